/* Applying in integers, compared with double precision over random profiles, and with the single precision path, which
 * defines the treatment of nearly saturated pixels. */
#include "unit/fixed_cases.h"

#include "campaign.h"

#include <lensprof/profile.h>

#include <core/fixed_plan.h>

static void as_drawn(fixture *f, uint64_t *random) { (void)f, (void)random; }

static void with_levels(fixture *f, uint64_t *random) {
    do random_levels_of_model(&f->m, random);
    while (!has_levels(&f->m));
    make_plan(f);
}

static void check_codes(uint32_t sample, void (*change)(fixture *f, uint64_t *random), double smallest_share) {
    uint64_t random = 5;
    double worst = 0.0, same = 0.0, all = 0.0;
    static fixture f;
    const int profiles = campaign_runs(3000);
    for (int n = 0; n < profiles; n++) {
        make_case(&f, sample, &random);
        if (n % 3 == 0 && sample == LENSPROF_SAMPLE_U8) {
            for (int c = 0; c < 3; c++) random_response(&f.m.output[c], &random);
            f.m.options.output_response = f.m.output, f.m.options.output_responses = n % 2 ? 1 : 3;
            make_plan(&f);
        }
        change(&f, &random);
        assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
        worst = fmax(worst, worst_error(&f, &same, &all));
    }
    print_message("worst %.0f level of %.0f samples, %.4f %% identical\n", worst, all, 100.0 * same / all);
    assert_true(worst <= 1.0);
    assert_true(same >= smallest_share * all);
}

static void test_8_bit_are_within_a_level(void **state) {
    (void)state;
    check_codes(LENSPROF_SAMPLE_U8, as_drawn, 0.9999);
}

static void test_16_bit_are_within_a_level(void **state) {
    (void)state;
    check_codes(LENSPROF_SAMPLE_U16, as_drawn, 0.95);
}

static void test_8_bit_with_levels_are_within_a_level(void **state) {
    (void)state;
    check_codes(LENSPROF_SAMPLE_U8, with_levels, 0.999);
}

static void test_16_bit_with_levels_are_within_a_level(void **state) {
    (void)state;
    check_codes(LENSPROF_SAMPLE_U16, with_levels, 0.95);
}

/* Extreme curves, falloffs near the permitted limits, centres far outside, small frames, large exposures. */
static void test_wild_models_are_within_a_level(void **state) {
    (void)state;
    uint64_t random = 11;
    double worst = 0.0, same = 0.0, all = 0.0;
    uint32_t refused = 0;
    static fixture f;
    const int profiles = campaign_runs(3000);
    for (int n = 0; n < profiles; n++) {
        make_case(&f, LENSPROF_SAMPLE_U8, &random);
        lensprof_apply_options *o = &f.m.options;
        if (n % 3 == 0) o->frame_width = PIXELS, o->frame_height = 1 + n % 40, f.x0 = 0, f.y0 = n % o->frame_height;
        const double center[2] = {2.0 * lp_random(&random) - 1.0, 2.0 * lp_random(&random) - 1.0};
        for (int c = 0; c < 3; c++) {
            double table[64] = {0.0}; /* flat here, steep there */
            for (int i = 1; i < 64; i++) table[i] = table[i - 1] + pow(lp_random(&random), 6.0);
            for (int i = 0; i < 64; i++) table[i] /= table[63];
            if (n % 2)
                assert_ok(lensprof_response_set_table(&f.m.response[c], table, 64));
            else
                assert_ok(lensprof_response_set_gamma(&f.m.response[c], 0.1 + 9.9 * lp_random(&random)));
            lensprof_vignetting *v = &f.m.vignetting[c];
            memcpy(v->center, center, sizeof center);
            do
                for (int i = 0; i < 3; i++) v->k[i] = 4.0 * lp_random(&random) - 2.0;
            while (lensprof_vignetting_validate(v) != LENSPROF_OK);
        }
        o->source.ev = 16.0 * lp_random(&random) - 8.0;
        const lensprof_status status = lensprof_fixed_plan_init(f.memory, sizeof f.memory, o, &f.plan, NULL);
        refused += status == LENSPROF_ERROR_UNSUPPORTED;
        if (status != LENSPROF_OK)
            assert_int_equal(status, LENSPROF_ERROR_UNSUPPORTED);
        else {
            assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
            worst = fmax(worst, worst_error(&f, &same, &all));
        }
    }
    print_message("worst %.0f level, %.4f %% identical, %u refused\n", worst, 100.0 * same / all, refused);
    assert_true(worst <= 1.0);
    assert_true(same >= 0.999 * all);
    assert_true(refused < (uint32_t)profiles / 10);
}

