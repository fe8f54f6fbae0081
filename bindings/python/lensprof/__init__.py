"""lensprof: estimates and corrects camera response, vignetting and exposure from overlapping pictures.

A thin layer over the C library lensprof that works on the memory of NumPy arrays. If the library refuses a call, it
raises lensprof.Error with a `status`; arguments that cannot be passed to it (an array of the wrong type, shape or
stride) raise TypeError or ValueError.
"""
from ._abi import (CAMERAS_MAX, COVARIANCE_MAX, COVERAGE_BINS, EMOR_MODES, FLAT_IMAGES, FLAT_SPOTS, GRID_SIDE, MODES_AUTO,
                   RESPONSE_SAMPLES, SETTINGS_MAX, UNKNOWN, CameraKind, CopyExposure, CurveKind, Direction, DistanceRule, DngForm, Encoding,
                   FitModel, FitResponse, FlatGrid, FlatLight, Format, Free, GammaFrom, Holds, ItemKind, Layout, LinkState,
                   Loss, MapSense, Method, Pack, Processing, ProfilePrior, Projection, Reason, ResponseFrom, ResponseKind,
                   SampleType, Sampling, Saturated, Severity, Status, StoreMode, StoreNames)
from ._abi import VERSION as __version__  # noqa: F401
from ._arrays import (EXPOSURE_DTYPE, FLAT_QUALITY_DTYPE, FLAT_SPOT_DTYPE, IMAGE_QUALITY_DTYPE, LINK_DTYPE,
                      MATCH_DTYPE, OBSERVATION_DTYPE, PAIR_DTYPE)
from ._library import Error, status_name, version
from .apply import ApplyOptions, FixedPlan, Plan, correct, layout_channels, layout_samples, sample_type_bytes, simulate
from .fit import FitCamera, FitImage, FitOptions, FitResult, fit_overlap, fit_radiance
from .flat import FlatImage, FlatOptions, FlatResult, fit_flat
from .formats import (FormatInfo, Pto, PtoImage, detect_format, export_profiles, format_info, import_profiles,
                      lensfun_read_cameras, map_read, map_write, points_read, points_write)
from .geometry import Camera
from .model import Exposure, GainGrid, Response, Vignetting, emor_table, half_diagonal
from .photo import (EXPOSURES_DTYPE, Calibration, CalibrateOptions, Notice, Picture, PictureMetadata, Scene,
                    SceneImage, calibrate, calibrate_folder, correct_file, correct_files, encode_picture, read_picture, write_picture)
from .profile import CameraModel, Profile, ProfileKey, Provenance
from .reason import Finding, Item, reason_name, reason_text
from .rendering import RenderingResult, RenderingShot, fit_rendering
from .sample import SampleImage, SampleOptions, sample_matches, sample_overlap, sample_tracks
from .store import Lookup, LookupOptions, Store, StoreFault, StoreRow, StoreStats, StoreSummary, lookup_in

__all__ = [
    "ApplyOptions", "CAMERAS_MAX", "COVARIANCE_MAX", "COVERAGE_BINS", "CalibrateOptions", "Calibration", "Camera",
    "CameraKind", "CameraModel", "CopyExposure",
    "CurveKind", "Direction", "DistanceRule", "DngForm", "EMOR_MODES", "EXPOSURES_DTYPE", "EXPOSURE_DTYPE", "Encoding", "Error",
    "Exposure", "FLAT_IMAGES", "FLAT_QUALITY_DTYPE", "FLAT_SPOTS", "FLAT_SPOT_DTYPE", "Finding", "FitCamera", "FitImage",
    "FitModel", "FitOptions", "FitResponse", "FitResult", "FixedPlan", "FlatGrid", "FlatImage",
    "FlatLight", "FlatOptions", "FlatResult", "Format", "FormatInfo", "Free", "GRID_SIDE", "GainGrid", "GammaFrom",
    "Holds", "IMAGE_QUALITY_DTYPE", "Item", "ItemKind", "LINK_DTYPE", "Layout", "LinkState", "Lookup", "LookupOptions",
    "Loss", "MATCH_DTYPE", "MODES_AUTO", "MapSense", "Method", "Notice", "OBSERVATION_DTYPE", "PAIR_DTYPE", "Pack", "Picture", "PictureMetadata",
    "Plan",
    "Processing", "Profile", "ProfileKey", "ProfilePrior", "Projection", "Provenance", "Pto", "PtoImage",
    "RESPONSE_SAMPLES", "Reason", "RenderingResult", "RenderingShot", "Response", "ResponseFrom", "ResponseKind", "SETTINGS_MAX", "SampleImage",
    "SampleOptions", "SampleType", "Sampling", "Saturated", "Scene", "SceneImage", "Severity", "Status", "Store", "StoreFault", "StoreMode", "StoreNames",
    "StoreRow", "StoreStats", "StoreSummary", "UNKNOWN", "Vignetting", "calibrate", "calibrate_folder", "correct", "correct_file",
    "correct_files", "detect_format", "emor_table", "encode_picture",
    "export_profiles", "fit_flat", "fit_overlap", "fit_radiance", "fit_rendering", "format_info", "half_diagonal", "import_profiles",
    "layout_channels", "layout_samples", "lensfun_read_cameras", "lookup_in", "map_read", "map_write", "points_read",
    "points_write", "read_picture", "reason_name", "reason_text", "sample_matches", "sample_overlap", "sample_tracks",
    "sample_type_bytes", "simulate", "status_name", "version", "write_picture",
]
