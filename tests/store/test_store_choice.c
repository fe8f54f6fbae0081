/* Which profiles a lookup uses if there are several kinds: states of processing, repeated settings, cameras. */
#include "store_fixture.h"

static lensprof_profile shared, answered = {.struct_size = sizeof answered}; /* 50 kB each */
static lensprof_lookup how = {.struct_size = sizeof how};

typedef struct entry {
    const char *camera, *lens, *unit;
    double aperture, crop, k1;
    uint32_t processing;
} entry;

static void put(lensprof_store *store, const entry *e) {
    lensprof_profile_init(&shared);
    strcpy(shared.key.camera_model, e->camera);
    strcpy(shared.key.lens, e->lens);
    strcpy(shared.key.unit, e->unit);
    shared.key.focal_mm = 50.0, shared.key.aperture = e->aperture, shared.key.distance_m = INFINITY;
    shared.key.crop_factor = e->crop, shared.key.processing = e->processing;
    shared.vignetting[0].k[0] = e->k1;
    put_at(store, &shared);
}

static lensprof_store *store_of(const place *here, const entry *entries, int count) {
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    for (int i = 0; i < count; i++) put(store, &entries[i]);
    return store;
}

static lensprof_status ask(lensprof_store *store, const char *camera, const char *lens, double focal, double aperture,
                           uint32_t any_processing) {
    lensprof_lookup_options options;
    lensprof_profile_key key;
    lensprof_lookup_options_init(&options);
    options.any_processing = any_processing;
    lensprof_profile_key_init(&key);
    strcpy(key.camera_model, camera);
    strcpy(key.lens, lens);
    key.focal_mm = focal, key.aperture = aperture, key.distance_m = INFINITY, key.processing = LENSPROF_PROCESSING_RAW;
    return lensprof_store_lookup(store, &key, &options, &answered, &how, NULL);
}

#define RAW LENSPROF_PROCESSING_RAW
#define JPEG LENSPROF_PROCESSING_JPEG

/* Only profiles with the key's processing count; if any processing will do, that of the newest, which the answer
 * states. */
static void test_one_processing(void **state) {
    static const entry entries[] = {{"", "A 50mm", "", 2.0, 1.5, -0.5, RAW},
                                    {"", "A 50mm", "", 4.0, 1.5, -0.3, RAW},
                                    {"", "A 50mm", "", 2.0, 1.5, -0.1, JPEG},
                                    {"", "A 50mm", "", 4.0, 1.5, -0.05, JPEG}};
    lensprof_store *store = store_of(*state, entries, 4);
    assert_ok(ask(store, "", "A 50mm", 50, 2.8, 1));
    assert_int_equal(how.rows, 2);
    assert_int_equal(answered.key.processing, JPEG);
    assert_true(answered.vignetting[0].k[0] > -0.15);
    assert_close(answered.key.crop_factor, 1.5, 0.0); /* the unit of r */
    assert_ok(ask(store, "", "A 50mm", 50, 2.8, 0));
    assert_int_equal(answered.key.processing, RAW);
    assert_true(answered.vignetting[0].k[0] < -0.3);
    lensprof_store_close(store);
}

/* A profile includes the earlier ones of its setting that it was fitted with, or has overruled them: only the newest
 * counts. */
static void test_newest_of_a_setting(void **state) {
    static const entry entries[] = {{"", "A 50mm", "", 2.0, 1, -0.9, RAW},
                                    {"", "A 50mm", "", 2.0, 1, -0.4, RAW},
                                    {"", "A 50mm", "", 4.0, 1, -0.9, RAW},
                                    {"", "A 50mm", "", 4.0, 1, -0.3, RAW}};
    lensprof_store *store = store_of(*state, entries, 4);
    assert_ok(ask(store, "", "A 50mm", 50, 2.8, 0));
    assert_int_equal(how.rows, 2);
    assert_true(answered.vignetting[0].k[0] > -0.4 && answered.vignetting[0].k[0] < -0.3);
    assert_ok(ask(store, "", "A 50mm", LENSPROF_UNKNOWN, 2.0, 0)); /* the only focal length: exact */
    assert_int_equal(how.exact, 1);
    assert_int_equal(how.id[0], 2);
    lensprof_store_close(store);
}

/* Rows of a camera also answer queries for the lens alone or with another camera, with a reason. Rows of a single unit
 * do not, and a reason mentions them. */
