// `lensprof doctor`: the installation and the databases, for a report of a problem.
#include <thread>

#include <nlohmann/json.hpp>

#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/utf8.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/registration/registration.hpp"
#include "photo/video/video.hpp"

namespace lensprof {
namespace {

struct Part {
    const char *library, *use;
    bool is_there;
};

std::vector<Part> optional_parts() {
    return {{"OpenCV", "finds the overlaps of pictures", can_register()},
            {"libav", "reads and writes videos", can_read_video()},
            {"LibRaw", "reads camera raw files", can_read_raw()},
            {"libheif", "reads HEIC and AVIF", can_read_heif()},
            {"libwebp", "reads WebP", can_read_webp()},
            {"libjxl", "reads JPEG XL", can_read_jxl()},
            {"cfitsio", "reads FITS", can_read_fits()},
            {"OpenEXR", "writes OpenEXR", can_write_exr()}};
}

struct DatabaseState {
    std::string file, role;
    bool exists = false;
    std::string fault;  // why it cannot be read; empty: it can
    lensprof_store_stats stats{};
};

DatabaseState state_of(const std::string &file, const std::string &role) {
    DatabaseState state{file, role, is_regular_file(file), {}, {}};
    lensprof_store_stats_init(&state.stats);
    if (!state.exists && path_exists(file)) state.exists = true, state.fault = "not a regular file";
    if (!state.exists || !state.fault.empty()) return state;
    lensprof_store *opened = nullptr;
    lensprof_error error{};
    lensprof_status status = lensprof_store_open(file.c_str(), LENSPROF_STORE_READ, &opened, &error);
    const Store store(opened);
    if (status == LENSPROF_OK) status = lensprof_store_get_stats(store.get(), &state.stats, &error);
    if (status != LENSPROF_OK) state.fault = *error.text ? error.text : lensprof_status_name(status);
    return state;
}

std::vector<DatabaseState> databases_to_check(const std::vector<std::string> &named) {
    std::vector<DatabaseState> states;
    for (const std::string &file : named) {
        states.push_back(state_of(file, "named by --db"));
        if (!states.back().exists) states.back().fault = "no such file";
    }
    if (!named.empty()) return states;
    try {
        states.push_back(state_of(store_path(""), "your own"));
    } catch (const Failure &failure) {  // no home folder
        states.push_back({"profiles.db", "your own", false, failure.what(), {}});
    }
    const std::string installed = installed_database();
    if (installed.empty())
        states.push_back({"lensprof/lensfun.db", "Lensfun data, from `make profiles && make install`", false, {}, {}});
    else
        states.push_back(state_of(installed, "Lensfun data, installed"));
    return states;
}

std::string describe(const DatabaseState &state) {
    if (!state.exists && state.fault.empty()) return "not found";
    if (!state.fault.empty()) return "cannot be read: " + state.fault;
    const lensprof_store_stats &stats = state.stats;
    return counted(stats.profiles, "profile") + ", " + counted(stats.lenses, "lens", "lenses") + ", "
           + counted(stats.cameras, "camera");
}

void print(const std::vector<DatabaseState> &databases, std::ostream &out) {
    out << "lensprof  " << lensprof_version() << ", " << counted(std::thread::hardware_concurrency(), "processor")
        << "\n";
    for (const Part &part : optional_parts())
        out << format("%-8s  %s: %s\n", part.library, part.is_there ? "yes" : "no", part.use);
    for (const DatabaseState &state : databases)
        out << "database  " << one_line(state.file + " (" + state.role + "): " + describe(state)) << "\n";
}

Json json_of(const std::vector<DatabaseState> &databases) {
    Json json = {
        {"schema", json_schema}, {"version", lensprof_version()}, {"processors", std::thread::hardware_concurrency()}};
    for (const Part &part : optional_parts()) json["libraries"][part.library] = part.is_there;
    json["databases"] = Json::array();
    for (const DatabaseState &state : databases)
        json["databases"].push_back({{"file", state.file},
                                     {"role", state.role},
                                     {"exists", state.exists},
                                     {"fault", state.fault},
                                     {"profiles", state.stats.profiles},
                                     {"lenses", state.stats.lenses},
                                     {"cameras", state.stats.cameras}});
    return json;
}

}  // namespace

void declare_doctor(Command &program) {
    struct Options {
        std::vector<std::string> dbs;
        bool json = false;
    };
    Command command = program.add("doctor", "print versions, optional parts and databases",
                                  "Prints what a report of a problem should include. The exit code is 6 if a database "
                                  "cannot be read.");
    auto o = std::make_shared<Options>();
    declare_listed_databases(command, o->dbs);
    declare_json(command, o->json);
    command.example("lensprof doctor");
    command.run([o](Streams &streams) {
        const std::vector<DatabaseState> databases = databases_to_check(o->dbs);
        if (o->json)
            print_json(json_of(databases), streams.out);
        else
            print(databases, streams.out);
        bool all_readable = true;
        for (const DatabaseState &state : databases) all_readable = all_readable && state.fault.empty();
        return static_cast<int>(all_readable ? ExitCode::done : ExitCode::store);
    });
}

}  // namespace lensprof
