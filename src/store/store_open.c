/* Opening, creating and closing a database. */
#include "store_private.h"

#include <stdlib.h>
#include <string.h>

#if SQLITE_VERSION_NUMBER < 3037000
#error "lensprof needs SQLite 3.37 or newer (STRICT tables)"
#endif

#define LARGEST_VALUE (1 << 20) /* bytes; the largest blob is 12288, more is a crafted file */

/* The journal mode stays what it is in a new file, DELETE: one file that can be copied and mailed, readable from
 * read-only media. A write-ahead log would need two more files beside it and gains nothing for a few short writes. */
static int configure(sqlite3 *db, uint32_t mode, int busy_ms)
{
    int rc = sqlite3_extended_result_codes(db, 1);
    if (rc == SQLITE_OK) rc = sqlite3_busy_timeout(db, busy_ms);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_FKEY, 1, NULL);
    /* The file may come from anybody: what it contains besides our tables is not to run. */
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_VIEW, 0, NULL);
    sqlite3_limit(db, SQLITE_LIMIT_LENGTH, LARGEST_VALUE);
    sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
    if (rc == SQLITE_OK)
        rc = sqlite3_exec(db, "PRAGMA cell_size_check = ON; PRAGMA temp_store = MEMORY", NULL, NULL, NULL);
    if (rc == SQLITE_OK && mode != LENSPROF_STORE_READ) /* reads the file, which lp_store_begin prepares for readers */
        rc = sqlite3_exec(db, "PRAGMA synchronous = FULL", NULL, NULL, NULL);
    return rc;
}

/* In an IMMEDIATE transaction: makes the tables unless another process was quicker. */
static int make_tables(sqlite3 *db)
{
    int64_t application_id = 0, tables = 0;
    int rc = lp_store_number(db, "PRAGMA application_id", &application_id);
    if (rc == SQLITE_OK) rc = lp_store_number(db, "SELECT count(*) FROM sqlite_master", &tables);
    if (rc == SQLITE_OK && application_id == 0 && tables == 0) rc = lp_store_migrate(db, 0);
    return rc;
}

static lensprof_status create_when_empty(lensprof_store *store, lensprof_error *error)
{
    int64_t pages = 0;
    int rc = lp_store_number(store->db, "PRAGMA page_count", &pages);
    if (rc == SQLITE_OK && pages > 0) return LENSPROF_OK;
    if (rc == SQLITE_OK) rc = sqlite3_exec(store->db, "BEGIN IMMEDIATE", NULL, NULL, NULL);
    if (rc == SQLITE_OK) rc = make_tables(store->db);
    if (rc == SQLITE_OK) return lp_store_commit(store, error);
    lensprof_status status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_rollback(store);
    return status;
}

/* That every table is there; what is in them is checked when it is read. */
static lensprof_status check_tables(lensprof_store *store, lensprof_error *error)
{
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    const char *sql = store->layout < 2
        ? "SELECT 1 FROM profiles, responses, emor_coefficients, vignettings"
        : store->layout < 3
        ? "SELECT gain_grids.channels FROM profiles, responses, emor_coefficients, vignettings, gain_grids"
        : "SELECT unit, gain_grids.channels FROM profiles, responses, emor_coefficients, vignettings, gain_grids";
    const int rc = sqlite3_prepare_v2(store->db, sql, -1, &statement, NULL);
    if (rc) status = lp_store_fail_sql(store->path, store->db, rc, error);
    sqlite3_finalize(statement);
    lp_store_rollback(store);
    return status;
}

static lensprof_status connect(lensprof_store *store, const char *full, int busy_ms, lensprof_error *error)
{
    int flags = SQLITE_OPEN_NOMUTEX; /* a handle belongs to one thread at a time */
    flags |= store->mode == LENSPROF_STORE_READ ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
    if (store->mode == LENSPROF_STORE_CREATE) flags |= SQLITE_OPEN_CREATE;
    int rc = sqlite3_open_v2(full, &store->db, flags, NULL);
    if (rc == SQLITE_OK) rc = configure(store->db, store->mode, busy_ms);
    if (rc) return lp_store_fail_sql(store->path, store->db, rc, error);
    /* SQLite opens a file for reading when it may not be written. */
    if (store->mode != LENSPROF_STORE_READ && sqlite3_db_readonly(store->db, "main") == 1)
        return lp_store_fail_sql(store->path, NULL, SQLITE_READONLY, error);
    lensprof_status status = LENSPROF_OK;
    if (store->mode == LENSPROF_STORE_CREATE) status = create_when_empty(store, error);
    return status == LENSPROF_OK ? check_tables(store, error) : status;
}

static lensprof_status check_file(const char *path, uint32_t mode, lp_store_file file, lensprof_error *error)
{
    if (file == LP_STORE_FILE_MISSING && mode != LENSPROF_STORE_CREATE)
        return lp_store_fail(path, LENSPROF_ERROR_NOT_FOUND, "no such file",
                             "check the path; storing a profile makes a new one", error);
    if (file == LP_STORE_FILE_FOREIGN)
        return lp_store_fail(path, LENSPROF_ERROR_CORRUPT, "is not a lensprof database",
                             "give the path of another file, or restore it from a copy", error);
    return LENSPROF_OK;
}

lensprof_status lp_store_open_waiting(const char *path, uint32_t mode, int busy_ms, lensprof_store **store,
                                      lensprof_error *error)
{
    lp_store_clear(error);
    if (!path || !*path) return lp_store_fail_argument("no path; name a file", error);
    if (!store) return lp_store_fail_argument("no place for the handle", error);
    if (mode > LENSPROF_STORE_CREATE) return lp_store_fail_argument("unknown mode; see lensprof_store_mode", error);
    lp_store_file file;
    char *full;
    lensprof_status status = lp_store_probe(path, &file, &full, error);
    if (status != LENSPROF_OK) return status;
    status = check_file(path, mode, file, error);
    size_t length = strlen(path);
    lensprof_store *made = NULL;
    if (status == LENSPROF_OK) {
        made = malloc(sizeof *made + length + 1);
        if (!made) status = lp_store_fail_sql(path, NULL, SQLITE_NOMEM, error);
    }
    if (made) {
        made->db = NULL;
        made->mode = mode;
        made->layout = 0;
        made->batch = false;
        made->prepared = 0;
        made->damage[0] = 0;
        memcpy(made->path, path, length + 1);
        status = connect(made, full, busy_ms, error);
    }
    sqlite3_free(full);
    if (status == LENSPROF_OK) *store = made;
    else lensprof_store_close(made);
    return status;
}

lensprof_status lensprof_store_open(const char *path, uint32_t mode, lensprof_store **store, lensprof_error *error)
{
    return lp_store_open_waiting(path, mode, LP_STORE_BUSY_MS, store, error);
}

void lensprof_store_close(lensprof_store *store)
{
    if (!store) return;
    lp_store_forget_statements(store);
    sqlite3_close(store->db);
    free(store);
}
