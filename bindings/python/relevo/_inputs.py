"""DEMs from memory: numpy arrays, rasterio datasets and xarray's arrays become heights that the library takes."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Protocol, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from ._errors import BadInput, warn
from ._transform import Transform, read_transform

if TYPE_CHECKING:
    import xarray


class _Wkt(Protocol):
    """A CRS of rasterio or pyproj."""

    def to_wkt(self) -> str: ...


Crs = Union[str, int, _Wkt]
"""A text such as "EPSG:32632", WKT or a PROJ string; a number of EPSG; a CRS of rasterio or pyproj."""

class _Dataset(Protocol):
    """An open dataset of rasterio."""

    count: int

    def read(self, band: int) -> NDArray[Any]: ...


_Name = Union[str, "os.PathLike[str]"]
Source = Union[_Name, Sequence[_Name], ArrayLike, _Dataset, "xarray.DataArray"]
Nodata = Union[float, str, None]
"""A number, "none", or None: what the source says."""


class Heights(NamedTuple):
    """Heights on a grid, as a file has them."""

    values: NDArray[numpy.float32]  # (rows, columns), C-contiguous, NaN in voids
    transform: Transform
    crs: str
    unit: Optional[str]  # None: that of the CRS's vertical part, else metres
    voids_known: bool  # the source says which elements are voids; else the library looks for undeclared ones
    scale: float = 1.0
    offset: float = 0.0  # height: offset + scale * value


def _void_of(nodata: Nodata, declared: Optional[float] = None) -> Optional[float]:
    """The number that marks voids: the one given, else the one declared."""
    if nodata is None:
        return declared
    if nodata == "none":
        return None
    if isinstance(nodata, str):
        raise BadInput(f'nodata: expected a number or "none" but got {nodata!r}')
    return float(nodata)


def plain_heights(given: Any, void: Optional[float]) -> tuple[NDArray[numpy.float32], bool]:
    """float32 of any numbers; masked elements and those of `void` become NaN. No copy where none is needed.

    Returns also whether that says which elements are voids.
    """
    known = void is not None or bool(numpy.ma.is_masked(given))  # type: ignore[no-untyped-call]
    if isinstance(given, numpy.ma.MaskedArray) and given.dtype.kind in "iuf":
        given = numpy.where(numpy.ma.getmaskarray(given), numpy.float32("nan"), given.data)  # type: ignore[no-untyped-call]
    array = numpy.asarray(given)
    if array.dtype.kind not in "iuf":
        raise BadInput(f"heights: expected numbers but got an array of {array.dtype}")
    if array.ndim != 2:
        raise BadInput(f"heights: expected rows and columns but got {array.ndim} dimensions, {array.shape}")
    if min(array.shape) < 2:
        raise BadInput(f"heights: expected 2 rows and columns or more but got {array.shape}")
    heights = numpy.ascontiguousarray(array, dtype=numpy.float32)
    if void is not None and not numpy.isnan(void):
        voids = array == void
        if voids.any():
            heights = heights.copy() if numpy.may_share_memory(heights, array) else heights
            heights[voids] = numpy.nan
    return heights, known


def of_array(array: Any, transform: Any, crs: Any, nodata: Nodata, unit: Optional[str]) -> Heights:
    if transform is None:
        raise BadInput("transform: missing; an array needs transform= and crs=")
    if crs is None:
        raise BadInput('crs: missing; an array needs transform= and crs=, such as "EPSG:32632"')
    values, known = plain_heights(array, _void_of(nodata))
    return Heights(values, read_transform(transform), crs_text(crs), unit, known)


def crs_text(crs: Any, name: str = "crs") -> str:
    """A text that the library takes of one, of a number of EPSG, or of a CRS of rasterio or pyproj."""
    if isinstance(crs, str):
        return crs
    if isinstance(crs, (int, numpy.integer)) and not isinstance(crs, bool):
        return f"EPSG:{crs}"
    for method in ("to_wkt", "ExportToWkt"):
        if hasattr(crs, method):
            return str(getattr(crs, method)())
    raise BadInput(f'{name}: expected a text such as "EPSG:32632", or a CRS of rasterio or pyproj, but got {crs!r}')


def is_rasterio(source: Any) -> bool:
    """Whether it is an open dataset of rasterio, which is then imported already."""
    return all(hasattr(source, name) for name in ("read", "transform", "crs", "nodatavals", "count"))


def of_rasterio(dataset: Any, band: int, crs: Any, nodata: Nodata, unit: Optional[str]) -> Heights:
    """Heights of a band with scale, offset, mask and unit as the dataset has them."""
    if not 1 <= band <= dataset.count:
        raise BadInput(f"band: {dataset.name} has {dataset.count} bands, not {band}")
    if dataset.crs is None and crs is None:
        raise BadInput(f"crs: {dataset.name} has none; give crs=")
    flags = {flag.name for flag in dataset.mask_flag_enums[band - 1]}
    has_mask = bool(flags & {"per_dataset", "alpha"}) and "nodata" not in flags
    void = _void_of(nodata, dataset.nodatavals[band - 1])
    values, known = plain_heights(dataset.read(band, masked=has_mask), void)
    text = crs_text(dataset.crs if crs is None else crs)
    # All BAG files have heights, though the vertical CRS of some has its axis downwards.
    sign = -1.0 if dataset.driver == "BAG" and "DOWN]" in text.upper() else 1.0
    return Heights(
        values,
        read_transform(dataset.transform),
        text,
        unit or dataset.units[band - 1] or None,
        known or has_mask,
        sign * float(dataset.scales[band - 1]),
        sign * float(dataset.offsets[band - 1]),
    )


def is_dataarray(source: Any) -> bool:
    """Whether it is a DataArray of xarray, which is then imported already."""
    xarray = sys.modules.get("xarray")
    return xarray is not None and isinstance(source, xarray.DataArray)


def of_dataarray(array: Any, transform: Any, crs: Any, nodata: Nodata, unit: Optional[str]) -> Heights:
    """Heights with coordinates and CRS as rioxarray writes them, or CF has them."""
    array = array.squeeze(drop=False)
    if array.ndim != 2:
        raise BadInput(f"heights: expected two dimensions but got {array.dims}")
    if _is_east(array, array.dims[0]):
        raise BadInput(f"heights: expected rows before columns but got {array.dims}; array.T has them so")
    if unit is None and isinstance(array.attrs.get("units"), str):
        unit = _unit_of(array.attrs["units"])
    void = _void_of(nodata, declared_void(array))
    if transform is None:
        transform = _transform_of(array)
    if crs is None:
        crs = _crs_of(array)
    if crs is None:
        raise BadInput("crs: the DataArray has none; give crs=")
    values, known = plain_heights(array.values, void)
    return Heights(values, read_transform(transform), crs_text(crs), unit, known)


def _is_east(array: Any, dim: Any) -> bool:
    """Whether a dimension goes to the east, by its name or by what CF says of its coordinates."""
    attributes = array.coords[dim].attrs if dim in array.coords else {}
    units = str(attributes.get("units", ""))
    return str(dim).lower() in ("x", "lon", "longitude", "easting", "column") or (
        attributes.get("axis") == "X" or units in ("degrees_east", "degree_east")
    )


def _unit_of(text: str) -> Optional[str]:
    return None if text in ("", "1") else text


def declared_void(array: Any) -> Optional[float]:
    """What the attributes say, or what xarray and rioxarray have made NaN of."""
    for value in (array.attrs.get("_FillValue"), array.attrs.get("nodata")):
        try:
            if value is not None:
                return float(value)
        except (TypeError, ValueError):
            return None
    return float("nan") if array.encoding.get("_FillValue") is not None else None


def _transform_of(array: Any) -> Transform:
    """From coordinates of centres, and from GeoTransform, where GDAL's drivers and rioxarray put it: that one is exact,
    but stays as it was where a part of the array is taken."""
    text = _reference_of(array).get("GeoTransform")
    written = Transform.from_gdal(*(float(number) for number in str(text).split())) if text else None
    y, x = (_step_of(array, dim) for dim in array.dims)
    if x is None or y is None:
        if written is None:
            raise BadInput("transform: the DataArray has no regular coordinates; give transform=")
        return written
    (first_x, step_x), (first_y, step_y) = x, y
    found = Transform(step_x, 0, first_x - 0.5 * step_x, 0, step_y, first_y - 0.5 * step_y)
    return written if written is not None and _agree(written, found, array.shape) else found


def _agree(written: Transform, found: Transform, shape: tuple[int, int]) -> bool:
    """Whether corners differ by less than a thousandth of a cell."""
    for corner in ((0, 0), (shape[1], shape[0])):
        (x, y), (other_x, other_y) = written.apply(*corner), found.apply(*corner)
        if abs(x - other_x) > 1e-3 * abs(found.a) or abs(y - other_y) > 1e-3 * abs(found.e):
            return False
    return True


def _step_of(array: Any, dim: Any) -> Optional[tuple[float, float]]:
    """The first coordinate and the step of regular ones; None where the dimension has no coordinates."""
    if dim not in array.coords or array.coords[dim].dtype.kind not in "iuf":
        return None
    centres = numpy.asarray(array.coords[dim].values, dtype=numpy.float64)
    step = (centres[-1] - centres[0]) / (len(centres) - 1) if len(centres) > 1 else 0.0
    if step == 0 or not numpy.allclose(numpy.diff(centres), step, rtol=1e-3, atol=0):
        raise BadInput(f"transform: the coordinates of {dim} are not regular; expected equal steps")
    return float(centres[0]), float(step)


def _reference_of(array: Any) -> dict[Any, Any]:
    """Attributes of the variable that describes the CRS."""
    name = array.encoding.get("grid_mapping", array.attrs.get("grid_mapping", "spatial_ref"))
    if name in array.coords:
        return dict(array.coords[name].attrs)
    # Arithmetic drops the attribute that names the variable.
    for coordinate in array.coords.values():
        if coordinate.ndim == 0 and any(key in coordinate.attrs for key in ("crs_wkt", "spatial_ref")):
            return dict(coordinate.attrs)
    return {}


def _crs_of(array: Any) -> Any:
    attributes = _reference_of(array)
    for name in ("crs_wkt", "spatial_ref"):
        if attributes.get(name):
            return attributes[name]
    if array.attrs.get("crs"):
        return array.attrs["crs"]
    units = [str(array.coords[dim].attrs.get("units", "")) for dim in array.dims if dim in array.coords]
    if len(units) == 2 and units[0].startswith("degree") and units[1].startswith("degree"):
        warn("crs: the DataArray has degrees and no CRS, WGS 84 is assumed; crs= sets another")
        return "EPSG:4326"
    return None
