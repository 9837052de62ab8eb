"""The terrain horizon at the points of a layer."""

from __future__ import annotations

import math
from typing import List, Union

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsFeatureSink,
    QgsField,
    QgsFields,
    QgsGeometry,
    QgsPointXY,
    QgsProcessing,
    QgsProcessingException,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterNumber,
    QgsProcessingUtils,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QVariant

from .algorithm import RelevoAlgorithm
from .backend import Direction, RelevoError, Watch

Answer = Union[List[Direction], str]


class HorizonAtPoints(RelevoAlgorithm):
    word = "horizon"
    title = "Horizon at points"
    group_title = "Sunlight"
    help = (
        "The elevation of the horizon that the terrain makes around the points of a layer, in degrees, in steps of the "
        "azimuth clockwise from true north, with terrestrial refraction.\n\n"
        "Either a row for each point and azimuth (azimuth_deg, horizon_deg, and distance_m to the ground that makes the "
        "horizon, empty if the raster blocks nothing), or a row for each point with a field for each azimuth (h_0, "
        "h_10, ...). A point without figures, such as one outside of the raster, has the reason in the field error."
    )
    POINTS, EYE, STEP, LAYOUT = "POINTS", "EYE_HEIGHT", "STEP", "LAYOUT"
    _LAYOUTS = ["rows", "fields"]

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add_dem()
        self.add_surroundings()
        real = QgsProcessingParameterNumber.Double
        self.addParameter(
            QgsProcessingParameterFeatureSource(self.POINTS, "Points", [QgsProcessing.TypeVectorPoint])
        )
        self.addParameter(
            QgsProcessingParameterNumber(self.EYE, "Height of the eye above the ground [m]", real, 0, False, 0, 10000)
        )
        self.addParameter(
            QgsProcessingParameterNumber(self.STEP, "Step of the azimuth [degrees]", real, 10, False, 0.01, 90)
        )
        self.addParameter(
            QgsProcessingParameterEnum(
                self.LAYOUT, "Table", self._LAYOUTS, defaultValue="rows", usesStaticStrings=True
            )
        )
        self.addParameter(
            QgsProcessingParameterFeatureSink(self.OUTPUT, "Horizon", QgsProcessing.TypeVectorPoint)
        )

    def compute(self, backend, parameters, context, feedback, watch):
        source = self.parameterAsSource(parameters, self.POINTS, context)
        if source is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, self.POINTS))
        step_deg = self.parameterAsDouble(parameters, self.STEP, context)
        in_rows = self.parameterAsEnumString(parameters, self.LAYOUT, context) == "rows"
        points = _points_of(source, watch)
        places = _places_of(points, source.sourceCrs(), context.transformContext())
        eye_m = self.parameterAsDouble(parameters, self.EYE, context)
        answers: List[Answer] = []
        if places:
            answers = backend.horizons(self.dem(parameters, context), places, eye_m, step_deg, watch)
        azimuths = _azimuths_of(answers, step_deg)
        names = ["azimuth_deg", "horizon_deg", "distance_m"] if in_rows else [f"h_{azimuth:.10g}" for azimuth in azimuths]
        fields = _fields(source.fields(), names)
        wkb_type = QgsWkbTypes.singleType(source.wkbType())
        sink, name = self.parameterAsSink(parameters, self.OUTPUT, context, fields, wkb_type, source.sourceCrs())
        if sink is None:
            raise QgsProcessingException(self.invalidSinkError(parameters, self.OUTPUT))
        for (feature, point), answer in zip(points, answers):
            rows = _long_rows(answer) if in_rows else [_wide_row(answer, len(azimuths))]
            for row in rows:
                result = QgsFeature(fields)
                result.setGeometry(QgsGeometry(point.clone()))
                result.setAttributes(feature.attributes() + row)
                sink.addFeature(result, QgsFeatureSink.FastInsert)
        return {self.OUTPUT: name}


def _points_of(source, watch: Watch):
    """(feature, point) of each point; a feature may have several."""
    points, without = [], 0
    for feature in source.getFeatures():
        vertices = list(feature.geometry().vertices())
        without += not vertices
        points += [(feature, point) for point in vertices]
    if without:
        watch.warning(f"{without} features have no point: they are skipped")
    return points


def _places_of(points, crs, transforms):
    """(latitude, longitude) of each point."""
    if not crs.isValid():
        raise RelevoError("points: have no coordinate system, expected one; set that of the layer")
    to_degrees = QgsCoordinateTransform(crs, QgsCoordinateReferenceSystem("EPSG:4326"), transforms)
    try:
        places = [to_degrees.transform(QgsPointXY(point)) for _, point in points]
    except QgsCsException as error:
        raise RelevoError(f"points: cannot be transformed to latitudes and longitudes: {error}") from error
    return [(place.y(), place.x()) for place in places]


def _azimuths_of(answers: List[Answer], step_deg: float) -> List[float]:
    """Those of the horizons; where no point has one, those that were asked for."""
    for answer in answers:
        if not isinstance(answer, str):
            return [one.azimuth_deg for one in answer]
    return [k * step_deg for k in range(math.ceil(round(360 / step_deg, 6)))]


def _fields(given: QgsFields, names: List[str]) -> QgsFields:
    """The given fields and those of the horizon. QGIS renames those that are there already: error_2."""
    fields = QgsFields()
    for name in names:
        fields.append(QgsField(name, QVariant.Double))
    fields.append(QgsField("error", QVariant.String))
    return QgsProcessingUtils.combineFields(given, fields)


def _long_rows(answer: Answer) -> List[list]:
    if isinstance(answer, str):
        return [[None, None, None, answer]]
    return [[one.azimuth_deg, one.horizon_deg, one.distance_m, None] for one in answer]


def _wide_row(answer: Answer, count: int) -> list:
    if isinstance(answer, str):
        return [None] * count + [answer]
    return [one.horizon_deg for one in answer] + [None]
