/* Sensor plans, rounded from double precision (lensprof/sensor.h). */
#include <math.h>
#include <string.h>

#include "core/fail.h"
#include "core/gain_grid.h"
#include "core/options.h"
#include "core/sensor_plan.h"

/* ---- the model ---- */

static int is_linear(const lensprof_apply_options *o, const lp_model *m) {
    int linear = 1;
    for (uint32_t c = 0; c < m->responses; c++) linear = linear && m->response[c].kind == LENSPROF_RESPONSE_LINEAR;
    const int is_output_linear = linear && !m->outputs;
    return (linear || o->input == LENSPROF_ENCODING_LINEAR)
           && (is_output_linear || o->output == LENSPROF_ENCODING_LINEAR);
}

/* M of a channel, with the gain grid. */
static double attenuation_at(const lensprof_apply_options *o, const lp_model *m, uint32_t channel, double x, double y) {
    const lensprof_vignetting *v = &m->vignetting[m->vignettings == 3 ? channel : 0];
    const double r2 = lensprof_vignetting_r2(v, o->frame_width, o->frame_height, x, y, NULL);
    const double falloff = lensprof_vignetting_eval(v, r2, NULL);
    if (!m->columns) return falloff;
    const lp_grid_cell column = lp_grid_cell_at(x, o->frame_width, m->columns);
    const lp_grid_cell row = lp_grid_cell_at(y, o->frame_height, m->rows);
    const uint32_t plane = m->channels == 3 ? channel : 0;
    const uint32_t first = (plane * m->rows + row.node) * m->columns + column.node;
    const float node[4] = {lp_model_node(m, first), lp_model_node(m, first + 1), lp_model_node(m, first + m->columns),
                           lp_model_node(m, first + m->columns + 1)};
    return falloff * lp_grid_value(node, 2, (lp_grid_cell){0, column.fraction}, (lp_grid_cell){0, row.fraction});
}

static double with_strength(const lp_sensor_source *s, uint32_t channel, double x, double y) {
    return 1.0 + s->options.strength * (attenuation_at(&s->options, &s->model, channel, x, y) - 1.0);
}

/* With strength, chroma and gain cap, as apply.h states them. */
static double corrected_attenuation(const lp_sensor_source *s, uint32_t channel, double x, double y) {
    static const double weight[3] = {0.2126, 0.7152, 0.0722};
    const double cap = s->options.gain_cap > 0.0 ? s->options.gain_cap : LP_LARGEST_GAIN_CAP;
    double of = with_strength(s, channel, x, y);
    if (s->options.chroma) {
        double luminance = 0.0;
        for (uint32_t c = 0; c < 3; c++) luminance += weight[c] * with_strength(s, c, x, y);
        of = s->has_colours ? of / luminance : 1.0;
    }
    return fmax(of, 1.0 / cap);
}

double lp_sensor_gain(const lp_sensor_source *s, uint32_t plane, double x, double y) {
    const uint32_t channel = s->readout.channel[plane];
    const double gain = lp_exposure_ratio(&s->options, channel) / corrected_attenuation(s, channel, x, y);
    return s->options.direction == LENSPROF_DIRECTION_SIMULATE ? 1.0 / gain : gain;
}

/* ---- validation ---- */

static lensprof_status take_levels(lp_sensor_source *s) {
    const lensprof_sensor_levels *given[2] = {s->readout.levels, s->readout.output_levels};
    if (!given[1] && given[0]) given[1] = given[0];
    for (int end = LP_INPUT; end <= LP_OUTPUT; end++) {
        lensprof_sensor_levels *levels = &s->levels[end];
        const lensprof_levels *of_model = lp_levels_of(&s->model, end);
        levels->white = 65535.0 * lp_white_level(of_model);
        for (uint32_t p = 0; p < LENSPROF_SENSOR_PLANES; p++)
            levels->black[p] = 65535.0 * of_model->black[s->readout.channel[p]];
        if (given[end]) *levels = *given[end];
        if (lp_sensor_levels_validate(levels) != LENSPROF_OK) return LENSPROF_ERROR_ARGUMENT;
    }
    return LENSPROF_OK;
}

