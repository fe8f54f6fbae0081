/* The curves of a plan as float tables: `inverse` maps every integer code to irradiance (8 and 16 bit input),
 * `forward` is the response on its 1024 grid. */
#include "core/plan_curves.h"

#include <string.h>

#include "core/levels.h"
#include "core/response.h"

/* The common kind of curve of all channels, for input or output. With levels, a linear response does not clip: noise
 * about black keeps its mean. */
static uint32_t kind_of(const lensprof_apply_options *o, const lp_model *m, enum lp_end end) {
    uint32_t kind = LP_CURVE_NONE;
    for (uint32_t c = 0; c < lp_curves(o, m); c++) {
        uint32_t curve_kind = lp_response(o, m, end, c)->kind;
        curve_kind = curve_kind == LENSPROF_RESPONSE_LINEAR  ? LP_CURVE_CLIP
                     : curve_kind == LENSPROF_RESPONSE_GAMMA ? LP_CURVE_POWER
                                                             : LP_CURVE_TABLE;
        kind = c && curve_kind != kind ? (uint32_t)LP_CURVE_MIXED : curve_kind;
        if (kind == LP_CURVE_MIXED) break;
    }
    return kind == LP_CURVE_CLIP && lp_model_has_levels(m) ? (uint32_t)LP_CURVE_NONE : kind;
}

static int is_integer(uint32_t sample) { return sample == LENSPROF_SAMPLE_U8 || sample == LENSPROF_SAMPLE_U16; }

/* Codes of a linear response lie within 0..1 as they are. */
static uint32_t decode_of(const lensprof_apply_options *o, const lp_model *m) {
    uint32_t kind = o->input == LENSPROF_ENCODING_LINEAR ? (uint32_t)LP_CURVE_NONE : kind_of(o, m, LP_INPUT);
    if (!is_integer(o->source_sample)) return kind;
    if (kind == LP_CURVE_CLIP) return LP_CURVE_NONE;
    if (kind == LP_CURVE_POWER && o->source_sample == LENSPROF_SAMPLE_U16 && !lp_model_has_levels(m)) return kind;
    return kind == LP_CURVE_NONE ? kind : (uint32_t)LP_CURVE_TABLE;
}

static uint32_t encode_of(const lensprof_apply_options *o, const lp_model *m) {
    uint32_t kind = o->output == LENSPROF_ENCODING_LINEAR ? (uint32_t)LP_CURVE_NONE : kind_of(o, m, LP_OUTPUT);
    return kind == LP_CURVE_CLIP && is_integer(o->target_sample) ? (uint32_t)LP_CURVE_NONE : kind;
}

/* Entries of the table of all codes; 0 if not used. */
static size_t codes_of(const lensprof_apply_options *o, const lp_model *m) {
    if (!is_integer(o->source_sample) || decode_of(o, m) != LP_CURVE_TABLE) return 0;
    return o->source_sample == LENSPROF_SAMPLE_U8 ? 256 : 65536;
}

/* Entries, of 16 bit, of the table of starting points among the samples; 0 if values do not go through the inverse. */
static size_t starts_of(const lensprof_apply_options *o, const lp_model *m) {
    const uint32_t decode = codes_of(o, m) ? (uint32_t)LP_CURVE_NONE : decode_of(o, m);
    return decode == LP_CURVE_TABLE || decode == LP_CURVE_MIXED ? LP_CELLS + 1 : 0;
}

/* Entries of the tables of f: that of the output, which also serves g of values (`starts`) if the input has the same
 * f; otherwise followed by that of the input. 0 if none is needed. */
static size_t samples_of(const lensprof_apply_options *o, const lp_model *m, size_t starts, enum lp_end end) {
    const uint32_t encode = encode_of(o, m);
    const int is_written = encode == LP_CURVE_TABLE || encode == LP_CURVE_MIXED;
    const int is_asked = end == LP_INPUT ? starts && m->outputs : is_written || (starts && !m->outputs);
    return is_asked ? LENSPROF_RESPONSE_SAMPLES : 0;
}

/* The grey value of a code, 0..1. */
static double grey_of(const lensprof_levels *levels, uint32_t channel, double sample) {
    if (!LP_HAS_LEVELS || !lp_has_levels(levels)) return sample;
    const double value = lensprof_levels_to_value(levels, channel, sample);
    return value < 0.0 ? 0.0 : value > 1.0 ? 1.0 : value;
}

