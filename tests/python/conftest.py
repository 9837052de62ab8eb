"""What tests of the Python package share."""

import os
import pathlib
import subprocess
import warnings

import numpy
import pytest
import rasterio

import relevo

BUILD = pathlib.Path(os.environ["RELEVO_BUILD"])
SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUNDLED = str(BUILD / "share/relevo/data/dem/jacksboro.tif")


@pytest.fixture(autouse=True)
def quiet():
    """The bundled DEM is small: mountains around it could hide the sun, which every figure warns of."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="mountains outside this DEM", category=relevo.Warning)
        yield


@pytest.fixture(scope="session")
def path():
    return BUNDLED


@pytest.fixture
def dem():
    with relevo.open(BUNDLED) as opened:
        yield opened


@pytest.fixture
def program(tmp_path):
    """Runs the program and returns its standard output."""

    def run(*arguments):
        done = subprocess.run(
            [os.environ["RELEVO_PROGRAM"], *map(str, arguments)], capture_output=True, text=True, cwd=tmp_path, timeout=300
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture
def written(program, tmp_path):
    """Bands of the raster that a verb of the program writes, voids as NaN."""

    def run(*arguments):
        file = tmp_path / "program.tif"
        program(*arguments, "-o", file, "--overwrite", "-q")
        with rasterio.open(file) as dataset:
            return dataset.read(masked=True).astype(numpy.float32).filled(numpy.nan)

    return run


@pytest.fixture
def captured(program, tmp_path):
    """RGBA of the picture that the program makes."""

    def run(*arguments):
        file = tmp_path / "program.png"
        program("capture", BUNDLED, "-o", file, "--overwrite", "-q", "--device", "software", *arguments)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a picture has no georeference
            with rasterio.open(file) as dataset:
                bands = dataset.read()
        rgba = numpy.full((*bands.shape[1:], 4), 255, dtype=numpy.uint8)
        rgba[..., : bands.shape[0]] = numpy.moveaxis(bands, 0, -1)
        return rgba

    return run
