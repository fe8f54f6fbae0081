# Generated from include/lensprof by bindings/tools/make_abi.py: do not edit; `make abi` regenerates it.
"""The C interface as tables: structures, enumerations, constants and functions of the public headers.

Nothing else in the package knows a layout or a number of the C library. Raw structures have the fields
of those in C; users see subclasses of them in the modules by topic.
"""
from __future__ import annotations

import typing
from ctypes import (CFUNCTYPE, POINTER, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_int64, c_size_t,
                    c_ssize_t, c_uint16, c_uint32, c_uint64, c_uint8, c_void_p)
from enum import IntEnum, IntFlag

if typing.TYPE_CHECKING:
    from ctypes import _CData

    class Structure(_CData):
        """The classes that users see declare their fields."""
else:
    from ctypes import Structure

VERSION = "0.3.0"  # of the headers

RESPONSE_SAMPLES = 1024
EMOR_MODES = 25
GRID_SIDE = 32
UNKNOWN = -1.0
COVARIANCE_MAX = 36
DEFLICKER_FRAMES = 4194304
FIELDS_IMAGES = 16384
SETTINGS_MAX = 64
CAMERAS_MAX = 64
MODES_AUTO = 4294967295
COVERAGE_BINS = 10
FIT_REFERENCE = 4294967295
FLAT_IMAGES = 128
FLAT_SPOTS = 32
ONLINE_TRACKS = 8192
ONLINE_KEYFRAMES = 24
ONLINE_MODES = 8
ONLINE_HISTORY = 65536
RENDERING_SHOTS = 16
RENDERING_SIDE = 256
RENDERING_RAW_SIDE = 64
SENSOR_PLANES = 4
SENSOR_GRID_SIDE = 33
LOOKUP_ROWS = 24
LOOKUP_REASONS = 8
LOOKUP_RESPONSES = 8
LOOKUP_NEAREST = 3
STATS_GROUPS = 8
TRIAL_PAIRS = 30
TRIAL_RINGS = 5
CAMERA_AUTO = 4294967295
DOUBT_RESPONSE = "response not shown by the pictures: typical of the kind"


class Status(IntEnum):
    """lensprof_status; see lensprof/base.h."""
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
    ERROR_NOT_USABLE = 33
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
    ERROR_READ = 60
    ERROR_WRITE = 61
    ERROR_INTERNAL = 90


class ItemKind(IntEnum):
    """lensprof_item_kind; see lensprof/base.h."""
    NONE = 0
    IMAGE = 1
    PAIR = 2
    OBSERVATION = 3
    POINT = 4
    SHOT = 5
    PROFILE = 6
    FRAME = 7
    MATCH = 8


class ResponseKind(IntEnum):
    """lensprof_response_kind; see lensprof/model.h."""
    LINEAR = 0
    GAMMA = 1
    EMOR = 2
    TABLE = 3


class CameraKind(IntEnum):
    """lensprof_camera_kind; see lensprof/model.h."""
    ANY = 0
    FILM = 1
    DIGITAL = 2
    STILL = 3
    PHONE = 4
    LINEAR = 5


class Processing(IntEnum):
    """lensprof_processing; see lensprof/profile.h."""
    RAW = 0
    JPEG = 1
    CORRECTED = 2


class Pack(IntFlag):
    """lensprof_pack; see lensprof/profile.h."""
    COVARIANCE = 0x01


class SampleType(IntEnum):
    """lensprof_sample_type; see lensprof/apply.h."""
    U8 = 0
    U16 = 1
    F32 = 2
    F16 = 3


class Layout(IntEnum):
    """lensprof_layout; see lensprof/apply.h."""
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
    """lensprof_direction; see lensprof/apply.h."""
    CORRECT = 0
    SIMULATE = 1


class Encoding(IntEnum):
    """lensprof_encoding; see lensprof/apply.h."""
    RESPONSE = 0
    LINEAR = 1


class Saturated(IntEnum):
    """lensprof_saturated; see lensprof/apply.h."""
    NEUTRAL = 0
    AS_VALUE = 1


class DeflickerState(IntEnum):
    """lensprof_deflicker_state; see lensprof/deflicker.h."""
    LEVELLED = 0
    DARK = 1
    WHITE = 2
    DISAGREES = 3


class DeflickerTo(IntEnum):
    """lensprof_deflicker_to; see lensprof/deflicker.h."""
    SMOOTH = 0
    LIGHT = 1
    MEAN = 2
    FRAME = 3
    CURVE = 4


class ExposureState(IntEnum):
    """lensprof_exposure_state; see lensprof/exposure_settings.h."""
    KNOWN = 0
    NO_TIME = 1
    NO_ISO = 2
    NO_APERTURE = 3
    APART = 4
    IMPLAUSIBLE = 5


class Reason(IntEnum):
    """lensprof_reason; see lensprof/reason.h."""
    NONE = 0
    IMAGE_GROUPS = 101
    FEW_PAIRS = 102
    FEW_AGREE = 103
    SCATTER = 104
    NOT_CONVERGED = 105
    UNDETERMINED = 106
    FEW_INLIERS = 107
    IMAGE_DISAGREES = 108
    PATTERNS = 109
    IMAGE_INCONSISTENT = 110
    IMAGES_LEFT_OUT = 111
    IMAGES_UNCONNECTED = 112
    MANY_OUTLIERS = 113
    SEAMS_REMAIN = 114
    LINKS_CONTRADICT = 115
    LINKS_UNVERIFIED = 116
    IMAGES_MINORITY = 117
    EXPOSURE_UNCERTAIN = 201
    EXPOSURES_EQUAL = 202
    KNOWN_ORDER = 203
    KNOWN_WRONG = 204
    KNOWN_STEP = 205
    KNOWN_CONTRADICT = 206
    GAMMA_INCONSISTENT = 207
    WHITE_BALANCE_FIXED = 208
    FEW_GREYS = 301
    MISSING_GREYS = 302
    UNUSUAL_RESPONSE = 303
    RESPONSE_UNCONSTRAINED = 304
    SMALL_RADIUS = 401
    CORNER_UNCERTAIN = 402
    FALLOFF_RISES = 403
    CENTER_ON_LIMIT = 404
    FALLOFF_DARK = 405
    SAME_VIEW = 406
    EXPOSURES_ONLY = 407
    NOTHING_BETTER = 408
    NOT_RADIAL = 409
    FAR_CENTER = 410
    FEW_IMAGES = 411
    FLAT_WHITE = 501
    FLAT_BLACK = 502
    FLAT_NO_CARD = 503
    FLAT_FEW_CELLS = 504
    FLAT_RESPONSE = 505
    FLAT_EXPOSURE_WRONG = 506
    FLAT_TEXTURE = 507
    FLAT_SHOTS_DIFFER = 508
    FLAT_STEEP = 509
    FLAT_NOT_RADIAL = 510
    FLAT_CENTER_BY_PRIOR = 511
    FLAT_DUST = 512
    FLAT_EDGE = 513
    FLAT_ONE_LIGHT = 514
    FLAT_NEEDS_GRID = 515
    FLAT_BLACK_LEVEL = 516
    FIELDS_FEW = 521
    FIELDS_REPEATED = 522
    FIELDS_PATTERN = 523
    FIELDS_UNCERTAIN = 524
    FIELDS_OFFSET = 525
    FIELDS_WHITE = 526
    FIELDS_BLACK = 527
    FIELDS_UNSEEN = 528
    FIELDS_GAIN = 529
    LOOKUP_NO_LENS = 601
    LOOKUP_NO_CAMERA = 602
    LOOKUP_OTHER_PROCESSING = 603
    LOOKUP_DOUBTFUL = 604
    LOOKUP_OTHER_CAMERA = 605
    LOOKUP_SEVERAL_LENSES = 606
    LOOKUP_SMALLER_SENSOR = 607
    LOOKUP_FOCAL_MISSING = 608
    LOOKUP_APERTURE_MISSING = 609
    LOOKUP_NO_FOCAL = 610
    LOOKUP_NO_APERTURE = 611
    LOOKUP_FOCAL_BEYOND = 612
    LOOKUP_APERTURE_BEYOND = 613
    LOOKUP_TOO_FAR = 614
    LOOKUP_CONTRADICTION = 615
    LOOKUP_CORRECTED = 616
    LOOKUP_FOCAL_ROUNDED = 651
    LOOKUP_FOCAL_OUTSIDE = 652
    LOOKUP_APERTURE_OUTSIDE = 653
    LOOKUP_OTHER_LIGHT = 654
    LOOKUP_SMALLEST_SENSOR = 655
    LOOKUP_BY_WORDS = 656
    LOOKUP_BUILT_IN = 657
    LOOKUP_WEAKEST_DISTANCE = 658
    LOOKUP_FARTHEST_DISTANCE = 659
    LOOKUP_USUAL_DISTANCE = 660
    LOOKUP_UNKNOWN_SENSOR = 661
    LOOKUP_ON_OTHER_CAMERA = 662
    LOOKUP_TYPICAL_RESPONSE = 663
    LOOKUP_OTHER_STYLE = 664
    PRIOR_OVERRULED = 701
    PRIOR_RESPONSE_OVERRULED = 702
    PRIOR_FALLOFF_OVERRULED = 703


class Severity(IntEnum):
    """lensprof_severity; see lensprof/reason.h."""
    PASSED = 0
    NOTE = 1
    WARNING = 2
    REFUSAL = 3


class Projection(IntEnum):
    """lensprof_projection; see lensprof/geometry.h."""
    RECTILINEAR = 0
    CYLINDRICAL = 1
    CIRCULAR_FISHEYE = 2
    FULLFRAME_FISHEYE = 3
    EQUIRECTANGULAR = 4
    ORTHOGRAPHIC = 8
    STEREOGRAPHIC = 10
    THOBY = 20
    EQUISOLID = 21


class Sampling(IntEnum):
    """lensprof_sampling; see lensprof/sample.h."""
    BALANCED = 0
    PAPER = 1
    BRACKET = 2


class LinkState(IntEnum):
    """lensprof_link_state; see lensprof/sample.h."""
    UNVERIFIED = 0
    VERIFIED = 1
    CONTRADICTED = 2


class Method(IntEnum):
    """lensprof_fit_method; see lensprof/fit.h."""
    TRANSFER = 0
    RADIANCE = 1
    TRANSFER_FUNCTION = 2


class Loss(IntEnum):
    """lensprof_loss; see lensprof/fit.h."""
    ROBUST = 0
    HUBER = 1
    SQUARED = 2


class GammaFrom(IntEnum):
    """lensprof_gamma_from; see lensprof/fit.h."""
    AUTO = 0
    PRIOR = 1
    EXPOSURES = 2
    KNOWN = 3
    NONE = 4
    PROFILE = 5
    FALLOFF = 6
    CAMERAS = 7


class FitResponse(IntEnum):
    """lensprof_fit_response; see lensprof/fit.h."""
    PICTURES = 0
    OPTIONS = 1
    KIND = 2
    PROFILE = 3


class FitModel(IntEnum):
    """lensprof_fit_model; see lensprof/fit.h."""
    FULL = 0
    LENS = 1
    EXPOSURES = 2
    NOTHING = 3


class ProfilePrior(IntEnum):
    """lensprof_profile_prior; see lensprof/fit.h."""
    NONE = 0
    USED = 1
    OVERRULED = 2
    RESPONSE_OVERRULED = 3
    FALLOFF_OVERRULED = 4


class FlatLight(IntEnum):
    """lensprof_flat_light; see lensprof/flat.h."""
    AUTO = 0
    EVEN = 1
    PLANE = 2
    QUADRATIC = 3


class FlatGrid(IntEnum):
    """lensprof_flat_grid; see lensprof/flat.h."""
    AUTO = 0
    NONE = 1
    ALWAYS = 2


