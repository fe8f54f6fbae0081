#!/bin/bash
# The demonstrations give the same bytes on the boards as on this machine, and stay within their stack.
# usage: test_boards.sh SOURCE_DIR WORK_DIR C_COMPILER BOARD
set -euo pipefail
source_dir=$1 work=$2 board=$4
. "$source_dir/tests/firmware/need.sh"
need arm-none-eabi-gcc qemu-system-arm make python3
mkdir -p "$work"
build=(make -s -C "$source_dir/examples/firmware" "OUT=$work" "CC=$3" "BOARD=$board")
"${build[@]}" pc > "$work/pc.log" 2>&1 || { head -20 "$work/pc.log"; exit 1; }
"${build[@]}" all > "$work/$board.log" 2>&1 || { head -20 "$work/$board.log"; exit 1; }
! grep -i -A3 warning "$work/$board.log" "$work/pc.log" | cut -c1-200 || exit 1

# same PROGRAM ROW PC_PROGRAM MOST: compares rows of one name; at most MOST bytes may differ, by one level.
same() {
    semihosted "$board" "$work/$board/$1.elf" > "$work/$board/$1.txt" || { grep -v ': [0-9a-f]*$' "$work/$board/$1.txt"; exit 1; }
    python3 - "$work/$board/$1.txt" "$work/$3.txt" "$2" "$4" << 'END'
import sys
board, pc = ([bytes.fromhex(line.split()[1]) for line in open(name) if line.startswith(sys.argv[3] + ":")]
             for name in sys.argv[1:3])
both = list(zip(b"".join(board), b"".join(pc)))
differ, worst = sum(a != b for a, b in both), max(abs(a - b) for a, b in both)
print(f"{sys.argv[3]}: {len(both)} bytes, {differ} differ, by {worst} at most")
rows = len(board) == len(pc) == 16 and len(set(b"".join(pc))) > 60  # a picture, not a constant
sys.exit(not rows or len(both) != 16 * 160 * 3 or differ > int(sys.argv[4]) or worst > 1)
END
}
case $board in
microbit)
    same correct_fixed fixed correct_fixed 0
    same correct_fixed_here fixed correct_fixed 20 # the board's own logarithms may differ in the last bits
    programs="correct_fixed correct_fixed_here" most=512 tick_ns=16 ;;
*)
    same correct_float table correct_float 0
    same correct_float gamma correct_float 20 # pow() from another C library
    programs=correct_float most=2560 tick_ns=40 ;;
esac
for program in $programs; do
    while read -r what _ bytes; do
        echo "$program, $board: $what stack $bytes bytes"
        [ "$what" = apply: ] && limit=$((most + 256)) || limit=2048 # 256: the demonstration's own stack
        [ "$bytes" -gt 64 ] && [ "$bytes" -le $limit ] || { echo "more than $limit"; exit 1; }
    done < <(grep -a "stack" "$work/$board/$program.txt")
    for ticks in $(sed -n 's/^apply: ticks //p' "$work/$board/$program.txt"); do
        echo "$program, $board: $((ticks * tick_ns / (160 * 16))) instructions per pixel (RGB, 8 bit)"
        [ "$ticks" -gt 1000 ]
    done
done
