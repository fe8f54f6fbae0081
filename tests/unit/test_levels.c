/* Black and white level. */
#include "support.h"

#include <lensprof/apply.h>
#include <lensprof/fixed.h>

#include <core/blob.h>

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

static void profile_of_sensor(lensprof_profile *profile, lensprof_apply_options *options, uint32_t layout) {
    lensprof_profile_init(profile);
    profile->levels = sensor_of_12_bit();
    lensprof_apply_options_init(options);
    assert_ok(lensprof_apply_options_set_profile(options, profile));
    options->frame_width = 4000, options->frame_height = 3000;
    options->source_sample = options->target_sample = LENSPROF_SAMPLE_U16;
    options->source_layout = layout;
}

/* A row at (0, 0), in place, in single precision or in integers. */
static void correct(const lensprof_apply_options *options, uint16_t *samples, uint32_t width, int in_integers) {
    static uint64_t memory[1 << 10];
    const uint32_t row = width * lensprof_layout_samples(options->source_layout) * 2;
    const lensprof_target target = {samples, row, width, 1, LENSPROF_SAMPLE_U16, options->source_layout};
    const lensprof_fixed_plan *fixed;
    const lensprof_plan *plan;
    if (in_integers) {
        assert_ok(lensprof_fixed_plan_init(memory, sizeof memory, options, &fixed, NULL));
        assert_ok(lensprof_fixed_apply(fixed, NULL, &target, 0, 0));
    } else {
        assert_ok(lensprof_plan_init(memory, sizeof memory, options, &plan, NULL));
        assert_ok(lensprof_apply(plan, NULL, &target, 0, 0));
    }
}

/* The corner of a mosaic of 12 bit with black 256: black stays, light doubles, and nothing exceeds white. */
static void test_mosaic_of_12_bit(void **state) {
    (void)state;
    lensprof_profile profile;
    lensprof_apply_options options;
    profile_of_sensor(&profile, &options, LENSPROF_LAYOUT_RGGB);
    options.target.ev = 1.0;
    for (int in_integers = 0; in_integers < 2; in_integers++) {
        uint16_t samples[4] = {256, 1256, 3800, 200};
        correct(&options, samples, 4, in_integers);
        assert_int_equal(samples[0], 256);
        assert_int_equal(samples[1], 2256);
        assert_int_equal(samples[2], 4095);
        assert_int_equal(samples[3], 144); /* noise below black keeps its mean */
    }
}

/* A grey ramp up to beyond white, as a sensor sees it under a light of which green saturates first. Corrected, all of
 * it is grey, unless clipped highlights are taken as they are. */
static void test_a_clipped_ramp_stays_grey(void **state) {
    (void)state;
    lensprof_profile profile;
    lensprof_apply_options options;
    const double balance[3] = {0.5, 1.0, 0.6};
    profile_of_sensor(&profile, &options, LENSPROF_LAYOUT_RGB);
    options.input = options.output = LENSPROF_ENCODING_LINEAR;
    options.source.ev = 1.0;
    memcpy(options.source.white_balance, balance, sizeof balance);
    for (int in_integers = 0; in_integers < 2; in_integers++)
        for (uint32_t saturated = LENSPROF_SATURATED_NEUTRAL; saturated <= LENSPROF_SATURATED_AS_VALUE; saturated++) {
            uint16_t ramp[3 * 200];
            int most = 0;
            options.saturated = saturated;
            for (int i = 0; i < 200; i++)
                for (int c = 0; c < 3; c++)
                    ramp[3 * i + c] = (uint16_t)floor(fmin(256.0 + 40.0 * i * balance[c], 4095.0) + 0.5);
            correct(&options, ramp, 200, in_integers);
            for (int i = 0; i < 200; i++)
                for (int c = 0; c < 3; c += 2) {
                    const int cast = abs(ramp[3 * i + c] - ramp[3 * i + 1]);
                    if (cast > most) most = cast;
                }
            assert_int_equal(ramp[3 * 20 + 1], 256 + 400);
            if (saturated == LENSPROF_SATURATED_NEUTRAL)
                assert_true(most <= 1 && ramp[3 * 199] == 256 + 1920); /* half of white, in the units of red */
            else
                assert_true(most > 1000);
        }
}

/* White of encoded samples as light, under the same light: grey too, of all sample types and in both kinds of plans. */
static void test_encoded_white_becomes_grey_light(void **state) {
    (void)state;
    static uint64_t memory[1 << 16];
    lensprof_profile profile;
    lensprof_apply_options options;
    const double balance[3] = {0.5, 1.0, 0.6};
    profile_of_sensor(&profile, &options, LENSPROF_LAYOUT_RGB);
    profile.levels = (lensprof_levels){{0.05, 0.05, 0.05}, 0.0};
    assert_ok(lensprof_response_set_gamma(&profile.response[0], 2.0));
    options.output = LENSPROF_ENCODING_LINEAR;
    options.output_levels = NULL;
    options.source.ev = 1.0;
    memcpy(options.source.white_balance, balance, sizeof balance);
    for (uint32_t types = 0; types < 4; types++) {
        const uint16_t white[3] = {65535, 65535, 65535};
        uint16_t found[2][3] = {{0}};
        options.source_sample = types & 1, options.target_sample = types >> 1;
        const lensprof_image from = {white, 6, 1, 1, options.source_sample, LENSPROF_LAYOUT_RGB};
        lensprof_target to = {found[0], 6, 1, 1, options.target_sample, LENSPROF_LAYOUT_RGB};
        const lensprof_plan *plan;
        const lensprof_fixed_plan *fixed;
        assert_ok(lensprof_plan_init(memory, sizeof memory, &options, &plan, NULL));
        assert_ok(lensprof_apply(plan, &from, &to, 0, 0));
        to.data = found[1];
        assert_ok(lensprof_fixed_plan_init(memory, sizeof memory, &options, &fixed, NULL));
        assert_ok(lensprof_fixed_apply(fixed, &from, &to, 0, 0));
        for (int c = 0; c < 3 && options.target_sample == LENSPROF_SAMPLE_U16; c++)
            for (int kind = 0; kind < 2; kind++) assert_in_range(found[kind][c], 32767, 32768);
        if (options.target_sample == LENSPROF_SAMPLE_U16) continue;
        const uint8_t grey[3] = {128, 128, 128};
        for (int kind = 0; kind < 2; kind++) assert_memory_equal(found[kind], grey, sizeof grey);
    }
}

