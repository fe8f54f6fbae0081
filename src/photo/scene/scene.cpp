#include "photo/scene/scene.hpp"

#include <algorithm>

#include "photo/base/paths.hpp"
#include "photo/scene/exposures.hpp"

namespace lensprof {
namespace {

// The first image with the same `number` as image i.
template <class Number>
uint32_t first_of(const std::vector<NewImage> &images, Number NewImage::*number, uint32_t i) {
    uint32_t first = 0;
    while (images[first].*number != images[i].*number) first++;
    return first;
}

// The mean response of the EMoR database, and no falloff.
std::shared_ptr<const lensprof_profile> mean_model() {
    auto model = std::shared_ptr<lensprof_profile>(new_profile());
    const double coefficients[5] = {};
    check(lensprof_response_set_emor(&model->response[0], coefficients, 5), "response");
    return model;
}

}  // namespace

void set_images(const std::vector<NewImage> &images, Scene &scene) {
    scene.images.clear(), scene.lenses.clear();
    for (uint32_t i = 0; i < images.size(); i++) {
        lensprof_pto_image image;
        lensprof_pto_image_init(&image);
        image.camera = images[i].camera;
        lensprof_exposure_init(&image.exposure);
        image.free = LENSPROF_FREE_LENS | (i ? LENSPROF_FREE_IMAGE : 0);
        image.response_of = image.vignetting_of = image.center_of = first_of(images, &NewImage::camera_id, i);
        image.ev_of = image.red_of = image.blue_of = i;
        image.crop[2] = static_cast<int32_t>(image.camera.width);
        image.crop[3] = static_cast<int32_t>(image.camera.height);
        scene.images.push_back(image);
        scene.lenses.push_back(first_of(images, &NewImage::lens, i));
    }
    scene.models.assign(images.size(), mean_model());
}

lensprof_camera camera_of_size(uint32_t width, uint32_t height) {
    lensprof_camera camera{};
    camera.projection = LENSPROF_PROJECTION_RECTILINEAR;
    camera.width = width, camera.height = height;
    camera.hfov_deg = 50.0;
    return camera;
}

FalloffFrame falloff_frame_of(const lensprof_pto_image &image) {
    const int32_t *crop = image.crop;
    if (!image.of_crop) return {0.0, 0.0, image.camera.width, image.camera.height};
    return {double(crop[0]), double(crop[1]), static_cast<uint32_t>(crop[2] - crop[0]),
            static_cast<uint32_t>(crop[3] - crop[1])};
}

void move_place(const Scene &scene, uint32_t image, double sign, double xy[2]) {
    const FalloffFrame frame = falloff_frame_of(scene.images[image]);
    xy[0] -= sign * frame.left, xy[1] -= sign * frame.top;
}

void move_places(const Scene &scene, double sign, std::vector<lensprof_pair> &pairs) {
    for (lensprof_pair &pair : pairs)
        for (int side = 0; side < 2; side++) move_place(scene, pair.image[side], sign, pair.xy[side]);
}

bool has_crops(const Scene &scene) {
    return std::any_of(scene.images.begin(), scene.images.end(),
                       [](const lensprof_pto_image &image) { return image.of_crop != 0; });
}

void refuse_crops(const Scene &scene, const std::string &option) {
    if (!has_crops(scene)) return;
    throw Failure(LENSPROF_ERROR_ARGUMENT, option + ": does not support " + scene.path
                                       + ", whose images are crops of one file, such as its two circles; use build and "
                                         "apply without it, or give a file per image");
}

uint32_t image_of_word(const Scene &scene, const std::string &word) {
    for (uint32_t i = 0; i < scene.names.size(); i++)
        if (word == scene.names[i] || word == std::to_string(i)) return i;
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  word + ": not an image of " + scene.path + "; give the number or name of one");
}

ImagesByFile::ImagesByFile(const Scene &scene) : scene_(&scene) {
    for (uint32_t i = 0; i < scene.files.size(); i++) images_.emplace(file_identity(scene.files[i]), i);
}

std::optional<uint32_t> ImagesByFile::find(const std::string &file) const {
    const auto found = images_.find(file_identity(file));
    return found == images_.end() ? std::nullopt : std::optional<uint32_t>(found->second);
}

uint32_t ImagesByFile::at(const std::string &file, const std::string &option) const {
    if (const auto found = find(file)) return *found;
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  file + ": is not a picture of " + scene_->path + "; omit it, or omit " + option);
}

std::vector<lensprof_fit_image> fit_images(const Scene &scene) {
    std::vector<lensprof_fit_image> images;
    auto exposures = scene_exposures(scene);
    for (const auto &from : scene.images) {
        lensprof_fit_image image;
        const FalloffFrame frame = falloff_frame_of(from);
        lensprof_fit_image_init(&image, static_cast<uint32_t>(images.size()), frame.width, frame.height);
        image.exposure = exposures[images.size()];
        image.free = from.free & LENSPROF_FREE_IMAGE;
        image.ev_of = from.ev_of;
        image.red_of = from.red_of;
        image.blue_of = from.blue_of;
        images.push_back(image);
    }
    return images;
}

}  // namespace lensprof
