/* The surface of a flat field by least squares: A n = b with A_ij = sum_x w_i(x) w_j(x) over the samples of a plane.
 *
 * A plane consists of one to sixteen sets of samples, one per place in the pattern; for each of them w is a product of
 * functions of the column and of the row, so A is a sum of products of tridiagonal matrices across and down. */
#include "core/sensor_flat.h"

#include <math.h>
#include <string.h>

#include "core/fail.h"

#define SIDE LENSPROF_SENSOR_GRID_SIDE
#define MOST_STEPS 200
#define CLOSE 1e-10            /* of the residual, relative to b */
#define LEAST_LIGHT (1.0 / 64) /* of white less black, where a plane is brightest */
#define LARGEST_GAIN 1000.0    /* as readouts allow */
#define LEAST_SHARE 0.125      /* of the samples of the best node */

/* Sums over the samples of an axis at one place of the pattern: w_i^2, and w_i w_(i + 1). */
typedef struct band {
    double own[SIDE], next[SIDE];
} band;

typedef struct system {
    const lp_sensor_grid *grid;
    uint32_t plane;
    band across[4], down[4];
} system;

/* Work memory: the system, the light of all planes, and four vectors of a plane. */
static size_t work_of(const lp_sensor_grid *grid) {
    return sizeof(system) + (grid->planes + 4) * lp_sensor_grid_nodes(grid) * sizeof(double);
}

size_t lensprof_sensor_flat_work_bytes(const lensprof_sensor_flat *flat) { return flat ? work_of(&flat->grid) : 0; }

static void fill_band(band *b, const lp_sensor_axis *axis, uint32_t nodes, uint32_t samples, uint32_t first,
                      uint32_t side) {
    memset(b, 0, sizeof *b);
    for (uint32_t i = first; i < samples; i += side) {
        const lp_sensor_place place = lp_sensor_place_at(axis, nodes, i);
        const double right = lp_flat_part(axis, place.rest), left = LP_FLAT_ONE - right;
        b->own[place.node] += left * left, b->own[place.node + 1] += right * right;
        b->next[place.node] += left * right;
    }
}

/* Of node i: the band's product with three values of a row or column, `step` apart. */
static double band_at(const band *b, uint32_t i, uint32_t nodes, const double *values, uint32_t step) {
    double sum = b->own[i] * values[i * step];
    if (i) sum += b->next[i - 1] * values[(i - 1) * step];
    if (i + 1 < nodes) sum += b->next[i] * values[(i + 1) * step];
    return sum;
}

/* product = A values. */
static void multiply(const system *s, const double *values, double *product) {
    const uint32_t columns = s->grid->columns, rows = s->grid->rows, side = s->grid->side;
    double line[SIDE];
    memset(product, 0, columns * rows * sizeof *product);
    for (uint32_t place = 0; place < side * side; place++) {
        if (s->grid->plane[place] != s->plane) continue;
        const band *across = &s->across[place % side], *down = &s->down[place / side];
        for (uint32_t row = 0; row < rows; row++) {
            for (uint32_t i = 0; i < columns; i++) line[i] = band_at(down, row, rows, values + i, columns);
            for (uint32_t i = 0; i < columns; i++) product[row * columns + i] += band_at(across, i, columns, line, 1);
        }
    }
}

