#!/usr/bin/env python3
"""Bytes of flash that the library and its dependencies take, from a map of the GNU linker, and RAM as printed by a
demonstration ("plan: bytes N", "apply: stack N").

usage: map_sizes.py MAP OUTPUT CODE_CEILING RAM_CEILING TITLE
       map_sizes.py --self-check

Included are the core's objects and the C, math and compiler libraries, but not the demonstration's own program,
start-up code and data. Exit 1 if a ceiling is exceeded, or if the EMoR tables are linked.
"""

import re
import sys

# " .text.name", then address, size and file, on one line or two
ENTRY = re.compile(r"^ (\.\S+)?\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S.*)$")
LIBRARY = re.compile(r"(libcore|libm|libc|libgcc|libc_nano|libm_nano)\.a\((.+)\)$")


def flash_of(text):
    """{"library: object" or library: bytes} of everything in flash."""
    text = text[text.index("Linker script and memory map") :]
    text = re.sub(r"^( \.\S+)\n +(0x)", r"\1 \2", text, flags=re.M)
    sizes, output = {}, ""
    for line in text.splitlines():
        if re.match(r"^\.?[a-zA-Z_]", line):
            output = line.split()[0]
        match = ENTRY.match(line)
        if not match or output not in {".text", ".data", ".ARM.exidx"}:
            continue
        where = LIBRARY.search(match.group(4))
        size = int(match.group(3), 16)
        if where and size:
            name = f"core: {where.group(2)}" if where.group(1) == "libcore" else where.group(1).split("_")[0]
            sizes[name] = sizes.get(name, 0) + size
    return sizes


def ram_of(output):
    """Largest plan and stack."""

    def largest(pattern):
        return max((int(number) for number in re.findall(pattern, output)), default=0)

    return largest(r"bytes (\d+)"), largest(r"stack (\d+)")


def self_check():
    text = "Discarded\n .text 0x0 0x99 libcore.a(a.o)\nLinker script and memory map\n\n.text 0x0 0x100\n"
    text += " .text.a 0x00000010 0x10 x/libcore.a(a.o)\n .text.long_name\n                0x00000020 0x8 x/libcore.a(a.o)\n"
    text += " .text 0x0 0x40 main.o\n .rodata.b 0x0 0x4 y/libm.a(b.o)\n.bss 0x0 0x50\n .bss 0x0 0x50 x/libcore.a(a.o)\n"
    good = flash_of(text) == {"core: a.o": 24, "libm": 4} and ram_of("plan: bytes 7\nplan: stack 9\napply: stack 3\n") == (7, 9)
    print("map_sizes: counted" if good else f"map_sizes: counted {flash_of(text)}")
    return 0 if good else 1


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        sizes = flash_of(file.read())
    with open(sys.argv[2], encoding="utf-8") as file:
        plan, stack = ram_of(file.read())
    flash, ram = sum(sizes.values()), plan + stack
    for name, size in sorted(sizes.items(), key=lambda item: -item[1]):
        print(f"  {size:6d}  {name}")
    print(f"{sys.argv[5]}: code and tables {flash} of {sys.argv[3]} bytes; plan {plan} + stack {stack} = {ram} of {sys.argv[4]} bytes")
    emor = any("emor" in name for name in sizes)
    if emor:
        print("the EMoR tables are linked, but applying does not need them")
    applying = {"core: row_scalar.o", "core: fixed.o", "core: sensor.o"}
    nothing = not flash or not stack or not applying & sizes.keys()
    return int(flash > int(sys.argv[3]) or ram > int(sys.argv[4]) or emor or nothing)


if __name__ == "__main__":
    sys.exit(main())
