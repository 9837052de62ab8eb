"""The package has what the commands have: arguments, types, ranges and defaults. A command or an option without a row here
fails, as does a signature with Any, * or **."""

import inspect
import os
import re
import subprocess

import pytest

import relevo
import relevo.xarray
from test_wrong_calls import CALLS, small  # noqa: F401, a fixture

FUNCTIONS = {
    "sun position": relevo.sun.position, "sun day": relevo.SunOverDem.day, "sun horizon": relevo.SunOverDem.horizon,
    "sun eclipses": relevo.SunOverDem.eclipses, "sun carpet": relevo.SunOverDem.carpet, "sun when": relevo.SunOverDem.when,
    "sun shadow": relevo.SunOverDem.shadow, "sun hours": relevo.SunOverDem.hours, "sun sky-view": relevo.SunOverDem.sky_view,
    "sun horizons": relevo.SunOverDem.horizons, "moon position": relevo.moon.position, "moon day": relevo.MoonOverDem.day,
    "moon horizon": relevo.MoonOverDem.horizon, "moon when": relevo.MoonOverDem.when, "sun along": relevo.SunOverDem.along,
}  # fmt: skip
STAY_COMMANDS = {"sun plane"}
# Options of other names, and those that are no argument: files, tables, drawings, and what Python has otherwise.
NAMES = {"from": ["start"], "to": ["end"], "at": ["lat", "lon"]}
OTHERWISE = {
    "help", "help-all", "output", "overwrite", "scale", "csv", "json", "name", "points", "points-crs", "co", "format",
    "at-crs", "no-refraction", "tiles", "halo", "shard", "resume", "dry-run", "no-cache", "DEM",
}  # fmt: skip
OF_COMMAND = {
    "sun position": {"time", "date"},  # times, and no events
    "sun shadow": {"at"},
    "sun along": {"by"},  # rows of a table
    # Of the panorama alone.
    "sun horizon": {"date", "from", "to", "year", "tz", "refraction", "limb", "dip", "highest"},
    "moon horizon": {"date", "from", "to", "year", "tz", "refraction", "limb", "dip", "highest"},
    "moon position": {"time", "date"},
}
ONLY_PYTHON = {"self", "progress", "times", "azimuth", "height", "lat", "lon", "walk"}
OF_OPEN = {"source", "transform", "memory_mib", "holes"}


def help_of(*verbs):
    return subprocess.run([os.environ["RELEVO_PROGRAM"], *verbs, "--help"], capture_output=True, text=True, check=True).stdout


def options_of(command):
    """{name: (type, help)} of options of the verb, and of the DEM."""
    groups, lines = {"verb": {}, "DEM": {}}, []
    group = "verb"
    for line in help_of(*command.split()).splitlines():
        if re.fullmatch(r"\w+:", line):
            group = "DEM" if line == "DEM:" else "verb"
        elif found := re.match(r"  (?:-\w,)?--([\w-]+) ?(?:(\S.*?)(?:  |$))?\s*(.*)", line):
            lines = groups[group][found[1]] = [found[2] or "", found[3]]
        elif line.startswith(" " * 10) and lines:
            lines[1] += line.strip()
    return groups["verb"], groups["DEM"]


@pytest.fixture(scope="module", params=FUNCTIONS)
def command(request):
    return request.param, FUNCTIONS[request.param], *options_of(request.param)


def test_every_command_has_a_row():
    for body in ("sun", "moon"):
        verbs = re.findall(r"^  ([a-z][\w-]*) {2,}", help_of(body).split("Subcommands:")[1], re.MULTILINE)
        assert len(verbs) >= 3
        assert {f"{body} {verb}" for verb in verbs} <= {*FUNCTIONS, *STAY_COMMANDS}


def names_of(option):
    return NAMES.get(option, [option.replace("-", "_")])


def test_arguments(command):
    name, function, verb, _ = command
    parameters = inspect.signature(function).parameters
    wanted = [option for option in verb if option not in OTHERWISE | OF_COMMAND.get(name, set())]
    assert wanted
    for option in wanted:
        assert set(names_of(option)) <= set(parameters), option
    known = {one for option in verb for one in names_of(option)} | ONLY_PYTHON
    assert set(parameters) <= known


