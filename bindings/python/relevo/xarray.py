"""An accessor of xarray: `array.relevo` on a DataArray of heights. `import relevo.xarray` registers it; `import relevo`
does where xarray is imported already.

    import xarray, relevo.xarray
    hours = heights.relevo.hours("2026-06-21")
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy
import xarray

from ._dem import Dem, open
from ._errors import Warning
from ._raster import Raster
from ._sun_over_dem import SunOverDem

if TYPE_CHECKING:
    from typing import Concatenate, ParamSpec

    P = ParamSpec("P")
R = TypeVar("R")

_UDUNITS = {"deg": "degree", "kWh/m2": "kW h m-2"}


def to_dataarray(raster: Raster) -> xarray.DataArray:
    """`Raster.to_xarray()`."""
    rows, columns = raster.shape[-2:]
    transform = raster.transform
    coords: dict[str, Any] = {"spatial_ref": _spatial_ref(raster)}
    row, column = numpy.arange(rows) + 0.5, numpy.arange(columns) + 0.5
    if transform.b == 0 and transform.d == 0:
        crs = _crs(raster)
        axes = {} if crs is None else {axis["axis"].lower(): axis for axis in crs.cs_to_cf()}
        coords["y"] = ("y", transform.f + transform.e * row, axes.get("y"), {"_FillValue": None})
        coords["x"] = ("x", transform.c + transform.a * column, axes.get("x"), {"_FillValue": None})
    dims: tuple[str, ...] = ("y", "x")
    if raster.values.ndim == 3:
        dims = ("band", *dims)
        coords["band"] = list(raster.bands)
    return _described(xarray.DataArray(raster.values, coords=coords, dims=dims), raster)


def _spatial_ref(raster: Raster) -> Any:
    """The CRS as rioxarray and CF have it."""
    geotransform = " ".join(repr(number) for number in raster.transform.to_gdal())
    found = {"crs_wkt": raster.wkt, "spatial_ref": raster.wkt, "GeoTransform": geotransform}
    crs = _crs(raster)
    return xarray.Variable((), numpy.int32(0), found if crs is None else {**crs.to_cf(), **found})


def _crs(raster: Raster) -> Any:
    """The CRS of pyproj, which knows CF's words for it; None without pyproj."""
    try:
        import pyproj
    except ImportError:
        return None
    return pyproj.CRS.from_wkt(raster.wkt)


def _described(array: Any, raster: Raster) -> Any:
    band = raster.bands[0] if raster.values.ndim == 2 else "sun"
    array.name = band if band.isidentifier() else raster.about["figure"]
    array.attrs.update(raster.about)
    if raster.values.ndim == 2:
        array.attrs.update(long_name=raster.name, units=_UDUNITS.get(raster.unit, raster.unit))
    else:
        array.coords["unit"] = ("band", list(raster.units))
    array.encoding["grid_mapping"] = "spatial_ref"
    return array


def _of_dem(function: Callable[Concatenate[Dem, P], R]) -> Callable[Concatenate[Accessor, P], R]:
    """A method of a DEM as one of the accessor."""

    @functools.wraps(function)
    def call(of: Accessor, /, *arguments: P.args, **options: P.kwargs) -> R:
        with open(of._array) as dem:
            return function(dem, *arguments, **options)

    return call


def _of_sun(function: Callable[Concatenate[SunOverDem, P], R]) -> Callable[Concatenate[Accessor, P], R]:
    """A method of `Dem.sun` as one of the accessor."""

    @functools.wraps(function)
    def call(of: Accessor, /, *arguments: P.args, **options: P.kwargs) -> R:
        with open(of._array) as dem:
            return function(dem.sun, *arguments, **options)

    return call


def _raster(function: Callable[Concatenate[SunOverDem, P], Raster]) -> Callable[Concatenate[Accessor, P], xarray.DataArray]:
    """A raster of `Dem.sun`, lazy where the heights are chunked."""

    @functools.wraps(function)
    def call(of: Accessor, /, *arguments: P.args, **options: P.kwargs) -> xarray.DataArray:
        array = of._array.squeeze(drop=False)
        if array.chunks is None:
            with open(array) as dem:
                return _aligned(array, function(dem.sun, *arguments, **options))
        import dask
        import dask.array

        figure: Any = function
        named: Any = options
        with warnings.catch_warnings(), open(_level(array)) as dem:  # says bands and units, and what is wrong
            warnings.simplefilter("ignore", Warning)
            said = _aligned(array, figure(dem.sun, *arguments, **{**named, "clip": None, "progress": None}))
        made = dask.delayed(_values)(array, function, arguments, options)
        values = dask.array.from_delayed(made, said.shape, numpy.float32)
        told = {key: said.attrs[key] for key in ("figure", "options", "long_name", "units") if key in said.attrs}
        lazy = said.copy(data=values.rechunk((-1,) * (said.ndim - 2) + array.chunks))
        lazy.attrs = told
        return lazy

    return call


def _values(array: Any, function: Any, arguments: Any, options: Any) -> Any:
    """In a process of dask."""
    with open(array) as dem:
        return function(dem.sun, *arguments, **options).values


def _level(array: Any) -> Any:
    """A few posts without heights, at the place of an array."""
    return array[:4, :4].copy(data=numpy.zeros(array[:4, :4].shape, numpy.float32))


@xarray.register_dataarray_accessor("relevo")
class Accessor:
    """Relevo on a DataArray of heights, (y, x). Each call opens the DEM anew, as heights may change; `open()` keeps it.

    Keywords of relevo.open() that the array does not say are those of `open()`; results of the other functions are
    DataArrays with the array's dimensions and coordinates. Of a chunked array they are lazy and have its chunks: the
    whole DEM is one task, because ground anywhere can shade a post.
    """

    def __init__(self, array: xarray.DataArray) -> None:
        self._array = array

    hours = _raster(SunOverDem.hours)
    shadow = _raster(SunOverDem.shadow)
    sky_view = _raster(SunOverDem.sky_view)
    horizons = _raster(SunOverDem.horizons)
    horizon = _of_sun(SunOverDem.horizon)
    capture = _of_dem(Dem.capture)

    @functools.wraps(open)
    def open(self, *arguments: Any, **options: Any) -> Dem:
        """relevo.open() of the array."""
        return open(self._array, *arguments, **options)


def _aligned(array: Any, raster: Raster) -> Any:
    """With dimensions and coordinates of the array that the DEM was made of."""
    dims, coords = array.dims, dict(array.coords)
    if raster.values.ndim == 3:
        coords.pop("band", None)
        dims = ("band", *dims)
        coords["band"] = list(raster.bands)
    if "spatial_ref" not in coords:
        coords["spatial_ref"] = _spatial_ref(raster)
    values = numpy.broadcast_to(raster.values[..., :1, :1], (*raster.values.shape[:-2], *array.shape)) if (
        raster.values.shape[-2:] != array.shape
    ) else raster.values
    return _described(xarray.DataArray(values, coords=coords, dims=dims), raster)
