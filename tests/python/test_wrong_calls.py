"""Wrong calls, made from the types of all arguments: each is an error that names an argument, in Python's words."""

import inspect
import re

import numpy
import pytest

import relevo

PLACE = {"lat": 47.0, "lon": 9.0}
DAY = {"date": "2026-06-21"}
# What makes each call right, but for the argument that is wrong.
CALLS = {
    "sun.position": (relevo.sun.position, {**PLACE, "times": "2026-06-21T12:00Z"}),
    "sun.events": (relevo.sun.events, {**PLACE, **DAY}),
    "sun.day": (relevo.sun.day, {**PLACE, **DAY}),
    "sun.eclipses": (relevo.sun.eclipses, {**PLACE, **DAY}),
    "moon.position": (relevo.moon.position, {**PLACE, "times": "2026-06-21T12:00Z"}),
    "moon.day": (relevo.moon.day, {**PLACE, **DAY}),
    "Dem.sun.day": (lambda dem: dem.sun.day, {**PLACE, **DAY}),
    "Dem.sun.eclipses": (lambda dem: dem.sun.eclipses, {**PLACE, **DAY}),
    "Dem.sun.carpet": (lambda dem: dem.sun.carpet, {**PLACE, "year": 2026, "step": 3600}),
    "Dem.sun.when": (lambda dem: dem.sun.when, {**PLACE, **DAY, "over": (47.0002, 9.0002)}),
    "Dem.sun.horizon": (lambda dem: dem.sun.horizon, {**PLACE, "step": 90.0}),
    "Dem.sun.along": (lambda dem: dem.sun.along, {"walk": [[47.0, 9.0], [47.0002, 9.0002]], "start": "2026-06-21T12:00Z", "speed": 4}),
    "Dem.moon.day": (lambda dem: dem.moon.day, {**PLACE, **DAY}),
    "Dem.moon.when": (lambda dem: dem.moon.when, {**PLACE, **DAY, "over": (47.0002, 9.0002)}),
    "Dem.moon.horizon": (lambda dem: dem.moon.horizon, {**PLACE, "step": 90.0}),
    "Dem.sun.hours": (lambda dem: dem.sun.hours, {**DAY, "bands": ["hours", "global"]}),
    "Dem.sun.shadow": (lambda dem: dem.sun.shadow, {"time": "2026-06-21T12:00Z"}),
    "Dem.sun.sky_view": (lambda dem: dem.sun.sky_view, {"directions": 8}),
    "Dem.sun.horizons": (lambda dem: dem.sun.horizons, {"directions": 8}),
    "Dem.sun.estimate": (lambda dem: dem.sun.estimate, {"figure": "hours", **DAY}),
}
# Other names than the argument's, by which errors may name it.
ALSO = {"times": "time", "azimuth": "azimuth_deg"}


def wrong_values(name, annotation):
    """Values that an argument of this type never takes."""
    yield object()
    if name in ("progress", "bands", "name"):
        return
    if re.search(r"\bfloat\b|ArrayLike", annotation):
        yield from ("x", float("nan"), *([1e300] if name != "azimuth" else []))
    elif re.search(r"\bint\b", annotation):
        yield from ("x", 1.5, 10**9)
    elif re.search(r"\bbool\b", annotation):
        yield "yes"
    elif re.search(r"Date|Time|Zone|\bstr\b", annotation):
        yield from ("no such", -1e15)


def wrong_calls():
    for name, (make, right) in CALLS.items():
        call = make if "Dem" not in name else getattr(getattr(relevo, f"{name.split('.')[1].title()}OverDem"), name.split(".")[-1])
        for parameter in inspect.signature(call).parameters.values():
            if parameter.name != "self":
                for wrong in wrong_values(parameter.name, str(parameter.annotation)):
                    yield name, parameter.name, wrong


ALL = list(wrong_calls())


@pytest.fixture(scope="module")
def small():
    heights = numpy.add.outer(numpy.arange(12.0), numpy.arange(12.0)) * 3 + 500
    with relevo.open(heights, transform=(0.0005, 0, 8.997, 0, -0.0005, 47.003), crs="EPSG:4326") as dem:
        yield dem


def test_there_are_enough():
    assert len(ALL) > 200


@pytest.mark.parametrize("name", CALLS)
@pytest.mark.filterwarnings("ignore::relevo.Warning")
def test_right_calls(small, name):
    make, right = CALLS[name]
    (make(small) if "Dem" in name else make)(**right)


@pytest.mark.parametrize("name, argument, wrong", ALL, ids=[f"{i}-{a}.{b}" for i, (a, b, _) in enumerate(ALL)])
@pytest.mark.filterwarnings("ignore::relevo.Warning")
def test_wrong_call(small, name, argument, wrong):
    make, right = CALLS[name]
    call = make(small) if "Dem" in name else make
    with pytest.raises((relevo.BadCall, relevo.BadInput, TypeError)) as raised:
        call(**{**right, argument: wrong})
    text = str(raised.value)
    names = [*inspect.signature(call).parameters, *(ALSO[name] for name in inspect.signature(call).parameters if name in ALSO)]
    assert any(re.search(rf"\b{one}\b", text) for one in names), text
    assert not re.search(r"--|relevo_|options:", text), text
