// Pictures of several cameras in one fit: a response per camera, and what joins the cameras.
#include "core/exposure.h"
#include "simulated_run.hpp"

namespace {

const lensprof_vignetting kWide{{-0.45, 0.12, -0.10}, {0.01, -0.01}}, kTele{{-0.15, 0.03, -0.05}, {-0.01, 0.01}};

// Images alternate between two cameras, which differ in response, falloff, sensitivity and white balance.
template <class Simulated>
Simulated alternating(uint64_t seed = 42) {
    Simulated s;
    s.images = 10;
    s.of_setting = {kWide, kTele};
    s.of_camera = {srgb_response(), film_response()};
    s.reach = 4;
    uint64_t random = seed + 7;
    for (uint32_t i = 0; i < s.images; i++) {
        lensprof_exposure e;
        lensprof_exposure_init(&e);
        if (i > 0)
            e = {2.0 * lp_random(&random) - 1.0,
                 {0.85 + 0.3 * lp_random(&random), 1.0, 0.85 + 0.3 * lp_random(&random)}};
        if (i % 2) e.ev -= 0.5, e.white_balance[0] *= 1.3, e.white_balance[2] *= 0.8;
        s.exposures.push_back(e);
    }
    if constexpr (std::is_same_v<Simulated, TrackSimulation>)
        s.make_tracks(1500, 1.0, 0.02, 1.0, seed);
    else
        s.make(6000, 1.0, 0.05, 1.0, seed);
    return s;
}

// Difference (0..1) between found and true grey values in an image for light from 3 % to white as the reference sees
// it. Uses the results of both cameras together, so that a common exponent and a common scale cancel.
double grey_error(const Simulation &s, const Run &run, uint32_t image) {
    const uint32_t camera = s.fit_images[image].camera;
    double worst = 0.0;
    for (int k = 3; k <= 100; k++)
        for (uint32_t c = 0; c < s.channels; c++) {
            const double light = k / 100.0, seen = lensprof_response_eval(&s.of_camera[0], light, nullptr);
            const double found = lensprof_response_invert(&run.of_camera(0).response, seen, nullptr)
                                 * lp_exposure_factor(&run.exposures[image], c);
            const double truth = light * lp_exposure_factor(&s.exposures[image], c);
            if (truth > 0.9) continue;  // too close to white, which pairs do not cover
            worst = std::max(worst, std::abs(lensprof_response_eval(&run.of_camera(camera).response, found, nullptr)
                                             - lensprof_response_eval(&s.of_camera[camera], truth, nullptr)));
        }
    return worst;
}

// Exposures of a camera's images relative to its first image: errors after removing the exponent `gamma`, EV.
double exposure_error(const Simulation &s, const Run &run, uint32_t camera, double gamma) {
    double worst = 0.0;
    for (uint32_t i = camera; i < s.images; i += 2)
        worst = std::max(worst, std::abs((run.exposures[i].ev - run.exposures[camera].ev) / gamma
                                         - (s.exposures[i].ev - s.exposures[camera].ev)));
    return worst;
}

// The exponent between recovered and true exposures of a camera's images.
double gamma_of(const Simulation &s, const Run &run, uint32_t camera) {
    std::vector<double> found, truth;
    double found_mean = 0.0, true_mean = 0.0, cross = 0.0, square = 0.0;
    for (uint32_t i = camera; i < s.images; i += 2)
        found.push_back(run.exposures[i].ev), truth.push_back(s.exposures[i].ev);
    for (size_t n = 0; n < found.size(); n++)
        found_mean += found[n] / static_cast<double>(found.size()),
            true_mean += truth[n] / static_cast<double>(found.size());
    for (size_t n = 0; n < found.size(); n++) {
        cross += (found[n] - found_mean) * (truth[n] - true_mean);
        square += (truth[n] - true_mean) * (truth[n] - true_mean);
    }
    return cross / square;
}

// Both cameras agree on one exponent, because their overlaps fix it.
void check_found(const Simulation &s, const Run &run) {
    const double gamma = gamma_of(s, run, 0);
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.left_out, 0);
    assert_close(gamma_of(s, run, 1) / gamma, 1.0, 0.02);
    for (uint32_t i = 0; i < s.images; i++) assert_true(grey_error(s, run, i) < 0.012);
    for (uint32_t n = 0; n < 2; n++) {
        const lensprof_fit_camera &camera = run.cameras[n];
        assert_int_equal(camera.images, 5);
        assert_int_equal(camera.joined, 1);
        assert_true(camera.agreeing_share > 0.8);
        assert_true(exposure_error(s, run, n, gamma) < 0.02);
        assert_true(falloff_error(run.settings[n].vignetting[0], s.of_setting[n], gamma)
                    < (s.channels == 3 ? 0.01 : 0.02));
        assert_int_equal(camera.setting, n);
        assert_int_equal(camera.reference % 2, n);
    }
    assert_true(run.cameras[0].offset_sigma_ev == 0.0 && run.cameras[1].offset_sigma_ev > 0.0);
    assert_memory_equal(&run.result.response, &run.of_camera(0).response, sizeof run.result.response);
}

