#include "fit/methods/refine.hpp"

#include <algorithm>
#include <cmath>

#include "falloff/dense.hpp"
#include "fit/base/levels.hpp"
#include "fit/problem/residual.hpp"

namespace lensprof {
namespace {

constexpr int kUnknown = kCorrections;      // unknown k - 1: the correction at grey level k of 255; the last is 0
constexpr int kGaussNewtonRounds = 8;       // Gauss-Newton,
constexpr double kWorthwhile = 1.0;         // as long as a round lowers the cost by more
constexpr double kBend = 0.002;             // levels: expected second difference of the correction from level to level,
constexpr double kEndBend = 1.0;            // and at the ends, where responses are steep,
constexpr double kEndReach = 6.0;           // reach of the ends, levels
constexpr double kLargestCorrection = 8.0;  // levels, one standard deviation: holds levels that no pair determines

// D at every level. f is linear up to its first sample of irradiance; up to the grey value there, and up to level 1, D
// is therefore constant.
struct Correction {
    double first;  // that grey value, levels
    std::array<double, kLevels> offset{};

    explicit Correction(const Curve &base) : first(std::clamp(255.0 * base.table[1], 1.0, 254.0)) {}

    Place place_of(double b) const { return lensprof::place_of(b, first); }
    double value(double b) const { return value_at(offset, place_of(b)); }
};

// f at the 1024 samples of irradiance from g = exp(G0 + D).
std::array<double, LENSPROF_RESPONSE_SAMPLES> table_of(const Curve &base, const Correction &d) {
    return response_samples([&](double b) { return base.invert(b, nullptr) * std::exp(d.value(b)); });
}

// Columns of the unknowns: corrections, then those of the images; -1 is fixed at 0.
int level_column(int level) { return level < kUnknown ? level : -1; }
int image_column(int unknown) { return unknown < 0 ? -1 : kUnknown + unknown; }

// D(B) - D(P) + d ln t as a sum over unknowns.
struct Row {
    static constexpr int kEntries = 8;
    int column[kEntries];
    double coefficient[kEntries];
};

Row row_of(const Problem &problem, const lensprof_pair &pair, int c, int side, Place b, Place p) {
    uint32_t i = pair.image[side], j = pair.image[1 - side];
    const auto channel = static_cast<size_t>(c);
    return {{level_column(b.low), level_column(b.low + 1), level_column(p.low), level_column(p.low + 1),
             image_column(problem.ev_unknown[i]), image_column(problem.balance_unknown[i][channel]),
             image_column(problem.ev_unknown[j]), image_column(problem.balance_unknown[j][channel])},
            {1.0 - b.share, b.share, p.share - 1.0, -p.share, 1.0, 1.0, -1.0, -1.0}};
}

// The linear problem of one round: the unknowns are the corrections and the changes of the images' log exposures, both
// relative to the start of the refinement.
class Equations {
public:
    Equations(const Problem &problem, const Estimate &first)
        : problem_(problem), first_(first), size_(kUnknown + problem.image_unknowns), rows_(size_) {}

    void add_pairs(const Loss &loss, const Correction &d, const Estimate &current);
    void add_smoothness();
    void hold_gamma();
    Eigen::VectorXd solve() const { return solve_symmetric(rows_.normal, rows_.right); }

private:
    void add_transfer(const lensprof_pair &pair, int c, int side, const Transfer &t, const Correction &d,
                      const Estimate &current, double weight);

