// The linear equations of response and exposures given by transfer functions (Kim & Pollefeys 2004, eq. 9 to 13):
//     g(b2) - g(b1) - (a2 - a1) = 0,    g = g0 + sum c_n h'_n,
// over the points (b1, b2) of all curves, solved by least squares with the images' exposures eliminated.
#pragma once

#include <Eigen/SparseCholesky>

#include "fit/methods/transfer_function/log_inverse.hpp"
#include "fit/methods/transfer_function/transfer_points.hpp"
#include "fit/prior/prior.hpp"

namespace lensprof {

struct LogModel {
    bool is_free = true;  // whether the response is estimated; else `g` stays
    int modes = 0;        // coefficients in use
    LogCoefficients c = LogCoefficients::Zero();
    LogInverse g = log_inverse(LogCoefficients(LogCoefficients::Zero()));
};

struct LogWeights {
    double noise = 1.0;     // of a grey value, levels
    bool as_paper = false;  // all points unadjusted and of equal weight except for the mask over the grey levels
    bool adjusted = false;  // derivatives at the nearest places on the estimate's curve, not at the points
};

class LogEquations {
public:
    // Weights points by the noise they carry at the model's response, by the mask over the grey levels, and by how well
    // they agree with the estimate: its response and exposures.
    LogEquations(const Problem &problem, const std::vector<TransferCurve> &curves, const LogWeights &weights,
                 const LogModel &model, const Estimate &estimate);

    // Adds known exposures of images.
    void add_known(const std::vector<Prior::KnownExposure> &known, const Estimate &estimate);

    // Eliminates the images; false if that failed numerically.
    bool eliminate();

    // Solves for the coefficients with `prior_weight` times the prior of the database's spread, then for the exposures.
    // With `hold_scale` the estimate's exposures keep their scale, because (g, k) and (alpha g, alpha k) solve the same
    // equations, and so does k = 0. False if the equations do not determine the unknowns.
    bool solve(double prior_weight, bool hold_scale, LogModel &model, Estimate &estimate) const;

    double points() const { return points_; }  // effective number

private:
    void add_curve(const TransferCurve &curve, const std::vector<double> &weights, const LogModel &model,
                   const Estimate &estimate, bool adjusted);
    Eigen::VectorXd scale_of(const Estimate &estimate) const;

    const Problem &problem_;
    double points_ = 0.0;
    Eigen::MatrixXd response_;  // by all coefficients
    Eigen::VectorXd response_right_;
    Eigen::MatrixXd cross_;        // images x coefficients
    Eigen::VectorXd image_right_;  // by changes of the images' unknowns
    std::vector<Eigen::Triplet<double>> entries_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
    Eigen::MatrixXd eliminated_;  // images^-1 cross
    Eigen::VectorXd image_only_;  // images^-1 image_right
};

}  // namespace lensprof
