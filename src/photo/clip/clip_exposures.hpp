// The exposure of every frame of a clip, under a known response and falloff.
#pragma once

#include <array>

#include "fit/base/chained.hpp"
#include "photo/clip/given_times.hpp"

namespace lensprof {

struct ClipModel {
    lensprof_response response;
    std::array<lensprof_vignetting, 3> falloff;
    bool is_exponent_open = false;  // that of typical cameras
};

// Sets state, segment and exposure of all frames. Every frame is compared with those 1, 2, 4, ... 256 frames before it:
// the ratio of two frames is the mode over the scene points that both show. The exposures are the least squares
// solution of all ratios, so that errors do not add up over the life of a point. Frames that are not connected form
// segments, each relative to its geometric mean. Known exposures, one per frame with NaN for none, hold and connect
// segments unless they contradict the ratios. Returns how they agree before they enter.
KnownAgreement find_exposures(const ClipModel &model, const KnownLevels &known, ClipTracks &clip);

}  // namespace lensprof
