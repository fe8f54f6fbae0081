// A structure-from-motion reconstruction as a project.
#pragma once

#include <string>

#include "photo/base/events.hpp"
#include "photo/base/shard.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

struct ReconstructionOptions {
    std::string images;            // folder of the pictures; empty: search for them
    bool is_by_colours = false;    // use the colours of the tracks, read no pictures
    std::string image_list;        // file with the image names to use, one per line; empty: all
    Shard shard;                   // of the images
    uint32_t pairs = 0, seed = 1;  // number of pairs; 0: 600 per image, or fewer for many images
};

// Images of one size are linked: EXIF distinguishes cameras and settings. Pictures are compared at the project's
// matches; without pictures, the colours of the tracks, if any, are its pairs.
Scene scene_of_reconstruction(const std::string &path, const ReconstructionOptions &options, Events &events);

// Failure (unreadable) for a file that belongs to a reconstruction but is not its main file, with the file to give
// instead. For names that are not a reconstruction.
void reject_reconstruction_part(const std::string &path);

}  // namespace lensprof
