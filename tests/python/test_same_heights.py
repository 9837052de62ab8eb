"""A DEM has the same heights and figures, or the same error, from its file and from memory: DEMs of others' making."""

import importlib.util
import warnings

import pytest
import rasterio

import relevo
from conftest import SOURCE

FOLDER = SOURCE.parent / "shared/dem"
NAMES = (
    "N42E001.hgt", "SainteHelens.dem", "dem_RGI50-05.08389.tif", "hawaii_rotated20.tif", "holyroodpark.tif",
    "missoula_valley.img", "monterey_bay_topobathy.tif", "mt_rainier_90m.tif", "n00_e006_3arc_v2.dt1", "n43.dt0", "roi.tif",
    "srtm_bigtujunga30m_utm11.tif",
)  # fmt: skip
WRONG = {"avaGar.asc": r"\bcrs\b", "gironde_dem_cm.tif": "so the unit may be wrong", "ldem_4_reduced.cub": "of the Moon"}


def sources(name):
    path = FOLDER / name
    if not path.exists():
        pytest.skip(f"needs {path}")
    dataset = rasterio.open(path)
    yield path, {}
    yield dataset, {}
    yield dataset.read(1), {
        "transform": dataset.transform, "crs": dataset.crs, "nodata": dataset.nodata, "unit": dataset.units[0]
    }  # fmt: skip
    if importlib.util.find_spec("rioxarray"):
        import rioxarray

        yield rioxarray.open_rasterio(path).isel(band=0), {}
        yield rioxarray.open_rasterio(path, masked=True).isel(band=0) * 1.0, {"unit": dataset.units[0]}


@pytest.fixture(autouse=True)
def without_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@pytest.mark.parametrize("name", NAMES)
def test_heights_and_shadows(name):
    made = []
    for source, options in sources(name):
        with relevo.open(source, **options) as dem:
            made.append((dem.heights().values.tobytes(), dem.sun.shadow(sun=(123, 12)).values.tobytes()))
    assert len(made) >= 3 and len(set(made)) == 1


@pytest.mark.parametrize("name", WRONG)
def test_errors(name):
    for source, options in sources(name):
        with pytest.raises(relevo.BadInput, match=WRONG[name]):
            with relevo.open(source, **options) as dem:
                dem.sun.shadow(sun=(123, 12))


def test_bag_of_rasterio_has_heights_though_its_crs_says_depths():
    file, dataset = list(sources("sample.bag"))[:2]
    made = [relevo.open(source).heights().values for source in (file[0], dataset[0])]
    assert made[0].max() > 90 and (made[0] == made[1]).all()
