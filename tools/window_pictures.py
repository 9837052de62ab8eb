#!/usr/bin/env python3
"""Takes the pictures of docs/viewer.md, on a display of its own.

    tools/window_pictures.py --dems FOLDER [BUILD] [--only day,point] [--size 1280x800]    BUILD: build/release (default)

FOLDER has the DEMs under the names that STATES uses. Needs Xvfb, xdotool and python3-pil. Writes docs/images/.
"""
import argparse
import os
import pathlib
import struct
import subprocess
import tempfile
import time

from PIL import Image

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


def screen(frame_buffer):
    """The picture of Xvfb's frame buffer, which is a file of xwd."""
    data = frame_buffer.read_bytes()
    head = struct.unpack(">25I", data[:100])
    size, row_bytes, colours = (head[4], head[5]), head[12], head[19]
    return Image.frombuffer("RGB", size, data[head[0] + 12 * colours:], "raw", "BGRX", row_bytes, 1)


def take(program, words, acts, size, dems, wait_s):
    with tempfile.TemporaryDirectory() as folder:
        server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", f"{size}x24", "-fbdir", folder],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        display = ":" + server.stdout.readline().decode().strip()
        environment = os.environ | {"DISPLAY": display, "XDG_CONFIG_HOME": folder, "XDG_STATE_HOME": folder}
        window = subprocess.Popen([program, *words], cwd=dems, env=environment)
        try:
            time.sleep(wait_s)
            for act in acts:
                if act.startswith("sleep "):
                    time.sleep(float(act.split()[1]))
                else:
                    subprocess.run(["xdotool", *act.split()], env=environment, check=True)
                    time.sleep(1)
            time.sleep(wait_s / 2)
            if window.poll() is not None:
                raise SystemExit("the window has ended")
            return screen(pathlib.Path(folder) / "Xvfb_screen0")
        finally:
            for process in (window, server):
                process.terminate()
                process.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--dems", type=pathlib.Path, required=True, help="folder of DEMs")
    parser.add_argument("--only", help="names of pictures, by commas")
    parser.add_argument("--size", default="1280x800")
    parser.add_argument("--wait", default=12, type=float, help="seconds until a picture is complete")
    arguments = parser.parse_args()
    for name in arguments.only.split(",") if arguments.only else STATES:
        words, acts = STATES[name]
        picture = take((arguments.build / "bin/relevo").resolve(), words, acts, arguments.size, arguments.dems,
                       arguments.wait)
        picture.save(ROOT / f"docs/images/viewer_{name}.jpg", quality=88)


if __name__ == "__main__":
    main()
