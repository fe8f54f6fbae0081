/* Finds values among the response's samples by a guess that needs no memory access: 0..1 is divided into as many
 * cells as fit into a table in registers, and g is a parabola in each. Samples are loaded around the guess; if they
 * do not contain the value, the usual search follows. A guess therefore never changes a result. */

#define GUESS_CELLS (IN_TABLE * (1.0f - 1.2e-7f)) /* so that 1 is in the last cell */
#define LEAST_GUESSED 512                         /* pixels of a row: with fewer, parabolas do not pay off */

#ifndef COUNT_LOST
#define COUNT_LOST(lost, count) ((void)0) /* tests count the values of a run that are not found */
#endif

/* Float values through one table in both directions, as in values_to_light in tables.h. */
static int is_guessable(const lensprof_plan *plan) {
    return plan->source_sample == LENSPROF_SAMPLE_F32 && plan->target_sample == LENSPROF_SAMPLE_F32 && plan->curves == 1
           && !lp_level_steps(plan) && plan->decode == LP_CURVE_TABLE && plan->encode == LP_CURVE_TABLE
           && plan->step == 0;
}

/* Parabolas through g at both ends and in the middle of every cell: place = guess[0] + t (guess[1] + t guess[2]) for
 * t = b GUESS_CELLS, to the sample half a sample before g or the one before that. */
static void find_guess(const lensprof_plan *plan, strip *s) {
    const lane_f half = f_set(0.5f), last = f_set((float)LAST);
    for (uint32_t i = 0; i < IN_TABLE; i += LANES) {
        const lane_f t = f_of_i(i_add(i_count(), i_set((int32_t)i)));
        lane_f x[3];
        for (int n = 0; n < 3; n++) {
            const lane_f b = f_mul(f_add(t, f_mul(f_set((float)n), half)), f_set(1.0f / GUESS_CELLS));
            x[n] = f_mul(last, table_inverse(plan, f_min(b, f_set(1.0f)), i_set(0)));
        }
        const lane_f ends = f_add(x[0], x[2]), bend = f_sub(f_add(ends, ends), f_mul(f_set(4.0f), x[1]));
        const lane_f rise = f_sub(f_sub(x[2], x[0]), bend);
        f_store(s->guess[0] + i, f_sub(f_sub(x[0], half), f_mul(t, f_sub(rise, f_mul(t, bend)))));
        f_store(s->guess[1] + i, f_sub(rise, f_mul(f_add(t, t), bend)));
        f_store(s->guess[2] + i, bend);
    }
}

/* The guessed place of values; any place for values that are NaN or not within 0..1. */
ALWAYS_INLINE lane_i guess_place(const lane_table guess[3], lane_f value) {
    const lane_f t = f_mul(f_min(value, f_set(1.0f)), f_set(GUESS_CELLS));
    const lane_i cell = i_of_f(t);
    const lane_f slope = f_add(table_pick(guess[1], cell), f_mul(t, table_pick(guess[2], cell)));
    return i_least(i_of_f(f_add(table_pick(guess[0], cell), f_mul(t, slope))), i_set(LAST - 3));
}

/* g of values from the samples from the guessed place on, in at most two steps; `is_found` is 0 if a value is
 * elsewhere. NaN stays. */
ALWAYS_INLINE lane_f inverse_from(const float *samples, const int32_t *place, lane_f value, int *is_found) {
    const lane_f b = f_min(f_set(1.0f), value), low = f_of_i(i_load(place));
    const lane_b is_dark = f_less_equal(value, f_set(0.0f));
    lane_f four[4];
    f_fours(samples, place, four);
    *is_found = b_all(b_or(b_and(f_not_less_equal(b, four[0]), f_not_less(four[2], b)), is_dark));
    const lane_b is_second = f_less(four[1], b);
    const lane_f below = f_pick(is_second, four[1], four[0]), above = f_pick(is_second, four[2], four[1]);
    const lane_f on = f_pick(is_second, f_add(low, f_set(1.0f)), low);
    const lane_f share = f_div(f_sub(b, below), f_sub(above, below));
    return f_pick(is_dark, f_set(0.0f), f_mul(f_add(on, share), f_set(1.0f / (float)LAST)));
}

/* As table_inverse, but not inlined, to keep it out of the caller's registers. */
static NEVER_INLINE lane_f inverse_by_steps(const lensprof_plan *plan, lane_f value) {
    return f_pick(f_is_number(value), table_inverse(plan, cut(value, 0, 1.0f), i_set(0)), value);
}

/* Converts values to light. If too many were not found, the rest of the row is not guessed. */
static void values_by_guess(const lensprof_plan *plan, const run *r, strip *s) {
    const lane_table guess[3] = {table_load(s->guess[0]), table_load(s->guess[1]), table_load(s->guess[2])};
    const float *values = (const float *)(const void *)r->from;
    const float *samples = plan->backward;
    const uint32_t count = r->count;
    float *light = s->light + r->at;
    int32_t *place = s->place + r->at;
    uint32_t lost = 0;
    if (count % LANES) {
        load_codes(LENSPROF_SAMPLE_F32, r->from, count, light);
        values = light;
    }
    for (uint32_t i = 0; i < count; i += LANES) {
        fetch_ahead(r, i * sizeof *values); /* this stage loads the least */
        i_store(place + i, guess_place(guess, f_load(values + i)));
    }
    for (uint32_t i = 0; i < count; i += LANES) {
        const lane_f value = f_load(values + i);
        int is_found = 0;
        lane_f x = inverse_from(samples, place + i, value, &is_found);
        if (!is_found) x = inverse_by_steps(plan, value), lost += LANES;
        f_store(light + i, x);
    }
    COUNT_LOST(lost, count);
    s->is_guessed = lost <= count / 4;
}
