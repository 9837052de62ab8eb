"""The wheel of packaging/wheel.sh: what it brings along, and how it gets on with rasterio and pyproj.

Skipped where there is none: CI makes none. RELEVO_WHEEL names one that is not in build/wheel.
"""

import hashlib
import os
import re
import subprocess
import sys
import zipfile

import pytest

import relevo
from conftest import BUNDLED, SOURCE

# What may be inside, with its licence. No library under the GPL is: a program that uses the wheel would be, too.
ALLOWED = {
    "librelevo": "MIT", "libbrotlicommon": "MIT", "libbrotlidec": "MIT", "libcairo": "LGPL-2.1", "libcrypto": "Apache-2.0",
    "libdate-tz": "MIT", "libdeflate": "MIT", "libepoxy": "MIT", "liberfa": "BSD-3", "libexpat": "MIT", "libfmt": "MIT",
    "libfontconfig": "MIT", "libfreetype": "FTL", "libgdal": "MIT", "libGeographicLib": "MIT", "libhdf5": "BSD-3",
    "libhdf5_hl": "BSD-3", "libhwy": "Apache-2.0", "libnetcdf": "BSD-3", "libnova-0.16": "LGPL-2", "libpixman-1": "MIT",
    "libpng16": "libpng", "libproj": "MIT", "libspdlog": "MIT", "libsqlite3": "public domain", "libtiff": "libtiff",
    "libutf8proc": "MIT", "libzstd": "BSD-3",
}
# Every Linux of the tag has these (PEP 600).
SYSTEM = {"libc.so.6", "libdl.so.2", "libexpat.so.1", "libgcc_s.so.1", "libm.so.6", "libpthread.so.0", "libstdc++.so.6",
          "libz.so.1", "ld-linux-x86-64.so.2"}


def run(*command, **more):
    """Without PYTHONPATH, which names the build tree."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | more
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=600, env=environment)


def python_of(*lines):
    return "import warnings; warnings.simplefilter('ignore')\n" + "\n".join(lines)


@pytest.fixture(scope="module")
def wheel():
    found = os.environ.get("RELEVO_WHEEL")
    files = [SOURCE / found] if found else sorted((SOURCE / "build/wheel").glob("relevo-*.whl"))
    if not files:
        pytest.skip("there is no wheel: packaging/wheel.sh makes it")
    return files[-1]


@pytest.fixture(scope="module")
def libraries(wheel, tmp_path_factory):
    """Libraries of the wheel, unpacked: {name without version: path}. Relevo's own modules are in lib/relevo."""
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(wheel) as files:
        names = [name for name in files.namelist() if re.search(r"\.so(\.|$)", name)]
        files.extractall(folder, names)
    bare = [re.sub(r"-[0-9a-f]{8}(?=\.)", "", name.rpartition("/")[2]) for name in names]  # auditwheel's checksums
    return {name.partition(".so")[0]: folder / path for name, path in zip(bare, names)}


def needs(path):
    return set(re.findall(r"NEEDED.*\[(\S+)\]", run("readelf", "-d", path).stdout))


def test_size(wheel):
    print(f"[ wheel ] {wheel.stat().st_size / 1e6:.1f} MB, {wheel.name}")
    assert wheel.stat().st_size <= 95e6


def test_tag_is_documented(wheel):
    minor = re.search(r"-py3-none-manylinux_2_(\d+)_x86_64\.", wheel.name)[1]
    assert f"glibc 2.{minor}" in (SOURCE / "docs/python.md").read_text(encoding="utf-8")


def test_no_library_under_the_gpl(libraries):
    assert {name for name, path in libraries.items() if path.parent.name == "lib"} <= set(ALLOWED)
    modules = {name for name, path in libraries.items() if path.parent.name != "lib"}
    assert "gdal" in modules and not modules & {"film_encoder", "image_formats"}


def test_all_that_is_needed_is_inside(libraries):
    inside = {path.name for path in libraries.values()}
    for path in libraries.values():
        assert needs(path) <= inside | SYSTEM, path.name


def test_licences(wheel, libraries):
    """Each library has its text: Debian's packages and sources are named as libraries are, but for their version."""
    with zipfile.ZipFile(wheel) as files:
        texts = {name.rpartition("/")[2] for name in files.namelist() if ".dist-info/licenses/" in name}
    for name in set(libraries) & set(ALLOWED) - {"librelevo"}:
        stem = re.match(r"lib([a-z]+)", name.lower())[1]
        aliases = {"brotlicommon": "brotli", "brotlidec": "brotli", "crypto": "ssl", "geographiclib": "geographic"}
        wanted = aliases.get(stem, stem)
        assert any(wanted in text for text in texts), name


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory):
    """A virtual environment with the wheel, rasterio and pyproj of the package index."""
    folder = tmp_path_factory.mktemp("environment")
    made = run(sys.executable, "-m", "venv", folder)
    if made.returncode:
        pytest.skip("needs python3-venv")
    made = run(folder / "bin/pip", "install", "--only-binary=:all:", wheel, "rasterio", "pyproj")
    if re.search(r"from versions: none|NewConnectionError", made.stderr):
        pytest.skip("needs numpy, rasterio and pyproj from the net")
    assert made.returncode == 0, made.stderr
    return folder / "bin/python"


