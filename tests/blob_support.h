/* Profiles to pack, and blobs to damage. */
#ifndef LENSPROF_TESTS_BLOB_SUPPORT_H
#define LENSPROF_TESTS_BLOB_SUPPORT_H

#include "support.h"

#include <lensprof/apply.h>
#include <lensprof/profile.h>

/* CRC-32 computed bit by bit, as the standard defines it, independent of the library's. */
static inline uint32_t slow_crc32(const uint8_t *bytes, size_t count) {
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
    }
    return ~crc;
}

static inline void put_number(uint8_t *at, uint64_t value, size_t bytes) {
    for (size_t i = 0; i < bytes; i++) at[i] = (uint8_t)(value >> 8 * i);
}

static inline void put_double(uint8_t *at, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_number(at, bits, 8);
}

static inline void put_float(uint8_t *at, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_number(at, bits, 4);
}

/* Updates length and CRC after a change. */
static inline void seal(uint8_t *blob, size_t bytes) {
    put_number(blob + 8, bytes, 4);
    put_number(blob + bytes - 4, slow_crc32(blob, bytes - 4), 4);
}

/* A blob in an allocation of its exact size, so that a sanitizer detects every access beyond it. */
static inline uint8_t *pack(const lensprof_profile *profile, uint32_t flags, size_t *bytes) {
    *bytes = 0;
    assert_ok(lensprof_profile_pack(profile, flags, NULL, 0, bytes));
    const size_t asked = *bytes;
    uint8_t *blob = malloc(asked);
    assert_ok(lensprof_profile_pack(profile, flags, blob, asked, bytes));
    assert_int_equal(*bytes, asked);
    return blob;
}

static inline void random_response(lensprof_response *r, uint64_t *random) {
    const uint32_t kind = (uint32_t)(4 * lp_random(random));
    if (kind == LENSPROF_RESPONSE_LINEAR) lensprof_response_set_linear(r);
    if (kind == LENSPROF_RESPONSE_GAMMA) assert_ok(lensprof_response_set_gamma(r, 0.2 + 4.0 * lp_random(random)));
    if (kind == LENSPROF_RESPONSE_EMOR) {
        double c[LENSPROF_EMOR_MODES];
        const uint32_t modes = (uint32_t)(26 * lp_random(random));
        double size = 0.5;
        do { /* until the response rises */
            for (uint32_t l = 0; l < modes; l++) c[l] = size * lp_normal(random) / (1 + l);
            size *= 0.7;
        } while (lensprof_response_set_emor(r, c, modes) != LENSPROF_OK);
    }
    if (kind == LENSPROF_RESPONSE_TABLE) {
        const uint32_t count = 2 + (uint32_t)(3000 * lp_random(random));
        double *values = calloc(count, sizeof *values);
        for (uint32_t i = 1; i < count; i++) /* with flat parts */
            values[i] = values[i - 1] + (lp_random(random) < 0.3 && i + 1 < count ? 0.0 : lp_random(random) + 1e-3);
        for (uint32_t i = 0; i < count; i++) values[i] /= values[count - 1];
        values[count - 1] = 1.0;
        assert_ok(lensprof_response_set_table(r, values, count));
        free(values);
    }
}

static inline void random_text(char *text, size_t capacity, uint64_t *random) {
    const size_t length = (size_t)((double)capacity * lp_random(random)); /* sometimes as long as allowed */
    for (size_t i = 0; i < length; i++) text[i] = (char)(0x20 + (int)(94.0 * lp_random(random)));
    if (length > 1) text[0] = '\xc3', text[1] = '\xa4'; /* not ASCII */
}

static inline void random_key(lensprof_profile *p, uint64_t *random) {
    random_text(p->key.camera_maker, sizeof p->key.camera_maker, random);
    random_text(p->key.camera_model, sizeof p->key.camera_model, random);
    random_text(p->key.lens, sizeof p->key.lens, random);
    random_text(p->provenance.method, sizeof p->provenance.method, random);
    random_text(p->provenance.software, sizeof p->provenance.software, random);
    if (lp_random(random) < 0.7) p->key.focal_mm = 10.0 + 300.0 * lp_random(random);
    if (lp_random(random) < 0.7) p->key.aperture = 1.0 + 20.0 * lp_random(random);
    if (lp_random(random) < 0.7) p->key.distance_m = lp_random(random) < 0.3 ? INFINITY : 0.1 + lp_random(random);
    p->key.processing = (uint32_t)(3 * lp_random(random));
    p->provenance.created_unix_s = (int64_t)(1e10 * (lp_random(random) - 0.3));
    p->provenance.images = (uint32_t)(4294967295.0 * lp_random(random));
    p->provenance.pairs = (uint32_t)(1e6 * lp_random(random));
    if (lp_random(random) < 0.7) p->provenance.heldout_rms = 255.0 * lp_random(random);
    if (lp_random(random) < 0.7) p->provenance.inlier_share = lp_random(random);
}

static inline void random_grid(lensprof_gain_grid *grid, uint64_t *random) {
    grid->columns = 2 + (uint32_t)(31 * lp_random(random)), grid->rows = 2 + (uint32_t)(31 * lp_random(random));
    grid->channels = lp_random(random) < 0.5 ? 1 : 3;
    for (uint32_t i = 0; i < grid->channels * grid->rows * grid->columns; i++)
        grid->attenuation[i] = (float)(0.6 + 0.8 * lp_random(random));
}

/* Every member of a profile except `source`, which is not packed. */
static inline void random_profile(lensprof_profile *p, uint64_t *random) {
    lensprof_profile_init(p);
    random_key(p, random);
    p->responses = lp_random(random) < 0.5 ? 1 : 3;
    p->vignettings = lp_random(random) < 0.5 ? 1 : 3;
    for (uint32_t c = 0; c < p->responses; c++) random_response(&p->response[c], random);
    const double x = 0.1 * lp_normal(random), y = 0.1 * lp_normal(random);
    for (uint32_t c = 0; c < p->vignettings; c++)
        p->vignetting[c] = (lensprof_vignetting){
            {-0.3 * lp_random(random), 0.1 * lp_random(random), -0.1 * lp_random(random)}, {x, y}};
    if (lp_random(random) < 0.5) random_grid(&p->grid, random);
    const uint32_t n = p->covariance_size = (uint32_t)(37 * lp_random(random));
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = i; j < n; j++)
            p->covariance[i * n + j] = p->covariance[j * n + i] = i == j ? lp_random(random) : lp_normal(random);
    assert_ok(lensprof_profile_validate(p));
}

#endif
