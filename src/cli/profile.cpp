/* `lensprof profile list | show | remove`. */
#include "library.hpp"
#include "report.hpp"
#include "run.hpp"

namespace lensprof {
namespace {

std::string number_or(double value, const char *pattern) {
    return value == LENSPROF_UNKNOWN ? std::string("-") : format(pattern, value);
}

int list(const std::string &db, bool json, Streams &streams) {
    Store store = open_store(db, LENSPROF_STORE_READ);
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_store_list(store.get(), nullptr, nullptr, 0, &found, &error), store_path(db), &error);
    std::vector<lensprof_store_row> rows(found);
    check(lensprof_store_list(store.get(), nullptr, rows.data(), found, &found, &error), store_path(db), &error);
    rows.resize(std::min<size_t>(rows.size(), found));
    if (json) {
        Json profiles = Json::array();
        for (const auto &row : rows)
            profiles.push_back(
                {{"id", row.id}, {"key", key_json(row.key)}, {"provenance", provenance_json(row.provenance)}});
        print_json(Json{{"schema", 1}, {"profiles", profiles}}, streams.out);
        return 0;
    }
    streams.out << format("%6s  %-28s %-32s %7s %6s %9s  %s\n", "id", "camera", "lens", "mm", "f/", "focus m", "state");
    for (const auto &row : rows) {
        const auto &k = row.key;
        streams.out << format("%6lld  %-28s %-32s %7s %6s %9s  %s\n", static_cast<long long>(row.id), k.camera_model,
                              k.lens, number_or(k.focal_mm, "%g").c_str(), number_or(k.aperture, "%g").c_str(),
                              number_or(k.distance_m, "%g").c_str(), processing_name(k.processing));
    }
    return 0;
}

int show(const std::string &db, int64_t id, bool json, Streams &streams) {
    Store store = open_store(db, LENSPROF_STORE_READ);
    auto profile = std::make_unique<lensprof_profile>();
    lensprof_error error{};
    check(lensprof_store_get(store.get(), id, profile.get(), &error), store_path(db), &error);
    if (json) print_json(profile_json(id, *profile), streams.out);
    else print_profile(id, *profile, streams.out);
    return 0;
}

int remove(const std::string &db, int64_t id, bool json, Streams &streams) {
    Store store = open_store(db, LENSPROF_STORE_WRITE);
    lensprof_error error{};
    check(lensprof_store_remove(store.get(), id, &error), store_path(db), &error);
    if (json) print_json(Json{{"schema", 1}, {"removed", id}}, streams.out);
    else streams.out << "removed profile " << id << "\n";
    return 0;
}

}  // namespace

int run_profile(const std::vector<std::string> &arguments, Streams &streams) {
    std::string db, verb;
    int64_t id = 0;
    bool json = false;
    CLI::App app("Lists, shows or removes profiles of the database.", "lensprof profile");
    app.add_option("VERB", verb, "list, show or remove")->required()->check(CLI::IsMember({"list", "show", "remove"}));
    app.add_option("ID", id, "the profile, for show and remove")->check(CLI::PositiveNumber);
    app.add_option("--db", db, "profile database; default the user's own");
    app.add_flag("--json", json, "print one JSON object");
    if (!parse(app, arguments, streams)) return 0;
    if (verb == "list") return list(db, json, streams);
    if (id == 0) throw Failure(ExitCode::usage, "profile " + verb + ": give the id that `lensprof profile list` shows");
    return verb == "show" ? show(db, id, json, streams) : remove(db, id, json, streams);
}

}  // namespace lensprof
