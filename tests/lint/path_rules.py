"""File access of the command: std::filesystem only through src/photo/base/paths.cpp, whose calls do not throw.

path_rules.py SOURCE_DIR     lists every call elsewhere in src/cli and src/photo that accesses the disk and can throw
path_rules.py --self-check   plants violations; exit 1 if one is not found
"""

import pathlib
import re
import sys

# A call of std::filesystem that accesses the disk, or a method of a directory entry.
CALL = re.compile(
    r"(?:filesystem::|fs::)(absolute|canonical|copy\w*|create_\w+|current_path|equivalent|exists|file_size|"
    r"hard_link_count|is_\w+|last_write_time|permissions|proximate|read_symlink|relative|remove\w*|rename|resize_file|"
    r"space|status|symlink_status|temp_directory_path|weakly_canonical|(?:recursive_)?directory_iterator\s+\w+)"
    r"\s*\(([^;]*)|entry->(is_\w+|exists|file_size|refresh)\(\)"
)
CODE = re.compile(r"\b(error|ignored|none)\b")  # an error code selects the overload that does not throw


def violations_in(text):
    return [
        (number, match.group(0).split("(")[0])
        for number, line in enumerate(text.splitlines(), 1)
        for match in CALL.finditer(line)
        if not CODE.search(match.group(2) or "")
    ]


def self_check():
    good = ["std::filesystem::remove(file, ignored);", "fs::path(a).filename();", "fs::directory_iterator entry(name, error), end;"]
    bad = ["std::filesystem::exists(file)", "fs::absolute(path).string();", "if (entry->is_directory())", "fs::directory_iterator e(name);"]
    wrong = [line for line in good if violations_in(line)] + [line for line in bad if not violations_in(line)]
    print("\n".join(wrong) or f"path_rules: {len(bad)} planted violations found")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    root = pathlib.Path(sys.argv[1])
    found = [
        f"{path.relative_to(root)}:{number}: {call} throws in words of its own; use photo/base/paths.hpp"
        for path in sorted((p for top in ("cli", "photo") for p in (root / "src" / top).rglob("*.?pp")))
        if path.name != "paths.cpp"
        for number, call in violations_in(path.read_text(encoding="utf-8"))
    ]
    print("\n".join(found) or "path_rules: no violation")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
