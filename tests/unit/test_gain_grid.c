/* Attenuation on a grid over the frame. */
#include "support.h"

#include <lensprof/model.h>

static lensprof_gain_grid ones(uint32_t columns, uint32_t rows, uint32_t channels) {
    lensprof_gain_grid g;
    lensprof_gain_grid_init(&g);
    g.columns = columns, g.rows = rows, g.channels = channels;
    for (uint32_t i = 0; i < columns * rows * channels; i++) g.attenuation[i] = 1.0f;
    return g;
}

static void test_no_grid_is_one_everywhere(void **state) {
    (void)state;
    lensprof_gain_grid g;
    memset(&g, 0xff, sizeof g);
    lensprof_gain_grid_init(&g);
    assert_ok(lensprof_gain_grid_validate(&g));
    for (uint32_t c = 0; c < 3; c++) assert_close(lensprof_gain_grid_eval(&g, 640, 480, 17.0, 400.0, c), 1.0, 0.0);
}

static void test_nodes_lie_from_first_to_last_pixel(void **state) {
    (void)state;
    lensprof_gain_grid g = ones(5, 4, 3);
    for (uint32_t i = 0; i < 60; i++) g.attenuation[i] = 0.5f + 0.01f * (float)i;
    /* 401 x 301: nodes every 100 px */
    for (uint32_t c = 0; c < 3; c++)
        for (uint32_t j = 0; j < 4; j++)
            for (uint32_t i = 0; i < 5; i++)
                assert_close(lensprof_gain_grid_eval(&g, 401, 301, 100.0 * i, 100.0 * j, c),
                             g.attenuation[(c * 4 + j) * 5 + i], 1e-14);
    /* Outside the frame: the value at the border. */
    assert_close(lensprof_gain_grid_eval(&g, 401, 301, -30.0, -1e9, 0), g.attenuation[0], 0.0);
    assert_close(lensprof_gain_grid_eval(&g, 401, 301, 400.5, 1e300, 2), g.attenuation[59], 0.0);
    g.channels = 1;
    for (uint32_t c = 0; c < 3; c++)
        assert_close(lensprof_gain_grid_eval(&g, 401, 301, 400.0, 300.0, c), g.attenuation[19], 1e-14);
    g.channels = 3; /* alpha has no nodes */
    assert_close(lensprof_gain_grid_eval(&g, 401, 301, 400.0, 300.0, 3), 1.0, 0.0);
}

/* a + b x + c y + d x y is bilinear in every cell, so a grid represents it to the precision of its floats. */
static void test_bilinear_functions_are_exact(void **state) {
    (void)state;
    uint64_t random = 11;
    for (int run = 0; run < 200; run++) {
        uint32_t columns = 2 + (uint32_t)(31 * lp_random(&random)), rows = 2 + (uint32_t)(31 * lp_random(&random));
        uint32_t width = 2 + (uint32_t)(900 * lp_random(&random)), height = 2 + (uint32_t)(900 * lp_random(&random));
        double b = lp_random(&random) - 0.5, c = lp_random(&random) - 0.5, d = lp_random(&random) - 0.5;
        lensprof_gain_grid g = ones(columns, rows, 1);
        for (uint32_t j = 0; j < rows; j++)
            for (uint32_t i = 0; i < columns; i++) {
                double u = i / (columns - 1.0), v = j / (rows - 1.0);
                g.attenuation[j * columns + i] = (float)(2.0 + b * u + c * v + d * u * v);
            }
        assert_ok(lensprof_gain_grid_validate(&g));
        double x = (width - 1.0) * lp_random(&random), y = (height - 1.0) * lp_random(&random);
        double u = x / (width - 1.0), v = y / (height - 1.0);
        assert_close(lensprof_gain_grid_eval(&g, width, height, x, y, 1), 2.0 + b * u + c * v + d * u * v, 3e-7);
    }
}

static void test_frames_of_one_pixel(void **state) {
    (void)state;
    lensprof_gain_grid g = ones(2, 2, 1);
    g.attenuation[0] = 0.25f;
    assert_close(lensprof_gain_grid_eval(&g, 1, 1, 0.0, 0.0, 0), 0.25, 0.0);
    assert_close(lensprof_gain_grid_eval(&g, 1, 2, 0.0, 1.0, 0), 1.0, 0.0);
}

static void test_validate_refuses(void **state) {
    (void)state;
    static const struct {
        uint32_t columns, rows, channels;
        lensprof_status status;
    } shapes[] = {{2, 2, 1, LENSPROF_OK},
                  {32, 32, 3, LENSPROF_OK},
                  {1, 2, 1, LENSPROF_ERROR_SIZE},
                  {2, 1, 1, LENSPROF_ERROR_SIZE},
                  {0, 2, 1, LENSPROF_ERROR_SIZE},
                  {33, 2, 1, LENSPROF_ERROR_SIZE},
                  {2, 4000000000u, 1, LENSPROF_ERROR_SIZE},
                  {2, 2, 2, LENSPROF_ERROR_ARGUMENT},
                  {2, 2, 0, LENSPROF_ERROR_ARGUMENT},
                  {0, 0, 1, LENSPROF_ERROR_ARGUMENT}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        lensprof_gain_grid g = ones(0, 0, 0);
        g.columns = shapes[i].columns, g.rows = shapes[i].rows, g.channels = shapes[i].channels;
        if (shapes[i].status == LENSPROF_OK) g = ones(g.columns, g.rows, g.channels);
        assert_int_equal(lensprof_gain_grid_validate(&g), shapes[i].status);
    }
    static const struct {
        float value;
        lensprof_status status;
    } values[] = {{0.001f, LENSPROF_OK},
                  {1000.0f, LENSPROF_OK},
                  {0.0f, LENSPROF_ERROR_VIGNETTING},
                  {0.00099f, LENSPROF_ERROR_VIGNETTING},
                  {1001.0f, LENSPROF_ERROR_VIGNETTING},
                  {-1.0f, LENSPROF_ERROR_VIGNETTING},
                  {NAN, LENSPROF_ERROR_NOT_FINITE},
                  {INFINITY, LENSPROF_ERROR_NOT_FINITE}};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        lensprof_gain_grid g = ones(4, 3, 3);
        g.attenuation[35] = values[i].value; /* the last node */
        assert_int_equal(lensprof_gain_grid_validate(&g), values[i].status);
    }
    lensprof_gain_grid g = ones(4, 3, 1);
    g.attenuation[12] = 1.0f; /* beyond the last node */
    assert_int_equal(lensprof_gain_grid_validate(&g), LENSPROF_ERROR_ARGUMENT);
    g.attenuation[12] = 0.0f, g.reserved = 1;
    assert_int_equal(lensprof_gain_grid_validate(&g), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_gain_grid_validate(NULL), LENSPROF_ERROR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_grid_is_one_everywhere),
        cmocka_unit_test(test_nodes_lie_from_first_to_last_pixel),
        cmocka_unit_test(test_bilinear_functions_are_exact),
        cmocka_unit_test(test_frames_of_one_pixel),
        cmocka_unit_test(test_validate_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
