"""The C interface of include/relevo/relevo.h, function by function. Use the package relevo instead."""

from __future__ import annotations

import os
from ctypes import POINTER, byref, c_char_p, c_double, c_float, c_int32, c_size_t, c_uint8, c_void_p
from typing import Any, Optional

from ._errors import BadCall
from ._library import PROGRESS, Address, Array, Handle, Progress, Structure
from ._library import array, call, call_long, check, function, text

_HANDLE, _TEXT, _DATA = c_void_p, c_char_p, c_void_p
_SIX = c_double * 6


class _Raster(Structure):
    _fields_ = [
        ("size", c_size_t), ("heights_m", _DATA), ("count", c_size_t), ("columns", c_int32), ("rows", c_int32),
        ("transform", _SIX), ("crs", _TEXT), ("options", _TEXT),
    ]


class _Grid(Structure):
    _fields_ = [
        ("size", c_size_t), ("columns", c_int32), ("rows", c_int32), ("transform", _SIX), ("centre_lat_deg", c_double),
        ("centre_lon_deg", c_double), ("column_spacing_m", c_double), ("row_spacing_m", c_double),
    ]


class _Place(Structure):
    _fields_ = [("size", c_size_t), ("lat_deg", c_double), ("lon_deg", c_double), ("height_m", c_double)]


class _Event(Structure):
    _fields_ = [
        ("size", c_size_t), ("kind", _TEXT), ("time_s", c_double), ("azimuth_deg", c_double),
        ("elevation_deg", c_double),
    ]


class _OpenOptions(Structure):
    _fields_ = [("size", c_size_t), ("device", _TEXT), ("folder", _TEXT), ("dem", _HANDLE)]


class _Picture(Structure):
    _fields_ = [
        ("size", c_size_t), ("rgba", _DATA), ("rgba_count", c_size_t), ("depth_m", _DATA), ("depth_count", c_size_t),
        ("position_m", _DATA), ("position_count", c_size_t), ("normal", _DATA), ("normal_count", c_size_t),
        ("origin_lat_deg", c_double), ("origin_lon_deg", c_double), ("origin_height_m", c_double),
    ]


_RECEIVED = POINTER(c_void_p)
_SAID = POINTER(c_char_p)
_dem_open = function("relevo_dem_open", POINTER(c_char_p), c_size_t, _TEXT, _RECEIVED)
_dem_from_heights = function("relevo_dem_from_heights", POINTER(_Raster), _RECEIVED)
_dem_close = function("relevo_dem_close", _HANDLE, result=None)
_dem_around = function("relevo_dem_around", _HANDLE, _HANDLE)
_dem_grid = function("relevo_dem_grid", _HANDLE, POINTER(_Grid))
_dem_crs = function("relevo_dem_crs", _HANDLE, _SAID)
_dem_wkt = function("relevo_dem_wkt", _HANDLE, _SAID)
_dem_read = function("relevo_dem_read", _HANDLE, _DATA, c_size_t)
_dem_heights = function("relevo_dem_heights", _HANDLE, _DATA, _DATA, c_size_t, _DATA)
_sun_position = function("relevo_sun_position", POINTER(_Place), _DATA, c_size_t, _TEXT, _DATA, _DATA, _DATA)
_sun_events = function("relevo_sun_events", POINTER(_Place), _TEXT, _TEXT, POINTER(_Event), c_size_t, POINTER(c_size_t))
_answer = function("relevo_answer", _HANDLE, _TEXT, _TEXT, _SAID)
_horizon = function("relevo_horizon", _HANDLE, POINTER(_Place), _TEXT, _DATA, c_size_t, _DATA, _DATA)
_shadow, _sun_hours, _sky_view, _horizons = (
    function(f"relevo_{name}", _HANDLE, _TEXT, _DATA, c_size_t, PROGRESS, _SAID)
    for name in ("shadow", "sun_hours", "sky_view", "horizons")
)
_tiles = function("relevo_tiles", _HANDLE, _TEXT, _TEXT, _TEXT, PROGRESS, _SAID)
_open = function("relevo_open", _TEXT, POINTER(_OpenOptions), _RECEIVED)
_close = function("relevo_close", _HANDLE, result=None)
_set = function("relevo_set", _HANDLE, _TEXT)
_scene = function("relevo_scene", _HANDLE, _SAID)
_picture_size = function("relevo_picture_size", _HANDLE, POINTER(c_int32), POINTER(c_int32))
_draw_picture = function("relevo_draw_picture", _HANDLE, POINTER(_Picture))
_version = function("relevo_version", result=c_char_p)


