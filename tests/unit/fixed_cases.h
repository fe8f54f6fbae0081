/* Random models for integer plans, pixels for them, and the expected results. */
#ifndef LENSPROF_TESTS_FIXED_CASES_H
#define LENSPROF_TESTS_FIXED_CASES_H

#include "unit/random_model.h"

#include <lensprof/fixed.h>

#ifndef PIXELS
#define PIXELS 200
#endif
enum {
    ROOM = 8 * PIXELS
};

typedef struct fixture {
    model m;
    uint8_t in[ROOM], out[ROOM];
    uint32_t x0, y0, bytes;
    lensprof_image from;
    lensprof_target to;
    uint32_t memory[8192]; /* 32 KiB, enough for every plan */
    const lensprof_fixed_plan *plan;
} fixture;

static const uint32_t layouts[] = {
    LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_GREY_ALPHA, LENSPROF_LAYOUT_RGB,  LENSPROF_LAYOUT_RGBA, LENSPROF_LAYOUT_BGR,
    LENSPROF_LAYOUT_BGRA, LENSPROF_LAYOUT_RGGB,       LENSPROF_LAYOUT_GRBG, LENSPROF_LAYOUT_GBRG, LENSPROF_LAYOUT_BGGR};

static void make_plan(fixture *f) {
    assert_in_range(lensprof_fixed_plan_bytes(&f->m.options), 1, sizeof f->memory);
    assert_ok(lensprof_fixed_plan_init(f->memory, sizeof f->memory, &f->m.options, &f->plan, NULL));
}

/* At most 12 nodes a side, so that plans stay small. */
static void cut_grid(lensprof_gain_grid *grid) {
    if (grid->columns > 12) grid->columns = 12;
    if (grid->rows > 12) grid->rows = 12;
    for (uint32_t i = grid->channels * grid->columns * grid->rows; i < 3 * 32 * 32; i++) grid->attenuation[i] = 0.0f;
}

/* A random model that an integer plan supports, and random pixels of a row somewhere in its frame. */
static void make_case(fixture *f, uint32_t sample, uint64_t *random) {
    lensprof_apply_options *o = &f->m.options;
    random_model(&f->m, random);
    o->image_circle = NULL;
    if (o->grid) cut_grid(&f->m.grid);
    o->source_sample = o->target_sample = sample;
    o->source_layout = layouts[(uint32_t)(10 * lp_random(random))];
    o->frame_width = PIXELS + (uint32_t)(6000 * lp_random(random));
    o->frame_height = 1 + (uint32_t)(5000 * lp_random(random));
    o->input = sample == LENSPROF_SAMPLE_U16 || lp_random(random) < 0.3;
    o->output = sample == LENSPROF_SAMPLE_U16 || lp_random(random) < 0.3;
    const uint32_t samples = lensprof_layout_samples(o->source_layout);
    f->bytes = samples * lensprof_sample_type_bytes(sample);
    for (uint32_t i = 0; i < ROOM; i++) f->in[i] = (uint8_t)(256.0 * lp_random(random));
    f->x0 = (uint32_t)((o->frame_width - PIXELS) * lp_random(random));
    f->y0 = (uint32_t)(o->frame_height * lp_random(random));
    f->from = (lensprof_image){f->in, 0, PIXELS, 1, sample, o->source_layout};
    f->to = (lensprof_target){f->out, 0, PIXELS, 1, sample, o->source_layout};
    make_plan(f);
}

/* The same from `source` to `target`, one of them U16, through responses, linear encoding and, if wanted, levels. */
static inline void make_wide_case(fixture *f, uint32_t source, uint32_t target, int with_levels, uint64_t *random) {
    lensprof_apply_options *o = &f->m.options;
    make_case(f, source, random);
    o->input = lp_random(random) < 0.3;
    o->output = lp_random(random) < 0.3;
    o->target_sample = f->to.sample = target;
    for (int c = 0; c < 3; c++) random_response(&f->m.output[c], random);
    if (lp_random(random) < 0.5)
        o->output_response = f->m.output, o->output_responses = lp_random(random) < 0.5 ? 1 : 3;
    if (with_levels) do
            random_levels_of_model(&f->m, random);
        while (!has_levels(&f->m));
    make_plan(f);
}

