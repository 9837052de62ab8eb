"""Reads the data of a web page of Relevo (docs/web.md): python3 read_web.py PAGE.html

read(bytes) returns the JSON as a dict and the blocks by name, as bytes. heights(about, blocks) returns metres, NaN in
voids, row 0 first. Both raise ValueError, which names the block at fault.
"""

import base64
import json
import re
import struct
import sys
import zlib

import numpy

VERSION = 1


def read(data):
    found = re.search(rb'id="data">([^<]*)<', data) if data[:1] == b"<" else None
    if found:
        data = base64.b64decode(found[1])
    if data[:4] != b"RLVW":
        raise ValueError("not the data of a web page of Relevo")
    if len(data) < 12:
        raise ValueError("cut short in the header")
    version, length = struct.unpack("<II", data[4:12])
    if version != VERSION:
        raise ValueError(f"version {version}, expected {VERSION}")
    if 12 + length > len(data):
        raise ValueError("cut short in the JSON")
    about = json.loads(data[12 : 12 + length].decode("utf-8"))
    body = memoryview(data)[12 + length :]
    return about, {entry["name"]: block(entry, body) for entry in about["blocks"]}


def block(entry, body):
    name, first, length, size = (entry[key] for key in ("name", "offset", "length", "size"))
    if first < 0 or length < 0 or first + length > len(body):
        raise ValueError(f"block {name}: ends at byte {first + length}, the data at {len(body)}")
    stored = body[first : first + length]
    if zlib.crc32(stored) != entry["crc32"]:
        raise ValueError(f"block {name}: wrong checksum")
    if entry["coding"] != "deflate":
        return bytes(stored)
    inflater = zlib.decompressobj()
    raw = inflater.decompress(stored, size + 1)
    if len(raw) != size or not inflater.eof:
        raise ValueError(f"block {name}: does not have its {size} bytes")
    return raw


def heights(about, blocks):
    columns, rows = about["size"]
    planes = numpy.frombuffer(blocks["heights"], numpy.uint8)
    if planes.size != 2 * rows * columns:
        raise ValueError(f"block heights: {planes.size} bytes, expected {2 * rows * columns}")
    low, high = planes.reshape(2, rows, columns).astype(numpy.uint16)
    values = (low + 256 * high).cumsum(0, dtype=numpy.uint16).cumsum(1, dtype=numpy.uint16)
    metres = about["height"]["min"] + about["height"]["step"] * values.astype(float)
    return numpy.where(values == 65535, numpy.nan, metres)


if __name__ == "__main__":
    try:
        with open(sys.argv[1], "rb") as file:
            ABOUT, BLOCKS = read(file.read())
        METRES = heights(ABOUT, BLOCKS)
    except ValueError as error:
        sys.exit(f"{sys.argv[1]}: {error}")
    print(ABOUT["title"], METRES.tolist())
