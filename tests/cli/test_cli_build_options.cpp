// What determines gamma, and the number of falloff curves: options of build on pictures with known exposures.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

// A linear camera, which no prior expects, with one falloff for all channels.
std::string linear_scene() {
    render("linear", {"--response", "linear", "--size", "320x240", "--images", "8", "--set", "ev=1.5,noise=0.5",
                      "--format", "tiff16", "--exif"});
    return work("linear");
}

Words build(const std::string &path, const Words &more) {
    return Words{"build", path + "/pano.pto", "--no-store", "--json", "--fit", "pairs=2000"} + more;
}

// Slope of recovered against true exposures: gamma.
double slope(const Json &json, const std::string &path) {
    const Json truth = parsed(text_of(path + "/truth.json"));
    const size_t count = json["images"].size();
    double mean = 0, true_mean = 0, cross = 0, square = 0;
    for (size_t i = 0; i < count; ++i) {
        mean += json["images"][i]["ev"].get<double>() / double(count);
        true_mean += truth["images"][i]["ev"].get<double>() / double(count);
    }
    for (size_t i = 0; i < count; ++i) {
        const double away = truth["images"][i]["ev"].get<double>() - true_mean;
        cross += away * (json["images"][i]["ev"].get<double>() - mean);
        square += away * away;
    }
    return cross / square;
}

void assert_gamma(const Json &json, const char *from) {
    assert_string_equal(json["gamma"]["from"].get<std::string>().c_str(), from);
    assert_string_equal(json["gamma_from"].get<std::string>().c_str(), from);
}

void test_gamma_from_exif(void **) {
    const std::string path = linear_scene();
    const Json json = json_of(build(path, {"--fit", "gamma-from=exif"}));
    assert_gamma(json, "exif");
    assert_close(slope(json, path), 1.0, 0.05);
    const double sigma = json["gamma"]["sigma"].get<double>();
    assert_true(sigma > 0.0 && sigma < 0.1);
    const Json wide = json_of(build(path, {"--fit", "gamma-from=exif,exif-sigma=0.2"}));
    assert_close(wide["gamma"]["sigma"].get<double>() / sigma, 2.0, 0.2);
}

void test_gamma_from_the_prior(void **) {
    const std::string path = linear_scene();
    const Json json = json_of(build(path, {"--fit", "gamma-from=prior"}));
    assert_gamma(json, "prior");
    assert_string_equal(json["gamma"]["camera_kind"].get<std::string>().c_str(), "any");
    assert_true(std::fabs(slope(json, path) - 1.0) > 0.05);
    // Without exposures only the prior remains.
    const Json none = json_of(build(path, {"--fit", "exif-sigma=0"}));
    assert_gamma(none, "prior");
    for (const Json &image : none["images"]) assert_close(image["known_ev_residual"].get<double>(), 0.0, 0.0);
    const Json film = json_of(build(path, {"--fit", "gamma-from=prior,camera-kind=film"}));
    assert_string_equal(film["gamma"]["camera_kind"].get<std::string>().c_str(), "film");
    assert_true(film["gamma"]["sigma"] != json["gamma"]["sigma"]);
    assert_string_equal(json["gamma"]["camera_kind_from"].get<std::string>().c_str(), "none");
    assert_string_equal(film["gamma"]["camera_kind_from"].get<std::string>().c_str(), "option");
    const Json linear = json_of(build(path, {"--fit", "camera-kind=linear"}));
    assert_gamma(linear, "known");
    assert_string_equal(linear["response"]["kind"].get<std::string>().c_str(), "linear");
    assert_close(slope(linear, path), 1.0, 0.01);
}

