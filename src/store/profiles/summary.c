/* Which lenses and cameras there are. */
#include "store/profiles/profiles.h"

#include <stdlib.h>
#include <string.h>

#include "store/names/names.h"

/* clang-format off */
#define COUNTS " count(*) AS profiles," \
    " CAST(total(processing = 'raw') AS INTEGER) AS raw, CAST(total(processing = 'jpeg') AS INTEGER) AS jpeg," \
    " CAST(total(processing = 'corrected') AS INTEGER) AS corrected," \
    " min(focal_mm) AS focal_low, max(focal_mm) AS focal_high, min(aperture) AS aperture_low," \
    " max(aperture) AS aperture_high, min(distance_m) AS distance_low, max(distance_m) AS distance_high FROM profiles"
/* clang-format on */

/* Columns in the order of read_summary; both hold for every layout. */
static const char *const lenses_sql =
    "SELECT '' AS maker, '' AS model, min(trim(lens)) AS lens, count(DISTINCT lower(nullif(trim(camera_model), ''))) AS others," COUNTS
    " WHERE trim(lens) <> '' GROUP BY trim(lens) COLLATE NOCASE ORDER BY trim(lens) COLLATE NOCASE";
static const char *const cameras_sql =
    "SELECT min(trim(camera_maker)) AS maker, min(trim(camera_model)) AS model, '' AS lens,"
    " count(DISTINCT lower(nullif(trim(lens), ''))) AS others," COUNTS
    " WHERE trim(camera_model) <> '' GROUP BY trim(camera_maker) COLLATE NOCASE, trim(camera_model) COLLATE NOCASE"
    " ORDER BY trim(camera_maker) COLLATE NOCASE, trim(camera_model) COLLATE NOCASE";

typedef struct summaries {
    lensprof_store_summary *rows; /* free it */
    bool *is_named;               /* of each: its name is the one that is asked for */
    uint32_t count, allocated, named;
} summaries;

static void free_summaries(summaries *all) {
    free(all->rows);
    free(all->is_named);
}

static bool grow(summaries *all) {
    if (all->count < all->allocated) return true;
    const uint32_t allocated = all->allocated ? 2 * all->allocated : 64;
    lensprof_store_summary *rows = realloc(all->rows, allocated * sizeof *rows);
    if (rows) all->rows = rows;
    bool *is_named = rows ? realloc(all->is_named, allocated * sizeof *is_named) : NULL;
    if (!is_named) return false;
    all->is_named = is_named, all->allocated = allocated;
    return true;
}

static void read_summary(lp_store_reader *reader, lensprof_store_summary *row) {
    double *const ranges[] = {row->focal_mm, row->aperture, row->distance_m};
    memset(row, 0, sizeof *row);
    lp_read_text(reader, row->camera_maker, sizeof row->camera_maker);
    lp_read_text(reader, row->camera_model, sizeof row->camera_model);
    lp_read_text(reader, row->lens, sizeof row->lens);
    row->others = (uint32_t)lp_read_integer(reader, 0, UINT32_MAX);
    row->profiles = (uint32_t)lp_read_integer(reader, 0, UINT32_MAX);
    for (int i = 0; i < 3; i++) row->processing[i] = (uint32_t)lp_read_integer(reader, 0, UINT32_MAX);
    for (int i = 0; i < 3; i++)
        for (int end = 0; end < 2; end++) ranges[i][end] = lp_read_known(reader);
}

/* Whether each word of `part` is in the name. */
static bool has_words(const lensprof_store_summary *row, const char *part) {
    char full_name[LP_NAME_BYTES], squeezed[LP_NAME_BYTES], word[LP_NAME_BYTES];
    size_t used = 0;
    for (const char *const *text = (const char *const[]){row->camera_maker, row->camera_model, row->lens, NULL}; *text;
         text++) {
        lp_squeeze(*text, squeezed);
        const size_t bytes = strlen(squeezed);
        if (used + bytes >= sizeof full_name) break;
        memcpy(full_name + used, squeezed, bytes);
        used += bytes;
    }
    full_name[used] = 0;
    while (*part) {
        const size_t bytes = strcspn(part, " ");
        if (bytes >= sizeof word) return false;
        memcpy(word, part, bytes);
        word[bytes] = 0;
        lp_squeeze(word, squeezed);
        if (!strstr(full_name, squeezed)) return false;
        part += bytes + strspn(part + bytes, " ");
    }
    return true;
}

/* Whether the name is the one that is asked for, as lookups compare them. */
static bool is_name(const lensprof_store_summary *row, const char *part) {
    if (*row->lens) return lp_name_score(row->lens, part) > 0.0 || lp_words_score(row->lens, part, "") > 0.0;
    return lp_name_score(row->camera_model, part) > 0.0;
}

static lensprof_status read_all(lensprof_store *store, const char *sql, const char *part, summaries *all,
                                lensprof_error *error) {
    lp_store_reader reader = {NULL, 0, NULL};
    lensprof_status status = lp_store_prepare(store, sql, &reader.statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(reader.statement);
    for (; rc == SQLITE_ROW && status == LENSPROF_OK; rc = sqlite3_step(reader.statement)) {
        lensprof_store_summary row;
        reader.column = 0;
        read_summary(&reader, &row);
        if (reader.bad) {
            status =
                lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, "has a profile with an impossible name or number",
                              "lensprof_store_check identifies it", error);
            break;
        }
        const bool named = *part && is_name(&row, part);
        if (!named && !has_words(&row, part)) continue;
        if (!grow(all)) {
            rc = SQLITE_NOMEM;
            break;
        }
        all->rows[all->count] = row;
        all->is_named[all->count++] = named;
        all->named += named;
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, reader.statement);
    return status;
}

/* Where names are those that are asked for, these alone. */
static void keep_named(summaries *all) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < all->count; i++)
        if (!all->named || all->is_named[i]) all->rows[kept++] = all->rows[i];
    all->count = kept;
}

static lensprof_status list(lensprof_store *store, const char *sql, const char *part, lensprof_store_summary *rows,
                            uint32_t capacity, uint32_t *count, lensprof_error *error) {
    summaries all = {NULL, NULL, 0, 0, 0};
    lp_store_clear(error);
    if (!store || !count || (capacity && !rows)) return lp_store_fail_argument("store, rows or count is NULL", error);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    part = part ? part + strspn(part, " ") : "";
    status = read_all(store, sql, part, &all, error);
    lp_store_rollback(store);
    if (status == LENSPROF_OK) {
        keep_named(&all);
        *count = all.count;
        if (capacity && all.count > capacity)
            status = lp_store_fail_capacity(all.count, capacity, error);
        else if (capacity && all.count)
            memcpy(rows, all.rows, all.count * sizeof *rows);
    }
    free_summaries(&all);
    return status;
}

lensprof_status lensprof_store_list_names(lensprof_store *store, uint32_t which, const char *part,
                                          lensprof_store_summary *rows, uint32_t capacity, uint32_t *count,
                                          lensprof_error *error) {
    if (which > LENSPROF_NAMES_CAMERAS)
        return lp_store_fail_argument("unknown kind of names; see lensprof_store_names", error);
    const char *const sql = which == LENSPROF_NAMES_LENSES ? lenses_sql : cameras_sql;
    return list(store, sql, part, rows, capacity, count, error);
}
