"""Samples as a raw sensor delivers them, corrected in integers by a grid of gains; see lensprof/sensor.h.

Samples are arrays of uint16 of shape (height, width), one sample per pixel, in the mosaic of the readout.
"""
from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_float
from typing import Any, Optional

import numpy as np

from . import _abi, _arrays
from ._abi import Flip, Layout, Packing
from ._library import check, lib
from ._struct import Enumerated, OptionalReference, Struct, Value, Vector, _Field, default, integer
from ._types import Pixels
from .apply import ApplyOptions, _apply_packed, _apply_tile


class SensorLevels(Value, _abi.SensorLevels):
    """Codes without light (black, per plane of the mosaic) and at saturation (white)."""

    black: Vector = Vector()
    white: float = default


class Gains(_Field):
    """A grid of the caller: a copy as an array of float32, or None."""

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Optional[Pixels]:
        if instance is None:
            return self  # type: ignore[return-value]
        return vars(instance).get("_gains")

    def __set__(self, instance: Any, value: Optional[Pixels]) -> None:
        gains = None if value is None else np.array(value, dtype=np.float32, order="C")
        if gains is not None and (gains.ndim != 3 or not gains.size):
            raise ValueError(f"gains of shape {gains.shape}: give (planes, rows, columns)")
        vars(instance)["_gains"] = gains
        self.raw.__set__(instance, None if gains is None else gains.ctypes.data_as(POINTER(c_float)))
        if gains is not None:
            instance.rows, instance.columns = gains.shape[1:]


class Readout(Struct, _abi.Readout):
    """What a sensor reads of its frame. Default: the whole frame, one plane, a grid of 17 x 13.

    x, y, width, height: the window; width and height in samples, 0 = to the end of the frame. step: pixels of the frame
    per sample. flip: the direction of reading. side, plane, channel: the mosaic; set_mosaic sets them. columns, rows:
    of the grid, 2..33. gains: (planes, rows, columns), which multiply those of the options, or None; sets columns and
    rows. levels: SensorLevels of the input, None = those of the options; output_levels: None = the same.
    """

    x: int = default
    y: int = default
    width: int = default
    height: int = default
    step: int = default
    flip: Enumerated[Flip] = Enumerated(Flip)
    side: int = default
    plane: Vector = Vector()
    channel: Vector = Vector()
    columns: int = default
    rows: int = default
    gains: Gains = Gains()
    levels: OptionalReference[SensorLevels] = OptionalReference(SensorLevels)
    output_levels: OptionalReference[SensorLevels] = OptionalReference(SensorLevels)

    def set_mosaic(self, colors: str) -> None:
        """The colours of the samples as they are read, row by row: "G", "RGGB", "RGgB" (the greens apart), "RRGG..."."""
        check(lib.lensprof_readout_set_mosaic(byref(self), colors.encode()),
              f"mosaic {colors!r}: give 1, 4 or 16 letters of R, G, g, B, I, W, at most four different ones")

    def _check_gains(self) -> None:
        planes = 1 + max(self.plane[:self.side * self.side], default=0) if self.side <= 4 else 0
        if self.gains is not None and self.gains.shape != (planes, self.rows, self.columns):
            raise ValueError(f"gains of shape {self.gains.shape}: the readout has {planes} planes, {self.rows} rows and "
                             f"{self.columns} columns")


