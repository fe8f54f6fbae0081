// The radiance method's model: exact radiances, derivatives, elimination, trust in observations.
#include "core/exposure.h"
#include "falloff_prior_terms.hpp"
#include "simulated_tracks.hpp"

#include <Eigen/Core>

#include "falloff/dense.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/solver/objective.hpp"
#include "fit/solver/radiance_equations.hpp"

using namespace lensprof;

namespace {

// Tracks of 2 to 4 observations on four images, some saturated, and an estimate a few levels away from the truth. f is
// piecewise linear; if residuals are large, radiances end on its kinks, which have no derivative.
struct Setting {
    TrackSimulation simulation;
    lensprof_fit_options options = radiance_fit();
    Problem problem;
    Estimate estimate;
    Loss loss;

    explicit Setting(uint32_t channels, uint32_t points, uint32_t kind) {
        simulation.response = srgb_response();
        simulation.channels = channels;
        simulation.images = 4;
        simulation.longest = 4;
        simulation.brightest = 1.6;
        simulation.make_tracks(points, 1.0, 0.0, 1.0, 7);
        options.channels = channels;
        simulation.fit_images[3].ev_of = 2;  // a linked exposure
        simulation.fit_images[2].free &= ~LENSPROF_FREE_RED;
        simulation.fit_images[1].setting = simulation.fit_images[3].setting = channels == 3 ? 5 : 0;
        const auto &all = simulation.observations;
        Tracks tracks = tracks_of(all.data(), static_cast<uint32_t>(all.size()));
        std::vector<uint32_t> keep;
        for (uint32_t t = 0; t < tracks.tracks.size(); t++) keep.push_back(t);
        problem = make_problem(options, simulation.fit_images.data(), 4, tracks, keep);
        problem.vignettings = static_cast<int>(channels);
        std::vector<double> emor = project_curve(simulation.response.table, 6);
        emor[0] += 0.05, emor[1] -= 0.02;
        set_response(estimate, emor.data(), 6);
        const lensprof_vignetting first{{-0.28, 0.06, -0.16}, {0.03, -0.02}}, second{{-0.2, 0.0, -0.1}, {0.0, 0.01}};
        estimate.vignetting = {{first, first, first}};
        if (problem.settings == 2) estimate.vignetting.push_back({second, second, second});
        uint64_t random = 3;
        for (uint32_t i = 0; i < 4; i++) {
            estimate.log_exposure.push_back({});
            for (uint32_t c = 0; c < 3; c++)
                estimate.log_exposure[i][c] =
                    std::log(lp_exposure_factor(&simulation.exposures[i], c)) + 0.03 * (lp_random(&random) - 0.5);
        }
        loss.kind = kind;
    }

