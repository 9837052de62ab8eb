#!/usr/bin/env python3
"""Checks that functions fit a screen: 60 lines from the name to the closing brace, comments and blank lines
included. A longer one says why in a comment of its own before it that begins with "In one piece:".

Usage: check_functions.py ROOT. Prints every function that is too long and exits with 1 if there is one.
"""

import pathlib
import re
import sys

MOST_LINES = 60
FOLDERS = ("app", "bindings", "core", "include", "plugins", "tools")
REASON = "In one piece:"
COMMENTS_AND_TEXTS = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*',
    re.DOTALL | re.MULTILINE)
SCOPE = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")


def blanked(text):
    """The text with comments, literals and directives as blanks, its lines where they were."""
    return COMMENTS_AND_TEXTS.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def end_of(text, opening):
    depth = 0
    for at in range(opening, len(text)):
        depth += (text[at] == "{") - (text[at] == "}")
        if depth == 0:
            return at
    return len(text) - 1


def functions(text, begin=0, end=None):
    """Pairs of offsets, from the first letter of a function's head to its closing brace."""
    end = len(text) if end is None else end
    head = at = begin
    while at < end:
        if text[at] in ";}":
            head = at + 1
        elif text[at] == "{":
            closing = end_of(text, at)
            words = text[head:at]
            following = text[closing + 1:end].lstrip()
            if "(" not in words and SCOPE.search(words):
                yield from functions(text, at + 1, closing)
                head = closing + 1
            elif "(" in words and not following.startswith((",", "{")) and "=" not in words.split("(")[0]:
                yield head + len(words) - len(words.lstrip()), closing
                head = closing + 1
            at = closing
        at += 1


def has_reason(lines, first):
    """Whether the comment right above a line, counted from 0, says why."""
    above = first - 1
    while above >= 0 and lines[above].strip().startswith("//"):
        if lines[above].strip().lstrip("/ ").startswith(REASON):
            return True
        above -= 1
    return False


def long_functions(root, most):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in {".h", ".hpp", ".cpp"} or "tests" in path.parts:
                continue
            text = path.read_text(encoding="utf-8")
            lines = text.splitlines()
            plain = blanked(text)
            for begin, closing in functions(plain):
                first = plain.count("\n", 0, begin)
                count = plain.count("\n", begin, closing) + 1
                if count > most and not has_reason(lines, first):
                    yield count, f"{path.relative_to(root)}:{first + 1}: {lines[first].strip()}"


def main():
    root = pathlib.Path(sys.argv[1])
    most = int(sys.argv[2]) if len(sys.argv) > 2 else MOST_LINES
    found = list(long_functions(root, most))
    for count, where in found:
        print(f"{where}: {count} lines, expected at most {most}; make steps of it, or say why above it: // {REASON} ...")
    if not found:
        print("functions: clean")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
