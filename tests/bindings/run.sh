#!/bin/bash
# The bindings of other languages: each builds and runs its example, which must give the bytes, the line and the errors
# that the Python package gives.
# usage: run.sh LIBRARY [LANGUAGE...]     of: cpp go java node rust; default: all
# Exit code 77 if a language was skipped because its tools are missing and no other failed. Node and Java get koffi and
# JNA from their registries; C++, Go and Rust need no network. PYTHON: a python3 with NumPy; CC, CXX: compilers.
set -uo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
library=$(realpath "$1")
shift
languages=("$@")
[ $# -gt 0 ] || languages=(cpp go java node rust)
python=${PYTHON:-python3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C.UTF-8 LENSPROF_LIBRARY=$library LD_LIBRARY_PATH PKG_CONFIG_PATH=$work/pkgconfig
LD_LIBRARY_PATH=$(dirname "$library")
failures=0
language=

wrong() { echo "WRONG: $language: $*"; failures=$((failures + 1)); }
skip() { echo "skipped: $language: there is no $1"; return 77; }
needs() {
    for tool in "$@"; do
        command -v "$tool" >/dev/null || { skip "$tool"; return 77; }
    done
}
# Runs a command; its output is shown only if it fails.
quiet() { "$@" >"$work/log" 2>&1 || { tail -40 "$work/log"; wrong "$*"; return 1; }; }

# Each prepares the tools of a language in $work/LANGUAGE and sets `example`, the command that runs its example, and
# `dump`, one that prints its layout of structures; empty for languages that include the headers.
prepare_cpp() {
    needs "${CXX:-g++}" pkg-config || return
    local standard
    for standard in 17 20; do
        # shellcheck disable=SC2046 # the flags are words
        quiet "${CXX:-g++}" -std=c++$standard -Wall -Wextra -Wpedantic -Werror $(pkg-config --cflags lensprof) \
            "$root/bindings/cpp/correct.cpp" -o "$work/cpp/correct$standard" $(pkg-config --libs lensprof) || return
    done
    example=("$work/cpp/correct17") dump=()
}

prepare_go() {
    needs go "${CC:-cc}" pkg-config || return
    export GOTOOLCHAIN=local GOPROXY=off
    (cd "$work/go" && quiet go vet ./... && quiet go build -o correct ./cmd/correct) || return
    example=("$work/go/correct") dump=()
}

prepare_rust() {
    needs cargo pkg-config || return
    (cd "$work/rust" && quiet cargo build --offline --examples) || return
    example=("$work/rust/target/debug/examples/correct") dump=("$work/rust/target/debug/examples/abi_dump")
}

prepare_node() {
    needs node npm || return
    (cd "$work/node" && quiet npm install --no-audit --no-fund) || return
    example=(node "$work/node/examples/correct.js") dump=(node "$work/node/examples/abi_dump.js")
}

prepare_java() {
    needs java javac mvn || return
    (cd "$work/java" && quiet mvn -q -B compile dependency:build-classpath -Dmdep.outputFile=classpath) || return
    local classes
    classes=$work/java/target/classes:$(cat "$work/java/classpath")
    example=(java -cp "$classes" lensprof.examples.Correct) dump=(java -cp "$classes" lensprof.examples.AbiDump)
}

# refused PATTERN ARGUMENT...: the example ends with code 1 and one line that matches.
refused() {
    local pattern=$1 code=0
    shift
    "${example[@]}" "$@" <"$work/tile.rgb" >"$work/output" 2>"$work/errors" || code=$?
    [ $code = 1 ] || wrong "$*: exit code $code"
    [ -s "$work/output" ] && wrong "$*: prints output"
    if [ "$(wc -l <"$work/errors")" != 1 ] || ! grep -Eq -- "$pattern" "$work/errors"; then
        wrong "$*: no line matches $pattern: $(cat "$work/errors")"
    fi
}

check_results() {
    "${example[@]}" tile "$work/profile.blob" 64 48 5 3 40 30 <"$work/tile.rgb" >"$work/output" ||
        wrong "tile: exit code $?"
    cmp "$work/output" "$work/corrected.rgb" || wrong "the corrected bytes differ"
    "${example[@]}" frame "$work/profile.blob" 64 48 <"$work/frame.rgb16" >"$work/output" ||
        wrong "frame: exit code $?"
    cmp "$work/output" "$work/corrected.rgb16" || wrong "the corrected bytes of 16 bit differ"
    "${example[@]}" repack "$work/profile.blob" >"$work/output" || wrong "repack: exit code $?"
    cmp "$work/output" "$work/profile.blob" || wrong "unpacked and packed, the blob differs"
    "${example[@]}" lookup "$database" Acme "Ä 1" "$lens" 50 2.8 >"$work/output" || wrong "lookup: exit code $?"
    diff "$work/output" "$work/lookup.txt" || wrong "the answer of the lookup differs"
}

check_errors() {
    local tile=(64 48 5 3 40 30)
    refused "newer lensprof; update .*LENSPROF_ERROR_LAYOUT" tile "$work/newer.blob" "${tile[@]}"
    refused "damaged; export it again .LENSPROF_ERROR_CORRUPT" tile "$work/truncated.blob" "${tile[@]}"
    refused "of 0 bytes: not a blob.*LENSPROF_ERROR_CORRUPT" tile "$work/empty.blob" "${tile[@]}"
    refused "newer lensprof; update .*LENSPROF_ERROR_LAYOUT" repack "$work/newer.blob"
    refused "of 0 bytes: not a blob.*LENSPROF_ERROR_CORRUPT" repack "$work/empty.blob"
    refused "must fit the frame.*LENSPROF_ERROR_SIZE" tile "$work/profile.blob" 64 48 30 3 40 30
    refused "must fit the frame.*LENSPROF_ERROR_SIZE" tile "$work/profile.blob" 64 48 5 3 40 31
    refused "nowhere ß.db: no such file.*LENSPROF_ERROR_NOT_FOUND" \
        lookup "$work/nowhere ß.db" Acme "Ä 1" "$lens" 50 2.8
    refused "LENSPROF_ERROR_NOT_FOUND" lookup "$database" Acme "Ä 1" "Another 35mm" 35 2.8
    refused "more than 127 bytes.*LENSPROF_ERROR_ARGUMENT" lookup "$database" Acme "Ä 1" "$(printf '%0200d' 0)" 50 2.8
}

# Handles that a program closes itself: twice does no harm, and later calls are refused. C++ and Rust have no such state.
check_closed() {
    case $language in
    go | node | java) refused "is closed; open it again .LENSPROF_ERROR_ARGUMENT" closed "$database" ;;
    esac
}

# A library of another minor version: named by the environment, or loaded before the real one. C++ and Go are compiled
# with the headers of the library that they link, whose name has the version.
check_version() {
    local pattern="is lensprof 0.99.0, but .* is for 0"
    case $language in
    node | java) LENSPROF_LIBRARY=$work/other.so refused "$pattern" lookup "$database" a b c 1 1 ;;
    rust) LD_PRELOAD=$work/other.so refused "$pattern" lookup "$database" a b c 1 1 ;;
    esac
}

