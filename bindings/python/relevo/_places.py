"""Figures of sun and moon at a place, over a DEM or a level horizon."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, Optional, TypeVar

from ._answers import Eclipses, MoonDays, SunDays, answer
from ._times import Date, Zone

if TYPE_CHECKING:
    from ._dem import Dem

Days = TypeVar("Days", SunDays, MoonDays)


class OfPlace(Generic[Days]):
    """What a body does at a place. All take

    lat, lon: degrees of WGS 84
    date: a day; or start and end, both included; or year
    tz: zone of the days: "Europe/Zurich", "+05:30", a ZoneInfo. None: the place's.
    height: height of the eye above sea level [m]. None: on the ground of a DEM, else 0.
    eye_height: above the ground of a DEM, or above the level ground around, instead [m] (0)
    limb: part of the disc that counts: "upper", "center", "lower"
    dip: dip of the level horizon [degrees]. None: by eye_height.
    refraction: "standard" (integrated ICAO atmosphere), "saemundsson", "none"
    terrestrial_refraction: of lines of sight over a DEM (0.13)
    highest: what no terrain outside of a DEM exceeds [m] (the DEM's highest post)

    Without limb, dip, refraction and eye_height risings are those of the Naval Observatory. Raises BadInput for places
    outside of a DEM, and warns (relevo.Warning) where terrain outside of it could change values.
    """

    _body = ""

    def __init__(self, dem: Optional[Dem] = None) -> None:
        self._dem = dem

    def day(
        self, lat: float, lon: float, date: Optional[Date] = None, *, start: Optional[Date] = None,
        end: Optional[Date] = None, year: Optional[int] = None, tz: Optional[Zone] = None,
        height: Optional[float] = None, eye_height: Optional[float] = None, limb: Optional[str] = None,
        dip: Optional[float] = None, refraction: Optional[str] = None, terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None,
    ) -> Days:
        """Rising, transit and setting on each of some days, as `days`; over a DEM direct light, too.

        Of the sun twilights, golden and blue hours and the year's `seasons`; of the moon its phase. `events` of a day
        are in order of time. `pandas.DataFrame(found["days"])` makes a table.
        """
        found: Days = answer(self._dem, f"{self._body} day", locals())
        return found


class OfSun(OfPlace[SunDays]):
    """Of the sun."""

    _body = "sun"

    def eclipses(
        self, lat: float, lon: float, date: Optional[Date] = None, *, start: Optional[Date] = None,
        end: Optional[Date] = None, year: Optional[int] = None, tz: Optional[Zone] = None,
        height: Optional[float] = None, eye_height: Optional[float] = None, limb: Optional[str] = None,
        dip: Optional[float] = None, refraction: Optional[str] = None, terrestrial_refraction: Optional[float] = None,
        highest: Optional[float] = None,
    ) -> Eclipses:
        """Eclipses of the sun, with contacts and magnitude; over a DEM also whether terrain hides them."""
        found: Eclipses = answer(self._dem, "sun eclipses", locals())
        return found


class OfMoon(OfPlace[MoonDays]):
    """Of the moon."""

    _body = "moon"
