/* lensprof/formats.h - other programs' files, from and to memory: Lensfun databases, Adobe lens profiles, DNG opcodes,
 * XMP of drones' cameras, radical's files, pcalib.txt, times.txt, tables of responses, falloffs as maps; and profiles
 * as JSON. hugin.h, which this includes, has Hugin's projects and points.
 *
 * lensprof_import and lensprof_export, at the end, are one call for any of them. No function here opens a file. */
#ifndef LENSPROF_FORMATS_H
#define LENSPROF_FORMATS_H

#include "apply.h"
#include "fit.h"
#include "geometry.h"
#include "hugin.h"
#include "profile.h"
#include "sample.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Falloffs of other programs' databases ---------------------------------------------------------------- */

/* One falloff of a file. */
typedef struct lensprof_import_entry {
    const lensprof_profile *profile; /* until the visitor returns: key, provenance, vignetting; a linear response. To
                                      * be kept by lensprof_profile_copy */
    uint32_t usable; /* 0: what the file has is no falloff (provenance.doubt says why), and lensprof_profile_validate
                      * refuses it; 1: a valid profile, which provenance.doubt may still warn of */
    uint32_t holds;  /* lensprof_holds: PROFILES, or by lensprof_import what the file holds, the rest being neutral */
} lensprof_import_entry;

/* Receives the entries in the order of the file. Anything but OK stops the reading and is what it returns, with the
 * error text as the visitor left it. */
typedef lensprof_status (*lensprof_import_visitor)(void *user, const lensprof_import_entry *entry);

/* ---- Lensfun database (.xml) ------------------------------------------------------------------------------ */

/* Every <vignetting> of a database of version 1 or 2, as a profile of raw pictures in lensprof's conventions
 * (docs/formats.md):
 *  - lens = "<maker> <model>", or the model alone where it begins with the maker; texts without a `lang` count before
 *    English ones. For a lens with one mount whose first letter is small (a camera with a fixed lens), camera_maker and
 *    camera_model too, where the file has exactly one <camera> with this mount.
 *  - crop_factor of the lens or of its <calibration>; focal_mm, aperture and distance_m as written, but 1000 m, which
 *    Lensfun's tools write for it, is INFINITY.
 *  - model "pa": k as written. Model "acm", with radii in focal lengths: rescaled, by the <distortion>'s real-focal of
 *    that focal length where there is one. <center> by the <aspect-ratio>, 3:2 where there is none.
 *  - provenance: method "import", source = `source` (a file's name, say; may be NULL, cut where it is too long) and the
 *    licence of Lensfun's database. doubt: M below 0.001 (usable = 0); coefficients -0.3, 0, 0, which a fit of
 *    Lensfun's calibrate.py starts from; M, followed outwards, rises by more than 0.05.
 * All of the text is checked before the first entry is visited. Document types are skipped and entities not expanded.
 * Errors (the text names line and lens): ARGUMENT; SIZE over 64 MiB, or over 2 million elements or attributes; SYNTAX;
 * UNSUPPORTED for another version or model; MEMORY; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_read(const void *data, size_t size, const char *source,
                                                                     lensprof_import_visitor visit, void *user,
                                                                     lensprof_error *error);

/* Receives the cameras of a file. Anything but OK ends the call and is what it returns. */
typedef lensprof_status (*lensprof_camera_visitor)(void *user, const lensprof_camera_model *camera);

