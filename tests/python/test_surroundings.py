"""A fine site in a wider and coarser DEM."""

import json
import shutil

import numpy
import pytest
import rasterio
from rasterio.warp import Resampling, reproject

import relevo

AT = {"lat": 36.245, "lon": -84.245}


@pytest.fixture(scope="module")
def site(path, tmp_path_factory):
    """A part of the DEM, of posts that are a quarter as far apart."""
    name = str(tmp_path_factory.mktemp("site") / "site.tif")
    with rasterio.open(path) as wide:
        step = wide.transform.a / 4
        transform = rasterio.Affine(step, 0, -84.26, 0, -step, 36.26)
        side = int(0.03 / step)
        heights = numpy.full((side, side), -9999, "float32")
        reproject(
            rasterio.band(wide, 1), heights, dst_transform=transform, dst_crs=wide.crs, resampling=Resampling.bilinear
        )
        profile = {"driver": "GTiff", "dtype": "float32", "count": 1, "width": side, "height": side}
        with rasterio.open(name, "w", crs=wide.crs, transform=transform, nodata=-9999, **profile) as file:
            file.write(heights, 1)
    return name


def test_figures_are_those_of_the_program(site, path, program, tmp_path):
    with relevo.open(site, surroundings=path) as dem:
        day = dem.sun.day(**AT, date="2026-12-21")
        hours = dem.sun.hours("2026-12-21", tz="UTC")
        made = dem.sun.tiles("sky_view", tmp_path / "tiles", tiles=64)
        alone = relevo.open(site).sun.day(**AT, date="2026-12-21")
    said = program("sun", "day", site, "--surroundings", path, "--at", "36.245,-84.245", "--date", "2026-12-21", "--json")
    assert day["days"][0]["direct_sun_h"] == json.loads(said)["days"][0]["direct_sun_h"] != alone["days"][0]["direct_sun_h"]
    program("sun", "hours", site, "--surroundings", path, "--date", "2026-12-21", "--tz", "UTC", "-o", str(tmp_path / "h.tif"))
    with rasterio.open(tmp_path / "h.tif") as file:
        numpy.testing.assert_array_equal(file.read(1), hours.values)
    assert made["made"] > 1
    assert "jacksboro.tif around the DEM: heights" in hours.about["surroundings"]


def test_heights_in_memory_have_them_too(site, path):
    with rasterio.open(site) as file:
        inside = relevo.open(file, surroundings=[path])
    with relevo.open(site, surroundings=path) as dem:
        numpy.testing.assert_array_equal(inside.sun.sky_view(8).values, dem.sun.sky_view(8).values)
        assert inside.provenance()["dem_sha256"] == dem.provenance()["dem_sha256"]
        assert dem.provenance()["dem_sha256"] != relevo.open(site).provenance()["dem_sha256"]


def test_rasters_are_made_again_with_them(site, path, tmp_path):
    shutil.copy(site, tmp_path / "site.tif")
    shutil.copy(path, tmp_path / "jacksboro.tif")
    with relevo.open(tmp_path / "site.tif", surroundings=tmp_path / "jacksboro.tif") as dem:
        raster = dem.sun.sky_view(8)
    raster.save(tmp_path / "sky.tif")
    numpy.testing.assert_array_equal(relevo.again(tmp_path / "sky.tif").values, raster.values)
    (tmp_path / "jacksboro.tif").unlink()
    with pytest.raises(relevo.BadInput, match="jacksboro.tif is missing"):
        relevo.again(tmp_path / "sky.tif")


@pytest.mark.parametrize("wrong", [[], 5, "none.tif", {"a": 1}])
def test_what_is_no_dem_is_refused(site, wrong):
    with pytest.raises(relevo.BadInput, match="surroundings|none.tif"):
        relevo.open(site, surroundings=wrong).sun.sky_view(4)


def test_a_site_beside_them_is_refused(site, path):
    with pytest.raises(relevo.BadInput, match="surroundings: .*end within the DEM"):
        relevo.open(path, surroundings=site).sun.sky_view(4)
