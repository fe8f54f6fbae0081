#!/usr/bin/env python3
"""The binary interface compared with the committed baseline, by abidiff (package abigail-tools).

usage: abi_check.py [--cc CC] check        exit 1 if functions or layouts differ from abi-baseline.xml
       abi_check.py [--cc CC] write        writes abi-baseline.xml (`make abi-baseline`)
       abi_check.py [--cc CC] self-check   planted changes must be found

The library itself is not compared, because compiling its debug information would take minutes. Instead, a shared object
with an empty function for every prototype of the headers has the same exports and types; lint_exports checks that the
library exports exactly these functions. Exit 77 (skipped) without abigail-tools, or on another processor than the
baseline's.
"""

import argparse
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
BASELINE = HERE / "abi-baseline.xml"
INCLUDE = HERE.parents[1] / "include"
PROTOTYPE = re.compile(r"^LENSPROF_API\s+(?:LENSPROF_MUST_USE\s+)?([^;{}]*?\blensprof_\w+\([^;{}]*\));", re.MULTILINE)


def stub_source(include):
    """A function for every prototype; the return values do not matter."""
    lines = ['#include <lensprof/lensprof.h>', '#include <lensprof/photo.h>', '#pragma GCC diagnostic ignored "-Wreturn-type"']
    for header in sorted((include / "lensprof").glob("*.h")):
        text = re.sub(r"/\*.*?\*/", "", header.read_text(encoding="utf-8"), flags=re.DOTALL)
        lines += [f"{' '.join(prototype.split())} {{ __builtin_unreachable(); }}" for prototype in PROTOTYPE.findall(text)]
    return "\n".join(lines) + "\n"


def compile_stubs(cc, include, folder):
    source, library = folder / "stubs.c", folder / "liblensprof.so"
    source.write_text(stub_source(include), encoding="utf-8")
    subprocess.run([cc, "-std=gnu11", "-g", "-O0", "-w", "-shared", "-fPIC", "-fvisibility=hidden", "-I", str(include),
                    str(source), "-o", str(library)], check=True)
    return library


def describe(cc, include, folder):
    """The ABI of the headers as XML."""
    out = folder / "abi.xml"
    subprocess.run(["abidw", "--no-show-locs", "--no-corpus-path", "--no-comp-dir-path", "--no-write-default-sizes", "--no-parameter-names",
                    "--out-file", str(out), str(compile_stubs(cc, include, folder))], check=True)
    return out


def differences(cc, include):
    """The report of abidiff on the headers and the baseline; empty if nothing differs."""
    with tempfile.TemporaryDirectory() as name:
        found = describe(cc, include, pathlib.Path(name))
        done = subprocess.run(["abidiff", "--harmless", str(BASELINE), str(found)], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True)
    if done.returncode & 3:
        sys.exit(f"abidiff failed:\n{done.stdout}")
    return done.stdout if done.returncode else ""


# Examples of careless changes: (header, text, replacement).
PLANTED = (
    ("store.h", "    uint32_t rows; ", "    uint64_t rows; "),
    ("profile.h", "    double focal_mm; ", "    double focal; "),
    ("base.h", "    LENSPROF_ERROR_SIZE = 3, ", "    LENSPROF_ERROR_SIZE = 6, "),
    ("apply.h", "lensprof_sample_type_bytes(uint32_t type)", "lensprof_sample_type_bytes(uint64_t type)"),
    ("base.h", "LENSPROF_API const char *lensprof_version(void);", ""),
)


def self_check(cc):
    failures = []
    for header, old, new in PLANTED:
        with tempfile.TemporaryDirectory() as name:
            include = pathlib.Path(name)
            shutil.copytree(INCLUDE / "lensprof", include / "lensprof")
            path = include / "lensprof" / header
            text = path.read_text(encoding="utf-8")
            if text.count(old) != 1:
                failures.append(f"{header}: has no {old!r} to change")
                continue
            path.write_text(text.replace(old, new), encoding="utf-8")
            if not differences(cc, include):
                failures.append(f"{header}: {old!r} -> {new!r} is not found")
    print("\n".join(failures) or "abi_check: planted changes found")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cc", default="cc")
    parser.add_argument("action", choices=["check", "write", "self-check"])
    options = parser.parse_args()
    if not (shutil.which("abidiff") and shutil.which("abidw")):
        print("skipped: needs abidiff; install the package abigail-tools (make test-deps)")
        return 77
    if platform.machine() != "x86_64":
        print("skipped: the baseline is for x86_64")
        return 77
    if options.action == "self-check":
        return self_check(options.cc)
    if options.action == "write":
        with tempfile.TemporaryDirectory() as name:
            shutil.copy(describe(options.cc, INCLUDE, pathlib.Path(name)), BASELINE)
        return 0
    found = differences(options.cc, INCLUDE)
    print(found or "abi_check: no difference from the baseline")
    if found:
        print("Old programs must keep running: members only at the end of structs that grow, nothing removed. If the"
              " change keeps this rule, run `make abi-baseline` and commit the baseline.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
