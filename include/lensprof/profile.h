/* lensprof/profile.h - what is known about one camera, lens and setting.
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

/* A number that is not known; a value of its own in keys: unknown equals unknown and nothing else. */
#define LENSPROF_UNKNOWN (-1.0)

typedef enum lensprof_processing {
    LENSPROF_PROCESSING_RAW = 0,      /* linear sensor data */
    LENSPROF_PROCESSING_JPEG = 1,     /* the camera's own rendering */
    LENSPROF_PROCESSING_CORRECTED = 2 /* rendered, with the falloff corrected in camera */
} lensprof_processing;

/* What a profile is for. Texts are UTF-8, terminated; empty = unknown. 512 bytes for ever: new members take the
 * reserved ones. */
typedef struct lensprof_profile_key {
    char camera_maker[64];
    char camera_model[64];
    char lens[128];
    char unit[64];              /* serial numbers, of one camera and lens; empty = any of the model */
    double crop_factor;         /* 43.27 mm over the diagonal of the sensor, > 0 or LENSPROF_UNKNOWN */
    double focal_mm;            /* focal length, > 0 or LENSPROF_UNKNOWN */
    double aperture;            /* f-number, > 0 or LENSPROF_UNKNOWN */
    double distance_m;          /* focus distance, > 0 (INFINITY allowed) or LENSPROF_UNKNOWN */
    double color_temperature_k; /* of the light, where the falloff depends on it, > 0 or LENSPROF_UNKNOWN */
    uint32_t processing;        /* lensprof_processing */
    char style[64];             /* picture style of a rendering, as the camera calls it; empty = any, or not known */
    uint32_t reserved[21];      /* 0 */
} lensprof_profile_key;

/* Empty texts, unknown numbers, processing JPEG. */
LENSPROF_API void lensprof_profile_key_init(lensprof_profile_key *key);

/* LENSPROF_OK when the texts are terminated and free of control characters and the numbers in range. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_key_validate(const lensprof_profile_key *key);

/* The kind of camera (lensprof_camera_kind) whose typical response pictures of this key have while none of its own is
 * known: LINEAR for processing RAW; PHONE where maker, model or lens is a phone's; ANY for film scanners and where no
 * camera is named; CAMERA for every other. The key is valid; NULL is ANY. */
LENSPROF_API uint32_t lensprof_camera_kind_of(const lensprof_profile_key *key);

/* What is known of a camera, whatever its lens: an entry of a table of cameras (store.h). Texts are UTF-8, terminated;
 * empty = not known. 1024 bytes for ever: new members take the reserved ones. */
typedef struct lensprof_camera_model {
    char maker[64]; /* as its EXIF has it, as has the model */
    char model[64];
    char other_maker[64]; /* as people call it: "Alpha 7 III"; empty where that is the same */
    char other_model[64];
    char variant[64]; /* which one, where several cameras or picture formats have one name */
    char mount[64];
    char lens[128];        /* the lens that it has built in, as profiles name it */
    char source[256];      /* file or database it is from */
    double crop_factor;    /* 43.27 mm over the diagonal of the sensor, > 0 or LENSPROF_UNKNOWN */
    uint32_t fixed_lens;   /* 1: the lens cannot be changed */
    uint32_t reserved[61]; /* 0 */
} lensprof_camera_model;

/* Empty texts, unknown numbers, a lens that can be changed. */
LENSPROF_API void lensprof_camera_model_init(lensprof_camera_model *camera);

/* LENSPROF_OK when it has a model, the texts are terminated and free of control characters and the numbers in range. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_camera_model_validate(const lensprof_camera_model *camera);

/* Order of the estimated parameters, which are the rows and columns of a covariance:
 *  1. the EMoR coefficients of response 0 (`modes` of them), then, where there are three responses, those of response 1
 *     and of response 2, each by its own `modes`; responses of other kinds have no parameters;
 *  2. k1, k2, k3 of each of the `vignettings` curves;
 *  3. centre x and y.
 * A parameter held fixed has a row and column of zeros. A covariance may end early: parameters beyond its size are not
 * known. The largest one is that of 25 modes, three vignetting curves and the centre. */
#define LENSPROF_COVARIANCE_MAX 36

/* Where a profile comes from. 768 bytes for ever: new members take the reserved ones. */
typedef struct lensprof_provenance {
    char method[32];        /* "transfer", "import", ... */
    char software[32];      /* "lensprof 0.2.0" */
    char source[256];       /* file or database it was made from */
    int64_t created_unix_s; /* seconds since 1970-01-01 UTC; 0 = unknown */
    uint32_t images;        /* pictures used */
    uint32_t pairs;         /* correspondences used */
    double heldout_rms;     /* transfer residual on held-out pairs, levels of 255; LENSPROF_UNKNOWN */
    double inlier_share;    /* 0..1; LENSPROF_UNKNOWN */
    char doubt[64];         /* why it may be wrong, as found when it was imported or fitted; empty = no doubt */
    int64_t prior_id;       /* profile of the same database that was the prior of its fit; 0 = none */
    uint32_t forced;        /* 1: stored although the fit was not usable; else 0 */
    uint32_t not_usable;    /* 1: of a fit whose result is not usable; lensprof_store_put wants `forced` then, and does
                               not store this member */
    double gamma_sigma;     /* standard error of ln gamma, the common exponent of response and falloff; 0 = not known */
    uint32_t reserved[82];  /* 0 */
} lensprof_provenance;

