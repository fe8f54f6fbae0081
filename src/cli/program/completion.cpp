// Completions are made of one table of words per command; files complete where a value is a file or folder.
#include <algorithm>

#include "cli/program/description.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// All commands and verbs, the program first.
void collect(const CommandDescription &command, std::vector<const CommandDescription *> &all) {
    all.push_back(&command);
    for (const CommandDescription &verb : command.commands) collect(verb, all);
}

std::vector<const CommandDescription *> all_of(const CommandDescription &program) {
    std::vector<const CommandDescription *> all;
    collect(program, all);
    return all;
}

// "profile list" of "lensprof profile list"; empty for the program.
std::string words_of(const CommandDescription &command) {
    const size_t space = command.path.find(' ');
    return space == std::string::npos ? std::string() : command.path.substr(space + 1);
}

bool is_path(const OptionDescription &option) { return option.type == "FILE" || option.type == "FOLDER"; }

std::string first_line(const std::string &text) { return text.substr(0, text.find('\n')); }

// A description in a list of zsh, where colons and brackets have a meaning.
std::string zsh_text(const std::string &text) {
    std::string escaped;
    for (const char c : text) escaped += c == ':' || c == '[' || c == ']' ? std::string("\\") + c : std::string(1, c);
    return escaped;
}

// The values of a positional that are words; of `help` and `man`, all commands.
std::vector<std::string> choices_of(const CommandDescription &program, const OptionDescription &positional) {
    if (positional.names[0] != "COMMAND") return positional.choices;
    std::vector<std::string> names;
    for (const CommandDescription &named : program.commands) names.push_back(named.name());
    return names;
}

// The words that may follow a command: verbs, choices of its arguments, and options.
std::vector<std::string> following_words(const CommandDescription &program, const CommandDescription &command) {
    std::vector<std::string> words;
    for (const CommandDescription &verb : command.commands) words.push_back(verb.name());
    for (const OptionDescription &option : command.options) {
        const std::vector<std::string> more = option.is_positional ? choices_of(program, option) : option.names;
        words.insert(words.end(), more.begin(), more.end());
    }
    return words;
}

bool takes_files(const CommandDescription &command) {
    return std::any_of(command.options.begin(), command.options.end(),
                       [](const OptionDescription &option) { return option.is_positional && is_path(option); });
}

std::string bash_cases(const CommandDescription &program) {
    std::string lines;
    for (const CommandDescription *command : all_of(program))
        lines += "    " + shell_quoted(words_of(*command))
                 + ") words=" + shell_quoted(joined(following_words(program, *command), " "))
                 + (takes_files(*command) ? "; files=1" : "; files=") + " ;;\n";
    return lines;
}

// The words that a value may be: of KEY=VALUE pairs, the keys.
std::vector<std::string> values_of(const OptionDescription &option) {
    std::vector<std::string> values = option.choices;
    for (const OptionDescription &key : option.keys) values.push_back(key.names[0] + "=");
    return values;
}

// What completes the value after `word`.
std::string bash_value(const std::string &word, const OptionDescription &option) {
    return "    " + shell_quoted(word) + ") "
           + (is_path(option) ? std::string("files=1")
                              : "values=" + shell_quoted(joined(values_of(option), " ")) + "; files=")
           + "; takes=1 ;;\n";
}

std::string bash_values(const CommandDescription &program) {
    std::string lines;
    for (const CommandDescription *command : all_of(program))
        for (const OptionDescription &option : command->options) {
            const std::string path = words_of(*command) + " ";
            for (const std::string &name : option.names)
                if (!option.is_positional && !option.type.empty()) lines += bash_value(path + name, option);
            for (const OptionDescription &key : option.keys) lines += bash_value(path + key.names[0] + "=", key);
        }
    return lines;
}

}  // namespace

std::string bash_completion(const CommandDescription &program) {
    return "# bash completion of lensprof; made by `lensprof completion bash`.\n"
           "_lensprof_words() {\n"
           "  case \"$1\" in\n"
           + bash_cases(program)
           + "  esac\n"
             "}\n"
             "_lensprof() {\n"
             "  local command='' topic='' word i words='' values='' files='' takes=''\n"
             "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
             "  if [[ $current == = ]]; then current= takes=1\n"  // bash splits --option=value and key=value
             "  elif [[ $previous == = ]]; then previous=${COMP_WORDS[COMP_CWORD-2]} takes=1; fi\n"
             "  [[ $takes && $previous != -* ]] && previous=${previous##*,}=\n"
             "  takes=\n"
             "  _lensprof_words ''\n"
             "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
             "    word=${COMP_WORDS[i]}\n"
             "    if [[ $word == -- ]]; then mapfile -t COMPREPLY < <(compgen -f -- \"$current\"); return; fi\n"
             "    [[ $word != -* && \" $words \" == *\" $word \"* ]] || continue\n"
             "    if [[ $command == help || $command == man ]]; then topic=${topic:+$topic }$word\n"
             "    else command=${command:+$command }$word; fi\n"
             "    _lensprof_words \"${topic:-$command}\"\n"
             "  done\n"
             "  case \"$command $previous\" in\n"
           + bash_values(program)
           + "  esac\n"
             "  [[ $takes ]] && words=$values\n"
             "  [[ $topic ]] && files=\n"
             "  [[ $current == -* && ! $takes ]] && files=\n"
             "  [[ $current != -* && ! $takes ]] && words=$(printf '%s\\n' $words | grep -v '^-')\n"
             "  mapfile -t COMPREPLY < <(compgen ${files:+-f} -W \"$words\" -- \"$current\")\n"
             "  [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2> /dev/null\n"
             "  return 0\n"
             "}\n"
             "complete -o filenames -F _lensprof lensprof\n";
}

