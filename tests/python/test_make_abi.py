"""The generator of the tables of all languages: synthetic headers, and the committed files are up to date."""
import ctypes
import os
import pathlib
import re
import shutil
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bindings/tools"))
try:
    import make_abi
except SystemExit:  # without pycparser
    make_abi = None

needs_pycparser = unittest.skipUnless(make_abi, "needs package python3-pycparser")
CC = os.environ.get("CC", "cc")
VERSION = "".join(f"#define LENSPROF_VERSION_{part} {i}\n" for i, part in enumerate(("MAJOR", "MINOR", "PATCH")))
BASE = "#include <stddef.h>\n#include <stdint.h>\n" + VERSION


PYTHON = "bindings/python/lensprof/_abi.py"
RUST = "bindings/rust/lensprof-sys/src/abi.rs"
RUST_DUMP = "bindings/rust/lensprof-sys/examples/abi_dump.rs"
NODE = "bindings/node/abi.js"
JAVA = "bindings/java/src/main/java/lensprof/Abi.java"
C_DUMP = "tests/python/abi_dump.c"


def texts_of(text, **others):
    """What is generated of a synthetic lensprof.h and other headers."""
    with tempfile.TemporaryDirectory() as folder:
        include = pathlib.Path(folder, "lensprof")
        include.mkdir()
        (include / "lensprof.h").write_text(BASE + text)
        for name, other in others.items():
            (include / f"{name}.h").write_text(other)
        return make_abi.generated(pathlib.Path(folder), CC)


def from_header(text):
    """(text of _abi.py, its module, text of abi_dump.c) for a synthetic header."""
    texts = texts_of(text)
    code = texts["bindings/python/lensprof/_abi.py"]
    module = types.ModuleType("made")
    exec(compile(code, "_abi.py", "exec"), vars(module))
    return code, module, texts["tests/python/abi_dump.c"]


@needs_pycparser
class Fresh(unittest.TestCase):
    def test_the_committed_files_are_what_the_headers_give(self):
        self.assertEqual(make_abi.stale(make_abi.generated(ROOT / "include", CC), ROOT), [],
                         "run `make abi` and commit what it writes")

    def stale_after(self, old, new):
        """The files that are stale after a change of the headers."""
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(ROOT / "include", folder, dirs_exist_ok=True)
            for path in pathlib.Path(folder, "lensprof").glob("*.h"):
                path.write_text(re.sub(old, new, path.read_text()))
            return set(make_abi.stale(make_abi.generated(pathlib.Path(folder), CC), ROOT))

    def test_a_changed_structure_makes_all_stale(self):
        self.assertEqual(self.stale_after("uint32_t pairs;", "uint32_t pairs, planted;"),
                         {PYTHON, RUST, RUST_DUMP, NODE, JAVA, C_DUMP})

    def test_a_changed_enumeration_makes_tables_stale(self):
        old = "LENSPROF_ERROR_BUSY = 46,"
        self.assertEqual(self.stale_after(old, old + " LENSPROF_ERROR_PLANTED = 47,"),
                         {PYTHON, RUST, NODE, JAVA, C_DUMP})

    def test_a_changed_function_makes_tables_stale(self):
        self.assertEqual(self.stale_after(r"lensprof_version\(void\)", "lensprof_version(int planted)"),
                         {PYTHON, RUST, NODE, JAVA})

    def test_a_changed_photograph_function_makes_the_package_stale(self):
        self.assertEqual(self.stale_after(r"\blensprof_picture_open\(", "lensprof_picture_planted("), {PYTHON})


