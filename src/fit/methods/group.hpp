// The largest group of images that agree, and a fit of it.
#pragma once

#include <array>
#include <functional>
#include <set>
#include <vector>

#include "fit/problem/problem.hpp"

namespace lensprof {

// Which images and links take part in a fit.
struct Group {
    std::vector<bool> joined;                  // of each image
    std::set<std::array<uint32_t, 2>> broken;  // links without a part, the lower image first
    uint32_t reference = 0;

    bool holds(uint32_t i, uint32_t j) const {
        return joined[i] && joined[j] && broken.count({std::min(i, j), std::max(i, j)}) == 0;
    }
};

// The pairs of the data between a group's images, by its links.
using PairsWithin = std::function<std::vector<lensprof_pair>(const Group &group)>;

// Fits the data of a group's images and links with these options.
using FitGroup = std::function<void(const lensprof_fit_options &options, const Group &group,
                                    lensprof_exposure *exposures, lensprof_fit_result &result)>;

// Fits all images. Where links contradict what the others agree on, or the result cannot state an image's exposure,
// fits again without them: the largest group of images that is still tied together. Images outside of it have an ev of
// NaN; a group of half of the images or less is refused.
void fit_largest_group(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                       const PairsWithin &pairs_within, const FitGroup &fit, lensprof_exposure *exposures,
                       lensprof_fit_result &result);

}  // namespace lensprof
