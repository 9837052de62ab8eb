"""Errors and warnings of the library, and what it says on its way."""

from __future__ import annotations

import contextlib
import logging
import math
import sys
import warnings
from typing import Any

import numpy
from numpy.typing import NDArray

from ._words import python_words

log = logging.getLogger("relevo")

_DEBUG, _INFO = 0, 1  # levels of messages; above: a warning
_kept: list[tuple[int, str]] = []  # what the library has said since messages() took it


class Error(Exception):
    """An error of Relevo. Its text is the sentence that the program would print."""


class BadCall(Error, ValueError):
    """The call itself is wrong: an array of a wrong shape or type, a DEM or view that is closed."""


class BadInput(Error, ValueError):
    """A file, an option or a value is wrong."""


class NoDevice(Error):
    """There is no GL device that can draw."""


class Cancelled(Error):
    """`progress` returned False."""


class OutOfMemory(Error, MemoryError):
    """Memory does not suffice."""


class Warning(UserWarning):
    """The result may not be what the user expects."""


_CLASSES: dict[int, type[Error]] = {2: BadCall, 3: BadInput, 4: NoDevice, 5: Cancelled, 6: OutOfMemory}


def error_of(code: int, text: str) -> Error:
    """The exception for a code of the C interface."""
    return _CLASSES.get(code, Error)(python_words(text))


def keep_message(level: int, text: str) -> None:
    """Keeps what the library says, on any thread, for messages(): all warnings, and as much else as anybody reads."""
    if level > _INFO or len(_kept) < 1000:
        _kept.append((level, text))


def numbers(name: str, given: Any) -> NDArray[numpy.float64]:
    """Of an argument. Raises BadInput for others."""
    try:
        return numpy.asarray(given, dtype=numpy.float64)
    except (TypeError, ValueError):
        raise BadInput(f"{name}: expected numbers but got {given!r}") from None


def number(name: str, given: Any, low: float = -math.inf, high: float = math.inf) -> float:
    """Of an argument. Raises BadInput for others."""
    one = numbers(name, given)
    if one.ndim or not low <= one <= high:
        raise BadInput(f"{name}: expected a number{'' if low == -math.inf else f' from {low} to {high}'} but got {given!r}")
    return float(one)


def _level_of_caller() -> int:
    """`stacklevel` of the first frame outside of this package, for the function that calls."""
    level = 1
    frame = sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).split(".")[0] == "relevo":
        frame = frame.f_back
        level += 1
    return level


def warn(text: str) -> None:
    """Warns the caller of the package."""
    warnings.warn(text, Warning, stacklevel=_level_of_caller())


class messages:
    """Around calls of the library: what it says becomes warnings and log records, on this thread.

    assumptions: what is assumed becomes a warning, too
    """

    def __init__(self, assumptions: bool = False) -> None:
        self._least = _INFO if assumptions else _INFO + 1  # of levels that become warnings

    def __enter__(self) -> None:
        pass

    def __exit__(self, *error: object) -> None:
        taken = []
        with contextlib.suppress(IndexError):  # of another thread, which takes at the same time
            while _kept:
                taken.append(_kept.pop(0))
        for level, text in taken:
            text = python_words(text)
            if level >= self._least:
                warn(text)
            else:
                log.log(logging.INFO if level == _INFO else logging.DEBUG, "%s", text)
