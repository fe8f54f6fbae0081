/* Packed rows for plans of either kind. Each kind has an object file of its own, so that a program links one only. */
#ifndef LENSPROF_CORE_PACKED_H
#define LENSPROF_CORE_PACKED_H

#include <lensprof/packed.h>

#include "core/image.h"

/* A plan, and how it is applied in place to U16 samples at pixel (x0, y0) of the frame. `apply` must refuse them, and
 * write nothing, if the plan is of other samples. */
typedef struct lp_packed_plan {
    const void *plan;
    uint32_t layout, frame_width, frame_height;
    lensprof_status (*apply)(const void *plan, const lensprof_target *samples, uint32_t x0, uint32_t y0);
} lp_packed_plan;

/* lensprof_apply_packed of this plan. */
lensprof_status lp_apply_packed(const lp_packed_plan *plan, uint32_t packing, const lensprof_packed_image *source,
                                const lensprof_packed_target *target, uint32_t x0, uint32_t y0);

#endif
