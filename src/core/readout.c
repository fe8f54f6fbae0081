/* Readouts of sensors (lensprof/sensor.h): their validation, and the positions of samples among the nodes. */
#include "core/readout.h"

#include <string.h>

#include "core/fail.h"
#include "core/gain_grid.h"
#include "core/sized.h"

#define FIRST_READOUT LP_END_OF(lensprof_readout, output_levels)
#define LARGEST_STEP 16
#define LEAST_SPAN 1.0 /* codes from black to white */

void lensprof_readout_init_sized(lensprof_readout *readout, size_t size) {
    if (!lp_sized_begin(readout, size, FIRST_READOUT)) return;
    readout->step = readout->side = 1;
    readout->columns = 17, readout->rows = 13;
    memset(readout->channel, 1, sizeof readout->channel);
}

static const char letters[] = "RGgBIW";
#define LETTERS (sizeof letters - 1)

static uint32_t letter_of(char color) {
    uint32_t letter = 0;
    while (letter < LETTERS && letters[letter] != color) letter++;
    return letter;
}

lensprof_status lensprof_readout_set_mosaic(lensprof_readout *readout, const char *colors) {
    uint8_t letter[16] = {0}, plane_of[LETTERS + 1] = {0}, occurs[LETTERS + 1] = {0}, planes = 0;
    uint32_t count = 0;
    if (!readout || !colors) return LENSPROF_ERROR_ARGUMENT;
    if (lp_sized_wrong(readout, FIRST_READOUT, sizeof *readout)) return LENSPROF_ERROR_STRUCT_SIZE;
    for (; colors[count] && count < sizeof letter; count++) {
        letter[count] = (uint8_t)letter_of(colors[count]);
        occurs[letter[count]] = 1;
    }
    if (colors[count] || (count != 1 && count != 4 && count != 16)) return LENSPROF_ERROR_SIZE;
    for (uint32_t i = 0; i < LETTERS; i++)
        if (occurs[i]) plane_of[i] = planes++;
    if (occurs[LETTERS] || planes > LENSPROF_SENSOR_PLANES) return LENSPROF_ERROR_ARGUMENT;
    readout->side = count == 1 ? 1 : count == 4 ? 2 : 4;
    memset(readout->plane, 0, sizeof readout->plane);
    memset(readout->channel, 1, sizeof readout->channel);
    for (uint32_t i = 0; i < count; i++) readout->plane[i] = plane_of[letter[i]];
    if (occurs[letter_of('R')]) readout->channel[plane_of[letter_of('R')]] = 0;
    if (occurs[letter_of('B')]) readout->channel[plane_of[letter_of('B')]] = 2;
    return LENSPROF_OK;
}

/* What does not depend on the frame: pattern, grid and enumerators. */
static int is_readout_sound(const lensprof_readout *r) {
    if ((r->side != 1 && r->side != 2 && r->side != 4) || r->flip > LENSPROF_FLIP_BOTH) return 0;
    for (uint32_t i = 0; i < r->side * r->side; i++)
        if (r->plane[i] >= LENSPROF_SENSOR_PLANES) return 0;
    for (uint32_t p = 0; p < LENSPROF_SENSOR_PLANES; p++)
        if (r->channel[p] > 2) return 0;
    return r->step >= 1 && r->step <= LARGEST_STEP;
}

uint32_t lp_readout_planes(const lensprof_readout *r) {
    uint32_t planes = 1;
    for (uint32_t i = 0; i < r->side * r->side; i++)
        if (r->plane[i] >= planes) planes = r->plane[i] + 1u;
    return planes;
}

/* Whether a window lies in the frame, on one axis; sets its number of samples if that is 0. */
static int take_window(uint32_t frame, uint32_t first, uint32_t step, uint32_t *samples) {
    if (frame > LP_SENSOR_LARGEST_SIDE || first >= frame) return 0;
    if (!*samples) *samples = (frame - first) / step;
    return *samples && *samples <= (frame - first) / step;
}

/* Cells hold a pattern, and not too many samples of a colour. */
static int are_cells_sound(uint32_t frame, uint32_t nodes, uint32_t stride) {
    return lp_is_sensor_grid_side(nodes) && stride * (nodes - 1) <= frame - 1
           && frame - 1 <= stride * LP_SENSOR_LARGEST_CELL * (nodes - 1);
}

