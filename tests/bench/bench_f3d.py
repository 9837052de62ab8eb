#!/usr/bin/env python3
"""What the whole `relevo capture` of a DEM takes beside F3D drawing a ready mesh of the same posts: 1200 x 640 of
them, made of the bundled DEM, a picture of 1280 x 1024.

Usage: bench_f3d.py [BUILD] [--rounds N] [--posts 1200x640]      BUILD: build/release (default)

Relevo reads the GeoTIFF, and draws all that is on by default; F3D (Debian's f3d, under Xvfb) reads a binary PLY of
the posts in metres, with neither shadows nor materials. Both in turn, after one round that warms files and shader
caches; printed is the least of each by the clock and of processor time, and Relevo's share of F3D's. By the clock
that means something on a machine that has nothing else to do.
"""

import argparse
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from osgeo import gdal

from bench_capture import ROOT, make_dem

EARTH_M = 6371000.0


def write_ply(dem, path):
    """A triangle mesh of all posts in metres: degrees are laid flat at the DEM's middle."""
    gdal.UseExceptions()
    data = gdal.Open(str(dem))
    height_m = data.ReadAsArray().astype("<f4")
    left, width, _, top, _, height = data.GetGeoTransform()
    rows, columns = height_m.shape
    degree_m = math.radians(1) * EARTH_M
    across_m = degree_m * math.cos(math.radians(top + height * rows / 2)) * width
    row, column = np.mgrid[0:rows, 0:columns].astype("<f4")
    vertices = np.stack([column * across_m, row * degree_m * height, height_m], -1).astype("<f4")
    index = np.arange(rows * columns, dtype="<i4").reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]
    triangles = np.stack([a, c, b, b, c, d], -1).reshape(-1, 3)
    faces = np.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {rows * columns}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        file.write(vertices.tobytes())
        file.write(faces.tobytes())


def took(command):
    """Seconds of the clock and of processor that a command takes."""
    before, began = os.times(), time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall, after = time.perf_counter() - began, os.times()
    return wall, after.children_user + after.children_system - before.children_user - before.children_system


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--posts", default="1200x640")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        dem = make_dem(folder, *map(int, arguments.posts.split("x")))
        write_ply(dem, folder / "posts.ply")
        commands = {
            "Relevo": [arguments.build / "bin/relevo", "-q", "capture", dem, "-o", folder / "relevo.png", "--overwrite",
                       "--device", "software"],
            # Under one Xvfb for all rounds: its start is none of F3D's.
            "F3D": ["f3d", folder / "posts.ply", "--output", folder / "f3d.png", "--resolution", "1280,1024", "--up", "+Z"],
        }
        least = {who: [math.inf, math.inf] for who in commands}
        for turn in range(arguments.rounds + 1):
            for who, command in commands.items():
                times = took(command)
                if turn > 0:
                    least[who] = [min(pair) for pair in zip(least[who], times)]
    for kind, name in enumerate(("by the clock", "of processor")):
        relevo, f3d = least["Relevo"][kind], least["F3D"][kind]
        print(f"{name}: Relevo {relevo:.2f} s, F3D {f3d:.2f} s, {relevo / f3d:.2f} of it")


if __name__ == "__main__":
    if "RELEVO_BENCH_DISPLAY" not in os.environ:
        os.environ["RELEVO_BENCH_DISPLAY"] = "1"
        os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1400x1100x24", *sys.orig_argv])
    main()
