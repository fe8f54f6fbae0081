"""packaging/release_check.py on copies of what it reads, each with one thing wrong: the line of that check fails."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "packaging"))
import release_check  # noqa: E402

FILES = [name for name, _ in release_check.VERSIONS] + [
    "CHANGELOG.md", "packaging/recipes/vcpkg/portfile.cmake", *(f"packaging/wheels/{name}.txt" for name in ("sources", "tools", "pictures"))]  # fmt: skip


class ReleaseCheck(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in FILES:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        shutil.copytree(ROOT / "include", self.root / "include")
        self.version = release_check.Release(self.root, self.root).version
        self.series = self.version.rpartition(".")[0]
        shutil.copytree(ROOT / "include/lensprof", self.root / f"tests/install/headers-{self.series}/lensprof")
        self.replace("CHANGELOG.md", f"## [{self.version}] - unreleased", f"## [{self.version}] - 2026-12-01")
        self.replace("packaging/debian/changelog", "UNRELEASED", "unstable")
        (self.root / "dist").mkdir()
        names = [f"lensprof-{self.version}-py3-none-{tag}.whl" for tag in release_check.WHEELS]
        names += [f"lensprof_photo-{self.version}-py3-none-{tag}.whl" for tag in release_check.PHOTO_WHEELS]
        for name in (f"lensprof-{self.version}.tar.gz", *names):
            (self.root / "dist" / name).write_text(name)

    def replace(self, name, old, new):
        path = self.root / name
        text = path.read_text()
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1))

    def faults(self, check):
        return "\n".join(check(release_check.Release(self.root, self.root / "dist")))

    def test_nothing_is_wrong(self):
        checks = release_check.Release
        for check in (checks.versions_agree, checks.changelog_is_dated, checks.debian_is_released, checks.headers_are_saved,
                      checks.sources_are_pinned, checks.packages_are_complete):  # fmt: skip
            self.assertEqual(self.faults(check), "", check.__name__)

    def test_another_version_anywhere_is_found(self):
        for name in sorted({name for name, _ in release_check.VERSIONS}):
            text = (self.root / name).read_text()
            (self.root / name).write_text(text.replace(self.version, "0.2.9").replace(f"liblensprof{self.series}", "liblensprof0.2"))
            self.assertIn(f"{name}: states 0.2", self.faults(release_check.Release.versions_agree), name)
            (self.root / name).unlink()
            self.assertIn(f"{name}: states no version", self.faults(release_check.Release.versions_agree), name)
            (self.root / name).write_text(text)

    def test_changelog(self):
        self.replace("CHANGELOG.md", "2026-12-01", "soon")
        self.assertIn("write the date", self.faults(release_check.Release.changelog_is_dated))
        (self.root / "CHANGELOG.md").write_text(f"## [{self.version}] - 2026-12-01\n\n## [0.1.0] - 2025-01-01\n- old\n")
        self.assertIn("lists no change", self.faults(release_check.Release.changelog_is_dated))
        (self.root / "CHANGELOG.md").write_text("# Changelog\n")
        self.assertIn(f"has no section {self.version}", self.faults(release_check.Release.changelog_is_dated))

    def test_unreleased_debian_changelog(self):
        self.replace("packaging/debian/changelog", "unstable", "UNRELEASED")
        self.assertIn("UNRELEASED", self.faults(release_check.Release.debian_is_released))

    def test_headers_that_are_not_saved(self):
        (self.root / "include/lensprof/store.h").write_text("/* new */")
        self.assertIn("store.h: differs", self.faults(release_check.Release.headers_are_saved))
        shutil.rmtree(self.root / "tests")
        self.assertIn("is missing; run `make abi-headers`", self.faults(release_check.Release.headers_are_saved))

    def test_source_without_a_hash(self):
        with open(self.root / "packaging/wheels/tools.txt", "a") as tools:
            tools.write("more==1.0\n")
        self.assertIn("more==1.0: has no version or no hash", self.faults(release_check.Release.sources_are_pinned))

    def test_packages(self):
        complete = release_check.Release.packages_are_complete
        (self.root / "dist/lensprof-0.2.0.tar.gz").touch()
        self.assertIn("lensprof-0.2.0.tar.gz: is of another version", self.faults(complete))
        for path in (self.root / "dist").glob("*win_amd64*"):
            path.unlink()
        self.assertIn("no wheel of lensprof for win_amd64", self.faults(complete))
        shutil.rmtree(self.root / "dist")
        with self.assertRaises(release_check.NotDone):
            self.faults(complete)
        with self.assertRaises(release_check.NotDone):
            self.faults(release_check.Release.wheels_pass_inspection)

    def test_recipes(self):
        self.assertIn("has another hash", self.faults(release_check.Release.recipes_have_the_hash))

    def test_command(self):
        command = [sys.executable, "-B", str(ROOT / "packaging/release_check.py"), "--root", str(self.root)]
        result = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("  ok       one version everywhere", result.stdout)
        self.assertIn("  failed   the tree is committed", result.stdout)
        self.assertFalse((self.root / "dist/SHA256SUMS").exists())


if __name__ == "__main__":
    unittest.main()