    // The estimate moved by h along unknown u: the free shared unknowns come first, then those of the images.
    Estimate moved(const std::vector<int> &columns, int u, double h) const {
        Estimate e = estimate;
        int shared = static_cast<int>(columns.size());
        if (u < shared) {
            Eigen::VectorXd full = shared_vector(e);
            full[columns[static_cast<size_t>(u)]] += h;
            set_shared(e, full, problem.vignettings);
            return e;
        }
        for (uint32_t i = 0; i < 4; i++)
            for (int c = 0; c < problem.channels; c++)
                for (int q : {problem.ev_unknown[i], problem.balance_unknown[i][c]})
                    if (q == u - shared) e.log_exposure[i][c] += h;
        return e;
    }
};

// Every radiance minimises its track's sum of squares: no other radiance nearby is better, and the slope is 0.
void test_radiances_are_at_their_minimum(void **) {
    for (uint32_t kind : {LENSPROF_LOSS_SQUARED, LENSPROF_LOSS_HUBER}) {
        Setting s(3, 200, kind);
        const TrackEvaluator evaluator(s.problem, s.estimate, s.loss);
        Trust trust = trust_all(s.problem);
        TrackFit fit;
        auto cost = [&](const std::vector<Sighting> &sightings, double radiance) {
            double sum = 0.0;
            for (const Sighting &one : sightings) {
                double e = one.value - response_at(s.estimate, one.factor * radiance, nullptr);
                if ((one.kind == Sighting::Kind::at_least && e < 0) || (one.kind == Sighting::Kind::at_most && e > 0))
                    continue;
                bool far = kind == LENSPROF_LOSS_HUBER && std::abs(e) > s.loss.huber;
                sum += far ? 2 * s.loss.huber * std::abs(e) - s.loss.huber * s.loss.huber : e * e;
            }
            return sum;
        };
        for (const Range &track : s.problem.tracks.tracks) {
            evaluator.evaluate(track, trust.data(), fit);
            for (size_t c = 0; c < 3; c++) {
                double own = cost(fit.channel[c], fit.radiance[c]);
                for (double step : {1e-3, 1e-2})
                    for (double sign : {-1.0, 1.0})
                        assert_true(cost(fit.channel[c], fit.radiance[c] * (1 + sign * step)) >= own - 1e-12);
            }
        }
    }
}

// A prior with all its parts.
Prior full_prior(const Problem &problem) {
    Prior prior = prior_of(make_prior(1.0, problem.vignettings, problem.settings, true), 6);
    for (int l = 0; l < 6; l++) prior.pin[l] = 0.3 - 0.1 * l;
    prior.pin_value = 0.2;
    prior.pin_precision = 50.0;
    prior.known.resize(problem.image_count);
    prior.known[1] = {0.1, 30.0};
    return prior;
}

// The objective, computed independently: the radiances are found again for every estimate.
double objective(const Setting &s, const Prior &prior, const Trust &trust, const Estimate &estimate) {
    return radiance_cost(s.problem, estimate, s.loss, trust)
           + prior_cost(prior, s.problem, free_columns(s.problem, estimate.modes), estimate);
}

// The gradient by the shared unknowns, with the images held, is that of the objective with the radiances following.
void test_gradient_of_the_reduced_objective(void **) {
    for (uint32_t kind : {LENSPROF_LOSS_ROBUST, LENSPROF_LOSS_HUBER, LENSPROF_LOSS_SQUARED})
        for (uint32_t channels : {1u, 3u}) {
            Setting s(channels, 150, kind);
            s.problem.image_unknowns = 0;
            for (uint32_t i = 0; i < 4; i++) s.problem.ev_unknown[i] = -1, s.problem.balance_unknown[i] = {-1, -1, -1};
            Prior prior = full_prior(s.problem);
            Trust trust = trust_all(s.problem);
            RadianceEquations model(s.problem, prior, s.loss, trust, s.estimate, ModeTable(6));
            assert_close(model.objective(), objective(s, prior, trust, s.estimate), 1e-9 * model.objective());
            assert_true(model.reduce(0.0));
            const auto &gradient = model.reduced_gradient();
            double scale = gradient.norm();
            const double h = 1e-4;
            for (int u = 0; u < static_cast<int>(model.columns().size()); u++) {
                double high = objective(s, prior, trust, s.moved(model.columns(), u, h));
                double low = objective(s, prior, trust, s.moved(model.columns(), u, -h));
                assert_close(-(high - low) / (2 * h), gradient[u], 5e-3 * std::abs(gradient[u]) + 5e-4 * scale);
            }
        }
}

// Along the step that the model proposes for all unknowns together, the objective falls at the predicted rate; this
// checks the images' part of the gradient.
void test_descent_along_a_joint_step(void **) {
    for (uint32_t kind : {LENSPROF_LOSS_ROBUST, LENSPROF_LOSS_HUBER, LENSPROF_LOSS_SQUARED}) {
        Setting s(3, 300, kind);
        Prior prior = full_prior(s.problem);
        Trust trust = trust_all(s.problem);
        RadianceEquations model(s.problem, prior, s.loss, trust, s.estimate, ModeTable(6));
        assert_true(model.reduce(0.0));
        Eigen::VectorXd d = solve_symmetric(model.reduced_hessian(), model.reduced_gradient());
        auto images = model.image_step(d);
        auto at = [&](double t) {
            Estimate e = s.estimate;
            Eigen::VectorXd full = shared_vector(e);
            for (size_t u = 0; u < model.columns().size(); u++)
                full[model.columns()[u]] += t * d[static_cast<Eigen::Index>(u)];
            set_shared(e, full, s.problem.vignettings);
            for (size_t i = 0; i < images.size(); i++)
                for (int c = 0; c < 3; c++) e.log_exposure[i][c] += t * images[i][c];
            return objective(s, prior, trust, e);
        };
        double h = 1e-5, slope = (at(h) - at(-h)) / (2 * h), promised = -2.0 * model.expected_gain(d);
        assert_close(slope, promised, 0.01 * std::abs(promised));
    }
}

// The residuals of all tracks with radiances fixed at the setting's estimate, times exp(shift).
class HeldRadiances {
public:
    HeldRadiances(const Setting &s, const Trust &trust) : s_(s), trust_(trust), at_(s.problem.tracks.tracks.size()) {
        const TrackEvaluator evaluator(s.problem, s.estimate, s.loss);
        for (size_t t = 0; t < at_.size(); t++) evaluator.evaluate(s.problem.tracks.tracks[t], trust.data(), at_[t]);
    }

