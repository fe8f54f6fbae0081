// Black and white level of the samples of a picture.
#pragma once

#include <string>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// Whether a sample is anything but its grey value.
bool has_levels(const lensprof_levels &levels);

// Failure (not usable) if a part of a channel lies clearly below its black level, which is too high then: dark parts
// would be left out, or pass for what lies outside of an image circle. Names the option that states the level.
void require_black_below(const Picture &picture, uint32_t channel, const lensprof_levels &levels,
                         const std::string &file, const std::string &option);

// Replaces samples by floats: 0 at the black level, 1 at the white level. Noise about black stays, below 0.
void remove_levels(const lensprof_levels &levels, Picture &picture);

}  // namespace lensprof
