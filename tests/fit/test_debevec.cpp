// The method `debevec` compared with simulated truth.
#include "simulated.hpp"

namespace {

lensprof_fit_options by_debevec() {
    lensprof_fit_options options = default_fit();
    options.method = LENSPROF_METHOD_DEBEVEC;
    options.free = LENSPROF_FREE_RESPONSE;
    return options;
}

// A bracket of five pictures 1 EV apart by a stationary camera.
Simulation bracket(const lensprof_response &response, double noise, uint32_t count = 20000) {
    Simulation s;
    s.response = response;
    s.vignetting = {{0.0, 0.0, 0.0}, {0.0, 0.0}};
    s.images = 5;
    s.reach = 2;
    for (uint32_t i = 0; i < s.images; i++) s.exposures.push_back({2.0 - i, {1.0, 1.0, 1.0}});
    s.make(count, noise, 0.0, 0.0, 42);
    for (uint32_t i = 0; i < s.images; i++) {
        s.fit_images[i].known_ev = s.exposures[i].ev + 7.0;  // the common offset is arbitrary
        s.fit_images[i].known_ev_sigma = 0.05;
    }
    return s;
}

// RMS difference from the truth over the grey values 5..250, in levels, at the best scale, and the largest difference
// from 20 up. Below 20, noise is a large part of the value, and least squares on a logarithm are biased (6 levels for
// gamma 2.2).
struct Error {
    double rms, largest;
};
Error response_error(const lensprof_response &found, const lensprof_response &truth) {
    Error best{255.0, 255.0};
    for (double scale = 0.5; scale < 2.0; scale *= 1.001) {
        double sum = 0.0, largest = 0.0;
        for (int b = 5; b <= 250; b++) {
            double light = scale * lensprof_response_invert(&found, b / 255.0, nullptr);
            double off = 255.0 * lensprof_response_eval(&truth, std::min(light, 1.0), nullptr) - b;
            sum += off * off;
            if (b >= 20) largest = std::max(largest, std::abs(off));
        }
        if (sum / 246.0 < best.rms * best.rms) best = {std::sqrt(sum / 246.0), largest};
    }
    return best;
}

void test_recovers_responses(void **) {
    for (const lensprof_response &response : {srgb_response(), gamma_response(2.2), film_response(), linear_response()})
        for (double noise : {0.0, 1.0}) {
            Simulation s = bracket(response, noise);
            FitRun run = run_fit(s, by_debevec());
            Error error = response_error(run.result.response, response);
            print_message("noise %.0f: response error %.2f levels RMS, %.2f at most; held-out %.2f\n", noise, error.rms,
                          error.largest, run.result.heldout_rms);
            assert_int_equal(run.result.usable, 1);
            assert_true(is_monotone(run.result.response));
            assert_ok(lensprof_response_validate(&run.result.response));
            assert_int_equal(run.result.response.kind, LENSPROF_RESPONSE_TABLE);
            assert_true(error.rms < 1.0 && error.largest < 2.5);
            assert_close(run.result.noise_levels, noise, 0.3);
            assert_int_equal(run.result.covariance_size, 0);
        }
}

// Exposures equal the known ones relative to the reference, whose own exposure stays as given.
void test_exposures_are_the_known_ones(void **) {
    Simulation s = bracket(srgb_response(), 1.0, 4000);
    lensprof_fit_options options = by_debevec();
    options.reference = 3;
    s.fit_images[3].exposure.ev = 0.25;
    FitRun run = run_fit(s, options);
    for (uint32_t i = 0; i < s.images; i++)
        assert_close(run.exposures[i].ev, s.exposures[i].ev - s.exposures[3].ev + 0.25, 1e-12);
    assert_int_equal(run.result.gamma_from, LENSPROF_GAMMA_KNOWN);
    for (const auto &q : run.quality) assert_close(q.known_ev_residual, 0.0, 1e-9);
}

// Held falloff and white balances enter the equations.
void test_held_falloff_and_white_balance(void **) {
    Simulation s = bracket(srgb_response(), 1.0, 1);
    s.vignetting = {{-0.3, 0.05, -0.15}, {0.0, 0.0}};
    for (uint32_t i = 0; i < s.images; i++) s.exposures[i].white_balance[0] = 1.0 + 0.1 * i;
    s.fit_images.clear(), s.pairs.clear();
    s.make(10000, 1.0, 0.0, 0.0, 7);
    for (uint32_t i = 0; i < s.images; i++) {
        s.fit_images[i].exposure = s.exposures[i];
        s.fit_images[i].known_ev = s.exposures[i].ev, s.fit_images[i].known_ev_sigma = 0.05;
    }
    lensprof_fit_options options = by_debevec();
    options.vignetting = s.vignetting;
    FitRun run = run_fit(s, options);
    assert_int_equal(run.result.usable, 1);
    assert_true(response_error(run.result.response, s.response).rms < 1.0);
    assert_close(run.exposures[2].white_balance[0], 1.2, 1e-12);
    assert_memory_equal(&run.result.vignetting[0], &s.vignetting, sizeof s.vignetting);
}

// Smoothness is the only prior: with little data, more of it is better; without any, the call still returns.
void test_smoothness(void **) {
    Simulation s = bracket(srgb_response(), 2.0, 300);
    lensprof_fit_options options = by_debevec();
    FitRun smooth = run_fit(s, options);
    options.prior_weight = 0.0;
    FitRun rough = run_fit(s, options);
    assert_true(is_monotone(rough.result.response));
    assert_true(response_error(smooth.result.response, s.response).rms
                < response_error(rough.result.response, s.response).rms);
}

void test_grey_pictures(void **) {
    Simulation s = bracket(srgb_response(), 1.0, 1);
    s.channels = 1;
    s.pairs.clear(), s.fit_images.clear();
    s.make(20000, 1.0, 0.0, 0.0, 9);
    for (uint32_t i = 0; i < s.images; i++)
        s.fit_images[i].known_ev = s.exposures[i].ev, s.fit_images[i].known_ev_sigma = 0.05;
    lensprof_fit_options options = by_debevec();
    options.channels = 1;
    FitRun run = run_fit(s, options);
    assert_int_equal(run.result.usable, 1);
    assert_true(response_error(run.result.response, s.response).rms < 1.0);
}

void test_same_bytes(void **) {
    Simulation s = bracket(film_response(), 2.0, 5000);
    lensprof_fit_options options = by_debevec();
    options.threads = 1;
    FitRun one = run_fit(s, options);
    options.threads = 5;
    FitRun five = run_fit(s, options);
    one.result.seconds = five.result.seconds = 0.0;
    assert_memory_equal(&one.result, &five.result, sizeof one.result);
    assert_memory_equal(one.exposures.data(), five.exposures.data(), one.exposures.size() * sizeof one.exposures[0]);
}

void test_exposures_that_cannot_be(void **) {
    Simulation reversed = bracket(srgb_response(), 1.0, 4000);
    for (auto &image : reversed.fit_images) image.known_ev = -image.known_ev;
    FitRun run = run_fit(reversed, by_debevec());
    assert_int_equal(run.result.usable, 0);
    assert_reason(run.result, KNOWN_REVERSED, "falls");
    assert_true(is_monotone(run.result.response));

    Simulation alike = bracket(srgb_response(), 1.0, 4000);
    for (auto &image : alike.fit_images) image.known_ev = 1.0;
    run = run_fit(alike, by_debevec());
    assert_int_equal(run.result.usable, 0);
    assert_reason(run.result, KNOWN_ALIKE, "differ by only 0.00 EV");
    assert_true(is_monotone(run.result.response));
}

// Checks that the call is refused with `word` in the text, and that nothing is written.
void assert_refused(const Simulation &s, const lensprof_fit_options &options, lensprof_status expected,
                    const char *word) {
    std::vector<lensprof_exposure> exposures(s.images);
    std::memset(static_cast<void *>(exposures.data()), 0x5A, exposures.size() * sizeof exposures[0]);
    const auto before = exposures;
    lensprof_fit *fit = nullptr;
    lensprof_error error;
    assert_int_equal(
        lensprof_fit_overlap(&options, s.fit_images.data(), s.images, s.pairs.data(),
                             static_cast<uint32_t>(s.pairs.size()), nullptr, 0, exposures.data(), &fit, &error),
        expected);
    assert_memory_equal(exposures.data(), before.data(), exposures.size() * sizeof exposures[0]);
    assert_null(fit);
    if (!std::strstr(error.text, word)) print_error("'%s' does not contain '%s'\n", error.text, word);
    assert_non_null(std::strstr(error.text, word));
}

void test_refuses(void **) {
    Simulation s = bracket(srgb_response(), 1.0, 100);
    for (uint32_t flag : {LENSPROF_FREE_K1, LENSPROF_FREE_K2, LENSPROF_FREE_K3, LENSPROF_FREE_CENTER}) {
        lensprof_fit_options options = by_debevec();
        options.free |= flag;
        assert_refused(s, options, LENSPROF_ERROR_ARGUMENT, "fix falloff");
    }
    lensprof_fit_options held = by_debevec();
    held.free = 0;
    assert_refused(s, held, LENSPROF_ERROR_ARGUMENT, "response");
    Simulation unknown = s;
    unknown.fit_images[3].known_ev_sigma = 0.0;
    assert_refused(unknown, by_debevec(), LENSPROF_ERROR_ARGUMENT, "image 3");
    Simulation far = s;
    far.fit_images[0].known_ev = 60.0, far.fit_images[4].known_ev = -60.0;
    assert_refused(far, by_debevec(), LENSPROF_ERROR_EXPOSURE, "image 4");
    Simulation none = s;
    none.pairs.clear();
    assert_refused(none, by_debevec(), LENSPROF_ERROR_NO_SAMPLES, "no pairs");
    lensprof_fit_options unwanted = by_debevec();
    unwanted.progress = [](double, void *) { return 1; };
    assert_refused(s, unwanted, LENSPROF_ERROR_CANCELLED, "cancelled");
    lensprof_fit_options other = by_debevec();
    other.method = LENSPROF_METHOD_DEBEVEC + 1;
    assert_refused(s, other, LENSPROF_ERROR_ARGUMENT, "fit options");
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_recovers_responses),
        cmocka_unit_test(test_exposures_are_the_known_ones),
        cmocka_unit_test(test_held_falloff_and_white_balance),
        cmocka_unit_test(test_smoothness),
        cmocka_unit_test(test_grey_pictures),
        cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_exposures_that_cannot_be),
        cmocka_unit_test(test_refuses),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