    Eigen::VectorXd residuals(const Estimate &e, double shift) const {
        const TrackEvaluator evaluator(s_.problem, e, s_.loss);
        std::vector<double> values;
        TrackFit fit;
        for (size_t t = 0; t < at_.size(); t++) {
            evaluator.evaluate(s_.problem.tracks.tracks[t], trust_.data(), fit);
            for (size_t c = 0; c < 3; c++)
                for (const Sighting &one : fit.channel[c]) {
                    double x = one.factor * at_[t].radiance[c] * std::exp(shift);
                    double r = one.value - response_at(e, x, nullptr);
                    bool holds = (one.kind == Sighting::Kind::at_least && r < 0)
                                 || (one.kind == Sighting::Kind::at_most && r > 0) || at_[t].radiance[c] == 0.0;
                    values.push_back(holds ? 0.0 : r);
                }
        }
        return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    }

    // By `outer` unknowns (columns, then the images'), then by the logarithm of every radiance.
    Eigen::MatrixXd jacobian(const std::vector<int> &columns, Eigen::Index outer) const {
        const double h = 1e-7;
        auto count = static_cast<Eigen::Index>(at_.size());
        Eigen::VectorXd by_radiance = (residuals(s_.estimate, h) - residuals(s_.estimate, -h)) / (2 * h);
        Eigen::MatrixXd result = Eigen::MatrixXd::Zero(by_radiance.size(), outer + 3 * count);
        for (Eigen::Index u = 0; u < outer; u++)
            result.col(u) = (residuals(s_.moved(columns, static_cast<int>(u), h), 0.0)
                             - residuals(s_.moved(columns, static_cast<int>(u), -h), 0.0))
                            / (2 * h);
        Eigen::Index row = 0;
        for (Eigen::Index t = 0; t < count; t++)
            for (Eigen::Index c = 0; c < 3; c++)
                for (size_t i = 0; i < at_[static_cast<size_t>(t)].lens.size(); i++, row++)
                    result(row, outer + 3 * t + c) = by_radiance[row];
        return result;
    }

private:
    const Setting &s_;
    const Trust &trust_;
    std::vector<TrackFit> at_;
};

// The prior's contribution to the full system.
void add_prior(const Setting &s, const Prior &prior, const std::vector<int> &columns, Eigen::MatrixXd &hessian,
               Eigen::VectorXd &gradient) {
    auto shared = static_cast<Eigen::Index>(columns.size());
    Eigen::VectorXd full = shared_vector(s.estimate), pin = Eigen::VectorXd::Zero(gradient.size());
    for (Eigen::Index u = 0; u < shared; u++) {
        int own = columns[static_cast<size_t>(u)];
        if (own < kMaxModes) pin[u] = prior.pin[own];
        for (Eigen::Index v = 0; v < shared; v++) {
            int other = columns[static_cast<size_t>(v)];
            hessian(u, v) += prior.precision(own, other);
            gradient[u] -= prior.precision(own, other) * (full[other] - prior.mean[other]);
        }
    }
    hessian += prior.pin_precision * pin * pin.transpose();
    gradient -= prior.pin_precision * (prior.pin.dot(full.head(kMaxModes)) - prior.pin_value) * pin;
    add_falloff_prior(s.problem, s.estimate, prior, columns, hessian, gradient);
    Eigen::Index known = shared + s.problem.ev_unknown[1];
    hessian(known, known) += prior.known[1].precision;
    gradient[known] -= prior.known[1].precision * (s.estimate.log_exposure[1][1] - prior.known[1].log_exposure);
    for (int q = 0; q < s.problem.image_unknowns; q++) hessian(shared + q, shared + q) += 2e-3;
}

// One dense system from numeric derivatives, with the radiances as ordinary unknowns, has the same solution and the
// same inverse.
void test_elimination_equals_full_solve(void **) {
    Setting s(3, 120, LENSPROF_LOSS_SQUARED);
    Prior prior = full_prior(s.problem);
    Trust trust = trust_all(s.problem);
    RadianceEquations model(s.problem, prior, s.loss, trust, s.estimate, ModeTable(6));
    assert_true(model.reduce(0.0));
    Eigen::VectorXd shared_step = solve_symmetric(model.reduced_hessian(), model.reduced_gradient());
    auto image_step = model.image_step(shared_step);

    Eigen::Index shared = shared_step.size(), outer = shared + s.problem.image_unknowns;
    const HeldRadiances held(s, trust);
    Eigen::MatrixXd jacobian = held.jacobian(model.columns(), outer);
    double scale = 1.0 / (s.loss.noise * s.loss.noise);
    Eigen::MatrixXd hessian = scale * jacobian.transpose() * jacobian;
    Eigen::VectorXd gradient = -scale * jacobian.transpose() * held.residuals(s.estimate, 0.0);
    add_prior(s, prior, model.columns(), hessian, gradient);
    for (Eigen::Index u = outer; u < hessian.rows(); u++) hessian(u, u) += 1e-9;  // radiances without a measurement
    Eigen::VectorXd step = solve_symmetric(hessian, gradient);
    for (Eigen::Index u = 0; u < shared; u++) assert_close(shared_step[u], step[u], 2e-3 * (0.01 + std::abs(step[u])));
    assert_close(image_step[1][1], step[shared + s.problem.ev_unknown[1]], 2e-4);
    assert_close(image_step[3][1], image_step[2][1], 0.0);  // linked
    assert_close(image_step[2][0], image_step[2][1], 0.0);  // red of image 2 is fixed
    assert_close(image_step[0][0], 0.0, 0.0);               // the reference is unchanged

    Eigen::MatrixXd inverse = inverse_of_symmetric(hessian);
    Eigen::MatrixXd shared_inverse = inverse_of_symmetric(model.reduced_hessian());
    Eigen::VectorXd variance = model.image_variance(shared_inverse, 1.0);
    for (Eigen::Index u = 0; u < shared; u++) assert_close(shared_inverse(u, u), inverse(u, u), 2e-3 * inverse(u, u));
    for (Eigen::Index q = 0; q < s.problem.image_unknowns; q++)
        assert_close(variance[q], inverse(shared + q, shared + q), 2e-3 * inverse(shared + q, shared + q));
}

// At the truth, exactly the replaced observations are distrusted.
void test_distrusts_what_is_wrong(void **) {
    Setting s(3, 300, LENSPROF_LOSS_ROBUST);
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t c = 0; c < 3; c++)
            s.estimate.log_exposure[i][c] = std::log(lp_exposure_factor(&s.simulation.exposures[i], c));
    const lensprof_vignetting &own = s.simulation.vignetting;
    s.estimate.vignetting.assign(static_cast<size_t>(s.problem.settings), {own, own, own});
    s.estimate.modes = -1;
    s.estimate.fixed = s.simulation.response;
    auto &tracks = s.problem.tracks;
    Trust truth = trust_all(s.problem);
    uint64_t random = 17;
    for (const Range &track : tracks.tracks) {
        if (track.last - track.first < 3 || lp_random(&random) < 0.5) continue;
        auto count = static_cast<double>(track.last - track.first);
        size_t wrong = track.first + static_cast<size_t>(lp_random(&random) * count);
        truth[wrong] = 0;
        for (double &v : tracks.observations[wrong].value) v = v < 0.5 ? v + 0.4 : v - 0.4;
    }
    assert_true(find_trust(s.problem, s.estimate, s.loss) == trust_all(s.problem));  // not before find_trust is called
    s.loss.distrusts = true;
    Trust trust = find_trust(s.problem, s.estimate, s.loss);
    size_t wrong = 0, found = 0, false_alarms = 0;
    for (size_t i = 0; i < trust.size(); i++) {
        wrong += !truth[i], found += !truth[i] && !trust[i];
        false_alarms += truth[i] && !trust[i];
    }
    print_message("%zu of %zu wrong observations found, %zu correct ones distrusted\n", found, wrong, false_alarms);
    assert_true(wrong > 60 && found * 10 > wrong * 9 && false_alarms * 20 < wrong);
}

