/* Which profile a key finds, and the order of lists. */
#include "store_fixture.h"

static void test_newest_wins(void **state) {
    lensprof_profile *profile = new_profile(), *found = new_profile();
    int64_t id;
    fill_profile(profile);
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    int64_t first = put_at(store, profile);
    profile->vignetting[0].k[0] = -0.25;
    int64_t second = put_at(store, profile);
    assert_true(second > first && first > 0);
    assert_ok(lensprof_store_find(store, &profile->key, found, &id, NULL));
    assert_int_equal(id, second);
    assert_close(found->vignetting[0].k[0], -0.25, 0.0);
    assert_ok(lensprof_store_get(store, first, found, NULL)); /* the older one stays */
    assert_close(found->vignetting[0].k[0], -0.3, 0.0);
    assert_ok(lensprof_store_remove(store, second, NULL));
    assert_ok(lensprof_store_find(store, &profile->key, found, NULL, NULL)); /* the id is optional */
    assert_ok(lensprof_store_find(store, &profile->key, found, &id, NULL));
    assert_int_equal(id, first);
    assert_true(put_at(store, profile) > second); /* an id is never used again */
    lensprof_store_close(store);
    free(profile);
    free(found);
}

/* Stores a profile with key `put` and looks for `asked`. */
static lensprof_status match(void **state, const lensprof_profile_key *put, const lensprof_profile_key *asked) {
    const place *here = *state;
    lensprof_profile *profile = new_profile();
    int64_t id;
    unlink(here->path);
    lensprof_profile_init(profile);
    profile->key = *put;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    put_at(store, profile);
    lensprof_status status = lensprof_store_find(store, asked, profile, &id, NULL);
    lensprof_store_close(store);
    free(profile);
    return status;
}

static void test_texts_match_without_case_and_blanks(void **state) {
    lensprof_profile_key put, asked;
    lensprof_profile_key_init(&put);
    strcpy(put.camera_maker, "  Canon ");
    strcpy(put.camera_model, "EOS 5D");
    asked = put;
    strcpy(asked.camera_maker, "cANON");
    strcpy(asked.camera_model, " eos 5d  ");
    assert_ok(match(state, &put, &asked));
    strcpy(asked.camera_model, "eos  5d"); /* inner blanks matter */
    assert_int_equal(match(state, &put, &asked), LENSPROF_ERROR_NOT_FOUND);
    strcpy(asked.camera_model, ""); /* unknown matches unknown only */
    assert_int_equal(match(state, &put, &asked), LENSPROF_ERROR_NOT_FOUND);
    asked = put;
    strcpy(asked.lens, "EF50mm");
    assert_int_equal(match(state, &put, &asked), LENSPROF_ERROR_NOT_FOUND);
    strcpy(put.lens, "\xc3\x89tude"); /* capital e acute; only ASCII case is ignored */
    strcpy(asked.lens, "\xc3\xa9tude");
    assert_int_equal(match(state, &put, &asked), LENSPROF_ERROR_NOT_FOUND);
    strcpy(asked.lens, "\xc3\x89TUDE");
    assert_ok(match(state, &put, &asked));
    strcpy(put.lens, "50%_");
    strcpy(asked.lens, "50xx"); /* no wildcards */
    assert_int_equal(match(state, &put, &asked), LENSPROF_ERROR_NOT_FOUND);
    asked = put;
    asked.processing = LENSPROF_PROCESSING_RAW;
    assert_int_equal(match(state, &put, &asked), LENSPROF_ERROR_NOT_FOUND);
}

static void test_numbers_match_to_a_millionth(void **state) {
    static const struct {
        double put, asked;
        int same;
    } cases[] = {
        {50.0, 50.0, 1},
        {50.0, 50.0 * (1 + 9e-7), 1},
        {50.0 * (1 + 9e-7), 50.0, 1},
        {50.0, 50.0 * (1 + 1.1e-6), 0},
        {50.0 * (1 + 1.1e-6), 50.0, 0},
        {50.0, LENSPROF_UNKNOWN, 0},
        {LENSPROF_UNKNOWN, 50.0, 0},
        {LENSPROF_UNKNOWN, LENSPROF_UNKNOWN, 1},
        {1e-7, 2e-7, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int field = 0; field < 4; field++) {
            lensprof_profile_key put, asked;
            lensprof_profile_key_init(&put);
            lensprof_profile_key_init(&asked);
            double *const in_put[] = {&put.focal_mm, &put.aperture, &put.distance_m, &put.color_temperature_k};
            double *const in_asked[] = {&asked.focal_mm, &asked.aperture, &asked.distance_m,
                                        &asked.color_temperature_k};
            *in_put[field] = cases[i].put;
            *in_asked[field] = cases[i].asked;
            assert_int_equal(match(state, &put, &asked), cases[i].same ? LENSPROF_OK : LENSPROF_ERROR_NOT_FOUND);
        }
}

static void test_infinity_matches_infinity_only(void **state) {
    static const double others[] = {1.0, 1.7e308, LENSPROF_UNKNOWN};
    lensprof_profile_key infinite, other;
    lensprof_profile_key_init(&infinite);
    infinite.distance_m = INFINITY;
    assert_ok(match(state, &infinite, &infinite));
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        other = infinite;
        other.distance_m = others[i];
        assert_int_equal(match(state, &infinite, &other), LENSPROF_ERROR_NOT_FOUND);
        assert_int_equal(match(state, &other, &infinite), LENSPROF_ERROR_NOT_FOUND);
    }
}

static void put_key(lensprof_store *store, const char *maker, const char *lens, double focal, double distance) {
    lensprof_profile *profile = new_profile();
    lensprof_profile_init(profile);
    strcpy(profile->key.camera_maker, maker);
    strcpy(profile->key.lens, lens);
    profile->key.focal_mm = focal;
    profile->key.distance_m = distance;
    put_at(store, profile);
    free(profile);
}

