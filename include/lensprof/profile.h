/* lensprof/profile.h - calibration of one camera, lens and setting.
 *
 * Example: a profile by hand, as a blob for firmware.
 *
 *     uint8_t blob[1024];
 *     size_t size;
 *     lensprof_profile_init(&profile);
 *     strcpy(profile.key.lens, "Acme 50mm f/1.8"), profile.key.focal_mm = 50, profile.key.aperture = 2.8;
 *     profile.vignetting[0].k[0] = -0.35; // of linear pictures: 65 % of the light in the corner
 *     status = lensprof_profile_pack(&profile, 0, blob, sizeof blob, &size);
 *
 * A profile is a value: it can be copied, stored (store.h), applied (apply.h) and packed into a blob for firmware.
 * No heap, no I/O.
 * Threads: all functions are pure. */
#ifndef LENSPROF_PROFILE_H
#define LENSPROF_PROFILE_H

#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An unknown number. In keys it is a value of its own: unknown equals only unknown. */
#define LENSPROF_UNKNOWN (-1.0)

typedef enum lensprof_processing {
    LENSPROF_PROCESSING_RAW = 0,      /* linear sensor data */
    LENSPROF_PROCESSING_JPEG = 1,     /* the camera's own rendering */
    LENSPROF_PROCESSING_CORRECTED = 2 /* rendered, and the camera corrected the falloff */
} lensprof_processing;

/* The camera, lens and setting that a profile applies to. Texts are UTF-8, terminated; empty = unknown. The size stays
 * 512 bytes: new members use the reserved ones. */
typedef struct lensprof_profile_key {
    char camera_maker[64];
    char camera_model[64];
    char lens[128];
    char unit[64];              /* serial numbers of one camera and lens; empty = any of the model */
    double crop_factor;         /* 43.27 mm over the diagonal of the sensor, > 0 or LENSPROF_UNKNOWN */
    double focal_mm;            /* focal length, > 0 or LENSPROF_UNKNOWN */
    double aperture;            /* f-number, > 0 or LENSPROF_UNKNOWN */
    double distance_m;          /* focus distance, > 0 (INFINITY allowed) or LENSPROF_UNKNOWN */
    double color_temperature_k; /* of the light, if the falloff depends on it, > 0 or LENSPROF_UNKNOWN */
    uint32_t processing;        /* lensprof_processing */
    char style[64];             /* picture style of a rendering, as named by the camera; empty = any, or unknown */
    uint32_t reserved[21];      /* 0 */
} lensprof_profile_key;

/* Empty texts, unknown numbers, processing JPEG. */
LENSPROF_API void lensprof_profile_key_init(lensprof_profile_key *key);

/* LENSPROF_OK if the texts are terminated and free of control characters and the numbers are in range. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_key_validate(const lensprof_profile_key *key);

/* The kind of camera (lensprof_camera_kind) whose typical response applies to pictures of this key if their own
 * response is unknown: LINEAR for processing RAW; PHONE if maker, model or lens is that of a phone; ANY for film
 * scanners and if no camera is named; otherwise CAMERA. The key must be valid; NULL gives ANY. */
LENSPROF_API uint32_t lensprof_camera_kind_of(const lensprof_profile_key *key);

/* Data of a camera, independent of the lens: an entry of the table of cameras (store.h). Texts are UTF-8, terminated;
 * empty = unknown. The size stays 1024 bytes: new members use the reserved ones. */
typedef struct lensprof_camera_model {
    char maker[64]; /* maker and model as written in EXIF */
    char model[64];
    char other_maker[64]; /* common name, e.g. "Alpha 7 III"; empty if it is the same */
    char other_model[64];
    char variant[64]; /* distinguishes cameras or picture formats with the same name */
    char mount[64];
    char lens[128];        /* the built-in lens, as named in profiles */
    char source[256];      /* file or database of origin */
    double crop_factor;    /* 43.27 mm over the diagonal of the sensor, > 0 or LENSPROF_UNKNOWN */
    uint32_t fixed_lens;   /* 1: the lens cannot be changed */
    uint32_t reserved[61]; /* 0 */
} lensprof_camera_model;

/* Empty texts, unknown numbers, interchangeable lens. */
LENSPROF_API void lensprof_camera_model_init(lensprof_camera_model *camera);

/* Order of the estimated parameters, which are the rows and columns of a covariance:
 *  1. the EMoR coefficients of response 0 (`modes` of them); with three responses, then those of responses 1 and 2,
 *     each with its own `modes`; responses of other kinds have no parameters;
 *  2. k1, k2, k3 of each of the `vignettings` curves;
 *  3. centre x and y.
 * A fixed parameter has a row and column of zeros. A covariance may be truncated: the uncertainty of parameters beyond
 * its size is unknown. The largest one has 25 modes, three vignetting curves and the centre. */
#define LENSPROF_COVARIANCE_MAX 36

/* The doubt of a fit whose pictures did not show the response (LENSPROF_FIT_RESPONSE_KIND). Lookups use the falloff of
 * such a profile, but do not use its response for any other lens or setting. */
#define LENSPROF_DOUBT_RESPONSE "response not shown by the pictures: typical of the kind"

