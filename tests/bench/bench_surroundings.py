#!/usr/bin/env python3
"""Accuracy and time of a site of 1 m in the DEM of its range, by `--surroundings`.

Usage: bench_surroundings.py DEM [BUILD] [--at 47.20,11.30] [--points 200] [--rounds 5]

The site, 732 x 801 posts, is the DEM (bilinear, in the UTM zone of the place) with waves of its own of 3 m. The reference
is one DEM of 1 m over 3 km more on each side, in the same surroundings: the site's heights on the site, the DEM's beyond.
DEM: such as the AW3D30 tile N47E011, 3600 x 3600 posts.
"""

import argparse
import csv
import io
import pathlib
import statistics
import subprocess
import tempfile
import time

import numpy
import rasterio
from rasterio.transform import from_origin
from rasterio.warp import Resampling, reproject, transform

COLUMNS, ROWS, MARGIN = 732, 801, 3000
STEP_DEG = 2


def write(dem, path, crs, west, north, margin):
    """Posts of 1 m over the site and so much more."""
    shape = ROWS + 2 * margin, COLUMNS + 2 * margin
    place = from_origin(west - margin, north + margin, 1, 1)
    heights = numpy.full(shape, numpy.nan, "float32")
    with rasterio.open(dem) as source:
        reproject(
            rasterio.band(source, 1), heights, dst_transform=place, dst_crs=crs, dst_nodata=numpy.nan,
            resampling=Resampling.bilinear,
        )
    x, y = numpy.meshgrid(numpy.arange(COLUMNS), numpy.arange(ROWS))
    waves = 2 * numpy.sin(x / 37) * numpy.cos(y / 29) + numpy.sin(x / 11 + y / 7)
    heights[margin : margin + ROWS, margin : margin + COLUMNS] += waves
    profile = {"driver": "GTiff", "dtype": "float32", "count": 1, "height": shape[0], "width": shape[1], "tiled": True}
    with rasterio.open(path, "w", crs=crs, transform=place, nodata=numpy.nan, **profile) as file:
        file.write(heights, 1)


def horizons(program, dems, points, count):
    """(points, directions, 2): elevation [degrees] and distance [m]."""
    said = subprocess.run(
        [program, "-q", "sun", "horizon", *dems, "--points", points, "--step", str(STEP_DEG), "--csv"],
        capture_output=True, text=True, check=True,
    ).stdout
    rows = csv.DictReader(line for line in io.StringIO(said) if not line.startswith("#"))
    found = [(float(row["horizon_deg"]), float(row["distance_m"] or "nan")) for row in rows]
    return numpy.array(found).reshape(count, -1, 2)


def print_accuracy(program, site, wide, around, points, at, count):
    nested = horizons(program, [site, *around], points, count)
    expected = horizons(program, [wide, *around], points, count)
    azimuth = numpy.radians(numpy.arange(0, 360, STEP_DEG))
    distance = expected[..., 1]
    x, y = at[0][:, None] + distance * numpy.sin(azimuth), at[1][:, None] - distance * numpy.cos(azimuth)
    on_site = (x > 0) & (x < COLUMNS) & (y > 0) & (y < ROWS)
    off_deg = numpy.abs(nested[..., 0] - expected[..., 0])
    for name, some in {"on the site": on_site, "beyond 2 km": ~on_site & (distance > 2000)}.items():
        worst, within = off_deg[some].max(), 100 * (off_deg[some] <= 0.05).mean()
        print(f"horizons, ridge {name}: worst {worst:.3f} degrees off, {within:.1f} % of {some.sum()} within 0.05")
    between = ~on_site & (distance <= 2000)
    slope = numpy.tan(numpy.radians(nested[..., 0])) - numpy.tan(numpy.radians(expected[..., 0]))
    print(f"the ridge between: its height at most {numpy.abs(slope * distance)[between].max():.2f} m off")


def print_time(program, site, around, place, rounds):
    verb = ["--at", place, "--date", "2026-12-21"]
    took = {"alone": [], "with surroundings": []}
    for _ in range(rounds):
        for name, dems in {"alone": [site], "with surroundings": [site, *around]}.items():
            began = time.monotonic()
            subprocess.run([program, "-q", "sun", "day", *dems, *verb], check=True, capture_output=True)
            took[name].append(time.monotonic() - began)
    alone, nested = (statistics.median(seconds) for seconds in took.values())
    print(f"sun day: {nested:.2f} s, the site alone {alone:.2f} s; the limit is {1.3 * alone + 1:.2f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dem")
    parser.add_argument("build", nargs="?", default="build/release", type=pathlib.Path)
    parser.add_argument("--at", default="47.20,11.30", help="the site's north-west corner")
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    lat, lon = map(float, arguments.at.split(","))
    crs = f"EPSG:{(32600 if lat >= 0 else 32700) + int((lon + 180) // 6) + 1}"
    (west,), (north,) = transform("EPSG:4326", crs, [lon], [lat])
    random = numpy.random.default_rng(1)
    at = random.uniform(5, COLUMNS - 5, arguments.points), random.uniform(5, ROWS - 5, arguments.points)
    lons, lats = transform(crs, "EPSG:4326", west + at[0], north - at[1])
    program, around = arguments.build / "bin/relevo", ["--surroundings", arguments.dem]
    with tempfile.TemporaryDirectory() as scratch:
        site, wide, points = (pathlib.Path(scratch) / name for name in ("site.tif", "wide.tif", "points.csv"))
        write(arguments.dem, site, crs, west, north, 0)
        write(arguments.dem, wide, crs, west, north, MARGIN)
        points.write_text("lat,lon\n" + "".join(f"{lat:.9f},{lon:.9f}\n" for lat, lon in zip(lats, lons)))
        print_accuracy(program, site, wide, around, points, at, arguments.points)
        print_time(program, site, around, f"{lats[0]:.6f},{lons[0]:.6f}", arguments.rounds)


if __name__ == "__main__":
    main()
