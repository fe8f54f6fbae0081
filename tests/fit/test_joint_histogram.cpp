// Joint histograms and transfer functions found in them (Kim & Pollefeys 2004, section 2.2).
#include "simulated.hpp"

#include "fit/methods/transfer_function/joint_histogram.hpp"

using namespace lensprof;

namespace {

JointHistogram random_histogram(int bins, uint64_t &random) {
    JointHistogram h{bins, {}};
    for (int i = 0; i < bins * bins; i++) h.count.push_back(std::log(0.05 + lp_random(&random)));
    return h;
}

// The best path, found by trying all of them.
double best_by_force(const JointHistogram &h, bool above, int b1, int from) {
    if (b1 == h.bins) return from == h.bins - 1 ? 0.0 : -1e300;
    double best = -1e300;
    for (int b2 = b1 == 0 ? 0 : from; b2 < (b1 == 0 ? 1 : h.bins); b2++)
        if (above ? b2 >= b1 : b2 <= b1) best = std::max(best, h.at(b1, b2) + best_by_force(h, above, b1 + 1, b2));
    return best;
}

void assert_keeps_constraints(const TransferPath &path, int bins) {
    assert_int_equal(path.to.size(), bins);
    assert_int_equal(path.to.front(), 0);
    assert_int_equal(path.to.back(), bins - 1);
    bool above = true, below = true;
    for (int b = 0; b < bins; b++) {
        int to = path.to[static_cast<size_t>(b)];
        if (b) assert_true(to >= path.to[static_cast<size_t>(b - 1)]);
        above = above && to >= b, below = below && to <= b;
    }
    assert_true(above || below);
}

void test_finds_the_best_of_all_paths(void **) {
    uint64_t random = 7;
    for (int bins : {2, 3, 5, 6, 7})
        for (int run = 0; run < 20; run++) {
            JointHistogram h = random_histogram(bins, random);
            TransferPath path = most_likely_path(h);
            assert_keeps_constraints(path, bins);
            double sum = 0.0, best = std::max(best_by_force(h, true, 0, 0), best_by_force(h, false, 0, 0));
            for (int b = 0; b < bins; b++) sum += h.at(b, path.to[static_cast<size_t>(b)]);
            assert_close(sum, best, 1e-12);
            assert_close(path.log_likelihood, best, 1e-12);
        }
}

void test_keeps_its_constraints_on_anything(void **) {
    uint64_t random = 8;
    for (int bins : {64, 128, 256}) {
        std::vector<LevelPair> pairs;
        for (int i = 0; i < 3000; i++) pairs.push_back({255.0 * lp_random(&random), 255.0 * lp_random(&random)});
        assert_keeps_constraints(most_likely_path(log_likelihood(joint_histogram(pairs, bins), 1.5)), bins);
        pairs.clear();  // no pairs
        assert_keeps_constraints(most_likely_path(log_likelihood(joint_histogram(pairs, bins), 1.5)), bins);
    }
}

// A known transfer function with noise and as many outliers as inliers; both directions are inverses of each other.
void test_finds_a_transfer_function_among_outliers(void **) {
    auto transfer = [](double b) { return 255.0 * std::pow(b / 255.0, 0.7); };
    uint64_t random = 9;
    std::vector<LevelPair> pairs;
    for (int i = 0; i < 20000; i++) {
        double b = 255.0 * lp_random(&random);
        pairs.push_back({b + lp_normal(&random), transfer(b) + lp_normal(&random)});
        pairs.push_back({255.0 * lp_random(&random), 255.0 * lp_random(&random)});
    }
    JointHistogram likelihood = log_likelihood(joint_histogram(pairs, 256), 1.5);
    TransferPath forward = most_likely_path(likelihood), backward = most_likely_path(transposed(likelihood));
    for (int b = 12; b < 244; b++) {
        assert_close(forward.to[static_cast<size_t>(b)], transfer(b), 3.0);
        assert_close(transfer(backward.to[static_cast<size_t>(b)]), b, 3.5);
    }
}

// Counts go to the nearest bin. The Gaussian preserves their sum and is the product of two one-dimensional ones.
void test_smoothing(void **) {
    std::vector<LevelPair> pairs{{100.2, 50.4}, {99.6, 49.6}};
    JointHistogram h = joint_histogram(pairs, 256);
    assert_close(h.at(100, 50), 2.0, 0.0);
    JointHistogram smooth = log_likelihood(h, 1.5);
    double floor = 2.0 / (256.0 * 256.0), sum = 0.0;
    for (double value : smooth.count) sum += std::exp(value) - floor;
    assert_close(sum, 2.0, 1e-9);
    auto at = [&](int b1, int b2) { return std::exp(smooth.at(b1, b2)) - floor; };
    assert_close(at(101, 51) * at(100, 50), at(101, 50) * at(100, 51), 1e-12);
    assert_close(at(101, 50) / at(100, 50), std::exp(-0.5 / 2.25), 1e-9);
    assert_close(at(120, 50), 0.0, 1e-15);
    assert_close(smooth.at(200, 200), std::log(floor), 1e-12);  // P0, beyond the reach of the Gaussian
}

void test_coarse_bins_reach_both_ends(void **) {
    JointHistogram h = joint_histogram({{0.0, 0.0}, {255.0, 255.0}, {2.1, 252.0}}, 64);
    assert_close(h.at(0, 0), 1.0, 0.0);
    assert_close(h.at(63, 63), 1.0, 0.0);
    assert_close(h.at(1, 62), 1.0, 0.0);
    assert_close(h.level(63), 255.0, 1e-12);
    assert_close(h.bin(h.level(17.25)), 17.25, 1e-12);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finds_the_best_of_all_paths),
        cmocka_unit_test(test_keeps_its_constraints_on_anything),
        cmocka_unit_test(test_finds_a_transfer_function_among_outliers),
        cmocka_unit_test(test_smoothing),
        cmocka_unit_test(test_coarse_bins_reach_both_ends),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
