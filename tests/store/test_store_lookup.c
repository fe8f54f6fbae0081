/* Profiles for settings that are not stored: names, cameras, units, sensors, the falloff between settings, refusals. */
#include "lookup_fixture.h"

#include "store/names/names.h"

static void test_exact(void **state) {
    lensprof_store *store = zoom_store(*state);
    assert_ok(ask(store, zoom, 35, 2.8, INFINITY));
    assert_int_equal(how.exact, 1);
    assert_int_equal(how.rows, 1);
    assert_int_equal(how.id[0], 1 + 6 + 2);
    assert_close(how.name_score, 1.0, 0.0);
    assert_close(worst_error(35, 2.8), 0.0, 1e-12);
    const int64_t newer = put_falloff(store, zoom, 35, 2.8, INFINITY);
    assert_ok(ask(store, zoom, 35, 2.8, INFINITY));
    assert_int_equal(how.id[0], newer);
    lensprof_store_close(store);
}

/* Of rows with a colour temperature, those with the nearest one in mired count, if the key has one. */
static void test_nearest_light(void **state) {
    static const double kelvins[] = {2800, 4000, 6500};
    lensprof_lookup_options options;
    lensprof_profile *p = zoom_profile(zoom, 35, 2.8, INFINITY);
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    for (int i = 0; i < 3; i++) {
        p->key.color_temperature_k = kelvins[i];
        put_at(store, p);
    }
    lensprof_lookup_options_init(&options);
    const struct {
        double asked;
        int64_t id;
        bool noted;
    } cases[] = {{LENSPROF_UNKNOWN, 3, false}, {4000, 2, false}, {2800, 1, false}, {4900, 2, true}, {5200, 3, true}};
    for (int i = 0; i < 5; i++) { /* 5000 K is in the middle between 4000 and 6500 K: 200 mired between 250 and 154 */
        p->key.color_temperature_k = cases[i].asked;
        assert_ok(ask_with(store, &p->key, &options));
        assert_int_equal(how.id[0], cases[i].id);
        assert_int_equal(how.exact, 1);
        assert_int_equal(strstr(how.reason, "colour temperature") != NULL, cases[i].noted);
        assert_int_equal(how.reason_code[0] == LENSPROF_REASON_LOOKUP_OTHER_LIGHT, cases[i].noted);
    }
    p->key.color_temperature_k = LENSPROF_UNKNOWN; /* a row without a temperature matches all */
    assert_int_equal(put_at(store, p), 4);
    p->key.color_temperature_k = 2800;
    assert_ok(ask_with(store, &p->key, &options));
    assert_int_equal(how.id[0], 4);
    lensprof_store_close(store);
}

static void test_between_settings(void **state) {
    static const double asked[][2] = {{28, 2.4}, {42, 3.5}, {60, 6.3}, {24, 1.9}, {70, 7.1}, {30, 4.0}};
    lensprof_store *store = zoom_store(*state);
    for (int i = 0; i < 6; i++) {
        assert_ok(ask(store, zoom, asked[i][0], asked[i][1], INFINITY));
        assert_int_equal(how.exact, 0);
        assert_true(how.rows > 4 && how.distance > 0.0 && how.distance < 0.5 && how.sigma > 0.0);
        assert_true(worst_error(asked[i][0], asked[i][1]) < 0.02);
        double sum = 0.0;
        for (uint32_t n = 0; n < how.rows; n++) sum += how.weight[n];
        assert_close(sum, 1.0, 0.02);
        assert_string_equal(answered.provenance.method, "lookup");
        assert_close(answered.key.focal_mm, asked[i][0], 0.0);
        assert_ok(lensprof_profile_validate(&answered));
    }
    lensprof_store_close(store);
}

