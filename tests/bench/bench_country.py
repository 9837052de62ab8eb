#!/usr/bin/env python3
"""What a country of tiles takes: a part computed for real, the whole extrapolated (docs/country.md).

    apt-get install python3-gdal
    tests/bench/bench_country.py INDEX build/release FOLDER

INDEX is an OGR tile index of square tiles in metres, whose own tiles are not read. Of its middle, 8 x 8 neighbouring
tiles are made in FOLDER under their names: real relief (data/dem/jacksboro.tif) stretched to 80 to 950 m, with trees
and roofs, 1000 x 1000 posts of 32-bit floats, LZW. Runs, each as `relevo plan` writes its tasks, and merged:

- a day in June and one in December, of all 64 tiles and in one go, which must be the same; of 4 x 4 with --halo
- 1, 4, 30 and 365 days of 2 x 2 tiles, for what a longer time costs; the year in one go, too
- a year with --halo of all 64 tiles, or of 4 x 4 if that takes longer than --minutes
- the plan of the whole index, whose other tiles are missing

Prints tables in Markdown. Times, peak memory (of the largest process) and bytes read and written (/proc/PID/io, from
the system's cache, too) are measured; the last table is extrapolated. Status 1: values differ that must not.
"""

import argparse
import collections
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

import numpy as np
from osgeo import gdal, ogr

gdal.UseExceptions()
ogr.UseExceptions()
REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
POSTS = 1000  # a side of a tile
LOWEST_M, HIGHEST_M = 80, 950
DAYS = {"June 21": "2026-06-21", "December 21": "2026-12-21"}
YEAR = ("--year", "2026")
CORES = (2, 16, 64, 256, 1024)
MIB, GIB = 1 << 20, 1 << 30


Square = collections.namedtuple("Square", ["name", "box"])  # of an index; box: west, south, east, north


def read_index(path):
    """All rows, and the layer's CRS."""
    name = f"/vsigzip/{path}" if str(path).endswith(".gz") else str(path)
    gdal.SetConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO")  # no file next to the index
    dataset = ogr.GetDriverByName("GPKG" if ".gpkg" in name else "FlatGeobuf").Open(name)
    layer = dataset.GetLayer(0)
    rows = []
    for feature in layer:
        west, east, south, north = feature.GetGeometryRef().GetEnvelope()
        rows.append(Square(pathlib.Path(feature.GetField("location")).stem, (west, south, east, north)))
    return rows, layer.GetSpatialRef().Clone()


def write_index(path, rows, srs):
    """Of local files: relative names, from the index's folder."""
    path.unlink(missing_ok=True)
    dataset = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = dataset.CreateLayer("tindex", srs, ogr.wkbPolygon)
    layer.CreateField(ogr.FieldDefn("location", ogr.OFTString))
    layer.StartTransaction()
    for row in rows:
        west, south, east, north = row.box
        outline = f"POLYGON (({west} {south}, {east} {south}, {east} {north}, {west} {north}, {west} {south}))"
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetField("location", f"dsm/{row.name}.tif")
        feature.SetGeometry(ogr.CreateGeometryFromWkt(outline))
        layer.CreateFeature(feature)
    layer.CommitTransaction()


def block_of(rows, side):
    """The side x side neighbouring squares nearest to the middle, from the north-west on; how many there are in all."""
    by_place = {row.box: row for row in reversed(rows)}
    size = rows[0].box[2] - rows[0].box[0]
    corner = np.mean(list(by_place), axis=0) + size * side / 2 * np.array([-1, 1, -1, 1])
    for west, south, east, north in sorted(by_place, key=lambda box: np.hypot(box[0] - corner[0], box[3] - corner[3])):
        steps = np.arange(side) * size
        boxes = [(west + i, south - k, east + i, north - k) for k in steps for i in steps]
        if all(box in by_place for box in boxes):
            return [by_place[box] for box in boxes], len(by_place)
    return sys.exit(f"the index has no {side} x {side} neighbouring tiles")


