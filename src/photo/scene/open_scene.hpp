// Opens a scene by the paths that the user names.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/scene/reconstruction_scene.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

struct SceneOptions {
    ReconstructionOptions reconstruction;
    bool one_lens = false;         // all pictures are from one camera
    bool takes_exposures = false;  // exposures.json is a scene, too; it cannot be fitted
};

// Takes pictures and folders and finds their overlaps, or takes one project, reconstruction or file of exposures.
// Failure (ARGUMENT) for paths that are not pictures, (READ), and (NOT_USABLE) if no two pictures overlap.
Scene open_scene(const std::vector<std::string> &paths, const SceneOptions &options, Events &events);

}  // namespace lensprof
