#include "fit/problem/monotone.hpp"

#include <algorithm>
#include <cmath>

#include "core/response.h"
#include "fit/base/inequality.hpp"

namespace lensprof {
namespace {

constexpr int kGrid = LENSPROF_RESPONSE_SAMPLES;
constexpr int kRises = kGrid - 1;
constexpr int kRadii = 33;  // samples of r^2 at which M is held positive
constexpr double kSmallestM = 0.01;
constexpr double kReach2 = 1.8 * 1.8;  // (1 + largest |centre|)^2 that the bound below leaves
constexpr double kLargestCenter = 0.5;

// The r^2 up to which M must be positive for a centre: the farthest corner, with a margin for the centre's own step.
double reach2(const Eigen::VectorXd &value) {
    double reach = 1.0 + std::hypot(value[kCenter], value[kCenter + 1]) + 0.02;
    return std::min(reach * reach, kReach2);
}

bool is_rising(const double *emor, int modes) {
    double table[kGrid];
    lp_emor_curve(emor, static_cast<uint32_t>(modes), table);
    for (int j = 0; j < kRises; j++)
        if (!(table[j + 1] - table[j] >= 0.5 * kSmallestRise)) return false;
    return true;
}

bool is_positive(const double *k, const double *center) {
    lensprof_vignetting v{{k[0], k[1], k[2]}, {center[0], center[1]}};
    return lensprof_vignetting_validate(&v) == LENSPROF_OK && std::abs(center[0]) <= kLargestCenter
           && std::abs(center[1]) <= kLargestCenter;
}

bool step_is_feasible(const Region &region, const Eigen::VectorXd &d) {
    Eigen::VectorXd value = region.value;
    for (size_t u = 0; u < region.columns.size(); u++) value[region.columns[u]] += d[static_cast<Eigen::Index>(u)];
    for (int c = 0; c < region.vignettings; c++)
        if (!is_positive(value.data() + kFalloff + 3 * c, value.data() + kCenter)) return false;
    return region.modes < 0 || is_rising(value.data(), region.modes);
}

// In this order: rises of f, values of each M, bounds of the centre.
class CameraInequalities : public Inequalities {
public:
    explicit CameraInequalities(const Region &r) : region(r), limit2(reach2(r.value)) {}

    int count() const override { return first_center() + 4; }
    double tolerance(int i) const override { return i < kRises ? 0.25 * kSmallestRise : 1e-6; }
    bool is_kept(const Eigen::VectorXd &d) const override { return step_is_feasible(region, d); }

    std::vector<double> gaps(const Eigen::VectorXd &d) const override {
        Eigen::VectorXd value = region.value;
        for (size_t u = 0; u < region.columns.size(); u++) value[region.columns[u]] += d[static_cast<Eigen::Index>(u)];
        std::vector<double> gap(static_cast<size_t>(count()), -1.0);
        if (!region.columns.empty() && region.columns[0] < kMaxModes) {
            double curve[kGrid];
            lp_emor_curve(value.data(), static_cast<uint32_t>(region.modes), curve);
            for (int i = 0; i < kRises; i++) gap[static_cast<size_t>(i)] = kSmallestRise - (curve[i + 1] - curve[i]);
        }
        for (int i = kRises; i < first_center(); i++) {
            const double *k = value.data() + kFalloff + 3 * ((i - kRises) / kRadii);
            double s = radius2(i);
            gap[static_cast<size_t>(i)] = kSmallestM - (1.0 + s * (k[0] + s * (k[1] + s * k[2])));
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

    // Rise of mode `l` between samples j and j + 1. The ends of f stay at 0 and 1 exactly (see lp_emor_curve).
    static double rise_of_mode(int l, int j) {
        const double *h = lensprof_emor_table(static_cast<uint32_t>(l) + 1);
        return (j + 1 == kGrid - 1 ? 0.0 : h[j + 1]) - (j == 0 ? 0.0 : h[j]);
    }

    const Region &region;
    double limit2;
};

}  // namespace

bool is_feasible(const Estimate &estimate, int vignettings) {
    for (int c = 0; c < vignettings; c++)
        if (!is_positive(estimate.vignetting[static_cast<size_t>(c)].k, estimate.vignetting[0].center)) return false;
    return estimate.modes < 0 || is_rising(estimate.emor.data(), estimate.modes);
}

Eigen::VectorXd constrained_step(const Region &region, const Eigen::MatrixXd &S, const Eigen::VectorXd &b) {
    return constrained_step(CameraInequalities(region), S, b);
}

std::vector<double> project_curve(const double *curve, int modes) {
    // The modes are orthonormal on the grid, so the normal matrix is the identity.
    Region region{modes, 1, {}, Eigen::VectorXd::Zero(kMaxShared)};
    Eigen::VectorXd b(modes);
    for (int l = 0; l < modes; l++) {
        const double *h = lensprof_emor_table(static_cast<uint32_t>(l) + 1), *f0 = lensprof_emor_table(0);
        region.columns.push_back(l);
        b[l] = 0.0;
        for (int j = 0; j < kGrid; j++) b[l] += h[j] * (curve[j] - f0[j]);
    }
    std::vector<double> emor(static_cast<size_t>(modes), 0.0);
    if (modes == 0) return emor;
    Eigen::VectorXd d = constrained_step(region, Eigen::MatrixXd::Identity(modes, modes), b);
    std::copy(d.data(), d.data() + modes, emor.begin());
    return emor;
}

}  // namespace lensprof