# Without LENSPROF_LIBRARY, what loads the library itself finds it as the system does.
check_loader() {
    case $language in
    node | java)
        LENSPROF_LIBRARY="" "${example[@]}" lookup "$database" Acme "Ä 1" "$lens" 50 2.8 >"$work/output" ||
            wrong "lookup without LENSPROF_LIBRARY: exit code $?"
        diff "$work/output" "$work/lookup.txt" || wrong "the answer without LENSPROF_LIBRARY differs"
        LENSPROF_LIBRARY=$work/nowhere.so refused "nowhere.so: .*cannot be loaded" lookup "$database" a b c 1 1
        ;;
    esac
}

# The tables have the layout that the C compiler has: size and alignment of structures, offsets of their members.
check_layout() {
    [ ${#dump[@]} -gt 0 ] || return 0
    "${dump[@]}" >"$work/layout" || wrong "its layout: exit code $?"
    [ -s "$work/layout" ] || wrong "prints no layout"
    diff <(LC_ALL=C sort "$work/layout") "$work/layout.c" >"$work/log" ||
        { head -20 "$work/log"; wrong "the layout differs from that of C"; }
}

# The layout of all structures but those of photo.h, which the bindings leave out.
make_layout() {
    "${CC:-cc}" -std=c11 -I"$root/include" "$root/tests/python/abi_dump.c" -o "$work/abi_dump" || return
    echo '#include <lensprof/photo.h>' | "${CC:-cc}" -E -I"$root/include" - |
        awk '/^# [0-9]+ "/ {photo = /photo\.h/} photo' |
        sed -n 's/^} \(lensprof_[a-z0-9_]*\);/\1/p' >"$work/photo"
    "$work/abi_dump" | grep -vwFf "$work/photo" |
        awk '$1 == "struct" {print} $1 == "field" {print $1, $2, $3, $4}' | LC_ALL=C sort >"$work/layout.c"
}

make_inputs() {
    local folder
    folder=$(dirname "$library")
    mkdir -p "$work/pkgconfig"
    printf '%s\n' "Name: lensprof" "Description: of the source tree" "Version: 0" "libdir=$folder" \
        "Cflags: -I$root/include" "Libs: -L$folder -llensprof" >"$work/pkgconfig/lensprof.pc"
    PYTHONPATH=$root/bindings/python "$python" -B "$root/tests/bindings/inputs.py" "$work" || return
    database=$(echo "$work"/*.db)
    lens=$(cut -d, -f1 "$work/lookup.txt")
    make_layout || return
    echo 'const char *lensprof_version(void) { return "0.99.0"; }' >"$work/other.c"
    "${CC:-cc}" -shared -fPIC "$work/other.c" -o "$work/other.so"
}

"$python" -c 'import numpy' 2>/dev/null || { echo "skipped: there is no python3 with numpy"; exit 77; }
make_inputs || { echo "WRONG: no inputs"; exit 1; }
skipped=0
for language in "${languages[@]}"; do
    [ -d "$root/bindings/$language" ] || { echo "unknown language $language"; exit 2; }
    cp -r "$root/bindings/$language" "$work/$language"
    before=$failures
    "prepare_$language"
    case $? in
    0) ;;
    77) skipped=$((skipped + 1)); continue ;;
    *) [ $failures -gt "$before" ] || wrong "cannot be built"; continue ;;
    esac
    check_results
    [ "$language" != cpp ] || { example=("$work/cpp/correct20") && check_results; }
    check_errors
    check_closed
    check_version
    check_loader
    check_layout
    [ $failures -gt "$before" ] || echo "$language: bytes, lookup and errors are those of the library"
done
[ $failures = 0 ] || { echo "$failures failures"; exit 1; }
[ $skipped = 0 ] || exit 77
