#include "fit/methods/transfer_function/log_equations.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

// The mask over the grey levels: f is steep or flat near its ends, and less smooth (section 2.4). The noise of a point
// already accounts for most of this.
constexpr double kMaskSigma = 90.0, kPaperMaskSigma = 45.0, kMiddle = 128.0;
constexpr double kPointError = 0.1;      // levels: error that no number of pairs averages out
constexpr double kDoubtful = 3.0;        // times the usual distance: points farther away have less weight
constexpr double kSmallestRidge = 1e-6;  // precision of a log exposure that nothing else determines
constexpr double kHold = 1e8;            // precision of a held scale
constexpr double kLargestShift = 5.0;    // levels: from a point to the estimate's curve

double mask(const TransferPoint &point, double sigma) {
    double sum = 0.0;
    for (double level : point.level) sum += std::pow((level - kMiddle) / sigma, 2);
    return std::exp(-0.25 * sum);  // the geometric mean of both ends' masks
}

// g(b2) - g(b1), and its variance for a variance of 1 in both levels.
double rise(const double *g, const TransferPoint &point, double *variance) {
    double slope[2], first = at_level(g, point.level[0], &slope[0]), second = at_level(g, point.level[1], &slope[1]);
    if (variance) *variance = slope[0] * slope[0] + slope[1] * slope[1];
    return second - first;
}

double log_ratio(const Problem &problem, const Estimate &estimate, const TransferCurve &curve) {
    const Edge &edge = problem.edges[curve.edge];
    auto c = static_cast<size_t>(curve.channel);
    return estimate.log_exposure[edge.image[1]][c] - estimate.log_exposure[edge.image[0]][c];
}

// The place on the estimate's curve nearest to a point, and the equation's residual at the point, linearised there:
// otherwise noise in a point would enter the derivatives and flatten g (Gauss-Helmert model).
struct Adjusted {
    TransferPoint point;
    double residual;  // of g(b2) - g(b1), to first order
};

Adjusted adjust(const LogModel &model, const TransferPoint &point, double ratio) {
    double slope[2], off = at_level(model.g.data(), point.level[1], &slope[1]) - ratio;
    off -= at_level(model.g.data(), point.level[0], &slope[0]);
    double steepness = std::max(slope[0] * slope[0] + slope[1] * slope[1], 1e-12);
    double reach = kLargestShift * std::sqrt(steepness), step = std::clamp(off, -reach, reach) / steepness;
    Adjusted result{point, 0.0};
    for (size_t side = 0; side < 2; side++) {
        double shift = (side ? -1.0 : 1.0) * step * slope[side], &level = result.point.level[side];
        level = std::clamp(level + shift, 1.0, static_cast<double>(kLogLevels));
        at_level(model.g.data(), level, &slope[side]);
        result.residual += (side ? 1.0 : -1.0) * slope[side] * (point.level[side] - level);
    }
    return result;
}

// Weight of every point: its precision times mask, reduced if it is far from the estimate compared with the others.
std::vector<std::vector<double>> point_weights(const Problem &problem, const std::vector<TransferCurve> &curves,
                                               const LogWeights &weights, const LogModel &model,
                                               const Estimate &estimate) {
    std::vector<std::vector<double>> all;
    std::vector<double> z;
    for (const TransferCurve &curve : curves) {
        all.emplace_back();
        for (const TransferPoint &point : curve.points) {
            if (weights.as_paper) {
                all.back().push_back(mask(point, kPaperMaskSigma));
                continue;
            }
            double variance, off = rise(model.g.data(), point, &variance) - log_ratio(problem, estimate, curve);
            variance *= weights.noise * weights.noise / point.pairs + kPointError * kPointError;
            variance = std::max(variance, 1e-12);
            all.back().push_back(mask(point, kMaskSigma) / variance);
            z.push_back(std::abs(off) / std::sqrt(variance));
        }
    }
    if (weights.as_paper || z.empty()) return all;
    std::vector<double> distances = z;
    double usual = kDoubtful * std::max(1.0, kMadToSigma * median(distances));
    size_t p = 0;
    for (auto &curve : all)
        for (double &weight : curve) {
            double ratio = z[p++] / usual;
            weight /= (1.0 + ratio * ratio) * (1.0 + ratio * ratio);
        }
    return all;
}

}  // namespace

LogEquations::LogEquations(const Problem &problem, const std::vector<TransferCurve> &curves, const LogWeights &weights,
                           const LogModel &model, const Estimate &estimate)
    : problem_(problem),
      response_(Eigen::MatrixXd::Zero(kLogModes, kLogModes)),
      response_right_(Eigen::VectorXd::Zero(kLogModes)),
      cross_(Eigen::MatrixXd::Zero(problem.image_unknowns, kLogModes)),
      image_right_(Eigen::VectorXd::Zero(problem.image_unknowns)) {
    auto all = point_weights(problem, curves, weights, model, estimate);
    for (size_t k = 0; k < curves.size(); k++) add_curve(curves[k], all[k], model, estimate, weights.adjusted);
    for (int q = 0; q < problem.image_unknowns; q++) entries_.emplace_back(q, q, kSmallestRidge);
}

