"""What the public headers declare, as data that the writers of this folder turn into the tables of each language.

The names of classes come from those in C: lensprof_gain_grid is GainGrid; the exceptions are listed below. Macros of a
single bit in hexadecimal are flags: LENSPROF_FREE_K1 0x02u is K1 of Free; a macro that joins them with | is a member,
too. A declaration that has no form here (union, bit field, inline function that is more than a call) is refused, with
its place.
"""
from __future__ import annotations

import collections
import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from typing import Any

try:
    from pycparser import c_ast, c_parser
except ImportError:
    sys.exit("make_abi.py: there is no pycparser; install the package python3-pycparser")

# C types of the standard headers, for which the parser gets typedefs, and those of the language.
STANDARD = ("int32_t", "int64_t", "uint8_t", "uint16_t", "uint32_t", "uint64_t", "size_t", "ptrdiff_t")
SCALARS = (*STANDARD, "char", "int", "float", "double", "void")

# Classes that are not named after their type, and enumerations whose members are combined.
NAMES = {"lensprof_curve": "CurveKind", "lensprof_error": "ErrorText", "lensprof_fit_method": "Method",
         "lensprof_sample_type": "SampleType"}
FLAGS = {"lensprof_pack"}


@dataclasses.dataclass(frozen=True)
class Scalar:
    """A type of C itself or of its standard headers; "void" as a result, or what a pointer points to."""
    name: str


@dataclasses.dataclass(frozen=True)
class Named:
    """A type of the headers. kind: "enum", "struct", "opaque" or "callback"."""
    kind: str
    name: str


@dataclasses.dataclass(frozen=True)
class Pointer:
    to: Any
    const: bool  # what it points to is only read


@dataclasses.dataclass(frozen=True)
class Array:
    of: Any
    length: int


@dataclasses.dataclass(frozen=True)
class Signature:
    result: Any
    parameters: tuple  # of (name, type)


VOID = Scalar("void")


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


def member_prefix(names: list) -> str:
    """What the members of an enumeration begin with: LENSPROF_ITEM_."""
    return os.path.commonprefix(names).rpartition("_")[0] + "_"


def class_name(c_name: str) -> str:
    return NAMES.get(c_name) or "".join(word.title() for word in c_name.split("_")[1:])


class Interface:
    """What the headers declare, in their order."""

    def __init__(self, include: pathlib.Path, cc: str):
        self.enums: dict = {}  # C name -> {member in C: value}
        self.flags: dict = collections.defaultdict(dict)  # prefix of macros -> the same, of single bits
        self.constants: dict = {}  # other macros -> value
        # ("struct", C name, [(field, type)]), ("opaque", C name), ("callback", C name, Signature)
        self.types: list = []
        self.functions: dict = {}  # name -> Signature
        self.headers: dict = {}  # name of any of these -> name of its header
        self.texts: dict = {}  # of macros, quoted
        self.inits: dict = {}  # C name of a structure -> (function that sets defaults, C types whose sizes it takes)
        self._known: dict = {name: Scalar(name) for name in SCALARS}
        self._values: dict = {}  # enumerators
        extra = "".join(f"double value_of_{name} = {name};\n" for name in self._macros(include, cc))
        for node in c_parser.CParser().parse(preprocess(include, cc, extra)).ext:
            self._read(node)
        classes = [class_name(name) for name in [*self.enums, *self.flags, *(kind[1] for kind in self.types)]]
        twice = [name for name, count in collections.Counter(classes).items() if count > 1]
        if twice:
            raise Refused(f"two types have a class named {twice[0]}; add one to NAMES")

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
            self.functions[name] = signature = self._signature(node.type)
            of = name[:-len("_init")]
            takes = [kind for _, kind in signature.parameters]
            if signature.result == VOID and takes == [Pointer(Named("struct", of), False)] and name.endswith("_init"):
                self.inits[of] = (name, [])
        else:
            raise Refused(f"{node.coord}: neither typedef nor function")

    def _read_inline(self, name: str, node: c_ast.FuncDef) -> None:
        """An inline function is not exported: other languages make its call of an exported one. Of interest are those
        that pass the sizes of structures, as `lensprof_x_init(x)`: `lensprof_x_init_sized(x, sizeof *x)`."""
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
            self._known[name], value = Named("enum", name), -1
            self.enums[name] = members = {}
            for item in inner.values.enumerators:
                value = members[item.name] = number(item.value, self._values) if item.value else value + 1
            self._values.update(members)
        elif isinstance(inner, c_ast.Struct):
            self._known[name] = Named("struct" if inner.decls else "opaque", name)
            fields = [(field.name, self._field(field)) for field in inner.decls or ()]
            self.types.append(("struct", name, fields) if inner.decls else ("opaque", name))
        elif isinstance(node, c_ast.PtrDecl) and isinstance(node.type, c_ast.FuncDecl):
            self._known[name] = Named("callback", name)
            self.types.append(("callback", name, self._signature(node.type)))
        else:
            raise Refused(f"{node.coord or name}: typedef of neither enumeration, structure nor pointer to function")

    def _field(self, field: c_ast.Decl) -> Any:
        if field.bitsize or not field.name:
            raise Refused(f"{field.coord}: bit field or member without a name")
        return self._type(field.type)

    def _type(self, node: c_ast.Node) -> Any:
        if isinstance(node, c_ast.TypeDecl) and isinstance(node.type, c_ast.IdentifierType):
            name = " ".join(node.type.names)
            if name in self._known:
                return self._known[name]
        if isinstance(node, c_ast.PtrDecl):
            return Pointer(self._type(node.type), "const" in getattr(node.type, "quals", ()))
        if isinstance(node, c_ast.ArrayDecl) and node.dim is not None:
            return Array(self._type(node.type), number(node.dim, self._values))
        raise Refused(f"{node.coord}: a type that this program does not know")

    def _signature(self, node: c_ast.FuncDecl) -> Signature:
        parameters = []
        for parameter in node.args.params if node.args else ():
            kind = parameter.type
            if isinstance(kind, c_ast.ArrayDecl):  # an array as a parameter is a pointer
                kind = c_ast.PtrDecl([], kind.type)
            parameters.append((getattr(parameter, "name", None), self._type(kind)))
        if [kind for _, kind in parameters] == [VOID]:
            parameters = []
        return Signature(self._type(node.type), tuple(parameters))

    def version(self) -> str:
        return ".".join(str(self.constants[f"LENSPROF_VERSION_{part}"]) for part in ("MAJOR", "MINOR", "PATCH"))

    def all_enums(self) -> dict:
        """C name, or prefix of macros -> {member in C: value}."""
        return {**self.enums, **self.flags}

    def header_of(self, name: str) -> str:
        """The header of an enumeration or of macros that are flags."""
        return self.headers[name if name in self.enums else next(iter(self.flags[name]))]

    def base(self) -> Interface:
        """The same without what photo.h declares, which is in the photograph library."""
        own = object.__new__(Interface)
        own.__dict__.update(self.__dict__)
        kept = [name for name, header in self.headers.items() if header != "photo.h"]
        for table in ("enums", "constants", "functions", "texts", "inits"):
            setattr(own, table, {name: value for name, value in getattr(self, table).items() if name in kept})
        own.types = [kind for kind in self.types if kind[1] in kept]
        own.flags = {name: members for name, members in self.flags.items() if next(iter(members)) in kept}
        return own
