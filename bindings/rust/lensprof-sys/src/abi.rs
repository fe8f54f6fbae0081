// Generated from include/lensprof by bindings/tools/make_abi.py: do not edit; `make abi` regenerates it.
use std::ffi::{c_char, c_int, c_void};
use std::mem::{size_of, zeroed};

/// Version of the headers.
pub const VERSION: &str = "0.3.0";

pub const RESPONSE_SAMPLES: u32 = 1024;
pub const EMOR_MODES: u32 = 25;
pub const GRID_SIDE: u32 = 32;
pub const UNKNOWN: f64 = -1.0;
pub const COVARIANCE_MAX: u32 = 36;
pub const DEFLICKER_FRAMES: u32 = 4194304;
pub const FIELDS_IMAGES: u32 = 16384;
pub const SETTINGS_MAX: u32 = 64;
pub const CAMERAS_MAX: u32 = 64;
pub const MODES_AUTO: u32 = 4294967295;
pub const COVERAGE_BINS: u32 = 10;
pub const FIT_REFERENCE: u32 = 4294967295;
pub const FLAT_IMAGES: u32 = 128;
pub const FLAT_SPOTS: u32 = 32;
pub const ONLINE_TRACKS: u32 = 8192;
pub const ONLINE_KEYFRAMES: u32 = 24;
pub const ONLINE_MODES: u32 = 8;
pub const ONLINE_HISTORY: u32 = 65536;
pub const RENDERING_SHOTS: u32 = 16;
pub const RENDERING_SIDE: u32 = 256;
pub const RENDERING_RAW_SIDE: u32 = 64;
pub const SENSOR_PLANES: u32 = 4;
pub const SENSOR_GRID_SIDE: u32 = 33;
pub const LOOKUP_ROWS: u32 = 24;
pub const LOOKUP_REASONS: u32 = 8;
pub const LOOKUP_RESPONSES: u32 = 8;
pub const LOOKUP_NEAREST: u32 = 3;
pub const STATS_GROUPS: u32 = 8;
pub const TRIAL_PAIRS: u32 = 30;
pub const TRIAL_RINGS: u32 = 5;
pub const DOUBT_RESPONSE: &str = "response not shown by the pictures: typical of the kind";

/// `lensprof_status`; see lensprof/base.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    Ok = 0,
    ErrorArgument = 1,
    ErrorStructSize = 2,
    ErrorSize = 3,
    ErrorCapacity = 4,
    ErrorNotFinite = 5,
    ErrorMemory = 10,
    ErrorCancelled = 11,
    ErrorResponse = 20,
    ErrorVignetting = 21,
    ErrorExposure = 22,
    ErrorGeometry = 23,
    ErrorNoOverlap = 30,
    ErrorNoSamples = 31,
    ErrorNoUnknowns = 32,
    ErrorNotUsable = 33,
    ErrorStore = 40,
    ErrorNotFound = 41,
    ErrorCorrupt = 42,
    ErrorLayout = 43,
    ErrorReadOnly = 44,
    ErrorFull = 45,
    ErrorBusy = 46,
    ErrorSyntax = 50,
    ErrorVariable = 51,
    ErrorUnsupported = 52,
    ErrorRead = 60,
    ErrorWrite = 61,
    ErrorInternal = 90,
}

impl Status {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Ok),
            1 => Some(Self::ErrorArgument),
            2 => Some(Self::ErrorStructSize),
            3 => Some(Self::ErrorSize),
            4 => Some(Self::ErrorCapacity),
            5 => Some(Self::ErrorNotFinite),
            10 => Some(Self::ErrorMemory),
            11 => Some(Self::ErrorCancelled),
            20 => Some(Self::ErrorResponse),
            21 => Some(Self::ErrorVignetting),
            22 => Some(Self::ErrorExposure),
            23 => Some(Self::ErrorGeometry),
            30 => Some(Self::ErrorNoOverlap),
            31 => Some(Self::ErrorNoSamples),
            32 => Some(Self::ErrorNoUnknowns),
            33 => Some(Self::ErrorNotUsable),
            40 => Some(Self::ErrorStore),
            41 => Some(Self::ErrorNotFound),
            42 => Some(Self::ErrorCorrupt),
            43 => Some(Self::ErrorLayout),
            44 => Some(Self::ErrorReadOnly),
            45 => Some(Self::ErrorFull),
            46 => Some(Self::ErrorBusy),
            50 => Some(Self::ErrorSyntax),
            51 => Some(Self::ErrorVariable),
            52 => Some(Self::ErrorUnsupported),
            60 => Some(Self::ErrorRead),
            61 => Some(Self::ErrorWrite),
            90 => Some(Self::ErrorInternal),
            _ => None,
        }
    }
}

/// `lensprof_item_kind`; see lensprof/base.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ItemKind {
    None = 0,
    Image = 1,
    Pair = 2,
    Observation = 3,
    Point = 4,
    Shot = 5,
    Profile = 6,
    Frame = 7,
    Match = 8,
}

impl ItemKind {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::None),
            1 => Some(Self::Image),
            2 => Some(Self::Pair),
            3 => Some(Self::Observation),
            4 => Some(Self::Point),
            5 => Some(Self::Shot),
            6 => Some(Self::Profile),
            7 => Some(Self::Frame),
            8 => Some(Self::Match),
            _ => None,
        }
    }
}

/// `lensprof_response_kind`; see lensprof/model.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResponseKind {
    Linear = 0,
    Gamma = 1,
    Emor = 2,
    Table = 3,
}

impl ResponseKind {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Linear),
            1 => Some(Self::Gamma),
            2 => Some(Self::Emor),
            3 => Some(Self::Table),
            _ => None,
        }
    }
}

/// `lensprof_camera_kind`; see lensprof/model.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CameraKind {
    Any = 0,
    Film = 1,
    Digital = 2,
    Still = 3,
    Phone = 4,
    Linear = 5,
}

impl CameraKind {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Any),
            1 => Some(Self::Film),
            2 => Some(Self::Digital),
            3 => Some(Self::Still),
            4 => Some(Self::Phone),
            5 => Some(Self::Linear),
            _ => None,
        }
    }
}

/// `lensprof_processing`; see lensprof/profile.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Processing {
    Raw = 0,
    Jpeg = 1,
    Corrected = 2,
}

impl Processing {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Raw),
            1 => Some(Self::Jpeg),
            2 => Some(Self::Corrected),
            _ => None,
        }
    }
}

pub const PACK_COVARIANCE: u32 = 1;

/// `lensprof_sample_type`; see lensprof/apply.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SampleType {
    U8 = 0,
    U16 = 1,
    F32 = 2,
    F16 = 3,
}

impl SampleType {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::U8),
            1 => Some(Self::U16),
            2 => Some(Self::F32),
            3 => Some(Self::F16),
            _ => None,
        }
    }
}

/// `lensprof_layout`; see lensprof/apply.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layout {
    Grey = 0,
    GreyAlpha = 1,
    Rgb = 2,
    Rgba = 3,
    Bgr = 4,
    Bgra = 5,
    Planar = 6,
    Rggb = 7,
    Grbg = 8,
    Gbrg = 9,
    Bggr = 10,
}

impl Layout {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Grey),
            1 => Some(Self::GreyAlpha),
            2 => Some(Self::Rgb),
            3 => Some(Self::Rgba),
            4 => Some(Self::Bgr),
            5 => Some(Self::Bgra),
            6 => Some(Self::Planar),
            7 => Some(Self::Rggb),
            8 => Some(Self::Grbg),
            9 => Some(Self::Gbrg),
            10 => Some(Self::Bggr),
            _ => None,
        }
    }
}

/// `lensprof_direction`; see lensprof/apply.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    Correct = 0,
    Simulate = 1,
}

impl Direction {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Correct),
            1 => Some(Self::Simulate),
            _ => None,
        }
    }
}

/// `lensprof_encoding`; see lensprof/apply.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    Response = 0,
    Linear = 1,
}

impl Encoding {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Response),
            1 => Some(Self::Linear),
            _ => None,
        }
    }
}

/// `lensprof_saturated`; see lensprof/apply.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Saturated {
    Neutral = 0,
    AsValue = 1,
}

impl Saturated {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Neutral),
            1 => Some(Self::AsValue),
            _ => None,
        }
    }
}

/// `lensprof_deflicker_state`; see lensprof/deflicker.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DeflickerState {
    Levelled = 0,
    Dark = 1,
    White = 2,
    Disagrees = 3,
}

impl DeflickerState {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Levelled),
            1 => Some(Self::Dark),
            2 => Some(Self::White),
            3 => Some(Self::Disagrees),
            _ => None,
        }
    }
}

/// `lensprof_deflicker_to`; see lensprof/deflicker.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DeflickerTo {
    Smooth = 0,
    Light = 1,
    Mean = 2,
    Frame = 3,
    Curve = 4,
}

impl DeflickerTo {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Smooth),
            1 => Some(Self::Light),
            2 => Some(Self::Mean),
            3 => Some(Self::Frame),
            4 => Some(Self::Curve),
            _ => None,
        }
    }
}

/// `lensprof_exposure_state`; see lensprof/exposure_settings.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ExposureState {
    Known = 0,
    NoTime = 1,
    NoIso = 2,
    NoAperture = 3,
    Apart = 4,
    Implausible = 5,
}

impl ExposureState {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Known),
            1 => Some(Self::NoTime),
            2 => Some(Self::NoIso),
            3 => Some(Self::NoAperture),
            4 => Some(Self::Apart),
            5 => Some(Self::Implausible),
            _ => None,
        }
    }
}

/// `lensprof_reason`; see lensprof/reason.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reason {
    None = 0,
    ImageGroups = 101,
    FewPairs = 102,
    FewAgree = 103,
    Scatter = 104,
    NotConverged = 105,
    Undetermined = 106,
    FewInliers = 107,
    ImageDisagrees = 108,
    Patterns = 109,
    ImageInconsistent = 110,
    ImagesLeftOut = 111,
    ImagesUnconnected = 112,
    ManyOutliers = 113,
    SeamsRemain = 114,
    LinksContradict = 115,
    LinksUnverified = 116,
    ImagesMinority = 117,
    ExposureUncertain = 201,
    ExposuresEqual = 202,
    KnownOrder = 203,
    KnownWrong = 204,
    KnownStep = 205,
    KnownContradict = 206,
    GammaInconsistent = 207,
    WhiteBalanceFixed = 208,
    FewGreys = 301,
    MissingGreys = 302,
    UnusualResponse = 303,
    ResponseUnconstrained = 304,
    SmallRadius = 401,
    CornerUncertain = 402,
    FalloffRises = 403,
    CenterOnLimit = 404,
    FalloffDark = 405,
    SameView = 406,
    ExposuresOnly = 407,
    NothingBetter = 408,
    NotRadial = 409,
    FarCenter = 410,
    FewImages = 411,
    FlatWhite = 501,
    FlatBlack = 502,
    FlatNoCard = 503,
    FlatFewCells = 504,
    FlatResponse = 505,
    FlatExposureWrong = 506,
    FlatTexture = 507,
    FlatShotsDiffer = 508,
    FlatSteep = 509,
    FlatNotRadial = 510,
    FlatCenterByPrior = 511,
    FlatDust = 512,
    FlatEdge = 513,
    FlatOneLight = 514,
    FlatNeedsGrid = 515,
    FlatBlackLevel = 516,
    FieldsFew = 521,
    FieldsRepeated = 522,
    FieldsPattern = 523,
    FieldsUncertain = 524,
    FieldsOffset = 525,
    FieldsWhite = 526,
    FieldsBlack = 527,
    FieldsUnseen = 528,
    FieldsGain = 529,
    LookupNoLens = 601,
    LookupNoCamera = 602,
    LookupOtherProcessing = 603,
    LookupDoubtful = 604,
    LookupOtherCamera = 605,
    LookupSeveralLenses = 606,
    LookupSmallerSensor = 607,
    LookupFocalMissing = 608,
    LookupApertureMissing = 609,
    LookupNoFocal = 610,
    LookupNoAperture = 611,
    LookupFocalBeyond = 612,
    LookupApertureBeyond = 613,
    LookupTooFar = 614,
    LookupContradiction = 615,
    LookupCorrected = 616,
    LookupFocalRounded = 651,
    LookupFocalOutside = 652,
    LookupApertureOutside = 653,
    LookupOtherLight = 654,
    LookupSmallestSensor = 655,
    LookupByWords = 656,
    LookupBuiltIn = 657,
    LookupWeakestDistance = 658,
    LookupFarthestDistance = 659,
    LookupUsualDistance = 660,
    LookupUnknownSensor = 661,
    LookupOnOtherCamera = 662,
    LookupTypicalResponse = 663,
    LookupOtherStyle = 664,
    PriorOverruled = 701,
    PriorResponseOverruled = 702,
    PriorFalloffOverruled = 703,
}

