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

// Which entries of the full shared vector are estimated.
std::vector<int> free_columns(const Problem &problem, int modes);

// (emor[0..24], k1..k3, centre x, y) of an estimate, and back.
Eigen::VectorXd shared_vector(const Estimate &estimate);
void set_shared(Estimate &estimate, const Eigen::VectorXd &full);

class NormalEquations {
public:
    // Builds the model. `objective` receives the value at the estimate, priors included.
    NormalEquations(const Problem &problem, const Prior &prior, const Loss &loss, const NoiseWeights &weights,
                    const Estimate &estimate);

    double objective() const { return objective_; }
    const std::vector<int> &columns() const { return columns_; }

    // Eliminates the images under damping `lambda`; false when that failed numerically.
    bool reduce(double lambda);
    const Eigen::MatrixXd &reduced_hessian() const { return S_; }
    const Eigen::VectorXd &reduced_gradient() const { return b_; }  // of -objective

    // The images' step that belongs to a shared step, as changes of a_ic.
    std::vector<std::array<double, 3>> image_step(const Eigen::VectorXd &shared_step) const;

private:
    void add_pair(size_t p, const NoiseWeights &weights, const Loss &loss, const Estimate &estimate);
    void add_prior(const Prior &prior, const Estimate &estimate);
    void map_images();

    const Problem &problem_;
    std::vector<int> columns_;
    double objective_ = 0.0;
    Eigen::MatrixXd shared_;                         // shared x shared
    Eigen::VectorXd gradient_;                       // shared, of -objective
    std::vector<std::array<double, 3>> edge_weight_; // Laplacian weight of each edge and channel
    Eigen::MatrixXd cross_;                          // (3 images) x shared, in a_ic
    Eigen::VectorXd image_gradient_;                 // 3 images
    Eigen::SparseMatrix<double> images_;             // in q
    Eigen::MatrixXd cross_q_;
    Eigen::VectorXd gradient_q_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
    Eigen::MatrixXd eliminated_;                     // images_^-1 cross_q_
    Eigen::VectorXd image_only_;                     // images_^-1 gradient_q_
    Eigen::MatrixXd S_;
    Eigen::VectorXd b_;
};

// The objective alone.
double objective(const Problem &problem, const Prior &prior, const Loss &loss, const NoiseWeights &weights,
                 const Estimate &estimate);

}  // namespace lensprof
