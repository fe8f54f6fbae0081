// The commands and their options. Only this file knows the parsing library (CLI11), which costs seconds to compile:
// commands declare what they accept with this interface and receive typed values.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/program/declarations.hpp"
#include "cli/program/description.hpp"
#include "cli/program/keys.hpp"
#include "cli/program/run.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lensprof {

class Program;

// A command, or a verb of one (`profile list`). Options are named "--seed" or "-o,--output", positionals "FILE". By
// default a value may be given once and must not be empty, as an unset shell variable would be.
class Command : public Declarations {
public:
    Command(CLI::App &app, Program &program) : app_(&app), program_(&program) {}

    // `brief` is shown in the list of commands; `about` follows it in the command's own help.
    Command add(const char *name, const std::string &brief, const std::string &about = "");

    // Sets the action, which throws Failure, and declares --quiet and --verbose; call it last. A command without an
    // action needs one of its verbs.
    void run(std::function<int(Streams &)> action);

    // The same command, declaring options that only --help-all and the second section of man pages show.
    Command expert() const;

    // An option of KEY=VALUE pairs; its keys are declared with what this returns.
    Keys keys(const char *name, const std::string &about, const char *type = "KEY=VALUE,...");

    void word(const char *names, const std::string &type, const Read &read, const std::string &about) override;
    void flag(const char *names, bool &value, const std::string &about) override;
    // May be repeated any number of times.
    void words(const char *names, const std::string &type, const Read &read, const std::string &about);
    // Positionals.
    void files(const char *name, std::vector<std::string> &values, const std::string &about);
    void texts(const char *name, std::vector<std::string> &values, const std::string &about);
    void profile_ids(const char *name, std::vector<int64_t> &values, const std::string &about);

    void require(const char *name);                 // a declared option or positional
    void group(const std::string &title);           // heading of the following options in the help
    void footer(const std::string &text);           // text at the end of the help
    void example(const std::string &command_line);  // after the footer, if there is one

private:
    CLI::Option *add_option(const char *names, const std::string &type, const Read &read, const std::string &about);
    void add_positionals(const char *name, const std::string &type, const Read &read, const std::string &about);

    CLI::App *app_;
    Program *program_;
    std::string group_ = "Options";
};

// All commands: parses the command line and runs the chosen command.
class Program {
public:
    Program(const std::string &name, const std::string &about);
    ~Program();
    Program(const Program &) = delete;
    Program &operator=(const Program &) = delete;

    Command root();

    // Prints help on request. Words that do not fit cause a Failure (usage) that suggests the nearest valid word.
    int run(const std::vector<std::string> &words, Streams &streams);

    // Help of the command and verbs in `words`, or of the program for an empty list, without the expert options;
    // Failure (usage).
    std::string help(const std::vector<std::string> &words) const;

    // All commands with their options.
    CommandDescription describe() const;

    // The keys of an option of KEY=VALUE pairs; null for others.
    const KeyTable *keys_of(const CLI::Option &option) const;

private:
    friend class Command;
    struct Actions;
    std::unique_ptr<CLI::App> app_;
    std::unique_ptr<Actions> actions_;
    bool quiet_ = false, verbose_ = false;  // of the chosen command
};

// Declares --db FILE, a profile database; `more` is added to its description.
void declare_db(Command &command, std::string &path, const std::string &more = "");

// Declare --json, and --progress for experts.
void declare_json(Command &command, bool &json);
void declare_progress(Command &command, bool &progress);

}  // namespace lensprof
