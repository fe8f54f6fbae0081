/* Databases of older layouts: read as they are, upgraded by the first write. Each test runs for each layout. */
#include "store_fixture.h"

#include <sys/wait.h>

/* Two profiles that layout `from` can hold, made once. */
static lensprof_profile old[2], found = {.struct_size = sizeof found};
static int from;

static void make_old(const char *path) {
    for (int i = 0; i < 2; i++) {
        fill_profile(&old[i]);
        if (from < 2) lensprof_gain_grid_init(&old[i].grid);
        if (from >= 3) {
            strcpy(old[i].key.unit, "12345");
            old[i].key.crop_factor = 1.53;
            strcpy(old[i].provenance.doubt, "a doubt");
        }
        if (from < 4) old[i].key.color_temperature_k = LENSPROF_UNKNOWN;
        lose_newer(&old[i], from);
        old[i].provenance.prior_id = i;
        old[i].provenance.forced = (uint32_t)i;
    }
    assert_ok(lensprof_response_set_gamma(&old[1].response[0], 2.2));
    old[1].key.aperture = 8.0;
    make_layout(path, from, old, 2);
}

static int64_t layout_of(const char *path) {
    sqlite3 *db;
    int64_t layout = -1;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(lp_store_number(db, "PRAGMA user_version", &layout), SQLITE_OK);
    sqlite3_close(db);
    return layout;
}

/* Both profiles are present and unchanged. */
static void assert_old_profiles(lensprof_store *store) {
    lensprof_store_row rows[20];
    uint32_t count;
    int64_t id;
    for (int i = 0; i < 2; i++) {
        scribble(&found);
        assert_ok(lensprof_store_get(store, i + 1, &found, NULL));
        assert_same_profile(&found, &old[i]);
    }
    assert_ok(lensprof_store_find(store, &old[1].key, &found, &id, NULL));
    assert_int_equal(id, 2);
    assert_same_profile(&found, &old[1]);
    assert_ok(lensprof_store_list(store, NULL, rows, 20, &count, NULL));
    assert_in_range(count, 2, 20);
    for (uint32_t i = 0; i < count; i++)
        if (rows[i].id == 2) {
            assert_memory_equal(&rows[i].key, &old[1].key, sizeof old[1].key);
            assert_memory_equal(&rows[i].provenance, &old[1].provenance, sizeof old[1].provenance);
        }
}

static void test_reading_changes_nothing(void **state) {
    const place *here = *state;
    lensprof_error error;
    size_t size;
    make_old(here->path);
    assert_int_equal(layout_of(here->path), from);
    unsigned char *bytes = read_file(here->path, &size);
    for (uint32_t mode = 0; mode < 3; mode++) { /* also in modes that could write */
        lensprof_store *store = store_at(here->path, mode);
        assert_old_profiles(store);
        if (mode == LENSPROF_STORE_READ)
            assert_int_equal(lensprof_store_put(store, &old[0], NULL, &error), LENSPROF_ERROR_READ_ONLY);
        lensprof_store_close(store);
        assert_file(here->path, bytes, size);
    }
    free(bytes);
}

static void test_first_put_brings_up_to_date(void **state) {
    const place *here = *state;
    lensprof_profile *newer = new_profile();
    make_old(here->path);
    fill_profile(newer);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE), *other = store_at(here->path, 0);
    assert_int_equal(count_at(other), 2);
    assert_int_equal(put_at(store, newer), 3);
    for (int handle = 0; handle < 2; handle++) { /* the other handle was opened before */
        assert_old_profiles(handle ? other : store);
        assert_ok(lensprof_store_get(handle ? other : store, 3, &found, NULL));
        assert_same_profile(&found, newer);
    }
    assert_int_equal(put_at(store, &old[0]), 4);
    lensprof_store_close(store);
    lensprof_store_close(other);
    assert_int_equal(layout_of(here->path), LP_STORE_LAYOUT);
    assert_integrity(here->path);
    store = store_at(here->path, LENSPROF_STORE_READ);
    assert_old_profiles(store);
    lensprof_store_close(store);
    free(newer);
}

static void test_first_remove_brings_up_to_date(void **state) {
    const place *here = *state;
    make_old(here->path);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    assert_ok(lensprof_store_remove(store, 1, NULL));
    assert_int_equal(count_at(store), 1);
    lensprof_store_close(store);
    assert_int_equal(layout_of(here->path), LP_STORE_LAYOUT);
    assert_integrity(here->path);
}

