"""Figures of sunlight and of the moon over a DEM."""

from __future__ import annotations

import datetime
import json
import os
import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from ._answers import Along, Carpet, Estimate, Tiles, When, answer, library_answer
from ._clip import Clip, part_of
from ._errors import BadInput, messages, number, numbers
from ._inputs import Crs, crs_text
from ._options import library_options, options_text
from ._places import OfMoon, OfSun
from ._raster import Raster, band_list, empty
from ._times import Date, Time, Times, Zone, seconds, time_text, utc

if TYPE_CHECKING:
    import pandas

    from ._dem import Dem

Progress = Callable[[float], object]
"""Is called with the share that is done, 0 to 1, on the thread that has called. False from it cancels."""


class Horizon(NamedTuple):
    """The horizon that the ground makes around a place; float64, an element for each direction."""

    azimuth: NDArray[numpy.float64]
    """Degrees clockwise from true north."""
    elevation: NDArray[numpy.float64]
    """Degrees, terrestrial refraction included."""
    distance: NDArray[numpy.float64]
    """Of the ground that makes the horizon [m]; NaN where that is outside of the DEM."""

    def to_pandas(self) -> pandas.Series[float]:
        """Elevations by azimuth, as pvlib has horizon profiles."""
        import pandas

        index = pandas.Index(self.azimuth, name="horizon_azimuth")
        return pandas.Series(self.elevation, index, name="horizon_elevation")


def shadow_options(options: dict[str, Any]) -> dict[str, Any]:
    """Options of the library by arguments or options, with the library's times and sun."""
    options = library_options(options)
    zone = options.get("zone")
    if "time" in options:
        options["time"] = time_text(options["time"], zone)
    if "times" in options:
        options["times"] = numpy.atleast_1d(seconds(options["times"], zone)).ravel().tolist()
    if "sun" in options and not isinstance(options["sun"], str):
        try:
            azimuth, elevation = options["sun"]
            options["sun"] = f"{float(azimuth)!r},{float(elevation)!r}"
        except (TypeError, ValueError):
            raise BadInput(f"sun: expected (azimuth, elevation) but got {options['sun']!r}") from None
    return options


def time_names(times: list[float]) -> list[str]:
    """Of bands: "2026-12-21T14:00:00Z"."""
    return [f"{utc(round(one)).isoformat()[:19]}Z" for one in times]


class _OverDem:
    """What figures of sun and moon have in common."""

    _dem: Dem
    _body: str

    def horizon(
        self, lat: float, lon: float, *, eye_height: float = 0.0, step: float = 1.0,
        azimuth: Optional[ArrayLike] = None, terrestrial_refraction: Optional[float] = None,
    ) -> Horizon:
        """The horizon that the ground makes around a place.

        lat, lon: degrees of WGS 84
        eye_height: above the ground [m]
        step: of the azimuth, from north [degrees]
        azimuth: directions instead of a step [degrees]

        Raises BadInput for a place without ground.
        """
        if azimuth is None:
            step = number("step", step, 0.001, 360)
            azimuth = numpy.arange(int(numpy.ceil(round(360 / step, 6)))) * step
        azimuths = numpy.ascontiguousarray(numpy.atleast_1d(numbers("azimuth", azimuth)))
        elevation, distance = numpy.empty_like(azimuths), numpy.empty_like(azimuths)
        options = options_text(
            {"eye_height": eye_height, "terrestrial_refraction": terrestrial_refraction}
        )
        with messages():
            self._dem._handle.horizon(number("lat", lat), number("lon", lon), options, azimuths, elevation, distance)
        return Horizon(azimuths, elevation, distance)

    def when(
        self, lat: float, lon: float, over: Union[tuple[float, float], tuple[float, float, float]],
        date: Optional[Date] = None, *, start: Optional[Date] = None, end: Optional[Date] = None,
        year: Optional[int] = None, tz: Optional[Zone] = None, summit_radius: Optional[float] = None,
        tolerance: Optional[float] = None, height: Optional[float] = None, eye_height: Optional[float] = None,
        refraction: Optional[str] = None, terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None,
    ) -> When:
        """When sun or moon stand over a summit, seen from a place. Other arguments are those of `day()`.

        over: (lat, lon) for the highest post nearby, or (lat, lon, height) for that point
        summit_radius: in which that post is searched [m] (100)
        tolerance: largest distance of its centre [degrees] (0.5)
        """
        options = library_options(locals())
        try:
            options["over"] = ",".join(repr(float(number)) for number in over)
        except (TypeError, ValueError):
            raise BadInput(f"over: expected (lat, lon) or (lat, lon, height) but got {over!r}") from None
        found: When = answer(self._dem, f"{self._body} when", options)
        return found


