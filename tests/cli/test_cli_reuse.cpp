// Stored profiles are used for later pictures: as the prior of the next fit, for one unit, between settings.
#include <exiv2/exiv2.hpp>

#include "cli_runs.hpp"

#include <lensprof/store.h>

using namespace cli_runs;
using namespace picture_files;

namespace {

// Two overlapping pictures of the simulated camera; the seed determines the place.
std::string pictures(const std::string &name, const char *seed, const char *falloff = "-0.4,0.1,-0.1") {
    render(name, {"--images", "2", "--size", "480x320", "--set", "overlap=0.5", "--vignetting", falloff, "--set",
                  "ev=1.5", "--exif", "--set", "exif-rounding=0.1", "--seed", seed});
    return work(name + "/pano.pto");
}

Words build(const std::string &project, const Words &more = {}) {
    return Words{"build", project, "--db", work("l.db"), "--fit", "stored=auto", "--json"} + more;
}

double corner_sigma(const Json &json) {
    const size_t first = json["response"]["emor"].size();
    double variance = 0.0;
    for (size_t i = first; i < first + 3; i++)
        for (size_t j = first; j < first + 3; j++) variance += json["covariance"][i][j].get<double>();
    return std::sqrt(variance);
}

Json shown(int64_t id) { return json_of({"profile", "show", std::to_string(id), "--db", work("l.db"), "--json"}); }

void test_next_sequences(void **) {
    const Json first = json_of(build(pictures("a", "1")));
    assert_true(first["prior"]["profile"].is_null());
    assert_true(contains(first["prior"]["reason"].get<std::string>(), "no database exists yet"));
    Json last = first;
    for (const char *name : {"b", "c"}) {
        const Json next = json_of(build(pictures(name, name == std::string("b") ? "2" : "3")));
        assert_true(next["prior"]["used"].get<bool>());
        assert_int_equal(next["prior"]["profile"].get<int>(), last["profile"].get<int>());
        assert_true(corner_sigma(next) < corner_sigma(last));
        last = next;
    }
    const Json stored = shown(3);
    assert_string_equal(stored["provenance"]["method"].get<std::string>().c_str(), "transfer");
    assert_int_equal(stored["provenance"]["prior_id"], 2);
    assert_false(stored["provenance"]["forced"].get<bool>());
    assert_int_equal(stored["provenance"]["images"], 6);
    assert_int_equal(stored["provenance"]["pairs"].get<int>(), 3 * shown(1)["provenance"]["pairs"].get<int>());
    const std::string said =
        must_exit(done, {"build", pictures("d", "4"), "--db", work("l.db"), "--fit", "stored=auto"});
    assert_true(contains(said, "prior     profile 3, used by the result"));
}

// Pictures count once, even through another profile or under another name.
void test_pictures_count_once(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "2");
    json_of(build(a));
    json_of(build(b));
    for (const std::string &again : {b, work("a/../b/./pano.pto")}) {
        const Json json = json_of(build(again, {"--no-store"}));
        assert_int_equal(json["prior"]["profile"], 1);
        assert_true(json["prior"]["used"].get<bool>());
    }
    assert_refused(usage, build(a), {a, "profile 2 already includes these pictures"});
    must_exit(done, {"profile", "remove", "2", "--db", work("l.db")});
    const Json alone = json_of(build(a, {"--no-store"}));
    assert_true(contains(alone["prior"]["reason"].get<std::string>(), "profile 1 is from these pictures alone"));
    json_of(build(b));
    must_exit(done, {"profile", "remove", "1", "--db", work("l.db")});  // the chain is broken: the origin is unknown
    assert_true(json_of(build(a, {"--no-store"}))["prior"]["used"].get<bool>());
}

