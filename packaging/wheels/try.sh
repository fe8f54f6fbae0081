#!/bin/bash
# The wheels of dist/ installed where nothing else is, and run.
#
#   packaging/wheels/try.sh [WHERE...]      without WHERE: all of them
#
#   bullseye, trixie   a minimal Debian 11 (Python 3.9) and 13 of this architecture: pip without an index, the exercise, and the
#                      tests of tests/python that need no picture library
#   arm64              the same exercise in a Debian 12 for arm64, under qemu-user; unit tests
#   musl               unit tests with Debian's musl (Debian has no Python for it: the import is not run)
#   windows            unit tests with Wine (it has no Python: the import is not run)
#
# Unit tests: those of tests/unit and tests/store that use the public functions alone, compiled with cmocka for the system and
# linked with the library of the wheel.
#
# Needs the packages of packages-platforms.txt and root (for chroots). build/wheels/trees keeps the systems for the next run.
# Exit 77: something that is needed is not installed or not served.
set -eu -o pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$root/build/wheels
trees=$build/trees
links=$build/links
mkdir -p "$trees" "$links"

# tree SUITE ARCHITECTURE: a system of Python and pip alone.
tree() {
    local folder=$trees/$1-$2
    [ -e "$folder/usr/bin/python3" ] && return
    command -v mmdebstrap >/dev/null || { echo "try.sh: mmdebstrap is not installed (packages-platforms.txt)" >&2; exit 77; }
    rm -rf "$folder"
    # Foreign programs run only under qemu-user: their packages are unpacked, not configured.
    local variant=--variant=apt
    [ "$2" = "$(dpkg --print-architecture)" ] || variant=--variant=extract
    mmdebstrap --quiet $variant --mode=root --architectures="$2" --include=python3,python3-venv,python3-pip \
        "$1" "$folder" || { rm -rf "$folder"; echo "try.sh: Debian $1 for $2 is not served here" >&2; exit 77; }
}

# numpy VERSION PLATFORM: NumPy's own wheel, which pip takes from this folder.
numpy() {
    "$build/tools/bin/python" -m pip download --quiet --disable-pip-version-check --no-deps --only-binary :all: \
        --python-version "$1" --platform "$2" -d "$links" numpy
}

# exercised WHERE FILE EXPECTED: compares the lines.
exercised() {
    diff "$3" "$2" && echo "$1: the $(wc -l <"$2") lines of $(basename "$3")"
}

