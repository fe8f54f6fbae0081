#include "refine.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/response.h"
#include "residual.hpp"

namespace lensprof {
namespace {

constexpr int kLevels = 255;         // unknown k - 1: the correction at grey level k of 255; the last is 0
constexpr int kUnknown = kCorrections;
constexpr int kRounds = 8;           // Gauss-Newton,
constexpr double kWorthwhile = 1.0;  // as long as a round lowers the cost by more
constexpr double kBend = 0.002;       // levels: expected second difference of the correction from level to level,
constexpr double kEndBend = 1.0;     // and at the ends, where responses are steep,
constexpr double kEndReach = 6.0;    // levels from there
constexpr double kLargestCorrection = 8.0;  // levels, one standard deviation: holds what no pair tells
constexpr int kFine = 16;            // samples of the inverse between two levels

// Levels of 255 about a grey value: the lower one's unknown and the share of the upper one.
struct Place {
    int low;
    double share;
};

// D at every level. f is straight up to its first sample of irradiance, so that up to the grey value there, and up to
// level 1, D is one number.
struct Correction {
    double first;  // that grey value, levels
    std::array<double, kLevels> at{};

    explicit Correction(const Curve &base) : first(std::clamp(255.0 * base.table[1], 1.0, 254.0)) {}

    Place place_of(double b) const {
        double level = std::clamp(b * 255.0, first, 255.0) - 1.0;
        int low = std::min(static_cast<int>(level), kLevels - 2);
        return {low, level - low};
    }
    double value(double b) const {
        Place p = place_of(b);
        auto low = static_cast<size_t>(p.low);
        return (1.0 - p.share) * at[low] + p.share * at[low + 1];
    }
};

// f at the 1024 samples of irradiance from g = exp(G0 + D).
std::array<double, LENSPROF_RESPONSE_SAMPLES> table_of(const Curve &base, const Correction &d) {
    constexpr int count = 255 * kFine;
    std::vector<double> x(count + 1, 0.0);
    for (size_t i = 1; i < x.size(); i++) {
        double b = static_cast<double>(i) / count;
        x[i] = std::max(x[i - 1], base.invert(b, nullptr) * std::exp(d.value(b)));
    }
    std::array<double, LENSPROF_RESPONSE_SAMPLES> f{};
    for (size_t j = 1, i = 0; j < LP_CURVE_LAST; j++) {
        double at = x.back() * static_cast<double>(j) / LP_CURVE_LAST;
        while (x[i + 1] < at) i++;
        f[j] = (static_cast<double>(i) + (at - x[i]) / (x[i + 1] - x[i])) / count;
    }
    f.back() = 1.0;
    return f;
}

// Columns of the unknowns: corrections, then those of the images; -1 is fixed at 0.
int level_column(int level) { return level < kUnknown ? level : -1; }
int image_column(int unknown) { return unknown < 0 ? -1 : kUnknown + unknown; }

// D(B) - D(P) + d ln t as a sum over unknowns.
struct Row {
    static constexpr int kEntries = 8;
    int column[kEntries];
    double by[kEntries];
};

Row row_of(const Problem &problem, const lensprof_pair &pair, int c, int side, Place b, Place p) {
    uint32_t i = pair.image[side], j = pair.image[1 - side];
    const auto channel = static_cast<size_t>(c);
    return {{level_column(b.low), level_column(b.low + 1), level_column(p.low), level_column(p.low + 1),
             image_column(problem.ev_unknown[i]), image_column(problem.balance_unknown[i][channel]),
             image_column(problem.ev_unknown[j]), image_column(problem.balance_unknown[j][channel])},
            {1.0 - b.share, b.share, p.share - 1.0, -p.share, 1.0, 1.0, -1.0, -1.0}};
}

// The linear problem of one round: unknowns are the corrections and the changes of the images' log exposures, both from
// where the refinement began.
class Equations {
public:
    Equations(const Problem &problem, const Estimate &first)
        : problem_(problem), first_(first), size_(kUnknown + problem.image_unknowns),
          normal_(Eigen::MatrixXd::Zero(size_, size_)), right_(Eigen::VectorXd::Zero(size_)) {}

    void add_pairs(const Loss &loss, const Correction &d, const Estimate &now);
    void add_smoothness();
    void hold_gamma();
    Eigen::VectorXd solve() const { return normal_.ldlt().solve(right_); }

private:
    void add_transfer(const lensprof_pair &pair, int c, int side, const Transfer &t, const Correction &d,
                      const Estimate &now, double weight);

    // value = sum of coefficients times unknowns; those with column -1 are fixed at 0.
    void add_row(const int *column, const double *coefficient, int count, double value, double weight) {
        for (int i = 0; i < count; i++) {
            if (column[i] < 0) continue;
            right_[column[i]] += weight * coefficient[i] * value;
            for (int j = 0; j < count; j++)
                if (column[j] >= 0) normal_(column[i], column[j]) += weight * coefficient[i] * coefficient[j];
        }
    }

