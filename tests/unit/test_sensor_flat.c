/* Flat fields captured on a device: surfaces that are known are found, and what they correct is even. */
#include "unit/sensor_cases.h"

enum {
    W = 400,
    H = 300,
    WORDS = 20000,
    PLANES = 4
};

static uint64_t memory[WORDS], work[WORDS];
static float gains[PLANES * 33 * 33];
static uint16_t picture[H][W];

static lensprof_image rows_at(uint32_t y, uint32_t width, uint32_t rows) {
    return (lensprof_image){picture[y], sizeof picture[0], width, rows, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
}

static lensprof_sensor_flat *begin(const lensprof_readout *readout) {
    lensprof_sensor_flat *flat;
    assert_in_range(lensprof_sensor_flat_bytes(readout), 1, sizeof memory);
    assert_ok(lensprof_sensor_flat_init(memory, sizeof memory, W, H, readout, &flat, NULL));
    assert_in_range(lensprof_sensor_flat_work_bytes(flat), 1, sizeof work);
    return flat;
}

static lensprof_readout random_readout(uint64_t *random) {
    lensprof_readout r;
    lensprof_readout_init(&r);
    assert_ok(lensprof_readout_set_mosaic(&r, sensor_colors[sensor_below(10, random)]));
    r.flip = sensor_below(4, random);
    r.columns = 2 + sensor_below(18, random), r.rows = 2 + sensor_below(14, random);
    return r;
}

/* Light of a plane, 0..1, at a place of the frame 0..1: a node's value if it is bilinear, else a falloff. */
static double light_at(uint32_t plane, double u, double v, int is_bilinear) {
    if (is_bilinear) return (0.9 - 0.3 * u) * (0.95 - 0.2 * v) * (1.0 - 0.1 * plane);
    const double r2 = (u - 0.52) * (u - 0.52) + (v - 0.47) * (v - 0.47);
    return (0.9 - 0.6 * r2 - 0.2 * r2 * r2) * (1.0 - 0.1 * plane * r2);
}

static void render(const lensprof_readout *r, int is_bilinear, double black, double white, double noise,
                   uint64_t *random) {
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            const double u = (r->flip & 1 ? W - 1 - x : x) / (W - 1.0), v = (r->flip & 2 ? H - 1 - y : y) / (H - 1.0);
            const uint32_t plane = r->plane[y % r->side * r->side + x % r->side];
            const double light = light_at(plane, u, v, is_bilinear) + noise * (lp_random(random) - 0.5);
            picture[y][x] = (uint16_t)floor(black + light * (white - black) + lp_random(random));
        }
}

static uint32_t planes_of(const lensprof_readout *r) {
    uint32_t planes = 0;
    for (uint32_t i = 0; i < r->side * r->side; i++) planes = r->plane[i] >= planes ? r->plane[i] + 1u : planes;
    return planes;
}

/* A surface that the grid can represent is found to a hundredth of a code or so, in tiles, over two pictures. */
static void test_surfaces_are_found(void **state) {
    (void)state;
    uint64_t random = 3;
    for (int n = 0; n < 40; n++) {
        lensprof_readout r = random_readout(&random);
        const double black = n % 2 ? 1000.0 : 0.0;
        const lensprof_sensor_levels levels = {{black, black, black, black}, 65000.0};
        r.levels = &levels;
        lensprof_sensor_flat *flat = begin(&r);
        for (int shot = 0; shot < 2; shot++) {
            render(&r, 1, black, 65000.0, 0.0, &random);
            for (uint32_t y = 0; y < H; y += 7) {
                const uint32_t rows = H - y < 7 ? H - y : 7, cut = 1 + sensor_below(W - 1, &random);
                const lensprof_image left = rows_at(y, cut, rows);
                lensprof_image right = rows_at(y, W - cut, rows);
                right.data = &picture[y][cut];
                assert_ok(lensprof_sensor_flat_add(flat, &right, cut, y));
                assert_ok(lensprof_sensor_flat_add(flat, &left, 0, y));
            }
        }
        assert_ok(lensprof_sensor_flat_gains(flat, work, sizeof work, gains, NULL));
        for (uint32_t p = 0; p < planes_of(&r); p++)
            for (uint32_t j = 0; j < r.rows; j++)
                for (uint32_t i = 0; i < r.columns; i++) {
                    const double wanted =
                        light_at(p, 0, 0, 1) / light_at(p, i / (r.columns - 1.0), j / (r.rows - 1.0), 1);
                    assert_close(gains[(p * r.rows + j) * r.columns + i], wanted, 5e-4);
                }
    }
}

