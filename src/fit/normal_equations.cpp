#include "normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include "residual.hpp"

namespace lensprof {
namespace {

// Shared unknowns that take part: those of a fixed response, or of modes not in use, do not count against the prior.
double prior_cost(const Prior &prior, const std::vector<int> &columns, const Estimate &estimate) {
    Eigen::VectorXd full = shared_vector(estimate), d = Eigen::VectorXd::Zero(kMaxShared);
    for (int column : columns) d[column] = full[column] - prior.mean[column];
    return 0.5 * d.dot(prior.precision * d);
}

}  // namespace

std::vector<int> free_columns(const Problem &problem, int modes) {
    std::vector<int> columns;
    if (problem.free & LENSPROF_FREE_RESPONSE)
        for (int l = 0; l < modes; l++) columns.push_back(l);
    const uint32_t flags[3] = {LENSPROF_FREE_K1, LENSPROF_FREE_K2, LENSPROF_FREE_K3};
    for (int n = 0; n < 3; n++)
        if (problem.free & flags[n]) columns.push_back(kMaxModes + n);
    if (problem.free & LENSPROF_FREE_CENTER)
        for (int d = 0; d < 2; d++) columns.push_back(kMaxModes + 3 + d);
    return columns;
}

Eigen::VectorXd shared_vector(const Estimate &estimate) {
    Eigen::VectorXd full(kMaxShared);
    std::copy(estimate.emor.begin(), estimate.emor.end(), full.data());
    std::copy(estimate.vignetting.k, estimate.vignetting.k + 3, full.data() + kMaxModes);
    std::copy(estimate.vignetting.center, estimate.vignetting.center + 2, full.data() + kMaxModes + 3);
    return full;
}

void set_shared(Estimate &estimate, const Eigen::VectorXd &full) {
    if (estimate.modes >= 0) set_response(estimate, full.data(), estimate.modes);
    std::copy(full.data() + kMaxModes, full.data() + kMaxModes + 3, estimate.vignetting.k);
    std::copy(full.data() + kMaxModes + 3, full.data() + kMaxModes + 5, estimate.vignetting.center);
}

NormalEquations::NormalEquations(const Problem &problem, const Prior &prior, const Loss &loss,
                                 const NoiseWeights &weights, const Estimate &estimate)
    : problem_(problem), columns_(free_columns(problem, estimate.modes)) {
    auto n = static_cast<Eigen::Index>(columns_.size());
    auto images = static_cast<Eigen::Index>(3 * problem.image_count);
    shared_ = Eigen::MatrixXd::Zero(n, n);
    gradient_ = Eigen::VectorXd::Zero(n);
    edge_weight_.assign(problem.edges.size(), {0.0, 0.0, 0.0});
    cross_ = Eigen::MatrixXd::Zero(images, n);
    image_gradient_ = Eigen::VectorXd::Zero(images);
    for (size_t p = 0; p < problem.pairs.size(); p++) add_pair(p, weights, loss, estimate);
    shared_.triangularView<Eigen::StrictlyUpper>() = shared_.transpose();
    add_prior(prior, estimate);
    map_images();
}

void NormalEquations::add_pair(size_t p, const NoiseWeights &weights, const Loss &loss, const Estimate &estimate) {
    const auto &pair = problem_.pairs[p];
    PairTransfer pair_transfer = evaluate_pair(problem_, estimate, pair);
    const Falloff &fall = pair_transfer.fall;
    const auto &t = pair_transfer.channel;
    PairResiduals factor, residuals = weighted_residuals(pair_transfer, problem_.channels, weights[p]);
    objective_ += 0.5 * pair_cost(residuals, problem_.channels, loss, &factor);

    auto n = static_cast<Eigen::Index>(columns_.size());
    double by_emor[kMaxModes], row_data[kMaxShared];
    Eigen::Map<Eigen::VectorXd> row(row_data, n);  // d prediction / d shared
    for (int c = 0; c < problem_.channels; c++)
        for (int side = 0; side < 2; side++) {
            double w = weights[p][c][side], f = factor[c][side] * w * w, by_delta = t[c].by_delta[side];
            if (f * by_delta * by_delta == 0.0 && t[c].by_value[side] == 0.0) continue;  // saturated prediction
            if (!columns_.empty() && columns_[0] < kMaxModes) transfer_by_emor(estimate, t[c], side, by_emor);
            for (Eigen::Index u = 0; u < n; u++) {
                int column = columns_[static_cast<size_t>(u)];
                row[u] = column < kMaxModes       ? -by_emor[column]
                         : column < kMaxModes + 3 ? by_delta * fall.by_k[column - kMaxModes]
                                                  : by_delta * fall.by_center[column - kMaxModes - 3];
            }
            double residual = t[c].residual[side];
            shared_.selfadjointView<Eigen::Lower>().rankUpdate(row, f);
            gradient_ += f * residual * row;
            edge_weight_[problem_.edge_of_pair[p]][c] += f * by_delta * by_delta;
            for (int end = 0; end < 2; end++) {
                Eigen::Index i = 3 * static_cast<Eigen::Index>(pair.image[end]) + c;
                double by_exposure = end == 0 ? by_delta : -by_delta;
                cross_.row(i) += f * by_exposure * row.transpose();
                image_gradient_[i] += f * by_exposure * residual;
            }
        }
}

void NormalEquations::add_prior(const Prior &prior, const Estimate &estimate) {
    Eigen::VectorXd full = shared_vector(estimate);
    objective_ += prior_cost(prior, columns_, estimate);
    for (size_t u = 0; u < columns_.size(); u++)
        for (size_t v = 0; v < columns_.size(); v++) {
            auto i = static_cast<Eigen::Index>(u), j = static_cast<Eigen::Index>(v);
            double precision = prior.precision(columns_[u], columns_[v]);
            shared_(i, j) += precision;
            gradient_[i] -= precision * (full[columns_[v]] - prior.mean[columns_[v]]);
        }
}

// From log exposures a_ic to the images' unknowns q.
void NormalEquations::map_images() {
    int count = problem_.image_unknowns;
    auto columns_of = [&](uint32_t i, int c) {
        return std::array<int, 2>{problem_.ev_unknown[i], problem_.balance_unknown[i][c]};
    };
    std::vector<Eigen::Triplet<double>> entries;
    for (size_t e = 0; e < problem_.edges.size(); e++)
        for (int c = 0; c < problem_.channels; c++)
            for (int end = 0; end < 2; end++)
                for (int other = 0; other < 2; other++)
                    for (int q : columns_of(problem_.edges[e].image[end], c))
                        for (int r : columns_of(problem_.edges[e].image[other], c))
                            if (q >= 0 && r >= 0)
                                entries.emplace_back(q, r, (end == other ? 1.0 : -1.0) * edge_weight_[e][c]);
    images_.resize(count, count);
    images_.setFromTriplets(entries.begin(), entries.end());
    cross_q_ = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(columns_.size()));
    gradient_q_ = Eigen::VectorXd::Zero(count);
    for (uint32_t i = 0; i < problem_.image_count; i++)
        for (int c = 0; c < problem_.channels; c++)
            for (int q : columns_of(i, c))
                if (q >= 0) {
                    cross_q_.row(q) += cross_.row(3 * static_cast<Eigen::Index>(i) + c);
                    gradient_q_[q] += image_gradient_[3 * static_cast<Eigen::Index>(i) + c];
                }
}

