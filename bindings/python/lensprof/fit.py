"""Recovers response, vignetting, exposure and white balance from correspondences; see lensprof/fit.h."""
from __future__ import annotations

import ctypes
from ctypes import byref, c_double, sizeof
from typing import Any, Iterable, Optional, Sequence, Union

import numpy as np

from . import _abi, _arrays
from ._abi import CameraKind, FitModel, FitResponse, Free, GammaFrom, Loss, Method, ProfilePrior, Reason
from ._library import check, lib
from ._progress import WithProgress, calling
from ._struct import (Curves, Enumerated, Flag, Nested, Numbers, OptionalReference, Struct, Text, Value, Vector, integer,
                      one_or_three)
from .model import Exposure, Response, Vignetting
from .profile import Covariance, Profile, ProfileKey
from .reason import Item


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

    width: int
    height: int
    exposure = Nested(Exposure)
    free = Enumerated(Free)
    ev_of: int
    red_of: int
    blue_of: int
    setting: int
    camera: int
    known_ev: float
    known_ev_sigma: float
    f_number_ratio: float
    crop_factor: float

    def __init__(self, index: int, width: int, height: int, **fields: Any):
        numbers = [integer(n, what) for n, what in ((index, "index"), (width, "width"), (height, "height"))]
        lib.lensprof_fit_image_init_sized(byref(self), sizeof(self), *numbers)
        super().__init__(**fields)


class FitOptions(WithProgress, Struct, _abi.FitOptions):
    """Options of a fit. Defaults: 3 channels, reference 0, everything free, modes chosen by held-out error.

    channels: 1 or 3. reference: the image whose exposure stays as given. free: Free.RESPONSE .. CENTER. modes: EMoR
    modes 0..25 or MODES_AUTO. huber_levels: levels of 255. prior_weight: 0 = none, as in the paper. response,
    vignetting: values if fixed (None = EMoR mean). vignettings: falloff curves, 1, 3 or 0 = chosen by held-out error.
    gamma_from: GammaFrom.AUTO, PRIOR or EXPOSURES. camera_kind: selects the responses of the prior. method:
    Method.TRANSFER, RADIANCE, TRANSFER_FUNCTION, or DEBEVEC: only the response, from known exposures of all images.
    refine: free the response from the EMoR modes, unless held-out pairs get clearly worse. threads: maximum number, 0 =
    one per core; does not affect the result. profile: of the same camera, lens and setting, from other pictures;
    replaces the prior of all cameras, and the result supersedes it unless FitResult.profile_prior is OVERRULED. links:
    those of SampleOptions, so that the result warns of images connected only where there is no texture to check the
    alignment; None = unknown.

    progress: called repeatedly during a fit with the fraction done (0..1). The fit is cancelled if it returns True or
    raises an exception, which then propagates from fit_overlap.
    """

    channels: int
    reference: int
    free = Enumerated(Free)
    modes: int
    loss = Enumerated(Loss)
    huber_levels: float
    prior_weight: float
    max_iterations: int
    vignettings: int
    gamma_from = Enumerated(GammaFrom)
    camera_kind = Enumerated(CameraKind)
    threads: int
    method = Enumerated(Method)
    refine = Flag()
    profile = OptionalReference(Profile)
    response = OptionalReference(Response)
    vignetting = Nested(Vignetting)
    _links: Optional[np.ndarray] = None

    @property
    def links(self) -> Optional[np.ndarray]:
        return self._links

    @links.setter
    def links(self, links: Optional[np.ndarray]) -> None:
        data, count = (None, 0) if links is None else _arrays.links(links)
        self._links, self.link_count = links, count
        _abi.FitOptions.links.__set__(self, data)

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in super()._names() if not name.startswith("link")]


class FitSetting(Struct, _abi.FitSetting):
    """Result for one lens setting; the fields have the same meaning as in FitResult.

    images: images of this setting in the fit; if 0, the other fields have no meaning. pairs: pairs with an end in them.
    """

    images: int
    pairs: int
    usable = Flag()
    reason = Text()
    vignetting = Curves(Vignetting, "_vignettings")
    radius_ends = Vector(writable=False)
    reason_code = Enumerated(Reason)
    reason_values: int
    reason_item = Nested(Item)
    reason_value = Numbers("reason_values")
    covariance = Covariance()
    gamma_direction = Vector(writable=False)
    _vignettings = 1
    _covariance_size = 0

    @property
    def covariance_size(self) -> int:
        return self._covariance_size


