/* The row kernel, compiled once for every lane count (a lanes_*.h comes first): pixels in strips that stay in the first
 * cache, each strip in steps: gains, light, light times gain, grey values. */
#include "../plan.h"

#if defined(__GNUC__)
#define ALWAYS_INLINE static inline __attribute__((always_inline))
#else
#define ALWAYS_INLINE static inline
#endif

#define LAST (LENSPROF_RESPONSE_SAMPLES - 1)
#define MOST_SAMPLES (4 * STRIP)
#define ROOM (MOST_SAMPLES + LANES) /* the last vector of a strip may go beyond */

/* Planes stand STRIP + LANES apart on it. */
typedef struct strip {
    float gain[LP_CHANNELS][STRIP + LANES]; /* of the pixels */
    float factor[ROOM];                     /* of the samples */
    float light[ROOM];
    int32_t channel[ROOM];  /* of the samples, where the channels have curves of their own */
    float rounding[ROOM];   /* added before a code is cut to an integer, with dither */
    uint8_t alpha[STRIP][4];
    float grid[LP_CHANNELS][LENSPROF_GRID_SIDE + 1];
} strip;

/* ---- gains ---- */

/* The gain grid's nodes, interpolated to a row. They hold what the attenuation is beyond 1, which is small: single
 * precision loses less. */
static void blend_rows(const lensprof_plan *plan, uint32_t y, strip *s)
{
    uint32_t last = plan->rows - 1, pixels = plan->frame_height > 1 ? plan->frame_height - 1 : 1;
    uint32_t at = y * last, node = at / pixels;
    if (node >= last) node = last - 1;
    float v = (float)(at - node * pixels) / (float)pixels;
    for (uint32_t c = 0; c < plan->gains; c++) {
        const float *above = plan->nodes[c] + node * plan->columns, *below = above + plan->columns;
        for (uint32_t i = 0; i < plan->columns; i++) s->grid[c][i] = above[i] + v * (below[i] - above[i]);
    }
}

/* The grid's values at pixels of the row, to `values`. */
static void grid_values(const lensprof_plan *plan, const float *nodes, uint32_t x, uint32_t count, float *values)
{
    uint32_t last = plan->columns - 1, pixels = plan->frame_width > 1 ? plan->frame_width - 1 : 1;
    uint32_t node = x * last / pixels, rest = x * last - node * pixels;
    float per_pixel = (float)pixels;
    for (uint32_t i = 0; i < count; i++) {
        if (node < last) values[i] = nodes[node] + (float)rest / per_pixel * (nodes[node + 1] - nodes[node]);
        else values[i] = nodes[last];
        for (rest += last; rest >= pixels; rest -= pixels) node++;
    }
}

/* factor / M of channel c for pixels of the row (or M / factor, to simulate), to s->gain[c]. */
static void gains_of_channel(const lensprof_plan *plan, uint32_t c, uint32_t x, float dy, uint32_t count, strip *s)
{
    float *gain = s->gain[c];
    const int has_grid = plan->columns != 0;
    const lane_f one = f_set(1.0f), k0 = f_set(plan->k[c][0]), k1 = f_set(plan->k[c][1]), k2 = f_set(plan->k[c][2]);
    const lane_i first = i_add(i_set((int32_t)x - plan->center_px[0]), i_count());
    const lane_f part = f_set(plan->center_part[0]), dy2 = f_set(dy * dy), factor = f_set(plan->factor[c]);
    const lane_f least = f_set(plan->least), strength = f_set(plan->strength);
    if (has_grid) grid_values(plan, s->grid[c], x, count, gain);
    for (uint32_t i = 0; i < count; i += LANES) {
        lane_f dx = f_sub(f_of_i(i_add(first, i_set((int32_t)i))), part);
        lane_f r2 = f_add(f_mul(dx, dx), dy2);
        lane_f off = f_mul(r2, f_add(k0, f_mul(r2, f_add(k1, f_mul(r2, k2))))); /* M - 1 */
        if (has_grid) {
            const lane_f grid = f_load(gain + i);
            off = f_mul(strength, f_add(f_add(off, grid), f_mul(off, grid)));
        }
        const lane_f m = f_max(f_add(one, off), least);
        f_store(gain + i, plan->simulate ? f_div(m, factor) : f_div(factor, m));
    }
}