// In another database, where ids differ, the origin of profiles is still known.
void test_merged_profiles_count_once(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "2");
    json_of(build(a));
    json_of(build(b));
    const Words all = {"--db", work("all.db")};
    must_exit(done, Words{"build", pictures("c", "3"), "--aperture", "11"} + all);
    must_exit(done, Words{"profile", "merge", work("l.db")} + all);
    const Json merged = json_of(Words{"profile", "show", "3", "--json"} + all);
    assert_int_equal(merged["provenance"]["prior_id"], 2);
    const Words again = all + Words{"--fit", "stored=auto", "--json", "--no-store"};
    assert_int_equal(json_of(Words{"build", b} + again)["prior"]["profile"], 2);
    assert_refused(usage, Words{"build", a} + again,
                   {a, "profile 3 already includes these pictures", "--fit stored=none"});
    assert_refused(usage, Words{"build", a, "--fit", "stored=3", "--no-store"} + all,
                   {"already includes these pictures"});
    const Json deep =
        json_of(Words{"build", a, "--no-store", "--json"} + all);  // not requested: it is left out, with a reason
    assert_true(deep["prior"]["profile"].is_null());
    assert_true(contains(deep["prior"]["reason"].get<std::string>(), "profile 3 already includes these pictures"));
    // An exported file has no ids of the database.
    must_exit(done, Words{"profile", "export", "3", "-o", work("one.json")} + all);
    must_exit(done, {"profile", "import", work("one.json"), "--db", work("one.db")});
    const Json alone = json_of({"profile", "show", "1", "--json", "--db", work("one.db")});
    assert_true(alone["provenance"]["prior_id"].is_null());
    assert_int_equal(alone["provenance"]["images"], 4);
    const std::string said = must_exit(done, {"profile", "import", work("one.json"), "--db", work("one.db")});
    assert_true(contains(said, "1 was stored already"));
}

// Its falloff is overruled; its response matches these pictures and stays the prior.
void test_wrong_profile_is_overruled(void **) {
    json_of(build(pictures("a", "1", "-0.05,0,0")));
    const Outcome outcome = run_words(build(pictures("b", "2")));
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "contradicts the pictures"));
    const Json json = parsed(outcome.out);
    assert_true(json["prior"]["used"].get<bool>());
    assert_true(json["prior"]["overruled"] == Json::array({"falloff"}));
    assert_true(contains(json["prior"]["reason"].get<std::string>(), "contradicts the pictures"));
    assert_int_equal(shown(2)["provenance"]["prior_id"], 1);
    assert_int_equal(shown(2)["provenance"]["images"], 4);
}

// Between two settings: the lens's profiles predicted for the setting, and the camera's response, form the prior. Their
// pictures do not count as pictures of the result, and pictures are never their own prior.
void test_composed_prior(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "2");
    json_of(build(a, {"--aperture", "4"}));
    json_of(build(pictures("c", "3"), {"--aperture", "5.6"}));
    const Json json = json_of(build(b, {"--aperture", "4.5"}));
    assert_true(json["prior"]["composed"].get<bool>());
    assert_true(json["prior"]["used"].get<bool>());
    assert_int_equal(json["prior"]["profile"], 1);
    assert_int_equal(shown(3)["provenance"]["prior_id"], 1);  // the nearest one, so that its pictures count once
    assert_int_equal(shown(3)["provenance"]["images"], 2);
    const Json again = json_of(build(a, {"--aperture", "4.2", "--no-store"}));
    assert_true(again["prior"]["profile"].is_null());
    assert_true(contains(again["prior"]["reason"].get<std::string>(), "already includes these pictures"));
}

void test_no_prior_for_this(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "2");
    json_of(build(a, {"--aperture", "4", "--camera", "Another camera"}));
    assert_true(
        contains(json_of(build(b, {"--no-store"}))["prior"]["reason"].get<std::string>(), "no profile is stored"));
    assert_refused(usage, build(b, {"--fit", "method=transfer-function"}), {"--fit stored", "transfer"});
    assert_refused(usage, {"build", b, "--fit", "prior=some"}, {"--fit prior", "some"});
    assert_refused(usage, {"build", b, "--fit", "stored=some"}, {"--fit stored", "some"});
    assert_refused(usage, build(b, {"--fit", "prior=0"}), {"--fit stored", "prior above 0"});
    assert_refused(not_found, {"build", b, "--fit", "stored=9", "--db", work("l.db")}, {work("l.db"), "9"});
    assert_refused(usage, {"bracket", work("a/img000.png"), "--fit", "stored=auto"}, {"stored is not a key"});
    save_text(work("l.db"), "not a database, but long enough that it might be one. not a database, but long enough...");
    assert_refused(store_failed, build(b), {work("l.db")});
}

