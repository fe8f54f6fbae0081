// `lensprof profile check` and `lensprof profile stats`: the state of a database.
#include <nlohmann/json.hpp>

#include "cli/profiles/check_against.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/database_options.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"

namespace lensprof {
namespace {

struct Fault {
    int64_t id;
    std::string reason;
};

lensprof_status collect(void *user, const lensprof_store_fault *fault) {
    static_cast<std::vector<Fault> *>(user)->push_back({fault->id, fault->reason});
    return LENSPROF_OK;
}

struct CheckOptions {
    std::string db;
    AgainstOptions against;
    bool json = false;
};

std::string range(const double *ends, const char *front, const char *end) {
    if (ends[0] == LENSPROF_UNKNOWN) return "unknown";
    const std::string low = format("%s%g%s", front, ends[0], end);
    return ends[0] == ends[1] ? low : low + " to " + format("%s%g%s", front, ends[1], end);
}

Json ends_json(const double *ends) {
    const auto number = [](double value) {
        return value == LENSPROF_UNKNOWN ? Json() : value > 1e300 ? Json("infinity") : Json(value);
    };
    return Json::array({number(ends[0]), number(ends[1])});
}

Json groups_json(const lensprof_store_group *groups) {
    Json all = Json::array();
    for (uint32_t i = 0; i < LENSPROF_STATS_GROUPS && groups[i].profiles; i++)
        all.push_back({{"name", groups[i].name}, {"profiles", groups[i].profiles}});
    return all;
}

void print_groups(const char *title, const lensprof_store_group *groups, uint32_t different, std::ostream &out) {
    uint32_t count = 0;
    for (; count < LENSPROF_STATS_GROUPS && groups[count].profiles; count++)
        out << format("%-12s %8u  %s\n", count ? "" : title, groups[count].profiles,
                      *groups[count].name ? groups[count].name : "unknown");
    if (different > count) out << format("%-12s %8s  and %u more\n", "", "", different - count);
}

Json stats_json(const std::string &file, const lensprof_store_stats &s) {
    return {{"schema", json_schema},
            {"file", file},
            {"layout", s.layout},
            {"bytes", s.bytes},
            {"profiles", s.profiles},
            {"cameras", s.cameras},
            {"lenses", s.lenses},
            {"units", s.units},
            {"processing", {{"raw", s.processing[0]}, {"jpeg", s.processing[1]}, {"corrected", s.processing[2]}}},
            {"with_covariance", s.with_covariance},
            {"with_gain_grid", s.with_grid},
            {"with_doubt", s.with_doubt},
            {"focal_mm", ends_json(s.focal_mm)},
            {"aperture", ends_json(s.aperture)},
            {"distance_m", ends_json(s.distance_m)},
            {"methods", groups_json(s.method)},
            {"different_methods", s.methods},
            {"sources", groups_json(s.source)},
            {"different_sources", s.sources}};
}

void print_stats(const std::string &file, const lensprof_store_stats &s, std::ostream &out) {
    out << format("database     %s: layout %u, %lld bytes\n", file.c_str(), s.layout, static_cast<long long>(s.bytes));
    out << format("profiles     %u of %s, %s, %s\n", s.profiles, counted(s.cameras, "camera").c_str(),
                  counted(s.lenses, "lens", "lenses").c_str(), counted(s.units, "single unit").c_str());
    out << format("processing   %u raw, %u jpeg, %u corrected in camera\n", s.processing[0], s.processing[1],
                  s.processing[2]);
    out << format("of these     %u with covariance, %u with gain grid, %u doubtful\n", s.with_covariance, s.with_grid,
                  s.with_doubt);
    out << "focal length " << range(s.focal_mm, "", " mm") << "\naperture     " << range(s.aperture, "f/", "")
        << "\nfocus        " << range(s.distance_m, "", " m") << "\n";
    print_groups("method", s.method, s.methods, out);
    print_groups("source", s.source, s.sources, out);
}

int run_check(const CheckOptions &o, Streams &streams) {
    if (o.against.is_requested()) return run_against(o.against, o.db, o.json, streams);
    Store store = open_store(o.db, LENSPROF_STORE_READ);
    const std::string file = store_path(o.db);
    std::vector<Fault> faults;
    uint32_t profiles = 0;
    lensprof_error error{};
    check(lensprof_store_check(store.get(), collect, &faults, &profiles, nullptr, &error), file, &error);
    if (o.json) {
        Json list = Json::array();
        for (const Fault &fault : faults)
            list.push_back({{"id", fault.id ? Json(fault.id) : Json()}, {"reason", fault.reason}});
        print_json(Json{{"schema", json_schema}, {"file", file}, {"profiles", profiles}, {"faults", list}},
                   streams.out);
    } else {
        for (const Fault &fault : faults)
            streams.out << (fault.id ? "profile " + std::to_string(fault.id) : std::string("file")) << ": "
                        << fault.reason << "\n";
        streams.out << file << ": " << counted(profiles, "profile") << " read, " << counted(faults.size(), "fault")
                    << "\n";
        if (!faults.empty())
            streams.out
                << "Remove damaged profiles with `lensprof profile remove`; for other faults restore the file from a "
                   "copy, or merge it into a new one\n";
    }
    return static_cast<int>(faults.empty() ? ExitCode::done : ExitCode::store);
}

struct StatsOptions {
    std::vector<std::string> dbs;
    bool json = false;
};

// In JSON the first database is at the top level, the others in a list.
int run_stats(const StatsOptions &o, Streams &streams) {
    const Databases databases(databases_of(o.dbs));
    Json first, others = Json::array();
    for (size_t i = 0; i < databases.size(); i++) {
        const std::string &file = databases.file(i);
        auto stats = std::make_unique<lensprof_store_stats>();
        lensprof_store_stats_init(stats.get());
        lensprof_error error{};
        check(lensprof_store_get_stats(databases.store(i), stats.get(), &error), file, &error);
        if (!o.json) {
            streams.out << (i ? "\n" : "");
            print_stats(file, *stats, streams.out);
        } else if (i == 0) {
            first = stats_json(file, *stats);
        } else {
            others.push_back(stats_json(file, *stats));
        }
    }
    if (!others.empty()) first["others"] = others;
    if (o.json) print_json(first, streams.out);
    return 0;
}

}  // namespace

void declare_profile_check(Command &profile) {
    Command command = profile.add(
        "check", "check the whole database, or profiles against pictures",
        "Lists all faults. Exit code 0 if no fault is found, else 6. With --against, reports which of the profiles "
        "fits "
        "the pictures: exit code 0 if at least one is better than leaving the falloff uncorrected, else 4. Writes nothing.");
    auto o = std::make_shared<CheckOptions>();
    declare_against(command, o->against);
    declare_db(command, o->db);
    declare_json(command, o->json);
    command.example("lensprof profile check --db lenses.db");
    command.run([o](Streams &streams) { return run_check(*o, streams); });
}

void declare_profile_stats(Command &profile) {
    Command command = profile.add("stats", "print statistics of the database");
    auto o = std::make_shared<StatsOptions>();
    declare_listed_databases(command, o->dbs);
    declare_json(command, o->json);
    command.example("lensprof profile stats --db lenses.db");
    command.run([o](Streams &streams) { return run_stats(*o, streams); });
}

}  // namespace lensprof
