/* Grids of gains, applied to the samples of a sensor in integers (lensprof/sensor.h). */
#include "core/sensor.h"

/* ---- samples ---- */

/* What is the same for all samples of a plane. */
typedef struct constants {
    int64_t base; /* black of the output and 1/2 for rounding, in units of light times gain */
    int32_t black;
    uint32_t largest;
    uint32_t shift; /* of the upper word of the product */
    uint32_t side;  /* samples from one of the plane to the next */
} constants;

static constants constants_of(const lensprof_sensor_plan *plan, uint32_t plane) {
    const int64_t one = (int64_t)1 << plan->shift[plane];
    return (constants){plan->black_out[plane] * one + (one << (LP_SENSOR_LEVEL_SHIFT - 1)), plan->black_in[plane],
                       plan->largest[plane], plan->shift[plane] - LP_SENSOR_LEAST_SHIFT, plan->grid.side};
}

/* black' + (B - black) G, clipped, for samples of one plane in one cell; G rises by `rise` from sample to sample. */
static void correct_cell(const constants *of, const uint16_t *from, uint16_t *to, uint32_t count, int32_t gain,
                         int32_t rise) {
    const uint32_t side = of->side, largest = of->largest;
    for (; count; count--, from += side, to += side) {
        const int32_t light = (int32_t)((uint32_t)*from << LP_SENSOR_LEVEL_SHIFT) - of->black;
        int32_t code = (int32_t)((of->base + (int64_t)light * gain) >> 32) >> of->shift;
        if ((uint32_t)code > largest) code = code < 0 ? 0 : (int32_t)largest;
        *to = (uint16_t)code;
        gain = (int32_t)((uint32_t)gain + (uint32_t)rise); /* after the last one it may overflow */
    }
}

/* ---- rows ---- */

/* The gain of column `node` at the height of a row. */
static int32_t gain_at(const uint32_t *nodes, uint32_t columns, uint32_t node, uint32_t part) {
    return lp_sensor_between((int32_t)nodes[node], (int32_t)nodes[columns + node], part);
}

/* Samples of one plane: those at x, x + side, ... before the end of the row. A cell's gains are counted from its first
 * sample of this plane in the frame, wherever the tile begins. */
static void correct_plane(const lensprof_sensor_plan *plan, const uint16_t *from, uint16_t *to, uint32_t x,
                          uint32_t count, uint32_t y) {
    const lp_sensor_axis *across = &plan->grid.axis[0];
    const lp_sensor_place row = lp_sensor_place_at(&plan->grid.axis[1], plan->grid.rows, y);
    const uint32_t plane = lp_sensor_plane_at(&plan->grid, x, y);
    const uint32_t *nodes = lp_sensor_nodes(plan, plane) + row.node * plan->grid.columns;
    const uint32_t down = row.rest * plan->grid.axis[1].per_whole, stride = across->step * plan->grid.side;
    const constants of = constants_of(plan, plane);
    lp_sensor_place place = lp_sensor_place_at(across, plan->grid.columns, x);
    while (count) {
        const int32_t left = gain_at(nodes, plan->grid.columns, place.node, down);
        const int32_t right = gain_at(nodes, plan->grid.columns, place.node + 1, down);
        const uint32_t before = place.rest / stride; /* samples of this plane in the cell */
        const int64_t rise_part = (int64_t)(right - left) * (stride * across->per_whole);
        const int32_t rise = (int32_t)((rise_part + (1 << (LP_SENSOR_PART_SHIFT - 1))) >> LP_SENSOR_PART_SHIFT);
        const uint32_t first_part = (place.rest - before * stride) * across->per_whole;
        const int32_t gain = lp_sensor_between(left, right, first_part) + (int32_t)before * rise;
        const uint32_t here = lp_sensor_in_cell(across, plan->grid.columns, place, stride, count);
        correct_cell(&of, from, to, here, gain, rise);
        from += here * plan->grid.side, to += here * plan->grid.side, count -= here;
        place.node++, place.rest += here * stride - across->whole;
    }
}

lensprof_status lensprof_sensor_apply(const lensprof_sensor_plan *plan, const lensprof_image *source,
                                      const lensprof_target *target, uint32_t x0, uint32_t y0) {
    if (!plan || !target) return LENSPROF_ERROR_ARGUMENT;
    const lensprof_image written = lp_image_of(target);
    if (!source) source = &written;
    const lp_tiles tiles = {LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY, plan->grid.width,
                            plan->grid.height};
    const lensprof_status status = lp_tile_validate(&tiles, source, &written, x0, y0);
    for (uint32_t y = 0; status == LENSPROF_OK && y < source->height; y++) {
        const uint8_t *from = (const uint8_t *)source->data + (ptrdiff_t)y * source->row_bytes;
        uint8_t *to = (uint8_t *)target->data + (ptrdiff_t)y * target->row_bytes;
        for (uint32_t i = 0; i < plan->grid.side && i < source->width; i++)
            correct_plane(plan, (const uint16_t *)(const void *)from + i, (uint16_t *)(void *)to + i, x0 + i,
                          (source->width - i + plan->grid.side - 1) / plan->grid.side, y0 + y);
    }
    return status;
}
