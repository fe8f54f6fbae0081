// The project with the result of its fit.
#include <algorithm>

#include "photo/base/library.hpp"
#include "photo/calibration/scene_fit.hpp"
#include "photo/scene/hugin_project.hpp"

namespace lensprof {
namespace {

constexpr uint32_t project_modes = 5;  // Ra..Re

// A project stores five modes and one falloff: refits with these instead of truncating a better result.
Fitted fit_for_project(FitInput input, const Fitted &best, uint32_t reference, const std::string &item,
                       Events &progress) {
    const auto can_hold = [](const auto &found) {
        return found.response.modes <= project_modes && found.vignettings == 1;
    };
    bool is_storable = can_hold(best.result);
    uint32_t modes = std::min<uint32_t>(best.result.response.modes, project_modes);
    for (const lensprof_fit_camera &camera : best.cameras)  // whose responses are tables, which are projected
        if (best.cameras.size() > 1 && camera.images)
            modes = project_modes, is_storable = is_storable && can_hold(best.settings[camera.setting]);
    if (is_storable || !(input.options.free & LENSPROF_FREE_RESPONSE)) return best;
    input.options.modes = modes;
    input.options.vignettings = 1;
    return fit(input, reference, item, progress, nullptr);
}

}  // namespace

std::string result_text(const SceneFit &state, const Scene &scene, const std::string &path) {
    Pto project = hugin_project(scene, path);
    const Fitted stored = fit_for_project(state.input, state.best, state.report.reference, state.item, state.events);
    lensprof_error error{};
    check(lensprof_pto_set_result(project.get(), &stored.result.response, &green_falloff(stored.result),
                                  stored.exposures.data(), static_cast<uint32_t>(stored.exposures.size()),
                                  stored.reference, &error),
          scene.path, &error);
    if (state.settings.has_several_settings() || state.settings.has_rotated_images()) {
        const FalloffGroups groups = falloff_groups(state.settings);
        std::vector<lensprof_vignetting> falloffs;
        for (const uint32_t first : groups.first) {
            const bool is_fitted = stored.settings[state.settings.of_image[first]].images > 0;
            const size_t curve = stored.falloff_curves_of(first) == 3 ? 1 : 0;
            falloffs.push_back(is_fitted ? stored.falloff_of(first)[curve] : green_falloff(stored.result));
        }
        check(lensprof_pto_set_settings(project.get(), groups.of_image.data(),
                                        static_cast<uint32_t>(groups.of_image.size()), falloffs.data(),
                                        static_cast<uint32_t>(falloffs.size()), &error),
              scene.path, &error);
    }
    if (state.settings.has_several_cameras()) {
        std::vector<lensprof_response> responses;
        for (const uint32_t first : state.settings.first_of_camera) responses.push_back(stored.response_of(first));
        check(lensprof_pto_set_cameras(project.get(), state.settings.camera_of_image.data(),
                                       static_cast<uint32_t>(state.settings.camera_of_image.size()), responses.data(),
                                       static_cast<uint32_t>(responses.size()), &error),
              scene.path, &error);
    }
    return pto_text(*project);
}

}  // namespace lensprof
