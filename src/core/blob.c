/* Reads profile blobs (docs/blob.md) in place: nothing is trusted, and nothing is stored except the view. */
#include "core/blob.h"

#include <math.h>

#include "core/features.h"
#include "core/gain_grid.h"
#include "core/levels.h"
#include "core/profile.h"
#include "core/response.h"

#define CRC_BYTES 4
#define LAST_LAYOUT (1 + (LP_HAS_CIRCLE ? LP_BLOB_CIRCLE : 0) + (LP_HAS_LEVELS ? LP_BLOB_LEVELS : 0))
#define FRAME_BYTES (LP_BLOB_BYTES + 4 + CRC_BYTES) /* common to all layouts: magic, layout, length, CRC */

uint32_t lp_crc32(const uint8_t *bytes, size_t count) {
    static const uint32_t of_nibble[16] = {/* remainders: one step per half byte, 64 bytes of table */
                                           0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4,
                                           0x4DB26158, 0x5005713C, 0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C,
                                           0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C};
    uint32_t crc = 0xFFFFFFFF;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        crc = crc >> 4 ^ of_nibble[crc & 15];
        crc = crc >> 4 ^ of_nibble[crc & 15];
    }
    return ~crc;
}

/* The rest of the input. */
typedef struct reader {
    const uint8_t *position;
    size_t left;
} reader;

/* The next `count` bytes; NULL if fewer remain. */
static const uint8_t *take(reader *r, size_t count) {
    if (count > r->left) return NULL;
    const uint8_t *bytes = r->position;
    r->position += count;
    r->left -= count;
    return bytes;
}

/* ---- parts ---- */

#if LP_HAS_CIRCLE || LP_HAS_LEVELS
static int has_part(const lp_blob *blob, enum lp_blob_part part) {
    return ((lp_u32_at(blob->bytes + LP_BLOB_VERSION) - 1) & (uint32_t)part) != 0;
}
#endif

#if LP_HAS_CIRCLE
static int open_circle(lp_blob *blob, reader *r) {
    lensprof_image_circle *circle = &blob->model->circle;
    if (!has_part(blob, LP_BLOB_CIRCLE)) return 1;
    const uint8_t *numbers = take(r, 3 * 8);
    if (!numbers) return 0;
    for (int d = 0; d < 2; d++) circle->center[d] = lp_f64_at(numbers + 8 * d);
    circle->radius = lp_f64_at(numbers + 16);
    return circle->radius != 0.0 && lensprof_image_circle_validate(circle) == LENSPROF_OK;
}
#else
static int open_circle(lp_blob *blob, reader *r) { return (void)blob, (void)r, 1; }
#endif

#if LP_HAS_LEVELS
static int open_levels(lp_blob *blob, reader *r) {
    lensprof_levels *levels = &blob->model->levels[0];
    if (!has_part(blob, LP_BLOB_LEVELS)) return 1;
    const uint8_t *numbers = take(r, 4 * 8);
    if (!numbers) return 0;
    for (int c = 0; c < 3; c++) levels->black[c] = lp_f64_at(numbers + 8 * c);
    levels->white = lp_f64_at(numbers + 24);
    blob->model->levels[1] = *levels; /* black is put back */
    return lp_has_levels(levels) && lensprof_levels_validate(levels) == LENSPROF_OK;
}
#else
static int open_levels(lp_blob *blob, reader *r) { return (void)blob, (void)r, 1; }
#endif

static int open_falloff(lp_blob *blob, reader *r) {
    lp_model *m = blob->model;
    m->vignettings = blob->bytes[LP_BLOB_VIGNETTINGS];
    if (m->vignettings != 1 && m->vignettings != 3) return 0;
    for (uint32_t c = 0; c < m->vignettings; c++) {
        const uint8_t *k = take(r, 3 * 8), *center = blob->bytes + LP_BLOB_CENTER;
        if (!k) return 0;
        for (int n = 0; n < 3; n++) m->vignetting[c].k[n] = lp_f64_at(k + 8 * n);
        for (int d = 0; d < 2; d++) m->vignetting[c].center[d] = lp_f64_at(center + 8 * d);
        if (lensprof_vignetting_validate(&m->vignetting[c]) != LENSPROF_OK) return 0;
    }
    return 1;
}

/* Rises from 0 to 1 without falling anywhere. */
static int is_curve(const struct lp_model_response *response) {
    double last = 0.0;
    for (uint32_t j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        const double value = lp_model_sample(response, j);
        if (!(value >= last) || (j == 0 && value != 0.0)) return 0; /* also for NaN */
        last = value;
    }
    return last == 1.0;
}