/* The <camera> entries of a Lensfun database: maker and model as EXIF has them and in the other language that there is,
 * mount, crop factor, and for a camera whose lens cannot be changed the lens of its mount in the same file, as profiles
 * of lensprof_lensfun_read call it: of several that without a converter, none where that is not clear. All entries are
 * checked before the first visit. Errors: as lensprof_lensfun_read. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_read_cameras(const void *data, size_t size,
                                                                             const char *source,
                                                                             lensprof_camera_visitor visit, void *user,
                                                                             lensprof_error *error);

/* The falloffs of profiles as a database of version 1, which every Lensfun reads: model "pa", one <lens> for each lens
 * and crop factor. Output as in base.h. Doubles are written so that they read back the same.
 *  - <maker> is the first word of key.lens, <model> all of it; the mount is Lensfun's "Generic".
 *  - Lensfun has one curve for all channels: of three, their mean is written. It has no responses, covariances, units
 *    and provenance: these are left out.
 *  - Infinite and unknown distances are 1000 m.
 *  - A centre is converted for frames of 3:2; Lensfun has one a lens.
 * Errors (the text names the profile, counted from 0): ARGUMENT for an unknown lens, crop factor, focal length or
 * aperture, texts that are not UTF-8, two profiles of the same lens and setting, or centres of one lens that differ;
 * UNSUPPORTED for a gain grid or pictures corrected in camera; what lensprof_profile_validate says; CAPACITY;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_write(const lensprof_profile *const *profiles,
                                                                      uint32_t profile_count, void *data,
                                                                      size_t capacity, size_t *count,
                                                                      lensprof_error *error);

/* ---- Profiles as JSON ------------------------------------------------------------------------------------- */

/* Profiles as `lensprof profile show --json` prints them (docs/json.md): the object of one, or {"schema": 1,
 * "profiles": [...]} of none and of several. Doubles, and the floats of gain grids, are written so that they read back
 * the same; bytes of texts that are not UTF-8 become U+FFFD. Output as in base.h. Errors (the text names the
 * profile, counted from 0): ARGUMENT; what lensprof_profile_validate says; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_json_write(const lensprof_profile *const *profiles,
                                                                   uint32_t profile_count, void *data, size_t capacity,
                                                                   size_t *count, lensprof_error *error);

/* Reads them: what lensprof_json_write wrote gives the same profiles, in every bit. Each must have `key` with
 * `processing`, and `vignetting` with `k`; without `gain_grid`, `covariance`, `provenance` and `response` it has none,
 * the last being linear. Texts and numbers of a key that are missing or null are unknown. Other members are ignored.
 * provenance.source is that of the file, or `source` where it has none (may be NULL, cut where it is too long).
 * All profiles are checked before the first is visited; they are all usable.
 * Errors (the text names the line, or the path, as "profiles[2].vignetting.k[0]"): ARGUMENT; SIZE over 64 MiB or 4
 * million values; SYNTAX, also for more than 32 levels; UNSUPPORTED for another schema; what the model's validate
 * functions say; MEMORY; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_json_read(const void *data, size_t size, const char *source,
                                                                  lensprof_import_visitor visit, void *user,
                                                                  lensprof_error *error);

/* ---- Photometric calibration of visual odometry (pcalib.txt, times.txt) ------------------------------------- */

/* Inverse response of TUM's tools, DSO and its kin: the irradiances of 256 evenly spaced grey values (or of up to
 * 65536), strictly increasing, separated by blanks and line ends. They are rescaled by the first and last, as those
 * tools do, to a TABLE. Errors (the text names the value, counted from 0): ARGUMENT; SYNTAX for fewer than 256 or what
 * is not a finite number; SIZE for over 65536; RESPONSE for a value that is not above the one before; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pcalib_read(const void *data, size_t size,
                                                                    lensprof_response *response, lensprof_error *error);

/* Writes 256 of them, from 0 to 255, on one line. Two are never closer than 1e-4, so that they increase strictly in
 * single precision too; where the response is so steep that they would be, it is less so by that much. Output as
 * in base.h. Errors: ARGUMENT, what lensprof_response_validate says, CAPACITY, MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pcalib_write(const lensprof_response *response, void *data,
                                                                     size_t capacity, size_t *count,
                                                                     lensprof_error *error);

/* A line of times.txt. lensprof_exposure.ev of a frame, where only its exposure time differs from that of another
 * frame: log2(exposure_ms / exposure_ms of the other). Frozen value struct. */
