#!/bin/bash
# Builds and runs the benchmark of a camera that runs (online.cpp) with the library of build/. The tables go to standard
# output and build/bench/online.md.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
mkdir -p build/bench
${CXX:-g++} -std=c++17 -O2 -Iinclude -o build/bench/online tests/bench/online.cpp -Lbuild -llensprof -Wl,-rpath,"$root/build"
build/bench/online "${1:-200}" | tee build/bench/online.md
