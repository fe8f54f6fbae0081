// Pictures with several lens settings in one fit: a falloff per setting, one response for all.
#include "simulated_run.hpp"

namespace {

const lensprof_vignetting kOpen{{-0.55, 0.15, -0.12}, {0.02, -0.015}}, kStopped{{-0.12, 0.02, -0.03}, {-0.01, 0.005}};

// Images alternate between wide open and stopped down.
template <class Simulated>
Simulated alternating(uint64_t seed = 42) {
    Simulated s;
    s.response = srgb_response();
    s.of_setting = {kOpen, kStopped};
    if constexpr (std::is_same_v<Simulated, TrackSimulation>)
        s.make_tracks(600, 1.0, 0.02, 1.0, seed);
    else
        s.make(2000, 1.0, 0.05, 1.0, seed);
    return s;
}

void check_found(const Simulation &s, const Run &run) {
    const double gamma = s.gamma(run.exposures);
    assert_int_equal(run.result.usable, 1);
    assert_true(s.exposure_error(run.exposures, gamma) < 0.015);
    for (size_t n = 0; n < 2; n++) {
        const lensprof_fit_result &setting = run.settings[n];
        assert_int_equal(setting.usable, 1);
        assert_int_equal(setting.images, 3);
        assert_true(falloff_error(setting.vignetting[0], s.of_setting[n], gamma) < 0.01);
        for (int d = 0; d < 2; d++) assert_close(setting.vignetting[0].center[d], s.of_setting[n].center[d], 0.015);
        uint32_t ends = 0;
        for (uint32_t count : setting.radius_ends) ends += count;
        assert_true(ends > run.result.pairs / 2 && ends < 2 * run.result.pairs);
    }
    // The reference, image 0, has setting 0.
    assert_memory_equal(run.result.vignetting, run.settings[0].vignetting, sizeof run.result.vignetting);
    assert_memory_equal(run.result.covariance, run.settings[0].covariance, sizeof run.result.covariance);
    assert_true(memcmp(run.settings[0].covariance, run.settings[1].covariance, sizeof run.result.covariance) != 0);
}

void test_each_falloff_is_found(void **) {
    const auto s = alternating<Simulation>();
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    check_found(s, run);
    // One falloff for both settings leaves larger residuals.
    Simulation one = s;
    for (auto &image : one.fit_images) image.setting = 0;
    const FitRun together = run_fit(one);
    assert_true(together.result.heldout_median > 1.5 * run.result.heldout_median);
    print_message("held-out residual: %.2f levels with a falloff per setting, %.2f with one falloff\n",
                  run.result.heldout_median, together.result.heldout_median);
}

void test_each_falloff_is_found_by_radiance(void **) {
    const auto s = alternating<TrackSimulation>();
    Run run(s);
    assert_ok(run.fit(s, radiance_fit()));
    check_found(s, run);
}

// Errors of the corner are consistent with their standard errors, apart from gamma, over simulations.
void test_stated_errors_hold(void **) {
    double square = 0.0;
    int count = 0;
    for (uint64_t seed = 1; seed <= 16; seed++) {
        const auto s = alternating<Simulation>(seed);
        Run run(s);
        assert_ok(run.fit(s, default_fit()));
        const double gamma = s.gamma(run.exposures);
        const lensprof_fit_result &r = run.result;
        for (size_t n = 0; n < 2; n++) {
            const lensprof_fit_result &setting = run.settings[n];
            const uint32_t first = r.response.modes;
            double variance = 0.0;
            for (uint32_t i = 0; i < 3; i++)
                for (uint32_t j = 0; j < 3; j++)
                    variance += setting.covariance[(first + i) * r.covariance_size + first + j]
                                - r.gamma_sigma * r.gamma_sigma * setting.gamma_direction[first + i]
                                      * setting.gamma_direction[first + j];
            const double m = lensprof_vignetting_eval(&setting.vignetting[0], 1.0, nullptr);
            const double truth = std::pow(lensprof_vignetting_eval(&s.of_setting[n], 1.0, nullptr), gamma);
            square += (m - truth) * (m - truth) / variance;
            count++;
        }
    }
    const double rms = std::sqrt(square / count);
    print_message("corner: RMS %.2f standard errors (%d)\n", rms, count);
    assert_true(rms > 0.6 && rms < 1.5);
}

// The numbering of settings makes no difference, nor do settings without images.
void test_numbers_are_names(void **) {
    const auto s = alternating<Simulation>();
    Simulation renamed = s;
    for (auto &image : renamed.fit_images) image.setting = image.setting ? 0 : 63;
    Run run(s), other(s);
    assert_ok(run.fit(s, default_fit()));
    assert_ok(other.fit(renamed, default_fit()));
    assert_memory_equal(run.exposures.data(), other.exposures.data(), s.images * sizeof run.exposures[0]);
    assert_int_equal(other.result.setting_count, 64);
    for (FoundResult &r : run.settings) r.setting_count = 64, r.seconds = other.result.seconds;
    assert_memory_equal(&run.settings[0], &other.settings[63], sizeof run.settings[0]);
    assert_memory_equal(&run.settings[1], &other.settings[0], sizeof run.settings[0]);
    assert_int_equal(other.settings[5].images, 0);
    assert_int_equal(other.settings[5].usable, 0);
}

// All images have one setting, whatever its number, and the caller does not ask for settings.
void test_one_setting_is_as_ever(void **) {
    Simulation s;
    s.response = srgb_response();
    s.make(1000, 1.0, 0.0, 1.0, 3);
    const FitRun plain = run_fit(s);
    for (auto &image : s.fit_images) image.setting = 9;
    const FitRun named = run_fit(s);
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    const FoundResult *const results[] = {&named.result, &run.result};
    for (const FoundResult *r : results) {
        assert_memory_equal(r->vignetting, plain.result.vignetting, sizeof r->vignetting);
        assert_memory_equal(r->covariance, plain.result.covariance, sizeof r->covariance);
        assert_true(r->heldout_rms == plain.result.heldout_rms);
    }
    assert_memory_equal(run.settings[9].vignetting, plain.result.vignetting, sizeof plain.result.vignetting);
    assert_int_equal(run.settings[9].images, s.images);
    assert_int_equal(run.settings[9].setting_pairs, plain.result.pairs);
    const auto two = alternating<Simulation>();
    const FitRun without = run_fit(two);
    Run with(two);
    assert_ok(with.fit(two, default_fit()));
    assert_memory_equal(without.result.vignetting, with.settings[0].vignetting, sizeof without.result.vignetting);
}

// A setting without pairs near the corner does not give a profile; the others do.
void test_verdicts_of_their_own(void **) {
    auto s = alternating<Simulation>();
    const auto is_far = [&](const lensprof_pair &pair) {
        for (int side = 0; side < 2; side++)
            if (pair.image[side] % 2 == 1
                && lensprof_vignetting_r2(&kStopped, s.width, s.height, pair.xy[side][0], pair.xy[side][1], nullptr)
                       > 0.09)
                return true;
        return false;
    };
    s.make(40000, 1.0, 0.0, 1.0, 42);
    s.fit_images.resize(s.images);
    s.pairs.erase(std::remove_if(s.pairs.begin(), s.pairs.end(), is_far), s.pairs.end());
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.settings[0].usable, 1);
    assert_int_equal(run.settings[1].usable, 0);
    assert_int_equal(run.settings[1].first.code, LENSPROF_REASON_SMALL_RADIUS);
    assert_int_equal(run.result.equalizes, 1);
}

