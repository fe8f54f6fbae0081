/* Plans: options prepared for the kernels (lensprof/apply.h).
 *
 * Pixels go  code -> irradiance -> times gain(x, y) -> code. The curves are tables (plan_curves.c); gains
 * are calculated per pixel from the plan's falloff data. */
#include "core/plan.h"

#include <math.h>
#include <string.h>

#include "core/fail.h"
#include "core/levels.h"
#include "core/plan_curves.h"

static size_t nodes_of(const lp_model *m) { return (size_t)m->channels * m->rows * m->columns; }

static size_t bytes_of(const lensprof_apply_options *o, const lp_model *m) {
    return sizeof(lensprof_plan) + (lp_curve_numbers(o, m) + nodes_of(m)) * sizeof(float);
}

size_t lensprof_plan_bytes(const lensprof_apply_options *options) {
    lensprof_apply_options o;
    lp_model model;
    if (!options || lp_options_take(options, &o) != LENSPROF_OK || !lensprof_sample_type_bytes(o.source_sample)
        || !lensprof_sample_type_bytes(o.target_sample) || !lensprof_layout_samples(o.source_layout))
        return 0;
    return lp_options_model(&o, &model) == LENSPROF_OK ? bytes_of(&o, &model) : 0;
}

/* Copies the nodes of the gain grid, less 1, to `memory`. */
static void prepare_grid(lensprof_plan *plan, const lp_model *m, float *memory) {
    if (!nodes_of(m)) return;
    plan->columns = m->columns;
    plan->rows = m->rows;
    for (uint32_t i = 0; i < nodes_of(m); i++) memory[i] = lp_model_node(m, i) - 1.0f;
    for (uint32_t c = 0; c < LP_CHANNELS; c++)
        plan->nodes[c] = memory + (m->channels == 3 ? c : 0) * m->rows * m->columns;
}

static void prepare_layout(lensprof_plan *plan, const lensprof_apply_options *o) {
    plan->layout = o->source_layout;
    plan->samples = lensprof_layout_samples(plan->layout);
    plan->channels = lensprof_layout_channels(plan->layout);
    lp_layout_sites(plan->layout, plan->channel_of_sample, plan->site);
}

static double full_scale_of(uint32_t sample) {
    return sample == LENSPROF_SAMPLE_U8 ? 255.0 : sample == LENSPROF_SAMPLE_U16 ? 65535.0 : 1.0;
}

/* White less black in the linear numbers of a kernel: without a curve in between, codes stay codes. */
static double white_of(const lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m, enum lp_end end,
                       uint32_t channel) {
    if ((end == LP_INPUT ? plan->decode : plan->encode) != LP_CURVE_NONE) return 1.0;
    const double full = full_scale_of(end == LP_INPUT ? o->source_sample : o->target_sample);
    return LP_HAS_LEVELS ? full * lp_level_span(lp_levels_of(m, end), channel) : full;
}

#if LP_HAS_LEVELS
static void prepare_levels(lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    const lensprof_levels *in = lp_levels_of(m, LP_INPUT), *out = lp_levels_of(m, LP_OUTPUT);
    struct lp_plan_levels *l = &plan->levels;
    const double in_scale = full_scale_of(plan->source_sample), out_scale = full_scale_of(plan->target_sample);
    const int is_in_code = plan->decode == LP_CURVE_NONE, is_out_code = plan->encode == LP_CURVE_NONE;
    if (lp_has_levels(in) && !plan->inverse) l->steps |= LP_LEVELS_IN;
    if (lp_has_levels(out)) l->steps |= LP_LEVELS_OUT;
    l->largest_code = (float)floor(out_scale * lp_highlight_level(o, m, is_out_code) + 0.5);
    l->are_one = 1;
    float least = 0.0f;
    for (uint32_t row = 0; row < LP_CHANNELS; row++) {
        const uint32_t c = plan->channels == 1 ? 1 : row; /* grey is treated as green */
        l->black_code[row] = (float)(in_scale * in->black[c]);
        l->code_span[row] = (float)(in_scale * lp_level_span(in, c));
        l->black_in[row] = is_in_code ? l->black_code[row] : (float)in->black[c];
        l->per_span_in[row] = is_in_code ? 1.0f : (float)(1.0 / lp_level_span(in, c));
        l->black_out[row] = (float)(is_out_code ? out_scale * out->black[c] : out->black[c]);
        l->span_out[row] = is_out_code ? 1.0f : (float)lp_level_span(out, c);
        if (l->black_in[row] != l->black_in[0] || l->black_out[row] != l->black_out[0]) l->are_one = 0;
        if (row == 0 || l->black_code[row] < least) least = l->black_code[row];
    }
    l->near_white = least + 0.89f * (float)(in_scale * lp_white_level(in) - (double)least);
}
#endif

