/* Damaged and crafted databases: every call returns a status and never an invalid profile. Run it with the sanitizers
 * too, to detect reads outside of buffers. */
#include "store_fixture.h"

#ifndef ROUNDS
#define ROUNDS 400 /* mutations; the slow variant has more */
#endif

/* A database of three profiles: 1 with every field, 2 with three table curves, 3 with gamma; returns its bytes. */
static unsigned char *make_three(const place *here, size_t *size) {
    lensprof_profile *profile = new_profile();
    double values[LENSPROF_RESPONSE_SAMPLES];
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    fill_profile(profile);
    put_at(store, profile);
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) values[j] = sqrt(j / 1023.0);
    for (int c = 0; c < 3; c++) {
        assert_ok(lensprof_response_set_table(&profile->response[c], values, LENSPROF_RESPONSE_SAMPLES));
        profile->vignetting[c] = profile->vignetting[0];
    }
    profile->responses = profile->vignettings = 3;
    put_at(store, profile);
    lensprof_profile_init(profile);
    assert_ok(lensprof_response_set_gamma(&profile->response[0], 2.2));
    put_at(store, profile);
    lensprof_store_close(store);
    free(profile);
    return read_file(here->path, size);
}

/* The database of make_three after SQL that violates the constraints. */
static lensprof_store *crafted(const place *here, const char *sql) {
    size_t size;
    char text[1200];
    unlink(here->path);
    free(make_three(here, &size));
    snprintf(text, sizeof text, "PRAGMA ignore_check_constraints = ON; PRAGMA foreign_keys = OFF; %s", sql);
    run_sql(here->path, text);
    return store_at(here->path, LENSPROF_STORE_WRITE);
}

/* Profile 1 is refused with a text that names it and `named`, outputs stay, and profile 3 is still readable. */
static void assert_damaged(const place *here, const char *sql, const char *named, bool in_list) {
    lensprof_profile *profile = new_profile(), *before = new_profile();
    lensprof_store_row rows[3];
    lensprof_error error = {"", {0, 0, 0, 0}};
    uint32_t found = 77;
    lensprof_store *store = crafted(here, sql);
    scribble(profile);
    scribble(before);
    memset(rows, 0x55, sizeof rows);
    lensprof_status status = lensprof_store_get(store, 1, profile, &error);
    if (status != LENSPROF_ERROR_CORRUPT) fail_msg("%s: get gives %s", sql, lensprof_status_name(status));
    if (!strstr(error.text, "profiles.db: profile 1 is damaged (")) fail_msg("%s: %s", sql, error.text);
    if (!strstr(error.text, named)) fail_msg("%s: %s", sql, error.text);
    assert_memory_equal(profile, before, sizeof *profile);
    assert_ok(lensprof_store_get(store, 3, profile, NULL));
    status = lensprof_store_list(store, NULL, rows, 3, &found, &error);
    if (status != LENSPROF_OK || found != 3) fail_msg("%s: list gives %s", sql, lensprof_status_name(status));
    for (uint32_t i = 0; i < 3; i++) { /* the others are listed, and profile 1 by its id */
        assert_in_range(rows[i].id, 1, 3);
        if (rows[i].damaged != (in_list && rows[i].id == 1)) fail_msg("%s: row %d", sql, (int)rows[i].id);
        assert_ok(lensprof_profile_key_validate(&rows[i].key));
    }
    assert_ok(lensprof_store_remove(store, 1, NULL)); /* the next step in the text helps */
    assert_int_equal(count_at(store), 2);
    lensprof_store_close(store);
    free(profile);
    free(before);
}

