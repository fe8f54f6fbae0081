// Fits of scenes whose points a reconstruction matched in images of a moving camera.
#include "simulated.hpp"

#include <numeric>

namespace {

constexpr double kGlossyShare = 0.25;

struct Scene : Simulation {
    std::vector<uint32_t> points;  // per pair; two pairs each
    std::vector<double> distances;

    explicit Scene(uint64_t seed = 42, uint32_t count = 3000) {
        response = srgb_response();
        images = 8, reach = 3;
        make(count, 1.0, 0.0, 1.0, seed);
        for (uint32_t p = 0; p < count; p++) points.push_back(4000000000u - p / 2);
    }

    lensprof_fit_options options() const {
        lensprof_fit_options o = default_fit();
        o.points = points.data();
        o.view_distances = distances.empty() ? nullptr : distances.data();
        o.moving_camera = 1;
        return o;
    }

    // A quarter of the points is brighter towards the middle of the frame, as surfaces that a flash on the camera
    // lights.
    void add_gloss() {
        uint64_t random = 7;
        std::vector<double> gloss(pairs.size());
        for (size_t p = 0; p < pairs.size(); p++)
            gloss[p] = p % 2 ? gloss[p - 1] : lp_random(&random) < kGlossyShare ? 0.05 : 0.0;
        for (size_t p = 0; p < pairs.size(); p++)
            for (int side = 0; side < 2; side++) {
                const double x = pairs[p].xy[side][0] / width - 0.5, y = pairs[p].xy[side][1] / height - 0.5;
                for (double &value : pairs[p].value[side])
                    value = std::min(1.0, value + gloss[p] * std::exp(-8.0 * (x * x + y * y)));
            }
    }

    // From image `first` on, the light comes from another side: every point has another irradiance.
    void change_light(uint32_t first, double log_change) {
        for (size_t p = 0; p < pairs.size(); p++) {
            uint64_t random = points[p];
            const double factor = std::exp(log_change * lp_normal(&random));
            for (int side = 0; side < 2; side++)
                if (pairs[p].image[side] >= first)
                    for (double &value : pairs[p].value[side]) value = std::min(1.0, value * factor);
        }
    }
};

double error_of(const Scene &scene, const FitRun &run) {
    return scene.exposure_error(run.exposures, scene.gamma(run.exposures));
}

void test_glossy_points_are_left_out(void **) {
    double with = 0.0, without = 0.0;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        Scene scene(seed);
        scene.add_gloss();
        lensprof_fit_options plain = scene.options();
        plain.points = nullptr;
        const FitRun run = run_fit(scene, scene.options()), other = run_fit(scene, plain);
        with += error_of(scene, run), without += error_of(scene, other);
        assert_int_equal(run.result.model, LENSPROF_FIT_MODEL_FULL);
        assert_int_equal(run.result.equalizes, 1);
        assert_true(run.result.pairs < 0.85 * other.result.pairs);
        assert_true(run.result.colour_variance < run.result.colour_variance_exposures_only);
        assert_true(run.result.colour_variance_exposures_only < run.result.colour_variance_before);
        assert_close(other.result.colour_variance_before, 0.0, 0.0);
        assert_true(run.result.seconds > 0.0);
    }
    print_message("errors of exposures, EV: %.4f with points, %.4f without\n", with / 4, without / 4);
    assert_true(with < 0.7 * without);
}

