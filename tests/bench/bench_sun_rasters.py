#!/usr/bin/env python3
"""Rasters of sun against GRASS and SAGA: the same DEM, the same machine, in turn, from file to file.

    apt-get install grass-core saga faketime
    tests/bench/bench_sun_rasters.py build/release DEM [--rounds 3]

DEM is one in metres (UTM). A day is from suns 3 minutes apart, sky view and horizons are of 36
directions, everything on all processors that the program can use: r.sun with nprocs, SAGA by itself,
r.horizon of GRASS 8.2 on one. What GRASS and SAGA first read the DEM into is not counted, what
Relevo reads and writes is. Prints seconds and how many times as long as Relevo each takes.
"""

import argparse
import os
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path


def seconds(command, **options):
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options)
    return time.perf_counter() - begin


class Bench:
    def __init__(self, build, dem, folder):
        self.relevo = str(Path(build) / "bin" / "relevo")
        self.dem = str(Path(dem).resolve())
        self.folder = Path(folder)
        self.processors = len(os.sched_getaffinity(0))

    def sun(self, *words):
        return seconds([self.relevo, "-q", "sun", words[0], self.dem, *words[1:], "-o",
                        str(self.folder / "relevo.tif"), "--overwrite"])

    def prepare(self):
        self.location = self.folder / "grass"
        subprocess.run(["grass", "-c", self.dem, "-e", str(self.location)], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.grass("r.in.gdal", f"input={self.dem}", "output=dem")
        self.grass("g.region", "raster=dem")
        self.grass("r.slope.aspect", "elevation=dem", "slope=slope", "aspect=aspect")
        subprocess.run(["saga_cmd", "io_gdal", "0", "-FILES", self.dem, "-GRIDS", str(self.folder / "dem.sgrd")],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def grass(self, *words):
        return seconds(["grass", str(self.location / "PERMANENT"), "--exec", *words, "--o", "--q"])

    def saga(self, date, *words):
        return seconds(["faketime", f"{date} 12:00:00", "saga_cmd", *words])

    def jobs(self):
        grid = str(self.folder / "dem.sgrd")
        out = {name: str(self.folder / f"{name}.sgrd") for name in "tdfuvs"}
        return [
            ("a day of sun, suns 3 minutes apart", [
                ("relevo sun hours", lambda: self.sun("hours", "--date", "2023-06-21")),
                (f"r.sun nprocs={self.processors}", lambda: self.grass(
                    "r.sun", "elevation=dem", "aspect=aspect", "slope=slope", "day=172", "step=0.05",
                    f"nprocs={self.processors}", "glob_rad=g", "insol_time=i")),
                ("SAGA ta_lighting 2", lambda: self.saga(
                    "2023-06-21", "ta_lighting", "2", "-GRD_DEM", grid, "-GRD_TOTAL", out["t"], "-GRD_DIRECT",
                    out["d"], "-GRD_DIFFUS", out["f"], "-GRD_DURATION", out["u"], "-LOCATION", "0", "-LATITUDE",
                    "34.32", "-PERIOD", "1", "-HOUR_STEP", "0.05"))]),
            ("36 horizons", [
                ("relevo sun horizons", lambda: self.sun("horizons", "--directions", "36")),
                ("r.horizon", lambda: self.grass(
                    "r.horizon", "elevation=dem", "step=10", "start=0", "end=360", "output=hr"))]),
            ("sky view, 36 directions", [
                ("relevo sun sky-view", lambda: self.sun("sky-view")),
                ("SAGA ta_lighting 3", lambda: self.saga(
                    "2023-06-21", "ta_lighting", "3", "-DEM", grid, "-SVF", out["v"], "-METHOD", "0", "-NDIRS",
                    "36"))]),
            ("shadows of a moment", [
                ("relevo sun shadow", lambda: self.sun("shadow", "--sun", "135,20")),
                ("SAGA ta_lighting 0", lambda: self.saga(
                    "2023-06-21", "ta_lighting", "0", "-ELEVATION", grid, "-SHADE", out["s"], "-METHOD", "3",
                    "-POSITION", "0", "-AZIMUTH", "135", "-DECLINATION", "20"))]),
            ("a year of sun", [("relevo sun hours", lambda: self.sun("hours", "--year", "2023"))]),
        ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("dem")
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    missing = [name for name in ("grass", "saga_cmd", "faketime") if not shutil.which(name)]
    if missing:
        parser.error(f"not installed: {', '.join(missing)}; apt-get install grass-core saga faketime")
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments.build, arguments.dem, folder)
        bench.prepare()
        for job, programs in bench.jobs():
            taken = {name: [] for name, _ in programs}
            for _ in range(arguments.rounds):
                for name, run in programs:
                    taken[name].append(run())
            ours = statistics.median(taken[programs[0][0]])
            print(job)
            for name, times in taken.items():
                middle = statistics.median(times)
                print(f"    {name:24} {middle:8.2f} s  {min(times):8.2f} at least  x {middle / ours:6.1f}", flush=True)


if __name__ == "__main__":
    main()
