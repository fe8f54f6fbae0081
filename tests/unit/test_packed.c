/* Packed rows: their bits compared with tables copied from the manual of V4L2, and plans on them compared with plans on
 * the whole frame, unpacked. */
#include "unit/random_model.h"

#include "campaign.h"

#include <lensprof/packed.h>

enum {
    MOST = 1024,  /* samples of a row */
    GUARD = 0x5A, /* of bytes that nothing may write */
    FRAME_W = 333,
    FRAME_H = 9, /* a whole frame, for plans */
    PITCH = 640  /* bytes from row to row, more than any row takes */
};

/* What the samples a, b, c, d of a group have in its bytes after the high ones, from bit 7 down to bit 0. */
static const struct {
    uint32_t packing, samples, bytes;
    const char *low[3];
} packings[] = {{LENSPROF_PACKING_RAW8, 1, 1, {NULL}},
                {LENSPROF_PACKING_RAW10, 4, 5, {"d1d0c1c0b1b0a1a0"}},
                {LENSPROF_PACKING_RAW12, 2, 3, {"b3b2b1b0a3a2a1a0"}},
                {LENSPROF_PACKING_RAW14, 4, 7, {"b1b0a5a4a3a2a1a0", "c3c2c1c0b5b4b3b2", "d5d4d3d2d1d0c5c4"}}};
#define PACKINGS (sizeof packings / sizeof *packings)

static uint32_t below(uint32_t limit, uint64_t *random) { return (uint32_t)(limit * lp_random(random)); }

/* The row of these codes, bit by bit. */
static void write_bits(size_t kind, const uint16_t *codes, uint32_t width, uint8_t *row) {
    const uint32_t samples = packings[kind].samples, bytes = packings[kind].bytes;
    for (uint32_t x = 0; x < width; x += samples, row += bytes, codes += samples) {
        for (uint32_t s = 0; s < samples; s++) row[s] = (uint8_t)(codes[s] >> (packings[kind].packing - 8));
        for (uint32_t b = samples; b < bytes; b++) {
            row[b] = 0;
            for (uint32_t bit = 0; bit < 8; bit++) {
                const char *place = packings[kind].low[b - samples] + 2 * (7 - bit);
                row[b] |= (uint8_t)((codes[place[0] - 'a'] >> (place[1] - '0') & 1) << bit);
            }
        }
    }
}

/* ---- rows ---- */

static void test_rows_have_the_bits_of_the_manual(void **state) {
    (void)state;
    static uint16_t codes[MOST], found[MOST + 1];
    static uint8_t wanted[2 * MOST], row[2 * MOST + 1];
    uint64_t random = 3;
    for (int n = 0; n < 600; n++) {
        const size_t kind = (size_t)n % PACKINGS;
        const uint32_t packing = packings[kind].packing, samples = packings[kind].samples;
        const uint32_t width = samples * (n < 60 ? 1 + (uint32_t)n / 3 : 1 + below(MOST / 4, &random));
        const size_t bytes = lensprof_packed_row_bytes(packing, width);
        for (uint32_t x = 0; x < width; x++) codes[x] = (uint16_t)below(1u << packing, &random);
        assert_int_equal(bytes, width / samples * packings[kind].bytes);
        write_bits(kind, codes, width, wanted);
        memset(row, GUARD, sizeof row), memset(found, GUARD, sizeof found);
        assert_ok(lensprof_pack_row(packing, codes, width, row + 1)); /* at any address */
        assert_memory_equal(row + 1, wanted, bytes);
        assert_int_equal(row[0], GUARD);
        assert_int_equal(row[1 + bytes], GUARD);
        assert_ok(lensprof_unpack_row(packing, row + 1, width, found));
        assert_memory_equal(found, codes, width * sizeof *codes);
        assert_int_equal(found[width], GUARD * 257);
    }
}

