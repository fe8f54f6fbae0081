// How much the colours of scene points differ between the images that see them.
#pragma once

#include <vector>

#include "fit/methods/fit_call.hpp"

namespace lensprof {

// What images are corrected with. Points to what must outlive it.
struct ColourCorrection {
    const lensprof_fit_image *images;
    const lensprof_exposure *exposures;                 // per image
    std::vector<const lensprof_response *> responses;   // per image
    std::vector<const lensprof_vignetting *> falloffs;  // per image: three curves, which may be equal
    uint32_t reference;

    ColourCorrection(const FitCall &call, const lensprof_exposure *found);
    ColourCorrection() = default;
};

// Half the squared difference of each pair's ends, levels of 255 squared, mean over the channels: of the images as they
// are, or, if `correction` is not NULL, corrected to the mean exposure. NaN if an exposure is unknown.
std::vector<double> colour_differences(const lensprof_pair *pairs, size_t count, int channels,
                                       const ColourCorrection *correction);

// Replaces NaN of pairs with unknown exposures: each link of two images is then compared at the ratio of exposures that
// its own pairs have.
void compare_unknown_exposures(const std::vector<lensprof_pair> &pairs, int channels,
                               const ColourCorrection &correction, std::vector<double> &differences);

// The mean of the smallest 90 % of these values; the others may show different objects. NaN is skipped; without others,
// the mean is NaN.
double colour_variance(std::vector<double> differences);

}  // namespace lensprof
