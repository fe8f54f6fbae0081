/* Applying a model to pixels: plan, checks, and the scalar loop.
 *
 * A plan holds the curves as float tables: `inverse` maps every integer code to irradiance (8 and 16 bit input),
 * `forward` is the response on its 1024 grid. Pixels go  code -> irradiance -> times gain(x, y) -> code. */
#include <lensprof/apply.h>

#include "gain_grid.h"

#include <math.h>
#include <string.h>

#define LAST (LENSPROF_RESPONSE_SAMPLES - 1)
#define LARGEST_SIDE (1u << 20)
#define LARGEST_ROW ((ptrdiff_t)1 << 28) /* bytes; times LARGEST_SIDE rows it stays within an address */

typedef struct curve {
    const float *forward; /* 1024 samples of f */
    const float *inverse; /* g of every code; NULL for float input */
    uint32_t kind;
    float gamma;
} curve;

struct lensprof_plan {
    uint32_t direction, input, output;
    uint32_t neutral_white;        /* LENSPROF_SATURATED_NEUTRAL is in force */
    uint32_t frame_width, frame_height;
    uint32_t source_sample, target_sample, layout;
    uint32_t channel_of_sample[4]; /* colour channel of each sample of a pixel */
    float center_px[2], per_rho;   /* pixel -> half diagonals */
    float k[3][3];                 /* vignetting of each channel */
    uint32_t columns, rows;        /* of the gain grid; 0 = none */
    const float *nodes[3];         /* of each channel */
    float factor[3];               /* target over source exposure */
    curve curves[3];
};

/* Where a pixel lies: for the falloff and in the gain grid. */
typedef struct place {
    float r2; /* half diagonals squared */
    lp_grid_cell column, row;
} place;

/* ---- formats ---- */

uint32_t lensprof_layout_samples(uint32_t layout)
{
    static const uint8_t samples[] = {1, 2, 3, 4, 3, 4};
    return layout < sizeof samples ? samples[layout] : 0;
}

uint32_t lensprof_layout_channels(uint32_t layout)
{
    static const uint8_t channels[] = {1, 1, 3, 3, 3, 3};
    return layout < sizeof channels ? channels[layout] : 0;
}

uint32_t lensprof_sample_bytes(uint32_t sample)
{
    static const uint8_t bytes[] = {1, 2, 4};
    return sample < sizeof bytes ? bytes[sample] : 0;
}

lensprof_status lensprof_image_validate(const lensprof_image *image)
{
    if (!image || !image->data) return LENSPROF_ERROR_ARGUMENT;
    uint32_t bytes = lensprof_sample_bytes(image->sample), samples = lensprof_layout_samples(image->layout);
    if (!bytes || !samples) return LENSPROF_ERROR_ARGUMENT;
    if (!image->width || !image->height || image->width > LARGEST_SIDE || image->height > LARGEST_SIDE)
        return LENSPROF_ERROR_SIZE;
    if (image->row_bytes > LARGEST_ROW || image->row_bytes < -LARGEST_ROW) return LENSPROF_ERROR_SIZE;
    int64_t row = image->row_bytes < 0 ? -(int64_t)image->row_bytes : (int64_t)image->row_bytes;
    if (row < (int64_t)image->width * samples * bytes && image->height > 1) return LENSPROF_ERROR_SIZE;
    if ((uintptr_t)image->data % bytes || row % bytes) return LENSPROF_ERROR_ARGUMENT;
    return LENSPROF_OK;
}

/* ---- plan ---- */

void lensprof_apply_options_init(lensprof_apply_options *options)
{
    memset(options, 0, sizeof *options);
    options->struct_size = sizeof *options;
    options->source_layout = LENSPROF_LAYOUT_RGB;
    options->responses = options->vignettings = 1;
    lensprof_exposure_init(&options->source);
    lensprof_exposure_init(&options->target);
}

static size_t codes_of(const lensprof_apply_options *options)
{
    if (options->input == LENSPROF_ENCODING_LINEAR) return 0;
    return options->source_sample == LENSPROF_SAMPLE_U8    ? 256
           : options->source_sample == LENSPROF_SAMPLE_U16 ? 65536
                                                           : 0;
}

