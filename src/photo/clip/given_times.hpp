// Whether given exposure times are those of a clip, before anything is fitted.
#pragma once

#include "photo/clip/clip_tracks.hpp"

namespace lensprof {

// Failure (not usable) for known exposures that differ from what the frames show.
[[noreturn]] void refuse_times(const ClipTracks &clip, double rms_ev);

// The same if the known exposures, one per frame with NaN for none, are certainly not those of these frames. Compared
// are the changes over 16 frames, with whatever exponent makes them most alike, because the response is not known yet.
void check_times_early(const ClipTracks &clip, const std::vector<double> &known_ev);

// The EV that is added to an exposure of the clip to get log2 of the known exposure time; 0 if none is known.
double offset_of_times(const ClipTracks &clip, const std::vector<double> &known_ev);

}  // namespace lensprof
