/* What is known of a picture's camera and lens, composed: the lens's falloff and the camera's response. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/covariance.h"
#include "store/lookup/lookup_falloff.h"
#include "store/lookup/lookup_response.h"
#include "store/lookup/nearest.h"

#define FIRST_OPTIONS LP_END_OF(lensprof_lookup_options, any_processing)
#define FIRST_LOOKUP LP_END_OF(lensprof_lookup, reason)

/* What a call works on. */
typedef struct work {
    lensprof_store *const *stores;
    uint32_t count;
    const lensprof_profile_key *key;
    lensprof_lookup_options options;
    lensprof_lookup lookup;
    lp_falloff_answer falloff;
    lp_response_answer response;
} work;

/* ---- the two parts ---- */

/* From the first store that has one; else the refusal of the first that knows the lens. */
static lensprof_status find_falloff(work *w, lensprof_error *error) {
    lensprof_lookup refused;
    lensprof_error refusal;
    bool is_known = false;
    for (uint32_t i = 0; i < w->count; i++) {
        lensprof_error camera_error;
        bool knows_lens = false;
        lp_store_clear(&camera_error);
        lensprof_lookup_init(&w->lookup);
        w->lookup.falloff_store = i;
        const lensprof_status status =
            lp_find_falloff(w->stores[i], w->key, &w->options, &w->falloff, &w->lookup, &knows_lens, &camera_error);
        if (status == LENSPROF_OK) return LENSPROF_OK;
        if (status != LENSPROF_ERROR_NOT_FOUND) {
            if (error) *error = camera_error;
            return status;
        }
        if (!i || (knows_lens && !is_known)) refused = w->lookup, refusal = camera_error, is_known = knows_lens;
    }
    w->lookup = refused;
    if (error) *error = refusal;
    return LENSPROF_ERROR_NOT_FOUND;
}

/* From the first store that has profiles of the camera; else the typical one. */
static lensprof_status find_response(work *w, lensprof_error *error) {
    lp_response_answer *r = &w->response;
    lp_typical_answer(&w->falloff.key, r);
    for (uint32_t i = 0; i < w->count && !r->rows; i++) {
        const lensprof_status status = lp_find_response(w->stores[i], &w->falloff.key, &w->options, r, error);
        if (status != LENSPROF_OK) return status;
        if (r->rows) w->lookup.response_store = i;
    }
    w->lookup.response_from = r->from;
    w->lookup.camera_kind = r->camera_kind;
    w->lookup.response_sigma = r->sigma;
    w->lookup.response_rows = r->rows;
    memcpy(w->lookup.response_id, r->id, sizeof r->id);
    memcpy(w->lookup.response_weight, r->weight, sizeof r->weight);
    if (r->has_other_style && !r->rows) lp_add_lookup_reason(&w->lookup, LENSPROF_REASON_LOOKUP_OTHER_STYLE, NULL);
    if (r->from == LENSPROF_RESPONSE_FROM_KIND)
        lp_add_lookup_reason(&w->lookup, LENSPROF_REASON_LOOKUP_TYPICAL_RESPONSE, NULL);
    return LENSPROF_OK;
}

/* ---- the answer ---- */

/* Of M in the corner: an error of ln gamma changes ln M by as much of itself. */
static void set_sigma(work *w) {
    lensprof_lookup *lookup = &w->lookup;
    double worst = 0.0;
    for (int c = 0; c < 3; c++) {
        const double *k = w->falloff.k[c], m = 1.0 + k[0] + k[1] + k[2];
        if (m > 0.0) worst = fmax(worst, fabs(m * log(m)));
    }
    const double parts[4] = {lookup->falloff_sigma, lookup->distance_sigma, lookup->sensor_sigma,
                             worst * lookup->response_sigma};
    double variance = 0.0;
    for (int i = 0; i < 4; i++) variance += parts[i] * parts[i];
    lookup->sigma = sqrt(variance);
}

