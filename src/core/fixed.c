/* Applies a model to pixels in integers: logarithms of light, thresholds between codes (lensprof/fixed.h). */
#include "core/fixed_plan.h"

#include <string.h>

#include "core/response.h"

#define FRACTION ((1u << LP_LOG_SHIFT) - 1)

/* ---- logarithms ---- */

/* The position of the highest set bit of v > 0. */
static uint32_t top_bit(uint32_t v) {
    uint32_t place = 0;
    for (uint32_t step = 16; step; step /= 2)
        if (v >> step) v >>= step, place += step;
    return place;
}

/* log2 of v > 0. */
static int32_t log2_of(uint32_t v) {
    const uint32_t place = top_bit(v), mantissa = v << (31 - place), i = mantissa >> 23 & 255;
    const uint32_t rise = lp_log2_table[i + 1] - lp_log2_table[i], part = mantissa >> 7 & 0xffff; /* 15, 16 bits */
    /* between entries the curve is above a straight line by log(2) / 2 rise^2 part (1 - part) */
    const uint32_t bend = (rise * rise >> 16) * (part * (uint16_t)~part >> 16) * 11 >> 27;
    return (int32_t)((place << LP_LOG_SHIFT) + lp_log2_table[i] + (rise * part >> 16) + bend);
}

/* 2^f in 2^-30, for the fractional part of a logarithm. */
static uint32_t exp2_of(uint32_t f) {
    const uint32_t i = f >> (LP_LOG_SHIFT - 8), rest = f & (FRACTION >> 8); /* 14 bits */
    const uint32_t rise = lp_exp2_table[i + 1] - lp_exp2_table[i];          /* 23 bits */
    const uint32_t bend = rest * ((1u << 14) - rest) * 44 >> 29; /* the curve is below a straight line: log(2) / 512 */
    return lp_exp2_table[i] + ((rise >> 5) * (rest - bend) >> (LP_LOG_SHIFT - 8 - 5));
}

/* ---- gains ---- */

/* r^2 from the centre, in 2^-20 px^2. */
static uint64_t r2_of(const lensprof_fixed_plan *plan, uint32_t x, uint32_t y) {
    const int64_t dx = (int64_t)((int32_t)(x << LP_CENTER_SHIFT) - plan->center[0]);
    const int64_t dy = (int64_t)((int32_t)(y << LP_CENTER_SHIFT) - plan->center[1]);
    return (uint64_t)(dx * dx + dy * dy);
}

static int32_t times(int32_t a, uint32_t t) { return (int32_t)((int64_t)a * t >> 31); }

/* Where a pixel is. */
typedef struct pixel_place {
    uint32_t t;                  /* r^2, as the falloff counts it */
    lp_sensor_place column, row; /* in the gain grid, if there is one */
} pixel_place;

#if LP_HAS_FIXED_GRID
/* The falloff times the grid, by strength. */
static int32_t with_grid(const lensprof_fixed_plan *plan, uint32_t channel, const pixel_place *at, int32_t m) {
    const lp_fixed_grid *grid = &plan->grid;
    const uint32_t columns = grid->columns, plane = grid->channels == 3 ? channel : 0;
    const int32_t *nodes = (const int32_t *)(const void *)plan + plan->bytes / 4 - lp_fixed_nodes(plan);
    const int32_t *above = nodes + (plane * grid->rows + at->row.node) * columns + at->column.node;
    const uint32_t across = at->column.rest * grid->axis[0].per_whole, down = at->row.rest * grid->axis[1].per_whole;
    const int32_t attenuation = lp_sensor_between(lp_sensor_between(above[0], above[1], across),
                                                  lp_sensor_between(above[columns], above[columns + 1], across), down);
    const int32_t one = 1 << plan->falloff_shift, product = (int32_t)((int64_t)m * attenuation >> grid->shift);
    return one + (int32_t)((int64_t)(product - one) * (int32_t)grid->strength >> LP_STRENGTH_SHIFT);
}
#endif

