#!/usr/bin/env python3
"""Writes docs/accuracy-shadows.md: shadows as drawn against rays marched in double precision.

Usage: shadow_accuracy.py [BUILD] [--from FILE...]
       BUILD: build/dev (default), with shadow_table built
       --from: what shadow_table has printed before, instead of running it (20 minutes)

The second DEM is test data from outside, $RELEVO_TEST_DATA or ../shared.
"""

import argparse
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = """# Accuracy of shadows

Made by

    tools/shadow_accuracy.py

Each row is one sun over one DEM. **True** is a march in double precision from every post towards the sun: the upright plane of the ray
cuts the grid's lines, on which heights are linear, and the post is in shadow if a cut lies above its ray. Posts are placed by
GeographicLib on the round Earth. **Drawn** is a picture from above, 2 to 8 pixels a post, with the parameters' defaults and the
picture's own level of detail; 0.5 of the light decides. Counted are the cells that face the sun. *Balanced accuracy* is the mean of
the shares of lit and of shaded cells that are right. *Beyond two texels* leaves out what is nearer than two texels of the map
to the true line, found by bisection along the grid's lines. *Texel* is across the light and up. Cases with less than 1 % shaded do not
count for these two, but they do for *lit cells right*: what it lacks is false shadow. Hills have no shade under a high sun, so the third table
is of the same hills four times as high (beyond two texels that one falls to 98.6 %, at 60 degrees, where 1 % is shaded).

Tested with five of these suns, one at each elevation up to 20 degrees, and two over the steep hills: `test_plugins
--gtest_filter='Vsm.*'` fails below 95 % and below 99 % beyond two texels. At 60 degrees it fails above 0.1 % of false shadow, over the hills as
they are and twice as high: a level of detail of the ground that follows the sun's height showed 0.8 to 8 % there.

What is left: the drawn ground is made of triangles, whose diagonals the march does not know (the sun from 135 and 315 degrees crosses
them squarely: lit cells suffer); shadows shallower than about a row of the map and a metre are let through; at 20
degrees on posts 30 m apart most shadows are one or two posts wide.

![Depth compared texel by texel, variance shadow map, marched rays, at 3 degrees of sun](images/shadows_compared.png)

*A part of the bundled DEM with the sun 3 degrees high: depth compared texel by texel in a map of 1024 texels, as drawn by default, and
marched. `shadow_table --comparison FILE.png --elevations 3 --azimuths 225 data/dem/jacksboro.tif`.*
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/dev", type=pathlib.Path)
    parser.add_argument("--from", dest="printed", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.printed:
        tables = [path.read_text() for path in arguments.printed]
    else:
        data = pathlib.Path(os.environ.get("RELEVO_TEST_DATA", ROOT.parent / "shared"))
        dems = [ROOT / "data/dem/jacksboro.tif", data / "dem/srtm_bigtujunga30m_utm11.tif"]
        runs = [[dem] for dem in dems] + [["--heights", "4", "--elevations", "20,30,40,60", dems[0]]]
        tables = [subprocess.run([arguments.build / "bin/shadow_table", *run], check=True, capture_output=True,
                                 text=True).stdout for run in runs]
    text = HEAD
    for table in tables:
        title, _, rest = table.strip().partition("\n")
        text += f"\n## {title}\n{rest}\n"
    (ROOT / "docs/accuracy-shadows.md").write_text(text)


if __name__ == "__main__":
    main()
