// `lensprof profile lenses | cameras`: what there is, a line for each.
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/profiles/key_filter.hpp"
#include "cli/profiles/known_range.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/format.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {
namespace {

using Summaries = std::vector<lensprof_store_summary>;

struct Options {
    std::vector<std::string> part;
    std::string db;
    bool json = false;
};

std::string states_text(const lensprof_store_summary &row) {
    std::string text;
    for (uint32_t i = 0; i < 3; i++)
        if (row.processing[i]) text += (text.empty() ? "" : ", ") + std::string(processing_name(i));
    return text;
}

Json names_json(const Summaries &rows, bool of_lenses) {
    Json list = Json::array();
    for (const auto &row : rows) {
        Json one;
        if (of_lenses) {
            one["lens"] = row.lens;
        } else {
            one["camera_maker"] = row.camera_maker;
            one["camera_model"] = row.camera_model;
        }
        one["profiles"] = row.profiles;
        one[of_lenses ? "cameras" : "lenses"] = row.others;
        for (uint32_t i = 0; i < 3; i++) one[processing_name(i)] = row.processing[i];
        one["focal_mm"] = range_json(row.focal_mm);
        one["aperture"] = range_json(row.aperture);
        one["distance_m"] = range_json(row.distance_m);
        list.push_back(one);
    }
    return Json{{"schema", 1}, {of_lenses ? "lenses" : "cameras", list}};
}

void print_names(const Summaries &rows, bool of_lenses, std::ostream &out) {
    out << format("%8s  %7s  %9s %9s %9s  %-15s  %s\n", "profiles", of_lenses ? "cameras" : "lenses", "mm", "f/",
                  "focus m", "processing", of_lenses ? "lens" : "camera");
    for (const auto &row : rows) {
        const std::string name = of_lenses ? std::string(row.lens) : camera_name(row.camera_maker, row.camera_model);
        out << format("%8u  %7u  %9s %9s %9s  %-15s  %s\n", row.profiles, row.others, range_text(row.focal_mm).c_str(),
                      range_text(row.aperture).c_str(), range_text(row.distance_m).c_str(), states_text(row).c_str(),
                      name.c_str());
    }
    out << (of_lenses ? counted(rows.size(), "lens", "lenses") : counted(rows.size(), "camera")) << "\n";
}

int run(const Options &o, bool of_lenses, Streams &streams) {
    std::string part;
    for (const std::string &word : o.part) part += (part.empty() ? "" : " ") + word;
    const Store store = open_store(o.db, LENSPROF_STORE_READ);
    const auto list = of_lenses ? lensprof_store_list_lenses : lensprof_store_list_cameras;
    const Summaries rows = listed<lensprof_store_summary>(
        o.db, [&](lensprof_store_summary *buffer, uint32_t capacity, uint32_t *count, lensprof_error *error) {
            return list(store.get(), part.c_str(), buffer, capacity, count, error);
        });
    if (o.json)
        print_json(names_json(rows, of_lenses), streams.out);
    else
        print_names(rows, of_lenses, streams.out);
    return 0;
}

void declare(Command &profile, const char *verb, const char *brief, bool of_lenses) {
    Command command = profile.add(verb, brief);
    auto o = std::make_shared<Options>();
    command.texts("PART", o->part,
                  "a name, or words that are in it, as 24-70 canon; case, blanks and signs do not matter; default all");
    declare_db(command, o->db);
    declare_json(command, o->json);
    command.run([o, of_lenses](Streams &streams) { return run(*o, of_lenses, streams); });
}

}  // namespace

void declare_profile_names(Command &profile) {
    declare(profile, "lenses", "the lenses of the database, with the settings that are known", true);
    declare(profile, "cameras", "the cameras of the profiles in the database", false);
}

}  // namespace lensprof
