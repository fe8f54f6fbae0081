/* The profile for a setting that need not be stored: which rows of the lens are used, and what is made of them. */
#include "store_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "falloff_prediction.h"
#include "store_names.h"

#define CROP_TOLERANCE 0.96 /* a sensor may be larger by so much than the one that was measured */
#define MOST_DISTANCES 8    /* stored focus distances that are tried where it is not known */

void lensprof_lookup_options_init(lensprof_lookup_options *options)
{
    memset(options, 0, sizeof *options);
    options->struct_size = sizeof *options;
}

/* A row of the lens: how well it fits the camera, and its node. */
typedef struct candidate {
    lp_falloff_node node;
    int of_unit, of_camera, has_covariance;
    double crop;
    uint32_t processing;
} candidate;

typedef struct candidates {
    candidate *all;
    uint32_t count, room;
    double name_score;
} candidates;

/* ---- rows ---- */

#define ROWS_OF_LENS(name, unit, crop, doubt) \
    "SELECT id, camera_model, lens, " unit ", " crop ", focal_mm, aperture, distance_m, curve, k1, k2, k3, vignetting_curves, covariance_size FROM profiles JOIN vignettings ON profile_id = id WHERE " name \
    " = ?1 AND (?2 OR " doubt " = '') AND (?3 OR processing = ?4) ORDER BY id, curve"

static const char *const rows_sql[2] = {
    ROWS_OF_LENS("lower(replace(replace(replace(replace(replace(replace(lens,"
                 " ' ', ''), '-', ''), '/', ''), '.', ''), '(', ''), ')', ''))", "''", "NULL", "''"),
    ROWS_OF_LENS("lens_name", "unit", "crop_factor", "doubt")};

static candidate *add(candidates *found)
{
    if (found->count == found->room) {
        const uint32_t room = found->room ? 2 * found->room : 64;
        candidate *all = realloc(found->all, room * sizeof *all);
        if (!all) return NULL;
        found->all = all, found->room = room;
    }
    return memset(&found->all[found->count++], 0, sizeof(candidate));
}

/* -1 for a row of another camera or unit. */
static int fits(const char *own, const char *asked)
{
    if (!*own) return 0;
    return lp_name_score(own, asked) >= 0.8 ? 1 : -1;
}

/* One curve of a row, as rows_sql has it. */
typedef struct row {
    lensprof_profile_key key;
    int64_t id, curve, curves, covariance_size;
    double k[3];
} row;

/* False, with the reader's column, for what no profile has. */
static bool read_row(sqlite3_stmt *statement, lp_store_reader *reader, row *r)
{
    *reader = (lp_store_reader){statement, 0, NULL};
    lensprof_profile_key_init(&r->key);
    r->id = lp_read_integer(reader, 1, INT64_MAX);
    lp_read_text(reader, r->key.camera_model, sizeof r->key.camera_model);
    lp_read_text(reader, r->key.lens, sizeof r->key.lens);
    lp_read_text(reader, r->key.unit, sizeof r->key.unit);
    r->key.crop_factor = lp_read_known(reader);
    r->key.focal_mm = lp_read_known(reader);
    r->key.aperture = lp_read_known(reader);
    r->key.distance_m = lp_read_known(reader);
    r->curve = lp_read_integer(reader, 0, 2);
    for (int n = 0; n < 3; n++) r->k[n] = lp_read_real(reader);
    r->curves = lp_read_integer(reader, 1, 3);
    r->covariance_size = lp_read_integer(reader, 0, LENSPROF_COVARIANCE_MAX);
    if (!reader->bad && lensprof_profile_key_validate(&r->key) != LENSPROF_OK) reader->bad = "key";
    return !reader->bad;
}

/* Takes a row that fits the key; its first curve comes first. False without memory. */
static bool take_row(const row *r, const lensprof_profile_key *key, candidates *found)
{
    candidate *one = found->count ? &found->all[found->count - 1] : NULL;
    if (!one || one->node.id != r->id) {
        const int unit = fits(r->key.unit, key->unit), camera = fits(r->key.camera_model, key->camera_model);
        if (unit < 0 || (camera < 0 && *key->camera_model) || r->curve != 0) return true;
        if (!(one = add(found))) return false;
        found->name_score = fmax(found->name_score, lp_name_score(r->key.lens, key->lens));
        one->of_unit = unit, one->of_camera = camera, one->has_covariance = r->covariance_size > 0;
        one->crop = r->key.crop_factor;
        one->node.id = r->id;
        one->node.focal_mm = r->key.focal_mm;
        one->node.aperture = r->key.aperture;
        one->node.distance_m = r->key.distance_m;
        for (int c = 0; c < 3; c++) memcpy(one->node.k[c], r->k, sizeof r->k); /* of all, unless others follow */
    } else memcpy(one->node.k[r->curve], r->k, sizeof r->k);
    return true;
}

