// Generated from include/lensprof by bindings/tools/make_abi.py: do not edit; `make abi` regenerates it.
package lensprof;

import com.sun.jna.Callback;
import com.sun.jna.IntegerType;
import com.sun.jna.Library;
import com.sun.jna.Native;
import com.sun.jna.Pointer;
import com.sun.jna.Structure;
import java.lang.annotation.Retention;
import java.lang.annotation.RetentionPolicy;

/** The C interface as tables: structures, enumerations, constants and functions of the public headers. */
public final class Abi {
    private Abi() {
    }

    /** size_t and ptrdiff_t. */
    public static class Size extends IntegerType {
        private static final long serialVersionUID = 1L;

        public Size() {
            this(0);
        }

        public Size(long value) {
            super(Native.SIZE_T_SIZE, value, false);
        }
    }

    /** The name of a structure in C. */
    @Retention(RetentionPolicy.RUNTIME)
    public @interface StructName {
        String value();
    }

    /** A structure that shows where its members lie. */
    public abstract static class Struct extends Structure {
        /** Offset of a member, bytes. */
        public int offset(String field) {
            return fieldOffset(field);
        }

        /** Alignment, bytes. */
        public int alignment() {
            return getStructAlignment();
        }
    }

    /** Version of the headers. */
    public static final String VERSION = "0.3.0";

    public static final int RESPONSE_SAMPLES = 1024;
    public static final int EMOR_MODES = 25;
    public static final int GRID_SIDE = 32;
    public static final double UNKNOWN = -1.0;
    public static final int COVARIANCE_MAX = 36;
    public static final int DEFLICKER_FRAMES = 4194304;
    public static final int FIELDS_IMAGES = 16384;
    public static final int SETTINGS_MAX = 64;
    public static final int CAMERAS_MAX = 64;
    public static final int MODES_AUTO = 0xffffffff;
    public static final int COVERAGE_BINS = 10;
    public static final int FIT_REFERENCE = 0xffffffff;
    public static final int FLAT_IMAGES = 128;
    public static final int FLAT_SPOTS = 32;
    public static final int ONLINE_TRACKS = 8192;
    public static final int ONLINE_KEYFRAMES = 24;
    public static final int ONLINE_MODES = 8;
    public static final int ONLINE_HISTORY = 65536;
    public static final int RENDERING_SHOTS = 16;
    public static final int RENDERING_SIDE = 256;
    public static final int RENDERING_RAW_SIDE = 64;
    public static final int SENSOR_PLANES = 4;
    public static final int SENSOR_GRID_SIDE = 33;
    public static final int LOOKUP_ROWS = 24;
    public static final int LOOKUP_REASONS = 8;
    public static final int LOOKUP_RESPONSES = 8;
    public static final int LOOKUP_NEAREST = 3;
    public static final int STATS_GROUPS = 8;
    public static final int TRIAL_PAIRS = 30;
    public static final int TRIAL_RINGS = 5;
    public static final String DOUBT_RESPONSE = "response not shown by the pictures: typical of the kind";

    /** lensprof_status; see lensprof/base.h. */
    public enum Status {
        OK(0),
        ERROR_ARGUMENT(1),
        ERROR_STRUCT_SIZE(2),
        ERROR_SIZE(3),
        ERROR_CAPACITY(4),
        ERROR_NOT_FINITE(5),
        ERROR_MEMORY(10),
        ERROR_CANCELLED(11),
        ERROR_RESPONSE(20),
        ERROR_VIGNETTING(21),
        ERROR_EXPOSURE(22),
        ERROR_GEOMETRY(23),
        ERROR_NO_OVERLAP(30),
        ERROR_NO_SAMPLES(31),
        ERROR_NO_UNKNOWNS(32),
        ERROR_NOT_USABLE(33),
        ERROR_STORE(40),
        ERROR_NOT_FOUND(41),
        ERROR_CORRUPT(42),
        ERROR_LAYOUT(43),
        ERROR_READ_ONLY(44),
        ERROR_FULL(45),
        ERROR_BUSY(46),
        ERROR_SYNTAX(50),
        ERROR_VARIABLE(51),
        ERROR_UNSUPPORTED(52),
        ERROR_READ(60),
        ERROR_WRITE(61),
        ERROR_INTERNAL(90);

        public final int value;

