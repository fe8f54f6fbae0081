#!/bin/bash
# The benchmark: accuracy, speed and robustness of build/lensprof beside Hugin's vig_optimize.
# Tables in Markdown go to standard output and build/bench/benchmarks.md, every figure to build/bench/results.json.
#
#   tests/bench/run.sh [--quick] [--real DIR] [--only PARTS] [--match TEXT] [--repeat N] [--jobs N] [--keep]
#                      PARTS, with commas: points, pictures, refusals, flat, static, scale, speed, radiance, real
#   tests/bench/run.sh --self-test      the scorer against known errors; needs no program; exit 77: NumPy is missing
#
# LENSPROF=program measures another program than build/lensprof.
set -eu
folder=$(cd "$(dirname "$0")" && pwd)
for python in /usr/bin/python3 python3 ""; do
    [ -n "$python" ] && "$python" -c 'import sys, numpy; sys.exit(sys.version_info < (3, 9))' 2>/dev/null && break
done
if [ -z "$python" ]; then
    echo "run.sh: skipped: needs Python 3.9 with NumPy; install python3-numpy (make test-deps)" >&2
    [ "${1:-}" = --self-test ] && exit 77
    exit 1
fi
[ "${1:-}" = --self-test ] && exec "$python" -B "$folder/test_scorer.py"
exec "$python" -B "$folder/bench.py" "$@"
