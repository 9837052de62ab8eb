"""Pictures, maps, and the year of direct sun at a point."""

from __future__ import annotations

from typing import Dict, Optional

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterRasterLayer,
)

from .algorithm import RelevoAlgorithm
from .backend import Picture, RelevoError
from .inputs import file_of

_REAL, _WHOLE = QgsProcessingParameterNumber.Double, QgsProcessingParameterNumber.Integer


class PictureAlgorithm(RelevoAlgorithm):
    """An algorithm that draws a scene."""

    WIDTH, HEIGHT, EXAGGERATION, PRESET = "WIDTH", "HEIGHT", "EXAGGERATION", "PRESET"
    ENABLE, DISABLE, VALUES, STAMPS, OVERLAY = "ENABLE", "DISABLE", "VALUES", "STAMPS", "OVERLAY"
    group_title = "Pictures"
    # The built-in ones (data/presets).
    PRESETS = ["none", "aspect", "bathymetry", "clay", "paper", "relief", "slope", "swiss"]
    _STAMPS = ["title", "scale", "north", "graticule", "date", "sun"]

    def add_scene(self) -> None:
        self.add_dem()
        self.add_time(optional=True)
        self.addParameter(
            QgsProcessingParameterRasterLayer(self.OVERLAY, "Raster to lay on the ground, such as hours of sun", None, True)
        )
        self.addParameter(QgsProcessingParameterNumber(self.WIDTH, "Width [pixels]", _WHOLE, 1280, False, 16, 65536))
        self.addParameter(QgsProcessingParameterNumber(self.HEIGHT, "Height [pixels]", _WHOLE, 720, False, 16, 65536))

    def add_effects(self) -> None:
        self.addParameter(
            QgsProcessingParameterNumber(self.EXAGGERATION, "Vertical exaggeration", _REAL, 1, False, 0, 100)
        )
        self.addParameter(
            QgsProcessingParameterEnum(
                self.PRESET, "Preset", self.PRESETS, defaultValue=self.PRESETS[0], usesStaticStrings=True
            )
        )
        self.addParameter(
            QgsProcessingParameterEnum(
                self.STAMPS, "Stamps", self._STAMPS, allowMultiple=True, optional=True, usesStaticStrings=True
            )
        )
        self.add_text(self.ENABLE, "Effects to switch on, with commas between", advanced=True)
        self.add_text(self.DISABLE, "Effects to switch off, with commas between", advanced=True)
        self.add_text(self.VALUES, "Parameters of effects (haze.density=0.2, terrain.normal=vertex)", advanced=True)

    def scene(self, parameters, context, watch) -> dict:
        """Members of Picture that all pictures have."""
        overlay = self.parameterAsRasterLayer(parameters, self.OVERLAY, context)
        preset = self.parameterAsEnumString(parameters, self.PRESET, context)
        exaggeration = self.parameterAsDouble(parameters, self.EXAGGERATION, context)
        self.zone(parameters, context, watch)
        return {
            "when": self.when(parameters, context),
            "size": (
                self.parameterAsInt(parameters, self.WIDTH, context),
                self.parameterAsInt(parameters, self.HEIGHT, context),
            ),
            "exaggeration": None if exaggeration == 1 else exaggeration,
            "preset": None if preset == self.PRESETS[0] else preset,
            "enable": self.words(parameters, self.ENABLE, context),
            "disable": self.words(parameters, self.DISABLE, context),
            "values": self._values(parameters, context),
            "stamps": [word for word in self.parameterAsEnumStrings(parameters, self.STAMPS, context) if word],
            "overlay": None if overlay is None else file_of(overlay),
        }

    def _values(self, parameters, context) -> Dict[str, str]:
        values = {}
        for word in self.words(parameters, self.VALUES, context):
            address, equals, value = word.partition("=")
            if not equals:
                raise RelevoError(f"parameters of effects: {word}: expected effect.parameter=value")
            values[address.strip()] = value.strip()
        return values


