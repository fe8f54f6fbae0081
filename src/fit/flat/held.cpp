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

// k = argmin sum_i w_i ((1 + k1 t_i + k2 t_i^2 + k3 t_i^3) / M(t_i) - 1)^2, t = r^2, and dk / d terms.
struct Nearest {
    Eigen::Vector3d k;
    Eigen::MatrixXd by_term;
};

Nearest nearest_powers(const FlatModel &model, const Eigen::VectorXd &u, int curve, double most_r2, double darkest,
                       double beyond) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3, 1 + model.terms());
    for (int i = 1; i <= kSamples; i++) {
        const double r2 = most_r2 * i / kSamples;
        const FalloffAt at = continued_falloff(model, u, curve, r2);
        const double size = std::max(at.value, darkest);
        const double weight = (r2 <= corner_r2(model) ? 1.0 : beyond) / (size * size);
        const Eigen::Vector3d powers(r2, r2 * r2, r2 * r2 * r2);
        normal += weight * powers * powers.transpose();
        right.col(0) += weight * (at.value - 1.0) * powers;
        for (int n = 0; n < model.terms(); n++)
            right.col(1 + n) += weight * at.by_term[static_cast<size_t>(n)] * powers;
    }
    const Eigen::MatrixXd solution = normal.ldlt().solve(right);
    return {solution.col(0), solution.rightCols(model.terms())};
}

// The curve nearest to the model's that is possible; a straight line in r^2 always is.
Nearest possible_powers(const FlatModel &model, const Eigen::VectorXd &u, int curve) {
    lensprof_vignetting v = falloff_of(model, u, curve);
    const double reach = std::pow(1.0 + std::hypot(v.center[0], v.center[1]), 2);
    for (const double darkest : kDarkest)
        for (const double beyond : kBeyond) {
            Nearest nearest = nearest_powers(model, u, curve, reach, darkest, beyond);
            std::copy_n(nearest.k.data(), 3, v.k);
            if (lensprof_vignetting_validate(&v) == LENSPROF_OK) return nearest;
        }
    return {Eigen::Vector3d(-0.9 / reach, 0.0, 0.0), Eigen::MatrixXd::Zero(3, model.terms())};
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

}  // namespace

double data_reach(const CellGrid &grid, const FlatSolution &solution) {
    const lensprof_vignetting v = falloff_of(solution.problem.model, solution.estimate.u, 0);
    const double half = lensprof_half_diagonal(grid.width, grid.height);
    double reach = 0.0;
    for (const FlatCell &cell : solution.problem.cells)
        reach = std::max(reach, lensprof_vignetting_r2(&v, grid.width, grid.height, cell.x, cell.y, nullptr));
    return std::pow(std::sqrt(reach) + 0.5 * std::hypot(grid.cell_width(), grid.cell_height()) / half, 2);
}

double corner_r2(const FlatModel &model) { return model.held < INFINITY ? std::min(model.reach, 1.0) : 1.0; }

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
