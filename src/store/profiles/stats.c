/* How much of what is in a database. */
#include "store/profiles/profiles.h"

#include <string.h>

#include "store/profiles/layouts.h"

/* One row: columns in the order of read_counts. */
static const char *const counts_sql[LP_STORE_LAYOUT] = LP_BY_LAYOUT(
    "SELECT count(*), (SELECT count(*) FROM (SELECT DISTINCT lower(trim(camera_maker)), lower(trim(camera_model))"
    " FROM profiles WHERE trim(camera_model) <> '')),"
    " (SELECT count(DISTINCT lower(trim(lens))) FROM profiles WHERE trim(lens) <> ''),"
    " (SELECT count(DISTINCT lower(trim(unit))) FROM profiles WHERE trim(unit) <> ''),"
    " total(processing = 'raw'), total(processing = 'jpeg'), total(processing = 'corrected'),"
    " total(covariance_size > 0), total(gain_grids > 0), total(doubt <> ''), count(DISTINCT method), count(DISTINCT source),"
    " min(focal_mm), max(focal_mm), min(aperture), max(aperture), min(distance_m), max(distance_m) FROM profiles");
static const char *const methods_sql[LP_STORE_LAYOUT] =
    LP_BY_LAYOUT("SELECT method, count(*) AS n FROM profiles GROUP BY method ORDER BY n DESC, method");

/* total() makes a REAL of a count. */
static uint32_t read_count(sqlite3_stmt *statement, int column) {
    const int64_t value = sqlite3_column_int64(statement, column);
    return value < 0 ? 0 : value > UINT32_MAX ? UINT32_MAX : (uint32_t)value;
}

static void read_range(lp_store_reader *reader, double range[2]) {
    for (int end = 0; end < 2; end++) range[end] = lp_read_known(reader);
}

static lensprof_status read_counts(lensprof_store *store, lensprof_store_stats *stats, lensprof_error *error) {
    uint32_t *const counts[] = {&stats->profiles,      &stats->cameras,         &stats->lenses,
                                &stats->units,         &stats->processing[0],   &stats->processing[1],
                                &stats->processing[2], &stats->with_covariance, &stats->with_grid,
                                &stats->with_doubt,    &stats->methods,         &stats->sources};
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_prepare(store, lp_store_of_layout(store, counts_sql), &statement, error);
    if (status != LENSPROF_OK) return status;
    const int rc = sqlite3_step(statement);
    if (rc == SQLITE_ROW) {
        lp_store_reader reader = {statement, sizeof counts / sizeof *counts, NULL};
        for (int i = 0; i < reader.column; i++) *counts[i] = read_count(statement, i);
        read_range(&reader, stats->focal_mm);
        read_range(&reader, stats->aperture);
        read_range(&reader, stats->distance_m);
        if (reader.bad)
            status = lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, "has a profile with an impossible number",
                                   "lensprof_store_check identifies it", error);
    } else
        status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, statement);
    return status;
}

static lensprof_status read_groups(lensprof_store *store, const char *sql, lensprof_store_group *groups,
                                   lensprof_error *error) {
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_prepare(store, sql, &statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(statement);
    for (uint32_t i = 0; i < LENSPROF_STATS_GROUPS && rc == SQLITE_ROW && status == LENSPROF_OK; i++) {
        lp_store_reader reader = {statement, 0, NULL};
        lp_read_text(&reader, groups[i].name, sizeof groups[i].name);
        groups[i].profiles = read_count(statement, 1);
        if (reader.bad)
            status = lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, "has a profile with an impossible text",
                                   "lensprof_store_check identifies it", error);
        else
            rc = sqlite3_step(statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_ROW && rc != SQLITE_DONE)
        status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, statement);
    return status;
}

static lensprof_status read_all(lensprof_store *store, lensprof_store_stats *stats, lensprof_error *error) {
    int64_t pages = 0, page = 0;
    lensprof_status status = read_counts(store, stats, error);
    if (status == LENSPROF_OK)
        status = read_groups(store, lp_store_of_layout(store, methods_sql), stats->method, error);
    if (status == LENSPROF_OK)
        status =
            read_groups(store, "SELECT source, count(*) AS n FROM profiles GROUP BY source ORDER BY n DESC, source",
                        stats->source, error);
    if (status != LENSPROF_OK) return status;
    int rc = lp_store_integer(store, "PRAGMA page_count", &pages);
    if (rc == SQLITE_OK) rc = lp_store_integer(store, "PRAGMA page_size", &page);
    if (rc) return lp_store_fail_sql(store->path, store->db, rc, error);
    stats->layout = (uint32_t)store->layout;
    stats->bytes = pages * page;
    return LENSPROF_OK;
}

#define FIRST_STATS LP_END_OF(lensprof_store_stats, bytes)

lensprof_status lensprof_store_get_stats(lensprof_store *store, lensprof_store_stats *stats, lensprof_error *error) {
    lensprof_store_stats found;
    lp_store_clear(error);
    if (!store || !stats) return lp_store_fail_argument("store or stats is NULL", error);
    const char *wrong = lp_sized_wrong(stats, FIRST_STATS, sizeof *stats);
    if (wrong) return lp_store_fail_size("lensprof_store_stats", wrong, error);
    lensprof_store_stats_init(&found);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = read_all(store, &found, error);
    lp_store_rollback(store);
    if (status == LENSPROF_OK) lp_sized_copy(stats, &found);
    return status;
}
