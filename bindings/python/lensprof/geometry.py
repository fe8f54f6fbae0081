"""Camera projections: direction <-> image pixel, as used by Hugin and nona; see lensprof/geometry.h."""
from __future__ import annotations

from ctypes import byref

from . import _abi
from ._abi import Projection
from ._library import check, lib
from ._struct import Enumerated, Value, Vector, default
from ._types import Array, Numbers
from .model import mapped, positions


class Camera(Value, _abi.Camera):
    """Camera of one picture; by default projection RECTILINEAR and zeros. Angles in degrees, sizes of the full frame in
    px.

    hfov_deg: horizontal field of view. radial: a, b, c. shift_px: d, e. shear_px: g, t. translation: TrX, TrY, TrZ.
    plane_deg: Tpy, Tpp.
    """

    projection: Enumerated[Projection] = Enumerated(Projection)
    width: int = default
    height: int = default
    hfov_deg: float = default
    yaw_deg: float = default
    pitch_deg: float = default
    roll_deg: float = default
    radial: Vector = Vector()
    shift_px: Vector = Vector()
    shear_px: Vector = Vector()
    translation: Vector = Vector()
    plane_deg: Vector = Vector()

    def validate(self) -> None:
        """Raises lensprof.Error unless the camera can be evaluated."""
        check(lib.lensprof_camera_validate(byref(self)),
              f"{self}: cannot be evaluated; give sizes above 0, finite numbers and a field of view that the "
              "projection has")

    def project(self, longitude: Numbers, latitude: Numbers) -> Array:
        """Pixels (x, y on the last axis) of directions in radians, latitude positive down.

        NaN if the camera does not see the direction. Pixels may lie outside the frame; pixel centres are integers.
        """
        self.validate()
        return mapped(lib.lensprof_camera_project_many, self, positions(longitude, latitude))

    def unproject(self, x: Numbers, y: Numbers) -> Array:
        """Directions (longitude, latitude on the last axis, radians) of pixels; NaN for pixels without a direction."""
        self.validate()
        return mapped(lib.lensprof_camera_unproject_many, self, positions(x, y))
