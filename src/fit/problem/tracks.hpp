// Tracks: all observations of one scene point, and conversions between tracks and pairs.
#pragma once

#include <functional>

#include "fit/problem/problem.hpp"

namespace lensprof {

// A grey value above kWhite is saturated: the sensor received at least that. One that rounds to 0 of 255 is black: at
// most kBlack. Both are one-sided.
constexpr double kWhite = 250.0 / 255.0, kBlack = 0.5 / 255.0;

// Groups observations by point and orders each group by image.
Tracks tracks_of(const lensprof_observation *observations, uint32_t count);

// Observations of pairs. Pairs with a common end (image, position, values) belong to one point, unless that point would
// then be at two places of one image.
std::vector<lensprof_observation> observations_of(const lensprof_pair *pairs, uint32_t count, int channels);

// For each track, the observations that are compatible with all those kept before them; drops tracks that keep fewer
// than two. holds(i, i): whether an image is used at all; holds(i, j): whether a link is.
Tracks tracks_within(const Tracks &tracks, const std::function<bool(uint32_t i, uint32_t j)> &holds);

// The pairs of tracks: neighbours among the observations that are not one-sided in any channel.
std::vector<lensprof_pair> pairs_of(const Tracks &tracks, int channels);

}  // namespace lensprof
