#!/bin/bash
# Memory of a camera that the apply path takes, from the linker's map, compared with its ceilings.
# usage: test_size.sh SOURCE_DIR WORK_DIR C_COMPILER
set -euo pipefail
source_dir=$1 work=$2
. "$source_dir/tests/firmware/need.sh"
need arm-none-eabi-gcc arm-none-eabi-size qemu-system-arm make python3
mkdir -p "$work"
# measure BOARD OPT PROGRAM CODE_CEILING RAM_CEILING: bytes of flash, plan and stack
measure() {
    local out=$work/$1$2
    mkdir -p "$out"
    make -s -C "$source_dir/examples/firmware" "OUT=$out" "CC=$cc" "BOARD=$1" "OPT=$2" all > "$out/log" 2>&1 || { head "$out/log"; exit 1; }
    arm-none-eabi-size "$out/$1/$3.elf"
    semihosted "$1" "$out/$1/$3.elf" > "$out/$3.txt"
    python3 "$source_dir/tests/firmware/map_sizes.py" "$out/$1/$3.map" "$out/$3.txt" "$4" "$5" "$1 $2 $3"
}
cc=$3
measure mps2-an386 -Os correct_float 24576 8192
measure mps2-an500 -Os correct_float 24576 8192
measure mps2-an386 -O2 correct_float 28672 8192 # optimised for speed
measure microbit -Os correct_fixed 8192 1024
measure microbit -Os correct_fixed_here 28672 4096 # with software floating point, to prepare the plan
