// A fit that the caller holds: its memory, what it answers, its profiles, and what it refuses.
#include <algorithm>
#include <string>

#include "simulated_run.hpp"

#include <thread>

#include <lensprof/lensprof.h>

#include "fit/api/fit_handle.hpp"

namespace {

Simulation sequence(uint64_t seed = 42) {
    Simulation s;
    s.response = srgb_response();
    s.make(2000, 1.0, 0.0, 1.0, seed);
    return s;
}

// Two cameras with two settings each.
Simulation cameras_and_settings() {
    Simulation s;
    s.response = srgb_response();
    s.images = 8;
    s.make(6000, 1.0, 0.02, 1.0, 7);
    for (uint32_t i = 0; i < s.images; i++) s.fit_images[i].setting = i / 2, s.fit_images[i].camera = i / 4;
    return s;
}

// In the caller's memory, of exactly the size asked for, the fit is the same.
void test_memory(void **) {
    for (const Simulation &s : {sequence(), cameras_and_settings()}) {
        const lensprof_fit_options options = default_fit();
        Run own;
        assert_ok(own.fit(s, options));
        const size_t bytes = lensprof_fit_bytes(s.fit_images.data(), s.images);
        std::vector<uint64_t> memory(bytes / 8);
        std::vector<lensprof_exposure> exposures(s.images);
        lensprof_error error;
        lensprof_fit *fit = nullptr;
        const auto run = [&](void *at, size_t size) {
            return lensprof_fit_overlap(&options, s.fit_images.data(), s.images, s.pairs.data(),
                                        static_cast<uint32_t>(s.pairs.size()), at, size, exposures.data(), &fit,
                                        &error);
        };
        assert_int_equal(run(memory.data(), bytes - 1), LENSPROF_ERROR_CAPACITY);
        assert_non_null(std::strstr(error.text, std::to_string(bytes).c_str()));
        assert_int_equal(run(reinterpret_cast<char *>(memory.data()) + 4, bytes - 8), LENSPROF_ERROR_CAPACITY);
        assert_null(fit);
        assert_ok(run(memory.data(), bytes));
        assert_ptr_equal(fit, memory.data());
        FitRun other;
        other.exposures = exposures;
        other.take(fit);
        for (size_t n = 0; n < own.settings.size(); n++) {
            own.settings[n].seconds = other.settings[n].seconds;
            assert_memory_equal(&own.settings[n], &other.settings[n], sizeof own.settings[n]);
        }
        assert_memory_equal(own.quality.data(), other.quality.data(), own.quality.size() * sizeof own.quality[0]);
        assert_memory_equal(own.cameras.data(), other.cameras.data(), own.cameras.size() * sizeof own.cameras[0]);
    }
    assert_int_equal(lensprof_fit_bytes(nullptr, 3), 0);
    Simulation bad = sequence();
    bad.fit_images[2].setting = LENSPROF_SETTINGS_MAX;
    assert_int_equal(lensprof_fit_bytes(bad.fit_images.data(), bad.images), 0);
}

// Every setting has the numbers of its own camera, and one profile.
void test_settings_and_cameras(void **) {
    const Simulation s = cameras_and_settings();
    Run run;
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.settings.size(), 4);
    assert_int_equal(run.cameras.size(), 2);
    assert_memory_equal(&run.result, &run.settings[s.fit_images[run.result.reference].setting], sizeof run.result);
    for (uint32_t n = 0; n < 4; n++) {
        const lensprof_fit_result &r = run.settings[n];
        assert_int_equal(r.camera, n / 2);
        assert_int_equal(r.images, 2);
        assert_int_equal(r.reference, run.result.reference);
        assert_memory_equal(&r.response, &run.of_camera(r.camera).response, sizeof r.response);
        lensprof_profile profile;
        lensprof_profile_init(&profile);
        std::strcpy(profile.key.lens, "a lens");
        std::strcpy(profile.provenance.source, "a file");
        profile.grid.columns = profile.grid.rows = 2, profile.grid.channels = 1;
        profile.provenance.created_unix_s = 5, profile.provenance.prior_id = 7, profile.provenance.forced = 1;
        assert_ok(lensprof_fit_profile(run.held.get(), n, &profile, nullptr));
        assert_string_equal(profile.key.lens, "a lens");  // the caller's
        assert_string_equal(profile.provenance.source, "a file");
        assert_int_equal(profile.provenance.created_unix_s, 5);
        assert_int_equal(profile.provenance.prior_id, 7);
        assert_int_equal(profile.provenance.forced, 1);
        assert_int_equal(profile.grid.columns, 0);
        assert_memory_equal(&profile.response[0], &r.response, sizeof r.response);
        assert_memory_equal(profile.vignetting, r.vignetting, sizeof r.vignetting);
        assert_int_equal(profile.covariance_size, r.covariance_size);
        assert_memory_equal(profile.covariance, r.covariance, r.covariance_size * r.covariance_size * sizeof(double));
        assert_string_equal(profile.provenance.method, "transfer");
        assert_string_equal(profile.provenance.software, "lensprof 0.3.0");
        assert_int_equal(profile.provenance.images, r.images);
        assert_int_equal(profile.provenance.pairs, r.setting_pairs);
        assert_int_equal(profile.provenance.not_usable, !r.usable);
        assert_close(profile.provenance.heldout_rms, r.heldout_rms, 0.0);
        assert_ok(lensprof_profile_validate(&profile));
    }
}

