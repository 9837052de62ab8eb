#!/usr/bin/env python3
"""The binary interface of librelevo is the one that is written down, in bindings/c/relevo.abi.

check_abi.py LIBRARY HEADERS BASELINE            fails where the interface is another one
check_abi.py --write LIBRARY HEADERS BASELINE    writes it down, unless programs that are built would no longer run
check_abi.py --broken LIBRARY HEADERS BASELINE   fails unless a function that is missing is found out
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

CHANGED, INCOMPATIBLE = 4, 8  # bits of abidiff's status


def describe(library, headers, output):
    subprocess.run(["abidw", "--exported-interfaces-only", "--drop-private-types", "--no-corpus-path", "--no-elf-needed",
                    "--no-comp-dir-path", "--no-show-locs", "--no-architecture", "--headers-dir", headers,
                    "--out-file", output, library], check=True)


def compare(before, now):
    """Status and report of abidiff."""
    done = subprocess.run(["abidiff", before, now], capture_output=True, text=True)
    if done.returncode & 3:
        sys.exit(f"abidiff {before} {now}: {done.stdout}{done.stderr}")
    return done.returncode, done.stdout


def with_another_function(baseline):
    """A baseline that has a function more than the library: as if that had been taken away."""
    text = pathlib.Path(baseline).read_text(encoding="utf-8")
    symbol = re.search(r" *<elf-symbol name='relevo_scene'.*\n", text).group()
    return text.replace(symbol, symbol + symbol.replace("relevo_scene", "relevo_taken_away"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--broken", action="store_true")
    parser.add_argument("library")
    parser.add_argument("headers")
    parser.add_argument("baseline")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        now = pathlib.Path(folder, "now.abi")
        describe(given.library, given.headers, now)
        if given.broken:
            before = pathlib.Path(folder, "before.abi")
            before.write_text(with_another_function(given.baseline), encoding="utf-8")
            status, report = compare(before, now)
            print(report)
            return 0 if status & INCOMPATIBLE and "relevo_taken_away" in report else 1
        if given.write and not pathlib.Path(given.baseline).exists():
            status, report = 0, ""
        else:
            status, report = compare(given.baseline, now)
        if status & INCOMPATIBLE:
            sys.exit(f"{report}\nprograms that are built would no longer run; keep what there was")
        if given.write:
            pathlib.Path(given.baseline).write_text(now.read_text(encoding="utf-8"), encoding="utf-8")
        elif status & CHANGED:
            sys.exit(f"{report}\nthe interface has grown or changed; write it down with check_abi.py --write, and "
                     "look at the difference")
    print("interface: as written down")
    return 0


if __name__ == "__main__":
    sys.exit(main())
