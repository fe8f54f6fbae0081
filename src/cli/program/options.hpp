// The options of a command: parsing, and those that several commands share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/program/run.hpp"

namespace CLI {
class App;
}

namespace lensprof {

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