/* Gains of the samples of `count` pixels from those of the pixels. */
static void spread_gains(const lensprof_plan *plan, uint32_t x, uint32_t y, uint32_t count, strip *s)
{
    const float *gain[LP_CHANNELS];
    for (uint32_t c = 0; c < LP_CHANNELS; c++) gain[c] = s->gain[plan->gains == 3 ? c : 0];
    if (plan->layout == LENSPROF_LAYOUT_PLANAR) {
        for (uint32_t c = 0; c < LP_CHANNELS; c++)
            for (uint32_t i = 0; i < count; i++) s->factor[c * (STRIP + LANES) + i] = gain[c][i] * plan->times[c];
    } else if (plan->samples == 1) { /* grey and mosaics */
        const float *of[2];
        float times[2];
        for (uint32_t parity = 0; parity < 2; parity++) {
            const uint32_t c = plan->site[y & 1][(x + parity) & 1];
            of[parity] = gain[c], times[parity] = plan->times[c];
        }
        for (uint32_t i = 0; i < count; i++) s->factor[i] = of[i & 1][i] * times[i & 1];
    } else if (plan->samples == 3) {
        const uint8_t *channel = plan->channel_of_sample;
        const lane_f times[3] = {f_set(plan->times[channel[0]]), f_set(plan->times[channel[1]]),
                                 f_set(plan->times[channel[2]])};
        for (uint32_t i = 0; i < count; i += LANES)
            f_store3(s->factor + 3 * i, f_mul(f_load(gain[channel[0]] + i), times[0]),
                     f_mul(f_load(gain[channel[1]] + i), times[1]), f_mul(f_load(gain[channel[2]] + i), times[2]));
    } else {
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t n = 0; n < plan->samples; n++) {
                uint32_t c = plan->channel_of_sample[n];
                s->factor[plan->samples * i + n] = c == LP_ALPHA ? 1.0f : gain[c][i] * plan->times[c];
            }
    }
}

/* The curve of every sample of a strip; strips begin at even pixels of the row. */
static void find_channels(const lensprof_plan *plan, uint32_t x, uint32_t y, strip *s)
{
    for (uint32_t i = 0; i < ROOM; i++) {
        uint32_t c = plan->channel_of_sample[i % plan->samples];
        if (plan->layout == LENSPROF_LAYOUT_PLANAR) c = i / (STRIP + LANES);
        else if (plan->samples == 1) c = plan->site[y & 1][(x + i) & 1];
        s->channel[i] = (int32_t)(c == LP_ALPHA ? 1 : c);
    }
}

/* ---- curves ---- */

/* x^e for 0 <= x <= 1, e > 0: 2^(e log2 x). log2 by the series of atanh, 2^ by a polynomial; relative error below 2e-6
 * where the result is above 1e-3. */
ALWAYS_INLINE lane_f power(lane_f x, lane_f e)
{
    const lane_i bits = i_of_bits(f_max(x, f_set(1e-37f)));
    const lane_i shifted = i_sub(bits, i_set(0x3f3504f3)); /* of the square root of 1/2: m lies about 1 */
    const lane_f whole = f_of_i(i_sub(i_right(i_add(shifted, i_set(0x40000000)), 23), i_set(0x80)));
    const lane_f m = f_of_bits(i_add(i_and(shifted, i_set(0x007fffff)), i_set(0x3f3504f3)));
    const lane_f t = f_div(f_sub(m, f_set(1.0f)), f_add(m, f_set(1.0f))), t2 = f_mul(t, t);
    lane_f series = f_add(f_set(0.4121985831f), f_mul(t2, f_set(0.3205988980f)));
    series = f_add(f_set(0.5770780164f), f_mul(t2, series));
    series = f_add(f_set(0.9617966939f), f_mul(t2, series));
    series = f_mul(t, f_add(f_set(2.8853900818f), f_mul(t2, series)));
    const lane_f z = f_max(f_mul(e, f_add(whole, series)), f_set(-126.0f));
    const lane_i n = i_sub(i_of_f(f_add(z, f_set(128.5f))), i_set(128)); /* to nearest */
    const lane_f f = f_sub(z, f_of_i(n));
    lane_f p = f_add(f_set(1.3333558e-3f), f_mul(f, f_set(1.5403530e-4f)));
    p = f_add(f_set(9.6181291e-3f), f_mul(f, p));
    p = f_add(f_set(5.5504109e-2f), f_mul(f, p));
    p = f_add(f_set(2.4022651e-1f), f_mul(f, p));
    p = f_add(f_set(6.9314718e-1f), f_mul(f, p));
    p = f_add(f_set(1.0f), f_mul(f, p));
    lane_f y = f_mul(p, f_of_bits(i_left(i_add(n, i_set(127)), 23)));
    y = f_pick(f_less(x, f_set(1e-37f)), f_set(0.0f), y);
    return f_pick(f_less(x, f_set(1.0f)), y, f_set(1.0f));
}

