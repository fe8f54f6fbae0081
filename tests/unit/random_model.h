/* Random models of real cameras, and the expected result of applying one, in double precision. */
#ifndef LENSPROF_TESTS_RANDOM_MODEL_H
#define LENSPROF_TESTS_RANDOM_MODEL_H

#include "support.h"

#include <lensprof/apply.h>

enum {
    MODEL_WIDTH = 4000,
    MODEL_HEIGHT = 3000
};

typedef struct model {
    lensprof_response response[3], output[3];
    lensprof_vignetting vignetting[3];
    lensprof_gain_grid grid;
    lensprof_levels levels[2]; /* of input and output */
    lensprof_image_circle circle;
    lensprof_apply_options options;
} model;

static void random_response(lensprof_response *r, uint64_t *random) {
    uint32_t kind = (uint32_t)(4 * lp_random(random));
    double emor[4], sizes[4] = {1.0, 0.5, 0.3, 0.1}, table[40] = {0.0};
    lensprof_response_set_linear(r);
    if (kind == 1) assert_ok(lensprof_response_set_gamma(r, 1.0 + 1.6 * lp_random(random)));
    if (kind == 2) do
            for (int i = 0; i < 4; i++) emor[i] = sizes[i] * (2.0 * lp_random(random) - 1.0);
        while (lensprof_response_set_emor(r, emor, 4) != LENSPROF_OK);
    if (kind < 3) return;
    for (int i = 1; i < 40; i++) table[i] = table[i - 1] + 0.2 + lp_random(random);
    for (int i = 0; i < 40; i++) table[i] /= table[39];
    assert_ok(lensprof_response_set_table(r, table, 40));
}

/* Falloffs of real lenses: between .25 and 1.1 everywhere in the frame. */
static void random_falloff(lensprof_vignetting *v, const double center[2], uint64_t *random) {
    int good = 0;
    while (!good) {
        for (int n = 0; n < 3; n++) v->k[n] = 1.2 * lp_random(random) - 0.8;
        v->center[0] = center[0], v->center[1] = center[1];
        good = 1;
        for (double r = 0.0; r <= 1.2; r += 0.02) {
            double m = lensprof_vignetting_eval(v, r * r, NULL);
            good = good && m > 0.25 && m < 1.1;
        }
    }
}

static void random_model(model *m, uint64_t *random) {
    memset(m, 0, sizeof *m);
    lensprof_apply_options *o = &m->options;
    lensprof_apply_options_init(o);
    const double center[2] = {0.1 * (lp_random(random) - 0.5), 0.1 * (lp_random(random) - 0.5)};
    o->responses = lp_random(random) < 0.5 ? 1 : 3;
    o->vignettings = lp_random(random) < 0.5 ? 1 : 3;
    for (int c = 0; c < 3; c++) {
        random_response(&m->response[c], random);
        random_falloff(&m->vignetting[c], center, random);
    }
    o->response = m->response, o->vignetting = m->vignetting;
    o->frame_width = MODEL_WIDTH, o->frame_height = MODEL_HEIGHT;
    o->direction = lp_random(random) < 0.3;
    o->saturated = LENSPROF_SATURATED_AS_VALUE;
    o->source.ev = 2.0 * lp_random(random) - 1.0;
    for (int c = 0; c < 3; c += 2) o->source.white_balance[c] = 0.7 + 0.6 * lp_random(random);
    if (lp_random(random) < 0.3) o->strength = lp_random(random);
    if (lp_random(random) < 0.3) o->gain_cap = 1.0 + 2.0 * lp_random(random);
    if (lp_random(random) < 0.3) {
        m->grid.columns = 2 + (uint32_t)(31 * lp_random(random));
        m->grid.rows = 2 + (uint32_t)(31 * lp_random(random));
        m->grid.channels = lp_random(random) < 0.5 ? 1 : 3;
        for (uint32_t i = 0; i < m->grid.columns * m->grid.rows * m->grid.channels; i++)
            m->grid.attenuation[i] = (float)(0.8 + 0.4 * lp_random(random));
        o->grid = &m->grid;
    }
    uint64_t of_circle = *random; /* the other numbers stay */
    if (lp_random(&of_circle) < 0.3) {
        for (int d = 0; d < 2; d++) m->circle.center[d] = 0.2 * (lp_random(&of_circle) - 0.5);
        m->circle.radius = 0.4 + 0.5 * lp_random(&of_circle);
        o->image_circle = &m->circle;
    }
}

