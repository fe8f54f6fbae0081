#!/bin/bash
# Builds and runs the benchmark of the store (store.c) with the library of build/, then imports the installed Lensfun
# data.
# The table goes to standard output and build/bench/store.md.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
mkdir -p build/bench
${CC:-gcc} -std=gnu11 -O2 -o build/bench/store tests/bench/store.c -Iinclude -Lbuild -llensprof -lm -Wl,-rpath,"$root/build"
{
    build/bench/store build/bench/store.db 100000 5
    build/bench/store build/bench/store.db 100000 20 | tail -1
    if ls /usr/share/lensfun/version_1/*.xml >/dev/null 2>&1; then
        rm -f build/bench/lensfun.db
        start=$(date +%s.%N)
        said=$(build/lensprof profile import --db build/bench/lensfun.db /usr/share/lensfun/version_1/*.xml | head -1)
        printf '\n%s in %.2f s\n' "${said% into *}" "$(awk "BEGIN { print $(date +%s.%N) - $start }")"
    fi
} | tee build/bench/store.md
rm -f build/bench/store.db build/bench/lensfun.db
