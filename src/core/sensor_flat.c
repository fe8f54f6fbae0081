/* Flat fields captured on a device: rows of samples added up in integers (lensprof/sensor.h).
 *
 * The light of a plane is a bilinear surface L(x) = sum_i n_i w_i(x): w_i is 1 at node i and 0 at its neighbours. The
 * least squares of the nodes need b_i = sum_x w_i(x) B(x), which is added up here; sensor_flat_fit.c solves the rest.
 */
#include "core/sensor_flat.h"

#include <string.h>

#include "core/fail.h"
#include "core/options.h"
#include "core/readout.h"

static size_t bytes_of(uint32_t nodes) { return sizeof(lensprof_sensor_flat) + nodes * sizeof(uint64_t); }

size_t lensprof_sensor_flat_bytes(const lensprof_readout *readout) {
    const uint32_t nodes = lp_readout_nodes(readout);
    return nodes ? bytes_of(nodes) : 0;
}

lensprof_status lensprof_sensor_flat_init(void *memory, size_t size, uint32_t frame_width, uint32_t frame_height,
                                          const lensprof_readout *given, lensprof_sensor_flat **result,
                                          lensprof_error *error) {
    if (!memory || !given || !result) return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "memory, readout or flat is NULL");
    lensprof_readout readout;
    const lensprof_status status = lp_readout_take(&readout, given, frame_width, frame_height, error);
    if (status != LENSPROF_OK) return status;
    if (readout.levels && lp_sensor_levels_validate(readout.levels) != LENSPROF_OK)
        return lp_fail(error, LENSPROF_ERROR_ARGUMENT, "levels: black is not below white, or white over 65535");
    const size_t bytes = bytes_of(lp_readout_nodes(&readout));
    if (size < bytes || (uintptr_t)memory % 8) return lp_fail(error, LENSPROF_ERROR_CAPACITY, LP_MEMORY_TEXT);
    lensprof_sensor_flat *flat = memory;
    memset(flat, 0, bytes);
    flat->magic = LP_FLAT_MAGIC, flat->bytes = (uint32_t)bytes;
    flat->grid = lp_readout_grid(&readout, frame_width, frame_height);
    flat->white = readout.levels ? readout.levels->white : 65535.0;
    if (readout.levels) memcpy(flat->black, readout.levels->black, sizeof flat->black);
    *result = flat;
    return lp_fail(error, LENSPROF_OK, "");
}

lensprof_status lensprof_sensor_flat_open(void *data, size_t size, lensprof_sensor_flat **result) {
    lensprof_sensor_flat *flat = data;
    if (!data || !result || (uintptr_t)data % 8) return LENSPROF_ERROR_ARGUMENT;
    if (size < sizeof *flat) return LENSPROF_ERROR_CAPACITY;
    if ((flat->magic ^ LP_FLAT_MAGIC) & 0xffffffu) return LENSPROF_ERROR_CORRUPT;
    if (flat->magic != LP_FLAT_MAGIC) return LENSPROF_ERROR_LAYOUT;
    if (flat->bytes > size) return LENSPROF_ERROR_CAPACITY;
    lensprof_sensor_levels levels;
    memcpy(levels.black, flat->black, sizeof levels.black);
    levels.white = flat->white;
    if (!lp_sensor_grid_is_sound(&flat->grid) || lp_sensor_levels_validate(&levels) != LENSPROF_OK
        || flat->samples > (uint64_t)flat->grid.width * flat->grid.height * LP_FLAT_MOST_PICTURES
        || flat->bytes != bytes_of(flat->grid.planes * lp_sensor_grid_nodes(&flat->grid)))
        return LENSPROF_ERROR_CORRUPT;
    *result = flat;
    return LENSPROF_OK;
}

/* ---- samples ---- */

/* Sums of one plane in one cell of a row: of the samples, and of the samples times their part of the way. */
typedef struct cell_sums {
    uint64_t of_samples, of_parts;
} cell_sums;

static cell_sums add_cell(const lp_sensor_axis *axis, const uint16_t *from, uint32_t count, uint32_t side,
                          uint32_t rest) {
    cell_sums sums = {0, 0};
    for (; count; count--, from += side, rest += axis->step * side) {
        sums.of_samples += *from;
        sums.of_parts += *from * lp_flat_part(axis, rest);
    }
    return sums;
}

/* Samples of one plane: those at x, x + side, ... of a row. */
static void add_plane(lensprof_sensor_flat *flat, const uint16_t *from, uint32_t x, uint32_t count, uint32_t y) {
    const lp_sensor_grid *grid = &flat->grid;
    const lp_sensor_axis *across = &grid->axis[0];
    const lp_sensor_place row = lp_sensor_place_at(&grid->axis[1], grid->rows, y);
    const uint32_t down = lp_flat_part(&grid->axis[1], row.rest), stride = across->step * grid->side;
    uint64_t *above = lp_flat_sums(flat, lp_sensor_plane_at(grid, x, y)) + row.node * grid->columns,
             *below = above + grid->columns;
    lp_sensor_place place = lp_sensor_place_at(across, grid->columns, x);
    while (count) {
        const uint32_t here = lp_sensor_in_cell(across, grid->columns, place, stride, count);
        const cell_sums sums = add_cell(across, from, here, grid->side, place.rest);
        const uint64_t left = sums.of_samples * LP_FLAT_ONE - sums.of_parts;
        above[place.node] += left * (LP_FLAT_ONE - down), above[place.node + 1] += sums.of_parts * (LP_FLAT_ONE - down);
        below[place.node] += left * down, below[place.node + 1] += sums.of_parts * down;
        from += here * grid->side, count -= here;
        place.node++, place.rest += here * stride - across->whole;
    }
}

static uint32_t count_saturated(const lensprof_sensor_flat *flat, const uint16_t *row, uint32_t width) {
    const uint32_t white = (uint32_t)flat->white;
    uint32_t count = 0;
    for (uint32_t x = 0; x < width; x++) count += row[x] >= white;
    return count;
}

lensprof_status lensprof_sensor_flat_add(lensprof_sensor_flat *flat, const lensprof_image *samples, uint32_t x0,
                                         uint32_t y0) {
    if (!flat || !samples) return LENSPROF_ERROR_ARGUMENT;
    const lp_sensor_grid *grid = &flat->grid;
    const lp_tiles tiles = {LENSPROF_SAMPLE_U16, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY, grid->width, grid->height};
    const lensprof_status status = lp_tile_validate(&tiles, samples, samples, x0, y0);
    if (status != LENSPROF_OK) return status;
    const uint64_t more = (uint64_t)samples->width * samples->height;
    if (flat->samples + more > (uint64_t)grid->width * grid->height * lp_flat_most_pictures(grid))
        return LENSPROF_ERROR_CAPACITY;
    for (uint32_t y = 0; y < samples->height; y++) {
        const uint16_t *row =
            (const uint16_t *)(const void *)((const uint8_t *)samples->data + (ptrdiff_t)y * samples->row_bytes);
        for (uint32_t i = 0; i < grid->side && i < samples->width; i++)
            add_plane(flat, row + i, x0 + i, (samples->width - i + grid->side - 1) / grid->side, y0 + y);
        flat->saturated += count_saturated(flat, row, samples->width);
    }
    flat->samples += more;
    lp_flat_add_moments(flat->moments, x0, y0, samples->width, samples->height);
    return LENSPROF_OK;
}
