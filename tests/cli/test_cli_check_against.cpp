// `lensprof profile check ID... --against PICTURES`: which profile fits and by how much, and refused input.
#include <exiv2/exiv2.hpp>

#include "cli_runs.hpp"

#include "cli/profiles/trial_report.hpp"

using namespace cli_runs;

namespace {

std::string db() { return in_folder("l.db"); }

Words against(const std::string &ids, const std::string &pictures, const Words &more = {}) {
    Words words = {"profile", "check"};
    std::istringstream each(ids);
    for (std::string id; each >> id;) words.push_back(id);
    return words + Words{"--against", pictures, "--db", db()} + more;
}

Json measured(const std::string &ids, const std::string &pictures, int code = done) {
    return json_of(against(ids, pictures, {"--json"}), code);
}

std::string pictures(const std::string &name, const char *seed, const char *falloff, const Words &more = {},
                     const char *size = "360x240") {
    must_exit(done, Words{"simulate", "-o", in_folder(name), "--images", "5", "--size", size, "--seed", seed,
                          "--vignetting", falloff, "--set", "center=0,0"}
                        + more);
    return in_folder(name + "/pano.pto");
}

constexpr const char *kFalloff = "-0.4,0.1,-0.1";

// Stores profile `id` with other content as the next one.
void store_changed(int id, const std::string &name, const std::function<void(Json &)> &change) {
    const std::string file = in_folder(name + ".json");
    must_exit(done, {"profile", "export", std::to_string(id), "-o", file, "--db", db()});
    Json json = parsed(text_of(file));
    json["covariance"] = nullptr;
    json["key"]["lens"] = name;
    change(json);
    save_text(file, json.dump());
    must_exit(done, {"profile", "import", file, "--db", db()});
}

// 1: measured on other pictures of the lens. 2: half of its falloff. 3: a table as its response. 4: its falloff as a
// gain grid, without response. 5: no falloff. 6: three equal curves. 7: from a telephoto lens, with very little
// falloff.
int make_profiles(void **state) {
    if (make_scene(state) != 0) return -1;
    must_exit(done, {"build", pictures("one", "1", kFalloff), "--db", db(), "--fit", "stored=none"});
    store_changed(1, "half", [](Json &json) {
        for (Json &k : json["vignetting"]["k"][0]) k = 0.5 * k.get<double>();
    });
    const std::string curve = in_folder("curve.csv"), map = in_folder("map.tif");
    must_exit(done, {"profile", "export", "1", "-o", curve, "--db", db(), "--encoding", "grid=2x1024"});
    must_exit(done, {"profile", "export", "1", "-o", map, "--encoding", "frame=360x240", "--db", db()});
    must_exit(done, {"profile", "import", curve, map, "--camera", "a", "--lens", "table", "--db", db()});
    must_exit(done, {"profile", "import", map, "--camera", "a", "--lens", "map", "--db", db()});
    store_changed(1, "none", [](Json &json) { json["vignetting"]["k"] = Json::array({{0.0, 0.0, 0.0}}); });
    store_changed(1, "three", [](Json &json) {
        const Json k = json["vignetting"]["k"][0];
        json["vignetting"]["k"] = Json::array({k, k, k});
    });
    store_changed(1, "tele", [](Json &json) { json["vignetting"]["k"] = Json::array({{-0.02, 0.0, 0.0}}); });
    pictures("two", "2", kFalloff);
    return 0;
}

const Json &of(const Json &json, int id) {
    for (const Json &profile : json["profiles"])
        if (profile["id"] == id) return profile;
    fail_msg("no profile %d in %s", id, json.dump().c_str());
    return json;
}

// With a project, a folder and single pictures.
void test_right_one_is_named(void **) {
    const std::string folder_of = in_folder("two");
    for (const std::string &given : {folder_of + "/pano.pto", folder_of}) {
        const Json json = measured("1 2", given);
        assert_int_equal(json["best"], 1);
        assert_true(json["is_decided"].get<bool>());
        assert_int_equal(json["images"], 5);
        assert_true(json["measured"] > 400 && json["fitted"] > 400);
        assert_true(of(json, 1)["rms"] < 1.2);
        assert_true(of(json, 1)["median"] < of(json, 1)["rms"]);
        assert_true(of(json, 1)["better_than_none"].get<bool>() && of(json, 1)["as_good_as_best"].get<bool>());
        assert_true(of(json, 2)["rms"] > 2.0 * of(json, 1)["rms"].get<double>());
        assert_true(of(json, 2)["above_best"] > 3.0 * of(json, 2)["above_best_sigma"].get<double>());
        assert_false(of(json, 2)["as_good_as_best"].get<bool>());
        assert_true(json["none"]["rms"] > of(json, 2)["rms"]);
        assert_true(json["before_rms"] > json["none"]["rms"]);
        assert_true(of(json, 1)["response"] == "own");
        assert_true(of(json, 1)["corners"] == "agree" && of(json, 2)["corners"] == "too-dark");
        assert_true(json["none"]["corners"] == "too-dark" && json["none"]["ring_ev"].size() == 5);
    }
    const std::string said = must_exit(done, against("2 1", folder_of + "/pano.pto"));
    assert_true(contains(said, "best           profile 1\n"));
    assert_true(contains(said, "no falloff") && contains(said, "undercorrects the corners by -0."));
    // As a shell expands *.png: the words after the first are further pictures.
    const Words more = {folder_of + "/img001.png", folder_of + "/img002.png", folder_of + "/img003.png"};
    assert_int_equal(json_of(against("1 2", folder_of + "/img000.png", more + Words{"--json"}))["best"], 1);
}

// Same input, same bytes; and nothing is written.
void test_repeats(void **) {
    const Disk before = disk();
    const Words words = against("1 2 3 4", in_folder("two"), {"--json"});
    assert_string_equal(must_exit(done, words).c_str(), must_exit(done, words).c_str());
    assert_string_equal(difference(before, disk()).c_str(), "");
}

void test_undecided(void **) {
    const Json json = measured("1 3 6 2", in_folder("two/pano.pto"));
    assert_false(json["is_decided"].get<bool>());
    for (int id : {1, 3, 6}) {
        assert_true(of(json, id)["as_good_as_best"].get<bool>());
        assert_true(of(json, id)["better_than_none"].get<bool>());
    }
    assert_false(of(json, 2)["as_good_as_best"].get<bool>());
    const std::string said = must_exit(done, against("1 6 2 1", in_folder("two/pano.pto")));
    assert_true(contains(said, "cannot distinguish profiles 1 and 6"));
}

// A falloff alone is combined with the best response: with that of the pictures' camera it fits.
void test_parts(void **) {
    const Json json = measured("4 1", in_folder("two/pano.pto"));
    assert_true(of(json, 4)["response"] == "other");
    assert_int_equal(of(json, 4)["response_profile"], 1);
    assert_true(of(json, 4)["rms"] < 1.1 * of(json, 1)["rms"].get<double>());
    const Json alone = measured("4", in_folder("two/pano.pto"));
    assert_true(of(alone, 4)["response"] == "kind");
    assert_true(of(alone, 4)["better_than_none"].get<bool>());
    assert_true(alone["is_decided"].get<bool>());
    const std::string said = must_exit(done, against("5 1", in_folder("two/pano.pto")));
    assert_true(contains(said, "has no falloff"));
}

// Each channel has its own curve: a single falloff is worse than three.
void test_three_channels(void **) {
    const char *falloffs = "-0.3,0,0,-0.4,0.1,-0.1,-0.5,0.1,0";
    must_exit(done, {"build", pictures("colours1", "4", falloffs), "--fit", "falloff-curves=3", "--db", db(), "--fit",
                     "stored=none", "--lens", "colours"});
    const std::string colours = pictures("colours", "5", falloffs);
    const Json json = measured("1 8", colours);
    assert_int_equal(json["best"], 8);
    assert_true(json["is_decided"].get<bool>());
    must_exit(done, {"profile", "remove", "8", "--db", db()});
}

// Sensor data have a linear response, whatever the profile's response is, and a frame may have another shape.
void test_linear_pictures(void **) {
    const std::string linear =
        pictures("linear", "6", kFalloff, {"--response", "linear", "--format", "tiff32"}, "300x300");
    const Json json = measured("1 2 4", linear);
    assert_int_equal(json["images"], 5);
    for (int id : {1, 2, 4}) assert_true(of(json, id)["response"] == "linear");
    assert_false(of(json, 2)["as_good_as_best"].get<bool>());
    assert_true(of(json, 1)["rms"] < 3.5);  // the profile's falloff has another gamma, within its error
}

// Moving objects are not part of any model: they are counted, and the right profile is still found.
void test_moving_objects(void **) {
    const Json json = measured("1 2", pictures("objects", "7", kFalloff, {"--set", "objects=0.1,outliers=0.05"}));
    assert_int_equal(json["best"], 1);
    assert_true(json["is_decided"].get<bool>());
    assert_true(json["unexplained"] > 0);
    assert_true(of(json, 1)["rms"] < 1.5);
}

// No profile is better than no correction: pictures without falloff, and profiles without falloff.
void test_none_fits(void **) {
    const std::string flat = pictures("flat", "3", "0,0,0");
    const Json json = measured("1 2", flat, not_usable);
    assert_true(json["best"].is_null());
    assert_false(json["is_decided"].get<bool>());
    for (int id : {1, 2}) assert_false(of(json, id)["better_than_none"].get<bool>());
    assert_refused(not_usable, against("1 2", flat), {flat, "no profile is better", "lensprof build"});
    assert_refused(not_usable, against("5", in_folder("two/pano.pto")), {"two", "falloff uncorrected"});
    assert_int_equal(measured("5 1", in_folder("two/pano.pto"))["best"], 1);
}

// A profile applies to one setting: pictures with other settings are named and left out.
void test_other_settings(void **) {
    const std::string mixed_db = work("two");
    fs::copy(in_folder("two"), mixed_db);
    for (const char *name : {"img000.png", "img001.png"}) {
        const std::string file = mixed_db + "/" + name;
        auto image = Exiv2::ImageFactory::open(file);
        image->readMetadata();
        image->exifData()["Exif.Photo.FNumber"] = "110/10";
        image->writeMetadata();
    }
    const Outcome outcome = run_words(against("1 2", mixed_db + "/pano.pto", {"--json"}));
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "2 pictures of another camera, size or lens setting left out"));
    assert_int_equal(parsed(outcome.out)["images"], 3);
}

