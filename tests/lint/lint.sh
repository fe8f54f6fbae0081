#!/usr/bin/env bash
# lint.sh BUILD_DIR: formatting, warnings of clang, cppcheck and clang-tidy over all sources (`make lint`). Continues
# after a finding; exit 1 if there was any. BUILD_DIR has a compile_commands.json of single sources (-DLENSPROF_JOIN=OFF).
# CLANG_TIDY_FILES=pattern: only these for clang-tidy.
set -uo pipefail
cd "$(dirname "$0")/../.."
build=$1
code=0
step() {
    printf '== %s\n' "$1"
    shift
    "$@" || code=1
}

checked() {
    local common=(--quiet --enable=warning,performance,portability --inline-suppr --error-exitcode=1
                  --suppressions-list=tests/lint/cppcheck.txt -Iinclude -Isrc)
    local failed=0
    cppcheck "${common[@]}" --std=c11 --language=c src/core src/store || failed=1
    cppcheck "${common[@]}" --std=c++17 --language=c++ src/falloff src/fit src/formats src/photo src/cli || failed=1
    return $failed
}

# The commands of the build without options that only GCC knows; each file separately, on all cores.
compiled() { python3 -B tests/lint/each_source.py "$build" clang; }
tidy() { python3 -B tests/lint/each_source.py "$build" clang-tidy "${CLANG_TIDY_FILES:-}"; }

step "clang-format: one style" tests/lint/format.sh
step "cppcheck" checked
step "clang: warnings are errors" compiled
step "clang-tidy: .clang-tidy" tidy
exit $code
