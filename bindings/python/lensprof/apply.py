"""Corrects (or simulates) falloff, exposure and white balance in the memory of NumPy arrays; see lensprof/apply.h.

Pictures have the shape (height, width) or (height, width, samples) and the type uint8 (0..255 = 0..1), uint16
(0..65535), float32 or float16 (0..1). Row strides are arbitrary, also negative: slices like a[10:20, 5:50] and a[::-1]
work.
"""
from __future__ import annotations

from ctypes import POINTER, byref
from typing import Any, Optional, Sequence

import numpy as np

from . import _abi, _arrays, packed
from ._abi import Direction, Encoding, Layout, Packing, SampleType, Saturated
from ._library import check, lib
from ._struct import Bytes, Count, Enumerated, Flag, Nested, OptionalReference, Referenced, Struct, default, integer
from ._types import Pixels
from .model import Exposure, GainGrid, ImageCircle, Levels, Response, Vignetting
from .profile import Profile


def layout_samples(layout: Layout) -> int:
    """Samples per pixel, 1..4."""
    return lib.lensprof_layout_samples(Layout(layout))


def layout_channels(layout: Layout) -> int:
    """Colour channels per pixel, 1 or 3."""
    return lib.lensprof_layout_channels(Layout(layout))


def sample_type_bytes(sample: SampleType) -> int:
    """Bytes of one sample: 1, 2 or 4."""
    return lib.lensprof_sample_type_bytes(SampleType(sample))


class ApplyOptions(Struct, _abi.ApplyOptions):
    """Options of a Plan. Defaults: correct, encoded input and output, uint8 RGB in and out, 0 EV; frame, response and
    vignetting must be given.

    frame_width, frame_height: the full frame, px. response and vignetting: one for all channels, or three. source:
    exposure and white balance of the picture. target: the wanted ones. grid: a GainGrid multiplied by the vignetting,
    or None. strength: 0..1 of the falloff. gain_cap: the largest gain for the falloff, 1..1e6, or 0. dither: dither
    instead of rounding, for uint8 output. blob: a result of Profile.pack, instead of response, vignetting and grid, or
    None. chroma: correct only the colour of the falloff, luminance stays. output_response: one response or three that
    encode the output instead; None = those of the model. levels: of the input, or None; output_levels: of the output,
    the same to put black back. image_circle: pixels outside of it keep their falloff; None = none.
    """

    direction: Enumerated[Direction] = Enumerated(Direction)
    input: Enumerated[Encoding] = Enumerated(Encoding)
    output: Enumerated[Encoding] = Enumerated(Encoding)
    frame_width: int = default
    frame_height: int = default
    source_sample: Enumerated[SampleType] = Enumerated(SampleType)
    source_layout: Enumerated[Layout] = Enumerated(Layout)
    target_sample: Enumerated[SampleType] = Enumerated(SampleType)
    saturated: Enumerated[Saturated] = Enumerated(Saturated)
    responses = Count()
    vignettings = Count()
    response: Referenced[Response] = Referenced(Response, "responses")
    vignetting: Referenced[Vignetting] = Referenced(Vignetting, "vignettings")
    source: Nested[Exposure] = Nested(Exposure)
    target: Nested[Exposure] = Nested(Exposure)
    grid: OptionalReference[GainGrid] = OptionalReference(GainGrid)
    strength: float = default
    gain_cap: float = default
    dither: Flag = Flag()
    blob: Bytes = Bytes("blob_bytes")
    blob_bytes = Count("assign blob")
    output_response: Referenced[Response] = Referenced(Response, "output_responses", optional=True)
    output_responses = Count("assign output_response")
    chroma: Flag = Flag()
    levels: OptionalReference[Levels] = OptionalReference(Levels)
    output_levels: OptionalReference[Levels] = OptionalReference(Levels)
    image_circle: OptionalReference[ImageCircle] = OptionalReference(ImageCircle)

    def set_profile(self, profile: Profile) -> None:
        """Sets response, vignetting, grid, levels and image circle from a copy of the profile, replacing previous values."""
        own = Profile._copy_of(byref(profile))
        check(lib.lensprof_apply_options_set_profile(byref(self), byref(own)), "not a profile")
        shown: Any = _abi.Profile.from_buffer(own)

        def pointed(name: str, value: Any) -> Any:
            return [value] if getattr(_abi.ApplyOptions, name).__get__(self) else ()

        vars(self).update(_response=shown.response[:own.responses], _vignetting=shown.vignetting[:own.vignettings],
                          _grid=pointed("grid", shown.grid), _blob=None, _levels=pointed("levels", shown.levels),
                          _output_levels=pointed("output_levels", shown.levels),
                          _image_circle=pointed("image_circle", shown.image_circle))


