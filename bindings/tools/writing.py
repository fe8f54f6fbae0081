"""What the writers of all languages share: the first line of a table, and lists over several lines."""
from __future__ import annotations

COMMAND = "bindings/tools/make_abi.py"
WARNING = f"Generated from include/lensprof by {COMMAND}: do not edit; `make abi` regenerates it."
WIDTH = 120


def wrapped(head: str, items: list, tail: str) -> str:
    """A list that begins after `head`; more lines where it is longer than WIDTH."""
    lines, line = [], head
    for i, item in enumerate(items):
        word = item + (tail if i == len(items) - 1 else ",")
        if len(line) + len(word) + 1 > WIDTH and line.strip():
            lines.append(line)
            line = " " * len(head)
        line += word if line == head or not line.strip() else " " + word
    return "\n".join([*lines, line if items else head + tail]) + "\n"


def short(name: str) -> str:
    """The name of a macro or an enumerator without the library's."""
    return name[len("LENSPROF_"):]
