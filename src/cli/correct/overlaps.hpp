// Pictures of the light in them and in those that overlap them (HDR), each in its own frame.
#pragma once

#include <optional>
#include <vector>

#include "cli/correct/lit_picture.hpp"

namespace lensprof {

// Failure (usage) for a picture with transparency, and for one that is grey where others are not, or the other way
// round: `layout` is that of the others, where there are any, and becomes this one's.
void check_mergeable(const std::string &file, std::optional<uint32_t> &layout);

// Writes the light of each picture of `jobs`, as 32 bit float, on its own scale (`wanted`): that of its own pixels and
// of all pictures that show the same place, each by how well it shows it: by 1/variance of the light, less and less
// next to black and white, not at all where it is that. Where the project is off by some pixels, or something has
// moved, the picture itself is right: another one counts where this one would have recorded its light with the grey
// values that it has, within .03 of full scale, and within .01 in black at most places about it. White fits all that is
// brighter. What masks of the project exclude of a picture does not count in others; in its own frame it stays. Warns
// of pictures that no other overlaps, and of those whose blocks agree with less than half of what others show of them.
// Memory, whatever the number: two pictures at full size, their light, and sums of 8 bytes a sample and one a pixel.
// The same bytes for every number of threads.
Corrected write_from_overlaps(const Project &project, const std::vector<PlacedCorrection> &jobs,
                              const std::vector<PlacedCorrection> &all, const CorrectionKind &kind, Progress &progress);

}  // namespace lensprof
