/* Opening, creating and closing a database. */
#include "store/file/private.h"

#include <stdlib.h>
#include <string.h>

#if SQLITE_VERSION_NUMBER < 3037000
#error "lensprof needs SQLite 3.37 or newer (STRICT tables)"
#endif

/* In an IMMEDIATE transaction: makes the tables unless another process was quicker. */
static int make_tables(sqlite3 *db) {
    int64_t application_id = 0, tables = 0;
    int rc = lp_store_number(db, "PRAGMA application_id", &application_id);
    if (rc == SQLITE_OK) rc = lp_store_number(db, "SELECT count(*) FROM sqlite_master", &tables);
    if (rc == SQLITE_OK && application_id == 0 && tables == 0) rc = lp_store_migrate(db, 0);
    return rc;
}

static lensprof_status create_when_empty(lensprof_store *store, lensprof_error *error) {
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
static lensprof_status check_tables(lensprof_store *store, lensprof_error *error) {
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    static const char *const columns[LP_STORE_LAYOUT] = {
        "SELECT mode, k1 FROM profiles, responses, emor_coefficients, vignettings",
        "SELECT mode, k1, channels FROM profiles, responses, emor_coefficients, vignettings, gain_grids",
        "SELECT mode, k1, channels, unit FROM profiles, responses, emor_coefficients, vignettings, gain_grids",
        "SELECT mode, k1, channels, prior_id FROM profiles, responses, emor_coefficients, vignettings, gain_grids",
        ("SELECT mode, k1, channels, gamma_sigma, crop FROM profiles, responses, emor_coefficients, vignettings, gain_grids,"
         " (SELECT crop_factor AS crop FROM cameras)"),
        ("SELECT mode, k1, channels, white_level, crop FROM profiles, responses, emor_coefficients, vignettings, gain_grids,"
         " (SELECT crop_factor AS crop FROM cameras)"),
        ("SELECT mode, k1, channels, circle_radius, crop FROM profiles, responses, emor_coefficients, vignettings,"
         " gain_grids, (SELECT crop_factor AS crop FROM cameras)")};
    const int rc = sqlite3_prepare_v2(store->db, lp_store_of_layout(store, columns), -1, &statement, NULL);
    if (rc) status = lp_store_fail_sql(store->path, store->db, rc, error);
    sqlite3_finalize(statement);
    lp_store_rollback(store);
    return status;
}

/* Read-only media: a log and its index cannot be created next to the file, and are not needed if there is no log. */
static bool is_immutable(const lensprof_store *store, const char *full, lp_store_file file) {
    bool exists;
    return store->mode == LENSPROF_STORE_READ && file == LP_STORE_FILE_LOGGED
           && !lp_store_is_folder_writable(full, &exists) && !lp_store_has_log(full);
}

static lensprof_status connect(lensprof_store *store, const char *full, lensprof_error *error) {
    const int rc = lp_store_connect(store, full, store->immutable, &store->db);
    if (rc) return lp_store_fail_sql(store->path, store->db, rc, error);
    /* SQLite opens a file for reading when it may not be written. */
    if (store->mode != LENSPROF_STORE_READ && sqlite3_db_readonly(store->db, "main") == 1)
        return lp_store_fail_sql(store->path, NULL, SQLITE_READONLY, error);
    lensprof_status status = LENSPROF_OK;
    if (store->mode == LENSPROF_STORE_CREATE) status = create_when_empty(store, error);
    if (status == LENSPROF_OK) status = check_tables(store, error);
    if (status == LENSPROF_OK) /* KiB; it reads the file, whose failures check_tables has reported */
        (void)sqlite3_exec(store->db, "PRAGMA cache_size = -16000", NULL, NULL, NULL);
    return status;
}

/* A full disk has no room for the index of a log either. Then what is in the file can still be read: where nothing can
 * be written, it does not change. */
static lensprof_status connect_to(lensprof_store *store, const char *full, lp_store_file file, lensprof_error *error) {
    store->immutable = is_immutable(store, full, file);
    lensprof_status status = connect(store, full, error);
    const bool no_room =
        status == LENSPROF_ERROR_FULL || status == LENSPROF_ERROR_STORE || status == LENSPROF_ERROR_READ_ONLY;
    if (!no_room || file != LP_STORE_FILE_LOGGED || store->immutable || lp_store_has_log(full)) return status;
    lp_store_forget_statements(store);
    sqlite3_close(store->db);
    store->db = NULL;
    lp_store_clear_log(full);
    if (store->mode != LENSPROF_STORE_READ) return status;
    store->immutable = true;
    return connect(store, full, error);
}

static lensprof_status check_file(const char *path, uint32_t mode, lp_store_file file, lensprof_error *error) {
    if (file == LP_STORE_FILE_MISSING && mode != LENSPROF_STORE_CREATE)
        return lp_store_fail(path, LENSPROF_ERROR_NOT_FOUND, "no such file",
                             "check the path; storing a profile creates a new database", error);
    if (file == LP_STORE_FILE_FOREIGN)
        return lp_store_fail(path, LENSPROF_ERROR_CORRUPT, "is not a lensprof database",
                             "give the path of another file, or restore it from a copy", error);
    return LENSPROF_OK;
}

lensprof_status lp_store_open_waiting(const char *path, uint32_t mode, int busy_ms, lensprof_store **store,
                                      lensprof_error *error) {
    lp_store_clear(error);
    if (!path || !*path) return lp_store_fail_argument("no path; give the path of a file", error);
    if (!store) return lp_store_fail_argument("store is NULL; pass the address of a handle", error);
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
        made->busy_ms = busy_ms;
        made->journal_ready = made->immutable = made->batch = false;
        made->prepared = 0;
        made->damage[0] = 0;
        memcpy(made->path, path, length + 1);
        status = connect_to(made, full, file, error);
    }
    sqlite3_free(full);
    if (status == LENSPROF_OK)
        *store = made;
    else
        lensprof_store_close(made);
    return status;
}

lensprof_status lensprof_store_open(const char *path, uint32_t mode, lensprof_store **store, lensprof_error *error) {
    return lp_store_open_waiting(path, mode, LP_STORE_BUSY_MS, store, error);
}

void lensprof_store_close(lensprof_store *store) {
    if (!store) return;
    lp_store_forget_statements(store);
    sqlite3_close(store->db);
    free(store);
}