/* A plan without a correction changes nothing, whatever the curve. */
static void test_nothing_to_do_changes_nothing(void **state) {
    (void)state;
    uint64_t random = 3;
    static fixture f;
    for (int n = 0; n < 500; n++) {
        make_case(&f, n % 4 ? LENSPROF_SAMPLE_U8 : LENSPROF_SAMPLE_U16, &random);
        f.m.options.strength = 0.0;
        f.m.options.source = f.m.options.target;
        f.m.options.output = f.m.options.input;
        make_plan(&f);
        assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
        assert_memory_equal(f.in, f.out, PIXELS * f.bytes);
    }
}

/* Nearly saturated pixels give the same result as the single precision path. */
static void test_white_stays_white(void **state) {
    (void)state;
    uint64_t random = 23;
    static fixture f;
    static uint64_t memory[1 << 15];
    static uint8_t wanted[ROOM];
    double same = 0.0, all = 0.0;
    for (int n = 0; n < 600; n++) {
        make_case(&f, LENSPROF_SAMPLE_U8, &random);
        lensprof_apply_options *o = &f.m.options;
        const uint32_t sample = n % 3 ? LENSPROF_SAMPLE_U8 : LENSPROF_SAMPLE_U16;
        o->source_layout = f.from.layout = f.to.layout = n % 2 ? LENSPROF_LAYOUT_RGBA : LENSPROF_LAYOUT_BGR;
        o->source_sample = o->target_sample = f.from.sample = f.to.sample = sample;
        o->input = o->output = LENSPROF_ENCODING_RESPONSE;
        o->saturated = LENSPROF_SATURATED_NEUTRAL;
        o->direction = LENSPROF_DIRECTION_CORRECT;
        o->source.white_balance[0] = 0.2 + 3.0 * lp_random(&random);
        o->source.white_balance[2] = 0.2 + 3.0 * lp_random(&random);
        if (sample == LENSPROF_SAMPLE_U16) o->responses = 1, lensprof_response_set_linear(&f.m.response[0]);
        for (uint32_t i = 0; i < ROOM; i++) f.in[i] = (uint8_t)(255.9 - 120.0 * pow(lp_random(&random), 2.0));
        make_plan(&f);
        const lensprof_plan *plan;
        assert_ok(lensprof_plan_init(memory, sizeof memory, o, &plan, NULL));
        assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
        lensprof_target target = f.to;
        target.data = wanted;
        assert_ok(lensprof_apply(plan, &f.from, &target, f.x0, f.y0));
        for (uint32_t i = 0; i < PIXELS * lensprof_layout_samples(f.from.layout); i++) {
            const double error = fabs(value_at(f.out, sample, i) - value_at(wanted, sample, i));
            assert_true(error <= 1.0);
            same += sample == LENSPROF_SAMPLE_U8 && error == 0.0, all += sample == LENSPROF_SAMPLE_U8;
        }
    }
    print_message("%.4f %% identical\n", 100.0 * same / all);
    assert_true(same >= 0.998 * all);
}

/* Tiles and bottom-up rows, in place or not, give the same result as the whole frame; nothing outside the tile is
 * written. */
