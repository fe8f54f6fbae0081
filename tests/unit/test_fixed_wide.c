/* Samples of 16 bit through responses in integers, and between 8 and 16 bit, compared with double precision, and with
 * the single precision path. */
#include "unit/fixed_cases.h"

#include "campaign.h"

#include <lensprof/profile.h>

#include <core/fixed_plan.h>

/* The worst error of profiles that `draw` makes. */
static void check_draws(const char *what, void (*draw)(fixture *f, int n, uint64_t *random), double smallest_share) {
    uint64_t random = 61;
    double worst = 0.0, same = 0.0, all = 0.0;
    static fixture f;
    const int profiles = campaign_runs(1000);
    for (int n = 0; n < profiles; n++) {
        draw(&f, n, &random);
        assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
        worst = fmax(worst, worst_error(&f, &same, &all));
    }
    print_message("%s: worst %.0f level of %.0f samples, %.4f %% identical\n", what, worst, all, 100.0 * same / all);
    assert_true(worst <= 1.0);
    assert_true(same >= smallest_share * all);
}

static void from_16_to_16(fixture *f, int n, uint64_t *random) {
    make_wide_case(f, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_U16, n & 1, random);
}

static void from_16_to_8(fixture *f, int n, uint64_t *random) {
    make_wide_case(f, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_U8, n & 1, random);
}

static void from_8_to_16(fixture *f, int n, uint64_t *random) {
    make_wide_case(f, LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16, n & 1, random);
}

/* The curve of a sensor that compands: straight lines between knees, with a slope of 64 in the dark and of 1/64 near
 * white. */
static void companding_response(lensprof_response *r, uint64_t *random) {
    enum {
        LAST = LENSPROF_RESPONSE_SAMPLES - 1
    };
    const int dark = 2 + (int)(8.0 * lp_random(random)), bright = 200 + (int)(800.0 * lp_random(random));
    double table[LAST + 1] = {0.0}, weight[LAST + 1], slope = 1.0, sum = 0.0;
    for (int j = dark + 1; j <= bright; j++) {
        if (lp_random(random) < 0.03) slope *= 0.2 + 0.7 * lp_random(random);
        sum += weight[j] = slope;
    }
    const double rest = LAST - 64.0 * dark - (LAST - bright) / 64.0;
    for (int j = 1; j <= LAST; j++) {
        const double rise = j <= dark ? 64.0 : j > bright ? 1.0 / 64.0 : rest * weight[j] / sum;
        table[j] = table[j - 1] + rise / LAST;
    }
    assert_ok(lensprof_response_set_table(r, table, LAST + 1));
}

/* Parts of it are flat, and so may be both ends. */
static void response_with_flat_parts(lensprof_response *r, uint64_t *random) {
    double table[64] = {0.0};
    for (int i = 1; i < 63; i++) table[i] = table[i - 1] + (lp_random(random) < 0.4 ? 0.0 : lp_random(random));
    table[63] = table[62];
    for (int i = 0; i < 64; i++) table[i] /= table[63];
    assert_ok(lensprof_response_set_table(r, table, 64));
}

/* Companded samples of 10 to 16 bit to light, or back. */
static void companded(fixture *f, int n, uint64_t *random) {
    lensprof_apply_options *o = &f->m.options;
    make_wide_case(f, LENSPROF_SAMPLE_U16, n % 3 ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_U8, 0, random);
    const uint32_t bits = 10 + 2 * (uint32_t)(4 * lp_random(random)), most = (1u << bits) - 1;
    const double black = most / 32 / 65535.0;
    for (int c = 0; c < 3; c++) companding_response(&f->m.response[c], random);
    o->input = n % 4 == 2 ? LENSPROF_ENCODING_LINEAR : LENSPROF_ENCODING_RESPONSE;
    o->output = n % 2 ? LENSPROF_ENCODING_LINEAR : LENSPROF_ENCODING_RESPONSE;
    o->output_response = NULL, o->output_responses = 0;
    f->m.levels[0] = (lensprof_levels){{black, black, black}, most / 65535.0};
    o->levels = &f->m.levels[0];
    o->output_levels = n % 5 ? NULL : o->levels;
    for (uint32_t i = 0; i < ROOM / 2; i++) {
        const uint16_t code = (uint16_t)((most + 1) * lp_random(random));
        memcpy(f->in + 2 * i, &code, sizeof code);
    }
    make_plan(f);
}