static void test_impossible_keys_and_provenance(void **state) {
    static const char *const cases[][2] = {
        {"camera_maker = printf('%.64c', 'x')", "camera_maker"},
        {"camera_model = 'a' || char(0) || 'b'", "camera_model"},
        {"lens = printf('%.1000000c', 'x')", "lens"},
        {"lens = 'a' || char(10)", "LENSPROF_ERROR_ARGUMENT"},
        {"focal_mm = 0", "LENSPROF_ERROR_ARGUMENT"},
        {"focal_mm = -1", "focal_mm"}, /* LENSPROF_UNKNOWN is stored as NULL */
        {"focal_mm = 9e999", "LENSPROF_ERROR_ARGUMENT"},
        {"aperture = -9e999", "aperture"},
        {"color_temperature_k = -1", "color_temperature_k"},
        {"color_temperature_k = 0", "LENSPROF_ERROR_ARGUMENT"},
        {"color_temperature_k = 2e6", "LENSPROF_ERROR_ARGUMENT"},
        {"prior_id = 0", "prior_id"}, /* no prior is NULL */
        {"prior_id = -7", "prior_id"},
        {"forced = 2", "forced"},
        {"style = printf('%.64c', 'x')", "style"},
        {"style = char(10)", "LENSPROF_ERROR_ARGUMENT"},
        {"gamma_sigma = -1", "LENSPROF_ERROR_ARGUMENT"},
        {"gamma_sigma = 9e999", "gamma_sigma"},
        {"distance_m = -3", "distance_m"},
        {"processing = 'Raw'", "processing"},
        {"processing = ''", "processing"},
        {"method = printf('%.32c', 'x')", "method"},
        {"software = char(27)", "LENSPROF_ERROR_ARGUMENT"},
        {"source = printf('%.256c', 'x')", "source"},
        {"images = -1", "images"},
        {"pairs = 4294967296", "pairs"},
        {"heldout_rms = -1", "heldout_rms"},
        {"heldout_rms = 256", "LENSPROF_ERROR_ARGUMENT"},
        {"inlier_share = 1.5", "LENSPROF_ERROR_ARGUMENT"},
    };
    char sql[200];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(sql, sizeof sql, "UPDATE profiles SET %s WHERE id = 1", cases[i][0]);
        const char *named = strncmp(cases[i][1], "LENSPROF", 8) ? cases[i][1] : "";
        assert_damaged(*state, sql, named, true);
    }
}

