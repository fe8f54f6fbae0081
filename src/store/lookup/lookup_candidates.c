/* The rows that a lookup may use, found by the names of lens and camera. */
#include "store/lookup/lookup_candidates.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/profile.h"
#include "store/names/names.h"
#include "store/profiles/layouts.h"

#define BUILT_IN_SCORE 0.6 /* of a lens that was found by its camera */
#define SHORTEST_CAMERA 3  /* characters of a name that is significant within another one */

#define NEAR_ID 4 /* rows of other lenses between two rows that cost less to read than to jump over */

/* Without curves, which only a prediction needs. A bracket gives the response of its camera, whatever the lens and the
 * setting, and nothing of a falloff: it counts where a camera is asked for (?5) alone. */
static const char *const rows_sql[LP_STORE_LAYOUT] = LP_BY_LAYOUT(
    "SELECT id, camera_model, lens, unit, crop_factor, focal_mm, aperture, distance_m, color_temperature_k,"
    " covariance_size, processing, style FROM profiles"
    " WHERE lens_name = ?1 AND (?2 OR doubt IN ('', ?6)) AND (?3 OR (processing = 'corrected') = ?4)"
    " AND (focal_mm IS NOT NULL OR aperture IS NOT NULL OR ?5 OR trim(lens) <> '' OR EXISTS (SELECT 1 FROM vignettings"
    " WHERE profile_id = id AND curve = 0 AND (k1 <> 0 OR k2 <> 0 OR k3 <> 0))) ORDER BY id");
static const char curves_sql[] =
    "SELECT profile_id, curve, k1, k2, k3 FROM vignettings"
    " WHERE profile_id BETWEEN ?1 AND ?2 ORDER BY profile_id, curve";

static lp_candidate *add(lp_candidates *found) {
    if (found->count == found->capacity) {
        const uint32_t capacity = found->capacity ? 2 * found->capacity : 64;
        lp_candidate *all = realloc(found->all, capacity * sizeof *all);
        if (!all) return NULL;
        found->all = all, found->capacity = capacity;
    }
    return memset(&found->all[found->count++], 0, sizeof(lp_candidate));
}

/* -1 for a row of another camera or unit. */
static int fits(const char *stored, const char *requested) {
    if (!*stored) return 0;
    return lp_name_score(stored, requested) >= 0.8 ? 1 : -1;
}

/* As rows_sql has it. */
typedef struct row {
    lensprof_profile_key key;
    char processing[16]; /* key.processing as it is stored */
    int64_t id, covariance_size;
} row;

/* As lp_read_text; `text` holds that of the row before, which most rows share. Returns whether it is another. */
static bool read_text(lp_store_reader *reader, char *text, size_t capacity) {
    if (sqlite3_column_type(reader->statement, reader->column) == SQLITE_TEXT) {
        const char *found = (const char *)sqlite3_column_text(reader->statement, reader->column);
        const size_t bytes = (size_t)sqlite3_column_bytes(reader->statement, reader->column);
        const bool is_as_long = found && bytes < capacity && !text[bytes] && (!bytes || text[bytes - 1]);
        if (is_as_long && !memcmp(found, text, bytes)) {
            reader->column++;
            return false;
        }
    }
    lp_read_text(reader, text, capacity);
    return true;
}

/* *r holds the row before. False, with the reader's column, for what no profile has. */
static bool read_row(sqlite3_stmt *statement, lp_store_reader *reader, row *r) {
    *reader = (lp_store_reader){statement, 0, NULL};
    r->id = lp_read_integer(reader, 1, INT64_MAX);
    bool is_new = read_text(reader, r->key.camera_model, sizeof r->key.camera_model);
    is_new |= read_text(reader, r->key.lens, sizeof r->key.lens);
    is_new |= read_text(reader, r->key.unit, sizeof r->key.unit);
    r->key.crop_factor = lp_read_known(reader);
    r->key.focal_mm = lp_read_known(reader);
    r->key.aperture = lp_read_known(reader);
    r->key.distance_m = lp_read_known(reader);
    r->key.color_temperature_k = lp_read_known(reader);
    r->covariance_size = lp_read_integer(reader, 0, LENSPROF_COVARIANCE_MAX);
    if (read_text(reader, r->processing, sizeof r->processing)) {
        reader->column--;
        r->key.processing = lp_read_name(reader, lp_store_processings, LP_STORE_PROCESSINGS);
    }
    is_new |= read_text(reader, r->key.style, sizeof r->key.style);
    const bool is_key = is_new ? lensprof_profile_key_validate(&r->key) == LENSPROF_OK : lp_are_key_numbers(&r->key);
    if (!reader->bad && !is_key) reader->bad = "key";
    return !reader->bad;
}

