#include "fit/methods/fit_call.hpp"

#include <algorithm>
#include <utility>

namespace lensprof {

void FitCall::make_room() {
    uint32_t last_setting = 0, last_camera = 0;
    for (const lensprof_fit_image &image : images) {
        last_setting = std::max(last_setting, image.setting);
        last_camera = std::max(last_camera, image.camera);
    }
    quality.assign(count(), {});
    settings.assign(last_setting ? last_setting + 1 : 0, {});
    cameras.assign(last_camera ? last_camera + 1 : 0, {});
    for (CameraResult &camera : cameras) lensprof_response_set_linear(&camera.response);
    point_to_room();
}

void FitCall::point_to_room() {
    result.image_quality = quality.data();
    result.settings = settings.empty() ? nullptr : settings.data();
    result.cameras = cameras.empty() ? nullptr : cameras.data();
    result.setting_count = static_cast<uint32_t>(settings.size());
    result.camera_count = static_cast<uint32_t>(cameras.size());
}

const lensprof_response &FitCall::response_of(uint32_t image) const {
    return cameras.empty() ? result.response : cameras[images[image].camera].response;
}

const lensprof_vignetting *FitCall::falloff_of(uint32_t image) const {
    const uint32_t setting = images[image].setting;
    return settings.empty() || !settings[setting].images ? result.vignetting : settings[setting].vignetting;
}

void FitCall::take(FitCall &&other) {
    images = std::move(other.images);
    result = std::move(other.result);
    quality = std::move(other.quality);
    settings = std::move(other.settings);
    cameras = std::move(other.cameras);
    point_to_room();
}

}  // namespace lensprof
