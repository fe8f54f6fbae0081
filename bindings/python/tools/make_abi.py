#!/usr/bin/env python3
"""Generates the package's view of the C interface from the public headers, for developers (`make abi`).

usage: make_abi.py [--cc CC]           write lensprof/_abi.py and tests/python/abi_dump.c
       make_abi.py [--cc CC] --check   exit 1 where one of them is not what the headers give; write nothing

Needs pycparser (package python3-pycparser) and a C preprocessor. Users of the package need neither. The names of
classes come from those in C: lensprof_gain_grid is GainGrid; the exceptions are listed below. Macros of a single bit
in hexadecimal make an IntFlag: LENSPROF_FREE_K1 0x02u is Free.K1; a macro that joins them with | is a member, too. A
declaration that has no form here (union, bit field, inline function that is more than a call) is refused, with its
place.
"""
from __future__ import annotations

import argparse
import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    from pycparser import c_ast, c_parser
except ImportError:
    sys.exit("make_abi.py: there is no pycparser; install the package python3-pycparser")

ROOT = pathlib.Path(__file__).resolve().parents[3]
COMMAND = "bindings/python/tools/make_abi.py"
WIDTH = 120

# ctypes.Structure has any attribute for type checkers, so that they would accept any attribute of a subclass.
STRUCTURE = '''
if typing.TYPE_CHECKING:
    from ctypes import _CData

    class Structure(_CData):
        """The classes that users see declare their fields."""
else:
    from ctypes import Structure
'''

# C types of the standard headers and what they are in ctypes; the parser gets typedefs for the first ones.
STANDARD = {"int32_t": "c_int32", "int64_t": "c_int64", "uint8_t": "c_uint8", "uint16_t": "c_uint16",
            "uint32_t": "c_uint32", "uint64_t": "c_uint64", "size_t": "c_size_t", "ptrdiff_t": "c_ssize_t"}
SCALARS = {**STANDARD, "char": "c_char", "int": "c_int", "float": "c_float", "double": "c_double", "void": "None"}
POINTERS = {"c_char": "c_char_p", "None": "c_void_p"}  # every other pointer is POINTER(...)

# Classes that are not named after their type, and enumerations whose members are combined.
NAMES = {"lensprof_curve": "CurveKind", "lensprof_error": "ErrorText", "lensprof_fit_method": "Method",
         "lensprof_sample_type": "SampleType"}
FLAGS = {"lensprof_pack"}


class Refused(Exception):
    """A header has a declaration that this program does not know how to write."""


def preprocess(include: pathlib.Path, cc: str, extra: str = "", options: tuple = ()) -> str:
    """The public headers and `extra` after preprocessing, with line markers. Attributes are empty, as for a compiler
    that is not GNU C, and the standard headers declare the types of STANDARD only."""
    with tempfile.TemporaryDirectory() as folder:
        standard = "#pragma once\n" + "".join(f"typedef int {name};\n" for name in STANDARD)
        pathlib.Path(folder, "stdint.h").write_text(standard)
        pathlib.Path(folder, "stddef.h").write_text('#include "stdint.h"\n')
        command = [*cc.split(), "-E", "-undef", "-nostdinc", "-I", folder, "-I", str(include), *options, "-x", "c", "-"]
        names = [name for name in ("lensprof.h", "photo.h") if (include / "lensprof" / name).exists()]
        source = "".join(f"#include <lensprof/{name}>\n" for name in names) + extra
        done = subprocess.run(command, input=source, capture_output=True, text=True)
    if done.returncode:
        raise Refused(f"{' '.join(command)}:\n{done.stderr}")
    return done.stdout


def number(node: c_ast.Node, known: dict):
    """Value of a constant expression; `known` has those of the names in it."""
    if isinstance(node, c_ast.Constant):
        if node.type in ("double", "float"):
            return float(node.value.rstrip("fFlL"))
        if "int" in node.type:
            return int(node.value.rstrip("uUlL"), 0)
    if isinstance(node, c_ast.ID) and node.name in known:
        return known[node.name]
    if isinstance(node, c_ast.UnaryOp) and node.op in "+-":
        value = number(node.expr, known)
        return -value if node.op == "-" else value
    operators = {"+": int.__add__, "-": int.__sub__, "*": int.__mul__, "<<": int.__lshift__, "|": int.__or__}
    if isinstance(node, c_ast.BinaryOp) and node.op in operators:
        return operators[node.op](number(node.left, known), number(node.right, known))
    raise Refused(f"{node.coord}: not a constant that this program evaluates")


def class_name(c_name: str) -> str:
    return NAMES.get(c_name) or "".join(word.title() for word in c_name.split("_")[1:])


