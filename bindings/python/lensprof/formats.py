"""Other tools' files, from and to memory: Hugin projects and point files, Lensfun databases; see lensprof/formats.h."""
from __future__ import annotations

from ctypes import POINTER, byref, c_size_t, c_uint32, cast, create_string_buffer
from typing import Any, Callable, Iterable, Sequence, Union

import numpy as np

from . import _abi, _arrays
from ._abi import Free, Status
from ._library import Handle, check, lib
from ._struct import Enumerated, Flag, Nested, Value, Vector, integer
from .geometry import Camera
from .model import Exposure, Response, Vignetting
from .profile import Profile


def _bytes(text: Union[str, bytes]) -> bytes:
    return text.encode("utf-8", "surrogateescape") if isinstance(text, str) else bytes(text)


def _written(write: Callable[[Any, int, Any], int], what: str) -> bytes:
    """Asks for the size, then for the text."""
    needed = c_size_t()
    status = write(None, 0, byref(needed))
    if status != Status.ERROR_CAPACITY:
        check(status, what)
    buffer = create_string_buffer(needed.value)
    check(write(buffer, needed.value, byref(needed)), what)
    return buffer.raw


class PtoImage(Value, _abi.PtoImage):
    """One `i` line with its links resolved.

    emor: Ra..Re. response_type: 0 EMoR, 1 linear. free: what the `v` lines ask for. response_of, vignetting_of,
    center_of, ev_of, red_of, blue_of: index of the image at the end of the link, own index when not linked. crop:
    left, top, right, bottom (exclusive), px.
    """

    camera = Nested(Camera)
    exposure = Nested(Exposure)
    vignetting = Nested(Vignetting)
    emor = Vector()
    response_type: int
    free = Enumerated(Free)
    response_of: int
    vignetting_of: int
    center_of: int
    ev_of: int
    red_of: int
    blue_of: int
    crop = Vector()
    crop_circular = Flag()


class Pto(Handle):
    """A Hugin project (.pto). A context manager; may also be left to the garbage collector."""

    def __init__(self, text: Union[str, bytes]):
        """Parses a project, e.g. Path("pano.pto").read_bytes()."""
        data, pointer, error = _bytes(text), POINTER(_abi.Pto)(), _abi.ErrorText()
        check(lib.lensprof_pto_read(data, len(data), byref(pointer), byref(error)), "the project cannot be read", error)
        super().__init__(pointer, lib.lensprof_pto_destroy)

    def __len__(self) -> int:
        """Number of images."""
        with self._use() as pto:
            return lib.lensprof_pto_image_count(pto)

    def _no_image(self, index: int) -> str:
        return f"image {index}: the project has no such image; count from 0"

    def image(self, index: int) -> PtoImage:
        """The `i` line of an image, in lensprof's conventions."""
        image = PtoImage()
        with self._use() as pto:
            check(lib.lensprof_pto_get_image(pto, integer(index, "index"), byref(image)), self._no_image(index))
        return image

    def response(self, index: int) -> Response:
        """The response of an image as Hugin evaluates it."""
        response = Response()
        with self._use() as pto:
            check(lib.lensprof_pto_get_response(pto, integer(index, "index"), byref(response)), self._no_image(index))
        return response

    def name(self, index: int) -> str:
        """File name of an image as written, relative to the project's folder; other bytes as with os.fsdecode."""
        number = integer(index, "index")
        with self._use() as pto:
            text = _written(lambda *buffer: lib.lensprof_pto_get_name(pto, number, *buffer), self._no_image(index))
        return text.rstrip(b"\0").decode("utf-8", "surrogateescape")

    def set_name(self, index: int, name: str) -> None:
        """Changes the file name of an image, for a project that is written to another folder."""
        text = _bytes(name)
        if b"\0" in text:
            raise ValueError(f"{name!r}: a file name holds no zero bytes")
        with self._use() as pto:
            check(lib.lensprof_pto_set_name(pto, integer(index, "index"), text),
                  f"image {index}, name {name!r}: the project has no such image, or the name is empty or has quotes or "
                  "control characters")

    def draw_mask(self, index: int, mask: np.ndarray) -> np.ndarray:
        """Draws where pairs may be taken from an image into a uint8 or bool array (height, width): 1, else 0. Returns
        it.

        The array is a view of the whole frame at its own size.
        """
        rows, columns = (mask.shape + (0, 0))[:2]
        pixels, row_bytes = _arrays.mask(mask, (rows, columns), writable=True)
        with self._use() as pto:
            check(lib.lensprof_pto_draw_mask(pto, integer(index, "index"), pixels, integer(columns, "columns"),
                                             integer(rows, "rows"), row_bytes),
                  f"image {index}, mask of {columns} x {rows}: the project has no such image, or the mask no pixels")
        return mask

    def set_result(self, response: Response, vignetting: Vignetting, exposures: Union[np.ndarray, Iterable[Exposure]],
                   reference: int = 0) -> None:
        """Puts a result into the project: one response, one vignetting, an exposure an image (Exposure, or
        EXPOSURE_DTYPE).

        A response other than EMoR with at most 5 modes becomes its least squares projection on Hugin's 5. Exposures are
        taken relative to that of image `reference`, which keeps its own.
        """
        given = _arrays.exposures(exposures)
        pointer, count = _arrays.structured(given, _arrays.EXPOSURE_DTYPE, _abi.Exposure, "exposures")
        with self._use() as pto:
            check(lib.lensprof_pto_set_result(pto, byref(response), byref(vignetting), pointer, count,
                                              integer(reference, "reference")),
                  f"{count} exposures, reference {reference}: give one valid exposure an image, and valid curves")

    def write(self) -> bytes:
        """The project as text: what was read, unchanged but for what was set."""
        with self._use() as pto:
            return _written(lambda *buffer: lib.lensprof_pto_write(pto, *buffer), "the project cannot be written")


