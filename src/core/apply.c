/* Applying a model to pixels: the plan, and what is checked before a kernel runs.
 *
 * A plan holds the curves as float tables: `inverse` maps every integer code to irradiance (8 and 16 bit input),
 * `forward` is the response on its 1024 grid. Pixels go  code -> irradiance -> times gain(x, y) -> code. */
#include "core/plan.h"

#include <math.h>
#include <string.h>

#include "core/options.h"
#include "core/response.h"

#define LARGEST_ROW ((ptrdiff_t)1 << 28) /* bytes; times LP_LARGEST_SIDE rows it stays within an address */
#define LAST (LENSPROF_RESPONSE_SAMPLES - 1)
#define STREAMED ((size_t)8 << 20) /* bytes of a float target to keep out of the caches; others gain nothing */

/* ---- formats ---- */

uint32_t lensprof_layout_samples(uint32_t layout) {
    static const uint8_t samples[] = {1, 2, 3, 4, 3, 4, 1, 1, 1, 1, 1};
    return layout < sizeof samples ? samples[layout] : 0;
}

uint32_t lensprof_layout_channels(uint32_t layout) {
    static const uint8_t channels[] = {1, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3};
    return layout < sizeof channels ? channels[layout] : 0;
}

uint32_t lensprof_sample_bytes(uint32_t sample) {
    static const uint8_t bytes[] = {1, 2, 4, 2};
    return sample < sizeof bytes ? bytes[sample] : 0;
}

lensprof_status lensprof_image_validate(const lensprof_image *image) {
    if (!image || !image->data) return LENSPROF_ERROR_ARGUMENT;
    uint32_t bytes = lensprof_sample_bytes(image->sample), samples = lensprof_layout_samples(image->layout);
    if (!bytes || !samples || image->layout == LENSPROF_LAYOUT_PLANAR) return LENSPROF_ERROR_ARGUMENT;
    if (!image->width || !image->height || image->width > LP_LARGEST_SIDE || image->height > LP_LARGEST_SIDE)
        return LENSPROF_ERROR_SIZE;
    if (image->row_bytes > LARGEST_ROW || image->row_bytes < -LARGEST_ROW) return LENSPROF_ERROR_SIZE;
    int64_t row = image->row_bytes < 0 ? -(int64_t)image->row_bytes : (int64_t)image->row_bytes;
    if (row < (int64_t)image->width * samples * bytes && image->height > 1) return LENSPROF_ERROR_SIZE;
    if (row * image->height > PTRDIFF_MAX) return LENSPROF_ERROR_SIZE; /* where addresses have 32 bits */
    if ((uintptr_t)image->data % bytes || (row & (bytes - 1))) return LENSPROF_ERROR_ARGUMENT;
    return LENSPROF_OK;
}

/* ---- plan ---- */

static int is_mosaic(uint32_t layout) { return layout >= LENSPROF_LAYOUT_RGGB && layout <= LENSPROF_LAYOUT_BGGR; }

/* The kind of curve of all channels. */
static uint32_t kind_of(const lensprof_apply_options *o, const lp_model *m) {
    uint32_t kind = LP_CURVE_NONE;
    for (uint32_t c = 0; c < lp_curves(o, m); c++) {
        uint32_t own = lp_response(o, m, c)->kind;
        own = own == LENSPROF_RESPONSE_LINEAR  ? LP_CURVE_CLIP
              : own == LENSPROF_RESPONSE_GAMMA ? LP_CURVE_POWER
                                               : LP_CURVE_TABLE;
        kind = c && own != kind ? (uint32_t)LP_CURVE_MIXED : own;
        if (kind == LP_CURVE_MIXED) break;
    }
    return kind;
}

static int is_integer(uint32_t sample) { return sample == LENSPROF_SAMPLE_U8 || sample == LENSPROF_SAMPLE_U16; }

/* Codes of a linear response lie within 0..1 as they are. */
static uint32_t decode_of(const lensprof_apply_options *o, const lp_model *m) {
    uint32_t kind = o->input == LENSPROF_ENCODING_LINEAR ? (uint32_t)LP_CURVE_NONE : kind_of(o, m);
    if (!is_integer(o->source_sample)) return kind;
    if (kind == LP_CURVE_CLIP) return LP_CURVE_NONE;
    if (kind == LP_CURVE_POWER && o->source_sample == LENSPROF_SAMPLE_U16) return kind;
    return kind == LP_CURVE_NONE ? kind : (uint32_t)LP_CURVE_TABLE;
}

