/* Merging databases: every profile arrives unchanged, none twice, all or nothing. */
#include "store_fixture.h"

static lensprof_profile sample[3], found = {.struct_size = sizeof found};

/* Profiles with something in every field: EMoR and a grid; three tables; unknown numbers, gamma and a doubt. */
static void fill_samples(void) {
    double values[LENSPROF_RESPONSE_SAMPLES];
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) values[j] = sqrt(j / 1023.0);
    fill_profile(&sample[0]);
    fill_profile(&sample[1]);
    sample[1].responses = sample[1].vignettings = 3;
    for (int c = 0; c < 3; c++) {
        assert_ok(lensprof_response_set_table(&sample[1].response[c], values, LENSPROF_RESPONSE_SAMPLES));
        sample[1].vignetting[c] = (lensprof_vignetting){{-0.1 / (c + 1), 0.0, 1.0 / 30}, {-1.0 / 3, 1.0}};
    }
    strcpy(sample[1].key.unit, "12345");
    sample[1].key.crop_factor = 1.53;
    lensprof_profile_init(&sample[2]);
    strcpy(sample[2].key.lens, "Another");
    sample[2].key.distance_m = INFINITY;
    strcpy(sample[2].provenance.doubt, "start values");
    assert_ok(lensprof_response_set_gamma(&sample[2].response[0], 2.2));
}

/* A closed database with the samples from `first` on. */
static void make_other(const place *here, const char *name, int first, int count) {
    lensprof_store *store = store_in(here, name, LENSPROF_STORE_CREATE);
    for (int i = 0; i < count; i++) put_at(store, &sample[first + i]);
    lensprof_store_close(store);
}

static void assert_merged(lensprof_store *store, lensprof_store *other, uint32_t new_ones, uint32_t old_ones) {
    lensprof_error error;
    uint32_t added = 99, known = 99;
    if (lensprof_store_merge(store, other, &added, &known, &error) != LENSPROF_OK) fail_msg("%s", error.text);
    assert_int_equal(added, new_ones);
    assert_int_equal(known, old_ones);
}

static void test_everything_arrives_as_it_was(void **state) {
    const place *here = *state;
    fill_samples();
    make_other(here, "other.db", 0, 3);
    lensprof_store *store, *other;
    open_pair(here, "other.db", LENSPROF_STORE_READ, &store, &other);
    put_at(store, &sample[2]);
    assert_merged(store, other, 2, 1);
    for (int i = 0; i < 2; i++) {
        assert_ok(lensprof_store_get(store, 2 + i, &found, NULL));
        assert_same_profile(&found, &sample[i]);
    }
    assert_merged(store, other, 0, 3); /* not twice */
    assert_int_equal(count_at(store), 3);
    assert_int_equal(count_at(other), 3);
    close_pair(store, other);
    assert_integrity(here->path);
}

/* Any difference makes another profile, even the last bit of one number. */
static void test_what_differs_is_added(void **state) {
    const place *here = *state;
    enum {
        CHANGES = 14
    };
    lensprof_profile *p = new_profile();
    fill_samples();
    lensprof_store *store, *other;
    open_pair(here, "other.db", LENSPROF_STORE_CREATE, &store, &other);
    put_at(store, &sample[0]);
    for (int i = 0; i < CHANGES; i++) {
        static const double coefficients[] = {-0.625, 0.1, -0.05, 0.02, 0.03};
        *p = sample[0];
        if (i == 0) strcpy(p->key.camera_maker, "CANON");
        if (i == 1) p->key.focal_mm = nextafter(p->key.focal_mm, 100.0);
        if (i == 2) p->key.processing = LENSPROF_PROCESSING_RAW;
        if (i == 3) strcpy(p->provenance.source, "");
        if (i == 4) p->provenance.created_unix_s = 0;
        if (i == 5) p->provenance.inlier_share = LENSPROF_UNKNOWN;
        if (i == 6) strcpy(p->provenance.doubt, "x");
        if (i == 7) p->covariance[0] = nextafter(p->covariance[0], 1.0);
        if (i == 8) p->covariance_size = 0;
        if (i == 9) assert_ok(lensprof_response_set_emor(&p->response[0], coefficients, 5));
        if (i == 10) p->vignetting[0].k[2] = nextafter(p->vignetting[0].k[2], 1.0);
        if (i == 11) p->grid.attenuation[3] = nextafterf(p->grid.attenuation[3], 2.0f);
        if (i == 12) lensprof_gain_grid_init(&p->grid);
        if (i == 13) p->key.color_temperature_k = LENSPROF_UNKNOWN;
        put_at(other, p);
    }
    assert_merged(store, other, CHANGES, 0);
    assert_merged(store, other, 0, CHANGES);
    close_pair(store, other);
    free(p);
}