static void test_impossible_curves(void **state) {
    static const char *const cases[][2] = {
        {"UPDATE profiles SET black_red = 0.99, white_level = 0.5 WHERE id = 1", "LENSPROF_ERROR_ARGUMENT"},
        {"UPDATE profiles SET black_green = -0.6 WHERE id = 1", "LENSPROF_ERROR_ARGUMENT"},
        {"UPDATE profiles SET white_level = 1.5 WHERE id = 1", "LENSPROF_ERROR_ARGUMENT"},
        {"UPDATE profiles SET circle_radius = NULL WHERE id = 1", "circle_radius"},
        {"UPDATE profiles SET circle_x = NULL WHERE id = 1", "circle_y"},
        {"UPDATE profiles SET circle_x = -1.5 WHERE id = 1", "LENSPROF_ERROR_ARGUMENT"},
        {"UPDATE profiles SET circle_radius = 9e999 WHERE id = 1", "circle_radius"},
        {"UPDATE profiles SET response_curves = 2 WHERE id = 1", "responses"},
        {"UPDATE profiles SET response_curves = 0 WHERE id = 1", "response_curves"},
        {"UPDATE profiles SET vignetting_curves = 3 WHERE id = 1", "count of vignettings"},
        {"UPDATE profiles SET vignetting_curves = 4294967297 WHERE id = 1", "vignetting_curves"},
        {"UPDATE profiles SET covariance_size = 11 WHERE id = 1", "covariance"},
        {"UPDATE profiles SET covariance_size = 0 WHERE id = 1", "covariance"},
        {"UPDATE profiles SET covariance_size = 37, covariance = zeroblob(10952) WHERE id = 1", "covariance_size"},
        {"UPDATE profiles SET covariance = NULL WHERE id = 1", "covariance"},
        {"UPDATE profiles SET covariance = zeroblob(799) WHERE id = 1", "covariance"},
        {"UPDATE profiles SET covariance = CAST(x'000000000000f07f' || zeroblob(792) AS BLOB) WHERE id = 1",
         "LENSPROF_ERROR_NOT_FINITE"},
        {"UPDATE responses SET kind = 'cubic' WHERE profile_id = 1", "kind"},
        {"UPDATE responses SET kind = 'gamma' WHERE profile_id = 1", "gamma"},
        {"UPDATE responses SET kind = 'table' WHERE profile_id = 1", "emor_modes"},
        {"UPDATE responses SET kind = 'table', emor_modes = NULL WHERE profile_id = 1", "samples"},
        {"UPDATE responses SET kind = 'linear' WHERE profile_id = 1", "emor_modes"},
        {"UPDATE responses SET gamma = 2.2 WHERE profile_id = 1", "gamma"},
        {"UPDATE responses SET kind = 'gamma', gamma = 0, emor_modes = NULL WHERE profile_id = 1", "response"},
        {"UPDATE responses SET kind = 'gamma', gamma = 9e999, emor_modes = NULL WHERE profile_id = 1", "gamma"},
        {"UPDATE responses SET emor_modes = 6 WHERE profile_id = 1", "count of emor_coefficients"},
        {"UPDATE responses SET emor_modes = 4 WHERE profile_id = 1", "count of emor_coefficients"},
        {"UPDATE responses SET emor_modes = 26 WHERE profile_id = 1", "emor_modes"},
        {"UPDATE responses SET curve = 1 WHERE profile_id = 1", "curve"},
        {"DELETE FROM responses WHERE profile_id = 1", "count of responses"},
        {"INSERT INTO responses VALUES (1, 1, 'linear', NULL, NULL, NULL)", "count of responses"},
        {"UPDATE emor_coefficients SET mode = 7 WHERE mode = 5", "mode"},
        {"UPDATE emor_coefficients SET coefficient = 9e999 WHERE mode = 5", "coefficient"},
        {"UPDATE emor_coefficients SET coefficient = 1e9 WHERE mode = 1", "response"}, /* decreases */
        {"DELETE FROM vignettings WHERE profile_id = 1", "count of vignettings"},
        {"UPDATE vignettings SET curve = 2 WHERE profile_id = 1", "curve"},
        {"UPDATE vignettings SET k1 = -9e999 WHERE profile_id = 1", "k1"},
        {"UPDATE vignettings SET k1 = -5 WHERE profile_id = 1", "LENSPROF_ERROR_VIGNETTING"},
        {"UPDATE vignettings SET center_y = 1.1 WHERE profile_id = 1", "LENSPROF_ERROR_VIGNETTING"},
        {"UPDATE profiles SET gain_grids = 0 WHERE id = 1", "count of gain_grids"},
        {"UPDATE profiles SET gain_grids = 2 WHERE id = 1", "gain_grids"},
        {"DELETE FROM gain_grids", "count of gain_grids"},
        {"UPDATE gain_grids SET grid_columns = 1", "grid_columns"},
        {"UPDATE gain_grids SET grid_columns = 33", "grid_columns"},
        {"UPDATE gain_grids SET grid_rows = 1", "grid_rows"},
        {"UPDATE gain_grids SET grid_rows = 4294967300", "grid_rows"},
        {"UPDATE gain_grids SET grid_rows = 5", "attenuation"},
        {"UPDATE gain_grids SET channels = 4", "channels"},
        {"UPDATE gain_grids SET channels = 3", "attenuation"},
        {"UPDATE gain_grids SET channels = 2, attenuation = CAST(attenuation || attenuation AS BLOB)",
         "LENSPROF_ERROR_ARGUMENT"},
        {"UPDATE gain_grids SET attenuation = zeroblob(80)", "LENSPROF_ERROR_VIGNETTING"},
        {"UPDATE gain_grids SET attenuation = CAST(x'0000c07f' || substr(attenuation, 5) AS BLOB)",
         "LENSPROF_ERROR_NOT_FINITE"},
        {"UPDATE gain_grids SET attenuation = zeroblob(1000000)", "attenuation"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) assert_damaged(*state, cases[i][0], cases[i][1], false);
}

static void test_impossible_tables(void **state) {
    static const char *const samples[] = {
        "zeroblob(8192)",
        "zeroblob(8191)",
        "zeroblob(8200)",
        "zeroblob(0)",
        "zeroblob(1000000)",
        "zeroblob(8) || x'000000000000f87f' || zeroblob(8168) || x'000000000000f03f'", /* NaN among zeros */
        "x'000000000000f03f' || zeroblob(8184)",                                       /* falls from 1 to 0 */
    };
    char sql[300];
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        snprintf(sql, sizeof sql,
                 "UPDATE responses SET kind = 'table', emor_modes = NULL, samples = CAST(%s AS BLOB)"
                 " WHERE profile_id = 1",
                 samples[i]);
        assert_damaged(*state, sql, i == 0 || i > 4 ? "response" : "samples", false);
    }
}

