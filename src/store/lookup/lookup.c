/* The profile for a setting that need not be stored: what is made of the rows of the lens that count. */
#include "store/lookup/lookup_choice.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/covariance.h"

#define MOST_DISTANCES 8 /* stored focus distances that are tried where it is not known */

#define FIRST_OPTIONS LP_END_OF(lensprof_lookup_options, any_processing)
#define FIRST_LOOKUP LP_END_OF(lensprof_lookup, reason)

void lensprof_lookup_options_init_sized(lensprof_lookup_options *options, size_t size) {
    (void)lp_sized_begin(options, size, FIRST_OPTIONS); /* every default is 0 */
}

void lensprof_lookup_init_sized(lensprof_lookup *lookup, size_t size) {
    (void)lp_sized_begin(lookup, size, FIRST_LOOKUP);
}

_Static_assert(LP_NEIGHBOURS == LENSPROF_LOOKUP_ROWS, "a lookup names all that a prediction uses");

/* k in half diagonals of the key's sensor: r there is r times the ratio here. */
static void rescale(lp_candidate *c, const lensprof_profile_key *key) {
    if (c->crop == LENSPROF_UNKNOWN || key->crop_factor == LENSPROF_UNKNOWN) return;
    const double ratio2 = (c->crop / key->crop_factor) * (c->crop / key->crop_factor);
    for (int curve = 0; curve < 3; curve++) {
        double scale = 1.0;
        for (int n = 0; n < 3; n++) c->node.k[curve][n] *= scale *= ratio2;
    }
}

static int is_same_setting(const lp_falloff_node *a, const lp_falloff_node *b) {
    return lp_is_same(a->focal_mm, b->focal_mm) && lp_is_same(a->aperture, b->aperture)
           && lp_is_same(a->distance_m, b->distance_m);
}

/* Of profiles of one setting the newest counts, as everywhere: it may hold the others, or have overruled them. They
 * come by rising id. */
static uint32_t keep_newest(lp_falloff_node *nodes, uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = i + 1;
        while (j < count && !is_same_setting(&nodes[i], &nodes[j])) j++;
        if (j == count) nodes[kept++] = nodes[i];
    }
    return kept;
}

/* ---- predictions ---- */

/* The weakest, radius by radius, of the falloffs at all distances that are stored; or that at the farthest. */
static int predict_any_distance(const lp_falloff_node *nodes, uint32_t count, lp_falloff_node at, uint32_t rule,
                                lp_falloff_prediction *best) {
    double distances[MOST_DISTANCES], weakest[3][LP_FALLOFF_RADII], own[LP_FALLOFF_RADII], corner = -INFINITY;
    uint32_t known = 0;
    int found = 0;
    double sigma = 0.0;
    for (double below = INFINITY; known < MOST_DISTANCES; known++) { /* from far to near */
        double next = 0.0;
        for (uint32_t i = 0; i < count; i++)
            if ((known == 0 || nodes[i].distance_m < below) && nodes[i].distance_m > next) next = nodes[i].distance_m;
        if (next <= 0.0) break;
        distances[known] = below = next;
        if (rule == LENSPROF_DISTANCE_FARTHEST) {
            known++;
            break;
        }
    }
    for (uint32_t d = 0; d < known; d++) {
        lp_falloff_prediction one;
        at.distance_m = distances[d];
        const int done = lp_predict_falloff(nodes, count, &at, &one);
        if (done < 0) return done;
        if (!done) {
            if (!found) *best = one;
            continue;
        }
        sigma = fmax(sigma, one.sigma);
        for (int c = 0; c < 3; c++) {
            lp_sample_falloff(one.k[c], own);
            for (int j = 0; j < LP_FALLOFF_RADII; j++) weakest[c][j] = found ? fmax(weakest[c][j], own[j]) : own[j];
        }
        if (one.k[1][0] + one.k[1][1] + one.k[1][2] > corner) {
            corner = one.k[1][0] + one.k[1][1] + one.k[1][2];
            *best = one;
        }
        found++;
    }
    for (int c = 0; c < 3 && found > 1; c++) lp_fit_falloff(weakest[c], best->k[c]);
    best->sigma = sigma;
    return found > 0;
}

