// What help shows to whom, KEY=VALUE options, and options under their earlier names.
#include "cli/program/renamed_options.hpp"

#include "help_runs.hpp"

using namespace help_runs;

namespace {

// The options listed below the headings, with "-o,--output" as one.
Words options_of(const std::string &help) {
    std::istringstream lines(help);
    Words options;
    for (std::string line; std::getline(lines, line);)
        if (!find_pattern("^  -", line).empty()) options.push_back(line.substr(2, line.find(' ', 2) - 2));
    return options;
}

std::string everyday_help(const Words &command) { return must_exit(done, Words{"help"} + command); }
std::string whole_help(const Words &command) { return must_exit(done, command + Words{"--help-all"}); }

void test_everyday_help_is_short(void **) {
    assert_true(options_of(everyday_help({"build"})).size() <= 14);
    assert_true(options_of(everyday_help({"apply"})).size() <= 12);
    for (const Words &command : all_commands()) {
        const std::string help = everyday_help(command);
        assert_true(options_of(help).size() <= 15);
        assert_true(contains(help, "  --help-all"));
        for (const char *none : {"Expert options", "--fit", "--key", "--verbose"}) assert_false(contains(help, none));
    }
}

// Options that all commands share are not counted.
void test_all_help_has_a_limit(void **) {
    const Words shared = {"-h,--help", "--help-all", "-q,--quiet", "-v,--verbose", "--json", "--progress"};
    size_t slots = 0;
    for (const Words &command : all_commands()) {
        const std::string help = whole_help(command);
        for (const std::string &option : options_of(help))
            slots += std::find(shared.begin(), shared.end(), option) == shared.end();
        assert_true(contains(help, "\nExpert options:\n") && contains(help, "  -v,--verbose"));
        for (const std::string &option : options_of(everyday_help(command)))
            assert_true(contains(help, "  " + option + " "));
    }
    if (slots > 202) fail_msg("%zu options of commands; at most 202", slots);
}

void test_keys_are_explained(void **) {
    const auto keys = keys_of(whole_help({"build"}));
    for (const char *key : {"method", "modes", "loss", "huber", "prior", "gamma-from", "exif-sigma", "camera-kind",
                            "seed", "max-side", "pairs"})
        assert_true(std::find(keys.begin(), keys.end(), std::pair<std::string, std::string>("--fit", key))
                    != keys.end());
    size_t keyed = 0;
    for (const Words &command : all_commands()) keyed += keys_of(whole_help(command)).size();
    assert_true(keyed > 150);
}

// Each earlier name is answered by the commands that have its new form, and by at least one.
void test_each_earlier_name(void **) {
    const std::vector<Words> commands = all_commands();
    for (const lensprof::RenamedOption &renamed : lensprof::renamed_options) {
        const std::string answer = std::string(renamed.before) + " is now " + renamed.now + "; see `lensprof ";
        size_t answers = 0;
        for (const Words &command : commands) {
            const Outcome outcome = run_words(command + Words{renamed.before, "1"});
            if (contains(outcome.err, answer)) {
                answers++;
                assert_int_equal(outcome.code, usage);
            }
        }
        if (!answers) fail_msg("%s: no command answers %s", renamed.before, answer.c_str());
    }
}

void test_earlier_names_of_other_commands(void **) {
    assert_refused(usage, {"build", "x.pto", "--huber=3"}, {"--huber is now --fit huber=NUMBER", "build --help-all`"});
    assert_refused(usage, {"flat", "x.tif", "--modes", "3"}, {"--modes: no such option"});  // flat never had it
    assert_refused(usage, {"simulate", "--blob", "x"}, {"--blob: no such option"});
    assert_refused(usage, {"report", "--from-db"}, {"--from-db: no such option"});
    assert_refused(usage, {"simulate", "--center", "0,0"}, {"--center is now --set center="});
    assert_refused(usage, {"flat", "--center", "free"}, {"--center is now --fit center="});
}

void test_wrong_keys(void **) {
    const struct {
        Words words;
        const char *said;
    } cases[] = {
        {{"--fit", "hubr=3"}, "--fit: hubr is not a key; did you mean huber? Keys: method, modes, loss, "},
        {{"--fit", "robust"}, "--fit: robust is not a key; keys: method, modes, loss, "},
        {{"--fit", "=3"}, "--fit: '' is not a key; keys: method, "},
        {{"--fit", "loss=huber,sed=3"}, "--fit: sed is not a key; did you mean seed?"},
        {{"--fit", "seed"}, "--fit seed: needs a value; give --fit seed=COUNT\n"},
        {{"--fit", "seed="}, "--fit seed: empty value; give COUNT, or omit the key\n"},
        {{"--fit", "seed=1,seed=2"}, "--fit seed: given more than once; give it once\n"},
        {{"--fit", "seed=1", "--fit=seed=2"}, "--fit seed: given more than once; give it once\n"},
        {{"--fit", "loss=hubr"}, "--fit loss: hubr: use robust, huber, squared; did you mean huber?\n"},
        {{"--fit", "loss=huber,squared"}, "--fit loss: huber,squared: use robust, huber, squared"},
        {{"--fit", "huber=300"}, "--fit huber: "},
        {{"--fit", "free=ev,,wb"}, "--fit free: ev,,wb: a value is missing before or after a comma"},
        {{"--reconstruction", "track-colors=on"}, "--reconstruction track-colors: on: use yes, no"},
        {{"--fit"}, "--fit: needs a value; give --fit KEY=VALUE,..."},
        {{"--fit", ""}, "--fit: empty value; give one, or omit the option"},
    };
    for (const auto &one : cases) assert_refused(usage, Words{"build", "x.pto"} + one.words, {one.said});
}

// Text after a comma without "=" belongs to the value before.
void test_commas_in_values(void **) {
    const Words build = {"build", scene("pano.pto"), "--no-store", "--json", "--db", work("none.db")};
    const std::string file = work("a,b.txt");
    const Json json =
        json_of(build + Words{"--fit", "free=ev,wb,pairs=400", "--fit", "seed=3", "--write", "points=" + file});
    assert_true(fs::is_regular_file(file));
    assert_true(json["pairs"].get<int>() <= 400);
    must_exit(done, {"simulate", "-o", work("s"), "--images", "2", "--size", "64x48", "--set",
                     "center=0.1,-0.1,mean-ev=-0.8,noise=0"});
    const Json truth = parsed(text_of(work("s/truth.json")));
    assert_close(truth["vignetting"]["center"][1].get<double>(), -0.1, 1e-9);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_everyday_help_is_short),
        CLI_TEST(test_all_help_has_a_limit),
        CLI_TEST(test_keys_are_explained),
        CLI_TEST(test_each_earlier_name),
        CLI_TEST(test_earlier_names_of_other_commands),
        CLI_TEST(test_wrong_keys),
        CLI_TEST(test_commas_in_values),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
