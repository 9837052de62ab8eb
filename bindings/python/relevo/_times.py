"""Times and dates of Python as the library takes them."""

from __future__ import annotations

import datetime
import re
import zoneinfo
from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from ._errors import BadInput

Time = Union[str, datetime.datetime, numpy.datetime64, float]
Date = Union[str, datetime.date, numpy.datetime64]
Zone = Union[str, datetime.tzinfo]
Times = Union[Time, Sequence[Time], ArrayLike]

_EPOCH = datetime.datetime(1970, 1, 1, tzinfo=datetime.timezone.utc)
_MICROSECOND = datetime.timedelta(microseconds=1)
_WALL_TIME = re.compile(r"\s*\d+-\d+-\d+[Tt ]\d+(:[\d.]+)*\s*")  # a time of day without a zone


def zone_text(zone: Zone) -> str:
    """A zone as the library takes it: "Europe/Zurich", "+02:00", "auto"."""
    if isinstance(zone, str):
        return zone
    name = getattr(zone, "key", None) or getattr(zone, "zone", None)  # of zoneinfo, of pytz
    if isinstance(name, str):
        return name
    offset = zone.utcoffset(None) if isinstance(zone, datetime.tzinfo) else None
    if offset is None:
        raise BadInput(f'tz: expected a name such as "Europe/Zurich", a ZoneInfo or a timezone but got {zone!r}')
    minutes = offset // datetime.timedelta(minutes=1)
    return f"{'-' if minutes < 0 else '+'}{abs(minutes) // 60:02}:{abs(minutes) % 60:02}"


def _tzinfo_of(zone: Zone) -> datetime.tzinfo:
    if isinstance(zone, datetime.tzinfo):
        return zone
    text = zone_text(zone)
    try:
        if text[:1] in ("+", "-"):
            offset = datetime.datetime.fromisoformat(f"2000-01-01T00:00{text}").tzinfo
            assert offset is not None
            return offset
        return zoneinfo.ZoneInfo("UTC" if text == "Z" else text)
    except (ValueError, OSError, zoneinfo.ZoneInfoNotFoundError):
        raise BadInput(f'tz: expected one as "Europe/Zurich" or "+02:00" but got {zone!r}') from None


def _no_zone(time: str, remedy: str) -> BadInput:
    return BadInput(f"time: {time} has no time zone; give tz=, or {remedy}")


def _check_zone(time: Any, zone: Optional[Zone]) -> None:
    """Raises BadInput for a datetime, or a text of a time of day, that has no zone where none is given."""
    if zone is not None:
        return
    if isinstance(time, datetime.datetime) and time.utcoffset() is None:
        remedy = 'set tzinfo, as in datetime(2026, 6, 21, 12, tzinfo=ZoneInfo("Europe/Zurich"))'
        raise _no_zone(time.isoformat(), remedy)
    if isinstance(time, str) and _WALL_TIME.fullmatch(time):
        raise _no_zone(time.strip(), "end it by Z for UTC or by an offset such as +02:00")


