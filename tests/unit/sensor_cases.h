/* Random sensors: models, readouts, mosaics, grids and levels; and the expected results in double precision. */
#ifndef LENSPROF_TESTS_SENSOR_CASES_H
#define LENSPROF_TESTS_SENSOR_CASES_H

#include "unit/random_model.h"

#include <lensprof/sensor.h>

enum {
    SENSOR_WIDTH = 150, /* samples of a tile */
    SENSOR_ROWS = 4,
    SENSOR_WORDS = 64 + 4 * 33 * 33 /* of a plan */
};

typedef struct sensor_case {
    model m;
    lensprof_readout readout;
    lensprof_sensor_levels levels[2];
    float gains[4 * 33 * 33];
    const char *colors;
    uint32_t x0, y0;
    uint16_t in[SENSOR_ROWS][SENSOR_WIDTH], out[SENSOR_ROWS][SENSOR_WIDTH];
    uint32_t memory[SENSOR_WORDS];
    const lensprof_sensor_plan *plan;
    double node_gain[4][33][33]; /* of light: plane, row, column */
} sensor_case;

static const char *const sensor_colors[] = {
    "G", "RGGB", "RGgB", "GRBg", "gBRG", "BgGR", "RRGGRRGGGGBBGGBB", "RRGGRRGGggBBggBB", "BGRGGIGIRGBGGIGI", "RWWB"};

static uint32_t sensor_below(uint32_t limit, uint64_t *random) { return (uint32_t)(limit * lp_random(random)); }

static void random_sensor_levels(lensprof_sensor_levels *levels, uint64_t *random) {
    const int bits = 10 + 2 * (int)(4 * lp_random(random));
    levels->white = lp_random(random) < 0.5 ? (1 << bits) - 1 : (0.6 + 0.4 * lp_random(random)) * ((1 << bits) - 1);
    const double black = lp_random(random) < 0.2 ? 0.0 : floor(levels->white / 8.0 * lp_random(random));
    const int is_one = lp_random(random) < 0.5;
    for (int p = 0; p < 4; p++) levels->black[p] = is_one ? black : black + 40.0 * (lp_random(random) - 0.5);
}

/* The letter of a sample, by the text that names the mosaic. */
static char letter_at(const sensor_case *c, uint32_t x, uint32_t y) {
    const uint32_t side = c->readout.side;
    return c->colors[y % side * side + x % side];
}

/* Letters before this one in the header's order, of those that occur. */
static uint32_t plane_of(const sensor_case *c, char letter) {
    uint32_t plane = 0;
    for (const char *l = "RGgBIW"; *l != letter; l++)
        if (strchr(c->colors, *l)) plane++;
    return plane;
}

static uint32_t channel_of(char letter) { return letter == 'R' ? 0 : letter == 'B' ? 2 : 1; }

/* Gain of light at a pixel: the formula of apply.h for a value of 1. */
static double model_gain(const sensor_case *c, char letter, double x, double y) {
    const lensprof_apply_options *o = &c->m.options;
    const uint32_t channel = channel_of(letter);
    const lensprof_vignetting *v = &c->m.vignetting[o->vignettings == 3 ? channel : 0];
    const double r2 = lensprof_vignetting_r2(v, o->frame_width, o->frame_height, x, y, NULL);
    double falloff = lensprof_vignetting_eval(v, r2, NULL);
    if (o->grid) falloff *= lensprof_gain_grid_eval(o->grid, o->frame_width, o->frame_height, x, y, channel);
    falloff = 1.0 + o->strength * (falloff - 1.0);
    if (o->gain_cap > 0.0) falloff = fmax(falloff, 1.0 / o->gain_cap);
    const double ratio =
        exp2(o->target.ev - o->source.ev) * o->target.white_balance[channel] / o->source.white_balance[channel];
    return o->direction == LENSPROF_DIRECTION_CORRECT ? ratio / falloff : falloff / ratio;
}

/* The gain at a place between the nodes, in nodes. */
static double gain_between(const sensor_case *c, char letter, double column, double row) {
    return model_gain(c, letter, (c->m.options.frame_width - 1.0) * column / (c->readout.columns - 1.0),
                      (c->m.options.frame_height - 1.0) * row / (c->readout.rows - 1.0));
}

/* Half of the mean excess of straight lines over the gain in their middles, on one axis. */
static double half_excess(const sensor_case *c, char letter, uint32_t column, uint32_t row, int axis) {
    const uint32_t at = axis ? row : column, last = (axis ? c->readout.rows : c->readout.columns) - 1;
    double sum = 0.0, count = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        if ((side < 0 && at == 0) || (side > 0 && at == last)) continue;
        const double du = axis ? 0.0 : side, dv = axis ? side : 0.0;
        sum += (gain_between(c, letter, column, row) + gain_between(c, letter, column + du, row + dv)) / 2
               - gain_between(c, letter, column + du / 2, row + dv / 2);
        count += 1.0;
    }
    return sum / count / 2;
}

/* Gains at the nodes of the grid, with the caller's own. The excess of their neighbours is subtracted, not beyond the
 * range of the gains of all nodes. */
static void find_node_gains(sensor_case *c, char letter) {
    const lensprof_readout *r = &c->readout;
    const uint32_t plane = plane_of(c, letter);
    double least = gain_between(c, letter, 0, 0), most = least;
    for (uint32_t j = 0; j < r->rows; j++)
        for (uint32_t i = 0; i < r->columns; i++) {
            least = fmin(least, gain_between(c, letter, i, j));
            most = fmax(most, gain_between(c, letter, i, j));
        }
    for (uint32_t j = 0; j < r->rows; j++)
        for (uint32_t i = 0; i < r->columns; i++) {
            const double excess = half_excess(c, letter, i, j, 0) + half_excess(c, letter, i, j, 1);
            const double own = r->gains ? (double)r->gains[(plane * r->rows + j) * r->columns + i] : 1.0;
            c->node_gain[plane][j][i] = own * fmin(most, fmax(least, gain_between(c, letter, i, j) - excess));
        }
}