// The pictures of a prior count if it is part of the result; unknown errors of gamma are 0.
void test_provenance(void **) {
    const Simulation s = sequence();
    Run run;
    assert_ok(run.fit(s, default_fit()));
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    lensprof_fit &held = *run.held;
    held.prior_images = 10, held.prior_pairs = UINT32_MAX - 5;
    held.results[0].gamma_sigma = LENSPROF_UNKNOWN;
    const char *const names[] = {"transfer", "radiance", "transfer-function"};
    for (held.method = 0; held.method < 3; held.method++) {
        assert_ok(lensprof_fit_profile(&held, LENSPROF_FIT_REFERENCE, &profile, nullptr));
        assert_string_equal(profile.provenance.method, names[held.method]);
    }
    assert_int_equal(profile.provenance.images, s.images + 10);
    assert_int_equal(profile.provenance.pairs, UINT32_MAX);  // saturates instead of overflowing
    assert_close(profile.provenance.gamma_sigma, 0.0, 0.0);
    const FitRun first = run_fit(sequence(5));
    assert_ok(lensprof_fit_profile(first.held.get(), 0, &profile, nullptr));
    lensprof_fit_options options = default_fit();
    options.profile = &profile;
    Run second;
    assert_ok(second.fit(s, options));
    assert_int_equal(second.result.profile_prior, LENSPROF_PROFILE_PRIOR_USED);
    const uint32_t images = profile.provenance.images;
    assert_ok(lensprof_fit_profile(second.held.get(), 0, &profile, nullptr));
    assert_int_equal(profile.provenance.images, images + s.images);
}

