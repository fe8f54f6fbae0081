#include "fit/solver/solver.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Cholesky>

#include "fit/solver/constrained_step.hpp"
#include "fit/solver/inflation.hpp"
#include "fit/solver/objective.hpp"

namespace lensprof {
namespace {

constexpr double kLargestLogBalance = 12.0;  // white balance factors stay valid, 1e-6..1e6
constexpr double kHeldFirmly =
    1e4;  // factor relative to the fit: gamma's own error is stated separately from the data's

// One accepted Levenberg-Marquardt step; false if no damping finds an improvement. The model of the accepted point is
// kept for the next step. falloff/levenberg_marquardt.hpp is not used because it is for few unknowns without
// constraints. Here the images are eliminated from each model (which may fail), the step satisfies inequalities, and
// evaluations are expensive, so that after a failure only the value is computed first.
struct Stepper {
    const Problem &problem;
    const Objective &objective;
    double flat;  // a step with a smaller expected gain is not evaluated
    bool falls;   // whether no falloff may rise
    std::unique_ptr<NormalEquations> model;
    double lambda = 1e-4;
    int steps = 0;
    bool is_solved = false;  // whether some step could be computed

    Estimate moved(const Estimate &from, const Eigen::VectorXd &d) const {
        Estimate to = from;
        Eigen::VectorXd full = shared_vector(from);
        for (size_t u = 0; u < model->columns().size(); u++)
            full[model->columns()[u]] += d[static_cast<Eigen::Index>(u)];
        set_shared(to, full, problem.vignettings);
        auto step = model->image_step(d);
        const auto zero = from.log_exposure[problem.reference];
        for (size_t i = 0; i < step.size(); i++) {
            auto &a = to.log_exposure[i];
            for (size_t c = 0; c < 3; c++)
                if (step[i][c] != 0.0)
                    a[c] = std::clamp(a[c] + step[i][c], zero[c] - kLargestLogExposure, zero[c] + kLargestLogExposure);
            for (size_t c : {0, 2})
                if (problem.balance_unknown[i][c] >= 0)
                    a[c] = std::clamp(a[c], a[1] - kLargestLogBalance, a[1] + kLargestLogBalance);
        }
        return to;
    }