ALWAYS_INLINE lane_f cut(lane_f x) { return f_min(f_max(x, f_set(0.0f)), f_set(1.0f)); } /* 0 for NaN */

/* f(x) by its samples, 0 <= x <= 1. `first`: where the samples begin. */
ALWAYS_INLINE lane_f table_at(const float *samples, lane_f x, lane_i first)
{
    const lane_f position = f_mul(x, f_set((float)LAST));
    const lane_i j = i_min(i_of_f(position), i_set(LAST - 1));
    lane_f low, high;
    f_gather_pair(samples, i_add(j, first), &low, &high);
    return f_add(low, f_mul(f_sub(position, f_of_i(j)), f_sub(high, low)));
}

/* g(b) by the samples of f, 0 <= b <= 1: the smallest x with f(x) >= b. */
ALWAYS_INLINE lane_f table_inverse(const float *samples, lane_f b, lane_i first)
{
    lane_i low = i_set(0);
    for (int32_t step = 512; step > 0; step /= 2) {
        const lane_i next = i_add(low, i_set(step));
        low = i_pick(f_less(f_gather(samples, i_add(next, first)), b), next, low);
    }
    lane_f below, above;
    low = i_min(low, i_set(LAST - 1));
    f_gather_pair(samples, i_add(low, first), &below, &above);
    const lane_f rise = f_sub(above, below);
    const lane_f share = f_div(f_sub(b, below), f_pick(f_less(f_set(0.0f), rise), rise, f_set(1.0f)));
    const lane_f x = f_div(f_add(f_of_i(low), share), f_set((float)LAST));
    return f_pick(f_less(f_set(0.0f), b), x, f_set(0.0f));
}

/* The value of a curve; NaN stays. `at`: index into s->channel. */
ALWAYS_INLINE lane_f curve_value(const lensprof_plan *plan, const strip *s, uint32_t curve, int inverse, uint32_t at,
                                 lane_f x)
{
    const float *exponents = inverse ? plan->inverse_exponent : plan->exponent;
    const lane_f inside = cut(x);
    lane_f y = inside, e = f_set(exponents[0]);
    lane_i channel = i_set(0);
    if (plan->curves == 3) channel = i_load(s->channel + at), e = f_gather(exponents, channel);
    if (curve == LP_CURVE_TABLE || curve == LP_CURVE_MIXED) {
        const lane_i first = i_left(channel, LP_FORWARD_SHIFT);
        y = inverse ? table_inverse(plan->forward, inside, first) : table_at(plan->forward, inside, first);
    }
    if (curve == LP_CURVE_POWER) y = power(inside, e);
    if (curve == LP_CURVE_MIXED) y = f_pick(f_less(f_set(0.0f), e), power(inside, e), y);
    return f_pick(f_is_number(x), y, x);
}

/* Codes of 16 bit that go through a formula become values. */
ALWAYS_INLINE lane_f code_scale(const lensprof_plan *plan)
{
    return f_set(plan->source_sample == LENSPROF_SAMPLE_U16 ? 1.0f / 65535.0f : 1.0f);
}

/* Samples of a strip's light, in place, through a curve; codes of 16 bit become values first. */
ALWAYS_INLINE void through_curve(const lensprof_plan *plan, strip *s, uint32_t curve, int inverse, uint32_t at,
                                 uint32_t count)
{
    const lane_f scale = inverse ? code_scale(plan) : f_set(1.0f);
    for (uint32_t i = at; i < at + count; i += LANES)
        f_store(s->light + i, curve_value(plan, s, curve, inverse, i, f_mul(f_load(s->light + i), scale)));
}

/* ---- samples to light ---- */

/* Half precision (IEEE binary16), exactly. */
static inline float float_of_half(uint16_t h)
{
    uint32_t sign = (uint32_t)(h & 0x8000u) << 16, exponent = (h >> 10) & 31u, mantissa = h & 0x3ffu, bits;
    float f;
    if (exponent == 0) {
        f = (float)mantissa * 5.9604644775390625e-8f; /* 2^-24 */
        return sign ? -f : f;
    }
    if (exponent == 31) bits = sign | 0x7f800000u | mantissa << 13 | (mantissa ? 0x400000u : 0u);
    else bits = sign | (exponent + 112u) << 23 | mantissa << 13;
    memcpy(&f, &bits, sizeof f);
    return f;
}

