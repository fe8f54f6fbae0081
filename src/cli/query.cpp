/* `lensprof query`: the profile of a camera, lens and setting. */
#include <cmath>

#include "library.hpp"
#include "report.hpp"
#include "run.hpp"

namespace lensprof {

int run_query(const std::vector<std::string> &arguments, Streams &streams) {
    std::string db, maker, camera, lens, processing;
    double focal = LENSPROF_UNKNOWN, aperture = LENSPROF_UNKNOWN, distance = LENSPROF_UNKNOWN;
    bool json = false;
    CLI::App app("Prints the newest profile that matches; what is not given may be anything.", "lensprof query");
    app.add_option("--camera", camera, "camera model");
    app.add_option("--maker", maker, "camera maker");
    app.add_option("--lens", lens, "lens");
    app.add_option("--focal", focal, "focal length, mm")->check(in_range(0.01, 1e5));
    app.add_option("--aperture", aperture, "f-number")->check(in_range(0.01, 1e4));
    app.add_option("--distance", distance, "focus distance, m")->check(in_range(1e-6, INFINITY));
    app.add_option("--processing", processing, "raw, jpeg or corrected");
    app.add_option("--db", db, "profile database; default the user's own");
    app.add_flag("--json", json, "print one JSON object");
    if (!parse(app, arguments, streams)) return 0;
    if (!processing.empty()) processing_of_name(processing);  /* a word that is none is an error whatever is stored */
    if (camera.empty() && lens.empty()) throw Failure(ExitCode::usage, "give at least --camera or --lens");

    lensprof_profile_key filter;
    lensprof_profile_key_init(&filter);
    set_text(filter.camera_maker, sizeof filter.camera_maker, maker);
    set_text(filter.camera_model, sizeof filter.camera_model, camera);
    set_text(filter.lens, sizeof filter.lens, lens);
    filter.focal_mm = focal;
    filter.aperture = aperture;
    filter.distance_m = distance;

    Store store = open_store(db, LENSPROF_STORE_READ);
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_store_list(store.get(), &filter, nullptr, 0, &found, &error), store_path(db), &error);
    std::vector<lensprof_store_row> rows(found);
    check(lensprof_store_list(store.get(), &filter, rows.data(), found, &found, &error), store_path(db), &error);
    rows.resize(std::min<size_t>(rows.size(), found));

    const lensprof_store_row *newest = nullptr;
    size_t matches = 0;
    for (const auto &row : rows) {
        if (!processing.empty() && row.key.processing != processing_of_name(processing)) continue;
        matches++;
        if (!newest || row.id > newest->id) newest = &row;
    }
    if (!newest)
        throw Failure(ExitCode::not_found, "no profile for " + (camera.empty() ? lens : camera) + " with this setting"
                                               + " in " + store_path(db)
                                               + "; `lensprof profile list` shows what there is");
    auto profile = std::make_unique<lensprof_profile>();
    check(lensprof_store_get(store.get(), newest->id, profile.get(), &error), store_path(db), &error);
    if (json) {
        Json object = profile_json(newest->id, *profile);
        object["matches"] = matches;
        print_json(object, streams.out);
    } else {
        print_profile(newest->id, *profile, streams.out);
        if (matches > 1)
            streams.out << matches << " profiles match; this is the newest. Give more of the setting to choose.\n";
    }
    return 0;
}

}  // namespace lensprof
