/* lensprof/formats.h - files of other programs, from and to memory: Lensfun databases, Adobe lens profiles, DNG
 * opcodes, XMP of drone cameras, radical's files, pcalib.txt, times.txt, response tables and falloff maps; also
 * profiles as JSON. hugin.h, which this header includes, has Hugin's projects and points.
 *
 * lensprof_import and lensprof_export, at the end, handle all of them in one call. No function here opens a file. */
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

/* ---- Falloffs in databases of other programs -------------------------------------------------------------- */

/* One falloff in a file. */
typedef struct lensprof_import_entry {
    const lensprof_profile *profile; /* valid until the visitor returns: key, provenance, vignetting; a linear response.
                                      * Keep it with lensprof_profile_copy */
    uint32_t usable; /* 0: not a valid falloff (provenance.doubt has the reason); lensprof_profile_validate refuses the
                      * profile. 1: a valid profile, but provenance.doubt may have a warning */
    uint32_t holds;  /* lensprof_holds: PROFILES, or from lensprof_import what the file holds, the rest being neutral */
    double change; /* of a response that decreased in places: the largest change that made it increasing, levels (1/255
                    * of its range); otherwise 0 */
} lensprof_import_entry;

/* Receives the entries in file order. A return value other than OK stops the reading and becomes its result, with the
 * error text left by the visitor. */
typedef lensprof_status (*lensprof_import_visitor)(void *user, const lensprof_import_entry *entry);

/* ---- Lensfun database (.xml) ------------------------------------------------------------------------------ */

/* Reads every <vignetting> of a database of version 1 or 2 as a profile of raw pictures in lensprof's conventions
 * (docs/formats.md):
 *  - lens = "<maker> <model>", or the model alone if it begins with the maker. Texts without a `lang` are preferred to
 *    English ones. For a lens with one mount whose first letter is lower case (a camera with a fixed lens), also
 *    camera_maker and camera_model, if the file has exactly one <camera> with this mount.
 *  - crop_factor of the lens or of its <calibration>; focal_mm, aperture and distance_m as written, except that 1000 m,
 *    which Lensfun's tools write for infinity, becomes INFINITY.
 *  - model "pa": k as written. Model "acm", with radii in focal lengths: rescaled, by real-focal of the <distortion> of
 *    that focal length if given. <center> is converted with the <aspect-ratio>, by default 3:2.
 *  - provenance: method "import", source = `source` (e.g. a file name; may be NULL, truncated if too long) and the
 *    licence of Lensfun's database. doubt: M below 0.001 (usable = 0); coefficients -0.3, 0, 0, the start values of
 *    Lensfun's calibrate.py; M increases outwards by more than 0.05.
 * The whole text is checked before the first entry is visited. Document types are skipped and entities not expanded.
 * Errors (the text names line and lens): ARGUMENT; SIZE over 64 MiB, or over 2 million elements or attributes; SYNTAX;
 * UNSUPPORTED for another version or model; MEMORY; the return value of the visitor. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_read(const void *data, size_t size, const char *source,
                                                                     lensprof_import_visitor visit, void *user,
                                                                     lensprof_error *error);

/* Receives the cameras of a file. A return value other than OK stops the reading and becomes its result. */
typedef lensprof_status (*lensprof_camera_visitor)(void *user, const lensprof_camera_model *camera);

/* Reads the <camera> entries of a Lensfun database: maker and model as in EXIF and in the other language given,
 * mount, crop factor. A camera with a fixed lens also gets the lens of its mount in the same file, named as by
 * lensprof_lensfun_read; if there are several, the one without a converter, and no lens if that is ambiguous. All
 * entries are checked before the first visit. Errors: as lensprof_lensfun_read. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_read_cameras(const void *data, size_t size,
                                                                             const char *source,
                                                                             lensprof_camera_visitor visit, void *user,
                                                                             lensprof_error *error);

/* Writes the falloffs of profiles as a database of version 1, which every Lensfun reads: model "pa", one <lens> per
 * lens and crop factor. Output as in base.h. Doubles round-trip exactly.
 *  - <maker> is the first word of key.lens, <model> all of it; the mount is Lensfun's "Generic".
 *  - Lensfun has one curve for all channels: the mean of three curves is written. Responses, covariances, units and
 *    provenance cannot be represented and are left out.
 *  - Infinite and unknown distances become 1000 m.
 *  - A centre is converted for 3:2 frames; Lensfun has one per lens.
 * Errors (the text names the profile, counted from 0): ARGUMENT for an unknown lens, crop factor, focal length or
 * aperture, texts that are not UTF-8, two profiles of the same lens and setting, or different centres of one lens;
 * UNSUPPORTED for a gain grid or pictures corrected in camera; those of lensprof_profile_validate; CAPACITY;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_write(const lensprof_profile *const *profiles,
                                                                      uint32_t profile_count, void *data,
                                                                      size_t capacity, size_t *count,
                                                                      lensprof_error *error);

/* ---- Profiles as JSON ------------------------------------------------------------------------------------- */

