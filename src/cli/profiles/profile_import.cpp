// `lensprof profile import`: profiles, responses and falloffs from the files of other programs.
#include <algorithm>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/foreign_options.hpp"
#include "cli/profiles/key_options.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/key_filter.hpp"
#include "photo/calibration/profile_store.hpp"

namespace lensprof {
namespace {

// The options of the command.
struct ImportOptions {
    std::vector<std::string> files;
    KeyFilter key;  // for information that files do not contain
    ForeignOptions foreign;
    std::string db, format;
    bool json = false, progress = false;
};

// A file and how it is read.
struct Input {
    std::string file;
    const ForeignRule *rule;
};

// State of one import.
struct Import {
    lensprof_store *store = nullptr;
    std::string db, file;
    uint32_t stored = 0, known = 0, cameras = 0;
    std::set<std::string> lenses;
    Json flagged = Json::array();                // file, key, doubt, stored
    lensprof_status store_status = LENSPROF_OK;  // of the last call, and its text
    lensprof_error error{};
};

// Samples rounded by a file: the parameters of their kind are used.
lensprof_status restore_curve(lensprof_response &response) {
    const std::vector<double> terms(response.emor, response.emor + response.modes);
    switch (response.kind) {
    case LENSPROF_RESPONSE_GAMMA: return lensprof_response_set_gamma(&response, response.gamma);
    case LENSPROF_RESPONSE_EMOR: return lensprof_response_set_emor(&response, terms.data(), response.modes);
    case LENSPROF_RESPONSE_LINEAR: lensprof_response_set_linear(&response); return LENSPROF_OK;
    default: return LENSPROF_OK;
    }
}

// The profile as stored here: ids it contains belong to another database.
lensprof_status make_independent(lensprof_profile &profile) {
    lensprof_status status = LENSPROF_OK;
    profile.provenance.prior_id = 0;
    for (uint32_t c = 0; c < profile.responses && status == LENSPROF_OK; c++)
        status = restore_curve(profile.response[c]);
    return status;
}

lensprof_status import_entry(void *user, const lensprof_import_entry *entry) {
    Import &import = *static_cast<Import *>(user);
    const lensprof_profile &profile = *entry->profile;
    if (*profile.provenance.doubt)
        import.flagged.push_back({{"file", import.file},
                                  {"key", key_json(profile.key)},
                                  {"doubt", profile.provenance.doubt},
                                  { "stored",
                                    entry->usable != 0 }});
    if (interrupted()) return LENSPROF_ERROR_CANCELLED;
    if (!entry->usable) return LENSPROF_OK;
    auto copy = new_profile();
    int64_t same = 0;
    lensprof_status status = lensprof_profile_copy(copy.get(), &profile);
    if (status == LENSPROF_OK) status = make_independent(*copy);
    if (status == LENSPROF_OK) status = lensprof_store_find_same(import.store, copy.get(), &same, &import.error);
    if (same) import.known++;
    if (same || status != LENSPROF_OK) return import.store_status = status;
    status = lensprof_store_put(import.store, copy.get(), nullptr, &import.error);
    if (status == LENSPROF_OK) import.stored++, import.lenses.insert(profile.key.lens);
    return import.store_status = status;
}

lensprof_status ignore(void *, const lensprof_import_entry *) { return LENSPROF_OK; }

// Profiles of files that hold only a response or a falloff, and what their reading found.
struct PartProfiles {
    std::vector<std::unique_ptr<lensprof_profile>> profiles;
    Json changed = Json::array();        // file and change, levels, of responses made increasing
    Json without_table = Json::array();  // file and reason, of tuning files without a table
};

// The name of a tuning file is that of its sensor, which libcamera's programs write into EXIF as the camera.
void name_sensor(const std::string &file, lensprof_profile_key &key) {
    if (*key.camera_model || *key.lens) return;
    set_text(key.camera_maker, sizeof key.camera_maker, "Raspberry Pi");
    set_text(key.camera_model, sizeof key.camera_model, std::filesystem::path(file).stem().string());
}

// The profile of files with a response, a falloff, or both, whose key the command line gives.
std::unique_ptr<lensprof_profile> read_profile_of(const ImportOptions &o, const std::vector<Input> &inputs,
                                                  PartProfiles &parts) {
    auto profile = new_profile();
    const bool has_response = std::any_of(
        inputs.begin(), inputs.end(), [](const Input &input) { return input.rule->holds == LENSPROF_HOLDS_RESPONSE; });
    profile->key = o.key.key(has_response ? LENSPROF_PROCESSING_JPEG : LENSPROF_PROCESSING_RAW);
    for (const Input &input : inputs) {
        if (input.rule->format == LENSPROF_FORMAT_ALSC) name_sensor(input.file, profile->key);
        const double change = read_part(*input.rule, input.file, o.foreign, *profile);
        if (change > 0.0) parts.changed.push_back({{"file", input.file}, {"levels", change}});
    }
    if (!*profile->key.camera_model && !*profile->key.lens)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      inputs[0].file + ": does not name camera or lens; give --camera or --lens");
    set_text(profile->provenance.method, sizeof profile->provenance.method, "import");
    set_text(profile->provenance.software, sizeof profile->provenance.software,
             std::string("lensprof ") + lensprof_version());
    check(lensprof_profile_validate(profile.get()), inputs[0].file);
    return profile;
}

// Tuning files of several sensors become a profile each.
void read_tuning_files(const ImportOptions &o, const std::vector<Input> &inputs, PartProfiles &parts) {
    for (const Input &input : inputs) {
        try {
            parts.profiles.push_back(read_profile_of(o, {input}, parts));
        } catch (const Failure &failure) {
            if (failure.group() != LENSPROF_ERROR_NOT_FOUND) throw;
            parts.without_table.push_back({{"file", input.file}, {"reason", failure.what()}});
        }
    }
    if (parts.profiles.empty())
        throw Failure(LENSPROF_ERROR_NOT_FOUND, parts.without_table[0]["reason"].get<std::string>());
}

// Failure (usage) for two responses or two falloffs, which are of two profiles.
void check_parts(const ImportOptions &o, const std::vector<Input> &inputs) {
    std::string response, falloff;
    for (const Input &input : inputs) {
        std::string &source_file = input.rule->holds == LENSPROF_HOLDS_RESPONSE ? response : falloff;
        if (!source_file.empty())
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          input.file + ": has a " + (&source_file == &response ? "response" : "falloff")
                              + ", and so has " + source_file + "; import the profiles one after the other"
                              + (o.key.is_empty() ? "" : ", each with its own camera and lens"));
        source_file = input.file;
    }
}

