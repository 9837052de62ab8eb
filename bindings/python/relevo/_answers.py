"""What figures of places say: the program's `--json`, with times as datetimes in UTC. docs/cli.md has all keys.
Keys of direct light need a DEM, keys of voids a DEM that has some."""

from __future__ import annotations

import datetime
import json
from typing import TYPE_CHECKING, Any, Optional, TypedDict

from . import _relevo
from ._errors import messages
from ._options import library_options, options_text

if TYPE_CHECKING:
    from ._dem import Dem


_Time = datetime.datetime
_Numbers = dict[str, float]
_Some = dict[str, object]
Place = TypedDict("Place", {"lat_deg": float, "lon_deg": float, "height_m": float})
Span = TypedDict("Span", {"begin_utc": _Time, "end_utc": _Time})
# When a body stands somewhere. Only of events: kind; only of eclipses: magnitude, obscuration, sun.
Moment = TypedDict("Moment", {
    "kind": str, "utc": _Time, "local": str, "azimuth_deg": float, "elevation_deg": float, "magnitude": float,
    "obscuration": float, "sun": str,
}, total=False)
# Direct light from its first to its last ray. Only of a day: azimuths, elevations, midnights.
Light = TypedDict("Light", {
    "first_utc": _Time, "last_utc": _Time, "first_azimuth_deg": float, "last_azimuth_deg": float,
    "first_apparent_elevation_deg": float, "last_apparent_elevation_deg": float, "from_midnight": bool,
    "to_midnight": bool, "not_known": list[Span],
}, total=False)
# Times of the first of each kind, None for none; `events` has all. Hours are sums.
SunDay = TypedDict("SunDay", {
    "date": str, "polar": Optional[str], "sunrise_utc": Optional[_Time], "transit_utc": Optional[_Time],
    "sunset_utc": Optional[_Time], "lower_transit_utc": Optional[_Time], "civil_dawn_utc": Optional[_Time],
    "civil_dusk_utc": Optional[_Time], "nautical_dawn_utc": Optional[_Time], "nautical_dusk_utc": Optional[_Time],
    "astronomical_dawn_utc": Optional[_Time], "astronomical_dusk_utc": Optional[_Time], "day_length_h": float,
    "golden_hour": list[Span], "blue_hour": list[Span], "events": list[Moment], "direct_sun": list[Light],
    "direct_sun_h": float, "level_horizon_h": float, "not_known_h": float,
}, total=False)
# As SunDay. illuminated_fraction and phase: at the middle of the day; phases: those that fall on it.
MoonDay = TypedDict("MoonDay", {
    "date": str, "all_day": Optional[str], "moonrise_utc": Optional[_Time], "transit_utc": Optional[_Time],
    "moonset_utc": Optional[_Time], "lower_transit_utc": Optional[_Time], "moon_up_h": float,
    "illuminated_fraction": float, "phase": str, "phases": list[_Some], "events": list[Moment],
    "direct_moonlight": list[Light], "direct_moonlight_h": float, "not_known_h": float,
}, total=False)
# Contacts and the greatest eclipse. central_s: how long it is total or annular; second and third contact only then.
Eclipse = TypedDict("Eclipse", {
    "date": str, "kind": str, "magnitude": float, "obscuration": float, "central_s": float, "first_contact": Moment,
    "second_contact": Moment, "greatest": Moment, "third_contact": Moment, "last_contact": Moment,
    "greatest_seen": Optional[Moment], "direct_sun": list[Span], "not_known": list[Span], "not_known_h": float,
}, total=False)
# Sun or moon at its closest to a summit. right_deg, above_deg: of its centre, from the summit. Of the moon moon_visible.
Passage = TypedDict("Passage", {
    "utc": _Time, "local": str, "date": str, "separation_deg": float, "right_deg": float, "above_deg": float,
    "azimuth_deg": float, "apparent_elevation_deg": float, "sun_visible": bool, "moon_visible": bool,
}, total=False)
SunDays = TypedDict("SunDays", {
    "place": Place, "zone": str, "definition": str, "days": list[SunDay], "seasons": list[_Some],
})
MoonDays = TypedDict("MoonDays", {"place": Place, "zone": str, "definition": str, "days": list[MoonDay]})
Eclipses = TypedDict("Eclipses", {"place": Place, "zone": str, "definition": str, "eclipses": list[Eclipse]})
# Hours of direct sun of a year, over the terrain and over a level horizon.
Carpet = TypedDict("Carpet", {
    "place": Place, "zone": str, "year": int, "light_definition": str, "horizon_definition": str,
    "direct_sun_h": float, "level_horizon_h": float, "months": list[_Numbers], "days": list[SunDay],
})
# sight: azimuth_deg, elevation_deg, distance_m, visible, hidden_by_deg of the summit.
When = TypedDict("When", {
    "place": Place, "zone": str, "eye_m": float, "target": Place, "sight": _Numbers, "definition": str,
    "passages": list[Passage],
})
WalkEnd = TypedDict("WalkEnd", {
    "utc": _Time, "local": str, "distance_m": float, "lat_deg": float, "lon_deg": float,
})
# light: "sun", "terrain", "night", "not_known".
Stretch = TypedDict("Stretch", {"light": str, "from": WalkEnd, "to": WalkEnd})
# Under each light duration_h, length_m, time_share and length_share. spacing_m, step_s: largest, between samples.
Along = TypedDict("Along", {
    "name": str, "zone": str, "definition": str, "refraction": str, "spacing_m": float, "step_s": float,
    "length_m": float, "duration_h": float, "sun": _Numbers, "terrain": _Numbers, "night": _Numbers,
    "not_known": _Numbers, "stretches": list[Stretch],
})

# Of a raster: memory_mib of the process, computing_s on `threads`, of which sampled_share was done to tell.
Estimate = TypedDict("Estimate", {
    "posts": float, "parts": int, "memory_mib": float, "computing_s": float, "sampled_share": float, "threads": int,
    "bands": int, "result_bytes": float,
})
Tiles = TypedDict("Tiles", {"made": int, "there": int})


def _with_times(found: dict[str, Any]) -> dict[str, Any]:
    for key, value in found.items():
        if key.endswith("utc") and value is not None:
            found[key] = datetime.datetime.fromisoformat(value[:-1] + "+00:00")
    return found


def answer(dem: Optional[Dem], figure: str, arguments: dict[str, Any]) -> Any:
    """A figure of the library by arguments of Python."""
    return library_answer(dem, figure, library_options(arguments))


def library_answer(dem: Optional[Dem], figure: str, options: dict[str, Any]) -> Any:
    """A figure of the library by its own options."""
    handle = None if dem is None else dem._handle
    with messages():
        return json.loads(_relevo.answer(handle, figure, options_text(options)), object_hook=_with_times)