debian() { # SUITE
    tree "$1" "$(dpkg --print-architecture)"
    local folder=$trees/$1-$(dpkg --print-architecture)
    local version
    version=$(chroot "$folder" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    numpy "$version" manylinux_2_17_x86_64
    rm -rf "$folder/work"
    mkdir "$folder/work"
    cp -r "$links" "$root/dist" "$root"/packaging/wheels/exercise*.py "$root/include" "$folder/work"
    mkdir "$folder/work/tests" "$folder/work/docs"
    cp -r "$root/tests/python" "$folder/work/tests"
    cp "$root/docs/reasons.md" "$folder/work/docs"
    local begun=$SECONDS
    chroot "$folder" sh -e -c '
        cd /work
        export LANG=C.UTF-8
        python3 -m venv empty
        begun=$(date +%s)
        empty/bin/pip install --quiet --no-index --find-links dist --find-links links lensprof
        echo "pip install lensprof: $(($(date +%s) - begun)) s"
        empty/bin/python exercise.py >exercised.txt
        cd tests/python
        LENSPROF_INCLUDE=/work/include/lensprof /work/empty/bin/python -m unittest -q test_apply test_exposure test_fields \
            test_fit test_fixed_reference test_flat test_formats test_model test_profile test_reason test_rendering \
            test_sample test_sensor test_store test_trial test_online >/work/tests.txt 2>&1 || { cat /work/tests.txt; exit 1; }
        tail -3 /work/tests.txt'
    exercised "$1 (Python $version)" "$folder/work/exercised.txt" "$root/packaging/wheels/exercised.txt"
    echo "$1: installed, exercised and tested in $((SECONDS - begun)) s"
    if has_photo manylinux_2_17_x86_64; then photo "$1" "$folder"; fi
}

# simulated FOLDER: six pictures in FOLDER/pictures.
simulated() { (cd "$1" && "$root/build/lensprof" simulate -o pictures --size 640x480 --set mean-ev=-0.8 >/dev/null); }

# has_photo TAG: there are the photograph library's wheel and the program that makes pictures for it.
has_photo() { ls "$root"/dist/lensprof_photo-*"$1"*.whl >/dev/null 2>&1 && [ -x "$root/build/lensprof" ]; }

# photo WHERE FOLDER: a folder of pictures, with what pip installs alone.
photo() {
    local begun=$SECONDS
    simulated "$2/work"
    chroot "$2" sh -e -c '
        cd /work
        export LANG=C.UTF-8
        empty/bin/pip install --quiet --no-index --find-links dist --find-links links "lensprof[photo]"
        empty/bin/python exercise_photo.py pictures'
    echo "$1, photograph library: installed and tried in $((SECONDS - begun)) s"
}

# What the examples print with the library of this machine's build.
expected_of_examples() {
    local folder=$build/unit/native name
    rm -rf "$folder" # find_profile makes a new database
    mkdir -p "$folder"
    for name in "${examples[@]}"; do
        cc -O1 -I"$root/include" "$root/examples/$name.c" -L"$root/build" -llensprof -Wl,-rpath,"$root/build" -lm -o "$folder/$name" >&2
        # shellcheck disable=SC2046 # the argument is one word or none
        (cd "$folder" && "./$name" $(argument_of "$name"))
    done >"$folder/examples.txt"
    echo "$folder/examples.txt"
}

cmocka() { # the source, from Debian's source package, whose signature apt checks
    [ -e "$build/cmocka" ] && return
    local work=$build/cmocka.part
    rm -rf "$work"
    mkdir -p "$work/lists/partial"
    echo "deb-src http://deb.debian.org/debian bookworm main" >"$work/sources.list"
    (cd "$work" && for command in update "source cmocka"; do
        apt-get -qq -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=- -o Dir::State::lists="$work/lists" \
            -o Dir::Cache::srcpkgcache= -o Dir::Cache::pkgcache= -o APT::Sandbox::User=root $command >/dev/null
    done) || { echo "try.sh: Debian's source package cmocka is not served here" >&2; exit 77; }
    mv "$work"/cmocka-* "$build/cmocka"
    # What every C11 library has.
    printf '#define HAVE_%s 1\n' STDLIB_H STRING_H STDIO_H STDINT_H INTTYPES_H SIGNAL_H TIME_H ASSERT_H SETJMP_H STDARG_H \
        STDDEF_H SYS_TYPES_H STRUCT_TIMESPEC STRSIGNAL >"$build/cmocka/config.h"
}

# Whole jobs: a correction, a fit, a database. The same words everywhere.
examples=(correct_pixels fit_pairs find_profile)
argument_of() { [ "$1" != find_profile ] || echo profiles.db; }

# unit WHERE TARGET WHEEL RUNNER...: every test program, run in a folder of its own.
unit() {
    local where=$1 target=$2 wheel=$3 zig folder=$build/unit/$1 name library failed=0 count=0
    shift 3
    cmocka
    zig=$(echo "$build"/tools/lib/python3*/site-packages/ziglang/zig)
    rm -rf "$folder"
    mkdir -p "$folder"
    python3 -m zipfile -e "$root"/dist/lensprof-*"$wheel"*.whl "$folder/wheel"
    library=$(ls "$folder"/wheel/lensprof/*lensprof.{so,dll} 2>/dev/null || true)
    cp "$library" "$folder"
    if [ "$where" = windows ]; then # what the linker needs instead of the DLL
        { echo EXPORTS; grep -v '^#' "$root/tests/lint/exported_symbols.txt"; } >"$folder/lensprof.def"
        "$zig" dlltool -m i386:x86-64 -D "$(basename "$library")" -d "$folder/lensprof.def" -l "$folder/library.a"
        library=$folder/library.a
    fi
    local begun=$SECONDS flags="-w -O1 -ffp-contract=off -DHAVE_CONFIG_H -I$build/cmocka -I$build/cmocka/include -I$root/include -I$root/tests"
    "$zig" cc -target "$target" $flags -D_GNU_SOURCE -c "$build/cmocka/src/cmocka.c" -o "$folder/cmocka.o"
    "$zig" cc -target "$target" $flags -c "$root/tests/one_test.c" -o "$folder/one_test.o"
    for source in "$root"/tests/unit/test_*.c "$root"/tests/formats/test_{points,pano_trafo}.c; do
        grep -qE '#include [<"](core/|guessed|install/)' "$source" && continue
        name=$(basename "$source" .c)
        "$zig" cc -target "$target" $flags -DLENSPROF_BLOBS="\"$root/tests/fuzz/corpus/blob\"" -DLENSPROF_INCLUDE="\"$root/include\"" \
            "$source" "$folder/cmocka.o" "$folder/one_test.o" "$library" -Wl,-rpath,"$folder" -lm -o "$folder/$name"
        count=$((count + 1))
        if ! (cd "$folder" && LENSPROF_PERCENT=10 "$@" "./$name" >"$name.log" 2>&1); then
            failed=$((failed + 1))
            echo "$where: $name failed: $folder/$name.log" >&2
        fi
    done
    if [ "$where" = windows ]; then # the other half of the room of the operating system
        "$zig" c++ -target "$target" $flags -std=c++17 -I"$root/src" "$root/tests/cli/test_system.cpp" \
            "$root/src/photo/system/system_windows.cpp" "$folder/cmocka.o" -o "$folder/test_system"
        count=$((count + 1))
        (cd "$folder" && "$@" ./test_system >test_system.log 2>&1) || { failed=$((failed + 1)); echo "$where: test_system failed" >&2; }
    fi
    for name in "${examples[@]}"; do
        "$zig" cc -target "$target" -O1 -I"$root/include" "$root/examples/$name.c" "$library" -Wl,-rpath,"$folder" -lm -o "$folder/$name"
        (cd "$folder" && "$@" "./$name" $(argument_of "$name") | tr -d '\r')
    done >"$folder/examples.txt"
    exercised "$where, examples" "$folder/examples.txt" "$(expected_of_examples)" || failed=$((failed + 1))
    echo "$where: $count programs of unit tests in $((SECONDS - begun)) s, $(cat "$folder"/*.log | grep -c '\[       OK') tests passed, $failed programs failed"
    [ "$failed" = 0 ]
}

musl() {
    [ -e /lib/ld-musl-x86_64.so.1 ] || { echo "try.sh: musl is not installed (packages-platforms.txt)" >&2; exit 77; }
    unit musl x86_64-linux-musl musllinux /lib/ld-musl-x86_64.so.1
}

windows() {
    PATH=$PATH:/usr/lib/wine # where Debian has it
    command -v wine64 >/dev/null || { echo "try.sh: wine64 is not installed (packages-platforms.txt)" >&2; exit 77; }
    WINEDEBUG=-all WINEPREFIX=$build/wine unit windows x86_64-windows-gnu win_amd64 wine64
}

arm64() {
    tree bookworm arm64
    command -v qemu-aarch64 >/dev/null || { echo "try.sh: qemu-user is not installed (packages-platforms.txt)" >&2; exit 77; }
    local folder=$trees/bookworm-arm64
    numpy 3.11 manylinux_2_17_aarch64
    rm -rf "$build/arm64"
    mkdir "$build/arm64"
    local begun=$SECONDS
    for wheel in "$root"/dist/lensprof-*manylinux_2_17_aarch64*.whl "$links"/numpy-*cp311*aarch64.whl; do
        python3 -m zipfile -e "$wheel" "$build/arm64"
    done
    PYTHONPATH=$build/arm64 LANG=C.UTF-8 qemu-aarch64 -L "$folder" "$folder/usr/bin/python3.11" -B \
        "$root/packaging/wheels/exercise.py" >"$build/arm64/exercised.txt"
    exercised "arm64 (qemu-user; the wheel unpacked, not installed by pip)" "$build/arm64/exercised.txt" \
        "$root/packaging/wheels/exercised.txt"
    echo "arm64: exercised in $((SECONDS - begun)) s"
    if has_photo manylinux_2_17_aarch64; then
        python3 -m zipfile -e "$root"/dist/lensprof_photo-*manylinux_2_17_aarch64*.whl "$build/arm64"
        simulated "$build/arm64"
        begun=$SECONDS
        (cd "$build/arm64" && PYTHONPATH=$build/arm64 LANG=C.UTF-8 qemu-aarch64 -L "$folder" "$folder/usr/bin/python3.11" -B \
            "$root/packaging/wheels/exercise_photo.py" pictures)
        echo "arm64, photograph library: tried in $((SECONDS - begun)) s"
    fi
    unit arm64 aarch64-linux-gnu.2.17 manylinux_2_17_aarch64 qemu-aarch64 -L "$folder"
}

if [ "${1-}" = --one ]; then
    "$2" "${3-}"
    exit
fi
[ $# -gt 0 ] || set -- bullseye trixie arm64 musl windows
for where; do
    case $where in
    bullseye | bookworm | trixie | arm64 | musl | windows) ;;
    *) echo "try.sh: $where: is not one of bullseye, bookworm, trixie, arm64, musl, windows" >&2; exit 1 ;;
    esac
done
# Each in a shell of its own, so that a failure ends that one alone.
failed=() skipped=()
for where; do
    code=0
    case $where in
    bullseye | bookworm | trixie) "$0" --one debian "$where" || code=$? ;;
    *) "$0" --one "$where" || code=$? ;;
    esac
    case $code in
    0) ;;
    77) skipped+=("$where") ;;
    *) failed+=("$where") ;;
    esac
done
[ ${#skipped[@]} = 0 ] || echo "not tried: ${skipped[*]}"
[ ${#failed[@]} = 0 ] || { echo "failed: ${failed[*]}" >&2; exit 1; }
[ ${#skipped[@]} = 0 ] || exit 77
