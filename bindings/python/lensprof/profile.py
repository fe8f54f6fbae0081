"""Calibration of one camera, lens and setting; see lensprof/profile.h."""
from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_size_t, cast, create_string_buffer
from typing import TYPE_CHECKING, Any, Iterable, Union

import numpy as np
import numpy.typing as npt

from . import _abi
from ._abi import CameraKind, Pack, Processing
from ._library import check, lib
from ._struct import Curves, Enumerated, Flag, Nested, Text, UnixTime, Value, default, integer
from ._types import Array
from .model import GainGrid, ImageCircle, Levels, Response, Vignetting

if TYPE_CHECKING:
    from matplotlib.figure import Figure  # type: ignore[import,unused-ignore]


class ProfileKey(Value, _abi.ProfileKey):
    """The camera, lens and setting that a profile applies to. Defaults: empty texts, lensprof.UNKNOWN, processing JPEG.

    unit: serial numbers of one camera and lens. crop_factor, focal_mm, aperture (f-number), distance_m (may be
    infinite) and color_temperature_k (of the light, if the falloff depends on it) are above 0, or UNKNOWN. style: the
    picture style of a rendering, as named by the camera.
    """

    camera_maker: Text = Text()
    camera_model: Text = Text()
    lens: Text = Text()
    unit: Text = Text()
    crop_factor: float = default
    focal_mm: float = default
    aperture: float = default
    distance_m: float = default
    color_temperature_k: float = default
    processing: Enumerated[Processing] = Enumerated(Processing)
    style: Text = Text()

    def validate(self) -> None:
        """Raises lensprof.Error unless the numbers are in range and the texts without control characters."""
        check(lib.lensprof_profile_key_validate(byref(self)),
              f"{self}: numbers must be above 0 or UNKNOWN, texts without control characters")

    @property
    def camera_kind(self) -> CameraKind:
        """The kind whose typical response applies if the camera's own response is unknown; see Response.typical."""
        self.validate()
        return CameraKind(lib.lensprof_camera_kind_of(byref(self)))


class Provenance(Value, _abi.Provenance):
    """Origin of a profile. Part of a Profile, which sets the defaults.

    created: datetime in UTC, to the second; None = unknown. images, pairs: numbers used. heldout_rms: levels of 255,
    or UNKNOWN. inlier_share: 0..1, or UNKNOWN. doubt: why the profile may be wrong, found at import or by the fit.
    prior_id: the profile of the same database that was the prior of the fit, 0 = none. forced: stored although the
    fit was not usable. not_usable: from a fit that was not usable, which Store.put refuses unless it is forced; it
    is not stored. gamma_sigma: standard error of ln gamma, the common exponent of response and falloff; 0 = unknown.
    """

    method: Text = Text()
    software: Text = Text()
    source: Text = Text()
    created: UnixTime = UnixTime("created_unix_s")
    images: int = default
    pairs: int = default
    heldout_rms: float = default
    inlier_share: float = default
    doubt: Text = Text()
    prior_id: int = default
    forced: Flag = Flag()
    not_usable: Flag = Flag()
    gamma_sigma: float = default

    def _set_defaults(self) -> None:
        self.heldout_rms = self.inlier_share = _abi.UNKNOWN

    @property
    def doubts_response(self) -> bool:
        """Whether the doubt concerns the response alone, which the pictures of the fit did not show."""
        return self.doubt == _abi.DOUBT_RESPONSE


class CameraModel(Value, _abi.CameraModel):
    """A camera, independent of the lens. maker, model: as in EXIF; other_maker, other_model: common name, empty if it
    is the same; variant: distinguishes cameras with the same name. lens: the built-in lens, as named in profiles.
    crop_factor: 43.27 mm over the sensor's diagonal, or UNKNOWN. fixed_lens: it cannot be changed."""

    maker: Text = Text()
    model: Text = Text()
    other_maker: Text = Text()
    other_model: Text = Text()
    variant: Text = Text()
    mount: Text = Text()
    lens: Text = Text()
    source: Text = Text()
    crop_factor: float = default
    fixed_lens: Flag = Flag()

    def _set_defaults(self) -> None:
        lib.lensprof_camera_model_init(byref(self))


def channel_number(channel: int) -> int:
    if integer(channel, "channel") > 2:
        raise ValueError(f"channel {channel} is not 0, 1 or 2")
    return channel


