"""Files of other programs, from and to memory; see lensprof/formats.h."""
from __future__ import annotations

import os
import re
from ctypes import POINTER, byref, c_double, c_float, c_size_t, c_uint32, cast, create_string_buffer, pointer
from typing import Any, Callable, Iterable, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _abi, _arrays
from ._abi import CurveKind, DngForm, Format, Free, Holds, Layout, MapSense, Pack, Status
from ._library import Handle, check, initialised, lib
from ._struct import Enumerated, Flag, Nested, Text, Value, Vector, integer, one_or_three
from .geometry import Camera
from .model import Exposure, Response, Vignetting
from .profile import CameraModel, Profile, ProfileKey


def _bytes(text: Union[str, bytes]) -> bytes:
    return text.encode("utf-8", "surrogateescape") if isinstance(text, str) else bytes(text)


_FILE_NAME = re.compile(r"[^\n<{]{1,4095}\.[A-Za-z]\w{0,9}")  # a line that ends like a name: no file's content does


def _content(data: Union[str, bytes], what: str = "data") -> bytes:
    """The content of a file; a path is refused."""
    if isinstance(data, os.PathLike) or isinstance(data, str) and _FILE_NAME.fullmatch(data):
        raise TypeError(f"{what} takes the content of a file, and not its name; give Path({os.fspath(data)!r}).read_bytes()")
    if isinstance(data, str):
        return _bytes(data)
    try:
        return bytes(memoryview(data))
    except TypeError:
        raise TypeError(f"{what} takes the content of a file as bytes or str, and not {type(data).__name__}") from None


def _format(format: Format) -> int:
    if isinstance(format, str):
        member = format.upper() if format.upper() in Format.__members__ else "JSON"
        raise TypeError(f"format takes a lensprof.Format, such as Format.{member}, and not {format!r}")
    return int(Format(format))


def _written(write: Callable[..., int], what: str) -> bytes:
    """Calls write(data, capacity, count, error): asks for the size, then for the bytes."""
    error, count = _abi.ErrorText(), c_size_t()
    check(write(None, 0, byref(count), byref(error)), what, error)
    buffer = create_string_buffer(count.value)
    check(write(buffer, count.value, byref(count), byref(error)), what, error)
    return buffer.raw