/* Writes profiles as printed by `lensprof profile show --json` (docs/json.md): one object for one profile, otherwise
 * {"schema": 1, "profiles": [...]}. Doubles, and the floats of gain grids, round-trip exactly; bytes of texts that are
 * not UTF-8 become U+FFFD. Output as in base.h. Errors (the text names the profile, counted from 0): ARGUMENT; those of
 * lensprof_profile_validate; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_json_write(const lensprof_profile *const *profiles,
                                                                   uint32_t profile_count, void *data, size_t capacity,
                                                                   size_t *count, lensprof_error *error);

/* Reads profiles from JSON. Output of lensprof_json_write gives the same profiles, bit by bit. Each profile must have
 * `key` with `processing`, and `vignetting` with `k`; `gain_grid`, `covariance`, `provenance` and `response` are
 * optional (no response: linear). Texts and numbers of a key that are missing or null are unknown. Other members are
 * ignored. provenance.source is that of the file, by default `source` (may be NULL, truncated if too long).
 * All profiles are checked before the first is visited; all are usable.
 * Errors (the text names the line, or the path, e.g. "profiles[2].vignetting.k[0]"): ARGUMENT; SIZE over 64 MiB or 4
 * million values; SYNTAX, also for more than 32 levels; UNSUPPORTED for another schema; those of the model's validate
 * functions; MEMORY; the return value of the visitor. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_json_read(const void *data, size_t size, const char *source,
                                                                  lensprof_import_visitor visit, void *user,
                                                                  lensprof_error *error);

/* ---- Photometric calibration of visual odometry (pcalib.txt, times.txt) ------------------------------------- */

/* Reads the inverse response of TUM's tools, DSO and related programs: irradiances of 256 evenly spaced grey values (up
 * to 65536), strictly increasing, separated by blanks and line ends. They are rescaled by the first and last, as those
 * tools do, to a TABLE. Errors (the text names the value, counted from 0): ARGUMENT; SYNTAX for fewer than 256 values
 * or one that is not a finite number; SIZE for over 65536; RESPONSE for a value not above the one before; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pcalib_read(const void *data, size_t size,
                                                                    lensprof_response *response, lensprof_error *error);

/* Writes 256 irradiances, from 0 to 255, on one line. Successive values differ by at least 1e-4, so they increase
 * strictly in single precision too; a response too steep for that is flattened by that much. Output as in base.h.
 * Errors: ARGUMENT; those of lensprof_response_validate; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pcalib_write(const lensprof_response *response, void *data,
                                                                     size_t capacity, size_t *count,
                                                                     lensprof_error *error);

/* A line of times.txt. If two frames differ only in exposure time, the lensprof_exposure.ev of one relative to the
 * other is log2(exposure_ms / exposure_ms of the other). Frozen value struct. */
typedef struct lensprof_frame_time {
    char id[64];        /* as written, with leading zeros */
    double time_s;      /* time stamp */
    double exposure_ms; /* > 0 or LENSPROF_UNKNOWN */
} lensprof_frame_time;

/* Reads lines of name, time and exposure; the exposure may be missing or 0 (unknown). Empty lines and lines that begin
 * with # are skipped. frames[capacity] and *count as in base.h. Errors (the text names the line): ARGUMENT; SYNTAX;
 * CAPACITY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_times_read(const void *data, size_t size,
                                                                   lensprof_frame_time *frames, uint32_t capacity,
                                                                   uint32_t *count, lensprof_error *error);

/* Writes the same format; numbers round-trip exactly. Output as in base.h. Errors (the text names the frame): ARGUMENT
 * for a name that is empty, contains blanks or begins with #; NOT_FINITE; EXPOSURE; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_times_write(const lensprof_frame_time *frames,
                                                                    uint32_t frame_count, void *data, size_t capacity,
                                                                    size_t *count, lensprof_error *error);

/* ---- Response curves as tables of text (.csv, pfstools' .m) -------------------------------------------------- */

