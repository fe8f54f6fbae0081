#!/bin/bash
# The Debian packages, from what is committed: build/deb/*.deb, their sources, and what lintian reports.
#
#   packaging/debian/build.sh           builds in build/deb/lensprof-VERSION
#   packaging/debian/build.sh --try     installs them in a minimal Debian 12, runs debian/tests there, removes them (needs root)
#
# Needs the packages of packages.txt and packages-deb.txt. Exit 77: Debian is not served here.
set -eu -o pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$root/build/deb
version=$(sed -n 's/^#define LENSPROF_VERSION_[A-Z]* \([0-9]*\)$/\1/p' "$root/include/lensprof/base.h" | paste -sd.)
stated=$(sed -n '1s/^lensprof (\(.*\)-.*/\1/p' "$root/packaging/debian/changelog")
[ "$version" = "$stated" ] || { echo "build.sh: debian/changelog is of $stated, the library of $version; add an entry" >&2; exit 1; }

make_packages() {
    local tree=$build/lensprof-$version begun=$SECONDS
    rm -rf "$build"/lensprof* "$build"/*.deb
    mkdir -p "$build"
    git -C "$root" archive --format=tar --prefix="lensprof-$version/" HEAD | xz -T0 -1 >"$build/lensprof_$version.orig.tar.xz"
    tar -C "$build" -xf "$build/lensprof_$version.orig.tar.xz"
    cp -r "$tree/packaging/debian" "$tree/debian"
    rm "$tree/debian/build.sh"
    (cd "$tree" && DEB_BUILD_OPTIONS="noautodbgsym parallel=$(nproc)" dpkg-buildpackage --no-sign >"$build/build.log" 2>&1) ||
        { tail -30 "$build/build.log"; echo "build.sh: the packages cannot be built; read $build/build.log" >&2; exit 1; }
    rm -rf "$tree"
    ls -l "$build"/*.deb | awk '{sub(".*/", "", $9); printf "%s %.2f MB\n", $9, $5 / 1e6}'
    echo "built in $((SECONDS - begun)) s"
    lintian --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs,unreleased-changes "$build"/*.changes &&
        echo "lintian: no error, no warning"
}

# inside COMMAND...: in the minimal system, without the variables of this one.
inside() { chroot "$build/tree" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

try_packages() {
    ls "$build"/lensprof_"$version"*.deb >/dev/null 2>&1 || { echo "build.sh: there are no packages; run it without --try first" >&2; exit 1; }
    if [ ! -e "$build/minimal.tar" ]; then
        mmdebstrap --quiet --format=tar --variant=minbase --mode=root bookworm "$build/minimal.tar.part" ||
            { echo "build.sh: Debian 12 is not served here" >&2; exit 77; }
        mv "$build/minimal.tar.part" "$build/minimal.tar"
    fi
    rm -rf "$build/tree"
    mkdir "$build/tree"
    tar -C "$build/tree" -xf "$build/minimal.tar"
    mkdir "$build/tree/work"
    cp "$build"/*.deb "$build/tree/work"
    tar -C "$build/tree/work" -xf "$build/lensprof_$version.orig.tar.xz"
    inside apt-get -qq update
    local begun=$SECONDS
    inside sh -ec 'cd /work && apt-get -qq install -y ./*.deb >install.txt 2>&1 || { tail -20 install.txt; exit 1; }'
    echo "installed with all they need in $((SECONDS - begun)) s"
    inside apt-get -qq install -y gcc libc6-dev pkg-config >/dev/null 2>&1
    for test in $(sed -n 's/^Tests: //p' "$root/packaging/debian/tests/control"); do
        echo "- $test"
        inside sh -ec "cd /work/lensprof-$version && packaging/debian/tests/$test"
    done
    inside sh -ec 'dpkg --purge lensprof lensprof-data python3-lensprof liblensprof-dev liblensprof-photo0.3 liblensprof0.3 >/dev/null 2>&1'
    local left
    left=$(inside sh -c 'find / -xdev -iname "*lensprof*" -not -path "/work*" -not -path "/proc*" -not -path "/tmp*"')
    [ -z "$left" ] || { echo "build.sh: left after the removal: $left" >&2; exit 1; }
    echo "removed without a rest; tried in $((SECONDS - begun)) s"
    rm -rf "$build/tree"
}

case ${1-} in
"") make_packages ;;
--try) try_packages ;;
*) echo "build.sh: $1: is not an option; use --try, or nothing" >&2; exit 1 ;;
esac
