#!/bin/bash
# The benchmark of the frei0r plug-in (frei0r.py) with the library of build/ and the installed Lensfun. The table goes to
# standard output and build/bench/frei0r.md.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
for tool in ffmpeg pkg-config; do
    command -v $tool >/dev/null || { echo "frei0r.sh: $tool is missing; make bench-frei0r installs it" >&2; exit 1; }
done
[ -e build/frei0r-1/lensprof.so ] || { echo "frei0r.sh: the plug-in is not built; install frei0r-plugins-dev and build again" >&2; exit 1; }
mkdir -p build/bench
# shellcheck disable=SC2046 # the flags are words
${CXX:-g++} -std=c++17 -O3 -march=native -o build/bench/lensfun_frames tests/bench/lensfun_frames.cpp \
    $(pkg-config --cflags --libs lensfun)
LENSPROF_LIBRARY=$root/build/liblensprof.so PYTHONPATH=$root/bindings/python "${PYTHON:-/usr/bin/python3}" -B tests/bench/frei0r.py \
    build/frei0r-1/lensprof.so build/bench/lensfun_frames "$root/build/bench/frei0r.md"
