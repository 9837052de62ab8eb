"""librelevo, and how it is called: results become exceptions, arrays addresses; long work runs on a thread of its own.

It is loaded by ctypes, so that one build serves every Python. Progress is polled: a callback would have to wait for the
GIL, and slow the work down while another thread is busy. Only messages come by a callback.
"""

from __future__ import annotations

import _thread
import atexit
import ctypes
import os
import pathlib
import re
import time
from collections.abc import Callable
from ctypes import CFUNCTYPE, POINTER, addressof, byref, c_char, c_char_p, c_double, c_int32, c_size_t, c_void_p, pointer
from typing import Any, NamedTuple, Optional

import numpy

from ._errors import BadCall, BadInput, error_of, keep_message

Progress = Optional[Callable[[float], object]]
Address = Optional[int]


class Structure(ctypes.Structure):
    """A struct of the interface with its size."""

    def __init__(self, **values: Any) -> None:
        super().__init__(size=ctypes.sizeof(self), **values)


_MESSAGE = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)


class _Progress(Structure):
    _fields_ = [("size", c_size_t), ("user", c_void_p), ("done", c_void_p), ("cancel", POINTER(c_int32)), ("share", POINTER(c_double))]


PROGRESS = POINTER(_Progress)


def _remedy(why: str) -> str:
    """The package of Debian that has a library, by Debian's rule for the names of such packages."""
    missing = re.match(r"lib([^/]+?)\.so\.([\d.]+): cannot open", why)
    if not missing:
        return "build it by pip install . or, for PYTHONPATH=build/release/python, by cmake --build build/release"
    name = missing[1].lower().replace("_", "-")
    return f"apt install lib{name}{'-' if name[-1:].isdigit() else ''}{missing[2]}"


def _load() -> ctypes.CDLL:
    """The library in the package's folder `lib`, which in the build tree and in Debian's package is a link."""
    try:
        return ctypes.CDLL(str(pathlib.Path(__file__).with_name("lib") / "librelevo.so.0"))
    except OSError as error:
        raise ImportError(f"relevo: its library does not load ({error}); {_remedy(str(error))}") from None


_library = _load()


def function(name: str, *arguments: Any, result: Any = c_int32) -> Callable[..., Any]:
    """A function of the library. Calls of it release the GIL."""
    found = getattr(_library, name)
    found.argtypes, found.restype = arguments, result
    return found  # type: ignore[no-any-return]


_error = function("relevo_error", result=c_char_p)

_user = 0  # the process that has used the library; 0: none yet
_ending = False  # Python ends
_calls: list[None] = []  # an element for each short call under way
_works: set[_Work] = set()  # long ones under way, also those that nobody waits for any more


def is_fork() -> bool:
    """Whether this process was forked from the one that has the library's threads."""
    return _user not in (0, os.getpid())


def check(code: int) -> None:
    """Raises what the last call of this thread has failed by."""
    if code:
        raise error_of(code, _error().decode("utf-8", "replace"))


def _begin() -> None:
    global _user
    if _ending:
        raise BadCall("relevo: Python ends")
    if is_fork():
        raise BadCall(
            "relevo: this process was forked after relevo was used, and its threads are not here; start processes by "
            'multiprocessing\'s "spawn"'
        )
    _user = os.getpid()


def call(called: Callable[..., int], *arguments: Any) -> None:
    """A call that is over soon."""
    _calls.append(None)
    try:
        _begin()
        check(called(*arguments))
    finally:
        _calls.pop()


class _Work:
    """A call on a thread of its own."""

    def __init__(self, work: Callable[[Any], Any]) -> None:
        self.cancelled, self.share, self.result = c_int32(0), c_double(0), None
        self.error: Optional[BaseException] = None
        self.running = _thread.allocate_lock()  # released at the end; this module takes a third of threading's time
        self.running.acquire()
        self._does = work

    def start(self) -> None:
        _works.add(self)
        try:
            _begin()
            _thread.start_new_thread(self._run, ())
        except BaseException:
            _works.discard(self)
            raise

    def _run(self) -> None:
        try:
            self.result = self._does(byref(_Progress(cancel=pointer(self.cancelled), share=pointer(self.share))))
        except BaseException as error:
            self.error = error
        del self._does
        _works.discard(self)
        self.running.release()