void test_each_response_is_found(void **) {
    const auto s = alternating<Simulation>();
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    check_found(s, run);
    // With one response for both, the cameras contradict each other.
    Simulation one = s;
    for (auto &image : one.fit_images) image.camera = 0;
    const FitRun together = run_fit(one);
    assert_int_equal(together.result.left_out, 5);
}

void test_each_response_is_found_by_radiance(void **) {
    const auto s = alternating<TrackSimulation>();
    Run run(s);
    assert_ok(run.fit(s, radiance_fit()));
    check_found(s, run);
}

void test_each_response_is_found_in_grey(void **) {
    auto s = alternating<Simulation>();
    s.pairs.clear(), s.fit_images.clear(), s.exposures.clear();
    s.channels = 1;
    s.make(6000, 1.0, 0.05, 1.0, 5);
    lensprof_fit_options options = default_fit();
    options.channels = 1;
    Run run(s);
    assert_ok(run.fit(s, options));
    check_found(s, run);
}

// Known exposures of one camera determine the exponent of the other.
void test_knowledge_of_one_serves_the_other(void **) {
    auto s = alternating<Simulation>();
    Run without(s);
    assert_ok(without.fit(s, default_fit()));
    for (size_t i = 0; i < s.images; i += 2)
        s.fit_images[i].known_ev = s.exposures[i].ev, s.fit_images[i].known_ev_sigma = 0.02;
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_close(gamma_of(s, run, 1), 1.0, 0.03);
    assert_true(run.of_camera(1).gamma_sigma < 0.03);
    assert_int_equal(run.of_camera(0).gamma_from, LENSPROF_GAMMA_EXPOSURES);
    assert_int_equal(run.of_camera(1).gamma_from, LENSPROF_GAMMA_CAMERAS);
    assert_true(without.of_camera(1).gamma_sigma > 2.0 * run.of_camera(1).gamma_sigma);
}

// Errors are consistent with their standard errors if the exposures of one camera are known. Checked are the other
// camera's exponent, and its exposures relative to each other, in which the common offset cancels, and relative to the
// reference.
void test_stated_errors_hold(void **) {
    double within = 0.0, between = 0.0, of_gamma = 0.0, worst = 0.0;
    int inner = 0, outer = 0, runs = 0;
    for (uint64_t seed = 1; seed <= 16; seed++, runs++) {
        auto s = alternating<Simulation>(seed);
        for (size_t i = 0; i < s.images; i += 2)
            s.fit_images[i].known_ev = s.exposures[i].ev, s.fit_images[i].known_ev_sigma = 0.02;
        Run run(s);
        assert_ok(run.fit(s, default_fit()));
        const double offset = run.cameras[1].offset_sigma_ev;
        const auto error = [&](size_t i) { return run.exposures[i].ev - s.exposures[i].ev; };
        const auto own = [&](size_t i) { return std::pow(run.quality[i].ev_sigma, 2) - offset * offset; };
        for (size_t i = 1; i < s.images; i += 2) {
            between += std::pow(error(i) / run.quality[i].ev_sigma, 2), outer++;
            worst = std::max(worst, std::abs(error(i)));
            if (i > 1) within += std::pow(error(i) - error(1), 2) / (own(i) + own(1)), inner++;
        }
        of_gamma += std::pow((gamma_of(s, run, 1) - 1.0) / run.of_camera(1).gamma_sigma, 2);
    }
    const double within_rms = std::sqrt(within / inner), between_rms = std::sqrt(between / outer),
                 gamma_rms = std::sqrt(of_gamma / runs);
    print_message("RMS in standard errors: within a camera %.2f, to the reference %.2f (at most %.3f EV), gamma %.2f\n",
                  within_rms, between_rms, worst, gamma_rms);
    assert_true(within_rms < 1.6 && between_rms < 1.6 && gamma_rms < 1.6);
}