// The mean over the 90 % of the pairs that differ least is the variance in the result.
void test_colour_differences(void **) {
    const Scene scene;
    const FitRun run = run_fit(scene, scene.options());
    std::vector<double> differences(scene.pairs.size());
    const auto count = static_cast<uint32_t>(differences.size());
    assert_ok(lensprof_fit_colour_differences(run.held.get(), scene.pairs.data(), count, differences.data(), nullptr));
    std::sort(differences.begin(), differences.end());
    const size_t counted = differences.size() * 9 / 10;
    const double sum = std::accumulate(differences.begin(), differences.begin() + static_cast<long>(counted), 0.0);
    assert_close(sum / static_cast<double>(counted), run.result.colour_variance, 1e-9);
    lensprof_error error;
    assert_int_equal(lensprof_fit_colour_differences(nullptr, scene.pairs.data(), count, differences.data(), &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_colour_differences(run.held.get(), nullptr, count, differences.data(), &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_fit_colour_differences(run.held.get(), scene.pairs.data(), count, nullptr, &error),
                     LENSPROF_ERROR_ARGUMENT);
}

// Of one point, no halves can be fitted, and all pairs are. Of many, halves can: errors are larger. Without those of
// the halves the ratio is .98, since scatter decreases with the quarter that is left out.
void test_errors_include_those_between_halves(void **) {
    double ratio = 0.0;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        Scene scene(seed, 1500);
        const auto red_sigma = [&] {
            lensprof_fit_options options = scene.options();
            options.free &= ~LENSPROF_FREE_RESPONSE;  // whose exponent all errors share
            options.response = &scene.response;
            const FitRun run = run_fit(scene, options);
            double sum = 0.0;
            for (const lensprof_fit_image_quality &q : run.quality) sum += q.white_balance_sigma[0];
            return sum;
        };
        const double of_many = red_sigma();
        std::fill(scene.points.begin(), scene.points.end(), 3);
        ratio += of_many / red_sigma() / 4.0;
    }
    print_message("errors of many points over those of one: %.2f\n", ratio);
    assert_true(ratio > 1.05);
}

// One inconsistent image costs neither the result nor the meaning of the differences.
void test_an_inconsistent_image(void **) {
    Scene scene;
    uint64_t random = 5;
    for (lensprof_pair &pair : scene.pairs)
        for (int side = 0; side < 2; side++)
            if (pair.image[side] == 7)
                for (double &value : pair.value[side]) value = 0.1 + 0.8 * lp_random(&random);
    const FitRun run = run_fit(scene, scene.options());
    assert_int_equal(run.result.model, LENSPROF_FIT_MODEL_FULL);
    assert_int_equal(run.result.usable, 1);
    assert_true(std::isnan(run.exposures[7].ev) && run.result.colour_variance < 5.0);
    std::vector<double> differences(scene.pairs.size());
    assert_ok(lensprof_fit_colour_differences(run.held.get(), scene.pairs.data(),
                                              static_cast<uint32_t>(differences.size()), differences.data(), nullptr));
    for (size_t p = 0; p < differences.size(); p++)
        assert_int_equal(std::isnan(differences[p]), scene.pairs[p].image[0] == 7 || scene.pairs[p].image[1] == 7);
}

// What decides stays a finding, also if exposures alone are the result; these do not replace what the caller gave.
void test_findings_on_the_pairs_stay(void **) {
    Scene scene(1, 400);
    scene.pairs.resize(5), scene.points.resize(5);
    FitRun run = run_fit(scene, scene.options());
    assert_int_equal(run.result.equalizes, 0);
    assert_true(run.with(LENSPROF_REASON_FEW_PAIRS) || run.with(LENSPROF_REASON_IMAGE_GROUPS));
    Scene linear;
    lensprof_response given;
    lensprof_response_set_linear(&given);
    lensprof_fit_options options = linear.options();
    options.free = LENSPROF_FREE_K1 | LENSPROF_FREE_K2;
    options.response = &given;
    run = run_fit(linear, options);
    assert_close(lensprof_response_eval(&run.result.response, 0.18, nullptr), 0.18, 1e-9);
}

// The unused channels of grey pairs have no meaning.
void test_grey_pairs(void **) {
    Scene scene(2, 1500);
    lensprof_fit_options options = scene.options();
    options.channels = 1;
    const FitRun run = run_fit(scene, options);
    for (lensprof_pair &pair : scene.pairs)
        for (int side = 0; side < 2; side++) pair.value[side][1] = pair.value[side][2] = NAN;
    const FitRun again = run_fit(scene, options);
    for (uint32_t i = 0; i < scene.images; i++)
        assert_memory_equal(&run.exposures[i], &again.exposures[i], sizeof run.exposures[i]);
}

// A camera without falloff and with the typical response: exposures alone are the result.
void test_exposures_alone_are_the_result(void **) {
    Scene scene;
    scene.pairs.clear(), scene.exposures.clear(), scene.fit_images.clear();
    assert_ok(lensprof_response_set_typical(&scene.response, LENSPROF_CAMERA_ANY, nullptr, nullptr));
    scene.vignetting = {};
    scene.make(static_cast<uint32_t>(scene.points.size()), 1.0, 0.0, 1.0, 42);
    for (uint32_t i = 0; i < scene.images; i++) scene.fit_images[i].setting = i % 2;
    lensprof_fit_options options = scene.options();
    options.prior_weight = 0.0;  // which expects a falloff
    const FitRun run = run_fit(scene, options);
    assert_int_equal(run.result.model, LENSPROF_FIT_MODEL_EXPOSURES);
    assert_int_equal(run.result.setting_count, 1);
    assert_non_null(run.with(LENSPROF_REASON_EXPOSURES_ONLY));
    assert_int_equal(run.result.usable, 0);
    assert_int_equal(run.result.equalizes, 1);
    assert_close(run.result.colour_variance, run.result.colour_variance_exposures_only, 0.0);
    assert_true(error_of(scene, run) < 0.02);
}

void test_two_visits_are_refused(void **) {
    for (const double log_change : {0.0, 0.3}) {
        Scene scene(42, 1200);
        scene.change_light(5, log_change);
        const FitRun run = run_fit(scene, scene.options());
        const lensprof_finding *groups = run.with(LENSPROF_REASON_IMAGE_GROUPS);
        assert_int_equal(groups != nullptr, log_change > 0.0);
        assert_int_equal(run.result.equalizes, log_change == 0.0);
        if (!groups) continue;
        assert_int_equal(run.result.usable, 0);
        assert_int_equal(groups->item.index, 5);
        assert_close(groups->value[0], 3.0, 0.0);
        assert_true(groups->measured > groups->limit && strstr(groups->text, "different light"));
        for (uint32_t i = 0; i < scene.images; i++) assert_int_equal(run.quality[i].component, i < 5 ? 0 : 5);
    }
}

// If no views of both groups are as close as others, their difference may be one of the sides they show.
void test_distant_views_are_not_two_visits(void **) {
    Scene scene(42, 1200);
    scene.change_light(5, 0.3);
    for (const lensprof_pair &pair : scene.pairs)
        scene.distances.push_back((pair.image[0] >= 5) != (pair.image[1] >= 5) ? 2.0 : 1.0);
    assert_null(run_fit(scene, scene.options()).with(LENSPROF_REASON_IMAGE_GROUPS));
}

void test_the_result_does_not_depend_on_threads(void **) {
    Scene scene;
    scene.add_gloss();
    lensprof_fit_options options = scene.options();
    options.threads = 1;
    const FitRun one = run_fit(scene, options);
    options.threads = 3;
    const FitRun three = run_fit(scene, options);
    for (uint32_t i = 0; i < scene.images; i++) {
        assert_memory_equal(&one.exposures[i], &three.exposures[i], sizeof one.exposures[i]);
        assert_memory_equal(&one.quality[i], &three.quality[i], sizeof one.quality[i]);
    }
}

struct Watch {
    double stop, last;
};

int watch(double done, void *user) {
    auto *watch = static_cast<Watch *>(user);
    assert_true(done >= watch->last && done <= 1.0);
    watch->last = done;
    return done >= watch->stop;
}

void test_progress_and_cancelling(void **) {
    const Scene scene(1, 1000);
    lensprof_fit_options options = scene.options();
    options.progress = watch;
    for (const double stop : {0.05, 0.15, 0.25, 2.0}) {
        Watch seen{stop, 0.0};
        options.progress_user = &seen;
        FitRun run;
        lensprof_error error;
        const lensprof_status status = fit_into(run, options, scene.fit_images, scene.pairs, &error);
        assert_int_equal(status, stop < 1.0 ? LENSPROF_ERROR_CANCELLED : LENSPROF_OK);
        assert_int_equal(run.held == nullptr, stop < 1.0);
    }
}

void test_bad_input(void **) {
    Scene scene(1, 400);
    FitRun run;
    lensprof_error error;
    lensprof_fit_options options = scene.options();
    scene.distances.assign(scene.pairs.size(), 1.0);
    options.view_distances = scene.distances.data();
    for (const double bad : {-1.0, double(NAN), double(INFINITY)}) {
        scene.distances[17] = bad;
        assert_int_equal(fit_into(run, options, scene.fit_images, scene.pairs, &error), LENSPROF_ERROR_ARGUMENT);
        assert_int_equal(error.item.kind, LENSPROF_ITEM_PAIR);
        assert_int_equal(error.item.index, 17);
    }
    scene.distances[17] = 1.0;
    options.points = nullptr;
    assert_int_equal(fit_into(run, options, scene.fit_images, scene.pairs, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "view_distances need points"));
    options = scene.options();
    options.method = LENSPROF_METHOD_RADIANCE;
    const lensprof_observation track[2] = {{0, 0, {10, 10}, {0.5, 0.5, 0.5}}, {0, 1, {20, 20}, {0.4, 0.4, 0.4}}};
    lensprof_fit *fit = nullptr;
    run.exposures.resize(scene.images);
    assert_int_equal(lensprof_fit_radiance(&options, scene.fit_images.data(), scene.images, track, 2, nullptr, 0,
                                           run.exposures.data(), &fit, &error),
                     LENSPROF_ERROR_UNSUPPORTED);
    assert_null(fit);
}

// With nothing of the camera free, points change nothing; with fixed exposures, there is no baseline.
void test_fixed_parameters(void **) {
    Scene scene(1, 1000);
    lensprof_fit_options options = scene.options();
    options.free = 0, options.response = &scene.response, options.vignetting = scene.vignetting;
    FitRun run = run_fit(scene, options);
    assert_close(run.result.colour_variance, 0.0, 0.0);
    options = scene.options();
    for (uint32_t i = 0; i < scene.images; i++)
        scene.fit_images[i].free = 0, scene.fit_images[i].exposure = scene.exposures[i];
    run = run_fit(scene, options);
    assert_close(run.result.colour_variance_exposures_only, LENSPROF_UNKNOWN, 0.0);
    assert_true(run.result.colour_variance < run.result.colour_variance_before);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_glossy_points_are_left_out),
        cmocka_unit_test(test_colour_differences),
        cmocka_unit_test(test_errors_include_those_between_halves),
        cmocka_unit_test(test_an_inconsistent_image),
        cmocka_unit_test(test_findings_on_the_pairs_stay),
        cmocka_unit_test(test_grey_pairs),
        cmocka_unit_test(test_exposures_alone_are_the_result),
        cmocka_unit_test(test_two_visits_are_refused),
        cmocka_unit_test(test_distant_views_are_not_two_visits),
        cmocka_unit_test(test_the_result_does_not_depend_on_threads),
        cmocka_unit_test(test_progress_and_cancelling),
        cmocka_unit_test(test_bad_input),
        cmocka_unit_test(test_fixed_parameters),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
