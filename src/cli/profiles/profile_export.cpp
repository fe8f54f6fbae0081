// `lensprof profile export`: profiles as files of other programs, and as blobs for firmware.
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/foreign_options.hpp"
#include "cli/profiles/key_options.hpp"
#include "cli/profiles/profile_blob.hpp"
#include "cli/profiles/profile_split.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/key_filter.hpp"
#include "photo/calibration/lens_file.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

struct ExportOptions {
    std::vector<int64_t> ids;
    KeyFilter filter;
    ForeignOptions foreign;
    std::vector<std::string> dbs;
    std::string output, format, into;
    double crop_factor = LENSPROF_UNKNOWN;
    bool covariance = false, all = false, json = false, split = false;
};

void declare(Command &command, ExportOptions &o) {
    command.profile_ids("ID", o.ids, "ids of profiles; see `lensprof profile list`");
    command.file("-o,--output", o.output,
                 "output file; its name chooses the format; DNG opcodes are written into an existing file");
    command.choice("--format", o.format, format_choices(true), "format of the output; default chosen by the file name");
    command.flag("--all", o.all, "export all profiles of the database");
    command.expert().flag(
        "--split", o.split,
        "write one file per lens, or per profile if the format holds only one, into the folder -o; needs --format");
    command.expert().file("--into", o.into,
                          "Lensfun database to which the entries are added; -o receives the whole, the file stays");
    declare_foreign(command, o.foreign, true)
        .flag("covariance", o.covariance, "write the covariance into a blob too, which cameras do not need");
    declare_listed_databases(command, o.dbs, "; ids and --all refer to the first, filters to the first with a match");
    declare_json(command, o.json);
    command.group("Filters, instead of ids");
    declare_key_filter(command, o.filter)
        .number("crop-factor", o.crop_factor, crop_factors,
                "43.27 mm divided by the sensor diagonal, for profiles without one; needed by lensfun and lcp");
    command.footer(about_foreign(true));
}

void check_options(const ExportOptions &o) {
    if (o.output.empty()) throw Failure(LENSPROF_ERROR_ARGUMENT, "profile export: no output file; give it with -o");
    if (int(!o.ids.empty()) + int(!o.filter.is_empty()) + int(o.all) != 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile export: give ids (see `lensprof profile list`), or --camera, --lens or other filters, "
                      "or --all");
    if (o.split && o.format.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile export: --split needs --format, because -o is a folder; add --format");
    if (o.split && o.covariance)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile export: --encoding covariance=yes needs a single blob; omit --split");
    if (o.split && path_exists(o.output) && !is_folder(o.output))
        throw Failure(LENSPROF_ERROR_ARGUMENT, o.output + ": is a file; --split needs a folder");
    for (const std::string &file : databases_of(o.dbs))
        if (is_same_file(o.output, file))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          o.output + ": is the profile database; give the output another name");
}

// One profile; size and checksum of its blob identify it.
void export_blob(const ExportOptions &o, const StoredProfile &stored, Streams &streams) {
    const lensprof_profile &profile = *stored.profile;
    const BlobStamp stamp = write_blob(profile, o.covariance, o.output);
    if (o.json) {
        print_json(Json{{"schema", json_schema},
                        {"profile", stored.id},
                        {"blob", {{"file", o.output}, {"bytes", stamp.bytes}, {"crc32", stamp.crc32}}},
                        {"covariance_size", o.covariance ? profile.covariance_size : 0}},
                   streams.out);
        return;
    }
    streams.out << format("wrote %s: profile %lld, %zu bytes, CRC-32 %s\n", o.output.c_str(),
                          static_cast<long long>(stored.id), stamp.bytes, stamp.crc32.c_str());
    if (o.covariance && !profile.covariance_size) streams.out << "no covariance stored; exported without it\n";
}

bool is_of_response(uint32_t format) {
    return format == LENSPROF_FORMAT_PCALIB || format == LENSPROF_FORMAT_CURVES || format == LENSPROF_FORMAT_CUBE
           || format == LENSPROF_FORMAT_RADICAL_RESPONSE;
}

// JSON holds all, and so does the blob in a header of C; readers of a DNG subtract the levels that it states before
// they apply its opcodes.
void note_omissions(const ForeignRule &rule, const std::vector<StoredProfile> &chosen, Streams &streams) {
    if (rule.format == LENSPROF_FORMAT_JSON || rule.format == LENSPROF_FORMAT_C) return;
    for (const StoredProfile &stored : chosen) {
        const std::string name = "profile " + std::to_string(stored.id);
        const std::string levels = note_of_levels(*stored.profile, name),
                          circle = note_of_circle(*stored.profile, name);
        if (!levels.empty() && rule.format != LENSPROF_FORMAT_DNG_OPCODES) note(streams, levels);
        if (!circle.empty() && !is_of_response(rule.format)) note(streams, circle);
    }
}

