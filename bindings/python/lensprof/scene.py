"""Scenes: pictures that show the same, and where; see lensprof/photo.h."""
from __future__ import annotations

import itertools
import os
from ctypes import POINTER, byref, c_char_p
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Iterable, Iterator, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _abi, _arrays
from ._events import Progress, calling_events
from ._frames import written_frames
from ._library import SharedHandle, check, initialised, photo
from ._paths import PathLike, optional_path, raw_path, raw_paths, text
from .calibration import Calibration, RawCalibrateOptions
from .geometry import Camera
from .pictures import PictureMetadata

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .calibration import CalibrateOptions


@dataclass(frozen=True)
class SceneImage:
    """An image of a scene: name, file, and camera."""

    name: str
    file: str
    camera: Camera


class Scene(SharedHandle):
    """Images with their cameras or matches: what is calibrated. Made by `Scene.open`.

    images: tuple of SceneImage. left_out: dict of the pictures that are not part of it, with the reason. reference: the
    image whose exposure is 0 EV. is_reconstruction: images of a moving camera, linked by matches alone.
    """

    images: tuple[SceneImage, ...]
    left_out: dict[str, str]
    reference: int
    is_reconstruction: bool

    def __init__(self, pointer: Any):
        library = photo()
        super().__init__(pointer, library.lensprof_scene_destroy)
        info = initialised(_abi.SceneInfo)
        self._ask(library.lensprof_scene_get_info, byref(info))
        self.images = tuple(self._image(index) for index in range(info.images))
        self.left_out = dict(self._left_out(index) for index in range(info.left_out))
        self.reference, self.is_reconstruction = info.reference, bool(info.is_reconstruction)
        self._matches, self._links = info.matches, info.links

    @classmethod
    def open(cls, paths: Union[PathLike, Iterable[PathLike]], images: Optional[PathLike] = None,
             image_list: Optional[PathLike] = None, one_lens: bool = False, progress: Progress = None) -> Scene:
        """Opens pictures and folders of them, whose overlaps are found; or one Hugin project; or one reconstruction
        (COLMAP, OpenSfM, OpenDroneMap, Bundler, AliceVision, OpenMVG). images: folder of a reconstruction's pictures.
        image_list: file with names of its images to use. one_lens: all pictures are from one camera and lens, whatever
        EXIF states. progress: called with a step and the fraction done; the call is cancelled if it returns True or
        raises; True = a bar, where tqdm is installed."""
        options = initialised(_abi.SceneOptions, one_lens=int(one_lens), images=optional_path(images),
                              image_list=optional_path(image_list))
        error, pointer = _abi.ErrorText(), POINTER(_abi.Scene)()
        with calling_events(progress) as events:
            status = photo().lensprof_scene_open(*raw_paths(paths), byref(options), events, byref(pointer), byref(error))
            check(status, "no scene", error)
            return cls(pointer)

    @property
    def matches(self) -> npt.NDArray[np.void]:
        """Positions of the same point in two images, of MATCH_DTYPE; empty for pictures of a rotating camera."""
        return self._items(photo().lensprof_scene_match_at, self._matches, _abi.Match(), _arrays.MATCH_DTYPE)

    @property
    def links(self) -> npt.NDArray[np.void]:
        """Images that show the same, of SCENE_LINK_DTYPE; empty for a Hugin project, whose images overlap where its cameras
        do."""
        return self._items(photo().lensprof_scene_link_at, self._links, _abi.SceneLink(), _arrays.SCENE_LINK_DTYPE)

    def save(self, path: PathLike) -> None:
        """Writes it as a Hugin project."""
        self._ask(photo().lensprof_scene_save, raw_path(path))

    def calibrate(self, progress: Progress = None, **options: Unpack[CalibrateOptions]) -> Calibration:
        """Samples the pictures and fits. Also returns if the result is poor: see `usable`."""
        return self._calibrate(RawCalibrateOptions(**options), progress)

    def _calibrate(self, given: RawCalibrateOptions, progress: Progress) -> Calibration:
        error, pointer = _abi.ErrorText(), POINTER(_abi.Calibration)()
        with self._use() as scene, calling_events(progress) as events:
            status = photo().lensprof_calibrate(scene, byref(given), events, byref(pointer), byref(error))
            check(status, "the fit failed", error)
            return Calibration(pointer)

    def _items(self, function: Any, count: int, item: Any, dtype: np.dtype[Any]) -> npt.NDArray[np.void]:
        array = np.zeros(count, dtype=dtype)
        for index in range(count):
            self._ask(function, index, byref(item))
            array[index] = np.frombuffer(item, dtype=dtype)[0]
        return array

    def _ask(self, function: Any, *rest: Any) -> None:
        error = _abi.ErrorText()
        with self._use() as scene:
            check(function(scene, *rest, byref(error)), "no such part of the scene", error)

    def _image(self, index: int) -> SceneImage:
        name, file, camera = c_char_p(), c_char_p(), Camera()
        self._ask(photo().lensprof_scene_image_at, index, byref(camera), byref(name), byref(file))
        return SceneImage(text(name.value), text(file.value), camera)

    def _left_out(self, index: int) -> tuple[str, str]:
        name, reason = c_char_p(), c_char_p()
        self._ask(photo().lensprof_scene_left_out_at, index, byref(name), byref(reason))
        return text(name.value), text(reason.value)

    def __repr__(self) -> str:
        return f"Scene({len(self.images)} images, {len(self.left_out)} left out)"


def calibrate(pictures: Union[PathLike, Iterable[PathLike], Iterable[npt.NDArray[Any]]], *,
              names: Optional[Iterable[str]] = None, times: Optional[Iterable[float]] = None,
              metadata: Optional[Iterable[PictureMetadata]] = None, images: Optional[PathLike] = None,
              progress: Progress = None, **options: Unpack[CalibrateOptions]) -> Calibration:
    """Calibrates overlapping pictures: a folder, files, a Hugin project or a reconstruction, as in Scene.open; or arrays,
    a list or an iterator of them (uint8 or uint16).

    What the EXIF of files states can be given for arrays, for each in their order. names: of the frames. times: their
    exposure times, s. metadata: PictureMetadata with exposure time, f-number, ISO, camera, lens and focal length; `times`
    replaces the exposure times in it. A value that is the same for all frames may be left unknown.
    """
    if isinstance(pictures, (str, os.PathLike)):
        pictures = [pictures]
    first, given = _with_first(pictures)
    if first is None:
        raise ValueError("no pictures; give at least two that overlap")
    if isinstance(first, np.ndarray):
        with written_frames(given, names, times, metadata) as (folder, name_of):
            calibration = _calibrate([folder], images, progress, options)
        calibration._is_of_arrays = True
        calibration.exposures["name"] = [name_of[file] for file in calibration.exposures["name"]]
        return calibration
    if not (names is None and times is None and metadata is None):
        raise TypeError("names, times and metadata are for arrays; files have their own")
    return _calibrate(given, images, progress, options)


def _with_first(items: Iterable[Any]) -> tuple[Any, Iterator[Any]]:
    """The first item, or None, and all of them."""
    given = iter(items)
    head = list(itertools.islice(given, 1))
    return (head[0] if head else None), itertools.chain(head, given)


def _calibrate(files: Iterable[PathLike], images: Optional[PathLike], progress: Progress,
               options: CalibrateOptions) -> Calibration:
    given = RawCalibrateOptions(**options)  # refuses unknown ones before the overlaps are found
    scene = Scene.open(files, images=images, one_lens=options.get("one_lens", False), progress=progress)
    return scene._calibrate(given, progress)
