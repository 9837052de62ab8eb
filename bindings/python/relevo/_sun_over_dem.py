"""Figures of sunlight over a DEM."""

from __future__ import annotations

import datetime
import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy
from numpy.typing import NDArray

from ._clip import Clip, part_of
from ._errors import BadInput, messages
from ._options import options_text
from ._raster import Raster, band_list, empty
from ._times import Date, Time, Zone, date_text, time_text, zone_text

if TYPE_CHECKING:
    from ._dem import Dem

Progress = Callable[[float], object]
"""Is called with the share that is done, 0 to 1, on the thread that has called. False from it cancels."""


_TEXTS: dict[str, Callable[[Any], str]] = {
    "date": date_text, "from": date_text, "to": date_text, "zone": zone_text,
}


class Horizon(NamedTuple):
    """The horizon that the ground makes around a place; float64, an element for each direction."""

    azimuth: NDArray[numpy.float64]
    """Degrees clockwise from true north."""
    elevation: NDArray[numpy.float64]
    """Degrees, terrestrial refraction included."""
    distance: NDArray[numpy.float64]
    """Of the ground that makes the horizon [m]; NaN where that is outside of the DEM."""


class SunOverDem:
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

    def __init__(self, dem: Dem) -> None:
        self._dem = dem

    def hours(
        self,
        date: Optional[Date] = None,
        *,
        start: Optional[Date] = None,
        end: Optional[Date] = None,
        year: Optional[int] = None,
        zone: Optional[Zone] = None,
        bands: Union[str, list[str], tuple[str, ...]] = "hours",
        step: Union[float, datetime.timedelta, None] = None,
        linke: Optional[float] = None,
        albedo: Optional[float] = None,
        terrestrial_refraction: Optional[float] = None,
        refraction: Optional[str] = None,
        highest: Optional[float] = None,
        clip: Optional[Clip] = None,
        clip_crs: Any = None,
        progress: Optional[Progress] = None,
    ) -> Raster:
        """Hours of direct sun, and what belongs to them.

        One of these: date, a day; start and end, both included; year, all of its days.

        zone: of the days, "Europe/Zurich", "+05:30", a ZoneInfo. None: that of the place.
        bands: "hours" [h]; of at most four days "first", "last" (minutes from the beginning to the first and the last
            sun) and "spells" (sunshine periods); "global", "beam", "diffuse", "reflected" (clear sky, kWh/m2). A list
            gives values of (bands, rows, columns).
        step: of the sun, of at most four days [s] (180)
        linke: Linke turbidity of irradiation (3)
        albedo: of the ground, of irradiation (0.2)
        """
        names, alone = band_list(bands)
        if isinstance(step, datetime.timedelta):
            step = step.total_seconds()
        return self._raster(
            "sun_hours", names, alone, progress,
            {
                "date": date, "from": start, "to": end, "year": year, "zone": zone, "bands": names, "step": step,
                "linke": linke, "albedo": albedo, "terrestrial_refraction": terrestrial_refraction,
                "refraction": refraction, "highest": highest, "clip": clip, "clip_crs": clip_crs,
            },
        )

    def shadow(
        self,
        time: Time,
        *,
        date: Optional[Date] = None,
        zone: Optional[Zone] = None,
        soft: bool = False,
        terrestrial_refraction: Optional[float] = None,
        refraction: Optional[str] = None,
        highest: Optional[float] = None,
        clip: Optional[Clip] = None,
        clip_crs: Any = None,
        progress: Optional[Progress] = None,
    ) -> Raster:
        """Light and shade at a time: 1 in light, 0 in the shadow of the ground.

        time, date, zone: as in `Dem.view()`
        soft: the visible fraction of the solar disc instead
        """
        return self._raster(
            "shadow", ["shadow"], True, progress,
            {
                "time": time_text(time, zone), "date": date, "zone": zone, "soft": soft,
                "terrestrial_refraction": terrestrial_refraction, "refraction": refraction, "highest": highest, "clip": clip, "clip_crs": clip_crs,
            },
        )

    def sky_view(
        self,
        directions: Optional[int] = None,
        *,
        level: bool = False,
        terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None,
        clip: Optional[Clip] = None,
        clip_crs: Any = None,
        progress: Optional[Progress] = None,
    ) -> Raster:
        """The sky-view factor, 0 to 1.

        directions: in which horizons are computed (36)
        level: of a level plane instead of the ground as it is inclined
        """
        return self._raster(
            "sky_view", ["sky_view"], True, progress,
            {
                "directions": directions, "level": level, "terrestrial_refraction": terrestrial_refraction,
                "highest": highest, "clip": clip, "clip_crs": clip_crs,
            },
        )

    def horizons(
        self,
        directions: int = 36,
        *,
        terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None,
        clip: Optional[Clip] = None,
        clip_crs: Any = None,
        progress: Optional[Progress] = None,
    ) -> Raster:
        """The horizon of each post [degrees]: values of (directions, rows, columns), evenly spread from north.

        directions: 1 to 720. Bands are named by their azimuths: `raster["90"]` is that to the east.
        """
        if isinstance(directions, bool) or directions not in range(1, 721):
            raise BadInput(f"directions: expected a whole number from 1 to 720 but got {directions!r}")
        names = [f"{360 * i / directions:.10g}" for i in range(directions)]
        return self._raster(
            "horizons", names, False, progress,
            {
                "directions": int(directions), "terrestrial_refraction": terrestrial_refraction, "highest": highest,
                "clip": clip, "clip_crs": clip_crs,
            },
        )

    def horizon(
        self,
        lat: float,
        lon: float,
        *,
        eye_height: float = 0.0,
        step: float = 1.0,
        azimuth: Any = None,
        terrestrial_refraction: Optional[float] = None,
    ) -> Horizon:
        """The horizon that the ground makes around a place.

        lat, lon: degrees of WGS 84
        eye_height: above the ground [m]
        step: of the azimuth, from north [degrees]
        azimuth: directions instead of a step [degrees]

        Raises BadInput for a place without ground.
        """
        if azimuth is None:
            if not 0.001 <= step <= 360:
                raise BadInput(f"step: expected 0.001 to 360 degrees but got {step}")
            azimuth = numpy.arange(int(numpy.ceil(round(360 / step, 6)))) * step
        azimuths = numpy.ascontiguousarray(numpy.atleast_1d(azimuth), dtype=numpy.float64)
        elevation, distance = numpy.empty_like(azimuths), numpy.empty_like(azimuths)
        options = options_text(
            "horizon", {"eye_height": eye_height, "terrestrial_refraction": terrestrial_refraction}
        )
        with messages():
            self._dem._handle.horizon(float(lat), float(lon), options, azimuths, elevation, distance)
        return Horizon(azimuths, elevation, distance)

    def _raster(
        self, figure: str, names: list[str], alone: bool, progress: Optional[Progress], options: dict[str, Any]
    ) -> Raster:
        """A figure by its function of the library."""
        for key, text in _TEXTS.items():
            if options.get(key) is not None:
                options[key] = text(options[key])
        values = empty(None if alone else len(names), *self._dem.shape)
        fill = getattr(self._dem._handle, figure)
        part = part_of(self._dem, options.pop("clip", None), options.pop("clip_crs", None))
        who = figure.removeprefix("sun_")
        asked, said = options_text(who, {**options, **part.asked}), options_text(who, {**options, **part.said})
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
