#!/usr/bin/env python3
"""Runs clang or clang-tidy on every source of compile_commands.json in src/, one process per core.

usage: each_source.py BUILD_DIR clang|clang-tidy [PART]    only sources whose path contains PART; exit 1 on any finding
"""

import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

# Kernels are compiled with instruction set options that only GCC needs; tables have no code.
LEFT_OUT = ("/kernels/row_", "_table.c")


def flags(entry):
    """Defines, include paths and the language standard of a compile command."""
    words, kept, skip = shlex.split(entry["command"]), [], False
    for i, word in enumerate(words):
        if skip:
            skip = False
        elif word == "-isystem":
            kept += [word, words[i + 1]]
            skip = True
        elif word.startswith(("-I", "-D", "-std=")):
            kept.append(word)
    return kept


def command(tool, entry):
    source = entry["file"]
    if tool == "clang-tidy":
        return ["clang-tidy", "--quiet", source, "--"] + flags(entry)
    compiler = "clang" if source.endswith(".c") else "clang++"
    warnings = ["-Wall", "-Wextra", "-Wshadow", "-Wpointer-arith", "-Werror"]
    return [compiler, "-fsyntax-only"] + warnings + flags(entry) + [source]


def main():
    build, tool = sys.argv[1:3]
    part = sys.argv[3] if len(sys.argv) > 3 else ""
    entries = json.loads(pathlib.Path(build, "compile_commands.json").read_text())
    root = str(pathlib.Path(__file__).resolve().parents[2] / "src") + "/"
    entries = [
        e for e in entries if e["file"].startswith(root) and part in e["file"] and not any(w in e["file"] for w in LEFT_OUT)
    ]
    if not entries:
        sys.exit(f"{build}/compile_commands.json: no source of src/ to check; run make build")

    def run(entry):
        done = subprocess.run(command(tool, entry), cwd=entry["directory"], capture_output=True, text=True)
        return entry["file"], done

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for _, done in pool.map(run, entries):
            if done.returncode:
                failed += 1
                print(done.stdout + done.stderr)
    print(f"{len(entries)} sources, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
