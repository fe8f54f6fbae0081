#include "fit/flat/solver.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "falloff/levenberg_marquardt.hpp"
#include "falloff/power_fit.hpp"
#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/prior/prior.hpp"
#include "fit/problem/loss.hpp"

namespace lensprof {
namespace {

constexpr double kCutoff = 4.0;           // of the robust loss, sigmas of a cell's typical size
constexpr int kRounds = 12;               // of estimating noise and fit in turn, of which the first are cut off:
constexpr int kShortRounds = 3;           // with the noise of a poor fit, steps are short
constexpr double kNoiseTolerance = 1e-3;  // largest change of the noise parameters at convergence
constexpr DescentLimits kLimits{60, 1e-6, 1e12, 1e-8}, kShortLimits{8, 1e-6, 1e12, 1e-8};
constexpr DescentLimits kRoughLimits{8, 1e-6, 1e12, 1e-4};  // of the first descent
constexpr double kSmallestScale = 0.2;
constexpr double kMedianChi2 = 0.4549, kMedianChi2Of3 = 2.366;   // of chi-squared, 1 and 3 degrees of freedom
constexpr double kInlierSquare = 0.973, kInlierSquare3 = 0.988;  // mean square of the residuals within inlier_limit
constexpr int kBlocks[] = {4, 8, 16, 32};                        // cells along a block
constexpr double kStartNoise = 0.01;                             // of a cell's light, in the start values
constexpr double kSmallestPivot = 1e-11;  // of the scaled normal equations: below it, they are singular

double square(double x) { return x * x; }

size_t channels_of(const FlatProblem &problem) { return static_cast<size_t>(problem.model.channels); }

double cutoff(const FlatProblem &problem) { return kCutoff * kCutoff * problem.model.channels; }

// Standard deviation of a cell's residual.
double sigma_of(const FlatEstimate &estimate, double variance, double predicted) {
    return std::sqrt(variance + square(estimate.unevenness * predicted));
}

double prior_objective(const FlatProblem &problem, const Eigen::VectorXd &u) {
    Eigen::VectorXd d = u - problem.prior.mean;
    return 0.5 * d.dot(problem.prior.precision * d);
}

// The reference of sigma, held while the solver steps: the prediction at its start.
using Sigmas = std::vector<std::array<double, 3>>;

Sigmas all_sigmas(const FlatProblem &problem, const FlatEstimate &estimate) {
    Sigmas sigmas(problem.cells.size());
    const FlatLight light(problem.model, estimate.u);
    for (size_t i = 0; i < sigmas.size(); i++) {
        const FlatCell &cell = problem.cells[i];
        const auto predicted = light.at(cell.shot, cell.x, cell.y);
        for (size_t c = 0; c < channels_of(problem); c++)
            sigmas[i][c] = estimate.scale * sigma_of(estimate, cell.variance[c], predicted[c]);
    }
    return sigmas;
}

double objective(const FlatProblem &problem, const Eigen::VectorXd &u, const Sigmas &sigmas, double inflation) {
    const FlatLight light(problem.model, u);
    double sum = 0.0, divisor;
    for (size_t i = 0; i < sigmas.size(); i++) {
        const FlatCell &cell = problem.cells[i];
        const auto predicted = light.at(cell.shot, cell.x, cell.y);
        double chi2 = 0.0;
        for (size_t c = 0; c < channels_of(problem); c++) chi2 += square((cell.value[c] - predicted[c]) / sigmas[i][c]);
        sum += 0.5 * robust_cost(chi2, cutoff(problem), &divisor);
    }
    return sum / inflation + prior_objective(problem, u);
}

// The normal equations of one channel of a shot: its cells depend on the same unknowns.
class ChannelEquations {
public:
    void add(const Prediction &prediction, double weight, double weighted_residual) {
        count_ = static_cast<size_t>(prediction.count);
        index_ = prediction.index;
        for (size_t a = 0; a < count_; a++) {
            const double slope = weight * prediction.derivative[a];
            gradient_[a] += weighted_residual * prediction.derivative[a];
            for (size_t b = 0; b <= a; b++) hessian_[a][b] += slope * prediction.derivative[b];
        }
    }

