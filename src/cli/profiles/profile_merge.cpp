// `lensprof profile merge`: profiles of other databases.
#include <nlohmann/json.hpp>

#include "cli/program/commands.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/profile_store.hpp"

namespace lensprof {
namespace {

struct MergeOptions {
    std::string db;
    std::vector<std::string> files;
    bool json = false;
};

// One of the databases to merge.
struct Other {
    std::string file;
    Store store;
    uint32_t added = 0, known = 0;
};

// Opens all of them before a database is created or locked.
std::vector<Other> open_others(const std::string &db, const std::vector<std::string> &files) {
    std::vector<Other> others;
    for (const std::string &file : files) {
        if (is_same_file(file, store_path(db)))
            throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is the target database itself; give another database to merge "
                                                  "into it");
        others.push_back({file, open_store(file, LENSPROF_STORE_READ)});
    }
    return others;
}

void merge_all(const std::string &db, std::vector<Other> &others) {
    Store store = open_store(db, LENSPROF_STORE_CREATE);
    lensprof_error error{};
    check(lensprof_store_begin(store.get(), &error), store_path(db), &error);
    for (Other &other : others) {  // a failure closes the store, and rolls back
        stop_if_cancelled();
        const auto status = lensprof_store_merge(store.get(), other.store.get(), &other.added, &other.known, &error);
        check(status, error.text[0] ? "" : other.file, &error);
    }
    check(lensprof_store_commit(store.get(), &error), store_path(db), &error);
}

int run(const MergeOptions &o, Streams &streams) {
    std::vector<Other> others = open_others(o.db, o.files);
    const bool is_new = !path_exists(store_path(o.db));
    try {
        merge_all(o.db, others);
    } catch (const Failure &) {
        if (is_new) remove_empty_store(store_path(o.db));
        throw;
    }
    Json merged = Json::array();
    for (const Other &other : others) {
        merged.push_back({{"file", other.file}, {"added", other.added}, {"known", other.known}});
        if (!o.json)
            streams.out << other.file << ": " << counted(other.added, "profile") << " added to " << store_path(o.db)
                        << ", " << other.known << (other.known == 1 ? " was" : " were") << " already there\n";
    }
    if (o.json) print_json(Json{{"schema", json_schema}, {"merged", merged}}, streams.out);
    return 0;
}

}  // namespace

void declare_profile_merge(Command &profile) {
    Command command = profile.add(
        "merge", "add the profiles of other databases",
        "Adds the profiles of other lensprof databases that are not yet stored, with their provenance. If one "
        "file cannot be merged, nothing is added.");
    auto o = std::make_shared<MergeOptions>();
    command.files("FILE", o->files, "databases to read; they are not changed");
    command.require("FILE");
    declare_db(command, o->db, ", created if missing");
    declare_json(command, o->json);
    command.example("lensprof profile merge other.db --db lenses.db");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