// The project's own response is kept, and gamma with it; here the response was found from known exposures.
void test_gamma_known(void **) {
    const std::string path = linear_scene(), pto = path + "/found.pto";
    const Json found = json_of(build(path, {"--fit", "gamma-from=exif,modes=5", "--write", std::string("pto=") + pto}));
    const Json json =
        json_of({"build", pto, "--no-store", "--json", "--fit", "pairs=2000,gamma-from=known,exif-sigma=0"});
    assert_gamma(json, "known");
    assert_close(json["gamma"]["sigma"].get<double>(), 0.0, 0.0);
    assert_close(slope(json, path), 1.0, 0.05);
    for (size_t i = 0; i < 5; ++i)
        assert_close(json["response"]["emor"][i].get<double>(), found["response"]["emor"][i].get<double>(), 1e-6);
}

void test_falloff_curves(void **) {
    const std::string path = linear_scene();
    for (const char *curves : {"auto", "1", "3"}) {
        const Json json = json_of(build(path, {"--fit", std::string("falloff-curves=") + curves}));
        assert_int_equal(json["vignetting"]["k"].size(), curves[0] == '3' ? 3 : 1);
    }
}

void test_coverage_and_errors_are_told(void **) {
    const Json json = json_of(build(linear_scene(), {}));
    for (const char *of : {"radius", "grey"}) {
        uint32_t sum = 0;
        for (const Json &bin : json["coverage"][of]) sum += bin.get<uint32_t>();
        assert_int_equal(json["coverage"][of].size(), 10);
        assert_int_equal(sum, (of[0] == 'g' ? 6 : 2) * json["pairs"].get<uint32_t>());
    }
    uint32_t ends = 0;
    for (size_t i = 0; i < json["images"].size(); ++i) {
        const Json &image = json["images"][i];
        ends += image["pairs"].get<uint32_t>();
        assert_true((image["ev_sigma"].get<double>() > 0.0) == (i != json["reference"].get<size_t>()));
        assert_close(image["known_ev_residual"].get<double>(), 0.0, 0.1);
    }
    assert_int_equal(ends, 2 * json["pairs"].get<uint32_t>());
    assert_int_equal(json["gamma"]["direction"].size(), json["gamma"]["correlation"].size());
    for (const Json &one : json["gamma"]["correlation"]) assert_true(std::fabs(one.get<double>()) <= 1.0);
}

// Standard errors are relative to the reference, whichever image it is.
void test_another_reference(void **) {
    const std::string path = linear_scene();
    const Json first = json_of(build(path, {"--fit", "exif-sigma=0"}));
    const Json other = json_of(build(path, {"--fit", "exif-sigma=0,reference=3"}));
    assert_int_equal(other["reference"].get<int>(), 3);
    assert_close(other["images"][3]["ev"].get<double>(), 0.0, 0.0);
    assert_close(other["images"][3]["ev_sigma"].get<double>(), 0.0, 0.0);
    const size_t base = first["reference"].get<size_t>();
    assert_close(other["images"][base]["ev"].get<double>(), -first["images"][3]["ev"].get<double>(), 0.02);
    assert_close(other["images"][base]["ev_sigma"].get<double>(), first["images"][3]["ev_sigma"].get<double>(), 0.01);
}

// Held exposures (wrong ones here) are relative to the project's own reference, whichever image is requested.
void test_another_reference_beside_held_exposures(void **) {
    const std::string pto = linear_scene() + "/pano.pto";
    edit(pto, "\nv E[^\n]*", "");
    edit(pto, "\nv ?\n", "\nv Eev1 Er1 Eb1\nv\n");
    const Json first = json_of({"build", pto, "--no-store", "--json", "--fit", "exif-sigma=0"}, not_usable);
    const Json other = json_of({"build", pto, "--no-store", "--json", "--fit", "exif-sigma=0,reference=1"}, not_usable);
    const double moved = first["images"][1]["ev"].get<double>();
    size_t compared = 0;  // contradicting held exposures can leave an image out, the same one in both
    for (size_t i : {0u, 2u, 3u}) {
        const Json &a = other["images"][i]["ev"], &b = first["images"][i]["ev"];
        assert_int_equal(a.is_null(), b.is_null());
        if (a.is_null()) continue;
        assert_close(a.get<double>(), b.get<double>() - moved, 1e-9);
        compared++;
    }
    assert_true(compared > 0);
}