// If both cameras get their exponent from the same prior, combining them does not reduce its error; without any
// knowledge the exponent stays undetermined.
void test_priors_err_together(void **) {
    const auto s = alternating<Simulation>();
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    for (const auto &camera : run.settings) {
        assert_int_equal(camera.gamma_from, LENSPROF_GAMMA_PRIOR);
        assert_true(camera.gamma_sigma > 0.2);
    }
    lensprof_fit_options options = default_fit();
    options.prior_weight = 0.0;
    Run open(s);
    assert_ok(open.fit(s, options));
    for (const auto &camera : open.settings) {
        assert_int_equal(camera.gamma_from, LENSPROF_GAMMA_NONE);
        assert_true(camera.gamma_sigma == LENSPROF_UNKNOWN);
    }
    assert_int_equal(open.cameras[1].joined, 1);
    // Knowledge of one camera determines the other, whichever camera the reference belongs to.
    auto held = s;
    for (size_t i = 1; i < s.images; i += 2) held.fit_images[i].exposure = s.exposures[i], held.fit_images[i].free = 0;
    Run known(held);
    assert_ok(known.fit(held, options));
    assert_int_equal(known.of_camera(0).gamma_from, LENSPROF_GAMMA_CAMERAS);
    assert_close(gamma_of(held, known, 0), 1.0, 0.03);
}

// The numbering of cameras makes no difference, nor does leaving out the per-camera results.
void test_numbers_are_names(void **) {
    const auto s = alternating<Simulation>();
    Simulation renamed = s;
    for (auto &image : renamed.fit_images) image.setting = image.setting ? 0 : 63, image.camera = image.camera ? 7 : 9;
    Run run(s), other(s);
    assert_ok(run.fit(s, default_fit()));
    assert_ok(other.fit(renamed, default_fit()));
    const FitRun unasked = run_fit(s);
    assert_memory_equal(run.exposures.data(), other.exposures.data(), s.images * sizeof run.exposures[0]);
    assert_memory_equal(run.exposures.data(), unasked.exposures.data(), s.images * sizeof run.exposures[0]);
    assert_memory_equal(&run.of_camera(1).response, &other.of_camera(7).response, sizeof run.result.response);
    assert_int_equal(other.cameras[5].images, 0);
}

// A response that is held applies to all cameras; only their lenses differ.
void test_held_response_is_of_all(void **) {
    auto s = alternating<Simulation>();
    s.of_camera = {s.of_camera[0], s.of_camera[0]};
    s.pairs.clear(), s.fit_images.clear();
    s.make(6000, 1.0, 0.05, 1.0, 3);
    lensprof_fit_options options = default_fit();
    options.free &= ~LENSPROF_FREE_RESPONSE;
    options.response = &s.of_camera[0];
    Run run(s);
    assert_ok(run.fit(s, options));
    assert_int_equal(run.result.usable, 1);
    assert_true(s.exposure_error(run.exposures, 1.0) < 0.02);
    assert_int_equal(run.cameras[0].images, 0);  // nothing was fitted per camera
    assert_int_equal(run.settings[1].images, 5);
}

Simulation within_cameras() {
    Simulation s = alternating<Simulation>();
    s.pairs.erase(std::remove_if(s.pairs.begin(), s.pairs.end(),
                                 [](const lensprof_pair &p) { return p.image[0] % 2 != p.image[1] % 2; }),
                  s.pairs.end());
    return s;
}

