"""What figures of places say: the program's `--json`, with times as datetimes in UTC. docs/cli.md has all keys; those of
voids are there where a DEM has voids, direct light where there is a DEM."""

from __future__ import annotations

import datetime
import json
from typing import TYPE_CHECKING, Any, Optional, TypedDict

from . import _relevo
from ._errors import messages
from ._options import library_options, options_text

if TYPE_CHECKING:
    from ._dem import Dem


class Place(TypedDict):
    lat_deg: float
    lon_deg: float
    height_m: float


class Span(TypedDict):
    begin_utc: datetime.datetime
    end_utc: datetime.datetime


class Moment(TypedDict, total=False):
    """When a body stands somewhere. Only of events: kind; only of eclipses: magnitude, obscuration, sun."""

    kind: str
    utc: datetime.datetime
    local: str
    azimuth_deg: float
    elevation_deg: float
    magnitude: float
    obscuration: float
    sun: str


class Light(TypedDict, total=False):
    """Direct light from its first to its last ray. Only of a day: azimuths, elevations, midnights."""

    first_utc: datetime.datetime
    last_utc: datetime.datetime
    first_azimuth_deg: float
    last_azimuth_deg: float
    first_apparent_elevation_deg: float
    last_apparent_elevation_deg: float
    from_midnight: bool
    to_midnight: bool
    not_known: list[Span]


class SunDay(TypedDict, total=False):
    """Times of the first of each kind, None for none; `events` has all. Hours are sums."""

    date: str
    polar: Optional[str]
    sunrise_utc: Optional[datetime.datetime]
    transit_utc: Optional[datetime.datetime]
    sunset_utc: Optional[datetime.datetime]
    civil_dawn_utc: Optional[datetime.datetime]
    civil_dusk_utc: Optional[datetime.datetime]
    day_length_h: float
    golden_hour: list[Span]
    blue_hour: list[Span]
    events: list[Moment]
    direct_sun: list[Light]
    direct_sun_h: float
    level_horizon_h: float
    not_known_h: float


class MoonDay(TypedDict, total=False):
    """As SunDay. illuminated_fraction and phase: at the middle of the day; phases: those that fall on it."""

    date: str
    all_day: Optional[str]
    moonrise_utc: Optional[datetime.datetime]
    transit_utc: Optional[datetime.datetime]
    moonset_utc: Optional[datetime.datetime]
    moon_up_h: float
    illuminated_fraction: float
    phase: str
    phases: list[dict[str, object]]
    events: list[Moment]
    direct_moonlight: list[Light]
    direct_moonlight_h: float
    not_known_h: float


class Eclipse(TypedDict):
    """Contacts and the greatest eclipse, None for those that it has not. central_s: how long it is total or annular."""

    date: str
    kind: str
    magnitude: float
    obscuration: float
    central_s: float
    first_contact: Moment
    greatest: Moment
    last_contact: Moment
    greatest_seen: Optional[Moment]


class Passage(TypedDict):
    """The sun at its closest to a summit. right_deg, above_deg: of its centre, from the summit."""

    utc: datetime.datetime
    local: str
    date: str
    separation_deg: float
    right_deg: float
    above_deg: float
    azimuth_deg: float
    apparent_elevation_deg: float
    sun_visible: bool


class Answer(TypedDict):
    place: Place
    zone: str


class SunDays(Answer):
    definition: str
    days: list[SunDay]
    seasons: list[dict[str, object]]


class MoonDays(Answer):
    definition: str
    days: list[MoonDay]


class Eclipses(Answer):
    definition: str
    eclipses: list[Eclipse]


class Carpet(Answer):
    """Hours of direct sun of a year, over the terrain and over a level horizon."""

    year: int
    light_definition: str
    direct_sun_h: float
    level_horizon_h: float
    months: list[dict[str, float]]
    days: list[SunDay]


class When(Answer):
    """sight: azimuth_deg, elevation_deg, distance_m, visible, hidden_by_deg of the summit."""

    target: Place
    sight: dict[str, float]
    definition: str
    passages: list[Passage]


def _with_times(found: dict[str, Any]) -> dict[str, Any]:
    for key, value in found.items():
        if key.endswith("utc") and value is not None:
            found[key] = datetime.datetime.fromisoformat(value[:-1] + "+00:00")
    return found


def answer(dem: Optional[Dem], figure: str, options: dict[str, Any]) -> Any:
    """A figure of the library by arguments of Python."""
    handle = None if dem is None else dem._handle
    text = options_text(library_options(options))
    with messages():
        return json.loads(_relevo.answer(handle, figure, text), object_hook=_with_times)
