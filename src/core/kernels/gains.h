/* Gains of the pixels of a strip, and of their samples. */

/* The gain grid's nodes, interpolated to a row. They hold the attenuation less 1, which is small, so that single
 * precision loses less. */
static void blend_rows(const lensprof_plan *plan, uint32_t y, strip *s) {
    uint32_t last = plan->rows - 1, pixels = plan->frame_height > 1 ? plan->frame_height - 1 : 1;
    uint32_t position = y * last, node = position / pixels;
    if (node >= last) node = last - 1;
    float v = (float)(position - node * pixels) / (float)pixels;
    for (uint32_t c = 0; c < plan->gains; c++) {
        const float *above = plan->nodes[c] + node * plan->columns, *below = above + plan->columns;
        for (uint32_t i = 0; i < plan->columns; i++) s->grid[c][i] = above[i] + v * (below[i] - above[i]);
    }
}

/* Writes the grid's values at pixels of the row to `values`. */
static void grid_values(const lensprof_plan *plan, const float *nodes, uint32_t x, uint32_t count, float *values) {
    uint32_t last = plan->columns - 1, pixels = plan->frame_width > 1 ? plan->frame_width - 1 : 1;
    uint32_t node = x * last / pixels, rest = x * last - node * pixels;
    float per_pixel = (float)pixels;
    for (uint32_t i = 0; i < count; i++) {
        if (node < last)
            values[i] = nodes[node] + (float)rest / per_pixel * (nodes[node + 1] - nodes[node]);
        else
            values[i] = nodes[last];
        for (rest += last; rest >= pixels; rest -= pixels) node++;
    }
}

/* factor / M of channel c for pixels of the row (or M / factor, to simulate), to s->gain[c]; with chroma M itself. */
static void gains_of_channel(const lensprof_plan *plan, uint32_t c, uint32_t x, float dy, uint32_t count, strip *s) {
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
        f_store(gain + i, LP_HAS_CHROMA && plan->chroma ? f_add(one, off)
                          : plan->simulate              ? f_div(m, factor)
                                                        : f_div(factor, m));
    }
}

/* With chroma: the gains of all channels from their M, relative to that of luminance (weights of ITU-R BT.709). */
static void gains_of_colour(const lensprof_plan *plan, uint32_t count, strip *s) {
    const lane_f red = f_set(0.2126f), green = f_set(0.7152f), blue = f_set(0.0722f), least = f_set(plan->least);
    for (uint32_t i = 0; i < count; i += LANES) {
        const lane_f bright = f_add(f_mul(red, f_load(s->gain[0] + i)), f_mul(green, f_load(s->gain[1] + i)));
        const lane_f luminance = f_add(bright, f_mul(blue, f_load(s->gain[2] + i)));
        for (uint32_t c = 0; c < LP_CHANNELS; c++) {
            const lane_f factor = f_set(plan->factor[c]);
            const lane_f m = f_max(f_div(f_load(s->gain[c] + i), luminance), least);
            f_store(s->gain[c] + i, plan->simulate ? f_div(m, factor) : f_div(factor, m));
        }
    }
}

/* Outside of the columns inside[0]..inside[1] - 1 of the frame M is 1. */
static void leave_outside(const lensprof_plan *plan, const uint32_t *inside, uint32_t x, uint32_t count, strip *s) {
    for (uint32_t c = 0; c < plan->gains; c++) {
        const float gain = plan->simulate ? 1.0f / plan->factor[c] : plan->factor[c];
        for (uint32_t i = 0; i < count; i++)
            if (x + i < inside[0] || x + i >= inside[1]) s->gain[c][i] = gain;
    }
}

/* Copies the gains of `count` pixels to their samples. */
static void spread_gains(const lensprof_plan *plan, uint32_t x, uint32_t y, uint32_t count, strip *s) {
    const float *gain[LP_CHANNELS];
    for (uint32_t c = 0; c < LP_CHANNELS; c++) gain[c] = s->gain[plan->gains == 3 ? c : 0];
    if (plan->layout == LENSPROF_LAYOUT_PLANAR) {
        for (uint32_t c = 0; c < LP_CHANNELS; c++)
            for (uint32_t i = 0; i < count; i++) s->factor[c * (STRIP + LANES) + i] = gain[c][i] * plan->times[c];
    } else if (plan->samples == 1) { /* grey and mosaics */
        const float *site_gain[2];
        float times[2];
        for (uint32_t parity = 0; parity < 2; parity++) {
            const uint32_t c = plan->site[y & 1][(x + parity) & 1];
            site_gain[parity] = gain[c], times[parity] = plan->times[c];
        }
        for (uint32_t i = 0; i < count; i++) s->factor[i] = site_gain[i & 1][i] * times[i & 1];
    } else if (plan->samples == 3) {
        const uint8_t *channel = plan->channel_of_sample;
        const lane_f times[3] = {f_set(plan->times[channel[0]]), f_set(plan->times[channel[1]]),
                                 f_set(plan->times[channel[2]])};
        for (uint32_t i = 0; i < count; i += LANES)
            f_store3(s->factor + 3 * i, f_mul(f_load(gain[channel[0]] + i), times[0]),
                     f_mul(f_load(gain[channel[1]] + i), times[1]), f_mul(f_load(gain[channel[2]] + i), times[2]));
#if LANES > 1
    } else if (plan->samples == 4) { /* the last one is alpha */
        const uint8_t *channel = plan->channel_of_sample;
        const float *a = gain[channel[0]], *b = gain[channel[1]], *c = gain[channel[2]];
        const float at = plan->times[channel[0]], bt = plan->times[channel[1]], ct = plan->times[channel[2]];
        for (uint32_t i = 0; i < count; i++) {
            float *factor = s->factor + 4 * i;
            factor[0] = a[i] * at, factor[1] = b[i] * bt, factor[2] = c[i] * ct, factor[3] = 1.0f;
        }
#endif
    } else {
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t n = 0; n < plan->samples; n++) {
                uint32_t c = plan->channel_of_sample[n];
                s->factor[plan->samples * i + n] = c == LP_ALPHA ? 1.0f : gain[c][i] * plan->times[c];
            }
    }
}

/* The curve of every sample of a strip; strips begin at even pixels of the row. */
static void find_channels(const lensprof_plan *plan, uint32_t x, uint32_t y, strip *s) {
    for (uint32_t i = 0; i < ROOM; i++) {
        uint32_t c = plan->channel_of_sample[i % plan->samples];
        if (plan->layout == LENSPROF_LAYOUT_PLANAR)
            c = i / (STRIP + LANES);
        else if (plan->samples == 1)
            c = plan->site[y & 1][(x + i) & 1];
        s->channel[i] = (int32_t)(c == LP_ALPHA ? 1 : c);
    }
}
