/* Point files of vig_optimize. */
#include "support.h"

#include <lensprof/formats.h>

#define FIRST "0 1 10.5 20 30 40.25 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0\n"
#define SECOND "7 2\t-1 2e1 3 4 0 1 0.5 1 0 +.25 0 0 0 0"

static const char two[] = FIRST "\r\n   \n" SECOND;

static void test_read(void **state) {
    (void)state;
    lensprof_pair pairs[3];
    uint32_t found = 99;
    lensprof_error error;
    assert_ok(lensprof_points_read(two, strlen(two), NULL, 0, &found, &error));
    assert_int_equal(found, 2);
    assert_ok(lensprof_points_read(two, strlen(two), pairs, 3, &found, &error));
    assert_int_equal(found, 2);
    assert_string_equal(error.text, "");
    assert_true(pairs[0].image[0] == 0 && pairs[0].image[1] == 1 && pairs[1].image[0] == 7 && pairs[1].image[1] == 2);
    assert_true(pairs[0].xy[0][0] == 10.5 && pairs[0].xy[0][1] == 20 && pairs[0].xy[1][0] == 30);
    assert_true(pairs[0].xy[1][1] == 40.25 && pairs[1].xy[0][0] == -1 && pairs[1].xy[0][1] == 20);
    for (int c = 0; c < 3; c++) {
        assert_close(pairs[0].value[0][c], 0.1 * (c + 1), 1e-16);
        assert_close(pairs[0].value[1][c], 0.1 * (c + 4), 1e-15);
    }
    assert_true(pairs[1].value[0][1] == 1 && pairs[1].value[1][2] == 0.25);
    assert_ok(lensprof_points_read("", 0, pairs, 3, &found, &error));
    assert_int_equal(found, 0);
}

