// Levels of items of which ratios are known: a sequence of frames, compared over several distances.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace lensprof {

// The level of `to` less that of `from`, EV, per channel.
struct ChainRatio {
    uint32_t from, to;
    std::array<double, 3> ev;
    double sigma, trust;  // standard error of `ev`; weight beyond 1 / sigma^2
};

// The levels of items in all channels, known otherwise; NaN: they are not.
struct KnownLevels {
    std::vector<double> ev;  // per item, or none
    double sigma = 1.0;
};

// Least squares of all ratios: the levels of `count` items. Items that ratios connect are relative to one of them, for
// which `is_anchor`, unless some are known. Ratios that contradict the others grossly, in channel `main`, count less.
inline std::vector<std::array<double, 3>> chained_levels(const std::vector<ChainRatio> &ratios,
                                                         const std::vector<uint8_t> &is_anchor, size_t main,
                                                         const KnownLevels &known = {}) {
    constexpr double gross_ev = 0.01, anchored = 1e12, nothing = 1e-9;
    const auto count = static_cast<Eigen::Index>(is_anchor.size());
    std::vector<double> weight;
    for (const ChainRatio &ratio : ratios) weight.push_back(ratio.trust / (ratio.sigma * ratio.sigma));
    Eigen::MatrixXd ev = Eigen::MatrixXd::Zero(count, 3);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    for (int round = 0; round < 4; round++) {
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 3);
        for (size_t n = 0; n < ratios.size(); n++) {
            const ChainRatio &ratio = ratios[n];
            const double w = weight[n];
            entries.emplace_back(ratio.to, ratio.to, w), entries.emplace_back(ratio.from, ratio.from, w);
            entries.emplace_back(std::max(ratio.to, ratio.from), std::min(ratio.to, ratio.from), -w);
            for (Eigen::Index c = 0; c < 3; c++) {
                right(ratio.to, c) += w * ratio.ev[static_cast<size_t>(c)];
                right(ratio.from, c) -= w * ratio.ev[static_cast<size_t>(c)];
            }
        }
        for (Eigen::Index i = 0; i < count; i++) {
            const auto item = static_cast<size_t>(i);
            entries.emplace_back(i, i, is_anchor[item] ? anchored : nothing);
            if (item >= known.ev.size() || std::isnan(known.ev[item])) continue;
            const double w = 1.0 / (known.sigma * known.sigma);
            entries.emplace_back(i, i, w);
            right.row(i).array() += w * known.ev[item];
        }
        Eigen::SparseMatrix<double> normal(count, count);
        normal.setFromTriplets(entries.begin(), entries.end());
        if (round == 0) solver.analyzePattern(normal);
        solver.factorize(normal);
        ev = solver.solve(right);
        for (size_t n = 0; n < ratios.size(); n++) {
            const ChainRatio &ratio = ratios[n];
            const auto c = static_cast<Eigen::Index>(main);
            const double residual = std::abs(ev(ratio.to, c) - ev(ratio.from, c) - ratio.ev[main]);
            const double limit = 2.0 * ratio.sigma + gross_ev;
            weight[n] = std::min(1.0, limit / std::max(residual, limit)) * ratio.trust / (ratio.sigma * ratio.sigma);
        }
    }
    std::vector<std::array<double, 3>> levels;
    for (Eigen::Index i = 0; i < count; i++) levels.push_back({ev(i, 0), ev(i, 1), ev(i, 2)});
    return levels;
}

}  // namespace lensprof
