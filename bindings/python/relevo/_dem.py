"""DEMs."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Any, NoReturn, Optional, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _inputs, _relevo
from ._errors import BadInput, messages
from ._options import options_text
from ._raster import Raster, bounds_of, empty, horizontal
from ._sun_over_dem import MoonOverDem, SunOverDem
from ._times import Date, Time, Zone
from ._transform import Transform
from ._view import Camera, Change, View, change_of


class Dem:
    """A DEM: heights on a grid with a place on the Earth. `relevo.open()` makes one.

    Any thread may use it, several at once. It is closed by `close()`, at the end of a `with`, or with the last reference
    to it; views of it keep what they need.
    """

    def __init__(self, handle: _relevo.Dem, name: str, files: Sequence[str] = (), options: str = "{}") -> None:
        self._handle = handle
        self._name = name
        self._opened_by = {"dem": name, "dem_files": json.dumps(files), "dem_options": options}
        (columns, rows), geotransform, self._centre, self._spacing_m = handle.grid()
        self._shape = rows, columns
        self._transform = Transform.from_gdal(*geotransform)
        self._crs, self._wkt = handle.crs(), handle.wkt()

    @property
    def name(self) -> str:
        """The file's, or what the DEM was made of."""
        return self._name

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self._shape

    @property
    def transform(self) -> Transform:
        """From corners of cells to coordinates of the CRS."""
        return self._transform

    @property
    def crs(self) -> str:
        """The code of the CRS, such as "EPSG:32632", or WKT 2 where it has none."""
        return self._crs

    @property
    def wkt(self) -> str:
        """The CRS as WKT 2."""
        return self._wkt

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(left, bottom, right, top) in the CRS, outer edges of cells."""
        return bounds_of(self._transform, *self._shape)

    @property
    def centre(self) -> tuple[float, float]:
        """(latitude, longitude) of the centre [degrees]."""
        return self._centre

    @property
    def spacing_m(self) -> tuple[float, float]:
        """Ground between columns and between rows at the centre [m]."""
        return self._spacing_m

    @property
    def sun(self) -> SunOverDem:
        """Figures of sunlight: hours, shadow, sky view, horizon."""
        return SunOverDem(self)

    @property
    def moon(self) -> MoonOverDem:
        """Figures of the moon: its days and moonlight, the horizon."""
        return MoonOverDem(self)

    @property
    def closed(self) -> bool:
        return self._handle.closed

    def provenance(self) -> dict[str, str]:
        """What rasters say of the DEM: "dem", its name; "dem_sha256" of heights, grid and CRS, and of surroundings, which is the same for
        copies, in memory and in any format; "dem_files" and "dem_options" by which it was opened, JSON."""
        if "dem_sha256" not in self._opened_by:
            heights = self.heights().values
            found = hashlib.sha256(f"{self._shape} {tuple(self._transform)} {self._wkt} ".encode())
            if around := json.loads(self._opened_by["dem_options"]).get("surroundings"):
                with open(around) as wider:
                    found.update(wider.provenance()["dem_sha256"].encode())
            for row in range(0, len(heights), 64):  # Ctrl-C does not wait for all
                some = heights[row : row + 64]
                some[numpy.isnan(some)] = numpy.nan  # of one kind
                found.update(some.data)
            self._opened_by["dem_sha256"] = found.hexdigest()
        return dict(self._opened_by)

    def heights(self) -> Raster:
        """All heights [m], NaN in voids."""
        values = empty(None, *self._shape)
        with messages():
            self._handle.read(values)
        return self._raster(values, ("height",), ("height",), ("m",), {})

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        return self.heights().__array__(dtype)

    def height(self, lat: ArrayLike, lon: ArrayLike) -> Union[float, NDArray[numpy.float64]]:
        """The height at places [m], bilinear between posts; NaN in voids and outside of the DEM.

        lat, lon: degrees of WGS 84, numbers or arrays. Returns a float, or an array of their shape.
        """
        lats, lons = numpy.asarray(lat, numpy.float64, "C"), numpy.asarray(lon, numpy.float64, "C")
        if lats.shape != lons.shape:
            lats, lons = (numpy.array(degrees) for degrees in numpy.broadcast_arrays(lats, lons))
        heights = numpy.empty(lats.shape)
        with messages():
            self._handle.height(lats, lons, heights)
        return float(heights) if heights.ndim == 0 else heights

    def view(
        self, time: Optional[Time] = None, size: Optional[tuple[int, int]] = None, *, date: Optional[Date] = None,
        tz: Optional[Zone] = None, camera: Optional[Camera] = None, exaggeration: Optional[float] = None,
        scene: Optional[Change] = None, device: str = "auto",
    ) -> View:
        """Opens a scene of the DEM that stays on its device: for many pictures, and for depth, positions and normals.

        time: a datetime, a datetime64 (UTC), seconds since 1970, or a text as the program takes it:
            "2026-06-21T16:30Z", "2026-06-21T18:30" with `tz`, "sunset-30min" with `date`. A datetime or text without
            a time zone needs `tz`. None: a time that shows relief.
        size: (columns, rows) of pictures [pixels]. None: 1280 x 720.
        date: of an event
        tz: zone of times without an offset: "Europe/Zurich", "+02:00", a ZoneInfo, "auto" (the place's)
        camera: as in scenes, such as {"orbit": {"azimuth": 210, "elevation": 30}}. None: one that shows relief.
        exaggeration: vertical exaggeration. None: 1.
        scene: what else a scene has (docs/scene.md), a dict or JSON: effects, overlay, stamps. Arguments go before it.
        device: "auto", "gpu", "software", or a part of a device's name.

        Raises NoDevice where nothing can draw, BadInput for a scene that is wrong.
        """
        return View(
            self._handle,
            change_of(time, size, date, tz, camera, exaggeration, scene),
            device,
            self._name,
        )

    def capture(
        self, time: Optional[Time] = None, size: Optional[tuple[int, int]] = None, *, date: Optional[Date] = None,
        tz: Optional[Zone] = None, camera: Optional[Camera] = None, exaggeration: Optional[float] = None,
        scene: Optional[Change] = None, device: str = "auto",
    ) -> NDArray[numpy.uint8]:
        """A picture, as `view()` draws it: uint8, (rows, columns, 4), sRGB and alpha, the first row at the top.

        Arguments and errors are those of `view()`, which is faster for several pictures.
        """
        with self.view(
            time, size, date=date, tz=tz, camera=camera, exaggeration=exaggeration, scene=scene, device=device
        ) as view:
            return view.draw()

    def close(self) -> None:
        """Gives back what the DEM holds. Later calls raise BadCall."""
        self._handle.close()

    def __enter__(self) -> Dem:
        return self

    def __exit__(
        self, kind: Optional[type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        rows, columns = self._shape
        return f"<relevo.Dem {self._name!r}: {rows} x {columns}{', closed' if self.closed else ''}>"

    def __reduce__(self) -> NoReturn:
        raise TypeError("a relevo.Dem cannot be pickled; open it in each process")

    def _raster(
        self, values: NDArray[numpy.float32], bands: tuple[str, ...], names: tuple[str, ...], units: tuple[str, ...],
        about: dict[str, Any],
    ) -> Raster:
        return Raster(values, self._transform, *horizontal(self._crs, self._wkt), bands, names, units, about)


Path = Union[str, "os.PathLike[str]"]


def open(
    source: _inputs.Source, *, surroundings: Union[Path, Sequence[Path], None] = None, transform: Optional[Sequence[float]] = None, crs: Optional[_inputs.Crs] = None,
    band: Optional[int] = None, unit: Optional[str] = None, nodata: _inputs.Nodata = None,
    encoding: Optional[str] = None, bounds: Optional[Sequence[float]] = None,
    crop: Union[str, Sequence[float], None] = None, memory_mib: Optional[int] = None, holes: Optional[str] = None,
) -> Dem:
    """Opens a DEM.

    source:
        - a path, or several of one DEM, in any format that GDAL opens
        - an open dataset of rasterio
        - an array of heights, (rows, columns), of any numbers: NaN and masked elements are voids. It needs `transform`
          and `crs`. It is copied.
        - a DataArray of xarray with coordinates; the CRS is that of rioxarray (`spatial_ref`) or of CF
    surroundings: files of wider and coarser DEMs in which this one lies, a path or several of one DEM: their ground
        shades figures (not pictures), with heights joined by vertical datum or by the median difference. Voids are
        answered by it. A warning says what does not fit.
    transform: of arrays: an affine.Affine, or its numbers a, b, c, d, e, f: x = a column + b row + c. Those of GDAL's
        order go through relevo.Transform.from_gdal().
    crs: instead of the source's: "EPSG:32632", WKT, a PROJ string, a number of EPSG, a CRS of rasterio or pyproj
    band: of files and datasets, from 1
    unit: of heights, instead of the source's: "m", "ft", "us-ft", "cm", "mm", "dm", "km". The source's is its own, else
        that of the vertical part of the CRS, else metres.
    nodata: a value that marks voids, instead of the source's; "none" for no value. Where the source declares none, a
        value far from all heights, such as -9999, marks voids, with a warning.
    encoding: of files, heights as colours: "terrain-rgb", "terrarium"
    bounds: (west, south, east, north) [degrees] of files without a georeference
    crop: (west, south, east, north) [degrees]: only this part
    memory_mib: that the DEM and what is made of it may take; larger DEMs are read in blocks (3072)
    holes: in pictures, "fill" small voids or "cut" them out

    Raises BadInput for what is no DEM.
    """
    if crop is not None and not isinstance(crop, str):
        crop = ",".join(repr(edge) for edge in _degrees("crop", crop))
    around = _paths(surroundings) if surroundings else None
    if surroundings is not None and around is None:
        raise BadInput("surroundings: expected a path, or several of one DEM")
    common = {
        "crop": crop, "memory_mib": memory_mib, "holes": holes,
        "surroundings": around and [_absolute(path) for path in around],
    }
    for_files = {"encoding": encoding, "bounds": None if bounds is None else _degrees("bounds", bounds)}
    paths = _paths(source)
    if paths is not None:
        if transform is not None:
            raise BadInput("transform: of arrays alone; bounds= places a file")
        text = options_text(
            {"crs": None if crs is None else _inputs.crs_text(crs), "band": band, "unit": unit, "nodata": nodata}
            | for_files
            | common,
        )
        with messages(assumptions=True):
            name = paths[0] if len(paths) == 1 else f"{paths[0]} ..."
            return Dem(_relevo.open_dem(paths, text), name, [_absolute(path) for path in paths], text)
    _refuse(for_files, "of files alone")
    heights, name = _heights(source, transform, crs, band, unit, nodata)
    text = options_text(
            {
            "unit": heights.unit, "nodata": "none" if nodata == "none" else None, "voids_known": heights.voids_known,
            "scale": heights.scale, "offset": heights.offset,
        }
        | common,
    )
    with messages(assumptions=True):
        handle = _relevo.dem_from_heights(heights.values, heights.transform.to_gdal(), heights.crs, text)
        return Dem(handle, name, options=options_text({"surroundings": common["surroundings"]}))


def _paths(source: Any) -> Optional[list[str]]:
    """Names of files; None for other things."""
    if isinstance(source, (str, os.PathLike)):
        return [os.fspath(source)]
    if isinstance(source, (list, tuple)) and not source:
        raise BadInput("source: expected one file or more")
    if isinstance(source, (list, tuple)) and all(isinstance(one, (str, os.PathLike)) for one in source):
        return [os.fspath(one) for one in source]
    return None


def _absolute(path: str) -> str:
    """Names of the net and of archives, which GDAL reads, stay."""
    return os.path.abspath(path) if os.path.exists(path) else path


def _degrees(name: str, edges: Sequence[float]) -> list[float]:
    try:
        west, south, east, north = (float(edge) for edge in edges)
    except (TypeError, ValueError):
        raise BadInput(f"{name}: expected (west, south, east, north) in degrees but got {edges!r}") from None
    return [west, south, east, north]


def _refuse(options: Mapping[str, Any], why: str) -> None:
    for name, value in options.items():
        if value is not None:
            raise BadInput(f"{name}: {why}")


def _heights(
    source: Any, transform: Any, crs: Any, band: Optional[int], unit: Optional[str], nodata: _inputs.Nodata
) -> tuple[_inputs.Heights, str]:
    if _inputs.is_rasterio(source):
        _refuse({"transform": transform}, "of arrays alone; the dataset has one")
        return _inputs.of_rasterio(source, 1 if band is None else band, crs, nodata, unit), str(source.name)
    _refuse({"band": band}, "of files and datasets alone")
    if _inputs.is_dataarray(source):
        return _inputs.of_dataarray(source, transform, crs, nodata, unit), str(source.name or "DataArray")
    return _inputs.of_array(source, transform, crs, nodata, unit), "array"
