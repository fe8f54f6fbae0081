/* The write-ahead log: readers and one writer simultaneously, and a commit is one synchronised write. */
#include "store/file/private.h"

#define SETTLE_MS 50 /* others that read keep the mode from being changed; the next write tries again */

/* Those who use a log hold a lock on the file. Without them its index can go; SQLite removes the log itself. */
void lp_store_clear_log(const char *full) {
    sqlite3_vfs *vfs = sqlite3_vfs_find(NULL);
    char *shared = sqlite3_mprintf("%s-shm", full);
    sqlite3 *db = NULL;
    if (shared && sqlite3_open_v2(full, &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL) == SQLITE_OK
        && sqlite3_exec(db, "PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE", NULL, NULL, NULL) == SQLITE_OK)
        (void)vfs->xDelete(vfs, shared, 0);
    sqlite3_close(db);
    sqlite3_free(shared);
}

/* Back to a rollback journal, where the file system has no memory that processes share: a connection alone needs none.
 */
static void leave_log(const char *full) {
    sqlite3 *db;
    if (sqlite3_open_v2(full, &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL) == SQLITE_OK)
        (void)sqlite3_exec(db, "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = DELETE", NULL, NULL, NULL);
    sqlite3_close(db);
}

int lp_store_settle_journal(lensprof_store *store) {
    int64_t pages;
    if (store->journal_ready) return SQLITE_OK;
    sqlite3_busy_timeout(store->db, store->busy_ms < SETTLE_MS ? store->busy_ms : SETTLE_MS);
    int rc = lp_store_execute(store, "PRAGMA journal_mode = WAL"); /* stays as it is where there can be no log */
    if (rc == SQLITE_OK) {
        rc = lp_store_integer(store, "PRAGMA page_count", &pages);
        if (rc == SQLITE_PROTOCOL || (rc & 0xff) == SQLITE_IOERR || (rc & 0xff) == SQLITE_CANTOPEN)
            leave_log(sqlite3_db_filename(store->db, "main"));
        store->journal_ready = rc == SQLITE_OK;
    }
    sqlite3_busy_timeout(store->db, store->busy_ms);
    return rc;
}
