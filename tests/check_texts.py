#!/usr/bin/env python3
"""Checks that the window's texts are marked for translation (app/viewer/translation.h).

A string literal of app/viewer is a text if it reads as one (two words, or a capital and small letters), or if it stands
where texts are shown and has two letters in a row. Placeholders, identifiers of ImGui ("##id") and units are no text.

Usage: check_texts.py ROOT. Prints every text that is not marked and exits with 1 if there is one.
"""

import pathlib
import re
import sys

MARKS = {"tr", "tr_label", "tr_later", "tr_format", "tr_plural", "tr_format_plural"}
# Calls that show their literals, to the user of the window; others do so only with what reads as text.
SHOWS = re.compile(r"ImGui::\w+|messages_\.\w+|bad_input|bad_usage|failed|fmt::format|tooltip|wrapped|rows\.next|item"
                   r"|button|tab|jump|date_field|height_field|go_to_edge")
# Calls whose literals no user of the window reads: logs, identifiers, command lines, labels for debuggers of GL.
HIDDEN = re.compile(r"log::\w+|command\.\w+|Command|command|gl::\w+|texture|depth|target\.emplace|dlopen|is_installed"
                    r"|ImGui::(Begin(Child|Table|TabBar|Popup)|OpenPopup|PushID|ArrowButton|InvisibleButton)"
                    r"|ImGui_Impl\w+")
# (file, pattern of texts, why)
ALLOWED = (
    (".*", r"Relevo( \{\})?|\{\} - Relevo", "a name"),
    (".*", r"view: .*", "messages of the command line, before there is a window"),
    ("document.cpp", r"relevo \w+|agl", "command lines"),
    ("effects_panel.cpp", r" is off: ", "part of a notice of core, to find it"),
    ("export.cpp", r"relevo-\{\}\.\{\}|Software|Description", "a file name, keys of metadata"),
    ("file_kind.cpp", r"Feature|Point", "GeoJSON"),
    ("film_plan.cpp", r"job: film:", "part of a message of core, to find it"),
    ("open_dialog.cpp", r"zenity .*", "a command line"),
    ("sun_overlay.cpp", r"sun (hours|shadow|sky-view)( --bands \w+)?", "command lines"),
    ("sun_overlay.cpp", r"Sky-view factor|Direct sun|(First|Last) light|Irradiation|Sun hours|.* to .*",
     "titles in scenes and pictures, which do not depend on the language"),
    ("window_words.cpp", r".*--.*", "parts of messages of core, to find them"),
)

TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\''
    r'|[A-Za-z_]\w*(?:(?:::|\.|->)\w+)*|[(){}\[\],;]|\S', re.DOTALL | re.MULTILINE)
PLACEHOLDER = re.compile(r"\{[^{}]*\}|%[-+0-9.]*l?[a-zA-Z]|##.*|\\.|--[\w-]+|\w+=|\.json\b")
UNITS = re.compile(r"\b(mm|cm|km²?|ha|EV|UTM|UTC|MGRS|min|PNG|JPEG|AVIF|TIFF|WebP)\b")


def literals(text):
    """(line, literal, names of the calls around it from the inner one) of each; adjacent literals are one."""
    calls, before = [], ""
    tokens = [token for token in TOKEN.finditer(text) if not token.group().lstrip().startswith(("//", "/*", "#"))]
    i = 0
    while i < len(tokens):
        token = tokens[i].group()
        if token in "([{":
            calls.append(before if token == "(" and re.match(r"[A-Za-z_]", before) else "")
        elif token in ")]}" and calls:
            calls.pop()
        elif token.startswith('"'):
            line, literal = text.count("\n", 0, tokens[i].start()) + 1, token[1:-1]
            while i + 1 < len(tokens) and tokens[i + 1].group().startswith('"'):
                i += 1
                literal += tokens[i].group()[1:-1]
            yield line, literal, [call for call in reversed(calls) if call]
        before = token
        i += 1


def is_text(literal, call):
    words = UNITS.sub(" ", PLACEHOLDER.sub(" ", literal))
    if re.search(r"[A-Za-z]{2,}[,;:.]? +[a-z]{2,}", words) or re.match(r"\s*[A-Z][a-z]+\b", words):
        return True
    return bool(SHOWS.fullmatch(call)) and bool(re.search(r"[A-Za-z]{2}", words))


def is_allowed(file, literal):
    return any(re.fullmatch(name, file) and re.fullmatch(text, literal) for name, text, _ in ALLOWED)


def findings(root):
    for path in sorted((root / "app" / "viewer").iterdir()):
        if path.suffix not in (".cpp", ".h") or path.stem == "translation":
            continue
        for line, literal, calls in literals(path.read_text(encoding="utf-8")):
            if any(call in MARKS or HIDDEN.fullmatch(call) for call in calls) or is_allowed(path.name, literal):
                continue
            if is_text(literal, calls[0] if calls else ""):
                yield f"{path.relative_to(root)}:{line}: not marked for translation: \"{literal}\""


def main():
    found = list(findings(pathlib.Path(sys.argv[1])))
    for one in found:
        print(one)
    print("texts: " + (f"{len(found)} to mark with tr(), tr_label(), tr_later() or tr_format()" if found else "marked"))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
