#include "fit/api/fit_call.hpp"

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

// Rejects more than one setting per camera for the method that estimates a single falloff.
lensprof_status check_settings(const FitCall &call, lensprof_error *error) {
    if (call.options.method != LENSPROF_METHOD_TRANSFER_FUNCTION) return LENSPROF_OK;
    std::map<uint32_t, uint32_t> setting_of;  // per camera
    for (uint32_t i = 0; i < call.count(); i++) {
        const lensprof_fit_image &image = call.images[i];
        if (setting_of.try_emplace(image.camera, image.setting).first->second != image.setting)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_UNSUPPORTED, error,
                           "has another lens setting; use the method transfer or radiance to fit several");
    }
    return LENSPROF_OK;
}

}  // namespace

lensprof_status take_call(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                          bool has_data, const lensprof_exposure *exposures, FitCall &call, lensprof_error *error) {
    clear(error);
    if (!options || !images || !exposures || !has_data)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: a pointer is NULL");
    if (image_count < 2) return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: at least two images are needed");
    lensprof_fit_options_init(&call.options);
    if (const char *wrong = lp_sized_take(&call.options, options, kFirstOptions))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "fit options: %s", wrong);
    lensprof_status status = check_options(call.options, image_count, error);
    if (call.options.camera_kind == LENSPROF_CAMERA_LINEAR && (call.options.free & LENSPROF_FREE_RESPONSE)) {
        lensprof_response_set_linear(&call.held);
        call.options.response = &call.held;
        call.options.free &= ~LENSPROF_FREE_RESPONSE;
    }
    if (status == LENSPROF_OK) status = take_images(images, image_count, call.images, error);
    if (status == LENSPROF_OK) status = check_settings(call, error);
    if (status == LENSPROF_OK) call.make_room();
    return status;
}

}  // namespace lensprof
