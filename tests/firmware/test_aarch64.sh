#!/bin/bash
# The core on a 64-bit ARM: the NEON kernel gives the same bytes as the scalar one, and all results of apply.h,
# fixed.h, packed.h and sensor.h are the same as here.
# usage: test_aarch64.sh SOURCE_DIR WORK_DIR
set -euo pipefail
source_dir=$1 work=$2 cc=aarch64-linux-gnu-gcc
. "$source_dir/tests/firmware/need.sh"
need $cc qemu-aarch64
cd "$source_dir"
mkdir -p "$work"
flags=(-std=gnu11 -O2 -Wall -Wextra -Werror -ffp-contract=off -Iinclude -Isrc -Itests -Itests/firmware/shim)
rm -f "$work"/*.o
for source in src/core/*.c src/core/kernels/{best,row_scalar,row_neon}.c; do
    $cc "${flags[@]}" -DLENSPROF_KERNELS -c "$source" -o "$work/$(basename "$source" .c).o"
done
aarch64-linux-gnu-objdump -d "$work/row_neon.o" | grep -c 'v[0-9]*\.4s' | sed 's/$/ instructions on four lanes/'
# Every instruction is interpreted, so only a third of the kernels' rows is tested, or all of them if LENSPROF_PERCENT
# is 100.
export LENSPROF_PERCENT="${LENSPROF_PERCENT:-33}"
for test in test_kernels test_apply test_fixed test_fixed_wide test_packed test_sensor; do
    $cc "${flags[@]}" -static "tests/unit/$test.c" "$work"/*.o -lm -o "$work/$test"
    qemu-aarch64 "$work/$test"
done
