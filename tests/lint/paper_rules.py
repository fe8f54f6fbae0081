#!/usr/bin/env python3
"""paper_rules.py ROOT: the files named in docs/papers.md exist, and contain the functions named after them.
paper_rules.py --self-check: missing files and functions are found."""
import pathlib
import re
import sys
import tempfile

PLACE = re.compile(r"`([\w/]+\.(?:c|h|cpp|hpp|py))`(?::((?:,? `\w+`)+))?")  # `file`: `function`, `function`


def missing(root):
    """Texts about missing files and functions."""
    for number, line in enumerate((root / "docs/papers.md").read_text(encoding="utf-8").splitlines(), 1):
        for name, functions in PLACE.findall(line):
            file = root / name
            text = file.read_text(encoding="utf-8") if file.is_file() else None
            if text is None:
                yield f"docs/papers.md:{number}: there is no {name}"
                continue
            for function in re.findall(r"`(\w+)`", functions):
                if not re.search(rf"\b{function}\b", text):
                    yield f"docs/papers.md:{number}: {name} has no {function}"


def self_check():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs").mkdir()
        (root / "a.c").write_text("int here(void);")
        (root / "docs/papers.md").write_text("| 1 | `a.c`: `here`, `there`; `b.c`: `here` |\n")
        return list(missing(root)) == ["docs/papers.md:1: a.c has no there", "docs/papers.md:1: there is no b.c"]


def main():
    if sys.argv[1] == "--self-check":
        return not self_check()
    problems = list(missing(pathlib.Path(sys.argv[1])))
    print("\n".join(problems))
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
