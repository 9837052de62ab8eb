"""An accessor of xarray: `array.relevo` on a DataArray of heights. `import relevo.xarray` registers it; `import relevo`
does where xarray is imported already.

    import xarray, relevo.xarray
    hours = heights.relevo.hours("2026-06-21")
"""

from __future__ import annotations

import datetime
import functools
import json
import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Optional, TypeVar, Union

import numpy
import xarray

from . import _lazy
from ._clip import Clip
from ._dem import Dem, open
from ._errors import BadInput, Warning
from ._inputs import Crs
from ._raster import Raster
from ._sun_over_dem import Progress, SunOverDem
from ._times import Date, Time, Times, Zone

if TYPE_CHECKING:
    from typing import Concatenate, ParamSpec

    P = ParamSpec("P")
R = TypeVar("R")

_HALO = """
        halo: of an array with chunks of dask: posts only so many km around each chunk, ground beyond as means, exact
            to 0.1 degrees of the horizon (all posts)
        """
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
    dims = (*_add_bands(coords, raster), "y", "x")
    return _described(xarray.DataArray(raster.values, coords=coords, dims=dims), raster)


def _add_bands(coords: dict[str, Any], raster: Raster) -> tuple[str, ...]:
    """Adds the coordinate of bands, or of times, and returns its name; none of a raster of (rows, columns)."""
    options = json.loads(str(raster.about.get("options", "{}")))
    if "times" in options:
        times = numpy.round(numpy.array(options["times"]) * 1e6).astype("datetime64[us]").astype("datetime64[ns]")
        dims = ("time",) if raster.values.ndim == 3 else ()
        coords["time"] = xarray.Variable(
            dims, times if dims else times[0], {"standard_name": "time", "long_name": "time"},
            {"units": "seconds since 1970-01-01", "calendar": "standard", "dtype": "float64", "_FillValue": None},
        )
        return dims
    if raster.values.ndim == 3:
        coords["band"] = list(raster.bands)
        return ("band",)
    return ()


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
    name, title = raster.bands[0], raster.name
    options = json.loads(str(raster.about.get("options", "{}")))
    if "times" in options:  # bands are named by them
        name, title = "shadow", "visible fraction of the solar disc" if options.get("soft") else "direct sun"
    array.attrs.update(raster.about)
    if "band" in array.dims:
        name, title = "sun", "horizon" if raster.about.get("figure") == "horizons" else ", ".join(raster.names)
        array.coords["unit"] = ("band", list(raster.units))
    array.attrs["long_name"] = title
    if len(set(raster.units)) == 1:
        array.attrs["units"] = _UDUNITS.get(raster.unit, raster.unit)
    array.name = name if name.isidentifier() else raster.about["figure"]
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


def _figure(of: Accessor, name: str, arguments: dict[str, Any]) -> Any:
    """A raster of `Dem.sun`, lazy where the heights are chunked.

    arguments: of the accessor's method
    """
    options = {key: value for key, value in arguments.items() if key not in ("self", "halo")}
    halo = arguments["halo"]
    array = of._array.squeeze(drop=False)
    if array.chunks is None:
        if halo is not None:
            raise BadInput("halo: of arrays with chunks of dask alone")
        with open(array) as dem:
            return _aligned(array, getattr(dem.sun, name)(**options))
    with warnings.catch_warnings(), open(_level(array)) as dem:  # says bands and units, and what is wrong
        warnings.simplefilter("ignore", Warning)
        said = _aligned(array, getattr(dem.sun, name)(**{**options, "clip": None, "progress": None}))
        values, about = _lazy.values(array, dem, name, options, halo, said.shape)
    told = {key: said.attrs[key] for key in ("figure", "options", "long_name", "units") if key in said.attrs}
    lazy = said.copy(data=values)
    lazy.attrs = {**told, **about}
    return lazy


def _level(array: Any) -> Any:
    """A few posts without heights, at the place of an array."""
    return array[:4, :4].copy(data=numpy.zeros(array[:4, :4].shape, numpy.float32))


@xarray.register_dataarray_accessor("relevo")
class Accessor:
    """Relevo on a DataArray of heights, (y, x). Each call opens the DEM anew, as heights may change; `open()` keeps it.

    Keywords of relevo.open() that the array does not say are those of `open()`; results of the other functions are
    DataArrays with the array's dimensions and coordinates. Of a chunked array they are lazy and have its chunks, from
    the whole DEM, because ground anywhere can shade a post; `halo=` takes all posts only around a chunk.
    """

    def __init__(self, array: xarray.DataArray) -> None:
        self._array = array

    def hours(
        self, date: Optional[Date] = None, *, start: Optional[Date] = None, end: Optional[Date] = None,
        year: Optional[int] = None, tz: Optional[Zone] = None,
        bands: Union[str, list[str], tuple[str, ...]] = "hours", step: Union[float, datetime.timedelta, None] = None,
        linke: Optional[float] = None, albedo: Optional[float] = None, tilt: Optional[float] = None,
        azimuth: Optional[float] = None, terrestrial_refraction: Optional[float] = None,
        refraction: Optional[str] = None, highest: Optional[float] = None, clip: Optional[Clip] = None,
        clip_crs: Optional[Crs] = None, halo: Optional[float] = None, progress: Optional[Progress] = None,
    ) -> xarray.DataArray:
        return _figure(self, "hours", locals())

    def shadow(
        self, time: Optional[Time] = None, *, times: Optional[Times] = None,
        sun: Union[str, Sequence[float], None] = None, date: Optional[Date] = None, tz: Optional[Zone] = None,
        soft: bool = False, terrestrial_refraction: Optional[float] = None, refraction: Optional[str] = None,
        highest: Optional[float] = None, clip: Optional[Clip] = None, clip_crs: Optional[Crs] = None,
        halo: Optional[float] = None, progress: Optional[Progress] = None,
    ) -> xarray.DataArray:
        return _figure(self, "shadow", locals())

    def sky_view(
        self, directions: Optional[int] = None, *, level: bool = False, terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None, clip: Optional[Clip] = None, clip_crs: Optional[Crs] = None,
        halo: Optional[float] = None, progress: Optional[Progress] = None,
    ) -> xarray.DataArray:
        return _figure(self, "sky_view", locals())

    def horizons(
        self, directions: int = 36, *, terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None, clip: Optional[Clip] = None, clip_crs: Optional[Crs] = None,
        halo: Optional[float] = None, progress: Optional[Progress] = None,
    ) -> xarray.DataArray:
        return _figure(self, "horizons", locals())

    for _method in (hours, shadow, sky_view, horizons):
        _method.__doc__ = (getattr(SunOverDem, _method.__name__).__doc__ or "") + _HALO
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
    coords.pop("time", None)
    dims = (*_add_bands(coords, raster), *dims)
    if "spatial_ref" not in coords:
        coords["spatial_ref"] = _spatial_ref(raster)
    values = numpy.broadcast_to(raster.values[..., :1, :1], (*raster.values.shape[:-2], *array.shape)) if (
        raster.values.shape[-2:] != array.shape
    ) else raster.values
    return _described(xarray.DataArray(values, coords=coords, dims=dims), raster)
