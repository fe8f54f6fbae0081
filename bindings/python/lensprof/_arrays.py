"""NumPy arrays as the library sees them: their own memory, never a copy. Unsuitable arrays are refused with a
reason."""
from __future__ import annotations

import ctypes
from typing import Any, Iterable, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _abi
from ._abi import Layout, SampleType
from ._library import check, lib
from ._struct import integer
from ._types import Pixels, Records
from .model import Exposure


def _dtype(kind: type) -> np.dtype[Any]:
    """The structure's layout. NumPy's own conversion, but with xy a 2 x 2 array instead of 2 arrays of 2."""
    one: Any = np.zeros((), dtype=np.dtype(kind))
    names = list(one.dtype.names)
    return np.dtype({"names": names, "formats": [(one[n].dtype, one[n].shape) for n in names],
                     "offsets": [one.dtype.fields[n][1] for n in names], "itemsize": one.dtype.itemsize})


PAIR_DTYPE = _dtype(_abi.Pair)
"""Layout of a correspondence: image[2], xy[2][2] (px of the full frame), value[2][3] (grey values 0..1)."""

OBSERVATION_DTYPE = _dtype(_abi.Observation)
"""Layout of a sight of a scene point: point, image, xy[2] (px of the full frame), value[3] (grey values 0..1)."""

EXPOSURE_DTYPE = _dtype(_abi.Exposure)
"""Layout of an exposure: ev, white_balance[3]."""

EXPOSURE_SETTINGS_DTYPE = _dtype(_abi.ExposureSettings)
"""Layout of the settings of a picture: time_s, f_number, iso (UNKNOWN = not stated), camera, lens, is_manual."""

KNOWN_EXPOSURE_DTYPE = _dtype(_abi.KnownExposure)
"""Layout of an exposure by settings: ev, sigma (EV; 0 = unknown), state (ExposureState)."""

IMAGE_QUALITY_DTYPE = _dtype(_abi.FitImageQuality)
"""Layout of an image's quality: ev_sigma, white_balance_sigma[3], median_residual, known_ev_residual, radius, grey_low,
grey_high, pairs, inliers, component, known_ev_left_out, joined."""

MATCH_DTYPE = _dtype(_abi.Match)
SCENE_LINK_DTYPE = _dtype(_abi.SceneLink)
"""Layout of two places that show the same: image[2], xy[2][2] (px of the full frame), map[2][2] (d xy[1] / d xy[0])."""

LINK_DTYPE = _dtype(_abi.Link)
"""Layout of two images that overlap: image[2], state (LinkState), pairs."""

FLAT_QUALITY_DTYPE = _dtype(_abi.FlatImageQuality)
"""Layout of what one picture gave to a flat field fit; see lensprof/flat.h."""

FLAT_SPOT_DTYPE = _dtype(_abi.FlatSpot)
"""Layout of a spot of dust: x, y, radius (px), depth, shots."""

ONLINE_OBSERVATION_DTYPE = _dtype(_abi.OnlineObservation)
"""Layout of what a tracker sees of one point: track, x, y (px), value[3] (grey values 0..1), weight."""

FIELDS_IMAGE_DTYPE = _dtype(_abi.FieldsImage)
"""Layout of what one picture gave to a fit of fields; see lensprof/fields.h."""

FIELDS_SMOOTHNESS_DTYPE = _dtype(_abi.FieldsSmoothness)
"""Layout of a smoothness that was tried: order, weight, rms (share of the light)."""

DEFLICKER_FRAME_DTYPE = _dtype(_abi.DeflickerFrame)
"""Layout of a frame in time: state (DeflickerState), segment, repeats, seconds, settings_ev, exposure, ev_sigma, agreeing,
shift[2], white_share, dark_share."""

_SAMPLE_TYPES = {np.dtype(np.uint8): SampleType.U8, np.dtype(np.uint16): SampleType.U16,
                 np.dtype(np.float32): SampleType.F32, np.dtype(np.float16): SampleType.F16}
_LAYOUTS = {1: Layout.GREY, 2: Layout.GREY_ALPHA, 3: Layout.RGB, 4: Layout.RGBA}


def address(array: Pixels, kind: type) -> Any:
    """Pointer to the array's first element; the caller keeps the array alive."""
    return ctypes.cast(array.ctypes.data, ctypes.POINTER(kind))


def sample_type(dtype: Any) -> SampleType:
    """The sample type of a NumPy dtype."""
    found = _SAMPLE_TYPES.get(np.dtype(dtype))
    if found is None:
        raise TypeError(f"samples of type {np.dtype(dtype)} are not supported; convert the picture to uint8, uint16, "
                        "float16 or float32 in native byte order")
    return found


def sample_dtype(kind: SampleType) -> Any:
    """The NumPy dtype of a sample type."""
    return next(dtype for dtype, sample in _SAMPLE_TYPES.items() if sample == kind)


def layout_of(array: Pixels, layout: Optional[Layout] = None) -> Layout:
    """Layout of a picture of shape (height, width) or (height, width, samples): RGB order by default."""
    if array.ndim not in (2, 3):
        raise ValueError(f"a picture has the shape (height, width) or (height, width, samples), not {array.shape}")
    samples = array.shape[2] if array.ndim == 3 else 1
    if layout is None:
        if samples not in _LAYOUTS:
            raise ValueError(f"a picture of shape {array.shape} has {samples} samples a pixel; it must have 1 to 4")
        return _LAYOUTS[samples]
    if lib.lensprof_layout_samples(layout) != samples:
        raise ValueError(f"a picture of shape {array.shape} has {samples} samples a pixel, which is not "
                         f"{Layout(layout).name}")
    return Layout(layout)


