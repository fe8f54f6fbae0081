#!/usr/bin/env python3
"""Every public header opens with an example, which compiles without warnings as C11 and runs.

usage: header_examples.py INCLUDE_DIR LIBRARY [CC]
       header_examples.py --self-check

An example is in the first comment of a header: a paragraph "Example: ...", a blank line, and 3 to 15 lines of code,
indented by five blanks: the body of a function, in the setting of header_examples.h. Variables that it does not declare
are those of the rule in base.h.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
FIRST_COMMENT = re.compile(r"\s*/\*.*?\*/", re.DOTALL)
EXAMPLE = re.compile(r"^/\* lensprof/\S+\.h - [^\n]*\n(?: \* \S[^\n]*\n)* \*\n \* Example: [^\n]*\n(?: \* \S[^\n]*\n)* \*\n"
                     r"((?: \*     [^\n]*\n)+)")
DECLARED = re.compile(r"Variables that it does not declare are these:\n((?: \*        [^\n]*\n)+)")
LINES = {"store.h": 6}  # at most; 15 in others


def code_of(block, indent):
    return "".join(line[indent:] + "\n" for line in block.splitlines())


def example_of(text):
    """The code, or None."""
    found = EXAMPLE.match(FIRST_COMMENT.match(text)[0]) if FIRST_COMMENT.match(text) else None
    return code_of(found[1], len(" *     ")) if found else None


def program_of(name, example, variables):
    header = "photo.h" if name == "photo.h" else "lensprof.h"
    return (f'#include <lensprof/lensprof.h>\n#include <lensprof/{header}>\n{variables}#include "header_examples.h"\n'
            f"static void example(void) {{\n{example}}}\n")


def faults_of(name, example, variables, include, library, cc):
    """What is wrong with the example of a header, one text each."""
    if not example:
        return [f"{name}: the first comment does not open with an example; see {pathlib.Path(__file__).name}"]
    count = len(example.splitlines())
    if not 3 <= count <= LINES.get(name, 15):
        return [f"{name}: the example has {count} lines; 3 to {LINES.get(name, 15)} are allowed"]
    with tempfile.TemporaryDirectory() as name_of_folder:
        folder = pathlib.Path(name_of_folder)
        (folder / "example.c").write_text(program_of(name, example, variables))
        libraries = [str(library)]
        if name == "photo.h":  # of the folder "holiday"
            libraries.insert(0, str(library.parent / "liblensprof-photo.so"))
            subprocess.run([library.parent / "lensprof", "simulate", "-o", "holiday", "--size", "400x300"], cwd=folder,
                           check=True, stdout=subprocess.DEVNULL)
        built = subprocess.run(
            [cc, "-std=c11", "-Wall", "-Wextra", "-Werror", f"-I{include}", f"-I{HERE}", "example.c", "-o", "example",
             *libraries, "-lm", f"-Wl,-rpath,{library.parent}"],
            cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if built.returncode:
            return [f"{name}: the example does not compile:\n{built.stdout}"]
        ran = subprocess.run(["./example"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        return [f"{name}: the example ends with {ran.returncode}:\n{ran.stdout[-500:]}"] if ran.returncode else []


def check(include, library, cc):
    declared = DECLARED.search((include / "lensprof" / "base.h").read_text())
    if not declared:
        return ["base.h: does not declare the variables of the examples"]
    variables = code_of(declared[1], len(" *        "))
    return [fault for header in sorted((include / "lensprof").glob("*.h"))
            for fault in faults_of(header.name, example_of(header.read_text()), variables, include, library, cc)]


def self_check():
    head = "/* lensprof/a.h - what it is.\n *\n"
    good = head + " * Example: one.\n *\n *     a();\n *     if (b)\n *         c();\n *\n * Text.\n */\nint a;\n"
    return (example_of(good) == "a();\nif (b)\n    c();\n"
            and example_of(head + " * Text.\n *\n *     B = f(L)\n */\n") is None
            and example_of("int a; /* lensprof/a.h - late.\n *\n * Example: one.\n *\n *     a();\n */\n") is None
            and example_of("/* lensprof/a.h - none. */\n" + good) is None
            and faults_of("a.h", None, "", None, None, None) != []
            and faults_of("a.h", "a();\n", "", None, None, None) != []
            and faults_of("store.h", "a();\n" * 7, "", None, None, None) != [])


def main():
    if sys.argv[1:] == ["--self-check"]:
        return not self_check()
    faults = check(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), (sys.argv[3:] or ["cc"])[0])
    print("\n".join(faults) or "header_examples: no fault")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
