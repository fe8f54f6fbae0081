// Measures how far a project is off between two images, by blocks of the pictures that look alike.
#pragma once

#include "fit/sampling/blocks.hpp"

namespace lensprof {

// The correction under which blocks match, from coarse to fine. No correction if the project is right within a pixel of
// the views, or if the pictures do not determine one.
Correction registration(const lensprof_camera &first, const GreyLevels &first_grey, const lensprof_camera &second,
                        const GreyLevels &second_grey);

}  // namespace lensprof
