/* lensprof/packed.h - rows of a raw sensor as MIPI CSI-2 sends them: 8, 10, 12 or 14 bits per sample, packed.
 *
 * Example: a frame of a sensor with 10 bits, corrected in place.
 *
 *     static uint64_t memory[128];
 *     static uint8_t sensor[480 * 640 * 5 / 4];
 *     const lensprof_packed_target frame = {sensor, 640 * 5 / 4, 640, 480};
 *     const lensprof_plan *plan;
 *     lensprof_apply_options options;
 *     lensprof_apply_options_init(&options);
 *     options.frame_width = frame.width, options.frame_height = frame.height;
 *     options.source_sample = options.target_sample = LENSPROF_SAMPLE_U16;
 *     options.source_layout = LENSPROF_LAYOUT_RGGB;
 *     options.input = options.output = LENSPROF_ENCODING_LINEAR;
 *     status = lensprof_apply_options_set_profile(&options, &profile);
 *     if (status == LENSPROF_OK) status = lensprof_plan_init(memory, sizeof memory, &options, &plan, &error);
 *     if (status == LENSPROF_OK)
 *         status = lensprof_apply_packed(plan, LENSPROF_PACKING_RAW10, NULL, &frame, 0, 0);
 *
 * A group begins with the 8 high bits of each of its samples a, b, ... Their low bits follow, from bit 0 of the first
 * byte upwards:
 *
 *            bytes of a group, the low bits from bit 7 to bit 0
 *     RAW10  A  B  C  D  d1d0c1c0b1b0a1a0
 *     RAW12  A  B  b3b2b1b0a3a2a1a0
 *     RAW14  A  B  C  D  b1b0a5a4a3a2a1a0  c3c2c1c0b5b4b3b2  d5d4d3d2d1d0c5c4
 *
 * These are V4L2_PIX_FMT_SRGGB10P, _SRGGB12P and _SRGGB14P of Linux, by docs.kernel.org/userspace-api/media/v4l:
 * pixfmt-srggb10p.html, pixfmt-srggb12p.html, pixfmt-srggb14p.html. (The first page of Linux 4.8 has the low bits in
 * the opposite order, which later versions correct.)
 *
 * Samples are codes 0..2^bits - 1 in 16 bits, so a level (lensprof_levels) is its code divided by 65535. No heap, no
 * I/O, no floating point but that of the plan. Threads: a plan may be used by several threads on different tiles. */
#ifndef LENSPROF_PACKED_H
#define LENSPROF_PACKED_H

#include "fixed.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bits per sample. */
typedef enum lensprof_packing {
    LENSPROF_PACKING_RAW8 = 8,   /* a byte per sample */
    LENSPROF_PACKING_RAW10 = 10, /* groups of 4 samples in 5 bytes */
    LENSPROF_PACKING_RAW12 = 12, /* 2 in 3 */
    LENSPROF_PACKING_RAW14 = 14  /* 4 in 7 */
} lensprof_packing;

/* Bytes of a row; 0 if the packing is unknown, or width is 0, above 2^20 or not a whole number of groups. */
LENSPROF_API size_t lensprof_packed_row_bytes(uint32_t packing, uint32_t width);

/* The codes of a row: lensprof_packed_row_bytes bytes, at any address, become samples[width]. The two must not overlap.
 * Errors: ARGUMENT for NULL and an unknown packing; SIZE for a width that has no bytes. Nothing is written then. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_unpack_row(uint32_t packing, const uint8_t *packed,
                                                                   uint32_t width, uint16_t *samples);

/* The inverse. Codes above 2^bits - 1 become 2^bits - 1. Errors: as above. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pack_row(uint32_t packing, const uint16_t *samples,
                                                                 uint32_t width, uint8_t *packed);

/* A view of packed rows owned by the caller, at any address, which are only read. Frozen value struct. */
typedef struct lensprof_packed_image {
    const void *data;       /* first group of the view */
    ptrdiff_t row_bytes;    /* from one row to the next; may be larger than the row; negative for bottom-up images */
    uint32_t width, height; /* in samples */
} lensprof_packed_image;

/* The same of rows that are written. Frozen value struct. */
typedef struct lensprof_packed_target {
    void *data;
    ptrdiff_t row_bytes;
    uint32_t width, height;
} lensprof_packed_target;

/* Applies a plan of U16 samples, in and out, and of layout GREY or a mosaic to a tile of packed rows whose first sample
 * is pixel (x0, y0) of the frame, which may be any. source NULL: in place; otherwise as for lensprof_apply. The result
 * has the bytes that lensprof_unpack_row, lensprof_apply and lensprof_pack_row give. Plans should be linear: a response
 * covers 0..65535, not the codes of a sensor. Bytes between rows are not touched. Takes 384 bytes of stack more than
 * lensprof_apply. Errors: ARGUMENT for NULL, an unknown packing, another plan and overlapping views; SIZE for views
 * that are not whole groups, differ in size or do not fit the frame. Nothing is written then. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_apply_packed(const lensprof_plan *plan, uint32_t packing,
                                                                     const lensprof_packed_image *source,
                                                                     const lensprof_packed_target *target, uint32_t x0,
                                                                     uint32_t y0);

/* As lensprof_apply_packed, in integers. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fixed_apply_packed(const lensprof_fixed_plan *plan,
                                                                           uint32_t packing,
                                                                           const lensprof_packed_image *source,
                                                                           const lensprof_packed_target *target,
                                                                           uint32_t x0, uint32_t y0);

#ifdef __cplusplus
}
#endif
#endif
