// `lensprof profile lenses | cameras`: lists them, one per line.
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/profiles/known_range.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/key_filter.hpp"

namespace lensprof {
namespace {

using Summaries = std::vector<lensprof_store_summary>;

struct NamesOptions {
    std::vector<std::string> part;
    std::vector<std::string> dbs;
    bool json = false;
};

// Calls visit(index of the database, row) for all rows.
template <typename Visit>
void for_each_row(const std::vector<Summaries> &all, const Visit &visit) {
    for (size_t i = 0; i < all.size(); i++)
        for (const auto &row : all[i]) visit(i, row);
}

std::string states_text(const lensprof_store_summary &row) {
    std::string text;
    for (uint32_t i = 0; i < 3; i++)
        if (row.processing[i]) text += (text.empty() ? "" : ", ") + std::string(processing_name(i));
    return text;
}

Json names_json(const Databases &databases, const std::vector<Summaries> &all, bool of_lenses) {
    Json list = Json::array();
    for_each_row(all, [&](size_t index, const lensprof_store_summary &row) {
        Json entry;
        if (of_lenses) {
            entry["lens"] = row.lens;
        } else {
            entry["camera_maker"] = row.camera_maker;
            entry["camera_model"] = row.camera_model;
        }
        entry["profiles"] = row.profiles;
        entry[of_lenses ? "cameras" : "lenses"] = row.others;
        for (uint32_t i = 0; i < 3; i++) entry[processing_name(i)] = row.processing[i];
        entry["focal_mm"] = range_json(row.focal_mm);
        entry["aperture"] = range_json(row.aperture);
        entry["distance_m"] = range_json(row.distance_m);
        if (databases.size() > 1) entry["database"] = databases.file(index);
        list.push_back(entry);
    });
    return Json{{"schema", json_schema}, {of_lenses ? "lenses" : "cameras", list}};
}

void print_names(const Databases &databases, const std::vector<Summaries> &all, bool of_lenses, std::ostream &out) {
    size_t rows = 0;
    out << format("%8s  %7s  %9s %9s %9s  %-15s  %s\n", "profiles", of_lenses ? "cameras" : "lenses", "mm", "f/",
                  "focus m", "processing", of_lenses ? "lens" : "camera");
    for_each_row(all, [&](size_t index, const lensprof_store_summary &row) {
        const std::string name = of_lenses ? std::string(row.lens) : camera_name(row.camera_maker, row.camera_model);
        out << format("%8u  %7u  %9s %9s %9s  %-15s  %s\n", row.profiles, row.others, range_text(row.focal_mm).c_str(),
                      range_text(row.aperture).c_str(), range_text(row.distance_m).c_str(), states_text(row).c_str(),
                      (name + databases.column(index)).c_str());
        rows++;
    });
    out << (of_lenses ? counted(rows, "lens", "lenses") : counted(rows, "camera"));
    out << (databases.size() > 1 ? ", listed per database\n" : "\n");
}

int run(const NamesOptions &o, bool of_lenses, Streams &streams) {
    std::string part;
    for (const std::string &word : o.part) part += (part.empty() ? "" : " ") + word;
    const Databases databases(databases_of(o.dbs));
    const uint32_t which = of_lenses ? LENSPROF_NAMES_LENSES : LENSPROF_NAMES_CAMERAS;
    std::vector<Summaries> all;
    for (size_t i = 0; i < databases.size(); i++)
        all.push_back(listed<lensprof_store_summary>(databases.file(i), [&](lensprof_store_summary *buffer,
                                                                            uint32_t capacity, uint32_t *count,
                                                                            lensprof_error *error) {
            return lensprof_store_list_names(databases.store(i), which, part.c_str(), buffer, capacity, count, error);
        }));
    if (o.json)
        print_json(names_json(databases, all, of_lenses), streams.out);
    else
        print_names(databases, all, of_lenses, streams.out);
    return 0;
}

void declare(Command &profile, const char *verb, const char *brief, bool of_lenses) {
    Command command = profile.add(verb, brief);
    auto o = std::make_shared<NamesOptions>();
    command.texts("PART", o->part,
                  "a name or words in it, such as 24-70 canon; case, blanks and punctuation are ignored; default all");
    declare_listed_databases(command, o->dbs);
    declare_json(command, o->json);
    command.example(of_lenses ? "lensprof profile lenses canon" : "lensprof profile cameras canon");
    command.run([o, of_lenses](Streams &streams) { return run(*o, of_lenses, streams); });
}

}  // namespace

void declare_profile_names(Command &profile) {
    declare(profile, "lenses", "list the lenses of the database, with the stored settings", true);
    declare(profile, "cameras", "list the cameras of the profiles in the database", false);
}

}  // namespace lensprof
