#include "falloff/known_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "falloff/refit.hpp"

namespace lensprof {
namespace {

constexpr double kDark = 0.05;       // of the largest value: the noise of a coded picture reaches .02
constexpr double kBright = 2.5;      // times that, on the other side of an edge; a falloff rises less within kEdge
constexpr uint32_t kEdge = 3;        // least number of values that are means of both sides
constexpr double kDarkShare = 0.01;  // of a map, below which dark values are specks
constexpr uint32_t kLeastSide = 48;  // of a map that shows an edge
constexpr double kOffCircle = 1.5;   // values between an outline and its circle
constexpr double kMiddle = 0.05;     // how far from the middle that of a rectangle may be, half diagonals

using Mask = std::vector<uint8_t>;

// Whether so many channels, relative to their largest values, are below `limit`.
Mask below(const FalloffMap &map, double limit, uint32_t channels) {
    const size_t size = size_t(map.columns) * map.rows;
    Mask dark(size, 0);
    for (uint32_t c = 0; c < map.channels; c++) {
        const double *values = map.attenuation.data() + size * c;
        const double least = limit * *std::max_element(values, values + size);
        for (size_t i = 0; i < size; i++) dark[i] += !(values[i] >= least);
    }
    for (uint8_t &count : dark) count = count >= channels;
    return dark;
}

// The mask and its eight neighbours.
Mask grown(const FalloffMap &map, const Mask &mask) {
    Mask result = mask;
    for (uint32_t j = 0; j < map.rows; j++)
        for (uint32_t i = 0; i < map.columns; i++) {
            if (!mask[size_t(j) * map.columns + i]) continue;
            for (uint32_t y = j - (j > 0); y <= std::min(j + 1, map.rows - 1); y++)
                for (uint32_t x = i - (i > 0); x <= std::min(i + 1, map.columns - 1); x++)
                    result[size_t(y) * map.columns + x] = 1;
        }
    return result;
}

Mask grown(const FalloffMap &map, Mask mask, uint32_t steps) {
    for (uint32_t i = 0; i < steps; i++) mask = grown(map, mask);
    return mask;
}

bool is_noisy(const FalloffMap &map, const Mask &dark) {
    for (size_t i = 0; i < map.attenuation.size(); i++)
        if (dark[i % dark.size()] && map.attenuation[i] > 0.0) return true;
    return false;
}

// Of what is not blurred, the part that hangs together and has most values: others are noise in the dark.
Mask largest_part(const FalloffMap &map, const Mask &blurred) {
    Mask seen = blurred, largest(blurred.size(), 0);
    size_t most = 0;
    for (size_t start = 0; start < seen.size(); start++) {
        if (seen[start]) continue;
        std::vector<size_t> part{start};
        seen[start] = 1;
        for (size_t next = 0; next < part.size(); next++) {
            const size_t i = part[next], column = i % map.columns;
            const auto take = [&](bool exists, size_t neighbour) {
                if (exists && !seen[neighbour]) seen[neighbour] = 1, part.push_back(neighbour);
            };
            take(column > 0, i - 1), take(column + 1 < map.columns, i + 1);
            take(i >= map.columns, i - map.columns), take(i + map.columns < seen.size(), i + map.columns);
        }
        if (part.size() <= most) continue;
        most = part.size();
        largest.assign(seen.size(), 0);
        for (const size_t i : part) largest[i] = 1;
    }
    return largest;
}

using Points = std::vector<std::array<double, 2>>;

// The ends of the known values along a line, if they are not at the edge of the map, in values.
template <class IsDark>
std::vector<double> ends_of(uint32_t length, IsDark is_dark) {
    uint32_t first = 0, last = length;
    while (first < length && is_dark(first)) first++;
    while (last > first && is_dark(last - 1)) last--;
    std::vector<double> ends;
    if (first == last) return ends;
    if (first > 0) ends.push_back(first - 0.5);
    if (last < length) ends.push_back(last - 0.5);
    return ends;
}

// Places of the outline in the frame, half diagonals from its middle, found along rows and columns.
Points outline(const FalloffMap &map, const Mask &dark) {
    Points points;
    const double half = lensprof_half_diagonal(map.width, map.height);
    const auto x_at = [&](double i) { return (map.x0 + i * map.dx - (map.width - 1.0) / 2.0) / half; };
    const auto y_at = [&](double j) { return (map.y0 + j * map.dy - (map.height - 1.0) / 2.0) / half; };
    for (uint32_t j = 0; j < map.rows; j++)
        for (const double end : ends_of(map.columns, [&](uint32_t i) { return dark[size_t(j) * map.columns + i]; }))
            points.push_back({x_at(end), y_at(j)});
    for (uint32_t i = 0; i < map.columns; i++)
        for (const double end : ends_of(map.rows, [&](uint32_t j) { return dark[size_t(j) * map.columns + i]; }))
            points.push_back({x_at(i), y_at(end)});
    return points;
}

// The median of the values next to the dark ones, of the largest of their channel.
double median_across(const FalloffMap &map, const Mask &blurred) {
    const Mask across = grown(map, blurred);
    const size_t size = blurred.size();
    std::vector<double> values;
    for (uint32_t c = 0; c < map.channels; c++) {
        const double *channel = map.attenuation.data() + size * c;
        const double largest = *std::max_element(channel, channel + size);
        for (size_t i = 0; i < size; i++)
            if (across[i] && !blurred[i]) values.push_back(channel[i] / largest);
    }
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Whether the dark is a part of the frame with an edge, not corners or specks.
bool shows_edge(const FalloffMap &map, const Mask &dark, uint32_t edge) {
    if (std::min(map.columns, map.rows) < kLeastSide) return false;
    const auto count = static_cast<double>(std::count(dark.begin(), dark.end(), 1));
    return count >= kDarkShare * static_cast<double>(dark.size())
           && median_across(map, grown(map, dark, edge)) >= kBright * kDark;
}

Mask inside_circle(const FalloffMap &map, const lensprof_image_circle &circle, uint32_t edge) {
    const double half = lensprof_half_diagonal(map.width, map.height);
    const double radius = circle.radius * half - edge * std::max(map.dx, map.dy);
    Mask inside;
    for (uint32_t j = 0; j < map.rows; j++)
        for (uint32_t i = 0; i < map.columns; i++) {
            const double x = map.x0 + i * map.dx - (map.width - 1.0) / 2.0 - circle.center[0] * half;
            const double y = map.y0 + j * map.dy - (map.height - 1.0) / 2.0 - circle.center[1] * half;
            inside.push_back(std::hypot(x, y) <= radius);
        }
    return inside;
}

// The rectangle around the known values if it is in the middle of the frame, as a mask leaves it; else the frame.
Mask inside_box(const FalloffMap &map, const Mask &unknown) {
    uint32_t left = map.columns, right = 0, top = map.rows, bottom = 0;
    for (uint32_t j = 0; j < map.rows; j++)
        for (uint32_t i = 0; i < map.columns; i++) {
            if (unknown[size_t(j) * map.columns + i]) continue;
            left = std::min(left, i), right = std::max(right, i);
            top = std::min(top, j), bottom = std::max(bottom, j);
        }
    const double x = (left + right + 1.0 - map.columns) / 2.0 * map.dx;
    const double y = (top + bottom + 1.0 - map.rows) / 2.0 * map.dy;
    if (std::hypot(x, y) > kMiddle * lensprof_half_diagonal(map.width, map.height)) return Mask(unknown.size(), 1);
    Mask inside(unknown.size(), 0);
    for (uint32_t j = top; j <= bottom && j < map.rows; j++)
        for (uint32_t i = left; i <= right; i++) inside[size_t(j) * map.columns + i] = 1;
    return inside;
}

// Of the places of `area`, those that are unknown.
double share(const Mask &unknown, const Mask &area) {
    size_t all = 0, part = 0;
    for (size_t i = 0; i < area.size(); i++) all += area[i], part += area[i] & unknown[i];
    return all ? static_cast<double>(part) / static_cast<double>(all) : 1.0;
}

}  // namespace

KnownArea drop_surround(FalloffMap &map) {
    const Mask dark = below(map, kDark, map.channels);
    // Noise in the dark shows a coded picture, whose blocks have ringing at the edge.
    const uint32_t edge = is_noisy(map, dark) ? std::max(kEdge, std::max(map.columns, map.rows) / 100) : kEdge;
    Mask empty = below(map, kLowestFalloff, 1), unknown = below(map, kLowestFalloff, map.channels);
    if (shows_edge(map, dark, edge)) {
        const Mask known = largest_part(map, grown(map, dark, edge));
        for (size_t i = 0; i < map.attenuation.size(); i++)
            if (!known[i % known.size()]) map.attenuation[i] = 0.0;
        unknown = grown(map, known, edge);
        for (size_t i = 0; i < unknown.size(); i++) empty[i] |= dark[i], unknown[i] = dark[i] || !unknown[i];
    }
    const double slack = kOffCircle * std::max(map.dx, map.dy) / lensprof_half_diagonal(map.width, map.height);
    const std::optional<lensprof_image_circle> circle = circle_through(outline(map, unknown), slack);
    for (size_t i = 0; i < unknown.size(); i++) unknown[i] |= empty[i];
    const Mask inside = circle ? inside_circle(map, *circle, edge) : inside_box(map, unknown);
    return {circle, share(empty, Mask(empty.size(), 1)), share(unknown, inside)};
}

}  // namespace lensprof