class CurveKind(IntEnum):
    """lensprof_curve; see lensprof/formats.h."""
    INVERSE = 0
    LOG = 1
    LOG10 = 2
    FORWARD = 3


class MapSense(IntEnum):
    """lensprof_map_sense; see lensprof/formats.h."""
    ATTENUATION = 0
    GAIN = 1


class DngForm(IntEnum):
    """lensprof_dng_form; see lensprof/formats.h."""
    RADIAL = 0
    GAIN_MAP = 1
    AUTO = 2


class Format(IntEnum):
    """lensprof_format; see lensprof/formats.h."""
    AUTO = 0
    LENSFUN = 1
    LCP = 2
    JSON = 3
    BLOB = 4
    DNG_OPCODES = 5
    DRONE_XMP = 6
    ALSC = 7
    MAP = 8
    PCALIB = 9
    CURVES = 10
    RADICAL_RESPONSE = 11
    RADICAL_VIGNETTING = 12
    CUBE = 13
    GLSL = 14
    WGSL = 15
    C = 16


class Holds(IntEnum):
    """lensprof_holds; see lensprof/formats.h."""
    PROFILES = 0
    RESPONSE = 1
    FALLOFF = 2


class OnlineState(IntEnum):
    """lensprof_online_state; see lensprof/online.h."""
    FIRST = 0
    CHAINED = 1
    LOST = 2


class OnlineKnown(IntEnum):
    """lensprof_online_known; see lensprof/online.h."""
    EXPONENT = 1
    SHAPE = 2
    FALLOFF = 4


class Packing(IntEnum):
    """lensprof_packing; see lensprof/packed.h."""
    RAW8 = 8
    RAW10 = 10
    RAW12 = 12
    RAW14 = 14


class Flip(IntEnum):
    """lensprof_flip; see lensprof/sensor.h."""
    NONE = 0
    HORIZONTAL = 1
    VERTICAL = 2
    BOTH = 3


class StoreMode(IntEnum):
    """lensprof_store_mode; see lensprof/store.h."""
    READ = 0
    WRITE = 1
    CREATE = 2


class DistanceRule(IntEnum):
    """lensprof_distance_rule; see lensprof/store.h."""
    USUAL = 0
    WEAKEST = 1
    FARTHEST = 2


class ResponseFrom(IntEnum):
    """lensprof_response_from; see lensprof/store.h."""
    PROFILE = 0
    CAMERA = 1
    KIND = 2
    RAW = 3


class StoreNames(IntEnum):
    """lensprof_store_names; see lensprof/store.h."""
    LENSES = 0
    CAMERAS = 1


class TrialResponse(IntEnum):
    """lensprof_trial_response; see lensprof/trial.h."""
    OWN = 0
    OTHER = 1
    KIND = 2
    LINEAR = 3


class TrialCorners(IntEnum):
    """lensprof_trial_corners; see lensprof/trial.h."""
    NOT_SHOWN = 0
    AGREE = 1
    TOO_DARK = 2
    TOO_BRIGHT = 3


class CopyExposure(IntEnum):
    """lensprof_copy_exposure; see lensprof/photo.h."""
    MEAN = 0
    KEEP = 1
    REFERENCE = 2


class Free(IntFlag):
    """LENSPROF_FREE_*; see lensprof/fit.h."""
    RESPONSE = 0x01
    K1 = 0x02
    K2 = 0x04
    K3 = 0x08
    CENTER = 0x10
    EV = 0x20
    RED = 0x40
    BLUE = 0x80
    FALLOFF = 0x0e
    LENS = 0x1f
    IMAGE = 0xe0


class Item(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("index", c_uint32),
        ("text_begin", c_uint32),
        ("text_bytes", c_uint32),
    ]


class ErrorText(Structure):
    _fields_ = [
        ("text", c_char * 256),
        ("item", Item),
    ]


Progress = CFUNCTYPE(c_int, c_double, c_void_p)


class Response(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("modes", c_uint32),
        ("gamma", c_double),
        ("emor", c_double * 25),
        ("table", c_double * 1024),
    ]


class Vignetting(Structure):
    _fields_ = [
        ("k", c_double * 3),
        ("center", c_double * 2),
    ]


class GainGrid(Structure):
    _fields_ = [
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("channels", c_uint32),
        ("reserved", c_uint32),
        ("attenuation", c_float * 3072),
    ]


class Levels(Structure):
    _fields_ = [
        ("black", c_double * 3),
        ("white", c_double),
    ]


class ImageCircle(Structure):
    _fields_ = [
        ("center", c_double * 2),
        ("radius", c_double),
    ]


class Exposure(Structure):
    _fields_ = [
        ("ev", c_double),
        ("white_balance", c_double * 3),
    ]


class ProfileKey(Structure):
    _fields_ = [
        ("camera_maker", c_char * 64),
        ("camera_model", c_char * 64),
        ("lens", c_char * 128),
        ("unit", c_char * 64),
        ("crop_factor", c_double),
        ("focal_mm", c_double),
        ("aperture", c_double),
        ("distance_m", c_double),
        ("color_temperature_k", c_double),
        ("processing", c_uint32),
        ("style", c_char * 64),
        ("reserved", c_uint32 * 21),
    ]


class CameraModel(Structure):
    _fields_ = [
        ("maker", c_char * 64),
        ("model", c_char * 64),
        ("other_maker", c_char * 64),
        ("other_model", c_char * 64),
        ("variant", c_char * 64),
        ("mount", c_char * 64),
        ("lens", c_char * 128),
        ("source", c_char * 256),
        ("crop_factor", c_double),
        ("fixed_lens", c_uint32),
        ("reserved", c_uint32 * 61),
    ]


class Provenance(Structure):
    _fields_ = [
        ("method", c_char * 32),
        ("software", c_char * 32),
        ("source", c_char * 256),
        ("created_unix_s", c_int64),
        ("images", c_uint32),
        ("pairs", c_uint32),
        ("heldout_rms", c_double),
        ("inlier_share", c_double),
        ("doubt", c_char * 64),
        ("prior_id", c_int64),
        ("forced", c_uint32),
        ("not_usable", c_uint32),
        ("gamma_sigma", c_double),
        ("reserved", c_uint32 * 82),
    ]


class Profile(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("responses", c_uint32),
        ("vignettings", c_uint32),
        ("covariance_size", c_uint32),
        ("key", ProfileKey),
        ("provenance", Provenance),
        ("response", Response * 3),
        ("vignetting", Vignetting * 3),
        ("grid", GainGrid),
        ("covariance", c_double * 1296),
        ("levels", Levels),
        ("image_circle", ImageCircle),
    ]


class Image(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("row_bytes", c_ssize_t),
        ("width", c_uint32),
        ("height", c_uint32),
        ("sample", c_uint32),
        ("layout", c_uint32),
    ]


class Target(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("row_bytes", c_ssize_t),
        ("width", c_uint32),
        ("height", c_uint32),
        ("sample", c_uint32),
        ("layout", c_uint32),
    ]


class ApplyOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("direction", c_uint32),
        ("input", c_uint32),
        ("output", c_uint32),
        ("frame_width", c_uint32),
        ("frame_height", c_uint32),
        ("source_sample", c_uint32),
        ("source_layout", c_uint32),
        ("target_sample", c_uint32),
        ("saturated", c_uint32),
        ("responses", c_uint32),
        ("vignettings", c_uint32),
        ("response", POINTER(Response)),
        ("vignetting", POINTER(Vignetting)),
        ("source", Exposure),
        ("target", Exposure),
        ("grid", POINTER(GainGrid)),
        ("strength", c_double),
        ("gain_cap", c_double),
        ("dither", c_uint32),
        ("reserved", c_uint32),
        ("blob", c_void_p),
        ("blob_bytes", c_size_t),
        ("output_response", POINTER(Response)),
        ("output_responses", c_uint32),
        ("reserved2", c_uint32),
        ("chroma", c_uint32),
        ("reserved3", c_uint32),
        ("levels", POINTER(Levels)),
        ("output_levels", POINTER(Levels)),
        ("image_circle", POINTER(ImageCircle)),
    ]


class Plan(Structure):
    """Opaque."""


class Deflicker(Structure):
    """Opaque."""


class DeflickerOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("responses", c_uint32),
        ("response", POINTER(Response)),
        ("rows", c_uint32),
        ("reserved", c_uint32),
        ("region", c_double * 4),
    ]


class DeflickerFacts(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("seconds", c_double),
        ("settings_ev", c_double),
        ("f_number", c_double),
    ]


class DeflickerFrame(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("state", c_uint32),
        ("segment", c_uint32),
        ("repeats", c_uint32),
        ("seconds", c_double),
        ("settings_ev", c_double),
        ("exposure", Exposure),
        ("ev_sigma", c_double),
        ("agreeing", c_double),
        ("shift", c_double * 2),
        ("white_share", c_double),
        ("dark_share", c_double),
    ]


class DeflickerResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("frames", c_uint32),
        ("levelled", c_uint32),
        ("segments", c_uint32),
        ("repeated", c_uint32),
        ("moving", c_uint32),
        ("motion", c_double),
        ("unlinked", c_double),
        ("flicker", c_double),
        ("tone_error", c_double),
        ("known_range", c_double),
    ]


class DeflickerTarget(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("to", c_uint32),
        ("frame", c_uint32),
        ("reserved", c_uint32),
        ("window_s", c_double),
        ("curve", POINTER(c_double)),
    ]


class ExposureSettings(Structure):
    _fields_ = [
        ("time_s", c_double),
        ("f_number", c_double),
        ("iso", c_double),
        ("camera", c_uint32),
        ("lens", c_uint32),
        ("is_manual", c_uint32),
        ("reserved", c_uint32),
    ]


class KnownExposure(Structure):
    _fields_ = [
        ("ev", c_double),
        ("sigma", c_double),
        ("state", c_uint32),
        ("reserved", c_uint32),
    ]


class Exposures(Structure):
    """Opaque."""


class ExposuresInfo(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("camera_count", c_uint32),
        ("lens_count", c_uint32),
        ("image_count", c_uint32),
        ("reference", c_uint32),
        ("reserved", c_uint32),
        ("software", c_char_p),
    ]


class ExposuresCamera(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("name", c_char_p),
        ("response", Response),
    ]


class ExposuresLens(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("camera", c_uint32),
        ("name", c_char_p),
        ("vignettings", c_uint32),
        ("reserved", c_uint32),
        ("vignetting", Vignetting * 3),
    ]


class ExposuresImage(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("lens", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("name", c_char_p),
        ("file", c_char_p),
        ("exposure", Exposure),
        ("ev_sigma", c_double),
        ("white_balance_sigma", c_double * 3),
    ]


class Finding(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("code", c_uint32),
        ("severity", c_uint32),
        ("value_count", c_uint32),
        ("rule_severity", c_uint32),
        ("reserved", c_uint32),
        ("value", c_double * 2),
        ("measured", c_double),
        ("limit", c_double),
        ("item", Item),
        ("text", c_char * 256),
    ]


class Fields(Structure):
    """Opaque."""


class FieldsOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("channels", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("given_offset", c_uint32),
        ("responses", c_uint32),
        ("threads", c_uint32),
        ("reserved", c_uint32),
        ("offset", c_double * 3),
        ("white", c_double),
        ("response", POINTER(Response)),
        ("progress", Progress),
        ("progress_user", c_void_p),
    ]


class FieldsImage(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("used", c_uint32),
        ("same_as", c_uint32),
        ("reserved", c_uint32),
        ("level", c_double * 3),
        ("white_share", c_double),
        ("pixel_share", c_double),
    ]


class FieldsSmoothness(Structure):
    _fields_ = [
        ("order", c_uint32),
        ("reserved", c_uint32),
        ("weight", c_double),
        ("rms", c_double),
    ]


class FieldsChannel(Structure):
    _fields_ = [
        ("offset", c_double),
        ("offset_sigma", c_double),
        ("offset_found", c_uint32),
        ("smoothness", c_uint32),
        ("shading_error", c_double),
        ("heldout_rms", c_double),
        ("even_rms", c_double),
        ("pattern", c_double),
        ("pattern_share", c_double),
        ("background_share", c_double),
        ("background_sigma", c_double),
        ("iterations", c_uint32),
        ("converged", c_uint32),
    ]


class FieldsResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("usable", c_uint32),
        ("findings", c_uint32),
        ("passed", c_uint32),
        ("images", c_uint32),
        ("used", c_uint32),
        ("repeated", c_uint32),
        ("black", c_uint32),
        ("white", c_uint32),
        ("channels", c_uint32),
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("smoothnesses", c_uint32),
        ("reserved", c_uint32),
        ("unseen_share", c_double),
        ("white_share", c_double),
        ("channel", FieldsChannel * 3),
        ("shading", GainGrid),
    ]


