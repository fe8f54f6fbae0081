/* What kind of file is it? Answered from the first 100 bytes, read through SQLite's own file layer: opening a foreign
 * database with SQLite proper may already change it (undo a write that was cut off, fold its log in), and closing a
 * second descriptor made with stdio would drop the locks that this process holds on the file. */
#include "store/file/private.h"

#include <string.h>

#define HEADER_BYTES 100   /* https://www.sqlite.org/fileformat2.html, section 1.3 */
#define READ_VERSION_AT 19 /* 2 = write-ahead mode */
#define APPLICATION_ID_AT 68

static uint32_t big_endian(const unsigned char *bytes) {
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static int classify(sqlite3_file *handle, lp_store_file *file) {
    unsigned char header[HEADER_BYTES];
    sqlite3_int64 size;
    int rc = handle->pMethods->xFileSize(handle, &size);
    if (rc) return rc;
    if (size == 0) { /* SQLite reports the same for one byte, for it writes an S itself on some file systems */
        rc = handle->pMethods->xRead(handle, header, 1, 0);
        *file = rc == SQLITE_OK && header[0] != 'S' ? LP_STORE_FILE_FOREIGN : LP_STORE_FILE_EMPTY;
        return rc == SQLITE_IOERR_SHORT_READ ? SQLITE_OK : rc;
    }
    *file = LP_STORE_FILE_FOREIGN;
    if (size < HEADER_BYTES) return SQLITE_OK;
    rc = handle->pMethods->xRead(handle, header, HEADER_BYTES, 0);
    if (rc) return rc;
    if (memcmp(header, "SQLite format 3", 16) == 0 && big_endian(header + APPLICATION_ID_AT) == LP_STORE_APPLICATION_ID)
        *file = header[READ_VERSION_AT] == 2 ? LP_STORE_FILE_LOGGED : LP_STORE_FILE_OURS;
    return SQLITE_OK;
}

/* `name` comes from sqlite3_create_filename, as xOpen demands. */
static int probe(sqlite3_vfs *vfs, const char *name, lp_store_file *file) {
    int exists = 0;
    sqlite3_file *handle = sqlite3_malloc(vfs->szOsFile);
    if (!handle) return SQLITE_NOMEM;
    memset(handle, 0, (size_t)vfs->szOsFile);
    int rc = vfs->xOpen(vfs, name, handle, SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_READONLY, NULL);
    if (rc == SQLITE_OK)
        rc = classify(handle, file);
    else if (vfs->xAccess(vfs, name, SQLITE_ACCESS_EXISTS, &exists) == SQLITE_OK && !exists) {
        *file = LP_STORE_FILE_MISSING;
        rc = SQLITE_OK;
    }
    if (handle->pMethods) handle->pMethods->xClose(handle);
    sqlite3_free(handle);
    return rc;
}

lensprof_status lp_store_probe(const char *path, lp_store_file *file, char **full, lensprof_error *error) {
    if (sqlite3_initialize()) return lp_store_fail_sql(path, NULL, SQLITE_NOMEM, error);
    sqlite3_vfs *vfs = sqlite3_vfs_find(NULL);
    if (!vfs) return lp_store_fail_sql(path, NULL, SQLITE_NOLFS, error);
    char *absolute = sqlite3_malloc(vfs->mxPathname + 1);
    if (!absolute) return lp_store_fail_sql(path, NULL, SQLITE_NOMEM, error);
    int rc = vfs->xFullPathname(vfs, path, vfs->mxPathname + 1, absolute);
    const char *name = NULL;
    if ((rc & 0xff) == SQLITE_OK) { /* SQLITE_OK_SYMLINK is fine too */
        name = sqlite3_create_filename(absolute, "", "", 0, NULL);
        rc = name ? probe(vfs, name, file) : SQLITE_NOMEM;
        sqlite3_free_filename((char *)name);
    }
    if (rc == SQLITE_OK) {
        *full = absolute;
        return LENSPROF_OK;
    }
    sqlite3_free(absolute);
    if (rc == SQLITE_NOMEM) return lp_store_fail_sql(path, NULL, rc, error);
    return lp_store_fail(path, LENSPROF_ERROR_STORE, "cannot be read", "check the path and its permissions", error);
}
