// `lensprof profile import`, and `lensprof query` for settings that are not stored.
#include <cmath>

#include "cli_runs.hpp"

using namespace cli_runs;
using namespace picture_files;

namespace {

constexpr const char *kLens = "24-70mm f/2.8";

std::string make_file() {
    save_text(work("lenses.xml"), lensfun_text(kLens, {{24, 2.8, -0.6},
                                                       {24, 4, -0.35},
                                                       {24, 8, -0.15},
                                                       {70, 2.8, -0.4},
                                                       {70, 4, -0.25},
                                                       {70, 8, -0.1},
                                                       {50, 2.8, -0.3},
                                                       {50, 4, -1.9, 0.1}}));
    return work("lenses.xml");
}

Words import_words() { return {"profile", "import", "--db", work("l.db")}; }

void test_import(void **) {
    const std::string file = make_file();
    const std::string said = must_exit(done, import_words() + Words{file});
    assert_true(contains(said, "imported 7 profiles of 1 lens from 1 file"));
    assert_true(contains(said, "doubtful: 2 profiles"));
    const Json again = json_of(import_words() + Words{"--json", file});
    assert_int_equal(again["stored"], 0);
    assert_int_equal(again["known"], 7);
    assert_int_equal(again["flagged"].size(), 2);
    assert_true(again["flagged"][0]["stored"].get<bool>() != again["flagged"][1]["stored"].get<bool>());
    assert_int_equal(json_of({"profile", "list", "--db", work("l.db"), "--json"})["profiles"].size(), 7);
}

void test_query_between(void **) {
    must_exit(done, import_words() + Words{make_file()});
    const Words query = {"query", "--db", work("l.db"), "--lens", "example 24-70MM F2.8", "--key", "crop-factor=1.5"};
    const Json json = json_of(query + Words{"--focal", "35", "--aperture", "3.4", "--key", "distance=inf", "--json"});
    const double k1 = json["vignetting"]["k"][0][0].get<double>();
    assert_true(k1 < -0.25 && k1 > -0.6);
    assert_false(json["lookup"]["exact"].get<bool>());
    assert_true(json["lookup"]["rows"].size() >= 6);
    assert_true(json["lookup"]["sigma"].get<double>() > 0.0);
    assert_true(json["id"].is_null());
    assert_true(json["lookup"]["reason_codes"].empty());
    const Json near = json_of(query + Words{"--focal", "35", "--aperture", "3.4", "--json"});
    assert_true(near["lookup"]["reason_codes"] == Json::array({"lookup_usual_distance"}));
    const std::string said = must_exit(done, query + Words{"--focal", "35", "--aperture", "3.4"});
    assert_true(contains(said, "predicted from") && contains(said, "the mean falloff over usual distances is used"));
    assert_true(contains(said, "Lensfun database, CC BY-SA 3.0"));
    assert_refused(not_found, query + Words{"--focal", "35", "--aperture", "32"}, {"aperture is beyond"});
    assert_refused(not_found,
                   {"query", "--db", work("l.db"), "--lens", "example 24-70MM F2.8", "--focal", "35", "--aperture",
                    "3.4", "--key", "crop-factor=1"},
                   {"smaller sensors only"});
    const std::string range = must_exit(done, query + Words{"--focal", "35"});
    assert_true(contains(range, "profiles match: the aperture is unknown, and the lens has several; specify it"));
    assert_true(contains(range, "\naperture  f/2.8-") && contains(range, "\ncorner    M 0."));
    const Json known = json_of(query + Words{"--json"})["range"];
    assert_true(known["focal_mm"].size() == 2 && known["corner"][0].get<double>() < known["corner"][1].get<double>());
    assert_true(known["lenses"].size() == 1 && known["processings"] == Json::array({"raw"}));
    assert_refused(not_found,
                   {"query", "--db", work("l.db"), "--lens", "Nothing 50mm", "--focal", "50", "--aperture", "2"},
                   {"no profile of a lens with this name"});
    assert_refused(usage, query + Words{"--key", "unknown-distance=nearest"}, {"--key unknown-distance"});
}

// Samples rounded in the file; several profiles of one key; none is stored twice.
void test_json_again(void **) {
    Json all = Json::array();
    for (double k1 : {-0.1, -0.2}) {
        Json curve = Json::array();
        for (int j = 0; j < 1024; j++) curve.push_back(std::round(std::pow(j / 1023.0, 1.0 / 2.2) * 1e7) / 1e7);
        all.push_back({{"key", {{"lens", "one"}, {"processing", "jpeg"}}},
                       {"vignetting", {{"k", Json::array({Json::array({k1, 0.0, 0.0})})}}},
                       {"response", {{"kind", "gamma"}, {"gamma", 2.2}, {"values", Json::array({curve})}}}});
    }
    save_text(work("two.json"), Json{{"schema", 1}, {"profiles", all}}.dump());
    assert_int_equal(json_of(import_words() + Words{"--json", work("two.json")})["stored"], 2);
    const Json again = json_of(import_words() + Words{"--json", work("two.json")});
    assert_int_equal(again["stored"], 0);
    assert_int_equal(again["known"], 2);
    const Json shown = json_of({"profile", "show", "1", "--json", "--db", work("l.db")});
    assert_true(std::fabs(shown["response"]["values"][0][511].get<double>() - std::pow(511 / 1023.0, 1.0 / 2.2))
                < 1e-12);
}

// Profiles of one unit state it; a full setting is never answered by another profile; formats and ids in words.
void test_units_and_settings(void **) {
    Json all = Json::array();
    for (double aperture : {2.0, 4.0})
        all.push_back({{"key",
                        {{"lens", "one"},
                         {"unit", "SN1"},
                         {"focal_mm", 50},
                         {"aperture", aperture},
                         {"processing", "raw"},
                         {"crop_factor", 1.0}}},
                       {"vignetting", {{"k", {{-0.4, 0, 0}, {-0.3, 0, 0}, {-0.2, 0, 0}}}}}});
    save_text(work("unit.json"), Json{{"schema", 1}, {"profiles", all}}.dump());
    must_exit(done, import_words() + Words{work("unit.json")});
    const Words query = {"query", "--db", work("l.db"), "--lens", "one", "--focal", "50"};
    assert_true(contains(must_exit(done, query + Words{"--aperture", "2"}), "unit      SN1"));
    assert_true(contains(must_exit(done, query + Words{"--aperture", "2.8", "--key", "unit=sn1"}),
                         "predicted from 2 profiles"));
    assert_refused(not_found, query + Words{"--aperture", "2.8"}, {"single units"});
    assert_refused(not_found, query, {"single units"});
    assert_refused(usage, {"profile", "show", "abc", "--db", work("l.db")}, {"abc is not a profile id"});
    const Outcome written = run_words({"profile", "export", "2", "-o", work("one.xml"), "--db", work("l.db")});
    assert_int_equal(written.code, done);
    assert_true(contains(written.err, "profile 2: its falloff differs per channel; lensfun stores the mean"));
    assert_refused(usage, {"profile", "export", "2", "-o", work("one.lcp"), "--db", work("l.db"), "--all"}, {"--all"});
    must_exit(done,
              {"profile", "export", "2", "-o", work("one.csv"), "--encoding", "grid=2x1024", "--db", work("l.db")});
}

// All files are imported, or none.
void test_import_refuses(void **) {
    const std::string good = make_file();
    save_text(work("cut.xml"), lensfun_text(kLens, {{24, 2.8, -0.6}}).substr(0, 150));
    assert_refused(unreadable, import_words() + Words{good, work("cut.xml")}, {work("cut.xml")});
    must_exit(done, import_words() + Words{good});
    assert_refused(unreadable, import_words() + Words{good, work("cut.xml")}, {work("cut.xml")});
    assert_refused(unreadable, import_words() + Words{work("none.xml")}, {work("none.xml")});
    assert_refused(unreadable, import_words() + Words{work("")}, {"is a folder"});
    assert_refused(usage, {"profile", "import"}, {"FILE"});
    assert_refused(store_failed, {"profile", "import", good, "--db", work("none/l.db")},
                   {"does not exist", "create it first"});
    assert_refused(store_failed, {"profile", "merge", work("l.db"), "--db", work("none/l.db")}, {"does not exist"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_import), CLI_TEST(test_query_between), CLI_TEST(test_json_again),
                                CLI_TEST(test_units_and_settings), CLI_TEST(test_import_refuses)};
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
