/* Finding, fetching and listing profiles. */
#include "store/profiles/profiles.h"

#include <stdlib.h>
#include <string.h>

#include "store/profiles/layouts.h"

const char *const lp_store_processings[LP_STORE_PROCESSINGS] = {"raw", "jpeg", "corrected"};

/* clang-format off */
#define ROW_COLUMNS \
    "id, camera_maker, camera_model, lens, unit, crop_factor, focal_mm, aperture, distance_m, color_temperature_k," \
    " style, processing, method, software, source, created_unix_s, images, pairs, heldout_rms, inlier_share, doubt, prior_id," \
    " forced, gamma_sigma"
/* clang-format on */

/* Texts are equal without ASCII case and outer blanks. */
#define SAME_TEXT(column, value) "trim(" column ") COLLATE NOCASE = trim(" value ")"
/* Numbers are equal to 1e-6 of the smaller one, so that infinity equals infinity (IS) and nothing else. */
#define SAME_NUMBER(column, value) \
    "(" column " IS " value " OR abs(" column " - " value ") <= 1e-6 * min(" column ", " value "))"
#define ANY_TEXT(column, value) "(trim(" value ") = '' OR " SAME_TEXT(column, value) ")"
#define ANY_NUMBER(column, value) "(" value " IS NULL OR " SAME_NUMBER(column, value) ")"

void lp_store_bind_key(lp_store_binder *binder, const lensprof_profile_key *key) {
    lp_bind_text(binder, key->camera_maker);
    lp_bind_text(binder, key->camera_model);
    lp_bind_text(binder, key->lens);
    lp_bind_text(binder, key->unit);
    lp_bind_known(binder, key->crop_factor);
    lp_bind_known(binder, key->focal_mm);
    lp_bind_known(binder, key->aperture);
    lp_bind_known(binder, key->distance_m);
    lp_bind_known(binder, key->color_temperature_k);
    lp_bind_text(binder, key->style);
}

/* Columns ROW_COLUMNS. Texts are zero-filled. The caller validates key and provenance. */
static void read_row(lp_store_reader *reader, lensprof_store_row *row) {
    lensprof_profile_key *key = &row->key;
    lensprof_provenance *provenance = &row->provenance;
    memset(row, 0, sizeof *row);
    lensprof_profile_key_init(key);
    row->id = lp_read_integer(reader, 1, INT64_MAX);
    lp_read_text(reader, key->camera_maker, sizeof key->camera_maker);
    lp_read_text(reader, key->camera_model, sizeof key->camera_model);
    lp_read_text(reader, key->lens, sizeof key->lens);
    lp_read_text(reader, key->unit, sizeof key->unit);
    key->crop_factor = lp_read_known(reader);
    key->focal_mm = lp_read_known(reader);
    key->aperture = lp_read_known(reader);
    key->distance_m = lp_read_known(reader);
    key->color_temperature_k = lp_read_known(reader);
    lp_read_text(reader, key->style, sizeof key->style);
    key->processing = lp_read_name(reader, lp_store_processings, LP_STORE_PROCESSINGS);
    lp_read_text(reader, provenance->method, sizeof provenance->method);
    lp_read_text(reader, provenance->software, sizeof provenance->software);
    lp_read_text(reader, provenance->source, sizeof provenance->source);
    if (!lp_read_null(reader)) provenance->created_unix_s = lp_read_integer(reader, INT64_MIN, INT64_MAX);
    provenance->images = (uint32_t)lp_read_integer(reader, 0, UINT32_MAX);
    provenance->pairs = (uint32_t)lp_read_integer(reader, 0, UINT32_MAX);
    provenance->heldout_rms = lp_read_known(reader);
    provenance->inlier_share = lp_read_known(reader);
    lp_read_text(reader, provenance->doubt, sizeof provenance->doubt);
    if (!lp_read_null(reader)) provenance->prior_id = lp_read_integer(reader, 1, INT64_MAX);
    provenance->forced = (uint32_t)lp_read_integer(reader, 0, 1);
    if (!lp_read_null(reader)) provenance->gamma_sigma = lp_read_real(reader);
}

