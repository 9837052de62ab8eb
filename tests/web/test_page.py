#!/usr/bin/env python3
"""Pages of `relevo export web` in headless Chromium, from file://: RELEVO=build/bin/relevo test_page.py

Prints what it measures. Exits 77 where Chromium is not installed. Other DEMs than those of the project are read from
$RELEVO_TEST_DATA, else ../shared beside the project, where they are there. $RELEVO_AXE names axe.min.js of the npm package
axe-core; without it the page's accessibility is not checked.
"""

import base64
import csv
import datetime
import functools
import http.server
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib

try:
    import numpy as np
    import rasterio
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

import chromium

ROOT = pathlib.Path(__file__).resolve().parents[2]
RELEVO = os.environ["RELEVO"]
OURS = ROOT / "data/dem/jacksboro.tif"
OTHERS = pathlib.Path(os.environ.get("RELEVO_TEST_DATA", ROOT.parent / "shared")) / "dem"
OTHER_DEMS = ["srtm_bigtujunga30m_utm11.tif", "mt_rainier_90m.tif", "SainteHelens.dem", "N42E001.hgt",
              "tyrol_aw3d30_n47e011_1s_cog.tif"]
READY = "document.body.dataset.ready || document.body.dataset.failed"
DAY = "2026-12-21"
FOLDER = tempfile.TemporaryDirectory()


