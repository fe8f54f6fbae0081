/* By how much a grid of gains differs from the model it was made from. */
#include <math.h>

#include "core/gain_grid.h"
#include "core/sensor_plan.h"

#define POSITIONS 8 /* per cell and axis */

/* The gains of the readout itself, bilinear over the frame. */
static double own_gain(const lp_sensor_source *s, uint32_t plane, double x, double y) {
    const lensprof_readout *r = &s->readout;
    if (!r->gains) return 1.0;
    return lp_grid_value(r->gains + plane * r->columns * r->rows, r->columns,
                         lp_grid_cell_at(x, s->options.frame_width, r->columns),
                         lp_grid_cell_at(y, s->options.frame_height, r->rows));
}

/* Pixel of the frame on an axis at node `at` of the plan, which counts flipped axes from the other end. */
static double pixel_of(const lp_sensor_source *s, int axis, double at, uint32_t nodes) {
    const double last = (axis ? s->options.frame_height : s->options.frame_width) - 1.0;
    const double pixel = at * last / (nodes - 1.0);
    return s->readout.flip & (axis ? LENSPROF_FLIP_VERTICAL : LENSPROF_FLIP_HORIZONTAL) ? last - pixel : pixel;
}

/* The relative error in one cell, at u, v of the way through it. */
static double error_at(const lensprof_sensor_plan *plan, const lp_sensor_source *s, uint32_t plane, uint32_t column,
                       uint32_t row, double u, double v) {
    const uint32_t *node = lp_sensor_nodes(plan, plane) + row * plan->grid.columns + column;
    const double above = node[0] + u * ((double)node[1] - node[0]);
    const double below =
        node[plan->grid.columns] + u * ((double)node[plan->grid.columns + 1] - node[plan->grid.columns]);
    const double span = lp_sensor_span(s, LP_OUTPUT, plane) / lp_sensor_span(s, LP_INPUT, plane);
    const double gain = (above + v * (below - above)) / (span * (double)(1u << plan->grid.shift));
    const double x = pixel_of(s, 0, column + u, plan->grid.columns), y = pixel_of(s, 1, row + v, plan->grid.rows);
    return fabs(gain / (lp_sensor_gain(s, plane, x, y) * own_gain(s, plane, x, y)) - 1.0);
}

/* Whether the readout reaches a place on an axis, in nodes. */
static int is_read(const lp_sensor_axis *axis, uint32_t samples, double at) {
    const double position = at * axis->whole;
    return position >= axis->first && position <= axis->first + (samples - 1.0) * axis->step;
}

static int is_plan_of(const lensprof_sensor_plan *plan, const lensprof_readout *r) {
    return plan->grid.width == r->width && plan->grid.height == r->height && plan->grid.side == r->side
           && plan->grid.columns == r->columns && plan->grid.rows == r->rows;
}

lensprof_status lensprof_sensor_plan_error(const lensprof_sensor_plan *plan, const lensprof_apply_options *options,
                                           const lensprof_readout *readout, double *largest) {
    if (!plan || !options || !readout || !largest) return LENSPROF_ERROR_ARGUMENT;
    lp_sensor_source source;
    const lensprof_status status = lp_sensor_source_take(&source, options, readout, NULL);
    if (status != LENSPROF_OK) return status;
    if (!is_plan_of(plan, &source.readout)) return LENSPROF_ERROR_ARGUMENT;
    const uint32_t across = (plan->grid.columns - 1) * POSITIONS, down = (plan->grid.rows - 1) * POSITIONS;
    *largest = 0.0;
    for (uint32_t j = 0; j < down; j++)
        for (uint32_t i = 0; i < across; i++) {
            const double u = (i % POSITIONS + 0.5) / POSITIONS, v = (j % POSITIONS + 0.5) / POSITIONS;
            const uint32_t column = i / POSITIONS, row = j / POSITIONS;
            if (!is_read(&plan->grid.axis[0], plan->grid.width, column + u)
                || !is_read(&plan->grid.axis[1], plan->grid.height, row + v))
                continue;
            for (uint32_t p = 0; p < plan->grid.planes; p++)
                *largest = fmax(*largest, error_at(plan, &source, p, column, row, u, v));
        }
    return LENSPROF_OK;
}
