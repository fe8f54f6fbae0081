#include "photo/calibration/key_filter.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "photo/base/events.hpp"
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

bool KeyFilter::is_empty() const {
    return maker.empty() && !has_camera_or_lens() && unit.empty() && style.empty() && !processing
           && focal == LENSPROF_UNKNOWN && aperture == LENSPROF_UNKNOWN && distance == LENSPROF_UNKNOWN;
}

lensprof_profile_key KeyFilter::key(uint32_t otherwise) const {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    set_text(key.camera_maker, sizeof key.camera_maker, maker);
    set_text(key.camera_model, sizeof key.camera_model, camera);
    set_text(key.lens, sizeof key.lens, lens);
    set_text(key.unit, sizeof key.unit, unit);
    set_text(key.style, sizeof key.style, style);
    key.focal_mm = focal;
    key.aperture = aperture;
    key.distance_m = distance;
    key.processing = processing.value_or(otherwise);
    return key;
}

KeyFilter KeyFilter::without_setting() const {
    KeyFilter any = *this;
    any.focal = any.aperture = any.distance = LENSPROF_UNKNOWN;
    any.processing.reset();
    return any;
}

void KeyFilter::put_into(lensprof_profile_key &key) const {
    if (!maker.empty()) set_text(key.camera_maker, sizeof key.camera_maker, maker);
    if (!camera.empty()) set_text(key.camera_model, sizeof key.camera_model, camera);
    if (!lens.empty()) set_text(key.lens, sizeof key.lens, lens);
    if (!unit.empty()) set_text(key.unit, sizeof key.unit, unit);
    if (!style.empty()) set_text(key.style, sizeof key.style, style);
    if (focal != LENSPROF_UNKNOWN) key.focal_mm = focal;
    if (aperture != LENSPROF_UNKNOWN) key.aperture = aperture;
    if (distance != LENSPROF_UNKNOWN) key.distance_m = distance;
    if (processing) key.processing = *processing;
}

std::vector<lensprof_store_row> KeyFilter::rows_of(lensprof_store *store, const std::string &db,
                                                   const lensprof_profile_key &filter) const {
    auto rows = listed<lensprof_store_row>(
        db, [&](lensprof_store_row *buffer, uint32_t capacity, uint32_t *count, lensprof_error *error) {
            return lensprof_store_list(store, &filter, buffer, capacity, count, error);
        });
    const auto is_other = [&](const lensprof_store_row &row) {
        return processing && !row.damaged && row.key.processing != *processing;
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
    const auto cameras = named(store, db, camera, LENSPROF_NAMES_CAMERAS);
    const auto lenses = named(store, db, lens, LENSPROF_NAMES_LENSES);
    for (const lensprof_store_summary &of_camera : cameras)
        for (const lensprof_store_summary &of_lens : lenses) {
            if (maker.empty()) std::copy_n(of_camera.camera_maker, sizeof filter.camera_maker, filter.camera_maker);
            std::copy_n(of_camera.camera_model, sizeof filter.camera_model, filter.camera_model);
            std::copy_n(of_lens.lens, sizeof filter.lens, filter.lens);
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
    const std::string &name = !camera.empty() ? camera : !lens.empty() ? lens : maker;
    return "no profile" + (name.empty() ? std::string() : " for " + name) + " with this setting in " + store_path(db)
           + advice("no_profile");
}

}  // namespace lensprof