static void with_flat_parts(fixture *f, int n, uint64_t *random) {
    from_16_to_16(f, n, random);
    for (int c = 0; c < 3; c++) response_with_flat_parts(&f->m.response[c], random);
    make_plan(f);
}

/* gamma from 0.2 to 5, where the logarithm of light is that of the code times gamma. */
static void with_gamma(fixture *f, int n, uint64_t *random) {
    from_16_to_16(f, n, random);
    for (int c = 0; c < 3; c++) {
        assert_ok(lensprof_response_set_gamma(&f->m.response[c], pow(5.0, 2.0 * lp_random(random) - 1.0)));
        assert_ok(lensprof_response_set_gamma(&f->m.output[c], pow(5.0, 2.0 * lp_random(random) - 1.0)));
    }
    make_plan(f);
}

static void test_16_bit_through_curves(void **state) {
    (void)state;
    check_draws("16 to 16 bit", from_16_to_16, 0.99);
}

static void test_16_to_8_bit(void **state) {
    (void)state;
    check_draws("16 to 8 bit", from_16_to_8, 0.998);
}

static void test_8_to_16_bit(void **state) {
    (void)state;
    check_draws("8 to 16 bit", from_8_to_16, 0.99);
}

static void test_companded_samples(void **state) {
    (void)state;
    check_draws("companded", companded, 0.99);
}

static void test_flat_parts(void **state) {
    (void)state;
    check_draws("flat parts", with_flat_parts, 0.99);
}

static void test_gamma(void **state) {
    (void)state;
    check_draws("gamma", with_gamma, 0.99);
}

/* Every code, at one gain: the results rise, and are within a level; without a correction, every sample that single
 * precision leaves alone stays. */
