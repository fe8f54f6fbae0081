// Every option of every command, as listed by `lensprof help`; misspelled words; numbers with units.
#include "help_runs.hpp"

using namespace help_runs;

namespace {

void test_all_commands_are_walked(void **) {
    const std::vector<Words> commands = all_commands();
    assert_int_equal(commands.size(), 16 + 11);
    size_t options = 0;
    for (const Words &command : commands)
        options += options_with_values(must_exit(done, command + Words{"--help-all"})).size();
    assert_true(options > 100);
}

void assert_wrong_usage(const Words &words, const std::string &named) {
    const Outcome outcome = run_words(words);
    if (outcome.code != usage || !contains(outcome.err, named))
        fail_msg("%s: exit code %d: %s", joined(words).c_str(), outcome.code, outcome.err.c_str());
}

// The shell turns an unset variable into an empty value.
void test_no_value_may_be_empty(void **) {
    for (const Words &command : all_commands()) {
        const std::string help = must_exit(done, command + Words{"--help-all"});
        for (const std::string &option : options_with_values(help)) {
            assert_wrong_usage(command + Words{option, ""}, option + ": ");
            assert_wrong_usage(command + Words{option + "="}, option + ": ");
        }
        for (const auto &[option, key] : keys_of(help))
            assert_wrong_usage(command + Words{option, key + "="}, option + " " + key + ": empty value");
        for (const std::string &name : section_of(help, "Positionals"))
            assert_wrong_usage(command + Words{""}, name + ": ");
    }
    assert_refused(usage, {"query", "--camera", "x", "--json="}, {"--json: takes no value"});
}

void test_the_nearest_is_named(void **) {
    const struct {
        Words words;
        const char *said;
    } cases[] = {
        {{"build", scene("pano.pto"), "--aprture", "1"}, "--aprture: no such option; did you mean --aperture?"},
        {{"build", scene("pano.pto"), "--fit", "max-sied=800"}, "--fit: max-sied is not a key; did you mean max-side?"},
        {{"apply", "--outptu", "x"}, "--outptu: no such option; did you mean --output?"},
        {{"profile", "list", "--cmaera", "x"}, "--cmaera: no such option; did you mean --camera?"},
        {{"profile", "lsit"}, "profile lsit: no such verb; did you mean list?"},
        {{"help", "profile", "exprot"}, "profile exprot: no such verb; did you mean export?"},
        {{"biuld"}, "biuld: no such command; did you mean build?"},
        {{"help", "qurey"}, "qurey: no such command; did you mean query?"},
        {{"apply", "--out", "x"}, "--out: no such option; did you mean --output?"},
        {{"apply", "--CONTACT-sheet", "x"}, "--CONTACT-sheet: no such option; did you mean --contact-sheet?"},
        {{"BUILD"}, "BUILD: no such command; did you mean build?"},
        {{"profile", "Exp"}, "profile Exp: no such verb; did you mean export?"},
    };
    for (const auto &one : cases) assert_refused(usage, one.words, {one.said});
    const Words far = {"query", "--zzzzzz", "1"};
    assert_refused(usage, far, {"--zzzzzz: no such option; see"});
    assert_refused(usage, {"profile"}, {"profile: give a subcommand", "list", "stats"});
    assert_refused(usage, {"profile", "check", "more"}, {"more: unexpected argument"});
    assert_refused(usage, {"help", "profile", "export", "more"}, {"has no verbs", "`lensprof help profile export`"});
}

// A word that starts with "-" is an option, not the value of the previous one, except for numbers and values after "=".
void test_options_are_no_values(void **) {
    const struct {
        Words words;
        const char *said;
    } cases[] = {
        {{"query", "--db", "--json", "--camera", "X"}, "--db: needs a value, but --json looks like an option"},
        {{"apply", "-o", "--linear", "x.png"}, "--output: needs a value, but --linear looks like an option"},
        {{"query", "--camera", "-X"}, "--camera: needs a value, but -X looks like an option"},
        {{"query", "--camera", "X", "--db", "-1.db"}, "--db: needs a value, but -1.db looks like an option"},
        {{"query", "--db=a", "--camera", "X", "--focal", "-1e-3"}, "--focal: -1e-3 is not a number"},
        {{"query", "--camera"}, "--camera: needs a value; give --camera TEXT"},
        {{"query", "--camera", "--", "X"}, "--camera: needs a value"},
        {{"profile", "check", "--db", "a", "--db", "b"}, "--db: given more than once; give it once"},
        {{"query", "--json=maybe"}, "--json: takes no value, but maybe was given; give --json alone"},
        {{"simulate"}, "--output: missing; give --output FOLDER"},
        {{"build"}, "FILE: missing; give FILE"},
        {{"apply", "-x.png"}, "-x.png: no such option; see `lensprof apply --help`, or put -- before names"},
        {{"apply", "-y"}, "-y: no such option; did you mean -h? Otherwise put -- before names that start with -\n"},
        {{"apply", "--jsn"}, "--jsn: no such option; did you mean --json?\n"},
        {{"query", "-y"}, "-y: no such option; did you mean -h?\n"},
        {{"build", "a.pto", "b.pto"}, "a.pto: is neither a picture (.jpg, .png, .tif) nor a folder"},
        {{"query", "a"}, "a: unexpected argument"},
    };
    for (const auto &one : cases) assert_refused(usage, one.words, {one.said});
    assert_refused(unreadable, {"bracket", "-", scene("img000.png"), "--no-store", "--ev", "-1.5,-.5"}, {"-: cannot"});
    assert_refused(not_found, {"query", "--db=-x.db", "--camera=-X", "--json=false"}, {"-x.db: no such file"});
}

// A word in brackets is not a list, and messages quote it as given.
void test_words_within_brackets(void **) {
    assert_refused(usage, {"profile", "show", "[1]"}, {": [1] is not a profile id; see"});
    assert_refused(usage, {"help", "[x]"}, {"lensprof: [x]: no such command"});
    assert_refused(not_found, {"query", "--camera", "[X,Y]", "--db", work("[p.db]")}, {work("[p.db]")});
    const std::string copy = copy_of("scene"), before = fs::current_path().string();
    fs::rename(copy + "/img000.png", copy + "/[x]");
    fs::current_path(copy);
    const Outcome outcome = run_words({"bracket", "[x]", "img001.png", "--no-store", "--json", "--fit", "pairs=300"});
    fs::current_path(before);
    if (!contains(outcome.out, "\"file\":\"[x]\"")) fail_msg("%s%s", outcome.out.c_str(), outcome.err.c_str());
}

// Like "--output=FILE" and "-oFILE".
void test_a_short_option_with_an_equals_sign(void **) {
    const std::string out = work("out");
    must_exit(done, {"simulate", "-o=" + out, "--images", "2", "--size", "40x30"});
    assert_true(fs::exists(out + "/pano.pto"));
    assert_refused(usage, {"simulate", "-o="}, {"--output: empty folder name; give one"});
}

// "--" ends the options at any position.
void test_two_dashes_end_options(void **) {
    const std::string copy = copy_of("scene");
    must_exit(done, Words{"build", copy + "/pano.pto", "--db", work("p.db")} + quick);
    const Words query = {"query", "--camera", "Simulated Camera", "--db", work("p.db")};
    const std::string plain = must_exit(done, query);
    assert_string_equal(must_exit(done, query + Words{"--"}).c_str(), plain.c_str());
    assert_refused(usage, query + Words{"--", "more"}, {"more: unexpected argument"});
    assert_refused(usage, query + Words{"--", "--help"}, {"--help: unexpected argument"});
    const Words apply = {"apply", "--profile", "1", "--db", work("p.db"), copy + "/img000.png"};
    for (const char *name : {"-x.png", "--", "--json", "[a,b]"})
        assert_refused(unreadable, apply + Words{"--output", work("out"), "--", name},
                       {std::string(name) + ": cannot"});
    assert_refused(unreadable, apply + Words{"--", "--output", work("out")}, {"--output: cannot"});
}

// Descriptions are wrapped, and footers are written to fit.
void test_help_fits_100_columns(void **) {
    std::vector<Words> commands = all_commands();
    commands.push_back({"profile"});
    commands.push_back({});
    for (const Words &command : commands) {
        std::istringstream help(must_exit(done, command + Words{"--help-all"}));
        for (std::string line; std::getline(help, line);)
            if (line.size() > 100) fail_msg("%s", line.c_str());
    }
}

// Results are the same; messages are omitted, or include the time of each step.
void test_quiet_and_verbose(void **) {
    const Words build = Words{"build", scene("pano.pto"), "--no-store", "--fit", "gamma-from=exif"} + quick;
    const Outcome normal = run_words(build), silent = run_words(build + Words{"-q"}),
                  verbose = run_words(build + Words{"--verbose"});
    assert_int_equal(normal.code, done);
    assert_true(contains(normal.err, "warning: ") && !contains(normal.err, "sampling"));
    assert_string_equal(silent.err.c_str(), "");
    for (const Outcome *outcome : {&silent, &verbose})  // the table; the time differs
        assert_string_equal(outcome->out.substr(0, 400).c_str(), normal.out.substr(0, 400).c_str());
    for (const char *part : {"warning: ", "lensprof: sampling: ", "lensprof: fitting: ", " s, CPU ", " MB of memory"})
        assert_true(contains(verbose.err, part));
    assert_false(contains(normal.err + verbose.err, "\x1b"));  // not a terminal
    assert_refused(usage, build + Words{"-q", "-v"}, {"--quiet and --verbose exclude each other"});
    assert_refused(unreadable, {"build", work("none.pto"), "--quiet"}, {"none.pto"});  // an error is printed
    assert_string_equal(run_words({"simulate", "-o", work("s"), "--images", "2", "--size", "64x48", "-q"}).err.c_str(),
                        "");
    const std::string progress =
        run_words({"simulate", "-o", work("s"), "--images", "2", "--size", "64x48", "--progress"}).err;
    assert_true(contains(progress, "rendering 100 %, 2 of 2"));
}

void test_version(void **) {
    const std::string version = must_exit(done, {"version"});
    for (const Words &words : {Words{"--version"}, Words{"--version", "query"}, Words{"--version", "--bogus"}})
        assert_string_equal(must_exit(done, words).c_str(), version.c_str());
    assert_refused(usage, {"query", "--version"}, {"--version: no such option"});
}

// A message mentions that a value is optional only if it is.
void test_empty_values_that_are_needed(void **) {
    const struct {
        Words words;
        const char *said;
    } cases[] = {
        {{"apply", "-o", ""}, "--output: empty folder name; give one, or omit the option\n"},
        {{"build", ""}, "FILE: empty file name; give one\n"},
        {{"build", "--db", ""}, "--db: empty file name; give one, or omit the option\n"},
        {{"query", "--camera="}, "--camera: empty value; give one, or omit the option\n"},
    };
    for (const auto &one : cases) assert_refused(usage, one.words, {one.said});
    const Words bracket = {"bracket", scene("img000.png"), scene("img001.png"), "--no-store", "--times"};
    for (const char *list : {"1,,2", ",1", "1,", ","})
        assert_refused(usage, bracket + Words{list},
                       {std::string("--times: ") + list + ": a value is missing before or after a comma"});
    assert_refused(usage, {"build", "x.pto", "--fit", "free=ev,"},
                   {"--fit free: ev,: a value is missing before or after a comma"});
}

// Whatever is echoed, a message is a single readable line.
void test_long_and_odd_words(void **) {
    const std::string word(100000, 'x'), db = work("none.db");
    const std::pair<int, Words> cases[] = {
        {usage, {word}},
        {usage, {"query", "--" + word}},
        {usage, {"query", word}},
        {usage, {"query", "--focal", word}},
        {usage, {"query", "--key", std::string("processing=") + word}},
        {store_failed, {"query", "--camera", "X", "--db", word}},
        {unreadable, {"apply", "--pto", word, "-o", work("out")}},
    };
    for (const auto &one : cases) {
        const Outcome outcome = run_words(one.second);
        if (outcome.err.size() > 2000)
            fail_msg("%s: %zu bytes", one.second[0].substr(0, 9).c_str(), outcome.err.size());
        if (one.first != outcome.code)
            fail_msg("%d, not %d: %s", outcome.code, one.first, outcome.err.substr(0, 400).c_str());
    }
    assert_string_equal(run_words({"\x1b[31mred\n\x7f"}).err.c_str(),
                        "lensprof: \\x1b[31mred\\x0a\\x7f: no such command; `lensprof help` lists them\n");
}

// Ids are as large as SQLite's.
void test_largest_ids(void **) {
    must_exit(done, Words{"build", scene("pano.pto"), "--db", work("p.db")} + quick);
    const Words db = {"--db", work("p.db")};
    for (const Words &verb : {Words{"show"}, Words{"remove"}, Words{"export", "-o", work("x.json")}}) {
        const Words words = Words{"profile"} + verb + db;
        assert_refused(not_found, words + Words{"9223372036854775807"}, {"no profile 9223372036854775807"});
        for (const char *id : {"9223372036854775808", "99999999999999999999999", "0", "1x"})
            assert_refused(usage, words + Words{id}, {std::string(id) + " is not a profile id; see"});
    }
}

void test_help_of_a_verb(void **) {
    for (const Words &command : all_commands()) {
        const std::string help = must_exit(done, Words{"help"} + command);
        assert_string_equal(help.c_str(), must_exit(done, command + Words{"--help"}).c_str());
        assert_true(contains(help, "Usage: lensprof " + command[0]));
    }
}

// Typed values: the database holds what was meant.
void test_units(void **) {
    const Json plain = json_of(Words{"build", scene("pano.pto"), "--db", work("p.db"), "--json", "--camera", "X",
                                     "--focal", "24", "--aperture", "4", "--key", "distance=3"}
                               + quick);
    assert_int_equal(plain["profile"].get<int>(), 1);
    for (const Words &words : {Words{"--focal", "24mm"}, Words{"--focal", "24 mm"}, Words{"--aperture", "f/4"},
                               Words{"--aperture", "F4"}, Words{"--aperture", "f4"}, Words{"--aperture", "F/4"},
                               Words{"--key", "distance=3m"}, Words{"--key", "distance=3 m"}}) {
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
        {{"--key", "distance=3mm"}, "--key distance: 3mm: 'mm' is not the unit of a distance"},
        {{"--focal", "f/4"}, "f/4"},
        {{"--aperture", "f/"}, "f/"},
        {{"--aperture", "1/2.8"}, "'/2.8' is not the unit of an aperture"},
        {{"--focal", "1/60"}, "'/60' is not the unit of a focal length"},
        {{"--key", "distance=3 m m"}, "3 m m"},
        {{"--key", "distance=nan"}, "nan"},
        {{"--focal", "0x18"}, "0x18 is not a number"},
        {{"--focal", "-0X1p3"}, "-0X1p3 is not a number"},
        {{"--focal", " 0x18"}, " 0x18 is not a number"},
        {{"--focal", " 24"}, " 24 is not a number"},
        {{"--focal", "inf"}, "inf is not a number"},
    };
    for (const auto &one : wrong)
        assert_refused(usage, Words{"query", "--camera", "X", "--db", work("p.db")} + one.words,
                       {one.words[0], one.said});
    const Words bracket = {"bracket", scene("img000.png"), scene("img001.png"), "--no-store", "--times"};
    for (const char *times : {"1/60ms,1/30", "1/0,1", "1/60,", ",1", "1/60s,1m", "1/ 0x2,1", "1/60, 1"})
        assert_refused(usage, bracket + Words{times}, {"--times: "});
    assert_refused(usage, bracket + Words{"1/60"}, {"--times: 1 value for 2 pictures"});
}

// Exposure times with and without units are the same.
void test_times_with_units(void **) {
    const auto exposures = [](const char *times) {
        const Outcome outcome = run_words({"bracket", scene("img000.png"), scene("img001.png"), "--no-store", "--json",
                                           "--fit", "pairs=500,modes=3", "--times", times});
        return outcome.code == done || outcome.code == not_usable
                   ? replaced(outcome.out, "\"seconds\":\\{[^}]*\\}", "") + outcome.err
                   : std::string("refused: ") + outcome.err;
    };
    const std::string plain = exposures("1/60,0.5");
    assert_false(contains(plain, "refused"));
    assert_string_equal(exposures("1/60s,0.5s").c_str(), plain.c_str());
    assert_string_equal(exposures("1/60 s,0.5").c_str(), plain.c_str());
}

void test_bad_options(void **) {
    const std::string pto = scene("pano.pto"), png = scene("img000.png");
    const Words cases[] = {
        {"build"},
        {"build", pto, pto},
        {"build", pto, "--frobnicate"},
        {"build", pto, "--fit", "modes=26"},
        {"build", pto, "--fit", "modes=-1"},
        {"build", pto, "--fit", "modes=3x"},
        {"build", pto, "--fit"},
        {"build", pto, "--fit", "modes"},
        {"build", pto, "--fit", "loss=l1"},
        {"build", pto, "--fit", "huber=0"},
        {"build", pto, "--fit", "prior=-1"},
        {"build", pto, "--fit", "free=everything"},
        {"build", pto, "--fit", "reference=4"},
        {"build", pto, "--fit", "reference=img009.png"},
        {"build", pto, "--fit", "pairs=-1"},
        {"build", pto, "--fit", "pairs=99999999"},
        {"build", pto, "--fit", "seed=-1"},
        {"build", pto, "--fit", "seed=x"},
        {"build", pto, "--fit", "max-side=-5"},
        {"build", pto, "--focal", "0"},
        {"build", pto, "--aperture", "-2"},
        {"build", pto, "--focal", "1e999"},
        {"build", pto, "--key", "processing=cooked"},
        {"build", pto, "--fit", "method=magic"},
        {"build", pto, "--fit", "sampling=x"},
        {"build", pto, "--no-store", "--fit", "stored=none", "--db", work("p.db")},
        {"apply"},
        {"apply", png},
        {"apply", "-o", work("out"), png},
        {"apply", "--profile", "0", "-o", work("out"), png},
        {"apply", "--profile", "x", "-o", work("out"), png},
        {"apply", "--profile", "1", "--profile", "auto", "-o", work("out"), png},
        {"apply", "--profile", "1", "-o", work("out")},
        {"apply", "--pto", pto, "-o", work("out"), "--set", "exposure=bright"},
        {"query"},
        {"query", "--focal", "50"},
        {"query", "--camera", "x", "--focal", "-1"},
        {"query", "x"},
        {"profile"},
        {"profile", "frob"},
        {"profile", "show"},
        {"profile", "remove"},
        {"profile", "show", "x"},
        {"profile", "show", "0"},
        {"profile", "show", "-1"},
        {"profile", "remove", "1", "--lens", "x"},
        {"simulate"},
        {"simulate", "-o"},
        {"simulate", "-o", work("s"), "--images", "1"},
        {"simulate", "-o", work("s"), "--size", "10"},
        {"simulate", "-o", work("s"), "--size", "10x10"},
        {"simulate", "-o", work("s"), "--size", "axb"},
        {"simulate", "-o", work("s"), "--set", "hfov=0"},
        {"simulate", "-o", work("s"), "--set", "hfov=160"},
        {"simulate", "-o", work("s"), "--response", "magic"},
        {"simulate", "-o", work("s"), "--response", "gamma:0"},
        {"simulate", "-o", work("s"), "--response", "gamma: 0x2"},
        {"simulate", "-o", work("s"), "--response", "emor:99"},
        {"simulate", "-o", work("s"), "--vignetting", "1,2"},
        {"simulate", "-o", work("s"), "--vignetting", "-5,0,0"},
        {"simulate", "-o", work("s"), "--set", "center=1"},
        {"simulate", "-o", work("s"), "--format", "bmp"},
        {"simulate", "-o", work("s"), "--seed", "x"},
        {"simulate", "-o", work("s"), "--set", "overlap=1"},
    };
    for (const Words &words : cases) assert_refused(usage, words, {});
}

void test_options_that_are_no_numbers(void **) {
    const std::string pto = scene("pano.pto"), out = work("s");
    const Words build = Words{"build", pto, "--db", work("new.db")} + quick;
    for (const char *option : {"--focal", "--aperture"}) assert_refused(usage, build + Words{option, "nan"}, {option});
    for (const char *key : {"huber", "prior"})
        assert_refused(usage, build + Words{"--fit", key + std::string("=nan")}, {std::string("--fit ") + key});
    assert_refused(usage, build + Words{"--key", "distance=nan"}, {"--key distance"});
    assert_refused(usage, {"query", "--camera", "x", "--focal", "nan", "--db", work("p.db")}, {"--focal"});
    for (const char *key : {"hfov", "overlap", "jitter", "misalign", "ev", "wb", "noise", "outliers"})
        assert_refused(usage,
                       {"simulate", "-o", out, "--images", "2", "--size", "40x30", "--set", key + std::string("=nan")},
                       {std::string("--set ") + key});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_all_commands_are_walked),
        CLI_TEST(test_no_value_may_be_empty),
        CLI_TEST(test_the_nearest_is_named),
        CLI_TEST(test_options_are_no_values),
        CLI_TEST(test_words_within_brackets),
        CLI_TEST(test_a_short_option_with_an_equals_sign),
        CLI_TEST(test_two_dashes_end_options),
        CLI_TEST(test_help_fits_100_columns),
        CLI_TEST(test_quiet_and_verbose),
        CLI_TEST(test_version),
        CLI_TEST(test_empty_values_that_are_needed),
        CLI_TEST(test_long_and_odd_words),
        CLI_TEST(test_largest_ids),
        CLI_TEST(test_help_of_a_verb),
        CLI_TEST(test_units),
        CLI_TEST(test_times_with_units),
        CLI_TEST(test_bad_options),
        CLI_TEST(test_options_that_are_no_numbers),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
