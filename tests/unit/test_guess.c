/* Long rows of values are guessed, and for smooth responses the guesses are right. test_kernels.c compares bytes only
 * and would not notice wrong guesses. */
#include "support.h"

#include "guessed_row.h"

enum {
    LEAST_WIDTH = 512, /* rows at least this long are guessed (kernels/README.md) */
    MOST_WIDTH = 701
};

guess_count guess_counts;

/* Runs a kernel over a row of evenly spaced values, through the EMoR response and back. */
static guess_count count_of(lp_row_kernel *row, const lensprof_response *response, uint32_t width) {
    static float source[3 * MOST_WIDTH], target[3 * MOST_WIDTH];
    for (uint32_t i = 0; i < 3 * width; i++) source[i] = (float)(i * 2654435761u) / 4294967296.0f;
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    const lensprof_vignetting falloff = {{-0.3, 0.1, -0.05}, {0.0, 0.0}};
    options.response = response;
    options.vignetting = &falloff;
    options.frame_width = options.frame_height = MOST_WIDTH;
    options.source_layout = LENSPROF_LAYOUT_RGB;
    options.source_sample = options.target_sample = LENSPROF_SAMPLE_F32;
    options.input = options.output = LENSPROF_ENCODING_RESPONSE;
    const size_t bytes = lensprof_plan_bytes(&options);
    void *memory = malloc(bytes);
    const lensprof_plan *plan;
    assert_ok(lensprof_plan_init(memory, bytes, &options, &plan, NULL));
    const uint8_t *from[3] = {(const uint8_t *)source, NULL, NULL};
    uint8_t *to[3] = {(uint8_t *)target, NULL, NULL};
    guess_counts = (guess_count){0, 0};
    row(plan, from, to, 0, 100, width, NULL, 0);
    free(memory);
    return guess_counts;
}

static void check_guesses(lp_row_kernel *row) {
    const double coefficients[][2] = {{0.0, 0.0}, {0.3, 0.1}, {-0.3, 0.1}, {0.5, -0.1}};
    for (size_t i = 0; i < sizeof coefficients / sizeof *coefficients; i++) {
        lensprof_response response;
        lensprof_response_set_linear(&response);
        assert_ok(lensprof_response_set_emor(&response, coefficients[i], 2));
        assert_int_equal(count_of(row, &response, LEAST_WIDTH - 1).guessed, 0);
        for (uint32_t width = LEAST_WIDTH; width <= MOST_WIDTH; width += MOST_WIDTH - LEAST_WIDTH) {
            const guess_count count = count_of(row, &response, width);
            assert_int_equal(count.guessed, 3 * width); /* no strip gave up */
            if (count.lost > count.guessed / 10)
                fail_msg("response %zu: %u of %u values were not found", i, count.lost, count.guessed);
        }
    }
}

static void test_values_are_found_with_avx2(void **state) {
    (void)state;
    if (lp_row_best(8) != lp_row_avx2) skip(); /* this processor has no AVX2 */
    check_guesses(guessed_row_avx2);
}

static void test_values_are_found_with_avx512(void **state) {
    (void)state;
    if (lp_row_best(16) != lp_row_avx512) skip(); /* this processor has no AVX-512 */
    check_guesses(guessed_row_avx512);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_are_found_with_avx2),
        cmocka_unit_test(test_values_are_found_with_avx512),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
