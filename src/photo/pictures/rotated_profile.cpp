#include "photo/pictures/rotated_profile.hpp"

#include <algorithm>
#include <cmath>

#include "photo/pictures/orientation.hpp"

namespace lensprof {
namespace {

constexpr uint16_t kOneWay = 6, kOtherWay = 8;  // orientations

float &node(lensprof_gain_grid &grid, uint32_t channel, uint32_t column, uint32_t row) {
    return grid.attenuation[(channel * grid.rows + row) * grid.columns + column];
}

// Nodes become nodes, because they reach from the first to the last pixel.
lensprof_gain_grid rotated_grid(lensprof_gain_grid &sensor, uint16_t turn) {
    lensprof_gain_grid grid;
    lensprof_gain_grid_init(&grid);
    const bool is_swapped = swaps_sides(turn);
    grid.channels = sensor.channels;
    grid.columns = is_swapped ? sensor.rows : sensor.columns, grid.rows = is_swapped ? sensor.columns : sensor.rows;
    for (uint32_t c = 0; c < grid.channels; c++)
        for (uint32_t j = 0; j < grid.rows; j++)
            for (uint32_t i = 0; i < grid.columns; i++) {
                double x = i - 0.5 * (grid.columns - 1.0), y = j - 0.5 * (grid.rows - 1.0);
                turn_upright(turn, x, y);
                node(grid, c, i, j) =
                    node(sensor, c, static_cast<uint32_t>(std::lround(x + 0.5 * (sensor.columns - 1.0))),
                         static_cast<uint32_t>(std::lround(y + 0.5 * (sensor.rows - 1.0))));
            }
    return grid;
}

}  // namespace

void turn_profile(uint16_t turn, lensprof_profile &profile) {
    for (uint32_t curve = 0; curve < profile.vignettings; curve++) {
        double *centre = profile.vignetting[curve].center;
        turn_upright(inverse_orientation(turn), centre[0], centre[1]);
        if (!turn) centre[0] = centre[1] = 0.0;
    }
    lensprof_image_circle &circle = profile.image_circle;
    turn_upright(inverse_orientation(turn), circle.center[0], circle.center[1]);
    if (!turn && circle.radius > 0.0)  // what both turns have inside, but not the whole of it
        circle = {{0.0, 0.0}, std::max(circle.radius - std::hypot(circle.center[0], circle.center[1]), 0.01)};
    if (!profile.grid.columns || turn == 1) return;
    const lensprof_gain_grid other = rotated_grid(profile.grid, turn ? turn : kOtherWay);
    profile.grid = rotated_grid(profile.grid, turn ? turn : kOneWay);
    const uint32_t nodes = other.channels * other.rows * other.columns;
    for (uint32_t n = 0; n < nodes; n++)
        profile.grid.attenuation[n] = 0.5f * (profile.grid.attenuation[n] + other.attenuation[n]);
}

void turn_profile_to_sensor(uint16_t turn, lensprof_profile &profile) {
    turn_profile(inverse_orientation(turn), profile);
}

}  // namespace lensprof
