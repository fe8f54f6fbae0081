"""The shared libraries: finding them, errors, and handles that must be released.

Search order: the file named by the environment variable LENSPROF_LIBRARY, the folder of this package (wheels have it
there), the system's loader. The photograph library is loaded when it is used first: LENSPROF_PHOTO_LIBRARY, the folder of
this package, that of the package lensprof_photo (a wheel of its own), that of the base library, the system's loader.
"""
from __future__ import annotations

import contextlib
import ctypes
import ctypes.util
import importlib.util
import os
import pathlib
import sys
import threading
import weakref
from typing import Any, Callable, Iterator, Optional, TypeVar

from . import _abi
from ._abi import ItemKind, Status

H = TypeVar("H", bound="Handle")


def _file_names(name: str = "lensprof") -> list[str]:
    if sys.platform == "win32":
        return [f"lib{name}.dll", f"{name}.dll"]  # wheels have the first, as MinGW names it
    if sys.platform == "darwin":
        return [f"lib{name}.0.3.dylib", f"lib{name}.dylib"]
    return [f"lib{name}.so.0.3", f"lib{name}.so"]


def _open(variable: str, name: str, folders: list[pathlib.Path], remedy: str) -> ctypes.CDLL:
    """The library that the environment variable names, else the one in a folder, else the system's. A file that exists but
    cannot be loaded is an error: another version elsewhere would be a surprise."""
    named = os.environ.get(variable)
    beside = [str(folder / file) for folder in folders for file in _file_names(name) if (folder / file).exists()]
    if named or beside:
        path = named or beside[0]
        try:
            return ctypes.CDLL(path)
        except OSError as error:
            raise ImportError(f"{variable}={path}: cannot be loaded ({error}); correct or unset it" if named else
                              f"{path}: cannot be loaded ({error}); install a lensprof for this system") from error
    found = ctypes.util.find_library(name)
    for file in _file_names(name) + ([found] if found else []):
        with contextlib.suppress(OSError):
            return ctypes.CDLL(file)
    raise ImportError(f"{remedy}, or set {variable} to the file {_file_names(name)[0]}")


def _find() -> ctypes.CDLL:
    return _open("LENSPROF_LIBRARY", "lensprof", [pathlib.Path(__file__).parent],
                 "the lensprof library is not installed; install it (`pip install lensprof` brings it)")


def _check_version(library: ctypes.CDLL) -> None:
    """While the major version is 0, structures may change with the minor one."""
    if not hasattr(library, "lensprof_version"):
        raise ImportError(f"{library._name}: is not the lensprof library; install lensprof or correct LENSPROF_LIBRARY")
    library.lensprof_version.restype = ctypes.c_char_p
    version = library.lensprof_version().decode()
    if version.split(".")[:2] != _abi.VERSION.split(".")[:2]:
        raise ImportError(f"{library._name}: is lensprof {version}, but this package is for {_abi.VERSION}; "
                          "install the two together")


def _load() -> ctypes.CDLL:
    library = _find()
    _check_version(library)
    _declare(library, _abi.FUNCTIONS)
    return library


def _declare(library: ctypes.CDLL, functions: dict[str, Any]) -> None:
    for name, (restype, argtypes) in functions.items():
        try:
            function = getattr(library, name)
        except AttributeError:
            raise ImportError(f"{library._name}: has no function {name}; install a complete lensprof") from None
        function.restype, function.argtypes = restype, argtypes


lib = _load()
_photo: Optional[ctypes.CDLL] = None


def photo() -> ctypes.CDLL:
    """The photograph library."""
    global _photo
    if _photo is None:
        package = importlib.util.find_spec("lensprof_photo")
        own = [pathlib.Path(place) for place in (package.submodule_search_locations or [])] if package else []
        folders = [pathlib.Path(__file__).parent, *own, pathlib.Path(lib._name).parent]
        library = _open("LENSPROF_PHOTO_LIBRARY", "lensprof-photo", folders,
                        "the photograph library of lensprof, which reads pictures and calibrates folders, is not installed; "
                        "install it (`pip install \"lensprof[photo]\"` on Linux x86-64, or `make install`)")
        _declare(library, _abi.PHOTO_FUNCTIONS)
        _photo = library
    return _photo


