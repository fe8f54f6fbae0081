"""Pictures, scenes of them, their calibration, and corrected copies; see lensprof/photo.h.

Needs the photograph library, liblensprof-photo, in addition to the base library.
"""
from __future__ import annotations

import contextlib
import ctypes
import json
import os
import pathlib
import tempfile
import threading
import warnings
from ctypes import POINTER, byref, c_char_p, c_double, c_size_t, c_uint32
from typing import Any, Callable, Iterable, Iterator, Optional, Sequence, Union

import numpy as np

from . import _abi, _arrays
from ._abi import CopyExposure, Free, GammaFrom, Loss, Method, SampleType, Severity, Status
from ._library import Error, Handle, check, initialised, lib, photo
from ._progress import _interrupts
from ._struct import Enumerated, Flag, Nested, Struct, Text
from .fit import FitResult
from .geometry import Camera
from .profile import Profile, ProfileKey
from .reason import Finding

PathLike = Union[str, "os.PathLike[str]"]
Progress = Callable[[str, float], Optional[bool]]

EXPOSURES_DTYPE = np.dtype([("name", object), ("ev", np.float64), ("ev_sigma", np.float64),
                            ("white_balance", np.float64, 3), ("white_balance_sigma", np.float64, 3)])
_DTYPES = {SampleType.U8: np.uint8, SampleType.U16: np.uint16, SampleType.F32: np.float32}


class Notice(UserWarning):
    """A message of the library about a file or scene, short of an error. Warnings are issued by `warnings.warn`."""


def _path(path: PathLike) -> bytes:
    return os.fsencode(path)


def _text(value: Optional[bytes]) -> str:
    return os.fsdecode(value or b"")


def _bar() -> Optional[Progress]:
    """A progress bar, where tqdm is installed."""
    try:
        from tqdm import tqdm  # type: ignore[import-untyped,import-not-found,unused-ignore]
    except ImportError:
        return None
    bars: dict[str, Any] = {}

    def show(step: str, done: float) -> None:
        if step not in bars:
            for other in bars.values():
                other.close()
            bars[step] = tqdm(total=100, desc=step, unit="%", leave=False)
        if bars[step].n != round(100 * done):
            bars[step].n = round(100 * done)
            bars[step].refresh()

    return show


@contextlib.contextmanager
def _events(progress: Union[Progress, bool, None]) -> Iterator[Any]:
    """The raw events of one call. The functions are called by any thread of the library, one at a time. An exception
    cancels the call, and propagates from it."""
    function = _bar() if progress is True else progress or None
    if function is not None and not callable(function):
        raise TypeError("progress takes a function of a step and the fraction done, True or None")
    raised: list[BaseException] = []
    notices: list[str] = []

    def on_step(step: bytes, done: float, _detail: bytes, _user: Any) -> int:
        try:
            return 1 if interrupted or raised or (function and function(step.decode(), done)) else 0
        except BaseException as exception:  # must not cross C
            raised.append(exception)
            return 1

    def on_notice(notice: Any, _user: Any) -> None:
        if notice.contents.severity == Severity.WARNING:
            item, text = _text(notice.contents.item), notice.contents.text.decode("utf-8", "replace")
            notices.append(f"{item}: {text}" if item else text)

    events = initialised(_abi.Events)
    events.progress, events.notice = _abi.OnStep(on_step), _abi.OnNotice(on_notice)
    try:
        with _interrupts() as interrupted:
            yield byref(events)
    finally:
        if raised:
            raise raised[0]
    for text in notices:
        warnings.warn(text, Notice, stacklevel=4)


class PictureMetadata(Struct, _abi.PictureMetadata):
    """What a file states about camera, lens and exposure. key: ProfileKey. exposure_time_s, iso, f_number: UNKNOWN if
    not stated; ev: log2(time iso / 100 / f_number^2), larger is brighter. captured: date and time as in EXIF.
    is_corrected: the falloff was corrected before."""

    is_corrected = Flag()
    key = Nested(ProfileKey)
    exposure_time_s: float
    iso: float
    f_number: float
    ev: float
    captured = Text()


class _OpenPicture(Handle):
    def __init__(self, source: Union[PathLike, bytes, bytearray, memoryview]):
        self.library = photo()
        error, pointer = _abi.ErrorText(), POINTER(_abi.Picture)()
        if isinstance(source, (bytes, bytearray, memoryview)):
            data = bytes(source)
            status = self.library.lensprof_picture_open_memory(data, len(data), byref(pointer), byref(error))
        else:
            status = self.library.lensprof_picture_open(_path(source), byref(pointer), byref(error))
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

    pixels: np.ndarray
    metadata: PictureMetadata
    icc: bytes
    orientation: int
    reduction: int

    def __init__(self, source: Union[PathLike, bytes, bytearray, memoryview], max_side: int = 0):
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


