// With u the estimate of all unknowns from all pairs, u_g that without group g of n, and m the mean of the u_g,
//
//     C = (n - 1) / n  sum_g (u_g - m)(u_g - m)'.
//
// Why the factor: to first order u is a mean of contributions of the groups, u = (1 / n) sum_g x_g, of which
// u_g - m = -(x_g - mean x) / (n - 1). The variance of that mean is sum_g (x_g - mean x)^2 / (n (n - 1)), which is the
// above. This holds for any estimator that is smooth in its data, including one of several stages as here (joint
// histograms, most likely transfer curves, least squares, falloff in turn), whose Hessians do not add up.
//
// A pair's group is drawn from its number by a hash, so that neighbouring pairs, whose errors are alike, are spread
// over all groups; what they share is then not in C. Each of the variances has n - 1 degrees of freedom, and a standard
// error the relative error 1 / sqrt(2 (n - 1)): a sixth for 20 groups. C has at most rank n - 1, so that it serves for
// standard errors of few combinations, not for an inverse of all. Units: coefficients, k and centre (half diagonals)
// have those of the shared vector, images' unknowns are natural logarithms.
#include "fit/methods/transfer_function/jackknife.hpp"

#include "fit/base/parallel.hpp"
#include "fit/solver/heldout.hpp"

namespace lensprof {
namespace {

// Logarithms of the images' exposures and white balance factors, by unknown.
Eigen::VectorXd image_vector(const Problem &problem, const Estimate &estimate) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(problem.image_unknowns);
    auto measured = static_cast<size_t>(problem.measured_channel());
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const auto &a = estimate.log_exposure[i];
        if (problem.ev_unknown[i] >= 0) q[problem.ev_unknown[i]] = a[measured];
        for (size_t c = 0; c < 3; c++)
            if (problem.balance_unknown[i][c] >= 0) q[problem.balance_unknown[i][c]] = a[c] - a[1];
    }
    return q;
}

}  // namespace

Covariance jackknife(const Problem &problem, uint32_t pair_count,
                     const std::function<Estimate(const std::vector<uint32_t> &keep)> &without,
                     const std::function<bool()> &cancelled) {
    std::vector<Estimate> found(kJackknifeGroups);
    bool is_done = for_each_parallel(
        kJackknifeGroups, problem.threads,
        [&](uint32_t group) {
            std::vector<uint32_t> keep;
            for (uint32_t p = 0; p < pair_count; p++)
                if ((pair_hash(p) >> 8) % kJackknifeGroups != group) keep.push_back(p);
            found[group] = without(keep);
        },
        cancelled);
    if (!is_done) throw Cancelled();
    Covariance result;
    result.shared = Eigen::MatrixXd::Zero(kOneSetting, kOneSetting);
    result.images = Eigen::VectorXd::Zero(problem.image_unknowns);
    for (const Estimate &estimate : found)
        if (estimate.log_exposure.empty()) return result;
    constexpr double n = kJackknifeGroups, scale = (n - 1.0) / n;
    Eigen::VectorXd shared = Eigen::VectorXd::Zero(kOneSetting), images = result.images;
    for (const Estimate &estimate : found) {
        shared += shared_vector(estimate) / n;
        images += image_vector(problem, estimate) / n;
    }
    for (const Estimate &estimate : found) {
        Eigen::VectorXd shared_deviation = shared_vector(estimate) - shared,
                        image_deviation = image_vector(problem, estimate) - images;
        result.shared +=
            shared_deviation * shared_deviation.transpose();  // symmetric to the last bit, unlike scale * off * off'
        result.images += image_deviation.cwiseAbs2();
    }
    result.shared *= scale;
    result.images *= scale;
    result.is_determined = result.shared.allFinite() && result.images.allFinite();
    return result;
}

}  // namespace lensprof
