#!/bin/bash
# Compiler launcher for a second build of the same sources. If the first build has the object, the source is preprocessed, which
# shows that its headers are found, and the object is copied; otherwise it is compiled.
# usage: reuse_object.sh FIRST_BUILD SECOND_BUILD COMPILER ARGUMENT...
set -euo pipefail
first=$1 second=$2
shift 2
object=
previous=
for argument; do
    if [ "$previous" = -o ]; then object=$argument; fi
    previous=$argument
done
known=$first/$(realpath -m --relative-to="$second" "$object")
case $object in
*.o) [ -f "$known" ] || exec "$@" ;;
*) exec "$@" ;;
esac
"$@" -E
cp "$known" "$object"
