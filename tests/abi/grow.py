"""Writes relevo/plugin.h as a later minor version may be: every struct has grown by two words, every table by a function.

Usage: grow.py plugin.h OUT.h
"""
import pathlib
import re
import sys

text = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
text, minors = re.subn(r"#define RELEVO_ABI_MINOR 1u", "#define RELEVO_ABI_MINOR 7u", text)
table = re.compile(r"^(\} relevo_\w+_1;)$", re.M)
text, tables = table.subn(r"    relevo_status (*grown)(void* self, int32_t word);\n\1", text)
struct = re.compile(r"^(\} relevo_(?:frame|texture_info|texels|draw|box|heights|nodes|mark|module);)$", re.M)
text, structs = struct.subn(r"    uint64_t grown_one;\n    int32_t grown_two, grown_three;\n\1", text)
text, hosts = re.subn(r"(    void \(\*fail\)\(.*\n)", r"\1    uint64_t grown_one;\n", text)
if (minors, tables, structs, hosts) != (1, 9, 9, 1):
    sys.exit(f"grow.py: the header has changed: {minors} minor, {tables} tables, {structs} structs, {hosts} hosts")
out = pathlib.Path(sys.argv[2])
out.parent.mkdir(parents=True, exist_ok=True)
out.write_text(text, encoding="utf-8")
