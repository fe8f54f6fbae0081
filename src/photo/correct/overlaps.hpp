// Merges overlapping pictures (HDR), each in its own frame.
#pragma once

#include <optional>
#include <vector>

#include "photo/correct/lit_picture.hpp"

namespace lensprof {

// Failure (usage) for a picture with transparency, or if grey and colour pictures are mixed: `layout` is that of the
// previous pictures, if any, and is set to that of this one.
void check_mergeable(const std::string &file, std::optional<uint32_t> &layout);

// Writes the irradiance of each picture of `jobs`, as 32 bit float, on its own scale (`wanted`): the mean of its own
// pixels and of all pictures that show the same point, weighted by 1/variance of the irradiance, fading to zero weight
// near black and white. If the project is misaligned by some pixels or something moved, the picture itself takes
// precedence: another picture contributes only where this one would have recorded its irradiance with the grey values
// that it has, within .03 of full scale, and in black areas within .01 at most surrounding points. White is consistent
// with any brighter value. Areas masked in the project do not contribute to other pictures but stay in the picture's
// own frame. Warns of pictures that no other overlaps, and of pictures whose blocks agree with less than half of the
// overlapping ones. Memory use, regardless of the number of pictures: two full-size pictures, their irradiance, and
// sums of 8 bytes per sample and one byte per pixel. The output bytes do not depend on the number of threads.
Corrected write_from_overlaps(const Scene &scene, const std::vector<PlacedCorrection> &jobs,
                              const std::vector<PlacedCorrection> &all, const CorrectionKind &kind, Events &events);

}  // namespace lensprof