class Interface:
    """What the headers declare, in their order. Types are ctypes expressions."""

    def __init__(self, include: pathlib.Path, cc: str):
        self.enums: dict = {}  # C name -> {member in C: value}
        self.flags: dict = collections.defaultdict(dict)  # prefix of macros -> the same, of single bits
        self.constants: dict = {}  # other macros -> value
        self.types: list = []  # ("struct", C name, [(field, type)]), ("opaque", C name), ("callback", C name, type)
        self.functions: dict = {}  # name -> (type of result, types of parameters)
        self.headers: dict = {}  # name of any of these -> name of its header
        self.texts: dict = {}  # of macros, quoted
        self.inits: dict = {}  # C name of a structure -> (function that sets defaults, C types whose sizes it takes)
        self._known = dict(SCALARS)  # C type -> ctypes expression
        self._values: dict = {}  # enumerators
        extra = "".join(f"double value_of_{name} = {name};\n" for name in self._macros(include, cc))
        for node in c_parser.CParser().parse(preprocess(include, cc, extra)).ext:
            self._read(node)
        classes = [class_name(name) for name in [*self.enums, *self.flags, *(kind[1] for kind in self.types)]]
        twice = [name for name, count in collections.Counter(classes).items() if count > 1]
        if twice:
            raise Refused(f"two types are named {twice[0]} in Python; add one to NAMES")

    def _macros(self, include: pathlib.Path, cc: str) -> list:
        """Names of the macros with a text and without parameters."""
        names, header = [], ""
        for line in preprocess(include, cc, options=("-dD",)).splitlines():
            place, macro = re.match(r'# \d+ "(.*?)"', line), re.match(r"#define (LENSPROF_\w+) +\S", line)
            if place:
                header = os.path.basename(place[1])
            elif macro:
                names.append(macro[1])
                self.headers[macro[1]] = header
        return names

    def _read(self, node: c_ast.Node) -> None:
        name = getattr(node, "name", None) or (node.decl.name if isinstance(node, c_ast.FuncDef) else "")
        self.headers[name] = os.path.basename(node.coord.file) if node.coord else ""
        if name in STANDARD:
            return
        if isinstance(node, c_ast.FuncDef) and "static" in node.decl.storage:
            self._read_inline(name, node)
        elif isinstance(node, c_ast.Typedef):
            self._read_typedef(name, node.type)
        elif isinstance(node, c_ast.Decl) and name and name.startswith("value_of_"):
            self._read_macro(name[len("value_of_"):], node.init)
        elif isinstance(node, c_ast.Decl) and isinstance(node.type, c_ast.FuncDecl):
            self.functions[name] = result, parameters = self._signature(node.type)
            of = name[:-len("_init")]
            if (result, parameters) == ("None", [f"POINTER({class_name(of)})"]) and name.endswith("_init"):
                self.inits[of] = (name, [])
        else:
            raise Refused(f"{node.coord}: neither typedef nor function")

    def _read_inline(self, name: str, node: c_ast.FuncDef) -> None:
        """An inline function is not exported: Python makes its call of an exported one. Of interest are those that
        pass the sizes of structures, as `lensprof_x_init(x)`: `lensprof_x_init_sized(x, sizeof *x)`."""
        statements = node.body.block_items or []
        call = statements[0] if len(statements) == 1 else None
        call = call.expr if isinstance(call, c_ast.Return) else call
        if not isinstance(call, c_ast.FuncCall) or call.name.name not in self.functions:
            raise Refused(f"{node.coord}: {name} is inline, but not one call of an exported function")
        parameters = {p.name: p.type for p in node.decl.type.args.params}
        if name.endswith("_init") and len(parameters) == 1:
            sizes = [self._sized(argument, parameters) for argument in call.args.exprs[1:]]
            self.inits[name[:-len("_init")]] = (call.name.name, sizes)

    def _sized(self, node: c_ast.Node, parameters: dict) -> str:
        """The C type T of `sizeof(T)`, or of `sizeof *p` where p is a parameter."""
        if isinstance(node, c_ast.UnaryOp) and node.op == "sizeof":
            of = node.expr
            if isinstance(of, c_ast.UnaryOp) and of.op == "*":
                of = parameters[of.expr.name]
            if isinstance(of, (c_ast.PtrDecl, c_ast.Typename)):
                of = of.type.type
                return " ".join((of.type if isinstance(of, c_ast.TypeDecl) else of).names)
        raise Refused(f"{node.coord}: not the size of a type or of what a parameter points to")

    def _read_macro(self, name: str, node: c_ast.Node) -> None:
        if isinstance(node, c_ast.Constant) and node.type == "string":
            self.texts[name] = node.value
            return
        value = number(node, self._values)
        prefix = "_".join(name.split("_")[:2]).lower()
        is_flag = isinstance(node, c_ast.Constant) and node.value.startswith("0x") and bin(value).count("1") == 1
        if is_flag or (prefix in self.flags and isinstance(node, c_ast.BinaryOp) and node.op == "|"):
            self.flags[prefix][name] = value
        else:
            self.constants[name] = value

    def _read_typedef(self, name: str, node: c_ast.Node) -> None:
        inner = node.type if isinstance(node, c_ast.TypeDecl) else None
        if isinstance(inner, c_ast.Enum) and inner.values:
            self._known[name], value = "c_int", -1
            self.enums[name] = members = {}
            for item in inner.values.enumerators:
                value = members[item.name] = number(item.value, self._values) if item.value else value + 1
            self._values.update(members)
        elif isinstance(inner, c_ast.Struct):
            self._known[name] = class_name(name)
            fields = [(field.name, self._field(field)) for field in inner.decls or ()]
            self.types.append(("struct", name, fields) if inner.decls else ("opaque", name))
        elif isinstance(node, c_ast.PtrDecl) and isinstance(node.type, c_ast.FuncDecl):
            self._known[name] = class_name(name)
            result, parameters = self._signature(node.type)
            self.types.append(("callback", name, f"CFUNCTYPE({', '.join([result, *parameters])})"))
        else:
            raise Refused(f"{node.coord or name}: typedef of neither enumeration, structure nor pointer to function")

    def _field(self, field: c_ast.Decl) -> str:
        if field.bitsize or not field.name:
            raise Refused(f"{field.coord}: bit field or member without a name")
        return self._type(field.type)

    def _type(self, node: c_ast.Node) -> str:
        if isinstance(node, c_ast.TypeDecl) and isinstance(node.type, c_ast.IdentifierType):
            name = " ".join(node.type.names)
            if name in self._known:
                return self._known[name]
        if isinstance(node, c_ast.PtrDecl):
            inner = self._type(node.type)
            return POINTERS.get(inner) or f"POINTER({inner})"
        if isinstance(node, c_ast.ArrayDecl) and node.dim is not None:
            return f"{self._type(node.type)} * {number(node.dim, self._values)}"
        raise Refused(f"{node.coord}: a type that this program does not know")

    def _signature(self, node: c_ast.FuncDecl) -> tuple:
        parameters = []
        for parameter in node.args.params if node.args else ():
            kind = parameter.type
            if isinstance(kind, c_ast.ArrayDecl):  # an array as a parameter is a pointer
                kind = c_ast.PtrDecl([], kind.type)
            parameters.append(self._type(kind))
        return self._type(node.type), [] if parameters == ["None"] else parameters


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


