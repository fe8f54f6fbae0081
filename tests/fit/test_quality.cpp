// What a result reports about itself: coverage, quality per image, local residuals, and the verdict in words.
#include "simulated.hpp"

#include <numeric>
#include <string>

namespace {

Simulation simulate(uint32_t pairs, double noise, double outliers, uint64_t seed = 42, uint32_t reach = 1) {
    Simulation s;
    s.response = srgb_response();
    s.images = reach > 1 ? 8 : 6;
    s.reach = reach;
    s.make(pairs, noise, outliers, 1.0, seed);
    return s;
}

template <class Condition>
void drop(Simulation &s, Condition &&condition) {
    s.pairs.erase(std::remove_if(s.pairs.begin(), s.pairs.end(), condition), s.pairs.end());
}

bool says(const FitRun &run, lensprof_reason code, const char *words) {
    bool found = strstr(run.result.first.text, words) != nullptr && run.result.first.code == code;
    if (!found)
        print_error("no \"%s\" (%u) in \"%s\" (%u)\n", words, code, run.result.first.text, run.result.first.code);
    return found;
}

// Whether the reason is about this image, with the range in its text that names it.
bool names(const FitRun &run, uint32_t image) {
    const lensprof_item &item = run.result.first.item;
    const std::string words = std::string(run.result.first.text).substr(item.text_begin, item.text_bytes);
    return item.kind == LENSPROF_ITEM_IMAGE && item.index == image && words == "image " + std::to_string(image);
}

void test_groups_are_told(void **) {
    Simulation s = simulate(1500, 1.0, 0.0);
    drop(s, [](const lensprof_pair &p) { return p.image[0] == 1 || p.image[0] == 3; });
    FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 0);
    assert_int_equal(run.result.components, 3);
    assert_close(run.result.first.value[0], 3.0, 0.0);
    assert_true(says(run, LENSPROF_REASON_IMAGE_GROUPS, "3 groups") && names(run, 2));
    const uint32_t component[6] = {0, 0, 2, 2, 4, 4};
    for (uint32_t i = 0; i < 6; i++) assert_int_equal(run.quality[i].component, component[i]);
}

// Distance from the true centre, half diagonals.
double radius(const Simulation &s, const lensprof_pair &pair, int side) {
    double half = 0.5 * std::hypot(s.width, s.height);
    double x = (pair.xy[side][0] - 0.5 * (s.width - 1)) / half - s.vignetting.center[0];
    double y = (pair.xy[side][1] - 0.5 * (s.height - 1)) / half - s.vignetting.center[1];
    return std::hypot(x, y);
}

// Standard error of M(1), one curve.
double corner_sigma(const lensprof_fit_result &r) {
    const uint32_t n = r.covariance_size, first = n - 5;
    double variance = 0.0;
    for (uint32_t i = first; i < first + 3; i++)
        for (uint32_t j = first; j < first + 3; j++) variance += r.covariance[i * n + j];
    return std::sqrt(variance);
}

void test_the_corners_must_be_covered(void **) {
    Simulation s = simulate(9000, 1.0, 0.0);
    drop(s, [&](const lensprof_pair &p) { return radius(s, p, 0) > 0.5 || radius(s, p, 1) > 0.5; });
    assert_true(s.pairs.size() > 1000);
    // What lenses have in common continues the falloff into the corners, with the error stated there.
    FitRun run = run_fit(s);
    const double corner = lensprof_vignetting_eval(&run.result.vignetting[1], 1.0, nullptr),
                 truth = std::pow(lensprof_vignetting_eval(&s.vignetting, 1.0, nullptr), s.gamma(run.exposures)),
                 sigma = corner_sigma(run.result);
    assert_true(sigma > 0.05 && std::abs(corner - truth) < 2.0 * sigma);
    // With a known centre, the radius equals the true one.
    lensprof_fit_options options = default_fit();
    options.free &= ~LENSPROF_FREE_CENTER;
    std::copy(s.vignetting.center, s.vignetting.center + 2, options.vignetting.center);
    run = run_fit(s, options);
    assert_int_equal(run.result.usable, 0);
    assert_true(says(run, LENSPROF_REASON_SMALL_RADIUS, "reach only to 0.5 of the half diagonal"));
    for (const auto &q : run.quality) assert_true(q.radius > 0.45 && q.radius <= 0.5);
    for (int bin = 5; bin < LENSPROF_COVERAGE_BINS; bin++) assert_int_equal(run.result.radius_ends[bin], 0);
    // If the falloff is not unknown, that is not a problem.
    options.free = LENSPROF_FREE_RESPONSE;
    options.vignetting = s.vignetting;
    assert_int_equal(run_fit(s, options).result.usable, 1);
}