// By default, stored profiles in any of the databases are the prior.
void test_stored_by_default(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "2"), db = work("l.db");
    const Words one = {"--db", db, "--json", "--no-store"}, two = {"--db", work("own.db")};
    assert_true(json_of(Words{"build", a, "--json", "--db", db})["prior"].is_null());  // nothing is stored yet
    const Json stored = json_of(Words{"build", b} + one)["prior"];
    assert_int_equal(stored["profile"], 1);
    assert_true(stored["used"].get<bool>() && !stored["composed"].get<bool>());
    assert_true(json_of({"build", b, "--fit", "stored=none", "--json", "--no-store"})["prior"].is_null());
    assert_true(json_of({"build", b, "--fit", "prior=0", "--json", "--no-store"})["prior"].is_null());
    assert_int_equal(json_of(Words{"build", b, "--fit", "stored=1"} + one)["prior"]["profile"], 1);
    const Json other = json_of(Words{"build", b, "--json"} + two + Words{"--db", db});
    assert_true(other["prior"]["used"].get<bool>() && other["prior"]["composed"].get<bool>());
    const Json row =
        json_of(Words{"profile", "show", "1", "--json"} + two);  // ids of one database mean nothing in another
    assert_true(row["provenance"]["prior_id"].is_null());
    assert_int_equal(row["provenance"]["images"], 2);
}

// The camera's response is the prior, even for a lens without profiles.
void test_response_of_the_camera(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "2"), db = work("l.db");
    must_exit(done, {"build", a, "--db", db, "--lens", "Another lens", "--fit", "exif-sigma=0.01"});
    const Json json = json_of({"build", b, "--db", db, "--lens", "This lens", "--json"});
    assert_true(json["prior"]["used"].get<bool>() && json["prior"]["composed"].get<bool>());
    assert_int_equal(json["prior"]["profile"], 1);
    assert_true(json["gamma"]["from"] != "prior");
}

// The same with a response refined from a bracket: a table with the error of its gamma.
void test_refined_response_of_the_camera(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "2"), db = work("l.db");
    const Json first = json_of({"build", a, "--no-store", "--json"});
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(db.c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    std::strcpy(profile->key.camera_model, "Simulated Camera");
    std::vector<double> curve;
    for (const auto &value : first["response"]["values"][0]) curve.push_back(value.get<double>());
    assert_ok(lensprof_response_set_table(&profile->response[0], curve.data(), uint32_t(curve.size())));
    profile->provenance.gamma_sigma = 0.02;
    assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
    lensprof_store_close(store);
    const Words words = {"build", b, "--lens", "This lens", "--json", "--no-store", "--fit", "exif-sigma=0"};
    const Json alone = json_of(words), json = json_of(words + Words{"--db", db});
    assert_true(json["prior"]["used"].get<bool>());
    assert_true(json["prior"]["overruled"].empty());
    assert_string_equal(json["gamma"]["from"].get<std::string>().c_str(), "profile");
    assert_true(json["gamma"]["sigma"].get<double>() < 0.05 && alone["gamma"]["sigma"].get<double>() > 0.06);
    double worst = 0;
    for (size_t i = 0; i < curve.size(); i++)
        worst = std::max(worst, std::fabs(json["response"]["values"][0][i].get<double>() - curve[i]));
    assert_true(worst < 0.02);
}