class Covariance:
    """An n x n matrix in the first n*n numbers of the field; reading gives a view, assigning a matrix sets n."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.raw = next(vars(base)[name] for base in owner.__mro__ if "_fields_" in vars(base))

    def __get__(self, instance: Any, owner: type) -> Array:
        if instance is None:
            return self  # type: ignore[return-value]
        n = min(instance.covariance_size, _abi.COVARIANCE_MAX)
        return np.ctypeslib.as_array(self.raw.__get__(instance))[:n * n].reshape(n, n)

    def __set__(self, instance: Any, matrix: npt.ArrayLike) -> None:
        matrix = np.asarray(matrix, dtype=np.float64)
        n = matrix.shape[0] if matrix.ndim else 0
        if matrix.shape != (n, n) or n > _abi.COVARIANCE_MAX:
            raise ValueError(f"a covariance of shape {matrix.shape} is not n x n with n <= {_abi.COVARIANCE_MAX}")
        numbers = np.ctypeslib.as_array(self.raw.__get__(instance))
        numbers[:n * n] = matrix.ravel().copy()
        numbers[n * n:] = 0.0
        instance.covariance_size = n


class Profile(Value, _abi.Profile):
    """Response and vignetting of one camera, lens and setting; by default linear and without falloff.

    response, vignetting: tuples of 1 (all channels) or 3; assign one or three. grid: multiplied by the vignetting.
    covariance: n x n, n = 0 if unknown; in the order EMoR coefficients of each response, k1, k2, k3 of each vignetting,
    centre x and y. levels: black and white of the samples of its pictures. image_circle: outside of it no falloff holds.
    """

    key: Nested[ProfileKey] = Nested(ProfileKey)
    provenance: Nested[Provenance] = Nested(Provenance)
    responses: int = default
    vignettings: int = default
    response: Curves[Response] = Curves(Response, "responses")
    vignetting: Curves[Vignetting] = Curves(Vignetting, "vignettings")
    grid: Nested[GainGrid] = Nested(GainGrid)
    covariance_size: int = default
    covariance: Covariance = Covariance()
    levels: Nested[Levels] = Nested(Levels)
    image_circle: Nested[ImageCircle] = Nested(ImageCircle)

    @classmethod
    def _copy_of(cls, shown: Any) -> Profile:
        """Of a profile that the library shows by a pointer."""
        profile = cls()
        check(lib.lensprof_profile_copy(byref(profile), shown), "the library is older than this package; install both")
        return profile

    def validate(self) -> None:
        """Raises lensprof.Error unless key, curves, gain grid, covariance, levels and image circle are valid."""
        check(lib.lensprof_profile_validate(byref(self)),
              f"{self.key}: not a valid profile; see validate() of its key, response, vignetting and grid, the "
              "covariance must be finite and symmetric")

    def plot(self) -> Figure:
        """Draws response and relative illuminance with matplotlib, and returns the figure."""
        from ._plot import plot_profile

        return plot_profile(self)

    def falloff(self, width: int, height: int, x: float, y: float, channel: int = 0) -> tuple[float, float | None]:
        """Relative illuminance of a channel at pixel (x, y) of a frame, including the gain grid, and its standard error
        from the covariance of the falloff; None if that is unknown."""
        return self._with_sigma(lambda this, sigma: lib.lensprof_profile_falloff(
            this, channel_number(channel), integer(width, "width"), integer(height, "height"), x, y, sigma))

    def radial_falloff(self, r: float, channel: int = 0) -> tuple[float, float | None]:
        """The same for the falloff alone, without gain grid, at r half diagonals from its centre."""
        return self._with_sigma(lambda this, sigma: lib.lensprof_profile_radial_falloff(
            this, channel_number(channel), r, sigma))

    def corner_falloff(self, channel: int = 0) -> tuple[float, float | None]:
        """The same in the corner, r = 1."""
        return self.radial_falloff(1.0, channel)

    def _with_sigma(self, call: Any) -> tuple[float, float | None]:
        self.validate()
        sigma = c_double()
        value = call(byref(self), byref(sigma))
        return value, None if sigma.value == _abi.UNKNOWN else sigma.value

    def pack(self, covariance: bool = False) -> bytes:
        """A blob for firmware, which lensprof_plan_init reads in place (docs/blob.md): response samples in single
        precision, without the provenance's source, and without the covariance unless requested."""
        needed, flags = c_size_t(), Pack.COVARIANCE if covariance else 0
        self.validate()
        check(lib.lensprof_profile_pack(byref(self), flags, None, 0, byref(needed)), "the profile cannot be packed")
        buffer = create_string_buffer(needed.value)
        check(lib.lensprof_profile_pack(byref(self), flags, buffer, needed.value, byref(needed)),
              "the profile cannot be packed")
        return buffer.raw

    @classmethod
    def unpack(cls, blob: Union[bytes, bytearray, memoryview, npt.NDArray[np.uint8]]) -> Profile:
        """The profile of a blob (bytes, or an array). Raises lensprof.Error with ERROR_CORRUPT if any part of it is
        invalid, with ERROR_LAYOUT if a newer lensprof wrote it."""
        data, profile = memoryview(blob).tobytes(), cls()  # type: ignore[arg-type, unused-ignore]
        check(lib.lensprof_profile_unpack(data, len(data), byref(profile)),
              f"{len(data)} bytes: not a profile blob, damaged, or of a newer lensprof; write it again with pack()")
        return profile


def profile_pointers(profiles: Iterable[Profile]) -> tuple[Any, int]:
    """The array of pointers to profiles, as the library takes them, and their number."""
    given = list(profiles)
    if not all(isinstance(profile, Profile) for profile in given):
        raise TypeError("profiles takes an iterable of Profile")
    kind = POINTER(_abi.Profile)
    return (kind * len(given))(*(cast(byref(profile), kind) for profile in given)), len(given)
