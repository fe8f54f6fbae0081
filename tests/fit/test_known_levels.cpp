// Long strips of pictures at one manual exposure: known exposures keep the strip level, even if some are wrong.
#include "simulated.hpp"

#include "campaign.h"
#include "fit/prior/known_levels.hpp"

using namespace lensprof;

namespace {

constexpr uint32_t kImages = 28;

// A strip whose neighbours share 30 %, taken with one exposure that scatters by `scatter` EV. Its falloff deviates from
// radial by one percent, which the fit of a strip takes for a drift of the exposures.
Simulation strip(double scatter, uint64_t seed, double tilt = 0.015) {
    Simulation s;
    s.response = srgb_response();
    s.images = kImages;
    s.shift = 0.7;
    s.tilt_ev = tilt;
    uint64_t random = seed + 99;
    for (uint32_t i = 0; i < kImages; i++) s.exposures.push_back({scatter * lp_normal(&random), {1.0, 1.0, 1.0}});
    s.exposures[0].ev = 0.0;
    s.make(300 * kImages, 2.0, 0.0, 1.0, seed);
    for (auto &image : s.fit_images) image.known_ev = 9.0, image.known_ev_sigma = 0.03;
    return s;
}

// Range of found minus true exposures over images [first, last).
double spread(const Simulation &s, const std::vector<lensprof_exposure> &found, uint32_t first, uint32_t last) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = first; i < last; i++) {
        low = std::min(low, found[i].ev - s.exposures[i].ev);
        high = std::max(high, found[i].ev - s.exposures[i].ev);
    }
    return high - low;
}

void test_one_manual_exposure_keeps_a_strip_level(void **) {
    for (uint64_t seed = 1; seed <= uint64_t(campaign_runs(3)); seed++) {
        Simulation s = strip(0.0, seed);
        const FitRun known = run_fit(s);
        for (auto &image : s.fit_images) image.known_ev_sigma = 0.0;
        const FitRun unknown = run_fit(s);
        lensprof_fit_options options = default_fit();
        options.prior_weight = 0.0;
        const FitRun paper = run_fit(s, options);
        assert_true(spread(s, known.exposures, 0, kImages) <= 0.05);
        assert_true(spread(s, unknown.exposures, 0, kImages) <= 0.05);  // since they are taken as equal
        assert_int_equal(unknown.result.equal_exposures, 1);
        assert_true(spread(s, paper.exposures, 0, kImages) > 0.1);
    }
}

// Shutter and aperture scatter as stated; the pictures show by how much.
void test_the_scatter_is_found(void **) {
    for (uint64_t seed = 1; seed <= uint64_t(campaign_runs(3)); seed++) {
        Simulation s = strip(0.03, seed);
        const FitRun run = run_fit(s);
        assert_true(spread(s, run.exposures, 0, kImages) <= 0.05);
        assert_string_equal(run.result.first.text, "");
        for (const auto &q : run.quality) assert_int_equal(q.known_ev_left_out, 0);
    }
}

// Three of 28 are wrong by half a stop: the others come out as without these three.
void test_a_few_that_are_wrong_are_left_out(void **) {
    for (uint64_t seed = 1; seed <= uint64_t(campaign_runs(3)); seed++) {
        Simulation s = strip(0.0, seed);
        for (uint32_t wrong : {4u, 13u, 14u}) s.fit_images[wrong].known_ev_sigma = 0.0;
        const FitRun without = run_fit(s);
        for (uint32_t wrong : {4u, 13u, 14u}) s.fit_images[wrong].known_ev_sigma = 0.03;
        s.fit_images[4].known_ev += 0.5, s.fit_images[13].known_ev -= 0.5, s.fit_images[14].known_ev += 0.5;
        const FitRun with = run_fit(s);
        for (uint32_t i = 0; i < kImages; i++) assert_close(with.exposures[i].ev, without.exposures[i].ev, 0.003);
        for (uint32_t i = 0; i < kImages; i++)
            assert_int_equal(with.quality[i].known_ev_left_out, i == 4 || i == 13 || i == 14);
        assert_int_equal(with.result.usable, 1);
        assert_int_equal(with.result.first.code, LENSPROF_REASON_KNOWN_WRONG);
        assert_true(with.quality[with.result.first.item.index].known_ev_left_out);
    }
}

// The aperture ring was moved at the 11th picture, which EXIF does not record: both parts stay level.
void test_a_step_parts_the_strip(void **) {
    for (uint64_t seed = 1; seed <= uint64_t(campaign_runs(3)); seed++) {
        Simulation s = strip(0.0, seed);
        for (uint32_t i = 10; i < kImages; i++) s.fit_images[i].known_ev += 0.5;
        const FitRun run = run_fit(s);
        assert_true(spread(s, run.exposures, 0, 10) <= 0.05);
        assert_true(spread(s, run.exposures, 10, kImages) <= 0.05);
        assert_true(spread(s, run.exposures, 0, kImages) <= 0.1);
        for (const auto &q : run.quality) assert_int_equal(q.known_ev_left_out, 0);
        assert_int_equal(run.result.first.code, LENSPROF_REASON_KNOWN_STEP);
        assert_int_equal(run.result.first.item.index, 10);
    }
}

// Differences between neighbours, in standard errors of both: 5 of them is a scatter of 5, a drift is not scatter. What
// may be chance is subtracted.
void test_the_scatter_of_neighbours(void **) {
    Simulation s = strip(0.0, 1);
    Problem problem = make_problem(default_fit(), s.fit_images.data(), s.images, s.pairs.data(), [&] {
        std::vector<uint32_t> keep(s.pairs.size());
        for (uint32_t p = 0; p < keep.size(); p++) keep[p] = p;
        return keep;
    }());
    const KnownNeighbours neighbours(problem, std::vector<bool>(kImages, true));
    std::vector<double> off(kImages), sigma(kImages, 0.03);
    for (uint32_t i = 0; i < kImages; i++) off[i] = 0.01 * i;
    assert_close(neighbours.scatter(off, sigma), 1.0, 0.0);
    const std::vector<int> one = neighbours.levels(off, sigma, 1.0);
    assert_int_equal(*std::max_element(one.begin(), one.end()), 0);
    uint64_t random = 5;
    for (double &value : off) value = 5.0 * 0.03 * lp_normal(&random);
    assert_close(neighbours.scatter(off, sigma), 5.0, 1.5);
    // One outlier, and an offset of all images from the 20th on.
    for (uint32_t i = 0; i < kImages; i++) off[i] = i == 7 ? -1.0 : i >= 20 ? 0.5 : 0.0;
    const std::vector<int> three = neighbours.levels(off, sigma, 1.0);
    assert_int_equal(*std::max_element(three.begin(), three.end()), 2);
    for (uint32_t i = 0; i < kImages; i++) assert_int_equal(three[i] == three[0], i < 20 && i != 7);
    assert_true(three[20] == three[27] && three[7] != three[20]);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_one_manual_exposure_keeps_a_strip_level),
        cmocka_unit_test(test_the_scatter_is_found),
        cmocka_unit_test(test_a_few_that_are_wrong_are_left_out),
        cmocka_unit_test(test_a_step_parts_the_strip),
        cmocka_unit_test(test_the_scatter_of_neighbours),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
