/* The table of cameras: stored, found by all their names, listed, merged, checked. */
#include "store_fixture.h"

static lensprof_camera_model camera(const char *maker, const char *model, const char *other, double crop) {
    lensprof_camera_model made;
    lensprof_camera_model_init(&made);
    strcpy(made.maker, maker);
    strcpy(made.model, model);
    strcpy(made.other_model, other);
    strcpy(made.mount, "a mount");
    made.crop_factor = crop;
    return made;
}

static void put_camera(lensprof_store *store, const lensprof_camera_model *one) {
    lensprof_error error;
    if (lensprof_store_put_camera(store, one, &error) != LENSPROF_OK) fail_msg("%s", error.text);
}

static void fill(lensprof_store *store) {
    lensprof_camera_model all[] = {camera("Canon", "Canon EOS 600D", "EOS 600D", 1.613),
                                   camera("Sony", "ILCE-7M3", "Alpha 7 III", 1.0),
                                   camera("Nikon Corporation", "Nikon Z 7_2", "Z 7II", 1.0),
                                   camera("Fujifilm", "X100V", "", 1.529),
                                   camera("Olympus Imaging Corp.", "E-M1", "", 2.0),
                                   camera("Panasonic", "DMC-LX3", "", 4.7),
                                   camera("Panasonic", "DMC-LX3", "", 5.75)};
    strcpy(all[3].lens, "X100V & compatibles (Standard)");
    strcpy(all[3].source, "compact-fujifilm.xml");
    all[3].fixed_lens = all[5].fixed_lens = all[6].fixed_lens = 1;
    strcpy(all[5].variant, "4:3");
    strcpy(all[6].variant, "16:9");
    strcpy(all[5].lens, "LX3");
    strcpy(all[6].lens, "LX3");
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) put_camera(store, &all[i]);
}

static void test_names(void **state) {
    static const struct {
        const char *maker, *model, *found; /* NULL = none */
    } names[] = {{"Canon", "Canon EOS 600D", "Canon EOS 600D"},
                 {"Canon", "Canon EOS REBEL T3i", "Canon EOS 600D"},
                 {"", "eos kiss x5", "Canon EOS 600D"},
                 {"SONY", "ILCE-7M3", "ILCE-7M3"},
                 {"", "Sony Alpha 7 III", "ILCE-7M3"},
                 {"NIKON CORPORATION", "NIKON Z 7_2", "Nikon Z 7_2"},
                 {"FUJIFILM", "X100V", "X100V"},
                 {"OLYMPUS CORPORATION", "E-M1", "E-M1"},
                 {"Nikon", "Canon EOS 600D", NULL},
                 {"Panasonic", "X100V", NULL},
                 {"", "Nikon EOS 600D", NULL},
                 {"Canon", "Canon EOS 60D", NULL},
                 {"SONY", "ILCE-7M2", NULL},
                 {"SONY", "", NULL},
                 {"SONY", "Sony", NULL},
                 {"", "", NULL}};
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_camera_model found;
    lensprof_error error;
    fill(store);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        memset(&found, 0x5A, sizeof found);
        const lensprof_status status =
            lensprof_store_find_camera(store, names[i].maker, names[i].model, &found, &error);
        if (names[i].found) {
            if (status != LENSPROF_OK) fail_msg("%s: %s", names[i].model, error.text);
            assert_string_equal(found.model, names[i].found);
            assert_ok(lp_camera_model_validate(&found));
        } else {
            if (status != LENSPROF_ERROR_NOT_FOUND) fail_msg("%s is found as %s", names[i].model, found.model);
            assert_int_equal(found.model[0], 0x5A);
        }
    }
    lensprof_store_close(store);
}

