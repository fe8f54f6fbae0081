// Copies of the pictures of a calibrated scene.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/photo.h>

#include "photo/correct/correction.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

struct CopyNames {
    std::string source, target;
};

// Without a model and at its own exposure; the number of pixels is not set.
Correction copy_of_picture(const CopyNames &names);

// How a scene with a result corrects its pictures.
class SceneCorrection {
public:
    // `exposure`: lensprof_copy_exposure. MEAN is lowered so that no picture is lifted by more than 1 EV: what is
    // brighter than half the limit clips. `name` is that of the model in the copies. `scene` must live as long.
    SceneCorrection(const Scene &scene, uint32_t exposure, const std::string &name);

    std::optional<uint32_t> find(const std::string &file) const { return images_.find(file); }
    bool is_left_out(uint32_t image) const { return scene_.images[image].left_out != 0; }

    // Sets model and exposures of the copy of an image.
    void put_into(uint32_t image, Correction &job) const;

private:
    const Scene &scene_;
    const uint32_t exposure_;
    const std::string name_;
    const ImagesByFile images_;
    const std::vector<lensprof_exposure> exposures_;
    const std::shared_ptr<const lensprof_response> encoding_;
    lensprof_exposure target_;
};

// Failure (NOT_FOUND) for a picture that is not in the result of the scene.
std::vector<Correction> copies_of_scene(const Scene &scene, const std::vector<CopyNames> &names, uint32_t exposure);

}  // namespace lensprof
