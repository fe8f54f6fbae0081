#include "cli/profiles/key_filter.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "cli/fitting/store_options.hpp"
#include "cli/program/key_texts.hpp"
#include "cli/program/options.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/library.hpp"

namespace lensprof {
namespace {

// The lenses or cameras that match a name or a part of one; without a name, one that matches any profile.
std::vector<lensprof_store_summary> named(lensprof_store *store, const std::string &db, const std::string &name,
                                          lensprof_store_names which) {
    if (name.empty()) return std::vector<lensprof_store_summary>(1);
    return listed<lensprof_store_summary>(
        db, [&](lensprof_store_summary *buffer, uint32_t capacity, uint32_t *count, lensprof_error *error) {
            return lensprof_store_list_names(store, which, name.c_str(), buffer, capacity, count, error);
        });
}

}  // namespace

Keys KeyFilter::add_options(Command &command) {
    command.text("--camera", camera_, "camera model");
    command.text("--lens", lens_, "lens model");
    command.number("--focal", focal_, focal_lengths, "focal length, mm, such as 50 or 50mm");
    command.number("--aperture", aperture_, f_numbers, "f-number, such as 4 or f/4");
    Keys keys = command.expert().keys("--key", "more about camera, lens and setting");
    keys.text("maker", maker_, "camera maker");
    keys.text("unit", unit_, "serial numbers of camera and lens, for profiles of a single unit");
    keys.number("distance", distance_, distances, "focus distance, m, such as 3 or 3m");
    keys.choice("processing", processing_, processing_choices(),
                "processing of the pictures: raw, jpeg or corrected (falloff corrected in camera)");
    keys.text("style", style_, "picture style, by the camera's name for it");
    return keys;
}

bool KeyFilter::is_empty() const {
    return maker_.empty() && !has_camera_or_lens() && unit_.empty() && style_.empty() && !processing_
           && focal_ == LENSPROF_UNKNOWN && aperture_ == LENSPROF_UNKNOWN && distance_ == LENSPROF_UNKNOWN;
}

void KeyFilter::check_names() const { require_text_sizes(maker_, camera_, lens_, unit_, style_); }

lensprof_profile_key KeyFilter::key(uint32_t processing) const {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    set_text(key.camera_maker, sizeof key.camera_maker, maker_);
    set_text(key.camera_model, sizeof key.camera_model, camera_);
    set_text(key.lens, sizeof key.lens, lens_);
    set_text(key.unit, sizeof key.unit, unit_);
    set_text(key.style, sizeof key.style, style_);
    key.focal_mm = focal_;
    key.aperture = aperture_;
    key.distance_m = distance_;
    key.processing = processing_.value_or(processing);
    return key;
}

KeyFilter KeyFilter::without_setting() const {
    KeyFilter any = *this;
    any.focal_ = any.aperture_ = any.distance_ = LENSPROF_UNKNOWN;
    any.processing_.reset();
    return any;
}

void KeyFilter::put_into(lensprof_profile_key &key) const {
    if (!maker_.empty()) set_text(key.camera_maker, sizeof key.camera_maker, maker_);
    if (!camera_.empty()) set_text(key.camera_model, sizeof key.camera_model, camera_);
    if (!lens_.empty()) set_text(key.lens, sizeof key.lens, lens_);
    if (!unit_.empty()) set_text(key.unit, sizeof key.unit, unit_);
    if (!style_.empty()) set_text(key.style, sizeof key.style, style_);
    if (focal_ != LENSPROF_UNKNOWN) key.focal_mm = focal_;
    if (aperture_ != LENSPROF_UNKNOWN) key.aperture = aperture_;
    if (distance_ != LENSPROF_UNKNOWN) key.distance_m = distance_;
    if (processing_) key.processing = *processing_;
}

std::vector<lensprof_store_row> KeyFilter::rows_of(lensprof_store *store, const std::string &db,
                                                   const lensprof_profile_key &filter) const {
    auto rows = listed<lensprof_store_row>(
        db, [&](lensprof_store_row *buffer, uint32_t capacity, uint32_t *count, lensprof_error *error) {
            return lensprof_store_list(store, &filter, buffer, capacity, count, error);
        });
    const auto is_other = [&](const lensprof_store_row &row) {
        return processing_ && !row.damaged && row.key.processing != *processing_;
    };
    rows.erase(std::remove_if(rows.begin(), rows.end(), is_other), rows.end());
    return rows;
}

std::vector<lensprof_store_row> KeyFilter::rows(lensprof_store *store, const std::string &db) const {
    return rows_of(store, db, key(LENSPROF_PROCESSING_JPEG));
}

std::vector<lensprof_store_row> KeyFilter::matching_rows(lensprof_store *store, const std::string &db) const {
    std::vector<lensprof_store_row> all;
    std::set<int64_t> seen;
    lensprof_profile_key filter = key(LENSPROF_PROCESSING_JPEG);
    const auto cameras = named(store, db, camera_, LENSPROF_NAMES_CAMERAS);
    const auto lenses = named(store, db, lens_, LENSPROF_NAMES_LENSES);
    for (const lensprof_store_summary &camera : cameras)
        for (const lensprof_store_summary &lens : lenses) {
            if (maker_.empty()) std::copy_n(camera.camera_maker, sizeof filter.camera_maker, filter.camera_maker);
            std::copy_n(camera.camera_model, sizeof filter.camera_model, filter.camera_model);
            std::copy_n(lens.lens, sizeof filter.lens, filter.lens);
            const auto rows = rows_of(store, db, filter);
            for (const auto &row : rows)  // a name without maker matches any maker
                if (seen.insert(row.id).second) all.push_back(row);
        }
    return all;
}

std::vector<StoredProfile> KeyFilter::profiles(const Databases &databases, const std::vector<int64_t> &ids,
                                               bool of_first) const {
    std::vector<StoredProfile> profiles;
    for (size_t i = 0; i < databases.size(); i++) {
        const std::string &file = databases.file(i);
        std::vector<int64_t> selected = ids;
        if (ids.empty())
            for (const auto &row : matching_rows(databases.store(i), file)) selected.push_back(row.id);
        for (int64_t id : selected) {
            auto profile = new_profile();
            lensprof_error error{};
            check(lensprof_store_get(databases.store(i), id, profile.get(), &error), file, &error);
            profiles.push_back({id, std::move(profile), databases.size() > 1 ? file : std::string()});
        }
        if (!ids.empty() || (of_first && !profiles.empty())) break;
    }
    if (profiles.empty()) throw Failure(LENSPROF_ERROR_NOT_FOUND, nothing_found(databases.names()));
    return profiles;
}

std::string KeyFilter::nothing_found(const std::string &db) const {
    const std::string &name = !camera_.empty() ? camera_ : !lens_.empty() ? lens_ : maker_;
    return "no profile" + (name.empty() ? std::string() : " for " + name) + " with this setting in " + store_path(db)
           + "; see `lensprof profile list`";
}

}  // namespace lensprof
