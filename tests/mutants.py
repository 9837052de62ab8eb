#!/usr/bin/env python3
"""Runs the tests against a list of single slips of a kind that programmers make: a wrong sign, rows for columns, a missing
check for voids. A slip that no test notices is a gap in the tests.

tests/mutants/<layer>.toml lists them:

    [[slip]]
    id = "grid_sun_azimuth"          # letters, digits and _
    claim = "..."                    # what a user would get wrong
    file = "core/light/shadows.cpp"
    before = '''way.x /= std::cos(lat)'''   # stands exactly once in the file; may span lines
    after = '''way.x *= std::cos(lat)'''
    kind = "expression"              # the default; or "statement", "text"
    tests = "light.Shadows sun.Zone.Name*"  # where it is expected to be noticed: layer.Suite or layer.Suite.Case

All slips of kind "expression" and "statement" are compiled at once, each behind a switch that the environment variable
RELEVO_SLIP throws: `before` becomes `(switch ? (after) : (before))` or `if (switch) { after } else { before }`. So a
statement must not declare what later lines use. A slip of kind "text" (shaders, data, constants, declarations) is a
change of the file and a build of its own. All happens in a copy, build/mutants/source, built with the preset dev.

Usage: mutants.py [--layer L]... [--only ID]... [--only-expected] [--list | --check] [-j N]
Prints for each slip the tests that noticed it, and a summary. Exits with 1 if a slip was not noticed or no longer applies,
with 2 if something could not be built.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
COPY = ROOT / "build/mutants/source"
BUILD = COPY / "build/dev"  # the paths that a compiler sees are those of a usual build, for the compiler's cache
KINDS = ("expression", "statement", "text")
KEYS = {"id", "claim", "file", "before", "after", "kind", "tests", "layer"}
TIMEOUT_S = 900  # of one test program; a slip may make it run for ever

# A slip may compare or assign what the code itself would not.
SWITCHES = """#include <cstdlib>
#include <cstring>
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wdiv-by-zero"
"""
SWITCH = """[[maybe_unused]] static const bool relevo_slip_{id} =
    std::getenv("RELEVO_SLIP") && !std::strcmp(std::getenv("RELEVO_SLIP"), "{id}");
"""


def fail(message):
    print(message, file=sys.stderr)
    sys.exit(2)


def read_slips():
    """All slips of the lists, in the lists' order."""
    slips = []
    for path in sorted((ROOT / "tests/mutants").glob("*.toml")):
        with open(path, "rb") as file:
            try:
                listed = tomllib.load(file).get("slip", [])
            except tomllib.TOMLDecodeError as error:
                fail(f"{path}: {error}")
        for slip in listed:
            slip = {"kind": "expression", "layer": path.stem} | slip
            name = f"{path.name}: {slip.get('id', 'a slip without id')}"
            if set(slip) != KEYS:
                fail(f"{name}: expected the keys {', '.join(sorted(KEYS - {'layer'}))}")
            if slip["kind"] not in KINDS or not re.fullmatch(r"\w+", slip["id"]):
                fail(f"{name}: expected a kind of {', '.join(KINDS)} and an id of letters, digits and _")
            if any(slip["id"] == other["id"] for other in slips):
                fail(f"{name}: an id of two slips")
            if slip["kind"] != "text" and not slip["file"].endswith((".cpp", ".h")):
                fail(f"{name}: a file that is not C++ takes kind = \"text\"")
            slips.append(slip)
    return slips


def why_gone(slip):
    """Why a slip no longer applies, or nothing."""
    path = ROOT / slip["file"]
    if not path.is_file():
        return f"{slip['file']} is not there"
    count = path.read_text().count(slip["before"])
    return None if count == 1 else f"{slip['file']} has its text {count} times, expected once"


