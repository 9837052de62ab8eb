#!/usr/bin/env python3
"""Checks the ranks of docs/architecture.md: who may include whom, and which layer owns which library.

Usage: check_layers.py ROOT. Prints every violation and exits with 1 if there is one.
"""

import pathlib
import re
import sys

RANK = {"base": 0, "geo": 1, "image": 1, "gl": 1, "json": 1, "shader": 1, "sky": 1, "dem": 2, "mesh": 2, "sun": 2, "climate": 2, "weather": 2, "film": 2, "light": 3, "overlay": 3, "names": 3, "effect": 3, "output": 4, "report": 4,
        "scene": 4, "zones": 4, "chart": 5, "figure": 5, "web": 5, "render": 6, "session": 7}

# Library headers, and the only layers of core/ that may include them. What is not listed is free.
OWNERS = {
    "GDAL or PROJ": (re.compile(r"(gdal|ogr_|cpl_|proj\.h|vrtdataset)"), {"geo", "dem", "output", "overlay", "zones"}),
    "GeographicLib": (re.compile(r"GeographicLib/"), {"geo"}),
    "ERFA": (re.compile(r"erfa"), {"sun"}),
    "libnova": (re.compile(r"libnova/"), {"sun"}),
    "date": (re.compile(r"date/"), {"sun"}),
    "GL": (re.compile(r"(epoxy/|EGL/|GL/)"), {"gl", "render"}),
    "OpenImageIO": (re.compile(r"OpenImageIO/"), {"image"}),
    "OpenEXR": (re.compile(r"(OpenEXR|Imath)/"), {"image"}),
    "libwebp": (re.compile(r"webp/"), {"image"}),
    "libheif": (re.compile(r"libheif/"), {"image"}),
    "FFmpeg": (re.compile(r"lib(av|sw)"), {"film"}),
    "Cairo": (re.compile(r"cairo"), {"chart"}),
    "zlib": (re.compile(r"zlib\.h"), {"climate", "names", "web"}),
    "utf8proc": (re.compile(r"utf8proc\.h"), {"names"}),
    "Expat": (re.compile(r"expat\.h"), {"dem"}),
    "libdeflate": (re.compile(r"libdeflate\.h"), {"image"}),
    "libpng": (re.compile(r"png\.h"), {"image"}),
}


# Rooms of a layer that see nothing of it but themselves, and what they may include.
ROOMS = {"light/sweep": {"base"}, "render/graph": {"base"}}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found.group(1), found.group(2)


def check_core(root):
    for path in sorted((root / "core").rglob("*")):
        if path.suffix not in {".h", ".cpp"}:
            continue
        layer = path.relative_to(root / "core").parts[0]
        where = path.relative_to(root)
        if layer not in RANK:
            yield f"{where}: {layer} is not a layer"
            continue
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".h" and "#pragma once" not in text:
            yield f"{where}: no #pragma once"
        for number, kind, name in includes(path):
            if kind == '"':
                other = name.split("/")[0]
                room = "/".join(path.relative_to(root / "core").parts[:2])
                if room in ROOMS and other not in ROOMS[room] and not name.startswith(room + "/"):
                    yield f"{where}:{number}: {room} includes {name}, but may see {', '.join(ROOMS[room])} alone"
                if other not in RANK:
                    yield f"{where}:{number}: {name} is not of core/"
                elif other != layer and RANK[other] >= RANK[layer]:
                    yield f"{where}:{number}: {layer} (rank {RANK[layer]}) includes {other} (rank {RANK[other]})"
            else:
                for library, (pattern, owners) in OWNERS.items():
                    if pattern.match(name) and layer not in owners:
                        yield f"{where}:{number}: {library} belongs to {', '.join(sorted(owners))}, not to {layer}"
                if path.suffix == ".h" and "/" in name and not name.startswith(("glm/", "relevo/", "sys/")):
                    yield f"{where}:{number}: a header of core shows {name}; only GLM and the plugin interface may be seen"


# Files that a stranger's file may name are opened by a checked type alone (base/allowed_name.h), in one place a library.
OPENS = re.compile(r"\b(GDALOpen(Ex|Shared)?|VSIFOpen(Ex)?L|ifstream|fopen|ImageInput::open)\b|\bInputStream \w+[({]")
OPENING_ROOMS = {"dem", "effect", "image", "output", "overlay", "scene", "session", "weather", "zones"}
OPENING_FILES = {"core/dem/gdal_open.cpp", "core/image/formats_openimageio.cpp"}  # and core/base/input_file.cpp


def check_opens(root):
    for layer in sorted(OPENING_ROOMS):
        for path in sorted((root / "core" / layer).rglob("*")):
            where = path.relative_to(root)
            if path.suffix not in {".h", ".cpp"} or str(where) in OPENING_FILES:
                continue
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                code = line.split("//")[0]
                if OPENS.search(code) and not code.startswith("RELEVO_GDAL("):
                    yield f"{where}:{number}: opens a file; use dem/gdal_open.h, base/input_file.h or image/image.h"


def check_plugins(root):
    for path in sorted((root / "plugins").glob("*/plugin.json")):
        if not (path.parent / "README.md").exists():
            yield f"{path.parent.relative_to(root)}: no README.md"
    allowed = {"base", "geo", "sky", "sun", "shader", "effect"}
    for path in sorted((root / "plugins").rglob("*")):
        if path.suffix not in {".h", ".cpp"} or "tests" in path.parts:
            continue
        for number, kind, name in includes(path):
            if kind == '"' and "/" in name and name.split("/")[0] not in allowed:
                yield f"{path.relative_to(root)}:{number}: a plugin includes {name}"


def check_names(root):
    """Core, app and bindings name no plugin: adding or removing one edits nothing else."""
    ids = [path.parent.name for path in (root / "plugins").glob("*/plugin.json")]
    if not ids:
        return
    quoted = re.compile(r'"(' + "|".join(map(re.escape, ids)) + r')"')
    for folder in ("core", "app", "bindings"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in {".h", ".cpp"}:
                for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                    # A hook may have the name of a plugin.
                    if quoted.search(line) and not line.strip().startswith("Hook{"):
                        yield f"{path.relative_to(root)}:{number}: names a plugin: {line.strip()}"


def main():
    root = pathlib.Path(sys.argv[1])
    violations = [*check_core(root), *check_opens(root), *check_plugins(root), *check_names(root)]
    print("\n".join(violations) if violations else "layers: clean")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
