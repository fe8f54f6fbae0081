// Tracks: all observations of one scene point, and how they and pairs become each other.
#pragma once

#include <functional>

#include "fit/problem/problem.hpp"

namespace lensprof {

// A grey value above kWhite is saturated: what the sensor received is at least that. One that rounds to 0 of 255 is
// black: at most kBlack. Both are one-sided.
constexpr double kWhite = 250.0 / 255.0, kBlack = 0.5 / 255.0;

// Groups observations by point and orders each group by image.
Tracks tracks_of(const lensprof_observation *observations, uint32_t count);

// Observations of pairs: pairs that have an end in common (image, position, values) are of one point, unless that one
// would then be at two places of one image.
std::vector<lensprof_observation> observations_of(const lensprof_pair *pairs, uint32_t count, int channels);

// The observations of each track that hold with all that were kept before them, of the tracks that keep two or more.
// holds(i, i): whether an image has a part at all; holds(i, j): whether a link has.
Tracks tracks_within(const Tracks &tracks, const std::function<bool(uint32_t i, uint32_t j)> &holds);

// The pairs of tracks: neighbours among the observations of which no channel is one-sided.
std::vector<lensprof_pair> pairs_of(const Tracks &tracks, int channels);

}  // namespace lensprof