    const Problem &problem_;
    const Estimate &first_;
    Eigen::Index size_;
    NormalRows rows_;
};

// A prediction P = f( g(B) t ) solves  G(P) + D(P) = G(B) + D(B) + ln t, so that
//     dP = (D(B) - D(P) + d ln t) dP/d ln t.
void Equations::add_transfer(const lensprof_pair &pair, int c, int side, const Transfer &t, const Correction &d,
                             const Estimate &current, double weight) {
    const auto channel = static_cast<size_t>(c);
    const double from = pair.value[1 - side][c], to = pair.value[side][c] - t.residual[side];
    const double slope = std::abs(t.by_delta[side]);
    if (slope == 0.0) return;  // saturated prediction
    uint32_t i = pair.image[side], j = pair.image[1 - side];
    Row row = row_of(problem_, pair, c, side, d.place_of(from), d.place_of(to));
    double done = d.value(from) - d.value(to) + current.log_exposure[i][channel] - first_.log_exposure[i][channel]
                  - current.log_exposure[j][channel] + first_.log_exposure[j][channel];
    rows_.add(row.column, row.coefficient, Row::kEntries, t.residual[side] / slope + done, weight * slope * slope);
}

void Equations::add_pairs(const Loss &loss, const Correction &d, const Estimate &current) {
    NoiseWeights weights = noise_weights(problem_, current, loss);
    for_each_transfer(problem_, current, [&](size_t p, const PairTransfer &t) {
        PairResiduals factor, residuals = weighted_residuals(t, problem_.channels, weights[p]);
        pair_cost(residuals, problem_.channels, loss, &factor);
        for (int c = 0; c < problem_.channels; c++)
            for (int side = 0; side < 2; side++) {
                const auto channel = static_cast<size_t>(c), direction = static_cast<size_t>(side);
                double weight = weights[p][channel][direction];
                add_transfer(problem_.pairs[p], c, side, t.channel[channel], d, current,
                             factor[channel][direction] * weight * weight);
            }
    });
}

// Adds the prior that the correction, in grey levels, is smooth and small.
void Equations::add_smoothness() {
    auto in_levels = [&](int k) {  // grey levels of a correction of 1 at unknown k: 1 / G'
        double b = (k + 1) / 255.0, low = b - 0.5 / 255.0, high = std::min(b + 0.5 / 255.0, 1.0);
        double rise = std::log(first_.curve.invert(high, nullptr) / std::max(first_.curve.invert(low, nullptr), 1e-9));
        return 255.0 * (high - low) / std::max(rise, 1e-6);
    };
    for (int k = 0; k < kLevels; k++) {
        double end = std::min(k, kLevels - 1 - k), bend = kBend + kEndBend * std::exp(-end / kEndReach);
        const int column[3] = {level_column(k - 1), level_column(k), level_column(k + 1)};
        const double small = in_levels(k);
        rows_.add(column + 1, &small, 1, 0.0, 1.0 / (kLargestCorrection * kLargestCorrection));
        if (k == 0 || k + 1 == kLevels) continue;
        const double bent[3] = {in_levels(k - 1), -2.0 * in_levels(k), in_levels(k + 1)};
        rows_.add(column, bent, 3, 0.0, 1.0 / (bend * bend));
    }
}

// Keeps changes of the exposures orthogonal to the exposures themselves, because a parallel part would change gamma.
void Equations::hold_gamma() {
    constexpr double firmly = 1e12;
    Eigen::VectorXd along = Eigen::VectorXd::Zero(size_);
    const auto &zero = first_.log_exposure[problem_.reference];
    auto measured = static_cast<size_t>(problem_.measured_channel());
    for (uint32_t i = 0; i < problem_.image_count; i++) {
        int ev = image_column(problem_.ev_unknown[i]);
        if (ev >= 0) along[ev] = first_.log_exposure[i][measured] - zero[measured];
    }
    double length = along.norm();
    if (length > 0.0) rows_.normal += firmly * along * along.transpose() / (length * length);
    rows_.normal.diagonal().tail(problem_.image_unknowns).array() += 1e-3;
}

// The corrections and the changes of the images' unknowns.
struct Refinement {
    Correction d;
    Eigen::VectorXd changes;
};

// The first estimate after applying a refinement.
Estimate refined(const Problem &problem, const Estimate &first, const Refinement &refinement) {
    Estimate estimate = first;
    set_table(estimate, table_of(first.curve, refinement.d).data());
    for (uint32_t i = 0; i < problem.image_count; i++)
        for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++)
            for (int unknown : {problem.ev_unknown[i], problem.balance_unknown[i][c]})
                if (unknown >= 0) estimate.log_exposure[i][c] += refinement.changes[unknown];
    return estimate;
}

double cost_of(const Problem &problem, const Loss &loss, const Estimate &estimate) {
    NoiseWeights weights = noise_weights(problem, estimate, loss);
    double cost = 0.0;
    for_each_transfer(problem, estimate, [&](size_t p, const PairTransfer &t) {
        cost += pair_cost(weighted_residuals(t, problem.channels, weights[p]), problem.channels, loss, nullptr);
    });
    return cost;
}

// Tries 1, 1/2, 1/4 and 1/8 of the step to the solution of a round; false if none lowers the cost.
bool advance(const Problem &problem, const Loss &loss, const Estimate &first, const Eigen::VectorXd &found,
             Refinement &refinement, Estimate &estimate, double &cost) {
    for (double share = 1.0; share > 0.1; share *= 0.5) {
        Refinement next = refinement;
        for (int k = 0; k < kUnknown; k++)
            next.d.offset[static_cast<size_t>(k)] += share * (found[k] - refinement.d.offset[static_cast<size_t>(k)]);
        next.changes += share * (found.tail(problem.image_unknowns) - refinement.changes);
        Estimate candidate = refined(problem, first, next);
        double lower = cost_of(problem, loss, candidate);
        if (!(lower < cost)) continue;
        refinement = next, estimate = candidate, cost = lower;
        return true;
    }
    return false;
}

}  // namespace

