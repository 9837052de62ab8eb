#!/usr/bin/env python3
"""Takes the pictures of docs/viewer.md, on a display of its own.

    tools/window_pictures.py --dems FOLDER [BUILD] [--only day,point] [--size 1280x800]    BUILD: build/release (default)
    tools/window_pictures.py --dems FOLDER [BUILD] --states [--keep FOLDER]    states of the window, as one picture

FOLDER has the DEMs under the names that STATES and SHEET use. Needs Xvfb, xdotool, xprop and python3-pil. Writes
docs/images/.
"""
import argparse
import json
import math
import os
import pathlib
import struct
import subprocess
import tempfile
import time

from PIL import Image, ImageChops

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Of each picture the words of its command, and what mouse and keys do afterwards, as xdotool has it.
STATES = {
    "day": (["tyrol.tif", "--time", "2026-06-21T08:20+02:00"], ["mousemove 820 420"]),
    "evening": (["tyrol.tif", "--time", "2026-09-21T18:20+02:00", "--eye", "47.3128,11.3850,30agl", "--heading", "250",
                 "--pitch", "-3"], ["mousemove 900 300"]),
    "point": (["tyrol.tif", "--time", "2026-12-21T10:30+01:00"],
              ["mousemove 760 560 click 1", "sleep 6", "key m", "mousemove 1010 500", "sleep 1", "mousemove 1012 502"]),
    "hours": (["tujunga.tif", "--time", "2026-12-21T13:00-08:00", "--view", "az=220,el=35"],
              ["key o", "sleep 8", "mousemove 900 470"]),
    "film": (["sthelens.tif", "--time", "2026-06-21T19:10-07:00"], ["key f", "sleep 3", "mousemove 900 300"]),
}

SUMMER, WINTER = ["--time", "2026-06-21T08:20+02:00"], ["--time", "2026-12-21T10:30+01:00"]
NIGHT = ["--time", "2026-03-02T21:00+01:00", "--eye", "47.3128,11.3850,30agl", "--heading", "250", "--pitch", "3"]
SMALL, USUAL, DENSE = ("800x600", 96), ("1280x800", 96), ("2560x1600", 192)
# The states of one picture: name, display, theme, words, acts.
SHEET = [
    ("start", USUAL, "dark", ["tyrol.tif"], None),
    ("day", USUAL, "dark", ["tyrol.tif", *SUMMER], []),
    ("day", USUAL, "light", ["tyrol.tif", *SUMMER], []),
    ("day", SMALL, "dark", ["tyrol.tif", *SUMMER], []),
    ("day", DENSE, "light", ["tyrol.tif", *SUMMER], []),
    ("night", USUAL, "dark", ["tyrol.tif", *NIGHT], ["key l"]),
    ("point", USUAL, "light", ["tyrol.tif", *WINTER], ["mousemove 760 360 click 1"]),
    ("point", SMALL, "dark", ["tyrol.tif", *WINTER], ["mousemove 560 260 click 1"]),
    ("point", DENSE, "dark", ["tyrol.tif", *WINTER], ["mousemove 1520 720", "sleep 5", "click 1"]),
    ("menu of a point", USUAL, "dark", ["tyrol.tif", *WINTER], ["mousemove 760 360 click 3"]),
    ("hours", USUAL, "light", STATES["hours"][0], ["key o", "mousemove 900 470"]),
    ("film", USUAL, "dark", STATES["film"][0], ["key f", "sleep 3"]),
    ("film", SMALL, "light", STATES["film"][0], ["key f", "sleep 3"]),
    ("export", USUAL, "light", ["tyrol.tif", *SUMMER], ["key ctrl+p"]),
    ("export", SMALL, "dark", ["tyrol.tif", *SUMMER], ["key ctrl+p"]),
    ("export", DENSE, "dark", ["tyrol.tif", *SUMMER], ["key ctrl+p"]),
    ("find", SMALL, "light", ["tyrol.tif", *SUMMER], ["key ctrl+f", "type innsbruck", "sleep 3"]),
    ("how it is read", USUAL, "dark", ["ascii.asc"], ["type austria"]),
    ("keys", DENSE, "light", ["tyrol.tif", *SUMMER], ["key h"]),
    ("menu", USUAL, "dark", ["tyrol.tif", *SUMMER], ["mousemove 108 11 click 1"]),
]
CELL, COLUMNS = (640, 400), 4


