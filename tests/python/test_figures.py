"""Figures of the package are the program's, bit by bit."""

import datetime
import json
import warnings

import numpy
import pytest
import rasterio

import relevo


def test_grid_is_the_file_s(dem, path):
    with rasterio.open(path) as file:
        assert dem.shape == file.shape
        assert tuple(dem.transform) == pytest.approx(tuple(file.transform)[:6], rel=1e-12)
        assert dem.bounds == pytest.approx(tuple(file.bounds), rel=1e-12)
        assert dem.crs == "EPSG:4326"
        assert rasterio.crs.CRS.from_wkt(dem.wkt) == file.crs
        numpy.testing.assert_array_equal(dem.heights(), file.read(1).astype(numpy.float32))
    assert dem.heights().unit == "m"


def test_hours(dem, written):
    hours = dem.sun.hours("2026-06-21")
    numpy.testing.assert_array_equal(hours, written("sun", "hours", dem.name, "--date", "2026-06-21")[0])
    assert (hours.name, hours.unit) == ("sun hours", "h")
    assert hours.about["holes"] == 0
    assert hours.about["definition"].startswith("hours that the centre of the sun stands over the terrain")
    assert "beyond" in hours.about
    assert hours.values.dtype == numpy.float32 and hours.shape == dem.shape


def test_bands_of_hours(dem, written):
    values = dem.sun.hours(
        start="2026-12-20",
        end=datetime.date(2026, 12, 21),
        tz="-05:00",
        bands=["hours", "first", "global"],
        linke=2,
        tilt=30,
        azimuth=200,
        step=datetime.timedelta(minutes=2),
    )
    expected = written(
        "sun", "hours", dem.name, "--from", "2026-12-20", "--to", "2026-12-21", "--tz", "-05:00", "--bands",
        "hours,first,global", "--linke", 2, "--step", "2min", "--tilt", 30, "--azimuth", 200,
    )
    numpy.testing.assert_array_equal(values, expected)
    assert values.units == ("h", "min", "kWh/m2")
    numpy.testing.assert_array_equal(values["global"], expected[2])
    assert values["global"].name == "global irradiation"
    assert numpy.shares_memory(values["global"].values, values.values)
    assert "irradiation" in values.about["definition"]
    with pytest.raises(KeyError, match="diffuse: expected one of hours, first, global"):
        values["diffuse"]


def test_hours_of_a_year(dem, written):
    numpy.testing.assert_array_equal(dem.sun.hours(year=2026), written("sun", "hours", dem.name, "--year", 2026)[0])


@pytest.mark.parametrize(
    "time",
    [
        "2026-12-21T14:00Z",
        datetime.datetime(2026, 12, 21, 9, tzinfo=datetime.timezone(datetime.timedelta(hours=-5))),
        numpy.datetime64("2026-12-21T14:00"),
        1797861600,
    ],
)
def test_shadow(dem, written, time):
    expected = written("sun", "shadow", dem.name, "--time", "2026-12-21T14:00Z")
    numpy.testing.assert_array_equal(dem.sun.shadow(time), expected[0])


def test_soft_shadow_of_an_event(dem, written):
    soft = dem.sun.shadow("sunset-30min", date="2026-12-21", soft=True, refraction="none", terrestrial_refraction=0.2)
    expected = written(
        "sun", "shadow", dem.name, "--time", "sunset-30min", "--date", "2026-12-21", "--soft", "--no-refraction", "-k", 0.2
    )
    numpy.testing.assert_array_equal(soft, expected[0])
    assert 0 < numpy.count_nonzero((soft.values > 0) & (soft.values < 1))
    assert soft.name == "visible fraction of the solar disc"


def test_sky_view(dem, written):
    view = dem.sun.sky_view(directions=16, level=True)
    numpy.testing.assert_array_equal(view, written("sun", "sky-view", dem.name, "--directions", 16, "--level")[0])
    assert (view.name, view.unit) == ("sky-view factor", "1")


def test_terrain_outside_of_the_dem(dem):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for raster in (
            dem.sun.shadow("2026-06-21T17:00Z", highest=300),
            dem.sun.hours("2026-06-21", highest=-400),
            dem.sun.sky_view(4, highest=-400),
        ):
            assert "beyond" not in raster.about
    with pytest.raises(relevo.BadInput, match="highest"):
        dem.sun.sky_view(highest=9000)


