// The falloff of a model as a profile holds it: k1..k3 nearest to it, which must be above 0 wherever a profile can be
// used.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "fit/flat/fit.hpp"

namespace lensprof {
namespace {

constexpr int kSamples = 96;                     // of r^2
constexpr double kDarkest[] = {0.02, 0.1, 0.5};  // of M, below which its error counts as that of this value
constexpr double kBeyond[] = {0.0, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0};  // weight where there are no data
constexpr double kSpacing = 0.06;  // of two nodes of a grid, half diagonals: M is held one beyond an edge
constexpr double kBetweenNodes[] = {0.0, 10.0, 30.0, 100.0, 300.0};  // weight of what a grid loses between its nodes,
constexpr double kLost = 0.003;                                      // until it loses no more than this of M

// k1..k3 and dk / d terms.
struct Nearest {
    Eigen::Vector3d k;
    Eigen::MatrixXd by_term;
};

// How k1..k3 are to approach M: see kDarkest, kBeyond, kBetweenNodes.
struct Wanted {
    double most_r2, darkest, beyond, between;
};

// What k1 t + k2 t^2 + k3 t^3 + 1 = M states, t = r^2: the powers of t; M - 1, and its derivatives by the terms.
struct Equation {
    Eigen::Vector3d powers;
    Eigen::RowVectorXd right;

    void add(const Equation &other, double factor) { powers += factor * other.powers, right += factor * other.right; }
};

Equation equation_at(const FlatModel &model, const Eigen::VectorXd &u, int curve, double r2, double darkest) {
    const FalloffAt at = continued_falloff(model, u, curve, r2);
    const double size = std::max(at.value, darkest);
    Equation equation{Eigen::Vector3d(r2, r2 * r2, r2 * r2 * r2) / size, Eigen::RowVectorXd(1 + model.terms())};
    equation.right[0] = (at.value - 1.0) / size;
    for (int n = 0; n < model.terms(); n++) equation.right[1 + n] = at.by_term[static_cast<size_t>(n)] / size;
    return equation;
}

// k = argmin sum w ((1 + k1 t + k2 t^2 + k3 t^3) / M - 1)^2, and the same of an eighth of its second differences over
// the spacing of a grid's nodes, which interpolation between them loses.
Nearest nearest_powers(const FlatModel &model, const Eigen::VectorXd &u, int curve, const Wanted &wanted) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3, 1 + model.terms());
    const auto add = [&](const Equation &equation, double weight) {
        normal += weight * equation.powers * equation.powers.transpose();
        right += weight * equation.powers * equation.right;
    };
    for (int i = 1; i <= kSamples; i++) {
        const double r2 = wanted.most_r2 * i / kSamples, r = std::sqrt(r2);
        add(equation_at(model, u, curve, r2, wanted.darkest), r2 <= corner_r2(model) ? 1.0 : wanted.beyond);
        if (wanted.between == 0.0 || std::pow(r + kSpacing, 2) > corner_r2(model)) continue;
        Equation lost{Eigen::Vector3d::Zero(), Eigen::RowVectorXd::Zero(1 + model.terms())};
        for (const int step : {-1, 0, 1})
            lost.add(equation_at(model, u, curve, std::pow(r + step * kSpacing, 2), 0.0), step == 0 ? -2.0 : 1.0);
        add(lost, std::pow(wanted.between / 8.0, 2));
    }
    const Eigen::MatrixXd solution = normal.ldlt().solve(right);
    return {solution.col(0), solution.rightCols(model.terms())};
}

// The largest share of M that a grid over these k1..k3 loses halfway between two nodes.
double lost_between_nodes(const FlatModel &model, const Eigen::VectorXd &u, int curve, const lensprof_vignetting &v) {
    const auto left = [&](double r) {
        return continued_falloff(model, u, curve, r * r).value / lensprof_vignetting_eval(&v, r * r, nullptr);
    };
    const double end = std::sqrt(corner_r2(model)) - kSpacing;
    double most = 0.0;
    for (int i = 1; i <= kSamples; i++) {
        const double r = end * i / kSamples, middle = left(r + 0.5 * kSpacing);
        most = std::max(most, std::abs(0.5 * (left(r) + left(r + kSpacing)) / middle - 1.0));
    }
    return most;
}

