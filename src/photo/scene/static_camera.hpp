// Pictures of one scene from a stationary camera, as a project without a Hugin file.
#pragma once

#include <string>
#include <vector>

#include "photo/scene/scene.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {

// A project in which all pictures have the same camera, so that equal pixels show the same point; the falloff is fixed
// at zero because it is equal in all and cancels. Exposures are free, white balances if `free_balance`; the first
// picture is the reference. Failure (usage) for fewer than two files or a repeated one; Failure (unreadable) with the
// name of a picture of another size than the first.
Scene static_scene(const std::vector<std::string> &files, bool free_balance);

// Samples pairs of such pictures, `options.pairs` or 10000 per picture: values next to black and white are included,
// because EMoR modes fail at the ends of a response. Grey levels up to `black` of 255 are ignored.
std::vector<lensprof_pair> sample_still(const Scene &scene, std::vector<SamplePicture> &pictures,
                                        lensprof_sample_options options, double black, Events &progress);

}  // namespace lensprof
