#include "photo/correct/scene_model.hpp"
#include "photo/scene/exposures.hpp"

#include <algorithm>
#include <iterator>

namespace lensprof {

// The reference of the scene, or the first image of its result.
static uint32_t joined_reference(const Scene &scene) {
    uint32_t reference = scene.reference;
    for (uint32_t i = 0; i < scene.images.size() && scene.images[reference].left_out; i++)
        if (!scene.images[i].left_out) reference = i;
    return reference;
}

std::shared_ptr<const lensprof_response> common_encoding(const Scene &scene) {
    const uint32_t reference = joined_reference(scene);
    const lensprof_response &response = scene.models[reference]->response[0];
    const bool has_one_encoding = std::all_of(scene.models.begin(), scene.models.end(), [&](const auto &model) {
        const auto &table = model->response[0].table;
        return std::equal(std::begin(table), std::end(table), response.table);
    });
    if (has_one_encoding) return nullptr;
    return std::make_shared<lensprof_response>(response);
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

}  // namespace lensprof
