"""Messages of the library in the words of Python: names of arguments instead of options of the command line."""

from __future__ import annotations

import re
from typing import Final

_PHRASES: Final = (
    (re.compile(r"/vsimem/relevo/\d+/heights\.tif"), "heights"),  # the name that heights of memory have for GDAL
    (re.compile(r"^relevo_\w+: "), ""),  # functions and their texts of options
    (re.compile(r"^(heights\.)?options:(\d+:)? ?"), ""),
    (re.compile(r"^dem: \(text\):1: "), ""),
    (re.compile(r"\(text\):1: "), ""),
    (re.compile(r"^scene: picture\.size: "), "size: "),
    (re.compile(r"^scene: time\.at: "), "time: "),
    (re.compile(r"^scene: (time\.)?(date|camera|exaggeration)(?=[.:])"), r"\2"),
    (re.compile(r"^scene: (time\.)?zone(?=[.:])|^zone(?=:)"), "tz"),
    (re.compile(r"^place: "), "lat and lon: "),
    (re.compile(r"^time zone: "), "tz: "),
    (re.compile(r"^-o: "), "folder: "),
    (re.compile(r"^sun along: the walk: line "), "walk: point "),
    (re.compile(r"^sun along: "), "walk: "),
    (re.compile(r"--start 2026-06-21T09:00 --speed 4"), 'start="2026-06-21T09:00Z" and speed=4'),
    (re.compile(r"^from: "), "start: "),
    (re.compile(r"\ba height in --at\b"), "height="),
    (re.compile(r"\bdate, from and to, or year\b"), "date, start and end, or year"),
    (re.compile(r"name it on the command line, or add --trust"), "open it with the program, which asks"),
    (re.compile(r", or --trust for all"), ""),
    (re.compile(r"write (\S+)Z for UTC or \S+\+02:00, or pass --tz Europe/Zurich"),
     r'write \1Z for UTC or \1+02:00, or give tz="Europe/Zurich"'),
)

_ARGUMENTS: Final = {
    "at": "lat and lon",
    "memory": "memory_mib",
    "overlay": "overlay.file",
    "points": "lat and lon",
    "exaggerate": "exaggeration",
    "from": "start",
    "to": "end",
}

# Members of scenes, as scene= takes them.
_MEMBERS: Final = {
    "attribution": "stamps.attribution",
    "backdrop": "camera.backdrop",
    "disable": "effects.disable",
    "dpi": "picture.dpi",
    "enable": "effects.enable",
    "ev100": "picture.ev100",
    "exposure": "picture.exposure",
    "eye": "camera.eye",
    "eye-distance": "camera.eye_distance",
    "focal-length": "camera.focal_length",
    "fov": "camera.fov",
    "hfov": "camera.hfov",
    "land-cover": "land_cover",
    "land-cover-classes": "land_cover_classes",
    "look-at": "camera.target",
    "map-scale": "picture.map_scale",
    "margin": "stamps.margin",
    "no-legend": "stamps.legend",
    "only": "effects.only",
    "ortho": "picture.ortho",
    "panorama": "camera.panorama",
    "pixel-error": "picture.pixel_error",
    "plugin-path": "effects.plugin_path",
    "preset": "effects.presets",
    "resolution": "picture.resolution",
    "samples": "picture.samples",
    "seconds": "picture.seconds",
    "set": "effects.set",
    "sheet": "picture.sheet",
    "station-height": "station_height",
    "stereo": "camera.stereo",
    "surface": "surface",
    "title": "stamps.title",
    "transparent": "picture.transparent",
    "view": "camera.orbit",
    "weather": "weather",
}

_VALUE: Final = r"\d+-\d+-\d+|-?[\d.]+|V|none|us-ft|ft|m|[cdk]m|mm|terrarium|terrain-rgb|[A-Z]+:\w+"
_OPTION: Final = re.compile(rf"--([a-z][a-z0-9-]*)(: |:$)?(?: ({_VALUE})(?=[\s;,)]|$))?")


def _word_of(found: re.Match[str]) -> str:
    option, colon, value = found.group(1), found.group(2) or "", found.group(3)
    member = _MEMBERS.get(option)
    if member is None and option.startswith("overlay-"):
        member = "overlay." + option[len("overlay-") :].replace("-", "_")
    if member is not None:
        path = "".join(f'["{key}"]' for key in member.split("."))
        return f"scene{path}{colon}" + (f" {value}" if value else "")
    name = _ARGUMENTS.get(option, option.replace("-", "_"))
    if colon or " " in name or "." in name:
        return name + colon + (f" {value}" if value else "")
    if value is None:
        return name + "="
    return f"{name}={value}" if re.fullmatch(r"-?[\d.]+|V", value) else f'{name}="{value}"'


def python_words(text: str) -> str:
    """A message of the library that names Python's arguments and members of scenes."""
    for phrase, words in _PHRASES:
        text = phrase.sub(words, text)
    return _OPTION.sub(_word_of, text)
