"""Types and docstrings of the package."""

import inspect
import shutil
import subprocess

import pytest

import relevo
from conftest import BUILD, SOURCE

FOLDER = SOURCE / "bindings/python"


def mypy(*arguments):
    if not shutil.which("mypy"):
        pytest.skip("needs mypy")
    command = ["mypy", "--config-file", FOLDER / "mypy.ini", "--cache-dir", BUILD / "mypy_cache", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=FOLDER, timeout=600)


def test_the_package_is_typed():
    done = mypy("relevo")
    assert done.returncode == 0, done.stdout + done.stderr


def test_users_get_types(tmp_path):
    (tmp_path / "use.py").write_text(
        "import relevo\n"
        "dem = relevo.open('alps.tif')\n"
        "reveal_type(dem.capture(size=(4, 4)))\n"
        "reveal_type(dem.sun.hours('2026-06-21')['hours'].values)\n"
        "reveal_type(dem.sun.horizon(1, 2).distance)\n"
        "dem.capture(size='large')\n"
    )
    done = mypy(tmp_path / "use.py")
    lines = done.stdout.splitlines()
    assert 'Revealed type is "numpy.ndarray[Any, numpy.dtype[numpy.unsignedinteger' in lines[0], done.stdout
    assert "numpy.floating" in lines[1] and "numpy.floating" in lines[2]
    assert 'Argument "size" to "capture" of "Dem" has incompatible type "str"' in lines[3]
    assert len(lines) == 5


def public(holder):
    for name, value in vars(holder).items():
        if not name.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
            yield f"{holder.__name__}.{name}", value


def test_docstrings():
    for name in relevo.__all__:
        item = getattr(relevo, name)
        assert inspect.getdoc(item), name
        if inspect.isclass(item) or inspect.ismodule(item):
            for member, value in public(item):
                assert inspect.getdoc(value) or member.endswith(".closed"), member