/* Nothing is found: that alone is the reason. */
static lensprof_status refuse(lensprof_store *store, lensprof_lookup *lookup, lensprof_reason reason,
                              lensprof_error *error) {
    const char *text = lensprof_reason_text(reason);
    memset(lookup->reason_code, 0, sizeof lookup->reason_code);
    lookup->reason_code[0] = reason;
    snprintf(lookup->reason, sizeof lookup->reason, "%s", text);
    return lp_store_fail(store->path, LENSPROF_ERROR_NOT_FOUND, "has no profile for this setting", text, error);
}

/* Variance of M in the corner, 0 = not known, without the rest of the profile, which takes longer to
 * read. */
static lensprof_status read_variance(lensprof_store *store, int64_t id, double *variance, lensprof_error *error) {
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX];
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(
        store,
        "SELECT covariance_size, covariance, vignetting_curves, CAST(total(emor_modes) AS INTEGER) AS emor_modes FROM"
        " profiles"
        " JOIN responses ON profile_id = id WHERE id = ?1",
        &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_integer(&binder, id);
    const int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    if (rc == SQLITE_ROW) {
        lp_store_reader reader = {binder.statement, 0, NULL};
        const uint32_t size = (uint32_t)lp_read_integer(&reader, 1, LENSPROF_COVARIANCE_MAX);
        lp_read_doubles(&reader, covariance, size * size);
        const uint32_t curves = (uint32_t)lp_read_integer(&reader, 1, 3);
        const uint32_t modes = (uint32_t)lp_read_integer(&reader, 0, 3 * LENSPROF_EMOR_MODES);
        if (reader.bad)
            status = lp_store_fail_profile(store, id, reader.bad, error);
        else
            *variance = fmax(lp_corner_variance(covariance, size, modes, curves), 0.0);
    } else
        status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    return status;
}

/* The profile that the prediction makes, of the nearest stored one. */
static lensprof_status make_profile(lensprof_store *store, const lensprof_profile_key *key,
                                    const lp_falloff_prediction *p, lensprof_lookup *lookup, lensprof_error *error) {
    lensprof_profile *profile = &store->scratch;
    lensprof_status status = lp_store_fetch(store, lookup->id[0], error);
    if (status != LENSPROF_OK) return status;
    profile->key = *key;
    profile->vignettings = memcmp(p->k[0], p->k[1], sizeof p->k[0]) || memcmp(p->k[0], p->k[2], sizeof p->k[0]) ? 3 : 1;
    for (uint32_t c = 0; c < 3; c++) {
        memcpy(profile->vignetting[c].k, p->k[c], sizeof p->k[c]);
        memcpy(profile->vignetting[c].center, profile->vignetting[0].center, sizeof profile->vignetting[0].center);
    }
    lensprof_gain_grid_init(&profile->grid);
    profile->covariance_size = 0;
    memset(profile->covariance, 0, sizeof profile->covariance);
    snprintf(profile->provenance.method, sizeof profile->provenance.method, "lookup");
    profile->provenance.images = profile->provenance.pairs = profile->provenance.forced = 0;
    profile->provenance.prior_id = 0;
    profile->provenance.heldout_rms = profile->provenance.inlier_share = LENSPROF_UNKNOWN;
    for (uint32_t c = profile->vignettings; c < 3; c++)
        memset(&profile->vignetting[c], 0, sizeof profile->vignetting[c]);
    if (lensprof_profile_validate(profile) != LENSPROF_OK)
        return refuse(store, lookup, LENSPROF_REASON_LOOKUP_CONTRADICTION, error);
    return LENSPROF_OK;
}

/* Profiles with a covariance count the less the less is known of them. */
static lensprof_status weigh(lensprof_store *store, lp_candidates *found, lensprof_error *error) {
    lensprof_status status = LENSPROF_OK;
    for (uint32_t i = 0; i < found->count && status == LENSPROF_OK; i++) {
        if (!found->all[i].has_covariance) continue;
        status = read_variance(store, found->all[i].node.id, &found->all[i].node.variance, error);
    }
    return status;
}