// Small pictures of one manual exposure: a strip of 28 stays level, by EXIF or since no picture shows a difference.
void test_a_strip_at_one_manual_exposure(void **) {
    const std::string path = work("strip");
    must_exit(done,
              {"simulate",   "-o",       path,      "--size", "200x150",      "--set",          "hfov=12", "--set",
               "jitter=0.4", "--images", "28",      "--set",  "overlap=0.25", "--set",          "ev=0",    "--set",
               "mean-ev=-1", "--set",    "noise=5", "--exif", "--set",        "exif-manual=yes"});
    const Json known = json_of(build(path, {"--fit", "stored=none"}));
    const Json unknown = json_of(build(path, {"--fit", "stored=none,exif-sigma=0"}));
    const Json paper = json_of(build(path, {"--fit", "stored=none,exif-sigma=0,prior=0"}));
    const auto spread = [](const Json &json) {
        double low = 0, high = 0;  // exposure of the reference
        for (const Json &image : json["images"]) {
            low = std::min(low, image["ev"].get<double>());
            high = std::max(high, image["ev"].get<double>());
        }
        return high - low;
    };
    assert_true(spread(known) <= 0.05);
    assert_true(spread(unknown) <= 0.05 && unknown["equal_exposures"] == true && known["equal_exposures"] == false);
    assert_true(spread(known) < spread(paper));
}

// Different white balances that are held: a message names the option that frees them, and the option solves the
// problem.
void test_held_balances(void **) {
    const std::string path = work("warm");
    must_exit(done, {"simulate", "-o", path, "--size", "400x300", "--images", "6", "--set", "wb=0.03,ev=0.5"});
    const Json held = json_of(build(path, {"--fit", "free=response,falloff,ev"}));
    assert_string_equal(code_of(held).c_str(), "white_balance_fixed");
    assert_true(contains(text_of(held), "--fit free=all"));
    assert_string_equal(code_of(json_of(build(path, {"--fit", "free=all"}))).c_str(), "none");
}

// Held values determine gamma.
void test_known_is_said(void **) {
    const std::string path = linear_scene();
    const Outcome known = run_words({"build", path + "/pano.pto", "--no-store", "--fit", "gamma-from=known"});
    assert_true(contains(known.out, "gamma     known from the fixed parameters"));
}

void test_refused_options(void **) {
    const std::string path = linear_scene();
    for (const Words &words :
         {Words{"--fit", "gamma-from=guess"}, Words{"--fit", "gamma-from="}, Words{"--fit", "exif-sigma=-0.1"},
          Words{"--fit", "exif-sigma=nan"}, Words{"--fit", "exif-sigma=11"}, Words{"--fit", "camera-kind=scanner"},
          Words{"--fit", "gamma-from=exif,exif-sigma=0"}, Words{"--fit", "falloff-curves=2"},
          Words{"--fit", "falloff-curves=4"}})
        assert_refused(usage, build(path, words), {words[0]});
    assert_refused(usage, build(path, {"--force"}), {"--no-store and --force", "omit one of them"});
    assert_refused(usage, {"bracket", path + "/img000.tif", path + "/img001.tif", "--no-store", "--force"},
                   {"--force"});
    must_exit(done, build(path, {"--force", "--write", "pto=" + work("out.pto")}));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_gamma_from_exif),
        CLI_TEST(test_gamma_from_the_prior),
        CLI_TEST(test_gamma_known),
        CLI_TEST(test_falloff_curves),
        CLI_TEST(test_coverage_and_errors_are_told),
        CLI_TEST(test_another_reference),
        CLI_TEST(test_another_reference_beside_held_exposures),
        CLI_TEST(test_a_strip_at_one_manual_exposure),
        CLI_TEST(test_held_balances),
        CLI_TEST(test_known_is_said),
        CLI_TEST(test_refused_options),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
