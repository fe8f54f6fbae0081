#!/bin/bash
# README's C example exactly as printed there: compiled, linked, and run on a picture.
# usage: test_readme.sh SOURCE_DIR LIBRARY C_COMPILER
set -euo pipefail
source_dir=$1 library=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk '$0 == "```c" { on = 1; next } on && /^```/ { exit } on' "$source_dir/README.md" > "$work/readme.c"
lines=$(wc -l < "$work/readme.c")
[ "$lines" -ge 10 ] && [ "$lines" -le 22 ] || { echo "README's example has $lines lines"; exit 1; }
cat "$source_dir/tests/install/readme_main.c" >> "$work/readme.c"
"$3" -std=c99 -D_DEFAULT_SOURCE -Wall -Wextra -pedantic -Werror -I"$source_dir/include" -o "$work/readme" "$work/readme.c" "$library" -lm \
    -Wl,-rpath,"$(dirname "$library")"
"$work/readme"