typedef struct lensprof_frame_time {
    char id[64];        /* as written, with leading zeros */
    double time_s;      /* time stamp */
    double exposure_ms; /* > 0 or LENSPROF_UNKNOWN */
} lensprof_frame_time;

/* Lines of name, time and exposure, of which the last may be missing or 0 (unknown); empty lines and those that begin
 * with # are skipped. frames[capacity] and *count as in base.h. Errors (the text names the line):
 * ARGUMENT; SYNTAX; CAPACITY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_times_read(const void *data, size_t size,
                                                                   lensprof_frame_time *frames, uint32_t capacity,
                                                                   uint32_t *count, lensprof_error *error);

/* Writes the same; numbers read back the same. Output as in base.h. Errors (the text names the frame): ARGUMENT
 * for a name that is empty, has blanks or begins with #; NOT_FINITE; EXPOSURE; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_times_write(const lensprof_frame_time *frames,
                                                                    uint32_t frame_count, void *data, size_t capacity,
                                                                    size_t *count, lensprof_error *error);

/* ---- Response curves as tables of text (.csv, pfstools' .m) -------------------------------------------------- */

/* What a table holds, on an even grid of what it is a function of. Nothing in such files says it. */
typedef enum lensprof_curve {
    LENSPROF_CURVE_INVERSE =
        0,                     /* grey value -> irradiance, to any scale: OpenCV's Debevec and Robertson, AliceVision */
    LENSPROF_CURVE_LOG = 1,    /* grey value -> natural logarithm of it: Debevec's g */
    LENSPROF_CURVE_LOG10 = 2,  /* grey value -> decadic logarithm of it */
    LENSPROF_CURVE_FORWARD = 3 /* irradiance -> grey value, rescaled by the first and last */
} lensprof_curve;

/* Reads 2 to 65536 rows of 1 or 3 numbers (red, green, blue; the other way round where names of columns say so), or of
 * these after one that counts the rows or is evenly spaced from 0. Between them stand blanks, commas, semicolons or
 * brackets; lines that begin with #, % or // and a first line of names are skipped. To one or three TABLEs, in which
 * irradiance 1 is that of the last grey value and what is darker than the first gives 0. `# name:` lines make it a file
 * of pfstools, with a matrix a channel, whatever `curve`. responses: 3 of them, of which *count are written. Errors
 * (the text names the line): ARGUMENT; SIZE over 65536 rows or 64 MiB; SYNTAX; RESPONSE for a value below that of the
 * row before, or an irradiance below 0; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_curves_read(const void *data, size_t size, uint32_t curve,
                                                                    lensprof_response *responses, uint32_t *count,
                                                                    lensprof_error *error);

/* Writes `rows` (2 to 65536; 256 for pictures of 8 bit) rows of 1 or 3 responses as a lensprof_curve, after a line of
 * names: the number of the row (FORWARD: irradiance), then the values, which read back the same; irradiances are 0
 * to 1. Logarithms are of at least 1e-6 of them. Output as in base.h. Errors: ARGUMENT, what
 * lensprof_response_validate says, CAPACITY, MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_curves_write(const lensprof_response *responses,
                                                                     uint32_t response_count, uint32_t curve,
                                                                     uint32_t rows, void *data, size_t capacity,
                                                                     size_t *count, lensprof_error *error);

/* ---- Falloffs as maps (vignette.png, gain images) ------------------------------------------------------------ */

typedef enum lensprof_map_sense {
    LENSPROF_MAP_ATTENUATION = 0, /* a picture is corrected by division: TUM's and DSO's vignette.png */
    LENSPROF_MAP_GAIN = 1         /* by multiplication */
} lensprof_map_sense;

/* A map in the caller's memory, linear, to any scale; 0 = not known. Values are the means of equal cells of the frame,
 * as the pixels of a reduced picture are: all of a picture's pixels make the map of its frame. Frozen value struct. */
