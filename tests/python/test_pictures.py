"""Pictures of the package are those of the program, byte by byte."""

import ctypes
import pathlib
import resource
import threading

import numpy
import pytest

import relevo

TIME = "2026-06-21T20:00Z"


def test_capture(dem, captured):
    picture = dem.capture(time=TIME, size=(128, 96), device="software")
    assert picture.dtype == numpy.uint8 and picture.shape == (96, 128, 4)
    numpy.testing.assert_array_equal(picture, captured("--time", TIME, "--size", "128x96"))


def test_capture_of_local_time(dem, captured):
    picture = dem.capture("2026-06-21T18:30", (96, 64), tz="America/New_York", device="software")
    expected = captured("--time", "2026-06-21T18:30", "--tz", "America/New_York", "--size", "96x64")
    numpy.testing.assert_array_equal(picture, expected)


def test_view_that_changes(dem, captured):
    with dem.view(TIME, (128, 96), scene={"effects": {"disable": ["haze"]}}, device="software") as view:
        numpy.testing.assert_array_equal(
            view.draw(), captured("--time", TIME, "--size", "128x96", "--disable", "haze")
        )
        view.set(
            "2026-06-21T12:30Z",
            camera={"orbit": {"azimuth": 300, "elevation": 20}},
            exaggeration=2,
            scene='{"picture": {"transparent": true, "samples": 4}}',
        )
        expected = captured(
            "--time", "2026-06-21T12:30Z", "--size", "128x96", "--view", "az=300,el=20", "--exaggerate", 2,
            "--disable", "haze", "--transparent", "--samples", 4,
        )
        numpy.testing.assert_array_equal(view.draw(), expected)
        assert view.scene["time"]["at"] == "2026-06-21T12:30:00Z"
        assert view.scene["exaggeration"] == 2
        view.set(size=(80, 60))
        assert view.size == (80, 60)
        assert view.draw().shape == (60, 80, 4)


def test_maps_have_their_own_size(dem, captured):
    with dem.view(TIME, (128, 96), scene={"picture": {"ortho": True}}, device="software") as view:
        columns, rows = view.size
        assert view.draw().shape == (rows, columns, 4)
        numpy.testing.assert_array_equal(view.draw(), captured("--time", TIME, "--size", "128x96", "--ortho"))


def test_layers(dem):
    with dem.view(TIME, (160, 120), device="software") as view:
        layers = view.layers()
        ground = numpy.isfinite(layers.depth)
        assert layers.depth.shape == (120, 160) and layers.positions.shape == layers.normals.shape == (120, 160, 3)
        assert ground.mean() > 0.1
        assert numpy.isnan(layers.positions[~ground]).all()
        lengths = numpy.linalg.norm(layers.normals[ground], axis=1)
        assert numpy.all((lengths < 1e-6) | (abs(lengths - 1) < 0.01))
        assert layers.origin[:2] == pytest.approx(dem.centre, abs=1e-9)
        # Up of a place near the middle is its height.
        east, north, up = layers.positions[ground][numpy.argmin(numpy.hypot(*layers.positions[ground].T[:2]))]
        lat = layers.origin[0] + numpy.degrees(north / 6.36e6)
        lon = layers.origin[1] + numpy.degrees(east / (6.378e6 * numpy.cos(numpy.radians(lat))))
        assert up + layers.origin[2] == pytest.approx(dem.height(lat, lon), abs=60)
        numpy.testing.assert_array_equal(view.depth(), layers.depth)
        numpy.testing.assert_array_equal(view.normals(), layers.normals)
        numpy.testing.assert_array_equal(view.positions(), layers.positions)
        view.set(scene={"camera": {"stereo": "anaglyph"}})
        with pytest.raises(relevo.BadInput, match="not of stereo pairs"):
            view.depth()


def test_error_leaves_the_scene(dem):
    with dem.view(TIME, (64, 48), device="software") as view:
        before, scene = view.draw(), view.scene
        for change in (
            {"exaggerate": 2},
            {"effects": {"enable": ["nothing"]}},
            {"dem": {"files": ["other.tif"]}},
            "{",
            "[]",
            {"time": 3},
            {"picture": {"exposure": float("nan")}},
            {"picture": {"exposure": object()}},
        ):
            with pytest.raises(relevo.BadInput):
                view.set(scene=change)
        for size in ((0, 10), (64,), "64x48", (1 << 40, 4), 7):
            with pytest.raises(relevo.BadInput):
                view.set(size=size)
        assert view.scene == scene
        numpy.testing.assert_array_equal(view.draw(), before)


def test_views_outlive_their_dem(path):
    dem = relevo.open(path)
    view = dem.view(TIME, (64, 48), device="software")
    before = view.draw()
    dem.close()
    numpy.testing.assert_array_equal(view.draw(), before)
    view.close()
    with pytest.raises(relevo.BadCall, match="view: closed"):
        view.draw()
    with pytest.raises(relevo.BadCall, match="dem: closed"):
        dem.view()


def test_no_device(dem):
    with pytest.raises(relevo.NoDevice):
        dem.view(device="no such GPU")


def test_views_on_threads(dem):
    times = [f"2026-06-21T{hour}:00Z" for hour in (12, 14, 16, 18)]
    together = {}

    def draw(time):
        with dem.view(time, (96, 64), device="software") as view:
            for _ in range(3):
                together[time] = view.draw()

    threads = [threading.Thread(target=draw, args=(time,)) for time in times]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for time in times:
        numpy.testing.assert_array_equal(together[time], dem.capture(time, (96, 64), device="software"))


def resident_mib():
    """Memory that is in use [MiB]: what was freed goes back to the system first, as how much of it stays is chance."""
    ctypes.CDLL(None).malloc_trim(0)
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def growth_mib(do_some):
    """The least of three stretches: a leak is in each of them, buffers of threads that end come and go."""
    do_some()
    held = [resident_mib()]
    for _ in range(3):
        do_some()
        held.append(resident_mib())
    return min(after - before for before, after in zip(held, held[1:]))


def test_memory_of_400_pictures(dem):
    with dem.view(TIME, (64, 48), device="software") as view:

        def draw_100():
            for i in range(100):
                view.set(f"2026-06-{1 + i % 28:02}T{11 + i % 10}:{i % 60:02}Z")
                view.draw()

        grown = growth_mib(draw_100)
    print(f"[ memory ] 100 pictures: {grown:.1f} MiB more (limit 1)")
    assert grown < 1


def test_memory_of_views(dem):
    def open_10():
        for _ in range(10):
            dem.capture(TIME, (32, 24), device="software")

    grown = growth_mib(open_10)
    print(f"[ memory ] 10 views opened and closed: {grown:.1f} MiB more (limit 10)")
    assert grown < 10  # a view holds 50
