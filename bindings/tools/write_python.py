"""The C interface for Python: lensprof/_abi.py, and a program in C that prints what it must agree with."""
from __future__ import annotations

import re
from typing import Any

from headers import FLAGS, Array, Interface, Named, Pointer, Refused, class_name, member_prefix
from writing import WARNING, wrapped

# ctypes.Structure has any attribute for type checkers, so that they would accept any attribute of a subclass.
STRUCTURE = '''
if typing.TYPE_CHECKING:
    from ctypes import _CData

    class Structure(_CData):
        """The classes that users see declare their fields."""
else:
    from ctypes import Structure
'''

CTYPES = {"int32_t": "c_int32", "int64_t": "c_int64", "uint8_t": "c_uint8", "uint16_t": "c_uint16",
          "uint32_t": "c_uint32", "uint64_t": "c_uint64", "size_t": "c_size_t", "ptrdiff_t": "c_ssize_t",
          "char": "c_char", "int": "c_int", "float": "c_float", "double": "c_double", "void": "None"}
POINTERS = {"c_char": "c_char_p", "None": "c_void_p"}  # every other pointer is POINTER(...)


def ctype(kind: Any) -> str:
    """The expression of a type in ctypes."""
    if isinstance(kind, Pointer):
        inner = ctype(kind.to)
        return POINTERS.get(inner) or f"POINTER({inner})"
    if isinstance(kind, Array):
        return f"{ctype(kind.of)} * {kind.length}"
    if isinstance(kind, Named):
        return "c_int" if kind.kind == "enum" else class_name(kind.name)
    return CTYPES[kind.name]


def functions_table(table: str, interface: Interface, names: set) -> str:
    body, header = f"\n{table} = {{\n", None
    for name, signature in interface.functions.items():
        if name not in names:
            continue
        if interface.headers[name] != header:
            header = interface.headers[name]
            body += f"    # {header}\n"
        parameters = [ctype(kind) for _, kind in signature.parameters]
        body += wrapped(f'    "{name}": ({ctype(signature.result)}, [', parameters, "]),")
    return body + "}\n"


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
        types = [ctype(kind[2].result), *(ctype(of) for _, of in kind[2].parameters)]
        return f"\n\n{name} = CFUNCTYPE({', '.join(types)})\n"
    if kind[0] == "opaque":
        return f'\n\nclass {name}(Structure):\n    """Opaque."""\n'
    rows = "".join(f'        ("{field}", {ctype(of)}),\n' for field, of in kind[2])
    return f"\n\nclass {name}(Structure):\n    _fields_ = [\n{rows}    ]\n"


def python_table(name: str, entries: dict) -> str:
    return f"\n{name} = {{\n" + "".join(f'    "{key}": {value},\n' for key, value in entries.items()) + "}\n"


def python_text(interface: Interface) -> str:
    """lensprof/_abi.py."""
    all_enums = interface.all_enums()
    prefixes = {member_prefix(list(members)): class_name(name) for name, members in all_enums.items()}
    if len(prefixes) != len(all_enums):
        raise Refused("two enumerations have the same prefix")
    body = f'VERSION = "{interface.version()}"  # of the headers\n\n'
    for name, value in interface.constants.items():
        if "_VERSION_" not in name:
            body += f"{name[len('LENSPROF_'):]} = {value}\n"
    for name, text in interface.texts.items():
        body += f"{name[len('LENSPROF_'):]} = {text}\n"
    for name, members in all_enums.items():
        body += python_enum(name, members, name in interface.flags or name in FLAGS, interface.header_of(name))
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
    return (f"# {WARNING}\n"
            '"""The C interface as tables: structures, enumerations, constants and functions of the public headers.\n\n'
            "Nothing else in the package knows a layout or a number of the C library. Raw structures have the fields\n"
            "of those in C; users see subclasses of them in the modules by topic.\n"
            '"""\nfrom __future__ import annotations\n\nimport typing\n'
            + (wrapped("from ctypes import (", used, ")") if used else "") + "from enum import IntEnum, IntFlag\n"
            + STRUCTURE + "\n" + body)


def dump_text(interface: Interface) -> str:
    """tests/python/abi_dump.c."""
    text = (f"/* {WARNING} */\n"
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
