#!/usr/bin/env python3
"""Builds the documentation as a site: tools/site.py BUILD_FOLDER [--linkcheck]

Pages are those of the repository, with their links to each other; the reference of commands is made by the program's build
(BUILD_FOLDER/generated/commands/reference). The site is in BUILD_FOLDER/site/html. --linkcheck also asks the net for every
address. Needs python3-sphinx, python3-myst-parser and python3-sphinx-rtd-theme.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Files that pages link to, besides pages.
LINKED = ("include/relevo/relevo.h", "core/dem/dry_land.cpp", "LICENSE", "locale/relevo.pot")


def copy(name, source):
    target = source / name
    target.parent.mkdir(parents=True, exist_ok=True)
    if (ROOT / name).is_dir():
        shutil.copytree(ROOT / name, target, ignore=shutil.ignore_patterns("site"))
    else:
        shutil.copy(ROOT / name, target)


def write_index(path, title, names):
    entries = "\n".join(names)
    path.write_text(f"# {title}\n\n```{{toctree}}\n:maxdepth: 1\n\n{entries}\n```\n", encoding="utf-8")


def put_together(build, source):
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    for name in ("README.md", "CHANGELOG.md", "docs", "data/README.md", "examples/library", "examples/notebook", *LINKED):
        copy(name, source)
    plugins = sorted(path.parent.name for path in ROOT.glob("plugins/*/README.md"))
    for plugin in plugins:
        copy(f"plugins/{plugin}/README.md", source)
        for picture in (ROOT / "plugins" / plugin).glob("*.jpg"):
            copy(picture.relative_to(ROOT), source)
    write_index(source / "plugins/index.md", "Effects", [f"{plugin}/README" for plugin in plugins])
    reference = build / "generated/commands/reference"
    if not reference.is_dir():
        sys.exit(f"{reference}: not there; build the target relevo_command_files first")
    shutil.copytree(reference, source / "reference")
    write_index(source / "reference/index.md", "Commands", sorted(path.stem for path in reference.glob("*.md")))
    shutil.copy(ROOT / "docs/site/index.md", source)


def sphinx(builder, source, site):
    return subprocess.run(["sphinx-build", "-q", "-W", "--keep-going", "-b", builder, "-c", ROOT / "docs/site",
                           "-d", site / "doctrees", source, site / builder]).returncode


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--linkcheck", action="store_true")
    given = parser.parse_args()
    site = given.build / "site"
    put_together(given.build, site / "source")
    status = sphinx("html", site / "source", site)
    if given.linkcheck:
        status = sphinx("linkcheck", site / "source", site) or status
    return status


if __name__ == "__main__":
    sys.exit(main())
