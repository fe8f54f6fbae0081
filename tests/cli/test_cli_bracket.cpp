// lensprof bracket: output, stored profiles, and refused input.
#include "bracket_runs.hpp"

using namespace bracket_runs;

namespace {

void test_known_exposures(void **) {
    const Words files = shots(five);
    for (const Words &known : {Words{"--ev", list_of(five)}, Words{"--times", "8,2.8284,1,0.35355,1/8"}}) {
        const Json json = json_of(bracket(files, no_store + known));
        assert_close(assert_recovered(json, five, 1.5), 1.0, 0.02);
        assert_string_equal(json["gamma_from"].get<std::string>().c_str(), "exif");
        assert_string_equal(text_of(json).c_str(), "");
    }
}

void test_object(void **) {
    const Words files = shots(three);
    const Json json = json_of(bracket(files, no_store + Words{"--ev", "2,0,-2"}));
    for (const char *field : {"usable", "findings", "reference", "images", "response", "gamma", "gamma_from", "profile",
                              "pairs", "components", "covariance", "coverage", "seconds", "residual", "iterations"})
        if (!json.contains(field)) fail_msg("no %s", field);
    assert_false(json.contains("vignetting"));
    assert_true(json["profile"].is_null());
    assert_int_equal(json["images"].size(), 3);
    for (size_t i = 0; i < 3; ++i) {
        assert_string_equal(json["images"][i]["file"].get<std::string>().c_str(), files[i].c_str());
        for (const char *field : {"ev", "ev_sigma", "white_balance", "median_residual", "known_ev_residual", "pairs"})
            assert_true(json["images"][i].contains(field));
    }
    const Outcome words = run_words({"bracket", files[0], files[1], files[2], "--no-store", "--fit", "pairs=4000"});
    assert_int_equal(words.code, done);
    assert_true(contains(words.out, "response "));
    assert_false(contains(words.out, "falloff"));
}

void test_reference(void **) {
    const Words files = shots(three);
    const Words known = no_store + Words{"--ev", "2,0,-2"};
    const Json first = json_of(bracket(files, known));
    for (const std::string &word : {std::string("2"), files[2]}) {
        const Json json = json_of(bracket(files, known + Words{"--fit", std::string("reference=") + word}));
        assert_int_equal(json["reference"].get<int>(), 2);
        assert_close(found_ev(json, 2), 0.0, 0.0);
        assert_close(found_ev(json, 0), found_ev(first, 0) - found_ev(first, 2), 0.01);
    }
    assert_refused(usage, bracket(files, no_store + Words{"--fit", "reference=3"}), {"3"});
    assert_refused(usage, bracket(files, no_store + Words{"--fit", "reference=other.png"}), {"other.png"});
}

void test_an_overexposed_picture_is_left_out(void **) {
    const std::vector<double> evs = {2.0, 0.0, -2.0, 20.0};
    const Words files = shots(evs);
    for (const Words &known : {Words{}, Words{"--ev", "2,0,-2,20"}}) {
        const Outcome outcome = run_words(bracket(files, no_store + known));
        assert_int_equal(outcome.code, done);
        assert_true(contains(outcome.err, files[3]) && contains(outcome.err, "left out"));
        const Json json = parsed(outcome.out);
        assert_recovered(json, three, 1.5);
        assert_int_equal(json["images"].size(), 4);
        assert_int_equal(json["images"][3]["pairs"].get<int>(), 0);
        if (known.empty())
            assert_true(json["images"][3]["ev"].is_null());
        else
            assert_close(found_ev(json, 3), 18.0, 1e-9);
    }
    const Outcome odd = run_words(bracket(files, no_store + Words{"--fit", "reference=3"}));
    assert_int_equal(odd.code, not_usable);
    assert_true(contains(odd.err, files[3]) && contains(odd.out, "\"code\":\"image_groups\""));
    const Outcome words = run_words(bracket(files, {"--no-store", "--fit", "pairs=4000"}));
    assert_true(contains(words.out, "unknown"));
}

// -1 is a valid exposure.
void test_an_exposure_of_minus_one(void **) {
    const std::vector<double> evs = {0.0, -1.0, 1.0};
    const Words files = shots(evs);
    const Json json = json_of(bracket(files, no_store + Words{"--ev", "0,-1,1"}));
    assert_close(found_ev(json, 1), -1.0, 0.05);
    const Outcome text = run_words(bracket(files, {"--no-store", "--fit", "pairs=4000", "--ev", "0,-1,1"}));
    assert_true(!contains(text.out, "unknown"));
}

// A reason names files correctly, whatever their names are.
void test_names_that_look_like_numbers(void **) {
    Shot like;
    like.noise = 0.0;
    const Words files = shots({20.0, -20.0}, like);
    const Words odd = {work("image 99999999999999999999.png"), work("shot 1 image 0.png")};
    for (size_t i = 0; i < 2; ++i) fs::rename(files[i], odd[i]);
    assert_refused(not_usable, bracket(odd, no_store), {odd[0]});
}

// A forced result is marked as forced, however long the method's name is.
void test_forced(void **) {
    const Words files = shots({0.0, 0.0, 0.0});
    must_exit(not_usable, bracket(files, {"--db", work("p.db"), "--camera", "X", "--fit",
                                          "pairs=4000,method=transfer-function", "--force"}));
    const Json shown = json_of({"profile", "show", "1", "--db", work("p.db"), "--json"});
    assert_string_equal(shown["provenance"]["method"].get<std::string>().c_str(), "bracket transfer-function");
    assert_true(shown["provenance"]["forced"].get<bool>());
}

void test_profile_of_the_camera_alone(void **) {
    const Words files = shots(three);
    for (size_t i = 0; i < 3; ++i) state_exposure(files[i], three[i] - 5.0);
    const std::string db = work("p.db");
    const Json json = json_of(bracket(files, {"--db", db, "--json", "--fit", "pairs=4000"}));
    const Json stored = json_of({"profile", "show", std::to_string(json["profile"].get<int>()), "--db", db, "--json"});
    assert_string_equal(stored["key"]["camera_model"].get<std::string>().c_str(), "Camera");
    assert_string_equal(stored["key"]["lens"].get<std::string>().c_str(), "");
    for (const char *field : {"focal_mm", "aperture", "distance_m"}) assert_true(stored["key"][field].is_null());
    assert_string_equal(stored["provenance"]["method"].get<std::string>().c_str(), "bracket");
    assert_true(stored["response"]["values"] == json["response"]["values"]);
    const std::string text = must_exit(done, {"profile", "show", "1", "--db", db});
    assert_true(contains(text, "not measured"));
    assert_refused(not_found, {"profile", "show", "1", "--chart", "--db", db}, {"profile 1", "lensprof flat"});
    const Json found = json_of({"query", "--camera", "Camera", "--db", db, "--json"});
    assert_true(found["id"] == stored["id"]);
}

void test_runs_repeat(void **) {
    const Words files = shots(three);
    const auto text = [&](const Words &more) {
        return replaced(must_exit(done, bracket(files, no_store + more)), "\"seconds\":[^}]*\\}", "");
    };
    const std::string first = text({});
    assert_string_equal(first.c_str(), text({}).c_str());
    assert_true(first != text({"--fit", "seed=2"}));
}

Bytes stored_database() {
    const Words files = shots(three);
    must_exit(done, bracket(files, {"--db", work("p.db"), "--camera", "X", "--fit", "pairs=4000"}));
    return load(work("p.db"));
}

void test_refused_options(void **) {
    stored_database();
    const Words files = shots(three);
    for (const Words &wrong : {Words{"--ev", "1,2"},
                               Words{"--ev", "1,2,3,4"},
                               Words{"--ev", "1,2,three"},
                               Words{"--ev", "1,2,"},
                               Words{"--ev", "1,,2"},
                               Words{"--ev", "1,2,nan"},
                               Words{"--ev", "1,2,inf"},
                               Words{"--ev", "1,2,65"},
                               Words{"--ev", "1;2;3"},
                               Words{"--ev", "1,2,3x"},
                               Words{"--ev", "1,2,1e400"},
                               Words{"--ev", ""},
                               Words{"--times", "1,2"},
                               Words{"--times", "1,2,0"},
                               Words{"--times", "1,2,-1"},
                               Words{"--times", "1,2,1/0"},
                               Words{"--times", "1,2,1/-8"},
                               Words{"--times", "1,2,1/"},
                               Words{"--times", "1,2,1e-10"},
                               Words{"--times", ""},
                               Words{"--fit", "ev-sigma=0"},
                               Words{"--fit", "ev-sigma=nan"},
                               Words{"--fit", "max-side=10"},
                               Words{"--fit", "ignore-below=-1"},
                               Words{"--fit", "ignore-below=255"},
                               Words{"--fit", "white-balance=warm"},
                               Words{"--fit", "modes=26"},
                               Words{"--fit", "modes=x"},
                               Words{"--fit", "pairs=-1"},
                               Words{"--fit", "seed=x"},
                               Words{"--fit", "method=guess"},
                               Words{"--fit", "gamma-from=guess"},
                               Words{"--fit", "gamma-from=known"}})
        assert_refused(usage, bracket(files, Words{"--db", work("p.db"), "--camera", "X"} + wrong), {wrong[0]});
    assert_refused(usage, bracket(files, {"--ev", "1,2,3", "--times", "1,2,3", "--no-store"}), {"--ev", "--times"});
    assert_refused(usage, bracket(files, {"--db", work("p.db"), "--no-store"}), {"--db", "--no-store"});
    assert_refused(usage, bracket(files, {"--db", work("p.db")}), {files[0], "give --camera"});
    assert_refused(store_failed, bracket(files, {"--db", work("none/p.db"), "--camera", "X"}), {work("none")});
    assert_refused(usage, {"bracket"}, {"FILE"});
}

void test_refused_pictures(void **) {
    stored_database();
    const Words files = shots(three);
    const Words store = {"--db", work("p.db"), "--camera", "X"};
    assert_refused(usage, bracket({files[0]}, store), {"at least two"});
    assert_refused(usage, bracket({files[0], files[1], files[0]}, store), {files[0], "twice"});
    fs::create_symlink(files[0], work("link.png"));
    assert_refused(usage, bracket({files[0], files[1], work("link.png")}, store), {"link.png", "twice"});
    assert_refused(unreadable, bracket({files[0], work("none.png")}, store), {work("none.png")});
    assert_refused(unreadable, bracket({files[0], work("")}, store), {work("")});
    Shot small;
    small.width = 120;
    save_shot(work("small.png"), small);
    assert_refused(unreadable, bracket({files[0], work("small.png")}, store), {work("small.png"), files[0], "120"});
    Bytes half = load(files[1]);
    half.resize(half.size() / 2);
    save(work("half.png"), half);
    assert_refused(unreadable, bracket({files[0], work("half.png")}, store), {work("half.png")});
    save_text(work("text.png"), "no picture");
    assert_refused(unreadable, bracket({files[0], work("text.png")}, store), {work("text.png")});
}

// Pictures that show no response: the reason is printed, as text and in the object, and nothing is stored.
void assert_shows_nothing(const Words &files, const Words &more = {}) {
    const Words stored = Words{"--db", work("p.db"), "--camera", "X", "--fit", "pairs=4000"} + more;
    assert_refused(not_usable, bracket(files, stored), {});
    const Json json = json_of(bracket(files, stored + Words{"--json"}), not_usable);
    assert_false(json["usable"].get<bool>());
    assert_true(text_of(json).size() > 10);
    assert_int_equal(json["images"].size(), files.size());
    assert_true(json["profile"].is_null());
    assert_false(json.contains("vignetting"));
}

void test_pictures_that_show_no_response(void **) {
    stored_database();
    Shot like;
    like.noise = 0.0;
    for (double ev : {-40.0, 40.0}) assert_shows_nothing(shots({ev, ev + 1.0, ev - 1.0}, like));
    assert_shows_nothing(shots({30.0, -30.0}, like));
    assert_refused(not_usable, bracket(shots({0.0, -30.0}, like), no_store), {"entirely black or white"});
    like.noise = 1.0;
    Words files = shots(three);
    for (uint32_t i = 0; i < 3; ++i) {
        like.ev = three[i], like.scene = i;
        save_shot(files[i], like);
    }
    assert_shows_nothing(files);
    assert_shows_nothing(files, {"--ev", "2,0,-2"});
}

// Hand-held plain pictures of one view: what `build` advises works.
void test_one_view(void **) {
    must_exit(done, {"simulate", "-o", work("plain"), "--images", "2", "--set", "overlap=0.99,jitter=0,noise=1",
                     "--size", "320x240", "--set", "ev=1.5", "--seed", "1"});
    const Outcome built = run_words({"build", work("plain/pano.pto"), "--no-store"});
    assert_int_equal(built.code, not_usable);
    assert_true(contains(built.err, "use bracket or align for plain exposures (no HDR) from a tripod"));
    const Words two = {"--fit", "pairs=4000", work("plain/img000.png"), work("plain/img001.png")};
    must_exit(done, Words{"bracket", "--no-store"} + two);
    must_exit(done, Words{"align", "-o", work("plain/out")} + two);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_known_exposures),
        CLI_TEST(test_object),
        CLI_TEST(test_reference),
        CLI_TEST(test_an_overexposed_picture_is_left_out),
        CLI_TEST(test_an_exposure_of_minus_one),
        CLI_TEST(test_names_that_look_like_numbers),
        CLI_TEST(test_forced),
        CLI_TEST(test_profile_of_the_camera_alone),
        CLI_TEST(test_runs_repeat),
        CLI_TEST(test_refused_options),
        CLI_TEST(test_refused_pictures),
        CLI_TEST(test_pictures_that_show_no_response),
        CLI_TEST(test_one_view),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
