/* Applying a model to pixels, compared with the formula in double precision. */
#include "core/exposure.h"
#include "core/image.h"
#include "support.h"

#include "campaign.h"

#include <lensprof/apply.h>

enum {
    W = 37,
    H = 23
};
static const double steps[3] = {255.0, 65535.0, 0.0};

typedef struct fixture {
    lensprof_response response[3], output[3];
    lensprof_vignetting vignetting[3];
    lensprof_gain_grid grid;
    lensprof_apply_options options;
    void *memory;
    const lensprof_plan *plan;
} fixture;

static void make_response(lensprof_response *response, uint32_t kind, int c) {
    const double emor[3] = {0.8, -0.3, 0.1}, table[4] = {0.0, 0.6, 0.9, 1.0};
    if (kind == LENSPROF_RESPONSE_LINEAR)
        lensprof_response_set_linear(response);
    else if (kind == LENSPROF_RESPONSE_GAMMA)
        assert_ok(lensprof_response_set_gamma(response, 2.0 + 0.2 * c));
    else if (kind == LENSPROF_RESPONSE_EMOR)
        assert_ok(lensprof_response_set_emor(response, emor, 1 + (uint32_t)c));
    else
        assert_ok(lensprof_response_set_table(response, table, 4));
}

static void make_model(fixture *f, uint32_t kind, uint32_t curves) {
    lensprof_apply_options_init(&f->options);
    for (int c = 0; c < 3; c++) {
        make_response(&f->response[c], kind, c);
        f->vignetting[c] = (lensprof_vignetting){{-0.4 + 0.1 * c, 0.1, -0.1}, {0.03, -0.05}};
    }
    f->options.response = f->response;
    f->options.vignetting = f->vignetting;
    f->options.responses = f->options.vignettings = curves;
    f->options.frame_width = W;
    f->options.frame_height = H;
    f->options.source = (lensprof_exposure){0.7, {1.1, 1.0, 0.9}};
    f->options.target = (lensprof_exposure){0.3, {1.0, 1.0, 1.05}};
    f->options.saturated = LENSPROF_SATURATED_AS_VALUE;
}

/* Random attenuations of 0.6..1.4. */
static void make_grid(fixture *f, uint32_t columns, uint32_t rows, uint32_t channels) {
    uint64_t random = columns + 100 * rows;
    lensprof_gain_grid_init(&f->grid);
    f->grid.columns = columns, f->grid.rows = rows, f->grid.channels = channels;
    for (uint32_t i = 0; i < columns * rows * channels; i++)
        f->grid.attenuation[i] = (float)(0.6 + 0.8 * lp_random(&random));
    f->options.grid = &f->grid;
}

static void make_plan(fixture *f) {
    size_t bytes = lensprof_plan_bytes(&f->options);
    assert_true(bytes > 0);
    f->memory = malloc(bytes);
    assert_ok(lensprof_plan_init(f->memory, bytes, &f->options, &f->plan, NULL));
}

/* The formula of apply.h for one sample; channel -1 is grey (treated as green). */
static double reference(const fixture *f, double value, int channel, double x, double y) {
    const lensprof_apply_options *o = &f->options;
    int c = channel < 0 ? 1 : channel, one_r = o->responses == 3 ? c : 0, one_v = o->vignettings == 3 ? c : 0;
    const lensprof_response *r = &f->response[one_r];
    const lensprof_response *out = o->output_responses ? &f->output[o->output_responses == 3 ? c : 0] : r;
    double m = lensprof_vignetting_eval(&f->vignetting[one_v],
                                        lensprof_vignetting_r2(&f->vignetting[one_v], W, H, x, y, NULL), NULL);
    if (o->grid) m *= lensprof_gain_grid_eval(o->grid, W, H, x, y, (uint32_t)c);
    double ratio = lp_exposure_factor(&o->target, (uint32_t)c) / lp_exposure_factor(&o->source, (uint32_t)c);
    double light = o->input == LENSPROF_ENCODING_LINEAR ? value : lensprof_response_invert(r, value, NULL);
    light *= o->direction == LENSPROF_DIRECTION_CORRECT ? ratio / m : m / ratio;
    return o->output == LENSPROF_ENCODING_LINEAR ? light : lensprof_response_eval(out, light, NULL);
}

