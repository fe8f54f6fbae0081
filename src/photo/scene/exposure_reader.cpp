#include "photo/scene/exposure_reader.hpp"

#include <cmath>
#include <filesystem>

#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/pictures.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

struct ExposuresDestroy {
    void operator()(lensprof_exposures *exposures) const { lensprof_exposures_destroy(exposures); }
};
using Exposures = std::unique_ptr<lensprof_exposures, ExposuresDestroy>;

// One model per lens, shared by its images.
std::vector<std::shared_ptr<const lensprof_profile>> models_of(const Exposures &exposures, uint32_t count) {
    std::vector<std::shared_ptr<const lensprof_profile>> models;
    for (uint32_t i = 0; i < count; i++) {
        lensprof_exposures_lens lens;
        lensprof_exposures_camera camera;
        lensprof_exposures_lens_init(&lens), lensprof_exposures_camera_init(&camera);
        check(lensprof_exposures_get_lens(exposures.get(), i, &lens, nullptr), "lens");
        check(lensprof_exposures_get_camera(exposures.get(), lens.camera, &camera, nullptr), "camera");
        auto model = std::shared_ptr<lensprof_profile>(new_profile());
        model->response[0] = camera.response;
        model->vignettings = lens.vignettings;
        std::copy_n(lens.vignetting, lens.vignettings, model->vignetting);
        models.push_back(model);
    }
    return models;
}

std::string picture_of(const lensprof_exposures_image &image, const Scene &scene, const std::string &images) {
    if (!images.empty()) return picture_of_name(images, image.name);
    if (!image.file)
        throw Failure(LENSPROF_ERROR_READ, scene.path + ": does not state the folder of " + image.name
                                               + "; give it with " + option_name("images")
                                               + advice("exposure_file_wanted"));
    return (fs::path(scene.path).parent_path() / image.file).lexically_normal().string();
}

void add_image(const lensprof_exposures_image &given, const std::string &images, Scene &scene) {
    lensprof_pto_image image;
    lensprof_pto_image_init(&image);
    image.camera.width = given.width, image.camera.height = given.height;
    image.left_out = std::isnan(given.exposure.ev);
    lensprof_exposure_init(&image.exposure);
    if (!image.left_out) image.exposure = given.exposure;
    const auto index = static_cast<uint32_t>(scene.images.size());
    image.response_of = image.vignetting_of = image.center_of = image.ev_of = image.red_of = image.blue_of = index;
    scene.images.push_back(image);
    scene.names.push_back(given.name);
    scene.files.push_back(picture_of(given, scene, images));
}

}  // namespace

bool is_exposure_file(const std::string &path) {
    return read_head(path, 256).find("\"lensprof exposures\"") != std::string::npos;
}

Scene exposures_of(const std::string &text, const std::string &path, const std::string &images) {
    lensprof_exposures *handle = nullptr;
    lensprof_error error{};
    const lensprof_status status = lensprof_exposures_read(text.data(), text.size(), &handle, &error);
    const Exposures exposures(handle);
    if (status != LENSPROF_OK) throw Failure(status, path + ": " + error.text + advice("exposure_file_wanted"));
    lensprof_exposures_info info;
    lensprof_exposures_info_init(&info);
    check(lensprof_exposures_get_info(handle, &info, nullptr), path);
    Scene scene;
    scene.path = path;
    scene.reference = info.reference;
    const auto models = models_of(exposures, info.lens_count);
    for (uint32_t i = 0; i < info.image_count; i++) {
        lensprof_exposures_image image;
        lensprof_exposures_image_init(&image);
        check(lensprof_exposures_get_image(handle, i, &image, nullptr), path);
        add_image(image, images, scene);
        scene.models.push_back(models[image.lens]);
    }
    return scene;
}

Scene read_exposures(const std::string &path, const std::string &images) {
    return exposures_of(read_text(path, max_text_bytes), path, images);
}

}  // namespace lensprof