class Camera(Structure):
    _fields_ = [
        ("projection", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("hfov_deg", c_double),
        ("yaw_deg", c_double),
        ("pitch_deg", c_double),
        ("roll_deg", c_double),
        ("radial", c_double * 3),
        ("shift_px", c_double * 2),
        ("shear_px", c_double * 2),
        ("translation", c_double * 3),
        ("plane_deg", c_double * 2),
    ]


class Pair(Structure):
    _fields_ = [
        ("image", c_uint32 * 2),
        ("xy", c_double * 2 * 2),
        ("value", c_double * 3 * 2),
    ]


class Observation(Structure):
    _fields_ = [
        ("point", c_uint32),
        ("image", c_uint32),
        ("xy", c_double * 2),
        ("value", c_double * 3),
    ]


class SampleImage(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reduction", c_uint32),
        ("every_pixel", c_uint32),
        ("reserved", c_uint32),
        ("view", Image),
        ("camera", Camera),
        ("mask", POINTER(c_uint8)),
        ("mask_row_bytes", c_ssize_t),
        ("black", c_double),
        ("white", c_double),
    ]


class Link(Structure):
    _fields_ = [
        ("image", c_uint32 * 2),
        ("state", c_uint32),
        ("pairs", c_uint32),
    ]


class SampleOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("sampling", c_uint32),
        ("pairs", c_uint32),
        ("seed", c_uint32),
        ("threads", c_uint32),
        ("reserved", c_uint32),
        ("progress", Progress),
        ("progress_user", c_void_p),
        ("links", POINTER(Link)),
        ("link_count", POINTER(c_uint32)),
        ("link_capacity", c_uint32),
        ("reserved2", c_uint32),
        ("response", POINTER(Response)),
        ("vignetting", POINTER(Vignetting)),
        ("match_of_pair", POINTER(c_uint32)),
    ]


class Match(Structure):
    _fields_ = [
        ("image", c_uint32 * 2),
        ("xy", c_double * 2 * 2),
        ("map", c_double * 2 * 2),
    ]


class FitImage(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("free", c_uint32),
        ("ev_of", c_uint32),
        ("red_of", c_uint32),
        ("blue_of", c_uint32),
        ("setting", c_uint32),
        ("exposure", Exposure),
        ("known_ev", c_double),
        ("known_ev_sigma", c_double),
        ("camera", c_uint32),
        ("reserved", c_uint32),
        ("f_number_ratio", c_double),
        ("crop_factor", c_double),
    ]


class FitOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("channels", c_uint32),
        ("reference", c_uint32),
        ("free", c_uint32),
        ("modes", c_uint32),
        ("loss", c_uint32),
        ("huber_levels", c_double),
        ("prior_weight", c_double),
        ("max_iterations", c_uint32),
        ("vignettings", c_uint32),
        ("gamma_from", c_uint32),
        ("camera_kind", c_uint32),
        ("threads", c_uint32),
        ("method", c_uint32),
        ("refine", c_uint32),
        ("moving_camera", c_uint32),
        ("profile", POINTER(Profile)),
        ("response", POINTER(Response)),
        ("vignetting", Vignetting),
        ("progress", Progress),
        ("progress_user", c_void_p),
        ("links", POINTER(Link)),
        ("link_count", c_uint32),
        ("unlinked_images", c_uint32),
        ("points", POINTER(c_uint32)),
        ("view_distances", POINTER(c_double)),
    ]


class Fit(Structure):
    """Opaque."""


class FitImageQuality(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("joined", c_uint32),
        ("ev_sigma", c_double),
        ("white_balance_sigma", c_double * 3),
        ("median_residual", c_double),
        ("known_ev_residual", c_double),
        ("radius", c_double),
        ("grey_low", c_double),
        ("grey_high", c_double),
        ("pairs", c_uint32),
        ("inliers", c_uint32),
        ("component", c_uint32),
        ("known_ev_left_out", c_uint32),
    ]


class FitResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("images", c_uint32),
        ("setting_pairs", c_uint32),
        ("usable", c_uint32),
        ("findings", c_uint32),
        ("passed", c_uint32),
        ("reserved", c_uint32),
        ("vignetting", Vignetting * 3),
        ("radius_ends", c_uint32 * 10),
        ("covariance", c_double * 1296),
        ("gamma_direction", c_double * 36),
        ("camera", c_uint32),
        ("covariance_size", c_uint32),
        ("response", Response),
        ("vignettings", c_uint32),
        ("pairs", c_uint32),
        ("equalizes", c_uint32),
        ("response_from", c_uint32),
        ("profile_prior", c_uint32),
        ("gamma_from", c_uint32),
        ("gamma_sigma", c_double),
        ("before_rms", c_double),
        ("heldout_rms", c_double),
        ("heldout_median", c_double),
        ("noise_levels", c_double),
        ("inlier_share", c_double),
        ("frame_share", c_double),
        ("image_share", c_double),
        ("irradiance_spread_ev", c_double),
        ("grey_ends", c_uint32 * 10),
        ("converged", c_uint32),
        ("iterations", c_uint32),
        ("model", c_uint32),
        ("equal_exposures", c_uint32),
        ("falloff_prior_distance", c_double),
        ("center_prior_distance", c_double),
        ("error_inflation", c_double),
        ("reference", c_uint32),
        ("left_out", c_uint32),
        ("components", c_uint32),
        ("setting_count", c_uint32),
        ("camera_count", c_uint32),
        ("reserved2", c_uint32),
        ("seconds", c_double),
        ("colour_variance_before", c_double),
        ("colour_variance_exposures_only", c_double),
        ("colour_variance", c_double),
    ]


class FitCamera(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("images", c_uint32),
        ("joined", c_uint32),
        ("shared_pairs", c_uint32),
        ("agreeing_share", c_double),
        ("irradiance_difference_ev", c_double),
        ("log_gamma", c_double),
        ("offset_sigma_ev", c_double),
        ("reference", c_uint32),
        ("setting", c_uint32),
        ("attached", c_uint32),
        ("reserved", c_uint32),
    ]


class FixedPlan(Structure):
    """Opaque."""


class FlatImage(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("reduction", c_uint32),
        ("shot", c_uint32),
        ("reserved", c_uint32),
        ("view", Image),
        ("mask", POINTER(c_uint8)),
        ("mask_row_bytes", c_ssize_t),
        ("black", c_double),
        ("white", c_double),
        ("ev", c_double),
        ("rotation_deg", c_double),
    ]


class FlatOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("channels", c_uint32),
        ("free", c_uint32),
        ("vignettings", c_uint32),
        ("light", c_uint32),
        ("own_light", c_uint32),
        ("several", c_uint32),
        ("find_card", c_uint32),
        ("grid", c_uint32),
        ("responses", c_uint32),
        ("threads", c_uint32),
        ("reserved", c_uint32),
        ("ev_sigma", c_double),
        ("prior_weight", c_double),
        ("response", POINTER(Response)),
        ("vignetting", Vignetting),
        ("progress", Progress),
        ("progress_user", c_void_p),
        ("levels", Levels),
        ("black_sigma", c_double),
    ]


class Flat(Structure):
    """Opaque."""


class FlatImageQuality(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("cells", c_uint32),
        ("white_share", c_double),
        ("black_share", c_double),
        ("noise_levels", c_double),
        ("ev_residual", c_double),
        ("residual", c_double),
        ("gradient", c_double * 2),
        ("radius", c_double),
        ("card", c_uint32 * 4),
    ]


class FlatSpot(Structure):
    _fields_ = [
        ("x", c_double),
        ("y", c_double),
        ("radius", c_double),
        ("depth", c_double),
        ("shots", c_uint32),
        ("reserved", c_uint32),
    ]


class FlatResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("usable", c_uint32),
        ("images", c_uint32),
        ("covariance_size", c_uint32),
        ("findings", c_uint32),
        ("passed", c_uint32),
        ("vignetting", Vignetting * 3),
        ("vignettings", c_uint32),
        ("light", c_uint32),
        ("shots", c_uint32),
        ("cells", c_uint32),
        ("separated", c_uint32),
        ("iterations", c_uint32),
        ("converged", c_uint32),
        ("spots", c_uint32),
        ("spot", FlatSpot * 32),
        ("radius", c_double),
        ("noise", c_double),
        ("residual", c_double),
        ("texture", c_double),
        ("frame_residual", c_double),
        ("shot_residual", c_double),
        ("inlier_share", c_double),
        ("corner_sigma", c_double),
        ("grid_residual", c_double),
        ("covariance", c_double * 1296),
        ("gain_grid", GainGrid),
        ("corner", c_double),
        ("edge_radius", c_double),
        ("edge_share", c_double),
        ("light_ev", c_double),
        ("polynomial_error", c_double),
        ("levels", Levels),
        ("black_offset", c_double),
        ("black_sigma", c_double),
        ("black_ev", c_double),
        ("black_shown", c_uint32),
        ("reserved", c_uint32),
        ("image_circle", ImageCircle),
    ]


class Pto(Structure):
    """Opaque."""


class PtoImage(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("response_type", c_uint32),
        ("camera", Camera),
        ("exposure", Exposure),
        ("vignetting", Vignetting),
        ("emor", c_double * 5),
        ("free", c_uint32),
        ("response_of", c_uint32),
        ("vignetting_of", c_uint32),
        ("center_of", c_uint32),
        ("ev_of", c_uint32),
        ("red_of", c_uint32),
        ("blue_of", c_uint32),
        ("crop", c_int32 * 4),
        ("crop_circular", c_uint32),
        ("left_out", c_uint32),
        ("of_crop", c_uint32),
    ]


class ImportEntry(Structure):
    _fields_ = [
        ("profile", POINTER(Profile)),
        ("usable", c_uint32),
        ("holds", c_uint32),
        ("change", c_double),
    ]


ImportVisitor = CFUNCTYPE(c_int, c_void_p, POINTER(ImportEntry))


CameraVisitor = CFUNCTYPE(c_int, c_void_p, POINTER(CameraModel))


class Map(Structure):
    _fields_ = [
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("channels", c_uint32),
        ("sense", c_uint32),
        ("values", POINTER(c_float)),
    ]


class FormatInfo(Structure):
    _fields_ = [
        ("format", c_uint32),
        ("holds", c_uint32),
        ("is_written", c_uint32),
        ("is_many", c_uint32),
        ("name", c_char_p),
        ("about", c_char_p),
    ]


class ImportOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("format", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("layout", c_uint32),
        ("curve", c_uint32),
        ("color_temperature_k", c_double),
        ("name", c_char_p),
        ("map", POINTER(Map)),
        ("key", POINTER(ProfileKey)),
        ("strict", c_uint32),
        ("reserved", c_uint32),
    ]


class ExportOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("format", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("layout", c_uint32),
        ("dng_form", c_uint32),
        ("curve", c_uint32),
        ("pack", c_uint32),
        ("color_temperature_k", c_double),
        ("name", c_char_p),
        ("camera", POINTER(CameraModel)),
        ("into", c_void_p),
        ("into_size", c_size_t),
        ("cost_ev", POINTER(c_double)),
    ]


class OnlineOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("channels", c_uint32),
        ("camera_kind", c_uint32),
        ("tracks", c_uint32),
        ("keyframes", c_uint32),
        ("modes", c_uint32),
        ("history", c_uint32),
        ("reserved", c_uint32),
        ("center", c_double * 2),
        ("black", c_double),
        ("white", c_double),
        ("profile", POINTER(Profile)),
    ]


class OnlineObservation(Structure):
    _fields_ = [
        ("track", c_uint64),
        ("x", c_float),
        ("y", c_float),
        ("value", c_float * 3),
        ("weight", c_float),
    ]


class OnlineFrame(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("count", c_uint32),
        ("number", c_uint64),
        ("known_ev", c_double),
        ("known_ev_sigma", c_double),
        ("observations", POINTER(OnlineObservation)),
    ]


class OnlineExposure(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("state", c_uint32),
        ("number", c_uint64),
        ("since", c_uint64),
        ("before", c_uint64),
        ("ev", c_double),
        ("ev_sigma", c_double),
        ("step_ev", c_double),
        ("step_sigma", c_double),
        ("white_balance", c_double * 3),
        ("tracks", c_uint32),
        ("outliers", c_uint32),
        ("unusable", c_uint32),
        ("keyframe", c_uint32),
    ]


class OnlineResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("known", c_uint32),
        ("frames", c_uint64),
        ("lost", c_uint64),
        ("chains", c_uint64),
        ("keyframes", c_uint64),
        ("observations", c_uint64),
        ("windows", c_uint64),
        ("gamma", c_double),
        ("log_gamma_sigma", c_double),
        ("shape_sigma", c_double),
        ("corner", c_double),
        ("corner_sigma", c_double),
        ("falloff_sigma", c_double),
        ("noise_levels", c_double),
        ("known_ev_scatter", c_double),
        ("inlier_share", c_double),
    ]


class Online(Structure):
    """Opaque."""


class PackedImage(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("row_bytes", c_ssize_t),
        ("width", c_uint32),
        ("height", c_uint32),
    ]


class PackedTarget(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("row_bytes", c_ssize_t),
        ("width", c_uint32),
        ("height", c_uint32),
    ]


class Rendering(Structure):
    """Opaque."""


class RenderingShot(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("quarter_turns", c_uint32),
        ("shift", c_double * 2),
        ("scale", c_double),
        ("k1", c_double),
        ("k2", c_double),
        ("correlation", c_double),
        ("texture", c_double),
        ("channels", c_uint32),
        ("squares", c_uint32),
        ("black", c_uint32),
        ("white", c_uint32),
        ("colourful", c_uint32),
        ("saturated", c_uint32),
        ("rough", c_uint32),
        ("areas", c_uint32),
        ("corrects_falloff", c_uint32),
        ("tones", c_uint32),
        ("radius", c_double),
        ("corner", c_double),
        ("corner_sigma", c_double),
        ("pattern_levels", c_double),
        ("pattern_ev", c_double),
        ("noise_levels", c_double),
        ("white_ev", c_double),
        ("gamma", c_double),
        ("gamma_sigma", c_double),
        ("colour", c_double * 9),
        ("falloff", c_double * 3),
        ("saturation", c_double),
    ]


class RenderingResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("usable", c_uint32),
        ("findings", c_uint32),
        ("passed", c_uint32),
        ("response", Response),
        ("gamma", c_double),
        ("gamma_sigma", c_double),
        ("lowest", c_double),
        ("highest", c_double),
        ("tenths", c_uint32),
        ("shows_white", c_uint32),
        ("corrects_falloff", c_uint32),
        ("shots", c_uint32),
        ("areas", c_uint32),
        ("reserved", c_uint32),
    ]


class SensorLevels(Structure):
    _fields_ = [
        ("black", c_double * 4),
        ("white", c_double),
    ]


class Readout(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("x", c_uint32),
        ("y", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("step", c_uint32),
        ("flip", c_uint32),
        ("side", c_uint32),
        ("plane", c_uint8 * 16),
        ("channel", c_uint8 * 4),
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("gains", POINTER(c_float)),
        ("levels", POINTER(SensorLevels)),
        ("output_levels", POINTER(SensorLevels)),
    ]


class SensorPlan(Structure):
    """Opaque."""


class SensorFlat(Structure):
    """Opaque."""


class Store(Structure):
    """Opaque."""


class LookupOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("distance_rule", c_uint32),
        ("with_doubt", c_uint32),
        ("any_processing", c_uint32),
        ("force_falloff", c_uint32),
        ("response_alone", c_uint32),
    ]


class Lookup(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("exact", c_uint32),
        ("rows", c_uint32),
        ("reserved", c_uint32),
        ("id", c_int64 * 24),
        ("weight", c_double * 24),
        ("distance", c_double),
        ("sigma", c_double),
        ("name_score", c_double),
        ("reason", c_char * 256),
        ("reason_code", c_uint32 * 8),
        ("falloff_sigma", c_double),
        ("distance_sigma", c_double),
        ("sensor_sigma", c_double),
        ("response_sigma", c_double),
        ("response_from", c_uint32),
        ("camera_kind", c_uint32),
        ("falloff_store", c_uint32),
        ("response_store", c_uint32),
        ("response_rows", c_uint32),
        ("reserved2", c_uint32),
        ("response_id", c_int64 * 8),
        ("response_weight", c_double * 8),
        ("nearest", c_char * 128 * 3),
    ]


class StoreRow(Structure):
    _fields_ = [
        ("id", c_int64),
        ("damaged", c_uint32),
        ("reserved", c_uint32 * 3),
        ("key", ProfileKey),
        ("provenance", Provenance),
    ]


class StoreFault(Structure):
    _fields_ = [
        ("id", c_int64),
        ("reason", c_char * 256),
    ]


FaultVisitor = CFUNCTYPE(c_int, c_void_p, POINTER(StoreFault))


class StoreGroup(Structure):
    _fields_ = [
        ("name", c_char * 256),
        ("profiles", c_uint32),
        ("reserved", c_uint32),
    ]


class StoreStats(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("layout", c_uint32),
        ("profiles", c_uint32),
        ("cameras", c_uint32),
        ("lenses", c_uint32),
        ("units", c_uint32),
        ("processing", c_uint32 * 3),
        ("with_covariance", c_uint32),
        ("with_grid", c_uint32),
        ("with_doubt", c_uint32),
        ("methods", c_uint32),
        ("sources", c_uint32),
        ("focal_mm", c_double * 2),
        ("aperture", c_double * 2),
        ("distance_m", c_double * 2),
        ("method", StoreGroup * 8),
        ("source", StoreGroup * 8),
        ("bytes", c_int64),
    ]


class StoreSummary(Structure):
    _fields_ = [
        ("camera_maker", c_char * 64),
        ("camera_model", c_char * 64),
        ("lens", c_char * 128),
        ("profiles", c_uint32),
        ("others", c_uint32),
        ("processing", c_uint32 * 3),
        ("reserved", c_uint32),
        ("focal_mm", c_double * 2),
        ("aperture", c_double * 2),
        ("distance_m", c_double * 2),
    ]


class TrialOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("channels", c_uint32),
        ("camera_kind", c_uint32),
        ("reserved", c_uint32),
    ]


class TrialCandidate(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("has_falloff", c_uint32),
        ("response_from", c_uint32),
        ("response_profile", c_uint32),
        ("as_good_as_best", c_uint32),
        ("better_than_none", c_uint32),
        ("heldout_rms", c_double),
        ("heldout_median", c_double),
        ("above_best", c_double),
        ("above_best_sigma", c_double),
        ("below_none", c_double),
        ("below_none_sigma", c_double),
        ("corners", c_uint32),
        ("rings", c_uint32),
        ("ring_ev", c_double * 5),
        ("ring_sigma_ev", c_double * 5),
    ]


class TrialResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("usable", c_uint32),
        ("best", c_uint32),
        ("decided", c_uint32),
        ("images", c_uint32),
        ("fitted", c_uint32),
        ("measured", c_uint32),
        ("unexplained", c_uint32),
        ("before_rms", c_double),
        ("ring_end", c_double * 5),
    ]


class Notice(Structure):
    _fields_ = [
        ("severity", c_uint32),
        ("reserved", c_uint32),
        ("item", c_char_p),
        ("text", c_char_p),
    ]


OnStep = CFUNCTYPE(c_int, c_char_p, c_double, c_char_p, c_void_p)


OnNotice = CFUNCTYPE(None, POINTER(Notice), c_void_p)


class Events(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("user", c_void_p),
        ("progress", OnStep),
        ("notice", OnNotice),
    ]


class Picture(Structure):
    """Opaque."""


class PictureInfo(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("sample", c_uint32),
        ("layout", c_uint32),
        ("reduction", c_uint32),
        ("read_width", c_uint32),
        ("read_height", c_uint32),
        ("orientation", c_uint32),
        ("icc_bytes", c_uint64),
    ]


class PictureMetadata(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("is_corrected", c_uint32),
        ("key", ProfileKey),
        ("exposure_time_s", c_double),
        ("iso", c_double),
        ("f_number", c_double),
        ("ev", c_double),
        ("captured", c_char * 40),
    ]


class PictureOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("jpeg_quality", c_uint32),
        ("like", POINTER(Picture)),
        ("metadata", POINTER(PictureMetadata)),
    ]


class Scene(Structure):
    """Opaque."""


class SceneOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("one_lens", c_uint32),
        ("images", c_char_p),
        ("image_list", c_char_p),
    ]


class SceneInfo(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("images", c_uint32),
        ("left_out", c_uint32),
        ("matches", c_uint32),
        ("reference", c_uint32),
        ("is_reconstruction", c_uint32),
        ("links", c_uint32),
    ]


class SceneLink(Structure):
    _fields_ = [
        ("image", c_uint32 * 2),
        ("points", c_uint32),
        ("fits_cameras", c_uint32),
    ]


class Calibration(Structure):
    """Opaque."""


class CalibrateOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("method", c_uint32),
        ("modes", c_uint32),
        ("loss", c_uint32),
        ("falloff_curves", c_uint32),
        ("gamma_from", c_uint32),
        ("free", c_uint32),
        ("pairs", c_uint32),
        ("seed", c_uint32),
        ("max_side", c_uint32),
        ("one_lens", c_uint32),
        ("use_stored", c_uint32),
        ("prior_weight", c_double),
        ("exif_sigma", c_double),
        ("databases", POINTER(c_char_p)),
        ("database_count", c_uint32),
        ("reserved", c_uint32),
        ("camera_kind", c_uint32),
        ("sampling", c_uint32),
        ("huber_levels", c_double),
        ("reference", c_char_p),
        ("key", POINTER(ProfileKey)),
    ]


class CalibrationInfo(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("images", c_uint32),
        ("profiles", c_uint32),
        ("findings", c_uint32),
        ("usable", c_uint32),
        ("equalizes", c_uint32),
    ]


class Copy(Structure):
    _fields_ = [
        ("source", c_char_p),
        ("target", c_char_p),
    ]


class CorrectOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("exposure", c_uint32),
        ("linear", c_uint32),
        ("overwrite", c_uint32),
        ("threads", c_uint32),
        ("force_falloff", c_uint32),
        ("strength", c_double),
        ("databases", POINTER(c_char_p)),
        ("database_count", c_uint32),
        ("reserved", c_uint32),
        ("gain_cap", c_double),
        ("simulate", c_uint32),
        ("dither", c_uint32),
        ("chroma", c_uint32),
        ("reserved2", c_uint32),
    ]


