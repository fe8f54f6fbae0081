/* The database under adverse conditions: files that are missing, foreign, protected or locked, and a full disk. */
#include "store_fixture.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

/* Opening fails with `status`, a text that names the file, and no handle. */
static void assert_refused(const char *path, uint32_t mode, lensprof_status status) {
    lensprof_store *store = NULL;
    lensprof_error error = {"", {0, 0, 0, 0}};
    lensprof_status found = lp_store_open_waiting(path, mode, 20, &store, &error);
    if (found != status) fail_msg("mode %u: %s: %s", mode, lensprof_status_name(found), error.text);
    assert_null(store);
    const char *name = strrchr(path, '/');
    if (!strstr(error.text, name ? name + 1 : path) || !strstr(error.text, "; ")) fail_msg("text: %s", error.text);
}

/* Every mode refuses the file; it stays unchanged, and no new file appears next to it. */
static void assert_refused_untouched(const place *here, lensprof_status status) {
    size_t size, entries[2] = {0, 0};
    unsigned char *bytes = read_file(here->path, &size);
    for (int after = 0; after < 2; after++) {
        for (uint32_t mode = 0; after && mode < 3; mode++) assert_refused(here->path, mode, status);
        DIR *directory = opendir(here->directory);
        while (readdir(directory)) entries[after]++;
        closedir(directory);
    }
    assert_int_equal(entries[0], entries[1]);
    assert_file(here->path, bytes, size);
    free(bytes);
}

/* A database with one profile. */
static void make_database(const place *here) {
    lensprof_profile *profile = new_profile();
    fill_profile(profile);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    put_at(store, profile);
    lensprof_store_close(store);
    free(profile);
}

/* Opens for reading: the number of profiles is right, and the file is intact. */
static void assert_profiles(const char *path, uint32_t count) {
    lensprof_store *store = store_at(path, LENSPROF_STORE_READ);
    assert_int_equal(count_at(store), count);
    lensprof_store_close(store);
    assert_integrity(path);
}

static void test_missing_file(void **state) {
    const place *here = *state;
    char path[300];
    assert_refused(here->path, LENSPROF_STORE_READ, LENSPROF_ERROR_NOT_FOUND);
    assert_refused(here->path, LENSPROF_STORE_WRITE, LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(access(here->path, F_OK), -1);
    snprintf(path, sizeof path, "%s/no/such.db", here->directory);
    for (uint32_t mode = 0; mode < 3; mode++) assert_refused(path, mode, LENSPROF_ERROR_NOT_FOUND);
}

static void test_directory(void **state) {
    const place *here = *state;
    for (uint32_t mode = 0; mode < 3; mode++) assert_refused(here->directory, mode, LENSPROF_ERROR_STORE);
}

static void test_path_through_a_file(void **state) {
    const place *here = *state;
    char path[300];
    write_file(here->path, "x", 1);
    snprintf(path, sizeof path, "%s/profiles.db", here->path);
    lensprof_store *store = NULL;
    for (uint32_t mode = 0; mode < 3; mode++) {
        assert_int_not_equal(lensprof_store_open(path, mode, &store, NULL), LENSPROF_OK);
        assert_null(store);
    }
}

static void test_overlong_path(void **state) {
    char path[5001];
    (void)state;
    memset(path, 'x', 5000);
    path[5000] = 0;
    lensprof_store *store = NULL;
    lensprof_error error;
    for (uint32_t mode = 0; mode < 3; mode++)
        assert_int_equal(lensprof_store_open(path, mode, &store, &error), LENSPROF_ERROR_STORE);
    assert_int_equal(strncmp(error.text, "...xxx", 6), 0);
    assert_non_null(strstr(error.text, "; "));
}

static void test_text_file(void **state) {
    const place *here = *state;
    static char text[5000];
    memset(text, 'a', sizeof text);
    static const size_t sizes[] = {1, 2, 15, 16, 99, 100, 101, 512, 4096, 5000};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        write_file(here->path, text, sizes[i]);
        assert_refused_untouched(here, LENSPROF_ERROR_CORRUPT);
    }
    memcpy(text, "SQLite format 3", 16); /* only resembles a database */
    write_file(here->path, text, sizeof text);
    assert_refused_untouched(here, LENSPROF_ERROR_CORRUPT);
    memcpy(text + 68, "LPRF", 4);
    write_file(here->path, text, sizeof text);
    assert_refused_untouched(here, LENSPROF_ERROR_CORRUPT);
}