// Negatives: the corners get less light, which comes out as more.
void test_a_falloff_that_rises_is_not_usable(void **) {
    Simulation s = simulate(2000, 1.0, 0.0);
    assert_int_equal(run_fit(s).result.usable, 1);
    for (auto &pair : s.pairs)
        for (auto &value : pair.value)
            for (double &v : value) v = 1.0 - v;
    const FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 0);
    assert_true(says(run, LENSPROF_REASON_FALLOFF_RISES, "unlike any lens"));
    assert_true(run.result.first.value[0] > 1.1 && run.result.first.value[1] < 0.1);
}

// Two pictures with different white balances, which are held: the falloff's centre absorbs the difference, without a
// prior up to its limit.
void test_a_centre_on_its_limit_is_not_usable(void **) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        Simulation s;
        s.response = srgb_response();
        s.images = 2;
        s.shift = 0.6;
        s.exposures = {{0.0, {1.0, 1.0, 1.0}}, {0.25, {1.1, 1.0, 0.9}}};
        s.make(2000, 2.0, 0.0, 1.0, seed);
        const FitRun all = run_fit(s);
        assert_int_equal(all.result.usable, 1);
        assert_close(all.result.vignetting[0].center[0], s.vignetting.center[0], 0.02);
        s.fit_images[1].free = LENSPROF_FREE_EV;
        const FitRun prior = run_fit(s);
        assert_true(!prior.result.usable || prior.result.first.code == LENSPROF_REASON_WHITE_BALANCE_FIXED);
        lensprof_fit_options options = default_fit();
        options.prior_weight = 0.0;
        const FitRun held = run_fit(s, options);
        assert_int_equal(held.result.first.code, LENSPROF_REASON_CENTER_ON_LIMIT);
        assert_close(held.result.first.value[0], 0.5, 0.01);
    }
}

// Grey values that no lens produces.
void test_a_falloff_to_nothing_is_not_usable(void **) {
    Simulation s;
    s.response = srgb_response();
    for (uint32_t i = 0; i < s.images; i++) s.exposures.push_back({0.2 * i, {1.0, 1.0, 1.0}});
    s.vignetting = {{-1.6, 0.4, 0.22}, {0.0, 0.0}};
    s.make(6000, 1.0, 0.0, 1.0, 5);
    const FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 0);
    assert_int_equal(run.result.first.code, LENSPROF_REASON_FALLOFF_DARK);
    assert_true(run.result.first.value[0] < 0.05);
}

// Six pictures, the third of them warmer; white balances held, free, or equal.
void test_balances_that_are_held_are_told(void **) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        Simulation s;
        s.response = srgb_response();
        uint64_t random = seed;
        for (uint32_t i = 0; i < s.images; i++)
            s.exposures.push_back({i ? lp_random(&random) - 0.5 : 0.0, {1.0, 1.0, 1.0}});
        Simulation equal = s;
        s.exposures[2] = {0.3, {1.06, 1.0, 0.94}};
        for (Simulation *one : {&s, &equal}) {
            one->make(6000, 2.0, 0.02, 1.0, seed);
            const FitRun free = run_fit(*one);
            assert_int_not_equal(free.result.first.code, LENSPROF_REASON_WHITE_BALANCE_FIXED);
            for (auto &image : one->fit_images) image.free = LENSPROF_FREE_EV;
        }
        assert_int_not_equal(run_fit(equal).result.first.code, LENSPROF_REASON_WHITE_BALANCE_FIXED);
        const FitRun held = run_fit(s);
        assert_true(says(held, LENSPROF_REASON_WHITE_BALANCE_FIXED, "the colours of image 2 differ"));
        assert_true(held.result.first.value[0] > 1.5 && held.result.first.value[0] < 20.0);
    }
}

