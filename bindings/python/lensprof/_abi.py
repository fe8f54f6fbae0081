"""The C interface as tables: structures, enumerations, constants and functions of lensprof's public headers.

Nothing else in the package knows a layout or a number of the C library. tests/python/test_abi.py compares all of it
with the C compiler's view and with the headers. Raw structures have the same field names as in C; what users see are
subclasses of them in the modules by topic.
"""
from __future__ import annotations

from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_int64,
                    c_size_t, c_ssize_t, c_uint8, c_uint32, c_void_p)
from enum import IntEnum, IntFlag

VERSION = "0.1.0"  # of the headers that these tables were written from

RESPONSE_SAMPLES = 1024
EMOR_MODES = 25
GRID_SIDE = 32
COVARIANCE_MAX = 36
LOOKUP_ROWS = 24
STATS_GROUPS = 8
COVERAGE_BINS = 10
FLAT_IMAGES = 128
FLAT_SPOTS = 32
UNKNOWN = -1.0
MODES_AUTO = 0xFFFFFFFF


# ---- enumerations ------------------------------------------------------------------------------------------------

class Status(IntEnum):
    """What a call came to; see lensprof/base.h."""
    OK = 0
    ERROR_ARGUMENT = 1
    ERROR_STRUCT_SIZE = 2
    ERROR_SIZE = 3
    ERROR_CAPACITY = 4
    ERROR_NOT_FINITE = 5
    ERROR_MEMORY = 10
    ERROR_CANCELLED = 11
    ERROR_RESPONSE = 20
    ERROR_VIGNETTING = 21
    ERROR_EXPOSURE = 22
    ERROR_GEOMETRY = 23
    ERROR_NO_OVERLAP = 30
    ERROR_NO_SAMPLES = 31
    ERROR_NO_UNKNOWNS = 32
    ERROR_STORE = 40
    ERROR_NOT_FOUND = 41
    ERROR_CORRUPT = 42
    ERROR_LAYOUT = 43
    ERROR_READ_ONLY = 44
    ERROR_FULL = 45
    ERROR_BUSY = 46
    ERROR_SYNTAX = 50
    ERROR_VARIABLE = 51
    ERROR_UNSUPPORTED = 52
    ERROR_INTERNAL = 90


class ResponseKind(IntEnum):
    """How a response curve is given."""
    LINEAR = 0
    GAMMA = 1
    EMOR = 2
    TABLE = 3


class Projection(IntEnum):
    """Lens projections, numbered as the `f` parameter of a Hugin project."""
    RECTILINEAR = 0
    CYLINDRICAL = 1
    CIRCULAR_FISHEYE = 2
    FULLFRAME_FISHEYE = 3
    EQUIRECTANGULAR = 4
    ORTHOGRAPHIC = 8
    STEREOGRAPHIC = 10
    THOBY = 20
    EQUISOLID = 21


class SampleType(IntEnum):
    """Type of a sample: uint8 (0..255 = 0..1), uint16 (0..65535 = 0..1), float32 or float16 (0..1)."""
    U8 = 0
    U16 = 1
    F32 = 2
    F16 = 3


class Layout(IntEnum):
    """Order of the samples of a pixel."""
    GREY = 0
    GREY_ALPHA = 1
    RGB = 2
    RGBA = 3
    BGR = 4
    BGRA = 5
    PLANAR = 6
    RGGB = 7
    GRBG = 8
    GBRG = 9
    BGGR = 10


class Direction(IntEnum):
    """Undo what the camera did to the light, or do it."""
    CORRECT = 0
    SIMULATE = 1


class Encoding(IntEnum):
    """Grey values encoded by the response, or irradiance."""
    RESPONSE = 0
    LINEAR = 1


class Saturated(IntEnum):
    """What happens to a pixel that is nearly saturated: towards white one gain for all channels, or nothing special."""
    NEUTRAL = 0
    AS_VALUE = 1


class Processing(IntEnum):
    """Linear sensor data, the camera's own rendering, or that with the falloff corrected in camera."""
    RAW = 0
    JPEG = 1
    CORRECTED = 2


class Pack(IntFlag):
    """What a blob holds beside what a camera needs."""
    COVARIANCE = 1


class DngForm(IntEnum):
    """Opcode of DNG that a falloff is written as: FixVignetteRadial or GainMap."""
    RADIAL = 0
    GAIN_MAP = 1