static void read_levels(lp_store_reader *reader, lensprof_levels *levels) {
    double *const numbers[4] = {&levels->black[0], &levels->black[1], &levels->black[2], &levels->white};
    for (int i = 0; i < 4; i++)
        if (!lp_read_null(reader)) *numbers[i] = lp_read_real(reader);
}

/* All three or none. */
static void read_circle(lp_store_reader *reader, lensprof_image_circle *circle) {
    double *const numbers[3] = {&circle->center[0], &circle->center[1], &circle->radius};
    const bool is_whole = sqlite3_column_type(reader->statement, reader->column) != SQLITE_NULL;
    for (int i = 0; i < 3; i++) {
        if (is_whole)
            *numbers[i] = lp_read_real(reader);
        else
            lp_read_nothing(reader);
    }
}

/* From the row at which `statement` stands, and its curves, into store->scratch. */
static lensprof_status read_profile(lensprof_store *store, sqlite3_stmt *statement, bool with_response, int64_t *id,
                                    lensprof_error *error) {
    lensprof_store_row row;
    lensprof_profile *profile = &store->scratch;
    lp_store_reader reader = {statement, 0, NULL};
    lensprof_profile_init(profile);
    read_row(&reader, &row);
    profile->key = row.key;
    profile->provenance = row.provenance;
    profile->responses = (uint32_t)lp_read_integer(&reader, 1, 3); /* lensprof_profile_validate refuses 2 */
    profile->vignettings = (uint32_t)lp_read_integer(&reader, 1, 3);
    profile->covariance_size = (uint32_t)lp_read_integer(&reader, 0, LENSPROF_COVARIANCE_MAX);
    if (profile->covariance_size)
        lp_read_doubles(&reader, profile->covariance, profile->covariance_size * profile->covariance_size);
    else
        lp_read_nothing(&reader);
    uint32_t grids = (uint32_t)lp_read_integer(&reader, 0, 1);
    read_levels(&reader, &profile->levels);
    read_circle(&reader, &profile->image_circle);
    *id = sqlite3_column_int64(statement, 0);
    if (reader.bad) return lp_store_fail_profile(store, *id, reader.bad, error);
    lensprof_status status = lp_store_read_curves(store, *id, with_response, grids, error);
    if (status != LENSPROF_OK) return status;
    status = lensprof_profile_validate(profile);
    return status == LENSPROF_OK ? LENSPROF_OK : lp_store_fail_profile(store, *id, lensprof_status_name(status), error);
}

/* clang-format off */
#define SELECT_PROFILE \
    "SELECT " ROW_COLUMNS ", response_curves, vignetting_curves, covariance_size, covariance, gain_grids, black_red," \
    " black_green, black_blue, white_level, circle_x, circle_y, circle_radius FROM profiles" \
    " WHERE "
#define WITH_KEY \
    SAME_TEXT("camera_maker", "?1") " AND " SAME_TEXT("camera_model", "?2") " AND " SAME_TEXT("lens", "?3") " AND " \
    SAME_TEXT("unit", "?4") " AND " SAME_NUMBER("crop_factor", "?5") " AND " SAME_NUMBER("focal_mm", "?6") " AND " \
    SAME_NUMBER("aperture", "?7") " AND " SAME_NUMBER("distance_m", "?8") " AND " \
    SAME_NUMBER("color_temperature_k", "?9") " AND " SAME_TEXT("style", "?10") " AND processing = ?11 ORDER BY id DESC LIMIT 1"