impl Reason {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::None),
            101 => Some(Self::ImageGroups),
            102 => Some(Self::FewPairs),
            103 => Some(Self::FewAgree),
            104 => Some(Self::Scatter),
            105 => Some(Self::NotConverged),
            106 => Some(Self::Undetermined),
            107 => Some(Self::FewInliers),
            108 => Some(Self::ImageDisagrees),
            109 => Some(Self::Patterns),
            110 => Some(Self::ImageInconsistent),
            111 => Some(Self::ImagesLeftOut),
            112 => Some(Self::ImagesUnconnected),
            113 => Some(Self::ManyOutliers),
            114 => Some(Self::SeamsRemain),
            115 => Some(Self::LinksContradict),
            116 => Some(Self::LinksUnverified),
            117 => Some(Self::ImagesMinority),
            201 => Some(Self::ExposureUncertain),
            202 => Some(Self::ExposuresEqual),
            203 => Some(Self::KnownOrder),
            204 => Some(Self::KnownWrong),
            205 => Some(Self::KnownStep),
            206 => Some(Self::KnownContradict),
            207 => Some(Self::GammaInconsistent),
            208 => Some(Self::WhiteBalanceFixed),
            301 => Some(Self::FewGreys),
            302 => Some(Self::MissingGreys),
            303 => Some(Self::UnusualResponse),
            304 => Some(Self::ResponseUnconstrained),
            401 => Some(Self::SmallRadius),
            402 => Some(Self::CornerUncertain),
            403 => Some(Self::FalloffRises),
            404 => Some(Self::CenterOnLimit),
            405 => Some(Self::FalloffDark),
            406 => Some(Self::SameView),
            407 => Some(Self::ExposuresOnly),
            408 => Some(Self::NothingBetter),
            409 => Some(Self::NotRadial),
            410 => Some(Self::FarCenter),
            411 => Some(Self::FewImages),
            501 => Some(Self::FlatWhite),
            502 => Some(Self::FlatBlack),
            503 => Some(Self::FlatNoCard),
            504 => Some(Self::FlatFewCells),
            505 => Some(Self::FlatResponse),
            506 => Some(Self::FlatExposureWrong),
            507 => Some(Self::FlatTexture),
            508 => Some(Self::FlatShotsDiffer),
            509 => Some(Self::FlatSteep),
            510 => Some(Self::FlatNotRadial),
            511 => Some(Self::FlatCenterByPrior),
            512 => Some(Self::FlatDust),
            513 => Some(Self::FlatEdge),
            514 => Some(Self::FlatOneLight),
            515 => Some(Self::FlatNeedsGrid),
            516 => Some(Self::FlatBlackLevel),
            521 => Some(Self::FieldsFew),
            522 => Some(Self::FieldsRepeated),
            523 => Some(Self::FieldsPattern),
            524 => Some(Self::FieldsUncertain),
            525 => Some(Self::FieldsOffset),
            526 => Some(Self::FieldsWhite),
            527 => Some(Self::FieldsBlack),
            528 => Some(Self::FieldsUnseen),
            529 => Some(Self::FieldsGain),
            601 => Some(Self::LookupNoLens),
            602 => Some(Self::LookupNoCamera),
            603 => Some(Self::LookupOtherProcessing),
            604 => Some(Self::LookupDoubtful),
            605 => Some(Self::LookupOtherCamera),
            606 => Some(Self::LookupSeveralLenses),
            607 => Some(Self::LookupSmallerSensor),
            608 => Some(Self::LookupFocalMissing),
            609 => Some(Self::LookupApertureMissing),
            610 => Some(Self::LookupNoFocal),
            611 => Some(Self::LookupNoAperture),
            612 => Some(Self::LookupFocalBeyond),
            613 => Some(Self::LookupApertureBeyond),
            614 => Some(Self::LookupTooFar),
            615 => Some(Self::LookupContradiction),
            616 => Some(Self::LookupCorrected),
            651 => Some(Self::LookupFocalRounded),
            652 => Some(Self::LookupFocalOutside),
            653 => Some(Self::LookupApertureOutside),
            654 => Some(Self::LookupOtherLight),
            655 => Some(Self::LookupSmallestSensor),
            656 => Some(Self::LookupByWords),
            657 => Some(Self::LookupBuiltIn),
            658 => Some(Self::LookupWeakestDistance),
            659 => Some(Self::LookupFarthestDistance),
            660 => Some(Self::LookupUsualDistance),
            661 => Some(Self::LookupUnknownSensor),
            662 => Some(Self::LookupOnOtherCamera),
            663 => Some(Self::LookupTypicalResponse),
            664 => Some(Self::LookupOtherStyle),
            701 => Some(Self::PriorOverruled),
            702 => Some(Self::PriorResponseOverruled),
            703 => Some(Self::PriorFalloffOverruled),
            _ => None,
        }
    }
}

/// `lensprof_severity`; see lensprof/reason.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Severity {
    Passed = 0,
    Note = 1,
    Warning = 2,
    Refusal = 3,
}

impl Severity {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Passed),
            1 => Some(Self::Note),
            2 => Some(Self::Warning),
            3 => Some(Self::Refusal),
            _ => None,
        }
    }
}

/// `lensprof_projection`; see lensprof/geometry.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Projection {
    Rectilinear = 0,
    Cylindrical = 1,
    CircularFisheye = 2,
    FullframeFisheye = 3,
    Equirectangular = 4,
    Orthographic = 8,
    Stereographic = 10,
    Thoby = 20,
    Equisolid = 21,
}

impl Projection {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Rectilinear),
            1 => Some(Self::Cylindrical),
            2 => Some(Self::CircularFisheye),
            3 => Some(Self::FullframeFisheye),
            4 => Some(Self::Equirectangular),
            8 => Some(Self::Orthographic),
            10 => Some(Self::Stereographic),
            20 => Some(Self::Thoby),
            21 => Some(Self::Equisolid),
            _ => None,
        }
    }
}

/// `lensprof_sampling`; see lensprof/sample.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sampling {
    Balanced = 0,
    Paper = 1,
    Bracket = 2,
}

impl Sampling {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Balanced),
            1 => Some(Self::Paper),
            2 => Some(Self::Bracket),
            _ => None,
        }
    }
}

/// `lensprof_link_state`; see lensprof/sample.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LinkState {
    Unverified = 0,
    Verified = 1,
    Contradicted = 2,
}

impl LinkState {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Unverified),
            1 => Some(Self::Verified),
            2 => Some(Self::Contradicted),
            _ => None,
        }
    }
}

/// `lensprof_fit_method`; see lensprof/fit.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    Transfer = 0,
    Radiance = 1,
    TransferFunction = 2,
}

impl Method {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Transfer),
            1 => Some(Self::Radiance),
            2 => Some(Self::TransferFunction),
            _ => None,
        }
    }
}

/// `lensprof_loss`; see lensprof/fit.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Loss {
    Robust = 0,
    Huber = 1,
    Squared = 2,
}

impl Loss {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Robust),
            1 => Some(Self::Huber),
            2 => Some(Self::Squared),
            _ => None,
        }
    }
}

/// `lensprof_gamma_from`; see lensprof/fit.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GammaFrom {
    Auto = 0,
    Prior = 1,
    Exposures = 2,
    Known = 3,
    None = 4,
    Profile = 5,
    Falloff = 6,
    Cameras = 7,
}

impl GammaFrom {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Auto),
            1 => Some(Self::Prior),
            2 => Some(Self::Exposures),
            3 => Some(Self::Known),
            4 => Some(Self::None),
            5 => Some(Self::Profile),
            6 => Some(Self::Falloff),
            7 => Some(Self::Cameras),
            _ => None,
        }
    }
}

/// `lensprof_fit_response`; see lensprof/fit.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FitResponse {
    Pictures = 0,
    Options = 1,
    Kind = 2,
    Profile = 3,
}

impl FitResponse {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Pictures),
            1 => Some(Self::Options),
            2 => Some(Self::Kind),
            3 => Some(Self::Profile),
            _ => None,
        }
    }
}

/// `lensprof_fit_model`; see lensprof/fit.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FitModel {
    Full = 0,
    Lens = 1,
    Exposures = 2,
    Nothing = 3,
}

impl FitModel {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Full),
            1 => Some(Self::Lens),
            2 => Some(Self::Exposures),
            3 => Some(Self::Nothing),
            _ => None,
        }
    }
}

/// `lensprof_profile_prior`; see lensprof/fit.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ProfilePrior {
    None = 0,
    Used = 1,
    Overruled = 2,
    ResponseOverruled = 3,
    FalloffOverruled = 4,
}

impl ProfilePrior {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::None),
            1 => Some(Self::Used),
            2 => Some(Self::Overruled),
            3 => Some(Self::ResponseOverruled),
            4 => Some(Self::FalloffOverruled),
            _ => None,
        }
    }
}

/// `lensprof_flat_light`; see lensprof/flat.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FlatLight {
    Auto = 0,
    Even = 1,
    Plane = 2,
    Quadratic = 3,
}

impl FlatLight {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Auto),
            1 => Some(Self::Even),
            2 => Some(Self::Plane),
            3 => Some(Self::Quadratic),
            _ => None,
        }
    }
}

/// `lensprof_flat_grid`; see lensprof/flat.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FlatGrid {
    Auto = 0,
    None = 1,
    Always = 2,
}

impl FlatGrid {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Auto),
            1 => Some(Self::None),
            2 => Some(Self::Always),
            _ => None,
        }
    }
}

/// `lensprof_curve`; see lensprof/formats.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CurveKind {
    Inverse = 0,
    Log = 1,
    Log10 = 2,
    Forward = 3,
}

