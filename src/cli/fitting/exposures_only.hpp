// What response and falloff are worth beside exposures alone, for pictures of scenes that no camera model explains
// well.
#pragma once

#include <string>

#include "cli/fitting/fitting.hpp"

namespace lensprof {

// Fits exposures and white balances of the input's pairs, with the typical response of its kind of camera and no
// falloff: what those correct that know nothing of the camera.
Fitted fit_exposures_only(FitInput input, uint32_t reference, const std::string &item, Progress &progress);

// Whether pairs that were held out of both fits differ less by the joint result: by the median of what is left, which
// things that are not matte move less than the mean.
bool is_joint_better(const Fitted &joint, const Fitted &exposures_only);

// See ColourVariance; `input` has the pairs, and the images that both results are of.
ColourVariance colour_variance(const FitInput &input, const Fitted &result, const Fitted &exposures_only);

}  // namespace lensprof
