"""Parts of a DEM that figures are made for: a rectangle, or shapes with `__geo_interface__`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Protocol, Union

import numpy
from numpy.typing import NDArray

from ._errors import BadInput
from ._inputs import crs_text

if TYPE_CHECKING:
    from ._dem import Dem


class Shape(Protocol):
    """A geometry or features, as shapely, geopandas and fiona have them."""

    @property
    def __geo_interface__(self) -> Mapping[str, Any]: ...


Clip = Union[Sequence[float], Shape]


class Part(NamedTuple):
    """Of a DEM."""

    asked: dict[str, Any]
    """Options of the library: a rectangle."""
    said: dict[str, Any]
    """By which it is made again."""
    outside: Optional[NDArray[numpy.bool_]]
    """(rows, columns): posts of the rectangle or around it that are not in the shapes. None: the rectangle is all."""


def part_of(dem: Dem, clip: Union[Clip, str, None], clip_crs: Any) -> Part:
    """Of arguments `clip` and `clip_crs`. Raises BadInput for what is neither a rectangle nor a shape with an area."""
    if clip is None or isinstance(clip, str) or not (hasattr(clip, "__geo_interface__") or isinstance(clip, Mapping)):
        text = clip if clip is None or isinstance(clip, str) else _rectangle(clip)
        asked = {"clip": text, "clip_crs": None if clip_crs is None else crs_text(clip_crs)}
        return Part(asked, asked, None)
    shapes = _shapes(clip if isinstance(clip, Mapping) else clip.__geo_interface__)
    of_shapes = clip_crs if clip_crs is not None else getattr(clip, "crs", None)
    crs = None if of_shapes is None else crs_text(of_shapes)
    said = {"clip": {"type": "GeometryCollection", "geometries": shapes}, "clip_crs": crs}
    try:
        import rasterio.features
        import rasterio.warp
    except ImportError:
        raise ImportError("relevo: clip= of shapes needs rasterio; pip install rasterio") from None
    try:
        if crs is not None:
            shapes = [rasterio.warp.transform_geom(crs, dem.wkt, shape) for shape in shapes]
        edges = numpy.array([rasterio.features.bounds(shape) for shape in shapes])
        outside = rasterio.features.geometry_mask(shapes, dem.shape, rasterio.Affine(*dem.transform))
    except (rasterio.errors.RasterioError, ValueError, TypeError, KeyError, IndexError) as error:
        raise BadInput(f"clip: {error}") from None
    if outside.all():
        raise BadInput("clip: no post of the DEM is in it; clip_crs= has the CRS of its coordinates")
    rectangle = [*edges[:, :2].min(axis=0).tolist(), *edges[:, 2:].max(axis=0).tolist()]
    return Part({"clip": _rectangle(rectangle)}, said, outside)


def _rectangle(clip: Any) -> str:
    try:
        west, south, east, north = (float(edge) for edge in clip)
    except (TypeError, ValueError):
        raise BadInput(
            f"clip: expected (west, south, east, north) or a shape with __geo_interface__ but got {clip!r}"
        ) from None
    return f"{west!r},{south!r},{east!r},{north!r}"


def _shapes(found: Any) -> list[Any]:
    """Polygons of GeoJSON, also of features."""
    kind = found.get("type") if isinstance(found, Mapping) else None
    if kind in ("Polygon", "MultiPolygon"):
        return [{"type": kind, "coordinates": found.get("coordinates")}]
    members = {"Feature": "geometry", "FeatureCollection": "features", "GeometryCollection": "geometries"}
    if kind not in members:
        raise BadInput(f"clip: expected polygons but got {kind}")
    inner = found.get(members[kind])
    shapes = [shape for one in (inner if isinstance(inner, (list, tuple)) else [inner]) for shape in _shapes(one)]
    if not shapes:
        raise BadInput(f"clip: {kind} has no polygon")
    return shapes