#define LIST /* one order for all: that of the index profiles_by_key */ \
    "SELECT " ROW_COLUMNS " FROM profiles WHERE " \
    ANY_TEXT("camera_maker", "?1") " AND " ANY_TEXT("camera_model", "?2") " AND " ANY_TEXT("lens", "?3") " AND " \
    ANY_TEXT("unit", "?4") " AND " ANY_NUMBER("crop_factor", "?5") " AND " ANY_NUMBER("focal_mm", "?6") " AND " \
    ANY_NUMBER("aperture", "?7") " AND " ANY_NUMBER("distance_m", "?8") " AND " \
    ANY_NUMBER("color_temperature_k", "?9") " AND " ANY_TEXT("style", "?10") \
    " ORDER BY trim(camera_maker) COLLATE NOCASE, trim(camera_model) COLLATE NOCASE, trim(lens) COLLATE NOCASE," \
    " focal_mm, aperture, distance_m, id"
/* clang-format on */

static const char *const find_sql[LP_STORE_LAYOUT] = LP_BY_LAYOUT(SELECT_PROFILE WITH_KEY);
static const char *const get_sql[LP_STORE_LAYOUT] = LP_BY_LAYOUT(SELECT_PROFILE "id = ?1");
static const char *const list_sql[LP_STORE_LAYOUT] = LP_BY_LAYOUT(LIST);

