"""What the algorithms ask of Relevo, without QGIS. program.py and library.py answer it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union


class RelevoError(Exception):
    """Relevo refuses or fails. The text is its own sentence."""


class Cancelled(Exception):
    """The user has cancelled."""


Options = Dict[str, Any]  # arguments of the package relevo by their names; None is its default


@dataclass(frozen=True)
class Dem:
    """An elevation raster that GDAL opens."""

    file: str
    crs: Optional[str] = None  # "EPSG:32632" or WKT, instead of the file's
    band: Optional[int] = None  # from 1; None: Relevo chooses
    unit: Optional[str] = None  # of the heights, instead of the file's
    options: Sequence[str] = ()  # more words of the program's command line
    surroundings: Optional[str] = None  # the file of a wider DEM around it, whose ground shades, too


@dataclass(frozen=True)
class Picture:
    """A view to draw. Members that are None or empty are left to Relevo."""

    when: Optional[Options] = None  # time, date and zone
    size: Tuple[int, int] = (1280, 720)  # [px]
    is_map: bool = False  # seen from straight above, with a georeference
    resolution: Optional[float] = None  # of a map: the side of a pixel in the DEM's units, instead of the size
    side: Optional[str] = None  # where the camera is: "north" ... or "top"
    elevation_deg: Optional[float] = None
    zoom: Optional[float] = None
    exaggeration: Optional[float] = None
    preset: Optional[str] = None
    enable: Sequence[str] = ()
    disable: Sequence[str] = ()
    values: Dict[str, str] = field(default_factory=dict)  # "haze.density": "0.2"
    stamps: Sequence[str] = ()
    overlay: Optional[str] = None  # a raster on the ground


@dataclass(frozen=True)
class Direction:
    """The horizon in a direction."""

    azimuth_deg: float  # clockwise from true north
    horizon_deg: float  # apparent elevation
    distance_m: Optional[float]  # of the ground that makes it; None outside of the DEM


Bounds = Tuple[float, float, float, float]  # west, south, east, north in the DEM's CRS


class Watch:
    """Hears of work while it is done, and may end it. All functions are called on the thread that asked for the work."""

    def progress(self, share: float) -> None:
        """@param share  that is done, 0 to 1"""

    def is_cancelled(self) -> bool:
        return False

    def info(self, text: str) -> None:
        """What Relevo assumes, and its summary."""

    def warning(self, text: str) -> None:
        """The result may not be what the user expects."""


class Backend(ABC):
    """Relevo, one way or another. All functions raise RelevoError and Cancelled. A result replaces a file of its name."""

    @abstractmethod
    def description(self) -> str:
        """What runs, and its version."""

    @abstractmethod
    def raster(
        self, figure: str, dem: Dem, options: Options, bounds: Optional[Bounds], output: str, watch: Watch
    ) -> None:
        """A GeoTIFF of a figure, which is a function of `relevo.SunOverDem`."""

    @abstractmethod
    def horizons(
        self, dem: Dem, places: Sequence[Tuple[float, float]], eye_height_m: float, step_deg: float, watch: Watch
    ) -> List[Union[List[Direction], str]]:
        """For each place (latitude, longitude) its horizon from north, or why it has none."""

    @abstractmethod
    def capture(self, dem: Dem, picture: Picture, output: str, watch: Watch) -> None:
        """A picture in the format of the output's ending; a map as GeoTIFF."""

    @abstractmethod
    def carpet(
        self, dem: Dem, place: Tuple[float, float], year: int, zone: Optional[str], output: str, table: Optional[str],
        watch: Watch,
    ) -> None:  # fmt: skip
        """The direct sun of a year as PNG or SVG, and as CSV if `table` names a file."""
