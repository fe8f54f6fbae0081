/* Functions over arrays: bit for bit the results of the functions for one number, also for NaN, outside and in place.
 */
#include "support.h"

#include <lensprof/geometry.h>
#include <lensprof/model.h>

#define COUNT 4000

static double drawn[2 * COUNT], results[2 * COUNT], slopes[2 * COUNT];

/* Numbers within low..high, with some beyond and some that are not finite. */
static void draw(double low, double high) {
    uint64_t random = 5;
    const double special[] = {NAN, INFINITY, -INFINITY, 0.0, -0.0, 1.0, 1e300};
    for (size_t i = 0; i < 2 * COUNT; i++)
        drawn[i] = i % 50 < 7 ? special[i % 50] : low + (high - low) * (1.2 * lp_random(&random) - 0.1);
    for (size_t i = 0; i < 2 * COUNT; i++) results[i] = slopes[i] = -77.0;
}

static void assert_same(double a, double b) { assert_memory_equal(&a, &b, sizeof a); }

static void test_responses(void **state) {
    (void)state;
    const double coefficients[2] = {0.5, -0.2}, values[4] = {0.0, 0.5, 0.5, 1.0};
    lensprof_response kinds[4];
    lensprof_response_set_linear(&kinds[0]);
    assert_ok(lensprof_response_set_gamma(&kinds[1], 2.2));
    assert_ok(lensprof_response_set_emor(&kinds[2], coefficients, 2));
    assert_ok(lensprof_response_set_table(&kinds[3], values, 4));
    for (int k = 0; k < 4; k++)
        for (int inverse = 0; inverse < 2; inverse++) {
            const lensprof_response *r = &kinds[k];
            draw(0.0, 1.0);
            (inverse ? lensprof_response_invert_many : lensprof_response_eval_many)(r, drawn, COUNT, results, slopes);
            for (size_t i = 0; i < COUNT; i++) {
                double slope;
                assert_same(results[i],
                            (inverse ? lensprof_response_invert : lensprof_response_eval)(r, drawn[i], &slope));
                assert_same(slopes[i], slope);
            }
            assert_same(results[COUNT], -77.0); /* nothing beyond the last */
            (inverse ? lensprof_response_invert_many : lensprof_response_eval_many)(r, drawn, COUNT, drawn, NULL);
            assert_memory_equal(drawn, results, COUNT * sizeof *drawn);
        }
}

static void test_falloffs(void **state) {
    (void)state;
    const lensprof_vignetting v = {{-0.3, 0.05, -0.1}, {0.02, -0.01}};
    draw(0.0, 1.5);
    lensprof_vignetting_eval_many(&v, drawn, COUNT, results, slopes);
    for (size_t i = 0; i < COUNT; i++) {
        double slope;
        assert_same(results[i], lensprof_vignetting_eval(&v, drawn[i], &slope));
        assert_same(slopes[i], slope);
    }
    draw(0.0, 640.0);
    lensprof_vignetting_r2_many(&v, 640, 480, drawn, COUNT, results, slopes);
    for (size_t i = 0; i < COUNT; i++) {
        double gradient[2];
        assert_same(results[i], lensprof_vignetting_r2(&v, 640, 480, drawn[2 * i], drawn[2 * i + 1], gradient));
        assert_memory_equal(&slopes[2 * i], gradient, sizeof gradient);
    }
    lensprof_vignetting_r2_many(&v, 640, 480, drawn, COUNT, results, NULL);
    lensprof_gain_grid grid;
    lensprof_gain_grid_init(&grid);
    grid.columns = 3, grid.rows = 2, grid.channels = 3;
    for (int i = 0; i < 18; i++) grid.attenuation[i] = 0.5f + 0.02f * (float)i;
    lensprof_gain_grid_eval_many(&grid, 640, 480, drawn, COUNT, 2, results);
    for (size_t i = 0; i < COUNT; i++)
        assert_same(results[i], lensprof_gain_grid_eval(&grid, 640, 480, drawn[2 * i], drawn[2 * i + 1], 2));
}

/* Half of the directions are at the back of the camera; those are NaN and not counted. */
static void test_cameras(void **state) {
    (void)state;
    const lensprof_camera camera = {.width = 640,
                                    .height = 480,
                                    .hfov_deg = 50.0,
                                    .yaw_deg = 20.0,
                                    .radial = {0.0, -0.02, 0.0},
                                    .shift_px = {3.0, -2.0}};
    assert_ok(lensprof_camera_validate(&camera));
    for (int back = 0; back < 2; back++) {
        size_t seen = 0;
        draw(back ? -2000.0 : -3.2, back ? 3000.0 : 3.2);
        const size_t reported =
            (back ? lensprof_camera_unproject_many : lensprof_camera_project_many)(&camera, drawn, COUNT, results);
        for (size_t i = 0; i < COUNT; i++) {
            double one[2];
            if ((back ? lensprof_camera_unproject : lensprof_camera_project)(&camera, drawn[2 * i], drawn[2 * i + 1],
                                                                             one)) {
                assert_memory_equal(&results[2 * i], one, sizeof one);
                seen++;
            } else {
                assert_true(isnan(results[2 * i]) && isnan(results[2 * i + 1]));
            }
        }
        assert_int_equal(reported, seen);
        assert_true(seen > 100 && seen < COUNT - 100);
        assert_int_equal(
            (back ? lensprof_camera_unproject_many : lensprof_camera_project_many)(&camera, drawn, COUNT, drawn), seen);
        assert_memory_equal(drawn, results, sizeof results);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_responses),
        cmocka_unit_test(test_falloffs),
        cmocka_unit_test(test_cameras),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