def read_picture(source: Union[PathLike, bytes, bytearray, memoryview], max_side: int = 0) -> Picture:
    """Reads a picture file, or its bytes, of any format that the library was built with. max_side: 0 = full size; else
    reduced by a whole number, so that the longer side has at least so many pixels."""
    return Picture(source, max_side)


def write_picture(path: PathLike, pixels: np.ndarray, like: Optional[Picture] = None, jpeg_quality: int = 0) -> None:
    """Writes pixels (uint8, uint16 or float32) in the format of the name: .png, .jpg, .tif. like: a picture that was
    read, whose metadata, colour profile and compression are taken. jpeg_quality: 1..100, 0 = like that picture."""
    library, error = photo(), _abi.ErrorText()
    with _picture_options(like, jpeg_quality) as options:
        check(library.lensprof_picture_write(_path(path), byref(_arrays.image(pixels)), options, byref(error)),
              "the picture cannot be written", error)


def encode_picture(format: str, pixels: np.ndarray, like: Optional[Picture] = None, jpeg_quality: int = 0) -> bytes:
    """The same as bytes; format: such as ".png"."""
    library, error, count = photo(), _abi.ErrorText(), c_size_t()
    buffer = ctypes.create_string_buffer(pixels.nbytes + (1 << 16))
    with _picture_options(like, jpeg_quality) as options:
        def encode() -> int:
            return library.lensprof_picture_encode(format.encode(), byref(_arrays.image(pixels)), options, buffer,
                                                   len(buffer), byref(count), byref(error))
        status = encode()
        if status == Status.ERROR_CAPACITY:
            buffer = ctypes.create_string_buffer(count.value)
            status = encode()
        check(status, "the picture cannot be encoded", error)
    return buffer.raw[:count.value]


@contextlib.contextmanager
def _picture_options(like: Optional[Picture], jpeg_quality: int) -> Iterator[Any]:
    options = initialised(_abi.PictureOptions, jpeg_quality=jpeg_quality)
    if like is None:
        yield byref(options)
        return
    with like._file._use() as picture:
        options.like = picture  # type: ignore[assignment]
        yield byref(options)


class SceneImage:
    """An image of a scene: name, file, and camera."""

    def __init__(self, name: str, file: str, camera: Camera):
        self.name, self.file, self.camera = name, file, camera

    def __repr__(self) -> str:
        return f"SceneImage({self.name!r}, {self.camera.width} x {self.camera.height})"


