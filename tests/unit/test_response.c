/* Response curves: construction, evaluation, inversion, derivatives, validation. */
#include "support.h"

#include <lensprof/model.h>

#define LAST (LENSPROF_RESPONSE_SAMPLES - 1)

static lensprof_response emor(double a, double b) {
    lensprof_response r;
    const double coefficients[2] = {a, b};
    assert_ok(lensprof_response_set_emor(&r, coefficients, 2));
    return r;
}

/* The published tables: curves end at 0 and 1, modes vanish at the ends and are orthonormal on the grid. */
static void test_srgb(void **state) {
    (void)state;
    lensprof_response r;
    lensprof_response_set_srgb(NULL);
    lensprof_response_set_srgb(&r);
    assert_ok(lensprof_response_validate(&r));
    assert_int_equal(r.kind, LENSPROF_RESPONSE_TABLE);
    /* Known values: the middle grey of 18 %, the end of the linear part, and white. */
    assert_close(lensprof_response_eval(&r, 0.18, NULL), 0.46135612950044164, 2e-5);
    assert_close(lensprof_response_invert(&r, 0.5, NULL), 0.21404114048223255, 2e-6);
    assert_close(lensprof_response_eval(&r, 0.002, NULL), 0.02584, 1e-6);
    assert_close(lensprof_response_eval(&r, 1.0, NULL), 1.0, 0.0);
}

static void test_emor_tables(void **state) {
    (void)state;
    assert_null(lensprof_emor_table(LENSPROF_EMOR_MODES + 1));
    assert_close(lensprof_emor_table(0)[0], 0.0, 0.0);
    assert_close(lensprof_emor_table(0)[LAST], 1.0, 0.0);
    assert_close(lensprof_emor_table(0)[1], 8.833750e-03, 0.0); /* first values of the published file */
    assert_close(lensprof_emor_table(1)[1], -1.452326e-03, 0.0);
    for (uint32_t l = 1; l <= LENSPROF_EMOR_MODES; l++)
        for (uint32_t m = 1; m <= l; m++) {
            double dot = 0.0;
            for (int j = 0; j <= LAST; j++) dot += lensprof_emor_table(l)[j] * lensprof_emor_table(m)[j];
            assert_close(dot, l == m ? 1.0 : 0.0, 2e-6);
        }
}

static void test_kinds_follow_their_formulas(void **state) {
    (void)state;
    lensprof_response r;
    lensprof_response_set_linear(&r);
    assert_close(lensprof_response_eval(&r, 0.3, NULL), 0.3, 0.0);
    assert_ok(lensprof_response_set_gamma(&r, 2.2));
    assert_close(lensprof_response_eval(&r, 0.3, NULL), pow(0.3, 1.0 / 2.2), 1e-15);
    assert_close(lensprof_response_invert(&r, 0.3, NULL), pow(0.3, 2.2), 1e-15);
    assert_close(r.table[512], pow(512.0 / LAST, 1.0 / 2.2), 1e-15);
    r = emor(0.5, -0.2);
    double expected =
        lensprof_emor_table(0)[100] + 0.5 * lensprof_emor_table(1)[100] - 0.2 * lensprof_emor_table(2)[100];
    assert_close(lensprof_response_eval(&r, 100.0 / LAST, NULL), expected, 1e-12);
    const double table[3] = {0.0, 0.8, 1.0};
    assert_ok(lensprof_response_set_table(&r, table, 3));
    assert_close(lensprof_response_eval(&r, 0.25, NULL), 0.4, 1e-6);
    assert_close(lensprof_response_eval(&r, 0.75, NULL), 0.9, 1e-6);
}

static void test_values_outside_are_clamped(void **state) {
    (void)state;
    lensprof_response r = emor(1.0, 0.0);
    double slope = 7.0;
    assert_close(lensprof_response_eval(&r, -0.5, &slope), 0.0, 0.0);
    assert_close(slope, 0.0, 0.0);
    assert_close(lensprof_response_eval(&r, 1.5, &slope), 1.0, 0.0);
    assert_close(slope, 0.0, 0.0);
    assert_close(lensprof_response_invert(&r, -1.0, NULL), 0.0, 0.0);
    assert_close(lensprof_response_invert(&r, 2.0, NULL), 1.0, 0.0);
}

static void test_invert_undoes_eval(void **state) {
    (void)state;
    lensprof_response kinds[4];
    lensprof_response_set_linear(&kinds[0]);
    assert_ok(lensprof_response_set_gamma(&kinds[1], 1.8));
    kinds[2] = emor(-1.0, 0.3);
    const double table[4] = {0.0, 0.5, 0.9, 1.0};
    assert_ok(lensprof_response_set_table(&kinds[3], table, 4));
    for (int k = 0; k < 4; k++)
        for (int i = 0; i <= 5000; i++) {
            double x = i / 5000.0;
            assert_close(lensprof_response_invert(&kinds[k], lensprof_response_eval(&kinds[k], x, NULL), NULL), x,
                         1e-9);
        }
}

