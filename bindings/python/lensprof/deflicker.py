"""Exposures of the frames of a stationary camera, and the smooth curve that levels them; see lensprof/deflicker.h."""
from __future__ import annotations

import math
from ctypes import POINTER, byref, c_double
from typing import Any, Iterable, Optional, Sequence, Union

import numpy as np

from . import _abi, _arrays
from ._abi import DeflickerTo, Layout, SampleType
from ._library import Handle, check, initialised, lib
from ._struct import Flag, Struct, default
from ._types import Pixels, Records
from .apply import ApplyOptions, Plan
from .model import Exposure, GainGrid, Response, Vignetting


class DeflickerResult(Struct, _abi.DeflickerResult):
    """What was measured.

    frames: added, of which `levelled` have an exposure. segments: 1 + number of cuts. repeated: frames that repeat the
    one before. moving: the camera moves too far from frame to frame; motion: median shift, share of the longer side.
    unlinked: share of the frames that agree with none before them. flicker: median difference of a frame from the mean
    of its neighbours, EV. tone_error: how far ratios of dark and bright cells differ, as a share; the response is wrong
    if it is large. known_range: of the settings, EV; NaN if any is unknown.
    """

    frames: int = default
    levelled: int = default
    segments: int = default
    repeated: int = default
    moving: Flag = Flag()
    motion: float = default
    unlinked: float = default
    flicker: float = default
    tone_error: float = default
    known_range: float = default


class Deflickered(Handle):
    """Levels of frames. result: DeflickerResult; frames: an array with one element per frame, DEFLICKER_FRAME_DTYPE; wanted:
    the exposures that the frames should have, EXPOSURE_DTYPE; window: s (or frames) that shaped them, 0 = none."""

    result: DeflickerResult
    frames: Records
    wanted: Records
    window: float
    _response: "tuple[Response, ...]"
    _layout: Optional[Layout]

    def target(self, to: Union[str, int, DeflickerTo, Sequence[float]] = "smooth", window: float = 0.0) -> None:
        """Changes `wanted`. to: "smooth", "light" (needs settings_ev), "mean", the index of a frame, or an EV per frame;
        window: of "smooth" and "light", s (frames without times); 0 = the best."""
        target: Any = initialised(_abi.DeflickerTarget, window_s=window)
        curve: Any = None
        if isinstance(to, str):
            if to.upper() not in DeflickerTo.__members__ or to.upper() in ("FRAME", "CURVE"):
                raise ValueError(f'to: {to!r} is neither "smooth", "light", "mean", the index of a frame nor a list')
            target.to = DeflickerTo[to.upper()]
        elif isinstance(to, DeflickerTo):
            target.to = to
        elif isinstance(to, int):
            target.to, target.frame = DeflickerTo.FRAME, to
        else:
            if len(to) != len(self.frames):
                raise ValueError(f"to: {len(to)} values for {len(self.frames)} frames; give one for each")
            curve = (c_double * len(to))(*to)
            target.to, target.curve = DeflickerTo.CURVE, curve
        wanted, used, error = (_abi.Exposure * len(self.frames))(), c_double(), _abi.ErrorText()
        check(lib.lensprof_deflicker_curve(self._pointer, byref(target), wanted, len(wanted), byref(used), byref(error)),
              "no curve", error)
        self.wanted, self.window = np.frombuffer(bytes(wanted), dtype=_arrays.EXPOSURE_DTYPE).copy(), used.value

    def shading(self, index: int) -> GainGrid:
        """What else differs between this frame and the others: flicker of lines, falloff of its aperture."""
        grid, error = GainGrid(), _abi.ErrorText()
        check(lib.lensprof_deflicker_shading(self._pointer, index, byref(grid), byref(error)), f"no frame {index}", error)
        return grid

    def level(self, index: int, frame: Pixels, out: Optional[Pixels] = None) -> Pixels:
        """Frame `index` at its wanted exposure: `frame` is its array, at any size. out: as in Plan.apply. 8 bit frames are
        dithered, because flicker of half a level is visible in smooth areas."""
        view = _arrays.image(frame, self._layout)
        is_float = view.sample not in (SampleType.U8, SampleType.U16)
        response = self._response or (Response.linear() if is_float else Response.srgb(),)
        options = ApplyOptions(frame_width=view.width, frame_height=view.height, source_sample=SampleType(view.sample),
                               target_sample=SampleType(view.sample), source_layout=view.layout, response=response,
                               vignetting=Vignetting(), dither=view.sample == SampleType.U8,
                               source=_exposure(self.frames["exposure"][index]), target=_exposure(self.wanted[index]))
        shading = self.shading(index)
        if shading.columns:
            options.grid = shading
        return Plan(options).apply(frame, out)


