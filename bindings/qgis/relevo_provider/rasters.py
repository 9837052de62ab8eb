"""Rasters of figures on the DEM's grid: shadow, hours of direct sun, sky-view factor."""

from __future__ import annotations

from typing import Optional, Tuple

from qgis.core import (
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDateTime,
    QgsProcessingParameterEnum,
    QgsProcessingParameterExtent,
    QgsProcessingParameterNumber,
    QgsProcessingParameterRasterDestination,
)
from qgis.PyQt.QtCore import Qt

from .algorithm import RelevoAlgorithm
from .backend import Bounds, Options, RelevoError
from .styles import load_as, style_result


class RasterAlgorithm(RelevoAlgorithm):
    """An algorithm whose result is a GeoTIFF with a style. Subclasses have `figure`, as Backend.raster(), and options()."""

    EXTENT = "EXTENT"
    group_title = "Sunlight"
    figure = ""

    def add_raster(self, description: str) -> None:
        self.add_advanced(
            QgsProcessingParameterExtent(
                self.EXTENT, "Only this part of the raster; terrain outside of it counts", optional=True
            )
        )
        self.addParameter(QgsProcessingParameterRasterDestination(self.OUTPUT, description))

    def bounds(self, parameters, context) -> Optional[Bounds]:
        """The extent in the CRS of the DEM."""
        crs = self.parameterAsRasterLayer(parameters, self.DEM, context).crs()
        extent = self.parameterAsExtent(parameters, self.EXTENT, context, crs)
        if extent.isEmpty():
            return None
        return extent.xMinimum(), extent.yMinimum(), extent.xMaximum(), extent.yMaximum()

    def options(self, parameters, context) -> Tuple[Options, str]:
        """Options of the figure, and a title."""
        raise NotImplementedError

    def compute(self, backend, parameters, context, feedback, watch):
        options, title = self.options(parameters, context)
        if options.get("zone"):
            watch.info(f"time zone {options['zone']}")
        output = self.parameterAsOutputLayer(parameters, self.OUTPUT, context)
        dem, bounds = self.dem(parameters, context), self.bounds(parameters, context)
        backend.raster(self.figure, dem, options, bounds, output, watch)
        style_result(output, title)
        load_as(context, output, title)
        return {self.OUTPUT: output}


class Shadow(RasterAlgorithm):
    word = figure = "shadow"
    title = "Shadow mask"
    help = (
        "Which cells of an elevation raster the sun reaches at a time: 1 in the sun, 0 in the shadow of the terrain. "
        "Or the visible fraction of the solar disc, 0 to 1.\n\n"
        "The time is local time of the time zone, which is that of the raster's centre unless one is given. "
        "The log says which one it is, and whether terrain outside of the raster could change the result."
    )
    SOFT = "SOFT"

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add_dem()
        self.add_surroundings()
        self.add_time(optional=False)
        self.addParameter(
            QgsProcessingParameterBoolean(self.SOFT, "Visible fraction of the solar disc instead of a mask", False)
        )
        self.add_raster("Shadow")

    def options(self, parameters, context):
        when = self.when(parameters, context)
        if when is None:
            raise RelevoError("time: expected a date and a time such as 2026-06-21T18:30:00")
        soft = self.parameterAsBoolean(parameters, self.SOFT, context)
        what = "Visible fraction of the solar disc" if soft else "Direct sun"
        words = (when["time"].replace("T", " "), when["date"], when["zone"])
        return {**when, "soft": soft}, f"{what}, {' '.join(word for word in words if word)}"