void test_the_greys_must_be_covered(void **) {
    Simulation s;
    s.response = srgb_response();
    s.channels = 1;
    s.exposures.assign(s.images, {0.0, {1.0, 1.0, 1.0}});
    s.make(80000, 0.3, 0.0, 0.0, 42);
    drop(s, [](const lensprof_pair &p) {
        auto is_off = [](double v) { return v < 0.50 || v > 0.545; };
        return is_off(p.value[0][0]) || is_off(p.value[1][0]);
    });
    assert_true(s.pairs.size() >= 100);
    lensprof_fit_options options = default_fit();
    options.channels = 1;
    FitRun run = run_fit(s, options);
    assert_int_equal(run.result.usable, 0);
    assert_true(says(run, LENSPROF_REASON_FEW_GREYS, "only 1 tenths of the grey values"));
    for (const auto &q : run.quality)
        assert_true(0.50 <= q.grey_low && q.grey_low < q.grey_high && q.grey_high <= 0.545);
}

// Ends are counted in the bins of the truth.
void test_coverage_counts_every_end(void **) {
    for (uint32_t channels : {1u, 3u}) {
        Simulation s;
        s.response = srgb_response();
        s.channels = channels;
        s.make(1200, 1.0, 0.0, 1.0, 5);
        lensprof_fit_options options = default_fit();
        options.channels = channels;
        options.free &= ~LENSPROF_FREE_CENTER;
        options.vignetting.center[0] = s.vignetting.center[0], options.vignetting.center[1] = s.vignetting.center[1];
        FitRun run = run_fit(s, options);
        uint32_t rings[LENSPROF_COVERAGE_BINS] = {0}, greys[LENSPROF_COVERAGE_BINS] = {0}, of_image[6] = {0};
        for (const auto &p : s.pairs)
            for (int side = 0; side < 2; side++) {
                rings[std::min(9, static_cast<int>(10.0 * radius(s, p, side)))]++;
                of_image[p.image[side]]++;
                for (uint32_t c = 0; c < channels; c++) greys[std::min(9, static_cast<int>(10.0 * p.value[side][c]))]++;
            }
        assert_memory_equal(run.result.radius_ends, rings, sizeof rings);
        assert_memory_equal(run.result.grey_ends, greys, sizeof greys);
        assert_int_equal(std::accumulate(rings, rings + 10, 0u), 2 * run.result.pairs);
        assert_int_equal(std::accumulate(run.result.grey_ends, run.result.grey_ends + 10, 0u),
                         2 * run.result.pairs * channels);
        for (uint32_t i = 0; i < s.images; i++) assert_int_equal(run.quality[i].pairs, of_image[i]);
    }
}

// One image is not where the project has it: its values belong to other places.
void test_a_misplaced_image_is_left_out(void **) {
    Simulation s = simulate(3000, 1.0, 0.0, 42, 3);
    std::vector<double *> values;
    for (auto &p : s.pairs)
        for (int side = 0; side < 2; side++)
            if (p.image[side] == 4) values.push_back(p.value[side]);
    double first[3];
    std::copy(values[0], values[0] + 3, first);
    for (size_t i = 1; i < values.size(); i++) std::copy(values[i], values[i] + 3, values[i - 1]);
    std::copy(first, first + 3, values.back());
    FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.equalizes, 1);
    assert_true(says(run, LENSPROF_REASON_IMAGES_LEFT_OUT, "including image 4)") && names(run, 4));
    assert_close(run.result.first.value[0], 1.0, 0.0);
    assert_int_equal(run.result.left_out, 1);
    for (uint32_t i = 0; i < s.images; i++) {
        assert_int_equal(run.quality[i].joined, i != 4);
        assert_int_equal(std::isnan(run.exposures[i].ev), i == 4);
        if (i == 4)
            assert_true(run.quality[i].pairs > 100 && run.quality[i].median_residual > 10.0);
        else
            assert_true(run.quality[i].median_residual < 3.0);
    }
}