def woven(text, slips, changed=None):
    """The text of a file with the switched slips in it, and if `changed` is given with that one made."""
    def place(slip):
        begin = text.index(slip["before"])
        return begin, begin + len(slip["before"])

    taken = [place(changed)] if changed else []
    edits = [(*taken[0], changed["after"])] if changed else []
    ids = []
    for slip in slips:
        begin, end = place(slip)
        if any(begin < other_end and other_begin < end for other_begin, other_end in taken):
            if changed and begin < taken[0][1] and taken[0][0] < end:
                continue
            fail(f"{slip['id']}: overlaps another slip; give one of them kind = \"text\"")
        taken.append((begin, end))
        ids.append(slip["id"])
        switch = f"relevo_slip_{slip['id']}"
        edits.append((begin, end, f"({switch} ? ({slip['after']}) : ({slip['before']}))" if slip["kind"] == "expression"
                      else f"if ({switch}) {{ {slip['after']} }} else {{ {slip['before']} }}"))
    for begin, end, new in sorted(edits, reverse=True):
        text = text[:begin] + new + text[end:]
    if ids:
        text = SWITCHES + "".join(SWITCH.format(id=name) for name in ids) + "#line 1\n" + text
    return text


class Copy:
    """The copy of the sources, with the switches in it."""

    def __init__(self, slips):
        self.by_file = {}
        for slip in slips:
            if slip["kind"] != "text":
                self.by_file.setdefault(slip["file"], []).append(slip)
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                                check=True, stdout=subprocess.PIPE).stdout.decode()
        self.names = [name for name in listed.split("\0") if name and (ROOT / name).is_file()]

    def put(self, name, changed=None):
        """Writes a file of the copy where it is another one: what did not change is not built again."""
        to, data = COPY / name, (ROOT / name).read_bytes()
        slips = self.by_file.get(name, [])
        if slips or changed:
            data = woven(data.decode(), slips, changed).encode()
        if to.is_file() and to.read_bytes() == data:
            return
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_bytes(data)
        shutil.copymode(ROOT / name, to)

    def put_all(self):
        for name in self.names:
            self.put(name)
        kept = set(self.names)
        for path in COPY.rglob("*"):
            name = path.relative_to(COPY)
            if name.parts[0] != "build" and path.is_file() and str(name) not in kept:
                path.unlink()


