// Pictures of a closed shutter: an offset and noise, without light.
#pragma once

#include <vector>

#include "fit/fields/fit.hpp"

namespace lensprof {

// Whether linear pictures, of which `used` take part, show nothing but an offset and noise in every channel: neither
// one of them nor their mean varies over the frame by more than noise, and their levels differ by less than that.
bool are_dark(const FieldsFit &fit, const std::vector<uint32_t> &used);

}  // namespace lensprof
