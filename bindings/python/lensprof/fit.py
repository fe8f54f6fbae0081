"""Recovers response, vignetting, exposure and white balance from correspondences; see lensprof/fit.h."""
from __future__ import annotations

import contextlib
import ctypes
import datetime
from ctypes import POINTER, byref, c_double, sizeof
from typing import TYPE_CHECKING, Any, Callable, Iterator, Optional, Sequence, TypedDict

import numpy as np
import numpy.typing as npt

from . import _abi, _arrays
from ._abi import CameraKind, FitModel, FitResponse, Free, GammaFrom, Loss, Method, ProfilePrior
from ._library import Handle, check, initialised, lib
from ._progress import WithProgress, calling
from ._struct import Curves, Enumerated, Flag, Nested, OptionalReference, Struct, Value, Vector, default, integer
from ._types import Array, Records
from .model import Exposure, Response, Vignetting
from .profile import Covariance, Profile, ProfileKey
from .reason import WithFindings

if TYPE_CHECKING:
    from typing_extensions import Unpack


class FitImageFields(TypedDict, total=False):
    """Fields of a FitImage that may be given to its constructor."""

    exposure: Exposure
    free: Free
    ev_of: int
    red_of: int
    blue_of: int
    setting: int
    camera: int
    known_ev: float
    known_ev_sigma: float
    f_number_ratio: float
    crop_factor: float


class FitImage(Value, _abi.FitImage):
    """One image of a fit.

    index: its position among the images. width, height: full frame, px. exposure: value if fixed. free: Free.EV, RED,
    BLUE, all by default. ev_of, red_of, blue_of: index of the image whose ev or white balance factor this one shares;
    by default its own. known_ev: exposure from another source (EXIF), EV up to a common offset, a soft observation;
    known_ev_sigma: its standard error, EV, 0 = unknown. setting: number of the lens setting (lens, focal length,
    aperture and focus), 0..SETTINGS_MAX - 1; each has its own vignetting. camera: number of the camera, 0..CAMERAS_MAX
    - 1; each has its own response. All images of a setting belong to one camera. f_number_ratio: f-number over the
    widest one of the lens, 0 = unknown. crop_factor: diagonal of 36 x 24 mm over that of the sensor, 0 = unknown.
    """

    width: int = default
    height: int = default
    exposure: Nested[Exposure] = Nested(Exposure)
    free: Enumerated[Free] = Enumerated(Free)
    ev_of: int = default
    red_of: int = default
    blue_of: int = default
    setting: int = default
    camera: int = default
    known_ev: float = default
    known_ev_sigma: float = default
    f_number_ratio: float = default
    crop_factor: float = default

    def __init__(self, index: int, width: int, height: int, **fields: Unpack[FitImageFields]):
        numbers = [integer(n, what) for n, what in ((index, "index"), (width, "width"), (height, "height"))]
        lib.lensprof_fit_image_init_sized(byref(self), sizeof(self), *numbers)
        super().__init__(**fields)


class PerPair:
    """An option with a number for each pair, which the options keep."""

    def __init__(self, dtype: Any):
        self._dtype = dtype

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, options: Any, owner: Optional[type] = None) -> Optional[npt.NDArray[Any]]:
        return self if options is None else vars(options).get(self._name)  # type: ignore[return-value]

    def __set__(self, options: Any, values: Optional[npt.ArrayLike]) -> None:
        given = None if values is None else np.asarray(values)
        if given is not None and issubclass(self._dtype, np.integer) and given.size and not (
                np.issubdtype(given.dtype, np.integer) and given.min() >= 0 and given.max() <= np.iinfo(self._dtype).max):
            raise ValueError(f"{self._name} must be integers of 0..{np.iinfo(self._dtype).max}")
        array = None if given is None else np.ascontiguousarray(given, dtype=self._dtype)
        if array is not None and array.ndim != 1:
            raise ValueError(f"{self._name} of shape {array.shape}: give one number for each pair")
        options.__dict__[self._name] = array
        field = getattr(_abi.FitOptions, self._name)
        kind: Any = dict(_abi.FitOptions._fields_)[self._name]  # type: ignore[arg-type, unused-ignore]
        field.__set__(options, None if array is None else ctypes.cast(array.ctypes.data, kind))


class Links:
    """Links between images, an array of LINK_DTYPE, which the options keep."""

    def __get__(self, options: Any, owner: Optional[type] = None) -> Optional[Records]:
        return self if options is None else vars(options).get("links")  # type: ignore[return-value]

    def __set__(self, options: Any, links: Optional[Records]) -> None:
        data, count = (None, 0) if links is None else _arrays.links(links)
        vars(options)["links"], options.link_count = links, count
        vars(_abi.FitOptions)["links"].__set__(options, data)