/* The answer is the same to the bit every time, and nothing is written. */
static void test_same_answer_and_nothing_written(void **state) {
    const place *here = *state;
    size_t before, after;
    lensprof_store_close(zoom_store(here));
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_READ);
    unsigned char *was = read_file(here->path, &before);
    assert_ok(ask(store, zoom, 28, 2.4, INFINITY));
    const lensprof_vignetting first = answered.vignetting[0];
    for (int i = 0; i < 5; i++) {
        assert_ok(ask(store, zoom, 28, 2.4, INFINITY));
        assert_memory_equal(&answered.vignetting[0], &first, sizeof first);
    }
    lensprof_store_close(store);
    unsigned char *is = read_file(here->path, &after);
    assert_int_equal(after, before);
    assert_memory_equal(is, was, before);
    free(was);
    free(is);
}

/* Leaves bytes on the stack that do not occur in an error. */
static __attribute__((noinline)) void soil_stack(void) {
    volatile unsigned char bytes[1 << 16];
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = 0x5A;
}

/* A refusal does not refer to an image or pair: the error has item NONE, whatever was in memory before. */
static void test_refusal_has_no_item(void **state) {
    lensprof_store *store = zoom_store(*state);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    static const char *const lenses[] = {zoom, "Another lens"};
    for (int i = 0; i < 2; i++) {
        const lensprof_profile_key key = zoom_profile(lenses[i], 200, 2.8, INFINITY)->key;
        lensprof_error error;
        memset(&error, 0x5A, sizeof error);
        soil_stack();
        assert_int_equal(lensprof_store_lookup(store, &key, &options, &answered, &how, &error),
                         LENSPROF_ERROR_NOT_FOUND);
        assert_int_equal(error.item.kind, LENSPROF_ITEM_NONE);
        assert_int_equal(error.item.index, 0);
    }
    lensprof_store_close(store);
}

static void test_refusals(void **state) {
    lensprof_store *store = zoom_store(*state);
    static const struct {
        double focal, aperture;
        const char *why;
        lensprof_reason code;
    } cases[] = {{24, 1.2, "aperture is beyond", LENSPROF_REASON_LOOKUP_APERTURE_BEYOND},
                 {24, 16, "aperture is beyond", LENSPROF_REASON_LOOKUP_APERTURE_BEYOND},
                 {14, 2.8, "focal length is beyond", LENSPROF_REASON_LOOKUP_FOCAL_BEYOND},
                 {200, 2.8, "focal length is beyond", LENSPROF_REASON_LOOKUP_FOCAL_BEYOND},
                 {LENSPROF_UNKNOWN, 2.8, "focal length is unknown", LENSPROF_REASON_LOOKUP_FOCAL_MISSING},
                 {35, LENSPROF_UNKNOWN, "aperture is unknown", LENSPROF_REASON_LOOKUP_APERTURE_MISSING}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scribble(&answered);
        assert_int_equal(ask(store, zoom, cases[i].focal, cases[i].aperture, INFINITY), LENSPROF_ERROR_NOT_FOUND);
        assert_non_null(strstr(how.reason, cases[i].why));
        assert_int_equal(how.reason_code[0], cases[i].code);
        assert_int_equal(how.reason_code[1], LENSPROF_REASON_NONE);
        assert_int_equal(((unsigned char *)&answered)[7], 0x5A);
    }
    assert_int_equal(ask(store, "Another lens", 35, 2.8, INFINITY), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_NO_LENS, "no profile of a lens with this name"));
    assert_int_equal(ask(store, zoom, 35, 2.8, 0.1), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_TOO_FAR, "too far"));
    lensprof_store_close(store);
}

