// The largest group of images that agree, and a fit of it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "fit/problem/problem.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// Which images and links take part in a fit.
struct Group {
    std::vector<bool> joined;                  // per image
    std::set<std::array<uint32_t, 2>> broken;  // links that are not used, the lower image first
    uint32_t reference = 0;

    bool holds(uint32_t i, uint32_t j) const {
        return joined[i] && joined[j] && broken.count({std::min(i, j), std::max(i, j)}) == 0;
    }
};

// The pairs between the images of a group, restricted to its links.
using PairsWithin = std::function<std::vector<lensprof_pair>(const Group &group)>;

// Fits the data of a group's images and links with the given options.
using FitGroup = std::function<void(const lensprof_fit_options &options, const Group &group,
                                    lensprof_exposure *exposures, FitResult &result)>;

// What is found if fewer than half of the images of the set, with those that overlap none, take part in a result that
// corrects pictures, and no link is verified.
std::optional<lensprof_finding> minority_finding(const lensprof_fit_options &options, uint32_t image_count,
                                                 const FitResult &r);

// Fits all images. If links contradict the others, or the result cannot determine an image's exposure, fits again
// without them, using the largest group of images that is still connected. Images outside of it have an ev of NaN. A
// group of half of the images or fewer is rejected.
void fit_largest_group(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                       const PairsWithin &pairs_within, const FitGroup &fit, lensprof_exposure *exposures,
                       FitResult &result);

}  // namespace lensprof
