/* Applies plans to tiles (lensprof/apply.h): checks before a kernel runs, and the rows passed to it. */
#include "core/plan.h"

#define STREAMED ((size_t)8 << 20) /* bytes of a float target to keep out of the caches; other types do not benefit */

static lensprof_status validate_tile(const lensprof_plan *plan, const lensprof_image *source,
                                     const lensprof_image *target, uint32_t layout, uint32_t x0, uint32_t y0) {
    const lp_tiles tiles = {plan->source_sample, plan->target_sample, layout, plan->frame_width, plan->frame_height};
    return lp_tile_validate(&tiles, source, target, x0, y0);
}

/* Valid views: a source that does not overlap its target, or is the same. */
static void apply_rows(const lensprof_plan *plan, const lensprof_image *source, const lensprof_target *target,
                       uint32_t planes, uint32_t x0, uint32_t y0) {
    const size_t bytes =
        (size_t)target->width * target->height * plan->samples * lensprof_sample_type_bytes(target->sample);
    const int stream = bytes >= STREAMED && target->sample == LENSPROF_SAMPLE_F32 && source->data != target->data;
    for (uint32_t y = 0; y < source->height; y++) {
        const uint8_t *from[3] = {NULL, NULL, NULL};
        uint8_t *to[3] = {NULL, NULL, NULL};
        for (uint32_t p = 0; p < planes; p++) {
            from[p] = (const uint8_t *)source[p].data + (ptrdiff_t)y * source[p].row_bytes;
            to[p] = (uint8_t *)target[p].data + (ptrdiff_t)y * target[p].row_bytes;
        }
        uint32_t columns[2];
        plan->row(plan, from, to, x0, y0 + y, source->width, lp_columns_inside(plan, y0 + y, columns), stream);
    }
}

lensprof_status lensprof_apply(const lensprof_plan *plan, const lensprof_image *source, const lensprof_target *target,
                               uint32_t x0, uint32_t y0) {
    if (!plan || !target || plan->layout == LENSPROF_LAYOUT_PLANAR) return LENSPROF_ERROR_ARGUMENT;
    const lensprof_image written = lp_image_of(target);
    if (!source) source = &written;
    lensprof_status status = validate_tile(plan, source, &written, plan->layout, x0, y0);
    if (status == LENSPROF_OK) apply_rows(plan, source, target, 1, x0, y0);
    return status;
}

lensprof_status lensprof_apply_planar(const lensprof_plan *plan, const lensprof_image source[3],
                                      const lensprof_target target[3], uint32_t x0, uint32_t y0) {
    if (!plan || !target || plan->layout != LENSPROF_LAYOUT_PLANAR) return LENSPROF_ERROR_ARGUMENT;
    const lensprof_image written[3] = {lp_image_of(target), lp_image_of(target + 1), lp_image_of(target + 2)};
    if (!source) source = written;
    for (uint32_t p = 0; p < 3; p++) {
        const lensprof_status status = validate_tile(plan, &source[p], &written[p], LENSPROF_LAYOUT_GREY, x0, y0);
        if (status != LENSPROF_OK) return status;
        if (source[p].width != source->width || source[p].height != source->height) return LENSPROF_ERROR_SIZE;
    }
    for (uint32_t p = 0; p < 3; p++) /* views are compared only if all six are valid: sizes do not overflow then */
        for (uint32_t other = 0; other < 3; other++)
            if (other != p
                && (lp_images_overlap(&written[p], &source[other]) || lp_images_overlap(&written[p], &written[other])))
                return LENSPROF_ERROR_ARGUMENT;
    apply_rows(plan, source, target, 3, x0, y0);
    return LENSPROF_OK;
}