typedef struct lensprof_map {
    uint32_t columns, rows; /* 2..65536 each */
    uint32_t channels;      /* 1 or 3 (red, green, blue) */
    uint32_t sense;         /* lensprof_map_sense */
    const float *values;    /* [row][column][channel], without gaps */
} lensprof_map;

/* The falloff of a map, in a frame of width x height px: one polynomial a channel with a common centre, by least
 * squares of the relative error, and a gain grid where they leave more than 0.2 %. Sets vignetting and grid of
 * *profile, which must be an initialised one, removes its covariance and leaves the rest. *worst (may be NULL) receives
 * the largest relative error left, of means over up to 64 values a side in maps of more than 1024. Errors: ARGUMENT,
 * also for values below 0; SIZE; NOT_FINITE; VIGNETTING for a map of which too little is known or that no falloff comes
 * near; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_map_read(const lensprof_map *map, uint32_t width,
                                                                 uint32_t height, lensprof_profile *profile,
                                                                 double *worst, lensprof_error *error);

/* Falloff and gain grid of a profile as columns x rows values for a frame of width x height px, as in lensprof_map; of
 * 1 channel it is the mean of the profile's. The largest attenuation of all channels is 1, so that gains are 1 and
 * more. To write vignette.png, multiply by 65535 (or 255) and round, but to no less than 1. Errors: ARGUMENT; SIZE;
 * what lensprof_profile_validate says; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_map_write(const lensprof_profile *profile, uint32_t width,
                                                                  uint32_t height, uint32_t columns, uint32_t rows,
                                                                  uint32_t channels, uint32_t sense, float *values,
                                                                  lensprof_error *error);

/* ---- radical (.crf, .vgn) ------------------------------------------------------------------------------------ */

/* The response file of radical: irradiances of 256 greys in three channels, to any scale; to three TABLEs as
 * lensprof_curves_read. Errors: ARGUMENT; SYNTAX; UNSUPPORTED for a matrix of another type; SIZE; RESPONSE for
 * irradiances that decrease or are none; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_response_read(const void *data, size_t size,
                                                                              lensprof_response *responses,
                                                                              lensprof_error *error);

/* Writes 1 (for all channels) or 3 responses; irradiances are 1e-6 to 1, as radical takes their logarithm. Output as
 * in base.h. Errors: ARGUMENT, what lensprof_response_validate says, CAPACITY, MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_response_write(const lensprof_response *responses,
                                                                               uint32_t response_count, void *data,
                                                                               size_t capacity, size_t *count,
                                                                               lensprof_error *error);

/* The vignetting file of radical, polynomial of degree 3 or nonparametric. Polynomials whose channels share a centre
 * are rescaled exactly; others, which have one each, and maps are refitted as by lensprof_map_read, in the frame that
 * the file names. profile, *worst (0 where exact) and errors as there; SYNTAX; UNSUPPORTED for other models. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_vignetting_read(const void *data, size_t size,
                                                                                lensprof_profile *profile,
                                                                                double *worst, lensprof_error *error);

/* Writes a profile for pictures of width x height px: a polynomial, or where it has a gain grid a map of 12 bytes a
 * pixel. Output as in base.h. Errors: ARGUMENT; SIZE; what lensprof_profile_validate says; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_vignetting_write(const lensprof_profile *profile,
                                                                                 uint32_t width, uint32_t height,
                                                                                 void *data, size_t capacity,
                                                                                 size_t *count, lensprof_error *error);
/* ---- DNG opcode lists (tags OpcodeList2, OpcodeList3) ----------------------------------------------------- */

typedef enum lensprof_dng_form {
    LENSPROF_DNG_RADIAL = 0,   /* FixVignetteRadial */
    LENSPROF_DNG_GAIN_MAP = 1, /* GainMap */
    LENSPROF_DNG_AUTO = 2      /* lensprof_export: RADIAL where that is exact to 0.5 %, else GAIN_MAP */
} lensprof_dng_form;

