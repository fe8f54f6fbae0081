// The frames of a clip that the fit uses.
#pragma once

#include <cstdint>
#include <vector>

#include "photo/clip/clip_tracks.hpp"

namespace lensprof {

// What two frames have in common.
struct CommonPoints {
    size_t shared = 0;     // scene points, neither black nor white
    double step_ev = 0.0;  // median change, from grey values as if the response were that of gamma 2.2
};

CommonPoints common_of(const ClipObservations &first, const ClipObservations &second);

// Frames in order, at most `most` of them, of one segment. A keyframe follows where too few scene points of the last
// one are still seen, or its exposure changed. The share of the points is the smallest that gives 50 keyframes. Of a
// clip with more than `most`, the consecutive keyframes over which the exposure changes most.
std::vector<uint32_t> choose_keyframes(const ClipTracks &clip, uint32_t most);

}  // namespace lensprof