        Status(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Status of(int value) {
            for (Status each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_item_kind; see lensprof/base.h. */
    public enum ItemKind {
        NONE(0),
        IMAGE(1),
        PAIR(2),
        OBSERVATION(3),
        POINT(4),
        SHOT(5),
        PROFILE(6),
        FRAME(7),
        MATCH(8);

        public final int value;

        ItemKind(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static ItemKind of(int value) {
            for (ItemKind each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_response_kind; see lensprof/model.h. */
    public enum ResponseKind {
        LINEAR(0),
        GAMMA(1),
        EMOR(2),
        TABLE(3);

        public final int value;

        ResponseKind(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static ResponseKind of(int value) {
            for (ResponseKind each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_camera_kind; see lensprof/model.h. */
    public enum CameraKind {
        ANY(0),
        FILM(1),
        DIGITAL(2),
        STILL(3),
        PHONE(4),
        LINEAR(5);

        public final int value;

        CameraKind(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static CameraKind of(int value) {
            for (CameraKind each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_processing; see lensprof/profile.h. */
    public enum Processing {
        RAW(0),
        JPEG(1),
        CORRECTED(2);

        public final int value;

        Processing(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Processing of(int value) {
            for (Processing each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_pack; see lensprof/profile.h. */
    public static final int PACK_COVARIANCE = 1;

    /** lensprof_sample_type; see lensprof/apply.h. */
    public enum SampleType {
        U8(0),
        U16(1),
        F32(2),
        F16(3);

        public final int value;

        SampleType(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static SampleType of(int value) {
            for (SampleType each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_layout; see lensprof/apply.h. */
    public enum Layout {
        GREY(0),
        GREY_ALPHA(1),
        RGB(2),
        RGBA(3),
        BGR(4),
        BGRA(5),
        PLANAR(6),
        RGGB(7),
        GRBG(8),
        GBRG(9),
        BGGR(10);

        public final int value;

        Layout(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Layout of(int value) {
            for (Layout each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_direction; see lensprof/apply.h. */
    public enum Direction {
        CORRECT(0),
        SIMULATE(1);

        public final int value;

        Direction(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Direction of(int value) {
            for (Direction each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_encoding; see lensprof/apply.h. */
    public enum Encoding {
        RESPONSE(0),
        LINEAR(1);

        public final int value;

        Encoding(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Encoding of(int value) {
            for (Encoding each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_saturated; see lensprof/apply.h. */
    public enum Saturated {
        NEUTRAL(0),
        AS_VALUE(1);

        public final int value;

        Saturated(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Saturated of(int value) {
            for (Saturated each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_deflicker_state; see lensprof/deflicker.h. */
    public enum DeflickerState {
        LEVELLED(0),
        DARK(1),
        WHITE(2),
        DISAGREES(3);

        public final int value;

        DeflickerState(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static DeflickerState of(int value) {
            for (DeflickerState each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_deflicker_to; see lensprof/deflicker.h. */
    public enum DeflickerTo {
        SMOOTH(0),
        LIGHT(1),
        MEAN(2),
        FRAME(3),
        CURVE(4);

        public final int value;

        DeflickerTo(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static DeflickerTo of(int value) {
            for (DeflickerTo each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_exposure_state; see lensprof/exposure_settings.h. */
    public enum ExposureState {
        KNOWN(0),
        NO_TIME(1),
        NO_ISO(2),
        NO_APERTURE(3),
        APART(4),
        IMPLAUSIBLE(5);

        public final int value;

        ExposureState(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static ExposureState of(int value) {
            for (ExposureState each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_reason; see lensprof/reason.h. */
    public enum Reason {
        NONE(0),
        IMAGE_GROUPS(101),
        FEW_PAIRS(102),
        FEW_AGREE(103),
        SCATTER(104),
        NOT_CONVERGED(105),
        UNDETERMINED(106),
        FEW_INLIERS(107),
        IMAGE_DISAGREES(108),
        PATTERNS(109),
        IMAGE_INCONSISTENT(110),
        IMAGES_LEFT_OUT(111),
        IMAGES_UNCONNECTED(112),
        MANY_OUTLIERS(113),
        SEAMS_REMAIN(114),
        LINKS_CONTRADICT(115),
        LINKS_UNVERIFIED(116),
        IMAGES_MINORITY(117),
        EXPOSURE_UNCERTAIN(201),
        EXPOSURES_EQUAL(202),
        KNOWN_ORDER(203),
        KNOWN_WRONG(204),
        KNOWN_STEP(205),
        KNOWN_CONTRADICT(206),
        GAMMA_INCONSISTENT(207),
        WHITE_BALANCE_FIXED(208),
        FEW_GREYS(301),
        MISSING_GREYS(302),
        UNUSUAL_RESPONSE(303),
        RESPONSE_UNCONSTRAINED(304),
        SMALL_RADIUS(401),
        CORNER_UNCERTAIN(402),
        FALLOFF_RISES(403),
        CENTER_ON_LIMIT(404),
        FALLOFF_DARK(405),
        SAME_VIEW(406),
        EXPOSURES_ONLY(407),
        NOTHING_BETTER(408),
        NOT_RADIAL(409),
        FAR_CENTER(410),
        FEW_IMAGES(411),
        FLAT_WHITE(501),
        FLAT_BLACK(502),
        FLAT_NO_CARD(503),
        FLAT_FEW_CELLS(504),
        FLAT_RESPONSE(505),
        FLAT_EXPOSURE_WRONG(506),
        FLAT_TEXTURE(507),
        FLAT_SHOTS_DIFFER(508),
        FLAT_STEEP(509),
        FLAT_NOT_RADIAL(510),
        FLAT_CENTER_BY_PRIOR(511),
        FLAT_DUST(512),
        FLAT_EDGE(513),
        FLAT_ONE_LIGHT(514),
        FLAT_NEEDS_GRID(515),
        FLAT_BLACK_LEVEL(516),
        FIELDS_FEW(521),
        FIELDS_REPEATED(522),
        FIELDS_PATTERN(523),
        FIELDS_UNCERTAIN(524),
        FIELDS_OFFSET(525),
        FIELDS_WHITE(526),
        FIELDS_BLACK(527),
        FIELDS_UNSEEN(528),
        FIELDS_GAIN(529),
        LOOKUP_NO_LENS(601),
        LOOKUP_NO_CAMERA(602),
        LOOKUP_OTHER_PROCESSING(603),
        LOOKUP_DOUBTFUL(604),
        LOOKUP_OTHER_CAMERA(605),
        LOOKUP_SEVERAL_LENSES(606),
        LOOKUP_SMALLER_SENSOR(607),
        LOOKUP_FOCAL_MISSING(608),
        LOOKUP_APERTURE_MISSING(609),
        LOOKUP_NO_FOCAL(610),
        LOOKUP_NO_APERTURE(611),
        LOOKUP_FOCAL_BEYOND(612),
        LOOKUP_APERTURE_BEYOND(613),
        LOOKUP_TOO_FAR(614),
        LOOKUP_CONTRADICTION(615),
        LOOKUP_CORRECTED(616),
        LOOKUP_FOCAL_ROUNDED(651),
        LOOKUP_FOCAL_OUTSIDE(652),
        LOOKUP_APERTURE_OUTSIDE(653),
        LOOKUP_OTHER_LIGHT(654),
        LOOKUP_SMALLEST_SENSOR(655),
        LOOKUP_BY_WORDS(656),
        LOOKUP_BUILT_IN(657),
        LOOKUP_WEAKEST_DISTANCE(658),
        LOOKUP_FARTHEST_DISTANCE(659),
        LOOKUP_USUAL_DISTANCE(660),
        LOOKUP_UNKNOWN_SENSOR(661),
        LOOKUP_ON_OTHER_CAMERA(662),
        LOOKUP_TYPICAL_RESPONSE(663),
        LOOKUP_OTHER_STYLE(664),
        PRIOR_OVERRULED(701),
        PRIOR_RESPONSE_OVERRULED(702),
        PRIOR_FALLOFF_OVERRULED(703);

        public final int value;

        Reason(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Reason of(int value) {
            for (Reason each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_severity; see lensprof/reason.h. */
    public enum Severity {
        PASSED(0),
        NOTE(1),
        WARNING(2),
        REFUSAL(3);

        public final int value;

        Severity(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Severity of(int value) {
            for (Severity each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_projection; see lensprof/geometry.h. */
    public enum Projection {
        RECTILINEAR(0),
        CYLINDRICAL(1),
        CIRCULAR_FISHEYE(2),
        FULLFRAME_FISHEYE(3),
        EQUIRECTANGULAR(4),
        ORTHOGRAPHIC(8),
        STEREOGRAPHIC(10),
        THOBY(20),
        EQUISOLID(21);

        public final int value;

        Projection(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Projection of(int value) {
            for (Projection each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_sampling; see lensprof/sample.h. */
    public enum Sampling {
        BALANCED(0),
        PAPER(1),
        BRACKET(2);

        public final int value;

        Sampling(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Sampling of(int value) {
            for (Sampling each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_link_state; see lensprof/sample.h. */
    public enum LinkState {
        UNVERIFIED(0),
        VERIFIED(1),
        CONTRADICTED(2);

        public final int value;

        LinkState(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static LinkState of(int value) {
            for (LinkState each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_fit_method; see lensprof/fit.h. */
    public enum Method {
        TRANSFER(0),
        RADIANCE(1),
        TRANSFER_FUNCTION(2);

        public final int value;

        Method(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Method of(int value) {
            for (Method each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_loss; see lensprof/fit.h. */
    public enum Loss {
        ROBUST(0),
        HUBER(1),
        SQUARED(2);

        public final int value;

        Loss(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Loss of(int value) {
            for (Loss each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_gamma_from; see lensprof/fit.h. */
    public enum GammaFrom {
        AUTO(0),
        PRIOR(1),
        EXPOSURES(2),
        KNOWN(3),
        NONE(4),
        PROFILE(5),
        FALLOFF(6),
        CAMERAS(7);

        public final int value;

        GammaFrom(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static GammaFrom of(int value) {
            for (GammaFrom each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_fit_response; see lensprof/fit.h. */
    public enum FitResponse {
        PICTURES(0),
        OPTIONS(1),
        KIND(2),
        PROFILE(3);

        public final int value;

        FitResponse(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static FitResponse of(int value) {
            for (FitResponse each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_fit_model; see lensprof/fit.h. */
    public enum FitModel {
        FULL(0),
        LENS(1),
        EXPOSURES(2),
        NOTHING(3);

        public final int value;

        FitModel(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static FitModel of(int value) {
            for (FitModel each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_profile_prior; see lensprof/fit.h. */
    public enum ProfilePrior {
        NONE(0),
        USED(1),
        OVERRULED(2),
        RESPONSE_OVERRULED(3),
        FALLOFF_OVERRULED(4);

        public final int value;

        ProfilePrior(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static ProfilePrior of(int value) {
            for (ProfilePrior each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_flat_light; see lensprof/flat.h. */
    public enum FlatLight {
        AUTO(0),
        EVEN(1),
        PLANE(2),
        QUADRATIC(3);

        public final int value;

        FlatLight(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static FlatLight of(int value) {
            for (FlatLight each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_flat_grid; see lensprof/flat.h. */
    public enum FlatGrid {
        AUTO(0),
        NONE(1),
        ALWAYS(2);

        public final int value;

        FlatGrid(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static FlatGrid of(int value) {
            for (FlatGrid each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_curve; see lensprof/formats.h. */
    public enum CurveKind {
        INVERSE(0),
        LOG(1),
        LOG10(2),
        FORWARD(3);

        public final int value;

        CurveKind(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static CurveKind of(int value) {
            for (CurveKind each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_map_sense; see lensprof/formats.h. */
    public enum MapSense {
        ATTENUATION(0),
        GAIN(1);

        public final int value;

        MapSense(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static MapSense of(int value) {
            for (MapSense each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_dng_form; see lensprof/formats.h. */
    public enum DngForm {
        RADIAL(0),
        GAIN_MAP(1),
        AUTO(2);

        public final int value;

        DngForm(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static DngForm of(int value) {
            for (DngForm each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_format; see lensprof/formats.h. */
    public enum Format {
        AUTO(0),
        LENSFUN(1),
        LCP(2),
        JSON(3),
        BLOB(4),
        DNG_OPCODES(5),
        DRONE_XMP(6),
        ALSC(7),
        MAP(8),
        PCALIB(9),
        CURVES(10),
        RADICAL_RESPONSE(11),
        RADICAL_VIGNETTING(12),
        CUBE(13),
        GLSL(14),
        WGSL(15),
        C(16);

        public final int value;

        Format(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Format of(int value) {
            for (Format each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_holds; see lensprof/formats.h. */
    public enum Holds {
        PROFILES(0),
        RESPONSE(1),
        FALLOFF(2);

        public final int value;

        Holds(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Holds of(int value) {
            for (Holds each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_online_state; see lensprof/online.h. */
    public enum OnlineState {
        FIRST(0),
        CHAINED(1),
        LOST(2);

        public final int value;

        OnlineState(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static OnlineState of(int value) {
            for (OnlineState each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_online_known; see lensprof/online.h. */
    public enum OnlineKnown {
        EXPONENT(1),
        SHAPE(2),
        FALLOFF(4);

        public final int value;

        OnlineKnown(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static OnlineKnown of(int value) {
            for (OnlineKnown each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_packing; see lensprof/packed.h. */
    public enum Packing {
        RAW8(8),
        RAW10(10),
        RAW12(12),
        RAW14(14);

        public final int value;

        Packing(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Packing of(int value) {
            for (Packing each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_flip; see lensprof/sensor.h. */
    public enum Flip {
        NONE(0),
        HORIZONTAL(1),
        VERTICAL(2),
        BOTH(3);

        public final int value;

        Flip(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static Flip of(int value) {
            for (Flip each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_store_mode; see lensprof/store.h. */
    public enum StoreMode {
        READ(0),
        WRITE(1),
        CREATE(2);

        public final int value;

        StoreMode(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static StoreMode of(int value) {
            for (StoreMode each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_distance_rule; see lensprof/store.h. */
    public enum DistanceRule {
        USUAL(0),
        WEAKEST(1),
        FARTHEST(2);

        public final int value;

        DistanceRule(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static DistanceRule of(int value) {
            for (DistanceRule each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_response_from; see lensprof/store.h. */
    public enum ResponseFrom {
        PROFILE(0),
        CAMERA(1),
        KIND(2),
        RAW(3);

        public final int value;

        ResponseFrom(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static ResponseFrom of(int value) {
            for (ResponseFrom each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_store_names; see lensprof/store.h. */
    public enum StoreNames {
        LENSES(0),
        CAMERAS(1);

        public final int value;

        StoreNames(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static StoreNames of(int value) {
            for (StoreNames each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_trial_response; see lensprof/trial.h. */
    public enum TrialResponse {
        OWN(0),
        OTHER(1),
        KIND(2),
        LINEAR(3);

        public final int value;

        TrialResponse(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static TrialResponse of(int value) {
            for (TrialResponse each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_trial_corners; see lensprof/trial.h. */
    public enum TrialCorners {
        NOT_SHOWN(0),
        AGREE(1),
        TOO_DARK(2),
        TOO_BRIGHT(3);

        public final int value;

        TrialCorners(int value) {
            this.value = value;
        }

        /** The member with a number of C; null if this version does not have it. */
        public static TrialCorners of(int value) {
            for (TrialCorners each : values()) {
                if (each.value == value) {
                    return each;
                }
            }
            return null;
        }
    }

    /** lensprof_free; see lensprof/fit.h. */
    public static final int FREE_RESPONSE = 1;
    public static final int FREE_K1 = 2;
    public static final int FREE_K2 = 4;
    public static final int FREE_K3 = 8;
    public static final int FREE_CENTER = 16;
    public static final int FREE_EV = 32;
    public static final int FREE_RED = 64;
    public static final int FREE_BLUE = 128;
    public static final int FREE_FALLOFF = 14;
    public static final int FREE_LENS = 31;
    public static final int FREE_IMAGE = 224;

    @StructName("lensprof_item")
    @Structure.FieldOrder({"kind", "index", "text_begin", "text_bytes"})
    public static class Item extends Struct {
        public int kind;
        public int index;
        public int text_begin;
        public int text_bytes;
    }

    @StructName("lensprof_error")
    @Structure.FieldOrder({"text", "item"})
    public static class ErrorText extends Struct {
        public byte[] text = new byte[256];
        public Item item;
    }

    /** lensprof_progress. */
    public interface Progress extends Callback {
        int invoke(double done, Pointer user);
    }

    @StructName("lensprof_response")
    @Structure.FieldOrder({"kind", "modes", "gamma", "emor", "table"})
    public static class Response extends Struct {
        public int kind;
        public int modes;
        public double gamma;
        public double[] emor = new double[25];
        public double[] table = new double[1024];
    }

    @StructName("lensprof_vignetting")
    @Structure.FieldOrder({"k", "center"})
    public static class Vignetting extends Struct {
        public double[] k = new double[3];
        public double[] center = new double[2];
    }

    @StructName("lensprof_gain_grid")
    @Structure.FieldOrder({"columns", "rows", "channels", "reserved", "attenuation"})
    public static class GainGrid extends Struct {
        public int columns;
        public int rows;
        public int channels;
        public int reserved;
        public float[] attenuation = new float[3072];

        /** As lensprof_gain_grid_init sets it. */
        public GainGrid init(Functions library) {
            library.lensprof_gain_grid_init(this);
            read();
            return this;
        }
    }

    @StructName("lensprof_levels")
    @Structure.FieldOrder({"black", "white"})
    public static class Levels extends Struct {
        public double[] black = new double[3];
        public double white;
    }

    @StructName("lensprof_image_circle")
    @Structure.FieldOrder({"center", "radius"})
    public static class ImageCircle extends Struct {
        public double[] center = new double[2];
        public double radius;
    }

    @StructName("lensprof_exposure")
    @Structure.FieldOrder({"ev", "white_balance"})
    public static class Exposure extends Struct {
        public double ev;
        public double[] white_balance = new double[3];

        /** As lensprof_exposure_init sets it. */
        public Exposure init(Functions library) {
            library.lensprof_exposure_init(this);
            read();
            return this;
        }
    }

    @StructName("lensprof_profile_key")
    @Structure.FieldOrder({"camera_maker", "camera_model", "lens", "unit", "crop_factor", "focal_mm", "aperture",
                           "distance_m", "color_temperature_k", "processing", "style", "reserved"})
    public static class ProfileKey extends Struct {
        public byte[] camera_maker = new byte[64];
        public byte[] camera_model = new byte[64];
        public byte[] lens = new byte[128];
        public byte[] unit = new byte[64];
        public double crop_factor;
        public double focal_mm;
        public double aperture;
        public double distance_m;
        public double color_temperature_k;
        public int processing;
        public byte[] style = new byte[64];
        public int[] reserved = new int[21];

        /** As lensprof_profile_key_init sets it. */
        public ProfileKey init(Functions library) {
            library.lensprof_profile_key_init(this);
            read();
            return this;
        }
    }

    @StructName("lensprof_camera_model")
    @Structure.FieldOrder({"maker", "model", "other_maker", "other_model", "variant", "mount", "lens", "source",
                           "crop_factor", "fixed_lens", "reserved"})
    public static class CameraModel extends Struct {
        public byte[] maker = new byte[64];
        public byte[] model = new byte[64];
        public byte[] other_maker = new byte[64];
        public byte[] other_model = new byte[64];
        public byte[] variant = new byte[64];
        public byte[] mount = new byte[64];
        public byte[] lens = new byte[128];
        public byte[] source = new byte[256];
        public double crop_factor;
        public int fixed_lens;
        public int[] reserved = new int[61];

        /** As lensprof_camera_model_init sets it. */
        public CameraModel init(Functions library) {
            library.lensprof_camera_model_init(this);
            read();
            return this;
        }
    }

    @StructName("lensprof_provenance")
    @Structure.FieldOrder({"method", "software", "source", "created_unix_s", "images", "pairs", "heldout_rms",
                           "inlier_share", "doubt", "prior_id", "forced", "not_usable", "gamma_sigma", "reserved"})
    public static class Provenance extends Struct {
        public byte[] method = new byte[32];
        public byte[] software = new byte[32];
        public byte[] source = new byte[256];
        public long created_unix_s;
        public int images;
        public int pairs;
        public double heldout_rms;
        public double inlier_share;
        public byte[] doubt = new byte[64];
        public long prior_id;
        public int forced;
        public int not_usable;
        public double gamma_sigma;
        public int[] reserved = new int[82];
    }

    @StructName("lensprof_profile")
    @Structure.FieldOrder({"struct_size", "responses", "vignettings", "covariance_size", "key", "provenance",
                           "response", "vignetting", "grid", "covariance", "levels", "image_circle"})
    public static class Profile extends Struct {
        public int struct_size;
        public int responses;
        public int vignettings;
        public int covariance_size;
        public ProfileKey key;
        public Provenance provenance;
        public Response[] response = new Response[3];
        public Vignetting[] vignetting = new Vignetting[3];
        public GainGrid grid;
        public double[] covariance = new double[1296];
        public Levels levels;
        public ImageCircle image_circle;

        /** As lensprof_profile_init sets it. */
        public Profile init(Functions library) {
            library.lensprof_profile_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_image")
    @Structure.FieldOrder({"data", "row_bytes", "width", "height", "sample", "layout"})
    public static class Image extends Struct {
        public Pointer data;
        public Size row_bytes = new Size();
        public int width;
        public int height;
        public int sample;
        public int layout;
    }

    @StructName("lensprof_target")
    @Structure.FieldOrder({"data", "row_bytes", "width", "height", "sample", "layout"})
    public static class Target extends Struct {
        public Pointer data;
        public Size row_bytes = new Size();
        public int width;
        public int height;
        public int sample;
        public int layout;
    }

    @StructName("lensprof_apply_options")
    @Structure.FieldOrder({"struct_size", "direction", "input", "output", "frame_width", "frame_height",
                           "source_sample", "source_layout", "target_sample", "saturated", "responses", "vignettings",
                           "response", "vignetting", "source", "target", "grid", "strength", "gain_cap", "dither",
                           "reserved", "blob", "blob_bytes", "output_response", "output_responses", "reserved2",
                           "chroma", "reserved3", "levels", "output_levels", "image_circle"})
    public static class ApplyOptions extends Struct {
        public int struct_size;
        public int direction;
        public int input;
        public int output;
        public int frame_width;
        public int frame_height;
        public int source_sample;
        public int source_layout;
        public int target_sample;
        public int saturated;
        public int responses;
        public int vignettings;
        public Pointer response;
        public Pointer vignetting;
        public Exposure source;
        public Exposure target;
        public Pointer grid;
        public double strength;
        public double gain_cap;
        public int dither;
        public int reserved;
        public Pointer blob;
        public Size blob_bytes = new Size();
        public Pointer output_response;
        public int output_responses;
        public int reserved2;
        public int chroma;
        public int reserved3;
        public Pointer levels;
        public Pointer output_levels;
        public Pointer image_circle;

        /** As lensprof_apply_options_init sets it. */
        public ApplyOptions init(Functions library) {
            library.lensprof_apply_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_deflicker_options")
    @Structure.FieldOrder({"struct_size", "responses", "response", "rows", "reserved", "region"})
    public static class DeflickerOptions extends Struct {
        public int struct_size;
        public int responses;
        public Pointer response;
        public int rows;
        public int reserved;
        public double[] region = new double[4];

        /** As lensprof_deflicker_options_init sets it. */
        public DeflickerOptions init(Functions library) {
            library.lensprof_deflicker_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_deflicker_facts")
    @Structure.FieldOrder({"struct_size", "reserved", "seconds", "settings_ev", "f_number"})
    public static class DeflickerFacts extends Struct {
        public int struct_size;
        public int reserved;
        public double seconds;
        public double settings_ev;
        public double f_number;

        /** As lensprof_deflicker_facts_init sets it. */
        public DeflickerFacts init(Functions library) {
            library.lensprof_deflicker_facts_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_deflicker_frame")
    @Structure.FieldOrder({"struct_size", "state", "segment", "repeats", "seconds", "settings_ev", "exposure",
                           "ev_sigma", "agreeing", "shift", "white_share", "dark_share"})
    public static class DeflickerFrame extends Struct {
        public int struct_size;
        public int state;
        public int segment;
        public int repeats;
        public double seconds;
        public double settings_ev;
        public Exposure exposure;
        public double ev_sigma;
        public double agreeing;
        public double[] shift = new double[2];
        public double white_share;
        public double dark_share;

        /** As lensprof_deflicker_frame_init sets it. */
        public DeflickerFrame init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_deflicker_result")
    @Structure.FieldOrder({"struct_size", "frames", "levelled", "segments", "repeated", "moving", "motion", "unlinked",
                           "flicker", "tone_error", "known_range"})
    public static class DeflickerResult extends Struct {
        public int struct_size;
        public int frames;
        public int levelled;
        public int segments;
        public int repeated;
        public int moving;
        public double motion;
        public double unlinked;
        public double flicker;
        public double tone_error;
        public double known_range;

        /** As lensprof_deflicker_result_init sets it. */
        public DeflickerResult init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_deflicker_target")
    @Structure.FieldOrder({"struct_size", "to", "frame", "reserved", "window_s", "curve"})
    public static class DeflickerTarget extends Struct {
        public int struct_size;
        public int to;
        public int frame;
        public int reserved;
        public double window_s;
        public Pointer curve;

        /** As lensprof_deflicker_target_init sets it. */
        public DeflickerTarget init(Functions library) {
            library.lensprof_deflicker_target_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_exposure_settings")
    @Structure.FieldOrder({"time_s", "f_number", "iso", "camera", "lens", "is_manual", "reserved"})
    public static class ExposureSettings extends Struct {
        public double time_s;
        public double f_number;
        public double iso;
        public int camera;
        public int lens;
        public int is_manual;
        public int reserved;
    }

    @StructName("lensprof_known_exposure")
    @Structure.FieldOrder({"ev", "sigma", "state", "reserved"})
    public static class KnownExposure extends Struct {
        public double ev;
        public double sigma;
        public int state;
        public int reserved;
    }

    @StructName("lensprof_exposures_info")
    @Structure.FieldOrder({"struct_size", "camera_count", "lens_count", "image_count", "reference", "reserved",
                           "software"})
    public static class ExposuresInfo extends Struct {
        public int struct_size;
        public int camera_count;
        public int lens_count;
        public int image_count;
        public int reference;
        public int reserved;
        public Pointer software;

        /** As lensprof_exposures_info_init sets it. */
        public ExposuresInfo init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_exposures_camera")
    @Structure.FieldOrder({"struct_size", "reserved", "name", "response"})
    public static class ExposuresCamera extends Struct {
        public int struct_size;
        public int reserved;
        public Pointer name;
        public Response response;

        /** As lensprof_exposures_camera_init sets it. */
        public ExposuresCamera init(Functions library) {
            library.lensprof_exposures_camera_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_exposures_lens")
    @Structure.FieldOrder({"struct_size", "camera", "name", "vignettings", "reserved", "vignetting"})
    public static class ExposuresLens extends Struct {
        public int struct_size;
        public int camera;
        public Pointer name;
        public int vignettings;
        public int reserved;
        public Vignetting[] vignetting = new Vignetting[3];

        /** As lensprof_exposures_lens_init sets it. */
        public ExposuresLens init(Functions library) {
            library.lensprof_exposures_lens_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_exposures_image")
    @Structure.FieldOrder({"struct_size", "lens", "width", "height", "name", "file", "exposure", "ev_sigma",
                           "white_balance_sigma"})
    public static class ExposuresImage extends Struct {
        public int struct_size;
        public int lens;
        public int width;
        public int height;
        public Pointer name;
        public Pointer file;
        public Exposure exposure;
        public double ev_sigma;
        public double[] white_balance_sigma = new double[3];

        /** As lensprof_exposures_image_init sets it. */
        public ExposuresImage init(Functions library) {
            library.lensprof_exposures_image_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_finding")
    @Structure.FieldOrder({"struct_size", "code", "severity", "value_count", "rule_severity", "reserved", "value",
                           "measured", "limit", "item", "text"})
    public static class Finding extends Struct {
        public int struct_size;
        public int code;
        public int severity;
        public int value_count;
        public int rule_severity;
        public int reserved;
        public double[] value = new double[2];
        public double measured;
        public double limit;
        public Item item;
        public byte[] text = new byte[256];

        /** As lensprof_finding_init sets it. */
        public Finding init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_fields_options")
    @Structure.FieldOrder({"struct_size", "channels", "width", "height", "given_offset", "responses", "threads",
                           "reserved", "offset", "white", "response", "progress", "progress_user"})
    public static class FieldsOptions extends Struct {
        public int struct_size;
        public int channels;
        public int width;
        public int height;
        public int given_offset;
        public int responses;
        public int threads;
        public int reserved;
        public double[] offset = new double[3];
        public double white;
        public Pointer response;
        public Pointer progress;
        public Pointer progress_user;

        /** As lensprof_fields_options_init sets it. */
        public FieldsOptions init(Functions library) {
            library.lensprof_fields_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_fields_image")
    @Structure.FieldOrder({"struct_size", "used", "same_as", "reserved", "level", "white_share", "pixel_share"})
    public static class FieldsImage extends Struct {
        public int struct_size;
        public int used;
        public int same_as;
        public int reserved;
        public double[] level = new double[3];
        public double white_share;
        public double pixel_share;

        /** As lensprof_fields_image_init sets it. */
        public FieldsImage init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_fields_smoothness")
    @Structure.FieldOrder({"order", "reserved", "weight", "rms"})
    public static class FieldsSmoothness extends Struct {
        public int order;
        public int reserved;
        public double weight;
        public double rms;
    }

    @StructName("lensprof_fields_channel")
    @Structure.FieldOrder({"offset", "offset_sigma", "offset_found", "smoothness", "shading_error", "heldout_rms",
                           "even_rms", "pattern", "pattern_share", "background_share", "background_sigma", "iterations",
                           "converged"})
    public static class FieldsChannel extends Struct {
        public double offset;
        public double offset_sigma;
        public int offset_found;
        public int smoothness;
        public double shading_error;
        public double heldout_rms;
        public double even_rms;
        public double pattern;
        public double pattern_share;
        public double background_share;
        public double background_sigma;
        public int iterations;
        public int converged;
    }

    @StructName("lensprof_fields_result")
    @Structure.FieldOrder({"struct_size", "usable", "findings", "passed", "images", "used", "repeated", "black",
                           "white", "channels", "columns", "rows", "smoothnesses", "reserved", "unseen_share",
                           "white_share", "channel", "shading"})
    public static class FieldsResult extends Struct {
        public int struct_size;
        public int usable;
        public int findings;
        public int passed;
        public int images;
        public int used;
        public int repeated;
        public int black;
        public int white;
        public int channels;
        public int columns;
        public int rows;
        public int smoothnesses;
        public int reserved;
        public double unseen_share;
        public double white_share;
        public FieldsChannel[] channel = new FieldsChannel[3];
        public GainGrid shading;

        /** As lensprof_fields_result_init sets it. */
        public FieldsResult init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_camera")
    @Structure.FieldOrder({"projection", "width", "height", "hfov_deg", "yaw_deg", "pitch_deg", "roll_deg", "radial",
                           "shift_px", "shear_px", "translation", "plane_deg"})
    public static class Camera extends Struct {
        public int projection;
        public int width;
        public int height;
        public double hfov_deg;
        public double yaw_deg;
        public double pitch_deg;
        public double roll_deg;
        public double[] radial = new double[3];
        public double[] shift_px = new double[2];
        public double[] shear_px = new double[2];
        public double[] translation = new double[3];
        public double[] plane_deg = new double[2];
    }

    @StructName("lensprof_pair")
    @Structure.FieldOrder({"image", "xy", "value"})
    public static class Pair extends Struct {
        public int[] image = new int[2];
        public double[] xy = new double[4];
        public double[] value = new double[6];
    }

    @StructName("lensprof_observation")
    @Structure.FieldOrder({"point", "image", "xy", "value"})
    public static class Observation extends Struct {
        public int point;
        public int image;
        public double[] xy = new double[2];
        public double[] value = new double[3];
    }

    @StructName("lensprof_sample_image")
    @Structure.FieldOrder({"struct_size", "reduction", "every_pixel", "reserved", "view", "camera", "mask",
                           "mask_row_bytes", "black", "white"})
    public static class SampleImage extends Struct {
        public int struct_size;
        public int reduction;
        public int every_pixel;
        public int reserved;
        public Image view;
        public Camera camera;
        public Pointer mask;
        public Size mask_row_bytes = new Size();
        public double black;
        public double white;

        /** As lensprof_sample_image_init sets it. */
        public SampleImage init(Functions library) {
            library.lensprof_sample_image_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_link")
    @Structure.FieldOrder({"image", "state", "pairs"})
    public static class Link extends Struct {
        public int[] image = new int[2];
        public int state;
        public int pairs;
    }

    @StructName("lensprof_sample_options")
    @Structure.FieldOrder({"struct_size", "sampling", "pairs", "seed", "threads", "reserved", "progress",
                           "progress_user", "links", "link_count", "link_capacity", "reserved2", "response",
                           "vignetting", "match_of_pair"})
    public static class SampleOptions extends Struct {
        public int struct_size;
        public int sampling;
        public int pairs;
        public int seed;
        public int threads;
        public int reserved;
        public Pointer progress;
        public Pointer progress_user;
        public Pointer links;
        public Pointer link_count;
        public int link_capacity;
        public int reserved2;
        public Pointer response;
        public Pointer vignetting;
        public Pointer match_of_pair;

        /** As lensprof_sample_options_init sets it. */
        public SampleOptions init(Functions library) {
            library.lensprof_sample_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_match")
    @Structure.FieldOrder({"image", "xy", "map"})
    public static class Match extends Struct {
        public int[] image = new int[2];
        public double[] xy = new double[4];
        public double[] map = new double[4];
    }

    @StructName("lensprof_fit_image")
    @Structure.FieldOrder({"struct_size", "width", "height", "free", "ev_of", "red_of", "blue_of", "setting",
                           "exposure", "known_ev", "known_ev_sigma", "camera", "reserved", "f_number_ratio",
                           "crop_factor"})
    public static class FitImage extends Struct {
        public int struct_size;
        public int width;
        public int height;
        public int free;
        public int ev_of;
        public int red_of;
        public int blue_of;
        public int setting;
        public Exposure exposure;
        public double known_ev;
        public double known_ev_sigma;
        public int camera;
        public int reserved;
        public double f_number_ratio;
        public double crop_factor;
    }

    @StructName("lensprof_fit_options")
    @Structure.FieldOrder({"struct_size", "channels", "reference", "free", "modes", "loss", "huber_levels",
                           "prior_weight", "max_iterations", "vignettings", "gamma_from", "camera_kind", "threads",
                           "method", "refine", "moving_camera", "profile", "response", "vignetting", "progress",
                           "progress_user", "links", "link_count", "unlinked_images", "points", "view_distances"})
    public static class FitOptions extends Struct {
        public int struct_size;
        public int channels;
        public int reference;
        public int free;
        public int modes;
        public int loss;
        public double huber_levels;
        public double prior_weight;
        public int max_iterations;
        public int vignettings;
        public int gamma_from;
        public int camera_kind;
        public int threads;
        public int method;
        public int refine;
        public int moving_camera;
        public Pointer profile;
        public Pointer response;
        public Vignetting vignetting;
        public Pointer progress;
        public Pointer progress_user;
        public Pointer links;
        public int link_count;
        public int unlinked_images;
        public Pointer points;
        public Pointer view_distances;

        /** As lensprof_fit_options_init sets it. */
        public FitOptions init(Functions library) {
            library.lensprof_fit_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_fit_image_quality")
    @Structure.FieldOrder({"struct_size", "joined", "ev_sigma", "white_balance_sigma", "median_residual",
                           "known_ev_residual", "radius", "grey_low", "grey_high", "pairs", "inliers", "component",
                           "known_ev_left_out"})
    public static class FitImageQuality extends Struct {
        public int struct_size;
        public int joined;
        public double ev_sigma;
        public double[] white_balance_sigma = new double[3];
        public double median_residual;
        public double known_ev_residual;
        public double radius;
        public double grey_low;
        public double grey_high;
        public int pairs;
        public int inliers;
        public int component;
        public int known_ev_left_out;

        /** As lensprof_fit_image_quality_init sets it. */
        public FitImageQuality init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_fit_result")
    @Structure.FieldOrder({"struct_size", "images", "setting_pairs", "usable", "findings", "passed", "reserved",
                           "vignetting", "radius_ends", "covariance", "gamma_direction", "camera", "covariance_size",
                           "response", "vignettings", "pairs", "equalizes", "response_from", "profile_prior",
                           "gamma_from", "gamma_sigma", "before_rms", "heldout_rms", "heldout_median", "noise_levels",
                           "inlier_share", "frame_share", "image_share", "irradiance_spread_ev", "grey_ends",
                           "converged", "iterations", "model", "equal_exposures", "falloff_prior_distance",
                           "center_prior_distance", "error_inflation", "reference", "left_out", "components",
                           "setting_count", "camera_count", "reserved2", "seconds", "colour_variance_before",
                           "colour_variance_exposures_only", "colour_variance"})
    public static class FitResult extends Struct {
        public int struct_size;
        public int images;
        public int setting_pairs;
        public int usable;
        public int findings;
        public int passed;
        public int reserved;
        public Vignetting[] vignetting = new Vignetting[3];
        public int[] radius_ends = new int[10];
        public double[] covariance = new double[1296];
        public double[] gamma_direction = new double[36];
        public int camera;
        public int covariance_size;
        public Response response;
        public int vignettings;
        public int pairs;
        public int equalizes;
        public int response_from;
        public int profile_prior;
        public int gamma_from;
        public double gamma_sigma;
        public double before_rms;
        public double heldout_rms;
        public double heldout_median;
        public double noise_levels;
        public double inlier_share;
        public double frame_share;
        public double image_share;
        public double irradiance_spread_ev;
        public int[] grey_ends = new int[10];
        public int converged;
        public int iterations;
        public int model;
        public int equal_exposures;
        public double falloff_prior_distance;
        public double center_prior_distance;
        public double error_inflation;
        public int reference;
        public int left_out;
        public int components;
        public int setting_count;
        public int camera_count;
        public int reserved2;
        public double seconds;
        public double colour_variance_before;
        public double colour_variance_exposures_only;
        public double colour_variance;

        /** As lensprof_fit_result_init sets it. */
        public FitResult init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_fit_camera")
    @Structure.FieldOrder({"struct_size", "images", "joined", "shared_pairs", "agreeing_share",
                           "irradiance_difference_ev", "log_gamma", "offset_sigma_ev", "reference", "setting",
                           "attached", "reserved"})
    public static class FitCamera extends Struct {
        public int struct_size;
        public int images;
        public int joined;
        public int shared_pairs;
        public double agreeing_share;
        public double irradiance_difference_ev;
        public double log_gamma;
        public double offset_sigma_ev;
        public int reference;
        public int setting;
        public int attached;
        public int reserved;

        /** As lensprof_fit_camera_init sets it. */
        public FitCamera init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_flat_image")
    @Structure.FieldOrder({"struct_size", "width", "height", "reduction", "shot", "reserved", "view", "mask",
                           "mask_row_bytes", "black", "white", "ev", "rotation_deg"})
    public static class FlatImage extends Struct {
        public int struct_size;
        public int width;
        public int height;
        public int reduction;
        public int shot;
        public int reserved;
        public Image view;
        public Pointer mask;
        public Size mask_row_bytes = new Size();
        public double black;
        public double white;
        public double ev;
        public double rotation_deg;

        /** As lensprof_flat_image_init sets it. */
        public FlatImage init(Functions library) {
            library.lensprof_flat_image_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_flat_options")
    @Structure.FieldOrder({"struct_size", "channels", "free", "vignettings", "light", "own_light", "several",
                           "find_card", "grid", "responses", "threads", "reserved", "ev_sigma", "prior_weight",
                           "response", "vignetting", "progress", "progress_user", "levels", "black_sigma"})
    public static class FlatOptions extends Struct {
        public int struct_size;
        public int channels;
        public int free;
        public int vignettings;
        public int light;
        public int own_light;
        public int several;
        public int find_card;
        public int grid;
        public int responses;
        public int threads;
        public int reserved;
        public double ev_sigma;
        public double prior_weight;
        public Pointer response;
        public Vignetting vignetting;
        public Pointer progress;
        public Pointer progress_user;
        public Levels levels;
        public double black_sigma;

        /** As lensprof_flat_options_init sets it. */
        public FlatOptions init(Functions library) {
            library.lensprof_flat_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_flat_image_quality")
    @Structure.FieldOrder({"struct_size", "cells", "white_share", "black_share", "noise_levels", "ev_residual",
                           "residual", "gradient", "radius", "card"})
    public static class FlatImageQuality extends Struct {
        public int struct_size;
        public int cells;
        public double white_share;
        public double black_share;
        public double noise_levels;
        public double ev_residual;
        public double residual;
        public double[] gradient = new double[2];
        public double radius;
        public int[] card = new int[4];

        /** As lensprof_flat_image_quality_init sets it. */
        public FlatImageQuality init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_flat_spot")
    @Structure.FieldOrder({"x", "y", "radius", "depth", "shots", "reserved"})
    public static class FlatSpot extends Struct {
        public double x;
        public double y;
        public double radius;
        public double depth;
        public int shots;
        public int reserved;
    }

    @StructName("lensprof_flat_result")
    @Structure.FieldOrder({"struct_size", "usable", "images", "covariance_size", "findings", "passed", "vignetting",
                           "vignettings", "light", "shots", "cells", "separated", "iterations", "converged", "spots",
                           "spot", "radius", "noise", "residual", "texture", "frame_residual", "shot_residual",
                           "inlier_share", "corner_sigma", "grid_residual", "covariance", "gain_grid", "corner",
                           "edge_radius", "edge_share", "light_ev", "polynomial_error", "levels", "black_offset",
                           "black_sigma", "black_ev", "black_shown", "reserved", "image_circle"})
    public static class FlatResult extends Struct {
        public int struct_size;
        public int usable;
        public int images;
        public int covariance_size;
        public int findings;
        public int passed;
        public Vignetting[] vignetting = new Vignetting[3];
        public int vignettings;
        public int light;
        public int shots;
        public int cells;
        public int separated;
        public int iterations;
        public int converged;
        public int spots;
        public FlatSpot[] spot = new FlatSpot[32];
        public double radius;
        public double noise;
        public double residual;
        public double texture;
        public double frame_residual;
        public double shot_residual;
        public double inlier_share;
        public double corner_sigma;
        public double grid_residual;
        public double[] covariance = new double[1296];
        public GainGrid gain_grid;
        public double corner;
        public double edge_radius;
        public double edge_share;
        public double light_ev;
        public double polynomial_error;
        public Levels levels;
        public double black_offset;
        public double black_sigma;
        public double black_ev;
        public int black_shown;
        public int reserved;
        public ImageCircle image_circle;

        /** As lensprof_flat_result_init sets it. */
        public FlatResult init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_pto_image")
    @Structure.FieldOrder({"struct_size", "response_type", "camera", "exposure", "vignetting", "emor", "free",
                           "response_of", "vignetting_of", "center_of", "ev_of", "red_of", "blue_of", "crop",
                           "crop_circular", "left_out", "of_crop"})
    public static class PtoImage extends Struct {
        public int struct_size;
        public int response_type;
        public Camera camera;
        public Exposure exposure;
        public Vignetting vignetting;
        public double[] emor = new double[5];
        public int free;
        public int response_of;
        public int vignetting_of;
        public int center_of;
        public int ev_of;
        public int red_of;
        public int blue_of;
        public int[] crop = new int[4];
        public int crop_circular;
        public int left_out;
        public int of_crop;

        /** As lensprof_pto_image_init sets it. */
        public PtoImage init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_import_entry")
    @Structure.FieldOrder({"profile", "usable", "holds", "change"})
    public static class ImportEntry extends Struct {
        public Pointer profile;
        public int usable;
        public int holds;
        public double change;
    }

    /** lensprof_import_visitor. */
    public interface ImportVisitor extends Callback {
        int invoke(Pointer user, ImportEntry entry);
    }

    /** lensprof_camera_visitor. */
    public interface CameraVisitor extends Callback {
        int invoke(Pointer user, CameraModel camera);
    }

    @StructName("lensprof_map")
    @Structure.FieldOrder({"columns", "rows", "channels", "sense", "values"})
    public static class Map extends Struct {
        public int columns;
        public int rows;
        public int channels;
        public int sense;
        public Pointer values;
    }

    @StructName("lensprof_format_info")
    @Structure.FieldOrder({"format", "holds", "is_written", "is_many", "name", "about"})
    public static class FormatInfo extends Struct {
        public int format;
        public int holds;
        public int is_written;
        public int is_many;
        public Pointer name;
        public Pointer about;
    }

    @StructName("lensprof_import_options")
    @Structure.FieldOrder({"struct_size", "format", "width", "height", "columns", "rows", "layout", "curve",
                           "color_temperature_k", "name", "map", "key", "strict", "reserved"})
    public static class ImportOptions extends Struct {
        public int struct_size;
        public int format;
        public int width;
        public int height;
        public int columns;
        public int rows;
        public int layout;
        public int curve;
        public double color_temperature_k;
        public Pointer name;
        public Pointer map;
        public Pointer key;
        public int strict;
        public int reserved;

        /** As lensprof_import_options_init sets it. */
        public ImportOptions init(Functions library) {
            library.lensprof_import_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_export_options")
    @Structure.FieldOrder({"struct_size", "format", "width", "height", "columns", "rows", "layout", "dng_form", "curve",
                           "pack", "color_temperature_k", "name", "camera", "into", "into_size", "cost_ev"})
    public static class ExportOptions extends Struct {
        public int struct_size;
        public int format;
        public int width;
        public int height;
        public int columns;
        public int rows;
        public int layout;
        public int dng_form;
        public int curve;
        public int pack;
        public double color_temperature_k;
        public Pointer name;
        public Pointer camera;
        public Pointer into;
        public Size into_size = new Size();
        public Pointer cost_ev;

        /** As lensprof_export_options_init sets it. */
        public ExportOptions init(Functions library) {
            library.lensprof_export_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_online_options")
    @Structure.FieldOrder({"struct_size", "width", "height", "channels", "camera_kind", "tracks", "keyframes", "modes",
                           "history", "reserved", "center", "black", "white", "profile"})
    public static class OnlineOptions extends Struct {
        public int struct_size;
        public int width;
        public int height;
        public int channels;
        public int camera_kind;
        public int tracks;
        public int keyframes;
        public int modes;
        public int history;
        public int reserved;
        public double[] center = new double[2];
        public double black;
        public double white;
        public Pointer profile;

        /** As lensprof_online_options_init sets it. */
        public OnlineOptions init(Functions library) {
            library.lensprof_online_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_online_observation")
    @Structure.FieldOrder({"track", "x", "y", "value", "weight"})
    public static class OnlineObservation extends Struct {
        public long track;
        public float x;
        public float y;
        public float[] value = new float[3];
        public float weight;
    }

    @StructName("lensprof_online_frame")
    @Structure.FieldOrder({"struct_size", "count", "number", "known_ev", "known_ev_sigma", "observations"})
    public static class OnlineFrame extends Struct {
        public int struct_size;
        public int count;
        public long number;
        public double known_ev;
        public double known_ev_sigma;
        public Pointer observations;

        /** As lensprof_online_frame_init sets it. */
        public OnlineFrame init(Functions library) {
            library.lensprof_online_frame_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_online_exposure")
    @Structure.FieldOrder({"struct_size", "state", "number", "since", "before", "ev", "ev_sigma", "step_ev",
                           "step_sigma", "white_balance", "tracks", "outliers", "unusable", "keyframe"})
    public static class OnlineExposure extends Struct {
        public int struct_size;
        public int state;
        public long number;
        public long since;
        public long before;
        public double ev;
        public double ev_sigma;
        public double step_ev;
        public double step_sigma;
        public double[] white_balance = new double[3];
        public int tracks;
        public int outliers;
        public int unusable;
        public int keyframe;

        /** As lensprof_online_exposure_init sets it. */
        public OnlineExposure init(Functions library) {
            library.lensprof_online_exposure_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_online_result")
    @Structure.FieldOrder({"struct_size", "known", "frames", "lost", "chains", "keyframes", "observations", "windows",
                           "gamma", "log_gamma_sigma", "shape_sigma", "corner", "corner_sigma", "falloff_sigma",
                           "noise_levels", "known_ev_scatter", "inlier_share"})
    public static class OnlineResult extends Struct {
        public int struct_size;
        public int known;
        public long frames;
        public long lost;
        public long chains;
        public long keyframes;
        public long observations;
        public long windows;
        public double gamma;
        public double log_gamma_sigma;
        public double shape_sigma;
        public double corner;
        public double corner_sigma;
        public double falloff_sigma;
        public double noise_levels;
        public double known_ev_scatter;
        public double inlier_share;

        /** As lensprof_online_result_init sets it. */
        public OnlineResult init(Functions library) {
            library.lensprof_online_result_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_packed_image")
    @Structure.FieldOrder({"data", "row_bytes", "width", "height"})
    public static class PackedImage extends Struct {
        public Pointer data;
        public Size row_bytes = new Size();
        public int width;
        public int height;
    }

    @StructName("lensprof_packed_target")
    @Structure.FieldOrder({"data", "row_bytes", "width", "height"})
    public static class PackedTarget extends Struct {
        public Pointer data;
        public Size row_bytes = new Size();
        public int width;
        public int height;
    }

    @StructName("lensprof_rendering_shot")
    @Structure.FieldOrder({"struct_size", "width", "height", "quarter_turns", "shift", "scale", "k1", "k2",
                           "correlation", "texture", "channels", "squares", "black", "white", "colourful", "saturated",
                           "rough", "areas", "corrects_falloff", "tones", "radius", "corner", "corner_sigma",
                           "pattern_levels", "pattern_ev", "noise_levels", "white_ev", "gamma", "gamma_sigma", "colour",
                           "falloff", "saturation"})
    public static class RenderingShot extends Struct {
        public int struct_size;
        public int width;
        public int height;
        public int quarter_turns;
        public double[] shift = new double[2];
        public double scale;
        public double k1;
        public double k2;
        public double correlation;
        public double texture;
        public int channels;
        public int squares;
        public int black;
        public int white;
        public int colourful;
        public int saturated;
        public int rough;
        public int areas;
        public int corrects_falloff;
        public int tones;
        public double radius;
        public double corner;
        public double corner_sigma;
        public double pattern_levels;
        public double pattern_ev;
        public double noise_levels;
        public double white_ev;
        public double gamma;
        public double gamma_sigma;
        public double[] colour = new double[9];
        public double[] falloff = new double[3];
        public double saturation;

        /** As lensprof_rendering_shot_init sets it. */
        public RenderingShot init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_rendering_result")
    @Structure.FieldOrder({"struct_size", "usable", "findings", "passed", "response", "gamma", "gamma_sigma", "lowest",
                           "highest", "tenths", "shows_white", "corrects_falloff", "shots", "areas", "reserved"})
    public static class RenderingResult extends Struct {
        public int struct_size;
        public int usable;
        public int findings;
        public int passed;
        public Response response;
        public double gamma;
        public double gamma_sigma;
        public double lowest;
        public double highest;
        public int tenths;
        public int shows_white;
        public int corrects_falloff;
        public int shots;
        public int areas;
        public int reserved;

        /** As lensprof_rendering_result_init sets it. */
        public RenderingResult init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_sensor_levels")
    @Structure.FieldOrder({"black", "white"})
    public static class SensorLevels extends Struct {
        public double[] black = new double[4];
        public double white;
    }

    @StructName("lensprof_readout")
    @Structure.FieldOrder({"struct_size", "x", "y", "width", "height", "step", "flip", "side", "plane", "channel",
                           "columns", "rows", "gains", "levels", "output_levels"})
    public static class Readout extends Struct {
        public int struct_size;
        public int x;
        public int y;
        public int width;
        public int height;
        public int step;
        public int flip;
        public int side;
        public byte[] plane = new byte[16];
        public byte[] channel = new byte[4];
        public int columns;
        public int rows;
        public Pointer gains;
        public Pointer levels;
        public Pointer output_levels;

        /** As lensprof_readout_init sets it. */
        public Readout init(Functions library) {
            library.lensprof_readout_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_lookup_options")
    @Structure.FieldOrder({"struct_size", "distance_rule", "with_doubt", "any_processing", "force_falloff",
                           "response_alone"})
    public static class LookupOptions extends Struct {
        public int struct_size;
        public int distance_rule;
        public int with_doubt;
        public int any_processing;
        public int force_falloff;
        public int response_alone;

        /** As lensprof_lookup_options_init sets it. */
        public LookupOptions init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_lookup")
    @Structure.FieldOrder({"struct_size", "exact", "rows", "reserved", "id", "weight", "distance", "sigma",
                           "name_score", "reason", "reason_code", "falloff_sigma", "distance_sigma", "sensor_sigma",
                           "response_sigma", "response_from", "camera_kind", "falloff_store", "response_store",
                           "response_rows", "reserved2", "response_id", "response_weight", "nearest"})
    public static class Lookup extends Struct {
        public int struct_size;
        public int exact;
        public int rows;
        public int reserved;
        public long[] id = new long[24];
        public double[] weight = new double[24];
        public double distance;
        public double sigma;
        public double name_score;
        public byte[] reason = new byte[256];
        public int[] reason_code = new int[8];
        public double falloff_sigma;
        public double distance_sigma;
        public double sensor_sigma;
        public double response_sigma;
        public int response_from;
        public int camera_kind;
        public int falloff_store;
        public int response_store;
        public int response_rows;
        public int reserved2;
        public long[] response_id = new long[8];
        public double[] response_weight = new double[8];
        public byte[] nearest = new byte[384];

        /** As lensprof_lookup_init sets it. */
        public Lookup init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_store_row")
    @Structure.FieldOrder({"id", "damaged", "reserved", "key", "provenance"})
    public static class StoreRow extends Struct {
        public long id;
        public int damaged;
        public int[] reserved = new int[3];
        public ProfileKey key;
        public Provenance provenance;
    }

    @StructName("lensprof_store_fault")
    @Structure.FieldOrder({"id", "reason"})
    public static class StoreFault extends Struct {
        public long id;
        public byte[] reason = new byte[256];
    }

    /** lensprof_fault_visitor. */
    public interface FaultVisitor extends Callback {
        int invoke(Pointer user, StoreFault fault);
    }

    @StructName("lensprof_store_group")
    @Structure.FieldOrder({"name", "profiles", "reserved"})
    public static class StoreGroup extends Struct {
        public byte[] name = new byte[256];
        public int profiles;
        public int reserved;
    }

    @StructName("lensprof_store_stats")
    @Structure.FieldOrder({"struct_size", "layout", "profiles", "cameras", "lenses", "units", "processing",
                           "with_covariance", "with_grid", "with_doubt", "methods", "sources", "focal_mm", "aperture",
                           "distance_m", "method", "source", "bytes"})
    public static class StoreStats extends Struct {
        public int struct_size;
        public int layout;
        public int profiles;
        public int cameras;
        public int lenses;
        public int units;
        public int[] processing = new int[3];
        public int with_covariance;
        public int with_grid;
        public int with_doubt;
        public int methods;
        public int sources;
        public double[] focal_mm = new double[2];
        public double[] aperture = new double[2];
        public double[] distance_m = new double[2];
        public StoreGroup[] method = new StoreGroup[8];
        public StoreGroup[] source = new StoreGroup[8];
        public long bytes;

        /** As lensprof_store_stats_init sets it. */
        public StoreStats init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_store_summary")
    @Structure.FieldOrder({"camera_maker", "camera_model", "lens", "profiles", "others", "processing", "reserved",
                           "focal_mm", "aperture", "distance_m"})
    public static class StoreSummary extends Struct {
        public byte[] camera_maker = new byte[64];
        public byte[] camera_model = new byte[64];
        public byte[] lens = new byte[128];
        public int profiles;
        public int others;
        public int[] processing = new int[3];
        public int reserved;
        public double[] focal_mm = new double[2];
        public double[] aperture = new double[2];
        public double[] distance_m = new double[2];
    }

    @StructName("lensprof_trial_options")
    @Structure.FieldOrder({"struct_size", "channels", "camera_kind", "reserved"})
    public static class TrialOptions extends Struct {
        public int struct_size;
        public int channels;
        public int camera_kind;
        public int reserved;

        /** As lensprof_trial_options_init sets it. */
        public TrialOptions init(Functions library) {
            library.lensprof_trial_options_init_sized(this, new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_trial_candidate")
    @Structure.FieldOrder({"struct_size", "has_falloff", "response_from", "response_profile", "as_good_as_best",
                           "better_than_none", "heldout_rms", "heldout_median", "above_best", "above_best_sigma",
                           "below_none", "below_none_sigma", "corners", "rings", "ring_ev", "ring_sigma_ev"})
    public static class TrialCandidate extends Struct {
        public int struct_size;
        public int has_falloff;
        public int response_from;
        public int response_profile;
        public int as_good_as_best;
        public int better_than_none;
        public double heldout_rms;
        public double heldout_median;
        public double above_best;
        public double above_best_sigma;
        public double below_none;
        public double below_none_sigma;
        public int corners;
        public int rings;
        public double[] ring_ev = new double[5];
        public double[] ring_sigma_ev = new double[5];

        /** As lensprof_trial_candidate_init sets it. */
        public TrialCandidate init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    @StructName("lensprof_trial_result")
    @Structure.FieldOrder({"struct_size", "usable", "best", "decided", "images", "fitted", "measured", "unexplained",
                           "before_rms", "ring_end"})
    public static class TrialResult extends Struct {
        public int struct_size;
        public int usable;
        public int best;
        public int decided;
        public int images;
        public int fitted;
        public int measured;
        public int unexplained;
        public double before_rms;
        public double[] ring_end = new double[5];

        /** As lensprof_trial_result_init sets it. */
        public TrialResult init(Functions library) {
            library.lensprof_init_sized(getPointer(), new Size(size()));
            read();
            return this;
        }
    }

    /** The exported functions. */
    public interface Functions extends Library {
        String lensprof_status_name(int status);
        void lensprof_init_sized(Pointer given, Size size);
        String lensprof_version();
        void lensprof_response_set_linear(Response response);
        int lensprof_response_set_gamma(Response response, double gamma);
        void lensprof_response_set_srgb(Response response);
        int lensprof_response_set_emor(Response response, Pointer coefficients, int modes);
        int lensprof_response_set_table(Response response, Pointer values, int count);
        int lensprof_response_validate(Response response);
        double lensprof_response_eval(Response response, double x, Pointer slope);
        double lensprof_response_invert(Response response, double b, Pointer slope);
        void lensprof_response_eval_many(Response response, Pointer x, Size count, Pointer values, Pointer slopes);
        void lensprof_response_invert_many(Response response, Pointer b, Size count, Pointer irradiances, Pointer slopes);
        int lensprof_response_set_typical(Response response, int camera_kind, Pointer covariance, Pointer log_gamma_sigma);
        Pointer lensprof_emor_table(int mode);
        double lensprof_half_diagonal(int width, int height);
        double lensprof_vignetting_eval(Vignetting vignetting, double r2, Pointer slope);
        void lensprof_vignetting_eval_many(Vignetting vignetting, Pointer r2, Size count, Pointer values, Pointer slopes);
        double lensprof_vignetting_r2(Vignetting vignetting, int width, int height, double x, double y, Pointer gradient);
        void lensprof_vignetting_r2_many(Vignetting vignetting, int width, int height, Pointer xy, Size count, Pointer r2, Pointer gradients);
        int lensprof_vignetting_validate(Vignetting vignetting);
        void lensprof_gain_grid_init(GainGrid grid);
        int lensprof_gain_grid_validate(GainGrid grid);
        double lensprof_gain_grid_eval(GainGrid grid, int width, int height, double x, double y, int channel);
        void lensprof_gain_grid_eval_many(GainGrid grid, int width, int height, Pointer xy, Size count, int channel, Pointer attenuations);
        int lensprof_levels_validate(Levels levels);
        double lensprof_levels_to_value(Levels levels, int channel, double sample);
        double lensprof_levels_to_sample(Levels levels, int channel, double value);
        int lensprof_image_circle_validate(ImageCircle circle);
        int lensprof_image_circle_contains(ImageCircle circle, int width, int height, double x, double y);
        void lensprof_exposure_init(Exposure exposure);
        int lensprof_exposure_validate(Exposure exposure);
        void lensprof_exposure_mean(Exposure exposures, Size count, Exposure mean);
        void lensprof_profile_key_init(ProfileKey key);
        int lensprof_profile_key_validate(ProfileKey key);
        int lensprof_camera_kind_of(ProfileKey key);
        void lensprof_camera_model_init(CameraModel camera);
        void lensprof_profile_init_sized(Profile profile, Size size);
        int lensprof_profile_copy(Profile to, Profile from);
        int lensprof_profile_validate(Profile profile);
        double lensprof_profile_falloff(Profile profile, int channel, int width, int height, double x, double y, Pointer sigma);
        double lensprof_profile_radial_falloff(Profile profile, int channel, double r, Pointer sigma);
        int lensprof_profile_pack(Profile profile, int flags, Pointer data, Size capacity, Pointer count);
        int lensprof_profile_unpack(Pointer data, Size size, Profile profile);
        int lensprof_layout_samples(int layout);
        int lensprof_layout_channels(int layout);
        int lensprof_sample_type_bytes(int type);
        int lensprof_image_validate(Image image);
        void lensprof_apply_options_init_sized(ApplyOptions options, Size size);
        int lensprof_apply_options_set_profile(ApplyOptions options, Profile profile);
        Size lensprof_plan_bytes(ApplyOptions options);
        int lensprof_plan_init(Pointer memory, Size size, ApplyOptions options, Pointer plan, ErrorText error);
        int lensprof_apply(Pointer plan, Image source, Target target, int x0, int y0);
        int lensprof_apply_planar(Pointer plan, Image source, Target target, int x0, int y0);
        void lensprof_deflicker_options_init_sized(DeflickerOptions options, Size size);
        void lensprof_deflicker_facts_init_sized(DeflickerFacts facts, Size size);
        void lensprof_deflicker_target_init_sized(DeflickerTarget target, Size size);
        int lensprof_deflicker_create(DeflickerOptions options, Pointer deflicker, ErrorText error);
        void lensprof_deflicker_destroy(Pointer deflicker);
        int lensprof_deflicker_add(Pointer deflicker, Image frame, DeflickerFacts facts, ErrorText error);
        int lensprof_deflicker_measure(Pointer deflicker, DeflickerResult result, ErrorText error);
        int lensprof_deflicker_frame_at(Pointer deflicker, int index, DeflickerFrame frame, ErrorText error);
        int lensprof_deflicker_curve(Pointer deflicker, DeflickerTarget target, Exposure exposures, int count, Pointer window, ErrorText error);
        int lensprof_deflicker_shading(Pointer deflicker, int index, GainGrid shading, ErrorText error);
        double lensprof_settings_ev(double time_s, double f_number, double iso);
        int lensprof_known_exposures(ExposureSettings settings, int count, KnownExposure known, ErrorText error);
        void lensprof_exposures_camera_init_sized(ExposuresCamera camera, Size size);
        void lensprof_exposures_lens_init_sized(ExposuresLens lens, Size size);
        void lensprof_exposures_image_init_sized(ExposuresImage image, Size size);
        int lensprof_exposures_read(Pointer data, Size size, Pointer exposures, ErrorText error);
        void lensprof_exposures_destroy(Pointer exposures);
        int lensprof_exposures_get_info(Pointer exposures, ExposuresInfo info, ErrorText error);
        int lensprof_exposures_get_camera(Pointer exposures, int index, ExposuresCamera camera, ErrorText error);
        int lensprof_exposures_get_lens(Pointer exposures, int index, ExposuresLens lens, ErrorText error);
        int lensprof_exposures_get_image(Pointer exposures, int index, ExposuresImage image, ErrorText error);
        int lensprof_exposures_write(ExposuresInfo info, ExposuresCamera cameras, ExposuresLens lenses, ExposuresImage images, Pointer data, Size capacity, Pointer count, ErrorText error);
        String lensprof_reason_name(int reason);
        String lensprof_reason_text(int reason);
        void lensprof_fields_options_init_sized(FieldsOptions options, Size size);
        int lensprof_fields_create(FieldsOptions options, Pointer fields, ErrorText error);
        void lensprof_fields_destroy(Pointer fields);
        int lensprof_fields_add(Pointer fields, Image view, Pointer mask, Size mask_row_bytes, ErrorText error);
        int lensprof_fields_fit(Pointer fields, ErrorText error);
        int lensprof_fields_get(Pointer fields, FieldsResult result, ErrorText error);
        int lensprof_fields_image_at(Pointer fields, int index, FieldsImage image, ErrorText error);
        int lensprof_fields_smoothness_at(Pointer fields, int channel, int index, FieldsSmoothness smoothness, ErrorText error);
        int lensprof_fields_finding_at(Pointer fields, int index, Finding finding, ErrorText error);
        int lensprof_fields_profile(Pointer fields, Profile profile, ErrorText error);
        int lensprof_camera_validate(Camera camera);
        int lensprof_camera_project(Camera camera, double longitude, double latitude, Pointer xy);
        int lensprof_camera_unproject(Camera camera, double x, double y, Pointer direction);
        Size lensprof_camera_project_many(Camera camera, Pointer directions, Size count, Pointer xy);
        Size lensprof_camera_unproject_many(Camera camera, Pointer xy, Size count, Pointer directions);
        void lensprof_sample_image_init_sized(SampleImage image, Size size);
        void lensprof_sample_options_init_sized(SampleOptions options, Size size);
        int lensprof_sample_overlap(SampleOptions options, SampleImage images, int image_count, Pair pairs, int capacity, Pointer count, ErrorText error);
        int lensprof_sample_tracks(SampleOptions options, SampleImage images, int image_count, Observation observations, int capacity, Pointer count, ErrorText error);
        int lensprof_sample_matches(SampleOptions options, SampleImage images, int image_count, Match matches, int match_count, Pair pairs, int capacity, Pointer count, ErrorText error);
        void lensprof_fit_image_init_sized(FitImage image, Size size, int index, int width, int height);
        void lensprof_fit_options_init_sized(FitOptions options, Size size);
        Size lensprof_fit_bytes(FitImage images, int image_count);
        int lensprof_fit_overlap(FitOptions options, FitImage images, int image_count, Pair pairs, int pair_count, Pointer memory, Size size, Exposure exposures, Pointer fit, ErrorText error);
        int lensprof_fit_radiance(FitOptions options, FitImage images, int image_count, Observation observations, int observation_count, Pointer memory, Size size, Exposure exposures, Pointer fit, ErrorText error);
        void lensprof_fit_destroy(Pointer fit);
        int lensprof_fit_image_at(Pointer fit, int index, FitImageQuality quality, ErrorText error);
        int lensprof_fit_setting_at(Pointer fit, int setting, FitResult result, ErrorText error);
        int lensprof_fit_camera_at(Pointer fit, int camera, FitCamera result, ErrorText error);
        int lensprof_fit_finding_at(Pointer fit, int setting, int index, Finding finding, ErrorText error);
        int lensprof_fit_profile(Pointer fit, int setting, Profile profile, ErrorText error);
        int lensprof_fit_transfer_rms(Pointer fit, Pair pairs, int pair_count, Pointer rms, Pointer median, ErrorText error);
        int lensprof_fit_colour_differences(Pointer fit, Pair pairs, int pair_count, Pointer differences, ErrorText error);
        Size lensprof_fixed_plan_bytes(ApplyOptions options);
        int lensprof_fixed_plan_init(Pointer memory, Size size, ApplyOptions options, Pointer plan, ErrorText error);
        int lensprof_fixed_plan_open(Pointer data, Size size, Pointer plan);
        int lensprof_fixed_apply(Pointer plan, Image source, Target target, int x0, int y0);
        void lensprof_flat_image_init_sized(FlatImage image, Size size);
        void lensprof_flat_options_init_sized(FlatOptions options, Size size);
        Size lensprof_flat_bytes(int image_count);
        int lensprof_fit_flat(FlatOptions options, FlatImage images, int image_count, Pointer memory, Size size, Pointer flat, ErrorText error);
        void lensprof_flat_destroy(Pointer flat);
        int lensprof_flat_get(Pointer flat, FlatResult result, ErrorText error);
        int lensprof_flat_image_at(Pointer flat, int index, FlatImageQuality quality, ErrorText error);
        int lensprof_flat_finding_at(Pointer flat, int index, Finding finding, ErrorText error);
        int lensprof_flat_profile(Pointer flat, Profile profile, ErrorText error);
        int lensprof_pto_read(Pointer data, Size size, Pointer pto, ErrorText error);
        void lensprof_pto_destroy(Pointer pto);
        int lensprof_pto_image_count(Pointer pto);
        int lensprof_pto_get_image(Pointer pto, int index, PtoImage image, ErrorText error);
        int lensprof_pto_get_response(Pointer pto, int index, Response response, ErrorText error);
        int lensprof_pto_get_name(Pointer pto, int index, Pointer name, Size capacity, Pointer count, ErrorText error);
        int lensprof_pto_set_name(Pointer pto, int index, String name, ErrorText error);
        int lensprof_pto_draw_mask(Pointer pto, int index, Pointer mask, int width, int height, Size row_bytes, ErrorText error);
        int lensprof_pto_set_result(Pointer pto, Response response, Vignetting vignetting, Exposure exposures, int image_count, int reference, ErrorText error);
        int lensprof_pto_set_settings(Pointer pto, Pointer setting, int image_count, Vignetting vignetting, int setting_count, ErrorText error);
        int lensprof_pto_set_cameras(Pointer pto, Pointer camera, int image_count, Response response, int camera_count, ErrorText error);
        int lensprof_pto_write(Pointer pto, Pointer data, Size capacity, Pointer count, ErrorText error);
        int lensprof_points_read(Pointer data, Size size, Pair pairs, int capacity, Pointer count, ErrorText error);
        int lensprof_points_write(Pair pairs, int pair_count, Camera cameras, int camera_count, Pointer data, Size capacity, Pointer count, ErrorText error);
        int lensprof_lensfun_read_cameras(Pointer data, Size size, String source, CameraVisitor visit, Pointer user, ErrorText error);
        int lensprof_map_write(Profile profile, int width, int height, int columns, int rows, int channels, int sense, Pointer values, ErrorText error);
        FormatInfo lensprof_format_get_info(int format);
        int lensprof_format_detect(Pointer data, Size size, String name);
        void lensprof_import_options_init_sized(ImportOptions options, Size size);
        int lensprof_import(Pointer data, Size size, ImportOptions options, ImportVisitor visit, Pointer user, ErrorText error);
        void lensprof_export_options_init_sized(ExportOptions options, Size size);
        int lensprof_export(Pointer profiles, int profile_count, ExportOptions options, Pointer data, Size capacity, Pointer count, ErrorText error);
        void lensprof_online_options_init_sized(OnlineOptions options, Size size);
        void lensprof_online_frame_init_sized(OnlineFrame frame, Size size);
        void lensprof_online_exposure_init_sized(OnlineExposure exposure, Size size);
        void lensprof_online_result_init_sized(OnlineResult result, Size size);
        Size lensprof_online_bytes(OnlineOptions options);
        int lensprof_online_begin(Pointer memory, Size size, OnlineOptions options, Pointer online, ErrorText error);
        int lensprof_online_add(Pointer online, OnlineFrame frame, OnlineExposure exposure, ErrorText error);
        int lensprof_online_solve(Pointer online, int steps, Pointer pending, ErrorText error);
        int lensprof_online_exposure_at(Pointer online, long number, OnlineExposure exposure, ErrorText error);
        int lensprof_online_get(Pointer online, OnlineResult result, ErrorText error);
        int lensprof_online_profile(Pointer online, Profile profile, ErrorText error);
        Size lensprof_packed_row_bytes(int packing, int width);
        int lensprof_unpack_row(int packing, Pointer packed, int width, Pointer samples);
        int lensprof_pack_row(int packing, Pointer samples, int width, Pointer packed);
        int lensprof_apply_packed(Pointer plan, int packing, PackedImage source, PackedTarget target, int x0, int y0);
        int lensprof_fixed_apply_packed(Pointer plan, int packing, PackedImage source, PackedTarget target, int x0, int y0);
        int lensprof_rendering_create(Response prior, Progress progress, Pointer progress_user, Pointer rendering, ErrorText error);
        void lensprof_rendering_destroy(Pointer rendering);
        int lensprof_rendering_add(Pointer rendering, Image raw, Image rendered, ErrorText error);
        int lensprof_rendering_fit(Pointer rendering, RenderingResult result, ErrorText error);
        int lensprof_rendering_shot_at(Pointer rendering, int index, RenderingShot shot, ErrorText error);
        int lensprof_rendering_finding_at(Pointer rendering, int index, Finding finding, ErrorText error);
        void lensprof_readout_init_sized(Readout readout, Size size);
        int lensprof_readout_set_mosaic(Readout readout, String colors);
        Size lensprof_sensor_plan_bytes(Readout readout);
        int lensprof_sensor_plan_init(Pointer memory, Size size, ApplyOptions options, Readout readout, Pointer plan, ErrorText error);
        int lensprof_sensor_plan_error(Pointer plan, ApplyOptions options, Readout readout, Pointer largest);
        int lensprof_sensor_plan_open(Pointer data, Size size, Pointer plan);
        int lensprof_sensor_plan_mix(Pointer memory, Size size, Pointer a, Pointer b, int share, Pointer plan);
        int lensprof_mired_share(int a_kelvin, int b_kelvin, int kelvin);
        int lensprof_sensor_apply(Pointer plan, Image source, Target target, int x0, int y0);
        int lensprof_sensor_apply_packed(Pointer plan, int packing, PackedImage source, PackedTarget target, int x0, int y0);
        Size lensprof_sensor_flat_bytes(Readout readout);
        int lensprof_sensor_flat_init(Pointer memory, Size size, int frame_width, int frame_height, Readout readout, Pointer flat, ErrorText error);
        int lensprof_sensor_flat_add(Pointer flat, Image samples, int x0, int y0);
        int lensprof_sensor_flat_open(Pointer data, Size size, Pointer flat);
        Size lensprof_sensor_flat_work_bytes(Pointer flat);
        int lensprof_sensor_flat_gains(Pointer flat, Pointer work, Size work_bytes, Pointer gains, ErrorText error);
        int lensprof_store_open(String path, int mode, Pointer store, ErrorText error);
        void lensprof_store_close(Pointer store);
        int lensprof_store_put(Pointer store, Profile profile, Pointer id, ErrorText error);
        int lensprof_store_find(Pointer store, ProfileKey key, Profile profile, Pointer id, ErrorText error);
        int lensprof_store_lookup_in(Pointer stores, int count, ProfileKey key, LookupOptions options, Profile profile, Lookup lookup, ErrorText error);
        int lensprof_store_begin(Pointer store, ErrorText error);
        int lensprof_store_commit(Pointer store, ErrorText error);
        void lensprof_store_rollback(Pointer store);
        int lensprof_store_get(Pointer store, long id, Profile profile, ErrorText error);
        int lensprof_store_list(Pointer store, ProfileKey filter, StoreRow rows, int capacity, Pointer count, ErrorText error);
        int lensprof_store_find_same(Pointer store, Profile profile, Pointer id, ErrorText error);
        int lensprof_store_merge(Pointer store, Pointer other, Pointer added, Pointer known, ErrorText error);
        int lensprof_store_put_camera(Pointer store, CameraModel camera, ErrorText error);
        int lensprof_store_find_camera(Pointer store, String maker, String model, CameraModel camera, ErrorText error);
        int lensprof_store_list_camera_models(Pointer store, CameraModel cameras, int capacity, Pointer count, ErrorText error);
        int lensprof_store_check(Pointer store, FaultVisitor visit, Pointer user, Pointer profiles, Pointer faults, ErrorText error);
        int lensprof_store_get_stats(Pointer store, StoreStats stats, ErrorText error);
        int lensprof_store_remove(Pointer store, long id, ErrorText error);
        int lensprof_store_set_key(Pointer store, long id, ProfileKey key, ErrorText error);
        int lensprof_store_list_names(Pointer store, int which, String part, StoreSummary rows, int capacity, Pointer count, ErrorText error);
        int lensprof_correct(Profile profile, Exposure exposure, Target picture, ErrorText error);
        void lensprof_trial_options_init_sized(TrialOptions options, Size size);
        int lensprof_trial_run(TrialOptions options, FitImage images, int image_count, Pair pairs, int pair_count, Pointer profiles, int profile_count, TrialCandidate candidates, TrialResult result, ErrorText error);
    }
}
