#!/bin/bash
# The core for a Cortex-M: no promotion to double in pixel code, only the listed functions, stack within the limits of
# apply.h and fixed.h.
# usage: test_objects.sh SOURCE_DIR WORK_DIR
set -euo pipefail
source_dir=$1 work=$2
. "$source_dir/tests/firmware/need.sh"
need arm-none-eabi-gcc arm-none-eabi-nm arm-none-eabi-size python3
cd "$source_dir"

# objects NAME FLAGS...: the core's objects and call graphs
objects() {
    local out=$work/$1
    shift
    rm -rf "$out" && mkdir -p "$out"
    for source in src/core/*.c src/core/kernels/best.c src/core/kernels/row_scalar.c; do
        arm-none-eabi-gcc -std=c11 -mthumb "$@" -ffp-contract=off -ffreestanding -Wall -Wextra -Werror -Iinclude -Isrc \
            -fcallgraph-info=su -c "$source" -o "$out/$(basename "$source" .c).o"
    done
    for pixels in kernels/row_scalar fixed packed apply_packed fixed_packed sensor sensor_packed; do
        arm-none-eabi-gcc -std=c11 -mthumb "$@" -ffp-contract=off -Wdouble-promotion -Wfloat-conversion -Werror -Iinclude -Isrc \
            -fsyntax-only "src/core/$pixels.c"
    done
    python3 -B tests/lint/symbol_rules.py --nm arm-none-eabi-nm apply "$out"
}
# code NAME MOST: what packed rows add, with plans of one kind; programs that do not use them have none of it
code() {
    local bytes
    bytes=$(arm-none-eabi-size "$work/$1"/{packed,apply_packed}.o | awk 'NR > 1 { sum += $1 + $2 } END { print sum }')
    echo "packed rows, $1: code $bytes of $2 bytes"
    [ "$bytes" -gt 128 ] && [ "$bytes" -le "$2" ]
}
depth() { python3 -B tests/firmware/stack_depth.py "$@"; }

for options in "m4-Os -Os -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard" \
               "m7-Os -Os -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard" \
               "m4-O2 -O2 -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard" \
               "m7-O2 -O2 -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard"; do
    # shellcheck disable=SC2086
    objects $options
    graphs=("$work/${options%% *}"/*.ci)
    depth 2560 lensprof_apply lp_row_scalar "${graphs[@]}"
    depth 2560 lensprof_apply_planar lp_row_scalar "${graphs[@]}"
    depth 1536 lensprof_plan_init - "${graphs[@]}"
    depth 512 lensprof_fixed_apply - "${graphs[@]}"
    depth 512 lensprof_sensor_apply - "${graphs[@]}"
    depth 2944 lensprof_apply_packed lp_row_scalar,lp_apply_packed=src/core/apply_packed.c:apply_in_place "${graphs[@]}"
done
objects m0 -Os -mcpu=cortex-m0plus
depth 512 lensprof_fixed_apply - "$work/m0"/*.ci
depth 512 lensprof_fixed_plan_open - "$work/m0"/*.ci
depth 1536 lensprof_fixed_plan_init - "$work/m0"/*.ci
depth 512 lensprof_sensor_apply - "$work/m0"/*.ci
depth 512 lensprof_sensor_plan_open - "$work/m0"/*.ci
depth 512 lensprof_sensor_flat_add - "$work/m0"/*.ci
depth 2048 lensprof_sensor_plan_init - "$work/m0"/*.ci
depth 896 lensprof_fixed_apply_packed lp_apply_packed=src/core/fixed_packed.c:apply_in_place "$work/m0"/*.ci
depth 896 lensprof_sensor_apply_packed lp_apply_packed=src/core/sensor_packed.c:apply_in_place "$work/m0"/*.ci
# grid NAME MOST: what a sensor plan made elsewhere adds, without packed rows
grid() {
    local bytes
    bytes=$(arm-none-eabi-size "$work/$1"/{sensor,sensor_open}.o | awk 'NR > 1 { sum += $1 + $2 } END { print sum }')
    echo "grids of gains, $1: code $bytes of $2 bytes"
    [ "$bytes" -gt 128 ] && [ "$bytes" -le "$2" ]
}

grid m4-Os 2048
grid m7-Os 2048
grid m0 2048
code m4-Os 1024
code m7-Os 1024
code m0 1024