@needs_pycparser
class Generator(unittest.TestCase):
    def test_first_line_warns(self):
        code, _, dump = from_header("typedef struct lensprof_any lensprof_any;")
        for text in (code, dump):
            self.assertIn("do not edit", text.splitlines()[0])

    def test_numbers_and_enumerations(self):
        _, made, dump = from_header("""
#define LENSPROF_SIDE 32 /* text */
#define LENSPROF_CELLS (3 * LENSPROF_SIDE)
#define LENSPROF_UNKNOWN (-1.5)
#define LENSPROF_ALL 0xFFFFFFFFu
#define LENSPROF_FREE_A 0x01u
#define LENSPROF_FREE_B 0x80u
#define LENSPROF_EMPTY
typedef struct lensprof_any lensprof_any;
typedef enum lensprof_light { LENSPROF_LIGHT_ANY = 0, LENSPROF_LIGHT_AREA = 7, LENSPROF_LIGHT_NEXT } lensprof_light;
typedef enum lensprof_pack { LENSPROF_PACK_COVARIANCE = 1 } lensprof_pack;
""")
        self.assertEqual((made.SIDE, made.CELLS, made.UNKNOWN, made.ALL, made.VERSION),
                         (32, 96, -1.5, 2**32 - 1, "0.1.2"))
        self.assertEqual(made.Light.__members__, {"ANY": 0, "AREA": 7, "NEXT": 8})
        self.assertIn("lensprof/lensprof.h", made.Free.__doc__)
        self.assertEqual(made.Free.A | made.Free.B, 0x81)
        self.assertTrue(issubclass(made.Pack, made.IntFlag))
        self.assertEqual(made.ENUMS, {"LENSPROF_LIGHT_": made.Light, "LENSPROF_PACK_": made.Pack,
                                      "LENSPROF_FREE_": made.Free})
        self.assertEqual(set(re.findall(r"VALUE\(LENSPROF_(\w+)\);", dump)),
                         {"SIDE", "CELLS", "UNKNOWN", "ALL", "FREE_A", "FREE_B", "LIGHT_ANY", "LIGHT_AREA",
                          "LIGHT_NEXT", "PACK_COVARIANCE", "VERSION_MAJOR", "VERSION_MINOR", "VERSION_PATCH"})

    def test_structures(self):
        _, made, dump = from_header("""
typedef struct lensprof_part { double xy[2][3]; char name[64]; } lensprof_part;
typedef struct lensprof_whole {
    uint32_t size, count;
    lensprof_part part[1 + 1];
    const lensprof_part *parts;
    const uint8_t *mask;
    void *data;
    ptrdiff_t row_bytes;
} lensprof_whole;
""")
        self.assertEqual(made.Part._fields_, [("xy", ctypes.c_double * 3 * 2), ("name", ctypes.c_char * 64)])
        self.assertEqual(made.Whole._fields_, [
            ("size", ctypes.c_uint32), ("count", ctypes.c_uint32), ("part", made.Part * 2),
            ("parts", ctypes.POINTER(made.Part)), ("mask", ctypes.POINTER(ctypes.c_uint8)), ("data", ctypes.c_void_p),
            ("row_bytes", ctypes.c_ssize_t)])
        lines = ("STRUCT(lensprof_part);", "FIELD(lensprof_part, xy);", "FIELD(lensprof_part, name);")
        self.assertIn("".join(f"    {line}\n" for line in lines), dump)

    def test_functions_callbacks_and_handles(self):
        _, made, _ = from_header("""
typedef enum lensprof_status { LENSPROF_OK = 0 } lensprof_status;
typedef struct lensprof_plan lensprof_plan;
typedef int (*lensprof_progress)(double done, void *user);
const char *lensprof_name(lensprof_status status);
lensprof_status lensprof_open(const char *path, lensprof_plan **plan, lensprof_progress progress, void *user);
void lensprof_close(lensprof_plan *plan);
uint32_t lensprof_sum(const double values[3], const lensprof_plan *const *plans, size_t *needed);
int lensprof_none(void);
""")
        plan = ctypes.POINTER(made.Plan)
        self.assertEqual(made.FUNCTIONS, {
            "lensprof_name": (ctypes.c_char_p, [ctypes.c_int]),
            "lensprof_open": (ctypes.c_int, [ctypes.c_char_p, ctypes.POINTER(plan), made.Progress, ctypes.c_void_p]),
            "lensprof_close": (None, [plan]),
            "lensprof_sum": (ctypes.c_uint32, [ctypes.POINTER(ctypes.c_double), ctypes.POINTER(plan),
                                               ctypes.POINTER(ctypes.c_size_t)]),
            "lensprof_none": (ctypes.c_int, [])})
        self.assertEqual(made.OPAQUE, {"lensprof_plan": made.Plan})
        self.assertEqual((made.Progress._restype_, made.Progress._argtypes_),
                         (ctypes.c_int, (ctypes.c_double, ctypes.c_void_p)))

    def test_init_functions(self):
        _, made, _ = from_header("""
typedef struct lensprof_a { uint32_t struct_size; } lensprof_a;
typedef struct lensprof_b { uint32_t struct_size; } lensprof_b;
typedef struct lensprof_c { uint32_t struct_size; lensprof_b *b; } lensprof_c;
typedef struct lensprof_d { uint32_t index; } lensprof_d;
void lensprof_a_init(lensprof_a *a);
void lensprof_b_init_sized(lensprof_b *b, size_t size);
static inline void lensprof_b_init(lensprof_b *b) { lensprof_b_init_sized(b, sizeof *b); }
void lensprof_c_init_sized(lensprof_c *c, size_t size, size_t b_size);
static inline void lensprof_c_init(lensprof_c *c) { lensprof_c_init_sized(c, sizeof *c, sizeof(lensprof_b)); }
void lensprof_d_init_sized(lensprof_d *d, size_t size, uint32_t index);
static inline void lensprof_d_init(lensprof_d *d, uint32_t index) { lensprof_d_init_sized(d, sizeof *d, index); }
""")
        self.assertEqual(made.INITS, {made.A: ("lensprof_a_init", []), made.B: ("lensprof_b_init_sized", [made.B]),
                                      made.C: ("lensprof_c_init_sized", [made.C, made.B])})
        self.assertNotIn("lensprof_b_init", made.FUNCTIONS)

    def test_texts(self):
        self.assertEqual(from_header("#define LENSPROF_TEXT \"a text\"")[1].TEXT, "a text")

    def test_what_has_no_form_is_refused(self):
        for text in ("typedef union lensprof_u { int a; } lensprof_u;",
                     "typedef struct lensprof_s { uint32_t bits : 3; } lensprof_s;",
                     "typedef struct lensprof_s { unsigned long n; } lensprof_s;",
                     "static inline int lensprof_alone(void) { return 1; }",
                     "extern int lensprof_global;",
                     "typedef enum lensprof_a { LENSPROF_A_X = 1 } lensprof_a;\n"
                     "typedef enum lensprof_b { LENSPROF_A_Y = 1 } lensprof_b;"):
            with self.subTest(text=text), self.assertRaises(make_abi.Refused):
                from_header(text)

    def test_a_header_that_does_not_compile_is_named(self):
        with self.assertRaisesRegex(make_abi.Refused, "nowhere.h"):
            from_header('#include "nowhere.h"')


