"""Rasters of chunked arrays of heights, as graphs of dask."""

from __future__ import annotations

import math
import threading
from typing import Any, Optional

import numpy
from numpy.typing import NDArray

from ._answers import library_answer
from ._dem import Dem, open
from ._errors import BadInput
from ._inputs import declared_void
from ._raster import bounds_of
from ._sun_over_dem import shadow_options
from ._transform import Transform


_OFTEN_VOID = -9999


class _Ground:
    """Heights that several tasks of a process take; the DEM is opened by the first one.

    part: where `array` is a part of another one: its transform, the window of it that is asked for, and heights and
        transform of a wider and coarser grid around it or None
    """

    def __init__(self, array: Any, part: Any = None) -> None:
        self._given = array, part
        self._lock = threading.Lock()
        self._opened: list[Dem] = []

    def __reduce__(self) -> Any:
        return _Ground, self._given

    def dem(self) -> Dem:
        array, part = self._given
        with self._lock:
            if not self._opened and part is None:
                self._opened = [open(array)]
            elif not self._opened:
                dem = _open(array, part[0])
                self._opened = [dem]
                if part[2] is not None:
                    heights, transform = part[2]
                    self._opened.append(open(heights, transform=transform, crs=dem.wkt, unit="m", nodata="none"))
                    dem._handle.set_around(self._opened[1]._handle)
            return self._opened[0]

    def values(self, figure: str, options: dict[str, Any], shape: tuple[int, ...]) -> NDArray[numpy.float32]:
        """Of a task. shape: of them"""
        array, part = self._given
        if part is None:
            return getattr(self.dem().sun, figure)(**options).values  # type: ignore[no-any-return]
        if not _known(array).any():
            return numpy.full(shape, numpy.nan, numpy.float32)
        rows, columns = part[1]
        window = bounds_of(_moved(part[0], columns.start, rows.start), shape[-2], shape[-1])
        made = getattr(self.dem().sun, figure)(**{**options, "clip": window})
        return made.values[..., rows, columns]  # type: ignore[no-any-return]


def _open(array: Any, transform: Any) -> Dem:
    """A part of an array. Of a part nobody knows which heights are far from all others, so that no voids are guessed."""
    return open(array, transform=transform, nodata=None if declared_void(array) is not None else "none")


def _known(array: Any) -> NDArray[numpy.bool_]:
    """Where there are heights."""
    void = declared_void(array)
    known: NDArray[numpy.bool_] = numpy.isfinite(array.values) & (True if void is None else array.values != void)
    return known