lensprof_status lp_sensor_source_take(lp_sensor_source *s, const lensprof_apply_options *options,
                                      const lensprof_readout *readout, lensprof_error *error) {
    lensprof_status status = lp_options_validate(options, &s->options, &s->model, error);
    if (status != LENSPROF_OK) return status;
    status = lp_readout_take(&s->readout, readout, s->options.frame_width, s->options.frame_height, error);
    if (status != LENSPROF_OK) return status;
    if (!is_linear(&s->options, &s->model))
        return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "sensor samples are linear: LINEAR input and output");
    if ((LP_HAS_CIRCLE && s->model.circle.radius > 0.0) || s->options.dither)
        return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "grids of gains take no image circle or dither");
    if (take_levels(s) != LENSPROF_OK)
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "levels: black is not below white, or white over 65535");
    s->has_colours = 0;
    for (uint32_t p = 1; p < lp_readout_planes(&s->readout); p++)
        if (s->readout.channel[p] != s->readout.channel[0])
            s->has_colours = s->model.vignettings == 3 || s->model.channels == 3;
    return LENSPROF_OK;
}

/* ---- plans ---- */

static double pixel_at(const lp_sensor_source *s, int axis, double node) {
    const double last = (axis ? s->options.frame_height : s->options.frame_width) - 1.0;
    return last * node / ((axis ? s->readout.rows : s->readout.columns) - 1.0);
}

/* By how much a straight line between `gain`, that at a node, and that of its neighbours is above the gain in the
 * middle; mean of the neighbours on an axis. */
static double excess_at(const lp_sensor_source *s, uint32_t plane, uint32_t column, uint32_t row, int axis,
                        double gain) {
    const uint32_t at = axis ? row : column, nodes = axis ? s->readout.rows : s->readout.columns;
    const double x = pixel_at(s, 0, column), y = pixel_at(s, 1, row);
    double excess = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        if (side < 0 ? at == 0 : at + 1 == nodes) continue;
        const double next = pixel_at(s, axis, (double)at + side), middle = pixel_at(s, axis, at + 0.5 * side);
        const double there = lp_sensor_gain(s, plane, axis ? x : next, axis ? next : y);
        excess += 0.5 * (gain + there) - lp_sensor_gain(s, plane, axis ? x : middle, axis ? middle : y);
    }
    return at == 0 || at + 1 == nodes ? excess : 0.5 * excess;
}

static double own_at(const lp_sensor_source *s, uint32_t plane, uint32_t column, uint32_t row) {
    const lensprof_readout *r = &s->readout;
    return r->gains ? (double)r->gains[(plane * r->rows + row) * r->columns + column] : 1.0;
}

/* Of the gains of light at the nodes of a plane. */
typedef struct gain_range {
    double least, most;
} gain_range;

/* The gain of light at a node, of the nodes as the plan counts them. Half of the excess is subtracted, so that a cell
 * is too bright in its middle by what it is too dark at its corners; but not beyond the range of the gains: at the
 * least one highlights are clipped, and the largest one has the largest integer. */
static double node_at(const lp_sensor_source *s, uint32_t plane, uint32_t column, uint32_t row, gain_range range) {
    const lensprof_readout *r = &s->readout;
    if (lp_readout_is_flipped(r, 0)) column = r->columns - 1 - column;
    if (lp_readout_is_flipped(r, 1)) row = r->rows - 1 - row;
    const double exact = lp_sensor_gain(s, plane, pixel_at(s, 0, column), pixel_at(s, 1, row));
    const double excess = excess_at(s, plane, column, row, 0, exact) + excess_at(s, plane, column, row, 1, exact);
    const double gain = fmax(exact - 0.5 * excess, range.least);
    return (gain < range.most ? gain : range.most) * own_at(s, plane, column, row);
}

/* *largest receives the bound of the gains with the readout's own. */
static gain_range find_range(const lp_sensor_source *s, uint32_t plane, double *largest) {
    const double first = lp_sensor_gain(s, plane, 0.0, 0.0);
    gain_range range = {first, first};
    double own = 0.0;
    for (uint32_t row = 0; row < s->readout.rows; row++)
        for (uint32_t column = 0; column < s->readout.columns; column++) {
            const double gain = lp_sensor_gain(s, plane, pixel_at(s, 0, column), pixel_at(s, 1, row));
            if (gain < range.least) range.least = gain;
            range.most = fmax(range.most, gain);
            own = fmax(own, own_at(s, plane, column, row));
        }
    *largest = range.most * own;
    return range;
}

/* The finest unit in which gains of codes fit; 0 = none does. */
static uint32_t shift_of(double largest) {
    uint32_t shift = LP_SENSOR_LARGEST_SHIFT;
    while (shift >= LP_SENSOR_LEAST_SHIFT && largest * (double)(1u << shift) > LP_SENSOR_LARGEST_NODE) shift--;
    return shift < LP_SENSOR_LEAST_SHIFT ? 0 : shift;
}

