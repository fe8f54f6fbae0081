/* The write-ahead log: when it is created and removed, and what happens if it cannot be created. */
#include "store_fixture.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

static lensprof_profile profile;

static bool has_file(const place *here, const char *end) {
    char path[200];
    snprintf(path, sizeof path, "%s%s", here->path, end);
    return access(path, F_OK) == 0;
}

/* The journal mode in the file's header: 2 = log. */
static int mode_of(const place *here) {
    size_t size;
    unsigned char *bytes = read_file(here->path, &size);
    const int mode = bytes[18] == bytes[19] ? bytes[18] : -1;
    free(bytes);
    return mode;
}

static void make_database(const place *here, int profiles) {
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    fill_profile(&profile);
    for (int i = 0; i < profiles; i++) put_at(store, &profile);
    lensprof_store_close(store);
}

static void assert_alone(const place *here) {
    assert_false(has_file(here, "-wal") || has_file(here, "-shm") || has_file(here, "-journal"));
}

static void test_one_file_when_closed(void **state) {
    const place *here = *state;
    make_database(here, 2);
    assert_int_equal(mode_of(here), 2);
    assert_alone(here);
    lensprof_store *a = store_at(here->path, LENSPROF_STORE_WRITE), *b = store_at(here->path, LENSPROF_STORE_READ);
    put_at(a, &profile);
    assert_true(has_file(here, "-wal"));
    assert_int_equal(count_at(b), 3);
    lensprof_store_close(a); /* the reader is the last to close */
    lensprof_store_close(b);
    assert_alone(here);
    assert_integrity(here->path);
}

static void test_settings(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    int64_t value = -1;
    int on = -1;
    fill_profile(&profile);
    put_at(store, &profile);
    assert_int_equal(lp_store_number(store->db, "PRAGMA synchronous", &value), SQLITE_OK);
    assert_int_equal(value, 2); /* a commit survives a power failure */
    assert_int_equal(lp_store_number(store->db, "PRAGMA busy_timeout", &value), SQLITE_OK);
    assert_int_equal(value, LP_STORE_BUSY_MS);
    assert_int_equal(lp_store_number(store->db, "PRAGMA trusted_schema", &value), SQLITE_OK);
    assert_int_equal(value, 0);
    assert_int_equal(sqlite3_db_config(store->db, SQLITE_DBCONFIG_DEFENSIVE, -1, &on), SQLITE_OK);
    assert_int_equal(on, 1);
    assert_int_equal(sqlite3_db_config(store->db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, -1, &on), SQLITE_OK);
    assert_int_equal(on, 0);
    lensprof_store_close(store);
}

/* A file of an older lensprof: readers leave it unchanged, the first writer switches to a log, even while others
 * read. */
static void test_rollback_mode_becomes_a_log(void **state) {
    const place *here = *state;
    make_database(here, 1);
    run_sql(here->path, "PRAGMA journal_mode = DELETE");
    for (uint32_t mode = 0; mode < 3; mode++) {
        lensprof_store *store = store_at(here->path, mode);
        assert_int_equal(count_at(store), 1);
        lensprof_store_close(store);
        assert_int_equal(mode_of(here), 1);
    }
    sqlite3 *reader;
    assert_int_equal(sqlite3_open(here->path, &reader), SQLITE_OK);
    assert_int_equal(sqlite3_exec(reader, "BEGIN; SELECT count(*) FROM profiles", NULL, NULL, NULL), SQLITE_OK);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    assert_int_equal(sqlite3_exec(reader, "COMMIT", NULL, NULL, NULL), SQLITE_OK);
    put_at(store, &profile);
    assert_int_equal(mode_of(here), 2);
    sqlite3_close(reader);
    lensprof_store_close(store);
    assert_alone(here);
    assert_integrity(here->path);
}