void test_profile_of_a_setting(void **) {
    const auto s = alternating<Simulation>();
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    assert_ok(lensprof_fit_profile(run.held.get(), 1, &profile, nullptr));
    assert_ok(lensprof_profile_validate(&profile));
    assert_memory_equal(profile.vignetting, run.settings[1].vignetting, sizeof profile.vignetting);
    assert_memory_equal(profile.response[0].table, run.result.response.table, sizeof profile.response[0].table);
    assert_memory_equal(profile.covariance, run.settings[1].covariance,
                        run.result.covariance_size * run.result.covariance_size * sizeof(double));
    assert_int_equal(profile.provenance.images, 3);
    assert_int_equal(profile.provenance.pairs, run.settings[1].setting_pairs);
}

void test_bad_input(void **) {
    auto s = alternating<Simulation>();
    lensprof_error error;
    Run run(s);
    lensprof_fit_options options = default_fit();
    options.method = LENSPROF_METHOD_TRANSFER_FUNCTION;
    assert_int_equal(run.fit(s, options, &error), LENSPROF_ERROR_UNSUPPORTED);
    s.fit_images[2].setting = LENSPROF_SETTINGS_MAX;
    assert_int_equal(run.fit(s, default_fit(), &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(error.item.index, 2);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_falloff_is_found),  cmocka_unit_test(test_each_falloff_is_found_by_radiance),
        cmocka_unit_test(test_stated_errors_hold),     cmocka_unit_test(test_numbers_are_names),
        cmocka_unit_test(test_one_setting_is_as_ever), cmocka_unit_test(test_verdicts_of_their_own),
        cmocka_unit_test(test_profile_of_a_setting),   cmocka_unit_test(test_bad_input),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
