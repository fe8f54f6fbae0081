#!/usr/bin/env python3
"""The table of renamed options in CHANGELOG.md is that of the source, one line each.

usage: renamed_options.py SOURCE_DIR            exit 1 if they differ
       renamed_options.py SOURCE_DIR --update   write the table of CHANGELOG.md
       renamed_options.py --self-check          exit 1 if a planted difference is not found
"""

import pathlib
import re
import sys

BEGIN, END = "  | before | now |\n  |---|---|\n", "\n\n"


def rows_of(source):
    """The lines of the table, from renamed_options.hpp."""
    pairs = re.findall(r'\{"(--[\w-]+)", "([^"]+)"\},', source)
    return "\n".join("  | `%s` | `%s` |" % (before, now.replace("|", "\\|")) for before, now in pairs)


def span(changes):
    """Begin and end of the lines of the table in CHANGELOG.md."""
    begin = changes.find(BEGIN)
    return (begin + len(BEGIN), changes.find(END, begin)) if begin >= 0 else (0, 0)


def differing(source, changes):
    begin, end = span(changes)
    wanted, found = set(rows_of(source).splitlines()), set(changes[begin:end].splitlines())
    if changes[begin:end] == rows_of(source):
        return []
    return sorted(f"CHANGELOG.md lacks{row}" for row in wanted - found) + sorted(
        f"renamed_options.hpp lacks{row}" for row in found - wanted) or ["the rows have another order"]


def self_check():
    source = '    {"--a", "--fit a=1|2"},\n    {"--b", "--set b=NUMBER"},\n'
    text = "x\n\n" + BEGIN + "  | `--a` | `--fit a=1\\|2` |\n  | `--b` | `--set b=NUMBER` |\n\nmore\n"
    good = not differing(source, text) and len(differing(source, text.replace("NUMBER", "COUNT"))) == 2
    good = good and len(differing(source, text.replace("`--a`", "`--c`"))) == 2 and differing(source, "nothing")
    print("renamed options: planted differences found" if good else "a planted difference was not found")
    return 0 if good else 1


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--update"]):
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    page = root / "CHANGELOG.md"
    source, changes = (root / "src/cli/program/renamed_options.hpp").read_text(), page.read_text()
    if sys.argv[2:]:
        begin, end = span(changes)
        page.write_text(changes[:begin] + rows_of(source) + changes[end:])
        return 0
    lines = differing(source, changes)
    print("\n".join(lines) or "renamed options: CHANGELOG.md has those of the source")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