static void test_names(void **state) {
    lensprof_store *store = zoom_store(*state);
    put_falloff(store, "Canon EF 85mm f/1.8 USM", 85, 1.8, INFINITY);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    static const struct {
        const char *lens, *maker;
        double score;
    } cases[] = {{"Canon EF 85mm f/1.8 USM", "", 1.0},      {" canon ef 85MM F/1.8 usm ", "", 1.0},
                 {"Canon EF85mm F1.8 USM", "", 0.9},        {"EF85mm f/1.8 USM", "Canon", 0.8},
                 {"EF85mm f/1.8 USM", "CANON INC.", 0.8},   {"EF85mm f/1.8 USM", "NIKON CORPORATION", 0.0},
                 {"Canon EF 85mm f/1.2 USM", "Canon", 0.0}, {"", "Canon", 0.0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lensprof_profile_key key = zoom_profile(cases[i].lens, 85, 1.8, INFINITY)->key;
        snprintf(key.camera_maker, sizeof key.camera_maker, "%s", cases[i].maker);
        const lensprof_status status = ask_with(store, &key, &options);
        assert_int_equal(status, cases[i].score > 0.0 ? LENSPROF_OK : LENSPROF_ERROR_NOT_FOUND);
        if (status == LENSPROF_OK) assert_close(how.name_score, cases[i].score, 1e-12);
    }
    lensprof_store_close(store);
}

/* A camera's own profiles come before the lens's, a unit's before the model's; then the smallest sensor that is large
 * enough. */
static void test_which_rows(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    double k[4] = {-0.5, -0.4, -0.3, -0.2};
    int64_t id[4];
    for (int i = 0; i < 4; i++) {
        lensprof_profile *p = zoom_profile("Lens", 50, 2.0, INFINITY);
        p->vignetting[0].k[0] = k[i];
        p->key.crop_factor = i == 1 ? 1.5 : 1.0;
        if (i >= 2) snprintf(p->key.camera_model, sizeof p->key.camera_model, "Body");
        if (i == 3) snprintf(p->key.unit, sizeof p->key.unit, "12345");
        id[i] = put_at(store, p);
    }
    lensprof_profile_key key = zoom_profile("Lens", 50, 2.0, INFINITY)->key;
    assert_ok(ask_with(store, &key, &options));
    snprintf(key.camera_model, sizeof key.camera_model, "body");
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.id[0], id[2]);
    snprintf(key.unit, sizeof key.unit, "12345");
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.id[0], id[3]);
    snprintf(key.camera_model, sizeof key.camera_model, "Another body");
    *key.unit = 0;
    key.crop_factor = 1.5;
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.id[0], id[1]);
    key.crop_factor = 1.2; /* on a full frame: r = 1 is at 1 / 1.2 of it */
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.id[0], id[0]);
    assert_close(answered.vignetting[0].k[0], k[0] / (1.2 * 1.2), 1e-3);
    key.crop_factor = 0.7;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_SMALLER_SENSOR, "smaller sensors"));
    lensprof_store_close(store);
}

/* Beyond the last focal length, the aperture has the same effect as at it. */
static void test_aperture_beyond_the_last_focal_length(void **state) {
    const place *here = *state;
    lensprof_store *store = zoom_store(here);
    double corner[3];
    const double apertures[3] = {1.8, 2.8, 8.0};
    for (int i = 0; i < 3; i++) {
        const double *k = answered.vignetting[0].k;
        assert_ok(ask(store, zoom, 71.0, apertures[i], INFINITY));
        corner[i] = 1.0 + k[0] + k[1] + k[2];
        assert_ok(ask(store, zoom, 70.0, apertures[i], INFINITY));
        assert_close(corner[i], 1.0 + k[0] + k[1] + k[2], 0.01);
    }
    assert_true(corner[0] < corner[1] - 0.05 && corner[1] < corner[2] - 0.05);
    lensprof_store_close(store);
}

/* An unknown sensor is taken as the smallest measured one, so that the falloff is not overcorrected. Curves of
 * different sensors are not mixed; a crop factor that EXIF rounds counts as the same sensor. */
