"""Rasters with their place on the Earth."""

from __future__ import annotations

import base64
import html
import json
import os
import struct
import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NoReturn, Optional, Union

import numpy
from numpy.typing import NDArray

from ._errors import BadInput
from ._transform import Transform

if TYPE_CHECKING:
    import xarray


class Raster:
    """Values on the grid of a DEM.

    numpy takes it as an array: `numpy.asarray(raster)`, `matplotlib.pyplot.imshow(raster)`.
    """

    def __init__(
        self, values: NDArray[numpy.float32], transform: Transform, crs: str, wkt: str, bands: tuple[str, ...],
        names: tuple[str, ...], units: tuple[str, ...], about: Mapping[str, Union[str, int]],
    ) -> None:
        self.values = values
        """float32, (rows, columns), or (bands, rows, columns) where a list of bands was asked for. Rows are in the
        order of the DEM, voids are NaN."""
        self.transform = transform
        self.crs = crs
        """The code of the CRS, such as "EPSG:32632", or WKT where it has none."""
        self.wkt = wkt
        """The CRS as WKT 2."""
        self.bands = bands
        """Names by which `raster["global"]` finds a band."""
        self.names = names
        """What each band is, for titles: "sun hours"."""
        self.units = units
        """The unit of each band: "h", "min", "kWh/m2", "m"; "1" for plain numbers."""
        self.about = dict(about)
        """"definition": what was computed, in a sentence. "holes": number of voids. "beyond": a sentence about terrain
        outside of the DEM, where that could change values. What else the program's GeoTIFF says: "dem", "time_from",
        "time_zone", "refraction", "software" ... And what `relevo.again()` takes: "figure", "options", "dem_sha256",
        "dem_files", "dem_options". Texts and numbers."""

    @property
    def name(self) -> str:
        """What the first band is."""
        return self.names[0]

    @property
    def unit(self) -> str:
        """The unit of the first band."""
        return self.units[0]

    @property
    def shape(self) -> tuple[int, ...]:
        """That of `values`."""
        return self.values.shape

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(left, bottom, right, top) in the CRS, outer edges of cells."""
        return bounds_of(self.transform, self.values.shape[-2], self.values.shape[-1])

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        values = self.values if dtype is None else self.values.astype(dtype, copy=False)
        return values.copy() if copy else values

    def __getitem__(self, band: str) -> Raster:
        """A band by its name: a raster of (rows, columns). No copy."""
        if band not in self.bands:
            raise KeyError(f"{band}: expected one of {', '.join(self.bands)}")
        i = self.bands.index(band)
        values = self.values if self.values.ndim == 2 else self.values[i]
        one = slice(i, i + 1)
        about = dict(self.about)
        if self.values.ndim == 3:
            options = json.loads(str(about["options"]))
            own = {"times": [options["times"][i]]} if "times" in options else {"bands": [band]}
            about["options"] = json.dumps({**options, **own})
        return Raster(
            values, self.transform, self.crs, self.wkt, self.bands[one], self.names[one], self.units[one], about
        )

    def __iter__(self) -> NoReturn:
        raise TypeError("a raster has no order of its own; go over raster.values or raster.bands")

    def __repr__(self) -> str:
        shape = " x ".join(str(side) for side in self.values.shape)
        what = ", ".join(f"{name} [{unit}]" for name, unit in zip(self.names, self.units))
        crs = self.crs if len(self.crs) < 40 else self.crs[:37] + "..."
        return f"<relevo.Raster {shape}: {what}, {crs}>"

    def _repr_html_(self) -> str:
        """What notebooks show: the raster in words, and its first band from black, the lowest value, to white."""
        values = self.values if self.values.ndim == 2 else self.values[0]
        step = max(1, -(-max(values.shape) // 256))
        picture = base64.b64encode(_png(values[::step, ::step])).decode()
        return f'<div>{html.escape(repr(self))}<br><img alt="" src="data:image/png;base64,{picture}"></div>'

    def to_xarray(self) -> xarray.DataArray:
        """An xarray.DataArray with coordinates of the centres of cells and the CRS in `spatial_ref`, as rioxarray has
        it. No copy of the values.

        Dimensions are y and x, with band before them where `values` has it. The coordinates of a rotated raster are
        numbers of rows and columns.
        """
        from .xarray import to_dataarray

        return to_dataarray(self)

    def save(
        self, path: Union[str, os.PathLike[str]], *, compress: Optional[str] = None,
        creation_options: Mapping[str, object] = {},
    ) -> None:
        """Writes a GeoTIFF by rasterio, which has to be installed: float32, NaN as nodata, unit and name of each band.

        compress: "deflate", "lzw", "zstd" ...; None: not
        creation_options: others, as rasterio.open() takes them
        """
        import rasterio

        bands = self.values if self.values.ndim == 3 else self.values[numpy.newaxis]
        profile: dict[str, Any] = {"driver": "GTiff", "nodata": float("nan"), "tiled": True, **creation_options}
        if compress is not None:
            profile["compress"] = compress
        with rasterio.open(
            path,
            "w",
            count=bands.shape[0],
            height=bands.shape[1],
            width=bands.shape[2],
            dtype="float32",
            crs=self.wkt,
            transform=rasterio.Affine(*self.transform),
            **profile,
        ) as file:
            file.write(bands)
            file.descriptions = self.names
            file.units = self.units
            file.update_tags(**{f"RELEVO_{key.upper()}": str(value) for key, value in self.about.items()})


def _png(values: NDArray[numpy.float32]) -> bytes:
    """A picture in greys, transparent where there is no number."""
    known = numpy.isfinite(values)
    low, high = (values[known].min(), values[known].max()) if known.any() else (0.0, 0.0)
    grey = numpy.where(known, (values - low) * (255 / max(float(high - low), 1e-30)), 0).astype(numpy.uint8)
    rows = numpy.zeros((values.shape[0], 1 + 2 * values.shape[1]), numpy.uint8)  # the first byte: no filter
    rows[:, 1::2], rows[:, 2::2] = grey, numpy.where(known, 255, 0)
    header = struct.pack(">IIBBBBB", values.shape[1], values.shape[0], 8, 4, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes())), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )


def horizontal(crs: str, wkt: str) -> tuple[str, str]:
    """The code and WKT 2 of the horizontal part of a CRS. Values of rasters are not in the unit of its vertical part."""
    if not wkt.startswith("COMPOUNDCRS["):
        return crs, wkt
    begin = wkt.index('",') + 2  # after the name
    depth, quoted = 0, False
    for end in range(begin, len(wkt)):
        quoted ^= wkt[end] == '"'
        depth += 0 if quoted else {"[": 1, "]": -1}.get(wkt[end], 0)
        if depth == 0 and wkt[end] == "]":
            break
    part = wkt[begin : end + 1]
    return (crs.split("+")[0] if "+" in crs and len(crs) < 40 else part), part


def bounds_of(transform: Transform, rows: int, columns: int) -> tuple[float, float, float, float]:
    """(left, bottom, right, top) of a raster."""
    corners = [transform.apply(column, row) for column in (0, columns) for row in (0, rows)]
    xs, ys = zip(*corners)
    return min(xs), min(ys), max(xs), max(ys)


def band_list(bands: Union[str, list[str], tuple[str, ...]]) -> tuple[list[str], bool]:
    """Names of bands, and whether there is one alone, whose values are then without a dimension of bands."""
    if isinstance(bands, str):
        return [bands], True
    names = list(bands) if isinstance(bands, (list, tuple)) else []
    if not names or not all(isinstance(name, str) for name in names):
        raise BadInput("bands: expected a name or a list of names")
    return names, False


def empty(bands: Optional[int], rows: int, columns: int) -> NDArray[numpy.float32]:
    """Room for values."""
    shape = (rows, columns) if bands is None else (bands, rows, columns)
    return numpy.empty(shape, dtype=numpy.float32)
