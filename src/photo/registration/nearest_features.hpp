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

// The same with the instructions of one kind of processor.
struct NearestKernel {
    const char *instructions;
    std::vector<NearestFeatures> (*find)(const int16_t *a, int count_a, const int16_t *b, int count_b);
};

// Those that this processor has, from the fastest, which nearest_features uses, to the last, plain C++.
std::vector<NearestKernel> nearest_kernels();

}  // namespace lensprof
