#!/usr/bin/env python3
"""Budgets of size: functions of 60 lines, files of 500. Only warnings; they never fail a build.

usage: budgets.py SOURCE_DIR     print what exceeds its budget; exit 0
       budgets.py --self-check   exit 1 if a planted function or file is not found
"""

import pathlib
import re
import sys
import tempfile

FUNCTION_LINES, FILE_LINES = 60, 500
EXEMPT = {  # tables
    "src/core/emor_table.c",
    "src/core/typical_table.c",
    "src/fit/methods/transfer_function/log_emor_table.cpp",
    "bindings/python/lensprof/_abi.py",
    "tests/python/abi_dump.c",
}
FOLDERS = ("src", "include", "examples", "bindings", "tests")
CONTAINER = re.compile(r'\b(namespace|class|struct|union|enum)\b[^()=]*$|\bextern\s*""\s*$')


def blank(text):
    """Comments and literals without their text; line numbers stay the same."""
    pattern = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-zA-Z])\'(?:\\.|[^\'\\\n])*\'', re.DOTALL
    )

    def replace(match):
        word = match.group()
        quote = {"/": " ", "R": '""', '"': '""', "'": "' '"}[word[0]]
        return quote + "\n" * word.count("\n")

    text = pattern.sub(replace, text)
    return re.sub(r"^[ \t]*#(?:[^\n\\]|\\\n|\\.)*", lambda m: "\n" * m.group().count("\n"), text, flags=re.MULTILINE)


def functions(text):
    """(name, first line, lines) of every function, as far as braces show."""
    text, found, depth, start, line, head_line = blank(text), [], 0, 0, 1, None
    opened = None  # (name, line, depth) of the current function
    for i, c in enumerate(text):
        if c == "\n":
            line += 1
        elif c == "{":
            head = text[start:i].strip()
            match = re.search(r"([\w:~]+|operator\S+)\s*\(", head)
            if opened is None and match and not CONTAINER.search(head) and not re.search(r"=\s*$", head):
                opened = (match.group(1), head_line or line, depth)
            depth += 1
        elif c == "}":
            depth -= 1
            if opened and depth == opened[2]:
                found.append((opened[0], opened[1], line - opened[1] + 1))
                opened = None
        if c in ";{}" and (c != ";" or text[start:i].count("(") <= text[start:i].count(")")):
            start, head_line = i + 1, None
        elif head_line is None and not c.isspace():
            head_line = line
    return found


def over_budget(root):
    warnings = []
    for path in sorted(p for folder in FOLDERS for p in (root / folder).rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix not in {".c", ".h", ".cpp", ".hpp", ".py", ".sh"} or name in EXEMPT or not path.is_file():
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        if text.count("\n") > FILE_LINES:
            warnings.append(f"{name}: {text.count(chr(10))} lines; a file should have at most {FILE_LINES} lines")
        if path.suffix in {".c", ".h", ".cpp", ".hpp"}:
            warnings += [
                f"{name}:{first}: {function} has {lines} lines; {FUNCTION_LINES} fit on a screen"
                for function, first, lines in functions(text)
                if lines > FUNCTION_LINES
            ]
    return warnings


def self_check():
    def body(lines):
        return "{\n" + "    if (x) { y = '}'; } /* } */ // }\n" * (lines - 3) + "}\n"

    text = (
        '#define OPEN {\nnamespace a {\nextern "C" {\nstruct s { int x; };\nconst int t[] = {\n' + "1,\n" * 80 + "};\n"
    )
    text += "static int fits(int x)\n" + body(60) + "static int\nlong_one(int x)\n" + body(61) + "}\n}\n"
    text += "class k {\n    int in_class(int x) const " + body(70) + "};\nk::k(int x) : y(x) " + body(62)
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "src").mkdir()
        (root / "src" / "a.cpp").write_text(text)
        (root / "src" / "b.c").write_text("\n" * 501)
        found = over_budget(root)
    wanted = ["a.cpp:147: long_one has 62", "in_class has 69", "k::k has 61", "b.c: 501 lines"]
    good = len(found) == len(wanted) and all(w in f for w, f in zip(wanted, found))
    print("budgets: planted functions and files found" if good else f"found {found}, wanted {wanted}")
    return 0 if good else 1


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    warnings = over_budget(pathlib.Path(sys.argv[1]))
    print("\n".join("warning: " + w for w in warnings) or "budgets: all within budget")
    return 0


if __name__ == "__main__":
    sys.exit(main())
