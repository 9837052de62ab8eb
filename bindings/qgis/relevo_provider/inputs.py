"""QGIS' layers and times as Relevo takes them."""

from __future__ import annotations

import os
import shlex
from typing import Optional, Union

from qgis.core import QgsCoordinateReferenceSystem, QgsRasterLayer
from qgis.PyQt.QtCore import QDateTime, Qt

from .backend import Dem, Options, RelevoError

_FORMAT = "yyyy-MM-ddTHH:mm:ss"


def file_of(layer: QgsRasterLayer) -> str:
    """The name of a layer's file, or of what GDAL opens in its place. Raises RelevoError for layers of other providers."""
    if layer.providerType() != "gdal":
        raise RelevoError(
            f"layer {layer.name()}: comes from the provider {layer.providerType()}, expected a raster file; "
            "export the layer as a GeoTIFF"
        )
    # The whole of it names what GDAL opens: a file, one in an archive, a part of a file such as GPKG:dem.gpkg:heights.
    name = layer.dataProvider().dataSourceUri()
    if "|" in name:
        raise RelevoError(f"layer {layer.name()}: has open options, which Relevo does not take; export it as a GeoTIFF")
    if "/vsimem/" in name:
        raise RelevoError(f"layer {layer.name()}: is in the memory of QGIS, expected a file; export it as a GeoTIFF")
    return os.path.abspath(name) if os.path.exists(name) else name


def crs_text(crs: QgsCoordinateReferenceSystem) -> str:
    return crs.authid() or crs.toWkt(QgsCoordinateReferenceSystem.WKT2_2019)


def dem_of(
    layer: QgsRasterLayer, band: Optional[int] = None, unit: Optional[str] = None, options: str = "",
    surroundings: Optional[QgsRasterLayer] = None,
) -> Dem:
    """@param band, unit  of the heights; None: as Relevo finds them
    @param options     of the program, as a shell takes them"""
    crs = None
    # A CRS that was set in QGIS goes before that of the file.
    if layer.crs().isValid() and layer.crs() != layer.dataProvider().crs():
        crs = crs_text(layer.crs())
    try:
        wider = file_of(surroundings) if surroundings else None
        return Dem(file_of(layer), crs, band, unit, shlex.split(options), wider)
    except ValueError as error:
        raise RelevoError(f"options: {options}: {error}") from error


def when_of(time: Union[QDateTime, str, None], event: str, zone: str) -> Optional[Options]:
    """A time as Relevo takes it: time, the date of an event, zone.

    time: a text is used as it is: Qt would move times that the clocks of this computer skip
    event: of the sun instead of the time of day, "sunset-30min"; may be empty
    zone: may be empty

    Returns None if there is neither a time nor an event.
    """
    text = time.strip().replace(" ", "T", 1) if isinstance(time, str) else _text_of(time)
    if not text:
        if event:
            raise RelevoError(f"event {event}: expected also a time, which names its day")
        return None
    return {"time": event or text, "date": text[:10] if event else None, "zone": zone or None}


def _text_of(time: Optional[QDateTime]) -> str:
    if time is None or not time.isValid():
        return ""
    if time.timeSpec() in (Qt.UTC, Qt.OffsetFromUTC):
        return time.toUTC().toString(_FORMAT) + "Z"
    return time.toString(_FORMAT)
