// Which of several profiles fits given pairs, of simulated cameras that are known.
#include <cmath>
#include <vector>

#include <lensprof/trial.h>

#include "simulated.hpp"

namespace {

using Profiles = std::vector<const lensprof_profile *>;

lensprof_profile profile_of(const Simulation &simulation, double depth) {
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    profile.response[0] = simulation.response;
    profile.vignetting[0] = simulation.vignetting;
    for (double &k : profile.vignetting[0].k) k *= depth;
    return profile;
}

Simulation simulated(double noise_levels, double outliers, uint32_t channels = 3) {
    Simulation simulation;
    simulation.channels = channels;
    assert_ok(lensprof_response_set_typical(&simulation.response, LENSPROF_CAMERA_STILL, nullptr, nullptr));
    simulation.make(1500, noise_levels, outliers, 1.0, 3);
    return simulation;
}

struct Outcome {
    explicit Outcome(size_t count) : candidates(count) {
        lensprof_trial_result_init(&result);
        for (lensprof_trial_candidate &candidate : candidates) lensprof_trial_candidate_init(&candidate);
    }
    std::vector<lensprof_trial_candidate> candidates;
    lensprof_trial_result result;
};

lensprof_status run(const Simulation &s, const Profiles &profiles, Outcome &outcome,
                    const lensprof_trial_options *options = nullptr, lensprof_error *error = nullptr) {
    return lensprof_trial_run(options, s.fit_images.data(), static_cast<uint32_t>(s.fit_images.size()), s.pairs.data(),
                              static_cast<uint32_t>(s.pairs.size()), profiles.data(),
                              static_cast<uint32_t>(profiles.size()), outcome.candidates.data(), &outcome.result,
                              error);
}

lensprof_trial_options options_of(uint32_t channels, uint32_t camera_kind) {
    lensprof_trial_options options;
    lensprof_trial_options_init(&options);
    options.channels = channels, options.camera_kind = camera_kind;
    return options;
}

// Without noise the true profile leaves the rounding of the pairs, whatever their exposures; a third are outliers.
void test_true_profile_explains_all(void **) {
    for (const uint32_t channels : {1u, 3u})
        for (const double outliers : {0.0, 0.3}) {
            const Simulation simulation = simulated(0.0, outliers, channels);
            const lensprof_profile half = profile_of(simulation, 0.5), right = profile_of(simulation, 1.0);
            const lensprof_trial_options options = options_of(channels, LENSPROF_CAMERA_STILL);
            Outcome outcome(3);
            assert_ok(run(simulation, {&half, &right}, outcome, &options));
            assert_int_equal(outcome.result.best, 1);
            assert_true(outcome.result.usable && outcome.result.decided);
            assert_true(outcome.candidates[1].heldout_median < 0.01);
            if (outliers == 0.0) {
                assert_true(outcome.candidates[1].heldout_rms < 0.01);
                assert_true(outcome.candidates[0].heldout_rms > 3.0);
            }
            assert_true(outcome.candidates[0].better_than_none && !outcome.candidates[0].as_good_as_best);
            assert_false(outcome.candidates[2].better_than_none || outcome.candidates[2].has_falloff);
            assert_int_equal(outcome.candidates[2].response_from, LENSPROF_TRIAL_RESPONSE_KIND);
            assert_int_equal(outcome.candidates[1].response_from, LENSPROF_TRIAL_RESPONSE_OWN);
            assert_int_equal(outcome.result.images, simulation.images);
            const double share =
                outcome.result.unexplained / double(outcome.result.measured + outcome.result.unexplained);
            assert_true(std::fabs(share - outliers) < 0.06);
            assert_true(std::fabs(double(outcome.result.fitted) - 750.0) < 80.0);
        }
}

// The noise of a pair, of both ends: the residual of the true profile; equal profiles are not distinguished.
void test_noise(void **) {
    const Simulation simulation = simulated(1.0, 0.0);
    const lensprof_profile right = profile_of(simulation, 1.0);
    Outcome outcome(3);
    assert_ok(run(simulation, {&right, &right}, outcome));
    const lensprof_trial_candidate &found = outcome.candidates[0];
    assert_true(found.heldout_rms > 1.2 && found.heldout_rms < 2.5);
    assert_true(found.heldout_median < found.heldout_rms);
    assert_true(found.as_good_as_best && outcome.candidates[1].as_good_as_best);
    assert_true(found.heldout_rms == outcome.candidates[1].heldout_rms && outcome.candidates[1].above_best == 0.0);
    assert_true(outcome.result.usable && !outcome.result.decided && outcome.result.best == 0);
    const double below = outcome.candidates[2].heldout_rms - found.heldout_rms;
    assert_close(found.below_none, below, 1e-9);
    Outcome again(3);
    assert_ok(run(simulation, {&right, &right}, again));
    assert_memory_equal(again.candidates.data(), outcome.candidates.data(), 3 * sizeof found);
    assert_memory_equal(&again.result, &outcome.result, sizeof again.result);
}

// Sensor data have a linear response; a raw profile has no response for rendered pictures.
void test_raw(void **) {
    Simulation linear;
    lensprof_response_set_linear(&linear.response);
    linear.make(1500, 0.0, 0.0, 1.0, 3);
    lensprof_profile curved = profile_of(simulated(0.0, 0.0), 1.0), raw = profile_of(linear, 1.0);
    raw.key.processing = LENSPROF_PROCESSING_RAW;
    const lensprof_trial_options options = options_of(3, LENSPROF_CAMERA_LINEAR);
    Outcome outcome(2);
    assert_ok(run(linear, {&curved}, outcome, &options));
    assert_int_equal(outcome.candidates[0].response_from, LENSPROF_TRIAL_RESPONSE_LINEAR);
    assert_true(outcome.candidates[0].heldout_rms < 0.01);
    const Simulation rendered = simulated(0.0, 0.0);
    Outcome mixed(3);
    assert_ok(run(rendered, {&raw, &curved}, mixed));
    assert_int_equal(mixed.candidates[0].response_from, LENSPROF_TRIAL_RESPONSE_OTHER);
    assert_int_equal(mixed.candidates[0].response_profile, 1);
    assert_true(mixed.candidates[0].heldout_rms < 0.01);
}

// A profile with too much or too little light in the corners leaves them too dark or too bright.
void test_rings(void **) {
    const Simulation simulation = simulated(1.0, 0.1);
    std::vector<lensprof_profile> profiles(3, profile_of(simulation, 1.0));
    const double off[] = {0.0, 0.2, -0.2};
    for (int i = 1; i < 3; i++) profiles[static_cast<size_t>(i)].vignetting[0].k[0] += off[i] * std::log(2.0) * 0.7;
    Outcome outcome(4);
    assert_ok(run(simulation, {&profiles[0], &profiles[1], &profiles[2]}, outcome));
    const lensprof_trial_candidate *found = outcome.candidates.data();
    const uint32_t last = found[0].rings - 1;
    assert_true(last >= 2 && outcome.result.ring_end[0] == 0.25 && outcome.result.ring_end[4] == 1.0);
    assert_int_equal(found[0].corners, LENSPROF_TRIAL_CORNERS_AGREE);
    assert_int_equal(found[1].corners, LENSPROF_TRIAL_CORNERS_TOO_DARK);
    assert_int_equal(found[2].corners, LENSPROF_TRIAL_CORNERS_TOO_BRIGHT);
    assert_int_equal(found[3].corners, LENSPROF_TRIAL_CORNERS_TOO_DARK);
    for (uint32_t k = 0; k <= last; k++) {
        assert_true(std::fabs(found[0].ring_ev[k]) <= 3.0 * found[0].ring_sigma_ev[k]);
        assert_true(found[0].ring_sigma_ev[k] < 0.05);
    }
    assert_true(found[1].better_than_none && found[2].better_than_none && !found[3].better_than_none);
}

// The standard errors follow the scatter: small with little noise, larger where pairs of a part of a picture share an
// error.
void test_ring_errors(void **) {
    Simulation simulation = simulated(0.2, 0.0);
    const lensprof_profile right = profile_of(simulation, 1.0);
    Outcome clean(2), shaded(2);
    assert_ok(run(simulation, {&right}, clean));
    for (lensprof_pair &pair : simulation.pairs)
        for (int side = 0; side < 2; side++)
            if (pair.image[side] == 1 && pair.xy[side][0] < 300.0)
                for (double &value : pair.value[side]) value *= 0.98;
    assert_ok(run(simulation, {&right}, shaded));
    const lensprof_trial_candidate &found = clean.candidates[0], &common = shaded.candidates[0];
    const uint32_t last = found.rings - 1;
    assert_int_equal(common.rings, found.rings);
    assert_true(last >= 2 && common.ring_sigma_ev[last] > 2.0 * found.ring_sigma_ev[last]);
    for (uint32_t k = 1; k <= last; k++) {
        assert_true(found.ring_sigma_ev[k] < 0.002);
        assert_true(std::fabs(found.ring_ev[k]) <= 3.0 * found.ring_sigma_ev[k]);
        assert_true(std::fabs(common.ring_ev[k]) <= 3.0 * common.ring_sigma_ev[k]);
    }
}

void test_before_rms(void **) {
    Simulation simulation = simulated(0.0, 0.0);
    for (lensprof_pair &pair : simulation.pairs)
        for (int c = 0; c < 3; c++) pair.value[0][c] = 0.5, pair.value[1][c] = 0.4;
    const lensprof_profile flat = profile_of(simulation, 0.0);
    Outcome outcome(2);
    assert_ok(run(simulation, {&flat}, outcome));
    assert_close(outcome.result.before_rms, 25.5, 1e-9);
    assert_false(outcome.candidates[0].has_falloff || outcome.result.usable);
}

void test_few_pairs(void **) {
    Simulation simulation = simulated(0.0, 0.0);
    const lensprof_profile right = profile_of(simulation, 1.0);
    const Outcome before(2);
    Outcome outcome(2);
    for (const size_t count : {40, 1, 0}) {
        simulation.pairs.resize(count);
        lensprof_error error;
        assert_int_equal(run(simulation, {&right}, outcome, nullptr, &error), LENSPROF_ERROR_NO_SAMPLES);
        assert_non_null(std::strstr(error.text, "at least 30"));
        assert_memory_equal(&outcome.result, &before.result, sizeof outcome.result);
    }
}

void refused(lensprof_status status, const Simulation &simulation, const Profiles &profiles,
             const lensprof_trial_options *options = nullptr) {
    const Outcome before(profiles.size() + 1);
    Outcome outcome(profiles.size() + 1);
    lensprof_error error;
    assert_int_equal(run(simulation, profiles, outcome, options, &error), status);
    assert_int_equal(error.text[0] != 0, 1);
    assert_memory_equal(&outcome.result, &before.result, sizeof outcome.result);
    assert_memory_equal(outcome.candidates.data(), before.candidates.data(),
                        before.candidates.size() * sizeof before.candidates[0]);
}

void test_bad_pairs(void **) {
    const Simulation good = simulated(0.0, 0.0);
    const lensprof_profile right = profile_of(good, 1.0);
    const auto with = [&](lensprof_status status, auto change) {
        Simulation bad = good;
        change(bad.pairs[700]);
        refused(status, bad, {&right});
    };
    with(LENSPROF_ERROR_ARGUMENT, [](lensprof_pair &pair) { pair.image[1] = 6; });
    with(LENSPROF_ERROR_ARGUMENT, [](lensprof_pair &pair) { pair.image[1] = pair.image[0]; });
    with(LENSPROF_ERROR_ARGUMENT, [](lensprof_pair &pair) { pair.xy[1][0] = 801.0; });
    with(LENSPROF_ERROR_ARGUMENT, [](lensprof_pair &pair) { pair.value[0][2] = 1.5; });
    with(LENSPROF_ERROR_NOT_FINITE, [](lensprof_pair &pair) { pair.xy[0][1] = NAN; });
    with(LENSPROF_ERROR_NOT_FINITE, [](lensprof_pair &pair) { pair.value[1][1] = NAN; });
    Simulation bad = good;
    bad.fit_images[2].width = 0;
    refused(LENSPROF_ERROR_SIZE, bad, {&right});
}

void test_bad_profiles(void **) {
    const Simulation simulation = simulated(0.0, 0.0);
    lensprof_profile right = profile_of(simulation, 1.0), bad = right;
    refused(LENSPROF_ERROR_ARGUMENT, simulation, {});
    refused(LENSPROF_ERROR_ARGUMENT, simulation, {&right, nullptr});
    bad.vignetting[0].k[0] = NAN;
    refused(LENSPROF_ERROR_NOT_FINITE, simulation, {&right, &bad});
    bad.vignetting[0].k[0] = -5.0;
    refused(LENSPROF_ERROR_VIGNETTING, simulation, {&bad, &right});
    for (const auto &options : {options_of(2, 0), options_of(3, 6)})
        refused(LENSPROF_ERROR_ARGUMENT, simulation, {&right}, &options);
    lensprof_trial_options unset{};
    refused(LENSPROF_ERROR_STRUCT_SIZE, simulation, {&right}, &unset);
}

void test_bad_pointers_and_sizes(void **) {
    const Simulation s = simulated(0.0, 0.0);
    const lensprof_profile right = profile_of(s, 1.0);
    const lensprof_profile *const one[] = {&right};
    const auto images = s.fit_images.data();
    const auto pairs = s.pairs.data();
    Outcome o(2);
    const auto call = [&](const lensprof_fit_image *i, const lensprof_pair *p, const lensprof_profile *const *profiles,
                          lensprof_trial_candidate *candidates, lensprof_trial_result *result) {
        return lensprof_trial_run(nullptr, i, 6, p, 1500, profiles, 1, candidates, result, nullptr);
    };
    lensprof_trial_candidate *const found = o.candidates.data();
    assert_int_equal(call(nullptr, pairs, one, found, &o.result), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(call(images, nullptr, one, found, &o.result), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(call(images, pairs, nullptr, found, &o.result), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(call(images, pairs, one, nullptr, &o.result), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(call(images, pairs, one, found, nullptr), LENSPROF_ERROR_ARGUMENT);
    o.candidates[1].struct_size = 0;
    assert_int_equal(call(images, pairs, one, found, &o.result), LENSPROF_ERROR_STRUCT_SIZE);
    lensprof_trial_candidate_init(&found[1]);
    o.result.struct_size = 4;
    assert_int_equal(call(images, pairs, one, found, &o.result), LENSPROF_ERROR_STRUCT_SIZE);
}

// What follows a profile of an older version is not read.
void test_profiles_of_an_older_version(void **) {
    Simulation simulation = simulated(0.0, 0.0);
    lensprof_profile right = profile_of(simulation, 1.0), older = right;
    older.struct_size = offsetof(lensprof_profile, image_circle);
    older.image_circle = {{0.0, 0.0}, 0.3};
    Outcome wanted(2), found(2);
    assert_ok(run(simulation, {&right}, wanted));
    assert_ok(run(simulation, {&older}, found));
    for (int ring = 0; ring < LENSPROF_TRIAL_RINGS; ring++)
        assert_true(found.candidates[0].ring_ev[ring] == wanted.candidates[0].ring_ev[ring]);
}

// Any grey values, also black and white, and any falloff: figures are numbers.
void test_any_values(void **) {
    Simulation simulation = simulated(0.0, 0.0);
    uint64_t random = 5;
    for (lensprof_pair &pair : simulation.pairs)
        for (auto &side : pair.value)
            for (double &value : side) value = std::min(1.0, std::max(0.0, 3.0 * lp_random(&random) - 1.0));
    const lensprof_profile right = profile_of(simulation, 1.0);
    Outcome outcome(2);
    assert_ok(run(simulation, {&right}, outcome));
    for (const lensprof_trial_candidate &candidate : outcome.candidates)
        for (const double value : {candidate.heldout_rms, candidate.heldout_median, candidate.above_best_sigma,
                                   candidate.below_none, candidate.below_none_sigma})
            assert_true(std::isfinite(value));
}

}  // namespace

int main(void) {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_true_profile_explains_all),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_raw),
        cmocka_unit_test(test_rings),
        cmocka_unit_test(test_ring_errors),
        cmocka_unit_test(test_before_rms),
        cmocka_unit_test(test_few_pairs),
        cmocka_unit_test(test_bad_pairs),
        cmocka_unit_test(test_bad_profiles),
        cmocka_unit_test(test_bad_pointers_and_sizes),
        cmocka_unit_test(test_profiles_of_an_older_version),
        cmocka_unit_test(test_any_values),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
