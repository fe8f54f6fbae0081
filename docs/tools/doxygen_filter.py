#!/usr/bin/env python3
"""Input filter of Doxygen (docs/Doxyfile): the plain comments of a header as documentation comments.

usage: doxygen_filter.py HEADER.h

- The first comment documents the file.
- A comment that starts a line documents what follows without a blank line.
- A comment after code documents that code: a member, an enumerator, a macro.
- Indented lines are formulas and are shown as they are. Characters that Doxygen would take for commands are escaped.
"""

import re
import sys

COMMENT = re.compile(r"/\*(.*?)\*/", re.DOTALL)


def words(text):
    return re.sub(r"([\\@#%<>])", r"\\\1", text)


def body_of(comment):
    """The lines of a comment, formulas marked. In a line without a leading star the indent has no meaning."""
    first, *more = comment.split("\n")
    out, inside, listed = [words(first)], False, False
    for line in more:
        star = re.match(r"\s*\*(.*)", line)
        listed = bool(star) and (re.match(r" *- ", star[1]) is not None or listed and star[1].startswith("  "))
        formula = bool(star) and not listed and re.match(r" {3,}\S", star[1]) is not None
        if formula != inside:
            out.append("@verbatim" if formula else "@endverbatim")
            inside = formula
        out.append(star[1] if formula else words(star[1] if star else line.strip()))
    if inside:
        out.append("@endverbatim")
    return "\n".join(out)


def filtered(source):
    parts, place = [], 0
    for number, match in enumerate(COMMENT.finditer(source)):
        before = source[source.rfind("\n", 0, match.start()) + 1:match.start()]
        after = source[match.end():]
        text = match[1]
        if number == 0:
            name, _, rest = text.strip().partition(" - ")
            new = f"/** @file {name}\n * @brief {body_of(rest)}\n */"
        elif before.strip() and not before.strip().startswith("*"):
            new = f"/**<{body_of(text)}*/"
        elif re.match(r"[ \t]*\n[ \t]*[^\s/]", after):
            new = f"/**{body_of(text)}*/"
        else:
            new = match[0]
        parts += [source[place:match.start()], new]
        place = match.end()
    return "".join(parts) + source[place:]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        sys.stdout.write(filtered(file.read()))
