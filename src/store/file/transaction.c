/* Transactions. Every public call is one: reads see one state of the file, writes happen whole or not at all. */
#include "store/file/private.h"

#include <stdio.h>

int lp_store_number(sqlite3 *db, const char *sql, int64_t *value) {
    sqlite3_stmt *statement;
    int rc = sqlite3_prepare_v2(db, sql, -1, &statement, NULL);
    if (rc) return rc;
    rc = sqlite3_step(statement);
    if (rc == SQLITE_ROW) *value = sqlite3_column_int64(statement, 0);
    int finalized = sqlite3_finalize(statement);
    return finalized ? finalized : rc == SQLITE_ROW ? SQLITE_OK : SQLITE_CORRUPT;
}

int lp_store_migrate(sqlite3 *db, int layout) {
    static const char *const schemas[LP_STORE_LAYOUT] = {lp_schema_0001, lp_schema_0002, lp_schema_0003, lp_schema_0004,
                                                         lp_schema_0005, lp_schema_0006, lp_schema_0007};
    int rc = SQLITE_OK;
    for (int next = layout; next < LP_STORE_LAYOUT && rc == SQLITE_OK; next++)
        rc = sqlite3_exec(db, schemas[next], NULL, NULL, NULL);
    return rc;
}

typedef struct layout {
    int64_t application_id, user_version, pages;
} layout;

/* What would be written to a file that has been removed would be lost; a log does not notice. */
static int check_place(sqlite3 *db) {
    int moved = 0;
    (void)sqlite3_file_control(db, "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    return moved ? SQLITE_READONLY_DBMOVED : SQLITE_OK;
}

static int begin(lensprof_store *store, bool write, layout *found) {
    int rc = SQLITE_OK;
    if (!sqlite3_get_autocommit(store->db)) rc = lp_store_execute(store, "ROLLBACK"); /* lacked the memory before */
    if (rc == SQLITE_OK && write) rc = check_place(store->db);
    if (rc == SQLITE_OK) rc = write ? lp_store_execute(store, "BEGIN IMMEDIATE") : lp_store_execute(store, "BEGIN");
    if (rc) return rc;
    rc = lp_store_integer(store, "PRAGMA application_id", &found->application_id);
    if (rc == SQLITE_OK) rc = lp_store_integer(store, "PRAGMA user_version", &found->user_version);
    if (rc == SQLITE_OK) rc = lp_store_integer(store, "PRAGMA page_count", &found->pages);
    return rc;
}

static lensprof_status check_layout(const lensprof_store *store, const layout *found, lensprof_error *error) {
    const char *restore = "give the path of another file, or restore it from a copy";
    if (found->pages == 0)
        return lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, "is empty, not a lensprof database",
                             "storing a profile turns it into a database", error);
    if (found->application_id != LP_STORE_APPLICATION_ID)
        return lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, "is not a lensprof database", restore, error);
    if (found->user_version > LP_STORE_LAYOUT) {
        char problem[80];
        snprintf(problem, sizeof problem, "has layout %lld; this lensprof supports up to %d",
                 (long long)found->user_version, LP_STORE_LAYOUT);
        return lp_store_fail(store->path, LENSPROF_ERROR_LAYOUT, problem, "update lensprof", error);
    }
    if (found->user_version < 1)
        return lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, "has no layout number", restore, error);
    return LENSPROF_OK;
}

/* Part of the transaction that writes: when that is not committed, the file keeps its layout. */
static lensprof_status bring_up_to_date(lensprof_store *store, lensprof_error *error) {
    int rc = lp_store_migrate(store->db, store->layout);
    if (rc) return lp_store_fail_sql(store->path, store->db, rc, error);
    store->layout = LP_STORE_LAYOUT;
    return LENSPROF_OK;
}

lensprof_status lp_store_begin(lensprof_store *store, bool write, lensprof_error *error) {
    layout found = {0, 0, 0};
    if (store->batch) {
        int rc = lp_store_execute(store, "SAVEPOINT call");
        return rc ? lp_store_fail_sql(store->path, store->db, rc, error) : LENSPROF_OK;
    }
    if (write && store->mode == LENSPROF_STORE_READ)
        return lp_store_fail(store->path, LENSPROF_ERROR_READ_ONLY, "was opened read-only",
                             "open it with LENSPROF_STORE_WRITE", error);
    lensprof_status status = lp_store_refresh(store, error);
    if (status != LENSPROF_OK) return status;
    int rc = begin(store, write, &found);
    if (rc == SQLITE_CANTOPEN && lp_store_has_log(sqlite3_db_filename(store->db, "main")))
        rc = SQLITE_READONLY_RECOVERY; /* no place for the log's index next to it */
    status = rc ? lp_store_fail_sql(store->path, store->db, rc, error) : check_layout(store, &found, error);
    if (status == LENSPROF_OK) store->layout = (int)found.user_version;
    if (status == LENSPROF_OK && write) status = bring_up_to_date(store, error);
    if (status != LENSPROF_OK) lp_store_rollback(store);
    return status;
}

const char *lp_store_of_layout(const lensprof_store *store, const char *const *statements) {
    return statements[store->layout - 1]; /* 1 or more: check_layout */
}

lensprof_status lp_store_commit(lensprof_store *store, lensprof_error *error) {
    int rc = store->batch ? lp_store_execute(store, "RELEASE call") : lp_store_execute(store, "COMMIT");
    if (rc == SQLITE_OK && !store->batch) (void)lp_store_settle_journal(store);
    if (rc == SQLITE_OK) return LENSPROF_OK;
    lensprof_status status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_rollback(store);
    return status;
}

void lp_store_rollback(lensprof_store *store) {
    if (store->batch && !sqlite3_get_autocommit(store->db)) {
        (void)lp_store_execute(store, "ROLLBACK TO call");
        (void)lp_store_execute(store, "RELEASE call");
        return;
    }
    /* Some failures have rolled back already. If there is not even the memory for this, the next begin does it. */
    if (!sqlite3_get_autocommit(store->db)) (void)lp_store_execute(store, "ROLLBACK");
    if (store->immutable) (void)sqlite3_db_release_memory(store->db); /* nothing reports when the file changes */
}

lensprof_status lensprof_store_begin(lensprof_store *store, lensprof_error *error) {
    lp_store_clear(error);
    if (!store || store->batch) return lp_store_fail_argument("store is NULL, or a transaction is already open", error);
    const lensprof_status status = lp_store_begin(store, true, error);
    store->batch = status == LENSPROF_OK;
    return status;
}

lensprof_status lensprof_store_commit(lensprof_store *store, lensprof_error *error) {
    lp_store_clear(error);
    if (!store || !store->batch) return lp_store_fail_argument("store is NULL, or no transaction is open", error);
    store->batch = false;
    if (!sqlite3_get_autocommit(store->db)) return lp_store_commit(store, error);
    return lp_store_fail(store->path, LENSPROF_ERROR_STORE, "the transaction was rolled back by an earlier failure",
                         "nothing was stored; try again", error);
}

void lensprof_store_rollback(lensprof_store *store) {
    if (!store || !store->batch) return;
    store->batch = false;
    lp_store_rollback(store);
}