class Capture(PictureAlgorithm):
    word = "capture"
    title = "Capture a picture"
    help = (
        "Draws an elevation raster in perspective, as the sun lights it at a time. Without a time, and with an automatic "
        "camera, both are chosen so that they show the relief.\n\n"
        "The time is local time of the time zone, which is that of the raster's centre unless one is given."
    )
    SIDE, ELEVATION, ZOOM = "SIDE", "ELEVATION", "ZOOM"
    _SIDES = ["automatic", "north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west",
              "top"]  # fmt: skip

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add_scene()
        self.addParameter(
            QgsProcessingParameterEnum(
                self.SIDE, "Side of the camera", self._SIDES, defaultValue=self._SIDES[0], usesStaticStrings=True
            )
        )
        self.addParameter(
            QgsProcessingParameterNumber(self.ELEVATION, "Elevation of the camera [degrees]", _REAL, None, True, 0, 90)
        )
        self.addParameter(QgsProcessingParameterNumber(self.ZOOM, "Zoom", _REAL, 1, False, 0.01, 1000))
        self.add_effects()
        self.addParameter(
            QgsProcessingParameterFileDestination(
                self.OUTPUT, "Picture", "PNG (*.png);;JPEG (*.jpg);;WebP (*.webp);;TIFF (*.tif)"
            )
        )

    def compute(self, backend, parameters, context, feedback, watch):
        side = self.parameterAsEnumString(parameters, self.SIDE, context)
        zoom = self.parameterAsDouble(parameters, self.ZOOM, context)
        picture = Picture(
            side=None if side == self._SIDES[0] else side,
            elevation_deg=self.number(parameters, self.ELEVATION, context),
            zoom=None if zoom == 1 else zoom,
            **self.scene(parameters, context, watch),
        )
        output = self.parameterAsFileOutput(parameters, self.OUTPUT, context)
        backend.capture(self.dem(parameters, context), picture, output, watch)
        return {self.OUTPUT: output}


class Map(PictureAlgorithm):
    word = "map"
    title = "Draw a map"
    help = (
        "Draws an elevation raster from straight above, as the sun lights it at a time, as a georeferenced raster in its "
        "CRS. It has the shape of the elevation raster within the width and the height, or pixels of a given size."
    )
    RESOLUTION = "RESOLUTION"

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add_scene()
        self.addParameter(
            QgsProcessingParameterNumber(
                self.RESOLUTION, "Side of a pixel in units of the CRS, instead of width and height", _REAL, None, True, 0
            )
        )
        self.add_effects()
        self.addParameter(QgsProcessingParameterRasterDestination(self.OUTPUT, "Map"))

    def compute(self, backend, parameters, context, feedback, watch):
        picture = Picture(
            is_map=True,
            resolution=self.number(parameters, self.RESOLUTION, context),
            **self.scene(parameters, context, watch),
        )
        output = self.parameterAsOutputLayer(parameters, self.OUTPUT, context)
        backend.capture(self.dem(parameters, context), picture, output, watch)
        return {self.OUTPUT: output}


class Carpet(RelevoAlgorithm):
    word = "carpet"
    title = "Direct sun of a year at a point"
    group_title = "Sunlight"
    help = (
        "When a point has direct sun in the course of a year: a diagram of days and times of day (night, twilight, behind "
        "terrain, in the sun), and the same as a table."
    )
    POINT, YEAR, TABLE = "POINT", "YEAR", "TABLE"

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add_dem()
        self.add_surroundings()
        self.addParameter(QgsProcessingParameterPoint(self.POINT, "Point"))
        self.addParameter(QgsProcessingParameterNumber(self.YEAR, "Year", _WHOLE, 2026, False, 1900, 2100))
        self.add_zone()
        self.addParameter(
            QgsProcessingParameterFileDestination(self.OUTPUT, "Diagram", "PNG (*.png);;SVG (*.svg)")
        )
        self.addParameter(
            QgsProcessingParameterFileDestination(self.TABLE, "Table", "CSV (*.csv)", optional=True, createByDefault=False)
        )

    def compute(self, backend, parameters, context, feedback, watch):
        crs = QgsCoordinateReferenceSystem("EPSG:4326")
        point = self.parameterAsPoint(parameters, self.POINT, context, crs)
        output = self.parameterAsFileOutput(parameters, self.OUTPUT, context)
        table: Optional[str] = self.parameterAsFileOutput(parameters, self.TABLE, context) or None
        backend.carpet(
            self.dem(parameters, context),
            (point.y(), point.x()),
            self.parameterAsInt(parameters, self.YEAR, context),
            self.zone(parameters, context, watch),
            output,
            table,
            watch,
        )
        return {self.OUTPUT: output, **({self.TABLE: table} if table else {})}
