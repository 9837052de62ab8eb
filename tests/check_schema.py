#!/usr/bin/env python3
"""Checks the JSON that the documentation shows against the published schemas of scenes, jobs and plugins, and
the program's own plugins and files.

Usage: check_schema.py ROOT [SCENE.json...] [--jobs JOB.json...]. Prints every violation and exits with 1 if there is
one.
"""

import json
import pathlib
import sys
import warnings

import jsonschema

SHOWN = {"scene.md": "scene", "jobs.md": "job", "plugin-guide.md": "plugin"}
KINDS = ("scene", "job", "plugin")


def shown_files(page):
    """The (name, text) of each fence ```json NAME of a page."""
    name, lines = None, []
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("```json "):
            name, lines = line.split(" ", 1)[1], []
        elif line.startswith("```"):
            if name:
                yield name, "\n".join(lines)
            name = None
        elif name:
            lines.append(line)


def validators(docs):
    schemas = {kind: json.loads((docs / f"{kind}.schema.json").read_text(encoding="utf-8")) for kind in KINDS}
    store = {f"{kind}.schema.json": schema for kind, schema in schemas.items()}
    result = {}
    for kind, schema in schemas.items():
        jsonschema.Draft7Validator.check_schema(schema)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of versions after Debian 12's
            resolver = jsonschema.RefResolver(f"{kind}.schema.json", schema, store)
        result[kind] = jsonschema.Draft7Validator(schema, resolver=resolver)
    return result


def main():
    root = pathlib.Path(sys.argv[1])
    check = validators(root / "docs")
    texts = [(check[kind], f"{page}: {name}", text)
             for page, kind in SHOWN.items() for name, text in shown_files(root / "docs" / page)]
    texts += [(check["plugin"], str(path.relative_to(root)), path.read_text(encoding="utf-8"))
              for path in sorted((root / "plugins").glob("*/plugin.json"))]
    kind = "scene"
    for name in sys.argv[2:]:
        if name == "--jobs":
            kind = "job"
        else:
            texts.append((check[kind], name, pathlib.Path(name).read_text(encoding="utf-8")))
    faults = 0
    for validator, name, text in texts:
        for error in validator.iter_errors(json.loads(text)):
            print(f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message}")
            faults += 1
    # What must not pass: the schemas say something.
    for kind, wrong in (("scene", {"format": 1, "dem": {"files": ["a"]}, "camera": {"fov": 500}}),
                        ("job", {"format": 1, "shots": [{"camera": {"zoom": 1}}]}),
                        ("job", {"format": 1, "sweep": [{"times": ["noon"], "dates": ["2026-01-01"]}]}),
                        ("plugin", {"format": 1, "id": "Dust", "name": "D", "version": "1"}),
                        ("plugin", {"format": 1, "id": "dust", "name": "D", "version": "1", "provide": ["dust"]}),
                        ("plugin", {"format": 1, "id": "dust", "name": "D", "version": "1",
                                    "textures": {"a": {"kind": "2d", "files": ["a.png"], "encoding": "srgb"}}})):
        if check[kind].is_valid(wrong):
            print(f"{kind}.schema.json takes {json.dumps(wrong)}")
            faults += 1
    if len(texts) < 6:
        print(f"expected six examples at least but found {len(texts)}")
        faults += 1
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
