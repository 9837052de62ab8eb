#!/usr/bin/env python3
"""relevo zones: 100,000 polygons of 20 cells over 3600 x 3600 values, time and memory.

Usage: bench_zones.py PROGRAM [--zones N] [--pairs N]. Needs GDAL's Python modules. With exactextract (PyPI) installed
the same is done by it, in turns, and the greatest difference of the means is printed.
"""

import argparse
import csv
import math
import multiprocessing
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

import numpy
from osgeo import gdal, ogr, osr

SIDE = 3600
CELL_M = 30


def write_raster(path):
    rows, columns = numpy.mgrid[0:SIDE, 0:SIDE]
    values = (1000 + 500 * numpy.sin(columns / 90.0) * numpy.cos(rows / 70.0)).astype("float32")
    raster = gdal.GetDriverByName("GTiff").Create(str(path), SIDE, SIDE, 1, gdal.GDT_Float32,
                                                  ["TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=3"])
    raster.SetGeoTransform((500000, CELL_M, 0, 5300000, 0, -CELL_M))
    raster.SetProjection(crs().ExportToWkt())
    raster.GetRasterBand(1).WriteArray(values)


def crs():
    found = osr.SpatialReference()
    found.ImportFromEPSG(32632)
    return found


def write_zones(path, count):
    """Octagons of 20 cells, anywhere."""
    chance = random.Random(1)
    radius = math.sqrt(20 * CELL_M**2 / (2 * math.sqrt(2)))
    dataset = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = dataset.CreateLayer("zones", crs(), ogr.wkbPolygon)
    dataset.StartTransaction()
    for _ in range(count):
        x = 500000 + chance.uniform(200, SIDE * CELL_M - 200)
        y = 5300000 - chance.uniform(200, SIDE * CELL_M - 200)
        corners = [f"{x + radius * math.cos(k * math.pi / 4):.3f} {y + radius * math.sin(k * math.pi / 4):.3f}"
                   for k in range(8)]
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POLYGON (({', '.join(corners + corners[:1])}))"))
        layer.CreateFeature(feature)
    dataset.CommitTransaction()


def run(command):
    """Seconds of the wall clock and of the processor, and MiB."""
    begun = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"failed: {command}")
    return time.perf_counter() - begun, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


PEER = """
import csv, sys
from exactextract import exact_extract
rows = exact_extract(sys.argv[1], sys.argv[2], ["mean"], include_cols=None)
csv.writer(open(sys.argv[3], "w")).writerows([row["properties"]["mean"]] for row in rows)
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--zones", type=int, default=100_000)
    parser.add_argument("--pairs", type=int, default=3)
    arguments = parser.parse_args()
    try:
        import exactextract  # noqa: F401
        peer = True
    except ImportError:
        peer = False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        raster, zones = folder / "values.tif", folder / "zones.gpkg"
        # Elsewhere: what a process has in memory counts for those that it begins.
        for write, path in (write_raster, [raster]), (write_zones, [zones, arguments.zones]):
            process = multiprocessing.Process(target=write, args=path)
            process.start()
            process.join()
        ours, theirs = [], []
        for _ in range(arguments.pairs):
            ours.append(run([arguments.program, "zones", raster, "--zones", zones, "-o", folder / "ours.csv",
                             "--overwrite"]))
            if peer:
                theirs.append(run([sys.executable, "-c", PEER, raster, zones, folder / "theirs.csv"]))
        print(f"relevo zones: {arguments.zones} zones, {statistics.median(t for t, _, _ in ours):.2f} s, "
              f"processor {statistics.median(p for _, p, _ in ours):.2f} s, {max(m for _, _, m in ours):.0f} MiB")
        if peer:
            print(f"exactextract: {statistics.median(t for t, _, _ in theirs):.2f} s, processor "
                  f"{statistics.median(p for _, p, _ in theirs):.2f} s")
            ratio = statistics.median(a[0] / b[0] for a, b in zip(ours, theirs))
            means = [float(row["mean"]) for row in csv.DictReader(open(folder / "ours.csv"))]
            others = [float(row[0]) for row in csv.reader(open(folder / "theirs.csv"))]
            print(f"ratio {ratio:.2f}; greatest difference of means "
                  f"{max(abs(a / b - 1) for a, b in zip(means, others)):.1e}")


if __name__ == "__main__":
    main()
