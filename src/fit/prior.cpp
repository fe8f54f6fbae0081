#include "prior.hpp"

#include <algorithm>

#include <Eigen/LU>

namespace lensprof {

const double kEmorSigma[kMaxModes] = {3.416,  1.294,  0.469,  0.202,  0.0961, 0.0706, 0.0520, 0.0371, 0.0368,
                                      0.0303, 0.0194, 0.0143, 0.0103, 0.0085, 0.0069, 0.0055, 0.0049, 0.0049,
                                      0.0035, 0.0030, 0.0029, 0.0019, 0.0018, 0.0016, 0.0014};

namespace {

// Mean and covariance of (k1, k2, k3) over the 19,920 falloff entries of the Lensfun database.
const double kFalloffMean[3] = {-0.347, 0.139, -0.118};
const double kFalloffCovariance[3][3] = {
    {0.1298, -0.1369, 0.0682}, {-0.1369, 0.3262, -0.2656}, {0.0682, -0.2656, 0.4005}};

// The falloff's centre lies where the optical axis meets the sensor: mounting tolerances, in half diagonals.
constexpr double kCenterSigma = 0.02;

constexpr double kPairsPerPrior = 200.0;

}  // namespace

Prior make_prior(double weight, size_t pairs) {
    double response_weight = weight * std::max(1.0, static_cast<double>(pairs) / kPairsPerPrior);
    Prior prior;
    prior.mean = Eigen::VectorXd::Zero(kMaxShared);
    prior.precision = Eigen::MatrixXd::Zero(kMaxShared, kMaxShared);
    for (int l = 0; l < kMaxModes; l++) prior.precision(l, l) = response_weight / (kEmorSigma[l] * kEmorSigma[l]);
    Eigen::Matrix3d covariance;
    for (int i = 0; i < 3; i++) {
        prior.mean(kMaxModes + i) = kFalloffMean[i];
        for (int j = 0; j < 3; j++) covariance(i, j) = kFalloffCovariance[i][j];
    }
    prior.precision.block<3, 3>(kMaxModes, kMaxModes) = weight * covariance.inverse();
    for (int d = 0; d < 2; d++)
        prior.precision(kMaxModes + 3 + d, kMaxModes + 3 + d) = weight / (kCenterSigma * kCenterSigma);
    return prior;
}

}  // namespace lensprof
