"""Heights of rasterio, numpy and xarray give what the file gives."""

import affine
import numpy
import pytest
import rasterio
import rasterio.io
import rasterio.vrt
import xarray

import relevo

TIME = "2026-12-21T14:00Z"


@pytest.fixture
def array(path):
    """Heights, transform and CRS of the bundled DEM, by rasterio."""
    with rasterio.open(path) as file:
        return file.read(1), file.transform, file.crs


@pytest.fixture
def expected(dem):
    return dem.sun.shadow(TIME).values


def same(dem, expected):
    numpy.testing.assert_array_equal(dem.sun.shadow(TIME), expected)


def test_numpy(array, expected, dem):
    heights, transform, crs = array
    for given in (transform, tuple(transform)[:6], relevo.Transform.from_gdal(*transform.to_gdal()), list(transform)):
        with relevo.open(heights, transform=given, crs=crs) as opened:
            assert opened.transform == pytest.approx(dem.transform, rel=1e-12)
            assert opened.crs == "EPSG:4326" and opened.name == "array"
            same(opened, expected)


def test_memory_layouts(array, expected):
    heights, transform, _ = array
    stuffed = numpy.zeros((2 * heights.shape[0], heights.shape[1] + 3), dtype=numpy.float64)
    stuffed[::2, 3:] = heights
    for given in (
        heights.astype(">i2"),
        heights.astype(">f8"),
        heights.astype(numpy.int64),
        numpy.asfortranarray(heights),
        stuffed[::2, 3:],
        heights[::-1][::-1],
        heights.tolist(),
        numpy.ma.masked_array(heights),
    ):
        same(relevo.open(given, transform=transform, crs=4326), expected)


def test_pictures_of_arrays(array, dem):
    heights, transform, _ = array
    with relevo.open(heights, transform=transform, crs=4326) as opened:
        size = (96, 64)
        numpy.testing.assert_array_equal(
            opened.capture(TIME, size, device="software"), dem.capture(TIME, size, device="software")
        )


def test_voids(array):
    heights, transform, crs = array
    masked = numpy.ma.masked_array(heights, mask=numpy.zeros(heights.shape, bool))
    masked[10:20, 30:50] = numpy.ma.masked
    floats = heights.astype(numpy.float32)
    floats[10:20, 30:50] = -9999
    kept = floats.copy()
    nan = numpy.where(floats == -9999, numpy.nan, floats)
    results = [
        relevo.open(masked, transform=transform, crs=crs),
        relevo.open(nan, transform=transform, crs=crs),
        relevo.open(floats, transform=transform, crs=crs, nodata=-9999),
    ]
    numpy.testing.assert_array_equal(floats, kept)  # the caller's memory is as it was
    for opened in results:
        read = opened.heights().values
        assert numpy.isnan(read[10:20, 30:50]).all() and numpy.isnan(read).sum() == 200
        assert opened.sun.shadow(TIME).about["holes"] == 200


def test_options_of_arrays(array):
    heights, transform, crs = array
    with relevo.open(heights / 0.3048, transform=transform, crs=crs, unit="ft", crop=(-84.3, 36.2, -84.2, 36.3)) as cropped:
        assert cropped.shape == pytest.approx((120, 120), abs=1)
        assert numpy.nanmax(cropped.heights().values) < 1100


def test_south_up(array, expected):
    heights, transform, crs = array
    turned = affine.Affine(transform.a, 0, transform.c, 0, -transform.e, transform.f + transform.e * heights.shape[0])
    lit = relevo.open(heights[::-1], transform=turned, crs=crs).sun.shadow(TIME)
    assert lit.transform.e > 0
    # Rows are in the order of the DEM; rounding differs.
    assert numpy.mean(lit.values[::-1] != expected) < 0.001


def test_rasterio(path, expected):
    with rasterio.open(path) as file, relevo.open(file) as opened:
        assert opened.name == path
        same(opened, expected)


def test_rasterio_in_memory(array, expected):
    heights, transform, crs = array
    profile = dict(driver="GTiff", height=heights.shape[0], width=heights.shape[1], crs=crs, transform=transform)
    with rasterio.io.MemoryFile() as memory:
        with memory.open(**profile, count=2, dtype="int16", nodata=-1) as file:
            # Heights in decimetres less 5 m, in the second band, with a void.
            stored = (heights.astype(numpy.int16) - 5) * 10
            stored[3, 4] = -1
            file.write(stored, 2)
            file.scales, file.offsets, file.units = (1, 0.1), (0, 5), ("", "metre")
        with memory.open() as file:
            opened = relevo.open(file, band=2)
            read = opened.heights().values
            assert numpy.isnan(read[3, 4])
            read[3, 4] = heights[3, 4]
            numpy.testing.assert_allclose(read, heights, atol=1e-3)
            with pytest.raises(relevo.BadInput, match="has 2 bands, not 3"):
                relevo.open(file, band=3)


def test_rasterio_warped(path):
    with rasterio.open(path) as file:
        with rasterio.vrt.WarpedVRT(file, crs="EPSG:32616", resampling=rasterio.enums.Resampling.bilinear) as warped:
            with relevo.open(warped) as opened:
                assert opened.crs == "EPSG:32616"
                assert opened.shape == warped.shape
                lat, lon = opened.centre
                with relevo.open(path) as original:
                    assert opened.height(lat, lon) == pytest.approx(original.height(lat, lon), abs=30)
                assert opened.sun.hours("2026-06-21").values[200, 200] > 0


