"""The C interface for Java: Abi.java, with structures, enumerations and functions of JNA."""
from __future__ import annotations

from typing import Any

from headers import FLAGS, Array, Interface, Named, Pointer, Scalar, Signature, class_name, member_prefix
from writing import WARNING, short, wrapped

TYPES = {"int32_t": "int", "int64_t": "long", "uint8_t": "byte", "uint16_t": "short", "uint32_t": "int",
         "uint64_t": "long", "size_t": "Size", "ptrdiff_t": "Size", "char": "byte", "int": "int", "float": "float", "double": "double",
         "void": "void"}
KEYWORDS = {"abstract", "byte", "case", "class", "default", "double", "final", "float", "int", "interface", "long",
            "native", "new", "package", "private", "public", "short", "static", "super", "switch", "this", "try"}
TEXT = Pointer(Scalar("char"), True)


def field_type(kind: Any) -> str:
    """The type of a member, or of the elements of an array. Java counts without signs: a uint32_t is an int."""
    if isinstance(kind, Array):
        return field_type(kind.of) + "[]" if not isinstance(kind.of, Array) else field_type(kind.of)
    if isinstance(kind, Pointer):
        return "Pointer"
    if isinstance(kind, Named):
        return "int" if kind.kind == "enum" else "Pointer" if kind.kind == "callback" else class_name(kind.name)
    return TYPES[kind.name]


def argument_type(kind: Any) -> str:
    """Structures go by reference, texts as UTF-8, arrays and handles as Pointer."""
    if kind == TEXT:
        return "String"
    if isinstance(kind, Pointer) and isinstance(kind.to, Named) and kind.to.kind == "struct":
        return class_name(kind.to.name)
    if isinstance(kind, Named) and kind.kind == "callback":
        return class_name(kind.name)
    return field_type(kind)


def java_name(name: str) -> str:
    return name + "_" if name in KEYWORDS else name


def length(kind: Any) -> int:
    """Number of elements of an array, whose rows follow each other."""
    return kind.length * length(kind.of) if isinstance(kind, Array) else 1


def java_field(name: str, kind: Any) -> str:
    text = f"        public {field_type(kind)} {java_name(name)}"
    if isinstance(kind, Array):
        text += f" = new {field_type(kind)[:-2]}[{length(kind)}]"
    elif isinstance(kind, Scalar) and TYPES[kind.name] == "Size":
        text += " = new Size()"
    return text + ";\n"


def java_constant(name: str, value: Any) -> str:
    if isinstance(value, float):
        return f"    public static final double {name} = {value};\n"
    if not -2**31 <= value < 2**32:
        return f"    public static final long {name} = {value}L;\n"
    return f"    public static final int {name} = {value if value < 2**31 else f'0x{value:x}'};\n"


ENUM_BODY = '''
        public final int value;

        TITLE(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static TITLE of(int value) {
            for (TITLE each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }
'''


def java_enum(interface: Interface, name: str, members: dict) -> str:
    prefix = member_prefix(list(members))
    where = f"    /** {name}; see lensprof/{interface.header_of(name)}. */\n"
    if name in FLAGS or name in interface.flags:
        return "\n" + where + "".join(java_constant(short(member), value) for member, value in members.items())
    title = class_name(name)
    rows = ",\n".join(f"        {java_name(member[len(prefix):])}({value})" for member, value in members.items())
    return f"\n{where}    public enum {title} {{\n{rows};\n{ENUM_BODY.replace('TITLE', title)}"


def java_kind(kind: tuple, inits: dict) -> str:
    title = class_name(kind[1])
    if kind[0] == "opaque":
        return ""
    if kind[0] == "callback":
        return (f"\n    /** {kind[1]}. */\n    public interface {title} extends Callback {{\n"
                f"        {java_method('invoke', kind[2])};\n    }}\n")
    names = [f'"{java_name(field)}"' for field, _ in kind[2]]
    order = wrapped("    @Structure.FieldOrder({", names, "})")
    body = "".join(java_field(field, of) for field, of in kind[2])
    if kind[1] in inits:
        function, sizes = inits[kind[1]]
        given = "getPointer()" if function == "lensprof_init_sized" else "this"
        own = [f"new Size({'' if of == kind[1] else f'new {class_name(of)}().'}size())" for of in sizes]
        arguments = ", ".join([given, *own])
        body += (f"\n        /** As {kind[1]}_init sets it. */\n        public {title} init(Functions library) {{\n"
                 f"            library.{function}({arguments});\n"
                 "            read();\n            return this;\n        }\n")
    return f'\n    @StructName("{kind[1]}")\n{order}    public static class {title} extends Struct {{\n{body}    }}\n'


def java_method(name: str, signature: Signature) -> str:
    parameters = [f"{argument_type(kind)} {java_name(of or f'p{i}')}"
                  for i, (of, kind) in enumerate(signature.parameters)]
    return f"{argument_type(signature.result)} {name}({', '.join(parameters)})"


HEAD = '''package lensprof;

import com.sun.jna.Callback;
import com.sun.jna.IntegerType;
import com.sun.jna.Library;
import com.sun.jna.Native;
import com.sun.jna.Pointer;
import com.sun.jna.Structure;
import java.lang.annotation.Retention;
import java.lang.annotation.RetentionPolicy;

/** The C interface as tables: structures, enumerations, constants and functions of the public headers. */
public final class Abi {
    private Abi() {
    }

    /** size_t and ptrdiff_t. */
    public static class Size extends IntegerType {
        private static final long serialVersionUID = 1L;

        public Size() {
            this(0);
        }

        public Size(long value) {
            super(Native.SIZE_T_SIZE, value, false);
        }
    }

    /** The name of a structure in C. */
    @Retention(RetentionPolicy.RUNTIME)
    public @interface StructName {
        String value();
    }

    /** A structure that shows where its members lie. */
    public abstract static class Struct extends Structure {
        /** Offset of a member, bytes. */
        public int offset(String field) {
            return fieldOffset(field);
        }

        /** Alignment, bytes. */
        public int alignment() {
            return getStructAlignment();
        }
    }

'''


def java_text(interface: Interface) -> str:
    """Abi.java."""
    interface = interface.base()
    body = f"// {WARNING}\n" + HEAD
    body += f'    /** Version of the headers. */\n    public static final String VERSION = "{interface.version()}";\n\n'
    for name, value in interface.constants.items():
        body += "" if "_VERSION_" in name else java_constant(short(name), value)
    for name, text in interface.texts.items():
        body += f"    public static final String {short(name)} = {text};\n"
    for name, members in interface.all_enums().items():
        body += java_enum(interface, name, members)
    for kind in interface.types:
        body += java_kind(kind, interface.inits)
    body += "\n    /** The exported functions. */\n    public interface Functions extends Library {\n"
    for name, signature in interface.functions.items():
        body += f"        {java_method(name, signature)};\n"
    return body + "    }\n}\n"
