// Selects the observations of a point to compare: those of similar views, because no surface is perfectly matte.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include <lensprof/sample.h>

#include "photo/reconstruction/reconstruction.hpp"

namespace lensprof {

// Two observations of one point, as indices of Reconstruction::observations.
struct ObservationPair {
    uint32_t first, second;
};

// Selects about `of_image` pairs per image, more if other images select it. A pair has the weight 1 / (1 + (a / 15
// degrees)^2) with the angle a between the two views at the point; without poses the share of points that the two
// images have in common is used instead. Points are drawn, and their pairs by these weights, reproducibly per seed.
// Sorted by images, then observations.
std::vector<ObservationPair> choose_pairs(const Reconstruction &reconstruction, uint32_t of_image, uint32_t seed);

// The distance of the views of each two images: the mean over these pairs of a / 15 degrees, or of its substitute.
std::map<std::pair<uint32_t, uint32_t>, double> view_distances(const Reconstruction &reconstruction,
                                                               const std::vector<ObservationPair> &pairs);

// The input matches of lensprof_sample_matches, with the maps of their surroundings if feature shapes determine them;
// else pairs are taken from the points themselves. Coordinates must be px of the stored pictures.
std::vector<lensprof_match> matches_of(const Reconstruction &reconstruction, const std::vector<ObservationPair> &pairs);

}  // namespace lensprof