// If the reference itself is misplaced, the first of the other images replaces it.
void test_a_misplaced_reference_is_replaced(void **) {
    Simulation s = simulate(3000, 1.0, 0.0, 42, 3);
    for (auto &p : s.pairs)
        for (int side = 0; side < 2; side++)
            if (p.image[side] == 0)
                for (double &v : p.value[side]) v = std::fmod(1.0 + 7.3 * p.xy[side][0] * p.xy[side][1], 0.9);
    FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.reference, 1);
    assert_true(std::isnan(run.exposures[0].ev));
    assert_close(run.exposures[1].ev, 0.0, 0.0);
    assert_true(run.quality[2].ev_sigma > 0.0);
}

// Drops all but `count` pairs of the last image.
void keep_of_last(Simulation &s, uint32_t count) {
    uint32_t kept = 0, last = s.images - 1;
    drop(s, [&](const lensprof_pair &p) { return (p.image[0] == last || p.image[1] == last) && kept++ >= count; });
}

// No pair of the last image: nothing disagrees, unless sampling found that the pictures show something else there.
void test_an_image_without_pairs_is_unconnected(void **) {
    Simulation s = simulate(3000, 1.0, 0.0, 42, 3);
    const uint32_t last = s.images - 1;
    keep_of_last(s, 0);
    FitRun run = run_fit(s);
    assert_int_equal(run.result.left_out, 1);
    assert_true(says(run, LENSPROF_REASON_IMAGES_UNCONNECTED, "including image 7;") && names(run, last));
    assert_close(run.result.first.value[0], 1.0, 0.0);
    lensprof_link links[] = {{{0, 1}, LENSPROF_LINK_VERIFIED, 100}, {{last - 1, last}, LENSPROF_LINK_CONTRADICTED, 0}};
    lensprof_fit_options options = default_fit();
    options.links = links, options.link_count = 1;
    assert_true(says(run_fit(s, options), LENSPROF_REASON_IMAGES_UNCONNECTED, "no pairs connect 1 of the images"));
    options.link_count = 2;
    assert_true(says(run_fit(s, options), LENSPROF_REASON_IMAGES_LEFT_OUT, "(1, including image 7)"));
}

// Images that overlap nothing count against a result of which no overlap shows the same content.
void test_a_minority_without_verified_links_is_refused(void **) {
    Simulation s = simulate(3000, 1.0, 0.0, 42, 3);
    lensprof_link links[] = {{{0, 1}, LENSPROF_LINK_UNVERIFIED, 100}, {{1, 2}, LENSPROF_LINK_UNVERIFIED, 100}};
    lensprof_fit_options options = default_fit();
    options.unlinked_images = s.images;  // exactly half take part
    options.links = links, options.link_count = 2;
    assert_int_equal(run_fit(s, options).result.usable, 1);
    options.unlinked_images = s.images + 1;
    const FitRun run = run_fit(s, options);
    assert_true(says(run, LENSPROF_REASON_IMAGES_MINORITY, "only 8 of 17 images"));
    assert_int_equal(run.result.usable + run.result.equalizes, 0);
    assert_close(run.result.first.measured, 8.0 / 17.0, 1e-12);
    assert_close(run.result.first.limit, 0.5, 0.0);
    options.link_count = 0;  // nothing is known of the links
    assert_int_equal(run_fit(s, options).result.usable, 1);
    links[1].state = LENSPROF_LINK_VERIFIED, options.link_count = 2;
    assert_int_equal(run_fit(s, options).result.usable, 1);
}

// Few images of a camera that moved are a note, if the falloff is estimated.
void test_few_images_of_a_moving_camera_are_noted(void **) {
    Simulation s = simulate(3000, 1.0, 0.0, 42, 3);
    lensprof_fit_options options = default_fit();
    assert_true(!says(run_fit(s, options), LENSPROF_REASON_FEW_IMAGES, ""));
    options.moving_camera = 1;
    const FitRun run = run_fit(s, options);
    assert_int_equal(run.result.usable, 1);
    assert_true(says(run, LENSPROF_REASON_FEW_IMAGES, "only 8 images of a moving camera"));
    assert_int_equal(run.result.first.severity, LENSPROF_SEVERITY_NOTE);
    assert_close(run.result.first.value[1], 12.0, 0.0);
    options.free = LENSPROF_FREE_RESPONSE;
    options.vignetting = s.vignetting;
    assert_true(!says(run_fit(s, options), LENSPROF_REASON_FEW_IMAGES, ""));
}