def relevo(*arguments, fails=False):
    done = subprocess.run([RELEVO, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert (done.returncode != 0) == fails, done.stderr
    return done.stderr if fails else done.stdout


def page_of(dem, *options, name=None):
    path = pathlib.Path(FOLDER.name) / f"{name or pathlib.Path(dem).stem}.html"
    if not path.exists():
        relevo("export", "web", dem, "-o", path, *options)
    return path


def opened(path, *flags, size=(1200, 630)):
    page = chromium.Page(path.as_uri(), size, flags)
    page.wait(READY)
    return page


def data_of(path):
    return bytearray(base64.b64decode(re.search(r'id="data">([^<]*)<', path.read_text())[1]))


def about_of(data):
    return json.loads(data[12:12 + struct.unpack("<I", data[8:12])[0]])


def with_data(path, data, name):
    """A copy of a page with other data."""
    copy = pathlib.Path(FOLDER.name) / f"{name}.html"
    copy.write_text(re.sub(r'(id="data">)[^<]*', lambda m: m[1] + base64.b64encode(data).decode(), path.read_text()))
    return copy


def with_about(path, change, name):
    data = data_of(path)
    length = struct.unpack("<I", data[8:12])[0]
    about = about_of(data)
    change(about)
    text = json.dumps(about).encode()
    text += b" " * (-len(text) % 8)
    return with_data(path, data[:8] + struct.pack("<I", len(text)) + text + data[12 + length:], name)


def shade(page, time):
    """Whether each post is in the shade, as the page draws it, and the sun's apparent elevation."""
    page.value(f"page.light = null; page.bar.set(Date.parse('{time}') / 1000)")
    page.wait("!!page.light")
    coded = page.value("""(() => {
        let text = '';
        for (let i = 0; i < page.light.length; i += 4096)
          text += String.fromCharCode(...page.light.subarray(i, i + 4096).map(v => v < 128 ? 1 : 0));
        return btoa(text);
    })()""")
    columns, rows = page.value("page.ground.meta.size")
    sun = page.value("sunAt(page.ground.meta, page.bar.unix, page.bar.centre.lat, page.bar.centre.lon).apparent")
    return np.frombuffer(base64.b64decode(coded), "u1").reshape(rows, columns) == 1, sun


def compared(page, dem, time, *options):
    dark, sun = shade(page, time)
    mask = pathlib.Path(FOLDER.name) / "mask.tif"
    relevo("sun", "shadow", dem, "--time", time, "-o", mask, "--overwrite", *options)
    with rasterio.open(mask) as raster:
        true = raster.read(1)
    known = true != 255
    dark, true = dark[known], true[known] == 0
    equal, overlap = (dark == true).mean(), (dark & true).sum() / max(1, (dark | true).sum())
    print(f"{pathlib.Path(dem).name} {' '.join(options)} {time}: sun {sun:.1f}, shade {true.mean():.1%}, equal {equal:.2%}, "
          f"overlap {overlap:.3f}")
    return true.mean(), equal, overlap


def time_of_sun(page, degrees):
    """The afternoon's time at which the sun stands so high on the shortest day, else on the longest one."""
    return page.value(f"""(() => {{
        const {{meta}} = page.ground, {{lat, lon}} = page.bar.centre;
        for (const day of ['2026-12-21', '2026-06-21'])
          for (let t = Date.parse(day + 'T12:00Z') / 1000 - lon * 240, last = -90, end = t + 36000; t < end; t += 60) {{
            const up = sunAt(meta, t, lat, lon).apparent;
            if (last > {degrees} && up <= {degrees}) return new Date(t * 1000).toISOString().slice(0, 16) + 'Z';
            last = up;
          }}
    }})()""")


class WebPage(unittest.TestCase):
    def test_shade_is_that_of_sun_shadow(self):
        for dem in [OURS, *[OTHERS / name for name in OTHER_DEMS if (OTHERS / name).exists()]]:
            # In the page of a large DEM would be means.
            options = ["--crop", "11.3,47.2,11.6,47.4"] if "tyrol" in dem.name else []
            with opened(page_of(dem, "--megabytes", "20", *options, name=f"whole-{dem.stem}")) as page:
                for degrees in (10, 30, 45):
                    share, equal, overlap = compared(page, dem, time_of_sun(page, degrees),
                                                     *(options and ["--clip", options[1], "--clip-crs", "EPSG:4326"]))
                    with self.subTest(dem=dem.name, sun=degrees):
                        self.assertGreater(equal, 0.985 if options else 0.995)
                        if 0.15 < share < 0.7:
                            self.assertGreater(overlap, 0.97)

    def test_ground_outside_shades(self):
        box = "-84.28,36.25,-84.2,36.33"
        with opened(page_of(OURS, "--crop", box, name="part")) as page:
            time = time_of_sun(page, 8)
            share, equal, _ = compared(page, OURS, time, "--clip", box, "--clip-crs", "EPSG:4326")
            self.assertGreater(equal, 0.995)
            alone, _, _ = compared(page, OURS, time, "--crop", box)
            self.assertGreater(share, alone + 0.005, "here ground outside shades")

    def test_direct_sun_of_points(self):
        with rasterio.open(OURS) as dem:
            columns, rows = dem.width, dem.height
            posts = [(round(columns * (c + 0.5) / 10), round(rows * (r + 0.5) / 5)) for r in range(5) for c in range(10)]
            places = [dem.xy(r, c) for c, r in posts]
        table = pathlib.Path(FOLDER.name) / "points.csv"
        with table.open("w") as file:
            csv.writer(file).writerows([("name", "lat", "lon"), *[(i, y, x) for i, (x, y) in enumerate(places)]])
        true = json.loads(relevo("sun", "day", OURS, "--points", table, "--date", DAY, "--json"))
        off = []
        with opened(page_of(OURS)) as page:
            for (column, row), day in zip(posts, true):
                found = page.value(f"spells(pointAt(page.ground, {column}, {row}), "
                                   f"midnightOf(page.ground.meta.zone, Date.parse('{DAY}T17:00Z') / 1000))")
                wanted = [[seconds(lit[e]) for e in ("first_utc", "last_utc")] for lit in day["direct_sun"]]
                if len(found) == len(wanted):
                    off += np.abs(np.subtract(found, wanted)).ravel().tolist()
                else:   # a spell too many or too few: its edges by the nearest ones
                    off += [min((abs(a - b) for s in found for b in s), default=1e9) for w in wanted for a in w]
        within = np.mean(np.array(off) <= 60)
        print(f"first and last light: {len(off)} edges, {within:.1%} within a minute, worst {max(off):.0f} s")
        self.assertGreaterEqual(within, 0.95)
        self.assertLessEqual(np.mean(np.array(off) > 180), 0.02)

    def test_sun_is_that_of_the_program(self):
        worst = 0
        with opened(page_of(OURS)) as page:
            place = page.value("page.bar.centre")
            for year in range(1970, 2101, 10):
                time = f"{year}-{1 + year // 10 % 12:02}-11T{13 + year // 10 % 9}:30Z"
                true = json.loads(relevo("sun", "position", "--at", f"{place['lat']},{place['lon']},500", "--time", time, "--json"))
                sun = page.value(f"sunAt(page.ground.meta, Date.parse('{time}') / 1000, {place['lat']}, {place['lon']})")
                e = np.radians(true["apparent_elevation_deg"])
                worst = max(worst, abs(sun["apparent"] - true["apparent_elevation_deg"]),
                            abs((sun["azimuth"] - true["azimuth_deg"] + 180) % 360 - 180) * np.cos(e))
        print(f"sun, 1970 to 2100: at most {worst:.4f} degrees off")
        self.assertLess(worst, 0.01)

    def test_damaged_blocks_are_named(self):
        good, page = page_of(OURS), {}
        data = data_of(good)
        blocks = {b["name"]: b for b in about_of(data)["blocks"]}
        first = 12 + struct.unpack("<I", data[8:12])[0]
        flipped = bytearray(data)
        flipped[first + blocks["sky_view"]["offset"] + 9] ^= 1
        page["sky_view"] = with_data(good, flipped, "flipped")
        page["colour"] = with_data(good, data[:-1000], "cut")

        def swap(about):
            a, b = about["blocks"][:2]
            for key in ("offset", "length", "crc32"):
                a[key], b[key] = b[key], a[key]
        page["heights"] = with_about(good, swap, "swapped")

        for block, path in page.items():
            self.failure(path, f'"{block}"')
        self.failure(with_about(good, lambda about: about["blocks"][0].update(size=1 << 40), "large"), '"heights"')
        bomb = zlib.compress(bytes(1 << 24), 9)

        def burst(about):
            about["blocks"][0].update(offset=0, length=len(bomb), crc32=zlib.crc32(bomb))
        whole = with_about(good, burst, "bomb")
        bytes_ = data_of(whole)
        start = 12 + struct.unpack("<I", bytes_[8:12])[0]
        self.failure(with_data(whole, bytes_[:start] + bomb + bytes_[start + len(bomb):], "bomb"), '"heights"')
        version = bytearray(data)
        version[4] = 9
        self.failure(with_data(good, version, "version"), "version 9")

    def failure(self, path, words):
        with opened(path) as page:
            said = page.value("document.getElementById('message').textContent")
            self.assertIn(words, said, path.name)

    def test_nothing_leaves_and_names_are_text(self):
        dem = pathlib.Path(FOLDER.name) / "<img src=x onerror=alert(1)>&amp;.tif"
        shutil.copy(OURS, dem)
        path = page_of(dem, "--title", "</title><script>document.body.remove()</script>", "--attribution", "<b>Me</b>", name="names")
        with opened(path) as page:
            page.wait("!!page.light")
            self.assertEqual(page.requests(), [path.as_uri()])
            self.assertEqual([c for c in page.complaints() if "GPU stall" not in c], [])
            self.assertEqual(page.value("document.title"), "</title><script>document.body.remove()</script>")
            self.assertIn("<b>Me</b>", page.value("document.getElementById('credits').textContent"))
            refused = page.value("fetch('https://example.org').then(() => 'sent', e => 'refused')")
            self.assertEqual(refused, "refused")

    def test_the_first_view_is_the_picture(self):
        path = page_of(OURS)
        data = data_of(path)
        block = next(b for b in about_of(data)["blocks"] if b["name"] == "still")
        first = 12 + struct.unpack("<I", data[8:12])[0] + block["offset"]
        grey = []
        with rasterio.MemoryFile(bytes(data[first:first + block["length"]])) as file, file.open() as picture:
            grey.append(picture.read().mean(axis=0))
        with opened(path) as page:
            page.wait("!!page.light")
            page.value("for (const id of ['bar', 'tools', 'name']) document.getElementById(id).hidden = true")
            page.value("new Promise(done => setTimeout(done, 700))")
            page.screenshot(f"{FOLDER.name}/view.png")
        with rasterio.open(f"{FOLDER.name}/view.png") as picture:
            grey.append(picture.read()[:3].mean(axis=0))
        lower = [g.reshape(63, 10, 120, 10).mean(axis=(1, 3))[25:].ravel() for g in grey]   # ground alone
        likeness = np.corrcoef(*lower)[0, 1]
        print(f"first view and picture: correlation {likeness:.3f}, mean {lower[1].mean():.0f} for {lower[0].mean():.0f}")
        self.assertGreater(likeness, 0.8)

    def test_megabytes_are_met(self):
        dem = pathlib.Path(FOLDER.name) / "rough.tif"
        random = np.random.default_rng(1).normal(0, 3, (1024, 1024)).cumsum(0).cumsum(1) / 40
        with rasterio.open(dem, "w", driver="GTiff", width=1024, height=1024, count=1, dtype="float32", crs="EPSG:32632",
                           transform=rasterio.Affine(30, 0, 500000, 0, -30, 5200000)) as file:
            file.write(random.astype("float32"), 1)
        for megabytes in (0.5, 1.0, 2.5):
            size = page_of(dem, "--megabytes", str(megabytes), name=f"rough{megabytes}").stat().st_size / 1e6
            print(f"--megabytes {megabytes}: {size:.3f}")
            self.assertLessEqual(size, megabytes)
            if megabytes < 2:   # the largest has the best of all
                self.assertGreater(size, 0.95 * megabytes)
        self.assertIn("--megabytes", relevo("export", "web", dem, "-o", f"{FOLDER.name}/n.html", "--megabytes", "0.2", fails=True))
        with opened(page_of(dem, name="rough2.5")) as page:
            page.wait("!!page.light")
            start = page.value("page.start_ms")
            moving, still = (page.value(f"""(() => {{
                const began = performance.now();
                for (let n = 0; n < {count}; n++) {{ page.frame({every}, {ratio}); page.drawer.finish(); }}
                return (performance.now() - began) / {count};
            }})()""") for every, ratio, count in ((6, 0.5, 10), (2, 1, 3)))
            held = page.value("page.drawer.bytes + page.ground.height.byteLength + page.light.byteLength") / 1e6
            print(f"1024 x 1024 posts: starts in {start:.0f} ms, frames in {moving:.0f} ms, at rest {still:.0f}, buffers {held:.0f} MB")
            self.assertLess(held, 100)

    def test_without_webgl2_there_is_a_picture(self):
        with opened(page_of(OURS), "--disable-3d-apis") as page:
            self.assertIn("no WebGL2", page.value("document.getElementById('message').textContent"))
            page.wait("document.getElementById('still').naturalWidth === 1200")

    def test_a_lost_context_leaves_the_picture(self):
        with opened(page_of(OURS)) as page:
            page.wait("!!page.light")
            page.value("page.drawer.gl.getExtension('WEBGL_lose_context').loseContext()")
            page.wait("!document.getElementById('still').hidden")
            self.assertIn("Reload", page.value("document.getElementById('message').textContent"))

    def test_a_folder_is_for_a_server(self):
        folder = pathlib.Path(FOLDER.name) / "site"
        relevo("export", "web", OURS, "--folder", "-o", folder)
        self.assertEqual(sorted(p.name for p in folder.iterdir()), ["data.rlvw", "index.html", "preview.jpg"])
        handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=folder)
        handler.log_message = lambda *_: None
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            url = f"http://127.0.0.1:{server.server_port}/"
            with chromium.Page(url) as page:
                page.wait("!!page.light")
                self.assertEqual([r for r in page.requests() if "favicon" not in r], [url, url + "data.rlvw"])
            server.shutdown()

    def test_a_hash_and_keys(self):
        path = page_of(OURS)
        with chromium.Page(path.as_uri() + "#t=1800000000&x=100&z=-200&az=90&tilt=30&d=9000") as page:
            page.wait(READY)
            self.assertEqual(page.value("[page.bar.unix, page.view.x, page.view.z, page.view.azimuth, page.view.tilt, page.view.distance]"),
                             [1800000000, 100, -200, 90, 30, 9000])
            for key, code in (("ArrowLeft", 37), (".", 190)):
                page.send("Input.dispatchKeyEvent", type="keyDown", key=key, windowsVirtualKeyCode=code)
            self.assertEqual(page.value("[page.view.azimuth, page.bar.unix]"), [95, 1800000600])
            page.wait("location.hash.includes('az=95') && location.hash.includes('t=1800000600')")

    @unittest.skipUnless(os.environ.get("RELEVO_AXE"), "RELEVO_AXE is not set")
    def test_accessibility(self):
        with opened(page_of(OURS)) as page:
            page.wait("!!page.light")
            page.value("page.choose({column: 200, row: 200, height: 0})")
            page.value(pathlib.Path(os.environ["RELEVO_AXE"]).read_text() + "; 0")
            found = page.value("axe.run().then(r => r.violations.map(v => v.id + ': ' + v.nodes.map(n => n.html.slice(0, 60)).join(' | ')))")
            self.assertEqual(found, [])


def seconds(iso):
    return datetime.datetime.fromisoformat(iso.replace("Z", "+00:00")).timestamp()


if __name__ == "__main__":
    if not shutil.which("chromium"):
        print("skipped: Chromium is not installed")
        sys.exit(77)
    try:
        unittest.main(verbosity=1)
    finally:
        FOLDER.cleanup()