static int open_response(lp_blob *blob, uint32_t c, reader *r) {
    struct lp_model_response *response = &blob->model->response[c];
    const uint8_t *head = take(r, 4);
    if (!head || head[2] || head[3]) return 0;
    const uint32_t kind = head[0], modes = head[1];
    blob->response[c] = head;
    response->kind = kind;
    response->gamma = 1.0;
    if (kind > LENSPROF_RESPONSE_TABLE || modes > (kind == LENSPROF_RESPONSE_EMOR ? LENSPROF_EMOR_MODES : 0)) return 0;
    if (kind == LENSPROF_RESPONSE_LINEAR) return 1;
    if (kind == LENSPROF_RESPONSE_GAMMA) {
        const uint8_t *gamma = take(r, 8);
        return gamma && lp_is_gamma(response->gamma = lp_f64_at(gamma));
    }
    const uint8_t *coefficients = take(r, 8 * modes);
    response->packed = take(r, 4 * LENSPROF_RESPONSE_SAMPLES);
    if (!coefficients || !response->packed) return 0;
    for (uint32_t l = 0; l < modes; l++)
        if (!isfinite(lp_f64_at(coefficients + 8 * l))) return 0;
    return is_curve(response);
}

static int open_responses(lp_blob *blob, reader *r) {
    const uint32_t responses = blob->bytes[LP_BLOB_RESPONSES];
    if (responses != 1 && responses != 3) return 0;
    blob->model->responses = responses;
    for (uint32_t c = 0; c < responses; c++)
        if (!open_response(blob, c, r)) return 0;
    return 1;
}

static int open_grid(lp_blob *blob, reader *r) {
    lp_model *m = blob->model;
    const uint8_t *grid = blob->bytes + LP_BLOB_GRID;
    m->channels = grid[0], m->columns = grid[1], m->rows = grid[2];
    if (!m->channels && !m->columns && !m->rows) return 1;
    if ((m->channels != 1 && m->channels != 3) || !lp_is_grid_side(m->columns) || !lp_is_grid_side(m->rows)) return 0;
    const uint32_t nodes = m->channels * m->columns * m->rows;
    m->packed_attenuation = take(r, 4 * nodes);
    if (!m->packed_attenuation) return 0;
    for (uint32_t i = 0; i < nodes; i++)
        if (!lp_is_attenuation(lp_model_node(m, i))) return 0;
    return 1;
}

static int open_covariance(lp_blob *blob, reader *r) {
    const uint32_t n = blob->bytes[LP_BLOB_COVARIANCE];
    if (n > LENSPROF_COVARIANCE_MAX) return 0;
    const uint8_t *entry = blob->covariance = take(r, 8 * n * (n + 1) / 2);
    if (!entry) return 0;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = i; j < n; j++, entry += 8)
            if (!isfinite(lp_f64_at(entry)) || (i == j && !(lp_f64_at(entry) >= 0.0))) return 0;
    return 1;
}

/* ---- texts ---- */

/* Text number `index` of the five. The validate functions check its contents; this one only checks that it contains
 * no 0. */
static int copy_text(const lp_blob *blob, uint32_t index, char *text, size_t capacity) {
    const uint8_t *lengths = blob->bytes + LP_BLOB_TEXTS, *from = blob->text;
    const uint32_t length = lengths[index];
    if (length >= capacity) return 0;
    for (uint32_t i = 0; i < index; i++) from += lengths[i];
    memset(text, 0, capacity);
    for (uint32_t i = 0; i < length; i++) {
        if (!from[i]) return 0;
        text[i] = (char)from[i];
    }
    return 1;
}

int lp_blob_key(const lp_blob *blob, lensprof_profile_key *key) {
    const uint8_t *b = blob->bytes;
    lensprof_profile_key_init(key);
    key->focal_mm = lp_f64_at(b + LP_BLOB_KEY);
    key->aperture = lp_f64_at(b + LP_BLOB_KEY + 8);
    key->distance_m = lp_f64_at(b + LP_BLOB_KEY + 16);
    key->processing = b[LP_BLOB_PROCESSING];
    return copy_text(blob, 0, key->camera_maker, sizeof key->camera_maker)
           && copy_text(blob, 1, key->camera_model, sizeof key->camera_model)
           && copy_text(blob, 2, key->lens, sizeof key->lens);
}

