#!/usr/bin/env python3
"""How the time of a frame grows with the size of a DEM, and how it compares with one plain mesh in VTK.

Usage: bench_terrain.py [BUILD] [--frames N] [--device NAME] [--sizes 1000,4000,10000] [--no-vtk]

DEMs are made of the bundled one; pictures are 1280 x 1024 with the plugin layering alone. Processor time is that of
all threads, which a busy machine changes less than it does the clock's. The camera stands where the
whole DEM is in the picture, and 300 m above the ground at the DEM's middle, where a view over the horizon has less
ground of a small DEM and a view down has as much of each. VTK is asked in the same run, where
`xvfb-run` and Debian's python3-vtk9 are installed, for the 1200 x 640 DEM as one mesh with Gouraud shading.
"""

import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
VTK_PYTHON = "/usr/bin/python3"  # Debian's, which its package belongs to


def make_dem(path, columns, rows):
    make = next(p for p in (ROOT / "build/dev/bin/make_dem", ROOT / "build/release/bin/make_dem") if p.exists())
    subprocess.run([make, ROOT / "data/dem/jacksboro.tif", str(columns), str(rows), path], check=True)
    return path


def frames(arguments, dem, folder, view):
    timings = folder / "timings.json"
    subprocess.run([arguments.build / "bin/relevo", "-q", "capture", dem, "-o", folder / "out.png", "--overwrite",
                    "--device", arguments.device, "--only", "layering", "--timings", timings,
                    "--repeat", str(arguments.frames), *view], check=True)
    return json.loads(timings.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=9)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--sizes", default="1000,4000,10000")
    parser.add_argument("--no-vtk", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        print(f"processors: {len(os.sched_getaffinity(0))}")
        first = {}
        for side in map(int, arguments.sizes.split(",")):
            dem = make_dem(folder / f"{side}.tif", side, side)
            info = json.loads(subprocess.run([arguments.build / "bin/relevo", "-q", "info", dem, "--json"],
                                             check=True, capture_output=True, text=True).stdout)
            middle = f"{info['center']['lat_deg']},{info['center']['lon_deg']}"
            above = ["--eye", middle + ",300agl", "--heading", "300", "--pitch"]
            for label, view in (("whole", []), ("300 m above ground", [*above, "-5"]),
                                ("looking down there", [*above, "-35"])):
                result = frames(arguments, dem, folder, view)
                ms = result["frames"]["median_ms"]
                growth = ms / first.setdefault(label, ms)
                processor = result["frames"]["processor_ms"]
                processor_growth = processor / first.setdefault(label + " processor", processor)
                print(f"{side:>6} posts a side, {label:<18}: median {ms:6.1f} ms (min {result['frames']['min_ms']:.1f}),"
                      f" {processor:.1f} ms of processor time, {result['triangles']:>7} triangles,"
                      f" {growth:.2f} and {processor_growth:.2f} of the first; whole capture "
                      f"{result['whole_ms'] / 1e3:.1f} s, load {result['stages_ms']['load'] / 1e3:.1f} s")
            dem.unlink()
        dem = make_dem(folder / "peer.tif", 1200, 640)
        result = frames(arguments, dem, folder, [])
        ours, our_processor = result["frames"]["median_ms"], result["frames"]["processor_ms"]
        print(f"1200 x 640 posts: median {ours:.1f} ms (min {result['frames']['min_ms']:.1f}), "
              f"{our_processor:.1f} ms of processor time a frame, "
              f"{result['triangles']} triangles, {result['device']}")
        if arguments.no_vtk or not shutil.which("xvfb-run"):
            print("VTK is not asked")
            return
        raw = make_dem(folder / "peer.raw", 1200, 640)
        run = subprocess.run(["xvfb-run", "-a", VTK_PYTHON, ROOT / "tests/bench/vtk_mesh.py", raw, "1200", "640", "90",
                              str(arguments.frames)], capture_output=True, text=True)
        if run.returncode != 0:
            print("VTK does not run here:", run.stderr.strip().splitlines()[-1:])
            return
        vtk = json.loads(run.stdout.splitlines()[-1])
        theirs = statistics.median(vtk["times_ms"])
        print(f"VTK {vtk['version']}: median {theirs:.1f} ms (min {min(vtk['times_ms']):.1f}), "
              f"{vtk['processor_ms']:.1f} ms of processor time a frame, "
              f"{vtk['triangles']} triangles, {vtk['device']}")
        print(f"ours against VTK's: {ours / theirs:.2f} of the time (aim: at most 0.50), "
              f"{our_processor / vtk['processor_ms']:.2f} of the processor's")


if __name__ == "__main__":
    main()
