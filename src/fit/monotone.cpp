#include "monotone.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <nlopt.h>

#include "core/response.h"

namespace lensprof {
namespace {

constexpr int kGrid = LENSPROF_RESPONSE_SAMPLES;
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
    double reach = 1.0 + std::hypot(value[kMaxModes + 3], value[kMaxModes + 4]) + 0.02;
    return std::min(reach * reach, kReach2);
}

struct Constraints {
    const Region &region;
    std::vector<double> curve;  // f at the start of the step
    double limit2;

    explicit Constraints(const Region &r) : region(r), curve(kGrid), limit2(reach2(r.value)) {
        lp_emor_curve(r.value.data(), static_cast<uint32_t>(std::max(r.modes, 0)), curve.data());
    }

    int count() const { return (kGrid - 1) + kRadii + 4; }

    // Rise of mode `l` between samples j and j + 1. The ends of f stay at 0 and 1 exactly (see lp_emor_curve).
    static double rise_of_mode(int l, int j) {
        const double *h = lensprof_emor_table(static_cast<uint32_t>(l) + 1);
        return (j + 1 == kGrid - 1 ? 0.0 : h[j + 1]) - (j == 0 ? 0.0 : h[j]);
    }

    // Row i: rises of f, then values of M, then bounds of the centre. False where no free unknown is involved.
    bool make(int i, Inequality &out) const {
        size_t n = region.columns.size();
        out.row = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
        bool used = false;
        for (size_t u = 0; u < n; u++) {
            int column = region.columns[u];
            double entry = 0.0;
            if (i < kGrid - 1) {
                if (column < kMaxModes) entry = rise_of_mode(column, i);
            } else if (i < kGrid - 1 + kRadii) {
                double s = limit2 * (i - (kGrid - 1) + 1) / kRadii;
                if (column >= kMaxModes && column < kMaxModes + 3) entry = std::pow(s, column - kMaxModes + 1);
            } else {
                int b = i - (kGrid - 1 + kRadii);
                if (column == kMaxModes + 3 + b / 2) entry = b % 2 ? -1.0 : 1.0;
            }
            out.row[static_cast<Eigen::Index>(u)] = entry;
            used = used || entry != 0.0;
        }
        out.limit = limit(i);
        return used;
    }

    double limit(int i) const {
        const double *k = region.value.data() + kMaxModes;
        if (i < kGrid - 1) return kSmallestRise - (curve[i + 1] - curve[i]);
        if (i < kGrid - 1 + kRadii) {
            double s = limit2 * (i - (kGrid - 1) + 1) / kRadii;
            return kSmallestM - (1.0 + s * (k[0] + s * (k[1] + s * k[2])));
        }
        int b = i - (kGrid - 1 + kRadii);
        double center = k[3 + b / 2];
        return -kLargestCenter - (b % 2 ? -center : center);
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
    int worst = -1;
    double worst_gap = 0.0;
    bool added = false;
    auto flush = [&] {
        Inequality inequality;
        if (worst >= 0 && !in_set[worst] && all.make(worst, inequality)) {
            in_set[worst] = added = true;
            set.push_back(std::move(inequality));
        }
        worst = -1;
        worst_gap = 0.0;
    };
    Inequality inequality;
    for (int i = 0; i < all.count(); i++) {
        double gap = all.make(i, inequality) ? inequality.limit - inequality.row.dot(d) : -1.0;
        double tolerance = i < kGrid - 1 ? 0.25 * kSmallestRise : 1e-6;
        if (gap > tolerance) {
            if (gap > worst_gap && !in_set[i]) worst = i, worst_gap = gap;
        } else {
            flush();
        }
    }
    flush();
    return added;
}

bool step_is_feasible(const Region &region, const Eigen::VectorXd &d, double t) {
    Eigen::VectorXd value = region.value;
    for (size_t u = 0; u < region.columns.size(); u++) value[region.columns[u]] += t * d[static_cast<Eigen::Index>(u)];
    lensprof_vignetting v;
    std::copy(value.data() + kMaxModes, value.data() + kMaxModes + 3, v.k);
    std::copy(value.data() + kMaxModes + 3, value.data() + kMaxModes + 5, v.center);
    return is_feasible(value.data(), region.modes, v);
}

}  // namespace

bool is_feasible(const double *emor, int modes, const lensprof_vignetting &vignetting) {
    if (lensprof_vignetting_validate(&vignetting) != LENSPROF_OK) return false;
    if (std::abs(vignetting.center[0]) > kLargestCenter || std::abs(vignetting.center[1]) > kLargestCenter)
        return false;
    if (modes < 0) return true;
    double table[kGrid];
    lp_emor_curve(emor, static_cast<uint32_t>(modes), table);
    for (int j = 0; j + 1 < kGrid; j++)
        if (!(table[j + 1] - table[j] >= 0.5 * kSmallestRise)) return false;
    return true;
}

Eigen::VectorXd constrained_step(const Region &region, const Eigen::MatrixXd &S, const Eigen::VectorXd &b) {
    Eigen::LLT<Eigen::MatrixXd> factor(S);
    if (factor.info() != Eigen::Success) return Eigen::VectorXd::Zero(b.size());
    Eigen::VectorXd d = factor.solve(b);
    if (!d.allFinite()) return Eigen::VectorXd::Zero(b.size());
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
    Region region{modes, {}, Eigen::VectorXd::Zero(kMaxShared)};
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
