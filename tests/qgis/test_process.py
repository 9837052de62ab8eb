"""The plugin in qgis_process, as its users run it in batches."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from support import DEM, ROOT, relevo, scratch_environment, skip

# /usr/bin/qgis_process of Debian 12 passes an option that the program behind it does not have.
QGIS_PROCESS = shutil.which("qgis_process.bin") or shutil.which("qgis_process")
if not QGIS_PROCESS:
    skip("QGIS is not installed (package qgis): no qgis_process")


class Process(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._scratch.name)
        cls.environment = scratch_environment(cls.folder)
        cls.dem = str(cls.folder / "dem.tif")
        shutil.copy(DEM, cls.dem)
        enabled = cls.qgis("plugins", "enable", "relevo_provider")
        assert enabled.returncode == 0, enabled.stdout + enabled.stderr

    @classmethod
    def tearDownClass(cls):
        cls._scratch.cleanup()

    @classmethod
    def qgis(cls, *words):
        return subprocess.run([QGIS_PROCESS, *words], env=cls.environment, cwd=cls.folder, capture_output=True, text=True,
                              timeout=120)  # fmt: skip

    def test_lists_the_algorithms(self):
        listed = self.qgis("list").stdout
        for name in ("capture", "carpet", "horizon", "map", "shadow", "skyview", "sunhours"):
            self.assertIn(f"relevo:{name}\t", listed)

    def test_hours_have_the_bytes_of_the_program_and_a_style(self):
        output, expected = self.folder / "hours.tif", self.folder / "expected.tif"
        run = self.qgis("run", "relevo:sunhours", f"--INPUT={self.dem}", "--FROM=2026-06-21", f"--OUTPUT={output}")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        relevo("sun", "hours", self.dem, "--date", "2026-06-21", "-o", expected)
        self.assertEqual(output.read_bytes(), expected.read_bytes())
        self.assertIn("singlebandpseudocolor", output.with_suffix(".qml").read_text())
        self.assertIn("sun hours [h]", output.with_suffix(".qmd").read_text())
        self.assertIn("time zone America/New_York of the place", run.stdout)
        self.assertIn("mountains outside this DEM", run.stdout)

    def test_the_commands_of_the_documentation(self):
        lines = [line.split() for line in (ROOT / "docs" / "qgis.md").read_text().splitlines()]
        commands = [words[1:] for words in lines if words[:2] in (["qgis_process", "run"], ["qgis_process", "help"])]
        self.assertGreaterEqual(len(commands), 3)
        for words in commands:
            run = self.qgis(*words)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_bad_input_gets_the_sentence_of_the_program(self):
        output = self.folder / "bad.tif"
        run = self.qgis("run", "relevo:shadow", f"--INPUT={self.dem}", "--TIME=2026-06-21T12:00:00", "--ZONE=Nowhere/X",
                        f"--OUTPUT={output}")  # fmt: skip
        self.assertIn("time zone: Nowhere/X: no such time zone, expected", run.stderr)
        self.assertNotIn("Traceback", run.stdout + run.stderr)
        self.assertNotEqual(run.returncode, 0)
        self.assertFalse(os.path.exists(output))


if __name__ == "__main__":
    unittest.main()
