#!/usr/bin/env python3
"""Random input to the window: keys, clicks, drags, the wheel, other sizes, files that change. The window has to stay, to
report nothing of GL, to keep its memory (at rest after each minute, from the second one on) and to end with status 0.

    tests/window/random_input.py build/dev/bin/relevo [--seconds 600] [--seed 7]    needs Xvfb and xdotool

Prints memory by the minute and what the window wrote, each line once.
"""
import argparse
import collections
import os
import pathlib
import random
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/bench"))
from screen import HEIGHT, WIDTH, Screen, wait_for_picture  # noqa: E402

KEYS = """t n g w a s d q e bracketright bracketleft braceright braceleft space c Tab h m F5 Up Down Left Right Prior Next
    Home o p f b l 1 2 Return BackSpace F6 F1 F12 Escape Escape Escape ctrl+z ctrl+z ctrl+y ctrl+c ctrl+f ctrl+p ctrl+s
    ctrl+j ctrl+e ctrl+Next ctrl+Prior""".split()
TEXTS = "36.3, -84.2|Jacksboro|12:30|2026-12-21|1e9|-5|albedo|?".split("|")
SIZES = [(WIDTH, HEIGHT), (1000, 700), (640, 480), (300, 30), (1, 1)]
MOST_GROWTH = 1.05  # of the memory at rest