// Reports what a format omits without being refused.
void note_losses(const ForeignRule &rule, const ExportOptions &o, const std::vector<StoredProfile> &chosen,
                 Streams &streams) {
    note_omissions(rule, chosen, streams);
    const bool is_mean = rule.format == LENSPROF_FORMAT_LENSFUN || rule.format == LENSPROF_FORMAT_LCP
                         || (rule.format == LENSPROF_FORMAT_MAP && format_of_name(o.output) == FileFormat::png);
    if (!is_mean) return;
    for (const StoredProfile &stored : chosen)
        if (stored.profile->vignettings == 3)
            note(streams, "profile " + std::to_string(stored.id) + ": its falloff differs per channel; " + rule.name
                              + " stores the mean");
}

// Formats that need a crop factor use that of the command line if the profile does not have one.
void complete_crop_factors(const ExportOptions &o, const ForeignRule &rule, const std::vector<StoredProfile> &chosen) {
    const bool needs_crop = rule.format == LENSPROF_FORMAT_LENSFUN || rule.format == LENSPROF_FORMAT_LCP;
    for (const StoredProfile &stored : chosen) {
        double &crop = stored.profile->key.crop_factor;
        if (crop == LENSPROF_UNKNOWN) crop = o.crop_factor;
        if (needs_crop && crop == LENSPROF_UNKNOWN)
            throw Failure(LENSPROF_ERROR_ARGUMENT, o.output + ": the crop factor of profile "
                                                       + std::to_string(stored.id)
                                                       + " is unknown; give --key crop-factor=NUMBER");
    }
}

void export_split(const ExportOptions &o, const ForeignRule &rule, const std::vector<StoredProfile> &chosen,
                  Streams &streams) {
    complete_crop_factors(o, rule, chosen);
    const std::vector<SplitFile> files = write_split(rule, o.output, o.foreign, chosen);
    note_losses(rule, o, chosen, streams);
    if (!o.json) {
        for (const SplitFile &file : files)
            streams.out << file.path << ": " << counted(file.profiles.size(), "profile") << "\n";
        return;
    }
    Json list = Json::array();
    for (const SplitFile &file : files) {
        Json ids = Json::array();
        for (const StoredProfile *stored : file.profiles) ids.push_back(stored->id);
        list.push_back({{"file", file.path}, {"profiles", ids}});
    }
    print_json(Json{{"schema", json_schema}, {"format", rule.name}, {"folder", o.output}, {"files", list}},
               streams.out);
}

void export_foreign(const ExportOptions &o, const ForeignRule &rule, const std::vector<StoredProfile> &chosen,
                    Streams &streams) {
    std::vector<const lensprof_profile *> profiles;
    std::vector<std::string> names;
    Json ids = Json::array();
    complete_crop_factors(o, rule, chosen);
    for (const StoredProfile &stored : chosen) {
        profiles.push_back(stored.profile.get()), ids.push_back(stored.id);
        names.push_back("profile " + std::to_string(stored.id));
    }
    Json result{{"schema", json_schema}, {"profiles", ids}, {"format", rule.name}, {"file", o.output}};
    if (rule.format == LENSPROF_FORMAT_LENSFUN) {
        LensFileCost cost;
        const std::string text = lens_file_text(profiles, o.dbs, o.into, cost, names);
        write_file(o.output, text.data(), text.size());
        for (const std::string &about : notes_of(cost, names)) note(streams, about);
        result["cost_ev"] = cost.ev;
    } else {
        write_foreign(rule, o.output, o.foreign, profiles, names);
    }
    note_losses(rule, o, chosen, streams);
    if (o.json)
        print_json(result, streams.out);
    else
        streams.out << format("wrote %s: %zu profile%s as %s\n", o.output.c_str(), chosen.size(),
                              chosen.size() == 1 ? "" : "s", rule.name);
}

int run(ExportOptions &o, Streams &streams) {
    check_options(o);
    const ForeignRule &rule = format_to_write(o.output, o.format);
    if (!o.into.empty() && (rule.format != LENSPROF_FORMAT_LENSFUN || o.split))
        throw Failure(LENSPROF_ERROR_ARGUMENT, "profile export: --into needs a single file of --format lensfun");
    if (o.covariance && rule.format != LENSPROF_FORMAT_BLOB)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile export: --encoding covariance=yes needs --format blob; add it, or omit the covariance");
    std::vector<std::string> files = databases_of(o.dbs);
    if (o.all) files.resize(1);
    const std::vector<StoredProfile> chosen = o.filter.profiles(Databases(files), o.ids, true);
    if (!chosen[0].database.empty()) note(streams, "profiles of " + chosen[0].database);
    if (o.split) {
        export_split(o, rule, chosen, streams);
        return 0;
    }
    if (rule.format != LENSPROF_FORMAT_BLOB) {
        export_foreign(o, rule, chosen, streams);
        return 0;
    }
    if (chosen.size() != 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT, o.output + ": a blob holds one profile, and "
                                                   + std::to_string(chosen.size()) + " were chosen; give one id");
    export_blob(o, chosen[0], streams);
    return 0;
}

}  // namespace

void declare_profile_export(Command &profile) {
    Command command = profile.add("export", "export profiles as files of other programs, or as blobs",
                                  "Writes profiles as files of other programs. If a profile cannot be exported, no "
                                  "file is written.");
    auto o = std::make_shared<ExportOptions>();
    declare(command, *o);
    command.example("lensprof profile export 1 -o vignette.png --encoding frame=1280x1024");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