class Sampling(IntEnum):
    """Balanced over image pairs, radius and grey level; or as in d'Angelo 2007, section 5.1."""
    BALANCED = 0
    PAPER = 1
    BRACKET = 2


class Free(IntFlag):
    """What is unknown: RESPONSE to CENTER belong to FitOptions.free, EV, RED and BLUE to FitImage.free."""
    RESPONSE = 0x01
    K1 = 0x02
    K2 = 0x04
    K3 = 0x08
    CENTER = 0x10
    EV = 0x20
    RED = 0x40
    BLUE = 0x80


class Method(IntEnum):
    """d'Angelo 2007, Goldman & Chen 2005, Kim & Pollefeys 2004, Debevec & Malik 1997."""
    TRANSFER = 0
    RADIANCE = 1
    TRANSFER_FUNCTION = 2
    DEBEVEC = 3


class Loss(IntEnum):
    """Noise-weighted and redescending; the paper's equation 11; or least squares."""
    ROBUST = 0
    HUBER = 1
    SQUARED = 2


class GammaFrom(IntEnum):
    """What settles the exponent that pictures leave open; KNOWN, NONE and PROFILE in results only."""
    AUTO = 0
    PRIOR = 1
    EXPOSURES = 2
    KNOWN = 3
    NONE = 4
    PROFILE = 5


class ProfilePrior(IntEnum):
    """What became of a profile that was given as the prior."""
    NONE = 0
    USED = 1
    OVERRULED = 2


class CameraKind(IntEnum):
    """The measured responses behind the prior."""
    ANY = 0
    FILM = 1
    DIGITAL = 2


class FlatLight(IntEnum):
    """How the light on a card may change over the scene."""
    AUTO = 0
    EVEN = 1
    PLANE = 2
    QUADRATIC = 3


class FlatGrid(IntEnum):
    """When a flat field fit adds a gain grid: where it is needed, never, always."""
    AUTO = 0
    NONE = 1
    ALWAYS = 2


class StoreMode(IntEnum):
    """Read an existing file; write to an existing file; write, and make the file when there is none."""
    READ = 0
    WRITE = 1
    CREATE = 2


class DistanceRule(IntEnum):
    """What stands for an unknown focus distance: the weakest falloff of all stored distances, or that of the farthest."""
    WEAKEST = 0
    FARTHEST = 1


class CurveKind(IntEnum):
    """What a table of a response holds: grey value to irradiance, to a logarithm of it, or irradiance to grey value."""
    INVERSE = 0
    LOG = 1
    LOG10 = 2
    FORWARD = 3


class MapSense(IntEnum):
    """A picture is corrected by division by a map, or by multiplication."""
    ATTENUATION = 0
    GAIN = 1


# Prefix of the names in C; a member's C name is prefix + name.
ENUMS = {
    "LENSPROF_": Status,
    "LENSPROF_RESPONSE_": ResponseKind,
    "LENSPROF_PROJECTION_": Projection,
    "LENSPROF_SAMPLE_": SampleType,
    "LENSPROF_LAYOUT_": Layout,
    "LENSPROF_DIRECTION_": Direction,
    "LENSPROF_ENCODING_": Encoding,
    "LENSPROF_SATURATED_": Saturated,
    "LENSPROF_PROCESSING_": Processing,
    "LENSPROF_PACK_": Pack,
    "LENSPROF_DNG_": DngForm,
    "LENSPROF_SAMPLING_": Sampling,
    "LENSPROF_FREE_": Free,
    "LENSPROF_METHOD_": Method,
    "LENSPROF_LOSS_": Loss,
    "LENSPROF_GAMMA_": GammaFrom,
    "LENSPROF_PROFILE_PRIOR_": ProfilePrior,
    "LENSPROF_CAMERA_": CameraKind,
    "LENSPROF_FLAT_LIGHT_": FlatLight,
    "LENSPROF_FLAT_GRID_": FlatGrid,
    "LENSPROF_STORE_": StoreMode,
    "LENSPROF_DISTANCE_": DistanceRule,
    "LENSPROF_CURVE_": CurveKind,
    "LENSPROF_MAP_": MapSense,
}


# ---- structures --------------------------------------------------------------------------------------------------

class ErrorText(Structure):
    _fields_ = [("text", c_char * 256)]


