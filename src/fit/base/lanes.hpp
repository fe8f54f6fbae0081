// Four values in one register: code for all of them together, without a branch.
#pragma once

#include <cstddef>

namespace lensprof {

constexpr int kLanes = 4;
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));

}  // namespace lensprof
