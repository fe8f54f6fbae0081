// Whether known exposures agree with each other and with the pictures, and what explains it best where they do not.
#pragma once

#include "fit/problem/problem.hpp"

namespace lensprof {

struct KnownExposures {
    enum class Explanation {
        none,
        order,
        one,
        step,
        any
    };

    int count = 0;       // known ones in the reference's group
    double slope = 1.0;  // of the found exposures on them
    // none: they agree within their errors. order: they do not follow the pictures at all.
    Explanation explanation = Explanation::none;
    uint32_t image = 0;  // one: that is wrong; step: the first after it
    double off_ev =
        0.0;  // by how much it is wrong, the step, or the largest distance of any; order: how the pictures differ
};

// With `open`, a factor between known and found exposures is as good as none: gamma.
KnownExposures compare_known(const Problem &problem, const Estimate &estimate, bool open);

}  // namespace lensprof