def _form(array: Pixels) -> str:
    return f"shape {array.shape} and strides {array.strides}"


def _row_bytes(array: Pixels, writable: bool, what: str) -> int:
    """Byte distance of rows; refuses arrays whose pixels of a row are not side by side.

    NumPy gives axes of length 0 or 1 any stride.
    """
    step = array.itemsize
    for axis in range(array.ndim - 1, 0, -1):
        if array.shape[axis] > 1 and array.size and array.strides[axis] != step:
            raise ValueError(f"{what} of {_form(array)}: the samples of a row must lie side by side, only rows may be "
                             "apart; use numpy.ascontiguousarray")
        step *= array.shape[axis]
    if writable and not array.flags.writeable:
        raise ValueError(f"{what} is read-only; give an array that can be written")
    return array.strides[0] if array.shape[0] > 1 else step


def _checked(array: Any, what: str) -> Pixels:
    if not isinstance(array, np.ndarray):
        raise TypeError(f"{what} must be a numpy.ndarray, not {type(array).__name__}")
    return array


def image(array: Pixels, layout: Optional[Layout] = None, what: str = "picture", *,
          writable: bool = False) -> Any:
    """A view on a picture, which may be read-only; the caller keeps the array alive."""
    _checked(array, what)
    sample, layout = sample_type(array.dtype), layout_of(array, layout)
    height, width = (integer(side, f"side of the {what}") for side in array.shape[:2])
    raw: Any = _abi.Image
    view = raw(array.ctypes.data, _row_bytes(array, writable, what), width, height, sample, layout)
    check(lib.lensprof_image_validate(ctypes.byref(view)),
          f"{what} of {_form(array)}: sizes must be 1..1048576, samples aligned, rows apart")
    return view


def target(array: Pixels, layout: Optional[Layout] = None, what: str = "out") -> Any:
    """The same on a picture to be written."""
    return _abi.Target.from_buffer_copy(image(array, layout, what, writable=True))


def mask(array: Pixels, shape: tuple[int, ...], writable: bool = False) -> tuple[Any, int]:
    """Pointer and row bytes of a mask: uint8 or bool of the given (height, width)."""
    if _checked(array, "mask").dtype not in (np.dtype(np.uint8), np.dtype(np.bool_)):
        raise TypeError(f"a mask of type {array.dtype} is not supported; give uint8 or bool")
    if array.shape != tuple(shape):
        raise ValueError(f"a mask of shape {array.shape} does not fit a picture of {shape[0]} rows, {shape[1]} columns")
    return address(array, ctypes.c_uint8), _row_bytes(array, writable, "mask")


def results(array: npt.NDArray[Any], count: int, what: str) -> Any:
    """Pointer to an array that receives this many numbers of type float64."""
    if _checked(array, what).dtype != np.dtype(np.float64):
        raise TypeError(f"{what} of type {array.dtype} is not supported; give float64")
    if array.shape != (count,) or not array.flags.c_contiguous:
        raise ValueError(f"{what} of {_form(array)}: give one contiguous dimension of {count}, as numpy.empty({count})")
    if not array.flags.writeable:
        raise ValueError(f"{what} is read-only; give an array that can be written")
    return address(array, ctypes.c_double)


def structured(array: Records, dtype: np.dtype[Any], kind: type, what: str) -> tuple[Any, int]:
    """Pointer and length of a one-dimensional structured array."""
    if _checked(array, what).dtype != dtype:
        raise TypeError(f"{what} must be an array of dtype {dtype}, not {array.dtype}")
    if array.ndim != 1 or not (array.flags.c_contiguous and array.flags.aligned):
        raise ValueError(f"{what} of {_form(array)}: give one contiguous dimension, with numpy.ascontiguousarray")
    return address(array, kind), integer(len(array), f"number of {what}")


def pairs(array: Records) -> tuple[Any, int]:
    """Pointer and length of an array of PAIR_DTYPE."""
    return structured(array, PAIR_DTYPE, _abi.Pair, "pairs")


def observations(array: Records) -> tuple[Any, int]:
    """Pointer and length of an array of OBSERVATION_DTYPE."""
    return structured(array, OBSERVATION_DTYPE, _abi.Observation, "observations")


def matches(array: Records) -> tuple[Any, int]:
    """Pointer and length of an array of MATCH_DTYPE."""
    return structured(array, MATCH_DTYPE, _abi.Match, "matches")


def links(array: Records) -> tuple[Any, int]:
    """Pointer and length of an array of LINK_DTYPE."""
    return structured(array, LINK_DTYPE, _abi.Link, "links")


def exposures(values: Union[Records, Iterable[Exposure]]) -> Records:
    """An array of EXPOSURE_DTYPE as it is, or Exposure objects gathered in one."""
    if isinstance(values, np.ndarray):
        structured(values, EXPOSURE_DTYPE, _abi.Exposure, "exposures")
        return values
    return np.array([(v.ev, v.white_balance) for v in values], dtype=EXPOSURE_DTYPE)
