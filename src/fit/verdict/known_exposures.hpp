// Whether known exposures agree with each other and with the pictures, and the best explanation if they do not.
#pragma once

#include "fit/problem/problem.hpp"

namespace lensprof {

struct KnownExposures {
    enum class Explanation {
        none,
        order,
        single_image,
        step,
        any
    };

    int count = 0;       // number of known exposures in the reference's group
    double slope = 1.0;  // of the found exposures against them
    // none: they agree within their errors. order: they do not follow the pictures at all.
    Explanation explanation = Explanation::none;
    uint32_t image = 0;  // one: the wrong image; step: the first image after the step
    double off_ev =
        0.0;  // size of the error, of the step, or largest distance of any image; order: spread of the pictures
};

// With `open`, a factor between known and found exposures is accepted: it is gamma.
KnownExposures compare_known(const Problem &problem, const Estimate &estimate, bool open);

}  // namespace lensprof
