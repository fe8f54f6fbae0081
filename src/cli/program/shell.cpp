#include "cli/program/shell.hpp"

#include <lensprof/base.h>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"

namespace lensprof {
namespace {

using Script = std::string (*)(const CommandDescription &);

// The command with these words; Failure (usage).
const CommandDescription &command_named(const CommandDescription &program, const std::vector<std::string> &words) {
    const CommandDescription *command = &program;
    for (const std::string &word : words) {
        const CommandDescription *found = nullptr;
        for (const CommandDescription &verb : command->commands)
            if (verb.name() == word) found = &verb;
        if (!found) throw Failure(LENSPROF_ERROR_ARGUMENT, word + ": no such command; `lensprof help` lists them");
        command = found;
    }
    return *command;
}

size_t write_pages(const CommandDescription &command, const std::string &folder) {
    const std::string page = man_page(command, lensprof_version());
    write_file(folder + "/" + man_name(command) + ".1", page.data(), page.size());
    size_t pages = 1;
    for (const CommandDescription &verb : command.commands) pages += write_pages(verb, folder);
    return pages;
}

}  // namespace

void declare_completion(Command &root, const Program &program) {
    Command command = root.add("completion", "print a completion script for bash, zsh or fish",
                               "Prints a script that completes commands, options, their values and file names.");
    auto script = std::make_shared<Script>(bash_completion);
    command.choice("SHELL", *script, {{"bash", bash_completion}, {"zsh", zsh_completion}, {"fish", fish_completion}},
                   "bash, zsh or fish");
    command.require("SHELL");
    command.footer(
        "bash:  lensprof completion bash > ~/.local/share/bash-completion/completions/lensprof\n"
        "zsh:   lensprof completion zsh > DIR/_lensprof, where DIR is in $fpath\n"
        "fish:  lensprof completion fish > ~/.config/fish/completions/lensprof.fish");
    command.run([script, &program](Streams &streams) {
        streams.out << (*script)(program.describe());
        return 0;
    });
}

void declare_man(Command &root, const Program &program) {
    struct Options {
        std::vector<std::string> words;
        std::string folder;
    };
    Command command = root.add("man", "print the man page of a command, or write all of them",
                               "Prints a man page in roff; `lensprof man build | man -l -` shows it.");
    auto o = std::make_shared<Options>();
    command.texts("COMMAND", o->words, "the command, and its verb; default the program");
    command.folder("-o,--output", o->folder, "write the pages of all commands to this folder");
    command.run([o, &program](Streams &streams) {
        const CommandDescription all = program.describe();
        if (o->folder.empty()) {
            streams.out << man_page(command_named(all, o->words), lensprof_version());
            return 0;
        }
        if (!o->words.empty())
            throw Failure(LENSPROF_ERROR_ARGUMENT, "man: -o writes the pages of all commands; leave COMMAND out");
        make_folder(o->folder);
        const size_t pages = write_pages(all, o->folder);
        streams.out << "wrote " << counted(pages, "man page") << " to " << o->folder << "\n";
        return 0;
    });
}

}  // namespace lensprof