/* Levels of a sensor, of one pedestal or one per channel. */
static void random_levels(lensprof_levels *levels, uint64_t *random) {
    const double black = 0.2 * lp_random(random) - 0.05;
    const int is_one = lp_random(random) < 0.5;
    for (int c = 0; c < 3; c++) levels->black[c] = is_one ? black : black + 0.1 * lp_random(random);
    levels->white = lp_random(random) < 0.3 ? 0.0 : 0.5 + 0.5 * lp_random(random);
}

static inline void random_levels_of_model(model *m, uint64_t *random) {
    for (int end = 0; end < 2; end++) random_levels(&m->levels[end], random);
    m->options.levels = lp_random(random) < 0.8 ? &m->levels[0] : NULL;
    m->options.output_levels = lp_random(random) < 0.7 ? m->options.levels : &m->levels[1];
}

static inline double white_of_output(const model *m) {
    const lensprof_levels *levels = m->options.output_levels;
    return levels && levels->white > 0.0 ? levels->white : 1.0;
}

static int has_levels(const model *m) { return m->options.levels || m->options.output_levels; }

/* Those that a layout uses: grey that of green. */
static int are_linear(const lensprof_response *responses, uint32_t count, uint32_t layout) {
    const int is_grey = lensprof_layout_channels(layout) == 1;
    for (uint32_t c = 0; c < count; c++)
        if (responses[c].kind != LENSPROF_RESPONSE_LINEAR && !(is_grey && count == 3 && c != 1)) return 0;
    return 1;
}

/* What the light of a channel is multiplied by at a pixel. */
static inline double reference_gain(const model *m, uint32_t c, uint32_t x, uint32_t y) {
    const lensprof_apply_options *o = &m->options;
    const lensprof_vignetting *v = &m->vignetting[o->vignettings == 3 ? c : 0];
    double r2 = lensprof_vignetting_r2(v, o->frame_width, o->frame_height, x, y, NULL);
    double falloff = lensprof_vignetting_eval(v, r2, NULL);
    if (o->grid) falloff *= lensprof_gain_grid_eval(o->grid, o->frame_width, o->frame_height, x, y, c);
    falloff = 1.0 + o->strength * (falloff - 1.0);
    if (o->gain_cap > 0.0) falloff = fmax(falloff, 1.0 / o->gain_cap);
    if (o->image_circle && !lensprof_image_circle_contains(o->image_circle, o->frame_width, o->frame_height, x, y))
        falloff = 1.0;
    double ratio =
        (exp2(o->target.ev) * o->target.white_balance[c]) / (exp2(o->source.ev) * o->source.white_balance[c]);
    return o->direction == LENSPROF_DIRECTION_CORRECT ? ratio / falloff : falloff / ratio;
}

/* The sample of a channel after its light is multiplied by a gain. */
static inline double reference_of_gain(const model *m, double sample, uint32_t c, double gain) {
    const lensprof_apply_options *o = &m->options;
    const double value = o->levels ? lensprof_levels_to_value(o->levels, c, sample) : sample;
    const lensprof_response *r = &m->response[o->responses == 3 ? c : 0];
    const lensprof_response *out = o->output_responses ? &m->output[o->output_responses == 3 ? c : 0] : r;
    const int any = has_levels(m);
    const int linear_in =
        o->input == LENSPROF_ENCODING_LINEAR || (any && are_linear(m->response, o->responses, o->source_layout));
    const int linear_out = o->output == LENSPROF_ENCODING_LINEAR
                           || (any
                               && (o->output_responses ? are_linear(m->output, o->output_responses, o->source_layout)
                                                       : are_linear(m->response, o->responses, o->source_layout)));
    double light = linear_in ? value : lensprof_response_invert(r, value, NULL);
    light *= gain;
    light = linear_out ? light : lensprof_response_eval(out, light, NULL);
    return o->output_levels ? lensprof_levels_to_sample(o->output_levels, c, light) : light;
}

/* The formula of apply.h for a sample of a channel at a pixel. */
static inline double reference(const model *m, double sample, uint32_t c, uint32_t x, uint32_t y) {
    return reference_of_gain(m, sample, c, reference_gain(m, c, x, y));
}

#endif
