"""Files of other programs; see lensprof/formats.h.

Readers take the path of a file or its content as bytes; `write_` functions write a file, `encode_` functions give bytes.
"""
from __future__ import annotations

import math
import os
import pathlib
from ctypes import (POINTER, byref, c_double, c_float, c_size_t, c_uint32, c_void_p, cast, create_string_buffer,
                    pointer)
from typing import TYPE_CHECKING, Any, Callable, Iterable, NamedTuple, Optional, Sequence, TypedDict, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _abi, _arrays
from ._abi import CurveKind, DngForm, Format, Free, Holds, Layout, MapSense, Pack, Status
from ._library import Handle, check, initialised, lib
from ._paths import PathLike, Source, optional_text, raw_text
from ._struct import Enumerated, Flag, Nested, Text, Value, Vector, default, integer, one_or_three
from ._types import Records
from .geometry import Camera
from .model import Exposure, Response, Vignetting
from .profile import CameraModel, Profile, ProfileKey, profile_pointers

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["CurveKind", "DngForm", "Exposures", "ExposuresCamera", "ExposuresImage", "ExposuresLens", "Format",
           "FormatInfo", "Holds", "MapSense", "Pto", "PtoImage", "ReadProfile", "WriteOptions", "detect",
           "encode_exposures", "encode_points", "encode_profiles", "info", "read_exposures", "read_lensfun_cameras",
           "read_map", "read_points", "read_profiles", "write_exposures", "write_map", "write_points",
           "write_profiles"]

Mask = TypeVar("Mask", bound="npt.NDArray[Any]")
T = TypeVar("T")


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")


def _content(source: Source) -> bytes:
    """The content of a file that is given by its path, or as bytes."""
    if isinstance(source, (str, os.PathLike)):
        return pathlib.Path(source).read_bytes()
    try:
        return bytes(memoryview(source))
    except TypeError:
        raise TypeError(f"give the path of a file or its bytes, not {type(source).__name__}") from None


def _name(source: Source, name: str = "") -> str:
    """The name of a file: as given, or that of its path."""
    return name or (os.path.basename(source) if isinstance(source, (str, os.PathLike)) else "")


def _format(format: Format) -> int:
    if isinstance(format, str):
        member = format.upper() if format.upper() in Format.__members__ else "JSON"
        raise TypeError(f"format takes a lensprof.formats.Format, such as Format.{member}, and not {format!r}")
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

    camera: Nested[Camera] = Nested(Camera)
    exposure: Nested[Exposure] = Nested(Exposure)
    vignetting: Nested[Vignetting] = Nested(Vignetting)
    emor: Vector = Vector()
    response_type: int = default
    free: Enumerated[Free] = Enumerated(Free)
    response_of: int = default
    vignetting_of: int = default
    center_of: int = default
    ev_of: int = default
    red_of: int = default
    blue_of: int = default
    crop: Vector = Vector()
    crop_circular: Flag = Flag()
    left_out: Flag = Flag()
    of_crop: Flag = Flag()


