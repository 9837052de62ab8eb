"""Figures of chunked arrays: with halos, and of many times."""

import inspect
import pickle
import subprocess
import sys
import warnings

import numpy
import pytest
import rasterio.merge
import xarray

import relevo
import relevo.xarray

pytest.importorskip("dask.array", reason="needs python3-dask")
TIMES = ["2026-12-21T21:00Z", "2026-12-21T14:00:30Z"]  # not in order
CRS = "EPSG:32632"


def hills(side, void=None):
    """10 m from post to post."""
    y, x = numpy.ogrid[0:side, 0:side]
    values = 600 + 300 * numpy.sin(x / 70) * numpy.cos(y / 90) + 200 * numpy.sin((x + 2 * y) / 400)
    centre = 10 * (numpy.arange(side) + 0.5)
    array = xarray.DataArray(values.astype("f4"), coords={"y": 5.3e6 - centre, "x": 5e5 + centre}, dims=("y", "x"))
    return array.assign_attrs(crs=CRS)


@pytest.fixture
def heights(dem):
    return dem.heights().to_xarray()


@pytest.fixture
def chunked(heights):
    return heights.chunk({"y": 100, "x": 150})


def test_many_times_are_a_stack(dem, heights, chunked):
    eager = heights.relevo.shadow(times=TIMES)
    lazy = chunked.relevo.shadow(times=TIMES)
    assert eager.dims == lazy.dims == ("time", "y", "x") and lazy.chunks[0] == (1, 1)
    numpy.testing.assert_array_equal(lazy.values, eager.values)
    expected = numpy.array([time[:-1] for time in TIMES], "datetime64[ns]")
    numpy.testing.assert_array_equal(lazy.time, expected)
    for one, time in zip(lazy, TIMES):
        single = heights.relevo.shadow(time)
        numpy.testing.assert_array_equal(one, single)
        assert one.attrs["long_name"] == single.attrs["long_name"] and one.attrs["units"] == single.attrs["units"] == "1"
        assert one.name == single.name == "shadow"
    soft = chunked.relevo.shadow(times=TIMES, soft=True)
    assert soft.attrs["long_name"] == heights.relevo.shadow(TIMES[0], soft=True).attrs["long_name"]
    sun = chunked.relevo.shadow(sun=(123, 8))
    numpy.testing.assert_array_equal(sun, dem.sun.shadow(sun="123,8"))


def test_the_dem_is_opened_once(chunked, heights, monkeypatch):
    opened = []
    opens = relevo._lazy.open
    monkeypatch.setattr(relevo._lazy, "open", lambda source, **options: opened.append(source.shape) or opens(source, **options))
    chunked.relevo.shadow(times=[*TIMES, "2026-06-21T12:00Z"]).compute(scheduler="threads")
    assert opened == [heights.shape]


def test_plots_have_titles_labels_and_units(chunked):
    pyplot = pytest.importorskip("matplotlib.pyplot", reason="needs python3-matplotlib")
    pyplot.switch_backend("Agg")
    image = chunked.relevo.shadow(times=TIMES, soft=True).isel(time=0).plot()
    assert "time = 2026-12-21T21:00:00" in image.axes.get_title()
    assert image.axes.get_xlabel() and image.axes.get_ylabel()
    pyplot.close("all")
    label = chunked.relevo.hours("2026-12-21").plot().colorbar.ax.get_ylabel()
    assert label == "sun hours [h]"
    pyplot.close("all")


@pytest.mark.parametrize("halo, side", [(0.8, 250), (2.05, 360)])  # means of 1 x 1 post, and of 2 x 2
def test_chunks_with_halos_are_the_tiles_of_the_program(halo, side, tmp_path):
    heights = hills(side)
    with relevo.open(heights) as opened:
        opened.heights().save(tmp_path / "hills.tif")
    lazy = heights.chunk({"y": 140, "x": 140})
    with relevo.open(tmp_path / "hills.tif") as dem:
        for figure, options in {
            "horizons": {"directions": 4}, "shadow": {"sun": (123, 6)}, "sky_view": {"directions": 8},
            "hours": {"date": "2026-12-21", "tz": "UTC", "bands": ["hours", "global"], "step": 3600},
        }.items():
            folder = tmp_path / figure
            dem.sun.tiles(figure, folder, tiles=140, halo=halo, **options)
            tiles, _ = rasterio.merge.merge(sorted(folder.glob("r*.tif")))
            found = getattr(lazy.relevo, figure)(halo=halo, **options)
            with rasterio.open(next(folder.glob("r*.tif"))) as tile:
                assert found.attrs["far_ground"] == tile.tags()["FAR_GROUND"].replace("a tile", "a chunk")
            off = numpy.abs(found.values - tiles.reshape(found.shape))
            assert off.max() == 0 if halo < 2 else numpy.quantile(off, 0.999) < 1e-3, figure