int lp_blob_provenance(const lp_blob *blob, lensprof_provenance *provenance) {
    const uint8_t *b = blob->bytes;
    memset(provenance, 0, sizeof *provenance);
    provenance->created_unix_s = (int64_t)lp_u64_at(b + LP_BLOB_CREATED);
    provenance->images = lp_u32_at(b + LP_BLOB_COUNTS);
    provenance->pairs = lp_u32_at(b + LP_BLOB_COUNTS + 4);
    provenance->heldout_rms = lp_f64_at(b + LP_BLOB_QUALITY);
    provenance->inlier_share = lp_f64_at(b + LP_BLOB_QUALITY + 8);
    return copy_text(blob, 3, provenance->method, sizeof provenance->method)
           && copy_text(blob, 4, provenance->software, sizeof provenance->software);
}

static int open_texts(lp_blob *blob, reader *r) {
    const uint8_t *lengths = blob->bytes + LP_BLOB_TEXTS;
    blob->text = take(r, (size_t)lengths[0] + lengths[1] + lengths[2] + lengths[3] + lengths[4]);
    return blob->text != NULL;
}

/* Checks key and provenance in place. A copy of either, with its room for future members, is too large for the stack
 * of a small processor. */
static int is_key_and_provenance(const lp_blob *blob) {
    static const uint8_t capacity[5] = {
        sizeof((lensprof_profile_key *)0)->camera_maker, sizeof((lensprof_profile_key *)0)->camera_model,
        sizeof((lensprof_profile_key *)0)->lens, sizeof((lensprof_provenance *)0)->method,
        sizeof((lensprof_provenance *)0)->software};
    const uint8_t *b = blob->bytes, *lengths = b + LP_BLOB_TEXTS, *text = blob->text;
    for (uint32_t i = 0; i < 5; text += lengths[i], i++) {
        if (lengths[i] >= capacity[i]) return 0;
        for (uint32_t n = 0; n < lengths[i]; n++)
            if (lp_is_control(text[n])) return 0;
    }
    return b[LP_BLOB_PROCESSING] <= LENSPROF_PROCESSING_CORRECTED
           && lp_is_setting(lp_f64_at(b + LP_BLOB_KEY), lp_f64_at(b + LP_BLOB_KEY + 8), lp_f64_at(b + LP_BLOB_KEY + 16))
           && lp_is_quality(lp_f64_at(b + LP_BLOB_QUALITY), lp_f64_at(b + LP_BLOB_QUALITY + 8));
}

/* ---- the whole ---- */

/* The frame, which all layouts share, distinguishes damaged files from newer ones. */
static lensprof_status check_frame(const uint8_t *b, size_t count) {
    if (count < FRAME_BYTES || b[0] != 'L' || b[1] != 'P' || b[2] != 'R' || b[3] != 'F') return LENSPROF_ERROR_CORRUPT;
    if (lp_u32_at(b + LP_BLOB_BYTES) != count) return LENSPROF_ERROR_CORRUPT;
    if (lp_crc32(b, count - CRC_BYTES) != lp_u32_at(b + count - CRC_BYTES)) return LENSPROF_ERROR_CORRUPT;
    const uint32_t layout = lp_u32_at(b + LP_BLOB_VERSION); /* including the reserved bytes, which are 0 */
    if ((layout & 0xFFFF) > LAST_LAYOUT) return LENSPROF_ERROR_LAYOUT;
#if LP_HAS_LEVELS && !LP_HAS_CIRCLE
    if (layout && (layout - 1) & LP_BLOB_CIRCLE) return LENSPROF_ERROR_LAYOUT;
#endif
    return layout - 1 < LAST_LAYOUT ? LENSPROF_OK : LENSPROF_ERROR_CORRUPT;
}

static int is_zero(const uint8_t *bytes, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        if (bytes[i]) return 0;
    return 1;
}

lensprof_status lp_blob_open(const void *bytes, size_t count, lp_blob *blob, lp_model *model) {
    const uint8_t *b = bytes;
    const lensprof_status status = check_frame(b, count);
    if (status != LENSPROF_OK) return status;
    if (count < LP_BLOB_FIXED + CRC_BYTES) return LENSPROF_ERROR_CORRUPT;
    memset(model, 0, sizeof *model);
    blob->bytes = b;
    blob->model = model;
    reader r = {b + LP_BLOB_FIXED, count - LP_BLOB_FIXED - CRC_BYTES};
    const int is_blob = is_zero(b + LP_BLOB_COVARIANCE + 1, 1) && is_zero(b + LP_BLOB_TEXTS + 5, 3)
                        && open_falloff(blob, &r) && open_circle(blob, &r) && open_levels(blob, &r)
                        && open_responses(blob, &r) && open_grid(blob, &r) && open_covariance(blob, &r)
                        && open_texts(blob, &r) && r.left == 0 && is_key_and_provenance(blob);
    return is_blob ? LENSPROF_OK : LENSPROF_ERROR_CORRUPT;
}
