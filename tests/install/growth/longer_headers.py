#!/usr/bin/env python3
"""Writes public headers with longer growing structs, as a later version will have.

usage: longer_headers.py INCLUDE_DIR NEW_INCLUDE_DIR

Every struct whose first member is `uint32_t struct_size`, and every *_image_quality, gets `double longer[4];` at its
end.
Unchanged files are not rewritten, so that nothing is compiled again.
"""

import pathlib
import re
import sys

STRUCT = re.compile(r"(typedef struct (lensprof_\w+) \{\n)(.*?)(\} \2;)", re.DOTALL)


def lengthen(text):
    """The text with longer structs, and their names."""
    names = []

    def longer(match):
        head, name, body, end = match.groups()
        if not (re.match(r"\s*uint32_t struct_size;", body) or name.endswith("_image_quality")):
            return match.group(0)
        names.append(name)
        return f"{head}{body}    double longer[4];\n{end}"

    return STRUCT.sub(longer, text), names


def main():
    include, target = (pathlib.Path(word) / "lensprof" for word in sys.argv[1:])
    target.mkdir(parents=True, exist_ok=True)
    names = []
    for header in sorted(include.glob("*.h")):
        text, found = lengthen(header.read_text(encoding="utf-8"))
        names += found
        written = target / header.name
        if not written.exists() or written.read_text(encoding="utf-8") != text:
            written.write_text(text, encoding="utf-8")
    if len(names) < 16:
        sys.exit(f"longer_headers.py: only {len(names)} structs grow: {' '.join(names)}")


if __name__ == "__main__":
    main()