/* To nearest, halves to even; beyond the range infinity. */
static inline uint16_t half_of_float(float f)
{
    uint32_t bits, magnitude;
    memcpy(&bits, &f, sizeof bits);
    uint16_t sign = (uint16_t)(bits >> 16 & 0x8000u);
    magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) return (uint16_t)(sign | 0x7e00u | (magnitude >> 13 & 0x3ffu));
    if (magnitude >= 0x477ff000u) return (uint16_t)(sign | 0x7c00u);
    if (magnitude < 0x38800000u) { /* below 2^-14: in units of 2^-24 */
        float scaled;
        memcpy(&scaled, &magnitude, sizeof scaled);
        scaled = scaled * 16777216.0f + 8388608.0f; /* 2^23: rounds to nearest even */
        memcpy(&bits, &scaled, sizeof bits);
        return (uint16_t)(sign | (bits & 0x7ffu));
    }
    magnitude += 0xfffu + (magnitude >> 13 & 1u);
    return (uint16_t)(sign | (magnitude - 0x38000000u) >> 13);
}

/* Samples as numbers: codes or values. */
ALWAYS_INLINE lane_f load_values(uint32_t sample, const uint8_t *p)
{
    float values[LANES];
    switch (sample) {
    case LENSPROF_SAMPLE_U8: return f_of_i(i_load_u8(p));
    case LENSPROF_SAMPLE_U16: return f_of_i(i_load_u16(p));
    case LENSPROF_SAMPLE_F16:
        for (uint32_t i = 0; i < LANES; i++) {
            uint16_t h;
            memcpy(&h, p + 2 * i, sizeof h);
            values[i] = float_of_half(h);
        }
        break;
    default: return f_load((const float *)(const void *)p);
    }
    return f_load(values);
}

ALWAYS_INLINE void load_codes(uint32_t sample, const uint8_t *from, uint32_t count, float *light)
{
    const uint32_t bytes = lensprof_sample_bytes(sample), whole = count - count % LANES;
    for (uint32_t i = 0; i < whole; i += LANES) {
        f_store(light + i, load_values(sample, from + i * bytes));
    }
    if (whole < count) {
        float room[LANES] = {0.0f};
        uint8_t *last = (uint8_t *)room;
        memcpy(last, from + whole * bytes, (count - whole) * bytes);
        f_store(light + whole, load_values(sample, last));
    }
}

/* Light of codes by the table of all codes. */
ALWAYS_INLINE lane_f light_of_codes(const lensprof_plan *plan, const strip *s, uint32_t at, lane_f codes)
{
    lane_i code = i_of_f(codes);
    if (plan->curves == 3) {
        const lane_i channel = i_load(s->channel + at);
        code = i_add(code, plan->inverse_shift == 8 ? i_left(channel, 8) : i_left(channel, 16));
    }
    return f_gather(plan->inverse, code);
}

static void codes_to_light(const lensprof_plan *plan, strip *s, uint32_t at, uint32_t count)
{
    for (uint32_t i = at; i < at + count; i += LANES)
        f_store(s->light + i, light_of_codes(plan, s, i, f_load(s->light + i)));
}

/* ---- towards white ---- */

/* 0 below `low`, 1 at white, smooth between. */
static inline float ramp(float value, float low)
{
    float t = (value - low) / (1.0f - low);
    if (!(t > 0.0f)) return 0.0f;
    if (t > 1.0f) t = 1.0f;
    return t * t * (3.0f - 2.0f * t);
}

/* Gains of red, green and blue, in s->factor. Towards white they approach the largest one, gradually, as the brightest
 * channel nears saturation (from 0.9 on) and the darkest one follows (from 0.6 on): a clipped cloud, not a bright
 * colour. The strip's light still holds codes, `unit` of which are white; channels lie `pitch` apart, pixels `step`. */
static void approach_white(strip *s, uint32_t count, uint32_t pitch, uint32_t step, float unit)
{
    for (uint32_t i = 0; i < count; i++) {
        const float *value = s->light + i * step;
        float *gain = s->factor + i * step, brightest = 0.0f, darkest = 1.0f, largest = 0.0f;
        for (uint32_t c = 0; c < 3; c++) {
            float one = value[c * pitch] / unit;
            if (one > brightest) brightest = one;
            if (!(one > darkest)) darkest = one;
            if (gain[c * pitch] > largest) largest = gain[c * pitch];
        }
        float t = ramp(brightest, 0.9f) * ramp(darkest, 0.6f);
        for (uint32_t c = 0; c < 3 && t > 0.0f; c++) gain[c * pitch] += t * (largest - gain[c * pitch]);
    }
}