/* log2 of the falloff M of a channel. */
static int32_t falloff_at(const lensprof_fixed_plan *plan, uint32_t channel, const pixel_place *at) {
    const int32_t *k = plan->k[channel];
    const uint32_t t = at->t;
    int32_t m = (1 << plan->falloff_shift) + times(k[0] + times(k[1] + times(k[2], t), t), t);
#if LP_HAS_FIXED_GRID
    if (plan->grid.columns) m = with_grid(plan, channel, at, m);
#endif
    if (m < plan->least) m = plan->least;
    return log2_of((uint32_t)m) - (int32_t)(plan->falloff_shift << LP_LOG_SHIFT);
}

static int32_t gain_of(const lensprof_fixed_plan *plan, uint32_t channel, int32_t falloff) {
    const int32_t gain = plan->factor[channel] - falloff;
    return plan->simulate ? -gain : gain;
}

/* log2 of the gains of the channels. */
static void find_gains(const lensprof_fixed_plan *plan, const pixel_place *at, int32_t *gain) {
    int32_t falloff = falloff_at(plan, 0, at);
    gain[0] = gain_of(plan, 0, falloff);
    for (uint32_t c = 1; c < LP_CHANNELS; c++) {
        if (c < plan->falloffs) falloff = falloff_at(plan, c, at);
        gain[c] = plan->gains == 3 ? gain_of(plan, c, falloff) : gain[0];
    }
}

/* ---- towards white ---- */

#define ONE (1u << 24)      /* of what follows, */
#define WHITE (65535u << 8) /* but for grey values */

static uint32_t share_of(uint32_t a, uint32_t b) { return (uint32_t)((uint64_t)a * b >> 24); }

/* 0 up to `low`, 1 at white, smooth in between. v is relative to WHITE, low to twice that; per_span: 2^48 divided by
 * the span in between. */
static uint32_t ramp(uint32_t v, uint32_t low, uint32_t per_span) {
    if (2 * v <= low) return 0;
    const uint32_t t = (uint32_t)((uint64_t)(2 * v - low) * per_span >> 24);
    return share_of(share_of(t, t), 3 * ONE - 2 * t);
}

/* As in the row kernel: from 0.9 of the brightest and 0.6 of the darkest channel on, gains approach the largest. */
static void approach_white(const uint32_t *value, int32_t *gain) {
    uint32_t brightest = value[0], darkest = value[0];
    int32_t largest = gain[0];
    for (uint32_t c = 1; c < 3; c++) {
        if (value[c] > brightest) brightest = value[c];
        if (value[c] < darkest) darkest = value[c];
        if (gain[c] > largest) largest = gain[c];
    }
    const uint32_t t = share_of(ramp(brightest, 117963 << 8, 83887360), ramp(darkest, 78642 << 8, 20971840));
    for (uint32_t c = 0; c < 3 && t; c++) {
        const int32_t off = gain[c] - largest;
        const uint32_t octaves = (uint32_t)(-(off >> LP_LOG_SHIFT));
        const uint32_t share =
            octaves > 30 ? 0 : exp2_of((uint32_t)off & FRACTION) >> octaves; /* of the largest gain */
        const uint32_t raised = share + share_of((1u << 30) - share, t);
        gain[c] = largest + log2_of(raised) - (30 << LP_LOG_SHIFT);
    }
}

/* ---- samples ---- */

static const int32_t *decode_table(const lensprof_fixed_plan *plan, uint32_t channel) {
    const int32_t *tables = (const int32_t *)(const void *)(plan + 1);
    return tables + (plan->decode_curves == 3 ? channel * LP_CODES : 0);
}

static const int32_t *encode_table(const lensprof_fixed_plan *plan, uint32_t channel) {
    const int32_t *tables = (const int32_t *)(const void *)(plan + 1) + plan->decode_curves * LP_CODES;
    return tables + (plan->encode_curves == 3 ? channel * LP_CODES : 0);
}

/* The number of thresholds that a light has reached: its code. */
static uint8_t code_of(const int32_t *thresholds, int32_t light) {
    uint32_t code = 0;
    for (uint32_t step = LP_CODES / 2; step; step /= 2)
        if (thresholds[code + step - 1] <= light) code += step;
    return (uint8_t)code;
}

