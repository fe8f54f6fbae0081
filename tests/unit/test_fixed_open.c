/* Integer plans from untrusted memory: whatever their bytes, they are refused, or applying them stays within their
 * memory and the pixels (checked by the sanitizers). */
#include "unit/fixed_cases.h"

#include <core/fixed_plan.h>

enum {
    ROUNDS = 30000,
    NEAR_WORDS = (sizeof(lensprof_fixed_plan) + 6 * sizeof(lp_fixed_curve)) / 4
};

/* In memory of exactly its size, with or without a corrected checksum. Returns whether it opens. */
static int try_plan(const uint32_t *words, size_t bytes, int seal, const fixture *f) {
    uint32_t *copy = malloc(bytes);
    const lensprof_fixed_plan *opened = NULL;
    memcpy(copy, words, bytes);
    lensprof_fixed_plan *plan = (lensprof_fixed_plan *)(void *)copy;
    if (seal && plan->bytes <= bytes && plan->bytes >= sizeof *plan) plan->check = lp_fixed_check(plan);
    const int opens = lensprof_fixed_plan_open(copy, bytes, &opened) == LENSPROF_OK;
    if (!opens) assert_null(opened);
    for (int corner = 0; opens && corner < 4; corner++) {
        lensprof_image from = f->from;
        lensprof_target to = f->to;
        from.sample = opened->sample, to.sample = opened->target, from.layout = to.layout = opened->layout;
        from.width = to.width = opened->frame_width < PIXELS ? opened->frame_width : PIXELS;
        const size_t samples = (size_t)from.width * lensprof_layout_samples(from.layout);
        const size_t read = samples * lensprof_sample_type_bytes(from.sample);
        void *pixels = malloc(read);
        memcpy(pixels, f->in, read);
        from.data = pixels;
        to.data = malloc(samples * lensprof_sample_type_bytes(to.sample));
        assert_ok(lensprof_fixed_apply(opened, &from, &to, corner & 1 ? opened->frame_width - from.width : 0,
                                       corner & 2 ? opened->frame_height - 1 : 0));
        free(pixels);
        free(to.data);
    }
    free(copy);
    return opens;
}

static void change(uint32_t *words, size_t count, uint64_t *random) {
    static const uint32_t values[] = {0,          1,          2,          3,          4,         30,
                                      63,         64,         99,         255,        0x7fff,    0x100000,
                                      0x40000000, 0x7fffffff, 0x80000000, 0xc0000000, 0xffffffff};
    const size_t near = count < NEAR_WORDS ? count : (size_t)NEAR_WORDS; /* the head, and curves */
    const size_t at = 3 + (size_t)((double)((lp_random(random) < 0.8 ? near : count) - 3) * lp_random(random));
    const double kind = lp_random(random);
    if (kind < 0.4)
        words[at] = values[(size_t)(lp_random(random) * (sizeof values / sizeof *values))];
    else if (kind < 0.7)
        words[at] ^= 1u << (uint32_t)(32 * lp_random(random));
    else
        ((uint8_t *)words)[4 * at + (size_t)(4 * lp_random(random))] = (uint8_t)(256 * lp_random(random));
}

static void check_any_bytes(int is_wide, int rounds) {
    uint64_t random = 53;
    static fixture f;
    static uint32_t copy[sizeof f.memory / 4];
    int opened = 0, refused = 0;
    for (int n = 0; n < rounds; n++) {
        if (n % 50 == 0 && is_wide) make_wide_case(&f, n % 150 != 0, n % 200 != 0 || n % 150 == 0, n % 4 == 0, &random);
        if (n % 50 == 0 && !is_wide) make_case(&f, n % 150 ? LENSPROF_SAMPLE_U8 : LENSPROF_SAMPLE_U16, &random);
        const size_t bytes = lensprof_fixed_plan_bytes(&f.m.options);
        memcpy(copy, f.memory, bytes);
        for (int i = 0; i <= n % 3; i++) change(copy, bytes / 4, &random);
        if (memcmp(copy, f.memory, bytes)) assert_int_equal(try_plan(copy, bytes, 0, &f), 0);
        if (try_plan(copy, bytes, 1, &f))
            opened++;
        else
            refused++;
    }
    assert_true(opened > rounds / 10 && refused > rounds / 10);
}

static void test_any_bytes_are_safe(void **state) {
    (void)state;
    check_any_bytes(0, ROUNDS);
}

static void test_any_bytes_of_curves_are_safe(void **state) {
    (void)state;
    check_any_bytes(1, ROUNDS / 3); /* plans of up to 25 KiB */
}

