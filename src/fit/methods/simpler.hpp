// Simpler descriptions of the pictures than response and falloff: no correction may be worse than these.
#pragma once

#include "fit/methods/overlap_fit.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// The data of a fit.
struct FitData {
    const lensprof_fit_options &options;
    uint32_t image_count;
    const OverlapFit::Make &make;
    uint32_t count;  // pairs or tracks
};

// Replaces the result of `full` if it is not usable, has a falloff that no lens has, or predicts held-out pairs no
// better: by the falloff of the profile and exposures, or by exposures and white balances alone, whichever predicts
// them better than nothing at all. If neither does, the pictures are corrected by nothing.
void prefer_simpler(const FitData &data, const OverlapFit &full, lensprof_exposure *exposures, FitResult &r);

}  // namespace lensprof
