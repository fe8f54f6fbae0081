// `lensprof profile import`: profiles, responses and falloffs from the files of other programs.
#include <algorithm>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/fitting/profile_store.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/foreign_options.hpp"
#include "cli/profiles/key_filter.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/format.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {
namespace {

// The options of the command.
struct Options {
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

// Files with only a response or a falloff are combined into one profile, whose key the command line gives.
std::unique_ptr<lensprof_profile> read_parts(const Options &o, const std::vector<Input> &inputs) {
    auto profile = new_profile();
    std::string response, falloff, names;
    for (const Input &input : inputs) {
        if (input.rule->holds == LENSPROF_HOLDS_PROFILES) continue;
        std::string &source_file = input.rule->holds == LENSPROF_HOLDS_RESPONSE ? response : falloff;
        if (!source_file.empty())
            throw Failure(ExitCode::usage, input.file + ": has a "
                                               + (&source_file == &response ? "response" : "falloff") + ", and so has "
                                               + source_file + "; import the profiles one after the other");
        source_file = input.file;
        names += (names.empty() ? "" : "; ") + std::filesystem::path(input.file).filename().string();
    }
    if (names.empty()) return nullptr;
    profile->key = o.key.key(response.empty() ? LENSPROF_PROCESSING_RAW : LENSPROF_PROCESSING_JPEG);
    for (const Input &input : inputs)
        if (input.rule->holds != LENSPROF_HOLDS_PROFILES) read_part(*input.rule, input.file, o.foreign, *profile);
    if (!*profile->key.camera_model && !*profile->key.lens)
        throw Failure(ExitCode::usage, (response.empty() ? falloff : response)
                                           + ": does not name camera or lens; give --camera or --lens");
    set_text(profile->provenance.method, sizeof profile->provenance.method, "import");
    set_text(profile->provenance.software, sizeof profile->provenance.software,
             std::string("lensprof ") + lensprof_version());
    set_text(profile->provenance.source, sizeof profile->provenance.source, names);
    check(lensprof_profile_validate(profile.get()), response.empty() ? falloff : response);
    return profile;
}

// Stores a camera of a table, replacing an existing one.
lensprof_status take_camera(void *user, const lensprof_camera_model *camera) {
    Import &import = *static_cast<Import *>(user);
    import.cameras++;
    if (import.store) import.store_status = lensprof_store_put_camera(import.store, camera, &import.error);
    return import.store_status;
}

// Every profile of every file, and the cameras.
void visit_all(Import &import, const std::vector<Input> &inputs, const lensprof_profile *of_parts,
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
            stop_if_interrupted();
            check(import.store_status, store_path(import.db),
                  &import.error);  // a failure of the store, not of the file
            throw;
        }
    }
    if (!of_parts) return;
    const lensprof_import_entry entry = {of_parts, 1, 0};
    import.file = of_parts->provenance.source;
    check(visit(&import, &entry), store_path(import.db), &import.error);
}

// A failure closes the store, and rolls back.
void store_all(Import &import, const std::vector<Input> &inputs, const lensprof_profile *of_parts, Progress &progress) {
    const std::string db = store_path(import.db);
    Store store = open_store(import.db, LENSPROF_STORE_CREATE);
    import.store = store.get();
    import.cameras = 0;
    check(lensprof_store_begin(store.get(), &import.error), db, &import.error);
    visit_all(import, inputs, of_parts, import_entry, "storing", progress);
    check(lensprof_store_commit(store.get(), &import.error), db, &import.error);
}

void print_import(const Import &import, size_t files, Streams &streams) {
    const size_t refused = static_cast<size_t>(std::count_if(import.flagged.begin(), import.flagged.end(),
                                                             [](const Json &entry) { return !entry["stored"]; }));
    streams.out << "imported " << counted(import.stored, "profile") << " of "
                << counted(import.lenses.size(), "lens", "lenses") << " from " << counted(files, "file") << " into "
                << store_path(import.db) << "\n";
    if (import.cameras)
        streams.out << "with " << counted(import.cameras, "camera") << ": sensor sizes and built-in lenses\n";
    if (import.known) streams.out << format("%u %s stored already\n", import.known, import.known == 1 ? "was" : "were");
    if (!import.flagged.empty())
        streams.out << "doubtful: " << counted(import.flagged.size(), "profile")
                    << format(
                           ", of which %zu are physically impossible and were not imported; %zu are stored with the ",
                           refused, import.flagged.size() - refused)
                    << "reason and used only with --doubtful; --json lists them\n";
}

int run(const Options &o, Streams &streams) {
    o.key.check_names();
    std::vector<Input> inputs;
    std::set<std::string> seen;
    for (const std::string &file : o.files)
        if (seen.insert(canonical_path(file)).second) inputs.push_back({file, &format_to_read(file, o.format)});
    const std::unique_ptr<lensprof_profile> of_parts = read_parts(o, inputs);
    if (!of_parts && !o.key.is_empty())
        throw Failure(ExitCode::usage,
                      "profile import: these files already name camera and lens; omit --camera, --lens and similar "
                      "options");
    Import import;
    import.db = o.db;
    Progress progress(streams, o.progress);
    visit_all(import, inputs, of_parts.get(), ignore, "reading", progress);  // before a database is created
    const bool is_new = !path_exists(store_path(o.db));
    try {
        store_all(import, inputs, of_parts.get(), progress);
    } catch (const Failure &) {
        if (is_new) remove_empty_store(store_path(o.db));
        throw;
    }
    progress.clear();
    if (o.json)
        print_json(Json{{"schema", 1},
                        {"stored", import.stored},
                        {"known", import.known},
                        {"lenses", import.lenses.size()},
                        {"cameras", import.cameras},
                        {"flagged", import.flagged}},
                   streams.out);
    else
        print_import(import, inputs.size(), streams);
    return 0;
}

}  // namespace

void declare_profile_import(Command &profile) {
    Command command =
        profile.add("import", "import profiles from files of other programs",
                    "Stores the profiles of other programs' files. If one file cannot be imported, nothing is stored.\n"
                    "The format is identified from the content, else from the name.");
    auto o = std::make_shared<Options>();
    command.files("FILE", o->files,
                  "profile files; or, for one profile, a file with a response, a file with a falloff, or both");
    command.require("FILE");
    command.choice("--format", o->format, format_choices(false),
                   "format of all files; default identified from content or name");
    declare_foreign(command, o->foreign, false);
    declare_db(command, o->db, ", created if missing");
    declare_json(command, o->json);
    declare_progress(command, o->progress);
    command.group("Camera, lens and setting, for files that do not name them");
    o->key.add_options(command);
    command.footer(about_foreign(false));
    command.example("lensprof profile import pcalib.txt vignette.png --camera \"My Camera\"");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
