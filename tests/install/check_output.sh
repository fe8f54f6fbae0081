#!/bin/bash
# Runs a program, which must succeed and print a matching line for every pattern.
# usage: check_output.sh PATTERN... -- PROGRAM [ARGUMENT...]     NEW_FILE as an argument: a path that does not exist yet
set -uo pipefail
patterns=()
while [ "$1" != -- ]; do patterns+=("$1"); shift; done
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
output=$("${@/#NEW_FILE/$work/new}")
code=$?
echo "$output"
[ $code = 0 ] || { echo "$1: exit code $code"; exit 1; }
for pattern in "${patterns[@]}"; do
    grep -Eq -- "$pattern" <<< "$output" || { echo "no line matches: $pattern"; exit 1; }
done
