// The two verdicts of a fit, and pictures that do not agree with the others.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

void simulate(const std::string &name, const Words &more) {
    render(name, Words{"--size", "400x300", "--images", "6"} + more);
}

std::string pto(const std::string &name) { return work(name + "/pano.pto"); }

// Replaces img005 by a picture of another scene.
void spoil(const std::string &name) {
    simulate(name, {"--seed", "3"});
    simulate(name + "-other", {"--seed", "99"});
    fs::copy_file(work(name + "-other/img001.png"), work(name + "/img005.png"), fs::copy_options::overwrite_existing);
}

void test_one_bad_picture_of_six(void **) {
    spoil("bad");
    const std::string result = work("bad/result.pto"), even = work("even"), db = work("bad.db");
    const Outcome found =
        run_words({"build", pto("bad"), "--db", db, "--json", "--write", std::string("pto=") + result});
    assert_int_equal(found.code, done);
    assert_true(contains(found.err, "img005.png: left out: it disagrees with the others"));
    const Json json = parsed(found.out);
    assert_true(json["usable"] == true && json["equalizes"] == true);
    for (size_t i = 0; i < 6; i++) {
        const Json &image = json["images"][i];
        assert_true(image["joined"] == (i != 5));
        assert_true(image["ev"].is_null() == (i == 5) && image["white_balance"].is_null() == (i == 5));
    }
    for (const Json &link : json["links"]) {
        const bool is_bad = link["images"][1] == 5;
        if (is_bad) assert_true(link["state"] != "verified");
        if (link["pairs"].get<int>() > 100) assert_true(link["state"] == "verified");
    }
    // As text: the picture has no exposure.
    const std::string text = must_exit(done, {"build", pto("bad"), "--no-store", "--fit", "stored=none"});
    assert_true(contains(text, "img005.png  left out") && contains(text, "\nlinks     4 verified, 1 contradicted\n"));
    // The other pictures are equalised, this one stays unchanged.
    assert_true(contains(text_of(result), "\n#-lensprof left_out 5\n"));
    const Outcome corrected = run_words({"apply", "--pto", result, "-o", even});
    assert_int_equal(corrected.code, done);
    assert_true(contains(corrected.err, "img005.png: not corrected: the project has no exposure for it"));
    assert_true(fs::exists(even + "/img003.png") && !fs::exists(even + "/img005.png"));
    const Json alone = json_of({"apply", "--pto", result, "-o", even, "--json", work("bad/img005.png")}, not_usable);
    assert_int_equal(alone["pictures"].size(), 0);
    assert_int_equal(alone["left_out"].size(), 1);
}

// The project has the last picture elsewhere: it overlaps none.
void test_one_picture_apart(void **) {
    simulate("apart", {"--seed", "3"});
    edit(pto("apart"), " y[-0-9.]+( .*img005.png)", " y180$1");
    const Outcome found = run_words({"build", pto("apart"), "--no-store", "--json"});
    assert_int_equal(found.code, done);
    assert_true(contains(found.err, "img005.png: left out: no pair connects it to the others"));
    const Json json = parsed(found.out);
    assert_true(json["images"][4]["joined"] == true && json["images"][5]["joined"] == false);
    assert_true(code_of(json) == "images_unconnected");
}

// The reference of the project is the bad one.
void test_the_reference_can_be_the_bad_one(void **) {
    spoil("first");
    const Outcome found = run_words(
        {"build", pto("first"), "--no-store", "--fit", "stored=none", "--json", "--fit", "reference=img005.png"});
    assert_int_equal(found.code, done);
    const Json json = parsed(found.out);
    const auto reference = json["reference"].get<size_t>();
    assert_true(reference != 5);
    assert_close(json["images"][reference]["ev"].get<double>(), 0.0, 0.0);
}

// Local tone mapping that does not belong to the camera but allows a correction: nothing is stored, the pictures can be
// corrected.
void test_even_pictures_that_are_no_profile(void **) {
    simulate("tone", {"--set", "local-tone=0.6"});
    const std::string db = work("tone.db"), result = work("tone/result.pto");
    const Json json = json_of({"build", pto("tone"), "--no-store", "--json"});
    assert_true(json["usable"] == false && json["equalizes"] == true && code_of(json) == "patterns");
    const Outcome told = run_words({"build", pto("tone"), "--no-store", "--write", std::string("pto=") + result});
    assert_int_equal(told.code, done);
    assert_true(contains(told.err, "corrects these pictures, but is not stored as a profile"));
    assert_true(contains(told.out, "CORRECTS"));
    assert_true(fs::exists(result));
    const Outcome stored = run_words({"build", pto("tone"), "--db", db});
    assert_int_equal(stored.code, not_usable);
    assert_true(contains(stored.err, "nothing was stored") && !fs::exists(db));
}

void test_noise_is_neither(void **) {
    simulate("noise", {"--set", "noise=100"});
    const Outcome found = run_words({"build", pto("noise"), "--no-store", "--json"});
    assert_int_equal(found.code, not_usable);
    const Json json = parsed(found.out);
    assert_true(json["usable"] == false && json["equalizes"] == false);
}

