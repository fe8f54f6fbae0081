/* Adding and removing profiles. */
#include "store/profiles/profiles.h"

#include <math.h>
#include <stdio.h>

#include "core/profile.h"
#include "store/names/names.h"

#define SAME_CURVE 1e-9 /* of the grey range; far below what a picture can show */

/* What is stored of a response must give the same curve again. */
static bool is_consistent(const lensprof_response *response) {
    lensprof_response rebuilt;
    if (lp_store_rebuild(response, &rebuilt) != LENSPROF_OK) return false;
    for (uint32_t j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++)
        if (!(fabs(rebuilt.table[j] - response->table[j]) <= SAME_CURVE)) return false;
    return true;
}

static lensprof_status check_profile(lensprof_store *store, const lensprof_profile *profile, lensprof_error *error) {
    lensprof_status status = lp_store_check_size(profile, error);
    if (status != LENSPROF_OK) return status;
    status = lensprof_profile_validate(profile);
    if (status != LENSPROF_OK) {
        char problem[80];
        snprintf(problem, sizeof problem, "the profile is invalid (%s)", lensprof_status_name(status));
        return lp_store_fail(store->path, status, problem, "nothing was stored; correct the profile", error);
    }
    if (profile->provenance.not_usable && !profile->provenance.forced)
        return lp_store_fail(store->path, LENSPROF_ERROR_ARGUMENT, "the fit of this profile was not usable",
                             "nothing was stored; set provenance.forced to store it anyway", error);
    for (uint32_t c = 0; c < profile->responses; c++)
        if (!is_consistent(&profile->response[c]))
            return lp_store_fail(store->path, LENSPROF_ERROR_RESPONSE,
                                 "the table of a response is not the curve that its kind and numbers describe",
                                 "make it with lensprof_response_set_...", error);
    return LENSPROF_OK;
}

static void bind_levels(lp_store_binder *binder, lensprof_levels levels) {
    const double numbers[4] = {levels.black[0], levels.black[1], levels.black[2], levels.white};
    for (int i = 0; i < 4; i++) {
        if (numbers[i] != 0.0)
            lp_bind_real(binder, numbers[i]);
        else
            lp_bind_null(binder);
    }
}

static void bind_circle(lp_store_binder *binder, lensprof_image_circle circle) {
    const double numbers[3] = {circle.center[0], circle.center[1], circle.radius};
    for (int i = 0; i < 3; i++) {
        if (circle.radius > 0.0)
            lp_bind_real(binder, numbers[i]);
        else
            lp_bind_null(binder);
    }
}

void lp_store_bind_profile(lp_store_binder *binder, const lensprof_profile *profile, const char *lens_name) {
    const lensprof_profile_key *key = &profile->key;
    const lensprof_provenance *provenance = &profile->provenance;
    lp_bind_text(binder, key->camera_maker);
    lp_bind_text(binder, key->camera_model);
    lp_bind_text(binder, key->lens);
    lp_bind_known(binder, key->focal_mm);
    lp_bind_known(binder, key->aperture);
    lp_bind_known(binder, key->distance_m);
    lp_bind_text(binder, lp_store_processings[key->processing]);
    lp_bind_text(binder, provenance->method);
    lp_bind_text(binder, provenance->software);
    lp_bind_text(binder, provenance->source);
    if (provenance->created_unix_s)
        lp_bind_integer(binder, provenance->created_unix_s);
    else
        lp_bind_null(binder);
    lp_bind_integer(binder, provenance->images);
    lp_bind_integer(binder, provenance->pairs);
    lp_bind_known(binder, provenance->heldout_rms);
    lp_bind_known(binder, provenance->inlier_share);
    lp_bind_integer(binder, profile->responses);
    lp_bind_integer(binder, profile->vignettings);
    lp_bind_integer(binder, profile->covariance_size);
    if (profile->covariance_size)
        lp_bind_doubles(binder, profile->covariance, profile->covariance_size * profile->covariance_size);
    else
        lp_bind_null(binder);
    lp_bind_integer(binder, profile->grid.columns > 0);
    lp_bind_text(binder, key->unit);
    lp_bind_known(binder, key->crop_factor);
    lp_bind_text(binder, provenance->doubt);
    lp_bind_text(binder, lens_name);
    lp_bind_known(binder, key->color_temperature_k);
    if (provenance->prior_id)
        lp_bind_integer(binder, provenance->prior_id);
    else
        lp_bind_null(binder);
    lp_bind_integer(binder, provenance->forced);
    lp_bind_text(binder, key->style);
    if (provenance->gamma_sigma > 0.0)
        lp_bind_real(binder, provenance->gamma_sigma);
    else
        lp_bind_null(binder);
    bind_levels(binder, lp_profile_levels(profile));
    bind_circle(binder, lp_profile_circle(profile));
}

/* With AUTOINCREMENT no id is used twice: where a row has or had the last one, no row can follow, and an INSERT would
 * report a full disk and take the caller's transaction back. */