class FitCamera(Struct, _abi.FitCamera):
    """Result for one camera, if the fit has several; the fields have the same meaning as in FitResult, for a fit of the
    pairs between its own images.

    images: images of this camera in its fit; if 0, the other fields have no meaning. attached: additional images, whose
    exposures follow from pairs with other cameras. joined: its exposures are relative to the reference, through pairs
    with other cameras; otherwise they are NaN. shared_pairs: pairs with another camera; agreeing_share: share of them
    within 3 sigma of the residual; light_difference_ev: median difference of the light at their ends. log_gamma: shift
    of its own fit to agree with the others. offset_sigma_ev: standard error of the offset of its exposures. reference:
    image whose exposure was fixed in its own fit; setting: setting of that image.
    """

    images: int
    attached: int
    joined = Flag()
    shared_pairs: int
    agreeing_share: float
    light_difference_ev: float
    log_gamma: float
    offset_sigma_ev: float
    response = Nested(Response)
    vignettings: int
    pairs: int
    evens = Flag()
    gamma_from = Enumerated(GammaFrom)
    response_from = Enumerated(FitResponse)
    profile_prior = Enumerated(ProfilePrior)
    covariance_size: int
    converged = Flag()
    gamma_sigma: float
    before_rms: float
    heldout_rms: float
    heldout_median: float
    noise_levels: float
    inlier_share: float
    frame_share: float
    image_share: float
    light_spread_ev: float
    grey_ends = Vector(writable=False)
    reference: int
    setting: int


class FitResult(Struct, _abi.FitResult):
    """Result of a fit. Arrays are views on this object.

    usable: a profile to store; if False, `reason` states why; if True, `reason` may have a warning. evens: the result
    evens out these pictures, whether or not it is a profile to store. left_out: number of inconsistent images, with ev
    NaN in `exposures` and `joined` 0 in `image_quality`; reference: the image of 0 EV. response_from: origin of the
    response; light_spread_ev: difference of the light between the ends of pairs. reason_code: a Reason; reason_item:
    the image concerned; reason_value: its numbers. response: of all images. vignetting: tuple of 1 (all channels) or 3.
    exposures: exposure and white balance of every image relative to the reference, EXPOSURE_DTYPE; image_quality: how
    well each image is determined, IMAGE_QUALITY_DTYPE. pairs: pairs used. components: connected groups of images.
    gamma_from: what determined the exponent gamma; gamma_sigma: standard error of ln gamma; gamma_direction: change of
    each parameter per unit of it. before_rms, heldout_rms, heldout_median, noise_levels: levels of 255. frame_share,
    image_share: share of the residual variance that follows one map over the frame, or a separate map per image.
    inlier_share: 0..1. seconds: time taken. radius_ends, grey_ends: pair ends by tenths of the half diagonal and of the
    grey range. covariance: n x n as in Profile; fixed parameters have zero rows. settings: tuple of FitSetting by
    FitImage.setting; if there are several, vignetting, radius_ends, usable, reason, covariance and gamma_direction of
    the result are those of the reference's setting. cameras: tuple of FitCamera by FitImage.camera; if there are
    several, the other fields of the result describe the reference's camera, except exposures, image_quality and
    left_out, which cover all. model: what the result consists of, the most complex description that predicts held-out
    pairs better than all simpler ones. falloff_prior_distance, center_prior_distance: how far the pictures alone are
    from what lenses have in common, in standard errors. error_inflation: variance of the falloff over that of
    independent pairs. equal_exposures: no exposure was known and the pictures show no difference, so that all are taken
    as equal.
    """

    usable = Flag()
    reason = Text()
    response = Nested(Response)
    vignetting = Curves(Vignetting, "vignettings")
    vignettings: int
    pairs: int
    components: int
    iterations: int
    converged = Flag()
    gamma_from = Enumerated(GammaFrom)
    gamma_sigma: float
    before_rms: float
    heldout_rms: float
    heldout_median: float
    noise_levels: float
    inlier_share: float
    frame_share: float
    image_share: float
    seconds: float
    radius_ends = Vector(writable=False)
    grey_ends = Vector(writable=False)
    covariance_size: int
    profile_prior = Enumerated(ProfilePrior)
    covariance = Covariance()
    gamma_direction = Vector(writable=False)
    reason_code = Enumerated(Reason)
    reason_values: int
    reason_item = Nested(Item)
    reason_value = Numbers("reason_values")
    evens = Flag()
    left_out: int
    reference: int
    response_from = Enumerated(FitResponse)
    light_spread_ev: float
    model = Enumerated(FitModel)
    falloff_prior_distance: float
    center_prior_distance: float
    error_inflation: float
    equal_exposures = Flag()

    def __init__(self, image_count: int, options: Optional[FitOptions] = None, setting_count: int = 1,
                 camera_count: int = 1):
        super().__init__()
        given = options or FitOptions()
        self._options = FitOptions(method=given.method, profile=given.profile)
        self._exposures = np.zeros(image_count, dtype=_arrays.EXPOSURE_DTYPE)
        self._quality = np.zeros(image_count, dtype=_arrays.IMAGE_QUALITY_DTYPE)
        self._settings = (FitSetting * setting_count)(*(FitSetting() for _ in range(setting_count)))
        self._cameras = (FitCamera * camera_count)(*(FitCamera() for _ in range(camera_count)))
        self._camera_of: dict[int, int] = {}  # of each setting

    @classmethod
    def _names(cls) -> list[str]:
        hidden = "image_quality", "settings", "setting_count", "cameras", "camera_count"
        return [name for name in super()._names() if name not in hidden]

    @property
    def settings(self) -> tuple[FitSetting, ...]:
        settings = tuple(self._settings)
        for number, setting in enumerate(settings):
            camera = self._cameras[self._camera_of.get(number, 0)]
            own = camera if camera.images else self
            setting._vignettings, setting._covariance_size = own.vignettings, own.covariance_size
        return settings

    @property
    def cameras(self) -> tuple[FitCamera, ...]:
        return tuple(self._cameras)

    @property
    def exposures(self) -> np.ndarray:
        return self._exposures

    @property
    def image_quality(self) -> np.ndarray:
        return self._quality

    def exposure(self, index: int) -> Exposure:
        """Exposure and white balance of image `index`."""
        return Exposure.from_buffer_copy(self._exposures[index])

    def profile(self, key: ProfileKey, source: str = "", created_unix_s: int = 0,
                setting: Optional[int] = None) -> Profile:
        """A profile of this result, to be stored or applied. source: file of origin. created_unix_s 0 = unknown.
        setting: number of the lens setting; None = that of the reference."""
        profile, error, count = Profile(key=key), _abi.ErrorText(), len(self._exposures)
        result: _abi.FitResult = self
        if setting is not None:
            result, found = _abi.FitResult.from_buffer_copy(self), self._settings[setting]
            camera = self._cameras[self._camera_of.get(setting, 0)]
            if camera.images:
                check(lib.lensprof_fit_result_take_camera(byref(result), byref(camera), byref(error)),
                      f"no profile of setting {setting}", error)
            check(lib.lensprof_fit_result_take_setting(byref(result), byref(found), byref(error)),
                  f"no profile of setting {setting}", error)
            count = found.images
        check(lib.lensprof_profile_from_fit(byref(profile), byref(result), byref(self._options), count,
                                            byref(error)), "no profile", error)
        profile.provenance.source, profile.provenance.created_unix_s = source, created_unix_s
        return profile


