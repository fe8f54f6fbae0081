// The offset that the stated black level leaves, from pictures of one pattern of light at different levels:
//     B_n(x) = b + a_n F(x),        b = 0 +- black_sigma before.
// If every shot has its own light, ln a_n is a plane over the frame. F(x) of a cell is linear in its pictures and is
// eliminated; b and the levels a_n relative to the first picture of their group follow by Gauss-Newton steps on what is
// left (variable projection, with Kaufman's approximation). Channels are independent: the light may change its colour
// with its level.
#include <algorithm>
#include <cmath>

#include "core/levels.h"
#include "falloff/dense.hpp"
#include "fit/flat/fit.hpp"
#include "fit/flat/limits.hpp"
#include "fit/problem/linear.hpp"

namespace lensprof {
namespace {

constexpr int kSteps = 30;
constexpr double kStill = 1e-6;         // of a level
constexpr double kConverged = 1e-9;     // of full scale
constexpr size_t kFullPictures2 = 400;  // square of the pictures of a group from which on some cells suffice
constexpr double kOutlier2 = 9.0;       // of chi^2 per degree of freedom, from where a cell loses weight
constexpr double kShown = 0.5;          // of the stated error: above it, the pictures show nothing new
constexpr double kBeyondDarkest = 5.0;  // standard errors: outside of an image circle, the darkest cell has no light
constexpr double kNoLight = 3.0;        // likewise, of a cell that is black

using Groups = std::vector<std::vector<uint32_t>>;

// Pictures that show one pattern of light: of a shot, and of shots at one angle.
Groups groups_of(const FlatFit &fit) {
    const bool is_common = !fit.options.several;
    std::vector<double> turns;
    Groups groups;
    for (const Shot &shot : fit.shots) {
        const auto same = std::find(turns.begin(), turns.end(), shot.turn);
        const bool joins = is_common && same != turns.end();
        const auto place = joins ? same - turns.begin() : static_cast<std::ptrdiff_t>(groups.size());
        if (!joins) turns.push_back(shot.turn), groups.emplace_back();
        auto &group = groups[static_cast<size_t>(place)];
        group.insert(group.end(), shot.images.begin(), shot.images.end());
    }
    groups.erase(std::remove_if(groups.begin(), groups.end(), [](const auto &group) { return group.size() < 2; }),
                 groups.end());
    return groups;
}

struct Seen {
    int unknown;  // the first of its level: 0 for the first picture of a group, whose level is 1
    double value, per_sigma;
    std::array<double, 3> term;  // of the level: 1, and the place from the middle, half diagonals
};

// The pictures of one cell.
using SeenCell = std::vector<Seen>;

class OffsetFit {
public:
    OffsetFit(const FlatFit &fit, const Groups &groups, size_t channel)
        : terms_(fit.options.own_light ? 3 : 1), sigma_(fit.options.black_sigma) {
        int unknowns = 1;
        for (const auto &group : groups) {
            const size_t step = 1 + group.size() * group.size() / kFullPictures2;
            for (size_t cell = 0; cell < fit.pictures[group.front()].cells.size(); cell += step)
                add_cell(fit, group, channel, cell, unknowns);
            unknowns += terms_ * (static_cast<int>(group.size()) - 1);
        }
        level_.assign(static_cast<size_t>(unknowns), 0.0);
        start_levels();
    }

    // False if no cell is in two pictures.
    bool solve() {
        if (cells_.empty()) return false;
        for (int step = 0; step < kSteps; step++) {
            accumulate();
            const Eigen::VectorXd change = solve_symmetric(normal_, gradient_);
            for (size_t i = 1; i < level_.size(); i++) level_[i] += change[static_cast<Eigen::Index>(i)];
            const double before = offset_;
            offset_ = std::clamp(offset_ + change[0], -0.5, std::max(darkest_, 0.0));
            if (std::abs(offset_ - before) < kConverged && change.cwiseAbs().maxCoeff() < kStill) break;
        }
        accumulate();
        return true;
    }

    double offset() const { return offset_; }

    // Whether the pictures tell more than the stated error did.
    bool is_shown() const { return sigma() < kShown * sigma_; }

    // Standard error, from the curvature and the scatter of the cells.
    double sigma() const {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(normal_.rows(), 0);
        return std::min(std::sqrt(std::max(solve_symmetric(normal_, unit)[0], 0.0)), sigma_);
    }

private:
    void add_cell(const FlatFit &fit, const std::vector<uint32_t> &group, size_t channel, size_t cell, int unknowns) {
        SeenCell seen;
        for (size_t n = 0; n < group.size(); n++) {
            const CellPicture &picture = fit.pictures[group[n]];
            const Cell &one = picture.cells[cell];
            const double value = static_cast<double>(one.value[channel]);
            const double variance = picture.noise[channel].at(value) / std::max(one.pixels, 1u);
            if (one.state != CellState::used || !(variance > 0.0)) continue;
            const double half = lensprof_half_diagonal(fit.grid.width, fit.grid.height);
            seen.push_back({n == 0 ? 0 : unknowns + terms_ * (static_cast<int>(n) - 1),
                            value,
                            1.0 / std::sqrt(variance),
                            {1.0, (one.x - 0.5 * fit.grid.width) / half, (one.y - 0.5 * fit.grid.height) / half}});
            darkest_ = std::min(darkest_, value + kBeyondDarkest * std::sqrt(variance));
        }
        if (seen.size() > 1) cells_.push_back(std::move(seen));
    }

