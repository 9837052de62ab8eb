#!/usr/bin/env python3
"""What a start of the program takes, the least of many runs.

    tests/bench/bench_start.py build/release [--runs 40]
"""
import argparse
import pathlib
import subprocess
import time

COMMANDS = {
    "--version": (["--version"], 20),
    "sun position": (["sun", "position", "--at", "46.95,7.45", "--time", "2026-06-21T12:00+02:00"], 30),
    "info DEM": (["-q", "info", "data/dem/jacksboro.tif"], None),
}


def least_ms(command, runs):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
        times.append(time.perf_counter() - start)
    return min(times) * 1000


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=40)
    arguments = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parents[2]
    program = str(arguments.build / "bin" / "relevo")
    for name, (words, aim_ms) in COMMANDS.items():
        words = [str(root / word) if word.startswith("data/") else word for word in words]
        aim = f"  (aim: below {aim_ms})" if aim_ms else ""
        print(f"{name:14}{least_ms([program, *words], arguments.runs):7.1f} ms{aim}")


if __name__ == "__main__":
    main()
