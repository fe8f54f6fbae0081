// Whether given exposure times are those of a clip, before and after the fit.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "photo/clip/clip_tracks.hpp"

namespace lensprof {

// How known exposures agree with those of the frames, each segment relative to its median.
struct KnownAgreement {
    double rms_ev = NAN;                 // NaN: fewer than two are known
    double scaled_rms_ev = NAN;          // the same with the exposures of the frames times `scale`, the best factor
    double scale = 1.0;                  // of the exponent
    uint32_t worst_frame = 0;            // where they differ most,
    double worst_ev = 0.0;               // and by how much
    int better_shift = 0;                // frames by which they come too late, if they then agree much better
    std::vector<uint32_t> wrong_frames;  // few frames whose known exposures alone differ

    bool is_good() const { return !(rms_ev > largest_ev) && better_shift == 0 && wrong_frames.empty(); }
    static constexpr double largest_ev = 0.1;  // rms, above which known exposures are not those of these frames
};

// `known_ev`: one per frame, NaN = unknown; the frames have their exposures. `is_exponent_open`: these are known up to
// a factor, so that rms_ev is scaled_rms_ev.
KnownAgreement agreement_with(const std::vector<double> &known_ev, bool is_exponent_open, const ClipTracks &clip);

// "frame 17", or "frames 17, 40": numbered from 1, at most eight of them.
std::string frame_list(std::vector<uint32_t> frames);

// How many of the known exposures may be wrong, and are left out: 3 %, or one.
size_t most_wrong(size_t known);

// Failure (not usable) for known exposures that differ from what the frames show.
[[noreturn]] void refuse_times(const ClipTracks &clip, double rms_ev);

// The same for those that fit the frames better if they are moved by `shift` frames.
[[noreturn]] void refuse_shifted_times(const ClipTracks &clip, int shift);

// The same if the known exposures, one per frame with NaN for none, are certainly not those of these frames. Compared
// are the changes over 16 frames, all but the tenth that differs most, with whatever exponent makes them most
// alike, because the response is not known yet.
void check_times_early(const ClipTracks &clip, const std::vector<double> &known_ev);

// The EV that is added to an exposure of the clip to get log2 of the known exposure time; 0 if none is known.
double offset_of_times(const ClipTracks &clip, const std::vector<double> &known_ev);

}  // namespace lensprof
