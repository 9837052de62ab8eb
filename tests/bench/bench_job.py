#!/usr/bin/env python3
"""What `relevo run` costs beside single frames, and whether its pictures hang on how it was run: the day of
docs/jobs.md, 96 pictures of 1280 x 1024, with every effect on.

Usage: bench_job.py [BUILD] [--device NAME] [--without EFFECTS] [--kills N] [--size WxH] [--cost]

BUILD: build/release (default)

Prints
- processor and wall time of the job for each picture, and the processor time of a frame whose sun is moved
  (`capture --repeat`, mean of every third hour of that day), with their ratio: machines that do other work as well
  spoil wall times only. What opening takes, as a job of one picture has it, is told apart;
- whether four shards, one after the other, give the bytes of the whole;
- whether N runs with --resume that SIGKILL ends at random moments leave whole pictures alone, and a last one gives the
  files of the whole.
Exits with 1 where a picture differs.
"""

import argparse
import hashlib
import json
import os
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOURS = [f"{hour:02}:00" for hour in range(0, 24, 3)]


def shown_job():
    """The day of docs/jobs.md, as it stands there."""
    text = (ROOT / "docs/jobs.md").read_text(encoding="utf-8")
    begin = text.index("```json day.json\n") + len("```json day.json\n")
    return json.loads(text[begin:text.index("```", begin)])


def every_effect(program, without):
    listed = subprocess.run([program, "plugins", "list"], check=True, capture_output=True, text=True).stdout
    return [line.split()[0] for line in listed.splitlines() if line and line.split()[0] not in without]


def files_of(folder):
    return {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class Job:
    def __init__(self, arguments, folder):
        self.program = arguments.build / "bin/relevo"
        self.folder = folder
        effects = every_effect(self.program, arguments.without.split(","))
        print(f"effects: {', '.join(effects)}")
        self.of_all = ["--enable", ",".join(effects), "--size", arguments.size, "--device", arguments.device]
        job = shown_job()
        job["dem"]["files"] = [str(ROOT / "data/dem/jacksboro.tif")]
        job["output"] = "out/{time:%H%M}.png"
        self.file = folder / "job.json"
        self.file.write_text(json.dumps(job), encoding="utf-8")
        self.date = job["time"]["date"]

    def command(self, *more):
        return [self.program, "-q", "run", self.file, *self.of_all, *more]

    def take(self):
        """The files that were made; the folder is free again."""
        files = files_of(self.folder / "out")
        for path in (self.folder / "out").iterdir():
            path.unlink()
        return files

    def frame_ms(self, hour):
        """Processor time of a frame with the sun moved."""
        timings = self.folder / "timings.json"
        subprocess.run([self.program, "-q", "capture", ROOT / "data/dem/jacksboro.tif", "--time", f"{self.date}T{hour}",
                        "-o", self.folder / "one.png", "--overwrite", "--timings", timings, "--repeat", "8",
                        "--allow-blank", *self.of_all], check=True)
        return json.loads(timings.read_text(encoding="utf-8"))["frames_with_sun_moved"]["processor_ms"]


def times(command):
    """@returns wall and processor time [s]"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    subprocess.run(command, check=True)
    wall = time.monotonic() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def cost(job):
    """@returns the files of the whole job, and how long it took [s]"""
    wall, processor = times(job.command())
    whole = job.take()
    one_wall, one = times(job.command("--shard", f"{len(whole) // 2}/{len(whole)}"))
    job.take()
    frame = sum(job.frame_ms(hour) for hour in HOURS) / len(HOURS)
    more = len(whole) - 1
    print(f"a job of one picture takes {one_wall:.1f} s of wall time and {one:.1f} s of processor time; each of the "
          f"{more} others {1e3 * (wall - one_wall) / more:.0f} ms and {1e3 * (processor - one) / more:.0f} ms, encoding "
          f"included; a frame with the sun moved {frame:.0f} ms of processor time: "
          f"{1e3 * (processor - one) / more / frame:.2f} times")
    return whole, wall


def shards(job, whole):
    for shard in range(1, 5):
        subprocess.run(job.command("--shard", f"{shard}/4"), check=True)
    same = job.take() == whole
    print(f"four shards: {'the bytes of the whole' if same else 'OTHER BYTES than the whole'}")
    return same


def killed(job, whole, kills, wall_s):
    random.seed(96)
    broken = 0
    reached = []
    for _ in range(kills):
        process = subprocess.Popen(job.command("--resume"))
        time.sleep(random.uniform(0.2, wall_s / 4))
        process.send_signal(signal.SIGKILL)
        ended = process.wait()
        if ended not in (-signal.SIGKILL, 0):
            print(f"a run ended by itself with {ended}")
            broken += 1
        there = files_of(job.folder / "out") if (job.folder / "out").exists() else {}
        broken += sum(whole.get(name) != content for name, content in there.items())
        reached.append(len(there))
    subprocess.run(job.command("--resume"), check=True)
    same = job.take() == whole
    print(f"{kills} times SIGKILL, with {', '.join(map(str, reached))} pictures there: {broken} of them not whole; "
          f"--resume gives {'the files of the whole' if same else 'OTHER FILES'}")
    return same and broken == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--without", default="vsm,tint,layering",
                        help="vsm excludes shadows, layering cover; tint hides the ground")
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--size", default="1280x1024")
    parser.add_argument("--cost", action="store_true", help="nothing but that")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        job = Job(arguments, pathlib.Path(name))
        print(f"processors: {len(os.sched_getaffinity(0))}, load before: {os.getloadavg()[0]:.1f}", flush=True)
        whole, wall_s = cost(job)
        sys.stdout.flush()
        if arguments.cost:
            return
        good = shards(job, whole)
        sys.stdout.flush()
        good &= killed(job, whole, arguments.kills, wall_s)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