static void test_tiles_give_the_frame(void **state) {
    (void)state;
    enum {
        W = 61,
        H = 37,
        PITCH = 4 * W + 3
    };
    static uint8_t in[H * PITCH], whole[H * PITCH], tiled[H * PITCH], upside[H * PITCH];
    uint64_t random = 9;
    static fixture f;
    for (int n = 0; n < 200; n++) {
        make_case(&f, LENSPROF_SAMPLE_U8, &random);
        f.m.options.frame_width = W, f.m.options.frame_height = H;
        make_plan(&f);
        for (size_t i = 0; i < sizeof in; i++)
            in[i] = whole[i] = tiled[i] = upside[i] = (uint8_t)(256.0 * lp_random(&random));
        lensprof_image from = {in, PITCH, W, H, LENSPROF_SAMPLE_U8, f.m.options.source_layout};
        lensprof_target to = {whole, PITCH, W, H, LENSPROF_SAMPLE_U8, f.m.options.source_layout};
        assert_ok(lensprof_fixed_apply(f.plan, &from, &to, 0, 0));
        for (uint32_t y = 0; y < H; y += 10)
            for (uint32_t x = 0; x < W; x += 13) {
                lensprof_target tile = {tiled + y * PITCH + x * f.bytes,
                                        PITCH,
                                        W - x < 13 ? W - x : 13,
                                        H - y < 10 ? H - y : 10,
                                        LENSPROF_SAMPLE_U8,
                                        from.layout};
                assert_ok(lensprof_fixed_apply(f.plan, NULL, &tile, x, y));
            }
        assert_memory_equal(whole, tiled, sizeof whole);
        if (from.layout >= LENSPROF_LAYOUT_RGGB) continue;
        f.m.options.frame_height = 1;
        for (uint32_t y = 0; y < H; y++) { /* rows stored bottom up */
            from = (lensprof_image){in + (H - 1 - y) * PITCH, -PITCH, W, 1, LENSPROF_SAMPLE_U8, to.layout};
            lensprof_target row = {upside + y * PITCH, PITCH, W, 1, LENSPROF_SAMPLE_U8, to.layout};
            assert_ok(lensprof_fixed_apply(f.plan, &from, &row, 0, H - 1 - y));
            assert_memory_equal(row.data, whole + (H - 1 - y) * PITCH, W * f.bytes);
        }
    }
}

/* A plan is plain bytes: a copy gives the same result; a plan with any flipped bit is refused. */
static void test_plans_can_be_copied(void **state) {
    (void)state;
    uint64_t random = 31;
    static fixture f;
    static uint32_t copy[2048];
    static uint8_t again[ROOM];
    const lensprof_fixed_plan *opened, *untouched = (const lensprof_fixed_plan *)(void *)again;
    for (int n = 0; n < 20; n++) {
        make_case(&f, n % 3 ? LENSPROF_SAMPLE_U8 : LENSPROF_SAMPLE_U16, &random);
        const size_t bytes = lensprof_fixed_plan_bytes(&f.m.options);
        memset(copy, 0xEE, sizeof copy);
        memcpy(copy, f.memory, bytes);
        assert_ok(lensprof_fixed_plan_open(copy, bytes, &opened));
        memset(f.memory, 0, sizeof f.memory);
        lensprof_target to = f.to;
        to.data = again;
        assert_ok(lensprof_fixed_apply(opened, &f.from, &to, f.x0, f.y0));
        make_plan(&f);
        assert_memory_equal(f.memory, copy, bytes); /* no addresses, no uninitialised bytes */
        assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
        assert_memory_equal(f.out, again, PIXELS * f.bytes);
        opened = untouched;
        for (size_t bit = 0; bit < 8 * bytes; bit += 1 + bit / 2048) {
            copy[bit / 32] ^= 1u << bit % 32;
            const lensprof_status status = lensprof_fixed_plan_open(copy, bytes, &opened);
            assert_true(status == LENSPROF_ERROR_CORRUPT || (bit >= 24 && bit < 32 && status == LENSPROF_ERROR_LAYOUT)
                        || (bit / 32 == 1 && status == LENSPROF_ERROR_CAPACITY));
            copy[bit / 32] ^= 1u << bit % 32;
        }
        for (size_t less = 0; less < bytes; less += 7)
            assert_int_equal(lensprof_fixed_plan_open(copy, less, &opened), LENSPROF_ERROR_CAPACITY);
        assert_int_equal(lensprof_fixed_plan_open(NULL, bytes, &opened), LENSPROF_ERROR_ARGUMENT);
        assert_int_equal(lensprof_fixed_plan_open((uint8_t *)copy + 2, bytes, &opened), LENSPROF_ERROR_ARGUMENT);
        assert_int_equal(lensprof_fixed_plan_open(copy, bytes, NULL), LENSPROF_ERROR_ARGUMENT);
        assert_ptr_equal(opened, untouched);
    }
}