/* Content of a table, on an even grid of its argument. Such files do not state it. */
typedef enum lensprof_curve {
    LENSPROF_CURVE_INVERSE = 0, /* grey value -> irradiance in any unit: OpenCV's Debevec and Robertson, AliceVision */
    LENSPROF_CURVE_LOG = 1,     /* grey value -> natural logarithm of the irradiance: Debevec's g */
    LENSPROF_CURVE_LOG10 = 2,   /* grey value -> decadic logarithm of the irradiance */
    LENSPROF_CURVE_FORWARD = 3  /* irradiance -> grey value, rescaled by the first and last */
} lensprof_curve;

/* Reads 2 to 65536 rows of 1 or 3 numbers (red, green, blue; or blue, green, red if a header line states it),
 * optionally after a number that counts the rows or is evenly spaced from 0. Separators are blanks, commas, semicolons
 * or brackets; lines that begin with #, % or // and a header line of names are skipped. The result is one or three
 * TABLEs, in which irradiance 1 is that of the last grey value and anything darker than the first gives 0. `# name:`
 * lines mark a pfstools file, with one matrix per channel; `curve` is then ignored. responses: 3 of them, of which
 * *count are written. Errors (the text names the line): ARGUMENT; SIZE over 65536 rows or 64 MiB; SYNTAX; RESPONSE for
 * a value below that of the row before, or an irradiance below 0; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_curves_read(const void *data, size_t size, uint32_t curve,
                                                                    lensprof_response *responses, uint32_t *count,
                                                                    lensprof_error *error);

/* Writes `rows` (2 to 65536; 256 for 8-bit pictures) rows of 1 or 3 responses as a lensprof_curve, after a header line:
 * the row number (FORWARD: irradiance), then the values, which round-trip exactly. Irradiances are 0 to 1; logarithms
 * are taken of no less than 1e-6. Output as in base.h. Errors: ARGUMENT; those of lensprof_response_validate; CAPACITY;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_curves_write(const lensprof_response *responses,
                                                                     uint32_t response_count, uint32_t curve,
                                                                     uint32_t rows, void *data, size_t capacity,
                                                                     size_t *count, lensprof_error *error);

/* ---- Falloffs as maps (vignette.png, gain images) ------------------------------------------------------------ */

typedef enum lensprof_map_sense {
    LENSPROF_MAP_ATTENUATION = 0, /* correct by division: vignette.png of TUM and DSO */
    LENSPROF_MAP_GAIN = 1         /* correct by multiplication */
} lensprof_map_sense;

/* A map in the caller's memory, linear, in any unit; 0 = unknown. Values are the means of equal cells of the frame,
 * like the pixels of a reduced picture: all pixels of a picture form the map of its frame. Frozen value struct. */
typedef struct lensprof_map {
    uint32_t columns, rows; /* 2..65536 each */
    uint32_t channels;      /* 1 or 3 (red, green, blue) */
    uint32_t sense;         /* lensprof_map_sense */
    const float *values;    /* [row][column][channel], without gaps */
} lensprof_map;

/* Fits the falloff of a map, in a frame of width x height px: one polynomial per channel with a common centre, by least
 * squares of the relative error, and a gain grid if the polynomials leave more than 0.2 %. Sets vignetting and grid of
 * an initialised *profile, removes its covariance and leaves the rest. *worst (may be NULL) receives the largest
 * relative error left; for maps with a side of more than 1024, that of means over up to 64 values along each side.
 * A dark surround with a sharp edge, as outside the circle of a fisheye, is unknown, too; there the falloff stays that
 * of the nearest known place. If the rest is a circle, provenance.source states it.
 * Errors: ARGUMENT, also for values below 0; SIZE; NOT_FINITE; VIGNETTING for a map with too few known values or that
 * no falloff approximates; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_map_read(const lensprof_map *map, uint32_t width,
                                                                 uint32_t height, lensprof_profile *profile,
                                                                 double *worst, lensprof_error *error);

/* Writes falloff and gain grid of a profile as columns x rows values for a frame of width x height px, as in
 * lensprof_map; with 1 channel, the mean of the profile's channels. The largest attenuation of all channels is 1, so
 * gains are at least 1. To write vignette.png, multiply by 65535 (or 255) and round, but to no less than 1. Errors:
 * ARGUMENT; SIZE; those of lensprof_profile_validate; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_map_write(const lensprof_profile *profile, uint32_t width,
                                                                  uint32_t height, uint32_t columns, uint32_t rows,
                                                                  uint32_t channels, uint32_t sense, float *values,
                                                                  lensprof_error *error);

/* ---- radical (.crf, .vgn) ------------------------------------------------------------------------------------ */