/* A number times 2^gain, rounded to nearest; at most `largest`, of up to 25 bits, or of 31 if gain is not above 0. */
static uint32_t multiplied(uint32_t number, int32_t gain, uint32_t largest) {
    const int32_t octaves = gain >> LP_LOG_SHIFT; /* towards minus infinity */
    if (octaves < -33 || !number) return 0;
    if (octaves > 25) return largest;
    const uint32_t shift = (uint32_t)(30 - octaves);
    const uint64_t result = ((uint64_t)number * exp2_of((uint32_t)gain & FRACTION) + (1ull << (shift - 1))) >> shift;
    return result < largest ? (uint32_t)result : largest;
}

/* The code of a number in 1 / 256 of a code, clipped. */
static uint32_t nearest_code(const lensprof_fixed_plan *plan, int32_t number) {
    const int32_t code = (number + (1 << (LP_LEVEL_SHIFT - 1))) >> LP_LEVEL_SHIFT;
    return (uint32_t)(code < 0 ? 0 : code > plan->largest ? plan->largest : code);
}

/* A linear code times 2^gain, from black to black, so that noise about it keeps its mean; clipped. */
static uint32_t linear_code(const lensprof_fixed_plan *plan, uint32_t code, uint32_t channel, int32_t gain) {
    if (!LP_HAS_LEVELS || !plan->levels) return multiplied(code, gain, (uint32_t)plan->largest);
    const int32_t light = (int32_t)(code << LP_LEVEL_SHIFT) - plan->black_in[channel];
    const int32_t size = (int32_t)multiplied((uint32_t)(light < 0 ? -light : light), gain, 1u << 25);
    return nearest_code(plan, (light < 0 ? -size : size) + plan->black_out[channel]);
}

#if LP_HAS_WIDE_CURVES
static const int32_t *samples_of(const lensprof_fixed_plan *plan, const lp_fixed_curve *curve) {
    return (const int32_t *)(const void *)(plan + 1) + curve->samples;
}

static const lp_fixed_curve *curve_of(const lensprof_fixed_plan *plan, uint32_t channel, int is_output) {
    const lp_fixed_curve *curves = (const lp_fixed_curve *)(const void *)(plan + 1);
    if (is_output) curves += plan->decode_curves;
    return curves + ((is_output ? plan->encode_curves : plan->decode_curves) == 3 ? channel : 0);
}

/* a / b for 0 < a <= b < 2^31, in 2^-LP_PLACE_SHIFT, rounded down. Small processors do not divide. */
static uint32_t ratio_of(uint32_t a, uint32_t b) {
    uint32_t ratio = 0;
    for (uint32_t bit = 0; bit <= LP_PLACE_SHIFT; bit++, a <<= 1) {
        ratio <<= 1;
        if (a >= b) a -= b, ratio++;
    }
    return ratio;
}

/* The first place among samples that has a value; 0 below them, the last one above. */
static uint32_t place_of(const int32_t *samples, int32_t value) {
    uint32_t j = 0;
    if (value <= samples[0]) return 0;
    if (value > samples[LP_CURVE_LAST]) return LP_CURVE_LAST << LP_PLACE_SHIFT;
    for (uint32_t step = LENSPROF_RESPONSE_SAMPLES / 2; step; step /= 2)
        if (samples[j + step] < value) j += step;
    return (j << LP_PLACE_SHIFT) + ratio_of((uint32_t)(value - samples[j]), (uint32_t)(samples[j + 1] - samples[j]));
}

static int32_t value_at(const int32_t *samples, uint32_t place) {
    const uint32_t j = place ? (place - 1) >> LP_PLACE_SHIFT : 0, rest = place - (j << LP_PLACE_SHIFT);
    const uint32_t rise = (uint32_t)(samples[j + 1] - samples[j]);
    return samples[j] + (int32_t)((uint64_t)rise * rest >> LP_PLACE_SHIFT);
}

