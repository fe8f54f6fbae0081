/* The reader and the writer of each format, which lensprof_import and lensprof_export call. */
#ifndef LP_FORMATS_EACH_FORMAT_H
#define LP_FORMATS_EACH_FORMAT_H

#include <lensprof/formats.h>

#ifdef __cplusplus
extern "C" {
#endif

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
LENSPROF_MUST_USE lensprof_status lp_lensfun_read(const void *data, size_t size, const char *source,
                                                  lensprof_import_visitor visit, void *user, lensprof_error *error);

/* Writes the falloffs of profiles as a database of version 1, which every Lensfun reads, or adds them to that of
 * options->into (options may be NULL): model "pa", one <lens> per lens and crop factor. Output as in base.h.
 *  - Maker, model and mount as Lensfun writes them (formats/lensfun_names.hpp); "Generic" where no mount is known.
 *  - Lensfun has one curve about the middle of the frame: the mean of three curves is written; a centre or gain grid is
 *    fitted again without it, by least squares of the relative error over the frame (3:2 unless its size is given).
 *  - k has 4 decimals. Infinite and unknown distances become 10 m and 1000 m.
 *  - Entries are in the order of focal length, aperture, distance.
 * Errors (the text names the profile, counted from 0): ARGUMENT for an unknown lens, crop factor, focal length or
 * aperture, texts that are not UTF-8, or two profiles of the same lens and setting; UNSUPPORTED for pictures corrected
 * in camera; those of lensprof_profile_validate; of `into` those of lp_lensfun_read; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_lensfun_write(const lensprof_profile *const *profiles, uint32_t profile_count,
                                                   const lensprof_export_options *options, void *data, size_t capacity,
                                                   size_t *count, lensprof_error *error);

/* Writes profiles as printed by `lensprof profile show --json` (docs/json.md): one object for one profile, otherwise
 * {"schema": 1, "profiles": [...]}. Doubles, and the floats of gain grids, round-trip exactly; bytes of texts that are
 * not UTF-8 become U+FFFD. Output as in base.h. Errors (the text names the profile, counted from 0): ARGUMENT; those of
 * lensprof_profile_validate; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_json_write(const lensprof_profile *const *profiles, uint32_t profile_count,
                                                void *data, size_t capacity, size_t *count, lensprof_error *error);

/* Reads profiles from JSON. Output of lp_json_write gives the same profiles, bit by bit. Each profile must have
 * `key` with `processing`, and `vignetting` with `k`; `gain_grid`, `covariance`, `provenance` and `response` are
 * optional (no response: linear). Texts and numbers of a key that are missing or null are unknown. Other members are
 * ignored. provenance.source is that of the file, by default `source` (may be NULL, truncated if too long).
 * All profiles are checked before the first is visited; all are usable.
 * Errors (the text names the line, or the path, e.g. "profiles[2].vignetting.k[0]"): ARGUMENT; SIZE over 64 MiB or 4
 * million values; SYNTAX, also for more than 32 levels; UNSUPPORTED for another schema; those of the model's validate
 * functions; MEMORY; the return value of the visitor. */
LENSPROF_MUST_USE lensprof_status lp_json_read(const void *data, size_t size, const char *source,
                                               lensprof_import_visitor visit, void *user, lensprof_error *error);

/* Reads the inverse response of TUM's tools, DSO and related programs: irradiances of 256 evenly spaced grey values (up
 * to 65536), strictly increasing, separated by blanks and line ends. They are rescaled by the first and last, as those
 * tools do, to a TABLE. Errors (the text names the value, counted from 0): ARGUMENT; SYNTAX for fewer than 256 values
 * or one that is not a finite number; SIZE for over 65536; RESPONSE for a value not above the one before; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_pcalib_read(const void *data, size_t size, lensprof_response *response,
                                                 lensprof_error *error);

/* Writes 256 irradiances, from 0 to 255, on one line. Successive values differ by at least 1e-4, so they increase
 * strictly in single precision too; a response too steep for that is flattened by that much. Output as in base.h.
 * Errors: ARGUMENT; those of lensprof_response_validate; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_pcalib_write(const lensprof_response *response, void *data, size_t capacity,
                                                  size_t *count, lensprof_error *error);

/* Reads 2 to 65536 rows of 1 or 3 numbers (red, green, blue; or blue, green, red if a header line states it),
 * optionally after a number that counts the rows or is evenly spaced from 0. Separators are blanks, commas, semicolons
 * or brackets; lines that begin with #, % or // and a header line of names are skipped. The result is one or three
 * TABLEs, in which irradiance 1 is that of the last grey value and anything darker than the first gives 0. `# name:`
 * lines mark a pfstools file, with one matrix per channel; `curve` is then ignored. responses: 3 of them, of which
 * *count are written. Errors (the text names the line): ARGUMENT; SIZE over 65536 rows or 64 MiB; SYNTAX; RESPONSE for
 * a value below that of the row before, or an irradiance below 0; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_curves_read(const void *data, size_t size, uint32_t curve,
                                                 lensprof_response *responses, uint32_t *count, lensprof_error *error);

/* Writes `rows` (2 to 65536; 256 for 8-bit pictures) rows of 1 or 3 responses as a lensprof_curve, after a header line:
 * the row number (FORWARD: irradiance), then the values, which round-trip exactly. Irradiances are 0 to 1; logarithms
 * are taken of no less than 1e-6. Output as in base.h. Errors: ARGUMENT; those of lensprof_response_validate; CAPACITY;
 * MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_curves_write(const lensprof_response *responses, uint32_t response_count,
                                                  uint32_t curve, uint32_t rows, void *data, size_t capacity,
                                                  size_t *count, lensprof_error *error);

/* Reads a one-dimensional table of Adobe's cube format (.cube), with a domain of 0 to 1: grey -> light (curve INVERSE)
 * or light -> grey (FORWARD), rescaled and repaired as in lp_curves_read. Three equal columns are one response.
 * responses: 3 of them, of which *count are written. Errors (the text names the line): ARGUMENT; UNSUPPORTED for
 * another curve, another domain and a table in three dimensions; SIZE over 65536 rows or 64 MiB; SYNTAX; RESPONSE;
 * MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_cube_read(const void *data, size_t size, uint32_t curve,
                                               lensprof_response *responses, uint32_t *count, lensprof_error *error);

/* Writes the responses of a profile as `rows` (2 to 65536) rows of three numbers 0 to 1, which round-trip exactly: g at
 * even steps of grey (curve INVERSE), or f at even steps of light (FORWARD). Output as in base.h. Errors: ARGUMENT;
 * UNSUPPORTED for another curve; those of lensprof_response_validate; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_cube_write(const lensprof_profile *profile, uint32_t curve, uint32_t rows,
                                                void *data, size_t capacity, size_t *count, lensprof_error *error);

/* Writes response and falloff of a profile as functions of GLSL (ES 3.00 and 3.30) or WGSL, for 32-bit floats:
 * lensprof_falloff(position, size), lensprof_to_light(encoded), lensprof_from_light(light) and
 * lensprof_correct(encoded, position, size). Responses that are not all linear or gamma are tables of 65 to 1021 values
 * of g at even steps of grey: the fewest with which a corrected value is within 0.3 levels of 255 of f(g(B) / M), for M
 * of this falloff, or else the most. Output as in base.h. Errors: ARGUMENT for another format; those of
 * lensprof_profile_validate; UNSUPPORTED for a gain grid; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_shader_write(const lensprof_profile *profile, uint32_t format, void *data,
                                                  size_t capacity, size_t *count, lensprof_error *error);

/* Writes a profile as a header of C99: its blob (without covariance), and centre, k1, k2 and k3 in single precision.
 * Output as in base.h. Errors: ARGUMENT; those of lensprof_profile_validate; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_c_header_write(const lensprof_profile *profile, void *data, size_t capacity,
                                                    size_t *count, lensprof_error *error);

/* Fits the falloff of a map, in a frame of width x height px: one polynomial per channel with a common centre, by least
 * squares of the relative error, and a gain grid if the polynomials leave more than 0.2 %. Sets vignetting and grid of
 * an initialised *profile, removes its covariance and leaves the rest. *worst (may be NULL) receives the largest
 * relative error left; for maps with a side of more than 1024, that of means over up to 64 values along each side.
 * A dark surround with a sharp edge, as outside the circle of a fisheye, is unknown, too; there the falloff stays that
 * of the nearest known place. If the rest is a circle, provenance.source states it.
 * Errors: ARGUMENT, also for values below 0; SIZE; NOT_FINITE; VIGNETTING for a map with too few known values or that
 * no falloff approximates; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_map_read(const lensprof_map *map, uint32_t width, uint32_t height,
                                              lensprof_profile *profile, double *worst, lensprof_error *error);

/* Reads radical's response file: irradiances of 256 grey values in three channels, in any unit, to three TABLEs as in
 * lp_curves_read. Errors: ARGUMENT; SYNTAX; UNSUPPORTED for a matrix of another type; SIZE; RESPONSE for
 * irradiances that decrease or are invalid; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_radical_response_read(const void *data, size_t size, lensprof_response *responses,
                                                           lensprof_error *error);

/* Writes 1 (for all channels) or 3 responses. Irradiances are 1e-6 to 1, because radical takes their logarithm. Output
 * as in base.h. Errors: ARGUMENT; those of lensprof_response_validate; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_radical_response_write(const lensprof_response *responses, uint32_t response_count,
                                                            void *data, size_t capacity, size_t *count,
                                                            lensprof_error *error);

/* Reads radical's vignetting file, polynomial of degree 3 or nonparametric. Polynomials whose channels share a centre
 * are rescaled exactly. Polynomials with different centres, and maps, are refitted as in lp_map_read, in the
 * frame that the file specifies. profile, *worst (0 if exact) and errors as there; SYNTAX; UNSUPPORTED for other
 * models. */
LENSPROF_MUST_USE lensprof_status lp_radical_vignetting_read(const void *data, size_t size, lensprof_profile *profile,
                                                             double *worst, lensprof_error *error);

/* Writes a profile for pictures of width x height px: a polynomial or, if it has a gain grid, a map of 12 bytes per
 * pixel. Output as in base.h. Errors: ARGUMENT; SIZE; those of lensprof_profile_validate; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_radical_vignetting_write(const lensprof_profile *profile, uint32_t width,
                                                              uint32_t height, void *data, size_t capacity,
                                                              size_t *count, lensprof_error *error);

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
LENSPROF_MUST_USE lensprof_status lp_dng_opcodes_read(const void *data, size_t size, uint32_t width, uint32_t height,
                                                      uint32_t layout, const char *source,
                                                      lensprof_import_visitor visit, void *user, lensprof_error *error);

/* Writes the falloff of a profile as such a list, with one optional opcode, or four. `form`, a lensprof_dng_form:
 *  - RADIAL: 5 coefficients by least squares of the relative error of the gain.
 *  - GAIN_MAP: 33 points along the longer side, at least 9 along the shorter. For a mosaic and a falloff per channel
 *    four maps, one for each of the four pixel sites of its squares; for RGB one map of 1 or 3 planes.
 * The largest |gain * attenuation - 1| within the frame goes to *worst (may be NULL), also on CAPACITY. Output as in
 * base.h. Errors: ARGUMENT; those of lensprof_profile_validate; UNSUPPORTED for pictures corrected in camera, for
 * RADIAL with a falloff per channel, a gain grid or a centre outside the frame, and for a falloff per channel if layout
 * is GREY; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_dng_opcodes_write(const lensprof_profile *profile, uint32_t width, uint32_t height,
                                                       uint32_t layout, uint32_t form, void *data, size_t capacity,
                                                       size_t *count, double *worst, lensprof_error *error);

/* Reads every entry with a VignetteModel, its properties as attributes or elements, as a profile (docs/formats.md):
 *  - key: Make, Model, Lens (LensPrettyName if it is missing), SensorFormatFactor, FocalLength, FocusDistance (INFINITY
 *    from 10 km on), and the f-number 2^(Av / 2) from the APEX ApertureValue Av. RAW if CameraRawProfile is True,
 *    otherwise JPEG. Texts, sensor and frame missing in an entry are those of the first entry.
 *  - vignetting: VignetteModelParam1..3 with radii in FocalLengthX longer sides of the frame, rescaled; or, if there
 *    are VignetteModelPiecewiseParam, their refit. Frames without ImageWidth and ImageLength are taken as 3:2. If the
 *    refit is off by more than 1 %, or FocalLengthY differs, a map of the frame is fitted, with a gain grid.
 *  - provenance, and what is checked first: as lp_lensfun_read. doubt, also: a refit with an error above 1 %.
 * In entries that are not usable, k may be NaN. Errors (the text names the line): ARGUMENT; SIZE over 64 MiB, 2 million
 * elements or attributes, 20000 entries or 1000 knots; SYNTAX; MEMORY; the return value of the visitor. */
LENSPROF_MUST_USE lensprof_status lp_lcp_read(const void *data, size_t size, const char *source,
                                              lensprof_import_visitor visit, void *user, lensprof_error *error);

/* Writes the falloffs of profiles of one camera, lens, crop factor and processing as a lens profile, with
 * VignetteModelParam1..3 and centre. width, height: of the frames; both 0 = unknown, taken as 3:2. Output as in base.h.
 * Numbers read back within 1e-9 of themselves. The mean of three channels is written; unknown distances are left out.
 * Errors (the text names the profile, counted from 0): as lp_lensfun_write; ARGUMENT also for profiles of several
 * cameras or lenses; SIZE for a side of over a million pixels. */
LENSPROF_MUST_USE lensprof_status lp_lcp_write(const lensprof_profile *const *profiles, uint32_t profile_count,
                                               uint32_t width, uint32_t height, void *data, size_t capacity,
                                               size_t *count, lensprof_error *error);

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
 * lp_lensfun_read, or over 16 (2D: 64) coefficients; SYNTAX; NOT_FOUND if the packet has no such data; VIGNETTING
 * for a polynomial that is not above 0 in the frame or that no falloff approximates; NOT_FINITE; MEMORY; the return
 * value of the visitor. */
LENSPROF_MUST_USE lensprof_status lp_drone_xmp_read(const void *data, size_t size, uint32_t width, uint32_t height,
                                                    const char *source, lensprof_import_visitor visit, void *user,
                                                    lensprof_error *error);

/* Reads the falloff of a libcamera tuning file, of its {"rpi.alsc": ...} or of that object itself, for a sensor of
 * width x height px. Gains are luminance_lut, times calibrations_Cr for red and calibrations_Cb for blue, at colour
 * temperature `ct` (K; LENSPROF_UNKNOWN: the file's default_ct, otherwise 4500), interpolated linearly between the two
 * nearest tables as in libcamera. If they are not grey, the key's color_temperature_k is set to it. luminance_strength
 * is not applied: the tables are the measured values. Without both calibrations there is one curve, otherwise three.
 * columns, rows: of the tables; 0 and 0 for those of 16 x 12 and 32 x 32. profile, *worst and errors as
 * lp_map_read; SYNTAX names line or path; NOT_FOUND for a tuning file without luminance_lut; UNSUPPORTED for one
 * with corner_strength, which replaces the table. A comma before a closing bracket is accepted, as by libcamera. */
LENSPROF_MUST_USE lensprof_status lp_alsc_read(const void *data, size_t size, double ct, uint32_t columns,
                                               uint32_t rows, uint32_t width, uint32_t height,
                                               lensprof_profile *profile, double *worst, lensprof_error *error);

/* Writes falloff and gain grid of a profile as {"rpi.alsc": ...}, to replace the one in `algorithms` of a tuning file:
 * tables of columns x rows (16 x 12, or 32 x 32 for a Pi 5; 2 to 256 each) for a sensor of width x height px, to 3
 * decimals like the tuning tool, for one colour temperature (K; LENSPROF_UNKNOWN: the key's, otherwise 4500). Output as
 * in base.h. Errors: ARGUMENT; SIZE; those of lensprof_profile_validate; CAPACITY; MEMORY. */
LENSPROF_MUST_USE lensprof_status lp_alsc_write(const lensprof_profile *profile, double ct, uint32_t columns,
                                                uint32_t rows, uint32_t width, uint32_t height, void *data,
                                                size_t capacity, size_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