static double dot(const double *a, const double *b, uint32_t count) {
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* Conjugate gradients from 0; A is well conditioned. r holds b at first. Vectors of `count` numbers. */
static int solve(const system *s, double *n, double *r, double *p, double *product, uint32_t count) {
    const double goal = CLOSE * CLOSE * dot(r, r, count);
    double rr = dot(r, r, count);
    memset(n, 0, count * sizeof *n);
    memcpy(p, r, count * sizeof *p);
    for (int step = 0; step < MOST_STEPS && rr > goal; step++) {
        multiply(s, p, product);
        const double alpha = rr / dot(p, product, count);
        for (uint32_t i = 0; i < count; i++) n[i] += alpha * p[i], r[i] -= alpha * product[i];
        const double before = rr;
        rr = dot(r, r, count);
        for (uint32_t i = 0; i < count; i++) p[i] = r[i] + rr / before * p[i];
    }
    return rr <= goal;
}

/* Whether each node has samples, by the row sums of A: w adds up to 1. */
static int have_samples(const system *s, double *ones, double *sums, uint32_t count) {
    double least, most;
    for (uint32_t i = 0; i < count; i++) ones[i] = 1.0;
    multiply(s, ones, sums);
    least = most = sums[0];
    for (uint32_t i = 1; i < count; i++) {
        if (sums[i] < least) least = sums[i];
        most = fmax(most, sums[i]);
    }
    return least > LEAST_SHARE * most / 4.0; /* the corners have a quarter of the samples of a node inside */
}

static double largest_of(const double *values, uint32_t count) {
    double largest = values[0];
    for (uint32_t i = 1; i < count; i++) largest = fmax(largest, values[i]);
    return largest;
}

/* The light of a plane at its nodes, less black, in codes of one picture. */
static const char *fit_plane(const lensprof_sensor_flat *flat, uint32_t plane, system *s, double *light, double *r) {
    const lp_sensor_grid *grid = &flat->grid;
    const uint32_t count = lp_sensor_grid_nodes(grid);
    double *p = r + count, *product = p + count, *extra = product + count;
    const uint64_t *sums = (const uint64_t *)(const void *)(flat + 1) + plane * count;
    const double pictures = (double)flat->samples / ((double)grid->width * grid->height);
    s->plane = plane;
    if (!have_samples(s, extra, product, count)) return "the window leaves nodes of the grid without samples";
    for (uint32_t i = 0; i < count; i++) r[i] = (double)sums[i] * LP_FLAT_ONE * LP_FLAT_ONE / pictures;
    if (!solve(s, light, r, p, product, count)) return "the flat field cannot be fitted";
    for (uint32_t i = 0; i < count; i++) light[i] -= flat->black[plane];
    const double largest = largest_of(light, count);
    if (!(largest >= LEAST_LIGHT * (flat->white - flat->black[plane])))
        return "the flat field is dark: expose more, or state its white level";
    for (uint32_t i = 0; i < count; i++)
        if (!(light[i] * LARGEST_GAIN >= largest)) return "the flat field is black in a part of the frame";
    return NULL;
}

/* Gains in the frame's order: a flipped readout counts its nodes from the other end. */
static void write_gains(const lp_sensor_grid *grid, const double *light, float *gains) {
    const double largest = largest_of(light, lp_sensor_grid_nodes(grid));
    for (uint32_t row = 0; row < grid->rows; row++)
        for (uint32_t column = 0; column < grid->columns; column++) {
            const uint32_t i = grid->flip & LENSPROF_FLIP_HORIZONTAL ? grid->columns - 1 - column : column;
            const uint32_t j = grid->flip & LENSPROF_FLIP_VERTICAL ? grid->rows - 1 - row : row;
            gains[row * grid->columns + column] = (float)(largest / light[j * grid->columns + i]);
        }
}

static const char *wrong_with(const lensprof_sensor_flat *flat) {
    const uint64_t picture = (uint64_t)flat->grid.width * flat->grid.height;
    uint64_t whole[LP_FLAT_MOMENTS] = {0};
    lp_flat_add_moments(whole, 0, 0, flat->grid.width, flat->grid.height);
    for (int m = 0; m < LP_FLAT_MOMENTS; m++) whole[m] *= flat->samples / picture;
    if (!flat->samples || flat->samples % picture || memcmp(whole, flat->moments, sizeof whole))
        return "samples are missing: each must be added equally often";
    if (flat->saturated > flat->samples / 1000) return "the flat field is saturated: expose less";
    return NULL;
}

lensprof_status lensprof_sensor_flat_gains(const lensprof_sensor_flat *flat, void *work, size_t work_bytes,
                                           float *gains, lensprof_error *error) {
    if (!flat || !work || !gains) return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "flat, work or gains is NULL");
    const lp_sensor_grid *grid = &flat->grid;
    if (work_bytes < work_of(grid) || (uintptr_t)work % 8)
        return lp_fail(error, LENSPROF_ERROR_CAPACITY, "memory is too small or unaligned");
    const uint32_t count = lp_sensor_grid_nodes(grid);
    system *s = work;
    double *light = (double *)(void *)(s + 1);
    const char *wrong = wrong_with(flat);
    s->grid = grid;
    for (uint32_t i = 0; i < grid->side; i++) {
        fill_band(&s->across[i], &grid->axis[0], grid->columns, grid->width, i, grid->side);
        fill_band(&s->down[i], &grid->axis[1], grid->rows, grid->height, i, grid->side);
    }
    for (uint32_t plane = 0; plane < grid->planes && !wrong; plane++)
        wrong = fit_plane(flat, plane, s, light + plane * count, light + grid->planes * count);
    for (uint32_t plane = 0; plane < grid->planes && !wrong; plane++)
        write_gains(grid, light + plane * count, gains + plane * count);
    return wrong ? lp_fail(error, LENSPROF_ERROR_NO_SAMPLES, wrong) : lp_fail(error, LENSPROF_OK, "");
}