// The figure is that of the fit, whatever the cameras; pairs between cameras are refused.
void test_transfer_rms(void **) {
    const Simulation s = sequence();
    const FitRun run = run_fit(s);
    double rms = 0.0, median = 0.0;
    const auto count = static_cast<uint32_t>(s.pairs.size());
    assert_ok(lensprof_fit_transfer_rms(run.held.get(), s.pairs.data(), count, &rms, &median, nullptr));
    assert_close(rms, run.result.heldout_rms, 0.3 * run.result.heldout_rms);
    assert_close(median, run.result.heldout_median, 0.3 * run.result.heldout_median);
    Simulation several = cameras_and_settings();
    Run of_cameras;
    assert_ok(of_cameras.fit(several, default_fit()));
    lensprof_error error;
    const lensprof_pair *pairs = several.pairs.data();
    assert_int_equal(lensprof_fit_transfer_rms(of_cameras.held.get(), pairs,
                                               static_cast<uint32_t>(several.pairs.size()), &rms, nullptr, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_non_null(std::strstr(error.text, "two cameras"));
    const auto is_between = [&](const lensprof_pair &p) {
        return several.fit_images[p.image[0]].camera != several.fit_images[p.image[1]].camera;
    };
    several.pairs.erase(std::remove_if(several.pairs.begin(), several.pairs.end(), is_between), several.pairs.end());
    assert_ok(lensprof_fit_transfer_rms(of_cameras.held.get(), pairs, static_cast<uint32_t>(several.pairs.size()), &rms,
                                        &median, nullptr));
    assert_true(median < 3.0);
}

void test_refused(void **) {
    const Simulation s = sequence();
    Run run;
    assert_ok(run.fit(s, default_fit()));
    lensprof_fit *fit = run.held.get();
    lensprof_fit_image_quality quality;
    lensprof_fit_result result;
    lensprof_fit_camera camera;
    lensprof_finding finding;
    lensprof_profile profile;
    lensprof_error error;
    double rms;
    const auto prepare = [&] {
        lensprof_fit_image_quality_init(&quality), lensprof_fit_result_init(&result);
        lensprof_fit_camera_init(&camera), lensprof_profile_init(&profile), lensprof_finding_init(&finding);
        error.text[0] = 0;
    };
    const auto all = [&](const lensprof_fit *of, uint32_t image, uint32_t setting, uint32_t number,
                         lensprof_status wanted) {
        prepare();
        assert_int_equal(lensprof_fit_image_at(of, image, &quality, &error), wanted);
        assert_int_equal(lensprof_fit_setting_at(of, setting, &result, nullptr), wanted);
        assert_int_equal(lensprof_fit_camera_at(of, number, &camera, nullptr), wanted);
        assert_int_equal(lensprof_fit_finding_at(of, setting, 0, &finding, nullptr), wanted);
        assert_int_equal(lensprof_fit_profile(of, setting, &profile, nullptr), wanted);
        assert_int_equal(*error.text == 0, wanted == LENSPROF_OK);
    };
    all(fit, s.images - 1, 0, 0, LENSPROF_OK);
    all(fit, s.images, 1, 1, LENSPROF_ERROR_ARGUMENT);
    assert_non_null(std::strstr(error.text, "no image 6, but 6"));
    all(fit, UINT32_MAX, UINT32_MAX - 1, UINT32_MAX, LENSPROF_ERROR_ARGUMENT);
    all(nullptr, 0, 0, 0, LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_image_at(fit, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_setting_at(fit, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_camera_at(fit, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_finding_at(fit, 0, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_profile(fit, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_transfer_rms(fit, nullptr, 1, &rms, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_transfer_rms(fit, s.pairs.data(), 0, &rms, nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_transfer_rms(fit, s.pairs.data(), 1, nullptr, nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    const uint32_t count = run.result.findings + run.result.passed;
    assert_ok(lensprof_fit_finding_at(fit, LENSPROF_FIT_REFERENCE, count - 1, &finding, &error));
    assert_int_equal(finding.severity, LENSPROF_SEVERITY_PASSED);
    for (const uint32_t beyond : {count, UINT32_MAX})
        assert_int_equal(lensprof_fit_finding_at(fit, 0, beyond, &finding, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(std::strstr(error.text, "no finding 4294967295, but"));
    finding.struct_size = 0;
    assert_int_equal(lensprof_fit_finding_at(fit, 0, 0, &finding, nullptr), LENSPROF_ERROR_STRUCT_SIZE);
    quality.struct_size = result.struct_size = camera.struct_size = profile.struct_size = 0;
    assert_int_equal(lensprof_fit_image_at(fit, 0, &quality, nullptr), LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(lensprof_fit_setting_at(fit, 0, &result, nullptr), LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(lensprof_fit_camera_at(fit, 0, &camera, nullptr), LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(lensprof_fit_profile(fit, 0, &profile, nullptr), LENSPROF_ERROR_STRUCT_SIZE);

    std::vector<uint64_t> memory(lensprof_fit_bytes(s.fit_images.data(), s.images) / 8);
    std::vector<lensprof_exposure> exposures(s.images);
    lensprof_fit *released = nullptr;
    const lensprof_fit_options options = default_fit();
    assert_ok(lensprof_fit_overlap(&options, s.fit_images.data(), s.images, s.pairs.data(),
                                   static_cast<uint32_t>(s.pairs.size()), memory.data(), 8 * memory.size(),
                                   exposures.data(), &released, nullptr));
    lensprof_fit_destroy(released);
    all(released, 0, 0, 0, LENSPROF_ERROR_ARGUMENT);
    assert_non_null(std::strstr(error.text, "released"));
    lensprof_fit_destroy(released);
    lensprof_fit_destroy(nullptr);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory),     cmocka_unit_test(test_settings_and_cameras),
        cmocka_unit_test(test_provenance), cmocka_unit_test(test_transfer_rms),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
