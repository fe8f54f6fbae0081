/* Options of plans: what they may be, and the model they hold, in the caller's structs or in a blob. */
#include "core/options.h"

#include <math.h>
#include <string.h>

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

lensprof_status lp_options_take(const lensprof_apply_options *given, lensprof_apply_options *own) {
    lensprof_apply_options_init(own);
    return lp_sized_take(own, given, FIRST_OPTIONS) ? LENSPROF_ERROR_STRUCT_SIZE : LENSPROF_OK;
}

static void view_response(struct lp_model_response *view, const lensprof_response *response) {
    view->kind = response->kind;
    view->gamma = response->kind == LENSPROF_RESPONSE_GAMMA ? response->gamma : 1.0;
    view->table = response->table;
}

/* The model in the caller's structs. Its size does not depend on the vignetting, which may not be there yet. */
static lensprof_status view_structs(const lensprof_apply_options *o, lp_model *m) {
    memset(m, 0, sizeof *m);
    if (!o->response || (o->responses != 1 && o->responses != 3)) return LENSPROF_ERROR_ARGUMENT;
    m->responses = o->responses;
    m->vignettings = o->vignetting && (o->vignettings == 1 || o->vignettings == 3) ? o->vignettings : 0;
    for (uint32_t c = 0; c < m->responses; c++) view_response(&m->response[c], &o->response[c]);
    for (uint32_t c = 0; c < m->vignettings; c++) m->vignetting[c] = o->vignetting[c];
    if (!o->grid) return LENSPROF_OK;
    m->columns = o->grid->columns, m->rows = o->grid->rows, m->channels = o->grid->channels;
    m->attenuation = o->grid->attenuation;
    return lensprof_gain_grid_validate(o->grid);
}

lensprof_status lp_options_model(const lensprof_apply_options *o, lp_model *m) {
    if (!o->blob) return view_structs(o, m);
    if (o->response || o->vignetting || o->grid) return LENSPROF_ERROR_ARGUMENT;
    lp_blob blob;
    const lensprof_status status = lp_blob_open(o->blob, o->blob_bytes, &blob);
    if (status == LENSPROF_OK) *m = blob.model;
    return status;
}

uint32_t lp_curves(const lensprof_apply_options *o, const lp_model *m) {
    return lensprof_layout_channels(o->source_layout) == 1 ? 1 : m->responses;
}

const struct lp_model_response *lp_response(const lensprof_apply_options *o, const lp_model *m, uint32_t curve) {
    uint32_t channel = lensprof_layout_channels(o->source_layout) == 1 ? 1 : curve;
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

/* The model in the caller's structs; lp_options_model checks the grid, and all of a blob. */
static lensprof_status validate_structs(const lensprof_apply_options *o) {
    lensprof_status status = LENSPROF_OK;
    if (!o->response || !o->vignetting || (o->responses != 1 && o->responses != 3)
        || (o->vignettings != 1 && o->vignettings != 3))
        return LENSPROF_ERROR_ARGUMENT;
    for (uint32_t c = 0; c < o->responses && status == LENSPROF_OK; c++)
        status = lensprof_response_validate(&o->response[c]);
    for (uint32_t c = 0; c < o->vignettings && status == LENSPROF_OK; c++) {
        status = lensprof_vignetting_validate(&o->vignetting[c]);
        if (status == LENSPROF_OK
            && (o->vignetting[c].center[0] != o->vignetting[0].center[0]
                || o->vignetting[c].center[1] != o->vignetting[0].center[1]))
            status = LENSPROF_ERROR_VIGNETTING; /* one centre for all channels */
    }
    return status;
}

double lp_center(const lensprof_apply_options *o, const lp_model *m, int axis) {
    const double side = axis ? o->frame_height : o->frame_width;
    return 0.5 * (side - 1.0) + lensprof_half_diagonal(o->frame_width, o->frame_height) * m->vignetting[0].center[axis];
}

double lp_exposure_ratio(const lensprof_apply_options *o, uint32_t channel) {
    return lensprof_exposure_factor(&o->target, channel) / lensprof_exposure_factor(&o->source, channel);
}

/* All but what the model decides. */
static lensprof_status validate_options(const lensprof_apply_options *o) {
    if (o->direction > LENSPROF_DIRECTION_SIMULATE || o->input > LENSPROF_ENCODING_LINEAR
        || o->output > LENSPROF_ENCODING_LINEAR || o->saturated > LENSPROF_SATURATED_AS_VALUE
        || !lensprof_sample_bytes(o->source_sample) || !lensprof_sample_bytes(o->target_sample)
        || !lensprof_layout_samples(o->source_layout))
        return LENSPROF_ERROR_ARGUMENT;
    if (!(o->strength >= 0.0 && o->strength <= 1.0) || o->dither > 1 || o->reserved
        || !(o->gain_cap == 0.0 || (o->gain_cap >= 1.0 && o->gain_cap <= LP_LARGEST_GAIN_CAP)))
        return LENSPROF_ERROR_ARGUMENT;
    if (!o->frame_width || !o->frame_height || o->frame_width > LP_LARGEST_SIDE || o->frame_height > LP_LARGEST_SIDE)
        return LENSPROF_ERROR_SIZE;
    lensprof_status status = lensprof_exposure_validate(&o->source);
    if (status == LENSPROF_OK) status = lensprof_exposure_validate(&o->target);
    for (uint32_t c = 0; c < 3 && status == LENSPROF_OK; c++) /* single precision must hold the factor */
        if (!(lp_exposure_ratio(o, c) >= 1e-12 && lp_exposure_ratio(o, c) <= 1e12)) status = LENSPROF_ERROR_EXPOSURE;
    return status == LENSPROF_OK && !o->blob ? validate_structs(o) : status;
}

lensprof_status lp_options_validate(const lensprof_apply_options *given, lensprof_apply_options *own, lp_model *model) {
    lensprof_status status = lp_options_take(given, own);
    if (status == LENSPROF_OK) status = validate_options(own);
    return status == LENSPROF_OK ? lp_options_model(own, model) : status;
}