static void test_empty_file(void **state) {
    const place *here = *state;
    write_file(here->path, "", 0);
    assert_refused(here->path, LENSPROF_STORE_READ, LENSPROF_ERROR_CORRUPT);
    assert_refused(here->path, LENSPROF_STORE_WRITE, LENSPROF_ERROR_CORRUPT);
    assert_file(here->path, "", 0);
    make_database(here);
    assert_profiles(here->path, 1);
}

/* Ends without a commit after some pages were written to the file: the worst case of kill -9. */
static void cut_off_write(const char *path, const char *sql) {
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        sqlite3 *db;
        if (sqlite3_open(path, &db)) _exit(1);
        _exit(sqlite3_exec(db, "PRAGMA cache_size = 1; PRAGMA cache_spill = 1; BEGIN IMMEDIATE", NULL, NULL, NULL)
              || sqlite3_exec(db, sql, NULL, NULL, NULL));
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
}

static void test_foreign_database(void **state) {
    const place *here = *state;
    run_sql(here->path, "CREATE TABLE profiles (a); INSERT INTO profiles VALUES (1)");
    assert_refused_untouched(here, LENSPROF_ERROR_CORRUPT);
    run_sql(here->path,
            "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 500)"
            " INSERT INTO profiles SELECT randomblob(1000) FROM n");
    cut_off_write(here->path, "UPDATE profiles SET a = randomblob(1000)");
    assert_refused_untouched(here, LENSPROF_ERROR_CORRUPT); /* not even rolled back */
}

