"""Style, legend and metadata of results, in files next to them that QGIS reads: .qml and .qmd."""

from __future__ import annotations

import math
import os
from typing import List, Tuple

from osgeo import gdal
from qgis.core import (
    QgsBasicNumericFormat,
    QgsColorRampLegendNodeSettings,
    QgsColorRampShader,
    QgsGradientColorRamp,
    QgsGradientStop,
    QgsPalettedRasterRenderer,
    QgsProcessingContext,
    QgsProcessingLayerPostProcessorInterface,
    QgsRasterLayer,
    QgsRasterRenderer,
    QgsRasterShader,
    QgsSingleBandPseudoColorRenderer,
)
from qgis.PyQt.QtGui import QColor

from .backend import RelevoError
from .ramps import RAMPS, usual_ramp


def _color(stop: Tuple[str, float]) -> QColor:
    color = QColor("#" + stop[0])
    color.setAlphaF(stop[1])
    return color


def _range_of(band: gdal.Band) -> Tuple[float, float]:
    """Smallest and largest value; without values 0 and 1."""
    try:
        low, high = band.ComputeRasterMinMax(False)
    except (RuntimeError, TypeError):  # no valid value
        return 0.0, 1.0
    return (low, high) if math.isfinite(low) and math.isfinite(high) else (0.0, 1.0)


def _mask_renderer(layer: QgsRasterLayer) -> QgsRasterRenderer:
    dark, light = RAMPS["shade"]
    # Legends ignore opacity: what is lit and stays as it is has a white box.
    classes = [
        QgsPalettedRasterRenderer.Class(1, _color(("ffffff", light[1])), "in the sun"),
        QgsPalettedRasterRenderer.Class(0, _color(dark), "in the shade"),
    ]
    return QgsPalettedRasterRenderer(layer.dataProvider(), 1, classes)


def _gradient(colors: List[QColor]) -> QgsGradientColorRamp:
    stops = [QgsGradientStop(k / (len(colors) - 1), color) for k, color in enumerate(colors)]
    return QgsGradientColorRamp(colors[0], colors[-1], False, stops[1:-1])


def _legend(suffix: str, decimals: int) -> QgsColorRampLegendNodeSettings:
    number = QgsBasicNumericFormat()
    number.setNumberDecimalPlaces(decimals)
    legend = QgsColorRampLegendNodeSettings()
    legend.setSuffix(suffix)
    legend.setNumericFormat(number)
    return legend


def _ramp_renderer(layer: QgsRasterLayer, name: str, unit: str, low: float, high: float) -> QgsRasterRenderer:
    ramp, low, high = usual_ramp(name, unit, low, high)
    colors = [_color(stop) for stop in RAMPS[ramp]]
    suffix = "" if unit in ("", "1") else " " + unit
    decimals = max(0, 2 - math.floor(math.log10(high - low)))
    shader = QgsColorRampShader(low, high, _gradient(colors), QgsColorRampShader.Interpolated)
    items = []
    for k, color in enumerate(colors):
        value = low + (high - low) * k / (len(colors) - 1)
        items.append(QgsColorRampShader.ColorRampItem(value, color, f"{value:.{decimals}f}{suffix}"))
    shader.setColorRampItemList(items)
    shader.setLegendSettings(_legend(suffix, decimals))
    raster_shader = QgsRasterShader(low, high)
    raster_shader.setRasterShaderFunction(shader)
    renderer = QgsSingleBandPseudoColorRenderer(layer.dataProvider(), 1, raster_shader)
    renderer.setClassificationMin(low)
    renderer.setClassificationMax(high)
    return renderer


def _set_metadata(layer: QgsRasterLayer, title: str, dataset: gdal.Dataset) -> None:
    about = dataset.GetMetadata()
    metadata = layer.metadata()
    metadata.setType("dataset")
    metadata.setTitle(title)
    sentences = [about.get("DEFINITION", ""), about.get("BEYOND_DEM", "")]
    bands = [dataset.GetRasterBand(k + 1) for k in range(dataset.RasterCount)]
    sentences += [f"Band {k}: {band.GetDescription()} [{band.GetUnitType()}]" for k, band in enumerate(bands, 1)]
    metadata.setAbstract("\n".join(sentence for sentence in sentences if sentence))
    metadata.addHistoryItem(f"Computed by {about.get('TIFFTAG_SOFTWARE', 'Relevo')} from {about.get('DEM', 'a DEM')}")
    layer.setMetadata(metadata)


def style_result(path: str, title: str) -> None:
    """Writes the style and the metadata of a raster of figures next to it. Raises RelevoError if that fails.

    The style is of the first band: classes for a mask, else Relevo's colours for the band, from its smallest to its largest
    value, with the unit in the legend.
    """
    _write_style(path, title)
    # Statistics that QGIS keeps of its first look at the file, or of an earlier file of this name.
    if os.path.exists(path + ".aux.xml"):
        os.remove(path + ".aux.xml")


def _write_style(path: str, title: str) -> None:
    layer = QgsRasterLayer(path, title, "gdal", QgsRasterLayer.LayerOptions(False))
    dataset = gdal.Open(path)
    if not layer.isValid() or dataset is None:
        raise RelevoError(f"{path}: QGIS cannot open the result")
    band = dataset.GetRasterBand(1)
    if band.DataType == gdal.GDT_Byte:
        layer.setRenderer(_mask_renderer(layer))
    else:
        layer.setRenderer(_ramp_renderer(layer, band.GetDescription(), band.GetUnitType(), *_range_of(band)))
    _set_metadata(layer, title, dataset)
    for save, file in ((layer.saveNamedStyle, _beside(path, ".qml")), (layer.saveNamedMetadata, _beside(path, ".qmd"))):
        message, saved = save(file)
        if not saved:
            raise RelevoError(f"{file}: {message}")


def _beside(path: str, ending: str) -> str:
    return os.path.splitext(path)[0] + ending


class _Loader(QgsProcessingLayerPostProcessorInterface):
    """Gives a layer that QGIS has loaded its style and its metadata."""

    alive: "List[_Loader]" = []  # QGIS does not keep them

    def postProcessLayer(self, layer, context, feedback):  # noqa: N802, QGIS calls it
        path = layer.source()
        for load, file in ((layer.loadNamedStyle, _beside(path, ".qml")), (layer.loadNamedMetadata, _beside(path, ".qmd"))):
            if os.path.exists(file):
                load(file)
        layer.triggerRepaint()
        self.alive.remove(self)


def load_as(context: QgsProcessingContext, path: str, title: str) -> None:
    """Has QGIS give the layer of a result its title and style, if it loads it."""
    if not context.willLoadLayerOnCompletion(path):
        return
    details = context.layerToLoadOnCompletionDetails(path)
    details.name = title
    loader = _Loader()
    _Loader.alive.append(loader)
    details.setPostProcessor(loader)
