#!/usr/bin/env python3
"""Makes core/sun/earth_rotation_table.inc: how the Earth turned from 1899 to the last bulletin.

Usage: make_earth_rotation_table.py C04 FINALS HISTORIC > core/sun/earth_rotation_table.inc

C04       IERS EOP 14 C04, IAU 2000 (eopc04_IAU2000.62-now), daily from 1962. Debian: python3-astropy.
FINALS    IERS Bulletin A, finals2000A.all, daily from 1973 with a year of predictions.
          https://datacenter.iers.org or https://maia.usno.navy.mil/ser7/finals2000A.all
HISTORIC  USNO historic_deltat.data, half-yearly TT-UT1 from 1657, as the array [Julian dates, seconds]
          that Debian's python3-skyfield carries (historic_deltat.npy).

C04 is used as far as it goes, then Bulletin A. Nodes are 30 days apart; the script prints on standard
error what cubic interpolation between them loses against the daily values.
"""

import ast
import datetime
import struct
import sys

STEP_D = 30

# TAI-UTC. Before 1972: from MJD, seconds, reference MJD, seconds a day (IERS, Bulletin C; USNO tai-utc.dat).
DRIFTING = [(37665, 1.8458580, 37665, 0.0011232), (38334, 1.9458580, 37665, 0.0011232),
            (38395, 3.2401300, 38761, 0.001296), (38486, 3.3401300, 38761, 0.001296),
            (38639, 3.4401300, 38761, 0.001296), (38761, 3.5401300, 38761, 0.001296),
            (38820, 3.6401300, 38761, 0.001296), (38942, 3.7401300, 38761, 0.001296),
            (39004, 3.8401300, 38761, 0.001296), (39126, 4.3131700, 39126, 0.002592),
            (39887, 4.2131700, 39126, 0.002592)]
LEAPS = [41317, 41499, 41683, 42048, 42413, 42778, 43144, 43509, 43874, 44239, 44786, 45151, 45516, 46247,
         47161, 47892, 48257, 48804, 49169, 49534, 50083, 50630, 51179, 53736, 54832, 56109, 57204, 57754]


def tai_minus_utc_s(mjd):
    if mjd >= LEAPS[0]:
        return 9.0 + sum(mjd >= leap for leap in LEAPS)
    start, seconds, reference, rate = [row for row in DRIFTING if row[0] <= mjd][-1]
    return seconds + (mjd - reference) * rate


def read_c04(path):
    days = {}
    with open(path, encoding="ascii") as file:
        for line in file:
            fields = line.split()
            if len(fields) > 12 and len(fields[0]) == 4 and fields[0].isdigit():
                mjd = int(fields[3])
                days[mjd] = (float(fields[6]) - tai_minus_utc_s(mjd), float(fields[4]), float(fields[5]))
    return days


def read_finals(path):
    days = {}
    last_measured = 0
    with open(path, encoding="ascii") as file:
        for line in file:
            if line[57] not in "IP":
                continue
            mjd = int(float(line[7:15]))
            days[mjd] = (float(line[58:68]) - tai_minus_utc_s(mjd), float(line[18:27]), float(line[37:46]))
            if line[57] == "I":
                last_measured = mjd
    return days, last_measured


def read_npy(path):
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack("<H", data[8:10])[0]
    header = ast.literal_eval(data[10:10 + length].decode("ascii"))
    assert header["descr"] == "<f8" and not header["fortran_order"] and header["shape"][0] == 2, header
    count = header["shape"][1]
    values = struct.unpack(f"<{2 * count}d", data[10 + length:])
    return values[:count], values[count:]


def interpolated(days, first, mjd, column):
    """Lagrange's cubic through the two nodes on each side."""
    node = (mjd - first) // STEP_D
    p = (mjd - first) / STEP_D - node
    y = [days[first + STEP_D * (node + k)][column] for k in (-1, 0, 1, 2)]
    return (-p * (p - 1) * (p - 2) / 6 * y[0] + (p + 1) * (p - 1) * (p - 2) / 2 * y[1]
            - (p + 1) * p * (p - 2) / 2 * y[2] + (p + 1) * p * (p - 1) / 6 * y[3])


def date_of(mjd):
    return (datetime.date(1858, 11, 17) + datetime.timedelta(days=mjd)).isoformat()


def print_rows(values, per_line):
    for start in range(0, len(values), per_line):
        print("    " + ", ".join(values[start:start + per_line]) + ",")


def main():
    c04 = read_c04(sys.argv[1])
    finals, last_measured = read_finals(sys.argv[2])
    days = {**finals, **c04}
    first = min(days)
    nodes = [mjd for mjd in range(first, max(days) + 1, STEP_D)]
    assert all(mjd in days for mjd in range(first, nodes[-1] + 1))

    for column, unit in enumerate(("s of UT1", "arcsec of x", "arcsec of y")):
        errors = sorted(abs(interpolated(days, first, mjd, column) - days[mjd][column])
                        for mjd in range(nodes[1], nodes[-2]))
        print(f"interpolation: median {errors[len(errors) // 2]:.5f}, worst {errors[-1]:.5f} {unit}",
              file=sys.stderr)

    dates, delta_t = read_npy(sys.argv[3])
    # Up to one node after C04 begins, so that the last interval has a neighbour.
    historic = [(jd, value) for jd, value in zip(dates, delta_t) if 2414650 < jd < 2438040]

    print("// Made by tools/make_earth_rotation_table.py; do not edit.")
    print("// Facts of: IERS EOP 14 C04 (1962 on), IERS Bulletin A finals2000A (after C04's end), USNO")
    print("// historic_deltat.data (before 1962).")
    print()
    print(f"// UT1-TAI [0.1 ms] and the pole's x, y [0.1 mas], every {STEP_D} days from {date_of(first)} to"
          f" {date_of(nodes[-1])}; predicted after {date_of(last_measured)}.")
    print(f"constexpr int kFirstNode_mjd = {first};")
    print(f"constexpr int kNodeStep_d = {STEP_D};")
    print("constexpr int kEarthRotation[][3] = {")
    print_rows([f"{{{days[mjd][0] * 1e4:.0f}, {days[mjd][1] * 1e4:.0f}, {days[mjd][2] * 1e4:.0f}}}" for mjd in nodes], 5)
    print("};")
    print()
    print("// TT-UT1 [ms] at the beginning and in the middle of years.")
    print(f"constexpr double kFirstDeltaT_mjd = {historic[0][0] - 2400000.5};")
    print(f"constexpr double kDeltaTStep_d = 182.625;")
    print("constexpr int kDeltaT[] = {")
    print_rows([f"{value * 1e3:.0f}" for _, value in historic], 16)
    print("};")


if __name__ == "__main__":
    main()