def version() -> str:
    said: bytes = _version()
    return said.decode()


def _text_from(called: Any, handle: Address) -> str:
    said = c_char_p()
    call(called, handle, byref(said))
    assert said.value is not None
    return said.value.decode()


def _check_length(one: Array, count: int) -> None:
    if one.length != count:
        raise BadCall("arrays: expected one length")


class Dem(Handle):
    """struct relevo_dem."""

    def __init__(self, address: Address) -> None:
        super().__init__(address, _dem_close, "dem")

    def set_around(self, wider: Dem) -> None:
        """Ground of a wider and coarser DEM shades rasters, too."""
        call(_dem_around, self.address, wider.address)

    def grid(
        self,
    ) -> tuple[tuple[int, int], tuple[float, ...], tuple[float, float], tuple[float, float]]:
        """(columns, rows), geotransform, (latitude, longitude) of the centre, (column, row) spacing [m]."""
        grid = _Grid()
        call(_dem_grid, self.address, byref(grid))
        return (
            (grid.columns, grid.rows), tuple(grid.transform), (grid.centre_lat_deg, grid.centre_lon_deg),
            (grid.column_spacing_m, grid.row_spacing_m),
        )

    def crs(self) -> str:
        return _text_from(_dem_crs, self.address)

    def wkt(self) -> str:
        return _text_from(_dem_wkt, self.address)

    def read(self, heights_m: Any) -> None:
        to, handle = array(heights_m, "f"), self.address
        call_long(lambda _: check(_dem_read(handle, to.address, to.length)))

    def height(self, lat_deg: Any, lon_deg: Any, height_m: Any) -> None:
        lat, lon, to = array(lat_deg, "d", False), array(lon_deg, "d", False), array(height_m, "d")
        _check_length(lat, to.length)
        _check_length(lon, to.length)
        call(_dem_heights, self.address, lat.address, lon.address, to.length, to.address)

    def shadow(self, options: str, lit: Any, progress: Progress) -> str:
        return self._raster(_shadow, options, lit, progress)

    def sun_hours(self, options: str, values: Any, progress: Progress) -> str:
        return self._raster(_sun_hours, options, values, progress)

    def sky_view(self, options: str, share: Any, progress: Progress) -> str:
        return self._raster(_sky_view, options, share, progress)

    def horizons(self, options: str, elevation_deg: Any, progress: Progress) -> str:
        return self._raster(_horizons, options, elevation_deg, progress)

    def tiles(self, figure: str, options: str, files: Optional[str], progress: Progress) -> str:
        """Tiles, or without `files` what a raster takes. Returns JSON."""
        handle = self.address

        def work(done: Any) -> str:
            said = c_char_p()
            check(_tiles(handle, figure.encode(), options.encode(), text(files), done, byref(said)))
            assert said.value is not None
            return said.value.decode()

        made: str = call_long(work, progress)
        return made

    def _raster(self, figure: Any, options: str, values: Any, progress: Progress) -> str:
        """A raster of light. Returns its `about`."""
        to, handle = array(values, "f"), self.address

        def work(done: Any) -> str:
            about = c_char_p()
            check(figure(handle, options.encode(), to.address, to.length, done, byref(about)))
            assert about.value is not None
            return about.value.decode()

        made: str = call_long(work, progress)
        return made

    def horizon(
        self, lat_deg: float, lon_deg: float, options: str, azimuth_deg: Any, elevation_deg: Any, distance_m: Any
    ) -> None:
        azimuth, elevation, distance = array(azimuth_deg, "d", False), array(elevation_deg, "d"), array(distance_m, "d")
        _check_length(elevation, azimuth.length)
        _check_length(distance, azimuth.length)
        place, handle = _Place(lat_deg=lat_deg, lon_deg=lon_deg), self.address
        call_long(
            lambda _: check(
                _horizon(
                    handle, byref(place), options.encode(), azimuth.address, azimuth.length, elevation.address,
                    distance.address,
                )
            )
        )


