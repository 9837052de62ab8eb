#!/usr/bin/env python3
"""Draws the default picture of DEMs and prints how much of it is ground, wall and backdrop.

Usage: look.py DEM|FOLDER... [--build BUILD] [--size 480x384] [--to FOLDER] [--options "OPTIONS OF CAPTURE"]

Masks are exact: layer `ids` of an OpenEXR picture. Columns: ground and water, bare wall and backdrop in percent of the
picture; posts of the DEM that are in the picture [%]; the frame's azimuth and elevation [deg]. Exits with 1 if a DEM has
less than 45 % ground, more than 6 % wall, or less than 75 % of its posts in the picture, or if the medians are below 55 %
or above 4 %. Pictures are kept with --to, one PNG a DEM.
"""

import argparse
import pathlib
import re
import shlex
import statistics
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUFFIXES = {".tif", ".hgt", ".dt0", ".dt1", ".dem", ".asc", ".nc", ".img", ".bag", ".vrt", ".png"}
SIZES = {0: 4, 1: 2, 2: 4}  # bytes of a pixel by the type of a channel: uint, half, float
LINES_OF_BLOCK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def header(data):
    """Attributes of an OpenEXR file, and the end of the header."""
    at, attributes = 8, {}
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channels(attribute):
    at, result = 0, []
    while attribute[at]:
        name, at = text(attribute, at)
        result.append((name, struct.unpack_from("<i", attribute, at)[0]))
        at += 16
    return result


def unpacked(block, size):
    """Undoes the deflation, the differences and the order of bytes of a ZIP block."""
    if len(block) == size:
        return block
    raw = bytearray(zlib.decompress(block))
    for i in range(1, len(raw)):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (len(raw) + 1) // 2
    result = bytearray(len(raw))
    result[0::2], result[1::2] = raw[:half], raw[half:]
    return bytes(result)


def kinds(path):
    """Counts of the values of channel ids.kind."""
    data = path.read_bytes()
    attributes, at = header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = LINES_OF_BLOCK[attributes["compression"][0]]
    of_line = sum(SIZES[kind] for _, kind in channels(attributes["channels"])) * width
    counts = [0, 0, 0, 0]
    for (offset,) in struct.iter_unpack("<Q", data[at : at + 8 * -(-height // lines)]):
        y, size = struct.unpack_from("<2i", data, offset)
        rows = min(lines, y1 + 1 - y)
        block = unpacked(data[offset + 8 : offset + 8 + size], rows * of_line)
        for row in range(rows):
            start = row * of_line
            for name, kind in channels(attributes["channels"]):
                end = start + SIZES[kind] * width
                if name == "ids.kind":
                    for value in struct.unpack("<%d%s" % (width, "Ief"[kind]), block[start:end]):
                        counts[int(value)] += 1
                start = end
    return counts


def measured(dem, arguments):
    """(ground, wall, backdrop, posts) in percent, azimuth and elevation; an error's text if it cannot be drawn."""
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "picture.exr"
        command = [str(ROOT / arguments.build / "bin/relevo"), "capture", "-v", str(dem), "--size", arguments.size]
        command += shlex.split(arguments.options)
        done = subprocess.run(command + ["--layers", "ids", "-o", str(picture)], capture_output=True, text=True)
        if done.returncode:
            return done.stderr.strip().splitlines()[-1]
        if arguments.to:
            to = pathlib.Path(arguments.to) / (dem.stem + ".png")
            subprocess.run(command + ["-o", str(to)], capture_output=True, check=True)
        counts = kinds(picture)
    shares = [100 * n / sum(counts) for n in (counts[1] + counts[2], counts[3], counts[0])]
    found = re.search(r"azimuth (\d+), (\d+) degrees high.*?(\d+) % of the (land's )?posts", done.stderr)
    return shares + [float(x) for x in (found[3], found[1], found[2])] if found else shares + [float("nan")] * 3


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dems", nargs="+", type=pathlib.Path)
    parser.add_argument("--build", default="build/dev")
    parser.add_argument("--size", default="480x384")
    parser.add_argument("--to")
    parser.add_argument("--options", default="")
    arguments = parser.parse_args()
    dems = []
    for path in arguments.dems:
        dems += sorted(p for p in path.rglob("*") if p.suffix.lower() in SUFFIXES) if path.is_dir() else [path]
    print("| DEM | ground % | wall % | back % | posts % | azimuth | elevation |\n|" + "---|" * 7)
    rows = []
    for dem in dems:
        row = measured(dem, arguments)
        if isinstance(row, str):
            print("| %s | %s |" % (dem.name, row))
            continue
        rows.append(row)
        flag = " **" if row[0] < 45 or row[1] > 6 or row[3] < 75 else ""
        print("| %s | " % dem.name + " | ".join("%.0f" % v if v == v else "-" for v in row) + " |" + flag, flush=True)
    if not rows:
        sys.exit("no DEM was drawn")
    ground, wall = (statistics.median(row[i] for row in rows) for i in (0, 1))
    print("| median of %d | %.0f | %.1f |" % (len(rows), ground, wall))
    bad = any(row[0] < 45 or row[1] > 6 or row[3] < 75 for row in rows)
    sys.exit(1 if bad or ground < 55 or wall > 4 else 0)


if __name__ == "__main__":
    main()
