#!/bin/bash
# The page in the browser, one file: build/page/lensprof.html. Needs the packages of packages-page.txt and of
# packages-wheels.txt, whose tools fetch the libraries inside.
set -eu -o pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$root/build/page
sources=$root/build/wheels/sources
[ -d "$sources/licenses" ] || "$root/packaging/wheels/build.py" --sources
mkdir -p "$build/web"
cp "$here"/*.js "$here"/*.mjs "$here"/*.json "$here/index.html" "$build/web"
cd "$build/web"
npm ci --no-audit --no-fund --silent
export NODE_PATH=$build/web/node_modules # of acorn, with which Emscripten makes its JavaScript smaller
{
    emcmake cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release -DLENSPROF_SOURCES="$sources" \
        -DLENSPROF_PHOTO=OFF -DLENSPROF_PROGRAM=OFF -DLENSPROF_TESTS=OFF &&
        cmake --build "$build" --target lensprof_page -j "$(nproc)"
} >"$build/build.log" 2>&1 || {
    tail -20 "$build/build.log"
    echo "build.sh: the library cannot be built; read $build/build.log" >&2
    exit 1
}
mkdir -p lensprof
cp "$root/LICENSE" "$root/NOTICE" lensprof
licences=(lensprof/* "$(em-config EMSCRIPTEN_ROOT)/system/lib/libc/musl/COPYRIGHT")
for library in nlopt pugixml eigen nlohmann libcxx libcxxabi; do licences+=("$sources/licenses/$library"/*); done
for library in exifr fast-png tiff fflate iobuffer; do licences+=("node_modules/$library/LICENSE"); done
node build.mjs "$build/bindings/web" "$build/lensprof.html" "${licences[@]}"
