/* Allocations and file operations of SQLite fail in turn, once or permanently: each call returns a status, leaks
 * nothing, and the database is as before or after the call. */
#include "store_fixture.h"

#define MOST_ROWS 4000 /* left by the sessions of one fault */
#ifndef STEP
#define STEP 101 /* every 101st operation fails; slow every 47th, sanitized every 307th */
#endif

static int countdown = -1; /* the operation that makes it 0 fails; negative: none */
static bool for_good;      /* all later ones fail, too */
static int file_fault;     /* result code of failing file operations */
static bool sync_failed;   /* then the commit may or may not be in the log */
static char other_path[200];
static sqlite3_mem_methods memory;
static sqlite3_vfs *real_vfs;

static bool faults(void) {
    if (countdown < 0) return false;
    if (countdown > 0) return --countdown == 0;
    return for_good;
}

static void *faulty_malloc(int size) { return !file_fault && faults() ? NULL : memory.xMalloc(size); }

static void *faulty_realloc(void *old, int size) { return !file_fault && faults() ? NULL : memory.xRealloc(old, size); }

/* The real file follows every faulty one in the same allocation. */
static sqlite3_file *real(sqlite3_file *file) { return file + 1; }

#define PLAIN(call) return real(file)->pMethods->call
#define FORWARD(call) return file_fault && faults() ? file_fault : real(file)->pMethods->call

static int faulty_read(sqlite3_file *file, void *bytes, int size, sqlite3_int64 at) {
    FORWARD(xRead)(real(file), bytes, size, at);
}
static int faulty_write(sqlite3_file *file, const void *bytes, int size, sqlite3_int64 at) {
    FORWARD(xWrite)(real(file), bytes, size, at);
}
static int faulty_truncate(sqlite3_file *file, sqlite3_int64 size) { FORWARD(xTruncate)(real(file), size); }
static int faulty_sync(sqlite3_file *file, int flags) {
    if (file_fault && faults()) {
        sync_failed = true;
        return file_fault;
    }
    PLAIN(xSync)(real(file), flags);
}
static int faulty_size(sqlite3_file *file, sqlite3_int64 *size) { FORWARD(xFileSize)(real(file), size); }
static int faulty_lock(sqlite3_file *file, int kind) { FORWARD(xLock)(real(file), kind); }

static int plain_close(sqlite3_file *file) { PLAIN(xClose)(real(file)); }
static int plain_unlock(sqlite3_file *file, int kind) { PLAIN(xUnlock)(real(file), kind); }
static int plain_reserved(sqlite3_file *file, int *out) { PLAIN(xCheckReservedLock)(real(file), out); }
static int plain_control(sqlite3_file *file, int op, void *data) { PLAIN(xFileControl)(real(file), op, data); }
static int plain_sector(sqlite3_file *file) { PLAIN(xSectorSize)(real(file)); }
static int plain_features(sqlite3_file *file) { PLAIN(xDeviceCharacteristics)(real(file)); }

/* Shared memory for the log's index. */
static int faulty_shm_map(sqlite3_file *file, int page, int size, int extend, void volatile **out) {
    if (file_fault && faults()) return file_fault == SQLITE_FULL ? SQLITE_FULL : SQLITE_IOERR_SHMMAP;
    PLAIN(xShmMap)(real(file), page, size, extend, out);
}
static int plain_shm_lock(sqlite3_file *file, int at, int n, int flags) { PLAIN(xShmLock)(real(file), at, n, flags); }
static void plain_shm_barrier(sqlite3_file *file) { real(file)->pMethods->xShmBarrier(real(file)); }
static int plain_shm_unmap(sqlite3_file *file, int remove) { PLAIN(xShmUnmap)(real(file), remove); }

static const sqlite3_io_methods methods = {
    2,
    plain_close,
    faulty_read,
    faulty_write,
    faulty_truncate,
    faulty_sync,
    faulty_size,
    faulty_lock,
    plain_unlock,
    plain_reserved,
    plain_control,
    plain_sector,
    plain_features,
    faulty_shm_map,
    plain_shm_lock,
    plain_shm_barrier,
    plain_shm_unmap,
    NULL,
    NULL,
};