void LogEquations::add_curve(const TransferCurve &curve, const std::vector<double> &weights, const LogModel &model,
                             const Estimate &estimate, bool adjusted) {
    const Edge &edge = problem_.edges[curve.edge];
    auto c = static_cast<size_t>(curve.channel);
    double weight = 0.0, right = 0.0, ratio = log_ratio(problem_, estimate, curve);
    LogCoefficients row_sum = LogCoefficients::Zero();  // sum of weighted rows
    for (size_t p = 0; p < curve.points.size(); p++) {
        Adjusted point = adjusted ? adjust(model, curve.points[p], ratio) : Adjusted{curve.points[p], 0.0};
        const double *known = model.is_free ? kLogEmor[0] : model.g.data();
        double w = weights[p], y = ratio - point.residual - rise(known, point.point, nullptr);
        LogCoefficients row = LogCoefficients::Zero();
        for (int n = 0; n < kLogModes && model.is_free; n++) row[n] = rise(kLogEmor[n + 1], point.point, nullptr);
        response_ += w * row * row.transpose();
        response_right_ += w * y * row;
        weight += w, right += w * y, row_sum += w * row;
        points_ += w > 0.0;
    }
    // The row's derivative by the unknowns of image 1 is +1, by those of image 2 -1.
    int q[4] = {problem_.ev_unknown[edge.image[0]], problem_.balance_unknown[edge.image[0]][c],
                problem_.ev_unknown[edge.image[1]], problem_.balance_unknown[edge.image[1]][c]};
    for (int a = 0; a < 4; a++) {
        if (q[a] < 0) continue;
        double sign = a < 2 ? 1.0 : -1.0;
        cross_.row(q[a]) += sign * row_sum.transpose();
        image_right_[q[a]] += sign * right;
        for (int b = 0; b < 4; b++)
            if (q[b] >= 0) entries_.emplace_back(q[a], q[b], weight * sign * (b < 2 ? 1.0 : -1.0));
    }
}

void LogEquations::add_known(const std::vector<Prior::KnownExposure> &known, const Estimate &estimate) {
    auto measured = static_cast<size_t>(problem_.measured_channel());
    for (size_t i = 0; i < known.size(); i++) {
        int q = problem_.ev_unknown[i];
        if (q < 0) continue;
        entries_.emplace_back(q, q, known[i].precision);
        image_right_[q] += known[i].precision * (known[i].log_exposure - estimate.log_exposure[i][measured]);
    }
}

bool LogEquations::eliminate() {
    int count = problem_.image_unknowns;
    eliminated_ = Eigen::MatrixXd::Zero(count, kLogModes);
    image_only_ = Eigen::VectorXd::Zero(count);
    if (count == 0) return true;
    Eigen::SparseMatrix<double> images(count, count);
    images.setFromTriplets(entries_.begin(), entries_.end());
    factor_.compute(images);
    if (factor_.info() != Eigen::Success) return false;
    eliminated_ = factor_.solve(cross_);
    image_only_ = factor_.solve(image_right_);
    return eliminated_.allFinite() && image_only_.allFinite();
}

// Half the derivative of the sum of all squared log exposures, relative to the reference, by the unknowns of the
// images.
Eigen::VectorXd LogEquations::scale_of(const Estimate &estimate) const {
    Eigen::VectorXd scale = Eigen::VectorXd::Zero(problem_.image_unknowns);
    for (uint32_t i = 0; i < problem_.image_count; i++)
        for (size_t c = 0; c < static_cast<size_t>(problem_.channels); c++)
            for (int unknown : {problem_.ev_unknown[i], problem_.balance_unknown[i][c]})
                if (unknown >= 0)
                    scale[unknown] += estimate.log_exposure[i][c] - estimate.log_exposure[problem_.reference][c];
    return scale;
}

bool LogEquations::solve(double prior_weight, bool hold_scale, LogModel &model, Estimate &estimate) const {
    if (model.is_free) {
        Eigen::Index m = model.modes;
        Eigen::MatrixXd S = response_.topLeftCorner(m, m) - (cross_.transpose() * eliminated_).topLeftCorner(m, m);
        Eigen::VectorXd b = (response_right_ - cross_.transpose() * image_only_).head(m);
        for (Eigen::Index n = 0; n < m; n++) S(n, n) += prior_weight / (kLogEmorSigma[n] * kLogEmorSigma[n]);
        // The images' unknowns change by  image_only - eliminated c,  orthogonally to the scale.
        Eigen::VectorXd scale = scale_of(estimate), held = (eliminated_.transpose() * scale).head(m);
        if (hold_scale && m && held.squaredNorm() > 0.0) {
            double hold = (kHold + 1e3 * S.diagonal().maxCoeff()) / held.squaredNorm();
            S += hold * held * held.transpose();
            b += hold * image_only_.dot(scale) * held;
        }
        LogCoefficients c = monotone_coefficients(S, b);
        if (!c.allFinite()) return false;
        model.c = c;
        model.g = log_inverse(c);
    }
    Eigen::VectorXd q = image_only_ - eliminated_ * model.c;
    const auto zero = estimate.log_exposure[problem_.reference];
    for (uint32_t i = 0; i < problem_.image_count; i++)
        for (size_t c = 0; c < static_cast<size_t>(problem_.channels); c++) {
            double &a = estimate.log_exposure[i][c];
            for (int unknown : {problem_.ev_unknown[i], problem_.balance_unknown[i][c]})
                if (unknown >= 0) a += q[unknown];
            if (problem_.ev_unknown[i] >= 0)
                a = std::clamp(a, zero[c] - kLargestLogExposure, zero[c] + kLargestLogExposure);
        }
    return true;
}

}  // namespace lensprof
