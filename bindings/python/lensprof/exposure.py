"""Exposures of pictures by the settings of their camera; see lensprof/exposure_settings.h."""
from __future__ import annotations

from ctypes import byref

import numpy as np

from . import _abi, _arrays
from ._library import check, lib
from ._types import Records


def settings_ev(time_s: float, f_number: float, iso: float) -> float:
    """log2(time_s iso / (100 f_number^2)): 0 for 1 s, f/1, ISO 100."""
    return float(lib.lensprof_settings_ev(time_s, f_number, iso))


def known_exposures(settings: Records) -> Records:
    """The exposures (KNOWN_EXPOSURE_DTYPE) of pictures with these settings (EXPOSURE_SETTINGS_DTYPE), as EXIF rounds
    them; UNKNOWN = not stated. `ev` and `sigma` are for FitImage.known_ev and known_ev_sigma; `state`: ExposureState. A
    value that no picture of a camera (ISO) or of a lens (aperture) states cancels. Pictures of one lens at one manual
    exposure have a smaller error than others."""
    given, count = _arrays.structured(settings, _arrays.EXPOSURE_SETTINGS_DTYPE, _abi.ExposureSettings, "settings")
    error, known = _abi.ErrorText(), np.zeros(count, dtype=_arrays.KNOWN_EXPOSURE_DTYPE)
    check(lib.lensprof_known_exposures(given, count, _arrays.address(known, _abi.KnownExposure), byref(error)),
          "the settings are invalid", error)
    return known