/* A write that fails rolls back the new layout, too. */
static void test_failed_write_leaves_the_layout(void **state) {
    const place *here = *state;
    lensprof_error error;
    char sql[60];
    int64_t pages = 0;
    size_t size;
    make_old(here->path);
    unsigned char *bytes = read_file(here->path, &size);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    assert_int_equal(lensprof_store_remove(store, 77, &error), LENSPROF_ERROR_NOT_FOUND);
    assert_file(here->path, bytes, size);
    assert_int_equal(lp_store_number(store->db, "PRAGMA page_count", &pages), SQLITE_OK);
    snprintf(sql, sizeof sql, "PRAGMA max_page_count = %d", (int)pages);
    assert_int_equal(sqlite3_exec(store->db, sql, NULL, NULL, NULL), SQLITE_OK);
    fill_profile(&found); /* larger than the remaining pages */
    assert_ok(lensprof_response_set_table(&found.response[0], (double[]){0.0, 0.7, 1.0}, 3));
    assert_int_equal(lensprof_store_put(store, &found, NULL, &error), LENSPROF_ERROR_FULL);
    assert_old_profiles(store);
    assert_file(here->path, bytes, size);
    assert_int_equal(sqlite3_exec(store->db, "PRAGMA max_page_count = 1000", NULL, NULL, NULL), SQLITE_OK);
    assert_int_equal(put_at(store, &old[0]), 3); /* the handle remains usable */
    lensprof_store_close(store);
    free(bytes);
}

/* Text of every table and index, by name. */
static void read_schema(const char *path, char *text, size_t capacity) {
    sqlite3 *db;
    sqlite3_stmt *statement;
    size_t used = 0;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY name", -1,
                                        &statement, NULL),
                     SQLITE_OK);
    while (sqlite3_step(statement) == SQLITE_ROW)
        used += (size_t)snprintf(text + used, capacity - used, "%s\n", sqlite3_column_text(statement, 0));
    assert_true(used > 1000 && used < capacity);
    sqlite3_finalize(statement);
    sqlite3_close(db);
}

static void test_old_and_new_files_become_the_same(void **state) {
    const place *here = *state;
    static char schema[2][16384];
    char path[300];
    make_old(here->path);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    put_at(store, &old[0]);
    lensprof_store_close(store);
    snprintf(path, sizeof path, "%s/new.db", here->directory);
    lensprof_store_close(store_at(path, LENSPROF_STORE_CREATE));
    assert_int_equal(layout_of(path), LP_STORE_LAYOUT);
    read_schema(here->path, schema[0], sizeof schema[0]);
    read_schema(path, schema[1], sizeof schema[1]);
    assert_string_equal(schema[0], schema[1]);
}

/* Several processes upgrade it simultaneously; one of them does it, and none fails. */
static void test_several_processes(void **state) {
    const place *here = *state;
    enum {
        PROCESSES = 4
    };
    make_old(here->path);
    fill_profile(&found);
    strcpy(found.key.lens, "another");
    for (int i = 0; i < PROCESSES; i++)
        if (fork() == 0) {
            lensprof_store *store = NULL;
            lensprof_status status = lensprof_store_open(here->path, LENSPROF_STORE_WRITE, &store, NULL);
            for (int k = 0; k < 3 && status == LENSPROF_OK; k++) status = lensprof_store_put(store, &found, NULL, NULL);
            _exit((int)status);
        }
    for (int i = 0; i < PROCESSES; i++) {
        int status = 0;
        assert_true(wait(&status) > 0);
        assert_int_equal(status, 0);
    }
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_READ);
    assert_int_equal(count_at(store), 2 + 3 * PROCESSES);
    assert_old_profiles(store);
    lensprof_store_close(store);
    assert_integrity(here->path);
}