impl CurveKind {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Inverse),
            1 => Some(Self::Log),
            2 => Some(Self::Log10),
            3 => Some(Self::Forward),
            _ => None,
        }
    }
}

/// `lensprof_map_sense`; see lensprof/formats.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapSense {
    Attenuation = 0,
    Gain = 1,
}

impl MapSense {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Attenuation),
            1 => Some(Self::Gain),
            _ => None,
        }
    }
}

/// `lensprof_dng_form`; see lensprof/formats.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DngForm {
    Radial = 0,
    GainMap = 1,
    Auto = 2,
}

impl DngForm {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Radial),
            1 => Some(Self::GainMap),
            2 => Some(Self::Auto),
            _ => None,
        }
    }
}

/// `lensprof_format`; see lensprof/formats.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    Auto = 0,
    Lensfun = 1,
    Lcp = 2,
    Json = 3,
    Blob = 4,
    DngOpcodes = 5,
    DroneXmp = 6,
    Alsc = 7,
    Map = 8,
    Pcalib = 9,
    Curves = 10,
    RadicalResponse = 11,
    RadicalVignetting = 12,
    Cube = 13,
    Glsl = 14,
    Wgsl = 15,
    C = 16,
}

impl Format {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Auto),
            1 => Some(Self::Lensfun),
            2 => Some(Self::Lcp),
            3 => Some(Self::Json),
            4 => Some(Self::Blob),
            5 => Some(Self::DngOpcodes),
            6 => Some(Self::DroneXmp),
            7 => Some(Self::Alsc),
            8 => Some(Self::Map),
            9 => Some(Self::Pcalib),
            10 => Some(Self::Curves),
            11 => Some(Self::RadicalResponse),
            12 => Some(Self::RadicalVignetting),
            13 => Some(Self::Cube),
            14 => Some(Self::Glsl),
            15 => Some(Self::Wgsl),
            16 => Some(Self::C),
            _ => None,
        }
    }
}

/// `lensprof_holds`; see lensprof/formats.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Holds {
    Profiles = 0,
    Response = 1,
    Falloff = 2,
}

impl Holds {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Profiles),
            1 => Some(Self::Response),
            2 => Some(Self::Falloff),
            _ => None,
        }
    }
}

/// `lensprof_online_state`; see lensprof/online.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OnlineState {
    First = 0,
    Chained = 1,
    Lost = 2,
}

impl OnlineState {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::First),
            1 => Some(Self::Chained),
            2 => Some(Self::Lost),
            _ => None,
        }
    }
}

/// `lensprof_online_known`; see lensprof/online.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OnlineKnown {
    Exponent = 1,
    Shape = 2,
    Falloff = 4,
}

impl OnlineKnown {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            1 => Some(Self::Exponent),
            2 => Some(Self::Shape),
            4 => Some(Self::Falloff),
            _ => None,
        }
    }
}

/// `lensprof_packing`; see lensprof/packed.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Packing {
    Raw8 = 8,
    Raw10 = 10,
    Raw12 = 12,
    Raw14 = 14,
}

impl Packing {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            8 => Some(Self::Raw8),
            10 => Some(Self::Raw10),
            12 => Some(Self::Raw12),
            14 => Some(Self::Raw14),
            _ => None,
        }
    }
}

/// `lensprof_flip`; see lensprof/sensor.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Flip {
    None = 0,
    Horizontal = 1,
    Vertical = 2,
    Both = 3,
}

impl Flip {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::None),
            1 => Some(Self::Horizontal),
            2 => Some(Self::Vertical),
            3 => Some(Self::Both),
            _ => None,
        }
    }
}

/// `lensprof_store_mode`; see lensprof/store.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StoreMode {
    Read = 0,
    Write = 1,
    Create = 2,
}

impl StoreMode {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Read),
            1 => Some(Self::Write),
            2 => Some(Self::Create),
            _ => None,
        }
    }
}

/// `lensprof_distance_rule`; see lensprof/store.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DistanceRule {
    Usual = 0,
    Weakest = 1,
    Farthest = 2,
}

impl DistanceRule {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Usual),
            1 => Some(Self::Weakest),
            2 => Some(Self::Farthest),
            _ => None,
        }
    }
}

/// `lensprof_response_from`; see lensprof/store.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResponseFrom {
    Profile = 0,
    Camera = 1,
    Kind = 2,
    Raw = 3,
}

impl ResponseFrom {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Profile),
            1 => Some(Self::Camera),
            2 => Some(Self::Kind),
            3 => Some(Self::Raw),
            _ => None,
        }
    }
}

/// `lensprof_store_names`; see lensprof/store.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StoreNames {
    Lenses = 0,
    Cameras = 1,
}

impl StoreNames {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Lenses),
            1 => Some(Self::Cameras),
            _ => None,
        }
    }
}

/// `lensprof_trial_response`; see lensprof/trial.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TrialResponse {
    Own = 0,
    Other = 1,
    Kind = 2,
    Linear = 3,
}

impl TrialResponse {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::Own),
            1 => Some(Self::Other),
            2 => Some(Self::Kind),
            3 => Some(Self::Linear),
            _ => None,
        }
    }
}

/// `lensprof_trial_corners`; see lensprof/trial.h.
#[repr(i32)]
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TrialCorners {
    NotShown = 0,
    Agree = 1,
    TooDark = 2,
    TooBright = 3,
}

impl TrialCorners {
    /// The member with a number of C, if this version has it.
    pub fn from_raw(value: i64) -> Option<Self> {
        match value {
            0 => Some(Self::NotShown),
            1 => Some(Self::Agree),
            2 => Some(Self::TooDark),
            3 => Some(Self::TooBright),
            _ => None,
        }
    }
}

pub const FREE_RESPONSE: u32 = 1;
pub const FREE_K1: u32 = 2;
pub const FREE_K2: u32 = 4;
pub const FREE_K3: u32 = 8;
pub const FREE_CENTER: u32 = 16;
pub const FREE_EV: u32 = 32;
pub const FREE_RED: u32 = 64;
pub const FREE_BLUE: u32 = 128;
pub const FREE_FALLOFF: u32 = 14;
pub const FREE_LENS: u32 = 31;
pub const FREE_IMAGE: u32 = 224;

/// `lensprof_item`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Item {
    pub kind: u32,
    pub index: u32,
    pub text_begin: u32,
    pub text_bytes: u32,
}

/// `lensprof_error`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ErrorText {
    pub text: [c_char; 256],
    pub item: Item,
}

pub type Progress = Option<unsafe extern "C" fn(done: f64, user: *mut c_void) -> c_int>;

/// `lensprof_response`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Response {
    pub kind: u32,
    pub modes: u32,
    pub gamma: f64,
    pub emor: [f64; 25],
    pub table: [f64; 1024],
}

/// `lensprof_vignetting`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Vignetting {
    pub k: [f64; 3],
    pub center: [f64; 2],
}

/// `lensprof_gain_grid`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct GainGrid {
    pub columns: u32,
    pub rows: u32,
    pub channels: u32,
    pub reserved: u32,
    pub attenuation: [f32; 3072],
}

/// `lensprof_levels`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Levels {
    pub black: [f64; 3],
    pub white: f64,
}

/// `lensprof_image_circle`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ImageCircle {
    pub center: [f64; 2],
    pub radius: f64,
}

/// `lensprof_exposure`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Exposure {
    pub ev: f64,
    pub white_balance: [f64; 3],
}

/// `lensprof_profile_key`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ProfileKey {
    pub camera_maker: [c_char; 64],
    pub camera_model: [c_char; 64],
    pub lens: [c_char; 128],
    pub unit: [c_char; 64],
    pub crop_factor: f64,
    pub focal_mm: f64,
    pub aperture: f64,
    pub distance_m: f64,
    pub color_temperature_k: f64,
    pub processing: u32,
    pub style: [c_char; 64],
    pub reserved: [u32; 21],
}

/// `lensprof_camera_model`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct CameraModel {
    pub maker: [c_char; 64],
    pub model: [c_char; 64],
    pub other_maker: [c_char; 64],
    pub other_model: [c_char; 64],
    pub variant: [c_char; 64],
    pub mount: [c_char; 64],
    pub lens: [c_char; 128],
    pub source: [c_char; 256],
    pub crop_factor: f64,
    pub fixed_lens: u32,
    pub reserved: [u32; 61],
}

/// `lensprof_provenance`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Provenance {
    pub method: [c_char; 32],
    pub software: [c_char; 32],
    pub source: [c_char; 256],
    pub created_unix_s: i64,
    pub images: u32,
    pub pairs: u32,
    pub heldout_rms: f64,
    pub inlier_share: f64,
    pub doubt: [c_char; 64],
    pub prior_id: i64,
    pub forced: u32,
    pub not_usable: u32,
    pub gamma_sigma: f64,
    pub reserved: [u32; 82],
}

/// `lensprof_profile`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Profile {
    pub struct_size: u32,
    pub responses: u32,
    pub vignettings: u32,
    pub covariance_size: u32,
    pub key: ProfileKey,
    pub provenance: Provenance,
    pub response: [Response; 3],
    pub vignetting: [Vignetting; 3],
    pub grid: GainGrid,
    pub covariance: [f64; 1296],
    pub levels: Levels,
    pub image_circle: ImageCircle,
}

/// `lensprof_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Image {
    pub data: *const c_void,
    pub row_bytes: isize,
    pub width: u32,
    pub height: u32,
    pub sample: u32,
    pub layout: u32,
}

/// `lensprof_target`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Target {
    pub data: *mut c_void,
    pub row_bytes: isize,
    pub width: u32,
    pub height: u32,
    pub sample: u32,
    pub layout: u32,
}

/// `lensprof_apply_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ApplyOptions {
    pub struct_size: u32,
    pub direction: u32,
    pub input: u32,
    pub output: u32,
    pub frame_width: u32,
    pub frame_height: u32,
    pub source_sample: u32,
    pub source_layout: u32,
    pub target_sample: u32,
    pub saturated: u32,
    pub responses: u32,
    pub vignettings: u32,
    pub response: *const Response,
    pub vignetting: *const Vignetting,
    pub source: Exposure,
    pub target: Exposure,
    pub grid: *const GainGrid,
    pub strength: f64,
    pub gain_cap: f64,
    pub dither: u32,
    pub reserved: u32,
    pub blob: *const c_void,
    pub blob_bytes: usize,
    pub output_response: *const Response,
    pub output_responses: u32,
    pub reserved2: u32,
    pub chroma: u32,
    pub reserved3: u32,
    pub levels: *const Levels,
    pub output_levels: *const Levels,
    pub image_circle: *const ImageCircle,
}

/// Opaque.
#[repr(C)]
pub struct Plan {
    _private: [u8; 0],
}

/// Opaque.
#[repr(C)]
pub struct Deflicker {
    _private: [u8; 0],
}

/// `lensprof_deflicker_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct DeflickerOptions {
    pub struct_size: u32,
    pub responses: u32,
    pub response: *const Response,
    pub rows: u32,
    pub reserved: u32,
    pub region: [f64; 4],
}

