/* Options of plans: their validation, and the model they contain, in the caller's structs or in a blob. */
#include "core/options.h"

#include <math.h>
#include <string.h>

#include "core/exposure.h"
#include "core/fail.h"
#include "core/levels.h"
#include "core/plan.h"
#include "core/profile.h"
#include "core/response.h"

#define FIRST_OPTIONS LP_END_OF(lensprof_apply_options, blob_bytes)

void lensprof_apply_options_init_sized(lensprof_apply_options *options, size_t size) {
    if (!lp_sized_begin(options, size, FIRST_OPTIONS)) return;
    options->source_layout = LENSPROF_LAYOUT_RGB;
    options->responses = options->vignettings = 1;
    options->strength = 1.0;
    lensprof_exposure_init(&options->source);
    lensprof_exposure_init(&options->target);
}

lensprof_status lensprof_apply_options_set_profile(lensprof_apply_options *options, const lensprof_profile *profile) {
    if (!options || !profile) return LENSPROF_ERROR_ARGUMENT;
    if (lp_sized_wrong(options, FIRST_OPTIONS, sizeof *options)
        || lp_sized_wrong(profile, LP_FIRST_PROFILE, sizeof *profile))
        return LENSPROF_ERROR_STRUCT_SIZE;
    const lensprof_levels levels = lp_profile_levels(profile);
    const int has_levels = lp_has_levels(&levels);
    const int has_circle = lp_profile_circle(profile).radius > 0.0;
    const int has_room = options->struct_size >= LP_END_OF(lensprof_apply_options, output_levels);
    const int has_room_for_circle = options->struct_size >= LP_END_OF(lensprof_apply_options, image_circle);
    if ((has_levels && !has_room) || (has_circle && !has_room_for_circle)) return LENSPROF_ERROR_UNSUPPORTED;
    options->responses = profile->responses;
    options->vignettings = profile->vignettings;
    options->response = profile->response;
    options->vignetting = profile->vignetting;
    options->grid = profile->grid.columns ? &profile->grid : NULL;
    options->blob = NULL;
    options->blob_bytes = 0;
    if (has_room) options->levels = options->output_levels = has_levels ? &profile->levels : NULL;
    if (has_room_for_circle) options->image_circle = has_circle ? &profile->image_circle : NULL;
    return LENSPROF_OK;
}

lensprof_status lp_options_take(const lensprof_apply_options *given, lensprof_apply_options *options) {
    lensprof_apply_options_init(options);
    return lp_sized_take(options, given, FIRST_OPTIONS) ? LENSPROF_ERROR_STRUCT_SIZE : LENSPROF_OK;
}

static void view_response(struct lp_model_response *view, const lensprof_response *response) {
    view->kind = response->kind;
    view->gamma = response->kind == LENSPROF_RESPONSE_GAMMA ? response->gamma : 1.0;
    view->table = response->table;
}

/* The model in the caller's structs. Its size does not depend on the vignetting, which may not be set yet. */
static lensprof_status view_structs(const lensprof_apply_options *o, lp_model *m) {
    memset(m, 0, sizeof *m);
    if (!o->response || (o->responses != 1 && o->responses != 3)) return LENSPROF_ERROR_ARGUMENT;
    m->responses = o->responses;
    m->vignettings = o->vignetting && (o->vignettings == 1 || o->vignettings == 3) ? o->vignettings : 0;
    for (uint32_t c = 0; c < m->responses; c++) view_response(&m->response[c], &o->response[c]);
    for (uint32_t c = 0; c < m->vignettings; c++) m->vignetting[c] = o->vignetting[c];
#if LP_HAS_CIRCLE
    if (o->image_circle) m->circle = *o->image_circle;
#endif
    if (!o->grid) return LENSPROF_OK;
    m->columns = o->grid->columns, m->rows = o->grid->rows, m->channels = o->grid->channels;
    m->attenuation = o->grid->attenuation;
    return lensprof_gain_grid_validate(o->grid);
}

static int is_output_stated(const lensprof_apply_options *o) {
    const uint32_t count = o->output_responses;
    return o->output_response ? count == 1 || count == 3 : !count;
}

static lensprof_status view_model(const lensprof_apply_options *o, lp_model *m) {
    if (!o->blob) return view_structs(o, m);
    if (o->response || o->vignetting || o->grid || o->image_circle) return LENSPROF_ERROR_ARGUMENT;
    lp_blob blob;
    return lp_blob_open(o->blob, o->blob_bytes, &blob, m);
}