static size_t nodes_of(const lensprof_apply_options *options)
{
    return options->grid ? (size_t)options->grid->channels * options->grid->rows * options->grid->columns : 0;
}

size_t lensprof_plan_bytes(const lensprof_apply_options *options)
{
    if (!options || options->struct_size != sizeof *options) return 0;
    if (!lensprof_sample_bytes(options->source_sample) || (options->responses != 1 && options->responses != 3))
        return 0;
    if (options->grid && lensprof_gain_grid_validate(options->grid) != LENSPROF_OK) return 0;
    size_t tables = options->responses * (LENSPROF_RESPONSE_SAMPLES + codes_of(options));
    return sizeof(lensprof_plan) + (tables + nodes_of(options)) * sizeof(float);
}

static lensprof_status validate_options(const lensprof_apply_options *o)
{
    if (o->struct_size != sizeof *o) return LENSPROF_ERROR_STRUCT_SIZE;
    if (o->direction > LENSPROF_DIRECTION_SIMULATE || o->input > LENSPROF_ENCODING_LINEAR
        || o->output > LENSPROF_ENCODING_LINEAR || o->saturated > LENSPROF_SATURATED_AS_VALUE
        || !lensprof_sample_bytes(o->source_sample) || !lensprof_sample_bytes(o->target_sample)
        || !lensprof_layout_samples(o->source_layout) || !o->response || !o->vignetting
        || (o->responses != 1 && o->responses != 3) || (o->vignettings != 1 && o->vignettings != 3))
        return LENSPROF_ERROR_ARGUMENT;
    if (!o->frame_width || !o->frame_height || o->frame_width > LARGEST_SIDE || o->frame_height > LARGEST_SIDE)
        return LENSPROF_ERROR_SIZE;
    lensprof_status status = lensprof_exposure_validate(&o->source);
    if (status == LENSPROF_OK) status = lensprof_exposure_validate(&o->target);
    for (uint32_t c = 0; c < 3 && status == LENSPROF_OK; c++) { /* single precision must hold the factor */
        double factor = lensprof_exposure_factor(&o->target, c) / lensprof_exposure_factor(&o->source, c);
        if (!(factor >= 1e-12 && factor <= 1e12)) status = LENSPROF_ERROR_EXPOSURE;
    }
    for (uint32_t c = 0; c < o->responses && status == LENSPROF_OK; c++)
        status = lensprof_response_validate(&o->response[c]);
    for (uint32_t c = 0; c < o->vignettings && status == LENSPROF_OK; c++) {
        status = lensprof_vignetting_validate(&o->vignetting[c]);
        if (status == LENSPROF_OK && (o->vignetting[c].center[0] != o->vignetting[0].center[0]
                                      || o->vignetting[c].center[1] != o->vignetting[0].center[1]))
            status = LENSPROF_ERROR_VIGNETTING; /* one centre for all channels */
    }
    if (status == LENSPROF_OK && o->grid) status = lensprof_gain_grid_validate(o->grid);
    return status;
}

/* Fills the tables of one response at `memory`; returns the memory behind them. */
static float *prepare_curve(curve *c, const lensprof_response *response, size_t codes, float *memory)
{
    c->kind = response->kind;
    c->gamma = (float)response->gamma;
    c->forward = memory;
    for (int j = 0; j <= LAST; j++) *memory++ = (float)response->table[j];
    c->inverse = codes ? memory : NULL;
    for (size_t code = 0; code < codes; code++)
        *memory++ = (float)lensprof_response_invert(response, (double)code / (double)(codes - 1), NULL);
    return memory;
}

/* Copies the nodes of the gain grid to `memory`. */
static void prepare_grid(lensprof_plan *plan, const lensprof_apply_options *options, float *memory)
{
    const lensprof_gain_grid *grid = options->grid;
    if (!nodes_of(options)) return;
    plan->columns = grid->columns;
    plan->rows = grid->rows;
    memcpy(memory, grid->attenuation, nodes_of(options) * sizeof *memory);
    for (uint32_t c = 0; c < 3; c++)
        plan->nodes[c] = memory + (grid->channels == 3 ? c : 0) * grid->rows * grid->columns;
}

