#!/usr/bin/env python3
"""How long `relevo capture` takes, and on what: a DEM of 1200 x 640 posts made of the bundled one, a picture of
1280 x 1024.

Usage: bench_capture.py [BUILD] [--runs N] [--device NAME] [--only EFFECTS] [--posts 4096x4096] [--frames N]
       BUILD: build/release (default)

Prints the whole process's time (minimum, median, maximum of the runs after one that warms the driver's
shader cache), the median of each stage and its share. Stages overlap: the DEM is read while the device starts.
With --frames also what further frames take, with the sun still and with it moved before each: the least by the clock,
and of processor time in the mean of N, of all runs.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def make_dem(folder, columns, rows):
    """A DEM of that size; make_dem is built with the tests."""
    path = folder / f"bench_{columns}x{rows}.tif"
    make = next(p for p in (ROOT / "build/dev/bin/make_dem", ROOT / "build/release/bin/make_dem") if p.exists())
    subprocess.run([make, ROOT / "data/dem/jacksboro.tif", str(columns), str(rows), path], check=True)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--only", help="effects to draw with; all that are on by default if not given")
    parser.add_argument("--posts", default="1200x640", help="columns and rows of the DEM")
    parser.add_argument("--frames", type=int, default=0, help="further frames of each run")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        dem = make_dem(folder, *map(int, arguments.posts.split("x")))
        timings = folder / "timings.json"
        command = [arguments.build / "bin/relevo", "-q", "capture", dem, "-o", folder / "out.png", "--overwrite",
                   "--device", arguments.device, *(["--only", arguments.only] if arguments.only else [])]
        walls, stages, wholes, frames = [], {}, [], {}
        for run in range(arguments.runs + 1):
            began = time.perf_counter()
            subprocess.run(command, check=True)
            wall = (time.perf_counter() - began) * 1e3
            subprocess.run([*command, "--timings", timings, "--repeat", str(arguments.frames)], check=True)
            if run == 0:
                print(f"first run, shader cache cold or warm as it was: {wall:.0f} ms")
                continue
            walls.append(wall)
            result = json.loads(timings.read_text())
            wholes.append(result["whole_ms"])
            for kind in ("frames", "frames_with_sun_moved"):
                for key in ("min_ms", "processor_ms") if kind in result else ():
                    frames[kind, key] = min(frames.get((kind, key), float("inf")), result[kind][key])
            for stage, ms in {**result["stages_ms"],
                              **{f"  pass {k}": v for k, v in result["passes_ms"].items()}}.items():
                stages.setdefault(stage, []).append(ms)
        print(f"device: {result['device']}, processors: {len(os.sched_getaffinity(0))}, "
              f"triangles: {result['triangles']}")
        print(f"whole process: min {min(walls):.0f}, median {statistics.median(walls):.0f}, "
              f"max {max(walls):.0f} ms of {len(walls)} runs (aim: below 1000)")
        whole = statistics.median(walls)
        for stage, values in stages.items():
            ms = statistics.median(values)
            print(f"  {stage:<18} {ms:7.1f} ms  {100 * ms / whole:5.1f} %")
        for key, words in (("min_ms", "by the clock"), ("processor_ms", "of processor")) if frames else ():
            still, moved = frames["frames", key], frames["frames_with_sun_moved", key]
            print(f"a frame {words}: {still:.0f} ms, with the sun moved {moved:.0f} ms: {moved - still:.0f} ms more")


if __name__ == "__main__":
    main()
