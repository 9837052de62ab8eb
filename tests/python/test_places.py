"""Figures of places are those of the program's --json."""

import datetime
import json

import numpy
import pandas
import pytest

import relevo
from conftest import BUNDLED

LAT, LON = 36.32, -84.25
AT = ("--at", f"{LAT},{LON}", "--json", "-q")
WARNS = pytest.mark.filterwarnings("ignore:mountains of up to")


def texts(found):
    """With times as the program writes them."""
    if isinstance(found, dict):
        return {key: texts(value) for key, value in found.items()}
    if isinstance(found, list):
        return [texts(value) for value in found]
    if isinstance(found, datetime.datetime):
        assert found.utcoffset() == datetime.timedelta(0)
        return found.isoformat(timespec="milliseconds").replace("+00:00", "Z")
    return found


def same(found, said):
    assert len(json.dumps(texts(found))) > 100
    assert texts(found) == said


@WARNS
@pytest.mark.parametrize("body", ["sun", "moon"])
def test_days_over_a_dem(dem, program, body):
    words = ("--from", "2026-06-20", "--to", "2026-06-22", "--tz", "UTC", "--eye-height", "2.5", "--limb", "lower")
    found = getattr(dem, body).day(
        LAT, LON, start="2026-06-20", end=datetime.date(2026, 6, 22), tz=datetime.timezone.utc, eye_height=2.5, limb="lower"
    )
    same(found, json.loads(program(body, "day", BUNDLED, *AT, *words)))
    assert len(pandas.DataFrame(found["days"])) == 3


@pytest.mark.parametrize("body", ["sun", "moon"])
def test_a_day_without_terrain(program, body):
    """One day is a list of one, too."""
    found = getattr(relevo, body).day(LAT, LON, "2026-06-21", height=120.0, refraction="saemundsson", dip=0.5)
    words = ("--at", f"{LAT},{LON},120", "--date", "2026-06-21", "--refraction", "saemundsson", "--dip", "0.5")
    said = json.loads(program(body, "day", *words, "--json", "-q"))
    assert len(found["days"]) == 1
    same(found, said)


@WARNS
def test_light_of_the_terrain_is_shorter(dem):
    over = dem.sun.day(LAT, LON, "2026-06-21", terrestrial_refraction=0.2, highest=1000)["days"][0]
    level = relevo.sun.day(LAT, LON, "2026-06-21")["days"][0]
    assert 0 < over["direct_sun_h"] < level["day_length_h"] - 0.5
    assert "direct_sun" not in level


@WARNS
def test_eclipses(dem, program):
    words = ("--from", "2017-01-01", "--to", "2024-12-31", "--tz", "UTC")
    days = {"start": "2017-01-01", "end": "2024-12-31", "tz": "UTC"}
    over = dem.sun.eclipses(LAT, LON, **days)
    same(over, json.loads(program("sun", "eclipses", BUNDLED, *AT, *words)))
    same(relevo.sun.eclipses(LAT, LON, **days), json.loads(program("sun", "eclipses", *AT, *words)))
    assert "2024-04-08" in [one["date"] for one in over["eclipses"]]


@WARNS
def test_carpet(dem, program):
    found = dem.sun.carpet(LAT, LON, 2026, step=datetime.timedelta(minutes=30), highest=1200)
    words = ("--year", "2026", "--step", "30min", "--highest", "1200")
    same(found, json.loads(program("sun", "carpet", BUNDLED, *AT, *words)))
    assert found["direct_sun_h"] == pytest.approx(sum(day["direct_sun_h"] for day in found["days"]))


@WARNS
def test_when(dem, program):
    found = dem.sun.when(LAT, LON, (36.35, -84.3), year=2026, summit_radius=300, tolerance=20)
    words = ("--over", "36.35,-84.3", "--year", "2026", "--summit-radius", "300", "--tolerance", "20")
    same(found, json.loads(program("sun", "when", BUNDLED, *AT, *words)))
    assert found["passages"]
    point = dem.sun.when(LAT, LON, (36.35, -84.3, 900), "2026-06-21")
    assert point["target"]["height_m"] == 900


@WARNS
def test_when_of_the_moon(dem, program):
    found = dem.moon.when(LAT, LON, (36.35, -84.3), start="2026-06-01", end="2026-06-30", tolerance=20, refraction="none")
    words = ("--over", "36.35,-84.3", "--from", "2026-06-01", "--to", "2026-06-30", "--tolerance", "20", "--no-refraction")
    same(found, json.loads(program("moon", "when", BUNDLED, *AT, *words)))
    assert found["passages"] and all(isinstance(one["moon_visible"], bool) for one in found["passages"])
    for one in found["passages"]:
        moon = relevo.moon.position(LAT, LON, one["utc"], height=found["place"]["height_m"], refraction="none")
        assert moon.azimuth == pytest.approx(one["azimuth_deg"], abs=2e-3)
        assert moon.apparent == pytest.approx(one["apparent_elevation_deg"], abs=2e-3)