/* ---- light to samples ---- */

/* One vector as samples at p. `at`: its place on the strip. */
ALWAYS_INLINE void store_vector(const lensprof_plan *plan, uint32_t sample, const strip *s, uint32_t at, lane_f light,
                                uint8_t *p, int stream)
{
    if (sample == LENSPROF_SAMPLE_F32) {
        if (stream) f_stream((float *)(void *)p, light);
        else f_store((float *)(void *)p, light);
        return;
    }
    if (sample == LENSPROF_SAMPLE_F16) {
        float values[LANES];
        f_store(values, light);
        for (uint32_t i = 0; i < LANES; i++) {
            uint16_t h = half_of_float(values[i]);
            memcpy(p + 2 * i, &h, sizeof h);
        }
        return;
    }
    const float unit = sample == LENSPROF_SAMPLE_U8 ? 255.0f : 65535.0f;
    const lane_f codes = f_mul(light, f_set(plan->encode == LP_CURVE_NONE ? 1.0f : unit));
    const lane_f half = plan->dither ? f_load(s->rounding + at) : f_set(0.5f);
    const lane_i code = i_of_f(f_min(f_add(f_max(codes, f_set(0.0f)), half), f_set(unit + 0.5f)));
    if (sample == LENSPROF_SAMPLE_U8) i_store_u8(p, code);
    else if (stream) i_stream_u16(p, code);
    else i_store_u16(p, code);
}

ALWAYS_INLINE void store_samples(const lensprof_plan *plan, uint32_t sample, const strip *s, uint32_t at, uint8_t *to,
                                 uint32_t count, int stream)
{
    const uint32_t bytes = lensprof_sample_bytes(sample);
    uint32_t i = 0;
    stream = stream && CAN_STREAM && sample != LENSPROF_SAMPLE_U8 && sample != LENSPROF_SAMPLE_F16;
    if (stream) { /* up to where vectors are aligned */
        i = (uint32_t)(-(uintptr_t)to % (LANES * bytes)) / bytes;
        if (i > count) i = count;
        float room[LANES];
        uint8_t *first = (uint8_t *)room;
        store_vector(plan, sample, s, at, f_load(s->light + at), first, 0);
        memcpy(to, first, i * bytes);
    }
    for (; i + LANES <= count; i += LANES) 
        store_vector(plan, sample, s, at + i, f_load(s->light + at + i), to + i * bytes, stream);
    if (i < count) {
        float room[LANES];
        uint8_t *last = (uint8_t *)room;
        store_vector(plan, sample, s, at + i, f_load(s->light + at + i), last, 0);
        memcpy(to + i * bytes, last, (count - i) * bytes);
    }
}

/* ---- alpha ---- */

static void take_alpha(const lensprof_plan *plan, const uint8_t *from, uint32_t count, strip *s)
{
    const uint32_t bytes = lensprof_sample_bytes(plan->source_sample);
    for (uint32_t i = 0; i < count; i++)
        memcpy(s->alpha[i], from + ((i + 1) * plan->samples - 1) * bytes, bytes);
}

/* A value 0..1 as one sample. */
static void put_value(uint32_t sample, float value, uint8_t *p)
{
    const float inside = value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f;
    const uint16_t half = half_of_float(value), code = (uint16_t)(inside * 65535.0f + 0.5f);
    switch (sample) {
    case LENSPROF_SAMPLE_U8: *p = (uint8_t)(inside * 255.0f + 0.5f); break;
    case LENSPROF_SAMPLE_U16: memcpy(p, &code, sizeof code); break;
    case LENSPROF_SAMPLE_F16: memcpy(p, &half, sizeof half); break;
    default: memcpy(p, &value, sizeof value); break;
    }
}

static float get_value(uint32_t sample, const uint8_t *p)
{
    uint16_t word;
    float value;
    memcpy(&word, p, sizeof word);
    memcpy(&value, p, sizeof value);
    return sample == LENSPROF_SAMPLE_U8    ? (float)*p / 255.0f
           : sample == LENSPROF_SAMPLE_U16 ? (float)word / 65535.0f
           : sample == LENSPROF_SAMPLE_F16 ? float_of_half(word)
                                           : value;
}

