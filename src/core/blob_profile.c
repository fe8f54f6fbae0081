/* Profiles to blobs and back (docs/blob.md). */
#include "core/blob.h"
#include "core/levels.h"
#include "core/profile.h"

/* ---- writing ---- */

static void put(uint8_t **to, uint64_t value, uint32_t bytes) {
    for (uint32_t i = 0; i < bytes; i++) *(*to)++ = (uint8_t)(value >> 8 * i);
}

static void put_f32(uint8_t **to, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(to, bits, 4);
}

static void put_f64(uint8_t **to, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(to, bits, 8);
}

static int has_samples(const lensprof_response *r) {
    return r->kind == LENSPROF_RESPONSE_EMOR || r->kind == LENSPROF_RESPONSE_TABLE;
}

static uint32_t modes_of(const lensprof_response *r) { return r->kind == LENSPROF_RESPONSE_EMOR ? r->modes : 0; }

static size_t length_of(const char *text, size_t capacity) {
    size_t length = 0;
    while (length < capacity && text[length]) length++;
    return length;
}

/* The five texts of a profile, in their order. */
typedef struct texts {
    const char *text[5];
    size_t length[5];
} texts;

static texts texts_of(const lensprof_profile *p) {
    texts t = {{p->key.camera_maker, p->key.camera_model, p->key.lens, p->provenance.method, p->provenance.software},
               {0}};
    static const uint8_t capacity[5] = {sizeof p->key.camera_maker, sizeof p->key.camera_model, sizeof p->key.lens,
                                        sizeof p->provenance.method, sizeof p->provenance.software};
    for (int i = 0; i < 5; i++) t.length[i] = length_of(t.text[i], capacity[i]);
    return t;
}

static int has_circle(const lensprof_profile *p) { return lp_profile_circle(p).radius > 0.0; }

static int has_levels(const lensprof_profile *p) {
    const lensprof_levels levels = lp_profile_levels(p);
    return lp_has_levels(&levels);
}

static size_t bytes_of(const lensprof_profile *p, uint32_t covariance) {
    const texts t = texts_of(p);
    size_t bytes = LP_BLOB_FIXED + p->vignettings * 3 * 8 + 4;
    if (has_circle(p)) bytes += 3 * 8;
    if (has_levels(p)) bytes += 4 * 8;
    for (uint32_t c = 0; c < p->responses; c++) {
        bytes += 4 + 8 * modes_of(&p->response[c]) + (p->response[c].kind == LENSPROF_RESPONSE_GAMMA ? 8 : 0);
        if (has_samples(&p->response[c])) bytes += 4 * LENSPROF_RESPONSE_SAMPLES;
    }
    bytes += 4 * (size_t)p->grid.channels * p->grid.rows * p->grid.columns;
    bytes += 8 * (size_t)covariance * (covariance + 1) / 2;
    for (int i = 0; i < 5; i++) bytes += t.length[i];
    return bytes;
}

static void put_fixed(uint8_t **to, const lensprof_profile *p, uint32_t covariance, size_t bytes) {
    const texts t = texts_of(p);
    put(to, 0x4652504C, 4); /* "LPRF" */
    put(to, 1u + (has_circle(p) ? LP_BLOB_CIRCLE : 0) + (has_levels(p) ? LP_BLOB_LEVELS : 0), 4);
    put(to, bytes, 4);
    put(to, p->key.processing, 1);
    put(to, p->responses, 1);
    put(to, p->vignettings, 1);
    put(to, p->grid.channels, 1);
    put(to, p->grid.columns, 1);
    put(to, p->grid.rows, 1);
    put(to, covariance, 2);
    for (int i = 0; i < 5; i++) put(to, t.length[i], 1);
    put(to, 0, 3);
    put_f64(to, p->key.focal_mm);
    put_f64(to, p->key.aperture);
    put_f64(to, p->key.distance_m);
    for (int d = 0; d < 2; d++) put_f64(to, p->vignetting[0].center[d]);
    put(to, (uint64_t)p->provenance.created_unix_s, 8);
    put(to, p->provenance.images, 4);
    put(to, p->provenance.pairs, 4);
    put_f64(to, p->provenance.heldout_rms);
    put_f64(to, p->provenance.inlier_share);
}

static void put_response(uint8_t **to, const lensprof_response *r) {
    put(to, r->kind, 1);
    put(to, modes_of(r), 3);
    if (r->kind == LENSPROF_RESPONSE_GAMMA) put_f64(to, r->gamma);
    for (uint32_t l = 0; l < modes_of(r); l++) put_f64(to, r->emor[l]);
    for (uint32_t j = 0; has_samples(r) && j < LENSPROF_RESPONSE_SAMPLES; j++) put_f32(to, (float)r->table[j]);
}