class Scene(Handle):
    """Images with their cameras or matches: what is calibrated. Made by `Scene.open`.

    images: tuple of SceneImage. left_out: dict of the pictures that are not part of it, with the reason. matches:
    array of MATCH_DTYPE, positions of the same point in two images; empty for pictures of a rotating camera.
    """

    def __init__(self, pointer: Any):
        library = photo()
        super().__init__(pointer, library.lensprof_scene_destroy)
        self._info = initialised(_abi.SceneInfo)
        self._ask(library.lensprof_scene_get_info, byref(self._info))
        self.images = tuple(self._image(index) for index in range(self._info.images))
        self.left_out = dict(self._left_out(index) for index in range(self._info.left_out))

    @classmethod
    def open(cls, paths: Union[PathLike, Sequence[PathLike]], images: Optional[PathLike] = None,
             image_list: Optional[PathLike] = None, one_lens: bool = False,
             progress: Union[Progress, bool, None] = None) -> Scene:
        """Opens pictures and folders of them, whose overlaps are found; or one Hugin project; or one reconstruction
        (COLMAP, OpenSfM, OpenDroneMap, Bundler, AliceVision, OpenMVG). images: folder of a reconstruction's pictures.
        image_list: file with names of its images to use. one_lens: all pictures are from one camera and lens, whatever
        EXIF states. progress: called with a step and the fraction done; the call is cancelled if it returns True or
        raises; True = a bar, where tqdm is installed."""
        names = [_path(path) for path in ([paths] if isinstance(paths, (str, os.PathLike)) else list(paths))]
        array = (c_char_p * max(len(names), 1))(*names)
        options = initialised(_abi.SceneOptions, one_lens=int(one_lens))
        if images is not None:
            options.images = _path(images)
        if image_list is not None:
            options.image_list = _path(image_list)
        library, error, pointer = photo(), _abi.ErrorText(), POINTER(_abi.Scene)()
        with _events(progress) as events:
            status = library.lensprof_scene_open(array, len(names), byref(options), events, byref(pointer), byref(error))
        check(status, "no scene", error)
        return cls(pointer)

    @property
    def reference(self) -> int:
        """The image whose exposure is 0 EV."""
        return int(self._info.reference)

    @property
    def is_reconstruction(self) -> bool:
        return bool(self._info.is_reconstruction)

    @property
    def matches(self) -> np.ndarray:
        array = np.zeros(self._info.matches, dtype=_arrays.MATCH_DTYPE)
        match = _abi.Match()
        for index in range(len(array)):
            self._ask(photo().lensprof_scene_match_at, index, byref(match))
            array[index] = np.frombuffer(match, dtype=_arrays.MATCH_DTYPE)[0]
        return array

    def save(self, path: PathLike) -> None:
        """Writes it as a Hugin project."""
        self._ask(photo().lensprof_scene_save, _path(path))

    def calibrate(self, progress: Union[Progress, bool, None] = None, **options: Any) -> Calibration:
        """Samples the pictures and fits. options: those of CalibrateOptions. Also returns if the result is poor: see
        `usable`."""
        given = options.pop("options", None) or CalibrateOptions(**options)
        library, error, pointer = photo(), _abi.ErrorText(), POINTER(_abi.Calibration)()
        with self._use() as scene, _events(progress) as events:
            status = library.lensprof_calibrate(scene, byref(given), events, byref(pointer), byref(error))
        check(status, "the fit failed", error)
        return Calibration(pointer, self.images)

    def _ask(self, function: Any, *rest: Any) -> None:
        error = _abi.ErrorText()
        with self._use() as scene:
            check(function(scene, *rest, byref(error)), "no such part of the scene", error)

    def _image(self, index: int) -> SceneImage:
        name, file, camera = c_char_p(), c_char_p(), Camera()
        self._ask(photo().lensprof_scene_image_at, index, byref(camera), byref(name), byref(file))
        return SceneImage(_text(name.value), _text(file.value), camera)

    def _left_out(self, index: int) -> tuple[str, str]:
        name, reason = c_char_p(), c_char_p()
        self._ask(photo().lensprof_scene_left_out_at, index, byref(name), byref(reason))
        return _text(name.value), _text(reason.value)

    def __repr__(self) -> str:
        return f"Scene({len(self.images)} images, {len(self.left_out)} left out)"


class CalibrateOptions(Struct, _abi.CalibrateOptions):
    """How a scene is fitted. Defaults: those of `lensprof build`.

    method: Method.TRANSFER or RADIANCE. modes: of the response, MODES_AUTO = by held-out error. loss. falloff_curves: 1,
    3 or 0 = by held-out error. gamma_from: what determines the common exponent. free: Free.EV ... of every image, 0 =
    those of the project, or all. pairs: 0 = by the number of images; seed: of the sampling; max_side: pictures are read
    reduced to at least so many pixels. one_lens: one response and falloff for all. use_stored: the profile stored for
    camera and lens is the prior. prior_weight: 0 = none. exif_sigma: standard error of exposures in EXIF, EV; 0 = not
    used, negative = by EXIF. databases: paths of profile databases; none = the user's own and the installed one.
    """

    method = Enumerated(Method)
    modes: int
    loss = Enumerated(Loss)
    falloff_curves: int
    gamma_from = Enumerated(GammaFrom)
    free = Enumerated(Free)
    pairs: int
    seed: int
    max_side: int
    one_lens = Flag()
    use_stored = Flag()
    prior_weight: float
    exif_sigma: float

    def __init__(self, databases: Sequence[PathLike] = (), **fields: Any):
        super().__init__(**fields)
        self._paths = _paths(self, databases)

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in super()._names() if name not in ("databases", "database_count")]


def _paths(options: Any, databases: Sequence[PathLike]) -> Any:
    """Sets the databases of raw options; returns what must live as long."""
    names = (c_char_p * max(len(databases), 1))(*map(_path, databases))
    raw: Any = next(base for base in type(options).__mro__ if "_fields_" in vars(base))
    raw.databases.__set__(options, names)
    raw.database_count.__set__(options, len(databases))
    return names


