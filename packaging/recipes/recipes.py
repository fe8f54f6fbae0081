#!/usr/bin/env python3
"""The recipes of conda-forge, Homebrew and vcpkg: of this version, and with the hash of its sdist.

usage: recipes.py [--dist FOLDER]      writes version and hash of FOLDER/lensprof-VERSION.tar.gz (default: dist/); exit 1 if a
                                       recipe cannot be read
       recipes.py --try                configures and builds the library with the options that each has, from the sdist
"""

import argparse
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "packaging/wheels"))
import sources  # noqa: E402

# File, then what states the version and the hash in it.
RECIPES = (
    ("conda/recipe.yaml", r'(version: ")([\d.]+)(")', "sha256", r'(sha256: ")(\w+)(")'),
    ("homebrew/lensprof.rb", r"(/lensprof-)([\d.]+)(\.tar\.gz)", "sha256", r'(sha256 ")(\w+)(")'),
    ("vcpkg/vcpkg.json", r'("version": ")([\d.]+)(")', None, None),
    ("vcpkg/portfile.cmake", None, "sha512", r"(SHA512 )(\w+)(\n)"),
)


def set_values(archive: pathlib.Path, version: str) -> None:
    data = archive.read_bytes()
    for name, version_pattern, kind, hash_pattern in RECIPES:
        path = HERE / name
        text = path.read_text()
        for pattern, value in ((version_pattern, version), (hash_pattern, kind and hashlib.new(kind, data).hexdigest())):
            if pattern:
                text, count = re.subn(pattern, lambda found, value=value: found[1] + value + found[3], text)
                if count != 1:
                    sys.exit(f"recipes.py: {path}: {pattern} is there {count} times; correct the recipe")
        path.write_text(text)


def faults() -> list[str]:
    """What a reader of the files would refuse; release_check.py compares their versions and hashes."""
    found = []
    try:
        json.loads((HERE / "vcpkg/vcpkg.json").read_text())
    except ValueError as error:
        found.append(f"{HERE / 'vcpkg/vcpkg.json'}: {error}")
    ruby = shutil.which("ruby")
    if ruby and subprocess.run([ruby, "-c", HERE / "homebrew/lensprof.rb"], capture_output=True).returncode:
        found.append(f"{HERE / 'homebrew/lensprof.rb'}: Ruby cannot read it")
    return found


def options_of(name: str) -> list[str]:
    """What a recipe gives CMake, without the variables of its own tool."""
    return [word for word in re.findall(r"-D[A-Z0-9_]+=[\w.]+", (HERE / name).read_text()) if "CMAKE_" not in word]


def try_recipes(archive: pathlib.Path) -> None:
    with tempfile.TemporaryDirectory() as work:
        with tarfile.open(archive) as opened:
            opened.extractall(work)
        source = next(pathlib.Path(work).iterdir())
        for name in ("conda/recipe.yaml", "homebrew/lensprof.rb", "vcpkg/portfile.cmake"):
            build = pathlib.Path(work) / "build"
            shutil.rmtree(build, ignore_errors=True)
            options = options_of(name)
            for command in (["cmake", "-S", source, "-B", build, "-DCMAKE_BUILD_TYPE=Release", *options],
                            ["cmake", "--build", build, "--parallel", "2", "--target", "lensprof_core"]):  # fmt: skip
                result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
                if result.returncode:
                    sys.exit(f"recipes.py: {name}: {' '.join(options)}: {result.stderr[-1500:]}")
            print(f"{name}: configured and begun with {' '.join(options)}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Set or check the recipes of package managers.")
    parser.add_argument("--dist", type=pathlib.Path, default=ROOT / "dist")
    parser.add_argument("--try", dest="tries", action="store_true")
    options = parser.parse_args()
    version = sources.version_of_lensprof()
    archive = options.dist / f"lensprof-{version}.tar.gz"
    if not archive.exists():
        sys.exit(f"recipes.py: {archive}: there is no such sdist; make it with `packaging/wheels/build.py --sdist`")
    if options.tries:
        try_recipes(archive)
        return
    set_values(archive, version)
    found = faults()
    print("\n".join(found) or f"recipes: of {version}", file=sys.stderr if found else sys.stdout)
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