// The curve nearest to the model's that is possible; a straight line in r^2 always is. Where the falloff is so deep
// that a grid would not hold what such a curve leaves, one is taken that leaves less between the nodes.
Nearest possible_powers(const FlatModel &model, const Eigen::VectorXd &u, int curve) {
    lensprof_vignetting v = falloff_of(model, u, curve);
    const double reach = std::pow(1.0 + std::hypot(v.center[0], v.center[1]), 2);
    Nearest best{Eigen::Vector3d(-0.9 / reach, 0.0, 0.0), Eigen::MatrixXd::Zero(3, model.terms())};
    double least = INFINITY;
    const auto is_possible = [&](const Nearest &nearest) {
        std::copy_n(nearest.k.data(), 3, v.k);
        return lensprof_vignetting_validate(&v) == LENSPROF_OK;
    };
    const auto take = [&](double between) {
        for (const double darkest : kDarkest)
            for (const double beyond : kBeyond) {
                const Nearest nearest = nearest_powers(model, u, curve, {reach, darkest, beyond, between});
                if (!is_possible(nearest)) continue;
                const double lost = lost_between_nodes(model, u, curve, v);
                if (lost < least) least = lost, best = nearest;
                return;
            }
    };
    for (const double between : kBetweenNodes)
        if (least > kLost) take(between);
    return best;
}

// Largest relative error of k1..k3 within the data.
double worst_of(const FlatModel &model, const Eigen::VectorXd &u, int curve, const lensprof_vignetting &v) {
    double worst = 0.0;
    for (int i = 1; i <= kSamples; i++) {
        const double r2 = corner_r2(model) * i / kSamples;
        const double m = continued_falloff(model, u, curve, r2).value;
        worst = std::max(worst, std::abs(lensprof_vignetting_eval(&v, r2, nullptr) / m - 1.0));
    }
    return worst;
}

// From the middle of a cell to its corner, half diagonals.
double half_cell(const CellGrid &grid) {
    return 0.5 * std::hypot(grid.cell_width(), grid.cell_height()) / lensprof_half_diagonal(grid.width, grid.height);
}

}  // namespace

double data_reach(const CellGrid &grid, const FlatSolution &solution) {
    const lensprof_vignetting v = falloff_of(solution.problem.model, solution.estimate.u, 0);
    double reach = 0.0;
    for (const FlatCell &cell : solution.problem.cells)
        reach = std::max(reach, lensprof_vignetting_r2(&v, grid.width, grid.height, cell.x, cell.y, nullptr));
    return std::pow(std::sqrt(reach) + half_cell(grid), 2);
}

double corner_r2(const FlatModel &model) {
    const bool has_edge = model.held < INFINITY;
    return has_edge ? std::min(std::pow(std::sqrt(model.reach) - half_cell(model.grid), 2), 1.0) : 1.0;
}

void hold_falloff(FlatFit &fit) {
    FlatModel &model = fit.problem.model;
    HeldFalloff &held = fit.held;
    held = {};
    held.is_whole = model.form == FalloffForm::powers && fit.edge.radius == 0.0;
    if (!held.is_whole) model.reach = data_reach(fit.grid, fit);
    if (fit.edge.radius > 0.0) model.held = std::pow(std::sqrt(model.reach) + kSpacing, 2);
    Eigen::MatrixXd map = Eigen::MatrixXd::Zero(3 * model.curves + 2, model.unknowns());
    map.bottomRows(2).middleCols(model.center(), 2).setIdentity();
    for (int curve = 0; curve < model.curves; curve++) {
        lensprof_vignetting v = falloff_of(model, fit.estimate.u, curve);
        if (held.is_whole) {
            map.block<3, 3>(3 * curve, model.k(curve)).setIdentity();
        } else {
            const Nearest nearest = possible_powers(model, fit.estimate.u, curve);
            std::copy_n(nearest.k.data(), 3, v.k);
            map.block(3 * curve, model.k(curve), 3, model.terms()) = nearest.by_term;
            held.left = std::max(held.left, worst_of(model, fit.estimate.u, curve, v));
        }
        held.curve[static_cast<size_t>(curve)] = v;
    }
    if (!fit.covariance.size()) return;
    const Eigen::MatrixXd product = map * fit.covariance * map.transpose();
    held.covariance = 0.5 * (product + product.transpose());  // symmetric to the bit
}

double held_ratio(const FlatFit &fit, int channel, double x, double y) {
    if (fit.held.is_whole) return 1.0;
    const int curve = fit.problem.model.curve_of(channel);
    const lensprof_vignetting &v = fit.held.curve[static_cast<size_t>(curve)];
    const double r2 = lensprof_vignetting_r2(&v, fit.grid.width, fit.grid.height, x, y, nullptr);
    return lensprof_vignetting_eval(&v, r2, nullptr)
           / continued_falloff(fit.problem.model, fit.estimate.u, curve, r2).value;
}

}  // namespace lensprof
