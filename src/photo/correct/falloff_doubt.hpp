// Falloffs that no lens has.
#pragma once

#include <cstdint>
#include <string>

#include <lensprof/profile.h>

namespace lensprof {

// "its falloff rises to 1.08 times the centre, 0.62 half diagonals from it"; empty for a possible falloff. Possible is
// kSmallestM to kLargestRise inside a frame of width x height px (0 = unknown, 3:2 is assumed) that rises outward by at
// most kSmallRise, or by more if the rise is twice its standard error; is_circular: inside its circle only. What lies
// outside of the image circle does not count. A gain grid is measured, and not judged.
std::string impossible_falloff(const lensprof_profile &profile, uint32_t width, uint32_t height,
                               bool is_circular = false);

}  // namespace lensprof
