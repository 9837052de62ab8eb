"""QGIS' layers and times as Relevo takes them."""

from __future__ import annotations

import os
from typing import Optional

from qgis.core import QgsCoordinateReferenceSystem, QgsProviderRegistry, QgsRasterLayer
from qgis.PyQt.QtCore import QDateTime, Qt

from .backend import Dem, RelevoError, When


def file_of(layer: QgsRasterLayer) -> str:
    """The name of a layer's file, or of what GDAL opens in its place. Raises RelevoError for layers of other providers."""
    if layer.providerType() != "gdal":
        raise RelevoError(
            f"layer {layer.name()}: comes from the provider {layer.providerType()}, expected a raster file; "
            "export the layer as a GeoTIFF"
        )
    source = layer.dataProvider().dataSourceUri()
    parts = QgsProviderRegistry.instance().decodeUri("gdal", source)
    if parts.get("openOptions"):
        raise RelevoError(f"layer {layer.name()}: has open options, which Relevo does not take; export it as a GeoTIFF")
    path = parts.get("path") or source
    # A part of a file, such as NETCDF:"file.nc":height, is named by the whole of it.
    name = source if parts.get("layerName") else path
    if "/vsimem/" in name:
        raise RelevoError(f"layer {layer.name()}: is in the memory of QGIS, expected a file; export it as a GeoTIFF")
    return os.path.abspath(name) if os.path.exists(name) else name


def crs_text(crs: QgsCoordinateReferenceSystem) -> str:
    return crs.authid() or crs.toWkt(QgsCoordinateReferenceSystem.WKT2_2019)


def dem_of(layer: QgsRasterLayer, band: Optional[int], unit: Optional[str]) -> Dem:
    """@param band, unit  of the heights; None: as Relevo finds them"""
    crs = None
    # A CRS that was set in QGIS goes before that of the file.
    if layer.crs().isValid() and layer.crs() != layer.dataProvider().crs():
        crs = crs_text(layer.crs())
    return Dem(file_of(layer), crs, band, unit)


def when_of(time: Optional[QDateTime], event: str, zone: str) -> Optional[When]:
    """@param event  of the sun instead of the time of day: "sunset-30min"; may be empty
    @param zone   may be empty
    @returns None if there is neither a time nor an event"""
    if time is None or not time.isValid():
        if event:
            raise RelevoError(f"event {event}: expected also a time, which names its day")
        return None
    if event:
        return When(event, time.date().toString(Qt.ISODate), zone or None)
    if time.timeSpec() in (Qt.UTC, Qt.OffsetFromUTC):
        return When(time.toUTC().toString("yyyy-MM-ddTHH:mm:ss") + "Z", None, zone or None)
    return When(time.toString("yyyy-MM-ddTHH:mm:ss"), None, zone or None)
