// lensprof bracket: accuracy of the results for every kind of picture and every kind of known exposures.
#include "bracket_runs.hpp"

using namespace bracket_runs;

namespace {

void test_unknown_exposures(void **) {
    const Json json = json_of(bracket(shots(five)));
    assert_recovered(json, five, 1.5);
    assert_string_equal(json["gamma_from"].get<std::string>().c_str(), "prior");
}

void test_exposures_of_exif(void **) {
    const Words files = shots(five);
    for (size_t i = 0; i < files.size(); ++i) state_exposure(files[i], five[i] - 5.0);
    const Json json = json_of(bracket(files));
    assert_close(assert_recovered(json, five, 1.5), 1.0, 0.03);
    assert_string_equal(json["gamma_from"].get<std::string>().c_str(), "exif");
    const Json without = json_of(bracket(files, no_store + Words{"--fit", "exif-sigma=0"}));
    assert_string_equal(without["gamma_from"].get<std::string>().c_str(), "prior");
}

void test_white_balance_that_is_free_or_not(void **) {
    const Words files = shots(three);
    const Json fixed = json_of(bracket(files, no_store + Words{"--fit", "white-balance=fixed"}));
    const Json free = json_of(bracket(files, no_store + Words{"--fit", "white-balance=free"}));
    for (size_t i = 0; i < 3; ++i)
        for (size_t c = 0; c < 3; ++c) {
            assert_close(fixed["images"][i]["white_balance"][c].get<double>(), 1.0, 0.0);
            assert_close(free["images"][i]["white_balance"][c].get<double>(), 1.0, 0.02);
        }
}

void test_kinds_of_pictures(void **) {
    for (uint32_t layout : {LENSPROF_LAYOUT_GREY, LENSPROF_LAYOUT_RGB})
        for (uint32_t sample : {LENSPROF_SAMPLE_U8, LENSPROF_SAMPLE_U16}) {
            Shot like;
            like.layout = layout, like.sample = sample;
            const Json json = json_of(bracket(shots(five, like), no_store + Words{"--ev", list_of(five)}));
            assert_recovered(json, five, 1.5);
        }
}

// A linear camera, which the prior does not expect, and one whose curve a few modes cannot represent.
void test_other_responses(void **) {
    Shot like;
    like.response = [](double x) { return x; };
    like.sample = LENSPROF_SAMPLE_U16, like.noise = 0.3;
    assert_recovered(json_of(bracket(shots(five, like), no_store + Words{"--ev", list_of(five)})), five, 1.0,
                     like.response);
    const auto kink = [](double x) { return x < 0.5 ? 0.9 * srgb(x) / srgb(0.5) : 0.9 + 0.2 * (x - 0.5); };
    like.response = kink;
    const Json refined = json_of(bracket(shots(five, like), no_store + Words{"--ev", list_of(five)}));
    assert_recovered(refined, five, 1.5, kink);
    assert_string_equal(refined["response"]["kind"].get<std::string>().c_str(), "table");
    const Json modes =
        json_of(bracket(shots(five, like), no_store + Words{"--ev", list_of(five), "--fit", "modes-only=yes"}));
    assert_string_equal(modes["response"]["kind"].get<std::string>().c_str(), "emor");
    assert_true(heldout(refined) < heldout(modes));
}

// The camera changed its sensitivity, which the metadata do not show.
void test_wrong_metadata_is_said(void **) {
    for (double wrong : {0.6, -1.0})
        for (size_t count : {5u, 7u}) {
            std::vector<double> truth, stated;
            for (size_t i = 0; i < count; ++i) truth.push_back(3.0 - 6.0 * double(i) / double(count - 1));
            stated = truth;
            const size_t which = count == 5 ? 1 : 4;
            stated[which] += wrong;
            const Words files = shots(truth);
            const Json json = json_of(bracket(files, no_store + Words{"--ev", list_of(stated)}));
            const std::string reason = text_of(json);
            if (!contains(reason, files[which]) || !contains(reason, std::to_string(std::fabs(wrong)).substr(0, 3)))
                fail_msg("%zu pictures, %.1f EV: %s", count, wrong, reason.c_str());
            assert_string_equal(code_of(json).c_str(), "known_wrong");
            assert_true(json["findings"][0]["item"]["file"] == files[which]
                        && json["findings"][0]["item"]["index"] == which);
            assert_close(assert_recovered(json, truth, 1.5), 1.0, 0.05);
        }
}

// A step, a wrong exposure at the end, the wrong order: faults other than one exposure in the middle.
void test_other_wrong_metadata(void **) {
    struct Case {
        std::vector<double> truth, stated;
        size_t named;  // a picture in the reason, or `none`
        const char *word;
    };
    constexpr size_t none = 99;
    const Case cases[] = {
        {{-3.0, -1.0, 1.0, 3.0}, {-3.0, -1.0, 1.6, 3.0}, none, "known"},
        {{-3.0, -1.5, 0.0, 2.3, 3.8}, {-3.0, -1.5, 0.0, 1.5, 3.0}, 3, "0.8 EV lower"},
        {{-3.0, -1.5, 0.0, 1.5, 3.0}, {-3.0, -1.5, 0.0, 1.5, 3.8}, none, "known"},
        {{-3, -2, -1, 0, 1, 2, 3}, {-3, -2, -1, -0.4, 0, 0.4, 1}, none, "known exposures contradict"},
        {{-2.0, 0.0, 2.0}, {-2.0, 0.0, 2.8}, none, "known exposures contradict"},
        {{-2.0, 0.0, 2.0}, {2.0, 0.0, -2.0}, none, "check their order"},
        {{-2.0, 0.0, 2.0}, {0.0, 0.0, 0.0}, none, "do not match"},
    };
    for (const Case &one : cases)
        for (const char *method : {"transfer", "radiance", "transfer-function"}) {
            const Words files = shots(one.truth);
            const Words words = bracket(files, no_store
                                                   + Words{"--fit", std::string("method=") + method, "--fit",
                                                           "ev-sigma=0.1", "--ev", list_of(one.stated)});
            const std::string reason = text_of(json_of(words));
            if (!contains(reason, one.word) || (one.named != none && !contains(reason, files[one.named])))
                fail_msg("%s of %s: %s", method, list_of(one.stated).c_str(), reason.c_str());
        }
}

// For any response, known exposures determine gamma, and the result matches them. Modes alone cannot always do so; then
// a reason reports it.
void test_known_exposures_hold_gamma(void **) {
    const auto tone = [](double x) {
        double y = srgb(x);
        return y + 0.6 * y * (1.0 - y) * (y - 0.35);
    };
    const auto root = [](double x) { return std::sqrt(x); };
    const auto line = [](double x) { return x; };
    const std::vector<double> evs = {-3.0, -1.5, 0.0, 1.5, 3.0};
    for (const std::function<double(double)> &response : {std::function<double(double)>(tone), {root}, {line}}) {
        Shot like;
        like.response = response;
        const Words files = shots(evs, like);
        for (const char *method : {"transfer", "radiance", "transfer-function"}) {
            const Json json = json_of(
                bracket(files, no_store + Words{"--fit", std::string("method=") + method, "--ev", list_of(evs)}));
            for (size_t i = 0; i < evs.size(); ++i) {
                const double off = std::fabs(found_ev(json, i) - found_ev(json, 0) - (evs[i] - evs[0]));
                const double sigma = json["images"][i]["ev_sigma"].get<double>();
                if (off > 3.0 * sigma + 1e-3)
                    fail_msg("%s: picture %zu is %.3f EV off, stated %.3f", method, i, off, sigma);
            }
        }
        const Json modes = json_of(bracket(files, no_store + Words{"--fit", "modes-only=yes", "--ev", list_of(evs)}));
        if (std::fabs(found_ev(modes, 4) - found_ev(modes, 0) - 6.0) > 0.6)
            assert_true(contains(text_of(modes), "modes of the response do not allow"));
    }
}

// Two of three always agree: the wrong exposure cannot be identified, and the stated error is large.
void test_exposures_of_three_pictures_contradict(void **) {
    const Words files = shots(three);
    for (const char *stated : {"2,0.6,-2", "2,-0.8,-2", "3,0,-2", "2.6,0,-2", "2,0,-1.2", "2,0,-2.8"}) {
        const Json json = json_of(bracket(files, no_store + Words{"--ev", stated}));
        const std::string reason = text_of(json);
        if (!contains(reason, "exposures contradict each other")) fail_msg("--ev %s: %s", stated, reason.c_str());
        assert_true(json["gamma"]["sigma"].get<double>() > 0.05);
        for (size_t i = 1; i < 3; ++i)
            assert_true(std::fabs(found_ev(json, i) - (three[i] - three[0]))
                        < 3.0 * json["images"][i]["ev_sigma"].get<double>());
    }
    const Json right = json_of(bracket(files, no_store + Words{"--ev", "2,0.05,-2"}));
    assert_string_equal(text_of(right).c_str(), "");
}

// Local changes from picture to picture: light, or tone mapping.
void test_changed_light_is_refused(void **) {
    Shot like;
    like.waves_ev = 0.4;
    const Json json = json_of(bracket(shots(five, like)), not_usable);
    const std::string reason = text_of(json);
    if (!contains(reason, "light changed") || contains(reason, "free them")) fail_msg("%s", reason.c_str());
}

// Pictures of one exposure show no response, whatever the method, and whatever exposures are stated for them.
void test_one_exposure_is_refused(void **) {
    const Words files = shots({0.0, 0.02, -0.02});
    for (const char *method : {"transfer", "radiance", "transfer-function"}) {
        const Json json =
            json_of(bracket(files, no_store + Words{"--fit", std::string("method=") + method}), not_usable);
        assert_string_equal(code_of(json).c_str(), "exposures_equal");
    }
    must_exit(not_usable, bracket(files, no_store + Words{"--ev", "0,2,-2"}));
}

// Scanned film: its black is grey, and dark pictures contain almost nothing else.
void test_black_that_is_not_0(void **) {
    const auto film = [](double x) { return (16.0 + 239.0 * std::pow(x, 0.6)) / 255.0; };
    Shot like;
    like.response = [&](double x) { return std::max(film(x), 20.0 / 255.0); };
    const std::vector<double> evs = {3.0, 1.5, 0.0, -1.5, -3.0, -12.0};
    const Words files = shots(evs, like);
    const Outcome outcome =
        run_words(bracket(files, no_store + Words{"--fit", "ignore-below=24", "--ev", list_of(evs)}));
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, files[5]) && contains(outcome.err, "left out"));
    const Json json = parsed(outcome.out);
    double worst;
    assert_close(slope(json, five, worst), 1.0, 0.05);
    assert_true(worst < 0.05);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_unknown_exposures),
        CLI_TEST(test_exposures_of_exif),
        CLI_TEST(test_white_balance_that_is_free_or_not),
        CLI_TEST(test_kinds_of_pictures),
        CLI_TEST(test_other_responses),
        CLI_TEST(test_wrong_metadata_is_said),
        CLI_TEST(test_other_wrong_metadata),
        CLI_TEST(test_known_exposures_hold_gamma),
        CLI_TEST(test_exposures_of_three_pictures_contradict),
        CLI_TEST(test_changed_light_is_refused),
        CLI_TEST(test_one_exposure_is_refused),
        CLI_TEST(test_black_that_is_not_0),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
