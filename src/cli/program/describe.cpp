#include <cctype>
#include <sstream>

#include <CLI/CLI.hpp>

#include "cli/program/help_text.hpp"
#include "cli/program/options.hpp"

namespace lensprof {
namespace {

// "auto|1|3", also of a list "raw|jpeg,..."; without ID of "auto|none|ID", which names a value.
std::vector<std::string> choices_of(const std::string &type) {
    std::vector<std::string> choices;
    if (type.find('|') == std::string::npos) return choices;
    std::istringstream words(type.substr(0, type.find(",...")));
    for (std::string word; std::getline(words, word, '|');)
        if (!std::isupper(static_cast<unsigned char>(word[0]))) choices.push_back(word);
    return choices;
}

OptionDescription describe_option(const CLI::Option &option) {
    OptionDescription described;
    described.is_positional = option.get_positional();
    for (const std::string &name : option.get_snames()) described.names.push_back("-" + name);
    for (const std::string &name : option.get_lnames()) described.names.push_back("--" + name);
    if (described.is_positional) described.names = {option.get_name()};
    described.type = option.get_items_expected_max() == 0 ? "" : option.get_type_name();
    described.about = option.get_description();
    described.choices = choices_of(described.type);
    described.is_repeated = option.get_items_expected_max() > 1;
    described.is_required = option.get_required();
    described.is_expert = option.get_group() == expert_group;
    return described;
}

OptionDescription describe_key(const KeyTable::Key &key) {
    OptionDescription described;
    described.names = {key.name};
    described.type = key.type;
    described.about = key.about;
    described.choices = choices_of(key.type);
    return described;
}

CommandDescription describe_command(const Program &program, const CLI::App &app, const std::string &above) {
    CommandDescription described;
    described.path = above.empty() ? app.get_name() : above + " " + app.get_name();
    const std::string about = app.get_description();
    const size_t line = about.find('\n');
    described.brief = about.substr(0, line);
    if (line != std::string::npos) described.about = about.substr(line + 1);
    described.footer = app.get_footer();
    for (const CLI::Option *option : app.get_options()) {
        described.options.push_back(describe_option(*option));
        if (const KeyTable *table = program.keys_of(*option))
            for (const KeyTable::Key &key : table->keys) described.options.back().keys.push_back(describe_key(key));
    }
    for (const CLI::App *command : app.get_subcommands({}))
        described.commands.push_back(describe_command(program, *command, described.path));
    return described;
}

}  // namespace

CommandDescription Program::describe() const { return describe_command(*this, *app_, ""); }

}  // namespace lensprof
