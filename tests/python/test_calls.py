"""Errors, warnings, Ctrl-C, threads and processes: never a crash of the interpreter, and all goes on after."""

import copy
import logging
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy
import pytest

import relevo
from relevo import _relevo


def hills(side):
    """A DEM of so many rows and columns."""
    row, column = numpy.mgrid[:side, :side]
    heights = 1000 + 400 * numpy.sin(row / 37) * numpy.cos(column / 23) + 50 * numpy.sin(column / 5)
    return relevo.open(heights, transform=(30, 0, 600000, 0, -30, 5200000), crs="EPSG:32632")


@pytest.fixture(scope="module")
def large():
    """A DEM on which figures take seconds."""
    with hills(1500) as opened:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            opened.sun.shadow("2026-06-21T07:00Z")  # reads the heights
        yield opened


WORK = {
    "hours": lambda dem, **more: dem.sun.hours(start="2026-06-20", end="2026-06-22", **more),
    "sky_view": lambda dem, **more: dem.sun.sky_view(360, **more),
    "shadow": lambda dem, **more: [dem.sun.shadow("2026-06-21T07:00Z", soft=True, **more) for _ in range(1000)],
}


def interrupted(work, delay_s):
    """How long a figure goes on after Ctrl-C [s]."""
    pressed = []

    def press():
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(delay_s, press)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            work()
        return time.monotonic() - pressed[0]
    finally:
        timer.cancel()
        timer.join()


@pytest.mark.parametrize("work", WORK)
@pytest.mark.parametrize("delay_s", [0.05, 1.0])
def test_keyboard_interrupt(large, work, delay_s):
    took_s = interrupted(lambda: WORK[work](large), delay_s)
    print(f"[ interrupt ] {work} after {delay_s} s: {1000 * took_s:.0f} ms (limit 200 on an idle machine)")
    assert took_s < 2  # on a machine that does other things, too
    assert large.sun.shadow("2026-06-21T07:00Z").values.max() == 1  # all goes on


def test_keyboard_interrupt_between_steps():
    """Steps of the library take a second on 9 million posts. Python does not wait for them."""
    with hills(3000) as dem:
        took_s = min(interrupted(dem.sun.sky_view, delay_s) for delay_s in (0.2, 0.3, 0.4))
        print(f"[ interrupt ] 9 million posts: {1000 * took_s:.0f} ms")
        assert took_s < 0.2


def test_progress(large):
    shares = []
    threads = set()

    def progress(share):
        shares.append(share)
        threads.add(threading.get_ident())

    large.sun.sky_view(72, progress=progress)
    assert len(shares) > 2 and shares == sorted(shares)
    assert 0 < shares[0] and shares[-1] <= 1
    assert threads == {threading.get_ident()}


def test_progress_that_cancels(large):
    with pytest.raises(relevo.Cancelled, match="cancelled"):
        large.sun.sky_view(360, progress=lambda share: False)


def test_progress_that_raises(large):
    def progress(share):
        raise ZeroDivisionError(share)

    with pytest.raises(ZeroDivisionError):
        large.sun.sky_view(360, progress=progress)
    with pytest.raises(relevo.BadCall, match="progress: expected a function"):
        large.sun.sky_view(progress=7)


def test_other_threads_go_on(large):
    """The GIL is given back: a thread of Python counts while figures and pictures are made."""
    for work in (lambda: large.sun.sky_view(36), lambda: large.capture(size=(640, 480), device="software")):
        count, over = 0, False

        def go_on():
            nonlocal count
            while not over:
                count += 1
                time.sleep(0.001)

        thread = threading.Thread(target=go_on)
        thread.start()
        begin = time.monotonic()
        work()
        took_s = time.monotonic() - begin
        over = True
        thread.join()
        print(f"[ GIL ] {count} steps of another thread in {took_s:.2f} s")
        assert count > 50 * took_s


