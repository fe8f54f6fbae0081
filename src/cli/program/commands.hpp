// The commands, as run() knows them.
#pragma once

#include <string>
#include <vector>

#include "cli/program/run.hpp"

namespace lensprof {

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

}  // namespace lensprof
