/* The database in normal operation: profiles are stored, read and removed; invalid profiles are not stored. */
#include "store_fixture.h"

static void round_trip(const place *here, const lensprof_profile *profile) {
    lensprof_profile *found = new_profile();
    int64_t id;
    scribble(found);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    int64_t put = put_at(store, profile);
    lensprof_store_close(store);
    store = store_at(here->path, LENSPROF_STORE_READ);
    assert_ok(lensprof_store_get(store, put, found, NULL));
    assert_same_profile(profile, found);
    scribble(found);
    assert_ok(lensprof_store_find(store, &profile->key, found, &id, NULL));
    assert_int_equal(id, put);
    assert_same_profile(profile, found);
    lensprof_store_close(store);
    assert_integrity(here->path);
    free(found);
}

static void test_every_field_round_trips(void **state) {
    lensprof_profile *profile = new_profile();
    fill_profile(profile);
    profile->provenance.prior_id = INT64_MAX;
    round_trip(*state, profile);
    free(profile);
}

static void test_three_curves_round_trip(void **state) {
    lensprof_profile *profile = new_profile();
    double values[LENSPROF_RESPONSE_SAMPLES], coefficients[LENSPROF_EMOR_MODES] = {0};
    uint64_t seed = 1;
    fill_profile(profile);
    profile->responses = profile->vignettings = 3;
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) values[j] = j ? values[j - 1] + lp_random(&seed) : 0.0;
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) values[j] /= values[LENSPROF_RESPONSE_SAMPLES - 1];
    assert_ok(lensprof_response_set_table(&profile->response[0], values, LENSPROF_RESPONSE_SAMPLES));
    assert_ok(lensprof_response_set_gamma(&profile->response[1], 2.2 + 1e-15));
    coefficients[24] = 5e-324; /* the smallest positive number, after 24 zeros that count */
    assert_ok(lensprof_response_set_emor(&profile->response[2], coefficients, LENSPROF_EMOR_MODES));
    for (int c = 0; c < 3; c++)
        profile->vignetting[c] = (lensprof_vignetting){{-0.1 / (c + 1), 1e-300 * c, 1.0 / 30}, {-1.0 / 3, 1.0}};
    fill_grid(&profile->grid, LENSPROF_GRID_SIDE, LENSPROF_GRID_SIDE, 3);
    profile->covariance_size = LENSPROF_COVARIANCE_MAX;
    for (uint32_t i = 0; i < LENSPROF_COVARIANCE_MAX; i++)
        for (uint32_t j = 0; j <= i; j++)
            profile->covariance[36 * i + j] = profile->covariance[36 * j + i] = i == j ? 1.0 : -lp_random(&seed);
    profile->covariance[1] = profile->covariance[36] = -0.0;
    round_trip(*state, profile);
    free(profile);
}

static void test_unknown_and_infinite_round_trip(void **state) {
    lensprof_profile *profile = new_profile();
    lensprof_profile_init(profile);
    round_trip(*state, profile); /* everything unknown */
    profile->key.distance_m = INFINITY;
    profile->key.focal_mm = 35.0;
    round_trip(*state, profile);
    profile->key.processing = LENSPROF_PROCESSING_RAW;
    profile->provenance.heldout_rms = 0.0;
    profile->provenance.inlier_share = 1.0;
    profile->provenance.created_unix_s = -1; /* a second before 1970, not unknown */
    round_trip(*state, profile);
    profile->key.processing = LENSPROF_PROCESSING_CORRECTED;
    profile->key.aperture = 5e-324;
    assert_ok(lensprof_response_set_emor(&profile->response[0], NULL, 0)); /* the mean curve */
    round_trip(*state, profile);
    free(profile);
}

/* Negative zero is the only number that SQLite does not keep to the bit; see 0001_profiles.sql. */
static void test_negative_zero_becomes_zero(void **state) {
    lensprof_profile *profile = new_profile();
    fill_profile(profile);
    profile->vignetting[0].k[0] = -0.0;
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    int64_t id = put_at(store, profile);
    assert_ok(lensprof_store_get(store, id, profile, NULL));
    assert_close(profile->vignetting[0].k[0], 0.0, 0.0);
    assert_false(signbit(profile->vignetting[0].k[0]));
    lensprof_store_close(store);
    free(profile);
}

static void test_longest_texts_round_trip(void **state) {
    lensprof_profile *profile = new_profile();
    lensprof_profile_init(profile);
    memset(profile->key.camera_maker, 'a', sizeof profile->key.camera_maker - 1);
    memset(profile->key.camera_model, 'b', sizeof profile->key.camera_model - 1);
    memset(profile->key.lens, '\xe9', sizeof profile->key.lens - 1); /* Latin-1, not UTF-8: stored unchanged */
    memset(profile->provenance.method, 'd', sizeof profile->provenance.method - 1);
    memset(profile->provenance.software, 'e', sizeof profile->provenance.software - 1);
    for (size_t i = 0; i + 2 < sizeof profile->provenance.source; i += 2)
        memcpy(profile->provenance.source + i, "\xc3\xa9", 2);
    round_trip(*state, profile);
    free(profile);
}

