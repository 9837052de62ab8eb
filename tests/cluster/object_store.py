#!/usr/bin/env python3
"""Has tasks write into an object store by others, s3rver, and compares with one process that writes into a folder: a
year of hours in tiles and a day of pictures, each in 1, 2 and 7 tasks.

Usage: object_store.py RELEVO DEM FOLDER. The folder is emptied first. Needs s3rver on the PATH (`npm install s3rver`,
and PATH=node_modules/.bin:$PATH). Ends with status 77 where it is not, and says so.
"""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request

from slurm import free_port, run, skip, tiles

LIMIT_S = 20
BUCKET = "/vsis3/bucket"


class Store:
    """s3rver on this computer, with its objects in a folder."""

    def __init__(self, folder):
        self.objects = folder / "objects"
        self.objects.mkdir()
        port = free_port()
        self.address = f"127.0.0.1:{port}"
        self.environment = dict(os.environ, AWS_S3_ENDPOINT=self.address, AWS_HTTPS="NO", AWS_VIRTUAL_HOSTING="FALSE",
                                AWS_ACCESS_KEY_ID="S3RVER", AWS_SECRET_ACCESS_KEY="S3RVER", AWS_REGION="us-east-1")
        self.process = subprocess.Popen(["s3rver", "-d", str(self.objects), "-a", "127.0.0.1", "-p", str(port),
                                         "--configure-bucket", "bucket"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        until = time.monotonic() + LIMIT_S
        while not self.answers():
            if time.monotonic() > until:
                sys.exit(f"s3rver does not answer within {LIMIT_S} s")
            time.sleep(0.2)

    def answers(self):
        try:
            urllib.request.urlopen(f"http://{self.address}/", timeout=2)
            return True
        except urllib.error.HTTPError:
            return True
        except OSError:
            return False

    def content(self, name):
        """The content of an object, as the store keeps it."""
        return (self.objects / "bucket" / f"{name}._S3rver_object").read_bytes()

    def names(self, ending):
        ending += "._S3rver_object"
        return sorted(str(path.relative_to(self.objects / "bucket"))[:-len("._S3rver_object")]
                      for path in (self.objects / "bucket").rglob("*" + ending))

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(10)


def hours(dem, folder):
    return ["-q", "sun", "hours", dem, "--year", "2026", "--tz", "UTC", "--tiles", 101, "-o", folder]


def job_of_pictures(dem, folder, where):
    job = folder / "day.json"
    job.write_text(f"""{{"format": 1, "dem": {{"files": ["{dem}"]}}, "picture": {{"size": [64, 48]}},
        "time": {{"at": "0:00", "date": "2026-06-21"}}, "effects": {{"only": []}},
        "sweep": [{{"times": {{"from": "6:00", "to": "19:00", "step": "1h"}}}}],
        "output": "{where}/{{time:%H%M}}.png"}}""")
    return ["-q", "run", job, "--device", "software"]


def in_tasks(relevo, store, tasks, words):
    for task in range(1, tasks + 1):
        run(relevo, *words, "--resume", "--shard", f"{task}/{tasks}", environment=store.environment)


def check_hours(relevo, store, dem, expected):
    for tasks in (1, 2, 7):
        where = f"hours{tasks}"
        in_tasks(relevo, store, tasks, hours(dem, f"{BUCKET}/{where}"))
        names = [name for name in store.names(".tif") if name.startswith(f"{where}/r")]
        if {name.split("/")[1]: store.content(name) for name in names} != expected:
            sys.exit(f"{tasks} tasks: the tiles in the store are others than those of one process")
        run(relevo, "merge", f"{BUCKET}/{where}", "-o", f"{BUCKET}/{where}/all.vrt", "--stac",
            f"{BUCKET}/{where}/all.json", environment=store.environment)
        for name in ("all.vrt", "all.json"):
            run(relevo, "info", f"{BUCKET}/{where}/{name}", "--unit", "m", environment=store.environment)


def check_missing(relevo, store, dem):
    in_tasks(relevo, store, 1, hours(dem, f"{BUCKET}/part") + ["--clip", "-84.4,36.3,-84.3,36.4"])
    name = [name for name in store.names(".tif") if name.startswith("part/r")][-1]
    (store.objects / "bucket" / f"{name}._S3rver_object").unlink()
    (store.objects / "bucket" / f"{name}._S3rver_metadata.json").unlink()
    merge = run(relevo, "merge", f"{BUCKET}/part", environment=store.environment, check=False)
    if merge.returncode != 1 or f"{BUCKET}/{name}: is missing" not in merge.stderr:
        sys.exit(f"the merge does not name what is missing: {merge.stderr}")


def check_pictures(relevo, store, dem, folder):
    (folder / "day").mkdir()
    run(relevo, *job_of_pictures(dem, folder, folder / "day"))
    expected = {path.name: path.read_bytes() for path in (folder / "day").glob("*.png")}
    for tasks in (1, 2, 7):
        words = job_of_pictures(dem, folder, f"{BUCKET}/day{tasks}")
        in_tasks(relevo, store, tasks, words)
        run(relevo, *words, "--missing", environment=store.environment)
        names = [name for name in store.names(".png") if name.startswith(f"day{tasks}/")]
        if {name.split("/")[1]: store.content(name) for name in names} != expected:
            sys.exit(f"{tasks} tasks: the pictures in the store are others than those of one process")
    return len(expected)


def main():
    relevo, dem, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    if not shutil.which("s3rver"):
        skip("s3rver is not installed")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run(relevo, *hours(dem, folder / "hours"))
    expected = tiles(folder / "hours")
    store = Store(folder)
    try:
        check_hours(relevo, store, dem, expected)
        check_missing(relevo, store, dem)
        pictures = check_pictures(relevo, store, dem, folder)
    finally:
        store.stop()
    print(f"{len(expected)} tiles of a year and {pictures} pictures of a day, of 1, 2 and 7 tasks, are those of one "
          "process")


if __name__ == "__main__":
    main()
