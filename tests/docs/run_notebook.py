#!/usr/bin/env python3
"""Runs the code cells of a notebook one after the other, in a new folder; exit 1 if one raises.

usage: run_notebook.py --build BUILD_DIR NOTEBOOK    with the libraries and the program of a build
       run_notebook.py --self-check
"""
import json
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(notebook):
    """The text of the first error; empty without one."""
    names = {"__name__": "notebook"}
    for number, cell in enumerate(notebook["cells"]):
        if cell["cell_type"] != "code":
            continue
        try:
            exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
        except Exception as error:  # of any kind: the cell is wrong
            return f"cell {number}: {type(error).__name__}: {error}"
    return ""


def main():
    cell = {"cell_type": "code", "source": ["a = 1\n", "assert a == 1"]}
    if sys.argv[1:] == ["--self-check"]:
        wrong = run({"cells": [cell]}) or not run({"cells": [cell, {"cell_type": "code", "source": ["assert a == 2"]}]})
        return bool(wrong)
    try:
        import numpy  # noqa: F401
    except ImportError:
        print("skipped: this python3 has no NumPy")
        return 77
    build, page = pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
    os.environ["LENSPROF_LIBRARY"] = str(build / "liblensprof.so")
    os.environ["PATH"] = f"{build}{os.pathsep}{os.environ['PATH']}"
    sys.path.insert(0, str(ROOT / "bindings" / "python"))
    sys.dont_write_bytecode = True
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        wrong = run(json.loads(page.read_text()))
        os.chdir("/")
    print(wrong or f"{page.name}: every cell runs")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
