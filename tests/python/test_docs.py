"""What docs/python.md and the notebooks show runs."""

import importlib.util
import json
import os
import re
import shutil
import subprocess
import time

import pytest

import relevo
from conftest import SOURCE

PAGE = SOURCE / "docs/python.md"
NOTEBOOKS = sorted((SOURCE / "examples/notebook").glob("*.ipynb"))


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


def cells(notebook):
    return json.loads(notebook.read_text(encoding="utf-8"))["cells"]


def test_there_are_three_notebooks():
    assert len(NOTEBOOKS) == 3


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=[one.stem for one in NOTEBOOKS])
def test_notebook_has_no_outputs(notebook):
    for cell in cells(notebook):
        if cell["cell_type"] == "code":
            assert cell["outputs"] == [] and cell["execution_count"] is None


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=[one.stem for one in NOTEBOOKS])
def test_notebook(notebook, beside_the_dem):
    """By Python alone; a cell that needs a package says so in its first line."""
    pyplot = pytest.importorskip("matplotlib.pyplot", reason="needs python3-matplotlib")
    pytest.importorskip("pandas", reason="needs python3-pandas")
    pyplot.switch_backend("Agg")
    names, skipped, began = {}, [], time.monotonic()
    for cell in cells(notebook):
        source = "".join(cell["source"])
        needed = re.match(r"# needs (\w+)\n", source)
        if needed and importlib.util.find_spec(needed[1]) is None:
            skipped.append(needed[1])
        elif cell["cell_type"] == "code":
            exec(compile(source, notebook.name, "exec"), names)
    took_s = time.monotonic() - began
    folder = os.environ.get("RELEVO_NOTEBOOK_PICTURES")  # for who wants to see them
    figures = pyplot.get_fignums()
    for number in figures:
        if folder:
            pyplot.figure(number).savefig(f"{folder}/{notebook.stem}_{number}.png")
    pyplot.close("all")
    print(f"{notebook.stem}: {took_s:.1f} s, {len(figures)} figures, without {skipped or 'nothing'}")
    assert took_s < 20
    assert len(figures) >= 3


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=[one.stem for one in NOTEBOOKS])
def test_notebook_in_jupyter(notebook, beside_the_dem, tmp_path):
    if not shutil.which("jupyter-nbconvert") or not importlib.util.find_spec("ipykernel"):
        pytest.skip("needs jupyter-nbconvert and ipykernel")
    copy = shutil.copy(notebook, tmp_path)  # it runs in its own folder
    command = ["jupyter-nbconvert", "--execute", "--to", "html", copy]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