FIGURE = f"""
import hashlib
raster = relevo.open({BUNDLED!r}).sun.hours("2026-06-21")
place = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:32616", always_xy=True).transform(-84.2, 36.3)
with rasterio.open({BUNDLED!r}) as dataset:
    print(hashlib.sha256(raster.values.tobytes()).hexdigest(), raster.crs, place, dataset.crs, dataset.read(1).sum())
"""


def test_figures_in_any_order_of_imports(python):
    """The same, also as those of the build tree."""
    orders = ("relevo, rasterio, pyproj", "rasterio, pyproj, relevo", "pyproj, relevo, rasterio")
    said = [run(python, "-c", python_of(f"import {order}", FIGURE)) for order in orders]
    assert [one.stderr for one in said] == [""] * 3
    assert len({one.stdout for one in said}) == 1
    here = relevo.open(BUNDLED).sun.hours("2026-06-21").values
    assert said[0].stdout.split()[0] == hashlib.sha256(here.tobytes()).hexdigest()


def test_other_libraries_are_not_used(python):
    """Variables of GDAL and PROJ are for other libraries than those inside, and are left as they are."""
    lines = python_of("import os", "before = dict(os.environ)", "import relevo", f"dem = relevo.open({BUNDLED!r})",
                      "files = [os.path.realpath(f'/proc/self/fd/{name}') for name in os.listdir('/proc/self/fd')]",
                      "print(dem.crs, dem.centre, *(file for file in files if file.endswith('proj.db')))",
                      "assert dict(os.environ) == before")
    nowhere = dict.fromkeys(("PROJ_DATA", "PROJ_LIB", "GDAL_DATA", "GDAL_DRIVER_PATH"), "/nowhere")
    plain, other = run(python, "-c", lines), run(python, "-c", lines, **nowhere)
    assert plain.returncode == 0, plain.stderr
    assert plain.stdout == other.stdout and plain.stderr == other.stderr == ""
    assert re.search(rf" {python.parents[1]}\S+/proj.db$", plain.stdout), plain.stdout


def test_import_is_quick(python):
    line = "import time; begin = time.perf_counter(); import numpy; own = time.perf_counter(); import relevo; " \
        "print(own - begin, time.perf_counter() - own)"
    numpy_s, own_s = min([float(word) for word in run(python, "-c", line).stdout.split()] for _ in range(5))
    print(f"[ import ] {numpy_s:.3f} s for numpy, {own_s:.3f} s for relevo")
    assert own_s < 0.3


DRIVERS = "AAIGrid COG CSV DTED GPKG GPX GRIB GTiff GeoJSON JPEG PNG SRTMHGT USGSDEM VRT netCDF"
OF_THE_NET = "DAAS EEDA HTTP OGCAPI STACTA WCS WMS WMTS"


def test_drivers(python):
    """Those that packaging/wheel.sh names, and none that asks the net."""
    done = run(python, "-c", f"""
import ctypes, pathlib, relevo
(file,) = (pathlib.Path(relevo.__file__).parent / "lib").glob("libgdal-*")
gdal = ctypes.CDLL(str(file))
gdal.GDALAllRegister()
gdal.GDALGetDriverByName.restype = ctypes.c_void_p
print(*(name for name in "{DRIVERS} {OF_THE_NET}".split() if gdal.GDALGetDriverByName(name.encode())))""")
    assert done.stdout.split() == DRIVERS.split(), done.stderr


@pytest.mark.parametrize(
    "ending, options",
    [
        ("tif", {"driver": "GTiff", "compress": "zstd"}),
        ("lerc.tif", {"driver": "GTiff", "compress": "lerc_deflate"}),
        ("cog.tif", {"driver": "COG"}),
        ("vrt", {"driver": "VRT"}),
        ("asc", {"driver": "AAIGrid"}),
        ("nc", {"driver": "netCDF", "format": "NC4"}),
        ("grb2", {"driver": "GRIB", "data_encoding": "SIMPLE_PACKING", "jpeg2000_driver": "none"}),
    ],
)
def test_formats(python, tmp_path, ending, options):
    """Files that rasterio writes have the heights of their source."""
    file = tmp_path / f"dem.{ending}"
    done = run(python, "-c", python_of(f"""
import numpy, rasterio.shutil, relevo
rasterio.shutil.copy({BUNDLED!r}, {str(file)!r}, **{options!r})
one, other = (relevo.open(name, unit="m").heights().values for name in ({BUNDLED!r}, {str(file)!r}))
print(float(numpy.abs(one - other).max()))"""))
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 0.01
