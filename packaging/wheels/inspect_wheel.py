#!/usr/bin/env python3
"""What a wheel of lensprof contains, compared with what it must.

usage: inspect_wheel.py WHEEL...     prints a line for each; exit 1: something is missing, or too much
"""

import json
import pathlib
import re
import subprocess
import sys
import zipfile
from typing import NamedTuple

import lief

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# What every system of the kind has.
SYSTEM_LIBRARIES = {
    "linux": {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2",
              "ld-linux-aarch64.so.1"},
    "musl": {"libc.so"},
    "macos": {"/usr/lib/libSystem.B.dylib"},
    "win": {"KERNEL32.dll", "ntdll.dll", "ADVAPI32.dll"},
}  # fmt: skip
MACHINES = {"x86_64": ("X86_64", "AMD64"), "aarch64": ("AARCH64",), "arm64": ("ARM64",), "amd64": ("AMD64",)}
COMMON = ("licenses/LICENSE", "licenses/NOTICE", "licenses/sqlite/LICENSE.txt", "licenses/eigen/LICENSE.txt",
          "licenses/libcxx/LICENSE.TXT", "licenses/pugixml/LICENSE.md", "METADATA", "WHEEL", "RECORD")  # fmt: skip
INSIDE = {"sqlite", "pugixml", "eigen", "nlohmann", "libcxx", "libcxxabi", "libunwind", "compiler-rt"}


class Package(NamedTuple):
    """What a wheel of this name has: files, those of dist-info, libraries inside, exports, and other wheels' libraries."""

    folder: str
    files: tuple[str, ...]
    info: tuple[str, ...]
    inside: set[str]
    exports: str
    needs: set[str]


PACKAGES = {
    "lensprof": Package("lensprof/", ("__init__.py", "_abi.py", "py.typed"),
                        (*COMMON, "licenses/nlopt/COPYING", "licenses/nlopt/slsqp-COPYRIGHT", "sboms/lensprof.cdx.json"),
                        INSIDE | {"nlopt"}, "exported_symbols.txt", set()),
    "lensprof_photo": Package("lensprof_photo/", ("__init__.py",),
                              (*COMMON, "licenses/opencv/LICENSE", "licenses/libjpeg-turbo/LICENSE.md", "licenses/libpng/LICENSE",
                               "licenses/libtiff/COPYRIGHT", "licenses/zlib/LICENSE", "sboms/lensprof-photo.cdx.json"),
                              INSIDE | {"opencv", "libjpeg-turbo", "libpng", "libtiff", "zlib"}, "exported_photo_symbols.txt",
                              {"liblensprof.so"}),
}  # fmt: skip


def kind_of(tag: str) -> str:
    """The kind of system of a platform tag."""
    return next(kind for word, kind in (("manylinux", "linux"), ("musllinux", "musl"), ("macosx", "macos"), ("win", "win"))
                if tag.startswith(word))  # fmt: skip


def exported(library: lief.Binary) -> set[str]:
    if isinstance(library, lief.ELF.Binary):
        return {s.name for s in library.exported_symbols}
    if isinstance(library, lief.PE.Binary):
        return {entry.name for entry in library.get_export().entries}
    return {s.name.removeprefix("_") for s in library.exported_symbols}


def machine(library: lief.Binary) -> str:
    header = library.header
    return str(getattr(header, "machine_type", getattr(header, "machine", getattr(header, "cpu_type", "")))).split(".")[-1]


def needed(library: lief.Binary) -> set[str]:
    if isinstance(library, lief.MachO.Binary):
        return {command.name for command in library.libraries if command.command != lief.MachO.LoadCommand.TYPE.ID_DYLIB}
    return {getattr(entry, "name", entry) for entry in library.libraries}


def faults_of_library(library: lief.Binary, tag: str, package: Package) -> list[str]:
    faults, kind = [], kind_of(tag)
    lines = (ROOT / "tests/lint" / package.exports).read_text().splitlines()
    wanted = {line for line in lines if not line.startswith("#")}
    found = exported(library)
    if isinstance(library, lief.MachO.Binary):  # zig's linker has no list of exports: what C++ declares visible stays
        found -= {name for name in found if name in ("_mh_dylib_header", "__dso_handle") or re.match(r"_Z(n|d)[wal]", name)}
    if found != wanted:
        faults.append(f"exports: missing {sorted(wanted - found)[:5]}, too many {sorted(found - wanted)[:5]}")
    foreign = {name for name in needed(library)
               if name not in SYSTEM_LIBRARIES[kind] | package.needs and not name.startswith("api-ms-win-crt-")}  # fmt: skip
    if foreign:
        faults.append(f"needs {sorted(foreign)}, which such systems need not have")
    processor = next(names for word, names in MACHINES.items() if tag.endswith(word))
    if machine(library) not in processor:
        faults.append(f"is for {machine(library)}")
    if isinstance(library, lief.ELF.Binary):
        faults += [f"has {entry}" for entry in library.dynamic_entries if "PATH" in str(entry.tag)]
    return faults


def faults_of(path: pathlib.Path) -> list[str]:
    wheel = zipfile.ZipFile(path)
    names = set(wheel.namelist())
    name, version, tags = *path.name.split("-")[:2], path.stem.split("-")[-1].split(".")
    package, info = PACKAGES[name], f"{name}-{version}.dist-info/"
    wanted_files = [package.folder + file for file in package.files] + [info + file for file in package.info]
    faults = [f"{file} is missing" for file in wanted_files if file not in names]
    libraries = [file for file in names if file.startswith(package.folder) and not file.endswith((".py", "py.typed"))]
    ending = {"macos": ".dylib", "win": ".dll"}.get(kind_of(tags[0]), ".so")
    if libraries != [f"{package.folder}lib{name.replace('_', '-')}{ending}"]:  # the names that _library.py looks for
        return faults + [f"has the files {libraries}, and not one library of the name that the package loads"]
    bill = json.loads(wheel.read(info + package.info[-1]))
    inside = {part["name"] for part in bill["components"]}
    wanted = package.inside | ({"mingw-w64"} if kind_of(tags[0]) == "win" else set())
    if inside != wanted:
        faults.append(f"the bill of materials names {sorted(inside)}, and not {sorted(wanted)}")
    library = lief.parse(list(wheel.read(libraries[0])))
    faults += faults_of_library(library, tags[0], package)
    if kind_of(tags[0]) == "linux":  # the versions of the symbols of glibc
        shown = subprocess.run([sys.executable, "-m", "auditwheel", "show", str(path)], capture_output=True, text=True)
        if not any(f'"{tag}"' in shown.stdout for tag in tags):
            faults.append(f"auditwheel: {shown.stdout + shown.stderr}")
    size = len(wheel.read(libraries[0]))
    print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB, {libraries[0]} {size / 1e6:.2f} MB, {len(exported(library))} functions, "
          f"needs {', '.join(sorted(needed(library)))}", flush=True)  # fmt: skip
    return faults


def main() -> None:
    faults = [f"{path}: {fault}" for path in map(pathlib.Path, sys.argv[1:]) for fault in faults_of(path)]
    print("\n".join(faults), file=sys.stderr)
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