static uint32_t encode_of(const lensprof_apply_options *o, const lp_model *m) {
    uint32_t kind = o->output == LENSPROF_ENCODING_LINEAR ? (uint32_t)LP_CURVE_NONE : kind_of(o, m);
    return kind == LP_CURVE_CLIP && is_integer(o->target_sample) ? (uint32_t)LP_CURVE_NONE : kind;
}

/* Entries of the table of all codes; 0 without. */
static size_t codes_of(const lensprof_apply_options *o, const lp_model *m) {
    if (!is_integer(o->source_sample) || decode_of(o, m) != LP_CURVE_TABLE) return 0;
    return o->source_sample == LENSPROF_SAMPLE_U8 ? 256 : 65536;
}

/* Entries of the table of where to begin among the samples; 0 where values do not go through the inverse. */
static size_t starts_of(const lensprof_apply_options *o, const lp_model *m) {
    const uint32_t decode = codes_of(o, m) ? (uint32_t)LP_CURVE_NONE : decode_of(o, m);
    return decode == LP_CURVE_TABLE || decode == LP_CURVE_MIXED ? LP_CELLS + 1 : 0;
}

/* Entries of the table of the response; 0 where none is asked. */
static size_t samples_of(const lensprof_apply_options *o, const lp_model *m) {
    const uint32_t encode = encode_of(o, m);
    const int is_asked = starts_of(o, m) || encode == LP_CURVE_TABLE || encode == LP_CURVE_MIXED;
    return is_asked ? LENSPROF_RESPONSE_SAMPLES : 0;
}

static size_t nodes_of(const lp_model *m) { return (size_t)m->channels * m->rows * m->columns; }

static size_t bytes_of(const lensprof_apply_options *o, const lp_model *m) {
    const size_t samples = samples_of(o, m), behind = samples ? 1 : 0;
    const size_t numbers = lp_curves(o, m) * (samples + codes_of(o, m) + starts_of(o, m)) + behind + nodes_of(m);
    return sizeof(lensprof_plan) + numbers * sizeof(float);
}

size_t lensprof_plan_bytes(const lensprof_apply_options *o) {
    lp_model model;
    if (!o || o->struct_size != sizeof *o || !lensprof_sample_bytes(o->source_sample)
        || !lensprof_sample_bytes(o->target_sample) || !lensprof_layout_samples(o->source_layout))
        return 0;
    return lp_options_model(o, &model) == LENSPROF_OK ? bytes_of(o, &model) : 0;
}

/* g of every code. As codes rise, so does the place among the response's samples. */
static void fill_inverse(const struct lp_model_response *response, size_t codes, float *inverse) {
    const double last = (double)(codes - 1);
    inverse[0] = 0.0f;
    for (size_t code = 1; lp_is_power(response) && code < codes; code++)
        inverse[code] = (float)lp_curve_power((double)code / last, response->gamma, NULL);
    if (lp_is_power(response)) return;
    double below = 0.0, above = lp_model_sample(response, 1);
    uint32_t j = 0;
    for (size_t code = 1; code < codes; code++) {
        const double b = (double)code / last;
        for (; above < b && j + 2 < LENSPROF_RESPONSE_SAMPLES; j++) {
            below = above;
            above = lp_model_sample(response, j + 2);
        }
        inverse[code] = (float)lp_curve_between(below, above, b, j);
    }
}

/* Where to begin among the samples, for every cell of values, and the first step from there. */
static void fill_start(lensprof_plan *plan, const float *samples, float *start) {
    uint32_t j = 0;
    for (uint32_t cell = 0; cell <= LP_CELLS; cell++) {
        const float least = (float)cell / LP_CELLS;
        const uint32_t before = j;
        while (j + 1 < LENSPROF_RESPONSE_SAMPLES && samples[j + 1] < least) j++;
        start[cell] = (float)j;
        while (plan->step <= (int32_t)(j - before) / 2) plan->step = plan->step ? 2 * plan->step : 1;
    }
}