/* Reads radical's response file: irradiances of 256 grey values in three channels, in any unit, to three TABLEs as in
 * lensprof_curves_read. Errors: ARGUMENT; SYNTAX; UNSUPPORTED for a matrix of another type; SIZE; RESPONSE for
 * irradiances that decrease or are invalid; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_response_read(const void *data, size_t size,
                                                                              lensprof_response *responses,
                                                                              lensprof_error *error);

/* Writes 1 (for all channels) or 3 responses. Irradiances are 1e-6 to 1, because radical takes their logarithm. Output
 * as in base.h. Errors: ARGUMENT; those of lensprof_response_validate; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_response_write(const lensprof_response *responses,
                                                                               uint32_t response_count, void *data,
                                                                               size_t capacity, size_t *count,
                                                                               lensprof_error *error);

/* Reads radical's vignetting file, polynomial of degree 3 or nonparametric. Polynomials whose channels share a centre
 * are rescaled exactly. Polynomials with different centres, and maps, are refitted as in lensprof_map_read, in the
 * frame that the file specifies. profile, *worst (0 if exact) and errors as there; SYNTAX; UNSUPPORTED for other
 * models. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_vignetting_read(const void *data, size_t size,
                                                                                lensprof_profile *profile,
                                                                                double *worst, lensprof_error *error);

/* Writes a profile for pictures of width x height px: a polynomial or, if it has a gain grid, a map of 12 bytes per
 * pixel. Output as in base.h. Errors: ARGUMENT; SIZE; those of lensprof_profile_validate; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_radical_vignetting_write(const lensprof_profile *profile,
                                                                                 uint32_t width, uint32_t height,
                                                                                 void *data, size_t capacity,
                                                                                 size_t *count, lensprof_error *error);
/* ---- DNG opcode lists (tags OpcodeList2, OpcodeList3) ----------------------------------------------------- */

typedef enum lensprof_dng_form {
    LENSPROF_DNG_RADIAL = 0,   /* FixVignetteRadial */
    LENSPROF_DNG_GAIN_MAP = 1, /* GainMap */
    LENSPROF_DNG_AUTO = 2      /* lensprof_export: RADIAL if it is exact to 0.5 %, otherwise GAIN_MAP */
} lensprof_dng_form;

/* Reads the falloff of an opcode list, the bytes of the tag, as one profile of raw pictures with an otherwise empty
 * key. width, height: of the frame that the opcodes apply to, in square pixels (the active area of the picture).
 * layout: the lensprof_layout that they apply to: RGGB, GRBG, GBRG or BGGR for a mosaic (OpcodeList2), RGB for three
 * planes (OpcodeList3), GREY for one.
 *  - Gains are the inverse of attenuations; those of several opcodes are multiplied.
 *  - FixVignetteRadial alone, about one centre: the radial falloff by least squares of the relative error.
 *    Otherwise the frame is sampled: radial falloffs and, if they leave more than 0.2 %, a gain grid (docs/formats.md).
 *  - GainMap: bilinear at pixel centres, constant beyond the outermost points, plane min(plane, MapPlanes - 1). In a
 *    mosaic each colour uses the maps of its pixels, green the mean of its two. Channels that differ get a falloff
 *    each, which is 1 at its centre, so a constant gain per channel is left out.
 *  - doubt: a largest relative error above 1 %, and opcodes of other kinds, which are left out.
 * Visited at most once. Errors (the text names the opcode, from 0): ARGUMENT; SYNTAX; SIZE over 64 gains or 1 Mi map
 * points; NOT_FOUND if no opcode is a gain; UNSUPPORTED for an opcode that is not in DNG 1.7 and not optional, for
 * gains after TrimBounds, for a map of every 2nd pixel if the layout is not a mosaic, and for maps of fewer pixels;
 * VIGNETTING for gains not above 0 or that no falloff approximates; MEMORY; the return value of the visitor. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_dng_opcodes_read(const void *data, size_t size, uint32_t width,
                                                                         uint32_t height, uint32_t layout,
                                                                         const char *source,
                                                                         lensprof_import_visitor visit, void *user,
                                                                         lensprof_error *error);

/* Writes the falloff of a profile as such a list, with one optional opcode, or four. `form`, a lensprof_dng_form:
 *  - RADIAL: 5 coefficients by least squares of the relative error of the gain.
 *  - GAIN_MAP: 33 points along the longer side, at least 9 along the shorter. For a mosaic and a falloff per channel
 *    four maps, one for each of the four pixel sites of its squares; for RGB one map of 1 or 3 planes.
 * The largest |gain * attenuation - 1| within the frame goes to *worst (may be NULL), also on CAPACITY. Output as in
 * base.h. Errors: ARGUMENT; those of lensprof_profile_validate; UNSUPPORTED for pictures corrected in camera, for
 * RADIAL with a falloff per channel, a gain grid or a centre outside the frame, and for a falloff per channel if layout
 * is GREY; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_dng_opcodes_write(const lensprof_profile *profile,
                                                                          uint32_t width, uint32_t height,
                                                                          uint32_t layout, uint32_t form, void *data,
                                                                          size_t capacity, size_t *count, double *worst,
                                                                          lensprof_error *error);

/* ---- Adobe lens profile (.lcp) ---------------------------------------------------------------------------- */