/* Of the falloff alone: its profiles, distance and sensor. The response's error stands in its own block. */
static double sigma_of_falloff(const lensprof_lookup *lookup) {
    return sqrt(lookup->falloff_sigma * lookup->falloff_sigma + lookup->distance_sigma * lookup->distance_sigma
                + lookup->sensor_sigma * lookup->sensor_sigma);
}

/* The response's block and one for each curve of the falloff. Curves of the channels err together, but a covariance
 * that includes it would have no inverse: they are treated separately. */
static void set_covariance(const work *w, lensprof_profile *profile) {
    const uint32_t modes = lp_covariance_modes(profile->response, profile->responses);
    const uint32_t n = lp_covariance_index(modes, profile->vignettings);
    double block[9];
    profile->covariance_size = 0;
    memset(profile->covariance, 0, sizeof profile->covariance);
    if (n > LENSPROF_COVARIANCE_MAX) return;
    profile->covariance_size = n;
    for (uint32_t i = 0; i < modes && w->response.modes == modes; i++)
        memcpy(&profile->covariance[i * n], &w->response.covariance[i * modes], modes * sizeof(double));
    lp_falloff_covariance(sigma_of_falloff(&w->lookup), block);
    for (uint32_t c = 0; c < profile->vignettings; c++)
        for (uint32_t i = 0; i < 3; i++)
            memcpy(&profile->covariance[(modes + 3 * c + i) * n + modes + 3 * c], &block[3 * i], 3 * sizeof(double));
}

static void set_falloff(const work *w, lensprof_profile *profile) {
    const double(*k)[3] = w->falloff.k;
    profile->vignettings = memcmp(k[0], k[1], sizeof k[0]) || memcmp(k[0], k[2], sizeof k[0]) ? 3 : 1;
    for (uint32_t c = 0; c < 3; c++) {
        if (c >= profile->vignettings) {
            memset(&profile->vignetting[c], 0, sizeof profile->vignetting[c]);
            continue;
        }
        memcpy(profile->vignetting[c].k, k[c], sizeof k[c]);
        memcpy(profile->vignetting[c].center, profile->vignetting[0].center, sizeof profile->vignetting[0].center);
    }
    lensprof_gain_grid_init(&profile->grid);
}

/* Levels belong to the sensor: those of another camera do not apply. */
static void set_levels(const work *w, lensprof_profile *profile) {
    for (int i = 0; i < LENSPROF_LOOKUP_REASONS; i++)
        if (w->lookup.reason_code[i] == LENSPROF_REASON_LOOKUP_ON_OTHER_CAMERA)
            memset(&profile->levels, 0, sizeof profile->levels);
}

/* Centre and image circle are those of the nearest profile, in half diagonals of the picture's sensor; no circle if it
 * covers that. */
static void set_places(const work *w, double profile_crop_factor, lensprof_profile *profile) {
    const double crop_factor = w->falloff.key.crop_factor;
    const int is_known = profile_crop_factor != LENSPROF_UNKNOWN && crop_factor != LENSPROF_UNKNOWN;
    const double scale = is_known ? crop_factor / profile_crop_factor : 1.0;
    lensprof_image_circle *circle = &profile->image_circle;
    for (int d = 0; d < 2; d++) {
        for (uint32_t c = 0; c < 3; c++) {
            double *center = &profile->vignetting[c].center[d];
            *center = fmin(fmax(*center * scale, -1.0), 1.0);
        }
        circle->center[d] *= scale;
    }
    circle->radius *= scale;
    if (circle->radius - hypot(circle->center[0], circle->center[1]) >= 1.0
        || lensprof_image_circle_validate(circle) != LENSPROF_OK)
        memset(circle, 0, sizeof *circle);
}

static void set_response(const work *w, lensprof_profile *profile) {
    lensprof_response linear;
    if (w->response.responses < 3) lensprof_response_set_linear(&linear);
    profile->responses = w->response.responses;
    for (uint32_t c = 0; c < profile->responses; c++) profile->response[c] = w->response.response[c];
    for (uint32_t c = profile->responses; c < 3; c++) profile->response[c] = linear;
}