/* As it was, converted where the types differ. */
static void give_alpha(const lensprof_plan *plan, const strip *s, uint8_t *to, uint32_t count)
{
    const uint32_t bytes = lensprof_sample_bytes(plan->target_sample);
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *p = to + ((i + 1) * plan->samples - 1) * bytes;
        if (plan->source_sample == plan->target_sample) memcpy(p, s->alpha[i], bytes);
        else put_value(plan->target_sample, get_value(plan->source_sample, s->alpha[i]), p);
    }
}

/* ---- rows ---- */

/* 8 x 8 ordered dither (Bayer 1973), in 64ths. */
static const uint8_t dither_matrix[8][8] = {
    {0, 32, 8, 40, 2, 34, 10, 42},   {48, 16, 56, 24, 50, 18, 58, 26}, {12, 44, 4, 36, 14, 46, 6, 38},
    {60, 28, 52, 20, 62, 30, 54, 22}, {3, 35, 11, 43, 1, 33, 9, 41},   {51, 19, 59, 27, 49, 17, 57, 25},
    {15, 47, 7, 39, 13, 45, 5, 37},   {63, 31, 55, 23, 61, 29, 53, 21}};

/* Strips begin at pixels of the row that are multiples of 8 away from its first. */
static void find_rounding(const lensprof_plan *plan, uint32_t x, uint32_t y, strip *s)
{
    const uint32_t planes = plan->layout == LENSPROF_LAYOUT_PLANAR ? 3 : 1;
    for (uint32_t plane = 0; plane < planes; plane++)
        for (uint32_t i = 0; i < (planes == 3 ? STRIP + LANES : ROOM); i++)
            s->rounding[plane * (STRIP + LANES) + i] =
                ((float)dither_matrix[y & 7][(x + i / plan->samples) & 7] + 0.5f) * (1.0f / 64.0f);
}

/* Samples that lie one behind the other, in memory and on the strip. */
typedef struct run {
    const uint8_t *from;
    uint8_t *to;
    uint32_t at, count;
} run;

static void decode(const lensprof_plan *plan, const run *r, strip *s)
{
    switch (plan->decode) {
    case LP_CURVE_NONE: break;
    case LP_CURVE_CLIP: through_curve(plan, s, LP_CURVE_CLIP, 1, r->at, r->count); break;
    case LP_CURVE_TABLE:
        if (plan->inverse) codes_to_light(plan, s, r->at, r->count);
        else through_curve(plan, s, LP_CURVE_TABLE, 1, r->at, r->count);
        break;
    case LP_CURVE_POWER: through_curve(plan, s, LP_CURVE_POWER, 1, r->at, r->count); break;
    default: through_curve(plan, s, LP_CURVE_MIXED, 1, r->at, r->count); break;
    }
}

static void encode(const lensprof_plan *plan, const run *r, strip *s)
{
    for (uint32_t i = r->at; i < r->at + r->count; i += LANES)
        f_store(s->light + i, f_mul(f_load(s->light + i), f_load(s->factor + i)));
    switch (plan->encode) {
    case LP_CURVE_NONE: break;
    case LP_CURVE_CLIP: through_curve(plan, s, LP_CURVE_CLIP, 0, r->at, r->count); break;
    case LP_CURVE_TABLE: through_curve(plan, s, LP_CURVE_TABLE, 0, r->at, r->count); break;
    case LP_CURVE_POWER: through_curve(plan, s, LP_CURVE_POWER, 0, r->at, r->count); break;
    default: through_curve(plan, s, LP_CURVE_MIXED, 0, r->at, r->count); break;
    }
}

static void load_run(const lensprof_plan *plan, const run *r, strip *s)
{
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8: load_codes(LENSPROF_SAMPLE_U8, r->from, r->count, s->light + r->at); break;
    case LENSPROF_SAMPLE_U16: load_codes(LENSPROF_SAMPLE_U16, r->from, r->count, s->light + r->at); break;
    case LENSPROF_SAMPLE_F16: load_codes(LENSPROF_SAMPLE_F16, r->from, r->count, s->light + r->at); break;
    default: load_codes(LENSPROF_SAMPLE_F32, r->from, r->count, s->light + r->at); break;
    }
}

