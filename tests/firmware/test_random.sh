#!/bin/bash
# Random profiles, prepared here and applied in integers on a Cortex-M0, M4 and M7, compared with double precision; and
# rows of random sensors, which have the bytes of this machine.
# usage: test_random.sh SOURCE_DIR WORK_DIR MAKE_CASES
set -euo pipefail
source_dir=$1 work=$2 tests=$1/tests/firmware
. "$tests/need.sh"
need arm-none-eabi-gcc qemu-system-arm make
mkdir -p "$work"
"$3" > "$work/cases.c"
# Nothing is left out of the core.
for board in microbit mps2-an386 mps2-an500; do
    make -s -C "$source_dir/examples/firmware" "OUT=$work" BOARD=$board LEFT_OUT= own PROGRAM=check_cases \
        OWN_FLAGS="-I$tests" SOURCES="$tests/check_cases.c $work/cases.c"
    semihosted $board "$work/$board/check_cases.elf" | sed "s/^/$board: /"
done