/* Falloff and factor of a channel. The gain is factor / M, or M / factor to simulate. */
static void prepare_gain(lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m, uint32_t channel) {
    const double w = o->frame_width, h = o->frame_height, per_rho2 = 4.0 / (w * w + h * h);
    const double *k = m->vignetting[m->vignettings == 3 ? channel : 0].k;
    const uint32_t row = plan->channels == 1 ? 0 : channel; /* grey is treated as green */
    double scale = plan->columns ? 1.0 : o->strength;
    for (int n = 0; n < 3; n++) plan->k[row][n] = (float)(k[n] * (scale *= per_rho2));
    const double units =
        (plan->encode == LP_CURVE_TABLE ? LENSPROF_RESPONSE_SAMPLES - 1 : white_of(plan, o, m, LP_OUTPUT, channel))
        / white_of(plan, o, m, LP_INPUT, channel);
    const double ratio = lp_exposure_ratio(o, channel);
    plan->factor[row] = (float)(plan->simulate ? ratio / units : ratio * units);
    plan->times[row] = 1.0f;
    if (row != channel) plan->nodes[row] = plan->nodes[channel];
}

/* Whether all channels have the same falloff, which has no colour. */
static int has_one_falloff(const lensprof_plan *plan) {
    for (uint32_t c = 1; c < plan->channels; c++)
        if (memcmp(plan->k[c], plan->k[0], sizeof plan->k[0]) || plan->nodes[c] != plan->nodes[0]) return 0;
    return 1;
}

/* Channels that differ only in their factors share one division per pixel, if the rounding has no visible effect. */
static void share_gains(lensprof_plan *plan) {
    if (plan->target_sample == LENSPROF_SAMPLE_F32 && plan->encode < LP_CURVE_TABLE) return;
    for (uint32_t c = 0; c < LP_CHANNELS; c++) {
        plan->times[c] = plan->simulate ? 1.0f / plan->factor[c] : plan->factor[c];
        plan->factor[c] = 1.0f;
    }
    plan->gains = 1;
}

static void prepare_gains(lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    for (int d = 0; d < 2; d++) {
        const double center = lp_center(o, m, d);
        plan->center_px[d] = (int32_t)floor(center + 0.5);
        plan->center_part[d] = (float)(center - plan->center_px[d]);
    }
#if LP_HAS_CIRCLE
    plan->circle = m->circle;
#endif
    plan->least = (float)(1.0 / (o->gain_cap > 0.0 ? o->gain_cap : LP_LARGEST_GAIN_CAP));
    plan->strength = (float)o->strength;
    plan->gains = 1;
    for (uint32_t c = 0; c < LP_CHANNELS; c++) {
        if (plan->channels == 1 && c != 1) continue;
        prepare_gain(plan, o, m, c);
        if (plan->channels == 3 && plan->factor[c] != plan->factor[0]) plan->gains = 3;
    }
    if (!has_one_falloff(plan)) {
        plan->gains = 3;
        plan->chroma = o->chroma; /* needs M of all channels */
        return;
    }
    if (LP_HAS_CHROMA && o->chroma) memset(plan->k, 0, sizeof plan->k), plan->columns = 0;
    if (plan->gains == 3) share_gains(plan);
}

lensprof_status lensprof_plan_init(void *memory, size_t size, const lensprof_apply_options *given,
                                   const lensprof_plan **result, lensprof_error *error) {
    if (!memory || !given || !result) return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "memory, options or plan is NULL");
    lensprof_apply_options local_options;
    const lensprof_apply_options *options = &local_options;
    lp_model model;
    const lensprof_status status = lp_options_validate(given, &local_options, &model, error);
    if (status != LENSPROF_OK) return status;
    if (size < bytes_of(options, &model) || (uintptr_t)memory % 8)
        return lp_fail(error, LENSPROF_ERROR_CAPACITY, LP_MEMORY_TEXT);

    lensprof_plan *plan = memory;
    memset(plan, 0, sizeof *plan);
    plan->row = lp_row_best(0);
    plan->simulate = options->direction == LENSPROF_DIRECTION_SIMULATE;
    plan->frame_width = options->frame_width;
    plan->frame_height = options->frame_height;
    plan->source_sample = options->source_sample;
    plan->target_sample = options->target_sample;
    plan->dither = options->dither && options->target_sample == LENSPROF_SAMPLE_U8;
    prepare_layout(plan, options);
    plan->neutral_white = (uint32_t)lp_is_neutral_white(options);
    float *tables = (float *)(void *)(plan + 1);
    tables = lp_prepare_curves(plan, options, &model, tables);
#if LP_HAS_LEVELS
    prepare_levels(plan, options, &model);
#endif
    prepare_grid(plan, &model, tables);
    prepare_gains(plan, options, &model);
    *result = plan;
    return lp_fail(error, LENSPROF_OK, "");
}
