/* Profile blobs (docs/blob.md), read in place; and the model of a plan, which comes from a blob or from the caller's
 * structs. */
#ifndef LENSPROF_CORE_BLOB_H
#define LENSPROF_CORE_BLOB_H

#include <string.h>

#include <lensprof/profile.h>

#include "core/features.h"

#define LP_BLOB_FIXED 100 /* bytes before the parts of variable length */

/* The layout is 1 and the sum of the parts that not every profile has. */
enum lp_blob_part {
    LP_BLOB_CIRCLE = 1, /* the image circle */
    LP_BLOB_LEVELS = 2  /* black and white level */
};

/* Byte offsets of the fixed part. */
enum lp_blob_offset {
    LP_BLOB_MAGIC = 0,
    LP_BLOB_VERSION = 4,     /* u16, then u16 0 */
    LP_BLOB_BYTES = 8,       /* u32: of the whole blob */
    LP_BLOB_PROCESSING = 12, /* bytes from here on */
    LP_BLOB_RESPONSES = 13,
    LP_BLOB_VIGNETTINGS = 14,
    LP_BLOB_GRID = 15,       /* channels, columns, rows */
    LP_BLOB_COVARIANCE = 18, /* its size n, then 0 */
    LP_BLOB_TEXTS = 20,      /* lengths of the five texts, then three 0 */
    LP_BLOB_KEY = 28,        /* focal_mm, aperture, distance_m */
    LP_BLOB_CENTER = 52,     /* x, y */
    LP_BLOB_CREATED = 68,    /* i64 */
    LP_BLOB_COUNTS = 76,     /* images, pairs: u32 */
    LP_BLOB_QUALITY = 84     /* heldout_rms, inlier_share */
};

/* ---- numbers: little-endian, at any address ---- */

static inline uint32_t lp_u32_at(const uint8_t *p) {
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static inline uint64_t lp_u64_at(const uint8_t *p) { return lp_u32_at(p) | (uint64_t)lp_u32_at(p + 4) << 32; }

static inline float lp_f32_at(const uint8_t *p) {
    uint32_t bits = lp_u32_at(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double lp_f64_at(const uint8_t *p) {
    uint64_t bits = lp_u64_at(p);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* ---- models ---- */

/* The model from which a plan is made. If samples or nodes are in a blob, `table` or `attenuation` is NULL. */
typedef struct lp_model {
    uint32_t responses, vignettings;
    struct lp_model_response {
        uint32_t kind;         /* lensprof_response_kind */
        double gamma;          /* of GAMMA; else 1 */
        const double *table;   /* the samples of EMOR and TABLE */
        const uint8_t *packed; /* the same, f32 */
    } response[3];
    struct lp_model_response output[3]; /* of the output, if it has its own */
    uint32_t outputs;                   /* 1 or 3, or 0 */
    lensprof_vignetting vignetting[3];
    uint32_t columns, rows, channels; /* of the gain grid; 0 = none */
    lensprof_image_circle circle;
#if LP_HAS_LEVELS
    lensprof_levels levels[2]; /* of input and output; all 0 = none */
#endif
    const float *attenuation;
    const uint8_t *packed_attenuation;
} lp_model;

static inline double lp_model_sample(const struct lp_model_response *response, uint32_t j) {
    return response->table ? response->table[j] : (double)lp_f32_at(response->packed + 4 * j);
}

static inline float lp_model_node(const lp_model *m, uint32_t i) {
    return m->attenuation ? m->attenuation[i] : lp_f32_at(m->packed_attenuation + 4 * i);
}

/* ---- blobs ---- */

/* Positions of a blob's parts of variable length. */
typedef struct lp_blob {
    const uint8_t *bytes;       /* its first byte: the fixed part */
    const uint8_t *response[3]; /* kind, modes, 0, 0; then a gamma, or coefficients and samples */
    const uint8_t *covariance;  /* upper triangle, row by row, f64 */
    const uint8_t *text;        /* maker, model, lens, method, software, without gaps */
    lp_model *model;            /* what a plan needs of it, of whoever opens it */
} lp_blob;

/* CRC-32 of IEEE 802.3: reflected, polynomial 0xEDB88320. */
uint32_t lp_crc32(const uint8_t *bytes, size_t count);

/* Finds the parts and checks everything in them, as lensprof_profile_unpack states; fills both structs. */
lensprof_status lp_blob_open(const void *bytes, size_t count, lp_blob *blob, lp_model *model);

/* Key and provenance of an open blob; 0 if a text does not fit. */
int lp_blob_key(const lp_blob *blob, lensprof_profile_key *key);
int lp_blob_provenance(const lp_blob *blob, lensprof_provenance *provenance);

#endif
