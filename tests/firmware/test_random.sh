#!/bin/bash
# Random profiles, prepared here and applied in integers on a Cortex-M0, compared with double precision.
# usage: test_random.sh SOURCE_DIR WORK_DIR MAKE_CASES
set -euo pipefail
source_dir=$1 work=$2 tests=$1/tests/firmware
. "$tests/need.sh"
need arm-none-eabi-gcc qemu-system-arm make
mkdir -p "$work"
"$3" > "$work/cases.c"
make -s -C "$source_dir/examples/firmware" "OUT=$work" BOARD=microbit own PROGRAM=check_cases OWN_FLAGS="-I$tests" \
    SOURCES="$tests/check_cases.c $work/cases.c"
semihosted microbit "$work/microbit/check_cases.elf"
