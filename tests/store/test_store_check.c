/* Checks and statistics of a whole database. */
#include "store_fixture.h"

typedef struct faults {
    uint32_t count;
    lensprof_store_fault fault[50];
    lensprof_status answer;
} faults;

static lensprof_status collect(void *user, const lensprof_store_fault *fault) {
    faults *all = user;
    if (all->count < 50) all->fault[all->count] = *fault;
    all->count++;
    return all->answer;
}

static void check_at(const char *path, uint32_t profiles, faults *all) {
    lensprof_store *store = store_at(path, LENSPROF_STORE_READ);
    lensprof_error error = {"x", {0, 0, 0, 0}};
    uint32_t read = 99, count = 99;
    memset(all, 0, sizeof *all);
    if (lensprof_store_check(store, collect, all, &read, &count, &error) != LENSPROF_OK) fail_msg("%s", error.text);
    assert_string_equal(error.text, "");
    assert_int_equal(read, profiles);
    assert_int_equal(count, all->count);
    lensprof_store_close(store);
}

/* Whether a fault with this id has `part` in its reason. */
static bool has_fault(const faults *all, int64_t id, const char *part) {
    for (uint32_t i = 0; i < all->count && i < 50; i++)
        if (all->fault[i].id == id && strstr(all->fault[i].reason, part)) return true;
    return false;
}

static void make_database(const char *path) {
    lensprof_profile *profile = new_profile();
    lensprof_store *store = store_at(path, LENSPROF_STORE_CREATE);
    fill_profile(profile);
    for (int i = 0; i < 4; i++) put_at(store, profile);
    lensprof_profile_init(profile);
    put_at(store, profile);
    lensprof_store_close(store);
    free(profile);
}

static void craft(const char *path, const char *sql) {
    char text[1000];
    unlink(path);
    make_database(path);
    snprintf(text, sizeof text, "PRAGMA ignore_check_constraints = ON; PRAGMA foreign_keys = OFF; %s", sql);
    run_sql(path, text);
}

static void test_sound(void **state) {
    const place *here = *state;
    faults *all = malloc(sizeof *all);
    size_t size;
    make_database(here->path);
    unsigned char *bytes = read_file(here->path, &size);
    check_at(here->path, 5, all);
    assert_int_equal(all->count, 0);
    assert_file(here->path, bytes, size);
    free(bytes);
    free(all);
}

static void test_older_layouts(void **state) {
    const place *here = *state;
    faults *all = malloc(sizeof *all);
    lensprof_profile *profile = new_profile();
    fill_profile(profile);
    for (int layout = 1; layout < LP_STORE_LAYOUT; layout++) {
        unlink(here->path);
        make_layout(here->path, layout, profile, 1);
        check_at(here->path, 1, all);
        assert_int_equal(all->count, 0);
        run_sql(here->path, "UPDATE vignettings SET k1 = -5");
        check_at(here->path, 1, all);
        assert_true(has_fault(all, 1, "VIGNETTING"));
    }
    free(profile);
    free(all);
}

