#include "cli/program/options.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "cli/program/error.hpp"
#include "cli/program/nearest.hpp"

namespace lensprof {

struct Program::Actions {
    std::map<const CLI::App *, std::function<int(Streams &)>> of;
};

namespace {

// "lensprof profile list".
std::string path_of(const CLI::App &app) {
    return app.get_parent() ? path_of(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

// App::help would print the help of the command that was parsed.
std::string help_of(const CLI::App &app) {
    return app.get_formatter()->make_help(&app, path_of(app), CLI::AppFormatMode::Normal);
}

std::vector<std::string> names_of_commands(const CLI::App &app) {
    std::vector<std::string> names;
    for (const CLI::App *command : app.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> names_of_options(const CLI::App &app) {
    std::vector<std::string> names;
    for (const CLI::Option *option : app.get_options()) {
        for (const std::string &name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string &name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

std::string joined(const std::vector<std::string> &words) {
    std::string text;
    for (const std::string &word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

// A list of commands shows the first line of what they say about themselves.
class HelpText : public CLI::Formatter {
public:
    HelpText() { label("SUBCOMMAND", "VERB"); }
    std::string make_usage(const CLI::App *app, std::string name) const override {
        if (app->get_parent()) return CLI::Formatter::make_usage(app, name);
        return "\nusage: lensprof COMMAND [OPTIONS]\n\n";
    }
    std::string make_subcommand(const CLI::App *command) const override {
        const std::string about = command->get_description();
        std::ostringstream line;
        CLI::detail::format_help(line, command->get_name(), about.substr(0, about.find('\n')), get_column_width());
        return line.str();
    }
};

// The nearest of the words, else where to look.
std::string advice(const std::string &word, const std::vector<std::string> &words, const std::string &otherwise) {
    const std::string nearest = did_you_mean(word, words);
    return nearest.empty() ? "; " + otherwise : nearest;
}

[[noreturn]] void fail_no_command(const CLI::App &app, const std::string &word) {
    const std::string path = path_of(app), parent = app.get_parent() ? path.substr(path.find(' ') + 1) + " " : "";
    throw Failure(ExitCode::usage,
                  parent + word + (parent.empty() ? ": no such command" : ": no such verb")
                      + advice(word, names_of_commands(app),
                               "`lensprof help" + (parent.empty() ? "" : " " + app.get_name()) + "` lists them"));
}

// Failure for the first word that no command on the way knows; it matters more than what is missing.
void check_unknown(const CLI::App &app) {
    for (const std::string &word : app.remaining()) {
        if (word == "--") continue;
        const bool is_option = word.size() > 1 && word[0] == '-';
        if (!is_option && !app.get_subcommands({}).empty()) fail_no_command(app, word);
        const std::string name = word.substr(0, word.find('=')), see = "see `" + path_of(app) + " --help`";
        if (is_option)
            throw Failure(ExitCode::usage, name + ": no such option" + advice(name, names_of_options(app), see));
        throw Failure(ExitCode::usage, word + ": is more than this command takes; " + see);
    }
    for (const CLI::App *command : app.get_subcommands()) check_unknown(*command);
}

// "--seed=" names no value either; the library would take the next word.
void check_empty(const std::vector<std::string> &words) {
    for (const std::string &word : words) {
        if (word == "--") return;
        if (word.size() > 3 && word.rfind("--", 0) == 0 && word.find('=') == word.size() - 1)
            throw Failure(ExitCode::usage,
                          word.substr(0, word.size() - 1) + ": its value is empty; give one, or leave the option out");
    }
}

const CLI::App &named_command(const CLI::App &root) {
    const CLI::App *app = &root;
    while (!app->get_subcommands().empty()) app = app->get_subcommands().back();
    return *app;
}

}  // namespace

Command Command::add(const char *name, const std::string &brief, const std::string &about) {
    app_->require_subcommand(0, 1);
    return {*app_->add_subcommand(name, brief + (about.empty() ? "" : "\n" + about))->group("Commands"), *program_};
}

void Command::run(std::function<int(Streams &)> action) { program_->actions_->of[app_] = std::move(action); }

CLI::Option *Command::add_option(const char *names, const std::string &type, const Read &read,
                                 const std::string &about) {
    const std::string all = names, name = all.substr(all.rfind(',') + 1);
    const auto take = [name, read, is_file = type == "FILE"](const std::vector<std::string> &words) {
        for (const std::string &word : words) try {
                if (word.empty())
                    throw std::invalid_argument(is_file ? "names no file; give one, or leave it out"
                                                        : "its value is empty; give one, or leave it out");
                read(word);
            } catch (const std::invalid_argument &wrong) {
                throw Failure(ExitCode::usage, name + ": " + wrong.what());
            }
        return true;
    };
    return app_->add_option(names, CLI::callback_t(take), about)->type_name(type);
}

void Command::flag(const char *names, bool &value, const std::string &about) { app_->add_flag(names, value, about); }

void Command::text(const char *names, std::string &value, const std::string &about) {
    add_option(
        names, "TEXT", [&value](const std::string &word) { value = word; }, about);
}

void Command::file(const char *names, std::string &value, const std::string &about) {
    add_option(
        names, "FILE", [&value](const std::string &word) { value = word; }, about);
}

void Command::files(const char *name, std::vector<std::string> &values, const std::string &about) {
    add_option(
        name, "FILE", [&values](const std::string &word) { values.push_back(word); }, about)
        ->expected(1, CLI::detail::expected_max_vector_size)
        ->allow_extra_args();
}

void Command::texts(const char *name, std::vector<std::string> &values, const std::string &about) {
    add_option(
        name, "", [&values](const std::string &word) { values.push_back(word); }, about)
        ->expected(1, CLI::detail::expected_max_vector_size)
        ->allow_extra_args();
}

void Command::number(const char *names, double &value, const Quantity &quantity, const std::string &about) {
    add_option(
        names, "NUMBER", [&value, quantity](const std::string &word) { value = number_of(word, quantity); }, about);
}

void Command::number(const char *names, std::optional<double> &value, const Quantity &quantity,
                     const std::string &about) {
    add_option(
        names, "NUMBER", [&value, quantity](const std::string &word) { value = number_of(word, quantity); }, about);
}

void Command::count(const char *names, uint32_t &value, uint32_t low, uint32_t high, const std::string &about) {
    add_option(
        names, "COUNT", [&value, low, high](const std::string &word) { value = count_of(word, low, high); }, about);
}

void Command::numbers(const char *names, std::vector<double> &values, const Quantity &quantity,
                      const std::string &about) {
    const auto read = [&values, quantity](const std::string &list) {
        values.clear();
        for (const std::string &word : split(list)) values.push_back(number_of(word, quantity));
    };
    add_option(names, "NUMBER,...", read, about);
}

void Command::counts(const char *names, std::vector<uint32_t> &values, uint32_t low, uint32_t high,
                     const std::string &about) {
    const auto read = [&values, low, high](const std::string &list) {
        values.clear();
        for (const std::string &word : split(list)) values.push_back(count_of(word, low, high));
    };
    add_option(names, "COUNT,...", read, about);
}

void Command::size(const char *names, uint32_t &width, uint32_t &height, std::pair<uint32_t, uint32_t> ends,
                   const std::string &about) {
    const auto read = [&width, &height, ends](const std::string &word) {
        const std::vector<std::string> sides = split(word, 'x');
        if (sides.size() != 2) throw std::invalid_argument(word + ": give WIDTHxHEIGHT");
        const uint32_t w = count_of(sides[0], ends.first, ends.second), h = count_of(sides[1], ends.first, ends.second);
        width = w, height = h;
    };
    add_option(names, "WIDTHxHEIGHT", read, about);
}

namespace {

int64_t id_of(const std::string &word) {
    const bool digits = word.size() < 19 && word.find_first_not_of("0123456789") == std::string::npos;
    if (!digits || word.find_first_not_of('0') == std::string::npos)
        throw std::invalid_argument(word + " is no number of a profile; `lensprof profile list` shows them");
    return std::stoll(word);
}

}  // namespace

void Command::profile_id(const char *names, int64_t &value, const std::string &about) {
    add_option(
        names, "ID", [&value](const std::string &word) { value = id_of(word); }, about);
}

void Command::profile_ids(const char *name, std::vector<int64_t> &values, const std::string &about) {
    add_option(
        name, "", [&values](const std::string &word) { values.push_back(id_of(word)); }, about)
        ->expected(1, CLI::detail::expected_max_vector_size)
        ->allow_extra_args();
}

void Command::word(const char *names, const std::string &type, const Read &read, const std::string &about) {
    add_option(names, type, read, about);
}

void Command::words(const char *names, const std::string &type, const Read &read, const std::string &about) {
    add_option(names, type, read, about)->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(false);
}

namespace {

size_t index_of(const std::string &word, const std::vector<std::string> &words) {
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) throw std::invalid_argument(word + ": use " + joined(words));
    return static_cast<size_t>(found - words.begin());
}

std::string type_of(const std::vector<std::string> &words) {
    std::string type;
    for (const std::string &word : words) type += (type.empty() ? "" : "|") + word;
    return type;
}

}  // namespace

void Command::choice_of(const char *names, const std::vector<std::string> &words,
                        const std::function<void(size_t)> &choose, const std::string &about) {
    add_option(
        names, type_of(words), [words, choose](const std::string &word) { choose(index_of(word, words)); }, about);
}

void Command::list_of(const char *names, const std::vector<std::string> &words, const std::function<void()> &clear,
                      const std::function<void(size_t)> &choose, const std::string &about) {
    const auto read = [words, clear, choose](const std::string &list) {
        clear();
        for (const std::string &word : split(list)) choose(index_of(word, words));
    };
    add_option(names, type_of(words) + ",...", read, about);
}

void Command::require(const char *name) { app_->get_option(name)->required(); }

void Command::group(const std::string &title) { app_->option_defaults()->group(title); }

void Command::footer(const std::string &text) { app_->footer(text); }

Program::Program(const std::string &name, const std::string &about)
    : app_(std::make_unique<CLI::App>(about, name)), actions_(std::make_unique<Actions>()) {
    app_->formatter(std::make_shared<HelpText>());
}

Program::~Program() = default;

Command Program::root() { return {*app_, *this}; }

std::string Program::help(const std::vector<std::string> &words) const {
    const CLI::App *app = app_.get();
    for (const std::string &word : words) {
        const auto commands =
            app->get_subcommands([&](const CLI::App *command) { return command->get_name() == word; });
        if (commands.empty()) fail_no_command(*app, word);
        app = commands.front();
    }
    return help_of(*app);
}

int Program::run(const std::vector<std::string> &words, Streams &streams) {
    check_empty(words);
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    try {
        app_->parse(reversed);
    } catch (const CLI::CallForHelp &) {
        for (const std::string &word : app_->remaining()) fail_no_command(*app_, word);
        streams.out << help_of(named_command(*app_));
        return static_cast<int>(ExitCode::done);
    } catch (const Failure &) {
        check_unknown(*app_);  // its value may have been taken for something else
        throw;
    } catch (const CLI::ParseError &e) {
        check_unknown(*app_);
        throw Failure(ExitCode::usage, std::string(e.what()) + "; see `" + path_of(named_command(*app_)) + " --help`");
    }
    const CLI::App &command = named_command(*app_);
    const auto action = actions_->of.find(&command);
    if (action == actions_->of.end())
        throw Failure(ExitCode::usage,
                      path_of(command) + ": name one of its verbs: " + joined(names_of_commands(command)));
    return action->second(streams);
}

void declare_db(Command &command, std::string &path, const std::string &more) {
    command.file("--db", path, "profile database" + more + "; default the user's own");
}

void declare_json(Command &command, bool &json) { command.flag("--json", json, "print one JSON object"); }

void declare_progress(Command &command, bool &progress) {
    command.flag("--progress", progress, "show progress also when standard error is not a terminal");
}

}  // namespace lensprof
