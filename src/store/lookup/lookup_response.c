/* The response of a camera: the mean of its profiles, weighted by their errors.
 *
 * Profile i states the standard error s_i of ln gamma, and has the weight 1/s_i^2. If gamma was determined by exposures
 * the errors are independent of each other. If it was determined by the typical response of the kind of camera, which
 * shows in an error as large as that one's, all profiles share the camera's distance from it. With weights w that add
 * up to 1 the variance of the mean is then (sum of w s over the sharing)^2 + sum of w^2 s^2 over the others. */
#include "store/lookup/lookup_response.h"

#include <math.h>
#include <string.h>

#include "core/covariance.h"
#include "core/response.h"
#include "store/lookup/lookup_candidates.h"
#include "store/names/names.h"
#include "store/profiles/layouts.h"

#define REPEATABILITY 0.018 /* of ln gamma between brackets of one camera (docs/model.md) */
#define SHARED 0.5 /* errors of this share of the typical one, and larger ones, are common to a camera's profiles */

#define MOST_HELD 64
#define LEAST_SIGMA 1e-3 /* of ln gamma: nobody knows it better */

#define MOST_SPELLINGS (2 * LP_CAMERA_NAMES)

/* The newest first, whatever the camera is called in them. */
static const char *const
    rows_sql[LP_STORE_LAYOUT] = LP_BY_LAYOUT("SELECT id, style, coalesce(prior_id, 0) FROM profiles WHERE " LP_SQUEEZED(
        "camera_model") " IN (?2, ?3, ?4, ?5, ?6, ?7)"
                        " AND processing <> 'raw' AND (?1 OR (doubt = '' AND NOT forced))"
                        " AND EXISTS (SELECT 1 FROM responses WHERE profile_id = id AND kind <> 'linear')"
                        " ORDER BY id DESC");

_Static_assert(MOST_SPELLINGS == 6, "rows_sql has a parameter for each");

void lp_typical_answer(const lensprof_profile_key *key, lp_response_answer *answer) {
    memset(answer, 0, sizeof *answer);
    answer->camera_kind = lensprof_camera_kind_of(key);
    answer->from =
        key->processing == LENSPROF_PROCESSING_RAW ? LENSPROF_RESPONSE_FROM_RAW : LENSPROF_RESPONSE_FROM_KIND;
    answer->responses = 1;
    if (lensprof_response_set_typical(&answer->response[0], answer->camera_kind, answer->covariance, &answer->sigma)
        != LENSPROF_OK)
        return; /* not of a kind that there is */
    answer->modes = answer->response[0].kind == LENSPROF_RESPONSE_EMOR ? answer->response[0].modes : 0;
}

/* By a covariance of the coefficients, n numbers a row; along[modes] receives that of each with q. */
static double gamma_variance(const lensprof_response *response, const double *covariance, uint32_t n,
                             double along[LENSPROF_EMOR_MODES]) {
    double slope[LENSPROF_EMOR_MODES], variance = 0.0;
    (void)lp_gauge_position(response->table, slope);
    for (uint32_t i = 0; i < response->modes; i++) {
        along[i] = 0.0;
        for (uint32_t j = 0; j < response->modes; j++) along[i] += covariance[i * n + j] * slope[j];
        variance += along[i] * slope[i];
    }
    return isfinite(variance) ? variance : 0.0;
}

static double sigma_of_coefficients(const lensprof_profile *profile) {
    const lensprof_response *response = &profile->response[0];
    double along[LENSPROF_EMOR_MODES];
    if (response->kind != LENSPROF_RESPONSE_EMOR || !response->modes || profile->covariance_size < response->modes)
        return LENSPROF_UNKNOWN;
    const double variance = gamma_variance(response, profile->covariance, profile->covariance_size, along);
    return variance > 0.0 ? sqrt(variance) : LENSPROF_UNKNOWN;
}

/* The covariance states the error of gamma that the answer does: what brackets do not repeat, and what the profiles
 * share, is added where q goes along. */
static void widen(lp_response_answer *answer) {
    double along[LENSPROF_EMOR_MODES];
    const uint32_t n = answer->modes;
    if (!n || answer->responses != 1 || answer->response[0].kind != LENSPROF_RESPONSE_EMOR) return;
    const double variance = gamma_variance(&answer->response[0], answer->covariance, n, along);
    const double missing = answer->sigma * answer->sigma - variance;
    if (!(variance > 0.0) || !(missing > 0.0)) return;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++)
            answer->covariance[i * n + j] += along[i] * along[j] * missing / (variance * variance);
}

double lp_stated_gamma_sigma(const lensprof_profile *profile) {
    const double stated = profile->provenance.gamma_sigma;
    return stated > 0.0 ? stated : sigma_of_coefficients(profile);
}

/* ---- which profiles ---- */

typedef struct choice {
    uint32_t count;
    int64_t id[LENSPROF_LOOKUP_RESPONSES];
    int64_t held[MOST_HELD]; /* priors that these profiles hold already, and what those hold in turn */
    uint32_t held_count;
    int style; /* lp_fits_style of all of them */
    bool has_other_style;
} choice;

