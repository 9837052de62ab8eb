#!/usr/bin/env python3
"""Checks the words that users read against the table "Words" of docs/terms.md, and the line length of their pages.

Read are the pages below, the texts of app/, bindings/ and core/ (string literals with a blank in them, so that keys and options
stay free), those of the QGIS plugin, and the names and descriptions of plugins, presets, parameters and schemas. Code in pages (`...`, fences) is not.
A word is refused by the pattern of its row; a row without a pattern needs a reader. New rows need an entry here.

Usage: check_words.py ROOT. Prints every finding and exits with 1 if there is one.
"""

import ast
import json
import pathlib
import re
import sys

PAGES = ("README.md", "CHANGELOG.md", "docs/cli.md", "docs/dem-formats.md", "docs/gallery.md", "docs/jobs.md",
         "docs/library.md", "docs/plugin-guide.md", "docs/python.md", "docs/qgis.md", "docs/scene.md", "docs/terms.md",
         "docs/translating.md", "docs/viewer.md")
MOST_COLUMNS = 120

# The left column of the table, and what finds it. None: only a reader can tell.
RULES = {
    "hangs on": r"\bh[au]ngs? on\b|\bhanging on\b",
    "beside (in time, of threads)": r"\b(beside|besides)\b",
    "likewise": r"\blikewise\b",
    "by the clock": r"\bby (the|its|their|whose|these|those) (\w+ )?clocks?\b|\bby whose clocks\b",
    "is told, tells": r"\b(tells?|told)\b",
    "is looked at, looked over": r"\blook(s|ed|ing)? (at|over)\b(?! the sky)",
    "left out": r"\b(left|leaves?|leaving) \w* ?out\b",
    "that which": r"\bthat which\b",
    "hole": r"\bholes?\b",
    "shadow's edge, margin": r"\bshadow's edge\b|\bmargins?\b",
    "share of the disc": r"\bshare of the (sun's )?disc\b",
    "spells": r"\bspells?\b",
    "beyond the DEM, doubt": r"\bbeyond the DEM\b|\bdoubts?\b",
    "drape": r"\bdrap(e|es|ed|ing)\b",
    "page": r"(?<!tile )(?<!web )\bpages?\b(?! (up|down)\b)",
    "patch net": r"\bpatch nets?\b",
    "picture (of the renderer)": None,
    "moment (a time)": r"\bmoments?\b",
    "afresh": r"\bafresh\b",
    "shown (after tone mapping)": None,
    "facing (a shading factor)": None,
    "take away": r"\bt(ake|akes|aken|aking|ook) (it |them )?away\b",
    "invention, invented": r"\binvent(s|ed|ion|ions)?\b",
    "bend, twist (derivatives)": r"\btwists?\b",
    "aloud": r"\baloud\b",
    "that comes along": r"\b(comes?|came) along\b",
    "names of C++": r"\b(base|geo|image|gl|shader|dem|climate|sun|light|effect|scene|chart|render|session|cli|viewer)"
                    r"::\w+",
}

# (file, text in which a refused word may stand, why)
ALLOWED = (
    ("app/cli/sun_hours.cpp", "last and spells", "the name of a band of --bands"),
    ("app/cli/sun_hours.cpp", "and spells (number of sunshine periods)", "the name of a band of --bands"),
    ("bindings/qgis/relevo_provider/rasters.py", "and spells (number of sunshine periods)", "the name of a band of --bands"),
    ("core/render/terrain.cpp", "page table", "the label of a buffer, for debuggers of GL"),
    ("docs/plugin-guide.md", "cannot be a word that core uses", "the list of these words"),
    ("core/session/overlay.cpp", "share of the sun's disc", "the band's name in files of earlier versions"),
)

TOKENS = re.compile(
    r'(?P<comment>//[^\n]*|/\*.*?\*/)|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<text>(?:\\.|[^"\\\n])*)"'
    r"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'|^[ \t]*#[ \t]*include[^\n]*", re.DOTALL | re.MULTILINE)
ANNOTATED = re.compile(r'\b(?:label|description)\("((?:\\.|[^"\\])*)"\)')
OPTIONS = re.compile(r"--[a-z][a-z-]*( (fill|cut|mark|holes))?")


def literals(text):
    """The (line, text) of every string literal of C++; neighbours are one, as the compiler has them."""
    whole, line, end = None, 0, 0
    for found in TOKENS.finditer(text):
        piece = found["raw"] if found["raw"] is not None else found["text"]
        if piece is None:
            continue
        if whole is not None and not text[end:found.start()].strip():
            whole += piece
        else:
            if whole is not None:
                yield line, whole
            whole, line = piece, text.count("\n", 0, found.start()) + 1
        end = found.end()
    if whole is not None:
        yield line, whole


