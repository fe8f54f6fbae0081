#!/bin/bash
# lensprof inside another project, static; then installed from there, and used by find_package. Objects of C++, whose compilation
# takes minutes, are those of BUILD_DIR.
# usage: test_subproject.sh SOURCE_DIR BUILD_DIR C_COMPILER CXX_COMPILER
set -euo pipefail
source_dir=$1 build_dir=$2
export CC=$3 CXX=$4
here=$source_dir/tests/install
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset LD_LIBRARY_PATH CMAKE_PREFIX_PATH DESTDIR
failures=0

wrong() { echo "WRONG: $*"; failures=$((failures + 1)); }
quiet() { "$@" > "$work/log" 2>&1 || { tail -30 "$work/log"; wrong "$*"; return 1; }; }

version=$(sed -n 's/^#define LENSPROF_VERSION_\(MAJOR\|MINOR\|PATCH\) //p' "$source_dir/include/lensprof/base.h" | paste -sd.)
quiet cmake -S "$here/consumer_subproject" -B "$work/build" -DLENSPROF="$source_dir" \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$here/reuse_object.sh;$build_dir;$work/build/lensprof"
quiet cmake --build "$work/build" -j 2
[ "$("$work/build/consumer_c")" = "lensprof $version from C" ] || wrong "consumer_c"
"$work/build/fit_pairs" | grep -q "usable: yes" || wrong "fit_pairs"
"$work/build/consumer_core" | grep -q "^corrected:   corner 147" || wrong "consumer_core"
if ldd "$work/build/consumer_c" | grep liblensprof; then wrong "it is not static"; fi

quiet cmake --install "$work/build" --prefix "$work/prefix"
quiet cmake -S "$here/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$work/prefix"
quiet cmake --build "$work/consumer"
[ "$("$work/consumer/consumer_c")" = "lensprof $version from C" ] || wrong "consumer_c by find_package"
if ldd "$work/consumer/consumer_c" | grep liblensprof; then wrong "find_package does not give the static library"; fi

[ $failures = 0 ] || { echo "$failures failures"; exit 1; }
echo "lensprof inside another project works"
