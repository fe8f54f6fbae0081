/* Valid contents of a gain grid, and its interpolation: for one position, and for the pixels of a row, whose columns
 * and rows are looked up separately. */
#ifndef LENSPROF_CORE_GAIN_GRID_H
#define LENSPROF_CORE_GAIN_GRID_H

#include <lensprof/model.h>

static inline int lp_is_grid_side(uint32_t nodes) { return nodes >= 2 && nodes <= LENSPROF_GRID_SIDE; }

/* Also false for NaN. */
static inline int lp_is_attenuation(float value) { return value >= 0.001f && value <= 1000.0f; }

/* The node before a position on one axis, which has a node after it, and the fraction of the way to that node, 0..1. */
typedef struct lp_grid_cell {
    uint32_t node;
    double fraction;
} lp_grid_cell;

/* `position` in pixels; the first and last pixel of `pixels` map to the first and last of `nodes` >= 2; clamped to
 * them. */
static inline lp_grid_cell lp_grid_cell_at(double position, uint32_t pixels, uint32_t nodes) {
    double t = pixels > 1 ? position / (pixels - 1.0) : 0.0;
    t = (nodes - 1.0) * (t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0);
    lp_grid_cell cell = {(uint32_t)t, 0.0};
    if (cell.node > nodes - 2) cell.node = nodes - 2;
    cell.fraction = t - cell.node;
    return cell;
}

/* Bilinear between four nodes of one channel, whose rows are `columns` apart. */
static inline double lp_grid_value(const float *nodes, uint32_t columns, lp_grid_cell column, lp_grid_cell row) {
    const float *above = nodes + row.node * columns + column.node, *below = above + columns;
    double u = column.fraction, v = row.fraction;
    return (1.0 - v) * ((1.0 - u) * above[0] + u * above[1]) + v * ((1.0 - u) * below[0] + u * below[1]);
}

#endif