    const Problem &problem_;
    const Estimate &first_;
    Eigen::Index size_;
    Eigen::MatrixXd normal_;
    Eigen::VectorXd right_;
};

// A prediction P = f( g(B) t ) solves  G(P) + D(P) = G(B) + D(B) + ln t, so that
//     dP = (D(B) - D(P) + d ln t) dP/d ln t.
void Equations::add_transfer(const lensprof_pair &pair, int c, int side, const Transfer &t, const Correction &d,
                             const Estimate &now, double weight) {
    const auto channel = static_cast<size_t>(c);
    const double from = pair.value[1 - side][c], to = pair.value[side][c] - t.residual[side];
    const double slope = std::abs(t.by_delta[side]);
    if (slope == 0.0) return;  // saturated prediction
    uint32_t i = pair.image[side], j = pair.image[1 - side];
    Row row = row_of(problem_, pair, c, side, d.place_of(from), d.place_of(to));
    double done = d.value(from) - d.value(to) + now.log_exposure[i][channel]
                  - first_.log_exposure[i][channel] - now.log_exposure[j][channel] + first_.log_exposure[j][channel];
    add_row(row.column, row.by, Row::kEntries, t.residual[side] / slope + done, weight * slope * slope);
}

void Equations::add_pairs(const Loss &loss, const Correction &d, const Estimate &now) {
    NoiseWeights weights = noise_weights(problem_, now, loss);
    for_each_transfer(problem_, now, [&](size_t p, const PairTransfer &t) {
        PairResiduals factor, residuals = weighted_residuals(t, problem_.channels, weights[p]);
        pair_cost(residuals, problem_.channels, loss, &factor);
        for (int c = 0; c < problem_.channels; c++)
            for (int side = 0; side < 2; side++) {
                const auto channel = static_cast<size_t>(c), direction = static_cast<size_t>(side);
                double weight = weights[p][channel][direction];
                add_transfer(problem_.pairs[p], c, side, t.channel[channel], d, now,
                             factor[channel][direction] * weight * weight);
            }
    });
}

// The correction, in grey levels, is smooth and small.
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
        add_row(column + 1, &small, 1, 0.0, 1.0 / (kLargestCorrection * kLargestCorrection));
        if (k == 0 || k + 1 == kLevels) continue;
        const double bent[3] = {in_levels(k - 1), -2.0 * in_levels(k), in_levels(k + 1)};
        add_row(column, bent, 3, 0.0, 1.0 / (bend * bend));
    }
}

// Changes of the exposures have no part along the exposures themselves: that part would be a change of gamma.
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
    if (length > 0.0) normal_ += firmly * along * along.transpose() / (length * length);
    normal_.diagonal().tail(problem_.image_unknowns).array() += 1e-3;
}

// The corrections and the changes of the images' unknowns.
struct Refinement {
    Correction d;
    Eigen::VectorXd changes;
};

// The estimate that a refinement makes of the first one.
Estimate refined(const Problem &problem, const Estimate &first, const Refinement &by) {
    Estimate estimate = first;
    set_table(estimate, table_of(first.curve, by.d).data());
    for (uint32_t i = 0; i < problem.image_count; i++)
        for (size_t c = 0; c < static_cast<size_t>(problem.channels); c++)
            for (int unknown : {problem.ev_unknown[i], problem.balance_unknown[i][c]})
                if (unknown >= 0) estimate.log_exposure[i][c] += by.changes[unknown];
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

// The share of the way to the solution of a round, of 1, 1/2, 1/4 and 1/8, that lowers the cost; false for none.
bool advance(const Problem &problem, const Loss &loss, const Estimate &first, const Eigen::VectorXd &found,
             Refinement &by, Estimate &estimate, double &cost) {
    for (double share = 1.0; share > 0.1; share *= 0.5) {
        Refinement next = by;
        for (int k = 0; k < kUnknown; k++)
            next.d.at[static_cast<size_t>(k)] += share * (found[k] - by.d.at[static_cast<size_t>(k)]);
        next.changes += share * (found.tail(problem.image_unknowns) - by.changes);
        Estimate candidate = refined(problem, first, next);
        double lower = cost_of(problem, loss, candidate);
        if (!(lower < cost)) continue;
        by = next, estimate = candidate, cost = lower;
        return true;
    }
    return false;
}

}  // namespace

Estimate corrected(const Problem &problem, const Estimate &first, const Eigen::VectorXd &by,
                   const Eigen::VectorXd &changes) {
    Refinement refinement{Correction(first.curve), changes};
    std::copy(by.begin(), by.end(), refinement.d.at.begin());
    return refined(problem, first, refinement);
}

std::vector<double> prediction_rates(const Problem &problem, const Estimate &first, const Eigen::VectorXd &by,
                                     const Eigen::VectorXd &changes) {
    Eigen::VectorXd unknowns(by.size() + changes.size());
    unknowns << by, changes;
    const Correction none(first.curve);
    std::vector<double> rates;
    for_each_transfer(problem, first, [&](size_t p, const PairTransfer &t) {
        const lensprof_pair &pair = problem.pairs[p];
        for (int c = 0; c < problem.channels; c++)
            for (int side = 0; side < 2; side++) {
                const Transfer &one = t.channel[static_cast<size_t>(c)];
                Row row = row_of(problem, pair, c, side, none.place_of(pair.value[1 - side][c]),
                                 none.place_of(pair.value[side][c] - one.residual[side]));
                double sum = 0.0;
                for (int k = 0; k < Row::kEntries; k++)
                    if (row.column[k] >= 0) sum += row.by[k] * unknowns[row.column[k]];
                rates.push_back(sum * std::abs(one.by_delta[side]));
            }
    });
    return rates;
}

void refine_response(const Problem &problem, const Loss &loss, Estimate &estimate) {
    const Estimate first = estimate;
    Refinement by{Correction(first.curve), Eigen::VectorXd::Zero(problem.image_unknowns)};
    double cost = cost_of(problem, loss, first);
    for (int round = 0; round < kRounds; round++) {
        Equations equations(problem, first);
        equations.add_pairs(loss, by.d, estimate);
        equations.add_smoothness();
        equations.hold_gamma();
        Eigen::VectorXd found = equations.solve();
        double before = cost;
        if (!found.allFinite() || !advance(problem, loss, first, found, by, estimate, cost)) break;
        if (before - cost < kWorthwhile) break;
    }
    if (!estimate.is_refined) set_table(estimate, first.curve.table.data());
}

}  // namespace lensprof
