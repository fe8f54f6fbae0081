// Every derivative of the fit compared with central differences, and the elimination of the images compared with a full
// solve.
#include "falloff_prior_terms.hpp"
#include "simulated.hpp"

#include <Eigen/Core>

#include "falloff/dense.hpp"
#include "fit/prior/prior.hpp"
#include "fit/problem/residual.hpp"
#include "fit/solver/transfer_equations.hpp"

using namespace lensprof;

namespace {

struct Setting {
    Simulation simulation;
    lensprof_fit_options options;
    Problem problem;
    Estimate estimate;

    // With two lens settings, images 1 and 3 use the second.
    explicit Setting(uint32_t channels, uint32_t count = 60, int settings = 1) {
        simulation.response = srgb_response();
        simulation.channels = channels;
        simulation.images = 4;
        simulation.make(count, 2.0, 0.1, 1.0, 7);
        lensprof_fit_options_init(&options);
        options.channels = channels;
        simulation.fit_images[3].ev_of = 2;  // a linked exposure
        simulation.fit_images[2].free &= ~LENSPROF_FREE_RED;
        for (uint32_t i = 0; i < 4 && settings == 2; i++) simulation.fit_images[i].setting = 7 * (i % 2);
        std::vector<uint32_t> keep;
        for (uint32_t p = 0; p < count; p++) keep.push_back(p);
        problem = make_problem(options, simulation.fit_images.data(), 4, simulation.pairs.data(), keep);
        const double emor[6] = {0.7, -0.4, 0.1, 0.05, -0.02, 0.01};
        set_response(estimate, emor, 6);
        const lensprof_vignetting first{{-0.2, 0.1, -0.1}, {0.05, -0.03}}, second{{-0.4, 0.2, -0.1}, {-0.02, 0.04}};
        estimate.vignetting = {{first, first, first}};
        if (settings == 2) estimate.vignetting.push_back({second, second, second});
        assert_int_equal(problem.settings, settings);
        uint64_t random = 3;
        for (int i = 0; i < 4; i++)
            estimate.log_exposure.push_back(
                {lp_random(&random) - 0.5, lp_random(&random) - 0.5, lp_random(&random) - 0.5});
    }
};

// Residuals of all pairs at an estimate.
std::vector<double> residuals(const Problem &problem, const Estimate &estimate) {
    std::vector<double> values;
    for_each_transfer(problem, estimate, [&](size_t, const PairTransfer &t) {
        for (int c = 0; c < problem.channels; c++)
            for (double r : t.channel[c].residual) values.push_back(r);
    });
    return values;
}

// The response is piecewise linear: if a step crosses a kink, the central difference is not a derivative. With 1024
// pieces and steps of 1e-7 that is rare; such cases are counted.
void compare(const std::vector<double> &analytic, const std::vector<double> &low, const std::vector<double> &high,
             double h, const char *what) {
    size_t kinks = 0;
    for (size_t i = 0; i < analytic.size(); i++) {
        double numeric = (high[i] - low[i]) / (2 * h);
        if (std::abs(analytic[i] - numeric) > 2e-5 * (1.0 + std::abs(numeric))) kinks++;
    }
    if (kinks * 100 > analytic.size()) print_error("%s: %zu of %zu derivatives differ\n", what, kinks, analytic.size());
    assert_true(kinks * 100 <= analytic.size());
}

void test_residual_by_response(void **) {
    Setting s(3);
    const ModeTable modes(6);
    const double h = 1e-7;
    for (int l = 0; l < 6; l++) {
        std::vector<double> analytic;
        for_each_transfer(s.problem, s.estimate, [&](size_t, const PairTransfer &t) {
            for (int c = 0; c < 3; c++)
                for (int side = 0; side < 2; side++) {
                    double by_emor[kMaxModes];
                    modes.transfer_by_emor(t.channel[c], side, 1.0, by_emor);
                    analytic.push_back(-by_emor[l]);
                }
        });
        Estimate low = s.estimate, high = s.estimate;
        low.emor[l] -= h, high.emor[l] += h;
        set_response(low, low.emor.data(), 6), set_response(high, high.emor.data(), 6);
        compare(analytic, residuals(s.problem, low), residuals(s.problem, high), h, "response");
    }
}

// d ln(M1/M2) by unknown u of the falloff curves of a lens setting.
double by_unknown(const Problem &problem, const lensprof_pair &pair, const Falloff &fall, int setting, int u) {
    double by = 0.0;
    for (int side = 0; side < 2; side++) {
        const Attenuation &end = fall.end[side];
        if (problem.setting_of[pair.image[side]] == setting)
            by += (side ? -1.0 : 1.0) * (u < 3 ? end.by_k[u] : end.by_center[u - 3]);
    }
    return by;
}

// One curve for all channels, and one per channel: unknown u of curve `curve` of one lens setting.
void check_residual_by_falloff(int vignettings, int settings, int setting) {
    const double h = 1e-7;
    Setting s(3, 60, settings);
    s.problem.vignettings = vignettings;
    for (int curve = 0; curve < vignettings; curve++)
        for (int u = 0; u < 5; u++) {
            std::vector<double> analytic;
            for_each_transfer(s.problem, s.estimate, [&](size_t p, const PairTransfer &t) {
                for (int c = 0; c < 3; c++)
                    for (int side = 0; side < 2; side++) {
                        const Falloff &fall = t.fall[vignettings == 3 ? c : 0];
                        double by = by_unknown(s.problem, s.problem.pairs[p], fall, setting, u);
                        bool own = u >= 3 || vignettings == 1 || c == curve;
                        analytic.push_back(own ? -t.channel[c].by_delta[side] * by : 0.0);
                    }
            });
            Estimate low = s.estimate, high = s.estimate;
            for (int c = 0; c < 3; c++) {
                if (u < 3 && vignettings == 3 && c != curve) continue;
                lensprof_vignetting &below = low.vignetting[setting][c], &above = high.vignetting[setting][c];
                (u < 3 ? below.k[u] : below.center[u - 3]) -= h;
                (u < 3 ? above.k[u] : above.center[u - 3]) += h;
            }
            compare(analytic, residuals(s.problem, low), residuals(s.problem, high), h, "falloff");
        }
}

void test_residual_by_falloff(void **) {
    for (int vignettings : {1, 3}) {
        check_residual_by_falloff(vignettings, 1, 0);
        for (int setting : {0, 1}) check_residual_by_falloff(vignettings, 2, setting);
    }
}

void test_residual_by_exposure_and_value(void **) {
    Setting s(3);
    const double h = 1e-7;
    std::vector<double> analytic, by_value, value_low, value_high;
    for (const Edge &edge : s.problem.edges) {
        auto exposure = exposure_ratios(s.problem, s.estimate, edge);
        for (size_t p = edge.first; p < edge.last; p++) {
            const auto &pair = s.problem.pairs[p];
            for (int c = 0; c < 3; c++) {
                double ratio = falloff(s.problem, s.estimate, 0, pair).ratio * exposure[c];
                double b1 = pair.value[0][c], b2 = pair.value[1][c];
                by_value.push_back(transfer(s.estimate, b1, b2, ratio).by_value[0]);
                value_low.push_back(-transfer(s.estimate, b1, b2 - h, ratio).residual[0]);
                value_high.push_back(-transfer(s.estimate, b1, b2 + h, ratio).residual[0]);
            }
        }
    }
    compare(by_value, value_low, value_high, h, "grey value");
    for (uint32_t image = 0; image < 4; image++)
        for (int c = 0; c < 3; c++) {
            analytic.clear();
            for_each_transfer(s.problem, s.estimate, [&](size_t p, const PairTransfer &t) {
                const auto &pair = s.problem.pairs[p];
                for (int channel = 0; channel < 3; channel++)
                    for (int side = 0; side < 2; side++) {
                        double sign = (pair.image[0] == image) - (pair.image[1] == image);
                        analytic.push_back(channel == c ? -sign * t.channel[channel].by_delta[side] : 0.0);
                    }
            });
            Estimate low = s.estimate, high = s.estimate;
            low.log_exposure[image][c] -= h, high.log_exposure[image][c] += h;
            compare(analytic, residuals(s.problem, low), residuals(s.problem, high), h, "exposure");
        }
}

// The objective of the solver, computed independently.
double objective(const Problem &problem, const Prior &prior, const Loss &loss, const NoiseWeights &weights,
                 const Estimate &estimate) {
    double sum = prior_cost(prior, problem, free_columns(problem, estimate.modes), estimate);
    for_each_transfer(problem, estimate, [&](size_t p, const PairTransfer &t) {
        sum += 0.5 * pair_cost(weighted_residuals(t, problem.channels, weights[p]), problem.channels, loss, nullptr);
    });
    return sum;
}

// A prior with all its parts: response, falloff, a held gamma and known exposures.
Prior full_prior(double weight, const Problem &problem) {
    Prior prior = make_prior(weight, problem.vignettings, problem.settings);
    for (int l = 0; l < 6; l++) prior.pin[l] = 0.3 - 0.1 * l;
    prior.pin_value = 0.2;
    prior.pin_precision = 50.0;
    prior.known.resize(problem.image_count);
    prior.known[1] = {0.1, 30.0};
    return prior;
}

// The gradient of the reduced system compared with differences of the objective for each loss: along every shared
// unknown with the images' unknowns held, and along a joint step.
void test_objective_gradient(void **) {
    for (uint32_t kind : {LENSPROF_LOSS_ROBUST, LENSPROF_LOSS_HUBER, LENSPROF_LOSS_SQUARED})
        for (uint32_t channels : {1u, 3u}) {
            Setting s(channels, 400, channels == 3 ? 2 : 1);
            Loss loss;
            loss.kind = kind;
            s.problem.vignettings = static_cast<int>(channels);
            Prior prior = full_prior(1.0, s.problem);
            NoiseWeights weights = noise_weights(s.problem, s.estimate, loss);
            TransferEquations model(s.problem, prior, loss, weights, s.estimate, ModeTable(6));
            assert_close(model.objective(), objective(s.problem, prior, loss, weights, s.estimate),
                         1e-9 * model.objective());
            assert_true(model.reduce(0.0));
            // A step along the solution of the reduced system decreases the objective at the rate -b'S^-1 b - (images'
            // part).
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
                return objective(s.problem, prior, loss, weights, e);
            };
            double h = 1e-4, slope = (at(h) - at(-h)) / (2 * h);
            // For a Gauss-Newton step d = H^-1 g the slope is -g'd = -d'Hd, and the quadratic model promises half of
            // it.
            double model_slope = -(d.dot(model.reduced_gradient()));
            assert_true(slope < 0.0);
            assert_true(slope <= 0.98 * model_slope);  // the images' own gradient adds to the descent
        }
}