/* Without STRICT, a column can hold any type. */
static void test_wrong_types(void **state) {
    static const char *const cases[][3] = {
        {"profiles", "focal_mm", "'abc'"},
        {"profiles", "aperture", "x'00'"},
        {"profiles", "distance_m", "''"},
        {"profiles", "lens", "x'c3a9'"},
        {"profiles", "lens", "NULL"},
        {"profiles", "source", "x''"},
        {"profiles", "processing", "1"},
        {"profiles", "images", "1.5"},
        {"profiles", "pairs", "'-'"},
        {"profiles", "created_unix_s", "'x'"},
        {"profiles", "response_curves", "'one'"},
        {"profiles", "covariance", "printf('%.800c', 'x')"},
        {"responses", "kind", "2"},
        {"responses", "emor_modes", "x'05'"},
        {"responses", "samples", "1"},
        {"vignettings", "k2", "'x'"},
        {"emor_coefficients", "coefficient", "x'0000000000000000'"},
        {"gain_grids", "channels", "x'01'"},
        {"gain_grids", "attenuation", "printf('%.80c', 'x')"},
    };
    char sql[600];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        snprintf(sql, sizeof sql,
                 "PRAGMA writable_schema = ON; UPDATE sqlite_master SET sql = replace(replace(replace(sql,"
                 " ') STRICT, WITHOUT', ') WITHOUT'), ') STRICT', ')'), 'T NOT NULL', 'T');"
                 " PRAGMA writable_schema = RESET; UPDATE %s SET %s = %s WHERE %s = 1",
                 cases[i][0], cases[i][1], cases[i][2], i < 12 ? "id" : "profile_id");
        assert_damaged(*state, sql, cases[i][1], i < 10);
    }
}

static void assert_not_opened(const place *here, const char *sql) {
    lensprof_store *store = NULL;
    lensprof_error error;
    size_t size;
    unlink(here->path);
    free(make_three(here, &size));
    run_sql(here->path, sql);
    for (uint32_t mode = 0; mode < 3; mode++) {
        lensprof_status status = lensprof_store_open(here->path, mode, &store, &error);
        if (status != LENSPROF_ERROR_CORRUPT) fail_msg("%s: %s", sql, lensprof_status_name(status));
    }
    assert_null(store);
}

static void test_other_tables(void **state) {
    assert_not_opened(*state, "DROP TABLE vignettings");
    assert_not_opened(*state, "DROP TABLE gain_grids");
    assert_not_opened(*state, "ALTER TABLE emor_coefficients RENAME TO e");
    /* A view that never ends. */
    assert_not_opened(*state,
                      "ALTER TABLE profiles RENAME TO p; CREATE VIEW profiles AS WITH RECURSIVE n(id) AS"
                      " (SELECT 1 UNION ALL SELECT id + 1 FROM n) SELECT * FROM n");
}

