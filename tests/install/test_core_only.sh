#!/bin/bash
# The core alone: configures and builds without a C++ compiler and without pkg-config, and a program links with nothing
# else.
# usage: test_core_only.sh SOURCE_DIR C_COMPILER
set -euo pipefail
source_dir=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$source_dir"
export CC=$2 CXX=/bin/false PKG_CONFIG=/bin/false
cmake --preset core-only -B "$work/build" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
archive=$(find "$work/build" -name liblensprof-core.a)
[ -n "$archive" ] || { echo "no liblensprof-core.a"; exit 1; }
if grep CMAKE_CXX_COMPILER: "$work/build/CMakeCache.txt"; then echo "the build looked for a C++ compiler"; exit 1; fi
if find "$work/build" -name '*.so*' -o -name 'lensprof' -type f | grep .; then echo "more than the core was built"; exit 1; fi
"$CC" -std=c99 -I include examples/correct_pixels.c "$archive" -lm -o "$work/correct_pixels"
"$work/correct_pixels" | tee "$work/out"
grep -q "^corrected:   corner 147, middle 147$" "$work/out"

# Installed alone: the package of the core is found, that of the library is not.
prefix=$work/prefix
cmake --install "$work/build" --prefix "$prefix" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
unset CXX
cmake -S tests/install/consumer_core -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" -DEXAMPLES="$PWD/examples" > "$work/log" 2>&1 \
    && cmake --build "$work/consumer" > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/consumer/consumer_core" | grep -q "^corrected:   corner 147, middle 147$"
if cmake -S tests/install/consumer -B "$work/none" -DCMAKE_PREFIX_PATH="$prefix" > "$work/log" 2>&1; then
    echo "found the library in a prefix with only the core"; exit 1
fi
grep -q "component library is not installed" "$work/log" || { cat "$work/log"; exit 1; }