class PtoImage(Value, _abi.PtoImage):
    """One `i` line with its links resolved.

    emor: Ra..Re. response_type: 0 EMoR, 1 linear. free: requested by the `v` lines. response_of, vignetting_of,
    center_of, ev_of, red_of, blue_of: index of the image at the end of the link; own index if not linked. crop: left,
    top, right, bottom (exclusive), px. left_out: the result in the project excludes this image.
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
    left_out = Flag()


class Pto(Handle):
    """A Hugin project (.pto). A context manager; may also be left to the garbage collector."""

    def __init__(self, text: Union[str, bytes]):
        """Parses a project, e.g. Path("pano.pto").read_bytes()."""
        data, handle, error = _content(text, "text"), POINTER(_abi.Pto)(), _abi.ErrorText()
        check(lib.lensprof_pto_read(data, len(data), byref(handle), byref(error)), "the project cannot be read", error)
        super().__init__(handle, lib.lensprof_pto_destroy)

    def __len__(self) -> int:
        """Number of images."""
        with self._use() as pto:
            return lib.lensprof_pto_image_count(pto)

    def _no_image(self, index: int) -> str:
        return f"image {index}: the project has no such image; count from 0"

    def image(self, index: int) -> PtoImage:
        """The `i` line of an image, in the conventions of lensprof."""
        image, error = PtoImage(), _abi.ErrorText()
        with self._use() as pto:
            check(lib.lensprof_pto_get_image(pto, integer(index, "index"), byref(image), byref(error)),
                  self._no_image(index), error)
        return image

    def response(self, index: int) -> Response:
        """The response of an image as evaluated by Hugin."""
        response, error = Response(), _abi.ErrorText()
        with self._use() as pto:
            check(lib.lensprof_pto_get_response(pto, integer(index, "index"), byref(response), byref(error)),
                  self._no_image(index), error)
        return response

    def name(self, index: int) -> str:
        """File name of an image as written, relative to the project's folder; other bytes as with os.fsdecode."""
        number = integer(index, "index")
        with self._use() as pto:
            text = _written(lambda *buffer: lib.lensprof_pto_get_name(pto, number, *buffer), self._no_image(index))
        return text.decode("utf-8", "surrogateescape")

    def set_name(self, index: int, name: str) -> None:
        """Changes the file name of an image, for a project that is written to another folder."""
        text, error = _bytes(name), _abi.ErrorText()
        if b"\0" in text:
            raise ValueError(f"{name!r}: a file name holds no zero bytes")
        with self._use() as pto:
            check(lib.lensprof_pto_set_name(pto, integer(index, "index"), text, byref(error)), repr(name), error)

    def draw_mask(self, index: int, mask: np.ndarray) -> np.ndarray:
        """Draws the mask of places where pairs may be taken from an image into a uint8 or bool array (height, width):
        1, otherwise 0. Returns the array.

        The array is a view of the whole frame at its own size.
        """
        rows, columns = (mask.shape + (0, 0))[:2]
        pixels, row_bytes = _arrays.mask(mask, (rows, columns), writable=True)
        error = _abi.ErrorText()
        with self._use() as pto:
            check(lib.lensprof_pto_draw_mask(pto, integer(index, "index"), pixels, integer(columns, "columns"),
                                             integer(rows, "rows"), row_bytes, byref(error)),
                  f"mask of {columns} x {rows}", error)
        return mask

    def set_result(self, response: Response, vignetting: Vignetting, exposures: Union[np.ndarray, Iterable[Exposure]],
                   reference: int = 0) -> None:
        """Writes a result into the project: one response, one vignetting, an exposure per image (Exposure, or
        EXPOSURE_DTYPE).

        A response other than EMoR with at most 5 modes becomes its least squares projection on Hugin's 5. Exposures are
        taken relative to that of image `reference`, which keeps its own.
        """
        given = _arrays.exposures(exposures)
        pointer, count = _arrays.structured(given, _arrays.EXPOSURE_DTYPE, _abi.Exposure, "exposures")
        error = _abi.ErrorText()
        with self._use() as pto:
            check(lib.lensprof_pto_set_result(pto, byref(response), byref(vignetting), pointer, count,
                                              integer(reference, "reference"), byref(error)),
                  f"{count} exposures, reference {reference}", error)

    def set_settings(self, settings: Iterable[int], vignetting: Iterable[Vignetting]) -> None:
        """Writes a falloff per lens setting. settings: setting number of each image, 0 .. len(vignetting) - 1. The
        first image of each setting receives the falloff, and the others are linked to it."""
        numbers = [integer(number, "a setting") for number in settings]
        curves = list(vignetting)
        error = _abi.ErrorText()
        with self._use() as pto:
            check(lib.lensprof_pto_set_settings(pto, (c_uint32 * len(numbers))(*numbers), len(numbers),
                                                (_abi.Vignetting * len(curves))(*curves), len(curves), byref(error)),
                  f"{len(numbers)} settings, {len(curves)} vignettings", error)

    def set_cameras(self, cameras: Iterable[int], response: Iterable[Response]) -> None:
        """Writes a response per camera. cameras: camera number of each image, 0 .. len(response) - 1. The first image
        of each camera receives the response, and the others are linked to it. Call it after set_result."""
        numbers = [integer(number, "a camera") for number in cameras]
        curves = list(response)
        error = _abi.ErrorText()
        with self._use() as pto:
            check(lib.lensprof_pto_set_cameras(pto, (c_uint32 * len(numbers))(*numbers), len(numbers),
                                               (_abi.Response * len(curves))(*curves), len(curves), byref(error)),
                  f"{len(numbers)} cameras, {len(curves)} responses", error)

    def write(self) -> bytes:
        """The project as text. Everything that was read stays unchanged, except what was set."""
        with self._use() as pto:
            return _written(lambda *buffer: lib.lensprof_pto_write(pto, *buffer), "the project cannot be written")


