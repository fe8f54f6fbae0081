/* Samples of one type in and out, through one table in both directions, in stages of a whole run: table positions
 * are stored in memory, so that loads from them do not wait. The numbers are the same as in curves.h. */
#ifdef IN_TABLE
#include "core/kernels/guess.h"
#endif

/* Keeps the surrounding code scalar: gathers, which compilers use for vectors of indexed loads, are slower. */
#if defined(__GNUC__)
#define ONE_BY_ONE() __asm__ volatile("")
#else
#define ONE_BY_ONE() ((void)0)
#endif

/* Codes to light. */
ALWAYS_INLINE void codes_by_table(const lensprof_plan *plan, const run *r, strip *s, uint32_t sample) {
    const uint16_t *codes = (const uint16_t *)(const void *)r->from;
    const float *inverse = plan->inverse;
    float *light = s->light + r->at;
    uint32_t i = 0;
    for (; i + 4 <= r->count; i += 4)
        for (uint32_t n = i; n < i + 4; n++) {
            light[n] = inverse[sample == LENSPROF_SAMPLE_U8 ? r->from[n] : codes[n]];
            ONE_BY_ONE();
        }
    for (; i < r->count; i++) light[i] = inverse[sample == LENSPROF_SAMPLE_U8 ? r->from[i] : codes[i]];
    for (; i % LANES; i++) light[i] = 0.0f;
}

static void look_up(const uint16_t *restrict table, int32_t *restrict place, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        place[i] = table[place[i]];
        ONE_BY_ONE();
    }
}

/* Converts values to light if no steps are needed. */
static void values_by_table(const lensprof_plan *plan, const run *r, strip *s) {
    const uint16_t *start = plan->start;
    const float *samples = plan->backward;
    float *light = s->light + r->at;
    int32_t *place = s->place + r->at;
    load_codes(LENSPROF_SAMPLE_F32, r->from, r->count, light);
    for (uint32_t i = 0; i < r->count; i += LANES)
        i_store(place + i, cell_of(cut(f_load(light + i), 0, 1.0f), i_set(0)));
    look_up(start, place, (r->count + LANES - 1) / LANES * LANES);
    for (uint32_t i = 0; i < r->count; i += LANES) {
        const lane_f value = f_load(light + i);
        lane_f four[4];
        f_fours(samples, place + i, four);
        const lane_f x = between_four(four, i_load(place + i), cut(value, 0, 1.0f));
        f_store(light + i, f_pick(f_is_number(value), x, value));
    }
}

/* Light times gain to samples. First finds each position in the table: the sample before it and the fraction of the
 * way to the next; then reads the table. A fraction of NaN stays NaN. */
ALWAYS_INLINE void light_by_table(const lensprof_plan *shared, const run *r, strip *s, uint32_t sample) {
    lensprof_plan local_plan = *shared; /* which no store can change */
    const lensprof_plan *plan = &local_plan;
    const uint32_t bytes = sample == LENSPROF_SAMPLE_U8 ? 1 : sample == LENSPROF_SAMPLE_U16 ? 2 : 4;
    const int is_light = sample != LENSPROF_SAMPLE_F32; /* codes are */
    const lane_f last_index = f_set((float)LAST);
    float *light = s->light + r->at, last[LANES] = {0.0f};
    int32_t *place = s->place + r->at;
    local_plan.dither = 0, local_plan.encode = LP_CURVE_TABLE;
    for (uint32_t i = 0; i < r->count; i += LANES) {
        const lane_f x = f_mul(f_load(light + i), f_load(s->factor + r->at + i));
        const lane_f position = f_min(last_index, is_light ? x : f_max(f_set(0.0f), x));
        const lane_i j = i_least(i_of_f(position), i_set(LAST));
        f_store(light + i, f_sub(position, f_of_i(j)));
        i_store(place + i, j);
    }
    for (uint32_t i = 0; i < r->count; i += LANES) {
        lane_f low, high;
        f_pairs(plan->forward, place + i, &low, &high);
        const lane_f y = f_add(low, f_mul(f_load(light + i), f_sub(high, low)));
        uint8_t *to = i + LANES <= r->count ? r->to + i * bytes : (uint8_t *)last;
        store_vector(plan, sample, is_light, s, r->at + i, y, to);
    }
    const uint32_t rest = r->count % LANES;
    memcpy(r->to + (r->count - rest) * bytes, last, rest * bytes);
}

static void values_to_light(const lensprof_plan *plan, const run *r, strip *s) {
#ifdef IN_TABLE
    if (s->is_guessed) {
        values_by_guess(plan, r, s);
        return;
    }
#endif
    values_by_table(plan, r, s);
}

static void through_tables(const lensprof_plan *plan, const run *r, strip *s) {
    switch (plan->source_sample) {
    case LENSPROF_SAMPLE_U8:
        codes_by_table(plan, r, s, LENSPROF_SAMPLE_U8);
        light_by_table(plan, r, s, LENSPROF_SAMPLE_U8);
        break;
    case LENSPROF_SAMPLE_U16:
        codes_by_table(plan, r, s, LENSPROF_SAMPLE_U16);
        light_by_table(plan, r, s, LENSPROF_SAMPLE_U16);
        break;
    default: values_to_light(plan, r, s); light_by_table(plan, r, s, LENSPROF_SAMPLE_F32);
    }
}
