#include "falloff/map_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/gain_grid.h"
#include "core/profile.h"
#include "falloff/failure.hpp"
#include "falloff/levenberg_marquardt.hpp"
#include "falloff/power_fit.hpp"
#include "falloff/refit.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMaxSamples = 128;     // of a map, a side: more tell a polynomial nothing
constexpr double kGridFrom = 0.002;       // relative error of a radial falloff that a grid is for
constexpr uint32_t kGridNodes = 24;       // along the longer side
constexpr double kMoreNodesFrom = 0.005;  // relative error of such a grid that one with more nodes is for
constexpr double kUnknownShare = 0.02;    // of a map, from which it is taken as that of a part of the frame
constexpr size_t kFewValues = 4;          // of a map, a node
constexpr int kRefinements = 20;          // of such a grid: the error of a table of 16 x 12 falls from 3.5 to 0.3 %
constexpr double kFarthestCenter = 0.5;   // half diagonals; beyond it is not the centre of a falloff

[[noreturn]] void fail(const char *text) { throw FalloffFailure{LENSPROF_ERROR_VIGNETTING, text}; }

// A value of a map.
struct Sample {
    double x, y, value;
};

// The values of a channel over its largest, at most kMaxSamples a side: the known ones, and where nothing is known
// those of the nearest known ones.
struct Channel {
    double largest;
    std::vector<Sample> samples, beyond;
};

// The known value nearest to each value of a channel, in steps along rows and columns.
std::vector<double> extended(const FalloffMap &map, const double *values, double lowest) {
    const size_t size = size_t(map.columns) * map.rows;
    std::vector<double> nearest(size, 0.0);
    std::vector<size_t> queue;
    queue.reserve(size);
    for (size_t i = 0; i < size; i++)
        if (values[i] >= lowest) nearest[i] = values[i], queue.push_back(i);
    for (size_t next = 0; next < queue.size(); next++) {
        const size_t i = queue[next], column = i % map.columns;
        const auto take = [&](bool exists, size_t neighbour) {
            if (exists && nearest[neighbour] == 0.0) nearest[neighbour] = nearest[i], queue.push_back(neighbour);
        };
        take(column > 0, i - 1), take(column + 1 < map.columns, i + 1);
        take(i >= map.columns, i - map.columns), take(i + map.columns < size, i + map.columns);
    }
    return nearest;
}

Channel channel_of(const FalloffMap &map, uint32_t index) {
    const size_t size = size_t(map.columns) * map.rows;
    const double *values = map.attenuation.data() + size * index;
    Channel channel{*std::max_element(values, values + size), {}, {}};
    if (!(channel.largest > 0.0)) fail("the map has no value above 0; correct it");
    const std::vector<double> nearest = extended(map, values, kLowestFalloff * channel.largest);
    const uint32_t across = std::min(map.columns, kMaxSamples), down = std::min(map.rows, kMaxSamples);
    for (uint32_t b = 0; b < down; b++)
        for (uint32_t a = 0; a < across; a++) {
            const uint32_t i = static_cast<uint32_t>((2 * uint64_t(a) + 1) * map.columns / (2 * across));
            const uint32_t j = static_cast<uint32_t>((2 * uint64_t(b) + 1) * map.rows / (2 * down));
            const size_t at = size_t(j) * map.columns + i;
            const bool is_known = values[at] >= kLowestFalloff * channel.largest;
            (is_known ? channel.samples : channel.beyond)
                .push_back({map.x0 + i * map.dx, map.y0 + j * map.dy, nearest[at] / channel.largest});
        }
    if (channel.samples.size() < 8) fail("too few values of the map are above 0; give one that covers the frame");
    return channel;
}

// Minimises the sum of squares of the relative error over the known values plus `weight_beyond` times that over the
// others, which keeps M possible there.
//
// Unknowns: scale c0 and c1..c3 = c0 k of every channel, so that with a fixed centre all is linear; then the centre.
class MapFit {
public:
    MapFit(const FalloffMap &map, const std::vector<Channel> &channels, double weight_beyond)
        : map_(map), channels_(channels), weight_beyond_(weight_beyond) {
        terms_ = Eigen::VectorXd::Zero(4 * map.channels + 2);
    }

