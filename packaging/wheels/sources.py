#!/usr/bin/env python3
"""The sources of what a wheel of lensprof contains, fetched by pip and cargo, whose files state their hashes.

usage: sources.py FOLDER

FOLDER receives a folder of each library (eigen, nlohmann, nlopt, pugixml, sqlite), their licences (licenses/NAME), and
lists of them for programs that check licences and vulnerabilities (lensprof.cdx.json and, with the start-up code of
DLLs, lensprof-windows.cdx.json; CycloneDX 1.6). `cmake -DLENSPROF_SOURCES=FOLDER` builds lensprof with them. A folder
of other versions is replaced; the last step is to rename a complete one, so that a run that was stopped is done again.
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
import zipfile
from typing import NamedTuple

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


class Library(NamedTuple):
    """A library inside the wheels."""

    name: str
    license: str  # SPDX
    package: str  # whose archive contains the source, as a package URL without its version
    version: str  # of the package
    folder: str  # of the source in that archive
    version_in: tuple[str, str]  # a file of the source, and what states the library's version there
    texts: tuple[str, ...]  # licences, from the archive's root


LIBRARIES = (
    Library("nlopt", "MIT", "pkg:cargo/nlopt", "0.8.1", "nlopt-2.9.1",
            ("CMakeLists.txt", r"set \(NLOPT_(?:MAJOR|MINOR|BUGFIX)_VERSION \"(\d+)\"\)"),
            ("nlopt-2.9.1/COPYING", "nlopt-2.9.1/src/algs/slsqp/COPYRIGHT", "nlopt-2.9.1/src/algs/direct/COPYING",
             "nlopt-2.9.1/src/algs/bobyqa/COPYRIGHT", "nlopt-2.9.1/src/algs/cobyla/COPYRIGHT",
             "nlopt-2.9.1/src/algs/esch/COPYRIGHT", "nlopt-2.9.1/src/algs/newuoa/COPYRIGHT")),
    Library("sqlite", "blessing", "pkg:cargo/libsqlite3-sys", "0.36.0", "sqlite3",
            ("sqlite3.h", r"#define SQLITE_VERSION +\"(\d+)\.(\d+)\.(\d+)\""), ()),
    Library("pugixml", "MIT", "pkg:pypi/pugixml", "0.8.0", "src/third_party/pugixml",
            ("CMakeLists.txt", r"pugixml VERSION (\d+)\.(\d+)"), ("src/third_party/pugixml/LICENSE.md",)),
    Library("nlohmann", "MIT", "pkg:pypi/nlohmann-json", "3.12.0", "nlohmann_json/include",
            ("nlohmann/detail/abi_macros.hpp", r"#define NLOHMANN_JSON_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)"),
            ("nlohmann_json-3.12.0.dist-info/licenses/LICENSE",)),
    Library("eigen", "MPL-2.0", "pkg:pypi/cmeel-eigen", "3.4.0.2", "cmeel.prefix/include/eigen3",
            ("Eigen/src/Core/util/Macros.h", r"#define EIGEN_(?:WORLD|MAJOR|MINOR)_VERSION (\d+)"), ()),
)  # fmt: skip

# Licences that are no file of the archives.
NOTES = {
    "sqlite": "SQLite is in the public domain: https://www.sqlite.org/copyright.html\n",
    "eigen": "Eigen (https://eigen.tuxfamily.org) is subject to the terms of the Mozilla Public License, v. 2.0. If a copy "
    "of\nthe MPL was not distributed with this file, you can obtain one at https://mozilla.org/MPL/2.0/. lensprof contains\n"
    "compiled, unmodified headers of Eigen; their source is the package {package} {version} of PyPI.\n",
}
LIBCXX = "Apache-2.0 WITH LLVM-exception"


def fetch(folder: pathlib.Path) -> dict[str, pathlib.Path]:
    """Unpacked archives by package name."""
    vendored, archives, unpacked = folder / "crates", folder / "archives", folder / "unpacked"
    manifest = folder / "manifest"
    shutil.copytree(HERE / "sources", manifest)
    (manifest / "empty.rs").touch()
    run("cargo", "vendor", "--quiet", "--locked", "--manifest-path", manifest / "Cargo.toml", vendored)
    run(sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps",
        "--no-binary", "pugixml", "--no-build-isolation", "--require-hashes", "-r", HERE / "sources.txt", "-d", archives)  # fmt: skip
    found = {path.name: path for path in vendored.iterdir()}
    for archive in sorted(archives.iterdir()):
        name = re.split(r"-\d", archive.name)[0].replace("_", "-")
        if archive.suffix == ".whl":
            zipfile.ZipFile(archive).extractall(unpacked / name)
            found[name] = unpacked / name
        else:
            tarfile.open(archive).extractall(unpacked)
            found[name] = unpacked / archive.name.replace(".tar.gz", "")
    return found


def run(*command: object) -> None:
    try:
        result = subprocess.run([str(word) for word in command], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    except FileNotFoundError:
        sys.exit(f"sources.py: {command[0]}: is not installed; install the packages of packages-wheels.txt (make wheels)")
    if result.returncode:
        sys.exit(f"sources.py: {' '.join(str(word) for word in command[:4])}: failed; run it again if the network failed\n"
                 + result.stderr[-2000:])  # fmt: skip


def stated_version(library: Library, source: pathlib.Path) -> str:
    name, pattern = library.version_in
    numbers = [n for match in re.findall(pattern, (source / name).read_text()) for n in (match if isinstance(match, tuple) else (match,))]
    if not numbers:
        sys.exit(f"sources.py: {source / name}: states no version; correct version_in of {library.name}")
    return ".".join(numbers[:3])


def component(name: str, version: str, license_name: str, url: str) -> dict:
    stated = {"expression": license_name} if " " in license_name else {"license": {"id": license_name}}
    return {"type": "library", "bom-ref": name, "name": name, "version": version, "licenses": [stated], "purl": url}


def version_of_lensprof(root: pathlib.Path = ROOT) -> str:
    header = (root / "include/lensprof/base.h").read_text()
    return ".".join(re.findall(r"LENSPROF_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header)[:3])


def bill_of_materials(components: list[dict]) -> str:
    """CycloneDX without a serial number or a time: the same sources, the same bytes."""
    product = {"type": "library", "bom-ref": "lensprof", "name": "lensprof", "version": version_of_lensprof(),
               "licenses": [{"license": {"id": "MIT"}}], "purl": f"pkg:pypi/lensprof@{version_of_lensprof()}"}  # fmt: skip
    depends = [{"ref": "lensprof", "dependsOn": [c["bom-ref"] for c in components]}]
    text = {"bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1, "metadata": {"component": product},
            "components": components, "dependencies": depends}  # fmt: skip
    return json.dumps(text, indent=1) + "\n"


def collect(unpacked: dict[str, pathlib.Path], compiler: pathlib.Path, folder: pathlib.Path) -> None:
    components = []
    for library in LIBRARIES:
        archive = unpacked[library.package.split("/")[-1]]
        shutil.copytree(archive / library.folder, folder / library.name)
        texts = folder / "licenses" / library.name
        texts.mkdir(parents=True)
        for text in library.texts:
            parts = pathlib.PurePath(text).parts
            shutil.copy(archive / text, texts / "-".join(parts[-2:] if "algs" in parts else parts[-1:]))
        if library.name in NOTES:
            (texts / "LICENSE.txt").write_text(NOTES[library.name].format(package=library.package, version=library.version))
        url = f"{library.package}@{library.version}"
        components.append(component(library.name, stated_version(library, folder / library.name), library.license, url))
    version = next(compiler.parent.glob("ziglang-*.dist-info")).name.split("-")[1].replace(".dist", "")
    part = f"pkg:pypi/ziglang@{version}"
    for name in ("libcxx", "libcxxabi", "libunwind"):  # of the compiler, static in C++ libraries
        (folder / "licenses" / name).mkdir()
        shutil.copy(compiler / "lib" / name / "LICENSE.TXT", folder / "licenses" / name)
        components.append(component(name, version, LIBCXX, part))
    components.append(component("compiler-rt", version, "MIT", part))  # that of zig
    (folder / "licenses/mingw-w64").mkdir()  # start-up code of DLLs for Windows
    shutil.copy(compiler / "lib/libc/mingw/COPYING", folder / "licenses/mingw-w64")
    (folder / "lensprof.cdx.json").write_text(bill_of_materials(components))
    components.append(component("mingw-w64", version, "ZPL-2.1", part))
    (folder / "lensprof-windows.cdx.json").write_text(bill_of_materials(components))


def main() -> None:
    parser = argparse.ArgumentParser(description="Fetch the sources of what a wheel contains.")
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    lists = (HERE / "sources.py", HERE / "sources.txt", HERE / "tools.txt", HERE / "sources/Cargo.lock")
    stamp = hashlib.sha256(b"".join(path.read_bytes() for path in lists)).hexdigest()
    if (folder / "stamp").exists() and (folder / "stamp").read_text() == stamp:
        return
    try:
        import ziglang
    except ImportError:
        sys.exit("sources.py: the package ziglang is not installed; run `make wheels`, which installs it")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as work:
        collected = pathlib.Path(work) / "collected"
        collect(fetch(pathlib.Path(work)), pathlib.Path(ziglang.__file__).parent, collected)
        (collected / "stamp").write_text(stamp)
        shutil.rmtree(folder, ignore_errors=True)
        collected.rename(folder)


if __name__ == "__main__":
    main()
