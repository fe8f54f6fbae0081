/* The image circle: which pixels lie in it, and that corrections leave the others alone. */
#include "support.h"

#include <lensprof/apply.h>
#include <lensprof/fixed.h>

#include "core/image_circle.h"

enum {
    WIDTH = 60,
    HEIGHT = 40
};

static void test_validation(void **state) {
    (void)state;
    static const lensprof_image_circle good[] = {{{0, 0}, 0}, {{0, 0}, 1}, {{-1, 1}, 4}, {{0.2, -0.1}, 1e-3}};
    const lensprof_image_circle wrong[] = {{{0.1, 0}, 0},         {{0, 0}, -0.5},        {{0, 0}, 4.001},
                                           {{1.001, 0}, 1},       {{0, -1.001}, 1},      {{(double)NAN, 0}, 1},
                                           {{0, 0}, (double)NAN}, {{0, (double)NAN}, 0}, {{0, 0}, (double)INFINITY}};
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        assert_ok(lensprof_image_circle_validate(&good[i]));
        profile.image_circle = good[i];
        assert_ok(lensprof_profile_validate(&profile));
    }
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(lensprof_image_circle_validate(&wrong[i]), LENSPROF_ERROR_ARGUMENT);
        profile.image_circle = wrong[i];
        assert_int_equal(lensprof_profile_validate(&profile), LENSPROF_ERROR_ARGUMENT);
    }
    assert_int_equal(lensprof_image_circle_validate(NULL), LENSPROF_ERROR_ARGUMENT);
}

/* The columns of a row are those of its pixels, one by one; those of a circle off the frame are empty. */
static void test_columns_are_those_of_the_pixels(void **state) {
    (void)state;
    uint64_t random = 1;
    for (int n = 0; n < 2000; n++) {
        const uint32_t width = 1 + (uint32_t)(90 * lp_random(&random)),
                       height = 1 + (uint32_t)(70 * lp_random(&random));
        lensprof_image_circle circle = {{2.0 * lp_random(&random) - 1.0, 2.0 * lp_random(&random) - 1.0},
                                        exp(4.0 * lp_random(&random) - 3.0)};
        if (n % 3 == 0) circle.center[0] = circle.center[1] = 0.0; /* ties */
        if (n % 9 == 0) circle.radius = 5.0 / lensprof_half_diagonal(width, height);
        for (uint32_t y = 0; y < height; y++) {
            uint32_t first, end;
            lp_image_circle_columns(&circle, width, height, y, &first, &end);
            assert_true(first <= end && end <= width);
            for (uint32_t x = 0; x < width; x++)
                assert_int_equal(lensprof_image_circle_contains(&circle, width, height, x, y), x >= first && x < end);
        }
    }
}

static void test_numbers(void **state) {
    (void)state;
    const lensprof_image_circle none = {{0, 0}, 0}, circle = {{0.1, 0}, 0.5};
    const double rho = lensprof_half_diagonal(WIDTH, HEIGHT), middle = 29.5 + 0.1 * rho;
    assert_true(lensprof_image_circle_contains(&none, WIDTH, HEIGHT, 1e6, 1e6));
    assert_true(lensprof_image_circle_contains(&circle, WIDTH, HEIGHT, middle + 0.499 * rho, 19.5));
    assert_false(lensprof_image_circle_contains(&circle, WIDTH, HEIGHT, middle + 0.501 * rho, 19.5));
    assert_true(lensprof_image_circle_contains(&circle, WIDTH, HEIGHT, middle - 0.499 * rho, 19.5));
    assert_false(lensprof_image_circle_contains(&circle, WIDTH, HEIGHT, middle, 19.5 - 0.501 * rho));
}

/* A falloff of two stops, and a grid; no blob holds the grid's samples differently. */
static void make_profile(lensprof_profile *profile) {
    lensprof_profile_init(profile);
    assert_ok(lensprof_response_set_gamma(&profile->response[0], 2.2));
    profile->vignetting[0] = (lensprof_vignetting){{-0.75, 0.0, 0.0}, {0.02, -0.03}};
    profile->grid.columns = profile->grid.rows = 2, profile->grid.channels = 1;
    for (int i = 0; i < 4; i++) profile->grid.attenuation[i] = 0.75f + 0.125f * (float)i;
    profile->image_circle = (lensprof_image_circle){{-0.05, 0.03}, 0.7};
}

static void test_falloff_ends_at_the_circle(void **state) {
    (void)state;
    lensprof_profile profile, whole;
    make_profile(&profile);
    whole = profile;
    whole.image_circle = (lensprof_image_circle){{0, 0}, 0};
    int outside = 0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double sigma = 0.0;
            const double m = lensprof_profile_falloff(&profile, 1, WIDTH, HEIGHT, x, y, &sigma);
            const int is_in = lensprof_image_circle_contains(&profile.image_circle, WIDTH, HEIGHT, x, y);
            assert_close(m, is_in ? lensprof_profile_falloff(&whole, 1, WIDTH, HEIGHT, x, y, NULL) : 1.0, 0.0);
            assert_close(m, lensprof_profile_falloff(&profile, 1, WIDTH, HEIGHT, x, y, NULL), 0.0);
            outside += !is_in;
        }
    assert_in_range(outside, WIDTH * HEIGHT / 10, WIDTH * HEIGHT / 2);
}

