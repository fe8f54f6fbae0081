/* Black and white level. */
#include "support.h"

#include <lensprof/apply.h>
#include <lensprof/fixed.h>

static lensprof_levels sensor_of_12_bit(void) {
    return (lensprof_levels){{256.0 / 65535.0, 256.0 / 65535.0, 256.0 / 65535.0}, 4095.0 / 65535.0};
}

static void test_values_and_samples(void **state) {
    (void)state;
    lensprof_levels none = {{0.0, 0.0, 0.0}, 0.0};
    const lensprof_levels levels = {{0.1, 0.0, -0.05}, 0.9};
    assert_close(lensprof_levels_to_value(&none, 1, 0.37), 0.37, 0.0);
    assert_close(lensprof_levels_to_value(&levels, 0, 0.1), 0.0, 0.0);
    assert_close(lensprof_levels_to_value(&levels, 0, 0.9), 1.0, 1e-15);
    assert_close(lensprof_levels_to_value(&levels, 2, 0.425), 0.5, 1e-15);
    for (uint32_t c = 0; c < 3; c++)
        for (double sample = -0.2; sample < 1.3; sample += 0.01)
            assert_close(lensprof_levels_to_sample(&levels, c, lensprof_levels_to_value(&levels, c, sample)), sample,
                         1e-15);
    assert_close(lensprof_levels_to_value(&levels, 3, 0.2), 0.2, 0.0); /* alpha has no levels */
}

static void test_validation(void **state) {
    (void)state;
    lensprof_levels levels = {{0.0, 0.0, 0.0}, 0.0};
    assert_ok(lensprof_levels_validate(&levels));
    const double wrong[][4] = {{0.5, 0.0, 0.0, 0.5},   {0.0, 0.4995, 0.0, 0.5},      {0.0, 0.0, 0.0, 1.01},
                               {0.0, 0.0, -0.51, 0.5}, {(double)NAN, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.0, (double)NAN},
                               {0.0, 1.0, 0.0, 0.0},   {0.0, 0.0, 0.0, -0.1},        {(double)INFINITY, 0.0, 0.0, 1.0}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        for (int c = 0; c < 3; c++) levels.black[c] = wrong[i][c];
        levels.white = wrong[i][3];
        assert_int_equal(lensprof_levels_validate(&levels), LENSPROF_ERROR_ARGUMENT);
        lensprof_profile profile;
        lensprof_profile_init(&profile);
        assert_ok(lensprof_profile_validate(&profile));
        profile.levels = levels;
        assert_int_equal(lensprof_profile_validate(&profile), LENSPROF_ERROR_ARGUMENT);
    }
    assert_int_equal(lensprof_levels_validate(NULL), LENSPROF_ERROR_ARGUMENT);
}

/* The corner of a mosaic of 12 bit with black 256: black stays, light doubles, and nothing exceeds white. */
static void test_mosaic_of_12_bit(void **state) {
    (void)state;
    static uint64_t memory[1 << 10];
    lensprof_profile profile;
    lensprof_apply_options options;
    const lensprof_plan *plan;
    uint16_t samples[4] = {256, 1256, 3800, 200};
    const lensprof_target corner = {samples, 8, 4, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGGB};
    lensprof_profile_init(&profile);
    profile.levels = sensor_of_12_bit();
    lensprof_apply_options_init(&options);
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    options.frame_width = 4000, options.frame_height = 3000;
    options.source_sample = options.target_sample = LENSPROF_SAMPLE_U16;
    options.source_layout = LENSPROF_LAYOUT_RGGB;
    options.target.ev = 1.0;
    assert_ok(lensprof_plan_init(memory, sizeof memory, &options, &plan, NULL));
    assert_ok(lensprof_apply(plan, NULL, &corner, 0, 0));
    assert_int_equal(samples[0], 256);
    assert_int_equal(samples[1], 2256);
    assert_int_equal(samples[2], 4095);
    assert_int_equal(samples[3], 144); /* noise below black keeps its mean */
}

static void test_what_has_no_room_for_levels(void **state) {
    (void)state;
    static uint64_t memory[1 << 10];
    lensprof_profile profile;
    lensprof_apply_options options;
    lensprof_error error;
    const lensprof_fixed_plan *fixed;
    size_t bytes;
    lensprof_profile_init(&profile);
    profile.levels = sensor_of_12_bit();
    assert_int_equal(lensprof_profile_pack(&profile, 0, NULL, 0, &bytes), LENSPROF_ERROR_UNSUPPORTED);
    lensprof_apply_options_init(&options);
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    options.frame_width = options.frame_height = 100;
    assert_int_equal(lensprof_fixed_plan_init(memory, sizeof memory, &options, &fixed, &error),
                     LENSPROF_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.text, "levels"));
    lensprof_apply_options_init_sized(&options, offsetof(lensprof_apply_options, levels)); /* of an older program */
    assert_int_equal(lensprof_apply_options_set_profile(&options, &profile), LENSPROF_ERROR_UNSUPPORTED);
    lensprof_profile_init_sized(&profile, offsetof(lensprof_profile, levels));
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    assert_ok(lensprof_profile_validate(&profile));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_and_samples),
        cmocka_unit_test(test_validation),
        cmocka_unit_test(test_mosaic_of_12_bit),
        cmocka_unit_test(test_what_has_no_room_for_levels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
