// The program as a function, so that tests run it in process.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace lensprof {

// Where a command writes: results to `out`, everything else to `err`.
struct Streams {
    std::ostream &out;
    std::ostream &err;
};

// A row of the command table. `arguments` are the words behind the command's name. Failures are thrown.
struct Command {
    const char *name;
    const char *help;
    int (*run)(const std::vector<std::string> &arguments, Streams &streams);
};

int run_align(const std::vector<std::string> &arguments, Streams &streams);
int run_apply(const std::vector<std::string> &arguments, Streams &streams);
int run_bracket(const std::vector<std::string> &arguments, Streams &streams);
int run_build(const std::vector<std::string> &arguments, Streams &streams);
int run_flat(const std::vector<std::string> &arguments, Streams &streams);
int run_profile(const std::vector<std::string> &arguments, Streams &streams);
int run_profile_export(const std::vector<std::string> &arguments, Streams &streams);  // behind `profile export`
int run_profile_import(const std::vector<std::string> &arguments, Streams &streams);  // behind `profile import`
int run_profile_check(const std::vector<std::string> &arguments, Streams &streams);   // behind `profile check`
int run_profile_stats(const std::vector<std::string> &arguments, Streams &streams);   // behind `profile stats`
int run_profile_merge(const std::vector<std::string> &arguments, Streams &streams);   // behind `profile merge`
int run_query(const std::vector<std::string> &arguments, Streams &streams);
int run_simulate(const std::vector<std::string> &arguments, Streams &streams);

// The whole program: returns its exit code (ExitCode in error.hpp).
int run(const std::vector<std::string> &words, Streams &streams);

// Parses a command's words. Returns true when the command shall run; otherwise help was asked for and printed.
// Words that do not fit are a Failure (usage).
bool parse(CLI::App &app, const std::vector<std::string> &arguments, Streams &streams);

// --db FILE, a profile database; `more` is said of it. An empty name, which is what a shell makes of a variable that is
// not set, is refused.
void declare_db(CLI::App &app, std::string &path, const std::string &more = "");

// Check of an option's word: what `lensprof profile list` shows as id.
std::string is_profile_id(const std::string &word);

// Check of an option's word: a number from low to high, both included; neither "nan" nor "inf" beyond them.
std::function<std::string(const std::string &)> in_range(double low, double high);

}  // namespace lensprof
