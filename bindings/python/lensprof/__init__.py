"""lensprof: estimates and corrects camera response, vignetting and exposure from overlapping pictures.

A thin layer over the C library lensprof that works on the memory of NumPy arrays. If the library refuses a call, it
raises lensprof.Error with a `status`; arguments that cannot be passed to it (an array of the wrong type, shape or
stride) raise TypeError or ValueError. Files of other programs are in lensprof.formats.
"""
from . import formats
from ._abi import (CAMERAS_MAX, COVARIANCE_MAX, COVERAGE_BINS, EMOR_MODES, FIELDS_IMAGES, FLAT_IMAGES, FLAT_SPOTS, GRID_SIDE,
                   MODES_AUTO, RESPONSE_SAMPLES, SETTINGS_MAX, UNKNOWN, CameraKind, CopyExposure, DeflickerState, DeflickerTo, Direction,
                   DistanceRule, Encoding, ExposureState, FitModel, FitResponse, FlatGrid, FlatLight, Flip, Free, GammaFrom,
                   ItemKind, Layout, LinkState, Loss, Method, OnlineKnown, OnlineState, Pack, Packing, Processing, ProfilePrior, Projection, Reason,
                   ResponseFrom, ResponseKind, SampleType, Sampling, Saturated, Severity, Status, StoreMode, StoreNames,
                   TrialCorners, TrialResponse)
from ._abi import VERSION as __version__  # noqa: F401
from ._arrays import (DEFLICKER_FRAME_DTYPE, EXPOSURE_DTYPE, EXPOSURE_SETTINGS_DTYPE, FIELDS_IMAGE_DTYPE, FIELDS_SMOOTHNESS_DTYPE,
                      FLAT_QUALITY_DTYPE, FLAT_SPOT_DTYPE, IMAGE_QUALITY_DTYPE, KNOWN_EXPOSURE_DTYPE, LINK_DTYPE, MATCH_DTYPE, OBSERVATION_DTYPE, PAIR_DTYPE,
                      SCENE_LINK_DTYPE)
from ._events import Notice, Progress
from ._library import Error, status_name, version
from .apply import ApplyOptions, FixedPlan, Plan, correct, layout_channels, layout_samples, sample_type_bytes, simulate
from .calibration import EXPOSURES_DTYPE, CalibrateOptions, Calibration
from .copies import CorrectOptions, correct_file, correct_files
from .deflicker import Deflickered, DeflickerResult, deflicker
from .exposure import known_exposures, settings_ev
from .fields import FieldsChannel, FieldsOptions, FieldsResult, fit_fields
from .fit import FitCamera, FitImage, FitOptions, FitResult, fit_overlap, fit_radiance
from .flat import FlatImage, FlatOptions, FlatResult, fit_flat
from .folder import calibrate_folder
from .geometry import Camera
from .model import Exposure, GainGrid, ImageCircle, Levels, Response, Vignetting, emor_table, half_diagonal
from .online import Online, OnlineExposure, OnlineOptions, OnlineResult
from .packed import pack_rows, unpack_rows
from .pictures import Picture, PictureMetadata, encode_picture, read_picture, write_picture
from .profile import CameraModel, Profile, ProfileKey, Provenance
from .reason import Finding, Item, reason_name, reason_text
from .rendering import RenderingResult, RenderingShot, fit_rendering
from .sample import SampleImage, SampleOptions, sample_matches, sample_overlap, sample_tracks
from .scene import Scene, SceneImage, calibrate
from .sensor import Readout, SensorFlat, SensorLevels, SensorPlan, mired_share
from .store import Lookup, LookupOptions, Store, StoreFault, StoreRow, StoreStats, StoreSummary, lookup_in
from .trial import TrialCandidate, TrialResult, try_profiles

__all__ = [
    "ApplyOptions", "CAMERAS_MAX", "COVARIANCE_MAX", "COVERAGE_BINS", "CalibrateOptions", "Calibration", "Camera",
    "CameraKind", "CameraModel", "CopyExposure", "CorrectOptions", "DEFLICKER_FRAME_DTYPE", "DeflickerResult", "DeflickerState", "DeflickerTo",
    "Deflickered", "Direction", "DistanceRule", "EMOR_MODES",
    "EXPOSURES_DTYPE", "EXPOSURE_DTYPE", "EXPOSURE_SETTINGS_DTYPE", "Encoding", "Error", "Exposure", "ExposureState",
    "FIELDS_IMAGES", "FIELDS_IMAGE_DTYPE", "FIELDS_SMOOTHNESS_DTYPE",
    "FLAT_IMAGES", "FLAT_QUALITY_DTYPE", "FLAT_SPOTS", "FLAT_SPOT_DTYPE", "FieldsChannel", "FieldsOptions",
    "FieldsResult", "Finding", "FitCamera", "FitImage",
    "FitModel", "FitOptions", "FitResponse", "FitResult", "FixedPlan", "FlatGrid", "FlatImage", "FlatLight",
    "FlatOptions", "FlatResult", "Flip", "Free", "GRID_SIDE", "GainGrid", "GammaFrom", "IMAGE_QUALITY_DTYPE", "ImageCircle", "Item",
    "ItemKind", "KNOWN_EXPOSURE_DTYPE", "LINK_DTYPE", "Layout", "Levels", "LinkState", "Lookup", "LookupOptions", "Loss",
    "MATCH_DTYPE", "MODES_AUTO", "Method", "Notice", "OBSERVATION_DTYPE", "Online", "OnlineExposure", "OnlineKnown",
    "OnlineOptions", "OnlineResult", "OnlineState", "PAIR_DTYPE", "Pack", "Packing", "Picture",
    "PictureMetadata", "Plan", "Processing", "Profile", "ProfileKey", "ProfilePrior", "Progress", "Projection",
    "Provenance", "RESPONSE_SAMPLES", "Readout", "Reason", "RenderingResult", "RenderingShot", "Response", "ResponseFrom",
    "ResponseKind", "SCENE_LINK_DTYPE", "SETTINGS_MAX", "SampleImage", "SampleOptions", "SampleType", "Sampling", "Saturated", "Scene",
    "SceneImage", "SensorFlat", "SensorLevels", "SensorPlan", "Severity", "Status", "Store", "StoreFault", "StoreMode", "StoreNames", "StoreRow", "StoreStats",
    "StoreSummary", "TrialCandidate", "TrialCorners", "TrialResponse", "TrialResult", "UNKNOWN", "Vignetting",
    "calibrate", "calibrate_folder", "correct", "correct_file", "correct_files", "deflicker", "emor_table", "encode_picture", "fit_fields", "fit_flat",
    "fit_overlap", "fit_radiance", "fit_rendering", "formats", "half_diagonal", "known_exposures", "layout_channels",
    "layout_samples", "lookup_in", "mired_share", "pack_rows", "read_picture", "reason_name", "reason_text", "sample_matches", "sample_overlap",
    "sample_tracks", "sample_type_bytes", "settings_ev", "simulate", "status_name", "try_profiles", "unpack_rows", "version",
    "write_picture",
]
