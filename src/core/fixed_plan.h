/* The contents of an integer plan: made by fixed_plan.c, read by fixed.c. It has no addresses and no padding, so
 * that it may be copied. */
#ifndef LENSPROF_CORE_FIXED_PLAN_H
#define LENSPROF_CORE_FIXED_PLAN_H

#include <lensprof/fixed.h>

#include "core/image.h"
#include "core/options.h"

#define LP_FIXED_MAGIC 0x3358464cu /* "LFX3" in memory; the last byte is the layout's version */
#define LP_LOG_SHIFT 22            /* logarithms to base 2, in units of 2^-22 */
#define LP_LOG_NONE (-(1 << 30))   /* for no light: far below any value that a plan can reach by adding gains */
#define LP_CENTER_SHIFT 10         /* the falloff's centre, in units of 2^-10 px */
#define LP_LEVEL_SHIFT 8           /* levels, in units of 2^-8 of a code */
#define LP_CODES 256

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
    uint8_t reserved;
    int32_t center[2];
    uint32_t reach_shift;      /* 2^reach_shift times r^2 in 2^-20 px^2 has t = r^2 / R, in 2^-31, in its upper word */
    uint32_t falloff_shift;    /* falloffs are in units of 2^-falloff_shift */
    int32_t k[LP_CHANNELS][3]; /* M = 1 + k0 t + k1 t^2 + k2 t^3 */
    int32_t least;             /* M, after the gain cap */
    int32_t factor[LP_CHANNELS]; /* log2 of target over source exposure, and of the spans of linear samples */
    int32_t black_in[LP_CHANNELS], black_out[LP_CHANNELS]; /* in 1 / 256 of a code; 0 without levels */
    int32_t largest;                                       /* code at which linear output is clipped */
    uint32_t per_span[LP_CHANNELS]; /* to 65535ths of white less black, in 2^-16: for LENSPROF_SATURATED_NEUTRAL */
    /* int32_t decode[decode_curves][256]: log2 of the light of every code; int32_t encode[encode_curves][256]: log2
     * of the light at which code + 1 begins */
};

/* log2(1 + i/256) in 2^-22 and 2^(i/256) in 2^-30, i = 0..256. */
extern const uint32_t lp_log2_table[257], lp_exp2_table[257];

/* CRC-32 of the bytes after `check`, tables included. fixed_open.c */
uint32_t lp_fixed_check(const lensprof_fixed_plan *plan);

#endif