    void run() {
        solve_linear();
        constexpr DescentLimits kLimits{50, 1e-3, 1e9, 1e-12};
        const auto cost_after = [&](const Eigen::VectorXd &change) {
            const Eigen::VectorXd next = terms_ + change;
            const bool inside = std::hypot(next[center()], next[center() + 1]) <= kFarthestCenter;
            return inside ? cost_of(next) : INFINITY;
        };
        levenberg_marquardt(
            kLimits, [&] { return model(); }, cost_after, [&](const Eigen::VectorXd &change) { terms_ += change; });
    }

    std::array<double, 3> k(uint32_t channel) const {
        const Eigen::Index first = 4 * channel;
        return {terms_[first + 1] / terms_[first], terms_[first + 2] / terms_[first],
                terms_[first + 3] / terms_[first]};
    }
    uint32_t channels() const { return map_.channels; }
    const Channel &channel(uint32_t index) const { return channels_[index]; }
    // What M = 1 is, of the channel's largest value.
    double unit_value(uint32_t channel) const { return terms_[4 * channel]; }
    double center_of(int axis) const { return terms_[center() + axis]; }

private:
    Eigen::Index center() const { return terms_.size() - 2; }

    lensprof_vignetting shape(const Eigen::VectorXd &terms, uint32_t c) const {
        return {{terms[4 * c + 1], terms[4 * c + 2], terms[4 * c + 3]}, {terms[center()], terms[center() + 1]}};
    }

    // M to scale, less 1, over the sample; and its derivatives.
    double residual(const Eigen::VectorXd &terms, uint32_t c, const Sample &s, Eigen::VectorXd *slope) const {
        const lensprof_vignetting v = shape(terms, c);
        double gradient[2], by_r2;
        const double r2 = lensprof_vignetting_r2(&v, map_.width, map_.height, s.x, s.y, gradient);
        const double m = lensprof_vignetting_eval(&v, r2, &by_r2) - 1.0 + terms[4 * c];
        if (slope) {
            slope->setZero(terms.size());
            double power = 1.0 / s.value;
            for (int n = 0; n < 4; n++, power *= r2) (*slope)[4 * c + n] = power;
            for (int axis = 0; axis < 2; axis++) (*slope)[center() + axis] = by_r2 * gradient[axis] / s.value;
        }
        return m / s.value - 1.0;
    }

    // With the centre held where it is.
    void solve_linear() {
        constexpr int kPowers[4] = {0, 1, 2, 3};
        for (uint32_t c = 0; c < map_.channels; c++) {
            const lensprof_vignetting v = shape(terms_, c);
            const std::vector<Sample> &samples = channels_[c].samples, &beyond = channels_[c].beyond;
            const size_t known = samples.size(), count = known + (weight_beyond_ > 0.0 ? beyond.size() : 0);
            terms_.segment(4 * c, 4) = fit_powers(kPowers, 4, static_cast<int>(count), 1, [&](int index) {
                const size_t i = static_cast<size_t>(index);
                const Sample &s = i < known ? samples[i] : beyond[i - known];
                const double r2 = lensprof_vignetting_r2(&v, map_.width, map_.height, s.x, s.y, nullptr);
                return PowerSample{r2, s.value, (i < known ? 1.0 : weight_beyond_) / (s.value * s.value)};
            });
        }
    }

    // Calls use(channel, sample, weight) for every sample that has a weight.
    template <class Use>
    void visit(Use use) const {
        for (uint32_t c = 0; c < map_.channels; c++) {
            for (const Sample &s : channels_[c].samples) use(c, s, 1.0);
            for (const Sample &s : channels_[c].beyond)
                if (weight_beyond_ > 0.0) use(c, s, weight_beyond_);
        }
    }

