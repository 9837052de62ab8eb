#!/usr/bin/python3
"""Makes data/climate/climate.bin, the climate of the whole Earth by month, and land.bin beside it, what covers its ground (data/README.md says
from what).

Usage: make_climate.py climate|land FOLDER OUT

FOLDER  of climate: t0_1deg.tif, orog_1deg.tif, pr_annual_0p5.tif, pr_share_2p5.tif, ice_0p05.tif
        of land: igbp_0p05.tif, ground_0p2.tif, towns_0p1.tif
OUT     data/climate/climate.bin or data/climate/land.bin

All grids are of latitude and longitude, north up from 90 N and 180 W, a cell an area. They are cut into bands of 2 to 10 degrees of latitude,
each deflated by itself, so that a place costs only its own.
Layout: the text "relevo climate 1\\n" or "relevo land 1\\n"; for each grid "NAME COLUMNS ROWS PLANES BITS BAND_ROWS\\n"; "end\\n"; the size of each band, 4 bytes, least
first, grid after grid from north to south; then the bands, as zlib writes them with its checksum. A band is plane after plane, row after row:
of 1 bit eight cells a byte, the highest bit first; of 8 bits each cell less the one to the left, mod 256; of 16 bits each plane less the one
before, then each cell less the one to the left, mod 65536, first the low bytes of all, then the high ones.

The file is read again and compared with the grids, cell by cell. Needs python3-numpy and python3-gdal.
"""

import pathlib
import struct
import sys
import zlib

import numpy
from osgeo import gdal

# name, file, bits, rows a band
GRIDS = {"climate": [("temperature", "t0_1deg.tif", 16, 10), ("relief", "orog_1deg.tif", 16, 10), ("rain", "pr_annual_0p5.tif", 8, 20),
                     ("share", "pr_share_2p5.tif", 8, 4), ("ice", "ice_0p05.tif", 1, 100)],
         "land": [("class", "igbp_0p05.tif", 8, 40), ("ground", "ground_0p2.tif", 8, 25), ("towns", "towns_0p1.tif", 8, 50)]}


def encoded(planes, bits):
    """Of an array (plane, row, column)."""
    if bits == 1:
        return numpy.packbits(planes.astype(numpy.uint8), axis=2).tobytes()
    differences = planes.astype(numpy.int64)
    if bits == 16:
        differences[1:] -= planes[:-1]
    differences = numpy.diff(differences, axis=2, prepend=0)
    if bits == 8:
        return (differences % 256).astype(numpy.uint8).tobytes()
    words = (differences % 65536).astype(numpy.uint16)
    return (words & 255).astype(numpy.uint8).tobytes() + (words >> 8).astype(numpy.uint8).tobytes()


def decoded(data, shape, bits):
    if bits == 1:
        return numpy.unpackbits(numpy.frombuffer(data, numpy.uint8).reshape(shape[0], shape[1], -1), axis=2)[:, :, :shape[2]]
    if bits == 8:
        return numpy.cumsum(numpy.frombuffer(data, numpy.uint8).reshape(shape), axis=2) % 256
    halves = numpy.frombuffer(data, numpy.uint8).astype(numpy.int64).reshape(2, *shape)
    words = numpy.cumsum(numpy.cumsum(halves[0] + 256 * halves[1], axis=2), axis=0) % 65536
    return numpy.where(words > 32767, words - 65536, words)


def main():
    if len(sys.argv) != 4 or sys.argv[1] not in GRIDS:
        sys.exit(__doc__)
    gdal.UseExceptions()
    head, sizes, bands = f"relevo {sys.argv[1]} 1\n", b"", b""
    for name, file, bits, rows in GRIDS[sys.argv[1]]:
        grid = gdal.Open(str(pathlib.Path(sys.argv[2]) / file)).ReadAsArray()
        grid = grid if grid.ndim == 3 else grid[None]
        head += f"{name} {grid.shape[2]} {grid.shape[1]} {grid.shape[0]} {bits} {rows}\n"
        for first in range(0, grid.shape[1], rows):
            band = grid[:, first:first + rows]
            data = encoded(band, bits)
            if not (decoded(data, band.shape, bits) == band).all():
                sys.exit(f"make_climate.py: {file}: row {first} and those below would not be read as they are")
            packed = zlib.compress(data, 9)
            sizes += struct.pack("<I", len(packed))
            bands += packed
    data = head.encode() + b"end\n" + sizes + bands
    pathlib.Path(sys.argv[3]).write_bytes(data)
    print(f"{sys.argv[3]}: {len(data)} bytes")


if __name__ == "__main__":
    main()
