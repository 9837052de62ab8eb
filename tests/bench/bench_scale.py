#!/usr/bin/env python3
"""First picture, next frame and peak memory by the size and the layout of a DEM.

Usage: bench_scale.py [BUILD] [--sides 1000,4000,10000,20000] [--layouts strips1,strips64,tiles256,tiles256+overviews]
                      [--memory 64,256] [--keep FOLDER] [--device software]

DEMs are mirrored copies of the bundled one (make_dem), LZW. A picture is `capture` of the whole DEM, 1280 x 1024, with
default effects. The first start has no cache; the second one has what the first has written. Peak memory is that of
the process (ru_maxrss), less the floor: the same command on a DEM of 2 x 2 posts. Times are wall-clock times.
With --keep, DEMs stay in FOLDER and are used again.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def make_dem(build, path, side, layout):
    if path.exists():
        return
    name, _, overviews = layout.partition("+")
    part = path.with_suffix(".part.tif")
    command = [build / "bin/make_dem", ROOT / "data/dem/jacksboro.tif", str(side), str(side), part, "--layout", name]
    subprocess.run(command + (["--overviews"] if overviews else []), check=True)
    part.rename(path)


def run(command, environment):
    """Seconds and peak [MiB] of a command, which must succeed."""
    began = time.monotonic()
    process = subprocess.Popen([str(word) for word in command], env=environment)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{command} ended with {os.waitstatus_to_exitcode(status)}")
    return time.monotonic() - began, usage.ru_maxrss / 1024


class Bench:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache")}

    def capture(self, dem, *more):
        """Seconds and peak of a capture, and its --timings."""
        timings = self.folder / "timings.json"
        result = run([self.arguments.build / "bin/relevo", "-q", "capture", dem, "-o", self.folder / "out.png",
                      "--overwrite", "--device", self.arguments.device, "--timings", timings, *more], self.environment)
        return *result, json.loads(timings.read_text())

    def clear_cache(self):
        subprocess.run(["rm", "-rf", self.folder / "cache" / "relevo" / "levels"], check=True)

    def measure(self, name, dem, floor, *options):
        self.clear_cache()
        first_s, peak, _ = self.capture(dem, *options)
        second_s, second_peak, _ = self.capture(dem, *options)
        _, _, timings = self.capture(dem, *options, "--repeat", "5")
        print(f"{name:<34} first {first_s:6.2f} s, second {second_s:6.2f} s, next frame "
              f"{timings['frames']['median_ms']:5.0f} ms, peak less floor {peak - floor:5.0f} MiB, "
              f"second start {second_peak - floor:5.0f} MiB", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--sides", default="1000,4000,10000,20000")
    parser.add_argument("--layouts", default="strips1,strips64,tiles256,tiles256+overviews")
    parser.add_argument("--memory", default="", help="MiB; without it the default")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--device", default="software")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        dems = arguments.keep or folder
        dems.mkdir(parents=True, exist_ok=True)
        bench = Bench(arguments, folder)
        make_dem(arguments.build, dems / "2.tif", 2, "tiles256")
        bench.capture(dems / "2.tif")
        floor = min(bench.capture(dems / "2.tif")[1] for _ in range(3))
        print(f"processors: {len(os.sched_getaffinity(0))}, floor {floor:.0f} MiB")
        for side in map(int, arguments.sides.split(",")):
            for layout in arguments.layouts.split(","):
                dem = dems / f"{side}_{layout}.tif"
                make_dem(arguments.build, dem, side, layout)
                for memory in arguments.memory.split(","):
                    options = ["--memory", memory] if memory else []
                    bench.measure(f"{side} {layout} {' '.join(options)}", dem, floor, *options)
                if not arguments.keep:
                    dem.unlink()


if __name__ == "__main__":
    main()