static void test_missing_column(void **state) {
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    uint32_t found;
    lensprof_store *store = crafted(*state, "ALTER TABLE profiles RENAME COLUMN source TO origin");
    assert_int_equal(lensprof_store_get(store, 1, profile, &error), LENSPROF_ERROR_CORRUPT);
    assert_int_equal(lensprof_store_list(store, NULL, NULL, 0, &found, &error), LENSPROF_ERROR_CORRUPT);
    fill_profile(profile);
    assert_int_equal(lensprof_store_put(store, profile, &(int64_t){0}, &error), LENSPROF_ERROR_CORRUPT);
    assert_ok(lensprof_store_remove(store, 1, &error));
    lensprof_store_close(store);
    free(profile);
}

/* Triggers in the file do not run. */
static void test_triggers_are_ignored(void **state) {
    lensprof_profile *profile = new_profile();
    const char *sql = "CREATE TRIGGER t AFTER INSERT ON profiles BEGIN DELETE FROM profiles; END";
    lensprof_store *store = crafted(*state, sql);
    fill_profile(profile);
    int64_t id = put_at(store, profile);
    assert_int_equal(count_at(store), 4);
    assert_ok(lensprof_store_get(store, id, profile, NULL));
    lensprof_store_close(store);
    free(profile);
}

static void use_everything(lensprof_store *store) {
    static lensprof_profile found = {.struct_size = sizeof found}, asked = {.struct_size = sizeof asked};
    lensprof_lookup_options options;
    lensprof_lookup how = {.struct_size = sizeof how};
    lensprof_error error;
    lensprof_store_stats stats = {.struct_size = sizeof stats};
    uint32_t count;
    fill_profile(&asked);
    lensprof_lookup_options_init(&options);
    if (lensprof_store_lookup(store, &asked.key, &options, &found, &how, &error) == LENSPROF_OK)
        assert_ok(lensprof_profile_validate(&found));
    (void)!lensprof_store_check(store, NULL, NULL, NULL, &count, &error);
    (void)!lensprof_store_get_stats(store, &stats, &error);
    (void)!lensprof_store_list(store, NULL, NULL, 0, &count, &error);
    (void)!lensprof_store_put(store, &asked, NULL, &error);
    (void)!lensprof_store_remove(store, 2, &error);
}

