/* By how much a grid of gains differs from the model it was made from. */
#include <math.h>
#include <string.h>

#include "core/gain_grid.h"
#include "core/sensor_plan.h"

#define POSITIONS 8 /* per cell and axis, if the readout has the whole frame */

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
    const double gain = (above + v * (below - above)) / (span * (double)(1u << plan->shift[plane]));
    const double x = pixel_of(s, 0, column + u, plan->grid.columns), y = pixel_of(s, 1, row + v, plan->grid.rows);
    return fabs(gain / (lp_sensor_gain(s, plane, x, y) * own_gain(s, plane, x, y)) - 1.0);
}

/* Place `i` of `count` + 1 among the samples of an axis, from the first to the last, in nodes. */
static double place_of(const lp_sensor_axis *axis, uint32_t samples, uint32_t i, uint32_t count) {
    const double sample = count ? (samples - 1.0) * i / count : 0.0;
    return (axis->first + sample * axis->step) / axis->whole;
}

static uint32_t node_before(double place, uint32_t nodes) {
    const uint32_t node = (uint32_t)place;
    return node < nodes - 1 ? node : nodes - 2;
}

static int is_plan_of(const lensprof_sensor_plan *plan, const lp_sensor_source *s) {
    const lp_sensor_grid grid = lp_readout_grid(&s->readout, s->options.frame_width, s->options.frame_height);
    return !memcmp(&grid, &plan->grid, sizeof grid);
}

lensprof_status lensprof_sensor_plan_error(const lensprof_sensor_plan *plan, const lensprof_apply_options *options,
                                           const lensprof_readout *readout, double *largest) {
    if (!plan || !options || !readout || !largest) return LENSPROF_ERROR_ARGUMENT;
    lp_sensor_source source;
    const lensprof_status status = lp_sensor_source_take(&source, options, readout, NULL);
    if (status != LENSPROF_OK) return status;
    if (!is_plan_of(plan, &source)) return LENSPROF_ERROR_ARGUMENT;
    const lp_sensor_grid *grid = &plan->grid;
    const uint32_t across = POSITIONS * (grid->columns - 1), down = POSITIONS * (grid->rows - 1);
    const uint32_t most_x = across < grid->width ? across : grid->width - 1;
    const uint32_t most_y = down < grid->height ? down : grid->height - 1;
    *largest = 0.0;
    for (uint32_t j = 0; j <= most_y; j++)
        for (uint32_t i = 0; i <= most_x; i++) {
            const double u = place_of(&grid->axis[0], grid->width, i, most_x);
            const double v = place_of(&grid->axis[1], grid->height, j, most_y);
            const uint32_t column = node_before(u, grid->columns), row = node_before(v, grid->rows);
            for (uint32_t p = 0; p < grid->planes; p++)
                *largest = fmax(*largest, error_at(plan, &source, p, column, row, u - column, v - row));
        }
    return LENSPROF_OK;
}
