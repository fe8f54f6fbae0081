/* Profiles of another database, as they are. */
#include "store_private.h"

#include <string.h>

#include "store_names.h"

/* Rows of `profiles` with every column as lp_store_bind_profile binds it: the first three lines are the way through the
 * index profiles_by_key, the others are to the letter and bit. */
static const char equal_rows[] =
    "SELECT id FROM profiles WHERE trim(camera_maker) COLLATE NOCASE = trim(?1)"
    " AND trim(camera_model) COLLATE NOCASE = trim(?2) AND trim(lens) COLLATE NOCASE = trim(?3)"
    " AND focal_mm IS ?4 AND aperture IS ?5 AND distance_m IS ?6"
    " AND camera_maker = ?1 AND camera_model = ?2 AND lens = ?3 AND processing = ?7 AND method = ?8 AND software = ?9"
    " AND source = ?10 AND created_unix_s IS ?11 AND images = ?12 AND pairs = ?13 AND heldout_rms IS ?14"
    " AND inlier_share IS ?15 AND response_curves = ?16 AND vignetting_curves = ?17 AND covariance_size = ?18"
    " AND covariance IS ?19 AND gain_grids = ?20 AND unit = ?21 AND crop_factor IS ?22 AND doubt = ?23 AND lens_name = ?24";

static bool have_same_curves(const lensprof_profile *a, const lensprof_profile *b)
{
    return !memcmp(a->response, b->response, a->responses * sizeof *a->response)
        && !memcmp(a->vignetting, b->vignetting, a->vignettings * sizeof *a->vignetting)
        && !memcmp(&a->grid, &b->grid, sizeof a->grid);
}

/* Whether the store has this profile, with the same provenance. */
static lensprof_status is_there(lensprof_store *store, const lensprof_profile *profile, bool *there,
                                lensprof_error *error)
{
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    char lens_name[LP_NAME_BYTES];
    *there = false;
    lensprof_status status = lp_store_prepare(store, equal_rows, &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_squeeze(profile->key.lens, lens_name);
    lp_store_bind_profile(&binder, profile, lens_name);
    int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    while (rc == SQLITE_ROW && status == LENSPROF_OK && !*there) {
        status = lp_store_fetch(store, sqlite3_column_int64(binder.statement, 0), error);
        if (status != LENSPROF_OK) break;
        *there = have_same_curves(&store->scratch, profile);
        if (!*there) rc = sqlite3_step(binder.statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_ROW && rc != SQLITE_DONE)
        status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    return status;
}

typedef struct counts {
    uint32_t added, known;
} counts;

static lensprof_status take(lensprof_store *store, lensprof_store *other, int64_t id, counts *count,
                            lensprof_error *error)
{
    bool there;
    int64_t made;
    lensprof_status status = lp_store_fetch(other, id, error);
    if (status == LENSPROF_OK) status = is_there(store, &other->scratch, &there, error);
    if (status != LENSPROF_OK) return status;
    if (there) count->known++;
    else count->added++;
    return there ? LENSPROF_OK : lp_store_insert(store, &other->scratch, &made, error);
}

/* The oldest first, so that the newest of a key stays the newest. */
static lensprof_status take_all(lensprof_store *store, lensprof_store *other, counts *count, lensprof_error *error)
{
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_prepare(other, "SELECT id FROM profiles ORDER BY id", &statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(statement);
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        status = take(store, other, sqlite3_column_int64(statement, 0), count, error);
        if (status == LENSPROF_OK) rc = sqlite3_step(statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(other->path, other->db, rc, error);
    lp_store_release(other, statement);
    return status;
}

lensprof_status lensprof_store_merge(lensprof_store *store, lensprof_store *other, uint32_t *added, uint32_t *known,
                                     lensprof_error *error)
{
    counts count = {0, 0};
    lp_store_clear(error);
    if (!store || !other) return lp_store_fail_argument("store or other is NULL", error);
    if (store == other || !strcmp(sqlite3_db_filename(store->db, "main"), sqlite3_db_filename(other->db, "main")))
        return lp_store_fail(other->path, LENSPROF_ERROR_ARGUMENT, "is the database itself",
                             "name another one to be merged into it", error);
    lensprof_status status = lp_store_begin(store, true, error);
    if (status != LENSPROF_OK) return status;
    status = lp_store_begin(other, false, error);
    if (status == LENSPROF_OK) {
        status = take_all(store, other, &count, error);
        lp_store_rollback(other);
    }
    if (status == LENSPROF_OK) status = lp_store_commit(store, error);
    else lp_store_rollback(store);
    if (status == LENSPROF_OK && added) *added = count.added;
    if (status == LENSPROF_OK && known) *known = count.known;
    return status;
}
