// Responses that the pictures do not determine.
#include "core/profile.h"
#include "simulated.hpp"

#include <cstring>
#include <memory>
#include <string>

namespace {

// Pictures of one exposure from a camera that corrects all of its falloff but a trace.
Simulation even(double noise, uint64_t seed = 42, double corner = 0.97) {
    Simulation s;
    s.response = srgb_response();
    s.vignetting = {{corner - 1.0, 0.0, 0.0}, {}};
    s.exposures.assign(s.images, {0.0, {1.0, 1.0, 1.0}});
    s.make(2000, noise, 0.0, 0.0, seed);
    return s;
}

void assert_typical(const FitRun &run, uint32_t kind) {
    auto typical = std::make_unique<lensprof_response>();
    std::vector<double> covariance(LENSPROF_EMOR_MODES * LENSPROF_EMOR_MODES);
    double sigma;
    assert_ok(lensprof_response_set_typical(typical.get(), kind, covariance.data(), &sigma));
    const auto &r = run.result;
    assert_int_equal(r.usable, 1);
    assert_int_equal(r.equalizes, 1);
    assert_int_equal(r.first.code, LENSPROF_REASON_RESPONSE_UNCONSTRAINED);
    assert_int_equal(r.response_from, LENSPROF_FIT_RESPONSE_KIND);
    assert_int_equal(r.gamma_from, LENSPROF_GAMMA_PRIOR);
    assert_close(r.gamma_sigma, sigma, 1e-12);
    assert_memory_equal(r.response.table, typical->table, sizeof typical->table);
    assert_true(r.covariance_size >= LENSPROF_EMOR_MODES + 5);
    for (uint32_t i = 0; i < LENSPROF_EMOR_MODES; i++)
        for (uint32_t j = 0; j < LENSPROF_EMOR_MODES; j++)
            assert_close(r.covariance[i * r.covariance_size + j], covariance[i * LENSPROF_EMOR_MODES + j], 1e-12);
    for (uint32_t c = 0; c < r.vignettings; c++)
        assert_close(lensprof_vignetting_eval(&r.vignetting[c], 1.0, nullptr), 0.97, 0.02);
}

void test_equal_light_shows_no_response(void **) {
    for (double noise : {0.0, 2.0})
        for (uint32_t kind : {LENSPROF_CAMERA_ANY, LENSPROF_CAMERA_PHONE})
            for (uint32_t method : {LENSPROF_METHOD_TRANSFER, LENSPROF_METHOD_RADIANCE}) {
                lensprof_fit_options options = default_fit();
                options.camera_kind = kind;
                options.method = method;
                assert_typical(run_fit(even(noise), options), kind);
            }
}

// Without that trace there is nothing to correct: no model predicts held-out pairs better than the pictures as they
// are.
void test_equal_pictures_are_left_alone(void **) {
    for (uint64_t seed = 1; seed <= 8; seed++) {
        const FitRun run = run_fit(even(2.0, seed, 1.0));
        assert_int_equal(run.result.usable, 0);
        assert_int_equal(run.result.equalizes, 0);
        assert_int_equal(run.result.model, LENSPROF_FIT_MODEL_NOTHING);
        assert_int_equal(run.result.first.code, LENSPROF_REASON_NOTHING_BETTER);
    }
}

// Its profile can be stored, but is marked doubtful, so that later fits do not use it.
void test_the_profile_says_that_it_is_not_shown(void **) {
    for (uint64_t seed = 1; seed < 6; seed++) {
        Simulation s;
        s.response = srgb_response();
        s.vignetting = {{-0.02, 0.004, -0.003}, {0.01, -0.01}};
        s.exposures.assign(s.images, {0.0, {1.0, 1.0, 1.0}});
        s.make(2000, 1.0, 0.0, 0.0, seed);
        const lensprof_fit_options options = default_fit();
        const FitRun run = run_fit(s, options);
        assert_int_equal(run.result.response_from, LENSPROF_FIT_RESPONSE_KIND);
        auto profile = std::make_unique<lensprof_profile>();
        lensprof_profile_init(profile.get());
        assert_ok(lensprof_fit_profile(run.held.get(), 0, profile.get(), nullptr));
        assert_ok(lensprof_profile_validate(profile.get()));
        assert_true(lp_provenance_doubts_response(&profile->provenance) == 1);
    }
}

// Exposure differences of a fifth of an EV are enough.
void test_little_light_shows_one(void **) {
    Simulation s;
    s.response = srgb_response();
    s.vignetting = {};
    for (uint32_t i = 0; i < s.images; i++) s.exposures.push_back({i % 2 ? 0.2 : 0.0, {1.0, 1.0, 1.0}});
    s.make(4000, 1.0, 0.0, 0.0, 42);
    const FitRun run = run_fit(s);
    assert_int_equal(run.result.response_from, LENSPROF_FIT_RESPONSE_PICTURES);
    assert_true(run.result.irradiance_spread_ev > 0.15 && run.result.irradiance_spread_ev < 0.25);
}

// A profile from other pictures provides the response.
void test_the_profile_is_held_where_there_is_one(void **) {
    Simulation shown;
    shown.response = srgb_response();
    shown.make(6000, 1.0, 0.0, 1.0, 7);
    lensprof_fit_options options = default_fit();
    const FitRun first = run_fit(shown, options);
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    assert_ok(lensprof_fit_profile(first.held.get(), 0, profile.get(), nullptr));
    for (uint32_t i = 0; i < profile->covariance_size; i++)  // the response alone: this lens is corrected
        for (uint32_t j = 0; j < profile->covariance_size; j++)
            if (std::max(i, j) >= profile->response[0].modes)
                profile->covariance[i * profile->covariance_size + j] = 0.0;
    options.profile = profile.get();
    const FitRun run = run_fit(even(2.0), options);
    assert_int_equal(run.result.response_from, LENSPROF_FIT_RESPONSE_PROFILE);
    for (double x : {0.02, 0.1, 0.4})
        assert_close(lensprof_response_eval(&run.result.response, x, nullptr),
                     lensprof_response_eval(&first.result.response, x, nullptr), 0.02);
}

// The paper's variant has no prior that could hold the response.
void test_without_a_prior_nothing_is_held(void **) {
    lensprof_fit_options options = default_fit();
    options.prior_weight = 0.0;
    assert_int_equal(run_fit(even(2.0), options).result.response_from, LENSPROF_FIT_RESPONSE_PICTURES);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equal_light_shows_no_response),
        cmocka_unit_test(test_equal_pictures_are_left_alone),
        cmocka_unit_test(test_the_profile_says_that_it_is_not_shown),
        cmocka_unit_test(test_little_light_shows_one),
        cmocka_unit_test(test_the_profile_is_held_where_there_is_one),
        cmocka_unit_test(test_without_a_prior_nothing_is_held),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