// If nothing joins the cameras, the reference's camera is the result; the other camera's exposures are unknown, and its
// profile is complete by itself.
void test_cameras_apart(void **) {
    const Simulation s = within_cameras();
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.left_out, 5);
    assert_int_equal(run.cameras[1].joined, 0);
    assert_int_equal(run.cameras[1].images, 5);
    assert_int_equal(run.settings[1].usable, 1);
    for (size_t i = 0; i < s.images; i++) {
        assert_int_equal(std::isnan(run.exposures[i].ev), i % 2);
        assert_int_equal(run.quality[i].joined, i % 2 == 0);
    }
}

// A camera with fewer than half of the images in agreement is not usable.
void test_most_must_agree(void **) {
    Simulation s = within_cameras();
    for (size_t i = 0; i < 3; i += 2) {  // disconnect two images of the reference's camera
        const auto is_cut = [&](const lensprof_pair &p) { return p.image[0] == i + 6 || p.image[1] == i + 6; };
        s.pairs.erase(std::remove_if(s.pairs.begin(), s.pairs.end(), is_cut), s.pairs.end());
    }
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.result.left_out, 7);
    assert_int_equal(run.result.usable, 0);
    assert_int_equal(run.result.equalizes, 0);
    assert_int_equal(run.result.first.code, LENSPROF_REASON_IMAGE_GROUPS);
    assert_int_equal(run.settings[0].usable, 0);
    assert_int_equal(run.settings[1].usable, 0);
}

// Pairs between the cameras that show something else do not join them.
void test_contradictions_join_nothing(void **) {
    Simulation s = alternating<Simulation>();
    uint64_t random = 3;
    for (auto &pair : s.pairs)
        if (pair.image[0] % 2 != pair.image[1] % 2)
            for (double &v : pair.value[1]) v = 0.05 + 0.9 * lp_random(&random);
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.cameras[1].joined, 0);
    assert_int_equal(run.result.left_out, 5);
}

// A single picture does not determine its camera's response; it is left out, and the others stay.
void test_single_picture_is_left_out(void **) {
    Simulation s = alternating<Simulation>();
    for (size_t i = 0; i < s.images; i++) s.fit_images[i].camera = s.fit_images[i].setting = 0;
    s.of_camera.pop_back(), s.of_setting.pop_back();
    s.pairs.clear(), s.fit_images.clear();
    s.make(4000, 1.0, 0.05, 1.0, 11);
    s.fit_images[4].camera = 1, s.fit_images[4].setting = 1;
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.left_out, 1);
    assert_int_equal(run.cameras[1].images, 0);
    assert_int_equal(run.settings[1].images, 0);
    assert_true(std::isnan(run.exposures[4].ev));
    // If it was the reference, another image replaces it.
    lensprof_fit_options options = default_fit();
    options.reference = 4;
    assert_ok(run.fit(s, options));
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.reference == 4, 0);
    assert_true(std::isnan(run.exposures[4].ev));
}

// Images joined to their camera's other images only through another camera still get exposures, and so do images
// connected only through such images.
void test_groups_of_a_camera(void **) {
    Simulation s = alternating<Simulation>();
    const auto is_own = [](const lensprof_pair &p, uint32_t i, uint32_t j) {
        return (p.image[0] == i && p.image[1] == j) || (p.image[0] == j && p.image[1] == i);
    };
    const auto is_cut = [&](const lensprof_pair &p) {  // groups 1 3 | 5 7 9; image 1 has pairs with 0 and 2 only
        return (p.image[0] % 2 && p.image[1] % 2 && p.image[0] < 5 && p.image[1] >= 5) || is_own(p, 1, 4)
               || is_own(p, 1, 3);
    };
    s.pairs.erase(std::remove_if(s.pairs.begin(), s.pairs.end(), is_cut), s.pairs.end());
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.result.left_out, 0);
    assert_int_equal(run.cameras[1].images, 3);
    assert_int_equal(run.cameras[1].attached, 2);
    assert_int_equal(run.settings[1].images, 5);
    const double gamma = gamma_of(s, run, 0);
    for (uint32_t i = 0; i < s.images; i++) {
        assert_true(grey_error(s, run, i) < 0.012);
        assert_int_equal(run.quality[i].joined, 1);
        if (i % 2)
            assert_close((run.exposures[i].ev - run.exposures[9].ev) / gamma, s.exposures[i].ev - s.exposures[9].ev,
                         0.03);
    }
    assert_true(run.quality[1].ev_sigma > 0.0 && run.quality[1].ev_sigma < 0.5);
    // Such an image can be the reference.
    lensprof_fit_options options = default_fit();
    options.reference = 1;
    assert_ok(run.fit(s, options));
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.left_out, 0);
}

