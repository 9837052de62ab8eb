#!/usr/bin/env python3
"""Makes data/dem/*.tif from Debian's package python-matplotlib-data.

Usage: make_bundled_dems.py [--samples FOLDER] OUT

FOLDER holds jacksboro_fault_dem.npz and topobathy.npz; without it the package is downloaded with
apt-get and unpacked in a folder that is removed again. Needs python3-numpy and python3-gdal.
What the files are and why they are placed where they are: data/README.md.
"""

import argparse
import hashlib
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal, osr

PACKAGE = "python-matplotlib-data"
SAMPLES = "usr/share/matplotlib/mpl-data/sample_data"
SHA256 = {
    "jacksboro_fault_dem.npz": "d493f50a33e82a4420494c54d1fca1539d177bdc27ab190bc5fe6e92f62fb637",
    "topobathy.npz": "0244e03291702df45024dcb5cacbc4f3d4cb30d72dfa7fd371c4ac61c42b4fbf",
}


def opened(folder, name):
    path = folder / name
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != SHA256[name]:
        sys.exit(f"make_bundled_dems: {path}: another file than the one that was checked, "
                 f"expected SHA-256 {SHA256[name]} but got {found}; check its place anew")
    return np.load(path)


def write(path, height_m, crs, geotransform, description):
    rows, columns = height_m.shape
    dataset = gdal.GetDriverByName("GTiff").Create(
        str(path), columns, rows, 1, gdal.GDT_Int16,
        ["COMPRESS=DEFLATE", "PREDICTOR=2", "ZLEVEL=9", "BLOCKYSIZE=64"])
    reference = osr.SpatialReference()
    reference.SetFromUserInput(crs)
    dataset.SetSpatialRef(reference)
    dataset.SetGeoTransform(geotransform)
    dataset.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", description)
    band = dataset.GetRasterBand(1)
    band.SetUnitType("m")
    band.WriteArray(height_m)
    band = None
    dataset = None
    print(f"{path}: {columns} x {rows}, {height_m.min()} to {height_m.max()} m, "
          f"{path.stat().st_size} bytes")


def make_jacksboro(samples, out):
    with opened(samples, "jacksboro_fault_dem.npz") as data:
        height_m = data["elevation"]  # row 0 is north
        step_deg = float(data["dx"])
        # ymax is the northern edge. ymin is not the southern one: it is ymax plus the height of the
        # raster where it should be minus. Cross Mountain, Norris Lake and five towns agree
        # (tests/dem/test_bundled.cpp); 32 km further north, nothing does.
        west_deg, north_deg = float(data["xmin"]), float(data["ymax"])
    rows, columns = height_m.shape
    write(out / "jacksboro.tif", height_m, "EPSG:4326",
          (west_deg, step_deg, 0, north_deg, 0, -step_deg),
          "Jacksboro fault, Cumberland Mountains, Tennessee; SRTM, 3 arc-seconds; NASA and USGS, "
          "public domain")


def make_vancouver_island(samples, out):
    with opened(samples, "topobathy.npz") as data:
        height_m = data["topo"][::-1]  # row 0 is south
        lat_deg = data["latitude"].astype(float)[::-1]
        lon_deg = data["longitude"].astype(float) - 360
    radius_m = 6378137.0  # of EPSG:3857
    x_m = radius_m * np.radians(lon_deg)
    y_m = radius_m * np.log(np.tan(np.pi / 4 + np.radians(lat_deg) / 2))

    def straight(values_m, what):
        """The first value and the step of equally spaced ones; they are, to the file's 32 bits."""
        index = np.arange(values_m.size)
        step_m, first_m = np.polyfit(index, values_m, 1)
        worst_m = np.abs(first_m + step_m * index - values_m).max()
        print(f"vancouver-island: {what}: step {step_m:.3f} m in EPSG:3857, at most {worst_m:.2f} m "
              "off equal steps")
        assert worst_m < 0.01 * abs(step_m)
        return first_m, step_m

    first_x_m, step_x_m = straight(x_m, "columns")
    first_y_m, step_y_m = straight(y_m, "rows")
    assert np.array_equal(height_m, np.rint(height_m))
    write(out / "vancouver-island.tif", height_m.astype(np.int16), "EPSG:3857",
          (first_x_m - step_x_m / 2, step_x_m, 0, first_y_m - step_y_m / 2, 0, step_y_m),
          "Vancouver Island and the sea around it, 2 minutes; from matplotlib's sample data, "
          "Copyright (c) 2012- Matplotlib Development Team; All Rights Reserved")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    options = parser.parse_args()
    gdal.UseExceptions()
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        samples = options.samples
        if samples is None:
            subprocess.run(["apt-get", "download", PACKAGE], cwd=scratch, check=True)
            package = next(pathlib.Path(scratch).glob("*.deb"))
            subprocess.run(["dpkg-deb", "-x", package, scratch], check=True)
            samples = pathlib.Path(scratch) / SAMPLES
        make_jacksboro(samples, options.out)
        make_vancouver_island(samples, options.out)


if __name__ == "__main__":
    main()