// Two pairs for each of seven images: all are left out together, because they are more than the fits that are tried.
void test_images_with_few_pairs_are_left_out_together(void **) {
    Simulation s;
    s.response = srgb_response();
    s.images = 24, s.reach = 3;
    s.make(4000, 1.0, 0.0, 1.0, 42);
    const auto is_weak = [](uint32_t i) { return i > 0 && i % 3 == 0; };
    std::vector<uint32_t> kept(s.images, 0);
    drop(s, [&](const lensprof_pair &p) {
        if (is_weak(p.image[0]) == is_weak(p.image[1])) return is_weak(p.image[0]);
        return ++kept[p.image[is_weak(p.image[0]) ? 0 : 1]] > 2;
    });
    lensprof_fit_options options = default_fit();
    const FitRun run = run_fit(s, options);
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.left_out, 7);
    for (uint32_t i = 0; i < s.images; i++) assert_int_equal(std::isnan(run.exposures[i].ev), is_weak(i));
}

// Two images, each connected to the other alone, are unconnected; with an image that disagrees, the reason is about
// that.
void test_images_that_disagree_come_first(void **) {
    Simulation s = simulate(4000, 1.0, 0.0, 42, 3);
    const auto is_last = [&](uint32_t i) { return i + 2 >= s.images; };
    drop(s, [&](const lensprof_pair &p) { return is_last(p.image[0]) != is_last(p.image[1]); });
    assert_true(says(run_fit(s), LENSPROF_REASON_IMAGES_UNCONNECTED, "2 of the images, including image 6;"));
    for (auto &p : s.pairs)
        for (int side = 0; side < 2; side++)
            if (p.image[side] == 5)
                for (double &v : p.value[side]) v = std::fmod(1.0 + 7.3 * p.xy[side][0] * p.xy[side][1], 0.9);
    const FitRun run = run_fit(s);
    assert_int_equal(run.result.left_out, 3);
    assert_true(says(run, LENSPROF_REASON_IMAGES_LEFT_OUT, "(1, including image 5)") && names(run, 5));
}

// Links that contradict the others are left out; their images stay.
void test_a_broken_link_is_left_out_alone(void **) {
    Simulation s = simulate(3000, 1.0, 0.0, 42, 3);
    size_t of_link = 0;
    for (auto &p : s.pairs)
        if (p.image[0] == 2 && p.image[1] == 3) {
            of_link++;
            for (double &v : p.value[1]) v = std::fmod(v + 3.7 * static_cast<double>(of_link), 0.9);
        }
    assert_true(of_link > 50);
    FitRun run = run_fit(s);
    assert_int_equal(run.result.usable, 1);
    assert_int_equal(run.result.left_out, 0);
    assert_int_equal(run.result.pairs, s.pairs.size() - of_link);
    assert_true(says(run, LENSPROF_REASON_LINKS_CONTRADICT, "1 of the links") && names(run, 2));
    assert_int_equal(run.result.equalizes, 0);  // that seam stays
}

// The last image keeps seven pairs, five of which show something else; two agree on an exposure by chance.
void test_an_exposure_must_rest_on_pairs(void **) {
    Simulation s = simulate(2000, 1.0, 0.0, 42, 3);
    const uint32_t last = s.images - 1;
    keep_of_last(s, 7);
    assert_int_equal(run_fit(s).result.usable, 1);
    uint32_t seen = 0;
    for (auto &p : s.pairs)
        if ((p.image[0] == last || p.image[1] == last) && seen++ < 5)
            for (double &v : p.value[p.image[1] == last]) v = 0.15 * seen;
    FitRun run = run_fit(s);
    assert_int_equal(run.quality[last].pairs, 7);
    assert_true(run.quality[last].inliers < 3);
    assert_int_equal(run.quality[last].joined, 0);
    assert_true(says(run, LENSPROF_REASON_IMAGES_LEFT_OUT, "image 7") && names(run, 7));
    // A given exposure needs no support from pairs.
    s.fit_images[last].free = 0;
    s.fit_images[last].exposure = s.exposures[last];
    assert_int_not_equal(run_fit(s).result.first.code, LENSPROF_REASON_FEW_INLIERS);
}

