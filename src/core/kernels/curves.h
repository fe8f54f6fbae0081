/* Responses and their inverses, for lanes. */

/* x^e for 0 <= x <= 1, e > 0: 2^(e log2 x). log2 by the series of atanh, 2^ by a polynomial; relative error below 2e-6
 * where the result is above 1e-3. */
ALWAYS_INLINE lane_f power(lane_f x, lane_f e) {
    const lane_i bits = i_of_bits(f_max(x, f_set(1e-37f)));
    const lane_i shifted = i_sub(bits, i_set(0x3f3504f3)); /* square root of 1/2: m is around 1 */
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

/* Clamps to 0..most; 0 for NaN. `is_light`: numbers not below 0. */
ALWAYS_INLINE lane_f cut(lane_f x, int is_light, float limit) {
    return f_min(is_light ? x : f_max(x, f_set(0.0f)), f_set(limit));
}

/* f(position / LAST) from its samples, 0 <= position <= LAST. One extra number follows them. */
ALWAYS_INLINE lane_f table_at(const float *samples, lane_f position, lane_i channel) {
    const lane_i first = i_left(channel, LP_FORWARD_SHIFT);
    const lane_i j = i_of_f(position);
    lane_f low, high;
    f_gather_pair(samples, i_add(j, first), &low, &high);
    return f_add(low, f_mul(f_sub(position, f_of_i(j)), f_sub(high, low)));
}

/* The cell of b in plan->start, for a channel; 0 <= b <= 1. */
ALWAYS_INLINE lane_i cell_of(lane_f b, lane_i channel) {
    const lane_i cell = i_of_f(f_mul(b, f_set((float)LP_CELLS)));
    return i_add(i_add(cell, i_left(channel, LP_CELL_SHIFT)), channel); /* a table is one longer than cells */
}

/* g(b) from the four samples of f at place `low` and after, one of which is the last below b: the smallest x with
 * f(x) >= b. */
ALWAYS_INLINE lane_f between_four(const lane_f four[4], lane_i low, lane_f b) {
    const lane_b is_second = f_less(four[1], b), is_third = f_less(four[2], b);
    const lane_f below = f_pick(is_third, four[2], f_pick(is_second, four[1], four[0]));
    const lane_f above = f_pick(is_third, four[3], f_pick(is_second, four[2], four[1]));
    const lane_f on = f_pick(is_third, f_set(2.0f), f_pick(is_second, f_set(1.0f), f_set(0.0f)));
    const lane_f rise = f_sub(above, below);
    const lane_f share = f_div(f_sub(b, below), f_pick(f_less(f_set(0.0f), rise), rise, f_set(1.0f)));
    const lane_f x = f_mul(f_add(f_add(f_of_i(low), on), share), f_set(1.0f / (float)LAST));
    return f_pick(f_less(f_set(0.0f), b), x, f_set(0.0f));
}

/* g(b) from the samples of f, 0 <= b <= 1. */
ONCE_IN_SCALAR lane_f table_inverse(const lensprof_plan *plan, lane_f b, lane_i channel) {
    const float *samples = plan->backward;
    const lane_i first = i_left(channel, LP_FORWARD_SHIFT);
    int32_t index[LANES];
    lane_f four[4];
    i_store(index, cell_of(b, channel));
    for (uint32_t i = 0; i < LANES; i++) index[i] = plan->start[index[i]];
    lane_i low = i_load(index);
    for (int32_t step = plan->step; step > 0; step /= 2) {
        const lane_i next = i_min(i_add(low, i_set(step)), i_set(LAST - 3));
        low = i_pick(f_less(f_gather(samples, i_add(next, first)), b), next, low);
    }
    i_store(index, i_add(low, first));
    f_fours(samples, index, four);
    return between_four(four, low, b);
}

/* The value of a curve; NaN stays. `at`: index into s->channel. `is_light`: x are numbers not below 0. For codes
 * from a table, x is a position in the table. */
ALWAYS_INLINE lane_f curve_value(const lensprof_plan *plan, const strip *s, uint32_t curve, int inverse, int is_light,
                                 uint32_t at, lane_f x) {
    const float *exponents = inverse ? plan->inverse_exponent : plan->exponent;
    const int is_position = !inverse && curve == LP_CURVE_TABLE;
    const lane_f inside = cut(x, is_light, is_position ? (float)LAST : 1.0f);
    lane_f y = inside, e = f_set(exponents[0]);
    lane_i channel = i_set(0);
    if (plan->curves == 3) channel = i_load(s->channel + at), e = f_gather(exponents, channel);
    if (is_position)
        y = table_at(plan->forward, inside, channel);
    else if (inverse && (curve == LP_CURVE_TABLE || curve == LP_CURVE_MIXED))
        y = table_inverse(plan, inside, channel);
    else if (curve == LP_CURVE_MIXED)
        y = table_at(plan->forward, f_mul(inside, f_set((float)LAST)), channel);
    if (curve == LP_CURVE_POWER) y = power(inside, e);
    if (curve == LP_CURVE_MIXED) y = f_pick(f_less(f_set(0.0f), e), power(inside, e), y);
    return is_light ? y : f_pick(f_is_number(x), y, x);
}

/* Converts 16-bit codes to values for evaluation by a formula. */
ALWAYS_INLINE lane_f code_scale(const lensprof_plan *plan) {
    return f_set(plan->source_sample == LENSPROF_SAMPLE_U16 ? 1.0f / 65535.0f : 1.0f);
}

/* Passes the samples of a strip's light, in place, through a curve; codes of 16 bit are converted to values first. */
ALWAYS_INLINE void through_curve(const lensprof_plan *plan, strip *s, uint32_t curve, int inverse, uint32_t at,
                                 uint32_t count) {
    const lane_f scale = inverse ? code_scale(plan) : f_set(1.0f);
    for (uint32_t i = at; i < at + count; i += LANES)
        f_store(s->light + i, curve_value(plan, s, curve, inverse, 0, i, f_mul(f_load(s->light + i), scale)));
}
