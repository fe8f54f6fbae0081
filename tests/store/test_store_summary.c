/* Lists of lenses and cameras, and profiles that get another key. */
#include "store_fixture.h"

typedef struct row {
    const char *maker, *model, *lens;
    double focal_mm, aperture, distance_m;
    uint32_t processing;
} row;

static const row rows[] = {
    {"Canon", "Canon EOS 6D", "EF24-70mm f/2.8L USM", 24, 2.8, 10, LENSPROF_PROCESSING_RAW},
    {"", "", "Canon EF 24-70mm f/2.8L USM", 70, 8, INFINITY, LENSPROF_PROCESSING_RAW},
    {"", "", "canon ef 24-70MM f/2.8L USM ", 35, 4, -1, LENSPROF_PROCESSING_JPEG},
    {"", "", "Canon EF 24-70mm f/2.8L II USM", 24, 2.8, -1, LENSPROF_PROCESSING_RAW},
    {"NIKON CORPORATION", "NIKON D500", "AF-S DX 35mm f/1.8G", 35, 1.8, -1, LENSPROF_PROCESSING_CORRECTED},
    {"NIKON CORPORATION", "nikon d500", "", 8, -1, -1, LENSPROF_PROCESSING_JPEG},
};

static lensprof_store *make_database(const place *here) {
    lensprof_profile *profile = new_profile();
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lensprof_profile_init(profile);
        strcpy(profile->key.camera_maker, rows[i].maker);
        strcpy(profile->key.camera_model, rows[i].model);
        strcpy(profile->key.lens, rows[i].lens);
        profile->key.focal_mm = rows[i].focal_mm;
        profile->key.aperture = rows[i].aperture;
        profile->key.distance_m = rows[i].distance_m;
        profile->key.processing = rows[i].processing;
        put_at(store, profile);
    }
    free(profile);
    return store;
}

static uint32_t list(lensprof_store *store, uint32_t which, const char *part, lensprof_store_summary *found) {
    uint32_t count = 99;
    lensprof_error error;
    if (lensprof_store_list_names(store, which, part, found, 20, &count, &error) != LENSPROF_OK)
        fail_msg("%s", error.text);
    return count;
}

static void test_lenses(void **state) {
    lensprof_store *store = make_database(*state);
    lensprof_store_summary found[20];
    assert_int_equal(list(store, LENSPROF_NAMES_LENSES, NULL, found), 4);
    assert_string_equal(found[0].lens, "AF-S DX 35mm f/1.8G");
    assert_string_equal(found[1].lens, "Canon EF 24-70mm f/2.8L II USM");
    const lensprof_store_summary *one = &found[2];
    assert_string_equal(one->lens, "Canon EF 24-70mm f/2.8L USM");
    assert_string_equal(one->camera_model, "");
    assert_int_equal(one->profiles, 2);
    assert_int_equal(one->others, 0);
    assert_int_equal(one->processing[LENSPROF_PROCESSING_RAW], 1);
    assert_int_equal(one->processing[LENSPROF_PROCESSING_JPEG], 1);
    assert_true(one->focal_mm[0] == 35 && one->focal_mm[1] == 70);
    assert_true(one->distance_m[0] == INFINITY && one->distance_m[1] == INFINITY);
    assert_int_equal(found[3].others, 1);
    lensprof_store_close(store);
}

