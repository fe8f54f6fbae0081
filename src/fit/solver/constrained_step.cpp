#include "fit/solver/constrained_step.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/inequality.hpp"
#include "fit/problem/curve_shape.hpp"

namespace lensprof {
namespace {

constexpr int kRadii = 33;  // samples of r^2 at which M is held positive
constexpr double kSmallestM = 0.01;
constexpr double kReach2 = 1.8 * 1.8;  // (1 + largest |centre|)^2 that the bound below leaves

// The r^2 up to which M must be positive for a centre: the farthest corner, with a margin for the centre's own step.
double reach2(const Eigen::VectorXd &value) {
    double reach = 1.0 + std::hypot(value[kCenter], value[kCenter + 1]) + 0.02;
    return std::min(reach * reach, kReach2);
}

Eigen::VectorXd moved(const Region &region, const Eigen::VectorXd &d) {
    Eigen::VectorXd value = region.value;
    for (size_t u = 0; u < region.columns.size(); u++) value[region.columns[u]] += d[static_cast<Eigen::Index>(u)];
    return value;
}

// In this order: rises of f, values of each M, bounds of the centre.
class CameraInequalities : public Inequalities {
public:
    explicit CameraInequalities(const Region &r) : region(r), limit2(reach2(r.value)) {}

    int count() const override { return first_center() + 4; }
    double tolerance(int i) const override { return i < kRises ? 0.25 * kSmallestRise : 1e-6; }

    bool is_kept(const Eigen::VectorXd &d) const override {
        const Eigen::VectorXd value = moved(region, d);
        for (int c = 0; c < region.vignettings; c++)
            if (!is_positive(value.data() + kFalloff + 3 * c, value.data() + kCenter)) return false;
        return region.modes < 0 || is_rising(value.data(), region.modes);
    }

    std::vector<double> gaps(const Eigen::VectorXd &d) const override {
        const Eigen::VectorXd value = moved(region, d);
        std::vector<double> gap(static_cast<size_t>(count()), -1.0);
        if (!region.columns.empty() && region.columns[0] < kMaxModes) rise_gaps(value.data(), region.modes, gap.data());
        for (int i = kRises; i < first_center(); i++) {
            const double *k = value.data() + kFalloff + 3 * ((i - kRises) / kRadii);
            const lensprof_vignetting v{{k[0], k[1], k[2]}, {0.0, 0.0}};
            gap[static_cast<size_t>(i)] = kSmallestM - lensprof_vignetting_eval(&v, radius2(i), nullptr);
        }
        for (int b = 0; b < 4; b++)
            gap[static_cast<size_t>(first_center() + b)] =
                (b % 2 ? value[kCenter + b / 2] : -value[kCenter + b / 2]) - kLargestCenter;
        return gap;
    }

    Eigen::VectorXd row(int i) const override {
        Eigen::VectorXd row = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(region.columns.size()));
        for (Eigen::Index u = 0; u < row.size(); u++) {
            int column = region.columns[static_cast<size_t>(u)];
            if (i < kRises) {
                if (column < kMaxModes) row[u] = rise_of_mode(column, i);
            } else if (i < first_center()) {
                int power = column - kFalloff - 3 * ((i - kRises) / kRadii);
                if (column >= kFalloff && power >= 0 && power < 3) row[u] = std::pow(radius2(i), power + 1);
            } else {
                int b = i - first_center();
                if (column == kCenter + b / 2) row[u] = b % 2 ? -1.0 : 1.0;
            }
        }
        return row;
    }

private:
    int first_center() const { return kRises + kRadii * region.vignettings; }
    double radius2(int i) const { return limit2 * ((i - kRises) % kRadii + 1) / kRadii; }

    const Region &region;
    double limit2;
};

}  // namespace

Eigen::VectorXd constrained_step(const Region &region, const Eigen::MatrixXd &S, const Eigen::VectorXd &b) {
    return constrained_step(CameraInequalities(region), S, b);
}

}  // namespace lensprof
