// Every option of every command, as `lensprof help` lists them; words that are nearly right; numbers with units.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

// The first words of the lines of a section of a help text, "  WORD  about".
Words section_of(const std::string &help, const std::string &title) {
    std::istringstream lines(help);
    Words words;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && line[0] != ' ') inside = line == title + ":";
        if (inside && line.size() > 2 && line[0] == ' ' && line[2] != ' ')
            words.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    return words;
}

// All commands and verbs, as words.
std::vector<Words> all_commands() {
    std::vector<Words> commands;
    for (const std::string &name : section_of(must_exit(done, {"help"}), "Commands")) {
        const Words verbs = section_of(must_exit(done, {"help", name}), "Commands");
        if (verbs.empty()) commands.push_back({name});
        for (const std::string &verb : verbs) commands.push_back({name, verb});
    }
    return commands;
}

// "--seed" of "  --seed COUNT   about", "--output" of "  -o,--output FILE   about", for options that take a value.
Words options_with_values(const std::string &help) {
    std::istringstream lines(help);
    Words options;
    for (std::string line; std::getline(lines, line);) {
        const auto match = find_pattern("^  (-[a-z],)?(--[a-z-]+) [^ ]", line);
        if (!match.empty()) options.push_back(line.substr(match[2].first, match[2].second));
    }
    return options;
}

void test_all_commands_are_walked(void **) {
    const std::vector<Words> commands = all_commands();
    assert_int_equal(commands.size(), 9 + 8);
    size_t options = 0;
    for (const Words &command : commands)
        options += options_with_values(must_exit(done, Words{"help"} + command)).size();
    assert_true(options > 150);
}

void assert_wrong_usage(const Words &words, const std::string &named) {
    const Outcome outcome = run_words(words);
    if (outcome.code != usage || !contains(outcome.err, named))
        fail_msg("%s: exit code %d: %s", joined(words).c_str(), outcome.code, outcome.err.c_str());
}

// An empty value is what a shell makes of a variable that is not set.
void test_no_value_may_be_empty(void **) {
    for (const Words &command : all_commands()) {
        const std::string help = must_exit(done, Words{"help"} + command);
        for (const std::string &option : options_with_values(help)) {
            assert_wrong_usage(command + Words{option, ""}, option + ": ");
            assert_wrong_usage(command + Words{option + "="}, option + ": ");
        }
        for (const std::string &name : section_of(help, "Positionals"))
            assert_wrong_usage(command + Words{""}, name + ": ");
    }
    assert_refused(usage, {"query", "--camera", "x", "--json="}, {"--json: its value is empty"});
}

void test_the_nearest_is_named(void **) {
    const struct {
        Words words;
        const char *said;
    } cases[] = {
        {{"build", scene("pano.pto"), "--prioor", "1"}, "--prioor: no such option; did you mean --prior?"},
        {{"build", scene("pano.pto"), "--max-sied=800"}, "--max-sied: no such option; did you mean --max-side?"},
        {{"apply", "--outptu", "x"}, "--outptu: no such option; did you mean --output?"},
        {{"profile", "list", "--cmaera", "x"}, "--cmaera: no such option; did you mean --camera?"},
        {{"profile", "lsit"}, "profile lsit: no such verb; did you mean list?"},
        {{"help", "profile", "exprot"}, "profile exprot: no such verb; did you mean export?"},
        {{"biuld"}, "biuld: no such command; did you mean build?"},
        {{"help", "qurey"}, "qurey: no such command; did you mean query?"},
    };
    for (const auto &one : cases) assert_refused(usage, one.words, {one.said});
    const Words far = {"query", "--zzzzzz", "1"};
    assert_refused(usage, far, {"--zzzzzz: no such option; see"});
    assert_refused(usage, {"profile"}, {"name one of its verbs", "list", "stats"});
    assert_refused(usage, {"profile", "check", "more"}, {"more"});
}

