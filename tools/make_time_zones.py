#!/usr/bin/env python3
"""Makes data/timezones/timezones.bin: which time zone a place is in (data/README.md says from what).

Usage: make_time_zones.py GRID NAMES OUT

GRID   16-bit grey PNG of the whole Earth, north up, 0.1 degree a cell from 180 W and 90 N; a value is a line of NAMES, from 0
NAMES  IANA names, one a line
OUT    data/timezones/timezones.bin

Rows differ little from the one above, so that only the changes are written: 74 KB where the PNG has 92, and nothing to inflate.
Layout: the text "relevo time zones 1\\n", "COLUMNS ROWS NAMES\\n", the names, each with "\\n"; then for each row the number of spans
that are not as in the row above (above the first row there is nothing), and for each span how many cells to leave from the end of the last
one, how many it has, and its name's index; at the end FNV-1a (64 bits, least byte first) of all bytes before. Numbers have 7 bits a byte,
the least first, with the highest bit set in all bytes but the last.

The file is read again and compared with the grid, cell by cell. Takes some ten seconds.
"""

import pathlib
import struct
import sys
import zlib


def fail(what):
    sys.exit(f"make_time_zones.py: {what}")


def unfiltered(kind, line, above):
    """The bytes of a PNG's row of 2 bytes a pixel (PNG specification, 9.2), from those of its filter."""
    for i, value in enumerate(line):
        left, upper_left = (line[i - 2], above[i - 2]) if i > 1 else (0, 0)
        up = above[i]
        if kind == 1:
            value += left
        elif kind == 2:
            value += up
        elif kind == 3:
            value += (left + up) // 2
        elif kind == 4:
            estimate = left + up - upper_left
            value += min((left, up, upper_left), key=lambda near: abs(estimate - near))
        line[i] = value & 255
    return line


def read_grid(path):
    """Rows of whole numbers."""
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        fail(f"{path}: expected a PNG")
    at, pixels, head = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", data[at + 8:at + 8 + size])
        elif kind == b"IDAT":
            pixels += data[at + 8:at + 8 + size]
        at += size + 12
    columns, rows = head[:2]
    if head[2:] != (16, 0, 0, 0, 0):
        fail(f"{path}: expected 16-bit grey without interlace")
    pixels = zlib.decompress(pixels)
    above, grid = bytes(2 * columns), []
    for row in range(rows):
        begin = row * (2 * columns + 1)
        above = unfiltered(pixels[begin], bytearray(pixels[begin + 1:begin + 1 + 2 * columns]), above)
        grid.append(list(struct.unpack(f">{columns}H", above)))
    return grid


def number(value):
    data = bytearray()
    while value > 127:
        data.append(value & 127 | 128)
        value >>= 7
    data.append(value)
    return bytes(data)


def spans(line, above):
    """(first, end, value) of what is not as above."""
    first = 0
    while first < len(line):
        end = first + 1
        if line[first] != above[first]:
            while end < len(line) and line[end] == line[first] and line[end] != above[end]:
                end += 1
            yield first, end, line[first]
        first = end


def fnv_1a(data):
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return struct.pack("<Q", value)


def encoded(grid, names):
    columns = len(grid[0])
    data = bytearray(f"relevo time zones 1\n{columns} {len(grid)} {len(names)}\n".encode())
    data += "".join(name + "\n" for name in names).encode()
    above = [None] * columns
    for line in grid:
        changed = list(spans(line, above))
        data += number(len(changed))
        last = 0
        for first, end, value in changed:
            data += number(first - last) + number(end - first) + number(value)
            last = end
        above = line
    return bytes(data) + fnv_1a(data)


def decoded(data):
    """Rows of names."""
    at = data.index(b"\n") + 1
    end = data.index(b"\n", at)
    columns, rows, count = map(int, data[at:end].split())
    *names, rest = data[end + 1:-8].split(b"\n", count)
    at, line = 0, [None] * columns

    def take():
        nonlocal at
        value = shift = 0
        while True:
            value |= (rest[at] & 127) << shift
            shift += 7
            at += 1
            if rest[at - 1] < 128:
                return value

    for _ in range(rows):
        cell = 0
        for _ in range(take()):
            cell += take()
            length = take()
            line[cell:cell + length] = [names[take()].decode()] * length
            cell += length
        yield line


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    grid = read_grid(pathlib.Path(sys.argv[1]))
    names = pathlib.Path(sys.argv[2]).read_text(encoding="ascii").split()
    if max(map(max, grid)) >= len(names):
        fail(f"{sys.argv[1]}: a value of {max(map(max, grid))}, but only {len(names)} names")
    data = encoded(grid, names)
    for row, (line, again) in enumerate(zip(grid, decoded(data), strict=True)):
        if [names[value] for value in line] != again:
            fail(f"row {row} would not be read as it is")
    pathlib.Path(sys.argv[3]).write_bytes(data)
    print(f"{sys.argv[3]}: {len(data)} bytes, {len(names)} zones, each of {len(grid) * len(grid[0])} cells compared")


if __name__ == "__main__":
    main()
