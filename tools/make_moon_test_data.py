#!/usr/bin/env python3
"""Makes tests/data/moon: published positions, phases, rises and eclipses, some rows of larger tables.

Usage: make_moon_test_data.py ASTRONOMY OUT

ASTRONOMY  a clone of github.com/cosinekitty/astronomy, which collected them
OUT        tests/data/moon

Rows are picked by position, never by how well the program does on them: every n-th row in the order of the file.
"""

import csv
import pathlib
import re
import sys

COLLECTED = "collected by github.com/cosinekitty/astronomy, generate/{} @865d3da"
MONTHS = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec".split()


def write(path, source, header, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.write(f"# Source: {source}.\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def day(year, month_name, of_month):
    return f"{year}-{MONTHS.index(month_name) + 1:02}-{of_month}"


def horizons(generate):
    """Topocentric apparent places without air, from 1900 to 2099."""
    name = "horizons/airless_Moon.txt"
    row = re.compile(r"^ (\d{4})-(\w{3})-(\d\d) (\d\d:\d\d) .{3} +(\S+) +(\S+) +(\S+) +(\S+) +(\S+) +(\S+)$")
    rows = [match.groups() for match in map(row.match, (generate / name).read_text().splitlines()) if match]
    picked = [[day(*r[:3]) + "T" + r[3], "UT1" if int(r[0]) < 1962 else "UTC", 29, -81, 10, *r[6:]]
              for r in rows[::41]]
    return (f"JPL Horizons (DE431), April 2019; {COLLECTED.format(name)}. Before 1962 the time is UT1; from July 2019 on "
            "Horizons' UT1 was a prediction. Without air", ["time", "scale", "lat_deg", "lon_deg", "height_m",
                                                          "ra_deg", "dec_deg", "az_deg", "el_deg"], picked)


def phases(generate):
    name = "moonphase/moonphases.txt"
    rows = [line.split() for line in (generate / name).read_text().splitlines()]
    rows = [[time[:-8], phase] for phase, time in rows if 1900 <= int(time[:4]) <= 2100]
    return (f"U.S. Naval Observatory, phases of the moon, to the minute of UT; {COLLECTED.format(name)}. "
            "0 new moon, 1 first quarter, 2 full moon, 3 last quarter", ["time", "phase"], rows[::17])


def rises(generate):
    name = "riseset/riseset.txt"
    rows = [line.split() for line in (generate / name).read_text().splitlines() if line.startswith("Moon ")]
    rows = [[time[:-1], lat, lon, {"r": "moonrise", "s": "moonset"}[kind]] for _, lon, lat, time, kind in rows]
    return (f"U.S. Naval Observatory, rise/set table for the moon, to the minute of UT; {COLLECTED.format(name)}",
            ["time", "lat_deg", "lon_deg", "event"], rows[::41])


def eclipses(generate):
    """Place and kind of greatest eclipse; times of TT."""
    row = re.compile(r"^\d{5} +(\d{4}) (\w{3}) (\d\d) +(\d\d:\d\d:\d\d) +(\S+) +\S+ +\S+ +(\S+) +(\S+) +(\S+) +"
                     r"([\d.]+)([NS]) +([\d.]+)([EW]) +(\d+) +\d*(.*)$")
    picked = []
    for name in ("eclipse/se1901.html", "eclipse/se2001.html"):
        text = re.sub("<[^>]*>", "", (generate / name).read_text())
        for match in filter(None, map(row.match, text.splitlines())):
            year, month, date, time, delta_t, kind, _, magnitude, lat, south, lon, west, alt, rest = match.groups()
            duration = re.search(r"(\d\d)m(\d\d)s", rest)
            picked.append([day(year, month, date) + "T" + time, delta_t, kind[0], magnitude,
                           ("-" if south == "S" else "") + lat, ("-" if west == "W" else "") + lon, alt,
                           int(duration[1]) * 60 + int(duration[2]) if duration else ""])
    return (f"NASA, Five Millennium Catalog of Solar Eclipses (F. Espenak, J. Meeus), 1901 to 2100; "
            f"{COLLECTED.format('eclipse')}. Greatest eclipse, TT, its place to 0.1 degrees; P partial, A annular, "
            "T total, H hybrid; magnitude: of central eclipses the ratio of the discs; duration of the central phase",
            ["time_tt", "delta_t_s", "kind", "magnitude", "lat_deg", "lon_deg", "sun_alt_deg", "duration_s"], picked)


def main():
    generate, out = pathlib.Path(sys.argv[1]) / "generate", pathlib.Path(sys.argv[2])
    for name, table in (("horizons_airless", horizons), ("usno_phases", phases), ("usno_riseset", rises),
                        ("nasa_eclipses", eclipses)):
        write(out / f"{name}.csv", *table(generate))


if __name__ == "__main__":
    main()