void test_refused(void **) {
    const std::string two = in_folder("two/pano.pto"), text = work("text.txt"), bad = work("bad.jpg");
    save_text(text, "hello\n");
    save_text(bad, "hello\n");
    save_text(work("bad2.jpg"), "hello again\n");
    assert_refused(not_found, against("1 99", two), {"99", "list the profiles"});
    assert_refused(not_found, {"profile", "check", "1", "--against", two, "--db", work("none.db")}, {"none.db"});
    assert_refused(usage, {"profile", "check", "1", "--db", db()}, {"1", "--against"});
    assert_refused(usage, {"profile", "check", "--images", work("x"), "--db", db()}, {"--images", "--against"});
    assert_refused(usage, {"profile", "check", "--against", two, "--db", db()}, {"--against", "profile list"});
    assert_refused(usage, against("0", two), {"0 is not a profile id"});
    assert_refused(usage, against("99999999999999999999", two), {"99999999999999999999"});
    assert_refused(usage, against("1", two, {"--images", work("x")}), {"--images"});
    assert_refused(unreadable, against("1", text), {text});
    assert_refused(unreadable, against("1", work("none.pto")), {"none.pto"});
    assert_refused(unreadable, against("1", in_folder("two/img000.png"), {text}), {text, "neither a picture"});
    assert_refused(unreadable, against("1", bad, {work("bad2.jpg")}), {bad});
    assert_refused(not_usable, against("1", in_folder("two/img000.png")), {"img000.png", "at least two"});
    const std::string broken = copy_of("two");
    fs::remove(broken + "/img002.png");
    assert_refused(unreadable, against("1", broken + "/pano.pto"), {"img002.png"});
}

