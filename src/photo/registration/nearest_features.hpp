// The most similar descriptors of another picture, for every descriptor of one.
#pragma once

#include <cstdint>
#include <vector>

#include "photo/registration/features.hpp"

namespace lensprof {

// The largest and the second largest product of a descriptor with those of the other picture, and the number of the
// former. Products of integers are exact: every processor finds the same.
struct NearestFeatures {
    int32_t best = -1, next = -1;
    int32_t number = -1;
};

// Per row of `a`, which has `count_a` rows of descriptor_length, among those of `b`.
std::vector<NearestFeatures> nearest_features(const int16_t *a, int count_a, const int16_t *b, int count_b);

// The same, whatever the processor can do; for tests.
std::vector<NearestFeatures> nearest_features_plainly(const int16_t *a, int count_a, const int16_t *b, int count_b);

}  // namespace lensprof
