"""The response of a camera from raw frames and the pictures rendered of them; see lensprof/rendering.h."""
from __future__ import annotations

from ctypes import POINTER, byref
from typing import Any, Callable, Iterable, Optional

from . import _abi, _arrays
from ._library import check, lib
from ._progress import Function, calling_function
from ._struct import Flag, Nested, Struct, Vector, default
from ._types import Pixels
from .model import Response
from .reason import WithFindings


class RenderingShot(Struct, _abi.RenderingShot):
    """One shot: how its two pictures correspond, and what the camera did.

    width, height: of the rendered picture, px; quarter_turns: rotation that aligns it with the raw frame. shift,
    scale, k1, k2: from rendered picture to raw frame, in half diagonals. correlation, texture: of both, aligned.
    squares: of the rendered picture, of which black, white, colourful, saturated and rough ones were left out; areas:
    compared. corner: irradiance of the rendering over that of the sensor at `radius`; corrects_falloff: the camera
    brightened the corners. tones: 0 = mapped globally, 1 = perhaps locally, 2 = locally. pattern_levels, pattern_ev:
    map of residuals. noise_levels: of an area. white_ev: from white to the sensor's saturation. gamma, gamma_sigma:
    from this shot alone. colour: matrix, row by row; falloff, saturation: of the rendering.
    """

    width: int = default
    height: int = default
    quarter_turns: int = default
    shift: Vector = Vector(writable=False)
    scale: float = default
    k1: float = default
    k2: float = default
    correlation: float = default
    texture: float = default
    channels: int = default
    squares: int = default
    black: int = default
    white: int = default
    colourful: int = default
    saturated: int = default
    rough: int = default
    areas: int = default
    corrects_falloff: Flag = Flag()
    tones: int = default
    radius: float = default
    corner: float = default
    corner_sigma: float = default
    pattern_levels: float = default
    pattern_ev: float = default
    noise_levels: float = default
    white_ev: float = default
    gamma: float = default
    gamma_sigma: float = default
    colour: Vector = Vector(writable=False)
    falloff: Vector = Vector(writable=False)
    saturation: float = default


class RenderingResult(WithFindings, Struct, _abi.RenderingResult):
    """The response that renders raw frames, and what was found.

    usable: a response to store. findings: tuple of Finding, refusals first, then warnings and notes; passed: the rules
    that hold. response. gamma: its exponent between grey levels 48 and 208; gamma_sigma: standard error of ln gamma.
    lowest, highest: grey values 0..1 that are measured; tenths: of the grey values. shows_white: the rendering reaches
    white before the sensor saturates. corrects_falloff: in most shots. areas: compared. shots: tuple of RenderingShot.
    """

    usable: Flag = Flag()
    response: Nested[Response] = Nested(Response)
    gamma: float = default
    gamma_sigma: float = default
    lowest: float = default
    highest: float = default
    tenths: int = default
    shows_white: Flag = Flag()
    corrects_falloff: Flag = Flag()
    areas: int = default
    _shots: tuple[RenderingShot, ...] = ()

    @property
    def shots(self) -> tuple[RenderingShot, ...]:
        return self._shots

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in super()._names() if name != "shots"]


def fit_rendering(shots: Iterable[tuple[Pixels, Pixels]], prior: Optional[Response] = None,
                  progress: Optional[Function] = None) -> RenderingResult:
    """Fits the response of a camera to shots (raw, rendered): a linear frame of uint16, 65535 = saturated, and the
    picture rendered of it, uint8, each (height, width) or (height, width, 3). The arrays are read one shot after the
    other. prior: of unmeasured grey levels; None = that of current cameras. progress: as in FitOptions, called with 0.
    Also returns if the result is poor: see `usable`."""
    error, pointer = _abi.ErrorText(), POINTER(_abi.Rendering)()
    with calling_function(progress) as function:
        check(lib.lensprof_rendering_create(None if prior is None else byref(prior), function, None, byref(pointer),
                                            byref(error)), "the fit failed", error)
        try:
            return _fit(pointer, shots, error)
        finally:
            lib.lensprof_rendering_destroy(pointer)


def _fit(pointer: Any, shots: Iterable[tuple[Pixels, Pixels]], error: Any) -> RenderingResult:
    for number, (raw, rendered) in enumerate(shots):
        views = _arrays.image(raw, what=f"raw frame {number}"), _arrays.image(rendered, what=f"picture {number}")
        check(lib.lensprof_rendering_add(pointer, *map(byref, views), byref(error)), f"shot {number}", error)
    result = RenderingResult()
    check(lib.lensprof_rendering_fit(pointer, byref(result), byref(error)), "the fit failed", error)
    found: list[RenderingShot] = []
    for number in range(vars(_abi.RenderingResult)["shots"].__get__(result)):
        found.append(RenderingShot())
        check(lib.lensprof_rendering_shot_at(pointer, number, byref(found[-1]), byref(error)), f"no shot {number}", error)
    result._shots = tuple(found)
    at: Callable[..., int] = lambda *rest: lib.lensprof_rendering_finding_at(pointer, *rest)
    result._take(_abi.RenderingResult, at)
    return result
