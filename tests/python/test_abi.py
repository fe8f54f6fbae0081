"""The tables of lensprof._abi against the C compiler (abi_dump), the headers and the shared library."""
import ctypes
import json
import os
import pathlib
import re
import subprocess
import unittest

from lensprof import _abi, _library

PACKAGE = pathlib.Path(_abi.__file__).parent
SCALARS = {"double": ctypes.c_double, "float": ctypes.c_float, "int": ctypes.c_int, "uint32_t": ctypes.c_uint32,
           "int64_t": ctypes.c_int64, "size_t": ctypes.c_size_t, "ptrdiff_t": ctypes.c_ssize_t, "lensprof_status": ctypes.c_int, "void": None}
POINTERS = {"char": ctypes.c_char_p, "void": ctypes.c_void_p, "uint8_t": ctypes.POINTER(ctypes.c_uint8)}


def header_text():
    """All public headers without comments."""
    folder = pathlib.Path(os.environ["LENSPROF_INCLUDE"])
    text = "\n".join(path.read_text() for path in sorted(folder.glob("*.h")))
    return re.sub(r"/\*.*?\*/", "", text, flags=re.S)


def ctype_of(declaration):
    """ctypes type of a C parameter or result: `const double *values`, `double xy[2]`, `lensprof_pto **pto`."""
    if "lensprof_import_visitor" in declaration:
        return _abi.ImportVisitor
    if "lensprof_fault_visitor" in declaration:
        return _abi.FaultVisitor
    words = re.findall(r"\w+", declaration)
    name = next(word for word in words if word != "const")
    stars = declaration.count("*") + declaration.count("[")
    if stars == 0:
        return SCALARS[name]
    known = {**_abi.STRUCTS, **_abi.OPAQUE}
    kind = POINTERS[name] if name in POINTERS else ctypes.POINTER(known[name] if name in known else SCALARS[name])
    for _ in range(stars - 1):
        kind = ctypes.POINTER(kind)
    return kind


def prototypes():
    """name -> (result, parameters) as C text, of every LENSPROF_API function."""
    pattern = r"LENSPROF_API\s+(?:LENSPROF_MUST_USE\s+)?([\w\s*]+?)(lensprof_\w+)\(([^)]*)\)\s*;"
    return {name: (result, [] if parameters.strip() == "void" else parameters.split(","))
            for result, name, parameters in re.findall(pattern, header_text())}


class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        output = subprocess.run([os.environ["LENSPROF_ABI_DUMP"]], check=True, capture_output=True, text=True).stdout
        cls.c = json.loads(output)
        cls.headers = header_text()

    def test_every_struct_of_the_headers_is_compared(self):
        declared = set(re.findall(r"^\} (lensprof_\w+);", self.headers, flags=re.M))
        enumerations = set(re.findall(r"typedef enum (\w+)", self.headers))
        self.assertEqual(declared - enumerations, set(self.c["structs"]))
        self.assertEqual(set(self.c["structs"]), set(_abi.STRUCTS))
        opaque = set(re.findall(r"typedef struct (\w+) \1;", self.headers))
        self.assertEqual(opaque, set(_abi.OPAQUE))

    def test_sizes_and_offsets(self):
        for name, layout in self.c["structs"].items():
            struct = _abi.STRUCTS[name]
            with self.subTest(struct=name):
                self.assertEqual(ctypes.sizeof(struct), layout["size"])
                self.assertEqual(ctypes.alignment(struct), layout["alignment"])
                fields = {f[0]: [getattr(struct, f[0]).offset, getattr(struct, f[0]).size] for f in struct._fields_}
                self.assertEqual(fields, layout["fields"])
                self.assertEqual([f[0] for f in struct._fields_], list(layout["fields"]))

    def test_numpy_layouts(self):
        from lensprof import EXPOSURE_DTYPE, OBSERVATION_DTYPE, PAIR_DTYPE
        for name, dtype in {"lensprof_pair": PAIR_DTYPE, "lensprof_observation": OBSERVATION_DTYPE,
                            "lensprof_exposure": EXPOSURE_DTYPE}.items():
            self.assertEqual(dtype.itemsize, self.c["structs"][name]["size"])
            self.assertEqual({field: [offset, kind.itemsize] for field, (kind, offset) in dtype.fields.items()},
                             self.c["structs"][name]["fields"])

    def test_every_value_of_the_headers_is_compared(self):
        enumerators = re.findall(r"^\s+(LENSPROF_\w+)\s*=", self.headers, flags=re.M)
        numbers = re.findall(r"^#define (LENSPROF_\w+) [(\d]", self.headers, flags=re.M)
        self.assertGreater(len(enumerators), 60)
        self.assertEqual(set(enumerators + numbers), set(self.c["values"]))

    def test_values(self):
        ours = {prefix + member.name: member.value for prefix, enum in _abi.ENUMS.items() for member in enum}
        constants = {"LENSPROF_" + name: getattr(_abi, name) for name in
                     ("RESPONSE_SAMPLES", "EMOR_MODES", "GRID_SIDE", "COVARIANCE_MAX", "COVERAGE_BINS", "FLAT_IMAGES",
                      "FLAT_SPOTS", "UNKNOWN", "MODES_AUTO", "LOOKUP_ROWS", "STATS_GROUPS")}
        version = dict(zip(("LENSPROF_VERSION_MAJOR", "LENSPROF_VERSION_MINOR", "LENSPROF_VERSION_PATCH"),
                           map(int, _abi.VERSION.split("."))))
        self.assertEqual({**ours, **constants, **version}, self.c["values"])

    def test_every_function_of_the_headers_is_in_the_table_with_its_types(self):
        declared = prototypes()
        self.assertEqual(len(declared), len(re.findall(r"^LENSPROF_API ", self.headers, flags=re.M)))
        self.assertEqual(set(declared), set(_abi.FUNCTIONS))
        for name, (result, parameters) in declared.items():
            restype, argtypes = _abi.FUNCTIONS[name]
            with self.subTest(function=name):
                expected = ctypes.c_char_p if "char" in result else ctype_of(result)
                self.assertIs(restype, expected)
                self.assertEqual(argtypes, [ctype_of(parameter) for parameter in parameters])

    def test_every_function_is_exported(self):
        for name in _abi.FUNCTIONS:
            self.assertTrue(hasattr(_library.lib, name), name)

    def test_every_function_has_a_pythonic_face(self):
        sources = "".join(path.read_text() for path in PACKAGE.glob("*.py") if path.name != "_abi.py")
        for name in _abi.FUNCTIONS:
            self.assertRegex(sources, rf"lib(rary)?\.{name}\b")

    def test_callback_types(self):
        for name, kind in {"progress": _abi.Progress, "import_visitor": _abi.ImportVisitor,
                           "fault_visitor": _abi.FaultVisitor}.items():
            typedef = re.search(rf"typedef (\w+) \(\*lensprof_{name}\)\(([^)]*)\);", self.headers)
            self.assertIs(kind._restype_, ctype_of(typedef[1]))
            self.assertEqual(list(kind._argtypes_), [ctype_of(p) for p in typedef[2].split(",")])

    def test_everything_public_is_exported(self):
        import lensprof
        self.assertEqual(sorted(lensprof.__all__), lensprof.__all__)
        for name in lensprof.__all__:
            self.assertTrue(hasattr(lensprof, name), name)
        for enum in _abi.ENUMS.values():
            self.assertIn(enum.__name__, lensprof.__all__)


if __name__ == "__main__":
    unittest.main()
