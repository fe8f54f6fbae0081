/* Plans in integers (lensprof/fixed.h), rounded from double precision. */
#include "core/fixed_plan.h"

#include <math.h>
#include <string.h>

#include "core/fail.h"
#include "core/levels.h"
#include "core/plan.h"
#include "core/response.h"

#define LEAST_FALLOFF_SHIFT 21 /* M in 2^-21: 1 / 2000 of the smallest one allowed */
#define LARGEST_GRID_SIDE (LP_HAS_FIXED_GRID ? LP_SENSOR_LARGEST_SIDE : 0) /* px of a frame with a grid */
#define SMALLEST_M 0.0005 /* below the smallest one allowed, above 0 after rounding */

/* Returns a linear response if pixels are light. */
static struct lp_model_response response_of(const lensprof_apply_options *o, const lp_model *m, enum lp_end end,
                                            uint32_t curve) {
    struct lp_model_response response = *lp_response(o, m, end, curve);
    if ((end == LP_INPUT ? o->input : o->output) == LENSPROF_ENCODING_LINEAR)
        response.kind = LENSPROF_RESPONSE_LINEAR, response.gamma = 1.0;
    return response;
}

static int is_linear(const lensprof_apply_options *o, const lp_model *m, enum lp_end end) {
    int linear = 1;
    for (uint32_t c = 0; c < lp_curves(o, m); c++)
        linear = linear && response_of(o, m, end, c).kind == LENSPROF_RESPONSE_LINEAR;
    return linear;
}

/* Whether black of the channels differs, for input or output. */
static int have_own_black(const lp_model *m) {
    int differ = 0;
    for (int end = LP_INPUT; end <= LP_OUTPUT && LP_HAS_LEVELS; end++) {
        const double *black = lp_levels_of(m, end)->black;
        differ = differ || black[0] != black[1] || black[2] != black[1];
    }
    return differ;
}

/* Whether samples of 16 bit come in or go out. */
static int is_wide(const lensprof_apply_options *o) {
    return o->source_sample != LENSPROF_SAMPLE_U8 || o->target_sample != LENSPROF_SAMPLE_U8;
}

static uint32_t tables_of(const lensprof_apply_options *o, const lp_model *m, enum lp_end end) {
    const int is_linear_in = is_linear(o, m, LP_INPUT), is_linear_out = is_linear(o, m, LP_OUTPUT);
    if ((is_wide(o) || lp_model_has_levels(m)) && is_linear_in && is_linear_out) return 0;
    if (have_own_black(m) && lensprof_layout_channels(o->source_layout) == 3) return 3;
    return (end == LP_INPUT ? is_linear_in : is_linear_out) ? 1 : lp_curves(o, m);
}

/* Whether the output is encoded as the input is, so that one table is enough. */
static int are_ends_equal(const lensprof_apply_options *o, const lp_model *m) {
    return o->source_sample == o->target_sample && o->input == o->output && !m->outputs
           && !memcmp(lp_levels_of(m, LP_INPUT), lp_levels_of(m, LP_OUTPUT), sizeof(lensprof_levels));
}

/* Curves of an end that have samples of their own. */
static uint32_t sampled_of(const lensprof_apply_options *o, const lp_model *m, enum lp_end end) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < tables_of(o, m, end) && !(end == LP_OUTPUT && are_ends_equal(o, m)); c++) {
        const struct lp_model_response response = response_of(o, m, end, c);
        count += !lp_is_power(&response);
    }
    return count;
}

/* Planes of the gain grid that a plan holds: grey uses that of green. */
static inline uint32_t grid_channels(const lensprof_apply_options *o, const lp_model *m) {
    return m->channels == 3 && lensprof_layout_channels(o->source_layout) == 1 ? 1 : m->channels;
}

static size_t bytes_of_tables(const lensprof_apply_options *o, const lp_model *m) {
    const uint32_t tables = tables_of(o, m, LP_INPUT) + tables_of(o, m, LP_OUTPUT);
    if (!LP_HAS_WIDE_CURVES || !is_wide(o)) return tables * (LP_CODES * sizeof(int32_t));
    return tables * sizeof(lp_fixed_curve)
           + (sampled_of(o, m, LP_INPUT) + sampled_of(o, m, LP_OUTPUT)) * LENSPROF_RESPONSE_SAMPLES * sizeof(int32_t);
}