/* Fills the tables of the curves at `memory`; returns the memory behind them. */
static float *prepare_curves(lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m, float *memory) {
    const size_t samples = samples_of(o, m), codes = codes_of(o, m), starts = starts_of(o, m);
    plan->curves = lp_curves(o, m);
    plan->decode = decode_of(o, m);
    plan->encode = encode_of(o, m);
    float *inverse = memory + plan->curves * samples + (samples ? 1 : 0), *start = inverse + plan->curves * codes;
    if (samples) inverse[-1] = 0.0f; /* kernels read it, times 0 */
    plan->forward = memory;
    plan->inverse = codes ? inverse : NULL;
    plan->start = starts ? start : NULL;
    plan->inverse_shift = codes == 256 ? 8 : 16;
    for (uint32_t c = 0; c < plan->curves; c++) {
        const struct lp_model_response *response = lp_response(o, m, c);
        plan->exponent[c] = lp_is_power(response) ? (float)(1.0 / response->gamma) : 0.0f;
        plan->inverse_exponent[c] = lp_is_power(response) ? (float)response->gamma : 0.0f;
        for (size_t j = 0; j < samples; j++) /* not read where there is an exponent */
            memory[c * samples + j] = lp_is_power(response) ? 0.0f : (float)lp_model_sample(response, (uint32_t)j);
        if (codes) fill_inverse(response, codes, inverse + c * codes);
        memset(start + c * starts, 0, starts * sizeof *start);
        if (starts && !lp_is_power(response)) fill_start(plan, memory + c * samples, start + c * starts);
    }
    return start + plan->curves * starts;
}

/* Copies the nodes of the gain grid, less 1, to `memory`. */
static void prepare_grid(lensprof_plan *plan, const lp_model *m, float *memory) {
    if (!nodes_of(m)) return;
    plan->columns = m->columns;
    plan->rows = m->rows;
    for (uint32_t i = 0; i < nodes_of(m); i++) memory[i] = lp_model_node(m, i) - 1.0f;
    for (uint32_t c = 0; c < LP_CHANNELS; c++)
        plan->nodes[c] = memory + (m->channels == 3 ? c : 0) * m->rows * m->columns;
}

void lp_layout_sites(uint32_t layout, uint8_t channel_of_sample[4], uint8_t site[2][2]) {
    static const uint8_t sites[4][2][2] = {{{0, 1}, {1, 2}}, {{1, 0}, {2, 1}}, {{1, 2}, {0, 1}}, {{2, 1}, {1, 0}}};
    const int reversed = layout == LENSPROF_LAYOUT_BGR || layout == LENSPROF_LAYOUT_BGRA;
    for (uint8_t s = 0; s < 4; s++)
        channel_of_sample[s] = s >= lensprof_layout_channels(layout) ? LP_ALPHA
                               : reversed && s < 3                   ? (uint8_t)(2 - s)
                                                                     : s;
    if (is_mosaic(layout)) memcpy(site, sites[layout - LENSPROF_LAYOUT_RGGB], sizeof sites[0]);
}

static void prepare_layout(lensprof_plan *plan, const lensprof_apply_options *o) {
    plan->layout = o->source_layout;
    plan->samples = lensprof_layout_samples(plan->layout);
    plan->channels = lensprof_layout_channels(plan->layout);
    lp_layout_sites(plan->layout, plan->channel_of_sample, plan->site);
}

/* White in the linear numbers of a kernel: where no curve is between, codes stay codes. */
static double white_of(uint32_t sample, uint32_t curve) {
    if (curve != LP_CURVE_NONE) return 1.0;
    return sample == LENSPROF_SAMPLE_U8 ? 255.0 : sample == LENSPROF_SAMPLE_U16 ? 65535.0 : 1.0;
}

/* Falloff and factor of a channel. The gain is factor / M, or M / factor to simulate. */
static void prepare_gain(lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m, uint32_t channel) {
    const double w = o->frame_width, h = o->frame_height, per_rho2 = 4.0 / (w * w + h * h);
    const double *k = m->vignetting[m->vignettings == 3 ? channel : 0].k;
    const uint32_t at = plan->channels == 1 ? 0 : channel; /* grey is treated as green */
    double scale = plan->columns ? 1.0 : o->strength;
    for (int n = 0; n < 3; n++) plan->k[at][n] = (float)(k[n] * (scale *= per_rho2));
    const double units = (plan->encode == LP_CURVE_TABLE ? LAST : white_of(o->target_sample, plan->encode))
                         / white_of(o->source_sample, plan->decode);
    const double ratio = lp_exposure_ratio(o, channel);
    plan->factor[at] = (float)(plan->simulate ? ratio / units : ratio * units);
    plan->times[at] = 1.0f;
    if (at != channel) plan->nodes[at] = plan->nodes[channel];
}

