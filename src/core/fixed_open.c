/* Integer plans that were made elsewhere. The contents of a plan are not trusted: whatever its bytes are, a plan
 * that opens is applied without reading or writing beyond it and the pixels, and without overflow. */
#include <string.h>

#include "core/fixed_plan.h"
#include "core/gain_grid.h"
#include "core/response.h"

#define LARGEST_FACTOR (51 << LP_LOG_SHIFT) /* options allow 1e12, levels 1e3, and their inverses */
#define LARGEST_LEVEL (1 << 24)             /* 65535 in the units of levels, rounded up */

uint32_t lp_fixed_check(const lensprof_fixed_plan *plan) {
    const size_t before = offsetof(lensprof_fixed_plan, check) + sizeof plan->check;
    return lp_crc32((const uint8_t *)plan + before, plan->bytes - before);
}

static int is_one_or_three(uint32_t count) { return count == 1 || count == 3; }

/* Whether the fields that follow from the layout are consistent with it. */
static int is_layout_sound(const lensprof_fixed_plan *plan) {
    uint8_t channel_of_sample[4], site[2][2] = {{0, 0}, {0, 0}};
    const uint32_t samples = lensprof_layout_samples(plan->layout);
    if (!samples || plan->layout == LENSPROF_LAYOUT_PLANAR || plan->sample > LENSPROF_SAMPLE_U16) return 0;
    if (LP_HAS_WIDE_CURVES ? plan->target > LENSPROF_SAMPLE_U16 : plan->target != plan->sample) return 0;
    lp_layout_sites(plan->layout, channel_of_sample, site);
    return plan->samples == samples && plan->channels == lensprof_layout_channels(plan->layout)
           && !memcmp(plan->channel_of_sample, channel_of_sample, sizeof channel_of_sample)
           && !memcmp(plan->site, site, sizeof site) && plan->simulate <= 1
           && plan->neutral_white <= (samples >= 3 ? 1u : 0u);
}

/* t stays below 2^31 anywhere in the frame: its centre and size against the power of 2 that r^2 counts in. */
static int is_reach_sound(const lensprof_fixed_plan *plan) {
    const uint32_t size[2] = {plan->frame_width, plan->frame_height};
    uint64_t r2 = 0;
    for (int d = 0; d < 2; d++) {
        if (!size[d] || size[d] > LP_LARGEST_SIDE || plan->center[d] <= -(1 << 30)) return 0;
        const int64_t before = plan->center[d], after = ((int64_t)(size[d] - 1) << LP_CENTER_SHIFT) - before;
        const uint64_t reach = (uint64_t)(before > after ? before : after);
        r2 += reach * reach;
    }
    return plan->reach_shift < 44 && !(r2 >> (63 - plan->reach_shift));
}

static uint32_t size_of(int32_t value) { return value < 0 ? 0u - (uint32_t)value : (uint32_t)value; }

/* The largest node, or 1 in the grid's units if there is no grid; 0 if the grid is wrong. */
static uint32_t largest_node(const lensprof_fixed_plan *plan) {
    const lp_fixed_grid *grid = &plan->grid;
    const uint32_t sides[2] = {plan->frame_width, plan->frame_height}, nodes[2] = {grid->columns, grid->rows};
    if (!grid->columns) return grid->rows || grid->channels ? 0 : 1u << grid->shift;
    if (!LP_HAS_FIXED_GRID || !lp_is_grid_side(grid->columns) || !lp_is_grid_side(grid->rows)
        || !is_one_or_three(grid->channels))
        return 0;
    if (grid->strength > 1u << LP_STRENGTH_SHIFT || sides[0] > LP_SENSOR_LARGEST_SIDE
        || sides[1] > LP_SENSOR_LARGEST_SIDE)
        return 0;
    for (int d = 0; d < 2; d++) {
        const lp_sensor_axis axis = lp_fixed_grid_axis(sides[d], nodes[d]);
        if (memcmp(&axis, &grid->axis[d], sizeof axis)) return 0;
    }
    const uint32_t count = lp_fixed_nodes(plan);
    if (plan->bytes < sizeof *plan + count * 4) return 0;
    const uint32_t *node = (const uint32_t *)(const void *)plan + plan->bytes / 4 - count;
    uint32_t largest = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!node[i] || node[i] > LP_SENSOR_LARGEST_NODE) return 0;
        if (node[i] > largest) largest = node[i];
    }
    return largest;
}

/* Sums of the falloff's terms fit into 31 bits, also times the grid, and so do those of gains and light. */
static int are_gains_sound(const lensprof_fixed_plan *plan) {
    if (plan->grid.shift > LP_SENSOR_LARGEST_SHIFT) return 0;
    const uint32_t node = largest_node(plan);
    if (!node) return 0;
    if (!is_one_or_three(plan->falloffs) || !is_one_or_three(plan->gains)) return 0;
    if (plan->falloff_shift > 30 || plan->least <= 0 || plan->least > 1 << plan->falloff_shift) return 0;
    for (uint32_t c = 0; c < LP_CHANNELS; c++) {
        uint64_t sum = (1u << plan->falloff_shift) + 3u; /* each product rounds down */
        for (int n = 0; n < 3; n++) sum += size_of(plan->k[c][n]);
        if (sum > INT32_MAX || (sum * node >> plan->grid.shift) > INT32_MAX
            || size_of(plan->factor[c]) > LARGEST_FACTOR)
            return 0;
    }
    return 1;
}