/* Reads every entry with a VignetteModel, its properties as attributes or elements, as a profile (docs/formats.md):
 *  - key: Make, Model, Lens (LensPrettyName if it is missing), SensorFormatFactor, FocalLength, FocusDistance (INFINITY
 *    from 10 km on), and the f-number 2^(Av / 2) from the APEX ApertureValue Av. RAW if CameraRawProfile is True,
 *    otherwise JPEG. Texts, sensor and frame missing in an entry are those of the first entry.
 *  - vignetting: VignetteModelParam1..3 with radii in FocalLengthX longer sides of the frame, rescaled; or, if there
 *    are VignetteModelPiecewiseParam, their refit. Frames without ImageWidth and ImageLength are taken as 3:2. If the
 *    refit is off by more than 1 %, or FocalLengthY differs, a map of the frame is fitted, with a gain grid.
 *  - provenance, and what is checked first: as lensprof_lensfun_read. doubt, also: a refit with an error above 1 %.
 * In entries that are not usable, k may be NaN. Errors (the text names the line): ARGUMENT; SIZE over 64 MiB, 2 million
 * elements or attributes, 20000 entries or 1000 knots; SYNTAX; MEMORY; the return value of the visitor. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lcp_read(const void *data, size_t size, const char *source,
                                                                 lensprof_import_visitor visit, void *user,
                                                                 lensprof_error *error);

/* Writes the falloffs of profiles of one camera, lens, crop factor and processing as a lens profile, with
 * VignetteModelParam1..3 and centre. width, height: of the frames; both 0 = unknown, taken as 3:2. Output as in base.h.
 * Numbers read back within 1e-9 of themselves. The mean of three channels is written; unknown distances are left out.
 * Errors (the text names the profile, counted from 0): as lensprof_lensfun_write; ARGUMENT also for profiles of several
 * cameras or lenses; SIZE for a side of over a million pixels. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lcp_write(const lensprof_profile *const *profiles,
                                                                  uint32_t profile_count, uint32_t width,
                                                                  uint32_t height, void *data, size_t capacity,
                                                                  size_t *count, lensprof_error *error);

/* ---- Falloffs in the XMP packets of drone cameras ---------------------------------------------------------- */