// Exposures far apart depend on gamma; that alone does not make them uncertain, not even in grey pictures.
void test_gamma_is_no_doubt_of_an_exposure(void **) {
    for (uint32_t channels : {1u, 3u}) {
        Simulation s;
        s.response = srgb_response();
        s.channels = channels;
        for (uint32_t i = 0; i < s.images; i++) s.exposures.push_back({0.5 * i, {1.0, 1.0, 1.0}});
        s.make(4000, 1.0, 0.0, 1.0, 42);
        lensprof_fit_options options = default_fit();
        options.channels = channels;
        FitRun run = run_fit(s, options);
        assert_int_equal(run.result.usable, 1);
        assert_true(run.quality[5].ev_sigma > 0.2);
    }
}

// A link provides what two pairs could not.
void test_linked_images_share_their_pairs(void **) {
    Simulation s = simulate(2000, 1.0, 0.0, 42, 3);
    const uint32_t last = s.images - 1;
    keep_of_last(s, 2);
    assert_true(says(run_fit(s), LENSPROF_REASON_IMAGES_LEFT_OUT, "including image 7)"));
    s.fit_images[last].ev_of = s.fit_images[last].red_of = s.fit_images[last].blue_of = last - 1;
    assert_int_not_equal(run_fit(s).result.first.code, LENSPROF_REASON_FEW_INLIERS);
}

// Overlaps as in a panorama: neighbouring pixels in one frame are neighbours in the other.
Simulation overlaps(double local_ev, double frame_ev, double outliers = 0.0, uint64_t seed = 42) {
    Simulation s;
    s.response = srgb_response();
    s.images = 8, s.reach = 3, s.shift = 0.25;
    s.local_ev = local_ev, s.frame_ev = frame_ev;
    s.make(2000, 1.0, outliers, 1.0, seed);
    return s;
}

FitRun panorama(double local_ev, double frame_ev, double outliers = 0.0, uint64_t seed = 42) {
    Simulation s = overlaps(local_ev, frame_ev, outliers, seed);
    return run_fit(s);
}

// Each picture was brightened and darkened according to its surroundings; the stronger the effect, the larger the local
// part of the residual.
void test_local_processing_is_refused(void **) {
    double last = 0.0;  // levels
    for (double local_ev : {0.02, 0.05, 0.2, 0.5}) {
        FitRun run = panorama(local_ev, 0.0);
        const double pattern = run.result.noise_levels * std::sqrt(run.result.image_share);
        print_message("local %.2f EV: image share %.2f, noise %.2f levels\n", local_ev, run.result.image_share,
                      run.result.noise_levels);
        assert_true(pattern > last && run.result.image_share <= 1.0);
        last = pattern;
        assert_int_equal(run.result.usable, local_ev < 0.03);
        if (!run.result.usable) assert_true(says(run, LENSPROF_REASON_PATTERNS, "a different pattern in each image"));
    }
}

// Weak patterns and an unusual response: each alone may be a camera's, both together are not.
void test_patterns_and_an_unusual_response_are_refused(void **) {
    for (const uint32_t kind : {LENSPROF_CAMERA_ANY, LENSPROF_CAMERA_STILL})
        for (const double local_ev : {0.0, 0.03}) {
            Simulation s = overlaps(local_ev, 0.0);
            lensprof_fit_options options = default_fit();
            options.camera_kind = kind;
            const FitRun run = run_fit(s, options);
            const bool is_refused = kind == LENSPROF_CAMERA_STILL && local_ev > 0.0;
            assert_int_equal(run.result.usable, !is_refused);
            if (is_refused) assert_true(says(run, LENSPROF_REASON_PATTERNS, "unlike those of measured cameras"));
        }
}

// One pattern in all pictures is not a radial falloff, but it belongs to the camera: the result is usable, and a reason
// reports it.
void test_a_falloff_that_is_not_radial_is_told(void **) {
    FitRun run = panorama(0.0, 0.1);
    print_message("frame 0.1 EV: frame share %.2f, image share %.2f\n", run.result.frame_share, run.result.image_share);
    assert_true(run.result.frame_share > 0.3);
    assert_true(run.result.image_share < 0.1);
    assert_int_equal(run.result.usable, 1);
    assert_true(says(run, LENSPROF_REASON_NOT_RADIAL, "not radial"));
}

