// Tests how well profiles explain pairs of overlapping pictures: exposures and white balances are fitted to one half of
// the pairs, with response and falloff of the profile fixed, and the residual is measured on the other half.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lensprof/fit.h>

namespace lensprof {

// Exposures are fitted to `train`, the residual is measured on `heldout`.
struct TrialPairs {
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_pair> train, heldout;
    uint32_t channels = 3;
};

// Splits pairs by their indices, reproducibly. Held-out pairs whose images are not connected by pairs of the other half
// are dropped.
TrialPairs split_pairs(std::vector<lensprof_fit_image> images, const std::vector<lensprof_pair> &pairs,
                       uint32_t channels);

// A candidate.
struct TrialModel {
    const lensprof_profile *falloff = nullptr;  // falloffs and gain grid; NULL: none
    const lensprof_response *responses;         // per channel; all equal the first if there is one
    uint32_t response_count = 1;
};

// Residuals of the held-out pairs, levels of 255: per side and channel of a pair.
struct TrialErrors {
    std::vector<double> squares;    // mean per pair
    std::vector<double> absolutes;  // all, pair by pair
};
TrialErrors try_model(const TrialPairs &pairs, const TrialModel &model);

// The pictures as they are.
TrialErrors uncorrected_errors(const TrialPairs &pairs);

// Whether each held-out pair counts: one of the models explains it. The others show two different objects.
std::vector<bool> explained_pairs(const std::vector<const TrialErrors *> &candidates);

struct TrialFigures {
    double rms = 0.0, median = 0.0;
};
TrialFigures figures_of(const TrialErrors &errors, const std::vector<bool> &is_explained);

// The RMS of one model above that of another, levels, and the standard error of this difference: the larger of the
// errors from the scatter of pairs and of image links. Curves stored in another form differ by less than the last
// number.
struct TrialDifference {
    double levels = 0.0, sigma = 0.0;
    bool is_clear() const { return levels > 2.0 * sigma && levels > 1e-3; }
};
TrialDifference difference_of(const TrialErrors &a, const TrialErrors &b, const TrialPairs &pairs,
                              const std::vector<bool> &is_explained);

}  // namespace lensprof
