// From the exposures of the frames to those that they should have.
#pragma once

#include <vector>

#include <lensprof/deflicker.h>

#include "fit/deflicker/chain.hpp"

namespace lensprof {

lensprof_exposure exposure_of(const ChainFrame &frame, uint32_t channels);

lensprof_deflicker_result summarise(const FrameChain &chain);

// What is wanted for every frame; `window` receives the longest that was used. The target is valid.
std::vector<lensprof_exposure> wanted_exposures(const FrameChain &chain, const lensprof_deflicker_target &target,
                                                double &window);

}  // namespace lensprof
