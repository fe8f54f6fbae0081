#include "fit/fields/surface.hpp"

#include <algorithm>
#include <cmath>

#include <lensprof/geometry.h>
#include <lensprof/model.h>

#include "core/gain_grid.h"

namespace lensprof {
namespace {

constexpr double kRidge = 1e-12;  // pull to 0, for what neither cells nor penalty determine

using Matrix = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

Matrix matrix_of(Eigen::Index rows, Eigen::Index columns, const Entries &entries) {
    Matrix matrix(rows, columns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

// Weights with which lensprof_gain_grid_eval interpolates the nodes at the middle of each cell.
Matrix interpolation(const FieldGrid &grid, uint32_t columns, uint32_t rows) {
    Entries entries;
    for (int j = 0; j < grid.rows; j++)
        for (int i = 0; i < grid.columns; i++) {
            const double x = (i + 0.5) * grid.width / grid.columns - 0.5;
            const double y = (j + 0.5) * grid.height / grid.rows - 0.5;
            const lp_grid_cell column = lp_grid_cell_at(x, grid.width, columns);
            const lp_grid_cell row = lp_grid_cell_at(y, grid.height, rows);
            const double u = column.fraction, v = row.fraction;
            const auto first = static_cast<int>(row.node * columns + column.node),
                       below = first + static_cast<int>(columns);
            const int cell = j * grid.columns + i;
            entries.emplace_back(cell, first, (1 - u) * (1 - v));
            entries.emplace_back(cell, first + 1, u * (1 - v));
            entries.emplace_back(cell, below, (1 - u) * v);
            entries.emplace_back(cell, below + 1, u * v);
        }
    return matrix_of(static_cast<Eigen::Index>(grid.count()), columns * rows, entries);
}

// Coefficients of the difference of an order: 1; -1, 1; 1, -2, 1; ...
std::vector<double> difference(int order) {
    std::vector<double> coefficients = {1.0};
    for (int i = 0; i < order; i++) {
        std::vector<double> next(coefficients.size() + 1);
        for (size_t k = 0; k < coefficients.size(); k++) next[k] -= coefficients[k], next[k + 1] += coefficients[k];
        coefficients = next;
    }
    return coefficients;
}

double binomial(int n, int k) { return k == 0 ? 1.0 : binomial(n - 1, k - 1) * n / k; }

// The mean over the frame of  sum over i of C(order, i) (d^order s / dx^i dy^(order - i))^2,  which does not depend on
// the directions of the axes; `dx`, `dy`: distances of nodes.
Matrix penalty_of(uint32_t columns, uint32_t rows, double dx, double dy, int order) {
    const auto nodes = static_cast<Eigen::Index>(columns * rows);
    Matrix penalty(nodes, nodes);
    for (int i = 0; i <= order; i++) {
        const std::vector<double> across = difference(i), down = difference(order - i);
        const int width = static_cast<int>(columns) - i, height = static_cast<int>(rows) - (order - i);
        if (width < 1 || height < 1) continue;
        Entries entries;
        for (int row = 0; row < height; row++)
            for (int column = 0; column < width; column++)
                for (size_t b = 0; b < down.size(); b++)
                    for (size_t a = 0; a < across.size(); a++)
                        entries.emplace_back(
                            row * width + column,
                            (row + static_cast<int>(b)) * static_cast<int>(columns) + column + static_cast<int>(a),
                            across[a] * down[b]);
        const Matrix differences = matrix_of(width * height, nodes, entries);
        const double scale =
            binomial(order, i) / (width * height) / std::pow(dx, 2 * i) / std::pow(dy, 2 * (order - i));
        penalty += scale * Matrix(differences.transpose() * differences);
    }
    return penalty;
}

}  // namespace

Surface::Surface(const FieldGrid &grid, int most_nodes) : grid_(grid) {
    const double longer = std::max(grid.columns, grid.rows);
    const auto side = [&](int cells) {
        return static_cast<uint32_t>(
            std::clamp(std::lround(most_nodes * cells / longer), 4L, long(LENSPROF_GRID_SIDE)));
    };
    columns_ = side(grid.columns), rows_ = side(grid.rows);
    cells_ = interpolation(grid, columns_, rows_);
    const double half = lensprof_half_diagonal(grid.width, grid.height);
    for (size_t i = 0; i < 2; i++)
        penalty_[i] = penalty_of(columns_, rows_, grid.width / half / (columns_ - 1.0),
                                 grid.height / half / (rows_ - 1.0), kSmoothOrders[i]);
}

std::unique_ptr<Surface::Solver> Surface::solver(const std::vector<double> &weight,
                                                 const Smoothness &smoothness) const {
    auto made = std::make_unique<Solver>();
    const Eigen::Map<const Eigen::VectorXd> given(weight.data(), static_cast<Eigen::Index>(weight.size()));
    const double total = given.sum();
    if (!(total > 0.0)) return made;
    made->share_ = given / total, made->cells_ = &cells_;
    Matrix identity(cells_.cols(), cells_.cols());
    identity.setIdentity();
    const Matrix normal = Matrix(cells_.transpose() * made->share_.asDiagonal() * cells_)
                          + smoothness.weight * penalty_[smoothness.order - kSmoothOrders[0]] + kRidge * identity;
    made->factor_.compute(normal);
    made->is_good_ = made->factor_.info() == Eigen::Success;
    return made;
}

bool Surface::Solver::solve(const std::vector<double> &value, std::vector<double> &nodes) const {
    if (!is_good_) return false;
    const Eigen::Map<const Eigen::VectorXd> target(value.data(), static_cast<Eigen::Index>(value.size()));
    const Eigen::VectorXd solution = factor_.solve(cells_->transpose() * share_.cwiseProduct(target));
    nodes.assign(solution.data(), solution.data() + solution.size());
    return solution.allFinite();
}

bool Surface::fit(const std::vector<double> &weight, const std::vector<double> &value, const Smoothness &smoothness,
                  std::vector<double> &nodes) const {
    return solver(weight, smoothness)->solve(value, nodes);
}

std::vector<double> Surface::at_cells(const std::vector<double> &nodes) const {
    const Eigen::Map<const Eigen::VectorXd> given(nodes.data(), static_cast<Eigen::Index>(nodes.size()));
    const Eigen::VectorXd values = cells_ * given;
    return {values.data(), values.data() + values.size()};
}

}  // namespace lensprof