    void add_to(Eigen::MatrixXd &hessian, Eigen::VectorXd &gradient) const {
        for (size_t a = 0; a < count_; a++) {
            gradient[index_[a]] += gradient_[a];
            for (size_t b = 0; b < a; b++) {
                hessian(index_[a], index_[b]) += hessian_[a][b];
                hessian(index_[b], index_[a]) += hessian_[a][b];
            }
            hessian(index_[a], index_[a]) += hessian_[a][a];
        }
    }

private:
    static constexpr size_t kMost = Prediction::kMaxEntries;
    size_t count_ = 0;
    std::array<int, kMost> index_{};
    std::array<double, kMost> gradient_{};
    std::array<std::array<double, kMost>, kMost> hessian_{};
};

// Restricted to the free unknowns.
QuadraticModel normal_equations(const FlatProblem &problem, const Eigen::VectorXd &u, const Sigmas &sigmas,
                                double inflation) {
    const size_t channels = channels_of(problem);
    std::vector<ChannelEquations> equations(channels * static_cast<size_t>(problem.model.shots));
    const FlatLight light(problem.model, u);
    QuadraticModel normal;
    for (size_t i = 0; i < sigmas.size(); i++) {
        const FlatCell &cell = problem.cells[i];
        const auto predicted = light.with_derivatives(cell.shot, cell.x, cell.y);
        double residual[3], chi2 = 0.0, divisor;
        for (size_t c = 0; c < channels; c++) {
            residual[c] = (cell.value[c] - predicted[c].value) / sigmas[i][c];
            chi2 += residual[c] * residual[c];
        }
        normal.objective += 0.5 * robust_cost(chi2, cutoff(problem), &divisor);
        for (size_t c = 0; c < channels; c++)
            equations[channels * static_cast<size_t>(cell.shot) + c].add(
                predicted[c], 1.0 / (divisor * square(sigmas[i][c])), residual[c] / (divisor * sigmas[i][c]));
    }
    const int n = problem.model.unknowns();
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    for (const ChannelEquations &part : equations) part.add_to(hessian, gradient);
    normal.hessian =
        hessian(problem.free, problem.free) / inflation + problem.prior.precision(problem.free, problem.free);
    gradient = gradient / inflation + problem.prior.precision * (problem.prior.mean - u);
    normal.gradient = gradient(problem.free);
    normal.objective = normal.objective / inflation + prior_objective(problem, u);
    return normal;
}

bool is_falloff(const FlatModel &model, const Eigen::VectorXd &u) {
    for (int curve = 0; curve < model.curves; curve++) {
        lensprof_vignetting v = falloff_of(model, u, curve);  // a logarithm is always above 0
        if (lensprof_vignetting_validate(&v) != LENSPROF_OK) return false;
    }
    return u.allFinite();
}

// Steps until the objective converges, with sigmas held.
void descend(const FlatProblem &problem, FlatEstimate &estimate, DescentLimits limits, FlatSteps &steps) {
    limits.steps = std::min(limits.steps, std::max(steps.left, 0));
    const Sigmas sigmas = all_sigmas(problem, estimate);
    const auto moved = [&](const Eigen::VectorXd &change) {
        Eigen::VectorXd next = estimate.u;
        next(problem.free) += change;
        return next;
    };
    const auto objective_after = [&](const Eigen::VectorXd &change) {
        const Eigen::VectorXd next = moved(change);
        return is_falloff(problem.model, next) ? objective(problem, next, sigmas, estimate.inflation) : INFINITY;
    };
    const Descent descent = levenberg_marquardt(
        limits, [&] { return normal_equations(problem, estimate.u, sigmas, estimate.inflation); }, objective_after,
        [&](const Eigen::VectorXd &change) { estimate.u = moved(change); });
    estimate.converged = descent.converged;
    estimate.iterations += static_cast<uint32_t>(descent.steps);
    steps.left -= descent.steps;
}

// Residuals of all cells, (E - P) / sigma / scale, and their chi-squared.
struct Scaled {
    std::vector<std::array<double, 3>> z;
    std::vector<double> chi2;
};

// Ratio of the variance of the residuals' sums over blocks to that of independent cells.
double block_inflation(const FlatProblem &problem, const Scaled &residuals, int side) {
    const CellGrid &grid = problem.model.grid;
    const int across = (grid.columns + side - 1) / side, blocks = across * ((grid.rows + side - 1) / side);
    double worst = 1.0;
    for (int curve = 0; curve < problem.model.curves; curve++) {
        std::vector<double> sum(static_cast<size_t>(blocks)), count(sum.size());
        for (size_t i = 0; i < problem.cells.size(); i++) {
            if (residuals.chi2[i] > inlier_limit(problem.model.channels)) continue;
            const int cell = problem.cells[i].cell, row = cell / grid.columns, column = cell - row * grid.columns;
            const auto block = static_cast<size_t>(row / side * across + column / side);
            for (int c = 0; c < problem.model.channels; c++)
                if (problem.model.curve_of(c) == curve) {
                    sum[block] += residuals.z[i][static_cast<size_t>(c)];
                    count[block] += 1.0;
                }
        }
        double ratio = 0.0, used = 0.0;
        for (size_t b = 0; b < sum.size(); b++)
            if (count[b] >= 16.0) ratio += sum[b] * sum[b] / count[b], used += 1.0;
        if (used > 0.0) worst = std::max(worst, ratio / used);
    }
    return worst;
}

// Unevenness, from relative residuals and the relative variance of their noise, robust against outlier cells.
double unevenness(const FlatProblem &problem, const std::vector<std::array<double, 3>> &predicted) {
    std::vector<double> squares, noises;
    for (size_t i = 0; i < predicted.size(); i++)
        for (size_t c = 0; c < static_cast<size_t>(problem.model.channels); c++) {
            double p = predicted[i][c], r = problem.cells[i].value[c] / p - 1.0;
            squares.push_back(r * r);
            noises.push_back(problem.cells[i].variance[c] / (p * p));
        }
    double excess = median(squares) / kMedianChi2 - median(noises);
    return std::sqrt(std::max(excess, 0.0));
}

// Mean square of the residuals without outliers, per degree of freedom.
double residual_variance(const FlatProblem &problem, const std::vector<double> &chi2) {
    std::vector<double> order = chi2;
    const int channels = problem.model.channels;
    double variance = std::max(median(order) / (channels == 3 ? kMedianChi2Of3 : kMedianChi2), 1e-12);
    for (int round = 0; round < 10; round++) {
        double sum = 0.0, count = 0.0;
        for (double value : chi2)
            if (value < inlier_limit(channels) * variance) sum += value, count += channels;
        if (count > 0.0) variance = sum / count / (channels == 3 ? kInlierSquare3 : kInlierSquare);
    }
    const auto data = static_cast<double>(channels) * static_cast<double>(chi2.size());
    return variance * data / std::max(data - static_cast<double>(problem.free.size()), 1.0);
}

// Unevenness, scale and inflation from the residuals.
void measure_noise(const FlatProblem &problem, FlatEstimate &estimate) {
    const size_t channels = channels_of(problem), cells = problem.cells.size();
    std::vector<std::array<double, 3>> predicted(cells);
    const FlatLight light(problem.model, estimate.u);
    for (size_t i = 0; i < cells; i++)
        predicted[i] = light.at(problem.cells[i].shot, problem.cells[i].x, problem.cells[i].y);
    estimate.unevenness = unevenness(problem, predicted);
    Scaled residuals{std::vector<std::array<double, 3>>(cells), std::vector<double>(cells)};
    for (size_t i = 0; i < cells; i++)
        for (size_t c = 0; c < channels; c++) {
            const double sigma = sigma_of(estimate, problem.cells[i].variance[c], predicted[i][c]);
            residuals.z[i][c] = (problem.cells[i].value[c] - predicted[i][c]) / sigma;
            residuals.chi2[i] += residuals.z[i][c] * residuals.z[i][c];
        }
    estimate.scale = std::max(std::sqrt(residual_variance(problem, residuals.chi2)), kSmallestScale);
    for (size_t i = 0; i < cells; i++) {
        residuals.chi2[i] /= estimate.scale * estimate.scale;
        for (size_t c = 0; c < channels; c++) residuals.z[i][c] /= estimate.scale;
    }
    estimate.inflation = 1.0;
    for (int side : kBlocks)
        estimate.inflation = std::max(estimate.inflation, block_inflation(problem, residuals, side));
}

// Least squares of the logarithm of the first shot's light, as if the light were even.
void start_logarithm(const FlatProblem &problem, int curve, Eigen::VectorXd &u) {
    const FlatModel &model = problem.model;
    const lensprof_vignetting middle = falloff_of(model, u, curve);
    std::vector<PowerSample> samples;
    for (const FlatCell &cell : problem.cells) {
        const auto c = static_cast<size_t>(model.curves == 3 ? curve : model.channels / 2);
        const double e = cell.value[c], weight = 1.0 / (cell.variance[c] / (e * e) + kStartNoise * kStartNoise);
        const double r2 = lensprof_vignetting_r2(&middle, model.grid.width, model.grid.height, cell.x, cell.y, nullptr);
        double slope;
        if (cell.shot == problem.cells.front().shot)
            samples.push_back({power_base(model.form, r2, &slope), std::log(e), weight});
    }
    constexpr int kPower[kMaxPowers] = {0, 1, 2, 3, 4, 5};
    const PowerTerms terms = fit_powers(kPower, kMaxPowers, static_cast<int>(samples.size()), 1,
                                        [&](int i) { return samples[static_cast<size_t>(i)]; });
    for (int n = 0; n + 1 < kMaxPowers; n++) u[model.k(curve) + n] = terms[n + 1];
}

}  // namespace

FlatPrior make_flat_prior(const lensprof_flat_options &options, const FlatModel &model) {
    const int n = model.unknowns();
    FlatPrior prior{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
    Prior lens = make_prior(options.prior_weight, model.curves, 1);
    make_falloff_linear(model.curves, lens);
    // The prior knows k1..k3; the terms of a logarithm are free.
    const int first = model.form == FalloffForm::powers ? 0 : model.center();
    auto column = [&](int i) { return i < model.center() ? kFalloff + i : kCenter + i - model.center(); };
    for (int i = first; i < model.levels(); i++) {
        prior.mean[i] = lens.mean[column(i)];
        for (int j = first; j < model.levels(); j++) prior.precision(i, j) = lens.precision(column(i), column(j));
    }
    for (int shot = 0; shot < model.shots && model.several; shot++) {
        double sigma = options.ev_sigma * kLn2;
        prior.precision(model.exposure_error(shot), model.exposure_error(shot)) = 1.0 / (sigma * sigma);
    }
    return prior;
}

std::vector<int> free_unknowns(const FlatModel &model, uint32_t free) {
    const uint32_t flags[3] = {LENSPROF_FREE_K1, LENSPROF_FREE_K2, LENSPROF_FREE_K3};
    std::vector<int> unknowns;
    for (int i = 0; i < model.unknowns(); i++) {
        bool held = i < model.center()   ? model.form == FalloffForm::powers && !(free & flags[i % 3])
                    : i < model.levels() ? !(free & LENSPROF_FREE_CENTER)
                                         : false;
        if (!held) unknowns.push_back(i);
    }
    return unknowns;
}

Eigen::VectorXd flat_start(const FlatProblem &problem, const lensprof_vignetting &given) {
    const FlatModel &model = problem.model;
    Eigen::VectorXd u = Eigen::VectorXd::Zero(model.unknowns());
    set_falloff(model, given, u);
    for (int i : problem.free)
        if (i < model.levels()) u[i] = 0.0;
    if (!is_falloff(model, u)) set_falloff(model, given, u);
    for (int curve = 0; curve < model.curves && model.form == FalloffForm::logarithm; curve++)
        start_logarithm(problem, curve, u);
    for (int shot = 0; shot < (model.several ? 1 : model.shots); shot++)
        for (int c = 0; c < model.channels; c++) {
            std::vector<double> values;
            const int curve = model.curve_of(c);
            const lensprof_vignetting v = falloff_of(model, u, curve);
            for (const FlatCell &cell : problem.cells)
                if (model.several || cell.shot == shot) {
                    const double r2 =
                        lensprof_vignetting_r2(&v, model.grid.width, model.grid.height, cell.x, cell.y, nullptr);
                    values.push_back(std::log(cell.value[static_cast<size_t>(c)] / falloff_value(model, u, curve, r2)));
                }
            u[model.level(shot, c)] = median(values);
        }
    return u;
}

std::vector<double> flat_chi2(const FlatProblem &problem, const FlatEstimate &estimate) {
    const FlatLight light(problem.model, estimate.u);
    std::vector<double> chi2;
    chi2.reserve(problem.cells.size());
    for (const FlatCell &cell : problem.cells) {
        const auto predicted = light.at(cell.shot, cell.x, cell.y);
        double sum = 0.0;
        for (size_t c = 0; c < channels_of(problem); c++)
            sum += square((cell.value[c] - predicted[c]) / sigma_of(estimate, cell.variance[c], predicted[c]));
        chi2.push_back(sum / square(estimate.scale));
    }
    return chi2;
}

double flat_cost(const FlatProblem &problem, const FlatEstimate &estimate) {
    double sum = 0.0, divisor;
    for (double chi2 : flat_chi2(problem, estimate)) sum += 0.5 * robust_cost(chi2, cutoff(problem), &divisor);
    return sum / estimate.inflation + prior_objective(problem, estimate.u);
}

void refine_flat(const FlatProblem &problem, FlatEstimate &estimate, FlatSteps &steps) {
    auto state = [&] { return Eigen::Vector3d(estimate.unevenness, estimate.scale, estimate.inflation); };
    measure_noise(problem, estimate);
    for (int round = 0; round < kRounds && !steps.are_over(); round++) {
        Eigen::Vector3d before = state();
        descend(problem, estimate, round < kShortRounds ? kShortLimits : kLimits, steps);
        measure_noise(problem, estimate);
        if (estimate.converged && (state() - before).norm() < kNoiseTolerance * before.norm()) break;
    }
}

void solve_flat(const FlatProblem &problem, FlatEstimate &estimate, FlatSteps &steps) {
    // The first fit holds the centre and counts cells as independent: before the falloff is near its solution, the
    // errors of all cells are correlated, and the priors would be too strong.
    FlatProblem held = problem;
    const FlatModel &model = problem.model;
    auto is_center = [&](int i) { return i >= model.center() && i < model.levels(); };
    held.free.erase(std::remove_if(held.free.begin(), held.free.end(), is_center), held.free.end());
    measure_noise(held, estimate);
    estimate.inflation = 1.0;
    descend(held, estimate, kRoughLimits, steps);
    refine_flat(problem, estimate, steps);
}

Eigen::MatrixXd flat_covariance(const FlatProblem &problem, const FlatEstimate &estimate) {
    const Eigen::MatrixXd hessian =
        normal_equations(problem, estimate.u, all_sigmas(problem, estimate), estimate.inflation).hessian;
    Eigen::VectorXd size = hessian.diagonal().cwiseSqrt();
    if (!(size.minCoeff() > 0.0)) return {};
    Eigen::MatrixXd scaled = size.cwiseInverse().asDiagonal() * hessian * size.cwiseInverse().asDiagonal();
    Eigen::LDLT<Eigen::MatrixXd> factor(scaled);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > kSmallestPivot)) return {};
    Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols()));
    inverse = size.cwiseInverse().asDiagonal() * inverse * size.cwiseInverse().asDiagonal();
    inverse = 0.5 * (inverse + inverse.transpose()).eval();
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(problem.model.unknowns(), problem.model.unknowns());
    full(problem.free, problem.free) = inverse;
    return full;
}

}  // namespace lensprof
