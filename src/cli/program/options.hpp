// The commands and their options. Only this file knows the parsing library (CLI11), which costs seconds to compile:
// commands declare what they accept with this interface and receive typed values.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/program/description.hpp"
#include "cli/program/numbers.hpp"
#include "cli/program/run.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lensprof {

// The value of each word of an option.
template <class Value>
using Choices = std::vector<std::pair<const char *, Value>>;

class Program;

// A command, or a verb of one (`profile list`). Options are named "--seed" or "-o,--output", positionals "FILE". By
// default a value may be given once and must not be empty, as an unset shell variable would be. The variables must live
// until the program ends: declare_... functions keep theirs in the action.
class Command {
public:
    Command(CLI::App &app, Program &program) : app_(&app), program_(&program) {}

    // `brief` is shown in the list of commands; `about` follows it in the command's own help.
    Command add(const char *name, const std::string &brief, const std::string &about = "");

    // Sets the action, which throws Failure, and declares --quiet and --verbose; call it last. A command without an
    // action needs one of its verbs.
    void run(std::function<int(Streams &)> action);

    void flag(const char *names, bool &value, const std::string &about);
    void text(const char *names, std::string &value, const std::string &about);
    void file(const char *names, std::string &value, const std::string &about);
    void folder(const char *names, std::string &value, const std::string &about);
    void files(const char *name, std::vector<std::string> &values, const std::string &about);  // positional
    void texts(const char *name, std::vector<std::string> &values, const std::string &about);  // positional
    void number(const char *names, double &value, const Quantity &quantity, const std::string &about);
    void number(const char *names, std::optional<double> &value, const Quantity &quantity, const std::string &about);
    void count(const char *names, uint32_t &value, uint32_t low, uint32_t high, const std::string &about);
    void numbers(const char *names, std::vector<double> &values, const Quantity &quantity, const std::string &about);
    void counts(const char *names, std::vector<uint32_t> &values, uint32_t low, uint32_t high,
                const std::string &about);
    void size(const char *names, uint32_t &width, uint32_t &height, std::pair<uint32_t, uint32_t> ends,
              const std::string &about);
    void profile_id(const char *names, int64_t &value, const std::string &about);
    void profile_ids(const char *name, std::vector<int64_t> &values, const std::string &about);  // positional

    // One of these words.
    template <class Value>
    void choice(const char *names, Value &value, const Choices<Value> &choices, const std::string &about) {
        choice_of(
            names, words_of(choices), [&value, choices](size_t i) { value = choices[i].second; }, about);
    }
    // Several words, separated by commas.
    template <class Value>
    void list(const char *names, std::vector<Value> &values, const Choices<Value> &choices, const std::string &about) {
        list_of(
            names, words_of(choices), [&values] { values.clear(); },
            [&values, choices](size_t i) { values.push_back(choices[i].second); }, about);
    }

    // For values with their own syntax: `read` sets the value, or throws std::invalid_argument with the reason. `words`
    // may be repeated any number of times.
    using Read = std::function<void(const std::string &)>;
    void word(const char *names, const std::string &type, const Read &read, const std::string &about);
    void words(const char *names, const std::string &type, const Read &read, const std::string &about);

    void require(const char *name);                 // a declared option or positional
    void group(const std::string &title);           // heading of the following options in the help
    void footer(const std::string &text);           // text at the end of the help
    void example(const std::string &command_line);  // after the footer, if there is one

private:
    template <class Value>
    static std::vector<std::string> words_of(const Choices<Value> &choices) {
        std::vector<std::string> words;
        for (const auto &choice : choices) words.emplace_back(choice.first);
        return words;
    }
    void choice_of(const char *names, const std::vector<std::string> &words, const std::function<void(size_t)> &choose,
                   const std::string &about);
    void list_of(const char *names, const std::vector<std::string> &words, const std::function<void()> &clear,
                 const std::function<void(size_t)> &choose, const std::string &about);
    CLI::Option *add_option(const char *names, const std::string &type, const Read &read, const std::string &about);

    CLI::App *app_;
    Program *program_;
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

    // Help of the command and verbs in `words`, or of the program for an empty list; Failure (usage).
    std::string help(const std::vector<std::string> &words) const;

    // All commands with their options.
    CommandDescription describe() const;

private:
    friend class Command;
    struct Actions;
    std::unique_ptr<CLI::App> app_;
    std::unique_ptr<Actions> actions_;
    bool quiet_ = false, verbose_ = false;  // of the chosen command
};

// Declares --db FILE, a profile database; `more` is added to its description.
void declare_db(Command &command, std::string &path, const std::string &more = "");

// Parses a profile id; throws std::invalid_argument.
int64_t profile_id_of(const std::string &word);

// Declare --json and --progress.
void declare_json(Command &command, bool &json);
void declare_progress(Command &command, bool &progress);

}  // namespace lensprof