static void prepare_layout(lensprof_plan *plan, uint32_t layout)
{
    int reversed = layout == LENSPROF_LAYOUT_BGR || layout == LENSPROF_LAYOUT_BGRA;
    plan->layout = layout;
    for (uint32_t s = 0; s < 3; s++) plan->channel_of_sample[s] = reversed ? 2 - s : s;
}

lensprof_status lensprof_plan_init(void *memory, size_t bytes, const lensprof_apply_options *options,
                                   const lensprof_plan **result)
{
    if (!memory || !options || !result) return LENSPROF_ERROR_ARGUMENT;
    lensprof_status status = validate_options(options);
    if (status != LENSPROF_OK) return status;
    if (bytes < lensprof_plan_bytes(options) || (uintptr_t)memory % 8) return LENSPROF_ERROR_CAPACITY;

    lensprof_plan *plan = memory;
    memset(plan, 0, sizeof *plan);
    plan->direction = options->direction;
    plan->input = options->input;
    plan->output = options->output;
    plan->neutral_white = options->saturated == LENSPROF_SATURATED_NEUTRAL
                          && options->direction == LENSPROF_DIRECTION_CORRECT
                          && options->input == LENSPROF_ENCODING_RESPONSE
                          && options->output == LENSPROF_ENCODING_RESPONSE;
    plan->frame_width = options->frame_width;
    plan->frame_height = options->frame_height;
    plan->source_sample = options->source_sample;
    plan->target_sample = options->target_sample;
    prepare_layout(plan, options->source_layout);

    double w = options->frame_width, h = options->frame_height, rho = 0.5 * sqrt(w * w + h * h);
    plan->per_rho = (float)(1.0 / rho);
    plan->center_px[0] = (float)(0.5 * (w - 1.0) + rho * options->vignetting[0].center[0]);
    plan->center_px[1] = (float)(0.5 * (h - 1.0) + rho * options->vignetting[0].center[1]);
    float *tables = (float *)(void *)(plan + 1);
    for (uint32_t c = 0; c < 3; c++) {
        const lensprof_vignetting *vignetting = &options->vignetting[options->vignettings == 3 ? c : 0];
        for (int n = 0; n < 3; n++) plan->k[c][n] = (float)vignetting->k[n];
        plan->factor[c] = (float)(lensprof_exposure_factor(&options->target, c)
                                  / lensprof_exposure_factor(&options->source, c));
        if (c < options->responses)
            tables = prepare_curve(&plan->curves[c], &options->response[c], codes_of(options), tables);
        else plan->curves[c] = plan->curves[0];
    }
    prepare_grid(plan, options, tables);
    *result = plan;
    return LENSPROF_OK;
}

/* ---- pixels ---- */

static float gain_at(const lensprof_plan *plan, uint32_t channel, const place *at)
{
    const float *k = plan->k[channel];
    float r2 = at->r2, falloff = 1.0f + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
    if (plan->columns) falloff *= (float)lp_grid_value(plan->nodes[channel], plan->columns, at->column, at->row);
    return plan->direction == LENSPROF_DIRECTION_CORRECT ? plan->factor[channel] / falloff
                                                         : falloff / plan->factor[channel];
}

/* f(x) for any x, NaN kept. */
static float encode(const curve *c, float x)
{
    if (x != x) return x;
    if (!(x > 0.0f)) return 0.0f;
    if (x >= 1.0f) return 1.0f;
    if (c->kind == LENSPROF_RESPONSE_LINEAR) return x;
    if (c->kind == LENSPROF_RESPONSE_GAMMA) return powf(x, 1.0f / c->gamma);
    float position = x * LAST;
    int j = (int)position;
    if (j >= LAST) return 1.0f; /* x just below 1 may round up */
    return c->forward[j] + (position - (float)j) * (c->forward[j + 1] - c->forward[j]);
}

