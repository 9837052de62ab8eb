#!/usr/bin/env python3
"""Writes the page of a DEM for tests, without the program: make_page.py DEM OUT.html [TIME]"""

import base64
import json
import math
import pathlib
import struct
import sys
import zlib

import numpy as np

import dem_grid

WEB = pathlib.Path(__file__).resolve().parents[2] / "web"
ORDER = ["reader", "sun", "sweep", "point", "draw", "view", "bar", "page"]


def planes(stored):
    """Heights as the container has them: planar prediction, low bytes, high bytes."""
    s = stored.astype(np.int64)
    p = s.copy()
    p[:, 1:] -= s[:, :-1]
    p[1:] -= s[:-1]
    p[1:, 1:] += s[:-1, :-1]
    p &= 65535
    return (p & 255).astype("u1").tobytes() + (p >> 8).astype("u1").tobytes()


def refraction():
    """Saemundsson's formula, 1010 hPa and 10 degrees C."""
    e = [x / 4 for x in range(-4, 361)]
    return {"elevation": e, "lift": [1.02 / 60 / math.tan(math.radians(x + 10.3 / (x + 5.11))) for x in e]}


def container(path, time, exaggeration=1.4, azimuth=180):
    heights, corners = dem_grid.read(path)
    low = float(np.nanmin(heights))
    step = max(0.1, (float(np.nanmax(heights)) - low) / 65000)
    stored = np.where(np.isnan(heights), 65535, np.round((heights - low) / step)).astype(np.uint16)
    raw = planes(stored)
    packed = zlib.compress(raw, 9)
    step_m = corners[0]["metres"]
    grid = {k: [c[k] for c in corners] for k in ("lat", "lon", "convergence")}
    grid.update(columns=2, rows=2, scale_x=[c["metres"][0] / step_m[0] for c in corners],
                scale_y=[c["metres"][1] / step_m[1] for c in corners])
    offset = round(np.mean(grid["lon"]) / 15) * 3600
    meta = {"title": pathlib.Path(path).stem, "credits": ["Heights: test"], "size": list(heights.shape[::-1]),
            "step_m": step_m, "height": {"min": low, "step": step}, "exaggeration": exaggeration,
            "view": {"post": [heights.shape[1] / 2, heights.shape[0] * 1.5], "height": 1.4 * low + 20000, "heading": azimuth - 180,
                     "pitch": -30, "fov": 50}, "time": time,
            "zone": {"name": "", "transitions": [[-2**40, int(offset)]]}, "grid": grid, "refraction": refraction(),
            "blocks": [{"name": "heights", "offset": 0, "length": len(packed), "size": len(raw),
                        "crc32": zlib.crc32(packed), "coding": "deflate"}]}
    text = json.dumps(meta).encode()
    text += b" " * (-len(text) % 8)
    return b"RLVW" + struct.pack("<II", 1, len(text)) + text + packed


def page(data, title="test"):
    text = (WEB / "page.html").read_text()
    parts = {"title": title, "policy": "default-src 'none'; connect-src 'none'; script-src 'unsafe-inline' blob:; "
             "worker-src blob:; img-src data: blob:; style-src 'unsafe-inline'",
             "style": (WEB / "page.css").read_text(), "sweep": (WEB / "sweep.js").read_text(),
             "data": base64.b64encode(data).decode(),
             "script": "\n".join((WEB / f"{n}.js").read_text() for n in ORDER)}
    for name, part in parts.items():
        text = text.replace("{{" + name + "}}", part)
    return text


if __name__ == "__main__":
    pathlib.Path(sys.argv[2]).write_text(page(container(sys.argv[1], *sys.argv[3:])))
