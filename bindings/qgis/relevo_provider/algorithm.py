"""What all algorithms share: the DEM, the time zone, messages, errors, and the way to Relevo."""

from __future__ import annotations

import os
from typing import List, Optional

from processing.core.ProcessingConfig import ProcessingConfig
from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsProcessingParameterBand,
    QgsProcessingParameterDateTime,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterString,
)
from qgis.PyQt.QtGui import QIcon

from . import library, program
from .backend import Backend, Cancelled, Dem, Options, RelevoError, Watch
from .inputs import dem_of, when_of

PROGRAM_SETTING = "RELEVO_PROGRAM"
NOT_FOUND = (
    "Relevo is not installed: there is neither a program relevo on PATH or in the settings of Processing, "
    "nor a Python package relevo"
)
_UNITS = ["automatic", "m", "ft", "us-ft", "cm", "mm", "dm", "km"]


def find_backend() -> Optional[Backend]:
    """The program of the setting or on PATH, else the Python package; None if there is neither."""
    setting = ProcessingConfig.getSetting(PROGRAM_SETTING) or ""
    path = program.find(setting)
    if path:
        return program.Program(path)
    if setting:
        raise RelevoError(f"{setting}: no program; correct it in the settings of Processing, or leave it empty")
    return library.find()


class FeedbackWatch(Watch):
    """Hands what Relevo says to QGIS."""

    def __init__(self, feedback: QgsProcessingFeedback) -> None:
        self._feedback = feedback

    def progress(self, share: float) -> None:
        self._feedback.setProgress(100 * share)

    def is_cancelled(self) -> bool:
        return self._feedback.isCanceled()

    def info(self, text: str) -> None:
        self._feedback.pushInfo(text)

    def warning(self, text: str) -> None:
        self._feedback.pushWarning(text)


class RelevoAlgorithm(QgsProcessingAlgorithm):
    """An algorithm over a DEM. Subclasses have `word`, `title`, `group_title`, `help`, and compute()."""

    DEM, BAND, UNIT, OPTIONS, SURROUNDINGS = "INPUT", "BAND", "UNIT", "OPTIONS", "SURROUNDINGS"
    TIME, EVENT, ZONE = "TIME", "EVENT", "ZONE"
    OUTPUT = "OUTPUT"

    word = title = group_title = help = ""

    def name(self):
        return self.word

    def displayName(self):  # noqa: N802
        return self.title

    def group(self):
        return self.group_title

    def groupId(self):  # noqa: N802
        return self.group_title.lower().replace(" ", "")

    def shortHelpString(self):  # noqa: N802
        return self.help

    def icon(self):
        return QIcon(self.svgIconPath())

    def svgIconPath(self):  # noqa: N802
        return os.path.join(os.path.dirname(__file__), "icon.svg")

    def createInstance(self):  # noqa: N802
        return type(self)()

    def canExecute(self):  # noqa: N802
        try:
            found = find_backend()
        except RelevoError as error:
            return False, str(error)
        return (True, "") if found else (False, NOT_FOUND)

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        watch = FeedbackWatch(feedback)
        try:
            backend = find_backend()
            if backend is None:
                raise RelevoError(NOT_FOUND)
            watch.info(backend.description())
            return self.compute(backend, parameters, context, feedback, watch)
        except Cancelled:
            return {}
        except (RelevoError, OSError) as error:
            raise QgsProcessingException(str(error)) from error

    def compute(self, backend, parameters, context, feedback, watch):
        """Computes the outputs. Raises RelevoError and Cancelled."""
        raise NotImplementedError

    def add_dem(self) -> None:
        self.addParameter(QgsProcessingParameterRasterLayer(self.DEM, "Elevation raster"))
        self.add_advanced(QgsProcessingParameterBand(self.BAND, "Band with the heights", None, self.DEM, True))
        self.add_advanced(
            QgsProcessingParameterEnum(
                self.UNIT, "Unit of the heights", _UNITS, defaultValue=_UNITS[0], usesStaticStrings=True
            )
        )

        self.add_text(self.OPTIONS, "More options of the program (--nodata 0 --highest 3000)", advanced=True)

    def add_surroundings(self) -> None:
        self.addParameter(
            QgsProcessingParameterRasterLayer(
                self.SURROUNDINGS, "Wider, coarser elevation raster around it: its ground shades, too", optional=True
            )
        )

    def dem(self, parameters, context) -> Dem:
        layer = self.parameterAsRasterLayer(parameters, self.DEM, context)
        if layer is None or not layer.isValid():
            raise QgsProcessingException(self.invalidRasterError(parameters, self.DEM))
        unit = self.parameterAsEnumString(parameters, self.UNIT, context)
        band = None if parameters.get(self.BAND) is None else self.parameterAsInt(parameters, self.BAND, context)
        wider = None
        if parameters.get(self.SURROUNDINGS):
            wider = self.parameterAsRasterLayer(parameters, self.SURROUNDINGS, context)
            if wider is None or not wider.isValid():
                raise QgsProcessingException(self.invalidRasterError(parameters, self.SURROUNDINGS))
        options = self.text(parameters, self.OPTIONS, context)
        return dem_of(layer, band, None if unit == _UNITS[0] else unit, options, wider)

    def add_time(self, optional: bool) -> None:
        self.addParameter(
            QgsProcessingParameterDateTime(
                self.TIME, "Date and time in the time zone", QgsProcessingParameterDateTime.DateTime, optional=optional
            )
        )
        self.add_text(self.EVENT, "Event of that day instead of the time (sunrise, sunset-30min, noon)")
        self.add_zone()

    def add_zone(self) -> None:
        self.add_text(self.ZONE, "Time zone (Europe/Zurich, +01:00, solar; empty: that of the place)")

    def when(self, parameters, context) -> Optional[Options]:
        time = parameters.get(self.TIME)
        if not isinstance(time, str):
            time = self.parameterAsDateTime(parameters, self.TIME, context)
        return when_of(time, self.text(parameters, self.EVENT, context), self.text(parameters, self.ZONE, context))

    def zone(self, parameters, context, watch: Watch) -> Optional[str]:
        """The time zone that was asked for, said in the log. Relevo itself says which one it chooses."""
        zone = self.text(parameters, self.ZONE, context)
        if zone:
            watch.info(f"time zone {zone}")
        return zone or None

    def add_advanced(self, parameter: QgsProcessingParameterDefinition) -> None:
        parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        self.addParameter(parameter)

    def add_text(self, name: str, description: str, advanced: bool = False) -> None:
        parameter = QgsProcessingParameterString(name, description, optional=True)
        self.add_advanced(parameter) if advanced else self.addParameter(parameter)

    def text(self, parameters, name, context) -> str:
        return self.parameterAsString(parameters, name, context).strip()

    def words(self, parameters, name, context) -> List[str]:
        """Words between commas."""
        return [word.strip() for word in self.text(parameters, name, context).split(",") if word.strip()]

    def number(self, parameters, name, context) -> Optional[float]:
        """An optional number."""
        if parameters.get(name) is None:
            return None
        return self.parameterAsDouble(parameters, name, context)
