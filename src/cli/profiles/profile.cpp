// `lensprof profile list | show`, and the verbs with their own files.
#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

#include "cli/profiles/key_options.hpp"
#include "cli/profiles/profile_blob.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/chart.hpp"
#include "cli/report/drawing.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/key_filter.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

std::string number_or(double value, const char *pattern) {
    return value == LENSPROF_UNKNOWN ? std::string("-") : format(pattern, value);
}

// Prints one line per row that cannot be listed, and returns the exit code for them.
int report_damaged(lensprof_store *store, const std::vector<lensprof_store_row> &rows, Streams &streams) {
    ExitCode code = ExitCode::done;
    auto profile = new_profile();
    for (const auto &row : rows) {
        lensprof_error error{};
        if (!row.damaged || lensprof_store_get(store, row.id, profile.get(), &error) == LENSPROF_OK) continue;
        warn(streams, error.text);
        code = ExitCode::store;
    }
    return static_cast<int>(code);
}

struct ListOptions {
    std::vector<std::string> dbs;
    KeyFilter filter;
    bool json = false;
};

using Rows = std::vector<lensprof_store_row>;

void list_json(const Databases &databases, const std::vector<Rows> &all, std::ostream &out) {
    Json profiles = Json::array();
    Json damaged = Json::array();
    for (size_t i = 0; i < all.size(); i++)
        for (const auto &row : all[i])
            if (row.damaged) {
                damaged.push_back(row.id);
            } else {
                profiles.push_back(
                    {{"id", row.id}, {"key", key_json(row.key)}, {"provenance", provenance_json(row.provenance)}});
                if (databases.size() > 1) profiles.back()["database"] = databases.file(i);
            }
    print_json(Json{{"schema", json_schema}, {"profiles", profiles}, {"damaged", damaged}}, out);
}

void list_text(const Databases &databases, const std::vector<Rows> &all, std::ostream &out) {
    out << format("%6s  %-28s %-32s %5s %7s %6s %9s  %s\n", "id", "camera", "lens", "crop", "mm", "f/", "focus m",
                  "state");
    bool is_empty = true;
    for (size_t i = 0; i < all.size(); i++)
        for (const auto &row : all[i]) {
            is_empty = false;
            if (row.damaged) continue;
            const auto &k = row.key;
            out << format("%6lld  %-28s %-32s %5s %7s %6s %9s  %s%s%s", static_cast<long long>(row.id), k.camera_model,
                          k.lens, number_or(k.crop_factor, "%.3g").c_str(), number_or(k.focal_mm, "%g").c_str(),
                          number_or(k.aperture, "%g").c_str(), number_or(k.distance_m, "%g").c_str(),
                          processing_name(k.processing), *k.unit ? ", unit " : "", k.unit)
                << databases.column(i) << "\n";
        }
    if (is_empty) out << "0 profiles\n";
}

int list(const ListOptions &o, Streams &streams) {
    const Databases databases(databases_of(o.dbs));
    std::vector<Rows> all;
    for (size_t i = 0; i < databases.size(); i++)
        all.push_back(o.filter.matching_rows(databases.store(i), databases.file(i)));
    o.json ? list_json(databases, all, streams.out) : list_text(databases, all, streams.out);
    int code = static_cast<int>(ExitCode::done);
    for (size_t i = 0; i < all.size(); i++) code = std::max(code, report_damaged(databases.store(i), all[i], streams));
    return code;
}

// The options of `show`.
struct ShowOptions {
    std::vector<int64_t> ids;
    KeyFilter filter;
    std::vector<std::string> dbs;
    std::string blob, chart_out;
    std::optional<int> channel;  // of charts; -1: all
    bool json = false, chart = false;
};

// One curve per profile if there are several, for comparison.
int channel_of(const ShowOptions &o, size_t profiles) { return o.channel.value_or(profiles > 1 ? 1 : -1); }

Json stored_json(const StoredProfile &stored) {
    Json object = profile_json(stored.id, *stored.profile);
    if (!stored.database.empty()) object["database"] = stored.database;
    return object;
}

void print_profiles(const std::vector<StoredProfile> &profiles, bool json, Streams &streams) {
    if (!json) {
        for (size_t i = 0; i < profiles.size(); i++) {
            if (i) streams.out << "\n";
            print_profile(profiles[i].id, *profiles[i].profile, streams.out);
            if (!profiles[i].database.empty()) streams.out << "database  " << profiles[i].database << "\n";
        }
    } else if (profiles.size() == 1) {
        print_json(stored_json(profiles[0]), streams.out);
    } else {
        Json all = Json::array();
        for (const StoredProfile &stored : profiles) all.push_back(stored_json(stored));
        print_json(Json{{"schema", json_schema}, {"profiles", all}}, streams.out);
    }
}

