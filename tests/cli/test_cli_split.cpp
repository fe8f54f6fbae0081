// `lensprof profile export --split`: a folder with one file per lens, and the size of JSON.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

struct Stored {
    const char *lens;
    double crop_factor, aperture;
};

// Lenses with names that file systems cannot hold as they are, or that differ only by case.
void make_db(const std::vector<Stored> &profiles) {
    Json all = Json::array();
    for (const Stored &one : profiles)
        all.push_back({{"key",
                        {{"camera_model", *one.lens ? "" : "Fixed"},
                         {"lens", one.lens},
                         {"focal_mm", 50},
                         {"aperture", one.aperture},
                         {"crop_factor", one.crop_factor > 0 ? Json(one.crop_factor) : Json()},
                         {"processing", "raw"}}},
                       {"vignetting", {{"k", {{-0.5 / one.aperture, 0, 0}}}}}});
    save_text(work("all.json"), Json{{"schema", 1}, {"profiles", all}}.dump());
    must_exit(done, {"profile", "import", work("all.json"), "--db", work("p.db")});
}

const std::vector<Stored> kSeveral = {{"A 50mm f/1.4", 1, 2}, {"A 50mm f/1.4", 1, 4},   {"a 50MM F/1.4", 1, 8},
                                      {"../B: \"x\"", 1, 2},  {"A 50mm f/1.4", 1.6, 2}, {"", 1, 2}};

Words split(const std::string &format, const Words &more = {}) {
    return Words{"profile", "export", "--split", "--format", format, "-o", work("out"), "--db", work("p.db")} + more;
}

Json json_in(const std::string &name) { return parsed(text_of(work(name))); }

std::vector<std::string> names_in(const std::string &folder) {
    std::vector<std::string> names;
    for (const auto &entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

void test_a_file_for_each_lens(void **) {
    make_db(kSeveral);
    const Json json = json_of(split("json", {"--all", "--json"}));
    assert_int_equal(json["files"].size(), 3);
    assert_true(names_in(work("out"))
                == std::vector<std::string>({"A 50mm f-1.4.json", "Fixed.json", "_..-B- -x-.json"}));
    uint32_t stored = 0;
    for (const Json &file : json["files"]) {
        const Json again = json_of({"profile", "import", file["file"], "--db", work("q.db"), "--json"});
        assert_int_equal(again["stored"], file["profiles"].size());
        stored += again["stored"].get<uint32_t>();
    }
    assert_int_equal(stored, kSeveral.size());
}

// An Adobe lens profile holds one camera and sensor, a blob one profile.
void test_formats_that_hold_less(void **) {
    make_db(kSeveral);
    must_exit(done, split("lcp", {"1", "2", "3", "4", "5"}));
    assert_true(names_in(work("out"))
                == std::vector<std::string>({"A 50mm f-1.4, crop 1.6.lcp", "A 50mm f-1.4, crop 1.lcp",
                                             "_..-B- -x-, crop 1.lcp", "a 50MM F-1.4, crop 1 (2).lcp"}));
    fs::remove_all(work("out"));
    must_exit(done, split("blob", {"--lens", "A 50mm f/1.4"}));
    assert_true(names_in(work("out"))
                == std::vector<std::string>(
                    {"A 50mm f-1.4 1.blob", "A 50mm f-1.4 2.blob", "A 50mm f-1.4 5.blob", "a 50MM F-1.4 3.blob"}));
}

void test_refusals(void **) {
    make_db({{"A", 1, 2}, {"B", -1, 2}});
    assert_refused(usage, {"profile", "export", "--all", "--split", "-o", work("out"), "--db", work("p.db")},
                   {"--format"});
    assert_refused(usage, split("map", {"--all"}), {"map"});
    assert_refused(usage, split("opcodes", {"--all"}), {"opcodes"});
    assert_refused(usage, split("alsc", {"--all"}), {"--encoding frame"});
    assert_refused(usage, split("blob", {"--all", "--encoding", "covariance=yes"}), {"--encoding covariance=yes"});
    assert_refused(not_found, split("json", {"--lens", "C"}), {"C"});
    save_text(work("file"), "");
    assert_refused(
        usage, {"profile", "export", "--all", "--split", "--format", "json", "-o", work("file"), "--db", work("p.db")},
        {work("file"), "folder"});
}

// A profile with curves given by their kind takes less than 1 kB; others include their samples.
void test_json_has_samples_of_tables_alone(void **) {
    make_db({{"A", 1, 2}});
    must_exit(done, {"profile", "export", "1", "-o", work("one.json"), "--db", work("p.db")});
    assert_true(fs::file_size(work("one.json")) < 1000);
    Json table = json_in("one.json");
    table["response"] = {{"kind", "table"}, {"values", {{0, 0.7, 1}}}};
    save_text(work("table.json"), table.dump());
    must_exit(done, {"profile", "import", work("table.json"), "--db", work("p.db")});
    must_exit(done, {"profile", "export", "2", "-o", work("two.json"), "--db", work("p.db")});
    assert_int_equal(json_in("two.json")["response"]["values"][0].size(), 1024);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_a_file_for_each_lens),
        CLI_TEST(test_formats_that_hold_less),
        CLI_TEST(test_refusals),
        CLI_TEST(test_json_has_samples_of_tables_alone),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
