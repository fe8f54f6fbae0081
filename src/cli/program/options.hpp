// The commands and their options. This is the one place that knows the library that parses (CLI11), which costs seconds
// to compile: commands declare what they accept in these words and receive typed values.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/program/numbers.hpp"
#include "cli/program/run.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lensprof {

// What a word of an option stands for.
template <class Value>
using Choices = std::vector<std::pair<const char *, Value>>;

class Program;

// A command, or a verb of one (`profile list`). Options are named as "--seed" or "-o,--output", positionals as "FILES".
// Every value is given once and none may be empty, which is what a shell makes of a variable that is not set. Values
// must live until the program ends: declare_... keep theirs in the action.
class Command {
public:
    Command(CLI::App &app, Program &program) : app_(&app), program_(&program) {}

    // `brief` stands in the list of commands; `about` follows it in the command's own help.
    Command add(const char *name, const std::string &brief, const std::string &about = "");

    // What it does; Failure is thrown. A command without an action wants one of its verbs.
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

    // One word of those.
    template <class Value>
    void choice(const char *names, Value &value, const Choices<Value> &choices, const std::string &about) {
        choice_of(
            names, words_of(choices), [&value, choices](size_t i) { value = choices[i].second; }, about);
    }
    // Several, with commas.
    template <class Value>
    void list(const char *names, std::vector<Value> &values, const Choices<Value> &choices, const std::string &about) {
        list_of(
            names, words_of(choices), [&values] { values.clear(); },
            [&values, choices](size_t i) { values.push_back(choices[i].second); }, about);
    }

    // For what has a form of its own: `read` sets the value, or throws std::invalid_argument with what is wrong with
    // the word. Of `words` any number may be given, by the option again and again.
    using Read = std::function<void(const std::string &)>;
    void word(const char *names, const std::string &type, const Read &read, const std::string &about);
    void words(const char *names, const std::string &type, const Read &read, const std::string &about);

    void require(const char *name);        // a declared option or positional
    void group(const std::string &title);  // of the options that follow, in the help
    void footer(const std::string &text);  // of the help

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

// All commands: parses the words of the command line and runs the one they name.
class Program {
public:
    Program(const std::string &name, const std::string &about);
    ~Program();
    Program(const Program &) = delete;
    Program &operator=(const Program &) = delete;

    Command root();

    // Help that is asked for is printed. Words that do not fit are a Failure (usage) that names the nearest that does.
    int run(const std::vector<std::string> &words, Streams &streams);

    // Of the command and verbs named by `words`, of the program where there are none; Failure (usage).
    std::string help(const std::vector<std::string> &words) const;

private:
    friend class Command;
    struct Actions;
    std::unique_ptr<CLI::App> app_;
    std::unique_ptr<Actions> actions_;
};

// --db FILE, a profile database; `more` is said of it.
void declare_db(Command &command, std::string &path, const std::string &more = "");

// The number of a profile; throws std::invalid_argument.
int64_t profile_id_of(const std::string &word);

// --json and --progress.
void declare_json(Command &command, bool &json);
void declare_progress(Command &command, bool &progress);

}  // namespace lensprof
