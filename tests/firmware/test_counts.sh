#!/bin/bash
# Instructions per sample of a 12 megapixel row, counted in an emulator on a Cortex-M4, M7 and A53: the grid of gains
# takes at most half of those of a plain loop. Prints the table of docs/firmware.md.
# usage: test_counts.sh SOURCE_DIR WORK_DIR MAKE_COUNTS
set -euo pipefail
source_dir=$1 work=$2 tests=$1/tests/firmware
. "$tests/need.sh"
need arm-none-eabi-gcc qemu-system-arm qemu-system-aarch64 aarch64-linux-gnu-gcc make
mkdir -p "$work"
"$3" > "$work/counts.c"

# report NAME OUTPUT: a line of the table; fails if the grid is not worth its code
report() {
    awk -v name="$1" '{ of[$1] = $2 }
        END {
            printf "| %s | %.1f | %.1f | %.1f | %.1f | %.1f |\n", name, of["copy"] / 100, of["plain"] / 100, of["sensor"] / 100, of["packed"] / 100, of["fixed"] / 100
            exit !(of["sensor"] > 500 && 2 * of["sensor"] < of["plain"] && of["fixed"] > of["sensor"])
        }' "$2"
}

echo "| per sample | copy | plain loop | grid | grid, RAW10 | polynomial |"
for board in mps2-an386 mps2-an500; do
    make -s -C "$source_dir/examples/firmware" "OUT=$work" OPT=-O2 LEFT_OUT= "BOARD=$board" own PROGRAM=count_samples \
        "OWN_FLAGS=-I$tests" "SOURCES=$tests/count_samples.c $work/counts.c"
    semihosted $board "$work/$board/count_samples.elf" > "$work/$board.txt"
    report "$board" "$work/$board.txt"
done
core=("$source_dir"/src/core/{blob,fixed,fixed_open,fixed_packed,fixed_table,image,levels,packed,sensor,sensor_open,sensor_packed}.c)
aarch64-linux-gnu-gcc -std=c11 -O2 -mcpu=cortex-a53 -ffreestanding -ffp-contract=off -ffunction-sections -fno-pic -nostdlib \
    -static -Wl,--gc-sections -Wl,--build-id=none -Wl,--no-warn-rwx-segments -T "$tests/a53.ld" -DNS_PER_TICK=16 \
    "-I$source_dir/include" "-I$source_dir/src" "-I$source_dir/examples/firmware" "-I$tests" \
    "$tests"/{a53,count_samples}.c "$work/counts.c" "${core[@]}" -o "$work/a53.elf"
timeout 120 qemu-system-aarch64 -M virt -nic none -cpu cortex-a53 -display none -monitor none -serial none -chardev stdio,id=out \
    -icount shift=0 -semihosting-config enable=on,target=native,chardev=out -kernel "$work/a53.elf" > "$work/a53.txt"
report cortex-a53 "$work/a53.txt"
