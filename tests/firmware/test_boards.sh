#!/bin/bash
# The demonstrations give the same bytes on the boards as on this machine, and stay within their stack; the memory of the
# apply path, from the linker's map, stays within its ceilings.
# usage: test_boards.sh SOURCE_DIR WORK_DIR C_COMPILER
set -euo pipefail
source_dir=$1 work=$2 cc=$3
. "$source_dir/tests/firmware/need.sh"
need arm-none-eabi-gcc arm-none-eabi-size qemu-system-arm make python3

# build OPT TARGET BOARD: below $work/OPT; the boards share what runs on this machine
build() {
    local out=$work/$1
    mkdir -p "$out"
    make -s -C "$source_dir/examples/firmware" "OUT=$out" "CC=$cc" "OPT=$1" "BOARD=$3" "$2" > "$out/$3-$2.log" 2>&1 ||
        { head -20 "$out/$3-$2.log"; exit 1; }
    ! grep -i -A3 warning "$out/$3-$2.log" | cut -c1-200 || exit 1
}

# same BOARD PROGRAM ROW PC_PROGRAM MOST: compares rows of one name; at most MOST bytes may differ, by one level.
same() {
    local on_board=$work/-Os/$1/$2.txt
    semihosted "$1" "${on_board%.txt}.elf" > "$on_board" || { grep -v ': [0-9a-f]*$' "$on_board"; exit 1; }
    python3 - "$on_board" "$work/-Os/$4.txt" "$3" "$5" << 'END'
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

# rows BOARD PROGRAM PC_PROGRAM COUNT: the lines of bytes are those of this machine
rows() {
    local on_board=$work/-Os/$1/$2.txt
    semihosted "$1" "${on_board%.txt}.elf" > "$on_board" || { cut -c1-200 "$on_board"; exit 1; }
    [ "$(grep -c ': [0-9a-f]\{200,\}$' "$on_board")" = "$4" ]
    cmp <(grep ': [0-9a-f]\{200,\}$' "$on_board") <(grep ': [0-9a-f]\{200,\}$' "$work/-Os/$3.txt")
    echo "$2, $1: $4 lines, the bytes of this machine"
}

# stack_and_time BOARD PROGRAM MOST TICK_NS: MOST is the limit that the header states for apply
stack_and_time() {
    local text=$work/-Os/$1/$2.txt
    while read -r what _ bytes; do
        echo "$2, $1: $what stack $bytes bytes"
        [ "$what" = apply: ] && limit=$(($3 + 256)) || limit=2048 # 256: the demonstration's own stack
        [ "$bytes" -gt 64 ] && [ "$bytes" -le $limit ] || { echo "more than $limit"; exit 1; }
    done < <(grep -a "stack" "$text")
    for ticks in $(sed -n 's/^apply: ticks //p' "$text"); do
        echo "$2, $1: $((ticks * $4 / (160 * 16))) instructions per pixel (RGB, 8 bit)"
        [ "$ticks" -gt 1000 ]
    done
}

# size BOARD OPT PROGRAM CODE_CEILING RAM_CEILING: bytes of flash, plan and stack
size() {
    local program=$work/$2/$1/$3
    arm-none-eabi-size "$program.elf"
    semihosted "$1" "$program.elf" > "$program.txt"
    python3 "$source_dir/tests/firmware/map_sizes.py" "$program.map" "$program.txt" "$4" "$5" "$1 $2 $3"
}

build -Os pc microbit
for board in mps2-an386 mps2-an500 microbit; do build -Os all $board; done
for board in mps2-an386 mps2-an500; do
    same $board correct_float table correct_float 0
    same $board correct_float gamma correct_float 20 # pow() from another C library
    stack_and_time $board correct_float 2560 40
    size $board -Os correct_float 24576 8192
done
same microbit correct_fixed fixed correct_fixed 0
same microbit correct_fixed_here fixed correct_fixed 20 # the board's own logarithms may differ in the last bits
for program in correct_fixed correct_fixed_here; do stack_and_time microbit $program 512 16; done
size microbit -Os correct_fixed 8192 1024
size microbit -Os correct_fixed_here 28672 4096 # with software floating point, to prepare the plan
for board in mps2-an386 mps2-an500 microbit; do
    rows $board correct_sensor correct_sensor 16
    rows $board capture_flat capture_flat 2
    size $board -Os correct_sensor 4096 1024
done
rows mps2-an386 correct_sensor_here correct_sensor 16 # the plan made from the blob, on the board
rows mps2-an500 correct_sensor_here correct_sensor 16
build -O2 all mps2-an386
size mps2-an386 -O2 correct_float 28672 8192 # optimised for speed
