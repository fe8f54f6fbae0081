#include "fit/methods/transfer_function/log_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/response.h"
#include "fit/base/inequality.hpp"

namespace lensprof {
namespace {

constexpr double kDarkest = 1e-12;  // irradiance whose logarithm replaces that of 0

// The rises of g as inequalities on the coefficients: they hold at 0, because g0 rises.
class RisingLog : public Inequalities {
public:
    explicit RisingLog(Eigen::Index modes) : modes_(modes) {}

    int count() const override { return kLogLevels - 1; }
    double tolerance(int) const override { return 0.25 * kSmallestLogRise; }
    std::vector<double> gaps(const Eigen::VectorXd &c) const override {
        std::vector<double> gap;
        for (int i = 0; i < count(); i++) gap.push_back(kSmallestLogRise - rise(0, i) - row(i).dot(c));
        return gap;
    }
    Eigen::VectorXd row(int i) const override {
        Eigen::VectorXd row(modes_);
        for (Eigen::Index n = 0; n < modes_; n++) row[n] = rise(static_cast<int>(n) + 1, i);
        return row;
    }
    bool is_kept(const Eigen::VectorXd &c) const override {
        for (double gap : gaps(c))
            if (!(gap <= 0.5 * kSmallestLogRise)) return false;
        return true;
    }

private:
    static double rise(int curve, int i) { return kLogEmor[curve][i + 1] - kLogEmor[curve][i]; }

    Eigen::Index modes_;
};

}  // namespace

LogInverse log_inverse(const LogCoefficients &c) {
    LogInverse g;
    for (size_t i = 0; i < g.size(); i++) {
        g[i] = kLogEmor[0][i];
        for (int n = 0; n < kLogModes; n++) g[i] += c[n] * kLogEmor[n + 1][i];
    }
    g.back() = 0.0;  // exact except for rounding
    return g;
}

LogInverse log_inverse(const lensprof_response &response) {
    LogInverse g;
    for (size_t i = 0; i < g.size(); i++) {
        double x = lensprof_response_invert(&response, static_cast<double>(i + 1) / kLogLevels, nullptr);
        g[i] = std::log(std::max(x, kDarkest));
    }
    return g;
}

double at_level(const double *row, double level, double *slope) {
    double position = std::clamp(level, 1.0, static_cast<double>(kLogLevels)) - 1.0;
    auto i = std::min(static_cast<int>(position), kLogLevels - 2);
    double rise = row[i + 1] - row[i];
    if (slope) *slope = rise;
    return row[i] + (position - i) * rise;
}

lensprof_response response_of(const LogInverse &g) {
    std::array<double, LENSPROF_RESPONSE_SAMPLES> table;
    double below = 0.0, above = std::exp(g[0]);  // irradiances of the levels i and i + 1
    size_t i = 0;
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        double x = static_cast<double>(j) / LP_CURVE_LAST;
        while (above < x && i + 1 < g.size()) below = above, above = std::exp(g[++i]);
        double part = above > below ? std::clamp((x - below) / (above - below), 0.0, 1.0) : 1.0;
        table[static_cast<size_t>(j)] = (static_cast<double>(i) + part) / kLogLevels;
    }
    table.front() = 0.0;
    table.back() = 1.0;
    lensprof_response response;
    if (lensprof_response_set_table(&response, table.data(), LENSPROF_RESPONSE_SAMPLES) != LENSPROF_OK)
        throw std::runtime_error("the fitted response is not monotone");
    return response;
}

LogCoefficients monotone_coefficients(const Eigen::MatrixXd &S, const Eigen::VectorXd &b) {
    LogCoefficients c = LogCoefficients::Zero();
    if (b.size()) c.head(b.size()) = constrained_step(RisingLog(b.size()), S, b);
    return c;
}

}  // namespace lensprof