/* The falloff of a list of opcodes, the bytes of the tag, as one profile of raw pictures whose key is otherwise empty.
 * width, height: of the frame that the opcodes work on, in square pixels (the picture's active area). layout: what they
 * work on, a lensprof_layout: RGGB, GRBG, GBRG or BGGR for a mosaic (OpcodeList2), RGB for three planes (OpcodeList3),
 * GREY for one.
 *  - Gains are the inverse of attenuations; those of several opcodes are multiplied.
 *  - FixVignetteRadial alone, about one centre: the radial falloff of least squares of the relative error. Else, the
 *    frame is sampled: radial falloffs and, for what they leave beyond 0.2 %, a gain grid (docs/formats.md).
 *  - GainMap: bilinear at pixels' centres, beyond the outermost points as at the nearest, the plane min(plane,
 *    MapPlanes - 1); in a mosaic the maps of each colour's pixels, the mean of the two greens. Falloffs a channel where
 *    channels differ; each is 1 in its centre, so that a gain for all of a channel is left out.
 *  - doubt: a largest relative error above 1 %, and the opcodes of other kinds, which are left out.
 * Visited once, or not at all. Errors (the text names the opcode, from 0): ARGUMENT; SYNTAX; SIZE over 64 gains or
 * 1 Mi points of maps; NOT_FOUND where no opcode is a gain; UNSUPPORTED for an opcode that DNG 1.7 has not and that is
 * not optional, for gains after TrimBounds, and for a map of every 2nd pixel where the layout is none of a mosaic, or
 * of fewer; VIGNETTING for gains not above 0 and for what no falloff comes near; MEMORY; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_dng_opcodes_read(const void *data, size_t size, uint32_t width,
                                                                         uint32_t height, uint32_t layout,
                                                                         const char *source,
                                                                         lensprof_import_visitor visit, void *user,
                                                                         lensprof_error *error);

/* The falloff of a profile as such a list, with one optional opcode, or four. `form`, a lensprof_dng_form:
 *  - RADIAL: 5 coefficients by least squares of the gain's relative error.
 *  - GAIN_MAP: 33 points along the longer side, at least 9 along the shorter. For a mosaic and falloffs a channel four
 *    maps, one for the pixels of each site of its squares; for RGB one map of 1 or 3 planes.
 * *worst (may be NULL) receives the largest |gain * attenuation - 1| within the frame. Output as in base.h;
 * *worst is set on CAPACITY, too. Errors: ARGUMENT; what lensprof_profile_validate says;
 * UNSUPPORTED for pictures corrected in camera, for RADIAL with falloffs a channel, a gain grid or a centre outside the
 * frame, and for falloffs a channel where layout is GREY; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_dng_opcodes_write(const lensprof_profile *profile,
                                                                          uint32_t width, uint32_t height,
                                                                          uint32_t layout, uint32_t form, void *data,
                                                                          size_t capacity, size_t *count, double *worst,
                                                                          lensprof_error *error);

/* ---- Adobe lens profile (.lcp) ---------------------------------------------------------------------------- */