// An imported falloff without covariance determines gamma as well as it can; so does one measured at other settings.
void test_imported_falloff_settles_gamma(void **) {
    const std::string a = pictures("a", "1"), db = work("lens.db");
    const Words fit = {"build", a, "--json", "--no-store", "--fit", "exif-sigma=0"};
    const Words words = fit + Words{"--db", work("own.db"), "--db", db};
    const Json alone = json_of(fit + Words{"--fit", "stored=none"});
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(db.c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    std::strcpy(profile->key.lens, "Simulated Lens");
    profile->key.focal_mm = 38.6, profile->key.crop_factor = 1;
    profile->key.processing = LENSPROF_PROCESSING_RAW;
    const double truth[3] = {-0.4, 0.1, -0.1};
    std::copy_n(truth, 3, profile->vignetting[0].k);
    for (double aperture : {2.8, 4.0}) {
        profile->key.aperture = aperture;
        assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
    }
    lensprof_store_close(store);
    const Words unknown = words + Words{"--focal", "38.6", "--key", "crop-factor=1", "--lens", "Simulated Lens"};
    json_of(unknown);
    for (const char *aperture : {"2.8", "2.9"}) {
        const Json json = json_of(words + Words{"--aperture", aperture, "--focal", "38.6", "--key", "crop-factor=1"});
        assert_true(json["prior"]["used"].get<bool>() && json["prior"]["composed"].get<bool>());
        assert_true(json["gamma"]["sigma"].get<double>() < alone["gamma"]["sigma"].get<double>());
        double corner = 1, before = 1;
        for (size_t i = 0; i < 3; i++) {
            corner += json["vignetting"]["k"][0][i].get<double>();
            before += alone["vignetting"]["k"][0][i].get<double>();
        }
        assert_true(std::fabs(corner - 0.6) < 0.03);
        assert_true(std::fabs(corner - 0.6) <= std::fabs(before - 0.6) + 0.005);
    }
}

void write_exif(const std::string &file, const std::map<std::string, std::string> &values) {
    auto image = Exiv2::ImageFactory::open(file);
    image->readMetadata();
    for (const auto &value : values) image->exifData()[value.first].setValue(value.second);
    image->writeMetadata();
}

// A profile of a unit is used for this unit, before one of the model, and for no other unit.
void test_units(void **) {
    const std::string a = pictures("a", "1");
    const auto set_unit = [&](const char *body) {
        for (const char *name : {"a/img000.png", "a/img001.png"})
            write_exif(work(name), {{"Exif.Photo.BodySerialNumber", body}, {"Exif.Photo.LensSerialNumber", "77"}});
    };
    set_unit("123");
    const Words db = {"--db", work("l.db")};
    must_exit(done, Words{"build", a} + db);
    must_exit(done, Words{"build", a, "--key", "unit=exif"} + db);
    must_exit(done, Words{"build", a, "--key", "unit=other"} + db);
    assert_string_equal(shown(1)["key"]["unit"].get<std::string>().c_str(), "");
    assert_string_equal(shown(2)["key"]["unit"].get<std::string>().c_str(), "123/77");
    const Words apply = Words{"apply", "--profile", "auto", "--json", "-o", work("out"), work("a/img000.png")} + db;
    assert_int_equal(json_of(apply)["pictures"][0]["profile"], 2);
    fs::remove_all(work("out"));
    set_unit("124");
    assert_int_equal(json_of(apply)["pictures"][0]["profile"], 1);
    write_exif(work("a/img000.png"), {{"Exif.Photo.BodySerialNumber", ""}, {"Exif.Photo.LensSerialNumber", "0000"}});
    assert_refused(usage, Words{"build", a, "--key", "unit=exif"} + db, {"img000.png", "--key unit"});
}

// Between two apertures the falloff is predicted, and a note reports it.
void test_apply_between_settings(void **) {
    const std::string a = pictures("a", "1"), b = pictures("b", "1", "-0.2,0.05,-0.05");
    const Words db = {"--db", work("l.db"), "--key", "distance=inf"};
    must_exit(done, Words{"build", a, "--aperture", "2.5"} + db);
    must_exit(done, Words{"build", b, "--aperture", "3.2"} + db);
    const Words apply = {"apply", "--profile", "auto", "-o", work("out"), work("a/img000.png"), work("a/img001.png"),
                         "--db",  work("l.db")};
    const Outcome outcome = run_words(apply);
    assert_int_equal(outcome.code, done);
    // A single note, since the lookup is the same for both.
    assert_true(contains(outcome.err, "img000.png and 1 more: falloff predicted from 2 profiles, response "));
    assert_true(contains(outcome.err, "; at most, relative illuminance in the corner \u00b1 0."));
    assert_int_equal(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    fs::remove_all(work("out"));
    const Json lookup = json_of(apply + Words{"--json"})["pictures"][0]["lookup"];
    assert_int_equal(lookup["rows"].size(), 2);
    assert_false(lookup["exact"].get<bool>());
    assert_true(lookup["sigma"].get<double>() > 0.0);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_next_sequences),
                                CLI_TEST(test_pictures_count_once),
                                CLI_TEST(test_merged_profiles_count_once),
                                CLI_TEST(test_wrong_profile_is_overruled),
                                CLI_TEST(test_stored_by_default),
                                CLI_TEST(test_response_of_the_camera),
                                CLI_TEST(test_refined_response_of_the_camera),
                                CLI_TEST(test_imported_falloff_settles_gamma),
                                CLI_TEST(test_composed_prior),
                                CLI_TEST(test_no_prior_for_this),
                                CLI_TEST(test_units),
                                CLI_TEST(test_apply_between_settings)};
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
