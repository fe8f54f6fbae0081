// Which observations of the same points are compared: those of similar views, for no surface is quite matte.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include <lensprof/sample.h>

#include "cli/reconstruction/reconstruction.hpp"

namespace lensprof {

// Two observations of one point, by their indices in Reconstruction::observations.
struct ObservationPair {
    uint32_t first, second;
};

// About `of_image` pairs of every image, and more where other images choose it. A pair counts 1 / (1 + (a / 15
// degrees)^2), where a is the angle between the two views at the point; without poses the share of points that the two
// images have in common takes its place. Points are drawn, and their pairs by these weights, the same for one seed. By
// images, then observations.
std::vector<ObservationPair> choose_pairs(const Reconstruction &reconstruction, uint32_t of_image, uint32_t seed);

// How far apart the views of each two images are: the mean over these pairs of a / 15 degrees, or of what takes its
// place.
std::map<std::pair<uint32_t, uint32_t>, double> view_distances(const Reconstruction &reconstruction,
                                                               const std::vector<ObservationPair> &pairs);

// The matches that lensprof_sample_matches takes, with the maps of their surroundings where shapes of features say
// these; else pairs come from the points themselves. Coordinates must be px of the stored pictures.
std::vector<lensprof_match> matches_of(const Reconstruction &reconstruction, const std::vector<ObservationPair> &pairs);

}  // namespace lensprof
