#include <algorithm>

#include "cli/program/description.hpp"

namespace lensprof {
namespace {

constexpr const char *page_date = "2026-11-26";  // of the last change of the commands

// Text for roff: no line starts with a control character, and hyphens of options stay hyphens.
std::string roff_text(const std::string &text) {
    std::string escaped;
    bool starts_line = true;
    for (const char c : text) {
        if (starts_line && (c == '.' || c == '\'')) escaped += "\\&";
        escaped += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
        starts_line = c == '\n';
    }
    return escaped;
}

std::string bold(const std::string &text) { return "\\fB" + roff_text(text) + "\\fR"; }
std::string italic(const std::string &text) { return "\\fI" + roff_text(text) + "\\fR"; }

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return text;
}

// `-o, --output FILE`.
std::string heading_of(const OptionDescription &option) {
    std::string heading;
    for (const std::string &name : option.names)
        heading += (heading.empty() ? "" : ", ") + (option.is_positional ? italic(name) : bold(name));
    if (!option.is_positional && !option.type.empty()) heading += " " + italic(option.type);
    return heading + (option.is_repeated && option.type.find(",...") == std::string::npos ? " ..." : "");
}

// Text of several lines, such as a table of keys.
std::string lines_of(const std::string &text) {
    std::string lines;
    for (const char c : roff_text(text)) lines += c == '\n' ? std::string("\n.br\n") : std::string(1, c);
    return lines;
}

template <class IsIn>
std::string options_section(const CommandDescription &command, const std::string &title, const IsIn &is_in) {
    std::string text;
    for (const OptionDescription &option : command.options)
        if (is_in(option)) text += ".TP\n" + heading_of(option) + "\n" + lines_of(option.about) + "\n";
    return text.empty() ? text : ".SH " + title + "\n" + text;
}

std::string options_sections(const CommandDescription &command) {
    using Option = OptionDescription;
    return options_section(command, "ARGUMENTS", [](const Option &option) { return option.is_positional; })
           + options_section(command, "OPTIONS",
                             [](const Option &option) { return !option.is_positional && !option.is_expert; })
           + options_section(command, "EXPERT OPTIONS", [](const Option &option) { return option.is_expert; });
}

std::string synopsis(const CommandDescription &command) {
    std::string line = bold(command.path);
    if (!command.commands.empty()) return line + (command.name() == "lensprof" ? " COMMAND" : " VERB") + " [OPTIONS]\n";
    line += " [OPTIONS]";
    for (const OptionDescription &option : command.options)
        if (option.is_positional)
            line += " " + std::string(option.is_required ? "" : "[") + italic(option.names[0])
                    + (option.is_repeated ? "..." : "") + (option.is_required ? "" : "]");
    return line + "\n";
}

}  // namespace

std::string man_name(const CommandDescription &command) {
    std::string name = command.path;
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

std::string man_page(const CommandDescription &command, const std::string &version) {
    std::string page = ".TH " + upper(man_name(command)) + " 1 \"" + std::string(page_date) + "\" \"lensprof " + version
                       + "\" \"lensprof manual\"\n";
    page += ".SH NAME\n" + roff_text(man_name(command)) + " \\- " + roff_text(command.brief) + "\n";
    page += ".SH SYNOPSIS\n" + synopsis(command);
    if (!command.about.empty()) page += ".SH DESCRIPTION\n" + roff_text(command.about) + "\n";
    if (!command.commands.empty()) {
        page += command.name() == "lensprof" ? ".SH COMMANDS\n" : ".SH VERBS\n";
        for (const CommandDescription &verb : command.commands)
            page += ".TP\n" + bold(verb.name()) + "\n" + roff_text(verb.brief) + "\n";
    }
    page += options_sections(command);
    if (!command.footer.empty()) page += ".SH NOTES\n.nf\n" + roff_text(command.footer) + "\n.fi\n";
    page += ".SH SEE ALSO\n";
    if (command.name() == "lensprof")
        for (size_t i = 0; i < command.commands.size(); i++)
            page += ".BR " + roff_text(man_name(command.commands[i])) + " (1)"
                    + (i + 1 < command.commands.size() ? "," : "") + "\n";
    else
        page += ".BR lensprof (1)\n";
    return page;
}

}  // namespace lensprof