Estimate corrected(const Problem &problem, const Estimate &first, const Eigen::VectorXd &offsets,
                   const Eigen::VectorXd &changes) {
    Refinement refinement{Correction(first.curve), changes};
    std::copy(offsets.begin(), offsets.end(), refinement.d.offset.begin());
    return refined(problem, first, refinement);
}

std::vector<double> prediction_rates(const Problem &problem, const Estimate &first, const Eigen::VectorXd &offsets,
                                     const Eigen::VectorXd &changes) {
    Eigen::VectorXd unknowns(offsets.size() + changes.size());
    unknowns << offsets, changes;
    const Correction no_correction(first.curve);
    std::vector<double> rates;
    for_each_transfer(problem, first, [&](size_t p, const PairTransfer &t) {
        const lensprof_pair &pair = problem.pairs[p];
        for (int c = 0; c < problem.channels; c++)
            for (int side = 0; side < 2; side++) {
                const Transfer &transfer = t.channel[static_cast<size_t>(c)];
                Row row = row_of(problem, pair, c, side, no_correction.place_of(pair.value[1 - side][c]),
                                 no_correction.place_of(pair.value[side][c] - transfer.residual[side]));
                double sum = 0.0;
                for (int k = 0; k < Row::kEntries; k++)
                    if (row.column[k] >= 0) sum += row.coefficient[k] * unknowns[row.column[k]];
                rates.push_back(sum * std::abs(transfer.by_delta[side]));
            }
    });
    return rates;
}

void refine_response(const Problem &problem, const Loss &loss, Estimate &estimate) {
    const Estimate first = estimate;
    Refinement refinement{Correction(first.curve), Eigen::VectorXd::Zero(problem.image_unknowns)};
    double cost = cost_of(problem, loss, first);
    for (int round = 0; round < kGaussNewtonRounds; round++) {
        Equations equations(problem, first);
        equations.add_pairs(loss, refinement.d, estimate);
        equations.add_smoothness();
        equations.hold_gamma();
        Eigen::VectorXd found = equations.solve();
        double before = cost;
        if (!found.allFinite() || !advance(problem, loss, first, found, refinement, estimate, cost)) break;
        if (before - cost < kWorthwhile) break;
    }
    if (!estimate.is_refined) set_table(estimate, first.curve.table.data());
}

}  // namespace lensprof