class Calibration(Handle):
    """What was found about the cameras, lenses and exposures of a scene. Made by `calibrate`, `Scene.calibrate` or
    `Calibration.read`.

    exposures: structured array of EXPOSURES_DTYPE: name, ev and white_balance relative to the reference, with standard
    errors; NaN for images left out. profiles: tuple of Profile, one for each lens setting; findings: tuple of Finding,
    most severe first. usable: a profile to store; equalizes: the pictures can be corrected.
    """

    def __init__(self, pointer: Any, images: Sequence[SceneImage] = ()):
        library = photo()
        super().__init__(pointer, library.lensprof_calibration_destroy)
        self.exposures = self._exposures([image.name for image in images])
        self.profiles = tuple(self._profiles())
        self.findings = tuple(self._findings())
        self.result: Optional[FitResult] = None
        with self._use() as calibration:
            fit = library.lensprof_calibration_get_fit(calibration)
        if fit:
            self.result, error = FitResult(), _abi.ErrorText()
            check(lib.lensprof_fit_setting_at(fit, _abi.FIT_REFERENCE, byref(self.result), byref(error)), "no result", error)

    @classmethod
    def read(cls, path: PathLike, images: Optional[PathLike] = None) -> Calibration:
        """A result that was saved: exposures.json, whose pictures are in the folder `images` if it is given, or a Hugin
        project. It has exposures and corrects; it has no profiles and findings."""
        library, error, pointer = photo(), _abi.ErrorText(), POINTER(_abi.Calibration)()
        check(library.lensprof_calibration_open(_path(path), None if images is None else _path(images), byref(pointer),
                                                byref(error)), "no result", error)
        return cls(pointer)

    @property
    def usable(self) -> bool:
        return self.result is not None and bool(self.result.usable)

    @property
    def equalizes(self) -> bool:
        return self.result is None or bool(self.result.equalizes or self.result.usable)

    def save(self, path: PathLike) -> None:
        """Writes the result in the format of the name: .pto, exposures.json, else a profile: profile.json, pcalib.txt and
        other formats."""
        self._ask(photo().lensprof_calibration_save, _path(path))

    def store(self, database: Optional[PathLike] = None) -> int:
        """Stores the usable profiles in a database, by default the user's own. Returns their number."""
        stored = c_uint32()
        self._ask(photo().lensprof_calibration_store, None if database is None else _path(database), byref(stored))
        return stored.value

    def correct(self, source: PathLike, target: PathLike, **options: Any) -> None:
        """Writes a corrected copy of a picture of the scene; options: those of correct_files."""
        correct_files([(source, target)], self, **options)

    def plot(self) -> Any:
        """Draws response and relative illuminance with matplotlib, and returns the figure."""
        if not self.profiles:
            raise ValueError("a result that was read has no profiles to plot")
        return self.profiles[0].plot()

    def _ask(self, function: Any, *rest: Any) -> None:
        error = _abi.ErrorText()
        with self._use() as calibration:
            check(function(calibration, *rest, byref(error)), "no such part of the calibration", error)

    def _exposures(self, names: Sequence[str]) -> np.ndarray:
        rows: list[tuple[Any, ...]] = []
        with contextlib.suppress(_End):
            while not names or len(rows) < len(names):
                exposure, errors = _abi.Exposure(), (c_double * 4)()
                with _ending(Status.ERROR_ARGUMENT):
                    self._ask(photo().lensprof_calibration_exposure_at, len(rows), byref(exposure), errors)
                rows.append((names[len(rows)] if names else str(len(rows)), exposure.ev, errors[0],
                             tuple(exposure.white_balance), tuple(errors[1:])))
        return np.array(rows, dtype=EXPOSURES_DTYPE)

    def _profiles(self) -> Iterator[Profile]:
        with self._use() as calibration:
            count = photo().lensprof_calibration_count_profiles(calibration)
        for index in range(count):
            profile = Profile()
            try:
                self._ask(photo().lensprof_calibration_profile_at, index, byref(profile))
            except Error as error:
                if error.status is not Status.ERROR_NOT_FOUND:  # a setting none of whose pictures agrees
                    raise
                continue
            yield profile

    def _findings(self) -> Iterator[Finding]:
        with contextlib.suppress(_End):
            for index in range(1 << 16):
                finding = Finding()
                with _ending(Status.ERROR_NOT_FOUND, Status.ERROR_ARGUMENT):
                    self._ask(photo().lensprof_calibration_finding_at, index, byref(finding))
                yield finding

    def __repr__(self) -> str:
        return f"Calibration({len(self.exposures)} images, usable={self.usable}, equalizes={self.equalizes})"


class _End(Exception):
    """There are no more."""


@contextlib.contextmanager
def _ending(*statuses: Status) -> Iterator[None]:
    try:
        yield
    except Error as error:
        if error.status in statuses:
            raise _End from None
        raise


