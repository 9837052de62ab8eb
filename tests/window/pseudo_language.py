#!/usr/bin/env python3
"""Makes a catalogue of a language that no one speaks from the table of texts, to see the window in it: letters with
accents, in brackets, a third longer. A text without accents on the screen is not translated.

Usage: pseudo_language.py TABLE FOLDER [--lies]    writes FOLDER/xx/LC_MESSAGES/relevo.mo
--lies: placeholders that do not fit the English text's.
"""

import ast
import pathlib
import re
import subprocess
import sys

ACCENTS = str.maketrans("aceinouyACEINOUY", "àçéîñôûýÀÇÉÎÑÔÛÝ")
HEADER = 'msgid ""\nmsgstr "Content-Type: text/plain; charset=UTF-8\\nPlural-Forms: nplurals=2; plural=n!=1;\\n"\n\n'


def texts(table):
    """Pairs of a text and its plural, which may be None."""
    for entry in table.read_text(encoding="utf-8").split("\n\n"):
        found = {}
        for key, lines in re.findall(r'^(msgid|msgid_plural) ((?:".*"\n?)+)', entry, re.MULTILINE):
            found[key] = "".join(ast.literal_eval(line) for line in lines.splitlines())
        if found.get("msgid"):
            yield found["msgid"], found.get("msgid_plural")


def pseudo(text):
    body = text.strip("\n")
    before, after = text[:len(text) - len(text.lstrip("\n"))], text[len(text.rstrip("\n")):]
    parts = re.split(r"(\{[^{}]*\})", body)
    accented = "".join(part if part.startswith("{") else part.translate(ACCENTS) for part in parts)
    length = len("".join(part for part in parts if not part.startswith("{")))
    return f"{before}[{accented}{'~' * round(length / 3)}]{after}"


def lie(text):
    return "%s%n {} {5} {:d} {:q} {" + pseudo(text) if "{" in text else pseudo(text)


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def main():
    table, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]) / "xx" / "LC_MESSAGES"
    translated = lie if "--lies" in sys.argv[3:] else pseudo
    catalogue = HEADER
    for one, many in texts(table):
        catalogue += f"msgid {quoted(one)}\n"
        if many is None:
            catalogue += f"msgstr {quoted(translated(one))}\n\n"
        else:
            catalogue += (f"msgid_plural {quoted(many)}\nmsgstr[0] {quoted(translated(one))}\n"
                          f"msgstr[1] {quoted(translated(many))}\n\n")
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["msgfmt", "--output-file", folder / "relevo.mo", "-"], input=catalogue, text=True, check=True)


if __name__ == "__main__":
    main()