def functions_table(table: str, interface: Interface, names: set) -> str:
    body, header = f"\n{table} = {{\n", None
    for name, (result, parameters) in interface.functions.items():
        if name not in names:
            continue
        if interface.headers[name] != header:
            header = interface.headers[name]
            body += f"    # {header}\n"
        body += wrapped(f'    "{name}": ({result}, [', parameters, "]),")
    return body + "}\n"


def member_prefix(names: list) -> str:
    return os.path.commonprefix(names).rpartition("_")[0] + "_"


def python_enum(name: str, members: dict, is_flag: bool, header: str) -> str:
    prefix = member_prefix(list(members))
    where = f"{name.upper()}_*" if is_flag and name not in FLAGS else name
    rows = "".join(f"    {member[len(prefix):]} = {f'0x{value:02x}' if is_flag else value}\n"
                   for member, value in members.items())
    base = "IntFlag" if is_flag else "IntEnum"
    return f'\n\nclass {class_name(name)}({base}):\n    """{where}; see lensprof/{header}."""\n{rows}'


def python_type(kind: tuple) -> str:
    name = class_name(kind[1])
    if kind[0] == "callback":
        return f"\n\n{name} = {kind[2]}\n"
    if kind[0] == "opaque":
        return f'\n\nclass {name}(Structure):\n    """Opaque."""\n'
    rows = "".join(f'        ("{field}", {ctype}),\n' for field, ctype in kind[2])
    return f"\n\nclass {name}(Structure):\n    _fields_ = [\n{rows}    ]\n"


def python_table(name: str, entries: dict) -> str:
    return f"\n{name} = {{\n" + "".join(f'    "{key}": {value},\n' for key, value in entries.items()) + "}\n"