static lensprof_status validate_size(lensprof_readout *r, uint32_t width, uint32_t height, lensprof_error *error) {
    const uint32_t stride = r->side * r->step;
    if (!take_window(width, r->x, r->step, &r->width) || !take_window(height, r->y, r->step, &r->height))
        return lp_fail(error, LENSPROF_ERROR_SIZE, "the readout is not in the frame, or a side is over 65535");
    if (!are_cells_sound(width, r->columns, stride) || !are_cells_sound(height, r->rows, stride))
        return lp_fail(error, LENSPROF_ERROR_SIZE, "grid: 2..33 nodes a side, 1..1024 patterns a cell");
    const uint32_t nodes = r->gains ? lp_readout_planes(r) * r->columns * r->rows : 0;
    for (uint32_t i = 0; i < nodes; i++)
        if (!lp_is_attenuation(r->gains[i])) return lp_fail(error, LENSPROF_ERROR_VIGNETTING, "gains: 0.001..1000");
    return LENSPROF_OK;
}

/* What does not depend on the frame. */
static lensprof_status take(lensprof_readout *r, const lensprof_readout *given, lensprof_error *error) {
    lensprof_readout_init(r);
    const char *wrong = lp_sized_take(r, given, FIRST_READOUT);
    if (wrong) return lp_fail(error, LENSPROF_ERROR_STRUCT_SIZE, wrong);
    if (!is_readout_sound(r))
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "readout: side, plane, channel, flip or step 1..16");
    return LENSPROF_OK;
}

uint32_t lp_readout_nodes(const lensprof_readout *given) {
    lensprof_readout r;
    const int is_good = given && take(&r, given, NULL) == LENSPROF_OK && lp_is_sensor_grid_side(r.columns)
                        && lp_is_sensor_grid_side(r.rows);
    return is_good ? lp_readout_planes(&r) * r.columns * r.rows : 0;
}

lensprof_status lp_readout_take(lensprof_readout *r, const lensprof_readout *given, uint32_t frame_width,
                                uint32_t frame_height, lensprof_error *error) {
    const lensprof_status status = take(r, given, error);
    return status == LENSPROF_OK ? validate_size(r, frame_width, frame_height, error) : status;
}

lensprof_status lp_sensor_levels_validate(const lensprof_sensor_levels *levels) {
    if (!(levels->white >= 1.0 && levels->white <= 65535.0)) return LENSPROF_ERROR_ARGUMENT;
    for (uint32_t p = 0; p < LENSPROF_SENSOR_PLANES; p++)
        if (!(levels->black[p] >= -32768.0 && levels->white - levels->black[p] >= LEAST_SPAN))
            return LENSPROF_ERROR_ARGUMENT;
    return LENSPROF_OK;
}

/* ---- positions ---- */

int lp_readout_is_flipped(const lensprof_readout *r, int axis) {
    return r->flip & (axis ? LENSPROF_FLIP_VERTICAL : LENSPROF_FLIP_HORIZONTAL) ? 1 : 0;
}

/* Sample i is at pixel p = first + step (i + 1/2) - 1/2, and at node p (nodes - 1) / (frame - 1): in units of half
 * pixels divided by the number of cells, so that all is whole. A flipped axis counts from the other end of the frame.
 */
static lp_sensor_axis axis_of(const lensprof_readout *r, int axis, uint32_t frame) {
    const uint32_t samples = axis ? r->height : r->width, before = axis ? r->y : r->x;
    const uint32_t cells = (axis ? r->rows : r->columns) - 1;
    const uint32_t first = lp_readout_is_flipped(r, axis) ? frame - before - samples * r->step : before;
    return lp_sensor_axis_of((2 * first + r->step - 1) * cells, 2 * r->step * cells, 2 * (frame - 1));
}

lp_sensor_grid lp_readout_grid(const lensprof_readout *r, uint32_t frame_width, uint32_t frame_height) {
    lp_sensor_grid grid;
    memset(&grid, 0, sizeof grid);
    grid.width = r->width, grid.height = r->height;
    grid.side = (uint8_t)r->side, grid.planes = (uint8_t)lp_readout_planes(r), grid.flip = (uint8_t)r->flip;
    memcpy(grid.plane, r->plane, r->side * r->side);
    grid.columns = r->columns, grid.rows = r->rows;
    grid.axis[0] = axis_of(r, 0, frame_width);
    grid.axis[1] = axis_of(r, 1, frame_height);
    return grid;
}
