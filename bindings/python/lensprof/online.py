"""Exposure, response and falloff of a camera that runs, frame by frame; see lensprof/online.h."""
from __future__ import annotations

import datetime
from ctypes import POINTER, byref, c_uint32, c_uint64
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _abi, _arrays
from ._abi import CameraKind, OnlineState
from ._library import check, initialised, lib
from ._struct import Enumerated, Flag, OptionalReference, Struct, Vector, default, integer
from .profile import Profile, ProfileKey


class OnlineOptions(Struct, _abi.OnlineOptions):
    """Options of an Online. Defaults: 1 channel, any kind of camera, 512 tracks, 12 keyframes, 6 modes.

    width, height: frame, px; must be given. channels: 1 or 3. camera_kind: CameraKind, the response to start from; LINEAR
    fixes a linear one. tracks: most observations per frame, 8..8192. keyframes: of a window, 4..24. modes: EMoR modes
    that are fitted, 0..8. history: frames whose exposures can be asked for later. center: of the falloff, half diagonals
    from the middle. black, white: grey values that are used. profile: Profile of the same camera and lens to start from,
    or None.
    """

    width: int = default
    height: int = default
    channels: int = default
    camera_kind: Enumerated[CameraKind] = Enumerated(CameraKind)
    tracks: int = default
    keyframes: int = default
    modes: int = default
    history: int = default
    center: Vector = Vector()
    black: float = default
    white: float = default
    profile: OptionalReference[Profile] = OptionalReference(Profile)


class OnlineExposure(Struct, _abi.OnlineExposure):
    """The exposure of one frame; unknown values are nan, and their standard errors inf.

    state: OnlineState. number: the frame; since: the first one of the chain, to which ev, ev_sigma and white_balance
    refer; before: the measured frame before this one, to which step_ev and step_sigma refer. tracks: that determine it;
    outliers: that contradict it; unusable: too dark or bright. keyframe: kept for the next solves.
    """

    state: Enumerated[OnlineState] = Enumerated(OnlineState)
    number: int = default
    since: int = default
    before: int = default
    ev: float = default
    ev_sigma: float = default
    step_ev: float = default
    step_sigma: float = default
    white_balance: Vector = Vector(writable=False)
    tracks: int = default
    outliers: int = default
    unusable: int = default
    keyframe: Flag = Flag()


class OnlineResult(Struct, _abi.OnlineResult):
    """What is known of a camera that runs.

    known: sum of the OnlineKnown that are certain. frames: added; lost: without an exposure; chains: of exposures;
    keyframes, observations: kept; windows: completed. gamma: exponent of the response; log_gamma_sigma: standard error of
    ln gamma, common to response, falloff and exposures. shape_sigma: of the response at a given exponent, in grey value.
    corner, corner_sigma: falloff M in the corner; falloff_sigma: standard error of ln M at a given exponent.
    noise_levels: of an observation, levels of 255. known_ev_scatter: of known exposures, in their standard errors, 0 =
    fewer than three. inlier_share: of the observations of known tracks.
    """

    known: int = default
    frames: int = default
    lost: int = default
    chains: int = default
    keyframes: int = default
    observations: int = default
    windows: int = default
    gamma: float = default
    log_gamma_sigma: float = default
    shape_sigma: float = default
    corner: float = default
    corner_sigma: float = default
    falloff_sigma: float = default
    noise_levels: float = default
    known_ev_scatter: float = default
    inlier_share: float = default