def _apply_tile(apply: Any, plan: Any, layout: Layout, source: Pixels, out: Optional[Pixels], dtype: Any, x0: int,
                y0: int) -> Pixels:
    """By the function `apply` of the library; to an array of `dtype` (None: of the source's) unless out is given."""
    view = _arrays.image(source, layout, what="source")
    if out is None:
        out = np.empty(source.shape, dtype=dtype or source.dtype)
    target = _arrays.target(out, layout)
    check(apply(plan, byref(view), byref(target), integer(x0, "x0"), integer(y0, "y0")),
          f"source {source.shape} {source.dtype} and out {out.shape} {out.dtype} at ({x0}, {y0}): both must have the "
          "plan's sample types, the same size, lie in the frame, and be the same array or apart")
    return out


def _apply_packed(apply: Any, plan: Any, source: Pixels, packing: Packing, width: int, out: Optional[Pixels], x0: int,
                  y0: int) -> Pixels:
    """By the function `apply` of the library."""
    read = packed.view(source, packing, width, "source")
    if out is None:
        out = np.zeros((len(source), packed.row_bytes(packing, width)), dtype=np.uint8)
    target = packed.view(out, packing, width, "out", writable=True)
    check(apply(plan, packing, byref(_abi.PackedImage.from_buffer_copy(read)), byref(target), integer(x0, "x0"),
                integer(y0, "y0")),
          f"packed rows of {len(source)} x {width} samples and out of {len(out)} rows at ({x0}, {y0}): the plan must be of "
          "uint16 grey or a mosaic, both must have the same height, lie in the frame, and be the same array or apart")
    return out