/* Every entry with a VignetteModel, its properties as attributes or elements, as a profile (docs/formats.md):
 *  - key: Make, Model, Lens (LensPrettyName where there is none), SensorFormatFactor, FocalLength, FocusDistance
 * (INFINITY from 10 km on), and from the APEX ApertureValue Av the f-number 2^(Av / 2). RAW where CameraRawProfile is
 * True, else JPEG. Texts, sensor and frame that an entry does not say are those of the first one.
 *  - vignetting: VignetteModelParam1..3 with radii in FocalLengthX longer sides of the frame, rescaled; or, where there
 * are VignetteModelPiecewiseParam, their refit. Frames without ImageWidth and ImageLength are taken as 3:2. Where
 *    FocalLengthY differs, a map of the frame is fitted, with a gain grid for what is not radial.
 *  - provenance and what is checked first: as lensprof_lensfun_read. doubt, also: a refit that is off by more than 1 %.
 * Of entries that are not usable, k may be NaN. Errors (the text names the line): ARGUMENT; SIZE over 64 MiB, 2 million
 * elements or attributes, 20000 entries or 1000 knots; SYNTAX; MEMORY; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lcp_read(const void *data, size_t size, const char *source,
                                                                 lensprof_import_visitor visit, void *user,
                                                                 lensprof_error *error);

/* The falloffs of profiles of one camera, lens, crop factor and processing as a lens profile, with
 * VignetteModelParam1..3 and centre. width, height: of the frames; both 0 = not known, of 3:2. Output as
 * in base.h. Numbers read back within 1e-9 of themselves. Of falloffs a channel the mean is written; distances
 * that are not known are left out. Errors (the text names the profile, counted from 0): as lensprof_lensfun_write;
 * ARGUMENT also for profiles of several cameras or lenses; SIZE for a side of over a million pixels. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lcp_write(const lensprof_profile *const *profiles,
                                                                  uint32_t profile_count, uint32_t width,
                                                                  uint32_t height, void *data, size_t capacity,
                                                                  size_t *count, lensprof_error *error);

/* ---- Falloffs in the XMP packets of drones' cameras -------------------------------------------------------- */

/* The polynomial that a MicaSense, Parrot Sequoia, DJI or Sentera camera writes about itself into its pictures, from
 * the picture's XMP packet, as one profile of raw pictures (docs/formats.md). width, height: of the picture, in px.
 *  - Camera:VignettingPolynomial, about Camera:VignettingCenter: 1 + c0 r + c1 r^2 + ..., r in px. An attenuation; of
 * DJI a gain. Of Sentera, under Sentera: or Camera:, the highest power comes first: ... c1, c0. A packet is Sentera's
 * by tiff:Make, where it has none by the key that lensprof_import is given, or by a property of that namespace.
 *  - drone-dji:VignettingData, about CalibratedOpticalCenterX and Y: such a gain. It counts before the other one.
 *  - Camera:VignettingPolynomial2D with the powers in ...2DName: an attenuation, sum of c x^i y^j with x, y in 0..1 of
 * the frame; fitted as a map, with a gain grid. Radial ones are refitted; where even powers come no nearer than 1 %, a
 * gain grid holds the rest. Without a centre that of the frame. key: tiff:Make and tiff:Model. doubt: a refit that is
 * off by more than 1 %; a picture that DJI's VignettingFlag says is corrected already. Visited once, or not at all.
 * Errors: ARGUMENT; SIZE as lensprof_lensfun_read, or over 16 (2D: 64) coefficients; SYNTAX; NOT_FOUND where the packet
 * has none of them; VIGNETTING for a polynomial that is not above 0 in the frame or that no falloff comes near;
 * NOT_FINITE; MEMORY; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_drone_xmp_read(const void *data, size_t size, uint32_t width,
                                                                       uint32_t height, const char *source,
                                                                       lensprof_import_visitor visit, void *user,
                                                                       lensprof_error *error);

/* ---- Lens shading tables of the Raspberry Pi (libcamera's rpi.alsc) -------------------------------------------- */

/* The falloff of a tuning file of libcamera, of its {"rpi.alsc": ...} or of that object itself, for a sensor of width x
 * height px: gains luminance_lut, times calibrations_Cr for red and calibrations_Cb for blue, at colour temperature
 * `ct` (K; LENSPROF_UNKNOWN: the file's default_ct, else 4500), between the two nearest tables linearly as libcamera
 * does; not grey ones set the key's color_temperature_k to it. luminance_strength is not applied: the tables are what
 * was measured. Without both calibrations one curve, else three. columns, rows: of the tables; 0 and 0 for those of 16
 * x 12 and 32 x 32. profile, *worst and errors as lensprof_map_read; SYNTAX names line or path; UNSUPPORTED for a file
 * with corner_strength, which replaces the table.
 */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_alsc_read(const void *data, size_t size, double ct,
                                                                  uint32_t columns, uint32_t rows, uint32_t width,
                                                                  uint32_t height, lensprof_profile *profile,
                                                                  double *worst, lensprof_error *error);

