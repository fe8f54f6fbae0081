#!/usr/bin/env python3
"""Calls between the object files of a layer have an order: no file calls another that calls it, directly or indirectly.

usage: circle_rules.py [--nm NM] FOLDER               list the circles of the objects below FOLDER; exit 1 for any
       circle_rules.py [--nm NM] [--cc CC] self-check compile a circle and a chain; exit 1 if they are not distinguished
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile


def symbols(nm, file):
    """Global names that an object defines, and global names that it refers to."""
    defined, referred = set(), set()
    for line in subprocess.run([nm, "-g", file], check=True, capture_output=True, text=True).stdout.splitlines():
        fields = line.split()
        if len(fields) >= 2:
            (referred if fields[-2] in "Uwv" else defined).add(fields[-1])
    return defined, referred


def calls_of(nm, folder):
    """For each object below the folder, the other objects that it refers to."""
    tables = {str(file.relative_to(folder)): symbols(nm, file) for file in sorted(folder.rglob("*.o"))}
    owner = {name: file for file, (defined, _) in tables.items() for name in defined}
    return {file: sorted({owner[name] for name in referred if name in owner} - {file})
            for file, (_, referred) in tables.items()}


def circles(calls):
    """One text per call that closes a circle, found depth first."""
    done, path, found = set(), [], []

    def visit(file):
        if file in path:
            found.append(" -> ".join(path[path.index(file):] + [file]))
        elif file not in done:
            path.append(file)
            for other in calls[file]:
                visit(other)
            path.pop()
            done.add(file)

    for file in calls:
        visit(file)
    return found


def check(nm, folder):
    calls = calls_of(nm, folder)
    if not calls:
        print(f"{folder}: no object files; build first")
        return 1
    found = circles(calls)
    for circle in found:
        print(f"call circle: {circle}; move what both ends use to a file below them")
    return 1 if found else 0


def self_check(nm, cc):
    chain = {"a.c": "int b(void); int a(void) { return b(); }", "b.c": "int c(void); int b(void) { return c(); }"}
    trees = [({**chain, "c.c": "int c(void) { return 0; }"}, 0),
             ({**chain, "c.c": "int a(void); int c(void) { return a(); }"}, 1)]
    for sources, expected in trees:
        with tempfile.TemporaryDirectory() as made:
            folder = pathlib.Path(made)
            for name, text in sources.items():
                (folder / name).write_text(text + "\n")
                subprocess.run([cc, "-c", folder / name, "-o", folder / f"{name}.o"], check=True)
            if check(nm, folder) != expected:
                print("a circle was " + ("not found" if expected else "found without one"))
                return 1
    return 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--nm", default="nm")
    parser.add_argument("--cc", default="cc")
    parser.add_argument("folder")
    options = parser.parse_args()
    if options.folder == "self-check":
        return self_check(options.nm, options.cc)
    return check(options.nm, pathlib.Path(options.folder))


if __name__ == "__main__":
    sys.exit(main())