class FitOptions(WithProgress, _abi.FitOptions):
    """Options of a fit. Defaults: 3 channels, reference 0, everything free, modes chosen by held-out error.

    channels: 1 or 3. reference: the image whose exposure stays as given. free: Free.RESPONSE .. CENTER. modes: EMoR
    modes 0..25 or MODES_AUTO. huber_levels: levels of 255. prior_weight: 0 = none, as in the paper. response,
    vignetting: values if fixed (None = EMoR mean). vignettings: falloff curves, 1, 3 or 0 = chosen by held-out error.
    gamma_from: GammaFrom.AUTO, PRIOR or EXPOSURES. camera_kind: selects the responses of the prior. method:
    Method.TRANSFER, RADIANCE or TRANSFER_FUNCTION.
    refine: free the response from the EMoR modes, unless held-out pairs get clearly worse. threads: maximum number, 0 =
    one per core; does not affect the result. profile: of the same camera, lens and setting, from other pictures;
    replaces the prior of all cameras, and the result supersedes it unless FitResult.profile_prior is OVERRULED. links:
    those of SampleOptions, so that the result warns of images connected only where there is no texture to check the
    alignment; None = unknown. moving_camera: the camera moved between the images, so that a finding notes few of them.
    unlinked_images: images of the same set that overlap none of these; if there are links and none is verified, they
    count against a result of fewer images. points: for pairs that a reconstruction matched, the scene point of each, any
    numbers: the fit then leaves out glossy points, and `equalizes` states whether the colours of points agree; None.
    view_distances: with points, how far the views of each pair are apart; None = all alike.

    progress: called repeatedly during a fit with the fraction done (0..1). The fit is cancelled if it returns True or
    raises an exception, which then propagates from fit_overlap.
    """

    channels: int = default
    reference: int = default
    free: Enumerated[Free] = Enumerated(Free)
    modes: int = default
    loss: Enumerated[Loss] = Enumerated(Loss)
    huber_levels: float = default
    prior_weight: float = default
    max_iterations: int = default
    vignettings: int = default
    gamma_from: Enumerated[GammaFrom] = Enumerated(GammaFrom)
    camera_kind: Enumerated[CameraKind] = Enumerated(CameraKind)
    threads: int = default
    method: Enumerated[Method] = Enumerated(Method)
    refine: Flag = Flag()
    moving_camera: Flag = Flag()
    profile: OptionalReference[Profile] = OptionalReference(Profile)
    response: OptionalReference[Response] = OptionalReference(Response)
    vignetting: Nested[Vignetting] = Nested(Vignetting)
    unlinked_images: int = default
    links: Links = Links()
    points: PerPair = PerPair(np.uint32)
    view_distances: PerPair = PerPair(np.float64)

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in super()._names() if name not in ("links", "link_count", "points", "view_distances")]


class FitCamera(Struct, _abi.FitCamera):
    """How one of several cameras joins the others; FitResult.settings[setting] is the result of its own fit.

    images: images of this camera in its fit, 0 if no pairs connect two of them. attached: additional images, whose
    exposures follow from pairs with other cameras. joined: its exposures are relative to the reference, through pairs
    with other cameras; otherwise they are NaN. shared_pairs: pairs with another camera; agreeing_share: share of them
    within 3 sigma of the residual; irradiance_difference_ev: median difference of the light at their ends. log_gamma:
    shift of its own fit to agree with the others. offset_sigma_ev: standard error of the offset of its exposures.
    reference: image whose exposure was fixed in its own fit; setting: setting of that image.
    """

    images: int = default
    attached: int = default
    joined: Flag = Flag()
    shared_pairs: int = default
    agreeing_share: float = default
    irradiance_difference_ev: float = default
    log_gamma: float = default
    offset_sigma_ev: float = default
    reference: int = default
    setting: int = default


def _keep(_fit: Any) -> None:
    """Releases nothing."""