// One exposure, and a falloff corrected by the camera: the response is typical of the kind of camera, and a reason
// reports it.
void test_pictures_that_show_no_response(void **) {
    simulate("flat", {"--set", "ev=0,wb=0", "--vignetting=-.04,0,0"});
    const Json json = json_of({"build", pto("flat"), "--no-store", "--json"});
    assert_true(json["usable"] == true && json["equalizes"] == true);
    assert_true(code_of(json) == "response_unconstrained" && json["response"]["from"] == "kind");
    assert_true(json["response"]["irradiance_spread_ev"].get<double>() < 0.06);
    assert_close(json["gamma"]["sigma"].get<double>(), 0.264, 0.001);
    const Json other = json_of({"build", pto("flat"), "--no-store", "--json", "--fit", "seed=7"});
    assert_true(other["response"]["values"] == json["response"]["values"]);  // independent of noise
    simulate("equal", {"--set", "ev=0,wb=0", "--vignetting", "0,0,0"});      // nothing to correct
    const Json equal = json_of({"build", pto("equal"), "--no-store", "--json"}, not_usable);
    assert_true(code_of(equal) == "nothing_better" && equal["model"] == "nothing");
    simulate("shown", {});
    assert_true(json_of({"build", pto("shown"), "--no-store", "--json"})["response"]["from"] == "pictures");
}

// The falloff of such pictures is still known: it is stored and found for its setting. The response is not a prior of
// the next fit.
void test_a_falloff_without_a_response_is_found(void **) {
    const Words dim{"--set", "ev=0,wb=0", "--vignetting=-.06,0,0"};
    const Words setting{"--db", work("even.db"), "--camera", "B", "--lens", "C", "--focal", "30", "--aperture", "4"};
    simulate("even", dim);
    must_exit(done, Words{"build", pto("even")} + setting);
    must_exit(done, Words{"query"} + setting);
    simulate("next", dim + Words{"--seed", "77"});
    const Json next = json_of(Words{"build", pto("next"), "--json", "--no-store"} + setting);
    assert_true(next["response"]["from"] == "kind");
    assert_close(next["gamma"]["sigma"].get<double>(),
                 json_of({"build", pto("next"), "--json", "--no-store", "--fit", "stored=none", "--camera",
                          "B"})["gamma"]["sigma"]
                     .get<double>(),
                 0.002);
}

// No parameter of the lens is requested, so the profile would be empty.
void test_nothing_to_store(void **) {
    simulate("nothing", {});
    const Outcome refused = run_words({"build", pto("nothing"), "--fit", "free=ev,wb", "--db", work("nothing.db")});
    assert_int_equal(refused.code, usage);
    assert_true(contains(refused.err, "give --no-store, or --fit free=all"));
    assert_false(fs::exists(work("nothing.db")));
}

// A sky with a few wires, with a project that is off by some pixels, is joined.
void test_smooth_pictures_join(void **) {
    simulate("sky", {"--scene", "sky", "--set", "misalign=4", "--response", "srgb"});
    const Json json = json_of({"build", pto("sky"), "--no-store", "--json"});
    for (const Json &image : json["images"]) assert_true(image["joined"] == true);
    assert_true(json["equalizes"] == true);
    for (const Json &link : json["links"]) assert_true(link["state"] != "contradicted");
}

// Frames of a stationary camera with one exposure already match; a bracket of them shows nothing.
void test_frames_of_one_exposure(void **) {
    simulate("still", {});
    fs::copy_file(work("still/img000.png"), work("still/copy.png"));
    const Words frames = {work("still/img000.png"), work("still/copy.png")};
    must_exit(done, Words{"align", "-o", work("aligned")} + frames);
    assert_refused(not_usable, Words{"bracket", "--no-store"} + frames, {"0.00 EV"});
}

// The light found by a first fit joins the picture that was left out: exposures are true except for gamma, which is
// open.
void test_a_second_look_joins(void **) {
    must_exit(done, {"simulate", "-o", work("far"), "--size", "480x360", "--images", "4", "--scene", "foliage", "--set",
                     "ev=5,overlap=0.35,noise=1", "--seed", "3"});
    const Json json = json_of({"build", pto("far"), "--no-store", "--fit", "stored=none,free=all", "--json"});
    assert_int_equal(json["looks"], 2);
    const Json truth = parsed(text_of(work("far/truth.json")))["images"];
    const auto true_ev = [&](size_t i) { return truth[i]["ev"].get<double>() - truth[0]["ev"].get<double>(); };
    const double exponent = json["images"][1]["ev"].get<double>() / true_ev(1);
    for (size_t i = 1; i < 4; i++) {
        assert_true(json["images"][i]["joined"] == true);
        assert_true(std::abs(json["images"][i]["ev"].get<double>() / exponent - true_ev(i)) < 0.03);
    }
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        CLI_TEST(test_one_bad_picture_of_six),
        CLI_TEST(test_one_picture_apart),
        CLI_TEST(test_the_reference_can_be_the_bad_one),
        CLI_TEST(test_even_pictures_that_are_no_profile),
        CLI_TEST(test_noise_is_neither),
        CLI_TEST(test_pictures_that_show_no_response),
        CLI_TEST(test_a_falloff_without_a_response_is_found),
        CLI_TEST(test_nothing_to_store),
        CLI_TEST(test_smooth_pictures_join),
        CLI_TEST(test_frames_of_one_exposure),
        CLI_TEST(test_a_second_look_joins),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