static void test_unknown_sensor(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    for (int a = 0; a < 4; a++)
        for (int small = 0; small < 2; small++) {
            lensprof_profile *p = zoom_profile("Lens", 50, 2.0 * (1 << a), INFINITY);
            p->key.crop_factor = small ? 1.5 : 1.0;
            p->vignetting[0].k[0] = (small ? -0.2 : -0.5) / (1 << a);
            put_at(store, p);
        }
    lensprof_profile_key key = zoom_profile("Lens", 50, 2.8, INFINITY)->key;
    key.crop_factor = LENSPROF_UNKNOWN;
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.rows, 4);
    assert_true(answered.vignetting[0].k[0] > -0.2);
    assert_true(how.sigma < 0.1);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_SMALLEST_SENSOR, "the sensor size is unknown"));
    key.crop_factor = 1.51;
    key.aperture = 2.0;
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(how.exact, 1);
    lensprof_store_close(store);
}

/* A reason mentions profiles that exist but were not asked for. */
static void test_left_out_is_said(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    put_falloff(store, "Lens 50mm", 50, 2.0, INFINITY);
    lensprof_profile *p = zoom_profile("Lens 35mm", 35, 2.0, INFINITY);
    snprintf(p->provenance.doubt, sizeof p->provenance.doubt, "odd");
    put_at(store, p);
    lensprof_profile_key key = zoom_profile("Lens 50mm", 50, 2.0, INFINITY)->key;
    key.processing = LENSPROF_PROCESSING_CORRECTED;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_CORRECTED, "the camera corrects the falloff"));
    p = zoom_profile("Lens 28mm", 28, 2.0, INFINITY);
    p->key.processing = LENSPROF_PROCESSING_CORRECTED;
    put_at(store, p);
    assert_int_equal(ask(store, "Lens 28mm", 28, 2.0, INFINITY), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_OTHER_PROCESSING, "whose falloff the camera corrected"));
    assert_int_equal(ask(store, "Lens 35mm", 35, 2.0, INFINITY), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_DOUBTFUL, "doubtful"));
    assert_int_equal(ask(store, "Lens 85mm", 85, 2.0, INFINITY), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_NO_LENS, "with this name"));
    lensprof_store_close(store);
}

/* A lens known at one distance only: that profile is the answer, and the error is typical of lenses known at
 * several. */
static void test_lone_distance(void **state) {
    lensprof_store *store = zoom_store(*state);
    assert_ok(ask(store, zoom, 28, 2.4, INFINITY));
    const double k = answered.vignetting[0].k[0], sigma = how.falloff_sigma;
    assert_close(how.distance_sigma, 0.0, 0.0);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    const lensprof_profile_key key = zoom_profile(zoom, 28, 2.4, LENSPROF_UNKNOWN)->key;
    for (uint32_t rule = LENSPROF_DISTANCE_USUAL; rule <= LENSPROF_DISTANCE_FARTHEST; rule++) {
        options.distance_rule = rule;
        assert_ok(ask_with(store, &key, &options));
        assert_close(answered.vignetting[0].k[0], k, 0.0);
        assert_close(how.falloff_sigma, sigma, 0.0);
        assert_close(how.distance_sigma, 0.007, 0.0);
    }
    lensprof_store_close(store);
}

/* Without a distance, the correction is conservative. */
static void test_unknown_distance(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    static const double distance[3] = {0.5, 2.0, INFINITY}, k[3] = {-0.3, -0.5, -0.4};
    for (int i = 0; i < 3; i++) {
        lensprof_profile *p = zoom_profile("Lens", 50, 2.0, distance[i]);
        p->vignetting[0].k[0] = k[i];
        put_at(store, p);
    }
    lensprof_profile_key key = zoom_profile("Lens", 50, 2.0, LENSPROF_UNKNOWN)->key;
    assert_ok(ask_with(store, &key, &options)); /* most photographs are taken at a distance of some metres or more */
    assert_true(answered.vignetting[0].k[0] > -0.48 && answered.vignetting[0].k[0] < -0.40);
    assert_true(how.distance_sigma > 0.015 && how.distance_sigma < 0.06);
    assert_true(how.sigma >= sqrt(how.distance_sigma * how.distance_sigma + how.falloff_sigma * how.falloff_sigma));
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_USUAL_DISTANCE, "usual distances"));
    options.distance_rule = LENSPROF_DISTANCE_WEAKEST;
    assert_ok(ask_with(store, &key, &options));
    assert_true(how.distance_sigma > 0.1); /* the weakest falloff undercorrects */
    assert_true(answered.vignetting[0].k[0] > -0.32 && answered.vignetting[0].k[0] < -0.28);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_WEAKEST_DISTANCE, "weakest"));
    options.distance_rule = LENSPROF_DISTANCE_FARTHEST;
    assert_ok(ask_with(store, &key, &options));
    assert_close(answered.vignetting[0].k[0], -0.4, 0.02);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_FARTHEST_DISTANCE, "farthest"));
    lensprof_store_close(store);
}

