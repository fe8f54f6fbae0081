#!/usr/bin/env python3
"""Runs the tutorials: every command of a Markdown page, in order, in an empty folder, against the program just built.

usage: run_tutorials.py --build DIR [--python PYTHON] [--update] PAGE.md...
       run_tutorials.py --self-check

- A block ```LANGUAGE title="NAME" is a file: it is written before the commands run.
- In a ```console block a line "$ COMMAND" is run by bash; a command that ends in a backslash continues in the next
  line. The lines after it are its output, standard error included. One shell runs all commands of a page.
- A comment in the line before a block changes its treatment:
    <!-- not run: REASON -->      the commands are skipped, or the file is not written
    <!-- needs: PROGRAM... -->    they are skipped if a program is missing; python:NAME is a Python module, /PATH a file
    <!-- exit: CODE -->           the last command must end with this code; by default every command must end with 0
- The folder `lensprof` is the source tree; the program, the library and the Python package are on the path. A page that
  mentions pkg-config or find_package gets an installed copy.

Outputs are compared loosely: blanks are ignored; numbers may differ by 15 % or 0.15, whichever is more; numbers of
seconds and hexadecimal numbers are ignored; "..." on a separate line matches any lines. --update writes outputs that
differ by more into the page.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHOWN_FOLDER = "/home/you/tutorial"  # shown on pages instead of the folder in which a page runs
SKIPPED = 77
BLOCK = re.compile(r"(?:^<!-- *(?P<note>[^\n]*?) *-->\n)?^```(?P<language>\w+)(?P<more>[^\n]*)\n(?P<text>.*?)^```$",
                   re.MULTILINE | re.DOTALL)
HEXADECIMAL = re.compile(r"\b(?:(?=\w*\d)(?=\w*[a-f])[0-9a-f]{4,}|[0-9a-f]{8})\b")
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?=(?P<seconds> s\b)?)")


class Command:
    def __init__(self, line, first, last):
        self.line, self.first, self.last = line, first, last  # its output is in lines first..last of the page
        self.code, self.output = 0, []


def commands_of(text, first_line):
    """The commands of a console block that starts in line first_line of the page."""
    found, lines, i = [], text.splitlines(), 0
    while i < len(lines):
        if not lines[i].startswith("$ "):
            raise SystemExit(f"line {first_line + i}: {lines[i]!r} is output without a command")
        line = lines[i][2:]
        i += 1
        while line.endswith("\\"):
            line, i = line + "\n" + lines[i], i + 1
        begin = i
        while i < len(lines) and not lines[i].startswith("$ "):
            i += 1
        found.append(Command(line, first_line + begin, first_line + i))
    return found


def is_missing(need, python):
    if need.startswith("python:"):
        return subprocess.run([python, "-c", f"import {need[7:]}"], capture_output=True).returncode != 0
    return not os.path.exists(need) if need.startswith("/") else shutil.which(need) is None


class Page:
    def __init__(self, markdown, python=sys.executable):
        self.lines = markdown.splitlines()
        self.files, self.commands, self.skipped = {}, [], []
        for match in BLOCK.finditer(markdown):
            note = match["note"] or ""
            first = markdown.count("\n", 0, match.start("text"))
            if note.startswith("not run:"):
                continue
            missing = [need for need in note.partition("needs:")[2].split() if is_missing(need, python)]
            if missing:
                self.skipped.append(f"line {first}: needs {' '.join(missing)}")
                continue
            title = re.search(r'title="([^"]+)"', match["more"])
            if title:
                if title[1] in self.files:
                    raise SystemExit(f"line {first}: a second file {title[1]!r}")
                self.files[title[1]] = match["text"]
            elif match["language"] == "console":
                found = commands_of(match["text"], first)
                if note.startswith("exit:"):
                    found[-1].code = int(note[5:])
                self.commands += found

    def expected(self, command):
        return self.lines[command.first:command.last]


def numbers_agree(wanted, found):
    first, second = list(NUMBER.finditer(wanted)), list(NUMBER.finditer(found))
    if len(first) != len(second):
        return False
    for a, b in zip(first, second):
        x, y = float(a[0]), float(b[0])
        if not a["seconds"] and abs(x - y) > max(0.15 * abs(x), 0.15) + 1e-9:
            return False
    return True


def lines_agree(wanted, found):
    wanted, found = (HEXADECIMAL.sub("hexadecimal", line) for line in (wanted, found))
    words = [" ".join(NUMBER.sub(" # ", line).split()) for line in (wanted, found)]
    return words[0] == words[1] and numbers_agree(wanted, found)


def agree(wanted, found):
    """Whether two lists of lines are the same output, compared loosely."""
    if not wanted:
        return not found
    if wanted[0].strip() == "...":
        return any(agree(wanted[1:], found[i:]) for i in range(len(found) + 1))
    return bool(found) and lines_agree(wanted[0], found[0]) and agree(wanted[1:], found[1:])


def environment(build, python, work, text):
    """The environment: built programs first on the path, and no user databases."""
    programs = work.parent / "bin"
    programs.mkdir()
    (programs / "python3").symlink_to(python)
    values = dict(os.environ, HOME=str(work.parent), XDG_DATA_HOME=str(work.parent / "share"), LC_ALL="C.UTF-8",
                  PYTHONPATH=str(ROOT / "bindings/python"), PYTHONDONTWRITEBYTECODE="1", XDG_DATA_DIRS="/nowhere",
                  LENSPROF_LIBRARY=str(build / "liblensprof.so"))
    if "pkg-config" in text or "find_package" in text:
        prefix = work.parent / "prefix"
        subprocess.run(["cmake", "--install", build, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
        library = next(prefix.rglob("liblensprof.so")).parent
        values.update(PKG_CONFIG_PATH=str(library / "pkgconfig"), CMAKE_PREFIX_PATH=str(prefix),
                      LD_LIBRARY_PATH=str(library))
        (programs / "lensprof").symlink_to(prefix / "bin/lensprof")
    else:
        (programs / "lensprof").symlink_to(build / "lensprof")
    values["PATH"] = f"{programs}:{values['PATH']}"
    return values


def run(page, work, values):
    """Runs the commands and keeps their outputs; returns the faults."""
    for name, text in page.files.items():
        (work / name).parent.mkdir(parents=True, exist_ok=True)
        (work / name).write_text(text)
    (work / "lensprof").symlink_to(ROOT)
    script = "exec 2>&1 </dev/null\n"
    script += "".join(f"{command.line}\nprintf '\\001%d\\002\\n' $?\n" for command in page.commands)
    done = subprocess.run(["bash", "-c", script], cwd=work, env=values, stdout=subprocess.PIPE, timeout=300)
    output = done.stdout.decode().replace(str(work), SHOWN_FOLDER)
    parts = re.findall(r"(.*?)\001(\d+)\002\n", output, re.DOTALL)
    wrong = []
    for command, (text, code) in zip(page.commands, parts):
        command.output = [line.rstrip() for line in text.splitlines()]
        if int(code) != command.code:
            wrong.append(f"$ {command.line}\nexit code {code}, not {command.code}\n{text}")
    if len(parts) != len(page.commands):
        wrong.append(f"the shell ended after {len(parts)} of {len(page.commands)} commands")
    return wrong


def differences(page):
    for command in page.commands:
        if not agree(page.expected(command), command.output):
            yield command


def shortened(wanted, found):
    """The output, shortened at its start or end as on the page."""
    kept = len(wanted) - 1
    if kept > 0 and wanted[0].strip() == "...":
        return wanted[:1] + found[-kept:]
    if kept > 0 and wanted[-1].strip() == "...":
        return found[:kept] + wanted[-1:]
    return found


def updated(page):
    lines = list(page.lines)
    for command in reversed(list(differences(page))):
        lines[command.first:command.last] = shortened(page.expected(command), command.output)
    return "\n".join(lines) + "\n"


def check(path, build, python, update):
    markdown = path.read_text(encoding="utf-8")
    page = Page(markdown, python)
    for skipped in page.skipped:
        print(f"{path.name}: skipped, {skipped}")
    if "import numpy" in markdown and is_missing("python:numpy", python):
        print(f"{path.name}: skipped, needs python3 with NumPy (package python3-numpy)")
        return SKIPPED
    if not page.commands:
        return SKIPPED
    with tempfile.TemporaryDirectory() as place:
        work = pathlib.Path(place).resolve() / "tutorial"
        work.mkdir()
        wrong = run(page, work, environment(build, python, work, markdown))
    if wrong:
        print(f"{path}:", *wrong, sep="\n")
        return 1
    different = list(differences(page))
    if update:
        path.write_text(updated(page), encoding="utf-8")
        print(f"{path.name}: {len(different)} outputs written")
        return 0
    for command in different:
        print(f"{path}:{command.first + 1}: the output of\n$ {command.line}\ndiffers from the page:",
              *command.output, sep="\n")
    if different:
        print("`make docs-update` writes the outputs into the pages")
    else:
        print(f"{path.name}: {len(page.commands)} commands, {len(page.files)} files")
    return 1 if different else 0


def self_check():
    cases = (
        (["a 1.00"], ["a  1.14"], True), (["a 1.00"], ["a 1.3"], False), (["a 1"], ["b 1"], False),
        (["load 1.0 s"], ["load 9.0 s"], True), (["...", "z"], ["a", "b", "z"], True), (["a", "..."], ["a"], True),
        (["...", "z"], ["a"], False), (["a"], [], False), ([], ["a"], False), (["x 1"], ["x 1 2"], False),
        (["crc 7531b796"], ["crc 1f00"], True),
    )
    wrong = [f"{case}" for case in cases if agree(case[0], case[1]) is not case[2]]
    for before, after in ((["...", "y"], ["...", "c"]), (["y", "..."], ["a", "..."]), (["y"], ["a", "b", "c"])):
        if shortened(before, ["a", "b", "c"]) != after:
            wrong.append(f"shortened: {before}")
    page = Page('<!-- not run: no -->\n```console\n$ false\n```\n```c title="a.c"\nint a;\n```\n<!-- exit: 1 -->\n'
                "```console\n$ cat \\\n  a.c\nint b;\n$ false\n```\n<!-- needs: no-such-program -->\n```console\n$ x\n```\n")
    with tempfile.TemporaryDirectory() as place:
        found = run(page, pathlib.Path(place), dict(os.environ))
    if found or page.files != {"a.c": "int a;\n"} or len(page.commands) != 2 or len(page.skipped) != 1:
        wrong.append(f"page: {found} {page.files} {len(page.commands)} {page.skipped}")
    if [command.output for command in differences(page)] != [["int a;"]] or "\nint a;\n$ false" not in updated(page):
        wrong.append(f"differences: {[command.output for command in differences(page)]}")
    print("\n".join(wrong) or "run_tutorials --self-check: planted differences found")
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--self-check", action="store_true")
    parser.add_argument("--build", type=pathlib.Path)
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    given = parser.parse_args()
    if given.self_check:
        return self_check()
    codes = [check(path, given.build.resolve(), given.python, given.update) for path in given.pages]
    return 1 if 1 in codes else max(codes, default=2)


if __name__ == "__main__":
    sys.exit(main())
