/* From what went wrong to a status and a sentence. */
#include "store/file/private.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define PATH_SHOWN 100 /* bytes of a path in a text, which holds 255 */

void lp_store_clear(lensprof_error *error) {
    if (error) memset(error, 0, sizeof *error);
}

/* The end of a long path, from the start of a UTF-8 character. */
static const char *path_tail(const char *path) {
    size_t length = strlen(path);
    if (length <= PATH_SHOWN) return path;
    path += length - PATH_SHOWN;
    while (((unsigned char)*path & 0xc0) == 0x80) path++;
    return path;
}

lensprof_status lp_store_fail(const char *path, lensprof_status status, const char *problem, const char *next,
                              lensprof_error *error) {
    const char *tail = path_tail(path);
    if (error)
        snprintf(error->text, sizeof error->text, "%s%s: %s; %s", tail == path ? "" : "...", tail, problem, next);
    return status;
}

lensprof_status lp_store_fail_argument(const char *problem, lensprof_error *error) {
    if (error) snprintf(error->text, sizeof error->text, "profile database: %s", problem);
    return LENSPROF_ERROR_ARGUMENT;
}

lensprof_status lp_store_fail_capacity(uint32_t rows, uint32_t capacity, lensprof_error *error) {
    if (error)
        snprintf(
            error->text, sizeof error->text,
            "profile database: %u rows do not fit the buffer of %u; pass a larger one, or capacity 0 to get the number",
            rows, capacity);
    return LENSPROF_ERROR_CAPACITY;
}

lensprof_status lp_store_fail_size(const char *name, const char *wrong, lensprof_error *error) {
    if (error) snprintf(error->text, sizeof error->text, "%s: %s", name, wrong);
    return LENSPROF_ERROR_STRUCT_SIZE;
}

lensprof_status lp_store_check_size(const lensprof_profile *profile, lensprof_error *error) {
    const char *wrong = lp_sized_wrong(profile, LP_FIRST_PROFILE, sizeof *profile);
    return wrong ? lp_store_fail_size("lensprof_profile", wrong, error) : LENSPROF_OK;
}

/* The error of the system; SQLite forgets it when it cleans up after a failed COMMIT, the file does not. 0 = nothing.
 */
static int last_errno(sqlite3 *db) {
    int number = sqlite3_system_errno(db);
    sqlite3_file *log = NULL;
    if (!number) (void)sqlite3_file_control(db, "main", SQLITE_FCNTL_LAST_ERRNO, &number);
    if (!number) (void)sqlite3_file_control(db, "main", SQLITE_FCNTL_JOURNAL_POINTER, &log);
    if (log && log->pMethods) (void)log->pMethods->xFileControl(log, SQLITE_FCNTL_LAST_ERRNO, &number);
    return number;
}

/* A file that could not be opened or made: SQLite tries several ways, and its errno is that of the last. */
static lensprof_status status_of_folder(const char *path) {
    bool exists;
    const bool writable = lp_store_is_folder_writable(path, &exists);
    return !exists ? LENSPROF_ERROR_NOT_FOUND : !writable ? LENSPROF_ERROR_READ_ONLY : LENSPROF_ERROR_STORE;
}

static lensprof_status status_of_errno(int number) {
    switch (number) {
    case EACCES:
    case EPERM:
    case EROFS: return LENSPROF_ERROR_READ_ONLY;
    case ENOSPC:
#ifdef EDQUOT
    case EDQUOT:
#endif
    case EFBIG: return LENSPROF_ERROR_FULL;
    case ENOMEM: return LENSPROF_ERROR_MEMORY;
    default: return LENSPROF_ERROR_STORE;
    }
}

