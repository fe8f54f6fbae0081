"""The tables of lensprof._abi compared with the C compiler (abi_dump), the headers and the shared library.

The tables are generated (make_abi.py, test_make_abi.py). Here they are checked independently: sizes, offsets and values
by the compiler, completeness by counting lines of the headers.
"""
import ctypes
import os
import pathlib
import re
import subprocess
import unittest
from enum import IntEnum, IntFlag

from lensprof import _abi, _library

PACKAGE = pathlib.Path(_abi.__file__).parent


def header_text():
    """All public headers without comments."""
    folder = pathlib.Path(os.environ["LENSPROF_INCLUDE"])
    text = "\n".join(path.read_text() for path in sorted(folder.glob("*.h")))
    return re.sub(r"/\*.*?\*/", "", text, flags=re.S)


def compiled():
    """The output of abi_dump: {struct: (size, alignment)}, {struct: {field: (offset, size)}}, {constant: value}."""
    output = subprocess.run([os.environ["LENSPROF_ABI_DUMP"]], check=True, capture_output=True, text=True).stdout
    structs, fields, values = {}, {}, {}
    for kind, name, *rest in map(str.split, output.splitlines()):
        if kind == "struct":
            structs[name], fields[name] = tuple(map(int, rest)), {}
        elif kind == "field":
            fields[name][rest[0]] = tuple(map(int, rest[1:]))
        else:
            values[name] = float(rest[0])
    return structs, fields, values


class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.structs, cls.fields, cls.values = compiled()
        cls.headers = header_text()

    def count(self, pattern):
        return len(re.findall(pattern, self.headers, flags=re.M))

    def test_nothing_of_the_headers_is_missing(self):
        self.assertEqual(self.count(r"^LENSPROF_API "), len(_abi.FUNCTIONS) + len(_abi.PHOTO_FUNCTIONS))
        self.assertEqual(self.count(r"^typedef enum "), len(set(_abi.ENUMS) - {"LENSPROF_FREE_"}))  # in a macro
        self.assertEqual(self.count(r"^typedef struct \w+ \{"), len(self.structs))
        self.assertEqual(self.count(r"^typedef struct (\w+) \1;"), len(_abi.OPAQUE))
        self.assertEqual(self.count(r"^typedef [\w *]+\(\*"), len(_abi.CALLBACKS))
        self.assertEqual(self.count(r"^\s+LENSPROF_\w+\s*=") + self.count(r"^#define LENSPROF_\w+ [(\d]"),
                         len(self.values))

    def test_sizes_and_offsets(self):
        self.assertEqual(set(self.structs), set(_abi.STRUCTS))
        for name, struct in _abi.STRUCTS.items():
            with self.subTest(struct=name):
                self.assertEqual((ctypes.sizeof(struct), ctypes.alignment(struct)), self.structs[name])
                ours = [(f[0], (getattr(struct, f[0]).offset, getattr(struct, f[0]).size)) for f in struct._fields_]
                self.assertEqual(ours, list(self.fields[name].items()))

    def test_numpy_layouts(self):
        from lensprof import EXPOSURE_DTYPE, OBSERVATION_DTYPE, PAIR_DTYPE
        for name, dtype in {"lensprof_pair": PAIR_DTYPE, "lensprof_observation": OBSERVATION_DTYPE,
                            "lensprof_exposure": EXPOSURE_DTYPE}.items():
            self.assertEqual(dtype.itemsize, self.structs[name][0])
            self.assertEqual({field: (offset, kind.itemsize) for field, (kind, offset) in dtype.fields.items()},
                             self.fields[name])

    def test_values(self):
        ours = {prefix + member.name: member.value for prefix, enum in _abi.ENUMS.items() for member in enum.__members__.values()}
        ours.update(zip(("LENSPROF_VERSION_MAJOR", "LENSPROF_VERSION_MINOR", "LENSPROF_VERSION_PATCH"),
                        map(int, _abi.VERSION.split("."))))
        ours.update(("LENSPROF_" + name, value) for name, value in vars(_abi).items()
                    if isinstance(value, (int, float)))
        self.assertEqual(ours, self.values)

    def test_every_function_is_exported(self):
        for name in _abi.FUNCTIONS:
            self.assertTrue(hasattr(_library.lib, name), name)

    def test_every_function_has_a_pythonic_face(self):
        sources = "".join(path.read_text() for path in PACKAGE.glob("*.py") if path.name != "_abi.py")
        # one call for arrays is for numbers, too
        others = {name for name in _abi.FUNCTIONS if f"{name}_many" in _abi.FUNCTIONS}
        others |= {"lensprof_correct",  # lensprof.correct makes a plan, which has more options
                   "lensprof_fit_bytes", "lensprof_flat_bytes"}  # the library allocates
        for name in set(_abi.FUNCTIONS) - {name for name, _ in _abi.INITS.values()} - others:
            self.assertRegex(sources, rf"lib(rary)?\.{name}\b")

    def test_structures_with_a_size_have_it_set_by_their_init(self):
        sized = {name: struct for name, struct in _abi.STRUCTS.items() if struct._fields_[0][0] == "struct_size"}
        self.assertGreater(len(sized), 5)
        for name, struct in sized.items():
            with self.subTest(struct=name):
                if f"{name}_init_sized" in _abi.FUNCTIONS and struct not in _abi.INITS:
                    continue  # takes more than sizes: its class calls it
                self.assertEqual(_library.initialised(struct).struct_size, ctypes.sizeof(struct))

    def test_everything_public_is_exported(self):
        import lensprof
        self.assertEqual(sorted(lensprof.__all__), lensprof.__all__)
        for name in lensprof.__all__:
            self.assertTrue(hasattr(lensprof, name), name)
        formats = lensprof.formats.__all__
        self.assertEqual(sorted(formats), formats)
        for enum in _abi.ENUMS.values():
            self.assertTrue((enum.__name__ in lensprof.__all__) != (enum.__name__ in formats), enum)
            self.assertTrue(issubclass(enum, (IntEnum, IntFlag)))


if __name__ == "__main__":
    unittest.main()