// The prior's covariance is that of measured curves: positive definite, and its first block is the covariance for few
// modes.
void test_prior_covariance(void **) {
    Prior prior = make_prior(1.0, 1, 1, true);
    Estimate estimate;
    for (int modes : {1, 5, 25}) {
        Eigen::MatrixXd precision = prior_of(prior, modes).precision.topLeftCorner(modes, modes);
        Eigen::MatrixXd covariance = inverse_of_symmetric(precision);
        for (int l = 0; l < modes; l++) {
            assert_close(covariance(l, l), kEmorSigma[l] * kEmorSigma[l], 1e-9 * covariance(l, l));
            for (int m = 0; m < l; m++)
                assert_close(covariance(l, m), kEmorSigma[l] * kEmorSigma[m] * kEmorCorrelation[l * (l - 1) / 2 + m],
                             1e-9 * kEmorSigma[l] * kEmorSigma[m]);
        }
        assert_true(is_positive_definite(precision));
    }
    assert_true(prior_of(make_prior(1.0, 1, 1), 5).precision == make_prior(1.0, 1, 1).precision);  // unchanged
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_radiances_are_at_their_minimum), cmocka_unit_test(test_gradient_of_the_reduced_objective),
        cmocka_unit_test(test_descent_along_a_joint_step),     cmocka_unit_test(test_elimination_equals_full_solve),
        cmocka_unit_test(test_distrusts_what_is_wrong),        cmocka_unit_test(test_prior_covariance),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
