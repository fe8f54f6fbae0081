#include "falloff/dense.hpp"

#include <Eigen/Cholesky>

namespace lensprof {

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd &matrix, const Eigen::VectorXd &right) {
    return matrix.ldlt().solve(right);
}

Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd &matrix) {
    return matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

Eigen::MatrixXd inverse_of_positive(const Eigen::MatrixXd &matrix) {
    return matrix.llt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

bool is_positive_definite(const Eigen::MatrixXd &matrix) { return matrix.llt().info() == Eigen::Success; }

}  // namespace lensprof
