#include "fit/prior/gamma_prior.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include "core/response.h"

namespace lensprof {
namespace {

using Modes = Eigen::Matrix<double, LENSPROF_EMOR_MODES, 1>;

constexpr double kShapeGreys[4] = {24.0 / 255.0, 80.0 / 255.0, 144.0 / 255.0, 232.0 / 255.0};
constexpr double kShapeError = 0.02;  // of a shape: error of fits, and of 25 modes
constexpr double kUsual =
    3.5;  // standard deviations: 95 % of a kind's measured curves are nearer, and almost all others
constexpr double kSmallestSigma = 1e-3;  // of ln gamma: that of LINEAR is 0
constexpr double kUntypical = 0.5;       // above 1, by which a response is untypical of the kind

// ln g at four grey values, scaled to 0 at the dark and 1 at the bright one of the gauge. It is the same for all
// members f(x^(1/gamma)) of a family, whose ln g are multiples of each other.
struct ShapeOf {
    Eigen::Vector4d at;
    Eigen::Matrix<double, 4, LENSPROF_EMOR_MODES> by_mode;

    explicit ShapeOf(const double *table) {
        Modes of_dark, of_bright, of_grey;
        const double dark = lp_log_irradiance(table, LP_GAUGE_DARK, of_dark.data()),
                     range =
                         std::max(lp_log_irradiance(table, LP_GAUGE_BRIGHT, of_bright.data()) - dark, LP_GAUGE_LEAST);
        for (int i = 0; i < 4; i++) {
            at[i] = (lp_log_irradiance(table, kShapeGreys[i], of_grey.data()) - dark) / range;
            by_mode.row(i) = ((of_grey - of_dark) - at[i] * (of_bright - of_dark)).transpose() / range;
        }
    }
};

// Variances of the shape at the four grey values.
Eigen::Vector4d shape_variance(const ShapeOf &shape, const Eigen::MatrixXd &covariance) {
    const auto by_mode = shape.by_mode.leftCols(covariance.cols());
    return (by_mode * covariance).cwiseProduct(by_mode).rowwise().sum();
}

void set_typical(uint32_t kind, lensprof_response &response, double *covariance, double &sigma) {
    if (lensprof_response_set_typical(&response, kind, covariance, &sigma) != LENSPROF_OK)
        throw std::invalid_argument("unknown kind of camera");
}

}  // namespace

double gamma_position(const double *table, Eigen::VectorXd *slope) {
    Modes by_mode;
    const double position = lp_gauge_position(table, by_mode.data());
    if (slope) *slope = by_mode;
    return position;
}

double shape_distance(const KnownResponse &a, const KnownResponse &b) {
    const ShapeOf of_a(a.table), of_b(b.table);
    const Eigen::Array4d variance =
        (shape_variance(of_a, a.covariance) + shape_variance(of_b, b.covariance)).array() + kShapeError * kShapeError;
    return ((of_a.at - of_b.at).array().abs() / variance.sqrt()).maxCoeff();
}

GammaPrior::GammaPrior(uint32_t camera_kind) {
    constexpr int kModes = LENSPROF_EMOR_MODES;
    lensprof_response typical;
    Eigen::Matrix<double, kModes, kModes> covariance;  // symmetric
    set_typical(camera_kind, typical, covariance.data(), sigma_);
    position_ = gamma_position(typical.table);
    sigma_ = std::max(sigma_, kSmallestSigma);
    const ShapeOf shape(typical.table);
    shape_ = shape.at;
    Eigen::Matrix4d scatter = shape.by_mode * covariance * shape.by_mode.transpose();
    scatter.diagonal().array() += kShapeError * kShapeError;
    precision_ = scatter.inverse();
    set_typical(LENSPROF_CAMERA_ANY, typical, nullptr, of_any_);
}

double GammaPrior::oddness(const double *table) const {
    const Shape off = ShapeOf(table).at - shape_;
    return std::sqrt(off.dot(precision_ * off)) / kUsual;
}

double GammaPrior::sigma_of(const double *table) const {
    return std::hypot(sigma_, of_any_ * std::clamp((oddness(table) - 1.0) / kUntypical, 0.0, 1.0));
}

}  // namespace lensprof