/* 1: the same picture style; 0: one of them is not known. */
int lp_fits_style(const char *stored, const char *requested) {
    if (!lp_is_known(stored) || !lp_is_known(requested)) return 0;
    return lp_name_score(stored, requested) >= 0.9 ? 1 : -1;
}

bool lp_is_known(const char *text) { return text[strspn(text, " ")] != 0; }

/* Of the lens's name, or of the camera's where no lens is asked for. */
static double score_of(const row *r, const lensprof_profile_key *key, const lp_candidates *found) {
    if (!lp_is_known(key->lens)) return lp_name_score(r->key.camera_model, key->camera_model);
    if (found->by_camera) return BUILT_IN_SCORE;
    return found->by_words ? lp_words_score(r->key.lens, key->lens, key->camera_maker)
                           : lp_name_score(r->key.lens, key->lens);
}

/* Into found->last_...: comparing names takes longer than reading the row. */
static void compare_names(const row *r, const lensprof_profile_key *key, lp_candidates *found) {
    lensprof_profile_key *last = &found->last;
    if (found->last_score > 0.0 && !strcmp(last->lens, r->key.lens) && !strcmp(last->camera_model, r->key.camera_model))
        return;
    memcpy(last->lens, r->key.lens, sizeof last->lens);
    memcpy(last->camera_model, r->key.camera_model, sizeof last->camera_model);
    found->last_score = score_of(r, key, found);
    found->last_camera = fits(r->key.camera_model, key->camera_model);
}

static bool asks_for_camera(const lensprof_profile_key *key) {
    return !lp_is_known(key->lens) && key->focal_mm == LENSPROF_UNKNOWN && key->aperture == LENSPROF_UNKNOWN;
}

/* Takes a row that fits the key. False without memory. */
static bool take_row(const row *r, const lensprof_profile_key *key, const lensprof_lookup_options *o,
                     lp_candidates *found) {
    compare_names(r, key, found);
    const int unit = found->any_unit ? 0 : fits(r->key.unit, key->unit);
    const int camera = found->by_table ? 1 : found->last_camera; /* from the table */
    if (unit < 0) return true;
    if ((!lp_is_known(key->lens) || found->by_camera) && camera <= 0) return true; /* the camera's own only */
    lp_candidate *candidate = add(found);
    if (!candidate) return false;
    found->name_score = fmax(found->name_score, found->last_score);
    candidate->is_fixed = !lp_is_known(key->lens) || !lp_is_known(r->key.lens) || found->by_camera;
    candidate->of_unit = unit, candidate->of_camera = *key->camera_model ? camera : 0;
    candidate->node.variance = r->covariance_size > 0 ? LP_VARIANCE_UNREAD : 0.0;
    candidate->has_own_response = (o->any_processing || r->key.processing == key->processing)
                                  && candidate->of_camera >= 0 && lp_fits_style(r->key.style, key->style) >= 0;
    candidate->processing = r->key.processing;
    candidate->crop = r->key.crop_factor;
    candidate->node.id = r->id;
    candidate->node.focal_mm = r->key.focal_mm;
    candidate->node.aperture = r->key.aperture;
    candidate->node.distance_m = r->key.distance_m;
    candidate->color_temperature_k = r->key.color_temperature_k;
    return true;
}

