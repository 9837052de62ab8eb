"""What the tests of the QGIS plugin share."""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLUGINS = ROOT / "bindings" / "qgis"
DEM = str(ROOT / "data" / "dem" / "jacksboro.tif")
PROGRAM = os.environ["RELEVO_PROGRAM"]
SKIPPED = 77  # exit status


def skip(why):
    """Ends the test as skipped."""
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def relevo(*words):
    """Runs the program itself."""
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True)


def scratch_environment(folder):
    """The environment of a QGIS that sees nothing of this user's, and has the program first on its PATH."""
    folders = {name: str(pathlib.Path(folder, name)) for name in ("HOME", "XDG_RUNTIME_DIR", "QGIS_CUSTOM_CONFIG_PATH")}
    for path in folders.values():
        pathlib.Path(path).mkdir(mode=0o700)
    return {
        **os.environ,
        **folders,
        "QT_QPA_PLATFORM": "offscreen",
        "QGIS_PLUGINPATH": str(PLUGINS),
        "PYTHONDONTWRITEBYTECODE": "1",
        "PATH": os.path.dirname(PROGRAM) + ":/usr/bin:/bin",
    }
