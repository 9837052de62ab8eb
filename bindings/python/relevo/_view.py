"""Pictures."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import TracebackType
from typing import Any, NamedTuple, NoReturn, Optional, Union

import numpy
from numpy.typing import NDArray

from . import _relevo
from ._errors import BadInput, messages
from ._options import Json, json_text
from ._times import Date, Time, Zone, date_text, time_text, zone_text

Camera = Mapping[str, Any]
Change = Union[str, Mapping[str, Any]]


class Layers(NamedTuple):
    """What the pixels of a picture show; float32, the first row at the top, of the middle of each pixel."""

    depth: NDArray[numpy.float32]
    """(rows, columns): distance from the eye along the optical axis [m]; infinite without ground."""
    positions: NDArray[numpy.float32]
    """(rows, columns, 3): east, north and up of `origin` [m]; NaN without ground."""
    normals: NDArray[numpy.float32]
    """(rows, columns, 3): unit normal of the ground, east, north and up; 0 without ground."""
    origin: tuple[float, float, float]
    """Latitude, longitude [degrees] and height above the WGS 84 ellipsoid [m] of positions."""


def change_of(
    time: Optional[Time], size: Optional[tuple[int, int]], date: Optional[Date], zone: Optional[Zone],
    camera: Optional[Camera], exaggeration: Optional[float], scene: Optional[Change],
    zone_before: Optional[str] = None,
) -> dict[str, Any]:
    """A part of a scene from arguments.

    zone_before: that of the scene, which stays if none is given
    """
    change = _members(scene)
    if time is not None or date is not None or zone is not None:
        when = {
            "at": None if time is None else time_text(time, zone or _zone_of(change) or zone_before),
            "date": None if date is None else date_text(date),
            "zone": None if zone is None else zone_text(zone),
        }
        change["time"] = {**change.get("time", {}), **{key: text for key, text in when.items() if text is not None}}
    if size is not None:
        change["picture"] = {**change.get("picture", {}), "size": _size(size)}
    if camera is not None:
        change["camera"] = dict(camera)
    if exaggeration is not None:
        change["exaggeration"] = exaggeration
    return change


class View:
    """A scene of a DEM on a device. `Dem.view()` opens one.

    Any thread may use it; calls wait for each other. Several views draw at once. It is closed by `close()`, at the end
    of a `with`, or with the last reference to it.
    """

    def __init__(self, dem: _relevo.Dem, scene: Mapping[str, object], device: str, name: str) -> None:
        self._name = name
        self._zone = _zone_of(scene)
        with messages():
            self._session = _relevo.open_session(json_text("scene", scene), dem, device)

    def set(
        self, time: Optional[Time] = None, size: Optional[tuple[int, int]] = None, *, date: Optional[Date] = None,
        tz: Optional[Zone] = None, camera: Optional[Camera] = None, exaggeration: Optional[float] = None,
        scene: Optional[Change] = None,
    ) -> None:
        """Changes the scene; what is not given stays. Arguments are those of `Dem.view()`.

        A camera replaces the one before, effects of `scene` are added, other members take the place of the scene's.
        Raises BadInput; the scene is then as it was.
        """
        change = change_of(time, size, date, tz, camera, exaggeration, scene, self._zone)
        with messages():
            self._session.set(json_text("scene", change))
        self._zone = _zone_of(change) or self._zone

    @property
    def scene(self) -> dict[str, Json]:
        """The scene with what was chosen for it, as a scene file has it; the time in UTC."""
        scene: dict[str, Json] = json.loads(self._session.scene())
        return scene

    @property
    def size(self) -> tuple[int, int]:
        """(columns, rows) of the picture; of a map, a panorama or with a margin not what was asked for."""
        with messages():
            return self._session.picture_size()

    @property
    def closed(self) -> bool:
        return self._session.closed

    def draw(self) -> NDArray[numpy.uint8]:
        """Draws the picture: uint8, (rows, columns, 4), sRGB and alpha, the first row at the top.

        The same scene gives the same bytes on one device, whatever was drawn before: those of `relevo capture`.
        """
        columns, rows = self.size
        picture = numpy.empty((rows, columns, 4), dtype=numpy.uint8)
        with messages():
            self._session.draw(picture, None, None, None)
        return picture

    def layers(self) -> Layers:
        """Depth, positions and normals of the picture. Not of stereo pairs, panoramas and pictures with a margin
        (BadInput). The first call takes a second set of the device's buffers."""
        columns, rows = self.size
        depth = numpy.empty((rows, columns), dtype=numpy.float32)
        positions = numpy.empty((rows, columns, 3), dtype=numpy.float32)
        normals = numpy.empty((rows, columns, 3), dtype=numpy.float32)
        with messages():
            origin = self._session.draw(None, depth, positions, normals)
        return Layers(depth, positions, normals, origin)

    def depth(self) -> NDArray[numpy.float32]:
        """`layers().depth`."""
        return self.layers().depth

    def positions(self) -> NDArray[numpy.float32]:
        """`layers().positions`."""
        return self.layers().positions

    def normals(self) -> NDArray[numpy.float32]:
        """`layers().normals`."""
        return self.layers().normals

    def close(self) -> None:
        """Gives back the device's memory. Later calls raise BadCall."""
        self._session.close()

    def __enter__(self) -> View:
        return self

    def __exit__(
        self, kind: Optional[type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<relevo.View of {self._name!r}{', closed' if self.closed else ''}>"

    def __reduce__(self) -> NoReturn:
        raise TypeError("a relevo.View cannot be pickled; open one in each process")


def _members(scene: Optional[Change]) -> dict[str, Any]:
    """Members of a scene, of which those that arguments change are objects."""
    if scene is None:
        return {}
    if isinstance(scene, str):
        try:
            scene = json.loads(scene)
        except ValueError as error:
            raise BadInput(f"scene: {error}") from None
    if not isinstance(scene, Mapping):
        raise BadInput(f"scene: expected a dict or a JSON object but got {type(scene).__name__}")
    members = dict(scene)
    for name in ("time", "picture"):
        if not isinstance(members.get(name, {}), Mapping):
            raise BadInput(f"scene: {name}: expected an object")
    return members


def _zone_of(scene: Mapping[str, Any]) -> Optional[str]:
    zone = scene.get("time", {}).get("zone")
    return None if zone is None else zone_text(zone)


def _size(size: tuple[int, int]) -> list[int]:
    try:
        columns, rows = size
        return [int(columns), int(rows)]
    except (TypeError, ValueError):
        raise BadInput(f"size: expected (columns, rows) but got {size!r}") from None