class FitOf(Handle):
    """The fit of the library, with what it holds of all images, settings and cameras. `owner`: a calibration that it is
    part of, and that releases it."""

    def __init__(self, pointer: Any, exposures: Records, owner: Any = None):
        release: Callable[..., None] = _keep
        if owner is None:
            release = lib.lensprof_fit_destroy
        super().__init__(pointer, release)
        self._owner = owner
        self.exposures = exposures
        self.quality = np.zeros(len(exposures), dtype=_arrays.IMAGE_QUALITY_DTYPE)
        for index in range(len(exposures)):
            quality: Any = initialised(_abi.FitImageQuality)
            self.ask(lib.lensprof_fit_image_at, index, quality)
            self.quality[index] = np.frombuffer(quality, dtype=_arrays.IMAGE_QUALITY_DTYPE)[0]
        self.reference = self.result(_abi.FIT_REFERENCE)
        self.settings = tuple(self.result(setting) for setting in range(self.reference.setting_count))
        cameras = [FitCamera() for _ in range(self.reference.camera_count)]
        for number, camera in enumerate(cameras):
            self.ask(lib.lensprof_fit_camera_at, number, camera)
        self.cameras = tuple(cameras)

    @contextlib.contextmanager
    def _use(self) -> Iterator[Any]:
        with contextlib.ExitStack() as stack:
            if self._owner is not None:
                stack.enter_context(self._owner._use())  # refuses a calibration that is closed
            yield stack.enter_context(super()._use())

    def ask(self, function: Any, number: int, part: Any) -> None:
        error = _abi.ErrorText()
        with self._use() as fit:
            check(function(fit, number, byref(part), byref(error)), f"no part {number} of the fit", error)

    def result(self, setting: int) -> FitResult:
        result = FitResult()
        self.ask(lib.lensprof_fit_setting_at, setting, result)
        result._fit = self
        with self._use() as fit:
            result._take(_abi.FitResult, lambda *rest: lib.lensprof_fit_finding_at(fit, setting, *rest))
        return result


class FitResult(WithFindings, Struct, _abi.FitResult):
    """Result of a fit for one lens setting; fit_overlap returns that of the reference's. Arrays are views.

    Of the setting: images and setting_pairs in it (if images is 0, the others have no meaning). usable: a profile to
    store. findings: tuple of Finding, refusals first, then warnings and notes; passed: the rules that hold.
    vignetting: tuple of 1 (all channels) or 3. radius_ends: pair ends by tenths of the half diagonal. covariance: n x
    n as in Profile; fixed parameters have zero rows. gamma_direction: change of each parameter per unit of ln gamma.

    Of its camera: response. pairs used. equalizes: the result equalises these pictures, whether or not it is a
    profile to store. response_from: origin of the response; irradiance_spread_ev: difference of the light between the
    ends of pairs. gamma_from: what determined the exponent gamma; gamma_sigma: standard error of ln gamma.
    before_rms, heldout_rms, heldout_median, noise_levels: levels of 255. frame_share, image_share: share of the
    residual variance that follows one map over the frame, or a separate map per image. inlier_share: 0..1. grey_ends:
    pair ends by tenths of the grey range. model: what the result consists of, the most complex description that
    predicts held-out pairs better than all simpler ones. equal_exposures: no exposure was known and the pictures show
    no difference, so that all are taken as equal. falloff_prior_distance, center_prior_distance: how far the pictures
    alone are from what lenses have in common, in standard errors. error_inflation: variance of the falloff over that
    of independent pairs.

    Of the whole fit: exposures: exposure and white balance of every image relative to the reference, EXPOSURE_DTYPE;
    image_quality: how well each image is determined, IMAGE_QUALITY_DTYPE. left_out: number of inconsistent images, with
    ev NaN in `exposures` and `joined` 0 in `image_quality`; reference: the image of 0 EV. components: connected groups
    of images. settings: tuple of FitResult by FitImage.setting. cameras: tuple of FitCamera by FitImage.camera.
    seconds: time taken. colour_variance_before, colour_variance_exposures_only, colour_variance: with points, of a
    point's colour over the images that see it, levels of 255 squared: as they are, corrected by exposures and white
    balances alone, and by the result.
    """

    images: int = default
    setting_pairs: int = default
    usable: Flag = Flag()
    response: Nested[Response] = Nested(Response)
    vignetting: Curves[Vignetting] = Curves(Vignetting, "vignettings")
    vignettings: int = default
    camera: int = default
    pairs: int = default
    components: int = default
    iterations: int = default
    converged: Flag = Flag()
    gamma_from: Enumerated[GammaFrom] = Enumerated(GammaFrom)
    gamma_sigma: float = default
    before_rms: float = default
    heldout_rms: float = default
    heldout_median: float = default
    noise_levels: float = default
    inlier_share: float = default
    frame_share: float = default
    image_share: float = default
    seconds: float = default
    radius_ends: Vector = Vector(writable=False)
    grey_ends: Vector = Vector(writable=False)
    covariance_size: int = default
    profile_prior: Enumerated[ProfilePrior] = Enumerated(ProfilePrior)
    covariance: Covariance = Covariance()
    gamma_direction: Vector = Vector(writable=False)
    equalizes: Flag = Flag()
    left_out: int = default
    reference: int = default
    response_from: Enumerated[FitResponse] = Enumerated(FitResponse)
    irradiance_spread_ev: float = default
    model: Enumerated[FitModel] = Enumerated(FitModel)
    falloff_prior_distance: float = default
    center_prior_distance: float = default
    error_inflation: float = default
    equal_exposures: Flag = Flag()
    setting_count: int = default
    camera_count: int = default
    colour_variance_before: float = default
    colour_variance_exposures_only: float = default
    colour_variance: float = default
    _fit: Any = None

    @property
    def settings(self) -> tuple[FitResult, ...]:
        return self._fit.settings

    @property
    def cameras(self) -> tuple[FitCamera, ...]:
        return self._fit.cameras

    @property
    def exposures(self) -> Records:
        return self._fit.exposures

    @property
    def image_quality(self) -> Records:
        return self._fit.quality

    def exposure(self, index: int) -> Exposure:
        """Exposure and white balance of image `index`."""
        return Exposure.from_buffer_copy(self.exposures[index])

    def profile(self, key: ProfileKey, source: str = "", created: Optional[datetime.datetime] = None,
                setting: Optional[int] = None) -> Profile:
        """A profile of this result, to be stored or applied. source: file of origin. created: with time zone; None = unknown.
        setting: number of the lens setting; None = that of the reference."""
        profile, error = Profile(key=key), _abi.ErrorText()
        number = _abi.FIT_REFERENCE if setting is None else integer(setting, "setting")
        with self._fit._use() as fit:
            check(lib.lensprof_fit_profile(fit, number, byref(profile), byref(error)),
                  "no profile" if setting is None else f"no profile of setting {setting}", error)
        profile.provenance.source, profile.provenance.created = source, created
        return profile

    def transfer_rms(self, pairs: Records) -> tuple[float, float]:
        """Root mean square and median absolute value of the transfer residual of pairs under this fit, in levels of
        255."""
        rms, median, error = c_double(), c_double(), _abi.ErrorText()
        with self._fit._use() as fit:
            check(lib.lensprof_fit_transfer_rms(fit, *_arrays.pairs(pairs), byref(rms), byref(median), byref(error)),
                  "the pairs do not belong to this fit", error)
        return rms.value, median.value

    def colour_differences(self, pairs: Records) -> Array:
        """Half the squared difference of the colours at the ends of each pair, corrected by this fit, in levels of 255
        squared: of colour_variance. NaN for pairs of images left out."""
        differences, error = np.zeros(len(pairs)), _abi.ErrorText()
        with self._fit._use() as fit:
            check(lib.lensprof_fit_colour_differences(fit, *_arrays.pairs(pairs),
                                                      _arrays.address(differences, c_double), byref(error)),
                  "the pairs do not belong to this fit", error)
        return differences


