// Pictures of a closed shutter: an offset and noise, without light.
#pragma once

#include <vector>

#include "fit/fields/fit.hpp"

namespace lensprof {

// Those of the linear pictures `used` that show nothing but an offset and noise in every channel: neither one of them
// nor their mean varies over the frame by more than noise, and they are above the darkest by no more than that.
std::vector<uint32_t> dark_pictures(const FieldsFit &fit, const std::vector<uint32_t> &used);

}  // namespace lensprof
