#!/usr/bin/env python3
"""What must hold before a release: one line for each, "ok", "failed" or "not done" with the next step.

usage: release_check.py [--dist FOLDER] [--root FOLDER]     exit 1 unless all lines are "ok"; writes FOLDER/SHA256SUMS if
                                                            the wheels are complete
"""

from __future__ import annotations

import argparse
import datetime
import hashlib
import pathlib
import re
import subprocess
import sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent / folder) for folder in ("wheels", "recipes")]
import recipes  # noqa: E402
import sources  # noqa: E402

# Where a version stands, and the pattern of it.
VERSIONS = (
    ("pyproject.toml", r'"lensprof-photo==([\d.]+)"'),
    ("packaging/photo/pyproject.toml", r'"lensprof==([\d.]+)"'),
    ("packaging/debian/changelog", r"\Alensprof \(([\d.]+)-"),
    ("packaging/debian/control", r"^Package: liblensprof([\d.]+)$"),
    ("packaging/debian/rules", r"@Base ([\d.]+)"),
    ("packaging/recipes/conda/recipe.yaml", r'version: "([\d.]+)"'),
    ("packaging/recipes/homebrew/lensprof.rb", r"/lensprof-([\d.]+)\.tar\.gz"),
    ("packaging/recipes/vcpkg/vcpkg.json", r'"version": "([\d.]+)"'),
    ("bindings/python/lensprof/_abi.py", r'^VERSION = "([\d.]+)"'),
    ("bindings/node/package.json", r'"version": "([\d.]+)"'),
    ("bindings/node/abi.js", r"VERSION = '([\d.]+)'"),
    ("bindings/java/pom.xml", r"<artifactId>lensprof</artifactId>\s*<version>([\d.]+)<"),
    ("bindings/java/src/main/java/lensprof/Abi.java", r'VERSION = "([\d.]+)"'),
    ("bindings/rust/Cargo.toml", r'^version = "([\d.]+)"'),
    ("bindings/rust/lensprof/Cargo.toml", r'lensprof-sys.*version = "([\d.]+)"'),
    ("bindings/rust/lensprof-sys/src/abi.rs", r'VERSION: &str = "([\d.]+)"'),
)
WHEELS = ("manylinux_2_17_x86_64", "manylinux_2_17_aarch64", "musllinux_1_2_x86_64", "macosx_11_0_arm64", "macosx_11_0_x86_64",
          "win_amd64")  # fmt: skip
PHOTO_WHEELS = ("manylinux_2_17_x86_64",)


class NotDone(Exception):
    """Something is to be made first."""


