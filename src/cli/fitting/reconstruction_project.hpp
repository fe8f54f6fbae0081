// What structure from motion found, as a project.
#pragma once

#include <string>

#include "cli/fitting/project.hpp"
#include "cli/program/run.hpp"
#include "cli/program/shard.hpp"

namespace lensprof {

struct ReconstructionOptions {
    std::string images;            // folder of the pictures; empty: where they are looked for
    bool is_by_colours = false;    // the colours of the tracks are taken, and no picture is read
    std::string image_list;        // file of the names of images that are taken, one a line; empty: all
    Shard shard;                   // of the images
    uint32_t pairs = 0, seed = 1;  // wanted; 0: 600 an image, or fewer of many
};

// Images of one size are linked: EXIF tells cameras and settings apart. Pictures of the project are compared at its
// matches; where there are no pictures, and the tracks have colours, these are its pairs.
Project project_of_reconstruction(const std::string &path, const ReconstructionOptions &options, Streams &streams);

// Failure (unreadable) for a file that belongs to a reconstruction but is not what is read first, with what to give
// instead. For names that are not a reconstruction.
void check_is_no_part(const std::string &path);

}  // namespace lensprof
