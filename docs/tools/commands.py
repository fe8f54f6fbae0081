#!/usr/bin/env python3
"""Writes docs/reference/commands.md: what `lensprof COMMAND --help-all` prints, of every command and verb.

usage: commands.py SOURCE_DIR LENSPROF            write the page
       commands.py SOURCE_DIR LENSPROF --check    exit 1 if the page is out of date

Builds without optional libraries may lack some lines; the page is that of a build with all of packages.txt.
"""

import pathlib
import re
import subprocess
import sys
import textwrap

from generated import write_or_check

COLUMNS = 112

HEAD = """# Commands

<!-- Made by docs/tools/commands.py from the program's help; `make docs-update` makes it again. -->

This page is what `lensprof COMMAND --help-all` prints, with long lines wrapped. `lensprof help COMMAND` leaves out the
expert options.

"""


def wrapped(line):
    """A long line broken at COLUMNS, below the place where its explanation begins."""
    if len(line) <= COLUMNS:
        return [line]
    indent = re.match(r"  \S.*?  +(?=\S)| *(?=\S)", line)[0]
    return textwrap.wrap(line[len(indent):], COLUMNS, initial_indent=indent, subsequent_indent=" " * len(indent),
                         break_long_words=False, break_on_hyphens=False)


def help_of(program, *names):
    done = subprocess.run([program, *names, "--help-all"], capture_output=True, text=True, check=True)
    lines = [part for line in done.stdout.splitlines() for part in wrapped(line.rstrip())]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip() + "\n"


def names_in(text):
    """The names in the list "Commands:" of a help."""
    listed = re.search(r"^(?:Commands|Subcommands|Verbs):\n((?:  .*\n)+)", text + "\n", re.MULTILINE)
    return re.findall(r"^  (\w[\w-]*)", listed[1], re.MULTILINE) if listed else []


def section(level, title, text):
    return f"{'#' * level} {title}\n\n```text\n{text}```\n\n"


def page(program):
    top = help_of(program)
    text = HEAD + section(2, "lensprof", top)
    for name in names_in(top):
        if name in ("help", "version"):
            continue
        own = help_of(program, name)
        text += section(2, f"lensprof {name}", own)
        for verb in names_in(own):
            text += section(3, f"lensprof {name} {verb}", help_of(program, name, verb))
    return text.rstrip() + "\n"


def main():
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["--check"]):
        sys.exit(__doc__)
    return write_or_check(pathlib.Path(sys.argv[1]), "docs/reference/commands.md", page(sys.argv[2]), "--check" in sys.argv)


if __name__ == "__main__":
    sys.exit(main())
