/* Options of plans: their validation, and the model they contain, in the caller's structs or in a blob. */
#ifndef LENSPROF_CORE_OPTIONS_H
#define LENSPROF_CORE_OPTIONS_H

#include "core/blob.h"
#include "core/image.h"
#include "core/levels.h"
#include "core/sized.h"

#define LP_LARGEST_GAIN_CAP 1e6 /* over all attenuations that are allowed */

/* Text of CAPACITY for the memory of a plan. Texts are short here because they are in the flash memory of cameras. */
#define LP_MEMORY_TEXT "memory is too small or unaligned"

/* Converts the caller's options, of any version, to this library's: OK or STRUCT_SIZE. */
lensprof_status lp_options_take(const lensprof_apply_options *given, lensprof_apply_options *options);

/* The model. For structs, checks only what its size depends on; the vignetting may not be set yet. */
lensprof_status lp_options_model(const lensprof_apply_options *options, lp_model *model);

/* The status and text that lensprof_plan_init returns for the caller's options; also these options in this library's
 * version, and their model. */
lensprof_status lp_options_validate(const lensprof_apply_options *given, lensprof_apply_options *options,
                                    lp_model *model, lensprof_error *error);

/* The response with which pixels are encoded, for input and for output. Grey is treated as green. */
enum lp_end {
    LP_INPUT,
    LP_OUTPUT
};
uint32_t lp_curves(const lensprof_apply_options *options, const lp_model *model);
const struct lp_model_response *lp_response(const lensprof_apply_options *options, const lp_model *model,
                                            enum lp_end end, uint32_t curve);

/* Levels of the input or output, which may be none. */
const lensprof_levels *lp_levels_of(const lp_model *model, enum lp_end end);

static inline int lp_model_has_levels(const lp_model *m) {
    return LP_HAS_LEVELS && (lp_has_levels(lp_levels_of(m, LP_INPUT)) || lp_has_levels(lp_levels_of(m, LP_OUTPUT)));
}

/* Whether a response is a power of light (including the first power) rather than a table. */
static inline int lp_is_power(const struct lp_model_response *response) {
    return response->kind == LENSPROF_RESPONSE_LINEAR || response->kind == LENSPROF_RESPONSE_GAMMA;
}

/* g(b), as lensprof_response_invert. */
double lp_model_invert(const struct lp_model_response *response, double b);

/* Centre of the falloff, px from the middle of the frame's first pixel; across for axis 0, down for 1. */
double lp_center(const lensprof_apply_options *options, const lp_model *model, int axis);

/* Target over source exposure of a channel. */
double lp_exposure_ratio(const lensprof_apply_options *options, uint32_t channel);

/* Whether LENSPROF_SATURATED_NEUTRAL applies to encoded pixels of three channels. */
static inline int lp_is_neutral_white(const lensprof_apply_options *o) {
    return o->saturated == LENSPROF_SATURATED_NEUTRAL && o->direction != LENSPROF_DIRECTION_SIMULATE
           && lensprof_layout_channels(o->source_layout) == 3 && !lp_is_mosaic(o->source_layout)
           && o->input == LENSPROF_ENCODING_RESPONSE && o->output == LENSPROF_ENCODING_RESPONSE;
}

/* The sample at which the output of pictures with levels is clipped: white. So that clipped highlights of linear output
 * are neutral (LENSPROF_SATURATED_NEUTRAL), it is that of a saturated sample of the channel with the least exposure
 * ratio, where this is less. */
double lp_highlight_level(const lensprof_apply_options *options, const lp_model *model, int is_linear);

#endif
