/* Whether a profile is there already: the one rule of merging and importing. */
#include "store/profiles/profiles.h"

#include <string.h>

#include "store/names/names.h"

/* Rows of `profiles` with the columns as lp_store_bind_profile binds them, but method, software, prior_id and forced:
 * which profile is in one, and which version of a program made it, make no other. The first three lines are the way
 * through the index profiles_by_key, the others are to the letter and bit. */
static const char equal_rows[] =
    "SELECT id FROM profiles WHERE trim(camera_maker) COLLATE NOCASE = trim(?1)"
    " AND trim(camera_model) COLLATE NOCASE = trim(?2) AND trim(lens) COLLATE NOCASE = trim(?3)"
    " AND focal_mm IS ?4 AND aperture IS ?5 AND distance_m IS ?6"
    " AND camera_maker = ?1 AND camera_model = ?2 AND lens = ?3 AND processing = ?7"
    " AND source = ?10 AND created_unix_s IS ?11 AND images = ?12 AND pairs = ?13 AND heldout_rms IS ?14"
    " AND inlier_share IS ?15 AND response_curves = ?16 AND vignetting_curves = ?17 AND covariance_size = ?18"
    " AND covariance IS ?19 AND gain_grids = ?20 AND unit = ?21 AND crop_factor IS ?22 AND doubt = ?23 AND lens_name = ?24"
    " AND color_temperature_k IS ?25 AND style = ?28 AND gamma_sigma IS ?29"
    " AND black_red IS ?30 AND black_green IS ?31 AND black_blue IS ?32 AND white_level IS ?33"
    " AND circle_x IS ?34 AND circle_y IS ?35 AND circle_radius IS ?36"
    " AND EXISTS (SELECT 1 FROM vignettings WHERE profile_id = id AND curve = 0 AND k1 = ?37 AND k2 = ?38 AND k3 = ?39)";

/* Values, not bits: a database has no -0. */
static bool are_equal(const double *a, const double *b, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        if (a[i] != b[i]) return false;
    return true;
}

static bool have_same_curves(const lensprof_profile *a, const lensprof_profile *b) {
    for (uint32_t c = 0; c < a->responses; c++) {
        const lensprof_response *r = &a->response[c], *s = &b->response[c];
        if (r->kind != s->kind) return false;
        if (r->kind == LENSPROF_RESPONSE_GAMMA && r->gamma != s->gamma) return false;
        if (r->kind == LENSPROF_RESPONSE_EMOR && (r->modes != s->modes || !are_equal(r->emor, s->emor, r->modes)))
            return false;
        if (r->kind == LENSPROF_RESPONSE_TABLE && !are_equal(r->table, s->table, LENSPROF_RESPONSE_SAMPLES))
            return false; /* for other kinds the parameters suffice */
    }
    for (uint32_t c = 0; c < a->vignettings; c++) {
        const lensprof_vignetting *v = &a->vignetting[c], *w = &b->vignetting[c];
        if (!are_equal(v->k, w->k, 3) || !are_equal(v->center, w->center, 2)) return false;
    }
    return !memcmp(&a->grid, &b->grid, sizeof a->grid);
}

lensprof_status lp_store_find_same(lensprof_store *store, const lensprof_profile *profile, int64_t *id,
                                   lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    char lens_name[LP_NAME_BYTES];
    bool same = false;
    lensprof_status status = lp_store_prepare(store, equal_rows, &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_squeeze(profile->key.lens, lens_name);
    lp_store_bind_profile(&binder, profile, lens_name);
    for (int n = 0; n < 3; n++) lp_bind_real(&binder, profile->vignetting[0].k[n]);
    int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    while (rc == SQLITE_ROW && status == LENSPROF_OK && !same) {
        *id = sqlite3_column_int64(binder.statement, 0);
        status = lp_store_fetch(store, *id, error);
        same = status == LENSPROF_OK && have_same_curves(&store->scratch, profile);
        if (status == LENSPROF_OK && !same) rc = sqlite3_step(binder.statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_ROW && rc != SQLITE_DONE)
        status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    if (!same) *id = 0;
    return status;
}

lensprof_status lensprof_store_find_same(lensprof_store *store, const lensprof_profile *profile, int64_t *id,
                                         lensprof_error *error) {
    int64_t found = 0;
    lp_store_clear(error);
    if (!store || !profile || !id) return lp_store_fail_argument("store, profile or id is NULL", error);
    lensprof_status status = lp_store_check_size(profile, error);
    if (status != LENSPROF_OK) return status;
    status = lensprof_profile_validate(profile);
    if (status != LENSPROF_OK) {
        (void)lp_store_fail_argument("the profile is invalid; see lensprof_profile_validate", error);
        return status;
    }
    status = lp_store_begin(store, true, error); /* whose layout is the newest */
    if (status != LENSPROF_OK) return status;
    status = lp_store_find_same(store, profile, &found, error);
    lp_store_rollback(store);
    if (status == LENSPROF_OK) *id = found;
    return status;
}