/* Origin of a profile. The size stays 768 bytes: new members use the reserved ones. */
typedef struct lensprof_provenance {
    char method[32];        /* "transfer", "import", ... */
    char software[32];      /* "lensprof 0.3.0" */
    char source[256];       /* file or database of origin */
    int64_t created_unix_s; /* seconds since 1970-01-01 UTC; 0 = unknown */
    uint32_t images;        /* pictures used */
    uint32_t pairs;         /* correspondences used */
    double heldout_rms;     /* transfer residual of held-out pairs, levels of 255; LENSPROF_UNKNOWN */
    double inlier_share;    /* 0..1; LENSPROF_UNKNOWN */
    char doubt[64];         /* why the profile may be wrong, found at import or by the fit; empty = no doubt */
    int64_t prior_id;       /* profile of the same database that was the prior of the fit; 0 = none */
    uint32_t forced;        /* 1: stored although the fit was not usable; otherwise 0 */
    uint32_t not_usable;    /* 1: from a fit that is not usable; lensprof_store_put then requires `forced`, and does not
                               store this member */
    double gamma_sigma;     /* standard error of ln gamma, the common exponent of response and falloff; 0 = unknown */
    uint32_t reserved[82];  /* 0 */
} lensprof_provenance;

/* About 50 kB: keep it off small stacks. The struct is extensible. A profile that the library shows has the library's
 * struct_size; copy it with lensprof_profile_copy, not by assignment. */
typedef struct lensprof_profile {
    uint32_t struct_size;
    uint32_t responses;       /* 1 for all channels, or 3 */
    uint32_t vignettings;     /* 1 for all channels, or 3 */
    uint32_t covariance_size; /* n; 0 = unknown */
    lensprof_profile_key key;
    lensprof_provenance provenance;
    lensprof_response response[3];
    lensprof_vignetting vignetting[3];
    lensprof_gain_grid grid; /* multiplied by the vignetting; 0 x 0 = no grid */
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX]; /* n x n, row major, in its first n*n */
    lensprof_levels levels;             /* of the samples of pictures to which the profile applies; all 0 = none */
    lensprof_image_circle image_circle; /* outside of it there is no light, and no correction; all 0 = none */
} lensprof_profile;

/* Empty key, linear response, no falloff, no gain grid, no covariance, no levels, no image circle,
 * provenance unknown. */
LENSPROF_API void lensprof_profile_init_sized(lensprof_profile *profile, size_t size);
static inline void lensprof_profile_init(lensprof_profile *profile) {
    lensprof_profile_init_sized(profile, sizeof *profile);
}

/* *to = *from, for any two versions of the struct: members missing in `from` get their defaults. Both must be
 * initialised. Errors: ARGUMENT, STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_copy(lensprof_profile *to,
                                                                     const lensprof_profile *from);

/* LENSPROF_OK if struct_size, key, provenance, responses, vignettings (which share one centre), gain grid,
 * covariance (finite, symmetric, non-negative diagonal), levels and image circle are valid. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_validate(const lensprof_profile *profile);

/* Relative illuminance at pixel (x, y), which may be fractional, of a frame of width x height pixels, in channel 0, 1
 * or 2 of a valid profile. This is the divisor of a correction: M times gain grid, > 0; 1 at the centre of the falloff
 * if there is no grid, and 1 outside of the image circle. Returns 0 for another channel. If not NULL, *sigma receives
 * its standard error, computed from the covariance of k1..k3 and the centre, with the grid taken as exact;
 * LENSPROF_UNKNOWN if the covariance does not include the curve, if the falloff was fixed, or outside of the image
 * circle. */
LENSPROF_API double lensprof_profile_falloff(const lensprof_profile *profile, uint32_t channel, uint32_t width,
                                             uint32_t height, double x, double y, double *sigma);

/* The same for the falloff alone, without gain grid and image circle: M at r half diagonals from its centre, r >= 0.
 * The standard error is that of k1..k3 at this r; the position of the centre does not matter. */
LENSPROF_API double lensprof_profile_radial_falloff(const lensprof_profile *profile, uint32_t channel, double r,
                                                    double *sigma);

/* The same in the corner, r = 1. */
static inline double lensprof_profile_corner_falloff(const lensprof_profile *profile, uint32_t channel, double *sigma) {
    return lensprof_profile_radial_falloff(profile, channel, 1.0, sigma);
}

typedef enum lensprof_pack {
    LENSPROF_PACK_COVARIANCE = 1 /* include the covariance, which a camera does not need: up to 5 kB */
} lensprof_pack;

/* Packs the profile as a blob (docs/blob.md): little-endian, with a version and a CRC-32, readable in place by
 * lensprof_plan_init (apply.h). It contains the key without unit, crop factor, colour temperature and style; the
 * responses (samples in single precision), vignettings, levels, image circle and gain grid; and the provenance without
 * source, doubt, prior, forced and gamma_sigma. Size: 132 bytes and the texts for a linear response, 4 kB more per
 * curve of samples. The same profile gives the same bytes on every machine. `flags`: lensprof_pack, 0 = none.
 * data[capacity] and *count (bytes) as in base.h. Errors: those of lensprof_profile_validate; ARGUMENT for unknown
 * flags. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_pack(const lensprof_profile *profile, uint32_t flags,
                                                                     void *data, size_t capacity, size_t *count);

/* Unpacks the blob data[size], at any address, into an initialised *profile. Packing it again, with its covariance,
 * gives the same blob. The input is not trusted: CORRUPT if it is not a blob, is damaged in any bit, truncated or too
 * long, or does not contain a valid profile; LAYOUT if a newer lensprof wrote it; STRUCT_SIZE;
 * UNSUPPORTED if it has levels or an image circle and a profile of an older version has no room for them. The profile
 * is written only after the whole blob has passed all checks. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_unpack(const void *data, size_t size,
                                                                       lensprof_profile *profile);

#ifdef __cplusplus
}
#endif
#endif
