#include "fit/trial/response_error.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/response.h"

namespace lensprof {
namespace {

constexpr double kUnstatedShare = 0.3;   // of the scatter of a kind: error of a response without a covariance
constexpr double kLeastVariance = 1e-3;  // of the largest: modes below it are left out
constexpr double kLowestLevel = 24.0 / 255.0,
                 kHighestLevel = 240.0 / 255.0;  // in which pairs have most of their weight

using Modes = Eigen::Matrix<double, LENSPROF_EMOR_MODES, 1>;

double level_of(size_t i) { return static_cast<double>(i) / (kErrorLevels - 1); }

// Subtracts the multiple of ln g, and the constant, that are nearest to the error.
void take_out_gamma(const lensprof_response &response, LevelError &error) {
    double n = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
    const auto log_light = [&](size_t i) {
        return std::log(std::max(lensprof_response_invert(&response, level_of(i), nullptr), 1e-6));
    };
    for (size_t i = 0; i < kErrorLevels; i++) {
        if (level_of(i) < kLowestLevel || level_of(i) > kHighestLevel) continue;
        const double x = log_light(i), y = error[i];
        n++, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
    }
    const double spread = n * sum_xx - sum_x * sum_x;
    const double slope = spread > 0.0 ? (n * sum_xy - sum_x * sum_y) / spread : 0.0;
    for (size_t i = 0; i < kErrorLevels; i++) error[i] -= slope * log_light(i) + (sum_y - slope * sum_x) / n;
}

Eigen::MatrixXd scatter_of_kind(uint32_t camera_kind, double &log_gamma_sigma) {
    Eigen::MatrixXd covariance(LENSPROF_EMOR_MODES, LENSPROF_EMOR_MODES);
    lensprof_response typical;
    if (lensprof_response_set_typical(&typical, camera_kind, covariance.data(), &log_gamma_sigma) != LENSPROF_OK)
        covariance.setZero();
    return covariance;
}

// Of the first response; empty if it is unknown.
Eigen::MatrixXd stated_covariance(const lensprof_profile &profile) {
    const uint32_t modes = profile.response[0].kind == LENSPROF_RESPONSE_EMOR ? profile.response[0].modes : 0;
    const auto size = static_cast<Eigen::Index>(std::min(modes, profile.covariance_size));
    const auto stride = static_cast<Eigen::Index>(profile.covariance_size);
    Eigen::MatrixXd covariance(size, size);
    for (Eigen::Index i = 0; i < size; i++)
        for (Eigen::Index j = 0; j < size; j++) covariance(i, j) = profile.covariance[i * stride + j];
    return covariance;
}

std::vector<LevelError> shapes_of(const lensprof_profile &profile, uint32_t camera_kind) {
    const Eigen::MatrixXd stated = stated_covariance(profile);
    if (stated.size() && stated.trace() > 0.0) return shape_errors(profile.response[0], stated, 1.0);
    double unused;
    return shape_errors(profile.response[0], scatter_of_kind(camera_kind, unused), kUnstatedShare);
}

}  // namespace

std::vector<LevelError> shape_errors(const lensprof_response &response, const Eigen::MatrixXd &covariance,
                                     double share) {
    std::vector<LevelError> shapes;
    if (!covariance.size()) return shapes;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
    const double largest = axes.eigenvalues().maxCoeff();
    for (Eigen::Index m = covariance.cols() - 1; m >= 0; m--) {
        const double variance = axes.eigenvalues()[m];
        if (!(variance > kLeastVariance * largest)) continue;
        LevelError shape{};
        for (size_t i = 1; i + 1 < kErrorLevels; i++) {
            Modes by_mode;
            lp_log_irradiance(response.table, level_of(i), by_mode.data());
            shape[i] = share * std::sqrt(variance) * by_mode.head(covariance.cols()).dot(axes.eigenvectors().col(m));
        }
        shape[0] = shape[1], shape[kErrorLevels - 1] = shape[kErrorLevels - 2];
        take_out_gamma(response, shape);
        shapes.push_back(shape);
    }
    return shapes;
}

ResponseError own_error(const lensprof_profile &profile, uint32_t camera_kind) {
    return {shapes_of(profile, camera_kind), 0.0, 0.0};
}

ResponseError foreign_error(const lensprof_profile *profile, uint32_t camera_kind) {
    ResponseError error;
    const Eigen::MatrixXd scatter = scatter_of_kind(camera_kind, error.log_gamma_sigma);
    if (profile) {
        error.shapes = shapes_of(*profile, camera_kind);
        if (profile->provenance.gamma_sigma > 0.0) error.log_gamma_sigma = profile->provenance.gamma_sigma;
        return error;
    }
    lensprof_response typical;
    if (lensprof_response_set_typical(&typical, camera_kind, nullptr, nullptr) == LENSPROF_OK)
        error.shapes = shape_errors(typical, scatter, 1.0);
    return error;
}

}  // namespace lensprof
