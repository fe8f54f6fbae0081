"""Falloff from pictures of a white card or another even light; see lensprof/flat.h."""
from __future__ import annotations

import datetime
from ctypes import POINTER, byref
from dataclasses import dataclass
from typing import Any, Optional, Sequence

import numpy as np

from . import _abi, _arrays
from ._abi import FlatGrid, FlatLight, Free, Layout
from ._library import Handle, check, initialised, lib
from ._progress import WithProgress, calling
from ._struct import Count, Curves, Enumerated, Flag, Nested, Referenced, Struct, default, integer
from ._types import Pixels, Records
from .model import GainGrid, ImageCircle, Levels, Response, Vignetting
from .profile import Covariance, Profile, ProfileKey
from .reason import WithFindings


@dataclass
class FlatImage:
    """A picture of a card; its arrays are read in place.

    array: (height, width) or (height, width, samples); in layouts with alpha, alpha below half = excluded. width,
    height: of the full frame, px; by default those of the array times reduction. shot: pictures of one shot (same
    pose, different exposure) have the same number. ev: known exposure, EV. rotation_deg: rotation of the camera about
    its axis, clockwise seen from the back of the camera. layout, reduction, mask, black, white: as in SampleImage.
    """

    array: Pixels
    shot: int = 0
    ev: float = 0.0
    rotation_deg: float = 0.0
    width: Optional[int] = None
    height: Optional[int] = None
    layout: Optional[Layout] = None
    reduction: int = 1
    mask: Optional[Pixels] = None
    black: float = 2.0 / 255.0
    white: float = 250.0 / 255.0

    def _view(self, index: int) -> _abi.FlatImage:
        """Points into this object's arrays."""
        view = _arrays.image(self.array, self.layout, what=f"image {index}")
        mask, row_bytes = (None, 0) if self.mask is None else _arrays.mask(self.mask, self.array.shape[:2])
        reduction = integer(self.reduction, "reduction")
        width = view.width * reduction if self.width is None else integer(self.width, "width")
        height = view.height * reduction if self.height is None else integer(self.height, "height")
        return initialised(_abi.FlatImage, view=view, width=integer(width, "width"), height=integer(height, "height"),
                           reduction=reduction, shot=integer(self.shot, "shot"), mask=mask, mask_row_bytes=row_bytes,
                           black=self.black, white=self.white, ev=self.ev, rotation_deg=self.rotation_deg)


class FlatOptions(WithProgress, _abi.FlatOptions):
    """Options of a flat field fit. Defaults: 3 channels, everything free, linear response, shots that fill the frame.

    channels: 1 or 3. free: Free.K1, K2, K3, CENTER. vignettings: falloff curves, 1, 3 or 0 = 3 if they differ. light:
    FlatLight; own_light: each shot has its own light. several: one card at several places of the frame, with the same
    brightness; find_card: find the card in the frame. grid: FlatGrid. ev_sigma: standard error of an exposure, EV
    (several). prior_weight: 0 = none. response: () = linear, otherwise one or three. vignetting: values of fixed
    parameters. threads: maximum number, 0 = one per core; does not affect the result. progress: as in FitOptions.
    levels: of the samples. black_sigma: standard error of the black level, 0 = exact; otherwise pictures of one light
    at different levels determine what it leaves.
    """

    channels: int = default
    free: Enumerated[Free] = Enumerated(Free)
    vignettings: int = default
    light: Enumerated[FlatLight] = Enumerated(FlatLight)
    own_light: Flag = Flag()
    several: Flag = Flag()
    find_card: Flag = Flag()
    grid: Enumerated[FlatGrid] = Enumerated(FlatGrid)
    responses = Count()
    threads: int = default
    ev_sigma: float = default
    prior_weight: float = default
    response: Referenced[Response] = Referenced(Response, "responses")
    vignetting: Nested[Vignetting] = Nested(Vignetting)
    levels: Nested[Levels] = Nested(Levels)
    black_sigma: float = default


