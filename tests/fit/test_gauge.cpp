// The exponent gamma that pictures leave open: what determines it, compared with simulated truth.
#include "simulated.hpp"

#include "fit/prior/gauge.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/problem/residual.hpp"

using namespace lensprof;

namespace {

// A member of a curve's family: f(x^(1/gamma)).
lensprof_response raised(const lensprof_response &f, double gamma) {
    return table_response([&](double x) { return lensprof_response_eval(&f, std::pow(x, 1.0 / gamma), nullptr); });
}

struct Named {
    const char *name;
    lensprof_response response;
};

std::vector<Named> cameras() {
    return {{"srgb", srgb_response()},
            {"linear", linear_response()},
            {"gamma 2.2", gamma_response(2.2)},
            {"film", film_response()}};
}

void test_position_counts_the_exponent(void **) {
    for (const Named &camera : cameras())
        for (double gamma : {0.7, 0.9, 1.1, 1.5}) {
            lensprof_response member = raised(camera.response, gamma);
            // Interpolation between 1024 samples is coarse if a steep curve reaches the gauge's grey value early.
            assert_close(gamma_position(member.table) - gamma_position(camera.response.table), std::log(gamma), 0.01);
        }
}

constexpr uint32_t kKinds[] = {LENSPROF_CAMERA_ANY, LENSPROF_CAMERA_FILM, LENSPROF_CAMERA_DIGITAL,
                               LENSPROF_CAMERA_STILL, LENSPROF_CAMERA_PHONE};

lensprof_response typical(uint32_t kind, double *sigma = nullptr) {
    lensprof_response response;
    assert_ok(lensprof_response_set_typical(&response, kind, nullptr, sigma));
    return response;
}

// The prior on the shape must not depend on which member of its family was found. (For curves that 1024 samples
// represent down to dark greys at all of these exponents.)
void test_the_shape_is_of_the_family(void **) {
    for (uint32_t kind : kKinds)
        for (const lensprof_response &response : {linear_response(), film_response()}) {
            const GammaPrior prior(kind);
            for (double gamma : {0.7, 0.9, 1.1, 1.5})
                assert_close(prior.oddness(raised(response, gamma).table), prior.oddness(response.table), 0.05);
        }
}

// Compared with differences of curves with one coefficient changed.
void test_the_slope_of_the_position(void **) {
    for (uint32_t kind : kKinds) {
        lensprof_response r = typical(kind), up, down;
        Eigen::VectorXd slope;
        gamma_position(r.table, &slope);
        for (uint32_t l = 0; l < LENSPROF_EMOR_MODES; l++) {
            double emor[LENSPROF_EMOR_MODES];
            std::copy(r.emor, r.emor + LENSPROF_EMOR_MODES, emor);
            emor[l] += 1e-5;
            assert_ok(lensprof_response_set_emor(&up, emor, LENSPROF_EMOR_MODES));
            emor[l] -= 2e-5;
            assert_ok(lensprof_response_set_emor(&down, emor, LENSPROF_EMOR_MODES));
            assert_close(slope[l], (gamma_position(up.table) - gamma_position(down.table)) / 2e-5, 1e-3);
        }
    }
}

// The prior has the position of the typical response, and its stated error.
void test_the_prior_is_that_of_the_typical_response(void **) {
    for (uint32_t kind : kKinds) {
        double sigma;
        lensprof_response r = typical(kind, &sigma);
        const GammaPrior prior(kind);
        double q = std::log(std::log(lensprof_response_invert(&r, 208.0 / 255.0, nullptr)
                                     / lensprof_response_invert(&r, 48.0 / 255.0, nullptr)));
        assert_close(prior.position(), q, 1e-12);
        assert_close(prior.sigma(), sigma, 0.0);
        assert_close(prior.oddness(r.table), 0.0, 1e-9);
        assert_close(prior.sigma_of(r.table), sigma, 0.0);
    }
}

// Curves that programs use are within two of the stated errors, even if EXIF names a camera: their shape is unlike a
// camera's, which widens the error.
void test_plain_curves_are_within_what_is_stated(void **) {
    std::vector<Named> plain = {{"srgb", srgb_response()}, {"linear", linear_response()}};
    for (double gamma : {1.8, 2.0, 2.2, 2.4, 2.6}) plain.push_back({"gamma", gamma_response(gamma)});
    for (uint32_t kind : {LENSPROF_CAMERA_ANY, LENSPROF_CAMERA_STILL, LENSPROF_CAMERA_PHONE})
        for (const Named &curve : plain) {
            const GammaPrior prior(kind);
            const double *table = curve.response.table;
            assert_true(std::abs(gamma_position(table) - prior.position()) <= 2.0 * prior.sigma_of(table));
            assert_int_equal(prior.oddness(table) > 1.0, kind != LENSPROF_CAMERA_ANY);
        }
}

lensprof_response mean_response() {
    lensprof_response response;
    assert_ok(lensprof_response_set_emor(&response, nullptr, 0));
    return response;
}

// An estimate at the truth of a simulation, with 12 modes and a mild falloff.
struct Setting {
    Simulation simulation;
    lensprof_fit_options options = default_fit();
    Problem problem;
    Estimate estimate;