class Online:
    """A camera that runs: add() each frame, and solve() when there is time, e.g. one step per frame."""

    def __init__(self, options: OnlineOptions):
        if not isinstance(options, OnlineOptions):
            raise TypeError("an Online is made of OnlineOptions")
        self._channels = options.channels
        self._memory = np.zeros(lib.lensprof_online_bytes(byref(options)) // 8 + 1, dtype=np.uint64)
        self._online, error = POINTER(_abi.Online)(), _abi.ErrorText()
        check(lib.lensprof_online_begin(self._memory.ctypes.data, self._memory.nbytes, byref(options),
                                        byref(self._online), byref(error)), "these options cannot be used", error)

    def add(self, number: int, tracks: npt.ArrayLike, xy: npt.ArrayLike, values: npt.ArrayLike,
            weights: npt.ArrayLike = 1.0, *, known_ev: float = 0.0, known_ev_sigma: float = 0.0) -> OnlineExposure:
        """Adds a frame and returns its exposure.

        number: increases from frame to frame. tracks: (n) numbers of the tracks. xy: (n, 2) positions, px. values: (n)
        or (n, channels) grey values 0..1. weights: (n), inverse variances of the noise relative to others. known_ev,
        known_ev_sigma: exposure stated by the camera and its standard error, EV; sigma 0 = unknown.
        """
        ids = np.asarray(tracks)
        if ids.ndim != 1 or (ids.size and ids.dtype.kind not in "iu"):
            raise TypeError(f"tracks are {ids.dtype} of shape {ids.shape}; give one integer per track")
        seen = np.zeros(len(ids), dtype=_arrays.ONLINE_OBSERVATION_DTYPE)
        seen["track"] = ids
        places, grey = np.asarray(xy, dtype=np.float32), np.asarray(values, dtype=np.float32)
        shapes = [(len(ids), self._channels)] + [(len(ids),)] * (self._channels == 1)
        if places.size == 0:
            places = places.reshape(-1, 2)
        if places.shape != (len(ids), 2) or (grey.shape not in shapes and len(ids)):
            raise ValueError(f"{len(ids)} tracks, positions of shape {places.shape} and values of shape {grey.shape}: give "
                             f"(n), (n, 2) and (n, {self._channels})")
        seen["x"], seen["y"] = places[:, 0], places[:, 1]
        seen["value"][:, :self._channels] = grey.reshape(len(ids), self._channels)
        seen["weight"] = weights
        frame: Any = initialised(_abi.OnlineFrame, number=integer(number, "number", c_uint64), known_ev=known_ev,
                                 known_ev_sigma=known_ev_sigma)
        frame.observations, frame.count = _arrays.structured(seen, _arrays.ONLINE_OBSERVATION_DTYPE,
                                                             _abi.OnlineObservation, "observations")
        exposure, error = OnlineExposure(), _abi.ErrorText()
        check(lib.lensprof_online_add(self._online, byref(frame), byref(exposure), byref(error)), f"frame {number}", error)
        return exposure

    def solve(self, steps: int = 1) -> bool:
        """Takes up to `steps` steps of the fit; returns whether another one would change anything."""
        pending, error = c_uint32(), _abi.ErrorText()
        check(lib.lensprof_online_solve(self._online, integer(steps, "steps"), byref(pending), byref(error)),
              "the fit failed", error)
        return bool(pending.value)

    def exposure(self, number: int) -> OnlineExposure:
        """The exposure of an earlier frame as it is known now."""
        exposure, error = OnlineExposure(), _abi.ErrorText()
        check(lib.lensprof_online_exposure_at(self._online, integer(number, "number", c_uint64), byref(exposure),
                                              byref(error)), f"frame {number}", error)
        return exposure

    @property
    def result(self) -> OnlineResult:
        """What is known now."""
        result, error = OnlineResult(), _abi.ErrorText()
        check(lib.lensprof_online_get(self._online, byref(result), byref(error)), "no result", error)
        return result

    def profile(self, key: ProfileKey, source: str = "", created: Optional[datetime.datetime] = None) -> Profile:
        """A profile of what is known now. source: file that it was made from."""
        profile, error = Profile(key=key), _abi.ErrorText()
        check(lib.lensprof_online_profile(self._online, byref(profile), byref(error)), "no profile", error)
        profile.provenance.source, profile.provenance.created = source, created
        return profile
