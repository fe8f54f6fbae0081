/* The process is killed during work: reported operations are complete, and nothing is half done. */
#include "store_fixture.h"

#include <signal.h>
#include <sys/wait.h>
#include <time.h>

#ifndef ROUNDS
#define ROUNDS 20 /* kills per kind; the slow variant has more */
#endif

/* The child's report after a call returned. */
typedef struct report {
    int64_t id;      /* put; negative: removed */
    uint32_t number; /* images of that profile */
} report;

/* Stores profiles of varying size in an endless loop, and removes every fourth of them again. */
static void work(const char *path, int pipe_end, uint32_t number) {
    lensprof_profile *profile = new_profile();
    lensprof_store *store = NULL;
    if (lensprof_store_open(path, LENSPROF_STORE_CREATE, &store, NULL)) _exit(1);
    for (;; number++) {
        report done = {0, number};
        fill_profile(profile);
        profile->provenance.images = number;
        if (number % 2) profile->response[0].kind = LENSPROF_RESPONSE_TABLE;
        if (number % 3) profile->covariance_size = 0;
        if (lensprof_store_put(store, profile, &done.id, NULL)) _exit(2);
        if (write(pipe_end, &done, sizeof done) != sizeof done) _exit(3);
        if (number % 4) continue;
        if (lensprof_store_remove(store, done.id, NULL)) _exit(4);
        done.id = -done.id;
        if (write(pipe_end, &done, sizeof done) != sizeof done) _exit(5);
    }
}

/* Lets a child work for some time, kills it, and returns the number of its reports. */
static size_t work_and_kill(const char *path, uint32_t number, double seconds, report *reports, size_t capacity) {
    int ends[2], status = 0;
    size_t count = 0;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        close(ends[0]);
        work(path, ends[1], number);
    }
    close(ends[1]);
    struct timespec pause = {(time_t)seconds, (long)(fmod(seconds, 1.0) * 1e9)};
    nanosleep(&pause, NULL);
    assert_int_equal(kill(child, SIGKILL), 0);
    while (count < capacity && read(ends[0], &reports[count], sizeof *reports) == sizeof *reports) count++;
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status)); /* it did not end by itself */
    return count;
}

/* Every report of the round holds; one further call (`extra`: 0 or 1) may have been done but not reported. */
static void check_reports(const char *path, uint32_t mode, const report *reports, size_t count, uint32_t expected) {
    lensprof_profile *profile = new_profile();
    lensprof_store *store = store_at(path, mode);
    uint32_t found = count_at(store);
    assert_in_range(found, expected ? expected - 1 : 0, expected + 1);
    for (size_t i = 0; i < count; i++) {
        bool removed = reports[i].id < 0 || (i + 1 < count && reports[i + 1].id < 0);
        bool last_open = i + 1 == count && reports[i].id > 0 && reports[i].number % 4 == 0;
        lensprof_status status = lensprof_store_get(store, llabs(reports[i].id), profile, NULL);
        if (last_open && status == LENSPROF_ERROR_NOT_FOUND) continue; /* its removal was done but not reported */
        assert_int_equal(status, removed ? LENSPROF_ERROR_NOT_FOUND : LENSPROF_OK);
        if (!removed) assert_int_equal(profile->provenance.images, reports[i].number);
    }
    lensprof_store_close(store);
    free(profile);
}

static void test_killed_at_random_moments(void **state) {
    const place *here = *state;
    enum {
        CAPACITY = 20000
    };
    report *reports = malloc(CAPACITY * sizeof *reports);
    uint64_t seed = 7;
    uint32_t stored = 0;
    size_t done = 0;
    /* On a busy machine more rounds are needed to get enough done. */
    for (int round = 0; round < ROUNDS || (done <= (size_t)ROUNDS && round < 10 * ROUNDS); round++) {
        size_t count =
            work_and_kill(here->path, (uint32_t)round * 1000000, 0.001 + 0.06 * lp_random(&seed), reports, CAPACITY);
        done += count;
        for (size_t i = 0; i < count; i++) stored += reports[i].id > 0 ? 1 : UINT32_MAX;
        if (access(here->path, F_OK) == 0) {
            struct stat status;
            assert_int_equal(stat(here->path, &status), 0);
            /* Killed before anything was written: only CREATE turns the empty file into a database. */
            uint32_t mode = done == 0 || status.st_size == 0 ? LENSPROF_STORE_CREATE : (uint32_t)round % 3;
            check_reports(here->path, mode, reports, count, stored);
            assert_integrity(here->path);
            lensprof_store *store = store_at(here->path, LENSPROF_STORE_READ);
            stored = count_at(store); /* including the unreported one */
            lensprof_store_close(store);
        }
    }
    assert_true(done > (size_t)ROUNDS); /* otherwise nothing was tested */
    free(reports);
}