def points_read(text: Union[str, bytes]) -> np.ndarray:
    """The pairs of a point file (vig_optimize -w, 16 numbers per line): an array of PAIR_DTYPE."""
    data, found, error = _content(text, "text"), c_uint32(), _abi.ErrorText()
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
                    f"{count} pairs over {len(cameras)} cameras")


def _imported(read: Callable[..., int], source: str, what: str) -> list[tuple[Profile, bool]]:
    """Calls read(source, visitor, user, error) and gathers the entries."""
    error, name = _abi.ErrorText(), _bytes(source)
    if b"\0" in name:
        raise ValueError(f"{source!r}: a source holds no zero bytes")
    found: list[tuple[Profile, bool]] = []
    raised: list[BaseException] = []

    def visit(_user: Any, entry: Any) -> int:
        try:
            found.append((Profile._copy_of(entry.contents.profile), bool(entry.contents.usable)))
            return Status.OK
        except BaseException as exception:  # must not cross C
            raised.append(exception)
            return Status.ERROR_CANCELLED

    status = read(name, _abi.ImportVisitor(visit), None, byref(error))
    if raised:
        raise raised[0]
    check(status, what, error)
    return found


def _database(write: Callable[..., int], profiles: Iterable[Profile], settings: tuple, what: str) -> bytes:
    """Calls write(profiles, count, *settings, data, capacity, count, error)."""
    given = list(profiles)
    if not all(isinstance(profile, Profile) for profile in given):
        raise TypeError("profiles takes an iterable of Profile")
    kind = POINTER(_abi.Profile)
    pointers = (kind * len(given))(*(cast(byref(profile), kind) for profile in given))
    return _written(lambda *buffer: write(pointers, len(given), *settings, *buffer), what)


def lensfun_read(text: Union[str, bytes], source: str = "") -> list[tuple[Profile, bool]]:
    """The falloffs of a Lensfun database (.xml) as (profile, usable), about 50 kB each, in file order.

    usable is False for an invalid falloff, which cannot be stored or applied; provenance.doubt states the reason, and
    may have a warning for others. source: origin of the text, for provenance.source.
    """
    data = _content(text, "text")
    return _imported(lambda *rest: lib.lensprof_lensfun_read(data, len(data), *rest), source,
                     "the database cannot be read")


def lensfun_read_cameras(text: Union[str, bytes], source: str = "") -> list[CameraModel]:
    """The cameras of a Lensfun database (.xml), for Store.put_camera()."""
    data, error, name = _content(text, "text"), _abi.ErrorText(), _bytes(source)
    found: list[CameraModel] = []
    raised: list[BaseException] = []

    def visit(_user: Any, camera: Any) -> int:
        try:
            found.append(CameraModel.from_buffer_copy(camera.contents))
            return Status.OK
        except BaseException as exception:  # must not cross C
            raised.append(exception)
            return Status.ERROR_CANCELLED

    status = lib.lensprof_lensfun_read_cameras(data, len(data), name, _abi.CameraVisitor(visit), None, byref(error))
    if raised:
        raise raised[0]
    check(status, "the database cannot be read", error)
    return found


def lensfun_write(profiles: Iterable[Profile]) -> str:
    """A Lensfun database (.xml) of the falloffs of profiles with known lens, crop factor, focal length and aperture."""
    return _database(lib.lensprof_lensfun_write, profiles, (), "the database cannot be written").decode()


