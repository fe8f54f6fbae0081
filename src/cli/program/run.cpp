#include "cli/program/run.hpp"

#include <new>

#include <lensprof/base.h>

#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/shell.hpp"
#include "photo/base/failure.hpp"

namespace lensprof {
namespace {

int print_version(Streams &streams) {
    streams.out << "lensprof " << lensprof_version() << "\n";
    return 0;
}

void declare_help(Command &root, const Program &program) {
    Command help = root.add("help", "print this help, or the help of a command");
    auto words = std::make_shared<std::vector<std::string>>();
    help.texts("COMMAND", *words, "the command, optionally followed by its verb");
    help.run([words, &program](Streams &streams) {
        streams.out << program.help(*words);
        return 0;
    });
}

void declare_root(Command &root, const Program &program) {
    auto version = std::make_shared<bool>(false);
    root.flag("--version", *version, "print the version");
    root.footer(
        "Run `lensprof help COMMAND` for its everyday options, `lensprof COMMAND --help-all` for all.\n"
        "exit codes: 0 done, 1 failed, 2 usage, 3 input unreadable, 4 fit not usable, 5 not found, 6 store,\n"
        "130 interrupted");
    root.run([version, &program](Streams &streams) {
        if (*version) return print_version(streams);
        streams.out << program.help({});
        return static_cast<int>(ExitCode::usage);
    });
}

void declare_all(Command root, const Program &program) {
    declare_calibrate(root);
    declare_build(root);
    declare_bracket(root);
    declare_response(root);
    declare_flat(root);
    declare_apply(root);
    declare_align(root);
    declare_deflicker(root);
    declare_query(root);
    declare_profile(root);
    declare_report(root);
    declare_simulate(root);
    declare_doctor(root);
    declare_completion(root, program);
    declare_man(root, program);
    root.add("version", "print the version").run(print_version);
    declare_help(root, program);
    declare_root(root, program);  // last: commands would inherit its footer
}

}  // namespace

int run(const std::vector<std::string> &words, Streams &streams) {
    streams.words = words;
    Progress events(streams);
    CallerScope caller(&events);
    try {
        Program program("lensprof", "calibrate camera response and vignetting, and correct pictures");
        declare_all(program.root(), program);
        return program.run(words, streams);
    } catch (const Failure &failure) {
        print_message(streams, failure.what());
        return static_cast<int>(exit_code(failure.status));
    } catch (const std::bad_alloc &) {
        print_message(streams, "out of memory; close other programs or use smaller pictures");
    } catch (const std::exception &e) {
        print_message(streams, e.what());
    }
    return static_cast<int>(ExitCode::failed);
}

}  // namespace lensprof
