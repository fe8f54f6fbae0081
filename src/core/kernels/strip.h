/* What the steps of a row kernel work on: a strip of pixels that stays in the first cache. A lanes_*.h comes first. */
#include "core/plan.h"

#if defined(__GNUC__)
#define ALWAYS_INLINE static inline __attribute__((always_inline))
#else
#define ALWAYS_INLINE static inline
#endif

#if defined(__GNUC__)
#define NEVER_INLINE __attribute__((noinline))
#else
#define NEVER_INLINE
#endif

/* Of one lane, which microcontrollers run, the code is to be small. */
#if LANES > 1
#define ONCE_IN_SCALAR ALWAYS_INLINE
#define ALIGNED_TO_VECTORS _Alignas(4 * LANES)
#else
#define ONCE_IN_SCALAR static
#define ALIGNED_TO_VECTORS
#endif

#define LAST (LENSPROF_RESPONSE_SAMPLES - 1)
#define MOST_SAMPLES (4 * STRIP)
#define ROOM (MOST_SAMPLES + LANES) /* the last vector of a strip may go beyond */

/* Planes stand STRIP + LANES apart on it. */
typedef struct strip {
    float gain[LP_CHANNELS][STRIP + LANES]; /* of the pixels */
    union {
        int32_t channel[ROOM]; /* of the samples, where the channels have curves of their own */
        int32_t place[ROOM];   /* of the samples in a table, where they have one curve */
    };
    /* In this order: the vector beyond each array's samples keeps one index of two arrays from lying exactly 4 KiB
     * apart, where processors take a load for one of what was just stored. */
    float light[ROOM];
    float factor[ROOM];   /* of the samples */
    float rounding[ROOM]; /* added before a code is cut to an integer, with dither */
    uint8_t alpha[STRIP][4];
    float grid[LP_CHANNELS][LENSPROF_GRID_SIDE + 1];
#ifdef IN_TABLE
    float guess[3][IN_TABLE]; /* of places in the response's samples: see guess.h */
    int is_guessed;
#endif
} strip;

/* Contiguous samples, in memory and on the strip. */
typedef struct run {
    const uint8_t *from;
    uint8_t *to;
    uint32_t at, count;
} run;
