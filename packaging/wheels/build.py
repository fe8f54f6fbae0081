#!/usr/bin/env python3
"""Wheels of the Python package with the library inside, for every platform, made on one machine.

usage: build.py [--check] [TARGET...]     without a TARGET, all of them; build.py --list names them
       build.py --photo [TARGET...]       the photograph library, a wheel of its own for Linux
       build.py --sources | --sdist       only the sources of the libraries inside | only the sdist

Writes dist/lensprof-VERSION.tar.gz (the sdist) and dist/*.whl, which are made from that sdist. clang of the package
ziglang has the C library of every target; sources.py fetches NLopt, SQLite, pugixml and headers. Two runs give the same
bytes. --check makes each wheel twice, in two folders, and compares them.
"""

import argparse
import functools
import hashlib
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tarfile
from typing import NamedTuple

import pictures

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BUILD, DIST = ROOT / "build/wheels", ROOT / "dist"
DATE = "1767225600"  # of the files in a wheel unless SOURCE_DATE_EPOCH is set: 2026-01-01


class Target(NamedTuple):
    """A platform: its name for zig, and the tags of its wheel."""

    zig: str
    tags: tuple[str, ...]


# glibc 2.17 is that of CentOS 7 (2014); macOS 11 of 2020. zig links its own C++ library statically everywhere.
TARGETS = {
    "linux-x86_64": Target("x86_64-linux-gnu.2.17", ("manylinux_2_17_x86_64", "manylinux2014_x86_64")),
    "linux-aarch64": Target("aarch64-linux-gnu.2.17", ("manylinux_2_17_aarch64", "manylinux2014_aarch64")),
    "musl-x86_64": Target("x86_64-linux-musl", ("musllinux_1_2_x86_64",)),
    "macos-arm64": Target("aarch64-macos.11.0", ("macosx_11_0_arm64",)),
    "macos-x86_64": Target("x86_64-macos.11.0", ("macosx_11_0_x86_64",)),
    "windows-x86_64": Target("x86_64-windows-gnu", ("win_amd64",)),
}
PHOTO_TARGETS = ("linux-x86_64",)


def run(*command: object, **options) -> None:
    result = subprocess.run([str(word) for word in command], **options)
    if result.returncode:
        sys.exit(f"build.py: {' '.join(pathlib.Path(str(word)).name for word in command[:5])}: failed, exit {result.returncode}")


def check_machine() -> None:
    """The tools of tools.txt are programs for one kind of machine."""
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        sys.exit(f"build.py: {platform.system()} {platform.machine()}: wheels are made on Linux x86-64; "
                 "`pip wheel .` makes one for this machine")  # fmt: skip
    if sys.version_info < (3, 11):
        sys.exit(f"build.py: Python {platform.python_version()}: is too old for the tools of tools.txt; use 3.11 or newer")
    if " " in str(ROOT):
        sys.exit(f"build.py: {ROOT}: has a space, which the compiler's flags cannot hold; move the folder")


def tools() -> pathlib.Path:
    """A Python with the packages of tools.txt, whose hashes pip checks."""
    python, wanted = BUILD / "tools/bin/python", (HERE / "tools.txt").read_text()
    installed = BUILD / "tools/installed.txt"
    if not installed.exists() or installed.read_text() != wanted:
        shutil.rmtree(BUILD / "tools", ignore_errors=True)
        run(sys.executable, "-m", "venv", BUILD / "tools")
        run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--require-hashes",
            "-r", HERE / "tools.txt")  # fmt: skip
        installed.write_text(wanted)
    return python


def sdist(python: pathlib.Path) -> pathlib.Path:
    """The sdist, unpacked."""
    make = "import sys, scikit_build_core.build as b; print(b.build_sdist(sys.argv[1]))"
    DIST.mkdir(exist_ok=True)
    run(python, "-c", make, DIST, cwd=ROOT, stdout=subprocess.DEVNULL)
    archive = max(DIST.glob("lensprof-*.tar.gz"), key=lambda path: path.stat().st_mtime)
    version = archive.name.removesuffix(".tar.gz")
    for old in DIST.glob("lensprof[-_]*"):  # pip would choose among versions
        if old != archive and not old.name.startswith((version + "-", version.replace("lensprof", "lensprof_photo") + "-")):
            old.unlink()
    shutil.rmtree(BUILD / "sdist", ignore_errors=True)
    tarfile.open(archive).extractall(BUILD / "sdist")
    return BUILD / "sdist" / archive.name.replace(".tar.gz", "")


def zig_program() -> pathlib.Path:
    return next((BUILD / "tools/lib").glob("python3*/site-packages/ziglang/zig"))