class Response(Structure):
    _fields_ = [("kind", c_uint32), ("modes", c_uint32), ("gamma", c_double), ("emor", c_double * EMOR_MODES),
                ("table", c_double * RESPONSE_SAMPLES)]


class Vignetting(Structure):
    _fields_ = [("k", c_double * 3), ("center", c_double * 2)]


class GainGrid(Structure):
    _fields_ = [("columns", c_uint32), ("rows", c_uint32), ("channels", c_uint32), ("reserved", c_uint32),
                ("attenuation", c_float * (3 * GRID_SIDE * GRID_SIDE))]


class Exposure(Structure):
    _fields_ = [("ev", c_double), ("white_balance", c_double * 3)]


class Camera(Structure):
    _fields_ = [("projection", c_uint32), ("width", c_uint32), ("height", c_uint32), ("hfov_deg", c_double),
                ("yaw_deg", c_double), ("pitch_deg", c_double), ("roll_deg", c_double), ("radial", c_double * 3),
                ("shift_px", c_double * 2), ("shear_px", c_double * 2), ("translation", c_double * 3),
                ("plane_deg", c_double * 2)]


class Image(Structure):
    _fields_ = [("data", c_void_p), ("row_bytes", c_ssize_t), ("width", c_uint32), ("height", c_uint32),
                ("sample", c_uint32), ("layout", c_uint32)]


class ApplyOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("direction", c_uint32), ("input", c_uint32), ("output", c_uint32),
                ("frame_width", c_uint32), ("frame_height", c_uint32), ("source_sample", c_uint32),
                ("source_layout", c_uint32), ("target_sample", c_uint32), ("saturated", c_uint32),
                ("responses", c_uint32), ("vignettings", c_uint32), ("response", POINTER(Response)),
                ("vignetting", POINTER(Vignetting)), ("source", Exposure), ("target", Exposure),
                ("grid", POINTER(GainGrid)), ("strength", c_double), ("gain_cap", c_double), ("dither", c_uint32),
                ("reserved", c_uint32), ("blob", c_void_p), ("blob_bytes", c_size_t)]


class Plan(Structure):
    """Opaque."""


class FixedPlan(Structure):
    """Opaque."""


class ProfileKey(Structure):
    _fields_ = [("camera_maker", c_char * 64), ("camera_model", c_char * 64), ("lens", c_char * 128),
                ("unit", c_char * 64), ("crop_factor", c_double), ("focal_mm", c_double),
                ("aperture", c_double), ("distance_m", c_double), ("processing", c_uint32),
                ("reserved", c_uint32)]


class Provenance(Structure):
    _fields_ = [("method", c_char * 32), ("software", c_char * 32), ("source", c_char * 256),
                ("created_unix_s", c_int64), ("images", c_uint32), ("pairs", c_uint32), ("heldout_rms", c_double),
                ("inlier_share", c_double), ("doubt", c_char * 64)]


class Profile(Structure):
    _fields_ = [("key", ProfileKey), ("provenance", Provenance), ("responses", c_uint32), ("vignettings", c_uint32),
                ("response", Response * 3), ("vignetting", Vignetting * 3), ("grid", GainGrid),
                ("covariance_size", c_uint32), ("reserved", c_uint32),
                ("covariance", c_double * (COVARIANCE_MAX * COVARIANCE_MAX))]


class ImportEntry(Structure):
    _fields_ = [("profile", POINTER(Profile)), ("usable", c_uint32), ("reserved", c_uint32)]


ImportVisitor = CFUNCTYPE(c_int, c_void_p, POINTER(ImportEntry))


class Pair(Structure):
    _fields_ = [("image", c_uint32 * 2), ("xy", c_double * 2 * 2), ("value", c_double * 3 * 2)]


class Observation(Structure):
    _fields_ = [("point", c_uint32), ("image", c_uint32), ("xy", c_double * 2), ("value", c_double * 3)]


class SampleImage(Structure):
    _fields_ = [("view", Image), ("camera", Camera), ("reduction", c_uint32), ("every_pixel", c_uint32),
                ("mask", POINTER(c_uint8)), ("mask_row_bytes", c_ssize_t), ("black", c_double), ("white", c_double)]


Progress = CFUNCTYPE(c_int, c_double, c_void_p)


class SampleOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("sampling", c_uint32), ("pairs", c_uint32), ("seed", c_uint32),
                ("threads", c_uint32), ("reserved", c_uint32), ("progress", Progress), ("progress_user", c_void_p)]


