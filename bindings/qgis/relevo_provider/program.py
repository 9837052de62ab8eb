"""Relevo as the program `relevo`."""

from __future__ import annotations

import csv
import json
import os
import queue
import shlex
import shutil
import signal
import subprocess
import tempfile
import threading
from typing import Collection, List, Optional, Sequence, Tuple, Union

from .backend import Backend, Bounds, Cancelled, Dem, Direction, Options, Picture, RelevoError, Watch

_POLL_S = 0.1  # how soon a cancelled run ends
_PATIENCE_S = 5.0  # for a run that was asked to end
_BAD_INPUT = 3  # exit status, also of runs in which some points have no figures


def find(setting: str) -> Optional[str]:
    """The path of the program: that of the setting, else the one on PATH; None if there is none."""
    return shutil.which(setting) if setting else shutil.which("relevo")


class Program(Backend):
    def __init__(self, path: str) -> None:
        self._path = path

    def description(self) -> str:
        return f"{self._run(['--version'], Watch()).strip()} ({self._path})"

    def raster(
        self, figure: str, dem: Dem, options: Options, bounds: Optional[Bounds], output: str, watch: Watch
    ) -> None:
        words = ["sun", figure.replace("_", "-"), *_dem_words(dem), *_option_words(options)]
        if bounds is not None:
            words.append("--clip=" + ",".join(repr(edge) for edge in bounds))
        for line in self._run([*words, *_output_words(output)], watch).splitlines():
            watch.info(line)

    def horizons(
        self, dem: Dem, places: Sequence[Tuple[float, float]], eye_height_m: float, step_deg: float, watch: Watch
    ) -> List[Union[List[Direction], str]]:
        with tempfile.TemporaryDirectory() as folder:
            points = os.path.join(folder, "points.csv")
            with open(points, "w", encoding="utf-8", newline="") as file:
                rows = csv.writer(file)
                rows.writerow(["name", "lat", "lon"])
                rows.writerows([number, repr(lat), repr(lon)] for number, (lat, lon) in enumerate(places, 1))
            words = ["sun", "horizon", *_dem_words(dem), "--points", points, "--json"]
            words += _number("--eye-height", eye_height_m) + _number("--step", step_deg)
            text = self._run(words, watch, accepted=(0, _BAD_INPUT))
        return [one["error"] if "error" in one else _directions(one["horizon"]) for one in json.loads(text)]

    def capture(self, dem: Dem, picture: Picture, output: str, watch: Watch) -> None:
        self._run(["capture", *_dem_words(dem), *_picture_words(picture), *_output_words(output)], watch)

    def carpet(
        self, dem: Dem, place: Tuple[float, float], year: int, zone: Optional[str], output: str, table: Optional[str],
        watch: Watch,
    ) -> None:  # fmt: skip
        words = ["sun", "carpet", *_dem_words(dem), "--at", f"{place[0]!r},{place[1]!r}", "--year", str(year)]
        words += (["--tz", zone] if zone else []) + (["--csv"] if table else [])
        text = self._run([*words, *_output_words(output)], watch)
        if table:
            with open(table, "w", encoding="utf-8", newline="") as file:
                file.write(text)

    def _run(self, words: Sequence[str], watch: Watch, accepted: Collection[int] = (0,)) -> str:
        """Runs the program. @returns its standard output"""
        command = [self._path, "--progress", *words]
        watch.info(shlex.join(command))
        try:
            process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                encoding="utf-8", errors="replace", start_new_session=True,
            )  # fmt: skip
        except OSError as error:
            raise RelevoError(f"{self._path}: cannot be run: {error.strerror}") from error
        with process:
            return _Run(process, watch).finish(accepted)