static void put(uint8_t *p, uint32_t sample, double value) {
    if (sample == LENSPROF_SAMPLE_U8) *p = (uint8_t)lround(value * 255.0);
    uint16_t u = (uint16_t)lround(value * 65535.0);
    float v = (float)value;
    if (sample == LENSPROF_SAMPLE_U16) memcpy(p, &u, 2);
    if (sample == LENSPROF_SAMPLE_F32) memcpy(p, &v, 4);
}

static double get(const uint8_t *p, uint32_t sample) {
    uint16_t u;
    float v;
    if (sample == LENSPROF_SAMPLE_U8) return *p / 255.0;
    if (sample == LENSPROF_SAMPLE_U16) return memcpy(&u, p, 2), u / 65535.0;
    return memcpy(&v, p, 4), (double)v;
}

static lensprof_target make_image(uint32_t sample, uint32_t layout, uint64_t seed) {
    lensprof_target image = {NULL, 0, W, H, sample, layout};
    uint32_t bytes = lensprof_sample_type_bytes(sample), count = W * H * lensprof_layout_samples(layout);
    image.row_bytes = (ptrdiff_t)(W * lensprof_layout_samples(layout) * bytes);
    uint8_t *data = malloc((size_t)count * bytes);
    for (uint32_t i = 0; i < count; i++) put(data + (size_t)i * bytes, sample, lp_random(&seed));
    image.data = data;
    return image;
}

/* lensprof_apply from the pixels of a target. */
static lensprof_status apply(const lensprof_plan *plan, const lensprof_target *source, const lensprof_target *target,
                             uint32_t x0, uint32_t y0) {
    const lensprof_image from = lp_image_of(source);
    return lensprof_apply(plan, &from, target, x0, y0);
}

static int channel_of(uint32_t layout, uint32_t s) {
    if (s >= lensprof_layout_channels(layout)) return -2; /* alpha */
    if (lensprof_layout_channels(layout) == 1) return -1;
    return (int)(layout == LENSPROF_LAYOUT_BGR || layout == LENSPROF_LAYOUT_BGRA ? 2 - s : s);
}

static void compare(const fixture *f, const lensprof_target *source, const lensprof_target *target) {
    uint32_t samples = lensprof_layout_samples(source->layout), sb = lensprof_sample_type_bytes(source->sample),
             tb = lensprof_sample_type_bytes(target->sample);
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++)
            for (uint32_t s = 0; s < samples; s++) {
                double in = get((const uint8_t *)source->data + y * source->row_bytes + (size_t)(x * samples + s) * sb,
                                source->sample);
                double out = get((uint8_t *)target->data + y * target->row_bytes + (size_t)(x * samples + s) * tb,
                                 target->sample);
                int channel = channel_of(source->layout, s);
                double expected = channel == -2 ? in : reference(f, in, channel, x, y), tolerance = 2e-6;
                if (target->sample != LENSPROF_SAMPLE_F32) {
                    expected = fmin(fmax(expected, 0.0), 1.0);
                    tolerance = (0.5 + 0.02) / steps[target->sample] + 1e-6;
                }
                assert_close(out, expected, tolerance + 2e-6 * fabs(expected));
            }
}

