/* lensprof/fixed.h - the work of apply.h in integers alone, for processors without a floating-point unit.
 *
 * Light and gains are logarithms: taking out falloff and exposure is one addition a sample, and a grey value is found
 * among the thresholds between grey values. Results are within 1 level of those in double precision.
 *
 *   log2 g(B) + log2(e' w' / (e w)) - log2 M   ->   the grey value whose light that is     apply.h, correct
 *
 * A plan is prepared with floating point (software will do: some 100 ms on a Cortex-M0+ at 48 MHz), or on another
 * machine and copied: it holds no address. Pixels then need no floating point, no heap, no I/O, and at most 512 bytes
 * of stack; lensprof_fixed_plan_init takes up to 2 KiB. Formats: U8 and U16 in layouts GREY to BGRA and mosaics, the
 * sample type written being the one read; U16 where input and output are linear (by their encoding, or because the
 * response is). A plan takes about 150 bytes, and for U8 2 KiB more a response. No gain grid, no dither, no planes:
 * UNSUPPORTED. Threads: a plan is immutable after init and may be used by several threads on different tiles. */
#ifndef LENSPROF_FIXED_H
#define LENSPROF_FIXED_H

#include "apply.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lensprof_fixed_plan lensprof_fixed_plan;

/* Bytes of memory that lensprof_fixed_plan_init needs for these options; 0 when they are invalid or not supported. */
LENSPROF_API size_t lensprof_fixed_plan_bytes(const lensprof_apply_options *options);

/* Prepares a plan in memory[size] (4-byte aligned, owned by the caller, must outlive the plan). Errors: as
 * lensprof_plan_init, and UNSUPPORTED for formats and options that are not in the list above and for a falloff whose
 * |k1| + |k2| + |k3|, each times its power of the frame's reach, is beyond 500, which integers do not hold. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fixed_plan_init(void *memory, size_t size,
                                                                        const lensprof_apply_options *options,
                                                                        const lensprof_fixed_plan **plan,
                                                                        lensprof_error *error);

/* A plan that was prepared elsewhere: the lensprof_fixed_plan_bytes bytes of its memory, copied to data[size]
 * (4-byte aligned; may be read-only), on machines of one byte order. Errors: NULL or unaligned ARGUMENT, fewer bytes
 * than the plan has CAPACITY, of another version LAYOUT, damaged CORRUPT (by its CRC-32, or because no plan holds such
 * numbers: a plan that opens is safe to apply, whoever made its bytes). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fixed_plan_open(const void *data, size_t size,
                                                                        const lensprof_fixed_plan **plan);

/* As lensprof_apply. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fixed_apply(const lensprof_fixed_plan *plan,
                                                                    const lensprof_image *source,
                                                                    const lensprof_image *target, uint32_t x0,
                                                                    uint32_t y0);

#ifdef __cplusplus
}
#endif
#endif
