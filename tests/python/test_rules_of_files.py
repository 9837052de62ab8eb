"""Heights in memory obey the rules of files: undeclared voids, and the unit of a CRS's vertical part."""

import numpy
import pytest
import rasterio
import rasterio.io
import xarray

import relevo

TRANSFORM = rasterio.Affine(30, 0, 600000, 0, -30, 5200000)
FEET = "EPSG:32632+6360"  # NAVD88 height, US survey feet
FOOT_M = 1200 / 3937


def ground(void=-9999.0):
    """40 x 50 heights from 600 m on, of which 12 are a void."""
    heights = numpy.add.outer(numpy.arange(40.0), numpy.arange(50.0)) + 600
    heights[3:7, 10:13] = void
    return heights


def data_array(heights, crs="EPSG:32632", **attributes):
    y, x = 5200000 - 30 * (numpy.arange(40) + 0.5), 600000 + 30 * (numpy.arange(50) + 0.5)
    array = xarray.DataArray(heights, dims=("y", "x"), coords={"y": y, "x": x}, attrs=attributes)
    array.coords["spatial_ref"] = xarray.Variable((), 0, {"crs_wkt": rasterio.crs.CRS.from_string(crs).to_wkt()})
    return array


@pytest.fixture
def dataset():
    """Opens a dataset in memory with those heights."""
    files = []

    def make(heights, crs="EPSG:32632", nodata=None, scale=1.0, offset=0.0):
        file = rasterio.io.MemoryFile()
        files.append(file)
        profile = dict(driver="GTiff", height=40, width=50, count=1, dtype=heights.dtype, transform=TRANSFORM)
        with file.open(**profile, crs=crs, nodata=nodata) as written:
            written.write(heights, 1)
            written.scales, written.offsets = (scale,), (offset,)
        return file.open()

    yield make
    for file in files:
        file.close()


def assert_void(opened):
    read = opened.heights().values
    assert numpy.isnan(read[3:7, 10:13]).all() and numpy.isnan(read).sum() == 12
    assert read[20, 20] == pytest.approx(640)


def assert_kept(opened, void=-9999):
    assert opened.heights().values[4, 11] == pytest.approx(void)


def test_undeclared_voids(dataset, tmp_path):
    file = tmp_path / "undeclared.tif"
    with rasterio.open(file, "w", driver="GTiff", height=40, width=50, count=1, dtype="float64", transform=TRANSFORM,
                       crs="EPSG:32632") as written:
        written.write(ground(), 1)
    sources = {
        "file": (file, {}),
        "array": (ground(), {"transform": TRANSFORM, "crs": "EPSG:32632"}),
        "whole numbers": (ground().astype("int16"), {"transform": TRANSFORM, "crs": "EPSG:32632"}),
        "a mask without a void": (numpy.ma.masked_array(ground(), False), {"transform": TRANSFORM, "crs": "EPSG:32632"}),
        "rasterio": (dataset(ground()), {}),
        "xarray": (data_array(ground()), {}),
        "xarray without attributes": (data_array(ground(), nodata=-1.0, units="ft") * 1.0, {}),
        "xarray without a CRS": (data_array(ground()).drop_vars("spatial_ref") * 1.0, {"crs": 32632}),
    }
    for name, (source, arguments) in sources.items():
        with pytest.warns(relevo.Warning, match="-9999 is taken as a void") as warned:
            opened = relevo.open(source, **arguments)
        assert_void(opened), name
        assert 'nodata="none" keeps it' in str(warned[0].message)
        assert_kept(relevo.open(source, nodata="none", **arguments))


def test_declared_voids_are_all(dataset):
    """Where a source says which elements are voids, others are heights."""
    place = {"transform": TRANSFORM, "crs": "EPSG:32632"}
    masked = numpy.ma.masked_array(ground(), False)
    masked[30, 30] = numpy.ma.masked
    assert_kept(relevo.open(ground(), nodata=-1, **place))
    assert_kept(relevo.open(masked, **place))
    assert_kept(relevo.open(dataset(ground(), nodata=-1), crs=32632))
    assert_kept(relevo.open(data_array(ground(), _FillValue=-1.0)))
    assert_void(relevo.open(dataset(ground(), nodata=-9999)))
    assert_void(relevo.open(data_array(ground(), nodata=-9999)))


def test_a_nodata_value_replaces_the_declared_one(dataset):
    heights = ground()
    heights[30, 30] = -5000
    opened = relevo.open(dataset(heights, nodata=-9999), nodata=-5000)
    assert_kept(opened)
    assert numpy.isnan(opened.heights().values[30, 30])


def test_stored_numbers_are_what_is_compared(dataset):
    """As in files: -9999 before scale and offset."""
    stored = ((ground() - 5) * 10).round().astype("int16")
    stored[3:7, 10:13] = -9999
    with pytest.warns(relevo.Warning, match="-9999 is taken as a void"):
        assert_void(relevo.open(dataset(stored, scale=0.1, offset=5.0)))


def test_a_sea_floor_is_ground(recwarn):
    deep = ground(void=-9999.0)
    deep[30, 30] = -9600  # within 500 m
    assert_kept(relevo.open(deep, transform=TRANSFORM, crs="EPSG:32632"))
    assert not [one for one in recwarn if issubclass(one.category, relevo.Warning)]


def test_feet_of_a_vertical_crs(dataset, tmp_path):
    heights = ground(void=610.0)
    file = tmp_path / "feet.tif"
    with rasterio.open(file, "w", driver="GTiff", height=40, width=50, count=1, dtype="float64", transform=TRANSFORM,
                       crs=FEET) as written:
        written.write(heights, 1)
    with relevo.open(file) as opened:
        expected = opened.heights()
    assert expected.values[20, 20] == pytest.approx(640 * FOOT_M, abs=1e-4)
    for source, arguments in (
        (heights, {"transform": TRANSFORM, "crs": FEET}),
        (data_array(heights, FEET), {}),
        (data_array(heights, FEET, units="us-ft") * 1.0, {}),
    ):
        with pytest.warns(relevo.Warning, match='US survey foot by the vertical part of the CRS; unit="m" takes'):
            numpy.testing.assert_array_equal(relevo.open(source, **arguments).heights(), expected)
        assert relevo.open(source, unit="m", **arguments).heights().values[20, 20] == 640
    numpy.testing.assert_array_equal(relevo.open(dataset(heights, crs=FEET)).heights(), expected)
    assert relevo.open(data_array(heights, FEET, units="m")).heights().values[20, 20] == 640
    assert relevo.open(data_array(heights, "EPSG:32632", units="ft")).heights().values[20, 20] == pytest.approx(640 * 0.3048)


def test_heights_in_metres_do_not_say_feet(dataset):
    """What relevo returns is in metres; its CRS has no vertical part in another unit."""
    opened = relevo.open(dataset(ground(void=610.0), crs=FEET))
    heights = opened.heights()
    assert opened.crs == FEET and opened.wkt.startswith("COMPOUNDCRS")
    assert heights.crs == "EPSG:32632" and heights.wkt.startswith("PROJCRS")
    again = relevo.open(heights.to_xarray() * 1.0)
    numpy.testing.assert_array_equal(again.heights(), heights)


def test_other_words_for_nodata():
    with pytest.raises(relevo.BadInput, match='nodata: expected a number or "none" but got'):
        relevo.open(ground(), transform=TRANSFORM, crs=32632, nodata="None")