static bool is_held(const choice *chosen, int64_t id) {
    for (uint32_t i = 0; i < chosen->held_count; i++)
        if (chosen->held[i] == id) return true;
    for (uint32_t i = 0; i < chosen->count; i++)
        if (chosen->id[i] == id) return true;
    return false;
}

/* One row, the newest first: those of the picture style before those of none that is known. */
static void choose(choice *chosen, int64_t id, int style, int64_t prior) {
    if (style < 0) chosen->has_other_style = true;
    if (style < 0 || style < chosen->style) return;
    const bool is_in_another = is_held(chosen, id);
    if (style > chosen->style) chosen->count = 0, chosen->style = style;
    if (prior && chosen->held_count < MOST_HELD) chosen->held[chosen->held_count++] = prior;
    if (is_in_another || chosen->count == LENSPROF_LOOKUP_RESPONSES) return;
    chosen->id[chosen->count++] = id;
}

/* All names of the camera, with its maker in front and without. */
typedef struct spellings {
    uint32_t count;
    char name[MOST_SPELLINGS][2 * LP_NAME_BYTES];
} spellings;

static void spell(const lensprof_profile_key *key, spellings *all) {
    char model[LP_NAME_BYTES], maker[LP_NAME_BYTES];
    const char *names[LP_CAMERA_NAMES];
    lp_squeeze(key->camera_model, model);
    lp_squeeze(key->camera_maker, maker);
    const char *bare = lp_without_maker(model), *in_front = lp_maker_in_front(model);
    if (!in_front) in_front = lp_maker_in_front(maker);
    if (!in_front) in_front = maker;
    const uint32_t count = lp_camera_names(bare, names);
    all->count = 0;
    for (uint32_t i = 0; i < count; i++) {
        strcpy(all->name[all->count++], names[i]);
        if (!*in_front) continue;
        strcpy(all->name[all->count], in_front);
        strcat(all->name[all->count++], names[i]);
    }
}