def python_literals(text):
    """The (line, text) of every string of Python but docstrings, which are expressions of their own."""
    tree = ast.parse(text)
    docstrings = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node.lineno, node.value


def described(value):
    """Every "description" in a JSON value."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key == "description" and isinstance(inner, str):
                yield inner
            else:
                yield from described(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from described(inner)


def sources(root):
    """The (file, line, text) of what the program says."""
    for folder in ("app", "bindings", "core"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in {".h", ".cpp"}:
                for line, text in literals(path.read_text(encoding="utf-8")):
                    if " " in text or "::" in text:
                        yield path.relative_to(root), line, text
    for path in sorted((root / "bindings/qgis").rglob("*.py")):
        for line, text in python_literals(path.read_text(encoding="utf-8")):
            if " " in text:
                yield path.relative_to(root), line, text
    for path in sorted((root / "plugins").rglob("*.glsl")):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            for text in ANNOTATED.findall(line):
                yield path.relative_to(root), number, text
    for folder, names in (("plugins", "*/plugin.json"), ("data/presets", "*.json"), ("docs", "*.schema.json")):
        for path in sorted((root / folder).glob(names)):
            content = json.loads(path.read_text(encoding="utf-8"))
            for text in (*described(content), content.get("name", ""), content.get("invents", {}).get("what", "")):
                yield path.relative_to(root), 1, text


def readable(page):
    """The page with its code as blanks, its lines where they were."""
    def blank(found):
        return re.sub(r"[^\n]", " ", found.group())
    page = re.sub(r"^```.*?^```[^\n]*|^    [^\n]*", blank, page, flags=re.DOTALL | re.MULTILINE)
    page = re.sub(r"`[^`]*`", blank, page)
    return re.sub(r"\]\([^)]*\)", blank, page)  # where links lead


def table_of(terms):
    """The lines of the table "Words", and the words of its left column."""
    begin = terms.index("## Words")
    rows = re.findall(r"^\| ([^|]+) \|", terms[begin:], re.MULTILINE)
    return begin, rows[1:]  # behind the head


def pages(root):
    """The (file, line, text) of every paragraph of the pages; what is broken over lines is one text."""
    for name in PAGES:
        text = (root / name).read_text(encoding="utf-8")
        if name == "docs/terms.md":
            text = text[:table_of(text)[0]]
        line = 1
        for paragraph in re.split(r"(\n\s*\n|\n(?=[|#-]))", readable(text)):
            yield pathlib.Path(name), line, " ".join(paragraph.split())
            line += paragraph.count("\n")


def refused(where, texts):
    patterns = {word: re.compile(pattern, re.IGNORECASE) for word, pattern in RULES.items() if pattern}
    for path, line, said in texts:
        text = OPTIONS.sub(" ", said)
        for word, pattern in patterns.items():
            for found in pattern.finditer(text):
                near = text[max(0, found.start() - 30):found.end() + 30]
                if not any(str(path) == file and allowed in text for file, allowed, _ in ALLOWED):
                    yield f'{path}:{line}: "{found.group()}" in "{near}": {where[word]}'


def long_lines(root):
    for name in PAGES:
        for number, line in enumerate((root / name).read_text(encoding="utf-8").splitlines(), 1):
            text = re.sub(r"\]\([^)]*\)", "]()", line) if line.startswith("|") else line  # a row cannot be broken
            if len(text) > MOST_COLUMNS:
                yield f"{name}:{number}: {len(text)} columns, expected at most {MOST_COLUMNS}"


def main():
    root = pathlib.Path(sys.argv[1])
    terms = (root / "docs/terms.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| ([^|]+) \| ([^|]+) \|", terms[table_of(terms)[0]:], re.MULTILINE))
    rows = {word: f"write {better}" for word, better in rows.items() if word not in ("not", "---")}
    findings = [f"docs/terms.md: {word}: has no rule in tests/check_words.py" for word in rows.keys() - RULES.keys()]
    findings += [f"docs/terms.md: {word}: is not in its table" for word in RULES.keys() - rows.keys()]
    if not findings:
        findings = [*refused(rows, sources(root)), *refused(rows, pages(root)), *long_lines(root)]
    print("\n".join(findings) if findings else "words: clean")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