bool NormalEquations::reduce(double lambda) {
    auto n = static_cast<Eigen::Index>(columns_.size());
    S_ = shared_;
    for (Eigen::Index u = 0; u < n; u++) S_(u, u) += lambda * shared_(u, u) + 1e-12;
    b_ = gradient_;
    if (problem_.image_unknowns == 0) return true;
    // A weak pull (sigma 30 EV) keeps images without usable pairs, and unconnected groups, where they are.
    Eigen::SparseMatrix<double> damped = images_, diagonal(images_.rows(), images_.cols());
    diagonal.setIdentity();
    for (Eigen::Index q = 0; q < images_.rows(); q++) diagonal.coeffRef(q, q) = lambda * images_.coeff(q, q) + 2e-3;
    damped += diagonal;
    factor_.compute(damped);
    if (factor_.info() != Eigen::Success) return false;
    eliminated_ = factor_.solve(cross_q_);
    image_only_ = factor_.solve(gradient_q_);
    S_ -= cross_q_.transpose() * eliminated_;
    S_ = 0.5 * (S_ + S_.transpose()).eval();
    b_ -= eliminated_.transpose() * gradient_q_;
    return S_.allFinite() && b_.allFinite();
}

std::vector<std::array<double, 3>> NormalEquations::image_step(const Eigen::VectorXd &shared_step) const {
    std::vector<std::array<double, 3>> step(problem_.image_count, {0.0, 0.0, 0.0});
    if (problem_.image_unknowns == 0) return step;
    Eigen::VectorXd q = image_only_ - eliminated_ * shared_step;
    for (uint32_t i = 0; i < problem_.image_count; i++)
        for (int c = 0; c < problem_.channels; c++) {
            if (problem_.ev_unknown[i] >= 0) step[i][c] += q[problem_.ev_unknown[i]];
            if (problem_.balance_unknown[i][c] >= 0) step[i][c] += q[problem_.balance_unknown[i][c]];
        }
    return step;
}

double objective(const Problem &problem, const Prior &prior, const Loss &loss, const NoiseWeights &weights,
                 const Estimate &estimate) {
    double sum = prior_cost(prior, free_columns(problem, estimate.modes), estimate);
    for (size_t p = 0; p < problem.pairs.size(); p++) {
        PairTransfer t = evaluate_pair(problem, estimate, problem.pairs[p]);
        sum += 0.5 * pair_cost(weighted_residuals(t, problem.channels, weights[p]), problem.channels, loss, nullptr);
    }
    return sum;
}

}  // namespace lensprof
