"""Correspondences: the same scene point in two pictures; see lensprof/sample.h."""
from __future__ import annotations

from ctypes import POINTER, byref, c_uint32, pointer
from dataclasses import dataclass
from typing import Any, Callable, Optional, Sequence

import numpy as np
import numpy.typing as npt

from . import _abi, _arrays
from ._abi import Layout, Sampling
from ._library import check, initialised, lib
from ._progress import WithProgress, calling
from ._struct import Enumerated, OptionalReference, Struct, default, integer
from ._types import Pixels, Records
from .geometry import Camera
from .model import Response, Vignetting


@dataclass
class SampleImage:
    """A picture to sample; its arrays are read in place.

    array: (height, width) or (height, width, samples); in layouts with alpha, alpha below half = excluded. camera: of
    the full frame. layout: None = RGB order. reduction: pixel (u, v) of the array is the mean of the square of
    `reduction` frame pixels that begins at (u, v) * reduction, or of some of its pixels. mask: (height, width) uint8 or
    bool, 0 = excluded. black, white: samples outside in any channel are not used; 0..1. every_pixel: all pixels of a
    patch must be within the limits; otherwise its mean must be.
    """

    array: Pixels
    camera: Camera
    layout: Optional[Layout] = None
    reduction: int = 1
    mask: Optional[Pixels] = None
    black: float = 2.0 / 255.0
    white: float = 250.0 / 255.0
    every_pixel: bool = False

    def _view(self, index: int) -> _abi.SampleImage:
        """Points into this object's arrays."""
        view = _arrays.image(self.array, self.layout, what=f"image {index}")
        mask, row_bytes = (None, 0) if self.mask is None else _arrays.mask(self.mask, self.array.shape[:2])
        return initialised(_abi.SampleImage, view=view, camera=self.camera, mask=mask, mask_row_bytes=row_bytes,
                           reduction=integer(self.reduction, "reduction"), every_pixel=int(bool(self.every_pixel)),
                           black=self.black, white=self.white)


class SampleOptions(WithProgress, _abi.SampleOptions):
    """Options of sampling. Defaults: balanced, pairs 0 (= 300 per image, at least 2000), seed 1, threads 0 (= one per
    core).

    Same seed, same pairs, with any number of threads. progress: called repeatedly with the fraction done (0..1).
    Sampling is cancelled if it returns True or raises an exception, which then propagates from sample_overlap. links:
    after balanced sampling, an array of LINK_DTYPE with the result of comparing the texture of overlapping images, for
    FitOptions.links; None before. response, vignetting: from a first fit or a profile, or None; places are then
    compared by their light, which connects pictures that are many EV apart.
    """

    sampling: Enumerated[Sampling] = Enumerated(Sampling)
    pairs: int = default
    seed: int = default
    threads: int = default
    response: OptionalReference[Response] = OptionalReference(Response)
    vignetting: OptionalReference[Vignetting] = OptionalReference(Vignetting)

    @property
    def match_of_pair(self) -> Optional[npt.NDArray[np.uint32]]:
        """After sample_matches, the index of the match of each pair; None before."""
        return vars(self).get("_match_of_pair")

    @property
    def links(self) -> Optional[Records]:
        return vars(self).get("_links")

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in super()._names() if not name.startswith("link") and name != "match_of_pair"]


def _sample(function: Any, images: Sequence[SampleImage], options: Optional[SampleOptions], dtype: np.dtype[Any],
            data: Callable[[Records], tuple[Any, int]], *more: Any) -> Records:
    images, options, error = list(images), options or SampleOptions(), _abi.ErrorText()
    views = (_abi.SampleImage * len(images))(*[image._view(i) for i, image in enumerate(images)])
    room, found = c_uint32(), c_uint32()
    check(function(byref(options), views, len(views), *more, None, 0, byref(room), byref(error)), "sampling failed", error)
    out = np.empty(room.value, dtype=dtype)
    links, link_count = np.zeros(min(len(views) * (len(views) - 1) // 2, 1 << 20), dtype=_arrays.LINK_DTYPE), c_uint32()
    with calling(options) as call:
        call.links, call.link_capacity = _arrays.address(links, _abi.Link), len(links)
        call.link_count = pointer(link_count)
        if more:
            matched = np.empty(len(out), dtype=np.uint32)
            call.match_of_pair = matched.ctypes.data_as(POINTER(c_uint32))
        status = function(byref(call), views, len(views), *more, *data(out), byref(found), byref(error))
    check(status, "sampling failed", error)
    options._links = links[:link_count.value]
    options._match_of_pair = matched[:found.value] if more else None
    return out[:found.value]


def sample_overlap(images: Sequence[SampleImage], options: Optional[SampleOptions] = None) -> Records:
    """Finds correspondences between at least two overlapping pictures: an array of PAIR_DTYPE.

    There are at most options.pairs, fewer if the overlaps do not hold as many.
    """
    return _sample(lib.lensprof_sample_overlap, images, options, _arrays.PAIR_DTYPE, _arrays.pairs)


def sample_tracks(images: Sequence[SampleImage], options: Optional[SampleOptions] = None) -> Records:
    """Finds points seen in several pictures, for fit_radiance: an array of OBSERVATION_DTYPE, by point.

    There are at most options.pairs points (0 = 150 per image, at least 2000), each with up to 16 observations.
    """
    return _sample(lib.lensprof_sample_tracks, images, options, _arrays.OBSERVATION_DTYPE, _arrays.observations)


def sample_matches(images: Sequence[SampleImage], matches: Records,
                   options: Optional[SampleOptions] = None) -> Records:
    """Measures correspondences at places that are known to match, an array of MATCH_DTYPE: an array of PAIR_DTYPE.

    For pictures from a moving camera; only width and height of the cameras are used. `map` of a match, the rotation and
    scale of its surroundings, may be all 0: the pair then comes from the match itself, otherwise from the smoothest
    place near it.
    """
    address, count = _arrays.matches(matches)
    return _sample(lib.lensprof_sample_matches, images, options, _arrays.PAIR_DTYPE, _arrays.pairs, address, count)
