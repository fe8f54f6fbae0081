/* Grids of gains for raw sensors, compared with double precision, with flipped and cut pictures, and with rows. */
#include "unit/sensor_cases.h"

#include "campaign.h"

#include <core/sensor.h>

static lensprof_image view_of(const uint16_t *samples, uint32_t width, uint32_t height) {
    return (lensprof_image){samples, SENSOR_WIDTH * 2, width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
}

static lensprof_target target_of(uint16_t *samples, uint32_t width, uint32_t height) {
    return (lensprof_target){samples, SENSOR_WIDTH * 2, width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
}

static void apply_case(sensor_case *c) {
    const lensprof_image from = view_of(c->in[0], SENSOR_WIDTH, SENSOR_ROWS);
    const lensprof_target to = target_of(c->out[0], SENSOR_WIDTH, SENSOR_ROWS);
    assert_ok(lensprof_sensor_apply(c->plan, &from, &to, c->x0, c->y0));
}

static void test_codes_are_within_one_of_double_precision(void **state) {
    (void)state;
    static sensor_case c;
    uint64_t random = 5, count = 0, same = 0;
    const int runs = campaign_runs(1500);
    for (int n = 0; n < runs; n++) {
        const lensprof_sensor_plan *opened;
        make_sensor(&c, &random);
        assert_ok(lensprof_sensor_plan_open(c.memory, c.plan->bytes, &opened));
        apply_case(&c);
        for (uint32_t y = 0; y < SENSOR_ROWS; y++)
            for (uint32_t x = 0; x < SENSOR_WIDTH; x++, count++) {
                const int wanted = sensor_wanted(&c, c.in[y][x], c.x0 + x, c.y0 + y);
                if (abs(c.out[y][x] - wanted) > 1)
                    fail_msg("run %d, sample %u, %u: %u becomes %u, not %d", n, c.x0 + x, c.y0 + y, c.in[y][x],
                             c.out[y][x], wanted);
                same += c.out[y][x] == wanted;
            }
    }
    printf("%d sensors: %.4f %% of the samples are the same\n", runs, 100.0 * (double)same / (double)count);
    assert_true(same > 0.999 * (double)count);
}

/* The example of a 12 bit sensor with a pedestal: black stays black, nothing exceeds white. */
static void test_pedestal_stays(void **state) {
    (void)state;
    static uint32_t memory[SENSOR_WORDS];
    const lensprof_sensor_levels levels = {{256, 256, 256, 256}, 4095};
    lensprof_profile profile;
    lensprof_apply_options options;
    lensprof_readout readout;
    const lensprof_sensor_plan *plan;
    lensprof_profile_init(&profile);
    profile.vignetting[0] = (lensprof_vignetting){{-0.5, 0.0, 0.0}, {0.0, 0.0}};
    lensprof_apply_options_init(&options);
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    options.frame_width = 640, options.frame_height = 480;
    lensprof_readout_init(&readout);
    assert_ok(lensprof_readout_set_mosaic(&readout, "RGGB"));
    readout.levels = &levels;
    assert_ok(lensprof_sensor_plan_init(memory, sizeof memory, &options, &readout, &plan, NULL));
    uint16_t row[8] = {256, 256, 3800, 3800, 0, 1256, 4095, 200};
    const lensprof_target corner = target_of(row, 8, 1);
    assert_ok(lensprof_sensor_apply(plan, NULL, &corner, 0, 0)); /* the light there is doubled */
    static const uint16_t least[8] = {256, 256, 4095, 4095, 0, 2170, 4095, 144};
    static const uint16_t most[8] = {256, 256, 4095, 4095, 0, 2256, 4095, 149};
    for (int x = 0; x < 8; x++)
        if (row[x] < least[x] || row[x] > most[x]) fail_msg("sample %d: %u", x, row[x]);
    /* Black is not put back. */
    const lensprof_sensor_levels without = {{0, 0, 0, 0}, 4095 - 256};
    readout.output_levels = &without;
    assert_ok(lensprof_sensor_plan_init(memory, sizeof memory, &options, &readout, &plan, NULL));
    uint16_t again[8] = {256, 255, 3800, 256, 256, 256, 256, 256};
    const lensprof_target same_corner = target_of(again, 8, 1);
    assert_ok(lensprof_sensor_apply(plan, NULL, &same_corner, 0, 0));
    assert_int_equal(again[0], 0);
    assert_int_equal(again[1], 0);
    assert_int_equal(again[2], 4095 - 256);
}

/* A grey ramp up to saturation, white balance and exposure changed: where it is clipped, all planes have one code. */
static void test_clipped_highlights_are_neutral(void **state) {
    (void)state;
    static sensor_case c;
    uint64_t random = 11;
    int clipped = 0;
    const int runs = campaign_runs(300);
    for (int n = 0; n < runs; n++) {
        make_sensor(&c, &random);
        c.m.options.direction = LENSPROF_DIRECTION_CORRECT;
        c.m.options.saturated = LENSPROF_SATURATED_NEUTRAL;
        c.levels[0] = (lensprof_sensor_levels){{64, 64, 64, 64}, 1023};
        c.readout.levels = &c.levels[0], c.readout.output_levels = NULL;
        make_sensor_plan(&c);
        if (c.plan->grid.planes == 1) continue; /* no colour */
        for (uint32_t y = 0; y < SENSOR_ROWS; y++)
            for (uint32_t x = 0; x < SENSOR_WIDTH; x++) c.in[y][x] = 1023;
        apply_case(&c);
        for (uint32_t y = 0; y < SENSOR_ROWS; y++)
            for (uint32_t x = 0; x < SENSOR_WIDTH; x++) assert_int_equal(c.out[y][x], c.out[0][0]);
        assert_int_equal(c.out[0][0], c.plan->largest[0]);
        clipped += c.out[0][0] < 1023;
    }
    assert_true(clipped > runs / 10); /* in others every gain is at least 1 */
}

/* Any order of tiles of any shape, in place and from buffer to buffer, gives the bytes of the whole. */
static void test_tiles_have_the_bytes_of_the_whole(void **state) {
    (void)state;
    static sensor_case c;
    static uint16_t tile[SENSOR_ROWS][SENSOR_WIDTH];
    uint64_t random = 17;
    const int runs = campaign_runs(300);
    for (int n = 0; n < runs; n++) {
        make_sensor(&c, &random);
        apply_case(&c);
        for (int t = 0; t < 20; t++) {
            const uint32_t x = sensor_below(SENSOR_WIDTH, &random), y = sensor_below(SENSOR_ROWS, &random);
            const uint32_t width = 1 + sensor_below(SENSOR_WIDTH - x, &random);
            const uint32_t height = 1 + sensor_below(SENSOR_ROWS - y, &random);
            memcpy(tile, c.in, sizeof tile);
            const lensprof_image from = view_of(&c.in[y][x], width, height);
            const lensprof_target to = target_of(&tile[y][x], width, height);
            assert_ok(lensprof_sensor_apply(c.plan, t % 2 ? &from : NULL, &to, c.x0 + x, c.y0 + y));
            for (uint32_t j = 0; j < height; j++) assert_memory_equal(&tile[y + j][x], &c.out[y + j][x], 2 * width);
            if (x) assert_int_equal(tile[y][x - 1], c.in[y][x - 1]);
            if (x + width < SENSOR_WIDTH) assert_int_equal(tile[y][x + width], c.in[y][x + width]);
        }
    }
}

/* What a flipped sensor reads, corrected, is the corrected frame, flipped; and a window is a part of it. */
static void test_flips_and_windows(void **state) {
    (void)state;
    enum {
        W = 150,
        H = 120
    };
    static sensor_case c;
    static uint16_t frame[H][SENSOR_WIDTH], read[H][SENSOR_WIDTH];
    uint64_t random = 19;
    const int runs = campaign_runs(200);
    for (int n = 0; n < runs; n++) {
        make_sensor(&c, &random);
        lensprof_readout *r = &c.readout;
        assert_ok(lensprof_readout_set_mosaic(r, "G")); /* a mosaic would change its order */
        c.m.options.frame_width = W, c.m.options.frame_height = H;
        r->x = r->y = r->flip = r->width = r->height = 0, r->step = 1;
        make_sensor_plan(&c);
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) frame[y][x] = (uint16_t)(1000 * lp_random(&random));
        const lensprof_image whole = view_of(frame[0], W, H);
        static uint16_t corrected[H][SENSOR_WIDTH];
        const lensprof_target to = target_of(corrected[0], W, H);
        assert_ok(lensprof_sensor_apply(c.plan, &whole, &to, 0, 0));
        r->flip = 1 + (uint32_t)n % 3;
        r->x = sensor_below(30, &random), r->y = sensor_below(30, &random);
        r->width = 60, r->height = 50;
        make_sensor_plan(&c);
        for (uint32_t y = 0; y < 50; y++)
            for (uint32_t x = 0; x < 60; x++)
                read[y][x] = frame[r->flip & 2 ? r->y + 49 - y : r->y + y][r->flip & 1 ? r->x + 59 - x : r->x + x];
        const lensprof_target window = target_of(read[0], 60, 50);
        assert_ok(lensprof_sensor_apply(c.plan, NULL, &window, 0, 0));
        for (uint32_t y = 0; y < 50; y++)
            for (uint32_t x = 0; x < 60; x++) { /* gains are added up from the other end: the last bit may differ */
                const int wanted =
                    corrected[r->flip & 2 ? r->y + 49 - y : r->y + y][r->flip & 1 ? r->x + 59 - x : r->x + x];
                if (abs(read[y][x] - wanted) > 1) fail_msg("%u, %u: %u, not %d", x, y, read[y][x], wanted);
            }
    }
}

/* Packed rows are unpacked, corrected and packed. */
static void test_packed_rows(void **state) {
    (void)state;
    static const uint32_t packings[] = {LENSPROF_PACKING_RAW8, LENSPROF_PACKING_RAW10, LENSPROF_PACKING_RAW12,
                                        LENSPROF_PACKING_RAW14};
    static sensor_case c;
    static uint8_t packed[2 * SENSOR_WIDTH], wanted[2 * SENSOR_WIDTH];
    uint64_t random = 23;
    const int runs = campaign_runs(400);
    for (int n = 0; n < runs; n++) {
        const uint32_t packing = packings[n % 4], width = 4 + 4 * sensor_below(SENSOR_WIDTH / 4, &random);
        make_sensor(&c, &random);
        for (uint32_t x = 0; x < width; x++) c.in[0][x] &= (uint16_t)((1u << packing) - 1);
        assert_ok(lensprof_pack_row(packing, c.in[0], width, packed));
        const lensprof_image from = view_of(c.in[0], width, 1);
        const lensprof_target to = target_of(c.out[0], width, 1);
        assert_ok(lensprof_sensor_apply(c.plan, &from, &to, c.x0, c.y0));
        assert_ok(lensprof_pack_row(packing, c.out[0], width, wanted));
        const size_t bytes = lensprof_packed_row_bytes(packing, width);
        const lensprof_packed_target row = {packed, (ptrdiff_t)bytes, width, 1};
        assert_ok(lensprof_sensor_apply_packed(c.plan, packing, NULL, &row, c.x0, c.y0));
        assert_memory_equal(packed, wanted, bytes);
    }
}

/* Between two plans every gain is between theirs, and at the ends it is theirs. */
static void test_plans_between_two(void **state) {
    (void)state;
    static sensor_case a, b;
    static uint32_t memory[SENSOR_WORDS];
    const lensprof_sensor_plan *plan;
    uint64_t random = 29;
    for (int n = 0; n < 100; n++) {
        make_sensor(&a, &random);
        b = a;
        b.m.options.response = b.m.response, b.m.options.grid = NULL;
        b.m.options.vignetting = b.m.vignetting, b.m.options.output_response = NULL, b.m.options.output_responses = 0;
        for (int i = 0; i < 3; i++) b.m.vignetting[i].k[0] -= 0.02;
        b.m.options.source.ev += 1.5 * (lp_random(&random) - 0.5); /* another shift */
        if (b.readout.gains) b.readout.gains = b.gains;
        if (b.readout.levels) b.readout.levels = &b.levels[0];
        if (b.readout.output_levels) b.readout.output_levels = &b.levels[1];
        make_sensor_plan(&b);
        const uint32_t share = n == 0 ? 0 : n == 1 ? 65536 : sensor_below(65537, &random);
        assert_ok(lensprof_sensor_plan_mix(memory, sizeof memory, a.plan, b.plan, share, &plan));
        const lensprof_sensor_plan *opened;
        assert_ok(lensprof_sensor_plan_open(memory, sizeof memory, &opened));
        const uint32_t count = lp_sensor_grid_nodes(&plan->grid);
        for (uint32_t i = 0; i < plan->grid.planes * count; i++) {
            const uint32_t p = i / count;
            const double of_a = ldexp(lp_sensor_nodes(a.plan, 0)[i], -a.plan->shift[p]);
            const double of_b = ldexp(lp_sensor_nodes(b.plan, 0)[i], -b.plan->shift[p]);
            const double wanted = of_a + (of_b - of_a) * share / 65536.0;
            assert_close(ldexp(lp_sensor_nodes(plan, 0)[i], -plan->shift[p]), wanted, ldexp(3.0, -plan->shift[p]));
        }
        if (share == 0 && !memcmp(plan->shift, a.plan->shift, 4)) assert_memory_equal(memory, a.memory, plan->bytes);
    }
    b = a;
    b.levels[0] = (lensprof_sensor_levels){{64, 64, 64, 64}, 1023}, b.readout.levels = &b.levels[0];
    b.readout.output_levels = NULL, b.readout.gains = NULL;
    make_sensor_plan(&b);
    a = b;
    b.levels[0].white = 4095; /* the same black */
    make_sensor_plan(&b);
    a.plan = (const lensprof_sensor_plan *)(const void *)a.memory;
    assert_int_equal(lensprof_sensor_plan_mix(memory, sizeof memory, a.plan, b.plan, 5, &plan),
                     LENSPROF_ERROR_ARGUMENT);
    b = a;
    b.readout.levels = &b.levels[0];
    b.readout.flip ^= 1;
    make_sensor_plan(&b);
    memset(memory, 7, sizeof memory);
    assert_int_equal(lensprof_sensor_plan_mix(memory, sizeof memory, a.plan, b.plan, 5, &plan),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_sensor_plan_mix(memory, sizeof memory, a.plan, a.plan, 65537, &plan),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_sensor_plan_mix(memory, 100, a.plan, a.plan, 5, &plan), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_sensor_plan_mix(NULL, 100, a.plan, a.plan, 5, &plan), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(memory[0], 0x07070707);
}

static void test_share_of_a_temperature(void **state) {
    (void)state;
    assert_int_equal(lensprof_mired_share(2850, 6500, 2850), 0);
    assert_int_equal(lensprof_mired_share(2850, 6500, 6500), 65536);
    assert_int_equal(lensprof_mired_share(2850, 6500, 2000), 0);
    assert_int_equal(lensprof_mired_share(2850, 6500, 9000), 65536);
    assert_int_equal(lensprof_mired_share(6500, 2850, 9000), 0);
    assert_int_equal(lensprof_mired_share(6500, 2850, 2000), 65536);
    assert_int_equal(lensprof_mired_share(5000, 5000, 4000), 0);
    assert_int_equal(lensprof_mired_share(0, UINT32_MAX, UINT32_MAX), 65536);
    for (uint32_t k = 2850; k <= 6500; k += 50) {
        const double wanted = 65536.0 * (1e6 / 2850 - 1e6 / k) / (1e6 / 2850 - 1e6 / 6500);
        assert_close(lensprof_mired_share(2850, 6500, k), wanted, 1.0);
        assert_close(lensprof_mired_share(6500, 2850, k), 65536.0 - wanted, 1.0);
    }
}

/* The stated error is that of any sample, nearly; a finer grid has less. */
static void test_stated_error(void **state) {
    (void)state;
    static sensor_case c;
    uint64_t random = 31;
    const int runs = campaign_runs(60);
    for (int n = 0; n < runs; n++) {
        make_sensor(&c, &random);
        c.m.options.grid = NULL, c.readout.gains = NULL, c.m.options.gain_cap = 0.0;
        c.readout.columns = c.readout.rows = 9;
        make_sensor_plan(&c);
        double stated, finer, largest = 0.0;
        assert_ok(lensprof_sensor_plan_error(c.plan, &c.m.options, &c.readout, &stated));
        for (int i = 0; i < 3000; i++) {
            const uint32_t x = sensor_below(c.readout.width, &random), y = sensor_below(c.readout.height, &random);
            const char letter = letter_at(&c, x, y);
            const double is = grid_gain(&c, letter, x, y);
            const double pixel_x = pixel_at(c.readout.x, c.readout.width, c.readout.step, c.readout.flip & 1, x);
            const double pixel_y = pixel_at(c.readout.y, c.readout.height, c.readout.step, c.readout.flip & 2, y);
            largest = fmax(largest, fabs(is / model_gain(&c, letter, pixel_x, pixel_y) - 1.0));
        }
        assert_true(largest <= 1.05 * stated + 1e-5);
        assert_true(largest >= 0.7 * stated - 1e-5);
        c.readout.columns = c.readout.rows = 17;
        make_sensor_plan(&c);
        assert_ok(lensprof_sensor_plan_error(c.plan, &c.m.options, &c.readout, &finer));
        assert_true(finer < 0.5 * stated + 1e-6); /* h^2: about a quarter */
        c.readout.rows = 16;
        assert_int_equal(lensprof_sensor_plan_error(c.plan, &c.m.options, &c.readout, &finer), LENSPROF_ERROR_ARGUMENT);
    }
}

/* Each option of apply.h does what it does there: a fine grid is compared with plans in floating point. */
static void test_options_are_those_of_plans(void **state) {
    (void)state;
    static sensor_case c;
    static uint64_t memory[1 << 14];
    static uint16_t wanted[SENSOR_ROWS][SENSOR_WIDTH];
    uint64_t random = 53;
    int chroma = 0;
    const int runs = campaign_runs(200);
    for (int n = 0; n < runs; n++) {
        lensprof_apply_options *o = &c.m.options;
        const lensprof_plan *plan;
        make_sensor(&c, &random);
        assert_ok(lensprof_readout_set_mosaic(&c.readout, n % 3 ? "GRBG" : "G"));
        c.colors = n % 3 ? "GRBG" : "G";
        o->grid = NULL, o->levels = o->output_levels = NULL, o->gain_cap = 0.0, o->output_response = NULL;
        o->output_responses = 0, o->saturated = LENSPROF_SATURATED_AS_VALUE;
        o->chroma = n % 2;
        o->source_sample = o->target_sample = LENSPROF_SAMPLE_U16;
        o->source_layout = n % 3 ? LENSPROF_LAYOUT_GRBG : LENSPROF_LAYOUT_GREY;
        c.readout.x = c.readout.y = c.readout.flip = c.readout.width = c.readout.height = 0, c.readout.step = 1;
        c.readout.gains = NULL, c.readout.levels = c.readout.output_levels = NULL;
        c.readout.columns = c.readout.rows = 33;
        make_sensor_plan(&c);
        double error;
        assert_ok(lensprof_sensor_plan_error(c.plan, o, &c.readout, &error));
        for (uint32_t y = 0; y < SENSOR_ROWS; y++)
            for (uint32_t x = 0; x < SENSOR_WIDTH; x++) c.in[y][x] = (uint16_t)(20000.0 * lp_random(&random));
        apply_case(&c);
        assert_ok(lensprof_plan_init(memory, sizeof memory, o, &plan, NULL));
        lensprof_image from = view_of(c.in[0], SENSOR_WIDTH, SENSOR_ROWS);
        lensprof_target to = target_of(wanted[0], SENSOR_WIDTH, SENSOR_ROWS);
        from.layout = to.layout = o->source_layout;
        assert_ok(lensprof_apply(plan, &from, &to, c.x0, c.y0));
        for (uint32_t y = 0; y < SENSOR_ROWS; y++)
            for (uint32_t x = 0; x < SENSOR_WIDTH; x++) {
                if (abs(c.out[y][x] - wanted[y][x]) > 1.5 + 1.2 * error * wanted[y][x])
                    fail_msg("run %d: %u becomes %u, not %u; error of the grid %g", n, c.in[y][x], c.out[y][x],
                             wanted[y][x], error);
                chroma += o->chroma && c.out[y][x] != c.in[y][x];
            }
    }
    assert_true(chroma > 5 * runs);
}

/* Levels and exposures of the options count for the readout. */
static void test_levels_of_the_profile(void **state) {
    (void)state;
    static uint32_t memory[2][SENSOR_WORDS];
    const lensprof_sensor_levels levels = {{256, 300, 256, 0}, 4095};
    const lensprof_levels shares = {{256 / 65535.0, 256 / 65535.0, 300 / 65535.0}, 4095 / 65535.0};
    lensprof_profile profile;
    lensprof_apply_options options;
    lensprof_readout readout;
    const lensprof_sensor_plan *plan;
    lensprof_profile_init(&profile);
    lensprof_apply_options_init(&options);
    assert_ok(lensprof_apply_options_set_profile(&options, &profile));
    options.frame_width = 640, options.frame_height = 480;
    lensprof_readout_init(&readout);
    assert_ok(lensprof_readout_set_mosaic(&readout, "GRBG"));
    options.levels = options.output_levels = &shares;
    assert_ok(lensprof_sensor_plan_init(memory[0], sizeof memory[0], &options, &readout, &plan, NULL));
    assert_int_equal(plan->black_in[2], 300 << LP_SENSOR_LEVEL_SHIFT); /* planes R, G, B */
    options.levels = options.output_levels = NULL;
    const lensprof_sensor_levels same = {{256, 256, 300, 256}, 4095};
    readout.levels = &same;
    assert_ok(lensprof_sensor_plan_init(memory[1], sizeof memory[1], &options, &readout, &plan, NULL));
    assert_memory_equal(memory[0], memory[1], plan->bytes);
    readout.levels = &levels;
    assert_ok(lensprof_sensor_plan_init(memory[1], sizeof memory[1], &options, &readout, &plan, NULL));
    assert_int_equal(plan->black_in[1], 300 << LP_SENSOR_LEVEL_SHIFT);
}

/* ---- bad input ---- */

static void test_mosaics_that_are_refused(void **state) {
    (void)state;
    lensprof_readout readout, before;
    lensprof_readout_init(&readout);
    before = readout;
    assert_int_equal(lensprof_readout_set_mosaic(&readout, "RGB"), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_readout_set_mosaic(&readout, ""), LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_readout_set_mosaic(&readout, "RGGX"), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_readout_set_mosaic(&readout, "RGgBIRGgBIRGgBIR"), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_readout_set_mosaic(&readout, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_readout_set_mosaic(NULL, "G"), LENSPROF_ERROR_ARGUMENT);
    assert_memory_equal(&readout, &before, sizeof before);
    readout.struct_size = 5;
    assert_int_equal(lensprof_readout_set_mosaic(&readout, "G"), LENSPROF_ERROR_STRUCT_SIZE);
}

static void test_plans_that_are_refused(void **state) {
    (void)state;
    static sensor_case c, was;
    static uint32_t before[SENSOR_WORDS];
    uint64_t random = 37;
    make_sensor(&c, &random);
    c.m.options.frame_width = 2000, c.m.options.frame_height = 1500;
    c.readout.x = c.readout.y = 8, c.readout.step = 1, c.readout.width = 1000, c.readout.height = 1000;
    c.readout.levels = &c.levels[0], c.readout.output_levels = &c.levels[1];
    c.readout.gains = c.gains;
    for (uint32_t i = 0; i < 4 * 33 * 33; i++) c.gains[i] = 1.5f;
    make_sensor_plan(&c);
    was = c;
    memcpy(before, c.memory, sizeof before);
#define BAD(expected, change)                                                                                  \
    do {                                                                                                       \
        lensprof_error error = {{0}, {0}};                                                                     \
        size_t size = sizeof c.memory;                                                                         \
        change;                                                                                                \
        assert_int_equal(lensprof_sensor_plan_init(c.memory, size, &c.m.options, &c.readout, &c.plan, &error), \
                         expected);                                                                            \
        assert_true(error.text[0] != '\0');                                                                    \
        assert_memory_equal(c.memory, before, sizeof before);                                                  \
        c.m.options = was.m.options, c.readout = was.readout;                                                  \
        memcpy(c.levels, was.levels, sizeof c.levels), memcpy(c.gains, was.gains, sizeof c.gains);             \
    } while (0)
    lensprof_image_circle circle = {{0.0, 0.0}, 0.5};
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[0].white = 0.0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[0].white = -1.0; c.levels[0].black[0] = -100.0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[0].white = 65536.0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[0].white = (double)NAN);
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[0].black[3] = c.levels[0].white);
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[1].black[2] = 65535.0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[1].black[2] = -40000.0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.levels[0].black[0] = (double)NAN);
    BAD(LENSPROF_ERROR_VIGNETTING, c.gains[3] = 0.0f);
    BAD(LENSPROF_ERROR_VIGNETTING, c.gains[0] = -1.0f);
    BAD(LENSPROF_ERROR_VIGNETTING, c.gains[2] = 2000.0f);
    BAD(LENSPROF_ERROR_VIGNETTING, c.gains[1] = (float)NAN);
    BAD(LENSPROF_ERROR_SIZE, c.readout.columns = 34);
    BAD(LENSPROF_ERROR_SIZE, c.readout.rows = 1);
    BAD(LENSPROF_ERROR_SIZE, c.readout.columns = 0);
    BAD(LENSPROF_ERROR_SIZE, c.m.options.frame_width = 65536);
    BAD(LENSPROF_ERROR_SIZE, c.m.options.frame_height = 1007); /* the window ends at 1008 */
    BAD(LENSPROF_ERROR_SIZE, c.readout.x = 2000; c.readout.width = 0);
    BAD(LENSPROF_ERROR_SIZE, c.readout.step = 2); /* 2008 pixels */
    BAD(LENSPROF_ERROR_SIZE, c.readout.side = 4; c.readout.width = c.readout.height = 16; c.readout.columns = 33;
        c.m.options.frame_width = 128); /* cells of less than a pattern */
    BAD(LENSPROF_ERROR_SIZE, c.readout.side = 1; c.readout.columns = 2; c.m.options.frame_width = 60000);
    BAD(LENSPROF_ERROR_ARGUMENT, c.readout.side = 3);
    BAD(LENSPROF_ERROR_ARGUMENT, c.readout.side = 0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.readout.plane[0] = 4);
    BAD(LENSPROF_ERROR_ARGUMENT, c.readout.channel[0] = 3);
    BAD(LENSPROF_ERROR_ARGUMENT, c.readout.step = 0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.readout.step = 17);
    BAD(LENSPROF_ERROR_ARGUMENT, c.readout.flip = 4);
    BAD(LENSPROF_ERROR_STRUCT_SIZE, c.readout.struct_size = 0);
    BAD(LENSPROF_ERROR_STRUCT_SIZE, c.m.options.struct_size = 0);
    BAD(LENSPROF_ERROR_CAPACITY, size = lensprof_sensor_plan_bytes(&c.readout) - 1);
    BAD(LENSPROF_ERROR_UNSUPPORTED, c.m.options.image_circle = &circle);
    BAD(LENSPROF_ERROR_UNSUPPORTED, c.m.options.dither = 1);
    assert_ok(lensprof_response_set_gamma(&c.m.response[0], 2.2));
    BAD(LENSPROF_ERROR_UNSUPPORTED, c.m.options.input = LENSPROF_ENCODING_RESPONSE);
    BAD(LENSPROF_ERROR_EXPOSURE, c.m.options.source.ev = 100.0);
    BAD(LENSPROF_ERROR_ARGUMENT, c.m.options.strength = 2.0);
    BAD(LENSPROF_ERROR_UNSUPPORTED, c.m.options.target.ev = 14.0; c.m.options.direction = LENSPROF_DIRECTION_CORRECT);
    assert_int_equal(lensprof_sensor_plan_bytes(NULL), 0);
}

