// How smooth the shading is, by pictures that are held out.
#pragma once

#include <iterator>

#include "fit/fields/descent.hpp"

namespace lensprof {

struct Heldout {
    std::vector<double> rms;  // per order and weight
    Smoothness best;
    size_t best_index = 0;
    double best_rms = 0.0, even_rms = 0.0;
};

constexpr size_t kSmoothnesses = std::size(kSmoothOrders) * kSmoothWeights;  // tried
Smoothness smoothness_at(size_t index);                                      // in Heldout::rms

// Every group of pictures is predicted by the surface of all others; weights and levels stay.
Heldout hold_out(const Descent &descent, const Surface &surface, size_t groups, uint32_t threads);

// Mean square over the cells of what ten times less smoothness changes of ln S, beyond chance (the jackknife over
// groups): the bias of the smoothness chosen, as far as the pictures show it.
double smoothing_bias(const Descent &descent, const Surface &surface, size_t groups);

}  // namespace lensprof
