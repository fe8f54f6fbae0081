#include "photo/calibration/profile_store.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/sensor.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

void warn_of_truncation(const PictureMetadata &metadata, const StoreOptions &o, const std::string &file,
                        Events &events) {
    const std::pair<const char *, bool> used[] = {{"maker", o.maker.empty()},
                                                  {"camera", o.camera.empty()},
                                                  {"lens", o.lens.empty()},
                                                  {"unit", o.unit == "exif"},
                                                  {"style", o.style.empty()}};
    for (const std::string &part : metadata.cut)
        for (const auto &entry : used)
            if (part == entry.first && entry.second && !o.no_store) {
                const std::string option = option_name(part);
                events.warn(file, "the EXIF text for " + option
                                      + " is too long and was truncated; give a shorter one with " + option);
            }
}

lensprof_profile_key override_key(lensprof_profile_key key, PictureSize size, const StoreOptions &o,
                                  const std::string &file) {
    if (!o.maker.empty()) set_text(key.camera_maker, sizeof key.camera_maker, o.maker);
    if (!o.camera.empty()) set_text(key.camera_model, sizeof key.camera_model, o.camera);
    if (!o.lens.empty()) set_text(key.lens, sizeof key.lens, o.lens);
    if (o.unit == "exif" && !*key.unit)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      file + ": its EXIF has no serial numbers; give them with " + option_name("unit_text"));
    if (o.unit != "exif") set_text(key.unit, sizeof key.unit, o.unit);  // any unit of the model, unless given
    const bool is_given = o.crop_factor != LENSPROF_UNKNOWN;
    const double crop = is_given ? o.crop_factor : crop_factor_in_files(o.dbs, key, size);
    if (crop != LENSPROF_UNKNOWN) key.crop_factor = crop;
    if (o.focal != LENSPROF_UNKNOWN) key.focal_mm = o.focal;
    if (o.aperture != LENSPROF_UNKNOWN) key.aperture = o.aperture;
    if (o.distance != LENSPROF_UNKNOWN) key.distance_m = o.distance;
    if (o.temperature != LENSPROF_UNKNOWN) key.color_temperature_k = o.temperature;
    if (o.processing) key.processing = *o.processing;
    if (!o.style.empty()) set_text(key.style, sizeof key.style, o.style);
    if (!*key.camera_model && !*key.lens && !o.no_store)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": EXIF does not name camera and lens; give "
                                                   + option_name("camera") + " and " + option_name("lens") + ", or "
                                                   + option_name("no_store"));
    return key;
}

lensprof_profile_key camera_key(const StoreOptions &o, PictureMetadata metadata, const std::string &file,
                                Events &events) {
    metadata.cut.erase(std::remove(metadata.cut.begin(), metadata.cut.end(), "lens"), metadata.cut.end());
    warn_of_truncation(metadata, o, file, events);
    lensprof_profile_key key = metadata.key, unknown;
    lensprof_profile_key_init(&unknown);
    set_text(key.lens, sizeof key.lens, "");
    key.focal_mm = unknown.focal_mm;
    key.aperture = unknown.aperture;
    key.distance_m = unknown.distance_m;
    if (!*key.camera_model && o.camera.empty() && o.lens.empty() && !o.no_store)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": EXIF does not name the camera; give " + option_name("camera")
                                                   + ", or " + option_name("no_store"));
    return override_key(key, metadata.size, o, file);
}

std::vector<lensprof_response> given_response(const StoreOptions &o, std::optional<double> gamma, int64_t profile) {
    std::vector<lensprof_response> response(1);
    lensprof_response_set_linear(response.data());
    if (gamma) check(lensprof_response_set_gamma(response.data(), *gamma), option_name("gamma"));
    if (!profile) return response;
    Store store = open_store(o.db, LENSPROF_STORE_READ);
    auto stored = new_profile();
    lensprof_error error{};
    check(lensprof_store_get(store.get(), profile, stored.get(), &error), store_path(o.db), &error);
    return {stored->response, stored->response + stored->responses};
}

void check_store(const StoreOptions &o) {
    if (o.no_store) return;
    const std::string file = store_path(o.db);
    const bool is_empty = is_regular_file(file) && file_bytes(file) == 0;
    if (path_exists(file) && !is_empty) {
        open_store(o.db, LENSPROF_STORE_WRITE);
        return;
    }
    require_folder(o.db);
    check_folder(std::filesystem::path(absolute_path(file)).parent_path().string(), file, LENSPROF_ERROR_STORE,
                 LENSPROF_ERROR_STORE);
}

void remove_empty_store(const std::string &file) {
    lensprof_store *store = nullptr;
    uint32_t profiles = 0;
    std::error_code ignored;
    if (lensprof_store_open(file.c_str(), LENSPROF_STORE_WRITE, &store, nullptr) != LENSPROF_OK) {
        if (is_regular_file(file) && file_bytes(file) == 0) std::filesystem::remove(file, ignored);
        return;  // else another process's
    }
    Store closing(store);  // keeps others from writing while it is counted and removed
    if (lensprof_store_begin(store, nullptr) != LENSPROF_OK) return;
    if (lensprof_store_list(store, nullptr, nullptr, 0, &profiles, nullptr) != LENSPROF_OK || profiles) return;
    for (const char *end : {"", "-wal", "-shm"}) std::filesystem::remove(file + end, ignored);
}

std::string source_of(const std::string &file) { return canonical_path(file); }

int64_t store_profile(const StoreOptions &o, lensprof_profile &profile, const Origin &origin) {
    auto &p = profile.provenance;
    set_text(p.method, sizeof p.method, origin.method);
    p.prior_id = origin.prior_id;
    p.forced = !origin.usable;
    set_text(p.source, sizeof p.source, source_of(origin.source));
    p.created_unix_s = static_cast<int64_t>(std::time(nullptr));
    bool is_new = !path_exists(store_path(o.db));
    try {
        Store store = open_store(o.db, LENSPROF_STORE_CREATE);
        int64_t id = 0;
        lensprof_error error{};
        check(lensprof_store_put(store.get(), &profile, &id, &error), store_path(o.db), &error);
        return id;
    } catch (const Failure &) {
        if (is_new) remove_empty_store(store_path(o.db));
        throw;
    }
}

}  // namespace lensprof