/// `lensprof_deflicker_facts`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct DeflickerFacts {
    pub struct_size: u32,
    pub reserved: u32,
    pub seconds: f64,
    pub settings_ev: f64,
    pub f_number: f64,
}

/// `lensprof_deflicker_frame`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct DeflickerFrame {
    pub struct_size: u32,
    pub state: u32,
    pub segment: u32,
    pub repeats: u32,
    pub seconds: f64,
    pub settings_ev: f64,
    pub exposure: Exposure,
    pub ev_sigma: f64,
    pub agreeing: f64,
    pub shift: [f64; 2],
    pub white_share: f64,
    pub dark_share: f64,
}

/// `lensprof_deflicker_result`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct DeflickerResult {
    pub struct_size: u32,
    pub frames: u32,
    pub levelled: u32,
    pub segments: u32,
    pub repeated: u32,
    pub moving: u32,
    pub motion: f64,
    pub unlinked: f64,
    pub flicker: f64,
    pub tone_error: f64,
    pub known_range: f64,
}

/// `lensprof_deflicker_target`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct DeflickerTarget {
    pub struct_size: u32,
    pub to: u32,
    pub frame: u32,
    pub reserved: u32,
    pub window_s: f64,
    pub curve: *const f64,
}

/// `lensprof_exposure_settings`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ExposureSettings {
    pub time_s: f64,
    pub f_number: f64,
    pub iso: f64,
    pub camera: u32,
    pub lens: u32,
    pub is_manual: u32,
    pub reserved: u32,
}

/// `lensprof_known_exposure`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct KnownExposure {
    pub ev: f64,
    pub sigma: f64,
    pub state: u32,
    pub reserved: u32,
}

/// Opaque.
#[repr(C)]
pub struct Exposures {
    _private: [u8; 0],
}

/// `lensprof_exposures_info`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ExposuresInfo {
    pub struct_size: u32,
    pub camera_count: u32,
    pub lens_count: u32,
    pub image_count: u32,
    pub reference: u32,
    pub reserved: u32,
    pub software: *const c_char,
}

/// `lensprof_exposures_camera`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ExposuresCamera {
    pub struct_size: u32,
    pub reserved: u32,
    pub name: *const c_char,
    pub response: Response,
}

/// `lensprof_exposures_lens`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ExposuresLens {
    pub struct_size: u32,
    pub camera: u32,
    pub name: *const c_char,
    pub vignettings: u32,
    pub reserved: u32,
    pub vignetting: [Vignetting; 3],
}

/// `lensprof_exposures_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ExposuresImage {
    pub struct_size: u32,
    pub lens: u32,
    pub width: u32,
    pub height: u32,
    pub name: *const c_char,
    pub file: *const c_char,
    pub exposure: Exposure,
    pub ev_sigma: f64,
    pub white_balance_sigma: [f64; 3],
}

/// `lensprof_finding`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Finding {
    pub struct_size: u32,
    pub code: u32,
    pub severity: u32,
    pub value_count: u32,
    pub rule_severity: u32,
    pub reserved: u32,
    pub value: [f64; 2],
    pub measured: f64,
    pub limit: f64,
    pub item: Item,
    pub text: [c_char; 256],
}

/// Opaque.
#[repr(C)]
pub struct Fields {
    _private: [u8; 0],
}

/// `lensprof_fields_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FieldsOptions {
    pub struct_size: u32,
    pub channels: u32,
    pub width: u32,
    pub height: u32,
    pub given_offset: u32,
    pub responses: u32,
    pub threads: u32,
    pub reserved: u32,
    pub offset: [f64; 3],
    pub white: f64,
    pub response: *const Response,
    pub progress: Progress,
    pub progress_user: *mut c_void,
}

/// `lensprof_fields_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FieldsImage {
    pub struct_size: u32,
    pub used: u32,
    pub same_as: u32,
    pub reserved: u32,
    pub level: [f64; 3],
    pub white_share: f64,
    pub pixel_share: f64,
}

/// `lensprof_fields_smoothness`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FieldsSmoothness {
    pub order: u32,
    pub reserved: u32,
    pub weight: f64,
    pub rms: f64,
}

/// `lensprof_fields_channel`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FieldsChannel {
    pub offset: f64,
    pub offset_sigma: f64,
    pub offset_found: u32,
    pub smoothness: u32,
    pub shading_error: f64,
    pub heldout_rms: f64,
    pub even_rms: f64,
    pub pattern: f64,
    pub pattern_share: f64,
    pub background_share: f64,
    pub background_sigma: f64,
    pub iterations: u32,
    pub converged: u32,
}

/// `lensprof_fields_result`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FieldsResult {
    pub struct_size: u32,
    pub usable: u32,
    pub findings: u32,
    pub passed: u32,
    pub images: u32,
    pub used: u32,
    pub repeated: u32,
    pub black: u32,
    pub white: u32,
    pub channels: u32,
    pub columns: u32,
    pub rows: u32,
    pub smoothnesses: u32,
    pub reserved: u32,
    pub unseen_share: f64,
    pub white_share: f64,
    pub channel: [FieldsChannel; 3],
    pub shading: GainGrid,
}

/// `lensprof_camera`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Camera {
    pub projection: u32,
    pub width: u32,
    pub height: u32,
    pub hfov_deg: f64,
    pub yaw_deg: f64,
    pub pitch_deg: f64,
    pub roll_deg: f64,
    pub radial: [f64; 3],
    pub shift_px: [f64; 2],
    pub shear_px: [f64; 2],
    pub translation: [f64; 3],
    pub plane_deg: [f64; 2],
}

/// `lensprof_pair`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Pair {
    pub image: [u32; 2],
    pub xy: [[f64; 2]; 2],
    pub value: [[f64; 3]; 2],
}

/// `lensprof_observation`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Observation {
    pub point: u32,
    pub image: u32,
    pub xy: [f64; 2],
    pub value: [f64; 3],
}

/// `lensprof_sample_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SampleImage {
    pub struct_size: u32,
    pub reduction: u32,
    pub every_pixel: u32,
    pub reserved: u32,
    pub view: Image,
    pub camera: Camera,
    pub mask: *const u8,
    pub mask_row_bytes: isize,
    pub black: f64,
    pub white: f64,
}

/// `lensprof_link`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Link {
    pub image: [u32; 2],
    pub state: u32,
    pub pairs: u32,
}

/// `lensprof_sample_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SampleOptions {
    pub struct_size: u32,
    pub sampling: u32,
    pub pairs: u32,
    pub seed: u32,
    pub threads: u32,
    pub reserved: u32,
    pub progress: Progress,
    pub progress_user: *mut c_void,
    pub links: *mut Link,
    pub link_count: *mut u32,
    pub link_capacity: u32,
    pub reserved2: u32,
    pub response: *const Response,
    pub vignetting: *const Vignetting,
    pub match_of_pair: *mut u32,
}

/// `lensprof_match`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Match {
    pub image: [u32; 2],
    pub xy: [[f64; 2]; 2],
    pub map: [[f64; 2]; 2],
}

/// `lensprof_fit_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FitImage {
    pub struct_size: u32,
    pub width: u32,
    pub height: u32,
    pub free: u32,
    pub ev_of: u32,
    pub red_of: u32,
    pub blue_of: u32,
    pub setting: u32,
    pub exposure: Exposure,
    pub known_ev: f64,
    pub known_ev_sigma: f64,
    pub camera: u32,
    pub reserved: u32,
    pub f_number_ratio: f64,
    pub crop_factor: f64,
}

/// `lensprof_fit_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FitOptions {
    pub struct_size: u32,
    pub channels: u32,
    pub reference: u32,
    pub free: u32,
    pub modes: u32,
    pub loss: u32,
    pub huber_levels: f64,
    pub prior_weight: f64,
    pub max_iterations: u32,
    pub vignettings: u32,
    pub gamma_from: u32,
    pub camera_kind: u32,
    pub threads: u32,
    pub method: u32,
    pub refine: u32,
    pub moving_camera: u32,
    pub profile: *const Profile,
    pub response: *const Response,
    pub vignetting: Vignetting,
    pub progress: Progress,
    pub progress_user: *mut c_void,
    pub links: *const Link,
    pub link_count: u32,
    pub unlinked_images: u32,
    pub points: *const u32,
    pub view_distances: *const f64,
}

/// Opaque.
#[repr(C)]
pub struct Fit {
    _private: [u8; 0],
}

/// `lensprof_fit_image_quality`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FitImageQuality {
    pub struct_size: u32,
    pub joined: u32,
    pub ev_sigma: f64,
    pub white_balance_sigma: [f64; 3],
    pub median_residual: f64,
    pub known_ev_residual: f64,
    pub radius: f64,
    pub grey_low: f64,
    pub grey_high: f64,
    pub pairs: u32,
    pub inliers: u32,
    pub component: u32,
    pub known_ev_left_out: u32,
}

/// `lensprof_fit_result`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FitResult {
    pub struct_size: u32,
    pub images: u32,
    pub setting_pairs: u32,
    pub usable: u32,
    pub findings: u32,
    pub passed: u32,
    pub reserved: u32,
    pub vignetting: [Vignetting; 3],
    pub radius_ends: [u32; 10],
    pub covariance: [f64; 1296],
    pub gamma_direction: [f64; 36],
    pub camera: u32,
    pub covariance_size: u32,
    pub response: Response,
    pub vignettings: u32,
    pub pairs: u32,
    pub equalizes: u32,
    pub response_from: u32,
    pub profile_prior: u32,
    pub gamma_from: u32,
    pub gamma_sigma: f64,
    pub before_rms: f64,
    pub heldout_rms: f64,
    pub heldout_median: f64,
    pub noise_levels: f64,
    pub inlier_share: f64,
    pub frame_share: f64,
    pub image_share: f64,
    pub irradiance_spread_ev: f64,
    pub grey_ends: [u32; 10],
    pub converged: u32,
    pub iterations: u32,
    pub model: u32,
    pub equal_exposures: u32,
    pub falloff_prior_distance: f64,
    pub center_prior_distance: f64,
    pub error_inflation: f64,
    pub reference: u32,
    pub left_out: u32,
    pub components: u32,
    pub setting_count: u32,
    pub camera_count: u32,
    pub reserved2: u32,
    pub seconds: f64,
    pub colour_variance_before: f64,
    pub colour_variance_exposures_only: f64,
    pub colour_variance: f64,
}

/// `lensprof_fit_camera`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FitCamera {
    pub struct_size: u32,
    pub images: u32,
    pub joined: u32,
    pub shared_pairs: u32,
    pub agreeing_share: f64,
    pub irradiance_difference_ev: f64,
    pub log_gamma: f64,
    pub offset_sigma_ev: f64,
    pub reference: u32,
    pub setting: u32,
    pub attached: u32,
    pub reserved: u32,
}

/// Opaque.
#[repr(C)]
pub struct FixedPlan {
    _private: [u8; 0],
}

/// `lensprof_flat_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FlatImage {
    pub struct_size: u32,
    pub width: u32,
    pub height: u32,
    pub reduction: u32,
    pub shot: u32,
    pub reserved: u32,
    pub view: Image,
    pub mask: *const u8,
    pub mask_row_bytes: isize,
    pub black: f64,
    pub white: f64,
    pub ev: f64,
    pub rotation_deg: f64,
}

