// The quadratic model of the objective about an estimate, with the images' unknowns eliminated (Schur complement).
//
// Shared unknowns s (response, falloff, centre) are dense and few. The images' log exposures a_ic count only relative
// to each other, so their Hessian is a sum over pairs of images: a weighted graph Laplacian per channel. Links and
// fixed values are a linear map a = T q. Cost is linear in pairs, and nearly so in images (sparse Cholesky).
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include "fit/prior/prior.hpp"
#include "fit/problem/problem.hpp"
#include "fit/problem/residual.hpp"

namespace lensprof {

class NormalEquations {
public:
    virtual ~NormalEquations() = default;

    double objective() const { return objective_; }  // at the estimate, priors included
    const std::vector<int> &columns() const { return columns_; }

    // Eliminates the images under damping `lambda`; false if that failed numerically.
    bool reduce(double lambda);
    const Eigen::MatrixXd &reduced_hessian() const { return S_; }
    const Eigen::VectorXd &reduced_gradient() const { return b_; }  // of -objective

    // The images' step for a given shared step, as changes of a_ic.
    std::vector<std::array<double, 3>> image_step(const Eigen::VectorXd &shared_step) const;

    // Decrease of the objective that the model predicts for a shared step and the corresponding step of the images.
    double expected_gain(const Eigen::VectorXd &shared_step) const;

    // Change of every unknown of the images per change of the shared unknowns in each column, with the sign reversed.
    Eigen::MatrixXd images_by(const Eigen::MatrixXd &shared) const;

    // Variance of every unknown of the images, given `shared`, the covariance of the shared unknowns, and the inflation
    // of the error of the images' own pairs.
    Eigen::VectorXd image_variance(const Eigen::MatrixXd &shared, double inflation) const;

protected:
    // Two images and the weight of the Laplacian between them, per channel.
    struct Link {
        uint32_t image[2];
        std::array<double, 3> weight;
    };
    // Contribution of the residuals to the model, as derivatives by a_ic: before links, fixed values and priors.
    struct Sums {
        double objective = 0.0;
        Eigen::MatrixXd shared, cross;  // shared: its lower half
        Eigen::VectorXd gradient, image_gradient;
        std::vector<Link> links;

        Sums(Eigen::Index n, uint32_t image_count);
        void add(const Sums &part);  // adds everything except the links
    };

    NormalEquations(const Problem &problem, const Estimate &estimate);

    void complete(const Sums &sums, const Prior &prior, const Estimate &estimate);

    const Problem &problem_;
    const std::vector<int> columns_;
    const size_t modes_;  // number of leading columns that are modes

private:
    void add_prior(const Prior &prior, const Estimate &estimate);
    void add_falloff_prior(const FalloffPrior &prior, int setting, const Estimate &estimate);
    void map_images(const Sums &sums, const Prior &prior, const Estimate &estimate);

    double objective_ = 0.0;
    Eigen::MatrixXd shared_;              // shared x shared
    Eigen::VectorXd gradient_;            // shared, of -objective
    Eigen::SparseMatrix<double> images_;  // in q
    Eigen::MatrixXd cross_q_;
    Eigen::VectorXd gradient_q_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
    Eigen::MatrixXd eliminated_;  // images_^-1 cross_q_
    Eigen::VectorXd image_only_;  // images_^-1 gradient_q_
    Eigen::MatrixXd S_;
    Eigen::VectorXd b_;
};

// Number of leading columns of free unknowns that are modes.
size_t leading_modes(const std::vector<int> &columns);

// Adds `sign` times the derivatives of ln M at a place of an image, for one falloff curve, to the derivatives by the
// lens, which follow those by the modes.
void add_by_lens(const Problem &problem, const std::vector<int> &columns, const Attenuation &place, uint32_t image,
                 int curve, double sign, double *derivative);

// Diagonal of the inverse of a factored matrix (Takahashi, Fagan and Chen 1973). Only entries in the pattern of the
// factor are computed, so that the cost is that of the factor.
Eigen::VectorXd inverse_diagonal(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> &factor);

}  // namespace lensprof