/* A falloff, with noise: the captured gains make the picture even. */
static void test_what_is_captured_corrects(void **state) {
    (void)state;
    static uint32_t plan_memory[SENSOR_WORDS];
    uint64_t random = 5;
    for (int n = 0; n < 12; n++) {
        lensprof_readout r = random_readout(&random);
        const lensprof_sensor_levels levels = {{64, 64, 64, 64}, 4095};
        r.columns = 33, r.rows = 25, r.levels = &levels;
        render(&r, 0, 64.0, 4095.0, 0.002, &random);
        lensprof_sensor_flat *flat = begin(&r);
        const lensprof_image whole = rows_at(0, W, H);
        for (int shot = 0; shot < 3; shot++) assert_ok(lensprof_sensor_flat_add(flat, &whole, 0, 0));
        assert_ok(lensprof_sensor_flat_gains(flat, work, sizeof work, gains, NULL));
        lensprof_profile profile;
        lensprof_apply_options options;
        const lensprof_sensor_plan *plan;
        lensprof_profile_init(&profile);
        lensprof_apply_options_init(&options);
        assert_ok(lensprof_apply_options_set_profile(&options, &profile));
        options.frame_width = W, options.frame_height = H;
        r.gains = gains;
        assert_ok(lensprof_sensor_plan_init(plan_memory, sizeof plan_memory, &options, &r, &plan, NULL));
        render(&r, 0, 64.0, 4095.0, 0.0, &random);
        const lensprof_target to = {picture, sizeof picture[0], W, H, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
        assert_ok(lensprof_sensor_apply(plan, NULL, &to, 0, 0));
        double least[PLANES] = {1e9, 1e9, 1e9, 1e9}, most[PLANES] = {0.0};
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) {
                const uint32_t plane = r.plane[y % r.side * r.side + x % r.side];
                least[plane] = fmin(least[plane], picture[y][x]), most[plane] = fmax(most[plane], picture[y][x]);
            }
        for (uint32_t p = 0; p < planes_of(&r); p++) assert_true(most[p] - least[p] < 0.007 * (most[p] - 64.0));
    }
}

