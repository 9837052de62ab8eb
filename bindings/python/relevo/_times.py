"""Times and dates of Python as the library takes them."""

from __future__ import annotations

import datetime
from typing import Any, Union

import numpy
from numpy.typing import NDArray

from ._errors import BadInput

Time = Union[str, datetime.datetime, numpy.datetime64, float]
Date = Union[str, datetime.date, numpy.datetime64]

_EPOCH = datetime.datetime(1970, 1, 1, tzinfo=datetime.timezone.utc)
_MICROSECOND = datetime.timedelta(microseconds=1)


def _seconds_of_datetime(time: datetime.datetime) -> float:
    if time.utcoffset() is None:
        raise BadInput(
            f"time: {time.isoformat()} has no time zone; give it one, as in "
            'datetime(2026, 6, 21, 12, tzinfo=ZoneInfo("Europe/Zurich"))'
        )
    return ((time - _EPOCH) // _MICROSECOND) * 1e-6


def _seconds_of_text(text: str) -> float:
    try:
        time = datetime.datetime.fromisoformat(text[:-1] + "+00:00" if text.endswith(("Z", "z")) else text)
    except ValueError:
        raise BadInput(f"time: expected one as 2026-06-21T18:30+02:00 but got {text!r}") from None
    if time.utcoffset() is None:
        raise BadInput(f"time: {text} has no time zone; end it by Z for UTC, or by an offset such as +02:00")
    return _seconds_of_datetime(time)


def _seconds_of(time: Any) -> float:
    if isinstance(time, str):
        return _seconds_of_text(time)
    if isinstance(time, datetime.datetime):
        return _seconds_of_datetime(time)
    if isinstance(time, numpy.datetime64):
        return float(_seconds_of_datetime64(numpy.asarray(time)))
    if isinstance(time, (bool, numpy.bool_)) or not isinstance(time, (int, float, numpy.number)):
        raise BadInput(f"time: expected a datetime, a text or seconds since 1970 but got {time!r}")
    return float(time)


def _seconds_of_datetime64(times: NDArray[Any]) -> NDArray[numpy.float64]:
    if numpy.isnat(times).any():
        raise BadInput("time: NaT is no time")
    whole = times.astype("datetime64[us]").astype(numpy.int64)
    seconds_since_1970: NDArray[numpy.float64] = whole * 1e-6
    return seconds_since_1970


def seconds(times: Any) -> NDArray[numpy.float64]:
    """Seconds since 1970-01-01T00:00Z, in the shape of `times`: one or many of

    - datetime.datetime and pandas.Timestamp with a time zone
    - numpy.datetime64, which is UTC
    - texts as 2026-06-21T18:30+02:00, 2026-06-21T16:30Z
    - seconds since 1970

    Raises BadInput for times without a zone and for what is no time.
    """
    array = numpy.asarray(times)
    if array.dtype.kind == "M":
        return _seconds_of_datetime64(array)
    if array.dtype.kind in "iuf":
        return array.astype(numpy.float64)
    flat = [_seconds_of(time) for time in array.ravel().tolist()] if array.dtype.kind in "OU" else [_seconds_of(times)]
    return numpy.array(flat, dtype=numpy.float64).reshape(array.shape)


def utc(seconds_since_1970: float) -> datetime.datetime:
    """A datetime in UTC."""
    return _EPOCH + datetime.timedelta(microseconds=round(seconds_since_1970 * 1e6))


def time_text(time: Time) -> str:
    """A time as scenes have it. Texts are those of the program: also local times, and events such as
    "sunset-30min"."""
    return time if isinstance(time, str) else utc(_seconds_of(time)).isoformat().replace("+00:00", "Z")


def date_text(date: Date) -> str:
    """A date as the library takes it: "2026-06-21"."""
    if isinstance(date, str):
        return date
    if isinstance(date, numpy.datetime64):
        if numpy.isnat(date):
            raise BadInput("date: NaT is no date")
        return str(date.astype("datetime64[D]"))
    if isinstance(date, datetime.datetime):
        return date.date().isoformat()
    if isinstance(date, datetime.date):
        return date.isoformat()
    raise BadInput(f'date: expected a date or a text such as "2026-06-21" but got {date!r}')
