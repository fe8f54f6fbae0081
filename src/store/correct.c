/* lensprof_correct: the plan of one picture, with memory of its own. */
#include <lensprof/store.h>

#include <stdlib.h>

#include "core/fail.h"
#include "core/image.h"

/* The whole picture, its samples unchanged in type and layout. */
static lensprof_status options_of(const lensprof_profile *profile, const lensprof_exposure *exposure,
                                  const lensprof_target *picture, lensprof_apply_options *options) {
    lensprof_apply_options_init(options);
    options->frame_width = picture->width, options->frame_height = picture->height;
    options->source_sample = options->target_sample = picture->sample;
    options->source_layout = picture->layout;
    if (exposure) options->source = *exposure;
    return lensprof_apply_options_set_profile(options, profile);
}

lensprof_status lensprof_correct(const lensprof_profile *profile, const lensprof_exposure *exposure,
                                 const lensprof_target *picture, lensprof_error *error) {
    lensprof_apply_options options;
    const lensprof_plan *plan = NULL;
    if (!profile || !picture) return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "profile or picture is NULL; pass both");
    if (picture->layout == LENSPROF_LAYOUT_PLANAR)
        return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "planes need a plan; use lensprof_apply_planar");
    const lensprof_image read = lp_image_of(picture);
    lensprof_status status = lensprof_image_validate(&read);
    if (status != LENSPROF_OK) return lp_fail(error, status, "the picture is invalid; see lensprof_image_validate");
    status = options_of(profile, exposure, picture, &options);
    if (status != LENSPROF_OK)
        return lp_fail(error, status, "the profile is not initialised; call lensprof_profile_init first");
    const size_t size = lensprof_plan_bytes(&options);
    void *memory = malloc(size ? size : 1);
    if (!memory) return lp_fail(error, LENSPROF_ERROR_MEMORY, "out of memory");
    status = lensprof_plan_init(memory, size, &options, &plan, error);
    if (status == LENSPROF_OK) status = lensprof_apply(plan, NULL, picture, 0, 0);
    free(memory);
    return status;
}
