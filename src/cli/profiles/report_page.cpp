// `lensprof report`: pictures, a project, profiles or a database -> a web page.
#include <algorithm>
#include <sstream>

#include "cli/fitting/build.hpp"
#include "cli/page/page.hpp"
#include "cli/profiles/database_page.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/key_options.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/key_filter.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/reconstruction/reconstruction_file.hpp"

namespace lensprof {
namespace {

struct PageOptions {
    std::vector<std::string> inputs, dbs;
    std::string output, images;
    int64_t id = 0;
    KeyFilter filter;
};

void declare(Command &command, PageOptions &o) {
    command.files(
        "FILE", o.inputs,
        "pictures, folders of them, a Hugin project or a reconstruction, which are fitted as `build` does; or "
        "a profile database; or a file of profiles; default: the databases of --db");
    command.file("-o,--output", o.output, "write this .html file");
    command.require("-o");
    command.folder("--images", o.images, "folder of the pictures of a reconstruction; default: next to it");
    command.group("Profiles of a database");
    command.profile_id("--profile", o.id, "report the profile with this id alone");
    declare_key_filter(command, o.filter);
    declare_listed_databases(command, o.dbs);
    command.footer(
        "The page is one file that needs no network. It contains the pictures before and after, the charts,\n"
        "and the numbers as JSON.");
    command.example("lensprof report photos -o report.html");
}

// Whether a file is a database of lensprof, intact or damaged: by SQLite's name and the application id, at bytes 68 to
// 71 of the header.
bool is_profile_database(const std::string &path) {
    if (!is_regular_file(path)) return false;
    const std::string head = read_head(path, 72);
    return head.size() == 72 && head.compare(0, 15, "SQLite format 3") == 0 && head.compare(68, 4, "LPRF") == 0;
}

enum class Kind {
    database,
    profiles,  // a file that another program keeps profiles in,
    part,      // or a response or falloff without a key
    to_fit     // pictures, a project, a reconstruction; or nothing that anybody can read
};

Kind kind_of(const std::string &path) {
    if (is_profile_database(path)) return Kind::database;
    if (!is_regular_file(path) || is_reconstruction(path)) return Kind::to_fit;
    try {
        if (format_to_read(path, "").holds == LENSPROF_HOLDS_PROFILES) return Kind::profiles;
        return is_picture_name(path) ? Kind::to_fit : Kind::part;
    } catch (const Failure &) {
        return Kind::to_fit;
    }
}

std::vector<StoredProfile> profiles_of_file(const std::string &path, Streams &streams) {
    struct Found {
        std::vector<StoredProfile> profiles;
        size_t invalid = 0;
    } found;
    const auto keep = [](void *user, const lensprof_import_entry *entry) {
        Found &all = *static_cast<Found *>(user);
        if (entry->usable)
            all.profiles.push_back({0, std::make_unique<lensprof_profile>(*entry->profile)});
        else
            all.invalid++;
        return LENSPROF_OK;
    };
    read_profiles(format_to_read(path, ""), path, keep, &found);
    if (found.invalid)
        warn(streams, path + ": " + counted(found.invalid, "profile") + " with an invalid falloff left out");
    if (found.profiles.empty())
        throw Failure(LENSPROF_ERROR_NOT_FOUND, path + ": has no valid profile; give another file");
    return std::move(found.profiles);
}

// Everything in the databases, except rows that are damaged: a warning counts these.
std::vector<StoredProfile> all_profiles(const Databases &databases, Streams &streams) {
    std::vector<StoredProfile> profiles;
    for (size_t i = 0; i < databases.size(); i++) {
        const auto list = [&](lensprof_store_row *rows, uint32_t capacity, uint32_t *count, lensprof_error *error) {
            return lensprof_store_list(databases.store(i), nullptr, rows, capacity, count, error);
        };
        size_t damaged = 0;
        for (const lensprof_store_row &row : listed<lensprof_store_row>(databases.file(i), list)) {
            auto profile = new_profile();
            if (row.damaged || lensprof_store_get(databases.store(i), row.id, profile.get(), nullptr) != LENSPROF_OK)
                damaged++;
            else
                profiles.push_back({row.id, std::move(profile)});
        }
        if (damaged)
            warn(streams, databases.file(i) + ": " + counted(damaged, "damaged profile")
                              + " left out; see `lensprof profile check`");
    }
    if (profiles.empty())
        throw Failure(LENSPROF_ERROR_NOT_FOUND,
                      databases.names() + ": no profile is stored; make one with `lensprof build`, or `make profiles`");
    return profiles;
}

// The profiles that are asked for.
std::vector<StoredProfile> profiles_of(const PageOptions &o, const Databases &databases, Streams &streams) {
    if (!o.id && o.filter.is_empty()) return all_profiles(databases, streams);
    return o.filter.profiles(databases, o.id ? std::vector<int64_t>{o.id} : std::vector<int64_t>{}, false);
}

// A fit's page is what `build` writes of it.
int report_fit(const PageOptions &o, Streams &streams) {
    std::ostringstream table;  // what build prints is in the report
    Streams quiet = streams.with(table, streams.err);
    bool is_written = false;
    const CommitWatch watch([&](const std::string &path, const std::string &) { is_written |= path == o.output; });
    const int code = build_page(o.inputs, o.images, o.output, quiet);
    if (is_written) streams.out << "wrote " << o.output << "\n";
    return code;
}

// Writes the page of profiles.
int write_page(const PageOptions &o, const std::vector<StoredProfile> &profiles, const std::string &name,
               Streams &streams) {
    const std::string command = command_text(streams.words);
    const std::string page = profiles.size() == 1 ? profile_page(profiles[0], command)
                                                  : database_page(profiles, name, command, streams.warnings);
    write_file(o.output, page.data(), page.size());
    streams.out << "wrote " << o.output << ": " << counted(profiles.size(), "profile") << "\n";
    return 0;
}

// Failure (usage) for inputs that do not go together with each other or the options.
void check_inputs(const PageOptions &o, const std::vector<Kind> &kinds, bool asks_profiles) {
    if (kinds.size() == 1 && kinds[0] == Kind::part)
        throw Failure(LENSPROF_ERROR_ARGUMENT, o.inputs[0] + ": holds a response or a falloff, but no profile; import it with "
                                                     "`lensprof profile import` and report the database");
    if (!o.inputs.empty() && !o.dbs.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "report: give files or --db, not both");
    if (!o.images.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--images: applies to a reconstruction, not to profiles; leave it out");
    const bool is_one_file = kinds.size() == 1 && kinds[0] == Kind::profiles && !asks_profiles;
    for (size_t i = 0; i < kinds.size() && !is_one_file; i++)
        if (kinds[i] != Kind::database)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          o.inputs[i]
                              + ": is not a profile database; give one kind of files: pictures, databases, or one file "
                                "of profiles without --profile and names");
}

int run_report(const PageOptions &o, Streams &streams) {
    check_page_name(o.output);
    const bool asks_profiles = o.id || !o.filter.is_empty() || !o.dbs.empty();
    std::vector<Kind> kinds;
    for (const std::string &input : o.inputs) kinds.push_back(kind_of(input));
    const bool is_fit = !kinds.empty() && !asks_profiles && std::all_of(kinds.begin(), kinds.end(), [](Kind kind) {
        return kind != Kind::database && kind != Kind::profiles;
    });
    if (is_fit && !(kinds.size() == 1 && kinds[0] == Kind::part)) return report_fit(o, streams);
    check_inputs(o, kinds, asks_profiles);
    const bool is_of_file = kinds.size() == 1 && kinds[0] == Kind::profiles;
    const std::vector<std::string> files = is_of_file ? o.inputs : databases_of(o.inputs.empty() ? o.dbs : o.inputs);
    check_not_reserved(o.output, "report", files);
    check_output_file(o.output);
    if (is_of_file) return write_page(o, profiles_of_file(files[0], streams), files[0], streams);
    const Databases databases(files);
    return write_page(o, profiles_of(o, databases, streams), databases.names(), streams);
}

}  // namespace

void declare_report(Command &program) {
    Command command = program.add("report", "write a report on pictures, profiles or a database as a web page",
                                  "Writes a web page: verdict, pictures before and after, charts and numbers.");
    auto o = std::make_shared<PageOptions>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run_report(*o, streams); });
}

}  // namespace lensprof
