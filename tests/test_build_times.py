#!/usr/bin/env python3
"""Test of tools/build_times.py on a log of six commands."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).parent.parent / "tools" / "build_times.py"

LOG = """# ninja log v5
0\t2000\t1\tcore/dem/CMakeFiles/relevo_dem.dir/load.cpp.o\taa
1000\t2500\t1\tcore/dem/CMakeFiles/relevo_dem.dir/grid.cpp.o\tbb
0\t4000\t1\tcore/light/CMakeFiles/relevo_light.dir/raster/shadows.cpp.o\tcc
2500\t4500\t1\tdata/a.ktx2\tdd
2500\t4500\t1\tdata/b.ktx2\tdd
4500\t5000\t1\tbin/relevo\tee
0\t3000\t1\tcore/dem/CMakeFiles/relevo_dem.dir/load.cpp.o\tff
10\t20\t1
"""


def report_of(log, *options):
    with tempfile.TemporaryDirectory() as folder:
        if log is not None:
            (pathlib.Path(folder) / ".ninja_log").write_text(log)
        return subprocess.run([sys.executable, TOOL, folder, *options], capture_output=True, text=True)


class BuildTimes(unittest.TestCase):
    def test_adds_up_objects_and_other_commands(self):
        lines = report_of(LOG).stdout.splitlines()
        self.assertEqual(lines[0].split(), "compiling 8.5 s in 3 objects".split())
        self.assertEqual(lines[1].split()[:6], "other 2.5 s in 2 commands:".split())
        self.assertEqual(lines[2].split(), "wall clock 5.0 s".split())

    def test_names_the_slowest_objects(self):
        text = report_of(LOG, "--slowest", "2").stdout
        slowest = text.split("slowest objects\n")[1].split("\n\n")[0].splitlines()
        self.assertEqual([line.split()[2] for line in slowest],
                         ["core/light/raster/shadows.cpp", "core/dem/load.cpp"])

    def test_adds_up_folders(self):
        folders = report_of(LOG).stdout.split("folders\n")[1].splitlines()
        self.assertEqual([line.split() for line in folders],
                         [["4.5", "s", "core/dem", "(2)"], ["4.0", "s", "core/light", "(1)"]])

    def test_says_what_is_no_log(self):
        self.assertIn("not a log of Ninja", report_of("hello\n").stderr)
        missing = report_of(None)
        self.assertIn("cannot be read", missing.stderr)
        self.assertNotEqual(missing.returncode, 0)


if __name__ == "__main__":
    unittest.main()
