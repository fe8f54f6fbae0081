/* Views of pixels: sample types, layouts, and the tiles to which a plan may be applied. */
#include "core/image.h"

#include <string.h>

#define LARGEST_ROW ((ptrdiff_t)1 << 28) /* bytes; times LP_LARGEST_SIDE rows it fits into an address */

/* ---- formats ---- */

uint32_t lensprof_layout_samples(uint32_t layout) {
    static const uint8_t samples[] = {1, 2, 3, 4, 3, 4, 1, 1, 1, 1, 1};
    return layout < sizeof samples ? samples[layout] : 0;
}

uint32_t lensprof_layout_channels(uint32_t layout) {
    static const uint8_t channels[] = {1, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3};
    return layout < sizeof channels ? channels[layout] : 0;
}

uint32_t lensprof_sample_type_bytes(uint32_t sample) {
    static const uint8_t bytes[] = {1, 2, 4, 2};
    return sample < sizeof bytes ? bytes[sample] : 0;
}

lensprof_status lensprof_image_validate(const lensprof_image *image) {
    if (!image || !image->data) return LENSPROF_ERROR_ARGUMENT;
    uint32_t bytes = lensprof_sample_type_bytes(image->sample), samples = lensprof_layout_samples(image->layout);
    if (!bytes || !samples || image->layout == LENSPROF_LAYOUT_PLANAR) return LENSPROF_ERROR_ARGUMENT;
    if (!image->width || !image->height || image->width > LP_LARGEST_SIDE || image->height > LP_LARGEST_SIDE)
        return LENSPROF_ERROR_SIZE;
    if (image->row_bytes > LARGEST_ROW || image->row_bytes < -LARGEST_ROW) return LENSPROF_ERROR_SIZE;
    int64_t row = image->row_bytes < 0 ? -(int64_t)image->row_bytes : (int64_t)image->row_bytes;
    if (row < (int64_t)image->width * samples * bytes && image->height > 1) return LENSPROF_ERROR_SIZE;
    if (row * image->height > PTRDIFF_MAX) return LENSPROF_ERROR_SIZE; /* if addresses have 32 bits */
    if ((uintptr_t)image->data % bytes || (row & (bytes - 1))) return LENSPROF_ERROR_ARGUMENT;
    return LENSPROF_OK;
}

int lp_is_mosaic(uint32_t layout) { return layout >= LENSPROF_LAYOUT_RGGB && layout <= LENSPROF_LAYOUT_BGGR; }

void lp_layout_sites(uint32_t layout, uint8_t channel_of_sample[4], uint8_t site[2][2]) {
    static const uint8_t sites[4][2][2] = {{{0, 1}, {1, 2}}, {{1, 0}, {2, 1}}, {{1, 2}, {0, 1}}, {{2, 1}, {1, 0}}};
    const int reversed = layout == LENSPROF_LAYOUT_BGR || layout == LENSPROF_LAYOUT_BGRA;
    for (uint8_t s = 0; s < 4; s++)
        channel_of_sample[s] = s >= lensprof_layout_channels(layout) ? LP_ALPHA
                               : reversed && s < 3                   ? (uint8_t)(2 - s)
                                                                     : s;
    if (lp_is_mosaic(layout)) memcpy(site, sites[layout - LENSPROF_LAYOUT_RGGB], sizeof sites[0]);
}

/* ---- tiles ---- */

/* First and last byte that a view covers. */
static void extent(const lensprof_image *image, uintptr_t *first, uintptr_t *last) {
    uintptr_t top = (uintptr_t)image->data;
    uintptr_t bottom = top + (uintptr_t)((intptr_t)(image->height - 1) * image->row_bytes);
    uintptr_t row =
        (uintptr_t)image->width * lensprof_layout_samples(image->layout) * lensprof_sample_type_bytes(image->sample);
    *first = top < bottom ? top : bottom;
    *last = (top < bottom ? bottom : top) + row - 1;
}

int lp_images_overlap(const lensprof_image *a, const lensprof_image *b) {
    uintptr_t a0, a1, b0, b1;
    extent(a, &a0, &a1);
    extent(b, &b0, &b1);
    return !(a1 < b0 || b1 < a0);
}

/* The same memory, row by row and sample by sample. */
static int is_in_place(const lensprof_image *source, const lensprof_image *target) {
    return source->data == target->data && source->row_bytes == target->row_bytes && source->sample == target->sample;
}

lensprof_status lp_tile_validate(const lp_tiles *tiles, const lensprof_image *source, const lensprof_image *target,
                                 uint32_t x0, uint32_t y0) {
    lensprof_status status = lensprof_image_validate(source);
    if (status == LENSPROF_OK) status = lensprof_image_validate(target);
    if (status != LENSPROF_OK) return status;
    if (source->sample != tiles->source_sample || target->sample != tiles->target_sample
        || source->layout != tiles->layout || target->layout != tiles->layout)
        return LENSPROF_ERROR_ARGUMENT;
    if (source->width != target->width || source->height != target->height) return LENSPROF_ERROR_SIZE;
    if (x0 > tiles->frame_width || source->width > tiles->frame_width - x0 || y0 > tiles->frame_height
        || source->height > tiles->frame_height - y0)
        return LENSPROF_ERROR_SIZE;
    return is_in_place(source, target) || !lp_images_overlap(source, target) ? LENSPROF_OK : LENSPROF_ERROR_ARGUMENT;
}