static size_t bytes_of(const lensprof_apply_options *o, const lp_model *m) {
    const uint32_t nodes = LP_HAS_FIXED_GRID ? grid_channels(o, m) * m->columns * m->rows : 0;
    return sizeof(lensprof_fixed_plan) + bytes_of_tables(o, m) + nodes * sizeof(uint32_t);
}

/* ---- falloff ---- */

/* Centre, and the largest r^2 in the frame, px^2; at least that of a corner from the middle, the unit in which k are
 * defined. */
static double prepare_center(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    const double unit = 1 << LP_CENTER_SHIFT, size[2] = {o->frame_width, o->frame_height};
    const double rho2 = 0.25 * (size[0] * size[0] + size[1] * size[1]);
    double reach2 = 0.0;
    for (int d = 0; d < 2; d++) {
        const double center = lp_center(o, m, d);
        const double reach = fmax(center, size[d] - 1.0 - center) + 1.0 / unit;
        plan->center[d] = (int32_t)floor(center * unit + 0.5);
        reach2 += reach * reach;
    }
    return fmax(reach2, rho2);
}

static inline double largest_node(const lp_model *m) {
    double largest = 0.0;
    for (uint32_t i = 0; i < m->channels * m->columns * m->rows; i++)
        largest = fmax(largest, (double)lp_model_node(m, i));
    return largest;
}

/* Coefficients in powers of t = r^2 / R, R a power of 2 beyond the frame. 0 if integers cannot represent them. */
static int prepare_falloffs(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    const double w = o->frame_width, h = o->frame_height, reach2 = prepare_center(plan, o, m);
    double k[LP_CHANNELS][3], largest = 0.0, reach = 1.0; /* R, px^2 */
    uint32_t shift = 63 - 2 * LP_CENTER_SHIFT;
    for (; reach <= reach2; reach *= 2.0) shift--;
    plan->reach_shift = shift;
    for (uint32_t c = 0; c < LP_CHANNELS; c++) {
        double scale = m->columns ? 1.0 : o->strength, sum = 1.0;
        for (int n = 0; n < 3; n++) {
            scale *= reach * 4.0 / (w * w + h * h);
            k[c][n] = m->vignetting[m->vignettings == 1 ? 0 : plan->channels == 1 ? 1 : c].k[n] * scale;
            sum += fabs(k[c][n]) + 1e-6; /* rounding */
        }
        largest = fmax(largest, sum);
    }
    if (LP_HAS_FIXED_GRID) largest *= fmax(largest_node(m), 1.0);
    plan->falloff_shift = 30;
    while (plan->falloff_shift >= LEAST_FALLOFF_SHIFT && ldexp(largest, (int)plan->falloff_shift) >= 2147483648.0)
        plan->falloff_shift--;
    if (plan->falloff_shift < LEAST_FALLOFF_SHIFT) return 0;
    const double unit = ldexp(1.0, (int)plan->falloff_shift);
    for (uint32_t c = 0; c < LP_CHANNELS; c++)
        for (int n = 0; n < 3; n++) plan->k[c][n] = (int32_t)floor(k[c][n] * unit + 0.5);
    plan->least = (int32_t)(unit * fmax(o->gain_cap > 0.0 ? 1.0 / o->gain_cap : 0.0, SMALLEST_M));
    return 1;
}

#if LP_HAS_FIXED_GRID
static void prepare_grid(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    lp_fixed_grid *grid = &plan->grid;
    const double largest = largest_node(m);
    const uint32_t sides[2] = {o->frame_width, o->frame_height}, nodes[2] = {m->columns, m->rows};
    if (!m->columns) return;
    grid->columns = m->columns, grid->rows = m->rows, grid->channels = grid_channels(o, m);
    grid->strength = (uint32_t)floor(o->strength * (1u << LP_STRENGTH_SHIFT) + 0.5);
    grid->shift = LP_SENSOR_LARGEST_SHIFT;
    while (largest * (1u << grid->shift) > LP_SENSOR_LARGEST_NODE) grid->shift--;
    for (int d = 0; d < 2; d++) grid->axis[d] = lp_fixed_grid_axis(sides[d], nodes[d]);
}

