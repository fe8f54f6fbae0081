// `lensprof profile merge`, `check` and `stats`: whole databases.
#include "cli_runs.hpp"

#include <sqlite3.h>

using namespace cli_runs;
using namespace picture_files;

namespace {

// A database with one imported lens and these falloffs.
std::string make_db(const std::string &name, const std::string &lens, const std::vector<LensfunEntry> &entries) {
    save_text(work(name + ".xml"), lensfun_text(lens, entries));
    must_exit(done, {"profile", "import", "--db", work(name), work(name + ".xml")});
    return work(name);
}

void run_sql(const std::string &file, const std::string &sql) {
    sqlite3 *db = nullptr;
    assert_int_equal(sqlite3_open(file.c_str(), &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(db);
}

size_t profiles_in(const std::string &file) {
    return json_of({"profile", "list", "--db", file, "--json"})["profiles"].size();
}

Words merge_into(const std::string &db) { return {"profile", "merge", "--db", db}; }

void test_merge(void **) {
    const std::string a = make_db("a.db", "50mm", {{50, 2, -0.4}, {50, 4, -0.2}});
    const std::string b = make_db("b.db", "85mm", {{85, 2, -0.4}}), all = work("all.db");
    const std::string said = must_exit(done, merge_into(all) + Words{a, b});
    assert_true(contains(said, a + ": 2 profiles added to " + all + ", 0 were already there"));
    assert_true(contains(said, b + ": 1 profile added"));
    const Json again = json_of(merge_into(all) + Words{b, a, "--json"});
    assert_string_equal(again["merged"][1]["file"].get<std::string>().c_str(), a.c_str());
    for (size_t i = 0; i < 2; i++) assert_int_equal(again["merged"][i]["added"], 0);
    assert_int_equal(again["merged"][1]["known"], 2);
    assert_int_equal(profiles_in(all), 3);
    const Json there = json_of({"profile", "list", "--db", all, "--json"}),
               here = json_of({"profile", "list", "--db", a, "--json"});
    assert_true(there["profiles"][0]["provenance"] == here["profiles"][0]["provenance"]);
}

void test_merge_refuses(void **) {
    const std::string a = make_db("a.db", "50mm", {{50, 2, -0.4}}), b = make_db("b.db", "85mm", {{85, 2, -0.4}});
    const std::string all = make_db("all.db", "24mm", {{24, 2, -0.4}}), fresh = work("fresh.db");
    fs::create_hard_link(a, work("hard.db"));
    for (const std::string &db : {all, fresh}) {
        assert_refused(usage, merge_into(db) + Words{b, db}, {db, "database itself"});
        assert_refused(not_found, merge_into(db) + Words{b, work("none.db")}, {"none.db"});
        assert_refused(store_failed, merge_into(db) + Words{b, work("a.db.xml")},
                       {"a.db.xml", "not a lensprof database"});
    }
    assert_refused(usage, merge_into(a) + Words{work("hard.db")}, {"hard.db", "database itself"});
    assert_refused(usage, merge_into(all), {"FILE"});
    run_sql(a, "UPDATE vignettings SET k1 = -7");
    for (const std::string &db : {all, fresh})
        assert_refused(store_failed, merge_into(db) + Words{b, a}, {"a.db", "profile 1 is damaged"});
    run_sql(a, "PRAGMA user_version = 99");
    assert_refused(store_failed, merge_into(all) + Words{b, a}, {"a.db", "layout 99"});
    assert_int_equal(profiles_in(all), 1);
}

void test_check(void **) {
    const std::string a = make_db("a.db", "50mm", {{50, 2, -0.4}, {50, 4, -0.2}, {50, 8, -0.1}});
    const Words check = {"profile", "check", "--db", a};
    const Disk before = disk();
    assert_string_equal(must_exit(done, check).c_str(), (a + ": 3 profiles read, 0 faults\n").c_str());
    assert_string_equal(difference(before, disk()).c_str(), "");
    run_sql(a,
            "PRAGMA foreign_keys = OFF; UPDATE vignettings SET k1 = -7 WHERE profile_id IN (1, 3);"
            "INSERT INTO vignettings VALUES (77, 0, 0.0, 0.0, 0.0, 0.0, 0.0)");
    const std::string said = must_exit(store_failed, check);
    for (const char *line : {"profile 1: ", "profile 3: ", "profile 77: a row of vignettings without its profile\n",
                             ": 3 profiles read, 3 faults\n"})
        assert_true(contains(said, line));
    const Json json = json_of(check + Words{"--json"}, store_failed);
    assert_int_equal(json["faults"].size(), 3);
    assert_int_equal(json["faults"][0]["id"], 77);
    assert_int_equal(json["faults"][2]["id"], 3);
    assert_int_equal(json["profiles"], 3);
    for (const char *id : {"1", "3"}) must_exit(done, {"profile", "remove", "--db", a, id});
    assert_refused(not_found, {"profile", "check", "--db", work("none.db")}, {"none.db"});
    assert_refused(store_failed, {"profile", "check", "--db", work("a.db.xml")}, {"a.db.xml"});
    assert_refused(usage, {"profile", "check", "--db", a, "1"}, {"1"});
}

// A damaged row does not end a list: the others are listed, the row is named.
void test_list_with_a_damaged_row(void **) {
    const std::string a = make_db("a.db", "50mm", {{50, 2, -0.4}, {50, 4, -0.2}, {50, 8, -0.1}});
    run_sql(a, "PRAGMA ignore_check_constraints = ON; UPDATE profiles SET aperture = -2.0 WHERE id = 2");
    const Words list = {"profile", "list", "--db", a};
    const Outcome outcome = run_words(list);
    assert_int_equal(outcome.code, store_failed);
    assert_true(contains(outcome.err, a + ": profile 2 is damaged (aperture)"));
    for (const char *id : {"\n     1 ", "\n     3 "}) assert_true(contains(outcome.out, id));
    assert_false(contains(outcome.out, "\n     2 "));
    const Json json = json_of(list + Words{"--json"}, store_failed);
    assert_int_equal(json["profiles"].size(), 2);
    assert_true(json["damaged"] == Json::array({2}));
    must_exit(done, {"profile", "remove", "--db", a, "2"});
    assert_int_equal(json_of(list + Words{"--json"})["damaged"].size(), 0);
}

void test_stats(void **) {
    const std::string a = make_db("a.db", "50mm", {{50, 2, -0.4, 0.0, 0.45}, {50, 4, -0.2}, {24, 4, -0.6}});
    const std::string said = must_exit(done, {"profile", "stats", "--db", a});
    for (const char *line : {"layout 7", "3 of 0 cameras, 1 lens, 0 single units", "3 raw, 0 jpeg", "24 mm to 50 mm",
                             "f/2 to f/4", "0.45 m to inf m", "import", "a.db.xml"})
        if (!contains(said, line)) fail_msg("no %s in %s", line, said.c_str());
    const Json json = json_of({"profile", "stats", "--db", a, "--json"});
    assert_int_equal(json["profiles"], 3);
    assert_string_equal(json["distance_m"][1].get<std::string>().c_str(), "infinity");
    assert_int_equal(json["methods"][0]["profiles"], 3);
    assert_int_equal(json["bytes"].get<uint64_t>(), fs::file_size(a));
    assert_refused(not_found, {"profile", "stats", "--db", work("none.db")}, {"none.db"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_merge), CLI_TEST(test_merge_refuses), CLI_TEST(test_check),
                                CLI_TEST(test_list_with_a_damaged_row), CLI_TEST(test_stats)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