class FitImage(Structure):
    _fields_ = [("width", c_uint32), ("height", c_uint32), ("exposure", Exposure), ("free", c_uint32),
                ("ev_of", c_uint32), ("red_of", c_uint32), ("blue_of", c_uint32), ("known_ev", c_double),
                ("known_ev_sigma", c_double)]


class FitOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("channels", c_uint32), ("reference", c_uint32), ("free", c_uint32),
                ("modes", c_uint32), ("loss", c_uint32), ("huber_levels", c_double), ("prior_weight", c_double),
                ("max_iterations", c_uint32), ("vignettings", c_uint32), ("gamma_from", c_uint32),
                ("camera_kind", c_uint32), ("threads", c_uint32), ("method", c_uint32), ("refine", c_uint32),
                ("reserved", c_uint32), ("profile", POINTER(Profile)), ("response", POINTER(Response)),
                ("vignetting", Vignetting),
                ("progress", Progress), ("progress_user", c_void_p)]


class FitImageQuality(Structure):
    _fields_ = [("ev_sigma", c_double), ("white_balance_sigma", c_double * 3), ("median_residual", c_double),
                ("known_ev_residual", c_double), ("radius", c_double), ("grey_low", c_double),
                ("grey_high", c_double), ("pairs", c_uint32), ("inliers", c_uint32), ("component", c_uint32),
                ("reserved", c_uint32)]


class FitResult(Structure):
    _fields_ = [("struct_size", c_uint32), ("usable", c_uint32), ("reason", c_char * 256), ("response", Response),
                ("vignetting", Vignetting * 3), ("vignettings", c_uint32), ("pairs", c_uint32),
                ("components", c_uint32), ("iterations", c_uint32), ("converged", c_uint32), ("gamma_from", c_uint32),
                ("gamma_sigma", c_double), ("before_rms", c_double), ("heldout_rms", c_double),
                ("heldout_median", c_double), ("noise_levels", c_double), ("inlier_share", c_double),
                ("frame_share", c_double), ("image_share", c_double), ("seconds", c_double), ("radius_ends", c_uint32 * COVERAGE_BINS),
                ("grey_ends", c_uint32 * COVERAGE_BINS), ("covariance_size", c_uint32), ("profile_prior", c_uint32),
                ("covariance", c_double * (COVARIANCE_MAX * COVARIANCE_MAX)),
                ("gamma_direction", c_double * COVARIANCE_MAX), ("image_quality", POINTER(FitImageQuality))]


class FlatImage(Structure):
    _fields_ = [("view", Image), ("width", c_uint32), ("height", c_uint32), ("reduction", c_uint32),
                ("shot", c_uint32), ("mask", POINTER(c_uint8)), ("mask_row_bytes", c_ssize_t), ("black", c_double),
                ("white", c_double), ("ev", c_double), ("turn_deg", c_double)]


class FlatOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("channels", c_uint32), ("free", c_uint32), ("vignettings", c_uint32),
                ("light", c_uint32), ("own_light", c_uint32), ("several", c_uint32), ("find_card", c_uint32),
                ("grid", c_uint32), ("responses", c_uint32), ("threads", c_uint32), ("reserved", c_uint32),
                ("ev_sigma", c_double), ("prior_weight", c_double), ("response", POINTER(Response)),
                ("vignetting", Vignetting), ("progress", Progress), ("progress_user", c_void_p)]


class FlatImageQuality(Structure):
    _fields_ = [("white_share", c_double), ("black_share", c_double), ("noise_levels", c_double),
                ("ev_residual", c_double), ("residual", c_double), ("gradient", c_double * 2), ("radius", c_double),
                ("card", c_uint32 * 4), ("cells", c_uint32), ("reserved", c_uint32)]


class FlatSpot(Structure):
    _fields_ = [("x", c_double), ("y", c_double), ("radius", c_double), ("depth", c_double), ("shots", c_uint32),
                ("reserved", c_uint32)]