static void test_doubt_and_processing(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    lensprof_profile *p = zoom_profile("Lens", 50, 2.0, INFINITY);
    snprintf(p->provenance.doubt, sizeof p->provenance.doubt, "start values of a fit that failed");
    put_at(store, p);
    lensprof_profile_key key = zoom_profile("Lens", 50, 2.0, INFINITY)->key;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_NOT_FOUND);
    options.with_doubt = 1;
    assert_ok(ask_with(store, &key, &options));
    assert_string_equal(answered.provenance.doubt, "start values of a fit that failed");
    key.processing = LENSPROF_PROCESSING_CORRECTED;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_NOT_FOUND);
    options.any_processing = 1;
    assert_ok(ask_with(store, &key, &options));
    assert_int_equal(answered.key.processing, LENSPROF_PROCESSING_RAW);
    lensprof_store_close(store);
}

/* Values that no valid profile has, written by another program. */
static void test_damaged_rows(void **state) {
    static const char *const damages[] = {"profiles SET aperture = -2.0", "profiles SET focal_mm = 0.0",
                                          "vignettings SET k1 = 9e999", "profiles SET camera_model = char(7)"};
    const place *here = *state;
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        char sql[120];
        lensprof_store *store = zoom_store(here);
        snprintf(sql, sizeof sql, "PRAGMA ignore_check_constraints = ON; UPDATE %s", damages[i]);
        run_sql(here->path, sql);
        scribble(&answered);
        assert_int_equal(ask(store, zoom, 28, 2.4, INFINITY), LENSPROF_ERROR_CORRUPT);
        assert_int_equal(((unsigned char *)&answered)[7], 0x5A);
        lensprof_store_close(store);
        unlink(here->path);
    }
}

static void test_transactions(void **state) {
    const place *here = *state;
    lensprof_store *store = store_at(here->path, LENSPROF_STORE_CREATE);
    lensprof_error error;
    uint32_t found = 9;
    assert_int_equal(lensprof_store_commit(store, &error), LENSPROF_ERROR_ARGUMENT);
    assert_ok(lensprof_store_begin(store, &error));
    assert_int_equal(lensprof_store_begin(store, &error), LENSPROF_ERROR_ARGUMENT);
    put_falloff(store, zoom, 24, 2.0, INFINITY);
    assert_int_equal(lensprof_store_remove(store, 77, &error), LENSPROF_ERROR_NOT_FOUND); /* removes nothing else */
    put_falloff(store, zoom, 35, 2.0, INFINITY);
    assert_ok(lensprof_store_list(store, NULL, NULL, 0, &found, &error));
    assert_int_equal(found, 2);
    lensprof_store *other = store_at(here->path, LENSPROF_STORE_READ);
    assert_ok(lensprof_store_list(other, NULL, NULL, 0, &found, &error));
    assert_int_equal(found, 0);
    lensprof_store_rollback(store);
    assert_ok(lensprof_store_list(store, NULL, NULL, 0, &found, &error));
    assert_int_equal(found, 0);
    assert_ok(lensprof_store_begin(store, &error));
    put_falloff(store, zoom, 24, 2.0, INFINITY);
    assert_ok(lensprof_store_commit(store, &error));
    assert_ok(lensprof_store_list(other, NULL, NULL, 0, &found, &error));
    assert_int_equal(found, 1);
    lensprof_store_close(other);
    lensprof_store_close(store);
    assert_integrity(here->path);
}

