// Correspondences at matches, for pictures of a moving camera, which no cameras of a project describe.
#include <algorithm>
#include <cmath>
#include <set>

#include "sampled_pictures.hpp"

namespace {

constexpr uint32_t kWidth = 320, kHeight = 240;

// Pictures whose upper and lower halves moved by different amounts, as by parallax.
struct Moved : Pictures {
    explicit Moved(uint32_t count) : Pictures(count, kWidth, kHeight, 0.0) {
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t v = 0; v < kHeight; v++)
                for (uint32_t u = 0; u < kWidth; u++)
                    for (int c = 0; c < 3; c++)
                        data[i][(size_t{v} * kWidth + u) * 3 + static_cast<uint32_t>(c)] =
                            static_cast<float>(layers(u + shift(i, v), v, c));
    }

    static double shift(uint32_t image, double y) { return image * (y < kHeight / 2 ? 70.0 : 20.0); }
    static double layers(double x, double y, int c) {
        const double at = 0.02 * x, down = 0.02 * y + (y < kHeight / 2 ? 0.0 : 7.0);
        return 0.45 + 0.15 * std::sin(0.9 * at + c) + 0.1 * std::cos(1.1 * down + at)
               + 0.12 * std::sin(9 * at) * std::cos(8 * down);
    }

    // Every 8 px within both images.
    std::vector<lensprof_match> matches(bool with_map, double off = 0.0) const {
        std::vector<lensprof_match> list;
        for (uint32_t i = 0; i + 1 < images.size(); i++)
            for (double y = 8; y < kHeight - 8; y += 8)
                for (double x = 8; x < kWidth - 8; x += 8) {
                    const double there = x + shift(i, y) - shift(i + 1, y) + off;
                    if (there < 8 || std::abs(y - kHeight / 2) < 24) continue;
                    lensprof_match match{{i, i + 1}, {{x, y}, {there, y}}, {}};
                    if (with_map) match.map[0][0] = match.map[1][1] = 1.0;
                    list.push_back(match);
                }
        return list;
    }

    lensprof_status sample(const std::vector<lensprof_match> &matches, std::vector<lensprof_pair> &pairs,
                           lensprof_sample_options options, lensprof_error *error = nullptr) const {
        uint32_t found = 0;
        const auto count = static_cast<uint32_t>(images.size()), given = static_cast<uint32_t>(matches.size());
        lensprof_status status =
            lensprof_sample_matches(&options, images.data(), count, matches.data(), given, nullptr, 0, &found, error);
        if (status != LENSPROF_OK) return status;
        pairs.assign(found, lensprof_pair{});
        status = lensprof_sample_matches(&options, images.data(), count, matches.data(), given, pairs.data(), found,
                                         &found, error);
        pairs.resize(status == LENSPROF_OK ? found : 0);
        return status;
    }
};

// The index of each pair's match: same images, and within the search distance for places of lower gradient.
void test_matches_of_pairs(void **) {
    const Moved pictures(3);
    const auto matches = pictures.matches(true);
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 600);
    std::vector<uint32_t> match_of_pair(600, UINT32_MAX);
    options.match_of_pair = match_of_pair.data();
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(matches, pairs, options));
    for (size_t p = 0; p < pairs.size(); p++) {
        assert_true(match_of_pair[p] < matches.size());
        const lensprof_match &match = matches[match_of_pair[p]];
        for (int side = 0; side < 2; side++) assert_int_equal(match.image[side], pairs[p].image[side]);
        for (int d = 0; d < 2; d++) assert_true(std::fabs(match.xy[0][d] - pairs[p].xy[0][d]) <= 8.0);
    }
}

void test_pairs_show_one_scene_point(void **) {
    const Moved pictures(3);
    for (const bool with_map : {true, false}) {
        std::vector<lensprof_pair> pairs;
        assert_ok(pictures.sample(pictures.matches(with_map), pairs, options_of(LENSPROF_SAMPLING_BALANCED, 600)));
        assert_true(pairs.size() > 500 && pairs.size() <= 600);
        std::set<uint32_t> first;
        for (const auto &pair : pairs) {
            first.insert(pair.image[0]);
            assert_int_equal(pair.image[1], pair.image[0] + 1);
            double at[2];  // in the scene
            for (int side = 0; side < 2; side++) {
                const double *xy = pair.xy[side];
                at[side] = xy[0] + Moved::shift(pair.image[side], xy[1]);
                for (int c = 0; c < 3; c++) assert_close(pair.value[side][c], Moved::layers(at[side], xy[1], c), 0.01);
            }
            assert_close(at[0], at[1], 1e-9);
            assert_close(pair.xy[0][1], pair.xy[1][1], 1e-9);
        }
        assert_int_equal(first.size(), 2);
    }
}

