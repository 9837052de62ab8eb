"""A display of Xvfb whose pictures are read and whose mouse and keys are moved, for benches of the window."""

import ctypes
import mmap
import os
import pathlib
import struct
import subprocess
import tempfile
import time

WIDTH, HEIGHT = 1280, 800
COLUMNS = range(500, 1200, 7)  # beside the panel
ROWS = (150, 250, 350, 450, 550, 650)


class Screen:
    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        reads, writes = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-noreset", "-displayfd", str(writes), "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", self.folder.name],
            pass_fds=(writes,), stderr=subprocess.DEVNULL)
        os.close(writes)
        with os.fdopen(reads) as number:
            self.name = ":" + number.readline().strip()
        with open(pathlib.Path(self.folder.name) / "Xvfb_screen0", "rb") as file:
            self.map = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        head = struct.unpack(">25I", self.map[:100])
        self.stride, self.begin = head[12], head[0] + 12 * head[19]
        # A program for every move would take half of the processors that are to be measured.
        self.x11, self.xtest = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXtst.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.display = ctypes.c_void_p(self.x11.XOpenDisplay(self.name.encode()))

    def sample(self):
        pieces = []
        for row in ROWS:
            at = self.begin + row * self.stride
            line = self.map[at:at + self.stride]
            pieces.append(bytes(line[4 * x] for x in COLUMNS))
        return b"".join(pieces)

    def act(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env={**os.environ, "DISPLAY": self.name}, check=True,
                       stdout=subprocess.DEVNULL)

    def move(self, x, y):
        self.xtest.XTestFakeMotionEvent(self.display, -1, x, y, ctypes.c_ulong(0))
        self.x11.XFlush(self.display)

    def click(self, button):
        for is_press in (1, 0):
            self.xtest.XTestFakeButtonEvent(self.display, button, is_press, ctypes.c_ulong(0))
        self.x11.XFlush(self.display)

    def close(self):
        self.x11.XCloseDisplay(self.display)
        self.server.terminate()
        self.server.wait()


def wait_for_picture(screen, began, most_s=30, viewer=None):
    """Seconds from `began` to a picture of the ground, which `viewer` must live to see."""
    while time.perf_counter() - began < most_s:
        if viewer and viewer.poll() is not None:
            raise RuntimeError(f"{viewer.args} ended with {viewer.returncode}")
        sample = screen.sample()
        if len(set(sample)) > 40:
            return time.perf_counter() - began
        time.sleep(0.005)
    raise RuntimeError(f"no picture within {most_s} s")


def sharp_after_s(screen):
    """From now until nothing has changed for two seconds."""
    began = changed = time.perf_counter()
    before = screen.sample()
    while time.perf_counter() - changed < 2:
        now = screen.sample()
        if now != before:
            before, changed = now, time.perf_counter()
        time.sleep(0.005)
    return changed - began


def wait_until_gone(screen):
    """Until the window has gone from the screen."""
    while len(set(screen.sample())) > 40:
        time.sleep(0.05)


def processor_s(process):
    """Of all threads so far."""
    text = pathlib.Path(f"/proc/{process.pid}/stat").read_text()
    words = text[text.rindex(")") + 2:].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")