/* A plan from a blob equals the plan from its profile; a damaged blob is refused. */
static void test_blobs_give_the_same_plan(void **state) {
    (void)state;
    uint64_t random = 37;
    static fixture f;
    static lensprof_profile profile;
    static uint8_t blob[1 << 15];
    static uint32_t wanted[sizeof f.memory / 4];
    for (int n = 0; n < 60; n++) {
        size_t bytes;
        make_case(&f, LENSPROF_SAMPLE_U8, &random);
        lensprof_apply_options *o = &f.m.options;
        lensprof_profile_init(&profile);
        profile.responses = o->responses, profile.vignettings = o->vignettings;
        memcpy(profile.response, f.m.response, sizeof profile.response);
        memcpy(profile.vignetting, f.m.vignetting, sizeof profile.vignetting);
        if (o->grid) profile.grid = *o->grid;
        assert_ok(lensprof_profile_pack(&profile, 0, blob, sizeof blob, &bytes));
        assert_ok(lensprof_profile_unpack(blob, bytes, &profile));
        o->response = profile.response, o->vignetting = profile.vignetting;
        memset(f.memory, 0, sizeof f.memory);
        make_plan(&f);
        memcpy(wanted, f.memory, sizeof wanted);
        o->response = NULL, o->vignetting = NULL, o->grid = NULL;
        o->blob = blob, o->blob_bytes = bytes;
        make_plan(&f);
        assert_memory_equal(f.memory, wanted, sizeof wanted);
        blob[bytes / 2] ^= 1;
        assert_int_equal(lensprof_fixed_plan_init(f.memory, sizeof f.memory, o, &f.plan, NULL), LENSPROF_ERROR_CORRUPT);
        assert_memory_equal(f.memory, wanted, sizeof wanted);
        assert_int_equal(lensprof_fixed_plan_bytes(o), 0);
    }
}

static void expect_refused(fixture *f, lensprof_status wanted) {
    const lensprof_fixed_plan *plan = NULL;
    static uint8_t before[sizeof f->memory];
    memset(f->memory, 0x5A, sizeof f->memory);
    memcpy(before, f->memory, sizeof before);
    assert_int_equal(lensprof_fixed_plan_init(f->memory, sizeof f->memory, &f->m.options, &plan, NULL), wanted);
    assert_null(plan);
    assert_memory_equal(f->memory, before, sizeof before);
}

