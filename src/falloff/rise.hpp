// Falloffs that rise away from the middle, as of no lens.
#pragma once

#include <lensprof/model.h>

namespace lensprof {

constexpr double kLargestRise = 1.05;  // M that a camera which corrects its lens may leave

// Where a falloff is brightest.
struct Highest {
    double m, r2;
};

// M of the falloff about its own centre; 1 at the centre where it rises nowhere.
inline Highest highest_of(const lensprof_vignetting &v) {
    constexpr int kSteps = 20;  // of r^2
    Highest highest{1.0, 0.0};
    for (int i = 1; i <= kSteps; i++) {
        const double r2 = double(i) / kSteps, m = lensprof_vignetting_eval(&v, r2, nullptr);
        if (m > highest.m) highest = {m, r2};
    }
    return highest;
}

}  // namespace lensprof
