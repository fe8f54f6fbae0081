#include "fit/api/fit_call.hpp"

#include <algorithm>
#include <map>

#include "fit/api/fit_checks.hpp"

namespace lensprof {

lensprof_status take_images(const lensprof_fit_image *given, uint32_t count, std::vector<lensprof_fit_image> &images,
                            lensprof_error *error) {
    auto init = [](lensprof_fit_image &image, uint32_t i) { lensprof_fit_image_init(&image, i, 0, 0); };
    lensprof_status status = take_all(given, count, kFirstImage, LENSPROF_ITEM_IMAGE, init, images, error);
    if (status == LENSPROF_OK) status = check_images(images.data(), count, error);
    return status == LENSPROF_OK ? check_cameras(images, error) : status;
}

namespace {

// Rejects more than one setting per camera for methods that estimate a single falloff.
lensprof_status check_settings(const FitCall &call, lensprof_error *error) {
    const uint32_t method = call.options.method;
    if (method != LENSPROF_METHOD_TRANSFER_FUNCTION && method != LENSPROF_METHOD_DEBEVEC) return LENSPROF_OK;
    std::map<uint32_t, uint32_t> setting_of;  // per camera
    for (uint32_t i = 0; i < call.count(); i++) {
        const lensprof_fit_image &image = call.images[i];
        const uint32_t camera = method == LENSPROF_METHOD_DEBEVEC ? 0 : image.camera;
        if (setting_of.try_emplace(camera, image.setting).first->second != image.setting)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_UNSUPPORTED, error,
                           "has another lens setting; use the method transfer or radiance to fit several");
        if (method == LENSPROF_METHOD_DEBEVEC && image.camera != call.images[0].camera)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_UNSUPPORTED, error,
                           "belongs to another camera; the method debevec fits one camera at a time");
    }
    return LENSPROF_OK;
}

// Allocates results for lens settings or cameras: as many as the images name, or as the caller asks for. None if all
// numbers are 0 and the caller does not ask for any.
template <class Item, class Init>
lensprof_status take_items(Item *given, uint32_t given_count, uint32_t last, uint32_t max_count, size_t first_size,
                           Init init, std::vector<Item> &items, lensprof_error *error) {
    std::vector<Item> checked;
    const uint32_t count = given ? std::min(given_count, max_count) : 0;
    const lensprof_status status = take_all(given, count, first_size, LENSPROF_ITEM_NONE, init, checked, error);
    if (status != LENSPROF_OK || (last == 0 && !given)) return status;
    items.resize(std::max(last + 1, count));
    for (Item &item : items) init(item, 0);
    return LENSPROF_OK;
}

lensprof_status take_settings(const lensprof_fit_result &given, FitCall &call, lensprof_error *error) {
    lensprof_fit_result taken;  // without these members if the caller's version is older
    lensprof_fit_result_init(&taken);
    lp_sized_copy(&taken, &given);
    call.given_settings = taken.settings, call.given_setting_count = taken.setting_count;
    call.given_cameras = taken.cameras, call.given_camera_count = taken.camera_count;
    uint32_t last_setting = 0, last_camera = 0;
    for (uint32_t i = 0; i < call.count(); i++) {
        last_setting = std::max(last_setting, call.images[i].setting);
        last_camera = std::max(last_camera, call.images[i].camera);
        if (taken.settings && call.images[i].setting >= taken.setting_count)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "its setting is %u, but the result has room for %u", call.images[i].setting,
                           taken.setting_count);
        if (taken.cameras && call.images[i].camera >= taken.camera_count)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "its camera is %u, but the result has room for %u", call.images[i].camera,
                           taken.camera_count);
    }
    lensprof_status status = check_settings(call, error);
    if (status == LENSPROF_OK)
        status = take_items(
            taken.settings, taken.setting_count, last_setting, LENSPROF_SETTINGS_MAX, kFirstSetting,
            [](lensprof_fit_setting &setting, uint32_t) { lensprof_fit_setting_init(&setting); }, call.settings, error);
    if (status == LENSPROF_OK)
        status = take_items(
            taken.cameras, taken.camera_count, last_camera, LENSPROF_CAMERAS_MAX, kFirstCamera,
            [](lensprof_fit_camera &camera, uint32_t) { lensprof_fit_camera_init(&camera); }, call.cameras, error);
    if (!call.settings.empty()) call.result.settings = call.settings.data();
    call.result.setting_count = static_cast<uint32_t>(call.settings.size());
    if (!call.cameras.empty()) call.result.cameras = call.cameras.data();
    call.result.camera_count = static_cast<uint32_t>(call.cameras.size());
    return status;
}

template <class Item>
void give_items(Item *given, uint32_t given_count, const std::vector<Item> &items) {
    auto *bytes = reinterpret_cast<char *>(given);
    const size_t step = bytes ? lp_sized_bytes(bytes) : 0;
    for (size_t n = 0; bytes && n < std::min<size_t>(given_count, items.size()); n++)
        lp_sized_copy(bytes + n * step, &items[n]);
}

}  // namespace

void give_settings(FitCall &call) {
    give_items(call.given_settings, call.given_setting_count, call.settings);
    give_items(call.given_cameras, call.given_camera_count, call.cameras);
    call.result.settings = call.given_settings, call.result.setting_count = call.given_setting_count;
    call.result.cameras = call.given_cameras, call.result.camera_count = call.given_camera_count;
}

lensprof_status take_call(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                          bool has_data, const lensprof_exposure *exposures, const lensprof_fit_result *result,
                          FitCall &call, lensprof_error *error) {
    clear(error);
    if (!options || !images || !exposures || !result || !has_data)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: a pointer is NULL");
    if (image_count < 2) return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: at least two images are needed");
    lensprof_status status =
        check_result(*result, kFirstResult, kFirstQuality, result->image_quality, "fit result", error);
    if (status != LENSPROF_OK) return status;
    lensprof_fit_options_init(&call.options);
    if (const char *wrong = lp_sized_take(&call.options, options, kFirstOptions))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "fit options: %s", wrong);
    status = check_options(call.options, image_count, error);
    if (call.options.camera_kind == LENSPROF_CAMERA_LINEAR && (call.options.free & LENSPROF_FREE_RESPONSE)
        && call.options.method != LENSPROF_METHOD_DEBEVEC) {
        lensprof_response_set_linear(&call.linear);
        call.options.response = &call.linear;
        call.options.free &= ~LENSPROF_FREE_RESPONSE;
    }
    if (status == LENSPROF_OK) status = take_images(images, image_count, call.images, error);
    lensprof_fit_result_init(&call.result);
    if (status == LENSPROF_OK)
        call.quality.resize(image_count);  // images are left out by it, even if nobody asks for it
    call.result.image_quality = call.quality.data();
    return status == LENSPROF_OK ? take_settings(*result, call, error) : status;
}

}  // namespace lensprof