LANGUAGES_HEADER = """
#define LENSPROF_ALL 0xFFFFFFFFu
#define LENSPROF_UNKNOWN (-1.0)
#define LENSPROF_FREE_A 0x01u
typedef enum lensprof_status { LENSPROF_OK = 0, LENSPROF_ERROR_SIZE = 3 } lensprof_status;
typedef struct lensprof_part { double xy[2][3]; char name[64]; } lensprof_part;
typedef struct lensprof_whole {
    uint32_t struct_size;
    lensprof_part part[2];
    const uint8_t *mask;
    size_t n;
} lensprof_whole;
typedef struct lensprof_plan lensprof_plan;
typedef int (*lensprof_progress)(double done, void *user);
void lensprof_whole_init_sized(lensprof_whole *whole, size_t size);
static inline void lensprof_whole_init(lensprof_whole *whole) { lensprof_whole_init_sized(whole, sizeof *whole); }
lensprof_status lensprof_open(const char *path, uint32_t type, lensprof_plan **plan, lensprof_progress progress);
"""


@needs_pycparser
class Languages(unittest.TestCase):
    def texts(self):
        return texts_of(LANGUAGES_HEADER, photo="typedef struct lensprof_picture { int seen; } lensprof_picture;\n"
                                                "int lensprof_see(const lensprof_picture *picture);\n")

    def holds(self, path, *parts):
        text = self.texts()[path]
        self.assertIn("do not edit", text.splitlines()[0])
        for part in parts:
            self.assertIn(part, text)
        self.assertNotIn("lensprof_see", text, "of the photograph library")
        self.assertNotIn("lensprof_picture", text)

    def test_rust(self):
        self.holds(RUST, 'pub const VERSION: &str = "0.1.2";', "pub const ALL: u32 = 4294967295;",
                   "pub const UNKNOWN: f64 = -1.0;", "pub const FREE_A: u32 = 1;",
                   "    Ok = 0,\n    ErrorSize = 3,\n", "            3 => Some(Self::ErrorSize),",
                   "    pub xy: [[f64; 3]; 2],\n    pub name: [c_char; 64],\n",
                   "    pub part: [Part; 2],\n    pub mask: *const u8,\n",
                   "unsafe { lensprof_whole_init_sized((&mut value as *mut Self).cast(), size_of::<Whole>()) };",
                   'pub type Progress = Option<unsafe extern "C" fn(done: f64, user: *mut c_void) -> c_int>;',
                   "pub fn lensprof_open(path: *const c_char, r#type: u32, plan: *mut *mut Plan, "
                   "progress: Progress) -> c_int;")
        self.holds(RUST_DUMP, "offset_of!(lensprof_sys::Whole, mask)")

    def test_node(self):
        self.holds(NODE, "export const VERSION = '0.1.2';", "export const ALL = 4294967295;", "    A: 0x01,\n",
                   "export const Status = Object.freeze({\n    OK: 0,\n    ERROR_SIZE: 3,\n});",
                   "        xy: 'double[3][2]',\n",
                   "        mask: 'uint8_t*',\n", "    ['callback', 'lensprof_progress', ['int', 'double', 'void*']],",
                   "    lensprof_whole: ['lensprof_whole_init_sized', ['lensprof_whole']],",
                   "    lensprof_open: ['int', ['char*', 'uint32_t', 'lensprof_plan**', 'lensprof_progress']],")

    def test_java(self):
        self.holds(JAVA, 'VERSION = "0.1.2";', "int ALL = 0xffffffff;", "double UNKNOWN = -1.0;", "int FREE_A = 1;",
                   "        OK(0),\n        ERROR_SIZE(3);", "public double[] xy = new double[6];",
                   "public Part[] part = new Part[2];", "public Pointer mask;", "public Size n = new Size();",
                   "library.lensprof_whole_init_sized(this, new Size(size()));",
                   "int invoke(double done, Pointer user);",
                   "int lensprof_open(String path, int type, Pointer plan, Progress progress);")


if __name__ == "__main__":
    unittest.main()