def python_text(interface: Interface) -> str:
    """lensprof/_abi.py."""
    all_enums = {**interface.enums, **interface.flags}
    prefixes = {member_prefix(list(members)): class_name(name) for name, members in all_enums.items()}
    if len(prefixes) != len(all_enums):
        raise Refused("two enumerations have the same prefix")
    version = ".".join(str(interface.constants[f"LENSPROF_VERSION_{part}"]) for part in ("MAJOR", "MINOR", "PATCH"))
    body = f'VERSION = "{version}"  # of the headers\n\n'
    for name, value in interface.constants.items():
        if "_VERSION_" not in name:
            body += f"{name[len('LENSPROF_'):]} = {value}\n"
    for name, text in interface.texts.items():
        body += f"{name[len('LENSPROF_'):]} = {text}\n"
    for name, members in all_enums.items():
        header = interface.headers[name if name in interface.enums else next(iter(members))]
        body += python_enum(name, members, name in interface.flags or name in FLAGS, header)
    for kind in interface.types:
        body += python_type(kind)
    body += "\n\n# Prefix in C of the members of each enumeration."
    body += python_table("ENUMS", prefixes)
    for table, wanted in (("STRUCTS", "struct"), ("OPAQUE", "opaque"), ("CALLBACKS", "callback")):
        body += python_table(table, {kind[1]: class_name(kind[1]) for kind in interface.types if kind[0] == wanted})
    body += "\n# The function that sets a structure's defaults, and the types whose sizes it takes.\n"
    body += "INITS: dict[type[Structure], tuple[str, list[type[Structure]]]] = {\n"
    for name, (function, sizes) in interface.inits.items():
        body += f'    {class_name(name)}: ("{function}", [{", ".join(map(class_name, sizes))}]),\n'
    body += "}\n"
    photo = {name for name in interface.functions if interface.headers[name] == "photo.h"}
    body += "\n# name: (restype, argtypes)" + functions_table("FUNCTIONS", interface, set(interface.functions) - photo)
    body += "\n# The same for liblensprof-photo." + functions_table("PHOTO_FUNCTIONS", interface, photo)
    used = sorted(set(re.findall(r"\b(?:c_\w+|POINTER|CFUNCTYPE)\b", body)))
    return (f"# Generated from include/lensprof by {COMMAND}: do not edit; `make abi` regenerates it.\n"
            '"""The C interface as tables: structures, enumerations, constants and functions of the public headers.\n\n'
            "Nothing else in the package knows a layout or a number of the C library. Raw structures have the fields\n"
            "of those in C; users see subclasses of them in the modules by topic.\n"
            '"""\nfrom __future__ import annotations\n\nimport typing\n'
            + (wrapped("from ctypes import (", used, ")") if used else "") + "from enum import IntEnum, IntFlag\n" + STRUCTURE + "\n" + body)


def dump_text(interface: Interface) -> str:
    """tests/python/abi_dump.c."""
    text = (f"/* Generated from include/lensprof by {COMMAND}: do not edit; `make abi` regenerates it. */\n"
            "/* Prints sizes and offsets of structs and values of constants as the C compiler sees them. test_abi.py\n"
            " * compares them with the tables of the Python package. */\n"
            "#include <lensprof/lensprof.h>\n#include <lensprof/photo.h>\n\n#include <stdio.h>\n\n"
            '#define STRUCT(type) printf("struct %s %zu %zu\\n", #type, sizeof(type), _Alignof(type))\n'
            "#define FIELD(type, name) "
            'printf("field %s %s %zu %zu\\n", #type, #name, offsetof(type, name), sizeof(((type *)0)->name))\n'
            '#define VALUE(name) printf("value %s %.17g\\n", #name, (double)(name))\n')
    text += "\nstatic void print_structs(void) {\n"
    for kind in interface.types:
        if kind[0] == "struct":
            text += f"    STRUCT({kind[1]});\n"
            text += "".join(f"    FIELD({kind[1]}, {field});\n" for field, _ in kind[2])
    text += "}\n\nstatic void print_values(void) {\n"
    for members in (interface.constants, *interface.enums.values(), *interface.flags.values()):
        text += "".join(f"    VALUE({name});\n" for name in members)
    return text + "}\n\nint main(void) {\n    print_structs();\n    print_values();\n    return 0;\n}\n"


def generated(include: pathlib.Path, cc: str) -> dict:
    """Path in the repository -> text, of both files."""
    interface = Interface(include, cc)
    return {"bindings/python/lensprof/_abi.py": python_text(interface),
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
            (ROOT / path).write_text(texts[path], encoding="utf-8")
            print(f"wrote {path}")
    return 1 if old and arguments.check else 0


if __name__ == "__main__":
    sys.exit(main())
