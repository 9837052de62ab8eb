"""Where the cells of a raster lie in its CRS."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeVar

import numpy
from numpy.typing import NDArray

from ._errors import BadInput

Number = TypeVar("Number", float, NDArray[numpy.float64])


class Transform(NamedTuple):
    """From corners of cells to coordinates of the CRS, in the order of `affine.Affine` and rasterio:

        x = a column + b row + c
        y = d column + e row + f

    Corners count from the outer corner of the first cell. `affine.Affine(*transform)` makes an Affine of it.
    """

    a: float
    b: float
    c: float
    d: float
    e: float
    f: float

    @classmethod
    def from_gdal(cls, c: float, a: float, b: float, f: float, d: float, e: float) -> Transform:
        """From the order of GDAL's geotransform: `Transform.from_gdal(*dataset.GetGeoTransform())`."""
        return cls(a, b, c, d, e, f)

    def to_gdal(self) -> tuple[float, float, float, float, float, float]:
        """In the order of GDAL's geotransform."""
        return (self.c, self.a, self.b, self.f, self.d, self.e)

    def apply(self, column: Number, row: Number) -> tuple[Number, Number]:
        """(x, y) of columns and rows, numbers or arrays. The centre of the first cell is at (0.5, 0.5)."""
        return self.a * column + self.b * row + self.c, self.d * column + self.e * row + self.f


def read_transform(given: Any) -> Transform:
    """A Transform of an `affine.Affine`, or of six numbers in its order.

    Raises BadInput for other things, and for six numbers that are a geotransform of GDAL.
    """
    try:
        numbers = [float(value) for value in given]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) == 9 and numbers[6:] == [0, 0, 1]:
        numbers = numbers[:6]
    if len(numbers) != 6:
        raise BadInput("transform: expected an affine.Affine or the six numbers a, b, c, d, e, f of one")
    if numbers[2] == 0 and numbers[4] == 0 and numbers[1] > 0 and numbers[5] < 0:
        raise BadInput("transform: looks as GDAL orders its numbers; relevo.Transform.from_gdal() takes those")
    return Transform(*numbers)
