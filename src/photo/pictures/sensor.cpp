#include "photo/pictures/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

// The number at `position`, and its end.
double take_number(const std::string &text, size_t &position) {
    double value = 0;
    for (; position < text.size() && text[position] >= '0' && text[position] <= '9'; position++)
        value = value * 10 + (text[position] - '0');
    return value;
}

// The ratio of the "16:9" in a text.
std::optional<double> aspect_in(const std::string &text) {
    const size_t colon = text.find(':');
    if (colon == std::string::npos) return {};
    size_t first = colon, next = colon + 1;
    while (first > 0 && text[first - 1] >= '0' && text[first - 1] <= '9') first--;
    const double width = take_number(text, first), height = take_number(text, next);
    return width > 0 && height > 0 ? std::optional<double>(width / height) : std::nullopt;
}

// Aspect of the pictures that the entry applies to; empty: all.
std::optional<double> aspect_of(const lensprof_camera_model &camera) {
    for (const char *text : {camera.variant, camera.model, camera.other_model})
        if (const auto aspect = aspect_in(text)) return aspect;
    return {};
}

// "Canon PowerShot G5 X 4:3" is another format of the "Canon PowerShot G5 X".
bool is_format_of(const lensprof_camera_model &camera, const lensprof_camera_model &other) {
    const std::string model = camera.model, base_model = other.model;
    if (std::string(camera.maker) != other.maker || model.compare(0, base_model.size(), base_model) != 0) return false;
    return model.size() == base_model.size()
           || (model[base_model.size()] == ' ' && aspect_in(model.substr(base_model.size())));
}

std::vector<lensprof_camera_model> all_cameras(lensprof_store *store, const std::string &file) {
    lensprof_error error{};
    uint32_t count = 0;
    check(lensprof_store_list_camera_models(store, nullptr, 0, &count, &error), file, &error);
    std::vector<lensprof_camera_model> cameras(count);
    if (count > 0) check(lensprof_store_list_camera_models(store, cameras.data(), count, &count, &error), file, &error);
    return cameras;
}

// The value that all formats with the picture's aspect agree on.
double crop_factor_of_format(const std::vector<lensprof_camera_model> &cameras, const lensprof_camera_model &camera,
                             double aspect) {
    constexpr double same_aspect = 0.02, same_crop = 0.005;
    double crop = LENSPROF_UNKNOWN;
    for (const auto &other : cameras) {
        if (!is_format_of(other, camera)) continue;
        const auto format_aspect = aspect_of(other);
        if (!format_aspect) return LENSPROF_UNKNOWN;  // distinguished by something else
        if (!(std::fabs(*format_aspect / aspect - 1) < same_aspect)) continue;
        if (crop != LENSPROF_UNKNOWN && std::fabs(crop / other.crop_factor - 1) > same_crop) return LENSPROF_UNKNOWN;
        crop = other.crop_factor;
    }
    return crop;
}

}  // namespace

double crop_factor_in_table(lensprof_store *store, const lensprof_profile_key &key, PictureSize picture) {
    lensprof_camera_model camera;
    lensprof_camera_model_init(&camera);
    lensprof_error error{};
    const std::string file = "database";
    const auto status = lensprof_store_find_camera(store, key.camera_maker, key.camera_model, &camera, &error);
    if (status == LENSPROF_ERROR_NOT_FOUND) return LENSPROF_UNKNOWN;
    check(status, file, &error);
    if (camera.crop_factor != LENSPROF_UNKNOWN && !aspect_of(camera)) return picture.of_part(camera.crop_factor);
    if (picture.width == 0 || picture.height == 0 || picture.shown_diagonal != 1.0) return LENSPROF_UNKNOWN;
    const double longer = std::max(picture.width, picture.height), shorter = std::min(picture.width, picture.height);
    return crop_factor_of_format(all_cameras(store, file), camera, longer / shorter);
}

double crop_factor_in_tables(const Databases &databases, const lensprof_profile_key &key, PictureSize picture) {
    double crop = LENSPROF_UNKNOWN;
    for (size_t i = 0; i < databases.size() && crop == LENSPROF_UNKNOWN; i++)
        crop = crop_factor_in_table(databases.store(i), key, picture);
    return crop;
}

double crop_factor_in_files(const std::vector<std::string> &named, const lensprof_profile_key &key,
                            PictureSize picture) {
    for (const std::string &file : existing_databases(named)) {
        try {
            const double crop = crop_factor_in_table(open_store(file, LENSPROF_STORE_READ).get(), key, picture);
            if (crop != LENSPROF_UNKNOWN) return crop;
        } catch (const Failure &) {
        }
    }
    return LENSPROF_UNKNOWN;
}

}  // namespace lensprof
