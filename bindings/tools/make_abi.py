#!/usr/bin/env python3
"""Generates each language's view of the C interface from the public headers, for developers (`make abi`).

usage: make_abi.py [--cc CC]           write the tables of all languages and tests/python/abi_dump.c
       make_abi.py [--cc CC] --check   exit 1 where one of them is not what the headers give; write nothing

Needs pycparser (package python3-pycparser) and a C preprocessor. Users of the bindings need neither. headers.py reads
the headers; a module per language writes. C++ and Go include the headers themselves and have no tables.
"""
from __future__ import annotations

import argparse
import os
import pathlib
import sys

from headers import Interface, Refused
from write_java import java_text
from write_node import node_text
from write_python import dump_text, python_text
from write_rust import rust_dump_text, rust_text

ROOT = pathlib.Path(__file__).resolve().parents[2]


def generated(include: pathlib.Path, cc: str) -> dict:
    """Path in the repository -> text, of all files."""
    interface = Interface(include, cc)
    return {"bindings/python/lensprof/_abi.py": python_text(interface),
            "bindings/rust/lensprof-sys/src/abi.rs": rust_text(interface),
            "bindings/rust/lensprof-sys/examples/abi_dump.rs": rust_dump_text(interface),
            "bindings/node/abi.js": node_text(interface),
            "bindings/java/src/main/java/lensprof/Abi.java": java_text(interface),
            "tests/python/abi_dump.c": dump_text(interface)}


def stale(texts: dict, root: pathlib.Path) -> list:
    """The files below `root` that are not as they are given in `texts`."""
    return [path for path, text in texts.items()
            if not (root / path).exists() or (root / path).read_text(encoding="utf-8") != text]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cc", default=os.environ.get("CC", "cc"), help="C compiler; default: CC, else cc")
    parser.add_argument("--check", action="store_true", help="compare only")
    arguments = parser.parse_args()
    try:
        texts = generated(ROOT / "include", arguments.cc)
    except (Refused, OSError) as error:
        print(f"make_abi.py: {error}", file=sys.stderr)
        return 1
    old = stale(texts, ROOT)
    for path in old:
        if arguments.check:
            print(f"{path}: not what the headers give; run `make abi` and commit it", file=sys.stderr)
        else:
            (ROOT / path).parent.mkdir(parents=True, exist_ok=True)
            (ROOT / path).write_text(texts[path], encoding="utf-8")
            print(f"wrote {path}")
    return 1 if old and arguments.check else 0


if __name__ == "__main__":
    sys.exit(main())