def json_read(text: Union[str, bytes], source: str = "") -> list[Profile]:
    """The profiles in JSON, as printed by `lensprof profile show --json` or made by json_write.

    source: origin of the text, for provenance.source if the text does not contain it.
    """
    data = _content(text, "text")
    found = _imported(lambda *rest: lib.lensprof_json_read(data, len(data), *rest), source, "the profiles cannot be read")
    return [profile for profile, _ in found]


def json_write(profiles: Iterable[Profile]) -> str:
    """Profiles as JSON (docs/json.md); json_read restores the same profiles."""
    return _database(lib.lensprof_json_write, profiles, (), "the profiles cannot be written").decode()


def pcalib_read(text: Union[str, bytes]) -> Response:
    """The response of a pcalib.txt of TUM's tools, DSO and related programs: 256 (or up to 65536) increasing
    irradiances."""
    data, response, error = _content(text, "text"), Response(), _abi.ErrorText()
    check(lib.lensprof_pcalib_read(data, len(data), byref(response), byref(error)), "pcalib cannot be read", error)
    return response


def pcalib_write(response: Response) -> str:
    """A pcalib.txt: 256 irradiances from 0 to 255, strictly increasing."""
    return _written(lambda *buffer: lib.lensprof_pcalib_write(byref(response), *buffer),
                    "pcalib cannot be written").decode()


class FrameTime(Value, _abi.FrameTime):
    """A line of times.txt: id as written, time_s, exposure_ms (UNKNOWN if missing)."""

    id = Text()
    time_s: float
    exposure_ms: float


def times_read(text: Union[str, bytes]) -> list[FrameTime]:
    """The frames of a times.txt: name, time stamp and, if known, exposure time on each line."""
    data, found, error = _content(text, "text"), c_uint32(), _abi.ErrorText()
    check(lib.lensprof_times_read(data, len(data), None, 0, byref(found), byref(error)), "times cannot be read", error)
    frames = (_abi.FrameTime * found.value)()
    check(lib.lensprof_times_read(data, len(data), frames, len(frames), byref(found), byref(error)),
          "times cannot be read", error)
    return [FrameTime.from_buffer_copy(frame) for frame in frames]


def times_write(frames: Iterable[FrameTime]) -> str:
    """A times.txt of frames."""
    given = list(frames)
    array = (_abi.FrameTime * len(given))(*given)
    return _written(lambda *buffer: lib.lensprof_times_write(array, len(given), *buffer),
                    "times cannot be written").decode()


def curves_read(text: Union[str, bytes], kind: CurveKind = CurveKind.INVERSE) -> list[Response]:
    """One or three responses of a text table (CSV, or .m of pfstools). The table does not state its content: pass
    it."""
    data, found, error = _content(text, "text"), c_uint32(), _abi.ErrorText()
    responses = (_abi.Response * 3)()
    check(lib.lensprof_curves_read(data, len(data), int(CurveKind(kind)), responses, byref(found), byref(error)),
          "the table cannot be read", error)
    return [Response.from_buffer_copy(responses[i]) for i in range(found.value)]


def curves_write(responses: Union[Response, Iterable[Response]], kind: CurveKind = CurveKind.INVERSE,
                 rows: int = 256) -> str:
    """One or three responses as CSV."""
    given = one_or_three(responses, Response, "responses")
    array = (_abi.Response * len(given))(*given)
    return _written(lambda *buffer: lib.lensprof_curves_write(array, len(given), int(CurveKind(kind)),
                                                              integer(rows, "rows"), *buffer),
                    "the table cannot be written").decode()


def _refitted(read: Callable[..., int], profile: Optional[Profile], what: str) -> tuple[Profile, float]:
    """A copy of the profile (or a new one) with the falloff that was read, and its largest relative error."""
    found, worst, error = profile.copy() if profile is not None else Profile(), c_double(), _abi.ErrorText()
    check(read(byref(found), byref(worst), byref(error)), what, error)
    return found, worst.value