/* g of every code. The place among the response's samples rises with the code. */
static void fill_inverse(const struct lp_model_response *response, const lensprof_levels *levels, uint32_t channel,
                         size_t codes, float *inverse) {
    double below = 0.0, above = lp_is_power(response) ? 1.0 : lp_model_sample(response, 1);
    uint32_t j = 0;
    for (size_t code = 0; code < codes; code++) {
        const double b = grey_of(levels, channel, (double)code / (double)(codes - 1));
        for (; above < b && j + 2 < LENSPROF_RESPONSE_SAMPLES; j++) {
            below = above;
            above = lp_model_sample(response, j + 2);
        }
        inverse[code] = (float)(!(b > 0.0)              ? 0.0
                                : lp_is_power(response) ? lp_curve_power(b, response->gamma, NULL)
                                                        : lp_curve_between(below, above, b, j));
    }
}

/* For every cell of values, the sample at which to begin, and the first step from there. Kernels look at four
 * samples together after the steps; a value may lie beyond two of them. */
static void fill_start(lensprof_plan *plan, const float *samples, uint16_t *start) {
    uint32_t j = 0;
    for (uint32_t cell = 0; cell <= LP_CELLS; cell++) {
        const float least = (float)cell / LP_CELLS;
        const uint32_t before = j;
        while (j + 1 < LENSPROF_RESPONSE_SAMPLES && samples[j + 1] < least) j++;
        start[cell] = (uint16_t)(j < LP_CURVE_LAST - 3 ? j : LP_CURVE_LAST - 3);
        while (j - before > 2 && plan->step < (int32_t)(j - before) / 2) plan->step = plan->step ? 2 * plan->step : 1;
    }
}

float *lp_prepare_curves(lensprof_plan *plan, const lensprof_apply_options *o, const lp_model *m, float *memory) {
    const size_t codes = codes_of(o, m), starts = starts_of(o, m);
    const size_t forward = samples_of(o, m, starts, LP_OUTPUT), backward = samples_of(o, m, starts, LP_INPUT);
    const size_t samples = forward + backward;
    plan->curves = lp_curves(o, m);
    plan->decode = decode_of(o, m);
    plan->encode = encode_of(o, m);
    float *inverse = memory + plan->curves * samples + (samples ? 1 : 0), *after = inverse + plan->curves * codes;
    uint16_t *start = (uint16_t *)(void *)after;
    if (samples) inverse[-1] = 0.0f; /* kernels read it, times 0 */
    plan->forward = memory;
    plan->backward = backward ? memory + plan->curves * forward : memory;
    plan->inverse = codes ? inverse : NULL;
    plan->start = starts ? start : NULL;
    plan->inverse_shift = codes == 256 ? 8 : 16;
    for (uint32_t c = 0; c < plan->curves; c++) {
        const struct lp_model_response *in = lp_response(o, m, LP_INPUT, c), *out = lp_response(o, m, LP_OUTPUT, c);
        plan->exponent[c] = lp_is_power(out) ? (float)(1.0 / out->gamma) : 0.0f;
        plan->inverse_exponent[c] = lp_is_power(in) ? (float)in->gamma : 0.0f;
        if (codes)
            fill_inverse(in, LP_HAS_LEVELS ? lp_levels_of(m, LP_INPUT) : NULL, plan->channels == 1 ? 1 : c, codes,
                         inverse + c * codes);
        float *to = memory + c * forward; /* f of the output, then that of the input if it has another table */
        const struct lp_model_response *response = out;
        for (size_t left = forward, end = 0; end < 2; end++) { /* not read if there is an exponent */
            for (size_t j = 0; j < left; j++)
                to[j] = lp_is_power(response) ? 0.0f : (float)lp_model_sample(response, (uint32_t)j);
            to = memory + plan->curves * forward + c * backward, response = in, left = backward;
        }
        memset(start + c * starts, 0, starts * sizeof *start);
        if (starts && !lp_is_power(in))
            fill_start(plan, plan->backward + c * LENSPROF_RESPONSE_SAMPLES, start + c * starts);
    }
    return after + (plan->curves * starts + 1) / 2;
}

size_t lp_curve_numbers(const lensprof_apply_options *o, const lp_model *m) {
    const size_t starts = starts_of(o, m);
    const size_t samples = samples_of(o, m, starts, LP_OUTPUT) + samples_of(o, m, starts, LP_INPUT);
    return lp_curves(o, m) * (samples + codes_of(o, m)) + (lp_curves(o, m) * starts + 1) / 2 + (samples ? 1 : 0);
}
