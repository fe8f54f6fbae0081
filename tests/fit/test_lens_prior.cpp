// The prior on falloff and centre: its figures, its weight against the pictures, and results that are left to simpler
// descriptions.
#include "simulated.hpp"

#include <Eigen/LU>

#include "falloff/rise.hpp"
#include "fit/prior/falloff_prior.hpp"

namespace {

using namespace lensprof;

double corner_of(const FitRun &run) { return lensprof_vignetting_eval(&run.result.vignetting[1], 1.0, nullptr); }

void test_derivatives_of_log_falloff(void **) {
    const double k[3] = {-0.3, 0.1, -0.2}, h = 1e-6;
    Eigen::Matrix3d slope;
    log_falloff(k, &slope);
    for (int n = 0; n < 3; n++) {
        double up[3] = {k[0], k[1], k[2]}, down[3] = {k[0], k[1], k[2]};
        up[n] += h, down[n] -= h;
        const Eigen::Vector3d numeric = (log_falloff(up, nullptr) - log_falloff(down, nullptr)) / (2 * h);
        for (int i = 0; i < 3; i++) assert_close(slope(i, n), numeric[i], 1e-7);
    }
}

// The medians of Lensfun's data by class (.52, .69, .77, .82), less the pictures that cameras correct.
void test_falloffs_weaken_with_every_stop(void **) {
    double last = 0.0;
    for (const double stops : {0.0, 1.0, 2.0, 3.0, 9.0}) {
        const FalloffPrior prior = expected_falloff({stops, LENSPROF_UNKNOWN});
        assert_true(expected_falloff({stops, 1.0}).mean[2] < prior.mean[2]);  // full frame
        assert_true(expected_falloff({stops, 1.5}).mean[2] > prior.mean[2]);
        const double corner = std::exp(prior.mean[2]), sigma = std::sqrt(prior.precision.inverse()(2, 2));
        assert_true(corner >= last && corner > 0.45 && corner < 0.9);
        assert_true(sigma > 0.1 && sigma < 0.6);
        last = corner;
    }
}

ShownFalloff shown(const double u[3], double sigma) {
    const Eigen::Matrix3d precision = Eigen::Matrix3d::Identity() / (sigma * sigma);
    return {precision, precision * Eigen::Vector3d::Map(u)};
}

void test_pictures_choose_among_lenses(void **) {
    double distance;
    const double corrected[3] = {0.001, -0.003, -0.004}, wide_open[3] = {-0.19, -0.42, -0.76},
                 rising[3] = {0.2, 0.5, 1.1};
    const FalloffPrior any = expected_falloff({});
    const FalloffPrior nothing = falloff_given(shown(wide_open, 30.0), {}, distance);
    for (int i = 0; i < 3; i++) assert_close(nothing.mean[i], any.mean[i], 0.02);
    assert_true(distance < 0.1);
    const FalloffPrior flat = falloff_given(shown(corrected, 0.005), {}, distance);
    assert_true(std::abs(flat.mean[2]) < 0.05 && distance < 1.0);
    const FalloffPrior steep = falloff_given(shown(wide_open, 0.02), {}, distance);
    assert_true(steep.mean[2] < any.mean[2] && distance < 1.5);
    const FalloffPrior far = falloff_given(shown(rising, 0.01), {}, distance);
    assert_true(distance > 4.0);  // no lens: the prior loses its weight
    assert_true(far.precision.determinant() < 0.1 * any.precision.determinant());
}

// The same pictures with a deeper falloff and a larger exponent: lenses tell which is likelier.
void test_the_depth_of_a_falloff_informs_gamma(void **) {
    Simulation s;
    s.response = srgb_response();
    s.make(2000, 1.0, 0.0, 0.7, 5);
    const FitRun unknown = run_fit(s);
    for (lensprof_fit_image &image : s.fit_images) image.f_number_ratio = image.crop_factor = 1.0;
    const FitRun wide_open = run_fit(s);  // most lenses have a corner of .35 then, and not of .6
    const auto ev_of = [](const FitRun &run) { return std::abs(run.exposures[1].ev); };
    assert_true(ev_of(wide_open) > 1.05 * ev_of(unknown));
    assert_true(wide_open.result.gamma_sigma < unknown.result.gamma_sigma);
}

// A row of pictures, every other one brighter by `ev`; `local_ev`: light that each picture changes locally.
Simulation row(double ev, double local_ev, uint64_t seed, uint32_t images = 8, double center_x = 0.0) {
    Simulation s;
    s.response = srgb_response();
    s.vignetting = {{-0.25, 0.02, -0.05}, {center_x, 0.0}};
    s.images = images;
    s.shift = 0.6;
    s.local_ev = local_ev;
    for (uint32_t i = 0; i < images; i++) s.exposures.push_back({i % 2 ? ev : 0.0, {1.0, 1.0, 1.0}});
    s.make(3000, 1.0, 0.05, 0.0, seed);
    return s;
}

void test_errors_in_common_are_measured(void **) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        assert_true(run_fit(row(0.0, 0.0, seed)).result.error_inflation < 2.0);
        assert_true(run_fit(row(0.0, 0.05, seed)).result.error_inflation > 3.0);
    }
}

// A drift along the row does not move the centre.
void test_a_row_stays_level(void **) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        const Simulation s = row(0.3, 0.03, seed);
        const FitRun run = run_fit(s);
        const lensprof_vignetting &v = run.result.vignetting[1];
        assert_int_equal(run.result.equal_exposures, 0);
        assert_true(std::hypot(v.center[0], v.center[1]) < 0.05);
        assert_true(s.exposure_error(run.exposures, s.gamma(run.exposures)) < 0.06);
    }
}