def _fit_images(images: Sequence[FitImage]) -> Any:
    return (_abi.FitImage * len(images))(*images)


def _fit(function: Any, images: Sequence[FitImage], data: tuple[Any, int], options: FitOptions) -> FitResult:
    error, result = _abi.ErrorText(), FitResult(
        len(images), options, min(1 + max((i.setting for i in images), default=0), _abi.SETTINGS_MAX),
        min(1 + max((i.camera for i in images), default=0), _abi.CAMERAS_MAX))
    result._camera_of = {i.setting: min(i.camera, len(result._cameras) - 1) for i in images}
    out = _abi.FitResult.from_buffer(result)
    out.settings = ctypes.cast(result._settings, ctypes.POINTER(_abi.FitSetting))
    out.setting_count = len(result._settings)
    out.cameras = ctypes.cast(result._cameras, ctypes.POINTER(_abi.FitCamera))
    out.camera_count = len(result._cameras)
    out.image_quality = _arrays.address(result.image_quality, _abi.FitImageQuality)
    with calling(options) as call:
        status = function(byref(call), _fit_images(images), len(images), *data,
                          _arrays.address(result.exposures, _abi.Exposure), byref(result), byref(error))
    check(status, "the fit failed", error)
    return result


def fit_overlap(images: Sequence[FitImage], pairs: np.ndarray, options: Optional[FitOptions] = None) -> FitResult:
    """Fits pairs (PAIR_DTYPE) over at least two images. Also returns if the result is poor: see `usable`."""
    return _fit(lib.lensprof_fit_overlap, images, _arrays.pairs(pairs), options or FitOptions())


def fit_radiance(images: Sequence[FitImage], observations: np.ndarray,
                 options: Optional[FitOptions] = None) -> FitResult:
    """Fits tracks of observations (OBSERVATION_DTYPE, in any order) over at least two images, with Method.RADIANCE."""
    return _fit(lib.lensprof_fit_radiance, images, _arrays.observations(observations),
                options or FitOptions(method=Method.RADIANCE))


def transfer_rms(response: Response, vignetting: Union[Vignetting, Iterable[Vignetting]], images: Sequence[FitImage],
                 exposures: Union[np.ndarray, Iterable[Exposure]], pairs: np.ndarray,
                 channels: int = 3) -> tuple[float, float]:
    """Root mean square and median absolute value of the transfer residual of pairs under a model, in levels of 255.
    vignetting: one for all channels, or three."""
    curves = one_or_three(vignetting, Vignetting, "vignetting")
    given = _arrays.exposures(exposures)
    if len(given) != len(images):
        raise ValueError(f"{len(given)} exposures for {len(images)} images; give one an image")
    rms, median, error = c_double(), c_double(), _abi.ErrorText()
    check(lib.lensprof_transfer_rms(byref(response), (_abi.Vignetting * 3)(*(curves * 3)[:3]), _fit_images(images),
                                    _arrays.address(given, _abi.Exposure), len(images), *_arrays.pairs(pairs),
                                    integer(channels, "channels"), byref(rms), byref(median),
                                    byref(error)),
          "this model and these pairs do not go together", error)
    return rms.value, median.value
