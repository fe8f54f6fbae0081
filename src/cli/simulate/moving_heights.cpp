#include "cli/simulate/moving_heights.hpp"

#include <algorithm>
#include <cmath>

#include "cli/simulate/moving_texture.hpp"

namespace lensprof {
namespace {

constexpr double kCell = 0.5;  // m
constexpr double kFar = 2000.0;

double hills(uint32_t seed, double x, double y) {
    return 10.0 * noise2(x / 62.0, y / 62.0, seed)
           + 5.0 * noise2(0.8 * x / 27.0 - 0.6 * y / 27.0, 0.6 * x / 27.0 + 0.8 * y / 27.0, seed + 1)
           + 1.6 * noise2(x / 11.0, y / 11.0, seed + 2) + 0.45 * noise2(x / 4.1, y / 4.1, seed + 3);
}

}  // namespace

Heights::Heights(uint32_t seed, double reach_x_m, double reach_y_m)
    : reach_m_{reach_x_m, reach_y_m},
      columns_(static_cast<size_t>(std::ceil(2.0 * reach_x_m / kCell)) + 2),
      rows_(static_cast<size_t>(std::ceil(2.0 * reach_y_m / kCell)) + 2),
      heights_m_(columns_ * rows_) {
    for (size_t j = 0; j < rows_; j++)
        for (size_t i = 0; i < columns_; i++)
            heights_m_[j * columns_ + i] = static_cast<float>(
                hills(seed, static_cast<double>(i) * kCell - reach_x_m, static_cast<double>(j) * kCell - reach_y_m));
    top_m_ = static_cast<double>(*std::max_element(heights_m_.begin(), heights_m_.end()));
    double steepest = 0.0;
    for (size_t j = 0; j + 1 < rows_; j++)
        for (size_t i = 0; i + 1 < columns_; i++) {
            const auto height = static_cast<double>(heights_m_[j * columns_ + i]);
            const double along = std::fabs(static_cast<double>(heights_m_[j * columns_ + i + 1]) - height);
            const double across = std::fabs(static_cast<double>(heights_m_[(j + 1) * columns_ + i]) - height);
            steepest = std::max({steepest, along, across});
        }
    slope_ = std::sqrt(2.0) * steepest / kCell;
}

double Heights::height_at(double x, double y) const {
    const double u = std::clamp((x + reach_m_[0]) / kCell, 0.0, static_cast<double>(columns_) - 1.001);
    const double v = std::clamp((y + reach_m_[1]) / kCell, 0.0, static_cast<double>(rows_) - 1.001);
    const auto i = static_cast<size_t>(u), j = static_cast<size_t>(v);
    const double s = u - static_cast<double>(i), t = v - static_cast<double>(j);
    const float *low = &heights_m_[j * columns_ + i], *high = low + columns_;
    const auto a = static_cast<double>(low[0]), b = static_cast<double>(low[1]), c = static_cast<double>(high[0]),
               d = static_cast<double>(high[1]);
    return (1.0 - t) * (a + s * (b - a)) + t * (c + s * (d - c));
}

Vector3 Heights::normal(double x, double y) const {
    const double along = height_at(x + kCell, y) - height_at(x - kCell, y),
                 across = height_at(x, y + kCell) - height_at(x, y - kCell);
    return normalised({-along, -across, 2.0 * kCell});
}

// In steps that cannot pass the ground, because it is nowhere steeper than slope_; the last ones by the secant method.
bool Heights::meet(const Line &line, double &distance_m) const {
    const double fall = -line.direction.z, horizontal = std::hypot(line.direction.x, line.direction.y);
    double travelled_m = line.from.z > top_m_ ? (line.from.z - top_m_) / fall : 0.0, previous_m = travelled_m,
           previous_gap = 0.0;
    if (line.from.z > top_m_ && fall <= 0.0) return false;
    const double closing = fall + slope_ * horizontal;  // a metre along the ray reduces the gap by at most this
    if (closing <= 0.0) return false;
    for (int step = 0; step < 400 && travelled_m < kFar; step++) {
        const Vector3 place = line.from + travelled_m * line.direction;
        if (fall <= 0.0 && place.z > top_m_) return false;
        const double gap = place.z - height_at(place.x, place.y);
        if (std::fabs(gap) < 1e-4) {
            distance_m = travelled_m;
            return true;
        }
        double advance = gap / closing;
        if (std::fabs(gap) < 0.2 && previous_gap != 0.0
            && previous_gap - gap > 0.1 * (travelled_m - previous_m) * closing)
            advance = gap * (travelled_m - previous_m) / (previous_gap - gap);
        previous_m = travelled_m, previous_gap = gap, travelled_m += advance;
    }
    return false;
}

}  // namespace lensprof