static void test_too_small_a_buffer(void **state) {
    (void)state;
    lensprof_pair pairs[2], before[2];
    uint32_t found = 0;
    lensprof_error error;
    memset(pairs, 5, sizeof pairs);
    memset(before, 5, sizeof before);
    assert_int_equal(lensprof_points_read(two, strlen(two), pairs, 1, &found, &error), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(found, 2);
    assert_memory_equal(pairs, before, sizeof pairs);
    assert_non_null(strchr(error.text, ';'));
}

static void test_read_errors(void **state) {
    (void)state;
    const struct {
        const char *line, *words;
    } cases[] = {
        {"0 1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8", "line 2: column 16"},
        {"0 1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0 0", "line 2: more than 16"},
        {"0 0 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "line 2: both points are in image 0"},
        {"0.5 1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "column 1 (image1) is \"0.5\""},
        {"0 -1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "column 2 (image2) is \"-1\""},
        {"0 4294967295 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "column 2"},
        {"0 1 nan 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "column 3 (x1) is \"nan\""},
        {"0 1 10 20 30 inf 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "column 6 (y2)"},
        {"0 1 10 20 30 40 1.31 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "column 7 (R1) is \"1.31\", not within 0..1"},
        {"0 1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 -0.3 0 0.7 0.8 0", "column 12 (B2)"},
        {"0 1 10 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8x 0", "column 15 (radius2) is \"0.8x\""},
        {"0 1 10,5 20 30 40 0.1 0.2 0.3 0.4 0.5 0.6 0 0.7 0.8 0", "column 3"},
        {"# comment", "column 1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[300];
        lensprof_pair pair[3], before[3];
        uint32_t found = 77;
        lensprof_error error;
        memset(pair, 5, sizeof pair);
        memset(before, 5, sizeof before);
        snprintf(text, sizeof text, "%s%s\n" FIRST, FIRST, cases[i].line);
        assert_int_equal(lensprof_points_read(text, strlen(text), pair, 3, &found, &error), LENSPROF_ERROR_SYNTAX);
        assert_int_equal(found, 77);
        assert_memory_equal(pair, before, sizeof pair);
        if (!strstr(error.text, cases[i].words) || !strchr(error.text, ';')) {
            print_error("\"%s\" does not hold \"%s\"\n", error.text, cases[i].words);
            fail();
        }
    }
}

/* Frames of 6 x 8: half the diagonal is 5, the centre is (2.5, 3.5). */
static void test_write(void **state) {
    (void)state;
    const lensprof_camera cameras[2] = {{.width = 6, .height = 8}, {.width = 600, .height = 800}};
    const lensprof_pair pair = {{1, 0}, {{299.5, 149.5}, {6.5, 6.5}}, {{0, 0.5, 1}, {0.1, 0.25, 1e-9}}};
    const char *expected = "1 0 299.5 149.5 6.5 6.5 0 0.5 1 0.1 0.25 1e-09 0 0.5 1 0\n";
    char text[100] = "untouched";
    size_t needed = 0;
    assert_ok(lensprof_points_write(&pair, 1, cameras, 2, NULL, 0, &needed, NULL));
    assert_int_equal(needed, strlen(expected));
    assert_int_equal(lensprof_points_write(&pair, 1, cameras, 2, text, needed - 1, NULL, NULL),
                     LENSPROF_ERROR_CAPACITY);
    assert_string_equal(text, "untouched");
    assert_ok(lensprof_points_write(&pair, 1, cameras, 2, text, sizeof text, &needed, NULL));
    assert_string_equal(text, expected);
    assert_ok(lensprof_points_write(NULL, 0, NULL, 0, NULL, 0, &needed, NULL));
    assert_int_equal(needed, 0);
}

static void test_write_refuses(void **state) {
    (void)state;
    lensprof_camera cameras[2] = {{.width = 6, .height = 8}, {.width = 6, .height = 8}};
    lensprof_pair pair = {{0, 1}, {{1, 2}, {3, 4}}, {{0, 0, 0}, {1, 1, 1}}};
    char text[200];
    assert_int_equal(lensprof_points_write(&pair, 1, cameras, 1, text, 200, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_points_write(NULL, 1, cameras, 2, text, 200, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_points_write(&pair, 1, NULL, 2, text, 200, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_points_write(&pair, 1, cameras, 2, NULL, 200, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
    pair.value[1][2] = NAN;
    assert_int_equal(lensprof_points_write(&pair, 1, cameras, 2, text, 200, NULL, NULL), LENSPROF_ERROR_NOT_FINITE);
    pair.value[1][2] = 1;
    pair.xy[0][1] = INFINITY;
    assert_int_equal(lensprof_points_write(&pair, 1, cameras, 2, text, 200, NULL, NULL), LENSPROF_ERROR_NOT_FINITE);
    pair.xy[0][1] = 1;
    cameras[1].width = 0;
    assert_int_equal(lensprof_points_write(&pair, 1, cameras, 2, text, 200, NULL, NULL), LENSPROF_ERROR_SIZE);
}

static void test_round_trip_is_exact(void **state) {
    (void)state;
    enum {
        COUNT = 500
    };
    static lensprof_pair pairs[COUNT], again[COUNT];
    static char text[COUNT * 400];
    lensprof_camera cameras[5];
    uint64_t seed = 3;
    for (int i = 0; i < 5; i++) cameras[i] = (lensprof_camera){.width = 4000 + 7 * (uint32_t)i, .height = 3000};
    for (int i = 0; i < COUNT; i++) {
        pairs[i].image[0] = (uint32_t)(i % 5);
        pairs[i].image[1] = (uint32_t)((i + 1 + i / 5 % 4) % 5);
        for (int side = 0; side < 2; side++) {
            for (int k = 0; k < 2; k++) pairs[i].xy[side][k] = 4000 * lp_random(&seed);
            for (int c = 0; c < 3; c++) pairs[i].value[side][c] = lp_random(&seed);
        }
    }
    size_t bytes;
    uint32_t found;
    assert_ok(lensprof_points_write(pairs, COUNT, cameras, 5, text, sizeof text, &bytes, NULL));
    assert_ok(lensprof_points_read(text, bytes, again, COUNT, &found, NULL));
    assert_int_equal(found, COUNT);
    assert_memory_equal(pairs, again, sizeof pairs);
}

static void test_arguments(void **state) {
    (void)state;
    lensprof_pair pair;
    uint32_t found;
    assert_int_equal(lensprof_points_read(NULL, 5, &pair, 1, &found, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_points_read(two, 5, NULL, 1, &found, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_points_read(two, 5, &pair, 1, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
}

/* Output of vig_optimize with the overshoot of its cubic interpolation. */
static void test_overshoot_is_cut(void **state) {
    (void)state;
    const char *text = "0 1 10 20 30 40 1.02 0.2 0.3 0.4 0.5 -0.015 0 0.7 0.8 0\n";
    lensprof_pair pair;
    uint32_t found = 0;
    assert_ok(lensprof_points_read(text, strlen(text), &pair, 1, &found, NULL));
    assert_close(pair.value[0][0], 1.0, 0.0);
    assert_close(pair.value[1][2], 0.0, 0.0);
    assert_close(pair.value[1][1], 0.5, 0.0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_read),          cmocka_unit_test(test_too_small_a_buffer),
        cmocka_unit_test(test_read_errors),   cmocka_unit_test(test_write),
        cmocka_unit_test(test_write_refuses), cmocka_unit_test(test_round_trip_is_exact),
        cmocka_unit_test(test_arguments),     cmocka_unit_test(test_overshoot_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
