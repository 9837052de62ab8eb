#!/usr/bin/env python3
"""Writes docs/plugin-reference.md from the shaders that plugins are written against.

    tools/plugin_reference.py           writes the file
    tools/plugin_reference.py --check   exit status 1 if it is not up to date
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIB = ROOT / "shaders/lib"
TARGET = ROOT / "docs/plugin-reference.md"
FIRST_RELEASE = "0.1"
# Files that only core includes.
CORE_ONLY = {"exposed.glsl", "finite.glsl", "frame.glsl", "moved.glsl", "octahedral.glsl", "overlay.glsl", "pages.glsl", "raster.glsl", "shown.glsl",
             "tile.glsl", "types.glsl"}

# Of files with many functions, those that are for plugins.
LISTED = {"air.glsl": {"air_radiance", "air_radiance_of_sky", "air_ground", "air_between_eye_and"}, "lines.glsl": {"lines_near"}}

HEAD = """# What plugins can read

Members and functions for the GLSL of plugins, written by `tools/plugin_reference.py` from `shaders/lib`. How they are used is in
[Writing a plugin](plugin-guide.md). *Since* is the version of Relevo that brought an entry; entries are only ever added.

Positions are metres in the local frame of the DEM's centre: x east, y north, z up. Radiance 1 is what a white diffuse surface facing
the sun outside the atmosphere reflects. Units are in brackets.
"""


def cells(*texts):
    return "| " + " | ".join(text.replace("|", "\\|") for text in texts) + " |"


def since(comment):
    """Splits `(since 0.2)` off the end of a comment."""
    match = re.search(r"\s*\(since ([0-9.]+)\)$", comment)
    return (comment[:match.start()], match.group(1)) if match else (comment, FIRST_RELEASE)


def members(body):
    """Declarations of a struct or block: type, name and comment, which may go on in lines of its own."""
    found = []
    for line in body.splitlines():
        declared = re.match(r"\s*(\w+)\s+([\w\[\], ]+);\s*(?://\s*(.*))?$", line)
        more = re.match(r"\s*//\s*(.*)$", line)
        if declared:
            found.append([declared.group(1), declared.group(2), declared.group(3) or ""])
        elif more and found:
            found[-1][2] += " " + more.group(1)
    return found


def table(rows):
    lines = [cells("member", "type", "meaning", "since"), "|---|---|---|---|"]
    for kind, name, comment in rows:
        text, version = since(comment.strip())
        lines.append(cells(f"`{name}`", f"`{kind}`", text, version))
    return "\n".join(lines)


def structs(text):
    """Name, comment and body of each struct."""
    pattern = r"((?:^///[^\n]*\n)+)struct (\w+) \{\n(.*?)\n\};"
    return [(m.group(2), " ".join(line[3:].strip() for line in m.group(1).splitlines()), m.group(3))
            for m in re.finditer(pattern, text, re.S | re.M)]


def functions(text):
    """Signature and comment of each function that has a comment of its own."""
    pattern = r"((?:^///.*\n)+)^([\w]+ \w+\([^{;]*\)) \{"
    for match in re.finditer(pattern, text, re.M):
        comment = " ".join(line[3:].strip() for line in match.group(1).splitlines())
        comment = re.sub(r"@param ([\w, ]+?)\s\s+|@param (\w+)\s+", lambda m: f"*{m.group(1) or m.group(2)}*: ", comment).replace("@returns ", "Returns ")
        signature = re.sub(r"\s+", " ", match.group(2))
        yield signature, comment


def reference():
    types = (LIB / "types.glsl").read_text()
    parts = [HEAD]
    for name, comment, body in structs(types):
        parts.append(f"## {name}\n\n{comment}\n\n{table(members(body))}\n")
    frame = (LIB / "frame.glsl").read_text()
    block = re.search(r"uniform Frame \{\n(.*?)\n\} frame;", frame, re.S).group(1)
    parts.append("## frame\n\nValues that are the same for every pixel of a frame: `frame.sun_direction`. Every hook can read them.\n")
    for name, comment, body in re.findall(r"^ */// (\w+): (.*)\n((?:(?! */// ).*\n?)*)", block, re.M):
        parts.append(f"**{name}**: {comment}\n\n{table(members(body))}\n")
    parts.append("## Library\n\nA file is included by a line of its own, `//@ include lib/NAME.glsl`.\n")
    for file in sorted(LIB.glob("*.glsl")):
        if file.name in CORE_ONLY:
            continue
        text = file.read_text()
        found = [(signature, comment) for signature, comment in functions(text)
                 if file.name not in LISTED or signature.split("(")[0].split()[-1] in LISTED[file.name]]
        rows = [cells(f"`{signature}`", *since(comment)) for signature, comment in found]
        if not rows:
            continue
        parts.append(f"### lib/{file.name}\n\n| function | meaning | since |\n|---|---|---|\n" + "\n".join(rows) + "\n")
        for name, comment, body in structs(text):
            if not any(name in signature for signature, _ in found):
                continue
            parts.append(f"`{name}`: {comment}\n\n{table(members(body))}\n")
    return "\n".join(parts)


def main():
    text = reference()
    if "--check" not in sys.argv[1:]:
        TARGET.write_text(text)
        return 0
    if TARGET.exists() and TARGET.read_text() == text:
        return 0
    print(f"{TARGET.relative_to(ROOT)}: not up to date with shaders/lib; run tools/plugin_reference.py")
    return 1


if __name__ == "__main__":
    sys.exit(main())