static lensprof_status choose_profiles(lensprof_store *store, const lensprof_profile_key *key,
                                       const lensprof_lookup_options *o, choice *chosen, lensprof_error *error) {
    spellings all;
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(store, lp_store_of_layout(store, rows_sql), &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    memset(chosen, 0, sizeof *chosen);
    spell(key, &all);
    lp_bind_integer(&binder, o->with_doubt);
    for (uint32_t i = 0; i < all.count; i++) lp_bind_text(&binder, all.name[i]); /* what is not bound is NULL */
    int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    for (; rc == SQLITE_ROW; rc = sqlite3_step(binder.statement)) {
        lp_store_reader reader = {binder.statement, 0, NULL};
        char style[sizeof key->style];
        const int64_t id = lp_read_integer(&reader, 1, INT64_MAX);
        lp_read_text(&reader, style, sizeof style);
        const int64_t prior = lp_read_integer(&reader, 0, INT64_MAX);
        if (reader.bad) {
            status = lp_store_fail_profile(store, id, reader.bad, error);
            break;
        }
        choose(chosen, id, lp_fits_style(style, key->style), prior);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    return status;
}

/* ---- their mean ---- */

/* Sums over the profiles, each times its weight. */
typedef struct sums {
    double weight, shared, independent; /* of 1/s^2; of the errors that all share, w s; of the others, w^2 s^2 */
    double table[3][LENSPROF_RESPONSE_SAMPLES];
    double emor[3][LENSPROF_EMOR_MODES];
    double covariance[LENSPROF_EMOR_MODES * LENSPROF_EMOR_MODES];
    uint32_t modes[3];
    bool is_emor, has_covariance;
} sums;

static void add_profile(sums *all, const lensprof_profile *profile, double sigma, bool is_shared) {
    const double w = 1.0 / (sigma * sigma);
    const uint32_t n = profile->covariance_size, modes = profile->response[0].modes;
    all->weight += w;
    *(is_shared ? &all->shared : &all->independent) += is_shared ? w * sigma : w * w * sigma * sigma;
    for (uint32_t c = 0; c < 3; c++) {
        const lensprof_response *response = &profile->response[profile->responses == 3 ? c : 0];
        all->is_emor &= response->kind == LENSPROF_RESPONSE_EMOR;
        for (uint32_t j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) all->table[c][j] += w * response->table[j];
        for (uint32_t l = 0; l < LENSPROF_EMOR_MODES && l < response->modes; l++)
            all->emor[c][l] += w * response->emor[l];
        if (response->modes > all->modes[c]) all->modes[c] = response->modes;
    }
    all->has_covariance &= all->is_emor && profile->responses == 1 && n >= modes;
    for (uint32_t i = 0; i < modes && all->has_covariance; i++)
        for (uint32_t j = 0; j < modes; j++)
            all->covariance[i * LENSPROF_EMOR_MODES + j] += w * profile->covariance[i * n + j];
}

/* The mean as a response: of EMoR responses an EMoR response, else a table. */
static lensprof_status take_mean(const sums *all, uint32_t c, lensprof_response *response) {
    double mean[LENSPROF_RESPONSE_SAMPLES];
    if (all->is_emor) {
        for (uint32_t l = 0; l < all->modes[c]; l++) mean[l] = all->emor[c][l] / all->weight;
        if (lensprof_response_set_emor(response, mean, all->modes[c]) == LENSPROF_OK) return LENSPROF_OK;
    }
    for (uint32_t j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) mean[j] = all->table[c][j] / all->weight;
    mean[0] = 0.0, mean[LENSPROF_RESPONSE_SAMPLES - 1] = 1.0;
    return lensprof_response_set_table(response, mean, LENSPROF_RESPONSE_SAMPLES);
}

/* The one profile's response as it is, and its block of the covariance. */
static void take_one(const lensprof_profile *profile, lp_response_answer *answer) {
    const uint32_t n = profile->covariance_size;
    memcpy(answer->response, profile->response, sizeof answer->response);
    answer->responses = profile->responses;
    answer->modes = lp_covariance_modes(profile->response, profile->responses);
    if (answer->modes > n) answer->modes = 0;
    for (uint32_t i = 0; i < answer->modes; i++)
        memcpy(&answer->covariance[i * answer->modes], &profile->covariance[i * n], answer->modes * sizeof(double));
}

/* variance: of ln gamma of the mean, by what the profiles state. */
static lensprof_status take_several(const sums *all, double variance, lp_response_answer *answer) {
    const uint32_t modes = all->modes[0];
    for (uint32_t c = 0; c < answer->responses; c++) {
        const lensprof_status status = take_mean(all, c, &answer->response[c]);
        if (status != LENSPROF_OK) return status;
    }
    answer->modes = all->has_covariance && answer->response[0].kind == LENSPROF_RESPONSE_EMOR ? modes : 0;
    /* the profiles' mean covariance, as far as the mean is surer of gamma than they are: rows / weight is their s^2 */
    const double scale = variance * all->weight / answer->rows;
    for (uint32_t i = 0; i < answer->modes; i++)
        for (uint32_t j = 0; j < answer->modes; j++)
            answer->covariance[i * modes + j] = scale * all->covariance[i * LENSPROF_EMOR_MODES + j] / all->weight;
    return LENSPROF_OK;
}

/* Fuses the chosen profiles. Profiles that know gamma less well than the typical response, which `answer` holds, depend
 * on a wider prior and are left out. */
static lensprof_status fuse(lensprof_store *store, const choice *chosen, lp_response_answer *answer,
                            lensprof_error *error) {
    const double typical = answer->sigma;
    sums all;
    memset(&all, 0, sizeof all);
    all.is_emor = all.has_covariance = true;
    for (uint32_t i = 0; i < chosen->count; i++) {
        lensprof_status status = lp_store_fetch(store, chosen->id[i], error);
        if (status != LENSPROF_OK) return status;
        const lensprof_profile *profile = &store->scratch;
        double sigma = lp_stated_gamma_sigma(profile);
        if (sigma > typical * (1.0 + 1e-9)) continue;
        sigma = sigma == LENSPROF_UNKNOWN ? typical : fmax(sigma, LEAST_SIGMA);
        add_profile(&all, profile, sigma, sigma >= SHARED * typical);
        if (profile->responses == 3) answer->responses = 3;
        answer->id[answer->rows] = chosen->id[i];
        answer->weight[answer->rows++] = 1.0 / (sigma * sigma);
    }
    if (!answer->rows) return LENSPROF_OK;
    answer->from = LENSPROF_RESPONSE_FROM_CAMERA;
    const double variance = (all.shared * all.shared + all.independent) / (all.weight * all.weight);
    answer->sigma = sqrt(variance + REPEATABILITY * REPEATABILITY);
    for (uint32_t i = 0; i < answer->rows; i++) answer->weight[i] /= all.weight;
    lensprof_status status = LENSPROF_OK;
    if (answer->rows == 1) {
        if (answer->id[0] != chosen->id[chosen->count - 1]) status = lp_store_fetch(store, answer->id[0], error);
        if (status != LENSPROF_OK) return status;
        take_one(&store->scratch, answer);
    } else if (take_several(&all, variance, answer) != LENSPROF_OK)
        return lp_store_fail_profile(store, answer->id[0], "invalid response", error);
    widen(answer);
    return LENSPROF_OK;
}

/* A name of signs alone is that of profiles without a camera. */
static bool has_letters(const char *model) {
    char squeezed[LP_NAME_BYTES];
    lp_squeeze(model, squeezed);
    return *squeezed != 0;
}

lensprof_status lp_find_response(lensprof_store *store, const lensprof_profile_key *key,
                                 const lensprof_lookup_options *o, lp_response_answer *answer, lensprof_error *error) {
    choice chosen;
    if (key->processing == LENSPROF_PROCESSING_RAW || !has_letters(key->camera_model)) return LENSPROF_OK;
    const lensprof_status status = choose_profiles(store, key, o, &chosen, error);
    if (status != LENSPROF_OK) return status;
    answer->has_other_style |= chosen.has_other_style;
    return chosen.count ? fuse(store, &chosen, answer, error) : LENSPROF_OK;
}