def map_read(values: np.ndarray, sense: MapSense = MapSense.ATTENUATION, frame: Optional[tuple[int, int]] = None,
             profile: Optional[Profile] = None) -> tuple[Profile, float]:
    """The falloff of a map (rows, columns) or (rows, columns, 3), and the largest relative error left.

    Values are linear, in any unit; 0 = unknown. frame: width and height of the pictures it applies to, px; by default
    those of the map. profile: copied for the rest of the result.
    """
    array = np.ascontiguousarray(values, dtype=np.float32)
    if array.ndim not in (2, 3):
        raise ValueError(f"a map of shape {array.shape}; give (rows, columns) or (rows, columns, 3)")
    rows, columns = array.shape[:2]
    given = initialised(_abi.Map, columns=columns, rows=rows, channels=array.shape[2] if array.ndim == 3 else 1,
                        sense=int(MapSense(sense)), values=_arrays.address(array, c_float))
    width, height = frame if frame is not None else (columns, rows)
    return _refitted(lambda *out: lib.lensprof_map_read(byref(given), integer(width, "width"), integer(height, "height"),
                                                        *out), profile, "the map cannot be read")


def map_write(profile: Profile, frame: tuple[int, int], size: Optional[tuple[int, int]] = None, channels: int = 1,
              sense: MapSense = MapSense.ATTENUATION) -> np.ndarray:
    """Falloff and gain grid as a float32 map of size (columns, rows), by default that of the frame (width, height).

    The largest attenuation is 1. With 1 channel: (rows, columns), the mean of the profile's channels; with 3: (rows,
    columns, 3).
    """
    columns, rows = size if size is not None else frame
    values = np.empty((integer(rows, "rows"), integer(columns, "columns"), integer(channels, "channels")), np.float32)
    error = _abi.ErrorText()
    check(lib.lensprof_map_write(byref(profile), integer(frame[0], "width"), integer(frame[1], "height"), columns, rows,
                                 channels, int(MapSense(sense)), _arrays.address(values, c_float), byref(error)),
          "the map cannot be written", error)
    return values[:, :, 0] if channels == 1 else values


def radical_response_read(data: bytes) -> list[Response]:
    """The responses of red, green and blue of a .crf file of radical."""
    given, responses, error = _content(data), (_abi.Response * 3)(), _abi.ErrorText()
    check(lib.lensprof_radical_response_read(given, len(given), responses, byref(error)), "the file cannot be read", error)
    return [Response.from_buffer_copy(response) for response in responses]


def radical_response_write(responses: Union[Response, Iterable[Response]]) -> bytes:
    """A .crf file of radical."""
    given = one_or_three(responses, Response, "responses")
    array = (_abi.Response * len(given))(*given)
    return _written(lambda *buffer: lib.lensprof_radical_response_write(array, len(given), *buffer),
                    "the file cannot be written")


def radical_vignetting_read(data: bytes, profile: Optional[Profile] = None) -> tuple[Profile, float]:
    """The falloff of a .vgn file of radical, and the largest relative error left; as map_read."""
    given = _content(data)
    return _refitted(lambda *out: lib.lensprof_radical_vignetting_read(given, len(given), *out), profile,
                     "the file cannot be read")


def radical_vignetting_write(profile: Profile, width: int, height: int) -> bytes:
    """A .vgn file of radical for pictures of width x height px."""
    return _written(lambda *buffer: lib.lensprof_radical_vignetting_write(byref(profile), integer(width, "width"),
                                                                          integer(height, "height"), *buffer),
                    "the file cannot be written")


