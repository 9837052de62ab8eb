#!/bin/sh
# Milliseconds of a frame on this machine's GPU, by pass, and frames a second: the default view of a DEM, and the same
# with the sun moved before each frame.
#
# Usage: gpu.sh [BUILD] [DEM]      200 frames of 1280 x 720 without a window; needs python3
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/release}
dem=${2:-$root/data/dem/jacksboro.tif}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$build/bin/relevo" -q capture "$dem" -o "$folder/frame.png" --size 1280x720 --device auto --repeat 200 \
    --timings "$folder/timings.json"
python3 - "$folder/timings.json" <<'PYTHON'
import json
import sys

timings = json.load(open(sys.argv[1]))
print(f"{timings['device']}, {timings['triangles']} triangles")
for name, what in (("frames", "a frame"), ("frames_with_sun_moved", "with the sun moved")):
    frames = timings[name]
    print(f"{what}: median {frames['median_ms']:.2f} ms (min {frames['min_ms']:.2f}, max {frames['max_ms']:.2f}), "
          f"{1e3 / frames['median_ms']:.0f} frames a second, {frames['processor_ms']:.2f} ms of processor time")
    for part, of in sorted(frames["passes"].items(), key=lambda item: -item[1]["ms"]):
        if of["ms"] >= 0.005:
            print(f"    {part:<20} {of['ms']:7.2f} ms")
PYTHON
