"""Slices of campaigns: a pattern that selects or skips tests must match at least one, because cmocka accepts a program
without tests.

slice_rules.py SOURCE_DIR     lists every LENSPROF_TEST and LENSPROF_SKIP of tests/*/CMakeLists.txt without a test
slice_rules.py --self-check   plants violations; exit 1 if one is not found
"""

import fnmatch
import pathlib
import re
import sys
import tempfile

CAMPAIGN = re.compile(r"^\s*lensprof_campaign\(\s*(\w+)([^)]*)\)", re.MULTILINE)
PROGRAM = re.compile(r"\bPROGRAM\s+(\w+)")
PATTERN = re.compile(r"LENSPROF_(?:TEST|SKIP)=([\w*?]*)")
REGISTERED = re.compile(r"\b(?:cmocka_unit_test\w*|CLI_TEST)\(\s*(\w+)")


def tests_of(folder, program):
    sources = [folder / f"{program}{ending}" for ending in (".c", ".cpp")]
    return {
        name
        for source in sources
        if source.exists()
        for name in REGISTERED.findall(source.read_text(encoding="utf-8"))
    }


def patterns_in(root):
    """Folder, program and pattern of each slice."""
    for path in sorted((root / "tests").glob("*/CMakeLists.txt")):
        for name, arguments in CAMPAIGN.findall(path.read_text(encoding="utf-8")):
            program = PROGRAM.search(arguments)
            for pattern in PATTERN.findall(arguments):
                yield path.parent, program.group(1) if program else name, pattern


def violations_in(root):
    return [
        f"{folder.relative_to(root)}/CMakeLists.txt: {pattern} is no test of {program}; correct the pattern"
        for folder, program, pattern in patterns_in(root)
        if not fnmatch.filter(tests_of(folder, program), pattern)
    ]


def self_check():
    good = [
        'lensprof_campaign(test_a SANITIZED "LENSPROF_TEST=test_on*")',
        "lensprof_campaign(test_a RELEASE LENSPROF_PERCENT=3 SANITIZED LENSPROF_SKIP=test_two)",
        "lensprof_campaign(b PROGRAM test_a\n  ARGUMENTS slow RELEASE LENSPROF_TEST=test_t?o)",
    ]
    bad = [
        'lensprof_campaign(test_a SANITIZED "LENSPROF_TEST=test_once*")',
        "lensprof_campaign(test_a SANITIZED LENSPROF_SKIP=test_t)",
        "lensprof_campaign(test_a SANITIZED LENSPROF_SKIP=test_unused)",
        "lensprof_campaign(test_none SANITIZED LENSPROF_TEST=test_one)",
    ]
    wrong = []
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made, "tests", "fit")
        folder.mkdir(parents=True)
        source = "static void test_unused(void **) {}\n{cmocka_unit_test(test_one), CLI_TEST(test_two)}\n"
        (folder / "test_a.cpp").write_text(source, encoding="utf-8")
        for line in good + bad:
            (folder / "CMakeLists.txt").write_text(line + "\n", encoding="utf-8")
            if bool(violations_in(pathlib.Path(made))) != (line in bad):
                wrong.append(line)
    print("\n".join(wrong) or f"slice_rules: {len(bad)} planted violations found")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    root = pathlib.Path(sys.argv[1])
    found = violations_in(root)
    count = len(list(patterns_in(root)))
    if not count:
        found = ["no slice found: has lensprof_campaign another name?"]
    print("\n".join(found) or f"slice_rules: {count} patterns, each matches a test")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
