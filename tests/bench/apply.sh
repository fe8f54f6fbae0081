#!/bin/bash
# Builds and runs the benchmark of apply (apply.cpp) with the library of build/ and the installed Lensfun and OpenCV.
# The table goes to standard output and build/bench/apply.md.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
for package in lensfun opencv4; do
    pkg-config --exists "$package" || { echo "apply.sh: $package is missing; make bench-apply installs it" >&2; exit 1; }
done
mkdir -p build/bench
${CXX:-g++} -std=c++17 -O3 -march=native -o build/bench/apply tests/bench/apply.cpp -Iinclude \
    $(pkg-config --cflags --libs lensfun) -I"$(pkg-config --variable=includedir opencv4)" -lopencv_core \
    -Lbuild -llensprof -Wl,-rpath,"$root/build"
build/bench/apply | tee build/bench/apply.md