def test_figures_on_threads(dem):
    expected = {hour: dem.sun.shadow(f"2026-12-21T{hour}:00Z").values for hour in (13, 15, 17, 19)}
    found = {}

    def make(hour):
        for _ in range(5):
            found[hour] = dem.sun.shadow(f"2026-12-21T{hour}:00Z").values

    threads = [threading.Thread(target=make, args=(hour,)) for hour in expected]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for hour, values in expected.items():
        numpy.testing.assert_array_equal(found[hour], values)


def test_warnings(dem):
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        with pytest.warns(relevo.Warning, match="mountains outside this DEM") as caught:
            dem.sun.hours("2026-06-21")
        assert caught[0].filename == __file__  # of the caller
        warnings.simplefilter("error")
        with pytest.raises(relevo.Warning, match="mountains outside"):
            dem.sun.hours("2026-06-21")


def test_log(dem, caplog):
    with caplog.at_level(logging.INFO, logger="relevo"):
        dem.capture(size=(32, 24), device="software")
    assert any(record.name == "relevo" and record.levelno == logging.INFO for record in caplog.records), caplog.text


def test_classes_of_errors():
    for kind in (relevo.BadCall, relevo.BadInput, relevo.NoDevice, relevo.Cancelled, relevo.OutOfMemory):
        assert issubclass(kind, relevo.Error)
    assert issubclass(relevo.BadInput, ValueError) and issubclass(relevo.OutOfMemory, MemoryError)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda dem: dem.sun.hours(), "expected one of date, start and end, or year"),
        (lambda dem: dem.sun.hours("2026-02-30"), "2026-02-30"),
        (lambda dem: dem.sun.hours("2026-06-21", year=2026), "expected one of"),
        (lambda dem: dem.sun.hours(20260621), "date: expected a date"),
        (lambda dem: dem.sun.hours(numpy.datetime64("NaT")), "NaT"),
        (lambda dem: dem.sun.hours("2026-06-21", bands=[]), "bands: expected"),
        (lambda dem: dem.sun.hours("2026-06-21", bands="houses"), "houses"),
        (lambda dem: dem.sun.hours("2026-06-21", bands=[3]), "bands: expected"),
        (lambda dem: dem.sun.hours("2026-06-21", tz="Mars/Olympus"), "Mars/Olympus"),
        (lambda dem: dem.sun.hours("2026-06-21", step=float("nan")), "step: Out of range"),
        (lambda dem: dem.sun.hours("2026-06-21", step="3min"), "step"),
        (lambda dem: dem.sun.shadow("noonish"), "noonish"),
        (lambda dem: dem.sun.shadow(None), "expected one of time, times and sun"),
        (lambda dem: dem.sun.shadow([None]), "time: expected"),
        (lambda dem: dem.sun.sky_view(3), "directions"),
        (lambda dem: dem.sun.sky_view(10**30), "directions"),
        (lambda dem: dem.sun.horizon(0, 0), "."),
        (lambda dem: dem.sun.horizon(float("nan"), 0), "^lat: "),
        (lambda dem: dem.sun.horizon(*dem.centre, step=0), "step"),
        (lambda dem: dem.sun.horizon(*dem.centre, azimuth=[float("inf")]), "finite"),
        (lambda dem: dem.height(91, 0), "^lat and lon: "),
    ],
)
def test_bad_input(dem, call, message):
    with pytest.raises(relevo.BadInput, match=message):
        call(dem)
    assert dem.sun.shadow("2026-12-21T14:00Z").values.max() == 1


def test_closed(path):
    dem = relevo.open(path)
    sun = dem.sun
    dem.close()
    dem.close()
    assert dem.closed and "closed" in repr(dem)
    for call in (dem.heights, lambda: dem.height(36, -84), sun.sky_view, dem.capture):
        with pytest.raises(relevo.BadCall, match="dem: closed"):
            call()
    with pytest.raises(relevo.BadCall):
        with relevo.open(path) as inside:
            pass
        inside.sun.shadow("2026-12-21T14:00Z")


