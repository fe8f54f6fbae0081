#include "photo/calibration/exposure_file.hpp"

#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "photo/base/paths.hpp"
#include "photo/scene/exposures.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

// The response in its own form, and the irradiance of every 8 bit grey level.
Json camera_json(const lensprof_response &response, const std::string &name) {
    Json curve = response_json(&response, 1), light = Json::array();
    if (response.kind != LENSPROF_RESPONSE_TABLE) curve.erase("values");
    for (int level = 0; level < 256; level++)
        light.push_back(lensprof_response_invert(&response, level / 255.0, nullptr));
    return {{"name", name}, {"response", curve}, {"light_of_level", light}};
}

Json cameras_json(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata) {
    Json list = Json::array();
    for (const uint32_t first : state.settings.first_of_camera)
        list.push_back(
            camera_json(state.best.response_of(first), describe_camera(metadata[first].key, scene.names[first])));
    return list;
}

Json lenses_json(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata) {
    Json list = Json::array();
    for (const uint32_t first : falloff_groups(state.settings).first)
        list.push_back({{"name", describe_setting(metadata[first].key, scene.names[first])},
                        {"camera", state.settings.camera_of_image[first]},
                        {"vignetting",
                         vignetting_json(state.best.falloff_of(first).data(), state.best.falloff_curves_of(first))}});
    return list;
}

Json image_json(const SceneFit &state, const Scene &scene, uint32_t i, const fs::path &folder) {
    const lensprof_exposure &exposure = state.best.exposures[i];
    const lensprof_camera &frame = scene.images[i].camera;
    Json json = {{"name", scene.names[i]}};
    if (path_exists(scene.files[i]))
        json["file"] = fs::path(absolute_path(scene.files[i])).lexically_proximate(folder).string();
    json["width"] = frame.width, json["height"] = frame.height;
    json["lens"] = state.settings.of_image[i];
    if (std::isnan(exposure.ev)) {
        json["ev"] = Json();
        return json;
    }
    json["ev"] = exposure.ev;
    json["white_balance"] = exposure.white_balance;
    if (i < state.report.quality.size()) {
        json["ev_sigma"] = number_or_null(state.report.quality[i].ev_sigma);
        json["white_balance_sigma"] = state.report.quality[i].white_balance_sigma;
    }
    return json;
}

}  // namespace

Json exposures_json(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                    const std::string &path) {
    const fs::path folder = fs::path(absolute_path(path)).parent_path();
    Json images = Json::array();
    for (uint32_t i = 0; i < scene.names.size(); i++) images.push_back(image_json(state, scene, i, folder));
    const lensprof_exposure mean = mean_exposure(state.best.exposures);
    return {{"schema", exposures_schema},
            {"file", "lensprof exposures"},
            {"software", std::string("lensprof ") + lensprof_version()},
            {"reference", scene.names[state.best.reference]},
            {"mean", {{"ev", mean.ev}, {"white_balance", mean.white_balance}}},
            {"cameras", cameras_json(state, scene, metadata)},
            {"lenses", lenses_json(state, scene, metadata)},
            {"images", images}};
}

std::string exposures_text(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                           const std::string &path) {
    return exposures_json(state, scene, metadata, path).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lensprof
