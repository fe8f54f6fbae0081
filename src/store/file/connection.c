/* The connection to the file, and how it is configured. */
#include "store/file/private.h"

#include <stdio.h>
#include <string.h>

#define LARGEST_VALUE (1 << 20) /* bytes; the largest blob is 12288, more is a crafted file */

/* Those who only read may write to the file all the same: to undo or complete what a killed writer left, and to remove
 * the log when they are the last. query_only keeps them from more. */
static int configure(sqlite3 *db, uint32_t mode, int busy_ms) {
    int rc = sqlite3_extended_result_codes(db, 1);
    if (rc == SQLITE_OK) rc = sqlite3_busy_timeout(db, busy_ms);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_FKEY, 1, NULL);
    /* The file may come from anyone: nothing in it other than our tables must run. */
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL);
    if (rc == SQLITE_OK) rc = sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_VIEW, 0, NULL);
    sqlite3_limit(db, SQLITE_LIMIT_LENGTH, LARGEST_VALUE);
    sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
    if (rc == SQLITE_OK)
        rc = sqlite3_exec(db, "PRAGMA cell_size_check = ON; PRAGMA temp_store = MEMORY", NULL, NULL, NULL);
    if (rc == SQLITE_OK)
        rc = sqlite3_exec(db, mode == LENSPROF_STORE_READ ? "PRAGMA query_only = ON" : "PRAGMA synchronous = FULL",
                          NULL, NULL, NULL);
    return rc;
}

/* sqlite3_free it; NULL = no memory. */
static char *immutable_uri(const char *full) {
    char *uri = sqlite3_malloc64(3 * strlen(full) + 32), *end = uri;
    if (!uri) return NULL;
    end += sprintf(end, "file:");
    for (; *full; full++) {
        const bool plain = (*full >= 'a' && *full <= 'z') || (*full >= 'A' && *full <= 'Z')
                           || (*full >= '0' && *full <= '9') || strchr("/._-", *full);
        end += plain ? sprintf(end, "%c", *full) : sprintf(end, "%%%02X", (unsigned)(unsigned char)*full);
    }
    sprintf(end, "?immutable=1");
    return uri;
}

int lp_store_connect(const lensprof_store *store, const char *full, bool immutable, sqlite3 **db) {
    int flags = SQLITE_OPEN_NOMUTEX; /* a handle belongs to one thread at a time */
    flags |= immutable ? SQLITE_OPEN_READONLY | SQLITE_OPEN_URI : SQLITE_OPEN_READWRITE;
    if (store->mode == LENSPROF_STORE_CREATE) flags |= SQLITE_OPEN_CREATE;
    char *uri = immutable ? immutable_uri(full) : NULL;
    if (immutable && !uri) return SQLITE_NOMEM;
    const int rc = sqlite3_open_v2(uri ? uri : full, db, flags, NULL);
    sqlite3_free(uri);
    return rc ? rc : configure(*db, store->mode, store->busy_ms);
}

lensprof_status lp_store_refresh(lensprof_store *store, lensprof_error *error) {
    const char *full = sqlite3_db_filename(store->db, "main");
    sqlite3 *db = NULL;
    if (!store->immutable || !lp_store_has_log(full)) return LENSPROF_OK;
    const int rc = lp_store_connect(store, full, false, &db);
    if (rc) {
        lensprof_status status = lp_store_fail_sql(store->path, db, rc, error);
        sqlite3_close(db);
        return status;
    }
    lp_store_forget_statements(store);
    sqlite3_close(store->db);
    store->db = db;
    store->immutable = false;
    return LENSPROF_OK;
}
