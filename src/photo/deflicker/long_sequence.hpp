// The exposures of many frames of a stationary camera, with a response fitted to a few of them.
#pragma once

#include <string>
#include <vector>

#include "photo/calibration/fit.hpp"

namespace lensprof {

constexpr size_t long_sequence_frames = 24;  // more than these are a long sequence

struct LongSequence {
    Fitted fitted;                     // to some of the frames; with the exposures of all, relative to the first
    std::vector<std::string> names;    // of the frames that it was fitted to
    std::vector<double> white_shares;  // per frame: of its samples that are saturated
};

// Fits frames of different exposures, and chains the exposures of all by their ratios (measure.hpp). Frames without
// information, unlike the others, or after a cut have an ev of NaN. Failure.
LongSequence fit_long_sequence(const std::vector<std::string> &files, const FitOptions &options,
                               const SamplingOptions &pixels, Events &events);

}  // namespace lensprof