    explicit Setting(const lensprof_response &response, uint32_t reference = 0) {
        simulation.response = response;
        simulation.vignetting = {{-0.2, 0.03, -0.02}, {0.02, -0.015}};
        simulation.make(400, 0.0, 0.0, 1.0, 11);
        options.reference = reference;
        std::vector<uint32_t> keep(400);
        for (uint32_t p = 0; p < 400; p++) keep[p] = p;
        problem = make_problem(options, simulation.fit_images.data(), simulation.images, simulation.pairs.data(), keep);
        set_response(estimate, project_curve(simulation.response.table, 12).data(), 12);
        const lensprof_vignetting &own = simulation.vignetting;
        estimate.vignetting = {{own, own, own}};
        for (const auto &e : simulation.exposures) {
            double log_ev = e.ev * std::log(2.0);
            estimate.log_exposure.push_back(
                {log_ev + std::log(e.white_balance[0]), log_ev, log_ev + std::log(e.white_balance[2])});
        }
    }
};

std::vector<double> residuals(const Problem &problem, const Estimate &estimate) {
    std::vector<double> values;
    for_each_transfer(problem, estimate, [&](size_t, const PairTransfer &t) {
        for (const auto &channel : t.channel)
            for (double r : channel.residual) values.push_back(255.0 * r);
    });
    return values;
}

// Only members that 12 modes can represent: sRGB at gamma 1.25 is too steep near black (0.38 levels RMS, 2 at most).
void test_the_exponent_does_not_show_in_the_pictures(void **) {
    for (const lensprof_response &response : {mean_response(), linear_response()})
        for (double gamma : {0.8, 0.9, 1.1, 1.25}) {
            Setting s(response, 2);
            Estimate moved = with_exponent(s.problem, s.estimate, std::log(gamma));
            std::vector<double> before = residuals(s.problem, s.estimate), after = residuals(s.problem, moved);
            for (size_t i = 0; i < after.size(); i++) assert_close(after[i], before[i], 0.3);
            for (size_t c = 0; c < 3; c++)
                for (size_t i = 0; i < moved.log_exposure.size(); i++) {
                    double from = s.estimate.log_exposure[i][c], zero = s.estimate.log_exposure[2][c];
                    assert_close(moved.log_exposure[i][c], zero + gamma * (from - zero), 1e-12);
                }
            for (double r2 : {0.25, 1.0})
                assert_close(lensprof_vignetting_eval(&moved.vignetting[0][1], r2, nullptr),
                             std::pow(lensprof_vignetting_eval(&s.simulation.vignetting, r2, nullptr), gamma), 0.002);
            assert_memory_equal(moved.vignetting[0][0].center, s.estimate.vignetting[0][0].center, 2 * sizeof(double));
            assert_close(gamma_position(moved.curve.table.data()) - gamma_position(s.estimate.curve.table.data()),
                         std::log(gamma), 0.02);
        }
}

// Falloff held at 0 stays there.
void test_parameters_held_do_not_move(void **) {
    Setting s(mean_response());
    s.problem.free &= ~(LENSPROF_FREE_K2 | LENSPROF_FREE_K3);
    for (auto &v : s.estimate.vignetting[0]) v.k[1] = v.k[2] = 0.0;
    Estimate moved = with_exponent(s.problem, s.estimate, 0.2);
    assert_close(moved.vignetting[0][0].k[1], 0.0, 0.0);
    assert_close(moved.vignetting[0][0].k[2], 0.0, 0.0);
    assert_true(moved.vignetting[0][0].k[0] < s.estimate.vignetting[0][0].k[0]);
}

void test_direction_is_the_derivative(void **) {
    Setting s(mean_response());
    Eigen::VectorXd direction = Gauge::direction(s.problem, s.estimate), here = shared_vector(s.estimate);
    const double h = 0.03;  // a step different from the tested code's
    Eigen::VectorXd up = shared_vector(with_exponent(s.problem, s.estimate, h));
    Eigen::VectorXd down = shared_vector(with_exponent(s.problem, s.estimate, -h));
    for (Eigen::Index i = 0; i < here.size(); i++)
        assert_close(direction[i], (up[i] - down[i]) / (2 * h), 0.02 * (0.1 + direction.cwiseAbs().maxCoeff()));
    // d M^gamma / d ln gamma = M ln M.
    double m = lensprof_vignetting_eval(&s.simulation.vignetting, 1.0, nullptr);
    for (int curve = 0; curve < 3; curve++)
        assert_close(direction.segment(kFalloff + 3 * curve, 3).sum(), m * std::log(m), 0.005);
    assert_close(direction[kCenter], 0.0, 0.0);
    // The position moves by one.
    Estimate moved = s.estimate;
    Eigen::VectorXd emor = here + 0.02 * direction;
    set_response(moved, emor.data(), 12);
    assert_close(gamma_position(moved.curve.table.data()) - gamma_position(s.estimate.curve.table.data()), 0.02, 0.002);
}

Simulation simulate(const lensprof_response &response, uint64_t seed = 42) {
    Simulation s;
    s.response = response;
    s.make(1000, 1.0, 0.0, 1.0, seed);
    return s;
}

void assert_from(const FitRun &run, uint32_t from, double sigma) {
    assert_int_equal(run.result.gamma_from, from);
    assert_close(run.result.gamma_sigma, sigma, 0.05 * sigma);  // the depth of the falloff adds to the prior
}

void test_what_closes_the_gauge(void **) {
    Simulation s = simulate(srgb_response());
    lensprof_fit_options options = default_fit();
    FitRun prior = run_fit(s, options);
    assert_from(prior, LENSPROF_GAMMA_PRIOR, GammaPrior(LENSPROF_CAMERA_ANY).sigma());
    options.free &= ~LENSPROF_FREE_RESPONSE;
    options.response = &s.response;
    assert_from(run_fit(s, options), LENSPROF_GAMMA_KNOWN, 0.0);
    options = default_fit();
    options.modes = 0;
    assert_from(run_fit(s, options), LENSPROF_GAMMA_KNOWN, 0.0);
    options = default_fit();
    options.free &= ~LENSPROF_FREE_K1;
    assert_from(run_fit(s, options), LENSPROF_GAMMA_PRIOR, prior.result.gamma_sigma);  // k1 = 0 in the whole family
    options.vignetting = s.vignetting;
    assert_from(run_fit(s, options), LENSPROF_GAMMA_KNOWN, 0.0);
    Simulation fixed = s;
    fixed.fit_images[3].free &= ~LENSPROF_FREE_EV;
    assert_from(run_fit(fixed), LENSPROF_GAMMA_PRIOR, prior.result.gamma_sigma);  // held like the reference's
    fixed.fit_images[3].exposure.ev = s.exposures[3].ev;
    assert_from(run_fit(fixed), LENSPROF_GAMMA_KNOWN, 0.0);
}

void test_without_a_prior_nothing_settles_gamma(void **) {
    Simulation s = simulate(srgb_response());
    lensprof_fit_options options = default_fit();
    options.prior_weight = 0.0;
    assert_int_equal(run_fit(s, options).result.gamma_from, LENSPROF_GAMMA_NONE);
}

// A bracket of two stops with exposures known to a tenth, which determines gamma better than the prior does. (For
// brackets of 0.7 EV they determine it to 15 % only, and the modes' own preference shows.)
Simulation bracket(const lensprof_response &response, uint32_t images, uint64_t seed) {
    const double ev[6] = {0.0, 1.0, -1.0, 0.5, -0.5, 0.8};
    Simulation s;
    s.response = response;
    s.images = images;
    for (uint32_t i = 0; i < images; i++) s.exposures.push_back({ev[i % 6], {1.0, 1.0, 1.0}});
    s.make(1000, 1.0, 0.0, 1.0, seed);
    for (uint32_t i = 0; i < images; i++) {
        s.fit_images[i].known_ev = 7.0 + s.exposures[i].ev;
        s.fit_images[i].known_ev_sigma = 0.1;
    }
    return s;
}

// For cameras near and far from the prior: the result has absolute values.
void test_known_exposures_settle_gamma(void **) {
    for (const Named &camera : cameras())
        for (uint64_t seed = 1; seed <= 4; seed++) {
            Simulation s = bracket(camera.response, 6, seed);
            FitRun run = run_fit(s);
            double slope = s.gamma(run.exposures);
            if (!(std::abs(slope - 1.0) < 0.05)) print_error("%s: slope %.3f\n", camera.name, slope);
            assert_int_equal(run.result.gamma_from, LENSPROF_GAMMA_EXPOSURES);
            assert_true(run.result.gamma_sigma > 0.0 && run.result.gamma_sigma < GammaPrior(0).sigma());
            assert_close(slope, 1.0, 0.05);
            assert_true(s.falloff_error(run.result.vignetting[0], 1.0) <= 0.02);
            for (const auto &q : run.quality) assert_close(q.known_ev_residual, 0.0, 0.05);
        }
}

double log_gamma_between(const FitRun &a, const FitRun &b) {
    return gamma_position(a.result.response.table) - gamma_position(b.result.response.table);
}

// With a given number of modes: their automatic selection is discrete, a small pull can change it, and other modes
// prefer another gamma.
lensprof_fit_options twelve_modes() {
    lensprof_fit_options options = default_fit();
    options.modes = 12;
    return options;
}

// Rounded exposures of a sequence at equal settings; the true exposures differ slightly.
void test_equal_known_exposures_pull_nothing(void **) {
    for (uint64_t seed = 1; seed <= 8; seed++) {
        Simulation s;
        s.response = srgb_response();
        uint64_t random = seed;
        for (uint32_t i = 0; i < s.images; i++)
            s.exposures.push_back({i ? 0.2 * lp_random(&random) - 0.1 : 0.0, {1.0, 1.0, 1.0}});
        s.make(1000, 1.0, 0.0, 1.0, seed);
        FitRun without = run_fit(s, twelve_modes());
        for (auto &image : s.fit_images) image.known_ev = 9.0, image.known_ev_sigma = 0.1;
        FitRun with = run_fit(s, twelve_modes());
        assert_close(log_gamma_between(with, without), 0.0, 0.02);
        assert_from(with, LENSPROF_GAMMA_PRIOR, without.result.gamma_sigma);
        for (uint32_t i = 0; i < s.images; i++) assert_close(with.exposures[i].ev, without.exposures[i].ev, 0.01);
    }
}

// One image's known exposure is 1 EV off: its residual shows it, and among twelve it has little weight.
void test_one_wrong_known_exposure(void **) {
    for (uint64_t seed = 1; seed <= 3; seed++)
        for (double wrong : {-1.0, 1.0}) {
            Simulation s = bracket(srgb_response(), 12, seed);
            s.fit_images[2].known_ev_sigma = 0.0;
            FitRun without = run_fit(s, twelve_modes());
            s.fit_images[2].known_ev_sigma = 0.1;
            s.fit_images[2].known_ev += wrong;
            FitRun with = run_fit(s, twelve_modes());
            assert_close(log_gamma_between(with, without), 0.0, 0.06);
            assert_close(with.quality[2].known_ev_residual, -wrong, 0.1);
            for (uint32_t i = 0; i < s.images; i++)
                if (i != 2) assert_close(with.quality[i].known_ev_residual, 0.0, 0.15);
        }
}

// Known exposures that scatter ten times more than stated are recognised: they do not bend the fit.
void test_known_exposures_that_scatter(void **) {
    for (uint64_t seed = 1; seed <= 6; seed++) {
        Simulation s = bracket(srgb_response(), 8, seed);
        uint64_t random = seed + 50;
        for (auto &image : s.fit_images) image.known_ev += lp_normal(&random);
        FitRun run = run_fit(s);
        double slope = s.gamma(run.exposures);
        assert_true(s.exposure_error(run.exposures, slope) < 0.05);
        assert_true(std::abs(std::log(slope)) < 0.5);
        assert_true(run.result.gamma_sigma > 0.07);
        assert_true(run.result.inlier_share > 0.9);
    }
}

// One mode of the response cannot follow to the gamma that exposures ask for. The stated error covers the distance.
void test_a_gamma_out_of_reach(void **) {
    lensprof_fit_options options = default_fit();
    options.modes = 1;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        const Simulation s = bracket(srgb_response(), 6, seed);
        const FitRun run = run_fit(s, options);
        assert_true(std::abs(std::log(s.gamma(run.exposures))) < 2.0 * run.result.gamma_sigma);
    }
}

