#include "photo/calibration/exposure_file.hpp"

#include <cmath>
#include <deque>
#include <filesystem>

#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

struct Exposures {
    std::vector<lensprof_exposures_camera> cameras;
    std::vector<lensprof_exposures_lens> lenses;
    std::vector<lensprof_exposures_image> images;
    std::deque<std::string> texts;  // to which the names point

    const char *keep(std::string text) { return texts.emplace_back(std::move(text)).c_str(); }
};

void add_camera(const SceneFit &state, uint32_t first, const std::string &name, Exposures &all) {
    lensprof_exposures_camera camera;
    lensprof_exposures_camera_init(&camera);
    camera.name = all.keep(name);
    camera.response = state.best.response_of(first);
    all.cameras.push_back(camera);
}

void add_lens(const SceneFit &state, uint32_t first, const std::string &name, Exposures &all) {
    lensprof_exposures_lens lens;
    lensprof_exposures_lens_init(&lens);
    lens.name = all.keep(name);
    lens.camera = state.settings.camera_of_image[first];
    lens.vignettings = state.best.falloff_curves_of(first);
    std::copy_n(state.best.falloff_of(first).data(), lens.vignettings, lens.vignetting);
    all.lenses.push_back(lens);
}

void add_image(const SceneFit &state, const Scene &scene, uint32_t i, const fs::path &folder, Exposures &all) {
    lensprof_exposures_image image;
    lensprof_exposures_image_init(&image);
    image.name = scene.names[i].c_str();
    if (path_exists(scene.files[i]))
        image.file = all.keep(fs::path(absolute_path(scene.files[i])).lexically_proximate(folder).string());
    image.width = scene.images[i].camera.width, image.height = scene.images[i].camera.height;
    image.lens = state.settings.of_image[i];
    image.exposure = state.best.exposures[i];
    if (i < state.report.quality.size()) {
        image.ev_sigma = state.report.quality[i].ev_sigma;
        std::copy_n(state.report.quality[i].white_balance_sigma, 3, image.white_balance_sigma);
    }
    all.images.push_back(image);
}

}  // namespace

std::string exposures_text(const SceneFit &state, const Scene &scene, const std::vector<PictureMetadata> &metadata,
                           const std::string &path) {
    const fs::path folder = fs::path(absolute_path(path)).parent_path();
    Exposures all;
    for (const uint32_t first : state.settings.first_of_camera)
        add_camera(state, first, describe_camera(metadata[first].key, scene.names[first]), all);
    for (const uint32_t first : falloff_groups(state.settings).first)
        add_lens(state, first, describe_setting(metadata[first].key, scene.names[first]), all);
    for (uint32_t i = 0; i < scene.names.size(); i++) add_image(state, scene, i, folder, all);
    lensprof_exposures_info info;
    lensprof_exposures_info_init(&info);
    info.camera_count = static_cast<uint32_t>(all.cameras.size());
    info.lens_count = static_cast<uint32_t>(all.lenses.size());
    info.image_count = static_cast<uint32_t>(all.images.size());
    info.reference = state.best.reference;
    return written(path, [&](void *data, size_t capacity, size_t *count, lensprof_error *error) {
        return lensprof_exposures_write(&info, all.cameras.data(), all.lenses.data(), all.images.data(), data, capacity,
                                        count, error);
    });
}

}  // namespace lensprof
