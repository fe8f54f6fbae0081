#!/bin/bash
# The benchmark of lensprof.fleet (fleet.py) with the build's library and Dask of PyPI, in build/fleet. The table goes to
# standard output and build/bench/fleet.md.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
python=$("$root/tests/python/fleet.sh" --python)
mkdir -p "$root/build/bench"
LENSPROF_LIBRARY=$root/build/liblensprof.so PYTHONPATH=$root/bindings/python "$python" -B "$root/tests/bench/fleet.py" \
    "$root/build/lensprof" "$root/build/bench/fleet.md"