/* g(b) of a float sample, NaN kept. */
static float decode(const curve *c, float b)
{
    if (b != b) return b;
    if (!(b > 0.0f)) return 0.0f;
    if (b > 1.0f) b = 1.0f;
    if (c->kind == LENSPROF_RESPONSE_LINEAR) return b;
    if (c->kind == LENSPROF_RESPONSE_GAMMA) return powf(b, c->gamma);
    int low = 0, high = LAST;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (c->forward[middle] < b) low = middle;
        else high = middle;
    }
    float step = c->forward[high] - c->forward[low];
    return ((float)low + (step > 0.0f ? (b - c->forward[low]) / step : 0.0f)) / LAST;
}

static float load(uint32_t sample, const uint8_t *p)
{
    uint16_t u16;
    float f32;
    switch (sample) {
    case LENSPROF_SAMPLE_U8: return (float)*p / 255.0f;
    case LENSPROF_SAMPLE_U16: memcpy(&u16, p, 2); return (float)u16 / 65535.0f;
    default: memcpy(&f32, p, 4); return f32;
    }
}

static float load_irradiance(const lensprof_plan *plan, const curve *c, const uint8_t *p)
{
    uint16_t u16;
    if (plan->input == LENSPROF_ENCODING_LINEAR) return load(plan->source_sample, p);
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8: return c->inverse[*p];
    case LENSPROF_SAMPLE_U16: memcpy(&u16, p, 2); return c->inverse[u16];
    default: return decode(c, load(LENSPROF_SAMPLE_F32, p));
    }
}

static void store(uint32_t sample, uint8_t *p, float value)
{
    if (sample == LENSPROF_SAMPLE_F32) {
        memcpy(p, &value, 4);
        return;
    }
    float unit = value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; /* NaN becomes 0 */
    if (sample == LENSPROF_SAMPLE_U8) {
        *p = (uint8_t)(unit * 255.0f + 0.5f);
    } else {
        uint16_t u16 = (uint16_t)(unit * 65535.0f + 0.5f);
        memcpy(p, &u16, 2);
    }
}

/* 0 below `low`, 1 at white, smooth between. */
static float ramp(float value, float low)
{
    float t = (value - low) / (1.0f - low);
    if (!(t > 0.0f)) return 0.0f;
    if (t > 1.0f) t = 1.0f;
    return t * t * (3.0f - 2.0f * t);
}

/* Gains of red, green and blue. Towards white they approach the largest one, gradually, as the brightest channel nears
 * saturation (from 0.9 on) and the darkest one follows (from 0.6 on): a clipped cloud, not a bright colour. */
static void gains_at(const lensprof_plan *plan, const uint8_t *source, const place *at, float gain[3])
{
    uint32_t bytes = lensprof_sample_bytes(plan->source_sample);
    float largest = 0.0f, brightest = 0.0f, darkest = 1.0f;
    for (uint32_t c = 0; c < 3; c++) {
        gain[c] = gain_at(plan, c, at);
        if (gain[c] > largest) largest = gain[c];
    }
    if (!plan->neutral_white || lensprof_layout_channels(plan->layout) == 1) return;
    for (uint32_t s = 0; s < 3; s++) {
        float value = load(plan->source_sample, source + s * bytes);
        if (value > brightest) brightest = value;
        if (!(value > darkest)) darkest = value;
    }
    float t = ramp(brightest, 0.9f) * ramp(darkest, 0.6f);
    for (uint32_t c = 0; c < 3; c++) gain[c] += t * (largest - gain[c]);
}