/* The columns are for other SQL users: this queries them the same way. */
static void test_numbers_can_be_queried(void **state) {
    const place *here = *state;
    lensprof_profile *profile = new_profile();
    sqlite3 *db;
    sqlite3_stmt *statement;
    fill_profile(profile);
    profile->key.distance_m = INFINITY;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    put_at(store, profile);
    lensprof_store_close(store);
    assert_int_equal(sqlite3_open(here->path, &db), SQLITE_OK);
    const char *sql =
        "SELECT camera_maker, focal_mm, distance_m = 9e999, processing, kind, emor_modes, coefficient,"
        " k1, center_y, length(covariance) FROM profiles JOIN responses r ON r.profile_id = id"
        " JOIN vignettings v ON v.profile_id = id"
        " JOIN emor_coefficients e ON e.profile_id = id AND mode = 1";
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    assert_string_equal((const char *)sqlite3_column_text(statement, 0), "Canon");
    assert_close(sqlite3_column_double(statement, 1), 24.1, 0.0);
    assert_int_equal(sqlite3_column_int(statement, 2), 1);
    assert_string_equal((const char *)sqlite3_column_text(statement, 3), "jpeg");
    assert_string_equal((const char *)sqlite3_column_text(statement, 4), "emor");
    assert_int_equal(sqlite3_column_int(statement, 5), 5);
    assert_close(sqlite3_column_double(statement, 6), -0.625, 0.0);
    assert_close(sqlite3_column_double(statement, 7), -0.3, 0.0);
    assert_close(sqlite3_column_double(statement, 8), -0.02, 0.0);
    assert_int_equal(sqlite3_column_int(statement, 9), 800);
    assert_int_equal(sqlite3_step(statement), SQLITE_DONE);
    sqlite3_finalize(statement);
    sqlite3_close(db);
    free(profile);
}

static void test_blobs_are_little_endian(void **state) {
    const place *here = *state;
    static const unsigned char one[] = {0, 0, 0, 0, 0, 0, 0xf0, 0x3f}, quarter[] = {0, 0, 0x80, 0x3e}; /* IEEE 754 */
    lensprof_profile *profile = new_profile();
    sqlite3 *db;
    sqlite3_stmt *statement;
    fill_profile(profile);
    profile->response[0].kind = LENSPROF_RESPONSE_TABLE;
    profile->response[0].modes = 0;
    memset(profile->response[0].emor, 0, sizeof profile->response[0].emor);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    put_at(store, profile);
    lensprof_store_close(store);
    assert_int_equal(sqlite3_open(here->path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, "SELECT samples FROM responses", -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    assert_int_equal(sqlite3_column_bytes(statement, 0), 8 * LENSPROF_RESPONSE_SAMPLES);
    assert_memory_equal((const char *)sqlite3_column_blob(statement, 0) + 8 * 1023, one, 8);
    sqlite3_finalize(statement);
    assert_int_equal(sqlite3_prepare_v2(db, "SELECT attenuation FROM gain_grids", -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    assert_int_equal(sqlite3_column_bytes(statement, 0), 4 * 5 * 4);
    assert_memory_equal((const char *)sqlite3_column_blob(statement, 0) + 4 * 5, quarter, 4);
    sqlite3_finalize(statement);
    sqlite3_close(db);
    free(profile);
}

static void test_remove(void **state) {
    const place *here = *state;
    lensprof_profile *profile = new_profile(), *found = new_profile();
    lensprof_error error;
    int64_t left = 0;
    fill_profile(profile);
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    int64_t id = put_at(store, profile);
    assert_ok(lensprof_store_remove(store, id, &error));
    assert_string_equal(error.text, "");
    assert_int_equal(lensprof_store_remove(store, id, &error), LENSPROF_ERROR_NOT_FOUND);
    assert_non_null(strstr(error.text, "profiles.db: has no profile 1;"));
    assert_int_equal(lensprof_store_get(store, id, found, &error), LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(lensprof_store_remove(store, -5, NULL), LENSPROF_ERROR_NOT_FOUND);
    const char *sql =
        "SELECT (SELECT count(*) FROM responses) + (SELECT count(*) FROM emor_coefficients)"
        " + (SELECT count(*) FROM vignettings)";
    assert_int_equal(lp_store_number(store->db, sql, &left), SQLITE_OK);
    assert_int_equal(left, 0);
    lensprof_store_close(store);
    assert_integrity(here->path);
    free(profile);
    free(found);
}

static void test_put_refuses_what_is_not_a_profile(void **state) {
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    int64_t id = 77;
    uint32_t found = 9;
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    fill_profile(profile);
    profile->vignetting[0].k[0] = NAN;
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_NOT_FINITE);
    assert_non_null(strstr(error.text, "LENSPROF_ERROR_NOT_FINITE"));
    fill_profile(profile);
    profile->key.focal_mm = 0.0;
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_ARGUMENT);
    fill_profile(profile);
    profile->provenance.inlier_share = NAN;
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_ARGUMENT);
    fill_profile(profile);
    profile->response[0].emor[0] = -0.6; /* the table is that of -0.625 */
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_RESPONSE);
    fill_profile(profile);
    profile->response[0].kind = LENSPROF_RESPONSE_LINEAR;
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_RESPONSE);
    assert_int_equal(id, 77);
    assert_ok(lensprof_store_list(store, NULL, NULL, 0, &found, NULL));
    assert_int_equal(found, 0);
    lensprof_store_close(store);
    free(profile);
}

