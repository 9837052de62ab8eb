"""What the QGIS plugin asks of the program, without QGIS."""

import os
import pathlib
import re
import stat
import sys
import tempfile
import time
import unittest

from support import DEM, PLUGINS, PROGRAM, ROOT, relevo

sys.path.insert(0, str(PLUGINS))
from relevo_provider import program, ramps  # noqa: E402
from relevo_provider.backend import Cancelled, Dem, Picture, RelevoError, Watch  # noqa: E402


class Listener(Watch):
    """Keeps what it hears. Cancels as soon as there is progress if `cancels`."""

    def __init__(self, cancels=False):
        self.shares, self.infos, self.warnings = [], [], []
        self.cancels = cancels

    def progress(self, share):
        self.shares.append(share)

    def is_cancelled(self):
        return self.cancels and bool(self.shares)

    def info(self, text):
        self.infos.append(text)

    def warning(self, text):
        self.warnings.append(text)


def processes_of(word):
    """Numbers of the processes that have a word on their command line."""
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if word in (folder / "cmdline").read_bytes().decode(errors="replace").split("\0"):
                found.append(folder.name)
        except OSError:
            pass
    return found


class Backend(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.backend = program.Program(PROGRAM)
        self.watch = Listener()

    def path(self, name):
        return str(self.folder / name)

    def raster(self, figure, options, dem=Dem(DEM), bounds=None):
        self.backend.raster(figure, dem, options, bounds, self.path("a.tif"), self.watch)

    def script(self, text):
        """A program of the shell in the place of Relevo."""
        path = self.folder / "relevo"
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return program.Program(str(path))

    def expect_same(self, made, *words):
        """A file has the bytes that the program writes."""
        relevo(*words, "-o", self.path("expected.tif"))
        self.assertEqual(pathlib.Path(made).read_bytes(), pathlib.Path(self.path("expected.tif")).read_bytes())

    def test_shadows_are_those_of_the_program(self):
        self.raster("shadow", {"time": "2026-12-21T09:00:00", "soft": False})
        self.expect_same(self.path("a.tif"), "sun", "shadow", DEM, "--time", "2026-12-21T09:00:00")
        self.assertIn("time zone America/New_York of the place; --tz sets another", self.watch.infos)
        self.assertTrue(any(text.startswith("mountains outside this DEM") for text in self.watch.warnings))

    def test_shadows_of_a_part_at_an_event(self):
        options = {"time": "sunset-30min", "date": "2026-12-21", "zone": "+01:00", "soft": True}
        self.raster("shadow", options, Dem(DEM, unit="ft"), (-84.3, 36.2, -84.2, 36.3))
        self.expect_same(self.path("a.tif"), "sun", "shadow", DEM, "--unit", "ft", "--soft", "--time", "sunset-30min",
                         "--date", "2026-12-21", "--tz", "+01:00", "--clip=-84.3,36.2,-84.2,36.3")  # fmt: skip

    def test_hours_are_those_of_the_program(self):
        what = {"bands": ["first", "global"], "step": 600, "linke": 4, "albedo": 0.5}
        self.raster("hours", {"start": "2026-03-01", "end": "2026-03-02", **what})
        self.expect_same(self.path("a.tif"), "sun", "hours", DEM, "--from", "2026-03-01", "--to", "2026-03-02", "--bands",
                         "first,global", "--step", "10min", "--linke", 4, "--albedo", 0.5)  # fmt: skip

    def test_sky_views_are_those_of_the_program(self):
        self.raster("sky_view", {"directions": 8, "level": True})
        self.expect_same(self.path("a.tif"), "sun", "sky-view", DEM, "--directions", 8, "--level")

    def test_surroundings_shade_a_part(self):
        crop = "--crop=-84.3,36.2,-84.2,36.3"
        self.raster("sky_view", {"directions": 8}, Dem(DEM, options=[crop], surroundings=DEM))
        self.expect_same(self.path("a.tif"), "sun", "sky-view", DEM, crop, "--surroundings", DEM, "--directions", 8)
        self.assertTrue(any(text.startswith("surroundings: ") for text in self.watch.infos), self.watch.infos)

    def test_progress_rises(self):
        self.raster("hours", {"date": "2026-06-21", "bands": ["hours"], "step": 30})
        self.assertGreater(len(self.watch.shares), 1)
        self.assertEqual(self.watch.shares, sorted(self.watch.shares))
        self.assertTrue(all(0 < share < 1 for share in self.watch.shares))

    def test_errors_are_the_sentences_of_the_program(self):
        with self.assertRaisesRegex(RelevoError, "^/no/such.tif: no such file; there is no folder /no$"):
            self.raster("sky_view", {"directions": 36}, Dem("/no/such.tif"))
        with self.assertRaisesRegex(RelevoError, "^(time zone|tz): Nowhere/X: no such time zone, expected "):
            self.raster("shadow", {"time": "2026-06-21T12:00", "zone": "Nowhere/X"})
        with self.assertRaisesRegex(RelevoError, "^/no/relevo: cannot be run: No such file or directory$"):
            program.Program("/no/relevo").description()
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_program_without_a_message_is_named(self):
        for text, expected in (("kill -SEGV $$", "the signal SIGSEGV"), ("exit 7", "status 7")):
            with self.assertRaisesRegex(RelevoError, expected):
                self.script(text).description()

    def test_cancelling_ends_the_work(self):
        watch = Listener(cancels=True)
        output = self.path("year.tif")
        began = time.monotonic()
        with self.assertRaises(Cancelled):
            options = {"year": 2026, "bands": ["hours", "global"]}
            self.backend.raster("hours", Dem(DEM), options, None, output, watch)
        self.assertLess(time.monotonic() - began, 10)
        self.assertEqual(processes_of(output), [])
        self.assertEqual(os.listdir(self.folder), [])

    def test_cancelling_ends_a_program_that_ignores_it_and_what_it_has_started(self):
        mark = f"{time.time_ns() % 10**9 + 10**6}.5"  # seconds, and a word of its own
        backend = self.script(f"trap '' TERM\necho progress 0.5 >&2\nsleep {mark} &\nwait\nsleep 100\n")
        patience, program._PATIENCE_S = program._PATIENCE_S, 0.3
        self.addCleanup(setattr, program, "_PATIENCE_S", patience)
        with self.assertRaises(Cancelled):
            backend.raster("sky_view", Dem(DEM), {}, None, self.path("a.tif"), Listener(cancels=True))
        self.assertEqual(processes_of(mark), [])

    def test_horizons_of_points_and_why_there_is_none(self):
        inside, outside = self.backend.horizons(Dem(DEM), [(36.3, -84.2), (10, 10)], 2, 45, self.watch)
        self.assertEqual([one.azimuth_deg for one in inside], [0, 45, 90, 135, 180, 225, 270, 315])
        text = relevo("sun", "horizon", DEM, "--at", "36.3,-84.2", "--eye-height", 2, "--step", 45, "--csv").stdout
        rows = [line.split(",") for line in text.splitlines() if line[0].isdigit()]
        for one, row in zip(inside, rows):
            self.assertAlmostEqual(one.horizon_deg, float(row[1]), delta=1e-4)
        self.assertTrue(outside.startswith("horizon: 10,10: outside of the DEM"), outside)

    def test_pictures(self):
        picture = Picture(
            {"time": "2026-06-21T18:30:00"}, (320, 200), side="north", elevation_deg=45, zoom=1.5, exaggeration=2,
            preset="relief", enable=["contours"], disable=["haze"], values={"contours.interval_m": "50"}, stamps=["date"],
        )  # fmt: skip
        self.backend.capture(Dem(DEM), picture, self.path("a.png"), self.watch)
        words = next(text for text in self.watch.infos if "capture" in text)
        for part in ("--size 320x200", "--view north,el=45,zoom=1.5", "--exaggerate 2", "--preset relief",
                     "--enable contours", "--disable haze", "--set contours.interval_m=50", "--stamp date"):  # fmt: skip
            self.assertIn(part, words)
        self.assertEqual(pathlib.Path(self.path("a.png")).read_bytes()[:4], b"\x89PNG")

    def test_the_year_at_a_point_is_a_diagram_and_a_table(self):
        self.backend.carpet(Dem(DEM), (36.3, -84.2), 2026, "solar", self.path("a.svg"), self.path("a.csv"), self.watch)
        expected = relevo("sun", "carpet", DEM, "--at", "36.3,-84.2", "--year", 2026, "--tz", "solar", "--csv").stdout
        self.assertEqual(pathlib.Path(self.path("a.csv")).read_text(), expected)
        self.assertTrue(pathlib.Path(self.path("a.svg")).read_text().lstrip().startswith("<"))

    def test_the_program_is_that_of_the_setting_or_on_the_path(self):
        self.assertEqual(program.find(PROGRAM), PROGRAM)
        self.assertIsNone(program.find("/no/relevo"))
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = os.path.dirname(PROGRAM)
        self.assertEqual(program.find(""), PROGRAM)
        os.environ["PATH"] = "/"
        self.assertIsNone(program.find(""))


class Copies(unittest.TestCase):
    """What the plugin has in a second place."""

    def test_ramps_are_those_of_the_program(self):
        text = (ROOT / "core" / "chart" / "ramp.cpp").read_text()
        for name, stops in ramps.RAMPS.items():
            found = re.search(r'\{"%s",\s*\{(.*?)\}\}(?:,|\s)' % name, text, re.DOTALL)
            pairs = re.findall(r"\{0x(\w{6})(?:, ([0-9.]+))?\}?", found.group(1))
            self.assertEqual([(rgb, float(opacity or 1)) for rgb, opacity in pairs], stops, name)

    def test_the_icon_is_that_of_the_program(self):
        icon = ROOT / "packaging" / "desktop" / "org.relevo.Relevo.svg"
        self.assertEqual((PLUGINS / "relevo_provider" / "icon.svg").read_text(), icon.read_text())

    def test_the_version_is_that_of_the_project(self):
        text = (PLUGINS / "relevo_provider" / "metadata.txt").read_text()
        self.assertIn(f"\nversion={os.environ['RELEVO_VERSION']}\n", text)


if __name__ == "__main__":
    unittest.main()
