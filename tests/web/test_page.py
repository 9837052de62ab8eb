#!/usr/bin/env python3
"""The page in headless Chromium, from file://: test_page.py RELEVO DEM...

Prints and requires: shade equal to `sun shadow`; the names of damaged blocks. Exits 77 where Chromium is not installed.
"""

import base64
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import rasterio

    import make_page
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

PROBE = """<script>
const probe = setInterval(() => {
  let spent = 0;   // virtual time does not wait for the worker, so the page spends real time
  for (let k = 0; k < 3e7; k++) spent += k;
  if (!document.body.dataset.failed && !page.light) return spent;
  clearInterval(probe);
  const out = document.createElement('pre');
  out.id = 'out';
  const s = page.bar && sunAt(page.ground.meta, page.bar.unix, page.bar.centre.lat, page.bar.centre.lon);
  let shade = '';
  if (page.light) for (let i = 0; i < page.light.length; i += 4096)
    shade += String.fromCharCode(...page.light.subarray(i, i + 4096).map(v => v < 128 ? 1 : 0));
  out.textContent = btoa(JSON.stringify({failed: document.body.dataset.failed ? document.getElementById('message').textContent : '',
    shade: btoa(shade), sun: s, bytes: page.drawer && page.drawer.bytes, place: page.bar && page.bar.centre, start_ms: page.start_ms}));
  document.body.append(out);
}, 20);
</script>"""


def answer(chromium, folder, data):
    """What the page of this data says of itself."""
    file = pathlib.Path(folder) / "page.html"
    file.write_text(make_page.page(data).replace("</body>", PROBE + "</body>"))
    dom = subprocess.run([chromium, "--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--window-size=640,400",
                          f"--user-data-dir={folder}/profile", "--virtual-time-budget=9000", "--dump-dom", file.as_uri()],
                         capture_output=True, text=True, timeout=120, check=True).stdout
    found = re.search(r'<pre id="out">([A-Za-z0-9+/=]+)', dom)
    if not found:
        sys.exit("the page gave no answer")
    return json.loads(base64.b64decode(found[1]))


def mask(relevo, folder, dem, time):
    subprocess.run([relevo, "sun", "shadow", dem, "--time", time, "-o", f"{folder}/mask.tif", "--overwrite"],
                   capture_output=True, check=True)
    with rasterio.open(f"{folder}/mask.tif") as raster:
        return raster.read(1)


def check_shade(chromium, relevo, folder, dem, time):
    page = answer(chromium, folder, make_page.container(dem, time))
    true = mask(relevo, folder, dem, time)
    shade = np.frombuffer(base64.b64decode(page["shade"]), "u1").reshape(true.shape)[true != 255] == 1
    dark = true[true != 255] == 0
    equal, overlap = (shade == dark).mean(), (shade & dark).sum() / (shade | dark).sum()
    print(f"{dem}: shade {dark.mean():.1%}, equal {equal:.2%}, IoU {overlap:.4f}, start {page['start_ms']:.0f} ms, "
          f"buffers {page['bytes'] / 1e6:.1f} MB, sun {page['sun']['apparent']:.2f}")
    return equal >= 0.995 and overlap >= 0.97


def check_damage(chromium, folder, dem, time):
    data = bytearray(make_page.container(dem, time))
    data[-100] ^= 1
    good = "heights" in answer(chromium, folder, bytes(data))["failed"]
    cut = "heights" in answer(chromium, folder, make_page.container(dem, time)[:-1000])["failed"]
    print(f"damaged block named: {good}, cut block named: {cut}")
    return good and cut


def main():
    chromium = shutil.which("chromium")
    if not chromium:
        print("skipped: Chromium is not installed")
        sys.exit(77)
    relevo, time, dems = sys.argv[1], sys.argv[2], sys.argv[3:]
    with tempfile.TemporaryDirectory() as folder:
        results = [check_shade(chromium, relevo, folder, dem, time) for dem in dems]
        results.append(check_damage(chromium, folder, dems[0], time))
    sys.exit(0 if all(results) else 1)


main()
