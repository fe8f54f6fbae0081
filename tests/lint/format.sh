#!/usr/bin/env bash
# format.sh CLANG_FORMAT: every C and C++ file follows .clang-format, and a file is executable if its first line states
# what runs it (#!). Exit 77 (skipped) without version 14 or git.
set -euo pipefail
cd "$(dirname "$0")/../.."
clang_format=${1:-clang-format}
"$clang_format" --version 2>/dev/null | grep -q 'version 14\.' || { echo "skipped: needs clang-format 14"; exit 77; }
git rev-parse --git-dir >/dev/null 2>&1 || { echo "skipped: needs a git checkout"; exit 77; }
failed=0
git ls-files '*.c' '*.h' '*.cpp' '*.hpp' | grep -vE '(emor|prior|typical)_table\.' | xargs "$clang_format" --dry-run -Werror ||
    { echo "run make format"; failed=1; }
scripts=$(git grep -l --cached -m1 '^#!' | while read -r file; do head -c2 "$file" | grep -q '#!' && echo "$file"; done | sort)
executables=$(git ls-files -s | sed -n 's/^100755[^\t]*\t//p' | sort)
diff <(echo "$scripts") <(echo "$executables") | sed -n 's/^< \(.*\)/\1: is not executable; chmod +x/p
    s/^> \(.*\)/\1: is executable, but has no #! line/p' | grep . && failed=1
exit $failed
