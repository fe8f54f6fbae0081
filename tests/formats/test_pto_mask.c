/* Drawing crops and masks. The pictures below are the expected results, row by row. */
#include "pto_support.h"

static void assert_drawn(const lensprof_pto *pto, uint32_t index, uint32_t width, uint32_t height,
                         const char *picture) {
    uint8_t mask[64 * 32];
    char drawn[64 * 32 + 1];
    assert_true(strlen(picture) == (size_t)width * height);
    memset(mask, 77, sizeof mask);
    assert_ok(lensprof_pto_draw_mask(pto, index, mask, width, height, (ptrdiff_t)width, NULL));
    for (uint32_t i = 0; i < width * height; i++) drawn[i] = mask[i] == 1 ? '#' : mask[i] == 0 ? '.' : '?';
    drawn[width * height] = '\0';
    for (uint32_t y = 0; y < height; y++) {
        if (memcmp(drawn + y * width, picture + y * width, width) != 0) {
            print_error("image %u, row %u: %.*s, not %.*s\n", index, y, (int)width, drawn + y * width, (int)width,
                        picture + y * width);
            fail();
        }
    }
    assert_int_equal(mask[width * height], 77);
}

static void test_crop(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto("i w8 h6 S2,7,1,5\ni w8 h6 S-3,99,-3,2\ni w8 h6\ni w8 h6 S2,6,2,6\n");
    assert_drawn(pto, 0, 8, 6,
                 "........"
                 "..#####."
                 "..#####."
                 "..#####."
                 "..#####."
                 "........");
    assert_drawn(pto, 1, 8, 6,
                 "########"
                 "########"
                 "........"
                 "........"
                 "........"
                 "........");
    assert_drawn(pto, 2, 8, 6,
                 "########"
                 "########"
                 "########"
                 "########"
                 "########"
                 "########");
    assert_drawn(pto, 3, 4, 3,
                 "...."
                 ".##."
                 ".##."); /* positions 0.5, 2.5, 4.5, 6.5 of pixels 2..5 */
    assert_drawn(pto, 2, 16, 2,
                 "################"
                 "################");
    lensprof_pto_destroy(pto);
}

/* The circle touches the closer sides of the crop: radius 4 around (6, 5) of 2..10 x 1..9. */
static void test_circular_crop(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto("i w12 h10 f2 v90 S1,11,1,9\n");
    uint8_t mask[10][12];
    assert_ok(lensprof_pto_draw_mask(pto, 0, mask[0], 12, 10, 12, NULL));
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 12; x++) assert_int_equal(mask[y][x], (x - 6) * (x - 6) + (y - 5) * (y - 5) < 16);
    lensprof_pto_destroy(pto);
}

static void test_polygons(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(
        "i w8 h6\n"
        "k i0 t0 p\"1.5 0.5 4.5 0.5 4.5 3.5 1.5 3.5\"\n" /* pixels 2..4 x 1..3 */
        "k i0 t0 p\"5.5 4.5 99 4.5 99 99 5.5 99\"\n"     /* beyond the corner */
        "k i0 t0 p\"0 0 5 5\"\n");                       /* two corners enclose no area */
    assert_drawn(pto, 0, 8, 6,
                 "########"
                 "##...###"
                 "##...###"
                 "##...###"
                 "########"
                 "######..");
    lensprof_pto_destroy(pto);
    pto = read_pto(
        "i w9 h9\n"
        "k i0 t0 p\"0.5 0.5 7.5 0.5 7.5 7.5 0.5 7.5 0.5 0.5 2.5 2.5 5.5 2.5 5.5 5.5 2.5 5.5 2.5 2.5\"\n");
    assert_drawn(pto, 0, 9, 9,
                 "#########"
                 "#.......#"
                 "#.......#"
                 "#..###..#"
                 "#..###..#"
                 "#..###..#"
                 "#.......#"
                 "#.......#"
                 "#########"); /* areas enclosed twice are not excluded */
    lensprof_pto_destroy(pto);
}