class Plan:
    """A plan prepared for one picture; may be applied to any of its tiles, by several threads simultaneously."""

    def __init__(self, options: ApplyOptions):
        size = lib.lensprof_plan_bytes(byref(options))
        self._memory = np.zeros(size // 8 + 1, dtype=np.uint64)
        self._plan = POINTER(_abi.Plan)()
        error = _abi.ErrorText()
        check(lib.lensprof_plan_init(self._memory.ctypes.data, self._memory.nbytes, byref(options), byref(self._plan),
                                     byref(error)), "these options cannot be applied", error)
        self._layout = options.source_layout
        self._target_dtype = _arrays.sample_dtype(options.target_sample)

    def apply(self, source: Pixels, out: Optional[Pixels] = None, *, x0: int = 0, y0: int = 0) -> Pixels:
        """Applies the plan to a tile whose upper left pixel is (x0, y0) of the frame; returns `out`.

        out: an array of the tile's shape and the target's type; `source` itself to work in place; a new one when None.
        """
        return _apply_tile(lib.lensprof_apply, self._plan, self._layout, source, out, self._target_dtype, x0, y0)

    def apply_packed(self, source: Pixels, packing: Packing, width: int, out: Optional[Pixels] = None, *, x0: int = 0,
                     y0: int = 0) -> Pixels:
        """The same for packed rows of a sensor (see lensprof.pack_rows); the plan is of uint16, grey or a mosaic."""
        return _apply_packed(lib.lensprof_apply_packed, self._plan, source, packing, width, out, x0, y0)

    def apply_planar(self, source: Sequence[Pixels], out: Optional[Sequence[Pixels]] = None, *, x0: int = 0,
                     y0: int = 0) -> Sequence[Pixels]:
        """The same for three planes, red, green and blue, of shape (height, width); the plan's layout is PLANAR.

        out: three arrays, each its source itself to work in place; new ones when None.
        """
        if out is None:
            out = [np.empty(plane.shape, dtype=self._target_dtype) for plane in source]
        if len(source) != 3 or len(out) != 3:
            raise ValueError(f"{len(source)} planes and {len(out)} for the result: give red, green and blue")
        planes = (_abi.Image * 3)(*(_arrays.image(p, Layout.GREY, what="source") for p in source))
        targets = (_abi.Target * 3)(*(_arrays.target(p, Layout.GREY) for p in out))
        check(lib.lensprof_apply_planar(self._plan, planes, targets, integer(x0, "x0"), integer(y0, "y0")),
              f"planes of {source[0].shape} {source[0].dtype} at ({x0}, {y0}): all must have the plan's sample types and one "
              "size, lie in the frame, and each result be its source or apart from all")
        return out


class FixedPlan:
    """A plan in integers, for processors without floating point; see lensprof/fixed.h.

    data: the plan as bytes, which may be copied to a camera; FixedPlan.open turns them into a plan.
    """

    def __init__(self, options: ApplyOptions):
        if not isinstance(options, ApplyOptions):
            raise TypeError("a FixedPlan is made of ApplyOptions; of its data by FixedPlan.open(data, layout)")
        size = lib.lensprof_fixed_plan_bytes(byref(options))
        self._memory = np.zeros(size // 4 + 1, dtype=np.uint32)
        self._plan, error = POINTER(_abi.FixedPlan)(), _abi.ErrorText()
        check(lib.lensprof_fixed_plan_init(self._memory.ctypes.data, self._memory.nbytes, byref(options),
                                           byref(self._plan), byref(error)),
              "these options cannot be applied in integers", error)
        self.data = self._memory.tobytes()[:size]
        self._layout = options.source_layout
        self._target_dtype: Any = _arrays.sample_dtype(options.target_sample)

    @classmethod
    def open(cls, data: bytes, layout: Layout) -> "FixedPlan":
        """The plan from its `data`, for pictures of the given layout. If it is between uint8 and uint16, give `out`."""
        plan = cls.__new__(cls)
        plan._memory = np.frombuffer(bytearray(data) + bytes(-len(data) % 4), dtype=np.uint32)
        plan._plan = POINTER(_abi.FixedPlan)()
        check(lib.lensprof_fixed_plan_open(plan._memory.ctypes.data, len(data), byref(plan._plan)),
              "not the data of a FixedPlan of this version, or damaged; make it again")
        plan.data, plan._layout, plan._target_dtype = bytes(data), Layout(layout), None
        return plan

    def apply(self, source: Pixels, out: Optional[Pixels] = None, *, x0: int = 0, y0: int = 0) -> Pixels:
        """As Plan.apply."""
        return _apply_tile(lib.lensprof_fixed_apply, self._plan, self._layout, source, out, self._target_dtype, x0, y0)

    def apply_packed(self, source: Pixels, packing: Packing, width: int, out: Optional[Pixels] = None, *, x0: int = 0,
                     y0: int = 0) -> Pixels:
        """As Plan.apply_packed."""
        return _apply_packed(lib.lensprof_fixed_apply_packed, self._plan, source, packing, width, out, x0, y0)


def _apply(direction: Direction, array: Pixels, profile: Profile, out: Optional[Pixels],
           layout: Optional[Layout], **fields: Any) -> Pixels:
    view = _arrays.image(array, layout)
    target = view.sample if out is None else _arrays.target(out, layout).sample
    options = ApplyOptions(direction=direction, frame_width=view.width, frame_height=view.height,
                           source_sample=view.sample, source_layout=view.layout, target_sample=target,
                           **{name: value for name, value in fields.items() if value is not None})
    options.set_profile(profile)
    return Plan(options).apply(array, out)


def correct(array: Pixels, profile: Profile, *, source: Optional[Exposure] = None,
            target: Optional[Exposure] = None, saturated: Optional[Saturated] = None,
            strength: Optional[float] = None, gain_cap: Optional[float] = None, dither: Optional[bool] = None,
            layout: Optional[Layout] = None, out: Optional[Pixels] = None) -> Pixels:
    """Removes the falloff (and gain grid) of a profile from a full frame, and changes exposure and white balance from
    source to target.

    source, target: None = 0 EV. strength, gain_cap, dither: as in ApplyOptions. layout: None = grey, RGB or RGBA by the
    number of samples. out: `array` itself to work in place, another array (its type is used), or None for a new one.
    Returns out.
    """
    return _apply(Direction.CORRECT, array, profile, out, layout, source=source, target=target, saturated=saturated,
                  strength=strength, gain_cap=gain_cap, dither=dither)


def simulate(array: Pixels, profile: Profile, *, source: Optional[Exposure] = None,
             target: Optional[Exposure] = None, layout: Optional[Layout] = None,
             out: Optional[Pixels] = None) -> Pixels:
    """The inverse of `correct`, up to clipping: what the camera would record."""
    return _apply(Direction.SIMULATE, array, profile, out, layout, source=source, target=target)
