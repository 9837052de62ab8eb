"""Rasters say what they are, and are made again from it."""

import json
import shutil
import warnings

import numpy
import pytest
import rasterio

import relevo
from conftest import SOURCE

MADE = {
    "hours of a day": lambda sun: sun.hours("2026-06-21"),
    "hours of days": lambda sun: sun.hours(start="2026-02-27", end="2026-03-01", tz="+02:00", refraction="saemundsson"),
    "bands": lambda sun: sun.hours("2026-12-21", bands=["hours", "global", "first"], linke=4, step=600),
    "a list of one band": lambda sun: sun.hours("2026-12-21", bands=["beam"], albedo=0.3),
    "a band of several": lambda sun: sun.hours("2026-12-21", bands=["hours", "spells"])["spells"],
    "shadow": lambda sun: sun.shadow("2026-12-21T14:00Z", terrestrial_refraction=0.2),
    "soft shadow of an event": lambda sun: sun.shadow("sunset-30min", date="2026-03-20", soft=True, highest=1200),
    "horizons": lambda sun: sun.horizons(4, highest=1500),
    "one of the horizons": lambda sun: sun.horizons(8, terrestrial_refraction=0)["45"],
    "sky view": lambda sun: sun.sky_view(8, level=True),
}


@pytest.fixture
def small(path):
    with relevo.open(path, crop=(-84.3, 36.2, -84.2, 36.3), unit="m") as opened:
        yield opened


def equal(made, raster):
    numpy.testing.assert_array_equal(made.values, raster.values)
    assert (made.bands, made.units, made.about, made.transform) == (raster.bands, raster.units, raster.about, raster.transform)


@pytest.mark.parametrize("what", MADE)
def test_again(small, tmp_path, what):
    raster = MADE[what](small.sun)
    equal(relevo.again(raster), raster)
    equal(relevo.again(raster.to_xarray(), trust=True), raster)
    raster.save(tmp_path / "raster.tif")
    if len(raster.bands) == 1:  # a file of one band is read as (rows, columns)
        raster = raster[raster.bands[0]]
    equal(relevo.again(tmp_path / "raster.tif", trust=True), raster)


def test_again_of_netcdf(small, path, tmp_path, monkeypatch):
    pytest.importorskip("scipy", reason="needs python3-scipy")
    xarray = pytest.importorskip("xarray")
    raster = small.sun.hours("2026-06-21")
    raster.to_xarray().to_netcdf(tmp_path / "hours.nc", engine="scipy")
    with xarray.open_dataset(tmp_path / "hours.nc", engine="scipy") as data:
        read = data["hours"].load()
    read.encoding.pop("source", None)  # which some engines note
    monkeypatch.chdir(tmp_path)
    with pytest.raises(relevo.BadInput, match=f"dem: {tmp_path}/jacksboro.tif is missing; put {path} there, or give dem="):
        relevo.again(read)
    shutil.copy(path, tmp_path)
    made = relevo.again(read)
    numpy.testing.assert_array_equal(made.values, raster.values)
    assert made.about["dem_sha256"] == raster.about["dem_sha256"]


def test_again_of_arrays(dem):
    array = relevo.open(dem.heights().values, transform=dem.transform, crs=dem.crs)
    shadow = array.sun.shadow("2026-12-21T14:00Z")
    assert shadow.about["dem_sha256"] == dem.sun.shadow("2026-12-21T14:00Z").about["dem_sha256"]
    with pytest.raises(relevo.BadInput, match="its DEM was an array; give dem="):
        relevo.again(shadow)
    numpy.testing.assert_array_equal(relevo.again(shadow, dem=dem).values, shadow.values)


def test_again_of_another_dem(path, tmp_path, dem):
    file = tmp_path / "jacksboro.tif"
    shutil.copy(path, file)
    with relevo.open(file) as opened:
        shadow = opened.sun.shadow("2026-12-21T14:00Z")
    shadow.save(tmp_path / "shadow.tif")
    numpy.testing.assert_array_equal(relevo.again(tmp_path / "shadow.tif").values, shadow.values)
    with rasterio.open(file, "r+") as dataset:
        heights = dataset.read(1)
        heights[100, 100] += 1
        dataset.write(heights, 1)
    for raster in (shadow, tmp_path / "shadow.tif"):
        with pytest.raises(relevo.BadInput, match="jacksboro.tif are not those that the raster was made of"):
            relevo.again(raster)
    assert relevo.again(shadow, dem=dem).values.shape == dem.shape


