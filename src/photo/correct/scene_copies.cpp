#include "photo/correct/scene_copies.hpp"

#include <algorithm>
#include <filesystem>

#include "photo/correct/project_model.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {

Correction copy_of_picture(const CopyNames &names) {
    Correction job;
    job.source = names.source, job.target = names.target;
    lensprof_exposure_init(&job.exposure);
    lensprof_exposure_init(&job.target_exposure);
    const PictureSize size = read_size(names.source);
    job.pixels = uint64_t(size.width) * size.height;
    return job;
}

lensprof_exposure common_exposure(const std::vector<lensprof_exposure> &exposures) {
    constexpr double largest_common_lift_ev = 1.0;
    lensprof_exposure common = mean_exposure(exposures);
    for (const lensprof_exposure &exposure : exposures)
        common.ev = std::min(common.ev, exposure.ev + largest_common_lift_ev);
    return common;
}

std::vector<Correction> copies_of_scene(const Project &scene, const std::vector<CopyNames> &names, uint32_t exposure) {
    const ImagesByFile images(scene);
    const std::vector<lensprof_exposure> exposures = relative_to_joined(scene);
    lensprof_exposure target;
    lensprof_exposure_init(&target);
    if (exposure == LENSPROF_COPY_EXPOSURE_MEAN) target = common_exposure(joined_exposures(scene, exposures));
    const auto encoding = common_encoding(scene);
    std::vector<Correction> jobs;
    for (const CopyNames &copy : names) {
        const auto image = images.find(copy.source);
        if (!image || scene.images[*image].left_out)
            throw Failure(LENSPROF_ERROR_NOT_FOUND,
                          copy.source + (image ? ": was left out of the result of " : ": is not a picture of ")
                              + scene.path + "; leave it out, or correct it by a stored profile");
        Correction job = copy_of_picture(copy);
        job.model = model_of_project(scene, *image);
        job.exposure = exposures[*image];
        job.target_exposure = exposure == LENSPROF_COPY_EXPOSURE_KEEP ? job.exposure : target;
        job.encoding = encoding;
        job.model_name = std::filesystem::path(scene.path).filename().string();
        jobs.push_back(std::move(job));
    }
    return jobs;
}

}  // namespace lensprof