WALK = [(36.30, -84.28), (36.31, -84.27), (36.33, -84.27)]
HOURS = ["2026-12-21T06:30-05:00", "2026-12-21T08:00:00.25-05:00", "2026-12-21T09:30-05:00"]


@pytest.fixture
def csv(tmp_path):
    rows = [f"{lat},{lon},{time}" for (lat, lon), time in zip(WALK, HOURS)]
    file = tmp_path / "walk.csv"
    file.write_text("\n".join(["lat,lon,time", *rows]), encoding="utf-8")
    return file


def along(program, csv, *words):
    return json.loads(program("sun", "along", BUNDLED, csv, *words, "--json", "-q"))


@WARNS
def test_along_by_its_own_times(dem, program, csv):
    said = along(program, csv, "--name", "three", "--eye-height", "1.5")
    assert {one["light"] for one in said["stretches"]} >= {"night", "sun", "terrain"}
    same(dem.sun.along(csv, name="three", eye_height=1.5), said)
    same(dem.sun.along(str(csv), track=1, name="three", eye_height=1.5), said)
    same(dem.sun.along(WALK, times=HOURS, name="three", eye_height=1.5), said)
    times = [datetime.datetime.fromisoformat(HOURS[0]), datetime.datetime(2026, 12, 21, 8, 0, 0, 250000), HOURS[2]]
    same(dem.sun.along(numpy.array(WALK), times=times, tz="-05:00", name="three", eye_height=1.5),
         along(program, csv, "--name", "three", "--eye-height", "1.5", "--tz", "-05:00"))


@WARNS
def test_along_at_a_speed(dem, program, csv):
    words = ("--speed", "3.5", "--refraction", "saemundsson", "--terrestrial-refraction", "0.2", "--highest", "1200")
    options = {"speed": 3.5, "refraction": "saemundsson", "terrestrial_refraction": 0.2, "highest": 1200}
    same(dem.sun.along(WALK, start="2026-02-10 sunrise", **options), along(program, csv, "--start", "2026-02-10 sunrise", *words))
    start = datetime.datetime(2026, 2, 10, 13, tzinfo=datetime.timezone.utc)
    same(dem.sun.along(WALK, start=start, tz="UTC", **options),
         along(program, csv, "--start", "2026-02-10T13:00Z", "--tz", "UTC", *words))
    same(dem.sun.along(csv, start="2026-02-10T13:00", tz="UTC"), along(program, csv, "--start", "2026-02-10T13:00", "--tz", "UTC"))


@WARNS
def test_a_long_walk(dem):
    """Longer than texts of people: 30,000 fixes of a logger."""
    share = numpy.linspace(0, 1, 30_000)
    walk = numpy.outer(1 - share, WALK[0]) + numpy.outer(share, WALK[1])
    found = dem.sun.along(walk, times=1766340000 + share * 7200)
    assert found["duration_h"] == pytest.approx(2) and found["length_m"] == pytest.approx(1429, abs=3)


def test_positions_of_the_moon(program):
    times = numpy.array(["2026-06-21T04", "2026-12-01T17:30"], "datetime64[s]").reshape(2, 1)
    found = relevo.moon.position(LAT, LON, times, height=300.0, refraction="none")
    for i, time in enumerate(times.ravel()):
        words = ("--at", f"{LAT},{LON},300", "--time", f"{time}Z", "--no-refraction", "--json")
        said = json.loads(program("moon", "position", *words))
        assert found.azimuth.shape == (2, 1)
        assert found.azimuth[i, 0] == said["azimuth_deg"] and found.apparent[i, 0] == said["apparent_elevation_deg"]
        assert found.distance[i, 0] == said["distance_km"]
        assert found.illuminated[i, 0] == said["illuminated_fraction"]
        assert found.bright_limb[i, 0] == said["bright_limb_from_zenith_deg"]
    many = relevo.moon.position(LAT, LON, numpy.arange(1001) * 60.0)
    assert many.elevation.shape == (1001,) and numpy.ptp(many.elevation) > 20


def test_horizons_as_pvlib_has_them(dem):
    series = dem.moon.horizon(LAT, LON, step=30).to_pandas()
    assert series.index.name == "horizon_azimuth" and series.name == "horizon_elevation"
    assert series[90.0] == dem.sun.horizon(LAT, LON, azimuth=90).elevation[0]