// The reference's camera moves with the others: exposures stay relative to its image.
void test_any_reference(void **) {
    const auto s = alternating<Simulation>();
    Run first(s), other(s);
    assert_ok(first.fit(s, default_fit()));
    lensprof_fit_options options = default_fit();
    options.reference = 3;
    assert_ok(other.fit(s, options));
    assert_int_equal(other.result.reference, 3);
    assert_true(other.exposures[3].ev == 0.0);
    assert_memory_equal(&other.result.response, &other.of_camera(1).response, sizeof other.result.response);
    for (size_t i = 0; i < s.images; i++)
        assert_close(other.exposures[i].ev - other.exposures[0].ev, first.exposures[i].ev, 0.01);
}

// The initial exposures of images, which a reference keeps, do not change the result.
void test_exposures_of_references(void **) {
    auto s = alternating<Simulation>();
    Run plain(s), shifted(s);
    assert_ok(plain.fit(s, default_fit()));
    for (size_t i = 0; i < s.images; i++) {
        s.fit_images[i].exposure.ev = i % 2 ? -2.5 : 1.5;
        s.fit_images[i].exposure.white_balance[0] = i % 2 ? 0.7 : 1.2;
    }
    assert_ok(shifted.fit(s, default_fit()));
    assert_true(std::abs(shifted.cameras[1].log_gamma - shifted.cameras[0].log_gamma) > 0.1);  // they moved
    assert_true(shifted.exposures[0].ev == 1.5);
    for (size_t i = 0; i < s.images; i++) {
        assert_close(shifted.exposures[i].ev - 1.5, plain.exposures[i].ev, 0.01);
        assert_close(shifted.exposures[i].white_balance[0] / 1.2, plain.exposures[i].white_balance[0], 0.01);
    }
    for (uint32_t i = 0; i < s.images; i++) {  // matches the grey values, relative to the reference
        shifted.exposures[i].ev -= 1.5, shifted.exposures[i].white_balance[0] /= 1.2;
        assert_true(grey_error(s, shifted, i) < 0.012);
    }
}

// A set of which fewer than half take part is refused once for all cameras, and the camera with the fewest images is
// stated.
void test_what_is_judged_for_all_cameras(void **) {
    const auto s = alternating<Simulation>();
    const lensprof_link link{{0, 1}, LENSPROF_LINK_UNVERIFIED, 100};
    lensprof_fit_options options = default_fit();
    options.links = &link, options.link_count = 1;
    options.moving_camera = 1, options.unlinked_images = s.images;  // half take part
    Run run(s);
    assert_ok(run.fit(s, options));
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.first.code, LENSPROF_REASON_FEW_IMAGES);
    assert_close(run.result.first.measured, s.images / 2.0, 0.0);
    options.unlinked_images++;
    assert_ok(run.fit(s, options));
    assert_int_equal(run.result.usable + run.result.equalizes, 0);
    assert_int_equal(run.result.first.code, LENSPROF_REASON_IMAGES_MINORITY);
    assert_close(run.result.first.measured, s.images / (2.0 * s.images + 1.0), 1e-12);
}

// Unknowns linked across cameras are shared only within each camera.
void test_links_end_at_cameras(void **) {
    auto s = alternating<Simulation>();
    s.exposures[3].ev = s.exposures[2].ev, s.exposures[5].ev = s.exposures[2].ev;
    s.pairs.clear(), s.fit_images.clear();
    s.make(6000, 1.0, 0.0, 1.0, 9);
    for (size_t i : {3, 5}) s.fit_images[i].ev_of = 2;
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    assert_int_equal(run.result.usable, 1);
    assert_true(run.exposures[3].ev == run.exposures[5].ev);
    assert_true(exposure_error(s, run, 1, gamma_of(s, run, 0)) < 0.02);
}

