#!/usr/bin/env python3
"""How quick the window is: first picture, pictures a second while the hand moves, input to picture.

Usage: bench_viewer.py BUILD [DEM...]   (BUILD is build/release or build/dev; needs Xvfb and xdotool)

Everything is read off the screen of a display of its own (Xvfb's screen is a file), as a person would see it. With both
ways of presentation (RELEVO_PRESENT) it also counts what a frame asks of the GL device while the camera orbits. Bytes
written to ring buffers are not counted: they are mapped memory, without a command.
"""

import os
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile
import time

from screen import Screen, processor_s, sharp_after_s, wait_for_picture, wait_until_gone


def settle(screen):
    before, since = screen.sample(), time.perf_counter()
    while time.perf_counter() - since < 0.5:
        now = screen.sample()
        if now != before:
            before, since = now, time.perf_counter()
        time.sleep(0.01)


def pictures_a_second(screen, move, seconds=4):
    """Distinct pictures on the screen while `move` is called again and again."""
    count, before, began, turn = 0, screen.sample(), time.perf_counter(), 0
    while time.perf_counter() - began < seconds:
        move(turn)
        turn += 1
        until = time.perf_counter() + 0.016
        while time.perf_counter() < until:
            now = screen.sample()
            if now != before:
                count, before = count + 1, now
            time.sleep(0.003)
    return count / seconds


def latencies_ms(screen, move, times=40):
    result = []
    for turn in range(times):
        settle(screen)
        before, began = screen.sample(), time.perf_counter()
        move(turn)
        while screen.sample() == before and time.perf_counter() - began < 3:
            time.sleep(0.001)
        result.append(1e3 * (time.perf_counter() - began))
    return sorted(result)


def bar_ms(screen, times=20):
    """From a notch of the wheel on the time bar to the first other picture, which is coarse, and to the full one."""
    coarse, full = [], []
    screen.act("mousemove", 700, 765)
    for turn in range(times):
        settle(screen)
        before, began = screen.sample(), time.perf_counter()
        screen.click(4 + turn % 2)
        while screen.sample() == before and time.perf_counter() - began < 3:
            time.sleep(0.001)
        coarse.append(1e3 * (time.perf_counter() - began))
        full.append(coarse[-1] + 1e3 * sharp_after_s(screen))
    return statistics.median(coarse), statistics.median(full)


def first_start(program, arguments, env, screen):
    """Seconds, and seconds of processor time, to the first picture where the driver keeps no programs yet."""
    with tempfile.TemporaryDirectory() as cache:
        began = time.perf_counter()
        viewer = subprocess.Popen([program, "-q", *arguments], env={**env, "MESA_SHADER_CACHE_DIR": cache}, cwd=screen.folder.name)
        try:
            return wait_for_picture(screen, began), processor_s(viewer)
        finally:
            viewer.terminate()
            viewer.wait()


def count_gl(program, arguments, env, screen, presentation):
    """Per frame of the scene: draws, bytes of buffers and of textures written, bytes read, reads, waits."""
    library = pathlib.Path(program).parent.parent / "tests/modules/count_gl.so"
    if not library.exists():
        return
    counts = pathlib.Path(screen.folder.name) / "counts"
    read = lambda: struct.unpack("7Q", counts.read_bytes())
    viewer = subprocess.Popen([program, "-q", *arguments], cwd=screen.folder.name, env={
        **env, "RELEVO_PRESENT": presentation, "LD_PRELOAD": str(library), "RELEVO_COUNT_GL": str(counts)})
    try:
        wait_for_picture(screen, time.perf_counter())
        settle(screen)
        screen.act("mousemove", 850, 400)
        screen.act("mousedown", 3)
        before = read()
        shown = pictures_a_second(screen, lambda i: screen.move(850 + 3 * (i % 60), 400))
        frames, *figures = [after - first for after, first in zip(read(), before)]
        screen.act("mouseup", 3)
        draws, buffers, textures, back, reads, waits = [figure / max(1, frames) for figure in figures]
        print(f"  {presentation}: {shown:.1f} pictures/s; a frame: {draws:.1f} draws, {buffers / 1e3:.0f} kB written to "
              f"buffers and {textures / 1e3:.0f} kB to textures, {back / 1e3:.0f} kB read in {reads:.1f} reads, "
              f"{waits:.1f} waits")
    finally:
        viewer.terminate()
        viewer.wait()
        wait_until_gone(screen)


def bench(program, dem):
    arguments = [dem] if dem else []
    screen = Screen()
    env = {**os.environ, "DISPLAY": screen.name, "WAYLAND_DISPLAY": "",
           "XDG_CONFIG_HOME": screen.folder.name, "XDG_STATE_HOME": screen.folder.name}
    cold_s, cold_used_s = first_start(program, arguments, env, screen)
    wait_until_gone(screen)
    began = time.perf_counter()
    viewer = subprocess.Popen([program, "-q", *arguments], env=env, cwd=screen.folder.name)
    try:
        first_s = wait_for_picture(screen, began)
        settle(screen)
        screen.act("mousemove", 850, 400)
        screen.act("mousedown", 3)
        used_s = processor_s(viewer)
        orbit = pictures_a_second(screen, lambda i: screen.move(850 + 3 * (i % 60), 400))
        used_ms = 1e3 * (processor_s(viewer) - used_s) / max(1, 4 * orbit)
        sharp_s = sharp_after_s(screen)
        held = screen.sample()
        screen.act("mouseup", 3)
        settle(screen)
        if screen.sample() != held:  # what came to rest was not the sharp picture
            sharp_s = float("inf")
        screen.act("mousedown", 3)
        delays = latencies_ms(screen, lambda i: screen.move(850 + 5 * (i % 30), 400))
        screen.act("mouseup", 3)
        settle(screen)
        screen.act("key", "space")
        sun = pictures_a_second(screen, lambda i: time.sleep(0.001))
        screen.act("key", "space")
        settle(screen)
        coarse_ms, full_ms = bar_ms(screen)
        time.sleep(2)
        used_s = processor_s(viewer)
        time.sleep(5)
        idle = (processor_s(viewer) - used_s) / 5
        print(f"{dem or 'bundled DEM'}: first picture {first_s:.2f} s, without kept programs {cold_s:.2f} s "
              f"({cold_used_s:.2f} s of processor time); orbiting {orbit:.1f} pictures/s; "
              f"sun moving {sun:.1f} pictures/s; input to picture median {statistics.median(delays):.0f} ms, "
              f"95 % {delays[int(0.95 * len(delays))]:.0f} ms; time bar to coarse picture {coarse_ms:.0f} ms, to full picture "
              f"{full_ms:.0f} ms; sharp {sharp_s:.2f} s after the last move; "
              f"{used_ms:.0f} ms of processor time a picture; idle {100 * idle:.1f} % of a processor")
    finally:
        viewer.terminate()
        viewer.wait()
    try:
        wait_until_gone(screen)
        for presentation in ("copy", "shared"):
            count_gl(program, arguments, env, screen, presentation)
    finally:
        screen.close()


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    program = str(pathlib.Path(sys.argv[1]).resolve() / "bin/relevo")
    for dem in sys.argv[2:] or [None]:
        bench(program, str(pathlib.Path(dem).resolve()) if dem else None)


main()
