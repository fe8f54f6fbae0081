/* The row kernel, compiled once for every lane count (a lanes_*.h comes first): pixels in strips, each strip in steps:
 * gains, light, light times gain, grey values. */
#include "core/kernels/strip.h"

#include "core/kernels/curves.h"
#include "core/kernels/gains.h"
#include "core/kernels/samples.h"
#if LANES > 1
#include "core/kernels/tables.h"
#endif

/* ---- towards white ---- */

/* 0 below `low`, 1 at white, smooth between. */
static inline float ramp(float value, float low) {
    float t = (value - low) / (1.0f - low);
    if (!(t > 0.0f)) return 0.0f;
    if (t > 1.0f) t = 1.0f;
    return t * t * (3.0f - 2.0f * t);
}

/* 0 without light and 1 at white. */
static inline float value_of_code(const lensprof_plan *plan, float code, uint32_t channel, float unit) {
#if LP_HAS_LEVELS
    (void)unit;
    return (code - plan->levels.black_code[channel]) / plan->levels.code_span[channel];
#else
    (void)plan, (void)channel;
    return code / unit;
#endif
}

/* A code below which no sample is nearly saturated. */
static inline float near_white_code(const lensprof_plan *plan, float unit) {
#if LP_HAS_LEVELS
    (void)unit;
    return plan->levels.near_white;
#else
    (void)plan;
    return 0.89f * unit;
#endif
}

/* Gains of red, green and blue, in s->factor. Towards white they gradually approach the largest gain, as the
 * brightest channel nears saturation (from 0.9 on) and the darkest one follows (from 0.6 on), so that a clipped
 * cloud does not take on a bright colour. The strip's light still holds codes; channels are `pitch` apart, pixels
 * `step`. */
static void approach_white(const lensprof_plan *plan, strip *s, uint32_t count, uint32_t pitch, uint32_t step,
                           float unit) {
    for (uint32_t i = 0; i < count; i++) {
        const float *value = s->light + i * step;
#if LANES > 1
        const float near_white = near_white_code(plan, unit);
        if (!(value[0] > near_white) && !(value[pitch] > near_white) && !(value[2 * pitch] > near_white)) continue;
#endif
        float *gain = s->factor + i * step, brightest = 0.0f, darkest = 1.0f, largest = 0.0f;
        for (uint32_t c = 0; c < 3; c++) {
            float sample = value_of_code(plan, value[c * pitch], pitch > 1 ? c : plan->channel_of_sample[c], unit);
            if (sample > brightest) brightest = sample;
            if (!(sample > darkest)) darkest = sample;
            if (gain[c * pitch] > largest) largest = gain[c * pitch];
        }
        float t = ramp(brightest, 0.9f) * ramp(darkest, 0.6f);
        for (uint32_t c = 0; c < 3 && t > 0.0f; c++) gain[c * pitch] += t * (largest - gain[c * pitch]);
    }
}

/* ---- rows ---- */

/* 8 x 8 ordered dither (Bayer 1973), in 64ths. */
static const uint8_t dither_matrix[8][8] = {{0, 32, 8, 40, 2, 34, 10, 42},  {48, 16, 56, 24, 50, 18, 58, 26},
                                            {12, 44, 4, 36, 14, 46, 6, 38}, {60, 28, 52, 20, 62, 30, 54, 22},
                                            {3, 35, 11, 43, 1, 33, 9, 41},  {51, 19, 59, 27, 49, 17, 57, 25},
                                            {15, 47, 7, 39, 13, 45, 5, 37}, {63, 31, 55, 23, 61, 29, 53, 21}};

/* Strips begin at pixels of the row that are multiples of 8 away from its first. */
static void find_rounding(const lensprof_plan *plan, uint32_t x, uint32_t y, strip *s) {
    const uint32_t planes = plan->layout == LENSPROF_LAYOUT_PLANAR ? 3 : 1;
    for (uint32_t plane = 0; plane < planes; plane++)
        for (uint32_t i = 0; i < (planes == 3 ? STRIP + LANES : ROOM); i++)
            s->rounding[plane * (STRIP + LANES) + i] =
                ((float)dither_matrix[y & 7][(x + i / plan->samples) & 7] + 0.5f) * (1.0f / 64.0f);
}

/* ---- levels ---- */

#if LP_HAS_LEVELS
/* A plan's numbers of the channels of samples. */
ALWAYS_INLINE lane_f of_channels(const strip *s, const float *numbers, uint32_t at) {
    return f_gather(numbers, i_load(s->channel + at));
}