/* The first or second pixel of the frame that a sample of an axis covers, if it is read backwards. */
static double pixel_at(uint32_t first, uint32_t samples, uint32_t step, int is_flipped, uint32_t sample) {
    const uint32_t i = is_flipped ? samples - 1 - sample : sample;
    return first + step * i + 0.5 * (step - 1.0);
}

/* Gain of light at a sample: bilinear between four nodes. */
static double grid_gain(const sensor_case *c, char letter, uint32_t x, uint32_t y) {
    const lensprof_readout *r = &c->readout;
    const double pixel_x = pixel_at(r->x, r->width, r->step, r->flip & 1, x);
    const double pixel_y = pixel_at(r->y, r->height, r->step, r->flip & 2, y);
    const double u = pixel_x * (r->columns - 1.0) / (c->m.options.frame_width - 1.0);
    const double v = pixel_y * (r->rows - 1.0) / (c->m.options.frame_height - 1.0);
    uint32_t i = (uint32_t)u, j = (uint32_t)v;
    if (i > r->columns - 2) i = r->columns - 2;
    if (j > r->rows - 2) j = r->rows - 2;
    const double s = u - i, t = v - j;
    const double *above = &c->node_gain[plane_of(c, letter)][j][i], *below = above + 33;
    return (1 - t) * ((1 - s) * above[0] + s * above[1]) + t * ((1 - s) * below[0] + s * below[1]);
}

static void make_sensor_plan(sensor_case *c) {
    assert_in_range(lensprof_sensor_plan_bytes(&c->readout), 1, sizeof c->memory);
    assert_ok(lensprof_sensor_plan_init(c->memory, sizeof c->memory, &c->m.options, &c->readout, &c->plan, NULL));
    for (const char *letter = "RGgBIW"; *letter; letter++)
        if (strchr(c->colors, *letter)) find_node_gains(c, *letter);
}

/* A random sensor, and random samples of a tile somewhere in what it reads. */
static inline void make_sensor(sensor_case *c, uint64_t *random) {
    lensprof_apply_options *o = &c->m.options;
    lensprof_readout *r = &c->readout;
    random_model(&c->m, random);
    o->input = o->output = LENSPROF_ENCODING_LINEAR;
    o->image_circle = NULL;
    o->frame_width = 600 + sensor_below(4000, random), o->frame_height = 600 + sensor_below(3000, random);
    lensprof_readout_init(r);
    c->colors = sensor_colors[sensor_below(10, random)];
    assert_ok(lensprof_readout_set_mosaic(r, c->colors));
    r->step = lp_random(random) < 0.6 ? 1 : 1 + sensor_below(3, random);
    r->flip = sensor_below(4, random);
    r->x = sensor_below(20, random), r->y = sensor_below(20, random);
    r->width = (o->frame_width - r->x) / r->step - sensor_below(20, random);
    r->height = (o->frame_height - r->y) / r->step - sensor_below(20, random);
    r->columns = 6 + sensor_below(28, random), r->rows = 6 + sensor_below(28, random);
    if (lp_random(random) < 0.3) {
        for (uint32_t i = 0; i < 4 * r->columns * r->rows; i++) c->gains[i] = (float)(1.0 + lp_random(random));
        r->gains = c->gains;
    }
    for (int end = 0; end < 2; end++) random_sensor_levels(&c->levels[end], random);
    r->levels = lp_random(random) < 0.8 ? &c->levels[0] : NULL;
    r->output_levels = lp_random(random) < 0.7 ? NULL : &c->levels[1];
    c->x0 = sensor_below(r->width - SENSOR_WIDTH, random), c->y0 = sensor_below(r->height - SENSOR_ROWS, random);
    const double white = r->levels ? r->levels->white : 65535.0;
    for (uint32_t y = 0; y < SENSOR_ROWS; y++)
        for (uint32_t x = 0; x < SENSOR_WIDTH; x++) c->in[y][x] = (uint16_t)(white * lp_random(random));
    make_sensor_plan(c);
}

/* Levels in codes of the input or output. */
static void levels_of(const sensor_case *c, int end, uint32_t plane, double *black, double *white) {
    const lensprof_readout *r = &c->readout;
    const lensprof_sensor_levels *levels = end && r->output_levels ? r->output_levels : r->levels;
    *black = levels ? levels->black[plane] : 0.0;
    *white = levels ? levels->white : 65535.0;
}

/* The expected code, not rounded or clipped. */
static double sensor_reference(const sensor_case *c, double code, uint32_t x, uint32_t y) {
    const char letter = letter_at(c, x, y);
    double black[2], white[2];
    for (int end = 0; end < 2; end++) levels_of(c, end, plane_of(c, letter), &black[end], &white[end]);
    const double light = (code - black[0]) / (white[0] - black[0]);
    return black[1] + light * grid_gain(c, letter, x, y) * (white[1] - black[1]);
}

/* The same rounded, and clipped at white. */
static inline uint16_t sensor_wanted(const sensor_case *c, double code, uint32_t x, uint32_t y) {
    double black, white;
    levels_of(c, 1, plane_of(c, letter_at(c, x, y)), &black, &white);
    const double result = floor(sensor_reference(c, code, x, y) + 0.5), most = floor(white + 0.5);
    return (uint16_t)fmax(0.0, fmin(result, most));
}

#endif