def build(targets, jobs):
    """@return what went wrong, or nothing"""
    if not (BUILD / "build.ninja").is_file():
        made = subprocess.run(["cmake", "--preset", "dev"], cwd=COPY, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if made.returncode:
            return made.stdout.decode()
    made = subprocess.run(["cmake", "--build", BUILD, "-j", str(jobs)] + (["--target", *targets] if targets else []),
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return "\n".join(made.stdout.decode().splitlines()[-40:]) if made.returncode else None


def filters(tests):
    """Of "light.Shadows sun.Zone.Name*": {"light": ["Shadows.*"], "sun": ["Zone.Name*"]}"""
    by_layer = {}
    for pattern in tests.split():
        layer, _, rest = pattern.partition(".")
        by_layer.setdefault(layer, []).append(rest if "." in rest else rest + ".*")
    return by_layer


def failed_of(layer, patterns, slip, first_alone):
    """The names of the tests of a program that fail with a slip, or of the first one."""
    environment = dict(os.environ)
    environment.pop("RELEVO_SLIP", None)
    if slip:
        environment["RELEVO_SLIP"] = slip
    if (ROOT.parent / "shared").is_dir():
        environment.setdefault("RELEVO_TEST_DATA", str(ROOT.parent / "shared"))
    folder = BUILD / "tests" / layer
    process = subprocess.Popen([BUILD / "bin" / f"test_{layer}", "--gtest_filter=" + ":".join(patterns),
                                *(["--gtest_fail_fast"] if first_alone else [])],
                               cwd=folder if folder.is_dir() else BUILD, env=environment, start_new_session=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        output = process.communicate(timeout=TIMEOUT_S)[0].decode(errors="replace")
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.communicate()
        return {f"{layer} (ran for {TIMEOUT_S} s)"}
    failed = {f"{layer}.{name}" for name in re.findall(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", output, re.MULTILINE)}
    if process.returncode < 0:
        last = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
        failed.add(f"{layer}.{last[-1] if last else '?'} (ended by signal {-process.returncode})")
    if "Running 0 tests" in output:
        print(f"{layer}: no test is called {' '.join(patterns)}")
    return failed


def programs():
    return sorted(path.name.removeprefix("test_") for path in (BUILD / "bin").glob("test_*"))


def run_tests(by_layer, slip, jobs, first_alone=False):
    with ThreadPoolExecutor(jobs) as pool:  # programs side by side, for two runs of one would share their folders
        found = pool.map(lambda item: failed_of(*item, slip, first_alone), by_layer.items())
        return set().union(*found)


class Run:
    def __init__(self, slips, jobs, only_expected):
        self.slips, self.jobs, self.only_expected = slips, jobs, only_expected
        self.copy = Copy(slips)
        self.targets = []  # all
        if only_expected:
            self.targets = sorted({f"test_{layer}" for slip in slips for layer in filters(slip["tests"])})

    def build(self):
        if wrong := build(self.targets, self.jobs):
            fail(wrong)

    def failed_with(self, slip, by_layer, first_alone):
        if slip["kind"] != "text":
            return run_tests(by_layer, slip["id"], self.jobs, first_alone)
        self.copy.put(slip["file"], changed=slip)
        try:
            self.build()
            return run_tests(by_layer, None, self.jobs, first_alone)
        finally:
            self.copy.put(slip["file"])

    def each(self, slips, tests_of):
        """Runs tests with each slip. @return the slips that were not noticed"""
        expected = {}
        for slip in slips:
            for layer, patterns in tests_of(slip).items():
                expected.setdefault(layer, set()).update(patterns)
        self.build()
        broken = run_tests({layer: sorted(patterns) for layer, patterns in expected.items()}, None, self.jobs)
        for name in sorted(broken):
            print(f"fails without any slip: {name}")
        missed = []
        for slip in sorted(slips, key=lambda one: one["kind"] == "text"):
            begin = time.monotonic()
            found = sorted(self.failed_with(slip, tests_of(slip), self.only_expected and not broken) - broken)
            if not found:
                missed.append(slip)
            more = f" and {len(found) - 3} more" if len(found) > 3 else ""
            print(f"{'noticed' if found else 'NOT NOTICED'}  {slip['id']}: "
                  f"{', '.join(found[:3]) + more if found else slip['claim']}  ({time.monotonic() - begin:.0f} s)",
                  flush=True)
        return missed

    def all(self):
        """@return the slips that no test noticed"""
        self.copy.put_all()
        missed = self.each(self.slips, lambda slip: filters(slip["tests"]))
        if not missed or self.only_expected:
            return missed
        print("all tests, with the slips that were not noticed where it was expected:", flush=True)
        everything = {path.name.removeprefix("test_"): ["*"] for path in (BUILD / "bin").glob("test_*")}
        return self.each(missed, lambda slip: everything)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--layer", action="append", help="slips of tests/mutants/LAYER.toml alone")
    parser.add_argument("--only", nargs="+", metavar="ID", help="these slips alone")
    parser.add_argument("--only-expected", action="store_true", help="build and run the tests named by slips alone")
    parser.add_argument("--list", action="store_true", help="print the slips, run nothing")
    parser.add_argument("--check", action="store_true", help="print slips that no longer apply, run nothing")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count(), help="of the build and of test programs")
    arguments = parser.parse_args()

    slips = read_slips()
    for wanted in arguments.only or []:
        if not any(slip["id"] == wanted for slip in slips):
            fail(f"--only {wanted}: no slip has this id; --list prints all")
    slips = [slip for slip in slips if (not arguments.layer or slip["layer"] in arguments.layer)
             and (not arguments.only or slip["id"] in arguments.only)]
    if arguments.list:
        for slip in slips:
            print(f"{slip['layer']}  {slip['id']}  {slip['file']}: {slip['claim']}")
        return 0
    gone = {slip["id"]: why for slip in slips if (why := why_gone(slip))}
    for name, why in gone.items():
        print(f"no longer applies: {name}: {why}")
    if arguments.check:
        print(f"{len(slips) - len(gone)} of {len(slips)} slips apply")
        return 1 if gone else 0
    applying = [slip for slip in slips if slip["id"] not in gone]
    missed = Run(applying, arguments.jobs, arguments.only_expected).all() if applying else []
    noticed = len(applying) - len(missed)
    print(f"{noticed} of {len(applying)} slips noticed ({100 * noticed / max(1, len(applying)):.1f} %), "
          f"{len(gone)} no longer apply")
    return 1 if gone or missed else 0


if __name__ == "__main__":
    sys.exit(main())