class FlatResult(WithFindings, Struct, _abi.FlatResult):
    """What a flat field fit found; shares are of the light.

    usable: a profile to store. findings: tuple of Finding, refusals first, then warnings and notes; passed: the rules
    that hold. vignetting: tuple of 1 (all channels)
    or 3. separated: the pictures tell the light's gradient from the centre. spot: dust, FLAT_SPOT_DTYPE.
    radius: largest r of a cell used. noise, residual, texture, frame_residual, shot_residual, grid_residual: of a cell.
    corner: M times grid in the corners, or along the edge if there is one; corner_sigma: its standard error. edge_radius,
    edge_share: where the data end, half diagonals (0: with the frame), and the share of the frame outside.
    image_circle: if they end at one.
    light_ev: change in a corner for another model of the light, EV. polynomial_error: largest, of M without the
    grid. levels: those of the options with the offset found; black_offset, black_sigma: it and its error; black_ev:
    what that changes in a corner, EV; black_shown: the pictures determine it. gain_grid: what the polynomial leaves.
    covariance: n x n as in Profile.
    image_quality: what every picture gave, FLAT_QUALITY_DTYPE.
    """

    usable: Flag = Flag()
    vignetting: Curves[Vignetting] = Curves(Vignetting, "vignettings")
    vignettings: int = default
    light: Enumerated[FlatLight] = Enumerated(FlatLight)
    shots: int = default
    cells: int = default
    separated: Flag = Flag()
    iterations: int = default
    converged: Flag = Flag()
    spots: int = default
    radius: float = default
    noise: float = default
    residual: float = default
    texture: float = default
    frame_residual: float = default
    shot_residual: float = default
    inlier_share: float = default
    corner_sigma: float = default
    corner: float = default
    edge_radius: float = default
    edge_share: float = default
    light_ev: float = default
    polynomial_error: float = default
    levels: Nested[Levels] = Nested(Levels)
    black_offset: float = default
    black_sigma: float = default
    black_ev: float = default
    black_shown: Flag = Flag()
    image_circle: Nested[ImageCircle] = Nested(ImageCircle)
    grid_residual: float = default
    covariance_size: int = default
    covariance: Covariance = Covariance()
    gain_grid: Nested[GainGrid] = Nested(GainGrid)
    images: int = default
    _flat: Any = None

    @property
    def spot(self) -> Records:
        array = vars(_abi.FlatResult)["spot"].__get__(self)
        return np.frombuffer(array, dtype=_arrays.FLAT_SPOT_DTYPE)[:min(self.spots, _abi.FLAT_SPOTS)]

    @property
    def image_quality(self) -> Records:
        return self._flat.quality

    def profile(self, key: ProfileKey, source: str = "",
                created: Optional[datetime.datetime] = None) -> Profile:
        """A profile of this result with the response of its pictures. source: file that it was
        made from."""
        profile, error = Profile(key=key), _abi.ErrorText()
        with self._flat._use() as flat:
            check(lib.lensprof_flat_profile(flat, byref(profile), byref(error)), "no profile", error)
        profile.provenance.source, profile.provenance.created = source, created
        return profile


class _Flat(Handle):
    """The fit of the library, with what every picture gave to it."""

    def __init__(self, pointer: Any, image_count: int):
        super().__init__(pointer, lib.lensprof_flat_destroy)
        self.quality = np.zeros(image_count, dtype=_arrays.FLAT_QUALITY_DTYPE)
        self.result, error = FlatResult(), _abi.ErrorText()
        check(lib.lensprof_flat_get(pointer, byref(self.result), byref(error)), "no result", error)
        for index in range(image_count):
            quality: Any = initialised(_abi.FlatImageQuality)
            check(lib.lensprof_flat_image_at(pointer, index, byref(quality), byref(error)), f"no image {index}", error)
            self.quality[index] = np.frombuffer(quality, dtype=_arrays.FLAT_QUALITY_DTYPE)[0]
        self.result._flat = self
        self.result._take(_abi.FlatResult, lambda *rest: lib.lensprof_flat_finding_at(pointer, *rest))


def fit_flat(images: Sequence[FlatImage], options: Optional[FlatOptions] = None) -> FlatResult:
    """Fits the falloff to pictures of a card. A fit that ran returns also when it is poor: see `usable`."""
    images, options, error = list(images), options or FlatOptions(), _abi.ErrorText()
    views = (_abi.FlatImage * len(images))(*[image._view(i) for i, image in enumerate(images)])
    pointer = POINTER(_abi.Flat)()
    with calling(options) as call:
        status = lib.lensprof_fit_flat(byref(call), views, len(views), None, 0, byref(pointer), byref(error))
    check(status, "the fit failed", error)
    return _Flat(pointer, len(images)).result
