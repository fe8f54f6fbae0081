#include "fit/methods/lens_weight.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <lensprof/profile.h>

namespace lensprof {
namespace {

// A symmetric matrix without its negative eigenvalues, which are rounding, and the projection on those that count.
template <class Matrix>
struct PositivePart {
    Matrix matrix, projection;

    explicit PositivePart(const Matrix &symmetric) {
        const Eigen::SelfAdjointEigenSolver<Matrix> parts(0.5 * (symmetric + symmetric.transpose()));
        const auto &vectors = parts.eigenvectors();
        const auto values = parts.eigenvalues().cwiseMax(0.0).eval();
        const double smallest = 1e-6 * values.maxCoeff();
        matrix = vectors * values.asDiagonal() * vectors.transpose();
        projection =
            vectors * (values.array() > smallest).template cast<double>().matrix().asDiagonal() * vectors.transpose();
    }
};

// What the pictures show of the falloff: information of the estimate minus that of the prior, over the inflation.
ShownFalloff shown_falloff(const Problem &problem, const FalloffPrior &prior, const Estimate &estimate,
                           const Covariance &found, double inflation, int setting) {
    const int green = green_falloff(problem.vignettings, setting);
    Eigen::Matrix3d slope, covariance = found.shared.block<3, 3>(green, green);
    const auto curve = static_cast<size_t>(green_curve(problem.vignettings));
    const Eigen::Vector3d u = log_falloff(estimate.vignetting[static_cast<size_t>(setting)][curve].k, &slope);
    covariance = slope * covariance * slope.transpose();
    const Eigen::Matrix3d all = covariance.inverse();
    if (!all.allFinite()) return {Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
    const PositivePart<Eigen::Matrix3d> alone(all - prior.precision);
    // The estimate minimises both: alone * own = all * u - prior * mean, within what the pictures show at all.
    return {alone.matrix / inflation, alone.projection * (all * u - prior.precision * prior.mean) / inflation};
}

// The pictures' own centre relative to the middle of the frame, in standard errors of both.
double center_distance(const Prior &prior, const Estimate &estimate, const Covariance &found, double inflation,
                       int setting) {
    constexpr double kNothing = 1e-4;
    const int center = center_column(setting);
    const Eigen::Matrix2d all = found.shared.block<2, 2>(center, center).inverse(),
                          of_prior = prior.precision.block<2, 2>(center, center);
    if (!all.allFinite() || !(of_prior(0, 0) > 0.0)) return 0.0;
    const Eigen::Vector2d at = Eigen::Vector2d::Map(estimate.vignetting[static_cast<size_t>(setting)][0].center);
    const Eigen::Matrix2d alone = PositivePart<Eigen::Matrix2d>(all - of_prior).matrix / inflation;
    const Eigen::Matrix2d error = (alone + kNothing * Eigen::Matrix2d::Identity()).inverse();
    const Eigen::Vector2d own = error * (all * at) / inflation;
    const Eigen::Matrix2d both = error + kCenterSigma * kCenterSigma * Eigen::Matrix2d::Identity();
    return std::sqrt(own.dot(both.inverse() * own));
}

}  // namespace

std::vector<WeighedLens> weigh_lenses(const Problem &problem, const Prior &prior, double weight,
                                      const Estimate &estimate, const Covariance &found, const Inflation &inflation) {
    std::vector<WeighedLens> lenses;
    for (int s = 0; s < problem.settings; s++) {
        const auto n = static_cast<size_t>(s);
        WeighedLens lens;
        const double inflated = inflation.lens[n];
        const bool is_whole = (problem.free & LENSPROF_FREE_FALLOFF) == LENSPROF_FREE_FALLOFF;
        const LensFacts facts = facts_of(problem, s);
        lens.knowledge = {expected_falloff(facts), weight * inflated, weight * inflated};
        if (is_whole)
            lens.knowledge.falloff = falloff_given(
                shown_falloff(problem, prior.falloff[n], estimate, found, inflated, s), facts, lens.falloff_distance);
        if (problem.free & LENSPROF_FREE_CENTER)
            lens.center_distance = center_distance(prior, estimate, found, inflated, s);
        lenses.push_back(lens);
    }
    return lenses;
}

}  // namespace lensprof