/// `lensprof_flat_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FlatOptions {
    pub struct_size: u32,
    pub channels: u32,
    pub free: u32,
    pub vignettings: u32,
    pub light: u32,
    pub own_light: u32,
    pub several: u32,
    pub find_card: u32,
    pub grid: u32,
    pub responses: u32,
    pub threads: u32,
    pub reserved: u32,
    pub ev_sigma: f64,
    pub prior_weight: f64,
    pub response: *const Response,
    pub vignetting: Vignetting,
    pub progress: Progress,
    pub progress_user: *mut c_void,
    pub levels: Levels,
    pub black_sigma: f64,
}

/// Opaque.
#[repr(C)]
pub struct Flat {
    _private: [u8; 0],
}

/// `lensprof_flat_image_quality`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FlatImageQuality {
    pub struct_size: u32,
    pub cells: u32,
    pub white_share: f64,
    pub black_share: f64,
    pub noise_levels: f64,
    pub ev_residual: f64,
    pub residual: f64,
    pub gradient: [f64; 2],
    pub radius: f64,
    pub card: [u32; 4],
}

/// `lensprof_flat_spot`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FlatSpot {
    pub x: f64,
    pub y: f64,
    pub radius: f64,
    pub depth: f64,
    pub shots: u32,
    pub reserved: u32,
}

/// `lensprof_flat_result`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FlatResult {
    pub struct_size: u32,
    pub usable: u32,
    pub images: u32,
    pub covariance_size: u32,
    pub findings: u32,
    pub passed: u32,
    pub vignetting: [Vignetting; 3],
    pub vignettings: u32,
    pub light: u32,
    pub shots: u32,
    pub cells: u32,
    pub separated: u32,
    pub iterations: u32,
    pub converged: u32,
    pub spots: u32,
    pub spot: [FlatSpot; 32],
    pub radius: f64,
    pub noise: f64,
    pub residual: f64,
    pub texture: f64,
    pub frame_residual: f64,
    pub shot_residual: f64,
    pub inlier_share: f64,
    pub corner_sigma: f64,
    pub grid_residual: f64,
    pub covariance: [f64; 1296],
    pub gain_grid: GainGrid,
    pub corner: f64,
    pub edge_radius: f64,
    pub edge_share: f64,
    pub light_ev: f64,
    pub polynomial_error: f64,
    pub levels: Levels,
    pub black_offset: f64,
    pub black_sigma: f64,
    pub black_ev: f64,
    pub black_shown: u32,
    pub reserved: u32,
    pub image_circle: ImageCircle,
}

/// Opaque.
#[repr(C)]
pub struct Pto {
    _private: [u8; 0],
}

/// `lensprof_pto_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PtoImage {
    pub struct_size: u32,
    pub response_type: u32,
    pub camera: Camera,
    pub exposure: Exposure,
    pub vignetting: Vignetting,
    pub emor: [f64; 5],
    pub free: u32,
    pub response_of: u32,
    pub vignetting_of: u32,
    pub center_of: u32,
    pub ev_of: u32,
    pub red_of: u32,
    pub blue_of: u32,
    pub crop: [i32; 4],
    pub crop_circular: u32,
    pub left_out: u32,
    pub of_crop: u32,
}

/// `lensprof_import_entry`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ImportEntry {
    pub profile: *const Profile,
    pub usable: u32,
    pub holds: u32,
    pub change: f64,
}

pub type ImportVisitor = Option<unsafe extern "C" fn(user: *mut c_void, entry: *const ImportEntry) -> c_int>;

pub type CameraVisitor = Option<unsafe extern "C" fn(user: *mut c_void, camera: *const CameraModel) -> c_int>;

/// `lensprof_map`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Map {
    pub columns: u32,
    pub rows: u32,
    pub channels: u32,
    pub sense: u32,
    pub values: *const f32,
}

/// `lensprof_format_info`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FormatInfo {
    pub format: u32,
    pub holds: u32,
    pub is_written: u32,
    pub is_many: u32,
    pub name: *const c_char,
    pub about: *const c_char,
}

/// `lensprof_import_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ImportOptions {
    pub struct_size: u32,
    pub format: u32,
    pub width: u32,
    pub height: u32,
    pub columns: u32,
    pub rows: u32,
    pub layout: u32,
    pub curve: u32,
    pub color_temperature_k: f64,
    pub name: *const c_char,
    pub map: *const Map,
    pub key: *const ProfileKey,
    pub strict: u32,
    pub reserved: u32,
}

/// `lensprof_export_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ExportOptions {
    pub struct_size: u32,
    pub format: u32,
    pub width: u32,
    pub height: u32,
    pub columns: u32,
    pub rows: u32,
    pub layout: u32,
    pub dng_form: u32,
    pub curve: u32,
    pub pack: u32,
    pub color_temperature_k: f64,
    pub name: *const c_char,
    pub camera: *const CameraModel,
    pub into: *const c_void,
    pub into_size: usize,
    pub cost_ev: *mut f64,
}

/// `lensprof_online_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct OnlineOptions {
    pub struct_size: u32,
    pub width: u32,
    pub height: u32,
    pub channels: u32,
    pub camera_kind: u32,
    pub tracks: u32,
    pub keyframes: u32,
    pub modes: u32,
    pub history: u32,
    pub reserved: u32,
    pub center: [f64; 2],
    pub black: f64,
    pub white: f64,
    pub profile: *const Profile,
}

/// `lensprof_online_observation`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct OnlineObservation {
    pub track: u64,
    pub x: f32,
    pub y: f32,
    pub value: [f32; 3],
    pub weight: f32,
}

/// `lensprof_online_frame`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct OnlineFrame {
    pub struct_size: u32,
    pub count: u32,
    pub number: u64,
    pub known_ev: f64,
    pub known_ev_sigma: f64,
    pub observations: *const OnlineObservation,
}

/// `lensprof_online_exposure`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct OnlineExposure {
    pub struct_size: u32,
    pub state: u32,
    pub number: u64,
    pub since: u64,
    pub before: u64,
    pub ev: f64,
    pub ev_sigma: f64,
    pub step_ev: f64,
    pub step_sigma: f64,
    pub white_balance: [f64; 3],
    pub tracks: u32,
    pub outliers: u32,
    pub unusable: u32,
    pub keyframe: u32,
}

/// `lensprof_online_result`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct OnlineResult {
    pub struct_size: u32,
    pub known: u32,
    pub frames: u64,
    pub lost: u64,
    pub chains: u64,
    pub keyframes: u64,
    pub observations: u64,
    pub windows: u64,
    pub gamma: f64,
    pub log_gamma_sigma: f64,
    pub shape_sigma: f64,
    pub corner: f64,
    pub corner_sigma: f64,
    pub falloff_sigma: f64,
    pub noise_levels: f64,
    pub known_ev_scatter: f64,
    pub inlier_share: f64,
}

/// Opaque.
#[repr(C)]
pub struct Online {
    _private: [u8; 0],
}

/// `lensprof_packed_image`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PackedImage {
    pub data: *const c_void,
    pub row_bytes: isize,
    pub width: u32,
    pub height: u32,
}

/// `lensprof_packed_target`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PackedTarget {
    pub data: *mut c_void,
    pub row_bytes: isize,
    pub width: u32,
    pub height: u32,
}

/// Opaque.
#[repr(C)]
pub struct Rendering {
    _private: [u8; 0],
}

/// `lensprof_rendering_shot`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RenderingShot {
    pub struct_size: u32,
    pub width: u32,
    pub height: u32,
    pub quarter_turns: u32,
    pub shift: [f64; 2],
    pub scale: f64,
    pub k1: f64,
    pub k2: f64,
    pub correlation: f64,
    pub texture: f64,
    pub channels: u32,
    pub squares: u32,
    pub black: u32,
    pub white: u32,
    pub colourful: u32,
    pub saturated: u32,
    pub rough: u32,
    pub areas: u32,
    pub corrects_falloff: u32,
    pub tones: u32,
    pub radius: f64,
    pub corner: f64,
    pub corner_sigma: f64,
    pub pattern_levels: f64,
    pub pattern_ev: f64,
    pub noise_levels: f64,
    pub white_ev: f64,
    pub gamma: f64,
    pub gamma_sigma: f64,
    pub colour: [f64; 9],
    pub falloff: [f64; 3],
    pub saturation: f64,
}

/// `lensprof_rendering_result`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RenderingResult {
    pub struct_size: u32,
    pub usable: u32,
    pub findings: u32,
    pub passed: u32,
    pub response: Response,
    pub gamma: f64,
    pub gamma_sigma: f64,
    pub lowest: f64,
    pub highest: f64,
    pub tenths: u32,
    pub shows_white: u32,
    pub corrects_falloff: u32,
    pub shots: u32,
    pub areas: u32,
    pub reserved: u32,
}

/// `lensprof_sensor_levels`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SensorLevels {
    pub black: [f64; 4],
    pub white: f64,
}

/// `lensprof_readout`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Readout {
    pub struct_size: u32,
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
    pub step: u32,
    pub flip: u32,
    pub side: u32,
    pub plane: [u8; 16],
    pub channel: [u8; 4],
    pub columns: u32,
    pub rows: u32,
    pub gains: *const f32,
    pub levels: *const SensorLevels,
    pub output_levels: *const SensorLevels,
}

/// Opaque.
#[repr(C)]
pub struct SensorPlan {
    _private: [u8; 0],
}

/// Opaque.
#[repr(C)]
pub struct SensorFlat {
    _private: [u8; 0],
}

/// Opaque.
#[repr(C)]
pub struct Store {
    _private: [u8; 0],
}

/// `lensprof_lookup_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct LookupOptions {
    pub struct_size: u32,
    pub distance_rule: u32,
    pub with_doubt: u32,
    pub any_processing: u32,
    pub force_falloff: u32,
    pub response_alone: u32,
}

/// `lensprof_lookup`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Lookup {
    pub struct_size: u32,
    pub exact: u32,
    pub rows: u32,
    pub reserved: u32,
    pub id: [i64; 24],
    pub weight: [f64; 24],
    pub distance: f64,
    pub sigma: f64,
    pub name_score: f64,
    pub reason: [c_char; 256],
    pub reason_code: [u32; 8],
    pub falloff_sigma: f64,
    pub distance_sigma: f64,
    pub sensor_sigma: f64,
    pub response_sigma: f64,
    pub response_from: u32,
    pub camera_kind: u32,
    pub falloff_store: u32,
    pub response_store: u32,
    pub response_rows: u32,
    pub reserved2: u32,
    pub response_id: [i64; 8],
    pub response_weight: [f64; 8],
    pub nearest: [[c_char; 128]; 3],
}

/// `lensprof_store_row`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StoreRow {
    pub id: i64,
    pub damaged: u32,
    pub reserved: [u32; 3],
    pub key: ProfileKey,
    pub provenance: Provenance,
}

/// `lensprof_store_fault`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StoreFault {
    pub id: i64,
    pub reason: [c_char; 256],
}

pub type FaultVisitor = Option<unsafe extern "C" fn(user: *mut c_void, fault: *const StoreFault) -> c_int>;

/// `lensprof_store_group`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StoreGroup {
    pub name: [c_char; 256],
    pub profiles: u32,
    pub reserved: u32,
}