def dng_opcodes_read(data: bytes, width: int, height: int, layout: Layout = Layout.RGB,
                     source: str = "") -> tuple[Profile, bool]:
    """The falloff of a DNG opcode list, the bytes of the tag OpcodeList2 or OpcodeList3, and whether it is usable.

    width, height: of the frame that the opcodes apply to. layout: RGGB, GRBG, GBRG or BGGR for a mosaic (OpcodeList2),
    RGB for three planes (OpcodeList3), GREY for one. provenance.doubt lists opcodes that are left out.
    """
    given = _content(data)
    (entry,) = _imported(
        lambda *rest: lib.lensprof_dng_opcodes_read(given, len(given), integer(width, "width"), integer(height, "height"),
                                                    integer(layout, "layout"), *rest),
        source, "the opcodes cannot be read")
    return entry


def dng_opcodes_write(profile: Profile, width: int, height: int, layout: Layout = Layout.RGB,
                      form: DngForm = DngForm.GAIN_MAP) -> tuple[bytes, float]:
    """The falloff of a profile as a DNG opcode list, and the largest relative error of its gains within the frame."""
    if not isinstance(profile, Profile):
        raise TypeError("profile takes a Profile")
    worst = c_double()
    numbers = (integer(width, "width"), integer(height, "height"), integer(layout, "layout"), integer(form, "form"))
    text = _written(lambda *buffer: lib.lensprof_dng_opcodes_write(byref(profile), *numbers, *buffer[:3], byref(worst),
                                                                   buffer[3]), "the opcodes cannot be written")
    return text, worst.value


def lcp_read(text: Union[str, bytes], source: str = "") -> list[tuple[Profile, bool]]:
    """The falloffs of an Adobe lens profile (.lcp), in the form of lensfun_read."""
    data = _content(text, "text")
    return _imported(lambda *rest: lib.lensprof_lcp_read(data, len(data), *rest), source,
                     "the lens profile cannot be read")


def lcp_write(profiles: Iterable[Profile], width: int = 0, height: int = 0) -> str:
    """An Adobe lens profile (.lcp) of the falloffs of profiles of one camera and lens, with known crop factor, focal
    length and aperture. width, height: of the frames; both 0 = unknown, taken as 3:2."""
    return _database(lib.lensprof_lcp_write, profiles, (integer(width, "width"), integer(height, "height")),
                     "the lens profile cannot be written").decode()


def drone_xmp_read(text: Union[str, bytes], width: int, height: int, source: str = "") -> tuple[Profile, bool]:
    """The falloff that a MicaSense, Parrot Sequoia, DJI or Sentera camera writes into the XMP packet of a picture of
    width x height pixels, and whether it is usable."""
    data = _content(text, "text")
    (entry,) = _imported(
        lambda *rest: lib.lensprof_drone_xmp_read(data, len(data), integer(width, "width"), integer(height, "height"),
                                                  *rest),
        source, "the XMP packet cannot be read")
    return entry


def alsc_read(text: Union[str, bytes], frame: tuple[int, int], ct: float = _abi.UNKNOWN,
              size: tuple[int, int] = (0, 0), profile: Optional[Profile] = None) -> tuple[Profile, float]:
    """The falloff of a libcamera tuning file for the Raspberry Pi, and the largest relative error left.

    frame: width and height of the sensor, px. ct: colour temperature, K; by default that of the file. size: columns and
    rows of tables other than 16 x 12 and 32 x 32. profile: as in map_read.
    """
    data, numbers = _content(text, "text"), [integer(n, "columns, rows, width or height") for n in (*size, *frame)]
    return _refitted(lambda *out: lib.lensprof_alsc_read(data, len(data), ct, *numbers, *out), profile,
                     "the tables cannot be read")


def alsc_write(profile: Profile, frame: tuple[int, int], ct: float = _abi.UNKNOWN,
               size: tuple[int, int] = (16, 12)) -> str:
    """Falloff and gain grid as the "rpi.alsc" of a tuning file, with tables of size (columns, rows)."""
    numbers = [integer(n, "columns, rows, width or height") for n in (*size, *frame)]
    return _written(lambda *buffer: lib.lensprof_alsc_write(byref(profile), ct, *numbers, *buffer),
                    "the tables cannot be written").decode()