def test_closed_while_in_use(large):
    other = relevo.open(large.heights().values, transform=large.transform, crs=large.crs)
    thread = threading.Timer(0.2, other.close)
    thread.start()
    assert other.sun.sky_view(36).values.max() <= 1
    thread.join()
    assert other.closed


def test_no_copies(dem):
    with dem.view(size=(32, 24), device="software") as view:
        for held in (dem, view):
            for attempt in (pickle.dumps, copy.copy, copy.deepcopy):
                with pytest.raises(TypeError, match="cannot be pickled"):
                    attempt(held)


def test_module_checks_its_arrays(dem):
    handle = dem._handle
    options = '{"time": "2026-12-21T14:00Z"}'
    read_only = numpy.zeros(dem.shape, numpy.float32)
    read_only.flags.writeable = False
    with pytest.raises(relevo.BadCall, match="type 'f' but got 'd'"):
        handle.shadow(options, numpy.zeros(dem.shape), None)
    with pytest.raises(relevo.BadCall, match="type 'f' but got '>f'"):
        handle.shadow(options, numpy.zeros(dem.shape, ">f4"), None)
    for array in (read_only, numpy.zeros((dem.shape[0], 2 * dem.shape[1]), numpy.float32)[:, ::2]):
        with pytest.raises((ValueError, BufferError)):
            handle.shadow(options, array, None)
    with pytest.raises(relevo.BadCall, match="count: expected 138632 elements but got 12"):
        handle.shadow(options, numpy.zeros(12, numpy.float32), None)
    with pytest.raises(TypeError):
        handle.shadow(options, None, None)
    with pytest.raises(TypeError):
        _relevo.Dem()
    with pytest.raises(relevo.BadCall, match="one length"):
        handle.height(numpy.zeros(3), numpy.zeros(3), numpy.zeros(2))


def run_python(text, *arguments):
    return subprocess.run([sys.executable, "-c", text, *arguments], capture_output=True, text=True, timeout=120)


FORKED = """
import os, relevo, sys
dem = relevo.open(sys.argv[1])
view = dem.view(size=(32, 24), device="software")
child = os.fork()
for call in (view.draw, lambda: dem.sun.sky_view(4), lambda: relevo.open(sys.argv[1])) if child == 0 else ():
    try:
        call()
    except relevo.BadCall as error:
        print(error, flush=True)
if child:
    assert os.waitpid(child, 0)[1] == 0
    assert view.draw().shape == (24, 32, 4)
"""


def test_forked_processes_are_told(path):
    done = run_python(FORKED, path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("this process was forked after relevo was used") == 3


SPAWNED = """
import multiprocessing, relevo, sys, warnings
def hours(path):
    warnings.simplefilter("ignore")
    return float(relevo.open(path).sun.hours("2026-06-21").values.mean())
"""


def test_spawned_processes(path, tmp_path):
    (tmp_path / "work.py").write_text(SPAWNED)
    code = (
        "import sys; sys.path.insert(0, sys.argv[2])\n"
        "import multiprocessing, relevo, work\n"
        "if __name__ == '__main__':\n"
        "    dem = relevo.open(sys.argv[1])\n"
        "    with multiprocessing.get_context('spawn').Pool(2) as pool:\n"
        "        print(pool.map(work.hours, [sys.argv[1]] * 2))\n"
    )
    script = tmp_path / "main.py"
    script.write_text(code)
    done = subprocess.run(
        [sys.executable, script, path, tmp_path], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("13.15") == 2


ENDS = """
import relevo, sys, threading, time, warnings
warnings.simplefilter("ignore")
dem = relevo.open(sys.argv[1])
view = dem.view(size=(32, 24), device="software")
def work():
    while True:
        dem.sun.sky_view(360)
        view.draw()
threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
"""


def test_python_ends_in_the_middle_of_work(path):
    done = run_python(ENDS, path)
    assert done.returncode == 0, done.stderr


def test_imports_nothing_else():
    done = run_python("import relevo, sys; print([m for m in ('xarray', 'rasterio', 'pandas') if m in sys.modules])")
    assert done.stdout.strip() == "[]", done.stderr
