// Whether given exposure times are those of a clip, before and after the fit.
#pragma once

#include <cmath>
#include <vector>

#include "photo/clip/clip_tracks.hpp"

namespace lensprof {

// How known exposures agree with those of the frames.
struct KnownAgreement {
    double rms_ev = NAN;          // each segment relative to its median; NaN: none is known
    int better_shift = 0;         // frames by which the known exposures come too late, if they then agree much better
    std::vector<uint32_t> wrong;  // few frames whose known exposures alone differ
    double wrong_ev = 0.0;        // by how much at most

    bool is_good() const { return rms_ev < largest_ev && better_shift == 0 && wrong.empty(); }
    static constexpr double largest_ev = 0.1;  // rms, above which known exposures are not those of these frames
};

// `known_ev`: one per frame, NaN = unknown; the frames have their exposures.
KnownAgreement agreement_with(const std::vector<double> &known_ev, const ClipTracks &clip);

// Failure (not usable) for known exposures that differ from what the frames show.
[[noreturn]] void refuse_times(const ClipTracks &clip, double rms_ev);

// The same for those that fit the frames better if they are moved by `shift` frames.
[[noreturn]] void refuse_shifted_times(const ClipTracks &clip, int shift);

// The same if the known exposures, one per frame with NaN for none, are certainly not those of these frames. Compared
// are the changes over 16 frames, all but the twentieth that differs most, with whatever exponent makes them most
// alike, because the response is not known yet.
void check_times_early(const ClipTracks &clip, const std::vector<double> &known_ev);

// The EV that is added to an exposure of the clip to get log2 of the known exposure time; 0 if none is known.
double offset_of_times(const ClipTracks &clip, const std::vector<double> &known_ev);

}  // namespace lensprof