// With a map of the surroundings, pairs come from places of lower gradient near the matches.
void test_the_flattest_place_near_a_match(void **) {
    const Moved pictures(2);
    double step[2] = {};
    for (const bool with_map : {false, true}) {
        std::vector<lensprof_pair> pairs;
        assert_ok(pictures.sample(pictures.matches(with_map), pairs, options_of(LENSPROF_SAMPLING_BALANCED, 4000)));
        for (const auto &pair : pairs) {
            const double x = pair.xy[0][0] + Moved::shift(pair.image[0], pair.xy[0][1]), y = pair.xy[0][1];
            step[with_map] += std::abs(Moved::layers(x + 1, y, 0) - Moved::layers(x - 1, y, 0)) / double(pairs.size());
        }
    }
    assert_true(step[1] < 0.8 * step[0]);
}

// Wrong matches give no pairs if their surroundings disagree, and their link is contradicted.
void test_wrong_matches_are_found(void **) {
    const Moved pictures(2);
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 600);
    lensprof_link link{};
    uint32_t links = 0;
    options.links = &link, options.link_capacity = 1, options.link_count = &links;
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(pictures.matches(true), pairs, options));
    assert_int_equal(links, 1);
    assert_int_equal(link.state, LENSPROF_LINK_VERIFIED);
    assert_int_equal(link.pairs, pairs.size());
    lensprof_error error{};
    assert_int_equal(pictures.sample(pictures.matches(true, 9.0), pairs, options, &error), LENSPROF_ERROR_NO_SAMPLES);
}

void test_the_same_on_any_number_of_threads(void **) {
    const Moved pictures(3);
    std::vector<lensprof_pair> one, four;
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 300);
    options.threads = 1;
    assert_ok(pictures.sample(pictures.matches(true), one, options));
    options.threads = 4;
    assert_ok(pictures.sample(pictures.matches(true), four, options));
    assert_int_equal(one.size(), four.size());
    assert_memory_equal(one.data(), four.data(), one.size() * sizeof one[0]);
}

// The cameras need not be valid; only their width and height are used.
void test_no_camera_is_needed(void **) {
    Moved pictures(2);
    for (auto &image : pictures.images) image.camera.hfov_deg = 0.0;
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(pictures.matches(true), pairs, options_of(LENSPROF_SAMPLING_BALANCED, 300)));
    assert_true(pairs.size() > 200);
}

void test_what_is_refused(void **) {
    const Moved pictures(2);
    const lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 300);
    std::vector<lensprof_pair> pairs;
    const auto refused = [&](auto change, const char *text) {
        std::vector<lensprof_match> matches = pictures.matches(true);
        change(matches[5]);
        lensprof_error error{};
        assert_int_equal(pictures.sample(matches, pairs, options, &error), LENSPROF_ERROR_ARGUMENT);
        assert_int_equal(error.item.kind, LENSPROF_ITEM_MATCH);
        assert_int_equal(error.item.index, 5);
        assert_non_null(std::strstr(error.text, text));
    };
    refused([](lensprof_match &m) { m.image[1] = 0; }, "match 5: image");
    refused([](lensprof_match &m) { m.image[1] = 2; }, "match 5: image");
    refused([](lensprof_match &m) { m.xy[0][0] = kWidth + 1.0; }, "outside its image");
    refused([](lensprof_match &m) { m.xy[1][1] = NAN; }, "outside its image");
    refused([](lensprof_match &m) { m.map[0][0] = NAN; }, "map");
    refused([](lensprof_match &m) { m.map[0][0] = -1.0; }, "map");
    refused([](lensprof_match &m) { m.map[0][0] = 0.0; }, "map");
    lensprof_error error{};
    assert_int_equal(pictures.sample(pictures.matches(true), pairs, options_of(LENSPROF_SAMPLING_PAPER, 300), &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_non_null(std::strstr(error.text, "paper"));
    assert_int_equal(pictures.sample({}, pairs, options, &error), LENSPROF_ERROR_NO_OVERLAP);
    uint32_t found = 0;
    assert_int_equal(
        lensprof_sample_matches(&options, pictures.images.data(), 2, nullptr, 3, nullptr, 0, &found, &error),
        LENSPROF_ERROR_ARGUMENT);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_matches_of_pairs),
        cmocka_unit_test(test_pairs_show_one_scene_point),
        cmocka_unit_test(test_the_flattest_place_near_a_match),
        cmocka_unit_test(test_wrong_matches_are_found),
        cmocka_unit_test(test_the_same_on_any_number_of_threads),
        cmocka_unit_test(test_no_camera_is_needed),
        cmocka_unit_test(test_what_is_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
