#!/bin/bash
# The page in a browser without a window: run.sh PAGE LENSPROF. Exit code 77: Chromium, Node or npm is missing.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
PAGE=$(realpath "$1") LENSPROF=$(realpath "$2")
for program in chromium node npm; do
    command -v $program >/dev/null || { echo "skipped: there is no $program"; exit 77; }
done
CHROMIUM=$(command -v chromium)
export PAGE LENSPROF CHROMIUM
work=$(dirname "$PAGE")/browser
mkdir -p "$work"
cp "$here"/*.mjs "$here"/*.json "$work"
cd "$work"
npm ci --no-audit --no-fund --silent
node --test --test-reporter=spec test_*.mjs