/* Reads the polynomial that a MicaSense, Parrot Sequoia, DJI or Sentera camera writes into its pictures, from the XMP
 * packet of the picture, as one profile of raw pictures (docs/formats.md). width, height: of the picture, in px.
 *  - Camera:VignettingPolynomial, about Camera:VignettingCenter: 1 + c0 r + c1 r^2 + ..., r in px. An attenuation; from
 *    DJI a gain. Sentera's, as Sentera: or Camera:, begins with the highest power: ... c1, c0. A packet is Sentera's by
 *    tiff:Make or, if that is missing, by the key given to lensprof_import, or by a property of the Sentera namespace.
 *  - drone-dji:VignettingData, about CalibratedOpticalCenterX and Y: such a gain. It takes precedence.
 *  - Camera:VignettingPolynomial2D with the powers in ...2DName: an attenuation, the sum of c x^i y^j with x, y in 0..1
 *    of the frame; fitted as a map, with a gain grid.
 * Radial polynomials are refitted; if even powers are off by more than 1 %, a gain grid holds the rest. Without a
 * centre, that of the frame is used. key: tiff:Make and tiff:Model. doubt: a refit with an error above 1 %; a picture
 * that is already corrected according to DJI's VignettingFlag. Visited at most once. Errors: ARGUMENT; SIZE as
 * lensprof_lensfun_read, or over 16 (2D: 64) coefficients; SYNTAX; NOT_FOUND if the packet has no such data; VIGNETTING
 * for a polynomial that is not above 0 in the frame or that no falloff approximates; NOT_FINITE; MEMORY; the return
 * value of the visitor. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_drone_xmp_read(const void *data, size_t size, uint32_t width,
                                                                       uint32_t height, const char *source,
                                                                       lensprof_import_visitor visit, void *user,
                                                                       lensprof_error *error);

/* ---- Lens shading tables of the Raspberry Pi (libcamera's rpi.alsc) -------------------------------------------- */

/* Reads the falloff of a libcamera tuning file, of its {"rpi.alsc": ...} or of that object itself, for a sensor of
 * width x height px. Gains are luminance_lut, times calibrations_Cr for red and calibrations_Cb for blue, at colour
 * temperature `ct` (K; LENSPROF_UNKNOWN: the file's default_ct, otherwise 4500), interpolated linearly between the two
 * nearest tables as in libcamera. If they are not grey, the key's color_temperature_k is set to it. luminance_strength
 * is not applied: the tables are the measured values. Without both calibrations there is one curve, otherwise three.
 * columns, rows: of the tables; 0 and 0 for those of 16 x 12 and 32 x 32. profile, *worst and errors as
 * lensprof_map_read; SYNTAX names line or path; NOT_FOUND for a tuning file without luminance_lut; UNSUPPORTED for one
 * with corner_strength, which replaces the table. A comma before a closing bracket is accepted, as by libcamera. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_alsc_read(const void *data, size_t size, double ct,
                                                                  uint32_t columns, uint32_t rows, uint32_t width,
                                                                  uint32_t height, lensprof_profile *profile,
                                                                  double *worst, lensprof_error *error);

/* Writes falloff and gain grid of a profile as {"rpi.alsc": ...}, to replace the one in `algorithms` of a tuning file:
 * tables of columns x rows (16 x 12, or 32 x 32 for a Pi 5; 2 to 256 each) for a sensor of width x height px, to 3
 * decimals like the tuning tool, for one colour temperature (K; LENSPROF_UNKNOWN: the key's, otherwise 4500). Output as
 * in base.h. Errors: ARGUMENT; SIZE; those of lensprof_profile_validate; CAPACITY; MEMORY. */
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
    LENSPROF_FORMAT_DNG_OPCODES = 5, /* the bytes of a tag, not the TIFF or DNG file around it */
    LENSPROF_FORMAT_DRONE_XMP = 6,   /* an XMP packet, not the picture around it */
    LENSPROF_FORMAT_ALSC = 7,
    LENSPROF_FORMAT_MAP = 8, /* a picture, decoded by the caller: lensprof_import_options.map, lensprof_map_write */
    LENSPROF_FORMAT_PCALIB = 9,
    LENSPROF_FORMAT_CURVES = 10,
    LENSPROF_FORMAT_RADICAL_RESPONSE = 11,
    LENSPROF_FORMAT_RADICAL_VIGNETTING = 12
} lensprof_format;

/* Content of a file format. */
typedef enum lensprof_holds {
    LENSPROF_HOLDS_PROFILES = 0, /* with their keys */
    LENSPROF_HOLDS_RESPONSE = 1,
    LENSPROF_HOLDS_FALLOFF = 2
} lensprof_holds;

/* Description of a format. Owned by the library, static. */
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

/* Detects the format of a file by its content (the first 8 KiB suffice), then by the ending of its name (may be NULL);
 * AUTO if neither decides. The name decides what a picture contains: TIFF opcodes (.dng) or a map, PNG a map, JPEG
 * XMP. */
LENSPROF_API uint32_t lensprof_format_detect(const void *data, size_t size, const char *name);