static void set_provenance(const work *w, lensprof_profile *profile) {
    lensprof_provenance *p = &profile->provenance;
    snprintf(p->method, sizeof p->method, "lookup");
    p->images = p->pairs = p->forced = 0;
    p->prior_id = 0;
    p->heldout_rms = p->inlier_share = LENSPROF_UNKNOWN;
    p->gamma_sigma = w->response.sigma;
}

/* In the scratch of the store that the falloff is from, of the nearest of its profiles. */
static lensprof_status compose(work *w, lensprof_error *error) {
    lensprof_store *store = w->stores[w->lookup.falloff_store];
    lensprof_profile *profile = &store->scratch;
    lensprof_status status = find_response(w, error);
    if (status == LENSPROF_OK) status = lp_store_fetch_falloff(store, w->lookup.id[0], error);
    if (status != LENSPROF_OK) return status;
    set_sigma(w);
    const double profile_crop_factor = profile->key.crop_factor;
    profile->key = w->falloff.key;
    set_response(w, profile);
    set_levels(w, profile);
    set_falloff(w, profile);
    set_places(w, profile_crop_factor, profile);
    set_covariance(w, profile);
    set_provenance(w, profile);
    if (lensprof_profile_validate(profile) != LENSPROF_OK)
        return lp_refuse(store, &w->lookup, LENSPROF_REASON_LOOKUP_CONTRADICTION, error);
    return LENSPROF_OK;
}

/* The camera's response if no falloff was found, as `error` and the reason in *lookup state. */
static lensprof_status answer_response(work *w, lensprof_error *error) {
    lensprof_error response_error;
    w->falloff.key = *w->key;
    lensprof_status status = find_response(w, &response_error);
    if (status != LENSPROF_OK && error) *error = response_error;
    if (status != LENSPROF_OK) return status;
    if (!w->response.rows) return LENSPROF_ERROR_NOT_FOUND;
    w->lookup.falloff_store = w->lookup.response_store;
    lensprof_profile *profile = &w->stores[w->lookup.response_store]->scratch;
    lensprof_profile_init(profile);
    profile->key = *w->key;
    set_response(w, profile);
    set_provenance(w, profile);
    const uint32_t modes = lp_covariance_modes(profile->response, profile->responses);
    if (w->response.modes != modes) return LENSPROF_OK;
    profile->covariance_size = modes;
    memcpy(profile->covariance, w->response.covariance, modes * modes * sizeof(double));
    return LENSPROF_OK;
}

static lensprof_status answer_exact(work *w, lensprof_error *error) {
    lensprof_store *store = w->stores[w->lookup.falloff_store];
    const lensprof_profile *profile = &store->scratch;
    const lensprof_status status = lp_store_fetch(store, w->lookup.id[0], error);
    if (status != LENSPROF_OK) return status;
    const double variance =
        lp_corner_variance(profile->covariance, profile->covariance_size,
                           lp_covariance_modes(profile->response, profile->responses), profile->vignettings);
    w->lookup.sigma = w->lookup.falloff_sigma = variance >= 0.0 ? sqrt(variance) : LENSPROF_UNKNOWN;
    w->lookup.response_from = LENSPROF_RESPONSE_FROM_PROFILE;
    w->lookup.camera_kind = lensprof_camera_kind_of(&w->falloff.key);
    w->lookup.response_sigma = lp_stated_gamma_sigma(profile);
    w->lookup.response_store = w->lookup.falloff_store;
    w->lookup.response_rows = 1;
    w->lookup.response_id[0] = w->lookup.id[0];
    w->lookup.response_weight[0] = 1.0;
    return LENSPROF_OK;
}

