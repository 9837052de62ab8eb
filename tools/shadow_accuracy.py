#!/usr/bin/env python3
"""Writes docs/accuracy-shadows.md: shadows as drawn against rays marched in double precision.

Usage: shadow_accuracy.py [BUILD] [--beside FILE FILE] [--from FILE...]
       BUILD: build/dev (default), with shadow_table built
       --beside: what it has printed before for `shadows` and `vsm`, at the posts and in penumbras, instead of
       running it (half an hour)
       --from: likewise for the tables of `vsm` alone (20 minutes)

All DEMs but the first are test data from outside, $RELEVO_TEST_DATA or ../shared.
"""

import argparse
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = """# Accuracy of shadows

Made by

    tools/shadow_accuracy.py

## `shadows` beside `vsm`

Shadows as drawn against a march in double precision from every post towards the sun, over three DEMs; how the march goes is said below. Drawn are
four windows of 60 x 60 posts in each DEM, from above with 16 pixels to a post, so that a pixel shows what is at the post itself (on the
steeper DEMs the middle 400 x 400 posts cast the shadows). 0.5 of the light decides. `test_plugins --gtest_filter='Shadows.*'` fails below 99 %.

@BESIDE@

**Penumbra** of `shadows`: the same pictures with a sun of its true width. True is the share of 64 points all over the disc from which the march reaches the post; counted are
posts that see some of them and not all, and the error is the drawn share less the true one.

@PENUMBRA@

What is left of `shadows`: towards most azimuths rays are met within a quarter of a post (`tests/light/test_sweep.cpp`); the disc is cut by a level line, and
of ridges that a low sun grazes at once three sweeps tell the limbs' and the centre's apart.
Between posts it is linear where rays cut triangles, so that in pictures of 2 to 6 pixels a post, as those below, 97.5 to 99.8 % of cells are right.

## `vsm` in whole pictures

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


SUNS = ["--elevations", "2,10,20", "--azimuths", "200"]
PENUMBRA_SUNS = ["--elevations", "2,5", "--azimuths", "45,135,200,290"]


def rows_of(printed):
    """By DEM, effect, sun and azimuth; both effects one after the other."""
    tables, dem, seen = {}, "", {}
    for line in printed.splitlines():
        if line.endswith("posts") and ":" in line:
            dem = line
            seen[dem] = seen.get(dem, -1) + 1
        elif line.startswith("| ") and line[2].isdigit():
            cells = [cell.strip() for cell in line.strip("| \n").split("|")]
            tables.setdefault(dem, {}).setdefault((cells[0], cells[1]), {})[seen[dem]] = cells[2:]
    return tables


def accuracy_beside(printed):
    text = "| DEM | sun | azimuth | shaded | `shadows`, balanced accuracy | `vsm` |\n|---|---|---|---|---|---|\n"
    for dem, suns in rows_of(printed).items():
        for (sun, azimuth), found in suns.items():
            if float(found[0][0].rstrip(" %")) < 1:
                continue  # of few cells a share says nothing
            text += f"| {dem.split(':')[0]} | {sun} | {azimuth} | {found[0][0]} | {found[0][1]} | {found[1][1] if 1 in found else ''} |\n"
    return text


def penumbra_of(printed):
    text = "| DEM | sun | azimuth | posts | mean error | its size |\n|---|---|---|---|---|---|\n"
    for dem, suns in rows_of(printed).items():
        for (sun, azimuth), found in suns.items():
            posts, mean, size = found[0][:3]
            if int(posts) > 0:
                text += f"| {dem.split(':')[0]} | {sun} | {azimuth} | {posts} | {mean} | {size} |\n"
    return text


def run_beside(table, data, more, effects=("shadows", "vsm")):
    dems = [[ROOT / "data/dem/jacksboro.tif"], ["--part", "400", data / "dem/srtm_bigtujunga30m_utm11.tif"],
            ["--part", "400", data / "dem/missoula_valley.img"]]
    return "".join(subprocess.run([table, "--effect", effect, *more, *dem], check=True, capture_output=True, text=True).stdout
                   for effect in effects for dem in dems)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/dev", type=pathlib.Path)
    parser.add_argument("--beside", nargs=2, type=pathlib.Path)
    parser.add_argument("--from", dest="printed", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    data = pathlib.Path(os.environ.get("RELEVO_TEST_DATA", ROOT.parent / "shared"))
    table = arguments.build / "bin/shadow_table"
    if arguments.beside:
        at_posts, penumbra = (path.read_text() for path in arguments.beside)
    else:
        at_posts = run_beside(table, data, ["--at-posts", *SUNS])
        penumbra = run_beside(table, data, ["--penumbra", *PENUMBRA_SUNS], ["shadows"])
    if arguments.printed:
        tables = [path.read_text() for path in arguments.printed]
    else:
        dems = [ROOT / "data/dem/jacksboro.tif", data / "dem/srtm_bigtujunga30m_utm11.tif"]
        runs = [[dem] for dem in dems] + [["--heights", "4", "--elevations", "20,30,40,60", dems[0]]]
        tables = [subprocess.run([table, "--effect", "vsm", *run], check=True, capture_output=True,
                                 text=True).stdout for run in runs]
    text = HEAD.replace("@BESIDE@", accuracy_beside(at_posts)).replace("@PENUMBRA@", penumbra_of(penumbra))
    for table in tables:
        title, _, rest = table.strip().partition("\n")
        text += f"\n## {title}\n{rest}\n"
    (ROOT / "docs/accuracy-shadows.md").write_text(text)


if __name__ == "__main__":
    main()
