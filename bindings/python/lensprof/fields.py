"""The shading that many pictures of different scenes have in common; see lensprof/fields.h."""
from __future__ import annotations

import datetime
from ctypes import POINTER, byref
from typing import Any, Iterable, Optional, Union

import numpy as np

from . import _abi, _arrays
from ._library import Handle, check, initialised, lib
from ._progress import WithProgress, calling
from ._struct import Count, Curves, Flag, Nested, Referenced, Struct, Value, Vector, default
from ._types import Pixels, Records
from .model import GainGrid, Response
from .profile import Profile, ProfileKey
from .reason import WithFindings


class FieldsOptions(WithProgress, _abi.FieldsOptions):
    """Options of a fit of fields. Defaults: linear pictures, of which channels and frame are those of the first one;
    the offset is estimated.

    channels: 1 or 3. width, height: frame of all pictures, px. given_offset: the offset is `offset`, per channel, in
    units of the samples (0..1 for integers). white: samples at or above it are saturated; 0 = the end of the range of
    the samples. response: () = linear, otherwise one or three. threads: maximum number, 0 = one per core; does not
    affect the result. progress: as in FitOptions.
    """

    channels: int = default
    width: int = default
    height: int = default
    given_offset: Flag = Flag()
    responses = Count()
    threads: int = default
    offset: Vector = Vector()
    white: float = default
    response: Referenced[Response] = Referenced(Response, "responses")


class FieldsChannel(Value, _abi.FieldsChannel):
    """One channel; shares are of the light.

    offset: in units of the samples; offset_sigma: its standard error, inf = not determined; offset_found: estimated.
    smoothness: index of the one chosen. shading_error: standard error of the shading, rms over the frame. heldout_rms:
    of held-out pictures; even_rms: the same without shading. pattern: fine detail common to all pictures, and
    pattern_share: its share of the variance of a cell. background_share, background_sigma: of the narrowest component
    of the content. iterations, converged.
    """

    offset: float = default
    offset_sigma: float = default
    offset_found: Flag = Flag()
    smoothness: int = default
    shading_error: float = default
    heldout_rms: float = default
    even_rms: float = default
    pattern: float = default
    pattern_share: float = default
    background_share: float = default
    background_sigma: float = default
    iterations: int = default
    converged: Flag = Flag()


class FieldsResult(WithFindings, Struct, _abi.FieldsResult):
    """The shading of pictures of different scenes.

    usable: a profile to store. findings: tuple of Finding, refusals first, then warnings and notes; passed: the rules
    that hold. images: pictures added, of which `used` took part; repeated, black, white: left out, as they repeat
    another one, show no light, or are saturated in more than half of the frame. columns, rows: cells. unseen_share: of
    the cells, usable in no picture; white_share: saturated. channel: tuple of 1 or 3 FieldsChannel. shading: 1 in the
    middle of the frame. image: what every picture gave, FIELDS_IMAGE_DTYPE.
    """

    usable: Flag = Flag()
    images: int = default
    used: int = default
    repeated: int = default
    black: int = default
    white: int = default
    channels: int = default
    columns: int = default
    rows: int = default
    smoothnesses: int = default
    unseen_share: float = default
    white_share: float = default
    channel: Curves[FieldsChannel] = Curves(FieldsChannel, "channels")
    shading: Nested[GainGrid] = Nested(GainGrid)
    _fields: Any = None

    @property
    def image(self) -> Records:
        return self._fields.images

    def smoothness(self, channel: int = 0) -> Records:
        """Those tried, FIELDS_SMOOTHNESS_DTYPE: order and weight, and the rms of held-out pictures."""
        tried, error = np.zeros(self.smoothnesses, dtype=_arrays.FIELDS_SMOOTHNESS_DTYPE), _abi.ErrorText()
        one: Any = _abi.FieldsSmoothness()
        with self._fields._use() as fields:
            for index in range(len(tried)):
                check(lib.lensprof_fields_smoothness_at(fields, channel, index, byref(one), byref(error)),
                      f"no smoothness {index}", error)
                tried[index] = np.frombuffer(one, dtype=_arrays.FIELDS_SMOOTHNESS_DTYPE)[0]
        return tried

    def profile(self, key: ProfileKey, source: str = "",
                created: Optional[datetime.datetime] = None) -> Profile:
        """A profile of this result with the response of its pictures. source: file that it was made from."""
        profile, error = Profile(key=key), _abi.ErrorText()
        with self._fields._use() as fields:
            check(lib.lensprof_fields_profile(fields, byref(profile), byref(error)), "no profile", error)
        profile.provenance.source, profile.provenance.created = source, created
        return profile


class _Fields(Handle):
    """The object of the library."""

    images: Records

    def take(self) -> FieldsResult:
        result, error = FieldsResult(), _abi.ErrorText()
        check(lib.lensprof_fields_get(self._pointer, byref(result), byref(error)), "no result", error)
        self.images = np.zeros(result.images, dtype=_arrays.FIELDS_IMAGE_DTYPE)
        for index in range(result.images):
            image: Any = initialised(_abi.FieldsImage)
            check(lib.lensprof_fields_image_at(self._pointer, index, byref(image), byref(error)), f"no image {index}",
                  error)
            self.images[index] = np.frombuffer(image, dtype=_arrays.FIELDS_IMAGE_DTYPE)[0]
        result._fields = self
        result._take(_abi.FieldsResult, lambda *rest: lib.lensprof_fields_finding_at(self._pointer, *rest))
        return result


Masked = Union[Pixels, "tuple[Pixels, Optional[Pixels]]"]


def fit_fields(pictures: Iterable[Masked], options: Optional[FieldsOptions] = None) -> FieldsResult:
    """Fits the shading that pictures of different scenes have in common. pictures: arrays (height, width) or (height,
    width, 3) of uint8, uint16 or float32, or pairs of such an array and a mask (height, width) of uint8, 0 = excluded;
    they are read one after the other, and not kept. A fit that ran returns also when it is poor: see `usable`."""
    error, pointer = _abi.ErrorText(), POINTER(_abi.Fields)()
    options = options or FieldsOptions()
    fields = None
    with calling(options) as call:
        for number, picture in enumerate(pictures):
            array, mask = picture if isinstance(picture, tuple) else (picture, None)
            view = _arrays.image(array, what=f"picture {number}")
            if fields is None:
                if not call.width and not call.height:
                    call.width, call.height = view.width, view.height
                    call.channels = 3 if array.ndim == 3 and array.shape[2] >= 3 else 1
                check(lib.lensprof_fields_create(byref(call), byref(pointer), byref(error)), "the fit failed", error)
                fields = _Fields(pointer, lib.lensprof_fields_destroy)
            given, row_bytes = (None, 0) if mask is None else _arrays.mask(mask, array.shape[:2])
            check(lib.lensprof_fields_add(pointer, byref(view), given, row_bytes, byref(error)), f"picture {number}",
                  error)
        if fields is None:
            raise ValueError("no pictures; give some")
        check(lib.lensprof_fields_fit(pointer, byref(error)), "the fit failed", error)
    return fields.take()
