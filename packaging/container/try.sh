#!/bin/bash
# The steps of the Containerfile in two minimal systems of Debian 12, for machines without registries; then the command
# is run as the container would. Needs mmdebstrap and root. Exit 77: Debian is not served here.
set -eu -o pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$root/build/container
rm -rf "$work"
mkdir -p "$work"
trap 'rm -rf "$work/build" "$work/run"' EXIT
command -v mmdebstrap >/dev/null || { echo "try.sh: mmdebstrap is not installed (packages-deb.txt)" >&2; exit 77; }
for name in build run; do
    mmdebstrap --quiet --variant=minbase --mode=root bookworm "$work/$name" >"$work/$name.log" 2>&1 ||
        { echo "try.sh: Debian 12 is not served here" >&2; exit 77; }
done
inside() { local tree=$work/$1; shift; chroot "$tree" /usr/bin/env -i PATH=/opt/lensprof/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"; }
mkdir "$work/build/source"
git -C "$root" archive HEAD | tar -C "$work/build/source" -x
begun=$SECONDS
inside build /source/packaging/container/build.sh /source /opt/lensprof
echo "first stage: $((SECONDS - begun)) s"
cp -r "$work/build/opt/lensprof" "$work/run/opt"
before=$(du -sm "$work/run" | cut -f1)
inside run /opt/lensprof/setup.sh
echo "second stage: $(du -sm "$work/run" | cut -f1) MB, $(($(du -sm "$work/run" | cut -f1) - before)) of them the libraries it needs"
inside run su lensprof -s /bin/sh -c '
    export PATH=/opt/lensprof/bin:/usr/bin:/bin LANG=C.UTF-8
    cd && lensprof --version && lensprof simulate -o pictures --size 320x240 >/dev/null &&
    lensprof calibrate pictures -o calibrated --db lenses.db && lensprof query --lens "Canon EF 24-70mm f/2.8L USM" --focal 40 --aperture 3.2'
echo "tried in $((SECONDS - begun)) s"