/* About 50 kB: keep it off small stacks. It grows: lensprof_profile_copy, and not an assignment, copies a profile that
 * the library shows, whose struct_size is the library's. */
typedef struct lensprof_profile {
    uint32_t struct_size;
    uint32_t responses;       /* 1 for all channels, or 3 */
    uint32_t vignettings;     /* 1 for all channels, or 3 */
    uint32_t covariance_size; /* n, 0 = not known */
    lensprof_profile_key key;
    lensprof_provenance provenance;
    lensprof_response response[3];
    lensprof_vignetting vignetting[3];
    lensprof_gain_grid grid; /* multiplied to the vignetting; 0 x 0 where there is none */
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX]; /* n x n, row major, in its first n*n */
} lensprof_profile;

/* Empty key, linear response, no falloff, no gain grid, no covariance, provenance unknown. */
LENSPROF_API void lensprof_profile_init_sized(lensprof_profile *profile, size_t size);
static inline void lensprof_profile_init(lensprof_profile *profile) {
    lensprof_profile_init_sized(profile, sizeof *profile);
}

/* *to = *from, of any two versions: members that `from` does not have get their defaults. Both are initialised. Errors:
 * ARGUMENT, STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_copy(lensprof_profile *to,
                                                                     const lensprof_profile *from);

/* LENSPROF_OK when struct_size, key, provenance, responses, vignettings (which share one centre), gain grid and
 * covariance (finite, symmetric, non-negative diagonal) are valid. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_validate(const lensprof_profile *profile);

/* 1 where the doubt of a provenance concerns the response alone: the fit's pictures did not show it
 * (LENSPROF_FIT_RESPONSE_KIND). Lookups answer with the falloff of such a profile, and take its response for no other
 * lens or setting. Else 0. */
LENSPROF_API int lensprof_provenance_doubts_response(const lensprof_provenance *provenance);

/* Relative illuminance at pixel (x, y), not necessarily a whole one, of a frame of width x height pixels, in channel 0,
 * 1 or 2 of a valid profile, as applying it divides by: M times gain grid, > 0; the centre of the falloff has 1 where
 * there is no grid. 0 for another channel. When not NULL, *sigma receives its standard error by the covariance of
 * k1..k3 and the centre, the grid taken as exact; LENSPROF_UNKNOWN where the covariance does not reach to the curve, or
 * the falloff was held fixed. */
LENSPROF_API double lensprof_profile_falloff(const lensprof_profile *profile, uint32_t channel, uint32_t width,
                                             uint32_t height, double x, double y, double *sigma);

/* The same for the falloff alone, without gain grid: M at r half diagonals from its centre, r >= 0. The standard error
 * is that of k1..k3 at this r; where the centre lies makes no difference. */
LENSPROF_API double lensprof_profile_radial_falloff(const lensprof_profile *profile, uint32_t channel, double r,
                                                    double *sigma);

/* The same in the corner: r = 1. */
LENSPROF_API double lensprof_profile_corner_falloff(const lensprof_profile *profile, uint32_t channel, double *sigma);

typedef enum lensprof_pack {
    LENSPROF_PACK_COVARIANCE = 1 /* the covariance as well, which a camera has no use for: up to 5 kB */
} lensprof_pack;

/* The profile as a blob (docs/blob.md): little-endian, with a version and a CRC-32, for lensprof_plan_init (apply.h) to
 * read in place. It holds the key but its unit, crop factor, colour temperature and style, the responses (samples in
 * single precision), vignettings, gain grid, and of the provenance all but source, doubt, prior, forced and
 * gamma_sigma: 132 bytes and the texts for a linear response, 4 kB more for each curve of samples. The same profile
 * gives the same bytes on every machine. `flags`: lensprof_pack, 0 = none. data[capacity] and *count (bytes) as in
 * base.h. Errors: what lensprof_profile_validate says; ARGUMENT for unknown flags. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_pack(const lensprof_profile *profile, uint32_t flags,
                                                                     void *data, size_t capacity, size_t *count);

/* The profile of a blob, data[size], at any address, to an initialised *profile; packed again, with its covariance, it
 * gives the same blob. Nothing is trusted: CORRUPT when it is no blob, is damaged in any bit, cut or too long, or holds
 * what is not a profile; LAYOUT when a newer lensprof wrote it; STRUCT_SIZE. The profile is written only once the whole
 * blob was found to be good. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_unpack(const void *data, size_t size,
                                                                       lensprof_profile *profile);

#ifdef __cplusplus
}
#endif
#endif
