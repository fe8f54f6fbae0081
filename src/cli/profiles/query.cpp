// `lensprof query`: the profile of a camera, lens and setting.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/profiles/key_options.hpp"
#include "cli/profiles/known_range.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/key_filter.hpp"
#include "photo/correct/lookup_report.hpp"
#include "photo/pictures/sensor.hpp"

namespace lensprof {
namespace {

struct QueryOptions {
    std::vector<std::string> dbs;
    KeyFilter filter;
    LookupOptions lookup;
    bool json = false;
};

void declare(Command &command, QueryOptions &o) {
    declare_lookup(declare_key_filter(command, o.filter), o.lookup);
    declare_databases(command, o.dbs);
    declare_json(command, o.json);
    command.footer(
        "If no profile is stored for the setting, the falloff is predicted from profiles of the same lens at\n"
        "other settings; the answer states the profiles used, their distance, and the standard error. The\n"
        "response is that of the camera, from its profiles with any lens, or the typical one of its kind. If\n"
        "several profiles match, the answer is the range of the stored settings.");
}

// Profiles of another sensor are left to a lookup, which converts them.
void keep_same_sensor(double crop_factor, std::vector<lensprof_store_row> &rows) {
    constexpr double max_relative_difference = 0.02;  // as lensprof_store_lookup
    const auto is_other = [=](const lensprof_store_row &row) {
        return row.key.crop_factor != LENSPROF_UNKNOWN
               && std::fabs(row.key.crop_factor / crop_factor - 1.0) > max_relative_difference;
    };
    rows.erase(std::remove_if(rows.begin(), rows.end(), is_other), rows.end());
}

// As in lookups.
void leave_out_doubtful(std::vector<lensprof_store_row> &rows) {
    const auto has_doubt = [](const lensprof_store_row &row) {
        return *row.provenance.doubt != 0 && std::strcmp(row.provenance.doubt, LENSPROF_DOUBT_RESPONSE) != 0;
    };
    rows.erase(std::remove_if(rows.begin(), rows.end(), has_doubt), rows.end());
}

std::vector<lensprof_store_row> applicable_rows(const QueryOptions &o, std::vector<lensprof_store_row> rows) {
    if (o.lookup.crop_factor != LENSPROF_UNKNOWN) keep_same_sensor(o.lookup.crop_factor, rows);
    if (!o.lookup.doubtful) leave_out_doubtful(rows);
    return rows;
}

// Profiles of one database.
struct Match {
    size_t database;
    std::vector<lensprof_store_row> rows;
};

std::vector<Match> matches(const QueryOptions &o, const Databases &databases, const KeyFilter &filter, bool by_parts) {
    std::vector<Match> all;
    for (size_t i = 0; i < databases.size(); i++) {
        const auto &file = databases.file(i);
        all.push_back({i, applicable_rows(o, by_parts ? filter.matching_rows(databases.store(i), file)
                                                      : filter.rows(databases.store(i), file))});
    }
    return all;
}

size_t count(const std::vector<Match> &all) {
    size_t rows = 0;
    for (const Match &match : all) rows += match.rows.size();
    return rows;
}

void read_profile(const Databases &databases, size_t index, int64_t id, lensprof_profile &profile) {
    lensprof_error error{};
    check(lensprof_store_get(databases.store(index), id, &profile, &error), databases.file(index), &error);
}

// The single matching profile.
void answer_stored(const QueryOptions &o, const Databases &databases, size_t index, int64_t id, Streams &streams) {
    auto profile = new_profile();
    read_profile(databases, index, id, *profile);
    if (o.json) {
        Json object = profile_json(id, *profile);
        object["found"] = true;
        object["matches"] = 1;
        print_json(object, streams.out);
        return;
    }
    print_profile(id, *profile, streams.out);
}

// The stored range of the lens or camera, if the setting is ambiguous.
void answer_range(const QueryOptions &o, const Databases &databases, const std::string &reason, Streams &streams) {
    KnownRange known;
    const auto all = matches(o, databases, o.filter.without_setting(), true);
    if (!count(all)) throw Failure(LENSPROF_ERROR_NOT_FOUND, o.filter.nothing_found(databases.names()) + "; " + reason);
    auto profile = new_profile();
    for (const Match &match : all)
        for (const auto &row : match.rows) {
            read_profile(databases, match.database, row.id, *profile);
            known.add(*profile);
        }
    if (o.json) {
        print_json(Json{{"schema", json_schema},
                        {"id", nullptr},
                        {"found", true},
                        {"matches", count(all)},
                        {"reason", reason},
                        {"range", known_range_json(known)}},
                   streams.out);
        return;
    }
    print_known_range(known, streams.out);
    streams.out << count(all) << " profiles match: " << reason << "\n";
}

// Why there is no answer, for JSON.
struct Refusal {
    lensprof_lookup lookup{};
    std::vector<std::string> nearest;
};

// Several profiles may be meant.
bool is_ambiguous(const lensprof_lookup &lookup) {
    const uint32_t reason = lookup.reason_code[0];
    return reason == LENSPROF_REASON_LOOKUP_FOCAL_MISSING || reason == LENSPROF_REASON_LOOKUP_APERTURE_MISSING
           || reason == LENSPROF_REASON_LOOKUP_SEVERAL_LENSES;
}

// The profile for the setting, stored or predicted. False if the key is ambiguous.
bool answer_lookup(const QueryOptions &o, const Databases &databases, size_t rows, Refusal &refusal, Streams &streams) {
    lensprof_lookup_options options = o.lookup.options();
    options.any_processing = !o.filter.processing;
    lensprof_profile_key key = o.filter.key(LENSPROF_PROCESSING_RAW);
    key.crop_factor = o.lookup.crop_factor;
    if (key.crop_factor == LENSPROF_UNKNOWN && *key.camera_model)
        key.crop_factor = crop_factor_in_tables(databases, key, {});
    auto profile = new_profile();
    lensprof_lookup &lookup = refusal.lookup;
    const lensprof_status status = databases.look_up(key, options, *profile, lookup);
    if (status == LENSPROF_ERROR_NOT_FOUND && is_ambiguous(lookup)) return false;
    if (status == LENSPROF_ERROR_NOT_FOUND) {
        refusal.nearest = nearest_names(databases, key, lookup);
        throw Failure(LENSPROF_ERROR_NOT_FOUND, o.filter.nothing_found(databases.names())
                                                    + "; the falloff cannot be predicted either: " + lookup.reason
                                                    + describe_nearest(refusal.nearest));
    }
    const Found found{lookup, databases.files()};
    if (o.json) {
        Json object = profile_json(lookup.exact ? lookup.id[0] : 0, *profile);
        object["found"] = true;
        object["matches"] = rows;
        object["lookup"] = lookup_json(found);
        print_json(object, streams.out);
        return true;
    }
    print_profile(lookup.exact ? lookup.id[0] : 0, *profile, streams.out);
    streams.out << lookup_lines(found);
    return true;
}

void answer(const QueryOptions &o, Refusal &refusal, Streams &streams) {
    const Databases databases(databases_of(o.dbs));
    const auto all = matches(o, databases, o.filter, false);
    const size_t rows = count(all);
    const auto only = std::find_if(all.begin(), all.end(), [](const Match &match) { return match.rows.size() == 1; });
    if (rows == 1)
        answer_stored(o, databases, only->database, only->rows[0].id, streams);
    else if (!answer_lookup(o, databases, rows, refusal, streams))
        answer_range(o, databases, refusal.lookup.reason, streams);
}

int run(const QueryOptions &o, Streams &streams) {
    if (!o.filter.has_camera_or_lens()) throw Failure(LENSPROF_ERROR_ARGUMENT, "give at least --camera or --lens");
    check_names(o.filter);
    Refusal refusal;
    lensprof_lookup_init(&refusal.lookup);
    try {
        answer(o, refusal, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.group() == LENSPROF_ERROR_NOT_FOUND)
            print_json(Json{{"schema", json_schema},
                            {"id", nullptr},
                            {"found", false},
                            {"reason", failure.what()},
                            {"reason_codes", reason_codes_json(refusal.lookup)},
                            {"nearest", refusal.nearest}},
                       streams.out);
        throw;
    }
    return 0;
}

}  // namespace

void declare_query(Command &program) {
    Command command = program.add(
        "query", "look up a profile by camera, lens, focal length and aperture",
        "Prints the profile for a camera, lens and setting, with its standard error: the newest stored one, or "
        "one predicted from other settings of the lens.");
    auto o = std::make_shared<QueryOptions>();
    declare(command, *o);
    command.example("lensprof query --lens \"canon 50mm f1.8 STM EF\" --focal 50 --aperture 2.5");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
