"""The moon over a place, without terrain.

    relevo.moon.position(46.95, 7.44, "2026-06-21T22:00+02:00")
    relevo.moon.day(46.95, 7.44, "2026-06-21")["days"][0]["moonrise_utc"]
"""

from __future__ import annotations

from typing import NamedTuple, Optional

import numpy
from numpy.typing import NDArray

from ._answers import answer
from ._places import OfMoon
from ._times import Times, Zone, seconds

__all__ = ["Position", "day", "position"]

day = OfMoon().day


class Position(NamedTuple):
    """Where the moon stands and how it is lit: arrays in the shape of the times."""

    azimuth: NDArray[numpy.float64]
    """Degrees clockwise from true north."""
    elevation: NDArray[numpy.float64]
    """Degrees, without an atmosphere."""
    apparent: NDArray[numpy.float64]
    """Degrees, elevation with refraction."""
    distance: NDArray[numpy.float64]
    """From the place [km]."""
    illuminated: NDArray[numpy.float64]
    """Fraction of the disc."""
    phase_angle: NDArray[numpy.float64]
    """Degrees, 0 at full moon."""
    bright_limb: NDArray[numpy.float64]
    """Middle of the bright limb, from the zenith to the left [degrees]."""


_KEYS = (
    "azimuth_deg", "elevation_deg", "apparent_elevation_deg", "distance_km", "illuminated_fraction", "phase_angle_deg",
    "bright_limb_from_zenith_deg",
)


def position(
    lat: float, lon: float, times: Times, *, tz: Optional[Zone] = None, height: float = 0.0,
    refraction: str = "standard",
) -> Position:
    """Where the moon stands.

    lat, lon: degrees of WGS 84, east positive
    times, tz: as in `relevo.sun.position`
    height: above sea level [m]
    refraction: "standard" (integrated ICAO atmosphere), "saemundsson", "none"
    """
    given = seconds(times, tz)
    rows = []
    for some in numpy.array_split(given.ravel(), max(1, -(-given.size // 1000))):  # Ctrl-C ends what follows
        options = {"lat": lat, "lon": lon, "height": height, "refraction": refraction, "times": some}
        rows += [[one[key] for key in _KEYS] for one in answer(None, "moon position", options)["positions"]]
    return Position(*(column.reshape(given.shape) for column in numpy.array(rows).reshape(-1, len(_KEYS)).T))