def screen(frame_buffer):
    """The picture of Xvfb's frame buffer, which is a file of xwd."""
    data = frame_buffer.read_bytes()
    head = struct.unpack(">25I", data[:100])
    size, row_bytes, colours = (head[4], head[5]), head[12], head[19]
    return Image.frombuffer("RGB", size, data[head[0] + 12 * colours:], "raw", "BGRX", row_bytes, 1)


def settle(frame_buffer, wait_s):
    """Waits until the screen is the same for three seconds, but for a cursor that blinks; at most so long."""
    before, since, until = screen(frame_buffer), time.monotonic(), time.monotonic() + wait_s
    while time.monotonic() < min(since + 3, until):
        time.sleep(0.3)
        now = screen(frame_buffer)
        box = ImageChops.difference(now, before).getbbox()
        if box and (box[2] - box[0]) * (box[3] - box[1]) > 400:
            since = time.monotonic()
        before = now


def take(program, words, acts, size, dems, wait_s, theme="dark", dpi=96):
    """The screen after some acts. Without acts (None): while the window opens."""
    with tempfile.TemporaryDirectory() as folder:
        server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", f"{size}x24", "-fbdir", folder, "-noreset"],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        display = ":" + server.stdout.readline().decode().strip()
        environment = os.environ | {"DISPLAY": display, "XDG_CONFIG_HOME": folder, "XDG_STATE_HOME": folder}
        frame_buffer = pathlib.Path(folder) / "Xvfb_screen0"
        settings = pathlib.Path(folder) / "relevo/settings.json"
        settings.parent.mkdir()
        settings.write_text(json.dumps({"style": theme}))
        subprocess.run(["xprop", "-root", "-f", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER", f"Xft.dpi: {dpi}"],
                       env=environment, check=True)
        window = subprocess.Popen([program, *words], cwd=dems, env=environment)
        try:
            if acts is None:
                while not subprocess.run(["xdotool", "search", "--onlyvisible", "--pid", str(window.pid)],
                                         env=environment, capture_output=True).stdout:
                    time.sleep(0.02)
                time.sleep(0.2)
                return screen(frame_buffer)
            opened = time.monotonic()  # the card of the opening stands over few colours
            while len(set(screen(frame_buffer).resize((40, 40)).getdata())) < 400 and time.monotonic() < opened + wait_s:
                time.sleep(0.3)
            settle(frame_buffer, wait_s)
            for act in acts:
                if act.startswith("sleep "):
                    time.sleep(float(act.split()[1]))
                else:
                    subprocess.run(["xdotool", *act.split()], env=environment, check=True)
                    time.sleep(1)
            settle(frame_buffer, wait_s)
            if window.poll() is not None:
                raise SystemExit("the window has ended")
            return screen(frame_buffer)
        finally:
            for process in (window, server):
                process.terminate()
                process.wait()


def take_states(program, dems, wait_s, keep):
    """Takes the states, as one picture of cells. @param keep  folder for each at its own size; None: nowhere"""
    sheet = Image.new("RGB", (COLUMNS * CELL[0], math.ceil(len(SHEET) / COLUMNS) * CELL[1]), (128, 128, 128))
    for number, (name, (size, dpi), theme, words, acts) in enumerate(SHEET):
        kept = f"{number:02}_{name.replace(' ', '_')}_{size}_{theme}.png"
        picture = take(program, words, acts, size, dems, wait_s, theme, dpi)
        if keep:
            picture.save(keep / kept)
        picture.thumbnail(CELL, Image.LANCZOS)
        column, row = number % COLUMNS, number // COLUMNS
        sheet.paste(picture, (column * CELL[0] + (CELL[0] - picture.width) // 2,
                              row * CELL[1] + (CELL[1] - picture.height) // 2))
    sheet.save(ROOT / "docs/images/window_states.webp", quality=82, method=6)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--dems", type=pathlib.Path, required=True, help="folder of DEMs")
    parser.add_argument("--only", help="names of pictures, by commas")
    parser.add_argument("--size", default="1280x800")
    parser.add_argument("--wait", default=60, type=float, help="most seconds until a picture is complete")
    parser.add_argument("--states", action="store_true", help="states of the window, as one picture")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for each of the states at its own size")
    arguments = parser.parse_args()
    program = (arguments.build / "bin/relevo").resolve()
    if arguments.states:
        return take_states(program, arguments.dems.resolve(), arguments.wait, arguments.keep)
    for name in arguments.only.split(",") if arguments.only else STATES:
        words, acts = STATES[name]
        picture = take(program, words, acts, arguments.size, arguments.dems,
                       arguments.wait)
        picture.save(ROOT / f"docs/images/viewer_{name}.jpg", quality=88)


if __name__ == "__main__":
    main()