/* At the end of the plan. */
static void prepare_nodes(lensprof_fixed_plan *plan, const lp_model *m) {
    const uint32_t count = lp_fixed_nodes(plan), first = plan->grid.channels < m->channels ? count : 0; /* of green */
    uint32_t *node = (uint32_t *)(void *)plan + plan->bytes / 4 - count;
    for (uint32_t i = 0; i < count; i++)
        node[i] = (uint32_t)floor((double)lp_model_node(m, first + i) * (1u << plan->grid.shift) + 0.5);
}
#endif

/* ---- logarithms ---- */

/* In the plan's units, rounded to nearest. */
static int32_t log_of(double light) {
    return light > 0.0 ? (int32_t)floor(log2(light) * (1 << LP_LOG_SHIFT) + 0.5) : LP_LOG_NONE;
}

/* The largest code. */
static double full_scale_of(const lensprof_fixed_plan *plan, enum lp_end end) {
    return lp_fixed_is_8_bit(plan) || (end == LP_OUTPUT && lp_fixed_target(plan) == LENSPROF_SAMPLE_U8) ? 255.0
                                                                                                        : 65535.0;
}

/* B of a sample 0..1. Grey is treated as green. */
static double grey_of(const lensprof_fixed_plan *plan, const lp_model *m, enum lp_end end, uint32_t curve,
                      double sample) {
    if (!LP_HAS_LEVELS || !lp_has_levels(lp_levels_of(m, end))) return sample;
    return lensprof_levels_to_value(lp_levels_of(m, end), plan->channels == 1 ? 1 : curve, sample);
}

static void prepare_tables(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    int32_t *table = (int32_t *)(void *)(plan + 1);
    const int is_light = is_linear(o, m, LP_INPUT);
    for (uint32_t c = 0; c < plan->decode_curves; c++, table += LP_CODES) {
        const struct lp_model_response response = response_of(o, m, LP_INPUT, c);
        for (uint32_t code = 0; code < LP_CODES; code++) {
            const double grey = grey_of(plan, m, LP_INPUT, c, code / 255.0); /* above white, light is not clipped */
            table[code] = log_of(is_light ? grey : lp_model_invert(&response, grey));
        }
    }
    for (uint32_t c = 0; c < plan->encode_curves; c++, table += LP_CODES) {
        const struct lp_model_response response = response_of(o, m, LP_OUTPUT, c);
        for (uint32_t code = 0; code < LP_CODES; code++) {
            const double grey = grey_of(plan, m, LP_OUTPUT, c, (code + 0.5) / 255.0);
            if (grey >= 1.0 || code >= (uint32_t)plan->largest)
                table[code] = INT32_MAX; /* no code is whiter */
            else
                table[code] = grey <= 0.0 ? INT32_MIN /* nor darker */ : log_of(lp_model_invert(&response, grey));
        }
    }
}

#if LP_HAS_WIDE_CURVES
/* Of samples of 16 bit. */
static lp_fixed_curve curve_of(const lensprof_fixed_plan *plan, const lp_model *m, enum lp_end end, uint32_t channel,
                               const struct lp_model_response *response) {
    lp_fixed_curve curve = {0, LP_CURVE_LAST << LP_PLACE_SHIFT, 0, 0, 1u << LP_EXPONENT_SHIFT};
    double one = curve.one;
    if (lp_is_power(response)) {
        const double gamma = end == LP_INPUT ? response->gamma : 1.0 / response->gamma;
        one = full_scale_of(plan, end) * (1 << LP_LEVEL_SHIFT) * lp_level_span(lp_levels_of(m, end), channel);
        curve.one = (uint32_t)(one + 0.5);
        curve.exponent = (uint32_t)(gamma * (1 << LP_EXPONENT_SHIFT) + 0.5);
    }
    curve.log_one = log_of(one);
    return curve;
}

static void prepare_samples(const lensprof_fixed_plan *plan, const lp_model *m, enum lp_end end, uint32_t channel,
                            const struct lp_model_response *response, int32_t *samples) {
    const lensprof_levels *levels = lp_levels_of(m, end);
    const double unit = full_scale_of(plan, end) * (1 << LP_SAMPLE_SHIFT);
    for (uint32_t j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        const double grey = lp_model_sample(response, j);
        samples[j] = (int32_t)floor(unit * lensprof_levels_to_sample(levels, channel, grey) + 0.5);
    }
}

