"""The C interface for Rust: lensprof-sys/src/abi.rs, and a program that prints the layout of its structures."""
from __future__ import annotations

from typing import Any

from headers import FLAGS, VOID, Array, Interface, Named, Pointer, Signature, class_name, member_prefix
from writing import WARNING, short

TYPES = {"int32_t": "i32", "int64_t": "i64", "uint8_t": "u8", "uint16_t": "u16", "uint32_t": "u32", "uint64_t": "u64",
         "size_t": "usize", "ptrdiff_t": "isize", "char": "c_char", "int": "c_int", "float": "f32", "double": "f64",
         "void": "c_void"}
KEYWORDS = {"as", "box", "dyn", "final", "fn", "impl", "in", "let", "loop", "match", "mod", "move", "override", "pub",
            "ref", "self", "trait", "type", "use", "where", "yield"}


def rust_type(kind: Any) -> str:
    if isinstance(kind, Pointer):
        return f"*{'const' if kind.const else 'mut'} {rust_type(kind.to)}"
    if isinstance(kind, Array):
        return f"[{rust_type(kind.of)}; {kind.length}]"
    if isinstance(kind, Named):  # a number without a name is not a value of an enum of Rust
        return "c_int" if kind.kind == "enum" else class_name(kind.name)
    return TYPES[kind.name]


def rust_name(name: str) -> str:
    return f"r#{name}" if name in KEYWORDS else name


def parameters_and_result(signature: Signature) -> str:
    parameters = [f"{rust_name(name or f'p{i}')}: {rust_type(kind)}"
                  for i, (name, kind) in enumerate(signature.parameters)]
    result = "" if signature.result == VOID else f" -> {rust_type(signature.result)}"
    return f"({', '.join(parameters)}){result}"


def rust_constant(name: str, value: Any) -> str:
    kind = "f64" if isinstance(value, float) else "u32" if 0 <= value < 2**32 else "i64"
    return f"pub const {short(name)}: {kind} = {value};\n"


def rust_enum(interface: Interface, name: str, members: dict) -> str:
    if name in FLAGS or name in interface.flags:
        return "\n" + "".join(rust_constant(member, value) for member, value in members.items())
    prefix, title = member_prefix(list(members)), class_name(name)
    names = {member: "".join(word.title() for word in member[len(prefix):].split("_")) for member in members}
    rows = "".join(f"    {names[member]} = {value},\n" for member, value in members.items())
    cases = "".join(f"            {value} => Some(Self::{names[member]}),\n" for member, value in members.items())
    return (f"\n/// `{name}`; see lensprof/{interface.header_of(name)}.\n#[repr(i32)]\n#[non_exhaustive]\n"
            f"#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]\npub enum {title} {{\n{rows}}}\n\nimpl {title} {{\n"
            "    /// The member with a number of C, if this version has it.\n"
            "    pub fn from_raw(value: i64) -> Option<Self> {\n"
            f"        match value {{\n{cases}            _ => None,\n        }}\n    }}\n}}\n")


def rust_kind(kind: tuple) -> str:
    title = class_name(kind[1])
    if kind[0] == "callback":
        return f'\npub type {title} = Option<unsafe extern "C" fn{parameters_and_result(kind[2])}>;\n'
    if kind[0] == "opaque":
        return f"\n/// Opaque.\n#[repr(C)]\npub struct {title} {{\n    _private: [u8; 0],\n}}\n"
    rows = "".join(f"    pub {rust_name(field)}: {rust_type(of)},\n" for field, of in kind[2])
    return f"\n/// `{kind[1]}`.\n#[repr(C)]\n#[derive(Clone, Copy)]\npub struct {title} {{\n{rows}}}\n"


def rust_init(name: str, function: str, sizes: list) -> str:
    arguments = ", ".join(["(&mut value as *mut Self).cast()", *(f"size_of::<{class_name(of)}>()" for of in sizes)])
    return (f"\nimpl Default for {class_name(name)} {{\n    /// As `{name}_init` sets it.\n"
            "    fn default() -> Self {\n"
            "        // SAFETY: every member is a number or a pointer, for which zero is a value.\n"
            f"        let mut value: Self = unsafe {{ zeroed() }};\n        unsafe {{ {function}({arguments}) }};\n"
            "        value\n    }\n}\n")


def rust_text(interface: Interface) -> str:
    """lensprof-sys/src/abi.rs."""
    interface = interface.base()
    body = f"// {WARNING}\n"
    body += ("use std::ffi::{c_char, c_int, c_void};\nuse std::mem::{size_of, zeroed};\n\n"
             f'/// Version of the headers.\npub const VERSION: &str = "{interface.version()}";\n\n')
    for name, value in interface.constants.items():
        body += "" if "_VERSION_" in name else rust_constant(name, value)
    for name, text in interface.texts.items():
        body += f"pub const {short(name)}: &str = {text};\n"
    for name, members in interface.all_enums().items():
        body += rust_enum(interface, name, members)
    for kind in interface.types:
        body += rust_kind(kind)
    for name, (function, sizes) in interface.inits.items():
        body += rust_init(name, function, sizes)
    body += '\n#[link(name = "lensprof")]\nextern "C" {\n'
    for name, signature in interface.functions.items():
        body += f"    pub fn {name}{parameters_and_result(signature)};\n"
    return body + "}\n"


def rust_dump_text(interface: Interface) -> str:
    """lensprof-sys/examples/abi_dump.rs."""
    body = (f"// {WARNING}\n"
            "//! Prints sizes and offsets of structures, as tests/python/abi_dump.c does; tests/bindings compares the two.\n"
            "use std::mem::{align_of, offset_of, size_of};\n\n#[rustfmt::skip]\nfn main() {\n")
    for kind in interface.base().types:
        if kind[0] == "struct":
            title = f"lensprof_sys::{class_name(kind[1])}"
            body += f'    println!("struct {kind[1]} {{}} {{}}", size_of::<{title}>(), align_of::<{title}>());\n'
            for field, _ in kind[2]:
                body += f'    println!("field {kind[1]} {field} {{}}", offset_of!({title}, {rust_name(field)}));\n'
    return body + "}\n"