void test_what_is_asked_for_settles_gamma(void **) {
    Simulation s = bracket(linear_response(), 6, 1);
    lensprof_fit_options options = twelve_modes();
    options.gamma_from = LENSPROF_GAMMA_EXPOSURES;
    FitRun exposures = run_fit(s, options);
    options.gamma_from = LENSPROF_GAMMA_PRIOR;
    FitRun prior = run_fit(s, options);
    assert_from(prior, LENSPROF_GAMMA_PRIOR, GammaPrior(LENSPROF_CAMERA_ANY).sigma());
    assert_int_equal(exposures.result.gamma_from, LENSPROF_GAMMA_EXPOSURES);
    assert_close(s.gamma(exposures.exposures), 1.0, 0.005);
    assert_true(std::abs(s.gamma(prior.exposures) - 1.0) > 0.1);  // the prior does not expect a linear camera
    for (auto &image : s.fit_images) image.known_ev_sigma = 0.0;
    assert_close(log_gamma_between(prior, run_fit(s, options)), 0.0, 0.02);
    options.gamma_from = LENSPROF_GAMMA_EXPOSURES;
    assert_int_equal(run_fit(s, options).result.gamma_from, LENSPROF_GAMMA_PRIOR);  // there is no other knowledge
}

// Gamma moves by the distance between the priors of the kinds.
void test_kinds_of_camera_differ(void **) {
    Simulation s = simulate(typical(LENSPROF_CAMERA_STILL));
    lensprof_fit_options options = twelve_modes();
    FitRun any = run_fit(s, options);
    for (uint32_t kind : {LENSPROF_CAMERA_DIGITAL, LENSPROF_CAMERA_STILL, LENSPROF_CAMERA_PHONE}) {
        options.camera_kind = kind;
        FitRun run = run_fit(s, options);
        const double apart = GammaPrior(kind).position() - GammaPrior(LENSPROF_CAMERA_ANY).position();
        assert_close(run.result.gamma_sigma, GammaPrior(kind).sigma(), 0.01 * GammaPrior(kind).sigma());
        assert_close(log_gamma_between(run, any), apart, 0.02);  // the depth of the falloff pulls at `any`
        assert_string_equal(run.result.first.text, "");
    }
}