def call_long(work: Callable[[Any], Any], progress: Progress = None) -> Any:
    """Does work on a thread of its own, while this one handles signals and calls `progress`.

    work: takes the address of a struct relevo_progress
    progress: a function of the share that is done; False from it cancels
    Raises what the work, `progress` and handlers of signals raise: the latter at once, while the work, which looks at
    its progress between steps of up to a second, ends in the background.
    """
    if progress is not None and not callable(progress):
        raise BadCall("progress: expected a function or None")
    one, shown = _Work(work), 0.0
    try:
        one.start()
        while not one.running.acquire(timeout=0.03):
            if progress is not None and one.share.value > shown:
                shown = one.share.value
                if progress(shown) is False:
                    one.cancelled.value = 1
    except BaseException:
        one.cancelled.value = 1
        raise
    if one.error is None:
        return one.result
    error, one.error = one.error, None  # whose frames have `one`
    try:
        raise error
    finally:
        del error


def _finish() -> None:
    """Cancels all work and waits for its end: threads that are in a call when Python has ended would end the process."""
    global _ending
    _ending = True
    while not is_fork() and (_calls or _works):
        for work in list(_works):
            work.cancelled.value = 1
        time.sleep(0.01)
    if not is_fork():
        _set_message(ctypes.cast(0, _MESSAGE), None)


class Array(NamedTuple):
    """Memory of a numpy array, which lives as long as this."""

    owner: Any
    address: int
    length: int


def array(given: Any, kind: str, write: bool = True) -> Array:
    """Raises BadCall unless elements are of the type `kind` of the module struct; BufferError for gaps between them, and
    for an array that is to be written and cannot be; TypeError for what is no array of numpy."""
    if not isinstance(given, numpy.ndarray):
        raise TypeError(f"array: expected one of numpy but got {type(given).__name__}")
    dtype, flags = given.dtype, given.flags
    if dtype.char != kind or not dtype.isnative:
        got = dtype.char if dtype.isnative else dtype.byteorder + dtype.char
        raise BadCall(f"array: expected elements of the type '{kind}' but got '{got}'")
    if not flags.c_contiguous or (write and not flags.writeable):
        raise BufferError("array: " + ("is read-only" if flags.c_contiguous else "has gaps between its elements"))
    # The faster way is for arrays that can be written.
    address = addressof(c_char.from_buffer(given.data)) if flags.writeable and given.size else given.ctypes.data
    return Array(given, address, given.size)


def text(given: Optional[str], name: str = "text") -> Optional[bytes]:
    if not isinstance(given, (str, type(None))):
        raise BadInput(f"{name}: expected a text but got {given!r}")
    return None if given is None else given.encode()


class Handle:
    """A handle of the library, closed with the object."""

    _address: Address = None

    def __init__(self, address: Address, close: Callable[[Address], None], what: str) -> None:
        self._address, self._close, self._what = address, close, what

    @property
    def address(self) -> Address:
        """Raises BadCall once it is closed."""
        if self._address is None:
            raise BadCall(f"{self._what}: closed")
        return self._address

    @property
    def closed(self) -> bool:
        return self._address is None

    def close(self) -> None:
        address, self._address = self._address, None
        if address is not None and not is_fork():
            self._close(address)

    def __del__(self) -> None:
        self.close()


_message = _MESSAGE(lambda user, level, said: keep_message(level, said.decode("utf-8", "replace")))
_set_message = function("relevo_set_message", _MESSAGE, c_void_p)
check(_set_message(_message, None))
atexit.register(_finish)