void test_noise_and_outliers_are_no_pattern(void **) {
    for (uint64_t seed = 1; seed <= 10; seed++)
        for (double outliers : {0.0, 0.3}) {
            FitRun run = panorama(0.0, 0.0, outliers, seed);
            assert_true(run.result.frame_share < 0.05);
            assert_true(run.result.image_share < 0.1);
            assert_int_equal(run.result.usable, 1);
        }
}

Simulation chromatic(uint64_t seed) {
    Simulation s;
    s.response = srgb_response();
    s.chromatic = {{{-0.24, 0.05, -0.12}, {0.02, -0.015}},
                   {{-0.30, 0.05, -0.15}, {0.02, -0.015}},
                   {{-0.36, 0.05, -0.17}, {0.02, -0.015}}};
    s.make(2000, 1.0, 0.0, 1.0, seed);
    return s;
}

void test_a_falloff_of_each_channel(void **) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        Simulation s = chromatic(seed);
        FitRun run = run_fit(s);
        double g = s.gamma(run.exposures);
        assert_int_equal(run.result.vignettings, 3);
        for (uint32_t c = 0; c < 3; c++) {
            assert_true(s.falloff_error(run.result.vignetting[c], g, c) < 0.01);
            assert_memory_equal(run.result.vignetting[c].center, run.result.vignetting[0].center, 2 * sizeof(double));
        }
        lensprof_fit_options options = default_fit();
        options.vignettings = 1;
        FitRun one = run_fit(s, options);
        assert_int_equal(one.result.vignettings, 1);
        assert_true(one.result.heldout_median > run.result.heldout_median);
        assert_true(one.result.noise_levels > run.result.noise_levels);
    }
}

void test_one_falloff_where_one_serves(void **) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        FitRun run = run_fit(simulate(800, 1.0, 0.0, seed));
        assert_int_equal(run.result.vignettings, 1);
        assert_memory_equal(&run.result.vignetting[1], &run.result.vignetting[0], sizeof run.result.vignetting[0]);
        assert_memory_equal(&run.result.vignetting[2], &run.result.vignetting[0], sizeof run.result.vignetting[0]);
    }
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_groups_are_told),
        cmocka_unit_test(test_the_corners_must_be_covered),
        cmocka_unit_test(test_a_falloff_that_rises_is_not_usable),
        cmocka_unit_test(test_a_centre_on_its_limit_is_not_usable),
        cmocka_unit_test(test_a_falloff_to_nothing_is_not_usable),
        cmocka_unit_test(test_balances_that_are_held_are_told),
        cmocka_unit_test(test_the_greys_must_be_covered),
        cmocka_unit_test(test_coverage_counts_every_end),
        cmocka_unit_test(test_a_misplaced_image_is_left_out),
        cmocka_unit_test(test_a_misplaced_reference_is_replaced),
        cmocka_unit_test(test_an_image_without_pairs_is_unconnected),
        cmocka_unit_test(test_images_that_disagree_come_first),
        cmocka_unit_test(test_a_minority_without_verified_links_is_refused),
        cmocka_unit_test(test_few_images_of_a_moving_camera_are_noted),
        cmocka_unit_test(test_images_with_few_pairs_are_left_out_together),
        cmocka_unit_test(test_a_broken_link_is_left_out_alone),
        cmocka_unit_test(test_an_exposure_must_rest_on_pairs),
        cmocka_unit_test(test_gamma_is_no_doubt_of_an_exposure),
        cmocka_unit_test(test_linked_images_share_their_pairs),
        cmocka_unit_test(test_local_processing_is_refused),
        cmocka_unit_test(test_patterns_and_an_unusual_response_are_refused),
        cmocka_unit_test(test_a_falloff_that_is_not_radial_is_told),
        cmocka_unit_test(test_noise_and_outliers_are_no_pattern),
        cmocka_unit_test(test_a_falloff_of_each_channel),
        cmocka_unit_test(test_one_falloff_where_one_serves),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