static void subtract_black(const lensprof_plan *plan, const run *r, strip *s) {
    for (uint32_t i = r->at; i < r->at + r->count; i += LANES)
        f_store(s->light + i, f_mul(f_sub(f_load(s->light + i), of_channels(s, plan->levels.black_in, i)),
                                    of_channels(s, plan->levels.per_span_in, i)));
}

static void add_black(const lensprof_plan *plan, const run *r, strip *s) {
    for (uint32_t i = r->at; i < r->at + r->count; i += LANES)
        f_store(s->light + i, f_add(f_mul(f_load(s->light + i), of_channels(s, plan->levels.span_out, i)),
                                    of_channels(s, plan->levels.black_out, i)));
}
#endif

static void decode(const lensprof_plan *plan, const run *r, strip *s) {
#if LP_HAS_LEVELS
    if (lp_level_steps(plan) & LP_LEVELS_IN) subtract_black(plan, r, s);
#endif
    switch (plan->decode) {
    case LP_CURVE_NONE: break;
    case LP_CURVE_CLIP: through_curve(plan, s, LP_CURVE_CLIP, 1, r->at, r->count); break;
    case LP_CURVE_TABLE:
        if (plan->inverse)
            codes_to_light(plan, s, r->at, r->count);
        else
            through_curve(plan, s, LP_CURVE_TABLE, 1, r->at, r->count);
        break;
    case LP_CURVE_POWER: through_curve(plan, s, LP_CURVE_POWER, 1, r->at, r->count); break;
    default: through_curve(plan, s, LP_CURVE_MIXED, 1, r->at, r->count); break;
    }
}

static void encode(const lensprof_plan *plan, const run *r, strip *s) {
    for (uint32_t i = r->at; i < r->at + r->count; i += LANES)
        f_store(s->light + i, f_mul(f_load(s->light + i), f_load(s->factor + i)));
    switch (plan->encode) {
    case LP_CURVE_NONE: break;
    case LP_CURVE_CLIP: through_curve(plan, s, LP_CURVE_CLIP, 0, r->at, r->count); break;
    case LP_CURVE_TABLE: through_curve(plan, s, LP_CURVE_TABLE, 0, r->at, r->count); break;
    case LP_CURVE_POWER: through_curve(plan, s, LP_CURVE_POWER, 0, r->at, r->count); break;
    default: through_curve(plan, s, LP_CURVE_MIXED, 0, r->at, r->count); break;
    }
#if LP_HAS_LEVELS
    if (lp_level_steps(plan) & LP_LEVELS_OUT) add_black(plan, r, s);
#endif
}

static void load_run(const lensprof_plan *plan, const run *r, strip *s) {
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8: load_codes(LENSPROF_SAMPLE_U8, r->from, r->count, s->light + r->at); break;
    case LENSPROF_SAMPLE_U16: load_codes(LENSPROF_SAMPLE_U16, r->from, r->count, s->light + r->at); break;
    case LENSPROF_SAMPLE_F16: load_codes(LENSPROF_SAMPLE_F16, r->from, r->count, s->light + r->at); break;
    default: load_codes(LENSPROF_SAMPLE_F32, r->from, r->count, s->light + r->at); break;
    }
}

static void store_run(const lensprof_plan *plan, const run *r, const strip *s) {
    switch (plan->target_sample) {
    case LENSPROF_SAMPLE_U8: store_samples(plan, LENSPROF_SAMPLE_U8, s, r->at, r->to, r->count); break;
    case LENSPROF_SAMPLE_U16: store_samples(plan, LENSPROF_SAMPLE_U16, s, r->at, r->to, r->count); break;
    case LENSPROF_SAMPLE_F16: store_samples(plan, LENSPROF_SAMPLE_F16, s, r->at, r->to, r->count); break;
    default: store_samples(plan, LENSPROF_SAMPLE_F32, s, r->at, r->to, r->count); break;
    }
}

#if LANES > 1
/* The usual cases in one pass, or by tables in stages: samples of one type in and out, through one curve in both
 * directions. The steps are those of load_run, decode, encode and store_run, and so are the bytes. */