PartProfiles read_parts(const ImportOptions &o, const std::vector<Input> &inputs) {
    PartProfiles parts;
    std::vector<Input> of_parts;
    std::copy_if(inputs.begin(), inputs.end(), std::back_inserter(of_parts),
                 [](const Input &input) { return input.rule->holds != LENSPROF_HOLDS_PROFILES; });
    const bool are_tuning_files = of_parts.size() > 1 && o.key.is_empty()
                                  && std::all_of(of_parts.begin(), of_parts.end(), [](const Input &input) {
                                         return input.rule->format == LENSPROF_FORMAT_ALSC;
                                     });
    if (are_tuning_files) {
        read_tuning_files(o, of_parts, parts);
    } else if (!of_parts.empty()) {
        check_parts(o, of_parts);
        parts.profiles.push_back(read_profile_of(o, of_parts, parts));
    }
    return parts;
}

// Stores a camera of a table, replacing an existing one.
lensprof_status take_camera(void *user, const lensprof_camera_model *camera) {
    Import &import = *static_cast<Import *>(user);
    import.cameras++;
    if (import.store) import.store_status = lensprof_store_put_camera(import.store, camera, &import.error);
    return import.store_status;
}

// Every profile of every file, and the cameras.
void visit_all(Import &import, const std::vector<Input> &inputs, const PartProfiles &parts,
               lensprof_import_visitor visit, const std::string &what, Progress &progress) {
    uint32_t done = 0;
    for (const Input &input : inputs) {
        progress.update_items(what, done++, static_cast<uint32_t>(inputs.size()));
        if (input.rule->holds != LENSPROF_HOLDS_PROFILES) continue;
        import.file = input.file;
        try {
            read_profiles(*input.rule, input.file, visit, &import);
            if (input.rule->format == LENSPROF_FORMAT_LENSFUN) read_cameras(input.file, take_camera, &import);
        } catch (const Failure &) {
            stop_if_cancelled();
            check(import.store_status, store_path(import.db),
                  &import.error);  // a failure of the store, not of the file
            throw;
        }
    }
    for (const auto &profile : parts.profiles) {
        const lensprof_import_entry entry = {profile.get(), 1, 0, 0.0};
        import.file = profile->provenance.source;
        check(visit(&import, &entry), store_path(import.db), &import.error);
    }
}