class SunHours(RasterAlgorithm):
    word, figure = "sunhours", "hours"
    title = "Hours of direct sun"
    help = (
        "Hours of direct sun on each cell of an elevation raster on a day, over several days or a year, behind the "
        "terrain's own shadows and without clouds. Days last from midnight to midnight of the time zone.\n\n"
        "Bands: hours; of at most four days first and last (minutes from the beginning to the first and the last sun) "
        "and spells (number of sunshine periods); global, beam, diffuse and reflected: clear-sky irradiation of the "
        "inclined ground in kWh/m2. The style shows the first band."
    )
    FROM, TO, YEAR, BANDS = "FROM", "TO", "YEAR", "BANDS"
    STEP, LINKE, ALBEDO = "STEP", "LINKE", "ALBEDO"
    _TITLES = {"hours": "Hours of direct sun", "first": "First sun", "last": "Last sun", "spells": "Sunshine periods"}
    _IRRADIATION = ["global", "beam", "diffuse", "reflected"]

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add_dem()
        self.add_surroundings()
        date = QgsProcessingParameterDateTime.Date
        self.addParameter(QgsProcessingParameterDateTime(self.FROM, "Day, or first day", date, optional=True))
        self.addParameter(QgsProcessingParameterDateTime(self.TO, "Last day (empty: one day)", date, optional=True))
        whole, real = QgsProcessingParameterNumber.Integer, QgsProcessingParameterNumber.Double
        self.addParameter(QgsProcessingParameterNumber(self.YEAR, "Year instead of days", whole, None, True, 1900, 2100))
        self.add_zone()
        bands = [*self._TITLES, *self._IRRADIATION]
        self.addParameter(QgsProcessingParameterEnum(self.BANDS, "Bands", bands, True, ["hours"], False, True))
        self.add_advanced(
            QgsProcessingParameterNumber(self.STEP, "Time step of at most four days [min]", real, 3, False, 1 / 60, 60)
        )
        self.add_advanced(
            QgsProcessingParameterNumber(self.LINKE, "Linke turbidity, for irradiation", real, 3, False, 1, 10)
        )
        self.add_advanced(
            QgsProcessingParameterNumber(self.ALBEDO, "Albedo of the ground, for irradiation", real, 0.2, False, 0, 1)
        )
        self.add_raster("Hours of direct sun")

    def checkParameterValues(self, parameters, context):  # noqa: N802
        try:
            self._days(parameters, context)
        except RelevoError as error:
            return False, str(error)
        return super().checkParameterValues(parameters, context)

    def options(self, parameters, context):
        days = self._days(parameters, context)
        bands = self.parameterAsEnumStrings(parameters, self.BANDS, context)
        step, linke, albedo = (
            self.parameterAsDouble(parameters, name, context) for name in (self.STEP, self.LINKE, self.ALBEDO)
        )
        # Those that count: Relevo refuses others.
        numbers = {"step": 60 * step} if "year" not in days and step != 3 else {}
        if any(band in self._IRRADIATION for band in bands):
            numbers.update(linke=linke, albedo=albedo)
        zone = self.text(parameters, self.ZONE, context) or None
        what = self._TITLES.get(bands[0], f"{bands[0].capitalize()} irradiation")
        options = {**days, "zone": zone, "bands": bands, **numbers}
        return options, f"{what}, {' to '.join(map(str, days.values()))}"

    def _days(self, parameters, context) -> Options:
        first, last = (self._date(parameters, name, context) for name in (self.FROM, self.TO))
        year = None if parameters.get(self.YEAR) is None else self.parameterAsInt(parameters, self.YEAR, context)
        if (first is None) == (year is None):
            raise RelevoError("days: expected either a first day or a year")
        if year is not None:
            if last is not None:
                raise RelevoError("days: expected either a last day or a year")
            return {"year": year}
        return {"date": first} if last in (None, first) else {"start": first, "end": last}

    def _date(self, parameters, name, context) -> Optional[str]:
        if parameters.get(name) is None:
            return None
        time = self.parameterAsDateTime(parameters, name, context)
        if not time.isValid():
            raise RelevoError(f"{name}: expected a date such as 2026-06-21 but got {parameters[name]}")
        return time.date().toString(Qt.ISODate)


class SkyView(RasterAlgorithm):
    word, figure = "skyview", "sky_view"
    title = "Sky-view factor"
    help = (
        "The fraction of a uniform sky's light that reaches the inclined ground of each cell of an elevation raster, "
        "0 to 1 (Dozier and Frew 1990). Or that of a level plane at each cell."
    )
    DIRECTIONS, LEVEL = "DIRECTIONS", "LEVEL"

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add_dem()
        self.add_surroundings()
        whole = QgsProcessingParameterNumber.Integer
        self.addParameter(
            QgsProcessingParameterNumber(self.DIRECTIONS, "Azimuths around each cell", whole, 36, False, 4, 3600)
        )
        self.addParameter(
            QgsProcessingParameterBoolean(self.LEVEL, "For a level plane instead of the inclined ground", False)
        )
        self.add_raster("Sky-view factor")

    def options(self, parameters, context):
        directions = self.parameterAsInt(parameters, self.DIRECTIONS, context)
        return {"directions": directions, "level": self.parameterAsBoolean(parameters, self.LEVEL, context)}, self.title