void test_no_overlap(void **) {
    const std::string other = pictures("elsewhere", "9", kFalloff);
    assert_refused(not_usable, against("1", in_folder("two/img000.png"), {in_folder("elsewhere/img004.png")}),
                   {"2 pictures", "no two of the pictures overlap"});
}

// The residuals of all pairs may prefer a profile whose corners the rings show to be wrong: that is stated.
void test_rings_contradict_the_residuals(void **) {
    std::vector<StoredProfile> profiles;
    for (const int64_t id : {7, 8}) profiles.push_back({id, new_profile()});
    TrialReport report("profiles.db", "pictures", profiles);
    report.result.usable = report.result.decided = 1;
    const struct {
        double rms, left;
        uint32_t corners;
    } found[] = {{1.0, 0.2, LENSPROF_TRIAL_CORNERS_TOO_BRIGHT}, {1.1, 0.01, LENSPROF_TRIAL_CORNERS_AGREE}};
    for (size_t i = 0; i < 2; i++) {
        lensprof_trial_candidate &candidate = report.candidates[i];
        candidate.heldout_rms = found[i].rms, candidate.corners = found[i].corners;
        candidate.rings = LENSPROF_TRIAL_RINGS;
        candidate.ring_ev[LENSPROF_TRIAL_RINGS - 1] = found[i].left;
    }
    std::ostringstream text;
    print_trial(report, text);
    assert_true(contains(text.str(), "best           profile 7\n"));
    assert_true(contains(text.str(), "overcorrects the corners by +0.20") && contains(text.str(), "profile 8 leaves"));
    assert_true(trial_json(report)["best_by_rings"] == 8);
    report.candidates[0].corners = LENSPROF_TRIAL_CORNERS_AGREE;
    std::ostringstream agreed;
    print_trial(report, agreed);
    assert_false(contains(agreed.str(), "by RMS"));
    assert_true(trial_json(report)["best_by_rings"].is_null());
}

}  // namespace

int main(void) {
    const CMUnitTest tests[] = {
        CLI_TEST(test_right_one_is_named), CLI_TEST(test_repeats),
        CLI_TEST(test_undecided),          CLI_TEST(test_parts),
        CLI_TEST(test_three_channels),     CLI_TEST(test_linear_pictures),
        CLI_TEST(test_moving_objects),     CLI_TEST(test_none_fits),
        CLI_TEST(test_other_settings),     CLI_TEST(test_refused),
        CLI_TEST(test_no_overlap),         CLI_TEST(test_rings_contradict_the_residuals),
    };
    return cmocka_run_group_tests(tests, make_profiles, remove_folder);
}
