// `lensprof query`: the profile of a camera, lens and setting.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/profiles/key_filter.hpp"
#include "cli/profiles/lookup_options.hpp"
#include "cli/profiles/lookup_report.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {
namespace {

struct Options {
    std::string db;
    KeyFilter filter;
    LookupOptions lookup;
    bool json = false;
};

void declare(Command &command, Options &o) {
    o.filter.add_options(command);
    o.lookup.add_options(command);
    declare_db(command, o.db);
    declare_json(command, o.json);
    command.footer(
        "When no profile is stored for the setting, the falloff is predicted from those of the same lens at other\n"
        "settings; the answer says from which, how far away they are, and how sure it is.");
}

// Profiles of another sensor are those of a lookup, which converts them.
void keep_sensor(double crop_factor, std::vector<lensprof_store_row> &rows) {
    constexpr double same = 0.02;  // as lensprof_store_lookup
    const auto is_other = [=](const lensprof_store_row &row) {
        return row.key.crop_factor != LENSPROF_UNKNOWN && std::fabs(row.key.crop_factor / crop_factor - 1.0) > same;
    };
    rows.erase(std::remove_if(rows.begin(), rows.end(), is_other), rows.end());
}

// As lookups do.
void leave_out_doubtful(std::vector<lensprof_store_row> &rows) {
    const auto has_doubt = [](const lensprof_store_row &row) { return *row.provenance.doubt != 0; };
    rows.erase(std::remove_if(rows.begin(), rows.end(), has_doubt), rows.end());
}

// The newest of the profiles that match.
void answer_stored(const Options &o, lensprof_store *store, const std::vector<lensprof_store_row> &rows,
                   Streams &streams) {
    int64_t newest = 0;
    for (const auto &row : rows) newest = std::max(newest, row.id);
    lensprof_error error{};
    auto profile = new_profile();
    check(lensprof_store_get(store, newest, profile.get(), &error), store_path(o.db), &error);
    if (o.json) {
        Json object = profile_json(newest, *profile);
        object["found"] = true;
        object["matches"] = rows.size();
        print_json(object, streams.out);
        return;
    }
    print_profile(newest, *profile, streams.out);
    if (rows.size() > 1)
        streams.out << rows.size() << " profiles match; this is the newest. Give more of the setting to choose.\n";
}

// Of these the newest that matches will do.
bool is_open(const lensprof_profile_key &key) {
    return !*key.lens || key.focal_mm == LENSPROF_UNKNOWN || key.aperture == LENSPROF_UNKNOWN;
}

// The profile for the setting: stored, or between what is stored. False where the setting leaves open which of `rows`.
bool answer_lookup(const Options &o, lensprof_store *store, const std::vector<lensprof_store_row> &rows,
                   lensprof_lookup &how, Streams &streams) {
    lensprof_lookup_options options = o.lookup.options();
    options.any_processing = !o.filter.has_processing();
    lensprof_profile_key key = o.filter.key(LENSPROF_PROCESSING_RAW);
    key.crop_factor = o.lookup.crop_factor;
    lensprof_error error{};
    auto profile = new_profile();
    const lensprof_status status = lensprof_store_lookup(store, &key, &options, profile.get(), &how, &error);
    if (status == LENSPROF_ERROR_NOT_FOUND && !rows.empty() && is_open(key)) return false;
    if (status == LENSPROF_ERROR_NOT_FOUND)
        throw Failure(ExitCode::not_found, o.filter.nothing_found(o.db) + "; nor can it be predicted: " + how.reason);
    check(status, store_path(o.db), &error);
    if (o.json) {
        Json object = profile_json(how.exact ? how.id[0] : 0, *profile);
        object["found"] = true;
        object["matches"] = rows.size();
        object["lookup"] = lookup_json(how);
        print_json(object, streams.out);
        return true;
    }
    print_profile(how.exact ? how.id[0] : 0, *profile, streams.out);
    print_lookup(how, streams.out);
    return true;
}

void answer(const Options &o, lensprof_lookup &how, Streams &streams) {
    Store store = open_store(o.db, LENSPROF_STORE_READ);
    auto rows = o.filter.rows(store.get(), o.db);
    if (o.lookup.crop_factor != LENSPROF_UNKNOWN) keep_sensor(o.lookup.crop_factor, rows);
    if (!o.lookup.doubtful) leave_out_doubtful(rows);
    if (rows.size() == 1 || !answer_lookup(o, store.get(), rows, how, streams))
        answer_stored(o, store.get(), rows, streams);
}

int run(const Options &o, Streams &streams) {
    if (!o.filter.has_camera_or_lens()) throw Failure(ExitCode::usage, "give at least --camera or --lens");
    lensprof_lookup how;
    lensprof_lookup_init(&how);
    try {
        answer(o, how, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.code == ExitCode::not_found)
            print_json(Json{{"schema", 1},
                            {"id", nullptr},
                            {"found", false},
                            {"reason", failure.what()},
                            {"reason_codes", reason_codes_json(how)}},
                       streams.out);
        throw;
    }
    return 0;
}

}  // namespace

void declare_query(Command &program) {
    Command command = program.add(
        "query", "look a profile up by camera, lens, focal length and aperture",
        "Prints the profile for a camera, lens and setting: the newest that is stored, or one predicted from those of "
        "the lens's other settings, and how sure it is.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