    // Ratios of sums over the cells that a picture shares with others of its group; the first have the level 1.
    void start_levels() {
        std::vector<double> sum(level_.size()), first(level_.size());
        for (const SeenCell &cell : cells_)
            for (const Seen &one : cell)
                if (one.unknown && cell.front().unknown == 0)
                    sum[static_cast<size_t>(one.unknown)] += one.value,
                        first[static_cast<size_t>(one.unknown)] += cell.front().value;
        for (size_t i = 1; i < level_.size(); i += static_cast<size_t>(terms_))
            if (first[i] > 0.0 && sum[i] > 0.0) level_[i] = std::log(sum[i] / first[i]);
    }

    double level_of(const Seen &one) const {
        double level = 0.0;
        for (int i = 0; i < terms_ && one.unknown; i++)
            level += level_[static_cast<size_t>(one.unknown + i)] * one.term[static_cast<size_t>(i)];
        return std::exp(level);
    }

    // Light of the cell at level 1, and |a / sigma|^2.
    std::pair<double, double> light_of(const SeenCell &cell) const {
        double both = 0.0, square = 0.0;
        for (const Seen &one : cell) {
            const double m = level_of(one) * one.per_sigma;
            both += m * (one.value - offset_) * one.per_sigma;
            square += m * m;
        }
        return {both / square, square};
    }

    double chi2_of(const SeenCell &cell, double light) const {
        double chi2 = 0.0;
        for (const Seen &one : cell) chi2 += std::pow((one.value - offset_ - level_of(one) * light) * one.per_sigma, 2);
        return chi2;
    }

    // Of a cell that leaves this chi^2, by the scatter of the last step.
    double weight_of(const SeenCell &cell, double chi2) const {
        return std::min(1.0, kOutlier2 * scatter_ * free_of(cell) / std::max(chi2, 1e-300));
    }

    static double free_of(const SeenCell &cell) { return static_cast<double>(cell.size()) - 1.0; }

    // Scatter of the cells in units of their noise, with the weights of the last step; at least 1.
    double scatter() const {
        double sum = 0.0, count = 0.0;
        for (const SeenCell &cell : cells_) {
            const double chi2 = chi2_of(cell, light_of(cell).first), weight = weight_of(cell, chi2);
            sum += weight * chi2, count += weight * free_of(cell);
        }
        return std::max(sum / std::max(count, 1.0), 1.0);
    }

    void accumulate() {
        const auto n = static_cast<Eigen::Index>(level_.size());
        scatter_ = scatter();
        normal_ = Eigen::MatrixXd::Zero(n, n);
        gradient_ = Eigen::VectorXd::Zero(n);
        for (const SeenCell &cell : cells_) add_normal(cell);
        normal_(0, 0) += 1.0 / (sigma_ * sigma_);
        gradient_[0] -= offset_ / (sigma_ * sigma_);
        for (Eigen::Index i = 1; i < n; i++) normal_(i, i) += 1e-12;  // of a picture without cells
    }

    // Column of an unknown: its derivative of every residual, less the part along a / sigma, which F takes.
    void add_normal(const SeenCell &cell) {
        const auto [light, square] = light_of(cell);
        const double weight = weight_of(cell, chi2_of(cell, light)) / scatter_;
        double along = 0.0;  // of 1 / sigma, the derivative by b
        for (const Seen &one : cell) along += level_of(one) * one.per_sigma * one.per_sigma / square;
        for (const Seen &one : cell) {
            const double m = level_of(one) * one.per_sigma, by_offset = one.per_sigma - along * m;
            const double rest = (one.value - offset_) * one.per_sigma - m * light;
            normal_(0, 0) += weight * by_offset * by_offset;
            gradient_[0] += weight * by_offset * rest;
            for (int i = 0; i < terms_ && one.unknown; i++) {
                const double by_level = light * m * one.term[static_cast<size_t>(i)];
                normal_(0, one.unknown + i) += weight * by_offset * by_level;
                normal_(one.unknown + i, 0) = normal_(0, one.unknown + i);
                gradient_[one.unknown + i] += weight * by_level * rest;
            }
            for (const Seen &other : cell)
                if (one.unknown && other.unknown) add_levels(one, other, weight * light * light, m / square);
        }
    }