def initialise(struct: Any) -> None:
    """Calls the `_init` function of a raw or public structure, if it has one, which sets size and defaults."""
    for kind in type(struct).__mro__:
        if kind in _abi.INITS:
            name, sizes = _abi.INITS[kind]
            getattr(photo() if name in _abi.PHOTO_FUNCTIONS else lib, name)(ctypes.byref(struct), *map(ctypes.sizeof, sizes))


def initialised(kind: Any, **fields: object) -> Any:
    """A raw structure with its defaults and the given fields."""
    struct = kind()
    initialise(struct)
    for name, value in fields.items():
        setattr(struct, name, value)
    return struct


def version() -> str:
    """Version of the shared library, e.g. "0.3.0"."""
    return lib.lensprof_version().decode()


def status_name(status: int) -> str:
    """Name of a status in C, e.g. "LENSPROF_ERROR_SIZE"; "unknown status" for other numbers."""
    return lib.lensprof_status_name(status).decode()


class Error(Exception):
    """The library refused a call or failed.

    status: a lensprof.Status. text: a sentence that names the offending item and the next step. item_kind and
    item_index: that item if it has an index, otherwise ItemKind.NONE and 0.
    """

    def __init__(self, status: Status, text: str, item_kind: ItemKind = ItemKind.NONE, item_index: int = 0):
        super().__init__(status, text)
        self.status = status
        self.text = text
        self.item_kind = item_kind
        self.item_index = item_index

    def __str__(self) -> str:
        return f"{self.text} ({status_name(self.status)})"


def check(status: int, text: str, error: Any = None) -> None:
    """Raises lensprof.Error unless status is OK; `text` is used if the library gives no text."""
    if status != Status.OK:
        if error is None or not error.text:
            raise Error(Status(status), text)
        item = error.item
        raise Error(Status(status), error.text.decode("utf-8", "replace"), ItemKind(item.kind), item.index)


class Handle:
    """An object of the library that must be released. A context manager; `close` may be called twice.

    The library allows one thread at a time: calls from several threads wait for each other.
    """

    def __init__(self, pointer: Any, release: Callable[..., None]):
        self._pointer = pointer
        self._lock = threading.Lock()
        self._release = weakref.finalize(self, release, pointer)

    @contextlib.contextmanager
    def _use(self) -> Iterator[Any]:
        with self._lock:
            if not self._release.alive:
                raise ValueError(f"this {type(self).__name__} is closed; open it again")
            yield self._pointer

    def close(self) -> None:
        """Releases the memory and files of this object."""
        with self._lock:
            self._release()

    def __enter__(self: H) -> H:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


class SharedHandle(Handle):
    """A handle that several threads use at the same time, for instance a function that receives the progress of a call.
    What changes it, and `close`, raise ValueError while it is in use."""

    def __init__(self, pointer: Any, release: Callable[..., None]):
        super().__init__(pointer, release)
        self._users = 0

    @contextlib.contextmanager
    def _use(self) -> Iterator[Any]:
        with super()._use() as pointer:
            self._users += 1
        try:
            yield pointer
        finally:
            with self._lock:
                self._users -= 1

    @contextlib.contextmanager
    def _use_alone(self) -> Iterator[Any]:
        with super()._use() as pointer:
            self._refuse_users()
            yield pointer

    def close(self) -> None:
        """Releases the memory and files of this object."""
        with self._lock:
            self._refuse_users()
            self._release()

    def _refuse_users(self) -> None:
        if self._users:
            raise ValueError(f"this {type(self).__name__} is in use by another call; wait until that has returned")
