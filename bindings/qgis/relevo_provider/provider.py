"""The provider, its algorithms and its setting."""

from __future__ import annotations

import os

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import QgsApplication, QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .algorithm import PROGRAM_SETTING
from .horizon import HorizonAtPoints
from .pictures import Capture, Carpet, Map
from .rasters import Shadow, SkyView, SunHours

_ALGORITHMS = (Shadow, SunHours, SkyView, HorizonAtPoints, Capture, Map, Carpet)


class RelevoProvider(QgsProcessingProvider):
    def id(self):
        return "relevo"

    def name(self):
        return "Relevo"

    def longName(self):  # noqa: N802
        return "Relevo: terrain and sun"

    def icon(self):
        return QIcon(self.svgIconPath())

    def svgIconPath(self):  # noqa: N802
        return os.path.join(os.path.dirname(__file__), "icon.svg")

    def load(self):
        ProcessingConfig.settingIcons[self.name()] = self.icon()
        ProcessingConfig.addSetting(
            Setting(self.name(), PROGRAM_SETTING, "Program relevo (empty: the one on PATH)", "", valuetype=Setting.FILE)
        )
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self):
        ProcessingConfig.removeSetting(PROGRAM_SETTING)

    def loadAlgorithms(self):  # noqa: N802
        for algorithm in _ALGORITHMS:
            self.addAlgorithm(algorithm())

    def supportedOutputRasterLayerExtensions(self):  # noqa: N802
        return ["tif", "tiff"]


class Plugin:
    """What QGIS loads: brings the provider and takes it away again."""

    def __init__(self):
        self._provider = None

    def initProcessing(self):  # noqa: N802
        self._provider = RelevoProvider()
        QgsApplication.processingRegistry().addProvider(self._provider)

    def initGui(self):  # noqa: N802
        self.initProcessing()

    def unload(self):
        QgsApplication.processingRegistry().removeProvider(self._provider)
