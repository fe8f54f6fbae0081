#include "cli/program/help_text.hpp"

#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>

namespace lensprof {

// The end of the word that starts at `from`: the next space that is not within `...`, which stays on one line.
static size_t word_end(const std::string &text, size_t from) {
    for (size_t at = from; at < text.size(); at++) {
        if (text[at] == ' ') return at;
        if (text[at] == '`') at = std::min(text.find('`', at + 1), text.size());
    }
    return text.size();
}

std::string wrapped(const std::string &text, size_t columns) {
    std::string lines;
    std::istringstream paragraphs(text);
    for (std::string paragraph; std::getline(paragraphs, paragraph);) {
        if (!lines.empty()) lines += '\n';
        size_t column = 0;
        for (size_t at = 0, end; at < paragraph.size(); at = end + 1) {
            end = word_end(paragraph, at);
            const std::string word = paragraph.substr(at, end - at);
            if (column > 0 && column + 1 + word.size() > columns)
                lines += '\n', column = 0;
            else if (at > 0 && column > 0)
                lines += ' ', column++;
            lines += word, column += word.size();
        }
    }
    return lines;
}

namespace {

// Wraps descriptions. A list of commands shows only the first line of each description.
class HelpText : public CLI::Formatter {
public:
    explicit HelpText(bool with_expert) : with_expert_(with_expert) { label("SUBCOMMAND", "VERB"); }
    std::string make_group(std::string group, bool is_positional,
                           std::vector<const CLI::Option *> options) const override {
        if (group == expert_group && !with_expert_) return "";
        return CLI::Formatter::make_group(group, is_positional, options);
    }
    std::string make_option_opts(const CLI::Option *option) const override {
        if (option->get_items_expected_max() == 0) return "";
        const std::string type = option->get_type_name();
        const bool is_list = type.size() > 4 && type.compare(type.size() - 4, 4, ",...") == 0;
        return (option->get_positional() || type.empty() ? "" : " " + type)
               + (option->get_items_expected_max() > 1 && !is_list ? " ..." : "");
    }
    std::string make_option_desc(const CLI::Option *option) const override {
        const std::string about = CLI::Formatter::make_option_desc(option);
        const std::string shown = with_expert_ ? about : about.substr(0, about.find('\n'));  // without tables of keys
        return wrapped(shown, help_columns - get_column_width());
    }
    std::string make_description(const CLI::App *app) const override {
        const std::string about = CLI::Formatter::make_description(app);
        return about.empty() ? about : wrapped(about, help_columns) + "\n";
    }
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

private:
    bool with_expert_;
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_formatter(bool with_expert) { return std::make_shared<HelpText>(with_expert); }

}  // namespace lensprof
