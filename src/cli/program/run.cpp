#include "cli/program/run.hpp"

#include <algorithm>
#include <new>

#include <lensprof/base.h>

#include "cli/program/commands.hpp"
#include "cli/program/error.hpp"

namespace lensprof {
namespace {

int run_version(const std::vector<std::string> &, Streams &streams) {
    streams.out << "lensprof " << lensprof_version() << "\n";
    return 0;
}

int run_help(const std::vector<std::string> &arguments, Streams &streams);

const Command commands[] = {
    {"build", "pictures of a Hugin project -> a lens profile in the database", run_build},
    {"bracket", "pictures of one scene at several exposures -> the camera's response", run_bracket},
    {"flat", "pictures of a white card or another even light -> a lens profile in the database", run_flat},
    {"apply", "correct pictures with a profile or a project", run_apply},
    {"align", "frames of a sequence -> all with one exposure and white balance", run_align},
    {"query", "look a profile up by camera, lens, focal length and aperture", run_query},
    {"profile", "list, show, remove, export, import, merge or check profiles", run_profile},
    {"simulate", "render overlapping pictures with a known camera", run_simulate},
    {"version", "print the version", run_version},
    {"help", "print this, or the help of a command", run_help},
};

const Command *find_command(const std::string &name) {
    auto match =
        std::find_if(std::begin(commands), std::end(commands), [&](const Command &c) { return name == c.name; });
    return match == std::end(commands) ? nullptr : match;
}

int run_help(const std::vector<std::string> &arguments, Streams &streams) {
    const Command *command = arguments.empty() ? nullptr : find_command(arguments[0]);
    if (command && command->run != run_help && command->run != run_version) {
        std::vector<std::string> words(arguments.begin() + 1, arguments.end());
        words.push_back("--help");
        return command->run(words, streams);
    }
    if (!arguments.empty() && !command)
        throw Failure(ExitCode::usage, arguments[0] + ": no such command; `lensprof help` lists them");
    streams.out << "lensprof - what the camera did to the light, and how to undo it\n\n"
                   "usage: lensprof COMMAND [OPTIONS]\n\n";
    for (const Command &c : commands) {
        std::string name = c.name;
        streams.out << "  " << name << std::string(10 - name.size(), ' ') << c.help << "\n";
    }
    streams.out << "\n`lensprof help COMMAND` tells a command's options.\n"
                   "exit codes: 0 done, 1 failed, 2 usage, 3 input unreadable, 4 fit not usable, 5 not found, "
                   "6 store, 130 interrupted\n";
    return 0;
}

}  // namespace

int run(const std::vector<std::string> &words, Streams &streams) {
    try {
        if (words.empty()) {
            run_help({}, streams);
            return static_cast<int>(ExitCode::usage);
        }
        std::string name = words[0] == "--help" || words[0] == "-h" ? "help"
                           : words[0] == "--version"                ? "version"
                                                                    : words[0];
        const Command *command = find_command(name);
        if (!command) throw Failure(ExitCode::usage, name + ": no such command; `lensprof help` lists them");
        return command->run({words.begin() + 1, words.end()}, streams);
    } catch (const Failure &failure) {
        streams.err << "lensprof: " << failure.what() << "\n";
        return static_cast<int>(failure.code);
    } catch (const std::bad_alloc &) {
        streams.err << "lensprof: out of memory\n";
    } catch (const std::exception &e) {
        streams.err << "lensprof: " << e.what() << "\n";
    }
    return static_cast<int>(ExitCode::failed);
}

}  // namespace lensprof
