"""Camera projections: direction <-> image pixel, as used by Hugin and nona; see lensprof/geometry.h."""
from __future__ import annotations

from ctypes import byref, c_double
from typing import Any

import numpy as np

from . import _abi
from ._abi import Projection
from ._library import check, lib
from ._struct import Enumerated, Value, Vector
from .model import Numbers, each

_NOWHERE = (np.nan, np.nan)


class Camera(Value, _abi.Camera):
    """Camera of one picture; by default projection RECTILINEAR and zeros. Angles in degrees, sizes of the full frame in
    px.

    hfov_deg: horizontal field of view. radial: a, b, c. shift_px: d, e. shear_px: g, t. translation: TrX, TrY, TrZ.
    plane_deg: Tpy, Tpp.
    """

    projection = Enumerated(Projection)
    width: int
    height: int
    hfov_deg: float
    yaw_deg: float
    pitch_deg: float
    roll_deg: float
    radial = Vector()
    shift_px = Vector()
    shear_px = Vector()
    translation = Vector()
    plane_deg = Vector()

    def validate(self) -> None:
        """Raises lensprof.Error unless the camera can be evaluated."""
        check(lib.lensprof_camera_validate(byref(self)),
              f"{self}: cannot be evaluated; give sizes above 0, finite numbers and a field of view that the "
              "projection has")

    def project(self, longitude: Numbers, latitude: Numbers) -> np.ndarray:
        """Pixels (x, y on the last axis) of directions in radians, latitude positive down.

        NaN if the camera does not see the direction. Pixels may lie outside the frame; pixel centres are integers.
        """
        return self._map(lib.lensprof_camera_project, longitude, latitude)

    def unproject(self, x: Numbers, y: Numbers) -> np.ndarray:
        """Directions (longitude, latitude on the last axis, radians) of pixels; NaN for pixels without a direction."""
        return self._map(lib.lensprof_camera_unproject, x, y)

    def _map(self, function: Any, first: Numbers, second: Numbers) -> np.ndarray:
        self.validate()
        this, found = byref(self), (c_double * 2)()
        return each(lambda a, b: tuple(found) if function(this, a, b, found) else _NOWHERE, first, second, columns=2)
