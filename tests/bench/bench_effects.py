#!/usr/bin/env python3
"""What each effect costs: a DEM of 1200 x 640 posts made of the bundled one, pictures of 1280 x 1024.

Usage: bench_effects.py [BUILD] [--frames N] [--rounds N] [--device NAME] [--without vsm]
       BUILD: build/release (default)

A frame with all effects but those of --without, and the same without one effect at a time; the difference is
that effect's cost. Effects that are off by default are added to the whole instead. Where an effect requires
another, switching that off takes both away.

Two figures: wall time, the least of N frames; and with --processor the processor time of a frame over the number of
processors, which other programs on the machine disturb less, and which is what a frame takes of a software renderer
that has the machine to itself. Rounds are taken in turn over all cases, and the least of each is printed.
"""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import tempfile

from bench_capture import ROOT, make_dem


def processor_ms():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1e3 * (usage.ru_utime + usage.ru_stime)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--processor", action="store_true", help="processor time instead of wall time")
    parser.add_argument("--without", default="vsm", help="effects left out of all figures")
    arguments = parser.parse_args()
    relevo = arguments.build / "bin/relevo"
    listed = json.loads(subprocess.run([relevo, "plugins", "list", "--json"], check=True, capture_output=True).stdout)
    left_out = set(arguments.without.split(","))
    plugins = [p for p in listed["plugins"] if p["id"] not in left_out]
    whole = [p["id"] for p in plugins if p["enabled_by_default"]]
    cases = {"core alone": [], "all": whole}
    for plugin in plugins:
        others = [i for i in whole if i != plugin["id"]]
        cases[plugin["id"]] = others if plugin["enabled_by_default"] else whole + [plugin["id"]]
    provides = {word: p["id"] for p in plugins for word in p["provides"]}
    taken_along = {}
    for plugin in plugins:
        for word in plugin["requires"]:
            taken_along.setdefault(provides[word], []).append(plugin["id"])
    for provider, dependents in taken_along.items():
        cases[provider] = [i for i in cases[provider] if i not in dependents]

    processors = len(os.sched_getaffinity(0))
    ms = {name: float("inf") for name in cases}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        dem = make_dem(folder, 1200, 640)
        timings = folder / "timings.json"

        def frames(effects, count):
            """The fastest of further frames by the clock, and the process's processor time [ms]."""
            before = processor_ms()
            subprocess.run([relevo, "-q", "capture", dem, "-o", folder / "out.png", "--overwrite", "--view",
                            "az=210,el=30", "--device",
                            arguments.device, "--only", ",".join(effects), "--timings", timings, "--repeat",
                            str(count)], check=True)
            return json.loads(timings.read_text()), processor_ms() - before

        for _ in range(arguments.rounds):
            for case, effects in cases.items():
                result, many = frames(effects, arguments.frames)
                took = result["frames"]["min_ms"]
                if arguments.processor:
                    took = (many - frames(effects, 0)[1]) / arguments.frames / processors
                ms[case] = min(ms[case], took)
    print(f"device: {result['device']}, processors: {processors}, triangles: {result['triangles']}")
    print(f"core alone {ms['core alone']:7.1f} ms a frame")
    print(f"all        {ms['all']:7.1f} ms a frame ({', '.join(whole)})")
    for plugin in plugins:
        on = plugin["enabled_by_default"]
        cost = ms["all"] - ms[plugin["id"]] if on else ms[plugin["id"]] - ms["all"]
        share = cost / (ms["all"] if on else ms[plugin["id"]])
        also = taken_along.get(plugin["id"], [])
        print(f"  {plugin['id']:<10} {cost:7.1f} ms  {100 * share:5.1f} %{'' if on else '  off by default'}"
              f"{'  with ' + ', '.join(also) if also else ''}")


if __name__ == "__main__":
    main()
