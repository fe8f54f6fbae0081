#!/usr/bin/env bash
# format.sh CLANG_FORMAT: every C and C++ file follows .clang-format. Exit 77 (skipped) without version 14 or git.
set -euo pipefail
cd "$(dirname "$0")/../.."
clang_format=${1:-clang-format}
"$clang_format" --version 2>/dev/null | grep -q 'version 14\.' || { echo "skipped: needs clang-format 14"; exit 77; }
git rev-parse --git-dir >/dev/null 2>&1 || { echo "skipped: needs a git checkout"; exit 77; }
git ls-files '*.c' '*.h' '*.cpp' '*.hpp' | grep -vE '(emor|prior|typical)_table\.' | xargs "$clang_format" --dry-run -Werror ||
    { echo "run make format"; exit 1; }