void test_help_of_a_verb(void **) {
    for (const Words &command : all_commands()) {
        const std::string help = must_exit(done, Words{"help"} + command);
        assert_string_equal(help.c_str(), must_exit(done, command + Words{"--help"}).c_str());
        assert_true(contains(help, "Usage: lensprof " + command[0]));
    }
}

// Typed values: what stands in the database is what was meant.
void test_units(void **) {
    const Json plain = json_of(Words{"build", scene("pano.pto"), "--db", work("p.db"), "--json", "--camera", "X",
                                     "--focal", "24", "--aperture", "4", "--distance", "3"}
                               + quick);
    assert_int_equal(plain["profile"].get<int>(), 1);
    for (const Words &words : {Words{"--focal", "24mm"}, Words{"--focal", "24 mm"}, Words{"--aperture", "f/4"},
                               Words{"--aperture", "F4"}, Words{"--aperture", "f4"}, Words{"--aperture", "F/4"},
                               Words{"--distance", "3m"}, Words{"--distance", "3 m"}}) {
        const Json list = json_of(Words{"profile", "list", "--db", work("p.db"), "--json"} + words);
        assert_int_equal(list["profiles"].size(), 1);
    }
    const Json none = json_of({"profile", "list", "--db", work("p.db"), "--json", "--focal", "25mm"});
    assert_int_equal(none["profiles"].size(), 0);
    const struct {
        Words words;
        const char *said;
    } wrong[] = {
        {{"--focal", "24m"}, "'m' is not the unit of a focal length"},
        {{"--focal", "2.4cm"}, "'cm' is not the unit"},
        {{"--aperture", "4mm"}, "'mm' is not the unit of an aperture"},
        {{"--distance", "3mm"}, "'mm' is not the unit of a distance"},
        {{"--focal", "f/4"}, "f/4"},
        {{"--aperture", "f/"}, "f/"},
        {{"--aperture", "1/2.8"}, "'/2.8' is not the unit of an aperture"},
        {{"--focal", "1/60"}, "'/60' is not the unit of a focal length"},
        {{"--distance", "3 m m"}, "3 m m"},
        {{"--distance", "nan"}, "nan"},
    };
    for (const auto &one : wrong)
        assert_refused(usage, Words{"query", "--camera", "X", "--db", work("p.db")} + one.words,
                       {one.words[0] + ": ", one.said});
    const Words bracket = {"bracket", scene("img000.png"), scene("img001.png"), "--no-store", "--times"};
    for (const char *times : {"1/60ms,1/30", "1/0,1", "1/60,", ",1", "1/60s,1m"})
        assert_refused(usage, bracket + Words{times}, {"--times: "});
    assert_refused(usage, bracket + Words{"1/60"}, {"--times: 1 values for 2 pictures"});
}

// Times with and without units are the same exposures.
void test_times_with_units(void **) {
    const auto exposures = [](const char *times) {
        const Outcome outcome = run_words({"bracket", scene("img000.png"), scene("img001.png"), "--no-store", "--json",
                                           "--pairs", "500", "--modes", "3", "--times", times});
        return outcome.code == done || outcome.code == not_usable
                   ? replaced(outcome.out, "\"seconds\":\\{[^}]*\\}", "") + outcome.err
                   : std::string("refused: ") + outcome.err;
    };
    const std::string plain = exposures("1/60,0.5");
    assert_false(contains(plain, "refused"));
    assert_string_equal(exposures("1/60s,0.5s").c_str(), plain.c_str());
    assert_string_equal(exposures("1/60 s,0.5").c_str(), plain.c_str());
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_all_commands_are_walked),
        CLI_TEST(test_no_value_may_be_empty),
        CLI_TEST(test_the_nearest_is_named),
        CLI_TEST(test_help_of_a_verb),
        CLI_TEST(test_units),
        CLI_TEST(test_times_with_units),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