/* For a lens whose name no store has. */
static lensprof_status add_nearest(work *w, lensprof_error *error) {
    lp_nearest nearest = {0};
    lensprof_error own;
    lensprof_status status = LENSPROF_OK;
    if (w->lookup.reason_code[0] != LENSPROF_REASON_LOOKUP_NO_LENS) return LENSPROF_OK;
    for (uint32_t i = 0; i < w->count && status == LENSPROF_OK; i++)
        status = lp_add_nearest(w->stores[i], w->key, &nearest, &own);
    if (status != LENSPROF_OK && error) *error = own;
    memcpy(w->lookup.nearest, nearest.lens, sizeof nearest.lens);
    return status;
}

/* One transaction a store, so that an answer is of one state of each. */
static lensprof_status look_up(work *w, lensprof_error *error) {
    lensprof_status status = LENSPROF_OK;
    uint32_t begun = 0;
    while (begun < w->count && status == LENSPROF_OK) {
        status = lp_store_begin(w->stores[begun], false, error);
        if (status == LENSPROF_OK) begun++;
    }
    if (status == LENSPROF_OK) status = find_falloff(w, error);
    if (status == LENSPROF_ERROR_NOT_FOUND) {
        const lensprof_status added = add_nearest(w, error);
        if (added != LENSPROF_OK) status = added;
    }
    if (status == LENSPROF_OK)
        status = w->lookup.exact ? answer_exact(w, error) : compose(w, error);
    else if (status == LENSPROF_ERROR_NOT_FOUND && w->options.response_alone)
        status = answer_response(w, error);
    while (begun > 0) lp_store_rollback(w->stores[--begun]);
    return status;
}

/* The caller's options as this library's, and whether the rest of the call can be answered. */
static lensprof_status check_lookup(const lensprof_profile_key *key, const lensprof_lookup_options *given,
                                    lensprof_lookup_options *options, const lensprof_profile *profile,
                                    const lensprof_lookup *lookup, lensprof_error *error) {
    lensprof_lookup_options_init(options);
    const char *wrong = given ? lp_sized_take(options, given, FIRST_OPTIONS) : NULL;
    if (wrong) return lp_store_fail_size("lensprof_lookup_options", wrong, error);
    wrong = lookup ? lp_sized_wrong(lookup, FIRST_LOOKUP, sizeof *lookup) : NULL;
    if (wrong) return lp_store_fail_size("lensprof_lookup", wrong, error);
    const lensprof_status status = lp_store_check_size(profile, error);
    if (status != LENSPROF_OK) return status;
    if (options->distance_rule > LENSPROF_DISTANCE_FARTHEST || options->with_doubt > 1 || options->any_processing > 1
        || options->force_falloff > 1 || options->response_alone > 1)
        return lp_store_fail_argument("an option is unknown; see lensprof_lookup_options", error);
    if (lensprof_profile_key_validate(key) != LENSPROF_OK)
        return lp_store_fail_argument("the key is invalid; see lensprof_profile_key", error);
    return LENSPROF_OK;
}

static bool has_null(lensprof_store *const *stores, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        if (!stores[i]) return true;
    return false;
}

lensprof_status lensprof_store_lookup_in(lensprof_store *const *stores, uint32_t count, const lensprof_profile_key *key,
                                         const lensprof_lookup_options *given, lensprof_profile *profile,
                                         lensprof_lookup *lookup, lensprof_error *error) {
    lensprof_lookup_options options;
    lp_store_clear(error);
    if (!stores || !count || has_null(stores, count) || !key || !profile)
        return lp_store_fail_argument("no store, or store, key or profile is NULL", error);
    lensprof_status status = check_lookup(key, given, &options, profile, lookup, error);
    if (status != LENSPROF_OK) return status;
    work *w = calloc(1, sizeof *w);
    if (!w) return lp_store_fail_sql(stores[0]->path, NULL, SQLITE_NOMEM, error);
    w->stores = stores, w->count = count, w->key = key, w->options = options;
    status = look_up(w, error);
    if (status == LENSPROF_OK) lp_sized_copy(profile, &stores[w->lookup.falloff_store]->scratch);
    if (lookup && (status == LENSPROF_OK || status == LENSPROF_ERROR_NOT_FOUND)) lp_sized_copy(lookup, &w->lookup);
    free(w);
    return status;
}
