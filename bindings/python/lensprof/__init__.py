"""lensprof: camera response, vignetting and exposure from overlapping pictures, and their correction.

A thin layer over the C library lensprof on the memory of NumPy arrays. What the library refuses raises lensprof.Error
with a `status`; what it could not be asked (an array of a wrong type, shape or stride) raises TypeError or
ValueError.
"""
from ._abi import (COVARIANCE_MAX, COVERAGE_BINS, EMOR_MODES, FLAT_IMAGES, FLAT_SPOTS, GRID_SIDE, MODES_AUTO,
                   RESPONSE_SAMPLES, UNKNOWN, CameraKind, Direction, DistanceRule, Encoding, FlatGrid, FlatLight, Free, GammaFrom,
                   Layout, Loss, Method, Pack, Processing, ProfilePrior, Projection, ResponseKind, SampleType, Sampling, Saturated,
                   Status, StoreMode)
from ._abi import VERSION as __version__  # noqa: F401
from ._arrays import (EXPOSURE_DTYPE, FLAT_QUALITY_DTYPE, FLAT_SPOT_DTYPE, IMAGE_QUALITY_DTYPE, OBSERVATION_DTYPE,
                      PAIR_DTYPE)
from ._library import Error, status_name, version
from .apply import ApplyOptions, FixedPlan, Plan, correct, layout_channels, layout_samples, sample_bytes, simulate
from .fit import FitImage, FitOptions, FitResult, fit_overlap, fit_radiance, transfer_rms
from .flat import FlatImage, FlatOptions, FlatResult, fit_flat
from .formats import Pto, PtoImage, lensfun_read, lensfun_write, points_read, points_write
from .geometry import Camera
from .model import Exposure, GainGrid, Response, Vignetting, emor_table
from .profile import Profile, ProfileKey, Provenance
from .sample import SampleImage, SampleOptions, sample_overlap, sample_tracks
from .store import Lookup, LookupOptions, Store, StoreFault, StoreRow, StoreStats

__all__ = [
    "ApplyOptions", "COVARIANCE_MAX", "COVERAGE_BINS", "Camera", "CameraKind", "Direction", "DistanceRule",
    "EMOR_MODES", "EXPOSURE_DTYPE", "Encoding", "Error", "Exposure", "FLAT_IMAGES", "FLAT_QUALITY_DTYPE", "FLAT_SPOTS",
    "FLAT_SPOT_DTYPE", "FitImage", "FitOptions", "FitResult", "FixedPlan", "FlatGrid", "FlatImage", "FlatLight",
    "FlatOptions", "FlatResult", "Free", "GRID_SIDE", "GainGrid", "GammaFrom", "IMAGE_QUALITY_DTYPE", "Layout",
    "Lookup", "LookupOptions", "Loss", "MODES_AUTO", "Method", "OBSERVATION_DTYPE", "PAIR_DTYPE", "Pack", "Plan",
    "Processing", "Profile", "ProfileKey", "ProfilePrior", "Projection", "Provenance", "Pto", "PtoImage", "RESPONSE_SAMPLES",
    "Response", "ResponseKind", "SampleImage", "SampleOptions", "SampleType", "Sampling", "Saturated", "Status",
    "Store", "StoreFault", "StoreMode", "StoreRow", "StoreStats", "UNKNOWN", "Vignetting", "correct", "emor_table", "fit_flat", "fit_overlap",
    "fit_radiance", "layout_channels", "layout_samples", "lensfun_read", "lensfun_write", "points_read",
    "points_write", "sample_bytes", "sample_overlap", "sample_tracks", "simulate", "status_name", "transfer_rms",
    "version",
]