/* Chroma: a neutral scene under the falloff becomes neutral with its luminance, by polynomials and a grid. */
static void test_chroma_keeps_luminance(void **state) {
    (void)state;
    const double weight[3] = {0.2126, 0.7152, 0.0722};
    for (uint32_t n = 0; n < 8; n++) {
        fixture f;
        make_model(&f, LENSPROF_RESPONSE_LINEAR, 3);
        if (n % 2) make_grid(&f, 5, 4, 3);
        f.options.strength = n / 2 % 2 ? 0.4 : 1.0;
        f.options.gain_cap = n / 4 ? 1.02 : 0.0;
        f.options.source = f.options.target, f.options.chroma = 1;
        f.options.source_sample = f.options.target_sample = LENSPROF_SAMPLE_F32;
        make_plan(&f);
        lensprof_target image = make_image(LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB, 1);
        double m[H][W][3], luminance[H][W];
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) {
                luminance[y][x] = 0.0;
                for (uint32_t c = 0; c < 3; c++) {
                    const lensprof_vignetting *v = &f.vignetting[c];
                    m[y][x][c] = lensprof_vignetting_eval(v, lensprof_vignetting_r2(v, W, H, x, y, NULL), NULL);
                    if (n % 2) m[y][x][c] *= lensprof_gain_grid_eval(&f.grid, W, H, x, y, c);
                    m[y][x][c] = 1.0 + f.options.strength * (m[y][x][c] - 1.0);
                    luminance[y][x] += weight[c] * m[y][x][c];
                    ((float *)image.data)[(y * W + x) * 3 + c] = (float)(0.5 * m[y][x][c]);
                }
            }
        assert_ok(lensprof_apply(f.plan, NULL, &image, 0, 0));
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++)
                for (uint32_t c = 0; c < 3; c++) {
                    const double ratio = fmax(m[y][x][c] / luminance[y][x], n / 4 ? 1.0 / 1.02 : 0.0);
                    assert_close(((float *)image.data)[(y * W + x) * 3 + c], 0.5 * m[y][x][c] / ratio, 2e-6);
                }
        free(image.data), free(f.memory);
    }
}

/* Chroma with one falloff, and of grey pixels: none. */
static void test_chroma_of_one_falloff_is_none(void **state) {
    (void)state;
    for (uint32_t layout = 0; layout < 3; layout += 2) {
        fixture f;
        make_model(&f, LENSPROF_RESPONSE_LINEAR, layout ? 1 : 3);
        f.options.source = f.options.target, f.options.chroma = 1, f.options.source_layout = layout;
        f.options.source_sample = f.options.target_sample = LENSPROF_SAMPLE_F32;
        make_plan(&f);
        lensprof_target image = make_image(LENSPROF_SAMPLE_F32, layout, 1);
        lensprof_target before = make_image(LENSPROF_SAMPLE_F32, layout, 1);
        assert_ok(lensprof_apply(f.plan, NULL, &image, 0, 0));
        assert_memory_equal(image.data, before.data, (size_t)image.row_bytes * H);
        free(image.data), free(before.data), free(f.memory);
    }
}

/* Every input and output sample type, layout, response kind, direction and encoding, with one and three curves. */
static void test_every_format_follows_the_formula(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 3 * 3 * 6 * 4 * 2 * 2 * 2 * 2; n += campaign_step()) {
        fixture f;
        uint32_t k = n, source_sample = k % 3, target_sample = (k /= 3) % 3, layout = (k /= 3) % 6, kind = (k /= 6) % 4;
        make_model(&f, kind, (k /= 4) % 2 ? 3 : 1);
        f.options.direction = (k /= 2) % 2;
        f.options.input = (k /= 2) % 2;
        f.options.output = (k /= 2) % 2;
        f.options.source_sample = source_sample;
        f.options.target_sample = target_sample;
        f.options.source_layout = layout;
        make_plan(&f);
        lensprof_target source = make_image(source_sample, layout, n), target = make_image(target_sample, layout, 1);
        assert_ok(apply(f.plan, &source, &target, 0, 0));
        compare(&f, &source, &target);
        free(source.data), free(target.data), free(f.memory);
    }
}