class Ground:
    """Hills of a real DEM with trees and roofs, at every metre of a plane."""

    def __init__(self, west, north, length_m):
        self.west, self.north = west, north
        source = gdal.Open(str(REPOSITORY / "data/dem/jacksboro.tif"))
        self.step_m = 80  # about as far as its posts are apart
        side = int(length_m / self.step_m) + 8
        hills = source.ReadAsArray().astype(np.float32)
        hills = np.pad(hills, [(0, max(0, side - n)) for n in hills.shape], mode="reflect")[:side, :side]
        hills = LOWEST_M + (hills - hills.min()) / np.ptp(hills) * (HIGHEST_M - 30 - LOWEST_M)
        self.hills = gdal.GetDriverByName("MEM").Create("", side, side, 1, gdal.GDT_Float32)
        self.hills.GetRasterBand(1).WriteArray(hills)

    @staticmethod
    def random(x, y, seed):
        """From 0 to 1 for whole numbers, the same in every tile."""
        mixed = (x.astype(np.uint64) * 0x9E3779B1 + y.astype(np.uint64) * 0x85EBCA77 + seed) * 0xC2B2AE3D27D4EB4F
        return ((mixed ^ (mixed >> np.uint64(29))) * 0x165667B19E3779F9 >> np.uint64(40)).astype(np.float32) / (1 << 24)

    def heights(self, box):
        west, north = box[0] - self.west, self.north - box[3]
        at = 3 + np.array([west, north]) / self.step_m
        size = POSTS / self.step_m
        hills = self.hills.GetRasterBand(1).ReadAsArray(at[0], at[1], size, size, POSTS, POSTS,
                                                        resample_alg=gdal.GRIORA_CubicSpline)
        x, y = np.meshgrid(int(box[0]) + np.arange(POSTS), int(box[3]) - np.arange(POSTS))
        use = self.random(x // 200, y // 200, 1)
        trees = np.where(self.random(x // 5, y // 5, 2) < 0.8, 12 + 16 * self.random(x // 5, y // 5, 3), 0)
        roofs = np.where(self.random(x // 14, y // 14, 4) < 0.4, 6 + 8 * self.random(x // 14, y // 14, 5), 0)
        return np.round(hills + np.where(use < 0.4, trees, np.where(use < 0.5, roofs, 0)), 2).astype(np.float32)


def make_tiles(folder, block, srs):
    folder.mkdir(parents=True, exist_ok=True)
    ground = Ground(block[0].box[0], block[0].box[3], len(block) ** 0.5 * POSTS)
    for square in block:
        out = gdal.GetDriverByName("GTiff").Create(str(folder / f"{square.name}.tif"), POSTS, POSTS, 1,
                                                   gdal.GDT_Float32, ["COMPRESS=LZW"])
        out.SetGeoTransform((square.box[0], 1, 0, square.box[3], 0, -1))
        out.SetProjection(srs.ExportToWkt())
        out.GetRasterBand(1).WriteArray(ground.heights(square.box))
        del out  # writes it


class Taken:
    """What commands took, one after the other."""

    def __init__(self):
        self.wall_s = self.processor_s = self.read = self.written = self.peak_mib = 0
        self.said = ""

    def run(self, *words):
        begin = time.perf_counter()
        with subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, text=True) as process:
            self.said = process.stdout.read()
            os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
            io = dict(line.split(": ") for line in
                      pathlib.Path(f"/proc/{process.pid}/io").read_text(encoding="ascii").splitlines())
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        self.wall_s += time.perf_counter() - begin
        self.processor_s += usage.ru_utime + usage.ru_stime
        self.read += int(io["rchar"])
        self.written += int(io["wchar"])
        self.peak_mib = max(self.peak_mib, usage.ru_maxrss / 1024)
        print(f"{self.wall_s:8.1f} s {self.processor_s:8.1f} s {pathlib.Path(words[-1]).name[-60:]}", file=sys.stderr)
        if process.returncode != 0:
            sys.exit(f"status {process.returncode}: {' '.join(map(str, words))}")
        return self


class Bench:
    def __init__(self, relevo, folder, halo_km):
        self.relevo, self.folder, self.halo = relevo, folder, ["--halo", str(halo_km)]
        self.index = folder / "block.gpkg"
        self.failed = False

    def command(self, when, more=()):
        return ["sun", "hours", self.index, *when, "--tz", "UTC", *more]

    def in_one(self, name, when, more=()):
        path = self.folder / f"{name}.tif"
        return path, Taken().run(self.relevo, "-q", *self.command(when, more), "-o", path, "--overwrite")

    def plan(self, folder, when, more=(), index=None):
        shutil.rmtree(folder, ignore_errors=True)
        words = self.command(when, more)
        words[2] = index or self.index
        return Taken().run(self.relevo, "-q", "plan", *words, "--tiles", words[2], "-o", folder, "--parallel",
                           f"{folder}.txt", "--overwrite")

    def in_tiles(self, name, when, more=()):
        """As a reader would: a plan, its tasks one after the other, and their merge."""
        folder, tasks = self.folder / name, Taken()
        self.plan(folder, when, more)
        for line in pathlib.Path(f"{folder}.txt").read_text(encoding="utf-8").splitlines():
            tasks.run("/bin/sh", "-c", line)
        Taken().run(self.relevo, "-q", "merge", folder, "-o", folder / "mosaic.vrt", "--overwrite")
        return folder / "mosaic.vrt", tasks

    def compare(self, what, tiles, whole, days=1, must_be_equal=False):
        """Minutes of a day by which the tiles are off."""
        part, of = gdal.Open(str(tiles)), gdal.Open(str(whole))
        ours, theirs = part.GetGeoTransform(), of.GetGeoTransform()
        window = round(ours[0] - theirs[0]), round(theirs[3] - ours[3]), part.RasterXSize, part.RasterYSize
        off = np.abs(part.ReadAsArray() - of.ReadAsArray(*window)).ravel() * 60 / days
        if must_be_equal and (not np.isfinite(off).all() or off.any()):
            self.failed = True
        at = np.quantile(off, [0.99, 0.999])
        print(f"| {what} | {len(off) / 1e6:.0f} M | {np.count_nonzero(off)} | {off.mean():.4f} | {at[0]:.3f} "
              f"| {at[1]:.3f} | {off.max():.2f} |", flush=True)


def table(title, *columns):
    print(f"\n{title}\n\n| {' | '.join(columns)} |\n|{'---|' * len(columns)}")


def number_after(word, text):
    return float(re.search(rf"^{word} +(?:some )?([0-9.e+-]+)", text, re.MULTILINE).group(1))


def clip_of(squares):
    boxes = np.array([square.box for square in squares])
    return ["--clip", ",".join(f"{n:.0f}" for n in (*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0)))]


def middle_of(block, side):
    """Of 8 x 8."""
    lines = range((8 - side) // 2, (8 + side) // 2)
    return [block[row * 8 + column] for row in lines for column in lines]


def measure_days(bench, block, lines, compared):
    for day, date in DAYS.items():
        when = ("--date", date)
        whole, one = bench.in_one(date, when)
        exact, tasks = bench.in_tiles(f"exact {date}", when)
        far, far_tasks = bench.in_tiles(f"halo {date}", when, bench.halo + clip_of(middle_of(block, 4)))
        lines += [(f"{day}, in one go", 64, one), (f"{day}, tasks", 64, tasks),
                  (f"{day}, --halo, tasks", 16, far_tasks)]
        compared += [(day, exact, whole, 1, True), (f"{day}, --halo", far, whole, 1, False)]


def measure_lengths(bench, block, lines, compared):
    """@returns what the last one took: a year"""
    clip = clip_of(middle_of(block, 2))
    for name, when in (("1 day", ("--date", "2026-06-21")), ("4 days", ("--from", "2026-06-21", "--to", "2026-06-24")),
                       ("30 days", ("--from", "2026-06-01", "--to", "2026-06-30")), ("365 days", YEAR)):
        year, tasks = bench.in_tiles(f"part {name}", when, bench.halo + clip)
        lines.append((f"{name}, --halo, tasks", 4, tasks))
    whole, one = bench.in_one("year", YEAR, clip)
    lines.append(("365 days, in one go", 4, one))
    compared.append(("365 days, --halo", year, whole, 365, False))
    return tasks


def print_measured(bench, lines, compared):
    table("Measured:", "hours of", "tiles", "wall s", "processor s", "processor s a tile", "read MiB", "written MiB",
          "peak MiB")
    for what, tiles, taken in lines:
        print(f"| {what} | {tiles} | {taken.wall_s:.1f} | {taken.processor_s:.1f} "
              f"| {taken.processor_s / tiles:.2f} | {taken.read / MIB:.0f} | {taken.written / MIB:.0f} "
              f"| {taken.peak_mib:.0f} |")
    table("Tiles against one go, minutes a day:", "hours of", "posts", "differ", "mean", "99 %", "99.9 %", "worst")
    for line in compared:
        bench.compare(*line)


def extrapolate(dsm, part, year, tiles, block_plan, whole_plan, squares):
    """What the whole takes: from a year of 4 and of more tiles, what each takes beyond a task's start."""
    tile_s = (year.processor_s - part.processor_s) / (tiles - 4)
    start_s = max(0, part.processor_s - 4 * tile_s)
    written = (year.written - part.written) / (tiles - 4) * squares
    plan_s = whole_plan.wall_s + (squares - 64) * block_plan.wall_s / 64
    tasks = int(number_after("tasks", whole_plan.said))
    task_s = start_s + squares / tasks * tile_s
    stored = sum(path.stat().st_size for path in dsm.glob("*.tif")) / (64 * POSTS**2 * 4)
    read = stored * (number_after("reading +up to", whole_plan.said) + 2 * 4 * squares * POSTS**2 / GIB)
    table(f"The whole, {squares} tiles, a year, extrapolated:", "cores", "wall-clock hours", "processor hours",
          "read GiB", "written GiB", "MiB a task", "tasks", "MiB/s read")
    for cores in CORES:
        wall_s = plan_s + math.ceil(tasks / cores) * task_s
        print(f"| {cores} | {wall_s / 3600:.1f} | {(plan_s + tasks * task_s) / 3600:.0f} | {read:.0f} "
              f"| {written / GIB:.0f} | {number_after('memory', whole_plan.said):.0f} | {tasks} "
              f"| {read * 1024 / wall_s:.0f} |")
    print(f"\nProcessor time: a tile {tile_s:.1f} s, a task's start {start_s:.1f} s, a task {task_s / 60:.0f} minutes; "
          f"the plan at most {plan_s / 60:.0f} minutes.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("index", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path, help="for tiles and results, some 3 GiB")
    parser.add_argument("--halo", type=float, default=3, help="of relevo, km (3)")
    parser.add_argument("--minutes", type=float, default=15, help="of two processors for the year (15)")
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    rows, srs = read_index(arguments.index)
    block, squares = block_of(rows, 8)
    make_tiles(folder / "dsm", block, srs)
    write_index(folder / "block.gpkg", block, srs)
    write_index(folder / "whole.gpkg", rows, srs)
    bench = Bench(arguments.build.resolve() / "bin/relevo", folder, arguments.halo)
    print(f"{len(rows)} rows of {squares} squares; made are {len(block)}, from {block[0].name} on", flush=True)
    lines, compared = [], []
    measure_days(bench, block, lines, compared)
    part = measure_lengths(bench, block, lines, compared)
    some = middle_of(block, 8 if part.processor_s / 4 * 64 / 2 < 60 * arguments.minutes else 4)
    _, year = bench.in_tiles("year", YEAR, bench.halo + clip_of(some))
    block_plan = bench.plan(folder / "plan", YEAR, bench.halo)
    whole_plan = bench.plan(folder / "whole", YEAR, [*bench.halo, "--cpus", "1"], folder / "whole.gpkg")
    lines += [("365 days, --halo, tasks", len(some), year), ("365 days, --halo, plan", 64, block_plan),
              ("365 days, --halo, plan of all", squares, whole_plan)]
    print_measured(bench, lines, compared)
    print(f"\nThe plan of 64 tiles:\n\n{block_plan.said}\nThat of all, most of them missing:\n\n{whole_plan.said}")
    extrapolate(folder / "dsm", part, year, len(some), block_plan, whole_plan, squares)
    if bench.failed:
        sys.exit("tiles without --halo are others than those of one go")


if __name__ == "__main__":
    main()
