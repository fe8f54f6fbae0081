"""The camera model: response, vignetting, exposure. B = f( L * M(r) * e * w ), see lensprof/model.h.

The maths is in the library. Functions here take numbers or arrays and make one call an element: for curves and
points; for pictures there is lensprof.Plan.
"""
from __future__ import annotations

from ctypes import POINTER, byref, c_double
from typing import Any, Callable, Iterable, Union

import numpy as np

from . import _abi
from ._abi import CameraKind, ResponseKind, Status
from ._library import Error, check, lib
from ._struct import Enumerated, Value, Vector, _Field, integer

Numbers = Union[float, np.ndarray]


def each(function: Callable[..., Any], *arguments: Any, columns: int = 0) -> Any:
    """Calls a function of numbers for every element of the broadcast arguments.

    Its results are numbers (columns 0: a float for scalars, else an array), or tuples that become the last axis.
    """
    arrays = np.broadcast_arrays(*[np.asarray(a, dtype=np.float64) for a in arguments])
    shape = arrays[0].shape
    results = np.empty((arrays[0].size, columns) if columns else arrays[0].size)
    for i, numbers in enumerate(zip(*[a.ravel().tolist() for a in arrays])):
        results[i] = function(*numbers)
    if columns:
        return results.reshape(shape + (columns,))
    return results.reshape(shape) if shape else float(results[0])


def _doubles(values: Iterable[float]) -> Any:
    numbers = [float(v) for v in values]
    return (c_double * len(numbers))(*numbers)


class Response(Value, _abi.Response):
    """A response curve f from irradiance 0..1 to grey value 0..1: non-decreasing, f(0) = 0, f(1) = 1. Linear by
    default.

    It cannot be changed, only replaced. Fields: kind; modes (EMoR modes in use); gamma; emor[25], the EMoR
    coefficients; table[1024], f(j / 1023) for every kind. The arrays are read-only views.
    """

    kind = Enumerated(ResponseKind)
    modes: int
    gamma: float
    emor = Vector(writable=False)
    table = Vector(writable=False)

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
    def typical(cls, kind: CameraKind = CameraKind.ANY) -> tuple[Response, np.ndarray, float]:
        """The mean of the cameras of a kind, the 25 x 25 covariance of its EMoR coefficients, and the error of ln
        gamma."""
        response, covariance, sigma = cls(), np.empty((_abi.EMOR_MODES, _abi.EMOR_MODES)), c_double()
        check(lib.lensprof_response_set_typical(byref(response), CameraKind(kind),
                                                covariance.ctypes.data_as(POINTER(c_double)), byref(sigma)),
              f"camera kind {kind}")
        return response, covariance, sigma.value

    def validate(self) -> None:
        """Raises lensprof.Error unless this is a response."""
        check(lib.lensprof_response_validate(byref(self)), "not a response: it must rise from 0 to 1")

    def eval(self, x: Numbers) -> Numbers:
        """f(x), the grey value of irradiance x; outside 0..1 as at the nearer end."""
        this = byref(self)
        return each(lambda v: lib.lensprof_response_eval(this, v, None), x)

    def eval_slope(self, x: Numbers) -> Numbers:
        """df/dx; 0 outside 0..1, where a sensor saturates."""
        this, slope = byref(self), c_double()

        def call(v: float) -> float:
            lib.lensprof_response_eval(this, v, byref(slope))
            return slope.value
        return each(call, x)

    def invert(self, b: Numbers) -> Numbers:
        """g(b), the smallest irradiance with grey value b; outside 0..1 as at the nearer end."""
        this = byref(self)
        return each(lambda v: lib.lensprof_response_invert(this, v, None), b)

    def invert_slope(self, b: Numbers) -> Numbers:
        """dg/db; 0 outside 0..1 and where f is flat."""
        this, slope = byref(self), c_double()

        def call(v: float) -> float:
            lib.lensprof_response_invert(this, v, byref(slope))
            return slope.value
        return each(call, b)


