#include "cli/program/options.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "cli/program/exit_code.hpp"
#include "cli/program/help_text.hpp"
#include "cli/program/message.hpp"
#include "cli/program/renamed_options.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/nearest.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

using KeyTables = std::map<const CLI::Option *, std::shared_ptr<KeyTable>>;

struct Program::Actions {
    std::map<const CLI::App *, std::function<int(Streams &)>> of;
    KeyTables keys;
};

namespace {

// "lensprof profile list".
std::string path_of(const CLI::App &app) {
    return app.get_parent() ? path_of(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

// App::help would print the help of the parsed command.
std::string help_of(const CLI::App &app, bool with_expert) {
    std::string text = help_formatter(with_expert)->make_help(&app, path_of(app), CLI::AppFormatMode::Normal);
    for (size_t at; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);  // of an omitted group
    return text.back() == '\n' ? text : text + "\n";
}

std::vector<std::string> names_of_commands(const CLI::App &app) {
    std::vector<std::string> names;
    for (const CLI::App *command : app.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

// The command or verb with this name; null if not found.
const CLI::App *command_of(const CLI::App &app, const std::string &name) {
    const auto found = app.get_subcommands([&](const CLI::App *command) { return command->get_name() == name; });
    return found.empty() ? nullptr : found.front();
}

std::vector<std::string> names_of_options(const CLI::App &app) {
    std::vector<std::string> names;
    for (const CLI::Option *option : app.get_options()) {
        for (const std::string &name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string &name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

// Suggests the nearest word, else where to look.
std::string advice(const std::string &word, const std::vector<std::string> &words, const std::string &fallback) {
    const std::string nearest = did_you_mean(word, words);
    return nearest.empty() ? "; " + fallback : nearest;
}

// Failure for an unknown command or verb.
[[noreturn]] void fail_no_command(const CLI::App &app, const std::string &word) {
    const std::string path = path_of(app), command_words = app.get_parent() ? path.substr(path.find(' ') + 1) : "";
    const std::string help = "`lensprof help" + (command_words.empty() ? "" : " " + command_words) + "`";
    const std::vector<std::string> names = names_of_commands(app);
    if (names.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      command_words + " " + word + ": `" + path + "` has no verbs; see " + help);
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  (command_words.empty() ? (word.empty() ? "''" : word) : command_words + " " + word)
                      + (command_words.empty() ? ": no such command" : ": no such verb")
                      + advice(word, names, help + " lists them"));
}

// Message for an empty value, such as from an unset shell variable.
std::string empty_text(const CLI::Option &option) {
    const std::string type = option.get_type_name();
    return (type == "FILE"     ? std::string("empty file name; give one")
            : type == "FOLDER" ? "empty folder name; give one"
                               : "empty value; give one")
           + (option.get_required() || option.get_positional() ? "" : ", or omit the option");
}

// The options, keys and choices in a form such as "--fit huber=NUMBER" or "-o FILE --format blob" are the command's.
bool has_form(const CLI::App &app, const KeyTables &tables, const std::string &form) {
    const CLI::Option *option = nullptr;
    for (const std::string &word : split(form, ' ')) {
        const size_t equal = word.find('=');
        if (word[0] == '-') {
            option = app.get_option_no_throw(word);
            if (!option) return false;
        } else if (equal != std::string::npos) {
            const auto table = tables.find(option);
            if (table == tables.end() || !table->second->find(word.substr(0, equal))) return false;
        } else if (option->get_type_name().find(word) == std::string::npos) {
            return false;
        }
    }
    return true;
}

// What an option of an earlier version is called in this command; empty if it had none of this name.
std::string form_now(const CLI::App &app, const KeyTables &tables, const std::string &name) {
    for (const RenamedOption &renamed : renamed_options)
        if (name == renamed.before && has_form(app, tables, renamed.now)) return renamed.now;
    return "";
}

bool is_flag(const CLI::Option &option) { return option.get_items_expected_max() == 0; }

// "-o", "--output" and "-1.db" look like options; "-", a file by convention, and numbers such as "-1.5" or "-1/8,1e-3"
// do not. An option that takes numbers reports its own error for "-3x".
bool looks_like_option(const std::string &word, const CLI::Option &option) {
    if (word.size() < 2 || word[0] != '-') return false;
    if (std::string("0123456789.").find(word[1]) == std::string::npos) return true;
    const std::string type = option.get_type_name();
    const bool takes_numbers = type.rfind("NUMBER", 0) == 0 || type.rfind("COUNT", 0) == 0;
    return !takes_numbers && word.find_first_not_of("0123456789.,/eE+-", 1) != std::string::npos;
}

// CLI11 parses a value in brackets as a list, and one that starts with this character as text.
constexpr char text_prefix = '=';

// Sorts the command line into the order that CLI11 parses as intended: commands, options with their values, "--",
// positionals. Otherwise it takes an option as the value of the preceding one, and "--" after a positional as the end
// of the command. Failure (usage) for the first word that does not fit.
class SortedWords {
public:
    SortedWords(const CLI::App &root, const KeyTables &tables, const std::vector<std::string> &words)
        : app_(&root), tables_(tables), words_(words) {
        const auto end = std::find(words.begin(), words.end(), "--");
        wants_all_ = std::find(words.begin(), end, "--help-all") != end;
        wants_help_ =
            wants_all_ || std::find(words.begin(), end, "-h") != end || std::find(words.begin(), end, "--help") != end;
        bool only_positionals = false;
        while (position_ < words_.size() && !is_done_) {
            const std::string &word = words_[position_++];
            const bool is_option = !only_positionals && word.size() > 1 && word[0] == '-';
            if (is_option && word == "--")
                only_positionals = true;
            else if (!is_option)
                parse_argument(word);
            else if (!wants_help_)
                parse_option(word);
        }
    }

    const CLI::App &command() const { return *app_; }
    bool wants_help() const { return wants_help_; }
    bool wants_all() const { return wants_all_; }  // of it, also the expert options

    // In reverse order, as CLI11 expects.
    std::vector<std::string> reversed() const {
        std::vector<std::string> all = commands_;
        all.insert(all.end(), options_.begin(), options_.end());
        if (!positionals_.empty()) all.emplace_back("--");
        all.insert(all.end(), positionals_.begin(), positionals_.end());
        return {all.rbegin(), all.rend()};
    }

private:
    // A command, one of its verbs, or a positional.
    void parse_argument(const std::string &word) {
        if (!app_->get_subcommands({}).empty()) {
            const CLI::App *command = command_of(*app_, word);
            if (!command) fail_no_command(*app_, word);
            app_ = command;
            commands_.push_back(word);
            return;
        }
        if (wants_help_) return;
        if (positionals_.size() == room())
            throw Failure(LENSPROF_ERROR_ARGUMENT, word + ": unexpected argument; see " + help_command());
        positionals_.push_back(text_prefix + word);
    }

    void parse_option(const std::string &word) {
        const bool is_long = word[1] == '-';
        const size_t equal = word.find('=');
        const std::string name = word.substr(0, equal);
        const CLI::Option *option = app_->get_option_no_throw(is_long ? name : word.substr(0, 2));
        if (option && !is_long && is_flag(*option) && word.size() > 2)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          word + ": " + word.substr(0, 2) + " takes no value; give one option per word");
        if (!option) fail_no_option(name, is_long);
        if (is_flag(*option)) return parse_flag(*option, equal == std::string::npos ? "true" : word.substr(equal + 1));
        const bool has_value = is_long ? equal != std::string::npos : word.size() > 2;
        const size_t value_offset = is_long || equal == 2 ? equal + 1 : 2;  // of --output=FILE, -o=FILE and -oFILE
        const std::string value = has_value ? word.substr(value_offset) : next_value(*option);
        if (counts_[option]++ > 0 && option->get_items_expected_max() == 1)
            throw Failure(LENSPROF_ERROR_ARGUMENT, option->get_name() + ": given more than once; give it once");
        options_.push_back(option->get_name());
        options_.push_back(text_prefix + value);
    }

    // A word with one dash may be a file name, even if an option is similar.
    [[noreturn]] void fail_no_option(const std::string &name, bool is_long) const {
        const std::string now = form_now(*app_, tables_, name);
        if (!now.empty())
            throw Failure(LENSPROF_ERROR_ARGUMENT, name + " is now " + now + "; see " + all_help_command());
        const std::string nearest = did_you_mean(name, names_of_options(*app_)),
                          hint = "put -- before names that start with -";
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      name + ": no such option"
                          + (nearest.empty()      ? "; see " + help_command() + (room() ? ", or " + hint : "")
                             : room() && !is_long ? nearest + " Otherwise " + hint
                                                  : nearest));
    }

    // An option of the program itself, such as --version, ends parsing.
    void parse_flag(const CLI::Option &flag, const std::string &value) {
        const std::string &name = flag.get_name();
        if (value.empty()) throw Failure(LENSPROF_ERROR_ARGUMENT, name + ": takes no value; give " + name + " alone");
        try {
            CLI::detail::to_flag_value(value);
        } catch (const std::exception &) {
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          name + ": takes no value, but " + value + " was given; give " + name + " alone");
        }
        options_.push_back(name + "=" + value);
        is_done_ = !app_->get_parent();
    }

    std::string next_value(const CLI::Option &option) {
        const std::string name = option.get_name(), remedy = "; give " + name + " " + option.get_type_name();
        if (position_ == words_.size()) throw Failure(LENSPROF_ERROR_ARGUMENT, name + ": needs a value" + remedy);
        const std::string &word = words_[position_++];
        if (!looks_like_option(word, option)) return word;
        throw Failure(LENSPROF_ERROR_ARGUMENT, name + ": needs a value, but " + word + " looks like an option" + remedy
                                                   + ", or " + name + "=" + word + " if that is the value");
    }

    // The number of positionals the command takes.
    size_t room() const {
        size_t room = 0;
        for (const CLI::Option *option : app_->get_options())
            if (option->get_positional()) room += static_cast<size_t>(option->get_items_expected_max());
        return room;
    }

    std::string help_command() const { return "`" + path_of(*app_) + " --help`"; }
    std::string all_help_command() const { return "`" + path_of(*app_) + " --help-all`"; }

    const CLI::App *app_;
    const KeyTables &tables_;
    const std::vector<std::string> &words_;
    size_t position_ = 0;
    bool wants_help_ = false, wants_all_ = false, is_done_ = false;
    std::map<const CLI::Option *, uint32_t> counts_;
    std::vector<std::string> commands_, options_, positionals_;
};

// Failure (usage) for a missing required option or positional.
void check_required(const CLI::App &command) {
    for (const CLI::Option *option : command.get_options()) {
        if (!option->get_required() || option->count()) continue;
        const std::string name = option->get_name(),
                          type = option->get_positional() ? "" : " " + option->get_type_name();
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      name + ": missing; give " + name + type + ", see `" + path_of(command) + " --help`");
    }
}

}  // namespace

Command Command::add(const char *name, const std::string &brief, const std::string &about) {
    app_->require_subcommand(0, 1);
    return {*app_->add_subcommand(name, brief + (about.empty() ? "" : "\n" + about))->group("Commands"), *program_};
}

void Command::run(std::function<int(Streams &)> action) {
    program_->actions_->of[app_] = std::move(action);
    if (app_ == program_->app_.get()) return;
    Command messages = expert();
    messages.flag("-q,--quiet", program_->quiet_, "print errors and results only: no progress, notes or warnings");
    messages.flag("-v,--verbose", program_->verbose_, "also print the time of each step and the memory used");
}

Command Command::expert() const {
    Command command = *this;
    command.group_ = expert_group;
    return command;
}

Keys Command::keys(const char *name, const std::string &about, const char *type) {
    auto table = std::make_shared<KeyTable>(KeyTable{name, about, path_of(*app_) + " --help-all", {}});
    words(
        name, type, [table](const std::string &pairs) { table->read(pairs); }, about);
    CLI::Option *option = app_->get_option(name);
    program_->actions_->keys[option] = table;
    return {table, [option](const std::string &text) { option->description(text); }};
}

CLI::Option *Command::add_option(const char *names, const std::string &type, const Read &read,
                                 const std::string &about) {
    const std::string all = names, name = all.substr(all.rfind(',') + 1);
    const auto parse = [app = app_, name, read](const std::vector<std::string> &words) {
        for (const std::string &marked : words) try {
                const std::string word = marked.substr(1);  // without text_prefix
                if (word.empty()) throw std::invalid_argument(empty_text(*app->get_option(name)));
                read(word);
            } catch (const std::invalid_argument &error) {
                throw Failure(LENSPROF_ERROR_ARGUMENT, name + ": " + error.what());
            }
        return true;
    };
    CLI::Option *option = app_->add_option(names, CLI::callback_t(parse), about)->type_name(type);
    option->group(group_);
    return option;
}

void Command::word(const char *names, const std::string &type, const Read &read, const std::string &about) {
    add_option(names, type, read, about);
}

void Command::flag(const char *names, bool &value, const std::string &about) {
    app_->add_flag(names, value, about)->group(group_);
}

void Command::words(const char *names, const std::string &type, const Read &read, const std::string &about) {
    add_option(names, type, read, about)->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(false);
}

void Command::add_positionals(const char *name, const std::string &type, const Read &read, const std::string &about) {
    add_option(name, type, read, about)->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args();
}

void Command::files(const char *name, std::vector<std::string> &values, const std::string &about) {
    add_positionals(
        name, "FILE", [&values](const std::string &given) { values.push_back(given); }, about);
}

void Command::texts(const char *name, std::vector<std::string> &values, const std::string &about) {
    add_positionals(
        name, "", [&values](const std::string &given) { values.push_back(given); }, about);
}

void Command::profile_ids(const char *name, std::vector<int64_t> &values, const std::string &about) {
    add_positionals(
        name, "", [&values](const std::string &given) { values.push_back(profile_id_of(given)); }, about);
}

void Command::require(const char *name) { app_->get_option(name)->required(); }

void Command::group(const std::string &title) { group_ = title; }

void Command::footer(const std::string &text) { app_->footer(text); }

void Command::example(const std::string &command_line) {
    const std::string above = app_->get_footer();
    app_->footer(above + (above.empty() ? "" : "\n") + "Example: " + command_line);
}

Program::Program(const std::string &name, const std::string &about)
    : app_(std::make_unique<CLI::App>(about, name)), actions_(std::make_unique<Actions>()) {
    app_->set_help_flag("-h,--help", "print this help");
    app_->set_help_all_flag("--help-all", "print this help with the expert options");
}

Program::~Program() = default;

const KeyTable *Program::keys_of(const CLI::Option &option) const {
    const auto found = actions_->keys.find(&option);
    return found == actions_->keys.end() ? nullptr : found->second.get();
}

Command Program::root() { return {*app_, *this}; }

std::string Program::help(const std::vector<std::string> &words) const {
    const CLI::App *app = app_.get();
    for (const std::string &word : words) {
        const CLI::App *command = command_of(*app, word);
        if (!command) fail_no_command(*app, word);
        app = command;
    }
    return help_of(*app, false);
}

namespace {

// The largest resident set of this process.
double peak_megabytes() { return 1e-6 * static_cast<double>(system::peak_memory_bytes()); }

}  // namespace

int Program::run(const std::vector<std::string> &words, Streams &streams) {
    const SortedWords sorted(*app_, actions_->keys, words);
    const CLI::App &command = sorted.command();
    if (sorted.wants_help()) {
        streams.out << help_of(command, sorted.wants_all());
        return static_cast<int>(ExitCode::done);
    }
    try {
        std::vector<std::string> reversed = sorted.reversed();
        app_->parse(reversed);
    } catch (const CLI::ParseError &e) {
        check_required(command);
        throw Failure(LENSPROF_ERROR_ARGUMENT, std::string(e.what()) + "; see `" + path_of(command) + " --help`");
    }
    const auto action = actions_->of.find(&command);
    if (action == actions_->of.end())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      command.get_name() + ": give a subcommand: " + joined(names_of_commands(command), ", "));
    if (quiet_ && verbose_)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--quiet and --verbose exclude each other; give one of them");
    if (quiet_ || verbose_) streams.verbosity = quiet_ ? Verbosity::quiet : Verbosity::verbose;
    const auto begin = std::chrono::steady_clock::now();
    const int code = action->second(streams);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    if (verbose_) print_message(streams, format("%.2f s, %.0f MB of memory", elapsed.count(), peak_megabytes()));
    return code;
}

void declare_db(Command &command, std::string &path, const std::string &more) {
    command.file("--db", path,
                 "profile database" + more + "; default lensprof/profiles.db in $XDG_DATA_HOME or ~/.local/share");
}

void declare_json(Command &command, bool &json) { command.flag("--json", json, "print the result as one JSON object"); }

void declare_progress(Command &command, bool &progress) {
    command.expert().flag("--progress", progress, "show progress even if standard error is not a terminal");
}

}  // namespace lensprof