ALWAYS_INLINE lane_f through(const lensprof_plan *plan, const strip *s, uint32_t sample, uint32_t curve, int has_levels,
                             uint32_t at, const uint8_t *from) {
    const int is_light = sample != LENSPROF_SAMPLE_F32; /* codes are */
    lane_f light;
    if (curve == LP_CURVE_TABLE)
        light = light_of_codes(plan, s, at, sample == LENSPROF_SAMPLE_U8 ? i_load_u8(from) : i_load_u16(from));
    else
        light = load_values(sample, from);
    (void)has_levels;
#if LP_HAS_LEVELS
    if (has_levels) { /* linear, and the spans are 1 */
        light = f_mul(f_sub(light, f_set(plan->levels.black_in[0])), f_load(s->factor + at));
        return f_add(light, f_set(plan->levels.black_out[0]));
    }
#endif
    if (curve == LP_CURVE_POWER) light = curve_value(plan, s, curve, 1, is_light, at, f_mul(light, code_scale(plan)));
    light = f_mul(light, f_load(s->factor + at));
    if (curve == LP_CURVE_TABLE) light = f_max(light, f_set(0.0f)); /* lanes past the run have any factor */
    return curve == LP_CURVE_NONE ? light : curve_value(plan, s, curve, 0, is_light, at, light);
}

ALWAYS_INLINE void one_pass(const lensprof_plan *shared, const run *r, const strip *s, uint32_t sample, uint32_t curve,
                            int has_levels) {
    lensprof_plan local_plan = *shared; /* which no store can change */
    const lensprof_plan *plan = &local_plan;
    const uint32_t bytes = sample == LENSPROF_SAMPLE_U8 ? 1 : sample == LENSPROF_SAMPLE_U16 ? 2 : 4;
    const int is_inside = sample != LENSPROF_SAMPLE_F32 && curve != LP_CURVE_NONE;
    uint32_t i = 0;
    local_plan.curves = 1, local_plan.dither = 0, local_plan.encode = curve;
    for (; i + LANES <= r->count; i += LANES) {
        if (FETCHES_TARGET || (CAN_STREAM && sample == LENSPROF_SAMPLE_F32)) fetch_ahead(r, i * bytes);
        const lane_f light = through(plan, s, sample, curve, has_levels, r->at + i, r->from + i * bytes);
        store_vector(plan, sample, is_inside, s, r->at + i, light, r->to + i * bytes);
    }
    if (i < r->count) {
        float buffer[2][LANES] = {{0.0f}, {0.0f}};
        uint8_t *in = (uint8_t *)buffer[0], *out = (uint8_t *)buffer[1];
        memcpy(in, r->from + i * bytes, (r->count - i) * bytes);
        const lane_f light = through(plan, s, sample, curve, has_levels, r->at + i, in);
        store_vector(plan, sample, is_inside, s, r->at + i, light, out);
        memcpy(r->to + i * bytes, out, (r->count - i) * bytes);
    }
}

#if LP_HAS_LEVELS
/* False if it is not the usual case of linear samples: black that all channels share, subtracted and added. */
static int do_one_pass_of_levels(const lensprof_plan *plan, const run *r, strip *s) {
    if (plan->decode != LP_CURVE_NONE || !plan->levels.are_one) return 0;
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8: one_pass(plan, r, s, LENSPROF_SAMPLE_U8, LP_CURVE_NONE, 1); return 1;
    case LENSPROF_SAMPLE_U16: one_pass(plan, r, s, LENSPROF_SAMPLE_U16, LP_CURVE_NONE, 1); return 1;
    case LENSPROF_SAMPLE_F32: one_pass(plan, r, s, LENSPROF_SAMPLE_F32, LP_CURVE_NONE, 1); return 1;
    default: return 0;
    }
}
#endif