/* Writes falloff and gain grid of a profile as {"rpi.alsc": ...}, to be put into a tuning file's `algorithms` in place
 * of its own: tables of columns x rows (16 x 12, or 32 x 32 for a Pi 5; 2 to 256 each) for a sensor of width x height
 * px, to 3 decimals as the tuning tool does, of one colour temperature (K; LENSPROF_UNKNOWN: the key's, else 4500).
 * Output as in base.h. Errors: ARGUMENT; SIZE; what lensprof_profile_validate says; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_alsc_write(const lensprof_profile *profile, double ct,
                                                                   uint32_t columns, uint32_t rows, uint32_t width,
                                                                   uint32_t height, void *data, size_t capacity,
                                                                   size_t *count, lensprof_error *error);

/* ---- Any of these formats ------------------------------------------------------------------------------------- */

typedef enum lensprof_format {
    LENSPROF_FORMAT_AUTO = 0, /* by content, then by the ending of the name; to write, by the name */
    LENSPROF_FORMAT_LENSFUN = 1,
    LENSPROF_FORMAT_LCP = 2,
    LENSPROF_FORMAT_JSON = 3,
    LENSPROF_FORMAT_BLOB = 4,        /* docs/blob.md */
    LENSPROF_FORMAT_DNG_OPCODES = 5, /* the bytes of a tag, and not the TIFF or DNG file around it */
    LENSPROF_FORMAT_DRONE_XMP = 6,   /* an XMP packet, and not the picture around it */
    LENSPROF_FORMAT_ALSC = 7,
    LENSPROF_FORMAT_MAP = 8, /* a picture, decoded by the caller: lensprof_import_options.map, lensprof_map_write */
    LENSPROF_FORMAT_PCALIB = 9,
    LENSPROF_FORMAT_CURVES = 10,
    LENSPROF_FORMAT_RADICAL_RESPONSE = 11,
    LENSPROF_FORMAT_RADICAL_VIGNETTING = 12
} lensprof_format;

/* What a file of a format holds. */
typedef enum lensprof_holds {
    LENSPROF_HOLDS_PROFILES = 0, /* with their keys */
    LENSPROF_HOLDS_RESPONSE = 1,
    LENSPROF_HOLDS_FALLOFF = 2
} lensprof_holds;

/* A format. The library's, static. */
typedef struct lensprof_format_info {
    uint32_t format;     /* lensprof_format */
    uint32_t holds;      /* lensprof_holds */
    uint32_t is_written; /* 1: read and written; 0: read only */
    uint32_t is_many;    /* 1: a file may hold several profiles; 0: one */
    const char *name;    /* one word */
    const char *about;   /* one line, with the ending of its files */
} lensprof_format_info;

/* NULL for AUTO and beyond the last one. */
LENSPROF_API const lensprof_format_info *lensprof_format_get_info(uint32_t format);

/* The format of a file by its content (the first 8 KiB do), then by the ending of its name (may be NULL); AUTO where
 * neither decides. A picture is taken for what its name says: TIFF for opcodes (.dng) or a map, PNG for a map, JPEG for
 * XMP. */
LENSPROF_API uint32_t lensprof_format_detect(const void *data, size_t size, const char *name);

