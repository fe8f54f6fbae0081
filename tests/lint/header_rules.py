#!/usr/bin/env python3
"""Rules for the public headers: each compiles alone as C99 and C++17, and its numbers are pinned.

usage: header_rules.py [--cc CC] [--cxx CXX] CHECK

  alone INCLUDE_DIR     every header compiles by itself, twice in a row, without a warning
  windows INCLUDE_DIR   the same with clang for Microsoft's ABI; exit 77: clang is not installed
  numbers INCLUDE_DIR   enumerators and numeric macros = enumerators.txt, in the text and for the compiler
  list INCLUDE_DIR      print the content that enumerators.txt should have
  self-check            every check must find a planted violation

Prints violations; exit 1 if there are any.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LIST = pathlib.Path(__file__).with_name("enumerators.txt")
STRICT = ["-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
NUMBER = r"\(?-?(?:0[xX][0-9a-fA-F]+|\d+(?:\.\d+)?)[uUlL]*\)?"


def compile_text(compiler, options, include, text, suffix):
    """The compiler's messages; empty if it accepts the source."""
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / ("alone" + suffix)
        source.write_text(text)
        done = subprocess.run(
            [compiler, *options, *STRICT, "-I", str(include), str(source)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            universal_newlines=True,
        )
    return "" if done.returncode == 0 else done.stdout or f"{compiler} failed"


def headers_of(include):
    return sorted((include / "lensprof").glob("*.h"))


def check_alone(cc, cxx, include, also=()):
    """`also`: options that select another target."""
    violations = []
    for header in headers_of(include):
        text = f"#include <lensprof/{header.name}>\n" * 2 + "int lint(void);\n"
        for compiler, options, suffix in ((cc, ["-std=c99"], ".c"), (cxx, ["-std=c++17"], ".cpp")):
            said = compile_text(compiler, [*also, *options], include, text, suffix)
            if said:
                violations.append(
                    f"{header.name}: does not compile alone with {' '.join([compiler, *also, *options])}:\n{said}"
                )
    return violations


def check_windows(include):
    """As Microsoft's compiler reads the headers: with its macros, and none of GCC's."""
    if not shutil.which("clang"):
        print("header_rules: windows: skipped: clang is not installed")
        sys.exit(77)
    return check_alone("clang", "clang", include, ["--target=x86_64-pc-windows-msvc", "-ffreestanding", "-fsyntax-only"])


def numbers_of(include):
    """[(name, value as written)] in the order of the headers, and faults in how they are written."""
    found, violations = [], []
    for header in headers_of(include):
        text = re.sub(r"/\*.*?\*/", " ", header.read_text(encoding="utf-8"), flags=re.DOTALL)
        for name, value in re.findall(rf"^\s*#define\s+(LENSPROF_\w+)\s+({NUMBER})\s*$", text, flags=re.MULTILINE):
            if not name.startswith("LENSPROF_VERSION_"):
                found.append((name, value))
        for body in re.findall(r"\benum\b[^{;]*\{([^}]*)\}", text):
            for entry in filter(None, (part.strip() for part in body.split(","))):
                match = re.fullmatch(rf"(\w+)\s*=\s*({NUMBER})", entry)
                if match:
                    found.append(match.groups())
                else:
                    violations.append(f"{header.name}: {entry}: an enumerator needs an explicit number")
    return found, violations


def check_numbers(cc, include, listed):
    found, violations = numbers_of(include)
    written = dict(found)
    for name, value in listed.items():
        if name not in written:
            violations.append(f"{name}: is gone; existing programs use it as {value}")
        elif written[name] != value:
            violations.append(f"{name}: was {value} and is now {written[name]}; numbers are pinned for ever")
    violations += [
        f"{name}: is new; add the line '{name} {value}' to {LIST.name}" for name, value in found if name not in listed
    ]
    if not violations:
        # The text may be hidden by #if, so the compiler checks integers again.
        asserts = "".join(
            f'_Static_assert((int64_t){name} == {value}, "{name}");\n'
            for name, value in listed.items()
            if "." not in value
        )
        present = [name for name in ("lensprof.h", "photo.h") if (pathlib.Path(include) / "lensprof" / name).exists()]
        headers = "".join(f"#include <lensprof/{name}>\n" for name in present)
        said = compile_text(cc, ["-std=c11"], include, headers + asserts, ".c")
        if said:
            violations.append(said)
    return violations


def read_list():
    listed = {}
    for line in LIST.read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            name, value = line.split()
            if name in listed:
                sys.exit(f"{LIST}: has {name} twice")
            listed[name] = value
    return listed


def self_check(cc, cxx):
    failures = []
    good = (
        "#ifndef X\n#define X\n#include <stdint.h>\n#define LENSPROF_MASK 0x10u\n#define LENSPROF_UNKNOWN (-1.0)\n"
        "typedef enum lensprof_e {\n    LENSPROF_A = 0, /* a, b */\n    LENSPROF_B = 7\n} lensprof_e;\n#endif\n"
    )
    listed = {"LENSPROF_MASK": "0x10u", "LENSPROF_UNKNOWN": "(-1.0)", "LENSPROF_A": "0", "LENSPROF_B": "7"}

    def expect(what, text, wanted_alone, wanted_numbers):
        with tempfile.TemporaryDirectory() as folder:
            include = pathlib.Path(folder)
            (include / "lensprof").mkdir()
            (include / "lensprof" / "lensprof.h").write_text(text)
            for check, wanted in (
                (check_alone(cc, cxx, include), wanted_alone),
                (check_numbers(cc, include, listed), wanted_numbers),
            ):
                if len(check) != len(wanted) or any(word not in violation for word, violation in zip(wanted, check)):
                    failures.append(f"{what}: found {check}, wanted {wanted}")

    expect("good", good, [], [])
    expect(
        "needs another header",
        good.replace("#include <stdint.h>", "size_t x(void);"),
        ["-std=c99", "-std=c++17"],
        ["int64_t"],
    )
    expect("no guard", good.replace("#ifndef X", "#if 1"), ["-std=c99", "-std=c++17"], [])
    expect("C++ keyword", good.replace("#endif", "int f(int class);\n#endif"), ["-std=c++17"], [])
    expect(
        "C11 only",
        good.replace("#endif", "struct s {\n    union {\n        int i;\n        float f;\n    };\n};\n#endif"),
        ["-std=c99"],
        [],
    )
    expect("changed", good.replace("= 7", "= 8"), [], ["LENSPROF_B: was 7 and is now 8"])
    expect("changed macro", good.replace("0x10u", "0x20u"), [], ["LENSPROF_MASK: was"])
    expect("gone", good.replace("LENSPROF_A = 0,", ""), [], ["LENSPROF_A: is gone"])
    expect("new", good.replace("= 7", "= 7, LENSPROF_C = 9"), [], ["'LENSPROF_C 9'"])
    expect("implicit", good.replace("= 7", "= 7, LENSPROF_C"), [], ["LENSPROF_C: an enumerator needs"])
    expect(
        "hidden",
        good.replace("typedef", "#if 0\ntypedef").replace("lensprof_e;", "lensprof_e;\n#endif"),
        [],
        ["LENSPROF_B"],
    )
    print("\n".join(failures) or "header_rules: planted violations found")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--cxx", default="c++")
    parser.add_argument("check", choices=["alone", "windows", "numbers", "list", "self-check"])
    parser.add_argument("include", nargs="?", type=pathlib.Path)
    options = parser.parse_args()
    if options.check == "self-check":
        return self_check(options.cc, options.cxx)
    if options.include is None or not headers_of(options.include):
        sys.exit(f"{options.include}: holds no lensprof/*.h")
    if options.check == "list":
        print("\n".join(f"{name} {value}" for name, value in numbers_of(options.include)[0]))
        return 0
    checks = {
        "alone": lambda: check_alone(options.cc, options.cxx, options.include),
        "windows": lambda: check_windows(options.include),
        "numbers": lambda: check_numbers(options.cc, options.include, read_list()),
    }
    violations = checks[options.check]()
    print("\n".join(violations) or f"header_rules: {options.check}: no violation")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
