/* The falloff of a lens at a setting that need not be stored. */
#include "store/lookup/lookup_falloff.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/covariance.h"
#include "store/lookup/lookup_distance.h"

/* Where the sensor's size is not known, the other one that it may have: a lens for 24 x 36 mm on a sensor half as
 * large, or, for smaller sensors, what their makers' sizes differ by. Ratios of crop factors. */
#define FULL_FRAME 1.4
#define SMALLER_THAN_FULL_FRAME 1.5
#define SMALLER_THAN_OTHERS 1.1

_Static_assert(LP_NEIGHBOURS == LENSPROF_LOOKUP_ROWS, "a lookup names all that a prediction uses");

lensprof_status lp_refuse(lensprof_store *store, lensprof_lookup *lookup, lensprof_reason reason,
                          lensprof_error *error) {
    const char *text = lensprof_reason_text(reason);
    memset(lookup->reason_code, 0, sizeof lookup->reason_code);
    lookup->reason_code[0] = reason;
    snprintf(lookup->reason, sizeof lookup->reason, "%s", text);
    return lp_store_fail(store->path, LENSPROF_ERROR_NOT_FOUND, "has no profile for this setting", text, error);
}

static lensprof_status refuse_both(lensprof_store *store, const char *text, lensprof_lookup *lookup,
                                   lensprof_error *error) {
    memset(lookup->reason_code, 0, sizeof lookup->reason_code);
    lookup->reason_code[0] = LENSPROF_REASON_LOOKUP_FOCAL_BEYOND;
    lookup->reason_code[1] = LENSPROF_REASON_LOOKUP_APERTURE_BEYOND;
    snprintf(lookup->reason, sizeof lookup->reason, "%s", text);
    return lp_store_fail(store->path, LENSPROF_ERROR_NOT_FOUND, "has no profile for this setting", text, error);
}

/* ---- the rows as nodes ---- */

/* k in half diagonals of the key's sensor: r there is r times the ratio here. */
static void rescale(lp_candidate *c, const lensprof_profile_key *key) {
    if (c->crop == LENSPROF_UNKNOWN || key->crop_factor == LENSPROF_UNKNOWN) return;
    const double ratio2 = (c->crop / key->crop_factor) * (c->crop / key->crop_factor);
    for (int curve = 0; curve < 3; curve++) {
        double scale = 1.0;
        for (int n = 0; n < 3; n++) c->node.k[curve][n] *= scale *= ratio2;
    }
}

static bool is_same_setting(const lp_falloff_node *a, const lp_falloff_node *b) {
    return lp_is_same(a->focal_mm, b->focal_mm) && lp_is_same(a->aperture, b->aperture)
           && lp_is_same(a->distance_m, b->distance_m);
}

/* A row's place among the others: `position` is larger by no more than TOLERANCE of itself where the setting is the
 * same. */
typedef struct placed {
    double position;
    lp_candidate *row;
    bool has_key_processing; /* of the key's processing */
} placed;

#define TOLERANCE 2e-6 /* twice that of lp_is_same */

/* Rises with all three numbers; settings that differ rarely share it. */
static double place_of(const lp_falloff_node *node) {
    const double d = node->distance_m;
    const double reach = d == LENSPROF_UNKNOWN ? 2.0 : isinf(d) ? 1.0 : d / (1.0 + d);
    return node->focal_mm + 1.4142135623730951 * node->aperture + 1.7320508075688772 * reach;
}

static int order_of(double a, double b) { return a < b ? -1 : a > b; }

/* Of rows with one setting profiles of the key's processing come before others, then the newest, as everywhere: it may
 * hold the others, or have overruled them. */
static int compare_rank(const placed *a, const placed *b) {
    if (a->has_key_processing != b->has_key_processing) return a->has_key_processing ? -1 : 1;
    return a->row->node.id > b->row->node.id ? -1 : a->row->node.id < b->row->node.id;
}

static int compare_places(const void *first, const void *second) {
    const placed *a = first, *b = second;
    const lp_falloff_node *of_a = &a->row->node, *of_b = &b->row->node;
    int side = order_of(a->position, b->position);
    if (!side) side = order_of(of_a->focal_mm, of_b->focal_mm);
    if (!side) side = order_of(of_a->aperture, of_b->aperture);
    if (!side) side = order_of(of_a->distance_m, of_b->distance_m);
    return side ? side : compare_rank(a, b);
}