// A response that programs use, in pictures that name a camera: a reason reports it, and the stated error holds.
void test_an_unusual_response_is_said(void **) {
    for (const Named &curve : {Named{"srgb", srgb_response()}, Named{"gamma 2.4", gamma_response(2.4)}}) {
        Simulation s = simulate(curve.response);
        lensprof_fit_options options = default_fit();
        options.camera_kind = LENSPROF_CAMERA_STILL;
        FitRun run = run_fit(s, options);
        assert_int_equal(run.result.usable, 1);
        assert_int_equal(run.result.first.code, LENSPROF_REASON_UNUSUAL_RESPONSE);
        assert_true(run.result.first.value[0] > 1.0);
        assert_int_equal(run.result.first.severity,
                         run.result.first.value[0] > 2.0 ? LENSPROF_SEVERITY_WARNING : LENSPROF_SEVERITY_NOTE);
        assert_close(run.result.first.value[1], run.result.gamma_sigma, 0.0);
        assert_true(run.result.gamma_sigma > 2.0 * GammaPrior(LENSPROF_CAMERA_STILL).sigma());
        assert_true(std::abs(std::log(s.gamma(run.exposures))) <= 2.0 * run.result.gamma_sigma);
    }
}

void test_linear_cameras_hold_the_response(void **) {
    Simulation s = simulate(linear_response());
    lensprof_response other = srgb_response();
    lensprof_fit_options options = default_fit();
    options.camera_kind = LENSPROF_CAMERA_LINEAR;
    options.response = &other;
    FitRun run = run_fit(s, options);
    assert_from(run, LENSPROF_GAMMA_KNOWN, 0.0);
    assert_int_equal(run.result.response.kind, LENSPROF_RESPONSE_LINEAR);
    assert_close(s.gamma(run.exposures), 1.0, 0.005);
    options.camera_kind = LENSPROF_CAMERA_LINEAR + 1;
    assert_int_equal(fit_into(run, options, s.fit_images, s.pairs), LENSPROF_ERROR_ARGUMENT);
}

