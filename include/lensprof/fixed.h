/* lensprof/fixed.h - apply.h in integer arithmetic, for processors without a floating-point unit.
 *
 * Example: a picture corrected without floating point, but for the plan.
 *
 *     static uint32_t memory[2048];
 *     const lensprof_fixed_plan *plan;
 *     lensprof_apply_options options;
 *     lensprof_apply_options_init(&options); // 8 bit RGB
 *     options.frame_width = picture.width, options.frame_height = picture.height;
 *     status = lensprof_apply_options_set_profile(&options, &profile);
 *     if (status == LENSPROF_OK) status = lensprof_fixed_plan_init(memory, sizeof memory, &options, &plan, &error);
 *     if (status == LENSPROF_OK) status = lensprof_fixed_apply(plan, NULL, &picture, 0, 0);
 *
 * Light and gains are logarithms: removing falloff and exposure is one addition per sample. From 8 to 8 bit, a search
 * among the thresholds between grey values follows; otherwise curves are evaluated. Results are within 1 level of those
 * in double precision; in 16 bit, for a gamma of the input up to 5 and an output with x f'(x) up to 5, which concave
 * responses have up to 1 and gamma has up to 1 / gamma.
 *
 *   log2 g(B) + log2(e' w' / (e w)) - log2 M   ->   the grey value with that light        apply.h, correct
 *
 * A plan is prepared with floating point (in software: some 100 ms on a Cortex-M0+ at 48 MHz), or on another machine
 * and copied, as it contains no address. Processing pixels then needs no floating point, no heap, no I/O, and at
 * most 512 bytes of stack; lensprof_fixed_plan_init takes up to 2 KiB. Formats: U8 and U16 in layouts GREY to BGRA
 * and mosaics, from either type to either, encoded or linear. Black and white levels count in 1 / 256 of a code. A
 * plan takes about 250 bytes, and 4 per node of a gain grid (in frames of up to 65535 px a side). From U8 to U8 it
 * takes 2 KiB more per response, unless it is linear and has levels; otherwise 4 KiB more for each response with
 * samples (TABLE, EMOR) of the input, and of the output unless that is encoded in the same way, and 20 bytes for
 * each that is linear or GAMMA. Image circles, dither and planes are UNSUPPORTED. Threads: a plan is immutable after
 * init and may be used by several threads on different tiles.
 *
 * Companded samples of a sensor, here of 12 bit, are a response: a table in, linear out.
 *
 *     static const double knees[] = {0.0, 0.5, 0.7, 0.8, 0.875, 0.925, 0.95, 0.975, 1.0}; // codes of light 0, 1/8, ..1
 *     lensprof_levels levels = {{240 / 65535.0, 240 / 65535.0, 240 / 65535.0}, 4095 / 65535.0};
 *     status = lensprof_response_set_table(&profile.response[0], knees, 9);
 *     options.source_sample = LENSPROF_SAMPLE_U16, options.levels = &levels;
 *     options.target_sample = LENSPROF_SAMPLE_U16, options.output = LENSPROF_ENCODING_LINEAR; // 65535 is white
 */
#ifndef LENSPROF_FIXED_H
#define LENSPROF_FIXED_H

#include "apply.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lensprof_fixed_plan lensprof_fixed_plan;

/* Bytes of memory that lensprof_fixed_plan_init needs for these options; 0 if they are invalid or unsupported. */
LENSPROF_API size_t lensprof_fixed_plan_bytes(const lensprof_apply_options *options);

/* Prepares a plan in memory[size] (4-byte aligned, owned by the caller, must outlive the plan). Errors: as
 * lensprof_plan_init; UNSUPPORTED for formats and options not listed above, and for a falloff whose |k1| + |k2| + |k3|,
 * each times its power of the largest radius in the frame, exceeds 500, which the integers cannot represent. M, times a
 * gain grid, counts as 0.0005 if it is less. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fixed_plan_init(void *memory, size_t size,
                                                                        const lensprof_apply_options *options,
                                                                        const lensprof_fixed_plan **plan,
                                                                        lensprof_error *error);

/* Opens a plan that was prepared elsewhere: the lensprof_fixed_plan_bytes bytes of its memory, copied to data[size]
 * (4-byte aligned; may be read-only), on a machine of the same byte order. Errors: ARGUMENT for NULL or unaligned data;
 * CAPACITY for fewer bytes than the plan has; LAYOUT for another version; CORRUPT for damage, detected by the CRC-32 or
 * by values that no plan has. A plan that opens is safe to apply, whatever the origin of its bytes. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fixed_plan_open(const void *data, size_t size,
                                                                        const lensprof_fixed_plan **plan);

/* As lensprof_apply. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fixed_apply(const lensprof_fixed_plan *plan,
                                                                    const lensprof_image *source,
                                                                    const lensprof_target *target, uint32_t x0,
                                                                    uint32_t y0);

#ifdef __cplusplus
}
#endif
#endif
