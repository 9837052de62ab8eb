"""Options and scenes as JSON texts."""

from __future__ import annotations

import datetime
import json
from collections.abc import Callable, Mapping
from typing import Any, Union

import numpy

from ._errors import BadInput
from ._times import date_text, zone_text


Json = Union[None, bool, float, str, list["Json"], dict[str, "Json"]]


def _plain(value: Any) -> Any:
    """What json does not know of numpy, and time zones."""
    if isinstance(value, datetime.tzinfo):
        return zone_text(value)
    if isinstance(value, numpy.generic):
        return value.item()
    if isinstance(value, numpy.ndarray):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is nothing that JSON has")


def json_text(who: str, value: Any) -> str:
    """JSON of a value. Raises BadInput for what JSON cannot have."""
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise BadInput(f"{who}: {error}") from None


def options_text(options: Mapping[str, Any]) -> str:
    """JSON of those options that are not None. Errors name the option."""
    return "{" + ", ".join(f'"{key}": {json_text(key, one)}' for key, one in options.items() if one is not None) + "}"


_OTHER = ("self", "progress")
_NAMES = {"start": "from", "end": "to", "tz": "zone"}
_TEXTS: dict[str, Callable[[Any], str]] = {"date": date_text, "from": date_text, "to": date_text, "zone": zone_text}


def library_options(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Options of the library by arguments of a method: with the library's names, dates and zones as texts."""
    options = {_NAMES.get(key, key): value for key, value in arguments.items() if key not in _OTHER and value is not None}
    if isinstance(options.get("step"), datetime.timedelta):
        options["step"] = options["step"].total_seconds()
    return {key: _TEXTS[key](value) if key in _TEXTS else value for key, value in options.items()}
