"""Relevo as the Python package `relevo`, in the process of QGIS."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import tempfile
import threading
import warnings
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple, Union

from .backend import Backend, Bounds, Cancelled, Dem, Direction, Options, Picture, RelevoError, Watch

# The camera's azimuth as seen from the ground (core/scene/view.cpp).
_SIDES = {"north": 0, "north-east": 45, "east": 90, "south-east": 135, "south": 180, "south-west": 225, "west": 270,
          "north-west": 315}  # fmt: skip
_MASK_NODATA = 255
_DRIVERS = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG", ".webp": "WEBP", ".tif": "GTiff", ".tiff": "GTiff"}


def find() -> Optional[Backend]:
    """None if the package is not installed. Raises RelevoError if it cannot be loaded."""
    try:
        import relevo
    except ModuleNotFoundError as error:
        if error.name == "relevo":
            return None
        raise RelevoError(f"Python package relevo: {error}") from error
    except ImportError as error:
        raise RelevoError(f"Python package relevo: {error}") from error
    return Library(relevo)


class Library(Backend):
    def __init__(self, package: Any) -> None:
        self._relevo = package

    def description(self) -> str:
        return f"Python package relevo {self._relevo.__version__}"

    def raster(
        self, figure: str, dem: Dem, options: Options, bounds: Optional[Bounds], output: str, watch: Watch
    ) -> None:
        if bounds is not None:
            raise RelevoError("extent: needs the program relevo, which is not installed; leave it empty")
        if "zone" in options:
            options = {key: value for key, value in options.items() if key != "zone"} | {"tz": options["zone"] or "auto"}
        with self._opened(dem, watch) as opened:
            raster = getattr(opened.sun, figure)(**options, progress=_progress(watch))
        is_mask = figure == "shadow" and not options["soft"]
        _write_raster(raster, dem, is_mask, self._relevo.__version__, output)

    def horizons(
        self, dem: Dem, places: Sequence[Tuple[float, float]], eye_height_m: float, step_deg: float, watch: Watch
    ) -> List[Union[List[Direction], str]]:
        answers: List[Union[List[Direction], str]] = []
        with self._opened(dem, watch) as opened:
            for lat, lon in places:
                if watch.is_cancelled():
                    raise Cancelled()
                answers.append(self._horizon(opened, lat, lon, eye_height_m, step_deg))
                watch.progress(len(answers) / len(places))
        return answers

    def capture(self, dem: Dem, picture: Picture, output: str, watch: Watch) -> None:
        ending = os.path.splitext(output)[1].lower()
        if ending not in _DRIVERS:
            raise RelevoError(f"{output}: expected a name that ends in {', '.join(_DRIVERS)}")
        with self._opened(dem, watch) as opened, opened.view(scene=_scene_of(picture)) as view:
            if watch.is_cancelled():
                raise Cancelled()
            pixels = view.draw()
            place = (opened.bounds, opened.wkt) if picture.is_map else None
        if watch.is_cancelled():
            raise Cancelled()
        _write_picture(pixels, place, _DRIVERS[ending], output)

    def carpet(
        self, dem: Dem, place: Tuple[float, float], year: int, zone: Optional[str], output: str, table: Optional[str],
        watch: Watch,
    ) -> None:  # fmt: skip
        raise RelevoError("the direct sun of a year at a point: needs the program relevo, which is not installed")

    def _horizon(
        self, opened: Any, lat: float, lon: float, eye_height_m: float, step_deg: float
    ) -> Union[List[Direction], str]:
        try:
            horizon = opened.sun.horizon(lat, lon, eye_height=eye_height_m, step=step_deg)
        except self._relevo.BadInput as error:
            return str(error)
        rows = zip(horizon.azimuth.tolist(), horizon.elevation.tolist(), horizon.distance.tolist())
        # NaN, a distance outside of the DEM, is not equal to itself.
        return [Direction(azimuth, elevation, far if far == far else None) for azimuth, elevation, far in rows]

    @contextlib.contextmanager
    def _opened(self, dem: Dem, watch: Watch) -> Iterator[Any]:
        """The DEM; what the package says and raises goes where that of the program does."""
        if dem.options:
            raise RelevoError("options: need the program relevo, which is not installed; leave them empty")
        try:
            with _heard(watch, self._relevo.Warning):
                how = {"crs": dem.crs, "band": dem.band, "unit": dem.unit, "surroundings": dem.surroundings}
                with self._relevo.open(dem.file, **how) as opened:
                    yield opened
        except self._relevo.Cancelled as error:
            raise Cancelled() from error
        except self._relevo.Error as error:
            raise RelevoError(str(error)) from error


class _Handler(logging.Handler):
    """Records of this thread."""

    def __init__(self, watch: Watch) -> None:
        super().__init__(logging.INFO)
        self._watch = watch
        self._thread = threading.get_ident()

    def emit(self, record: logging.LogRecord) -> None:
        if record.thread == self._thread:
            self._watch.info(record.getMessage())


@contextlib.contextmanager
def _heard(watch: Watch, warning: type) -> Iterator[None]:
    """What the package logs and warns of goes to `watch`."""
    log = logging.getLogger("relevo")
    handler, level = _Handler(watch), log.level
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    try:
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always", warning)
            try:
                yield
            finally:
                for one in heard:
                    watch.warning(str(one.message))
    finally:
        log.removeHandler(handler)
        log.setLevel(level)


def _progress(watch: Watch) -> Any:
    def done(share: float) -> bool:
        watch.progress(share)
        return not watch.is_cancelled()

    return done


def _scene_of(picture: Picture) -> Dict[str, Any]:
    """A part of a scene (docs/scene.md)."""
    scene: Dict[str, Any] = {"picture": {"ortho": True} if picture.is_map else {}}
    if picture.resolution is not None:
        scene["picture"]["resolution"] = picture.resolution
    else:
        scene["picture"]["size"] = list(picture.size)
    if picture.when:
        scene["time"] = {key.replace("time", "at"): value for key, value in picture.when.items() if value}
    if picture.side or picture.elevation_deg is not None or picture.zoom is not None:
        scene["camera"] = _camera_of(picture)
    if picture.exaggeration is not None:
        scene["exaggeration"] = picture.exaggeration
    values = {address: _value_of(text) for address, text in picture.values.items()}
    effects = {"presets": [picture.preset] if picture.preset else [], "enable": list(picture.enable),
               "disable": list(picture.disable), "set": values}  # fmt: skip
    scene["effects"] = {key: value for key, value in effects.items() if value}
    if picture.stamps:
        scene["stamps"] = {"show": list(picture.stamps)}
    if picture.overlay:
        scene["overlay"] = {"file": picture.overlay}
    return scene


def _camera_of(picture: Picture) -> Dict[str, Any]:
    orbit = {"elevation": picture.elevation_deg, "zoom": picture.zoom}
    camera: Dict[str, Any] = {}
    if picture.side == "top":
        orbit.update(azimuth=180, elevation=90)
        camera["fov"] = 1
    elif picture.side:
        orbit["azimuth"] = _SIDES[picture.side]
    return {**camera, "orbit": {key: value for key, value in orbit.items() if value is not None}}


def _value_of(text: str) -> Any:
    """A number, true or false of JSON, or a text."""
    try:
        return json.loads(text)
    except ValueError:
        return text


def _write_raster(raster: Any, dem: Dem, is_mask: bool, version: str, output: str) -> None:
    """A GeoTIFF as the program writes it; of the metadata those that the package has."""
    import numpy
    from osgeo import gdal

    values = raster.values if raster.values.ndim == 3 else raster.values[numpy.newaxis]
    if is_mask:
        values = numpy.where(numpy.isnan(values), _MASK_NODATA, values > 0).astype(numpy.uint8)
    kind = gdal.GDT_Byte if is_mask else gdal.GDT_Float32
    image = gdal.GetDriverByName("MEM").Create("", values.shape[2], values.shape[1], values.shape[0], kind)
    image.SetProjection(raster.wkt)
    image.SetGeoTransform(raster.transform.to_gdal())
    about = {"DEFINITION": raster.about.get("definition"), "HOLES": raster.about.get("holes"),
             "BEYOND_DEM": raster.about.get("beyond"), "DEM": dem.file,
             "TIFFTAG_SOFTWARE": f"Relevo {version}"}  # fmt: skip
    image.SetMetadata({key: str(value) for key, value in about.items() if value is not None})
    for number, (name, unit) in enumerate(zip(raster.names, raster.units), 1):
        band = image.GetRasterBand(number)
        band.SetDescription(name)
        band.SetUnitType(unit)
        band.SetNoDataValue(_MASK_NODATA if is_mask else float("nan"))
        band.WriteArray(values[number - 1])
    overviews = "NEAREST" if is_mask else "AVERAGE"
    options = ["COMPRESS=DEFLATE", "PREDICTOR=YES", f"OVERVIEW_RESAMPLING={overviews}"]
    _replace(image, "COG", options, output)


def _write_picture(pixels: Any, place: Optional[Tuple[Bounds, str]], driver: str, output: str) -> None:
    """@param place  of a map: (left, bottom, right, top) and the CRS"""
    from osgeo import gdal

    rows, columns = pixels.shape[:2]
    bands = 4 if pixels[..., 3].min() < 255 and driver != "JPEG" else 3
    image = gdal.GetDriverByName("MEM").Create("", columns, rows, bands, gdal.GDT_Byte)
    for number in range(bands):
        image.GetRasterBand(number + 1).SetColorInterpretation(gdal.GCI_RedBand + number)
        image.GetRasterBand(number + 1).WriteArray(pixels[..., number])
    if place:
        (left, bottom, right, top), wkt = place
        image.SetGeoTransform((left, (right - left) / columns, 0, top, 0, (bottom - top) / rows))
        image.SetProjection(wkt)
    _replace(image, driver, ["QUALITY=95"] if driver in ("JPEG", "WEBP") else [], output)


def _replace(image: Any, driver: str, options: List[str], output: str) -> None:
    """Writes an image under its name only when it is complete."""
    from osgeo import gdal

    with tempfile.TemporaryDirectory(prefix=".relevo-", dir=os.path.dirname(os.path.abspath(output))) as folder:
        part = os.path.join(folder, os.path.basename(output))
        gdal.ErrorReset()
        try:
            copy = gdal.GetDriverByName(driver).CreateCopy(part, image, options=options)
            is_made = copy is not None
            del copy  # writes what is left
        except RuntimeError as error:  # where somebody has had GDAL raise its errors
            raise RelevoError(f"{output}: cannot be written: {error}") from error
        if not is_made or gdal.GetLastErrorType() >= gdal.CE_Failure:
            raise RelevoError(f"{output}: cannot be written: {gdal.GetLastErrorMsg()}")
        for name in os.listdir(folder):
            os.replace(os.path.join(folder, name), os.path.join(os.path.dirname(os.path.abspath(output)), name))
