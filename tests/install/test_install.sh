#!/bin/bash
# Installs the build into a separate folder and uses it from there, as from outside the tree.
# usage: test_install.sh SOURCE_DIR BUILD_DIR C_COMPILER CXX_COMPILER
set -euo pipefail
source_dir=$1 build_dir=$2
export CC=$3 CXX=$4
here=$source_dir/tests/install
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix
unset LD_LIBRARY_PATH CMAKE_PREFIX_PATH DESTDIR
failures=0

say() { echo "== $*"; }
wrong() { echo "WRONG: $*"; failures=$((failures + 1)); }
# Runs a command; its output is shown only if it fails.
quiet() { "$@" > "$work/log" 2>&1 || { cat "$work/log"; wrong "$*"; return 1; }; }

say "install"
quiet cmake --install "$build_dir" --prefix "$prefix"
lib_dir=$(dirname "$(find "$prefix" -name liblensprof.so)")
for header in "$source_dir"/include/lensprof/*.h; do
    cmp -s "$header" "$prefix/include/lensprof/$(basename "$header")" || wrong "$(basename "$header") was changed"
done
if ldd "$lib_dir/liblensprof-photo.so" | grep libexiv2; then wrong "liblensprof-photo uses Exiv2, which is GPL"; fi
[ -f "$lib_dir/liblensprof-core.a" ] || wrong "liblensprof-core.a is not installed"
if grep -rl "$build_dir" "$prefix/include" "$lib_dir/cmake" "$lib_dir/pkgconfig"; then wrong "these files name the build folder"; fi

say "program"
version=$(sed -n 's/^#define LENSPROF_VERSION_\(MAJOR\|MINOR\|PATCH\) //p' "$source_dir/include/lensprof/base.h" | paste -sd.)
[ "$(env -i "$prefix/bin/lensprof" version)" = "lensprof $version" ] || wrong "bin/lensprof does not print lensprof $version"
used=$(ldd "$prefix/bin/lensprof" | sed -n 's/.*liblensprof.so.0.3 => \(.*\) (.*/\1/p')
[ "$(realpath "$used")" = "$(realpath "$lib_dir/liblensprof.so.0.3")" ] || wrong "bin/lensprof uses $used, not the installed library"

say "a program of 0.2"
echo 'const char *lensprof_version(void) { return "0.2.0"; }' >"$work/older.c"
echo 'const char *lensprof_version(void); int main(void) { return !lensprof_version(); }' >"$work/of_older.c"
mkdir "$work/older"
quiet "$CC" -shared -fPIC -Wl,-soname,liblensprof.so.0.2 "$work/older.c" -o "$work/older/liblensprof.so"
quiet "$CC" "$work/of_older.c" -L"$work/older" -llensprof -o "$work/of_older"
if LD_LIBRARY_PATH=$lib_dir "$work/of_older" 2>"$work/loader"; then wrong "it runs with this library"; fi
grep -q "liblensprof.so.0.2: cannot open" "$work/loader" || wrong "$(cat "$work/loader")"

say "pkg-config"
export PKG_CONFIG_PATH=$lib_dir/pkgconfig
[ "$(pkg-config --modversion lensprof)" = "$version" ] || wrong "pkg-config reports another version"
for variable in prefix libdir includedir; do
    value=$(pkg-config --variable=$variable lensprof)
    case $(realpath -m "$value") in
    "$prefix"*) ;;
    *) wrong "lensprof.pc: $variable is $value, but the library was installed under $prefix" ;;
    esac
done
# shellcheck disable=SC2046 # the flags are words
if quiet "$CC" -std=c99 -Wall -Wextra -Werror $(pkg-config --cflags lensprof) "$source_dir/examples/fit_pairs.c" \
    -o "$work/fit_pairs" $(pkg-config --libs lensprof) -lm; then
    LD_LIBRARY_PATH=$lib_dir "$work/fit_pairs" | grep -q "usable: yes" || wrong "fit_pairs through pkg-config does not run"
fi

# shellcheck disable=SC2046 # the flags are words
if quiet "$CC" -std=c99 -Wall -Wextra -Werror $(pkg-config --cflags lensprof-core) "$source_dir/examples/correct_pixels.c" \
    -o "$work/correct_pixels" $(pkg-config --libs lensprof-core); then
    "$work/correct_pixels" | grep -q "^corrected:   corner 147" || wrong "correct_pixels through pkg-config does not run"
    if ldd "$work/correct_pixels" | grep liblensprof; then wrong "lensprof-core.pc links the shared library"; fi
fi

say "find_package"
if quiet cmake -S "$here/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" && quiet cmake --build "$work/consumer"; then
    [ "$("$work/consumer/consumer_c")" = "lensprof $version from C" ] || wrong "consumer_c"
    [ "$("$work/consumer/consumer_cpp")" = "lensprof $version from C++" ] || wrong "consumer_cpp"
fi
if quiet cmake -S "$here/consumer_core" -B "$work/consumer_core" -DCMAKE_PREFIX_PATH="$prefix" -DEXAMPLES="$source_dir/examples" \
    && quiet cmake --build "$work/consumer_core"; then
    "$work/consumer_core/consumer_core" | grep -q "^corrected:   corner 147" || wrong "consumer_core does not run"
    if ldd "$work/consumer_core/consumer_core" | grep liblensprof; then wrong "the core needs the shared library"; fi
fi
if cmake -S "$here/consumer" -B "$work/nowhere" -DCMAKE_PREFIX_PATH="$work" > /dev/null 2>&1; then
    wrong "find_package found lensprof outside the prefix, which makes the test meaningless"
fi
if quiet cmake -S "$source_dir/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$prefix" && quiet cmake --build "$work/examples"; then
    "$work/examples/find_profile" "$work/x.db" | grep -q "found profile 1" || wrong "find_profile from the installed library"
fi

if quiet "$CC" -std=c99 -Wall -Wextra -Werror $(pkg-config --cflags lensprof-photo) "$source_dir/examples/photo.c" \
    -o "$work/photo" $(pkg-config --libs lensprof-photo); then
    mkdir "$work/copies"
    quiet "$prefix/bin/lensprof" simulate -o "$work/scene" --size 400x300
    rm -f "$work/scene"/*.pto "$work/scene"/*.json
    LD_LIBRARY_PATH=$lib_dir "$work/photo" "$work/scene" "$work/copies" || wrong "photo through pkg-config does not run"
    [ "$(ls "$work/copies" | wc -l)" = "$(ls "$work/scene"/*.png | wc -l)" ] || wrong "photo does not write every copy"
fi

say "moved to another place"
mv "$prefix" "$work/moved"
[ "$(env -i "$work/moved/bin/lensprof" version)" = "lensprof $version" ] || wrong "the program does not run when moved"

[ $failures = 0 ] || { echo "$failures failures"; exit 1; }
echo "installed library and program work"