def test_types(command):
    name, function, verb, _ = command
    parameters = inspect.signature(function).parameters
    for option, (kind, _) in verb.items():
        for argument in names_of(option):
            if argument in parameters and option not in OTHERWISE:
                found = str(parameters[argument].annotation)
                expected = "float" if kind.startswith("FLOAT") else "int" if kind.startswith("INT") else "bool" if not kind else ""
                assert re.search(rf"\b{expected}\b|ArrayLike", found) if expected else True, (option, found)


def test_defaults(command):
    """Those that the command's help ends with are in the docstrings, or the argument's own."""
    name, function, verb, _ = command
    holder = getattr(relevo, function.__qualname__.split(".")[0], None)
    text = (inspect.getdoc(function) or "") + (inspect.getdoc(holder) or "") + (inspect.getdoc(relevo.SunOverDem.__base__.__base__) or "")
    for option, (kind, said) in verb.items():
        default = re.search(r"\((-?[\d.]+)\)$", said)
        for argument in names_of(option):
            if default and argument in inspect.signature(function).parameters:
                own = inspect.signature(function).parameters[argument].default
                assert own == float(default[1]) or f"({default[1]})" in text, option


@pytest.mark.filterwarnings("ignore::relevo.Warning")
def test_ranges(command, small):  # noqa: F811
    """What the command takes, the package takes: both ends, and nothing beyond them."""
    name, function, verb, _ = command
    of_dem, place = f"Dem.{name.replace(' ', '.').replace('-', '_')}", name.replace(" ", ".")
    make, right = CALLS.get(of_dem) or CALLS[place]
    call = make(small) if of_dem in CALLS else make
    for option, (kind, _) in verb.items():
        found = re.fullmatch(r"(FLOAT|INT):(\S+) to (\S+)", kind)
        (argument,) = names_of(option) if found else [None]
        if not found or argument not in inspect.signature(call).parameters:
            continue
        if option == "step":  # of the horizon's azimuth, which Python bounds otherwise
            continue
        low, high = float(found[2]), float(found[3])
        for beyond in (low - 0.01 * max(1, abs(low)), high + 0.01 * max(1, abs(high))):
            with pytest.raises(relevo.BadInput, match=rf"\b{argument}\b"):
                call(**{**right, argument: round(beyond - 1) if found[1] == "INT" and beyond < low else beyond})
        for end in (low, high) if high < 1000 else (low,):
            try:
                call(**{**right, argument: int(end) if found[1] == "INT" else end})
            except relevo.BadInput as error:
                assert not str(error).startswith(f"{argument}: expected a number"), error


def test_open_has_the_options_of_dems():
    _, dem = options_of("sun hours")
    wanted = {names_of(option)[0] for option in dem} - {"no_cache", "memory"}
    assert len(wanted) >= 7
    assert set(inspect.signature(relevo.open).parameters) == wanted | OF_OPEN


def public_functions():
    for name in [*relevo.__all__, "xarray"]:
        holder = getattr(relevo, name)
        if inspect.isfunction(holder):
            yield name, holder
        elif inspect.isclass(holder) or inspect.ismodule(holder):
            names = getattr(holder, "__all__", None) or [one for one in vars(holder) if not one.startswith("_") or one == "__init__"]
            for member in names:
                value = inspect.getattr_static(holder, member)
                value = value.fget if isinstance(value, property) else value
                if inspect.isclass(value) and value.__module__.startswith("relevo"):
                    yield from ((f"{name}.{member}.{key}", one) for key, one in vars(value).items() if inspect.isfunction(one) and key[0] != "_")
                elif inspect.isfunction(value) or inspect.ismethod(value):
                    yield f"{name}.{member}", value


def test_no_signature_has_any():
    seen = dict(public_functions())
    assert {"open", "Dem.capture", "sun.day", "moon.position", "Raster.save", "xarray.Accessor.hours"} <= set(seen)
    assert len(seen) > 50
    for name, function in seen.items():
        if name in ("xarray.annotations", "Error.__init__") or function.__module__.split(".")[0] != "relevo":
            continue
        signature = inspect.signature(function)
        assert "Any" not in re.findall(r"\w+", str(signature.return_annotation)), name
        for one in signature.parameters.values():
            assert one.kind not in (one.VAR_KEYWORD, one.VAR_POSITIONAL), name
            assert "Any" not in re.findall(r"\w+", str(one.annotation)), (name, one)
    for holder in (relevo.sun.Position, relevo.sun.Event, relevo.moon.Position, relevo.Horizon, relevo.Layers):
        assert "Any" not in re.findall(r"\w+", str(holder.__annotations__)), holder
