// `lensprof doctor`.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

void test_databases(void **) {
    const Outcome none = run_words({"doctor"});
    assert_true(contains(none.out, "profiles.db (your own): not found"));
    must_exit(done, Words{"build", scene("pano.pto"), "--camera", "C", "--lens", "L"} + quick);
    assert_true(contains(run_words({"doctor"}).out, "1 profile, 1 lens, 1 camera"));
    const Json json = json_of({"doctor", "--json"});
    assert_int_equal(json["databases"][0]["profiles"].get<int>(), 1);
    assert_true(json["libraries"].contains("OpenCV"));
}

void test_damaged(void **) {
    save_text(work("a.db"), "SQLite format 3 and nothing more");
    const Outcome outcome = run_words({"doctor", "--db", work("a.db")});
    assert_int_equal(outcome.code, store_failed);
    assert_true(contains(outcome.out, work("a.db")) && contains(outcome.out, "cannot be read"));
    assert_int_equal(load(work("a.db")).size(), 32);  // unchanged
}

// Its purpose: a faulty installation.
void test_no_home(void **) {
    const std::string data = getenv("XDG_DATA_HOME"), home = getenv("HOME") ? getenv("HOME") : "";
    unsetenv("XDG_DATA_HOME");
    unsetenv("HOME");
    const Outcome outcome = run_words({"doctor"});
    setenv("XDG_DATA_HOME", data.c_str(), 1);
    if (!home.empty()) setenv("HOME", home.c_str(), 1);
    assert_int_equal(outcome.code, store_failed);
    assert_true(contains(outcome.out, "lensprof ") && contains(outcome.out, "OpenCV"));
    for (const std::string &odd : {work("none.db"), work("")}) {
        const Outcome refused = run_words({"doctor", "--db", odd});
        assert_int_equal(refused.code, store_failed);
        assert_true(contains(refused.out, odd) && contains(refused.out, "cannot be read"));
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_databases), CLI_TEST(test_damaged), CLI_TEST(test_no_home)};
    return cmocka_run_group_tests_name("doctor", tests, make_scene, remove_folder);
}