static void test_each_kind_of_damage(void **state) {
    static const struct {
        const char *sql;
        int64_t id;
        const char *reason;
    } cases[] = {
        {"UPDATE profiles SET lens = char(10) WHERE id = 2", 2, "ARGUMENT"},
        {"UPDATE profiles SET aperture = -2.0 WHERE id = 2", 2, "aperture"},
        {"UPDATE profiles SET covariance = zeroblob(799) WHERE id = 2", 2, "covariance"},
        {"UPDATE profiles SET covariance = CAST(x'000000000000f0bf' || zeroblob(792) AS BLOB) WHERE id = 2", 2,
         "LENSPROF"},
        {"UPDATE profiles SET covariance = CAST(zeroblob(8) || x'000000000000f03f' || zeroblob(784) AS BLOB) WHERE id = 2",
         2, "LENSPROF"}, /* not symmetric */
        {"UPDATE profiles SET covariance = CAST(x'000000000000f87f' || zeroblob(792) AS BLOB) WHERE id = 2", 2,
         "LENSPROF"},
        {"UPDATE profiles SET lens_name = 'another' WHERE id = 2", 2, "lens_name"},
        {"UPDATE emor_coefficients SET coefficient = 1e9 WHERE mode = 1 AND profile_id = 2", 2, "response"},
        {"UPDATE responses SET kind = 'table', emor_modes = NULL, samples = CAST(x'000000000000f03f' || zeroblob(8184) AS BLOB)"
         " WHERE profile_id = 2",
         2, "response"}, /* falls */
        {"UPDATE vignettings SET k1 = -5 WHERE profile_id = 2", 2, "VIGNETTING"},
        {"UPDATE gain_grids SET attenuation = zeroblob(80) WHERE profile_id = 2", 2, "VIGNETTING"},
        {"DELETE FROM responses WHERE profile_id = 2", 2, "count of responses"},
        {"INSERT INTO vignettings VALUES (77, 0, 0.0, 0.0, 0.0, 0.0, 0.0)", 77, "vignettings without its profile"},
        {"INSERT INTO responses VALUES (78, 0, 'linear', NULL, NULL, NULL)", 78, "responses without its profile"},
        {"INSERT INTO gain_grids VALUES (79, 2, 2, 1, zeroblob(16))", 79, "gain_grids without its profile"},
        {"INSERT INTO emor_coefficients VALUES (80, 0, 1, 0.5)", 80, "emor_coefficients without its response"},
        {"INSERT INTO emor_coefficients VALUES (5, 0, 1, 0.5)", 5, "not EMoR"},
        {"DROP INDEX profiles_by_lens; CREATE UNIQUE INDEX profiles_by_lens ON profiles (id); PRAGMA writable_schema = ON;"
         " UPDATE sqlite_master SET sql = 'CREATE INDEX profiles_by_lens ON profiles (lens_name, id)'"
         " WHERE name = 'profiles_by_lens'",
         0, "index profiles_by_lens"},
    };
    const place *here = *state;
    faults *all = malloc(sizeof *all);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        craft(here->path, cases[i].sql);
        check_at(here->path, 5, all);
        if (!has_fault(all, cases[i].id, cases[i].reason))
            fail_msg("%s: %u faults, the last: %s", cases[i].sql, all->count,
                     all->count ? all->fault[all->count - 1].reason : "");
        for (uint32_t n = 0; n < all->count; n++) assert_true(all->fault[n].id == cases[i].id || all->fault[n].id == 0);
    }
    free(all);
}

/* All of them, not only the first. */
static void test_everything_is_listed(void **state) {
    const place *here = *state;
    faults *all = malloc(sizeof *all);
    craft(here->path,
          "UPDATE vignettings SET k1 = -5 WHERE profile_id IN (1, 3); DELETE FROM responses WHERE profile_id = 4;"
          " DELETE FROM profiles WHERE id = 2");
    check_at(here->path, 4, all);
    assert_true(has_fault(all, 1, "VIGNETTING") && has_fault(all, 3, "VIGNETTING"));
    assert_true(has_fault(all, 4, "count of responses") && has_fault(all, 4, "without its response"));
    assert_true(has_fault(all, 2, "vignettings without") && has_fault(all, 2, "responses without")
                && has_fault(all, 2, "gain_grids without"));
    assert_int_equal(all->count, 7);
    free(all);
}

/* Overwritten pages: everything readable is checked, and nothing crashes. */
static void test_broken_pages(void **state) {
    const place *here = *state;
    faults *all = malloc(sizeof *all);
    size_t size;
    uint32_t told = 0;
    make_database(here->path);
    unsigned char *bytes = read_file(here->path, &size);
    for (size_t page = 1; page < size / 4096; page++) {
        unsigned char *broken = malloc(size);
        lensprof_store *store = NULL;
        lensprof_error error;
        uint32_t count = 0;
        memcpy(broken, bytes, size);
        memset(broken + page * 4096, 0xa5, 4096);
        write_file(here->path, broken, size);
        memset(all, 0, sizeof *all);
        if (lensprof_store_open(here->path, LENSPROF_STORE_READ, &store, &error) == LENSPROF_OK) {
            assert_ok(lensprof_store_check(store, collect, all, NULL, &count, &error));
            assert_int_equal(count, all->count);
            assert_true(count > 0);
            told++;
        }
        lensprof_store_close(store);
        free(broken);
    }
    assert_true(told > 5);
    free(bytes);
    free(all);
}

