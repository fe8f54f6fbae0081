// `lensprof profile list | show | remove | export`, and the way to the verbs that have files of their own.
#include <algorithm>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/profiles/key_filter.hpp"
#include "cli/profiles/profile_blob.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/format.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/run.hpp"
#include "cli/report/chart.hpp"
#include "cli/report/falloff.hpp"
#include "cli/report/report.hpp"

namespace lensprof {
namespace {

std::string number_or(double value, const char *pattern) {
    return value == LENSPROF_UNKNOWN ? std::string("-") : format(pattern, value);
}

// One line for each row that cannot be listed, and the exit code for them.
int report_damaged(lensprof_store *store, const std::vector<lensprof_store_row> &rows, Streams &streams) {
    ExitCode code = ExitCode::done;
    auto profile = new_profile();
    for (const auto &row : rows) {
        lensprof_error error{};
        if (!row.damaged || lensprof_store_get(store, row.id, profile.get(), &error) == LENSPROF_OK) continue;
        streams.err << "lensprof: warning: " << error.text << "\n";
        code = ExitCode::store;
    }
    return static_cast<int>(code);
}

int list(const std::string &db, const KeyFilter &filter, bool json, Streams &streams) {
    Store store = open_store(db, LENSPROF_STORE_READ);
    const std::vector<lensprof_store_row> rows = filter.rows(store.get(), db);
    if (json) {
        Json profiles = Json::array();
        Json damaged = Json::array();
        for (const auto &row : rows)
            if (row.damaged)
                damaged.push_back(row.id);
            else
                profiles.push_back(
                    {{"id", row.id}, {"key", key_json(row.key)}, {"provenance", provenance_json(row.provenance)}});
        print_json(Json{{"schema", 1}, {"profiles", profiles}, {"damaged", damaged}}, streams.out);
        return report_damaged(store.get(), rows, streams);
    }
    streams.out << format("%6s  %-28s %-32s %5s %7s %6s %9s  %s\n", "id", "camera", "lens", "crop", "mm", "f/",
                          "focus m", "state");
    for (const auto &row : rows) {
        if (row.damaged) continue;
        const auto &k = row.key;
        streams.out << format("%6lld  %-28s %-32s %5s %7s %6s %9s  %s%s%s\n", static_cast<long long>(row.id),
                              k.camera_model, k.lens, number_or(k.crop_factor, "%.3g").c_str(),
                              number_or(k.focal_mm, "%g").c_str(), number_or(k.aperture, "%g").c_str(),
                              number_or(k.distance_m, "%g").c_str(), processing_name(k.processing),
                              *k.unit ? ", unit " : "", k.unit);
    }
    return report_damaged(store.get(), rows, streams);
}

// What a verb is asked for.
struct ProfileOptions {
    std::vector<int64_t> ids;
    KeyFilter filter;
    std::string db, blob, chart_out, channel;
    bool json = false, chart = false;
};

// One curve a profile where there are several, so that they can be compared.
int channel_of(const ProfileOptions &o, size_t profiles) {
    static const char *const names[] = {"red", "green", "blue"};
    if (o.channel.empty()) return profiles > 1 ? 1 : -1;
    for (int c = 0; c < 3; c++)
        if (o.channel == names[c]) return c;
    return -1;
}

void print_profiles(const std::vector<StoredProfile> &profiles, bool json, Streams &streams) {
    if (!json) {
        for (size_t i = 0; i < profiles.size(); i++) {
            if (i) streams.out << "\n";
            print_profile(profiles[i].id, *profiles[i].profile, streams.out);
        }
    } else if (profiles.size() == 1) {
        print_json(profile_json(profiles[0].id, *profiles[0].profile), streams.out);
    } else {
        Json all = Json::array();
        for (const StoredProfile &stored : profiles) all.push_back(profile_json(stored.id, *stored.profile));
        print_json(Json{{"schema", 1}, {"profiles", all}}, streams.out);
    }
}

// A chart shows no curve of what was not measured, as by `bracket`.
void keep_with_falloff(std::vector<StoredProfile> &profiles) {
    const int64_t first = profiles.front().id;
    const auto lacks = [](const StoredProfile &stored) {
        return stored.profile->vignettings == 1 && !has_falloff(stored.profile->vignetting[0]);
    };
    profiles.erase(std::remove_if(profiles.begin(), profiles.end(), lacks), profiles.end());
    if (profiles.empty())
        throw Failure(ExitCode::not_found, "profile " + std::to_string(first)
                                               + " has no falloff that a chart could show; measure it with `lensprof flat` "
                                                 "or `lensprof build`");
}

// The blob's own line, then the profile as one of a database.
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

int show(const ProfileOptions &o, Streams &streams) {
    if (int(!o.ids.empty()) + int(!o.filter.is_empty()) + int(!o.blob.empty()) != 1)
        throw Failure(ExitCode::usage,
                      "profile show: give either ids that `lensprof profile list` shows, or --camera, "
                      "--lens and the like, or --blob");
    if (!o.blob.empty() && !o.db.empty())
        throw Failure(ExitCode::usage, "profile show: --blob reads a file of its own; leave --db out");
    if (!o.chart_out.empty()) check_chart_name(o.chart_out);
    if (is_same_file(o.chart_out, o.blob.empty() ? store_path(o.db) : o.blob))
        throw Failure(ExitCode::usage, o.chart_out + ": is the " + (o.blob.empty() ? "profile database" : "blob")
                                           + "; give --chart-out another name");
    std::vector<StoredProfile> profiles;
    BlobStamp stamp{};
    if (o.blob.empty())
        profiles = o.filter.profiles(o.db, o.ids);
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

int remove(const std::string &db, int64_t id, bool json, Streams &streams) {
    Store store = open_store(db, LENSPROF_STORE_WRITE);
    lensprof_error error{};
    check(lensprof_store_remove(store.get(), id, &error), store_path(db), &error);
    if (json)
        print_json(Json{{"schema", 1}, {"removed", id}}, streams.out);
    else
        streams.out << "removed profile " << id << "\n";
    return 0;
}

// Options that a verb would not look at are mistakes.
void check_verb(const std::string &verb, const ProfileOptions &o) {
    if (verb != "show" && (o.chart || !o.chart_out.empty() || !o.channel.empty()))
        throw Failure(ExitCode::usage, "profile " + verb + ": --chart, --chart-out and --channel belong to show");
    if (verb == "show" && !o.channel.empty() && !o.chart && o.chart_out.empty())
        throw Failure(ExitCode::usage, "profile show: --channel belongs to --chart and --chart-out; add one of them");
    if (verb == "remove" && !o.filter.is_empty())
        throw Failure(ExitCode::usage, "profile remove: --camera, --lens and the like belong to list and show");
    if (verb == "list" && !o.ids.empty())
        throw Failure(ExitCode::usage, "profile list: lists profiles without ids; `profile show` takes ids");
    if (verb == "remove" && o.ids.size() != 1)
        throw Failure(ExitCode::usage, "profile remove: give the id, one, that `lensprof profile list` shows");
    if (verb != "show" && !o.blob.empty())
        throw Failure(ExitCode::usage, "profile " + verb + ": --blob belongs to show and export");
}

}  // namespace

int run_profile(const std::vector<std::string> &arguments, Streams &streams) {
    static const Command others[] = {{"import", "", run_profile_import},
                                     {"export", "", run_profile_export},
                                     {"merge", "", run_profile_merge},
                                     {"check", "", run_profile_check},
                                     {"stats", "", run_profile_stats}};
    for (const Command &other : others)
        if (!arguments.empty() && arguments[0] == other.name)
            return other.run({arguments.begin() + 1, arguments.end()}, streams);
    std::string verb;
    ProfileOptions o;
    CLI::App app(
        "Lists, shows or removes profiles of the database. `lensprof profile import`, `export`, `merge`, `check` "
        "and `stats` have options of their own.",
        "lensprof profile");
    app.add_option("VERB", verb, "list, show or remove")->required()->check(CLI::IsMember({"list", "show", "remove"}));
    app.add_option("ID", o.ids, "profiles to show, or the one to remove")->check(is_profile_id);
    declare_db(app, o.db);
    app.add_flag("--json", o.json, "print one JSON object");
    app.add_flag("--chart", o.chart, "show: relative illuminance, M over r, as a chart and a table instead");
    app.add_option("--chart-out", o.chart_out, "show: draw that chart into this .svg or .png");
    app.add_option("--channel", o.channel,
                   "in charts, of profiles with a falloff a channel: red, green, blue or all; default all for one "
                   "profile, green for several")
        ->check(CLI::IsMember({"red", "green", "blue", "all"}));
    app.add_option("--blob", o.blob, "show: a blob (docs/blob.md) to read instead of the database");
    app.option_defaults()->group("What to list or show, instead of ids");
    o.filter.add_options(app);
    if (!parse(app, arguments, streams)) return 0;
    check_verb(verb, o);
    o.filter.check_words();
    if (verb == "list") return list(o.db, o.filter, o.json, streams);
    return verb == "show" ? show(o, streams) : remove(o.db, o.ids[0], o.json, streams);
}

}  // namespace lensprof
