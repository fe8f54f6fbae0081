"""Which of several profiles fits given pictures; see lensprof/trial.h."""
from __future__ import annotations

from ctypes import byref
from typing import Iterable, Sequence

from . import _abi, _arrays
from ._abi import CameraKind, TrialCorners, TrialResponse
from ._library import check, initialised, lib
from ._struct import Enumerated, Flag, Struct, Vector, default, integer
from ._types import Records
from .fit import FitImage
from .profile import Profile, profile_pointers


class TrialCandidate(Struct, _abi.TrialCandidate):
    """How well one profile, or no falloff, explains pairs of which exposures are not fitted; levels are of 255.

    has_falloff: a polynomial or a gain grid. response_from: a TrialResponse; response_profile: for OTHER, the index of
    the profile. as_good_as_best: its RMS is not clearly above that of the best profile. better_than_none: it is clearly
    below that without falloff. heldout_rms, heldout_median: residuals. above_best, below_none: differences of RMS;
    above_best_sigma, below_none_sigma: their standard errors. corners: a TrialCorners. rings: that the pictures show,
    from the middle on; ring_ev, ring_sigma_ev: brightness left in each, EV relative to the first, and its standard
    error.
    """

    has_falloff: Flag = Flag()
    response_from: Enumerated[TrialResponse] = Enumerated(TrialResponse)
    response_profile: int = default
    as_good_as_best: Flag = Flag()
    better_than_none: Flag = Flag()
    heldout_rms: float = default
    heldout_median: float = default
    above_best: float = default
    above_best_sigma: float = default
    below_none: float = default
    below_none_sigma: float = default
    corners: Enumerated[TrialCorners] = Enumerated(TrialCorners)
    rings: int = default
    ring_ev: Vector = Vector(writable=False)
    ring_sigma_ev: Vector = Vector(writable=False)


class TrialResult(Struct, _abi.TrialResult):
    """Which profile fits best.

    usable: a profile is better than none. best: index of the one with the smallest RMS; decided: all others are clearly
    worse. images: with pairs. fitted, measured: pairs that determine exposures, and pairs that count; unexplained: pairs
    that no candidate explains. before_rms: of the pictures as they are, levels of 255. ring_end: largest r of each ring,
    half diagonals. candidates: tuple of TrialCandidate, one per profile, in their order; none: the one without falloff.
    """

    usable: Flag = Flag()
    best: int = default
    decided: Flag = Flag()
    images: int = default
    fitted: int = default
    measured: int = default
    unexplained: int = default
    before_rms: float = default
    ring_end: Vector = Vector(writable=False)
    _candidates: tuple[TrialCandidate, ...] = ()
    _none: TrialCandidate

    @property
    def candidates(self) -> tuple[TrialCandidate, ...]:
        return self._candidates

    @property
    def none(self) -> TrialCandidate:
        return self._none


def try_profiles(images: Sequence[FitImage], pairs: Records, profiles: Iterable[Profile], *, channels: int = 3,
                 camera_kind: CameraKind = CameraKind.ANY) -> TrialResult:
    """Compares profiles on pairs (PAIR_DTYPE) of images of one camera at one lens setting, as `lensprof profile check
    --against`. camera_kind: LINEAR = the pictures are sensor data. Also returns if no profile fits: see `usable`."""
    given, count = profile_pointers(profiles)
    error, result = _abi.ErrorText(), TrialResult()
    options = initialised(_abi.TrialOptions, channels=integer(channels, "channels"),
                          camera_kind=CameraKind(camera_kind))
    found = [TrialCandidate() for _ in range(count + 1)]
    array = (_abi.TrialCandidate * len(found))(*found)
    check(lib.lensprof_trial_run(
        byref(options), (_abi.FitImage * len(images))(*images), len(images), *_arrays.pairs(pairs),
        given, count, array, byref(result), byref(error)), "the trial failed", error)
    measured = [TrialCandidate.from_buffer_copy(candidate) for candidate in array]
    result._candidates, result._none = tuple(measured[:-1]), measured[-1]
    return result