static lensprof_status read_rows(lensprof_store *store, const char *name, const lensprof_profile_key *key,
                                 const lensprof_lookup_options *o, lp_candidates *found, lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(store, lp_store_of_layout(store, rows_sql), &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_text(&binder, name);
    lp_bind_integer(&binder, o->with_doubt);
    lp_bind_integer(&binder, o->any_processing);
    lp_bind_integer(&binder, key->processing == LENSPROF_PROCESSING_CORRECTED && !o->force_falloff);
    lp_bind_integer(&binder, asks_for_camera(key));
    lp_bind_text(&binder, LENSPROF_DOUBT_RESPONSE);
    int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    row r = {.processing = ""};
    lensprof_profile_key_init(&r.key);
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        lp_store_reader reader;
        if (!read_row(binder.statement, &reader, &r))
            status = lp_store_fail_profile(store, r.id, reader.bad, error);
        else
            rc = take_row(&r, key, o, found) ? sqlite3_step(binder.statement) : SQLITE_NOMEM;
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    return status;
}

/* The curves of all[count], whose ids are near to each other. */
static lensprof_status read_run(lensprof_store *store, lp_candidate *all, uint32_t count, lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(store, curves_sql, &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_integer(&binder, all[0].node.id);
    lp_bind_integer(&binder, all[count - 1].node.id);
    int rc = binder.rc == SQLITE_OK ? sqlite3_step(binder.statement) : binder.rc;
    for (uint32_t i = 0; rc == SQLITE_ROW && status == LENSPROF_OK; rc = sqlite3_step(binder.statement)) {
        lp_store_reader reader = {binder.statement, 0, NULL};
        const int64_t id = lp_read_integer(&reader, 1, INT64_MAX), curve = lp_read_integer(&reader, 0, 2);
        double k[3];
        while (i < count && all[i].node.id < id) i++;
        if (i == count || all[i].node.id != id) continue;
        for (int n = 0; n < 3; n++) k[n] = lp_read_real(&reader);
        if (curve == 0) all[i].has_curve = true;
        for (int64_t c = curve; c < (curve ? curve + 1 : 3); c++) /* of all, unless others follow */
            memcpy(all[i].node.k[c], k, sizeof k);
        if (reader.bad) status = lp_store_fail_profile(store, id, reader.bad, error);
        if (reader.bad) break;
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder.statement);
    return status;
}

lensprof_status lp_read_curves(lensprof_store *store, lp_candidates *group, lensprof_error *error) {
    lensprof_status status = LENSPROF_OK;
    for (uint32_t from = 0, to; from < group->count && status == LENSPROF_OK; from = to) {
        lp_candidate *all = group->all;
        for (to = from + 1; to < group->count && all[to].node.id - all[to - 1].node.id <= NEAR_ID;) to++;
        status = read_run(store, &all[from], to - from, error);
    }
    for (uint32_t i = 0; i < group->count && status == LENSPROF_OK; i++)
        if (!group->all[i].has_curve)
            status = lp_store_fail_profile(store, group->all[i].node.id, "vignetting curves", error);
    return status;
}

/* Every name of a lens once; the first through the index profiles_by_lens, name by name. */
static const char *const lenses_sql[2] = {
    "SELECT DISTINCT lens FROM profiles ORDER BY lens",
    "WITH RECURSIVE names(name) AS (SELECT min(lens_name) FROM profiles UNION ALL"
    " SELECT (SELECT min(lens_name) FROM profiles WHERE lens_name > name) FROM names WHERE name IS NOT NULL)"
    " SELECT (SELECT lens FROM profiles WHERE lens_name = name LIMIT 1) FROM names WHERE name IS NOT NULL"};

/* The best of the names so far, and whether another one is as good. */
typedef struct best_name {
    char name[LP_NAME_BYTES]; /* squeezed */
    uint32_t apart;
    bool is_tied;
} best_name;

static void keep_better(best_name *best, const char *lens, uint32_t apart) {
    char name[LP_NAME_BYTES];
    lp_squeeze(lens, name);
    if (*best->name && (apart > best->apart || !strcmp(name, best->name))) return;
    best->is_tied = *best->name && apart == best->apart;
    best->apart = apart;
    memcpy(best->name, name, sizeof name);
}

/* The squeezed name of the lens that has the same words, or the most in common; empty if there is no such lens, or if
 * several are as good. */
static lensprof_status find_by_words(lensprof_store *store, const lensprof_profile_key *key, char *name,
                                     lensprof_error *error) {
    sqlite3_stmt *statement;
    best_name best = {"", 0, false};
    lp_words requested;
    *name = 0;
    if (!lp_split_words(key->lens, &requested)) return LENSPROF_OK;
    lensprof_status status = lp_store_prepare(store, lenses_sql[store->layout >= 3], &statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(statement);
    for (; rc == SQLITE_ROW; rc = sqlite3_step(statement)) {
        uint32_t apart;
        const char *stored = (const char *)sqlite3_column_text(statement, 0);
        if (!stored || (size_t)sqlite3_column_bytes(statement, 0) >= sizeof((lensprof_profile_key *)0)->lens) continue;
        if (lp_may_match(&requested, stored) && lp_words_match(&requested, stored, key->camera_maker, &apart) > 0.0)
            keep_better(&best, stored, apart);
    }
    if (rc != SQLITE_ROW && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, statement);
    if (status == LENSPROF_OK && !best.is_tied) memcpy(name, best.name, sizeof best.name);
    return status;
}

/* Whether a lens is named after its camera, which it is built in then: "Canon PowerShot S110 & compatibles". */
static bool is_built_in(const char *squeezed_lens, const char *camera) {
    char squeezed[LP_NAME_BYTES];
    lp_squeeze(camera, squeezed);
    const char *bare = lp_without_maker(squeezed);
    return strlen(bare) >= SHORTEST_CAMERA && strstr(squeezed_lens, bare) != NULL;
}

/* The squeezed name of the only lens of a camera. *lenses: how many there are, 2 for more. Where a lens is asked for,
 * one that is built in. */
static lensprof_status find_only_lens(lensprof_store *store, const lensprof_profile_key *key, char *name, int *lenses,
                                      lensprof_error *error) {
    lp_store_reader reader = {NULL, 0, NULL};
    *lenses = 0;
    lensprof_status status = lp_store_prepare(
        store, "SELECT DISTINCT camera_model, lens FROM profiles WHERE camera_model <> '' AND lens <> ''",
        &reader.statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(reader.statement);
    for (; rc == SQLITE_ROW && *lenses < 2; rc = sqlite3_step(reader.statement)) {
        char camera[LP_NAME_BYTES], lens[LP_NAME_BYTES], squeezed[LP_NAME_BYTES];
        reader.column = 0, reader.bad = NULL;
        lp_read_text(&reader, camera, sizeof camera);
        lp_read_text(&reader, lens, sizeof lens);
        if (reader.bad || lp_name_score(camera, key->camera_model) < 0.8) continue;
        lp_squeeze(lens, squeezed);
        if (lp_is_known(key->lens) && !is_built_in(squeezed, camera)) continue;
        if (*lenses && !strcmp(name, squeezed)) continue; /* of a camera by another of its names */
        memcpy(name, squeezed, sizeof squeezed);
        ++*lenses;
        if (!lp_is_standard(lens)) continue;
        *lenses = 1; /* the others are it with something in front */
        break;
    }
    if (rc != SQLITE_DONE && rc != SQLITE_ROW) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, reader.statement);
    return status;
}

/* The squeezed name of the built-in lens according to the table of cameras, or empty; and whether according to it the
 * camera's can be changed. */
static lensprof_status find_fixed_lens(lensprof_store *store, const lensprof_profile_key *key, char *name,
                                       bool *can_change, lensprof_error *error) {
    lensprof_camera_model camera;
    bool found;
    *name = 0, *can_change = false;
    lensprof_status status = lp_store_find_camera(store, key->camera_maker, key->camera_model, &camera, &found, error);
    if (status != LENSPROF_OK || !found) return status;
    *can_change = !camera.fixed_lens && *camera.mount;
    if (camera.fixed_lens) lp_squeeze(camera.lens, name);
    return status;
}

static lensprof_status find_camera(lensprof_store *store, const lensprof_profile_key *key,
                                   const lensprof_lookup_options *o, lp_candidates *found, lensprof_error *error) {
    char name[LP_NAME_BYTES] = "";
    int lenses = 0;
    bool can_change;
    lensprof_status status = lp_is_known(key->lens) ? LENSPROF_OK : read_rows(store, "", key, o, found, error);
    if (status != LENSPROF_OK || found->count) return status;
    status = find_fixed_lens(store, key, name, &can_change, error);
    if (status == LENSPROF_OK && *name) {
        found->by_camera = found->by_table = true;
        status = read_rows(store, name, key, o, found, error);
        if (status == LENSPROF_OK && !found->count) found->by_camera = found->by_table = false;
    }
    if (status != LENSPROF_OK || found->count || (can_change && lp_is_known(key->lens))) return status;
    status = find_only_lens(store, key, name, &lenses, error);
    found->has_lenses = lenses > 1 && !lp_is_known(key->lens);
    found->by_camera = lenses == 1 && lp_is_known(key->lens);
    return status == LENSPROF_OK && lenses == 1 ? read_rows(store, name, key, o, found, error) : status;
}

lensprof_status lp_find_candidates(lensprof_store *store, const lensprof_profile_key *key,
                                   const lensprof_lookup_options *o, lp_candidates *found, lensprof_error *error) {
    lp_names names;
    char name[LP_NAME_BYTES];
    lensprof_status status = LENSPROF_OK;
    if (!lp_is_known(key->lens))
        return lp_is_known(key->camera_model) ? find_camera(store, key, o, found, error) : LENSPROF_OK;
    lp_name_variants(key->lens, key->camera_maker, &names);
    for (uint32_t i = 0; i < names.count && status == LENSPROF_OK && !found->count; i++)
        status = read_rows(store, names.name[i], key, o, found, error);
    if (status != LENSPROF_OK || found->count) return status;
    status = find_by_words(store, key, name, error);
    found->by_words = *name != 0;
    if (status == LENSPROF_OK && *name) return read_rows(store, name, key, o, found, error);
    return status == LENSPROF_OK && lp_is_known(key->camera_model) ? find_camera(store, key, o, found, error) : status;
}