static int faulty_open(sqlite3_vfs *vfs, const char *name, sqlite3_file *file, int flags, int *out) {
    (void)vfs;
    file->pMethods = NULL;
    if (file_fault && faults()) return SQLITE_CANTOPEN;
    int rc = real_vfs->xOpen(real_vfs, name, real(file), flags, out);
    if (rc == SQLITE_OK) file->pMethods = &methods;
    return rc;
}

static int faulty_delete(sqlite3_vfs *vfs, const char *name, int sync) {
    (void)vfs;
    return file_fault && faults() ? SQLITE_IOERR_DELETE : real_vfs->xDelete(real_vfs, name, sync);
}

/* A batch that is rolled back, a check of everything, a lookup, and a merge that is rolled back. */
static lensprof_status whole_database(lensprof_store *store, const lensprof_profile *profile, lensprof_error *error) {
    static lensprof_profile found = {.struct_size = sizeof found};
    lensprof_lookup_options options;
    lensprof_lookup how = {.struct_size = sizeof how};
    lensprof_store *other = NULL;
    lensprof_store_stats stats = {.struct_size = sizeof stats};
    uint32_t bad = 0, added = 99;
    lensprof_lookup_options_init(&options);
    lensprof_status status = lensprof_store_lookup(store, &profile->key, &options, &found, &how, error);
    if (status == LENSPROF_OK) assert_same_profile(&found, profile);
    if (status == LENSPROF_OK) status = lensprof_store_check(store, NULL, NULL, NULL, &bad, error);
    if (status == LENSPROF_OK) assert_int_equal(bad, 0);
    if (status == LENSPROF_OK) status = lensprof_store_get_stats(store, &stats, error);
    if (status == LENSPROF_OK) status = lp_store_open_waiting(other_path, LENSPROF_STORE_READ, 0, &other, error);
    if (status == LENSPROF_OK) status = lensprof_store_begin(store, error);
    if (status == LENSPROF_OK) status = lensprof_store_put(store, profile, NULL, error);
    if (status == LENSPROF_OK) status = lensprof_store_merge(store, other, &added, NULL, error);
    if (status == LENSPROF_OK) assert_int_equal(added, 1);
    lensprof_store_rollback(store);
    lensprof_store_close(other);
    return status;
}

/* A sequence of calls, as in a program; stores one profile. `done`: whether it is in the file. */
static lensprof_status session(const char *path, const lensprof_profile *profile, bool *done, lensprof_error *error) {
    static lensprof_profile found = {.struct_size = sizeof found};
    lensprof_store *store = NULL;
    static lensprof_store_row rows[MOST_ROWS];
    uint32_t count;
    int64_t id;
    *done = false;
    lensprof_status status = lp_store_open_waiting(path, LENSPROF_STORE_CREATE, 0, &store, error);
    if (status == LENSPROF_OK) status = lensprof_store_put(store, profile, &id, error);
    if (status == LENSPROF_OK) *done = true;
    if (status == LENSPROF_OK) status = lensprof_store_find(store, &profile->key, &found, &id, error);
    if (status == LENSPROF_OK) assert_same_profile(&found, profile);
    if (status == LENSPROF_OK) status = lensprof_store_get(store, id, &found, error);
    if (status == LENSPROF_OK) status = lensprof_store_list(store, NULL, rows, MOST_ROWS, &count, error);
    if (status == LENSPROF_OK) status = whole_database(store, profile, error);
    if (status == LENSPROF_OK) status = lensprof_store_remove(store, id, error);
    if (status == LENSPROF_OK) *done = false;
    lensprof_store_close(store);
    return status;
}

/* Initial state of a session: the file left by the previous one, no file, or a file of layout 1 to upgrade. */
typedef enum start {
    AS_LEFT,
    NO_FILE,
    LAYOUT_1
} start;

