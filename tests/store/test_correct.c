/* lensprof_correct: one call for one picture, with a profile from a database. */
#include "store_fixture.h"

enum {
    WIDTH = 31,
    HEIGHT = 21
};

static lensprof_profile profile_of_lens(void) {
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    strcpy(profile.key.lens, "Acme 50mm f/1.8");
    profile.key.focal_mm = 50, profile.key.aperture = 2.8, profile.key.crop_factor = 1.5, profile.key.distance_m = 2;
    profile.vignetting[0] = (lensprof_vignetting){{-0.3, 0.05, -0.1}, {0.02, -0.01}};
    return profile;
}

/* Makes a picture of any sample type and layout; free its data. */
static lensprof_target picture(uint32_t sample, uint32_t layout) {
    const size_t row = (size_t)WIDTH * lensprof_layout_samples(layout);
    const size_t bytes = lensprof_sample_type_bytes(sample);
    lensprof_target image = {malloc(row * bytes * HEIGHT), (ptrdiff_t)(row * bytes), WIDTH, HEIGHT, sample, layout};
    for (size_t i = 0; i < row * HEIGHT; i++) {
        const unsigned value = (unsigned)(i * 37 % 200);
        if (sample == LENSPROF_SAMPLE_U8) ((uint8_t *)image.data)[i] = (uint8_t)value;
        if (sample == LENSPROF_SAMPLE_U16) ((uint16_t *)image.data)[i] = (uint16_t)(257 * value);
        if (sample == LENSPROF_SAMPLE_F32) ((float *)image.data)[i] = (float)value / 255.0f;
    }
    return image;
}

/* The same by the functions of apply.h. */
static void correct_in_parts(const lensprof_profile *profile, const lensprof_exposure *exposure,
                             const lensprof_target *image) {
    lensprof_apply_options options;
    const lensprof_plan *plan;
    lensprof_apply_options_init(&options);
    options.frame_width = WIDTH, options.frame_height = HEIGHT;
    options.source_sample = options.target_sample = image->sample, options.source_layout = image->layout;
    if (exposure) options.source = *exposure;
    assert_ok(lensprof_apply_options_set_profile(&options, profile));
    const size_t size = lensprof_plan_bytes(&options);
    void *memory = malloc(size);
    assert_ok(lensprof_plan_init(memory, size, &options, &plan, NULL));
    assert_ok(lensprof_apply(plan, NULL, image, 0, 0));
    free(memory);
}

static void test_as_in_parts(void **state) {
    (void)state;
    const struct {
        uint32_t sample, layout;
    } cases[] = {{LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB},
                 {LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_BGRA},
                 {LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY},
                 {LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGBA},
                 {LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGGB}};
    lensprof_profile profile = profile_of_lens();
    assert_ok(lensprof_response_set_gamma(&profile.response[0], 2.2));
    const lensprof_exposure exposure = {0.5, {1.1, 1.0, 0.9}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int with = 0; with < 2; with++) {
            const lensprof_target a = picture(cases[i].sample, cases[i].layout), b = picture(a.sample, a.layout);
            lensprof_error error;
            assert_ok(lensprof_correct(&profile, with ? &exposure : NULL, &a, &error));
            correct_in_parts(&profile, with ? &exposure : NULL, &b);
            assert_memory_equal(a.data, b.data, (size_t)a.row_bytes * HEIGHT);
            free(a.data), free(b.data);
        }
}

/* As in the example of store.h. */
static void test_from_a_database(void **state) {
    const place *here = *state;
    lensprof_profile profile = profile_of_lens();
    lensprof_store *store;
    lensprof_error error;
    assert_ok(lensprof_store_open(here->path, LENSPROF_STORE_CREATE, &store, &error));
    assert_ok(lensprof_store_put(store, &profile, NULL, &error));
    lensprof_store_close(store);

    const lensprof_target image = picture(LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    strcpy(key.lens, "Acme 50mm f/1.8"), key.focal_mm = 50, key.aperture = 2.8, key.crop_factor = 1.5;
    lensprof_profile_init(&profile);
    assert_ok(lensprof_store_open(here->path, LENSPROF_STORE_READ, &store, &error));
    assert_ok(lensprof_store_lookup(store, &key, NULL, &profile, NULL, &error));
    const int corner = ((uint8_t *)image.data)[0];
    assert_ok(lensprof_correct(&profile, NULL, &image, &error));
    assert_true(((uint8_t *)image.data)[0] > corner || corner == 0);
    strcpy(key.lens, "Another 85mm");
    assert_int_equal(lensprof_store_lookup(store, &key, NULL, &profile, NULL, &error), LENSPROF_ERROR_NOT_FOUND);
    assert_non_null(strstr(error.text, "no profile of a lens with this name"));
    lensprof_store_close(store);
    free(image.data);
}

/* Refused with a text, and the picture as it was. */
static void test_bad_input(void **state) {
    (void)state;
    const lensprof_profile profile = profile_of_lens();
    lensprof_profile raw = profile, steep = profile;
    raw.struct_size = 0;
    steep.vignetting[0].k[0] = -3;
    const lensprof_target image = picture(LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    lensprof_target none = image, empty = image, planes = image;
    none.data = NULL, empty.width = 0, planes.layout = LENSPROF_LAYOUT_PLANAR;
    const lensprof_exposure dark = {NAN, {1, 1, 1}};
    const struct {
        const lensprof_profile *profile;
        const lensprof_exposure *exposure;
        const lensprof_target *image;
        lensprof_status status;
    } cases[] = {
        {NULL, NULL, &image, LENSPROF_ERROR_ARGUMENT},         {&profile, NULL, NULL, LENSPROF_ERROR_ARGUMENT},
        {&profile, NULL, &none, LENSPROF_ERROR_ARGUMENT},      {&profile, NULL, &empty, LENSPROF_ERROR_SIZE},
        {&profile, NULL, &planes, LENSPROF_ERROR_UNSUPPORTED}, {&raw, NULL, &image, LENSPROF_ERROR_STRUCT_SIZE},
        {&steep, NULL, &image, LENSPROF_ERROR_VIGNETTING},     {&profile, &dark, &image, LENSPROF_ERROR_EXPOSURE}};
    const lensprof_target before = picture(LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lensprof_error error = {.text = ""};
        const lensprof_status status = lensprof_correct(cases[i].profile, cases[i].exposure, cases[i].image, &error);
        if (status != cases[i].status || !*error.text)
            fail_msg("case %zu: %s \"%s\"", i, lensprof_status_name(status), error.text);
        assert_memory_equal(image.data, before.data, (size_t)image.row_bytes * HEIGHT);
        assert_int_equal(lensprof_correct(cases[i].profile, cases[i].exposure, cases[i].image, NULL), status);
    }
    free(image.data), free(before.data);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_as_in_parts),
        cmocka_unit_test_setup_teardown(test_from_a_database, place_setup, place_teardown),
        cmocka_unit_test(test_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