std::string zsh_completion(const CommandDescription &program) {
    std::string text =
        "#compdef lensprof\n# zsh completion of lensprof; made by `lensprof completion zsh`.\n"
        "_lensprof() {\n"
        "  local command='' word\n"
        "  local -a entries\n"
        "  for word in ${words[2,CURRENT-1]}; do\n"
        "    case \"$command $word\" in\n";
    for (const CommandDescription *command : all_of(program))
        for (const CommandDescription &verb : command->commands)
            text += "      " + shell_quoted(words_of(*command) + " " + verb.name())
                    + ") command=" + shell_quoted(words_of(verb)) + " ;;\n";
    text += "    esac\n  done\n  case \"$command\" in\n";
    for (const CommandDescription *command : all_of(program)) {
        text += "    " + shell_quoted(words_of(*command)) + ")\n";
        if (!command->commands.empty()) {
            text += "      entries=(";
            for (const CommandDescription &verb : command->commands)
                text += "\n        " + shell_quoted(verb.name() + ":" + zsh_text(first_line(verb.brief)));
            text += ")\n      _describe command entries ;;\n";
            continue;
        }
        text += "      _arguments -s";
        std::vector<std::string> choices;  // of a positional
        for (const OptionDescription &option : command->options) {
            if (option.is_positional) {
                choices = choices_of(program, option);
                continue;
            }
            for (const std::string &name : option.names) {
                std::string entry = (option.is_repeated ? "*" : "") + name;
                if (!option.type.empty() && name.size() > 2) entry += "=";
                entry += "[" + zsh_text(first_line(option.about)) + "]";
                if (!option.type.empty())
                    entry += is_path(option)             ? ":file:_files"
                             : values_of(option).empty() ? ":value:"
                                                         : ":value:(" + joined(values_of(option), " ") + ")";
                text += " \\\n        " + shell_quoted(entry);
            }
        }
        text += " \\\n        "
                + shell_quoted(choices.empty() ? "*:file:_files" : "*:value:(" + joined(choices, " ") + ")") + " ;;\n";
    }
    return text + "  esac\n}\n_lensprof \"$@\"\n";
}

std::string fish_completion(const CommandDescription &program) {
    std::string text = "# fish completion of lensprof; made by `lensprof completion fish`.\n";
    for (const CommandDescription *command : all_of(program)) {
        const std::string path = words_of(*command);
        std::string condition = "__fish_use_subcommand";
        if (!path.empty()) {
            std::string conditions;
            for (size_t begin = 0; begin < path.size();) {
                const size_t end = std::min(path.find(' ', begin), path.size());
                conditions += (conditions.empty() ? "" : "; and ") + std::string("__fish_seen_subcommand_from ")
                              + path.substr(begin, end - begin);
                begin = end + 1;
            }
            condition = conditions;
        }
        for (const CommandDescription &verb : command->commands)
            text += "complete -c lensprof -f -n " + shell_quoted(condition) + " -a " + shell_quoted(verb.name())
                    + " -d " + shell_quoted(first_line(verb.brief)) + "\n";
        for (const OptionDescription &option : command->options) {
            if (option.is_positional) {
                const std::vector<std::string> choices = choices_of(program, option);
                if (!choices.empty())
                    text += "complete -c lensprof -f -n " + shell_quoted(condition) + " -a "
                            + shell_quoted(joined(choices, " ")) + "\n";
                continue;
            }
            text += "complete -c lensprof -n " + shell_quoted(condition);
            for (const std::string &name : option.names)
                text += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
            if (!option.type.empty()) text += is_path(option) ? " -r -F" : " -x";
            if (!values_of(option).empty()) text += " -a " + shell_quoted(joined(values_of(option), " "));
            text += " -d " + shell_quoted(first_line(option.about)) + "\n";
        }
    }
    return text;
}

}  // namespace lensprof
