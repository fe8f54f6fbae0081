#!/usr/bin/env python3
"""Plain technical English: the words of CONTRIBUTING.md, short sentences in README.md, short lines in Markdown.

usage: plain_words.py SOURCE_DIR      list violations; exit 1 if there are any
       plain_words.py --self-check    plant violations in a temporary tree; exit 1 if one is not found

The table below "Words" in CONTRIBUTING.md has one row per rule: phrases to avoid, each in backquotes, and what to write
instead. X in a phrase matches any word. Checked are the prose of Markdown files, and the comments and string literals
of the sources. Code, whether fenced or in backquotes, is not prose.
"""

import pathlib
import re
import sys
import tempfile

import text_rules

# Files to check, as globs relative to the project.
PROSE = ("*.md", "bindings/**/*.md", "docs/**/*.md", "examples/**/*.md", "src/**/*.md")
SOURCES = (
    "include/lensprof/*.h",
    "bindings/cpp/*.?pp",
    "bindings/python/lensprof/*.py",
    "bindings/tools/*.py",
    "src/cli/**/*.?pp",
    "src/core/*",
    "src/core/kernels/*",
    "src/falloff/*",
    "src/fit/**/*",
    "src/formats/**/*",
    "src/photo/**/*.?pp",
    "src/store/**/*",
    "tests/*.?",
    "tests/bench/*",
    "tests/bindings/*",
    "tests/docs/*",
    "tests/firmware/**/*",
    "tests/install/**/*",
    "tests/python/*",
    "tests/cli/*",
    "tests/fit/*",
    "tests/formats/*",
    "tests/fuzz/*.?pp",
    "tests/fuzz/*.c",
    "tests/store/*",
    "tests/unit/*",
)
# Files with sentences of other people, tables that a program wrote, or names in these tables.
EXEMPT = ("tests/lint/", "tests/bench/cases.py", "tests/bench/radiance.py", "tests/bench/report.py",
          "docs/benchmark-results.md", "docs/reference/schema.md", "LICENSE", "NOTICE")

TEXT_FILES = {".md", ".c", ".h", ".cpp", ".hpp", ".py"}

LONGEST_SENTENCE = 30  # words, in README.md
LONGEST_LINE = 120  # columns of Markdown; rows of tables and lines with one link are exempt
# Idioms that a phrase of the table must not match.
ALLOWED = re.compile(r"\b(?:there (?:is|are) no\b|(?:is|are) no (?:longer|more)\b|hard to say|that is to say)", re.IGNORECASE)

PYTHON_TEXT = re.compile(
    r'''(?P<doc>"{3}.*?"{3}) | (?P<text>f?"(?:[^"\\\n]|\\.)*") | '(?:[^'\\\n]|\\.)*' | (?P<comment>\#[^\n]*)''',
    re.VERBOSE | re.DOTALL,
)


def rules_of(contributing):
    """(pattern, what to write instead) of every phrase in the table of words."""
    rules = []
    section = contributing.partition("## Words")[2].partition("\n## ")[0]
    for row in re.findall(r"^\|(.*`.*)\|(.*)\|$", section, re.MULTILINE):
        for phrase in re.findall(r"`([^`]+)`", row[0]):
            words = r"\s+".join(r"\w+" if word == "X" else re.escape(word) for word in phrase.split())
            rules.append((re.compile(rf"\b{words}(?!\w)", re.IGNORECASE), row[1].strip()))
    return rules


def blank(match):
    """Spaces for a piece of text that is not prose; lines stay where they are."""
    return re.sub(r"[^\n]", " ", match[0])


def prose_of(markdown):
    text = re.sub(r"^ *(```|~~~).*?^ *\1", blank, markdown, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"<!--.*?-->|^(?: {4}|\t)[^\n]*", blank, text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"`[^`\n]+`", lambda match: "x" * len(match[0]), text)
    return re.sub(r"\]\([^)\s]*\)", lambda match: "]" + " " * (len(match[0]) - 1), text)


def texts_of(name, source):
    """(line, text) of every comment and string literal."""
    if name.endswith(".py"):
        found = ((source.count("\n", 0, match.start()) + 1, match.lastgroup, match[0]) for match in PYTHON_TEXT.finditer(source))
    else:
        found = text_rules.texts_of(source)
    for line, kind, text in found:
        if kind:
            yield line, re.sub(r"\n[ \t]*(?://|\*|#)?[ \t]*", "\n", text)