/* An unusable fit is stored only if the caller forces it, and is then marked as forced. */
static void test_put_refuses_what_is_not_usable(void **state) {
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    fill_profile(profile);
    profile->provenance.forced = 0;
    profile->provenance.not_usable = 1;
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    assert_int_equal(lensprof_store_put(store, profile, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "was not usable; nothing was stored; set provenance.forced"));
    assert_int_equal(count_at(store), 0);
    profile->provenance.forced = 1;
    const int64_t id = put_at(store, profile);
    assert_ok(lensprof_store_get(store, id, profile, NULL));
    assert_int_equal(profile->provenance.forced, 1);
    assert_int_equal(profile->provenance.not_usable, 0);
    put_at(store, profile); /* as stored in the database */
    lensprof_store_close(store);
    free(profile);
}

/* The largest id possible, in a row or in a removed row: not a full disk, and the caller's transaction survives. */
static void test_ids_are_used_up(void **state) {
    const place *here = *state;
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    lensprof_store *store, *other;
    fill_profile(profile);
    open_pair(here, "other.db", LENSPROF_STORE_CREATE, &store, &other);
    put_at(store, profile);
    run_sql(here->path,
            "UPDATE profiles SET id = 9223372036854775806; UPDATE sqlite_sequence SET seq = 9223372036854775806;"
            " UPDATE responses SET profile_id = 9223372036854775806;"
            " UPDATE emor_coefficients SET profile_id = 9223372036854775806;"
            " UPDATE vignettings SET profile_id = 9223372036854775806;"
            " UPDATE gain_grids SET profile_id = 9223372036854775806");
    assert_ok(lensprof_store_begin(store, NULL));
    assert_true(put_at(store, profile) == INT64_MAX);
    assert_int_equal(lensprof_store_put(store, profile, NULL, &error), LENSPROF_ERROR_FULL);
    assert_non_null(strstr(error.text, "profiles.db: no free ids"));
    assert_ok(lensprof_store_commit(store, NULL));
    assert_int_equal(count_at(store), 2);
    assert_ok(lensprof_store_remove(store, INT64_MAX, NULL));
    assert_int_equal(lensprof_store_put(store, profile, NULL, &error), LENSPROF_ERROR_FULL);
    assert_non_null(strstr(error.text, "no free ids"));
    assert_ok(lensprof_store_merge(other, store, NULL, NULL, NULL)); /* the next step in the text helps */
    assert_int_equal(put_at(other, profile), 2);
    close_pair(store, other);
    assert_integrity(here->path);
    free(profile);
}

static void test_wrong_arguments(void **state) {
    const place *here = *state;
    lensprof_profile *profile = new_profile();
    lensprof_store *store = NULL;
    lensprof_error error;
    int64_t id;
    uint32_t found;
    fill_profile(profile);
    assert_int_equal(lensprof_store_open(NULL, 0, &store, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_open("", 2, &store, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_open(here->path, 3, &store, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_open(here->path, 2, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_not_equal(error.text[0], 0);
    assert_null(store);
    assert_int_equal(access(here->path, F_OK), -1); /* no file was created */
    lensprof_store_close(NULL);
    store = store_at(here->path, LENSPROF_STORE_CREATE);
    assert_int_equal(lensprof_store_put(NULL, profile, &id, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_put(store, NULL, &id, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_find(store, NULL, profile, &id, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_find(store, &profile->key, NULL, &id, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_get(store, 1, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_list(store, NULL, NULL, 1, &found, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_list(store, NULL, NULL, 0, NULL, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_remove(NULL, 1, &error), LENSPROF_ERROR_ARGUMENT);
    profile->key.processing = 9;
    assert_int_equal(lensprof_store_find(store, &profile->key, profile, &id, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_list(store, &profile->key, NULL, 0, &found, &error), LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
    free(profile);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_every_field_round_trips),
        store_test(test_three_curves_round_trip),
        store_test(test_unknown_and_infinite_round_trip),
        store_test(test_negative_zero_becomes_zero),
        store_test(test_longest_texts_round_trip),
        store_test(test_numbers_can_be_queried),
        store_test(test_blobs_are_little_endian),
        store_test(test_remove),
        store_test(test_put_refuses_what_is_not_a_profile),
        store_test(test_put_refuses_what_is_not_usable),
        store_test(test_ids_are_used_up),
        store_test(test_wrong_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