static void store_run(const lensprof_plan *plan, const run *r, const strip *s, int stream)
{
    switch (plan->target_sample) {
    case LENSPROF_SAMPLE_U8: store_samples(plan, LENSPROF_SAMPLE_U8, s, r->at, r->to, r->count, stream); break;
    case LENSPROF_SAMPLE_U16: store_samples(plan, LENSPROF_SAMPLE_U16, s, r->at, r->to, r->count, stream); break;
    case LENSPROF_SAMPLE_F16: store_samples(plan, LENSPROF_SAMPLE_F16, s, r->at, r->to, r->count, stream); break;
    default: store_samples(plan, LENSPROF_SAMPLE_F32, s, r->at, r->to, r->count, stream); break;
    }
}

#if LANES > 1
/* The usual ways in one pass: samples of one type in and out, through one curve both ways. The same steps as
 * load_run, decode, encode and store_run, and so the same bytes. */
ALWAYS_INLINE lane_f through(const lensprof_plan *plan, const strip *s, uint32_t sample, uint32_t curve, uint32_t at,
                             const uint8_t *from)
{
    lane_f light;
    if (curve == LP_CURVE_TABLE && sample == LENSPROF_SAMPLE_U8) light = f_gather(plan->inverse, i_load_u8(from));
    else if (curve == LP_CURVE_TABLE && sample == LENSPROF_SAMPLE_U16) light = f_gather(plan->inverse, i_load_u16(from));
    else light = load_values(sample, from);
    if (curve != LP_CURVE_NONE && !(curve == LP_CURVE_TABLE && sample != LENSPROF_SAMPLE_F32))
        light = curve_value(plan, s, curve, 1, at, f_mul(light, code_scale(plan)));
    light = f_mul(light, f_load(s->factor + at));
    return curve == LP_CURVE_NONE ? light : curve_value(plan, s, curve, 0, at, light);
}

ALWAYS_INLINE void one_pass(const lensprof_plan *shared, const run *r, const strip *s, uint32_t sample, uint32_t curve,
                            int stream)
{
    lensprof_plan own = *shared; /* which no store can change */
    const lensprof_plan *plan = &own;
    own.curves = 1, own.dither = 0;
    const uint32_t bytes = sample == LENSPROF_SAMPLE_U8 ? 1 : sample == LENSPROF_SAMPLE_U16 ? 2 : 4;
    float room[2][LANES] = {{0.0f}, {0.0f}};
    uint8_t *in = (uint8_t *)room[0], *out = (uint8_t *)room[1];
    uint32_t i = 0;
    if (stream) { /* up to where vectors are aligned */
        i = (uint32_t)(-(uintptr_t)r->to % (LANES * bytes)) / bytes;
        if (i > r->count) i = r->count;
        memcpy(in, r->from, i * bytes);
        store_vector(plan, sample, s, r->at, through(plan, s, sample, curve, r->at, in), out, 0);
        memcpy(r->to, out, i * bytes);
    }
    for (; i + LANES <= r->count; i += LANES) {
        const lane_f light = through(plan, s, sample, curve, r->at + i, r->from + i * bytes);
        store_vector(plan, sample, s, r->at + i, light, r->to + i * bytes, stream);
    }
    if (i < r->count) {
        memcpy(in, r->from + i * bytes, (r->count - i) * bytes);
        store_vector(plan, sample, s, r->at + i, through(plan, s, sample, curve, r->at + i, in), out,
                     0);
        memcpy(r->to + i * bytes, out, (r->count - i) * bytes);
    }
}

/* False for what is not one of the usual ways. */
static int do_one_pass(const lensprof_plan *plan, const run *r, const strip *s, int stream)
{
    if (plan->source_sample != plan->target_sample || plan->decode != plan->encode || plan->dither
        || (plan->curves == 3 && plan->decode != LP_CURVE_NONE))
        return 0;
    stream = stream && CAN_STREAM && plan->target_sample != LENSPROF_SAMPLE_U8;
    switch (8 * plan->source_sample + plan->decode) {
    case 8 * LENSPROF_SAMPLE_U8 + LP_CURVE_NONE: one_pass(plan, r, s, LENSPROF_SAMPLE_U8, LP_CURVE_NONE, 0); return 1;
    case 8 * LENSPROF_SAMPLE_U8 + LP_CURVE_TABLE: one_pass(plan, r, s, LENSPROF_SAMPLE_U8, LP_CURVE_TABLE, 0); return 1;
    case 8 * LENSPROF_SAMPLE_U16 + LP_CURVE_NONE: one_pass(plan, r, s, LENSPROF_SAMPLE_U16, LP_CURVE_NONE, stream); return 1;
    case 8 * LENSPROF_SAMPLE_U16 + LP_CURVE_TABLE: one_pass(plan, r, s, LENSPROF_SAMPLE_U16, LP_CURVE_TABLE, stream); return 1;
    case 8 * LENSPROF_SAMPLE_U16 + LP_CURVE_POWER: one_pass(plan, r, s, LENSPROF_SAMPLE_U16, LP_CURVE_POWER, stream); return 1;
    case 8 * LENSPROF_SAMPLE_F32 + LP_CURVE_NONE: one_pass(plan, r, s, LENSPROF_SAMPLE_F32, LP_CURVE_NONE, stream); return 1;
    case 8 * LENSPROF_SAMPLE_F32 + LP_CURVE_TABLE: one_pass(plan, r, s, LENSPROF_SAMPLE_F32, LP_CURVE_TABLE, stream); return 1;
    default: return 0;
    }
}
#endif