static void test_lens_of_cameras(void **state) {
    static const entry entries[] = {{"EOS 5D", "A 50mm", "", 2.0, 1, -0.5, RAW},
                                    {"EOS 5D", "A 50mm", "", 4.0, 1, -0.3, RAW},
                                    {"", "B 50mm", "77", 2.0, 1, -0.5, RAW}};
    lensprof_store *store = store_of(*state, entries, 3);
    assert_ok(ask(store, "", "A 50mm", 50, 2.8, 0));
    assert_int_equal(how.rows, 2);
    assert_ok(ask(store, "EOS 5D", "A 50mm", 50, 2.8, 0));
    assert_int_equal(how.reason_code[0], LENSPROF_REASON_NONE);
    assert_ok(ask(store, "EOS 6D", "A 50mm", 50, 2.8, 0));
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_ON_OTHER_CAMERA, "on other cameras"));
    assert_ok(ask(store, "EOS 6D", "A 50mm", 50, 2.0, 0)); /* same setting, but measured with another response */
    assert_int_equal(how.exact, 0);
    assert_int_equal(ask(store, "", "B 50mm", 50, 2.0, 0), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_OTHER_CAMERA, "single units"));
    lensprof_store_close(store);
}

/* The only lens of a camera is found by any of the camera's names, and, if built in, also under the lens name in
 * EXIF. */
static void test_built_in_lens(void **state) {
    static const entry entries[] = {
        {"Canon PowerShot S110", "Canon PowerShot S110 & compatibles", "", 2.0, 4.6, -0.5, RAW},
        {"Canon PowerShot S110", "Canon PowerShot S110 & compatibles", "", 4.0, 4.6, -0.3, RAW},
        {"EOS 5D", "Canon 50mm f/2", "", 2.0, 1, -0.4, RAW}};
    lensprof_store *store = store_of(*state, entries, 3);
    for (int i = 0; i < 4; i++) {
        static const char *const names[] = {"canon powershot s110", "PowerShot S110", "CANON PowerShot-S110",
                                            "PowerShot S110"};
        assert_ok(ask(store, names[i], i == 3 ? "5.2-26.0 mm" : "", 50, 2.8, 0));
        assert_int_equal(how.rows, 2);
    }
    assert_close(how.name_score, 0.6, 0.0);
    assert_true(
        has_reason(&how, LENSPROF_REASON_LOOKUP_BUILT_IN, "built-in lens is used: Canon PowerShot S110 & compatibles"));
    assert_int_equal(ask(store, "EOS 5D", "Canon 85mm f/2", 50, 2.0, 0), LENSPROF_ERROR_NOT_FOUND); /* another lens */
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_NO_LENS, "no profile of a lens with this name"));
    lensprof_store_close(store);
}

/* Spacings of nodes also apply to fast lenses: one spacing beyond f/1.4 is f/2.06. */
static void test_fast_lens(void **state) {
    static const entry entries[] = {{"", "A 50mm", "", 0.95, 1, -0.6, RAW}, {"", "A 50mm", "", 1.4, 1, -0.4, RAW}};
    lensprof_store *store = store_of(*state, entries, 2);
    assert_ok(ask(store, "", "A 50mm", 50, 2.0, 0));
    assert_int_equal(ask(store, "", "A 50mm", 50, 2.2, 0), LENSPROF_ERROR_NOT_FOUND);
    lensprof_store_close(store);
}

/* One spacing beyond the last node is answered, with a reason. */
static void test_outside_is_said(void **state) {
    static const entry entries[] = {{"", "A 50mm", "", 2.0, 1, -0.5, RAW},
                                    {"", "A 50mm", "", 2.8, 1, -0.4, RAW},
                                    {"", "A 50mm", "", 4.0, 1, -0.3, RAW}};
    lensprof_store *store = store_of(*state, entries, 3);
    assert_ok(ask(store, "", "A 50mm", 50, 5.0, 0));
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_APERTURE_OUTSIDE, "the aperture is outside the stored range"));
    assert_ok(ask(store, "", "A 50mm", 50, 3.2, 0));
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_UNKNOWN_SENSOR, "the sensor size is unknown"));
    assert_int_equal(how.reason_code[1], LENSPROF_REASON_NONE);
    lensprof_store_close(store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_one_processing), store_test(test_newest_of_a_setting), store_test(test_lens_of_cameras),
        store_test(test_built_in_lens),  store_test(test_outside_is_said),     store_test(test_fast_lens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