/* Writes the nodes of a plane. Returns the smallest gain of light among them. */
static double write_nodes(lensprof_sensor_plan *plan, const lp_sensor_source *s, uint32_t plane, gain_range range) {
    uint32_t *node = (uint32_t *)(void *)(plan + 1) + plane * lp_sensor_grid_nodes(&plan->grid);
    const double units = lp_sensor_span(s, LP_OUTPUT, plane) / lp_sensor_span(s, LP_INPUT, plane);
    double smallest = 1.0;
    for (uint32_t row = 0; row < plan->grid.rows; row++)
        for (uint32_t column = 0; column < plan->grid.columns; column++, node++) {
            const double gain = node_at(s, plane, column, row, range);
            const double rounded = floor(gain * units * (double)(1u << plan->shift[plane]) + 0.5);
            if (gain < smallest) smallest = gain;
            *node = rounded < 1.0 ? 1 : (uint32_t)rounded;
        }
    return smallest;
}

static int32_t level_of(double code) { return (int32_t)floor(code * (1 << LP_SENSOR_LEVEL_SHIFT) + 0.5); }

static void prepare_levels(lensprof_sensor_plan *plan, const lp_sensor_source *s, double least) {
    plan->white_in = level_of(s->levels[LP_INPUT].white), plan->white_out = level_of(s->levels[LP_OUTPUT].white);
    const int is_neutral = s->options.saturated == LENSPROF_SATURATED_NEUTRAL && plan->grid.planes > 1
                           && s->options.direction == LENSPROF_DIRECTION_CORRECT;
    for (uint32_t p = 0; p < LENSPROF_SENSOR_PLANES; p++) {
        const double black = s->levels[LP_OUTPUT].black[p];
        plan->black_in[p] = level_of(s->levels[LP_INPUT].black[p]);
        plan->black_out[p] = level_of(black);
        plan->largest[p] =
            (uint32_t)fmax(floor(black + (is_neutral ? least : 1.0) * lp_sensor_span(s, LP_OUTPUT, p) + 0.5), 0.0);
    }
}

static size_t bytes_of_nodes(uint32_t nodes) { return sizeof(lensprof_sensor_plan) + nodes * sizeof(uint32_t); }

size_t lensprof_sensor_plan_bytes(const lensprof_readout *readout) {
    const uint32_t nodes = lp_readout_nodes(readout);
    return nodes ? bytes_of_nodes(nodes) : 0;
}

lensprof_status lensprof_sensor_plan_init(void *memory, size_t size, const lensprof_apply_options *options,
                                          const lensprof_readout *readout, const lensprof_sensor_plan **result,
                                          lensprof_error *error) {
    if (!memory || !options || !readout || !result)
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "memory, options, readout or plan is NULL");
    lp_sensor_source source;
    const lensprof_status status = lp_sensor_source_take(&source, options, readout, error);
    if (status != LENSPROF_OK) return status;
    const size_t bytes = bytes_of_nodes(lp_readout_nodes(&source.readout));
    if (size < bytes || (uintptr_t)memory % 4) return lp_fail(error, LENSPROF_ERROR_CAPACITY, LP_MEMORY_TEXT);
    gain_range range[LENSPROF_SENSOR_PLANES];
    double smallest = 1.0;
    uint8_t shift[LENSPROF_SENSOR_PLANES] = {LP_SENSOR_LEAST_SHIFT, LP_SENSOR_LEAST_SHIFT, LP_SENSOR_LEAST_SHIFT,
                                             LP_SENSOR_LEAST_SHIFT};
    const uint32_t planes = lp_readout_planes(&source.readout);
    for (uint32_t p = 0; p < planes; p++) {
        double largest;
        range[p] = find_range(&source, p, &largest);
        shift[p] =
            (uint8_t)shift_of(largest * lp_sensor_span(&source, LP_OUTPUT, p) / lp_sensor_span(&source, LP_INPUT, p));
        if (!shift[p]) return lp_fail(error, LENSPROF_ERROR_UNSUPPORTED, "gains of 4096 or more");
    }
    lensprof_sensor_plan *plan = memory;
    memset(plan, 0, sizeof *plan);
    plan->magic = LP_SENSOR_MAGIC, plan->bytes = (uint32_t)bytes;
    plan->grid = lp_readout_grid(&source.readout, source.options.frame_width, source.options.frame_height);
    memcpy(plan->shift, shift, sizeof shift);
    for (uint32_t p = 0; p < planes; p++) {
        const double of_plane = write_nodes(plan, &source, p, range[p]);
        if (of_plane < smallest) smallest = of_plane;
    }
    prepare_levels(plan, &source, smallest);
    plan->check = lp_sensor_check(plan);
    *result = plan;
    return lp_fail(error, LENSPROF_OK, "");
}