static void test_foreign_database_with_log(void **state) {
    const place *here = *state;
    char log[200];
    sqlite3 *db;
    run_sql(here->path, "PRAGMA journal_mode = WAL; CREATE TABLE profiles (a)");
    assert_int_equal(sqlite3_open(here->path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_db_config(db, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, "INSERT INTO profiles VALUES (1)", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    snprintf(log, sizeof log, "%s-wal", here->path);
    assert_int_equal(access(log, F_OK), 0);
    assert_refused_untouched(here, LENSPROF_ERROR_CORRUPT);
}

static void test_layouts(void **state) {
    const place *here = *state;
    lensprof_store *store = NULL;
    lensprof_error error;
    make_database(here);
    run_sql(here->path, "PRAGMA user_version = 8");
    assert_refused_untouched(here, LENSPROF_ERROR_LAYOUT);
    assert_int_equal(lensprof_store_open(here->path, 0, &store, &error), LENSPROF_ERROR_LAYOUT);
    assert_non_null(strstr(error.text, "layout 8"));
    run_sql(here->path, "PRAGMA user_version = 0");
    assert_refused_untouched(here, LENSPROF_ERROR_CORRUPT);
    run_sql(here->path, "PRAGMA user_version = 7");
    store = store_at(here->path, LENSPROF_STORE_WRITE);
    run_sql(here->path, "PRAGMA user_version = 8"); /* another process upgrades it while it is open here */
    assert_int_equal(lensprof_store_list(store, NULL, NULL, 0, &(uint32_t){0}, &error), LENSPROF_ERROR_LAYOUT);
    assert_int_equal(lensprof_store_remove(store, 1, &error), LENSPROF_ERROR_LAYOUT);
    lensprof_store_close(store);
}

static void test_names_that_sqlite_reads_otherwise(void **state) {
    const place *here = *state;
    static const char *const names[] = {":memory:", "file:x.db?mode=memory", "100%.db", "a b.db", "#1.db"};
    char old[PATH_MAX];
    assert_non_null(getcwd(old, sizeof old));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(chdir(here->directory), 0);
        lensprof_store *store = store_at(names[i], LENSPROF_STORE_CREATE);
        int exists = access(names[i], F_OK);
        assert_int_equal(chdir(old), 0); /* the handle keeps its file */
        assert_int_equal(exists, 0);
        assert_int_equal(count_at(store), 0);
        lensprof_store_close(store);
    }
}

static void test_symbolic_link(void **state) {
    const place *here = *state;
    char link[200];
    make_database(here);
    snprintf(link, sizeof link, "%s/link.db", here->directory);
    assert_int_equal(symlink(here->path, link), 0);
    assert_profiles(link, 1);
    assert_int_equal(unlink(here->path), 0);
    assert_refused(link, LENSPROF_STORE_READ, LENSPROF_ERROR_NOT_FOUND);
}

/* A handle without write access, on a database with one profile. */
static void assert_reads_only(lensprof_store *store) {
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    int64_t id = 99;
    assert_int_equal(count_at(store), 1);
    assert_ok(lensprof_store_get(store, 1, profile, NULL));
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_READ_ONLY);
    assert_non_null(strstr(error.text, "profiles.db: "));
    assert_int_equal(lensprof_store_remove(store, 1, &error), LENSPROF_ERROR_READ_ONLY);
    assert_int_equal(id, 99);
    assert_int_equal(count_at(store), 1);
    lensprof_store_close(store);
    free(profile);
}

static void test_reading_writes_nothing(void **state) {
    const place *here = *state;
    size_t size;
    make_database(here);
    unsigned char *bytes = read_file(here->path, &size);
    assert_reads_only(store_at(here->path, LENSPROF_STORE_READ));
    assert_file(here->path, bytes, size);
    free(bytes);
}

static void test_protected_file(void **state) {
    const place *here = *state;
    make_database(here);
    if (!set_protected(here->path, true)) skip();
    assert_refused(here->path, LENSPROF_STORE_WRITE, LENSPROF_ERROR_READ_ONLY);
    assert_refused(here->path, LENSPROF_STORE_CREATE, LENSPROF_ERROR_READ_ONLY);
    assert_reads_only(store_at(here->path, LENSPROF_STORE_READ));
}

static void test_protected_directory(void **state) {
    const place *here = *state;
    char path[200];
    make_database(here);
    if (!set_protected(here->directory, true)) skip();
    assert_reads_only(store_at(here->path, LENSPROF_STORE_READ));
    assert_refused(here->path, LENSPROF_STORE_WRITE, LENSPROF_ERROR_READ_ONLY); /* the log cannot be created */
    snprintf(path, sizeof path, "%s/new.db", here->directory);
    assert_refused(path, LENSPROF_STORE_CREATE, LENSPROF_ERROR_READ_ONLY);
}

static void test_cut_off_write_is_undone(void **state) {
    const place *here = *state;
    char journal[200];
    size_t size;
    snprintf(journal, sizeof journal, "%s-journal", here->path);
    for (uint32_t mode = 0; mode < 3; mode++) {
        unlink(here->path);
        make_database(here);
        run_sql(here->path, "PRAGMA journal_mode = DELETE"); /* as in versions without a log */
        unsigned char *bytes = read_file(here->path, &size);
        cut_off_write(here->path,
                      "WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n WHERE i < 50)"
                      " INSERT INTO responses SELECT i, 0, 'table', NULL, NULL, zeroblob(8192) FROM n;"
                      " UPDATE profiles SET covariance = zeroblob(800), source = 'cut off'");
        assert_int_equal(access(journal, F_OK), 0);
        lensprof_store *store = store_at(here->path, mode);
        assert_int_equal(count_at(store), 1);
        lensprof_store_close(store);
        assert_file(here->path, bytes, size);
        free(bytes);
    }
    cut_off_write(here->path,
                  "UPDATE profiles SET covariance = zeroblob(800);"
                  " INSERT INTO responses VALUES (1, 1, 'table', NULL, NULL, zeroblob(8192))");
    if (!set_protected(here->path, true)) skip();
    lensprof_store *store = NULL;
    lensprof_error error;
    assert_int_equal(lensprof_store_open(here->path, 0, &store, &error), LENSPROF_ERROR_READ_ONLY);
    assert_non_null(strstr(error.text, "interrupted write"));
    assert_true(set_protected(here->path, false));
    assert_profiles(here->path, 1);
}

static void test_removed_while_open(void **state) {
    const place *here = *state;
    lensprof_error error;
    make_database(here);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    assert_int_equal(unlink(here->path), 0);
    assert_int_equal(lensprof_store_remove(store, 1, &error), LENSPROF_ERROR_STORE);
    assert_non_null(strstr(error.text, "moved or removed"));
    lensprof_store_close(store);
}

/* SQLite's page limit simulates a full disk. */
static void test_no_page_left(void **state) {
    const place *here = *state;
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    int64_t id = 99, pages;
    char sql[60];
    size_t size;
    make_database(here);
    unsigned char *bytes = read_file(here->path, &size);
    fill_profile(profile);
    profile->response[0].kind = LENSPROF_RESPONSE_TABLE;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    assert_int_equal(lp_store_number(store->db, "PRAGMA page_count", &pages), SQLITE_OK);
    for (int more = 0; more < 2; more++) {
        snprintf(sql, sizeof sql, "PRAGMA max_page_count = %d", (int)pages + more);
        assert_int_equal(sqlite3_exec(store->db, sql, NULL, NULL, NULL), SQLITE_OK);
        assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_FULL);
        assert_non_null(strstr(error.text, "profiles.db: no space left"));
        assert_int_equal(id, 99);
        assert_int_equal(count_at(store), 1);
        assert_file(here->path, bytes, size);
    }
    assert_int_equal(sqlite3_exec(store->db, "PRAGMA max_page_count = 1000", NULL, NULL, NULL), SQLITE_OK);
    assert_int_equal(put_at(store, profile), 2); /* the handle remains usable */
    lensprof_store_close(store);
    assert_profiles(here->path, 2);
    free(bytes);
    free(profile);
}

