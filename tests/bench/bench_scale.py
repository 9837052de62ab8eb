#!/usr/bin/env python3
"""First picture, full detail, next frame and peak memory by the size and the layout of a DEM.

Usage: bench_scale.py [BUILD] [--sides 1000,4000,10000,20000,40000] [--layouts strips1,strips64,tiles256,overviews]
                      [--memory 64,256] [--keep FOLDER] [--no-window] [--plot FILE.svg]      (needs Xvfb for the window)

DEMs are mirrored copies of the bundled one (make_dem), LZW; `overviews` are those of tiles256; `index` is a tile index
of 1000 x 1000 posts each. A line has, of the first start (no cache) and the second (what the first has kept):
- window: seconds until the window of 1280 x 800 shows ground, and until nothing changes and nothing is computed
- capture: seconds of `capture` of the whole DEM, 1280 x 1024, default effects; its next frame; its peak memory
  (ru_maxrss) less the floor: the same command on a DEM of 2 x 2 posts
With --keep, DEMs stay in FOLDER and are used again. With --plot, the seconds by posts a side are drawn, too.
"""

import argparse
import atexit
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import time

from screen import Screen, processor_s, wait_for_picture, wait_until_gone

ROOT = pathlib.Path(__file__).resolve().parents[2]
TILE = 1000  # posts a side


def make_dem(build, path, side, layout):
    """A DEM of side x side posts; returns what to open."""
    if layout == "index":
        return make_index(build, path.parent, side)
    if not path.exists():
        part = path.with_suffix(".part.tif")
        more = ["--layout", "tiles256", "--overviews"] if layout == "overviews" else ["--layout", layout]
        subprocess.run([build / "bin/make_dem", ROOT / "data/dem/jacksboro.tif", str(side), str(side), part, *more], check=True)
        part.rename(path)
    return path


def make_index(build, folder, side):
    """Files of TILE x TILE posts, and a tile index of them."""
    index, tiles = folder / f"{side}_tiles.gpkg", folder / f"{side}_tiles"
    if index.exists():
        return index
    shutil.rmtree(tiles, ignore_errors=True)
    tiles.mkdir()
    subprocess.run([build.resolve() / "bin/make_dem", ROOT / "data/dem/jacksboro.tif", str(side), str(side), tiles,
                    "--files", str(TILE), "--layout", "tiles256"], check=True)
    names, part = folder / f"{side}_names.txt", folder / f"{side}_part.gpkg"
    names.write_text("\n".join(f"{tiles.name}/{path.name}" for path in sorted(tiles.iterdir())), encoding="utf-8")
    part.unlink(missing_ok=True)
    subprocess.run(["gdaltindex", "-f", "GPKG", part.name, "--optfile", names.name], check=True, cwd=folder,
                   stdout=subprocess.DEVNULL)
    part.rename(index)
    return index


def run(command, environment):
    """Seconds and peak [MiB] of a command, which must succeed."""
    began = time.monotonic()
    process = subprocess.Popen([str(word) for word in command], env=environment)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{command} ended with {os.waitstatus_to_exitcode(status)}")
    return time.monotonic() - began, usage.ru_maxrss / 1024


class Bench:
    def __init__(self, arguments, folder):
        self.program = str(arguments.build.resolve() / "bin/relevo")
        self.folder = folder
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache"), "XDG_CONFIG_HOME": str(folder),
                            "XDG_STATE_HOME": str(folder), "MESA_SHADER_CACHE_DIR": str(folder / "shaders")}
        self.screen = None if arguments.no_window else Screen()

    def clear_cache(self):
        shutil.rmtree(self.folder / "cache", ignore_errors=True)

    def capture(self, dem, *more):
        """Seconds and peak of a capture, and its --timings."""
        timings = self.folder / "timings.json"
        result = run([self.program, "-q", "capture", dem, "-o", self.folder / "out.png", "--overwrite", "--device", "software",
                      "--timings", timings, *more], self.environment)
        return *result, json.loads(timings.read_text())

    def window(self, dem, *more):
        """Seconds to the first picture, and to full detail."""
        began = time.perf_counter()
        environment = {**self.environment, "DISPLAY": self.screen.name, "WAYLAND_DISPLAY": ""}
        viewer = subprocess.Popen([self.program, "-q", "view", dem, *more], env=environment, cwd=self.folder)
        try:
            first = wait_for_picture(self.screen, began, 120, viewer)
            return first, wait_until_idle(self.screen, viewer, began)
        finally:
            viewer.terminate()
            viewer.wait()
            wait_until_gone(self.screen)

    def measure(self, name, dem, floor, options):
        figures = []
        for start in ("first", "second"):
            if self.screen:
                if start == "first":
                    self.clear_cache()
                figures += [f"{seconds:.1f}" for seconds in self.window(dem, *options)]
        self.clear_cache()
        for start in ("first", "second"):
            seconds, peak, _ = self.capture(dem, *options)
            figures += [f"{seconds:.1f}", f"{peak - floor:.0f}"]
        figures.append(f"{self.capture(dem, *options, '--repeat', '5')[2]['frames']['median_ms']:.0f}")
        print(f"| {name} | " + " | ".join(figures) + " |", flush=True)
        return figures