static void test_codes_above_the_range_are_clipped(void **state) {
    (void)state;
    for (size_t kind = 0; kind < PACKINGS; kind++) {
        const uint16_t largest = (uint16_t)((1u << packings[kind].packing) - 1);
        const uint16_t codes[4] = {largest, (uint16_t)(largest + 1), 65535, 1};
        uint16_t found[4] = {0};
        uint8_t row[7];
        assert_ok(lensprof_pack_row(packings[kind].packing, codes, 4, row));
        assert_ok(lensprof_unpack_row(packings[kind].packing, row, 4, found));
        for (int x = 0; x < 3; x++) assert_int_equal(found[x], largest);
        assert_int_equal(found[3], 1);
    }
}

static void test_rows_that_are_refused(void **state) {
    (void)state;
    static const struct {
        uint32_t packing, width;
        lensprof_status status;
    } bad[] = {{0, 4, LENSPROF_ERROR_ARGUMENT},
               {7, 4, LENSPROF_ERROR_ARGUMENT},
               {11, 4, LENSPROF_ERROR_ARGUMENT},
               {16, 4, LENSPROF_ERROR_ARGUMENT},
               {UINT32_MAX, 4, LENSPROF_ERROR_ARGUMENT},
               {10, 0, LENSPROF_ERROR_SIZE},
               {10, 2, LENSPROF_ERROR_SIZE},
               {10, 5, LENSPROF_ERROR_SIZE},
               {12, 3, LENSPROF_ERROR_SIZE},
               {14, 6, LENSPROF_ERROR_SIZE},
               {12, (1u << 20) + 2, LENSPROF_ERROR_SIZE}};
    uint16_t samples[8] = {1, 2, 3, 4, 5, 6, 7, 8}, samples_before[8];
    uint8_t row[16] = {1, 2, 3}, row_before[16];
    memcpy(samples_before, samples, sizeof samples), memcpy(row_before, row, sizeof row);
    for (size_t n = 0; n < sizeof bad / sizeof *bad; n++) {
        assert_int_equal(lensprof_packed_row_bytes(bad[n].packing, bad[n].width), 0);
        assert_int_equal(lensprof_unpack_row(bad[n].packing, row, bad[n].width, samples), bad[n].status);
        assert_int_equal(lensprof_pack_row(bad[n].packing, samples, bad[n].width, row), bad[n].status);
    }
    assert_int_equal(lensprof_unpack_row(10, NULL, 4, samples), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_unpack_row(10, row, 4, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pack_row(10, NULL, 4, row), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_pack_row(10, samples, 4, NULL), LENSPROF_ERROR_ARGUMENT);
    assert_memory_equal(samples, samples_before, sizeof samples);
    assert_memory_equal(row, row_before, sizeof row);
    assert_int_equal(lensprof_packed_row_bytes(12, 1u << 20), 3u << 19);
}

/* ---- plans ---- */

/* A plan of one kind or the other, the codes of a whole frame, and what the plan makes of them. */
typedef struct fixture {
    model m;
    int is_fixed;
    const lensprof_plan *plan;
    const lensprof_fixed_plan *fixed;
    uint64_t memory[1 << 16];
    uint16_t codes[FRAME_H][FRAME_W], corrected[FRAME_H][FRAME_W];
} fixture;

static lensprof_status apply(const fixture *f, uint32_t packing, const lensprof_packed_image *source,
                             const lensprof_packed_target *target, uint32_t x0, uint32_t y0) {
    return f->is_fixed ? lensprof_fixed_apply_packed(f->fixed, packing, source, target, x0, y0)
                       : lensprof_apply_packed(f->plan, packing, source, target, x0, y0);
}

static void prepare_plan(fixture *f) {
    if (f->is_fixed)
        assert_ok(lensprof_fixed_plan_init(f->memory, sizeof f->memory, &f->m.options, &f->fixed, NULL));
    else
        assert_ok(lensprof_plan_init(f->memory, sizeof f->memory, &f->m.options, &f->plan, NULL));
}

static void make_case(fixture *f, int is_fixed, uint32_t packing, uint64_t *random) {
    lensprof_apply_options *o = &f->m.options;
    random_model(&f->m, random);
    f->is_fixed = is_fixed;
    o->frame_width = FRAME_W, o->frame_height = FRAME_H;
    o->source_sample = o->target_sample = LENSPROF_SAMPLE_U16;
    o->source_layout = lp_random(random) < 0.3 ? LENSPROF_LAYOUT_GREY : LENSPROF_LAYOUT_RGGB + below(4, random);
    o->input = o->output = LENSPROF_ENCODING_LINEAR;
    if (is_fixed) o->grid = NULL, o->image_circle = NULL;
    if (!is_fixed && lp_random(random) < 0.5) { /* a pedestal, which stays */
        for (int c = 0; c < 3; c++) f->m.levels[0].black[c] = (1u << (packing - 4)) / 65535.0;
        f->m.levels[0].white = ((1u << packing) - 1) / 65535.0;
        o->levels = o->output_levels = &f->m.levels[0];
    }
    prepare_plan(f);
    for (uint32_t y = 0; y < FRAME_H; y++)
        for (uint32_t x = 0; x < FRAME_W; x++) f->codes[y][x] = (uint16_t)below(1u << packing, random);
    const lensprof_image from = {f->codes, FRAME_W * 2, FRAME_W, FRAME_H, LENSPROF_SAMPLE_U16, o->source_layout};
    const lensprof_target to = {f->corrected, FRAME_W * 2, FRAME_W, FRAME_H, LENSPROF_SAMPLE_U16, o->source_layout};
    if (is_fixed)
        assert_ok(lensprof_fixed_apply(f->fixed, &from, &to, 0, 0));
    else
        assert_ok(lensprof_apply(f->plan, &from, &to, 0, 0));
}

/* A tile of packed rows in a buffer of FRAME_H rows of PITCH bytes, in which nothing else may change. */
static void pack_tile(size_t kind, uint16_t (*codes)[FRAME_W], const uint32_t tile[4], int is_upside_down,
                      uint8_t (*rows)[PITCH]) {
    const uint16_t largest = (uint16_t)((1u << packings[kind].packing) - 1);
    uint16_t clipped[FRAME_W];
    for (uint32_t y = 0; y < tile[3]; y++) {
        for (uint32_t x = 0; x < tile[2]; x++) {
            const uint16_t code = codes[tile[1] + y][tile[0] + x];
            clipped[x] = code < largest ? code : largest;
        }
        write_bits(kind, clipped, tile[2], rows[is_upside_down ? FRAME_H - 1 - y : y]);
    }
}

static lensprof_packed_target view_of(uint8_t (*rows)[PITCH], const uint32_t tile[4], int is_upside_down) {
    return (lensprof_packed_target){is_upside_down ? rows[FRAME_H - 1] : rows[0], is_upside_down ? -PITCH : PITCH,
                                    tile[2], tile[3]};
}

/* Corrects a random tile, in place or not, rows in either order. Returns whether the tile changes. */
static int check_tile(const fixture *f, size_t kind, uint64_t *random) {
    static uint8_t in[FRAME_H][PITCH], in_before[FRAME_H][PITCH], out[FRAME_H][PITCH], wanted[FRAME_H][PITCH];
    const uint32_t packing = packings[kind].packing, samples = packings[kind].samples;
    uint32_t tile[4] = {0}; /* x0, y0, width, height */
    tile[2] = samples * (1 + below(FRAME_W / samples, random)), tile[3] = 1 + below(FRAME_H, random);
    tile[0] = below(FRAME_W - tile[2] + 1, random), tile[1] = below(FRAME_H - tile[3] + 1, random);
    const int from_end = lp_random(random) < 0.3, to_end = lp_random(random) < 0.3;
    memset(in, GUARD, sizeof in), memset(out, GUARD, sizeof out), memset(wanted, GUARD, sizeof wanted);
    pack_tile(kind, (uint16_t(*)[FRAME_W])f->codes, tile, from_end, in);
    pack_tile(kind, (uint16_t(*)[FRAME_W])f->corrected, tile, to_end, wanted);
    memcpy(in_before, in, sizeof in);
    const lensprof_packed_target here = view_of(in, tile, from_end), there = view_of(out, tile, to_end);
    const lensprof_packed_image source = {here.data, here.row_bytes, here.width, here.height};
    assert_ok(apply(f, packing, &source, &there, tile[0], tile[1]));
    assert_memory_equal(out, wanted, sizeof out);
    assert_memory_equal(in, in_before, sizeof in);
    memset(wanted, GUARD, sizeof wanted);
    pack_tile(kind, (uint16_t(*)[FRAME_W])f->corrected, tile, from_end, wanted);
    assert_ok(apply(f, packing, lp_random(random) < 0.5 ? NULL : &source, &here, tile[0], tile[1]));
    assert_memory_equal(in, wanted, sizeof in);
    return memcmp(in, in_before, sizeof in) != 0;
}

static void check_tiles(int is_fixed) {
    static fixture f;
    uint64_t random = 17;
    int changed = 0;
    const int cases = campaign_runs(300);
    for (int n = 0; n < cases; n++) {
        const size_t kind = (size_t)n % PACKINGS;
        make_case(&f, is_fixed, packings[kind].packing, &random);
        for (int i = 0; i < 4; i++) changed += check_tile(&f, kind, &random);
    }
    assert_true(changed > 3 * cases);
}

static void test_tiles_are_parts_of_the_unpacked_frame(void **state) {
    (void)state;
    check_tiles(0);
}

static void test_tiles_are_parts_of_the_unpacked_frame_in_integers(void **state) {
    (void)state;
    check_tiles(1);
}

/* A tile that is accepted, and changes of it that are not: none writes anything. */
static void check_refusals(fixture *f) {
    static uint8_t in[4 * PITCH], out[4 * PITCH], before[4 * PITCH];
    memset(in, 7, sizeof in), memset(out, GUARD, sizeof out), memcpy(before, out, sizeof out);
#define BAD(status, change)                                              \
    do {                                                                 \
        lensprof_packed_image from = {in + PITCH, PITCH, 64, 3};         \
        lensprof_packed_target to = {out + PITCH, PITCH, 64, 3};         \
        uint32_t packing = LENSPROF_PACKING_RAW10, x0 = 3, y0 = 1;       \
        change;                                                          \
        assert_int_equal(apply(f, packing, &from, &to, x0, y0), status); \
        assert_memory_equal(out, before, sizeof out);                    \
    } while (0)
    BAD(LENSPROF_ERROR_ARGUMENT, packing = 11);
    BAD(LENSPROF_ERROR_ARGUMENT, packing = 0);
    BAD(LENSPROF_ERROR_ARGUMENT, from.data = NULL);
    BAD(LENSPROF_ERROR_ARGUMENT, to.data = NULL);
    BAD(LENSPROF_ERROR_SIZE, from.width = to.width = 62);
    BAD(LENSPROF_ERROR_SIZE, from.width = to.width = 0);
    BAD(LENSPROF_ERROR_SIZE, from.height = to.height = 0);
    BAD(LENSPROF_ERROR_SIZE, from.width = 60);
    BAD(LENSPROF_ERROR_SIZE, to.height = 2);
    BAD(LENSPROF_ERROR_SIZE, from.row_bytes = 79); /* 64 samples have 80 bytes */
    BAD(LENSPROF_ERROR_SIZE, to.row_bytes = -79);
    BAD(LENSPROF_ERROR_SIZE, to.row_bytes = PTRDIFF_MAX);
    BAD(LENSPROF_ERROR_SIZE, from.row_bytes = PTRDIFF_MIN);
    BAD(LENSPROF_ERROR_SIZE, x0 = FRAME_W - 63);
    BAD(LENSPROF_ERROR_SIZE, y0 = FRAME_H - 2);
    BAD(LENSPROF_ERROR_SIZE, x0 = UINT32_MAX);
    BAD(LENSPROF_ERROR_SIZE, y0 = UINT32_MAX);
    BAD(LENSPROF_ERROR_ARGUMENT,
        from.data = out + PITCH - 5); /* a group before, a row before, the same rows reversed */
    BAD(LENSPROF_ERROR_ARGUMENT, from.data = out);
    BAD(LENSPROF_ERROR_ARGUMENT, from.data = out + 3 * PITCH; from.row_bytes = -PITCH);
    BAD(LENSPROF_ERROR_ARGUMENT, from.height = to.height = 1; from.data = out + PITCH + 79); /* by their last byte */
    const lensprof_packed_target to = {out + PITCH, PITCH, 64, 3};
    assert_int_equal(apply(f, LENSPROF_PACKING_RAW10, NULL, NULL, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_apply_packed(NULL, LENSPROF_PACKING_RAW10, NULL, &to, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fixed_apply_packed(NULL, LENSPROF_PACKING_RAW10, NULL, &to, 0, 0),
                     LENSPROF_ERROR_ARGUMENT);
    assert_memory_equal(out, before, sizeof out);
    /* Side by side in memory is not overlapping. */
    const lensprof_packed_image last = {out, 0, 64, 1};
    const lensprof_packed_target next = {out + 80, 0, 64, 1};
    assert_ok(apply(f, LENSPROF_PACKING_RAW10, &last, &next, 0, 0));
}

static void test_tiles_that_are_refused(void **state) {
    (void)state;
    static fixture f;
    uint64_t random = 29;
    for (int is_fixed = 0; is_fixed < 2; is_fixed++) {
        make_case(&f, is_fixed, LENSPROF_PACKING_RAW10, &random);
        check_refusals(&f);
    }
}

static void test_plans_that_are_refused(void **state) {
    (void)state;
    static fixture f;
    uint64_t random = 31;
    uint8_t row[80], before[80];
    const lensprof_packed_target view = {row, 80, 64, 1};
    memset(row, 99, sizeof row), memset(before, 99, sizeof before);
    for (int n = 0; n < 9; n++) {
        make_case(&f, n > 5, LENSPROF_PACKING_RAW10, &random);
        lensprof_apply_options *o = &f.m.options;
        o->levels = o->output_levels = NULL;
        if (n % 6 == 0) o->source_sample = o->target_sample = LENSPROF_SAMPLE_U8;
        if (n % 6 == 1) o->source_layout = LENSPROF_LAYOUT_RGB;
        if (n % 6 == 2) o->source_layout = LENSPROF_LAYOUT_GREY_ALPHA;
        if (n == 3) o->source_layout = LENSPROF_LAYOUT_PLANAR;
        if (n == 4) o->target_sample = LENSPROF_SAMPLE_F32;
        if (n == 5) o->source_sample = LENSPROF_SAMPLE_F16;
        prepare_plan(&f);
        assert_int_equal(apply(&f, LENSPROF_PACKING_RAW10, NULL, &view, 0, 0), LENSPROF_ERROR_ARGUMENT);
        assert_memory_equal(row, before, sizeof row);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_have_the_bits_of_the_manual),
        cmocka_unit_test(test_codes_above_the_range_are_clipped),
        cmocka_unit_test(test_rows_that_are_refused),
        cmocka_unit_test(test_tiles_are_parts_of_the_unpacked_frame),
        cmocka_unit_test(test_tiles_are_parts_of_the_unpacked_frame_in_integers),
        cmocka_unit_test(test_tiles_that_are_refused),
        cmocka_unit_test(test_plans_that_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
