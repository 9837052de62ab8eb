#!/usr/bin/env python3
"""How long a year of direct light at one point takes, the whole process of `relevo sun carpet` and `relevo sun day`:
exact edges of every interval of 365 days, and a carpet of 3-minute steps, on a DEM of 1200 x 640 posts.

Usage: bench_direct_light.py [BUILD] [--runs N] [--dem DEM --at LAT,LON]      BUILD: build/release (default)

Prints minimum, median and maximum of the whole process over the runs after the first. `relevo --version`, which
does nothing, is the floor: loading the program and its libraries.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

from bench_capture import ROOT, make_dem


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--dem", type=pathlib.Path)
    parser.add_argument("--at", default="36.30,-84.24")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        dem = arguments.dem or make_dem(folder, 1200, 640)
        common = ["--at", arguments.at, "--year", "2026", "--tz", "-05:00"]
        relevo = [arguments.build / "bin/relevo", "-q"]
        cases = {
            "nothing: --version": [*relevo, "--version"],
            "sun day --csv, 365 days": [*relevo, "sun", "day", dem, *common, "--csv"],
            "sun carpet -o x.csv, 3 min": [*relevo, "sun", "carpet", dem, *common, "-o", folder / "x.csv",
                                           "--overwrite"],
            "sun carpet -o x.png, 3 min": [*relevo, "sun", "carpet", dem, *common, "-o", folder / "x.png",
                                           "--overwrite"],
        }
        print(f"processors: {len(os.sched_getaffinity(0))}; whole process, ms (aim: below 1000)")
        for title, command in cases.items():
            walls = []
            for run in range(arguments.runs + 1):
                began = time.perf_counter()
                subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                if run > 0:
                    walls.append((time.perf_counter() - began) * 1e3)
            print(f"  {title:<28} min {min(walls):5.0f}   median {statistics.median(walls):5.0f}   "
                  f"max {max(walls):5.0f}   of {len(walls)} runs")


if __name__ == "__main__":
    main()
