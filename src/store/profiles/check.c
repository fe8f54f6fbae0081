/* Everything in a database read and checked, with all that is wrong and not only the first. */
#include "store/profiles/profiles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/names/names.h"

typedef struct inspection {
    lensprof_store *store;
    lensprof_fault_visitor visit;
    void *user;
    uint32_t profiles, faults;
} inspection;

static lensprof_status report(inspection *all, int64_t id, const char *reason) {
    lensprof_store_fault fault;
    memset(&fault, 0, sizeof fault);
    fault.id = id;
    snprintf(fault.reason, sizeof fault.reason, "%s", reason);
    all->faults++;
    return all->visit ? all->visit(all->user, &fault) : LENSPROF_OK;
}

/* A statement that could not be run to its end: damage is a fault of the file, anything else ends the check. */
static lensprof_status report_failure(inspection *all, int rc, const char *problem, lensprof_error *error) {
    char reason[200];
    const lensprof_status status = lp_store_fail_sql(all->store->path, all->store->db, rc, error);
    if (status != LENSPROF_ERROR_CORRUPT) return status;
    snprintf(reason, sizeof reason, "%s (%.100s)", problem, sqlite3_errmsg(all->store->db));
    lp_store_clear(error);
    return report(all, 0, reason);
}

/* Where SQLite could not read on (no memory, an I/O error) its check reports that in a text, like damage: the result
 * code in it, or SQLITE_OK. */
static int code_in(const char *text) {
    const char *marker = strstr(text, "error code");
    const int code = marker ? (int)strtol(marker + strlen("error code") + 1, NULL, 10) : SQLITE_OK;
    return (code & 0xff) == SQLITE_CORRUPT ? SQLITE_OK : code;
}