/* Colour channel of sample s of pixel (x, y), according to the names of the layouts; -1 for alpha. */
static int channel_at(uint32_t layout, uint32_t s, uint32_t x, uint32_t y) {
    static const char *const orders[] = {"G", "Ga", "RGB", "RGBa", "BGR", "BGRa", "", "RGGB", "GRBG", "GBRG", "BGGR"};
    const char name = orders[layout][layout >= LENSPROF_LAYOUT_RGGB ? 2 * (y & 1) + (x & 1) : s];
    return name == 'R' ? 0 : name == 'G' ? 1 : name == 'B' ? 2 : -1;
}

static double value_at(const uint8_t *data, uint32_t sample, uint32_t i) {
    uint16_t word;
    memcpy(&word, data + 2 * i, sizeof word);
    return sample == LENSPROF_SAMPLE_U8 ? data[i] : word;
}

static inline double full_scale(uint32_t sample) { return sample == LENSPROF_SAMPLE_U8 ? 255.0 : 65535.0; }

/* Whether LENSPROF_SATURATED_NEUTRAL applies to pixels. */
static inline int is_neutral_white(const lensprof_apply_options *o) {
    return o->saturated == LENSPROF_SATURATED_NEUTRAL && o->direction == LENSPROF_DIRECTION_CORRECT
           && o->input == LENSPROF_ENCODING_RESPONSE && o->output == LENSPROF_ENCODING_RESPONSE
           && lensprof_layout_samples(o->source_layout) >= 3;
}

static inline double towards_white(double value, double low) {
    const double t = fmin(fmax((value - low) / (1.0 - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/* The gain of a channel of a pixel of three colours, LENSPROF_SATURATED_NEUTRAL. */
static inline double gain_towards_white(const fixture *f, uint32_t channel, uint32_t pixel) {
    const uint32_t layout = f->from.layout, samples = lensprof_layout_samples(layout), x = f->x0 + pixel;
    const double full = full_scale(f->from.sample), own = reference_gain(&f->m, channel, x, f->y0);
    double brightest = 0.0, darkest = 1.0, largest = 0.0;
    for (uint32_t s = 0; s < samples; s++) {
        const int c = channel_at(layout, s, x, f->y0);
        if (c < 0) continue;
        double value = value_at(f->in, f->from.sample, pixel * samples + s) / full;
        if (f->m.options.levels) value = lensprof_levels_to_value(f->m.options.levels, (uint32_t)c, value);
        brightest = fmax(brightest, value), darkest = fmin(darkest, value);
        largest = fmax(largest, reference_gain(&f->m, (uint32_t)c, x, f->y0));
    }
    return own + towards_white(brightest, 0.9) * towards_white(darkest, 0.6) * (largest - own);
}

/* The expected code of sample i of the row. */
static inline double wanted_at(const fixture *f, uint32_t i) {
    const uint32_t samples = lensprof_layout_samples(f->from.layout), x = f->x0 + i / samples;
    const double full = full_scale(f->from.sample), unit = full_scale(f->to.sample),
                 code = value_at(f->in, f->from.sample, i);
    const int c = channel_at(f->from.layout, i % samples, x, f->y0);
    if (c < 0) return floor(code / full * unit + 0.5);
    const double gain = is_neutral_white(&f->m.options) ? gain_towards_white(f, (uint32_t)c, i / samples)
                                                        : reference_gain(&f->m, (uint32_t)c, x, f->y0);
    const double result = reference_of_gain(&f->m, code / full, (uint32_t)c, gain);
    return floor(unit * fmin(fmax(result, 0.0), white_of_output(&f->m)) + 0.5);
}

/* The largest difference from the reference, in levels; counts identical samples. */
static inline double worst_error(const fixture *f, double *same, double *all) {
    const uint32_t sample = f->to.sample, samples = lensprof_layout_samples(f->from.layout);
    double worst = 0.0;
    for (uint32_t i = 0; i < PIXELS * samples; i++) {
        const double error = fabs(value_at(f->out, sample, i) - wanted_at(f, i));
        worst = fmax(worst, error);
        *same += error == 0.0, *all += 1.0;
    }
    return worst;
}

#endif