static lensprof_status status_of(int rc, const char *path, sqlite3 *db) {
    if (rc == SQLITE_IOERR_NOMEM) return LENSPROF_ERROR_MEMORY;
    if (rc == SQLITE_IOERR_SHORT_READ || rc == SQLITE_IOERR_CORRUPTFS) return LENSPROF_ERROR_CORRUPT;
    if (rc == SQLITE_READONLY_DBMOVED) return LENSPROF_ERROR_STORE;
    switch (rc & 0xff) {
    case SQLITE_NOMEM: return LENSPROF_ERROR_MEMORY;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_PROTOCOL: return LENSPROF_ERROR_BUSY;
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH: return LENSPROF_ERROR_READ_ONLY;
    case SQLITE_FULL: return LENSPROF_ERROR_FULL;
    case SQLITE_IOERR: return db ? status_of_errno(last_errno(db)) : LENSPROF_ERROR_STORE;
    case SQLITE_CANTOPEN: return status_of_folder(path);
    case SQLITE_ERROR: /* the SQL is fixed: the tables are not those of the layout */
    case SQLITE_CONSTRAINT:
    case SQLITE_MISMATCH:
    case SQLITE_TOOBIG:
    case SQLITE_FORMAT:
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT: return LENSPROF_ERROR_CORRUPT;
    case SQLITE_INTERNAL:
    case SQLITE_MISUSE:
    case SQLITE_RANGE: return LENSPROF_ERROR_INTERNAL;
    default: return LENSPROF_ERROR_STORE;
    }
}

static const struct sentence {
    lensprof_status status;
    const char *problem, *next;
} sentences[] = {
    {LENSPROF_ERROR_STORE, "cannot be used", "check the file and its folder"},
    {LENSPROF_ERROR_NOT_FOUND, "no such file or folder", "check the path"},
    {LENSPROF_ERROR_CORRUPT, "is damaged", "restore it from a copy"},
    {LENSPROF_ERROR_READ_ONLY, "cannot be written",
     "check the permissions of the file and its folder, or write to a copy"},
    {LENSPROF_ERROR_FULL, "no space left", "free some space and try again"},
    {LENSPROF_ERROR_BUSY, "locked by another process", "try again when that has finished"},
    {LENSPROF_ERROR_MEMORY, "out of memory", "close other programs and try again"},
    {LENSPROF_ERROR_INTERNAL, "internal error of lensprof", "please report it"},
};

lensprof_status lp_store_fail_sql(const char *path, sqlite3 *db, int rc, lensprof_error *error) {
    if (rc == SQLITE_READONLY_ROLLBACK || rc == SQLITE_READONLY_RECOVERY || rc == SQLITE_READONLY_CANTINIT)
        return lp_store_fail(path, LENSPROF_ERROR_READ_ONLY, "an interrupted write must be completed or undone first",
                             "open it once with write access", error);
    if (rc == SQLITE_READONLY_DBMOVED)
        return lp_store_fail(path, LENSPROF_ERROR_STORE, "was moved or removed while it was open", "open it again",
                             error);
    const char *full = db ? sqlite3_db_filename(db, "main") : NULL;
    lensprof_status status = status_of(rc, full && *full ? full : path, db);
    const struct sentence *sentence = sentences;
    for (size_t i = 0; i < sizeof sentences / sizeof *sentences; i++)
        if (sentences[i].status == status) sentence = &sentences[i];
    char problem[100];
    snprintf(problem, sizeof problem, "%s (%.60s)", sentence->problem, db ? sqlite3_errmsg(db) : sqlite3_errstr(rc));
    return lp_store_fail(path, status, problem, sentence->next, error);
}

lensprof_status lp_store_fail_profile(lensprof_store *store, int64_t id, const char *problem, lensprof_error *error) {
    char text[100];
    if (sqlite3_errcode(store->db) == SQLITE_NOMEM) /* a column could not be fetched */
        return lp_store_fail_sql(store->path, store->db, SQLITE_NOMEM, error);
    snprintf(text, sizeof text, "profile %lld is damaged (%.50s)", (long long)id, problem);
    snprintf(store->damage, sizeof store->damage, "%.50s", problem);
    return lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, text, "remove it, or restore the file from a copy",
                         error);
}

lensprof_status lp_store_fail_missing(const lensprof_store *store, int64_t id, lensprof_error *error) {
    char text[60];
    snprintf(text, sizeof text, "has no profile %lld", (long long)id);
    return lp_store_fail(store->path, LENSPROF_ERROR_NOT_FOUND, text, "list the profiles to see the valid ids", error);
}