@pytest.mark.parametrize(
    "call, sentence",
    [
        (lambda dem: dem.sun.day(LAT, LON), "^date: missing; pass "),
        (lambda dem: dem.sun.day(95, LON, "2026-06-21"), "^lat: expected a number in"),
        (lambda dem: dem.moon.day(10, 10, "2026-06-21"), "outside"),
        (lambda dem: dem.sun.day(LAT, LON, "2026-06-21", height=3, eye_height=2), "^eye_height= and height= exclude"),
        (lambda dem: dem.sun.day(LAT, LON, "2026-06-21", limb="left"), "^limb: expected one of upper"),
        (lambda dem: dem.sun.carpet(LAT, LON, 2026, step=7), "step 7 s: does not divide"),
        (lambda dem: dem.sun.carpet(LAT, LON, 2026, step=7.5), "^step: "),
        (lambda dem: dem.sun.carpet(LAT, LON, 3000), "^year: 3000: "),
        (lambda dem: dem.sun.when(LAT, LON, "summit", year=2026), r"^over: expected \(lat, lon\)"),
        (lambda dem: dem.sun.when(LAT, LON, (1.0,), year=2026), "^over: 1.0: "),
        (lambda dem: dem.sun.along(WALK), '^start: missing, as the walk has no times; pass start="2026-06-21T09:00Z" and speed=4'),
        (lambda dem: dem.sun.along(WALK, start="2026-02-10T13:00Z"), "^speed: missing, as the walk has no times; pass speed="),
        (lambda dem: dem.sun.along(WALK, start="2026-02-10T13:00", speed=4), "^start: .* has no time zone; give tz="),
        (lambda dem: dem.sun.along(WALK, start="noon", speed=4), "^start: noon: no date; write .* noon$"),
        (lambda dem: dem.sun.along([], start="2026-02-10T13:00Z", speed=4), r"^walk: expected an array of \(points, 2\)"),
        (lambda dem: dem.sun.along(WALK[:1], start="2026-02-10T13:00Z", speed=4), "^walk: expected a file, or 2 to"),
        (lambda dem: dem.sun.along([*WALK, (float("nan"), 1)], start="2026-02-10T13:00Z", speed=4), "^walk: "),
        (lambda dem: dem.sun.along([*WALK, (96, 1)], start="2026-02-10T13:00Z", speed=4), "^walk: 96,1: "),
        (lambda dem: dem.sun.along([(1, 1), (1, 2)], start="2026-02-10T13:00Z", speed=4), "^walk: .*outside"),
        (lambda dem: dem.sun.along([WALK[0]] * 2, start="2026-02-10T13:00Z", speed=4), "^walk: "),
        (lambda dem: dem.sun.along(WALK, times=[]), "^times: expected one for each"),
        (lambda dem: dem.sun.along(WALK, times=HOURS[:2]), "^times: expected one for each"),
        (lambda dem: dem.sun.along(WALK, times=HOURS[::-1]), "^walk: point 2: its time, .* is before that of the point before"),
        (lambda dem: dem.sun.along(WALK, times=HOURS[:1] * 3), "^walk: "),
        (lambda dem: dem.sun.along(WALK, times=[0.0, 1.0, float("nan")]), "^time"),
        (lambda dem: dem.sun.along(WALK, times=HOURS, track=1), "^track: "),
        (lambda dem: dem.sun.along("/no/walk.gpx"), "^walk: /no/walk.gpx"),
        (lambda dem: dem.sun.along(dem.name), "^walk: "),
        (lambda dem: dem.moon.when(LAT, LON, (36.35, -84.3), start="2026-06-02", end="2026-06-01"), "^start=.* ends before it begins"),
        (lambda dem: relevo.sun.day(1, float("nan"), "2026-06-21"), "^lon: "),
        (lambda dem: relevo.sun.eclipses(1, 2, start="2026-06-21"), "^start= needs end=$"),
        (lambda dem: relevo.moon.position(1, 2, "2026-06-21T12:00"), "^time: .* give tz="),
    ],
)
def test_bad_input(dem, call, sentence):
    with pytest.raises(relevo.BadInput, match=sentence):
        call(dem)


@WARNS
def test_closed(dem):
    dem.close()
    with pytest.raises(relevo.BadCall, match="closed"):
        dem.sun.day(LAT, LON, "2026-06-21")


@WARNS
def test_warns_of_terrain_outside(dem):
    with pytest.warns(relevo.Warning, match="hide the sun.*bound them with highest="):
        dem.sun.carpet(LAT, LON, 2026)