class Hand:
    def __init__(self, screen, window, plugin, seed):
        self.screen, self.window, self.plugin, self.random = screen, window, plugin, random.Random(seed)
        self.last = collections.deque(maxlen=12)  # acts

    def act(self):
        acts = {self.drag: 6, self.click: 5, self.wheel: 3, self.key: 14, self.type: 1, self.resize: 1, self.write: 1}
        self.random.choices(list(acts), acts.values())[0]()

    def do(self, *words):
        self.last.append(" ".join(map(str, words)))
        self.screen.act(*words)

    def place(self):
        """On the window, but for the menu File, whose last line ends it."""
        while True:
            x, y = self.random.randrange(WIDTH), self.random.randrange(HEIGHT)
            if x > 80 or y > 50:
                return x, y

    def drag(self):
        (x, y), button = self.place(), self.random.choice((1, 1, 2, 3))
        dx, dy = self.random.randint(-200, 200), self.random.randint(-150, 150)
        self.do("mousemove", x, y, "sleep", "0.1", "mousedown", button)
        for step in range(1, 6):
            self.screen.move(x + dx * step // 5, y + dy * step // 5)
            time.sleep(0.05)
        self.do("mouseup", button)

    def click(self):
        repeat = self.random.choice((1, 1, 1, 2))
        self.do("mousemove", *self.place(), "sleep", "0.1", "click", "--repeat", repeat, "--delay", 60,
                        self.random.choice((1, 1, 1, 3)))

    def wheel(self):
        self.do("mousemove", *self.place(), "click", "--repeat", 5, "--delay", 20, self.random.choice((4, 5)))

    def key(self):
        self.do("key", "--repeat", self.random.choice((1, 1, 3)), "--delay", 40, self.random.choice(KEYS))

    def type(self):
        self.do("type", "--delay", 20, "--", self.random.choice(TEXTS))

    def resize(self):
        for width, height in (self.random.choice(SIZES), SIZES[0]):
            self.do("windowsize", self.window, width, height, "sleep", "0.3")

    def write(self):
        """An effect, right or wrong."""
        added = self.random.choice(("0.1", "0.2", "nothing"))
        self.last.append(f"write {added}")
        self.plugin.write_text(f"void paint_on_lit(in Surface s, inout vec3 radiance) {{ radiance.b += {added}; }}\n")


    def rest(self):
        """Shows the first DEM from above: opening a DEM ends sheets, films, overlays and comparisons."""
        for _ in range(6):
            self.do("key", "--delay", 100, "Escape", "Escape", "Escape", "ctrl+Next", "sleep", 4, "key", "t", "sleep", 4)
            title = subprocess.run(["xdotool", "getwindowname", self.window], env=os.environ | {"DISPLAY": self.screen.name},
                                   capture_output=True, text=True).stdout
            if "jacksboro" in title:
                return


def resident_mib(process):
    words = pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()
    return int(words[1]) * os.sysconf("SC_PAGESIZE") / 2**20


def prepare(folder):
    """Two DEMs and an effect. Returns the effect's file."""
    for dem in (ROOT / "data/dem").glob("*.tif"):
        shutil.copy(dem, folder)
    plugin = folder / "plugins/paint"
    plugin.mkdir(parents=True)
    (plugin / "plugin.json").write_text('{"format": 1, "id": "paint", "name": "Paint", "version": "1.0.0"}')
    (plugin / "paint.glsl").write_text("void paint_on_lit(in Surface s, inout vec3 radiance) { radiance.b += 0.1; }\n")
    return plugin / "paint.glsl"


def play(hand, window, seconds):
    """Returns the memory at rest after each minute [MiB]."""
    began, rests, most, acts = time.monotonic(), [], 0, 0
    while (passed := time.monotonic() - began) < seconds and window.poll() is None:
        try:
            hand.act()
            most = max(most, resident_mib(window))
            acts += 1
            if passed > 60 * (len(rests) + 1) - 15:
                hand.rest()
                rests.append(resident_mib(window))
                print(f"[ measured ] minute {len(rests)}: at rest {rests[-1]:.0f} MiB, at most {most:.0f} MiB", flush=True)
                most = 0
        except (subprocess.CalledProcessError, FileNotFoundError, IndexError):
            time.sleep(1)
            if window.poll() is None:
                raise
            break  # it ended under the hand
    print(f"[ measured ] {acts} acts in {passed:.0f} s")
    return rests


def end(screen, window, patience_s):
    """Asks it to end, twice: a film that is being drawn has it ask back. Returns its status; None: it goes on."""
    until = time.monotonic() + patience_s
    while window.poll() is None and time.monotonic() < until:
        screen.act("key", "--delay", 100, "Escape", "Escape", "Escape", "ctrl+q", "ctrl+q")
        try:
            window.wait(5)
        except subprocess.TimeoutExpired:
            pass
    return window.poll()


def faults(status, memory, lines):
    if status is None:
        yield "the window does not end"
    elif status != 0:
        yield f"the window ended with status {status}"
    yield from (f"the window wrote: {line}" for line in lines if ": gl: " in line or "SUMMARY: " in line)
    settled = memory[1:] or memory
    sanitized = "TSAN_OPTIONS" in os.environ or "ASAN_OPTIONS" in os.environ  # these keep what is freed
    if settled and settled[-1] > MOST_GROWTH * settled[0] and not sanitized:
        yield f"memory grew from {settled[0]:.0f} to {settled[-1]:.0f} MiB"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--patience", type=float, default=60, help="seconds for the first picture, and for the end")
    arguments = parser.parse_args()
    screen = Screen()
    folder = pathlib.Path(screen.folder.name)
    plugin = prepare(folder)
    environment = os.environ | {"DISPLAY": screen.name, "WAYLAND_DISPLAY": "", "XDG_CONFIG_HOME": str(folder),
                                "XDG_STATE_HOME": str(folder)}
    output = folder / "output.txt"
    with open(output, "w") as file:
        window = subprocess.Popen(
            [arguments.program.resolve(), "jacksboro.tif", "--plugin-path", "plugins"], cwd=folder, env=environment,
            stdout=file, stderr=file)
    try:
        wait_for_picture(screen, time.perf_counter(), arguments.patience, window)
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--pid", str(window.pid)], env=environment,
                               capture_output=True, text=True, check=True).stdout.split()
        hand = Hand(screen, found[0], plugin, arguments.seed)
        memory = play(hand, window, arguments.seconds)
        status = end(screen, window, arguments.patience)
    finally:
        if window.poll() is None:
            window.kill()
        window.wait()
        lines = output.read_text(errors="replace").splitlines()
        screen.close()
    for line, count in collections.Counter(lines).items():
        print(f"{count} x {line}")
    if found := list(faults(status, memory, lines)):
        sys.exit("\n".join([f"seed {arguments.seed}; the last acts were", *hand.last, *found]))


if __name__ == "__main__":
    main()
