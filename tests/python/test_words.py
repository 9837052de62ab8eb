"""Messages name Python's arguments, not options of the command line."""

import os
import re
import shutil
import subprocess
import sys

import numpy
import pytest

import relevo
from conftest import SOURCE
from relevo._words import python_words

OPTION = re.compile(r"--[a-z]|(?<![\w-])-[a-z](?![\w-])")  # not those of gdal_translate


@pytest.mark.parametrize(
    "said, read",
    [
        ("--unit: furlong: a unit of height", "unit: furlong: a unit of height"),
        ("the CRS is assumed; --crs sets another", "the CRS is assumed; crs= sets another"),
        ("pass --memory 200, or make tiles", "pass memory_mib=200, or make tiles"),
        ("a void; --nodata none keeps it", 'a void; nodata="none" keeps it'),
        ("or bound them with --highest", "or bound them with highest="),
        ("pass the right one with --crs EPSG:n", 'pass the right one with crs="EPSG:n"'),
        ("no date; write it or pass --date", "no date; write it or pass date="),
        ("pass --tz, as in --tz +02:00", "pass tz=, as in tz= +02:00"),
        ("--highest bounds them; --at for one", "highest= bounds them; lat and lon for one"),
        ("--panorama: add --eye LAT,LON", 'scene["camera"]["panorama"]: add scene["camera"]["eye"] LAT,LON'),
        ("haze: fails; --disable haze goes on", 'haze: fails; scene["effects"]["disable"] haze goes on'),
        ("relevo_shadow: options:1: soft: expected", "soft: expected"),
        ("/vsimem/relevo/12/heights.tif: is none", "heights: is none"),
        ("--unknown-word: is none", "unknown_word: is none"),
    ],
)
def test_words(said, read):
    assert python_words(said) == read


def test_no_message_of_the_library_names_an_option():
    """All texts of core/ that have one."""
    texts = []
    for file in sorted((SOURCE / "core").rglob("*.cpp")):
        texts += re.findall(r'"((?:[^"\\]|\\.)*--[a-z](?:[^"\\]|\\.)*)"', file.read_text(encoding="utf-8"))
    assert len(texts) > 100
    assert [text for text in texts if "--" in python_words(text) and not text.startswith("--- ")] == []


@pytest.mark.parametrize(
    "wrong",
    [
        lambda dem: dem.sun.hours("2026-06-21", tz="Europe/Zurih"),
        lambda dem: dem.sun.hours("2026-06-21", linke=3),
        lambda dem: dem.sun.hours(start="2026-06-21"),
        lambda dem: dem.sun.hours(start="2026-06-21", end="2026-01-01"),
        lambda dem: dem.sun.shadow("2026-06-21T12:00", tz="X"),
        lambda dem: dem.sun.shadow("sunset-30min"),
        lambda dem: dem.sun.shadow("2026-06-21T12:00Z", date="2026-06-21"),
        lambda dem: dem.capture("2026-06-21T12:00Z", size=(0, 1)),
        lambda dem: dem.view("2026-06-21T12:00Z", scene={"camera": {"panorama": "cylindrical"}}),
        lambda dem: dem.sun.horizon(0, 0),
        lambda dem: relevo.open(dem.name, band=4),
        lambda dem: relevo.open(dem.name, unit="furlong"),
        lambda dem: relevo.open(dem.name, crs="EPSG:4978"),
        lambda dem: relevo.open(dem.name, crop=(0, 0, 1, 1)),
        lambda dem: relevo.open(numpy.full((40, 50), 2e6), transform=(1, 0, 0, 0, -1, 0), crs=32632).sun.sky_view(),
        lambda dem: relevo.sun.events(47, 8, "2026-06-21", tz="nowhere"),
    ],
)
def test_errors(dem, wrong):
    with pytest.raises(relevo.BadInput) as raised:
        wrong(dem)
    text = str(raised.value)
    assert not OPTION.search(text) and "relevo_" not in text and "(text)" not in text and "from:" not in text, text


def test_errors_name_the_argument(dem):
    for wrong, name in (
        (lambda: dem.capture("2026-06-21T12:00Z", size=(0, 1)), "size: "),
        (lambda: dem.sun.hours("2026-06-21", tz="Europe/Zurih"), "tz: "),
        (lambda: dem.sun.hours(start="2026-06-21", end="2026-01-01"), "start: "),
        (lambda: relevo.open(dem.name, unit="furlong"), "unit: "),
    ):
        with pytest.raises(relevo.BadInput, match="^" + name):
            wrong()


def test_without_the_library(tmp_path):
    """The package as it lies in the source says how its library is built."""
    shutil.copytree(SOURCE / "bindings/python/relevo", tmp_path / "relevo")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", "import relevo"], capture_output=True, text=True, env=environment,
                          cwd=tmp_path, timeout=60)
    last = done.stderr.splitlines()[-1]
    assert last.startswith("ImportError: relevo: its library does not load") and "cmake --build build/release" in last