class MoonOverDem(OfMoon, _OverDem):
    """Figures of the moon over a DEM: `dem.moon`."""

    _dem: Dem


class SunOverDem(OfSun, _OverDem):
    """Figures of sunlight over a DEM: `dem.sun`.

    Rasters have the DEM's rows and columns; values are those of the program, to the bit. Ctrl-C ends them with
    KeyboardInterrupt and leaves the DEM usable. All take

    progress: a function that is called with the share that is done; False from it raises Cancelled
    terrestrial_refraction: curvature of a line of sight in units of the Earth's (0.13)
    refraction: of the sun: "standard" (integrated ICAO atmosphere), "saemundsson", "none"; not of the sky view
    highest: what no terrain outside of the DEM exceeds [m] (the DEM's highest post)
    clip: (west, south, east, north) in `clip_crs` (the DEM's CRS), or polygons: anything with `__geo_interface__`, as
        shapely and geopandas have it, in `clip_crs` (their own `crs`, else the DEM's); of another CRS the vertices
        are moved and edges are straight in the DEM's. Only posts in it are computed, in the shade of the whole DEM;
        others are NaN. Polygons need rasterio.

    and warn (relevo.Warning) where terrain outside of the DEM could change values.
    """

    _dem: Dem

    def __init__(self, dem: Dem) -> None:
        super().__init__(dem)

    def hours(
        self, date: Optional[Date] = None, *, start: Optional[Date] = None, end: Optional[Date] = None,
        year: Optional[int] = None, tz: Optional[Zone] = None,
        bands: Union[str, list[str], tuple[str, ...]] = "hours", step: Union[float, datetime.timedelta, None] = None,
        linke: Optional[float] = None, albedo: Optional[float] = None, tilt: Optional[float] = None,
        azimuth: Optional[float] = None, terrestrial_refraction: Optional[float] = None,
        refraction: Optional[str] = None, highest: Optional[float] = None, clip: Optional[Clip] = None,
        clip_crs: Optional[Crs] = None, progress: Optional[Progress] = None,
    ) -> Raster:
        """Hours of direct sun, and what belongs to them.

        One of these: date, a day; start and end, both included; year, all of its days.

        tz: zone of the days: "Europe/Zurich", "+05:30", a ZoneInfo. None: the place's.
        bands: "hours" [h]; of at most four days "first", "last" (minutes from the beginning to the first and the last
            sun) and "spells" (sunshine periods); "global", "beam", "diffuse", "reflected" (clear sky, kWh/m2). A list
            gives values of (bands, rows, columns).
        step: of the sun, of at most four days [s] (180)
        linke: Linke turbidity of irradiation (3)
        albedo: of the ground, of irradiation (0.2)
        tilt, azimuth: of a plane at each post that irradiation falls on: 0 level, 90 a wall; where it faces, clockwise
            from true north [degrees]. None: as the ground is inclined
        """
        options = library_options(locals())
        options["bands"], alone = band_list(bands)
        return self._raster("sun_hours", options["bands"], alone, options, progress)

    def shadow(
        self, time: Optional[Time] = None, *, times: Optional[Times] = None,
        sun: Union[str, Sequence[float], None] = None, date: Optional[Date] = None, tz: Optional[Zone] = None,
        soft: bool = False, terrestrial_refraction: Optional[float] = None, refraction: Optional[str] = None,
        highest: Optional[float] = None, clip: Optional[Clip] = None, clip_crs: Optional[Crs] = None,
        progress: Optional[Progress] = None,
    ) -> Raster:
        """Light and shade: 1 in light, 0 in the shadow of the ground. One of these:

        time, date, tz: as in `Dem.view()`
        times: a list, as in `relevo.sun.position`: values of (times, rows, columns), a band for each, named by its
            time in `tz`
        sun: (azimuth, elevation) as the sun is seen [degrees], or "grid:AZ,EL" from the north of the grid

        soft: the visible fraction of the solar disc instead
        """
        options = shadow_options(locals())
        names = ["shadow"] if times is None else time_names(options["times"])
        return self._raster("shadow", names, times is None, options, progress)

    def sky_view(
        self, directions: Optional[int] = None, *, level: bool = False, terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None, clip: Optional[Clip] = None, clip_crs: Optional[Crs] = None,
        progress: Optional[Progress] = None,
    ) -> Raster:
        """The sky-view factor, 0 to 1.

        directions: in which horizons are computed (36)
        level: of a level plane instead of the ground as it is inclined
        """
        return self._raster("sky_view", ["sky_view"], True, library_options(locals()), progress)

    def horizons(
        self, directions: int = 36, *, terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None, clip: Optional[Clip] = None, clip_crs: Optional[Crs] = None,
        progress: Optional[Progress] = None,
    ) -> Raster:
        """The horizon of each post [degrees]: values of (directions, rows, columns), evenly spread from north.

        directions: 1 to 720. Bands are named by their azimuths: `raster["90"]` is that to the east.
        """
        options = library_options(locals())
        if isinstance(directions, bool) or directions not in range(1, 721):
            raise BadInput(f"directions: expected a whole number from 1 to 720 but got {directions!r}")
        names = [f"{360 * i / directions:.10g}" for i in range(directions)]
        return self._raster("horizons", names, False, options, progress)

    def carpet(
        self, lat: float, lon: float, year: int, *, tz: Optional[Zone] = None,
        step: Union[float, datetime.timedelta, None] = None, height: Optional[float] = None,
        eye_height: Optional[float] = None, limb: Optional[str] = None, refraction: Optional[str] = None,
        terrestrial_refraction: Optional[float] = None, highest: Optional[float] = None,
    ) -> Carpet:
        """Direct sun of a year at a place: each day's, and sums of months. Arguments are those of `day()`.

        step: of the time of day, of whole seconds [s] (180)
        """
        found: Carpet = answer(self._dem, "sun carpet", locals())
        return found

    def along(
        self, walk: Union[str, os.PathLike[str], ArrayLike], *, times: Optional[Times] = None,
        start: Optional[Time] = None, speed: Optional[float] = None, tz: Optional[Zone] = None,
        track: Optional[int] = None, points_crs: Optional[Crs] = None, name: Optional[str] = None,
        eye_height: Optional[float] = None, refraction: Optional[str] = None,
        terrestrial_refraction: Optional[float] = None, highest: Optional[float] = None,
    ) -> Along:
        """Where a walk is in the sun. Other arguments are those of `day()`.

        walk: (points, 2) of (lat, lon), or a GPX, GeoJSON or CSV
        times: of an array's points, in order, as in `relevo.sun.position`
        start: when it begins, instead of its own times: as `time` of `Dem.view()`; events at its first point with
            their date, "2026-02-10 sunrise"
        speed: on the map [km/h]. None: by its own times, which start alone shifts.
        tz: of texts and datetimes without a zone. None: that of the first point.
        track: number of the track in a file, from 1
        points_crs: of columns x and y in a CSV
        """
        options = library_options({**locals(), "start": None, "times": None})
        if isinstance(walk, (str, os.PathLike)):
            options["walk"] = os.fspath(walk)
        else:
            places = numbers("walk", walk)
            if places.ndim != 2 or places.shape[1] != 2:
                raise BadInput(f"walk: expected an array of (points, 2) or a file but got {places.shape}")
            options["walk"] = places
        if times is not None:
            options["times"] = numpy.atleast_1d(seconds(times, tz))
        if start is not None:
            options["start"] = time_text(start, tz, "start")
        if points_crs is not None:
            options["points_crs"] = crs_text(points_crs, "points_crs")
        try:
            found: Along = library_answer(self._dem, "sun along", options)
        except BadInput as error:
            if start is None:
                raise
            raise BadInput(re.sub("^time:", "start:", str(error)).replace(" or pass date=", "")) from None
        return found

    def estimate(
        self, figure: str, *, time: Optional[Time] = None, times: Optional[Times] = None,
        sun: Union[str, Sequence[float], None] = None, date: Optional[Date] = None, start: Optional[Date] = None,
        end: Optional[Date] = None, year: Optional[int] = None, tz: Optional[Zone] = None,
        bands: Union[str, list[str], tuple[str, ...], None] = None, step: Union[float, datetime.timedelta, None] = None,
        linke: Optional[float] = None, albedo: Optional[float] = None, tilt: Optional[float] = None,
        azimuth: Optional[float] = None, soft: Optional[bool] = None,
        directions: Optional[int] = None, level: Optional[bool] = None, terrestrial_refraction: Optional[float] = None,
        refraction: Optional[str] = None, highest: Optional[float] = None, clip: Optional[Sequence[float]] = None,
        clip_crs: Optional[Crs] = None, progress: Optional[Progress] = None,
    ) -> Estimate:
        """Time and memory that a raster takes, estimated from a small part of it.

        figure: "hours", "shadow", "sky_view" or "horizons"; other arguments are those of that method
        """
        found: Estimate = self._files(figure, library_options(locals()), None, progress)
        return found

    def tiles(
        self, figure: str, folder: Union[str, os.PathLike[str]], *, tiles: int = 512, halo: Optional[float] = None,
        resume: bool = False, overwrite: bool = False, time: Optional[Time] = None, times: Optional[Times] = None,
        sun: Union[str, Sequence[float], None] = None, date: Optional[Date] = None, start: Optional[Date] = None, end: Optional[Date] = None, year: Optional[int] = None, tz: Optional[Zone] = None,
        bands: Union[str, list[str], tuple[str, ...], None] = None, step: Union[float, datetime.timedelta, None] = None,
        linke: Optional[float] = None, albedo: Optional[float] = None, tilt: Optional[float] = None,
        azimuth: Optional[float] = None, soft: Optional[bool] = None,
        directions: Optional[int] = None, level: Optional[bool] = None, terrestrial_refraction: Optional[float] = None,
        refraction: Optional[str] = None, highest: Optional[float] = None, clip: Optional[Sequence[float]] = None,
        clip_crs: Optional[Crs] = None, progress: Optional[Progress] = None,
    ) -> Tiles:
        """Writes a raster as GeoTIFFs of tiles, also of DEMs that memory does not hold. `relevo merge` joins them.

        figure: "hours", "shadow", "sky_view" or "horizons"; other arguments are those of that method
        tiles: posts a side
        halo: posts only so many km around a tile, ground beyond as means, exact to 0.1 degrees (all posts)
        resume: keep tiles that are there, complete and of the same call
        overwrite: replace files
        """
        options = library_options(locals())
        files = {key: options.pop(key) for key in ("folder", "tiles", "halo", "resume", "overwrite") if key in options}
        try:
            files["folder"] = os.fspath(folder)
        except TypeError:
            raise BadInput(f"folder: expected a name but got {folder!r}") from None
        found: Tiles = self._files(figure, options, options_text(files), progress)
        return found

    def _files(self, figure: str, options: dict[str, Any], files: Optional[str], progress: Optional[Progress]) -> Any:
        """`relevo_tiles()` of the library."""
        if figure not in ("hours", "shadow", "sky_view", "horizons"):
            raise BadInput(f"figure: expected hours, shadow, sky_view or horizons but got {figure!r}")
        del options["figure"]
        if "bands" in options:
            options["bands"], _ = band_list(options["bands"])
        options = shadow_options(options)
        part = part_of(self._dem, options.pop("clip", None), options.pop("clip_crs", None))
        name = figure if figure != "hours" else "sun_hours"
        with messages():
            return json.loads(self._dem._handle.tiles(name, options_text({**options, **part.asked}), files, progress))

    def _raster(
        self, figure: str, names: list[str], alone: bool, options: dict[str, Any], progress: Optional[Progress]
    ) -> Raster:
        """A figure by its function of the library."""
        values = empty(None if alone else len(names), *self._dem.shape)
        fill = getattr(self._dem._handle, figure)
        part = part_of(self._dem, options.pop("clip", None), options.pop("clip_crs", None))
        asked, said = options_text({**options, **part.asked}), options_text({**options, **part.said})
        of_dem = self._dem.provenance()  # before the figure, during which others may close the DEM
        with messages():
            about = json.loads(fill(asked, values, progress))
        if part.outside is not None:
            values[..., part.outside] = numpy.nan
        described = about.pop("bands")
        told = {key.lower().removeprefix("tifftag_"): value for key, value in about.pop("metadata").items()}
        about = {**told, **about, **of_dem, "figure": figure, "options": said}
        titles = tuple(band["name"] for band in described)
        units = tuple(band["unit"] for band in described)
        return self._dem._raster(values, tuple(names), titles, units, about)

    def __repr__(self) -> str:
        return f"<sun over {self._dem!r}>"
