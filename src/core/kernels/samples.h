/* Converts samples in memory to numbers on the strip, and back. */

/* Half precision (IEEE binary16), exactly. */
static inline float float_of_half(uint16_t h) {
    uint32_t sign = (uint32_t)(h & 0x8000u) << 16, exponent = (h >> 10) & 31u, mantissa = h & 0x3ffu, bits;
    float f;
    if (exponent == 0) {
        f = (float)mantissa * 5.9604644775390625e-8f; /* 2^-24 */
        return sign ? -f : f;
    }
    if (exponent == 31)
        bits = sign | 0x7f800000u | mantissa << 13 | (mantissa ? 0x400000u : 0u);
    else
        bits = sign | (exponent + 112u) << 23 | mantissa << 13;
    memcpy(&f, &bits, sizeof f);
    return f;
}

/* Rounds to nearest, ties to even; infinity beyond the range. */
static inline uint16_t half_of_float(float f) {
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
ALWAYS_INLINE lane_f load_values(uint32_t sample, const uint8_t *p) {
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

ALWAYS_INLINE void load_codes(uint32_t sample, const uint8_t *from, uint32_t count, float *light) {
    const uint32_t bytes = lensprof_sample_type_bytes(sample), in_vectors = count - count % LANES;
    for (uint32_t i = 0; i < in_vectors; i += LANES) {
        f_store(light + i, load_values(sample, from + i * bytes));
    }
    if (in_vectors < count) {
        float buffer[LANES] = {0.0f};
        uint8_t *last = (uint8_t *)buffer;
        memcpy(last, from + in_vectors * bytes, (count - in_vectors) * bytes);
        f_store(light + in_vectors, load_values(sample, last));
    }
}

/* Light of codes from the table of all codes. */
ALWAYS_INLINE lane_f light_of_codes(const lensprof_plan *plan, const strip *s, uint32_t at, lane_i code) {
    if (plan->curves == 3) {
        const lane_i channel = i_load(s->channel + at);
        code = i_add(code, plan->inverse_shift == 8 ? i_left(channel, 8) : i_left(channel, 16));
    }
    return f_gather(plan->inverse, code);
}

static void codes_to_light(const lensprof_plan *plan, strip *s, uint32_t at, uint32_t count) {
    for (uint32_t i = at; i < at + count; i += LANES)
        f_store(s->light + i, light_of_codes(plan, s, i, i_of_f(f_load(s->light + i))));
}

/* ---- light to samples ---- */

/* Integer output is clipped at white. */
static inline float largest_code(const lensprof_plan *plan, float unit) {
#if LP_HAS_LEVELS
    (void)unit;
    return plan->levels.largest_code;
#else
    (void)plan;
    return unit;
#endif
}

/* Stores one vector as samples at p. `at`: its place on the strip. `is_inside`: all within black and white. */
ALWAYS_INLINE void store_vector(const lensprof_plan *plan, uint32_t sample, int is_inside, const strip *s, uint32_t at,
                                lane_f light, uint8_t *p) {
    if (sample == LENSPROF_SAMPLE_F32) {
        f_store((float *)(void *)p, light);
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
    const lane_f codes = plan->encode == LP_CURVE_NONE ? light : f_mul(light, f_set(unit));
    const lane_f half = plan->dither ? f_load(s->rounding + at) : f_set(0.5f);
    const lane_f up = f_add(is_inside ? codes : f_max(codes, f_set(0.0f)), half);
    const lane_i code = i_of_f(is_inside ? up : f_min(up, f_set(largest_code(plan, unit) + 0.5f)));
    if (sample == LENSPROF_SAMPLE_U8)
        i_store_u8(p, code);
    else
        i_store_u16(p, code);
}

ALWAYS_INLINE void store_samples(const lensprof_plan *plan, uint32_t sample, const strip *s, uint32_t at, uint8_t *to,
                                 uint32_t count) {
    const uint32_t bytes = lensprof_sample_type_bytes(sample);
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES)
        store_vector(plan, sample, 0, s, at + i, f_load(s->light + at + i), to + i * bytes);
    if (i < count) {
        float buffer[LANES];
        uint8_t *last = (uint8_t *)buffer;
        store_vector(plan, sample, 0, s, at + i, f_load(s->light + at + i), last);
        memcpy(to + i * bytes, last, (count - i) * bytes);
    }
}

/* ---- alpha ---- */

static void take_alpha(const lensprof_plan *plan, const uint8_t *from, uint32_t count, strip *s) {
    const uint32_t bytes = lensprof_sample_type_bytes(plan->source_sample);
#if LANES > 1
    if (bytes == 1 && plan->samples == 4) {
        for (uint32_t i = 0; i < count; i++) s->alpha[i][0] = from[4 * i + 3];
        return;
    }
#endif
    for (uint32_t i = 0; i < count; i++) memcpy(s->alpha[i], from + ((i + 1) * plan->samples - 1) * bytes, bytes);
}

/* A value 0..1 as one sample. */
static void put_value(uint32_t sample, float value, uint8_t *p) {
    const float inside = value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f;
    const uint16_t half = half_of_float(value), code = (uint16_t)(inside * 65535.0f + 0.5f);
    switch (sample) {
    case LENSPROF_SAMPLE_U8: *p = (uint8_t)(inside * 255.0f + 0.5f); break;
    case LENSPROF_SAMPLE_U16: memcpy(p, &code, sizeof code); break;
    case LENSPROF_SAMPLE_F16: memcpy(p, &half, sizeof half); break;
    default: memcpy(p, &value, sizeof value); break;
    }
}

static float get_value(uint32_t sample, const uint8_t *p) {
    uint16_t word;
    float value;
    memcpy(&word, p, sizeof word);
    memcpy(&value, p, sizeof value);
    return sample == LENSPROF_SAMPLE_U8    ? (float)*p / 255.0f
           : sample == LENSPROF_SAMPLE_U16 ? (float)word / 65535.0f
           : sample == LENSPROF_SAMPLE_F16 ? float_of_half(word)
                                           : value;
}

/* Unchanged, converted if the types differ. */
static void give_alpha(const lensprof_plan *plan, const strip *s, uint8_t *to, uint32_t count) {
    const uint32_t bytes = lensprof_sample_type_bytes(plan->target_sample);
#if LANES > 1
    if (bytes == 1 && plan->samples == 4 && plan->source_sample == plan->target_sample) {
        for (uint32_t i = 0; i < count; i++) to[4 * i + 3] = s->alpha[i][0];
        return;
    }
#endif
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *p = to + ((i + 1) * plan->samples - 1) * bytes;
        if (plan->source_sample == plan->target_sample)
            memcpy(p, s->alpha[i], bytes);
        else
            put_value(plan->target_sample, get_value(plan->source_sample, s->alpha[i]), p);
    }
}
