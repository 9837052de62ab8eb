#!/usr/bin/env python3
"""Processor and wall-clock time of a steady frame with the effects of the default, beside a plain mesh in VTK.

Usage: frame.py [BUILD] [--beside BUILD] [--pairs 10] [--frames 6] [--size 1280x720] [--device software]

Two cameras over 1200 x 640 posts: the default view, of which some 60 % is ground, with air and a horizon; and the DEM as
a block, of which 30 % is. Each pair is one run of Relevo and one of the peer, in turn; figures are medians over the
pairs, and the ratio is the median of the pairs' ratios. The peer is another build (--beside), or else VTK, where
`xvfb-run` and Debian's python3-vtk9 are installed. A machine that does something else makes the clock's figures useless.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
VTK_PYTHON = "/usr/bin/python3"  # Debian's, which its package belongs to
COLUMNS, ROWS, SPACING_M = 1200, 640, 90
# The options of Relevo, and how much nearer than VTK's whole mesh its camera stands.
CAMERAS = {"default": ([], 2.6), "block": (["--view", "az=225,el=30"], 1.75)}


def make_dem(build, path):
    subprocess.run([build / "bin/make_dem", ROOT / "data/dem/jacksboro.tif", str(COLUMNS), str(ROWS), path], check=True)
    return path


def relevo(build, dem, folder, arguments, view):
    """Median wall-clock and processor time of a frame [ms]."""
    timings = folder / "timings.json"
    subprocess.run([build / "bin/relevo", "-q", "capture", dem, "-o", folder / "out.png", "--overwrite", "--size",
                    arguments.size, "--device", arguments.device, "--timings", timings, "--repeat",
                    str(arguments.frames), *view], check=True)
    frames = json.loads(timings.read_text())["frames"]
    return frames["median_ms"], frames["processor_ms"]


def vtk(raw, arguments, zoom):
    command = ["xvfb-run", "-a", VTK_PYTHON, ROOT / "tests/bench/vtk_mesh.py", raw, str(COLUMNS), str(ROWS),
               str(SPACING_M), str(arguments.frames), "--size", arguments.size, "--zoom", str(zoom)]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit(f"VTK does not run here: {run.stderr.strip().splitlines()[-1:]}; name a build with --beside")
    result = json.loads(run.stdout.splitlines()[-1])
    return statistics.median(result["times_ms"]), result["processor_ms"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--beside", type=pathlib.Path)
    parser.add_argument("--pairs", type=int, default=10)
    parser.add_argument("--frames", type=int, default=6)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--device", default="software")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        dem, raw = make_dem(arguments.build, folder / "dem.tif"), make_dem(arguments.build, folder / "dem.raw")
        for camera, (view, zoom) in CAMERAS.items():
            pairs = []
            for _ in range(arguments.pairs):
                ours = relevo(arguments.build, dem, folder, arguments, view)
                beside = arguments.beside
                pairs.append((ours, relevo(beside, dem, folder, arguments, view) if beside else vtk(raw, arguments, zoom)))
            for of, label in ((1, "processor"), (0, "clock")):
                ours, theirs = ([pair[side][of] for pair in pairs] for side in (0, 1))
                ratio = statistics.median(a / b for a, b in zip(ours, theirs))
                print(f"{camera:<8} {label:<10} {statistics.median(ours):7.1f} ms, {'build' if beside else 'VTK'} "
                      f"{statistics.median(theirs):7.1f} ms, ratio {ratio:.2f}", flush=True)


if __name__ == "__main__":
    main()
