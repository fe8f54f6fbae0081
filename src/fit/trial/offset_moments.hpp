// Least squares problems whose differences share offsets, without some of the differences: delete-a-group jackknife.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include <Eigen/Core>

namespace lensprof {

// Weighted sums over differences with a common offset.
class OffsetMoments {
public:
    explicit OffsetMoments(Eigen::Index unknowns)
        : rows_(Eigen::VectorXd::Zero(unknowns)),
          products_(Eigen::VectorXd::Zero(unknowns)),
          squares_(Eigen::MatrixXd::Zero(unknowns, unknowns)) {}

    // row: derivatives by the unknowns; residual: of the solution
    void add(double weight, const Eigen::VectorXd &row, double residual);
    void add(const OffsetMoments &other, double sign);
    // Adds the normal equations, from which the offset is eliminated.
    void reduce(double sign, Eigen::MatrixXd &normal, Eigen::VectorXd &right) const;
    double weight() const { return weight_; }

private:
    double weight_ = 0.0, sum_ = 0.0;
    Eigen::VectorXd rows_, products_;
    Eigen::MatrixXd squares_;
};

// Differences with common errors, by offset. A difference may be in several groups.
using JackknifeGroup = std::map<size_t, OffsetMoments>;

// Covariance of the unknowns by their changes without each of the groups, with the weights held. normal: all normal
// equations with their prior; all: moments per offset. A group of all differences, without which nothing is left, does
// not count.
Eigen::MatrixXd jackknife(const Eigen::MatrixXd &normal, const std::vector<OffsetMoments> &all,
                          const std::vector<JackknifeGroup> &groups);

}  // namespace lensprof