/* What SQLite finds in the file itself: pages, indexes, types and constraints. */
static lensprof_status check_file(inspection *all, lensprof_error *error) {
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_prepare(all->store, "PRAGMA integrity_check(1000)", &statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(statement);
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        const char *text = (const char *)sqlite3_column_text(statement, 0);
        const int code = text ? code_in(text) : SQLITE_NOMEM;
        if (code != SQLITE_OK)
            rc = code;
        else if (strcmp(text, "ok"))
            status = report(all, 0, text);
        if (code == SQLITE_OK && status == LENSPROF_OK) rc = sqlite3_step(statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE)
        status = report_failure(all, rc, "its structure cannot be checked", error);
    lp_store_release(all->store, statement);
    return status;
}

/* Orphaned rows, as PRAGMA foreign_key_check would find them, but by what the schema should be and not by
 * what the tables of this file do; and rows that no profile reads. Each gives the profile's number. */
static const struct orphans {
    const char *sql, *reason;
    int layout; /* from which there is such a table */
} orphans[] = {
    {"SELECT DISTINCT profile_id FROM responses WHERE profile_id NOT IN (SELECT id FROM profiles)",
     "a row of responses without its profile", 1},
    {"SELECT DISTINCT profile_id FROM vignettings WHERE profile_id NOT IN (SELECT id FROM profiles)",
     "a row of vignettings without its profile", 1},
    {"SELECT DISTINCT profile_id FROM gain_grids WHERE profile_id NOT IN (SELECT id FROM profiles)",
     "a row of gain_grids without its profile", 2},
    {"SELECT DISTINCT profile_id FROM emor_coefficients AS e WHERE NOT EXISTS"
     " (SELECT 1 FROM responses AS r WHERE r.profile_id = e.profile_id AND r.curve = e.curve)",
     "a row of emor_coefficients without its response", 1},
    {"SELECT DISTINCT profile_id FROM emor_coefficients JOIN responses USING (profile_id, curve) WHERE emor_modes IS NULL",
     "a row of emor_coefficients for a response that is not EMoR", 1},
};

static lensprof_status check_orphans(inspection *all, const struct orphans *kind, lensprof_error *error) {
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_prepare(all->store, kind->sql, &statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(statement);
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        status = report(all, sqlite3_column_int64(statement, 0), kind->reason);
        if (status == LENSPROF_OK) rc = sqlite3_step(statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = report_failure(all, rc, kind->reason, error);
    lp_store_release(all->store, statement);
    return status;
}

/* Whether lookups find the profile that is in store->scratch. */
static lensprof_status check_lens_name(inspection *all, int64_t id, sqlite3_stmt *statement, lensprof_error *error) {
    char expected[LP_NAME_BYTES];
    const char *found = all->store->layout < 3 ? NULL : (const char *)sqlite3_column_text(statement, 1);
    if (all->store->layout < 3) return LENSPROF_OK;
    if (!found && sqlite3_errcode(all->store->db) == SQLITE_NOMEM)
        return lp_store_fail_sql(all->store->path, NULL, SQLITE_NOMEM, error);
    lp_squeeze(all->store->scratch.key.lens, expected);
    return found && !strcmp(found, expected) ? LENSPROF_OK : report(all, id, "lens_name does not match lens");
}

static lensprof_status check_profile(inspection *all, sqlite3_stmt *statement, lensprof_error *error) {
    const int64_t id = sqlite3_column_int64(statement, 0);
    char reason[200];
    all->profiles++;
    *all->store->damage = 0;
    const lensprof_status status = lp_store_fetch(all->store, id, error);
    if (status == LENSPROF_OK) return check_lens_name(all, id, statement, error);
    if (status != LENSPROF_ERROR_CORRUPT && status != LENSPROF_ERROR_NOT_FOUND) return status;
    if (*all->store->damage)
        snprintf(reason, sizeof reason, "%s", all->store->damage);
    else
        snprintf(reason, sizeof reason, "cannot be read (%.100s)", sqlite3_errmsg(all->store->db));
    lp_store_clear(error);
    return report(all, id, reason);
}

/* Every profile is read as any other call reads it. */
static lensprof_status check_profiles(inspection *all, lensprof_error *error) {
    sqlite3_stmt *statement;
    const char *sql = all->store->layout < 3 ? "SELECT id FROM profiles ORDER BY id"
                                             : "SELECT id, lens_name FROM profiles ORDER BY id";
    lensprof_status status = lp_store_prepare(all->store, sql, &statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(statement);
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        status = check_profile(all, statement, error);
        if (status == LENSPROF_OK) rc = sqlite3_step(statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE)
        status = report_failure(all, rc, "profiles cannot be read completely", error);
    lp_store_release(all->store, statement);
    return status;
}

static lensprof_status report_camera(void *user, int64_t id, const char *wrong) {
    char reason[200];
    snprintf(reason, sizeof reason, "camera %lld: impossible %s", (long long)id, wrong);
    return report(user, 0, reason);
}

static lensprof_status check_cameras(inspection *all, lensprof_error *error) {
    const lensprof_status status = lp_store_check_cameras(all->store, report_camera, all, error);
    if (status != LENSPROF_ERROR_CORRUPT) return status;
    lp_store_clear(error);
    return report(all, 0, "cameras cannot be read completely");
}

lensprof_status lensprof_store_check(lensprof_store *store, lensprof_fault_visitor visit, void *user,
                                     uint32_t *profiles, uint32_t *faults, lensprof_error *error) {
    inspection all = {store, visit, user, 0, 0};
    lp_store_clear(error);
    if (!store) return lp_store_fail_argument("store is NULL", error);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = check_file(&all, error);
    for (size_t i = 0; i < sizeof orphans / sizeof *orphans && status == LENSPROF_OK; i++)
        if (store->layout >= orphans[i].layout) status = check_orphans(&all, &orphans[i], error);
    if (status == LENSPROF_OK) status = check_profiles(&all, error);
    if (status == LENSPROF_OK) status = check_cameras(&all, error);
    lp_store_rollback(store);
    if (status == LENSPROF_OK && profiles) *profiles = all.profiles;
    if (status == LENSPROF_OK && faults) *faults = all.faults;
    return status;
}
