"""Tiles of rasters, and estimates of what rasters take."""

import inspect

import numpy
import pytest
import rasterio
import rasterio.merge

import relevo

FIGURES = {
    "hours": {"date": "2026-12-21", "bands": ["hours", "global"], "tz": "UTC"},
    "shadow": {"time": "2026-12-21T15:00Z", "soft": True},
    "sky_view": {"directions": 8},
    "horizons": {"directions": 4},
}


@pytest.mark.parametrize("figure", FIGURES)
def test_tiles_have_the_values_of_the_raster(dem, tmp_path, figure):
    assert dem.sun.tiles(figure, tmp_path / "tiles", tiles=200, **FIGURES[figure]) == {"made": 6, "there": 0}
    files = sorted((tmp_path / "tiles").glob("r*.tif"))
    values, transform = rasterio.merge.merge(files)
    expected = getattr(dem.sun, figure)(**FIGURES[figure])
    numpy.testing.assert_array_equal(values.reshape(expected.shape), expected.values)
    assert tuple(transform)[:6] == pytest.approx(tuple(dem.transform), rel=1e-12)


def test_resume(dem, tmp_path):
    days = {"start": "2026-06-20", "end": "2026-06-21", "tz": "UTC"}
    dem.sun.tiles("hours", tmp_path / "tiles", tiles=200, **days)
    (tmp_path / "tiles/r0001_c0002.tif").unlink()
    with pytest.raises(relevo.BadInput, match="^folder: .* exists; pass overwrite= .* or resume="):
        dem.sun.tiles("hours", tmp_path / "tiles", tiles=200, **days)
    assert dem.sun.tiles("hours", tmp_path / "tiles", tiles=200, resume=True, **days) == {"made": 1, "there": 5}
    with pytest.raises(relevo.BadInput, match="^folder: .* is of another command"):
        dem.sun.tiles("hours", tmp_path / "tiles", tiles=200, resume=True, date="2026-06-20")
    assert dem.sun.tiles("hours", tmp_path / "tiles", tiles=200, overwrite=True, **days)["made"] == 6


def test_clip_and_halo(dem, tmp_path):
    clip = (-84.3, 36.2, -84.2, 36.3)
    assert dem.sun.tiles("sky_view", tmp_path / "some", tiles=64, halo=5, clip=clip, directions=8)["made"] == 9
    with rasterio.open(next((tmp_path / "some").glob("r*.tif"))) as tile:
        assert "FAR_GROUND" in tile.tags()


def test_progress_cancels(dem, tmp_path):
    with pytest.raises(relevo.Cancelled):
        dem.sun.tiles("hours", tmp_path / "tiles", tiles=200, year=2026, progress=lambda share: False)
    assert not list((tmp_path / "tiles").glob("r0002*.tif"))


def test_an_estimate_writes_nothing(dem, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plan.json").write_text("no plan of ours")
    found = dem.sun.estimate("hours", date="2026-12-21", bands=["hours", "global"])
    assert found["posts"] == dem.shape[0] * dem.shape[1] and found["bands"] == 2
    assert found["result_bytes"] == 8 * found["posts"]
    assert 100 < found["memory_mib"] < 1000 and 0 < found["computing_s"] < 600
    assert [one.name for one in tmp_path.iterdir()] == ["plan.json"]


def test_arguments_are_those_of_the_figures():
    for function, more in ((relevo.SunOverDem.estimate, set()), (relevo.SunOverDem.tiles, {"folder", "tiles", "halo", "resume", "overwrite"})):
        expected = {"figure"} | more
        for figure in FIGURES:
            expected |= set(inspect.signature(getattr(relevo.SunOverDem, figure)).parameters)
        assert set(inspect.signature(function).parameters) == expected


@pytest.mark.parametrize(
    "call, sentence",
    [
        (lambda sun, folder: sun.estimate("dial"), "^figure: expected hours, shadow, sky_view or horizons but got 'dial'"),
        (lambda sun, folder: sun.estimate("sky_view", linke=3), "^linke: no such key"),
        (lambda sun, folder: sun.estimate("shadow"), "time"),
        (lambda sun, folder: sun.tiles("sky_view", folder, tiles=0), "^tiles: expected a whole number"),
        (lambda sun, folder: sun.tiles("sky_view", folder, halo=0), "^halo: expected a number"),
        (lambda sun, folder: sun.tiles("sky_view", 5), "^folder: expected a name but got 5"),
        (lambda sun, folder: sun.tiles("sky_view", sun._dem.name), "^folder: .* is the DEM"),
    ],
)
def test_bad_input(dem, tmp_path, call, sentence):
    with pytest.raises(relevo.BadInput, match=sentence):
        call(dem.sun, tmp_path / "tiles")
    assert not list(tmp_path.rglob("*.tif"))


def test_tiles_are_of_files(dem, tmp_path):
    with relevo.open(numpy.asarray(dem), transform=dem.transform, crs=dem.crs) as opened:
        assert opened.sun.estimate("sky_view", directions=8)["posts"] > 0
        with pytest.raises(relevo.BadInput, match="^folder: tiles are of a DEM of files"):
            opened.sun.tiles("sky_view", tmp_path / "tiles", directions=8)
