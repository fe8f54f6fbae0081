"""The camera model: response, vignetting, exposure. B = f( L * M(r) * e * w ), see lensprof/model.h.

The maths is in the library. Functions here take numbers or arrays of any shape, and make one call of it for all: a
number gives a float, arrays an array of their broadcast shape. To correct pictures there is lensprof.Plan.
"""
from __future__ import annotations

from ctypes import POINTER, byref, c_double
from typing import Any, Callable, Iterable, Optional, overload

import numpy as np
import numpy.typing as npt

from . import _abi
from ._abi import CameraKind, ResponseKind, Status
from ._library import Error, check, lib
from ._struct import Enumerated, Value, Vector, _Field, default, integer
from ._types import Array, Numbers, Values


def _pointer(array: Array) -> Any:
    return array.ctypes.data_as(POINTER(c_double))


def _given(result: Array) -> Any:
    """The result for scalars as a float."""
    return result if result.ndim else float(result)


def positions(x: Numbers, y: Numbers) -> Array:
    """The broadcast coordinates side by side, as the library takes them: the last axis has x and y."""
    points = np.empty(np.broadcast(np.asarray(x), np.asarray(y)).shape + (2,))
    points[..., 0], points[..., 1] = x, y
    return points


def mapped(function: Callable[..., Any], this: Any, points: Array) -> Array:
    """function(this, points, count, results) of the library for positions: results of the same shape."""
    results = np.empty_like(points)
    function(byref(this), _pointer(points), points.size // 2, _pointer(results))
    return results


def _curve(function: Callable[..., None], this: Any, numbers: Numbers, slope: bool = False) -> Any:
    """function(this, numbers, count, values, slopes) of the library: the values, or the slopes."""
    given = np.asarray(numbers, dtype=np.float64, order="C")
    values, slopes = np.empty(given.shape), np.empty(given.shape) if slope else None
    function(byref(this), _pointer(given), given.size, _pointer(values), None if slopes is None else _pointer(slopes))
    return _given(values if slopes is None else slopes)


def _doubles(values: Iterable[float]) -> Any:
    numbers = [float(v) for v in values]
    return (c_double * len(numbers))(*numbers)


class Response(Value, _abi.Response):
    """A response curve f from irradiance 0..1 to grey value 0..1: non-decreasing, f(0) = 0, f(1) = 1. Linear by
    default.

    It cannot be changed, only replaced. Fields: kind; modes (EMoR modes in use); gamma; emor[25], the EMoR
    coefficients; table[1024], f(j / 1023) for every kind. The arrays are read-only views.
    """

    kind: Enumerated[ResponseKind] = Enumerated(ResponseKind)
    modes: int = default
    gamma: float = default
    emor: Vector = Vector(writable=False)
    table: Vector = Vector(writable=False)

    def __init__(self) -> None:
        super().__init__()

    def _set_defaults(self) -> None:
        lib.lensprof_response_set_linear(byref(self))

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a Response cannot be changed; make one with Response.from_gamma, from_emor or from_table")

    @classmethod
    def linear(cls) -> Response:
        """f(x) = x."""
        return cls()

    @classmethod
    def from_gamma(cls, gamma: float) -> Response:
        """f(x) = x^(1/gamma), gamma 0.1..10."""
        response = cls()
        check(lib.lensprof_response_set_gamma(byref(response), gamma), f"gamma {gamma}: give 0.1..10")
        return response

    @classmethod
    def srgb(cls) -> Response:
        """The transfer function of sRGB, of pictures rendered for screens."""
        response = cls()
        lib.lensprof_response_set_srgb(byref(response))
        return response

    @classmethod
    def from_emor(cls, coefficients: Iterable[float]) -> Response:
        """Mean curve of the empirical model of response plus 0..25 of its modes times coefficients."""
        response, numbers = cls(), _doubles(coefficients)
        check(lib.lensprof_response_set_emor(byref(response), numbers, len(numbers)),
              f"{len(numbers)} EMoR coefficients: give at most 25, finite, for which the curve does not decrease")
        return response

    @classmethod
    def from_table(cls, values: Iterable[float]) -> Response:
        """Piecewise linear through at least 2 values on a uniform grid of irradiance, from 0 to 1 (within 1e-6)."""
        response, numbers = cls(), _doubles(values)
        check(lib.lensprof_response_set_table(byref(response), numbers, len(numbers)),
              f"table of {len(numbers)} values: give 2..1048576 finite ones that rise from 0 to 1")
        return response

    @classmethod
    def typical(cls, kind: CameraKind = CameraKind.ANY) -> tuple[Response, Array, float]:
        """The mean of the cameras of a kind, the 25 x 25 covariance of its EMoR coefficients, and the error of ln
        gamma."""
        response, covariance, sigma = cls(), np.empty((_abi.EMOR_MODES, _abi.EMOR_MODES)), c_double()
        check(lib.lensprof_response_set_typical(byref(response), CameraKind(kind),
                                                _pointer(covariance), byref(sigma)),
              f"camera kind {kind}")
        return response, covariance, sigma.value

    def validate(self) -> None:
        """Raises lensprof.Error unless this is a response."""
        check(lib.lensprof_response_validate(byref(self)), "not a response: it must rise from 0 to 1")

    @overload
    def eval(self, x: float) -> float: ...

    @overload
    def eval(self, x: Values) -> Array: ...

    def eval(self, x: Numbers) -> Any:
        """f(x), the grey value of irradiance x; outside 0..1 as at the nearer end."""
        return _curve(lib.lensprof_response_eval_many, self, x)

    @overload
    def eval_slope(self, x: float) -> float: ...

    @overload
    def eval_slope(self, x: Values) -> Array: ...

    def eval_slope(self, x: Numbers) -> Any:
        """df/dx; 0 outside 0..1, where a sensor saturates."""
        return _curve(lib.lensprof_response_eval_many, self, x, slope=True)

    @overload
    def invert(self, b: float) -> float: ...

    @overload
    def invert(self, b: Values) -> Array: ...

    def invert(self, b: Numbers) -> Any:
        """g(b), the smallest irradiance with grey value b; outside 0..1 as at the nearer end."""
        return _curve(lib.lensprof_response_invert_many, self, b)

    @overload
    def invert_slope(self, b: float) -> float: ...

    @overload
    def invert_slope(self, b: Values) -> Array: ...

    def invert_slope(self, b: Numbers) -> Any:
        """dg/db; 0 outside 0..1 and where f is flat."""
        return _curve(lib.lensprof_response_invert_many, self, b, slope=True)


def emor_table(mode: int) -> Array:
    """EMoR's mean curve f0 (mode 0) or mode 1..25: a read-only view of 1024 samples on the grid j / 1023."""
    samples = lib.lensprof_emor_table(integer(mode, "mode"))
    if not samples:
        raise Error(Status.ERROR_ARGUMENT, f"EMoR has no mode {mode}; give 0..{_abi.EMOR_MODES}")
    table = np.ctypeslib.as_array(samples, (_abi.RESPONSE_SAMPLES,))
    table.flags.writeable = False
    return table


def half_diagonal(width: int, height: int) -> float:
    """Half the diagonal of a frame of width x height px, in px: the unit of r and of centres."""
    return lib.lensprof_half_diagonal(integer(width, "width"), integer(height, "height"))


class Vignetting(Value, _abi.Vignetting):
    """Radial falloff M = 1 + k1 r^2 + k2 r^4 + k3 r^6; by default no falloff.

    k: k1, k2, k3. center: x (right) and y (down) from the middle of the frame. r and center are in half diagonals.
    """

    k: Vector = Vector()
    center: Vector = Vector()

    def validate(self) -> None:
        """Raises lensprof.Error unless finite, |center| <= 1 and M >= 0.001 on the whole frame."""
        check(lib.lensprof_vignetting_validate(byref(self)),
              f"{self}: not a falloff; M must be finite and at least 0.001 on the whole frame, |center| at most 1")

    @overload
    def eval(self, r2: float) -> float: ...

    @overload
    def eval(self, r2: Values) -> Array: ...

    def eval(self, r2: Numbers) -> Any:
        """M as a function of r^2."""
        return _curve(lib.lensprof_vignetting_eval_many, self, r2)

    @overload
    def eval_slope(self, r2: float) -> float: ...

    @overload
    def eval_slope(self, r2: Values) -> Array: ...

    def eval_slope(self, r2: Numbers) -> Any:
        """dM/d(r^2)."""
        return _curve(lib.lensprof_vignetting_eval_many, self, r2, slope=True)

    @overload  # type: ignore[misc, unused-ignore]  # a float is one of Numbers
    def r2(self, width: int, height: int, x: float, y: float) -> float: ...

    @overload
    def r2(self, width: int, height: int, x: Numbers, y: Numbers) -> Array: ...

    def r2(self, width: int, height: int, x: Numbers, y: Numbers) -> Any:
        """r^2 of pixel (x, y) in a frame of width x height px; pixel centres are integers."""
        return _given(self._r2(width, height, x, y)[0])

    def r2_gradient(self, width: int, height: int, x: Numbers, y: Numbers) -> Array:
        """d(r^2)/d(center x, center y): the last axis has these two."""
        return self._r2(width, height, x, y)[1]

    def _r2(self, width: int, height: int, x: Numbers, y: Numbers) -> tuple[Array, Array]:
        points = positions(x, y)
        r2, gradients = np.empty(points.shape[:-1]), np.empty_like(points)
        lib.lensprof_vignetting_r2_many(byref(self), integer(width, "width"), integer(height, "height"), _pointer(points),
                                        r2.size, _pointer(r2), _pointer(gradients))
        return r2, gradients


class Attenuation(_Field):
    """The nodes of a gain grid as a view of shape (channels, rows, columns); assigning sets the grid's size."""

    def __get__(self, instance: Any, owner: Optional[type] = None) -> npt.NDArray[np.float32]:
        if instance is None:
            return self  # type: ignore[return-value]
        shape = (min(instance.channels, 3), min(instance.rows, _abi.GRID_SIDE), min(instance.columns, _abi.GRID_SIDE))
        nodes = np.ctypeslib.as_array(self.raw.__get__(instance))
        return nodes[:shape[0] * shape[1] * shape[2]].reshape(shape)

    def __set__(self, instance: Any, values: Values) -> None:
        array = np.array(values, dtype=np.float32)  # a copy: it may be a view of this very grid
        array = array[np.newaxis] if array.ndim == 2 else array
        is_grid = array.ndim == 3 and array.shape[0] in (1, 3)
        if not (is_grid and all(2 <= side <= _abi.GRID_SIDE for side in array.shape[1:])):
            raise ValueError(f"a gain grid of shape {array.shape} is not (rows, columns), (1, rows, columns) or "
                             f"(3, rows, columns) with 2..{_abi.GRID_SIDE} of each")
        nodes = np.ctypeslib.as_array(self.raw.__get__(instance))
        nodes[:array.size], nodes[array.size:] = array.ravel(), 0.0
        instance.channels, instance.rows, instance.columns = array.shape


class GainGrid(Value, _abi.GainGrid):
    """Attenuation on a grid over the frame, multiplied by the falloff, for what a radial polynomial cannot describe. By
    default no grid.

    attenuation: (rows, columns) or (channels, rows, columns), 2..32 nodes per side, within 0.001..1000; its first node
    lies at the first pixel of the frame, its last at the last. Assigning it sets channels, rows and columns.
    """

    columns: int = default
    rows: int = default
    channels: int = default
    attenuation: Attenuation = Attenuation()

    def __init__(self, attenuation: Optional[Values] = None) -> None:
        super().__init__(**({} if attenuation is None else {"attenuation": attenuation}))

    def validate(self) -> None:
        """Raises lensprof.Error unless there is no grid or all its attenuations are within 0.001..1000."""
        check(lib.lensprof_gain_grid_validate(byref(self)),
              f"gain grid of {self.columns} x {self.rows} nodes, {self.channels} channels: give 2..{_abi.GRID_SIDE} "
              "nodes a side, 1 or 3 channels, attenuations within 0.001..1000")

    @overload  # type: ignore[misc, unused-ignore]  # a float is one of Numbers
    def eval(self, width: int, height: int, x: float, y: float, channel: int = ...) -> float: ...

    @overload
    def eval(self, width: int, height: int, x: Numbers, y: Numbers, channel: int = ...) -> Array: ...

    def eval(self, width: int, height: int, x: Numbers, y: Numbers, channel: int = 1) -> Any:
        """Attenuation at pixel (x, y) of a frame of width x height px, bilinear; 1 where there is no grid."""
        if channel not in (0, 1, 2):
            raise Error(Status.ERROR_ARGUMENT, f"channel {channel}: give 0, 1 or 2")
        self.validate()
        points = positions(x, y)
        results = np.empty(points.shape[:-1])
        lib.lensprof_gain_grid_eval_many(byref(self), integer(width, "width"), integer(height, "height"),
                                         _pointer(points), results.size, channel, _pointer(results))
        return _given(results)


class Levels(Value, _abi.Levels):
    """Samples without light and at saturation, as shares of full scale: grey value = (sample - black) / (white -
    black). By default none: the grey value is the sample.

    black: of red, green and blue, -0.5..1; grey pictures use green. white: 0 = 1, full scale.
    """

    black: Vector = Vector()
    white: float = default

    def validate(self) -> None:
        """Raises lensprof.Error unless black lies below white."""
        check(lib.lensprof_levels_validate(byref(self)), f"{self}: black must lie below white, white at most 1")

    def to_value(self, sample: float, channel: int = 1) -> float:
        """The grey value of a sample (0..1), not clipped."""
        return float(lib.lensprof_levels_to_value(byref(self), integer(channel, "channel"), sample))

    def to_sample(self, value: float, channel: int = 1) -> float:
        """The reverse."""
        return float(lib.lensprof_levels_to_sample(byref(self), integer(channel, "channel"), value))


class ImageCircle(Value, _abi.ImageCircle):
    """The circle that the lens lights up, where it does not cover the frame. Outside of it no falloff holds, and
    corrections leave pictures as they are. By default none.

    center: to the right of and below the middle of the frame, half diagonals, -1..1. radius: half diagonals, up to 4;
    0 = none.
    """

    center: Vector = Vector()
    radius: float = default

    def validate(self) -> None:
        """Raises lensprof.Error unless the numbers are within these ranges."""
        check(lib.lensprof_image_circle_validate(byref(self)), f"{self}: center or radius out of range")

    def contains(self, width: int, height: int, x: float, y: float) -> bool:
        """Whether pixel (x, y) of a frame of width x height pixels lies in the circle, or its radius is 0."""
        return bool(lib.lensprof_image_circle_contains(byref(self), integer(width, "width"), integer(height, "height"),
                                                       x, y))


class Exposure(Value, _abi.Exposure):
    """Exposure and white balance of one picture; 0 EV and 1, 1, 1 by default.

    ev: log2 of the exposure factor, larger = more light recorded. white_balance: factors of red, green (1), blue.
    """

    ev: float = default
    white_balance: Vector = Vector()

    def validate(self) -> None:
        """Raises lensprof.Error unless |ev| <= 64 and the factors are in 1e-6..1e6."""
        check(lib.lensprof_exposure_validate(byref(self)), f"{self}: give |ev| <= 64 and factors in 1e-6..1e6")

    @classmethod
    def mean(cls, exposures: Iterable[Exposure]) -> Exposure:
        """Geometric mean of exposures and white balances, without those whose ev is NaN; NaN if no others are left."""
        given, mean = list(exposures), cls()
        lib.lensprof_exposure_mean((_abi.Exposure * len(given))(*given), len(given), byref(mean))
        return mean

    def factor(self, channel: int) -> float:
        """2^ev times the white balance of channel 0, 1 or 2."""
        if channel not in (0, 1, 2):
            raise Error(Status.ERROR_ARGUMENT, f"channel {channel}: give 0, 1 or 2")
        return 2.0 ** self.ev * float(self.white_balance[channel])
