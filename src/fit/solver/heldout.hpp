// The criterion by which fits compare their candidates: the costs of held-out pairs or tracks under each candidate.
#pragma once

#include <algorithm>
#include <vector>

#include "fit/problem/loss.hpp"

namespace lensprof {

constexpr size_t kMinHeldout = 20;

// Splits all pairs or tracks by their numbers: four fifths to fit, one fifth held out, and a few of the former for
// first fits. The split is deterministic.
struct Split {
    std::vector<uint32_t> all, train, heldout, brief;

    bool has_heldout() const { return heldout.size() >= kMinHeldout; }
};
Split split_pairs(uint32_t count, uint32_t images);

// A hash 0..2^64-1 of a pair's number: independent of the order along images, and deterministic.
uint64_t pair_hash(uint32_t pair);

// The cost of every held-out pair or track under an estimate, with a loss common to all candidates.
struct HeldoutLoss {
    std::vector<double> losses;
    double mean = 0.0;
};
HeldoutLoss heldout_loss(const Problem &heldout, const Estimate &estimate, const Loss &common);

// Mean and standard error of the difference of two candidates' held-out losses.
double loss_difference(const HeldoutLoss &a, const HeldoutLoss &b, double &standard_error);

// The same, with the standard error over places instead of single pairs or tracks: those that are near each other have
// errors in common (inflation.hpp).
double loss_difference_by_place(const Problem &heldout, const HeldoutLoss &a, const HeldoutLoss &b,
                                double &standard_error);

// Whether a candidate is within one standard error (of the paired difference) of the best one.
bool is_as_good(const HeldoutLoss &loss, const HeldoutLoss &best);

// Whether a candidate is better by more than three standard errors.
bool is_clearly_better(const HeldoutLoss &loss, const HeldoutLoss &other);

// The candidate with the smallest held-out loss.
template <class Candidate>
const Candidate &best_of(const std::vector<Candidate> &tried) {
    return *std::min_element(tried.begin(), tried.end(),
                             [](const Candidate &a, const Candidate &b) { return a.mean < b.mean; });
}

}  // namespace lensprof