class _Run:
    """A process: threads read its streams, the thread that waits hears of what they read."""

    def __init__(self, process: subprocess.Popen, watch: Watch) -> None:
        self._process = process
        self._watch = watch
        self._errors: List[str] = []
        self._lines: "queue.Queue[Optional[str]]" = queue.Queue()  # of standard error; None: it has ended
        self._output = ""

    def finish(self, accepted: Collection[int]) -> str:
        threads = [threading.Thread(target=self._read_lines), threading.Thread(target=self._read_output)]
        for thread in threads:
            thread.start()
        try:
            self._hear_all()
            status = self._process.wait()
        finally:
            if self._process.poll() is None:
                _end(self._process)
            for thread in threads:
                thread.join()
        if status in accepted and (status == 0 or self._output):
            for error in self._errors:
                self._watch.warning(error)
            return self._output
        raise RelevoError(self._sentence(status))

    def _read_lines(self) -> None:
        assert self._process.stderr
        for line in self._process.stderr:
            self._lines.put(line.rstrip("\n"))
        self._lines.put(None)

    def _read_output(self) -> None:
        assert self._process.stdout
        self._output = self._process.stdout.read()

    def _hear_all(self) -> None:
        while True:
            if self._watch.is_cancelled():
                raise Cancelled()
            try:
                line = self._lines.get(timeout=_POLL_S)
            except queue.Empty:
                continue
            if line is None:
                return
            self._hear(line)

    def _hear(self, line: str) -> None:
        if line.startswith("progress "):
            self._watch.progress(float(line.split()[1]))
        elif line.startswith("relevo: error: "):
            self._errors.append(line[len("relevo: error: ") :])
        elif line.startswith("relevo: warning: "):
            self._watch.warning(line[len("relevo: warning: ") :])
        else:
            self._watch.info(line[len("relevo: ") :] if line.startswith("relevo: ") else line)

    def _sentence(self, status: int) -> str:
        if self._errors:
            return "\n".join(self._errors)
        if status < 0:
            return f"relevo ended with the signal {signal.Signals(-status).name}"
        return f"relevo ended with status {status} and without a message"


def _end(process: subprocess.Popen) -> None:
    """Ends a process and those that it has started. Relevo removes what it was writing."""
    try:
        os.killpg(process.pid, signal.SIGTERM)
        process.wait(_PATIENCE_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    except ProcessLookupError:
        process.wait()


def _number(option: str, value: Optional[float]) -> List[str]:
    return [] if value is None else [option, repr(float(value))]


def _dem_words(dem: Dem) -> List[str]:
    words = [dem.file]
    if dem.crs:
        words += ["--crs", dem.crs]
    if dem.band:
        words += ["--band", str(dem.band)]
    if dem.surroundings:
        words += ["--surroundings", dem.surroundings]
    return words + (["--unit", dem.unit] if dem.unit else []) + list(dem.options)


def _option_words(options: Options) -> List[str]:
    """Options that are None or False are left out. A step is in seconds; the program needs its unit."""
    words: List[str] = []
    for name, value in options.items():
        if value is None or value is False:
            continue
        words.append("--" + {"zone": "tz", "start": "from", "end": "to"}.get(name, name))
        if value is not True:
            text = f"{value:.12g}s" if name == "step" else str(value)
            words.append(",".join(value) if isinstance(value, list) else text)
    return words


def _output_words(output: str) -> List[str]:
    return ["-o", output, "--overwrite"]


def _picture_words(picture: Picture) -> List[str]:
    words = _option_words(picture.when) if picture.when else []
    if picture.is_map:
        words.append("--ortho")
    if picture.resolution is not None:
        words += _number("--resolution", picture.resolution)
    else:
        words += ["--size", "{}x{}".format(*picture.size)]
    view = [picture.side] if picture.side else []
    view += [f"{name}={value:.12g}" for name, value in (("el", picture.elevation_deg), ("zoom", picture.zoom))
             if value is not None]  # fmt: skip
    if view:
        words += ["--view", ",".join(view)]
    words += _number("--exaggerate", picture.exaggeration)
    for option, list_ in (("--enable", picture.enable), ("--disable", picture.disable), ("--stamp", picture.stamps)):
        if list_:
            words += [option, ",".join(list_)]
    if picture.preset:
        words += ["--preset", picture.preset]
    for address, value in picture.values.items():
        words += ["--set", f"{address}={value}"]
    return words + (["--overlay", picture.overlay] if picture.overlay else [])


def _directions(horizon: Sequence[dict]) -> List[Direction]:
    return [Direction(one["azimuth_deg"], one["horizon_deg"], one["distance_m"]) for one in horizon]