// Exposures known much better than a camera can set them cause no numerical problem.
void test_tight_known_exposures(void **) {
    for (double sigma : {0.1, 0.02, 0.003, 0.001}) {
        Simulation s = simulate(srgb_response());
        for (uint32_t i = 0; i < s.images; i++)
            s.fit_images[i].known_ev = s.exposures[i].ev, s.fit_images[i].known_ev_sigma = sigma;
        FitRun run = run_fit(s);
        assert_int_equal(run.result.usable, 1);
        assert_int_equal(run.result.gamma_from, LENSPROF_GAMMA_EXPOSURES);
        assert_true(run.result.iterations < 40);
        assert_close(s.gamma(run.exposures), 1.0, 0.03);
    }
}

// A single known exposure cannot be compared with anything.
void test_one_known_exposure_says_nothing(void **) {
    Simulation s = simulate(srgb_response());
    FitRun without = run_fit(s);
    s.fit_images[2].known_ev = 5.0, s.fit_images[2].known_ev_sigma = 0.001;
    FitRun with = run_fit(s);
    assert_memory_equal(without.exposures.data(), with.exposures.data(), s.images * sizeof with.exposures[0]);
    assert_string_equal(with.result.first.text, "");
    for (const auto &q : with.quality) assert_close(q.known_ev_residual, 0.0, 0.0);
}

