/* Sensor plans that were made elsewhere, and plans between two. The contents of a plan are not trusted: whatever its
 * bytes are, a plan that opens is applied without reading or writing beyond it and the samples, and without overflow.
 */
#include <string.h>

#include "core/blob.h"
#include "core/sensor.h"

#define LARGEST_LEVEL (65535 << LP_SENSOR_LEVEL_SHIFT)

uint32_t lp_sensor_check(const lensprof_sensor_plan *plan) {
    const size_t before = offsetof(lensprof_sensor_plan, check) + sizeof plan->check;
    return lp_crc32((const uint8_t *)plan + before, plan->bytes - before);
}

static int is_pattern_sound(const lp_sensor_grid *grid) {
    if (grid->side != 1 && grid->side != 2 && grid->side != 4) return 0;
    if (!grid->planes || grid->planes > LENSPROF_SENSOR_PLANES || grid->flip > LENSPROF_FLIP_BOTH || grid->reserved)
        return 0;
    for (uint32_t i = 0; i < sizeof grid->plane; i++)
        if (grid->plane[i] >= grid->planes) return 0;
    return lp_is_sensor_grid_side(grid->columns) && lp_is_sensor_grid_side(grid->rows);
}

/* The last sample lies at the last node or before, and cells have at least a pattern and not too many samples. */
static int is_axis_sound(const lp_sensor_axis *axis, uint32_t nodes, uint32_t samples, uint32_t side) {
    const uint32_t most = LP_SENSOR_LARGEST_SIDE * 2;
    if (!samples || samples > LP_SENSOR_LARGEST_SIDE || !axis->whole || axis->whole > most || !axis->step) return 0;
    const uint64_t last = axis->first + (uint64_t)(samples - 1) * axis->step, stride = (uint64_t)axis->step * side;
    return last <= (uint64_t)axis->whole * (nodes - 1) && stride <= axis->whole
           && axis->whole <= stride * LP_SENSOR_LARGEST_CELL
           && axis->per_whole == lp_sensor_axis_of(axis->first, axis->step, axis->whole).per_whole;
}

int lp_sensor_grid_is_sound(const lp_sensor_grid *grid) {
    return is_pattern_sound(grid) && is_axis_sound(&grid->axis[0], grid->columns, grid->width, grid->side)
           && is_axis_sound(&grid->axis[1], grid->rows, grid->height, grid->side);
}

static int is_level_sound(int32_t level) { return level >= -(1 << 29) && level <= LARGEST_LEVEL; }

static int are_numbers_sound(const lensprof_sensor_plan *plan) {
    const uint32_t count = plan->grid.planes * lp_sensor_grid_nodes(&plan->grid);
    if (plan->bytes != sizeof *plan + count * sizeof(uint32_t)) return 0;
    if (!is_level_sound(plan->white_in) || !is_level_sound(plan->white_out)) return 0;
    for (uint32_t p = 0; p < LENSPROF_SENSOR_PLANES; p++)
        if (!is_level_sound(plan->black_in[p]) || !is_level_sound(plan->black_out[p]) || plan->largest[p] > 65535
            || plan->shift[p] < LP_SENSOR_LEAST_SHIFT || plan->shift[p] > LP_SENSOR_LARGEST_SHIFT)
            return 0;
    for (uint32_t i = 0; i < count; i++)
        if (!lp_sensor_nodes(plan, 0)[i] || lp_sensor_nodes(plan, 0)[i] > LP_SENSOR_LARGEST_NODE) return 0;
    return 1;
}

lensprof_status lensprof_sensor_plan_open(const void *data, size_t size, const lensprof_sensor_plan **result) {
    const lensprof_sensor_plan *plan = data;
    if (!data || !result || (uintptr_t)data % 4) return LENSPROF_ERROR_ARGUMENT;
    if (size < sizeof *plan) return LENSPROF_ERROR_CAPACITY;
    if ((plan->magic ^ LP_SENSOR_MAGIC) & 0xffffffu) return LENSPROF_ERROR_CORRUPT;
    if (plan->magic != LP_SENSOR_MAGIC) return LENSPROF_ERROR_LAYOUT;
    if (plan->bytes > size) return LENSPROF_ERROR_CAPACITY;
    if (plan->bytes < sizeof *plan || plan->check != lp_sensor_check(plan) || !lp_sensor_grid_is_sound(&plan->grid)
        || !are_numbers_sound(plan))
        return LENSPROF_ERROR_CORRUPT;
    *result = plan;
    return LENSPROF_OK;
}

/* ---- between two plans ---- */

/* Whether they have everything in common but gains, and what follows from gains. */
static int are_alike(const lensprof_sensor_plan *a, const lensprof_sensor_plan *b) {
    lensprof_sensor_plan head = *b;
    head.check = a->check;
    memcpy(head.shift, a->shift, sizeof head.shift);
    memcpy(head.largest, a->largest, sizeof head.largest);
    return !memcmp(&head, a, sizeof head);
}

static uint32_t mixed(uint32_t a, uint32_t b, uint32_t share) {
    return a + (uint32_t)((int64_t)((int32_t)b - (int32_t)a) * share >> 16);
}

lensprof_status lensprof_sensor_plan_mix(void *memory, size_t size, const lensprof_sensor_plan *a,
                                         const lensprof_sensor_plan *b, uint32_t share,
                                         const lensprof_sensor_plan **result) {
    if (!memory || !a || !b || !result || share > 65536 || !are_alike(a, b)) return LENSPROF_ERROR_ARGUMENT;
    if (size < a->bytes || (uintptr_t)memory % 4) return LENSPROF_ERROR_CAPACITY;
    lensprof_sensor_plan *plan = memory;
    const lensprof_sensor_plan of_b = *b; /* memory may be that of a plan */
    const uint32_t count = lp_sensor_grid_nodes(&a->grid);
    if (plan != a) memmove(plan, a, sizeof *plan);
    for (uint32_t p = 0; p < LENSPROF_SENSOR_PLANES; p++) {
        const uint32_t of_a = plan->shift[p], shift = of_a < of_b.shift[p] ? of_a : of_b.shift[p];
        const uint32_t *from_a = lp_sensor_nodes(a, p), *from_b = lp_sensor_nodes(b, p);
        uint32_t *node = (uint32_t *)(void *)(plan + 1) + p * count;
        for (uint32_t i = 0; p < plan->grid.planes && i < count; i++) {
            const uint32_t gain = mixed(from_a[i] >> (of_a - shift), from_b[i] >> (of_b.shift[p] - shift), share);
            node[i] = gain ? gain : 1;
        }
        plan->shift[p] = (uint8_t)shift;
        plan->largest[p] = mixed(plan->largest[p], of_b.largest[p], share);
    }
    plan->check = lp_sensor_check(plan);
    *result = plan;
    return LENSPROF_OK;
}

/* With mired m = 10^6 / K: (m_a - m) / (m_a - m_b) = b (k - a) / (k (b - a)). */
uint32_t lensprof_mired_share(uint32_t a_kelvin, uint32_t b_kelvin, uint32_t kelvin) {
    const uint32_t given[3] = {a_kelvin, b_kelvin, kelvin};
    int64_t t[3];
    for (int i = 0; i < 3; i++) t[i] = given[i] < 1 ? 1 : given[i] > 100000 ? 100000 : given[i];
    const int64_t a = t[0], b = t[1], k = t[2];
    if (a == b || (k <= a) == (a < b)) return 0;
    if ((k >= b) == (a < b)) return 65536;
    return (uint32_t)((65536 * b * (k - a) + k * (b - a) / 2) / (k * (b - a)));
}