/* In a child whose files may not grow beyond `bytes`: stores profiles until that fails. Exit code: 100 + the number of
 * stored profiles if the failure was as expected; `there` profiles were in the file before. */
static int fill_limited(const char *path, rlim_t bytes, uint32_t there) {
    pid_t child = fork();
    if (child == 0) {
        struct rlimit limit = {bytes, bytes};
        lensprof_profile *profile = new_profile();
        lensprof_store *store = NULL;
        int64_t id;
        int stored = 0;
        signal(SIGXFSZ, SIG_IGN);
        fill_profile(profile);
        profile->response[0].kind = LENSPROF_RESPONSE_TABLE;
        if (setrlimit(RLIMIT_FSIZE, &limit)) _exit(1);
        lensprof_status status = lensprof_store_open(path, LENSPROF_STORE_CREATE, &store, NULL);
        while (status == LENSPROF_OK && stored < 100)
            if ((status = lensprof_store_put(store, profile, &id, NULL)) == LENSPROF_OK) stored++;
        uint32_t found = 0;
        if (store && lensprof_store_list(store, NULL, NULL, 0, &found, NULL)) _exit(2);
        if (store && found != there + (uint32_t)stored) _exit(3);
        _exit(status == LENSPROF_ERROR_FULL ? 100 + stored : (int)status);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void test_no_room_for_the_file(void **state) {
    const place *here = *state;
    static const rlim_t limits[] = {1, 5000, 20000, 60000, 100000, 200001};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        unlink(here->path);
        int code = fill_limited(here->path, limits[i], 0);
        assert_in_range(code, 100, 199);
        if (limits[i] > 100000) assert_true(code > 102);
        lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE); /* there is room again */
        assert_int_equal(count_at(store), code - 100);
        lensprof_store_close(store);
        assert_profiles(here->path, (uint32_t)code - 100);
    }
    unlink(here->path);
    make_database(here);
    size_t size;
    unsigned char *bytes = read_file(here->path, &size);
    assert_int_equal(fill_limited(here->path, 600, 1), 100); /* not even room for the journal */
    assert_profiles(here->path, 1);
    assert_file(here->path, bytes, size);
    free(bytes);
}

