"""Options and scenes as JSON texts."""

from __future__ import annotations

import datetime
import json
from collections.abc import Mapping
from typing import Any

import numpy

from ._errors import BadInput
from ._times import zone_text


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


def options_text(who: str, options: Mapping[str, Any]) -> str:
    """JSON of those options that are not None."""
    return json_text(who, {key: value for key, value in options.items() if value is not None})
