// A smooth surface over the frame: bilinear between nodes, fitted to the cells by penalised least squares.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/SparseCholesky>

#include <lensprof/model.h>

#include "fit/fields/cells.hpp"

namespace lensprof {

// How a surface is kept smooth: the integral of its squared derivatives of an order over the frame, in half diagonals,
// times a weight. Relative to the mean squared distance from the cells, weighted.
struct Smoothness {
    int order = 3;  // 2: planes are free; 3: paraboloids are
    double weight = 1e-6;
};

constexpr int kSmoothOrders[] = {2, 3};
constexpr int kSmoothWeights = 12;  // per order
inline double smooth_weight(int i) {
    double weight = 1e-11;
    for (; i > 0; i--) weight *= 10.0;
    return weight;
}

class Surface {
public:
    // With so many nodes along the longer side.
    explicit Surface(const FieldGrid &grid, int nodes = LENSPROF_GRID_SIDE);

    using Matrix = Eigen::SparseMatrix<double>;

    // The surfaces nearest to any values of the cells, with these weights.
    class Solver {
    public:
        bool is_good() const { return is_good_; }  // the cells determine a surface
        // The nodes; false if they are not finite.
        bool solve(const std::vector<double> &value, std::vector<double> &nodes) const;

    private:
        friend class Surface;
        bool is_good_ = false;
        Eigen::VectorXd share_;
        const Matrix *cells_ = nullptr;
        Eigen::SimplicialLDLT<Matrix> factor_;
    };
    std::unique_ptr<Solver> solver(const std::vector<double> &weight, const Smoothness &smoothness) const;

    // The nodes of the surface nearest to the values of the cells; false if the cells do not determine it.
    bool fit(const std::vector<double> &weight, const std::vector<double> &value, const Smoothness &smoothness,
             std::vector<double> &nodes) const;

    // The surface at the cells.
    std::vector<double> at_cells(const std::vector<double> &nodes) const;

    const FieldGrid &grid() const { return grid_; }
    uint32_t columns() const { return columns_; }
    uint32_t rows() const { return rows_; }

private:
    FieldGrid grid_;
    uint32_t columns_ = 0, rows_ = 0;
    Matrix cells_;       // from nodes to cells
    Matrix penalty_[2];  // of each of kSmoothOrders
};

}  // namespace lensprof