/* False if it is not one of the usual cases. */
static int do_one_pass(const lensprof_plan *plan, const run *r, strip *s) {
    if (plan->source_sample != plan->target_sample || plan->decode != plan->encode || plan->dither
        || (plan->curves == 3 && plan->decode != LP_CURVE_NONE))
        return 0;
#if LP_HAS_LEVELS
    if (plan->levels.steps) return do_one_pass_of_levels(plan, r, s);
#endif
    switch (8 * plan->source_sample + plan->decode) {
    case 8 * LENSPROF_SAMPLE_U8 + LP_CURVE_NONE: one_pass(plan, r, s, LENSPROF_SAMPLE_U8, LP_CURVE_NONE, 0); return 1;
    case 8 * LENSPROF_SAMPLE_U16 + LP_CURVE_NONE: one_pass(plan, r, s, LENSPROF_SAMPLE_U16, LP_CURVE_NONE, 0); return 1;
    case 8 * LENSPROF_SAMPLE_U16 + LP_CURVE_POWER:
        one_pass(plan, r, s, LENSPROF_SAMPLE_U16, LP_CURVE_POWER, 0);
        return 1;
    case 8 * LENSPROF_SAMPLE_F32 + LP_CURVE_NONE: one_pass(plan, r, s, LENSPROF_SAMPLE_F32, LP_CURVE_NONE, 0); return 1;
#ifdef FAST_GATHERS
    case 8 * LENSPROF_SAMPLE_U8 + LP_CURVE_TABLE: one_pass(plan, r, s, LENSPROF_SAMPLE_U8, LP_CURVE_TABLE, 0); return 1;
    case 8 * LENSPROF_SAMPLE_U16 + LP_CURVE_TABLE:
        one_pass(plan, r, s, LENSPROF_SAMPLE_U16, LP_CURVE_TABLE, 0);
        return 1;
#else
    case 8 * LENSPROF_SAMPLE_U8 + LP_CURVE_TABLE:
    case 8 * LENSPROF_SAMPLE_U16 + LP_CURVE_TABLE:
#endif
    case 8 * LENSPROF_SAMPLE_F32 + LP_CURVE_TABLE:
        if (plan->step) return 0;
        through_tables(plan, r, s);
        return 1;
    default: return 0;
    }
}
#endif

/* The largest value; 0 if all are NaN. */
static float largest_value(const float *values, uint32_t count) {
    lane_f maxima = f_set(0.0f);
    float lanes[LANES], largest = 0.0f;
    uint32_t i = 0;
    for (; LANES > 1 && i + LANES <= count; i += LANES) maxima = f_max(f_load(values + i), maxima);
    f_store(lanes, maxima);
    for (; i < count; i++) largest = values[i] > largest ? values[i] : largest;
    for (i = 0; i < LANES; i++) largest = lanes[i] > largest ? lanes[i] : largest;
    return largest;
}

#if LANES > 1
/* That of red, green and blue alone: alpha is full in most pictures. Little-endian, as all processors with lanes. */
static float largest_colour(const lensprof_plan *plan, const run *r) {
    const uint16_t *codes = (const uint16_t *)(const void *)r->from;
    const float *values = (const float *)(const void *)r->from;
    const uint8_t *from = r->from;
    const uint32_t pixels = r->count / 4;
    float largest = 0.0f;
    uint32_t most = 0;
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8:
        for (uint32_t i = 0; i < pixels; i++) { /* alpha is the last byte; so written, compilers vectorise it */
            uint32_t pixel;
            memcpy(&pixel, from + 4 * i, sizeof pixel);
            const uint32_t a = pixel & 0xff, b = pixel >> 8 & 0xff, c = pixel >> 16 & 0xff;
            const uint32_t larger = a > b ? a : b, of_three = larger > c ? larger : c;
            most = of_three > most ? of_three : most;
        }
        return (float)most;
    case LENSPROF_SAMPLE_U16:
        for (uint32_t i = 0; i < r->count; i++) most = (i & 3) != 3 && codes[i] > most ? codes[i] : most;
        return (float)most;
    case LENSPROF_SAMPLE_F32:
        for (uint32_t i = 0; i < r->count; i++) largest = (i & 3) != 3 && values[i] > largest ? values[i] : largest;
        return largest;
    default: return 1.0f; /* halves, as below */
    }
}
#endif

/* The largest of the codes or values of a run; 0 if all are NaN. Written so that compilers vectorise it. */
static float largest_of(const lensprof_plan *plan, const run *r) {
    const uint16_t *codes = (const uint16_t *)(const void *)r->from;
    const float *values = (const float *)(const void *)r->from;
    uint8_t most8 = 0;
    uint16_t most16 = 0;
#if LANES > 1
    if (plan->samples > plan->channels) return largest_colour(plan, r);
#endif
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8:
        for (uint32_t i = 0; i < r->count; i++) most8 = r->from[i] > most8 ? r->from[i] : most8;
        return most8;
    case LENSPROF_SAMPLE_U16:
        for (uint32_t i = 0; i < r->count; i++) most16 = codes[i] > most16 ? codes[i] : most16;
        return most16;
    case LENSPROF_SAMPLE_F32: return largest_value(values, r->count);
    default: return 1.0f; /* halves are not scanned: treated as if white were present */
    }
}

