// `lensprof profile lenses | cameras | set`, `list` and `remove` of what matches.
#include "cli_runs.hpp"

#include <lensprof/store.h>

using namespace cli_runs;

namespace {

Words db_words() { return {"--db", work("p.db")}; }

Json one_of(const char *camera, const char *lens, double focal_mm, double aperture) {
    return {{"key",
             {{"camera_maker", *camera ? "Canon" : ""},
              {"camera_model", camera},
              {"lens", lens},
              {"focal_mm", focal_mm},
              {"aperture", aperture},
              {"processing", "raw"}}},
            {"vignetting", {{"k", {{-0.3, 0, 0}}}}}};
}

void make_db() {
    const Json all = {
        one_of("Canon EOS 6D", "EF24-70mm f/2.8L USM", 24, 2.8), one_of("Canon EOS 6D", "EF24-70mm f/2.8L USM", 70, 8),
        one_of("", "Sony FE 24-70mm f/2.8 GM", 24, 4), one_of("Canon EOS R6", "RF50mm F1.8 STM", 50, 1.8)};
    save_text(work("all.json"), Json{{"schema", 1}, {"profiles", all}}.dump());
    must_exit(done, Words{"profile", "import", work("all.json")} + db_words());
}

size_t listed(const Words &filter) {
    return json_of(Words{"profile", "list", "--json"} + filter + db_words())["profiles"].size();
}

void test_lenses_and_cameras(void **) {
    make_db();
    const Json lenses = json_of(Words{"profile", "lenses", "24-70", "--json"} + db_words())["lenses"];
    assert_int_equal(lenses.size(), 2);
    assert_true(lenses[0]
                == parsed(R"({"lens":"EF24-70mm f/2.8L USM","profiles":2,"cameras":1,"raw":2,"jpeg":0,)"
                          R"("corrected":0,"focal_mm":[24,70],"aperture":[2.8,8],"distance_m":null})"));
    const std::string text = must_exit(done, Words{"profile", "lenses", "FE", "24-70"} + db_words());
    assert_true(contains(text, "Sony FE 24-70mm f/2.8 GM") && contains(text, "1 lens\n"));
    const std::string cameras = must_exit(done, Words{"profile", "cameras"} + db_words());
    assert_true(contains(cameras, "  Canon EOS 6D\n") && contains(cameras, "2 cameras\n"));
    assert_false(contains(cameras, "Canon Canon"));
    assert_int_equal(json_of(Words{"profile", "cameras", "nikon", "--json"} + db_words())["cameras"].size(), 0);
    assert_refused(not_found, {"profile", "lenses", "--db", work("none.db")}, {work("none.db")});
}

void test_filters_take_parts_of_names(void **) {
    make_db();
    assert_int_equal(listed({"--lens", "24-70"}), 3);
    assert_int_equal(listed({"--lens", "canon ef 24-70MM f/2.8l usm"}), 2);
    assert_int_equal(listed({"--lens", "24-70", "--aperture", "4"}), 1);
    assert_int_equal(listed({"--camera", "r6"}), 1);
    assert_int_equal(listed({"--camera", "6d", "--lens", "sony"}), 0);
    assert_true(contains(must_exit(done, Words{"profile", "list", "--lens", "85mm"} + db_words()), "0 profiles"));
    assert_refused(not_found, Words{"profile", "show", "--lens", "85mm"} + db_words(), {"85mm"});
}

// As text and as JSON; not if the lens is stored and only the setting is missing.
void test_nearest_names(void **) {
    make_db();
    const Words query = Words{"query", "--key", "maker=Canon"} + db_words();
    const Words other = {"--lens", "EF24-70mm f/4L IS USM", "--aperture", "4", "--focal", "24"};
    const std::string nearest = "; nearest names: EF24-70mm f/2.8L USM";
    assert_refused(not_found, query + other, {nearest});
    const Json json = json_of(query + other + Words{"--json"}, not_found);
    assert_string_equal(json["nearest"][0].get<std::string>().c_str(), "EF24-70mm f/2.8L USM");
    assert_true(json["nearest"].size() == 1 && contains(json["reason"].get<std::string>(), nearest));
    const Words far = {"--lens", "EF24-70mm f/2.8L USM", "--aperture", "64", "--focal", "24"};
    assert_true(json_of(query + far + Words{"--json"}, not_found)["nearest"].empty());
    assert_false(contains(run_words(query + far).err, "nearest names"));
}

void test_nearest_cameras(void **) {
    make_db();
    const Words query = Words{"query", "--aperture", "4"} + db_words();
    for (const char *name : {"EOS 6E", "Canon EOS 6E"}) {
        assert_refused(not_found, query + Words{"--camera", name}, {"; nearest names: Canon EOS 6D; Canon EOS R6"});
        const Json json = json_of(query + Words{"--camera", name, "--json"}, not_found);
        assert_true(json["nearest"] == Json({"Canon EOS 6D", "Canon EOS R6"}));
    }
    assert_false(contains(run_words(query + Words{"--camera", "COOLPIX P7000"}).err, "nearest names"));
}

void test_remove_what_matches(void **) {
    make_db();
    const Words remove = Words{"profile", "remove"} + db_words();
    assert_refused(usage, remove + Words{"--lens", "24-70"}, {"would remove 3 profiles", work("p.db"), "--yes"});
    assert_refused(usage, remove + Words{"--yes"}, {"give ids"});
    assert_refused(not_found, remove + Words{"--lens", "85mm", "--yes"}, {"85mm"});
    assert_refused(not_found, remove + Words{"1", "9"}, {"9"});
    assert_int_equal(listed({}), 4);  // nothing is removed, because one id does not exist
    assert_true(json_of(remove + Words{"1", "4", "--json"})["removed"] == Json({1, 4}));
    assert_true(contains(must_exit(done, remove + Words{"--lens", "24-70", "--yes"}), "removed 2 profiles"));
    assert_int_equal(listed({}), 0);
}

void test_set(void **) {
    make_db();
    const Words set = Words{"profile", "set"} + db_words();
    assert_true(contains(must_exit(done, set
                                             + Words{"1", "2", "--lens", "My Lens", "--key",
                                                     "distance=3m,crop-factor=1.5", "--clear", "aperture"}),
                         "changed 2 profiles"));
    const Json key = json_of(Words{"profile", "show", "2", "--json"} + db_words())["key"];
    assert_true(key["lens"] == "My Lens" && key["camera_model"] == "Canon EOS 6D" && key["aperture"].is_null());
    assert_true(key["distance_m"] == 3 && key["crop_factor"] == 1.5 && key["focal_mm"] == 70);
    assert_int_equal(listed({"--lens", "my lens"}), 2);
    const Bytes before = load(work("p.db"));
    assert_refused(usage, set, {"ids"});
    assert_refused(usage, set + Words{"1"}, {"--lens"});
    assert_refused(usage, set + Words{"1", "--clear", "lens"}, {"--clear"});
    assert_refused(usage, set + Words{"1", "--lens", std::string(200, 'x')}, {"--lens"});
    assert_refused(not_found, set + Words{"1", "77", "--aperture", "4"}, {"77"});
    assert_true(json_of(Words{"profile", "show", "1", "--json"} + db_words())["key"]["aperture"].is_null());
    assert_true(load(work("p.db")) == before);
}

// A camera is listed once with a maker and once without; every member of a key can be set, but not in two ways.
void test_each_once(void **) {
    const std::string db = work("once.db");
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(db.c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_profile_init(profile.get());
    std::strcpy(profile->key.camera_model, "EOS 5D");
    assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
    std::strcpy(profile->key.camera_maker, "Canon");
    assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
    lensprof_store_close(store);
    const Words at = {"--db", db};
    assert_int_equal(json_of(Words{"profile", "list", "--camera", "EOS 5D", "--json"} + at)["profiles"].size(), 2);
    must_exit(done, Words{"profile", "set", "1", "1", "--key", "style=Vivid"} + at);
    assert_true(json_of(Words{"profile", "show", "1", "--json"} + at)["key"]["style"] == "Vivid");
    assert_refused(usage, Words{"profile", "set", "1", "--focal", "60", "--clear", "focal"} + at, {"--clear"});
    assert_refused(usage, Words{"profile", "set", "1", "--key", "crop-factor=2", "--clear", "crop-factor"} + at,
                   {"--clear"});
    assert_refused(usage, Words{"profile", "set", "1", "--key", "unit=7", "--clear", "unit"} + at, {"--clear"});
    must_exit(done, Words{"profile", "remove", "1", "1"} + at);
    must_exit(done, Words{"profile", "remove", "--camera", "EOS 5D", "--yes"} + at);
}

// The installed database is read after the user's own, or alone; changes and ids always refer to the user's own.
void test_installed_database(void **) {
    make_db();
    const std::string own = work("data/lensprof/profiles.db"), installed = work("share/lensprof/lensfun.db");
    fs::create_directories(fs::path(installed).parent_path());
    fs::rename(work("p.db"), installed);
    const Words lenses = {"profile", "lenses"}, cameras = {"profile", "cameras"}, list = {"profile", "list"},
                stats = {"profile", "stats"}, show = {"profile", "show", "--lens", "24-70", "--focal", "70"};
    for (const Words &words : {lenses, cameras, list, stats, show})
        assert_false(contains(must_exit(done, words), "  in "));  // with a single database it is not named
    assert_int_equal(json_of(stats + Words{"--json"})["profiles"], 4);
    must_exit(done, {"profile", "export", "1", "-o", work("one.json")});
    assert_false(fs::exists(own));

    save_text(work("own.json"), Json{{"schema", 1}, {"profiles", {one_of("Mine", "My 24-70mm", 70, 4)}}}.dump());
    const Bytes before = load(installed);
    must_exit(done, {"profile", "import", work("own.json")});
    assert_true(load(installed) == before);
    for (const Words &words : {lenses, cameras, list}) {
        const std::string text = must_exit(done, words);
        assert_true(text.find("  in " + own) < text.find("  in " + installed));
        assert_true(contains(text, "  in " + installed));
    }
    const Json all = json_of(list + Words{"--json"})["profiles"];
    assert_int_equal(all.size(), 5);
    assert_true(all[0]["database"] == own && all[1]["database"] == installed);
    assert_true(json_of(lenses + Words{"--json", "FE"})["lenses"][0]["database"] == installed);
    const Json counts = json_of(stats + Words{"--json"});
    assert_true(counts["file"] == own && counts["profiles"] == 1);
    assert_true(counts["others"][0]["file"] == installed && counts["others"][0]["profiles"] == 4);
    const std::string shown = must_exit(done, show);
    assert_true(contains(shown, "database  " + own) && contains(shown, "database  " + installed));
    assert_true(json_of({"profile", "show", "1", "--json"})["key"]["lens"] == "My 24-70mm");
    assert_refused(not_found, {"profile", "show", "2"}, {own});

    const auto exported = [](const Words &which) {
        return json_of(Words{"profile", "export", "--format", "json", "-o", work("out.json"), "--json"} + which);
    };
    assert_int_equal(exported({"--all"})["profiles"].size(), 1);
    assert_int_equal(exported({"--lens", "24-70"})["profiles"].size(), 1);  // the user's own takes precedence
    assert_int_equal(exported({"--lens", "RF50mm"})["profiles"].size(), 1);
    assert_refused(usage, {"profile", "export", "1", "-o", installed, "--format", "json"}, {"is the profile database"});
    must_exit(done, {"profile", "remove", "--lens", "24-70", "--yes"});
    assert_true(load(installed) == before);
    assert_int_equal(json_of(list + Words{"--json"})["profiles"].size(), 4);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_lenses_and_cameras),  CLI_TEST(test_filters_take_parts_of_names),
                                CLI_TEST(test_nearest_names),       CLI_TEST(test_nearest_cameras),
                                CLI_TEST(test_remove_what_matches), CLI_TEST(test_set),
                                CLI_TEST(test_each_once),           CLI_TEST(test_installed_database)};
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