static lensprof_status predict(lensprof_store *store, const lensprof_profile_key *key, const lensprof_lookup_options *o,
                               lp_candidates *found, lp_falloff_node at, lensprof_lookup *lookup,
                               lensprof_error *error) {
    lp_falloff_prediction p;
    lp_falloff_node *nodes = malloc(found->count * sizeof *nodes);
    if (!nodes) return lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
    for (uint32_t i = 0; i < found->count; i++) {
        rescale(&found->all[i], key);
        nodes[i] = found->all[i].node;
        if (nodes[i].distance_m == LENSPROF_UNKNOWN) nodes[i].distance_m = INFINITY;
    }
    const uint32_t count = lp_drop_repeated(nodes, keep_newest(nodes, found->count));
    const int done = at.distance_m == LENSPROF_UNKNOWN ? predict_any_distance(nodes, count, at, o->distance_rule, &p)
                                                       : lp_predict_falloff(nodes, count, &at, &p);
    if (done > 0) {
        lookup->rows = p.used;
        lookup->sigma = p.sigma;
        for (uint32_t i = 0; i < p.used; i++) {
            lookup->id[i] = nodes[p.row[i].node].id;
            lookup->weight[i] = p.row[i].weight;
        }
    }
    free(nodes);
    if (done < 0) return lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
    lookup->distance = p.nearest;
    if (!done) return refuse(store, lookup, LENSPROF_REASON_LOOKUP_TOO_FAR, error);
    return make_profile(store, key, &p, lookup, error);
}

/* No row: the lens or camera is not there at all, or only with what the options leave out. */
static lensprof_status refuse_unknown(lensprof_store *store, const lensprof_profile_key *key,
                                      const lensprof_lookup_options *o, lensprof_lookup *lookup,
                                      lensprof_error *error) {
    static const lensprof_reason reasons[] = {LENSPROF_REASON_LOOKUP_OTHER_PROCESSING, LENSPROF_REASON_LOOKUP_DOUBTFUL,
                                              LENSPROF_REASON_LOOKUP_OTHER_CAMERA};
    const bool has_lens = lp_is_known(key->lens);
    lensprof_lookup_options wider = *o;
    lensprof_profile_key any = *key;
    for (int which = 0; which < (has_lens ? 3 : 2); which++) {
        lp_candidates others;
        memset(&others, 0, sizeof others);
        if (which == 0) wider.any_processing = 1;
        if (which == 1) wider.with_doubt = 1;
        if (which == 2) memset(any.camera_model, 0, sizeof any.camera_model);
        others.any_unit = which == 2;
        const lensprof_status status = lp_find_candidates(store, &any, &wider, &others, error);
        const uint32_t count = others.count;
        free(others.all);
        if (status != LENSPROF_OK) return status;
        if (count) return refuse(store, lookup, reasons[which], error);
    }
    const bool of_lens = has_lens || !*key->camera_model;
    return refuse(store, lookup, of_lens ? LENSPROF_REASON_LOOKUP_NO_LENS : LENSPROF_REASON_LOOKUP_NO_CAMERA, error);
}

static lensprof_status answer_exact(lensprof_store *store, int64_t id, lensprof_lookup *lookup, lensprof_error *error) {
    lookup->exact = lookup->rows = 1;
    lookup->id[0] = id, lookup->weight[0] = 1.0;
    const lensprof_status status = lp_store_fetch(store, id, error);
    if (status != LENSPROF_OK) return status;
    const lensprof_profile *profile = &store->scratch;
    const double variance =
        lp_corner_variance(profile->covariance, profile->covariance_size,
                           lp_covariance_modes(profile->response, profile->responses), profile->vignettings);
    lookup->sigma = variance >= 0.0 ? sqrt(variance) : LENSPROF_UNKNOWN;
    return status;
}

/* What those that are used have in common, where the key leaves it open. */
static lensprof_profile_key complete_key(const lensprof_profile_key *key, const lp_candidates *found) {
    lensprof_profile_key whole = *key;
    whole.processing = found->all[0].processing;
    for (uint32_t i = 0; i < found->count && whole.crop_factor == LENSPROF_UNKNOWN; i++)
        whole.crop_factor = found->all[i].crop;
    return whole;
}

