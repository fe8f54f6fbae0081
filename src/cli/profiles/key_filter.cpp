#include "cli/profiles/key_filter.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "cli/fitting/profile_store.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

void KeyFilter::add_options(Command &command) {
    command.text("--camera", camera_, "camera model");
    command.text("--maker", maker_, "camera maker");
    command.text("--lens", lens_, "lens");
    command.text("--unit", unit_, "serial numbers of the one camera and lens that a profile is of");
    command.number("--focal", focal_, focal_lengths, "focal length, mm, as 50 or 50mm");
    command.number("--aperture", aperture_, f_numbers, "f-number, as 4 or f/4");
    command.number("--distance", distance_, distances, "focus distance, m, as 3 or 3m");
    command.choice("--processing", processing_, processing_choices(), "raw, jpeg or corrected");
}

bool KeyFilter::is_empty() const {
    return maker_.empty() && !has_camera_or_lens() && unit_.empty() && !processing_ && focal_ == LENSPROF_UNKNOWN
           && aperture_ == LENSPROF_UNKNOWN && distance_ == LENSPROF_UNKNOWN;
}

void KeyFilter::check_names() const { demand_room(maker_, camera_, lens_, unit_); }

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
    key.processing = processing_.value_or(processing);
    return key;
}

std::vector<lensprof_store_row> KeyFilter::rows(lensprof_store *store, const std::string &db) const {
    const lensprof_profile_key filter = key(LENSPROF_PROCESSING_JPEG);
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_store_list(store, &filter, nullptr, 0, &found, &error), store_path(db), &error);
    std::vector<lensprof_store_row> rows;
    lensprof_status status = LENSPROF_OK;
    do {  // again where others add profiles meanwhile
        rows.resize(found);
        status = lensprof_store_list(store, &filter, rows.data(), found, &found, &error);
    } while (status == LENSPROF_ERROR_CAPACITY);
    check(status, store_path(db), &error);
    rows.resize(std::min<size_t>(rows.size(), found));
    if (!processing_) return rows;
    const uint32_t processing = *processing_;
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
