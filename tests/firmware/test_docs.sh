#!/bin/bash
# The example of docs/firmware.md exactly as on the page: its commands and its program, on this machine.
# usage: test_docs.sh SOURCE_DIR WORK_DIR C_COMPILER FIND_PROFILE LENSPROF
set -euo pipefail
source_dir=$1 work=$2
grep -q blob_bytes "$source_dir/include/lensprof/apply.h" || { echo "skipped: needs the option blob of apply.h"; exit 77; }
rm -rf "$work" && mkdir -p "$work/bin" && cd "$work"
ln -s "$5" bin/lensprof
# block LANGUAGE: the first block of that language
block() { awk -v "first=\`\`\`$1" '$0 == first && !seen { on = seen = 1; next } on && /^```/ { exit } on' "$source_dir/docs/firmware.md"; }
"$4" lenses.db
block sh > commands.sh
PATH="$work/bin:$PATH" bash -euo pipefail commands.sh
block c > camera.c
lines=$(wc -l < camera.c)
[ "$lines" -ge 30 ] && [ "$lines" -le 48 ]
"$3" -std=c11 -Wall -Wextra -Werror -ffp-contract=off -I"$source_dir/include" -I"$source_dir/src" -I. -o camera camera.c \
    "$source_dir"/src/core/*.c "$source_dir"/src/core/kernels/{best,row_scalar}.c -lm
./camera | tee out
# The profile has M = 0.6 in the corner: 90 / 0.6 = 150 there, less at the edge, 90 in the middle.
grep -q '^row 0: left 150, middle 10[0-9]$' out
grep -q '^row 240: left 12[0-9], middle 90$' out