def centres(array):
    heights, transform, _ = array
    x = transform.c + transform.a * (numpy.arange(heights.shape[1]) + 0.5)
    y = transform.f + transform.e * (numpy.arange(heights.shape[0]) + 0.5)
    return x, y


def test_xarray_with_the_crs_of_rioxarray(array, expected):
    heights, _, crs = array
    x, y = centres(array)
    given = xarray.DataArray(
        heights[numpy.newaxis], dims=("band", "y", "x"), coords={"band": [1], "y": y, "x": x}, attrs={"units": "metres"}
    )
    given.coords["spatial_ref"] = xarray.Variable((), 0, {"crs_wkt": crs.to_wkt()})
    with relevo.open(given) as opened:
        assert opened.crs == "EPSG:4326"
        same(opened, expected)


def test_xarray_of_cf(array, expected):
    heights, _, _ = array
    x, y = centres(array)
    given = xarray.DataArray(
        heights,
        dims=("lat", "lon"),
        coords={"lat": ("lat", y, {"units": "degrees_north"}), "lon": ("lon", x, {"units": "degrees_east"})},
    )
    with pytest.warns(relevo.Warning, match="WGS 84 is assumed"):
        opened = relevo.open(given)
    same(opened, expected)
    with pytest.raises(relevo.BadInput, match="rows before columns"):
        relevo.open(given.T)
    with pytest.raises(relevo.BadInput, match="the DataArray has none"):
        relevo.open(given.drop_vars(["lat", "lon"]), transform=(1, 0, 0, 0, -1, 0))
    with pytest.raises(relevo.BadInput, match="coordinates of lon are not regular"):
        relevo.open(given.assign_coords(lon=x**3), crs=4326)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"transform": None}, "transform: missing"),
        ({"crs": None}, "crs: missing"),
        ({"crs": "EPSG:999999"}, "EPSG:999999"),
        ({"crs": 3.5}, "crs: expected a text"),
        ({"transform": (0, 1, 0, 5, 0, -1)}, "looks as GDAL orders"),
        ({"transform": (1, 0, 0, 0, 0, 0)}, "cells with an area"),
        ({"transform": (1, 2, 3)}, "six numbers"),
        ({"transform": "abcdef"}, "six numbers"),
        ({"transform": (float("nan"),) * 6}, "finite numbers"),
        ({"unit": "parsec"}, "parsec"),
        ({"crop": (1, 2, 3)}, "crop: expected"),
        ({"encoding": "terrarium"}, "encoding: of files alone"),
        ({"band": 1}, "band: of files and datasets alone"),
        ({"nodata": "void"}, "nodata: expected a number"),
        ({"memory_mib": -3}, "memory_mib"),
        ({"source": numpy.zeros((2, 3, 4))}, r"3 dimensions, \(2, 3, 4\)"),
        ({"source": numpy.zeros(4)}, "1 dimensions"),
        ({"source": numpy.zeros((1, 4))}, "2 rows and columns or more"),
        ({"source": numpy.zeros((0, 4))}, "2 rows and columns or more"),
        ({"source": numpy.zeros((4, 4), complex)}, "an array of complex128"),
        ({"source": numpy.zeros((4, 4), bool)}, "an array of bool"),
        ({"source": numpy.array([["a", "b"], ["c", "d"]])}, "an array of <U1"),
        ({"source": numpy.array([[object()] * 2] * 2)}, "an array of object"),
        ({"source": None}, "an array of object"),
        ({"source": 7}, "0 dimensions"),
    ],
)
def test_what_is_no_dem(array, arguments, message):
    heights, transform, crs = array
    given = {"source": heights, "transform": transform, "crs": crs, **arguments}
    with pytest.raises(relevo.BadInput, match=message):
        relevo.open(given.pop("source"), **given).heights()


def test_heights_without_any(array):
    heights, transform, crs = array
    with relevo.open(numpy.full((4, 4), numpy.inf), transform=transform, crs=crs) as voids:
        with pytest.raises(relevo.BadInput, match="^heights: no valid height"):
            voids.sun.sky_view()


def test_files_that_are_none(path, tmp_path):
    with pytest.raises(relevo.BadInput, match="no such file"):
        relevo.open(tmp_path / "nowhere.tif")
    with pytest.raises(relevo.BadInput, match="transform: of arrays alone"):
        relevo.open(path, transform=(1, 0, 0, 0, -1, 0))
    with pytest.raises(relevo.BadInput, match="bounds"):
        relevo.open(path, bounds="here")
    with pytest.raises(relevo.BadInput):
        relevo.open(str(tmp_path))
    with pytest.raises(relevo.BadInput, match="one file or more"):
        relevo.open([])
    with pytest.raises(relevo.BadInput):
        relevo.open("a\0b")


def test_transform():
    geotransform = (10.0, 2.0, 0.5, 20.0, 0.25, -3.0)
    transform = relevo.Transform.from_gdal(*geotransform)
    assert transform == (2.0, 0.5, 10.0, 0.25, -3.0, 20.0) == tuple(affine.Affine.from_gdal(*geotransform))[:6]
    assert transform.to_gdal() == geotransform
    assert transform.apply(1, 2) == (13.0, 14.25)
