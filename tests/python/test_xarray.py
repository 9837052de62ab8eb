"""The accessor of xarray, and results as DataArrays."""

import subprocess
import sys

import numpy
import pytest
import xarray

import relevo
import relevo.xarray


@pytest.fixture
def heights(dem):
    return dem.heights().to_xarray()


def test_to_xarray(dem, heights):
    assert heights.dims == ("y", "x") and heights.shape == dem.shape
    assert heights.attrs["units"] == "m" and heights.name == "height"
    left, bottom, right, top = dem.bounds
    assert float(heights.x[0]) == pytest.approx(left + dem.transform.a / 2)
    assert float(heights.y[-1]) == pytest.approx(bottom - dem.transform.e / 2)
    assert heights.spatial_ref.attrs["crs_wkt"] == dem.wkt
    with relevo.open(heights) as again:
        assert again.transform == pytest.approx(dem.transform, rel=1e-12) and again.crs == dem.crs
    hours = dem.sun.hours("2026-06-21", bands=["hours", "global"]).to_xarray()
    assert hours.dims == ("band", "y", "x")
    assert hours.sel(band="global").unit == "kWh/m2"
    assert "definition" in hours.attrs


def test_accessor(dem, heights):
    expected = dem.sun.hours("2026-06-21")
    hours = heights.relevo.hours("2026-06-21")
    numpy.testing.assert_array_equal(hours, expected)
    assert hours.attrs["units"] == "h" and hours.attrs["long_name"] == "sun hours"
    xarray.testing.assert_equal((hours * 0 + heights).drop_vars("spatial_ref"), heights.drop_vars("spatial_ref"))
    numpy.testing.assert_array_equal(heights.relevo.sky_view(8), dem.sun.sky_view(8))
    numpy.testing.assert_array_equal(
        heights.relevo.shadow("2026-12-21T14:00Z"), dem.sun.shadow("2026-12-21T14:00Z")
    )
    numpy.testing.assert_array_equal(
        heights.relevo.horizon(*dem.centre).elevation, dem.sun.horizon(*dem.centre).elevation
    )
    size = (64, 48)
    numpy.testing.assert_array_equal(
        heights.relevo.capture("2026-12-21T14:00Z", size, device="software"),
        dem.capture("2026-12-21T14:00Z", size, device="software"),
    )
    with heights.relevo.open(crop=(-84.3, 36.2, -84.2, 36.3)) as part:
        assert part.shape[0] < dem.shape[0]


def test_parts_lie_where_their_coordinates_say(dem, heights):
    part = heights[100:200, 50:300]  # with the GeoTransform of the whole
    with part.relevo.open() as opened:
        left, top = dem.transform.apply(50, 100)
        assert opened.transform[2] == pytest.approx(left, rel=1e-12) and opened.transform[5] == pytest.approx(top, rel=1e-12)
        numpy.testing.assert_array_equal(opened.heights(), part)


def test_names_of_dimensions_stay(dem, heights):
    renamed = heights.rename(y="northing", x="easting").expand_dims("time")
    bands = renamed.relevo.hours("2026-06-21", bands=["hours", "first"])
    assert bands.dims == ("band", "northing", "easting")
    numpy.testing.assert_array_equal(bands[0], dem.sun.hours("2026-06-21"))
    numpy.testing.assert_array_equal(bands.northing, heights.y)


@pytest.mark.parametrize("first", ["xarray, relevo", "relevo.xarray, xarray"])
def test_order_of_imports(first):
    code = f"import {first}; print(xarray.DataArray([[0]]).relevo)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert "Accessor" in done.stdout, done.stderr


def test_chunked_arrays_are_lazy(heights, monkeypatch):
    pytest.importorskip("dask.array", reason="needs python3-dask")
    opened = []
    opens = relevo.xarray.open
    for module in (relevo.xarray, relevo._lazy):
        monkeypatch.setattr(module, "open", lambda source: opened.append(source.shape) or opens(source))
    chunked = heights.chunk({"y": 100, "x": 150})
    days = {"start": "2026-03-20", "end": "2026-03-22", "bands": ["hours", "global"]}
    lazy = chunked.relevo.hours(**days)
    assert opened == [(4, 4)]
    assert lazy.chunks == ((2,), (100, 100, 100, 44), (150, 150, 103)) and lazy.dims == ("band", "y", "x")
    whole = heights.relevo.hours(**days)
    assert list(lazy.unit.values) == list(whole.unit.values) == ["h", "kWh/m2"]
    del opened[:]
    numpy.testing.assert_array_equal(lazy.values, whole.values)
    assert opened == [heights.shape]
    clip = (-84.3, 36.2, -84.2, 36.3)
    part = chunked.relevo.sky_view(8, clip=clip)
    assert part.attrs["long_name"] == "sky-view factor" and part.attrs["units"] == "1"
    numpy.testing.assert_array_equal(part.values, heights.relevo.sky_view(8, clip=clip).values)
    with pytest.raises(relevo.BadInput, match="^bands: expected some of"):
        chunked.relevo.hours("2026-03-20", bands="hour")