/* Every kind of response for input and output, one and three of each, encoded and linear, corrected and simulated. */
static void test_output_has_a_response_of_its_own(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 3 * 3 * 4 * 4 * 2 * 2 * 2 * 2; n += campaign_step()) {
        fixture f;
        uint32_t k = n, source_sample = k % 3, target_sample = (k /= 3) % 3, kind = (k /= 3) % 4, out = (k /= 4) % 4;
        make_model(&f, kind, (k /= 4) % 2 ? 3 : 1);
        for (int c = 0; c < 3; c++) make_response(&f.output[c], out, 2 - c);
        f.options.output_response = f.output;
        f.options.output_responses = (k /= 2) % 2 ? 3 : 1;
        f.options.direction = (k /= 2) % 2;
        f.options.output = (k /= 2) % 2;
        f.options.source_sample = source_sample;
        f.options.target_sample = target_sample;
        f.options.source_layout = n % 6;
        make_plan(&f);
        lensprof_target source = make_image(source_sample, n % 6, n), target = make_image(target_sample, n % 6, 1);
        assert_ok(apply(f.plan, &source, &target, 0, 0));
        compare(&f, &source, &target);
        /* If the output response equals the input response, the plan is the same as without an output response. */
        if (f.options.responses == f.options.output_responses) {
            lensprof_target same = make_image(target_sample, n % 6, 2), plain = make_image(target_sample, n % 6, 3);
            for (int own = 0; own < 2; own++) {
                f.options.output_response = own ? f.response : NULL;
                f.options.output_responses = own ? f.options.responses : 0;
                free(f.memory);
                make_plan(&f);
                assert_ok(apply(f.plan, &source, own ? &same : &plain, 0, 0));
            }
            assert_memory_equal(same.data, plain.data, (size_t)same.row_bytes * H);
            free(same.data), free(plain.data);
        }
        free(source.data), free(target.data), free(f.memory);
    }
}

static void test_gain_grids_follow_the_formula(void **state) {
    (void)state;
    static const uint32_t sides[][2] = {{2, 2}, {7, 5}, {32, 32}, {2, 32}};
    for (uint32_t n = 0; n < 4 * 2 * 2 * 6 * 3; n++) {
        fixture f;
        uint32_t k = n, side = k % 4, channels = (k /= 4) % 2 ? 3 : 1, direction = (k /= 2) % 2, layout = (k /= 2) % 6;
        make_model(&f, LENSPROF_RESPONSE_EMOR, n % 5 ? 1 : 3);
        make_grid(&f, sides[side][0], sides[side][1], channels);
        f.options.direction = direction;
        f.options.source_layout = layout;
        f.options.source_sample = f.options.target_sample = (k /= 6) % 3;
        make_plan(&f);
        memset(&f.grid.attenuation, 0, sizeof f.grid.attenuation); /* the plan has its own copy */
        lensprof_target source = make_image(k % 3, layout, n), target = make_image(k % 3, layout, 1);
        assert_ok(apply(f.plan, &source, &target, 0, 0));
        make_grid(&f, sides[side][0], sides[side][1], channels);
        compare(&f, &source, &target);
        free(source.data), free(target.data), free(f.memory);
    }
}

/* A grid of ones, an empty grid and NULL give the same result. */
static void test_no_gain_grid(void **state) {
    (void)state;
    lensprof_target source = make_image(LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB, 3), target[3];
    for (int n = 0; n < 3; n++) {
        fixture f;
        make_model(&f, LENSPROF_RESPONSE_EMOR, 1);
        f.options.source_sample = f.options.target_sample = LENSPROF_SAMPLE_U16;
        if (n > 0) make_grid(&f, n == 1 ? 0 : 6, n == 1 ? 0 : 4, n == 1 ? 0 : 1);
        for (int i = 0; n == 2 && i < 24; i++) f.grid.attenuation[i] = 1.0f;
        make_plan(&f);
        target[n] = make_image(LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB, 1);
        assert_ok(apply(f.plan, &source, &target[n], 0, 0));
        assert_memory_equal(target[n].data, target[0].data, (size_t)source.row_bytes * H);
        free(f.memory);
    }
    for (int n = 0; n < 3; n++) free(target[n].data);
    free(source.data);
}

