#include "photo/correct/project_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lensprof {

std::shared_ptr<const lensprof_profile> model_of_project(const Project &project, uint32_t image) {
    if (!project.models.empty()) return project.models[image];
    auto profile = std::shared_ptr<lensprof_profile>(new_profile());
    lensprof_error error{};
    check(lensprof_pto_get_response(project.pto.get(), image, &profile->response[0], &error), project.path, &error);
    profile->vignetting[0] = project.images[image].vignetting;
    return profile;
}

// The reference of the project, or the first image of its result.
static uint32_t joined_reference(const Project &project) {
    uint32_t reference = project.reference;
    for (uint32_t i = 0; i < project.images.size() && project.images[reference].left_out; i++)
        if (!project.images[i].left_out) reference = i;
    return reference;
}

std::shared_ptr<const lensprof_response> common_encoding(const Project &project) {
    const uint32_t reference = joined_reference(project);
    const auto &first = project.images[reference];
    const bool has_one_encoding =
        project.models.empty()
            ? std::all_of(project.images.begin(), project.images.end(),
                          [&](const lensprof_pto_image &image) {
                              return image.response_type == first.response_type
                                     && std::equal(image.emor, image.emor + 5, first.emor);
                          })
            : std::all_of(project.models.begin(), project.models.end(), [&](const auto &model) {
                  const auto &table = model->response[0].table;
                  return std::equal(std::begin(table), std::end(table), project.models[reference]->response[0].table);
              });
    if (has_one_encoding) return nullptr;
    return std::make_shared<lensprof_response>(model_of_project(project, reference)->response[0]);
}

std::vector<lensprof_exposure> relative_to_joined(const Project &project) {
    return relative_exposures(project_exposures(project), joined_reference(project));
}

std::vector<lensprof_exposure> joined_exposures(const Project &project, const std::vector<lensprof_exposure> &all) {
    std::vector<lensprof_exposure> joined;
    for (size_t i = 0; i < all.size(); i++)
        if (!project.images[i].left_out) joined.push_back(all[i]);
    return joined;
}

Fitted result_of_scene(const Project &project) {
    Fitted fitted;
    lensprof_fit_result_init(&fitted.result);
    fitted.result.vignettings = 1;
    fitted.reference = project.reference;
    for (uint32_t i = 0; i < project.images.size(); i++) {
        const auto model = model_of_project(project, i);
        lensprof_fit_result of_image{};
        of_image.images = 1, of_image.vignettings = model->vignettings;
        std::copy_n(model->vignetting, std::size(of_image.vignetting), of_image.vignetting);
        of_image.response = model->response[0];
        fitted.setting_of.push_back(i);
        fitted.settings.push_back(of_image);
    }
    fitted.exposures = relative_to_joined(project);
    for (size_t i = 0; i < project.images.size(); i++)
        if (project.images[i].left_out) fitted.exposures[i].ev = NAN;
    return fitted;
}

}  // namespace lensprof
