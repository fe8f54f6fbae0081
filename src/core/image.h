/* Views of pixels, and the tiles that a plan accepts. */
#ifndef LENSPROF_CORE_IMAGE_H
#define LENSPROF_CORE_IMAGE_H

#include <lensprof/apply.h>

#define LP_LARGEST_SIDE (1u << 20) /* px */
#define LP_CHANNELS 3
#define LP_ALPHA 3 /* instead of a channel */

/* A layout of one sample per pixel, with the channel given by row and column. */
int lp_is_mosaic(uint32_t layout);

/* Channels of a layout: by the samples of a pixel, and by row and column parity if it is a mosaic. */
void lp_layout_sites(uint32_t layout, uint8_t channel_of_sample[4], uint8_t site[2][2]);

/* Requirements for the tiles of a plan. */
typedef struct lp_tiles {
    uint32_t source_sample, target_sample, layout, frame_width, frame_height;
} lp_tiles;

/* Whether a plan may be applied to a tile; the status is that of lensprof_apply. */
lensprof_status lp_tile_validate(const lp_tiles *tiles, const lensprof_image *source, const lensprof_image *target,
                                 uint32_t x0, uint32_t y0);

/* Whether the byte ranges of two valid views, from the first to the last sample, overlap. */
int lp_images_overlap(const lensprof_image *a, const lensprof_image *b);

/* The pixels of a target, for what only compares or reads them. */
static inline lensprof_image lp_image_of(const lensprof_target *t) {
    return (lensprof_image){t->data, t->row_bytes, t->width, t->height, t->sample, t->layout};
}

#endif
