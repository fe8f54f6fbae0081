/* lensprof/formats.h - files of other programs, from and to memory: Lensfun databases, Adobe lens profiles, DNG
 * opcodes, XMP of drone cameras, radical's files, pcalib.txt, response tables and falloff maps; also profiles as JSON,
 * and as code for GPUs and firmware.
 * docs/formats.md states what each holds and how it is converted. hugin.h, which this header includes, has Hugin's
 * projects and points.
 *
 * Example: a profile as a file for Lensfun.
 *
 *     char text[4096];
 *     size_t size;
 *     const lensprof_profile *const all[] = {&profile};
 *     lensprof_export_options options;
 *     lensprof_export_options_init(&options);
 *     options.format = LENSPROF_FORMAT_LENSFUN;
 *     status = lensprof_export(all, 1, &options, text, sizeof text, &size, &error);
 *     if (status == LENSPROF_OK) fwrite(text, 1, size, stdout);
 *
 * lensprof_import reads all of them, lensprof_export writes them. No function here opens a file.
 *
 * Threads: calls are independent of each other. */
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

/* Receives the cameras of a file. A return value other than OK stops the reading and becomes its result. */
typedef lensprof_status (*lensprof_camera_visitor)(void *user, const lensprof_camera_model *camera);

/* Reads the <camera> entries of a Lensfun database: maker and model as in EXIF and in the other language given,
 * mount, crop factor. A camera with a fixed lens also gets the lens of its mount in the same file, named as
 * lensprof_import names it; if there are several, the one without a converter, and no lens if that is ambiguous. All
 * entries are checked before the first visit. Errors: as lensprof_import. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_read_cameras(const void *data, size_t size,
                                                                             const char *source,
                                                                             lensprof_camera_visitor visit, void *user,
                                                                             lensprof_error *error);

/* ---- Response curves as tables of text (.csv, pfstools' .m) -------------------------------------------------- */

/* Content of a table, on an even grid of its argument. Such files do not state it. */
typedef enum lensprof_curve {
    LENSPROF_CURVE_INVERSE = 0, /* grey value -> irradiance in any unit: OpenCV's Debevec and Robertson, AliceVision */
    LENSPROF_CURVE_LOG = 1,     /* grey value -> natural logarithm of the irradiance: Debevec's g */
    LENSPROF_CURVE_LOG10 = 2,   /* grey value -> decadic logarithm of the irradiance */
    LENSPROF_CURVE_FORWARD = 3  /* irradiance -> grey value, rescaled by the first and last */
} lensprof_curve;

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

/* Writes falloff and gain grid of a profile as columns x rows values for a frame of width x height px, as in
 * lensprof_map; with 1 channel, the mean of the profile's channels. The largest attenuation of all channels is 1, so
 * gains are at least 1. To write vignette.png, multiply by 65535 (or 255) and round, but to no less than 1. Errors:
 * ARGUMENT; SIZE; those of lensprof_profile_validate; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_map_write(const lensprof_profile *profile, uint32_t width,
                                                                  uint32_t height, uint32_t columns, uint32_t rows,
                                                                  uint32_t channels, uint32_t sense, float *values,
                                                                  lensprof_error *error);

/* ---- DNG opcode lists (tags OpcodeList2, OpcodeList3) ----------------------------------------------------- */

typedef enum lensprof_dng_form {
    LENSPROF_DNG_RADIAL = 0,   /* FixVignetteRadial */
    LENSPROF_DNG_GAIN_MAP = 1, /* GainMap */
    LENSPROF_DNG_AUTO = 2      /* lensprof_export: RADIAL if it is exact to 0.5 %, otherwise GAIN_MAP */
} lensprof_dng_form;

