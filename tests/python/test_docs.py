"""What docs/python.md and the notebook show runs."""

import json
import os
import re
import shutil
import subprocess
import sys
import warnings

import pytest

import relevo
from conftest import SOURCE

PAGE = SOURCE / "docs/python.md"
NOTEBOOK = SOURCE / "examples/notebook/sun_on_real_ground.ipynb"


@pytest.fixture
def beside_the_dem(path, tmp_path, monkeypatch):
    """The working folder has the DEM of the examples."""
    shutil.copy(path, tmp_path / "jacksboro.tif")
    monkeypatch.chdir(tmp_path)


def test_page(beside_the_dem):
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert len(blocks) >= 5
    names = {}
    for block in blocks:
        exec(compile(block, PAGE.name, "exec"), names)
    assert names["picture"].shape == (240, 320, 4)
    assert names["light"].unit == "kWh/m2"
    assert names["hours"].dims == ("y", "x")


def test_page_names_every_error():
    page = PAGE.read_text(encoding="utf-8")
    for name in relevo.__all__:
        if isinstance(getattr(relevo, name), type) and issubclass(getattr(relevo, name), (relevo.Error, relevo.Warning)):
            assert f"relevo.{name}`" in page, name


def cells():
    return json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]


def test_notebook_has_no_outputs():
    for cell in cells():
        if cell["cell_type"] == "code":
            assert cell["outputs"] == [] and cell["execution_count"] is None


def test_notebook(beside_the_dem, tmp_path):
    if shutil.which("jupyter-nbconvert") and subprocess.run([sys.executable, "-c", "import ipykernel"]).returncode == 0:
        command = ["jupyter-nbconvert", "--execute", "--to", "html", "--output-dir", str(tmp_path), str(NOTEBOOK)]
        command += [f"--ExecutePreprocessor.cwd={tmp_path}"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr
        return
    pyplot = pytest.importorskip("matplotlib.pyplot", reason="needs python3-matplotlib")
    pyplot.switch_backend("Agg")
    names = {}
    for cell in cells():
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), NOTEBOOK.name, "exec"), names)
    folder = os.environ.get("RELEVO_NOTEBOOK_PICTURES")  # for who wants to see them
    for number in pyplot.get_fignums():
        if folder:
            pyplot.figure(number).savefig(f"{folder}/{number}.png")
    assert len(pyplot.get_fignums()) == 4
    pyplot.close("all")
