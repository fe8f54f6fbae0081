// The end of the image circle: a dark surround that the light falls to within a few cells, far faster than a falloff.
#include <algorithm>
#include <cmath>

#include "falloff/circle.hpp"
#include "fit/base/quantile.hpp"
#include "fit/flat/fit.hpp"

namespace lensprof {
namespace {

constexpr double kDark = 0.06;      // of the bright cells' light: stray light and noise stay below it
constexpr double kBright = 0.9;     // quantile of the light that counts as bright
constexpr double kWidth = 0.07;     // half diagonals, within which the light falls from inside to the dark,
constexpr double kSteepest = 19.0;  // by more than this, ln per half diagonal: six stops of r^2 to r^4 reach 17
constexpr double kMostSoft = 0.14;  // half diagonals: width of a soft edge
constexpr double kSoft = 7.0;       // ln per half diagonal inside of it: more than most falloffs have
constexpr size_t kFewest = 3;       // cells of a dark place,
constexpr int kDepth = 2;           // and as many from the frame's border: a narrower one is a border of the picture,
constexpr size_t kCorner = 12;      // unless it has so few that it is a corner
constexpr int kTip = 3;            // cells along a diagonal that a circle cuts off without such a dark place: they have
constexpr double kMissing = 0.25;  // less light, ln, than those before them continue to,
constexpr double kMissingInBlack = 1.0;  // by more if it is black,
constexpr int kBeforeTip = 8;            // of which these are taken
constexpr size_t kCornersOfCircle = 3;   // of the frame that a circle about the middle cuts off at least
constexpr double kOffCircle = 2.0;       // cells between a place of the outline and its circle

struct DarkMap {
    const CellGrid &grid;
    std::vector<double> light;     // ln, the mean of the channels; NaN without data
    std::vector<double> variance;  // of it, by the noise of the pixels
    std::vector<bool> is_black;    // the light is about 0, and its logarithm imprecise
    std::vector<float> low_share;  // of pixels far darker than the rest
    double side;                   // of a cell, half diagonals

    int cells(double width) const { return std::max(2, static_cast<int>(std::lround(width / side))); }

    double at(int column, int row) const { return light[static_cast<size_t>(row * grid.columns + column)]; }