/* While another process reads, the profile is stored; a later write changes the mode. */
static void test_reader_keeps_the_mode(void **state) {
    const place *here = *state;
    sqlite3 *reader;
    sqlite3_stmt *statement;
    make_database(here, 3);
    run_sql(here->path, "PRAGMA journal_mode = DELETE");
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    store->journal_ready = false;
    assert_int_equal(sqlite3_open(here->path, &reader), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(reader, "SELECT id FROM profiles", -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    assert_int_not_equal(lp_store_settle_journal(store), SQLITE_OK);
    assert_int_equal(mode_of(here), 1);
    assert_int_equal(count_at(store), 3);
    sqlite3_finalize(statement);
    put_at(store, &profile);
    assert_int_equal(mode_of(here), 2);
    sqlite3_close(reader);
    lensprof_store_close(store);
}

/* Ends without closing: the log stays, with `more` committed profiles and an uncommitted one. */
static void leave_log(const char *path, int more) {
    pid_t child = fork();
    if (child == 0) {
        lensprof_store *store = store_at(path, LENSPROF_STORE_WRITE);
        for (int i = 0; i < more; i++) put_at(store, &profile);
        if (lensprof_store_begin(store, NULL) == LENSPROF_OK) put_at(store, &profile);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
}

static void test_log_that_was_left(void **state) {
    const place *here = *state;
    for (uint32_t mode = 0; mode < 3; mode++) {
        unlink(here->path);
        make_database(here, 1);
        leave_log(here->path, 2);
        assert_true(has_file(here, "-wal"));
        lensprof_store *store = store_at(here->path, mode);
        assert_int_equal(count_at(store), 3);
        lensprof_store_close(store);
        assert_alone(here);
        assert_integrity(here->path);
    }
}

static void assert_read_there(const char *path, lensprof_status expected, const char *text) {
    lensprof_store *store = NULL;
    lensprof_error error = {"", {0, 0, 0, 0}};
    const lensprof_status status = lensprof_store_open(path, LENSPROF_STORE_READ, &store, &error);
    if (status != expected) fail_msg("%s: %s", lensprof_status_name(status), error.text);
    if (status == LENSPROF_OK) {
        assert_int_equal(count_at(store), 1);
        assert_ok(lensprof_store_get(store, 1, &profile, &error));
        assert_int_equal(lensprof_store_put(store, &profile, NULL, &error), LENSPROF_ERROR_READ_ONLY);
    } else if (!strstr(error.text, text))
        fail_msg("%s", error.text);
    lensprof_store_close(store);
}

/* A read-only folder: the file is read as of its last close; a log left there is reported. */
static void test_read_only_folder(void **state) {
    const place *here = *state;
    make_database(here, 1);
    if (!set_protected(here->directory, true)) skip();
    assert_read_there(here->path, LENSPROF_OK, "");
    assert_alone(here);
    assert_true(set_protected(here->directory, false));
    leave_log(here->path, 1);
    char shared[200];
    snprintf(shared, sizeof shared, "%s-shm", here->path);
    unlink(shared); /* as on a medium it was copied to */
    assert_true(set_protected(here->directory, true));
    assert_read_there(here->path, LENSPROF_ERROR_READ_ONLY, "interrupted write");
}

/* A user with read access only; the name contains characters that are special in a URI. */
static void test_another_user(void **state) {
    const place *here = *state;
    char path[300];
    if (geteuid() != 0) skip();
    make_database(here, 1);
    snprintf(path, sizeof path, "%s/100%% a?b#1.db", here->directory);
    assert_int_equal(rename(here->path, path), 0);
    assert_int_equal(chmod(here->directory, 0755), 0);
    pid_t child = fork();
    if (child == 0) {
        if (setgid(65534) || setuid(65534)) _exit(1);
        assert_read_there(path, LENSPROF_OK, "");
        _exit(77);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(WEXITSTATUS(status), 77);
}

/* A reader without locks notices a later writer. */
static void test_writer_beside_an_immutable_reader(void **state) {
    const place *here = *state;
    make_database(here, 1);
    if (!set_protected(here->directory, true)) skip();
    lensprof_store *reader = store_at(here->path, LENSPROF_STORE_READ);
    assert_true(reader->immutable);
    assert_int_equal(count_at(reader), 1);
    assert_true(set_protected(here->directory, false));
    lensprof_store *writer = store_at(here->path, LENSPROF_STORE_WRITE);
    fill_profile(&profile);
    put_at(writer, &profile);
    assert_int_equal(count_at(reader), 2);
    assert_false(reader->immutable);
    lensprof_store_close(writer);
    assert_int_equal(count_at(reader), 2);
    lensprof_store_close(reader);
    assert_alone(here);
}

/* No room for the log's index (32 KiB): existing profiles can be read, and no new file appears next to the database. */
static void test_full_disk(void **state) {
    const place *here = *state;
    make_database(here, 1);
    pid_t child = fork();
    if (child == 0) {
        struct rlimit limit = {100, 100};
        signal(SIGXFSZ, SIG_IGN);
        if (setrlimit(RLIMIT_FSIZE, &limit)) _exit(1);
        assert_read_there(here->path, LENSPROF_OK, "");
        lensprof_store *store = NULL;
        _exit(lensprof_store_open(here->path, LENSPROF_STORE_WRITE, &store, NULL) == LENSPROF_ERROR_FULL ? 77 : 2);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(WEXITSTATUS(status), 77);
    assert_alone(here);
    assert_integrity(here->path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_one_file_when_closed),
        store_test(test_settings),
        store_test(test_rollback_mode_becomes_a_log),
        store_test(test_reader_keeps_the_mode),
        store_test(test_log_that_was_left),
        store_test(test_read_only_folder),
        store_test(test_another_user),
        store_test(test_writer_beside_an_immutable_reader),
        store_test(test_full_disk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