def test_horizons_of_a_halo_are_those_of_the_whole():
    """A sweep over a grid that begins elsewhere differs at single posts, the more the nearer the DEM ends."""
    heights = hills(700)
    whole = heights.relevo.horizons(8).values
    found = heights.chunk({"y": 250, "x": 250}).relevo.horizons(8, halo=2.5).values
    off = numpy.abs(found - whole)[:, 100:-100, 100:-100]
    print(f"halo of 2.5 km: mean {off.mean():.4f} degrees, 95 % {numpy.quantile(off, 0.95):.4f}, 99 % {numpy.quantile(off, 0.99):.3f}")
    assert off.mean() < 0.02 and numpy.quantile(off, 0.95) < 0.1


MEMORY = """
import sys, warnings
import dask, dask.array, numpy, xarray, relevo.xarray

def part(block_info=None):
    (top, bottom), (left, right) = block_info[None]["array-location"]
    y, x = numpy.ogrid[top:bottom, left:right]
    return (600 + 300 * numpy.sin(x / 70) * numpy.cos(y / 90)).astype("f4")

def peak_mib():
    with open("/proc/self/status") as status:
        return int(next(line for line in status if line.startswith("VmHWM")).split()[1]) / 1024

warnings.simplefilter("ignore")
centre = 10 * (numpy.arange(5000) + 0.5)
values = dask.array.map_blocks(part, chunks=((1000,) * 5,) * 2, dtype="f4", meta=numpy.zeros((0, 0), "f4"))
heights = xarray.DataArray(values, coords={"y": 5.3e6 - centre, "x": 5e5 + centre}, dims=("y", "x"), attrs={"crs": "EPSG:32632"})
before = peak_mib()
with dask.config.set(scheduler="synchronous"):
    mean = float(heights.relevo.shadow(sun=(123, 6), halo=float(sys.argv[1]) or None).mean())
print(mean, peak_mib() - before)
"""