/* A single impossible number is enough to refuse a plan. */
static void test_numbers_that_cannot_be(void **state) {
    (void)state;
    uint64_t random = 59;
    static fixture f;
    lensprof_fixed_plan *plan = (lensprof_fixed_plan *)(void *)f.memory, was;
    do make_case(&f, LENSPROF_SAMPLE_U8, &random);
    while (plan->grid.channels != 3);
    const size_t bytes = plan->bytes;
    was = *plan;
#define REFUSED(member, value)                                 \
    do {                                                       \
        *plan = was;                                           \
        plan->member = (value);                                \
        assert_int_equal(try_plan(f.memory, bytes, 1, &f), 0); \
    } while (0)
    assert_int_equal(try_plan(f.memory, bytes, 1, &f), 1);
    REFUSED(bytes, sizeof was);
    REFUSED(sample, LENSPROF_SAMPLE_F32);
    REFUSED(layout, LENSPROF_LAYOUT_PLANAR);
    REFUSED(layout, 200);
    REFUSED(samples, 255);
    REFUSED(channels, 2);
    REFUSED(channel_of_sample[0], 200);
    REFUSED(site[1][1], 7);
    REFUSED(simulate, 2);
    REFUSED(neutral_white, 3);
    REFUSED(decode_curves, 2);
    REFUSED(encode_curves, 0);
    REFUSED(falloffs, 2);
    REFUSED(gains, 4);
    REFUSED(frame_width, 0);
    REFUSED(frame_height, (1u << 20) + 1);
    REFUSED(center[0], INT32_MIN);
    REFUSED(reach_shift, 99);
    REFUSED(reach_shift, was.reach_shift + 3);
    REFUSED(falloff_shift, 40);
    REFUSED(least, 0);
    REFUSED(least, -1);
    REFUSED(k[0][1], INT32_MIN);
    REFUSED(factor[2], INT32_MAX);
    REFUSED(target, LENSPROF_SAMPLE_U16);
    REFUSED(target, LENSPROF_SAMPLE_F32);
    REFUSED(grid.columns, 0);
    REFUSED(grid.columns, 33);
    REFUSED(grid.rows, 1);
    REFUSED(grid.channels, 1);
    REFUSED(grid.channels, 2);
    REFUSED(grid.shift, 10);
    REFUSED(grid.shift, 40);
    REFUSED(grid.strength, (1u << 30) + 1);
    REFUSED(grid.axis[0].whole, 0);
    REFUSED(grid.axis[1].step, was.grid.axis[1].step + 1);
    REFUSED(grid.axis[1].per_whole, 0xffffffff);
    *plan = was;
    f.memory[bytes / 4 - 1] = 0; /* a node */
    assert_int_equal(try_plan(f.memory, bytes, 1, &f), 0);
#undef REFUSED
}

/* The same of curves and their samples. */
static void test_curves_that_cannot_be(void **state) {
    (void)state;
    uint64_t random = 61;
    static fixture f;
    static uint32_t was[sizeof f.memory / 4];
    lensprof_fixed_plan *plan = (lensprof_fixed_plan *)(void *)f.memory;
    lp_fixed_curve *table = (lp_fixed_curve *)(void *)(plan + 1), *power = table + 1;
    int32_t *samples = (int32_t *)(void *)(power + 1);
    lensprof_apply_options *o = &f.m.options;
    make_wide_case(&f, LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_U8, 0, &random);
    const double values[3] = {0.0, 0.6, 1.0};
    assert_ok(lensprof_response_set_table(&f.m.response[0], values, 3));
    o->responses = 1;
    o->input = LENSPROF_ENCODING_RESPONSE, o->output = LENSPROF_ENCODING_LINEAR;
    o->output_response = NULL, o->output_responses = 0;
    make_plan(&f);
    const size_t bytes = plan->bytes;
    assert_int_equal(bytes, sizeof *plan + 2 * sizeof *table + 4096);
    memcpy(was, f.memory, bytes);
#define REFUSED(member, value)                                 \
    do {                                                       \
        memcpy(f.memory, was, bytes);                          \
        (member) = (value);                                    \
        assert_int_equal(try_plan(f.memory, bytes, 1, &f), 0); \
    } while (0)
    assert_int_equal(try_plan(f.memory, bytes, 1, &f), 1);
    REFUSED(plan->bytes, bytes - 4);
    REFUSED(plan->decode_curves, 3);
    REFUSED(plan->encode_curves, 2);
    REFUSED(plan->target, 2);
    REFUSED(table->samples, 9);
    REFUSED(table->samples, 11);
    REFUSED(table->samples, 0xffffffff);
    REFUSED(table->one, 1023u << 22);
    REFUSED(table->most, 1);
    REFUSED(power->samples, 20);
    REFUSED(power->one, 0);
    REFUSED(power->one, 1u << 25);
    REFUSED(power->log_one, -1);
    REFUSED(power->log_one, INT32_MAX);
    REFUSED(power->exponent, 0xffffffff);
    REFUSED(samples[0], -(1 << 30));
    REFUSED(samples[500], samples[501] + 1);
    REFUSED(samples[1023], INT32_MAX);
#undef REFUSED
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_bytes_are_safe),
        cmocka_unit_test(test_any_bytes_of_curves_are_safe),
        cmocka_unit_test(test_numbers_that_cannot_be),
        cmocka_unit_test(test_curves_that_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