static void tiles_give_the_whole(int has_grid) {
    fixture f;
    make_model(&f, LENSPROF_RESPONSE_EMOR, 1);
    if (has_grid) make_grid(&f, 9, 13, 3);
    f.options.source_sample = f.options.target_sample = LENSPROF_SAMPLE_U16;
    make_plan(&f);
    lensprof_target source = make_image(LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB, 4),
                    whole = make_image(LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB, 5);
    assert_ok(apply(f.plan, &source, &whole, 0, 0));
    lensprof_target bottom_up = source; /* the tiles below use the row order of the frame */
    uint8_t *flipped = malloc((size_t)source.row_bytes * H);
    for (uint32_t y = 0; y < H; y++)
        memcpy(flipped + (H - 1 - y) * source.row_bytes, (uint8_t *)source.data + y * source.row_bytes,
               (size_t)source.row_bytes);
    bottom_up.data = flipped + (H - 1) * source.row_bytes;
    bottom_up.row_bytes = -source.row_bytes;
    for (uint32_t y = 0; y < H; y += 5)
        for (uint32_t x = 0; x < W; x += 11) {
            lensprof_target tile = bottom_up;
            tile.data = (uint8_t *)bottom_up.data + (ptrdiff_t)y * bottom_up.row_bytes + x * 6;
            tile.width = x + 11 > W ? W - x : 11;
            tile.height = y + 5 > H ? H - y : 5;
            assert_ok(lensprof_apply(f.plan, NULL, &tile, x, y));
        }
    for (uint32_t y = 0; y < H; y++)
        assert_memory_equal(flipped + (H - 1 - y) * source.row_bytes, (uint8_t *)whole.data + y * whole.row_bytes,
                            (size_t)source.row_bytes);
    free(source.data), free(whole.data), free(flipped), free(f.memory);
}

static void test_tiles_in_place_and_bottom_up_give_the_whole(void **state) {
    (void)state;
    tiles_give_the_whole(0);
    tiles_give_the_whole(1);
}

/* Simulating, then correcting restores the pixels within rounding. */
static void test_correct_undoes_simulate(void **state) {
    (void)state;
    fixture f;
    make_model(&f, LENSPROF_RESPONSE_TABLE, 1);
    f.options.source_sample = f.options.target_sample = LENSPROF_SAMPLE_F32;
    f.options.source = f.options.target = (lensprof_exposure){0.0, {1, 1, 1}};
    f.options.direction = LENSPROF_DIRECTION_SIMULATE;
    make_plan(&f);
    lensprof_target start = make_image(LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB, 8),
                    there = make_image(LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB, 9);
    assert_ok(apply(f.plan, &start, &there, 0, 0));
    free(f.memory);
    f.options.direction = LENSPROF_DIRECTION_CORRECT;
    make_plan(&f);
    assert_ok(lensprof_apply(f.plan, NULL, &there, 0, 0));
    for (int i = 0; i < W * H * 3; i++) assert_close(((float *)there.data)[i], ((float *)start.data)[i], 2e-5);
    free(start.data), free(there.data), free(f.memory);
}

static void test_not_a_number_stays_in_its_sample(void **state) {
    (void)state;
    fixture f;
    make_model(&f, LENSPROF_RESPONSE_EMOR, 1);
    f.options.source_sample = f.options.target_sample = LENSPROF_SAMPLE_F32;
    make_plan(&f);
    lensprof_target image = make_image(LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB, 8);
    ((float *)image.data)[100] = NAN;
    assert_ok(lensprof_apply(f.plan, NULL, &image, 0, 0));
    for (int i = 0; i < W * H * 3; i++) assert_int_equal(isnan(((float *)image.data)[i]) != 0, i == 100);
    free(image.data), free(f.memory);
}

