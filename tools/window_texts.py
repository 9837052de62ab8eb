#!/usr/bin/env python3
"""Lists the texts of the window in locale/relevo.pot, from which catalogues of translations are made (docs/translating.md).

Usage: window_texts.py          writes the table
       window_texts.py --check  exits with 1 if the table is not that of the source
Needs xgettext (package gettext).
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = ROOT / "locale" / "relevo.pot"
SOURCES = "app/viewer"
# Functions of app/viewer/translation.h; of plurals the arguments with both forms.
MARKS = ("tr", "tr_label", "tr_later", "tr_format", "tr_plural:1,2", "tr_format_plural:1,2")
HEADER = """# The texts of Relevo's window, made by tools/window_texts.py. How to translate them: docs/translating.md.
#
msgid ""
msgstr ""
"Project-Id-Version: Relevo\\n"
"PO-Revision-Date: YEAR-MO-DA HO:MI+ZONE\\n"
"Last-Translator: FULL NAME <EMAIL@ADDRESS>\\n"
"Language-Team: LANGUAGE <LL@li.org>\\n"
"Language: \\n"
"MIME-Version: 1.0\\n"
"Content-Type: text/plain; charset=UTF-8\\n"
"Content-Transfer-Encoding: 8bit\\n"
"Plural-Forms: nplurals=INTEGER; plural=EXPRESSION;\\n"

"""


def table():
    sources = sorted(str(path.relative_to(ROOT)) for path in (ROOT / SOURCES).iterdir() if path.suffix in (".cpp", ".h"))
    marks = [f"--keyword={mark}" for mark in MARKS]
    # Placeholders are those of fmt: no text is a format of printf.
    flags = [f"--flag={mark.split(':')[0]}:{argument}:no-c-format"
             for mark in MARKS for argument in (mark.split(":")[1].split(",") if ":" in mark else ["1"])]
    made = subprocess.run(["xgettext", "--language=C++", "--from-code=UTF-8", "--keyword", *marks, *flags,
                           "--add-location=file", "--add-comments=Translators:", "--output=-", *sources],
                          cwd=ROOT, check=True, capture_output=True, text=True).stdout
    texts = re.sub(r"^#, no-c-format\n", "", made[made.index("\n\n") + 2:], flags=re.MULTILINE)
    return HEADER + texts


def main():
    now = table()
    if "--check" not in sys.argv[1:]:
        TABLE.parent.mkdir(exist_ok=True)
        TABLE.write_text(now, encoding="utf-8")
        return 0
    if TABLE.exists() and TABLE.read_text(encoding="utf-8") == now:
        return 0
    print(f"{TABLE.relative_to(ROOT)}: not the texts of {SOURCES}; run tools/window_texts.py")
    return 1


if __name__ == "__main__":
    sys.exit(main())