def test_memory_is_that_of_a_chunk_and_its_halo():
    means, peaks = [], []
    for halo in ("0", "5"):
        done = subprocess.run([sys.executable, "-c", MEMORY, halo], capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        mean, peak = map(float, done.stdout.split())
        means.append(mean)
        peaks.append(peak)
    print(f"shadow of 5000 x 5000 posts: {peaks[0]:.0f} MiB; chunks of 1000 x 1000 with a halo of 5 km: {peaks[1]:.0f} MiB")
    assert means[0] == pytest.approx(means[1], abs=1e-3)
    assert peaks[1] < 0.7 * peaks[0]


@pytest.mark.parametrize("chunk", [1, (1, 35), (40, 1)])
def test_chunks_of_one_post(chunk):
    heights = hills(40)
    sides = (chunk, chunk) if isinstance(chunk, int) else chunk
    lazy = heights[:3, :40].chunk({"y": sides[0], "x": sides[1]})
    found = lazy.relevo.shadow(sun=(123, 6), halo=2)
    assert found.chunks == lazy.chunks
    numpy.testing.assert_array_equal(found.values, heights[:3, :40].relevo.shadow(sun=(123, 6)).values)


@pytest.mark.parametrize("mark", [numpy.nan, -9999.0])
def test_voids(mark):
    heights = hills(120)
    void = heights.copy(data=heights.values.copy())
    void.values[:60, :60] = mark  # of one chunk all
    void.values[70, 70] = mark
    if not numpy.isnan(mark):
        with pytest.raises(relevo.BadInput, match=r"^halo: -9999 seems to mark voids; make them NaN by heights.where"):
            void.chunk(60).relevo.shadow(sun=(123, 6), halo=0.5).compute()
        void.attrs["_FillValue"] = mark
    found = void.chunk(60).relevo.shadow(sun=(123, 6), halo=2)
    expected = void.relevo.shadow(sun=(123, 6))
    numpy.testing.assert_array_equal(numpy.isnan(found.values), numpy.isnan(expected.values))
    assert (found.values != expected.values)[~numpy.isnan(expected.values)].mean() < 2e-3


def test_turned_grids_and_bands():
    turned = relevo.Transform(8, 6, 5e5, 6, -8, 5.3e6)
    array = xarray.DataArray(hills(90).values, dims=("y", "x"), attrs={"crs": CRS})
    array.coords["spatial_ref"] = xarray.Variable((), 0, {"GeoTransform": " ".join(map(repr, turned.to_gdal())), "crs_wkt": CRS})
    found = array.chunk(40).relevo.hours("2026-12-21", tz="UTC", bands=["hours", "global"], halo=2)
    expected = array.relevo.hours("2026-12-21", tz="UTC", bands=["hours", "global"])
    assert found.dims == ("band", "y", "x") and found.chunks[1:] == ((40, 40, 10),) * 2
    assert numpy.quantile(numpy.abs(found.values - expected.values), 0.98) < 0.05


def test_tasks_can_be_sent_to_other_processes():
    ground = pickle.loads(pickle.dumps(relevo._lazy._Ground(hills(30))))
    numpy.testing.assert_array_equal(
        ground.values("shadow", {"sun": (123, 6)}, (30, 30)), hills(30).relevo.shadow(sun=(123, 6)).values
    )


@pytest.mark.parametrize(
    "call, sentence",
    [
        *((lambda of, halo=halo: of.shadow(sun=(123, 6), halo=halo), "^halo: ") for halo in (0, -1, 1e4, float("nan"), float("inf"), "5")),
        (lambda of: of.shadow(sun=(123, 6), halo=1, clip=(0, 0, 1, 1)), "^halo: of all chunks, without clip= and progress="),
        (lambda of: of.shadow(sun=(123, 6), halo=1, progress=print), "^halo: of all chunks"),
        (lambda of: of.shadow(times=[]), "^times: expected a list of one or more"),
        (lambda of: of.shadow(times=["2026-12-21T14:00"]), "^time: .* has no time zone"),
        (lambda of: of.shadow(times=[float("nan")]), "^time: "),
        (lambda of: of.shadow(times=TIMES, sun=(123, 6)), "^expected one of time, times and sun"),
        (lambda of: of.shadow(), "^expected one of time, times and sun"),
        (lambda of: of.shadow(sun=(123, 96)), "^sun: 123.0,96.0: expected AZ,EL"),
        (lambda of: of.shadow(sun=(float("nan"), 6)), "^sun: "),
        (lambda of: of.shadow(sun=7), "^sun: expected"),
        (lambda of: of.shadow(sun=(123, 6), refraction="none"), "^sun: is a direction as seen"),
        (lambda of: of.shadow(TIMES, halo=1), "^time: "),
        (lambda of: of.horizons(0, halo=1), "^directions: "),
    ],
)
def test_bad_input_is_said_at_once(call, sentence):
    with pytest.raises(relevo.BadInput, match=sentence):
        call(hills(30).chunk(10).relevo)


def test_halos_are_of_chunks():
    with pytest.raises(relevo.BadInput, match="^halo: of arrays with chunks"):
        hills(30).relevo.shadow(sun=(123, 6), halo=1)


def test_arguments_are_those_of_the_figures():
    for name in ("hours", "shadow", "sky_view", "horizons"):
        mine = inspect.signature(getattr(relevo.xarray.Accessor, name)).parameters
        theirs = inspect.signature(getattr(relevo.SunOverDem, name)).parameters
        assert {key: (one.annotation, one.default, one.kind) for key, one in mine.items() if key != "halo"} == {
            key: (one.annotation, one.default, one.kind) for key, one in theirs.items()
        }
        assert list(mine) == [*list(theirs)[:-1], "halo", "progress"]
        assert "halo: of an array with chunks" in getattr(relevo.xarray.Accessor, name).__doc__


def test_again_of_many_times(dem):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        stack = dem.sun.shadow(times=TIMES)
    for raster in (stack, stack[stack.bands[1]]):
        made = relevo.again(raster)
        numpy.testing.assert_array_equal(made.values, raster.values)
        assert made.bands == raster.bands and made.about["options"] == raster.about["options"]
