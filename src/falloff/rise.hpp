// Falloffs that no lens has: they rise away from the middle, or leave almost no light. Only this header of the layer
// may be used by the command line program: it needs nothing but the public model.
#pragma once

#include <lensprof/model.h>

namespace lensprof {

constexpr double kLargestRise = 1.05;  // M that a camera which corrects its lens may leave
constexpr double kSmallestM = 0.05;    // M of the darkest corner in Lensfun's data
constexpr double kSmallRise = 0.02;    // of M outward: 98 % of the falloffs in Lensfun's data rise less

// A value of M, or a change of M, and where it is.
struct MAt {
    double m, r2;
};

// How M changes from the centre of a falloff outward.
struct Course {
    MAt highest{1.0, 0.0}, lowest{1.0, 0.0};
    MAt rise{0.0, 0.0};  // the largest rise from a place to one farther from the centre, and this place
};

// Follows m_of(r2) up to farthest_r2. Rises for which counts(r2, rise) is false are ignored.
template <class MOf, class Counts>
Course course_of(double farthest_r2, const MOf &m_of, const Counts &counts) {
    constexpr int kSteps = 40;  // of r^2
    Course course;
    for (int i = 1; i <= kSteps; i++) {
        const double r2 = farthest_r2 * i / kSteps, m = m_of(r2), rise = m - course.lowest.m;
        if (m > course.highest.m) course.highest = {m, r2};
        if (rise > course.rise.m && counts(r2, rise)) course.rise = {rise, r2};
        if (m < course.lowest.m) course.lowest = {m, r2};
    }
    return course;
}

// The same of a falloff about its own centre, to r = 1.
inline Course course_of(const lensprof_vignetting &v) {
    return course_of(
        1.0, [&](double r2) { return lensprof_vignetting_eval(&v, r2, nullptr); }, [](double, double) { return true; });
}

}  // namespace lensprof
