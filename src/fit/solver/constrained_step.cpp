#include "fit/solver/constrained_step.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fit/base/inequality.hpp"
#include "fit/problem/curve_shape.hpp"

namespace lensprof {
namespace {

constexpr int kRadii = 33;  // samples of r^2 at which M is held positive
constexpr double kLowerBound = 0.01;
constexpr double kFallStep = 1.0 / kRadii;  // of r^2
constexpr double kReach2 = 1.8 * 1.8;       // (1 + largest |centre|)^2 that the bound below allows

// The r^2 up to which M must be positive for the centre of a setting: the farthest corner, with a margin for the
// centre's own step.
double reach2(const Eigen::VectorXd &value, int setting) {
    const int center = center_column(setting);
    double reach = 1.0 + std::hypot(value[center], value[center + 1]) + 0.02;
    return std::min(reach * reach, kReach2);
}

Eigen::VectorXd moved(const Region &region, const Eigen::VectorXd &d) {
    Eigen::VectorXd value = region.value;
    for (size_t u = 0; u < region.columns.size(); u++) value[region.columns[u]] += d[static_cast<Eigen::Index>(u)];
    return value;
}

// Order: rises of f; then for each setting the values of each M, the bounds of the centre and, if falloffs may not
// rise, the differences of each M from one radius to the next.
class CameraInequalities : public Inequalities {
public:
    explicit CameraInequalities(const Region &r) : region(r) {
        for (int s = 0; s < r.settings; s++) limit2.push_back(reach2(r.value, s));
    }

    int count() const override { return kRises + region.settings * of_setting(); }
    double tolerance(int i) const override { return i < kRises ? 0.25 * kSmallestRise : 1e-6; }

    bool is_kept(const Eigen::VectorXd &d) const override {
        const Eigen::VectorXd value = moved(region, d);
        for (int s = 0; s < region.settings; s++)
            for (int c = 0; c < region.vignettings; c++)
                if (!is_positive(value.data() + falloff_column(s) + 3 * c, value.data() + center_column(s)))
                    return false;
        for (int i = kRises; region.falls && i < count(); i++)
            if (const Place bound = place(i); bound.kind == Kind::fall && rise_at(value, bound) > tolerance(i))
                return false;
        return region.modes < 0 || is_rising(value.data(), region.modes);
    }

    std::vector<double> gaps(const Eigen::VectorXd &d) const override {
        const Eigen::VectorXd value = moved(region, d);
        std::vector<double> gap(static_cast<size_t>(count()), -1.0);
        if (!region.columns.empty() && region.columns[0] < kMaxModes) rise_gaps(value.data(), region.modes, gap.data());
        for (int i = kRises; i < count(); i++) {
            const Place bound = place(i);
            const double *k = value.data() + bound.column;
            double &of_bound = gap[static_cast<size_t>(i)];
            switch (bound.kind) {
            case Kind::upper: of_bound = *k - kLargestCenter; break;
            case Kind::lower: of_bound = -*k - kLargestCenter; break;
            case Kind::fall: of_bound = rise_at(value, bound); break;
            case Kind::positive: of_bound = kLowerBound - value_at(value, bound, bound.radius2); break;
            }
        }
        return gap;
    }

    Eigen::VectorXd row(int i) const override {
        Eigen::VectorXd row = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(region.columns.size()));
        for (Eigen::Index u = 0; u < row.size(); u++) {
            int column = region.columns[static_cast<size_t>(u)];
            if (i < kRises) {
                if (column < kMaxModes) row[u] = rise_of_mode(column, i);
                continue;
            }
            const Place bound = place(i);
            const int power = column - bound.column;
            const bool is_center = bound.kind == Kind::upper || bound.kind == Kind::lower;
            if (is_center && power == 0) row[u] = bound.kind == Kind::upper ? -1.0 : 1.0;
            if (is_center || power < 0 || power > 2) continue;
            row[u] = std::pow(bound.radius2, power + 1);
            if (bound.kind == Kind::fall) row[u] = std::pow(bound.radius2 - kFallStep, power + 1) - row[u];
        }
        return row;
    }

private:
    // Meaning of an inequality from kRises on: of the curve that begins in `column` its value at radius2, or its rise
    // up to there; or a bound of the coordinate of a centre in `column`.
    enum class Kind {
        positive,
        lower,
        upper,
        fall
    };
    struct Place {
        int column;
        Kind kind;
        double radius2;
    };
    Place place(int i) const {
        const int setting = (i - kRises) / of_setting(), n = (i - kRises) % of_setting();
        const int values = kRadii * region.vignettings, bound = n - values;
        const auto column = [&](int of_values) { return falloff_column(setting) + 3 * (of_values / kRadii); };
        if (bound < 0)
            return {column(n), Kind::positive, limit2[static_cast<size_t>(setting)] * (n % kRadii + 1) / kRadii};
        if (bound < 4) return {center_column(setting) + bound / 2, bound % 2 == 1 ? Kind::upper : Kind::lower, 0.0};
        return {column(bound - 4), Kind::fall, kFallStep * ((bound - 4) % kRadii + 1)};
    }
    int of_setting() const { return kRadii * region.vignettings * (region.falls ? 2 : 1) + 4; }

    static double value_at(const Eigen::VectorXd &value, const Place &bound, double radius2) {
        const double *k = value.data() + bound.column;
        const lensprof_vignetting v{{k[0], k[1], k[2]}, {0.0, 0.0}};
        return lensprof_vignetting_eval(&v, radius2, nullptr);
    }
    static double rise_at(const Eigen::VectorXd &value, const Place &bound) {
        return value_at(value, bound, bound.radius2) - value_at(value, bound, bound.radius2 - kFallStep);
    }

    const Region &region;
    std::vector<double> limit2;  // per setting
};

}  // namespace

Eigen::VectorXd constrained_step(const Region &region, const Eigen::MatrixXd &S, const Eigen::VectorXd &b) {
    return constrained_step(CameraInequalities(region), S, b);
}

}  // namespace lensprof
