// The commands and their options as data: what man pages and shell completions are made of.
#pragma once

#include <string>
#include <vector>

namespace lensprof {

struct OptionDescription {
    std::vector<std::string> names;  // "-o", "--output"; a positional has one name without dashes
    std::string type;                // "FILE", "NUMBER", "auto|1|3"; empty for a flag
    std::string about;
    std::vector<std::string> choices;     // of "auto|1|3"
    std::vector<OptionDescription> keys;  // of "KEY=VALUE,..."; each with one name
    bool is_positional = false, is_repeated = false, is_required = false, is_expert = false;
};

struct CommandDescription {
    std::string path;                  // "lensprof profile list"
    std::string brief, about, footer;  // one line; a paragraph; text after the options
    std::vector<OptionDescription> options;
    std::vector<CommandDescription> commands;  // verbs

    std::string name() const { return path.substr(path.rfind(' ') + 1); }  // its last word
};

// The man page of a command, roff: of the program with a list of its commands, else with all options and verbs.
std::string man_page(const CommandDescription &command, const std::string &version);

// "lensprof-profile-list".
std::string man_name(const CommandDescription &command);

// Scripts that complete commands, verbs, options, choices and file names.
std::string bash_completion(const CommandDescription &program);
std::string zsh_completion(const CommandDescription &program);
std::string fish_completion(const CommandDescription &program);

}  // namespace lensprof
