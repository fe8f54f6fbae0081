/* A flat field that is being captured: sums for the bilinear surface nearest to the samples. */
#ifndef LENSPROF_CORE_SENSOR_FLAT_H
#define LENSPROF_CORE_SENSOR_FLAT_H

#include "core/sensor.h"

#define LP_FLAT_MAGIC 0x31464e53u /* "SNF1" in memory; the last byte is the layout's version */
#define LP_FLAT_PART_SHIFT 8      /* the way from node to node, in 2^-8 */
#define LP_FLAT_ONE (1u << LP_FLAT_PART_SHIFT)
#define LP_FLAT_MOST_PICTURES 256
#define LP_FLAT_MOMENTS 5

struct lensprof_sensor_flat {
    uint32_t magic, bytes;
    lp_sensor_grid grid;
    uint32_t reserved;
    double black[LENSPROF_SENSOR_PLANES], white;
    uint64_t samples, saturated;       /* added so far */
    uint64_t moments[LP_FLAT_MOMENTS]; /* sums of x, y, x^2, y^2, x y of these, modulo 2^64: equal to those of whole
                                          pictures if each was added equally often */
    /* uint64_t sum[planes][rows][columns]: of samples times the node's share of the place, in 2^-16 */
};

/* Sum of i and of i^2 for i = first..first + count - 1. */
static inline uint64_t lp_sum_of(uint64_t first, uint64_t count) { return (2 * first + count - 1) * count / 2; }

static inline uint64_t lp_sum_of_squares(uint64_t first, uint64_t count) {
    const uint64_t end = first + count;
    return (end * (end - 1) * (2 * end - 1) - first * (first - 1) * (2 * first - 1)) / 6;
}

/* Adds the moments of samples x..x + width - 1, y..y + height - 1. */
static inline void lp_flat_add_moments(uint64_t moments[LP_FLAT_MOMENTS], uint32_t x, uint32_t y, uint32_t width,
                                       uint32_t height) {
    const uint64_t sum_x = lp_sum_of(x, width), sum_y = lp_sum_of(y, height);
    moments[0] += sum_x * height, moments[1] += sum_y * width;
    moments[2] += lp_sum_of_squares(x, width) * height, moments[3] += lp_sum_of_squares(y, height) * width;
    moments[4] += sum_x * sum_y;
}

/* Pictures whose sums stay below 2^64: 16 bit, two parts of 8 bit, and the samples between a node and its neighbours.
 */
static inline uint64_t lp_flat_most_pictures(const lp_sensor_grid *grid) {
    const uint64_t across = 2 * grid->axis[0].whole / grid->axis[0].step + 2;
    const uint64_t down = 2 * grid->axis[1].whole / grid->axis[1].step + 2;
    const uint64_t most = (1ull << 32) / (across * down);
    return most < LP_FLAT_MOST_PICTURES ? most : LP_FLAT_MOST_PICTURES;
}

static inline uint64_t *lp_flat_sums(lensprof_sensor_flat *flat, uint32_t plane) {
    return (uint64_t *)(void *)(flat + 1) + plane * lp_sensor_grid_nodes(&flat->grid);
}

/* The part of the way to the next node, to nearest: 0..256. */
static inline uint32_t lp_flat_part(const lp_sensor_axis *axis, uint32_t rest) {
    const uint32_t shift = LP_SENSOR_PART_SHIFT - LP_FLAT_PART_SHIFT;
    return (uint32_t)(((uint64_t)rest * axis->per_whole + (1u << (shift - 1))) >> shift);
}

#endif