static void test_tiles_that_are_refused(void **state) {
    (void)state;
    static sensor_case c;
    static uint16_t before[SENSOR_ROWS][SENSOR_WIDTH];
    uint64_t random = 41;
    make_sensor(&c, &random);
    memcpy(before, c.in, sizeof before);
    const lensprof_image apart = view_of(c.out[0], 100, 2);
    const lensprof_target good = target_of(c.in[0], 100, 2);
#define REFUSED(expected, change)                                                      \
    do {                                                                               \
        lensprof_image from = apart;                                                   \
        lensprof_target to = good;                                                     \
        uint32_t x0 = c.x0, y0 = c.y0;                                                 \
        change;                                                                        \
        assert_int_equal(lensprof_sensor_apply(c.plan, &from, &to, x0, y0), expected); \
        assert_memory_equal(c.in, before, sizeof before);                              \
    } while (0)
    REFUSED(LENSPROF_ERROR_ARGUMENT, to.sample = LENSPROF_SAMPLE_U8);
    REFUSED(LENSPROF_ERROR_ARGUMENT, from.layout = LENSPROF_LAYOUT_RGGB);
    REFUSED(LENSPROF_ERROR_SIZE, from.width = 99);
    REFUSED(LENSPROF_ERROR_SIZE, x0 = c.readout.width - 99);
    REFUSED(LENSPROF_ERROR_SIZE, y0 = c.readout.height - 1);
    REFUSED(LENSPROF_ERROR_ARGUMENT, from.data = &c.in[0][1]);
    REFUSED(LENSPROF_ERROR_ARGUMENT, from.data = NULL);
    assert_int_equal(lensprof_sensor_apply(NULL, &apart, &good, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_sensor_apply(c.plan, &apart, NULL, 0, 0), LENSPROF_ERROR_ARGUMENT);
}

/* ---- plans made elsewhere ---- */

/* In memory of exactly its size: whatever opens is applied within its memory (checked by the sanitizers). */
static int try_plan(const uint32_t *words, size_t bytes, int seal) {
    uint32_t *copy = malloc(bytes);
    const lensprof_sensor_plan *opened = NULL;
    memcpy(copy, words, bytes);
    lensprof_sensor_plan *plan = (lensprof_sensor_plan *)(void *)copy;
    if (seal && plan->bytes <= bytes && plan->bytes >= sizeof *plan) plan->check = lp_sensor_check(plan);
    const int opens = lensprof_sensor_plan_open(copy, bytes, &opened) == LENSPROF_OK;
    for (int corner = 0; opens && corner < 4; corner++) {
        uint16_t row[64];
        for (int i = 0; i < 64; i++) row[i] = i % 2 ? 65535 : 0;
        const uint32_t width = opened->grid.width < 64 ? opened->grid.width : 64;
        const lensprof_target tile = {row, 0, width, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
        assert_ok(lensprof_sensor_apply(opened, NULL, &tile, corner & 1 ? opened->grid.width - width : 0,
                                        corner & 2 ? opened->grid.height - 1 : 0));
    }
    free(copy);
    return opens;
}

static void test_any_bytes_are_safe(void **state) {
    (void)state;
    static sensor_case c;
    static uint32_t copy[SENSOR_WORDS];
    static const uint32_t values[] = {0,      1,       2,          4,          17,         29,         30,        99,
                                      0xffff, 0x10000, 0x3fffffff, 0x40000000, 0x7fffffff, 0x80000000, 0xffffffff};
    uint64_t random = 43;
    int opened = 0, refused = 0;
    const int runs = campaign_runs(20000);
    for (int n = 0; n < runs; n++) {
        if (n % 100 == 0) make_sensor(&c, &random);
        const size_t bytes = c.plan->bytes, head = sizeof(lensprof_sensor_plan) / 4;
        memcpy(copy, c.memory, bytes);
        for (int i = 0; i <= n % 3; i++) {
            const size_t at = 3 + (size_t)((lp_random(&random) < 0.8 ? head - 3 : bytes / 4 - 3) * lp_random(&random));
            if (lp_random(&random) < 0.5)
                copy[at] = values[sensor_below(sizeof values / sizeof *values, &random)];
            else
                copy[at] ^= 1u << sensor_below(32, &random);
        }
        if (memcmp(copy, c.memory, bytes)) assert_int_equal(try_plan(copy, bytes, 0), 0);
        if (try_plan(copy, bytes, 1))
            opened++;
        else
            refused++;
    }
    assert_true(opened > runs / 20 && refused > runs / 20);
}

static void test_damaged_and_newer_plans(void **state) {
    (void)state;
    static sensor_case c;
    const lensprof_sensor_plan *plan = NULL;
    uint64_t random = 47;
    make_sensor(&c, &random);
    const size_t bytes = c.plan->bytes;
    assert_ok(lensprof_sensor_plan_open(c.memory, bytes, &plan));
    assert_ptr_equal(plan, c.memory);
    assert_int_equal(lensprof_sensor_plan_open(c.memory, bytes - 1, &plan), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_sensor_plan_open(c.memory, 8, &plan), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_sensor_plan_open((const uint8_t *)c.memory + 1, bytes, &plan), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_sensor_plan_open(NULL, bytes, &plan), LENSPROF_ERROR_ARGUMENT);
    c.memory[0] += 1u << 24;
    assert_int_equal(lensprof_sensor_plan_open(c.memory, bytes, &plan), LENSPROF_ERROR_LAYOUT);
    c.memory[0] = 7;
    assert_int_equal(lensprof_sensor_plan_open(c.memory, bytes, &plan), LENSPROF_ERROR_CORRUPT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_codes_are_within_one_of_double_precision),
        cmocka_unit_test(test_pedestal_stays),
        cmocka_unit_test(test_clipped_highlights_are_neutral),
        cmocka_unit_test(test_tiles_have_the_bytes_of_the_whole),
        cmocka_unit_test(test_flips_and_windows),
        cmocka_unit_test(test_packed_rows),
        cmocka_unit_test(test_plans_between_two),
        cmocka_unit_test(test_share_of_a_temperature),
        cmocka_unit_test(test_stated_error),
        cmocka_unit_test(test_options_are_those_of_plans),
        cmocka_unit_test(test_levels_of_the_profile),
        cmocka_unit_test(test_mosaics_that_are_refused),
        cmocka_unit_test(test_plans_that_are_refused),
        cmocka_unit_test(test_tiles_that_are_refused),
        cmocka_unit_test(test_any_bytes_are_safe),
        cmocka_unit_test(test_damaged_and_newer_plans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