static void put_rest(uint8_t **to, const lensprof_profile *p, uint32_t covariance) {
    const texts t = texts_of(p);
    const uint32_t nodes = p->grid.channels * p->grid.rows * p->grid.columns;
    for (uint32_t c = 0; c < p->vignettings; c++)
        for (int n = 0; n < 3; n++) put_f64(to, p->vignetting[c].k[n]);
    const lensprof_image_circle circle = lp_profile_circle(p);
    for (int d = 0; d < 2 && has_circle(p); d++) put_f64(to, circle.center[d]);
    if (has_circle(p)) put_f64(to, circle.radius);
    const lensprof_levels levels = lp_profile_levels(p);
    for (int c = 0; c < 3 && has_levels(p); c++) put_f64(to, levels.black[c]);
    if (has_levels(p)) put_f64(to, levels.white);
    for (uint32_t c = 0; c < p->responses; c++) put_response(to, &p->response[c]);
    for (uint32_t i = 0; i < nodes; i++) put_f32(to, p->grid.attenuation[i]);
    for (uint32_t i = 0; i < covariance; i++)
        for (uint32_t j = i; j < covariance; j++) put_f64(to, p->covariance[i * covariance + j]);
    for (int i = 0; i < 5; i++)
        for (size_t n = 0; n < t.length[i]; n++) put(to, (uint8_t)t.text[i][n], 1);
}

lensprof_status lensprof_profile_pack(const lensprof_profile *profile, uint32_t flags, void *data, size_t capacity,
                                      size_t *count) {
    if (!profile || (!data && capacity) || flags & ~(uint32_t)LENSPROF_PACK_COVARIANCE) return LENSPROF_ERROR_ARGUMENT;
    const lensprof_status status = lensprof_profile_validate(profile);
    if (status != LENSPROF_OK) return status;
    const uint32_t covariance = flags & LENSPROF_PACK_COVARIANCE ? profile->covariance_size : 0;
    const size_t bytes = bytes_of(profile, covariance);
    if (count) *count = bytes;
    if (capacity < bytes) return capacity ? LENSPROF_ERROR_CAPACITY : LENSPROF_OK;
    uint8_t *to = data;
    put_fixed(&to, profile, covariance, bytes);
    put_rest(&to, profile, covariance);
    put(&to, lp_crc32(data, bytes - 4), 4);
    return LENSPROF_OK;
}

/* ---- reading ---- */

/* All numbers have been checked. */
static void copy_response(const lp_blob *blob, uint32_t c, lensprof_response *r) {
    const struct lp_model_response *from = &blob->model->response[c];
    lensprof_response_set_linear(r);
    if (from->kind == LENSPROF_RESPONSE_GAMMA && lensprof_response_set_gamma(r, from->gamma) == LENSPROF_OK) return;
    r->kind = from->kind;
    r->modes = blob->response[c][1];
    for (uint32_t l = 0; l < r->modes; l++) r->emor[l] = lp_f64_at(blob->response[c] + 4 + 8 * l);
    for (uint32_t j = 0; from->packed && j < LENSPROF_RESPONSE_SAMPLES; j++) r->table[j] = lp_model_sample(from, j);
}

static void copy_covariance(const lp_blob *blob, lensprof_profile *profile) {
    const uint32_t n = profile->covariance_size = blob->bytes[LP_BLOB_COVARIANCE];
    const uint8_t *entry = blob->covariance;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = i; j < n; j++, entry += 8)
            profile->covariance[i * n + j] = profile->covariance[j * n + i] = lp_f64_at(entry);
}

lensprof_status lensprof_profile_unpack(const void *data, size_t size, lensprof_profile *profile) {
    lp_blob b;
    lp_model model;
    if (!data || !profile) return LENSPROF_ERROR_ARGUMENT;
    if (lp_sized_wrong(profile, LP_FIRST_PROFILE, sizeof *profile)) return LENSPROF_ERROR_STRUCT_SIZE;
    const lensprof_status status = lp_blob_open(data, size, &b, &model);
    if (status != LENSPROF_OK) return status;
    const lp_model *m = &model;
#if LP_HAS_LEVELS
    if (lp_has_levels(&m->levels[0]) && profile->struct_size < LP_END_OF(lensprof_profile, levels))
        return LENSPROF_ERROR_UNSUPPORTED;
#endif
    if (m->circle.radius > 0.0 && profile->struct_size < LP_END_OF(lensprof_profile, image_circle))
        return LENSPROF_ERROR_UNSUPPORTED;
    lensprof_profile_init_sized(profile, profile->struct_size);
    if (!lp_blob_key(&b, &profile->key) || !lp_blob_provenance(&b, &profile->provenance))
        return LENSPROF_ERROR_INTERNAL; /* both were read before */
    profile->responses = m->responses;
    profile->vignettings = m->vignettings;
    for (uint32_t c = 0; c < m->responses; c++) copy_response(&b, c, &profile->response[c]);
    memcpy(profile->vignetting, m->vignetting, sizeof profile->vignetting);
    if (profile->struct_size >= LP_END_OF(lensprof_profile, image_circle)) profile->image_circle = m->circle;
#if LP_HAS_LEVELS
    if (profile->struct_size >= LP_END_OF(lensprof_profile, levels)) profile->levels = m->levels[0];
#endif
    profile->grid.columns = m->columns;
    profile->grid.rows = m->rows;
    profile->grid.channels = m->channels;
    for (uint32_t i = 0; i < m->channels * m->columns * m->rows; i++)
        profile->grid.attenuation[i] = lp_model_node(m, i);
    copy_covariance(&b, profile);
    return LENSPROF_OK;
}