static void test_ramps(void **state) {
    (void)state;
    enum {
        CODES = 65536
    };
    static uint16_t ramp[CODES], out[CODES], wanted[CODES];
    static uint64_t memory[1 << 17];
    static fixture f;
    uint64_t random = 67;
    double same = 0.0;
    const int ramps = campaign_runs(60);
    for (int i = 0; i < CODES; i++) ramp[i] = (uint16_t)i;
    for (int n = 0; n < ramps; n++) {
        lensprof_apply_options *o = &f.m.options;
        make_wide_case(&f, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_U16, n % 3 == 0, &random);
        o->source_layout = LENSPROF_LAYOUT_GREY;
        o->frame_width = CODES, o->frame_height = 1;
        o->strength = 0.0, o->grid = NULL;
        if (n % 4 == 1) companding_response(&f.m.response[1], &random), o->responses = 3;
        if (n % 4 == 2) response_with_flat_parts(&f.m.response[1], &random), o->responses = 3;
        if (n % 2) {
            o->source = o->target;
            o->input = o->output = LENSPROF_ENCODING_RESPONSE;
            o->output_response = NULL, o->output_responses = 0;
            o->output_levels = o->levels;
        }
        make_plan(&f);
        const lensprof_image from = {ramp, 0, CODES, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
        lensprof_target to = {out, 0, CODES, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
        assert_ok(lensprof_fixed_apply(f.plan, &from, &to, 0, 0));
        const lensprof_plan *plan;
        assert_ok(lensprof_plan_init(memory, sizeof memory, o, &plan, NULL));
        to.data = wanted;
        assert_ok(lensprof_apply(plan, &from, &to, 0, 0));
        for (int i = 0; i < CODES; i++) {
            const double value = reference(&f.m, i / 65535.0, 1, 0, 0);
            const double exact = floor(65535.0 * fmin(fmax(value, 0.0), white_of_output(&f.m)) + 0.5);
            assert_true(i == 0 || out[i] >= out[i - 1]);
            assert_true(fabs(out[i] - exact) <= 1.0);
            if (n % 2 && wanted[i] == i) assert_int_equal(out[i], i);
            same += out[i] == exact;
        }
    }
    print_message("%.4f %% of the codes identical\n", 100.0 * same / CODES / ramps);
}

/* The results are within a level of those in single and in double precision, those of nearly saturated pixels too. */
static void test_single_precision(void **state) {
    (void)state;
    static fixture f;
    static uint64_t memory[1 << 17];
    static uint8_t wanted[ROOM];
    uint64_t random = 71;
    double same = 0.0, all = 0.0, white = 0.0;
    const int profiles = campaign_runs(900);
    for (int n = 0; n < profiles; n++) {
        lensprof_apply_options *o = &f.m.options;
        make_wide_case(&f, n % 7 % 2, n % 7 / 2 % 2, n % 5 == 0, &random);
        o->saturated = LENSPROF_SATURATED_NEUTRAL;
        if (n % 2) {
            o->source_layout = f.from.layout = f.to.layout = n % 4 == 1 ? LENSPROF_LAYOUT_RGBA : LENSPROF_LAYOUT_BGR;
            o->direction = LENSPROF_DIRECTION_CORRECT;
            o->input = o->output = LENSPROF_ENCODING_RESPONSE;
            o->source.white_balance[0] = 0.2 + 3.0 * lp_random(&random);
            for (int end = 0; end < 2; end++) /* of both paths, gains contain white less black of linear output */
                f.m.levels[end].black[0] = f.m.levels[end].black[2] = f.m.levels[end].black[1];
            for (uint32_t i = 0; i < ROOM; i++) f.in[i] = (uint8_t)(255.9 - 120.0 * pow(lp_random(&random), 2.0));
        }
        make_plan(&f);
        white += f.plan->neutral_white;
        const lensprof_plan *plan;
        assert_ok(lensprof_plan_init(memory, sizeof memory, o, &plan, NULL));
        assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
        lensprof_target target = f.to;
        target.data = wanted;
        assert_ok(lensprof_apply(plan, &f.from, &target, f.x0, f.y0));
        for (uint32_t i = 0; i < PIXELS * lensprof_layout_samples(f.from.layout); i++) {
            const double error = fabs(value_at(f.out, f.to.sample, i) - value_at(wanted, f.to.sample, i));
            assert_true(error <= 1.0);
            if (is_neutral_white(o)) assert_true(fabs(value_at(f.out, f.to.sample, i) - wanted_at(&f, i)) <= 1.0);
            same += error == 0.0, all += 1.0;
        }
    }
    print_message("%.4f %% as in single precision\n", 100.0 * same / all);
    assert_true(white > profiles / 10.0);
    assert_true(same >= 0.99 * all);
}

/* A plan is plain bytes, and a blob gives the same plan as its profile. */
static void test_copies_and_blobs(void **state) {
    (void)state;
    static fixture f;
    static lensprof_profile profile;
    static uint8_t blob[1 << 15], again[ROOM];
    static uint32_t copy[sizeof f.memory / 4];
    uint64_t random = 73;
    for (int n = 0; n < 100; n++) {
        lensprof_apply_options *o = &f.m.options;
        make_wide_case(&f, n % 3 != 2, n % 3 != 1, 0, &random);
        lensprof_profile_init(&profile);
        profile.responses = o->responses, profile.vignettings = o->vignettings;
        memcpy(profile.response, f.m.response, sizeof profile.response);
        memcpy(profile.vignetting, f.m.vignetting, sizeof profile.vignetting);
        if (o->grid) profile.grid = *o->grid;
        size_t bytes;
        assert_ok(lensprof_profile_pack(&profile, 0, blob, sizeof blob, &bytes));
        assert_ok(lensprof_profile_unpack(blob, bytes, &profile));
        o->response = profile.response, o->vignetting = profile.vignetting;
        make_plan(&f);
        const size_t size = lensprof_fixed_plan_bytes(o);
        memcpy(copy, f.memory, size);
        assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
        memset(f.memory, 0xEE, sizeof f.memory);
        const lensprof_fixed_plan *opened;
        assert_ok(lensprof_fixed_plan_open(copy, size, &opened));
        lensprof_target to = f.to;
        to.data = again;
        assert_ok(lensprof_fixed_apply(opened, &f.from, &to, f.x0, f.y0));
        assert_memory_equal(f.out, again, PIXELS * lensprof_layout_samples(to.layout) * (f.to.sample ? 2 : 1));
        o->response = NULL, o->vignetting = NULL, o->grid = NULL;
        o->blob = blob, o->blob_bytes = bytes;
        make_plan(&f);
        assert_int_equal(lensprof_fixed_plan_bytes(o), size);
        assert_memory_equal(f.memory, copy, size);
        assert_int_equal(lensprof_fixed_plan_init(f.memory, size - 1, o, &f.plan, NULL), LENSPROF_ERROR_CAPACITY);
    }
}

/* Samples of a response take 4 KiB, once if the output has the response of the input; powers of light take none. */
static void test_sizes(void **state) {
    (void)state;
    static fixture f;
    uint64_t random = 79;
    lensprof_apply_options *o = &f.m.options;
    const double straight[2] = {0.0, 1.0};
    make_case(&f, LENSPROF_SAMPLE_U16, &random);
    o->source_layout = LENSPROF_LAYOUT_RGB;
    o->input = o->output = LENSPROF_ENCODING_RESPONSE;
    o->responses = 3;
    for (int c = 0; c < 3; c++) {
        assert_ok(lensprof_response_set_table(&f.m.response[c], straight, 2));
        assert_ok(lensprof_response_set_gamma(&f.m.output[c], 2.0));
    }
    const size_t head = sizeof(lensprof_fixed_plan), curve = sizeof(lp_fixed_curve);
    assert_in_range(head, 120, 200);
    assert_int_equal(lensprof_fixed_plan_bytes(o), head + 6 * curve + 3 * 4096);
    o->responses = 1;
    assert_int_equal(lensprof_fixed_plan_bytes(o), head + 2 * curve + 4096);
    o->output = LENSPROF_ENCODING_LINEAR;
    assert_int_equal(lensprof_fixed_plan_bytes(o), head + 2 * curve + 4096);
    o->target_sample = LENSPROF_SAMPLE_U8;
    o->output = LENSPROF_ENCODING_RESPONSE;
    assert_int_equal(lensprof_fixed_plan_bytes(o), head + 2 * curve + 2 * 4096);
    o->output_response = f.m.output, o->output_responses = 1;
    assert_int_equal(lensprof_fixed_plan_bytes(o), head + 2 * curve + 4096);
    o->response = f.m.output;
    assert_int_equal(lensprof_fixed_plan_bytes(o), head + 2 * curve);
    o->input = o->output = LENSPROF_ENCODING_LINEAR;
    assert_int_equal(lensprof_fixed_plan_bytes(o), head);
}

/* Views must have the sample types of the plan; samples of another type cannot be replaced in place. */
static void test_tiles_that_are_refused(void **state) {
    (void)state;
    static fixture f, before;
    uint64_t random = 83;
    make_wide_case(&f, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_U8, 0, &random);
    before = f;
    lensprof_image from = f.from;
    lensprof_target to = f.to;
    assert_int_equal(lensprof_fixed_apply(f.plan, NULL, &to, f.x0, f.y0), LENSPROF_ERROR_ARGUMENT);
    to.data = f.in;
    assert_int_equal(lensprof_fixed_apply(f.plan, &from, &to, f.x0, f.y0), LENSPROF_ERROR_ARGUMENT);
    to = f.to, to.sample = LENSPROF_SAMPLE_U16;
    assert_int_equal(lensprof_fixed_apply(f.plan, &from, &to, f.x0, f.y0), LENSPROF_ERROR_ARGUMENT);
    from.sample = LENSPROF_SAMPLE_U8;
    assert_int_equal(lensprof_fixed_apply(f.plan, &from, &f.to, f.x0, f.y0), LENSPROF_ERROR_ARGUMENT);
    assert_memory_equal(f.out, before.out, sizeof f.out);
    assert_memory_equal(f.in, before.in, sizeof f.in);
    assert_ok(lensprof_fixed_apply(f.plan, &f.from, &f.to, f.x0, f.y0));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_16_bit_through_curves),
        cmocka_unit_test(test_16_to_8_bit),
        cmocka_unit_test(test_8_to_16_bit),
        cmocka_unit_test(test_companded_samples),
        cmocka_unit_test(test_flat_parts),
        cmocka_unit_test(test_gamma),
        cmocka_unit_test(test_ramps),
        cmocka_unit_test(test_single_precision),
        cmocka_unit_test(test_copies_and_blobs),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_tiles_that_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
