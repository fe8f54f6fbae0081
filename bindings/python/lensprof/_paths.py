"""Paths and texts of files, as Python and the library have them."""
from __future__ import annotations

import os
from ctypes import c_char_p
from typing import Any, Iterable, Optional, Sequence, Union

PathLike = Union[str, os.PathLike[str]]

Source = Union[PathLike, bytes, bytearray, memoryview]
"""A file: its path, or its content as bytes."""


def raw_path(path: PathLike) -> bytes:
    raw = os.fsencode(path)
    if b"\0" in raw:
        raise ValueError(f"{path!r}: has a zero character; no file has such a name")
    return raw


def raw_text(value: str, what: str = "a name") -> bytes:
    """A text for C, which ends at a zero byte."""
    if "\0" in value:
        raise ValueError(f"{value!r}: {what} holds no zero bytes")
    return value.encode("utf-8", "surrogateescape")


def optional_text(value: Optional[str]) -> Optional[bytes]:
    return None if value is None else raw_text(value)


def optional_path(path: Optional[PathLike]) -> Optional[bytes]:
    return None if path is None else raw_path(path)


def text(value: Optional[bytes]) -> str:
    return os.fsdecode(value or b"")


def raw_paths(paths: Union[PathLike, Iterable[PathLike]]) -> tuple[Any, int]:
    """One path or several as an array of C, and their number."""
    names = [raw_path(path) for path in ([paths] if isinstance(paths, (str, os.PathLike)) else paths)]
    return (c_char_p * max(len(names), 1))(*names), len(names)


def set_databases(options: Any, databases: Sequence[PathLike]) -> None:
    """Sets the databases of raw options, which keep the array alive."""
    raw: Any = next(base for base in type(options).__mro__ if "_fields_" in vars(base))
    array, count = raw_paths(databases)
    raw.databases.__set__(options, array)
    raw.database_count.__set__(options, count)