/* ---- Import and export ---------------------------------------------------------------------------------------- */

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
    LENSPROF_FORMAT_RADICAL_VIGNETTING = 12,
    LENSPROF_FORMAT_CUBE = 13, /* one-dimensional */
    LENSPROF_FORMAT_GLSL = 14, /* GLSL to C: written only */
    LENSPROF_FORMAT_WGSL = 15,
    LENSPROF_FORMAT_C = 16
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
    uint32_t is_written; /* 1: read and written; 0: read only; 2: written only */
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
    uint32_t curve;                  /* curves: lensprof_curve; cube: INVERSE or FORWARD */
    double color_temperature_k;      /* alsc; LENSPROF_UNKNOWN: the file's */
    const char *name;                /* of the file, for detection and provenance.source; or NULL */
    const lensprof_map *map;         /* format MAP: the decoded picture, instead of data; otherwise NULL */
    const lensprof_profile_key *key; /* for files that hold a response or a falloff: key of the resulting profile. NULL:
                                        an empty one, JPEG for a response and RAW for a falloff. Empty texts are filled
                                        from the file if it has them */
    uint32_t strict;                 /* responses: 1 refuses values that decrease; 0 replaces
                                        them by the nearest increasing curve */
    uint32_t reserved;               /* 0 */
} lensprof_import_options;

/* AUTO, layout RGB, inverse curves; nothing else known. */
LENSPROF_API void lensprof_import_options_init_sized(lensprof_import_options *options, size_t size);
static inline void lensprof_import_options_init(lensprof_import_options *options) {
    lensprof_import_options_init_sized(options, sizeof *options);
}

/* Reads a file of any format and visits each of its profiles, in file order, or one profile with
 * its response or falloff (`holds` of the entry states which; the other is neutral). doubt, also: a refit with an error
 * above 1 %; an M that increases by more than 0.05, which may be a gain; a response that decreased and was changed by
 * more than 1 level (RESPONSE if by more than a tenth of its range, or with `strict`). options may be NULL.
 * The caller extracts data from containers: opcodes in a TIFF or DNG, XMP in a picture and maps as pictures are
 * UNSUPPORTED, and the text states what to pass; so is a format that is written only. A map has the size of the frame
 * or, if that is not given, its own.
 * Errors: ARGUMENT; STRUCT_SIZE; SIZE over 64 MiB; SYNTAX for an empty file and a damaged blob; UNSUPPORTED also if
 * neither content nor name identifies the format; those of the format (SYNTAX, RESPONSE, VIGNETTING, NOT_FOUND,
 * NOT_FINITE; the text names line or entry); MEMORY; the return value of the visitor. All of the file is checked before
 * the first visit. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_import(const void *data, size_t size,
                                                               const lensprof_import_options *options,
                                                               lensprof_import_visitor visit, void *user,
                                                               lensprof_error *error);

/* Options of lensprof_export. */
typedef struct lensprof_export_options {
    uint32_t struct_size;
    uint32_t format;        /* lensprof_format */
    uint32_t width, height; /* of the frame, px: required by opcodes, alsc and radical's vignetting; optional for lcp */
    uint32_t columns, rows; /* alsc: of the tables, 0 = 16 x 12; curves: rows, 0 = 256; cube: rows, 0 = 1024 */
    uint32_t layout;        /* opcodes: lensprof_layout that they apply to */
    uint32_t dng_form;      /* opcodes: lensprof_dng_form */
    uint32_t curve;         /* curves: lensprof_curve; cube: INVERSE (into light) or FORWARD (out of it) */
    uint32_t pack;          /* blob: lensprof_pack flags */
    double color_temperature_k;          /* alsc; LENSPROF_UNKNOWN: the key's */
    const char *name;                    /* of the file, for AUTO; or NULL */
    const lensprof_camera_model *camera; /* lensfun: of the pictures, gives maker, mount and crop factor; or NULL */
    const void *into;                    /* lensfun: into_size bytes of a database that the entries are added to; NULL:
                                            a new one. All else of it stays as it is, byte for byte */
    size_t into_size;
    double *cost_ev; /* lensfun: one per profile, or NULL. Receives the largest |log2(profile / written)|, EV, of its
                      * channels in the four corners of the frame, both relative to the middle of the frame */
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
 * identify, or for what the format cannot hold; those of lensprof_profile_validate; CAPACITY; MEMORY. The text names
 * the profile, counted from 0. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_export(const lensprof_profile *const *profiles,
                                                               uint32_t profile_count,
                                                               const lensprof_export_options *options, void *data,
                                                               size_t capacity, size_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