// A chart omits what was not measured, as by `bracket`.
void keep_with_falloff(std::vector<StoredProfile> &profiles) {
    const int64_t first = profiles.front().id;
    const auto has_no_falloff = [](const StoredProfile &stored) {
        return stored.profile->vignettings == 1 && !has_falloff(stored.profile->vignetting[0]);
    };
    profiles.erase(std::remove_if(profiles.begin(), profiles.end(), has_no_falloff), profiles.end());
    if (profiles.empty())
        throw Failure(LENSPROF_ERROR_NOT_FOUND, "profile " + std::to_string(first)
                                               + " has no falloff to draw; measure it with `lensprof flat` or "
                                                 "`lensprof build`");
}

// The blob's own line, then the profile like one of a database.
void print_blob(const std::string &path, const BlobStamp &stamp, const lensprof_profile &profile, bool json,
                Streams &streams) {
    if (!json) {
        streams.out << format("blob      %s: %zu bytes, CRC-32 %s\n", path.c_str(), stamp.bytes, stamp.crc32.c_str());
        print_profile(0, profile, streams.out);
        return;
    }
    Json object = profile_json(0, profile);
    object["blob"] = Json{{"file", path}, {"bytes", stamp.bytes}, {"crc32", stamp.crc32}};
    print_json(object, streams.out);
}

int show(const ShowOptions &o, Streams &streams) {
    if (int(!o.ids.empty()) + int(!o.filter.is_empty()) + int(!o.blob.empty()) != 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile show: give ids (see `lensprof profile list`), or --camera, --lens or other filters, or "
                      "--blob");
    if (o.channel && !o.chart && o.chart_out.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "profile show: --channel needs --chart or --chart-out; add one of them");
    if (!o.blob.empty() && !o.dbs.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "profile show: --blob does not read a database; omit --db");
    if (!o.chart_out.empty()) check_chart_name(o.chart_out);
    const std::vector<std::string> read = o.blob.empty() ? databases_of(o.dbs) : std::vector<std::string>{o.blob};
    for (const std::string &file : read)
        if (is_same_file(o.chart_out, file))
            throw Failure(LENSPROF_ERROR_ARGUMENT, o.chart_out + ": is the "
                                                       + (o.blob.empty() ? "profile database" : "blob")
                                                       + "; give --chart-out another name");
    std::vector<StoredProfile> profiles;
    BlobStamp stamp{};
    if (o.blob.empty())
        profiles = o.filter.profiles(Databases(read), o.ids, false);
    else
        profiles.push_back({0, read_blob(o.blob, stamp)});
    if (!o.chart && o.chart_out.empty()) {
        if (o.blob.empty())
            print_profiles(profiles, o.json, streams);
        else
            print_blob(o.blob, stamp, *profiles[0].profile, o.json, streams);
        return 0;
    }
    keep_with_falloff(profiles);
    const Chart chart = make_chart(profiles, channel_of(o, profiles.size()));
    if (!o.chart_out.empty()) draw_chart(chart, o.chart_out);
    if (o.json)
        print_json(chart_json(chart), streams.out);
    else if (o.chart)
        print_chart(chart, streams.out);
    else
        streams.out << "wrote " << o.chart_out << "\n";
    return 0;
}

void declare_list(Command &profile) {
    Command command = profile.add("list", "list the profiles of the database, one per line");
    auto o = std::make_shared<ListOptions>();
    declare_listed_databases(command, o->dbs);
    declare_json(command, o->json);
    command.group("Filters");
    declare_key_filter(command, o->filter);
    command.example("lensprof profile list --db lenses.db");
    command.run([o](Streams &streams) { return list(*o, streams); });
}

void declare_show(Command &profile) {
    Command command = profile.add("show", "show all data of profiles, or of a blob");
    auto o = std::make_shared<ShowOptions>();
    command.profile_ids("ID", o->ids, "ids of profiles to show; see `lensprof profile list`");
    declare_listed_databases(command, o->dbs, "; ids refer to the first");
    declare_json(command, o->json);
    command.flag("--chart", o->chart, "print the relative illuminance M over r as a chart and a table instead");
    Command expert = command.expert();
    expert.file("--chart-out", o->chart_out, "write this chart as .svg or .png");
    expert.choice("--channel", o->channel, {{"red", 0}, {"green", 1}, {"blue", 2}, {"all", -1}},
                  "channel of charts, for profiles with a falloff per channel: red, green, blue or all; default all "
                  "for one profile, green for several");
    expert.file("--blob", o->blob, "read this blob (docs/blob.md) instead of the database");
    command.group("Filters, instead of ids");
    declare_key_filter(command, o->filter);
    command.example("lensprof profile show 3 --chart");
    command.run([o](Streams &streams) { return show(*o, streams); });
}

}  // namespace

void declare_profile(Command &program) {
    Command profile = program.add("profile", "list, change, remove, import, export, merge, check or count profiles");
    declare_list(profile);
    declare_show(profile);
    declare_profile_names(profile);
    declare_profile_edit(profile);
    declare_profile_export(profile);
    declare_profile_import(profile);
    declare_profile_merge(profile);
    declare_profile_check(profile);
    declare_profile_stats(profile);
    profile.footer(
        "Run `lensprof help profile VERB` for the options of a verb.\nExample: lensprof profile list --lens \"EF 50mm\"");  // last: verbs would inherit it
}

}  // namespace lensprof