/* Channels that differ by their factors alone share one division a pixel, where what that rounds is not seen. */
static void share_gains(lensprof_plan *plan) {
    if (plan->gains == 1 || plan->target_sample == LENSPROF_SAMPLE_F32) return;
    for (uint32_t c = 1; c < LP_CHANNELS; c++)
        if (memcmp(plan->k[c], plan->k[0], sizeof plan->k[0]) || plan->nodes[c] != plan->nodes[0]) return;
    for (uint32_t c = 0; c < LP_CHANNELS; c++) {
        plan->times[c] = plan->simulate ? 1.0f / plan->factor[c] : plan->factor[c];
        plan->factor[c] = 1.0f;
    }
    plan->gains = 1;
}

static void prepare_gains(lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    for (int d = 0; d < 2; d++) {
        const double center = lp_center(o, m, d);
        plan->center_px[d] = (int32_t)floor(center + 0.5);
        plan->center_part[d] = (float)(center - plan->center_px[d]);
    }
    plan->least = (float)(1.0 / (o->gain_cap > 0.0 ? o->gain_cap : LP_LARGEST_GAIN_CAP));
    plan->strength = (float)o->strength;
    plan->gains = 1;
    for (uint32_t c = 0; c < LP_CHANNELS; c++) {
        if (plan->channels == 1 && c != 1) continue;
        prepare_gain(plan, o, m, c);
        if (plan->channels == 3
            && (memcmp(plan->k[c], plan->k[0], sizeof plan->k[0]) || plan->factor[c] != plan->factor[0]
                || plan->nodes[c] != plan->nodes[0]))
            plan->gains = 3;
    }
    share_gains(plan);
}

lensprof_status lensprof_plan_init(void *memory, size_t bytes, const lensprof_apply_options *options,
                                   const lensprof_plan **result) {
    if (!memory || !options || !result) return LENSPROF_ERROR_ARGUMENT;
    lp_model model;
    const lensprof_status status = lp_options_validate(options, &model);
    if (status != LENSPROF_OK) return status;
    if (bytes < bytes_of(options, &model) || (uintptr_t)memory % 8) return LENSPROF_ERROR_CAPACITY;

    lensprof_plan *plan = memory;
    memset(plan, 0, sizeof *plan);
    plan->row = lp_row_best(0);
    plan->simulate = options->direction == LENSPROF_DIRECTION_SIMULATE;
    plan->frame_width = options->frame_width;
    plan->frame_height = options->frame_height;
    plan->source_sample = options->source_sample;
    plan->target_sample = options->target_sample;
    plan->dither = options->dither && options->target_sample == LENSPROF_SAMPLE_U8;
    prepare_layout(plan, options);
    plan->neutral_white = options->saturated == LENSPROF_SATURATED_NEUTRAL && !plan->simulate && plan->channels == 3
                          && !is_mosaic(plan->layout) && options->input == LENSPROF_ENCODING_RESPONSE
                          && options->output == LENSPROF_ENCODING_RESPONSE;
    float *tables = (float *)(void *)(plan + 1);
    tables = prepare_curves(plan, options, &model, tables);
    prepare_grid(plan, &model, tables);
    prepare_gains(plan, options, &model);
    *result = plan;
    return LENSPROF_OK;
}

/* ---- tiles ---- */

/* First and last byte that a view touches. */
static void extent(const lensprof_image *image, uintptr_t *first, uintptr_t *last) {
    uintptr_t top = (uintptr_t)image->data;
    uintptr_t bottom = top + (uintptr_t)((intptr_t)(image->height - 1) * image->row_bytes);
    uintptr_t row =
        (uintptr_t)image->width * lensprof_layout_samples(image->layout) * lensprof_sample_bytes(image->sample);
    *first = top < bottom ? top : bottom;
    *last = (top < bottom ? bottom : top) + row - 1;
}