static void test_killed_while_creating(void **state) {
    const place *here = *state;
    report reports[1000];
    uint64_t seed = 8;
    static const char *const ends[] = {"", "-journal", "-wal", "-shm"};
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < 4; i++) {
            char path[200];
            snprintf(path, sizeof path, "%s%s", here->path, ends[i]);
            unlink(path);
        }
        size_t count = work_and_kill(here->path, 1, 0.008 * lp_random(&seed), reports, 1000);
        lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
        assert_true(count_at(store) <= count + 1);
        lensprof_store_close(store);
        assert_integrity(here->path);
    }
}

/* Stores batches of BATCH profiles with the batch's number in an endless loop, and reports each after its commit. */
enum {
    BATCH = 7
};

static void work_in_batches(const char *path, int pipe_end, uint32_t number) {
    lensprof_profile *profile = new_profile();
    lensprof_store *store = NULL;
    fill_profile(profile);
    if (lensprof_store_open(path, LENSPROF_STORE_CREATE, &store, NULL)) _exit(1);
    for (;; number++) {
        profile->provenance.images = number;
        if (lensprof_store_begin(store, NULL)) _exit(2);
        for (int i = 0; i < BATCH; i++)
            if (lensprof_store_put(store, profile, NULL, NULL)) _exit(3);
        if (lensprof_store_commit(store, NULL)) _exit(4);
        if (write(pipe_end, &number, sizeof number) != sizeof number) _exit(5);
    }
}

/* Looks up and checks in an endless loop; a reader must never see half of a batch. */
static void read_for_ever(const char *path) {
    lensprof_profile *profile = new_profile();
    lensprof_profile_key key;
    lensprof_lookup_options options;
    lensprof_lookup how = {.struct_size = sizeof how};
    lensprof_error error;
    uint32_t found;
    fill_profile(profile);
    key = profile->key;
    lensprof_lookup_options_init(&options);
    for (;;) {
        lensprof_store *store = NULL;
        if (lensprof_store_open(path, LENSPROF_STORE_READ, &store, &error)) _exit(11);
        for (int i = 0; i < 20; i++) {
            if (lensprof_store_list(store, NULL, NULL, 0, &found, &error) || found % BATCH) _exit(12);
            const lensprof_status status = lensprof_store_lookup(store, &key, &options, profile, &how, &error);
            if (status != (found ? LENSPROF_OK : LENSPROF_ERROR_NOT_FOUND) && found) _exit(13);
        }
        lensprof_store_close(store);
    }
}

/* Number of profiles of a batch: all of them, or none. */
static uint32_t count_batch(sqlite3 *db, uint32_t number) {
    char sql[80];
    int64_t count = -1;
    snprintf(sql, sizeof sql, "SELECT count(*) FROM profiles WHERE images = %u", number);
    assert_int_equal(lp_store_number(db, sql, &count), SQLITE_OK);
    return (uint32_t)count;
}

/* One writer of batches and two readers, all killed at a random moment. Every reported batch is complete, the next one
 * complete or missing, and the readers saw nothing else. */
static void test_batches_beside_readers(void **state) {
    const place *here = *state;
    uint64_t seed = 9;
    uint32_t number, reported = 0;
    lensprof_store_close(store_at(here->path, LENSPROF_STORE_CREATE));
    for (int round = 0; round < ROUNDS; round++) {
        int ends[2], status;
        pid_t children[3];
        assert_int_equal(pipe(ends), 0);
        for (int i = 0; i < 3; i++)
            if ((children[i] = fork()) == 0) {
                close(ends[0]);
                if (i) read_for_ever(here->path);
                work_in_batches(here->path, ends[1], (uint32_t)round * 100000 + 1);
            }
        close(ends[1]);
        struct timespec pause = {0, (long)(1e6 + 5e7 * lp_random(&seed))};
        nanosleep(&pause, NULL);
        for (int i = 0; i < 3; i++) assert_int_equal(kill(children[(round + i) % 3], SIGKILL), 0);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(waitpid(children[i], &status, 0), children[i]);
            if (!WIFSIGNALED(status)) fail_msg("child %d ended with %d", i, WEXITSTATUS(status));
        }
        lensprof_store *store = store_at(here->path, (uint32_t)round % 3);
        uint32_t last = (uint32_t)round * 100000;
        for (; read(ends[0], &number, sizeof number) == sizeof number; last = number, reported++)
            assert_int_equal(count_batch(store->db, number), BATCH);
        close(ends[0]);
        assert_true(count_batch(store->db, last + 1) % BATCH == 0);
        assert_int_equal(count_at(store) % BATCH, 0);
        lensprof_store_close(store);
        assert_integrity(here->path);
    }
    assert_true(reported > (uint32_t)ROUNDS / 4); /* otherwise nothing was tested */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_killed_at_random_moments),
        store_test(test_killed_while_creating),
        store_test(test_batches_beside_readers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
