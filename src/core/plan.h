/* The contents of a plan: made by plan.c, read by the kernels. */
#ifndef LENSPROF_CORE_PLAN_H
#define LENSPROF_CORE_PLAN_H

#include "core/features.h"
#include "core/image.h"
#include "core/image_circle.h"

#define LP_FORWARD_SHIFT 10 /* log2 of the samples of a response */
#define LP_CELL_SHIFT 11
#define LP_CELLS (1 << LP_CELL_SHIFT) /* cells of the range 0..1, to find values among the samples */

/* What the kernels do with the levels of a plan. */
enum lp_level_step {
    LP_LEVELS_IN = 1, /* subtract black from samples, and scale them; not if the table of codes includes it */
    LP_LEVELS_OUT = 2 /* scale values, and add black */
};

/* How codes or values become irradiance, and how irradiance becomes a value 0..1 again. */
enum lp_curve {
    LP_CURVE_NONE,  /* linear; codes are in units of their own, which the plan's factors include */
    LP_CURVE_CLIP,  /* linear, cut to 0..1 */
    LP_CURVE_TABLE, /* by the response's samples; for codes, by a table of all codes */
    LP_CURVE_POWER, /* x^exponent, cut to 0..1 */
    LP_CURVE_MIXED  /* the channels differ: a power if exponent > 0, else the table */
};

/* Applies a plan to `count` pixels of a row, the first of which is pixel (x, y) of the frame; outside of columns
 * inside[0]..inside[1] - 1 of the frame M is 1, NULL = all are inside. `stream`: write past the caches. */
typedef void lp_row_kernel(const lensprof_plan *plan, const uint8_t *const source[3], uint8_t *const target[3],
                           uint32_t x, uint32_t y, uint32_t count, const uint32_t *inside, int stream);

#if LP_HAS_LEVELS
/* Of the input, value = (number - black_in) per_span_in; of the output, number = value span_out + black_out. Numbers
 * are codes if there is no curve, which is then in the factor: the spans are 1. */
struct lp_plan_levels {
    uint32_t steps;   /* lp_level_step, or 0 */
    uint32_t are_one; /* all channels have the same black */
    float black_in[LP_CHANNELS], per_span_in[LP_CHANNELS], black_out[LP_CHANNELS], span_out[LP_CHANNELS];
    float black_code[LP_CHANNELS], code_span[LP_CHANNELS]; /* code of black, and of white less black */
    float near_white;                                      /* a code below which no sample is nearly saturated */
    float largest_code;                                    /* integer output is clipped there: the code of white */
};
#endif

struct lensprof_plan {
    lp_row_kernel *row;
    uint32_t source_sample, target_sample, layout;
    uint32_t samples, channels; /* of a pixel; colour channels */
    uint32_t decode, encode;    /* lp_curve */
    uint32_t simulate, dither;
    uint32_t chroma;        /* M of a channel is relative to that of luminance; the gains are then 3 */
    uint32_t neutral_white; /* LENSPROF_SATURATED_NEUTRAL is in force */
    uint32_t frame_width, frame_height;
    uint32_t gains;     /* 1 if all channels have the same gain, else 3 */
    uint32_t curves;    /* 1 or 3 */
    uint8_t site[2][2]; /* channel by row and column parity, of mosaics */
    uint8_t channel_of_sample[4];
    int32_t center_px[2];      /* of the falloff: whole pixels, */
    float center_part[2];      /* and the rest, -1/2..1/2, which single precision holds better */
    float k[LP_CHANNELS][3];   /* 1 + k1 r2 + ..., r2 in px^2 */
    float least, strength;     /* of the attenuation, after the gain cap; of the grid's part */
    float factor[LP_CHANNELS]; /* target over source exposure, and the units of linear codes */
    float times[LP_CHANNELS];  /* the same if the gain is otherwise that of all channels; else 1 */
#if LP_HAS_LEVELS
    struct lp_plan_levels levels;
#endif
#if LP_HAS_CIRCLE
    lensprof_image_circle circle; /* outside of it M is 1; radius 0 = none */
#endif
    float exponent[LP_CHANNELS]; /* of the response, for LP_CURVE_POWER and _MIXED; else 0 */
    float inverse_exponent[LP_CHANNELS];
    uint32_t columns, rows;          /* of the gain grid; 0 = none */
    uint32_t inverse_shift;          /* log2 of the codes that `inverse` has an entry for */
    const float *nodes[LP_CHANNELS]; /* attenuation less 1 */
    const float *forward;            /* curves x 1024 samples of f, and one number more */
    const float *backward;           /* the same for the input, for g of values; may be `forward` */
    const float *inverse;            /* curves x codes of g; NULL if not used */
    const uint16_t *start;           /* for g of values: curves x LP_CELLS + 1, the last sample below cell / LP_CELLS */
    int32_t step; /* the first step from there up the samples is this, then half of it, ...; 0 if a cell has <= 2 */
};

/* What the kernels do with the levels. */
static inline uint32_t lp_level_steps(const lensprof_plan *plan) {
#if LP_HAS_LEVELS
    return plan->levels.steps;
#else
    (void)plan;
    return 0;
#endif
}

/* The columns of a row of the frame in which the falloff holds, in columns[2]; NULL = all. */
static inline const uint32_t *lp_columns_inside(const lensprof_plan *plan, uint32_t y, uint32_t *columns) {
#if LP_HAS_CIRCLE
    if (plan->circle.radius > 0.0) {
        lp_image_circle_columns(&plan->circle, plan->frame_width, plan->frame_height, y, &columns[0], &columns[1]);
        return columns;
    }
#endif
    (void)plan, (void)y, (void)columns;
    return NULL;
}

/* The kernels. Each gives the same bytes. */
lp_row_kernel lp_row_scalar, lp_row_sse41, lp_row_avx2, lp_row_avx512, lp_row_gathers, lp_row_neon;

/* The fastest kernel that this processor supports, with at most `lanes` lanes, 0 = any. lp_row_gathers only with 0. */
lp_row_kernel *lp_row_best(uint32_t lanes);

#endif
