// The exposure of every frame of a clip, under a known response and falloff.
#pragma once

#include <array>

#include "fit/base/chained.hpp"
#include "photo/clip/clip_tracks.hpp"

namespace lensprof {

constexpr double largest_known_error_ev = 0.1;  // rms, above which known exposures are not those of these frames

struct ClipModel {
    lensprof_response response;
    std::array<lensprof_vignetting, 3> falloff;
};

// Sets state, segment and exposure of all frames. Every frame is compared with those 1, 2, 4, ... 256 frames before it:
// the ratio of two frames is the mode over the scene points that both show. The exposures are the least squares
// solution of all ratios, so that errors do not add up over the life of a point. Frames that are not connected form
// segments, each relative to its geometric mean. Known exposures, one per frame with NaN for none, hold and connect
// segments unless they contradict the ratios by 0.1 EV (rms). Returns by how much the exposures differ from the known
// ones without them, EV rms; NaN: none is known.
double find_exposures(const ClipModel &model, const KnownLevels &known, ClipTracks &clip);

}  // namespace lensprof