// Weak knowledge that agrees with the prior reduces its error.
void test_weak_exposures_do_not_weaken_the_prior(void **) {
    Simulation s = simulate(srgb_response());
    double prior = run_fit(s).result.gamma_sigma;
    for (uint32_t i = 0; i < s.images; i++)
        s.fit_images[i].known_ev = s.exposures[i].ev, s.fit_images[i].known_ev_sigma = 0.5;
    double both = run_fit(s).result.gamma_sigma;
    assert_true(both <= 1.1 * prior);
}

// A reference far from 0 EV, and a held green white balance that differs from it.
void test_where_the_reference_stands_does_not_matter(void **) {
    Simulation s = simulate(srgb_response());
    FitRun near = run_fit(s);
    s.fit_images[0].exposure.ev = 40.0;
    FitRun far = run_fit(s);
    assert_int_equal(far.result.usable, 1);
    for (uint32_t i = 0; i < s.images; i++) assert_close(far.exposures[i].ev - 40.0, near.exposures[i].ev, 1e-3);
    for (uint32_t i = 0; i < s.images; i++) {
        s.fit_images[i].exposure = s.exposures[i];
        s.fit_images[i].free = 0;
        if (i % 2) {
            s.fit_images[i].exposure.ev -= std::log2(3.0);
            for (double &w : s.fit_images[i].exposure.white_balance) w *= 3.0;
        }
    }
    FitRun held = run_fit(s);
    assert_int_equal(held.result.gamma_from, LENSPROF_GAMMA_KNOWN);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_position_counts_the_exponent),
        cmocka_unit_test(test_the_shape_is_of_the_family),
        cmocka_unit_test(test_the_slope_of_the_position),
        cmocka_unit_test(test_the_prior_is_that_of_the_typical_response),
        cmocka_unit_test(test_plain_curves_are_within_what_is_stated),
        cmocka_unit_test(test_the_exponent_does_not_show_in_the_pictures),
        cmocka_unit_test(test_parameters_held_do_not_move),
        cmocka_unit_test(test_direction_is_the_derivative),
        cmocka_unit_test(test_what_closes_the_gauge),
        cmocka_unit_test(test_without_a_prior_nothing_settles_gamma),
        cmocka_unit_test(test_known_exposures_settle_gamma),
        cmocka_unit_test(test_equal_known_exposures_pull_nothing),
        cmocka_unit_test(test_one_wrong_known_exposure),
        cmocka_unit_test(test_known_exposures_that_scatter),
        cmocka_unit_test(test_a_gamma_out_of_reach),
        cmocka_unit_test(test_what_is_asked_for_settles_gamma),
        cmocka_unit_test(test_kinds_of_camera_differ),
        cmocka_unit_test(test_an_unusual_response_is_said),
        cmocka_unit_test(test_linear_cameras_hold_the_response),
        cmocka_unit_test(test_tight_known_exposures),
        cmocka_unit_test(test_one_known_exposure_says_nothing),
        cmocka_unit_test(test_weak_exposures_do_not_weaken_the_prior),
        cmocka_unit_test(test_where_the_reference_stands_does_not_matter),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