/* The newest profile of a key in the other database is the newest here; two equal ones become one. */
static void test_order_and_repetitions(void **state) {
    const place *here = *state;
    int64_t id;
    fill_samples();
    lensprof_store *store, *other;
    open_pair(here, "other.db", LENSPROF_STORE_CREATE, &store, &other);
    put_at(other, &sample[0]);
    sample[0].vignetting[0].k[0] = -0.25;
    put_at(other, &sample[0]);
    put_at(other, &sample[0]);
    assert_merged(store, other, 2, 1);
    assert_ok(lensprof_store_find(store, &sample[0].key, &found, &id, NULL));
    assert_int_equal(id, 2);
    assert_close(found.vignetting[0].k[0], -0.25, 0.0);
    close_pair(store, other);
}

static void test_older_layouts_are_read_as_they_are(void **state) {
    const place *here = *state;
    char path[300];
    lensprof_store *store, *other;
    fill_samples();
    sample[0].key.color_temperature_k = LENSPROF_UNKNOWN;
    snprintf(path, sizeof path, "%s/old.db", here->directory);
    for (int layout = 1; layout < LP_STORE_LAYOUT; layout++) {
        size_t size;
        unlink(path);
        unlink(here->path);
        if (layout == 1) lensprof_gain_grid_init(&sample[0].grid);
        lose_newer(&sample[0], layout);
        make_layout(path, layout, sample, 1);
        unsigned char *bytes = read_file(path, &size);
        open_pair(here, "old.db", LENSPROF_STORE_READ, &store, &other);
        assert_merged(store, other, 1, 0);
        assert_ok(lensprof_store_get(store, 1, &found, NULL));
        assert_same_profile(&found, &sample[0]);
        close_pair(store, other);
        assert_file(path, bytes, size);
        free(bytes);
        fill_grid(&sample[0].grid, 5, 4, 1);
    }
}

/* A prior gets its id in this database, even if it was already here, and 0 if it is not here. */
static void test_priors_are_renumbered(void **state) {
    const place *here = *state;
    static const int64_t priors[] = {0, 1, 2, 99, 5, INT64_MAX}, here_as[] = {3, 4, 0, 0, 0};
    lensprof_store *store, *other;
    fill_samples();
    open_pair(here, "other.db", LENSPROF_STORE_CREATE, &store, &other);
    put_at(store, &sample[1]);
    put_at(store, &sample[2]);
    for (int i = 0; i < 6; i++) {
        sample[0].provenance.images = (uint32_t)(10 + i);
        sample[0].provenance.prior_id = priors[i];
        sample[0].provenance.forced = i == 2;
        put_at(other, &sample[0]);
        if (i == 0) put_at(store, &sample[0]); /* 3 */
    }
    assert_merged(store, other, 5, 1);
    for (int i = 0; i < 5; i++) {
        assert_ok(lensprof_store_get(store, 4 + i, &found, NULL));
        assert_int_equal(found.provenance.prior_id, here_as[i]);
        assert_int_equal(found.provenance.forced, i == 1);
        assert_string_equal(found.provenance.method, "transfer");
        assert_int_equal(found.provenance.images, 11 + i);
    }
    assert_merged(store, other, 0, 6);
    close_pair(store, other);
}

/* A known profile without a prior gets it from the other database; an existing prior and `forced` stay. */
static void test_known_profiles_get_their_priors(void **state) {
    const place *here = *state;
    static const int64_t own[] = {0, 0, 1}, theirs[] = {0, 1, 2};
    lensprof_store *store, *other;
    fill_samples();
    open_pair(here, "other.db", LENSPROF_STORE_CREATE, &store, &other);
    put_at(store, &sample[1]);
    for (int i = 0; i < 3; i++) {
        sample[0].provenance.images = (uint32_t)(10 + i);
        sample[0].provenance.prior_id = own[i];
        sample[0].provenance.forced = 0;
        put_at(store, &sample[0]);
        sample[0].provenance.prior_id = theirs[i];
        sample[0].provenance.forced = 1;
        put_at(other, &sample[0]);
    }
    for (int again = 0; again < 2; again++) {
        assert_merged(store, other, 0, 3);
        assert_ok(lensprof_store_get(store, 3, &found, NULL));
        assert_int_equal(found.provenance.prior_id, 2);
        assert_int_equal(found.provenance.forced, 0);
        assert_ok(lensprof_store_get(store, 4, &found, NULL));
        assert_int_equal(found.provenance.prior_id, 1);
    }
    close_pair(store, other);
}