/* One pixel. Samples beyond the colour channels are alpha. */
static void apply_pixel(const lensprof_plan *plan, const uint8_t *source, uint8_t *target, const place *at)
{
    uint32_t channels = lensprof_layout_channels(plan->layout), samples = lensprof_layout_samples(plan->layout);
    uint32_t source_bytes = lensprof_sample_bytes(plan->source_sample);
    uint32_t target_bytes = lensprof_sample_bytes(plan->target_sample);
    float gain[3];
    gains_at(plan, source, at, gain);
    for (uint32_t s = 0; s < samples; s++) {
        const uint8_t *from = source + s * source_bytes;
        uint8_t *to = target + s * target_bytes;
        if (s >= channels) {
            store(plan->target_sample, to, load(plan->source_sample, from));
            continue;
        }
        uint32_t channel = channels == 1 ? 1 : plan->channel_of_sample[s]; /* grey is treated as green */
        const curve *c = &plan->curves[channel];
        float x = load_irradiance(plan, c, from) * gain[channel];
        store(plan->target_sample, to, plan->output == LENSPROF_ENCODING_LINEAR ? x : encode(c, x));
    }
}

/* First and last byte that a view touches. */
static void extent(const lensprof_image *image, uintptr_t *first, uintptr_t *last)
{
    uintptr_t top = (uintptr_t)image->data;
    uintptr_t bottom = top + (uintptr_t)((intptr_t)(image->height - 1) * image->row_bytes);
    uintptr_t row =
        (uintptr_t)image->width * lensprof_layout_samples(image->layout) * lensprof_sample_bytes(image->sample);
    *first = top < bottom ? top : bottom;
    *last = (top < bottom ? bottom : top) + row - 1;
}

static lensprof_status validate_tile(const lensprof_plan *plan, const lensprof_image *source,
                                     const lensprof_image *target, uint32_t x0, uint32_t y0)
{
    lensprof_status status = lensprof_image_validate(source);
    if (status == LENSPROF_OK) status = lensprof_image_validate(target);
    if (status != LENSPROF_OK) return status;
    if (source->sample != plan->source_sample || target->sample != plan->target_sample || source->layout != plan->layout
        || target->layout != plan->layout)
        return LENSPROF_ERROR_ARGUMENT;
    if (source->width != target->width || source->height != target->height) return LENSPROF_ERROR_SIZE;
    if (x0 > plan->frame_width || source->width > plan->frame_width - x0 || y0 > plan->frame_height
        || source->height > plan->frame_height - y0)
        return LENSPROF_ERROR_SIZE;
    int in_place = source->data == target->data && source->row_bytes == target->row_bytes
                   && source->sample == target->sample;
    uintptr_t a0, a1, b0, b1;
    extent(source, &a0, &a1);
    extent(target, &b0, &b1);
    return in_place || a1 < b0 || b1 < a0 ? LENSPROF_OK : LENSPROF_ERROR_ARGUMENT;
}

lensprof_status lensprof_apply(const lensprof_plan *plan, const lensprof_image *source, const lensprof_image *target,
                               uint32_t x0, uint32_t y0)
{
    if (!plan || !source || !target) return LENSPROF_ERROR_ARGUMENT;
    lensprof_status status = validate_tile(plan, source, target, x0, y0);
    if (status != LENSPROF_OK) return status;
    size_t samples = lensprof_layout_samples(plan->layout);
    size_t source_step = samples * lensprof_sample_bytes(plan->source_sample);
    size_t target_step = samples * lensprof_sample_bytes(plan->target_sample);
    for (uint32_t y = 0; y < source->height; y++) {
        const uint8_t *from = (const uint8_t *)source->data + (ptrdiff_t)y * source->row_bytes;
        uint8_t *to = (uint8_t *)target->data + (ptrdiff_t)y * target->row_bytes;
        float dy = ((float)(y0 + y) - plan->center_px[1]) * plan->per_rho;
        place at = {0.0f, {0, 0.0}, {0, 0.0}};
        if (plan->columns) at.row = lp_grid_cell_at(y0 + y, plan->frame_height, plan->rows);
        for (uint32_t x = 0; x < source->width; x++, from += source_step, to += target_step) {
            float dx = ((float)(x0 + x) - plan->center_px[0]) * plan->per_rho;
            at.r2 = dx * dx + dy * dy;
            if (plan->columns) at.column = lp_grid_cell_at(x0 + x, plan->frame_width, plan->columns);
            apply_pixel(plan, from, to, &at);
        }
    }
    return LENSPROF_OK;
}