/* The largest of the codes or values of a run; 0 of none but NaN. Written so that compilers make vectors of it. */
static float largest_of(const lensprof_plan *plan, const run *r)
{
    const uint16_t *codes = (const uint16_t *)(const void *)r->from;
    const float *values = (const float *)(const void *)r->from;
    uint8_t most8 = 0;
    uint16_t most16 = 0;
    float most = 0.0f;
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8:
        for (uint32_t i = 0; i < r->count; i++) most8 = r->from[i] > most8 ? r->from[i] : most8;
        return most8;
    case LENSPROF_SAMPLE_U16:
        for (uint32_t i = 0; i < r->count; i++) most16 = codes[i] > most16 ? codes[i] : most16;
        return most16;
    case LENSPROF_SAMPLE_F32:
        for (uint32_t i = 0; i < r->count; i++) most = values[i] > most ? values[i] : most;
        return most;
    default: return 1.0f; /* halves are not looked through: as if there were white */
    }
}

/* A strip whose factors are known. */
static void do_strip(const lensprof_plan *plan, const run *runs, uint32_t planes, uint32_t count, strip *s, int stream)
{
    static const float units[] = {255.0f, 65535.0f, 1.0f, 1.0f};
    const float unit = units[plan->source_sample];
    const int has_alpha = plan->samples > plan->channels;
    int near_white = 0;
    if (has_alpha) take_alpha(plan, runs[0].from, count, s);
    for (uint32_t p = 0; p < planes && plan->neutral_white; p++)
        near_white |= largest_of(plan, &runs[p]) > 0.89f * unit;
    for (uint32_t p = 0; p < planes && near_white; p++) load_run(plan, &runs[p], s);
    if (near_white)
        approach_white(s, count, planes == 3 ? STRIP + LANES : 1, planes == 3 ? 1 : plan->samples, unit);
    for (uint32_t p = 0; p < planes; p++) {
#if LANES > 1
        if (do_one_pass(plan, &runs[p], s, stream)) continue;
#endif
        if (!near_white) load_run(plan, &runs[p], s);
        decode(plan, &runs[p], s);
        encode(plan, &runs[p], s);
        store_run(plan, &runs[p], s, stream);
    }
    if (has_alpha) give_alpha(plan, s, runs[0].to, count);
}

void ROW_KERNEL(const lensprof_plan *plan, const uint8_t *const source[3], uint8_t *const target[3], uint32_t x,
                uint32_t y, uint32_t count, int stream)
{
    const uint32_t planes = plan->layout == LENSPROF_LAYOUT_PLANAR ? 3 : 1;
    const uint32_t from_step = plan->samples * lensprof_sample_bytes(plan->source_sample);
    const uint32_t to_step = plan->samples * lensprof_sample_bytes(plan->target_sample);
    const float dy = (float)((int32_t)y - plan->center_px[1]) - plan->center_part[1];
    strip s;
    if (plan->columns) blend_rows(plan, y, &s);
    if (plan->curves == 3) find_channels(plan, x, y, &s);
    if (plan->dither) find_rounding(plan, x, y, &s);
    for (uint32_t done = 0; done < count; done += STRIP) {
        const uint32_t n = count - done < STRIP ? count - done : STRIP;
        run runs[3];
        for (uint32_t c = 0; c < plan->gains; c++) gains_of_channel(plan, c, x + done, dy, n, &s);
        spread_gains(plan, x + done, y, n, &s);
        for (uint32_t p = 0; p < planes; p++)
            runs[p] = (run){source[p] + (size_t)done * from_step, target[p] + (size_t)done * to_step,
                            p * (STRIP + LANES), n * plan->samples};
        do_strip(plan, runs, planes, n, &s, stream);
    }
    if (stream) end_stream();
}
