#include "monotone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <nlopt.h>

#include "core/response.h"

namespace lensprof {
namespace {

constexpr int kGrid = LENSPROF_RESPONSE_SAMPLES;
constexpr int kRises = kGrid - 1;
constexpr int kRadii = 33;             // samples of r^2 at which M is held positive
constexpr double kSmallestM = 0.01;
constexpr double kReach2 = 1.8 * 1.8;  // (1 + largest |centre|)^2 that the bound below leaves
constexpr double kLargestCenter = 0.5;

// One inequality  row . d >= limit  on the step.
struct Inequality {
    Eigen::VectorXd row;
    double limit;
};

// The r^2 up to which M must be positive for a centre: the farthest corner, with a margin for the centre's own step.
double reach2(const Eigen::VectorXd &value) {
    double reach = 1.0 + std::hypot(value[kCenter], value[kCenter + 1]) + 0.02;
    return std::min(reach * reach, kReach2);
}

// In this order: rises of f, values of each M, bounds of the centre.
struct Constraints {
    const Region &region;
    double limit2;

    explicit Constraints(const Region &r) : region(r), limit2(reach2(r.value)) {}

    int first_center() const { return kRises + kRadii * region.vignettings; }
    int count() const { return first_center() + 4; }

    // What every inequality lacks (> 0: violated) after a step.
    std::vector<double> gaps(const Eigen::VectorXd &d) const {
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

    // Row i by the free unknowns; zero where none is involved.
    Eigen::VectorXd row(int i) const {
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
    double radius2(int i) const { return limit2 * ((i - kRises) % kRadii + 1) / kRadii; }

    // Rise of mode `l` between samples j and j + 1. The ends of f stay at 0 and 1 exactly (see lp_emor_curve).
    static double rise_of_mode(int l, int j) {
        const double *h = lensprof_emor_table(static_cast<uint32_t>(l) + 1);
        return (j + 1 == kGrid - 1 ? 0.0 : h[j + 1]) - (j == 0 ? 0.0 : h[j]);
    }
};

// The quadratic in the unknowns y = L' d / scale, where its Hessian is the identity and its gradient at 0 has length 1:
// SLSQP's first model is then exact, and its tolerances mean what they say.
struct Quadratic {
    Eigen::VectorXd b;
};

double quadratic_cost(unsigned n, const double *y, double *gradient, void *data) {
    const auto &q = *static_cast<const Quadratic *>(data);
    Eigen::Map<const Eigen::VectorXd> v(y, n);
    if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, n) = v - q.b;
    return 0.5 * v.squaredNorm() - q.b.dot(v);
}

struct Rows {
    Eigen::MatrixXd a;
    Eigen::VectorXd limit;
};

void inequality_values(unsigned m, double *result, unsigned n, const double *y, double *gradient, void *data) {
    const auto &rows = *static_cast<const Rows *>(data);
    Eigen::Map<const Eigen::VectorXd> v(y, n);
    Eigen::Map<Eigen::VectorXd>(result, m) = rows.limit - rows.a * v;
    if (!gradient) return;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(gradient, m, n) = -rows.a;
}

// SLSQP on the working set, in whitened unknowns and rows of unit length.
Eigen::VectorXd solve_working_set(const std::vector<Inequality> &set, const Eigen::LLT<Eigen::MatrixXd> &factor,
                                  const Eigen::VectorXd &b) {
    auto n = static_cast<unsigned>(b.size());
    Quadratic quadratic{factor.matrixL().solve(b)};
    double scale = std::max(quadratic.b.norm(), 1e-300);
    quadratic.b /= scale;
    Rows rows{Eigen::MatrixXd(set.size(), n), Eigen::VectorXd(set.size())};
    for (size_t i = 0; i < set.size(); i++) {
        auto r = static_cast<Eigen::Index>(i);
        Eigen::VectorXd whitened = factor.matrixL().solve(set[i].row);
        double length = std::max(whitened.norm(), 1e-300);
        rows.a.row(r) = whitened.transpose() / length;
        rows.limit[r] = set[i].limit / (length * scale);
    }
    std::vector<double> y(n, 0.0), tolerance(set.size(), 1e-12);
    nlopt_opt optimizer = nlopt_create(NLOPT_LD_SLSQP, n);
    nlopt_set_min_objective(optimizer, quadratic_cost, &quadratic);
    nlopt_add_inequality_mconstraint(optimizer, static_cast<unsigned>(set.size()), inequality_values, &rows,
                                     tolerance.data());
    nlopt_set_xtol_rel(optimizer, 1e-12);
    nlopt_set_maxeval(optimizer, 60);
    double cost;
    nlopt_result code = nlopt_optimize(optimizer, y.data(), &cost);
    nlopt_destroy(optimizer);
    Eigen::Map<const Eigen::VectorXd> solution(y.data(), n);
    if (code == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
    // NLOPT_ROUNDOFF_LIMITED leaves the best point found; anything unusable is caught by the feasibility search.
    if (!solution.allFinite()) return Eigen::VectorXd::Zero(n);
    return factor.matrixL().transpose().solve(Eigen::VectorXd(scale * solution));
}

// Adds the worst violated inequality of each contiguous run; false when there is none.
bool add_violated(const Constraints &all, const Eigen::VectorXd &d, std::vector<bool> &in_set,
                  std::vector<Inequality> &set) {
    std::vector<double> gap = all.gaps(d);
    int worst = -1;
    bool added = false;
    auto flush = [&] {
        Eigen::VectorXd row;
        if (worst >= 0 && !(row = all.row(worst)).isZero(0.0)) {
            in_set[static_cast<size_t>(worst)] = added = true;
            double limit = gap[static_cast<size_t>(worst)] + row.dot(d);
            set.push_back({std::move(row), limit});
        }
        worst = -1;
    };
    for (int i = 0; i < all.count(); i++) {
        auto at = static_cast<size_t>(i);
        if (gap[at] > (i < kRises ? 0.25 * kSmallestRise : 1e-6)) {
            if (!in_set[at] && (worst < 0 || gap[at] > gap[static_cast<size_t>(worst)])) worst = i;
        } else {
            flush();
        }
    }
    flush();
    return added;
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

bool step_is_feasible(const Region &region, const Eigen::VectorXd &d, double t) {
    Eigen::VectorXd value = region.value;
    for (size_t u = 0; u < region.columns.size(); u++) value[region.columns[u]] += t * d[static_cast<Eigen::Index>(u)];
    for (int c = 0; c < region.vignettings; c++)
        if (!is_positive(value.data() + kFalloff + 3 * c, value.data() + kCenter)) return false;
    return region.modes < 0 || is_rising(value.data(), region.modes);
}

}  // namespace

bool is_feasible(const Estimate &estimate, int vignettings) {
    for (int c = 0; c < vignettings; c++)
        if (!is_positive(estimate.vignetting[static_cast<size_t>(c)].k, estimate.vignetting[0].center)) return false;
    return estimate.modes < 0 || is_rising(estimate.emor.data(), estimate.modes);
}

Eigen::VectorXd constrained_step(const Region &region, const Eigen::MatrixXd &S, const Eigen::VectorXd &b) {
    Eigen::LLT<Eigen::MatrixXd> factor(S);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (factor.info() != Eigen::Success) return Eigen::VectorXd::Constant(b.size(), kNone);
    Eigen::VectorXd d = factor.solve(b);
    if (!d.allFinite()) return Eigen::VectorXd::Constant(b.size(), kNone);
    if (step_is_feasible(region, d, 1.0)) return d;

    Constraints all(region);
    std::vector<Inequality> set;
    std::vector<bool> in_set(static_cast<size_t>(all.count()), false);
    for (int round = 0; round < 30 && add_violated(all, d, in_set, set); round++) d = solve_working_set(set, factor, b);

    // The region is convex and holds d = 0: what rounding left outside is pulled back along the step.
    double t = 1.0;
    for (int halving = 0; halving < 40 && !step_is_feasible(region, d, t); halving++) t *= halving < 8 ? 0.98 : 0.7;
    return step_is_feasible(region, d, t) ? Eigen::VectorXd(t * d) : Eigen::VectorXd(Eigen::VectorXd::Zero(b.size()));
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