class FolderOptions(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("one_lens", c_uint32),
        ("no_store", c_uint32),
        ("overwrite", c_uint32),
        ("threads", c_uint32),
        ("database_count", c_uint32),
        ("databases", POINTER(c_char_p)),
    ]


class FolderResult(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("found", c_uint32),
        ("panoramas", c_uint32),
        ("fitted", c_uint32),
        ("corrected", c_uint32),
        ("written", c_uint32),
        ("left_out", c_uint32),
        ("reserved", c_uint32),
    ]


# Prefix in C of the members of each enumeration.
ENUMS = {
    "LENSPROF_": Status,
    "LENSPROF_ITEM_": ItemKind,
    "LENSPROF_RESPONSE_": ResponseKind,
    "LENSPROF_CAMERA_": CameraKind,
    "LENSPROF_PROCESSING_": Processing,
    "LENSPROF_PACK_": Pack,
    "LENSPROF_SAMPLE_": SampleType,
    "LENSPROF_LAYOUT_": Layout,
    "LENSPROF_DIRECTION_": Direction,
    "LENSPROF_ENCODING_": Encoding,
    "LENSPROF_SATURATED_": Saturated,
    "LENSPROF_FRAME_": DeflickerState,
    "LENSPROF_TO_": DeflickerTo,
    "LENSPROF_EXPOSURE_": ExposureState,
    "LENSPROF_REASON_": Reason,
    "LENSPROF_SEVERITY_": Severity,
    "LENSPROF_PROJECTION_": Projection,
    "LENSPROF_SAMPLING_": Sampling,
    "LENSPROF_LINK_": LinkState,
    "LENSPROF_METHOD_": Method,
    "LENSPROF_LOSS_": Loss,
    "LENSPROF_GAMMA_": GammaFrom,
    "LENSPROF_FIT_RESPONSE_": FitResponse,
    "LENSPROF_FIT_MODEL_": FitModel,
    "LENSPROF_PROFILE_PRIOR_": ProfilePrior,
    "LENSPROF_FLAT_LIGHT_": FlatLight,
    "LENSPROF_FLAT_GRID_": FlatGrid,
    "LENSPROF_CURVE_": CurveKind,
    "LENSPROF_MAP_": MapSense,
    "LENSPROF_DNG_": DngForm,
    "LENSPROF_FORMAT_": Format,
    "LENSPROF_HOLDS_": Holds,
    "LENSPROF_ONLINE_": OnlineState,
    "LENSPROF_ONLINE_KNOWS_": OnlineKnown,
    "LENSPROF_PACKING_": Packing,
    "LENSPROF_FLIP_": Flip,
    "LENSPROF_STORE_": StoreMode,
    "LENSPROF_DISTANCE_": DistanceRule,
    "LENSPROF_RESPONSE_FROM_": ResponseFrom,
    "LENSPROF_NAMES_": StoreNames,
    "LENSPROF_TRIAL_RESPONSE_": TrialResponse,
    "LENSPROF_TRIAL_CORNERS_": TrialCorners,
    "LENSPROF_COPY_EXPOSURE_": CopyExposure,
    "LENSPROF_FREE_": Free,
}

STRUCTS = {
    "lensprof_item": Item,
    "lensprof_error": ErrorText,
    "lensprof_response": Response,
    "lensprof_vignetting": Vignetting,
    "lensprof_gain_grid": GainGrid,
    "lensprof_levels": Levels,
    "lensprof_image_circle": ImageCircle,
    "lensprof_exposure": Exposure,
    "lensprof_profile_key": ProfileKey,
    "lensprof_camera_model": CameraModel,
    "lensprof_provenance": Provenance,
    "lensprof_profile": Profile,
    "lensprof_image": Image,
    "lensprof_target": Target,
    "lensprof_apply_options": ApplyOptions,
    "lensprof_deflicker_options": DeflickerOptions,
    "lensprof_deflicker_facts": DeflickerFacts,
    "lensprof_deflicker_frame": DeflickerFrame,
    "lensprof_deflicker_result": DeflickerResult,
    "lensprof_deflicker_target": DeflickerTarget,
    "lensprof_exposure_settings": ExposureSettings,
    "lensprof_known_exposure": KnownExposure,
    "lensprof_exposures_info": ExposuresInfo,
    "lensprof_exposures_camera": ExposuresCamera,
    "lensprof_exposures_lens": ExposuresLens,
    "lensprof_exposures_image": ExposuresImage,
    "lensprof_finding": Finding,
    "lensprof_fields_options": FieldsOptions,
    "lensprof_fields_image": FieldsImage,
    "lensprof_fields_smoothness": FieldsSmoothness,
    "lensprof_fields_channel": FieldsChannel,
    "lensprof_fields_result": FieldsResult,
    "lensprof_camera": Camera,
    "lensprof_pair": Pair,
    "lensprof_observation": Observation,
    "lensprof_sample_image": SampleImage,
    "lensprof_link": Link,
    "lensprof_sample_options": SampleOptions,
    "lensprof_match": Match,
    "lensprof_fit_image": FitImage,
    "lensprof_fit_options": FitOptions,
    "lensprof_fit_image_quality": FitImageQuality,
    "lensprof_fit_result": FitResult,
    "lensprof_fit_camera": FitCamera,
    "lensprof_flat_image": FlatImage,
    "lensprof_flat_options": FlatOptions,
    "lensprof_flat_image_quality": FlatImageQuality,
    "lensprof_flat_spot": FlatSpot,
    "lensprof_flat_result": FlatResult,
    "lensprof_pto_image": PtoImage,
    "lensprof_import_entry": ImportEntry,
    "lensprof_map": Map,
    "lensprof_format_info": FormatInfo,
    "lensprof_import_options": ImportOptions,
    "lensprof_export_options": ExportOptions,
    "lensprof_online_options": OnlineOptions,
    "lensprof_online_observation": OnlineObservation,
    "lensprof_online_frame": OnlineFrame,
    "lensprof_online_exposure": OnlineExposure,
    "lensprof_online_result": OnlineResult,
    "lensprof_packed_image": PackedImage,
    "lensprof_packed_target": PackedTarget,
    "lensprof_rendering_shot": RenderingShot,
    "lensprof_rendering_result": RenderingResult,
    "lensprof_sensor_levels": SensorLevels,
    "lensprof_readout": Readout,
    "lensprof_lookup_options": LookupOptions,
    "lensprof_lookup": Lookup,
    "lensprof_store_row": StoreRow,
    "lensprof_store_fault": StoreFault,
    "lensprof_store_group": StoreGroup,
    "lensprof_store_stats": StoreStats,
    "lensprof_store_summary": StoreSummary,
    "lensprof_trial_options": TrialOptions,
    "lensprof_trial_candidate": TrialCandidate,
    "lensprof_trial_result": TrialResult,
    "lensprof_notice": Notice,
    "lensprof_events": Events,
    "lensprof_picture_info": PictureInfo,
    "lensprof_picture_metadata": PictureMetadata,
    "lensprof_picture_options": PictureOptions,
    "lensprof_scene_options": SceneOptions,
    "lensprof_scene_info": SceneInfo,
    "lensprof_scene_link": SceneLink,
    "lensprof_calibrate_options": CalibrateOptions,
    "lensprof_calibration_info": CalibrationInfo,
    "lensprof_copy": Copy,
    "lensprof_correct_options": CorrectOptions,
    "lensprof_folder_options": FolderOptions,
    "lensprof_folder_result": FolderResult,
}

OPAQUE = {
    "lensprof_plan": Plan,
    "lensprof_deflicker": Deflicker,
    "lensprof_exposures": Exposures,
    "lensprof_fields": Fields,
    "lensprof_fit": Fit,
    "lensprof_fixed_plan": FixedPlan,
    "lensprof_flat": Flat,
    "lensprof_pto": Pto,
    "lensprof_online": Online,
    "lensprof_rendering": Rendering,
    "lensprof_sensor_plan": SensorPlan,
    "lensprof_sensor_flat": SensorFlat,
    "lensprof_store": Store,
    "lensprof_picture": Picture,
    "lensprof_scene": Scene,
    "lensprof_calibration": Calibration,
}

CALLBACKS = {
    "lensprof_progress": Progress,
    "lensprof_import_visitor": ImportVisitor,
    "lensprof_camera_visitor": CameraVisitor,
    "lensprof_fault_visitor": FaultVisitor,
    "lensprof_on_step": OnStep,
    "lensprof_on_notice": OnNotice,
}

# The function that sets a structure's defaults, and the types whose sizes it takes.
INITS: dict[type[Structure], tuple[str, list[type[Structure]]]] = {
    GainGrid: ("lensprof_gain_grid_init", []),
    Exposure: ("lensprof_exposure_init", []),
    ProfileKey: ("lensprof_profile_key_init", []),
    CameraModel: ("lensprof_camera_model_init", []),
    Profile: ("lensprof_profile_init_sized", [Profile]),
    ApplyOptions: ("lensprof_apply_options_init_sized", [ApplyOptions]),
    DeflickerOptions: ("lensprof_deflicker_options_init_sized", [DeflickerOptions]),
    DeflickerFacts: ("lensprof_deflicker_facts_init_sized", [DeflickerFacts]),
    DeflickerFrame: ("lensprof_init_sized", [DeflickerFrame]),
    DeflickerResult: ("lensprof_init_sized", [DeflickerResult]),
    DeflickerTarget: ("lensprof_deflicker_target_init_sized", [DeflickerTarget]),
    ExposuresInfo: ("lensprof_init_sized", [ExposuresInfo]),
    ExposuresCamera: ("lensprof_exposures_camera_init_sized", [ExposuresCamera]),
    ExposuresLens: ("lensprof_exposures_lens_init_sized", [ExposuresLens]),
    ExposuresImage: ("lensprof_exposures_image_init_sized", [ExposuresImage]),
    Finding: ("lensprof_init_sized", [Finding]),
    FieldsOptions: ("lensprof_fields_options_init_sized", [FieldsOptions]),
    FieldsImage: ("lensprof_init_sized", [FieldsImage]),
    FieldsResult: ("lensprof_init_sized", [FieldsResult]),
    SampleImage: ("lensprof_sample_image_init_sized", [SampleImage]),
    SampleOptions: ("lensprof_sample_options_init_sized", [SampleOptions]),
    FitOptions: ("lensprof_fit_options_init_sized", [FitOptions]),
    FitImageQuality: ("lensprof_init_sized", [FitImageQuality]),
    FitResult: ("lensprof_init_sized", [FitResult]),
    FitCamera: ("lensprof_init_sized", [FitCamera]),
    FlatImage: ("lensprof_flat_image_init_sized", [FlatImage]),
    FlatOptions: ("lensprof_flat_options_init_sized", [FlatOptions]),
    FlatImageQuality: ("lensprof_init_sized", [FlatImageQuality]),
    FlatResult: ("lensprof_init_sized", [FlatResult]),
    PtoImage: ("lensprof_init_sized", [PtoImage]),
    ImportOptions: ("lensprof_import_options_init_sized", [ImportOptions]),
    ExportOptions: ("lensprof_export_options_init_sized", [ExportOptions]),
    OnlineOptions: ("lensprof_online_options_init_sized", [OnlineOptions]),
    OnlineFrame: ("lensprof_online_frame_init_sized", [OnlineFrame]),
    OnlineExposure: ("lensprof_online_exposure_init_sized", [OnlineExposure]),
    OnlineResult: ("lensprof_online_result_init_sized", [OnlineResult]),
    RenderingShot: ("lensprof_init_sized", [RenderingShot]),
    RenderingResult: ("lensprof_init_sized", [RenderingResult]),
    Readout: ("lensprof_readout_init_sized", [Readout]),
    LookupOptions: ("lensprof_init_sized", [LookupOptions]),
    Lookup: ("lensprof_init_sized", [Lookup]),
    StoreStats: ("lensprof_init_sized", [StoreStats]),
    TrialOptions: ("lensprof_trial_options_init_sized", [TrialOptions]),
    TrialCandidate: ("lensprof_init_sized", [TrialCandidate]),
    TrialResult: ("lensprof_init_sized", [TrialResult]),
    Events: ("lensprof_init_sized", [Events]),
    PictureInfo: ("lensprof_init_sized", [PictureInfo]),
    PictureMetadata: ("lensprof_picture_metadata_init_sized", [PictureMetadata]),
    PictureOptions: ("lensprof_init_sized", [PictureOptions]),
    SceneOptions: ("lensprof_init_sized", [SceneOptions]),
    SceneInfo: ("lensprof_init_sized", [SceneInfo]),
    CalibrateOptions: ("lensprof_calibrate_options_init_sized", [CalibrateOptions]),
    CalibrationInfo: ("lensprof_init_sized", [CalibrationInfo]),
    CorrectOptions: ("lensprof_correct_options_init_sized", [CorrectOptions]),
    FolderOptions: ("lensprof_init_sized", [FolderOptions]),
    FolderResult: ("lensprof_init_sized", [FolderResult]),
}