class Release:
    """A tree and its packages. Each check returns its faults."""

    def __init__(self, root: pathlib.Path, dist: pathlib.Path) -> None:
        self.root, self.dist = root, dist
        self.version = sources.version_of_lensprof(root)

    def tree_is_clean(self) -> list[str]:
        status = subprocess.run(["git", "-C", self.root, "status", "--porcelain"], capture_output=True, text=True)
        if status.returncode:
            return [f"{self.root}: is not a git checkout"]
        return [f"{line[3:]}: is not committed" for line in status.stdout.splitlines()[:5]]

    def versions_agree(self) -> list[str]:
        faults = []
        for name, pattern in VERSIONS:
            path = self.root / name
            found = re.findall(pattern, path.read_text(), re.MULTILINE) if path.exists() else []
            wanted = self.version.rpartition(".")[0] if "liblensprof(" in pattern else self.version
            if not found or any(value != wanted for value in found):
                faults.append(f"{name}: states {' and '.join(found) or 'no version'}, not {wanted}")
        return faults

    def changelog_is_dated(self) -> list[str]:
        text = (self.root / "CHANGELOG.md").read_text()
        heading = re.search(rf"^## \[{re.escape(self.version)}\] - (.*)$", text, re.MULTILINE)
        if not heading:
            return [f"CHANGELOG.md: has no section {self.version}"]
        try:
            datetime.date.fromisoformat(heading[1])
        except ValueError:
            return [f"CHANGELOG.md: {self.version} is of '{heading[1]}'; write the date"]
        section = text[heading.end() :].split("\n## ")[0]
        return [] if re.search(r"^- ", section, re.MULTILINE) else [f"CHANGELOG.md: {self.version} lists no change"]

    def debian_is_released(self) -> list[str]:
        first = (self.root / "packaging/debian/changelog").read_text().split("\n")[0]
        return ["packaging/debian/changelog: is UNRELEASED; name the distribution"] if "UNRELEASED" in first else []

    def headers_are_saved(self) -> list[str]:
        saved = self.root / f"tests/install/headers-{self.version.rpartition('.')[0]}/lensprof"
        if not saved.is_dir():
            return [f"{saved}: is missing; run `make abi-headers`"]
        headers = (self.root / "include/lensprof").glob("*.h")
        return [f"{path.name}: differs from the saved one; run `make abi-headers`" for path in sorted(headers)
                if not (saved / path.name).exists() or (saved / path.name).read_bytes() != path.read_bytes()][:3]  # fmt: skip

    def abi_is_the_baseline(self) -> list[str]:
        library = self.root / "build/liblensprof.so"
        if not library.exists():
            raise NotDone("run `make build`, which makes build/liblensprof.so")
        result = subprocess.run([sys.executable, self.root / "tests/install/abi_check.py", "check"], cwd=self.root,
                                capture_output=True, text=True)  # fmt: skip
        if result.returncode == 77:
            raise NotDone("install abigail-tools")
        return [] if result.returncode == 0 else (result.stdout + result.stderr).strip().splitlines()[-3:]

    def sources_are_pinned(self) -> list[str]:
        faults = []
        for name in ("sources.txt", "tools.txt", "pictures.txt"):
            for line in (self.root / "packaging/wheels" / name).read_text().splitlines():
                if line and not line.startswith("#") and not re.search(r"==\S+ --hash=sha256:[0-9a-f]{64}$", line):
                    faults.append(f"packaging/wheels/{name}: {line}: has no version or no hash")
        return faults

    def packages(self) -> list[pathlib.Path]:
        sdist = self.dist / f"lensprof-{self.version}.tar.gz"
        found = [sdist] if sdist.exists() else []
        return found + sorted(self.dist.glob(f"lensprof-{self.version}-*.whl")) + sorted(self.dist.glob(f"lensprof_photo-{self.version}-*.whl"))

    def packages_are_complete(self) -> list[str]:
        names = [path.name for path in self.packages()]
        if not names:
            raise NotDone("run `make wheels`")
        missing = [f"no wheel of {package} for {tag}" for package, tags in (("lensprof", WHEELS), ("lensprof_photo", PHOTO_WHEELS))
                   for tag in tags if not any(tag in name for name in names if name.startswith(package + "-"))]  # fmt: skip
        missing += [] if any(name.endswith(".tar.gz") for name in names) else ["no sdist"]
        foreign = [f"{path.name}: is of another version" for path in sorted(self.dist.glob("lensprof*"))
                   if path not in self.packages()]  # fmt: skip
        return [f"{self.dist}: {fault}; run `make wheels`" for fault in missing + foreign]

    def packages_are_newer(self) -> list[str]:
        """Than the last commit."""
        stated = subprocess.run(["git", "-C", self.root, "log", "-1", "--format=%ct"], capture_output=True, text=True)
        if not self.packages() or stated.returncode:
            raise NotDone("run `make wheels`")
        old = [path.name for path in self.packages() if path.stat().st_mtime < int(stated.stdout)]
        return [f"{name}: is older than the last commit; run `make wheels`" for name in old]

    def wheels_pass_inspection(self) -> list[str]:
        python = self.root / "build/wheels/tools/bin/python"
        wheels = [path for path in self.packages() if path.suffix == ".whl"]
        if not wheels or not python.exists():
            raise NotDone("run `make wheels`")
        result = subprocess.run([python, self.root / "packaging/wheels/inspect_wheel.py", *wheels], capture_output=True, text=True)
        return result.stderr.strip().splitlines() if result.returncode else []

    def recipes_have_the_hash(self) -> list[str]:
        sdist = self.dist / f"lensprof-{self.version}.tar.gz"
        if not sdist.exists():
            raise NotDone("run `make wheels`")
        data, folder = sdist.read_bytes(), self.root / "packaging/recipes"
        return [f"packaging/recipes/{name}: has another hash than {sdist.name}; run `make recipes`"
                for name, _, kind, _ in recipes.RECIPES
                if kind and hashlib.new(kind, data).hexdigest() not in (folder / name).read_text()]  # fmt: skip

    def write_sums(self) -> None:
        lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in self.packages()]
        (self.dist / "SHA256SUMS").write_text("".join(lines))


CHECKS = (
    ("the tree is committed", Release.tree_is_clean),
    ("one version everywhere", Release.versions_agree),
    ("CHANGELOG has the version and its date", Release.changelog_is_dated),
    ("the Debian changelog names a distribution", Release.debian_is_released),
    ("the headers of the release are saved", Release.headers_are_saved),
    ("the ABI is that of the baseline", Release.abi_is_the_baseline),
    ("sources and tools have hashes", Release.sources_are_pinned),
    ("sdist and wheels of all platforms", Release.packages_are_complete),
    ("they are of the last commit", Release.packages_are_newer),
    ("the wheels pass their inspection", Release.wheels_pass_inspection),
    ("recipes have the hash of the sdist", Release.recipes_have_the_hash),
)


def main() -> None:
    parser = argparse.ArgumentParser(description="Check what must hold before a release.")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--dist", type=pathlib.Path)
    options = parser.parse_args()
    release = Release(options.root, options.dist or options.root / "dist")
    print(f"lensprof {release.version}")
    complete, good = True, True
    for what, check in CHECKS:
        try:
            faults = check(release)
            print(f"  {'failed' if faults else 'ok':8} {what}" + "".join(f"\n           {fault}" for fault in faults))
        except NotDone as step:
            faults = [str(step)]
            print(f"  not done {what}: {step}")
        good &= not faults
        complete &= not faults or "package" not in check.__name__ and "wheels" not in check.__name__
    if complete:
        release.write_sums()
        print(f"written  {release.dist / 'SHA256SUMS'}")
    sys.exit(not good)


if __name__ == "__main__":
    main()
