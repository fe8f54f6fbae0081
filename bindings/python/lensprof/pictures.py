"""Picture files: pixels, metadata and colour profile; see lensprof/photo.h."""
from __future__ import annotations

import contextlib
import ctypes
from ctypes import POINTER, byref, c_size_t
from typing import Any, Iterator, Optional

import numpy as np
import numpy.typing as npt

from . import _abi, _arrays
from ._abi import SampleType, Status
from ._library import Handle, check, initialised, lib, photo
from ._paths import PathLike, Source, raw_path
from ._struct import Captured, Flag, Nested, Value, default
from .profile import ProfileKey

_DTYPES = {SampleType.U8: np.uint8, SampleType.U16: np.uint16, SampleType.F32: np.float32}


class PictureMetadata(Value, _abi.PictureMetadata):
    """What a picture states about camera, lens and exposure; by default nothing. key: ProfileKey. exposure_time_s, iso,
    f_number: UNKNOWN if not stated; ev: log2(time iso / 100 / f_number^2), larger is brighter. captured: datetime, as
    the camera's clock showed it, or None. is_corrected: the falloff was corrected before."""

    is_corrected: Flag = Flag()
    key: Nested[ProfileKey] = Nested(ProfileKey)
    exposure_time_s: float = default
    iso: float = default
    f_number: float = default
    ev: float = default
    captured: Captured = Captured()


class _OpenPicture(Handle):
    def __init__(self, source: Source):
        self.library = photo()
        error, pointer = _abi.ErrorText(), POINTER(_abi.Picture)()
        if isinstance(source, (bytes, bytearray, memoryview)):
            data = bytes(source)
            status = self.library.lensprof_picture_open_memory(data, len(data), byref(pointer), byref(error))
        else:
            status = self.library.lensprof_picture_open(raw_path(source), byref(pointer), byref(error))
        check(status, "no picture", error)
        super().__init__(pointer, self.library.lensprof_picture_destroy)

    def ask(self, function: Any, *rest: Any) -> None:
        error = _abi.ErrorText()
        with self._use() as picture:
            check(function(picture, *rest, byref(error)), "the picture cannot be read", error)


class Picture:
    """A picture that was read: `pixels`, an array (height, width) or (height, width, samples) as stored in the file;
    `metadata`; `icc`, the bytes of its colour profile; `orientation` of EXIF, 1..8, which is not applied; `reduction`:
    so many pixels of the file wide is one of `pixels`."""

    pixels: npt.NDArray[Any]
    metadata: PictureMetadata
    icc: bytes
    orientation: int
    reduction: int

    def __init__(self, source: Source, max_side: int = 0):
        self._file = _OpenPicture(source)
        library, info = self._file.library, initialised(_abi.PictureInfo)
        self._file.ask(library.lensprof_picture_get_info, max_side, byref(info))
        self.metadata = PictureMetadata()
        self._file.ask(library.lensprof_picture_get_metadata, byref(self.metadata))
        buffer, count = ctypes.create_string_buffer(max(info.icc_bytes, 1)), c_size_t()
        self._file.ask(library.lensprof_picture_get_icc, buffer, info.icc_bytes, byref(count))
        self.icc, self.orientation, self.reduction = buffer.raw[:info.icc_bytes], info.orientation, info.reduction
        samples = lib.lensprof_layout_samples(info.layout)
        shape = (info.read_height, info.read_width) + ((samples,) if samples > 1 else ())
        self.pixels = np.empty(shape, dtype=_DTYPES[SampleType(info.sample)])
        self._file.ask(library.lensprof_picture_read, max_side, byref(_arrays.target(self.pixels)))

    def __repr__(self) -> str:
        return f"Picture({self.pixels.shape[1]} x {self.pixels.shape[0]}, {self.pixels.dtype})"


def read_picture(source: Source, max_side: int = 0) -> Picture:
    """Reads a picture file, or its bytes, of any format that the library was built with. max_side: 0 = full size; else
    reduced by a whole number, so that the longer side has at least so many pixels."""
    return Picture(source, max_side)


def write_picture(path: PathLike, pixels: npt.NDArray[Any], like: Optional[Picture] = None, jpeg_quality: int = 0,
                  metadata: Optional[PictureMetadata] = None) -> None:
    """Writes pixels (uint8, uint16 or float32) in the format of the name: .png, .jpg, .tif. like: a picture that was
    read, whose metadata, colour profile and compression are taken. jpeg_quality: 1..100, 0 = like that picture.
    metadata: written as EXIF, over that of `like`; see lensprof_picture_options."""
    library, error = photo(), _abi.ErrorText()
    with _options(like, jpeg_quality, metadata) as options:
        check(library.lensprof_picture_write(raw_path(path), byref(_arrays.image(pixels)), options, byref(error)),
              "the picture cannot be written", error)


def encode_picture(format: str, pixels: npt.NDArray[Any], like: Optional[Picture] = None, jpeg_quality: int = 0,
                   metadata: Optional[PictureMetadata] = None) -> bytes:
    """The same as bytes; format: such as ".png"."""
    library, error, count = photo(), _abi.ErrorText(), c_size_t()
    buffer = ctypes.create_string_buffer(pixels.nbytes + (1 << 16))
    with _options(like, jpeg_quality, metadata) as options:
        def encode() -> Any:
            return library.lensprof_picture_encode(format.encode(), byref(_arrays.image(pixels)), options, buffer,
                                                   len(buffer), byref(count), byref(error))
        status = encode()
        if status == Status.ERROR_CAPACITY:
            buffer = ctypes.create_string_buffer(count.value)
            status = encode()
        check(status, "the picture cannot be encoded", error)
    return buffer.raw[:count.value]


@contextlib.contextmanager
def _options(like: Optional[Picture], jpeg_quality: int, metadata: Optional[PictureMetadata]) -> Iterator[Any]:
    options: Any = initialised(_abi.PictureOptions, jpeg_quality=jpeg_quality)
    with contextlib.ExitStack() as stack:
        if like is not None:
            options.like = stack.enter_context(like._file._use())
        if metadata is not None:
            options.metadata = ctypes.pointer(_abi.PictureMetadata.from_buffer(metadata))
        yield byref(options)