static void prepare_curves(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    lp_fixed_curve *curves = (lp_fixed_curve *)(void *)(plan + 1), *curve = curves;
    int32_t *words = (int32_t *)(void *)curves;
    uint32_t next = (plan->decode_curves + plan->encode_curves) * (sizeof *curves / sizeof *words);
    for (int end = LP_INPUT; end <= LP_OUTPUT; end++)
        for (uint32_t c = 0; c < (end == LP_INPUT ? plan->decode_curves : plan->encode_curves); c++, curve++) {
            const struct lp_model_response response = response_of(o, m, end, c);
            const uint32_t channel = plan->channels == 1 ? 1 : c; /* grey is treated as green */
            *curve = curve_of(plan, m, end, channel, &response);
            if (is_linear(o, m, end)) curve->most = LP_LOG_MOST;
            if (lp_is_power(&response)) continue;
            curve->samples = next;
            if (end == LP_OUTPUT && are_ends_equal(o, m))
                curve->samples = curves[c].samples;
            else {
                prepare_samples(plan, m, end, channel, &response, words + next);
                next += LENSPROF_RESPONSE_SAMPLES;
            }
        }
}
#endif

/* ---- plan ---- */

static lensprof_status validate(const lensprof_apply_options *given, lensprof_apply_options *o, lp_model *m,
                                lensprof_error *error) {
    const lensprof_status status = lp_options_validate(given, o, m, error);
    if (status != LENSPROF_OK) return status;
    if (o->source_sample > LENSPROF_SAMPLE_U16 || o->target_sample > LENSPROF_SAMPLE_U16
        || (!LP_HAS_WIDE_CURVES && o->target_sample != o->source_sample) || o->source_layout == LENSPROF_LAYOUT_PLANAR
        || o->dither || (m->columns && (o->frame_width > LARGEST_GRID_SIDE || o->frame_height > LARGEST_GRID_SIDE)))
        return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED,
                       "integers take U8, U16, no planes, dither, or grid over 65535");
    if (LP_HAS_CIRCLE && m->circle.radius > 0.0)
        return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "integers do not take an image circle");
    if (o->chroma) return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "integers do not take chroma");
    if (!LP_HAS_WIDE_CURVES && o->source_sample == LENSPROF_SAMPLE_U16
        && !(is_linear(o, m, LP_INPUT) && is_linear(o, m, LP_OUTPUT)))
        return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "integers take U16 through a linear response only");
    return LENSPROF_OK;
}

size_t lensprof_fixed_plan_bytes(const lensprof_apply_options *options) {
    lensprof_apply_options local_options;
    lp_model model;
    return options && validate(options, &local_options, &model, NULL) == LENSPROF_OK ? bytes_of(&local_options, &model)
                                                                                     : 0;
}

static void prepare_layout(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    plan->sample = (uint8_t)o->source_sample;
    plan->target = (uint8_t)o->target_sample;
    plan->layout = (uint8_t)o->source_layout;
    plan->samples = (uint8_t)lensprof_layout_samples(plan->layout);
    plan->channels = (uint8_t)lensprof_layout_channels(plan->layout);
    lp_layout_sites(plan->layout, plan->channel_of_sample, plan->site);
    plan->frame_width = o->frame_width;
    plan->frame_height = o->frame_height;
    plan->simulate = o->direction == LENSPROF_DIRECTION_SIMULATE;
    plan->decode_curves = (uint8_t)tables_of(o, m, LP_INPUT);
    plan->encode_curves = (uint8_t)tables_of(o, m, LP_OUTPUT);
}

#if LP_HAS_LEVELS
static int32_t level_of(const lensprof_fixed_plan *plan, enum lp_end end, double sample) {
    return (int32_t)floor(full_scale_of(plan, end) * sample * (1 << LP_LEVEL_SHIFT) + 0.5);
}