// Exposures that the pictures do not tell apart are equal. The centre then follows from the pictures.
void test_equal_exposures_are_recognised(void **) {
    const Simulation s = row(0.0, 0.02, 1, 8, 0.03);
    const FitRun run = run_fit(s);
    assert_int_equal(run.result.equal_exposures, 1);
    assert_close(run.result.vignetting[1].center[0], 0.03, 0.01);
    for (const lensprof_exposure &e : run.exposures) assert_close(e.ev, 0.0, 0.01);
    assert_true(run.quality[4].ev_sigma > 0.0);

    assert_int_equal(run_fit(row(0.0, 0.02, 1, 2)).result.equal_exposures, 0);  // one may be equal by accident
    lensprof_fit_options options = default_fit();
    options.prior_weight = 0.0;
    assert_int_equal(run_fit(s, options).result.equal_exposures, 0);
    assert_int_equal(run_fit(row(0.1, 0.0, 1)).result.equal_exposures, 0);
}

void test_a_crop_moves_the_centre(void **) {
    Simulation s;
    s.response = srgb_response();
    s.vignetting = {{-0.35, 0.02, -0.02}, {0.25, -0.1}};
    s.make(4000, 1.0, 0.05, 0.6, 7);
    const FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 1);
    assert_close(run.result.vignetting[1].center[0], 0.25, 0.03);
    assert_close(run.result.vignetting[1].center[1], -0.1, 0.03);
    assert_true(run.result.center_prior_distance > 3.0);
}

// Few pairs near the middle would let the corners rise to anything.
void test_corners_that_are_not_seen(void **) {
    double squares = 0.0, free_squares = 0.0;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        Simulation s;
        s.response = srgb_response();
        s.images = 4;
        s.make(600, 2.0, 0.1, 0.5, seed);
        const auto is_outside = [&](const lensprof_pair &pair) {
            return lensprof_vignetting_r2(&s.vignetting, s.width, s.height, pair.xy[0][0], pair.xy[0][1], nullptr) > 0.4
                   || lensprof_vignetting_r2(&s.vignetting, s.width, s.height, pair.xy[1][0], pair.xy[1][1], nullptr)
                          > 0.4;
        };
        s.pairs.erase(std::remove_if(s.pairs.begin(), s.pairs.end(), is_outside), s.pairs.end());
        lensprof_fit_options with = default_fit(), without = default_fit();
        without.prior_weight = 0.0;
        const double corner = corner_of(run_fit(s, with)), free_corner = corner_of(run_fit(s, without));
        assert_close(corner, 0.6, 0.2);
        squares += std::pow(corner - 0.6, 2), free_squares += std::pow(free_corner - 0.6, 2);
    }
    assert_true(squares < 0.25 * free_squares);
}

// Copies and tripod frames: places that barely move in the frame determine no falloff.
void test_the_same_view_shows_no_falloff(void **) {
    Simulation s;
    s.response = srgb_response();
    s.images = 2;
    s.shift = 0.004;
    s.exposures = {{0.0, {1.0, 1.0, 1.0}}, {-0.7, {1.0, 1.0, 1.0}}};
    s.make(2000, 1.0, 0.0, 0.0, 3);
    const FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 0);
    assert_int_equal(run.result.first.code, LENSPROF_REASON_SAME_VIEW);
    assert_int_equal(run.result.model, LENSPROF_FIT_MODEL_EXPOSURES);  // these are known
    assert_close(corner_of(run), 1.0, 1e-12);
    assert_close(run.exposures[1].ev, -0.7, 0.2);
}

// A camera that corrects its lens: exposures alone are the result.
void test_exposures_only(void **) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        Simulation s;
        assert_ok(lensprof_response_set_typical(&s.response, LENSPROF_CAMERA_STILL, nullptr, nullptr));
        s.vignetting = {};
        s.make(1500, 2.0, 0.05, 0.7, seed);
        lensprof_fit_options options = default_fit();
        options.camera_kind = LENSPROF_CAMERA_STILL;
        const FitRun run = run_fit(s, options);
        assert_int_equal(run.result.model, LENSPROF_FIT_MODEL_EXPOSURES);
        assert_int_equal(run.result.usable, 0);
        assert_int_equal(run.result.equalizes, 1);
        assert_int_equal(run.result.first.code, LENSPROF_REASON_EXPOSURES_ONLY);
        for (uint32_t i = 0; i < s.images; i++) assert_close(run.exposures[i].ev, s.exposures[i].ev, 0.06);
    }
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_derivatives_of_log_falloff),
        cmocka_unit_test(test_falloffs_weaken_with_every_stop),
        cmocka_unit_test(test_pictures_choose_among_lenses),
        cmocka_unit_test(test_the_depth_of_a_falloff_informs_gamma),
        cmocka_unit_test(test_errors_in_common_are_measured),
        cmocka_unit_test(test_a_row_stays_level),
        cmocka_unit_test(test_equal_exposures_are_recognised),
        cmocka_unit_test(test_a_crop_moves_the_centre),
        cmocka_unit_test(test_corners_that_are_not_seen),
        cmocka_unit_test(test_the_same_view_shows_no_falloff),
        cmocka_unit_test(test_exposures_only),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