class FlatResult(Structure):
    _fields_ = [("struct_size", c_uint32), ("usable", c_uint32), ("reason", c_char * 256),
                ("vignetting", Vignetting * 3), ("vignettings", c_uint32), ("light", c_uint32), ("shots", c_uint32),
                ("cells", c_uint32), ("separated", c_uint32), ("iterations", c_uint32), ("converged", c_uint32),
                ("spots", c_uint32), ("spot", FlatSpot * FLAT_SPOTS), ("radius", c_double), ("noise", c_double),
                ("residual", c_double), ("texture", c_double), ("frame_residual", c_double),
                ("shot_residual", c_double), ("inlier_share", c_double), ("corner_sigma", c_double),
                ("grid_residual", c_double), ("covariance_size", c_uint32), ("reserved", c_uint32),
                ("covariance", c_double * (COVARIANCE_MAX * COVARIANCE_MAX)), ("gain_grid", GainGrid),
                ("image_quality", POINTER(FlatImageQuality))]


class Pto(Structure):
    """Opaque."""


class PtoImage(Structure):
    _fields_ = [("camera", Camera), ("exposure", Exposure), ("vignetting", Vignetting), ("emor", c_double * 5),
                ("response_type", c_uint32), ("free", c_uint32), ("response_of", c_uint32),
                ("vignetting_of", c_uint32), ("center_of", c_uint32), ("ev_of", c_uint32), ("red_of", c_uint32),
                ("blue_of", c_uint32), ("crop", c_int32 * 4), ("crop_circular", c_uint32), ("reserved", c_uint32)]


class FrameTime(Structure):
    _fields_ = [("id", c_char * 64), ("time_s", c_double), ("exposure_ms", c_double)]


class Map(Structure):
    _fields_ = [("columns", c_uint32), ("rows", c_uint32), ("channels", c_uint32), ("sense", c_uint32),
                ("values", POINTER(c_float))]


class Store(Structure):
    """Opaque."""


class StoreRow(Structure):
    _fields_ = [("id", c_int64), ("key", ProfileKey), ("provenance", Provenance)]


class StoreFault(Structure):
    _fields_ = [("id", c_int64), ("reason", c_char * 256)]


FaultVisitor = CFUNCTYPE(c_int, c_void_p, POINTER(StoreFault))


class StoreGroup(Structure):
    _fields_ = [("name", c_char * 256), ("profiles", c_uint32), ("reserved", c_uint32)]


class StoreStats(Structure):
    _fields_ = [("profiles", c_uint32), ("cameras", c_uint32), ("lenses", c_uint32), ("units", c_uint32),
                ("processing", c_uint32 * 3), ("with_covariance", c_uint32), ("with_grid", c_uint32),
                ("with_doubt", c_uint32), ("methods", c_uint32), ("sources", c_uint32), ("focal_mm", c_double * 2),
                ("aperture", c_double * 2), ("distance_m", c_double * 2), ("method", StoreGroup * STATS_GROUPS),
                ("source", StoreGroup * STATS_GROUPS), ("bytes", c_int64), ("layout", c_uint32),
                ("reserved", c_uint32)]


class LookupOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("distance_rule", c_uint32), ("with_doubt", c_uint32),
                ("any_processing", c_uint32)]


class Lookup(Structure):
    _fields_ = [("exact", c_uint32), ("rows", c_uint32), ("id", c_int64 * LOOKUP_ROWS),
                ("weight", c_double * LOOKUP_ROWS), ("distance", c_double), ("sigma", c_double),
                ("name_score", c_double), ("reason", c_char * 256)]


STRUCTS = {
    "lensprof_error": ErrorText,
    "lensprof_response": Response,
    "lensprof_vignetting": Vignetting,
    "lensprof_gain_grid": GainGrid,
    "lensprof_exposure": Exposure,
    "lensprof_camera": Camera,
    "lensprof_image": Image,
    "lensprof_apply_options": ApplyOptions,
    "lensprof_profile_key": ProfileKey,
    "lensprof_provenance": Provenance,
    "lensprof_profile": Profile,
    "lensprof_import_entry": ImportEntry,
    "lensprof_pair": Pair,
    "lensprof_observation": Observation,
    "lensprof_sample_image": SampleImage,
    "lensprof_sample_options": SampleOptions,
    "lensprof_fit_image": FitImage,
    "lensprof_fit_options": FitOptions,
    "lensprof_fit_image_quality": FitImageQuality,
    "lensprof_fit_result": FitResult,
    "lensprof_flat_image": FlatImage,
    "lensprof_flat_options": FlatOptions,
    "lensprof_flat_image_quality": FlatImageQuality,
    "lensprof_flat_spot": FlatSpot,
    "lensprof_flat_result": FlatResult,
    "lensprof_pto_image": PtoImage,
    "lensprof_frame_time": FrameTime,
    "lensprof_map": Map,
    "lensprof_store_row": StoreRow,
    "lensprof_store_fault": StoreFault,
    "lensprof_store_group": StoreGroup,
    "lensprof_store_stats": StoreStats,
    "lensprof_lookup_options": LookupOptions,
    "lensprof_lookup": Lookup,
}