def calibrate(pictures: Any, names: Optional[Sequence[str]] = None, progress: Union[Progress, bool, None] = None,
              one_lens: bool = False, images: Optional[PathLike] = None, **options: Any) -> Calibration:
    """Calibrates overlapping pictures: a folder, files, a Hugin project or a reconstruction, as in Scene.open; or arrays,
    a list or an iterator of them (uint8 or uint16), with optional `names`. options: those of CalibrateOptions."""
    if isinstance(pictures, (str, os.PathLike)):
        return Scene.open(pictures, images=images, one_lens=one_lens, progress=progress).calibrate(
            progress, one_lens=one_lens, **options)
    given = list(pictures) if isinstance(pictures, (list, tuple)) else pictures
    if isinstance(given, list) and given and all(isinstance(path, (str, os.PathLike)) for path in given):
        return Scene.open(given, images=images, one_lens=one_lens, progress=progress).calibrate(
            progress, one_lens=one_lens, **options)
    with tempfile.TemporaryDirectory() as folder:  # frames of any number: one is in memory
        for number, picture in enumerate(given):
            name = names[number] if names else f"frame{number:05d}"
            if not name or pathlib.PurePath(name).name != name:
                raise ValueError(f"{name!r}: is not the name of a frame; give one without folders")
            write_picture(pathlib.Path(folder) / f"{name}.png", np.asarray(picture))
        calibration = Scene.open(folder, one_lens=one_lens, progress=progress).calibrate(
            progress, one_lens=one_lens, **options)
    calibration.exposures["name"] = [name[:-len(".png")] for name in calibration.exposures["name"]]
    return calibration


def calibrate_folder(paths: Union[PathLike, Sequence[PathLike]], output: PathLike, databases: Sequence[PathLike] = (),
                     store: bool = True, one_lens: bool = False, overwrite: bool = False, threads: int = 0,
                     progress: Union[Progress, bool, None] = None) -> dict[str, Any]:
    """The whole job of a folder: all its panoramas are found, fitted, stored and corrected, other pictures are corrected
    by the databases. A second call does what is missing or has changed. Returns the content of output/calibrate.json
    (docs/json.md)."""
    names = [_path(path) for path in ([paths] if isinstance(paths, (str, os.PathLike)) else list(paths))]
    array = (c_char_p * max(len(names), 1))(*names)
    options = initialised(_abi.FolderOptions, one_lens=int(one_lens), no_store=int(not store), overwrite=int(overwrite),
                          threads=threads)
    held = _paths(options, databases)  # noqa: F841
    library, error = photo(), _abi.ErrorText()
    with _events(progress) as events:
        status = library.lensprof_calibrate_folder(array, len(names), _path(output), byref(options), events, None,
                                                   byref(error))
    check(status, "the folder cannot be calibrated", error)
    return dict(json.loads((pathlib.Path(output) / "calibrate.json").read_text("utf-8")))


class _CorrectOptions(Struct, _abi.CorrectOptions):
    exposure = Enumerated(CopyExposure)
    linear = Flag()
    overwrite = Flag()
    threads: int
    force_falloff = Flag()
    strength: float

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in super()._names() if name not in ("databases", "database_count")]


def correct_files(copies: Iterable[tuple[PathLike, PathLike]], calibration: Optional[Calibration] = None,
                  databases: Sequence[PathLike] = (), progress: Union[Progress, bool, None] = None,
                  **options: Any) -> int:
    """Writes corrected copies (source, target) of pictures of a calibrated scene; without a calibration with the profile
    that the databases have for their camera, lens and setting. options: exposure (CopyExposure.MEAN, KEEP or
    REFERENCE), linear (irradiance as float), overwrite, threads, force_falloff, strength. Returns the number of
    copies."""
    pairs = [(_path(source), _path(target)) for source, target in copies]
    array = (_abi.Copy * max(len(pairs), 1))(*pairs)
    given = _CorrectOptions(**options)
    held = _paths(given, databases)  # noqa: F841
    library, error, written = photo(), _abi.ErrorText(), c_uint32()
    with contextlib.ExitStack() as stack:
        handle = stack.enter_context(calibration._use()) if calibration is not None else None
        events = stack.enter_context(_events(progress))
        status = library.lensprof_correct_files(handle, array, len(pairs), byref(given), events, byref(written),
                                                byref(error))
    check(status, "the pictures cannot be corrected", error)
    return written.value


def correct_file(source: PathLike, calibration: Optional[Calibration], target: PathLike, **options: Any) -> None:
    """Writes one corrected copy; as correct_files."""
    correct_files([(source, target)], calibration, **options)