/* Information that files do not contain. */
typedef struct lensprof_import_options {
    uint32_t struct_size;
    uint32_t format;                 /* lensprof_format */
    uint32_t width, height;          /* of the frame, px: required by opcodes, XMP and alsc; otherwise 0 */
    uint32_t columns, rows;          /* alsc: of tables other than 16 x 12 and 32 x 32; otherwise 0 */
    uint32_t layout;                 /* opcodes: lensprof_layout that they apply to */
    uint32_t curve;                  /* curves: lensprof_curve */
    double color_temperature_k;      /* alsc; LENSPROF_UNKNOWN: the file's */
    const char *name;                /* of the file, for detection and provenance.source; or NULL */
    const lensprof_map *map;         /* format MAP: the decoded picture, instead of data; otherwise NULL */
    const lensprof_profile_key *key; /* for files that hold a response or a falloff: key of the resulting profile. NULL:
                                        an empty one, JPEG for a response and RAW for a falloff. Empty texts are filled
                                        from the file if it has them */
    uint32_t strict;   /* responses: 1 refuses values that decrease, as the function of the format does; 0 replaces
                          them by the nearest increasing curve */
    uint32_t reserved; /* 0 */
} lensprof_import_options;

/* AUTO, layout RGB, inverse curves; nothing else known. */
LENSPROF_API void lensprof_import_options_init_sized(lensprof_import_options *options, size_t size);
static inline void lensprof_import_options_init(lensprof_import_options *options) {
    lensprof_import_options_init_sized(options, sizeof *options);
}

/* Reads a file of any format and visits each of its profiles, as the function of the format does, or one profile with
 * its response or falloff (`holds` of the entry states which; the other is neutral). doubt, also: a refit with an error
 * above 1 %; an M that increases by more than 0.05, which may be a gain; a response that decreased and was changed by
 * more than 1 level (RESPONSE if by more than a tenth of its range, or with `strict`). options may be NULL.
 * The caller extracts data from containers: opcodes in a TIFF or DNG, XMP in a picture and maps as pictures are
 * UNSUPPORTED, and the text states what to pass. A map has the size of the frame or, if that is not given, its own.
 * Errors: ARGUMENT; STRUCT_SIZE; SIZE over 64 MiB; SYNTAX for an empty file and a damaged blob; UNSUPPORTED also if
 * neither content nor name identifies the format; those of the format's own function; the return value of the
 * visitor. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_import(const void *data, size_t size,
                                                               const lensprof_import_options *options,
                                                               lensprof_import_visitor visit, void *user,
                                                               lensprof_error *error);

/* Options of lensprof_export. */
typedef struct lensprof_export_options {
    uint32_t struct_size;
    uint32_t format;        /* lensprof_format */
    uint32_t width, height; /* of the frame, px: required by opcodes, alsc and radical's vignetting; optional for lcp */
    uint32_t columns, rows; /* alsc: of the tables, 0 = 16 x 12; curves: rows, 0 = 256 */
    uint32_t layout;        /* opcodes: lensprof_layout that they apply to */
    uint32_t dng_form;      /* opcodes: lensprof_dng_form */
    uint32_t curve;         /* curves: lensprof_curve */
    uint32_t pack;          /* blob: lensprof_pack flags */
    double color_temperature_k; /* alsc; LENSPROF_UNKNOWN: the key's */
    const char *name;           /* of the file, for AUTO; or NULL */
} lensprof_export_options;

/* AUTO, layout RGB, opcode form chosen by its error, inverse curves. */
LENSPROF_API void lensprof_export_options_init_sized(lensprof_export_options *options, size_t size);
static inline void lensprof_export_options_init(lensprof_export_options *options) {
    lensprof_export_options_init_sized(options, sizeof *options);
}

/* Writes profiles in any format that can be written: all of them if the format holds several, otherwise one; pcalib
 * gets the green of three responses. Opcodes are the bytes of a tag; maps are UNSUPPORTED (use lensprof_map_write).
 * Output as in base.h. Errors: ARGUMENT, also for more profiles than the format holds; STRUCT_SIZE; SIZE for a file of
 * over 64 MiB, which lensprof_import would refuse; UNSUPPORTED for a format that is read only or that the name does not
 * identify; those of the format's own function. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_export(const lensprof_profile *const *profiles,
                                                               uint32_t profile_count,
                                                               const lensprof_export_options *options, void *data,
                                                               size_t capacity, size_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