/* On a flat stretch of the curve, the inverse is the smallest irradiance that gives the grey value. */
static void test_invert_of_a_flat_curve(void **state) {
    (void)state;
    lensprof_response r;
    const double table[5] = {0.0, 0.5, 0.5, 1.0, 1.0};
    assert_ok(lensprof_response_set_table(&r, table, 5));
    double half = r.table[256]; /* inside the first flat stretch */
    assert_true(lensprof_response_invert(&r, half, NULL) < 0.2505);
    assert_true(lensprof_response_invert(&r, 1.0, NULL) < 0.7515);
}

static void test_slopes_against_central_differences(void **state) {
    (void)state;
    lensprof_response kinds[3];
    lensprof_response_set_linear(&kinds[0]);
    assert_ok(lensprof_response_set_gamma(&kinds[1], 2.4));
    kinds[2] = emor(2.0, -0.5);
    uint64_t random = 1;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2000; i++) {
            /* inside one grid interval, where the curve is smooth */
            double x = (floor(lp_random(&random) * LAST) + 0.5) / LAST, h = 1e-6, slope, inverse_slope;
            double b = lensprof_response_eval(&kinds[k], x, &slope);
            double numeric =
                (lensprof_response_eval(&kinds[k], x + h, NULL) - lensprof_response_eval(&kinds[k], x - h, NULL))
                / (2.0 * h);
            assert_close(slope, numeric, 1e-4 * (1.0 + fabs(numeric)));
            lensprof_response_invert(&kinds[k], b, &inverse_slope);
            assert_close(inverse_slope * slope, 1.0, 1e-9);
        }
}

static void test_set_refuses_what_is_no_response(void **state) {
    (void)state;
    lensprof_response r, before;
    lensprof_response_set_linear(&r);
    before = r;
    const double steep[1] = {40.0}, nan_coefficient[1] = {NAN}, falling[3] = {0.0, 1.1, 1.0}, ends[2] = {0.1, 1.0};
    assert_int_equal(lensprof_response_set_emor(&r, steep, 1), LENSPROF_ERROR_RESPONSE);
    assert_int_equal(lensprof_response_set_emor(&r, nan_coefficient, 1), LENSPROF_ERROR_NOT_FINITE);
    assert_int_equal(lensprof_response_set_emor(&r, steep, 26), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_response_set_emor(&r, NULL, 1), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_response_set_table(&r, falling, 3), LENSPROF_ERROR_RESPONSE);
    assert_int_equal(lensprof_response_set_table(&r, ends, 2), LENSPROF_ERROR_RESPONSE);
    assert_int_equal(lensprof_response_set_table(&r, ends, 1), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_response_set_gamma(&r, 0.0), LENSPROF_ERROR_RESPONSE);
    assert_int_equal(lensprof_response_set_gamma(&r, NAN), LENSPROF_ERROR_RESPONSE);
    assert_memory_equal(&r, &before, sizeof r);
}

static void test_validate(void **state) {
    (void)state;
    lensprof_response good = emor(0.2, 0.1), r = good;
    assert_ok(lensprof_response_validate(&good));
    assert_int_equal(lensprof_response_validate(NULL), LENSPROF_ERROR_ARGUMENT);
    r.table[500] = r.table[499] - 1e-9;
    assert_int_equal(lensprof_response_validate(&r), LENSPROF_ERROR_RESPONSE);
    r = good, r.table[500] = NAN;
    assert_int_equal(lensprof_response_validate(&r), LENSPROF_ERROR_RESPONSE);
    r = good, r.table[LAST] = 0.999;
    assert_int_equal(lensprof_response_validate(&r), LENSPROF_ERROR_RESPONSE);
    r = good, r.kind = 9;
    assert_int_equal(lensprof_response_validate(&r), LENSPROF_ERROR_ARGUMENT);
    r = good, r.modes = 26;
    assert_int_equal(lensprof_response_validate(&r), LENSPROF_ERROR_RESPONSE);
    r = good, r.emor[7] = 1.0; /* beyond the modes in use */
    assert_int_equal(lensprof_response_validate(&r), LENSPROF_ERROR_RESPONSE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_srgb),
        cmocka_unit_test(test_emor_tables),
        cmocka_unit_test(test_kinds_follow_their_formulas),
        cmocka_unit_test(test_values_outside_are_clamped),
        cmocka_unit_test(test_invert_undoes_eval),
        cmocka_unit_test(test_invert_of_a_flat_curve),
        cmocka_unit_test(test_slopes_against_central_differences),
        cmocka_unit_test(test_set_refuses_what_is_no_response),
        cmocka_unit_test(test_validate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
