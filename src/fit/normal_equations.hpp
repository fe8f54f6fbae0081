// The quadratic model of the objective about an estimate, with the images' unknowns eliminated (Schur complement).
//
// Shared unknowns s (response, falloff, centre) are dense and few. The images' log exposures a_ic enter every residual
// only through a_ic - a_jc, so their Hessian is a sum over edges of image pairs: a weighted graph Laplacian for each
// channel. Links and fixed values are a linear map a = T q. Cost is linear in pairs, and nearly so in images (sparse
// Cholesky).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include "loss.hpp"
#include "prior.hpp"
#include "problem.hpp"

namespace lensprof {

class NormalEquations {
public:
    // Builds the model. `objective` receives the value at the estimate, priors included.
    NormalEquations(const Problem &problem, const Prior &prior, const Loss &loss, const NoiseWeights &weights,
                    const Estimate &estimate, const ModeTable &modes);

    double objective() const { return objective_; }
    const std::vector<int> &columns() const { return columns_; }

    // Eliminates the images under damping `lambda`; false when that failed numerically.
    bool reduce(double lambda);
    const Eigen::MatrixXd &reduced_hessian() const { return S_; }
    const Eigen::VectorXd &reduced_gradient() const { return b_; }  // of -objective

    // The images' step that belongs to a shared step, as changes of a_ic.
    std::vector<std::array<double, 3>> image_step(const Eigen::VectorXd &shared_step) const;

    // What the model expects the objective to fall by under a shared step and the images' that belongs to it.
    double expected_gain(const Eigen::VectorXd &shared_step) const;

    // Variance of every unknown of the images, when `shared` is the covariance of the shared unknowns.
    Eigen::VectorXd image_variance(const Eigen::MatrixXd &shared) const;

private:
    struct Rows;  // residuals of one edge and channel
    struct Sums;
    void by_lens(const Falloff &fall, int curve, int first, double *by) const;
    void add_chunk(const Chunk &chunk, const Loss &loss, const NoiseWeights &weights, const Estimate &estimate,
                   const ModeTable &modes, Sums &sums) const;
    void add_edge(const Edge &edge, const Loss &loss, const NoiseWeights &weights, const Estimate &estimate,
                  const ModeTable &modes, Sums &sums) const;
    static void add_rows(const Edge &edge, int channel, Sums &sums);
    void add_prior(const Prior &prior, const Estimate &estimate);
    void map_images(const Sums &sums, const Prior &prior, const Estimate &estimate);

    const Problem &problem_;
    std::vector<int> columns_;
    double objective_ = 0.0;
    Eigen::MatrixXd shared_;                         // shared x shared
    Eigen::VectorXd gradient_;                       // shared, of -objective
    std::vector<std::array<double, 3>> edge_weight_; // Laplacian weight of each edge and channel
    Eigen::SparseMatrix<double> images_;             // in q
    Eigen::MatrixXd cross_q_;
    Eigen::VectorXd gradient_q_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
    Eigen::MatrixXd eliminated_;                     // images_^-1 cross_q_
    Eigen::VectorXd image_only_;                     // images_^-1 gradient_q_
    Eigen::MatrixXd S_;
    Eigen::VectorXd b_;
};

// Diagonal of the inverse of a factored matrix (Takahashi, Fagan and Chen 1973): only entries in the pattern of the
// factor are ever formed, so that the cost follows the factor's.
Eigen::VectorXd inverse_diagonal(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> &factor);

}  // namespace lensprof
