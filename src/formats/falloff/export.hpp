// What the writers of databases share: which profiles they take, and the one curve that is written of three.
#pragma once

#include <array>
#include <string>

#include <lensprof/profile.h>

#include "formats/text/text.hpp"

namespace lensprof {

// Throws "profile INDEX: text" where something does not hold.
void demand_of_profile(bool holds, uint32_t index, const std::string &text,
                       lensprof_status status = LENSPROF_ERROR_ARGUMENT);

// A valid profile with lens, crop factor, focal length and aperture, not corrected in camera.
// `format` is the name for error texts.
void check_exported(const lensprof_profile &profile, uint32_t index, const std::string &format);
void check_no_grid(const lensprof_profile &profile, uint32_t index, const std::string &format);

// k1, k2, k3 of the mean of the curves; of one, or of three that are the same, exactly theirs.
std::array<double, 3> mean_curve(const lensprof_profile &profile);

}  // namespace lensprof