def points_read(text: Union[str, bytes]) -> np.ndarray:
    """The pairs of a point file (vig_optimize -w, 16 numbers a line): an array of PAIR_DTYPE."""
    data, found, error = _bytes(text), c_uint32(), _abi.ErrorText()
    check(lib.lensprof_points_read(data, len(data), None, 0, byref(found), byref(error)),
          "points cannot be read", error)
    pairs = np.empty(found.value, dtype=_arrays.PAIR_DTYPE)
    check(lib.lensprof_points_read(data, len(data), *_arrays.pairs(pairs), byref(found), byref(error)),
          "points cannot be read", error)
    return pairs


def points_write(pairs: np.ndarray, cameras: Sequence[Camera]) -> bytes:
    """A point file of pairs (PAIR_DTYPE). The cameras give the frame sizes for the radius columns."""
    pointer, count = _arrays.pairs(pairs)
    frames = (_abi.Camera * len(cameras))(*cameras)
    return _written(lambda *buffer: lib.lensprof_points_write(pointer, count, frames, len(frames), *buffer),
                    f"{count} pairs over {len(cameras)} cameras: image numbers must be below that, sizes above 0, "
                    "numbers finite")


def lensfun_read(text: Union[str, bytes], source: str = "") -> list[tuple[Profile, bool]]:
    """The falloffs of a Lensfun database (.xml) as profiles of about 50 kB each, in the order of the file.

    False stands beside those that are no falloff, which cannot be stored or applied; provenance.doubt says why, and may
    warn of others. source: where the text is from, for provenance.source.
    """
    data, error, name = _bytes(text), _abi.ErrorText(), _bytes(source)
    if b"\0" in name:
        raise ValueError(f"{source!r}: a source holds no zero bytes")
    found: list[tuple[Profile, bool]] = []
    raised: list[BaseException] = []

    def visit(_user: Any, entry: Any) -> int:
        try:
            found.append((Profile.from_buffer_copy(entry.contents.profile.contents), bool(entry.contents.usable)))
            return Status.OK
        except BaseException as exception:  # must not cross C
            raised.append(exception)
            return Status.ERROR_CANCELLED

    status = lib.lensprof_lensfun_read(data, len(data), name, _abi.ImportVisitor(visit), None, byref(error))
    if raised:
        raise raised[0]
    check(status, "the database cannot be read", error)
    return found


def lensfun_write(profiles: Iterable[Profile]) -> str:
    """A Lensfun database (.xml) of the falloffs of profiles, whose lens, crop factor, focal length and aperture are
    known."""
    given, error = list(profiles), _abi.ErrorText()
    if not all(isinstance(profile, Profile) for profile in given):
        raise TypeError("profiles takes an iterable of Profile")
    kind, needed = POINTER(_abi.Profile), c_size_t()
    pointers = (kind * len(given))(*(cast(byref(profile), kind) for profile in given))
    status = lib.lensprof_lensfun_write(pointers, len(given), None, 0, byref(needed), byref(error))
    if status != Status.ERROR_CAPACITY:
        check(status, "the database cannot be written", error)
    buffer = create_string_buffer(needed.value)
    check(lib.lensprof_lensfun_write(pointers, len(given), buffer, needed.value, byref(needed), byref(error)),
          "the database cannot be written", error)
    return buffer.raw.decode()
