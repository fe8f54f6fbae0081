#include "photo/correct/scene_copies.hpp"

#include <algorithm>
#include <filesystem>

#include "photo/correct/scene_model.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/scene/exposures.hpp"

namespace lensprof {
namespace {

lensprof_exposure common_exposure(const std::vector<lensprof_exposure> &exposures) {
    constexpr double largest_common_lift_ev = 1.0;
    lensprof_exposure common = mean_exposure(exposures);
    for (const lensprof_exposure &exposure : exposures)
        common.ev = std::min(common.ev, exposure.ev + largest_common_lift_ev);
    return common;
}

}  // namespace

Correction copy_of_picture(const CopyNames &names) {
    Correction job;
    job.source = names.source, job.target = names.target;
    lensprof_exposure_init(&job.exposure);
    lensprof_exposure_init(&job.target_exposure);
    return job;
}

SceneCorrection::SceneCorrection(const Scene &scene, uint32_t exposure, const std::string &name)
    : scene_(scene),
      exposure_(exposure),
      name_(name),
      images_(scene),
      exposures_(relative_to_joined(scene)),
      encoding_(common_encoding(scene)) {
    lensprof_exposure_init(&target_);
    if (exposure == LENSPROF_COPY_EXPOSURE_MEAN) target_ = common_exposure(joined_exposures(scene, exposures_));
}

void SceneCorrection::put_into(uint32_t image, Correction &job) const {
    job.model = scene_.models[image];
    job.exposure = exposures_[image];
    job.target_exposure = exposure_ == LENSPROF_COPY_EXPOSURE_KEEP ? job.exposure : target_;
    job.encoding = encoding_;
    job.model_name = name_;
}

std::vector<Correction> copies_of_scene(const Scene &scene, const std::vector<CopyNames> &names, uint32_t exposure) {
    const SceneCorrection correction(scene, exposure, std::filesystem::path(scene.path).filename().string());
    std::vector<Correction> jobs;
    for (const CopyNames &copy : names) {
        const auto image = correction.find(copy.source);
        if (!image || correction.is_left_out(*image))
            throw Failure(LENSPROF_ERROR_NOT_FOUND,
                          copy.source + (image ? ": was left out of the result of " : ": is not a picture of ")
                              + scene.path + "; leave it out, or correct it by a stored profile");
        jobs.push_back(copy_of_picture(copy));
        correction.put_into(*image, jobs.back());
    }
    return jobs;
}

}  // namespace lensprof