#if CAN_STREAM
/* Bypasses a cache in whole lines: partial lines would be slower than not bypassing it. */
static void stream_copy(uint8_t *to, const uint8_t *from, size_t bytes) {
    size_t i = (size_t)(-(uintptr_t)to % 64);
    if (i > bytes) i = bytes;
    memcpy(to, from, i);
    for (; i + 64 <= bytes; i += 64) stream_line(to + i, from + i);
    memcpy(to + i, from + i, bytes - i);
}
#endif

/* A run whose codes are on the strip already (`is_loaded`) or not yet. */
static void do_run(const lensprof_plan *plan, const run *r, int is_loaded, strip *s) {
#if LANES > 1
    if (do_one_pass(plan, r, s)) return;
#endif
    if (!is_loaded) load_run(plan, r, s);
    decode(plan, r, s);
    encode(plan, r, s);
    store_run(plan, r, s);
}

/* A strip whose factors are known. */
static void do_strip(const lensprof_plan *plan, const run *runs, uint32_t planes, uint32_t count, strip *s,
                     int stream) {
    static const float units[] = {255.0f, 65535.0f, 1.0f, 1.0f};
    const float unit = units[plan->source_sample];
    const int has_alpha = plan->samples > plan->channels;
    int near_white = 0;
    if (has_alpha) take_alpha(plan, runs[0].from, count, s);
    for (uint32_t p = 0; p < planes && plan->neutral_white; p++)
        near_white |= largest_of(plan, &runs[p]) > near_white_code(plan, unit);
    for (uint32_t p = 0; p < planes && near_white; p++) load_run(plan, &runs[p], s);
    if (near_white)
        approach_white(plan, s, count, planes == 3 ? STRIP + LANES : 1, planes == 3 ? 1 : plan->samples, unit);
    for (uint32_t p = 0; p < planes; p++) {
        run r = runs[p];
#if CAN_STREAM
        ALIGNED_TO_VECTORS uint8_t buffer[4 * MOST_SAMPLES];
        if (stream) r.to = buffer;
#endif
        do_run(plan, &r, near_white, s);
#if CAN_STREAM
        if (stream) stream_copy(runs[p].to, buffer, r.count * lensprof_sample_type_bytes(plan->target_sample));
#endif
    }
    (void)stream;
    if (has_alpha) give_alpha(plan, s, runs[0].to, count);
}

void ROW_KERNEL(const lensprof_plan *plan, const uint8_t *const source[3], uint8_t *const target[3], uint32_t x,
                uint32_t y, uint32_t count, const uint32_t *inside, int stream) {
    const uint32_t planes = plan->layout == LENSPROF_LAYOUT_PLANAR ? 3 : 1;
    const uint32_t from_step = plan->samples * lensprof_sample_type_bytes(plan->source_sample);
    const uint32_t to_step = plan->samples * lensprof_sample_type_bytes(plan->target_sample);
    const float dy = (float)((int32_t)y - plan->center_px[1]) - plan->center_part[1];
    ALIGNED_TO_VECTORS strip s;
    if (plan->columns) blend_rows(plan, y, &s);
    if (plan->curves == 3 || lp_level_steps(plan)) find_channels(plan, x, y, &s);
    if (plan->dither) find_rounding(plan, x, y, &s);
#ifdef IN_TABLE
    s.is_guessed = count >= LEAST_GUESSED && is_guessable(plan);
    if (s.is_guessed) find_guess(plan, &s);
#endif
    for (uint32_t done = 0; done < count; done += STRIP) {
        const uint32_t n = count - done < STRIP ? count - done : STRIP;
        run runs[3];
        for (uint32_t c = 0; c < plan->gains; c++) gains_of_channel(plan, c, x + done, dy, n, &s);
        if (LP_HAS_CHROMA && plan->chroma) gains_of_colour(plan, n, &s);
        if (LP_HAS_CIRCLE && inside && (x + done < inside[0] || x + done + n > inside[1]))
            leave_outside(plan, inside, x + done, n, &s);
        spread_gains(plan, x + done, y, n, &s);
        for (uint32_t p = 0; p < planes; p++)
            runs[p] = (run){source[p] + (size_t)done * from_step, target[p] + (size_t)done * to_step,
                            p * (STRIP + LANES), n * plan->samples};
        do_strip(plan, runs, planes, n, &s, stream);
    }
#if CAN_STREAM
    if (stream) end_stream();
#endif
}
