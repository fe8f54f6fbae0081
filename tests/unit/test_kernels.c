/* The row kernels: every lane count gives the same bytes as the scalar kernel and stays within the given pixels. */
#include "campaign.h"
#include "support.h"

#include <sys/mman.h>
#include <unistd.h>

#include <core/plan.h>

enum {
    MOST_WIDTH = 67,
    ROWS = 3,
    LAYOUTS = 11,
    FRAME_W = 900,
    FRAME_H = 700
};

/* Memory whose last byte is followed by a guard page. */
typedef struct guarded {
    uint8_t *pages, *end;
    size_t bytes;
} guarded;

static guarded guarded_memory(void) {
    guarded g;
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    g.bytes = 4 * page;
    g.pages = mmap(NULL, g.bytes + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(g.pages != MAP_FAILED);
    assert_int_equal(mprotect(g.pages + g.bytes, page, PROT_NONE), 0);
    g.end = g.pages + g.bytes;
    return g;
}

typedef struct model {
    lensprof_response response[3], output[3];
    lensprof_vignetting vignetting[3];
    lensprof_gain_grid grid;
    lensprof_levels levels[2]; /* of input and output */
    lensprof_image_circle circle;
    lensprof_apply_options options;
} model;

static void random_response(lensprof_response *r, uint32_t kind, uint64_t *random) {
    double emor[3] = {lp_random(random) - 0.5, 0.4 * (lp_random(random) - 0.5), 0.2 * (lp_random(random) - 0.5)};
    double table[9] = {0.0};
    for (int i = 1; i < 9; i++) table[i] = table[i - 1] + 0.01 + lp_random(random);
    for (int i = 0; i < 9; i++) table[i] /= table[8];
    lensprof_response_set_linear(r);
    if (kind == LENSPROF_RESPONSE_GAMMA) assert_ok(lensprof_response_set_gamma(r, 0.4 + 3.0 * lp_random(random)));
    if (kind == LENSPROF_RESPONSE_TABLE) assert_ok(lensprof_response_set_table(r, table, 9));
    if (kind == LENSPROF_RESPONSE_EMOR && lensprof_response_set_emor(r, emor, 3) != LENSPROF_OK)
        assert_ok(lensprof_response_set_emor(r, emor, 1));
}

/* One of many models, selected by number. */
static void make_model(model *m, uint64_t seed) {
    uint64_t random = seed * 977 + 5;
    uint32_t kinds = (uint32_t)(5 * lp_random(&random));
    memset(m, 0, sizeof *m);
    lensprof_apply_options *o = &m->options;
    lensprof_apply_options_init(o);
    double center[2] = {0.2 * (lp_random(&random) - 0.5), 0.2 * (lp_random(&random) - 0.5)};
    for (uint32_t c = 0; c < 3; c++) {
        random_response(&m->response[c], kinds < 4 ? kinds : (uint32_t)(4 * lp_random(&random)), &random);
        for (int n = 0; n < 3; n++) m->vignetting[c].k[n] = 0.2 * (lp_random(&random) - 0.6);
        memcpy(m->vignetting[c].center, center, sizeof center);
    }
    o->response = m->response;
    o->vignetting = m->vignetting;
    o->responses = lp_random(&random) < 0.5 ? 1 : 3;
    o->vignettings = lp_random(&random) < 0.5 ? 1 : 3;
    o->frame_width = FRAME_W;
    o->frame_height = FRAME_H;
    o->source_layout = (uint32_t)(LAYOUTS * lp_random(&random));
    o->source_sample = (uint32_t)(4 * lp_random(&random));
    o->target_sample = lp_random(&random) < 0.6 ? o->source_sample : (uint32_t)(4 * lp_random(&random));
    o->direction = lp_random(&random) < 0.3;
    o->input = lp_random(&random) < 0.4;
    o->output = lp_random(&random) < 0.4;
    o->saturated = lp_random(&random) < 0.5;
    o->dither = lp_random(&random) < 0.3;
    if (lp_random(&random) < 0.3) o->strength = lp_random(&random);
    if (lp_random(&random) < 0.3) o->chroma = 1;
    if (lp_random(&random) < 0.3) o->gain_cap = 1.0 + lp_random(&random);
    o->source = (lensprof_exposure){lp_random(&random), {1.0 + lp_random(&random), 1.0, 0.8}};
    if (lp_random(&random) < 0.3) o->source = o->target;
    if (lp_random(&random) < 0.3) {
        m->grid.columns = 2 + (uint32_t)(31 * lp_random(&random));
        m->grid.rows = 2 + (uint32_t)(31 * lp_random(&random));
        m->grid.channels = lp_random(&random) < 0.5 ? 1 : 3;
        for (uint32_t i = 0; i < m->grid.columns * m->grid.rows * m->grid.channels; i++)
            m->grid.attenuation[i] = (float)(0.6 + 0.8 * lp_random(&random));
        o->grid = &m->grid;
    }
    for (uint32_t end = 0; end < 2; end++) {
        const double black = 0.2 * lp_random(&random) - 0.05;
        for (int c = 0; c < 3; c++) m->levels[end].black[c] = kinds % 2 ? black : black + 0.1 * lp_random(&random);
        m->levels[end].white = lp_random(&random) < 0.3 ? 0.0 : 0.5 + 0.5 * lp_random(&random);
    }
    if (lp_random(&random) < 0.3) o->levels = &m->levels[0];
    if (lp_random(&random) < 0.3) o->output_levels = lp_random(&random) < 0.5 ? o->levels : &m->levels[1];
    for (int d = 0; d < 2; d++) m->circle.center[d] = lp_random(&random) - 0.5;
    m->circle.radius = 0.05 + lp_random(&random);
    if (lp_random(&random) < 0.3) o->image_circle = &m->circle;
    if (lp_random(&random) < 0.7) return;
    o->output_responses = lp_random(&random) < 0.5 ? 1 : 3;
    o->output_response = m->output;
    for (uint32_t c = 0; c < 3; c++) random_response(&m->output[c], (uint32_t)(4 * lp_random(&random)), &random);
}

/* The kernel of a lane count, 0 = that with gathers, also where it is not the fastest. */
static lp_row_kernel *kernel_of(uint32_t lanes) {
#if defined(__x86_64__)
    if (!lanes && lp_row_best(16) == lp_row_avx512) return lp_row_gathers;
#endif
    return lp_row_best(lanes);
}

static void *make_plan(const model *m, uint32_t lanes, const lensprof_plan **plan) {
    size_t bytes = lensprof_plan_bytes(&m->options);
    void *memory = malloc(bytes);
    assert_true(bytes > 0);
    assert_ok(lensprof_plan_init(memory, bytes, &m->options, plan, NULL));
    ((lensprof_plan *)memory)->row = kernel_of(lanes);
    return memory;
}

static void fill_samples(uint8_t *p, size_t bytes, uint32_t sample, uint64_t random) {
    for (size_t i = 0; i + 4 <= bytes; i += 4) {
        float value = (float)(1.3 * lp_random(&random) - 0.1);
        uint32_t any = (uint32_t)(4294967296.0 * lp_random(&random));
        if (sample == LENSPROF_SAMPLE_F32 && any % 50 == 0) value = (float)NAN;
        if (sample == LENSPROF_SAMPLE_F32)
            memcpy(p + i, &value, 4);
        else
            memcpy(p + i, &any, 4);
        if (sample == LENSPROF_SAMPLE_F16) p[i + 1] &= 0x3f, p[i + 3] &= 0x3f;                 /* 0..2 */
        if (sample < 2 && i % 64 < 24) p[i] = p[i + 1] = p[i + 2] = p[i + 3] = 255 - any % 32; /* near white */
    }
}

/* Rows of a tile that end at the end of the guarded memory, with `gap` bytes between rows. */
static lensprof_target tile_in(const guarded *g, uint32_t sample, uint32_t layout, uint32_t width, size_t gap) {
    uint32_t bytes = lensprof_sample_type_bytes(sample) * lensprof_layout_samples(layout);
    lensprof_target tile = {NULL, (ptrdiff_t)(width * bytes + gap), width, ROWS, sample, layout};
    tile.data = g->end - (width * bytes + (size_t)(ROWS - 1) * (size_t)tile.row_bytes);
    return tile;
}

static void apply_rows_streamed(const lensprof_plan *plan, const lensprof_image *from, const lensprof_target *to,
                                uint32_t x0, uint32_t y0) {
    for (uint32_t y = 0; y < ROWS; y++) {
        const uint8_t *source[3] = {(const uint8_t *)from->data + y * from->row_bytes, NULL, NULL};
        uint8_t *target[3] = {(uint8_t *)to->data + y * to->row_bytes, NULL, NULL};
        uint32_t columns[2];
        plan->row(plan, source, target, x0, y0 + y, from->width, lp_columns_inside(plan, y0 + y, columns), 1);
    }
}

static void check_case(uint64_t seed, uint32_t width, const guarded *in, const guarded *out, uint8_t *wanted) {
    model m;
    make_model(&m, seed);
    if (m.options.source_layout == LENSPROF_LAYOUT_PLANAR) m.options.source_layout = LENSPROF_LAYOUT_RGB;
    uint64_t random = seed + 7;
    uint32_t x0 = (uint32_t)((FRAME_W - width) * lp_random(&random)),
             y0 = (uint32_t)((FRAME_H - ROWS) * lp_random(&random));
    size_t gap = 4 * (size_t)(4 * lp_random(&random));
    const lensprof_target read = tile_in(in, m.options.source_sample, m.options.source_layout, width, gap);
    const lensprof_image from = lp_image_of(&read);
    const lensprof_target to = tile_in(out, m.options.target_sample, m.options.source_layout, width, gap);
    const uint32_t lanes[] = {1, 4, 8, 16, 0};
    int in_place = m.options.source_sample == m.options.target_sample && seed % 3 == 0;
    for (int n = 0; n < 5; n++) {
        const lensprof_plan *plan;
        void *memory = make_plan(&m, lanes[n], &plan);
        fill_samples(in->pages, in->bytes, m.options.source_sample, seed);
        memset(out->pages, 0xA5, out->bytes);
        if (in_place) memcpy(out->pages, in->pages, in->bytes);
        if (n && seed % 5 == 0 && !in_place)
            apply_rows_streamed(plan, &from, &to, x0, y0);
        else
            assert_ok(lensprof_apply(plan, in_place ? NULL : &from, &to, x0, y0));
        if (n == 0)
            memcpy(wanted, out->pages, out->bytes);
        else if (memcmp(wanted, out->pages, out->bytes))
            fail_msg("model %llu, width %u, layout %u, samples %u to %u: bytes of %u lanes differ",
                     (unsigned long long)seed, width, m.options.source_layout, m.options.source_sample,
                     m.options.target_sample, lanes[n]);
        free(memory);
    }
}

static void test_every_lane_count_gives_the_same_bytes(void **state) {
    (void)state;
    guarded in = guarded_memory(), out = guarded_memory();
    uint8_t *wanted = malloc(out.bytes);
    const uint64_t short_rows = (uint64_t)campaign_runs(6000), long_rows = (uint64_t)campaign_runs(200);
    for (uint64_t seed = 0; seed < short_rows; seed++)
        check_case(seed, 1 + (uint32_t)(seed % MOST_WIDTH), &in, &out, wanted);
    for (uint64_t seed = 6000; seed < 6000 + long_rows; seed++)
        check_case(seed, 250 + (uint32_t)(seed % 20), &in, &out, wanted);
    free(wanted);
}

/* Rows long enough for guessing the table positions of values: smooth responses, for which guesses are right, and
 * responses with kinks, for which many are wrong. Nothing after the last sample is touched. test_guess.c counts the
 * guesses. */
static void test_long_rows_of_values(void **state) {
    (void)state;
    enum {
        W = 701
    };
    static float wanted[3 * W];
    const guarded in = guarded_memory(), out = guarded_memory();
    float *source = (float *)(void *)(in.end - sizeof wanted), *target = (float *)(void *)(out.end - sizeof wanted);
    const uint32_t lanes[] = {1, 4, 8, 16, 0};
    for (uint64_t seed = 0; seed < 120; seed++) {
        uint64_t random = seed;
        model m;
        make_model(&m, seed);
        m.options.source_layout = LENSPROF_LAYOUT_RGB;
        m.options.source_sample = m.options.target_sample = LENSPROF_SAMPLE_F32;
        m.options.input = m.options.output = LENSPROF_ENCODING_RESPONSE;
        m.options.responses = 1;
        random_response(&m.response[0], seed % 3 ? LENSPROF_RESPONSE_EMOR : LENSPROF_RESPONSE_TABLE, &random);
        fill_samples((uint8_t *)source, sizeof wanted, LENSPROF_SAMPLE_F32, seed);
        const float rare[] = {0.0f, -0.0f, 1.0f, INFINITY, -INFINITY, 1e-42f, -1e30f, 1e30f, 0.99999994f};
        for (size_t i = 0; i < 500; i++)
            source[(size_t)(3 * W * lp_random(&random))] = rare[i % (sizeof rare / sizeof *rare)];
        const lensprof_image from = {source, 0, W, 1, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB};
        lensprof_target to = {wanted, 0, W, 1, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB};
        for (int n = 0; n < 5; n++) {
            const lensprof_plan *plan;
            void *memory = make_plan(&m, lanes[n], &plan);
            to.data = n ? target : wanted;
            assert_ok(lensprof_apply(plan, &from, &to, 5, 100));
            if (n) assert_memory_equal(target, wanted, sizeof wanted);
            free(memory);
        }
    }
}

/* A row processed in pieces, split anywhere, equals the whole row. */
static void test_pieces_give_the_row(void **state) {
    (void)state;
    static uint8_t source[4 * 4 * FRAME_W], whole[4 * 4 * FRAME_W], pieces[4 * 4 * FRAME_W];
    for (uint64_t seed = 0; seed < 300; seed++) {
        model m;
        make_model(&m, seed);
        if (m.options.source_layout == LENSPROF_LAYOUT_PLANAR) continue;
        const lensprof_plan *plan;
        void *memory = make_plan(&m, 0, &plan);
        uint32_t samples = lensprof_layout_samples(m.options.source_layout);
        uint32_t in = samples * lensprof_sample_type_bytes(m.options.source_sample),
                 out = samples * lensprof_sample_type_bytes(m.options.target_sample);
        fill_samples(source, sizeof source, m.options.source_sample, seed);
        lensprof_image from = {source, 0, FRAME_W, 1, m.options.source_sample, m.options.source_layout};
        lensprof_target to = {whole, 0, FRAME_W, 1, m.options.target_sample, m.options.source_layout};
        assert_ok(lensprof_apply(plan, &from, &to, 0, 77));
        uint64_t random = seed;
        for (uint32_t x = 0; x < FRAME_W;) {
            uint32_t width = 1 + (uint32_t)(FRAME_W / 4 * lp_random(&random));
            if (width > FRAME_W - x) width = FRAME_W - x;
            from.data = source + x * in, to.data = pieces + x * out;
            from.width = to.width = width;
            assert_ok(lensprof_apply(plan, &from, &to, x, 77));
            x += width;
        }
        assert_memory_equal(pieces, whole, (size_t)FRAME_W * out);
        free(memory);
    }
}

/* Planes give the same result as interleaved pixels. */
static void test_planes_are_the_same_picture(void **state) {
    (void)state;
    enum {
        W = 301
    };
    static uint8_t rgb[12 * W], target[12 * W], planes[3][4 * W], result[3][4 * W];
    for (uint64_t seed = 0; seed < 400; seed++) {
        model m;
        make_model(&m, seed);
        uint32_t in = lensprof_sample_type_bytes(m.options.source_sample),
                 out = lensprof_sample_type_bytes(m.options.target_sample);
        fill_samples(rgb, sizeof rgb, m.options.source_sample, seed);
        const lensprof_image from = {rgb, 0, W, 1, m.options.source_sample, LENSPROF_LAYOUT_RGB};
        const lensprof_target to = {target, 0, W, 1, m.options.target_sample, LENSPROF_LAYOUT_RGB};
        lensprof_image sources[3];
        lensprof_target targets[3];
        for (uint32_t c = 0; c < 3; c++) {
            for (uint32_t i = 0; i < W; i++) memcpy(planes[c] + i * in, rgb + (3 * i + c) * in, in);
            sources[c] = (lensprof_image){planes[c], 0, W, 1, m.options.source_sample, LENSPROF_LAYOUT_GREY};
            targets[c] = (lensprof_target){result[c], 0, W, 1, m.options.target_sample, LENSPROF_LAYOUT_GREY};
        }
        const lensprof_plan *plan;
        m.options.source_layout = LENSPROF_LAYOUT_RGB;
        void *memory = make_plan(&m, 0, &plan);
        assert_ok(lensprof_apply(plan, &from, &to, 40, 50));
        assert_int_equal(lensprof_apply_planar(plan, sources, targets, 40, 50), LENSPROF_ERROR_ARGUMENT);
        free(memory);
        m.options.source_layout = LENSPROF_LAYOUT_PLANAR;
        memory = make_plan(&m, 0, &plan);
        assert_ok(lensprof_apply_planar(plan, sources, targets, 40, 50));
        for (uint32_t c = 0; c < 3; c++)
            for (uint32_t i = 0; i < W; i++) assert_memory_equal(result[c] + i * out, target + (3 * i + c) * out, out);
        free(memory);
    }
}

enum {
    SIDE = 8
};

/* A plan for planes of 8 bit; data 0..2 are those of the sources, 3..5 those of the targets. */
typedef struct planes {
    uint8_t data[6][SIDE * SIDE];
    lensprof_image source[3];
    lensprof_target target[3];
    model m;
    void *memory;
    const lensprof_plan *plan;
} planes;

static void make_planes(planes *p) {
    memset(p->data, 77, sizeof p->data);
    for (int v = 0; v < 3; v++) {
        p->source[v] = (lensprof_image){p->data[v], SIDE, SIDE, SIDE, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY};
        p->target[v] = (lensprof_target){p->data[3 + v], SIDE, SIDE, SIDE, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY};
    }
    make_model(&p->m, 1);
    p->m.options.source_layout = LENSPROF_LAYOUT_PLANAR;
    p->m.options.source_sample = p->m.options.target_sample = LENSPROF_SAMPLE_U8;
    p->memory = make_plan(&p->m, 0, &p->plan);
}

static void assert_untouched(const planes *p) {
    for (int v = 0; v < 6; v++)
        for (int i = 0; i < SIDE * SIDE; i++) assert_int_equal(p->data[v][i], 77);
}

static void test_planes_that_are_refused(void **state) {
    (void)state;
    static planes p;
    make_planes(&p);
    const lensprof_image *source = p.source;
    lensprof_image narrow[3];
    lensprof_target *target = p.target, wrong[3];
    assert_int_equal(lensprof_apply(p.plan, source, target, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_apply_planar(NULL, source, target, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_apply_planar(p.plan, source, target, FRAME_W, 0), LENSPROF_ERROR_SIZE);
    memcpy(wrong, target, sizeof wrong);
    wrong[2].data = p.data[3]; /* two targets at the same address */
    assert_int_equal(lensprof_apply_planar(p.plan, source, wrong, 0, 0), LENSPROF_ERROR_ARGUMENT);
    wrong[2].data = p.data[0]; /* another plane's source */
    assert_int_equal(lensprof_apply_planar(p.plan, source, wrong, 0, 0), LENSPROF_ERROR_ARGUMENT);
    memcpy(narrow, source, sizeof narrow);
    narrow[1].width = SIDE - 1;
    assert_int_equal(lensprof_apply_planar(p.plan, narrow, target, 0, 0), LENSPROF_ERROR_SIZE);
    memcpy(wrong, target, sizeof wrong);
    wrong[1].layout = LENSPROF_LAYOUT_RGB, wrong[1].row_bytes = 3 * SIDE;
    assert_int_equal(lensprof_apply_planar(p.plan, source, wrong, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_untouched(&p);
    for (int v = 0; v < 3; v++) wrong[v] = target[v], wrong[v].data = p.data[v];
    assert_ok(lensprof_apply_planar(p.plan, source, wrong, 0, 0)); /* each in place */
    assert_ok(lensprof_apply_planar(p.plan, NULL, target, 0, 0));
    assert_memory_equal(p.data[0], p.data[3], sizeof p.data / 2);
    free(p.memory);
}

/* All six views are checked before any two are compared: unchecked members must not enter a calculation. */
static void test_planes_are_checked_before_they_are_compared(void **state) {
    (void)state;
    static const ptrdiff_t strides[] = {PTRDIFF_MIN, PTRDIFF_MAX, PTRDIFF_MIN / 2};
    static planes p;
    make_planes(&p);
    for (int n = 0; n < 6; n++)
        for (size_t i = 0; i < sizeof strides / sizeof *strides; i++) {
            ptrdiff_t *stride = n < 3 ? &p.source[n].row_bytes : &p.target[n - 3].row_bytes;
            *stride = strides[i];
            assert_int_equal(lensprof_apply_planar(p.plan, p.source, p.target, 0, 0), LENSPROF_ERROR_SIZE);
            *stride = SIDE;
        }
    assert_untouched(&p);
    free(p.memory);
}

/* Each site of a mosaic gets the same result as its channel in a picture of that colour alone. */
static void test_mosaics_follow_their_pattern(void **state) {
    (void)state;
    enum {
        W = 131,
        H = 7
    };
    static const char *patterns[] = {"RGGB", "GRBG", "GBRG", "BGGR"};
    static uint16_t mosaic[H][W], result[H][W], rgb[H][3 * W], full[H][3 * W];
    for (uint32_t n = 0; n < 40; n++) {
        model m;
        make_model(&m, n);
        m.options.source_sample = m.options.target_sample = LENSPROF_SAMPLE_U16;
        m.options.saturated = LENSPROF_SATURATED_AS_VALUE;
        fill_samples((uint8_t *)mosaic, sizeof mosaic, LENSPROF_SAMPLE_U16, n);
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < 3 * W; x++) rgb[y][x] = mosaic[y][x / 3];
        const uint32_t x0 = 11 * (n % 3), y0 = n % 2;
        const uint32_t layout = LENSPROF_LAYOUT_RGGB + n % 4;
        const lensprof_image from = {mosaic, sizeof *mosaic, W, H, LENSPROF_SAMPLE_U16, layout};
        const lensprof_target to = {result, sizeof *result, W, H, LENSPROF_SAMPLE_U16, layout};
        const lensprof_image from_rgb = {rgb, sizeof *rgb, W, H, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB};
        const lensprof_target to_rgb = {full, sizeof *full, W, H, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB};
        const lensprof_plan *plan;
        m.options.source_layout = from.layout;
        void *memory = make_plan(&m, 0, &plan);
        assert_ok(lensprof_apply(plan, &from, &to, x0, y0));
        free(memory);
        m.options.source_layout = LENSPROF_LAYOUT_RGB;
        memory = make_plan(&m, 0, &plan);
        assert_ok(lensprof_apply(plan, &from_rgb, &to_rgb, x0, y0));
        free(memory);
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) {
                char colour = patterns[n % 4][2 * ((y0 + y) & 1) + ((x0 + x) & 1)];
                assert_int_equal(result[y][x], full[y][3 * x + (colour == 'R' ? 0 : colour == 'G' ? 1 : 2)]);
            }
    }
}

/* Half floats survive a round trip; other values go to the nearest half, ties to even. */
static void test_half_floats(void **state) {
    (void)state;
    static uint16_t half[65536], back[65536];
    static float wide[65536];
    model m;
    make_model(&m, 0);
    lensprof_apply_options *o = &m.options;
    lensprof_apply_options_init(o);
    memset(m.vignetting, 0, sizeof m.vignetting);
    lensprof_response_set_linear(m.response);
    o->response = m.response, o->vignetting = m.vignetting;
    o->frame_width = 65536, o->frame_height = 1;
    o->input = o->output = LENSPROF_ENCODING_LINEAR;
    o->source_layout = LENSPROF_LAYOUT_GREY;
    for (uint32_t h = 0; h < 65536; h++) half[h] = (uint16_t)h;
    const lensprof_image image = {half, 0, 65536, 1, LENSPROF_SAMPLE_F16, LENSPROF_LAYOUT_GREY},
                         from_float = {wide, 0, 65536, 1, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_GREY};
    const lensprof_target as_float = {wide, 0, 65536, 1, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_GREY},
                          again = {back, 0, 65536, 1, LENSPROF_SAMPLE_F16, LENSPROF_LAYOUT_GREY};
    const lensprof_plan *plan;
    o->source_sample = LENSPROF_SAMPLE_F16, o->target_sample = LENSPROF_SAMPLE_F32;
    void *memory = make_plan(&m, 0, &plan);
    assert_ok(lensprof_apply(plan, &image, &as_float, 0, 0));
    free(memory);
    for (uint32_t h = 0; h < 65536; h++) {
        int exponent = (int)(h >> 10 & 31);
        double size = exponent ? ldexp(1.0 + (h & 0x3ff) / 1024.0, exponent - 15) : ldexp((h & 0x3ff) / 1024.0, -14);
        if (exponent < 31)
            assert_true((double)wide[h] == (h & 0x8000 ? -size : size));
        else
            assert_true(h & 0x3ff ? isnan(wide[h]) : isinf(wide[h]));
    }
    o->source_sample = LENSPROF_SAMPLE_F32, o->target_sample = LENSPROF_SAMPLE_F16;
    memory = make_plan(&m, 0, &plan);
    assert_ok(lensprof_apply(plan, &from_float, &again, 0, 0));
    for (uint32_t h = 0; h < 65536; h++)
        if ((h >> 10 & 31) < 31 || !(h & 0x3ff)) assert_int_equal(back[h], h);
    for (uint32_t h = 0; h < 0x7bff; h++) wide[h] = 0.5f * (wide[h] + wide[h + 1]); /* exactly between two */
    assert_ok(lensprof_apply(plan, &from_float, &again, 0, 0));
    for (uint32_t h = 0; h < 0x7bff; h++) assert_int_equal(back[h], h + (h & 1));
    for (uint32_t h = 0; h < 0x7bff; h++) wide[h] = nextafterf(wide[h], 1e9f);
    assert_ok(lensprof_apply(plan, &from_float, &again, 0, 0));
    for (uint32_t h = 0; h < 0x7bff; h++) assert_int_equal(back[h], h + 1);
    wide[0] = 65519.0f, wide[1] = 65520.0f;
    assert_ok(lensprof_apply(plan, &from_float, &again, 0, 0));
    assert_int_equal(back[0], 0x7bff);
    assert_int_equal(back[1], 0x7c00);
    free(memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_lane_count_gives_the_same_bytes),
        cmocka_unit_test(test_long_rows_of_values),
        cmocka_unit_test(test_pieces_give_the_row),
        cmocka_unit_test(test_planes_are_the_same_picture),
        cmocka_unit_test(test_planes_that_are_refused),
        cmocka_unit_test(test_planes_are_checked_before_they_are_compared),
        cmocka_unit_test(test_mosaics_follow_their_pattern),
        cmocka_unit_test(test_half_floats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
