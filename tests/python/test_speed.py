"""What the package takes, as a ratio to the program. Times are printed and never fail a test."""

import subprocess
import sys
import time

import numpy
import pytest

import relevo

COMMANDS = {
    "hours of a year": (
        lambda path: ["sun", "hours", path, "--year", "2026", "-o", "out.tif"],
        "numpy.save('out.npy', dem.sun.hours(year=2026))",
    ),
    "sky view in 720 directions": (
        lambda path: ["sun", "sky-view", path, "--directions", "720", "-o", "out.tif"],
        "numpy.save('out.npy', dem.sun.sky_view(720))",
    ),
    "a picture": (
        lambda path: ["capture", path, "--size", "640x480", "--device", "software", "-o", "out.tif"],
        "numpy.save('out.npy', dem.capture(size=(640, 480), device='software'))",
    ),
}


@pytest.mark.parametrize("what", COMMANDS)
def test_whole_runs(path, program, tmp_path, what):
    """A script of Python, with its start and imports, and the program that does the same."""
    arguments, line = COMMANDS[what]
    script = f"import numpy, relevo, sys; dem = relevo.open(sys.argv[1]); {line}"
    best = {"program": numpy.inf, "package": numpy.inf}
    for _ in range(2):
        begin = time.monotonic()
        program(*arguments(path), "--overwrite", "-q")
        best["program"] = min(best["program"], time.monotonic() - begin)
        begin = time.monotonic()
        subprocess.run([sys.executable, "-W", "ignore", "-c", script, path], cwd=tmp_path, check=True, timeout=300)
        best["package"] = min(best["package"], time.monotonic() - begin)
    ratio = best["package"] / best["program"]
    print(f"[ speed ] {what}: {best['package']:.2f} s, {ratio:.2f} of the program's {best['program']:.2f} s (aim 1.05)")


def test_calls(dem):
    """What Python adds to a call."""
    for what, call in (
        ("dem.height()", lambda: dem.height(*dem.centre)),
        ("sun.position() of a time", lambda: relevo.sun.position(47, 8, 0)),
    ):
        call()
        begin = time.monotonic()
        for _ in range(1000):
            call()
        print(f"[ speed ] {what}: {1000 * (time.monotonic() - begin):.0f} microseconds")
    times = numpy.arange(100_000.0)
    begin = time.monotonic()
    relevo.sun.position(47, 8, times)
    print(f"[ speed ] sun.position() of 100,000 times: {time.monotonic() - begin:.2f} s")