static void test_options_that_are_refused(void **state) {
    (void)state;
    uint64_t random = 41;
    static fixture f;
    lensprof_apply_options *o = &f.m.options;
#define REFUSED(change, status)                     \
    do {                                            \
        make_case(&f, LENSPROF_SAMPLE_U8, &random); \
        change;                                     \
        expect_refused(&f, status);                 \
    } while (0)
    REFUSED(o->struct_size = 1, LENSPROF_ERROR_STRUCT_SIZE);
    REFUSED(o->response = NULL, LENSPROF_ERROR_ARGUMENT);
    REFUSED(o->output_responses = 1, LENSPROF_ERROR_ARGUMENT);
    REFUSED(o->source_layout = 99, LENSPROF_ERROR_ARGUMENT);
    REFUSED(o->frame_width = 0, LENSPROF_ERROR_SIZE);
    REFUSED(o->source.ev = NAN, LENSPROF_ERROR_EXPOSURE);
    REFUSED(o->gain_cap = 0.5, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.m.vignetting[0].k[0] = -5.0, LENSPROF_ERROR_VIGNETTING);
    REFUSED(f.m.response[0].table[7] = 2.0, LENSPROF_ERROR_RESPONSE);
    REFUSED(o->dither = 1, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(o->target_sample = LENSPROF_SAMPLE_F32, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(o->source_sample = o->target_sample = LENSPROF_SAMPLE_F32, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(o->source_sample = o->target_sample = LENSPROF_SAMPLE_F16, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(o->source_layout = LENSPROF_LAYOUT_PLANAR, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(o->strength = 1.0; o->vignettings = 1; f.m.vignetting[0].k[2] = 1e6, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(o->chroma = 1, LENSPROF_ERROR_UNSUPPORTED);
    REFUSED(o->grid = &f.m.grid; lensprof_gain_grid_init(&f.m.grid); f.m.grid.columns = f.m.grid.rows = 2;
            f.m.grid.channels = 1; o->frame_width = 65536;
            for (int i = 0; i < 4; i++) f.m.grid.attenuation[i] = 1.0f, LENSPROF_ERROR_UNSUPPORTED);
    o->chroma = 1;
    assert_int_equal(lensprof_fixed_plan_bytes(o), 0);
    assert_int_equal(lensprof_fixed_plan_bytes(NULL), 0);
    lensprof_gain_grid_init(&f.m.grid);
    make_case(&f, LENSPROF_SAMPLE_U8, &random);
    o->grid = &f.m.grid; /* a grid without nodes does not count as a grid */
    make_plan(&f);
    const lensprof_fixed_plan *plan;
    const size_t bytes = lensprof_fixed_plan_bytes(o);
    assert_int_equal(lensprof_fixed_plan_init(f.memory, bytes - 1, o, &plan, NULL), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_fixed_plan_init((uint8_t *)f.memory + 2, bytes, o, &plan, NULL), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_fixed_plan_init(NULL, bytes, o, &plan, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fixed_plan_init(f.memory, bytes, NULL, &plan, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fixed_plan_init(f.memory, bytes, o, NULL, NULL), LENSPROF_ERROR_ARGUMENT);
}

static void test_tiles_that_are_refused(void **state) {
    (void)state;
    uint64_t random = 43;
    static fixture f, before;
    make_case(&f, LENSPROF_SAMPLE_U8, &random);
    before = f;
#define BAD(change, status)                                                         \
    do {                                                                            \
        lensprof_image from = f.from;                                               \
        lensprof_target to = f.to;                                                  \
        uint32_t x0 = f.x0, y0 = f.y0;                                              \
        change;                                                                     \
        assert_int_equal(lensprof_fixed_apply(f.plan, &from, &to, x0, y0), status); \
        assert_memory_equal(f.out, before.out, sizeof f.out);                       \
    } while (0)
    BAD(from.data = NULL, LENSPROF_ERROR_ARGUMENT);
    BAD(to.data = NULL, LENSPROF_ERROR_ARGUMENT);
    BAD(to.width = 0; (void)x0, LENSPROF_ERROR_SIZE);
    BAD(from.height = 2, LENSPROF_ERROR_SIZE);
    BAD(from.width--, LENSPROF_ERROR_SIZE);
    BAD(from.sample = to.sample = LENSPROF_SAMPLE_U16, LENSPROF_ERROR_ARGUMENT);
    BAD(from.layout = to.layout = LENSPROF_LAYOUT_PLANAR, LENSPROF_ERROR_ARGUMENT);
    BAD(from.layout = 77, LENSPROF_ERROR_ARGUMENT);
    BAD(x0 = f.m.options.frame_width, LENSPROF_ERROR_SIZE);
    BAD(y0 = f.m.options.frame_height, LENSPROF_ERROR_SIZE);
    BAD(x0 = UINT32_MAX, LENSPROF_ERROR_SIZE);
    BAD(to.data = f.in + f.bytes, LENSPROF_ERROR_ARGUMENT);
    BAD(to.row_bytes = PTRDIFF_MAX, LENSPROF_ERROR_SIZE);
    assert_int_equal(lensprof_fixed_apply(NULL, &f.from, &f.to, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fixed_apply(f.plan, NULL, NULL, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fixed_apply(f.plan, &f.from, NULL, 0, 0), LENSPROF_ERROR_ARGUMENT);
}

static void test_tables_are_what_they_say(void **state) {
    (void)state;
    for (int i = 0; i <= 256; i++) {
        assert_int_equal(lp_log2_table[i], lround(4194304.0 * log2(1.0 + i / 256.0)));
        assert_int_equal(lp_exp2_table[i], lround(1073741824.0 * exp2(i / 256.0)));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_8_bit_are_within_a_level),
        cmocka_unit_test(test_16_bit_are_within_a_level),
        cmocka_unit_test(test_8_bit_with_levels_are_within_a_level),
        cmocka_unit_test(test_16_bit_with_levels_are_within_a_level),
        cmocka_unit_test(test_wild_models_are_within_a_level),
        cmocka_unit_test(test_nothing_to_do_changes_nothing),
        cmocka_unit_test(test_white_stays_white),
        cmocka_unit_test(test_tiles_give_the_frame),
        cmocka_unit_test(test_plans_can_be_copied),
        cmocka_unit_test(test_blobs_give_the_same_plan),
        cmocka_unit_test(test_options_that_are_refused),
        cmocka_unit_test(test_tiles_that_are_refused),
        cmocka_unit_test(test_tables_are_what_they_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