/* Schemas that would run code, fail every statement or exhaust memory: no crash, no new file, no invalid profile. */
static void test_crafted_schemas(void **state) {
    static const char *const schemas[] = {
        "ALTER TABLE profiles RENAME TO p; CREATE VIEW profiles AS SELECT *, load_extension('/tmp/evil') AS e FROM p",
        "ALTER TABLE vignettings RENAME TO v; CREATE VIEW vignettings AS SELECT * FROM v",
        "CREATE TRIGGER t BEFORE INSERT ON profiles BEGIN SELECT RAISE(ABORT, 'no'); END",
        "CREATE TRIGGER t BEFORE DELETE ON profiles BEGIN SELECT RAISE(ROLLBACK, 'no'); END",
        "CREATE TRIGGER t AFTER INSERT ON vignettings BEGIN INSERT INTO vignettings SELECT * FROM vignettings; END",
        "ALTER TABLE profiles ADD COLUMN g TEXT GENERATED ALWAYS AS (printf('%.900000c', lens)) VIRTUAL",
        "ALTER TABLE vignettings ADD COLUMN g REAL GENERATED ALWAYS AS (abs(-9223372036854775807 - 1)) VIRTUAL",
        "CREATE INDEX i ON profiles (printf('%.900000c', lens)) WHERE id > 100",
        "UPDATE responses SET samples = zeroblob(3000000) WHERE profile_id = 1",
        "UPDATE profiles SET covariance = zeroblob(3000000), covariance_size = 36 WHERE id = 1",
        "UPDATE profiles SET lens = CAST(zeroblob(3000000) AS TEXT), lens_name = CAST(zeroblob(3000000) AS TEXT)",
        "UPDATE profiles SET created_unix_s = -9223372036854775807 - 1, images = 9223372036854775807",
        "CREATE TABLE sqlite_stat (a); CREATE VIRTUAL TABLE f USING fts5(a)",
        "UPDATE profiles SET unit = NULL, doubt = lens_name || 'x' WHERE id = 2",
    };
    const place *here = *state;
    for (size_t i = 0; i < sizeof schemas / sizeof *schemas; i++) {
        size_t size;
        char text[1200];
        sqlite3 *db;
        lensprof_store *store = NULL;
        unlink(here->path);
        free(make_three(here, &size));
        snprintf(text, sizeof text, "PRAGMA ignore_check_constraints = ON; PRAGMA foreign_keys = OFF; %s", schemas[i]);
        assert_int_equal(sqlite3_open(here->path, &db), SQLITE_OK);
        (void)sqlite3_exec(db, text, NULL, NULL, NULL); /* STRICT tables or this SQLite may refuse it */
        sqlite3_close(db);
        for (uint32_t mode = 0; mode < 2; mode++) {
            lensprof_error error = {"", {0, 0, 0, 0}};
            const lensprof_status status = lensprof_store_open(here->path, mode, &store, &error);
            if (status == LENSPROF_OK)
                use_everything(store);
            else if (status != LENSPROF_ERROR_CORRUPT)
                fail_msg("%s: %s", schemas[i], error.text);
            if (status == LENSPROF_OK) lensprof_store_close(store);
            if (i < 2) assert_int_equal(status, LENSPROF_ERROR_CORRUPT); /* views are not tables */
        }
    }
}

/* A constraint added by others fails the put, which has no effect. */
static void test_foreign_constraint(void **state) {
    lensprof_profile *profile = new_profile();
    lensprof_error error;
    int64_t id = 99;
    lensprof_store *store = crafted(*state, "CREATE UNIQUE INDEX u ON emor_coefficients (mode)");
    fill_profile(profile);
    assert_int_equal(lensprof_store_put(store, profile, &id, &error), LENSPROF_ERROR_CORRUPT);
    assert_int_equal(id, 99);
    run_sql(store->path, "BEGIN IMMEDIATE; COMMIT"); /* the lock is released */
    assert_int_equal(count_at(store), 3);
    lensprof_store_close(store);
    free(profile);
}

static void assert_sane(lensprof_status status, const lensprof_error *error, const char *what, int round) {
    bool fine = status == LENSPROF_OK ? error->text[0] == 0 : strstr(error->text, "profiles.db: ") != NULL;
    switch (status) {
    case LENSPROF_OK:
    case LENSPROF_ERROR_NOT_FOUND:
    case LENSPROF_ERROR_CORRUPT:
    case LENSPROF_ERROR_LAYOUT:
    case LENSPROF_ERROR_READ_ONLY:   /* a byte of the header makes it read-only */
    case LENSPROF_ERROR_FULL: break; /* a counter of ids at its maximum */
    default: fine = false;
    }
    if (!fine) fail_msg("round %d: %s: %s: %s", round, what, lensprof_status_name(status), error->text);
}

