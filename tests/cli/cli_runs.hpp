// Common parts of the tests of the program: commands run in process, the disk before and after, and a rendered
// sequence.
#pragma once

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <map>
#include <sstream>

#include <regex.h>  // <regex> causes false warnings from gcc under sanitizers
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "cli/program/run.hpp"

#include "picture_files.hpp"

// Compiled once, in cli_runs.cpp.
extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace cli_runs {

using namespace picture_files;

using Words = std::vector<std::string>;
using Json = nlohmann::ordered_json;

// The exit codes of the contract. They are repeated here so that a change of the program cannot change them unnoticed.
constexpr int done = 0, failed = 1, usage = 2, unreadable = 3, not_usable = 4, not_found = 5, store_failed = 6,
              stopped = 130;

struct Outcome {
    int code;  // or 128 + number of the signal that ended the child
    std::string out, err;
};

Words operator+(Words words, const Words &more);

std::string joined(const Words &words);

inline bool contains(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }

Outcome run_words(const Words &words);

// Runs and returns what was printed; the exit code must be `code`.
std::string must_exit(int code, const Words &words);

Json parsed(const std::string &text);

Json json_of(const Words &words, int code = done);

// Code and text of the first finding in what a command printed; "none" and "" without findings.
std::string code_of(const Json &json);
std::string text_of(const Json &json);

// Runs in a child process that `prepare` has changed: another user, another limit. Both outputs come back through a
// pipe, so that a full disk does not hide them.
Outcome run_child(
    const Words &words, const std::function<void()> &prepare = [] {});

// Every file and folder below the tests' folder, with its bytes.
using Disk = std::map<std::string, Bytes>;

Disk disk();

std::string difference(const Disk &before, const Disk &after);

// Checks that the failure is reported on standard error with these names, and that the disk is unchanged.
void assert_refusal(const Words &words, const Outcome &outcome, int code, const Words &named, const Disk &before);

void assert_refused(int code, const Words &words, const Words &named);

// Range of the first match of an extended regular expression in `text` from `at` on, and the ranges of its groups;
// empty without a match. `.` does not match a line break.
std::vector<std::pair<size_t, size_t>> find_pattern(const std::string &pattern, const std::string &text, size_t at = 0);

// Replaces every match; $1 is the first group.
std::string replaced(const std::string &text, const std::string &pattern, const std::string &replacement);

std::string text_of(const std::string &path);

// A text file changed by a regular expression, which must match.
void edit(const std::string &path, const std::string &pattern, const std::string &replacement);

inline void save_text(const std::string &path, const std::string &text) { save(path, Bytes(text.begin(), text.end())); }

// A Lensfun database of one lens, "Example NAME", for a crop factor of 1.5.
struct LensfunEntry {
    double focal_mm, aperture, k1, k2 = 0.0, distance_m = 1000.0;
};
std::string lensfun_text(const std::string &lens, const std::vector<LensfunEntry> &entries);

// `scene` holds four PNG files and `mixed` one picture of every kind, rendered once; `work` is empty before every test.
constexpr const char *mixed_names[] = {"img000.png", "img001.png", "img002.tif",
                                       "img003.tif", "img004.tif", "img005.jpg"};

// Largest difference between a falloff in JSON (k1..k3) and the true one, from the centre to the corner.
double falloff_error(const Json &k, const std::vector<double> &truth);

inline std::string scene(const std::string &name) { return in_folder("scene/" + name); }
inline std::string mixed(const std::string &name) { return in_folder("mixed/" + name); }
inline std::string work(const std::string &name) { return in_folder("work/" + name); }

// A copy of a rendered folder that a test may change.
std::string copy_of(const std::string &from, const std::string &to = "copy");

// `simulate` into work(name): what several tests of a program render is rendered once, and copied.
void render(const std::string &name, const Words &words);

// Enough for tests that are not about accuracy.
inline const Words quick = {"--fit", "pairs=600,modes=3"};

int make_scene(void **state);

int empty_work(void **);

}  // namespace cli_runs

#define CLI_TEST(name) cmocka_unit_test_setup(name, cli_runs::empty_work)
