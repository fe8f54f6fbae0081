/* A flat field that is being captured: sums for the bilinear surface nearest to the samples. */
#ifndef LENSPROF_CORE_SENSOR_FLAT_H
#define LENSPROF_CORE_SENSOR_FLAT_H

#include "core/sensor.h"

#define LP_FLAT_MAGIC 0x31464e53u /* "SNF1" in memory; the last byte is the layout's version */
#define LP_FLAT_PART_SHIFT 8      /* the way from node to node, in 2^-8 */
#define LP_FLAT_ONE (1u << LP_FLAT_PART_SHIFT)
#define LP_FLAT_MOST_PICTURES 256 /* sums of 16 bit, two parts of 8 bit and 2^24 samples of a cell are below 2^64 */

struct lensprof_sensor_flat {
    uint32_t magic, bytes;
    lp_sensor_grid grid;
    uint32_t reserved;
    double black[LENSPROF_SENSOR_PLANES], white;
    uint64_t samples, saturated; /* added so far */
    /* uint64_t sum[planes][rows][columns]: of samples times the node's share of the place, in 2^-16 */
};

static inline uint64_t *lp_flat_sums(lensprof_sensor_flat *flat, uint32_t plane) {
    return (uint64_t *)(void *)(flat + 1) + plane * lp_sensor_grid_nodes(&flat->grid);
}

/* The part of the way to the next node, to nearest: 0..256. */
static inline uint32_t lp_flat_part(const lp_sensor_axis *axis, uint32_t rest) {
    const uint32_t shift = LP_SENSOR_PART_SHIFT - LP_FLAT_PART_SHIFT;
    return (uint32_t)(((uint64_t)rest * axis->per_whole + (1u << (shift - 1))) >> shift);
}

#endif