/* Corrects grey noise with the options. */
static void correct(const lensprof_apply_options *options, uint8_t *to) {
    static uint64_t memory[1 << 12];
    const lensprof_plan *plan;
    uint64_t random = 3;
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) to[i] = (uint8_t)(140 * lp_random(&random));
    const lensprof_target target = {to, 3 * WIDTH, WIDTH, HEIGHT, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    assert_ok(lensprof_plan_init(memory, sizeof memory, options, &plan, NULL));
    assert_ok(lensprof_apply(plan, NULL, &target, 0, 0));
}

/* Outside the bytes stay, inside they are those of a correction without a circle; to correct and to simulate. */
static void test_what_lies_outside_stays(void **state) {
    (void)state;
    static uint8_t with[3 * WIDTH * HEIGHT], without[sizeof with], same[sizeof with];
    lensprof_profile profile;
    lensprof_apply_options options;
    make_profile(&profile);
    lensprof_apply_options_init(&options);
    options.frame_width = WIDTH, options.frame_height = HEIGHT;
    for (uint32_t direction = 0; direction < 2; direction++) {
        int changed = 0;
        options.direction = direction;
        assert_ok(lensprof_apply_options_set_profile(&options, &profile));
        assert_ptr_equal(options.image_circle, &profile.image_circle);
        correct(&options, with);
        options.image_circle = NULL;
        correct(&options, without);
        options.strength = 0.0;
        correct(&options, same);
        options.strength = 1.0;
        for (uint32_t i = 0; i < sizeof with; i++) {
            const uint32_t x = i / 3 % WIDTH, y = i / 3 / WIDTH;
            const int is_in = lensprof_image_circle_contains(&profile.image_circle, WIDTH, HEIGHT, x, y);
            assert_int_equal(with[i], is_in ? without[i] : same[i]);
            changed += with[i] != without[i];
        }
        assert_true(changed > WIDTH * HEIGHT / 3);
    }
}

static void test_blobs_hold_it(void **state) {
    (void)state;
    static uint8_t blob[1 << 13], again[1 << 13], by_blob[3 * WIDTH * HEIGHT], by_profile[sizeof by_blob];
    lensprof_profile profile, unpacked;
    lensprof_apply_options options;
    size_t bytes, bytes_again, plain;
    make_profile(&profile);
    assert_ok(lensprof_profile_pack(&profile, 0, blob, sizeof blob, &bytes));
    assert_int_equal(blob[4], 2); /* the layout */
    lensprof_profile_init(&unpacked);
    assert_ok(lensprof_profile_unpack(blob, bytes, &unpacked));
    assert_memory_equal(&unpacked.image_circle, &profile.image_circle, sizeof profile.image_circle);
    assert_ok(lensprof_profile_pack(&unpacked, 0, again, sizeof again, &bytes_again));
    assert_int_equal(bytes, bytes_again);
    assert_memory_equal(blob, again, bytes);
    lensprof_apply_options_init(&options);
    options.frame_width = WIDTH, options.frame_height = HEIGHT;
    options.blob = blob, options.blob_bytes = bytes;
    correct(&options, by_blob);
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    correct(&options, by_profile);
    assert_memory_equal(by_blob, by_profile, sizeof by_blob);
    for (size_t i = 0; i < bytes; i++) { /* any bit that flips, any end that is missing */
        blob[i] ^= 4;
        assert_int_not_equal(lensprof_profile_unpack(blob, bytes, &unpacked), LENSPROF_OK);
        blob[i] ^= 4;
        assert_int_not_equal(lensprof_profile_unpack(blob, i, &unpacked), LENSPROF_OK);
    }
    profile.image_circle = (lensprof_image_circle){{0, 0}, 0};
    assert_ok(lensprof_profile_pack(&profile, 0, blob, sizeof blob, &plain));
    assert_int_equal(blob[4], 1);
    assert_int_equal(plain, bytes - 24);
}

static void test_what_has_no_room_for_it(void **state) {
    (void)state;
    static uint64_t memory[1 << 10];
    lensprof_profile profile;
    lensprof_apply_options options;
    lensprof_error error;
    const lensprof_fixed_plan *fixed;
    const lensprof_plan *plan;
    make_profile(&profile);
    profile.grid = (lensprof_gain_grid){0};
    lensprof_apply_options_init(&options);
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    options.frame_width = options.frame_height = 100;
    assert_int_equal(lensprof_fixed_plan_init(memory, sizeof memory, &options, &fixed, &error),
                     LENSPROF_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.text, "image circle"));
    profile.image_circle.radius = -1.0;
    assert_int_equal(lensprof_plan_init(memory, sizeof memory, &options, &plan, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "image_circle"));
    profile.image_circle.radius = 0.7;
    lensprof_apply_options_init_sized(&options, offsetof(lensprof_apply_options, image_circle)); /* an older program */
    assert_int_equal(lensprof_apply_options_set_profile(&options, &profile), LENSPROF_ERROR_UNSUPPORTED);
    lensprof_profile_init_sized(&profile, offsetof(lensprof_profile, image_circle));
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    assert_ok(lensprof_profile_validate(&profile));
    profile.vignetting[0].k[0] = -0.75;
    assert_true(lensprof_profile_falloff(&profile, 1, WIDTH, HEIGHT, 0, 0, NULL) < 1.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_validation),
        cmocka_unit_test(test_columns_are_those_of_the_pixels),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_falloff_ends_at_the_circle),
        cmocka_unit_test(test_what_lies_outside_stays),
        cmocka_unit_test(test_blobs_hold_it),
        cmocka_unit_test(test_what_has_no_room_for_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