/* Blobs hold levels; the plan made from one equals that made from its profile. Levels of the options replace them. */
static void test_blobs_hold_levels(void **state) {
    (void)state;
    static uint8_t blob[4096];
    lensprof_profile profile, unpacked;
    lensprof_apply_options options;
    size_t bytes;
    for (int with_circle = 0; with_circle < 2; with_circle++) {
        profile_of_sensor(&profile, &options, LENSPROF_LAYOUT_GBRG);
        profile.levels.black[2] = 0.005;
        profile.vignetting[0].k[0] = -0.5;
        options.target.ev = 0.5;
        if (with_circle) profile.image_circle = (lensprof_image_circle){{0.01, 0.02}, 0.9};
        assert_ok(lensprof_profile_pack(&profile, 0, blob, sizeof blob, &bytes));
        assert_int_equal(blob[4], with_circle ? 4 : 3);
        lensprof_profile_init(&unpacked);
        assert_ok(lensprof_profile_unpack(blob, bytes, &unpacked));
        assert_memory_equal(&unpacked.levels, &profile.levels, sizeof profile.levels);
        assert_memory_equal(&unpacked.image_circle, &profile.image_circle, sizeof profile.image_circle);
        assert_ok(lensprof_apply_options_set_profile(&options, &profile));
        uint16_t wanted[60], found[60];
        for (int i = 0; i < 60; i++) wanted[i] = found[i] = (uint16_t)(70 * i);
        correct(&options, wanted, 60, 0);
        const size_t size = lensprof_plan_bytes(&options);
        options.response = NULL, options.vignetting = NULL, options.levels = options.output_levels = NULL;
        options.image_circle = NULL;
        options.blob = blob, options.blob_bytes = bytes;
        assert_int_equal(lensprof_plan_bytes(&options), size);
        correct(&options, found, 60, 0);
        assert_memory_equal(found, wanted, sizeof found);
        if (with_circle) continue;
        uint16_t samples[4] = {256, 1256, 3800, 200};
        options.target.ev = 1.0;
        unpacked.vignetting[0].k[0] = 0.0;
        assert_ok(lensprof_profile_pack(&unpacked, 0, blob, sizeof blob, &options.blob_bytes));
        correct(&options, samples, 4, 0);
        assert_int_equal(samples[1], 2256 - 72); /* blue, with a black of 328 */
        lensprof_levels of_caller = sensor_of_12_bit();
        options.levels = &of_caller; /* without black in the output */
        samples[0] = 1256;
        correct(&options, samples, 1, 1);
        assert_int_equal(samples[0], (uint16_t)floor(2.0 * 1000.0 / 3839.0 * 65535.0 + 0.5));
    }
    lensprof_profile_init_sized(&unpacked, offsetof(lensprof_profile, levels));
    assert_int_equal(lensprof_profile_unpack(blob, bytes, &unpacked), LENSPROF_ERROR_UNSUPPORTED);
}

/* Levels in a blob that no profile has. */
static void test_blobs_with_wrong_levels(void **state) {
    (void)state;
    static uint8_t blob[4096];
    const double wrong[][4] = {
        {0, 0, 0, 0}, {0.5, 0, 0, 0.5}, {0, 0, -0.6, 1}, {0, 0, 0, 1.01}, {(double)NAN, 0, 0, 1}};
    lensprof_profile profile;
    size_t bytes;
    lensprof_profile_init(&profile);
    profile.levels = sensor_of_12_bit();
    assert_ok(lensprof_profile_pack(&profile, 0, blob, sizeof blob, &bytes));
    const size_t at = LP_BLOB_FIXED + 3 * 8;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        for (int n = 0; n < 4; n++) { /* little-endian */
            uint64_t bits;
            memcpy(&bits, &wrong[i][n], sizeof bits);
            for (int k = 0; k < 8; k++) blob[at + 8 * (size_t)n + (size_t)k] = (uint8_t)(bits >> 8 * k);
        }
        const uint32_t crc = lp_crc32(blob, bytes - 4);
        for (int k = 0; k < 4; k++) blob[bytes - 4 + (size_t)k] = (uint8_t)(crc >> 8 * k);
        assert_int_equal(lensprof_profile_unpack(blob, bytes, &profile), LENSPROF_ERROR_CORRUPT);
    }
}

static void test_what_has_no_room_for_levels(void **state) {
    (void)state;
    lensprof_profile profile;
    lensprof_apply_options options;
    lensprof_profile_init(&profile);
    profile.levels = sensor_of_12_bit();
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
        cmocka_unit_test(test_a_clipped_ramp_stays_grey),
        cmocka_unit_test(test_encoded_white_becomes_grey_light),
        cmocka_unit_test(test_blobs_hold_levels),
        cmocka_unit_test(test_blobs_with_wrong_levels),
        cmocka_unit_test(test_what_has_no_room_for_levels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