/// `lensprof_store_stats`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StoreStats {
    pub struct_size: u32,
    pub layout: u32,
    pub profiles: u32,
    pub cameras: u32,
    pub lenses: u32,
    pub units: u32,
    pub processing: [u32; 3],
    pub with_covariance: u32,
    pub with_grid: u32,
    pub with_doubt: u32,
    pub methods: u32,
    pub sources: u32,
    pub focal_mm: [f64; 2],
    pub aperture: [f64; 2],
    pub distance_m: [f64; 2],
    pub method: [StoreGroup; 8],
    pub source: [StoreGroup; 8],
    pub bytes: i64,
}

/// `lensprof_store_summary`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StoreSummary {
    pub camera_maker: [c_char; 64],
    pub camera_model: [c_char; 64],
    pub lens: [c_char; 128],
    pub profiles: u32,
    pub others: u32,
    pub processing: [u32; 3],
    pub reserved: u32,
    pub focal_mm: [f64; 2],
    pub aperture: [f64; 2],
    pub distance_m: [f64; 2],
}

/// `lensprof_trial_options`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct TrialOptions {
    pub struct_size: u32,
    pub channels: u32,
    pub camera_kind: u32,
    pub reserved: u32,
}

/// `lensprof_trial_candidate`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct TrialCandidate {
    pub struct_size: u32,
    pub has_falloff: u32,
    pub response_from: u32,
    pub response_profile: u32,
    pub as_good_as_best: u32,
    pub better_than_none: u32,
    pub heldout_rms: f64,
    pub heldout_median: f64,
    pub above_best: f64,
    pub above_best_sigma: f64,
    pub below_none: f64,
    pub below_none_sigma: f64,
    pub corners: u32,
    pub rings: u32,
    pub ring_ev: [f64; 5],
    pub ring_sigma_ev: [f64; 5],
}

/// `lensprof_trial_result`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct TrialResult {
    pub struct_size: u32,
    pub usable: u32,
    pub best: u32,
    pub decided: u32,
    pub images: u32,
    pub fitted: u32,
    pub measured: u32,
    pub unexplained: u32,
    pub before_rms: f64,
    pub ring_end: [f64; 5],
}

impl Default for GainGrid {
    /// As `lensprof_gain_grid_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_gain_grid_init((&mut value as *mut Self).cast()) };
        value
    }
}

impl Default for Exposure {
    /// As `lensprof_exposure_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_exposure_init((&mut value as *mut Self).cast()) };
        value
    }
}

impl Default for ProfileKey {
    /// As `lensprof_profile_key_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_profile_key_init((&mut value as *mut Self).cast()) };
        value
    }
}

impl Default for CameraModel {
    /// As `lensprof_camera_model_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_camera_model_init((&mut value as *mut Self).cast()) };
        value
    }
}

impl Default for Profile {
    /// As `lensprof_profile_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_profile_init_sized((&mut value as *mut Self).cast(), size_of::<Profile>()) };
        value
    }
}

impl Default for ApplyOptions {
    /// As `lensprof_apply_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_apply_options_init_sized((&mut value as *mut Self).cast(), size_of::<ApplyOptions>()) };
        value
    }
}

impl Default for DeflickerOptions {
    /// As `lensprof_deflicker_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_deflicker_options_init_sized((&mut value as *mut Self).cast(), size_of::<DeflickerOptions>()) };
        value
    }
}

impl Default for DeflickerFacts {
    /// As `lensprof_deflicker_facts_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_deflicker_facts_init_sized((&mut value as *mut Self).cast(), size_of::<DeflickerFacts>()) };
        value
    }
}

impl Default for DeflickerFrame {
    /// As `lensprof_deflicker_frame_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<DeflickerFrame>()) };
        value
    }
}

impl Default for DeflickerResult {
    /// As `lensprof_deflicker_result_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<DeflickerResult>()) };
        value
    }
}

impl Default for DeflickerTarget {
    /// As `lensprof_deflicker_target_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_deflicker_target_init_sized((&mut value as *mut Self).cast(), size_of::<DeflickerTarget>()) };
        value
    }
}

impl Default for ExposuresInfo {
    /// As `lensprof_exposures_info_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<ExposuresInfo>()) };
        value
    }
}

impl Default for ExposuresCamera {
    /// As `lensprof_exposures_camera_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_exposures_camera_init_sized((&mut value as *mut Self).cast(), size_of::<ExposuresCamera>()) };
        value
    }
}

impl Default for ExposuresLens {
    /// As `lensprof_exposures_lens_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_exposures_lens_init_sized((&mut value as *mut Self).cast(), size_of::<ExposuresLens>()) };
        value
    }
}

impl Default for ExposuresImage {
    /// As `lensprof_exposures_image_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_exposures_image_init_sized((&mut value as *mut Self).cast(), size_of::<ExposuresImage>()) };
        value
    }
}

impl Default for Finding {
    /// As `lensprof_finding_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<Finding>()) };
        value
    }
}

impl Default for FieldsOptions {
    /// As `lensprof_fields_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_fields_options_init_sized((&mut value as *mut Self).cast(), size_of::<FieldsOptions>()) };
        value
    }
}

impl Default for FieldsImage {
    /// As `lensprof_fields_image_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<FieldsImage>()) };
        value
    }
}

impl Default for FieldsResult {
    /// As `lensprof_fields_result_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<FieldsResult>()) };
        value
    }
}

impl Default for SampleImage {
    /// As `lensprof_sample_image_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_sample_image_init_sized((&mut value as *mut Self).cast(), size_of::<SampleImage>()) };
        value
    }
}

impl Default for SampleOptions {
    /// As `lensprof_sample_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_sample_options_init_sized((&mut value as *mut Self).cast(), size_of::<SampleOptions>()) };
        value
    }
}

impl Default for FitOptions {
    /// As `lensprof_fit_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_fit_options_init_sized((&mut value as *mut Self).cast(), size_of::<FitOptions>()) };
        value
    }
}

impl Default for FitImageQuality {
    /// As `lensprof_fit_image_quality_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<FitImageQuality>()) };
        value
    }
}

impl Default for FitResult {
    /// As `lensprof_fit_result_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<FitResult>()) };
        value
    }
}

impl Default for FitCamera {
    /// As `lensprof_fit_camera_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<FitCamera>()) };
        value
    }
}

impl Default for FlatImage {
    /// As `lensprof_flat_image_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_flat_image_init_sized((&mut value as *mut Self).cast(), size_of::<FlatImage>()) };
        value
    }
}

impl Default for FlatOptions {
    /// As `lensprof_flat_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_flat_options_init_sized((&mut value as *mut Self).cast(), size_of::<FlatOptions>()) };
        value
    }
}

impl Default for FlatImageQuality {
    /// As `lensprof_flat_image_quality_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<FlatImageQuality>()) };
        value
    }
}

impl Default for FlatResult {
    /// As `lensprof_flat_result_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<FlatResult>()) };
        value
    }
}

impl Default for PtoImage {
    /// As `lensprof_pto_image_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<PtoImage>()) };
        value
    }
}

impl Default for ImportOptions {
    /// As `lensprof_import_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_import_options_init_sized((&mut value as *mut Self).cast(), size_of::<ImportOptions>()) };
        value
    }
}

impl Default for ExportOptions {
    /// As `lensprof_export_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_export_options_init_sized((&mut value as *mut Self).cast(), size_of::<ExportOptions>()) };
        value
    }
}

impl Default for OnlineOptions {
    /// As `lensprof_online_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_online_options_init_sized((&mut value as *mut Self).cast(), size_of::<OnlineOptions>()) };
        value
    }
}

impl Default for OnlineFrame {
    /// As `lensprof_online_frame_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_online_frame_init_sized((&mut value as *mut Self).cast(), size_of::<OnlineFrame>()) };
        value
    }
}

impl Default for OnlineExposure {
    /// As `lensprof_online_exposure_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_online_exposure_init_sized((&mut value as *mut Self).cast(), size_of::<OnlineExposure>()) };
        value
    }
}

impl Default for OnlineResult {
    /// As `lensprof_online_result_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_online_result_init_sized((&mut value as *mut Self).cast(), size_of::<OnlineResult>()) };
        value
    }
}

impl Default for RenderingShot {
    /// As `lensprof_rendering_shot_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<RenderingShot>()) };
        value
    }
}

impl Default for RenderingResult {
    /// As `lensprof_rendering_result_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<RenderingResult>()) };
        value
    }
}

impl Default for Readout {
    /// As `lensprof_readout_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_readout_init_sized((&mut value as *mut Self).cast(), size_of::<Readout>()) };
        value
    }
}

impl Default for LookupOptions {
    /// As `lensprof_lookup_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<LookupOptions>()) };
        value
    }
}

impl Default for Lookup {
    /// As `lensprof_lookup_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<Lookup>()) };
        value
    }
}

impl Default for StoreStats {
    /// As `lensprof_store_stats_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<StoreStats>()) };
        value
    }
}

impl Default for TrialOptions {
    /// As `lensprof_trial_options_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_trial_options_init_sized((&mut value as *mut Self).cast(), size_of::<TrialOptions>()) };
        value
    }
}

impl Default for TrialCandidate {
    /// As `lensprof_trial_candidate_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<TrialCandidate>()) };
        value
    }
}

impl Default for TrialResult {
    /// As `lensprof_trial_result_init` sets it.
    fn default() -> Self {
        // SAFETY: every member is a number or a pointer, for which zero is a value.
        let mut value: Self = unsafe { zeroed() };
        unsafe { lensprof_init_sized((&mut value as *mut Self).cast(), size_of::<TrialResult>()) };
        value
    }
}

