// The overlap fit compared with simulated truth.
#include "simulated.hpp"

namespace {

struct Run : FitRun {
    double gamma;
};

Run fit(const Simulation &s, const lensprof_fit_options &options) {
    Run run;
    lensprof_error error;
    const lensprof_status status = fit_into(run, options, s.fit_images, s.pairs, &error);
    if (status != LENSPROF_OK) print_error("%s\n", error.text);
    assert_ok(status);
    assert_true(is_monotone(run.result.response));
    assert_ok(lensprof_response_validate(&run.result.response));
    assert_ok(lensprof_vignetting_validate(&run.result.vignetting[0]));
    run.gamma = s.gamma(run.exposures);
    return run;
}

lensprof_fit_options default_options() {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    return options;
}

Simulation simulate(const lensprof_response &response, uint32_t pairs, double noise, double outliers, double ev = 1.0) {
    Simulation s;
    s.response = response;
    s.make(pairs, noise, outliers, ev, 42);
    return s;
}

// Noise of 2 levels; a pair's images are up to `reach` apart.
Simulation mosaic(uint32_t images, uint32_t reach, uint32_t pairs, double outliers, uint64_t seed) {
    Simulation s;
    s.response = srgb_response();
    s.images = images;
    s.reach = reach;
    s.make(pairs, 2.0, outliers, 1.0, seed);
    return s;
}

// Transfer residual of the noise-free truth: the mismatch a user sees in corrected pictures.
double clean_rms(const Simulation &s, const Run &run) {
    Simulation clean = s;
    clean.exposures.clear(), clean.fit_images.clear(), clean.pairs.clear();
    clean.make(1000, 0.0, 0.0, 1.0, 42);
    double rms = 0;
    assert_ok(lensprof_fit_transfer_rms(run.held.get(), clean.pairs.data(), 1000, &rms, nullptr, nullptr));
    return rms;
}

void test_recovers_an_srgb_camera(void **) {
    Simulation s = simulate(srgb_response(), 2000, 1.0, 0.0);
    Run run = fit(s, default_options());
    assert_int_equal(run.result.usable, 1);
    assert_string_equal(run.result.first.text, "");
    assert_int_equal(run.result.first.code, LENSPROF_REASON_NONE);
    assert_int_equal(run.result.first.value_count, 0);
    // Unknown exposures and response: the exponent depends on the prior, whose spread over measured curves is 0.15.
    assert_close(std::log(run.gamma), 0.0, 0.35);
    assert_true(s.exposure_error(run.exposures, run.gamma) < 0.01);
    assert_true(s.falloff_error(run.result.vignetting[0], run.gamma) < 0.01);
    assert_close(run.result.vignetting[0].center[0], 0.02, 0.01);
    assert_close(run.result.vignetting[0].center[1], -0.015, 0.01);
    assert_close(run.result.noise_levels, 1.0, 0.15);
    assert_true(run.result.heldout_rms < 2.0 && run.result.before_rms > 10.0);
    assert_true(run.result.inlier_share > 0.98);
    assert_true(clean_rms(s, run) < 0.4);
}

// A linear sensor, for which the mean of the model is a poor start.
void test_recovers_a_linear_camera(void **) {
    lensprof_response linear;
    lensprof_response_set_linear(&linear);
    Simulation s = simulate(linear, 2000, 1.0, 0.05);
    Run run = fit(s, default_options());
    assert_true(clean_rms(s, run) < 0.5);
    assert_true(s.exposure_error(run.exposures, run.gamma) < 0.02);
}

void test_survives_outliers(void **) {
    for (double share : {0.1, 0.3, 0.5}) {
        Simulation s = simulate(srgb_response(), 600, 2.0, share);
        Run run = fit(s, default_options());
        assert_true(clean_rms(s, run) < 1.5);
        assert_close(run.result.inlier_share, 1.0 - share, 0.06);
    }
}

// A mosaic with little more than one pair per edge: no edge can identify its wrong pairs by itself. A wrong pair
// distorts an image in five or six of 120 such mosaics; in which of them depends on details of the fit.
void test_few_pairs_on_many_images(void **) {
    int wrong = 0;
    for (uint64_t seed = 1; seed <= 24; seed++) {
        Simulation s = mosaic(40, 4, 200, 0.15, seed);
        Run run = fit(s, default_options());
        const double error = s.exposure_error(run.exposures, run.gamma);
        assert_true(error < 0.7);
        wrong += error >= 0.6;
    }
    assert_in_range(wrong, 0, 1);
}

// Most pairs of the last image are with the first image, for which the project has the wrong place: these pairs do not
// agree with each other.
void test_a_large_edge_in_the_wrong_place(void **) {
    for (uint64_t seed = 1; seed <= 8; seed++) {
        Simulation s = mosaic(4, 3, 1500, 0.0, seed);
        uint64_t random = seed;
        uint32_t right = 0;
        std::vector<lensprof_pair> pairs;
        for (lensprof_pair p : s.pairs) {
            if (p.image[1] == 3 && p.image[0] != 0 && ++right > 80) continue;
            double darker = 0.1 + 0.8 * lp_random(&random);
            for (int c = 0; c < 3 && p.image[0] == 0 && p.image[1] == 3; c++) p.value[1][c] = p.value[0][c] * darker;
            pairs.push_back(p);
        }
        s.pairs = pairs;
        Run run = fit(s, default_options());
        assert_true(s.exposure_error(run.exposures, run.gamma) < 0.2);
    }
}

void test_the_paper_s_variant(void **) {
    Simulation s = simulate(srgb_response(), 1000, 2.0, 0.1);
    lensprof_fit_options options = default_options();
    options.modes = 5;
    options.prior_weight = 0.0;
    options.loss = LENSPROF_LOSS_HUBER;
    Run huber = fit(s, options);
    assert_int_equal(huber.result.response.modes, 5);
    assert_true(clean_rms(s, huber) < 1.5);
    options.loss = LENSPROF_LOSS_SQUARED;
    assert_true(clean_rms(s, fit(s, options)) > clean_rms(s, huber));  // d'Angelo, figure 1
}

void test_grey_pictures(void **) {
    Simulation s;
    s.response = srgb_response();
    s.channels = 1;
    s.make(1500, 1.0, 0.1, 1.0, 42);
    lensprof_fit_options options = default_options();
    options.channels = 1;
    Run run = fit(s, options);
    assert_true(clean_rms(s, run) < 0.6);
    for (const auto &e : run.exposures) assert_close(e.white_balance[0], 1.0, 0.0);
}

// Fixed parameters keep every bit; with a known response no exponent is left open.
void test_known_response_gives_absolute_values(void **) {
    Simulation s = simulate(srgb_response(), 2000, 1.0, 0.1);
    lensprof_fit_options options = default_options();
    options.free &= ~LENSPROF_FREE_RESPONSE;
    options.response = &s.response;
    Run run = fit(s, options);
    assert_int_equal(run.result.covariance_size, run.result.response.modes + 5);
    assert_memory_equal(run.result.response.table, s.response.table, sizeof s.response.table);
    assert_close(run.gamma, 1.0, 0.01);
    assert_true(s.exposure_error(run.exposures, 1.0) < 0.01);
    assert_true(s.falloff_error(run.result.vignetting[0], 1.0) < 0.01);
}

void test_fixed_and_linked_parameters(void **) {
    Simulation s = simulate(srgb_response(), 2000, 1.0, 0.0);
    lensprof_fit_options options = default_options();
    options.free = LENSPROF_FREE_RESPONSE | LENSPROF_FREE_K1;
    options.vignetting = {{0.0, 0.05, -0.15}, {0.02, -0.015}};
    options.reference = 2;
    s.fit_images[2].exposure.ev = s.exposures[2].ev;
    s.fit_images[4].free = 0;
    s.fit_images[4].exposure = s.exposures[4];
    s.fit_images[0].free = 0;  // far outside the range of free exposures, but kept
    s.fit_images[0].exposure.ev = 30.0;
    s.pairs.erase(
        std::remove_if(s.pairs.begin(), s.pairs.end(), [](const lensprof_pair &p) { return p.image[0] == 0; }),
        s.pairs.end());
    s.fit_images[5].red_of = 3;
    Run run = fit(s, options);
    assert_close(run.exposures[2].ev, s.exposures[2].ev, 1e-12);  // the reference
    assert_close(run.exposures[4].ev, s.exposures[4].ev, 1e-12);  // fixed
    assert_close(run.exposures[0].ev, 30.0, 1e-12);
    assert_close(run.exposures[4].white_balance[2], s.exposures[4].white_balance[2], 1e-12);
    assert_close(run.exposures[5].white_balance[0], run.exposures[3].white_balance[0], 1e-12);  // linked
    assert_close(run.result.vignetting[0].k[1], 0.05, 0.0);
    assert_close(run.result.vignetting[0].center[0], 0.02, 0.0);
    assert_true(run.result.vignetting[0].k[0] < -0.1);
}

void test_number_of_modes(void **) {
    Simulation s = simulate(srgb_response(), 1500, 1.0, 0.0);
    lensprof_fit_options options = default_options();
    for (uint32_t modes : {0u, 1u, 8u, 25u}) {
        options.modes = modes;
        assert_int_equal(fit(s, options).result.response.modes, modes);
    }
    // Modes that noise hides are not needed; more modes are needed if the noise is low.
    options.modes = LENSPROF_MODES_AUTO;
    lensprof_response mean, far;
    assert_ok(lensprof_response_set_emor(&mean, nullptr, 0));
    lensprof_response_set_linear(&far);
    uint32_t few = fit(simulate(mean, 1500, 2.0, 0.0), options).result.response.modes;
    uint32_t many = fit(simulate(far, 3000, 0.3, 0.0), options).result.response.modes;
    assert_true(few <= 7);
    assert_true(many > few);
}

// Chunks of pairs go to threads in any order; their results are combined in a fixed order.
void test_same_input_same_bytes(void **) {
    Simulation s = simulate(srgb_response(), 6000, 2.0, 0.2);
    lensprof_fit_options options = default_options();
    options.threads = 1;
    Run a = fit(s, options);
    a.result.seconds = 0.0;
    for (uint32_t threads : {1u, 2u, 5u, 0u}) {
        options.threads = threads;
        Run b = fit(s, options);
        b.result.seconds = 0.0;
        assert_memory_equal(&a.result, &b.result, sizeof a.result);
        assert_memory_equal(a.exposures.data(), b.exposures.data(), a.exposures.size() * sizeof a.exposures[0]);
    }
}

void test_unconnected_images_are_not_usable(void **) {
    Simulation s = simulate(srgb_response(), 1000, 1.0, 0.0);
    s.pairs.erase(
        std::remove_if(s.pairs.begin(), s.pairs.end(), [](const lensprof_pair &p) { return p.image[0] == 2; }),
        s.pairs.end());
    Run run = fit(s, default_options());
    assert_int_equal(run.result.usable, 0);
    assert_int_equal(run.result.components, 2);
    assert_reason(run.result, IMAGE_GROUPS, "2 groups: no usable overlap connects image 3 ");
    assert_int_equal(run.result.first.item.index, 3);
}

void test_too_few_pairs_are_not_usable(void **) {
    Simulation s = simulate(srgb_response(), 5, 1.0, 0.0);
    Run run = fit(s, default_options());
    assert_int_equal(run.result.usable, 0);
    assert_close(run.result.heldout_rms, LENSPROF_UNKNOWN, 0.0);
}

// The scatter of the estimate over simulations agrees with its stated covariance (for a known response, so that the
// linearisation is accurate).
void test_covariance_is_of_the_right_size(void **) {
    double square = 0.0, stated = 0.0;
    const int runs = 40;
    for (int k = 0; k < runs; k++) {
        Simulation s;
        s.response = srgb_response();
        s.make(400, 2.0, 0.0, 1.0, 1000 + k);
        lensprof_fit_options options = default_options();
        options.free &= ~LENSPROF_FREE_RESPONSE;
        options.response = &s.response;
        Run run = fit(s, options);
        assert_int_equal(run.result.covariance_size, 5);
        double m = lensprof_vignetting_eval(&run.result.vignetting[0], 1.0, nullptr) - 0.6, variance = 0.0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) variance += run.result.covariance[i * 5 + j];
        square += m * m / runs;
        stated += variance / runs;
    }
    assert_true(std::sqrt(square / stated) > 0.7 && std::sqrt(square / stated) < 1.4);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_recovers_an_srgb_camera),
        cmocka_unit_test(test_recovers_a_linear_camera),
        cmocka_unit_test(test_survives_outliers),
        cmocka_unit_test(test_few_pairs_on_many_images),
        cmocka_unit_test(test_a_large_edge_in_the_wrong_place),
        cmocka_unit_test(test_the_paper_s_variant),
        cmocka_unit_test(test_grey_pictures),
        cmocka_unit_test(test_known_response_gives_absolute_values),
        cmocka_unit_test(test_fixed_and_linked_parameters),
        cmocka_unit_test(test_number_of_modes),
        cmocka_unit_test(test_same_input_same_bytes),
        cmocka_unit_test(test_unconnected_images_are_not_usable),
        cmocka_unit_test(test_too_few_pairs_are_not_usable),
        cmocka_unit_test(test_covariance_is_of_the_right_size),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