/* Lets the n-th operation fail, for growing n, until a session ends before it; returns that n. */
static int fail_each(const place *here, int first, start start_at, lensprof_status only) {
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    lensprof_status status = LENSPROF_ERROR_INTERNAL;
    uint32_t stored = 0;
    int n = 0;
    bool done;
    fill_profile(profile);
    unsigned char *layout_1 = NULL;
    size_t size = 0;
    if (start_at == LAYOUT_1) {
        make_layout(here->path, 1, NULL, 0);
        layout_1 = read_file(here->path, &size);
    }
    for (n = first; n < 200000; n += STEP) {
        if (start_at != AS_LEFT) unlink(here->path);
        if (start_at != AS_LEFT) stored = 0;
        if (start_at == LAYOUT_1) write_file(here->path, layout_1, size);
        error.text[0] = 0;
        sqlite3_int64 used = sqlite3_memory_used();
        countdown = n;
        sync_failed = false;
        status = session(here->path, profile, &done, &error);
        bool reached = countdown == 0;
        countdown = -1;
        assert_int_equal(sqlite3_memory_used(), used);
        bool fine = status != LENSPROF_ERROR_INTERNAL && status != LENSPROF_ERROR_ARGUMENT;
        if (status != LENSPROF_OK && only != LENSPROF_OK) fine = status == only;
        if (status != LENSPROF_OK && !strstr(error.text, "profiles.db: ")) fine = false;
        if (!fine) fail_msg("n = %d: %s: %s", n, lensprof_status_name(status), error.text);
        stored += done ? 1 : 0;
        lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
        uint32_t found = count_at(store);
        if (sync_failed && status != LENSPROF_OK && (found == stored + 1 || found + 1 == stored)) stored = found;
        if (found != stored) fail_msg("n = %d: %u profiles, not %u: %s", n, found, stored, error.text);
        lensprof_store_close(store);
        if (!reached) break;
    }
    assert_ok(status); /* the last session had no fault */
    assert_integrity(here->path);
    free(layout_1);
    free(profile);
    return n;
}

static void fail_each_way(void **state, int fault, lensprof_status only) {
    const place *here = *state;
    lensprof_profile *another = new_profile();
    fill_profile(another);
    another->key.aperture = 11.0;
    snprintf(other_path, sizeof other_path, "%s/other-profiles.db", here->directory);
    lensprof_store *other = store_at(other_path, LENSPROF_STORE_CREATE);
    put_at(other, another);
    lensprof_store_close(other);
    free(another);
    for (int way = 0; way < 6; way++) {
        unlink(here->path);
        if (way < 2) lensprof_store_close(store_at(here->path, LENSPROF_STORE_CREATE));
        file_fault = fault;
        for_good = way % 2;
        int n = fail_each(here, 1 + 5 * way % STEP, (start)(way / 2), only);
        file_fault = 0;
        assert_true(n > 50); /* otherwise the faults did not occur where expected */
    }
}

static void test_out_of_memory(void **state) { fail_each_way(state, 0, LENSPROF_ERROR_MEMORY); }

static void test_input_output_error(void **state) { fail_each_way(state, SQLITE_IOERR_WRITE, LENSPROF_OK); }

static void test_full_disk_at_every_operation(void **state) { fail_each_way(state, SQLITE_FULL, LENSPROF_OK); }

/* Runs before SQLite is used for the first time. */
static int install_faults(void **state) {
    static sqlite3_vfs vfs;
    sqlite3_mem_methods faulty;
    (void)state;
    if (sqlite3_config(SQLITE_CONFIG_GETMALLOC, &memory)) return -1;
    faulty = memory;
    faulty.xMalloc = faulty_malloc;
    faulty.xRealloc = faulty_realloc;
    if (sqlite3_config(SQLITE_CONFIG_MALLOC, &faulty) || sqlite3_config(SQLITE_CONFIG_LOOKASIDE, 0, 0)) return -1;
    real_vfs = sqlite3_vfs_find(NULL);
    vfs = *real_vfs;
    vfs.zName = "faulty";
    vfs.pNext = NULL;
    vfs.szOsFile = (int)sizeof(sqlite3_file) + real_vfs->szOsFile;
    vfs.xOpen = faulty_open;
    vfs.xDelete = faulty_delete;
    return sqlite3_vfs_register(&vfs, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_out_of_memory),
        store_test(test_input_output_error),
        store_test(test_full_disk_at_every_operation),
    };
    return cmocka_run_group_tests(tests, install_faults, NULL);
}
