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
    uint32_t memory[2048]; /* 8 KiB, enough for every plan */
    const lensprof_fixed_plan *plan;
} fixture;

static const uint32_t layouts[] = {
    LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_GREY_ALPHA, LENSPROF_LAYOUT_RGB,  LENSPROF_LAYOUT_RGBA, LENSPROF_LAYOUT_BGR,
    LENSPROF_LAYOUT_BGRA, LENSPROF_LAYOUT_RGGB,       LENSPROF_LAYOUT_GRBG, LENSPROF_LAYOUT_GBRG, LENSPROF_LAYOUT_BGGR};

static void make_plan(fixture *f) {
    assert_in_range(lensprof_fixed_plan_bytes(&f->m.options), 1, sizeof f->memory);
    assert_ok(lensprof_fixed_plan_init(f->memory, sizeof f->memory, &f->m.options, &f->plan, NULL));
}

/* A random model that an integer plan supports, and random pixels of a row somewhere in its frame. */
static void make_case(fixture *f, uint32_t sample, uint64_t *random) {
    lensprof_apply_options *o = &f->m.options;
    random_model(&f->m, random);
    o->grid = NULL, o->image_circle = NULL;
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

/* The expected code of sample i of the row. */
static inline double wanted_at(const fixture *f, uint32_t i) {
    const uint32_t samples = lensprof_layout_samples(f->from.layout), x = f->x0 + i / samples;
    const double unit = f->from.sample == LENSPROF_SAMPLE_U8 ? 255.0 : 65535.0,
                 code = value_at(f->in, f->from.sample, i);
    const int c = channel_at(f->from.layout, i % samples, x, f->y0);
    if (c < 0) return code;
    return floor(unit * fmin(fmax(reference(&f->m, code / unit, (uint32_t)c, x, f->y0), 0.0), white_of_output(&f->m))
                 + 0.5);
}

#endif
