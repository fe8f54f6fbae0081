/* The surroundings of the file: its folder, and a log next to it. Uses SQLite's file layer, without a connection. */
#include "store/file/private.h"

#include <string.h>

bool lp_store_has_log(const char *full) {
    sqlite3_vfs *vfs = sqlite3_vfs_find(NULL);
    char *log = sqlite3_mprintf("%s-wal", full);
    int exists = 0;
    if (log) (void)vfs->xAccess(vfs, log, SQLITE_ACCESS_EXISTS, &exists); /* false for one of no bytes */
    sqlite3_free(log);
    return exists != 0;
}

bool lp_store_is_folder_writable(const char *full, bool *exists) {
    sqlite3_vfs *vfs = sqlite3_vfs_find(NULL); /* there is one: it was asked to open the file */
    const char *slash = strrchr(full, '/');
    char *folder = slash ? sqlite3_mprintf("%.*s", (int)(slash - full) + 1, full) : sqlite3_mprintf(".");
    int is_there = 1, writable = 1;
    if (folder) (void)vfs->xAccess(vfs, folder, SQLITE_ACCESS_EXISTS, &is_there);
    if (folder) (void)vfs->xAccess(vfs, folder, SQLITE_ACCESS_READWRITE, &writable);
    sqlite3_free(folder);
    *exists = is_there != 0;
    return writable != 0;
}