def test_horizon(dem, program):
    lat, lon = dem.centre
    horizon = dem.sun.horizon(lat, lon, eye_height=2, step=1)
    told = json.loads(
        program("sun", "horizon", dem.name, "--at", f"{lat!r},{lon!r}", "--eye-height", 2, "--step", 1, "--json")
    )["horizon"]
    assert len(horizon.azimuth) == len(told) == 360
    numpy.testing.assert_allclose(horizon.elevation, [row["horizon_deg"] for row in told], atol=1e-6)
    distances = [numpy.nan if row["distance_m"] is None else row["distance_m"] for row in told]
    numpy.testing.assert_allclose(horizon.distance, distances, atol=1e-3)
    south = dem.sun.horizon(lat, lon, eye_height=2, azimuth=180)
    assert south.elevation[0] == pytest.approx(horizon.elevation[180], abs=1e-4)  # of few, by another way
    assert len(dem.sun.horizon(lat, lon, step=0.1).azimuth) == 3600


def test_height(dem):
    lat, lon = dem.centre
    heights = dem.heights().values
    rows, columns = dem.shape
    # The middle of an even number of rows and an odd one of columns lies between two posts.
    between = 0.5 * (float(heights[rows // 2 - 1, columns // 2]) + float(heights[rows // 2, columns // 2]))
    assert dem.height(lat, lon) == pytest.approx(between, abs=0.01)
    many = dem.height([[lat, 0], [lat, lat]], lon)
    assert many.shape == (2, 2)
    assert many[0, 0] == many[1, 1] == dem.height(lat, lon)
    assert numpy.isnan(many[0, 1])


def test_options_of_opening(path, written):
    crop = (-84.3, 36.2, -84.2, 36.3)
    with relevo.open(path, crop=crop, unit="ft", memory_mib=256, holes="cut") as dem:
        assert dem.shape == pytest.approx((120, 120), abs=1)
        expected = written("sun", "hours", path, "--date", "2026-06-21", "--crop", "-84.3,36.2,-84.2,36.3", "--unit", "ft")
        numpy.testing.assert_array_equal(dem.sun.hours("2026-06-21"), expected[0])


def test_saved_raster(dem, tmp_path):
    dem.sun.hours("2026-06-21", bands=["hours", "spells"]).save(tmp_path / "hours.tif", compress="deflate", creation_options={"blockxsize": 256, "blockysize": 256})
    hours = dem.sun.hours("2026-06-21")
    with rasterio.open(tmp_path / "hours.tif") as file:
        numpy.testing.assert_array_equal(file.read(1), hours)
        assert file.units == ("h", "1") and file.descriptions[0] == "sun hours"
        assert file.crs.to_epsg() == 4326
        assert tuple(file.transform)[:6] == pytest.approx(tuple(dem.transform), rel=1e-12)
        assert file.tags()["RELEVO_DEFINITION"] == hours.about["definition"]


def test_repr(dem):
    assert repr(dem) == f"<relevo.Dem {dem.name!r}: 344 x 403>"
    assert repr(dem.sun.shadow("2026-12-21T14:00Z")) == "<relevo.Raster 344 x 403: direct sun [1], EPSG:4326>"


@pytest.mark.parametrize(
    "words, make",
    [
        (["hours", "--date", "2026-06-21"], lambda sun, **clip: sun.hours("2026-06-21", **clip)),
        (["shadow", "--time", "2026-12-21T13:30Z"], lambda sun, **clip: sun.shadow("2026-12-21T13:30Z", **clip)),
        (["sky-view", "--directions", "8"], lambda sun, **clip: sun.sky_view(8, **clip)),
        (["horizons", "--directions", "1"], lambda sun, **clip: sun.horizons(1, **clip)["0"]),
    ],
)
def test_clip(dem, path, written, words, make):
    """The values of --clip at their places, and those of no other places; NaN elsewhere."""
    raster = make(dem.sun, clip=(-84.3, 36.2, -84.2, 36.25))
    inside = numpy.isfinite(raster.values)
    rows, columns = numpy.flatnonzero(inside.any(axis=1)), numpy.flatnonzero(inside.any(axis=0))
    assert inside.sum() == len(rows) * len(columns) == 61 * 121
    found = raster.values[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    numpy.testing.assert_array_equal(found, written("sun", *words[:1], path, *words[1:], "--clip=-84.3,36.2,-84.2,36.25")[0])
    assert abs(found - make(dem.sun).values[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]).max() < 0.1
    assert raster.about["clip"].startswith(f"columns {columns[0]} to {columns[-1]} and rows {rows[0]} to {rows[-1]}")
    numpy.testing.assert_array_equal(relevo.again(raster).values, raster.values)


def test_clip_in_another_crs(dem):
    metres = dem.sun.shadow("2026-12-21T13:30Z", clip=(743000, 4010000, 750000, 4015000), clip_crs=32616)
    assert 5000 < numpy.isfinite(metres.values).sum() < 8000
    for wrong, message in (
        ({"clip": (0, 0, 1, 1)}, "^clip: .* not one post of the DEM"),
        ({"clip": (1, 0, 0, 1)}, "^clip: .* expected WEST,SOUTH,EAST,NORTH, numbers of the DEM's CRS or of clip_crs="),
        ({"clip": 7}, "^clip: expected .west, south, east, north. or a shape with __geo_interface__ but got 7"),
        ({"clip": (1, 2, 3)}, "^clip: expected"),
        ({"clip_crs": 32616}, "^clip_crs: needs clip"),
        ({"clip": (0, 0, 1, 1), "clip_crs": "EPSG:999999"}, "^clip_crs: "),
    ):
        with pytest.raises(relevo.BadInput, match=message):
            dem.sun.sky_view(8, **wrong)


def test_horizons(dem, written):
    horizons = dem.sun.horizons(8)
    numpy.testing.assert_array_equal(horizons, written("sun", "horizons", dem.name, "--directions", 8))
    assert horizons.bands[:3] == ("0", "45", "90") and horizons.unit == "deg"
    assert horizons["45"].name == "horizon towards azimuth 45"
    row, column = 100, 200
    x, y = dem.transform.apply(column + 0.5, row + 0.5)
    exact = dem.sun.horizon(y, x, step=45).elevation
    assert horizons.values[:, row, column] == pytest.approx(exact, abs=0.2)
    for wrong in (0, 721, 2.5, True, "8", 10**30):
        with pytest.raises(relevo.BadInput, match="^directions: expected a whole number from 1 to 720"):
            dem.sun.horizons(wrong)


class Shape:
    """As shapely and geopandas have it."""

    def __init__(self, corners, crs=None, kind="Polygon"):
        polygon = {"type": "Polygon", "coordinates": [corners]}
        self.__geo_interface__ = polygon if kind == "Polygon" else {
            "type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": polygon}]
        }
        if crs:
            self.crs = crs


# No centre of a post lies on its edges.
TRIANGLE = [(-84.3001, 36.2001), (-84.2001, 36.2001), (-84.3001, 36.2501), (-84.3001, 36.2001)]


def test_clip_of_a_shape(dem):
    """Posts whose centres are in the triangle have the values of the whole DEM; others are NaN."""
    whole, found = dem.sun.sky_view(8).values, dem.sun.sky_view(8, clip=Shape(TRIANGLE))
    rows, columns = numpy.indices(dem.shape)
    x, y = dem.transform.apply(columns + 0.5, rows + 0.5)
    inside = (x > -84.3001) & (y > 36.2001) & ((x + 84.3001) / 0.1 + (y - 36.2001) / 0.05 < 1)
    assert 0 < inside.sum() < inside.size / 10
    numpy.testing.assert_array_equal(found.values, numpy.where(inside, whole, numpy.float32("nan")))
    assert relevo.again(found, dem=dem).values.tobytes() == found.values.tobytes()
    bands = dem.sun.horizons(2, clip=Shape(TRIANGLE))
    assert (numpy.isfinite(bands.values) == inside).all()


def test_clip_of_features_in_another_crs(dem):
    import rasterio.warp

    (x, y) = rasterio.warp.transform("EPSG:4326", "EPSG:32616", *zip(*TRIANGLE))
    features = Shape(list(zip(x, y)), "EPSG:32616", "FeatureCollection")
    found, expected = dem.sun.sky_view(4, clip=features), dem.sun.sky_view(4, clip=Shape(TRIANGLE))
    assert (numpy.isfinite(found.values) != numpy.isfinite(expected.values)).sum() < 10  # on its edges


@pytest.mark.parametrize(
    "shape, message",
    [
        ({"type": "Point", "coordinates": (1, 2)}, "^clip: expected polygons but got Point"),
        ({"type": "FeatureCollection", "features": []}, "^clip: FeatureCollection has no polygon"),
        ({"type": "Polygon"}, "^clip: "),
        ({"type": "Polygon", "coordinates": [[(1, 1), (2, 1), (1, 2), (1, 1)]]}, "^clip: no post of the DEM is in it"),
    ],
)
def test_clip_of_no_shape(dem, shape, message):
    with pytest.raises(relevo.BadInput, match=message):
        dem.sun.sky_view(4, clip=shape)


def test_notebooks_show_a_raster(dem, tmp_path):
    import base64
    import re

    raster = dem.sun.sky_view(4, clip=(-84.3, 36.2, -84.2, 36.25))
    shown = raster._repr_html_()
    assert shown.startswith("<div>&lt;relevo.Raster ")
    (tmp_path / "shown.png").write_bytes(base64.b64decode(re.search('base64,([^"]+)', shown)[1]))
    with rasterio.open(tmp_path / "shown.png") as picture:
        grey, alpha = picture.read()
    step = -(-max(dem.shape) // 256)
    known = numpy.isfinite(raster.values[::step, ::step])
    assert ((alpha == 255) == known).all() and grey[known].min() == 0 and grey[known].max() >= 254
