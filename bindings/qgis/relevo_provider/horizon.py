"""The terrain horizon at the points of a layer."""

from __future__ import annotations

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
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QVariant

from .algorithm import RelevoAlgorithm
from .backend import Direction, RelevoError

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
        points = [(feature, point) for feature in source.getFeatures() for point in feature.geometry().vertices()]
        places = _places_of(points, source.sourceCrs(), context.transformContext())
        eye_m = self.parameterAsDouble(parameters, self.EYE, context)
        answers: List[Answer] = []
        if places:
            answers = backend.horizons(self.dem(parameters, context), places, eye_m, step_deg, watch)
        azimuths = next(([one.azimuth_deg for one in answer] for answer in answers if not isinstance(answer, str)), [])
        fields = _fields(source.fields(), [] if in_rows else azimuths)
        wkb_type = QgsWkbTypes.singleType(source.wkbType())
        sink, name = self.parameterAsSink(
            parameters, self.OUTPUT, context, fields, wkb_type, source.sourceCrs()
        )
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


def _fields(given: QgsFields, azimuths: List[float]) -> QgsFields:
    """@param azimuths  a field for each; empty: the fields of a row for each direction"""
    fields = QgsFields(given)
    names = [f"h_{azimuth:.10g}" for azimuth in azimuths] or ["azimuth_deg", "horizon_deg", "distance_m"]
    for name in names:
        fields.append(QgsField(name, QVariant.Double))
    fields.append(QgsField("error", QVariant.String))
    return fields


def _long_rows(answer: Answer) -> List[list]:
    if isinstance(answer, str):
        return [[None, None, None, answer]]
    return [[one.azimuth_deg, one.horizon_deg, one.distance_m, None] for one in answer]


def _wide_row(answer: Answer, count: int) -> list:
    if isinstance(answer, str):
        return [None] * (count or 3) + [answer]
    return [one.horizon_deg for one in answer] + [None]
