"""Rasters that are made again from what they say of themselves."""

from __future__ import annotations

import json
import os
import pathlib
from typing import TYPE_CHECKING, Any, Optional, Union

from ._dem import Dem, open
from ._errors import BadInput
from ._raster import Raster
from ._sun_over_dem import shadow_options, time_names

if TYPE_CHECKING:
    import xarray

_FIGURES = ("horizons", "shadow", "sky_view", "sun_hours")
_DEM_OPTIONS = ("band", "bounds", "crop", "crs", "encoding", "holes", "memory_mib", "nodata", "surroundings", "unit")


def again(
    raster: Union[Raster, str, os.PathLike[str], xarray.DataArray], *, dem: Optional[Dem] = None, trust: bool = False
) -> Raster:
    """Makes a raster again from what it says of itself, the same to the bit with one version of Relevo.

    raster: a Raster, its DataArray, or the name of a GeoTIFF that `Raster.save()` wrote
    dem: the DEM to take, whichever the raster names. None: the files that it names: of a Raster where they are; of
        others beside the file that the raster is read from, else in the working folder, because names in files could
        be any.
    trust: take the files that a DataArray or a GeoTIFF names where they are, too

    Raises BadInput for what is no raster of a figure, for a file that is missing, and without `dem` where the heights
    are not those that the raster was made of.
    """
    about, alone, folder = _described(raster)
    figure, options = about.get("figure"), _object(about, "options")
    if figure not in _FIGURES or not all(isinstance(name, str) for name in options.get("bands", [])):
        raise BadInput("raster: does not say by which figure of relevo it was made")
    if dem is not None:
        return _made(dem, figure, options, alone)
    files = _files(about, None if trust else folder)
    how = _object(about, "dem_options")
    if "surroundings" in how:
        how["surroundings"] = _beside(how["surroundings"], None if trust else folder)
    with open(files, **_keywords(how, *_DEM_OPTIONS)) as opened:
        if opened.provenance()["dem_sha256"] != about.get("dem_sha256"):
            raise BadInput(f"dem: heights of {files[0]} are not those that the raster was made of; dem= takes others")
        return _made(opened, figure, options, alone)


def _made(dem: Dem, figure: str, options: dict[str, Any], alone: bool) -> Raster:
    if figure != "horizons":
        names = time_names(shadow_options(options)["times"]) if "times" in options else options.get("bands", [figure])
        return dem.sun._raster(figure, names, alone, options, None)
    band = options.pop("bands", [])
    every = dem.sun.horizons(**_keywords(options, "directions", "terrestrial_refraction", "highest", "clip", "clip_crs"))
    if band and band[0] not in every.bands:
        raise BadInput(f"options: bands: expected one of {', '.join(every.bands)} but got {band[0]}")
    return every[band[0]] if band else every


def _keywords(options: dict[str, Any], *known: str) -> dict[str, Any]:
    if not set(known).issuperset(options):
        raise BadInput(f"options: expected some of {', '.join(known)}")
    return options


def _described(raster: Any) -> tuple[dict[str, Any], bool, Optional[pathlib.Path]]:
    """What a raster says, whether it has one band alone, and the folder of its file; no folder: its names are ours."""
    if isinstance(raster, Raster):
        return raster.about, raster.values.ndim == 2, None
    if isinstance(raster, (str, os.PathLike)):
        import rasterio

        try:
            with rasterio.open(raster) as file:
                tags, count = file.tags(), file.count
        except rasterio.errors.RasterioIOError as error:
            raise BadInput(f"raster: {error}") from None
        about = {key[7:].lower(): text for key, text in tags.items() if key.startswith("RELEVO_")}
        return about, count == 1, pathlib.Path(raster).absolute().parent
    if not hasattr(raster, "attrs") or not hasattr(raster, "encoding"):
        raise BadInput(f"raster: expected a Raster, a DataArray or a file but got {type(raster).__name__}")
    source = pathlib.Path(raster.encoding.get("source", "DataArray")).absolute()
    return dict(raster.attrs), raster.ndim == 2, source.parent


def _object(about: dict[str, Any], key: str) -> dict[str, Any]:
    try:
        found = json.loads(about[key])
    except (KeyError, TypeError, ValueError):
        found = None
    if not isinstance(found, dict):
        raise BadInput(f"raster: does not say how it was made: {key} is missing or no JSON object")
    return found


def _files(about: dict[str, Any], folder: Optional[pathlib.Path]) -> list[str]:
    """Of the DEM. folder: where they have to lie"""
    try:
        named = json.loads(about["dem_files"])
    except (KeyError, TypeError, ValueError):
        named = None
    if named == []:
        raise BadInput("raster: its DEM was an array; give dem=")
    return _beside(named, folder)


def _beside(named: Any, folder: Optional[pathlib.Path]) -> list[str]:
    """Files of these names in a folder; no folder: where they are."""
    if not isinstance(named, list) or not named or not all(isinstance(name, str) for name in named):
        raise BadInput("raster: does not say of which files its DEM is; give dem=")
    if folder is None:
        return named
    beside = [folder / os.path.basename(name) for name in named]
    for file, name in zip(beside, named):
        if not file.is_file():
            raise BadInput(f"dem: {file} is missing; put {name} there, or give dem= or trust=True")
    return [str(file) for file in beside]