/* Differences of codes and black fit into 25 bits. */
static int are_levels_sound(const lensprof_fixed_plan *plan) {
    if (plan->levels > LP_HAS_LEVELS) return 0;
    if (plan->largest < 0 || plan->largest > (lp_fixed_target(plan) == LENSPROF_SAMPLE_U8 ? 255 : 65535)) return 0;
    for (uint32_t c = 0; c < LP_CHANNELS; c++) {
        const int32_t in = plan->black_in[c], out = plan->black_out[c];
        if (in > LARGEST_LEVEL || out > LARGEST_LEVEL || in < -LARGEST_LEVEL / 2 || out < -LARGEST_LEVEL / 2) return 0;
    }
    return 1;
}

#if LP_HAS_WIDE_CURVES
/* Samples that rise, between the codes. */
static int are_samples_sound(const int32_t *samples) {
    if (samples[0] < -(1 << 29) || samples[LP_CURVE_LAST] > 1 << 30) return 0;
    for (uint32_t j = 0; j < LP_CURVE_LAST; j++)
        if (samples[j + 1] < samples[j]) return 0;
    return 1;
}

/* Logarithms stay below 2^31 with any gain; samples lie within the plan. */
static int are_curves_sound(const lensprof_fixed_plan *plan) {
    const lp_fixed_curve *curves = (const lp_fixed_curve *)(const void *)(plan + 1);
    const uint32_t count = plan->decode_curves + plan->encode_curves, first = count * (sizeof *curves / 4);
    const uint32_t words = (plan->bytes - (uint32_t)sizeof *plan) / 4 - lp_fixed_nodes(plan);
    if (words < first || (words - first) % LENSPROF_RESPONSE_SAMPLES) return 0;
    for (const lp_fixed_curve *c = curves; c < curves + count; c++) {
        if (c->log_one < 0 || c->log_one > 32 << LP_LOG_SHIFT || (c->most && c->most != LP_LOG_MOST)) return 0;
        if (c->exponent > 10u << LP_EXPONENT_SHIFT) return 0;
        if (!c->samples && (!c->one || c->one > LARGEST_LEVEL + LARGEST_LEVEL / 2)) return 0;
        if (!c->samples) continue;
        if (c->samples < first || c->samples > words || words - c->samples < LENSPROF_RESPONSE_SAMPLES) return 0;
        if (c->one != (uint32_t)LP_CURVE_LAST << LP_PLACE_SHIFT) return 0;
        if (!are_samples_sound((const int32_t *)(const void *)(plan + 1) + c->samples)) return 0;
    }
    return 1;
}
#endif

static int are_tables_sound(const lensprof_fixed_plan *plan) {
    const uint32_t decode = plan->decode_curves, encode = plan->encode_curves;
    const int32_t *table = (const int32_t *)(const void *)(plan + 1);
    const int is_coded = lp_fixed_is_8_bit(plan);
    const int is_linear = !decode && !encode && (!is_coded || plan->levels);
    if (!is_linear && !((is_coded || LP_HAS_WIDE_CURVES) && is_one_or_three(decode) && is_one_or_three(encode)))
        return 0;
#if LP_HAS_WIDE_CURVES
    if (lp_fixed_is_wide(plan)) return are_curves_sound(plan);
#endif
    if (plan->bytes != sizeof *plan + ((decode + encode) * LP_CODES + lp_fixed_nodes(plan)) * sizeof *table) return 0;
    for (uint32_t i = 0; i < decode * LP_CODES; i++)
        if (size_of(table[i]) > size_of(LP_LOG_NONE)) return 0;
    return 1;
}

lensprof_status lensprof_fixed_plan_open(const void *data, size_t size, const lensprof_fixed_plan **result) {
    const lensprof_fixed_plan *plan = data;
    if (!data || !result || (uintptr_t)data % 4) return LENSPROF_ERROR_ARGUMENT;
    if (size < sizeof *plan) return LENSPROF_ERROR_CAPACITY;
    if ((plan->magic ^ LP_FIXED_MAGIC) & 0xffffffu) return LENSPROF_ERROR_CORRUPT;
    if (plan->magic != LP_FIXED_MAGIC) return LENSPROF_ERROR_LAYOUT;
    if (plan->bytes > size) return LENSPROF_ERROR_CAPACITY;
    if (plan->bytes < sizeof *plan || plan->bytes % 4 || plan->check != lp_fixed_check(plan))
        return LENSPROF_ERROR_CORRUPT;
    if (!is_layout_sound(plan) || !is_reach_sound(plan) || !are_gains_sound(plan) || !are_levels_sound(plan)
        || !are_tables_sound(plan))
        return LENSPROF_ERROR_CORRUPT;
    *result = plan;
    return LENSPROF_OK;
}