static void assert_ids(lensprof_store *store, const lensprof_profile_key *filter, const char *expected) {
    lensprof_store_row rows[20];
    char ids[100] = "";
    uint32_t found = 99;
    assert_ok(lensprof_store_list(store, filter, rows, 20, &found, NULL));
    assert_true(found <= 20);
    for (uint32_t i = 0; i < found; i++)
        snprintf(ids + strlen(ids), sizeof ids - strlen(ids), "%s%d", i ? " " : "", (int)rows[i].id);
    assert_string_equal(ids, expected);
}

static void fill_listing(lensprof_store *store) {
    put_key(store, "Nikon", "a", 50.0, INFINITY);           /* 1 */
    put_key(store, "canon", "b", 35.0, 2.0);                /* 2 */
    put_key(store, "Canon", "B", 35.0, INFINITY);           /* 3 */
    put_key(store, "CANON ", "b ", 35.0, LENSPROF_UNKNOWN); /* 4 */
    put_key(store, "Canon", "b", 24.0, 9.0);                /* 5 */
    put_key(store, "", "z", LENSPROF_UNKNOWN, 1.0);         /* 6 */
    put_key(store, "Canon", "a", 200.0, 1.0);               /* 7 */
    put_key(store, "Canon", "b", 24.0, 9.0);                /* 8, as 5 */
}

static void test_list_order(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    assert_ids(store, NULL, "");
    fill_listing(store);
    assert_ids(store, NULL, "6 7 5 8 4 2 3 1");
    lensprof_store_close(store);
}

static void test_list_filter(void **state) {
    lensprof_profile_key filter;
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    fill_listing(store);
    lensprof_profile_key_init(&filter);
    filter.processing = LENSPROF_PROCESSING_RAW; /* never filters */
    assert_ids(store, &filter, "6 7 5 8 4 2 3 1");
    strcpy(filter.camera_maker, " CANON");
    assert_ids(store, &filter, "7 5 8 4 2 3");
    strcpy(filter.lens, "b");
    assert_ids(store, &filter, "5 8 4 2 3");
    filter.focal_mm = 35.00001;
    assert_ids(store, &filter, "4 2 3");
    filter.distance_m = INFINITY;
    assert_ids(store, &filter, "3");
    filter.aperture = 2.8;
    assert_ids(store, &filter, "");
    filter.aperture = LENSPROF_UNKNOWN;
    filter.color_temperature_k = 5000.0;
    assert_ids(store, &filter, "");
    lensprof_profile_key_init(&filter);
    filter.distance_m = 1.0;
    assert_ids(store, &filter, "6 7");
    lensprof_store_close(store);
}

static void test_list_capacity(void **state) {
    lensprof_store_row rows[9];
    uint32_t found = 0;
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    fill_listing(store);
    assert_ok(lensprof_store_list(store, NULL, NULL, 0, &found, NULL));
    assert_int_equal(found, 8);
    memset(rows, 0x55, sizeof rows);
    lensprof_error error;
    found = 0;
    assert_int_equal(lensprof_store_list(store, NULL, rows, 7, &found, &error), LENSPROF_ERROR_CAPACITY);
    assert_non_null(strstr(error.text, "8 rows do not fit the buffer of 7"));
    assert_int_equal(found, 8);
    assert_int_equal(rows[0].id, 0x5555555555555555);
    found = 0;
    assert_ok(lensprof_store_list(store, NULL, rows, 8, &found, NULL));
    assert_int_equal(found, 8);
    assert_int_equal(rows[0].id, 6);
    assert_int_equal(rows[1].id, 7);
    assert_string_equal(rows[1].key.camera_maker, "Canon");
    assert_close(rows[1].key.focal_mm, 200.0, 0.0);
    assert_close(rows[1].provenance.heldout_rms, LENSPROF_UNKNOWN, 0.0);
    assert_int_equal(rows[8].id, 0x5555555555555555);
    lensprof_store_close(store);
}

static void test_long_list(void **state) {
    const place *here = *state;
    enum {
        COUNT = 1000
    };
    uint32_t found = 0;
    lensprof_store_row *rows = malloc(COUNT * sizeof *rows);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    put_key(store, "Canon", "a", 1.0, 1.0);
    run_sql(here->path,
            "WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n WHERE i < 1000)"
            " INSERT INTO profiles SELECT i, camera_maker, camera_model, lens, i, aperture, distance_m,"
            " processing, method, software, source, created_unix_s, images, pairs, heldout_rms,"
            " inlier_share, response_curves, vignetting_curves, covariance_size, covariance, 0,"
            " unit, crop_factor, doubt, lens_name, color_temperature_k, prior_id, forced, style, gamma_sigma,"
            " black_red, black_green, black_blue, white_level, circle_x, circle_y, circle_radius FROM profiles, n");
    assert_ok(lensprof_store_list(store, NULL, rows, COUNT, &found, NULL));
    assert_int_equal(found, COUNT);
    for (int i = 0; i < COUNT; i++) assert_close(rows[i].key.focal_mm, i + 1.0, 0.0);
    assert_int_equal(lensprof_store_list(store, NULL, rows, 999, &found, NULL), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(found, COUNT);
    lensprof_store_close(store);
    free(rows);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_newest_wins),
        store_test(test_texts_match_without_case_and_blanks),
        store_test(test_numbers_match_to_a_millionth),
        store_test(test_infinity_matches_infinity_only),
        store_test(test_list_order),
        store_test(test_list_filter),
        store_test(test_list_capacity),
        store_test(test_long_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
