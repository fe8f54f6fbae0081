#include "fit/problem/curve_shape.hpp"

#include <algorithm>
#include <cmath>

#include "core/response.h"

namespace lensprof {
namespace {

constexpr int kGrid = LENSPROF_RESPONSE_SAMPLES;

// The rises of f as a function of its coefficients, which are the steps.
class RiseInequalities : public Inequalities {
public:
    explicit RiseInequalities(int modes) : modes_(modes) {}

    int count() const override { return kRises; }
    double tolerance(int) const override { return 0.25 * kSmallestRise; }
    bool is_kept(const Eigen::VectorXd &d) const override { return is_rising(d.data(), modes_); }

    std::vector<double> gaps(const Eigen::VectorXd &d) const override {
        std::vector<double> gaps(kRises);
        rise_gaps(d.data(), modes_, gaps.data());
        return gaps;
    }

    Eigen::VectorXd row(int i) const override {
        Eigen::VectorXd row(modes_);
        for (int l = 0; l < modes_; l++) row[l] = rise_of_mode(l, i);
        return row;
    }

private:
    int modes_;
};

}  // namespace

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

bool is_feasible(const Estimate &estimate, int vignettings) {
    for (const Falloffs &curves : estimate.vignetting)
        for (int c = 0; c < vignettings; c++)
            if (!is_positive(curves[static_cast<size_t>(c)].k, curves[0].center)) return false;
    return estimate.modes < 0 || is_rising(estimate.emor.data(), estimate.modes);
}

void rise_gaps(const double *emor, int modes, double *gaps) {
    double curve[kGrid];
    lp_emor_curve(emor, static_cast<uint32_t>(modes), curve);
    for (int i = 0; i < kRises; i++) gaps[i] = kSmallestRise - (curve[i + 1] - curve[i]);
}

double rise_of_mode(int l, int j) {
    const double *h = lensprof_emor_table(static_cast<uint32_t>(l) + 1);
    return (j + 1 == kGrid - 1 ? 0.0 : h[j + 1]) - (j == 0 ? 0.0 : h[j]);
}

std::vector<double> project_curve(const double *curve, int modes) {
    // The modes are orthonormal on the grid, so the normal matrix is the identity.
    Eigen::VectorXd b(modes);
    for (int l = 0; l < modes; l++) {
        const double *h = lensprof_emor_table(static_cast<uint32_t>(l) + 1), *f0 = lensprof_emor_table(0);
        b[l] = 0.0;
        for (int j = 0; j < kGrid; j++) b[l] += h[j] * (curve[j] - f0[j]);
    }
    std::vector<double> emor(static_cast<size_t>(modes), 0.0);
    if (modes == 0) return emor;
    Eigen::VectorXd d = constrained_step(RiseInequalities(modes), Eigen::MatrixXd::Identity(modes, modes), b);
    std::copy(d.data(), d.data() + modes, emor.begin());
    return emor;
}

}  // namespace lensprof
