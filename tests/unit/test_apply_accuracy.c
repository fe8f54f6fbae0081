/* Apply compared with a reference in double precision over random profiles. 8 bit: within one level, and nearly always
 * identical. 16 bit: within one level. Float: within four units in the last place if both sides are linear, and within
 * a twentieth of a 16 bit level through responses and with levels. */
#include "unit/random_model.h"

enum {
    PROFILES = 400,
    W = MODEL_WIDTH,
    H = MODEL_HEIGHT,
    PIXELS = 900
};

/* Change of a result by the rounding of a sample near 1 and of black to single precision. */
static double reach_of_rounding(const model *m, double value, uint32_t c, uint32_t x, uint32_t y) {
    return fabs(reference(m, value + 6e-8, c, x, y) - reference(m, value - 6e-8, c, x, y));
}

/* Difference from the reference for pixels of a few rows: the largest, and the share of identical samples. */
static double worst_error(const model *m, uint32_t sample, uint64_t *random, double *same) {
    static union {
        uint8_t u8[3 * PIXELS];
        uint16_t u16[3 * PIXELS];
        float f32[3 * PIXELS];
    } in, out;
    const double unit = sample == LENSPROF_SAMPLE_U8 ? 255.0 : sample == LENSPROF_SAMPLE_U16 ? 65535.0 : 1.0;
    const lensprof_plan *plan;
    double worst = 0.0;
    void *memory = malloc(lensprof_plan_bytes(&m->options));
    assert_ok(lensprof_plan_init(memory, lensprof_plan_bytes(&m->options), &m->options, &plan, NULL));
    for (uint32_t i = 0; i < 3 * PIXELS; i++) {
        double value = lp_random(random);
        if (sample == LENSPROF_SAMPLE_U8)
            in.u8[i] = (uint8_t)(256.0 * value);
        else if (sample == LENSPROF_SAMPLE_U16)
            in.u16[i] = (uint16_t)(65536.0 * value);
        else
            in.f32[i] = (float)value;
    }
    const uint32_t x0 = (uint32_t)((W - PIXELS) * lp_random(random)), y = (uint32_t)(H * lp_random(random));
    const lensprof_image from = {&in, 0, PIXELS, 1, sample, LENSPROF_LAYOUT_RGB};
    const lensprof_target to = {&out, 0, PIXELS, 1, sample, LENSPROF_LAYOUT_RGB};
    assert_ok(lensprof_apply(plan, &from, &to, x0, y));
    for (uint32_t i = 0; i < 3 * PIXELS; i++) {
        double value = sample == LENSPROF_SAMPLE_U8    ? in.u8[i]
                       : sample == LENSPROF_SAMPLE_U16 ? in.u16[i]
                                                       : (double)in.f32[i];
        double wanted = reference(m, value / unit, i % 3, x0 + i / 3, y), error;
        if (sample == LENSPROF_SAMPLE_F32) {
            float nearest = (float)wanted;
            const double last_place = (double)nextafterf(nearest, 1e30f) - (double)nearest;
            const int is_linear = m->options.input == LENSPROF_ENCODING_LINEAR
                                  && m->options.output == LENSPROF_ENCODING_LINEAR && !has_levels(m);
            error = fabs((double)out.f32[i] - wanted) / (is_linear ? last_place : 1.0 / 65535.0);
            if (has_levels(m)) /* a difference of single numbers, which a steep curve enlarges near black */
                error = fmax(0.0, error - 65535.0 * reach_of_rounding(m, value, i % 3, x0 + i / 3, y));
        } else {
            wanted = floor(unit * fmin(fmax(wanted, 0.0), white_of_output(m)) + 0.5);
            error = fabs((sample == LENSPROF_SAMPLE_U8 ? out.u8[i] : out.u16[i]) - wanted);
        }
        *same += error == 0.0;
        worst = fmax(worst, error);
    }
    free(memory);
    return worst;
}

/* Sets the samples and encodings of a model. */
typedef void (*encoder)(model *m, uint64_t *random);

static void as_drawn(model *m, uint64_t *random) {
    m->options.input = lp_random(random) < 0.3;
    m->options.output = lp_random(random) < 0.3;
}

static void with_levels(model *m, uint64_t *random) {
    as_drawn(m, random);
    while (!has_levels(m)) random_levels_of_model(m, random);
}

static void linear(model *m, uint64_t *random) {
    (void)random;
    m->options.input = m->options.output = LENSPROF_ENCODING_LINEAR;
}

static void through_responses(model *m, uint64_t *random) {
    (void)m;
    (void)random;
}

/* The largest error over all profiles; *same receives the share of identical samples. */
static double worst_of_profiles(uint32_t sample, uint64_t random, encoder encode, double *same) {
    double count = 0.0, worst = 0.0;
    for (int n = 0; n < PROFILES; n++) {
        model m;
        random_model(&m, &random);
        m.options.source_sample = m.options.target_sample = sample;
        encode(&m, &random);
        worst = fmax(worst, worst_error(&m, sample, &random, &count));
    }
    *same = count / (3.0 * PIXELS * PROFILES);
    return worst;
}

static void check_codes(uint32_t sample, encoder encode, double smallest_share) {
    double same;
    const double worst = worst_of_profiles(sample, 17, encode, &same);
    print_message("worst %.0f level, %.4f %% identical\n", worst, 100.0 * same);
    assert_true(worst <= 1.0);
    assert_true(same >= smallest_share);
}

static void test_8_bit(void **state) {
    (void)state;
    check_codes(LENSPROF_SAMPLE_U8, as_drawn, 0.999);
    check_codes(LENSPROF_SAMPLE_U8, with_levels, 0.999);
}

static void test_16_bit(void **state) {
    (void)state;
    check_codes(LENSPROF_SAMPLE_U16, as_drawn, 0.95);
    check_codes(LENSPROF_SAMPLE_U16, with_levels, 0.95);
}

static void test_linear_float(void **state) {
    (void)state;
    double same;
    const double worst = worst_of_profiles(LENSPROF_SAMPLE_F32, 29, linear, &same);
    print_message("worst %.2f units in the last place\n", worst);
    assert_true(worst <= 4.0);
}

static void test_float_through_responses(void **state) {
    (void)state;
    double same;
    const double worst = worst_of_profiles(LENSPROF_SAMPLE_F32, 31, through_responses, &same);
    print_message("worst %.3f levels of 16 bit\n", worst);
    assert_true(worst <= 0.05);
}

static void test_float_with_levels(void **state) {
    (void)state;
    double same;
    const double worst = worst_of_profiles(LENSPROF_SAMPLE_F32, 37, with_levels, &same);
    print_message("worst %.3f levels of 16 bit\n", worst);
    assert_true(worst <= 0.05);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_8_bit),
        cmocka_unit_test(test_16_bit),
        cmocka_unit_test(test_linear_float),
        cmocka_unit_test(test_float_through_responses),
        cmocka_unit_test(test_float_with_levels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
