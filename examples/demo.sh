#!/usr/bin/env bash
# The whole job: overlapping pictures in; corrected copies, a stored profile of the lens and a page about both out.
#
#   examples/demo.sh            on six pictures that `lensprof simulate` renders
#   examples/demo.sh FOLDER     on pictures of yours, which are only read
set -euo pipefail
pictures=${1:+$(realpath "$1")}
cd "$(dirname "$0")/.."
lensprof=${LENSPROF:-$PWD/build/lensprof} # the program
work=$(dirname "$lensprof")/demo

run() { printf '$ lensprof'; printf ' %q' "$@"; printf '\n'; "$lensprof" "$@"; }

rm -rf "$work"
mkdir -p "$work"
if [[ -z $pictures ]]; then
    pictures=$work/pictures
    run simulate -o "$pictures" --set mean-ev=-0.8 --format jpeg --size 1200x800
fi
run calibrate "$pictures" -o "$work/corrected" --db "$work/lenses.db" --report "$work/report.html"
printf '\nOpen %s in a browser: the pictures before and after, and the lens.\n' "$work/report.html"