// Schur elimination equals the solution of the full system, formed densely from numeric Jacobians.
void test_elimination_equals_full_solve(void **) {
    Setting s(3, 200);
    Loss loss;
    loss.kind = LENSPROF_LOSS_SQUARED;
    s.problem.vignettings = 3;
    Prior prior = full_prior(0.5, s.problem);
    NoiseWeights weights = noise_weights(s.problem, s.estimate, loss);
    TransferEquations model(s.problem, prior, loss, weights, s.estimate, ModeTable(6));
    assert_true(model.reduce(0.0));
    Eigen::VectorXd shared_step = solve_symmetric(model.reduced_hessian(), model.reduced_gradient());
    auto image_step = model.image_step(shared_step);

    int shared = static_cast<int>(model.columns().size()), unknowns = shared + s.problem.image_unknowns;
    auto moved = [&](int u, double h) {
        Estimate e = s.estimate;
        if (u < shared) {
            Eigen::VectorXd full = shared_vector(e);
            full[model.columns()[static_cast<size_t>(u)]] += h;
            set_shared(e, full, s.problem.vignettings);
        } else {
            for (uint32_t i = 0; i < 4; i++)
                for (int c = 0; c < 3; c++)
                    for (int q : {s.problem.ev_unknown[i], s.problem.balance_unknown[i][c]})
                        if (q == u - shared) e.log_exposure[i][c] += h;
        }
        return residuals(s.problem, e);
    };
    std::vector<double> r = residuals(s.problem, s.estimate);
    Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(r.size()), unknowns);
    const double h = 1e-7;
    for (int u = 0; u < unknowns; u++) {
        auto low = moved(u, -h), high = moved(u, h);
        for (size_t i = 0; i < r.size(); i++) jacobian(static_cast<Eigen::Index>(i), u) = (high[i] - low[i]) / (2 * h);
    }
    double scale = 0.5 / (loss.noise * loss.noise);
    Eigen::MatrixXd hessian = scale * jacobian.transpose() * jacobian;
    Eigen::VectorXd gradient =
        -scale * jacobian.transpose() * Eigen::Map<Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size()));
    Eigen::VectorXd full = shared_vector(s.estimate);
    for (int u = 0; u < shared; u++)
        for (int v = 0; v < shared; v++) {
            double p =
                prior.precision(model.columns()[static_cast<size_t>(u)], model.columns()[static_cast<size_t>(v)]);
            hessian(u, v) += p;
            gradient[u] -=
                p
                * (full[model.columns()[static_cast<size_t>(v)]] - prior.mean[model.columns()[static_cast<size_t>(v)]]);
        }
    Eigen::VectorXd pin = Eigen::VectorXd::Zero(unknowns);
    pin.head(6) = prior.pin.head(6);
    hessian += prior.pin_precision * pin * pin.transpose();
    gradient -= prior.pin_precision * (prior.pin.dot(full.head(kMaxModes)) - prior.pin_value) * pin;
    add_falloff_prior(s.problem, s.estimate, prior, model.columns(), hessian, gradient);
    int known = shared + s.problem.ev_unknown[1];
    hessian(known, known) += prior.known[1].precision;
    gradient[known] -= prior.known[1].precision * (s.estimate.log_exposure[1][1] - prior.known[1].log_exposure);
    for (int q = shared; q < unknowns; q++) hessian(q, q) += 2e-3;
    Eigen::VectorXd step = solve_symmetric(hessian, gradient);
    for (int u = 0; u < shared; u++) assert_close(shared_step[u], step[u], 1e-3 * (0.01 + std::abs(step[u])));
    assert_close(image_step[1][1], step[shared + s.problem.ev_unknown[1]], 1e-4);
    assert_close(image_step[3][1], image_step[2][1], 0.0);  // linked
    assert_close(image_step[2][0], image_step[2][1], 0.0);  // red of image 2 is fixed: it moves with the exposure alone
    assert_close(image_step[0][0], 0.0, 0.0);               // the reference is unchanged

    // Variances: the diagonal of the full inverse.
    Eigen::MatrixXd inverse = inverse_of_symmetric(hessian),
                    shared_inverse = inverse_of_symmetric(model.reduced_hessian());
    Eigen::VectorXd variance = model.image_variance(shared_inverse, 1.0);
    for (int u = 0; u < shared; u++) assert_close(shared_inverse(u, u), inverse(u, u), 1e-3 * inverse(u, u));
    for (int q = 0; q < s.problem.image_unknowns; q++)
        assert_close(variance[q], inverse(shared + q, shared + q), 1e-3 * inverse(shared + q, shared + q));
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_residual_by_response),           cmocka_unit_test(test_residual_by_falloff),
        cmocka_unit_test(test_residual_by_exposure_and_value), cmocka_unit_test(test_objective_gradient),
        cmocka_unit_test(test_elimination_equals_full_solve),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