    // The light so many cells from a cell towards the middle of the frame, but not beyond it.
    double inward(int cell, int steps) const {
        const int column = cell % grid.columns, row = cell / grid.columns;
        const double across = 0.5 * (grid.columns - 1) - column, down = 0.5 * (grid.rows - 1) - row;
        const double far = std::max(std::hypot(across, down), 1.0), part = std::min(steps / far, 1.0);
        return at(static_cast<int>(column + std::lround(part * across)),
                  static_cast<int>(row + std::lround(part * down)));
    }
};

DarkMap dark_map(const CellGrid &grid, int channels, const Shot &shot) {
    const double half = lensprof_half_diagonal(grid.width, grid.height);
    DarkMap map{grid,
                std::vector<double>(shot.light.size(), NAN),
                std::vector<double>(shot.light.size(), 0.0),
                std::vector<bool>(shot.light.size(), false),
                std::vector<float>(shot.light.size(), 0.0f),
                std::max(grid.cell_width(), grid.cell_height()) / half};
    for (size_t i = 0; i < map.light.size(); i++) {
        const CellLight &cell = shot.light[i];
        if (cell.state == CellState::masked || !shot.card[i]) continue;
        double sum = 0.0, variance = 0.0;
        for (size_t c = 0; c < static_cast<size_t>(channels); c++) {
            const double value = std::max(cell.value[c], 1e-9);
            sum += std::log(value), variance += cell.variance[c] / (value * value);
        }
        map.light[i] = sum / channels, map.variance[i] = variance / channels / channels;
        map.is_black[i] = cell.state == CellState::black;
        map.low_share[i] = cell.low_share;
    }
    return map;
}

int distance_to_border(const CellGrid &grid, int cell) {
    const int column = cell % grid.columns, row = cell / grid.columns;
    return std::min({column, row, grid.columns - 1 - column, grid.rows - 1 - row});
}

// Cells of a group that have a neighbour outside of it.
std::vector<int> rim_of(const CellGrid &grid, const std::vector<bool> &member) {
    std::vector<int> rim;
    for (int cell = 0; cell < grid.count(); cell++) {
        if (!member[static_cast<size_t>(cell)]) continue;
        const int column = cell % grid.columns, row = cell / grid.columns;
        const auto is_out = [&](bool exists, int other) { return exists && !member[static_cast<size_t>(other)]; };
        if (is_out(column > 0, cell - 1) || is_out(column + 1 < grid.columns, cell + 1)
            || is_out(row > 0, cell - grid.columns) || is_out(row + 1 < grid.rows, cell + grid.columns))
            rim.push_back(cell);
    }
    return rim;
}

// Median of the rise of the light between two distances from the rim, cells: ln per half diagonal.
double rise(const DarkMap &map, const std::vector<int> &rim, int from, int to) {
    std::vector<double> rises;
    for (int cell : rim) {
        const double step = map.inward(cell, to) - map.inward(cell, from);
        if (!std::isnan(step)) rises.push_back(step);
    }
    return rises.empty() ? 0.0 : median(rises) / ((to - from) * map.side);
}

// Dark places at the border of the frame, which end steeply.
std::vector<bool> surround(const DarkMap &map, std::vector<int> &rim) {
    const CellGrid &grid = map.grid;
    std::vector<double> seen;
    for (double light : map.light)
        if (!std::isnan(light)) seen.push_back(light);
    std::vector<bool> dark(map.light.size()), found(map.light.size());
    if (seen.empty()) return found;
    const double limit = quantile(seen, kBright) + std::log(kDark);
    for (size_t i = 0; i < dark.size(); i++) dark[i] = map.light[i] < limit;
    for (const auto &group : connected_cells(grid, dark, [](int, int) { return true; })) {
        int nearest = grid.columns, deepest = 0;
        std::vector<bool> member(dark.size());
        for (int cell : group) {
            nearest = std::min(nearest, distance_to_border(grid, cell));
            deepest = std::max(deepest, distance_to_border(grid, cell));
            member[static_cast<size_t>(cell)] = true;
        }
        const bool is_line = deepest + 1 < kDepth && group.size() > kCorner;
        if (nearest > 0 || is_line || group.size() < kFewest) continue;
        const std::vector<int> around = rim_of(grid, member);
        if (rise(map, around, 0, map.cells(kWidth)) < kSteepest) continue;
        rim.insert(rim.end(), around.begin(), around.end());
        for (int cell : group) found[static_cast<size_t>(cell)] = true;
    }
    return found;
}

// How many of the first of some cells, up to kTip, end in one with less light than a cubic through the four cells that
// follow continues to: by a fourth difference beyond five standard deviations, by noise and of those that follow.
int depth_of_tip(const DarkMap &map, const std::array<int, kTip + kBeforeTip> &cells) {
    constexpr std::array<double, 5> binomial = {1.0, -4.0, 6.0, -4.0, 1.0};
    const auto sum = [&](int k, const auto &of_cell) {
        double total = 0.0;
        for (size_t n = 0; n < binomial.size(); n++)
            total += of_cell(static_cast<size_t>(cells[static_cast<size_t>(k) + n]), binomial[n]);
        return total;
    };
    const auto difference = [&](int k) { return sum(k, [&](size_t i, double b) { return b * map.light[i]; }); };
    double squares = 0.0;
    for (int k = kTip; k < kTip + kBeforeTip - 4; k++) squares += difference(k) * difference(k);
    for (int depth = kTip; depth > 0; depth--) {
        const double noise = sum(depth - 1, [&](size_t i, double b) { return b * b * map.variance[i]; });
        const double sigma = std::sqrt(std::max(noise, squares / (kBeforeTip - 4)));
        const auto end = static_cast<size_t>(cells[static_cast<size_t>(depth) - 1]),
                   next = static_cast<size_t>(cells[static_cast<size_t>(depth)]);
        const double missing = map.is_black[end] ? kMissingInBlack : kMissing;
        const bool is_darker = map.light[end] < map.light[next] - 0.5 * missing;  // not a bright corner
        if (is_darker && -difference(depth - 1) > std::max(missing, 5.0 * sigma)) return depth;
    }
    return 0;
}

// A corner of the frame, with the cells along its diagonal.
struct Corner {
    std::array<int, kTip + kBeforeTip> diagonal;
    int right, down;  // steps into the frame, cells
};

std::array<Corner, 4> corners_of(const CellGrid &grid) {
    std::array<Corner, 4> corners;
    for (int n = 0; n < 4; n++) {
        Corner &corner = corners[static_cast<size_t>(n)];
        corner.right = n & 1 ? -1 : 1, corner.down = (n & 2 ? -1 : 1) * grid.columns;
        const int first = (n & 1 ? grid.columns - 1 : 0) + (n & 2 ? grid.rows - 1 : 0) * grid.columns;
        for (int k = 0; k < kTip + kBeforeTip; k++)
            corner.diagonal[static_cast<size_t>(k)] = first + k * (corner.right + corner.down);
    }
    return corners;
}

// Whether the frame's border is dark far from its corner as well, along one of its sides: no circle has a straight
// edge. The mean of a cell may show nothing of it, but a cell where it is half of a corner's has this share.
bool is_at_border(const DarkMap &map, const Corner &corner) {
    constexpr double lit = 0.5;    // ln, of the cells next to it
    constexpr float share = 0.2f;  // of pixels far darker than the rest
    const auto is_dark = [&](int along, int inward) {
        const auto far = static_cast<size_t>(corner.diagonal[0] + (kTip + kBeforeTip) * along);
        const double next = map.light[far + static_cast<size_t>(kTip * inward)];
        return map.is_black[far] || map.low_share[far] > share || !(map.light[far] > next - lit);  // also if left out
    };
    return is_dark(corner.right, corner.down) || is_dark(corner.down, corner.right);
}

// Corners of the frame that an image circle cuts off within a few cells, too small for a dark place, are outside.
// Returns a cell at the rim of every corner that is cut off, if they are three; fewer may be dust.
std::vector<int> add_tips(const DarkMap &map, std::vector<bool> &outside, std::vector<int> &rim) {
    constexpr int last = kTip + kBeforeTip - 1;
    if (std::min(map.grid.columns, map.grid.rows) < 2 * (kTip + kBeforeTip)) return {};
    struct Tip {
        const Corner corner;
        int depth;
    };
    std::vector<Tip> tips;
    std::vector<int> cut;
    for (const Corner &corner : corners_of(map.grid)) {
        if (is_at_border(map, corner)) continue;
        int dark = 0;
        while (dark < last && outside[static_cast<size_t>(corner.diagonal[static_cast<size_t>(dark)])]) dark++;
        if (dark == 0) tips.push_back({corner, depth_of_tip(map, corner.diagonal)});
        const int depth = dark > 0 ? dark : tips.back().depth;
        if (depth > 0) cut.push_back(corner.diagonal[static_cast<size_t>(depth - 1)]);
    }
    if (cut.size() < kCornersOfCircle) return {};
    for (const auto &[corner, depth] : tips) {
        for (int i = 0; i < 2 * depth; i++)
            for (int j = 0; i + j < 2 * depth; j++)
                outside[static_cast<size_t>(corner.diagonal[0] + i * corner.right + j * corner.down)] = true;
        if (depth > 0) rim.push_back(corner.diagonal[static_cast<size_t>(depth - 1)]);
    }
    return cut;
}

void grow(const CellGrid &grid, std::vector<bool> &cells) {
    const std::vector<bool> before = cells;
    for (int cell = 0; cell < grid.count(); cell++) {
        if (!before[static_cast<size_t>(cell)]) continue;
        const int column = cell % grid.columns, row = cell / grid.columns;
        for (int y = std::max(0, row - 1); y <= std::min(grid.rows - 1, row + 1); y++)
            for (int x = std::max(0, column - 1); x <= std::min(grid.columns - 1, column + 1); x++)
                cells[static_cast<size_t>(y * grid.columns + x)] = true;
    }
}

// Adds the groups of candidates that have a cell outside.
void join(const CellGrid &grid, std::vector<bool> candidates, std::vector<bool> &outside) {
    for (size_t i = 0; i < candidates.size(); i++) candidates[i] = candidates[i] || outside[i];
    for (const auto &group : connected_cells(grid, candidates, [](int, int) { return true; })) {
        const auto is_outside = [&](int cell) { return static_cast<bool>(outside[static_cast<size_t>(cell)]); };
        if (std::none_of(group.begin(), group.end(), is_outside)) continue;
        for (int cell : group) outside[static_cast<size_t>(cell)] = true;
    }
}

// Cells with a part in the dark, where it is narrower than a cell.
void add_black(const CellGrid &grid, const Shot &shot, std::vector<bool> &outside) {
    std::vector<bool> black(outside.size());
    for (size_t i = 0; i < black.size(); i++) black[i] = shot.light[i].state == CellState::black;
    join(grid, black, outside);
}

// A cell's middle, half diagonals from that of the frame.
std::array<double, 2> place_of(const CellGrid &grid, int cell) {
    const double half = lensprof_half_diagonal(grid.width, grid.height);
    const auto [x, y] = grid.middle(cell);
    return {(x - 0.5 * grid.width) / half, (y - 0.5 * grid.height) / half};
}

// Where the light has fallen to a half, cells inwards from the middle of a dark one: the sum of what is missing.
double inward_of(const DarkMap &map, int cell) {
    const int depth = map.cells(kWidth);
    double missing = -0.5;
    for (int step = 0; step < depth; step++)
        missing += 1.0 - std::exp(std::min(map.inward(cell, step) - map.inward(cell, depth), 0.0));
    return std::isnan(missing) ? 0.5 : missing;
}

// Where what is lit ends, half diagonals from the middle of the frame: at cells of a rim, the nearest, and those at the
// frame's border, of which only a part may be in the frame, or without them.
struct Outline {
    std::vector<std::array<double, 2>> places, at_border;
    double nearest = INFINITY;
};

Outline outline_of(const DarkMap &map, const std::vector<int> &rim) {
    Outline outline;
    for (int cell : rim) {
        const auto [x, y] = place_of(map.grid, cell);
        const double far = std::hypot(x, y), part = 1.0 - inward_of(map, cell) * map.side / std::max(far, map.side);
        (distance_to_border(map.grid, cell) > 0 ? outline.places : outline.at_border).push_back({part * x, part * y});
        outline.nearest = std::min(outline.nearest, part * far);
    }
    return outline;
}

// Through the corners that it cuts off; about the middle of the frame if their places are too imprecise for a centre.
lensprof_image_circle circle_of_corners(const DarkMap &map, const std::vector<int> &corners) {
    constexpr double farthest = 0.1;  // half diagonals
    const Outline outline = outline_of(map, corners);
    std::vector<std::array<double, 2>> places = outline.places;
    places.insert(places.end(), outline.at_border.begin(), outline.at_border.end());
    const auto circle = circle_through(places, kOffCircle * map.side, places.size());
    if (circle && std::hypot(circle->center[0], circle->center[1]) <= farthest) return *circle;
    return {{0.0, 0.0}, outline.nearest};
}

// Cells beyond a radius of the circle that join what is outside, such as a line of cells along the frame's border that
// the dark covers in part. An arc shows little of the other side of the frame, which does not join it.
void leave_out_beyond(const CellGrid &grid, const lensprof_image_circle &circle, double radius,
                      std::vector<bool> &outside) {
    std::vector<bool> beyond(outside.size());
    for (int cell = 0; cell < grid.count(); cell++) {
        const auto [x, y] = place_of(grid, cell);
        beyond[static_cast<size_t>(cell)] = std::hypot(x - circle.center[0], y - circle.center[1]) > radius;
    }
    join(grid, beyond, outside);
}

}  // namespace

FlatEdge find_edge(const CellGrid &grid, int channels, const Shot &shot) {
    const DarkMap map = dark_map(grid, channels, shot);
    FlatEdge edge;
    std::vector<int> rim;
    edge.outside = surround(map, rim);
    const std::vector<int> corners = add_tips(map, edge.outside, rim);
    if (rim.empty()) return edge;
    const Outline outline = outline_of(map, rim);
    edge.radius = outline.nearest;
    edge.circle = circle_through(outline.places, kOffCircle * map.side);
    if (!edge.circle && !corners.empty()) edge.circle = circle_of_corners(map, corners);
    if (edge.circle) edge.radius = edge.circle->radius;
    int soft = 1;
    while (soft < map.cells(kMostSoft) && rise(map, rim, soft, soft + 1) > kSoft) soft++;
    for (int step = 0; step <= soft; step++) grow(grid, edge.outside);
    edge.inner = edge.radius - (soft + 1) * map.side;
    edge.soft = (soft - 1) * map.side;
    if (edge.circle) leave_out_beyond(grid, *edge.circle, edge.inner, edge.outside);
    add_black(grid, shot, edge.outside);
    edge.share = static_cast<double>(std::count(edge.outside.begin(), edge.outside.end(), true)) / grid.count();
    return edge;
}

}  // namespace lensprof
