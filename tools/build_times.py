#!/usr/bin/env python3
"""Says where the time of a build went, by Ninja's log of it.

    tools/build_times.py build/release

Prints the sums of the times of all commands, the wall-clock time, the slowest objects, and the sum for each folder. Build
into an empty folder first: where Ninja has built into it several times, the last command of each output counts, and the
wall-clock time is that of the longest build. CCACHE_RECACHE=1 has ccache compile what it knows.
"""
import argparse
import collections
import pathlib
import sys


class Command:
    """One command of a build: when it ran, in milliseconds since the build began, and its outputs."""

    def __init__(self, start_ms, end_ms):
        self.start_ms, self.end_ms, self.outputs = start_ms, end_ms, []

    def seconds(self):
        return (self.end_ms - self.start_ms) / 1000

    def is_object(self):
        return any(output.endswith((".o", ".gch")) for output in self.outputs)


def commands_in(text):
    """The commands of a .ninja_log: of each output the last one."""
    lines = text.splitlines()
    if not lines or not lines[0].startswith("# ninja log v"):
        raise ValueError("not a log of Ninja")
    last = {}  # by output: start, end and hash of the command
    for line in lines[1:]:
        fields = line.split("\t")
        if len(fields) == 5:  # or the last line of a build that was killed
            last[fields[3]] = (int(fields[0]), int(fields[1]), fields[4])
    commands = {}
    for output, key in last.items():
        commands.setdefault(key, Command(key[0], key[1])).outputs.append(output)
    return list(commands.values())


def source_of(output):
    """"core/dem/CMakeFiles/relevo_dem.dir/load.cpp.o" is of "core/dem/load.cpp"."""
    parts = [part for part in output.split("/") if part != "CMakeFiles" and not part.endswith(".dir")]
    return "/".join(parts).removesuffix(".o")


def folder_of(source):
    """The first two folders: "core/dem"."""
    folders = source.split("/")[:-1]
    return "/".join(folders[:2]) or "."


def report(text, most):
    """What is printed of a log."""
    commands = commands_in(text)
    objects = [command for command in commands if command.is_object()]
    others = [command for command in commands if not command.is_object()]
    wall_s = max((command.end_ms for command in commands), default=0) / 1000
    lines = [f"compiling    {sum(c.seconds() for c in objects):8.1f} s in {len(objects)} objects",
             f"other        {sum(c.seconds() for c in others):8.1f} s in {len(others)} commands: links, data",
             f"wall clock   {wall_s:8.1f} s"]
    lines += ["", "slowest objects"]
    for command in sorted(objects, key=Command.seconds, reverse=True)[:most]:
        lines.append(f"{command.seconds():8.1f} s  {source_of(command.outputs[0])}")
    folders = collections.defaultdict(lambda: [0.0, 0])
    for command in objects:
        total = folders[folder_of(source_of(command.outputs[0]))]
        total[0] += command.seconds()
        total[1] += 1
    lines += ["", "folders"]
    for folder, (seconds, count) in sorted(folders.items(), key=lambda one: -one[1][0]):
        lines.append(f"{seconds:8.1f} s  {folder} ({count})")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="a folder that Ninja has built into: build/release")
    parser.add_argument("--slowest", type=int, default=15, help="how many objects to name (15)")
    arguments = parser.parse_args()
    log = arguments.folder / ".ninja_log"
    try:
        text = report(log.read_text(), arguments.slowest)
    except OSError as error:
        sys.exit(f"build_times: {log}: cannot be read, {error.strerror}; name a folder that was built")
    except ValueError as error:
        sys.exit(f"build_times: {log}: {error}")
    print(text)


if __name__ == "__main__":
    main()
