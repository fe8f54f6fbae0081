#include "fit/base/inequality.hpp"

#include <algorithm>
#include <limits>
#include <new>

#include <nlopt.h>
#include <Eigen/Cholesky>

namespace lensprof {
namespace {

// One inequality  row . d >= limit  on the step.
struct Inequality {
    Eigen::VectorXd row;
    double limit;
};

// The quadratic in the unknowns y = L' d / scale. Its Hessian is the identity and its gradient at 0 has length 1, so
// that SLSQP's first model is exact and its tolerances have their nominal meaning.
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

// Adds the worst violated inequality of each contiguous run; false if no inequality is violated.
bool add_violated(const Inequalities &all, const Eigen::VectorXd &d, std::vector<bool> &in_set,
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
        auto index = static_cast<size_t>(i);
        if (gap[index] > all.tolerance(i)) {
            if (!in_set[index] && (worst < 0 || gap[index] > gap[static_cast<size_t>(worst)])) worst = i;
        } else {
            flush();
        }
    }
    flush();
    return added;
}

}  // namespace

Eigen::VectorXd constrained_step(const Inequalities &all, const Eigen::MatrixXd &S, const Eigen::VectorXd &b) {
    Eigen::LLT<Eigen::MatrixXd> factor(S);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (factor.info() != Eigen::Success) return Eigen::VectorXd::Constant(b.size(), kNone);
    Eigen::VectorXd d = factor.solve(b);
    if (!d.allFinite()) return Eigen::VectorXd::Constant(b.size(), kNone);
    if (all.is_kept(d)) return d;

    std::vector<Inequality> set;
    std::vector<bool> in_set(static_cast<size_t>(all.count()), false);
    for (int round = 0; round < 30 && add_violated(all, d, in_set, set); round++) d = solve_working_set(set, factor, b);

    // The region is convex and contains d = 0: pulls a step that rounding left outside back towards 0.
    double t = 1.0;
    for (int halving = 0; halving < 40 && !all.is_kept(t * d); halving++) t *= halving < 8 ? 0.98 : 0.7;
    return all.is_kept(t * d) ? Eigen::VectorXd(t * d) : Eigen::VectorXd(Eigen::VectorXd::Zero(b.size()));
}

}  // namespace lensprof
