"""The C interface for Node: node/abi.js, tables that native.js turns into types and functions of koffi."""
from __future__ import annotations

import re
from typing import Any

from headers import FLAGS, Array, Interface, Named, Pointer, class_name, member_prefix
from writing import WARNING, short


def node_type(kind: Any) -> str:
    """A type as a text: its name in C, then * for a pointer to it and [n] for an array, from the inside out."""
    if isinstance(kind, Pointer):
        return node_type(kind.to) + "*"
    if isinstance(kind, Array):
        return f"{node_type(kind.of)}[{kind.length}]"
    return "int" if isinstance(kind, Named) and kind.kind == "enum" else kind.name


def quoted(kinds: Any) -> str:
    return ", ".join(f"'{node_type(kind)}'" for kind in kinds)


def node_text(interface: Interface) -> str:
    """node/abi.js."""
    interface = interface.base()
    body = (f"// {WARNING}\n"
            "// The C interface as tables. A type is its name in C, then * for a pointer and [n] for an array.\n\n"
            f"export const VERSION = '{interface.version()}'; // of the headers\n\n")
    for name, value in interface.constants.items():
        body += "" if "_VERSION_" in name else f"export const {short(name)} = {value};\n"
    for name, text in interface.texts.items():
        body += f"export const {short(name)} = {text};\n"
    for name, members in interface.all_enums().items():
        prefix = member_prefix(list(members))
        is_flag = name in FLAGS or name in interface.flags
        rows = "".join(f"    {node_member(member[len(prefix):])}: {f'0x{value:02x}' if is_flag else value},\n"
                       for member, value in members.items())
        body += f"\n/** {name}; see lensprof/{interface.header_of(name)}. */\n"
        body += f"export const {class_name(name)} = Object.freeze({{\n{rows}}});\n"
    body += "\n/** [kind, name, fields of a structure, or the types of result and parameters of a callback]. */\n"
    body += "export const TYPES = [\n"
    for kind in interface.types:
        body += f"    ['{kind[0]}', '{kind[1]}'"
        if kind[0] == "callback":
            body += f", [{quoted([kind[2].result, *(of for _, of in kind[2].parameters)])}]"
        elif kind[0] == "struct":
            body += ", {\n" + "".join(f"        {field}: '{node_type(of)}',\n" for field, of in kind[2]) + "    }"
        body += "],\n"
    body += "];\n\n/** Of a structure: the function that sets its defaults, and the types whose sizes it takes. */\n"
    body += "export const INITS = {\n"
    for name, (function, sizes) in interface.inits.items():
        texts = ", ".join(f"'{of}'" for of in sizes)
        body += f"    {name}: ['{function}', [{texts}]],\n"
    body += "};\n\n/** name: [type of the result, types of the parameters]. */\nexport const FUNCTIONS = {\n"
    for name, signature in interface.functions.items():
        body += f"    {name}: ['{node_type(signature.result)}', [{quoted(of for _, of in signature.parameters)}]],\n"
    return body + "};\n"


def node_member(name: str) -> str:
    return name if re.match(r"[A-Za-z_]", name) else f"'{name}'"
