/* Prepared statements, kept in the handle: preparing one takes longer than most of them run. */
#include "store/file/private.h"

static bool is_kept(const lensprof_store *store, const sqlite3_stmt *statement) {
    for (uint32_t i = 0; i < store->prepared; i++)
        if (store->kept[i].statement == statement) return true;
    return false;
}

static int prepare(lensprof_store *store, const char *sql, sqlite3_stmt **statement) {
    for (uint32_t i = 0; i < store->prepared; i++)
        if (store->kept[i].sql == sql && !sqlite3_stmt_busy(store->kept[i].statement)) {
            *statement = store->kept[i].statement;
            return SQLITE_OK;
        }
    const int rc = sqlite3_prepare_v3(store->db, sql, -1, SQLITE_PREPARE_PERSISTENT, statement, NULL);
    if (rc == SQLITE_OK && store->prepared < LP_STORE_STATEMENTS) {
        store->kept[store->prepared].sql = sql;
        store->kept[store->prepared++].statement = *statement;
    }
    return rc;
}

lensprof_status lp_store_prepare(lensprof_store *store, const char *sql, sqlite3_stmt **statement,
                                 lensprof_error *error) {
    const int rc = prepare(store, sql, statement);
    return rc ? lp_store_fail_sql(store->path, store->db, rc, error) : LENSPROF_OK;
}

void lp_store_release(lensprof_store *store, sqlite3_stmt *statement) {
    if (is_kept(store, statement)) {
        (void)sqlite3_reset(statement); /* the step before reported the same */
        (void)sqlite3_clear_bindings(statement);
    } else
        sqlite3_finalize(statement);
}

void lp_store_forget_statements(lensprof_store *store) {
    while (store->prepared) sqlite3_finalize(store->kept[--store->prepared].statement);
}

int lp_store_execute(lensprof_store *store, const char *sql) {
    sqlite3_stmt *statement;
    int rc = prepare(store, sql, &statement);
    if (rc) return rc;
    rc = sqlite3_step(statement);
    lp_store_release(store, statement);
    return rc == SQLITE_DONE || rc == SQLITE_ROW ? SQLITE_OK : rc;
}

int lp_store_integer(lensprof_store *store, const char *sql, int64_t *value) {
    sqlite3_stmt *statement;
    int rc = prepare(store, sql, &statement);
    if (rc) return rc;
    rc = sqlite3_step(statement);
    if (rc == SQLITE_ROW) *value = sqlite3_column_int64(statement, 0);
    lp_store_release(store, statement);
    return rc == SQLITE_ROW ? SQLITE_OK : rc == SQLITE_DONE ? SQLITE_CORRUPT : rc;
}

lensprof_status lp_store_run(lensprof_store *store, lp_store_binder *binder, lensprof_error *error) {
    int rc = binder->rc;
    if (rc == SQLITE_OK) rc = sqlite3_step(binder->statement);
    lensprof_status status = rc == SQLITE_DONE ? LENSPROF_OK : lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder->statement);
    return status;
}
