// How well profiles explain pairs of overlapping pictures: exposures and white balances are fitted to one half of the
// pairs, with the profile's response and falloff as they are, and the other half is measured.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <lensprof/lensprof.h>

namespace lensprof {

// Pairs to try on: exposures are fitted to `train`, `heldout` is measured.
struct TrialPairs {
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_pair> train, heldout;
    uint32_t channels = 3;
};

// Splits pairs by their numbers, the same every time. Left out of what is measured are pairs whose images no pair of
// the other half joins.
TrialPairs split_for_trial(std::vector<lensprof_fit_image> images, const std::vector<lensprof_pair> &pairs,
                           uint32_t channels);

// What is tried.
struct TrialModel {
    const lensprof_profile *falloff = nullptr;  // its falloffs and gain grid; NULL: none
    const lensprof_response *responses;         // of the channels; all of them the first where there is one
    uint32_t response_count = 1;
};

// Levels of 255 that are left of the held-out pairs: of each side and channel of a pair.
struct TrialErrors {
    std::vector<double> squares;    // mean of each pair
    std::vector<double> absolutes;  // all, pair by pair
};
TrialErrors try_model(const TrialPairs &pairs, const TrialModel &model);

// The pictures as they are.
TrialErrors errors_as_they_are(const TrialPairs &pairs);

// Of each held-out pair whether it counts: one of the models explains it. Others show two different things.
std::vector<bool> explained_pairs(const std::vector<TrialErrors> &tried);

struct TrialFigures {
    double rms = 0.0, median = 0.0;
};
TrialFigures figures_of(const TrialErrors &errors, const std::vector<bool> &counts);

// By how much the RMS of one is above that of another, levels, and the standard error of that: the larger of those that
// pairs and the links between images say by their scatter. Curves that are stored in another form differ by less than
// the last number.
struct TrialDifference {
    double levels = 0.0, sigma = 0.0;
    bool is_clear() const { return levels > 2.0 * sigma && levels > 1e-3; }
};
TrialDifference difference_of(const TrialErrors &one, const TrialErrors &other, const TrialPairs &pairs,
                              const std::vector<bool> &counts);

}  // namespace lensprof
