#!/usr/bin/env python3
"""Takes the pictures of docs/gallery.md that have a command below them.

    tools/gallery.py --dems FOLDER [BUILD] [--only dawn_valley,storm_air]      BUILD: build/release (default)

FOLDER has the DEMs under the names that the commands use. Writes docs/images/. --check takes none and reports pictures
of the sections "Light and weather" without a command, without a file or with another's name.
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/gallery.md"
SIZE = "960x540"


def pictures(text):
    """(file in docs/, words of its command or [] where none follows) of each picture on a line of its own."""
    found = []
    for match in re.finditer(r"^!\[[^\]]*\]\(([^)]+)\)\n\n((?:(?:    | {8}).*\n)*)", text, re.MULTILINE):
        found.append((match[1], shlex.split(match[2].replace("\\\n", " "))))
    return found


def faults(section):
    """What is wrong with the pictures of the section, a sentence each."""
    result = []
    for path, words in pictures(section):
        name = pathlib.Path(path).name
        if words[:2] != ["relevo", "capture"]:
            result.append(f"{path}: no command below it")
        elif "-o" not in words or words[words.index("-o") + 1] != name:
            result.append(f"{path}: its command does not write {name}")
        if not (PAGE.parent / path).exists():
            result.append(f"{path}: no such file")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--dems", type=pathlib.Path, help="folder of DEMs")
    parser.add_argument("--only", help="names of pictures, by commas")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    section = PAGE.read_text().partition("\n## Light and weather\n")[2].partition("\n## ")[0]
    if arguments.check:
        wrong = faults(section) or ([] if section else ["docs/gallery.md: no section \"Light and weather\""])
        print("\n".join(wrong), end="\n" if wrong else "")
        return 1 if wrong else 0
    if not arguments.dems:
        parser.error("--dems is required")
    only = arguments.only.split(",") if arguments.only else None
    for path, words in pictures(section):
        if only and pathlib.Path(path).stem not in only:
            continue
        words = words[2:]
        words[0] = arguments.dems / words[0]
        words[words.index("-o") + 1] = PAGE.parent / path
        subprocess.run([arguments.build.resolve() / "bin/relevo", "-q", "capture", *words, "--size", SIZE, "--overwrite",
                        "--device", "software"], check=True)
        print(path, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
