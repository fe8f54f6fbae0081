/* `lensprof query`: the profile of a camera, lens and setting. */
#include "key_filter.hpp"
#include "library.hpp"
#include "report.hpp"
#include "run.hpp"

namespace lensprof {

int run_query(const std::vector<std::string> &arguments, Streams &streams) {
    std::string db;
    KeyFilter filter;
    bool json = false;
    CLI::App app("Prints the newest profile that matches; what is not given may be anything.", "lensprof query");
    filter.add_options(app);
    app.add_option("--db", db, "profile database; default the user's own");
    app.add_flag("--json", json, "print one JSON object");
    if (!parse(app, arguments, streams)) return 0;
    filter.check_words();
    if (!filter.has_camera_or_lens()) throw Failure(ExitCode::usage, "give at least --camera or --lens");

    Store store = open_store(db, LENSPROF_STORE_READ);
    const auto rows = filter.rows(store.get(), db);
    if (rows.empty()) throw Failure(ExitCode::not_found, filter.nothing_found(db));
    int64_t newest = 0;
    for (const auto &row : rows) newest = std::max(newest, row.id);
    lensprof_error error{};
    auto profile = std::make_unique<lensprof_profile>();
    check(lensprof_store_get(store.get(), newest, profile.get(), &error), store_path(db), &error);
    if (json) {
        Json object = profile_json(newest, *profile);
        object["matches"] = rows.size();
        print_json(object, streams.out);
    } else {
        print_profile(newest, *profile, streams.out);
        if (rows.size() > 1)
            streams.out << rows.size() << " profiles match; this is the newest. Give more of the setting to choose.\n";
    }
    return 0;
}

}  // namespace lensprof
