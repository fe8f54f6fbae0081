#include "photo/correct/scene_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lensprof {

std::shared_ptr<const lensprof_profile> model_of(const Scene &scene, uint32_t image) {
    if (!scene.models.empty()) return scene.models[image];
    auto profile = std::shared_ptr<lensprof_profile>(new_profile());
    lensprof_error error{};
    check(lensprof_pto_get_response(scene.pto.get(), image, &profile->response[0], &error), scene.path, &error);
    profile->vignetting[0] = scene.images[image].vignetting;
    return profile;
}

// The reference of the project, or the first image of its result.
static uint32_t joined_reference(const Scene &scene) {
    uint32_t reference = scene.reference;
    for (uint32_t i = 0; i < scene.images.size() && scene.images[reference].left_out; i++)
        if (!scene.images[i].left_out) reference = i;
    return reference;
}

std::shared_ptr<const lensprof_response> common_encoding(const Scene &scene) {
    const uint32_t reference = joined_reference(scene);
    const auto &first = scene.images[reference];
    const bool has_one_encoding =
        scene.models.empty()
            ? std::all_of(scene.images.begin(), scene.images.end(),
                          [&](const lensprof_pto_image &image) {
                              return image.response_type == first.response_type
                                     && std::equal(image.emor, image.emor + 5, first.emor);
                          })
            : std::all_of(scene.models.begin(), scene.models.end(), [&](const auto &model) {
                  const auto &table = model->response[0].table;
                  return std::equal(std::begin(table), std::end(table), scene.models[reference]->response[0].table);
              });
    if (has_one_encoding) return nullptr;
    return std::make_shared<lensprof_response>(model_of(scene, reference)->response[0]);
}

std::vector<lensprof_exposure> relative_to_joined(const Scene &scene) {
    return relative_exposures(scene_exposures(scene), joined_reference(scene));
}

std::vector<lensprof_exposure> joined_exposures(const Scene &scene, const std::vector<lensprof_exposure> &all) {
    std::vector<lensprof_exposure> joined;
    for (size_t i = 0; i < all.size(); i++)
        if (!scene.images[i].left_out) joined.push_back(all[i]);
    return joined;
}

Fitted result_of_scene(const Scene &scene) {
    Fitted fitted;
    lensprof_fit_result_init(&fitted.result);
    fitted.result.vignettings = 1;
    fitted.reference = scene.reference;
    for (uint32_t i = 0; i < scene.images.size(); i++) {
        const auto model = model_of(scene, i);
        lensprof_fit_result of_image{};
        of_image.images = 1, of_image.vignettings = model->vignettings;
        std::copy_n(model->vignetting, std::size(of_image.vignetting), of_image.vignetting);
        of_image.response = model->response[0];
        fitted.setting_of.push_back(i);
        fitted.settings.push_back(of_image);
    }
    fitted.exposures = relative_to_joined(scene);
    for (size_t i = 0; i < scene.images.size(); i++)
        if (scene.images[i].left_out) fitted.exposures[i].ev = NAN;
    return fitted;
}

}  // namespace lensprof
