/* `lensprof profile import`: falloffs of other programs' databases. */
#include <algorithm>
#include <set>

#include "library.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "run.hpp"

namespace lensprof {
namespace {

/* What one call imports. */
struct Import {
    lensprof_store *store = nullptr;
    std::string db, file;
    bool was_empty = true; /* nothing can be there twice */
    uint32_t stored = 0, known = 0;
    std::set<std::string> lenses;
    Json flagged = Json::array(); /* file, key, doubt, stored */
    lensprof_error error{};
};

/* Whether the newest profile of this key is the same falloff from the same place. */
bool is_there(Import &import, const lensprof_profile &profile) {
    auto found = std::make_unique<lensprof_profile>();
    const lensprof_status status = lensprof_store_find(import.store, &profile.key, found.get(), nullptr, &import.error);
    if (status == LENSPROF_ERROR_NOT_FOUND) return false;
    check(status, store_path(import.db), &import.error);
    return std::equal(profile.vignetting[0].k, profile.vignetting[0].k + 3, found->vignetting[0].k)
        && std::equal(profile.vignetting[0].center, profile.vignetting[0].center + 2, found->vignetting[0].center)
        && std::string(profile.provenance.source) == found->provenance.source;
}

lensprof_status take(void *user, const lensprof_import_entry *entry) {
    Import &import = *static_cast<Import *>(user);
    const lensprof_profile &profile = *entry->profile;
    if (*profile.provenance.doubt)
        import.flagged.push_back({{"file", import.file}, {"key", key_json(profile.key)},
                                  {"doubt", profile.provenance.doubt}, {"stored", entry->usable != 0}});
    if (!entry->usable) return LENSPROF_OK;
    if (!import.was_empty && is_there(import, profile)) {
        import.known++;
        return LENSPROF_OK;
    }
    const lensprof_status status = lensprof_store_put(import.store, &profile, nullptr, &import.error);
    if (status == LENSPROF_OK) import.stored++, import.lenses.insert(profile.key.lens);
    return status;
}

lensprof_status ignore(void *, const lensprof_import_entry *) { return LENSPROF_OK; }

void read_file(Import &import, const std::string &file, lensprof_import_visitor visit) {
    const std::string text = read_text(file, uint64_t(64) << 20);
    const size_t slash = file.rfind('/');
    const std::string name = slash == std::string::npos ? file : file.substr(slash + 1);
    import.file = file;
    import.error.text[0] = 0;
    check(lensprof_lensfun_read(text.data(), text.size(), name.c_str(), visit, &import, &import.error), file,
          &import.error);
}

void print_import(const Import &import, size_t files, Streams &streams) {
    const size_t refused = static_cast<size_t>(
        std::count_if(import.flagged.begin(), import.flagged.end(), [](const Json &one) { return !one["stored"]; }));
    streams.out << format("imported %u falloffs of %zu lenses from %zu file%s into %s\n", import.stored,
                          import.lenses.size(), files, files == 1 ? "" : "s", store_path(import.db).c_str());
    if (import.known) streams.out << format("%u were there already\n", import.known);
    if (!import.flagged.empty())
        streams.out << format("%zu are doubtful: %zu of them, which no lens has, were left out, the others stored with the "
                              "reason, and looked up only when asked for; --json lists them\n",
                              import.flagged.size(), refused);
}

}  // namespace

int run_profile_import(const std::vector<std::string> &arguments, Streams &streams) {
    std::string db;
    std::vector<std::string> files;
    bool json = false;
    CLI::App app("Stores the falloffs of other programs' databases: Lensfun (.xml). All files or none.",
                 "lensprof profile import");
    app.add_option("FILES", files, "databases to read")->required();
    app.add_option("--db", db, "profile database, made where there is none; default the user's own");
    app.add_flag("--json", json, "print one JSON object");
    if (!parse(app, arguments, streams)) return 0;
    Import import;
    for (const std::string &file : files) read_file(import, file, ignore); /* before a database is made */
    Store store = open_store(db, LENSPROF_STORE_CREATE);
    import.store = store.get();
    import.db = db;
    uint32_t before = 0;
    check(lensprof_store_list(store.get(), nullptr, nullptr, 0, &before, &import.error), store_path(db), &import.error);
    import.was_empty = before == 0;
    check(lensprof_store_begin(store.get(), &import.error), store_path(db), &import.error);
    for (const std::string &file : files) read_file(import, file, take); /* a failure closes the store, and rolls back */
    check(lensprof_store_commit(store.get(), &import.error), store_path(db), &import.error);
    if (json)
        print_json(Json{{"schema", 1}, {"stored", import.stored}, {"known", import.known},
                        {"lenses", import.lenses.size()}, {"flagged", import.flagged}},
                   streams.out);
    else print_import(import, files.size(), streams);
    return 0;
}

}  // namespace lensprof
