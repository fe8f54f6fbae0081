#include "fit/trial/offset_moments.hpp"

#include <Eigen/Cholesky>

namespace lensprof {
namespace {

constexpr double kLeastRest = 1e-9;  // of the weight of an offset: rounding errors of a group with all of it

}  // namespace

void OffsetMoments::add(double weight, const Eigen::VectorXd &row, double residual) {
    weight_ += weight, sum_ += weight * residual;
    rows_ += weight * row, products_ += weight * residual * row, squares_ += weight * row * row.transpose();
}

void OffsetMoments::add(const OffsetMoments &other, double sign) {
    weight_ += sign * other.weight_, sum_ += sign * other.sum_;
    rows_ += sign * other.rows_, products_ += sign * other.products_, squares_ += sign * other.squares_;
}

void OffsetMoments::reduce(double sign, Eigen::MatrixXd &normal, Eigen::VectorXd &right) const {
    if (!(weight_ > 0.0)) return;
    normal += sign * (squares_ - rows_ * rows_.transpose() / weight_);
    right += sign * (products_ - rows_ * (sum_ / weight_));
}

Eigen::MatrixXd jackknife(const Eigen::MatrixXd &normal, const std::vector<OffsetMoments> &all,
                          const std::vector<JackknifeGroup> &groups) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(normal.rows(), normal.cols());
    double count = 0.0;
    for (const JackknifeGroup &group : groups) {
        Eigen::MatrixXd without = normal;
        Eigen::VectorXd right = Eigen::VectorXd::Zero(normal.rows());
        size_t lost = 0;  // offsets
        for (const auto &[offset, moments] : group) {
            OffsetMoments rest = all[offset];
            rest.reduce(-1.0, without, right);
            rest.add(moments, -1.0);
            if (rest.weight() > kLeastRest * all[offset].weight())
                rest.reduce(1.0, without, right);
            else
                lost++;
        }
        if (group.empty() || lost == all.size()) continue;
        count++;
        const Eigen::VectorXd change = without.ldlt().solve(right);
        sum += change * change.transpose();
    }
    return count > 0.0 ? Eigen::MatrixXd(sum * ((count - 1.0) / count)) : sum;
}

}  // namespace lensprof