static lensprof_status read_rows(lensprof_store *store, const char *name, const lensprof_profile_key *key,
                                 const lensprof_lookup_options *o, candidates *found, lensprof_error *error)
{
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(store, rows_sql[store->layout >= 3], &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_text(&binder, name);
    lp_bind_integer(&binder, o->with_doubt);
    lp_bind_integer(&binder, o->any_processing);
    lp_bind_text(&binder, lp_store_processings[key->processing]);
    int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        lp_store_reader reader;
        row r;
        if (!read_row(binder.statement, &reader, &r)) status = lp_store_fail_profile(store, r.id, reader.bad, error);
        else rc = take_row(&r, key, found) ? sqlite3_step(binder.statement) : SQLITE_NOMEM;
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    return status;
}

/* ---- which of them ---- */

static int is_sensor_covered(const candidate *c, const lensprof_profile_key *key)
{
    return c->crop == LENSPROF_UNKNOWN || key->crop_factor == LENSPROF_UNKNOWN
           || key->crop_factor / c->crop >= CROP_TOLERANCE;
}

/* Larger is better: unit, camera, then the sensor nearest to the key's. */
static double rank_of(const candidate *c, const lensprof_profile_key *key)
{
    const int is_known = c->crop != LENSPROF_UNKNOWN && key->crop_factor != LENSPROF_UNKNOWN;
    return 100.0 * c->of_unit + 10.0 * c->of_camera + (is_known ? fmin(c->crop / key->crop_factor, 1.0) : 0.5);
}

/* Keeps the best group; returns how many there are. */
static uint32_t keep_best(candidates *found, const lensprof_profile_key *key)
{
    double best = -1.0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < found->count; i++)
        if (is_sensor_covered(&found->all[i], key)) best = fmax(best, rank_of(&found->all[i], key));
    for (uint32_t i = 0; i < found->count; i++)
        if (is_sensor_covered(&found->all[i], key) && rank_of(&found->all[i], key) >= best - 1e-3)
            found->all[kept++] = found->all[i];
    return found->count = kept;
}

/* k in half diagonals of the key's sensor: r there is r times the ratio here. */
static void rescale(candidate *c, const lensprof_profile_key *key)
{
    if (c->crop == LENSPROF_UNKNOWN || key->crop_factor == LENSPROF_UNKNOWN) return;
    const double ratio2 = (c->crop / key->crop_factor) * (c->crop / key->crop_factor);
    for (int curve = 0; curve < 3; curve++) {
        double scale = 1.0;
        for (int n = 0; n < 3; n++) c->node.k[curve][n] *= scale *= ratio2;
    }
}

/* ---- settings ---- */

/* Focal length for 0, aperture for 1. */
static double setting(const lp_falloff_node *node, int which) { return which ? node->aperture : node->focal_mm; }

static void set(lp_falloff_node *node, int which, double value) { *(which ? &node->aperture : &node->focal_mm) = value; }

static int is_same(double a, double b) { return a == b || fabs(a - b) <= 1e-6 * fmin(a, b); }

/* Rows that lack a number which the key has are of no use; one that the key lacks must be the same in all rows. Returns
 * NULL, or what is wrong. */
static const char *settle(candidates *found, lp_falloff_node *at, int which)
{
    static const char *const missing[] = {"the focal length is not known, and the lens has several; give it",
                                          "the aperture is not known, and the lens has several; give it"};
    static const char *const useless[] = {"no profile of this lens has a focal length",
                                          "no profile of this lens has an aperture"};
    uint32_t kept = 0;
    if (setting(at, which) == LENSPROF_UNKNOWN) {
        const double only = setting(&found->all[0].node, which);
        for (uint32_t i = 1; i < found->count; i++)
            if (!is_same(setting(&found->all[i].node, which), only)) return missing[which];
        set(at, which, only != LENSPROF_UNKNOWN ? only : 1.0); /* where nobody knows it makes no difference */
        for (uint32_t i = 0; i < found->count && only == LENSPROF_UNKNOWN; i++) set(&found->all[i].node, which, 1.0);
        return NULL;
    }
    for (uint32_t i = 0; i < found->count; i++)
        if (setting(&found->all[i].node, which) != LENSPROF_UNKNOWN) found->all[kept++] = found->all[i];
    found->count = kept;
    return kept ? NULL : useless[which];
}

/* Nothing is predicted more than one node beyond the last: the outermost two nodes' spacing (in stops or octaves), or a
 * twelfth of an octave in focal length and a third of a stop where there is one node only. */