// A failure closes the store, and rolls back.
void store_all(Import &import, const std::vector<Input> &inputs, const PartProfiles &parts, Progress &progress) {
    const std::string db = store_path(import.db);
    Store store = open_store(import.db, LENSPROF_STORE_CREATE);
    import.store = store.get();
    import.cameras = 0;
    check(lensprof_store_begin(store.get(), &import.error), db, &import.error);
    visit_all(import, inputs, parts, import_entry, "storing", progress);
    check(lensprof_store_commit(store.get(), &import.error), db, &import.error);
}

void print_import(const Import &import, const PartProfiles &parts, size_t files, Streams &streams) {
    const size_t refused = static_cast<size_t>(std::count_if(import.flagged.begin(), import.flagged.end(),
                                                             [](const Json &entry) { return !entry["stored"]; }));
    streams.out << "imported " << counted(import.stored, "profile") << " of "
                << counted(import.lenses.size(), "lens", "lenses") << " from " << counted(files, "file") << " into "
                << store_path(import.db) << "\n";
    if (import.cameras)
        streams.out << "with " << counted(import.cameras, "camera") << ": sensor sizes and built-in lenses\n";
    if (import.known) streams.out << format("%u %s stored already\n", import.known, import.known == 1 ? "was" : "were");
    for (const Json &file : parts.changed)
        streams.out << file["file"].get<std::string>()
                    << format(
                           ": decreases in places; the nearest increasing curve is stored, which differs by at most "
                           "%.2g of 255 levels\n",
                           file["levels"].get<double>());
    if (!parts.without_table.empty())
        streams.out << "not imported: " << counted(parts.without_table.size(), "file")
                    << " without a table of lens shading\n";
    for (const Json &file : parts.without_table) streams.out << "  " << file["file"].get<std::string>() << "\n";
    if (!import.flagged.empty())
        streams.out << "doubtful: " << counted(import.flagged.size(), "profile")
                    << format(
                           ", of which %zu are physically impossible and were not imported; %zu are stored with the ",
                           refused, import.flagged.size() - refused)
                    << "reason and used only with --key doubtful=yes; --json lists them\n";
}

int run(const ImportOptions &o, Streams &streams) {
    check_names(o.key);
    std::vector<Input> inputs;
    std::set<std::string> seen;
    for (const std::string &file : o.files)
        if (seen.insert(canonical_path(file)).second) inputs.push_back({file, &format_to_read(file, o.format)});
    const PartProfiles parts = read_parts(o, inputs);
    if (parts.profiles.empty() && !o.key.is_empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "profile import: these files already name camera and lens; omit --camera, --lens and similar "
                      "options");
    Import import;
    import.db = o.db;
    Progress progress(streams, o.progress);
    visit_all(import, inputs, parts, ignore, "reading", progress);  // before a database is created
    const bool is_new = !path_exists(store_path(o.db));
    try {
        store_all(import, inputs, parts, progress);
    } catch (const Failure &) {
        if (is_new) remove_empty_store(store_path(o.db));
        throw;
    }
    progress.clear();
    if (o.json)
        print_json(Json{{"schema", json_schema},
                        {"stored", import.stored},
                        {"known", import.known},
                        {"lenses", import.lenses.size()},
                        {"cameras", import.cameras},
                        {"changed", parts.changed},
                        {"without_table", parts.without_table},
                        {"flagged", import.flagged}},
                   streams.out);
    else
        print_import(import, parts, inputs.size() - parts.without_table.size(), streams);
    return 0;
}

}  // namespace

void declare_profile_import(Command &profile) {
    Command command =
        profile.add("import", "import profiles from files of other programs",
                    "Stores the profiles of other programs' files. If one file cannot be imported, nothing is stored.\n"
                    "The format is identified from the content, else from the name.");
    auto o = std::make_shared<ImportOptions>();
    command.files("FILE", o->files,
                  "profile files; or, for one profile, a file with a response, a file with a falloff, or both; or "
                  "Raspberry Pi tuning files, for a profile per sensor, whose name is that of the file");
    command.require("FILE");
    command.choice("--format", o->format, format_choices(false),
                   "format of all files; default identified from content or name");
    declare_foreign(command, o->foreign, false);
    declare_db(command, o->db, ", created if missing");
    declare_json(command, o->json);
    declare_progress(command, o->progress);
    command.group("Camera, lens and setting, for files that do not name them");
    declare_key_filter(command, o->key);
    command.footer(about_foreign(false));
    command.example("lensprof profile import pcalib.txt vignette.png --camera \"My Camera\"");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