# name: (restype, argtypes)
FUNCTIONS = {
    # base.h
    "lensprof_status_name": (c_char_p, [c_int]),
    "lensprof_init_sized": (None, [c_void_p, c_size_t]),
    "lensprof_version": (c_char_p, []),
    # model.h
    "lensprof_response_set_linear": (None, [POINTER(Response)]),
    "lensprof_response_set_gamma": (c_int, [POINTER(Response), c_double]),
    "lensprof_response_set_srgb": (None, [POINTER(Response)]),
    "lensprof_response_set_emor": (c_int, [POINTER(Response), POINTER(c_double), c_uint32]),
    "lensprof_response_set_table": (c_int, [POINTER(Response), POINTER(c_double), c_uint32]),
    "lensprof_response_validate": (c_int, [POINTER(Response)]),
    "lensprof_response_eval": (c_double, [POINTER(Response), c_double, POINTER(c_double)]),
    "lensprof_response_invert": (c_double, [POINTER(Response), c_double, POINTER(c_double)]),
    "lensprof_response_eval_many": (None, [POINTER(Response), POINTER(c_double), c_size_t, POINTER(c_double),
                                           POINTER(c_double)]),
    "lensprof_response_invert_many": (None, [POINTER(Response), POINTER(c_double), c_size_t, POINTER(c_double),
                                             POINTER(c_double)]),
    "lensprof_response_set_typical": (c_int, [POINTER(Response), c_uint32, POINTER(c_double), POINTER(c_double)]),
    "lensprof_emor_table": (POINTER(c_double), [c_uint32]),
    "lensprof_half_diagonal": (c_double, [c_uint32, c_uint32]),
    "lensprof_vignetting_eval": (c_double, [POINTER(Vignetting), c_double, POINTER(c_double)]),
    "lensprof_vignetting_eval_many": (None, [POINTER(Vignetting), POINTER(c_double), c_size_t, POINTER(c_double),
                                             POINTER(c_double)]),
    "lensprof_vignetting_r2": (c_double, [POINTER(Vignetting), c_uint32, c_uint32, c_double, c_double,
                                          POINTER(c_double)]),
    "lensprof_vignetting_r2_many": (None, [POINTER(Vignetting), c_uint32, c_uint32, POINTER(c_double), c_size_t,
                                           POINTER(c_double), POINTER(c_double)]),
    "lensprof_vignetting_validate": (c_int, [POINTER(Vignetting)]),
    "lensprof_gain_grid_init": (None, [POINTER(GainGrid)]),
    "lensprof_gain_grid_validate": (c_int, [POINTER(GainGrid)]),
    "lensprof_gain_grid_eval": (c_double, [POINTER(GainGrid), c_uint32, c_uint32, c_double, c_double, c_uint32]),
    "lensprof_gain_grid_eval_many": (None, [POINTER(GainGrid), c_uint32, c_uint32, POINTER(c_double), c_size_t,
                                            c_uint32, POINTER(c_double)]),
    "lensprof_levels_validate": (c_int, [POINTER(Levels)]),
    "lensprof_levels_to_value": (c_double, [POINTER(Levels), c_uint32, c_double]),
    "lensprof_levels_to_sample": (c_double, [POINTER(Levels), c_uint32, c_double]),
    "lensprof_image_circle_validate": (c_int, [POINTER(ImageCircle)]),
    "lensprof_image_circle_contains": (c_int, [POINTER(ImageCircle), c_uint32, c_uint32, c_double, c_double]),
    "lensprof_exposure_init": (None, [POINTER(Exposure)]),
    "lensprof_exposure_validate": (c_int, [POINTER(Exposure)]),
    "lensprof_exposure_mean": (None, [POINTER(Exposure), c_size_t, POINTER(Exposure)]),
    # profile.h
    "lensprof_profile_key_init": (None, [POINTER(ProfileKey)]),
    "lensprof_profile_key_validate": (c_int, [POINTER(ProfileKey)]),
    "lensprof_camera_kind_of": (c_uint32, [POINTER(ProfileKey)]),
    "lensprof_camera_model_init": (None, [POINTER(CameraModel)]),
    "lensprof_profile_init_sized": (None, [POINTER(Profile), c_size_t]),
    "lensprof_profile_copy": (c_int, [POINTER(Profile), POINTER(Profile)]),
    "lensprof_profile_validate": (c_int, [POINTER(Profile)]),
    "lensprof_profile_falloff": (c_double, [POINTER(Profile), c_uint32, c_uint32, c_uint32, c_double, c_double,
                                            POINTER(c_double)]),
    "lensprof_profile_radial_falloff": (c_double, [POINTER(Profile), c_uint32, c_double, POINTER(c_double)]),
    "lensprof_profile_pack": (c_int, [POINTER(Profile), c_uint32, c_void_p, c_size_t, POINTER(c_size_t)]),
    "lensprof_profile_unpack": (c_int, [c_void_p, c_size_t, POINTER(Profile)]),
    # apply.h
    "lensprof_layout_samples": (c_uint32, [c_uint32]),
    "lensprof_layout_channels": (c_uint32, [c_uint32]),
    "lensprof_sample_type_bytes": (c_uint32, [c_uint32]),
    "lensprof_image_validate": (c_int, [POINTER(Image)]),
    "lensprof_apply_options_init_sized": (None, [POINTER(ApplyOptions), c_size_t]),
    "lensprof_apply_options_set_profile": (c_int, [POINTER(ApplyOptions), POINTER(Profile)]),
    "lensprof_plan_bytes": (c_size_t, [POINTER(ApplyOptions)]),
    "lensprof_plan_init": (c_int, [c_void_p, c_size_t, POINTER(ApplyOptions), POINTER(POINTER(Plan)),
                                   POINTER(ErrorText)]),
    "lensprof_apply": (c_int, [POINTER(Plan), POINTER(Image), POINTER(Target), c_uint32, c_uint32]),
    "lensprof_apply_planar": (c_int, [POINTER(Plan), POINTER(Image), POINTER(Target), c_uint32, c_uint32]),
    # deflicker.h
    "lensprof_deflicker_options_init_sized": (None, [POINTER(DeflickerOptions), c_size_t]),
    "lensprof_deflicker_facts_init_sized": (None, [POINTER(DeflickerFacts), c_size_t]),
    "lensprof_deflicker_target_init_sized": (None, [POINTER(DeflickerTarget), c_size_t]),
    "lensprof_deflicker_create": (c_int, [POINTER(DeflickerOptions), POINTER(POINTER(Deflicker)), POINTER(ErrorText)]),
    "lensprof_deflicker_destroy": (None, [POINTER(Deflicker)]),
    "lensprof_deflicker_add": (c_int, [POINTER(Deflicker), POINTER(Image), POINTER(DeflickerFacts),
                                       POINTER(ErrorText)]),
    "lensprof_deflicker_measure": (c_int, [POINTER(Deflicker), POINTER(DeflickerResult), POINTER(ErrorText)]),
    "lensprof_deflicker_frame_at": (c_int, [POINTER(Deflicker), c_uint32, POINTER(DeflickerFrame), POINTER(ErrorText)]),
    "lensprof_deflicker_curve": (c_int, [POINTER(Deflicker), POINTER(DeflickerTarget), POINTER(Exposure), c_uint32,
                                         POINTER(c_double), POINTER(ErrorText)]),
    "lensprof_deflicker_shading": (c_int, [POINTER(Deflicker), c_uint32, POINTER(GainGrid), POINTER(ErrorText)]),
    # exposure_settings.h
    "lensprof_settings_ev": (c_double, [c_double, c_double, c_double]),
    "lensprof_known_exposures": (c_int, [POINTER(ExposureSettings), c_uint32, POINTER(KnownExposure),
                                         POINTER(ErrorText)]),
    # exposures.h
    "lensprof_exposures_camera_init_sized": (None, [POINTER(ExposuresCamera), c_size_t]),
    "lensprof_exposures_lens_init_sized": (None, [POINTER(ExposuresLens), c_size_t]),
    "lensprof_exposures_image_init_sized": (None, [POINTER(ExposuresImage), c_size_t]),
    "lensprof_exposures_read": (c_int, [c_void_p, c_size_t, POINTER(POINTER(Exposures)), POINTER(ErrorText)]),
    "lensprof_exposures_destroy": (None, [POINTER(Exposures)]),
    "lensprof_exposures_get_info": (c_int, [POINTER(Exposures), POINTER(ExposuresInfo), POINTER(ErrorText)]),
    "lensprof_exposures_get_camera": (c_int, [POINTER(Exposures), c_uint32, POINTER(ExposuresCamera),
                                              POINTER(ErrorText)]),
    "lensprof_exposures_get_lens": (c_int, [POINTER(Exposures), c_uint32, POINTER(ExposuresLens), POINTER(ErrorText)]),
    "lensprof_exposures_get_image": (c_int, [POINTER(Exposures), c_uint32, POINTER(ExposuresImage),
                                             POINTER(ErrorText)]),
    "lensprof_exposures_write": (c_int, [POINTER(ExposuresInfo), POINTER(ExposuresCamera), POINTER(ExposuresLens),
                                         POINTER(ExposuresImage), c_void_p, c_size_t, POINTER(c_size_t),
                                         POINTER(ErrorText)]),
    # reason.h
    "lensprof_reason_name": (c_char_p, [c_uint32]),
    "lensprof_reason_text": (c_char_p, [c_uint32]),
    # fields.h
    "lensprof_fields_options_init_sized": (None, [POINTER(FieldsOptions), c_size_t]),
    "lensprof_fields_create": (c_int, [POINTER(FieldsOptions), POINTER(POINTER(Fields)), POINTER(ErrorText)]),
    "lensprof_fields_destroy": (None, [POINTER(Fields)]),
    "lensprof_fields_add": (c_int, [POINTER(Fields), POINTER(Image), POINTER(c_uint8), c_ssize_t, POINTER(ErrorText)]),
    "lensprof_fields_fit": (c_int, [POINTER(Fields), POINTER(ErrorText)]),
    "lensprof_fields_get": (c_int, [POINTER(Fields), POINTER(FieldsResult), POINTER(ErrorText)]),
    "lensprof_fields_image_at": (c_int, [POINTER(Fields), c_uint32, POINTER(FieldsImage), POINTER(ErrorText)]),
    "lensprof_fields_smoothness_at": (c_int, [POINTER(Fields), c_uint32, c_uint32, POINTER(FieldsSmoothness),
                                              POINTER(ErrorText)]),
    "lensprof_fields_finding_at": (c_int, [POINTER(Fields), c_uint32, POINTER(Finding), POINTER(ErrorText)]),
    "lensprof_fields_profile": (c_int, [POINTER(Fields), POINTER(Profile), POINTER(ErrorText)]),
    # geometry.h
    "lensprof_camera_validate": (c_int, [POINTER(Camera)]),
    "lensprof_camera_project": (c_int, [POINTER(Camera), c_double, c_double, POINTER(c_double)]),
    "lensprof_camera_unproject": (c_int, [POINTER(Camera), c_double, c_double, POINTER(c_double)]),
    "lensprof_camera_project_many": (c_size_t, [POINTER(Camera), POINTER(c_double), c_size_t, POINTER(c_double)]),
    "lensprof_camera_unproject_many": (c_size_t, [POINTER(Camera), POINTER(c_double), c_size_t, POINTER(c_double)]),
    # sample.h
    "lensprof_sample_image_init_sized": (None, [POINTER(SampleImage), c_size_t]),
    "lensprof_sample_options_init_sized": (None, [POINTER(SampleOptions), c_size_t]),
    "lensprof_sample_overlap": (c_int, [POINTER(SampleOptions), POINTER(SampleImage), c_uint32, POINTER(Pair), c_uint32,
                                        POINTER(c_uint32), POINTER(ErrorText)]),
    "lensprof_sample_tracks": (c_int, [POINTER(SampleOptions), POINTER(SampleImage), c_uint32, POINTER(Observation),
                                       c_uint32, POINTER(c_uint32), POINTER(ErrorText)]),
    "lensprof_sample_matches": (c_int, [POINTER(SampleOptions), POINTER(SampleImage), c_uint32, POINTER(Match),
                                        c_uint32, POINTER(Pair), c_uint32, POINTER(c_uint32), POINTER(ErrorText)]),
    # fit.h
    "lensprof_fit_image_init_sized": (None, [POINTER(FitImage), c_size_t, c_uint32, c_uint32, c_uint32]),
    "lensprof_fit_options_init_sized": (None, [POINTER(FitOptions), c_size_t]),
    "lensprof_fit_bytes": (c_size_t, [POINTER(FitImage), c_uint32]),
    "lensprof_fit_overlap": (c_int, [POINTER(FitOptions), POINTER(FitImage), c_uint32, POINTER(Pair), c_uint32,
                                     c_void_p, c_size_t, POINTER(Exposure), POINTER(POINTER(Fit)), POINTER(ErrorText)]),
    "lensprof_fit_radiance": (c_int, [POINTER(FitOptions), POINTER(FitImage), c_uint32, POINTER(Observation), c_uint32,
                                      c_void_p, c_size_t, POINTER(Exposure), POINTER(POINTER(Fit)),
                                      POINTER(ErrorText)]),
    "lensprof_fit_destroy": (None, [POINTER(Fit)]),
    "lensprof_fit_image_at": (c_int, [POINTER(Fit), c_uint32, POINTER(FitImageQuality), POINTER(ErrorText)]),
    "lensprof_fit_setting_at": (c_int, [POINTER(Fit), c_uint32, POINTER(FitResult), POINTER(ErrorText)]),
    "lensprof_fit_camera_at": (c_int, [POINTER(Fit), c_uint32, POINTER(FitCamera), POINTER(ErrorText)]),
    "lensprof_fit_finding_at": (c_int, [POINTER(Fit), c_uint32, c_uint32, POINTER(Finding), POINTER(ErrorText)]),
    "lensprof_fit_profile": (c_int, [POINTER(Fit), c_uint32, POINTER(Profile), POINTER(ErrorText)]),
    "lensprof_fit_transfer_rms": (c_int, [POINTER(Fit), POINTER(Pair), c_uint32, POINTER(c_double), POINTER(c_double),
                                          POINTER(ErrorText)]),
    "lensprof_fit_colour_differences": (c_int, [POINTER(Fit), POINTER(Pair), c_uint32, POINTER(c_double),
                                                POINTER(ErrorText)]),
    # fixed.h
    "lensprof_fixed_plan_bytes": (c_size_t, [POINTER(ApplyOptions)]),
    "lensprof_fixed_plan_init": (c_int, [c_void_p, c_size_t, POINTER(ApplyOptions), POINTER(POINTER(FixedPlan)),
                                         POINTER(ErrorText)]),
    "lensprof_fixed_plan_open": (c_int, [c_void_p, c_size_t, POINTER(POINTER(FixedPlan))]),
    "lensprof_fixed_apply": (c_int, [POINTER(FixedPlan), POINTER(Image), POINTER(Target), c_uint32, c_uint32]),
    # flat.h
    "lensprof_flat_image_init_sized": (None, [POINTER(FlatImage), c_size_t]),
    "lensprof_flat_options_init_sized": (None, [POINTER(FlatOptions), c_size_t]),
    "lensprof_flat_bytes": (c_size_t, [c_uint32]),
    "lensprof_fit_flat": (c_int, [POINTER(FlatOptions), POINTER(FlatImage), c_uint32, c_void_p, c_size_t,
                                  POINTER(POINTER(Flat)), POINTER(ErrorText)]),
    "lensprof_flat_destroy": (None, [POINTER(Flat)]),
    "lensprof_flat_get": (c_int, [POINTER(Flat), POINTER(FlatResult), POINTER(ErrorText)]),
    "lensprof_flat_image_at": (c_int, [POINTER(Flat), c_uint32, POINTER(FlatImageQuality), POINTER(ErrorText)]),
    "lensprof_flat_finding_at": (c_int, [POINTER(Flat), c_uint32, POINTER(Finding), POINTER(ErrorText)]),
    "lensprof_flat_profile": (c_int, [POINTER(Flat), POINTER(Profile), POINTER(ErrorText)]),
    # hugin.h
    "lensprof_pto_read": (c_int, [c_void_p, c_size_t, POINTER(POINTER(Pto)), POINTER(ErrorText)]),
    "lensprof_pto_destroy": (None, [POINTER(Pto)]),
    "lensprof_pto_image_count": (c_uint32, [POINTER(Pto)]),
    "lensprof_pto_get_image": (c_int, [POINTER(Pto), c_uint32, POINTER(PtoImage), POINTER(ErrorText)]),
    "lensprof_pto_get_response": (c_int, [POINTER(Pto), c_uint32, POINTER(Response), POINTER(ErrorText)]),
    "lensprof_pto_get_name": (c_int, [POINTER(Pto), c_uint32, c_char_p, c_size_t, POINTER(c_size_t),
                                      POINTER(ErrorText)]),
    "lensprof_pto_set_name": (c_int, [POINTER(Pto), c_uint32, c_char_p, POINTER(ErrorText)]),
    "lensprof_pto_draw_mask": (c_int, [POINTER(Pto), c_uint32, POINTER(c_uint8), c_uint32, c_uint32, c_ssize_t,
                                       POINTER(ErrorText)]),
    "lensprof_pto_set_result": (c_int, [POINTER(Pto), POINTER(Response), POINTER(Vignetting), POINTER(Exposure),
                                        c_uint32, c_uint32, POINTER(ErrorText)]),
    "lensprof_pto_set_settings": (c_int, [POINTER(Pto), POINTER(c_uint32), c_uint32, POINTER(Vignetting), c_uint32,
                                          POINTER(ErrorText)]),
    "lensprof_pto_set_cameras": (c_int, [POINTER(Pto), POINTER(c_uint32), c_uint32, POINTER(Response), c_uint32,
                                         POINTER(ErrorText)]),
    "lensprof_pto_write": (c_int, [POINTER(Pto), c_void_p, c_size_t, POINTER(c_size_t), POINTER(ErrorText)]),
    "lensprof_points_read": (c_int, [c_void_p, c_size_t, POINTER(Pair), c_uint32, POINTER(c_uint32),
                                     POINTER(ErrorText)]),
    "lensprof_points_write": (c_int, [POINTER(Pair), c_uint32, POINTER(Camera), c_uint32, c_void_p, c_size_t,
                                      POINTER(c_size_t), POINTER(ErrorText)]),
    # formats.h
    "lensprof_lensfun_read_cameras": (c_int, [c_void_p, c_size_t, c_char_p, CameraVisitor, c_void_p,
                                              POINTER(ErrorText)]),
    "lensprof_map_write": (c_int, [POINTER(Profile), c_uint32, c_uint32, c_uint32, c_uint32, c_uint32, c_uint32,
                                   POINTER(c_float), POINTER(ErrorText)]),
    "lensprof_format_get_info": (POINTER(FormatInfo), [c_uint32]),
    "lensprof_format_detect": (c_uint32, [c_void_p, c_size_t, c_char_p]),
    "lensprof_import_options_init_sized": (None, [POINTER(ImportOptions), c_size_t]),
    "lensprof_import": (c_int, [c_void_p, c_size_t, POINTER(ImportOptions), ImportVisitor, c_void_p,
                                POINTER(ErrorText)]),
    "lensprof_export_options_init_sized": (None, [POINTER(ExportOptions), c_size_t]),
    "lensprof_export": (c_int, [POINTER(POINTER(Profile)), c_uint32, POINTER(ExportOptions), c_void_p, c_size_t,
                                POINTER(c_size_t), POINTER(ErrorText)]),
    # online.h
    "lensprof_online_options_init_sized": (None, [POINTER(OnlineOptions), c_size_t]),
    "lensprof_online_frame_init_sized": (None, [POINTER(OnlineFrame), c_size_t]),
    "lensprof_online_exposure_init_sized": (None, [POINTER(OnlineExposure), c_size_t]),
    "lensprof_online_result_init_sized": (None, [POINTER(OnlineResult), c_size_t]),
    "lensprof_online_bytes": (c_size_t, [POINTER(OnlineOptions)]),
    "lensprof_online_begin": (c_int, [c_void_p, c_size_t, POINTER(OnlineOptions), POINTER(POINTER(Online)),
                                      POINTER(ErrorText)]),
    "lensprof_online_add": (c_int, [POINTER(Online), POINTER(OnlineFrame), POINTER(OnlineExposure),
                                    POINTER(ErrorText)]),
    "lensprof_online_solve": (c_int, [POINTER(Online), c_uint32, POINTER(c_uint32), POINTER(ErrorText)]),
    "lensprof_online_exposure_at": (c_int, [POINTER(Online), c_uint64, POINTER(OnlineExposure), POINTER(ErrorText)]),
    "lensprof_online_get": (c_int, [POINTER(Online), POINTER(OnlineResult), POINTER(ErrorText)]),
    "lensprof_online_profile": (c_int, [POINTER(Online), POINTER(Profile), POINTER(ErrorText)]),
    # packed.h
    "lensprof_packed_row_bytes": (c_size_t, [c_uint32, c_uint32]),
    "lensprof_unpack_row": (c_int, [c_uint32, POINTER(c_uint8), c_uint32, POINTER(c_uint16)]),
    "lensprof_pack_row": (c_int, [c_uint32, POINTER(c_uint16), c_uint32, POINTER(c_uint8)]),
    "lensprof_apply_packed": (c_int, [POINTER(Plan), c_uint32, POINTER(PackedImage), POINTER(PackedTarget), c_uint32,
                                      c_uint32]),
    "lensprof_fixed_apply_packed": (c_int, [POINTER(FixedPlan), c_uint32, POINTER(PackedImage), POINTER(PackedTarget),
                                            c_uint32, c_uint32]),
    # rendering.h
    "lensprof_rendering_create": (c_int, [POINTER(Response), Progress, c_void_p, POINTER(POINTER(Rendering)),
                                          POINTER(ErrorText)]),
    "lensprof_rendering_destroy": (None, [POINTER(Rendering)]),
    "lensprof_rendering_add": (c_int, [POINTER(Rendering), POINTER(Image), POINTER(Image), POINTER(ErrorText)]),
    "lensprof_rendering_fit": (c_int, [POINTER(Rendering), POINTER(RenderingResult), POINTER(ErrorText)]),
    "lensprof_rendering_shot_at": (c_int, [POINTER(Rendering), c_uint32, POINTER(RenderingShot), POINTER(ErrorText)]),
    "lensprof_rendering_finding_at": (c_int, [POINTER(Rendering), c_uint32, POINTER(Finding), POINTER(ErrorText)]),
    # sensor.h
    "lensprof_readout_init_sized": (None, [POINTER(Readout), c_size_t]),
    "lensprof_readout_set_mosaic": (c_int, [POINTER(Readout), c_char_p]),
    "lensprof_sensor_plan_bytes": (c_size_t, [POINTER(Readout)]),
    "lensprof_sensor_plan_init": (c_int, [c_void_p, c_size_t, POINTER(ApplyOptions), POINTER(Readout),
                                          POINTER(POINTER(SensorPlan)), POINTER(ErrorText)]),
    "lensprof_sensor_plan_error": (c_int, [POINTER(SensorPlan), POINTER(ApplyOptions), POINTER(Readout),
                                           POINTER(c_double)]),
    "lensprof_sensor_plan_open": (c_int, [c_void_p, c_size_t, POINTER(POINTER(SensorPlan))]),
    "lensprof_sensor_plan_mix": (c_int, [c_void_p, c_size_t, POINTER(SensorPlan), POINTER(SensorPlan), c_uint32,
                                         POINTER(POINTER(SensorPlan))]),
    "lensprof_mired_share": (c_uint32, [c_uint32, c_uint32, c_uint32]),
    "lensprof_sensor_apply": (c_int, [POINTER(SensorPlan), POINTER(Image), POINTER(Target), c_uint32, c_uint32]),
    "lensprof_sensor_apply_packed": (c_int, [POINTER(SensorPlan), c_uint32, POINTER(PackedImage), POINTER(PackedTarget),
                                             c_uint32, c_uint32]),
    "lensprof_sensor_flat_bytes": (c_size_t, [POINTER(Readout)]),
    "lensprof_sensor_flat_init": (c_int, [c_void_p, c_size_t, c_uint32, c_uint32, POINTER(Readout),
                                          POINTER(POINTER(SensorFlat)), POINTER(ErrorText)]),
    "lensprof_sensor_flat_add": (c_int, [POINTER(SensorFlat), POINTER(Image), c_uint32, c_uint32]),
    "lensprof_sensor_flat_open": (c_int, [c_void_p, c_size_t, POINTER(POINTER(SensorFlat))]),
    "lensprof_sensor_flat_work_bytes": (c_size_t, [POINTER(SensorFlat)]),
    "lensprof_sensor_flat_gains": (c_int, [POINTER(SensorFlat), c_void_p, c_size_t, POINTER(c_float),
                                           POINTER(ErrorText)]),
    # store.h
    "lensprof_store_open": (c_int, [c_char_p, c_uint32, POINTER(POINTER(Store)), POINTER(ErrorText)]),
    "lensprof_store_close": (None, [POINTER(Store)]),
    "lensprof_store_put": (c_int, [POINTER(Store), POINTER(Profile), POINTER(c_int64), POINTER(ErrorText)]),
    "lensprof_store_find": (c_int, [POINTER(Store), POINTER(ProfileKey), POINTER(Profile), POINTER(c_int64),
                                    POINTER(ErrorText)]),
    "lensprof_store_lookup_in": (c_int, [POINTER(POINTER(Store)), c_uint32, POINTER(ProfileKey), POINTER(LookupOptions),
                                         POINTER(Profile), POINTER(Lookup), POINTER(ErrorText)]),
    "lensprof_store_begin": (c_int, [POINTER(Store), POINTER(ErrorText)]),
    "lensprof_store_commit": (c_int, [POINTER(Store), POINTER(ErrorText)]),
    "lensprof_store_rollback": (None, [POINTER(Store)]),
    "lensprof_store_get": (c_int, [POINTER(Store), c_int64, POINTER(Profile), POINTER(ErrorText)]),
    "lensprof_store_list": (c_int, [POINTER(Store), POINTER(ProfileKey), POINTER(StoreRow), c_uint32, POINTER(c_uint32),
                                    POINTER(ErrorText)]),
    "lensprof_store_find_same": (c_int, [POINTER(Store), POINTER(Profile), POINTER(c_int64), POINTER(ErrorText)]),
    "lensprof_store_merge": (c_int, [POINTER(Store), POINTER(Store), POINTER(c_uint32), POINTER(c_uint32),
                                     POINTER(ErrorText)]),
    "lensprof_store_put_camera": (c_int, [POINTER(Store), POINTER(CameraModel), POINTER(ErrorText)]),
    "lensprof_store_find_camera": (c_int, [POINTER(Store), c_char_p, c_char_p, POINTER(CameraModel),
                                           POINTER(ErrorText)]),
    "lensprof_store_list_camera_models": (c_int, [POINTER(Store), POINTER(CameraModel), c_uint32, POINTER(c_uint32),
                                                  POINTER(ErrorText)]),
    "lensprof_store_check": (c_int, [POINTER(Store), FaultVisitor, c_void_p, POINTER(c_uint32), POINTER(c_uint32),
                                     POINTER(ErrorText)]),
    "lensprof_store_get_stats": (c_int, [POINTER(Store), POINTER(StoreStats), POINTER(ErrorText)]),
    "lensprof_store_remove": (c_int, [POINTER(Store), c_int64, POINTER(ErrorText)]),
    "lensprof_store_set_key": (c_int, [POINTER(Store), c_int64, POINTER(ProfileKey), POINTER(ErrorText)]),
    "lensprof_store_list_names": (c_int, [POINTER(Store), c_uint32, c_char_p, POINTER(StoreSummary), c_uint32,
                                          POINTER(c_uint32), POINTER(ErrorText)]),
    "lensprof_correct": (c_int, [POINTER(Profile), POINTER(Exposure), POINTER(Target), POINTER(ErrorText)]),
    # trial.h
    "lensprof_trial_options_init_sized": (None, [POINTER(TrialOptions), c_size_t]),
    "lensprof_trial_run": (c_int, [POINTER(TrialOptions), POINTER(FitImage), c_uint32, POINTER(Pair), c_uint32,
                                   POINTER(POINTER(Profile)), c_uint32, POINTER(TrialCandidate), POINTER(TrialResult),
                                   POINTER(ErrorText)]),
}

