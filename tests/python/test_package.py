"""The package as pip installs it, its version, and what it says where a library is missing."""

import os
import pathlib
import re
import subprocess
import sys
import zipfile

import pytest

import relevo
from conftest import BUILD, BUNDLED, SOURCE
from relevo import _library


def first(pattern, name):
    return re.search(pattern, (SOURCE / name).read_text(encoding="utf-8"), re.MULTILINE)[1]


def test_one_version():
    assert relevo.__version__ == first(r"^project\(relevo VERSION ([\d.]+) ", "CMakeLists.txt")
    assert relevo.__version__ == first(r"^## (\S+)", "CHANGELOG.md")
    assert relevo.__version__ == first(r"^version: (\S+)", "CITATION.cff")
    assert first(r"^date-released: \"(\S+)\"", "CITATION.cff") == first(r"RELEASE_DATE (\S+)\)", "packaging/CMakeLists.txt")


def test_import_is_quick():
    line = "import time, numpy; begin = time.process_time(); import relevo; print(time.process_time() - begin)"
    took_s = min(float(run(sys.executable, "-c", line).stdout) for _ in range(3))
    print(f"[ import ] {took_s:.3f} s of processor time")
    assert took_s < 0.3


def run(*command, **more):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600, **more)


def needed():
    """Names of the libraries that the library is linked with, but for those that Python itself needs."""
    text = run("readelf", "-d", BUILD / "lib/librelevo.so.0").stdout
    return sorted(set(re.findall(r"NEEDED.*\[(lib\S+)\]", text)) - {"libcrypto.so.3", "libm.so.6", "libz.so.1"})


def test_missing_libraries_are_named_by_their_package():
    """The package is Debian's for each library that ours needs."""
    names = needed()
    assert len(names) > 10
    places = dict(re.findall(r"^\s(\S+) \(.*x86-64.*\) => (\S+)", run("/sbin/ldconfig", "-p").stdout, re.MULTILINE))
    for name in names:
        if name not in places:
            continue
        path = pathlib.Path(places[name])
        owners = [run("dpkg-query", "-S", one).stdout for one in (path, path.resolve(), str(path).removeprefix("/usr"))]
        package = next((found.split(":")[0] for found in owners if found), None)
        said = f"{name}: cannot open shared object file: No such file or directory"
        assert package is None or _library._remedy(said) == f"apt install {package}", name


def test_a_missing_library_is_named(tmp_path):
    (tmp_path / "lib").mkdir()
    made = run(
        "gcc", "-shared", "-x", "c", "/dev/null", "-Wl,-soname,libnowhere3.so.7", "-o", tmp_path / "libnowhere3.so.7"
    )
    made = run(
        "gcc", "-shared", "-x", "c", "/dev/null", "-x", "none", "-Wl,--no-as-needed", tmp_path / "libnowhere3.so.7",
        "-o", tmp_path / "lib/librelevo.so.0",
    )
    assert made.returncode == 0, made.stderr
    (tmp_path / "libnowhere3.so.7").unlink()
    package = tmp_path / "relevo"
    package.mkdir()
    for file in (SOURCE / "bindings/python/relevo").iterdir():
        (package / file.name).symlink_to(file)
    (package / "lib").symlink_to(tmp_path / "lib")
    done = run(sys.executable, "-c", "import relevo", env={**os.environ, "PYTHONPATH": str(tmp_path)})
    assert done.returncode == 1
    assert "ImportError: relevo: its library does not load (libnowhere3.so.7: cannot" in done.stderr
    assert done.stderr.strip().endswith("apt install libnowhere3-7")


README_LINES = first(r"^```python\n((?:.*\n)*?)^```", "README.md")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Made by pip of pyproject.toml, and of what is built already."""
    folder = tmp_path_factory.mktemp("a wheel")
    made = run(
        sys.executable, "-m", "pip", "wheel", SOURCE, "--no-deps", "-w", folder, "--config-settings", f"build-dir={folder}/build",
        "--config-settings", "cmake.source-dir=tests/python/wheel",
        "--config-settings", f"cmake.define.RELEVO_BUILD={BUILD}",
    )
    if "from versions: none" in made.stderr or "No module named pip" in made.stderr:
        pytest.skip("needs pip, and scikit-build-core from the net")
    assert made.returncode == 0, made.stdout + made.stderr
    (file,) = folder.glob("*.whl")
    return file


def test_wheel(wheel, tmp_path):
    """One for every Python, with all that it needs, in two environments at once."""
    assert wheel.name.startswith(f"relevo-{relevo.__version__}-py3-none-linux_")
    with zipfile.ZipFile(wheel) as files:
        names = [name.partition("/")[2] for name in files.namelist()]
        for name in ("lib/librelevo.so.0", "lib/relevo/gdal.so", "share/relevo/shaders/terrain.frag.glsl"):
            assert name in names
        assert sum("librelevo.so" in name for name in names) == 1
        print(f"[ wheel ] {wheel.stat().st_size / 2**20:.0f} MiB, {len(names)} files")
    (tmp_path / "data/dem").mkdir(parents=True)
    (tmp_path / "data/dem/jacksboro.tif").symlink_to(BUNDLED)
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    runs = []
    for name in ("one", "the other"):
        python = tmp_path / name / "bin/python3"
        made = run(sys.executable, "-m", "venv", "--system-site-packages", tmp_path / name)
        if made.returncode:
            pytest.skip("needs python3-venv")
        made = run(python, "-m", "pip", "install", "--no-deps", "--no-index", wheel, env=environment)
        assert made.returncode == 0, made.stderr
        code = f"import relevo; print(relevo.__file__)\n{README_LINES}"
        runs.append(subprocess.Popen([python, "-W", "ignore", "-c", code], env=environment, cwd=tmp_path, text=True,
                                     stdout=subprocess.PIPE, stderr=subprocess.PIPE))
    for name, process in zip(("one", "the other"), runs):
        out, err = process.communicate(timeout=300)
        assert process.returncode == 0, err
        assert out.startswith(str(tmp_path / name)) and "13.15" in out, out