class FormatInfo(NamedTuple):
    """A format: its name, a description, the content of its files, whether it can be written, and whether it holds
    several."""

    name: str
    about: str
    holds: Holds
    is_written: bool
    is_many: bool


def format_info(format: Format) -> FormatInfo:
    """Description of a format other than AUTO."""
    found = lib.lensprof_format_get_info(_format(format))
    if not found:
        raise ValueError("AUTO is not a format here; pass another lensprof.Format")
    info = found.contents
    return FormatInfo(info.name.decode(), info.about.decode(), Holds(info.holds), bool(info.is_written), bool(info.is_many))


def detect_format(data: Union[str, bytes], name: str = "") -> Format:
    """The format of a file by its content, then by the ending of its name; Format.AUTO if neither decides."""
    content = _content(data)
    return Format(lib.lensprof_format_detect(content, len(content), _bytes(name)))


def import_profiles(data: Union[str, bytes], name: str = "", *, format: Format = Format.AUTO,
                    key: Optional[ProfileKey] = None, frame: tuple[int, int] = (0, 0), tables: tuple[int, int] = (0, 0),
                    layout: Layout = Layout.RGB, curve: CurveKind = CurveKind.INVERSE,
                    color_temperature_k: float = _abi.UNKNOWN, strict: bool = False) -> list[tuple[Profile, bool]]:
    """The profiles of a file of any format, in the form of lensfun_read. data: the content of the file.

    A response or a falloff makes one profile with `key`. name: of the file, for detection and provenance.source. frame:
    width and height of the pictures, which opcodes, XMP and alsc do not contain. tables: columns and rows, of alsc. The
    bytes are those of the format, not of a picture around them: opcodes without their DNG, XMP without its JPEG.
    strict: refuse a response that decreases anywhere, instead of reading the nearest increasing curve.
    """
    content, options = _content(data), initialised(_abi.ImportOptions)
    options.format, options.layout, options.curve = _format(format), int(Layout(layout)), int(CurveKind(curve))
    options.width, options.height = (integer(side, "frame") for side in frame)
    options.columns, options.rows = (integer(side, "tables") for side in tables)
    options.color_temperature_k = color_temperature_k
    options.strict = int(strict)
    if key is not None:
        options.key = pointer(_abi.ProfileKey.from_buffer(key))

    def read(source: bytes, *rest: Any) -> int:
        options.name = source
        return lib.lensprof_import(content, len(content), byref(options), *rest)

    return _imported(read, name, "the file cannot be read")


def export_profiles(profiles: Iterable[Profile], name: str = "", *, format: Format = Format.AUTO,
                    frame: tuple[int, int] = (0, 0), tables: tuple[int, int] = (0, 0), layout: Layout = Layout.RGB,
                    form: DngForm = DngForm.AUTO, curve: CurveKind = CurveKind.INVERSE, covariance: bool = False,
                    color_temperature_k: float = _abi.UNKNOWN) -> bytes:
    """A file in any format that can be written, selected by `format` or the ending of the name: of all profiles if the
    format holds several, otherwise of one. frame, tables: as for import_profiles; rows of curves are tables[1]. form:
    of opcodes. covariance: of a blob."""
    for other in Format:
        if other and not format and format_info(other).name == name:
            raise ValueError(f"{name!r} is a format and not the name of a file; give format=Format.{other.name}")
    options, text = initialised(_abi.ExportOptions), _bytes(name)
    options.format, options.layout, options.curve = _format(format), int(Layout(layout)), int(CurveKind(curve))
    options.width, options.height = (integer(side, "frame") for side in frame)
    options.columns, options.rows = (integer(side, "tables") for side in tables)
    options.dng_form, options.pack = int(DngForm(form)), int(Pack.COVARIANCE) if covariance else 0
    options.color_temperature_k, options.name = color_temperature_k, text
    return _database(lib.lensprof_export, profiles, (byref(options),), "the file cannot be written")