static lensprof_status answer(lensprof_store *store, const lensprof_profile_key *key, const lensprof_lookup_options *o,
                              lp_candidates *found, lensprof_lookup *lookup, lensprof_error *error) {
    lp_falloff_node at = {0, key->focal_mm, key->aperture, key->distance_m, {{0}}, 0.0};
    lookup->name_score = found->name_score;
    if (found->has_lenses) return refuse(store, lookup, LENSPROF_REASON_LOOKUP_SEVERAL_LENSES, error);
    if (!found->count) return refuse_unknown(store, key, o, lookup, error);
    lensprof_reason wrong = lp_choose_candidates(found, key, lookup);
    if (wrong) return refuse(store, lookup, wrong, error);
    lp_round_focal(found, &at, lookup);
    int64_t same = lp_find_exact(found, &at, key);
    if (same < 0) {
        wrong = lp_settle(found, &at, lookup);
        if (wrong) return refuse(store, lookup, wrong, error);
        same = lp_find_exact(found, &at, key);
    }
    if (same > 0) return answer_exact(store, same, lookup, error);
    if (at.distance_m == LENSPROF_UNKNOWN)
        lp_mind(lookup,
                o->distance_rule == LENSPROF_DISTANCE_WEAKEST ? LENSPROF_REASON_LOOKUP_WEAKEST_DISTANCE
                                                              : LENSPROF_REASON_LOOKUP_FARTHEST_DISTANCE,
                NULL);
    const lensprof_profile_key whole = complete_key(key, found);
    lensprof_status status = weigh(store, found, error);
    return status == LENSPROF_OK ? predict(store, &whole, o, found, at, lookup, error) : status;
}

/* The caller's options as this library's, and whether the rest of the call can be answered. */
static lensprof_status check_lookup(const lensprof_profile_key *key, const lensprof_lookup_options *given,
                                    lensprof_lookup_options *own, const lensprof_profile *profile,
                                    const lensprof_lookup *lookup, lensprof_error *error) {
    lensprof_lookup_options_init(own);
    const char *wrong = lp_sized_take(own, given, FIRST_OPTIONS);
    if (wrong) return lp_store_fail_size("lensprof_lookup_options", wrong, error);
    wrong = lp_sized_wrong(lookup, FIRST_LOOKUP, sizeof *lookup);
    if (wrong) return lp_store_fail_size("lensprof_lookup", wrong, error);
    const lensprof_status status = lp_store_check_size(profile, error);
    if (status != LENSPROF_OK) return status;
    if (own->distance_rule > LENSPROF_DISTANCE_FARTHEST || own->with_doubt > 1 || own->any_processing > 1)
        return lp_store_fail_argument("an option is unknown; see lensprof_lookup_options", error);
    if (lensprof_profile_key_validate(key) != LENSPROF_OK)
        return lp_store_fail_argument("the key is not valid; see lensprof_profile_key", error);
    return LENSPROF_OK;
}

lensprof_status lensprof_store_lookup(lensprof_store *store, const lensprof_profile_key *key,
                                      const lensprof_lookup_options *given, lensprof_profile *profile,
                                      lensprof_lookup *lookup, lensprof_error *error) {
    lensprof_lookup_options options;
    lensprof_lookup result;
    lp_candidates found;
    lp_store_clear(error);
    if (!store || !key || !given || !profile || !lookup)
        return lp_store_fail_argument("store, key, options, profile or lookup is NULL", error);
    lensprof_status status = check_lookup(key, given, &options, profile, lookup, error);
    if (status != LENSPROF_OK) return status;
    lensprof_lookup_init(&result);
    memset(&found, 0, sizeof found);
    status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = lp_find_candidates(store, key, &options, &found, error);
    if (status == LENSPROF_OK) status = answer(store, key, &options, &found, &result, error);
    lp_store_rollback(store);
    free(found.all);
    if (status == LENSPROF_OK) lp_sized_copy(profile, &store->scratch);
    if (status == LENSPROF_OK || status == LENSPROF_ERROR_NOT_FOUND) lp_sized_copy(lookup, &result);
    return status;
}
