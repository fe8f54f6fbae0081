#include "cli/program/database_options.hpp"

namespace lensprof {
namespace {

void declare_files(Command &command, std::vector<std::string> &files, const std::string &about) {
    command.words(
        "--db", "FILE", [&files](const std::string &word) { files.push_back(word); },
        about
            + "; default lensprof/profiles.db in $XDG_DATA_HOME or ~/.local/share, then the lens data installed with "
              "lensprof");
}

}  // namespace

void declare_databases(Command &command, std::vector<std::string> &files, const std::string &more) {
    declare_files(
        command, files,
        "profile database" + more + "; repeat to search several: the first that has the lens or the camera answers");
}

void declare_listed_databases(Command &command, std::vector<std::string> &files, const std::string &more) {
    declare_files(command, files, "profile database; repeat to read several" + more);
}

}  // namespace lensprof
