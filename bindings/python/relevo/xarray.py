"""An accessor of xarray: `array.relevo` on a DataArray of heights. `import relevo.xarray` registers it; `import relevo`
does where xarray is imported already.

    import xarray, relevo.xarray
    hours = heights.relevo.hours("2026-06-21")
"""

from __future__ import annotations

from typing import Any

import numpy
import xarray
from numpy.typing import NDArray

from ._dem import Dem, open
from ._raster import Raster
from ._sun_over_dem import Horizon


_UDUNITS = {"deg": "degree", "kWh/m2": "kW h m-2"}


def to_dataarray(raster: Raster) -> Any:
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


@xarray.register_dataarray_accessor("relevo")
class Accessor:
    """Relevo on a DataArray of heights, (y, x). Each call opens the DEM anew, as heights may change; `open()` keeps it.

    Keywords of relevo.open() that the array does not say are those of `open()`; results of the other functions are
    DataArrays with the array's dimensions and coordinates.
    """

    def __init__(self, array: Any) -> None:
        self._array = array

    def open(self, **options: Any) -> Dem:
        """relevo.open() of the array."""
        return open(self._array, **options)

    def hours(self, *arguments: Any, **options: Any) -> Any:
        """`Dem.sun.hours()` as a DataArray."""
        with self.open() as dem:
            return self._aligned(dem.sun.hours(*arguments, **options))

    def shadow(self, *arguments: Any, **options: Any) -> Any:
        """`Dem.sun.shadow()` as a DataArray."""
        with self.open() as dem:
            return self._aligned(dem.sun.shadow(*arguments, **options))

    def sky_view(self, *arguments: Any, **options: Any) -> Any:
        """`Dem.sun.sky_view()` as a DataArray."""
        with self.open() as dem:
            return self._aligned(dem.sun.sky_view(*arguments, **options))

    def horizon(self, *arguments: Any, **options: Any) -> Horizon:
        """`Dem.sun.horizon()`."""
        with self.open() as dem:
            return dem.sun.horizon(*arguments, **options)

    def capture(self, *arguments: Any, **options: Any) -> NDArray[numpy.uint8]:
        """`Dem.capture()`."""
        with self.open() as dem:
            return dem.capture(*arguments, **options)

    def _aligned(self, raster: Raster) -> Any:
        """With dimensions and coordinates of the array that the DEM was made of."""
        array = self._array.squeeze(drop=False)
        dims, coords = array.dims, dict(array.coords)
        if raster.values.ndim == 3:
            coords.pop("band", None)
            dims = ("band", *dims)
            coords["band"] = list(raster.bands)
        if "spatial_ref" not in coords:
            coords["spatial_ref"] = _spatial_ref(raster)
        return _described(xarray.DataArray(raster.values, coords=coords, dims=dims), raster)