void test_threads_change_nothing(void **) {
    const auto s = alternating<Simulation>();
    lensprof_fit_options options = default_fit();
    Run one(s), four(s);
    options.threads = 1;
    assert_ok(one.fit(s, options));
    options.threads = 4;
    assert_ok(four.fit(s, options));
    assert_memory_equal(one.exposures.data(), four.exposures.data(), s.images * sizeof one.exposures[0]);
    assert_memory_equal(one.cameras.data(), four.cameras.data(), 2 * sizeof one.cameras[0]);
}

// Progress covers both cameras.
void test_progress_rises(void **) {
    const auto s = alternating<Simulation>();
    struct Told {
        double last = 0.0;
        int falls = 0, calls = 0;
    } told;
    lensprof_fit_options options = default_fit();
    options.progress = [](double done, void *user) {
        auto &t = *static_cast<Told *>(user);
        t.falls += done < t.last || done > 1.0;
        t.last = done, t.calls++;
        return 0;
    };
    options.progress_user = &told;
    Run run(s);
    assert_ok(run.fit(s, options));
    assert_true(told.calls > 10 && told.falls == 0 && told.last > 0.7);
    options.progress = [](double done, void *) { return static_cast<int>(done > 0.6); };
    assert_int_equal(run.fit(s, options), LENSPROF_ERROR_CANCELLED);
}

void test_profile_of_a_camera(void **) {
    const auto s = alternating<Simulation>();
    Run run(s);
    assert_ok(run.fit(s, default_fit()));
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    assert_ok(lensprof_fit_profile(run.held.get(), 1, &profile, nullptr));
    assert_ok(lensprof_profile_validate(&profile));
    assert_memory_equal(profile.vignetting, run.settings[1].vignetting, sizeof profile.vignetting);
    assert_memory_equal(profile.response[0].table, run.of_camera(1).response.table, sizeof profile.response[0].table);
    assert_true(profile.provenance.heldout_rms == run.of_camera(1).heldout_rms);
    assert_int_equal(profile.provenance.images, 5);
    assert_true(profile.covariance_size > 0);
}

void test_bad_input(void **) {
    auto s = alternating<Simulation>();
    lensprof_error error;
    Run run(s);
    auto mixed = s;
    mixed.fit_images[3].setting = 0;  // belongs to camera 1
    assert_int_equal(run_fit(s).result.usable, 1);
    Run other(s);
    assert_int_equal(other.fit(mixed, default_fit(), &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(error.item.index, 3);
    auto beyond = s;
    beyond.fit_images[2].camera = LENSPROF_CAMERAS_MAX;
    assert_int_equal(other.fit(beyond, default_fit(), &error), LENSPROF_ERROR_ARGUMENT);
    auto alone = s;
    for (uint32_t i = 0; i < s.images; i++) alone.fit_images[i].camera = alone.fit_images[i].setting = i;
    Run each(s);
    assert_int_equal(each.fit(alone, default_fit(), &error), LENSPROF_ERROR_NO_SAMPLES);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_response_is_found),
        cmocka_unit_test(test_each_response_is_found_by_radiance),
        cmocka_unit_test(test_each_response_is_found_in_grey),
        cmocka_unit_test(test_knowledge_of_one_serves_the_other),
        cmocka_unit_test(test_stated_errors_hold),
        cmocka_unit_test(test_priors_err_together),
        cmocka_unit_test(test_numbers_are_names),
        cmocka_unit_test(test_held_response_is_of_all),
        cmocka_unit_test(test_cameras_apart),
        cmocka_unit_test(test_most_must_agree),
        cmocka_unit_test(test_contradictions_join_nothing),
        cmocka_unit_test(test_single_picture_is_left_out),
        cmocka_unit_test(test_groups_of_a_camera),
        cmocka_unit_test(test_any_reference),
        cmocka_unit_test(test_exposures_of_references),
        cmocka_unit_test(test_what_is_judged_for_all_cameras),
        cmocka_unit_test(test_links_end_at_cameras),
        cmocka_unit_test(test_threads_change_nothing),
        cmocka_unit_test(test_progress_rises),
        cmocka_unit_test(test_profile_of_a_camera),
        cmocka_unit_test(test_bad_input),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