static void test_arguments(void **state) {
    lensprof_store *store = zoom_store(*state);
    lensprof_lookup_options options;
    lensprof_lookup_options_init(&options);
    lensprof_profile_key key = zoom_profile(zoom, 35, 2.8, INFINITY)->key;
    assert_int_equal(lensprof_store_lookup(NULL, &key, &options, &answered, &how, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_lookup(store, NULL, &options, &answered, &how, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_store_lookup(store, &key, &options, NULL, &how, NULL), LENSPROF_ERROR_ARGUMENT);
    options.distance_rule = 3;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_ARGUMENT);
    lensprof_lookup_options_init(&options);
    options.force_falloff = 2;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_ARGUMENT);
    lensprof_lookup_options_init(&options);
    options.struct_size = 1;
    lensprof_error error;
    assert_int_equal(lensprof_store_lookup(store, &key, &options, &answered, &how, &error), LENSPROF_ERROR_STRUCT_SIZE);
    assert_non_null(strstr(error.text, "lensprof_lookup_options: struct_size"));
    lensprof_lookup_options_init(&options);
    key.focal_mm = NAN;
    assert_int_equal(ask_with(store, &key, &options), LENSPROF_ERROR_ARGUMENT);
    lensprof_store_close(store);
}

/* A corner of the range without rows nearby: if one setting is outside, it is predicted; if both are, it is not. */
static void test_outside_both_ranges(void **state) {
    static const double focals[] = {24, 28, 35}, apertures[] = {2.8, 4.0, 5.6};
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    for (int f = 0; f < 3; f++)
        for (int a = 0; a < 3; a++) put_falloff(store, zoom, focals[f], apertures[a], INFINITY);
    assert_ok(ask(store, zoom, 24.0001, 2.8, INFINITY));
    const double inside = how.falloff_sigma;
    assert_ok(ask(store, zoom, 23.9999, 2.8, INFINITY));
    assert_true(how.falloff_sigma > 1.8 * inside); /* only the side of 24 mm has changed */
    assert_ok(ask(store, zoom, 22, 2.8, INFINITY));
    assert_ok(ask(store, zoom, 24, 2.5, INFINITY));
    assert_ok(ask(store, zoom, 23.5, 2.5, INFINITY)); /* another rounding of 24 mm */
    const double corners[4][2] = {{22, 2.5}, {39, 2.5}, {22, 6.3}, {39, 6.3}};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(ask(store, zoom, corners[i][0], corners[i][1], INFINITY), LENSPROF_ERROR_NOT_FOUND);
        assert_int_equal(how.reason_code[0], LENSPROF_REASON_LOOKUP_FOCAL_BEYOND);
        assert_int_equal(how.reason_code[1], LENSPROF_REASON_LOOKUP_APERTURE_BEYOND);
        assert_non_null(strstr(how.reason, "24 to 35 mm, f/2.8 to f/5.6"));
    }
    lensprof_store_close(store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        store_test(test_outside_both_ranges),
        store_test(test_exact),
        store_test(test_nearest_light),
        store_test(test_between_settings),
        store_test(test_same_answer_and_nothing_written),
        store_test(test_refusals),
        store_test(test_refusal_has_no_item),
        store_test(test_names),
        store_test(test_which_rows),
        store_test(test_aperture_beyond_the_last_focal_length),
        store_test(test_unknown_sensor),
        store_test(test_left_out_is_said),
        store_test(test_unknown_distance),
        store_test(test_lone_distance),
        store_test(test_doubt_and_processing),
        store_test(test_damaged_rows),
        store_test(test_transactions),
        store_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