class Pto(Handle):
    """A Hugin project (.pto). A context manager; may also be left to the garbage collector."""

    def __init__(self, source: Source):
        """Reads a project: its path, such as "pano.pto", or its bytes."""
        data, handle, error = _content(source), POINTER(_abi.Pto)(), _abi.ErrorText()
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
        text, error = raw_text(name, "a file name"), _abi.ErrorText()
        with self._use() as pto:
            check(lib.lensprof_pto_set_name(pto, integer(index, "index"), text, byref(error)), repr(name), error)

    def draw_mask(self, index: int, mask: Mask) -> Mask:
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

    def set_result(self, response: Response, vignetting: Vignetting, exposures: Union[Records, Iterable[Exposure]],
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

    def __bytes__(self) -> bytes:
        """The project as text. Everything that was read stays unchanged, except what was set."""
        with self._use() as pto:
            return _written(lambda *buffer: lib.lensprof_pto_write(pto, *buffer), "the project cannot be written")

    def write(self, path: PathLike) -> None:
        """Writes bytes(self), the project, to a file."""
        pathlib.Path(path).write_bytes(bytes(self))

    def __repr__(self) -> str:
        return f"Pto({len(self)} images)"


def read_points(source: Source) -> Records:
    """The pairs of a point file (vig_optimize -w, 16 numbers per line): an array of PAIR_DTYPE."""
    data, found, error = _content(source), c_uint32(), _abi.ErrorText()
    check(lib.lensprof_points_read(data, len(data), None, 0, byref(found), byref(error)),
          "points cannot be read", error)
    pairs = np.empty(found.value, dtype=_arrays.PAIR_DTYPE)
    check(lib.lensprof_points_read(data, len(data), *_arrays.pairs(pairs), byref(found), byref(error)),
          "points cannot be read", error)
    return pairs


def write_points(path: PathLike, pairs: Records, cameras: Sequence[Camera]) -> None:
    """Writes a point file of pairs (PAIR_DTYPE). The cameras give the frame sizes for the radius columns."""
    pathlib.Path(path).write_bytes(encode_points(pairs, cameras))


def encode_points(pairs: Records, cameras: Sequence[Camera]) -> bytes:
    """The same as bytes."""
    pointer, count = _arrays.pairs(pairs)
    frames = (_abi.Camera * len(cameras))(*cameras)
    return _written(lambda *buffer: lib.lensprof_points_write(pointer, count, frames, len(frames), *buffer),
                    f"{count} pairs over {len(cameras)} cameras")


class ExposuresCamera(NamedTuple):
    """A camera of exposures.json. name: such as "Canon EOS 6D"."""

    response: Response
    name: Optional[str] = None


class ExposuresLens(NamedTuple):
    """A lens setting of exposures.json. camera: index. vignetting: one falloff, or those of red, green and blue. name:
    such as "50 mm, f/2.8"."""

    camera: int
    vignetting: tuple[Vignetting, ...]
    name: Optional[str] = None


class ExposuresImage(NamedTuple):
    """An image of exposures.json. size: width and height, px. lens: index. exposure: relative to the reference; None: no
    result. file: path of the picture, relative to the folder of the file. ev_sigma (EV), white_balance_sigma: standard
    errors; None: unknown."""

    name: str
    size: tuple[int, int]
    lens: int
    exposure: Optional[Exposure]
    file: Optional[str] = None
    ev_sigma: Optional[float] = None
    white_balance_sigma: tuple[Optional[float], ...] = (None, None, None)


class Exposures(NamedTuple):
    """The content of exposures.json. reference: index of the image whose exposure is 0 EV. software: program that wrote
    it; None to write: this version of lensprof."""

    cameras: list[ExposuresCamera]
    lenses: list[ExposuresLens]
    images: list[ExposuresImage]
    reference: int = 0
    software: Optional[str] = None


def _text_or_none(text: Optional[bytes]) -> Optional[str]:
    return None if text is None else text.decode()


def _known_or_none(value: float) -> Optional[float]:
    return None if value == _abi.UNKNOWN else value


def _known(value: Optional[float]) -> float:
    return _abi.UNKNOWN if value is None else value


def _exposures_image(raw: Any) -> ExposuresImage:
    exposure = None if math.isnan(raw.exposure.ev) else Exposure.from_buffer_copy(raw.exposure)
    return ExposuresImage(raw.name.decode(), (raw.width, raw.height), raw.lens, exposure, _text_or_none(raw.file),
                          _known_or_none(raw.ev_sigma), tuple(map(_known_or_none, raw.white_balance_sigma)))


def read_exposures(source: Source) -> Exposures:
    """The content of exposures.json, as Calibration.save writes it: its path or its bytes."""
    data, handle, error = _content(source), POINTER(_abi.Exposures)(), _abi.ErrorText()
    check(lib.lensprof_exposures_read(data, len(data), byref(handle), byref(error)), "exposures cannot be read", error)

    def got(get: Callable[..., int], kind: Any, *index: int) -> Any:
        raw = initialised(kind)
        check(get(handle, *index, byref(raw), byref(error)), "exposures", error)
        return raw

    try:
        info = got(lib.lensprof_exposures_get_info, _abi.ExposuresInfo)
        cameras = (got(lib.lensprof_exposures_get_camera, _abi.ExposuresCamera, i) for i in range(info.camera_count))
        lenses = (got(lib.lensprof_exposures_get_lens, _abi.ExposuresLens, i) for i in range(info.lens_count))
        images = (got(lib.lensprof_exposures_get_image, _abi.ExposuresImage, i) for i in range(info.image_count))
        return Exposures(
            [ExposuresCamera(Response.from_buffer_copy(raw.response), _text_or_none(raw.name)) for raw in cameras],
            [ExposuresLens(raw.camera, tuple(Vignetting.from_buffer_copy(curve)
                                             for curve in raw.vignetting[:raw.vignettings]), _text_or_none(raw.name))
             for raw in lenses],
            [_exposures_image(raw) for raw in images], info.reference, _text_or_none(info.software))
    finally:
        lib.lensprof_exposures_destroy(handle)


def _raw_exposures_image(image: ExposuresImage) -> Any:
    width, height = (integer(side, "size") for side in image.size)
    return initialised(_abi.ExposuresImage, name=optional_text(image.name), file=optional_text(image.file), width=width,
                       height=height, lens=integer(image.lens, "lens"),
                       exposure=Exposure(ev=math.nan) if image.exposure is None else image.exposure,
                       ev_sigma=_known(image.ev_sigma),
                       white_balance_sigma=(c_double * 3)(*map(_known, image.white_balance_sigma)))


def _raw_exposures_lens(lens: ExposuresLens) -> Any:
    return initialised(_abi.ExposuresLens, name=optional_text(lens.name), camera=integer(lens.camera, "camera"),
                       vignettings=len(lens.vignetting), vignetting=(_abi.Vignetting * 3)(*lens.vignetting[:3]))


def write_exposures(path: PathLike, exposures: Exposures) -> None:
    """Writes exposures.json, which `lensprof apply --model` and Calibration.read take."""
    pathlib.Path(path).write_bytes(encode_exposures(exposures))


def encode_exposures(exposures: Exposures) -> bytes:
    """The same as bytes."""
    cameras = [initialised(_abi.ExposuresCamera, name=optional_text(camera.name), response=camera.response)
               for camera in exposures.cameras]
    lenses = [_raw_exposures_lens(lens) for lens in exposures.lenses]
    images = [_raw_exposures_image(image) for image in exposures.images]
    info = initialised(_abi.ExposuresInfo, camera_count=len(cameras), lens_count=len(lenses), image_count=len(images),
                       reference=integer(exposures.reference, "reference"), software=optional_text(exposures.software))
    arrays = ((_abi.ExposuresCamera * len(cameras))(*cameras), (_abi.ExposuresLens * len(lenses))(*lenses),
              (_abi.ExposuresImage * len(images))(*images))
    return _written(lambda *buffer: lib.lensprof_exposures_write(byref(info), *arrays, *buffer),
                    f"{len(images)} exposures")


class ReadProfile(NamedTuple):
    """A profile of a file. usable: False for an invalid falloff, which cannot be stored or applied; provenance.doubt of
    the profile states the reason, and may have a warning for others."""

    profile: Profile
    usable: bool


def _visited(kind: Any, made: Callable[[Any], T], read: Callable[..., int], what: str) -> list[T]:
    """Calls read(visitor, user, error); returns what is made of each struct that the visitor receives."""
    error = _abi.ErrorText()
    found: list[T] = []
    raised: list[BaseException] = []

    def visit(_user: Any, struct: Any) -> int:
        try:
            found.append(made(struct.contents))
            return Status.OK
        except BaseException as exception:  # must not cross C
            raised.append(exception)
            return Status.ERROR_CANCELLED

    status = read(kind(visit), None, byref(error))
    if raised:
        raise raised[0]
    check(status, what, error)
    return found


def _imported(read: Callable[..., int], source: str, what: str) -> list[ReadProfile]:
    """Calls read(source, visitor, user, error) and gathers the entries."""
    name = raw_text(source, "a source")

    def made(entry: Any) -> ReadProfile:
        return ReadProfile(Profile._copy_of(entry.profile), bool(entry.usable))

    return _visited(_abi.ImportVisitor, made, lambda *rest: read(name, *rest), what)


def _database(write: Callable[..., int], profiles: Iterable[Profile], settings: tuple[Any, ...], what: str) -> bytes:
    """Calls write(profiles, count, *settings, data, capacity, count, error)."""
    given = profile_pointers(profiles)
    return _written(lambda *buffer: write(*given, *settings, *buffer), what)


def read_lensfun_cameras(source: Source, name: str = "") -> list[CameraModel]:
    """The cameras of a Lensfun database (.xml), for Store.put_camera(). name: of a file that is given as bytes."""
    data, file = _content(source), _bytes(_name(source, name))
    return _visited(_abi.CameraVisitor, CameraModel.from_buffer_copy,
                    lambda *rest: lib.lensprof_lensfun_read_cameras(data, len(data), file, *rest),
                    "the database cannot be read")


def _import_options(format: Format, frame: tuple[int, int], key: Optional[ProfileKey]) -> Any:
    options = initialised(_abi.ImportOptions)
    options.format = _format(format)
    options.width, options.height = (integer(side, "frame") for side in frame)
    if key is not None:
        options.key = pointer(_abi.ProfileKey.from_buffer(key))
    return options


def read_map(values: npt.ArrayLike, sense: MapSense = MapSense.ATTENUATION, frame: tuple[int, int] = (0, 0),
             key: Optional[ProfileKey] = None) -> ReadProfile:
    """The falloff of a map (rows, columns) or (rows, columns, 3) as a profile.

    Values are linear, in any unit; 0 = unknown. frame: width and height of the pictures it applies to, px; by default
    those of the map. key: as for read_profiles.
    """
    array = np.ascontiguousarray(values, dtype=np.float32)
    if array.ndim not in (2, 3):
        raise ValueError(f"a map of shape {array.shape}; give (rows, columns) or (rows, columns, 3)")
    rows, columns = array.shape[:2]
    given = initialised(_abi.Map, columns=columns, rows=rows, channels=array.shape[2] if array.ndim == 3 else 1,
                        sense=int(MapSense(sense)), values=_arrays.address(array, c_float))
    options = _import_options(Format.MAP, frame, key)
    options.map = pointer(given)
    (entry,) = _imported(lambda _source, *rest: lib.lensprof_import(None, 0, byref(options), *rest), "",
                         "the map cannot be read")
    return entry


def write_map(profile: Profile, frame: tuple[int, int], size: Optional[tuple[int, int]] = None, channels: int = 1,
              sense: MapSense = MapSense.ATTENUATION) -> npt.NDArray[np.float32]:
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


class WriteOptions(TypedDict, total=False):
    """How profiles are written. format: Format.AUTO = by the name. frame, tables: as for read_profiles; rows of curves
    and cubes are tables[1]. layout, form: of opcodes. curve: of curves and cubes. covariance: of a blob. color_temperature_k: of alsc.
    camera: of Lensfun's files, gives maker, mount and crop factor. into: a Lensfun database, to which the profiles are
    added. cost_ev: of Lensfun's files, an array of float64 with a number per profile, which receives what the file loses
    of it: the largest error in a corner of the frame relative to its middle, EV."""

    format: Format
    frame: tuple[int, int]
    tables: tuple[int, int]
    layout: Layout
    form: DngForm
    curve: CurveKind
    covariance: bool
    color_temperature_k: float
    camera: CameraModel
    into: Source
    cost_ev: npt.NDArray[np.float64]


class FormatInfo(NamedTuple):
    """A format: its name, a description, the content of its files, whether it can be written, whether it holds several,
    and whether it can be read."""

    name: str
    about: str
    holds: Holds
    is_written: bool
    is_many: bool
    is_read: bool


def info(format: Format) -> FormatInfo:
    """Description of a format other than AUTO."""
    found = lib.lensprof_format_get_info(_format(format))
    if not found:
        raise ValueError("AUTO is not a format here; pass another Format")
    info = found.contents
    written_only = 2  # is_written of C
    return FormatInfo(info.name.decode(), info.about.decode(), Holds(info.holds), bool(info.is_written), bool(info.is_many),
                      info.is_written != written_only)


def detect(source: Source, name: str = "") -> Format:
    """The format of a file by its content, then by the ending of its name; Format.AUTO if neither decides."""
    content = _content(source)
    return Format(lib.lensprof_format_detect(content, len(content), _bytes(_name(source, name))))


def read_profiles(source: Source, name: str = "", *, format: Format = Format.AUTO, key: Optional[ProfileKey] = None,
                  frame: tuple[int, int] = (0, 0), tables: tuple[int, int] = (0, 0), layout: Layout = Layout.RGB,
                  curve: CurveKind = CurveKind.INVERSE, color_temperature_k: float = _abi.UNKNOWN,
                  strict: bool = False) -> list[ReadProfile]:
    """The profiles of a file of any format, about 50 kB each, in file order.

    source: the path of the file, or its content as bytes. name: of a file that is given as bytes, for detection and
    provenance.source. A response or a falloff makes one profile with `key`. frame: width and height of the pictures,
    which opcodes, XMP and alsc do not contain. tables: columns and rows, of alsc. The bytes are those of the format, not
    of a picture around them: opcodes without their DNG, XMP without its JPEG. strict: refuse a response that decreases
    anywhere, instead of reading the nearest increasing curve.
    """
    content, options = _content(source), _import_options(format, frame, key)
    options.layout, options.curve = int(Layout(layout)), int(CurveKind(curve))
    options.columns, options.rows = (integer(side, "tables") for side in tables)
    options.color_temperature_k = color_temperature_k
    options.strict = int(strict)

    def read(file: bytes, *rest: Any) -> Any:
        options.name = file
        return lib.lensprof_import(content, len(content), byref(options), *rest)

    return _imported(read, _name(source, name), "the file cannot be read")


def write_profiles(path: PathLike, profiles: Iterable[Profile], **options: Unpack[WriteOptions]) -> None:
    """Writes a file in any format that can be written, selected by `format` or the ending of its name: of all profiles if
    the format holds several, otherwise of one."""
    pathlib.Path(path).write_bytes(encode_profiles(profiles, os.path.basename(path), **options))


def encode_profiles(profiles: Iterable[Profile], name: str = "", *, format: Format = Format.AUTO,
                    frame: tuple[int, int] = (0, 0), tables: tuple[int, int] = (0, 0), layout: Layout = Layout.RGB,
                    form: DngForm = DngForm.AUTO, curve: CurveKind = CurveKind.INVERSE, covariance: bool = False,
                    color_temperature_k: float = _abi.UNKNOWN, camera: Optional[CameraModel] = None,
                    into: Optional[Source] = None, cost_ev: Optional[npt.NDArray[np.float64]] = None) -> bytes:
    """The same as bytes; name: of the file, whose ending selects the format."""
    for other in Format:
        if other and not format and info(other).name == name:
            raise ValueError(f"{name!r} is a format and not the name of a file; give format=Format.{other.name}")
    options, text = initialised(_abi.ExportOptions), _bytes(name)
    options.format, options.layout, options.curve = _format(format), int(Layout(layout)), int(CurveKind(curve))
    options.width, options.height = (integer(side, "frame") for side in frame)
    options.columns, options.rows = (integer(side, "tables") for side in tables)
    options.dng_form, options.pack = int(DngForm(form)), int(Pack.COVARIANCE) if covariance else 0
    options.color_temperature_k, options.name = color_temperature_k, text
    if camera is not None:
        options.camera = pointer(_abi.CameraModel.from_buffer(camera))
    content = create_string_buffer(b"" if into is None else _content(into))
    if into is not None:
        options.into, options.into_size = cast(content, c_void_p), len(content) - 1
    given = list(profiles)
    if cost_ev is not None:
        options.cost_ev = _arrays.results(cost_ev, len(given), "cost_ev")
    return _database(lib.lensprof_export, given, (byref(options),), "the file cannot be written")
