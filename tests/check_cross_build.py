#!/usr/bin/env python3
"""Checks that a build for another machine runs no program that it has built.

Usage: check_cross_build.py CMAKE SOURCES BUILD. Configures the sources with a toolchain file that says so, this machine's
own compiler behind it: without RELEVO_HOST_TOOLS that is refused, and with those of BUILD the commands that make data
name them.
"""

import pathlib
import shutil
import subprocess
import sys

TOOLCHAIN = """set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR other)
"""


def main():
    cmake, sources, build = sys.argv[1], *map(pathlib.Path, sys.argv[2:4])
    scratch = build / "scratch/cross_build"
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    (scratch / "other.cmake").write_text(TOOLCHAIN, encoding="utf-8")

    def configure(folder, *options):
        return subprocess.run([cmake, "-S", sources, "-B", scratch / folder, "-G", "Ninja", "--toolchain",
                               scratch / "other.cmake", *options], capture_output=True, text=True, check=False)

    refused = configure("without")
    if refused.returncode == 0 or "RELEVO_HOST_TOOLS" not in refused.stderr:
        print("cross build: expected a message that asks for RELEVO_HOST_TOOLS but got", refused.stderr)
        return 1
    tools = build / "bin"
    made = configure("with", f"-DRELEVO_HOST_TOOLS={tools}")
    if made.returncode != 0:
        print("cross build: it cannot be configured:", made.stderr)
        return 1
    commands = subprocess.run(["ninja", "-C", scratch / "with", "-t", "commands", "relevo_ground_data", "relevo_sky_data"],
                              capture_output=True, text=True, check=True).stdout.splitlines()
    for name in ("relevo_make_ground", "relevo_make_sky"):
        if not any(f" {tools / name} " in command for command in commands):
            print(f"cross build: expected {tools / name} to be run but got", *commands, sep="\n    ")
            return 1
    foreign = [command for command in commands if "-o bin/" in command or f" {scratch}/with/bin/" in command]
    if foreign:
        print("cross build: programs for the other machine are part of it:", *foreign, sep="\n    ")
        return 1
    print("cross build: clean")
    return 0


if __name__ == "__main__":
    sys.exit(main())
