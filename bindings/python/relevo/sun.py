"""The sun at a place: position and events."""

from __future__ import annotations

import datetime
from typing import NamedTuple, Optional, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _relevo
from ._errors import messages, number, numbers
from ._places import OfSun
from ._times import Date, Times, Zone, date_text, seconds, utc, zone_text

__all__ = ["Event", "Position", "day", "eclipses", "events", "position"]

day, eclipses = OfSun().day, OfSun().eclipses


class Position(NamedTuple):
    """Where the sun stands: floats, or float64 arrays in the shape of places and times."""

    azimuth: Union[float, NDArray[numpy.float64]]
    """Degrees clockwise from true north."""
    elevation: Union[float, NDArray[numpy.float64]]
    """Degrees, without an atmosphere."""
    apparent: Union[float, NDArray[numpy.float64]]
    """Degrees, elevation with refraction."""


class Event(NamedTuple):
    """Something that the sun does over a level horizon."""

    kind: str
    """"sunrise", "transit", "sunset", "civil_dusk" ..."""
    time: datetime.datetime
    """In UTC; `time.astimezone(ZoneInfo("Europe/Zurich"))` has another zone."""
    azimuth: float
    """Degrees clockwise from true north."""
    elevation: float
    """Of the centre of the disc [degrees], without refraction."""


def position(
    lat: ArrayLike, lon: ArrayLike, times: Times, *, tz: Optional[Zone] = None, height: ArrayLike = 0.0, refraction: str = "standard"
) -> Position:
    """Where the sun stands.

    lat, lon: degrees of WGS 84, east positive; numbers or arrays
    times: datetimes, datetime64 (UTC), texts such as "2026-06-21T12:00+02:00", or seconds since 1970, one or many; 1900
        to 2100
    tz: of datetimes and texts that have none: "Europe/Zurich", "+02:00", a ZoneInfo
    height: above the ellipsoid [m], of which refraction depends
    refraction: "standard" (integrated ICAO atmosphere), "saemundsson", "none"

    Arrays are broadcast as numpy does it. Accurate to 0.1 arc-seconds from 1962 to 2026.
    Raises BadInput for times without a zone where none is given, and for places and times that are none.
    """
    places = [numbers(name, value) for name, value in (("lat", lat), ("lon", lon), ("height", height))]
    given = seconds(times, tz)
    one_place = all(one.ndim == 0 for one in places)
    shape = given.shape if one_place else numpy.broadcast_shapes(given.shape, *(one.shape for one in places))
    if not one_place:
        places = [numpy.broadcast_to(one, shape).ravel() for one in places]
    where = numpy.stack(places, axis=-1) if places[0].ndim else numpy.array(places)
    times_s = numpy.ascontiguousarray(numpy.broadcast_to(given, shape)).ravel()
    results = numpy.empty((3, times_s.size))
    with messages():
        _relevo.sun_position(numpy.ascontiguousarray(where), times_s, refraction, results)
    if shape == ():
        return Position(*(float(result[0]) for result in results))
    return Position(*(result.reshape(shape) for result in results))


def events(lat: float, lon: float, date: Date, tz: Optional[Zone] = None, *, height: float = 0.0) -> list[Event]:
    """What the sun does on a local day over a level horizon, in order of time, by the rule of the Naval Observatory.

    lat, lon: degrees of WGS 84, east positive
    date: a date, or a text such as "2026-06-21"
    tz: of the day, "Europe/Zurich", "+02:00", a ZoneInfo. None: that of the place.
    height: above the ellipsoid [m]
    """
    name = None if tz is None else zone_text(tz)
    with messages():
        found = _relevo.sun_events(number("lat", lat), number("lon", lon), number("height", height), date_text(date), name)
    return [Event(kind, utc(time_s), azimuth, elevation) for kind, time_s, azimuth, elevation in found]
