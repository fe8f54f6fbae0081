"""What was found about the cameras, lenses and exposures of a scene; see lensprof/photo.h."""
from __future__ import annotations

import os
from ctypes import POINTER, byref, c_char_p, c_double, c_uint32, cast
from typing import TYPE_CHECKING, Any, Iterator, Optional, Sequence, TypedDict, Union

import numpy as np
import numpy.typing as npt

from . import _abi
from ._abi import CameraKind, Free, GammaFrom, Loss, Method, Sampling, Status
from ._arrays import EXPOSURE_DTYPE
from ._library import Error, SharedHandle, check, initialised, photo
from ._paths import PathLike, optional_path, raw_path, raw_text, set_databases, text
from ._struct import Enumerated, Flag, Struct, default
from .copies import correct_files
from .fit import FitOf, FitResult
from .model import Exposure
from .profile import Profile, ProfileKey
from .reason import Finding

if TYPE_CHECKING:
    from matplotlib.figure import Figure  # type: ignore[import,unused-ignore]
    from typing_extensions import Unpack

    from .copies import CorrectOptions

EXPOSURES_DTYPE = np.dtype([("name", object), ("ev", np.float64), ("ev_sigma", np.float64),
                            ("white_balance", np.float64, 3), ("white_balance_sigma", np.float64, 3)])


class CalibrateOptions(TypedDict, total=False):
    """How a scene is fitted. Defaults: those of `lensprof build`.

    method: Method.TRANSFER or RADIANCE. modes: of the response, MODES_AUTO = by held-out error. loss. falloff_curves: 1,
    3 or 0 = by held-out error. gamma_from: what determines the common exponent. free: Free.EV ... of every image, 0 =
    those of the project, or all. pairs: 0 = by the number of images; seed: of the sampling; max_side: pictures are read
    reduced to at least so many pixels. one_lens: one response and falloff for all. use_stored: the profile stored for
    camera and lens is the prior. prior_weight: 0 = none. exif_sigma: standard error of exposures in EXIF, EV; 0 = not
    used, negative = by EXIF. databases: paths of profile databases; none = the user's own and the installed one.
    camera_kind: that the prior describes, None = by EXIF. huber_levels: sigma of Loss.HUBER, levels of 255. sampling:
    Sampling.BALANCED or PAPER. reference: name or number of the image whose exposure is 0 EV. key: ProfileKey of the
    profile, which replaces what EXIF states where it is known.
    """

    method: Method
    modes: int
    loss: Loss
    falloff_curves: int
    gamma_from: GammaFrom
    free: Free
    pairs: int
    seed: int
    max_side: int
    one_lens: bool
    use_stored: bool
    prior_weight: float
    exif_sigma: float
    databases: Sequence[PathLike]
    camera_kind: Optional[CameraKind]
    huber_levels: float
    sampling: Sampling
    reference: Union[str, int, None]
    key: Optional[ProfileKey]


class RawCalibrateOptions(Struct, _abi.CalibrateOptions):
    """The same as the library takes them."""

    method: Enumerated[Method] = Enumerated(Method)
    modes: int = default
    loss: Enumerated[Loss] = Enumerated(Loss)
    falloff_curves: int = default
    gamma_from: Enumerated[GammaFrom] = Enumerated(GammaFrom)
    free: Enumerated[Free] = Enumerated(Free)
    pairs: int = default
    seed: int = default
    max_side: int = default
    one_lens: Flag = Flag()
    use_stored: Flag = Flag()
    prior_weight: float = default
    exif_sigma: float = default
    huber_levels: float = default
    sampling: Enumerated[Sampling] = Enumerated(Sampling)

    def __init__(self, databases: Sequence[PathLike] = (), camera_kind: Optional[CameraKind] = None,
                 reference: Union[str, int, None] = None, key: Optional[ProfileKey] = None, **fields: Any):
        super().__init__(**fields)
        set_databases(self, databases)
        raw: Any = _abi.CalibrateOptions
        raw.reference.__set__(self, None if reference is None else raw_text(str(reference)))
        if camera_kind is not None:
            raw.camera_kind.__set__(self, CameraKind(camera_kind))
        if key is not None:
            raw.key.__set__(self, cast(byref(key), POINTER(_abi.ProfileKey)))