static int32_t raised(int32_t log, uint32_t exponent) {
    const int64_t result = ((int64_t)log * exponent + (1 << (LP_EXPONENT_SHIFT - 1))) >> LP_EXPONENT_SHIFT;
    return result < LP_LOG_NONE ? LP_LOG_NONE : result > LP_LOG_MOST ? LP_LOG_MOST : (int32_t)result;
}

/* log2 of the light of a code. */
static int32_t wide_light(const lensprof_fixed_plan *plan, uint32_t code, uint32_t channel) {
    const lp_fixed_curve *curve = curve_of(plan, channel, 0);
    const int32_t number = curve->samples
                               ? (int32_t)place_of(samples_of(plan, curve), (int32_t)(code << LP_SAMPLE_SHIFT))
                               : (int32_t)(code << LP_LEVEL_SHIFT) - plan->black_in[channel];
    if (number <= 0) return LP_LOG_NONE;
    const int32_t log = log2_of((uint32_t)number) - curve->log_one;
    return raised(log < curve->most ? log : curve->most, curve->exponent);
}

static uint32_t wide_code(const lensprof_fixed_plan *plan, int32_t light, uint32_t channel) {
    const lp_fixed_curve *curve = curve_of(plan, channel, 1);
    const uint32_t largest = curve->samples ? curve->one : 1u << 25;
    const uint32_t number = multiplied(curve->one, raised(light, curve->exponent), largest);
    return nearest_code(plan, curve->samples
                                  ? value_at(samples_of(plan, curve), number) >> (LP_SAMPLE_SHIFT - LP_LEVEL_SHIFT)
                                  : (int32_t)number + plan->black_out[channel]);
}
#else
static int32_t wide_light(const lensprof_fixed_plan *plan, uint32_t code, uint32_t channel) {
    return (void)plan, (void)channel, (int32_t)code;
}

static uint32_t wide_code(const lensprof_fixed_plan *plan, int32_t light, uint32_t channel) {
    return (void)plan, (void)channel, (uint32_t)light;
}
#endif

static uint32_t bytes_of(uint32_t sample) { return sample == LENSPROF_SAMPLE_U8 ? 1 : 2; }

/* The code of a sample; of 16 bit unless all are of 8. */
static uint32_t get_code(const lensprof_fixed_plan *plan, const uint8_t *p) {
    uint16_t code;
    if (plan->sample == LENSPROF_SAMPLE_U8) return lp_fixed_is_8_bit(plan) ? *p : *p * 257u;
    memcpy(&code, p, sizeof code);
    return code;
}

static void put_code(uint32_t sample, uint32_t code, uint8_t *p) {
    const uint16_t word = (uint16_t)code;
    if (sample == LENSPROF_SAMPLE_U8)
        *p = (uint8_t)code;
    else
        memcpy(p, &word, sizeof word);
}

static void put_sample(const lensprof_fixed_plan *plan, uint32_t code, uint32_t channel, int32_t gain, uint8_t *p) {
    uint32_t result;
    if (lp_fixed_is_wide(plan))
        result = wide_code(plan, wide_light(plan, code, channel) + gain, channel);
    else if (plan->decode_curves)
        result = code_of(encode_table(plan, channel), decode_table(plan, channel)[code] + gain);
    else
        result = linear_code(plan, code, channel, gain);
    put_code(lp_fixed_target(plan), result, p);
}

static void put_alpha(const lensprof_fixed_plan *plan, uint32_t code, uint8_t *p) {
    if (lp_fixed_target(plan) < plan->sample) code = (code * 255 + 32895) >> 16; /* rounded to nearest */
    put_code(lp_fixed_target(plan), code, p);
}

/* The grey value of a code from which black has been subtracted, relative to WHITE. */
static uint32_t grey_of(const lensprof_fixed_plan *plan, uint32_t code, uint32_t channel) {
    if (!LP_HAS_LEVELS || !plan->levels) return code * (lp_fixed_is_8_bit(plan) ? WHITE / 255 : WHITE / 65535);
    const int32_t light = (int32_t)(code << LP_LEVEL_SHIFT) - plan->black_in[channel];
    const uint64_t grey = light > 0 ? (uint64_t)light * plan->per_span[channel] >> lp_fixed_span_shift(plan) : 0;
    return grey < WHITE ? (uint32_t)grey : WHITE;
}

