/* Attenuation on a grid over the frame: the residual of a radial polynomial. */
#include "core/gain_grid.h"

#include <math.h>
#include <string.h>

#define NODES_MAX (3u * LENSPROF_GRID_SIDE * LENSPROF_GRID_SIDE)

void lensprof_gain_grid_init(lensprof_gain_grid *grid) { memset(grid, 0, sizeof *grid); }

lensprof_status lensprof_gain_grid_validate(const lensprof_gain_grid *grid) {
    if (!grid || grid->reserved) return LENSPROF_ERROR_ARGUMENT;
    int is_empty = !grid->columns && !grid->rows;
    if (!is_empty && (!lp_is_grid_side(grid->columns) || !lp_is_grid_side(grid->rows))) return LENSPROF_ERROR_SIZE;
    if (is_empty ? grid->channels != 0 : grid->channels != 1 && grid->channels != 3) return LENSPROF_ERROR_ARGUMENT;
    uint32_t used = grid->channels * grid->rows * grid->columns;
    for (uint32_t i = 0; i < used; i++) {
        if (!isfinite(grid->attenuation[i])) return LENSPROF_ERROR_NOT_FINITE;
        if (!lp_is_attenuation(grid->attenuation[i])) return LENSPROF_ERROR_VIGNETTING;
    }
    for (uint32_t i = used; i < NODES_MAX; i++)
        if (grid->attenuation[i] != 0.0f) return LENSPROF_ERROR_ARGUMENT;
    return LENSPROF_OK;
}

double lensprof_gain_grid_eval(const lensprof_gain_grid *grid, uint32_t width, uint32_t height, double x, double y,
                               uint32_t channel) {
    if (!grid->columns || channel > 2) return 1.0;
    const float *nodes = grid->attenuation + (grid->channels == 3 ? channel : 0) * grid->rows * grid->columns;
    return lp_grid_value(nodes, grid->columns, lp_grid_cell_at(x, width, grid->columns),
                         lp_grid_cell_at(y, height, grid->rows));
}

void lensprof_gain_grid_eval_many(const lensprof_gain_grid *grid, uint32_t width, uint32_t height, const double *xy,
                                  size_t count, uint32_t channel, double *attenuations) {
    for (size_t i = 0; i < count; i++)
        attenuations[i] = lensprof_gain_grid_eval(grid, width, height, xy[2 * i], xy[2 * i + 1], channel);
}
