#!/bin/bash
# The tests of lensprof.fleet with Dask, fsspec and pyarrow from PyPI, in build/fleet; `make platforms`.
# --python: names the Python that has them instead.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
python=$root/build/fleet/bin/python
[ -x "$python" ] || python3 -m venv "$root/build/fleet"
"$python" -m pip install --quiet --disable-pip-version-check "dask[distributed]>=2023.1" "fsspec>=2023.1" "pyarrow>=10" numpy
[ "${1-}" != --python ] || { echo "$python"; exit; }
cd "$root/tests/python"
LENSPROF_LIBRARY=$root/build/liblensprof.so LENSPROF_PROGRAM=$root/build/lensprof PYTHONPATH=$root/bindings/python \
    PYTHONDONTWRITEBYTECODE=1 "$python" -m unittest test_fleet