    double cost_of(const Eigen::VectorXd &terms) const {
        double cost = 0.0;
        visit([&](uint32_t c, const Sample &s, double weight) {
            cost += weight * std::pow(residual(terms, c, s, nullptr), 2);
        });
        return cost;
    }

    QuadraticModel model() const {
        const Eigen::Index n = terms_.size();
        QuadraticModel model{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
        Eigen::VectorXd slope;
        visit([&](uint32_t c, const Sample &s, double weight) {
            const double left = residual(terms_, c, s, &slope);
            model.objective += weight * left * left;
            model.gradient -= weight * left * slope;
            model.hessian.selfadjointView<Eigen::Lower>().rankUpdate(slope, weight);
        });
        model.hessian = Eigen::MatrixXd(model.hessian.selfadjointView<Eigen::Lower>());
        return model;
    }

    const FalloffMap &map_;
    const std::vector<Channel> &channels_;
    double weight_beyond_;
    Eigen::VectorXd terms_;
};

// The values whose places lie within [from, to], at least the nearest one.
struct Range {
    uint32_t low, high;
};
Range values_within(double from, double to, double first, double step, uint32_t count) {
    double low = std::ceil((from - first) / step - 1e-9), high = std::floor((to - first) / step + 1e-9);
    if (low > high) low = high = std::round(((from + to) / 2.0 - first) / step);
    const double last = count - 1.0;
    return {static_cast<uint32_t>(std::clamp(low, 0.0, last)), static_cast<uint32_t>(std::clamp(high, 0.0, last))};
}

// The value of a channel that means 1, and the value below which it is unknown.
struct Scale {
    double unit_value, lowest;
};

// What the falloff leaves at a node: the plane through the values within half a node's spacing, which is not drawn
// aside at the frame's edge as a mean would be; their mean where they are too few, 1 where nothing is known.
double left_at(const FalloffMap &map, const lensprof_vignetting &falloff, uint32_t channel, const Scale &scale,
               double x, double y, double step_x, double step_y) {
    const Range across = values_within(x - step_x / 2.0, x + step_x / 2.0, map.x0, map.dx, map.columns),
                down = values_within(y - step_y / 2.0, y + step_y / 2.0, map.y0, map.dy, map.rows);
    const double *values = map.attenuation.data() + size_t(map.columns) * map.rows * channel;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (uint32_t j = down.low; j <= down.high; j++)
        for (uint32_t i = across.low; i <= across.high; i++) {
            const double value = values[size_t(j) * map.columns + i];
            const double px = map.x0 + i * map.dx, py = map.y0 + j * map.dy;
            if (value < scale.lowest) continue;
            const double r2 = lensprof_vignetting_r2(&falloff, map.width, map.height, px, py, nullptr);
            const Eigen::Vector3d basis(1.0, (px - x) / step_x, (py - y) / step_y);
            normal += basis * basis.transpose();
            right += basis * (value / scale.unit_value / lensprof_vignetting_eval(&falloff, r2, nullptr));
        }
    const double count = normal(0, 0);
    if (count == 0.0) return 1.0;
    const double spread = std::min(normal(1, 1), normal(2, 2));
    const bool plane = count >= 6.0 && spread > 0.01 * count;
    normal.diagonal().array() += 1e-6 * count;
    const double left = plane ? normal.ldlt().solve(right)[0] : right[0] / count;
    return std::clamp(left, kLowestFalloff, 1.0 / kLowestFalloff);
}

// A grid with so many nodes along the longer side. Where nothing is known, the falloff stays that of the nearest known
// place, so that a correction does not amplify what is there.
void set_grid(const FalloffMap &map, const MapFit &fit, uint32_t most_nodes, lensprof_profile &profile) {
    lensprof_gain_grid &grid = profile.grid;
    const uint32_t longer = std::max(map.width, map.height);
    const auto nodes = [&](uint32_t side, uint32_t values) {
        const uint32_t intervals = static_cast<uint32_t>(std::lround(double(most_nodes - 1) * side / longer)) + 1;
        return std::clamp<uint32_t>(std::min(intervals, values), 2, LENSPROF_GRID_SIDE);
    };
    grid.columns = nodes(map.width, map.columns), grid.rows = nodes(map.height, map.rows);
    grid.channels = map.channels;
    const double step_x = (map.width - 1.0) / (grid.columns - 1), step_y = (map.height - 1.0) / (grid.rows - 1);
    float *node = grid.attenuation;
    for (uint32_t c = 0; c < grid.channels; c++) {
        const double largest = fit.channel(c).largest;
        const Scale scale{fit.unit_value(c) * largest, kLowestFalloff * largest};
        FalloffMap whole = map;
        if (!fit.channel(c).beyond.empty()) {
            double *values = whole.attenuation.data() + size_t(map.columns) * map.rows * c;
            const std::vector<double> nearest = extended(map, values, scale.lowest);
            std::copy(nearest.begin(), nearest.end(), values);
        }
        for (uint32_t j = 0; j < grid.rows; j++)
            for (uint32_t i = 0; i < grid.columns; i++)
                *node++ = static_cast<float>(
                    left_at(whole, profile.vignetting[c], c, scale, i * step_x, j * step_y, step_x, step_y));
    }
}

// Draws the nodes to the values: each by the mean, over the values that it is interpolated for and weighted as they
// are, of what they are over the model.
void refine_grid(const FalloffMap &map, const MapFit &fit, lensprof_profile &profile) {
    lensprof_gain_grid &grid = profile.grid;
    const size_t nodes = size_t(grid.columns) * grid.rows;
    for (uint32_t c = 0; c < map.channels; c++) {
        for (int round = 0; round < kRefinements; round++) {
            std::vector<double> sum(nodes), weight(nodes);
            for (const Sample &s : fit.channel(c).samples) {
                const double model =
                    fit.unit_value(c) * lp_profile_continued_falloff(&profile, c, map.width, map.height, s.x, s.y);
                const lp_grid_cell x = lp_grid_cell_at(s.x, map.width, grid.columns),
                                   y = lp_grid_cell_at(s.y, map.height, grid.rows);
                for (uint32_t k = 0; k < 4; k++) {
                    const double share =
                        (k & 1 ? x.fraction : 1.0 - x.fraction) * (k & 2 ? y.fraction : 1.0 - y.fraction);
                    const size_t node = size_t(y.node + (k >> 1)) * grid.columns + x.node + (k & 1);
                    sum[node] += share * s.value / model, weight[node] += share;
                }
            }
            for (size_t i = 0; i < nodes; i++) {
                float &node = grid.attenuation[c * nodes + i];
                if (weight[i] > 0.0)
                    node =
                        static_cast<float>(std::clamp(node * sum[i] / weight[i], kLowestFalloff, 1.0 / kLowestFalloff));
            }
        }
    }
}

// Largest |model / attenuation - 1| over what is known.
double worst_error(const FalloffMap &map, const MapFit &fit, const lensprof_profile &profile) {
    double worst = 0.0;
    for (uint32_t c = 0; c < map.channels; c++) {
        for (const Sample &s : fit.channel(c).samples) {
            const double model =
                fit.unit_value(c) * lp_profile_continued_falloff(&profile, c, map.width, map.height, s.x, s.y);
            worst = std::max(worst, std::fabs(model / s.value - 1.0));
        }
    }
    return worst;
}

// Sets the grid that leaves least: of planes alone or refined, and with more nodes if few leave much. Refined are the
// nodes of tables with few values, and those across the edge of what is known. Returns the largest relative error.
double set_best_grid(const FalloffMap &map, const MapFit &fit, lensprof_profile &profile) {
    double least = INFINITY;
    lensprof_gain_grid best = profile.grid;
    const auto keep = [&] {
        const double worst = worst_error(map, fit, profile);
        if (worst < least) least = worst, best = profile.grid;
    };
    for (const uint32_t nodes : {kGridNodes, static_cast<uint32_t>(LENSPROF_GRID_SIDE)}) {
        set_grid(map, fit, nodes, profile);
        const size_t count = size_t(profile.grid.columns) * profile.grid.rows;
        const bool is_refined = size_t(map.columns) * map.rows < kFewValues * count || !fit.channel(0).beyond.empty();
        if (!is_refined) keep();
        if (is_refined || least > kMoreNodesFrom) refine_grid(map, fit, profile), keep();
        if (!(least > kMoreNodesFrom)) break;
    }
    profile.grid = best;
    return least;
}

// Whether so many values are unknown that the map is that of a part of the frame, such as the circle of a fisheye.
bool is_of_part(const std::vector<Channel> &channels) {
    size_t known = 0, beyond = 0;
    for (const Channel &channel : channels) known += channel.samples.size(), beyond += channel.beyond.size();
    return static_cast<double>(beyond) > kUnknownShare * static_cast<double>(known + beyond);
}

// Sets the radial falloffs; false if one of them is not possible.
bool set_radial(const MapFit &fit, lensprof_profile &profile) {
    profile.vignettings = fit.channels();
    for (uint32_t c = 0; c < profile.vignettings; c++) {
        lensprof_vignetting &v = profile.vignetting[c];
        const std::array<double, 3> k = fit.k(c);
        v = {{k[0], k[1], k[2]}, {fit.center_of(0), fit.center_of(1)}};
        if (!(fit.unit_value(c) > 0.0) || lensprof_vignetting_validate(&v) != LENSPROF_OK) return false;
    }
    return true;
}

}  // namespace

