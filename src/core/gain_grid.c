/* Attenuation on a grid over the frame: what a radial polynomial leaves. */
#include <lensprof/model.h>

#include <math.h>
#include <string.h>

#define NODES_MAX (3u * LENSPROF_GRID_SIDE * LENSPROF_GRID_SIDE)
#define SMALLEST 0.001f
#define LARGEST 1000.0f

void lensprof_gain_grid_init(lensprof_gain_grid *grid)
{
    memset(grid, 0, sizeof *grid);
}

static int is_side(uint32_t nodes)
{
    return nodes >= 2 && nodes <= LENSPROF_GRID_SIDE;
}

lensprof_status lensprof_gain_grid_validate(const lensprof_gain_grid *grid)
{
    if (!grid || grid->reserved) return LENSPROF_ERROR_ARGUMENT;
    int none = !grid->columns && !grid->rows;
    if (!none && (!is_side(grid->columns) || !is_side(grid->rows))) return LENSPROF_ERROR_SIZE;
    if (none ? grid->channels != 0 : grid->channels != 1 && grid->channels != 3) return LENSPROF_ERROR_ARGUMENT;
    uint32_t used = grid->channels * grid->rows * grid->columns;
    for (uint32_t i = 0; i < used; i++) {
        if (!isfinite(grid->attenuation[i])) return LENSPROF_ERROR_NOT_FINITE;
        if (!(grid->attenuation[i] >= SMALLEST && grid->attenuation[i] <= LARGEST)) return LENSPROF_ERROR_VIGNETTING;
    }
    for (uint32_t i = used; i < NODES_MAX; i++)
        if (grid->attenuation[i] != 0.0f) return LENSPROF_ERROR_ARGUMENT;
    return LENSPROF_OK;
}

/* The node before a position in 0..pixels-1, with a node behind it, and how far towards that one, 0..1. */
static uint32_t cell(double position, uint32_t pixels, uint32_t nodes, double *fraction)
{
    double t = pixels > 1 ? position / (pixels - 1.0) : 0.0;
    t = (nodes - 1.0) * (t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0);
    uint32_t node = (uint32_t)t;
    if (node > nodes - 2) node = nodes - 2;
    *fraction = t - node;
    return node;
}

double lensprof_gain_grid_eval(const lensprof_gain_grid *grid, uint32_t width, uint32_t height, double x, double y,
                               uint32_t channel)
{
    if (!grid->columns) return 1.0;
    double u, v;
    uint32_t column = cell(x, width, grid->columns, &u), row = cell(y, height, grid->rows, &v);
    uint32_t c = grid->channels == 3 ? channel : 0;
    const float *above = grid->attenuation + (c * grid->rows + row) * grid->columns + column;
    const float *below = above + grid->columns;
    return (1.0 - v) * ((1.0 - u) * above[0] + u * above[1]) + v * ((1.0 - u) * below[0] + u * below[1]);
}