#[link(name = "lensprof")]
extern "C" {
    pub fn lensprof_status_name(status: c_int) -> *const c_char;
    pub fn lensprof_init_sized(given: *mut c_void, size: usize);
    pub fn lensprof_version() -> *const c_char;
    pub fn lensprof_response_set_linear(response: *mut Response);
    pub fn lensprof_response_set_gamma(response: *mut Response, gamma: f64) -> c_int;
    pub fn lensprof_response_set_srgb(response: *mut Response);
    pub fn lensprof_response_set_emor(response: *mut Response, coefficients: *const f64, modes: u32) -> c_int;
    pub fn lensprof_response_set_table(response: *mut Response, values: *const f64, count: u32) -> c_int;
    pub fn lensprof_response_validate(response: *const Response) -> c_int;
    pub fn lensprof_response_eval(response: *const Response, x: f64, slope: *mut f64) -> f64;
    pub fn lensprof_response_invert(response: *const Response, b: f64, slope: *mut f64) -> f64;
    pub fn lensprof_response_eval_many(response: *const Response, x: *const f64, count: usize, values: *mut f64, slopes: *mut f64);
    pub fn lensprof_response_invert_many(response: *const Response, b: *const f64, count: usize, irradiances: *mut f64, slopes: *mut f64);
    pub fn lensprof_response_set_typical(response: *mut Response, camera_kind: u32, covariance: *mut f64, log_gamma_sigma: *mut f64) -> c_int;
    pub fn lensprof_emor_table(mode: u32) -> *const f64;
    pub fn lensprof_half_diagonal(width: u32, height: u32) -> f64;
    pub fn lensprof_vignetting_eval(vignetting: *const Vignetting, r2: f64, slope: *mut f64) -> f64;
    pub fn lensprof_vignetting_eval_many(vignetting: *const Vignetting, r2: *const f64, count: usize, values: *mut f64, slopes: *mut f64);
    pub fn lensprof_vignetting_r2(vignetting: *const Vignetting, width: u32, height: u32, x: f64, y: f64, gradient: *mut f64) -> f64;
    pub fn lensprof_vignetting_r2_many(vignetting: *const Vignetting, width: u32, height: u32, xy: *const f64, count: usize, r2: *mut f64, gradients: *mut f64);
    pub fn lensprof_vignetting_validate(vignetting: *const Vignetting) -> c_int;
    pub fn lensprof_gain_grid_init(grid: *mut GainGrid);
    pub fn lensprof_gain_grid_validate(grid: *const GainGrid) -> c_int;
    pub fn lensprof_gain_grid_eval(grid: *const GainGrid, width: u32, height: u32, x: f64, y: f64, channel: u32) -> f64;
    pub fn lensprof_gain_grid_eval_many(grid: *const GainGrid, width: u32, height: u32, xy: *const f64, count: usize, channel: u32, attenuations: *mut f64);
    pub fn lensprof_levels_validate(levels: *const Levels) -> c_int;
    pub fn lensprof_levels_to_value(levels: *const Levels, channel: u32, sample: f64) -> f64;
    pub fn lensprof_levels_to_sample(levels: *const Levels, channel: u32, value: f64) -> f64;
    pub fn lensprof_image_circle_validate(circle: *const ImageCircle) -> c_int;
    pub fn lensprof_image_circle_contains(circle: *const ImageCircle, width: u32, height: u32, x: f64, y: f64) -> c_int;
    pub fn lensprof_exposure_init(exposure: *mut Exposure);
    pub fn lensprof_exposure_validate(exposure: *const Exposure) -> c_int;
    pub fn lensprof_exposure_mean(exposures: *const Exposure, count: usize, mean: *mut Exposure);
    pub fn lensprof_profile_key_init(key: *mut ProfileKey);
    pub fn lensprof_profile_key_validate(key: *const ProfileKey) -> c_int;
    pub fn lensprof_camera_kind_of(key: *const ProfileKey) -> u32;
    pub fn lensprof_camera_model_init(camera: *mut CameraModel);
    pub fn lensprof_profile_init_sized(profile: *mut Profile, size: usize);
    pub fn lensprof_profile_copy(to: *mut Profile, from: *const Profile) -> c_int;
    pub fn lensprof_profile_validate(profile: *const Profile) -> c_int;
    pub fn lensprof_profile_falloff(profile: *const Profile, channel: u32, width: u32, height: u32, x: f64, y: f64, sigma: *mut f64) -> f64;
    pub fn lensprof_profile_radial_falloff(profile: *const Profile, channel: u32, r: f64, sigma: *mut f64) -> f64;
    pub fn lensprof_profile_pack(profile: *const Profile, flags: u32, data: *mut c_void, capacity: usize, count: *mut usize) -> c_int;
    pub fn lensprof_profile_unpack(data: *const c_void, size: usize, profile: *mut Profile) -> c_int;
    pub fn lensprof_layout_samples(layout: u32) -> u32;
    pub fn lensprof_layout_channels(layout: u32) -> u32;
    pub fn lensprof_sample_type_bytes(r#type: u32) -> u32;
    pub fn lensprof_image_validate(image: *const Image) -> c_int;
    pub fn lensprof_apply_options_init_sized(options: *mut ApplyOptions, size: usize);
    pub fn lensprof_apply_options_set_profile(options: *mut ApplyOptions, profile: *const Profile) -> c_int;
    pub fn lensprof_plan_bytes(options: *const ApplyOptions) -> usize;
    pub fn lensprof_plan_init(memory: *mut c_void, size: usize, options: *const ApplyOptions, plan: *mut *const Plan, error: *mut ErrorText) -> c_int;
    pub fn lensprof_apply(plan: *const Plan, source: *const Image, target: *const Target, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_apply_planar(plan: *const Plan, source: *const Image, target: *const Target, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_deflicker_options_init_sized(options: *mut DeflickerOptions, size: usize);
    pub fn lensprof_deflicker_facts_init_sized(facts: *mut DeflickerFacts, size: usize);
    pub fn lensprof_deflicker_target_init_sized(target: *mut DeflickerTarget, size: usize);
    pub fn lensprof_deflicker_create(options: *const DeflickerOptions, deflicker: *mut *mut Deflicker, error: *mut ErrorText) -> c_int;
    pub fn lensprof_deflicker_destroy(deflicker: *mut Deflicker);
    pub fn lensprof_deflicker_add(deflicker: *mut Deflicker, frame: *const Image, facts: *const DeflickerFacts, error: *mut ErrorText) -> c_int;
    pub fn lensprof_deflicker_measure(deflicker: *mut Deflicker, result: *mut DeflickerResult, error: *mut ErrorText) -> c_int;
    pub fn lensprof_deflicker_frame_at(deflicker: *const Deflicker, index: u32, frame: *mut DeflickerFrame, error: *mut ErrorText) -> c_int;
    pub fn lensprof_deflicker_curve(deflicker: *const Deflicker, target: *const DeflickerTarget, exposures: *mut Exposure, count: u32, window: *mut f64, error: *mut ErrorText) -> c_int;
    pub fn lensprof_deflicker_shading(deflicker: *const Deflicker, index: u32, shading: *mut GainGrid, error: *mut ErrorText) -> c_int;
    pub fn lensprof_settings_ev(time_s: f64, f_number: f64, iso: f64) -> f64;
    pub fn lensprof_known_exposures(settings: *const ExposureSettings, count: u32, known: *mut KnownExposure, error: *mut ErrorText) -> c_int;
    pub fn lensprof_exposures_camera_init_sized(camera: *mut ExposuresCamera, size: usize);
    pub fn lensprof_exposures_lens_init_sized(lens: *mut ExposuresLens, size: usize);
    pub fn lensprof_exposures_image_init_sized(image: *mut ExposuresImage, size: usize);
    pub fn lensprof_exposures_read(data: *const c_void, size: usize, exposures: *mut *mut Exposures, error: *mut ErrorText) -> c_int;
    pub fn lensprof_exposures_destroy(exposures: *mut Exposures);
    pub fn lensprof_exposures_get_info(exposures: *const Exposures, info: *mut ExposuresInfo, error: *mut ErrorText) -> c_int;
    pub fn lensprof_exposures_get_camera(exposures: *const Exposures, index: u32, camera: *mut ExposuresCamera, error: *mut ErrorText) -> c_int;
    pub fn lensprof_exposures_get_lens(exposures: *const Exposures, index: u32, lens: *mut ExposuresLens, error: *mut ErrorText) -> c_int;
    pub fn lensprof_exposures_get_image(exposures: *const Exposures, index: u32, image: *mut ExposuresImage, error: *mut ErrorText) -> c_int;
    pub fn lensprof_exposures_write(info: *const ExposuresInfo, cameras: *const ExposuresCamera, lenses: *const ExposuresLens, images: *const ExposuresImage, data: *mut c_void, capacity: usize, count: *mut usize, error: *mut ErrorText) -> c_int;
    pub fn lensprof_reason_name(reason: u32) -> *const c_char;
    pub fn lensprof_reason_text(reason: u32) -> *const c_char;
    pub fn lensprof_fields_options_init_sized(options: *mut FieldsOptions, size: usize);
    pub fn lensprof_fields_create(options: *const FieldsOptions, fields: *mut *mut Fields, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fields_destroy(fields: *mut Fields);
    pub fn lensprof_fields_add(fields: *mut Fields, view: *const Image, mask: *const u8, mask_row_bytes: isize, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fields_fit(fields: *mut Fields, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fields_get(fields: *const Fields, result: *mut FieldsResult, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fields_image_at(fields: *const Fields, index: u32, image: *mut FieldsImage, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fields_smoothness_at(fields: *const Fields, channel: u32, index: u32, smoothness: *mut FieldsSmoothness, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fields_finding_at(fields: *const Fields, index: u32, finding: *mut Finding, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fields_profile(fields: *const Fields, profile: *mut Profile, error: *mut ErrorText) -> c_int;
    pub fn lensprof_camera_validate(camera: *const Camera) -> c_int;
    pub fn lensprof_camera_project(camera: *const Camera, longitude: f64, latitude: f64, xy: *mut f64) -> c_int;
    pub fn lensprof_camera_unproject(camera: *const Camera, x: f64, y: f64, direction: *mut f64) -> c_int;
    pub fn lensprof_camera_project_many(camera: *const Camera, directions: *const f64, count: usize, xy: *mut f64) -> usize;
    pub fn lensprof_camera_unproject_many(camera: *const Camera, xy: *const f64, count: usize, directions: *mut f64) -> usize;
    pub fn lensprof_sample_image_init_sized(image: *mut SampleImage, size: usize);
    pub fn lensprof_sample_options_init_sized(options: *mut SampleOptions, size: usize);
    pub fn lensprof_sample_overlap(options: *const SampleOptions, images: *const SampleImage, image_count: u32, pairs: *mut Pair, capacity: u32, count: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_sample_tracks(options: *const SampleOptions, images: *const SampleImage, image_count: u32, observations: *mut Observation, capacity: u32, count: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_sample_matches(options: *const SampleOptions, images: *const SampleImage, image_count: u32, matches: *const Match, match_count: u32, pairs: *mut Pair, capacity: u32, count: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_image_init_sized(image: *mut FitImage, size: usize, index: u32, width: u32, height: u32);
    pub fn lensprof_fit_options_init_sized(options: *mut FitOptions, size: usize);
    pub fn lensprof_fit_bytes(images: *const FitImage, image_count: u32) -> usize;
    pub fn lensprof_fit_overlap(options: *const FitOptions, images: *const FitImage, image_count: u32, pairs: *const Pair, pair_count: u32, memory: *mut c_void, size: usize, exposures: *mut Exposure, fit: *mut *mut Fit, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_radiance(options: *const FitOptions, images: *const FitImage, image_count: u32, observations: *const Observation, observation_count: u32, memory: *mut c_void, size: usize, exposures: *mut Exposure, fit: *mut *mut Fit, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_destroy(fit: *mut Fit);
    pub fn lensprof_fit_image_at(fit: *const Fit, index: u32, quality: *mut FitImageQuality, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_setting_at(fit: *const Fit, setting: u32, result: *mut FitResult, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_camera_at(fit: *const Fit, camera: u32, result: *mut FitCamera, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_finding_at(fit: *const Fit, setting: u32, index: u32, finding: *mut Finding, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_profile(fit: *const Fit, setting: u32, profile: *mut Profile, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_transfer_rms(fit: *const Fit, pairs: *const Pair, pair_count: u32, rms: *mut f64, median: *mut f64, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fit_colour_differences(fit: *const Fit, pairs: *const Pair, pair_count: u32, differences: *mut f64, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fixed_plan_bytes(options: *const ApplyOptions) -> usize;
    pub fn lensprof_fixed_plan_init(memory: *mut c_void, size: usize, options: *const ApplyOptions, plan: *mut *const FixedPlan, error: *mut ErrorText) -> c_int;
    pub fn lensprof_fixed_plan_open(data: *const c_void, size: usize, plan: *mut *const FixedPlan) -> c_int;
    pub fn lensprof_fixed_apply(plan: *const FixedPlan, source: *const Image, target: *const Target, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_flat_image_init_sized(image: *mut FlatImage, size: usize);
    pub fn lensprof_flat_options_init_sized(options: *mut FlatOptions, size: usize);
    pub fn lensprof_flat_bytes(image_count: u32) -> usize;
    pub fn lensprof_fit_flat(options: *const FlatOptions, images: *const FlatImage, image_count: u32, memory: *mut c_void, size: usize, flat: *mut *mut Flat, error: *mut ErrorText) -> c_int;
    pub fn lensprof_flat_destroy(flat: *mut Flat);
    pub fn lensprof_flat_get(flat: *const Flat, result: *mut FlatResult, error: *mut ErrorText) -> c_int;
    pub fn lensprof_flat_image_at(flat: *const Flat, index: u32, quality: *mut FlatImageQuality, error: *mut ErrorText) -> c_int;
    pub fn lensprof_flat_finding_at(flat: *const Flat, index: u32, finding: *mut Finding, error: *mut ErrorText) -> c_int;
    pub fn lensprof_flat_profile(flat: *const Flat, profile: *mut Profile, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_read(data: *const c_void, size: usize, pto: *mut *mut Pto, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_destroy(pto: *mut Pto);
    pub fn lensprof_pto_image_count(pto: *const Pto) -> u32;
    pub fn lensprof_pto_get_image(pto: *const Pto, index: u32, image: *mut PtoImage, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_get_response(pto: *const Pto, index: u32, response: *mut Response, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_get_name(pto: *const Pto, index: u32, name: *mut c_char, capacity: usize, count: *mut usize, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_set_name(pto: *mut Pto, index: u32, name: *const c_char, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_draw_mask(pto: *const Pto, index: u32, mask: *mut u8, width: u32, height: u32, row_bytes: isize, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_set_result(pto: *mut Pto, response: *const Response, vignetting: *const Vignetting, exposures: *const Exposure, image_count: u32, reference: u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_set_settings(pto: *mut Pto, setting: *const u32, image_count: u32, vignetting: *const Vignetting, setting_count: u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_set_cameras(pto: *mut Pto, camera: *const u32, image_count: u32, response: *const Response, camera_count: u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_pto_write(pto: *const Pto, data: *mut c_void, capacity: usize, count: *mut usize, error: *mut ErrorText) -> c_int;
    pub fn lensprof_points_read(data: *const c_void, size: usize, pairs: *mut Pair, capacity: u32, count: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_points_write(pairs: *const Pair, pair_count: u32, cameras: *const Camera, camera_count: u32, data: *mut c_void, capacity: usize, count: *mut usize, error: *mut ErrorText) -> c_int;
    pub fn lensprof_lensfun_read_cameras(data: *const c_void, size: usize, source: *const c_char, visit: CameraVisitor, user: *mut c_void, error: *mut ErrorText) -> c_int;
    pub fn lensprof_map_write(profile: *const Profile, width: u32, height: u32, columns: u32, rows: u32, channels: u32, sense: u32, values: *mut f32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_format_get_info(format: u32) -> *const FormatInfo;
    pub fn lensprof_format_detect(data: *const c_void, size: usize, name: *const c_char) -> u32;
    pub fn lensprof_import_options_init_sized(options: *mut ImportOptions, size: usize);
    pub fn lensprof_import(data: *const c_void, size: usize, options: *const ImportOptions, visit: ImportVisitor, user: *mut c_void, error: *mut ErrorText) -> c_int;
    pub fn lensprof_export_options_init_sized(options: *mut ExportOptions, size: usize);
    pub fn lensprof_export(profiles: *const *const Profile, profile_count: u32, options: *const ExportOptions, data: *mut c_void, capacity: usize, count: *mut usize, error: *mut ErrorText) -> c_int;
    pub fn lensprof_online_options_init_sized(options: *mut OnlineOptions, size: usize);
    pub fn lensprof_online_frame_init_sized(frame: *mut OnlineFrame, size: usize);
    pub fn lensprof_online_exposure_init_sized(exposure: *mut OnlineExposure, size: usize);
    pub fn lensprof_online_result_init_sized(result: *mut OnlineResult, size: usize);
    pub fn lensprof_online_bytes(options: *const OnlineOptions) -> usize;
    pub fn lensprof_online_begin(memory: *mut c_void, size: usize, options: *const OnlineOptions, online: *mut *mut Online, error: *mut ErrorText) -> c_int;
    pub fn lensprof_online_add(online: *mut Online, frame: *const OnlineFrame, exposure: *mut OnlineExposure, error: *mut ErrorText) -> c_int;
    pub fn lensprof_online_solve(online: *mut Online, steps: u32, pending: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_online_exposure_at(online: *const Online, number: u64, exposure: *mut OnlineExposure, error: *mut ErrorText) -> c_int;
    pub fn lensprof_online_get(online: *const Online, result: *mut OnlineResult, error: *mut ErrorText) -> c_int;
    pub fn lensprof_online_profile(online: *const Online, profile: *mut Profile, error: *mut ErrorText) -> c_int;
    pub fn lensprof_packed_row_bytes(packing: u32, width: u32) -> usize;
    pub fn lensprof_unpack_row(packing: u32, packed: *const u8, width: u32, samples: *mut u16) -> c_int;
    pub fn lensprof_pack_row(packing: u32, samples: *const u16, width: u32, packed: *mut u8) -> c_int;
    pub fn lensprof_apply_packed(plan: *const Plan, packing: u32, source: *const PackedImage, target: *const PackedTarget, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_fixed_apply_packed(plan: *const FixedPlan, packing: u32, source: *const PackedImage, target: *const PackedTarget, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_rendering_create(prior: *const Response, progress: Progress, progress_user: *mut c_void, rendering: *mut *mut Rendering, error: *mut ErrorText) -> c_int;
    pub fn lensprof_rendering_destroy(rendering: *mut Rendering);
    pub fn lensprof_rendering_add(rendering: *mut Rendering, raw: *const Image, rendered: *const Image, error: *mut ErrorText) -> c_int;
    pub fn lensprof_rendering_fit(rendering: *mut Rendering, result: *mut RenderingResult, error: *mut ErrorText) -> c_int;
    pub fn lensprof_rendering_shot_at(rendering: *const Rendering, index: u32, shot: *mut RenderingShot, error: *mut ErrorText) -> c_int;
    pub fn lensprof_rendering_finding_at(rendering: *const Rendering, index: u32, finding: *mut Finding, error: *mut ErrorText) -> c_int;
    pub fn lensprof_readout_init_sized(readout: *mut Readout, size: usize);
    pub fn lensprof_readout_set_mosaic(readout: *mut Readout, colors: *const c_char) -> c_int;
    pub fn lensprof_sensor_plan_bytes(readout: *const Readout) -> usize;
    pub fn lensprof_sensor_plan_init(memory: *mut c_void, size: usize, options: *const ApplyOptions, readout: *const Readout, plan: *mut *const SensorPlan, error: *mut ErrorText) -> c_int;
    pub fn lensprof_sensor_plan_error(plan: *const SensorPlan, options: *const ApplyOptions, readout: *const Readout, largest: *mut f64) -> c_int;
    pub fn lensprof_sensor_plan_open(data: *const c_void, size: usize, plan: *mut *const SensorPlan) -> c_int;
    pub fn lensprof_sensor_plan_mix(memory: *mut c_void, size: usize, a: *const SensorPlan, b: *const SensorPlan, share: u32, plan: *mut *const SensorPlan) -> c_int;
    pub fn lensprof_mired_share(a_kelvin: u32, b_kelvin: u32, kelvin: u32) -> u32;
    pub fn lensprof_sensor_apply(plan: *const SensorPlan, source: *const Image, target: *const Target, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_sensor_apply_packed(plan: *const SensorPlan, packing: u32, source: *const PackedImage, target: *const PackedTarget, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_sensor_flat_bytes(readout: *const Readout) -> usize;
    pub fn lensprof_sensor_flat_init(memory: *mut c_void, size: usize, frame_width: u32, frame_height: u32, readout: *const Readout, flat: *mut *mut SensorFlat, error: *mut ErrorText) -> c_int;
    pub fn lensprof_sensor_flat_add(flat: *mut SensorFlat, samples: *const Image, x0: u32, y0: u32) -> c_int;
    pub fn lensprof_sensor_flat_open(data: *mut c_void, size: usize, flat: *mut *mut SensorFlat) -> c_int;
    pub fn lensprof_sensor_flat_work_bytes(flat: *const SensorFlat) -> usize;
    pub fn lensprof_sensor_flat_gains(flat: *const SensorFlat, work: *mut c_void, work_bytes: usize, gains: *mut f32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_open(path: *const c_char, mode: u32, store: *mut *mut Store, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_close(store: *mut Store);
    pub fn lensprof_store_put(store: *mut Store, profile: *const Profile, id: *mut i64, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_find(store: *mut Store, key: *const ProfileKey, profile: *mut Profile, id: *mut i64, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_lookup_in(stores: *const *mut Store, count: u32, key: *const ProfileKey, options: *const LookupOptions, profile: *mut Profile, lookup: *mut Lookup, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_begin(store: *mut Store, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_commit(store: *mut Store, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_rollback(store: *mut Store);
    pub fn lensprof_store_get(store: *mut Store, id: i64, profile: *mut Profile, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_list(store: *mut Store, filter: *const ProfileKey, rows: *mut StoreRow, capacity: u32, count: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_find_same(store: *mut Store, profile: *const Profile, id: *mut i64, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_merge(store: *mut Store, other: *mut Store, added: *mut u32, known: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_put_camera(store: *mut Store, camera: *const CameraModel, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_find_camera(store: *mut Store, maker: *const c_char, model: *const c_char, camera: *mut CameraModel, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_list_camera_models(store: *mut Store, cameras: *mut CameraModel, capacity: u32, count: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_check(store: *mut Store, visit: FaultVisitor, user: *mut c_void, profiles: *mut u32, faults: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_get_stats(store: *mut Store, stats: *mut StoreStats, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_remove(store: *mut Store, id: i64, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_set_key(store: *mut Store, id: i64, key: *const ProfileKey, error: *mut ErrorText) -> c_int;
    pub fn lensprof_store_list_names(store: *mut Store, which: u32, part: *const c_char, rows: *mut StoreSummary, capacity: u32, count: *mut u32, error: *mut ErrorText) -> c_int;
    pub fn lensprof_correct(profile: *const Profile, exposure: *const Exposure, picture: *const Target, error: *mut ErrorText) -> c_int;
    pub fn lensprof_trial_options_init_sized(options: *mut TrialOptions, size: usize);
    pub fn lensprof_trial_run(options: *const TrialOptions, images: *const FitImage, image_count: u32, pairs: *const Pair, pair_count: u32, profiles: *const *const Profile, profile_count: u32, candidates: *mut TrialCandidate, result: *mut TrialResult, error: *mut ErrorText) -> c_int;
}