@pytest.mark.parametrize(
    "change, message",
    [
        ({"figure": "close"}, "does not say by which figure"),
        ({"figure": None}, "does not say by which figure"),
        ({"options": "[]"}, "options is missing or no JSON object"),
        ({"options": '{"bands": [[]]}'}, "does not say by which figure"),
        ({"options": '{"time": "2026-12-21T14:00Z", "shell": 1}'}, "shell"),
        ({"options": '{"time": "2026-12-21T14:00Z", "progress": 1}'}, "progress"),
        ({"dem_files": "7"}, "does not say of which files"),
        ({"dem_files": None}, "does not say of which files"),
        ({"dem_files": '["/etc/passwd"]'}, "passwd is missing"),
        ({"dem_files": '[".."]'}, "is missing"),
        ({"dem_files": '["/vsicurl/http://example.org/a.tif"]'}, "a.tif is missing"),
        ({"dem_options": '{"transform": 1}'}, "options: expected some of band"),
        ({"dem_sha256": "0"}, "are not those that the raster was made of"),
    ],
)
def test_attributes_of_strangers(dem, path, tmp_path, monkeypatch, change, message):
    """Nothing but figures is made, and no file is opened but those beside a raster."""
    shutil.copy(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    array = dem.sun.shadow("2026-12-21T14:00Z").to_xarray()
    array.attrs = {key: value for key, value in {**array.attrs, **change}.items() if value is not None}
    with pytest.raises(relevo.BadInput, match=message):
        relevo.again(array)


def test_no_rasters(dem, path):
    for given, message in ((dem.heights(), "figure|options"), (path, "figure|options"), (7, "expected a Raster"),
                           ("/nowhere.tif", "nowhere.tif")):
        with pytest.raises(relevo.BadInput, match=message):
            relevo.again(given)


def test_rasters_carry_what_the_program_writes(small, program, tmp_path):
    raster = small.sun.hours("2026-06-21", tz="Europe/Zurich")
    program("sun", "hours", small.name, "--crop=-84.3,36.2,-84.2,36.3", "--date", "2026-06-21", "--tz", "Europe/Zurich",
            "-o", tmp_path / "hours.tif", "-q")
    with rasterio.open(tmp_path / "hours.tif") as file:
        tags = file.tags()
    tags.pop("AREA_OR_POINT")
    assert tags.pop("BEYOND_DEM") == raster.about["beyond"]
    assert len(tags) > 8
    for key, text in tags.items():
        assert str(raster.about[key.lower().removeprefix("tifftag_")]) == text, key
    assert json.loads(raster.about["dem_files"]) == [small.name]


@pytest.mark.parametrize("what", ["hours of a day", "shadow", "horizons", "sky view", "ten days"])
def test_the_accuracy_is_that_of_the_docs(small, what):
    made = MADE.get(what, lambda sun: sun.hours(start="2026-03-01", end="2026-03-10"))
    said, heights = str(made(small.sun).about["accuracy"]).split("; ")
    assert heights == "errors of the heights come on top"
    page = " ".join((SOURCE / "docs/accuracy-sun-rasters.md").read_text(encoding="utf-8").split())
    assert f": {said} " in page


def test_words_of_cf(dem):
    pytest.importorskip("pyproj", reason="needs python3-pyproj")
    light = dem.sun.hours("2026-06-21", bands="global").to_xarray()
    assert light.attrs["units"] == "kW h m-2" and light.attrs["long_name"] == "global irradiation"
    assert light.x.attrs["standard_name"] == "longitude" and light.y.attrs["units"] == "degrees_north"
    assert light.spatial_ref.attrs["grid_mapping_name"] == "latitude_longitude"
    assert light.encoding["grid_mapping"] == "spatial_ref"
    assert all(isinstance(value, (str, int, float)) for value in light.attrs.values())
    for made in (dem.sun.hours("2026-06-21", bands=["hours", "global"]), dem.sun.horizons(4), dem.sun.sky_view(4)):
        assert made.to_xarray().attrs["long_name"]
    assert dem.sun.horizons(4).to_xarray().attrs["units"] == "degree"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        hill = relevo.open(numpy.eye(9) * 99, transform=(30, 0, 600000, 0, -30, 5200000), crs="EPSG:32632")
        lit = hill.sun.shadow("2026-06-21T12:00Z").to_xarray()
    assert lit.x.attrs["standard_name"] == "projection_x_coordinate" and lit.x.attrs["units"] == "metre"
    assert lit.spatial_ref.attrs["grid_mapping_name"] == "transverse_mercator"
    stack = hill.sun.shadow(times=["2026-06-21T12:00Z", "2026-06-21T13:00:30Z"])
    for time in (stack.to_xarray().time, stack[stack.bands[1]].to_xarray().time):
        assert time.attrs["standard_name"] == "time" and time.encoding["dtype"] == "float64"  # CF has no int64
        assert str(time.values.ravel()[-1])[:19] == "2026-06-21T13:00:30"