class Session(Handle):
    """struct relevo_session."""

    def __init__(self, address: Address) -> None:
        super().__init__(address, _close, "view")

    def set(self, change: str) -> None:
        handle = self.address
        call_long(lambda _: check(_set(handle, change.encode())))

    def scene(self) -> str:
        return _text_from(_scene, self.address)

    def picture_size(self) -> tuple[int, int]:
        columns, rows = c_int32(), c_int32()
        call(_picture_size, self.address, byref(columns), byref(rows))
        return columns.value, rows.value

    def draw(self, rgba: Any, depth_m: Any, position_m: Any, normal: Any) -> tuple[float, float, float]:
        """Fills those arrays that are not None. Returns the origin of positions."""
        picture, handle = _Picture(), self.address
        held = []
        for name, given, kind in (
            ("rgba", rgba, "B"), ("depth_m", depth_m, "f"), ("position_m", position_m, "f"), ("normal", normal, "f"),
        ):
            if given is not None:
                held.append(array(given, kind))
                setattr(picture, name, held[-1].address)
                setattr(picture, name.removesuffix("_m") + "_count", held[-1].length)

        def work(_: Any) -> list[Array]:
            check(_draw_picture(handle, byref(picture)))
            return held

        call_long(work)
        return picture.origin_lat_deg, picture.origin_lon_deg, picture.origin_height_m


def open_dem(files: list[str], options: str) -> Dem:
    names = (c_char_p * len(files))(*(os.fsencode(file) for file in files))
    opened: Dem = _opened(Dem, _dem_open, names, len(files), options.encode())
    return opened


def _opened(kind: Any, called: Any, *arguments: Any) -> Any:
    def work(_: Any) -> Any:
        handle = c_void_p()
        check(called(*arguments, byref(handle)))
        return kind(handle.value)

    return call_long(work)


def dem_from_heights(heights_m: Any, transform: tuple[float, ...], crs: str, options: str) -> Dem:
    heights = array(heights_m, "f", False)
    rows, columns = heights_m.shape
    raster = _Raster(
        heights_m=heights.address, count=heights.length, columns=columns, rows=rows,
        transform=_SIX(*transform), crs=crs.encode(), options=options.encode(),
    )
    raster.held = heights  # also if nobody waits for the call any more
    opened: Dem = _opened(Dem, _dem_from_heights, byref(raster))
    return opened


def open_session(scene: Optional[str], dem: Dem, device: Optional[str]) -> Session:
    options = _OpenOptions(device=text(device, "device"), dem=dem.address)
    opened: Session = _opened(Session, _open, text(scene), byref(options))
    return opened


def answer(dem: Optional[Dem], figure: str, options: str) -> str:
    """JSON of a figure of a place."""
    handle = None if dem is None else dem.address

    def work(_: Any) -> str:
        said = c_char_p()
        check(_answer(handle, figure.encode(), options.encode(), byref(said)))
        assert said.value is not None
        return said.value.decode()

    made: str = call_long(work)
    return made


def sun_position(places: Any, times_s: Any, refraction: Optional[str], results: Any) -> None:
    """Azimuths, elevations and apparent elevations [degrees] into rows of `results`.

    places: latitude, longitude and height for all times, or for each time
    """
    place, times, to = array(places, "d", False), array(times_s, "d", False), array(results, "d")
    _check_length(to, 3 * times.length)
    one = place.length == 3
    if not one:
        _check_length(place, 3 * times.length)
    step, row, model, at = times.length if one else 1, 8 * times.length, text(refraction, "refraction"), _Place()

    def each() -> int:
        many = places.reshape(-1, 3).tolist()
        for i, (at.lat_deg, at.lon_deg, at.height_m) in zip(range(0, row, 8 * max(1, step)), many):
            azimuth = to.address + i
            code: int = _sun_position(
                byref(at), times.address + i, step, model, azimuth, azimuth + row, azimuth + 2 * row
            )
            if code:
                return code
        return 0

    call(each)


def sun_events(
    lat_deg: float, lon_deg: float, height_m: float, date: str, zone: Optional[str]
) -> list[tuple[str, float, float, float]]:
    """(kind, seconds since 1970, azimuth, elevation) of each event."""
    events, count = (_Event * 64)(_Event()), c_size_t()
    place = _Place(lat_deg=lat_deg, lon_deg=lon_deg, height_m=height_m)
    call(_sun_events, byref(place), date.encode(), text(zone), events, 64, byref(count))
    return [(one.kind.decode(), one.time_s, one.azimuth_deg, one.elevation_deg) for one in events[: count.value]]