lensprof_status lp_options_model(const lensprof_apply_options *o, lp_model *m) {
    if (!is_output_stated(o)) return LENSPROF_ERROR_ARGUMENT;
    const lensprof_status status = view_model(o, m);
#if LP_HAS_LEVELS
    if (o->levels || o->output_levels) { /* instead of a blob's */
        memset(m->levels, 0, sizeof m->levels);
        if (o->levels) m->levels[LP_INPUT] = *o->levels;
        if (o->output_levels) m->levels[LP_OUTPUT] = *o->output_levels;
    }
#endif
    m->outputs = o->output_responses;
    for (uint32_t c = 0; c < m->outputs; c++) view_response(&m->output[c], &o->output_response[c]);
    return status;
}

const lensprof_levels *lp_levels_of(const lp_model *m, enum lp_end end) {
#if LP_HAS_LEVELS
    return &m->levels[end];
#else
    static const lensprof_levels none;
    (void)m, (void)end;
    return &none;
#endif
}

/* Otherwise channels need tables of their own. */
static inline int has_one_black(const lensprof_levels *levels) {
    return levels->black[0] == levels->black[1] && levels->black[2] == levels->black[1];
}

uint32_t lp_curves(const lensprof_apply_options *o, const lp_model *m) {
    if (lensprof_layout_channels(o->source_layout) == 1) return 1;
    return m->responses == 3 || m->outputs == 3 || (LP_HAS_LEVELS && !has_one_black(lp_levels_of(m, LP_INPUT))) ? 3 : 1;
}

const struct lp_model_response *lp_response(const lensprof_apply_options *o, const lp_model *m, enum lp_end end,
                                            uint32_t curve) {
    const uint32_t channel = lensprof_layout_channels(o->source_layout) == 1 ? 1 : curve;
    const uint32_t outputs = end == LP_OUTPUT ? m->outputs : 0;
    if (outputs) return &m->output[outputs == 3 ? channel : 0];
    return &m->response[m->responses == 3 ? channel : 0];
}

double lp_model_invert(const struct lp_model_response *response, double b) {
    if (!(b > 0.0)) return 0.0;
    if (lp_is_power(response)) return lp_curve_power(b, response->gamma, NULL);
    uint32_t low = 0, high = LENSPROF_RESPONSE_SAMPLES - 1;
    if (b > lp_model_sample(response, high)) return 1.0;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (lp_model_sample(response, middle) < b)
            low = middle;
        else
            high = middle;
    }
    return lp_curve_between(lp_model_sample(response, low), lp_model_sample(response, high), b, low);
}

static lensprof_status validate_responses(const lensprof_response *response, uint32_t count, lensprof_error *error) {
    lensprof_status status = LENSPROF_OK;
    for (uint32_t c = 0; c < count && status == LENSPROF_OK; c++) status = lensprof_response_validate(&response[c]);
    return status == LENSPROF_OK ? status : lp_fail(error, status, "a response is invalid");
}

static lensprof_status validate_curves(const lensprof_apply_options *o, lensprof_error *error) {
    lensprof_status status = validate_responses(o->response, o->responses, error);
    if (status != LENSPROF_OK) return status;
    for (uint32_t c = 0; c < o->vignettings && status == LENSPROF_OK; c++)
        status = lensprof_vignetting_validate(&o->vignetting[c]);
    if (status != LENSPROF_OK) return lp_fail(error, status, "M below 0.001; fix k1 to k3");
    for (uint32_t c = 1; c < o->vignettings; c++)
        if (o->vignetting[c].center[0] != o->vignetting[0].center[0]
            || o->vignetting[c].center[1] != o->vignetting[0].center[1])
            return lp_fail(error, LENSPROF_ERROR_VIGNETTING, "vignettings differ in centre");
    return LENSPROF_OK;
}

/* The model in the caller's structs; lp_options_model checks the grid, and all of a blob. */
static lensprof_status validate_structs(const lensprof_apply_options *o, lensprof_error *error) {
    if (!o->response || !o->vignetting || (o->responses != 1 && o->responses != 3)
        || (o->vignettings != 1 && o->vignettings != 3))
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "no model: 1 or 3 curves each, or a blob");
    return validate_curves(o, error);
}

double lp_center(const lensprof_apply_options *o, const lp_model *m, int axis) {
    const double side = axis ? o->frame_height : o->frame_width;
    return 0.5 * (side - 1.0) + lensprof_half_diagonal(o->frame_width, o->frame_height) * m->vignetting[0].center[axis];
}

