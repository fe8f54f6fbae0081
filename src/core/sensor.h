/* The contents of a sensor plan: made by sensor_plan.c, read by sensor.c. It has no addresses and no padding, so that
 * it may be copied. */
#ifndef LENSPROF_CORE_SENSOR_H
#define LENSPROF_CORE_SENSOR_H

#include <lensprof/sensor.h>

#include "core/image.h"

#define LP_SENSOR_MAGIC 0x314e534cu /* "LSN1" in memory; the last byte is the layout's version */
#define LP_SENSOR_LEVEL_SHIFT 14    /* codes and levels in units of 2^-14 of a code */
#define LP_SENSOR_PART_SHIFT 31     /* the way from one node to the next, in 2^-31 */
#define LP_SENSOR_LEAST_SHIFT 18    /* of gains: the upper word of code times gain then has no fraction less than 0 */
#define LP_SENSOR_LARGEST_SHIFT 29
#define LP_SENSOR_LARGEST_NODE ((1u << 30) - 1)
#define LP_SENSOR_LARGEST_SIDE 65535u /* px of the frame */
#define LP_SENSOR_LARGEST_CELL 1024u  /* samples of a colour: gains are added up, with an error of 1/2 unit each */

/* Positions along an axis, in units of which `whole` lie between two nodes: sample i is at first + i step. */
typedef struct lp_sensor_axis {
    uint32_t first, step, whole;
    uint32_t per_whole; /* 2^31 / whole, to nearest */
} lp_sensor_axis;

static inline lp_sensor_axis lp_sensor_axis_of(uint32_t first, uint32_t step, uint32_t whole) {
    return (lp_sensor_axis){first, step, whole, ((1u << LP_SENSOR_PART_SHIFT) + whole / 2) / whole};
}

/* The samples of a readout and the nodes among them. */
typedef struct lp_sensor_grid {
    uint32_t width, height; /* samples of a row, and rows */
    uint8_t side, planes;
    uint8_t flip; /* lensprof_flip: nodes count from the end of the frame at which reading begins */
    uint8_t reserved;
    uint8_t plane[16];
    uint32_t columns, rows;
    lp_sensor_axis axis[2]; /* across, down */
} lp_sensor_grid;

struct lensprof_sensor_plan {
    uint32_t magic, bytes; /* of the plan with its nodes */
    uint32_t check;        /* of what follows: lp_sensor_check */
    lp_sensor_grid grid;
    int32_t black_in[LENSPROF_SENSOR_PLANES], black_out[LENSPROF_SENSOR_PLANES];
    uint32_t largest[LENSPROF_SENSOR_PLANES]; /* code at which the output is clipped */
    int32_t white_in, white_out;              /* levels of a plan, to compare plans with */
    uint8_t shift[LENSPROF_SENSOR_PLANES];    /* gains of a plane are in units of 2^-shift */
    /* uint32_t node[planes][rows][columns] */
};

static inline uint32_t lp_sensor_grid_nodes(const lp_sensor_grid *grid) { return grid->rows * grid->columns; }

/* Whether the numbers of a grid from elsewhere are those of a readout: samples lie within the nodes, and cells have at
 * least a pattern and not too many samples. */
int lp_sensor_grid_is_sound(const lp_sensor_grid *grid);

/* CRC-32 of the bytes after `check`, nodes included. */
uint32_t lp_sensor_check(const lensprof_sensor_plan *plan);

static inline const uint32_t *lp_sensor_nodes(const lensprof_sensor_plan *plan, uint32_t plane) {
    return (const uint32_t *)(const void *)(plan + 1) + plane * lp_sensor_grid_nodes(&plan->grid);
}

/* The plane of a sample. */
static inline uint32_t lp_sensor_plane_at(const lp_sensor_grid *grid, uint32_t x, uint32_t y) {
    return grid->plane[y % grid->side * grid->side + x % grid->side];
}

static inline int lp_is_sensor_grid_side(uint32_t nodes) { return nodes >= 2 && nodes <= LENSPROF_SENSOR_GRID_SIDE; }

/* The node before a position, which has a node after it, and the rest of the way, 0..whole. */
typedef struct lp_sensor_place {
    uint32_t node, rest;
} lp_sensor_place;

static inline lp_sensor_place lp_sensor_place_at(const lp_sensor_axis *axis, uint32_t nodes, uint32_t sample) {
    const uint32_t position = axis->first + sample * axis->step;
    uint32_t node = position / axis->whole;
    if (node > nodes - 2) node = nodes - 2;
    return (lp_sensor_place){node, position - node * axis->whole};
}

/* The place of the next sample. */
static inline void lp_sensor_next(const lp_sensor_axis *axis, uint32_t nodes, lp_sensor_place *place) {
    place->rest += axis->step;
    while (place->rest >= axis->whole && place->node < nodes - 2) place->rest -= axis->whole, place->node++;
}

/* How many of `count` samples, which are `stride` apart in units of the axis, lie before the next node. */
static inline uint32_t lp_sensor_in_cell(const lp_sensor_axis *axis, uint32_t nodes, lp_sensor_place place,
                                         uint32_t stride, uint32_t count) {
    const uint32_t here = place.node < nodes - 2 ? (axis->whole - place.rest + stride - 1) / stride : count;
    return here < count ? here : count;
}

/* From one gain towards the next by a part in 2^-31. */
static inline int32_t lp_sensor_between(int32_t from, int32_t to, uint32_t part) {
    return from + (int32_t)((int64_t)(to - from) * part >> LP_SENSOR_PART_SHIFT);
}

#endif