def check_words(name, line, text, rules):
    spoken = re.sub(r"`[^`\n]+`", lambda match: "x" * len(match[0]), text)
    spoken = ALLOWED.sub(blank, spoken)
    for pattern, better in rules:
        for found in pattern.finditer(spoken):
            yield f"{name}:{line + spoken.count(chr(10), 0, found.start())}: {found[0]!r}; write {better}"


def check_lines(name, markdown):
    fenced = False
    for number, line in enumerate(markdown.split("\n"), 1):
        if re.match(r" *(```|~~~)", line):
            fenced = not fenced
        if len(line) > LONGEST_LINE and not fenced and not line.startswith("|") and line.count(" ") > 2:
            yield f"{name}:{number}: {len(line)} columns; wrap the line at {LONGEST_LINE}"


def check_sentences(name, prose):
    for paragraph in re.finditer(r"(?:^(?![|#]).*\S.*\n?)+", prose, re.MULTILINE):
        line = prose.count("\n", 0, paragraph.start()) + 1
        for sentence in re.split(r"(?<=[.!?])\s+|^[-*] |^\d+\. ", paragraph[0], flags=re.MULTILINE):
            words = re.findall(r"[\w'-]+", sentence)
            if len(words) > LONGEST_SENTENCE:
                yield f"{name}:{line}: a sentence of {len(words)} words: {' '.join(words[:6])} ...; split it"


def files_of(root, globs):
    for pattern in globs:
        for path in sorted(root.glob(pattern)):
            name = str(path.relative_to(root))
            if path.is_file() and not name.startswith(EXEMPT) and path.suffix in TEXT_FILES:
                yield name, path.read_text(encoding="utf-8")


def check(root, prose=PROSE, sources=SOURCES):
    rules = rules_of((root / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    if not rules:
        return ["CONTRIBUTING.md: no table of words below '## Words'"]
    violations = []
    for name, markdown in files_of(root, prose):
        text = prose_of(markdown)
        if name == "CONTRIBUTING.md":  # the table itself
            text = re.sub(r"## Words.*?(?=\n## |\Z)", blank, text, flags=re.DOTALL)
        violations += check_words(name, 1, text, rules)
        violations += check_lines(name, markdown)
        if name == "README.md":
            violations += check_sentences(name, text)
    for name, source in files_of(root, sources):
        for line, text in texts_of(name, source):
            violations += check_words(name, line, text, rules)
    return violations


def self_check():
    words = "# C\n## Words\n| avoid | write |\n|---|---|\n| `tells`, `told` | reports |\n| `is no X` | is not a |\n\n## More\n"
    cases = (
        ("README.md", "It tells you.\n", 1),
        ("README.md", "There is no mark. It is no longer so. `tells` and\n```\ntold\n```\n", 0),
        ("README.md", "\nThis is\nno number.\n", 1),
        ("README.md", "word " * 31 + ".\n", 2),
        ("README.md", "- " + "word " * 16 + "\n- " + "word " * 16 + "\n", 0),
        ("a.cpp", '// It is told.\nint tells = 1;\nsay("is " "no" " file");\n', 2),
        ("a.py", '"""It tells."""\ntold = "is no file"  # told\n', 3),
        ("a.c", "/* One.\n * It\n * is no\n * file. */\n", 1),
    )
    failures = []
    for name, text, wanted in cases:
        with tempfile.TemporaryDirectory() as place:
            root = pathlib.Path(place)
            (root / "CONTRIBUTING.md").write_text(words)
            (root / name).write_text(text)
            found = check(root, ("README.md", "CONTRIBUTING.md"), ("a.*",))
            if len(found) != wanted:
                failures.append(f"{name} {text!r}: found {found}, wanted {wanted}")
    print("\n".join(failures) or "plain_words --self-check: all violations are found")
    return 1 if failures else 0


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--self-check":
        sys.exit(self_check())
    violations = check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(violations) or "plain_words: no violation")
    sys.exit(1 if violations else 0)


if __name__ == "__main__":
    main()