static bool is_twin(const lp_falloff_node *a, const lp_falloff_node *b) {
    return a->focal_mm == b->focal_mm && a->aperture == b->aperture && a->distance_m == b->distance_m;
}

/* Marks rows of a setting that a better row has, too. */
static void find_replaced(lp_candidates *group, uint32_t processing, placed *places) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < group->count; i++) {
        lp_candidate *row = &group->all[i];
        row->is_replaced = false;
        places[i] = (placed){place_of(&row->node), row, row->processing == processing};
    }
    qsort(places, group->count, sizeof *places, compare_places);
    for (uint32_t i = 0; i < group->count; i++) /* the first of the same numbers is the best of them */
        if (kept && is_twin(&places[kept - 1].row->node, &places[i].row->node))
            places[i].row->is_replaced = true;
        else
            places[kept++] = places[i];
    for (uint32_t i = 0; i < kept; i++)
        for (uint32_t j = i + 1; j < kept && places[j].position <= places[i].position * (1.0 + TOLERANCE); j++)
            if (is_same_setting(&places[i].row->node, &places[j].row->node))
                places[compare_rank(&places[i], &places[j]) < 0 ? j : i].row->is_replaced = true;
}

/* One node for each setting, to nodes[group->count]; returns how many, or 0 without memory. */
static uint32_t take_nodes(lp_candidates *group, uint32_t processing, lp_falloff_node *nodes) {
    uint32_t kept = 0;
    placed *places = malloc(group->count * sizeof *places);
    if (!places) return 0;
    find_replaced(group, processing, places);
    for (uint32_t i = 0; i < group->count; i++)
        if (!group->all[i].is_replaced) nodes[kept++] = group->all[i].node;
    for (uint32_t i = 0; i < kept; i++)
        if (nodes[i].distance_m == LENSPROF_UNKNOWN) nodes[i].distance_m = INFINITY;
    free(places);
    uint32_t *order = malloc(kept * sizeof *order);
    kept = order ? lp_drop_repeated(nodes, kept, order) : 0;
    free(order);
    return kept;
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

/* Whose nodes a prediction is from, and what went wrong when one was read. */
typedef struct source {
    lensprof_store *store;
    lensprof_error *error;
    lensprof_status status;
} source;

static bool read_node(void *user, lp_falloff_node *node) {
    source *from = user;
    node->variance = 0.0;
    from->status = read_variance(from->store, node->id, &node->variance, from->error);
    return from->status == LENSPROF_OK;
}

/* ---- the answer of a group of rows ---- */

/* Of M in the corner, where the sensor's size is not known and the lens can be put on several. */
static double sensor_sigma(const lp_candidates *group, const lensprof_profile_key *key, const double k[3]) {
    const lp_candidate *first = &group->all[0];
    if (first->is_fixed || first->of_camera > 0
        || (first->crop != LENSPROF_UNKNOWN && key->crop_factor != LENSPROF_UNKNOWN))
        return 0.0;
    const double crop = first->crop != LENSPROF_UNKNOWN ? first->crop : key->crop_factor;
    const double smaller =
        crop == LENSPROF_UNKNOWN || crop < FULL_FRAME ? SMALLER_THAN_FULL_FRAME : SMALLER_THAN_OTHERS;
    const lensprof_vignetting v = {{k[0], k[1], k[2]}, {0.0, 0.0}};
    return fabs(lensprof_vignetting_eval(&v, 1.0, NULL)
                - lensprof_vignetting_eval(&v, 1.0 / (smaller * smaller), NULL));
}

/* What those that are used have in common, where the key leaves it open. */
static lensprof_profile_key complete_key(const lensprof_profile_key *key, const lensprof_lookup_options *o,
                                         const lp_candidates *group) {
    lensprof_profile_key completed = *key;
    if (o->any_processing) completed.processing = group->all[group->count - 1].processing; /* of the newest */
    for (uint32_t i = 0; i < group->count && completed.crop_factor == LENSPROF_UNKNOWN; i++)
        completed.crop_factor = group->all[i].crop;
    return completed;
}

static void add_unknown_reasons(const lp_falloff_node *target, uint32_t distance_rule, lensprof_lookup *lookup) {
    static const lensprof_reason distances[] = {LENSPROF_REASON_LOOKUP_USUAL_DISTANCE,
                                                LENSPROF_REASON_LOOKUP_WEAKEST_DISTANCE,
                                                LENSPROF_REASON_LOOKUP_FARTHEST_DISTANCE};
    bool is_reported = false;
    for (uint32_t i = 0; i < LENSPROF_LOOKUP_REASONS; i++)
        is_reported |= lookup->reason_code[i] == LENSPROF_REASON_LOOKUP_SMALLEST_SENSOR;
    if (lookup->sensor_sigma > 0.0 && !is_reported)
        lp_add_lookup_reason(lookup, LENSPROF_REASON_LOOKUP_UNKNOWN_SENSOR, NULL);
    if (target->distance_m == LENSPROF_UNKNOWN) lp_add_lookup_reason(lookup, distances[distance_rule], NULL);
}

/* As lp_predict_falloff; -1 also on an error, which is in from->status. */
static int predict_at(source *from, lp_falloff_nodes *nodes, const lp_falloff_node *target, uint32_t distance_rule,
                      lp_falloff_prediction *p, double *distance_sigma) {
    nodes->read_variance = read_node, nodes->user = from;
    if (!nodes->count) return -1;
    *distance_sigma = 0.0;
    return target->distance_m == LENSPROF_UNKNOWN
               ? lp_predict_any_distance(nodes, target, distance_rule, p, distance_sigma)
               : lp_predict_falloff(nodes, target, p);
}

static lensprof_status predict(lensprof_store *store, const lensprof_profile_key *key, const lensprof_lookup_options *o,
                               lp_candidates *group, lp_falloff_node target, lp_falloff_answer *answer,
                               lensprof_lookup *lookup, lensprof_error *error) {
    lp_falloff_prediction p;
    double distance_sigma;
    source from = {store, error, LENSPROF_OK};
    lp_falloff_nodes nodes = {malloc(group->count * sizeof *nodes.node), 0, NULL, NULL};
    if (!nodes.node) return lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
    for (uint32_t i = 0; i < group->count; i++) rescale(&group->all[i], &answer->key);
    nodes.count = take_nodes(group, answer->key.processing, nodes.node);
    const int done = predict_at(&from, &nodes, &target, o->distance_rule, &p, &distance_sigma);
    for (uint32_t i = 0; done > 0 && i < p.used; i++) {
        lookup->id[i] = nodes.node[p.row[i].node].id;
        lookup->weight[i] = p.row[i].weight;
    }
    free(nodes.node);
    if (from.status != LENSPROF_OK) return from.status;
    if (done < 0) return lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
    lookup->distance = p.nearest;
    if (!done) return lp_refuse(store, lookup, LENSPROF_REASON_LOOKUP_TOO_FAR, error);
    lookup->rows = p.used;
    lookup->falloff_sigma = p.sigma * lp_widening(group, &target);
    lookup->distance_sigma = distance_sigma;
    lookup->sensor_sigma = sensor_sigma(group, key, p.k[1]);
    memcpy(answer->k, p.k, sizeof answer->k);
    add_unknown_reasons(&target, o->distance_rule, lookup);
    return LENSPROF_OK;
}

/* NOT_FOUND where none of the group is near the setting. */
static lensprof_status ask_group(lensprof_store *store, const lensprof_profile_key *key,
                                 const lensprof_lookup_options *o, lp_candidates *group, lp_falloff_answer *answer,
                                 lensprof_lookup *lookup, lensprof_error *error) {
    lp_falloff_node target = {0, key->focal_mm, key->aperture, key->distance_m, {{0}}, 0.0};
    lp_round_focal(group, &target, lookup);
    int64_t same = lp_find_exact(group, &target, key);
    if (same < 0) {
        const lensprof_reason wrong = lp_resolve_setting(group, &target, lookup);
        if (wrong) return lp_refuse(store, lookup, wrong, error);
        same = lp_find_exact(group, &target, key);
    }
    answer->key = complete_key(key, o, group);
    if (same > 0) {
        lookup->exact = lookup->rows = 1;
        lookup->id[0] = same, lookup->weight[0] = 1.0;
        return LENSPROF_OK;
    }
    char text[sizeof lookup->reason];
    if (lp_is_outside_both(group, &target, text, sizeof text)) return refuse_both(store, text, lookup, error);
    const lensprof_status status = lp_read_curves(store, group, error);
    return status == LENSPROF_OK ? predict(store, key, o, group, target, answer, lookup, error) : status;
}

/* ---- groups, the best first ---- */

/* No row: the lens or camera is not there at all, or only with what the key or the options leave out. */
static lensprof_status refuse_unknown(lensprof_store *store, const lensprof_profile_key *key,
                                      const lensprof_lookup_options *o, lensprof_lookup *lookup, bool *knows_lens,
                                      lensprof_error *error) {
    const bool is_corrected = key->processing == LENSPROF_PROCESSING_CORRECTED;
    const lensprof_reason reasons[] = {
        is_corrected ? LENSPROF_REASON_LOOKUP_CORRECTED : LENSPROF_REASON_LOOKUP_OTHER_PROCESSING,
        LENSPROF_REASON_LOOKUP_DOUBTFUL, LENSPROF_REASON_LOOKUP_OTHER_CAMERA};
    const bool has_lens = lp_is_known(key->lens);
    lensprof_lookup_options wider = *o;
    for (int step = 0; step < (has_lens ? 3 : 2); step++) {
        lp_candidates others;
        memset(&others, 0, sizeof others);
        if (step == 0) wider.any_processing = 1;
        if (step == 1) wider.with_doubt = 1;
        others.any_unit = step == 2;
        const lensprof_status status = lp_find_candidates(store, key, &wider, &others, error);
        const uint32_t count = others.count;
        free(others.all);
        if (status != LENSPROF_OK) return status;
        *knows_lens |= count > 0;
        if (count) return lp_refuse(store, lookup, reasons[step], error);
    }
    const bool of_lens = has_lens || !*key->camera_model;
    return lp_refuse(store, lookup, of_lens ? LENSPROF_REASON_LOOKUP_NO_LENS : LENSPROF_REASON_LOOKUP_NO_CAMERA, error);
}

/* The first group that has an answer; where none has, what is wrong with the first. */
static lensprof_status ask_groups(lensprof_store *store, const lensprof_profile_key *key,
                                  const lensprof_lookup_options *o, const lp_candidates *found, lp_candidates *group,
                                  lp_falloff_answer *answer, lensprof_lookup *lookup, lensprof_error *error) {
    const lensprof_lookup begun = *lookup;
    lensprof_lookup best = begun;
    lensprof_error best_error;
    lensprof_status status = LENSPROF_ERROR_NOT_FOUND;
    double below = INFINITY;
    for (int tried = 0; status == LENSPROF_ERROR_NOT_FOUND; tried++) {
        *lookup = begun;
        below = lp_choose_candidates(found, key, below, group, lookup);
        if (!group->count) {
            if (!tried) return lp_refuse(store, lookup, LENSPROF_REASON_LOOKUP_SMALLER_SENSOR, error);
            *lookup = best;
            if (error) *error = best_error;
            return status;
        }
        lensprof_error group_error;
        lp_store_clear(&group_error);
        status = ask_group(store, key, o, group, answer, lookup, &group_error);
        if (!tried) best = *lookup, best_error = group_error;
        if (status != LENSPROF_OK && status != LENSPROF_ERROR_NOT_FOUND && error) *error = group_error;
    }
    return status;
}

lensprof_status lp_find_falloff(lensprof_store *store, const lensprof_profile_key *key,
                                const lensprof_lookup_options *o, lp_falloff_answer *answer, lensprof_lookup *lookup,
                                bool *knows_lens, lensprof_error *error) {
    lp_candidates found, group;
    memset(&found, 0, sizeof found);
    *knows_lens = false;
    lensprof_status status = lp_find_candidates(store, key, o, &found, error);
    lookup->name_score = found.name_score;
    group = found;
    group.all = NULL;
    if (status != LENSPROF_OK) {
    } else if (found.has_lenses)
        status = lp_refuse(store, lookup, LENSPROF_REASON_LOOKUP_SEVERAL_LENSES, error);
    else if (!found.count)
        status = refuse_unknown(store, key, o, lookup, knows_lens, error);
    else if (!(group.all = malloc(found.count * sizeof *group.all)))
        status = lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
    else {
        *knows_lens = true;
        status = ask_groups(store, key, o, &found, &group, answer, lookup, error);
    }
    free(group.all);
    free(found.all);
    return status;
}