    bool step(Estimate &estimate, double &cost) {
        is_solved = false;
        if (!model) model = objective.model_at(estimate);
        Region region{estimate.modes,   problem.vignettings,     problem.settings,
                      model->columns(), shared_vector(estimate), falls};
        for (int attempt = 0; attempt < 12; attempt++, lambda *= 8.0) {
            if (!model->reduce(lambda)) continue;
            Eigen::VectorXd d = constrained_step(region, model->reduced_hessian(), model->reduced_gradient());
            if (!d.allFinite()) continue;
            is_solved = true;
            if (attempt == 0 && model->expected_gain(d) < flat) break;
            Estimate candidate = moved(estimate, d);
            // After a failure another is likely: the value alone is cheaper than a model.
            if (attempt > 0 && !(objective.value_at(candidate) < model->objective())) continue;
            auto next = objective.model_at(candidate);
            if (!(next->objective() < model->objective())) continue;
            estimate = candidate;
            model = std::move(next);
            cost = model->objective();
            lambda = std::max(lambda * 0.1, 1e-9);
            steps++;
            return true;
        }
        cost = model->objective();
        return false;
    }
};

}  // namespace

double largest_change(const Estimate &a, const Estimate &b) {
    double largest = 0.0;
    for (size_t j = 0; j < a.curve.table.size(); j += 31)
        largest = std::max(largest, std::abs(a.curve.table[j] - b.curve.table[j]));
    for (size_t s = 0; s < a.vignetting.size(); s++) {
        const Falloffs &of_a = a.vignetting[s], &of_b = b.vignetting[s];
        for (size_t c = 0; c < 3; c++)
            for (double r2 : {0.25, 0.5, 1.0})
                largest = std::max(largest, std::abs(lensprof_vignetting_eval(&of_a[c], r2, nullptr)
                                                     - lensprof_vignetting_eval(&of_b[c], r2, nullptr)));
        for (int d = 0; d < 2; d++) largest = std::max(largest, std::abs(of_a[0].center[d] - of_b[0].center[d]));
    }
    for (size_t i = 0; i < a.log_exposure.size(); i++)
        for (size_t c = 0; c < 3; c++)
            largest = std::max(largest, std::abs(a.log_exposure[i][c] - b.log_exposure[i][c]));
    return largest;
}

Outcome solve(const Problem &problem, const Prior &prior, Gauge &gauge, Loss &loss, bool refine_noise,
              const Control &control, Estimate &estimate) {
    constexpr double kStill = 3e-5;  // largest visible change in a step at convergence
    constexpr int kNoiseRounds = 4, kHeldRounds = 10;
    Prior renewed = prior_of(prior, estimate.modes);
    Outcome outcome;
    // Exposures that are held firmly and their common offset converge slowly together.
    for (int round = 0; round < control.rounds * (renewed.renews_offset ? kHeldRounds : 1); round++) {
        Estimate before = estimate;
        if (refine_noise && round < kNoiseRounds) loss.noise = estimate_noise(problem, estimate, loss.noise);
        gauge.renew(problem, estimate, renewed);
        std::unique_ptr<Objective> objective = make_objective(problem, renewed, loss, estimate);
        Stepper stepper{problem, *objective, control.flat, control.falls, nullptr};
        outcome.converged = false;
        while (!outcome.converged && outcome.iterations < control.max_iterations) {
            if (control.cancelled && control.cancelled()) throw Cancelled();
            Estimate previous = estimate;
            double last = outcome.cost;
            outcome.iterations++;
            bool improved = stepper.step(estimate, outcome.cost);
            bool flat = stepper.steps > 1 && last - outcome.cost < control.flat;
            if (!improved && !stepper.is_solved) return outcome;
            outcome.converged = !improved || flat || largest_change(previous, estimate) < kStill;
        }
        if (outcome.iterations >= control.max_iterations || largest_change(before, estimate) < 5 * kStill) break;
    }
    return outcome;
}

Covariance covariance(const Problem &problem, const Prior &prior, Gauge &gauge, const Loss &loss,
                      const Estimate &estimate, const Inflation *inflation) {
    Covariance result;
    result.shared = Eigen::MatrixXd::Zero(shared_size(problem.settings), shared_size(problem.settings));
    result.images = Eigen::VectorXd::Zero(problem.image_unknowns);
    Prior renewed = prior_of(prior, estimate.modes);
    gauge.renew(problem, estimate, renewed);
    renewed.pin_precision *= kHeldFirmly;
    for (auto &known : renewed.known) known.precision /= known.hold;
    std::unique_ptr<NormalEquations> about = make_objective(problem, renewed, loss, estimate)->model_at(estimate);
    NormalEquations &model = *about;
    auto n = static_cast<Eigen::Index>(model.columns().size());
    if (!model.reduce(0.0)) return result;
    Eigen::MatrixXd inverse(n, n);
    if (n) {
        Eigen::LLT<Eigen::MatrixXd> factor(model.reduced_hessian());
        if (factor.info() != Eigen::Success) return result;  // not determined: no covariance
        inverse = factor.solve(Eigen::MatrixXd::Identity(n, n));
        if (!inverse.allFinite() || inverse.diagonal().minCoeff() <= 0.0) return result;
    }
    if (inflation) {
        Eigen::VectorXd scale(n);
        for (Eigen::Index u = 0; u < n; u++)
            scale[u] = std::sqrt(inflation->of_column(model.columns()[static_cast<size_t>(u)]));
        inverse = scale.asDiagonal() * inverse * scale.asDiagonal();
    }
    for (Eigen::Index u = 0; u < n; u++)
        for (Eigen::Index v = 0; v < n; v++)
            result.shared(model.columns()[static_cast<size_t>(u)], model.columns()[static_cast<size_t>(v)]) =
                0.5 * (inverse(u, v) + inverse(v, u));
    if (problem.image_unknowns) result.images = model.image_variance(inverse, inflation ? inflation->exposures : 1.0);
    result.is_determined = result.images.allFinite();
    return result;
}

}  // namespace lensprof
