/* Radial falloff and exposure. */
#include "core/exposure.h"
#include "support.h"

#include <lensprof/model.h>

static void test_value_and_radius(void **state) {
    (void)state;
    const lensprof_vignetting v = {{-0.3, 0.05, -0.15}, {0.0, 0.0}};
    assert_close(lensprof_vignetting_eval(&v, 0.0, NULL), 1.0, 0.0);
    assert_close(lensprof_vignetting_eval(&v, 1.0, NULL), 0.6, 1e-15);
    assert_close(lensprof_vignetting_eval(&v, 0.25, NULL), 1 - 0.3 * 0.25 + 0.05 * 0.0625 - 0.15 * 0.015625, 1e-15);
    /* 400 x 300: half diagonal 250 px, centre (199.5, 149.5); the outer corner of the corner pixel is at r = 1 */
    assert_close(lensprof_vignetting_r2(&v, 400, 300, 199.5, 149.5, NULL), 0.0, 1e-15);
    assert_close(lensprof_vignetting_r2(&v, 400, 300, -0.5, -0.5, NULL), 1.0, 1e-12);
    assert_close(lensprof_vignetting_r2(&v, 400, 300, 449.5, 149.5, NULL), 1.0, 1e-12);
    const lensprof_vignetting shifted = {{0}, {0.1, -0.2}}; /* 25 px right, 50 px up */
    assert_close(lensprof_vignetting_r2(&shifted, 400, 300, 224.5, 99.5, NULL), 0.0, 1e-15);
}

static void test_derivatives_against_central_differences(void **state) {
    (void)state;
    uint64_t random = 3;
    for (int i = 0; i < 1000; i++) {
        lensprof_vignetting v = {{lp_random(&random) - 0.5, lp_random(&random) - 0.5, lp_random(&random) - 0.5},
                                 {0.2 * (lp_random(&random) - 0.5), 0.2 * (lp_random(&random) - 0.5)}};
        double r2 = lp_random(&random), h = 1e-5, slope, gradient[2], x = 640 * lp_random(&random),
               y = 480 * lp_random(&random);
        lensprof_vignetting_eval(&v, r2, &slope);
        double numeric =
            (lensprof_vignetting_eval(&v, r2 + h, NULL) - lensprof_vignetting_eval(&v, r2 - h, NULL)) / (2 * h);
        assert_close(slope, numeric, 1e-8);
        lensprof_vignetting_r2(&v, 640, 480, x, y, gradient);
        for (int d = 0; d < 2; d++) {
            lensprof_vignetting low = v, high = v;
            low.center[d] -= h;
            high.center[d] += h;
            numeric = (lensprof_vignetting_r2(&high, 640, 480, x, y, NULL)
                       - lensprof_vignetting_r2(&low, 640, 480, x, y, NULL))
                      / (2 * h);
            assert_close(gradient[d], numeric, 1e-8);
        }
    }
}

/* The verdict equals that of a fine scan over the radius. */
static void test_validate_finds_every_minimum(void **state) {
    (void)state;
    uint64_t random = 5;
    int valid = 0, invalid = 0;
    for (int i = 0; i < 20000; i++) {
        lensprof_vignetting v = {{6 * lp_random(&random) - 4, 8 * lp_random(&random) - 4, 6 * lp_random(&random) - 3},
                                 {0.3 * (lp_random(&random) - 0.5), 0.3 * (lp_random(&random) - 0.5)}};
        if (i % 3 == 0) v.k[2] = 0.0;
        if (i % 7 == 0) v.k[1] = 0.0;
        double reach = 1.0 + hypot(v.center[0], v.center[1]), smallest = 1.0;
        for (int s = 0; s <= 2000; s++)
            smallest = fmin(smallest, lensprof_vignetting_eval(&v, reach * reach * s / 2000.0, NULL));
        lensprof_status status = lensprof_vignetting_validate(&v);
        if (smallest > 0.0015) assert_ok(status), valid++;
        if (smallest < 0.0009) assert_int_equal(status, LENSPROF_ERROR_VIGNETTING), invalid++;
    }
    assert_true(valid > 1000 && invalid > 1000);
}

static void test_validate_refuses(void **state) {
    (void)state;
    lensprof_vignetting v = {{NAN, 0, 0}, {0, 0}};
    assert_int_equal(lensprof_vignetting_validate(&v), LENSPROF_ERROR_NOT_FINITE);
    v = (lensprof_vignetting){{0}, {0, INFINITY}};
    assert_int_equal(lensprof_vignetting_validate(&v), LENSPROF_ERROR_NOT_FINITE);
    v = (lensprof_vignetting){{0}, {1.5, 0}};
    assert_int_equal(lensprof_vignetting_validate(&v), LENSPROF_ERROR_VIGNETTING);
    v = (lensprof_vignetting){{-4e155, 4e155, 1e150}, {0, 0}}; /* squares overflow */
    assert_int_equal(lensprof_vignetting_validate(&v), LENSPROF_ERROR_VIGNETTING);
    assert_int_equal(lensprof_vignetting_validate(NULL), LENSPROF_ERROR_ARGUMENT);
}

static void test_exposure(void **state) {
    (void)state;
    lensprof_exposure e;
    lensprof_exposure_init(&e);
    assert_ok(lensprof_exposure_validate(&e));
    assert_close(lp_exposure_factor(&e, 0), 1.0, 0.0);
    e.ev = -1.5;
    e.white_balance[2] = 1.25;
    assert_close(lp_exposure_factor(&e, 2), exp2(-1.5) * 1.25, 1e-15); /* larger ev = more light */
    e.white_balance[2] = 0.0;
    assert_int_equal(lensprof_exposure_validate(&e), LENSPROF_ERROR_EXPOSURE);
    e.white_balance[2] = 1.0, e.ev = NAN;
    assert_int_equal(lensprof_exposure_validate(&e), LENSPROF_ERROR_EXPOSURE);
}

static void test_half_diagonal(void **state) {
    (void)state;
    assert_close(lensprof_half_diagonal(400, 300), 250.0, 0.0);
    assert_close(lensprof_half_diagonal(1, 1), 0.70710678118654752440, 0.0);
    assert_close(lensprof_half_diagonal(UINT32_MAX, UINT32_MAX), UINT32_MAX * 0.70710678118654752440, 1e-5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half_diagonal),
        cmocka_unit_test(test_value_and_radius),
        cmocka_unit_test(test_derivatives_against_central_differences),
        cmocka_unit_test(test_validate_finds_every_minimum),
        cmocka_unit_test(test_validate_refuses),
        cmocka_unit_test(test_exposure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
