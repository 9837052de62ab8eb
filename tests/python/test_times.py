"""Every call takes times by one rule: without a time zone they need tz=."""

import datetime
import zoneinfo

import numpy
import pandas
import pytest

import relevo
from conftest import BUNDLED

ZURICH = zoneinfo.ZoneInfo("Europe/Zurich")
NAIVE = (
    "2026-06-21T12:00",
    "2026-06-21 12:00:00",
    datetime.datetime(2026, 6, 21, 12),
    pandas.Timestamp("2026-06-21T12:00"),
)
ZONES = ("Europe/Zurich", "+02:00", ZURICH, datetime.timezone(datetime.timedelta(hours=2)))


@pytest.fixture
def dem():
    with relevo.open(BUNDLED, crop=(-84.3, 36.2, -84.27, 36.23)) as part:
        yield part


def position_at(dem):
    return lambda time, **more: relevo.sun.position(46.95, 7.44, time, **more).azimuth


def shadow_at(dem):
    return lambda time, **more: numpy.nansum(dem.sun.shadow(time, **more))


def view_at(dem):
    def at(time, **more):
        with dem.view(time, (16, 16), device="software", **more) as view:
            return view.scene["time"]["at"]

    return at


def set_at(dem):
    def at(time, **more):
        with dem.view("2026-06-21T00:00Z", (16, 16), device="software") as view:
            view.set(time, **more)
            return view.scene["time"]["at"]

    return at


def capture_at(dem):
    return lambda time, **more: dem.capture(time, (16, 16), device="software", **more).tolist()


CALLS = pytest.mark.parametrize("call", [position_at, shadow_at, view_at, set_at, capture_at])


@CALLS
def test_a_zone_is_needed(dem, call):
    at = call(dem)
    for time in NAIVE:
        with pytest.raises(relevo.BadInput, match="^time: 2026-06-21.12:00(:00)? has no time zone; give tz=, or "):
            at(time)
    expected = at("2026-06-21T10:00Z")
    assert at("2026-06-21T13:00Z") != expected
    for time in NAIVE if call in (position_at, shadow_at) else NAIVE[1:3]:
        for zone in ZONES:
            assert at(time, tz=zone) == expected, (time, zone)
    assert at(datetime.datetime(2026, 6, 21, 12, tzinfo=ZURICH)) == expected
    assert at(numpy.datetime64("2026-06-21T10:00")) == expected  # UTC


@CALLS
def test_what_is_no_time(dem, call):
    at = call(dem)
    for time in (pandas.NaT, numpy.datetime64("NaT"), float("nan"), numpy.float32("nan"), float("inf"), True):
        for more in ({}, {"tz": "UTC"}):
            with pytest.raises(relevo.BadInput, match="^time: "):
                at(time, **more)


def test_many_times():
    naive = [datetime.datetime(2026, 6, 21, 12), "2026-12-21T12:00"]
    found = relevo.sun.position(46.95, 7.44, naive, tz=ZURICH)
    expected = relevo.sun.position(46.95, 7.44, ["2026-06-21T10:00Z", "2026-12-21T11:00Z"])
    numpy.testing.assert_array_equal(found.azimuth, expected.azimuth)
    for bad in ([1782036000.0, float("nan")], [pandas.NaT, naive[0]]):
        with pytest.raises(relevo.BadInput, match="^time: "):
            relevo.sun.position(46.95, 7.44, bad, tz=ZURICH)


def test_clocks_that_are_put_back(dem):
    """The first of two times, in Python as in the library."""
    twice, zone = "2026-10-25T02:30", "Europe/Zurich"
    assert view_at(dem)(twice, tz=zone).startswith("2026-10-25T00:30")
    assert position_at(dem)(twice, tz=zone) == position_at(dem)("2026-10-25T00:30Z")


def test_zones_of_scenes(dem):
    scene = {"time": {"zone": ZURICH}}
    assert view_at(dem)("2026-06-21T12:00", scene=scene).startswith("2026-06-21T10:00")


def test_a_view_keeps_its_zone(dem):
    with dem.view("2026-06-21T12:00", (16, 16), tz=ZURICH, device="software") as view:
        view.set("2026-06-21T14:00")
        assert view.scene["time"]["at"].startswith("2026-06-21T12:00")


def test_the_zone_of_the_place(dem):
    assert view_at(dem)("2026-06-21T12:00", tz="auto") == view_at(dem)("2026-06-21T12:00", tz="America/New_York")


def test_events_need_no_zone(dem):
    assert view_at(dem)("sunset-30min", date="2026-06-21").startswith("2026-06-2")


def test_zones_of_days(dem):
    expected = dem.sun.hours("2026-06-21", tz="America/New_York").values
    found = dem.sun.hours("2026-06-21", tz=zoneinfo.ZoneInfo("America/New_York")).values
    numpy.testing.assert_array_equal(found, expected)
    assert relevo.sun.events(46.95, 7.44, "2026-06-21", ZURICH) == relevo.sun.events(46.95, 7.44, "2026-06-21")
    offset = datetime.timezone(datetime.timedelta(hours=-4))
    numpy.testing.assert_array_equal(dem.sun.hours("2026-06-21", tz=offset).values, expected)


@pytest.mark.parametrize("zone", ["Europe/Zurih", "+99:00", 2, datetime.date(2026, 6, 21)])
def test_what_is_no_zone(dem, zone):
    for call in (position_at, shadow_at):
        with pytest.raises(relevo.BadInput, match="^(time zone|tz): "):
            call(dem)("2026-06-21T12:00", tz=zone)


def test_dates():
    for date in (pandas.NaT, numpy.datetime64("NaT"), None, 3):
        with pytest.raises(relevo.BadInput, match="^date: "):
            relevo.sun.events(46.95, 7.44, date)