static void prepare_levels(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    const lensprof_levels *in = lp_levels_of(m, LP_INPUT), *out = lp_levels_of(m, LP_OUTPUT);
    if (!lp_model_has_levels(m)) return;
    plan->levels = 1;
    for (uint32_t row = 0; row < LP_CHANNELS; row++) {
        const uint32_t c = plan->channels == 1 ? 1 : row; /* grey is treated as green */
        plan->black_in[row] = level_of(plan, LP_INPUT, in->black[c]);
        plan->black_out[row] = level_of(plan, LP_OUTPUT, out->black[c]);
        const double per_span = 256.0 * 65535.0 / level_of(plan, LP_INPUT, lp_level_span(in, c));
        plan->per_span[row] = (uint32_t)(per_span * (1u << lp_fixed_span_shift(plan)) + 0.5);
    }
    plan->largest =
        (int32_t)floor(full_scale_of(plan, LP_OUTPUT) * lp_highlight_level(o, m, is_linear(o, m, LP_OUTPUT)) + 0.5);
}
#endif

/* The ratio of exposures and, if codes stay codes, of white less black, in codes. */
static double factor_of(const lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m,
                        uint32_t channel) {
    const double ratio = lp_exposure_ratio(o, channel);
    if ((!LP_HAS_LEVELS && !LP_HAS_WIDE_CURVES) || plan->decode_curves) return ratio;
    double spans = full_scale_of(plan, LP_OUTPUT) / full_scale_of(plan, LP_INPUT);
    if (LP_HAS_LEVELS)
        spans *= lp_level_span(lp_levels_of(m, LP_OUTPUT), channel) / lp_level_span(lp_levels_of(m, LP_INPUT), channel);
    return plan->simulate ? ratio / spans : ratio * spans;
}

static void prepare_gains(lensprof_fixed_plan *plan, const lensprof_apply_options *o, const lp_model *m) {
    plan->falloffs = plan->gains = 1;
    for (uint32_t c = 0; c < LP_CHANNELS; c++)
        plan->factor[c] = log_of(factor_of(plan, o, m, plan->channels == 1 ? 1 : c)); /* grey is treated as green */
    for (uint32_t c = 1; c < plan->channels; c++) {
        if (memcmp(plan->k[c], plan->k[0], sizeof plan->k[0])) plan->falloffs = 3;
        if (plan->grid.channels == 3) plan->falloffs = 3;
        if (plan->falloffs == 3 || plan->factor[c] != plan->factor[0]) plan->gains = 3;
    }
    plan->neutral_white = lp_is_neutral_white(o) && plan->gains == 3;
}

lensprof_status lensprof_fixed_plan_init(void *memory, size_t size, const lensprof_apply_options *given,
                                         const lensprof_fixed_plan **result, lensprof_error *error) {
    if (!memory || !given || !result) return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "memory, options or plan is NULL");
    lensprof_apply_options local_options;
    const lensprof_apply_options *options = &local_options;
    lensprof_fixed_plan head;
    memset(&head, 0, sizeof head);
    lp_model model;
    const lensprof_status status = validate(given, &local_options, &model, error);
    if (status != LENSPROF_OK) return status;
    prepare_layout(&head, options, &model);
    if (!prepare_falloffs(&head, options, &model))
        return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "the falloff is too steep for integers");
#if LP_HAS_FIXED_GRID
    prepare_grid(&head, options, &model);
#endif
    prepare_gains(&head, options, &model);
    head.largest = (int32_t)full_scale_of(&head, LP_OUTPUT);
#if LP_HAS_LEVELS
    prepare_levels(&head, options, &model);
#endif
    head.magic = LP_FIXED_MAGIC;
    head.bytes = (uint32_t)bytes_of(options, &model);
    if (size < head.bytes || (uintptr_t)memory % 4) return lp_fail(error, LENSPROF_ERROR_CAPACITY, LP_MEMORY_TEXT);
    lensprof_fixed_plan *plan = memory;
    *plan = head;
#if LP_HAS_WIDE_CURVES
    if (is_wide(options))
        prepare_curves(plan, options, &model);
    else
#endif
        prepare_tables(plan, options, &model);
#if LP_HAS_FIXED_GRID
    prepare_nodes(plan, &model);
#endif
    plan->check = lp_fixed_check(plan);
    *result = plan;
    return lp_fail(error, LENSPROF_OK, "");
}
