"""The types that public functions, methods and fields declare."""
import inspect
import tempfile
import typing
import unittest

import lensprof as lp
from lensprof import formats

OF_JSON = {"calibrate_folder.return"}  # whatever calibrate.json has


def public():
    """(name, object) of all that users may name."""
    for module, names in ((lp, lp.__all__), (formats, formats.__all__)):
        for name in names:
            yield name, getattr(module, name)


def methods(cls):
    """(name, function) of the public methods and properties that a class of the package defines."""
    for base in cls.__mro__:
        if base.__module__.startswith("lensprof"):
            for name, member in vars(base).items():
                if not name.startswith("_"):
                    yield name, getattr(member, "fget", None) or getattr(member, "__func__", member)


class Types(unittest.TestCase):
    def signatures(self):
        for name, one in public():
            if inspect.isfunction(one):
                yield name, one
            elif inspect.isclass(one):
                yield from ((f"{name}.{method}", function) for method, function in methods(one)
                            if inspect.isfunction(function) and hasattr(function, "__module__"))

    def test_every_signature_has_types(self):
        """Of overloaded functions, the implementation returns Any, and its overloads do not."""
        names = set()
        for name, function in self.signatures():
            is_overloaded = name.split(".")[-1] in ("eval", "eval_slope", "invert", "invert_slope", "r2")
            names.add(name)
            for parameter, details in inspect.signature(function).parameters.items():
                if parameter not in ("self", "cls"):
                    self.assertNotIn(details.annotation, (inspect.Parameter.empty, "Any"), f"{name}: {parameter}")
            found = inspect.signature(function).return_annotation
            self.assertIsNot(found, inspect.Signature.empty, name)
            if not is_overloaded and f"{name}.return" not in OF_JSON:
                self.assertNotRegex(found, r"\bAny\b", name)
        self.assertGreater(len(names), 100)
        self.assertIn("Store.get", names)

    def test_every_field_has_a_type(self):
        """What a structure shows is declared in its class, so that type checkers know it."""
        for name, cls in public():
            if inspect.isclass(cls) and hasattr(cls, "_names"):
                declared = {field for base in cls.__mro__ for field in vars(base).get("__annotations__", {})}
                declared |= {field for field in dir(cls) if isinstance(inspect.getattr_static(cls, field), property)}
                counts = {field for field in cls._names() if type(inspect.getattr_static(cls, field)).__name__ == "Count"}
                self.assertEqual(set(cls._names()) - counts - declared, set(), name)

    def test_enumerations_and_flags(self):
        for status in ("usable", "equalizes", "converged"):
            self.assertIs(type(getattr(lp.FitResult(), status)), bool)
        self.assertIs(type(lp.StoreRow().damaged), bool)
        self.assertIs(type(lp.Provenance().forced), bool)
        self.assertIs(type(lp.Camera().projection), lp.Projection)
        self.assertIsNone(lp.Provenance().created)
        self.assertIn("projection=<Projection.RECTILINEAR: 0>, width=640", repr(lp.Camera(width=640)))
        with tempfile.TemporaryDirectory() as folder, lp.Store(f"{folder}/p.db", lp.StoreMode.CREATE) as store:
            self.assertEqual(repr(store), f"Store('{folder}/p.db')")
        self.assertTrue(typing.get_type_hints(lp.CalibrateOptions))


if __name__ == "__main__":
    unittest.main()
