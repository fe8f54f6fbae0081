/* The data of a row kernel's steps: a strip of pixels that fits into the first cache. A lanes_*.h comes first. */
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

/* With one lane, which microcontrollers run, the code must be small. */
#if LANES > 1
#define ONCE_IN_SCALAR ALWAYS_INLINE
#define ALIGNED_TO_VECTORS _Alignas(4 * LANES)
#else
#define ONCE_IN_SCALAR static
#define ALIGNED_TO_VECTORS
#endif

#define LAST (LENSPROF_RESPONSE_SAMPLES - 1)
#define MOST_SAMPLES (4 * STRIP)
#define ROOM (MOST_SAMPLES + LANES) /* the last vector of a strip may extend beyond */

/* Distance of its planes: STRIP + LANES. */
typedef struct strip {
    float gain[LP_CHANNELS][STRIP + LANES]; /* of the pixels */
    union {
        int32_t channel[ROOM]; /* of the samples, if the channels have curves of their own */
        int32_t place[ROOM];   /* of the samples in a table, if the channels have one curve */
    };
    /* Keep this order: the extra vector after each array's samples prevents one index of two arrays from being
     * exactly 4 KiB apart, at which distance processors mistake a load for one of data just stored. */
    float light[ROOM];
    float factor[ROOM];   /* of the samples */
    float rounding[ROOM]; /* added before a code is truncated to an integer, with dither */
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

#ifdef FAST_GATHERS
#define FETCHES_TARGET 1 /* lines are fetched to be written, which streams do not need */
#else
#define FETCHES_TARGET 0
#endif

/* Fetches a line of samples to be read soon, those of the next strip if pixels are three floats, and the line to write
 * them to. The addresses may be past the end of a row, where a pointer would be undefined. */
ALWAYS_INLINE void fetch_ahead(const run *r, size_t byte) {
#if defined(__GNUC__)
    const size_t ahead = byte + 3 * STRIP * sizeof(float);
    __builtin_prefetch((const void *)((uintptr_t)r->from + ahead));
    if (FETCHES_TARGET) __builtin_prefetch((const void *)((uintptr_t)r->to + ahead), 1);
#else
    (void)r, (void)byte;
#endif
}