static void test_visitor_ends_the_check(void **state) {
    const place *here = *state;
    faults *all = calloc(1, sizeof *all);
    lensprof_error error;
    uint32_t count = 77;
    craft(here->path, "UPDATE vignettings SET k1 = -5");
    all->answer = LENSPROF_ERROR_CANCELLED;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_READ);
    assert_int_equal(lensprof_store_check(store, collect, all, NULL, &count, &error), LENSPROF_ERROR_CANCELLED);
    assert_int_equal(all->count, 1);
    assert_int_equal(count, 77);
    assert_ok(lensprof_store_check(store, NULL, NULL, NULL, &count, &error));
    assert_int_equal(count, 5);
    assert_int_equal(lensprof_store_check(NULL, NULL, NULL, NULL, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
    free(all);
}

static void put_counted(lensprof_store *store, const char *camera, const char *lens, const char *unit, double focal) {
    static lensprof_profile p = {.struct_size = sizeof p};
    lensprof_profile_init(&p);
    strcpy(p.key.camera_model, camera);
    strcpy(p.key.lens, lens);
    strcpy(p.key.unit, unit);
    p.key.focal_mm = focal;
    p.key.processing = focal > 50.0 ? LENSPROF_PROCESSING_CORRECTED : LENSPROF_PROCESSING_RAW;
    strcpy(p.provenance.method, focal > 30.0 ? "transfer" : "import");
    strcpy(p.provenance.doubt, focal > 70.0 ? "x" : "");
    snprintf(p.provenance.source, sizeof p.provenance.source, "%g.pto", focal);
    put_at(store, &p);
}

static void test_stats(void **state) {
    const place *here = *state;
    lensprof_store_stats *s = malloc(sizeof *s);
    struct stat file;
    lensprof_store_stats_init(s);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    assert_ok(lensprof_store_get_stats(store, s, NULL));
    assert_int_equal(s->profiles, 0);
    assert_close(s->focal_mm[0], LENSPROF_UNKNOWN, 0.0);
    put_counted(store, "A", "x", "", 24.0);
    put_counted(store, " a", "X ", "1", 35.0);
    put_counted(store, "B", "x", "1 ", 50.0);
    put_counted(store, "", "y", "2", 85.0);
    for (int i = 0; i < 9; i++) put_counted(store, "", "", "", 60.0 + i / 10.0);
    put_counted(store, "", "", "", 85.0);
    assert_ok(lensprof_store_get_stats(store, s, NULL));
    assert_int_equal(s->profiles, 14);
    assert_int_equal(s->cameras, 2);
    assert_int_equal(s->lenses, 2);
    assert_int_equal(s->units, 2);
    assert_int_equal(s->processing[LENSPROF_PROCESSING_RAW], 3);
    assert_int_equal(s->processing[LENSPROF_PROCESSING_JPEG], 0);
    assert_int_equal(s->processing[LENSPROF_PROCESSING_CORRECTED], 11);
    assert_int_equal(s->with_doubt, 2);
    assert_int_equal(s->with_covariance + s->with_grid, 0);
    assert_close(s->focal_mm[0], 24.0, 0.0);
    assert_close(s->focal_mm[1], 85.0, 0.0);
    assert_close(s->distance_m[1], LENSPROF_UNKNOWN, 0.0);
    assert_int_equal(s->methods, 2);
    assert_string_equal(s->method[0].name, "transfer");
    assert_int_equal(s->method[0].profiles, 13);
    assert_int_equal(s->method[1].profiles, 1);
    assert_int_equal(s->method[2].profiles, 0);
    assert_int_equal(s->sources, 13);
    assert_string_equal(s->source[0].name, "85.pto");
    assert_int_equal(s->source[LENSPROF_STATS_GROUPS - 1].profiles, 1);
    assert_int_equal(s->layout, LP_STORE_LAYOUT);
    lensprof_store_close(store);
    assert_int_equal(stat(here->path, &file), 0);
    assert_int_equal(s->bytes, file.st_size);
    assert_int_equal(lensprof_store_get_stats(NULL, s, NULL), LENSPROF_ERROR_ARGUMENT);
    free(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_sound),
        store_test(test_older_layouts),
        store_test(test_each_kind_of_damage),
        store_test(test_everything_is_listed),
        store_test(test_broken_pages),
        store_test(test_visitor_ends_the_check),
        store_test(test_stats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
