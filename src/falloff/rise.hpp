// Falloffs that rise away from the middle, as of no lens.
#pragma once

#include <lensprof/model.h>

namespace lensprof {

constexpr double kLargestRise = 1.05;  // M that a camera which corrects its lens may leave
constexpr double kSmallestM = 0.05;    // M of the darkest corner in Lensfun's data
constexpr double kSmallRise = 0.02;    // of M outward: 99 % of the falloffs in Lensfun's data rise less

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

// The smallest M of the falloff about its own centre, at most 1.
inline double lowest_of(const lensprof_vignetting &v) {
    constexpr int kSteps = 20;  // of r^2
    double lowest = 1.0;
    for (int i = 1; i <= kSteps; i++) {
        const double m = lensprof_vignetting_eval(&v, double(i) / kSteps, nullptr);
        lowest = m < lowest ? m : lowest;
    }
    return lowest;
}

// The largest rise of M from a place to one farther from its centre.
inline double outward_rise(const lensprof_vignetting &v) {
    constexpr int kSteps = 40;  // of r^2
    double lowest = 1.0, rise = 0.0;
    for (int i = 1; i <= kSteps; i++) {
        const double m = lensprof_vignetting_eval(&v, double(i) / kSteps, nullptr);
        lowest = m < lowest ? m : lowest;
        rise = m - lowest > rise ? m - lowest : rise;
    }
    return rise;
}

}  // namespace lensprof
