#include "photo/scene/exposures.hpp"

namespace lensprof {

lensprof_exposure mean_exposure(const std::vector<lensprof_exposure> &exposures) {
    lensprof_exposure mean;
    lensprof_exposure_mean(exposures.data(), exposures.size(), &mean);
    return mean;
}

std::vector<lensprof_exposure> relative_exposures(std::vector<lensprof_exposure> exposures, uint32_t reference) {
    const lensprof_exposure zero = exposures[reference];
    for (auto &e : exposures) {
        e.ev -= zero.ev;
        for (int c = 0; c < 3; c++) e.white_balance[c] /= zero.white_balance[c];
    }
    return exposures;
}

std::vector<lensprof_exposure> scene_exposures(const Scene &scene) {
    std::vector<lensprof_exposure> exposures;
    for (const auto &image : scene.images) exposures.push_back(image.exposure);
    return relative_exposures(exposures, scene.reference);
}

}  // namespace lensprof
