#!/usr/bin/env python3
"""Texts of the library suit every program: they do not mention options and commands of the command line program.

usage: text_rules.py SOURCE_DIR       list violations; exit 1 if there are any
       text_rules.py --self-check     plant violations in a temporary tree; exit 1 if one is not found

String literals of src/{core,falloff,fit,formats,photo,store} must not have a word that begins with "--", `lensprof` with the
name of one of its commands, or "option of the command". A program offers its options based on the code of a reason
(docs/reasons.md), or on the status and the item of an error.
"""

import pathlib
import re
import sys
import tempfile

LAYERS = ("core", "falloff", "fit", "formats", "photo", "store")
SOURCES = {".c", ".h", ".cpp", ".hpp"}
# A comment, a character, or a sequence of string literals, which the compiler joins.
TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/) | '(?:[^'\\\n]|\\.)+' | (?P<text>"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*)""",
    re.VERBOSE | re.DOTALL,
)
OPTION = re.compile(r"(?<![\w-])--[a-z][\w-]*")
OF_COMMAND = re.compile(r"\boptions? of the (?:command|program)\b")


def commands_of(root):
    """Names of the commands: those of the functions declare_NAME of src/cli."""
    text = "".join(path.read_text(encoding="utf-8") for path in sorted((root / "src" / "cli").rglob("*.hpp")))
    return sorted(set(re.findall(r"\bvoid declare_([a-z]+)\(Command &program\)", text)))


def texts_of(text):
    """(line, kind, text) of every comment and every joined sequence of string literals, except names of includes."""
    text = re.sub(r"^[ \t]*#[ \t]*include[^\n]*", "", text, flags=re.MULTILINE)
    for match in TOKEN.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        if match["comment"]:
            yield line, "comment", match["comment"]
        elif match["text"]:
            yield line, "text", "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', match["text"]))


def literals_of(text):
    """(line, text) of every sequence of string literals."""
    return ((line, literal) for line, kind, literal in texts_of(text) if kind == "text")


def check(root):
    commands = commands_of(root)
    if not commands:
        return [f"{root}/src/cli: no function declare_NAME of a command"]
    of_program = re.compile(rf"\blensprof (?:{'|'.join(commands)})\b")
    violations = []
    for layer in LAYERS:
        for path in sorted((root / "src" / layer).rglob("*")):
            if path.suffix not in SOURCES:
                continue
            for line, text in literals_of(path.read_text(encoding="utf-8")):
                for rule in (OPTION, of_program, OF_COMMAND):
                    found = rule.search(text)
                    if found:
                        violations.append(f"{path.relative_to(root)}:{line}: names {found[0]!r} of the program")
    return violations


def self_check():
    failures = []

    def expect(what, text, wanted, folder="fit/verdict"):
        with tempfile.TemporaryDirectory() as place:
            root = pathlib.Path(place)
            for name, content in (("cli/program/commands.hpp", "void declare_build(Command &program);\nvoid declare_flat(Command &program);\n"),
                                  (f"{folder}/planted.cpp", text)):
                path = root / "src" / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(content)
            found = check(root)
            if len(found) != len(wanted) or any(word not in line for word, line in zip(wanted, found)):
                failures.append(f"{what}: found {found}, wanted {wanted}")

    expect("good", 'say("lensprof reads a -- b; images-- of 2; not a lensprof database");\n', [])
    expect("option", 'int a;\nsay("its black is raised (bracket --black)");\n', ["planted.cpp:2: names '--black'"])
    expect("split option", 'say("free more: "\n    "--free all");\n', ["--free"])
    expect("joined words", 'say("give what lensprof "\n    "build prints");\n', ["lensprof build"])
    expect("quoted command", 'say("see `lensprof flat`");\n', ["lensprof flat"])
    expect("command word", 'say("an option of the command");\n', ["option of the command"])
    expect("two", 'say("--one"); say("options of the program");\n', ["--one", "options of the program"])
    expect("comments", "// `lensprof build --free`\n/* \"--x\" */ int n = '\"'; // --free\n", [])
    expect("include", '#include "fit/--x.hpp"\n', [])
    expect("another folder", 'say("--free");\n', [], folder="cli/fitting")
    for layer in LAYERS:
        expect(layer, 'say("--free");\n', ["--free"], folder=layer)
    print("\n".join(failures) or "text_rules: planted violations found")
    return 1 if failures else 0


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    violations = check(pathlib.Path(sys.argv[1]))
    print("\n".join(violations) or "text_rules: no violation")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
