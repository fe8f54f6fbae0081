"""Rows of raw sensors as MIPI CSI-2 sends them, with 10, 12 or 14 bits per sample; see lensprof/packed.h.

Packed rows are arrays of uint8 of the shape (height, bytes); a row may have more bytes than its samples take.
"""
from __future__ import annotations

from ctypes import c_uint8, c_uint16
from typing import Any

import numpy as np

from . import _abi, _arrays
from ._abi import Layout, Packing
from ._library import check, lib
from ._struct import integer
from ._types import Pixels


def row_bytes(packing: Packing, width: int) -> int:
    """Bytes that a row of `width` samples takes."""
    size = lib.lensprof_packed_row_bytes(Packing(packing), integer(width, "width"))
    if not size:
        raise ValueError(f"a row of {width} samples has no whole number of groups of {Packing(packing).name}: 2 samples "
                         "of RAW12, 4 of RAW10 and RAW14")
    return size


def view(array: Pixels, packing: Packing, width: int, what: str, writable: bool = False) -> Any:
    """A view on packed rows; the caller keeps the array alive."""
    rows = _arrays.image(array, Layout.GREY, what, writable=writable)
    if array.dtype != np.uint8:
        raise TypeError(f"{what} of type {array.dtype} is not packed rows; give uint8")
    if array.shape[1] < row_bytes(packing, width):
        raise ValueError(f"{what} has {array.shape[1]} bytes per row; {width} samples of {Packing(packing).name} take "
                         f"{row_bytes(packing, width)}")
    raw: Any = _abi.PackedTarget
    return raw(rows.data, rows.row_bytes, width, rows.height)


def unpack_rows(packed: Pixels, packing: Packing, width: int) -> Pixels:
    """The codes of packed rows, 0..2**bits - 1, as an array of uint16 of shape (height, width)."""
    view(packed, packing, width, "packed")
    samples = np.empty((len(packed), width), dtype=np.uint16)
    for row, to in zip(packed, samples):
        check(lib.lensprof_unpack_row(packing, _arrays.address(row, c_uint8), width, _arrays.address(to, c_uint16)),
              "the row cannot be unpacked")
    return samples


def pack_rows(samples: Pixels, packing: Packing) -> Pixels:
    """The inverse of unpack_rows: uint16 of shape (height, width) to packed rows. Codes above the range are clipped."""
    _arrays.image(samples, Layout.GREY, "samples")
    if samples.dtype != np.uint16:
        raise TypeError(f"samples of type {samples.dtype} cannot be packed; give uint16")
    width = samples.shape[1]
    packed = np.empty((len(samples), row_bytes(packing, width)), dtype=np.uint8)
    for row, to in zip(samples, packed):
        check(lib.lensprof_pack_row(packing, _arrays.address(row, c_uint16), width, _arrays.address(to, c_uint8)),
              "the row cannot be packed")
    return packed