def _exposure(record: Any) -> Exposure:
    return Exposure(ev=float(record["ev"]), white_balance=[float(factor) for factor in record["white_balance"]])


def deflicker(frames: Iterable[Pixels], *, times: Optional[Iterable[float]] = None,
              settings_ev: Optional[Iterable[float]] = None, f_numbers: Optional[Iterable[float]] = None,
              response: Union[Response, Iterable[Response], None] = None,
              to: Union[str, int, DeflickerTo, Sequence[float]] = "smooth", window: float = 0.0, rows: bool = False,
              region: Sequence[float] = (0.0, 0.0, 0.0, 0.0), layout: Optional[Layout] = None) -> Deflickered:
    """Measures the exposures of the frames of a stationary camera, and the curve that levels them.

    frames: arrays (height, width) or (height, width, 3) of uint8, uint16 or float32, in order; they are read one after
    the other, and not kept. times: s, one per frame. settings_ev: exposures by the settings of the camera (settings_ev),
    for to="light". f_numbers: apertures, whose falloffs are then compared. response: None = sRGB for integers, linear for
    floats; else one or three. rows: level lines, too. region: left, top, right, bottom as shares of the frame. layout:
    Layout.BGR for frames of OpenCV; None = by the shape. to, window: as in Deflickered.target.
    """
    given = () if response is None else (response,) if isinstance(response, Response) else tuple(response)
    options: Any = initialised(_abi.DeflickerOptions, rows=int(rows))
    curves = (_abi.Response * len(given))(*given) if given else None
    if curves is not None:
        options.response, options.responses = curves, len(given)
    options.region[:] = [float(edge) for edge in region]
    error, pointer = _abi.ErrorText(), POINTER(_abi.Deflicker)()
    check(lib.lensprof_deflicker_create(byref(options), byref(pointer), byref(error)), "invalid options", error)
    made = Deflickered(pointer, lib.lensprof_deflicker_destroy)
    made._response, made._layout = given, layout
    known = [None if values is None else iter(values) for values in (times, settings_ev, f_numbers)]
    count = 0
    for count, frame in enumerate(frames, 1):
        facts: Any = initialised(_abi.DeflickerFacts)
        for name, values in zip(("seconds", "settings_ev", "f_number"), known):
            if values is not None:
                value = next(values, None)
                if value is None:
                    raise ValueError(f"{name}: fewer values than frames; give one for each")
                setattr(facts, name, float(value))
        check(lib.lensprof_deflicker_add(pointer, byref(_arrays.image(frame, layout)), byref(facts), byref(error)),
              f"frame {count - 1}", error)
    for name, values in zip(("times", "settings_ev", "f_numbers"), known):
        if values is not None and next(values, None) is not None:
            raise ValueError(f"{name}: more values than frames; give one for each")
    if count < 2:
        raise ValueError(f"frames: {count or 'no'} frame{'' if count == 1 else 's'}; give at least two")
    made.result = DeflickerResult()
    check(lib.lensprof_deflicker_measure(pointer, byref(made.result), byref(error)), "no exposures", error)
    made.frames = np.zeros(count, dtype=_arrays.DEFLICKER_FRAME_DTYPE)
    for index in range(count):
        one: Any = initialised(_abi.DeflickerFrame)
        check(lib.lensprof_deflicker_frame_at(pointer, index, byref(one), byref(error)), f"no frame {index}", error)
        made.frames[index] = np.frombuffer(one, dtype=_arrays.DEFLICKER_FRAME_DTYPE)[0]
    made.target(to, window)
    return made