def wheel(python: pathlib.Path, source: pathlib.Path, name: str, folder: pathlib.Path, dist: pathlib.Path,
          project: str = ".", pictures_folder: pathlib.Path | None = None) -> pathlib.Path:  # fmt: skip
    """The wheel of a target, built in `folder`; `project`: where its pyproject.toml is; `pictures_folder`: what pictures.make
    made, for the photograph library."""
    target = TARGETS[name]
    zig = zig_program()
    defines = {
        "CMAKE_TOOLCHAIN_FILE": source / "packaging/wheels/zig.cmake",
        "LENSPROF_ZIG": zig,
        "LENSPROF_ZIG_TARGET": target.zig,
        "LENSPROF_SOURCES": BUILD / "sources",
        # No symbols, and no path of this machine.
        "CMAKE_SHARED_LINKER_FLAGS": "-s",
        **({"LENSPROF_PICTURES": pictures_folder} if pictures_folder else {}),
        **{f"CMAKE_{language}_FLAGS": f"-ffile-prefix-map={source}=. -ffile-prefix-map={BUILD}=." for language in ("C", "CXX")},
    }
    settings = [f"build-dir={folder / 'build'}", "wheel.tags=" + ";".join(f"py3-none-{tag}" for tag in target.tags)]
    settings += [f"cmake.define.{name}={value}" for name, value in defines.items()]
    dist.mkdir(parents=True, exist_ok=True)
    made = folder / "wheel"
    for old in (made, folder / "build"):  # the files of an sdist have no times by which to tell what changed; zig has a cache
        shutil.rmtree(old, ignore_errors=True)
    run(python, "-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-build-isolation",
        "-w", made, *[f"-C{setting}" for setting in settings], source / project,
        env={"SOURCE_DATE_EPOCH": DATE, **os.environ, "CMAKE_BUILD_PARALLEL_LEVEL": str(os.cpu_count()),
             "ZIG_LOCAL_CACHE_DIR": str(folder / "cache"), "ZIG_GLOBAL_CACHE_DIR": str(BUILD / "cache")})  # fmt: skip
    path = next(made.glob("*.whl"))
    return pathlib.Path(shutil.move(path, dist / path.name))


def photo_wheel(python: pathlib.Path, source: pathlib.Path, name: str, folder: pathlib.Path, dist: pathlib.Path) -> pathlib.Path:
    """That of the photograph library."""
    libraries = BUILD / "pictures" / name
    pictures.make(zig_program(), TARGETS[name].zig, BUILD / "sources", libraries)
    project = "packaging/photo"
    for text in ("LICENSE", "NOTICE"):
        shutil.copy(source / text, source / project)
    return wheel(python, source, name, folder, dist, project, libraries)


def make_twice(path: pathlib.Path, make, again: pathlib.Path) -> None:
    """Makes a wheel a second time, and compares the bytes."""
    second = make(again, BUILD / "again/dist")
    if hashlib.sha256(path.read_bytes()).digest() != hashlib.sha256(second.read_bytes()).digest():
        sys.exit(f"build.py: {path.name}: the second one differs; compare {path} and {second}")
    print(f"{path.name}: made twice, the same bytes", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Make the wheels of lensprof.")
    parser.add_argument("targets", nargs="*", metavar="TARGET")
    parser.add_argument("--list", action="store_true", help="name the targets")
    parser.add_argument("--photo", action="store_true", help="make the wheel of the photograph library instead")
    parser.add_argument("--sources", action="store_true", help="fetch the sources of the libraries inside, and stop")
    parser.add_argument("--sdist", action="store_true", help="make the sdist, and stop")
    parser.add_argument("--check", action="store_true", help="make each wheel twice, and compare the bytes")
    options = parser.parse_args()
    known = PHOTO_TARGETS if options.photo else tuple(TARGETS)
    if options.list:
        print("\n".join(known))
        return
    unknown = [name for name in options.targets if name not in known]
    if unknown:
        parser.error(f"{unknown[0]}: is no target; they are {', '.join(known)}")
    check_machine()
    python = tools()
    if not options.sdist:
        run(python, HERE / "sources.py", BUILD / "sources")
    if options.sources:
        return
    source = sdist(python)
    if options.sdist:
        return
    make = photo_wheel if options.photo else wheel
    for name in options.targets or known:
        folder = f"photo-{name}" if options.photo else name
        path = make(python, source, name, BUILD / folder, DIST)
        run(python, HERE / "inspect_wheel.py", path)
        if options.check:
            make_twice(path, functools.partial(make, python, source, name), BUILD / "again" / folder)


if __name__ == "__main__":
    main()