static void test_flat_fields_that_are_refused(void **state) {
    (void)state;
    uint64_t random = 7;
    lensprof_readout r;
    lensprof_readout_init(&r);
    const lensprof_sensor_levels levels = {{64, 64, 64, 64}, 4095};
    r.levels = &levels;
    const lensprof_image whole = rows_at(0, W, H), most = rows_at(0, W, H - 1);
    static float before[PLANES * 33 * 33];
    memset(gains, 7, sizeof gains), memcpy(before, gains, sizeof gains);
#define REFUSED(words)                                                                       \
    do {                                                                                     \
        lensprof_error error = {{0}, {0}};                                                   \
        assert_int_equal(lensprof_sensor_flat_gains(flat, work, sizeof work, gains, &error), \
                         LENSPROF_ERROR_NO_SAMPLES);                                         \
        if (!strstr(error.text, words)) fail_msg("%s", error.text);                          \
        assert_memory_equal(gains, before, sizeof gains);                                    \
    } while (0)
    lensprof_sensor_flat *flat = begin(&r);
    REFUSED("missing");
    render(&r, 0, 64.0, 4095.0, 0.0, &random);
    assert_ok(lensprof_sensor_flat_add(flat, &most, 0, 0));
    REFUSED("missing");
    flat = begin(&r); /* as many samples as a picture has, of the upper half twice */
    const lensprof_image half = rows_at(0, W, H / 2);
    for (int shot = 0; shot < 2; shot++) assert_ok(lensprof_sensor_flat_add(flat, &half, 0, 0));
    REFUSED("missing");
    flat = begin(&r); /* a row instead of another */
    for (uint32_t y = 0; y < H; y++) {
        const lensprof_image one = rows_at(y, W, 1);
        assert_ok(lensprof_sensor_flat_add(flat, &one, 0, y == 30 ? 33 : y));
    }
    REFUSED("missing");
    flat = begin(&r);
    for (uint32_t x = 0; x < W; x++) picture[3][x] = 4095;
    assert_ok(lensprof_sensor_flat_add(flat, &whole, 0, 0));
    REFUSED("saturated");
    flat = begin(&r);
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) picture[y][x] = 70;
    assert_ok(lensprof_sensor_flat_add(flat, &whole, 0, 0));
    REFUSED("dark");
    flat = begin(&r);
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) picture[y][x] = x < W / 2 ? 2000 : 64;
    assert_ok(lensprof_sensor_flat_add(flat, &whole, 0, 0));
    REFUSED("black");
    r.x = 100, r.width = 200;
    flat = begin(&r);
    const lensprof_image window = rows_at(0, 200, H);
    assert_ok(lensprof_sensor_flat_add(flat, &window, 0, 0));
    REFUSED("window");
    assert_int_equal(lensprof_sensor_flat_gains(flat, work, 100, gains, NULL), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_sensor_flat_gains(NULL, work, sizeof work, gains, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_sensor_flat_add(flat, &whole, 0, 0), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_sensor_flat_add(flat, NULL, 0, 0), LENSPROF_ERROR_ARGUMENT);
    for (int shot = 1; shot < 256; shot++) assert_ok(lensprof_sensor_flat_add(flat, &window, 0, 0));
    assert_int_equal(lensprof_sensor_flat_add(flat, &window, 0, 0), LENSPROF_ERROR_CAPACITY);
}

static void test_copies_are_opened(void **state) {
    (void)state;
    static uint64_t copy[WORDS];
    uint64_t random = 9;
    lensprof_readout r = random_readout(&random);
    lensprof_sensor_flat *flat = begin(&r), *opened = NULL;
    render(&r, 0, 0.0, 60000.0, 0.0, &random);
    const lensprof_image whole = rows_at(0, W, H);
    assert_ok(lensprof_sensor_flat_add(flat, &whole, 0, 0));
    const size_t bytes = lensprof_sensor_flat_bytes(&r);
    memcpy(copy, flat, bytes);
    assert_ok(lensprof_sensor_flat_open(copy, bytes, &opened));
    static float wanted[PLANES * 33 * 33];
    assert_ok(lensprof_sensor_flat_gains(flat, work, sizeof work, wanted, NULL));
    assert_ok(lensprof_sensor_flat_gains(opened, work, sizeof work, gains, NULL));
    assert_memory_equal(gains, wanted, planes_of(&r) * r.columns * r.rows * sizeof *gains);
    assert_int_equal(lensprof_sensor_flat_open(copy, bytes - 1, &opened), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_sensor_flat_open(NULL, bytes, &opened), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_sensor_flat_open((uint8_t *)copy + 4, bytes, &opened), LENSPROF_ERROR_ARGUMENT);
    for (int n = 0; n < 5000; n++) { /* whatever opens is safe to add to and to fit (checked by the sanitizers) */
        memcpy(copy, flat, bytes);
        ((uint8_t *)copy)[sensor_below(n % 2 ? 160 : (uint32_t)bytes, &random)] = (uint8_t)(256 * lp_random(&random));
        if (lensprof_sensor_flat_open(copy, bytes, &opened) != LENSPROF_OK) continue;
        lensprof_image row = rows_at(0, 1, 1);
        (void)!lensprof_sensor_flat_add(opened, &row, sensor_below(W, &random), sensor_below(H, &random));
        if (lensprof_sensor_flat_work_bytes(opened) <= sizeof work && n % 20 == 0)
            (void)!lensprof_sensor_flat_gains(opened, work, sizeof work, gains, NULL);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_surfaces_are_found),
        cmocka_unit_test(test_what_is_captured_corrects),
        cmocka_unit_test(test_flat_fields_that_are_refused),
        cmocka_unit_test(test_copies_are_opened),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
