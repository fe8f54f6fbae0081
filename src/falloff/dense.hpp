// Dense symmetric matrices. Eigen's decompositions take the compiler seconds per source, so they are compiled once,
// here.
#pragma once

#include <Eigen/Core>

namespace lensprof {

// By LDL' with pivoting.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd &matrix, const Eigen::VectorXd &right);
Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd &matrix);

// By LL'; `matrix` must be positive definite.
Eigen::MatrixXd inverse_of_positive(const Eigen::MatrixXd &matrix);

// Whether all eigenvalues are above 0, that is, whether the matrix has a Cholesky factor.
bool is_positive_definite(const Eigen::MatrixXd &matrix);

}  // namespace lensprof