def _words(size: int, kind: type = np.uint32) -> Any:
    return np.zeros(size // np.dtype(kind).itemsize + 1, dtype=kind)


def mired_share(a_kelvin: int, b_kelvin: int, kelvin: int) -> int:
    """The share of b, 0..65536, for SensorPlan.mix: linear in mired between the temperatures of two plans."""
    return lib.lensprof_mired_share(integer(a_kelvin, "a_kelvin"), integer(b_kelvin, "b_kelvin"),
                                    integer(kelvin, "kelvin"))


class SensorPlan:
    """A grid of gains for what a sensor reads. data: the plan as bytes, which may be copied to a camera."""

    def __init__(self, options: ApplyOptions, readout: Readout):
        if not isinstance(options, ApplyOptions) or not isinstance(readout, Readout):
            raise TypeError("a SensorPlan is made of ApplyOptions and a Readout; of its data by SensorPlan.open(data)")
        readout._check_gains()
        self._memory = _words(lib.lensprof_sensor_plan_bytes(byref(readout)))
        self._plan, error = POINTER(_abi.SensorPlan)(), _abi.ErrorText()
        check(lib.lensprof_sensor_plan_init(self._memory.ctypes.data, self._memory.nbytes, byref(options),
                                            byref(readout), byref(self._plan), byref(error)),
              "these options cannot be applied by a grid of gains", error)

    @property
    def data(self) -> bytes:
        return self._memory.tobytes()[:int(self._memory[1])]

    @classmethod
    def _empty(cls, size: int) -> "SensorPlan":
        plan = cls.__new__(cls)
        plan._memory, plan._plan = _words(size), POINTER(_abi.SensorPlan)()
        return plan

    @classmethod
    def open(cls, data: bytes) -> "SensorPlan":
        """The plan from its `data`."""
        plan = cls._empty(len(data))
        plan._memory.view(np.uint8)[:len(data)] = np.frombuffer(data, dtype=np.uint8)
        check(lib.lensprof_sensor_plan_open(plan._memory.ctypes.data, len(data), byref(plan._plan)),
              "not the data of a SensorPlan of this version, or damaged; make it again")
        return plan

    @classmethod
    def mix(cls, a: "SensorPlan", b: "SensorPlan", share: int) -> "SensorPlan":
        """The plan between two: gains (1 - s) a + s b with s = share / 65536."""
        plan = cls._empty(a._memory.nbytes)
        check(lib.lensprof_sensor_plan_mix(plan._memory.ctypes.data, plan._memory.nbytes, a._plan, b._plan,
                                           integer(share, "share"), byref(plan._plan)),
              f"share {share} of two plans: give 0..65536, and plans that differ in their gains only")
        return plan

    def error(self, options: ApplyOptions, readout: Readout) -> float:
        """The largest relative error of the interpolated gains, against the options' own over the readout."""
        readout._check_gains()
        largest = c_double()
        check(lib.lensprof_sensor_plan_error(self._plan, byref(options), byref(readout), byref(largest)),
              "the error of a plan needs the options and the readout it was made of")
        return largest.value

    def apply(self, source: Pixels, out: Optional[Pixels] = None, *, x0: int = 0, y0: int = 0) -> Pixels:
        """Corrects a tile of uint16 samples whose first sample is (x0, y0) of the readout; returns `out`.

        out: an array of the tile's shape; `source` itself to work in place; a new one when None.
        """
        return _apply_tile(lib.lensprof_sensor_apply, self._plan, Layout.GREY, source, out, None, x0, y0)

    def apply_packed(self, source: Pixels, packing: Packing, width: int, out: Optional[Pixels] = None, *, x0: int = 0,
                     y0: int = 0) -> Pixels:
        """The same for packed rows (see lensprof.pack_rows)."""
        return _apply_packed(lib.lensprof_sensor_apply_packed, self._plan, source, packing, width, out, x0, y0)


class SensorFlat:
    """A flat field captured on a device: sums of the samples of an evenly lit picture. data: its memory as bytes."""

    def __init__(self, frame_width: int, frame_height: int, readout: Readout):
        readout._check_gains()
        self._memory = _words(lib.lensprof_sensor_flat_bytes(byref(readout)), np.uint64)
        self._flat, error = POINTER(_abi.SensorFlat)(), _abi.ErrorText()
        check(lib.lensprof_sensor_flat_init(self._memory.ctypes.data, self._memory.nbytes,
                                            integer(frame_width, "frame_width"), integer(frame_height, "frame_height"),
                                            byref(readout), byref(self._flat), byref(error)),
              "this readout cannot be captured", error)
        self._shape = (1 + int(max(readout.plane[:readout.side * readout.side])), readout.rows, readout.columns)

    @property
    def data(self) -> bytes:
        return self._memory.tobytes()[:int(self._memory.view(np.uint32)[1])]

    @classmethod
    def open(cls, data: bytes) -> "SensorFlat":
        """The flat field from the memory of a device."""
        flat = cls.__new__(cls)
        flat._memory, flat._flat = _words(len(data), np.uint64), POINTER(_abi.SensorFlat)()
        flat._memory.view(np.uint8)[:len(data)] = np.frombuffer(data, dtype=np.uint8)
        check(lib.lensprof_sensor_flat_open(flat._memory.ctypes.data, len(data), byref(flat._flat)),
              "not the memory of a flat field of this version, or damaged; copy it again")
        columns, rows = flat._memory.view(np.uint32)[9:11]  # src/core/sensor_flat.h
        flat._shape = (int(flat._memory.view(np.uint8)[17]), int(rows), int(columns))
        return flat

    def add(self, samples: Pixels, *, x0: int = 0, y0: int = 0) -> None:
        """Adds a tile of uint16 samples whose first sample is (x0, y0) of the readout."""
        view = _arrays.image(samples, Layout.GREY, what="samples")
        check(lib.lensprof_sensor_flat_add(self._flat, byref(view), integer(x0, "x0"), integer(y0, "y0")),
              f"samples {samples.shape} {samples.dtype} at ({x0}, {y0}): give uint16 that lie in the readout, of at most "
              "256 pictures")

    def gains(self) -> Pixels:
        """The gains that make the flat field even, (planes, rows, columns), for Readout.gains."""
        gains = np.empty(self._shape, dtype=np.float32)
        work = _words(lib.lensprof_sensor_flat_work_bytes(self._flat), np.uint64)
        error = _abi.ErrorText()
        check(lib.lensprof_sensor_flat_gains(self._flat, work.ctypes.data, work.nbytes,
                                             gains.ctypes.data_as(POINTER(c_float)), byref(error)),
              "this flat field has no gains", error)
        return gains