def emor_table(mode: int) -> np.ndarray:
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

    k = Vector()
    center = Vector()

    def validate(self) -> None:
        """Raises lensprof.Error unless finite, |center| <= 1 and M >= 0.001 on the whole frame."""
        check(lib.lensprof_vignetting_validate(byref(self)),
              f"{self}: not a falloff; M must be finite and at least 0.001 on the whole frame, |center| at most 1")

    def eval(self, r2: Numbers) -> Numbers:
        """M as a function of r^2."""
        this = byref(self)
        return each(lambda v: lib.lensprof_vignetting_eval(this, v, None), r2)

    def eval_slope(self, r2: Numbers) -> Numbers:
        """dM/d(r^2)."""
        this, slope = byref(self), c_double()

        def call(v: float) -> float:
            lib.lensprof_vignetting_eval(this, v, byref(slope))
            return slope.value
        return each(call, r2)

    def r2(self, width: int, height: int, x: Numbers, y: Numbers) -> Numbers:
        """r^2 of pixel (x, y) in a frame of width x height px; pixel centres are integers."""
        this, size = byref(self), (integer(width, "width"), integer(height, "height"))
        return each(lambda u, v: lib.lensprof_vignetting_r2(this, *size, u, v, None), x, y)

    def r2_gradient(self, width: int, height: int, x: Numbers, y: Numbers) -> np.ndarray:
        """d(r^2)/d(center x, center y): the last axis has these two."""
        this, size, gradient = byref(self), (integer(width, "width"), integer(height, "height")), (c_double * 2)()

        def call(u: float, v: float) -> Any:
            lib.lensprof_vignetting_r2(this, *size, u, v, gradient)
            return tuple(gradient)
        return each(call, x, y, columns=2)


class Attenuation(_Field):
    """The nodes of a gain grid as a view of shape (channels, rows, columns); assigning sets the grid's size."""

    def __get__(self, instance: Any, owner: type) -> np.ndarray:
        if instance is None:
            return self  # type: ignore[return-value]
        shape = (min(instance.channels, 3), min(instance.rows, _abi.GRID_SIDE), min(instance.columns, _abi.GRID_SIDE))
        nodes = np.ctypeslib.as_array(self.raw.__get__(instance))
        return nodes[:shape[0] * shape[1] * shape[2]].reshape(shape)

    def __set__(self, instance: Any, values: Any) -> None:
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

    columns: int
    rows: int
    channels: int
    attenuation = Attenuation()

    def __init__(self, attenuation: Any = None) -> None:
        super().__init__(**({} if attenuation is None else {"attenuation": attenuation}))

    def validate(self) -> None:
        """Raises lensprof.Error unless there is no grid or all its attenuations are within 0.001..1000."""
        check(lib.lensprof_gain_grid_validate(byref(self)),
              f"gain grid of {self.columns} x {self.rows} nodes, {self.channels} channels: give 2..{_abi.GRID_SIDE} "
              "nodes a side, 1 or 3 channels, attenuations within 0.001..1000")

    def eval(self, width: int, height: int, x: Numbers, y: Numbers, channel: int = 1) -> Numbers:
        """Attenuation at pixel (x, y) of a frame of width x height px, bilinear; 1 where there is no grid."""
        if channel not in (0, 1, 2):
            raise Error(Status.ERROR_ARGUMENT, f"channel {channel}: give 0, 1 or 2")
        self.validate()
        this, size = byref(self), (integer(width, "width"), integer(height, "height"))
        return each(lambda u, v: lib.lensprof_gain_grid_eval(this, *size, u, v, channel), x, y)


class Exposure(Value, _abi.Exposure):
    """Exposure and white balance of one picture; 0 EV and 1, 1, 1 by default.

    ev: log2 of the exposure factor, larger = more light recorded. white_balance: factors of red, green (1), blue.
    """

    ev: float
    white_balance = Vector()

    def validate(self) -> None:
        """Raises lensprof.Error unless |ev| <= 64 and the factors are in 1e-6..1e6."""
        check(lib.lensprof_exposure_validate(byref(self)), f"{self}: give |ev| <= 64 and factors in 1e-6..1e6")

    def factor(self, channel: int) -> float:
        """2^ev times the white balance of channel 0, 1 or 2."""
        if channel not in (0, 1, 2):
            raise Error(Status.ERROR_ARGUMENT, f"channel {channel}: give 0, 1 or 2")
        return 2.0 ** self.ev * float(self.white_balance[channel])
