// The exposure of every frame of a clip, under a known response and falloff.
#pragma once

#include <array>

#include "photo/clip/clip_tracks.hpp"

namespace lensprof {

struct ClipModel {
    lensprof_response response;
    std::array<lensprof_vignetting, 3> falloff;
};

// Sets state, segment and exposure of all frames. Every frame is compared with those 1, 2, 4, ... 256 frames before it:
// per channel, the ratio of two frames is the robust mean over the scene points that both show. The exposures are the
// least squares solution of all ratios, so that errors do not add up over the life of a point. Frames that are not
// connected form segments, each relative to its geometric mean.
void find_exposures(const ClipModel &model, ClipTracks &clip);

}  // namespace lensprof
