/* The contents of an integer plan: made by fixed_plan.c, read by fixed.c. It has no addresses and no padding, so
 * that it may be copied. */
#ifndef LENSPROF_CORE_FIXED_PLAN_H
#define LENSPROF_CORE_FIXED_PLAN_H

#include <lensprof/fixed.h>

#include "core/features.h"
#include "core/image.h"
#include "core/options.h"
#include "core/sensor.h"

#define LP_FIXED_MAGIC 0x3458464cu /* "LFX4" in memory; the last byte is the layout's version */
#define LP_LOG_SHIFT 22            /* logarithms to base 2, in units of 2^-22 */
#define LP_LOG_NONE (-(1 << 30))   /* for no light: far below any value that a plan can reach by adding gains */
#define LP_CENTER_SHIFT 10         /* the falloff's centre, in units of 2^-10 px */
#define LP_LEVEL_SHIFT 8           /* levels, in units of 2^-8 of a code */
#define LP_CODES 256
#define LP_PLACE_SHIFT 21    /* places among the samples of a response, in units of 2^-21 */
#define LP_SAMPLE_SHIFT 14   /* those samples, in units of 2^-14 of a code */
#define LP_EXPONENT_SHIFT 26 /* exponents, in units of 2^-26 */
#define LP_LOG_MOST (1 << 30)
#define LP_STRENGTH_SHIFT 30 /* strength, in units of 2^-30 */

/* A curve between light and codes of 16 bit: a power, or the samples of a response. Both relate light to a number,
 * which is a code less black in 1 / 256, or a place among the samples:
 *   log2 of light = exponent (log2 number - log_one);  number = one 2^(exponent log2 of light) */
typedef struct lp_fixed_curve {
    uint32_t samples; /* where int32_t[1024] begin, in words after the plan's head: black + f (white - black), in 2^-14
                         of a code; 0: a power */
    uint32_t one;     /* number of light 1: white less black, or the place of the last sample */
    int32_t log_one, most; /* log2 of it; the largest log2 of light, 0 = clipped at white */
    uint32_t exponent;     /* gamma to decode, 1 / gamma to encode; 1 for samples and linear codes */
} lp_fixed_curve;

/* Attenuation between nodes: uint32_t node[channels][rows][columns] in units of 2^-shift, at the end of the plan. */
typedef struct lp_fixed_grid {
    uint32_t columns, rows, channels; /* 0 = no grid */
    uint32_t shift, strength;
    lp_sensor_axis axis[2];
} lp_fixed_grid;

struct lensprof_fixed_plan {
    uint32_t magic, bytes; /* of the plan with its tables */
    uint32_t check;        /* of what follows: lp_fixed_check */
    uint32_t frame_width, frame_height;
    uint8_t sample, layout, samples, channels;
    uint8_t channel_of_sample[4];
    uint8_t site[2][2];
    uint8_t simulate, neutral_white;      /* LENSPROF_SATURATED_NEUTRAL is in force */
    uint8_t decode_curves, encode_curves; /* tables of each kind: 1 or 3; 0 for linear codes */
    uint8_t falloffs, gains;              /* 1, or 3 if the channels differ: in the falloff; in falloff or factor */
    uint8_t levels;                       /* 1: samples have a black and a white level */
    uint8_t target;                       /* sample type of the output; `sample` is that of the input */
    int32_t center[2];
    uint32_t reach_shift;      /* 2^reach_shift times r^2 in 2^-20 px^2 has t = r^2 / R, in 2^-31, in its upper word */
    uint32_t falloff_shift;    /* falloffs are in units of 2^-falloff_shift */
    int32_t k[LP_CHANNELS][3]; /* M = 1 + k0 t + k1 t^2 + k2 t^3 */
    int32_t least;             /* M, after the gain cap */
    int32_t factor[LP_CHANNELS]; /* log2 of target over source exposure, and of the spans of linear samples */
    int32_t black_in[LP_CHANNELS], black_out[LP_CHANNELS]; /* in 1 / 256 of a code; 0 without levels */
    int32_t largest;                                       /* code at which linear output is clipped */
    uint32_t per_span[LP_CHANNELS]; /* of a level's unit, from black to white 2^8 65535, shifted by
                                       lp_fixed_span_shift: for LENSPROF_SATURATED_NEUTRAL */
    lp_fixed_grid grid;             /* multiplied by M, which then has no strength of its own */
    /* From U8 to U8: int32_t decode[decode_curves][256]: log2 of the light of every code; int32_t
     * encode[encode_curves][256]: log2 of the light at which code + 1 begins. Otherwise lp_fixed_curve
     * decode[decode_curves], encode[encode_curves], and their samples. */
};

/* The first and last pixel of a side have the first and last node. */
static inline lp_sensor_axis lp_fixed_grid_axis(uint32_t pixels, uint32_t nodes) {
    return lp_sensor_axis_of(0, nodes - 1, pixels > 1 ? pixels - 1 : 1);
}

/* Nodes of the grid, in words of the plan. */
static inline uint32_t lp_fixed_nodes(const lensprof_fixed_plan *plan) {
    return LP_HAS_FIXED_GRID ? plan->grid.columns * plan->grid.rows * plan->grid.channels : 0;
}

static inline uint32_t lp_fixed_target(const lensprof_fixed_plan *plan) {
    return LP_HAS_WIDE_CURVES ? plan->target : plan->sample;
}

/* Whether input and output are U8. If one is U16, the codes of the input are of 16 bit, those of U8 times 257. */
static inline int lp_fixed_is_8_bit(const lensprof_fixed_plan *plan) {
    return plan->sample == LENSPROF_SAMPLE_U8 && lp_fixed_target(plan) == LENSPROF_SAMPLE_U8;
}

static inline uint32_t lp_fixed_span_shift(const lensprof_fixed_plan *plan) {
    return lp_fixed_is_8_bit(plan) ? 14 : 22;
}

/* Whether codes pass through lp_fixed_curve. */
static inline int lp_fixed_is_wide(const lensprof_fixed_plan *plan) {
    return LP_HAS_WIDE_CURVES && plan->decode_curves && !lp_fixed_is_8_bit(plan);
}

/* log2(1 + i/256) in 2^-22 and 2^(i/256) in 2^-30, i = 0..256. */
extern const uint32_t lp_log2_table[257], lp_exp2_table[257];

/* CRC-32 of the bytes after `check`, tables included. fixed_open.c */
uint32_t lp_fixed_check(const lensprof_fixed_plan *plan);

#endif