/* What files do not say. */
typedef struct lensprof_import_options {
    uint32_t struct_size;
    uint32_t format;                 /* lensprof_format */
    uint32_t width, height;          /* of the frame, px: opcodes, XMP and alsc want it; else 0 */
    uint32_t columns, rows;          /* alsc: of tables other than 16 x 12 and 32 x 32; else 0 */
    uint32_t layout;                 /* opcodes: lensprof_layout that they work on */
    uint32_t curve;                  /* curves: lensprof_curve */
    double color_temperature_k;      /* alsc; LENSPROF_UNKNOWN: the file's */
    const char *name;                /* of the file, for detection and provenance.source; or NULL */
    const lensprof_map *map;         /* format MAP: the decoded picture, in place of data; else NULL */
    const lensprof_profile_key *key; /* of files that hold a response or a falloff: of the profile that it becomes.
                                        NULL: an empty one, JPEG of a response and RAW of a falloff. Texts that are
                                        empty are filled by the file's, where it has them */
} lensprof_import_options;

/* AUTO, layout RGB, inverse curves; nothing else known. */
LENSPROF_API void lensprof_import_options_init_sized(lensprof_import_options *options, size_t size);
static inline void lensprof_import_options_init(lensprof_import_options *options) {
    lensprof_import_options_init_sized(options, sizeof *options);
}

/* Reads a file of any format: each of its profiles is visited, as by the function of the format, or one that has its
 * response or falloff (`holds` of the entry says which; the other is neutral). doubt, also: a refit that is off by more
 * than 1 %; an M that rises by more than 0.05, which may be a gain. options may be NULL.
 * The containers are the caller's business: opcodes in a TIFF or DNG, XMP in a picture and maps as pictures are
 * UNSUPPORTED, and the text says what to pass. A map is that of the frame, or where there is none of its own size.
 * Errors: ARGUMENT; STRUCT_SIZE; SIZE over 64 MiB; SYNTAX for an empty file and a damaged blob; UNSUPPORTED also where
 * neither content nor name identifies the format; those of the format's own function; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_import(const void *data, size_t size,
                                                               const lensprof_import_options *options,
                                                               lensprof_import_visitor visit, void *user,
                                                               lensprof_error *error);

/* How profiles are written. */
typedef struct lensprof_export_options {
    uint32_t struct_size;
    uint32_t format;            /* lensprof_format */
    uint32_t width, height;     /* of the frame, px: opcodes, alsc and radical's vignetting need it, lcp may have it */
    uint32_t columns, rows;     /* alsc: of the tables, 0 = 16 x 12; rows of curves, 0 = 256 */
    uint32_t layout;            /* opcodes: lensprof_layout that they work on */
    uint32_t dng_form;          /* opcodes: lensprof_dng_form */
    uint32_t curve;             /* curves: lensprof_curve */
    uint32_t pack;              /* blob: lensprof_pack flags */
    double color_temperature_k; /* alsc; LENSPROF_UNKNOWN: the key's */
    const char *name;           /* of the file, for AUTO; or NULL */
} lensprof_export_options;

/* AUTO, layout RGB, the opcode chosen by its error, inverse curves. */
LENSPROF_API void lensprof_export_options_init_sized(lensprof_export_options *options, size_t size);
static inline void lensprof_export_options_init(lensprof_export_options *options) {
    lensprof_export_options_init_sized(options, sizeof *options);
}

/* Writes profiles as a file of any format that is written: all of them where it holds several, else one; of three
 * responses pcalib gets that of green. Opcodes are the bytes of a tag; maps are UNSUPPORTED (lensprof_map_write).
 * Output as in base.h. Errors: ARGUMENT, also for more profiles than the format holds; STRUCT_SIZE; SIZE for a file of
 * over 64 MiB, which lensprof_import would refuse; UNSUPPORTED for a format that is read only or that the name does not
 * tell; those of the format's own function. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_export(const lensprof_profile *const *profiles,
                                                               uint32_t profile_count,
                                                               const lensprof_export_options *options, void *data,
                                                               size_t capacity, size_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
