#!/bin/bash
# The benchmark: accuracy, speed and robustness of build/lensprof compared with Hugin's vig_optimize.
# Markdown tables go to standard output and build/bench/benchmarks.md, all figures to build/bench/results.json.
#
#   tests/bench/run.sh [--quick] [--real DIR] [--only PARTS] [--match TEXT] [--repeat N] [--jobs N] [--keep]
#                      [--sequences N] [--tune]
#                      PARTS, separated by commas: points, pictures, refusals, verdicts, flat, cards, forms (shading
#                      tables of libcamera-ipa and DIR/shading, projects of DIR/overlaps), trials, static, sweep, timelapse,
#                      video (over the photographs DIR/src_pano/*.jpg, else painted scenes), scale, speed, radiance, knowledge, photographs (also of --real DIR), frames-registration,
#                      reconstruction (with colmap; also DIR/reconstruction), real (pano.pto and hugin.pto below DIR,
#                      and folders of DIR/brackets)
#   tests/bench/run.sh --only reconstruction --match terrain,drone   only these sets: terrain, room, drone, and with
#                      --real DIR the folders of DIR/reconstruction; existing database.db and sparse are used
#   tests/bench/run.sh --only verdicts --match "smooth 17"   one rendered sequence again, or all of a kind; --keep keeps
#                      its pictures in build/bench/verdicts
#   tests/bench/run.sh --only cards --tune --match dusty   likewise rendered cards, pictures in build/bench/cards
#   tests/bench/run.sh --only trials --tune --match "fitted 17"   likewise sequences to check profiles against
#   tests/bench/run.sh --self-test      tests the scorer and the references; needs no program; exit 77: NumPy is missing
#   tests/bench/run.sh --lookup [DIR]   lookups between stored settings compared with Lensfun's rule, also written to
#                                       build/bench/lookup.md; exit 1: target missed; 77: no NumPy or Lensfun data
#
# LENSPROF=program measures another program instead of build/lensprof.
set -eu -o pipefail
folder=$(cd "$(dirname "$0")" && pwd)
for python in /usr/bin/python3 python3 ""; do
    [ -n "$python" ] && "$python" -c 'import sys, numpy; sys.exit(sys.version_info < (3, 9))' 2>/dev/null && break
done
if [ -z "$python" ]; then
    echo "run.sh: skipped: needs Python 3.9 with NumPy; install python3-numpy (make test-deps)" >&2
    case "${1:-}" in --self-test | --lookup) exit 77 ;; esac
    exit 1
fi
[ "${1:-}" = --self-test ] && exec "$python" -B -m unittest discover -q -s "$folder"
if [ "${1:-}" = --lookup ]; then
    shift
    mkdir -p "$folder/../../build/bench"
    "$python" -B "$folder/lookup.py" "$@" | tee "$folder/../../build/bench/lookup.md"
    exit 0
fi
exec "$python" -B "$folder/bench.py" "$@"