double lp_exposure_ratio(const lensprof_apply_options *o, uint32_t channel) {
    return lp_exposure_factor(&o->target, channel) / lp_exposure_factor(&o->source, channel);
}

#if LP_HAS_LEVELS
double lp_highlight_level(const lensprof_apply_options *o, const lp_model *m, int is_linear) {
    const lensprof_levels *levels = lp_levels_of(m, LP_OUTPUT);
    const int is_neutral = o->saturated == LENSPROF_SATURATED_NEUTRAL && o->direction == LENSPROF_DIRECTION_CORRECT
                           && lensprof_layout_channels(o->source_layout) == 3 && !lp_is_neutral_white(o) && is_linear
                           && lp_model_has_levels(m);
    double least = 1.0;
    for (uint32_t c = 0; c < 3 && is_neutral; c++) {
        const double ratio = lp_exposure_ratio(o, c);
        if (ratio < least) least = ratio;
    }
    return levels->black[1] + least * lp_level_span(levels, 1);
}
#endif

static lensprof_status validate_exposures(const lensprof_apply_options *o, lensprof_error *error) {
    lensprof_status status = lensprof_exposure_validate(&o->source);
    if (status == LENSPROF_OK) status = lensprof_exposure_validate(&o->target);
    for (uint32_t c = 0; c < 3 && status == LENSPROF_OK; c++) /* single precision must be able to represent the
                                                               * factor */
        if (!(lp_exposure_ratio(o, c) >= 1e-12 && lp_exposure_ratio(o, c) <= 1e12)) status = LENSPROF_ERROR_EXPOSURE;
    return status == LENSPROF_OK ? status : lp_fail(error, status, "exposures invalid, or over 1e12 apart");
}

/* Checks everything that does not depend on the model. */
static lensprof_status validate_options(const lensprof_apply_options *o, lensprof_error *error) {
    if (o->direction > LENSPROF_DIRECTION_SIMULATE || o->input > LENSPROF_ENCODING_LINEAR
        || o->output > LENSPROF_ENCODING_LINEAR || o->saturated > LENSPROF_SATURATED_AS_VALUE)
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "unknown direction, encoding or saturated");
    if (!lensprof_sample_type_bytes(o->source_sample) || !lensprof_sample_type_bytes(o->target_sample)
        || !lensprof_layout_samples(o->source_layout))
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "unknown sample type or layout");
    if (!(o->strength >= 0.0 && o->strength <= 1.0)
        || !(o->gain_cap == 0.0 || (o->gain_cap >= 1.0 && o->gain_cap <= LP_LARGEST_GAIN_CAP)) || o->dither > 1
        || o->chroma > LP_HAS_CHROMA || (!LP_HAS_LEVELS && (o->levels || o->output_levels))
        || (!LP_HAS_CIRCLE && o->image_circle) || o->reserved || o->reserved2 || o->reserved3)
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "strength, gain_cap, dither, chroma, levels, circle");
    if (!o->frame_width || !o->frame_height || o->frame_width > LP_LARGEST_SIDE || o->frame_height > LP_LARGEST_SIDE)
        return lp_fail(error, LENSPROF_ERROR_SIZE, "frame size is 0, or over 2^20");
#if LP_HAS_LEVELS
    if ((o->levels && lensprof_levels_validate(o->levels) != LENSPROF_OK)
        || (o->output_levels && lensprof_levels_validate(o->output_levels) != LENSPROF_OK))
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "levels: black is not below white");
#endif
#if LP_HAS_CIRCLE
    if (o->image_circle && lensprof_image_circle_validate(o->image_circle) != LENSPROF_OK)
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "image_circle: centre or radius out of range");
#endif
    const lensprof_status status = validate_exposures(o, error);
    return status == LENSPROF_OK && !o->blob ? validate_structs(o, error) : status;
}

lensprof_status lp_options_validate(const lensprof_apply_options *given, lensprof_apply_options *options,
                                    lp_model *model, lensprof_error *error) {
    lensprof_apply_options_init(options);
    const char *wrong = lp_sized_take(options, given, FIRST_OPTIONS);
    if (wrong) return lp_fail(error, LENSPROF_ERROR_STRUCT_SIZE, wrong);
    lensprof_status status = validate_options(options, error);
    if (status != LENSPROF_OK) return status;
    status = lp_options_model(options, model);
    if (status == LENSPROF_OK) return validate_responses(options->output_response, options->output_responses, error);
    return lp_fail(error, status, options->blob ? "invalid blob, or blob and curves" : "grid or output is invalid");
}
