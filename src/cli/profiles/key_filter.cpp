#include "cli/profiles/key_filter.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

void KeyFilter::add_options(CLI::App &app) {
    app.add_option("--camera", camera_, "camera model");
    app.add_option("--maker", maker_, "camera maker");
    app.add_option("--lens", lens_, "lens");
    app.add_option("--unit", unit_, "serial numbers of the one camera and lens that a profile is of");
    app.add_option("--focal", focal_, "focal length, mm")->check(in_range(0.01, 1e5));
    app.add_option("--aperture", aperture_, "f-number")->check(in_range(0.01, 1e4));
    app.add_option("--distance", distance_, "focus distance, m")->check(in_range(1e-6, INFINITY));
    app.add_option("--processing", processing_, "raw, jpeg or corrected");
}

void KeyFilter::check_words() const {
    if (!processing_.empty()) processing_of_name(processing_);
}

bool KeyFilter::is_empty() const {
    return maker_.empty() && !has_camera_or_lens() && unit_.empty() && processing_.empty() && focal_ == LENSPROF_UNKNOWN
           && aperture_ == LENSPROF_UNKNOWN && distance_ == LENSPROF_UNKNOWN;
}

lensprof_profile_key KeyFilter::key(uint32_t processing) const {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    set_text(key.camera_maker, sizeof key.camera_maker, maker_);
    set_text(key.camera_model, sizeof key.camera_model, camera_);
    set_text(key.lens, sizeof key.lens, lens_);
    set_text(key.unit, sizeof key.unit, unit_);
    key.focal_mm = focal_;
    key.aperture = aperture_;
    key.distance_m = distance_;
    key.processing = processing_.empty() ? processing : processing_of_name(processing_);
    return key;
}

std::vector<lensprof_store_row> KeyFilter::rows(lensprof_store *store, const std::string &db) const {
    const lensprof_profile_key filter = key(LENSPROF_PROCESSING_JPEG);
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_store_list(store, &filter, nullptr, 0, &found, &error), store_path(db), &error);
    std::vector<lensprof_store_row> rows(found);
    check(lensprof_store_list(store, &filter, rows.data(), found, &found, &error), store_path(db), &error);
    rows.resize(std::min<size_t>(rows.size(), found));
    if (processing_.empty()) return rows;
    const uint32_t processing = processing_of_name(processing_);
    rows.erase(
        std::remove_if(rows.begin(), rows.end(),
                       [=](const lensprof_store_row &row) { return !row.damaged && row.key.processing != processing; }),
        rows.end());
    return rows;
}

std::vector<StoredProfile> KeyFilter::profiles(const std::string &db, std::vector<int64_t> ids) const {
    Store store = open_store(db, LENSPROF_STORE_READ);
    if (ids.empty())
        for (const auto &row : rows(store.get(), db)) ids.push_back(row.id);
    if (ids.empty()) throw Failure(ExitCode::not_found, nothing_found(db));
    std::vector<StoredProfile> profiles;
    for (int64_t id : ids) {
        auto profile = new_profile();
        lensprof_error error{};
        check(lensprof_store_get(store.get(), id, profile.get(), &error), store_path(db), &error);
        profiles.push_back({id, std::move(profile)});
    }
    return profiles;
}

std::string KeyFilter::nothing_found(const std::string &db) const {
    const std::string &name = !camera_.empty() ? camera_ : !lens_.empty() ? lens_ : maker_;
    return "no profile" + (name.empty() ? std::string() : " for " + name) + " with this setting in " + store_path(db)
           + "; `lensprof profile list` shows what there is";
}

}  // namespace lensprof
