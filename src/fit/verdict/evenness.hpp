// Whether a result equalises its own pictures, independent of whether it is usable as a profile.
#pragma once

#include "fit/verdict/finish.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// Median difference of grey values between overlapping pictures, before and after the correction, levels of 255.
struct Seam {
    double before = 0.0, after = 0.0;
};

// Fills `equalizes`. Returns the seam of the first link that keeps one, otherwise that of all links.
Seam judge_evenness(const Found &found, FitResult &result);

}  // namespace lensprof
