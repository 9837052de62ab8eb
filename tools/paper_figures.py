#!/usr/bin/env python3
"""Takes the pictures of docs/paper.md: the paper's figures 1 and 3 to 7 on the real terrain that comes along,
those of plugins' READMEs, and the one on the front page.

Usage: paper_figures.py [BUILD] [--only 4,haze] [--size 960x600]      BUILD: build/release (default)

Writes docs/images/. Everything a picture depends on is in this file.
"""

import argparse
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[1]

DAWN = "--eye 36.40,-84.40,900 --heading 100 --pitch -1 --fov 30 --time 2026-03-20T08:05-04:00"
ROCK = "--set layering.limits=metres --set layering.grass_rock_m=-100,0"
EDGE = f"--eye 36.3718,-84.3303,12agl --heading 20 --pitch -22 --fov 30 --time 2026-06-21T06:55-04:00 {ROCK} " \
       "--set bump.strength=3 --disable shadows,skylight"
DISC = "--eye 36.35,-84.38,1000 --heading 90 --pitch 2 --fov 12 --time 2026-03-20T07:53-04:00 --exposure -1.5"
WIDE = "--eye 36.35,-84.38,1000 --heading 95 --pitch 8 --fov 60 --time 2026-03-20T08:05-04:00"
GROUND = f"--eye 36.3513,-84.2290,2agl --heading 75 --pitch -10 --fov 50 --time 2026-06-21T08:40-04:00 {ROCK}"
RIDGES = "--eye 36.35,-84.38,1000 --heading 95 --pitch 0 --fov 40"

HILLS = "--view az=200,el=28,zoom=2 --time 2026-06-21T18:00-04:00"

FIGURES = {
    "front": {"jacksboro": "--eye 36.22,-84.30,1500 --heading 340 --pitch -8 --fov 45 --time 2026-06-21T19:40-04:00"},
    "1": {"paper_1_dawn": DAWN},
    "3": {"paper_3a_abrupt": f"{EDGE} --set bump.correction=abrupt", "paper_3b_smooth": f"{EDGE} --set bump.correction=smooth"},
    "4": {"paper_4a_disc": DISC, "paper_4b_sky": WIDE, "paper_4c_paper": f"{WIDE} --preset paper"},
    "5": {"paper_5a_dry": GROUND, "paper_5b_wet": f"{GROUND} --enable wet"},
    "6": {"paper_6_shadows": "--view az=205,el=32,zoom=2.2 --time 2026-06-21T20:05-04:00 --disable skylight --ab vsm"},
    "7": {"paper_7a_day": f"{RIDGES} --time 2026-03-20T13:00-04:00", "paper_7b_sunset": f"{RIDGES} --time 2026-03-20T07:55-04:00",
          "paper_7c_night": f"{RIDGES} --time 2026-03-20T05:30-04:00"},
    "layering": {"layering_range": f"{HILLS} --set layering.limits=normalised", "layering_climate": HILLS},
    "stars": {"stars": "--eye 36.40,-84.30,1100 --heading 190 --pitch 26 --fov 62 --time 2026-01-15T22:30-05:00"},
    "agx": {"agx": f"{WIDE} --ab agx"},
    "haze": {"haze_ab": f"{RIDGES} --time 2026-03-20T09:00-04:00 --ab haze"},
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--only", default=",".join(FIGURES), help="figures, by number or name")
    parser.add_argument("--size", default="960x600")
    arguments = parser.parse_args()
    for number in arguments.only.split(","):
        for name, view in FIGURES[number].items():
            if name.startswith(("paper_", "layering_")):
                view += " --enable layering"  # the paper's ground
            path = ROOT / f"docs/images/{name}.jpg"
            subprocess.run([arguments.build / "bin/relevo", "-q", "capture", ROOT / "data/dem/jacksboro.tif", "-o", path,
                            "--overwrite", "--size", arguments.size, "--device", "software", *view.split()], check=True)
            print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1024} kB")


if __name__ == "__main__":
    main()
