// `lensprof profile export`: profiles as files of other programs, and as blobs for firmware.
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "cli/pictures/picture.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/foreign_options.hpp"
#include "cli/profiles/key_filter.hpp"
#include "cli/profiles/profile_blob.hpp"
#include "cli/profiles/profile_split.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/databases.hpp"
#include "cli/program/format.hpp"
#include "cli/program/library.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {
namespace {

struct Options {
    std::vector<int64_t> ids;
    KeyFilter filter;
    ForeignOptions foreign;
    std::vector<std::string> dbs;
    std::string output, blob, format;
    double crop_factor = LENSPROF_UNKNOWN;
    bool covariance = false, all = false, json = false, split = false;
};

void declare(Command &command, Options &o) {
    command.profile_ids("ID", o.ids, "profiles that `lensprof profile list` shows");
    command.file("-o,--output", o.output,
                 "file to write; its name chooses the format. DNG opcodes go into a file that is there");
    command.choice("--format", o.format, format_choices(true), "another format than the name's");
    command.file("--blob", o.blob, "the same as --format blob -o FILE: for firmware to read in place (docs/blob.md)");
    command.flag("--covariance", o.covariance, "blob: the covariance as well, which a camera has no use for");
    command.flag("--all", o.all, "all profiles of the database");
    command.flag("--split", o.split,
                 "-o is a folder, and --format gives the format: a file for each lens, or, where a file holds one "
                 "profile, for each profile");
    declare_foreign(command, o.foreign, true);
    command.number("--crop-factor", o.crop_factor, crop_factors,
                   "43.27 mm over the sensor's diagonal, for profiles that do not know it; lensfun and lcp need it");
    declare_listed_databases(command, o.dbs,
                             ": ids and --all are of the first, other profiles of the first that has any");
    declare_json(command, o.json);
    command.group("Which profiles, instead of ids");
    o.filter.add_options(command);
    command.footer(about_foreign(true));
}

void check_options(Options &o) {
    if (!o.blob.empty() && !o.output.empty())
        throw Failure(
            ExitCode::usage,
            "profile export: -o and --blob both name the file to be written; give one of them (-o FILE --format "
            "blob says the same as --blob FILE)");
    if (o.blob.empty() && o.output.empty())
        throw Failure(ExitCode::usage, "profile export: name the file to be written with -o (or --blob)");
    if (!o.blob.empty() && !o.format.empty() && o.format != "blob")
        throw Failure(ExitCode::usage, "profile export: --blob and --format contradict each other; use -o");
    if (!o.blob.empty()) o.output = o.blob, o.format = "blob";
    if (int(!o.ids.empty()) + int(!o.filter.is_empty()) + int(o.all) != 1)
        throw Failure(ExitCode::usage,
                      "profile export: give either ids that `lensprof profile list` shows, or --camera, "
                      "--lens and the like, or --all");
    if (o.split && o.format.empty())
        throw Failure(ExitCode::usage, "profile export: --split needs --format, since -o names a folder");
    if (o.split && o.covariance)
        throw Failure(ExitCode::usage, "profile export: --covariance is for one blob; leave --split out");
    if (o.split && !o.blob.empty())
        throw Failure(ExitCode::usage, "profile export: --split and --blob contradict each other; use --format blob");
    if (o.split && path_exists(o.output) && !is_folder(o.output))
        throw Failure(ExitCode::usage, o.output + ": is a file; --split needs a folder");
    for (const std::string &file : databases_of(o.dbs))
        if (is_same_file(o.output, file))
            throw Failure(ExitCode::usage, o.output + ": is the profile database; give the output another name");
}

// One profile; its blob's size and checksum tell it from others.
void export_blob(const Options &o, const StoredProfile &stored, Streams &streams) {
    const lensprof_profile &profile = *stored.profile;
    const BlobStamp stamp = write_blob(profile, o.covariance, o.output);
    if (o.json) {
        print_json(Json{{"schema", 1},
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

// What a format cannot hold and is not refused.
void warn_of_means(const ForeignRule &rule, const Options &o, const std::vector<StoredProfile> &chosen,
                   Streams &streams) {
    const bool is_mean = rule.format == LENSPROF_FORMAT_LENSFUN || rule.format == LENSPROF_FORMAT_LCP
                         || (rule.format == LENSPROF_FORMAT_MAP && format_of_name(o.output) == FileFormat::png);
    if (!is_mean) return;
    for (const StoredProfile &one : chosen)
        if (one.profile->vignettings == 3)
            streams.err << "profile " << one.id << ": has a falloff for each channel, of which " << rule.name
                        << " holds the mean\n";
}

// Formats that need a crop factor take that of the command line where the profile has none.
void complete_crop_factors(const Options &o, const ForeignRule &rule, const std::vector<StoredProfile> &chosen) {
    const bool needs_crop = rule.format == LENSPROF_FORMAT_LENSFUN || rule.format == LENSPROF_FORMAT_LCP;
    for (const StoredProfile &one : chosen) {
        double &crop = one.profile->key.crop_factor;
        if (crop == LENSPROF_UNKNOWN) crop = o.crop_factor;
        if (needs_crop && crop == LENSPROF_UNKNOWN)
            throw Failure(ExitCode::usage, o.output + ": the crop factor of profile " + std::to_string(one.id)
                                               + " is not known; give --crop-factor");
    }
}

void export_split(const Options &o, const ForeignRule &rule, const std::vector<StoredProfile> &chosen,
                  Streams &streams) {
    complete_crop_factors(o, rule, chosen);
    const std::vector<SplitFile> files = write_split(rule, o.output, o.foreign, chosen);
    warn_of_means(rule, o, chosen, streams);
    if (!o.json) {
        for (const SplitFile &file : files)
            streams.out << file.path << ": " << counted(file.profiles.size(), "profile") << "\n";
        return;
    }
    Json list = Json::array();
    for (const SplitFile &file : files) {
        Json ids = Json::array();
        for (const StoredProfile *one : file.profiles) ids.push_back(one->id);
        list.push_back({{"file", file.path}, {"profiles", ids}});
    }
    print_json(Json{{"schema", 1}, {"format", rule.name}, {"folder", o.output}, {"files", list}}, streams.out);
}

void export_foreign(const Options &o, const ForeignRule &rule, const std::vector<StoredProfile> &chosen,
                    Streams &streams) {
    std::vector<const lensprof_profile *> profiles;
    std::vector<std::string> names;
    Json ids = Json::array();
    complete_crop_factors(o, rule, chosen);
    for (const StoredProfile &one : chosen) {
        profiles.push_back(one.profile.get()), ids.push_back(one.id);
        names.push_back("profile " + std::to_string(one.id));
    }
    write_foreign(rule, o.output, o.foreign, profiles, names);
    warn_of_means(rule, o, chosen, streams);
    if (o.json)
        print_json(Json{{"schema", 1}, {"profiles", ids}, {"format", rule.name}, {"file", o.output}}, streams.out);
    else
        streams.out << format("wrote %s: %zu profile%s as %s\n", o.output.c_str(), chosen.size(),
                              chosen.size() == 1 ? "" : "s", rule.name);
}

int run(Options &o, Streams &streams) {
    check_options(o);
    const ForeignRule &rule = format_to_write(o.output, o.format);
    if (o.covariance && rule.format != LENSPROF_FORMAT_BLOB)
        throw Failure(ExitCode::usage, "profile export: --covariance belongs to --format blob");
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
        throw Failure(ExitCode::usage, o.output + ": a blob holds one profile, and " + std::to_string(chosen.size())
                                           + " were chosen; give one id");
    export_blob(o, chosen[0], streams);
    return 0;
}

}  // namespace

void declare_profile_export(Command &profile) {
    Command command = profile.add("export", "write profiles as files of other programs, or as blobs",
                                  "Writes profiles as files of other programs, complete or not at all.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
