// The calibration of a clip: response, falloff, and the exposure of every frame.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photo/calibration/fit.hpp"
#include "photo/clip/clip_exposures.hpp"

namespace lensprof {

struct ClipOptions {
    FitOptions fit;
    std::optional<lensprof_response> response;  // known, and not fitted
    std::vector<double> known_ev;               // per frame, NaN = unknown; empty: none is known
    double known_sigma_ev = 0.02;               // standard error of each
    uint32_t most_keyframes = 60;
};

struct ClipFit {
    BuildReport report;  // of the keyframes
    Fitted best;
    std::vector<uint32_t> keyframes;      // in the order of the fit
    size_t points = 0, observations = 0;  // of the fit
    KnownAgreement known;                 // of the known exposures with the frames'
    std::vector<uint32_t> left_out;       // frames whose known exposures were not used, because they are wrong,
    double left_out_ev = 0.0;             // and by how much at most
    double fitted_rms = NAN;              // residual that a fitted response leaves, levels, where one is given

    std::unique_ptr<lensprof_profile> profile() const;  // response and falloff alone

    // Whether these are not measured, and exposures alone level the frames.
    bool shows_exposures_only() const { return report.verdict.find(LENSPROF_REASON_EXPOSURES_ONLY) != nullptr; }
};

// Fits response, falloff, and exposures of keyframes with the method radiance, then sets the exposures of all frames of
// the clip. A few known exposures that the frames contradict are left out, with a warning. Failure (not usable) for a
// clip in which no scene points are followed, for known exposures that the frames contradict, for a fit whose
// exposures are not those of the frames, and for a given response that leaves a far larger residual than a fitted one.
ClipFit fit_clip(ClipOptions o, const lensprof_profile_key &key, ClipTracks &clip, Events &events);

}  // namespace lensprof
