"""Relevo: any DEM under the sun of a date.

    import relevo

    dem = relevo.open("alps.tif")
    picture = dem.capture(time="2026-06-21T22:30Z", size=(1280, 720))
    hours = dem.sun.hours("2026-06-21")

Units are metres, degrees and hours; azimuths are clockwise from true north; places are WGS 84, east positive.
"""

from __future__ import annotations

import sys

from . import moon, sun
from ._again import again
from ._dem import Dem, open
from ._errors import BadCall, BadInput, Cancelled, Error, NoDevice, OutOfMemory, Warning
from ._raster import Raster
from ._relevo import version as _version
from ._sun_over_dem import Horizon, MoonOverDem, SunOverDem
from ._transform import Transform
from ._view import Layers, View

__all__ = [
    "BadCall",
    "BadInput",
    "Cancelled",
    "Dem",
    "Error",
    "Horizon",
    "Layers",
    "MoonOverDem",
    "NoDevice",
    "OutOfMemory",
    "Raster",
    "SunOverDem",
    "Transform",
    "View",
    "Warning",
    "again",
    "moon",
    "open",
    "sun",
]

__version__ = _version()

if "xarray" in sys.modules:
    from . import xarray as _xarray  # noqa: F401, the accessor