/* A triangle compared with the half-plane test, at the size of the frame and in smaller and larger views. */
static void test_triangle_in_views(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto("i w40 h30\nk i0 p\"3.3 2.2 35.1 9.7 12.9 27.4\"\n");
    const double corner[3][2] = {{3.3, 2.2}, {35.1, 9.7}, {12.9, 27.4}};
    const uint32_t sizes[4][2] = {{40, 30}, {20, 15}, {13, 7}, {64, 32}};
    for (int s = 0; s < 4; s++) {
        uint32_t width = sizes[s][0], height = sizes[s][1];
        uint8_t mask[64 * 32];
        int excluded = 0;
        assert_ok(lensprof_pto_draw_mask(pto, 0, mask, width, height, width, NULL));
        for (uint32_t v = 0; v < height; v++) {
            for (uint32_t u = 0; u < width; u++) {
                double x = (u + 0.5) * 40 / width - 0.5, y = (v + 0.5) * 30 / height - 0.5;
                int inside = 1;
                for (int i = 0; i < 3; i++) {
                    const double *a = corner[i], *b = corner[(i + 1) % 3];
                    inside &= (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0;
                }
                excluded += inside;
                assert_int_equal(mask[v * width + u], !inside);
            }
        }
        assert_true(excluded > 15);
    }
    lensprof_pto_destroy(pto);
}

static void test_include(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(
        "i w8 h4 S0,7,0,4\n"
        "k i0 t1 p\"0.5 0.5 2.5 0.5 2.5 2.5 0.5 2.5\"\n"
        "k i0 t1 p\"4.5 -1 9 -1 9 9 4.5 9\"\n"
        "k i0 t0 p\"-1 1.5 9 1.5 9 2.5 -1 2.5\"\n");
    assert_drawn(pto, 0, 8, 4,
                 "#####..."
                 "#..##..."
                 "........"
                 "#####...");
    lensprof_pto_destroy(pto);
}

/* Images with linked j form a stack (Hugin writes j0 for every unlinked image), images with linked v share a lens. */
static void test_stack_and_lens(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto(
        "i w4 h1 j0\ni w4 h1 v=0 j=0\ni w4 h1 v=1 j0\ni w4 h1 j=1\ni w4 h1 v60 j1\n"
        "k i1 t2 p\"-1 -1 0.5 -1 0.5 9 -1 9\"\n"
        "k i1 t4 p\"0.5 -1 1.5 -1 1.5 9 0.5 9\"\n"
        "k i4 t3 p\"-1 -1 2.5 -1 2.5 9 -1 9\"\n");
    const char *const pictures[5] = {"..##", "..##", "#.##", ".###", "...#"};
    for (uint32_t i = 0; i < 5; i++) assert_drawn(pto, i, 4, 1, pictures[i]);
    lensprof_pto_destroy(pto);
}

static void test_rows(void **state) {
    (void)state;
    lensprof_pto *pto = read_pto("i w4 h3 S0,4,0,1\n");
    uint8_t mask[3 * 6];
    memset(mask, 9, sizeof mask);
    assert_ok(lensprof_pto_draw_mask(pto, 0, mask + 12, 4, 3, -6, NULL)); /* bottom row first in memory */
    const uint8_t expected[18] = {0, 0, 0, 0, 9, 9, 0, 0, 0, 0, 9, 9, 1, 1, 1, 1, 9, 9};
    assert_memory_equal(mask, expected, sizeof expected);
    assert_int_equal(lensprof_pto_draw_mask(pto, 0, mask, 4, 3, 3, NULL), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_pto_draw_mask(pto, 0, mask, 4, 3, -3, NULL), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_pto_draw_mask(pto, 0, mask, 0, 3, 4, NULL), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_pto_draw_mask(pto, 0, mask, 4, 0, 4, NULL), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_pto_draw_mask(pto, 1, mask, 4, 3, 4, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_draw_mask(pto, 0, NULL, 4, 3, 4, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pto_draw_mask(NULL, 0, mask, 4, 3, 4, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_memory_equal(mask, expected, sizeof expected);
    lensprof_pto_destroy(pto);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crop),     cmocka_unit_test(test_circular_crop),
        cmocka_unit_test(test_polygons), cmocka_unit_test(test_triangle_in_views),
        cmocka_unit_test(test_include),  cmocka_unit_test(test_stack_and_lens),
        cmocka_unit_test(test_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
