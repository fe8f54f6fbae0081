// Pictures of the light in them and in those that overlap them (HDR), each in its own frame.
#pragma once

#include <vector>

#include "cli/correct/correction.hpp"
#include "cli/fitting/project.hpp"

namespace lensprof {

// A correction of an image of a project, by the model of the project.
struct PlacedCorrection {
    Correction job;
    uint32_t image;
};

// Failure (usage) for pictures with transparency, and for grey ones among others.
void check_overlaps(const std::vector<PlacedCorrection> &all);

// Writes the light of each picture of `jobs`, as 32 bit float, on its own scale (`wanted`): that of its own pixels and
// of all pictures that show the same place, each by how well it shows it: by 1/variance of the light, less and less
// next to black and white, not at all where it is that. Where the project is off by some pixels, or something has
// moved, the picture itself is right: another one counts where this one would have recorded its light with the grey
// values that it has, within .03 of full scale; white fits all that is brighter. Masks of the project are respected.
// Bounded memory: two pictures at full size and their light, whatever the number. The same bytes for every number of
// threads.
Corrected write_from_overlaps(const Project &project, const std::vector<PlacedCorrection> &jobs,
                              const std::vector<PlacedCorrection> &all, const CorrectionKind &kind, Progress &progress);

}  // namespace lensprof