# The same for liblensprof-photo.
PHOTO_FUNCTIONS = {
    # photo.h
    "lensprof_picture_metadata_init_sized": (None, [POINTER(PictureMetadata), c_size_t]),
    "lensprof_picture_open": (c_int, [c_char_p, POINTER(POINTER(Picture)), POINTER(ErrorText)]),
    "lensprof_picture_open_memory": (c_int, [c_void_p, c_size_t, POINTER(POINTER(Picture)), POINTER(ErrorText)]),
    "lensprof_picture_destroy": (None, [POINTER(Picture)]),
    "lensprof_picture_get_info": (c_int, [POINTER(Picture), c_uint32, POINTER(PictureInfo), POINTER(ErrorText)]),
    "lensprof_picture_get_metadata": (c_int, [POINTER(Picture), POINTER(PictureMetadata), POINTER(ErrorText)]),
    "lensprof_picture_get_icc": (c_int, [POINTER(Picture), c_void_p, c_size_t, POINTER(c_size_t), POINTER(ErrorText)]),
    "lensprof_picture_read": (c_int, [POINTER(Picture), c_uint32, POINTER(Target), POINTER(ErrorText)]),
    "lensprof_picture_write": (c_int, [c_char_p, POINTER(Image), POINTER(PictureOptions), POINTER(ErrorText)]),
    "lensprof_picture_encode": (c_int, [c_char_p, POINTER(Image), POINTER(PictureOptions), c_void_p, c_size_t,
                                        POINTER(c_size_t), POINTER(ErrorText)]),
    "lensprof_scene_open": (c_int, [POINTER(c_char_p), c_uint32, POINTER(SceneOptions), POINTER(Events),
                                    POINTER(POINTER(Scene)), POINTER(ErrorText)]),
    "lensprof_scene_destroy": (None, [POINTER(Scene)]),
    "lensprof_scene_get_info": (c_int, [POINTER(Scene), POINTER(SceneInfo), POINTER(ErrorText)]),
    "lensprof_scene_image_at": (c_int, [POINTER(Scene), c_uint32, POINTER(Camera), POINTER(c_char_p), POINTER(c_char_p),
                                        POINTER(ErrorText)]),
    "lensprof_scene_link_at": (c_int, [POINTER(Scene), c_uint32, POINTER(SceneLink), POINTER(ErrorText)]),
    "lensprof_scene_match_at": (c_int, [POINTER(Scene), c_uint32, POINTER(Match), POINTER(ErrorText)]),
    "lensprof_scene_left_out_at": (c_int, [POINTER(Scene), c_uint32, POINTER(c_char_p), POINTER(c_char_p),
                                           POINTER(ErrorText)]),
    "lensprof_scene_save": (c_int, [POINTER(Scene), c_char_p, POINTER(ErrorText)]),
    "lensprof_calibrate_options_init_sized": (None, [POINTER(CalibrateOptions), c_size_t]),
    "lensprof_calibrate": (c_int, [POINTER(Scene), POINTER(CalibrateOptions), POINTER(Events),
                                   POINTER(POINTER(Calibration)), POINTER(ErrorText)]),
    "lensprof_calibration_open": (c_int, [c_char_p, c_char_p, POINTER(POINTER(Calibration)), POINTER(ErrorText)]),
    "lensprof_calibration_destroy": (None, [POINTER(Calibration)]),
    "lensprof_calibration_get_fit": (POINTER(Fit), [POINTER(Calibration)]),
    "lensprof_calibration_get_info": (c_int, [POINTER(Calibration), POINTER(CalibrationInfo), POINTER(ErrorText)]),
    "lensprof_calibration_image_at": (c_int, [POINTER(Calibration), c_uint32, POINTER(c_char_p), POINTER(c_char_p),
                                              POINTER(ErrorText)]),
    "lensprof_calibration_exposure_at": (c_int, [POINTER(Calibration), c_uint32, POINTER(Exposure), POINTER(c_double),
                                                 POINTER(ErrorText)]),
    "lensprof_calibration_profile_at": (c_int, [POINTER(Calibration), c_uint32, POINTER(Profile), POINTER(ErrorText)]),
    "lensprof_calibration_finding_at": (c_int, [POINTER(Calibration), c_uint32, POINTER(Finding), POINTER(ErrorText)]),
    "lensprof_calibration_store": (c_int, [POINTER(Calibration), c_char_p, POINTER(c_uint32), POINTER(ErrorText)]),
    "lensprof_calibration_save": (c_int, [POINTER(Calibration), c_char_p, POINTER(ErrorText)]),
    "lensprof_correct_options_init_sized": (None, [POINTER(CorrectOptions), c_size_t]),
    "lensprof_correct_files": (c_int, [POINTER(Calibration), POINTER(Copy), c_uint32, POINTER(CorrectOptions),
                                       POINTER(Events), POINTER(c_uint32), POINTER(ErrorText)]),
    "lensprof_calibrate_folder": (c_int, [POINTER(c_char_p), c_uint32, c_char_p, POINTER(FolderOptions),
                                          POINTER(Events), POINTER(FolderResult), POINTER(ErrorText)]),
}