/* The same rule for importers: every profile is compared, not only the newest, and whatever its method. */
static void test_find_same(void **state) {
    const place *here = *state;
    lensprof_error error;
    int64_t id = 77;
    fill_samples();
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    sample[0].vignetting[0].center[0] = -0.0; /* stored as 0 */
    put_at(store, &sample[0]);
    sample[0].provenance.images++;
    put_at(store, &sample[0]);
    sample[0].provenance.images--;
    assert_ok(lensprof_store_find_same(store, &sample[1], &id, NULL));
    assert_int_equal(id, 0);
    strcpy(sample[0].provenance.software, "lensprof 99");
    memset(sample[0].provenance.method, 0, sizeof sample[0].provenance.method);
    sample[0].provenance.prior_id = 1;
    sample[0].provenance.forced = 0;
    assert_ok(lensprof_store_find_same(store, &sample[0], &id, NULL));
    assert_int_equal(id, 1);
    assert_ok(lensprof_response_set_gamma(&sample[2].response[0], 1.8)); /* compared by the number, not by the table */
    put_at(store, &sample[2]);
    sample[2].response[0].table[500] += 1e-11;
    assert_ok(lensprof_store_find_same(store, &sample[2], &id, NULL));
    assert_int_equal(id, 3);
    sample[2].response[0].gamma = 1.8001;
    assert_ok(lensprof_store_find_same(store, &sample[2], &id, NULL));
    assert_int_equal(id, 0);
    id = 1;
    sample[0].vignettings = 7;
    assert_int_equal(lensprof_store_find_same(store, &sample[0], &id, &error), lensprof_profile_validate(&sample[0]));
    assert_non_null(strstr(error.text, "invalid"));
    assert_int_equal(lensprof_store_find_same(store, NULL, &id, &error), LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
    store = store_at(here->path, LENSPROF_STORE_READ);
    assert_int_equal(lensprof_store_find_same(store, &sample[1], &id, &error), LENSPROF_ERROR_READ_ONLY);
    assert_int_equal(id, 1);
    lensprof_store_close(store);
}

static void test_damaged_row_takes_everything_back(void **state) {
    const place *here = *state;
    char path[300];
    lensprof_error error;
    uint32_t added = 77;
    fill_samples();
    make_other(here, "other.db", 0, 3);
    snprintf(path, sizeof path, "%s/other.db", here->directory);
    run_sql(path, "UPDATE vignettings SET k1 = -5 WHERE profile_id = 3");
    lensprof_store *store, *other;
    open_pair(here, "other.db", LENSPROF_STORE_READ, &store, &other);
    assert_int_equal(lensprof_store_merge(store, other, &added, NULL, &error), LENSPROF_ERROR_CORRUPT);
    assert_non_null(strstr(error.text, "other.db: profile 3 is damaged ("));
    assert_int_equal(added, 77);
    assert_int_equal(count_at(store), 0);
    assert_ok(lensprof_store_begin(store, NULL)); /* also in the caller's transaction, whose other calls remain */
    put_at(store, &sample[1]);
    assert_int_equal(lensprof_store_merge(store, other, &added, NULL, &error), LENSPROF_ERROR_CORRUPT);
    assert_ok(lensprof_store_commit(store, NULL));
    assert_int_equal(count_at(store), 1);
    close_pair(store, other);
    assert_integrity(here->path);
}

static void test_one_transaction_for_several(void **state) {
    const place *here = *state;
    fill_samples();
    make_other(here, "a.db", 0, 2);
    make_other(here, "b.db", 1, 2);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_store *a = store_in(here, "a.db", 0), *b = store_in(here, "b.db", 0);
    for (int again = 0; again < 2; again++) {
        assert_ok(lensprof_store_begin(store, NULL));
        assert_merged(store, a, 2, 0);
        assert_merged(store, b, 1, 1);
        if (again)
            assert_ok(lensprof_store_commit(store, NULL));
        else
            lensprof_store_rollback(store);
        assert_int_equal(count_at(store), again ? 3 : 0);
    }
    lensprof_store_close(a);
    lensprof_store_close(b);
    lensprof_store_close(store);
}

static void test_refusals(void **state) {
    const place *here = *state;
    lensprof_error error;
    char link[300];
    fill_samples();
    make_other(here, "other.db", 0, 1);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE), *same = store_at(here->path, 0);
    lensprof_store *other = store_in(here, "other.db", LENSPROF_STORE_READ);
    snprintf(link, sizeof link, "%s/link.db", here->directory);
    assert_int_equal(symlink(here->path, link), 0);
    lensprof_store *linked = store_at(link, LENSPROF_STORE_READ);
    assert_int_equal(lensprof_store_merge(NULL, other, NULL, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_merge(store, NULL, NULL, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_merge(store, store, NULL, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_merge(store, same, NULL, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_merge(store, linked, NULL, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "is the database itself"));
    assert_int_equal(lensprof_store_merge(other, store, NULL, NULL, &error), LENSPROF_ERROR_READ_ONLY);
    assert_int_equal(count_at(store), 0);
    lensprof_store_close(linked);
    lensprof_store_close(other);
    lensprof_store_close(same);
    lensprof_store_close(store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_everything_arrives_as_it_was),
        store_test(test_what_differs_is_added),
        store_test(test_order_and_repetitions),
        store_test(test_older_layouts_are_read_as_they_are),
        store_test(test_priors_are_renumbered),
        store_test(test_known_profiles_get_their_priors),
        store_test(test_find_same),
        store_test(test_damaged_row_takes_everything_back),
        store_test(test_one_transaction_for_several),
        store_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