def wait_until_idle(screen, viewer, began):
    """Seconds from `began` to the last change of the picture before a second in which nothing was computed."""
    changed, before = time.perf_counter(), screen.sample()
    used, since = processor_s(viewer), time.perf_counter()
    while True:
        time.sleep(0.02)
        now = screen.sample()
        if now != before:
            before, changed = now, time.perf_counter()
        if time.perf_counter() - since > 1:
            used_before, used, since = used, processor_s(viewer), time.perf_counter()
            if used - used_before < 0.1:
                return changed - began


def plot(path, rows):
    """Seconds to the window's first picture and of a capture, by posts a side, on logarithmic axes, as SVG.

    rows: {layout: [(posts a side, figures of measure())]}
    """
    width, height, left, bottom, top = 720, 420, 50, 50, 20
    curves = [("picture", 0, "2 0"), ("picture again", 2, "2 3"), ("capture", 4, "8 0")]
    colours = dict(zip(rows, ("#1b6ca8", "#b5532a", "#3f7d3a", "#7a4b9a")))
    x = lambda side: left + (width - left - 150) * math.log(side / 1000) / math.log(40)
    y = lambda seconds: top + (height - bottom - top) * math.log(20 / seconds) / math.log(20 / 0.2)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for seconds in (0.2, 0.5, 1, 2, 5, 10, 20):
        parts.append(f'<path d="M{left} {y(seconds):.1f}H{width - 150}" stroke="#ddd"/>'
                     f'<text x="{left - 6}" y="{y(seconds) + 4:.1f}" text-anchor="end">{seconds:g} s</text>')
    for side in (1000, 4000, 10000, 20000, 40000):
        parts.append(f'<text x="{x(side):.1f}" y="{height - bottom + 18}" text-anchor="middle">{side:,}</text>')
    parts.append(f'<text x="{(left + width - 150) / 2}" y="{height - 8}" text-anchor="middle">posts a side</text>')
    for i, (layout, measured) in enumerate(rows.items()):
        parts.append(f'<text x="{width - 140}" y="{top + 18 * i + 12}" fill="{colours[layout]}">{layout}</text>')
        for _, index, dashes in curves:
            points = " ".join(f"{x(side):.1f},{y(max(0.2, float(figures[index]))):.1f}" for side, figures in measured)
            stroke = 2.5 if index == 4 else 1.5
            parts.append(f'<polyline points="{points}" fill="none" stroke="{colours[layout]}" stroke-width="{stroke}" '
                         f'stroke-dasharray="{dashes}"/>')
    for i, (name, index, dashes) in enumerate(curves):
        at = top + 18 * (len(rows) + 1 + i) + 12
        parts.append(f'<path d="M{width - 140} {at - 4}h24" stroke="#444" stroke-width="{2.5 if index == 4 else 1.5}" '
                     f'stroke-dasharray="{dashes}"/><text x="{width - 110}" y="{at}">{name}</text>')
    path.write_text("\n".join([*parts, "</svg>", ""]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--sides", default="1000,4000,10000,20000,40000")
    parser.add_argument("--layouts", default="strips1,strips64,tiles256,overviews")
    parser.add_argument("--memory", default="", help="MiB; without it the default")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--no-window", action="store_true")
    parser.add_argument("--plot", type=pathlib.Path, help="SVG; needs the window")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        dems = (arguments.keep or folder).resolve()
        dems.mkdir(parents=True, exist_ok=True)
        bench = Bench(arguments, folder)
        if bench.screen:
            atexit.register(bench.screen.close)
        small = make_dem(arguments.build, dems / "2_tiles256.tif", 2, "tiles256")
        bench.capture(small, "--allow-blank")
        floor = min(bench.capture(small, "--allow-blank")[1] for _ in range(3))
        window = [f"{start}: {what}, s" for start in ("window", "again") for what in ("picture", "detail")]
        capture = [f"{start}: {what}" for start in ("capture", "again") for what in ("s", "MiB")]
        columns = ["posts a side, layout", *(window if bench.screen else []), *capture, "next frame, ms"]
        print(f"{len(os.sched_getaffinity(0))} processors; MiB above a floor of {floor:.0f}\n")
        print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))
        drawn = {layout: [] for layout in arguments.layouts.split(",")}
        for side in map(int, arguments.sides.split(",")):
            for layout in arguments.layouts.split(","):
                dem = make_dem(arguments.build, dems / f"{side}_{layout}.tif", side, layout)
                for memory in arguments.memory.split(","):
                    options = ["--memory", memory] if memory else []
                    figures = bench.measure(" ".join([str(side), layout, *options]), dem, floor, options)
                    drawn[layout].append((side, figures))
        if arguments.plot:
            plot(arguments.plot, drawn)


if __name__ == "__main__":
    main()
