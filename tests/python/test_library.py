"""Finding the shared library, errors and handles."""
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import unittest.mock

import lensprof as lp
from lensprof import _abi, _library
from support import refused

PACKAGE = pathlib.Path(lp.__file__).parent


def run_python(code, **environment):
    """A new interpreter with these environment variables in addition to the current ones; None removes one."""
    wanted = {**os.environ, **environment}
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                          env={name: value for name, value in wanted.items() if value is not None})


class Finding(unittest.TestCase):
    def test_file_names_of_the_wheels(self):
        """Those that packaging/wheels/inspect_wheel.py requires."""
        for system, name in (("win32", "liblensprof.dll"), ("darwin", "liblensprof.dylib"), ("linux", "liblensprof.so")):
            with unittest.mock.patch.object(_library.sys, "platform", system):
                self.assertIn(name, _library._file_names())

    def test_variable_that_names_no_library(self):
        result = run_python("import lensprof", LENSPROF_LIBRARY="/nowhere/liblensprof.so")
        self.assertIn("ImportError: LENSPROF_LIBRARY=/nowhere/liblensprof.so: cannot be loaded", result.stderr)

    def test_library_beside_the_package(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "lensprof"
            shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
            shutil.copy(os.environ["LENSPROF_LIBRARY"], copy / "liblensprof.so.0.3")
            result = run_python("import lensprof; print(lensprof._library.lib._name)", LENSPROF_LIBRARY=None,
                                PYTHONPATH=folder)
            self.assertEqual(result.stdout.strip(), str(copy / "liblensprof.so.0.3"), result.stderr)

    def test_library_beside_the_package_that_is_damaged(self):
        """It is named. The system's library, which may be another version, does not take its place."""
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "lensprof"
            shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
            damaged = copy / "liblensprof.so"
            damaged.write_bytes(b"no library")
            result = run_python("import lensprof", LENSPROF_LIBRARY=None, PYTHONPATH=folder)
            self.assertIn(f"ImportError: {damaged}: cannot be loaded (", result.stderr)
            self.assertIn("install a lensprof for this system", result.stderr)

    def test_library_of_the_loader(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(os.environ["LENSPROF_LIBRARY"], pathlib.Path(folder) / "liblensprof.so.0.3")
            result = run_python("import lensprof; print(lensprof._library.lib._name)", LENSPROF_LIBRARY=None,
                                LD_LIBRARY_PATH=folder)
            self.assertEqual(result.stdout.strip(), "liblensprof.so.0.3", result.stderr)

    def test_no_library_at_all(self):
        code = "import ctypes, ctypes.util\ndef refuse(name): raise OSError\nctypes.CDLL = refuse\n" \
               "ctypes.util.find_library = lambda name: None\nimport lensprof"
        result = run_python(code, LENSPROF_LIBRARY=None)
        self.assertIn("ImportError: the lensprof library is not installed", result.stderr)

    def test_other_version(self):
        class Old:
            _name = "old.so"

            class lensprof_version:
                restype = None

                def __new__(cls):
                    return b"0.1.0"
        with self.assertRaisesRegex(ImportError, "old.so: is lensprof 0.1.0, but this package is for 0.3"):
            _library._check_version(Old)

    def test_version(self):
        self.assertEqual(lp.version(), _abi.VERSION)
        self.assertEqual(lp.__version__, _abi.VERSION)


class Errors(unittest.TestCase):
    def test_names_of_all_statuses(self):
        for status in lp.Status:
            self.assertEqual(lp.status_name(status), "LENSPROF_" + status.name)
        self.assertEqual(lp.status_name(77), "unknown status")

    def test_text_of_the_library_or_of_the_call(self):
        with refused(self, lp.Status.ERROR_SYNTAX) as caught:
            lp.formats.read_points(b"0 1 nonsense")
        self.assertIn("line 1", caught.exception.text)
        self.assertIn("LENSPROF_ERROR_SYNTAX", str(caught.exception))
        with refused(self, lp.Status.ERROR_RESPONSE) as caught:
            lp.Response.from_gamma(99)
        self.assertEqual(caught.exception.text, "gamma 99: give 0.1..10")

    def test_error_can_be_pickled(self):
        error = pickle.loads(pickle.dumps(lp.Error(lp.Status.ERROR_BUSY, "in use")))
        self.assertEqual((error.status, error.text), (lp.Status.ERROR_BUSY, "in use"))


class Handles(unittest.TestCase):
    def test_released_once(self):
        released = []
        handle = _library.Handle("pointer", released.append)
        with handle:
            with handle._use() as pointer:
                self.assertEqual(pointer, "pointer")
        handle.close()
        self.assertEqual(released, ["pointer"])
        with self.assertRaisesRegex(ValueError, "closed"):
            with handle._use():
                pass

    def test_released_with_the_object(self):
        released = []
        handle = _library.Handle("pointer", released.append)
        del handle
        self.assertEqual(released, ["pointer"])

    def test_one_thread_at_a_time(self):
        handle, inside, most = _library.Handle(None, lambda pointer: None), [], []

        def work():
            for _ in range(200):
                with handle._use():
                    inside.append(1)
                    most.append(len(inside))
                    inside.pop()
        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(max(most), 1)


if __name__ == "__main__":
    unittest.main()