OPAQUE = {"lensprof_fixed_plan": FixedPlan, "lensprof_plan": Plan, "lensprof_pto": Pto, "lensprof_store": Store}


# ---- functions ---------------------------------------------------------------------------------------------------

_status = c_int
_doubles = POINTER(c_double)
_u32_out = POINTER(c_uint32)
_size_out = POINTER(c_size_t)
_error = POINTER(ErrorText)
_response = POINTER(Response)
_vignetting = POINTER(Vignetting)
_gain_grid = POINTER(GainGrid)
_exposures = POINTER(Exposure)
_camera = POINTER(Camera)
_image = POINTER(Image)
_key = POINTER(ProfileKey)
_profile = POINTER(Profile)
_pairs = POINTER(Pair)
_observations = POINTER(Observation)
_fit_images = POINTER(FitImage)
_plan = POINTER(Plan)
_fixed_plan = POINTER(FixedPlan)
_pto = POINTER(Pto)
_store = POINTER(Store)

# name: (restype, argtypes)
FUNCTIONS = {
    # base.h
    "lensprof_status_name": (c_char_p, [_status]),
    "lensprof_version": (c_char_p, []),
    # model.h
    "lensprof_response_set_linear": (None, [_response]),
    "lensprof_response_set_gamma": (_status, [_response, c_double]),
    "lensprof_response_set_emor": (_status, [_response, _doubles, c_uint32]),
    "lensprof_response_set_table": (_status, [_response, _doubles, c_uint32]),
    "lensprof_response_validate": (_status, [_response]),
    "lensprof_response_eval": (c_double, [_response, c_double, _doubles]),
    "lensprof_response_invert": (c_double, [_response, c_double, _doubles]),
    "lensprof_emor_table": (_doubles, [c_uint32]),
    "lensprof_vignetting_eval": (c_double, [_vignetting, c_double, _doubles]),
    "lensprof_vignetting_r2": (c_double, [_vignetting, c_uint32, c_uint32, c_double, c_double, _doubles]),
    "lensprof_vignetting_validate": (_status, [_vignetting]),
    "lensprof_gain_grid_init": (None, [_gain_grid]),
    "lensprof_gain_grid_validate": (_status, [_gain_grid]),
    "lensprof_gain_grid_eval": (c_double, [_gain_grid, c_uint32, c_uint32, c_double, c_double, c_uint32]),
    "lensprof_exposure_init": (None, [_exposures]),
    "lensprof_exposure_factor": (c_double, [_exposures, c_uint32]),
    "lensprof_exposure_validate": (_status, [_exposures]),
    # geometry.h
    "lensprof_camera_validate": (_status, [_camera]),
    "lensprof_camera_project": (c_int, [_camera, c_double, c_double, _doubles]),
    "lensprof_camera_unproject": (c_int, [_camera, c_double, c_double, _doubles]),
    # apply.h
    "lensprof_layout_samples": (c_uint32, [c_uint32]),
    "lensprof_layout_channels": (c_uint32, [c_uint32]),
    "lensprof_sample_bytes": (c_uint32, [c_uint32]),
    "lensprof_image_validate": (_status, [_image]),
    "lensprof_apply_options_init": (None, [POINTER(ApplyOptions)]),
    "lensprof_plan_bytes": (c_size_t, [POINTER(ApplyOptions)]),
    "lensprof_plan_init": (_status, [c_void_p, c_size_t, POINTER(ApplyOptions), POINTER(_plan)]),
    "lensprof_apply": (_status, [_plan, _image, _image, c_uint32, c_uint32]),
    "lensprof_apply_planar": (_status, [_plan, _image, _image, c_uint32, c_uint32]),
    # fixed.h
    "lensprof_fixed_plan_bytes": (c_size_t, [POINTER(ApplyOptions)]),
    "lensprof_fixed_plan_init": (_status, [c_void_p, c_size_t, POINTER(ApplyOptions), POINTER(_fixed_plan)]),
    "lensprof_fixed_plan_open": (_status, [c_void_p, c_size_t, POINTER(_fixed_plan)]),
    "lensprof_fixed_apply": (_status, [_fixed_plan, _image, _image, c_uint32, c_uint32]),
    # profile.h
    "lensprof_profile_key_init": (None, [_key]),
    "lensprof_profile_key_validate": (_status, [_key]),
    "lensprof_profile_init": (None, [_profile]),
    "lensprof_profile_validate": (_status, [_profile]),
    "lensprof_profile_pack": (_status, [_profile, c_uint32, c_void_p, c_size_t, _size_out]),
    "lensprof_profile_unpack": (_status, [c_void_p, c_size_t, _profile]),
    # sample.h
    "lensprof_sample_options_init": (None, [POINTER(SampleOptions)]),
    "lensprof_sample_overlap": (_status, [POINTER(SampleOptions), POINTER(SampleImage), c_uint32, _pairs, c_uint32,
                                          _u32_out, _error]),
    "lensprof_sample_tracks": (_status, [POINTER(SampleOptions), POINTER(SampleImage), c_uint32, _observations,
                                         c_uint32, _u32_out, _error]),
    # fit.h
    "lensprof_fit_options_init": (None, [POINTER(FitOptions)]),
    "lensprof_fit_result_init": (None, [POINTER(FitResult)]),
    "lensprof_fit_overlap": (_status, [POINTER(FitOptions), _fit_images, c_uint32, _pairs, c_uint32, _exposures,
                                       POINTER(FitResult), _error]),
    "lensprof_fit_radiance": (_status, [POINTER(FitOptions), _fit_images, c_uint32, _observations, c_uint32, _exposures,
                                        POINTER(FitResult), _error]),
    "lensprof_transfer_rms": (_status, [_response, _vignetting, _fit_images, _exposures, c_uint32, _pairs, c_uint32,
                                        c_uint32, _doubles, _doubles]),
    # flat.h
    "lensprof_flat_options_init": (None, [POINTER(FlatOptions)]),
    "lensprof_flat_result_init": (None, [POINTER(FlatResult)]),
    "lensprof_fit_flat": (_status, [POINTER(FlatOptions), POINTER(FlatImage), c_uint32, POINTER(FlatResult), _error]),
    # formats.h
    "lensprof_pto_read": (_status, [c_char_p, c_size_t, POINTER(_pto), _error]),
    "lensprof_pto_destroy": (None, [_pto]),
    "lensprof_pto_image_count": (c_uint32, [_pto]),
    "lensprof_pto_get_image": (_status, [_pto, c_uint32, POINTER(PtoImage)]),
    "lensprof_pto_get_response": (_status, [_pto, c_uint32, _response]),
    "lensprof_pto_get_name": (_status, [_pto, c_uint32, c_char_p, c_size_t, _size_out]),
    "lensprof_pto_set_name": (_status, [_pto, c_uint32, c_char_p]),
    "lensprof_pto_draw_mask": (_status, [_pto, c_uint32, POINTER(c_uint8), c_uint32, c_uint32, c_ssize_t]),
    "lensprof_pto_set_result": (_status, [_pto, _response, _vignetting, _exposures, c_uint32, c_uint32]),
    "lensprof_pto_write": (_status, [_pto, c_char_p, c_size_t, _size_out]),
    "lensprof_points_read": (_status, [c_char_p, c_size_t, _pairs, c_uint32, _u32_out, _error]),
    "lensprof_points_write": (_status, [_pairs, c_uint32, _camera, c_uint32, c_char_p, c_size_t, _size_out]),
    "lensprof_lensfun_read": (_status, [c_char_p, c_size_t, c_char_p, ImportVisitor, c_void_p, _error]),
    "lensprof_lensfun_write": (_status, [POINTER(_profile), c_uint32, c_char_p, c_size_t, _size_out, _error]),
    "lensprof_json_write": (_status, [POINTER(_profile), c_uint32, c_char_p, c_size_t, _size_out, _error]),
    "lensprof_json_read": (_status, [c_char_p, c_size_t, c_char_p, ImportVisitor, c_void_p, _error]),
    "lensprof_pcalib_read": (_status, [c_char_p, c_size_t, _response, _error]),
    "lensprof_pcalib_write": (_status, [_response, c_char_p, c_size_t, _size_out, _error]),
    "lensprof_times_read": (_status, [c_char_p, c_size_t, POINTER(FrameTime), c_uint32, _u32_out, _error]),
    "lensprof_times_write": (_status, [POINTER(FrameTime), c_uint32, c_char_p, c_size_t, _size_out, _error]),
    "lensprof_curves_read": (_status, [c_char_p, c_size_t, c_uint32, _response, _u32_out, _error]),
    "lensprof_curves_write": (_status, [_response, c_uint32, c_uint32, c_uint32, c_char_p, c_size_t, _size_out,
                                        _error]),
    "lensprof_map_read": (_status, [POINTER(Map), c_uint32, c_uint32, _profile, _doubles, _error]),
    "lensprof_map_write": (_status, [_profile, c_uint32, c_uint32, c_uint32, c_uint32, c_uint32, c_uint32,
                                     POINTER(c_float), _error]),
    "lensprof_radical_response_read": (_status, [c_void_p, c_size_t, _response, _error]),
    "lensprof_radical_response_write": (_status, [_response, c_uint32, c_void_p, c_size_t, _size_out, _error]),
    "lensprof_radical_vignetting_read": (_status, [c_void_p, c_size_t, _profile, _doubles, _error]),
    "lensprof_radical_vignetting_write": (_status, [_profile, c_uint32, c_uint32, c_void_p, c_size_t, _size_out,
                                                    _error]),
    "lensprof_dng_opcodes_read": (_status, [c_void_p, c_size_t, c_uint32, c_uint32, c_uint32, c_char_p, ImportVisitor,
                                            c_void_p, _error]),
    "lensprof_dng_opcodes_write": (_status, [_profile, c_uint32, c_uint32, c_uint32, c_uint32, c_void_p, c_size_t,
                                             _size_out, _doubles, _error]),
    "lensprof_lcp_read": (_status, [c_char_p, c_size_t, c_char_p, ImportVisitor, c_void_p, _error]),
    "lensprof_lcp_write": (_status, [POINTER(_profile), c_uint32, c_uint32, c_uint32, c_char_p, c_size_t, _size_out,
                                     _error]),
    "lensprof_drone_xmp_read": (_status, [c_char_p, c_size_t, c_uint32, c_uint32, c_char_p, ImportVisitor, c_void_p,
                                          _error]),
    "lensprof_alsc_read": (_status, [c_char_p, c_size_t, c_double, c_uint32, c_uint32, c_uint32, c_uint32, _profile,
                                     _doubles, _error]),
    "lensprof_alsc_write": (_status, [_profile, c_double, c_uint32, c_uint32, c_uint32, c_uint32, c_char_p, c_size_t,
                                      _size_out, _error]),
    # store.h
    "lensprof_store_open": (_status, [c_char_p, c_uint32, POINTER(_store), _error]),
    "lensprof_store_close": (None, [_store]),
    "lensprof_store_put": (_status, [_store, _profile, POINTER(c_int64), _error]),
    "lensprof_store_find": (_status, [_store, _key, _profile, POINTER(c_int64), _error]),
    "lensprof_lookup_options_init": (None, [POINTER(LookupOptions)]),
    "lensprof_store_lookup": (_status, [_store, _key, POINTER(LookupOptions), _profile, POINTER(Lookup), _error]),
    "lensprof_store_begin": (_status, [_store, _error]),
    "lensprof_store_commit": (_status, [_store, _error]),
    "lensprof_store_rollback": (None, [_store]),
    "lensprof_store_get": (_status, [_store, c_int64, _profile, _error]),
    "lensprof_store_list": (_status, [_store, _key, POINTER(StoreRow), c_uint32, _u32_out, _error]),
    "lensprof_store_find_same": (_status, [_store, _profile, POINTER(c_int64), _error]),
    "lensprof_provenance_prior": (c_int64, [POINTER(Provenance)]),
    "lensprof_provenance_set_prior": (_status, [POINTER(Provenance), c_int64]),
    "lensprof_store_merge": (_status, [_store, _store, _u32_out, _u32_out, _error]),
    "lensprof_store_check": (_status, [_store, FaultVisitor, c_void_p, _u32_out, _u32_out, _error]),
    "lensprof_store_get_stats": (_status, [_store, POINTER(StoreStats), _error]),
    "lensprof_store_remove": (_status, [_store, c_int64, _error]),
}