/* Every call on the file at `path`; delivered profiles must be valid. */
static lensprof_status use(const char *path, uint32_t mode, int round) {
    static lensprof_profile profile = {.struct_size = sizeof profile}, asked = {.struct_size = sizeof asked};
    lensprof_store *store = NULL;
    lensprof_store_row rows[4];
    lensprof_error error = {"", {0, 0, 0, 0}};
    int64_t id = 0;
    uint32_t found = 0;
    lensprof_status status = lensprof_store_open(path, mode, &store, &error);
    assert_sane(status, &error, "open", round);
    if (status != LENSPROF_OK) return status;
    (void)sqlite3_exec(store->db, "PRAGMA synchronous = OFF", NULL, NULL, NULL); /* for speed */
    assert_sane(status = lensprof_store_list(store, NULL, rows, 4, &found, &error), &error, "list", round);
    for (uint32_t i = 0; status == LENSPROF_OK && i < found && i < 4; i++)
        assert_ok(lensprof_profile_key_validate(&rows[i].key));
    for (id = 1; id <= 3; id++) {
        assert_sane(status = lensprof_store_get(store, id, &profile, &error), &error, "get", round);
        if (status == LENSPROF_OK) assert_ok(lensprof_profile_validate(&profile));
    }
    fill_profile(&asked);
    assert_sane(status = lensprof_store_find(store, &asked.key, &profile, &id, &error), &error, "find", round);
    if (status == LENSPROF_OK) assert_ok(lensprof_profile_validate(&profile));
    if (mode != LENSPROF_STORE_READ) {
        assert_sane(lensprof_store_put(store, &asked, &id, &error), &error, "put", round);
        assert_sane(lensprof_store_remove(store, 2, &error), &error, "remove", round);
    }
    lensprof_store_close(store);
    return LENSPROF_OK;
}

static void put_file(const place *here, const unsigned char *bytes, size_t size) {
    char path[200];
    static const char *const beside[] = {"-journal", "-wal", "-shm"};
    for (int i = 0; i < 3; i++) {
        snprintf(path, sizeof path, "%s%s", here->path, beside[i]);
        unlink(path);
    }
    write_file(here->path, bytes, size);
}

static void test_truncated(void **state) {
    const place *here = *state;
    size_t size, page = 4096;
    unsigned char *bytes = make_three(here, &size);
    assert_int_equal(size % page, 0);
    for (size_t cut = 1; cut < size; cut += cut % page < 110 ? 9 : 331) {
        put_file(here, bytes, cut);
        lensprof_status status = use(here->path, LENSPROF_STORE_READ, (int)cut);
        if (cut <= size - page) assert_int_equal(status, LENSPROF_ERROR_CORRUPT); /* a whole page is missing */
        assert_file(here->path, bytes, cut);
        use(here->path, LENSPROF_STORE_CREATE, (int)cut);
    }
    free(bytes);
}

static void test_random_damage(void **state) {
    const place *here = *state;
    size_t size, page = 4096;
    uint64_t seed = 42;
    unsigned char *good = make_three(here, &size), *bytes = malloc(size);
    for (int round = 0; round < ROUNDS; round++) {
        memcpy(bytes, good, size);
        int count = 1 + (int)(lp_random(&seed) * (round % 3 ? 4 : 40));
        for (int i = 0; i < count; i++) {
            size_t at = (size_t)(lp_random(&seed) * (double)size); /* anywhere, or where the structure is */
            if (round % 4 == 1) at = at / page * page + (at % page) % 64;
            if (round % 4 == 2) at = (size_t)(lp_random(&seed) * 112);
            bytes[at] = lp_random(&seed) < 0.5 ? (unsigned char)(lp_random(&seed) * 256)
                                               : bytes[at] ^ (unsigned char)(1 << (int)(lp_random(&seed) * 8));
        }
        if (round % 8 == 7) memcpy(bytes + page, good + page * 2, page); /* pages swapped */
        put_file(here, bytes, size);
        use(here->path, LENSPROF_STORE_WRITE, round);
        put_file(here, bytes, size);
        use(here->path, LENSPROF_STORE_READ, round);
    }
    free(good);
    free(bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_impossible_keys_and_provenance),
        store_test(test_impossible_curves),
        store_test(test_impossible_tables),
        store_test(test_wrong_types),
        store_test(test_other_tables),
        store_test(test_missing_column),
        store_test(test_triggers_are_ignored),
        store_test(test_foreign_constraint),
        store_test(test_crafted_schemas),
        store_test(test_truncated),
        store_test(test_random_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