static void test_parts(void **state) {
    lensprof_store *store = make_database(*state);
    lensprof_store_summary found[20];
    static const struct {
        const char *part;
        uint32_t lenses, cameras;
    } cases[] = {
        {"", 4, 2},
        {"  ", 4, 2},
        {"24-70", 3, 0},
        {" 2470 CANON ", 2, 0},
        {"usm ii", 1, 0},
        {"35mm f/1.8", 1, 0},
        {"Canon EF 24-70mm f/2.8L USM", 2, 0}, /* a name, with and without the maker: does not match II */
        {"d500", 0, 1},
        {"nikon", 0, 1},
        {"canon 6d", 0, 1},
        {"Canon EOS 6D", 0, 1},
        {"eos 60d", 0, 0},
        {"100%", 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(list(store, LENSPROF_NAMES_LENSES, cases[i].part, found), cases[i].lenses);
        assert_int_equal(list(store, LENSPROF_NAMES_CAMERAS, cases[i].part, found), cases[i].cameras);
    }
    char longest[1000];
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    assert_int_equal(list(store, LENSPROF_NAMES_LENSES, longest, found), 0);
    lensprof_store_close(store);
}

static void test_cameras(void **state) {
    lensprof_store *store = make_database(*state);
    lensprof_store_summary found[20];
    assert_int_equal(list(store, LENSPROF_NAMES_CAMERAS, NULL, found), 2);
    assert_string_equal(found[0].camera_model, "Canon EOS 6D");
    assert_string_equal(found[1].camera_maker, "NIKON CORPORATION");
    assert_int_equal(found[1].profiles, 2);
    assert_int_equal(found[1].others, 1);
    assert_string_equal(found[1].lens, "");
    lensprof_store_close(store);
}

static void test_capacity(void **state) {
    lensprof_store *store = make_database(*state);
    lensprof_store_summary found[3];
    uint32_t count = 0;
    lensprof_error error;
    memset(found, 7, sizeof found);
    assert_int_equal(lensprof_store_list_names(store, LENSPROF_NAMES_LENSES, NULL, NULL, 0, &count, &error),
                     LENSPROF_OK);
    assert_int_equal(count, 4);
    assert_int_equal(lensprof_store_list_names(store, LENSPROF_NAMES_LENSES, NULL, found, 3, &count, &error),
                     LENSPROF_ERROR_CAPACITY);
    assert_int_equal(count, 4);
    assert_int_equal(((unsigned char *)found)[0], 7);
    assert_int_equal(lensprof_store_list_names(store, 2, NULL, found, 3, &count, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_list_names(NULL, LENSPROF_NAMES_LENSES, NULL, found, 3, &count, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_list_names(store, LENSPROF_NAMES_CAMERAS, NULL, NULL, 3, &count, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_list_names(store, LENSPROF_NAMES_CAMERAS, NULL, found, 3, NULL, &error),
                     LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
}

static void test_set_key(void **state) {
    lensprof_store *store = make_database(*state);
    lensprof_profile *before = new_profile(), *after = new_profile();
    lensprof_lookup_options options;
    lensprof_lookup how;
    lensprof_error error;
    lensprof_lookup_options_init(&options);
    lensprof_lookup_init(&how);
    assert_ok(lensprof_store_get(store, 4, before, &error));
    lensprof_profile_key key = before->key;
    memset(key.lens, 0, sizeof key.lens);
    strcpy(key.lens, "Another 50mm f/2");
    strcpy(key.unit, "SN 7");
    key.focal_mm = 50, key.aperture = 2, key.distance_m = INFINITY, key.crop_factor = 1.5;
    key.color_temperature_k = 5000, key.processing = LENSPROF_PROCESSING_JPEG;
    assert_ok(lensprof_store_set_key(store, 4, &key, &error));
    assert_ok(lensprof_store_get(store, 4, after, &error));
    assert_memory_equal(&after->key, &key, sizeof key);
    assert_memory_equal(&after->provenance, &before->provenance, sizeof after->provenance);
    assert_memory_equal(after->vignetting, before->vignetting, sizeof after->vignetting);
    assert_ok(lensprof_store_lookup(store, &key, &options, after, &how, &error)); /* under its new name */
    assert_int_equal(how.id[0], 4);
    assert_int_equal(lensprof_store_set_key(store, 99, &key, &error), LENSPROF_ERROR_NOT_FOUND);
    key.aperture = -3;
    assert_int_equal(lensprof_store_set_key(store, 4, &key, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_set_key(store, 4, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
    store = store_at(((const place *)*state)->path, LENSPROF_STORE_READ);
    key.aperture = 4;
    assert_int_equal(lensprof_store_set_key(store, 4, &key, &error), LENSPROF_ERROR_READ_ONLY);
    lensprof_store_close(store);
    free(before);
    free(after);
}

int main(void) {
    const struct CMUnitTest tests[] = {store_test(test_lenses), store_test(test_parts), store_test(test_cameras),
                                       store_test(test_capacity), store_test(test_set_key)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