static int overlap(const lensprof_image *a, const lensprof_image *b) {
    uintptr_t a0, a1, b0, b1;
    extent(a, &a0, &a1);
    extent(b, &b0, &b1);
    return !(a1 < b0 || b1 < a0);
}

static int is_in_place(const lensprof_image *source, const lensprof_image *target) {
    return source->data == target->data && source->row_bytes == target->row_bytes && source->sample == target->sample;
}

lensprof_status lp_tile_validate(const lp_tiles *tiles, const lensprof_image *source, const lensprof_image *target,
                                 uint32_t x0, uint32_t y0) {
    lensprof_status status = lensprof_image_validate(source);
    if (status == LENSPROF_OK) status = lensprof_image_validate(target);
    if (status != LENSPROF_OK) return status;
    if (source->sample != tiles->source_sample || target->sample != tiles->target_sample
        || source->layout != tiles->layout || target->layout != tiles->layout)
        return LENSPROF_ERROR_ARGUMENT;
    if (source->width != target->width || source->height != target->height) return LENSPROF_ERROR_SIZE;
    if (x0 > tiles->frame_width || source->width > tiles->frame_width - x0 || y0 > tiles->frame_height
        || source->height > tiles->frame_height - y0)
        return LENSPROF_ERROR_SIZE;
    return is_in_place(source, target) || !overlap(source, target) ? LENSPROF_OK : LENSPROF_ERROR_ARGUMENT;
}

static lensprof_status validate_tile(const lensprof_plan *plan, const lensprof_image *source,
                                     const lensprof_image *target, uint32_t layout, uint32_t x0, uint32_t y0) {
    const lp_tiles tiles = {plan->source_sample, plan->target_sample, layout, plan->frame_width, plan->frame_height};
    return lp_tile_validate(&tiles, source, target, x0, y0);
}

static void apply_rows(const lensprof_plan *plan, const lensprof_image *source, const lensprof_image *target,
                       uint32_t planes, uint32_t x0, uint32_t y0) {
    const size_t bytes = (size_t)target->width * target->height * plan->samples * lensprof_sample_bytes(target->sample);
    const int stream = bytes >= STREAMED && target->sample == LENSPROF_SAMPLE_F32 && !is_in_place(source, target);
    for (uint32_t y = 0; y < source->height; y++) {
        const uint8_t *from[3] = {NULL, NULL, NULL};
        uint8_t *to[3] = {NULL, NULL, NULL};
        for (uint32_t p = 0; p < planes; p++) {
            from[p] = (const uint8_t *)source[p].data + (ptrdiff_t)y * source[p].row_bytes;
            to[p] = (uint8_t *)target[p].data + (ptrdiff_t)y * target[p].row_bytes;
        }
        plan->row(plan, from, to, x0, y0 + y, source->width, stream);
    }
}

lensprof_status lensprof_apply(const lensprof_plan *plan, const lensprof_image *source, const lensprof_image *target,
                               uint32_t x0, uint32_t y0) {
    if (!plan || !source || !target || plan->layout == LENSPROF_LAYOUT_PLANAR) return LENSPROF_ERROR_ARGUMENT;
    lensprof_status status = validate_tile(plan, source, target, plan->layout, x0, y0);
    if (status == LENSPROF_OK) apply_rows(plan, source, target, 1, x0, y0);
    return status;
}

lensprof_status lensprof_apply_planar(const lensprof_plan *plan, const lensprof_image source[3],
                                      const lensprof_image target[3], uint32_t x0, uint32_t y0) {
    if (!plan || !source || !target || plan->layout != LENSPROF_LAYOUT_PLANAR) return LENSPROF_ERROR_ARGUMENT;
    for (uint32_t p = 0; p < 3; p++) {
        lensprof_status status = validate_tile(plan, &source[p], &target[p], LENSPROF_LAYOUT_GREY, x0, y0);
        if (status != LENSPROF_OK) return status;
        if (source[p].width != source->width || source[p].height != source->height) return LENSPROF_ERROR_SIZE;
        for (uint32_t other = 0; other < 3; other++)
            if (other != p && (overlap(&target[p], &source[other]) || overlap(&target[p], &target[other])))
                return LENSPROF_ERROR_ARGUMENT;
    }
    apply_rows(plan, source, target, 3, x0, y0);
    return LENSPROF_OK;
}
