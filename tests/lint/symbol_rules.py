#!/usr/bin/env python3
"""Layer rules, from the symbols that the compiled code refers to and that the shared library exports.

usage: symbol_rules.py [--nm NM] [--cc CC] CHECK

  core ARCHIVE                         the core needs only the listed functions, and has no writable data
  apply OBJECTS_FOLDER                 code that applies a profile needs even less, pixel code least: for processors of
                                       cameras, too
  layer NAME ARCHIVE OBJECTS_FOLDER [BELOW]
                                       falloff, fit, formats or store refer only to themselves, the core, the layer with
                                       its objects in BELOW and their library
  exports LIBRARY HEADERS LIST         exported symbols = LIST = LENSPROF_API of the headers
  self-check                           every check must find a planted violation

Prints violations; exit 1 if there are any.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

LIST = pathlib.Path(__file__).with_name("exported_symbols.txt")

LIBM = """acos asin atan atan2 cbrt ceil copysign cos cosh exp exp2 expm1 fabs floor fma fmax fmin fmod frexp hypot ldexp
log log10 log1p log2 lrint lround modf nearbyint pow remainder rint round scalbn sin sinh sqrt tan tanh trunc""".split()
# sincos: gcc combines sin and cos of one number. _GLOBAL_OFFSET_TABLE_: from position-independent code.
CORE_MAY_NEED = {
    *LIBM,
    *(name + "f" for name in LIBM),
    "sincos",
    "sincosf",
    "memcmp",
    "memcpy",
    "memmove",
    "memset",
    "_GLOBAL_OFFSET_TABLE_",
}
WRITABLE = re.compile(r"^(\.t?data|\.t?bss|\*COM\*)(\.(?!rel\.ro).*)?$")  # tables of pointers are in .data.rel.ro

# Functions that fit, formats and store must leave to the program: files, output, environment, time of day, randomness;
# also threads, except those that the fit layer starts and ends within a call.
OUTSIDE = re.compile(
    r"""^_*(
    f?(open|open64|close|read|write|printf|puts|putc|getc|scanf|seek|tell|flush) | fdopen | freopen(64)? | fopen(64)?
  | remove | rename | unlink | tmpfile(64)? | mkstemp | v?f?printf | putchar | perror | std(in|out|err) | getenv
  | setenv | setlocale | s?rand | random | drand48 | time | gettimeofday | localtime(_r)? | gmtime(_r)? | system | fork | exit
  | abort | signal
)(_chk)?$ | ^_ZSt[34](cin|cout|cerr|clog)$ | basic_[io]?fstream | basic_filebuf | random_device""",
    re.VERBOSE,
)
THREADS = re.compile(r"^pthread_create$|St6thread")
MAY_START_THREADS = {"fit"}


class Nm:
    def __init__(self, program):
        self.program = program

    def symbols(self, path, *options):
        """(name, type letter, section) of every symbol."""
        text = subprocess.run(
            [self.program, "--format=sysv", *options, str(path)],
            check=True,
            stdout=subprocess.PIPE,
            universal_newlines=True,
        ).stdout
        found = []
        for line in text.splitlines():
            fields = [field.strip() for field in line.split("|")]
            if len(fields) == 7 and fields[0] != "Name":
                found.append((fields[0].split("@")[0], fields[2], fields[6]))
        return found

    def needed_and_made(self, paths):
        needed, made = set(), set()
        for path in paths:
            for name, kind, _ in self.symbols(path):
                (needed if kind in "Uw" else made).add(name)
        return needed - made, made


def check_core(nm, archive):
    needed, made = nm.needed_and_made([archive])
    if "lensprof_apply" not in made and "planted" not in made:
        return [f"{archive}: does not hold the core"]
    violations = [
        f"{archive}: refers to {name}; the core needs libm and memcpy only" for name in sorted(needed - CORE_MAY_NEED)
    ]
    for name, _, section in nm.symbols(archive):
        if WRITABLE.match(section):
            violations.append(f"{archive}: {name} is writable data ({section}); the core has no mutable globals")
    return violations


# Objects that apply a profile, without the rest of the core. The first set prepares plans and may use a few functions.
APPLY_PATH = {"apply", "apply_packed", "base", "best", "blob", "fixed", "fixed_open", "fixed_packed", "fixed_plan",
              "fixed_table", "levels", "gain_grid", "image", "image_circle", "options", "packed", "plan", "plan_curves", "profile", "response",
              "readout", "row_avx2", "row_avx512", "row_gathers", "row_neon", "row_scalar", "row_sse41", "sensor", "sensor_error", "sensor_flat",
              "sensor_flat_fit", "sensor_open", "sensor_packed", "sensor_plan", "vignetting"}
# log: newlib implements log2 with it.
APPLY_MAY_NEED = {"exp2", "fabs", "floor", "fmax", "hypot", "ldexp", "log", "log2", "pow", "sqrt", "copysign",
                  "memcmp", "memcpy", "memmove", "memset", "_GLOBAL_OFFSET_TABLE_"}
OF_COMPILER = re.compile(r"^__(aeabi|gnu)_\w+$|^__(clz|ctz|popcount)[sd]i2$")
# Functions that an ARM compiler calls for numbers that the processor lacks.
OF_DOUBLE = re.compile(r"^__aeabi_(c?d[a-z]\w*|\w+2d)$")
OF_FLOAT = re.compile(r"^__aeabi_(c?[df][a-z]\w*|\w+2[df])$")
# Pixel code: no functions but these; no double precision in the row kernel, no floating point in the others.
PIXELS = {"row_scalar": OF_DOUBLE, "fixed": OF_FLOAT, "packed": OF_FLOAT, "apply_packed": OF_FLOAT, "fixed_packed": OF_FLOAT,
          "sensor": OF_FLOAT, "sensor_packed": OF_FLOAT}
PIXELS_MAY_NEED = {"memcpy", "memmove", "memset", "_GLOBAL_OFFSET_TABLE_", "lensprof_sample_type_bytes", "lp_tile_validate",
                   "lp_log2_table", "lp_exp2_table"}
PACKED_MAY_NEED = {"packed": {"lp_images_overlap", "lp_is_mosaic"}, "apply_packed": {"lensprof_apply", "lp_apply_packed"},
                   "fixed_packed": {"lensprof_fixed_apply", "lp_apply_packed"},
                   "sensor_packed": {"lensprof_sensor_apply", "lp_apply_packed"}}


def check_apply(nm, folder):
    paths = {path.name.split(".")[0]: path for path in sorted(pathlib.Path(folder).rglob("*.o"))}
    if not PIXELS.keys() <= paths.keys():
        return [f"{folder}: does not hold what applies a profile"]
    needed, _ = nm.needed_and_made([path for name, path in paths.items() if name in APPLY_PATH])
    _, core = nm.needed_and_made(paths.values())
    # The EMoR tables are for constructing responses; a linker leaves them out (tests/firmware).
    violations = [
        f"{folder}: what applies a profile refers to {name}"
        for name in sorted(needed - APPLY_MAY_NEED - (core & {"lp_emor_table"}))
        if not OF_COMPILER.match(name)
    ]
    for pixels, never in PIXELS.items():
        allowed = PIXELS_MAY_NEED | PACKED_MAY_NEED.get(pixels, set())
        for name in sorted(nm.needed_and_made([paths[pixels]])[0] - allowed):
            if never.match(name) or not OF_COMPILER.match(name):
                violations.append(f"{folder}: pixels in {pixels} call {name}")
    return violations


LIBRARY_OF = {"falloff": re.compile(r"(?!)"), "fit": re.compile(r"^nlopt_"), "formats": re.compile(r"^_ZNK?4pugi"), "store": re.compile(r"^sqlite3_")}
OF_LIBRARIES = re.compile(r"^(nlopt_|sqlite3_|lensprof_|lp_|_ZNK?8lensprof|_ZNK?4pugi|png_|TIFF|jpeg_|_ZN5Exiv2)")


def check_layer(nm, name, archive, folder, below=None):
    objects = sorted(pathlib.Path(folder).rglob("*.o"))
    if not objects:
        return [f"{folder}: holds no object files"]
    needed, _ = nm.needed_and_made(objects)
    _, known = nm.needed_and_made([archive, *(pathlib.Path(below).rglob("*.o") if below else [])])
    violations = []
    for symbol in sorted(needed - known):
        if OUTSIDE.search(symbol) or (THREADS.search(symbol) and name not in MAY_START_THREADS):
            violations.append(
                f"{name}: refers to {symbol}; files, output, environment, clock and threads belong to the program"
            )
        elif OF_LIBRARIES.match(symbol) and not LIBRARY_OF[name].match(symbol):
            violations.append(f"{name}: refers to {symbol} of a layer or library that it must not use")
    return violations


def declared_functions(headers):
    """Of the headers in a folder except photo.h, whose library is another; or of one header."""
    found, place = set(), pathlib.Path(headers)
    for header in [place] if place.is_file() else sorted(set(place.glob("*.h")) - {place / "photo.h"}):
        text = re.sub(r"/\*.*?\*/", " ", header.read_text(encoding="utf-8"), flags=re.DOTALL)
        text = re.sub(r"^\s*#.*$", "", text, flags=re.MULTILINE)
        found |= set(re.findall(r"\bLENSPROF_API\b[^;({]*?(\w+)\s*\(", text))
    return found


def check_exports(nm, library, headers, listed):
    exported = {name for name, kind, _ in nm.symbols(library, "--dynamic", "--defined-only") if kind not in "Abdrt"}
    declared = declared_functions(headers)
    cpp = sorted(name for name in exported - listed if name.startswith("_Z"))
    violations = [
        f"{library}: exports {name}, which is not in {LIST.name}" for name in sorted(exported - listed - set(cpp))
    ]
    if cpp:
        violations.append(
            f"{library}: exports {len(cpp)} symbols of C++, which can clash with those of the program that loads it: "
            f"{' '.join(cpp)}; link it with a version script that lets out lensprof_* only"
        )
    violations += [f"{library}: does not export {name}, which is in {LIST.name}" for name in sorted(listed - exported)]
    violations += [f"{headers}: declares {name}, which is not in {LIST.name}" for name in sorted(declared - listed)]
    violations += [f"{headers}: does not declare {name}, which is in {LIST.name}" for name in sorted(listed - declared)]
    return violations


def read_list(path):
    lines = [line.strip() for line in pathlib.Path(path).read_text().splitlines() if line.strip() and not line.startswith("#")]
    if lines != sorted(set(lines)):
        sys.exit(f"{path}: is not sorted or names a function twice")
    return set(lines)


def self_check(nm, cc):
    failures = []

    def expect(what, violations, wanted):
        if len(violations) != len(wanted) or any(word not in text for word, text in zip(wanted, violations)):
            failures.append(f"{what}: found {violations}, wanted {wanted}")

    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)

        def compile_c(text, name="planted"):
            (folder / name).mkdir(exist_ok=True)
            (folder / f"{name}.c").write_text(text)
            subprocess.run(
                [cc, "-O1", "-fPIC", "-c", "-o", folder / name / f"{name}.o", folder / f"{name}.c"], check=True
            )
            return folder / name / f"{name}.o"

        clean = (
            "#include <math.h>\nstatic const char *const names[] = {\"a\", \"b\"};\n"
            "double planted(double x, int i) { return pow(x, names[i][0]); }\n"
        )
        expect("clean core", check_core(nm, compile_c(clean)), [])
        expect(
            "malloc",
            check_core(nm, compile_c(clean + "#include <stdlib.h>\nvoid *m(int n) { return malloc(n); }\n")),
            ["malloc"],
        )
        expect(
            "puts", check_core(nm, compile_c(clean + "#include <stdio.h>\nvoid p(void) { puts(\"x\"); }\n")), ["puts"]
        )
        expect(
            "errno",
            check_core(nm, compile_c(clean + "#include <errno.h>\nint e(void) { return errno; }\n")),
            ["__errno_location"],
        )
        expect(
            "static",
            check_core(nm, compile_c(clean + "static int count;\nint c(void) { return ++count; }\n")),
            ["count"],
        )
        expect("initialised", check_core(nm, compile_c(clean + "int count = 3;\n")), ["count"])
        expect("thread-local", check_core(nm, compile_c(clean + "_Thread_local int count = 3;\n")), ["count"])
        core = compile_c(clean)
        for layer, code, wanted in [
            (
                "fit",
                "int nlopt_create(void); double planted(double, int); "
                "int f(void) { return nlopt_create() + planted(1, 1); }",
                [],
            ),
            ("fit", "int sqlite3_open(void); int f(void) { return sqlite3_open(); }", ["sqlite3_open"]),
            (
                "fit",
                "int lensprof_store_open(void); int f(void) { return lensprof_store_open(); }",
                ["lensprof_store_open"],
            ),
            ("fit", "int pthread_create(void); int f(void) { return pthread_create(); }", []),
            ("store", "int pthread_create(void); int f(void) { return pthread_create(); }", ["pthread_create"]),
            ("formats", "int nlopt_create(void); int f(void) { return nlopt_create(); }", ["nlopt_create"]),
            ("formats", "int _ZN4pugi4loadEv(void); int f(void) { return _ZN4pugi4loadEv(); }", []),
            ("store", "int _ZNK4pugi4loadEv(void); int f(void) { return _ZNK4pugi4loadEv(); }", ["_ZNK4pugi4loadEv"]),
            ("formats", "#include <stdio.h>\nvoid *f(void) { return fopen(\"x\", \"r\"); }", ["fopen"]),
            ("formats", "#include <stdio.h>\nint f(char *s) { return snprintf(s, 9, \"%s\", s + 1); }", []),
            ("store", "#include <time.h>\nlong f(void) { return time(0); }", ["time"]),
            ("store", "int sqlite3_open(void); int f(void) { return sqlite3_open(); }", []),
        ]:
            compile_c(code, "layer")
            expect(f"{layer}: {code}", check_layer(nm, layer, core, folder / "layer"), wanted)
        pixels = "int __aeabi_%s(void); int %s(void) { return __aeabi_%s(); }"
        for code, wanted in [
            ("", []),
            (pixels % ("dmul", "f", "dmul"), ["row_scalar call __aeabi_dmul"]),
            (pixels % ("f2d", "f", "f2d"), ["row_scalar call __aeabi_f2d"]),
            (pixels % ("lmul", "f", "lmul"), []),
            ("float sqrtf(float); float f(float x) { return sqrtf(x); }",
             ["applies a profile refers to sqrtf", "row_scalar call sqrtf"]),
        ]:
            (folder / "apply").mkdir(exist_ok=True)
            for name, text in [*((name, "") for name in PIXELS), ("row_scalar", code)]:
                (folder / "apply" / f"{name}.o").write_bytes(compile_c(text + "\nint here;", name).read_bytes())
            expect(f"apply: {code}", check_apply(nm, folder / "apply"), wanted)
        for helper, wanted in [("fadd", 1), ("cfcmple", 1), ("i2f", 1), ("dadd", 1), ("ui2d", 1), ("llsl", 0), ("uidiv", 0)]:
            object_file = compile_c(pixels % (helper, "g", helper), "fixed")
            (folder / "apply" / "fixed.o").write_bytes(object_file.read_bytes())
            (folder / "apply" / "row_scalar.o").write_bytes(compile_c("int here;", "row_scalar").read_bytes())
            expect(helper, check_apply(nm, folder / "apply"), ["pixels in fixed call"] * wanted)
        headers = folder / "headers"
        headers.mkdir()
        (headers / "x.h").write_text(
            "/* LENSPROF_API int lensprof_no(void); */\n#define LENSPROF_API\n"
            "LENSPROF_API LENSPROF_MUST_USE const double *\nlensprof_one(int x);\n"
            "LENSPROF_API void lensprof_two(void (*f)(int));\n"
        )
        library = folder / "lib.so"
        for code, listed, wanted in [
            ("int lensprof_one, lensprof_two;", {"lensprof_one", "lensprof_two"}, []),
            ("int lensprof_one, lensprof_two, lp_x;", {"lensprof_one", "lensprof_two"}, ["exports lp_x"]),
            (
                "int lensprof_one, lensprof_two, _ZSt1x, _ZSt1y;",
                {"lensprof_one", "lensprof_two"},
                ["exports 2 symbols of C++"],
            ),
            ("int lensprof_one;", {"lensprof_one", "lensprof_two"}, ["not export lensprof_two"]),
            ("int lensprof_one, lensprof_two;", {"lensprof_one"}, ["exports lensprof_two", "declares lensprof_two"]),
            (
                "int lensprof_one, lensprof_two, lensprof_x;",
                {"lensprof_one", "lensprof_two", "lensprof_x"},
                ["not declare lensprof_x"],
            ),
        ]:
            subprocess.run([cc, "-shared", "-o", library, compile_c(code, "exports")], check=True)
            expect(code, check_exports(nm, library, headers, listed), wanted)
    print("\n".join(failures) or "symbol_rules: planted violations found")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nm", default="nm")
    parser.add_argument("--cc", default="cc")
    parser.add_argument("check", choices=["core", "apply", "layer", "exports", "self-check"])
    parser.add_argument("arguments", nargs="*")
    options = parser.parse_args()
    nm = Nm(options.nm)
    if options.check == "self-check":
        return self_check(nm, options.cc)
    if options.check == "core":
        violations = check_core(nm, *options.arguments)
    elif options.check == "apply":
        violations = check_apply(nm, *options.arguments)
    elif options.check == "layer":
        violations = check_layer(nm, *options.arguments)
    else:
        violations = check_exports(nm, *options.arguments[:2], read_list(options.arguments[2]))
    print("\n".join(violations) or f"symbol_rules: {options.check} {' '.join(options.arguments)}: no violation")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
