"""The sun at a place is the program's."""

import datetime
import json
import zoneinfo

import numpy
import pandas
import pytest

import relevo

PLACE = (46.95, 7.44)


def told(program, time):
    return json.loads(program("sun", "position", "--at", "46.95,7.44,540", "--json", "--time", time))


def test_position(program):
    sun = relevo.sun.position(*PLACE, "2026-06-21T12:00+02:00", height=540)
    expected = told(program, "2026-06-21T12:00+02:00")
    assert sun.azimuth == pytest.approx(expected["azimuth_deg"], abs=1e-6)
    assert sun.elevation == pytest.approx(expected["elevation_deg"], abs=1e-6)
    assert sun.apparent == pytest.approx(expected["apparent_elevation_deg"], abs=1e-6)
    assert isinstance(sun.azimuth, float)


def test_forms_of_a_time():
    zurich = zoneinfo.ZoneInfo("Europe/Zurich")
    noon = datetime.datetime(2026, 6, 21, 12, tzinfo=zurich)
    expected = relevo.sun.position(*PLACE, 1782036000)
    for time in (
        noon,
        pandas.Timestamp(noon),
        numpy.datetime64("2026-06-21T10:00"),
        numpy.datetime64("2026-06-21T10:00:00.000000000"),
        "2026-06-21T10:00Z",
        "2026-06-21T12:00+02:00",
        1782036000.0,
        numpy.int64(1782036000),
    ):
        assert relevo.sun.position(*PLACE, time) == expected, time
    for times in (
        [noon, noon],
        ["2026-06-21T10:00Z"] * 2,
        pandas.DatetimeIndex([noon, noon]),
        pandas.Series([noon, noon]),
        numpy.array(["2026-06-21T10:00", "2026-06-21T10:00"], "datetime64[ns]"),
        [1782036000, 1782036000.0],
    ):
        assert relevo.sun.position(*PLACE, times).azimuth.tolist() == [expected.azimuth] * 2, times


def test_shapes():
    times = numpy.datetime64("2026-06-21T00:00") + numpy.arange(24).reshape(4, 6) * numpy.timedelta64(1, "h")
    sun = relevo.sun.position(*PLACE, times)
    assert sun.azimuth.shape == sun.elevation.shape == sun.apparent.shape == (4, 6)
    lat = numpy.array([[10.0], [46.95]])
    many = relevo.sun.position(lat, [[8.0], [7.44]], times.ravel())
    assert many.azimuth.shape == (2, 24)
    numpy.testing.assert_array_equal(many.elevation[1], sun.elevation.ravel())
    assert relevo.sun.position([0, 10], 0, "2026-06-21T10:00Z").azimuth.shape == (2,)
    assert relevo.sun.position(0, 0, []).azimuth.shape == (0,)


@pytest.mark.parametrize(
    "time, message",
    [
        (datetime.datetime(2026, 6, 21), "2026-06-21T00:00:00 has no time zone"),
        ([datetime.datetime(2026, 6, 21)], "no time zone"),
        ("2026-06-21T12:00", "no time zone"),
        ("noonish", "expected one as"),
        (numpy.datetime64("NaT"), "NaT"),
        (numpy.array(["NaT"], "datetime64[ns]"), "NaT"),
        (None, "time: expected"),
        (True, "time: expected"),
        ([True], "time: expected"),
        (float("nan"), "seconds since 1970"),
        (1e15, "seconds since 1970"),
        (7e9, "2191"),
        (datetime.date(2026, 6, 21), "time: expected"),
    ],
)
def test_what_is_no_time(time, message):
    with pytest.raises(relevo.BadInput, match=message):
        relevo.sun.position(*PLACE, time)


def test_what_is_no_place():
    for lat, lon in ((91, 0), (float("nan"), 0), (0, 400)):
        with pytest.raises(relevo.BadInput, match="^lat"):
            relevo.sun.position(lat, lon, 0)
        with pytest.raises(relevo.BadInput, match="^l(at|on)"):
            relevo.sun.events(lat, lon, "2026-06-21")
    with pytest.raises(relevo.BadInput, match="refraction"):
        relevo.sun.position(0, 0, 0, refraction="mist")
    with pytest.raises(ValueError):
        relevo.sun.position([1, 2], [1, 2, 3], 0)


def test_events(program):
    events = relevo.sun.events(*PLACE, datetime.date(2026, 6, 21), "Europe/Zurich")
    expected = json.loads(
        program("sun", "day", "--at", "46.95,7.44,0", "--date", "2026-06-21", "--tz", "Europe/Zurich", "--json")
    )["days"][0]["events"]
    assert [event.kind for event in events] == [event["kind"] for event in expected]
    for event, other in zip(events, expected):
        assert event.azimuth == pytest.approx(other["azimuth_deg"], abs=1e-6)
        assert abs(event.time - datetime.datetime.fromisoformat(other["utc"].replace("Z", "+00:00"))) < datetime.timedelta(
            milliseconds=1
        )
    assert events == relevo.sun.events(*PLACE, "2026-06-21")
    assert events[0].time.tzinfo is datetime.timezone.utc
    with pytest.raises(relevo.BadInput):
        relevo.sun.events(*PLACE, "tomorrow")