/* ---- rows ---- */

/* One sample per pixel: grey, or a mosaic. */
static void do_single(const lensprof_fixed_plan *plan, const uint8_t *from, uint8_t *to, uint32_t channel,
                      const pixel_place *at) {
    const int32_t falloff = falloff_at(plan, plan->falloffs == 3 ? channel : 0, at);
    put_sample(plan, get_code(plan, from), channel, gain_of(plan, channel, falloff), to);
}

static void do_pixel(const lensprof_fixed_plan *plan, const uint8_t *from, uint8_t *to, const pixel_place *at) {
    const uint32_t read = bytes_of(plan->sample), written = bytes_of(lp_fixed_target(plan));
    uint32_t code[4], value[LP_CHANNELS];
    int32_t gain[LP_CHANNELS];
    find_gains(plan, at, gain);
    for (uint32_t n = 0; n < plan->samples; n++) {
        const uint32_t channel = plan->channel_of_sample[n];
        code[n] = get_code(plan, from + n * read);
        if (channel != LP_ALPHA) value[channel] = grey_of(plan, code[n], channel);
    }
    if (plan->neutral_white) approach_white(value, gain);
    for (uint32_t n = 0; n < plan->samples; n++) {
        const uint32_t channel = plan->channel_of_sample[n];
        if (channel == LP_ALPHA)
            put_alpha(plan, code[n], to + n * written);
        else
            put_sample(plan, code[n], channel, gain[channel], to + n * written);
    }
}

static void do_row(const lensprof_fixed_plan *plan, const uint8_t *from, uint8_t *to, uint32_t x, uint32_t y,
                   uint32_t count) {
    const uint32_t read = plan->samples * bytes_of(plan->sample);
    const uint32_t written = plan->samples * bytes_of(lp_fixed_target(plan));
    /* (x + 1)^2 - x^2 = 2 x + 1, in units of 2^-10 px */
    uint64_t r2 = r2_of(plan, x, y);
    int64_t rise = 2 * ((int64_t)(int32_t)(x << LP_CENTER_SHIFT) - plan->center[0]) * (1 << LP_CENTER_SHIFT)
                   + (1 << 2 * LP_CENTER_SHIFT);
    pixel_place at;
#if LP_HAS_FIXED_GRID
    if (plan->grid.columns) {
        at.column = lp_sensor_place_at(&plan->grid.axis[0], plan->grid.columns, x);
        at.row = lp_sensor_place_at(&plan->grid.axis[1], plan->grid.rows, y);
    }
#endif
    for (uint32_t i = 0; i < count; i++, from += read, to += written) {
        at.t = (uint32_t)(r2 << plan->reach_shift >> 32);
        if (plan->samples == 1)
            do_single(plan, from, to, plan->site[y & 1][(x + i) & 1], &at);
        else
            do_pixel(plan, from, to, &at);
        r2 += (uint64_t)rise;
        rise += 2 << 2 * LP_CENTER_SHIFT;
        if (LP_HAS_FIXED_GRID && plan->grid.columns)
            lp_sensor_next(&plan->grid.axis[0], plan->grid.columns, &at.column);
    }
}

lensprof_status lensprof_fixed_apply(const lensprof_fixed_plan *plan, const lensprof_image *source,
                                     const lensprof_target *target, uint32_t x0, uint32_t y0) {
    if (!plan || !target) return LENSPROF_ERROR_ARGUMENT;
    const lensprof_image written = lp_image_of(target);
    if (!source) source = &written;
    const lp_tiles tiles = {plan->sample, lp_fixed_target(plan), plan->layout, plan->frame_width, plan->frame_height};
    const lensprof_status status = lp_tile_validate(&tiles, source, &written, x0, y0);
    for (uint32_t y = 0; status == LENSPROF_OK && y < source->height; y++)
        do_row(plan, (const uint8_t *)source->data + (ptrdiff_t)y * source->row_bytes,
               (uint8_t *)target->data + (ptrdiff_t)y * target->row_bytes, x0, y0 + y, source->width);
    return status;
}