def _seconds_of_datetime(time: datetime.datetime, zone: Optional[Zone]) -> float:
    if time != time:
        raise BadInput("time: NaT is no time")
    _check_zone(time, zone)
    if time.utcoffset() is None and zone is not None:
        time = time.replace(tzinfo=_tzinfo_of(zone))
    return ((time - _EPOCH) // _MICROSECOND) * 1e-6


def _seconds_of_text(text: str, zone: Optional[Zone]) -> float:
    _check_zone(text, zone)
    try:
        time = datetime.datetime.fromisoformat(text[:-1] + "+00:00" if text.endswith(("Z", "z")) else text)
    except ValueError:
        raise BadInput(f"time: expected one as 2026-06-21T18:30+02:00 but got {text!r}") from None
    return _seconds_of_datetime(time, zone)


def _seconds_of(time: Any, zone: Optional[Zone]) -> float:
    if isinstance(time, str):
        return _seconds_of_text(time, zone)
    if isinstance(time, datetime.datetime):
        return _seconds_of_datetime(time, zone)
    if isinstance(time, numpy.datetime64):
        return float(_seconds_of_datetime64(numpy.asarray(time)))
    if isinstance(time, (bool, numpy.bool_)) or not isinstance(time, (int, float, numpy.number)):
        raise BadInput(f"time: expected a datetime, a text or seconds since 1970 but got {time!r}")
    if not numpy.isfinite(time):
        raise BadInput(f"time: expected seconds since 1970 but got {time!r}")
    return float(time)


def _seconds_of_datetime64(times: NDArray[Any]) -> NDArray[numpy.float64]:
    if numpy.isnat(times).any():
        raise BadInput("time: NaT is no time")
    whole = times.astype("datetime64[us]").astype(numpy.int64)
    seconds_since_1970: NDArray[numpy.float64] = whole * 1e-6
    return seconds_since_1970


def seconds(times: Times, zone: Optional[Zone] = None) -> NDArray[numpy.float64]:
    """Seconds since 1970-01-01T00:00Z, in the shape of `times`: one or many of

    - datetime.datetime and pandas.Timestamp
    - numpy.datetime64, which is UTC
    - texts as 2026-06-21T18:30+02:00, 2026-06-21T16:30Z
    - seconds since 1970

    zone: of datetimes and texts that have none. Raises BadInput where neither has one, and for what is no time.
    """
    if zone is not None:
        _tzinfo_of(zone)
    array = numpy.asarray(times)
    if array.dtype.kind == "M":
        return _seconds_of_datetime64(array)
    if array.dtype.kind in "iuf":
        if not numpy.isfinite(array).all():
            raise BadInput("time: expected seconds since 1970 but got NaN or infinity")
        return array.astype(numpy.float64)
    flat = (
        [_seconds_of(time, zone) for time in array.ravel().tolist()]
        if array.dtype.kind in "OU"
        else [_seconds_of(times, zone)]
    )
    return numpy.array(flat, dtype=numpy.float64).reshape(array.shape)


def utc(seconds_since_1970: float) -> datetime.datetime:
    """A datetime in UTC."""
    try:
        return _EPOCH + datetime.timedelta(microseconds=round(seconds_since_1970 * 1e6))
    except OverflowError:
        raise BadInput(f"time: expected seconds since 1970 but got {seconds_since_1970!r}") from None


def time_text(time: Time, zone: Optional[Zone] = None, name: str = "time") -> str:
    """A time as scenes have it. Texts are those of the program, also events such as "sunset-30min".

    zone: of a datetime or text that has none. Raises BadInput where neither has one.
    name: of the argument, for errors
    """
    try:
        return _time_text(time, zone)
    except BadInput as error:
        raise BadInput(re.sub("^time", name, str(error))) from None


def _time_text(time: Time, zone: Optional[Zone]) -> str:
    if zone is not None:
        zone_text(zone)
    if isinstance(time, str):
        _check_zone(time, zone)
        return time
    if isinstance(time, datetime.datetime) and time == time and time.utcoffset() is None:
        _check_zone(time, zone)
        return time.isoformat()
    return utc(_seconds_of(time, zone)).isoformat().replace("+00:00", "Z")


def date_text(date: Date) -> str:
    """A date as the library takes it: "2026-06-21"."""
    if isinstance(date, str):
        return date
    if isinstance(date, numpy.datetime64):
        if numpy.isnat(date):
            raise BadInput("date: NaT is no date")
        return str(date.astype("datetime64[D]"))
    if isinstance(date, datetime.date) and date != date:
        raise BadInput("date: NaT is no date")
    if isinstance(date, datetime.datetime):
        return date.date().isoformat()
    if isinstance(date, datetime.date):
        return date.isoformat()
    raise BadInput(f'date: expected a date or a text such as "2026-06-21" but got {date!r}')