void place_as_cells(FalloffMap &map) {
    map.dx = double(map.width) / map.columns, map.dy = double(map.height) / map.rows;
    map.x0 = map.dx / 2.0 - 0.5, map.y0 = map.dy / 2.0 - 0.5;
}

FalloffMap sampled_map(uint32_t width, uint32_t height, uint32_t channels, const Attenuation &attenuation) {
    const double longer = std::max(width, height);
    const auto cells = [&](uint32_t side) {
        return std::min(side, static_cast<uint32_t>(std::ceil(kMaxSamples * (side / longer))));
    };
    FalloffMap map{width, height, cells(width), cells(height), channels, 0, 0, 0, 0, {}};
    const auto step = [](uint32_t side, uint32_t count) { return count > 1 ? (side - 1.0) / (count - 1) : 1.0; };
    map.dx = step(width, map.columns), map.dy = step(height, map.rows);  // with the corners, where errors are largest
    map.attenuation.reserve(size_t(map.columns) * map.rows * channels);
    for (uint32_t c = 0; c < channels; c++)
        for (uint32_t j = 0; j < map.rows; j++)
            for (uint32_t i = 0; i < map.columns; i++)
                map.attenuation.push_back(attenuation(map.x0 + i * map.dx, map.y0 + j * map.dy, c));
    return map;
}

double fit_map(const FalloffMap &map, lensprof_profile &profile) {
    for (double value : map.attenuation)
        if (!std::isfinite(value))
            throw FalloffFailure{LENSPROF_ERROR_NOT_FINITE, "the map has a value that is not finite; correct it"};
    std::vector<Channel> channels;
    for (uint32_t c = 0; c < map.channels; c++) channels.push_back(channel_of(map, c));
    const bool is_part = is_of_part(channels);
    for (const double weight : {0.0, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0}) {
        if (is_part == (weight == 0.0)) continue;
        MapFit fit(map, channels, weight);
        fit.run();
        if (!set_radial(fit, profile)) continue;
        lensprof_gain_grid_init(&profile.grid);
        const double radial = worst_error(map, fit, profile);
        return radial > kGridFrom || is_part ? set_best_grid(map, fit, profile) : radial;
    }
    fail("no radial falloff approximates the map; check that it shows one frame, and its sense");
}

}  // namespace lensprof