    void add_levels(const Seen &one, const Seen &other, double weight, double along) {
        const double part = (one.unknown == other.unknown ? 1.0 : 0.0) - along * level_of(other) * other.per_sigma;
        const double both = weight * level_of(one) * one.per_sigma * level_of(other) * other.per_sigma * part;
        for (int i = 0; i < terms_; i++)
            for (int j = 0; j < terms_; j++)
                normal_(one.unknown + i, other.unknown + j) +=
                    both * one.term[static_cast<size_t>(i)] * other.term[static_cast<size_t>(j)];
    }

    int terms_;  // of a level
    double sigma_, offset_ = 0.0, scatter_ = 1.0, darkest_ = 1.0;
    std::vector<SeenCell> cells_;
    std::vector<double> level_;  // terms of ln a_n; the first number is that of the offset, and not used
    Eigen::MatrixXd normal_;
    Eigen::VectorXd gradient_;
};

// What an offset of 1 changes of ln M from the brightest to the darkest cell of the picture that has most light.
double effect_in_corner(const FlatFit &fit, size_t channel, double offset) {
    double effect = 0.0, most = 0.0;
    for (const CellPicture &picture : fit.pictures) {
        double dark = INFINITY, bright = 0.0;
        for (const Cell &cell : picture.cells) {
            const double value = static_cast<double>(cell.value[channel]) - offset;
            if (cell.state == CellState::used) dark = std::min(dark, value), bright = std::max(bright, value);
        }
        if (bright > most) most = bright, effect = effect_of_offset(bright, std::max(dark, 1e-6));
    }
    return effect;
}

// An offset that is neither clearly present nor known well enough for the corners is noise, which would make them
// worse. The same for all channels, whose falloffs would differ otherwise.
bool is_clear_or_exact(const FlatFit &fit, const FlatOffset &found) {
    double chi2 = 0.0, most = 0.0;
    int channels = 0;
    for (size_t c = 0; c < fit.options.channels; c++) {
        if (found.sigma[c] == 0.0) continue;
        channels++;
        chi2 += std::pow(found.value[c] / found.sigma[c], 2);
        most = std::max(most, found.sigma[c] * effect_in_corner(fit, c, found.value[c]));
    }
    const double clear = std::pow(flat_limits::kClearOffset, 2) + 2.6 * (channels - 1);  // 99.73 % of chi-squared
    return chi2 > clear || most < flat_limits::kLargestCornerSigma;
}

void subtract(CellPicture &picture, size_t channel, double offset) {
    const double span = 1.0 - offset;
    const auto moved = [&](double value) { return (value - offset) / span; };
    for (Cell &cell : picture.cells) {
        cell.value[channel] = static_cast<float>(moved(static_cast<double>(cell.value[channel])));
        cell.noise[channel] /= static_cast<float>(span);
        const double sigma = static_cast<double>(cell.noise[channel]) / std::sqrt(std::max(cell.pixels, 1u));
        const bool is_dark = static_cast<double>(cell.value[channel]) < kNoLight * sigma;
        if (cell.state == CellState::used && is_dark) cell.state = CellState::black;
    }
    for (double &grey : picture.noise[channel].grey) grey = moved(grey);
    for (double &variance : picture.noise[channel].variance) variance /= span * span;
}

}  // namespace

void subtract_offset(FlatFit &fit) {
    if (!(fit.options.black_sigma > 0.0) || !are_linear(fit.options.response, fit.options.responses)) return;
    const Groups groups = groups_of(fit);
    const size_t channels = fit.options.channels;
    FlatOffset found;
    size_t shown = 0;
    for (size_t c = 0; c < channels; c++) {
        OffsetFit offset(fit, groups, c);
        if (!offset.solve() || !offset.is_shown()) continue;
        found.value[c] = offset.offset(), found.sigma[c] = offset.sigma();
        shown++;
    }
    fit.offset.sigma.fill(fit.options.black_sigma);
    if (shown == 0) return;
    if (!is_clear_or_exact(fit, found)) {  // as one light has it for all channels
        for (size_t c = 0; c < channels; c++)
            if (found.sigma[c] > 0.0)
                fit.offset.sigma[c] = std::min(std::hypot(found.value[c], found.sigma[c]), fit.options.black_sigma);
        return;
    }
    double mean = 0.0;
    for (size_t c = 0; c < channels; c++) {
        if (found.sigma[c] == 0.0) continue;
        fit.offset.value[c] = found.value[c], fit.offset.sigma[c] = found.sigma[c];
        mean += found.value[c] / static_cast<double>(channels);
        for (CellPicture &picture : fit.pictures) subtract(picture, c, found.value[c]);
    }
    fit.offset.is_shown = shown == channels;
    for (lensprof_flat_image &image : fit.images)
        image.black = std::max((image.black - mean) / (1.0 - mean), 0.0),
        image.white = (image.white - mean) / (1.0 - mean);
    if (channels == 1) fit.offset.value.fill(fit.offset.value[0]), fit.offset.sigma.fill(fit.offset.sigma[0]);
}

}  // namespace lensprof