/* Reads the profile with `key`, or with `*id` when key is NULL, into store->scratch. */
static lensprof_status fetch(lensprof_store *store, const lensprof_profile_key *key, bool with_response, int64_t *id,
                             lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    const char *sql = lp_store_of_layout(store, key ? find_sql : get_sql);
    lensprof_status status = lp_store_prepare(store, sql, &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    if (key) {
        lp_store_bind_key(&binder, key);
        lp_bind_text(&binder, lp_store_processings[key->processing]);
    } else
        lp_bind_integer(&binder, *id);
    int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    if (rc == SQLITE_ROW)
        status = read_profile(store, binder.statement, with_response, id, error);
    else if (rc != SQLITE_DONE)
        status = lp_store_fail_sql(store->path, store->db, rc, error);
    else if (!key)
        status = lp_store_fail_missing(store, *id, error);
    else
        status = lp_store_fail(store->path, LENSPROF_ERROR_NOT_FOUND, "has no profile with this key",
                               "list the profiles to see the valid keys", error);
    lp_store_release(store, binder.statement);
    return status;
}

lensprof_status lp_store_fetch(lensprof_store *store, int64_t id, lensprof_error *error) {
    return fetch(store, NULL, true, &id, error);
}

lensprof_status lp_store_fetch_falloff(lensprof_store *store, int64_t id, lensprof_error *error) {
    return fetch(store, NULL, false, &id, error);
}

static lensprof_status fetch_in_transaction(lensprof_store *store, const lensprof_profile_key *key, int64_t *id,
                                            lensprof_error *error) {
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = fetch(store, key, true, id, error);
    lp_store_rollback(store);
    return status;
}

lensprof_status lensprof_store_find(lensprof_store *store, const lensprof_profile_key *key, lensprof_profile *profile,
                                    int64_t *id, lensprof_error *error) {
    int64_t found = 0;
    lp_store_clear(error);
    if (!store || !key || !profile) return lp_store_fail_argument("store, key or profile is NULL", error);
    lensprof_status status = lensprof_profile_key_validate(key);
    if (status != LENSPROF_OK) return lp_store_fail_argument("the key is invalid; see lensprof_profile_key", error);
    status = lp_store_check_size(profile, error);
    if (status == LENSPROF_OK) status = fetch_in_transaction(store, key, &found, error);
    if (status != LENSPROF_OK) return status;
    lp_sized_copy(profile, &store->scratch);
    if (id) *id = found;
    return LENSPROF_OK;
}

lensprof_status lensprof_store_get(lensprof_store *store, int64_t id, lensprof_profile *profile,
                                   lensprof_error *error) {
    lp_store_clear(error);
    if (!store || !profile) return lp_store_fail_argument("store or profile is NULL", error);
    lensprof_status status = lp_store_check_size(profile, error);
    if (status == LENSPROF_OK) status = fetch_in_transaction(store, NULL, &id, error);
    if (status == LENSPROF_OK) lp_sized_copy(profile, &store->scratch);
    return status;
}

/* Rows as they come, in a buffer that grows, so that the caller's stays untouched when a later row fails. */
typedef struct listing {
    lensprof_store_row *rows;
    uint32_t kept, allocated, capacity, found;
} listing;

static bool keep(listing *list, const lensprof_store_row *row) {
    if (list->found < UINT32_MAX) list->found++;
    if (list->kept == list->capacity) return true;
    if (list->kept == list->allocated) {
        uint32_t allocated = list->allocated > list->capacity / 2 ? list->capacity
                             : list->allocated                    ? 2 * list->allocated
                                                                  : 16;
        if (allocated > list->capacity) allocated = list->capacity;
        uint64_t bytes = (uint64_t)allocated * sizeof *list->rows;
        lensprof_store_row *rows = bytes == (size_t)bytes ? realloc(list->rows, (size_t)bytes) : NULL;
        if (!rows) return false;
        list->rows = rows;
        list->allocated = allocated;
    }
    list->rows[list->kept++] = *row;
    return true;
}

/* A row with impossible values is listed by its id alone. */
static void make_damaged(lensprof_store_row *row, int64_t id) {
    memset(row, 0, sizeof *row);
    row->id = id;
    row->damaged = 1;
    lensprof_profile_key_init(&row->key);
    row->provenance.heldout_rms = row->provenance.inlier_share = LENSPROF_UNKNOWN;
}

static lensprof_status list_row(lensprof_store *store, sqlite3_stmt *statement, listing *list, lensprof_error *error) {
    lensprof_store_row row;
    lp_store_reader reader = {statement, 0, NULL};
    read_row(&reader, &row);
    if (reader.bad && sqlite3_errcode(store->db) == SQLITE_NOMEM) /* a column could not be fetched */
        return lp_store_fail_sql(store->path, store->db, SQLITE_NOMEM, error);
    store->scratch.key = row.key; /* the rest of it is valid */
    store->scratch.provenance = row.provenance;
    if (reader.bad || lensprof_profile_validate(&store->scratch) != LENSPROF_OK)
        make_damaged(&row, sqlite3_column_int64(statement, 0));
    return keep(list, &row) ? LENSPROF_OK : lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
}

static lensprof_status list_rows(lensprof_store *store, const lensprof_profile_key *filter, listing *list,
                                 lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(store, lp_store_of_layout(store, list_sql), &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_store_bind_key(&binder, filter);
    lensprof_profile_init(&store->scratch);
    int rc = binder.rc;
    if (rc == SQLITE_OK) rc = sqlite3_step(binder.statement);
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        status = list_row(store, binder.statement, list, error);
        if (status == LENSPROF_OK) rc = sqlite3_step(binder.statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    return status;
}

lensprof_status lensprof_store_list(lensprof_store *store, const lensprof_profile_key *filter, lensprof_store_row *rows,
                                    uint32_t capacity, uint32_t *count, lensprof_error *error) {
    lensprof_profile_key any;
    listing list = {NULL, 0, 0, capacity, 0};
    lp_store_clear(error);
    if (!store || !count || (capacity && !rows)) return lp_store_fail_argument("store, rows or count is NULL", error);
    lensprof_profile_key_init(&any);
    if (!filter) filter = &any;
    if (lensprof_profile_key_validate(filter) != LENSPROF_OK)
        return lp_store_fail_argument("the filter is invalid; see lensprof_profile_key", error);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = list_rows(store, filter, &list, error);
    lp_store_rollback(store);
    if (status == LENSPROF_OK) {
        *count = list.found;
        if (capacity && list.found > capacity)
            status = lp_store_fail_capacity(list.found, capacity, error);
        else if (list.kept)
            memcpy(rows, list.rows, list.kept * sizeof *rows);
    }
    free(list.rows);
    return status;
}
