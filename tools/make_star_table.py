#!/usr/bin/env python3
"""Makes tools/sky/stars.csv: where the stars stand that one sees without a telescope, how bright they are, and their colour.

Usage: make_star_table.py CATALOGUE OUT

CATALOGUE  file `catalog` of the Bright Star Catalogue, 5th revised edition (preliminary), D. Hoffleit and
           W. H. Warren, Astronomical Data Center 1991; CDS V/50, unpacked: 9110 lines of 197 characters
OUT        tools/sky/stars.csv

Only measured values are taken over: place, proper motion, magnitude and colour index of stars to magnitude 6.0.
"""

import pathlib
import sys

FAINTEST_MAG = 6.0
# T Coronae Borealis stands in the catalogue with the 2.0 of its outburst of 1866; it is of magnitude 10 between two of them.
NOVAE = {5958}


def star(line):
    """The row of a line, or None for the 14 entries that are no stars."""
    line = line.ljust(197)
    if not line[75:77].strip():
        return None
    right_ascension_s = int(line[75:77]) * 3600 + int(line[77:79]) * 60 + float(line[79:83])
    declination_arcsec = int(line[84:86]) * 3600 + int(line[86:88]) * 60 + int(line[88:90])
    if line[83] == "-":
        declination_arcsec = -declination_arcsec
    return {"hr": int(line[:4]), "ra_deg": f"{right_ascension_s / 240:.5f}", "dec_deg": f"{declination_arcsec / 3600:.5f}",
            "pm_ra": line[148:154].strip(), "pm_dec": line[154:160].strip(),
            "v": float(line[102:107]), "b_v": line[109:114].strip()}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    lines = pathlib.Path(sys.argv[1]).read_text(encoding="latin-1").splitlines()
    if len(lines) != 9110:
        sys.exit(f"make_star_table.py: {sys.argv[1]}: expected the 9110 lines of the Bright Star Catalogue, got {len(lines)}")
    stars = [s for s in map(star, lines) if s and s["v"] <= FAINTEST_MAG and s["hr"] not in NOVAE]
    stars.sort(key=lambda s: (s["v"], s["hr"]))
    with open(sys.argv[2], "w", encoding="ascii", newline="\n") as out:
        out.write("hr,ra_deg,dec_deg,pm_ra_arcsec,pm_dec_arcsec,v_mag,b_v_mag\n")
        for s in stars:
            pm = [f"{float(s[k]):.3f}" for k in ("pm_ra", "pm_dec")]
            b_v = f"{float(s['b_v']):.2f}" if s["b_v"] else ""
            out.write(f"{s['hr']},{s['ra_deg']},{s['dec_deg']},{pm[0]},{pm[1]},{s['v']:.2f},{b_v}\n")


if __name__ == "__main__":
    main()