static void test_busy(void **state) {
    const place *here = *state;
    lensprof_profile *profile = new_profile();
    lensprof_store *store = NULL;
    lensprof_error error;
    int64_t id = 99;
    sqlite3 *other;
    make_database(here);
    fill_profile(profile);
    assert_ok(lp_store_open_waiting(here->path, LENSPROF_STORE_WRITE, 20, &store, NULL));
    assert_int_equal(sqlite3_open(here->path, &other), SQLITE_OK);
    assert_int_equal(sqlite3_exec(other, "BEGIN IMMEDIATE", NULL, NULL, NULL), SQLITE_OK);
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_BUSY);
    assert_non_null(strstr(error.text, "locked by another process"));
    assert_int_equal(lensprof_store_remove(store, 1, &error), LENSPROF_ERROR_BUSY);
    assert_int_equal(count_at(store), 1); /* readers continue */
    assert_int_equal(sqlite3_exec(other, "COMMIT; BEGIN EXCLUSIVE", NULL, NULL, NULL), SQLITE_OK);
    assert_ok(lensprof_store_get(store, 1, profile, &error));
    for (uint32_t mode = 0; mode < 3; mode++) lensprof_store_close(store_at(here->path, mode));
    assert_int_equal(sqlite3_exec(other, "COMMIT; BEGIN; SELECT count(*) FROM profiles", NULL, NULL, NULL), SQLITE_OK);
    assert_int_equal(put_at(store, profile), 2); /* no trace of the failed ones; a reader does not block it */
    assert_int_equal(sqlite3_exec(other, "COMMIT", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(other);
    lensprof_store_close(store);
    assert_profiles(here->path, 2);
    free(profile);
}

/* The probe of a second handle in one process must not drop the locks of the first. */
static void test_opening_keeps_locks_of_this_process(void **state) {
    const place *here = *state;
    sqlite3 *holder;
    make_database(here);
    assert_int_equal(sqlite3_open(here->path, &holder), SQLITE_OK);
    assert_int_equal(sqlite3_exec(holder, "BEGIN IMMEDIATE", NULL, NULL, NULL), SQLITE_OK);
    lensprof_store_close(store_at(here->path, LENSPROF_STORE_WRITE));
    pid_t child = fork();
    if (child == 0) {
        lensprof_store *store = NULL;
        if (lp_store_open_waiting(here->path, LENSPROF_STORE_WRITE, 20, &store, NULL)) _exit(1);
        _exit((int)lensprof_store_remove(store, 1, NULL));
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(WEXITSTATUS(status), LENSPROF_ERROR_BUSY);
    assert_int_equal(sqlite3_exec(holder, "COMMIT", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(holder);
}

static void test_several_processes_create_and_put(void **state) {
    const place *here = *state;
    enum {
        PROCESSES = 4,
        PUTS = 5
    };
    for (int i = 0; i < PROCESSES; i++)
        if (fork() == 0) {
            lensprof_profile *profile = new_profile();
            lensprof_store *store = NULL;
            int64_t id;
            fill_profile(profile);
            lensprof_status status = lensprof_store_open(here->path, LENSPROF_STORE_CREATE, &store, NULL);
            for (int k = 0; k < PUTS && status == LENSPROF_OK; k++)
                status = lensprof_store_put(store, profile, &id, NULL);
            _exit((int)status);
        }
    for (int i = 0; i < PROCESSES; i++) {
        int status = 0;
        assert_true(wait(&status) > 0);
        assert_int_equal(status, 0);
    }
    assert_profiles(here->path, PROCESSES * PUTS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_missing_file),
        store_test(test_directory),
        store_test(test_path_through_a_file),
        store_test(test_overlong_path),
        store_test(test_text_file),
        store_test(test_empty_file),
        store_test(test_foreign_database),
        store_test(test_foreign_database_with_log),
        store_test(test_layouts),
        store_test(test_names_that_sqlite_reads_otherwise),
        store_test(test_symbolic_link),
        store_test(test_reading_writes_nothing),
        store_test(test_protected_file),
        store_test(test_protected_directory),
        store_test(test_cut_off_write_is_undone),
        store_test(test_removed_while_open),
        store_test(test_no_page_left),
        store_test(test_no_room_for_the_file),
        store_test(test_busy),
        store_test(test_opening_keeps_locks_of_this_process),
        store_test(test_several_processes_create_and_put),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
