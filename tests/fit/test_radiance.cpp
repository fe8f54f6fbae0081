// The radiance method compared with simulated truth, and the gamma family of its solutions.
#include "simulated_tracks.hpp"

#include "fit/problem/tracks.hpp"

using namespace lensprof;

namespace {

TrackSimulation simulate(const lensprof_response &response, uint32_t longest, uint32_t points, double noise,
                         double outliers, uint64_t seed = 5) {
    TrackSimulation s;
    s.response = response;
    s.longest = longest;
    s.make_tracks(points, noise, outliers, 1.0, seed);
    return s;
}

lensprof_fit_options known_response(const TrackSimulation &s) {
    lensprof_fit_options options = radiance_fit();
    options.free &= ~LENSPROF_FREE_RESPONSE;
    options.response = &s.response;
    return options;
}

// Section 4.1: with a known response, exposures and falloff share no free exponent.
void test_known_response(void **) {
    for (uint32_t longest : {2u, 3u, 6u}) {
        TrackSimulation s = simulate(film_response(), longest, 1000, 1.0, 0.0);
        FitRun run = run_radiance(s, known_response(s));
        assert_int_equal(run.result.usable, 1);
        assert_int_equal(run.result.gamma_from, LENSPROF_GAMMA_KNOWN);
        assert_true(s.exposure_error(run.exposures, 1.0) < (longest == 2 ? 0.03 : 0.01));
        assert_true(s.falloff_error(run.result.vignetting[1], 1.0) < 0.01);
        assert_close(run.result.vignetting[0].center[0], 0.02, 0.01);
        assert_close(run.result.noise_levels, 1.0, 0.1);
    }
}

// Section 4.2: with an unknown response, up to the exponent.
void test_unknown_response(void **) {
    for (const lensprof_response &response : {srgb_response(), film_response(), gamma_response(1.8)})
        for (uint32_t channels : {1u, 3u}) {
            TrackSimulation s;
            s.response = response;
            s.channels = channels;
            s.make_tracks(1500, 1.0, 0.05, 1.0, 5);
            lensprof_fit_options options = radiance_fit();
            options.channels = channels;
            FitRun run = run_radiance(s, options);
            double gamma = s.gamma(run.exposures);
            assert_int_equal(run.result.usable, 1);
            assert_true(is_monotone(run.result.response));
            assert_close(std::log(gamma), 0.0, 0.5);
            assert_true(s.exposure_error(run.exposures, gamma) < 0.03);
            assert_true(s.falloff_error(run.result.vignetting[1], gamma) < 0.015);
            assert_close(run.result.noise_levels, 1.0, 0.15);
        }
}

// The losses: robust ones tolerate outliers, squares work without outliers.
void test_losses(void **) {
    for (double outliers : {0.0, 0.05}) {
        TrackSimulation s = simulate(srgb_response(), 4, 1200, 1.5, outliers);
        for (uint32_t kind : {LENSPROF_LOSS_ROBUST, LENSPROF_LOSS_HUBER, LENSPROF_LOSS_SQUARED}) {
            if (outliers > 0.0 && kind == LENSPROF_LOSS_SQUARED) continue;
            lensprof_fit_options options = known_response(s);
            options.loss = kind;
            FitRun run = run_radiance(s, options);
            assert_true(s.exposure_error(run.exposures, 1.0) < (kind == LENSPROF_LOSS_HUBER ? 0.04 : 0.012));
            assert_true(s.falloff_error(run.result.vignetting[1], 1.0) < 0.02);
        }
    }
}

// A wrong observation does not invalidate a long track.
void test_wrong_observations(void **) {
    for (double outliers : {0.15, 0.3}) {
        TrackSimulation s = simulate(srgb_response(), 6, 900, 1.5, outliers);
        FitRun run = run_radiance(s);
        double gamma = s.gamma(run.exposures);
        assert_true(s.exposure_error(run.exposures, gamma) < 0.02);
        assert_true(s.falloff_error(run.result.vignetting[1], gamma) < 0.02);
        assert_close(run.result.noise_levels, 1.5, 0.2);
    }
}

// Saturated samples give a lower bound for the light. Without them, samples that noise pushed to white are missing,
// which biases the others, and mostly saturated images lose their connections.
void test_saturated_samples_help(void **) {
    for (double ev_range : {0.5, 1.5}) {
        double with = 0.0, without = 0.0;
        for (uint64_t seed = 1; seed <= 16; seed++) {
            TrackSimulation s;
            s.response = linear_response();
            s.channels = 1;
            s.images = 4;
            s.shortest = 3, s.longest = 4;
            s.brightest = 40.0;
            s.make_tracks(120, 4.0, 0.0, ev_range, seed);
            lensprof_fit_options options = known_response(s);
            options.channels = 1;
            with += std::pow(s.exposure_error(run_radiance(s, options).exposures, 1.0), 2);
            without += std::pow(s.exposure_error(run_radiance(s, s.unsaturated(), options).exposures, 1.0), 2);
        }
        print_message("squared error with saturated samples %g, without %g\n", with, without);
        assert_true(with < (ev_range > 1.0 ? 0.5 : 0.9) * without);
    }
}

// Exposures and falloff scatter by their stated standard errors.
void test_standard_errors(void **) {
    constexpr int kRuns = 60;
    double ev2 = 0.0, balance2 = 0.0, k2 = 0.0, center2 = 0.0;
    int evs = 0;
    for (int n = 0; n < kRuns; n++) {
        TrackSimulation s = simulate(srgb_response(), 5, 250, 2.0, 0.05, 100 + static_cast<uint64_t>(n));
        lensprof_fit_options options = known_response(s);
        options.vignettings = 1;
        options.prior_weight = 0.0;
        options.threads = 1;
        FitRun run = run_radiance(s, options);
        const auto &r = run.result;
        for (uint32_t i = 1; i < s.images; i++, evs++) {
            ev2 += std::pow((run.exposures[i].ev - s.exposures[i].ev) / run.quality[i].ev_sigma, 2);
            balance2 += std::pow((run.exposures[i].white_balance[0] - s.exposures[i].white_balance[0])
                                     / run.quality[i].white_balance_sigma[0],
                                 2);
        }
        assert_int_equal(r.covariance_size, 5);
        for (uint32_t u = 0; u < 3; u++)
            k2 += std::pow(r.vignetting[0].k[u] - s.vignetting.k[u], 2) / r.covariance[u * 5 + u];
        for (uint32_t u = 0; u < 2; u++)
            center2 +=
                std::pow(r.vignetting[0].center[u] - s.vignetting.center[u], 2) / r.covariance[(3 + u) * 5 + 3 + u];
    }
    print_message("mean square of error over standard error: ev %.2f, balance %.2f, k %.2f, centre %.2f\n", ev2 / evs,
                  balance2 / evs, k2 / (3 * kRuns), center2 / (2 * kRuns));
    for (double mean : {ev2 / evs, balance2 / evs, k2 / (3 * kRuns), center2 / (2 * kRuns)}) {
        assert_true(mean > 0.65);
        assert_true(mean < 1.5);
    }
}

// A picture corrected by a model: falloff removed and exposure set to the geometric mean (eq. 15, 16).
std::vector<double> corrected(const lensprof_response &response, const lensprof_vignetting &vignetting,
                              const std::vector<lensprof_exposure> &exposures, size_t image, uint32_t side,
                              const std::vector<float> &pixels) {
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.frame_width = options.frame_height = side;
    options.source_sample = options.target_sample = LENSPROF_SAMPLE_F32;
    options.saturated = LENSPROF_SATURATED_AS_VALUE;
    options.responses = options.vignettings = 1;
    options.response = &response;
    options.vignetting = &vignetting;
    options.source = exposures[image];
    double log_red = 0.0, log_blue = 0.0;
    lensprof_exposure_init(&options.target);
    for (const auto &e : exposures) {
        options.target.ev += e.ev / static_cast<double>(exposures.size());
        log_red += std::log(e.white_balance[0]) / static_cast<double>(exposures.size());
        log_blue += std::log(e.white_balance[2]) / static_cast<double>(exposures.size());
    }
    options.target.white_balance[0] = std::exp(log_red), options.target.white_balance[2] = std::exp(log_blue);
    std::vector<uint64_t> memory(lensprof_plan_bytes(&options) / 8 + 1);
    const lensprof_plan *plan;
    assert_ok(lensprof_plan_init(memory.data(), memory.size() * 8, &options, &plan, nullptr));
    std::vector<float> out = pixels;
    const lensprof_target picture{
        out.data(), static_cast<ptrdiff_t>(side * 12), side, side, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB};
    assert_ok(lensprof_apply(plan, nullptr, &picture, 0, 0));
    return {out.begin(), out.end()};
}

std::vector<float> random_picture(uint32_t side, uint64_t seed) {
    uint64_t random = seed;
    std::vector<float> pixels(3 * side * side);
    for (float &v : pixels) v = static_cast<float>(0.05 + 0.9 * lp_random(&random));
    return pixels;
}

// Equations 4 to 7 give another member of the family. Equations 8 to 10: both correct pictures equally, within the
// rounding of an 8 bit picture. M = 1 + k r^2; its square and cube are also falloffs of the model.
void test_gamma_family_corrects_alike(void **) {
    constexpr uint32_t side = 96;
    for (double gamma : {2.0, 3.0}) {
        const double k = -0.3;
        lensprof_response response[2];
        assert_ok(lensprof_response_set_gamma(&response[0], 2.0));
        assert_ok(lensprof_response_set_gamma(&response[1], 2.0 * gamma));  // R'(E) = R(E^(1/gamma))
        lensprof_vignetting falloff[2] = {{{k, 0, 0}, {0.1, 0}}, {{2 * k, k * k, 0}, {0.1, 0}}};
        if (gamma == 3.0) falloff[1] = {{3 * k, 3 * k * k, k * k * k}, {0.1, 0}};
        std::vector<lensprof_exposure> exposures[2];
        for (double ev : {-0.6, 0.0, 0.5})
            for (int member = 0; member < 2; member++) {
                double power = member ? gamma : 1.0;
                exposures[member].push_back({power * ev, {std::pow(1.1, power * ev), 1.0, std::pow(0.9, power * ev)}});
            }
        for (size_t image = 0; image < 3; image++) {
            std::vector<float> pixels = random_picture(side, image + 1);
            auto one = corrected(response[0], falloff[0], exposures[0], image, side, pixels);
            auto other = corrected(response[1], falloff[1], exposures[1], image, side, pixels);
            double change = 0.0;
            for (size_t i = 0; i < one.size(); i++) {
                assert_close(one[i], other[i], 0.5 / 255.0);
                change = std::max(change, std::abs(one[i] - pixels[i]));
            }
            assert_true(change > 0.1);  // something was corrected
        }
    }
}

// Fits with known exposures at other exponents end at other members of the family, and all of them correct pictures
// equally.
void test_two_fits_of_the_family_correct_alike(void **) {
    constexpr uint32_t side = 96;
    TrackSimulation s = simulate(srgb_response(), 5, 2000, 0.5, 0.0);
    lensprof_fit_options options = radiance_fit();
    options.gamma_from = LENSPROF_GAMMA_EXPOSURES;
    FitRun run[2];
    for (int n = 0; n < 2; n++) {
        double gamma = n ? 1.3 : 0.9;
        for (uint32_t i = 0; i < s.images; i++)
            s.fit_images[i].known_ev = gamma * s.exposures[i].ev, s.fit_images[i].known_ev_sigma = 0.02;
        run[n] = run_radiance(s, options);
        assert_close(s.gamma(run[n].exposures), gamma, 0.05);
    }
    std::vector<float> pixels = random_picture(side, 9);
    for (size_t image = 0; image < s.images; image++) {
        std::vector<double> both[2];
        for (int n = 0; n < 2; n++)
            both[n] =
                corrected(run[n].result.response, run[n].result.vignetting[1], run[n].exposures, image, side, pixels);
        const auto &one = both[0], &other = both[1];
        double sum2 = 0.0;
        size_t count = 0;
        for (size_t i = 0; i < one.size(); i++)
            if (one[i] < 0.97) sum2 += std::pow(255.0 * (one[i] - other[i]), 2), count++;
        assert_true(std::sqrt(sum2 / static_cast<double>(count)) < 0.8);  // levels
    }
}

void assert_same(const FitRun &a, const FitRun &b) {
    lensprof_fit_result one = a.result, other = b.result;
    one.seconds = other.seconds = 0.0;
    assert_memory_equal(&one, &other, sizeof one);
    assert_memory_equal(a.exposures.data(), b.exposures.data(), a.exposures.size() * sizeof a.exposures[0]);
    assert_memory_equal(a.quality.data(), b.quality.data(), a.quality.size() * sizeof a.quality[0]);
}

// A bad image in the middle of the tracks is left out; the rest of the tracks still joins the other images.
void test_a_bad_image_within_tracks(void **) {
    TrackSimulation s = simulate(srgb_response(), 3, 1500, 1.0, 0.0);
    uint64_t random = 3;
    for (auto &o : s.observations)
        if (o.image == 2)
            for (double &v : o.value) v = 0.1 + 0.8 * lp_random(&random);
    FitRun run = run_radiance(s);
    assert_int_equal(run.result.left_out, 1);
    for (uint32_t i = 0; i < s.images; i++) assert_int_equal(std::isnan(run.exposures[i].ev), i == 2);
    assert_int_equal(run.result.equalizes, 1);
}

// Same input, same bytes: for any number of threads and any order of the observations.
void test_is_deterministic(void **) {
    TrackSimulation s = simulate(srgb_response(), 6, 900, 1.5, 0.1);
    lensprof_fit_options options = radiance_fit();
    options.threads = 1;
    FitRun run = run_radiance(s, options);
    options.threads = 5;
    assert_same(run, run_radiance(s, options));
    std::vector<lensprof_observation> shuffled = s.observations;
    uint64_t random = 2;
    for (size_t i = shuffled.size(); i-- > 1;)
        std::swap(shuffled[i], shuffled[static_cast<size_t>(lp_random(&random) * static_cast<double>(i + 1))]);
    assert_same(run, run_radiance(s, shuffled, options));
}

// Pairs with a common end form one track, unless an image would then have the point twice.
void test_pairs_become_tracks(void **) {
    auto pair = [](uint32_t i, double x, uint32_t j, double y) {
        return lensprof_pair{{i, j}, {{x, 1}, {y, 1}}, {{0.1 * (i + 1), 0.5, 0.5}, {0.1 * (j + 1), 0.5, 0.5}}};
    };
    const lensprof_pair pairs[] = {pair(0, 10, 1, 20), pair(1, 20, 2, 30), pair(3, 40, 2, 30),   // one track of four
                                   pair(0, 10, 1, 20),                                           // a duplicate
                                   pair(0, 11, 2, 30),                                           // image 0 has it at 10
                                   pair(0, 50, 1, 60), pair(2, 70, 3, 80), pair(1, 60, 2, 70)};  // joined by the last
    auto observations = observations_of(pairs, 8, 3);
    Tracks tracks = tracks_of(observations.data(), static_cast<uint32_t>(observations.size()));
    std::vector<size_t> lengths;
    for (const Range &track : tracks.tracks) lengths.push_back(track.last - track.first);
    std::sort(lengths.begin(), lengths.end());
    assert_true(lengths == (std::vector<size_t>{2, 4, 4}));
    assert_int_equal(pairs_of(tracks, 3).size(), 7);
}

// The same through lensprof_fit_overlap.
void test_fits_pairs(void **) {
    TrackSimulation s = simulate(srgb_response(), 4, 800, 1.0, 0.0);
    Tracks tracks = tracks_of(s.observations.data(), static_cast<uint32_t>(s.observations.size()));
    s.pairs = pairs_of(tracks, 3);
    FitRun run = run_fit(s, radiance_fit());
    assert_int_equal(run.result.usable, 1);
    assert_true(s.exposure_error(run.exposures, s.gamma(run.exposures)) < 0.02);
    FitRun direct = run_radiance(s, s.unsaturated(), radiance_fit());
    assert_close(run.result.heldout_rms, direct.result.heldout_rms, 0.2);
    for (size_t i = 0; i < s.images; i++) assert_close(run.exposures[i].ev, direct.exposures[i].ev, 0.02);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_response),
        cmocka_unit_test(test_unknown_response),
        cmocka_unit_test(test_losses),
        cmocka_unit_test(test_wrong_observations),
        cmocka_unit_test(test_saturated_samples_help),
        cmocka_unit_test(test_standard_errors),
        cmocka_unit_test(test_gamma_family_corrects_alike),
        cmocka_unit_test(test_two_fits_of_the_family_correct_alike),
        cmocka_unit_test(test_a_bad_image_within_tracks),
        cmocka_unit_test(test_is_deterministic),
        cmocka_unit_test(test_pairs_become_tracks),
        cmocka_unit_test(test_fits_pairs),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
