// How far the shading and the offset of a fit are from the truth, by fits without some of the pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fit/fields/descent.hpp"

namespace lensprof {

struct FieldErrors {
    double shading = 0.0;  // standard error of ln S, rms over the frame
    double offset = 0.0;   // of the offset; 0 if it is held
};

struct Refits {
    size_t groups;      // of pictures, each left out once; at least 2
    bool moves_offset;  // with everything else
    uint32_t threads;
};

// The jackknife: the whole fit goes on without each group, from where it is. Throws Cancelled.
FieldErrors jackknife(const Descent &descent, const Refits &how, const FieldStep &step);

}  // namespace lensprof