static int is_beyond(const candidates *found, const lp_falloff_node *at, int which)
{
    double low = INFINITY, high = 0.0, above_low = INFINITY, below_high = 0.0;
    const double single = which ? 1.0 / 6.0 : 1.0 / 12.0; /* log2; of the f-number half a stop counts as 1/4 */
    for (uint32_t i = 0; i < found->count; i++) {
        const double value = log2(setting(&found->all[i].node, which));
        low = fmin(low, value), high = fmax(high, value);
    }
    for (uint32_t i = 0; i < found->count; i++) {
        const double value = log2(setting(&found->all[i].node, which));
        if (value > low + 1e-6) above_low = fmin(above_low, value);
        if (value < high - 1e-6) below_high = fmax(below_high, value);
    }
    const double asked = log2(setting(at, which)), least = 1e-6;
    const double before = high - low > 1e-6 ? fmax(above_low - low, single) : single;
    const double behind = high - low > 1e-6 ? fmax(high - below_high, single) : single;
    return asked < low - before - least || asked > high + behind + least;
}

/* ---- predictions ---- */

/* The weakest, radius by radius, of the falloffs at all distances that are stored; or that at the farthest. */
static int predict_any_distance(const lp_falloff_node *nodes, uint32_t count, lp_falloff_node at, uint32_t rule,
                                lp_falloff_prediction *best)
{
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
        if (rule == LENSPROF_DISTANCE_FARTHEST) { known++; break; }
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

static lensprof_status refuse(lensprof_store *store, lensprof_lookup *lookup, const char *reason, lensprof_error *error)
{
    snprintf(lookup->reason, sizeof lookup->reason, "%s", reason);
    return lp_store_fail(store->path, LENSPROF_ERROR_NOT_FOUND, "has no profile for this setting", reason, error);
}

/* Variance of M in the corner of a stored profile by its covariance, mean of its curves; 0 = not known. */
static double corner_variance(const lensprof_profile *p)
{
    uint32_t first = 0;
    double sum = 0.0;
    for (uint32_t c = 0; c < p->responses; c++)
        if (p->response[c].kind == LENSPROF_RESPONSE_EMOR) first += p->response[c].modes;
    if (p->covariance_size < first + 3) return 0.0;
    for (uint32_t i = first; i < first + 3; i++)
        for (uint32_t j = first; j < first + 3; j++) sum += p->covariance[i * p->covariance_size + j];
    return sum > 0.0 ? sum : 0.0;
}

/* The profile that the prediction makes, of the nearest stored one. */
static lensprof_status make_profile(lensprof_store *store, const lensprof_profile_key *key,
                                    const lp_falloff_prediction *p, lensprof_lookup *lookup, lensprof_error *error)
{
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
    profile->provenance.images = profile->provenance.pairs = 0;
    profile->provenance.heldout_rms = profile->provenance.inlier_share = LENSPROF_UNKNOWN;
    for (uint32_t c = profile->vignettings; c < 3; c++) memset(&profile->vignetting[c], 0, sizeof profile->vignetting[c]);
    if (lensprof_profile_validate(profile) != LENSPROF_OK)
        return refuse(store, lookup, "the profiles near it contradict each other: the falloff between them is none", error);
    return LENSPROF_OK;
}

/* Profiles with a covariance count the less the less is known of them. */
static lensprof_status weigh(lensprof_store *store, candidates *found, lensprof_error *error)
{
    lensprof_status status = LENSPROF_OK;
    for (uint32_t i = 0; i < found->count && status == LENSPROF_OK; i++) {
        if (!found->all[i].has_covariance) continue;
        status = lp_store_fetch(store, found->all[i].node.id, error);
        if (status == LENSPROF_OK) found->all[i].node.variance = corner_variance(&store->scratch);
    }
    return status;
}

static lensprof_status predict(lensprof_store *store, const lensprof_profile_key *key, const lensprof_lookup_options *o,
                               candidates *found, lp_falloff_node at, lensprof_lookup *lookup, lensprof_error *error)
{
    lp_falloff_prediction p;
    lp_falloff_node *nodes = malloc(found->count * sizeof *nodes);
    if (!nodes) return lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
    for (uint32_t i = 0; i < found->count; i++) {
        rescale(&found->all[i], key);
        nodes[i] = found->all[i].node;
        if (nodes[i].distance_m == LENSPROF_UNKNOWN) nodes[i].distance_m = INFINITY;
    }
    const int done = at.distance_m == LENSPROF_UNKNOWN ? predict_any_distance(nodes, found->count, at, o->distance_rule, &p)
                                                       : lp_predict_falloff(nodes, found->count, &at, &p);
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
    if (!done) return refuse(store, lookup, "the nearest profile of this lens is too far from this setting", error);
    return make_profile(store, key, &p, lookup, error);
}

/* The newest row that is at the setting, or -1. */
static int64_t find_exact(const candidates *found, const lp_falloff_node *at, const lensprof_profile_key *key)
{
    int64_t newest = -1;
    for (uint32_t i = 0; i < found->count; i++) {
        const candidate *c = &found->all[i];
        const int same_sensor = c->crop == LENSPROF_UNKNOWN || key->crop_factor == LENSPROF_UNKNOWN
                                || is_same(c->crop, key->crop_factor);
        if (same_sensor && is_same(c->node.focal_mm, at->focal_mm) && is_same(c->node.aperture, at->aperture)
            && is_same(c->node.distance_m, at->distance_m) && c->node.id > newest)
            newest = c->node.id;
    }
    return newest;
}

static lensprof_status answer(lensprof_store *store, const lensprof_profile_key *key, const lensprof_lookup_options *o,
                              candidates *found, lensprof_lookup *lookup, lensprof_error *error)
{
    lp_falloff_node at = {0, key->focal_mm, key->aperture, key->distance_m, {{0}}, 0.0};
    lookup->name_score = found->name_score;
    if (!found->count)
        return refuse(store, lookup, "no profile of a lens of this name; list the profiles to see which there are", error);
    if (!keep_best(found, key)) return refuse(store, lookup, "this lens was measured on smaller sensors only", error);
    const int64_t same = find_exact(found, &at, key);
    if (same > 0) {
        lookup->exact = lookup->rows = 1;
        lookup->id[0] = same, lookup->weight[0] = 1.0;
        lensprof_status status = lp_store_fetch(store, same, error);
        const double variance = status == LENSPROF_OK ? corner_variance(&store->scratch) : 0.0;
        lookup->sigma = variance > 0.0 ? sqrt(variance) : LENSPROF_UNKNOWN;
        return status;
    }
    for (int which = 0; which < 2; which++) {
        const char *wrong = settle(found, &at, which);
        if (wrong) return refuse(store, lookup, wrong, error);
        if (is_beyond(found, &at, which))
            return refuse(store, lookup, which ? "the aperture is beyond those at which this lens is known"
                                               : "the focal length is beyond those at which this lens is known", error);
    }
    if (at.distance_m == LENSPROF_UNKNOWN)
        snprintf(lookup->reason, sizeof lookup->reason, "the focus distance is not known: %s",
                 o->distance_rule == LENSPROF_DISTANCE_WEAKEST ? "the weakest falloff of those stored is taken"
                                                               : "the falloff at the farthest one stored is taken");
    lensprof_status status = weigh(store, found, error);
    return status == LENSPROF_OK ? predict(store, key, o, found, at, lookup, error) : status;
}

/* All rows of the lens, under the first name that any has. */
static lensprof_status find_lens(lensprof_store *store, const lensprof_profile_key *key, const lensprof_lookup_options *o,
                                 candidates *found, lensprof_error *error)
{
    lp_names names;
    lensprof_status status = LENSPROF_OK;
    lp_name_variants(key->lens, key->camera_maker, &names);
    for (uint32_t i = 0; i < names.count && status == LENSPROF_OK && !found->count; i++)
        status = read_rows(store, names.name[i], key, o, found, error);
    return status;
}

lensprof_status lensprof_store_lookup(lensprof_store *store, const lensprof_profile_key *key,
                                      const lensprof_lookup_options *options, lensprof_profile *profile,
                                      lensprof_lookup *lookup, lensprof_error *error)
{
    lensprof_lookup result;
    candidates found = {NULL, 0, 0, 0.0};
    lp_store_clear(error);
    if (!store || !key || !options || !profile || !lookup)
        return lp_store_fail_argument("store, key, options, profile or lookup is NULL", error);
    if (options->struct_size != sizeof *options) return LENSPROF_ERROR_STRUCT_SIZE;
    if (options->distance_rule > LENSPROF_DISTANCE_FARTHEST || options->with_doubt > 1 || options->any_processing > 1)
        return lp_store_fail_argument("an option is unknown; see lensprof_lookup_options", error);
    if (lensprof_profile_key_validate(key) != LENSPROF_OK)
        return lp_store_fail_argument("the key is not valid; see lensprof_profile_key", error);
    memset(&result, 0, sizeof result);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = find_lens(store, key, options, &found, error);
    if (status == LENSPROF_OK) status = answer(store, key, options, &found, &result, error);
    lp_store_rollback(store);
    free(found.all);
    if (status == LENSPROF_OK) *profile = store->scratch;
    if (status == LENSPROF_OK || status == LENSPROF_ERROR_NOT_FOUND) *lookup = result;
    return status;
}