static void test_last_word(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_camera_model found, mavic = camera("DJI", "Mavic Pro FC220", "", 5.6);
    fill(store);
    put_camera(store, &mavic);
    assert_ok(lensprof_store_find_camera(store, "DJI", "FC220", &found, NULL));
    assert_string_equal(found.model, "Mavic Pro FC220");
    static const char *const others[][2] = {{"DJI", "C220"},    {"DJI", "220"}, {"DJI", "Air FC220"}, {"DJI", "Pro"},
                                            {"Canon", "FC220"}, {"", "FC220"},  {"DJI", "XFC220"}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (lensprof_store_find_camera(store, others[i][0], others[i][1], &found, NULL) != LENSPROF_ERROR_NOT_FOUND)
            fail_msg("%s is found as %s", others[i][1], found.model);
    lensprof_store_close(store);
}

static void test_every_member(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_camera_model found, put = camera("Ricoh", "GR III", "GR 3", 1.5);
    strcpy(put.other_maker, "Ricoh Imaging");
    strcpy(put.variant, "crop");
    strcpy(put.lens, "GR III & compatibles");
    strcpy(put.source, "a file");
    put.fixed_lens = 1;
    put_camera(store, &put);
    assert_ok(lensprof_store_find_camera(store, "Ricoh", "GR 3", &found, NULL));
    assert_memory_equal(&found, &put, sizeof put);
    put.crop_factor = LENSPROF_UNKNOWN; /* replaces the previous one */
    put_camera(store, &put);
    assert_ok(lensprof_store_find_camera(store, "Ricoh", "GR III", &found, NULL));
    assert_memory_equal(&found, &put, sizeof put);
    lensprof_store_close(store);
    assert_integrity(here->path);
}

static void test_what_several_do_not_agree_on_is_unknown(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_camera_model found;
    fill(store);
    assert_ok(lensprof_store_find_camera(store, "Panasonic", "DMC-LX3", &found, NULL));
    assert_close(found.crop_factor, LENSPROF_UNKNOWN, 0);
    assert_string_equal(found.lens, "LX3");
    assert_string_equal(found.variant, "");
    assert_int_equal(found.fixed_lens, 1);
    lensprof_store_close(store);
}

static void test_list(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_camera_model rows[8];
    uint32_t count = 99;
    assert_ok(lensprof_store_list_camera_models(store, NULL, 0, &count, NULL));
    assert_int_equal(count, 0);
    fill(store);
    assert_ok(lensprof_store_list_camera_models(store, rows, 8, &count, NULL));
    assert_int_equal(count, 7);
    assert_string_equal(rows[0].model, "Canon EOS 600D");
    assert_string_equal(rows[4].variant, "16:9");
    assert_string_equal(rows[6].maker, "Sony");
    assert_int_equal(lensprof_store_list_camera_models(store, rows, 6, &count, NULL), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(count, 7);
    lensprof_store_close(store);
}

static void test_merge(void **state) {
    const place *here = *state;
    lensprof_store *store, *other;
    lensprof_camera_model found, own = camera("Sony", "ILCE-7M3", "", 1.01);
    uint32_t count, added = 99;
    open_pair(here, "other.db", LENSPROF_STORE_CREATE, &store, &other);
    fill(other);
    put_camera(store, &own);
    assert_ok(lensprof_store_merge(store, other, &added, NULL, NULL));
    assert_int_equal(added, 0);
    assert_ok(lensprof_store_list_camera_models(store, NULL, 0, &count, NULL));
    assert_int_equal(count, 7);
    assert_ok(lensprof_store_find_camera(store, "Sony", "ILCE-7M3", &found, NULL));
    assert_close(found.crop_factor, 1.01, 0); /* existing cameras stay */
    close_pair(store, other);
    assert_integrity(here->path);
}

/* Files of layouts without this table: nothing is found, and a put creates it. */
static void test_older_layouts(void **state) {
    const place *here = *state;
    lensprof_profile *profile = new_profile();
    fill_profile(profile);
    for (int layout = 1; layout < LP_STORE_LAYOUT; layout++) {
        lensprof_camera_model found;
        uint32_t count = 99;
        unlink(here->path);
        make_layout(here->path, layout, profile, 1);
        lensprof_store *store = store_at(here->path, LENSPROF_STORE_WRITE);
        assert_int_equal(lensprof_store_find_camera(store, "Sony", "ILCE-7M3", &found, NULL), LENSPROF_ERROR_NOT_FOUND);
        assert_ok(lensprof_store_list_camera_models(store, NULL, 0, &count, NULL));
        assert_int_equal(count, 0);
        fill(store);
        assert_ok(lensprof_store_find_camera(store, "Sony", "ILCE-7M3", &found, NULL));
        lensprof_store_close(store);
    }
    free(profile);
}

static lensprof_status count_faults(void *user, const lensprof_store_fault *fault) {
    *(int *)user += strstr(fault->reason, "camera 1: impossible crop_factor") != NULL;
    return LENSPROF_OK;
}

static void test_damage(void **state) {
    const place *here = *state;
    lensprof_camera_model found;
    lensprof_error error;
    uint32_t count;
    int faults = 0;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    fill(store);
    lensprof_store_close(store);
    run_sql(here->path, "PRAGMA ignore_check_constraints = ON; UPDATE cameras SET crop_factor = -2 WHERE id = 1");
    store = store_at(here->path, LENSPROF_STORE_READ);
    assert_int_equal(lensprof_store_find_camera(store, "Canon", "EOS 600D", &found, &error), LENSPROF_ERROR_CORRUPT);
    assert_non_null(strstr(error.text, "profiles.db: camera 1 is damaged (crop_factor)"));
    assert_int_equal(lensprof_store_list_camera_models(store, NULL, 0, &count, &error), LENSPROF_ERROR_CORRUPT);
    assert_ok(lensprof_store_find_camera(store, "Sony", "ILCE-7M3", &found, &error));
    assert_ok(lensprof_store_check(store, count_faults, &faults, NULL, NULL, NULL));
    assert_int_equal(faults, 1);
    lensprof_store_close(store);
}

static void test_refusals(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_camera_model one = camera("Sony", " ", "", 1.0);
    lensprof_error error;
    assert_int_equal(lensprof_store_put_camera(store, &one, &error), LENSPROF_ERROR_ARGUMENT);
    one = camera("Sony", "A\nB", "", 1.0);
    assert_int_equal(lensprof_store_put_camera(store, &one, &error), LENSPROF_ERROR_ARGUMENT);
    one = camera("Sony", "A", "", 0.0);
    assert_int_equal(lensprof_store_put_camera(store, &one, &error), LENSPROF_ERROR_ARGUMENT);
    one = camera("Sony", "A", "", 1.0);
    one.reserved[60] = 1;
    assert_int_equal(lensprof_store_put_camera(store, &one, &error), LENSPROF_ERROR_ARGUMENT);
    one.reserved[60] = 0;
    assert_int_equal(lensprof_store_put_camera(NULL, &one, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_find_camera(store, NULL, "A", &one, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_list_camera_models(store, NULL, 1, &(uint32_t){0}, &error),
                     LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
    store = store_at(here->path, LENSPROF_STORE_READ);
    assert_int_equal(lensprof_store_put_camera(store, &one, &error), LENSPROF_ERROR_READ_ONLY);
    lensprof_store_close(store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_names),         store_test(test_last_word),
        store_test(test_every_member),  store_test(test_what_several_do_not_agree_on_is_unknown),
        store_test(test_list),          store_test(test_merge),
        store_test(test_older_layouts), store_test(test_damage),
        store_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