def _fit(function: Any, images: Sequence[FitImage], data: tuple[Any, int], options: FitOptions) -> FitResult:
    error, pointer = _abi.ErrorText(), POINTER(_abi.Fit)()
    exposures = np.zeros(len(images), dtype=_arrays.EXPOSURE_DTYPE)
    array = (_abi.FitImage * len(images))(*images)
    with calling(options) as call:
        status = function(byref(call), array, len(images), *data, None, 0, _arrays.address(exposures, _abi.Exposure),
                          byref(pointer), byref(error))
    check(status, "the fit failed", error)
    return FitOf(pointer, exposures).reference


def fit_overlap(images: Sequence[FitImage], pairs: Records, options: Optional[FitOptions] = None) -> FitResult:
    """Fits pairs (PAIR_DTYPE) over at least two images. Also returns if the result is poor: see `usable`."""
    options = options or FitOptions()
    for name in ("points", "view_distances"):
        values = getattr(options, name)
        if values is not None and len(values) != len(pairs):
            raise ValueError(f"{len(values)} {name} for {len(pairs)} pairs: give one for each")
    return _fit(lib.lensprof_fit_overlap, images, _arrays.pairs(pairs), options)


def fit_radiance(images: Sequence[FitImage], observations: Records,
                 options: Optional[FitOptions] = None) -> FitResult:
    """Fits tracks of observations (OBSERVATION_DTYPE, in any order) over at least two images, with Method.RADIANCE."""
    return _fit(lib.lensprof_fit_radiance, images, _arrays.observations(observations),
                options or FitOptions(method=Method.RADIANCE))
