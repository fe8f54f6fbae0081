// `lensprof profile set | remove`: changes keys of profiles or removes profiles. All of them or none.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/profiles/key_options.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/key_filter.hpp"

namespace lensprof {
namespace {

// Calls change(store, id, &error) for every id, in one transaction.
template <typename Change>
void change_all(const std::string &db, lensprof_store *store, const std::vector<int64_t> &ids, const Change &change) {
    lensprof_error error{};
    const std::string file = store_path(db);
    check(lensprof_store_begin(store, &error), file, &error);
    for (const int64_t id : ids) check(change(store, id, &error), file, &error);  // closing the store rolls back
    check(lensprof_store_commit(store, &error), file, &error);
}

void print_changed(const std::vector<int64_t> &ids, const char *what, bool json, Streams &streams) {
    if (json)
        print_json(Json{{"schema", json_schema}, {what, ids}}, streams.out);
    else if (ids.size() == 1)
        streams.out << what << " profile " << ids[0] << "\n";
    else
        streams.out << what << " " << counted(ids.size(), "profile") << "\n";
}

void remove_duplicates(std::vector<int64_t> &ids) {
    std::set<int64_t> seen;
    ids.erase(std::remove_if(ids.begin(), ids.end(), [&](int64_t id) { return !seen.insert(id).second; }), ids.end());
}

// ---- remove ----

struct RemoveOptions {
    std::vector<int64_t> ids;
    KeyFilter filter;
    std::string db;
    bool yes = false, json = false;
};

int remove(RemoveOptions &o, Streams &streams) {
    if (o.ids.empty() == o.filter.is_empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile remove: give ids (see `lensprof profile list`), or --camera, --lens or other filters "
                      "with --yes");
    remove_duplicates(o.ids);
    const Store store = open_store(o.db, LENSPROF_STORE_WRITE);
    if (o.ids.empty()) {
        for (const auto &row : o.filter.matching_rows(store.get(), o.db)) o.ids.push_back(row.id);
        if (o.ids.empty()) throw Failure(LENSPROF_ERROR_NOT_FOUND, o.filter.nothing_found(o.db));
        if (!o.yes)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          "profile remove: would remove " + counted(o.ids.size(), "profile") + " of " + store_path(o.db)
                              + "; list them with `lensprof profile list` and the same options, then add --yes");
    }
    change_all(o.db, store.get(), o.ids, lensprof_store_remove);
    print_changed(o.ids, "removed", o.json, streams);
    return 0;
}

void declare_remove(Command &profile) {
    Command command = profile.add("remove", "remove profiles from the database");
    auto o = std::make_shared<RemoveOptions>();
    command.profile_ids("ID", o->ids, "ids of profiles; see `lensprof profile list`");
    command.flag("--yes", o->yes, "remove all matching profiles; without it the command only counts them");
    declare_db(command, o->db);
    declare_json(command, o->json);
    command.group("Filters, instead of ids");
    declare_key_filter(command, o->filter);
    command.example("lensprof profile remove 3");
    command.run([o](Streams &streams) { return remove(*o, streams); });
}

// ---- set ----

struct SetOptions {
    std::vector<int64_t> ids;
    KeyFilter key;
    double crop_factor = LENSPROF_UNKNOWN;
    std::vector<double lensprof_profile_key::*> unknown;  // null: the unit
    std::string db;
    bool json = false;
};

const Choices<double lensprof_profile_key::*> clearable = {{"crop-factor", &lensprof_profile_key::crop_factor},
                                                           {"focal", &lensprof_profile_key::focal_mm},
                                                           {"aperture", &lensprof_profile_key::aperture},
                                                           {"distance", &lensprof_profile_key::distance_m},
                                                           {"unit", nullptr}};

// Refuses what is both given and cleared.
void check_contradictions(const SetOptions &o) {
    lensprof_profile_key given = o.key.key(LENSPROF_PROCESSING_JPEG);
    given.crop_factor = o.crop_factor;
    for (double lensprof_profile_key::*number : o.unknown)
        if (number ? given.*number != LENSPROF_UNKNOWN : *given.unit != 0)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          "profile set: --clear and the option of the same name exclude each other; omit one of them");
}

int set(SetOptions &o, Streams &streams) {
    if (o.ids.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "profile set: give the ids of profiles; see `lensprof profile list`");
    if (o.key.is_empty() && o.crop_factor == LENSPROF_UNKNOWN && o.unknown.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile set: nothing to change; give for example --lens NAME or --clear "
                      "distance");
    check_names(o.key);
    check_contradictions(o);
    remove_duplicates(o.ids);
    const Store store = open_store(o.db, LENSPROF_STORE_WRITE);
    const auto profile = new_profile();
    change_all(o.db, store.get(), o.ids, [&](lensprof_store *db, int64_t id, lensprof_error *error) {
        const lensprof_status status = lensprof_store_get(db, id, profile.get(), error);
        if (status != LENSPROF_OK) return status;
        lensprof_profile_key key = profile->key;
        for (double lensprof_profile_key::*number : o.unknown) {
            if (number)
                key.*number = LENSPROF_UNKNOWN;
            else
                set_text(key.unit, sizeof key.unit, "");
        }
        if (o.crop_factor != LENSPROF_UNKNOWN) key.crop_factor = o.crop_factor;
        o.key.put_into(key);
        return lensprof_store_set_key(db, id, &key, error);
    });
    print_changed(o.ids, "changed", o.json, streams);
    return 0;
}

void declare_set(Command &profile) {
    Command command = profile.add("set", "change camera, lens or setting of stored profiles",
                                  "Changes which camera, lens and setting stored profiles are for; their data stays "
                                  "unchanged.");
    auto o = std::make_shared<SetOptions>();
    command.profile_ids("ID", o->ids, "ids of profiles; see `lensprof profile list`");
    declare_db(command, o->db);
    declare_json(command, o->json);
    command.group("New camera, lens and setting; default unchanged");
    Keys keys = declare_key_filter(command, o->key);
    keys.number("crop-factor", o->crop_factor, crop_factors, "43.27 mm divided by the sensor diagonal");
    command.list("--clear", o->unknown, clearable,
                 "set these to unknown, separated by commas: crop-factor, focal, aperture, distance; unit makes the "
                 "profile valid for all units of the model");
    command.example("lensprof profile set 3 --lens \"EF 50mm f/1.8 STM\"");
    command.run([o](Streams &streams) { return set(*o, streams); });
}

}  // namespace

void declare_profile_edit(Command &profile) {
    declare_set(profile);
    declare_remove(profile);
}

}  // namespace lensprof