/* White stays neutral when the white balance changes; well exposed pixels follow the formula. */
static void test_saturated_pixels_stay_neutral(void **state) {
    (void)state;
    fixture f;
    make_model(&f, LENSPROF_RESPONSE_EMOR, 1);
    f.options.saturated = LENSPROF_SATURATED_NEUTRAL;
    make_plan(&f);
    lensprof_target image = make_image(LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, 8),
                    before = make_image(LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, 8);
    uint8_t *data = image.data;
    data[0] = data[1] = data[2] = 255;
    data[3] = 255, data[4] = 200, data[5] = 100; /* bright, but coloured */
    assert_ok(lensprof_apply(f.plan, NULL, &image, 0, 0));
    assert_int_equal(data[0], data[1]);
    assert_int_equal(data[1], data[2]);
    for (int c = 0; c < 3; c++) {
        const double in[3] = {255, 200, 100};
        assert_close(data[3 + c], 255.0 * fmin(1.0, reference(&f, in[c] / 255.0, c, 1, 0)), 0.6);
    }
    free(image.data), free(before.data), free(f.memory);
}

static void test_plan_refuses(void **state) {
    (void)state;
    fixture f;
    make_model(&f, LENSPROF_RESPONSE_EMOR, 1);
    size_t bytes = lensprof_plan_bytes(&f.options);
    uint8_t *memory = malloc(bytes + 8);
    const lensprof_plan *plan = NULL;
    const lensprof_apply_options good = f.options;
    lensprof_error error = {.text = ""};
    memset(memory, 0xAA, bytes + 8);
#define REFUSED(change, status)                                                                 \
    do {                                                                                        \
        f.options = good;                                                                       \
        change;                                                                                 \
        assert_int_equal(lensprof_plan_init(memory, bytes, &f.options, &plan, &error), status); \
        if (strlen(error.text) < 10) fail_msg("no text: %s", #change);                          \
        error.text[0] = 0;                                                                      \
    } while (0)
    REFUSED(f.options.struct_size = 4, LENSPROF_ERROR_STRUCT_SIZE);
    REFUSED(f.options.direction = 2, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.source_sample = 4, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.target_sample = 4, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.source_layout = 11, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.chroma = 2, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.strength = 1.5, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.strength = NAN, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.gain_cap = 0.5, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.gain_cap = NAN, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.gain_cap = INFINITY, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.dither = 2, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.reserved = 1, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.saturated = 2, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.responses = 2, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.response = NULL, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.output_responses = 1, LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_plan_bytes(&f.options), 0);
    REFUSED(f.options.output_response = f.output, LENSPROF_ERROR_ARGUMENT);
    REFUSED((f.options.output_response = f.output, f.options.output_responses = 2), LENSPROF_ERROR_ARGUMENT);
    memset(f.output, 0, sizeof f.output);
    REFUSED((f.options.output_response = f.output, f.options.output_responses = 1), LENSPROF_ERROR_RESPONSE);
    REFUSED(f.options.reserved2 = 1, LENSPROF_ERROR_ARGUMENT);
    REFUSED(f.options.frame_width = 0, LENSPROF_ERROR_SIZE);
    REFUSED(f.options.frame_height = 0xFFFFFFFFu, LENSPROF_ERROR_SIZE);
    REFUSED(f.options.source.ev = NAN, LENSPROF_ERROR_EXPOSURE);
    REFUSED((f.options.source.ev = -64.0, f.options.target.ev = 64.0), LENSPROF_ERROR_EXPOSURE);
    REFUSED(f.vignetting[0].k[0] = -2.0, LENSPROF_ERROR_VIGNETTING);
    assert_int_equal(lensprof_plan_init(memory, bytes, &f.options, &plan, &error), LENSPROF_ERROR_VIGNETTING);
    assert_non_null(strstr(error.text, "M below 0.001"));
    assert_non_null(strstr(error.text, "fix k1 to k3"));
    assert_true(strlen(error.text) + 1 < sizeof error.text);
    f.vignetting[0].k[0] = -0.4;
    REFUSED((f.options.vignettings = 3, f.vignetting[1].center[0] = 0.2), LENSPROF_ERROR_VIGNETTING);
    f.vignetting[1].center[0] = 0.03;
    make_grid(&f, 4, 3, 1);
    f.grid.attenuation[5] = 0.0f;
    REFUSED(f.options.grid = &f.grid, LENSPROF_ERROR_VIGNETTING);
    assert_int_equal(lensprof_plan_bytes(&f.options), 0);
    f.grid.rows = 33;
    REFUSED(f.options.grid = &f.grid, LENSPROF_ERROR_SIZE);
    make_grid(&f, 4, 3, 1); /* needs its own memory */
    assert_int_equal(lensprof_plan_bytes(&f.options), bytes + 12 * sizeof(float));
    REFUSED(f.options.grid = &f.grid, LENSPROF_ERROR_CAPACITY);
    REFUSED(f.response[0].table[3] = 0.0, LENSPROF_ERROR_RESPONSE);
#undef REFUSED
    make_model(&f, LENSPROF_RESPONSE_EMOR, 1);
    assert_int_equal(lensprof_plan_init(memory, bytes - 1, &f.options, &plan, NULL), LENSPROF_ERROR_CAPACITY);
    assert_int_equal(lensprof_plan_init(memory + 1, bytes, &f.options, &plan, NULL), LENSPROF_ERROR_CAPACITY);
    for (size_t i = 0; i < bytes + 8; i++) assert_int_equal(memory[i], 0xAA);
    assert_null(plan);
    f.options.struct_size = 0;
    assert_int_equal(lensprof_plan_bytes(&f.options), 0);
    assert_int_equal(lensprof_plan_bytes(NULL), 0);
    free(memory);
}

/* A profile's model replaces the options set before; the plan equals that of its parts set one by one. */
static void test_model_of_a_profile(void **state) {
    (void)state;
    fixture f;
    static lensprof_profile profile;
    make_model(&f, LENSPROF_RESPONSE_EMOR, 3);
    lensprof_profile_init(&profile);
    profile.responses = profile.vignettings = 3;
    memcpy(profile.response, f.options.response, sizeof profile.response);
    memcpy(profile.vignetting, f.options.vignetting, sizeof profile.vignetting);
    make_grid(&f, 4, 3, 1);
    for (int with_grid = 0; with_grid < 2; with_grid++) {
        if (with_grid) profile.grid = f.grid;
        f.options.responses = f.options.vignettings = 3;
        f.options.response = profile.response, f.options.vignetting = profile.vignetting;
        f.options.grid = with_grid ? &f.grid : NULL;
        f.options.blob = NULL;
        make_plan(&f);
        const size_t bytes = lensprof_plan_bytes(&f.options);
        uint8_t *const by_hand = f.memory;
        f.options.responses = 1, f.options.response = NULL, f.options.vignetting = NULL;
        f.options.grid = NULL, f.options.blob = "blob", f.options.blob_bytes = 4;
        assert_ok(lensprof_apply_options_set_profile(&f.options, &profile));
        assert_int_equal(lensprof_plan_bytes(&f.options), bytes);
        assert_ptr_equal(f.options.response, profile.response);
        assert_true(f.options.grid == (with_grid ? &profile.grid : NULL));
        assert_null(f.options.blob);
        make_plan(&f);
        uint8_t light[2][7 * 5 * 3];
        memset(light, 100, sizeof light);
        for (int i = 0; i < 2; i++) {
            const lensprof_target view = {light[i], 21, 7, 5, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
            const lensprof_plan *plan = i ? f.plan : (const lensprof_plan *)(const void *)by_hand;
            assert_ok(lensprof_apply(plan, NULL, &view, 0, 0));
        }
        assert_memory_equal(light[0], light[1], sizeof light[0]);
        free(by_hand);
        free(f.memory);
    }
    assert_int_equal(lensprof_apply_options_set_profile(NULL, &profile), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_apply_options_set_profile(&f.options, NULL), LENSPROF_ERROR_ARGUMENT);
    profile.struct_size += 8;
    assert_int_equal(lensprof_apply_options_set_profile(&f.options, &profile), LENSPROF_ERROR_STRUCT_SIZE);
    profile.struct_size = sizeof profile, f.options.struct_size = 0;
    assert_int_equal(lensprof_apply_options_set_profile(&f.options, &profile), LENSPROF_ERROR_STRUCT_SIZE);
}

static void test_apply_refuses_and_writes_nothing(void **state) {
    (void)state;
    fixture f;
    make_model(&f, LENSPROF_RESPONSE_EMOR, 1);
    make_plan(&f);
    lensprof_target s = make_image(LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, 1),
                    t = make_image(LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, 2);
    size_t bytes = (size_t)t.row_bytes * H;
    uint8_t *before = malloc(bytes);
    memcpy(before, t.data, bytes);
    lensprof_target bad;
    assert_int_equal(apply(NULL, &s, &t, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(apply(f.plan, &s, NULL, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(apply(f.plan, &s, &t, 1, 0), LENSPROF_ERROR_SIZE);
    assert_int_equal(apply(f.plan, &s, &t, 0, 0xFFFFFFFFu), LENSPROF_ERROR_SIZE);
    bad = t, bad.layout = LENSPROF_LAYOUT_BGR;
    assert_int_equal(apply(f.plan, &s, &bad, 0, 0), LENSPROF_ERROR_ARGUMENT);
    bad = t, bad.sample = LENSPROF_SAMPLE_U16, bad.row_bytes *= 2;
    assert_int_equal(apply(f.plan, &s, &bad, 0, 0), LENSPROF_ERROR_ARGUMENT);
    bad = t, bad.width = W - 1;
    assert_int_equal(apply(f.plan, &s, &bad, 0, 0), LENSPROF_ERROR_SIZE);
    bad = t, bad.row_bytes = 3 * W - 1;
    assert_int_equal(apply(f.plan, &s, &bad, 0, 0), LENSPROF_ERROR_SIZE);
    bad = t, bad.row_bytes = PTRDIFF_MIN;
    assert_int_equal(apply(f.plan, &s, &bad, 0, 0), LENSPROF_ERROR_SIZE);
    bad = t, bad.data = NULL;
    assert_int_equal(apply(f.plan, &s, &bad, 0, 0), LENSPROF_ERROR_ARGUMENT);
    bad = t, bad.height = 0;
    assert_int_equal(apply(f.plan, &s, &bad, 0, 0), LENSPROF_ERROR_SIZE);
    bad = t, bad.data = NULL; /* in place */
    assert_int_equal(lensprof_apply(f.plan, NULL, &bad, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_apply(f.plan, NULL, NULL, 0, 0), LENSPROF_ERROR_ARGUMENT);
    bad = s, bad.data = (uint8_t *)s.data + 3, bad.height = H - 1; /* overlaps the source at another address */
    lensprof_target shorter = s;
    shorter.height = H - 1;
    assert_int_equal(apply(f.plan, &shorter, &bad, 0, 0), LENSPROF_ERROR_ARGUMENT);
    assert_memory_equal(before, t.data, bytes);
    free(s.data), free(t.data), free(before), free(f.memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chroma_keeps_luminance),
        cmocka_unit_test(test_chroma_of_one_falloff_is_none),
        cmocka_unit_test(test_every_format_follows_the_formula),
        cmocka_unit_test(test_output_has_a_response_of_its_own),
        cmocka_unit_test(test_gain_grids_follow_the_formula),
        cmocka_unit_test(test_no_gain_grid),
        cmocka_unit_test(test_tiles_in_place_and_bottom_up_give_the_whole),
        cmocka_unit_test(test_correct_undoes_simulate),
        cmocka_unit_test(test_not_a_number_stays_in_its_sample),
        cmocka_unit_test(test_saturated_pixels_stay_neutral),
        cmocka_unit_test(test_plan_refuses),
        cmocka_unit_test(test_model_of_a_profile),
        cmocka_unit_test(test_apply_refuses_and_writes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
