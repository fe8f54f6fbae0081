#include "cli/correct/project_model.hpp"

namespace lensprof {

std::shared_ptr<lensprof_profile> model_of_project(const Project &project, uint32_t image) {
    auto profile = std::shared_ptr<lensprof_profile>(new_profile());
    lensprof_error error{};
    check(lensprof_pto_get_response(project.pto.get(), image, &profile->response[0], &error), project.path, &error);
    profile->vignetting[0] = project.images[image].vignetting;
    return profile;
}

std::vector<lensprof_exposure> relative_to_joined(const Project &project) {
    uint32_t reference = project.reference;
    for (uint32_t i = 0; i < project.images.size() && project.images[reference].left_out; i++)
        if (!project.images[i].left_out) reference = i;
    return relative_exposures(project_exposures(project), reference);
}

std::vector<lensprof_exposure> joined_exposures(const Project &project, const std::vector<lensprof_exposure> &all) {
    std::vector<lensprof_exposure> joined;
    for (size_t i = 0; i < all.size(); i++)
        if (!project.images[i].left_out) joined.push_back(all[i]);
    return joined;
}

}  // namespace lensprof