static lensprof_status check_ids(lensprof_store *store, lensprof_error *error) {
    int64_t last = 0;
    const int rc = lp_store_integer(store,
                                    "SELECT max(ifnull((SELECT max(id) FROM profiles), 0),"
                                    " ifnull((SELECT max(seq) FROM sqlite_sequence WHERE name = 'profiles'), 0))",
                                    &last);
    if (rc) return lp_store_fail_sql(store->path, store->db, rc, error);
    if (last < INT64_MAX) return LENSPROF_OK;
    return lp_store_fail(store->path, LENSPROF_ERROR_FULL, "no free ids: a profile has or had the last one",
                         "merge it into a new database, where ids begin at 1", error);
}

static lensprof_status put_profile(lensprof_store *store, const lensprof_profile *profile, int64_t *id,
                                   lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(
        store,
        "INSERT INTO profiles (camera_maker, camera_model, lens, focal_mm, aperture, distance_m, processing,"
        " method, software, source, created_unix_s, images, pairs, heldout_rms, inlier_share,"
        " response_curves, vignetting_curves, covariance_size, covariance, gain_grids, unit, crop_factor, doubt, lens_name,"
        " color_temperature_k, prior_id, forced, style, gamma_sigma, black_red, black_green, black_blue, white_level,"
        " circle_x, circle_y, circle_radius)"
        " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    char lens_name[LP_NAME_BYTES]; /* bound as it is: until the statement has run */
    lp_squeeze(profile->key.lens, lens_name);
    lp_store_bind_profile(&binder, profile, lens_name);
    status = lp_store_run(store, &binder, error);
    *id = sqlite3_last_insert_rowid(store->db);
    return status;
}

lensprof_status lp_store_insert(lensprof_store *store, const lensprof_profile *profile, int64_t *id,
                                lensprof_error *error) {
    lensprof_status status = check_ids(store, error);
    if (status == LENSPROF_OK) status = put_profile(store, profile, id, error);
    return status == LENSPROF_OK ? lp_store_put_curves(store, *id, profile, error) : status;
}

lensprof_status lensprof_store_put(lensprof_store *store, const lensprof_profile *profile, int64_t *id,
                                   lensprof_error *error) {
    int64_t made = 0;
    lp_store_clear(error);
    if (!store || !profile) return lp_store_fail_argument("store or profile is NULL", error);
    lensprof_status status = check_profile(store, profile, error);
    if (status == LENSPROF_OK) status = lp_store_begin(store, true, error);
    if (status != LENSPROF_OK) return status;
    status = lp_store_insert(store, profile, &made, error);
    if (status == LENSPROF_OK)
        status = lp_store_commit(store, error);
    else
        lp_store_rollback(store);
    if (status == LENSPROF_OK && id) *id = made;
    return status;
}

static lensprof_status remove_profile(lensprof_store *store, int64_t id, lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(store, "DELETE FROM profiles WHERE id = ?", &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_integer(&binder, id);
    status = lp_store_run(store, &binder, error);
    if (status != LENSPROF_OK) return status;
    return sqlite3_changes(store->db) ? LENSPROF_OK : lp_store_fail_missing(store, id, error);
}

lensprof_status lensprof_store_remove(lensprof_store *store, int64_t id, lensprof_error *error) {
    lp_store_clear(error);
    if (!store) return lp_store_fail_argument("store is NULL", error);
    lensprof_status status = lp_store_begin(store, true, error);
    if (status != LENSPROF_OK) return status;
    status = remove_profile(store, id, error);
    if (status == LENSPROF_OK) return lp_store_commit(store, error);
    lp_store_rollback(store);
    return status;
}

static lensprof_status set_key(lensprof_store *store, int64_t id, const lensprof_profile_key *key,
                               lensprof_error *error) {
    char lens_name[LP_NAME_BYTES]; /* bound as it is: until the statement has run */
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(
        store,
        "UPDATE profiles SET camera_maker = ?, camera_model = ?, lens = ?, unit = ?, crop_factor = ?, focal_mm = ?,"
        " aperture = ?, distance_m = ?, color_temperature_k = ?, style = ?, processing = ?, lens_name = ? WHERE id = ?",
        &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_store_bind_key(&binder, key);
    lp_bind_text(&binder, lp_store_processings[key->processing]);
    lp_squeeze(key->lens, lens_name);
    lp_bind_text(&binder, lens_name);
    lp_bind_integer(&binder, id);
    status = lp_store_run(store, &binder, error);
    if (status != LENSPROF_OK) return status;
    return sqlite3_changes(store->db) ? LENSPROF_OK : lp_store_fail_missing(store, id, error);
}

lensprof_status lensprof_store_set_key(lensprof_store *store, int64_t id, const lensprof_profile_key *key,
                                       lensprof_error *error) {
    lp_store_clear(error);
    if (!store || !key) return lp_store_fail_argument("store or key is NULL", error);
    if (lensprof_profile_key_validate(key) != LENSPROF_OK)
        return lp_store_fail_argument("the key is invalid; see lensprof_profile_key", error);
    lensprof_status status = lp_store_begin(store, true, error);
    if (status != LENSPROF_OK) return status;
    status = set_key(store, id, key, error);
    if (status == LENSPROF_OK) return lp_store_commit(store, error);
    lp_store_rollback(store);
    return status;
}