/* Values at the end of the method are read from there before the upgrade, and moved by the same rule during it. */
static void test_methods(void **state) {
    const place *here = *state;
    static const struct {
        const char *before, *method;
        int64_t prior;
        uint32_t forced;
    } rows[] = {{"transfer", "transfer", 0, 0},
                {"transfer+12", "transfer", 12, 0},
                {"transfer+12 (forced)", "transfer", 12, 1},
                {"transfer (forced)", "transfer", 0, 1},
                {"transfer+12(forced)", "transfer+12(forced)", 0, 0},
                {"a+b", "a+b", 0, 0},
                {"a+1b", "a+1b", 0, 0},
                {"", "", 0, 0},
                {" (forced)", "", 0, 1},
                {"12", "12", 0, 0},
                {"+5", "", 5, 0},
                {"x+0", "x", 0, 0},
                {"x+1+2", "x+1", 2, 0},
                {"transfer+0012", "transfer", 12, 0},
                {"transfer+-3", "transfer+-3", 0, 0},
                {"x+9223372036854775807", "x", INT64_MAX, 0},
                {"c++", "c++", 0, 0},
                {"radiance (EMoR+falloff)", "radiance (EMoR+falloff)", 0, 0}};
    enum {
        COUNT = sizeof rows / sizeof *rows
    };
    lensprof_profile *all = calloc(COUNT, sizeof *all);
    lensprof_store_stats stats[2] = {{.struct_size = sizeof *stats}, {.struct_size = sizeof *stats}};
    for (int i = 0; i < COUNT; i++) {
        fill_profile(&all[i]);
        all[i].provenance.forced = 0;
        memset(all[i].provenance.method, 0, sizeof all[i].provenance.method);
        strcpy(all[i].provenance.method, rows[i].before);
    }
    make_layout(here->path, from, all, COUNT);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
    for (int again = 0; again < 2; again++) {
        for (int i = 0; i < COUNT; i++) {
            assert_ok(lensprof_store_get(store, i + 1, &found, NULL));
            assert_string_equal(found.provenance.method, rows[i].method);
            assert_int_equal(found.provenance.prior_id, rows[i].prior);
            assert_int_equal(found.provenance.forced, rows[i].forced);
        }
        assert_ok(lensprof_store_get_stats(store, &stats[again], NULL));
        assert_int_equal(stats[again].layout, again ? LP_STORE_LAYOUT : from);
        if (!again) assert_ok(lensprof_store_remove(store, put_at(store, &all[0]), NULL));
    }
    assert_string_equal(stats[0].method[0].name, "transfer");
    assert_int_equal(stats[0].method[0].profiles, 5);
    assert_memory_equal(stats[0].method, stats[1].method, sizeof stats[0].method);
    lensprof_store_close(store);
    assert_integrity(here->path);
    free(all);
}

/* A user's own table or column of that name: the write fails, reading still works. */
static void test_names_that_are_taken(void **state) {
    const place *here = *state;
    static const char *const taken[] = {"ALTER TABLE profiles ADD COLUMN circle_radius REAL",
                                        "ALTER TABLE profiles ADD COLUMN white_level REAL",
                                        "ALTER TABLE profiles ADD COLUMN style TEXT",
                                        "CREATE TABLE cameras (a)",
                                        "ALTER TABLE profiles ADD COLUMN forced INTEGER",
                                        "ALTER TABLE profiles ADD COLUMN prior_id INTEGER",
                                        "CREATE TABLE gain_grids (a)",
                                        "ALTER TABLE profiles ADD COLUMN gain_grids INTEGER"};
    lensprof_error error;
    for (int i = 0; i < (from < 2 ? 8 : from < 4 ? 6 : from < 5 ? 4 : from < 6 ? 2 : 1); i++) {
        size_t size;
        unlink(here->path);
        make_old(here->path);
        run_sql(here->path, taken[i]);
        unsigned char *bytes = read_file(here->path, &size);
        lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
        assert_int_equal(lensprof_store_put(store, &old[0], NULL, &error), LENSPROF_ERROR_CORRUPT);
        assert_non_null(strstr(error.text, "profiles.db: "));
        assert_old_profiles(store);
        lensprof_store_close(store);
        assert_file(here->path, bytes, size);
        free(bytes);
    }
}

static int setup_1(void **state) { return from = 1, place_setup(state); }
static int setup_2(void **state) { return from = 2, place_setup(state); }
static int setup_3(void **state) { return from = 3, place_setup(state); }
static int setup_4(void **state) { return from = 4, place_setup(state); }
static int setup_5(void **state) { return from = 5, place_setup(state); }
static int setup_6(void **state) { return from = 6, place_setup(state); }

#define FROM(layout, function) \
    { #function " from layout " #layout, function, setup_##layout, place_teardown, NULL }
#define FROM_OLD(function) FROM(1, function), FROM(2, function), FROM(3, function)
#define FROM_EACH(function) FROM_OLD(function), FROM(4, function), FROM(5, function), FROM(6, function)

int main(void) {
    const struct CMUnitTest tests[] = {
        FROM_EACH(test_reading_changes_nothing),
        FROM_EACH(test_first_put_brings_up_to_date),
        FROM_EACH(test_first_remove_brings_up_to_date),
        FROM_EACH(test_failed_write_leaves_the_layout),
        FROM_EACH(test_old_and_new_files_become_the_same),
        FROM_EACH(test_several_processes),
        FROM_OLD(test_methods),
        FROM_EACH(test_names_that_are_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
