#!/bin/bash
# Builds and runs the benchmark of apply (apply.cpp) with the library of build/ and the installed Lensfun and OpenCV.
# The table goes to standard output and build/bench/apply.md.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
opencv=/usr/include/opencv4 # part of libopencv-core-dev, which has no pkg-config file
pkg-config --exists opencv4 && opencv=$(pkg-config --variable=includedir opencv4)
pkg-config --exists lensfun || { echo "apply.sh: lensfun is missing; make bench-apply installs it" >&2; exit 1; }
[ -e "$opencv/opencv2/core.hpp" ] || { echo "apply.sh: opencv4 is missing; make bench-apply installs it" >&2; exit 1; }
mkdir -p build/bench
${CXX:-g++} -std=c++17 -O3 -march=native -o build/bench/apply tests/bench/apply.cpp -Iinclude \
    $(pkg-config --cflags --libs lensfun) -I"$opencv" -lopencv_core \
    -Lbuild -llensprof -Wl,-rpath,"$root/build"
build/bench/apply | tee build/bench/apply.md