def values(
    array: Any, level: Dem, figure: str, options: dict[str, Any], halo: Optional[float], shape: tuple[int, ...]
) -> tuple[Any, dict[str, str]]:
    """A lazy array of a figure of `Dem.sun` with the chunks of `array`, and what is to be said of it.

    level: of the grid of `array`, from its first corner
    """
    import dask
    import dask.array

    each = [options]
    if options.get("times") is not None:  # a task for each time
        times = shadow_options(options)["times"]
        each = [{**options, "times": [time]} for time in times]
    bands = () if len(shape) == 2 else (shape[0] // len(each),)

    def made(ground: Any, rows: int, columns: int) -> Any:
        part = (*bands, rows, columns)
        parts = [dask.array.from_delayed(ground.values(figure, one, part), part, numpy.float32) for one in each]
        return parts[0] if len(parts) == 1 else dask.array.concatenate(parts)

    if halo is None:
        whole = made(dask.delayed(_Ground, pure=False)(array), *array.shape)
        return whole.rechunk({-2: array.chunks[0], -1: array.chunks[1]}), {}
    if options["clip"] is not None or options["progress"] is not None:
        raise BadInput("halo: of all chunks, without clip= and progress=; take a part of the result instead")
    sites = _Sites(array, level, halo)
    rows, columns = (list(zip(sites.ends[i], sites.ends[i][1:])) for i in (0, 1))
    blocks = [[made(*sites.site(row, column)) for column in columns] for row in rows]
    means = sites.need["means"]
    said = f"ground beyond {halo:g} km of a chunk is means of {means} x {means} posts"
    return dask.array.block(blocks), {"far_ground": said}


class _Sites:
    """Parts of an array with halos around them, in the means of the whole: what tiles of the program have."""

    def __init__(self, array: Any, level: Dem, halo: float) -> None:
        import dask.graph_manipulation

        self._array, self._transform = array, level.transform
        rows, columns = array.shape
        middle = _moved(level.transform, columns // 2 - 1, rows // 2 - 1)
        with open(numpy.zeros((2, 2)), transform=middle, crs=level.wkt, unit="m") as dem:
            self.need = library_answer(dem, "halo", {"halo": halo})
        self.ends = [numpy.cumsum([0, *chunks]).tolist() for chunks in array.chunks]
        self._around = self._means()
        # Read again after the means, so that memory does not keep all chunks till then.
        self._array = dask.graph_manipulation.bind(array, self._around[0])

    def _means(self) -> Any:
        """Of the whole, and their transform."""
        import dask

        rows, columns = self._array.shape
        height, width = (max(2, side // self.need["means"]) for side in (rows, columns))
        sums = [
            dask.delayed(_sums)(*self._part(*row, *column), row, column, (rows / height, columns / width))
            for row in zip(self.ends[0], self.ends[0][1:])
            for column in zip(self.ends[1], self.ends[1][1:])
        ]
        a, b, c, d, e, f = self._transform
        x, y = columns / width, rows / height
        return dask.delayed(_mean)(sums, (height, width)), Transform(a * x, b * y, c, d * x, e * y, f)

    def _part(self, top: int, bottom: int, left: int, right: int) -> tuple[Any, Any, Any]:
        """Of the array, 2 x 2 posts at least, its transform and its first row and column."""
        rows, columns = self._array.shape
        top, left = min(top, rows - 2), min(left, columns - 2)
        part = self._array[top : max(bottom, top + 2), left : max(right, left + 2)]
        return part, _moved(self._transform, left, top), (top, left)

    def site(self, rows: tuple[int, int], columns: tuple[int, int]) -> tuple[Any, int, int]:
        """Ground of a chunk, and the chunk's size."""
        import dask

        high, wide = self.need["rows"], self.need["columns"]
        part, transform, (top, left) = self._part(
            max(0, rows[0] - high), min(self._array.shape[0], rows[1] + high),
            max(0, columns[0] - wide), min(self._array.shape[1], columns[1] + wide),
        )
        # What is the whole has nothing around it.
        around = None if part.shape == self._array.shape else self._around
        window = slice(rows[0] - top, rows[1] - top), slice(columns[0] - left, columns[1] - left)
        ground = dask.delayed(_Ground, pure=False)(part, (transform, window, around))
        return ground, rows[1] - rows[0], columns[1] - columns[0]


def _moved(transform: Transform, column: int, row: int) -> Transform:
    x, y = transform.apply(float(column), float(row))
    return transform._replace(c=x, f=y)


def _weights(start: int, end: int, side: float) -> tuple[int, NDArray[numpy.float64]]:
    """Shares of posts in cells of means, (cells, posts), and the first of these cells. side: posts of a cell"""
    first = int(start / side)
    low = side * numpy.arange(first, math.ceil(end / side))[:, numpy.newaxis]
    post = numpy.arange(start, end)
    return first, numpy.maximum(0, numpy.minimum(low + side, post + 1) - numpy.maximum(low, post))


def _sums(array: Any, transform: Any, first: Any, rows: Any, columns: Any, cell: Any) -> Any:
    """Sums and counts of a chunk's heights [m] in the cells of means, and where those are."""
    heights = numpy.full(array.shape, numpy.nan)
    if _known(array).any():
        with _open(array, transform) as dem:
            heights = numpy.asarray(dem, numpy.float64)
    top, left = first
    heights = heights[rows[0] - top : rows[1] - top, columns[0] - left : columns[1] - left]
    known = numpy.isfinite(heights)
    (row, down), (column, right) = (_weights(ends[0], ends[1], side) for ends, side in zip((rows, columns), cell))
    sums = (down @ one @ right.T for one in (numpy.where(known, heights, 0.0), known * 1.0))
    is_mark = heights == _OFTEN_VOID
    near = known & ~is_mark & (abs(heights - _OFTEN_VOID) < 500)
    return (row, column), *sums, is_mark.any(), near.any()


def _mean(sums: Any, shape: tuple[int, int]) -> NDArray[numpy.float32]:
    total, count = numpy.zeros(shape), numpy.zeros(shape)
    if any(one[3] for one in sums) and not any(one[4] for one in sums):
        raise BadInput(f"halo: {_OFTEN_VOID} seems to mark voids; make them NaN by heights.where(heights != {_OFTEN_VOID})")
    for (row, column), some, known, *_ in sums:
        cells = slice(row, row + some.shape[0]), slice(column, column + some.shape[1])
        total[cells] += some
        count[cells] += known
    with numpy.errstate(invalid="ignore"):
        return (total / count).astype(numpy.float32)