class Calibration(SharedHandle):
    """What was found about the cameras, lenses and exposures of a scene. Made by `calibrate`, `Scene.calibrate` or
    `Calibration.read`.

    exposures: structured array of EXPOSURES_DTYPE: name, ev and white_balance relative to the reference, with standard
    errors; NaN for images left out. profiles: tuple of Profile, one for each lens setting; findings: tuple of Finding,
    most severe first. usable: a profile to store; equalizes: the pictures can be corrected. result: the FitResult of the
    reference's lens setting, None for a result that was read.
    """

    exposures: npt.NDArray[np.void]
    profiles: tuple[Profile, ...]
    findings: tuple[Finding, ...]
    usable: bool
    equalizes: bool
    result: Optional[FitResult]

    def __init__(self, pointer: Any):
        library = photo()
        super().__init__(pointer, library.lensprof_calibration_destroy)
        info = initialised(_abi.CalibrationInfo)
        self._ask(library.lensprof_calibration_get_info, byref(info))
        self.usable, self.equalizes = bool(info.usable), bool(info.equalizes)
        self.exposures = np.array([self._exposure(i) for i in range(info.images)], dtype=EXPOSURES_DTYPE)
        self.profiles = tuple(self._profiles(info.profiles))
        self.findings = tuple(self._finding(index) for index in range(info.findings))
        self.result = None
        self._is_of_arrays = False
        with self._use() as calibration:
            fit = library.lensprof_calibration_get_fit(calibration)
        if fit:
            plain = np.zeros(info.images, dtype=EXPOSURE_DTYPE)
            plain["ev"], plain["white_balance"] = self.exposures["ev"], self.exposures["white_balance"]
            self.result = FitOf(fit, plain, self).reference

    @classmethod
    def read(cls, path: PathLike, images: Optional[PathLike] = None) -> Calibration:
        """A result that was saved: exposures.json, whose pictures are in the folder `images` if it is given, or a Hugin
        project. It has exposures and corrects; it has no profiles and findings."""
        library, error, pointer = photo(), _abi.ErrorText(), POINTER(_abi.Calibration)()
        check(library.lensprof_calibration_open(raw_path(path), optional_path(images), byref(pointer), byref(error)),
              "no result", error)
        return cls(pointer)

    def save(self, path: PathLike) -> None:
        """Writes the result in the format of the name: .pto, exposures.json, else a profile: profile.json, pcalib.txt and
        other formats."""
        if self._is_of_arrays and os.fspath(path).endswith(".pto"):
            raise ValueError("a project refers to files, but the pictures are arrays; save exposures.json or a profile")
        self._change(photo().lensprof_calibration_save, raw_path(path))

    def store(self, database: Optional[PathLike] = None) -> int:
        """Stores the usable profiles in a database, by default the user's own. Returns their number."""
        stored = c_uint32()
        self._change(photo().lensprof_calibration_store, optional_path(database), byref(stored))
        return stored.value

    def correct(self, source: PathLike, target: PathLike, **options: Unpack[CorrectOptions]) -> None:
        """Writes a corrected copy of a picture of the scene; options: those of correct_files."""
        if self._is_of_arrays:
            raise ValueError("the pictures are arrays; use lensprof.correct with a profile and calibration.exposure(index)")
        correct_files([(source, target)], self, **options)

    def exposure(self, index: int) -> Exposure:
        """Exposure and white balance of image `index`, as lensprof.correct takes them."""
        row = self.exposures[index]
        return Exposure(ev=row["ev"], white_balance=tuple(row["white_balance"]))

    def plot(self) -> Figure:
        """Draws response and relative illuminance with matplotlib, and returns the figure."""
        if not self.profiles:
            raise ValueError("a result that was read has no profiles to plot")
        return self.profiles[0].plot()

    def _ask(self, function: Any, *rest: Any) -> None:
        error = _abi.ErrorText()
        with self._use() as calibration:
            check(function(calibration, *rest, byref(error)), "no such part of the calibration", error)

    def _change(self, function: Any, *rest: Any) -> None:
        error = _abi.ErrorText()
        with self._use_alone() as calibration:
            check(function(calibration, *rest, byref(error)), "no such part of the calibration", error)

    def _exposure(self, index: int) -> tuple[Any, ...]:
        name, exposure, errors = c_char_p(), Exposure(), (c_double * 4)()
        self._ask(photo().lensprof_calibration_image_at, index, byref(name), None)
        self._ask(photo().lensprof_calibration_exposure_at, index, byref(exposure), errors)
        return text(name.value), exposure.ev, errors[0], tuple(exposure.white_balance), tuple(errors[1:])

    def _profiles(self, count: int) -> Iterator[Profile]:
        for index in range(count):
            profile = Profile()
            try:
                self._ask(photo().lensprof_calibration_profile_at, index, byref(profile))
            except Error as error:
                if error.status is not Status.ERROR_NOT_FOUND:  # a setting none of whose pictures agrees
                    raise
                continue
            yield profile

    def _finding(self, index: int) -> Finding:
        finding = Finding()
        self._ask(photo().lensprof_calibration_finding_at, index, byref(finding))
        return finding

    def __repr__(self) -> str:
        return f"Calibration({len(self.exposures)} images, usable={self.usable}, equalizes={self.equalizes})"
